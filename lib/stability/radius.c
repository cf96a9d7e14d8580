/* radius.c: the spectral radius of a method's step M(z), from the propagator alone.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "stability.h"
#include <math.h>

void zgeev_(const char *left, const char *right, const int *n, double *a, const int *lda,
            double *w, double *vl, const int *ldvl, double *vr, const int *ldvr, double *work,
            const int *lwork, double *rwork, int *info);

enum { SCRATCH = 8 }; /* complex work of zgeev per row; 2 would do */

static int propagate(stf_growth *growth, const sunrealtype z[2], sunrealtype *M)
{
  return growth->method->propagator(growth->ctx, &growth->spec, growth->table, z, &growth->r, M);
}

int stf_growth_open(stf_growth *growth, steif_context *ctx, const char *method)
{
  *growth = (stf_growth){.ctx = ctx, .name = method};
  STEIF_CHECK(method, ctx, STEIF_BAD_INPUT,
              "no method was named: give one such as \"bdf:p=3\"");
  STEIF_TRY(steif_spec_parse(ctx, method, &growth->spec));
  STEIF_TRY(stf_method_find(ctx, &growth->spec, &growth->method, &growth->table));
  const sunrealtype origin[2] = {0, 0};
  const int code = propagate(growth, origin, NULL);
  if (code) return stf_growth_close(growth), code;
  const size_t r = (size_t)growth->r;
  growth->M = stf_allocate(ctx, 2 * r * r, sizeof *growth->M);
  growth->work = stf_allocate(ctx, (2 + 2 * SCRATCH + 2) * r, sizeof *growth->work);
  if (growth->M && growth->work) return STEIF_OK;
  stf_growth_close(growth);
  return STEIF_NO_MEMORY;
}

void stf_growth_close(stf_growth *growth)
{
  stf_release(growth->ctx, growth->M);
  stf_release(growth->ctx, growth->work);
  steif_table_free(growth->ctx, &growth->table);
  growth->M = growth->work = NULL;
}

static int eigenvalues(stf_growth *growth)
{
  const int n = growth->r, one = 1, lwork = SCRATCH * n;
  sunrealtype *w = growth->work, *work = w + 2 * n, *rwork = work + 2 * lwork;
  int info;
  for (int i = 0; i < 2 * n * n; i++)
    STEIF_CHECK(
      isfinite(growth->M[i]), growth->ctx, STEIF_NOT_FINITE,
      "the step of %s on y' = lambda y is not finite here: z hits a pole of the method",
      growth->name);
  zgeev_("N", "N", &n, growth->M, &n, w, NULL, &one, NULL, &one, work, &lwork, rwork, &info);
  STEIF_CHECK(info == 0, growth->ctx, STEIF_NO_CONVERGENCE,
              "the eigenvalues of the %d x %d step matrix of %s did not converge (zgeev: %d)",
              n, n, growth->name, info);
  return STEIF_OK;
}

int stf_growth_eigenvalues(stf_growth *growth, sunrealtype re, sunrealtype im)
{
  const sunrealtype z[2] = {re, im};
  STEIF_TRY(propagate(growth, z, growth->M));
  if (growth->r > 1) return eigenvalues(growth);
  growth->work[0] = growth->M[0];
  growth->work[1] = growth->M[1];
  return STEIF_OK;
}

sunrealtype stf_growth_at(stf_growth *growth, sunrealtype re, sunrealtype im)
{
  if (growth->code != STEIF_OK) return 0;
  growth->code = stf_growth_eigenvalues(growth, re, im);
  /* At a pole the step is infinite: growth without bound, no failure. */
  if (growth->code == STEIF_NOT_FINITE || growth->code == STEIF_SINGULAR) {
    growth->code = STEIF_OK;
    steif_forget(growth->ctx);
    return INFINITY;
  }
  sunrealtype most = 0;
  for (int i = 0; i < growth->r && growth->code == STEIF_OK; i++)
    most = fmax(most, hypot(growth->work[2 * i], growth->work[2 * i + 1]));
  if (isnan(growth->work[0])) return INFINITY;
  return (growth->star ? most * exp(-re) : most) - 1;
}

int steif_spectral_radius(steif_context *ctx, const char *method, const sunrealtype z[2],
                          sunrealtype *radius)
{
  stf_growth growth;
  STEIF_TRY(stf_growth_open(&growth, ctx, method));
  const sunrealtype g = stf_growth_at(&growth, z[0], z[1]);
  const int code = growth.code;
  stf_growth_close(&growth);
  *radius = code == STEIF_OK ? g + 1 : NAN;
  return code;
}
