/* test_hidden_breaks.c: unknowns of index 2 and 3, recomputed from differences of F in t, at breaks of the problem and
 * beside them, where their closed forms jump: one side never tells of the other.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/solver.h>

static steif_context *ctx;

/* -- x' = u, 0 = x - g(t): u = g' --------------------------------------------------------------- */

enum { MOST = 4 };
/* g' = cos t + the sum of kinks where t is after breaks[i]. */
typedef struct force {
  int count;
  double at[MOST], kink[MOST], shift;
} force;

static double g(const force *k, double t)
{
  double sum = sin(t);
  for (int i = 0; i < k->count; i++) sum += t > k->at[i] ? k->kink[i] * (t - k->at[i]) : 0;
  return sum;
}

/* after: the time is a break, and what follows is asked for. */
static double slope(const force *k, double t, int after)
{
  double sum = cos(t);
  for (int i = 0; i < k->count; i++)
    sum += t > k->at[i] || (after && t == k->at[i]) ? k->kink[i] : 0;
  return sum;
}

static int follows(sunrealtype t, N_Vector Y, N_Vector Yp, N_Vector R, void *user)
{
  const double *y = N_VGetArrayPointer(Y), *d = N_VGetArrayPointer(Yp);
  double *F = N_VGetArrayPointer(R);
  F[0] = d[0] - y[1];
  F[1] = y[0] - g(user, t);
  return 0;
}

static const int two[] = {1, 2};
static double begin_two[] = {0, 1};

/* -- index 3: x' = v, v' = l, 0 = x - G, G'' = g' - cos t + sin t: v kinks, l jumps ---------------- */

static double twice(const force *k, double t)
{
  double sum = -sin(t);
  for (int i = 0; i < k->count; i++)
    sum += t > k->at[i] ? k->kink[i] * pow(t - k->at[i], 2) / 2 : 0;
  return sum;
}

static double bend(const force *k, double t, int after)
{
  return slope(k, t, after) - cos(t) + sin(t);
}

static int driven(sunrealtype t, N_Vector Y, N_Vector Yp, N_Vector R, void *user)
{
  const double *y = N_VGetArrayPointer(Y), *d = N_VGetArrayPointer(Yp);
  double *F = N_VGetArrayPointer(R);
  F[0] = d[0] - y[1];
  F[1] = d[1] - y[2];
  F[2] = y[0] - twice(user, t);
  return 0;
}

static const int three[] = {1, 2, 3};
static double begin_three[] = {0, -1, 0};

/* -- a mass on a circle that turns at the rate w = 1 + sum kinks (t - breaks): tangential forces jump, and the force of the
 * rod w^2 kinks. x = (cos a, sin a), a' = w, x'' = -l x + w' (-sin a, cos a), 0 = x^2 - 1. --------------- */

static double rate(const force *k, double t, int after)
{
  double sum = 1;
  (void)after;
  for (int i = 0; i < k->count; i++) sum += t > k->at[i] ? k->kink[i] * (t - k->at[i]) : 0;
  return sum;
}

static double tension(const force *k, double t, int after) { return pow(rate(k, t, after), 2); }

static int turned(sunrealtype t, N_Vector Y, N_Vector Yp, N_Vector R, void *user)
{
  const double *y = N_VGetArrayPointer(Y), *d = N_VGetArrayPointer(Yp);
  double *F = N_VGetArrayPointer(R);
  const double push = slope(user, t, 0) - cos(t);
  F[0] = d[0] - y[2];
  F[1] = d[1] - y[3];
  F[2] = d[2] + y[4] * y[0] + push * y[1];
  F[3] = d[3] + y[4] * y[1] - push * y[0];
  F[4] = y[0] * y[0] + y[1] * y[1] - 1;
  return 0;
}

static const int of_circle[] = {1, 1, 2, 2, 3};
static double begin_circle[] = {1, 0, 0, 1, 1};

static steif_problem of(const char *name, force *k, int n, double *y0, const int *index,
                        steif_residual F)
{
  return (steif_problem){.name = name,
                         .n = n,
                         .t1 = 2,
                         .y0 = y0,
                         .F = F,
                         .index = index,
                         .user = k,
                         .breaks = k->at,
                         .break_count = k->count};
}

/* -- what is shown ------------------------------------------------------------------------------ */

static const char *const methods[] = {"radau:s=2", "radau:s=3", "bdf"};

/* told: may it be said that nothing was recomputed? */
static void compare(const steif_problem *p, const char *method, double rtol, double t,
                    double right, int told)
{
  const double few = 5;
  const steif_options o = {.rtol = rtol, .atol = rtol, .recompute = 1};
  steif_solver *s = steif_solver_new(ctx, p, method, &o);
  const int code = s ? steif_solve_to(s, t) : steif_status(ctx);
  sunrealtype drift = NAN;
  CU_ASSERT_FATAL(!code && !steif_recomputed(s, &drift, NULL));
  const double u = NV_Ith_S(steif_solution(s), p->n - 1);
  const double off = fabs(u - right) / (rtol * (1 + fabs(right)));
  const int good = isfinite(drift) ? off <= few : told;
  if (!good)
    printf("\n  %s, %s, %g, t = %.17g: %.12g, right %.12g, %.3g tolerances, drift %g", p->name,
           method, rtol, t, u, right, off, drift);
  CHECK(good);
  steif_solver_free(&s);
}

static void beside(const steif_problem *p, double t,
                   double (*right)(const force *, double, int))
{
  const double away[] = {0, 1e-12, 1e-6, 1e-3};
  for (int m = 0; m < 3; m++)
    for (double rtol = 1e-3; rtol > 1e-9; rtol *= 1e-2)
      for (int i = 0; i < 4; i++)
        for (int sign = -1; sign < (i ? 2 : 1); sign += 2) {
          const double at = t * (1 + sign * away[i]);
          compare(p, methods[m], rtol, at, right(p->user, at, at < p->t1), 0);
        }
}

static steif_problem of_two(force *k) { return of("two", k, 2, begin_two, two, follows); }

static steif_problem of_three(force *k)
{
  return of("three", k, 3, begin_three, three, driven);
}

static steif_problem of_five(force *k)
{
  return of("circle", k, 5, begin_circle, of_circle, turned);
}

static void at_one_break(void)
{
  force k = {.count = 1, .at = {1}, .kink = {1}};
  const steif_problem p = of_two(&k), q = of_three(&k), r = of_five(&k);
  ctx = steif_context_new(NULL);
  beside(&p, 1, slope);
  beside(&q, 1, bend);
  beside(&r, 1, tension);
  steif_context_free(&ctx);
}

/* Where the last time is a break, what holds before it is shown. */
static void at_the_end(void)
{
  force k = {.count = 1, .at = {2}, .kink = {1}};
  const steif_problem p = of_two(&k), q = of_three(&k);
  ctx = steif_context_new(NULL);
  for (int m = 0; m < 3; m++) {
    compare(&p, methods[m], 1e-6, 2, slope(&k, 2, 0), 0);
    compare(&q, methods[m], 1e-6, 2, bend(&k, 2, 0), 0);
  }
  steif_context_free(&ctx);
}

/* Parts too short for differences have what the step has, and it is told. */
static void crowded(void)
{
  static const double gaps[] = {1e-2, 1e-4, 1e-6, 1e-8, 1e-12};
  ctx = steif_context_new(NULL);
  for (int i = 0; i < 5; i++) {
    const double d = gaps[i];
    force k = {.count = 3, .at = {1, 1 + d, 1 + 2.5 * d}, .kink = {1, -3, 2}};
    const double t[] = {1 - d, 1, 1 + d / 3, 1 + d, 1 + 1.5 * d, 1 + 2.5 * d, 1 + 3 * d, 1.5};
    const steif_problem p = of_two(&k), q = of_three(&k);
    for (int m = 0; m < 3; m++)
      for (int j = 0; j < 8; j++) {
        compare(&p, methods[m], 1e-6, t[j], slope(&k, t[j], 1), j > 0 && j < 5 && d < 1e-5);
        const int hard = j > 0 && (j < 5 || (j < 7 && d < 1e-9)) && d < 1e-3;
        compare(&q, methods[m], 1e-6, t[j], bend(&k, t[j], 1), hard);
      }
  }
  steif_context_free(&ctx);
}

/* At the end of a step the observer sees what holds before a break. */
static double before_break;

static int look(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  N_Vector out = N_VClone(y);
  if (t == 1 && out && !steif_output(s, t, out)) before_break = NV_Ith_S(out, 1);
  if (out) N_VDestroy(out);
  (void)user;
  return 0;
}

static void observed(void)
{
  force k = {.count = 1, .at = {1}, .kink = {1}};
  const steif_problem p = of_two(&k);
  const steif_options o = {.rtol = 1e-6, .atol = 1e-6, .recompute = 1, .observe = look};
  ctx = steif_context_new(NULL);
  steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
  sunrealtype error = NAN;
  before_break = NAN;
  CU_ASSERT_FATAL(s && !steif_solve_to(s, 1));
  CLOSE(before_break, slope(&k, 1, 0), 2e-6);
  CLOSE(NV_Ith_S(steif_solution(s), 1), slope(&k, 1, 1), 2e-6);
  CHECK(!steif_hidden_error(s, &error) && error < 5);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_hidden_breaks[] = {{"at one break", at_one_break},
                                        {"at the end", at_the_end},
                                        {"crowded", crowded},
                                        {"observed", observed},
                                        CU_TEST_INFO_NULL};
