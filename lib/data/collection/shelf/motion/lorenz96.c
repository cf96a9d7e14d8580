/* lorenz96.c: Lorenz' model of a circle of latitude, x_i' = (x_{i+1} - x_{i-2}) x_{i-1} - x_i + F,
 * i modulo n. Four entries in a row of the Jacobian: storage=sparse, and always above n = 1000.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { MEASURED = 40, DENSE_MOST = 1000 }; /* the n of the reference; of dense storage */

typedef struct setting {
  sunindextype n;
  sunrealtype F;
} setting;

static const sunindextype which[] = {0, 1, 2, 3, 18, 19, 20, 21, 22};
static const sunrealtype end[] = {
  3.163090400053394044549, -6.13615668801253068235, -7.09943088551661855262,
  8.090924035009191996909, 10.50176025764810610862, 3.831349396593584787824,
  -2.72417292866301620473, -0.78557671611874786959, 2.582831514987519491891};
static const steif_reference reference = {
  .t = 2,
  .count = 9,
  .component = which,
  .value = end,
  .digits = 17,
  .source =
    "Taylor series of orders 26 and 24 in 45-digit arithmetic, steps 0.02 and 0.016 agree"};

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const setting *s = user;
  const sunindextype n = s->n;
  const sunrealtype *x = N_VGetArrayPointer(y);
  sunrealtype *dx = N_VGetArrayPointer(ydot);
  (void)t;
  dx[0] = (x[1] - x[n - 2]) * x[n - 1] - x[0] + s->F;
  dx[1] = (x[2] - x[n - 1]) * x[0] - x[1] + s->F;
  for (sunindextype i = 2; i < n - 1; i++)
    dx[i] = (x[i + 1] - x[i - 2]) * x[i - 1] - x[i] + s->F;
  dx[n - 1] = (x[0] - x[n - 3]) * x[n - 2] - x[n - 1] + s->F;
  return 0;
}

/* Column j, rows ascending: j - 1, j, j + 1, j + 2 modulo n. */
static void fill_column(sunindextype n, const sunrealtype *x, sunindextype j, SUNMatrix J)
{
  const sunindextype before = (j + n - 1) % n, next = (j + 1) % n, beyond = (j + 2) % n;
  const struct {
    sunindextype row;
    sunrealtype value;
  } entry[] = {
    {before, x[(j + n - 2) % n]}, {j, -1}, {next, x[beyond] - x[before]}, {beyond, -x[next]}};
  sunindextype first = 0; /* of the cycle, where the rows start again */
  for (sunindextype e = 1; e < 4; e++)
    if (entry[e].row < entry[first].row) first = e;
  SM_INDEXPTRS_S(J)[j] = 4 * j;
  for (sunindextype e = 0; e < 4; e++) {
    SM_INDEXVALS_S(J)[4 * j + e] = entry[(first + e) % 4].row;
    SM_DATA_S(J)[4 * j + e] = entry[(first + e) % 4].value;
  }
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  const sunindextype n = ((const setting *)user)->n;
  const sunrealtype *x = N_VGetArrayPointer(y);
  (void)t, (void)fy, (void)tmp1, (void)tmp2, (void)tmp3;
  if (SUNMatGetID(J) == SUNMATRIX_SPARSE) {
    for (sunindextype j = 0; j < n; j++) fill_column(n, x, j, J);
    SM_INDEXPTRS_S(J)[n] = 4 * n;
    return 0;
  }
  for (sunindextype i = 0; i < n; i++) {
    const sunindextype before = (i + n - 1) % n, two = (i + n - 2) % n, next = (i + 1) % n;
    SM_ELEMENT_D(J, i, i) = -1;
    SM_ELEMENT_D(J, i, next) = x[before];
    SM_ELEMENT_D(J, i, two) = -x[before];
    SM_ELEMENT_D(J, i, before) = x[next] - x[two];
  }
  return 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  int n;
  sunrealtype F;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"n", "F", "storage", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "n", 4, 10000000, MEASURED, &n));
  STEIF_TRY(stf_spec_real(ctx, spec, "F", -1e3, 1e3, 8, &F));
  if (n > DENSE_MOST) self->storage = STEIF_SPARSE;
  STEIF_TRY(stf_collection_storage(ctx, spec, self));
  STEIF_CHECK(self->storage != STEIF_BAND, ctx, STEIF_UNSUPPORTED,
              "'lorenz96' has no band storage: choose dense or sparse");
  STEIF_CHECK(self->storage == STEIF_SPARSE || n <= DENSE_MOST, ctx, STEIF_UNSUPPORTED,
              "'lorenz96' of %d unknowns is too large for dense storage (at most %d): choose "
              "sparse",
              n, DENSE_MOST);
  setting *s = stf_collection_allocate(ctx, self, sizeof *s, (size_t)n);
  if (!s) return STEIF_NO_MEMORY;
  *s = (setting){n, F};
  sunrealtype *start = (sunrealtype *)(s + 1);
  for (int i = 0; i < n; i++) start[i] = F;
  start[n / 2 - 1] += 0.001 * F;
  self->n = n;
  self->y0 = start;
  self->nnz = 4 * (sunindextype)n;
  self->reference = n == MEASURED && F == 8 ? &reference : NULL;
  return STEIF_OK;
}

const steif_problem steif_problem_lorenz96 = {
  .about = "Lorenz' circle of latitude, n=40,F=8 (storage=dense), chaotic: E. N. Lorenz, "
           "Predictability (ECMWF, "
           "1996); E. N. Lorenz and K. Emanuel, J. Atmos. Sci. 55 (1998) 399-414",
  .n = MEASURED,
  .t1 = 2,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .build = build,
  .destroy = stf_collection_release,
};
