/* samples.c: forcing functions from samples at equal distances: the polynomial through `points` of
 * them and its derivatives, by the weights of B. Fornberg (Generation of finite difference formulas
 * on arbitrarily spaced grids, Math. Comp. 51, 1988). At the time of a sample the formula is
 * one-sided, from there on, so that what was before the start has no part in it; between two
 * samples it is as central as it can be.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "forcing.h"
#include "input.h"
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 8, POINTS_MOST = 24 };
static const double uneven = 1e-3; /* of a distance: more is an error in the file */
static const double near = 1e-9;   /* of a distance: times of samples are not exact */

/* Fornberg's recurrence for the nodes 0, 1, .., m-1 and the derivatives 0 .. d at x; c[j][k] is the
 * weight of node j in derivative k. */
void stf_samples_weights(sunrealtype x, int m, int d, sunrealtype *weights)
{
  sunrealtype c[POINTS_MOST][POINTS_MOST] = {{0}}, scale = 1, back = 0 - x;
  c[0][0] = 1;
  for (int i = 1; i < m; i++) {
    const int top = i < d ? i : d;
    const sunrealtype before = back;
    sunrealtype product = 1;
    back = i - x;
    for (int j = 0; j < i; j++) {
      const sunrealtype distance = i - j;
      product *= distance;
      if (j == i - 1)
        for (int k = top; k >= 0; k--)
          c[i][k] = scale * ((k ? k * c[i - 1][k - 1] : 0) - before * c[i - 1][k]) / product;
      for (int k = top; k >= 0; k--)
        c[j][k] = (back * c[j][k] - (k ? k * c[j][k - 1] : 0)) / distance;
    }
    scale = product;
  }
  for (int j = 0; j < m; j++) weights[j] = c[j][d];
}

/* ---- evaluation ------------------------------------------------------------------------------ */

/* First sample of the formula for position x (in distances from the first sample). */
static sunindextype window(const stf_samples *s, int points, sunrealtype *x)
{
  const sunrealtype nearest = floor(*x + 0.5);
  sunindextype start = (sunindextype)floor(*x) - (points - 1) / 2;
  if (fabs(*x - nearest) <= near) {
    *x = nearest;
    start = (sunindextype)nearest;
  }
  if (start > s->count - points) start = s->count - points;
  return start < 0 ? 0 : start;
}

static void differentiate(const steif_function *f, sunrealtype t, int derivative, int points,
                          sunrealtype *u)
{
  const stf_samples *s = &f->samples;
  sunrealtype x = (t - s->t0) / s->h;
  const sunindextype start = window(s, points, &x);
  const sunrealtype scale = pow(s->h, -derivative);
  stf_samples_weights(x - (sunrealtype)start, points, derivative, s->weights);
  for (sunindextype i = 0; i < f->inputs; i++) {
    sunrealtype sum = 0;
    for (int j = 0; j < points; j++)
      sum += s->weights[j] * s->value[(start + j) * f->inputs + i];
    u[i] = sum * scale;
  }
}

int stf_samples_value(steif_function *f, sunrealtype t, int derivative, sunrealtype *u)
{
  const stf_samples *s = &f->samples;
  const sunrealtype x = (t - s->t0) / s->h, last = (sunrealtype)(s->count - 1);
  if (derivative >= s->points)
    return STEIF_RECOVER(
      f->ctx, STEIF_UNSUPPORTED,
      "derivative %d from %d samples; %d is the highest, or take more points", derivative,
      s->points, s->points - 1);
  if (!(x >= -near && x <= last + near))
    return STEIF_RECOVER(f->ctx, STEIF_BAD_INPUT,
                         "t = %.9g is outside the samples, from %.9g to %.9g; sample further",
                         t, s->t0, s->t0 + last * s->h);
  differentiate(f, t, derivative, s->points, u);
  for (sunindextype i = 0; i < f->inputs; i++)
    if (!isfinite(u[i]))
      return STEIF_RECOVER(f->ctx, STEIF_NOT_FINITE,
                           "component %lld of derivative %d at t = %.9g overflows; scale the "
                           "samples",
                           (long long)i + 1, derivative, t);
  return STEIF_OK;
}

/* max |p_m^(d) - p_{m-1}^(d)| / max |p_m^(d)|. */
int steif_function_accuracy(const steif_function *f, sunrealtype t, int derivative,
                            sunrealtype *accuracy)
{
  if (!f || !accuracy) return STEIF_BAD_INPUT;
  const stf_samples *s = &f->samples;
  *accuracy = 0;
  if (!s->points) return STEIF_OK;
  STEIF_CHECK(derivative >= 0, f->ctx, STEIF_BAD_INPUT, "derivative %d; ask for 0 or more",
              derivative);
  *accuracy = INFINITY;
  if (derivative >= s->points - 1) return STEIF_OK;
  sunrealtype *d = stf_allocate(f->ctx, 2 * (size_t)f->inputs, sizeof *d);
  if (!d) return STEIF_NO_MEMORY;
  sunrealtype difference = 0, size = 0;
  differentiate(f, t, derivative, s->points, d);
  differentiate(f, t, derivative, s->points - 1, d + f->inputs);
  for (sunindextype i = 0; i < f->inputs; i++) {
    difference = fmax(difference, fabs(d[i] - d[f->inputs + i]));
    size = fmax(size, fabs(d[i]));
  }
  *accuracy = difference > 0 ? difference / size : 0;
  stf_release(f->ctx, d);
  return STEIF_OK;
}

/* ---- the file -------------------------------------------------------------------------------- */

static const char *skip(const char *at)
{
  while (isspace((unsigned char)*at) && *at != '\n') at++;
  return at;
}

/* t, f_1 .. f_n of a line into value[0 .. n]. */
static int row(steif_context *ctx, const char *path, long number, const char *line,
               sunindextype n, sunrealtype *value)
{
  char shown[STF_SHOWN];
  const char *at = skip(line);
  for (sunindextype k = 0; k <= n; k++) {
    char *end = NULL;
    if (*at && *at != '\n') value[k] = strtod(at, &end);
    STEIF_CHECK(end && end > at, ctx, STEIF_BAD_INPUT,
                "%s, line %ld: expected a number in column %lld of %lld, found '%s'; write "
                "t,f_1,...",
                path, number, (long long)k + 1, (long long)n + 1, stf_input_shown(at, shown));
    STEIF_CHECK(isfinite(value[k]), ctx, STEIF_NOT_FINITE,
                "%s, line %ld: column %lld is %g; every sample must be finite", path, number,
                (long long)k + 1, value[k]);
    at = skip(end);
    if (k == n) break;
    if (*at == ',') at = skip(at + 1);
  }
  STEIF_CHECK(!*at || *at == '\n', ctx, STEIF_BAD_INPUT,
              "%s, line %ld: expected %lld columns, found '%s' after them; write t,f_1,...",
              path, number, (long long)n + 1, stf_input_shown(at, shown));
  return STEIF_OK;
}

/* A first line of names; a number may begin with a digit, a sign or a point only. */
static bool is_header(const char *line)
{
  const char c = *skip(line);
  return isalpha((unsigned char)c) || c == '"' || c == '_';
}

/* All rows into value (n + 1 columns); value NULL: count them. */
static int rows(steif_context *ctx, const char *path, const char *text, sunindextype n,
                sunrealtype *value, sunindextype *count)
{
  bool first = true;
  long number = 1;
  *count = 0;
  for (const char *line = text; *line; line = stf_next_line(line), number++) {
    if (!stf_has_data(line)) continue;
    const bool names = first && is_header(line);
    first = false;
    if (names) continue;
    if (value) STEIF_TRY(row(ctx, path, number, line, n, value + *count * (n + 1)));
    ++*count;
  }
  return STEIF_OK;
}

/* Times at equal distances into t0 and h, the rest into value. `all`: rows of n + 1. */
static int arrange(steif_function *f, const char *path, const sunrealtype *all)
{
  stf_samples *s = &f->samples;
  const size_t width = (size_t)f->inputs + 1, last = (size_t)s->count - 1;
  s->t0 = all[0];
  s->h = (all[last * width] - all[0]) / (sunrealtype)last;
  STEIF_CHECK(s->h > 0 && isfinite(s->h), f->ctx, STEIF_BAD_INPUT,
              "%s: the times go from %g to %g; let them ascend", path, all[0],
              all[last * width]);
  for (size_t k = 0; k <= last; k++) {
    const sunrealtype t = all[k * width], ideal = s->t0 + (sunrealtype)k * s->h;
    STEIF_CHECK(
      fabs(t - ideal) <= uneven * s->h, f->ctx, STEIF_BAD_INPUT,
      "%s: sample %zu is at t = %.9g, and equal distances of %.9g put it at %.9g; sample "
      "at equal distances and write times with more digits",
      path, k + 1, t, s->h, ideal);
    memcpy(s->value + k * (width - 1), all + k * width + 1, (width - 1) * sizeof *all);
  }
  return STEIF_OK;
}

static int fill(steif_function *f, const char *path, const char *text, SUNMatrix B, int points)
{
  stf_samples *s = &f->samples;
  if (B) STEIF_TRY(stf_function_input(f, B));
  const size_t n = (size_t)f->inputs;
  STEIF_TRY(rows(f->ctx, path, text, f->inputs, NULL, &s->count));
  const int wanted = points ? points : s->count < POINTS ? (int)s->count : POINTS;
  STEIF_CHECK(wanted >= 2 && wanted <= POINTS_MOST, f->ctx, STEIF_BAD_INPUT,
              "formulas over %d points; take from 2 to %d", wanted, POINTS_MOST);
  STEIF_CHECK(s->count >= wanted, f->ctx, STEIF_BAD_INPUT,
              "%s has %lld samples and the formulas take %d; give more samples or fewer points",
              path, (long long)s->count, wanted);
  STEIF_CHECK(n <= strlen(text) / (size_t)s->count, f->ctx, STEIF_BAD_INPUT,
              "%s is too short for %zu components; write t,f_1,... in each line", path, n);
  s->points = wanted;
  s->value = stf_pool_array(f->pool, (size_t)s->count * n, sizeof *s->value);
  s->weights = stf_pool_array(f->pool, (size_t)wanted, sizeof *s->weights);
  if (!s->value || !s->weights) return STEIF_NO_MEMORY;
  sunrealtype *all = stf_allocate(f->ctx, (size_t)s->count * (n + 1), sizeof *all);
  if (!all) return STEIF_NO_MEMORY;
  int code = rows(f->ctx, path, text, f->inputs, all, &s->count);
  if (code == STEIF_OK) code = arrange(f, path, all);
  stf_release(f->ctx, all);
  return code;
}

steif_function *steif_function_samples(steif_context *ctx, const char *path, sunindextype n,
                                       SUNMatrix B, int points, sunrealtype *accuracy)
{
  stf_plain plain;
  char *text = stf_input_text(ctx, path);
  steif_function *f = text ? stf_function_new(ctx, n) : NULL;
  int code = f ? stf_plain_begin(ctx, &plain) : STEIF_OK;
  if (f && code == STEIF_OK) {
    code = fill(f, path, text, B, points);
    stf_plain_end(&plain);
  }
  if (f && code == STEIF_OK && accuracy)
    code = steif_function_accuracy(f, f->samples.t0, 1, accuracy);
  if (code != STEIF_OK) steif_function_free(&f);
  if (text) stf_release(ctx, text);
  return f;
}
