/* scale_vector.c: vectors that count where ranks would wait for each other.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "scale.h"
#include <nvector/nvector_serial.h>
#include <time.h>

static scale_network *counted; /* clones know nothing of their own */

static double seconds(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void scale_sleep(const scale_network *network)
{
  if (!(network->delay > 0)) return;
  const long whole = (long)network->delay;
  nanosleep(&(struct timespec){whole, (long)(1e9 * (network->delay - (double)whole))}, NULL);
}

double scale_sleep_lasts(double delay)
{
  enum { MANY = 200 };
  const scale_network network = {.delay = delay};
  const double from = seconds();
  for (int i = 0; i < MANY; i++) scale_sleep(&network);
  return (seconds() - from) / MANY;
}

static void sum(void)
{
  counted->sums++;
  scale_sleep(counted);
}

static sunrealtype dot(N_Vector x, N_Vector y) { return sum(), N_VDotProd_Serial(x, y); }
static sunrealtype largest(N_Vector x) { return sum(), N_VMaxNorm_Serial(x); }
static sunrealtype rms(N_Vector x, N_Vector w) { return sum(), N_VWrmsNorm_Serial(x, w); }
static sunrealtype length(N_Vector x, N_Vector w) { return sum(), N_VWL2Norm_Serial(x, w); }
static sunrealtype total(N_Vector x) { return sum(), N_VL1Norm_Serial(x); }
static sunrealtype least(N_Vector x) { return sum(), N_VMin_Serial(x); }
static sunbooleantype invert(N_Vector x, N_Vector z) { return sum(), N_VInvTest_Serial(x, z); }
static N_Vector_ID id(N_Vector v) { return (void)v, SUNDIALS_NVEC_CUSTOM; }

static int together(int count, N_Vector x, sunrealtype *sums)
{
  (void)count, (void)x, (void)sums;
  sum();
  return 0;
}

N_Vector scale_vector(sunindextype n, SUNContext sun, scale_network *network)
{
  N_Vector v = N_VNew_Serial(n, sun);
  if (!v) return NULL;
  counted = network;
  N_Vector_Ops ops = v->ops;
  ops->nvgetvectorid = id, ops->nvdotprod = dot, ops->nvmaxnorm = largest;
  ops->nvwrmsnorm = rms, ops->nvwl2norm = length, ops->nvl1norm = total, ops->nvmin = least;
  ops->nvinvtest = invert, ops->nvdotprodmultiallreduce = together;
  return v;
}
