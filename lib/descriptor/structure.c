/* structure.c: structure and impulses of a descriptor system: what is asked is checked, one of
 * the algorithms is chosen, and its answer is completed. Dense pencils and small ones:
 * staircase and generalised Schur form; large sparse ones: Cauchy integrals or a Krylov space.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "structure.h"
#include "blame.h"
#include "demand.h"
#include "field.h"
#include "pairing.h"
#include "pencil.h"
#include "units.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { SMALL = 400 }; /* sparse pencils up to this order are treated as dense */

static bool is_dense(SUNMatrix M) { return SUNMatGetID(M) == SUNMATRIX_DENSE; }
static sunindextype order(SUNMatrix M)
{
  return is_dense(M) ? SM_COLUMNS_D(M) : SM_COLUMNS_S(M);
}

static int check_finite(steif_context *ctx, const char *name, SUNMatrix M)
{
  const sunindextype n = order(M);
  const sunrealtype *a = is_dense(M) ? SM_DATA_D(M) : SM_DATA_S(M);
  const sunindextype count = is_dense(M) ? SM_LDATA_D(M) : SM_INDEXPTRS_S(M)[n];
  if (stf_all_finite(a, (size_t)count)) return STEIF_OK;
  sunindextype p = 0, j = 0;
  while (isfinite(a[p])) p++;
  while (!is_dense(M) && SM_INDEXPTRS_S(M)[j + 1] <= p) j++;
  return STEIF_FAIL(ctx, STEIF_NOT_FINITE, "entry (%lld, %lld) of %s is %g: all must be finite",
                    (long long)(is_dense(M) ? p % n : SM_INDEXVALS_S(M)[p]),
                    (long long)(is_dense(M) ? p / n : j), name, a[p]);
}

static int check_matrix(steif_context *ctx, const char *name, SUNMatrix M)
{
  STEIF_CHECK(M, ctx, STEIF_BAD_INPUT, "matrix %s is missing", name);
  const SUNMatrix_ID id = SUNMatGetID(M);
  STEIF_CHECK(
    id == SUNMATRIX_DENSE || id == SUNMATRIX_SPARSE, ctx, STEIF_UNSUPPORTED,
    "matrix %s is neither dense nor sparse (SUNMatrix kind %d): copy it to one of them", name,
    (int)id);
  STEIF_CHECK(is_dense(M) || SM_SPARSETYPE_S(M) == CSC_MAT, ctx, STEIF_UNSUPPORTED,
              "matrix %s is stored by rows: convert it with SUNSparseMatrix_ToCSC", name);
  const sunindextype rows = is_dense(M) ? SM_ROWS_D(M) : SM_ROWS_S(M), columns = order(M);
  STEIF_CHECK(rows == columns, ctx, STEIF_BAD_INPUT,
              "matrix %s is %lld x %lld: as many equations as unknowns are needed", name,
              (long long)rows, (long long)columns);
  return check_finite(ctx, name, M);
}

int stf_structure_check(steif_context *ctx, SUNMatrix E, SUNMatrix F)
{
  STEIF_TRY(check_matrix(ctx, "E", E));
  STEIF_TRY(check_matrix(ctx, "F", F));
  STEIF_CHECK(order(E) == order(F), ctx, STEIF_BAD_INPUT,
              "E is of order %lld, F of order %lld: they must be equal", (long long)order(E),
              (long long)order(F));
  return STEIF_OK;
}

static int check(steif_context *ctx, SUNMatrix E, SUNMatrix F, const steif_analysis *analysis)
{
  STEIF_TRY(stf_structure_check(ctx, E, F));
  STEIF_CHECK((int)analysis->algorithm >= STEIF_AUTOMATIC && analysis->algorithm <= STEIF_ARRAY,
              ctx, STEIF_BAD_INPUT, "algorithm %d does not exist: choose 0 .. %d",
              (int)analysis->algorithm, STEIF_ARRAY);
  STEIF_CHECK(!(analysis->radius < 0) && isfinite(analysis->radius), ctx, STEIF_BAD_INPUT,
              "the radius %g of the circle must be positive, or 0 to have it found",
              analysis->radius);
  return STEIF_OK;
}

/* The algorithm meant, STEIF_AUTOMATIC resolved. */
static steif_analysis resolve(SUNMatrix E, SUNMatrix F, const steif_analysis *analysis)
{
  steif_analysis a = analysis ? *analysis : (steif_analysis){0};
  const bool dense = E && F && is_dense(E) && is_dense(F);
  const bool small =
    E && (SUNMatGetID(E) == SUNMATRIX_SPARSE || is_dense(E)) && order(E) <= SMALL;
  if (a.algorithm == STEIF_AUTOMATIC)
    a.algorithm = dense || small ? STEIF_STAIRCASE : STEIF_CONTOUR;
  return a;
}

static bool by_dense(const steif_analysis *a)
{
  return a->algorithm == STEIF_STAIRCASE || a->algorithm == STEIF_QZ;
}

static void take_lists(steif_structure *from, steif_structure *to)
{
  const steif_structure old = *to;
  to->equations = from->equations, to->equations_count = from->equations_count;
  to->unknowns = from->unknowns, to->unknowns_count = from->unknowns_count;
  from->equations = old.equations, from->unknowns = old.unknowns;
}

/* What the pattern alone says: the structural degree, or that and where it is singular. Where it decides
 * the number of finite eigenvalues it also tells all that raise the index, in whatever units. */
static int pattern(steif_context *ctx, SUNMatrix E, SUNMatrix F, const steif_names *names,
                   steif_structure *structure)
{
  sunindextype rank;
  steif_structure found = {.degree = -1};
  int code = stf_matching(ctx, E, F, &rank, &found);
  structure->degree = found.degree;
  if (!code && structure->index > 1 && structure->finite == found.degree)
    take_lists(&found, structure);
  if (!code && rank < structure->n) {
    take_lists(&found, structure);
    structure->certified = 1;
    code = stf_reject_pattern(ctx, E, F, names, rank, structure);
  }
  steif_structure_clear(ctx, &found);
  return code;
}

/* Circles find no s where s E + F is regular: is there none, for the numbers as given? What the
 * pattern alone raises the index by is not to blame. */
static int settle(steif_context *ctx, SUNMatrix E, SUNMatrix F, steif_structure *s)
{
  bool singular = s->degree < 0;
  if (s->regular) return STEIF_OK;
  if (s->degree >= 0) {
    s->equations_count = s->unknowns_count = 0;
    STEIF_TRY(stf_field_singular(ctx, E, F, &singular));
    if (singular) STEIF_TRY(stf_field_offenders(ctx, E, F, s));
    snprintf(
      s->message, sizeof s->message,
      "singular pencil%s (reciprocal condition %.1e at best) although its pattern is not; "
      "look for an equation that follows from others%s",
      singular ? ": det(s E + F) = 0 for all s exactly"
               : " to rounding: s E + F is so at every s tried",
      s->rcond, singular ? "" : " but for rounding");
  }
  s->certified = singular;
  return STEIF_OK;
}

static int find(steif_context *ctx, stf_pool *pool, SUNMatrix E, SUNMatrix F,
                const steif_analysis *analysis, bool whole, steif_structure *structure)
{
  stf_units u;
  if (by_dense(analysis)) {
    STEIF_TRY(stf_dense_structure(ctx, E, F, analysis, whole, structure));
    if (!whole || !structure->regular) structure->count = NAN;
    structure->degree = -1;
    if (!whole) return STEIF_OK;
  }
  STEIF_TRY(stf_units_open(ctx, pool, E, F, &u));
  if (by_dense(analysis)) return pattern(ctx, u.E, u.F, analysis->names, structure);
  STEIF_TRY(stf_contour(ctx, u.E, u.F, analysis, structure));
  return settle(ctx, u.E, u.F, structure);
}

int steif_structure_find(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                         const steif_analysis *analysis, steif_structure *structure)
{
  STEIF_CHECK(structure, ctx, STEIF_BAD_INPUT, "no place for the structure: it is NULL");
  *structure = (steif_structure){.count = NAN, .degree = -1};
  const steif_analysis a = resolve(E, F, analysis);
  STEIF_TRY(check(ctx, E, F, &a));
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  const int code = find(ctx, pool, E, F, &a, true, structure);
  stf_pool_free(&pool);
  if (code != STEIF_OK) steif_structure_clear(ctx, structure);
  return code;
}

typedef struct question {
  steif_context *ctx;
  stf_pool *pool;
  SUNMatrix E, F;
  steif_analysis analysis;
  const sunrealtype *x0;
  sunrealtype t;
  stf_demand demand;
  steif_forcing f;       /* that of the demand; NULL: 0 */
  steif_structure found; /* without the lists of the caller's; its circle is lent */
  bool lent;
  stf_sources sources;
} question;

/* E x(0-) and as many derivatives of f as the index asks for. */
static int collect(question *q, int index)
{
  const size_t n = (size_t)order(q->E), rows = q->f ? (size_t)index : 0;
  sunrealtype *all = stf_claim(q->pool, n * (rows + 1), sizeof *all);
  if (!all) return STEIF_NO_MEMORY;
  stf_sources_product(q->E, q->x0, all);
  q->sources = (stf_sources){(sunindextype)n, index - 1, all, rows ? all + n : NULL};
  if (!rows) return STEIF_OK;
  N_Vector like = N_VNewEmpty_Serial((sunindextype)n, steif_sundials(q->ctx)), g;
  STEIF_CHECK(like, q->ctx, STEIF_NO_MEMORY, "no memory for a vector of %zu values", n);
  g = stf_claim_vector(q->pool, like);
  N_VDestroy(like);
  return g ? stf_sources_force(q->ctx, q->f, &q->demand, q->t, index - 1, g, all + n)
           : STEIF_NO_MEMORY;
}

/* The index to work with: of an undecided one the number of deflations made, or the lower
 * bound. */
static int working(const steif_structure *s)
{
  if (s->index >= 0) return s->index;
  if (s->weyr_count > 0) return s->weyr_count;
  return s->index_least > 1 ? s->index_least : 1;
}

/* There is no answer, and why: all that can be said is found out now. */
static int singular(question *q, const steif_structure *s)
{
  steif_structure why = {.count = NAN, .degree = -1};
  if (!*s->message) STEIF_TRY(find(q->ctx, q->pool, q->E, q->F, &q->analysis, true, &why));
  const int code =
    STEIF_FAIL(q->ctx, STEIF_SINGULAR, "x(0+) does not exist or is not unique: %s",
               *s->message ? s->message : why.message);
  steif_structure_clear(q->ctx, &why);
  return code;
}

static int know(question *q, const steif_structure *structure, int *index)
{
  const bool given =
    structure && structure->n == order(q->E) && structure->method &&
    (structure->index >= 0 || structure->weyr_count || !by_dense(&q->analysis));
  STEIF_CHECK(!structure || structure->n == order(q->E), q->ctx, STEIF_BAD_INPUT,
              "the structure is of order %lld, E of order %lld: give that of this pencil",
              (long long)structure->n, (long long)order(q->E));
  if (!given) STEIF_TRY(find(q->ctx, q->pool, q->E, q->F, &q->analysis, false, &q->found));
  const steif_structure *s = given ? structure : &q->found;
  if (!s->regular) return singular(q, s);
  *index = working(s);
  q->demand.finite = s->finite;
  if (given) {
    q->found = *structure, q->lent = true;
    q->found.weyr = q->found.equations = q->found.unknowns = NULL;
    q->found.weyr_count = 0, q->found.equations_count = q->found.unknowns_count = 0;
  }
  return STEIF_OK;
}

static int solve(question *q, const steif_structure *structure, steif_impulse *impulse)
{
  int index = 0;
  stf_units u;
  STEIF_CHECK(stf_all_finite(q->x0, (size_t)order(q->E)), q->ctx, STEIF_NOT_FINITE,
              "x(0-) is not finite: all %lld values must be", (long long)order(q->E));
  STEIF_TRY(know(q, structure, &index));
  STEIF_TRY(collect(q, index));
  if (by_dense(&q->analysis))
    return stf_dense_impulse(q->ctx, q->E, q->F, &q->analysis, q->x0, &q->sources, impulse);
  const sunrealtype *x0 = q->x0;
  stf_sources sources = q->sources;
  STEIF_TRY(stf_units_open(q->ctx, q->pool, q->E, q->F, &u));
  STEIF_TRY(stf_units_enter(q->pool, &u, &x0, &sources));
  const enum steif_algorithm by = q->analysis.algorithm;
  const int code = (by == STEIF_DRAZIN  ? stf_drazin_impulse
                    : by == STEIF_ARRAY ? stf_array_impulse
                                        : stf_contour_impulse)(
    q->ctx, u.E, u.F, &q->analysis, x0, &sources, &q->found, impulse);
  impulse->resolution = q->found.resolution;
  if (!code) stf_units_leave(&u, impulse);
  return code;
}

int steif_impulse_find(steif_context *ctx, SUNMatrix E, SUNMatrix F, const sunrealtype *x0,
                       sunrealtype t, steif_forcing f, void *user,
                       const steif_analysis *analysis, const steif_structure *structure,
                       steif_impulse *impulse)
{
  question q = {.ctx = ctx, .E = E, .F = F, .x0 = x0, .t = t, .f = f ? stf_demand_value : NULL};
  STEIF_CHECK(impulse, ctx, STEIF_BAD_INPUT, "no place for the impulse: it is NULL");
  *impulse = (steif_impulse){0};
  STEIF_CHECK(x0, ctx, STEIF_BAD_INPUT, "x(0-) is missing");
  q.analysis = resolve(E, F, analysis);
  q.demand = stf_demand_of(ctx, &(steif_linear){E, F, f, user}, &q.analysis);
  STEIF_TRY(check(ctx, E, F, &q.analysis));
  if (!(q.pool = stf_pool_new(ctx))) return STEIF_NO_MEMORY;
  const int code = solve(&q, structure, impulse);
  if (code == STEIF_OK)
    stf_impulse_residuals(E, F, x0, q.sources.f, impulse);
  else
    steif_impulse_clear(ctx, impulse);
  if (q.lent) q.found.circle = NULL;
  steif_structure_clear(ctx, &q.found);
  stf_pool_free(&q.pool);
  stf_demand_close(&q.demand);
  return code;
}

/* Without forcing x(0+) = Pi_s x(0-). */
int steif_projector_apply(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                          const steif_analysis *analysis, const steif_structure *structure,
                          const sunrealtype *x, sunrealtype *slow)
{
  steif_impulse i;
  STEIF_CHECK(slow, ctx, STEIF_BAD_INPUT, "no place for the projected vector: it is NULL");
  const int code = steif_impulse_find(ctx, E, F, x, 0, NULL, NULL, analysis, structure, &i);
  if (!code) memcpy(slow, i.x_plus, (size_t)i.n * sizeof *slow);
  if (!code) steif_impulse_clear(ctx, &i);
  return code;
}

int steif_projector_find(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                         const steif_analysis *analysis, sunrealtype *P)
{
  STEIF_CHECK(P, ctx, STEIF_BAD_INPUT, "no place for the projector: it is NULL");
  steif_analysis a = resolve(E, F, analysis);
  STEIF_TRY(check(ctx, E, F, &a));
  STEIF_CHECK(
    by_dense(&a), ctx, STEIF_UNSUPPORTED,
    "the projector of order %lld is dense: choose the staircase to have it all the same",
    (long long)order(E));
  return stf_dense_parts(ctx, E, F, &a, &(stf_pieces){.slow = P});
}
