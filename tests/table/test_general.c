/* test_general.c: general linear methods of the shelf: orders, left eigenvectors, parasitic
 * roots, error constants, what they have in common with the formulas they stand for.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"
#include "suite.h"
#include <complex.h>
#include <stdlib.h>
#include <string.h>

static steif_table *make(steif_context *ctx, const char *spec)
{
  steif_table *t = steif_table_new(ctx, spec);
  if (!t) printf("\n  %s: %s", spec, steif_message(ctx));
  CU_ASSERT_FATAL(t != NULL && t->kind == STEIF_GLM && t->general != NULL);
  return t;
}

static const char *const all[] = {
  "ab:p=1",
  "ab:p=2",
  "ab:p=3",
  "ab:p=4",
  "ab:p=5",
  "ab:p=6",
  "am:p=1",
  "am:p=2",
  "am:p=3",
  "am:p=4",
  "am:p=5",
  "am:p=6",
  "bdf:p=1",
  "bdf:p=2",
  "bdf:p=3",
  "bdf:p=4",
  "bdf:p=5",
  "bdf:p=6",
  "nordsieck:of=bdf,p=1",
  "nordsieck:of=bdf,p=2",
  "nordsieck:of=bdf,p=3",
  "nordsieck:of=bdf,p=4",
  "nordsieck:of=bdf,p=5",
  "nordsieck:of=bdf,p=6",
  "nordsieck:of=am,p=1",
  "nordsieck:of=am,p=2",
  "nordsieck:of=am,p=3",
  "nordsieck:of=am,p=4",
  "nordsieck:of=am,p=5",
  "nordsieck:of=am,p=6",
  "dimsim1",
  "dimsim2",
  "dimsim1:p=3",
  "dimsim1:p=4",
  "dimsim2:p=3",
  "dimsim2:p=4",
  "nord22",
  "irks:p=1",
  "irks:p=2",
  "irks:p=3",
  "irks:p=4",
};
enum { ALL = sizeof all / sizeof *all };

/* A table added to the shelf is added to the list above. */
static void every_table_is_listed(void)
{
  int seen = 0;
  for (size_t k = 0; k < stf_table_count; k++) {
    const steif_table *item = stf_table_shelf[k].item;
    if (item->kind != STEIF_GLM) continue;
    int found = 0;
    for (int i = 0; i < ALL; i++) found += !strncmp(all[i], item->name, strlen(item->name));
    if (!found) printf("\n  '%s' is not tested", item->name);
    CHECK(found > 0);
    seen++;
  }
  CHECK(seen >= 8);
}

/* The order after the last '='; without one, 2. */
static int claimed(const char *spec)
{
  const char *p = strrchr(spec, '=');
  return p ? atoi(p + 1) : 2;
}

/* From the matrices alone: no W given, and no order above the one found. */
static void orders_follow_from_the_matrices(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < ALL; i++) {
    steif_table *t = make(ctx, all[i]);
    steif_glm g = *t->general;
    const int p = claimed(all[i]);
    CHECK(t->order == p && g.order == p && g.stage_order >= p);
    g.order = 0;
    CHECK(steif_glm_complete(ctx, &g) == STEIF_OK && g.order == p && g.stage_order == p);
    for (int k = 0; k < g.k * (p + 1); k++) CLOSE_FLOOR(g.W[k], t->general->W[k], 1e-12, 1);
    double one = 0;
    for (int j = 0; j < g.k; j++) one += g.ell[j] * g.W[j * (p + 1)];
    CLOSE(one, 1, 1e-13);
    steif_table_free(ctx, &t);
  }
  steif_context_free(&ctx);
}

/* Taylor coefficients x^(j) / j! of exp(-0.4 t + 0.9 sin t): x' = a x, a = -0.4 + 0.9 cos t. */
static void taylor(double t, int n, double *x)
{
  double a[20], fact = 1;
  for (int j = 0; j < n; j++, fact *= j)
    a[j] = (j == 0 ? -0.4 : 0) + 0.9 * cos(t + j * acos(0.0)) / fact;
  x[0] = exp(-0.4 * t + 0.9 * sin(t));
  for (int j = 0; j < n; j++) {
    x[j + 1] = 0;
    for (int m = 0; m <= j; m++) x[j + 1] += a[m] * x[j - m] / (j + 1);
  }
}

static void start(const steif_glm *g, double t, double h, double *X)
{
  double x[20];
  taylor(t, g->order, x);
  for (int i = 0; i < g->k; i++) {
    double term = 1;
    X[i] = 0;
    for (int j = 0; j <= g->order; j++, term *= h * j)
      X[i] += g->W[i * (g->order + 1) + j] * term * x[j];
  }
}

/* max_i |F(S_h(x(t)))_i - S_h(x(t + h))_i|, stages one after another. */
static double local_error(const steif_glm *g, double t, double h)
{
  double X[STEIF_PAST], Y[STEIF_PAST], F[STEIF_STAGES], most = 0;
  start(g, t, h, X), start(g, t + h, h, Y);
  for (int i = 0; i < g->r; i++) {
    const double a = -0.4 + 0.9 * cos(t + g->xi[i] * h);
    double G = 0;
    for (int j = 0; j < g->k; j++) G += g->U[i * g->k + j] * X[j];
    for (int l = 0; l < i; l++) G += h * g->C[i * g->r + l] * F[l];
    F[i] = a * G / (1 - h * g->C[i * g->r + i] * a);
  }
  for (int i = 0; i < g->k; i++) {
    for (int j = 0; j < g->k; j++) Y[i] -= g->V[i * g->k + j] * X[j];
    for (int l = 0; l < g->r; l++) Y[i] -= h * g->D[i * g->r + l] * F[l];
    most = fmax(most, fabs(Y[i]));
  }
  return most;
}

static void local_errors_have_the_order(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < ALL; i++) {
    steif_table *t = make(ctx, all[i]);
    const steif_glm *g = t->general;
    const double order = log2(local_error(g, 0.7, 0.02) / local_error(g, 0.7, 0.01)) - 1;
    if (fabs(order - g->order) > 0.2) printf("\n  %s: %.3f", all[i], order);
    CHECK(fabs(order - g->order) <= 0.2);
    steif_table_free(ctx, &t);
  }
  steif_context_free(&ctx);
}

/* ell of a multistep formula: rho(x) / (x - 1) over rho'(1); of Adams (1, and sums of weights).
 * The parasitic roots of BDF are those of rho; Adams methods, Nordsieck's included, have none
 * but 0. Errors: Hairer, Norsett, Wanner, Solving ODEs I, III.2: C* of BDF is -1/(p+1), of
 * Adams 5/12, 3/8, 251/720 and -1/12, -1/24, -19/720; X runs ahead by -C*. */
static const struct known {
  const char *spec;
  double ell[6], second, error;
} known[] = {
  {"bdf:p=2", {-1 / 2., 3 / 2.}, 1 / 3., 1 / 3.},
  {"bdf:p=3", {1 / 3., -7 / 6., 11 / 6.}, 0.42640143271, 1 / 4.},
  {"bdf:p=4", {-1 / 4., 13 / 12., -23 / 12., 25 / 12.}, 0.56086151609, 1 / 5.},
  {"bdf:p=5", {1 / 5., -21 / 20., 137 / 60., -163 / 60., 137 / 60.}, 0.70871081627, 1 / 6.},
  {"bdf:p=6",
   {-1 / 6., 31 / 30., -163 / 60., 79 / 20., -71 / 20., 49 / 20.},
   0.86338026787,
   1 / 7.},
  {"ab:p=2", {1, 1, -1 / 2.}, 0, -5 / 12.},
  {"ab:p=3", {1, 1, -11 / 12., 5 / 12.}, 0, -3 / 8.},
  {"ab:p=4", {1, 1, -31 / 24., 7 / 6., -3 / 8.}, 0, -251 / 720.},
  {"am:p=2", {1, 1 / 2.}, 0, 1 / 12.},
  {"am:p=3", {1, 7 / 12., -1 / 12.}, 0, 1 / 24.},
  {"am:p=4", {1, 5 / 8., -1 / 6., 1 / 24.}, 0, 19 / 720.},
  {"dimsim1", {1 / 2., 1 / 2.}, 0, -1 / 6.},
  {"dimsim2", {0.79289321881345247560, 0.20710678118654752440}, 0, 0.04044011451988},
  {"nord22", {1, 0, -1 / 4.}, 0, 5 / 24.},
};

static void eigenvectors_roots_and_errors(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    steif_table *t = make(ctx, known[i].spec);
    for (int j = 0; j < t->general->k; j++)
      CLOSE_FLOOR(t->general->ell[j], known[i].ell[j], 1e-14, 1);
    CLOSE_FLOOR(t->general->second, known[i].second, 1e-10, 1e3); /* defective zeros */
    CLOSE(t->general->error, known[i].error, 1e-11);
    steif_table_free(ctx, &t);
  }
  steif_context_free(&ctx);
}

/* Nordsieck's form has the parasitic roots and the error of the formula, and z_j = h^j y^(j) /
 * j!. */
static void nordsieck_is_the_same_formula(void)
{
  static const char *const pairs[][2] = {{"nordsieck:of=bdf,p=3", "bdf:p=3"},
                                         {"nordsieck:of=bdf,p=6", "bdf:p=6"},
                                         {"nordsieck:of=am,p=3", "am:p=3"},
                                         {"nordsieck:of=am,p=5", "am:p=5"}};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 4; i++) {
    steif_table *t = make(ctx, pairs[i][0]), *u = make(ctx, pairs[i][1]);
    CLOSE_FLOOR(t->general->second, u->general->second, 1e-3, 1); /* AM: roots of x^p */
    CLOSE(t->general->error, u->general->error, 1e-10);
    steif_table_free(ctx, &t), steif_table_free(ctx, &u);
  }
  steif_table *bdf2 = make(ctx, "nordsieck:p=2"), *am4 = make(ctx, "nordsieck:of=am,p=4");
  const double l2[] = {2 / 3., 1, 1 / 3.}, l4[] = {3 / 8., 1, 11 / 12., 1 / 3., 1 / 24.};
  for (int j = 0; j < 3; j++) CLOSE(bdf2->general->D[j], l2[j], 1e-15);
  for (int j = 0; j < 5; j++) CLOSE(am4->general->D[j], l4[j], 1e-15);
  steif_table_free(ctx, &bdf2), steif_table_free(ctx, &am4);
  steif_context_free(&ctx);
}

/* Gear's shorter vectors, (y, h y', .., h^{p-1} y^(p-1)), l = (5/12, 1, 1/2) and (3/8, 1, 3/4,
 * 1/6), have order p = 3 and 4 (C. W. Gear, 1971, table 9.1), and V only the roots 1 and 0. */
static void shorter_vectors_of_gear(void)
{
  static const double l[2][4] = {{5 / 12., 1, 1 / 2.}, {3 / 8., 1, 3 / 4., 1 / 6.}};
  static const double pascal[16] = {1, 1, 1, 1, 0, 1, 2, 3, 0, 0, 1, 3, 0, 0, 0, 1};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 2; m++) {
    const int k = 3 + m;
    steif_glm g = {.name = "gear", .k = k, .r = 1, .xi = {1}, .C = {l[m][0]}};
    for (int j = 0; j < k; j++) {
      for (int i = 0; i < k; i++) g.V[i * k + j] = pascal[4 * i + j] - l[m][i] * pascal[4 + j];
      g.U[j] = g.V[j], g.D[j] = l[m][j];
    }
    CHECK(steif_glm_complete(ctx, &g) == STEIF_OK && g.order == k);
    CHECK(g.second < 1e-4);
    CLOSE(g.error, m ? 19 / 720. : 1 / 24., 1e-12);
  }
  steif_context_free(&ctx);
}

static void formulas_of_wright_give_nord22(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_table *t = make(ctx, "nord22");
  steif_glm g = *t->general;
  memset(g.U, 0, sizeof g.U), memset(g.V, 0, sizeof g.V), memset(g.W, 0, sizeof g.W);
  stf_glm_nordsieck(&g, 2);
  for (int i = 0; i < 6; i++) CLOSE_FLOOR(g.U[i], t->general->U[i], 1e-16, 1);
  for (int i = 0; i < 9; i++) CLOSE_FLOOR(g.V[i], t->general->V[i], 1e-16, 1);
  for (int i = 0; i < 9; i++) CHECK(g.W[i] == (i % 4 == 0));
  steif_table_free(ctx, &t);
  steif_context_free(&ctx);
}

/* M(z) of every Runge-Kutta table as a general linear method is its R(z), and the limit too. */
static void runge_kutta_tables_are_general(void)
{
  static const double points[][2] = {
    {-1.3, 0.7}, {0.2, -31}, {-1e4, 55}, {0, 0}, {-INFINITY, 0}};
  steif_context *ctx = steif_context_new(NULL);
  int seen = 0;
  for (size_t i = 0; i < stf_table_count; i++) {
    if (stf_table_shelf[i].item->kind == STEIF_GLM) continue;
    steif_table *t = steif_table_new(ctx, stf_table_shelf[i].name);
    steif_glm g;
    double R[2], M[2];
    CU_ASSERT_FATAL(t != NULL);
    CHECK(steif_table_glm(ctx, t, &g) == STEIF_OK && g.k == 1 && g.r == t->s);
    for (int m = 0; m < 5; m++) {
      /* powers up to z^12 of thirteen stages cancel where |z| is large */
      if ((m == 1 || m == 2) && t->kind == STEIF_EXPLICIT && t->s > 4) continue;
      CHECK(steif_table_stability(ctx, t, points[m], R) == STEIF_OK);
      CHECK(steif_glm_propagator(ctx, &g, points[m], M) == STEIF_OK);
      CHECK(isinf(R[0]) == isinf(M[0]));
      if (!isinf(R[0])) CLOSE_FLOOR(hypot(R[0] - M[0], R[1] - M[1]), 0, 1e-11, 1 + fabs(R[0]));
    }
    g.order = 0;
    CHECK(steif_glm_complete(ctx, &g) == STEIF_OK && g.order == (t->order < 8 ? t->order : 8));
    CHECK(g.stage_order == t->stage_order || t->stage_order == 0 || t->s > 4);
    steif_table_free(ctx, &t), seen++;
  }
  CHECK(seen > 13);
  steif_context_free(&ctx);
}

/* Butcher's tables of order 2 (Appl. Numer. Math. 11, 1993); M(z) of all has one eigenvalue besides 0:
 * trace(M^j) = trace(M)^j, j = 1 .. k. */
static void dimsims_have_one_eigenvalue(void)
{
  static const char *const names[] = {"dimsim1",     "dimsim2",     "dimsim1:p=3",
                                      "dimsim2:p=3", "dimsim1:p=4", "dimsim2:p=4"};
  const double r = sqrt(2), D[2][4] = {{1.25, .25, .75, -.25},
                                       {(73 - 34 * r) / 28, (4 * r - 5) / 4, (87 - 48 * r) / 28,
                                        (34 * r - 45) / 28}};
  static const double points[][2] = {{-1.3, 0.7}, {0.2, -3.1}, {-40, 55}, {0.9, 0}};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 6; i++) {
    steif_table *t = make(ctx, names[i]);
    const steif_glm *g = t->general;
    for (int e = 0; e < 4 && i < 2; e++) CLOSE(g->D[e], D[i][e], 1e-12);
    for (int m = 0; m < 4; m++) {
      double M[2 * 16];
      double complex P[16], Q[16], one = 0, power = 1;
      const int k = g->k;
      CHECK(steif_glm_propagator(ctx, g, points[m], M) == STEIF_OK);
      for (int e = 0; e < k * k; e++) P[e] = M[2 * e] + M[2 * e + 1] * I;
      for (int e = 0; e < k; e++) one += P[e * (k + 1)];
      double size = 0;
      for (int e = 0; e < k * k; e++) size = fmax(size, cabs(P[e]));
      for (int j = 1; j <= k; j++) {
        double complex trace = 0;
        for (int e = 0; e < k; e++) trace += P[e * (k + 1)];
        power *= one;
        CLOSE_FLOOR(cabs(trace - power), 0, 1e-11 * pow(k * size, j), 1);
        for (int a = 0; a < k * k; a++) {
          Q[a] = 0;
          for (int b = 0; b < k; b++)
            Q[a] +=
              P[a / k * k + b] * (M[2 * (b * k + a % k)] + M[2 * (b * k + a % k) + 1] * I);
        }
        memcpy(P, Q, sizeof P);
      }
    }
    steif_table_free(ctx, &t);
  }
  steif_context_free(&ctx);
}

static void refuse(steif_context *ctx, steif_glm *g, const char *words)
{
  CHECK(steif_glm_complete(ctx, g) == STEIF_BAD_INPUT);
  if (!strstr(steif_message(ctx), words)) printf("\n  %s", steif_message(ctx));
  CHECK(strstr(steif_message(ctx), words) && strstr(steif_message(ctx), g->name));
}

static void unstable_and_inconsistent_ones_are_refused(void)
{
  const double alpha[] = {-1, 0, 1}, beta[] = {1 / 3., 4 / 3., 1 / 3.}, wrong[] = {-1, 0, 2};
  steif_context *ctx = steif_context_new(NULL);
  steif_glm g;
  CHECK(steif_glm_multistep(ctx, "simpson", 2, alpha, beta, &g) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "'simpson' is not strictly stable"));
  CHECK(strstr(steif_message(ctx), "eigenvalue -1"));
  CHECK(steif_glm_multistep(ctx, "crooked", 2, wrong, beta, &g) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "'crooked' is inconsistent"));
  CHECK(steif_glm_multistep(ctx, "zero", 2, (double[]){1, -1, 0}, beta, &g) == STEIF_BAD_INPUT);
  CHECK(steif_glm_multistep(ctx, "long", 17, alpha, beta, &g) == STEIF_BAD_INPUT);
  CHECK(!steif_table_new(ctx, "bdf:p=7") && steif_status(ctx) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "'bdf:p=7' is not strictly stable"));
  CHECK(strstr(steif_message(ctx), "modulus 1.0222"));
  CHECK(!steif_table_new(ctx, "nordsieck:of=bdf,p=7") &&
        strstr(steif_message(ctx), "not strictly stable"));
  CHECK(!steif_table_new(ctx, "nordsieck:of=ab,p=3") &&
        steif_status(ctx) == STEIF_UNKNOWN_NAME);
  steif_table *t = make(ctx, "dimsim1");
  g = *t->general, g.order = 0, g.D[1] = 0.3;
  refuse(ctx, &g, "order 0");
  g = *t->general, g.order = 3;
  refuse(ctx, &g, "said to have order 3 and has 2");
  g = *t->general, g.W[4] = 0.3;
  refuse(ctx, &g, "(2, 2)");
  g = *t->general, g.order = 0, g.U[0] = 2;
  refuse(ctx, &g, "V u = u and U u = 1");
  g = *t->general, g.V[0] = NAN;
  CHECK(steif_glm_complete(ctx, &g) == STEIF_NOT_FINITE);
  g = *t->general, g.k = 0;
  CHECK(steif_glm_complete(ctx, &g) == STEIF_BAD_INPUT);
  CHECK(steif_glm_complete(ctx, NULL) == STEIF_BAD_INPUT);
  steif_table_free(ctx, &t);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_general[] = {
  {"every table is listed here", every_table_is_listed},
  {"orders follow from the matrices", orders_follow_from_the_matrices},
  {"local errors relative to the start have the order", local_errors_have_the_order},
  {"left eigenvectors, parasitic roots, errors", eigenvectors_roots_and_errors},
  {"Nordsieck's form is the same formula", nordsieck_is_the_same_formula},
  {"Gear's shorter vectors have their order", shorter_vectors_of_gear},
  {"Wright's formulas give nord22", formulas_of_wright_give_nord22},
  {"Runge-Kutta tables are general linear methods", runge_kutta_tables_are_general},
  {"DIMSIMs have one eigenvalue", dimsims_have_one_eigenvalue},
  {"unstable and inconsistent ones are refused", unstable_and_inconsistent_ones_are_refused},
  CU_TEST_INFO_NULL};
