/* dense_algorithm.c: two independent algorithms on one dense pencil, staircase and generalised Schur
 * form with equally many infinite eigenvalues. The result is certified when N^k of the Schur form is
 * rounding at the same k and both give the same x(0+) and impulses, from a random x(0-) when only the
 * structure is asked for.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "dense_algorithm.h"
#include "dense_agreement.h"
#include "dense_algebra.h"
#include "dense_thresholds.h"
#include "dense_units.h"
#include "prime_field.h"
#include "sentences.h"
#include "staircase.h"
#include "structural.h"
#include "units.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { STAIRCASE, SCHUR };

typedef struct dense {
  stf_dense_units units;
  sunrealtype *x0, *difference; /* of the unknowns in these units */
  stf_sources sources;
  steif_structure staircase, schur; /* staircase: with a start, else it is the descriptor's */
  steif_structure *found;           /* which of them */
  steif_impulse answer[2];
  stf_both_ways both;
  steif_structure pattern; /* degree and lists */
  sunindextype pattern_rank;
  const char *objection;
  char text[240];
} dense;

/* -- units and right-hand sides ------------------------------------------------------------- */

static int scale(stf_descriptor *d)
{
  dense *p = d->state = stf_pool_array(d->pool, 1, sizeof *p);
  if (!p) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_dense_units_choose(d->ctx, d->pool, &d->options, d->E, d->F, &p->units));
  p->both.other_index = p->units.other_index;
  p->pattern.degree = -1;
  const size_t n = (size_t)p->units.n;
  p->pattern_rank = p->units.n;
  p->x0 = stf_pool_array(d->pool, 2 * n, sizeof *p->x0);
  if (!p->x0) return STEIF_NO_MEMORY;
  p->difference = p->x0 + n;
  return STEIF_OK;
}

/* A random x(0-) without forcing. */
static int random_start(const stf_descriptor *d, dense *p)
{
  const int n = p->units.n;
  uint64_t state = d->options.seed ? d->options.seed : 1;
  sunrealtype *Ex0 = stf_pool_array(d->pool, (size_t)n, sizeof *Ex0);
  if (!Ex0) return STEIF_NO_MEMORY;
  for (int i = 0; i < n; i++) p->x0[i] = stf_draw(&state);
  stf_gemm('N', 'N', n, 1, n, 1, p->units.E, n, p->x0, n, 0, Ex0, n);
  p->sources = (stf_sources){n, -1, Ex0, NULL};
  return STEIF_OK;
}

static int given_start(const stf_descriptor *d, dense *p)
{
  const stf_sources *from = &d->sources;
  const sunrealtype *row = p->units.row;
  const size_t n = (size_t)p->units.n, rows = from->f ? (size_t)from->derivatives + 1 : 0;
  sunrealtype *all = stf_pool_array(d->pool, n * (rows + 1), sizeof *all);
  if (!all) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < n; i++) {
    p->x0[i] = d->x0[i] / p->units.column[i];
    all[i] = from->Ex0[i] * row[i];
    for (size_t j = 0; j < rows; j++) all[(j + 1) * n + i] = from->f[j * n + i] * row[i];
  }
  p->sources = (stf_sources){p->units.n, from->derivatives, all, rows ? all + n : NULL};
  return STEIF_OK;
}

/* -- both ways ------------------------------------------------------------------------------ */

static int staircase(stf_descriptor *d, dense *p, steif_structure *found, bool start)
{
  const stf_dense_units *u = &p->units;
  p->found = found;
  return stf_staircase(d->ctx, u->n, u->E, u->F, &d->options, start ? &p->sources : NULL, found,
                       &p->answer[STAIRCASE], NULL);
}

/* Whatever rounding makes of them, entries whose det(s E + F) is 0 for all s are those of a singular
 * pencil; a rank that is full at one s modulo one prime proves that they are not. */
static int look_exactly(stf_descriptor *d)
{
  steif_structure *s = d->structure;
  stf_field field;
  bool singular;
  if (!s->regular) return STEIF_OK;
  STEIF_TRY(stf_field_open(d->ctx, d->E, d->F, d->options.snap, &field));
  STEIF_TRY(stf_field_singular(d->ctx, &field, &singular));
  if (!singular) return STEIF_OK;
  s->regular = 0;
  s->index = -1;
  s->index_least = 0;
  s->finite = s->infinite = -1;
  s->weyr_count = 0;
  return STEIF_OK;
}

/* Without x(0-) the start of the first way comes with the structure. */
static int structure(stf_descriptor *d)
{
  dense *p = d->state;
  if (!d->x0) STEIF_TRY(random_start(d, p));
  STEIF_TRY(staircase(d, p, d->structure, !d->x0));
  d->structure->count = NAN;
  d->structure->degree = -1;
  return look_exactly(d);
}

static int solve(stf_descriptor *d, int way)
{
  dense *p = d->state;
  const stf_dense_units *u = &p->units;
  sunindextype infinite = 0;
  if (way == STAIRCASE && !d->x0) return STEIF_OK;
  if (way == STAIRCASE) {
    STEIF_TRY(given_start(d, p));
    STEIF_TRY(staircase(d, p, &p->staircase, true));
    STEIF_CHECK(
      p->staircase.regular, d->ctx, STEIF_SINGULAR,
      "the pencil is singular (reciprocal condition %.1e at best): x(0+) does not exist "
      "or is not unique; see the structure for the equations",
      p->staircase.rcond);
    return STEIF_OK;
  }
  for (int i = 0; i < p->found->weyr_count; i++) infinite += p->found->weyr[i];
  return stf_schur(d->ctx, u->n, u->E, u->F, (int)infinite, &p->sources, &p->schur,
                   &p->answer[SCHUR]);
}

/* -- comparison ----------------------------------------------------------------------------- */

static stf_two_starts starts(const stf_descriptor *d, dense *p)
{
  return (stf_two_starts){.ctx = d->ctx,
                          .pool = d->pool,
                          .units = &p->units,
                          .analysis = &d->options,
                          .sources = &p->sources,
                          .x0 = p->x0,
                          .one = &p->answer[STAIRCASE],
                          .two = &p->answer[SCHUR],
                          .difference = p->difference,
                          .apart = d->apart};
}

/* Without x(0-) no answer is given whose error would matter: then both ways may differ by what rounding
 * of the entries makes of any answer. */
static int compare_starts(stf_descriptor *d, dense *p)
{
  const stf_two_starts both = starts(d, p);
  sunrealtype moved = 0;
  p->both.off = stf_starts_apart(&both);
  p->both.agreed = stf_starts_agree(&both, STF_AGREEMENT);
  if (d->x0 || !p->both.agreed) STEIF_TRY(stf_start_moves(&both, &moved));
  if (d->x0)
    p->both.moved = moved;
  else if (!p->both.agreed)
    p->both.agreed = stf_starts_agree(&both, fmin(STF_LEAST_AGREEMENT, STF_EXPLAINED * moved));
  return STEIF_OK;
}

/* What the pattern alone says: the structural degree, and who raises the index or is left over. */
static int find_pattern(stf_descriptor *d, dense *p)
{
  stf_units u;
  if (d->x0) return STEIF_OK;
  STEIF_TRY(stf_units_open(d->ctx, d->pool, d->E, d->F, &u));
  return stf_structural_rank(d->ctx, u.E, u.F, &p->pattern_rank, &p->pattern);
}

static int compare(stf_descriptor *d)
{
  dense *p = d->state;
  sunindextype degree;
  STEIF_TRY(stf_dense_carried(d->ctx, &p->units, &p->both.carried));
  STEIF_TRY(stf_dense_degree(d->ctx, &p->units, &degree));
  p->both.resolution = fmin(p->found->resolution, p->schur.resolution);
  if (p->found->finite == degree) p->both.resolution = INFINITY;
  p->found->count = NAN;
  if (p->schur.index >= 0) {
    STEIF_TRY(stf_jensen(d->pool, p->units.n, p->units.E, p->units.F, p->schur.radius,
                         p->schur.resolution, &p->found->count));
    STEIF_TRY(compare_starts(d, p));
  }
  return find_pattern(d, p);
}

/* -- certificate ---------------------------------------------------------------------------- */

static void take_lists(steif_structure *from, steif_structure *to)
{
  const steif_structure old = *to;
  to->equations = from->equations;
  to->equations_count = from->equations_count;
  to->unknowns = from->unknowns;
  to->unknowns_count = from->unknowns_count;
  from->equations = old.equations;
  from->unknowns = old.unknowns;
}

/* What two algorithms, or two units, see differently is not decided. */
static void doubt(steif_structure *s, int by_schur, int in_other_units)
{
  int least = by_schur >= 0 && by_schur < s->index ? by_schur : s->index;
  if (in_other_units >= 0 && in_other_units < least) least = in_other_units;
  const bool agreed = in_other_units < 0 && (by_schur < 0 || by_schur == s->index);
  if (s->index < 0 || agreed) return;
  s->index_least = least;
  s->index = -1;
  s->finite = s->infinite = -1;
}

/* Where the pattern decides the number of finite eigenvalues it also tells all that raise the index,
 * in whatever units. */
static void certify_structure(stf_descriptor *d, dense *p)
{
  steif_structure *s = d->structure;
  s->certified = !p->objection;
  s->radius = p->schur.radius;
  s->resolution = p->both.resolution;
  if (d->options.algorithm == STEIF_QZ) {
    s->method = "qz";
    if (p->schur.index >= 0) s->gap = p->schur.gap;
  }
  doubt(s, p->schur.index, p->both.other_index);
  s->degree = p->pattern.degree;
  if (s->index > 1 && s->finite == p->pattern.degree) take_lists(&p->pattern, s);
}

/* Back to the unknowns as they were given. */
static void unscale(const stf_dense_units *u, steif_impulse *impulse)
{
  for (int j = 0; j < u->n; j++) {
    impulse->x_plus[j] *= u->column[j];
    for (int i = 0; i < impulse->count; i++)
      impulse->c[(size_t)i * (size_t)u->n + (size_t)j] *= u->column[j];
  }
}

static void certify_start(stf_descriptor *d, dense *p)
{
  const bool both = p->schur.index >= 0, qz = both && d->options.algorithm == STEIF_QZ;
  steif_impulse *from = &p->answer[qz ? SCHUR : STAIRCASE];
  unscale(&p->units, &p->answer[STAIRCASE]);
  if (both) unscale(&p->units, &p->answer[SCHUR]);
  for (int j = 0; j < p->units.n; j++) d->apart[j] *= p->units.column[j];
  *d->impulse = *from;
  d->impulse->estimate = both ? fmax(p->both.off, STF_DRAW_FACTOR * p->both.moved) : INFINITY;
  d->impulse->method = qz ? "qz" : "staircase";
  d->impulse->certified = !p->objection;
  d->impulse->resolution = p->both.resolution;
  *from = (steif_impulse){0};
}

static int certify(stf_descriptor *d)
{
  dense *p = d->state;
  p->both.staircase = p->found;
  p->both.schur = &p->schur;
  p->objection = stf_dense_objection(&p->both, p->text, sizeof p->text);
  if (d->x0)
    certify_start(d, p);
  else
    certify_structure(d, p);
  return STEIF_OK;
}

/* -- sentences ------------------------------------------------------------------------------ */

static void say_start(const stf_descriptor *d, const dense *p)
{
  steif_impulse *i = d->impulse;
  const bool qz = !strcmp(i->method, "qz");
  char from_on[64] = "";
  if (!p->objection && isfinite(p->both.resolution))
    snprintf(from_on, sizeof from_on, " for time scales from %.1e on", 1 / p->both.resolution);
  snprintf(i->message, sizeof i->message,
           "index %d, %d impulse coefficient%s by the %s; %s%s%s", i->index, i->count,
           i->count == 1 ? "" : "s", qz ? "generalised Schur form" : "staircase",
           p->objection ? "not certified: " : "certified by the other algorithm",
           p->objection ? p->objection : "", from_on);
}

/* A pattern without a perfect matching is singular whatever the entries are. */
static int say_pattern(const stf_descriptor *d, dense *p)
{
  steif_structure *s = d->structure;
  if (p->pattern_rank >= s->n) return STEIF_OK;
  take_lists(&p->pattern, s);
  s->certified = 1;
  return stf_say_singular_pattern(d->ctx, d->E, d->F, d->options.names, p->pattern_rank, s);
}

static int say(stf_descriptor *d)
{
  dense *p = d->state;
  const bool qz = d->options.algorithm == STEIF_QZ;
  if (d->x0)
    say_start(d, p);
  else {
    stf_dense_message(d->structure, p->objection, qz ? "staircase" : "generalised Schur form");
    STEIF_TRY(say_pattern(d, p));
  }
  return STEIF_OK;
}

static int singular(stf_descriptor *d)
{
  dense *p = d->state;
  bool exactly;
  stf_field field;
  stf_units u;
  steif_structure *s = d->structure;
  STEIF_TRY(stf_field_open(d->ctx, d->E, d->F, d->options.snap, &field));
  STEIF_TRY(stf_field_singular(d->ctx, &field, &exactly));
  s->certified = exactly;
  STEIF_TRY(stf_units_open(d->ctx, d->pool, d->E, d->F, &u));
  if (exactly) STEIF_TRY(stf_structural_dependent(d->ctx, u.E, u.F, s));
  stf_dense_message(s, NULL, NULL);
  STEIF_TRY(stf_structural_rank(d->ctx, u.E, u.F, &p->pattern_rank, &p->pattern));
  s->degree = p->pattern.degree;
  return say_pattern(d, p);
}

static void close(stf_descriptor *d)
{
  dense *p = d->state;
  if (!p) return;
  steif_structure_clear(d->ctx, &p->staircase);
  steif_structure_clear(d->ctx, &p->schur);
  steif_structure_clear(d->ctx, &p->pattern);
  for (int way = STAIRCASE; way <= SCHUR; way++) steif_impulse_clear(d->ctx, &p->answer[way]);
}

const stf_algorithm stf_dense_algorithm = {.scale = scale,
                                           .structure = structure,
                                           .singular = singular,
                                           .solve = solve,
                                           .compare = compare,
                                           .certify = certify,
                                           .say = say,
                                           .close = close};
