/* fit_statistics.c: covariance, intervals and what the data do not determine, by the singular values of J.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "descent.h"
#include "jacobi_svd.h"
#include <math.h>
#include <string.h>

static const sunrealtype undetermined = 1e-8; /* of the largest singular value */
static const sunrealtype part = 1e-3;         /* of a unit vector: less is none */
static const sunrealtype normal =
  1.959963984540054; /* 97.5 % lie below; M. Abramowitz and I. A. Stegun, table 26.6, with more digits */

/* sum_k v_ki v_kj / sigma_k^2 over what is determined. */
sunrealtype stf_fit_variance(const steif_fit *f, int i, int j)
{
  const int P = f->count;
  sunrealtype sum = 0;
  for (int k = 0; k < P; k++)
    if (f->singular[k] > undetermined * f->singular[0])
      sum +=
        f->direction[k * P + i] / f->singular[k] * (f->direction[k * P + j] / f->singular[k]);
  return sum;
}

/* Has parameter i a part in a direction that is not determined, or does nothing determine it where it is? */
static bool loose(const stf_descent *d, const steif_fit *f, int i)
{
  if (f->bound[i]) return false;
  if (d->fate[i] != STF_FOUND) return true;
  for (int k = 0; k < f->count; k++)
    if (!(f->singular[k] > undetermined * f->singular[0]) &&
        fabs(f->direction[k * f->count + i]) > part)
      return true;
  return false;
}

/* The direction of a parameter at a bound alone? */
static bool held(const steif_fit *f, int k)
{
  for (int i = 0; i < f->count; i++)
    if (f->bound[i] && f->direction[k * f->count + i] != 0) return true;
  return false;
}

/* Columns of parameters at bounds are 0, and so are their singular values: they come last. */
static int hold(steif_fit *f)
{
  const int P = f->count;
  int last = P;
  for (int k = P - 1; k >= 0; k--) {
    if (!held(f, k)) continue;
    last--;
    for (int i = 0; i < P; i++) {
      const sunrealtype kept = f->direction[k * P + i];
      f->direction[k * P + i] = f->direction[last * P + i];
      f->direction[last * P + i] = kept;
    }
    f->singular[k] = f->singular[last], f->singular[last] = 0;
  }
  return P - last;
}

/* Of chi2, |U^T r|^2, with U diag(sigma) in J. */
static sunrealtype promised(const stf_descent *d, const steif_fit *f)
{
  const size_t m = d->data->count;
  sunrealtype sum = 0;
  for (int k = 0; k < f->count; k++) {
    if (!(f->singular[k] > undetermined * f->singular[0])) continue;
    sunrealtype part_of_r = 0;
    for (size_t j = 0; j < m; j++)
      part_of_r += d->J[(size_t)k * m + j] / f->singular[k] * d->r[j];
    sum += part_of_r * part_of_r;
  }
  return d->chi2 > 0 ? sum / d->chi2 : 0;
}

static void decompose(stf_descent *d, steif_fit *f)
{
  const int P = f->count;
  stf_jacobi_svd(d->data->count, (size_t)P, d->J, f->singular, f->direction);
  const sunrealtype share = promised(d, f);
  const int fixed = hold(f);
  f->undetermined = 0;
  for (int k = 0; k < P - fixed; k++)
    f->undetermined += !(f->singular[k] > undetermined * f->singular[0]);
  f->dof = (long)d->data->count - (P - fixed - f->undetermined);
  if (f->exhausted) return;
  stf_fit_end_of(d, f, share);
  if (d->end) f->exhausted = 2;
}

/* dp/dtheta. */
static sunrealtype unit_of(const stf_descent *d, const steif_fit *f, int i)
{
  return d->log ? f->p[i] : d->unit[i];
}

/* Without a degree of freedom nothing tells the standard deviation of the data, where it is not given. */
static void spread(const stf_descent *d, steif_fit *f)
{
  const int P = f->count;
  const bool told = d->data->sd || f->dof > 0;
  const sunrealtype known = d->data->sd || !told ? 1 : f->chi2 / (sunrealtype)f->dof;
  for (int i = 0; i < P; i++)
    for (int j = 0; j < P; j++)
      f->covariance_theta[i * P + j] = known * stf_fit_variance(f, i, j);
  for (int i = 0; i < P; i++)
    for (int j = 0; j < P; j++) {
      const sunrealtype both = f->covariance_theta[i * P + j];
      const sunrealtype a = f->covariance_theta[i * P + i], b = f->covariance_theta[j * P + j];
      const bool undefined =
        !(told || f->bound[i] || f->bound[j]) || loose(d, f, i) || loose(d, f, j);
      f->correlation[i * P + j] = i == j ? 1 : a > 0 && b > 0 ? both / sqrt(a) / sqrt(b) : 0;
      f->covariance[i * P + j] = !undefined ? both * unit_of(d, f, i) * unit_of(d, f, j)
                                 : i == j   ? INFINITY
                                            : NAN;
    }
}

/* How many standard deviations a 95 % interval has to each side: Student's t where that of the data is an estimate. */
static int quantile(const stf_descent *d, steif_fit *f)
{
  f->known = d->data->sd != NULL, f->probability = NAN;
  f->quantile = f->known ? normal : INFINITY;
  if (f->dof < 1) return STEIF_OK;
  return f->known ? steif_chi_square(d->ctx, f->chi2, f->dof, &f->probability)
                  : steif_student(d->ctx, 0.95, f->dof, &f->quantile);
}

static int intervals(const stf_descent *d, steif_fit *f)
{
  STEIF_TRY(quantile(d, f));
  for (int i = 0; i < f->count; i++) {
    const int at = i * f->count + i;
    const sunrealtype theta = loose(d, f, i) ? INFINITY : sqrt(f->covariance_theta[at]);
    const sunrealtype p = f->p[i], half = theta > 0 ? f->quantile * theta : 0;
    f->sd[i] = sqrt(f->covariance[at]);
    f->low[i] = d->log ? p * exp(-half) : p - half * d->unit[i];
    f->high[i] = d->log ? p * exp(half) : p + half * d->unit[i];
  }
  return STEIF_OK;
}

int stf_fit_judge(stf_descent *d, steif_fit *f)
{
  const size_t m = d->data->count;
  f->chi2 = d->chi2;
  memcpy(f->residual, d->r, m * sizeof *d->r);
  for (int i = 0; i < d->P; i++) {
    sunrealtype size = 0;
    for (size_t j = 0; j < m; j++) size = fmax(size, fabs(d->J[(size_t)i * m + j]));
    const sunrealtype p = f->p[i] = d->p0[i];
    f->bound[i] = size > 0 || d->fate[i] ? 0 : p <= d->low[i] ? -1 : p >= d->high[i];
    if (d->fate[i]) memset(d->J + (size_t)i * m, 0, m * sizeof *d->J);
  }
  decompose(d, f);
  spread(d, f);
  return intervals(d, f);
}
