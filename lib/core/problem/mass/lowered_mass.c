/* lowered_mass.c: M(t, y) y' = f(t, y) as F(t, y, y') = 0, which every implicit method takes. dF/dy holds
 * d(M y')/dy: where M depends on y, F is differenced as a whole.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "varying_mass.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

typedef struct lowered {
  steif_problem from, problem;
  SUNMatrix M;
  N_Vector product, work[4];
  int variation;
  bool regular;
} lowered;

/* -- callbacks ------------------------------------------------------------------------------ */

static int fill_mass(lowered *l, sunrealtype t, N_Vector y, N_Vector yp)
{
  if (SUNMatGetID(l->M) != SUNMATRIX_SPARSE && SUNMatZero(l->M)) return -1;
  const int returned = l->from.E(t, y, yp, l->M, l->from.user);
  if (returned || SUNMatGetID(l->M) != SUNMATRIX_SPARSE) return returned;
  const sunindextype used = SM_INDEXPTRS_S(l->M)[l->from.n];
  return used >= 0 && used <= SM_NNZ_S(l->M) ? 0 : -1;
}

static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  lowered *l = user;
  int returned = l->from.f(t, y, r, l->from.user);
  if (returned) return returned;
  if (l->M) {
    returned = fill_mass(l, t, y, yp);
    if (!returned && SUNMatMatvec(l->M, yp, l->product)) returned = -1;
  } else
    returned = l->from.Ev(t, y, yp, yp, l->product, l->from.user);
  if (!returned) N_VLinearSum(1, l->product, -1, r, r);
  return returned;
}

static int E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  const lowered *l = user;
  return l->from.E(t, y, yp, M, l->from.user);
}

static int A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  const lowered *l = user;
  const steif_problem *p = &l->from;
  N_Vector const *w = l->work;
  if (p->A) return p->A(t, y, yp, M, p->user);
  const int returned = p->f(t, y, w[0], p->user);
  return returned ? returned : p->jac(t, y, w[0], M, p->user, w[1], w[2], w[3]);
}

static int Ev(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  const lowered *l = user;
  return l->from.Ev(t, y, yp, x, out, l->from.user);
}

static int Av(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  const lowered *l = user;
  return l->from.Av(t, y, yp, x, out, l->from.user);
}

static int Etv(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  const lowered *l = user;
  return l->from.Etv(t, y, yp, x, out, l->from.user);
}

static int Atv(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  const lowered *l = user;
  return l->from.Atv(t, y, yp, x, out, l->from.user);
}

static int precsetup(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c,
                     void *user)
{
  const lowered *l = user;
  return l->from.precsetup(t, y, yp, r, c, l->from.user);
}

static int precsolve(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
                     sunrealtype c, sunrealtype delta, void *user)
{
  const lowered *l = user;
  return l->from.precsolve(t, y, yp, r, b, z, c, delta, l->from.user);
}

static int precsolve_pair(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector *b,
                          N_Vector *z, sunrealtype c_re, sunrealtype c_im, sunrealtype delta,
                          void *user)
{
  const lowered *l = user;
  return l->from.precsolve_pair(t, y, yp, r, b, z, c_re, c_im, delta, l->from.user);
}

static int precsolve_transposed(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b,
                                N_Vector z, sunrealtype c, sunrealtype delta, void *user)
{
  const lowered *l = user;
  return l->from.precsolve_transposed(t, y, yp, r, b, z, c, delta, l->from.user);
}

static int start(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const lowered *l = user;
  return l->from.start(t, y, yp, l->from.user);
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const lowered *l = user;
  return l->from.exact(t, y, yp, l->from.user);
}

static int invariant(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const lowered *l = user;
  return l->from.invariant(t, y, value, l->from.user);
}

static int event(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const lowered *l = user;
  return l->from.event(t, y, value, l->from.user);
}

static int handle_event(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  const lowered *l = user;
  return l->from.handle_event(t, y, fired, l->from.user);
}

static int event_slope(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const lowered *l = user;
  return l->from.event_slope(t, y, yp, l->from.user);
}

static int project(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const steif_problem *p = &((const lowered *)user)->from;
  return p->project(t, y, yp, p->user);
}

static int begin(sunrealtype t, void *user)
{
  const lowered *l = user;
  return l->from.begin(t, l->from.user);
}

static long save(void *bytes, void *user)
{
  const lowered *l = user;
  return l->from.save(bytes, l->from.user);
}

static int restore(const void *bytes, size_t count, void *user)
{
  const lowered *l = user;
  return l->from.restore(bytes, count, l->from.user);
}

/* -- the problem ---------------------------------------------------------------------------- */

static steif_problem states(const lowered *l)
{
  const steif_problem *p = &l->from;
  const bool of_state = (l->variation & STF_OF_STATE) != 0;
  steif_problem q = *p;
  q.f = NULL, q.jac = NULL, q.L = NULL, q.Lv = NULL, q.kick = q.drift = NULL;
  q.F = F, q.linear = 0, q.autonomous = 0, q.positions = 0;
  q.E = p->E ? E : NULL, q.Ev = p->Ev ? Ev : NULL;
  q.A = !of_state && (p->A || p->jac) ? A : NULL;
  q.Av = !of_state && p->Av ? Av : NULL;
  q.Etv = p->Etv ? Etv : NULL;
  q.Atv = !of_state && p->Atv ? Atv : NULL;
  q.precsolve_transposed = p->precsolve_transposed ? precsolve_transposed : NULL;
  q.precsetup = p->precsetup ? precsetup : NULL;
  q.precsolve = p->precsolve ? precsolve : NULL;
  q.precsolve_pair = p->precsolve_pair ? precsolve_pair : NULL;
  q.start = p->start ? start : NULL;
  q.project = p->project ? project : NULL;
  q.exact = p->exact ? exact : NULL;
  q.invariant = p->invariant ? invariant : NULL;
  q.event = p->event ? event : NULL;
  q.handle_event = p->handle_event ? handle_event : NULL;
  q.event_slope = p->event_slope ? event_slope : NULL;
  q.begin = p->begin ? begin : NULL;
  q.save = p->save ? save : NULL;
  q.restore = p->restore ? restore : NULL;
  q.user = (void *)(uintptr_t)l;
  return q;
}

static void destroy_matrix(void *M) { SUNMatDestroy(M); }

static int open(stf_pool *pool, steif_context *ctx, N_Vector y, lowered *l)
{
  const steif_problem *p = &l->from;
  const sunindextype n = p->n, stated = p->nnz_E > 0 ? p->nnz_E : p->nnz;
  SUNContext sun = steif_sundials(ctx);
  l->product = stf_pool_vector(pool, y);
  if (!l->product) return STEIF_NO_MEMORY;
  for (int k = 0; k < 4; k++)
    if (!(l->work[k] = stf_pool_vector(pool, y))) return STEIF_NO_MEMORY;
  if (p->storage == STEIF_KRYLOV || !p->E) return STEIF_OK;
  switch (p->storage) {
  case STEIF_DENSE: l->M = SUNDenseMatrix(n, n, sun); break;
  case STEIF_BAND: l->M = SUNBandMatrix(n, p->upper, p->lower, sun); break;
  default: l->M = SUNSparseMatrix(n, n, stated > n ? stated : n, CSC_MAT, sun);
  }
  STEIF_CHECK(l->M, ctx, STEIF_NO_MEMORY, "no memory for a matrix of order %lld", (long long)n);
  return stf_pool_adopt(pool, l->M, destroy_matrix);
}

/* -- slopes at the start ---------------------------------------------------------------------- */

typedef struct entries {
  sunindextype n, count, *row, *column;
  sunrealtype *value;
} entries;

static void put(entries *m, sunindextype i, sunindextype j, sunrealtype v)
{
  if (v == 0) return;
  m->row[m->count] = i, m->column[m->count] = j, m->value[m->count++] = v;
}

static int list(stf_pool *pool, SUNMatrix M, sunindextype n, entries *m)
{
  const SUNMatrix_ID kind = SUNMatGetID(M);
  const sunindextype most = kind == SUNMATRIX_DENSE  ? n * n
                            : kind == SUNMATRIX_BAND ? SM_LDATA_B(M)
                                                     : SM_INDEXPTRS_S(M)[n];
  m->n = n, m->count = 0;
  m->row = stf_pool_array(pool, (size_t)(most + n), sizeof *m->row);
  m->column = stf_pool_array(pool, (size_t)(most + n), sizeof *m->column);
  m->value = stf_pool_array(pool, (size_t)(most + n), sizeof *m->value);
  if (!m->row || !m->column || !m->value) return STEIF_NO_MEMORY;
  for (sunindextype j = 0; j < n; j++) {
    if (kind == SUNMATRIX_SPARSE) {
      for (sunindextype k = SM_INDEXPTRS_S(M)[j]; k < SM_INDEXPTRS_S(M)[j + 1]; k++)
        put(m, SM_INDEXVALS_S(M)[k], j, SM_DATA_S(M)[k]);
      continue;
    }
    const sunindextype first =
      kind == SUNMATRIX_BAND && j > SM_UBAND_B(M) ? j - SM_UBAND_B(M) : 0;
    const sunindextype end = kind == SUNMATRIX_BAND ? j + SM_LBAND_B(M) + 1 : n;
    for (sunindextype i = first; i < n && i < end; i++)
      put(m, i, j, kind == SUNMATRIX_BAND ? SM_ELEMENT_B(M, i, j) : SM_ELEMENT_D(M, i, j));
  }
  return STEIF_OK;
}

/* Ones where the rows without entries meet the columns without: 0 = 0 becomes y_j' = 0. False: there are not as
 * many. */
static bool complete(entries *m, bool *row, bool *column)
{
  sunindextype i = 0, free_rows = 0, free_columns = 0;
  for (sunindextype k = 0; k < m->count; k++) row[m->row[k]] = column[m->column[k]] = true;
  for (sunindextype k = 0; k < m->n; k++) free_rows += !row[k], free_columns += !column[k];
  for (sunindextype j = 0; free_rows == free_columns && j < m->n; j++) {
    if (column[j]) continue;
    while (row[i]) i++;
    put(m, i++, j, 1);
  }
  return free_rows == free_columns;
}

/* b := M^{-1} b; *regular: it could be done, and rounding leaves some digits. */
static int solve(stf_pool *pool, steif_context *ctx, entries *m, N_Vector b, bool *regular)
{
  const sunindextype n = m->n;
  sunrealtype most = 0;
  SUNMatrix A = SUNSparseMatrix(n, n, m->count, CSC_MAT, steif_sundials(ctx));
  STEIF_CHECK(A, ctx, STEIF_NO_MEMORY, "no memory for a matrix of order %lld", (long long)n);
  STEIF_TRY(stf_pool_adopt(pool, A, destroy_matrix));
  for (sunindextype k = 0; k < m->count; k++) {
    most = fmax(most, fabs(m->value[k]));
    m->value[k] = -m->value[k];
  }
  STEIF_TRY(steif_fill_triplets(A, m->count, m->row, m->column, m->value));
  steif_pencil *P = steif_pencil_new(ctx, NULL, A);
  if (!P) return steif_status(ctx);
  N_Vector right[] = {b};
  const sunrealtype before = N_VMaxNorm(b);
  int code = steif_pencil_factor(P, 1, &(steif_shift){0, 0});
  if (!code) code = steif_pencil_solve(P, 0, 1, right, NULL);
  steif_pencil_free(&P);
  *regular = !code && isfinite(N_VMaxNorm(b)) &&
             N_VMaxNorm(b) * most * STF_EPS <= 1e-4 * fmax(before, most);
  if (code == STEIF_NO_MEMORY) return code;
  if (code) steif_forget(ctx);
  return STEIF_OK;
}

/* Columns without entries at the start have none later, as far as one look tells. */
static int stay_empty(stf_pool *work, lowered *l, N_Vector y, const bool *column, bool *stay)
{
  const sunrealtype t = l->from.t0 + 0.381966 * (l->from.t1 - l->from.t0);
  entries m;
  *stay = !fill_mass(l, t, y, l->product);
  if (!*stay) return STEIF_OK;
  STEIF_TRY(list(work, l->M, l->from.n, &m));
  for (sunindextype k = 0; k < m.count; k++) *stay = *stay && column[m.column[k]];
  return STEIF_OK;
}

static int find_slopes(stf_pool *work, steif_context *ctx, lowered *l, N_Vector y, N_Vector b)
{
  const steif_problem *p = &l->from;
  const size_t n = (size_t)p->n;
  entries m;
  bool *row = stf_pool_array(work, 2 * n, sizeof *row), *column = row + n, stay;
  if (!row) return STEIF_NO_MEMORY;
  N_VConst(0, l->product);
  if (fill_mass(l, p->t0, y, l->product) || p->f(p->t0, y, b, p->user)) return STEIF_OK;
  STEIF_TRY(list(work, l->M, p->n, &m));
  sunrealtype *x = stf_array(b);
  if (!m.count || !complete(&m, row, column)) return STEIF_OK;
  STEIF_TRY(stay_empty(work, l, y, column, &stay));
  if (!stay) return STEIF_OK;
  for (size_t i = 0; i < n; i++) {
    if (!isfinite(x[i])) return STEIF_OK;
    if (!row[i]) x[i] = 0;
  }
  return solve(work, ctx, &m, b, &l->regular);
}

/* Where M is regular but for rows and columns of zeros, y' of the others. */
static int add_slopes(stf_pool *pool, steif_context *ctx, lowered *l, N_Vector y)
{
  stf_pool *work = stf_pool_new(ctx);
  N_Vector b = stf_pool_vector(pool, y);
  int code = work && b ? find_slopes(work, ctx, l, y, b) : STEIF_NO_MEMORY;
  stf_pool_free(&work);
  if (!code && l->regular && !l->from.yp0 && !l->from.start) l->problem.yp0 = stf_array(b);
  return code;
}

typedef struct pattern {
  steif_context *ctx;
  steif_pattern *found;
} pattern;

static void free_pattern(void *object)
{
  pattern *p = object;
  steif_pattern_free(p->ctx, &p->found);
}

/* Sparse, with M(t, y): the pattern of all of dF/dy. */
static int add_pattern(stf_pool *pool, steif_context *ctx, lowered *l)
{
  pattern *p = stf_pool_array(pool, 1, sizeof *p);
  if (!p) return STEIF_NO_MEMORY;
  p->ctx = ctx;
  STEIF_TRY(steif_pattern_find(ctx, &l->problem, &p->found));
  l->problem.pattern = p->found;
  return stf_pool_adopt(pool, p, free_pattern);
}

int stf_mass_lower(stf_pool *pool, steif_context *ctx, const steif_problem *problem,
                   int variation, N_Vector y, const steif_problem **into)
{
  lowered *l = stf_pool_array(pool, 1, sizeof *l);
  if (!l) return STEIF_NO_MEMORY;
  l->from = *problem, l->variation = variation;
  STEIF_TRY(open(pool, ctx, y, l));
  l->problem = states(l);
  if (l->M) STEIF_TRY(add_slopes(pool, ctx, l, y));
  if (problem->storage == STEIF_SPARSE && !l->problem.A && !problem->pattern)
    STEIF_TRY(add_pattern(pool, ctx, l));
  *into = &l->problem;
  return STEIF_OK;
}

void stf_mass_lower_again(const steif_problem *before, steif_problem *problem)
{
  lowered *l = before->user;
  l->from = *problem;
  *problem = states(l);
  if (!problem->pattern) problem->pattern = l->problem.pattern;
  if (!problem->index) problem->index = before->index;
}

bool stf_mass_regular(const steif_problem *problem)
{
  return problem->F == F && ((const lowered *)problem->user)->regular;
}
