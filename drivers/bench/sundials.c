/* sundials.c: was the SUNDIALS that is linked compiled with optimisation?
 * SPDX-License-Identifier: BSD-3-Clause */
#include "timing.h"
#include "workprec.h"
#include <math.h>
#include <nvector/nvector_serial.h>

typedef struct sum {
  N_Vector x, y, z;
} sum;

static void theirs(void *data)
{
  const sum *v = data;
  N_VLinearSum_Serial(0.7134, v->x, -1.3917, v->y, v->z);
}

static void plain(void *data)
{
  const sum *v = data;
  const sunrealtype *x = NV_DATA_S(v->x), *y = NV_DATA_S(v->y);
  sunrealtype *z = NV_DATA_S(v->z);
  const sunindextype n = NV_LENGTH_S(v->z);
  for (sunindextype i = 0; i < n; i++) z[i] = 0.7134 * x[i] - 1.3917 * y[i];
}

sunrealtype steif_bench_sundials(steif_context *ctx)
{
  sunrealtype ratio = NAN;
  sum v = {.x = N_VNew_Serial(1000, steif_sundials(ctx))};
  if (v.x) {
    v.y = N_VClone(v.x);
    v.z = N_VClone(v.x);
  }
  if (v.y && v.z) {
    N_VConst(0.3721, v.x);
    N_VConst(0.8153, v.y);
    ratio = stf_time(theirs, &v) / stf_time(plain, &v);
  }
  if (v.x) N_VDestroy(v.x);
  if (v.y) N_VDestroy(v.y);
  if (v.z) N_VDestroy(v.z);
  return ratio;
}
