/* test_differences.c: gradients of large and higher-index problems against differences of runs on the same mesh.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subjects.h"
#include <stdlib.h>
#include <steif/data.h>

typedef struct mesh {
  sunrealtype t[4000];
  size_t count;
} mesh;

static int note(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  mesh *m = user;
  (void)s, (void)y;
  CU_ASSERT_FATAL(m->count < 4000);
  if (m->count == 0 || t > m->t[m->count - 1]) m->t[m->count++] = t;
  return 0;
}

static const steif_functional J = {
  .count = 1, .integrand = weighted_sum, .end = weighted_sum, .slopes = weighted_slopes};

static int set(steif_context *ctx, steif_problem *p, int k, sunrealtype x)
{
  const steif_parameters *q = p->parameters;
  if (q->name) return steif_model_set(ctx, p, q->name[k], x);
  q->value[k] = x;
  return STEIF_OK;
}

static sunrealtype size_of(const steif_problem *p, int k)
{
  return p->parameters->scale ? p->parameters->scale[k] : p->parameters->value[k];
}

/* The value with p_k moved by d, and where g is given the gradient. */
static sunrealtype value(steif_context *ctx, steif_problem *p, const char *method,
                         const steif_options *o, int k, sunrealtype d, steif_gradient *g)
{
  steif_gradient own = {0};
  const sunrealtype here = p->parameters->value[k];
  CU_ASSERT_FATAL(d == 0 || !set(ctx, p, k, here + d));
  const int code = steif_gradient_find(ctx, p, method, o, &J, &own);
  if (code) printf("\n  %s: %s", p->name, steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  CU_ASSERT_FATAL(d == 0 || !set(ctx, p, k, here));
  const sunrealtype J0 = own.value[0];
  if (g)
    *g = own;
  else
    steif_gradient_free(ctx, &own);
  return J0;
}

/* Parameters in `list`, differences with d p_k and half of it, extrapolated; `error`: of the largest p dJ/dp. */
static void differ(steif_context *ctx, steif_problem *p, const char *method, sunrealtype rtol,
                   sunrealtype t1, const char *list, sunrealtype d, sunrealtype error)
{
  mesh *m = calloc(1, sizeof *m);
  steif_options o = steif_defaults();
  steif_gradient g = {0};
  sunrealtype size = 0;
  CU_ASSERT_FATAL(m != NULL);
  o.rtol = rtol, o.t1 = t1, o.observe = note, o.observer = m;
  o.initial = p->index && !p->parameters->name ? STEIF_AS_GIVEN : STEIF_REPAIR;
  note(NULL, p->t0, NULL, m);
  steif_solver *s = steif_solver_new(ctx, p, method, &o);
  CU_ASSERT_FATAL(s && steif_solve_to(s, t1) == STEIF_OK);
  steif_solver_free(&s);
  int active[32], actives = 0;
  for (int k = 0; list[k]; k++)
    if (list[k] != '.') active[actives++] = k;
  o.active = active, o.active_count = actives;
  o.observe = NULL, o.mesh = m->t, o.mesh_size = m->count, o.newton = 1e-6;
  value(ctx, p, method, &o, 0, 0, &g);
  for (int k = 0; k < g.parameters; k++)
    if (list[k] != '.') size = fmax(size, fabs(g.dp[k] * size_of(p, k)));
  for (int k = 0; k < g.parameters; k++) {
    const sunrealtype pk = size_of(p, k), x = d * pk;
    CHECK((list[k] == '.') == isnan(g.dp[k]));
    if (list[k] == '.') continue;
    const sunrealtype quotient =
      (8 * value(ctx, p, method, &o, k, x / 2, NULL) -
       8 * value(ctx, p, method, &o, k, -x / 2, NULL) - value(ctx, p, method, &o, k, x, NULL) +
       value(ctx, p, method, &o, k, -x, NULL)) /
      (6 * x);
    CLOSE_FLOOR(g.dp[k] * pk, quotient * pk, error, size);
  }
  steif_gradient_free(ctx, &g);
  free(m);
}

static void parsed(steif_context *ctx, const char *text, steif_problem *p)
{
  const int code = steif_model_parse(ctx, text, "model", NULL, p);
  if (code) printf("\n  %s", steif_message(ctx));
  CU_ASSERT_FATAL(!code);
}

/* ---- index 3 ---------------------------------------------------------------------------------------- */

/* As posed, from rest; m1 and m2 act by their ratio only. */
static const char two_rods[] =
  "param L1 = 1, L2 = 0.75, m1 = 1, m2 = 0.5, g = 9.81\n"
  "state x1 = L1, y1 = 0, x2 = L1 + 0.6*L2, y2 = -0.8*L2\n"
  "state u1 = 0, v1 = 0, u2 = 0, v2 = 0, a1 ~ 0, a2 ~ 0\n"
  "x1' = u1\ny1' = v1\nx2' = u2\ny2' = v2\n"
  "m1*u1' = -a1*x1 + a2*(x2 - x1)\nm1*v1' = -a1*y1 + a2*(y2 - y1) - m1*g\n"
  "m2*u2' = -a2*(x2 - x1)\nm2*v2' = -a2*(y2 - y1) - m2*g\n"
  "0 = x1^2 + y1^2 - L1^2\n0 = (x2 - x1)^2 + (y2 - y1)^2 - L2^2\ntime 0 to 1\n";

static int some(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 2), g[1] = NV_Ith_S(y, 7);
  return 0;
}

static int multiplier(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 9);
  return 0;
}

/* x2(1), v2(1) and the integral of the second multiplier by L1, L2, m1, m2, g: own Radau IIA codes of 113 bits, index 1
 * and index 3 agree. */
static void double_pendulum(void)
{
  static const sunrealtype end[2][5] = {
    {-0.7718272484943, -0.7993000191453, -0.2026724288877, 0.4053448577754, -0.005097819960077},
    {4.877556515609, 6.079567368021, 1.580173038033, -3.160346076065, -0.4532480700247}};
  static const sunrealtype integral[] = {0.9205764922071, -20.16186196021, 2.678089941674,
                                         23.84387547942, 1.447586134348};
  const steif_functional ends = {.count = 2, .end = some},
                         pull = {.count = 1, .integrand = multiplier};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  o.rtol = 1e-10;
  parsed(ctx, two_rods, &p);
  steif_gradient a = {0}, b = {0};
  CU_ASSERT_FATAL(!steif_gradient_find(ctx, &p, "radau:s=5", &o, &ends, &a));
  CU_ASSERT_FATAL(!steif_gradient_find(ctx, &p, "radau:s=5", &o, &pull, &b));
  for (int k = 0; k < 5; k++) {
    CLOSE(a.dp[k], end[0][k], 1e-6);
    CLOSE(a.dp[5 + k], end[1][k], 1e-6);
    CLOSE(b.dp[k], integral[k], 1e-6);
  }
  CLOSE(b.value[0], 14.600027681382, 1e-8);
  steif_gradient_free(ctx, &a), steif_gradient_free(ctx, &b);
  differ(ctx, &p, "radau:s=3", 1e-5, 1, "L....", 2e-3, 1e-7);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Of the parameters L0 and M, which starts do not depend on. */
static void car_axis(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, EXAMPLES "/caraxis.steif", &p));
  differ(ctx, &p, "radau:s=3", 1e-5, 0.25, ".L.M..", 1e-3, 1e-7);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* IDAS' example of a slider-crank, stabilised (index 2): the integral of its kinetic energy to 10 by k and c, in 113 bits. */
static const char crank[] =
  "param k = 1, c = 1, a = 0.5, J1 = 1, m2 = 1, J2 = 2, l0 = 1, F = 1\n"
  "state q = 1.5707963267948966, x ~ 0.86602540378443865, p ~ -0.52359877559829887\n"
  "state qd = 0, xd = 0, pd = 0, r, s, mu, nu\n"
  "let s21 = sin(p - q)\n"
  "let l = sqrt(x^2 - x*(cos(p) + a*cos(q)) + (1 + a^2)/4 + a*cos(p - q)/2)\n"
  "let ld = (2*x*xd - xd*(cos(p) + a*cos(q)) + x*(sin(p)*pd + a*sin(q)*qd)"
  " - a*s21*(pd - qd)/2)/(2*l)\n"
  "let f = (k*(l - l0) + c*ld)/l\n"
  "q' = qd - a*sin(q)*mu + a*cos(q)*nu\nx' = xd - mu\np' = pd - sin(p)*mu + cos(p)*nu\n"
  "J1*qd' = -f*a*(s21/2 + x*sin(q))/2 - a*sin(q)*r + a*cos(q)*s\n"
  "m2*xd' = f*(cos(p)/2 - x + a*cos(q)/2) + F - r\n"
  "J2*pd' = -f*(x*sin(p) - a*s21/2)/2 - F*sin(p) - sin(p)*r + cos(p)*s\n"
  "x - cos(p) - a*cos(q) = 0\n-sin(p) - a*sin(q) = 0\n"
  "a*sin(q)*qd + xd + sin(p)*pd = 0\n-a*cos(q)*qd - cos(p)*pd = 0\ntime 0 to 10\n";

static int kinetic(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  const sunrealtype *v = NV_DATA_S(y) + 3;
  (void)t, (void)user;
  g[0] = (v[0] * v[0] + v[1] * v[1] + 2 * v[2] * v[2]) / 2;
  return 0;
}

static int momenta(sunrealtype t, N_Vector y, int i, int at_end, N_Vector dy, sunrealtype *dp,
                   void *user)
{
  const sunrealtype *v = NV_DATA_S(y) + 3;
  (void)t, (void)i, (void)at_end, (void)dp, (void)user;
  NV_Ith_S(dy, 3) = v[0], NV_Ith_S(dy, 4) = v[1], NV_Ith_S(dy, 5) = 2 * v[2];
  return 0;
}

static void slider_crank(void)
{
  static const int active[] = {0, 1};
  const steif_functional energy = {.count = 1, .integrand = kinetic, .slopes = momenta};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_gradient g = {0};
  steif_options o = steif_defaults();
  o.rtol = 1e-10, o.active = active, o.active_count = 2;
  parsed(ctx, crank, &p);
  CU_ASSERT_FATAL(!steif_gradient_find(ctx, &p, "radau:s=5", &o, &energy, &g));
  CLOSE(g.value[0], 3.33660679948278, 1e-8);
  CLOSE(g.dp[0], 0.33344810612844, 1e-8);
  CLOSE(g.dp[1], -0.36375403397095, 1e-8);
  steif_gradient_free(ctx, &g);
  differ(ctx, &p, "radau:s=3", 1e-5, 1, "kc......", 1e-3, 1e-8);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Andrews' mechanism with more torque of the motor and viscous friction of its axle. */
enum { AXLE = 7, MOTOR = 14 };
typedef struct mechanism {
  steif_problem given;
  sunrealtype p[2];
} mechanism;

static int driven(sunrealtype t, N_Vector y, N_Vector f, void *user)
{
  const mechanism *m = user;
  const int code = m->given.f(t, y, f, m->given.user);
  NV_Ith_S(f, MOTOR) += m->p[1] * NV_Ith_S(y, AXLE) - m->p[0];
  return code;
}

static int driven_by(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  (void)t, (void)yp, (void)user;
  N_VConst(0, out);
  NV_Ith_S(out, MOTOR) = k ? -NV_Ith_S(y, AXLE) : 1;
  return 0;
}

static void andrews(void)
{
  static const sunrealtype scale[] = {0.033, 1e-4};
  steif_context *ctx = steif_context_new(NULL);
  mechanism m = {.p = {0, 0}};
  const steif_parameters q = {.count = 2, .value = m.p, .scale = scale, .dFdp = driven_by};
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "andrews", &m.given));
  steif_problem p = m.given;
  p.f = driven, p.user = &m, p.parameters = &q;
  differ(ctx, &p, "radau:s=3", 1e-5, 0.01, "tf", 1e-3, 1e-7);
  steif_problem_clear(ctx, &m.given);
  steif_context_free(&ctx);
}

/* ---- circuits ----------------------------------------------------------------------------------------- */

static const char ring[] =
  "param C = 1.6e-8, Cs = 2e-12, Cp = 1e-8, R = 25000, Rp = 50, Lh = 4.45, Ls1 = 0.002\n"
  "param Ls2 = 5e-4, Ls3 = 5e-4, Rg1 = 36.3, Rg2 = 17.3, Rg3 = 17.3, Ri = 50, Rc = 600\n"
  "param gam = 40.67286402e-9, del = 17.7493332\n"
  "state U1 = 0, U2 = 0, U3 = 0, U4 = 0, U5 = 0, U6 = 0, U7 = 0\n"
  "state I1 = 0, I2 = 0, I3 = 0, I4 = 0, I5 = 0, I6 = 0, I7 = 0, I8 = 0\n"
  "let e1 = 0.5*sin(2000*pi*t), e2 = 2*sin(20000*pi*t)\n"
  "let q1 = gam*(exp(del*(U3 - U5 - U7 - e2)) - 1)\n"
  "let q2 = gam*(exp(del*(U6 - U4 - U7 - e2)) - 1)\n"
  "let q3 = gam*(exp(del*(U4 + U5 + U7 + e2)) - 1)\n"
  "let q4 = gam*(exp(del*(U7 + e2 - U3 - U6)) - 1)\n"
  "C*U1' = I1 - I3/2 + I4/2 + I7 - U1/R\nC*U2' = I2 - I5/2 + I6/2 + I8 - U2/R\n"
  "Cs*U3' = I3 - q1 + q4\nCs*U4' = -I4 + q2 - q3\nCs*U5' = I5 + q1 - q3\n"
  "Cs*U6' = -I6 - q2 + q4\nCp*U7' = -U7/Rp + q1 + q2 - q3 - q4\n"
  "Lh*I1' = -U1\nLh*I2' = -U2\nLs2*I3' = U1/2 - U3 - Rg2*I3\n"
  "Ls3*I4' = -U1/2 + U4 - Rg3*I4\nLs2*I5' = U2/2 - U5 - Rg2*I5\n"
  "Ls3*I6' = -U2/2 + U6 - Rg3*I6\nLs1*I7' = -U1 + e1 - (Ri + Rg1)*I7\n"
  "Ls1*I8' = -U2 - (Rc + Rg1)*I8\ntime 0 to 1e-3\n";

/* The ring modulator (IVP Test Set). */
static void ring_modulator(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  parsed(ctx, ring, &p);
  differ(ctx, &p, "radau:s=3", 1e-5, 4e-6, "CC.R...L..R...gd", 2e-4, 1e-8);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void transistors(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, EXAMPLES "/transamp.steif", &p));
  differ(ctx, &p, "radau:s=3", 1e-5, 0.005, "......12345", 1e-4, 1e-8);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* ---- large sparse stages: factors of few steps, against band matrices with factors of each ------------- */

static void sparse_stages(void)
{
  static const char *const methods[] = {"radau:s=3", "gauss:s=2", "bdf", "dirk:hw43"};
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    steif_gradient g[2] = {{0}, {0}};
    for (int k = 0; k < 2; k++) {
      subject_brusselator(&s, k ? STEIF_BAND : STEIF_SPARSE);
      gradient_of(ctx, &s, methods[m], 1e-9, 2, &J, &g[k]);
    }
    for (int k = 0; k < 3; k++) CLOSE(g[0].dp[k], g[1].dp[k], 1e-6);
    for (sunindextype i = 0; i < s.problem.n; i++)
      CLOSE_FLOOR(g[0].dy0[i], g[1].dy0[i], 1e-6, 0.01);
    CHECK(g[0].cost.factors < g[1].cost.factors);
    steif_gradient_free(ctx, &g[0]), steif_gradient_free(ctx, &g[1]);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_differences[] = {{"double pendulum of index 3", double_pendulum},
                                      {"car axis of index 3", car_axis},
                                      {"slider-crank of index 2", slider_crank},
                                      {"Andrews' mechanism of index 3", andrews},
                                      {"ring modulator", ring_modulator},
                                      {"transistor amplifier", transistors},
                                      {"large sparse stages", sparse_stages},
                                      CU_TEST_INFO_NULL};
