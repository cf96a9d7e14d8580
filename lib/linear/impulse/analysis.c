/* analysis.c: structure and start of a descriptor system, E x' + F x = f from x(0-), on one page. Dense
 * pencils and small ones by staircase and generalised Schur form; large sparse ones by circles.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "analysis_options.h"
#include "contour.h"
#include "demand.h"
#include "dense_algorithm.h"
#include "pencil.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { SMALL = 400 }; /* sparse pencils up to this order are treated as dense */

/* The forcing, of which only derivatives that matter are asked for. */
typedef struct forcing {
  stf_demand demand;
  steif_forcing f; /* NULL: 0 */
  sunrealtype t;
} forcing;

static int collect_sources(stf_descriptor *d, forcing *f);
static int no_start(stf_descriptor *d);

/* Algorithms measure in units of their own; what is said of the error holds in those given as well. */
static void estimate_as_given(stf_descriptor *d)
{
  steif_impulse *i = d->impulse;
  const sunrealtype off = stf_sources_length(i->n, d->apart);
  if (!(off > 0)) return;
  const sunrealtype plus = stf_sources_length(i->n, i->x_plus),
                    by = stf_sources_measure(&d->sources, plus, stf_sources_frobenius(d->E),
                                             stf_sources_frobenius(d->F));
  i->estimate = fmax(i->estimate, by > 0 ? off / by : INFINITY);
}

/* One pencil from its entries to the sentence; f NULL: the structure alone. */
static int analyse(const stf_algorithm *by, stf_descriptor *d, forcing *f)
{
  STEIF_TRY(by->scale(d));
  if (!d->structure_known) STEIF_TRY(by->structure(d));
  if (!d->structure->regular) {
    if (!d->structure_known) STEIF_TRY(by->singular(d));
    return f ? no_start(d) : STEIF_OK;
  }
  if (f) STEIF_TRY(collect_sources(d, f));
  if (f && !(d->apart = stf_pool_array(d->pool, (size_t)d->structure->n, sizeof *d->apart)))
    return STEIF_NO_MEMORY;
  STEIF_TRY(by->solve(d, 0));
  STEIF_TRY(by->solve(d, 1));
  STEIF_TRY(by->compare(d));
  STEIF_TRY(by->certify(d));
  if (f) estimate_as_given(d);
  return by->say(d);
}

/* -- right-hand sides ----------------------------------------------------------------------- */

/* The index to work with: of an undecided one the number of deflations made, or the lower
 * bound. */
static int working_index(const steif_structure *s)
{
  if (s->index >= 0) return s->index;
  if (s->weyr_count > 0) return s->weyr_count;
  return s->index_least > 1 ? s->index_least : 1;
}

/* E x(0-) and as many derivatives of f as the index asks for. */
static int collect_sources(stf_descriptor *d, forcing *f)
{
  const int index = working_index(d->structure);
  const size_t n = (size_t)d->structure->n, rows = f->f ? (size_t)index : 0;
  sunrealtype *all = stf_pool_array(d->pool, n * (rows + 1), sizeof *all);
  if (!all) return STEIF_NO_MEMORY;
  f->demand.finite = d->structure->finite;
  stf_sources_product(d->E, d->x0, all);
  d->sources = (stf_sources){(sunindextype)n, index - 1, all, rows ? all + n : NULL};
  if (!rows) return STEIF_OK;
  N_Vector like = N_VNewEmpty_Serial((sunindextype)n, steif_sundials(d->ctx)), g;
  STEIF_CHECK(like, d->ctx, STEIF_NO_MEMORY, "no memory for a vector of %zu values", n);
  g = stf_pool_vector(d->pool, like);
  N_VDestroy(like);
  return g ? stf_sources_force(d->ctx, f->f, &f->demand, f->t, index - 1, g, all + n)
           : STEIF_NO_MEMORY;
}

static int no_start(stf_descriptor *d)
{
  return STEIF_FAIL(d->ctx, STEIF_SINGULAR, "x(0+) does not exist or is not unique: %s",
                    d->structure->message);
}

/* -- the algorithm -------------------------------------------------------------------------- */

static bool is_dense(SUNMatrix M) { return M && SUNMatGetID(M) == SUNMATRIX_DENSE; }

static bool is_small(SUNMatrix M)
{
  if (is_dense(M)) return SM_COLUMNS_D(M) <= SMALL;
  return M && SUNMatGetID(M) == SUNMATRIX_SPARSE && SM_COLUMNS_S(M) <= SMALL;
}

steif_analysis stf_analysis_resolved(SUNMatrix E, SUNMatrix F, const steif_analysis *analysis)
{
  steif_analysis a = analysis ? *analysis : (steif_analysis){0};
  const bool dense = (is_dense(E) && is_dense(F)) || is_small(E);
  if (a.algorithm == STEIF_AUTOMATIC) a.algorithm = dense ? STEIF_STAIRCASE : STEIF_CONTOUR;
  return a;
}

bool stf_analysis_dense(const steif_analysis *a)
{
  return a->algorithm == STEIF_STAIRCASE || a->algorithm == STEIF_QZ;
}

static const stf_algorithm *algorithm_of(const steif_analysis *a)
{
  return stf_analysis_dense(a) ? &stf_dense_algorithm : &stf_contour_algorithm;
}

int stf_analysis_check(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                       const steif_analysis *analysis)
{
  STEIF_TRY(stf_structure_check(ctx, E, F));
  STEIF_CHECK((int)analysis->algorithm >= STEIF_AUTOMATIC &&
                analysis->algorithm <= STEIF_CONTOUR,
              ctx, STEIF_BAD_INPUT, "algorithm %d does not exist: choose 0 .. %d",
              (int)analysis->algorithm, STEIF_CONTOUR);
  STEIF_CHECK(!(analysis->radius < 0) && isfinite(analysis->radius), ctx, STEIF_BAD_INPUT,
              "the radius %g of the circle must be positive, or 0 to have it found",
              analysis->radius);
  return STEIF_OK;
}

static int run(stf_descriptor *d, forcing *f)
{
  const stf_algorithm *by = algorithm_of(&d->options);
  d->pool = stf_pool_new(d->ctx);
  if (!d->pool) return STEIF_NO_MEMORY;
  const int code = analyse(by, d, f);
  by->close(d);
  return code;
}

/* What staircase and Schur form leave open circles may decide, which have exact ranks beside them: are they asked,
 * and the answer taken if it is certified? Their failures are none. */
static bool asks_circles(const steif_analysis *wanted, const steif_analysis *used)
{
  return (!wanted || wanted->algorithm == STEIF_AUTOMATIC) && stf_analysis_dense(used);
}

bool stf_found_by_circles(const steif_structure *s)
{
  return s && s->method && !strcmp(s->method, "contour");
}

/* -- structure ------------------------------------------------------------------------------ */

/* Of a regular pencil. */
static int structure_by_circles(const stf_descriptor *open, steif_structure *structure)
{
  steif_structure other = {.count = NAN, .degree = -1, .exact = -1};
  stf_descriptor d = {.ctx = open->ctx,
                      .E = open->E,
                      .F = open->F,
                      .structure = &other,
                      .options = open->options};
  d.options.algorithm = STEIF_CONTOUR;
  const int code = run(&d, NULL);
  stf_pool_free(&d.pool);
  const bool taken = !code && other.regular && other.certified;
  steif_structure_clear(open->ctx, taken ? structure : &other);
  if (taken) *structure = other;
  if (code == STEIF_NO_MEMORY || code == STEIF_STOPPED) return code;
  steif_forget(open->ctx);
  return STEIF_OK;
}

int steif_structure_find(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                         const steif_analysis *analysis, steif_structure *structure)
{
  STEIF_CHECK(structure, ctx, STEIF_BAD_INPUT, "no place for the structure: it is NULL");
  *structure = (steif_structure){.count = NAN, .degree = -1, .exact = -1};
  stf_descriptor d = {.ctx = ctx, .E = E, .F = F, .structure = structure};
  d.options = stf_analysis_resolved(E, F, analysis);
  STEIF_TRY(stf_analysis_check(ctx, E, F, &d.options));
  int code = run(&d, NULL);
  stf_pool_free(&d.pool);
  if (!code && asks_circles(analysis, &d.options) && structure->regular &&
      !structure->certified)
    code = structure_by_circles(&d, structure);
  if (code != STEIF_OK) steif_structure_clear(ctx, structure);
  return code;
}

/* -- start ---------------------------------------------------------------------------------- */

/* Does the structure given say what is needed? */
static bool is_known(const steif_structure *s, const steif_analysis *a)
{
  if (!s || !s->method || (!s->regular && !*s->message)) return false;
  return s->index >= 0 || s->weyr_count || !stf_analysis_dense(a);
}

/* The structure given without its lists, which stay the caller's, as do its factors. */
static steif_structure borrowed(const steif_structure *given)
{
  steif_structure s = *given;
  s.weyr = s.equations = s.unknowns = NULL;
  s.equations_count = s.unknowns_count = 0;
  return s;
}

/* Two radii may agree on what is wrong: no answer is certified that leaves F c_0 + E (x(0+) - x(0-)) = 0
 * unfulfilled, which no circle has a part in. Right ones were below 1e-9. */
static void check_equations(steif_impulse *out)
{
  static const sunrealtype most = 1e-4;
  if (!out->certified || out->first <= most) return;
  out->certified = 0;
  snprintf(out->message, sizeof out->message,
           "not certified: x(0+) and the impulses leave %.1e of F c_0 + E (x(0+) - x(0-)) = 0, "
           "relative to its terms; scale time or the equations, or use another algorithm",
           out->first);
}

/* In the units given an error may be larger than in those of the analysis: the same bound holds for both. */
static void check_estimate(steif_impulse *out)
{
  static const sunrealtype most = 1e-3; /* up to which differences follow the error */
  if (!out->certified || out->estimate <= most) return;
  out->certified = 0;
  snprintf(out->message, sizeof out->message,
           "not certified: in the units given x(0+) is known to %.1e of its size, or of a "
           "thousandth of "
           "x(0-); take units in which unknowns are of one size",
           out->estimate);
}

static int find_start(stf_descriptor *d, forcing *f, const steif_structure *given)
{
  const sunindextype n = is_dense(d->E) ? SM_COLUMNS_D(d->E) : SM_COLUMNS_S(d->E);
  STEIF_CHECK(stf_all_finite(d->x0, (size_t)n), d->ctx, STEIF_NOT_FINITE,
              "x(0-) is not finite: all %lld values must be", (long long)n);
  STEIF_CHECK(!given || given->n == n, d->ctx, STEIF_BAD_INPUT,
              "the structure is of order %lld, E of order %lld: give that of this pencil",
              (long long)given->n, (long long)n);
  steif_structure s = {.count = NAN, .degree = -1, .exact = -1};
  d->structure_known = is_known(given, &d->options);
  if (d->structure_known) s = borrowed(given);
  d->structure = &s;
  int code = run(d, f);
  if (code == STEIF_OK) {
    stf_impulse_residuals(d->E, d->F, d->x0, d->impulse);
    check_equations(d->impulse);
    check_estimate(d->impulse);
  } else {
    steif_impulse_clear(d->ctx, d->impulse);
  }
  if (d->structure_known) s.kept = NULL;
  steif_structure_clear(d->ctx, &s);
  stf_pool_free(&d->pool);
  return code;
}

static int start_by_circles(const stf_descriptor *open, forcing *f)
{
  steif_impulse other = {0}, *first = open->impulse;
  stf_descriptor d = {.ctx = open->ctx,
                      .E = open->E,
                      .F = open->F,
                      .x0 = open->x0,
                      .impulse = &other,
                      .options = open->options};
  d.options.algorithm = STEIF_CONTOUR;
  const int code = find_start(&d, f, NULL);
  const bool taken = !code && other.certified;
  steif_impulse_clear(open->ctx, taken ? first : &other);
  if (taken) *first = other;
  if (code == STEIF_NO_MEMORY || code == STEIF_STOPPED || code == STEIF_CALLBACK) return code;
  steif_forget(open->ctx);
  return STEIF_OK;
}

int steif_impulse_find(steif_context *ctx, SUNMatrix E, SUNMatrix F, const sunrealtype *x0,
                       sunrealtype t, steif_forcing f, void *user,
                       const steif_analysis *analysis, const steif_structure *structure,
                       steif_impulse *impulse)
{
  STEIF_CHECK(impulse, ctx, STEIF_BAD_INPUT, "no place for the impulse: it is NULL");
  *impulse = (steif_impulse){0};
  STEIF_CHECK(x0, ctx, STEIF_BAD_INPUT, "x(0-) is missing");
  stf_descriptor d = {.ctx = ctx, .E = E, .F = F, .x0 = x0, .impulse = impulse};
  d.options = stf_analysis_resolved(E, F, analysis);
  if (asks_circles(analysis, &d.options) && stf_found_by_circles(structure))
    d.options.algorithm = STEIF_CONTOUR;
  STEIF_TRY(stf_analysis_check(ctx, E, F, &d.options));
  forcing wanted = {.f = f ? stf_demand_value : NULL, .t = t};
  wanted.demand = stf_demand_of(ctx, &(steif_linear){E, F, f, user}, &d.options);
  int code = find_start(&d, &wanted, structure);
  if (!code && asks_circles(analysis, &d.options) && !impulse->certified)
    code = start_by_circles(&d, &wanted);
  if (code) steif_impulse_clear(ctx, impulse);
  stf_demand_close(&wanted.demand);
  return code;
}
