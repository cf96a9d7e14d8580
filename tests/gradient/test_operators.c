/* test_operators.c: gradients with Krylov storage: of products, transposed too, and of matrices that it keeps.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "net.h"
#include <stdbool.h>
#include <string.h>

static const char *const methods[] = {"radau:s=1",     "radau:s=2", "radau:s=3",    "radau:s=5",
                                      "gauss:s=2",     "bdf:p=1",   "bdf:p=3",      "dirk:hw43",
                                      "dirk:esdirk43", "bdf",       "lobatto3c:s=3"};
enum { METHODS = sizeof methods / sizeof *methods };

static const steif_functional J = {.count = 1, .end = weighted_sum, .slopes = weighted_slopes},
                              both = {.count = 1,
                                      .end = weighted_sum,
                                      .integrand = weighted_sum,
                                      .slopes = weighted_slopes};

enum kind { PLAIN, PRECONDITIONED, INCOMPLETE, INSTEAD, MASS, GROWING, KINDS };
static const char *const kinds[] = {"products",         "preconditioned", "ILU(0)",
                                    "matrices instead", "mass",           "M(t)"};

static void make(enum kind kind, struct net *w, steif_options *o)
{
  net_products(w);
  *o = steif_defaults();
  if (kind == PRECONDITIONED || kind == MASS || kind == GROWING) net_precondition(w);
  if (kind == MASS || kind == GROWING) net_mass(w, kind == GROWING);
  if (kind == INCOMPLETE) net_matrices(w), o->force_storage = 1, o->storage = STEIF_KRYLOV;
  if (kind != INSTEAD) return;
  struct net other = *w;
  net_matrices(&other);
  w->s.problem.jac = other.s.problem.jac, w->s.problem.nnz = other.s.problem.nnz;
  w->s.problem.Atv = NULL;
}

static void find(steif_context *ctx, const struct net *w, const char *method,
                 const steif_options *o, const steif_functional *of, steif_gradient *g)
{
  const int code = steif_gradient_find(ctx, &w->s.problem, method, o, of, g);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
}

/* w . S of the run forward, that of the same storage, against the gradient of w . y(T). */
static double apart(steif_context *ctx, const struct net *w, const char *method,
                    steif_options o, const steif_gradient *g)
{
  o.sensitivities = 1;
  steif_solver *forward = steif_solver_new(ctx, &w->s.problem, method, &o);
  const int code = forward ? steif_solve_to(forward, o.t1) : steif_status(ctx);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  N_Vector S = N_VClone(steif_solution(forward));
  double most = 0;
  for (int k = 0; k < g->parameters; k++) {
    sunrealtype sum;
    CHECK(steif_sensitivity(forward, o.t1, k, S) == STEIF_OK);
    weighted_sum(o.t1, S, &sum, NULL);
    most = fmax(most, fabs(sum - g->dp[k]) / fmax(fabs(sum), N_VMaxNorm(S)));
  }
  N_VDestroy(S);
  steif_solver_free(&forward);
  return most;
}

/* Prescribed steps: to what the sweeps forward leave. */
static void duality(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (enum kind kind = 0; kind < KINDS; kind++)
    for (int m = 0; m < METHODS; m++) {
      struct net w;
      steif_options o;
      steif_gradient g = {0};
      make(kind, &w, &o);
      o.h = 0.0625, o.t1 = 1, o.newton = 1e-8;
      if (!strcmp(methods[m], "bdf")) o.h = 0, o.rtol = 1e-7;
      if (kind >= MASS && !strcmp(methods[m], "dirk:esdirk43")) continue; /* begins with y' */
      find(ctx, &w, methods[m], &o, &J, &g);
      const double e = apart(ctx, &w, methods[m], o, &g), most = o.h > 0 ? 1e-13 : 1e-9;
      if (e > most) printf("\n  %s %s: %.2e", kinds[kind], methods[m], e);
      CHECK(e <= most);
      steif_gradient_free(ctx, &g);
    }
  steif_context_free(&ctx);
}

/* GMRES against factors: the same equations, chosen steps that differ by what Newton's iteration leaves. */
static void as_with_factors(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int mass = 0; mass < 3; mass++)
    for (int m = 0; m < METHODS; m++) {
      struct net w, sparse;
      steif_options o;
      steif_gradient g = {0}, other = {0};
      if (mass && !strcmp(methods[m], "dirk:esdirk43")) continue;
      make(mass == 2 ? GROWING : mass ? MASS : PRECONDITIONED, &w, &o);
      net_products(&sparse), net_matrices(&sparse);
      if (mass) net_mass(&sparse, mass == 2);
      o.h = 0.0625, o.t1 = 1, o.newton = 1e-8;
      find(ctx, &w, methods[m], &o, &both, &g);
      find(ctx, &sparse, methods[m], &o, &both, &other);
      const double most = 1e-9;
      for (int k = 0; k < 3; k++) CLOSE_FLOOR(g.dp[k], other.dp[k], most, fabs(other.dp[2]));
      for (int i = 0; i < NET_N; i++) CLOSE_FLOOR(g.dy0[i], other.dy0[i], most, 1);
      CLOSE(g.value[0], other.value[0], most);
      steif_gradient_free(ctx, &g), steif_gradient_free(ctx, &other);
    }
  steif_context_free(&ctx);
}

/* What P serves forward and back is the same memory: steps made again leave no trace. */
static void bit_for_bit(void)
{
  steif_context *ctx = steif_context_new(NULL);
  static const char *const some[] = {"radau:s=3", "gauss:s=2", "bdf", "dirk:hw43"};
  for (enum kind kind = 0; kind < KINDS; kind++)
    for (int m = 0; m < 4; m++) {
      struct net w;
      steif_options o;
      steif_gradient all = {0}, few = {.checkpoints = 3}, more = {.checkpoints = 6};
      make(kind, &w, &o);
      o.rtol = 1e-3, o.t1 = 0.3;
      find(ctx, &w, some[m], &o, &both, &all), find(ctx, &w, some[m], &o, &both, &few);
      find(ctx, &w, some[m], &o, &both, &more);
      CHECK(few.cost.recomputed_steps > few.cost.steps || few.cost.steps < 9);
      CHECK(all.value[0] == few.value[0] && all.value[0] == more.value[0]);
      CHECK(!memcmp(all.dp, few.dp, 3 * sizeof *all.dp));
      CHECK(!memcmp(all.dp, more.dp, 3 * sizeof *all.dp));
      CHECK(!memcmp(all.dy0, few.dy0, NET_N * sizeof *all.dy0));
      steif_gradient_free(ctx, &all), steif_gradient_free(ctx, &few);
      steif_gradient_free(ctx, &more);
    }
  steif_context_free(&ctx);
}

/* Second derivatives by products at points that move, against those of matrices. */
static void hessians(void)
{
  static const sunrealtype v[3] = {1, -0.5, 0.01};
  steif_context *ctx = steif_context_new(NULL);
  for (int mass = 0; mass < 2; mass++)
    for (int m = 0; m < METHODS; m++) {
      sunrealtype H[2][3], G[2][NET_N];
      if (mass && !strcmp(methods[m], "dirk:esdirk43")) continue;
      if (!strcmp(methods[m], "bdf")) continue;
      for (int sparse = 0; sparse < 2; sparse++) {
        struct net w;
        steif_options o;
        steif_gradient g = {0};
        make(mass ? MASS : PRECONDITIONED, &w, &o);
        if (sparse) net_products(&w), net_matrices(&w);
        if (sparse && mass) net_mass(&w, 0);
        o.h = 0.0625, o.t1 = 0.5, o.newton = 1e-8;
        steif_direction *d = steif_direction_new(ctx, &w.s.problem, v, NULL);
        const int code =
          steif_hessian_product(ctx, d, methods[m], &o, &both, &g, H[sparse], G[sparse]);
        if (code) printf("\n  %s: %s", methods[m], steif_message(ctx));
        CU_ASSERT_FATAL(code == STEIF_OK);
        steif_direction_free(&d);
        steif_gradient_free(ctx, &g);
      }
      for (int k = 0; k < 3; k++) CLOSE_FLOOR(H[0][k], H[1][k], 1e-8, fabs(H[1][2]));
      for (int i = 0; i < NET_N; i++) CLOSE_FLOOR(G[0][i], G[1][i], 1e-8, 1);
    }
  steif_context_free(&ctx);
}

/* ---- what fails ----------------------------------------------------------------------------------- */

static void failing_requests(void)
{
  static const char *const some[] = {"radau:s=3", "bdf", "dirk:hw43"};
  for (enum kind kind = 0; kind < MASS; kind++)
    for (int m = 0; m < 3; m++) {
      struct net w;
      steif_options o;
      make(kind, &w, &o);
      o.h = 0.05, o.t1 = 0.1;
      requests_fail(&w.s.problem, some[m], &o, &J, 0);
    }
}

/* The k-th call of each kind fails, forward or back, for good or (> 0) for this step. */
static void failing_calls(void)
{
  static const enum net_call which[] = {NET_AV,    NET_ATV,   NET_ETV,
                                        NET_SETUP, NET_SOLVE, NET_TURNED};
  static const char *const some[] = {"radau:s=3", "bdf:p=2", "dirk:hw43"};
  static const long at[] = {1, 2, 9, 40};
  for (int m = 0; m < 3; m++)
    for (int c = 0; c < 6; c++)
      for (int k = 0; k < 8; k++) {
        steif_context *ctx = steif_context_new(NULL);
        struct net w;
        steif_options o;
        steif_gradient g = {0};
        make(MASS, &w, &o);
        o.rtol = 1e-4, o.t1 = 0.5, o.h = 0.05;
        w.stop = which[c], w.at = at[k % 4], w.returned = k < 4 ? -7 : 5;
        const int code = steif_gradient_find(ctx, &w.s.problem, some[m], &o, &J, &g);
        const bool back = which[c] == NET_ATV || which[c] == NET_ETV || which[c] == NET_TURNED;
        const bool reached = w.calls >= w.at;
        if (reached && (k < 4 || back)) {
          CHECK(code == STEIF_CALLBACK);
          const char *said = steif_message(ctx);
          const bool told = strstr(said, k < 4 ? "-7" : "returned 5") != NULL;
          if (code != STEIF_CALLBACK || !told)
            printf("\n  %s, call %d, %ld: %d %s", some[m], (int)which[c], w.at, code, said);
          CHECK(told);
        }
        CHECK(!back || reached || code == STEIF_OK);
        CHECK((code == STEIF_OK) == (g.value != NULL));
        steif_gradient_free(ctx, &g);
        steif_context_free(&ctx);
      }
}

static int nothing(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
                   sunrealtype c, sunrealtype delta, void *user)
{
  (void)t, (void)y, (void)yp, (void)r, (void)b, (void)c, (void)delta, (void)user;
  N_VConst(0, z);
  return 0;
}

static void refusal(const struct net *w, const steif_options *o, int expected, const char *word)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_gradient g = {0};
  const int code = steif_gradient_find(ctx, &w->s.problem, "radau:s=3", o, &J, &g);
  if (code != expected || !strstr(steif_message(ctx), word))
    printf("\n  %d: %s", code, steif_message(ctx));
  CHECK(code == expected && strstr(steif_message(ctx), word) != NULL);
  CHECK(g.value == NULL && g.dp == NULL && g.dy0 == NULL);
  steif_context_free(&ctx);
}

static void refused(void)
{
  static const sunrealtype v[3] = {1, 0, 0};
  struct net w;
  steif_options o;
  make(PLAIN, &w, &o);
  o.h = 0.1, o.t1 = 0.5;
  w.s.problem.Atv = NULL;
  refusal(&w, &o, STEIF_UNSUPPORTED, "give .Atv");
  make(MASS, &w, &o);
  o.h = 0.1, o.t1 = 0.5;
  w.s.problem.Etv = NULL;
  refusal(&w, &o, STEIF_UNSUPPORTED, "give .Etv");
  w.s.problem.Atv = NULL;
  refusal(&w, &o, STEIF_UNSUPPORTED, "give .Atv and .Etv");
  make(PRECONDITIONED, &w, &o);
  o.h = 0.1, o.t1 = 0.5;
  w.s.problem.precsolve_transposed = nothing; /* of rank 0 */
  refusal(&w, &o, STEIF_NO_CONVERGENCE, "transposed preconditioner");
  make(PRECONDITIONED, &w, &o);
  w.s.problem.Av = NULL;
  steif_context *ctx = steif_context_new(NULL);
  steif_direction *d = steif_direction_new(ctx, &w.s.problem, v, NULL);
  steif_gradient g = {0};
  sunrealtype H[3];
  CHECK(steif_hessian_product(ctx, d, "radau:s=3", &o, &J, &g, H, NULL) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "give .Av") != NULL);
  steif_direction_free(&d);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_operators[] = {{"forward and back", duality},
                                    {"as with factors", as_with_factors},
                                    {"bit for bit", bit_for_bit},
                                    {"second derivatives", hessians},
                                    {"failing requests for memory", failing_requests},
                                    {"failing calls", failing_calls},
                                    {"refused with a sentence", refused},
                                    CU_TEST_INFO_NULL};
