/* allencahn.c: u_t = 0.01 u_xx + u - u^3 on (-1, 1), u = -1 and 1 at the ends, by second
 * differences on n inner points. Fronts form at once and then hardly move.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>

#define PI 3.14159265358979323846
#define SPREAD 0.01
#define END 10

/* At x = -3/4, -1/2 .. 3/4 for n = 39 and 199, odd in x as the start is. */
enum { POINTS = 7 };
static const sunrealtype end39[] = {-0.96284622354793, -0.2349564422954, 0.83662602218785, 0,
                                    -0.83662602218785, 0.2349564422954,  0.96284622354793};
static const sunrealtype end199[] = {-0.96316953492001, -0.23417004106455, 0.8342918531001, 0,
                                     -0.8342918531001,  0.23417004106455,  0.96316953492};

typedef struct line {
  sunindextype n;
  sunrealtype scale; /* 0.01/h^2 */
  sunindextype component[POINTS];
  steif_reference reference;
  sunrealtype start[]; /* n */
} line;

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const line *l = user;
  const sunrealtype *u = N_VGetArrayPointer(y);
  sunrealtype *du = N_VGetArrayPointer(ydot);
  (void)t;
  for (sunindextype i = 0; i < l->n; i++) {
    const sunrealtype left = i > 0 ? u[i - 1] : -1, right = i < l->n - 1 ? u[i + 1] : 1;
    du[i] = l->scale * (left - 2 * u[i] + right) + u[i] - u[i] * u[i] * u[i];
  }
  return 0;
}

static int linear_part(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix L, void *user)
{
  const line *l = user;
  const sunrealtype value[] = {l->scale, -2 * l->scale, l->scale};
  (void)t, (void)y, (void)yp;
  return stf_collection_toeplitz(L, -1, 1, value);
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const line *l = user;
  const sunrealtype *u = N_VGetArrayPointer(y);
  (void)fy, (void)a, (void)b, (void)c;
  const int code = linear_part(t, y, NULL, J, user);
  for (sunindextype i = 0; code == 0 && i < l->n; i++)
    *stf_collection_diagonal(J, i) += 1 - 3 * u[i] * u[i];
  return code;
}

static void refer(line *l, steif_problem *self)
{
  const sunrealtype *value = l->n == 39 ? end39 : l->n == 199 ? end199 : NULL;
  if (!value) return;
  for (int k = 0; k < POINTS; k++) l->component[k] = (l->n + 1) / 8 * (k + 1) - 1;
  l->reference =
    (steif_reference){.t = END,
                      .count = POINTS,
                      .component = l->component,
                      .value = value,
                      .digits = 12,
                      .source = "explicit Runge-Kutta of order 8 (DOP853 of SciPy), tolerances "
                                "1e-13 and 3e-14 agree to 2e-13"};
  self->reference = &l->reference;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  int n;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"n", "storage", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "n", 1, 10000000, 199, &n));
  STEIF_TRY(stf_collection_storage(ctx, spec, self));
  line *l = stf_collection_allocate(ctx, self, sizeof *l, (size_t)n);
  if (!l) return STEIF_NO_MEMORY;
  const sunrealtype h = 2 / ((sunrealtype)n + 1);
  l->n = self->n = n;
  l->scale = SPREAD / (h * h);
  for (int i = 0; i < n; i++) {
    const sunrealtype x = (2.0 * (i + 1) - n - 1) / (n + 1);
    l->start[i] = 0.53 * x - 0.47 * sin(1.5 * PI * x);
  }
  self->y0 = l->start;
  self->lower = self->upper = n > 1;
  self->nnz = stf_collection_count(n, -1, 1);
  refer(l, self);
  return STEIF_OK;
}

const steif_problem steif_problem_allencahn = {
  .about =
    "u_t = 0.01 u_xx + u - u^3, fronts, on n=199 points (storage=band): A.-K. Kassam and "
    "L. N. Trefethen, SIAM J. Sci. Comput. 26 (2005)",
  .t1 = END,
  .f = f,
  .jac = jac,
  .L = linear_part,
  .storage = STEIF_BAND,
  .autonomous = 1,
  .build = build,
  .destroy = stf_collection_release,
};
