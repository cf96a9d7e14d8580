/* radius.c: the spectral radius of a method's step M(z), from the propagator alone.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "region.h"
#include "lapack.h"
#include <math.h>

enum { SCRATCH = 8 }; /* complex work of zgeev per row; 2 would do */

static int propagate(stf_scan *scan, const sunrealtype z[2], sunrealtype *M)
{
  return stf_propagate(scan->ctx, scan->method, &scan->spec, scan->table, z, &scan->r, M);
}

int stf_scan_open(stf_scan *scan, steif_context *ctx, const char *method)
{
  *scan = (stf_scan){.ctx = ctx, .name = method};
  STEIF_CHECK(method, ctx, STEIF_BAD_INPUT,
              "no method was named: give one such as \"bdf:p=3\"");
  STEIF_TRY(steif_spec_parse(ctx, method, &scan->spec));
  STEIF_TRY(stf_method_find(ctx, &scan->spec, &scan->method, &scan->table));
  const sunrealtype origin[2] = {0, 0};
  const int code = propagate(scan, origin, NULL);
  if (code) return stf_scan_close(scan), code;
  const size_t r = (size_t)scan->r;
  scan->M = stf_allocate(ctx, 2 * r * r, sizeof *scan->M);
  scan->work = stf_allocate(ctx, (2 + 2 * SCRATCH + 2) * r, sizeof *scan->work);
  if (scan->M && scan->work) return STEIF_OK;
  stf_scan_close(scan);
  return STEIF_NO_MEMORY;
}

void stf_scan_close(stf_scan *scan)
{
  stf_release(scan->ctx, scan->M);
  stf_release(scan->ctx, scan->work);
  steif_table_free(scan->ctx, &scan->table);
  scan->M = scan->work = NULL;
}

static int eigenvalues(stf_scan *scan)
{
  const int n = scan->r, one = 1, lwork = SCRATCH * n;
  sunrealtype *w = scan->work, *work = w + 2 * n, *rwork = work + 2 * lwork;
  int info;
  for (int i = 0; i < 2 * n * n; i++)
    STEIF_CHECK(
      isfinite(scan->M[i]), scan->ctx, STEIF_NOT_FINITE,
      "the step of %s on y' = lambda y is not finite here: z hits a pole of the method",
      scan->name);
  zgeev_("N", "N", &n, scan->M, &n, w, NULL, &one, NULL, &one, work, &lwork, rwork, &info, 1,
         1);
  STEIF_CHECK(info == 0, scan->ctx, STEIF_NO_CONVERGENCE,
              "the eigenvalues of the %d x %d step matrix of %s did not converge (zgeev: %d)",
              n, n, scan->name, info);
  return STEIF_OK;
}

int stf_scan_eigenvalues(stf_scan *scan, sunrealtype re, sunrealtype im)
{
  const sunrealtype z[2] = {re, im};
  STEIF_TRY(propagate(scan, z, scan->M));
  if (scan->r > 1) return eigenvalues(scan);
  scan->work[0] = scan->M[0];
  scan->work[1] = scan->M[1];
  return STEIF_OK;
}

sunrealtype stf_scan_excess(stf_scan *scan, sunrealtype re, sunrealtype im)
{
  if (scan->code != STEIF_OK) return 0;
  scan->code = stf_scan_eigenvalues(scan, re, im);
  /* At a pole the step is infinite: growth without bound, no failure. */
  if (scan->code == STEIF_NOT_FINITE || scan->code == STEIF_SINGULAR) {
    scan->code = STEIF_OK;
    steif_forget(scan->ctx);
    return INFINITY;
  }
  sunrealtype most = 0;
  for (int i = 0; i < scan->r && scan->code == STEIF_OK; i++)
    most = fmax(most, hypot(scan->work[2 * i], scan->work[2 * i + 1]));
  if (isnan(scan->work[0])) return INFINITY;
  return (scan->star ? most * exp(-re) : most) - 1;
}

int steif_spectral_radius(steif_context *ctx, const char *method, const sunrealtype z[2],
                          sunrealtype *radius)
{
  stf_scan scan;
  STEIF_TRY(stf_scan_open(&scan, ctx, method));
  const sunrealtype g = stf_scan_excess(&scan, z[0], z[1]);
  const int code = scan.code;
  stf_scan_close(&scan);
  *radius = code == STEIF_OK ? g + 1 : NAN;
  return code;
}
