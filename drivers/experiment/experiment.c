/* experiment.c: experiments by name, and what they find.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"
#include <math.h>
#include <string.h>

/* Room for one more of `*room` things of this size: doubled in the pool. */
static void *grown(stf_pool *pool, void *old, size_t count, size_t *room, size_t size)
{
  if (count < *room) return old;
  const size_t more = *room ? 2 * *room : 64;
  void *block = stf_pool_array(pool, more, size);
  if (!block) return NULL;
  if (count) memcpy(block, old, count * size);
  *room = more;
  return block;
}

static bool halved(const steif_finding *before, const steif_finding *now)
{
  return !strcmp(before->of, now->of) && !strcmp(before->quantity, "error") &&
         !strcmp(now->quantity, "error") && fabs(before->h / now->h - 2) < 1e-9;
}

int stf_find(stf_trial *t, const char *of, sunrealtype h, const char *quantity,
             sunrealtype value, sunrealtype reference, sunrealtype tolerance)
{
  steif_finding *f = t->finding =
    grown(t->pool, t->finding, t->count, &t->room, sizeof *t->finding);
  if (!f) return STEIF_NO_MEMORY;
  f += t->count++;
  *f = (steif_finding){of, h, quantity, value, reference, NAN, -1, NAN, NAN, NAN};
  if (!isnan(reference)) {
    const sunrealtype off = fabs(value - reference);
    f->error = reference != 0 ? off / fabs(reference) : off;
    f->agrees = off <= tolerance;
  }
  if (t->count > 1 && halved(f - 1, f)) f->order = log2(f[-1].value / value);
  return STEIF_OK;
}

void stf_beside(stf_trial *t, sunrealtype printed, sunrealtype imitated)
{
  steif_finding *f = &t->finding[t->count - 1];
  f->printed = printed;
  f->imitated = imitated;
}

/* -- curves -------------------------------------------------------------------------------------- */

int stf_curve(stf_trial *t, const char *label, int marks)
{
  STEIF_CHECK(t->curves < STF_CURVES, t->ctx, STEIF_BAD_INPUT,
              "the picture has %d curves, no room for '%s'", STF_CURVES, label);
  t->curve[t->curves++] = (steif_curve){label, 0, NULL, NULL, marks};
  return STEIF_OK;
}

/* Room is the next power of two above 63: it doubles where the count reaches one. */
int stf_curve_point(stf_trial *t, sunrealtype x, sunrealtype y)
{
  steif_curve *c = t->curve + t->curves - 1;
  const size_t n = c->count;
  sunrealtype *X = (sunrealtype *)c->x, *Y = (sunrealtype *)c->y;
  if (n == 0 || (n >= 64 && (n & (n - 1)) == 0)) {
    size_t room = n, other = n;
    X = grown(t->pool, X, n, &room, sizeof *X);
    Y = grown(t->pool, Y, n, &other, sizeof *Y);
    if (!X || !Y) return STEIF_NO_MEMORY;
  }
  X[n] = x;
  Y[n] = y;
  c->x = X;
  c->y = Y;
  c->count++;
  return STEIF_OK;
}

/* -- the shelf ----------------------------------------------------------------------------------- */

const char *steif_experiment_name(size_t i, const char **about)
{
  if (i >= stf_experiment_count) return NULL;
  if (about) *about = stf_experiment_shelf[i].item->about;
  return stf_experiment_shelf[i].name;
}

static const stf_experiment_entry *find(const char *name)
{
  for (size_t i = 0; i < stf_experiment_count; i++)
    if (!strcmp(name, stf_experiment_shelf[i].name)) return stf_experiment_shelf + i;
  return NULL;
}

static int run(const steif_experiment *e, stf_trial *t, steif_findings *f)
{
  t->curve = stf_pool_array(t->pool, STF_CURVES, sizeof *t->curve);
  if (!t->curve) return STEIF_NO_MEMORY;
  STEIF_TRY(e->run(t));
  f->count = t->count;
  f->finding = t->finding;
  for (size_t i = 0; i < t->count; i++) {
    f->disagree += t->finding[i].agrees == 0;
    if (!isnan(t->finding[i].printed)) f->printed = 1;
  }
  f->plot = e->frame;
  f->plot.count = t->curves;
  f->plot.curve = t->curve;
  return STEIF_OK;
}

int steif_experiment_run(steif_context *ctx, const char *name, steif_findings *f)
{
  STEIF_CHECK(name && f, ctx, STEIF_BAD_INPUT,
              "the name of an experiment and room for its findings are needed");
  *f = (steif_findings){0};
  const stf_experiment_entry *entry = find(name);
  char guess[STF_GUESS];
  STEIF_CHECK(entry, ctx, STEIF_UNKNOWN_NAME, "no experiment '%s'%s", name,
              stf_guess(name, stf_experiment_shelf, stf_experiment_count,
                        sizeof *stf_experiment_shelf, guess));
  stf_trial t = {.ctx = ctx, .data = entry->item->data, .pool = stf_pool_new(ctx)};
  if (!t.pool) return STEIF_NO_MEMORY;
  f->memory = t.pool;
  f->name = entry->name;
  f->about = entry->item->about;
  const int code = run(entry->item, &t, f);
  if (code) steif_findings_clear(ctx, f);
  return code;
}

void steif_findings_clear(steif_context *ctx, steif_findings *f)
{
  (void)ctx;
  if (!f) return;
  stf_pool *pool = f->memory;
  stf_pool_free(&pool);
  *f = (steif_findings){0};
}
