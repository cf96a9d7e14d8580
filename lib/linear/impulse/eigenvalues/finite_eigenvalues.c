/* finite_eigenvalues.c: the finite eigenvalues of a pencil, all or those near to a point.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "dense_units.h"
#include "eigenpairs.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static void destroy(void *M) { SUNMatDestroy(M); }

/* M itself, or sparse in the pool. */
static int sparse(stf_eigenpairs *p, SUNMatrix *M)
{
  if (SUNMatGetID(*M) == SUNMATRIX_SPARSE) return STEIF_OK;
  *M = SUNSparseFromDenseMatrix(*M, 0, CSC_MAT);
  STEIF_CHECK(*M, p->ctx, STEIF_NO_MEMORY, "no memory for a sparse copy of a matrix");
  return stf_pool_adopt(p->pool, *M, destroy);
}

static void measure_rows(SUNMatrix M, sunrealtype *norm)
{
  const sunindextype count = SM_INDEXPTRS_S(M)[SM_COLUMNS_S(M)];
  for (sunindextype k = 0; k < count; k++) norm[SM_INDEXVALS_S(M)[k]] += fabs(SM_DATA_S(M)[k]);
}

/* A dense pencil: in the units in which it is analysed, so that those of the unknowns do not matter. */
static int measure_dense(stf_eigenpairs *p)
{
  stf_dense_units u;
  const size_t n = (size_t)p->n;
  STEIF_TRY(stf_dense_units_choose(p->ctx, p->pool, p->analysis, p->E, p->F, &u));
  p->row = u.row, p->unit = u.column;
  for (size_t k = 0; k < n * n; k++) {
    p->norm[0][k % n] += fabs(u.E[k]);
    p->norm[1][k % n] += fabs(u.F[k]);
  }
  return STEIF_OK;
}

static int check(const stf_eigenpairs *p, const steif_eigenvalue_request *request, bool dense)
{
  const steif_structure *s = p->structure;
  STEIF_CHECK(s->regular, p->ctx, STEIF_SINGULAR, "every s is an eigenvalue: %s", s->message);
  STEIF_CHECK(s->index >= 0 && s->finite >= 0, p->ctx, STEIF_NOT_CERTIFIED,
              "which eigenvalues are finite is undecided: %s", s->message);
  STEIF_CHECK(request->count >= 0 && request->count <= s->n && isfinite(request->re) &&
                isfinite(request->im),
              p->ctx, STEIF_BAD_INPUT,
              "%ld eigenvalues near %g %+g i: ask for 0 .. %lld at a finite point",
              request->count, request->re, request->im, (long long)s->n);
  STEIF_CHECK(
    dense || request->count || !s->finite, p->ctx, STEIF_UNSUPPORTED,
    "all %lld eigenvalues of a sparse pencil of order %lld: ask for those nearest to a "
    "point",
    (long long)s->finite, (long long)s->n);
  return STEIF_OK;
}

static int run(stf_eigenpairs *p, bool dense)
{
  const size_t n = (size_t)p->n;
  p->norm[0] = stf_pool_array(p->pool, 2 * n, sizeof **p->norm);
  p->r = stf_pool_array(p->pool, n, sizeof *p->r);
  if (!p->norm[0] || !p->r) return STEIF_NO_MEMORY;
  p->norm[1] = p->norm[0] + n;
  if (!dense) STEIF_TRY(sparse(p, &p->E));
  if (!dense) STEIF_TRY(sparse(p, &p->F));
  if (dense) {
    STEIF_TRY(measure_dense(p));
    STEIF_TRY(stf_eigenpairs_dense(p));
  } else {
    measure_rows(p->E, p->norm[0]);
    measure_rows(p->F, p->norm[1]);
    if (p->wanted) STEIF_TRY(stf_eigenpairs_sparse(p));
  }
  stf_eigenpairs_sort(p);
  return STEIF_OK;
}

/* As many as were asked for, and the other one of a pair. */
static long shown(const stf_eigenpairs *p)
{
  long count = p->wanted && p->wanted < p->count ? p->wanted : p->count;
  if (!count || count == p->count || cimag(p->near) != 0) return count;
  const steif_eigenvalue *last = p->value + count - 1;
  return last->im < 0 && last[1].im == -last->im ? count + 1 : count;
}

static void conclude(const stf_eigenpairs *p, bool dense, steif_eigenvalues *out)
{
  const long finite = (long)p->structure->finite;
  const long wanted = p->wanted && p->wanted < finite ? p->wanted : finite;
  sunrealtype most = 0;
  for (long k = 0; k < out->count; k++) most = fmax(most, out->value[k].residual);
  out->all = out->count == finite;
  out->certified = out->count >= wanted && most <= STF_RESIDUAL;
  snprintf(out->message, sizeof out->message,
           "%ld of %ld finite eigenvalues by %s, residuals up to %.1e%s", out->count, finite,
           dense ? "the QZ algorithm" : "Arnoldi's method", most,
           out->count < wanted
             ? "; others did not converge, or are equal to these: take another "
               "point"
           : dense || out->all ? ""
                               : "; that none near is missed is not certain");
}

static int find(stf_eigenpairs *p, const steif_eigenvalue_request *request,
                steif_eigenvalues *out)
{
  const steif_analysis a = stf_analysis_resolved(p->E, p->F, p->analysis);
  const bool small = stf_analysis_dense(&a),
             dense = small && !stf_found_by_circles(p->structure);
  p->analysis = &a;
  /* Of a small pencil all are found all the same. */
  if (small && !dense && !p->wanted) p->wanted = (long)p->structure->finite;
  STEIF_TRY(stf_analysis_check(p->ctx, p->E, p->F, &a));
  STEIF_TRY(check(p, request, small));
  STEIF_TRY(run(p, dense));
  out->count = shown(p);
  out->value = stf_allocate(p->ctx, (size_t)out->count + 1, sizeof *out->value);
  if (!out->value) return STEIF_NO_MEMORY;
  if (out->count) memcpy(out->value, p->value, (size_t)out->count * sizeof *out->value);
  conclude(p, dense, out);
  return STEIF_OK;
}

int steif_eigenvalues_find(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                           const steif_analysis *analysis, const steif_structure *structure,
                           const steif_eigenvalue_request *request,
                           steif_eigenvalues *eigenvalues)
{
  static const steif_eigenvalue_request all = {0};
  STEIF_CHECK(eigenvalues, ctx, STEIF_BAD_INPUT, "no place for the eigenvalues: it is NULL");
  *eigenvalues = (steif_eigenvalues){0};
  STEIF_CHECK(structure && structure->method, ctx, STEIF_BAD_INPUT,
              "the structure of the pencil is needed: call steif_structure_find before");
  if (!request) request = &all;
  stf_eigenpairs p = {.ctx = ctx,
                      .pool = stf_pool_new(ctx),
                      .E = E,
                      .F = F,
                      .analysis = analysis,
                      .structure = structure,
                      .n = (int)structure->n,
                      .wanted = request->count,
                      .near = request->re + I * request->im};
  if (!p.pool) return STEIF_NO_MEMORY;
  const int code = find(&p, request, eigenvalues);
  stf_pool_free(&p.pool);
  if (code) steif_eigenvalues_clear(ctx, eigenvalues);
  return code;
}

void steif_eigenvalues_clear(steif_context *ctx, steif_eigenvalues *eigenvalues)
{
  if (!eigenvalues) return;
  stf_release(ctx, eigenvalues->value);
  *eigenvalues = (steif_eigenvalues){0};
}
