/* bilinear.c: the generalised bilinear transform and its special cases.
 *
 * With K = (1 - a z)^{-1}, z = h A: Ad = K (1 + (1-a) z), Bd = h K B, Cd = C K, Dd = D + a C Bd.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "discrete.h"
#include <math.h>
#include <string.h>

/* alpha and the step h, which prewarping changes. */
static int parameters(const stf_plan *p, double *alpha, double *h)
{
  double w = 0;
  const double limit = STF_PI / p->dt;
  *alpha = p->rule->alpha, *h = p->dt;
  STEIF_CHECK(*alpha >= 0 || stf_spec_word(p->spec, "alpha"), p->ctx, STEIF_BAD_INPUT,
              "gbt needs its parameter from 0 to 1: write gbt:alpha=0.75, say");
  if (*alpha < 0) return stf_spec_real(p->ctx, p->spec, "alpha", 0, 1, 0, alpha);
  if (!stf_spec_word(p->spec, "w")) return STEIF_OK;
  STEIF_TRY(stf_spec_real(p->ctx, p->spec, "w", -HUGE_VAL, HUGE_VAL, 0, &w));
  STEIF_CHECK(
    w > 0 && w < limit, p->ctx, STEIF_BAD_INPUT,
    "w = %g: a frequency to be kept lies above 0 and below pi/dt = %g; choose another "
    "or shorten dt",
    w, limit);
  *h = 2 * tan(w * p->dt / 2) / w;
  return STEIF_OK;
}

/* Factor K^{-1} = 1 - a z in place. */
static int factor(const stf_plan *p, double alpha, double h, double *K, int *pivot)
{
  const int n = p->s->n;
  double *work = stf_allocate(p->ctx, 4 * (size_t)n, sizeof *work), rcond = 0;
  int *whole = stf_allocate(p->ctx, (size_t)n, sizeof *whole), info = 0;
  if (work && whole) {
    const double norm = stf_norm1(n, K);
    dgetrf_(&n, &n, K, &n, pivot, &info);
    if (info == 0) dgecon_("1", &n, K, &n, &norm, &rcond, work, whole, &info, 1);
  }
  const int code = work && whole ? STEIF_OK : STEIF_NO_MEMORY;
  stf_release(p->ctx, work), stf_release(p->ctx, whole);
  STEIF_TRY(code);
  STEIF_CHECK(rcond > STF_EPS, p->ctx, STEIF_SINGULAR,
              "1 - %g A is singular (reciprocal condition %.1e): A has an eigenvalue near %g; "
              "choose another dt or alpha",
              alpha * h, rcond, 1 / (alpha * h));
  return STEIF_OK;
}

/* Cd = C K by the transposed system, through scratch of n x p. */
static int output(const stf_plan *p, double alpha, const double *K, const int *pivot)
{
  const int n = p->s->n, o = p->s->p;
  if (!o) return STEIF_OK;
  stf_product(o, p->s->m, n, alpha, p->s->C, p->Bd, 1, p->Dd);
  double *T = stf_allocate(p->ctx, (size_t)n * (size_t)o, sizeof *T);
  if (!T) return STEIF_NO_MEMORY;
  int info;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < o; j++) T[i + n * j] = p->s->C[j + o * i];
  dgetrs_("T", &n, &o, K, &n, pivot, T, &n, &info, 1);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < o; j++) p->Cd[j + o * i] = T[i + n * j];
  stf_release(p->ctx, T);
  return STEIF_OK;
}

static int solve(const stf_plan *p, double alpha, double h, double *K, int *pivot)
{
  const int n = p->s->n, m = p->s->m;
  const size_t count = (size_t)n * (size_t)n, inputs = (size_t)n * (size_t)m;
  int info;
  for (size_t i = 0; i < count; i++) {
    const double one = i % ((size_t)n + 1) == 0, z = h * p->s->A[i];
    K[i] = one - alpha * z, p->Ad[i] = one + (1 - alpha) * z;
  }
  for (size_t i = 0; i < inputs; i++) p->Bd[i] = h * p->s->B[i];
  STEIF_TRY(stf_check_result(p->ctx, "dt A", count, K, h * stf_norm1(n, p->s->A)));
  if (alpha > 0) {
    STEIF_TRY(factor(p, alpha, h, K, pivot));
    dgetrs_("N", &n, &n, K, &n, pivot, p->Ad, &n, &info, 1);
    if (m) dgetrs_("N", &n, &m, K, &n, pivot, p->Bd, &n, &info, 1);
    STEIF_TRY(output(p, alpha, K, pivot));
  }
  for (size_t i = 0; i < inputs; i++)
    p->B0[i] = (1 - alpha) * p->Bd[i], p->B1[i] = alpha * p->Bd[i];
  return STEIF_OK;
}

int stf_bilinear_build(const stf_plan *p)
{
  const size_t n = (size_t)p->s->n;
  double alpha, h;
  STEIF_TRY(parameters(p, &alpha, &h));
  double *K = stf_allocate(p->ctx, n * n, sizeof *K);
  int *pivot = stf_allocate(p->ctx, n, sizeof *pivot);
  const int code = K && pivot ? solve(p, alpha, h, K, pivot) : STEIF_NO_MEMORY;
  stf_release(p->ctx, K), stf_release(p->ctx, pivot);
  return code;
}
