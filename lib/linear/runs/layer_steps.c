/* layer_steps.c: lengths of steps for runs through layers, in blocks of equal ones.
 *
 * Of a block outside its layer the differences of order p + 1, e = max |D x| / (p + 1) T/h in
 * units of the tolerance, T the length of the run, are what errors of h^p add up to.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "layers.h"
#include <math.h>

/* Of a length at once; beyond as many refusals in a row errors that do not become smaller are
 * rounding, which grows as h^-(k-1) or more. */
enum { HALVINGS = 2, PATIENT = 2 };

enum { STRIDE = 4 }; /* steps that a difference is taken over, at most */

typedef struct steady {
  stf_layers *layers;
  steif_layers_step tell;
  void *user;
  int told;          /* rows */
  int rejected;      /* blocks in a row ... */
  sunrealtype least; /* ... and the smallest of their errors */
} steady;

/* Enough rows for a difference, and for a change to half the length behind them. */
static int block(const stf_layers *w) { return w->width + w->past + w->order + 1; }

/* Whole steps to the end. */
static long left(const stf_layers *w)
{
  return lround((w->t1 - (w->kept ? w->t[w->kept - 1] : w->t0)) / w->h);
}

/* Of the differences that end with row `last`, over several steps where so many are clean:
 * rounding has less part in those. */
static sunrealtype difference(const stf_layers *w, int last)
{
  const steif_options *o = &w->options;
  const int q = w->order + 1, room = (last - w->clean) / q;
  const int stride = room < STRIDE ? room : STRIDE;
  sunrealtype most = 0;
  for (int i = 0; i < w->n; i++) {
    sunrealtype sum = 0, size = 0, binomial = 1;
    for (int j = 0; j <= q; j++) {
      const sunrealtype x = w->x[(last - j * stride) * w->n + i];
      sum += binomial * x, size = fmax(size, fabs(x));
      binomial *= -(sunrealtype)(q - j) / (j + 1);
    }
    const sunrealtype allowed = o->rtol * size + (o->atols      ? o->atols[i]
                                                  : o->atol > 0 ? o->atol
                                                                : o->rtol);
    most = fmax(most, fabs(sum) / allowed);
  }
  return most / q / pow(stride, q) * (w->t1 - w->t0) / w->h;
}

/* Rows on trial; 0 where they are too few for a difference, at the end. */
static sunrealtype error_of(const stf_layers *w)
{
  const int first = w->clean + w->order + 1;
  sunrealtype most = 0;
  for (int k = first > w->kept ? first : w->kept; k < w->count; k++)
    most = fmax(most, difference(w, k));
  return most;
}

static int tell(steady *s)
{
  stf_layers *w = s->layers;
  for (int k = s->told; k < w->count; k++) {
    const sunrealtype h = k ? w->t[k] - w->t[k - 1] : w->h;
    w->stats.steps++;
    if (!(w->stats.shortest > 0) || h < w->stats.shortest) w->stats.shortest = h;
    w->stats.longest = fmax(w->stats.longest, h);
    STEIF_CHECK(!s->tell || !s->tell(w->t[k], w->x + k * w->n, k < w->valid, s->user), w->ctx,
                STEIF_CALLBACK, "the output stopped the run at t = %.12g", w->t[k]);
  }
  stf_layers_keep(w);
  s->told = w->kept;
  return STEIF_OK;
}

/* Of the length wanted or a little less: the way to the end in whole steps. */
static sunrealtype whole(const stf_layers *w, sunrealtype h)
{
  const sunrealtype way = w->t1 - (w->kept ? w->t[w->kept - 1] : w->t0);
  return way / ceil(way / h * (1 - 1e-9));
}

static int shrink(steady *s, sunrealtype e)
{
  stf_layers *w = s->layers;
  const sunrealtype wish = ceil(log2(2 * e) / w->order);
  const int halvings = wish < 1 ? 1 : wish > HALVINGS ? HALVINGS : (int)wish;
  const sunrealtype way = w->t1 - (w->kept ? w->t[w->kept - 1] : w->t0);
  const sunrealtype h = fmin(ldexp(w->h, -halvings), way / (w->order + STF_BEYOND));
  w->stats.rejected += w->count - w->kept;
  s->least = s->rejected ? fmin(s->least, e) : e;
  STEIF_CHECK(
    ++s->rejected <= PATIENT || e <= s->least, w->ctx, STEIF_STEP_SIZE,
    "%d blocks of steps in a row were rejected at t = %.12g, the last with h = %.3g and %.3g "
    "times the tolerance, more than with longer ones: that is rounding, which grows as h "
    "falls where the index is %d; loosen the tolerance, or find x(0+) first "
    "(steif_linear_run)",
    s->rejected, w->kept ? w->t[w->kept - 1] : w->t0, w->h, e, w->index);
  return w->kept ? stf_layers_change(w, whole(w, h)) : stf_layers_begin(w, whole(w, h));
}

/* Twice the length, where that is a gain and the values for it are there. */
static int grow(steady *s, sunrealtype e)
{
  stf_layers *w = s->layers;
  const sunrealtype most = w->options.h_max;
  if (left(w) < 4 * block(w) || (most > 0 && 2 * w->h > most)) return STEIF_OK;
  const sunrealtype h = whole(w, 2 * w->h);
  if (ldexp(e, w->order) > 0.5 || !stf_layers_fit(w, h)) return STEIF_OK;
  return stf_layers_change(w, h);
}

static int go(steady *s)
{
  stf_layers *w = s->layers;
  const sunrealtype longest = (w->t1 - w->t0) / (w->opening + 4 * block(w));
  const sunrealtype first = w->options.h0 > 0 ? w->options.h0 : longest;
  STEIF_TRY(stf_layers_begin(w, whole(w, fmin(first, longest))));
  while (w->kept == 0 || w->t[w->kept - 1] < w->t1) {
    STEIF_CHECK(
      w->stats.steps < w->options.max_steps, w->ctx, STEIF_STEP_LIMIT,
      "%ld steps made at t = %.12g, the limit: raise max_steps or loosen the tolerance",
      w->stats.steps, w->t[w->kept - 1]);
    const int from = w->count;
    while (w->count < from + block(w) && steif_time(w->solver) < w->t1)
      STEIF_TRY(stf_layers_step(w));
    const sunrealtype e = error_of(w);
    if (!(e <= 1)) {
      STEIF_TRY(shrink(s, e));
      continue;
    }
    s->rejected = 0;
    STEIF_TRY(tell(s));
    STEIF_TRY(grow(s, e));
  }
  return STEIF_OK;
}

int steif_layers_run(steif_context *ctx, const steif_linear *linear, const sunrealtype *x0,
                     sunrealtype t0, const char *method, const steif_options *options,
                     const steif_analysis *analysis, steif_layers_step tell_, void *user,
                     steif_layers_stats *stats)
{
  stf_layers w;
  STEIF_TRY(stf_layers_open(ctx, linear, x0, t0, method, options, analysis, &w));
  const int code = go(&(steady){.layers = &w, .tell = tell_, .user = user});
  w.stats.width = w.width, w.stats.opening = w.opening;
  if (stats) *stats = w.stats;
  stf_layers_close(&w);
  return code;
}
