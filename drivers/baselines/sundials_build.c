/* sundials_build.c: the time of a vector sum of SUNDIALS against that of a plain loop.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sundials_build.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <sundials/sundials_version.h>
#include <time.h>

typedef struct sum {
  N_Vector x, y, z;
} sum;

static void theirs(const sum *v) { N_VLinearSum_Serial(0.7134, v->x, -1.3917, v->y, v->z); }

static void plain(const sum *v)
{
  const sunrealtype *x = NV_DATA_S(v->x), *y = NV_DATA_S(v->y);
  sunrealtype *z = NV_DATA_S(v->z);
  const sunindextype n = NV_LENGTH_S(v->z);
  for (sunindextype i = 0; i < n; i++) z[i] = 0.7134 * x[i] - 1.3917 * y[i];
}

static double seconds(void (*work)(const sum *v), const sum *v)
{
  enum { CALLS = 400 };
  struct timespec a, b;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &a);
  for (int i = 0; i < CALLS; i++) work(v);
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &b);
  return (double)(b.tv_sec - a.tv_sec) + 1e-9 * (double)(b.tv_nsec - a.tv_nsec);
}

/* Least of several batches, in turns. */
static double ratio_of(const sum *v)
{
  enum { BATCHES = 25 };
  double least[2] = {INFINITY, INFINITY};
  for (int i = 0; i < BATCHES; i++) {
    least[0] = fmin(least[0], seconds(theirs, v));
    least[1] = fmin(least[1], seconds(plain, v));
  }
  return least[0] / least[1];
}

double sundials_ratio(steif_context *ctx)
{
#ifndef __OPTIMIZE__
  return (void)ctx, (void)ratio_of, NAN; /* the plain loop would be as slow */
#else
  double ratio = NAN;
  sum v = {.x = N_VNew_Serial(1000, steif_sundials(ctx))};
  if (v.x) {
    v.y = N_VClone(v.x);
    v.z = N_VClone(v.x);
  }
  if (v.y && v.z) {
    N_VConst(0.3721, v.x);
    N_VConst(0.8153, v.y);
    ratio = ratio_of(&v);
  }
  if (v.x) N_VDestroy(v.x);
  if (v.y) N_VDestroy(v.y);
  if (v.z) N_VDestroy(v.z);
  return ratio;
#endif
}

void sundials_caption(steif_context *ctx, char title[64], char axis[96])
{
  const double ratio = sundials_ratio(ctx);
  *title = *axis = 0;
  if (isnan(ratio)) return;
  snprintf(title, 64, "SUNDIALS compiled %s optimisation",
           ratio > SUNDIALS_SLOW ? "without" : "with");
  snprintf(axis, 96, "vector sums of SUNDIALS take %.1f times as long as a plain loop", ratio);
}

double sundials_describe(steif_context *ctx, char *text, size_t room)
{
  char version[24] = "";
  const double ratio = sundials_ratio(ctx);
  SUNDIALSGetVersion(version, sizeof version);
  if (isnan(ratio))
    snprintf(text, room, "SUNDIALS %s, its optimisation not measured", version);
  else
    snprintf(
      text, room,
      "SUNDIALS %s compiled %s optimisation: its vector sums take %.1f times as long as a "
      "plain loop",
      version, ratio > SUNDIALS_SLOW ? "without" : "with", ratio);
  return ratio;
}
