/* method_orders.c: weak orders of methods as h tends to 0, by runs in many digits on canonical systems.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "exact_run.h"
#include "verdict_case.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const asked_method asked[] = {{"be", NULL, STEIF_R},
                                     {"be", NULL, STEIF_P},
                                     {"be", "cq", STEIF_C},
                                     {"bdf:p=2", "cq", STEIF_C},
                                     {"bdf:p=3", "cq", STEIF_C},
                                     {"bdf:p=4", "cq", STEIF_C},
                                     {"bdf:p=2", "ramp", STEIF_R},
                                     {"bdf:p=2", "constant", STEIF_R},
                                     {"bdf:p=3", "constant", STEIF_R},
                                     {"radau:s=2", NULL, STEIF_STAGE},
                                     {"radau:s=3", NULL, STEIF_STAGE},
                                     {"radau:s=4", NULL, STEIF_STAGE},
                                     {"radau:s=2", NULL, STEIF_R},
                                     {"gauss:s=1", NULL, STEIF_STAGE},
                                     {"gauss:s=2", NULL, STEIF_STAGE},
                                     {"gauss:s=3", NULL, STEIF_STAGE},
                                     {"radau1a:s=2", NULL, STEIF_STAGE},
                                     {"radau1a:s=3", NULL, STEIF_STAGE},
                                     {"lobatto3c:s=2", NULL, STEIF_STAGE},
                                     {"lobatto3c:s=3", NULL, STEIF_STAGE},
                                     {"dirk:alexander2", NULL, STEIF_STAGE},
                                     {"dirk:alexander2b", NULL, STEIF_STAGE},
                                     {"dirk:alexander3", NULL, STEIF_STAGE},
                                     {"dirk:crouzeix23", NULL, STEIF_STAGE},
                                     {"dirk:hw43", NULL, STEIF_STAGE}};

const asked_method *asked_method_at(int i)
{
  return i >= 0 && i < (int)(sizeof asked / sizeof *asked) ? asked + i : NULL;
}

int canonical_run(steif_context *ctx, int method, const steif_linear *plain,
                  const sunrealtype *z0, int index, const stf_weight *g, double h, size_t steps,
                  long double *z)
{
  const asked_method *a = asked_method_at(method);
  const int n = (int)SM_ROWS_D(plain->E), limbs = stf_exact_limbs(index, steps);
  stf_real sum[SYSTEM_MOST] = {0};
  stf_spline spline;
  stf_exact_run r = {.of = {.ctx = ctx,
                            .linear = plain,
                            .method = a->method,
                            .start = a->start,
                            .x0 = z0,
                            .n = n,
                            .h = h,
                            .steps = steps},
                     .limbs = limbs,
                     .g = &spline,
                     .convention = a->convention,
                     .solved = a->start && !strcmp(a->start, "cq"),
                     .h = stf_real_of(h),
                     .sum = sum};
  int code = stf_spline_open(g, stf_smooth(index), limbs, false, &spline);
  if (!code) code = stf_exact_run_make(&r);
  for (int m = 0; m < n && !code; m++) z[m] = stf_real_value(sum + m);
  stf_spline_close(ctx, &spline);
  return code;
}

/* (1 - t)^14: not 0 in any derivative that matters. */
static int steep(long double t, int order, long double *c, void *user)
{
  enum { n = 14 };
  long double binomial = 1;
  (void)user;
  for (int j = 0; j <= order; j++) {
    c[j] = j > n ? 0 : (j % 2 ? -binomial : binomial) * powl(1 - t, n - j);
    binomial = binomial * (n - j) / (j + 1);
  }
  return 0;
}

#define NONE 1e-13L /* of the largest value: what the quadrature leaves of errors that are 0 */
#define SEEN 1e-10L /* likewise: an error that is not */
#define SAME 0.15   /* orders on both sides of a row that are one */
#define WHOLE 0.1 /* which is a whole number in the end: further from one it is not seen yet */

/* The order that errors at h, h / 2 and h / 4 show; infinite: they are 0; NAN: not known. */
static double order_of(const long double error[3], long double size)
{
  if (error[1] <= NONE * size && error[2] <= NONE * size) return INFINITY;
  if (error[2] <= SEEN * size) return NAN;
  const double before = (double)log2l(error[0] / error[1]),
               after = (double)log2l(error[1] / error[2]);
  const bool same = fabs(before - after) <= SAME, seen = fabs(after - round(after)) <= WHOLE;
  return same && seen ? after : (double)NAN;
}

/* Largest error of the components at 1/h = steps. */
static int error_at(steif_context *ctx, int method, planted_system *s, int component,
                    const stf_weight *g, size_t steps, long double *error, long double *size)
{
  long double made[SYSTEM_MOST], z[SYSTEM_MOST], c[SYSTEM_MOST * SYSTEM_MOST];
  STEIF_TRY(
    canonical_run(ctx, method, &s->plain, s->z0, s->index, g, 1 / (double)steps, steps, made));
  STEIF_TRY(planted_system_exact(s, g, z, c));
  *error = *size = 0;
  for (int m = 0; m < s->n; m++) {
    *size = fmaxl(*size, fmaxl(fabsl(z[m]), fabsl(made[m])));
    made[m] -= z[m];
  }
  for (int m = 0; m < s->n; m++)
    if (component == STEIF_ALL || m == component)
      *error = fmaxl(*error, fabsl(planted_system_component(s, m, made)));
  return STEIF_OK;
}

static int order_on(steif_context *ctx, int method, planted_system *s, int component,
                    size_t steps, double *order)
{
  const steif_weight given = {steep, NULL, 1, 0};
  const stf_weight g = stf_weight_of(ctx, &given);
  long double error[3], size;
  for (int i = 0; i < 3; i++)
    STEIF_TRY(error_at(ctx, method, s, component, &g, steps << i, error + i, &size));
  *order = order_of(error, size);
  return STEIF_OK;
}

/* A Jordan block and the last unit vector. */
static planted_system *one_block(steif_context *ctx, int index)
{
  planted_system *s = calloc(1, sizeof *s);
  if (!s) return (void)STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for a block"), NULL;
  s->index = s->n = index;
  s->last[index - 1] = true;
  s->z0[index - 1] = s->away[index - 1] = 1;
  for (int m = 0; m < index; m++) s->back[m][m] = 1;
  return s;
}

int method_order_on_impulse(steif_context *ctx, int method, int q, method_orders *known,
                            double *order)
{
  enum { STEPS = 512 };
  double *kept = &known->impulse[method][q];
  *order = *kept;
  if (*kept != 0) return STEIF_OK;
  planted_system *s = one_block(ctx, q + 2);
  int code = s ? planted_system_matrices(ctx, s) : STEIF_NO_MEMORY;
  if (!code) code = order_on(ctx, method, s, 0, STEPS, kept);
  if (*kept == 0) *kept = 1e-9; /* known to be 0 */
  *order = *kept;
  if (s) planted_system_free(s);
  free(s);
  return code;
}

int method_order_without(steif_context *ctx, int method, const planted_system *of,
                         int component, double *order)
{
  enum { STEPS = 512 };
  planted_system *s = malloc(sizeof *s);
  if (!s) return STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for a system");
  *s = *of;
  s->plain.user = s;
  planted_system_settle(s);
  const int code = order_on(ctx, method, s, component, STEPS, order);
  free(s);
  return code;
}
