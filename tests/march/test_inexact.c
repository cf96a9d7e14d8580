/* test_inexact.c: forcing terms, complex systems on pairs, and preconditioners that serve for long: against
 * factors, and by identities between counts.
 *
 * The rod is u_t = u_xx - 5 u^2 on N points with u = 0 at the ends; its preconditioner eliminates c E - A without the
 * reaction, which is small beside c.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "smooth.h"
#include <stdlib.h>
#include <string.h>

enum { N = 50 };
static double start[N];
static struct {
  double c;
  long setups, halves, pairs;
} seen;

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const double q = (N + 1.) * (N + 1.), *u = NV_DATA_S(y);
  (void)t, (void)user;
  for (int i = 0; i < N; i++)
    NV_Ith_S(out, i) =
      q * ((i ? u[i - 1] : 0) - 2 * u[i] + (i < N - 1 ? u[i + 1] : 0)) - 5 * u[i] * u[i];
  return 0;
}

static int Av(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  const int code = f(t, x, out, user);
  (void)yp;
  for (int i = 0; i < N; i++)
    NV_Ith_S(out, i) += 5 * NV_Ith_S(x, i) * (NV_Ith_S(x, i) - 2 * NV_Ith_S(y, i));
  return code;
}

static int setup(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c, void *user)
{
  (void)t, (void)y, (void)yp, (void)r, (void)user;
  seen.setups++, seen.c = c;
  return 0;
}

static void eliminate(const double *b, double *z)
{
  const double q = (N + 1.) * (N + 1.);
  double d[N];
  for (int i = 0; i < N; i++) {
    d[i] = seen.c + 2 * q - (i ? q * q / d[i - 1] : 0);
    z[i] = b[i] + (i ? q * z[i - 1] / d[i - 1] : 0);
  }
  for (int i = N - 1; i >= 0; i--) z[i] = (z[i] + (i < N - 1 ? q * z[i + 1] : 0)) / d[i];
}

static int half(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
                sunrealtype c, sunrealtype delta, void *user)
{
  (void)t, (void)y, (void)yp, (void)r, (void)c, (void)delta, (void)user;
  seen.halves++;
  eliminate(NV_DATA_S(b), NV_DATA_S(z));
  return 0;
}

static int both(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector *b, N_Vector *z,
                sunrealtype re, sunrealtype im, sunrealtype delta, void *user)
{
  (void)t, (void)y, (void)yp, (void)r, (void)delta, (void)user;
  CHECK(im != 0 && hypot(re, im) < 2.001 * seen.c && hypot(re, im) > 0.499 * seen.c);
  seen.pairs++;
  for (int i = 0; i < 2; i++) eliminate(NV_DATA_S(b[i]), NV_DATA_S(z[i]));
  return 0;
}

static steif_problem rod(enum steif_storage storage)
{
  for (int i = 0; i < N; i++) start[i] = sin(acos(-1) * (i + 1) / (N + 1));
  memset(&seen, 0, sizeof seen);
  steif_problem p = {.name = "rod", .n = N, .t1 = 0.1, .y0 = start, .f = f, .storage = storage};
  p.lower = p.upper = 1;
  if (storage == STEIF_KRYLOV) p.Av = Av, p.precsetup = setup, p.precsolve = half;
  return p;
}

/* From the FIXED-th on with constant steps. */
static const char *const families[] = {
  "be",        "bdf",    "dirk:hw43", "radau:s=2",     "radau:s=3",   "radau:s=5",
  "gauss:s=3", "rodas4", "bdf:p=3",   "lobatto3c:s=3", "radau1a:s=3", "glm:nord22"};
enum { FAMILIES = sizeof families / sizeof *families, FIXED = 8 };

/* Counts of a run are made of whole iterations: one application more than iterations for each solve, two
 * for a pair. */
static void identities(const steif_krylov_stats *k, const steif_stats *n)
{
  const long real = k->solves - k->complex_solves,
             iterations = k->iterations - k->complex_iterations;
  CHECK(k->applications == real + iterations + 2 * (k->complex_solves + k->complex_iterations));
  CHECK(k->products == iterations + 2 * k->complex_iterations);
  CHECK(k->applications == seen.halves + 2 * seen.pairs && k->setups == seen.setups);
  CHECK(k->iterations == n->nli && k->solves == n->nsolve && k->setups == n->nlu);
}

/* Within the tolerance of the run by factors, and with its steps. */
static void as_with_factors(void)
{
  for (int m = 0; m < FAMILIES; m++)
    for (int k = 0; k < 2; k++) {
      steif_context *ctx = steif_context_new(NULL);
      steif_problem p = rod(STEIF_KRYLOV), q = rod(STEIF_BAND);
      steif_options o = steif_defaults();
      o.rtol = !k ? 1e-3 : m ? 1e-6 : 1e-4; /* be: some thousand steps */
      o.h = m >= FIXED ? 0.005 : 0;
      steif_solver *krylov = smooth_open(ctx, &p, families[m], &o),
                   *direct = smooth_open(ctx, &q, families[m], &o);
      const int failed = steif_solve_to(krylov, p.t1) || steif_solve_to(direct, p.t1);
      double off = 0;
      for (int i = 0; i < N; i++)
        off = fmax(
          off, fabs(NV_Ith_S(steif_solution(krylov), i) - NV_Ith_S(steif_solution(direct), i)));
      if (failed || !(off < o.rtol))
        printf("\n  %s, rtol %g: %.2e, %s", families[m], o.rtol, off, steif_message(ctx));
      CHECK(!failed && off < o.rtol);
      const double steps = (double)steif_statistics(direct)->steps;
      CHECK((double)steif_statistics(krylov)->steps < 1.3 * steps + 2);
      identities(steif_krylov_statistics(krylov), steif_statistics(krylov));
      CHECK(steif_krylov_statistics(direct)->iterations == 0);
      steif_solver_free(&krylov), steif_solver_free(&direct);
      steif_context_free(&ctx);
    }
}

/* With an exact real preconditioner: the chord from s/|s| to 1 takes 2 or 3 iterations for nine tenths. */
static void few_iterations(void)
{
  static const char *const methods[] = {"radau:s=2", "radau:s=3", "radau:s=5", "gauss:s=2"};
  for (int m = 0; m < 4; m++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p = rod(STEIF_KRYLOV);
    steif_options o = steif_defaults();
    o.rtol = 1e-5;
    steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
    CHECK(!steif_solve_to(s, p.t1));
    const steif_krylov_stats *k = steif_krylov_statistics(s);
    CHECK(k->complex_solves > 0 && 2 * k->complex_iterations <= 5 * k->complex_solves);
    CHECK(k->reductions <= 2 * k->iterations + 6 * steif_statistics(s)->steps + 60);
    CHECK(k->setups <= steif_statistics(s)->steps);
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

/* A preconditioner of pairs that does the same gives the same bits. */
static void pairs_are_halves(void)
{
  double end[2][N];
  for (int k = 0; k < 2; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p = rod(STEIF_KRYLOV);
    if (k) p.precsolve_pair = both;
    steif_solver *s = smooth_open(ctx, &p, "radau:s=3", NULL);
    CHECK(!steif_solve_to(s, p.t1));
    CHECK(k ? seen.pairs > 0 : seen.pairs == 0);
    identities(steif_krylov_statistics(s), steif_statistics(s));
    memcpy(end[k], NV_DATA_S(steif_solution(s)), sizeof end[k]);
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
  for (int i = 0; i < N; i++) CLOSE_FLOOR(end[0][i], end[1][i], 1e-5, 1e-3);
}

/* Steps h and h / 2 against ones far shorter: order 2 s - 1. */
static void order_is_kept(void)
{
  double end[3][N], error[2] = {0};
  for (int k = 0; k < 3; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p = rod(STEIF_KRYLOV);
    steif_options o = steif_defaults();
    p.t0 = 0, o.h = k == 0 ? 0.02 : k == 1 ? 0.01 : 0.00125;
    steif_solver *s = smooth_open(ctx, &p, "radau:s=2", &o);
    CHECK(!steif_solve_to(s, p.t1));
    memcpy(end[k], NV_DATA_S(steif_solution(s)), sizeof end[k]);
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < N; i++) error[k] = fmax(error[k], fabs(end[k][i] - end[2][i]));
  const double order = log2(error[0] / error[1]);
  CHECK(order > 2.6 && order < 3.4);
}

static int descend(steif_context *c)
{
  steif_problem p = rod(STEIF_KRYLOV);
  p.precsolve_pair = both;
  steif_options o = steif_defaults();
  o.rtol = 1e-3, o.t1 = 1e-3;
  steif_solver *s = steif_solver_new(c, &p, "radau:s=3", &o);
  const int code = s ? steif_solve_to(s, o.t1) : steif_status(c);
  steif_solver_free(&s);
  return code;
}

static void short_memory(void)
{
  int code = STEIF_NO_MEMORY;
  long k = 0;
  while (code == STEIF_NO_MEMORY && k < 2000) {
    failing fails = {.refuse_at = ++k};
    const steif_setup given = failing_setup(&fails);
    steif_context *c = steif_context_new(&given);
    code = c ? descend(c) : STEIF_NO_MEMORY;
    steif_context_free(&c);
    CHECK(fails.alive == 0);
  }
  CHECK(code == STEIF_OK && k > 40);
}

CU_TestInfo tests_of_inexact[] = {
  {"all families as with factors; counts are whole iterations", as_with_factors},
  {"complex systems take few iterations, all take few sums", few_iterations},
  {"preconditioners of pairs", pairs_are_halves},
  {"the order is kept", order_is_kept},
  {"short memory with complex systems", short_memory},
  CU_TEST_INFO_NULL,
};
