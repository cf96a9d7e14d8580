/* error_estimate.c: what methods make of their error estimates.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include "step_error.h"
#include <math.h>

/* Weights of the divided difference through k + 1 nodes. */
static void difference(int k, const sunrealtype *node, sunrealtype *weight)
{
  for (int j = 0; j <= k; j++) {
    weight[j] = 1;
    for (int m = 0; m <= k; m++)
      if (m != j) weight[j] /= node[j] - node[m];
  }
}

bool stf_above_rounding(const steif_problem *p, const steif_options *o, const sunrealtype *y,
                        sunrealtype times)
{
  sunrealtype most = 0, least = o->atol;
  for (sunindextype i = 0; i < p->n; i++) {
    most = fmax(most, fabs(y[i]));
    if (o->atols) least = i ? fmin(least, o->atols[i]) : o->atols[i];
  }
  return times * STF_EPS * most <= least;
}

sunrealtype stf_share(const stf_step *s, int q, int p, sunrealtype rounding)
{
  const sunrealtype sum = 2e-3, anchor = 1e-3, most = 0.1;
  const sunrealtype rtol = s->options->rtol, power = (q + 1.0) / p;
  return fmin(most, fmax(pow(sum * rtol / anchor, power) * anchor, rounding) / rtol);
}

int stf_share_open(stf_step *s, const char *name, int q, int p, sunrealtype least)
{
  const sunrealtype rounding = 1e-14, none = least * rounding;
  const sunrealtype wanted = stf_share(s, q, p, none) * s->options->rtol;
  s->control.order = q;
  if (!s->adaptive) return STEIF_OK;
  STEIF_CHECK(
    wanted > none, s->ctx, STEIF_UNSUPPORTED,
    "'%s' of order %d cannot keep rtol = %g: the error of one step would have to be below "
    "rounding; take a method of higher order, radau:s=3 or more, or a larger rtol",
    name, p, s->options->rtol);
  s->control.tolerance = stf_share(s, q, p, rounding);
  if (!(s->method->traits & STF_EXPLICIT)) stf_share_newton(s, rounding);
  return STEIF_OK;
}

void stf_share_newton(stf_step *s, sunrealtype rounding)
{
  const sunrealtype most = 1e-3, least = 0.1 * rounding / s->options->rtol;
  if (s->options->newton > 0) return;
  s->newton.tolerance = fmin(most, fmax(0.01 * s->control.tolerance, least));
  if (s->problem->dae_index >= 3)
    s->newton.tolerance =
      fmin(s->newton.tolerance, stf_multipliers_known(s->options->rtol, s->control.order));
}

void stf_estimate_open(stf_estimate *e, const steif_table *T, const stf_transform *transform,
                       sunrealtype rtol)
{
  const int s = T->s;
  const sunrealtype re = transform->re[0], im = transform->im[0], anchor = 1e-3;
  sunrealtype node[STEIF_STAGES + 1] = {0}, weight[STEIF_STAGES + 1];
  for (int i = 0; i < s; i++) node[i + 1] = T->c[i];
  difference(s, node, weight);
  for (int i = 0; i < s; i++) e->top[i] = weight[i + 1];
  difference(s - 1, node + 1, e->below);
  if (s > 2) difference(s - 2, node + 2, e->lower + 1);
  e->s = s, e->beyond = T->order - s;
  e->gain = re + im * im / re;
  e->weight = 1 / e->gain;
  for (int k = s + 1; k <= T->order + 1; k++) e->gain /= k;
  e->legendre = 1;
  for (int k = 1; k <= s; k++) e->legendre *= (sunrealtype)k / (s + k);
  const bool end = T->claims & STEIF_STIFFLY_ACCURATE;
  const sunrealtype undamped = end || s < 4 ? 1 : 0.1, most = undamped * (end ? 0.05 : 0.04),
                    low = s > 2 ? 0.002
                          : end ? 0.0003
                                : 0.001,
                    part = fmin(most, undamped * low * s * s);
  e->most = 0.1 * pow(rtol, (s + 1.0) / (2 * s)) / rtol;
  e->loosest =
    part * pow(anchor, (s + 1.0) / (2 * s)) * pow(rtol / anchor, (s + 1.0) / T->order) / rtol;
}

static sunrealtype ratio_of(const stf_estimate *e, sunrealtype top, sunrealtype below)
{
  sunrealtype ratio = e->gain;
  for (int k = 0; k < e->beyond; k++) ratio *= e->s * top / below;
  return ratio;
}

bool stf_estimate_sees(const stf_estimate *e, sunrealtype top)
{
  const sunrealtype seen = 0.3;
  return top * e->legendre > seen;
}

sunrealtype stf_estimate_ratio(const stf_estimate *e, sunrealtype top, sunrealtype below)
{
  const sunrealtype ratio = ratio_of(e, top, below);
  return ratio < 1 ? ratio : 1;
}

void stf_estimate_set(stf_step *s, const stf_estimate *e, sunrealtype top, sunrealtype below)
{
  const sunrealtype wanted = 0.3;
  const sunrealtype ratio = stf_estimate_sees(e, top) ? ratio_of(e, top, below) : 0;
  const bool less = ratio * e->loosest > wanted && e->loosest > wanted;
  s->control.tolerance = !less ? e->loosest : ratio < 1 ? wanted / ratio : wanted;
  s->control.order = e->s + (less && ratio < 1 ? e->beyond : 0);
}

void stf_estimate_share(stf_step *s, const stf_estimate *e, sunrealtype ratio,
                        sunrealtype share)
{
  const sunrealtype wanted = 0.3;
  const sunrealtype more = fmin(e->most, fmin(wanted, share) / ratio);
  if (more > s->control.tolerance) s->control.tolerance = more;
}

void stf_estimate_none(stf_step *s, const stf_estimate *e)
{
  const sunrealtype bound = 0.05;
  s->control.tolerance = fmin(s->control.tolerance, bound);
  s->control.order = e->s;
}

int stf_product_by_pencil(stf_step *s, N_Vector v, N_Vector out)
{
  return steif_pencil_product(s->system.pencil, 'E', v, out);
}

int stf_solve_by_pencil(stf_step *s, sunrealtype h, N_Vector v)
{
  (void)h;
  return steif_pencil_solve(s->system.pencil, 0, 1, &v, NULL);
}

void stf_of_index_one(const stf_step *s, N_Vector v)
{
  const int *index = s->problem->index;
  if (!index || s->problem->dae_index < 2) return;
  sunindextype rows;
  sunrealtype *x = stf_own_rows(v, &rows);
  for (sunindextype i = 0; x && i < rows; i++)
    if (index[i] > 1) x[i] = 0;
}

static sunrealtype norm_of_index_one(const stf_step *s, N_Vector v, N_Vector work)
{
  stf_copy(&s->system.space, v, work);
  stf_of_index_one(s, work);
  return stf_norm(&s->system.space, work, s->weights);
}

static sunrealtype stiff_bound(const stf_step *s)
{
  const sunrealtype bound = 3, rounding = 5e-11;
  return bound + rounding / s->options->rtol;
}

sunrealtype stf_raise_stiff(stf_step *s, sunrealtype size)
{
  const sunrealtype times = size / stiff_bound(s) * s->control.tolerance / s->error_norm;
  if (!(times > 1) || s->tries >= STF_STUBBORN) return 1;
  stf_scale(&s->system.space, times, s->error, s->error);
  s->error_norm *= times;
  return times;
}

/* The part that each of the solves has left, q = gamma_0 z / (1 + gamma_0 z), grows with h^(1 - q). */
int stf_estimate_stiff(stf_step *s, const stf_estimate *e, sunrealtype h, stf_by_E *product,
                       stf_by_shift *filter, N_Vector rest, N_Vector work)
{
  const stf_space *space = &s->system.space;
  const sunrealtype bound = stiff_bound(s), small = 0.1;
  if (s->tries >= STF_STUBBORN || s->problem->dae_index > 2) return STEIF_OK;
  const sunrealtype whole = s->error_norm = stf_norm(space, s->error, s->weights);
  if (!(whole <= s->control.tolerance)) return STEIF_OK;
  int k = 1;
  sunrealtype size = e->s * whole;
  stf_copy(space, s->error, rest);
  for (; k < e->s && size > small * bound; k++) {
    STEIF_TRY((product ? product : stf_product_by_pencil)(s, rest, work));
    STEIF_TRY(filter(s, h, work));
    stf_axpy(space, -1 / (e->weight * h), work, rest);
    size = e->s * norm_of_index_one(s, rest, work);
  }
  if (k == 1 || !(stf_raise_stiff(s, size) > 1)) return STEIF_OK;
  const sunrealtype left = fmin(1, pow(size / (e->s * whole), 1.0 / (k - 1)));
  s->control.order = e->s + (int)((e->s - 1) * (1 - left));
  return STEIF_OK;
}

/* Unknowns of index 3 forget their start in so many steps; what so many refusals have not cured is not
 * theirs. */
enum { SETTLED = 3, PATIENT = 3 };

/* Linear systems start from impulses, which they forget more slowly. */
static bool watched(const stf_step *s)
{
  return s->problem->dae_index >= 3 && !s->system.linear;
}

static bool settled(const stf_step *s) { return s->count >= SETTLED && s->tries < PATIENT; }

bool stf_filters_twice(const stf_step *s)
{
  return watched(s) ? !settled(s) : s->count == 0 || s->rejected;
}

void stf_estimate_levels(stf_step *s)
{
  const int *index = s->problem->index;
  const sunrealtype rounding = 1e-11, strict = 0.05 + rounding / s->options->rtol;
  if (!index || !watched(s) || !settled(s) || s->control.tolerance <= strict) return;
  sunindextype rows;
  sunrealtype *error = stf_own_rows(s->error, &rows);
  for (sunindextype i = 0; error && i < rows; i++)
    if (index[i] > 1) error[i] *= s->control.tolerance / strict;
}

void stf_stages_known(stf_step *s, int p)
{
  const sunrealtype usual = 1e-4, multipliers = 1e-6, rtol = s->options->rtol;
  if (!s->adaptive || s->options->newton > 0) return;
  s->newton.tolerance = s->problem->dae_index < 3 ? usual
                        : p                       ? stf_multipliers_known(rtol, p)
                                                  : multipliers;
}

sunrealtype stf_multipliers_known(sunrealtype rtol, int p)
{
  const sunrealtype most = 1e-6, rounding = 1e-20;
  return fmax(most * fmin(1, pow(rtol / most, 2.0 / p)), rounding / rtol);
}

enum { PATIENCE = 2 };

int stf_filter_rounds(const stf_step *s)
{
  return s->rejected && s->undamped > PATIENCE ? 3 : 1;
}

/* What a step began with is more than half of what it ends with: no shorter step would end with less. */
static bool inherited(const stf_step *s) { return s->undamped_start > s->undamped_end / 2; }

int stf_test_undamped(stf_step *s, N_Vector first, sunrealtype times, bool diverged,
                      bool blended)
{
  const stf_space *space = &s->system.space;
  const sunrealtype bound = 0.1;
  stf_axpy(space, -times, s->error, first);
  if (!s->rejected) s->undamped = 0, s->undamped_start = s->undamped_end;
  s->undamped_end = stf_norm(space, first, s->weights);
  const bool large = s->undamped_end > bound, old = large && blended && inherited(s);
  if (large) s->undamped++;
  if (s->undamped > PATIENCE || diverged || old) {
    stf_axpy(space, 1, first, s->next);
    s->undamped_end = 0;
  } else if (s->undamped)
    stf_scale(space, s->control.tolerance / bound, first, s->error);
  return STEIF_OK;
}

int stf_check_mode_index(const stf_step *s)
{
  const char *name = s->no_multipliers;
  STEIF_CHECK(
    !name || !s->adaptive || s->problem->dae_index < 3, s->ctx, STEIF_UNSUPPORTED,
    "'%s' cannot choose steps for problem '%s' of index %d, whose multipliers it does "
    "not find: use radau, or give steps with h",
    name, s->problem->name, s->problem->dae_index);
  return STEIF_OK;
}

int stf_check_index(stf_step *s, const char *name)
{
  s->no_multipliers = name;
  return stf_check_mode_index(s);
}
