/* pencil.c: the frame of a pencil s E - A: what is asked of it is checked here, what can be kept
 * is kept, and a back end does the rest.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static const stf_backend *backend_of(SUNMatrix A)
{
  switch (SUNMatGetID(A)) {
  case SUNMATRIX_DENSE: return &stf_backend_dense;
  case SUNMATRIX_BAND: return &stf_backend_band;
  case SUNMATRIX_SPARSE: return &stf_backend_sparse;
  default: return NULL;
  }
}

static void size_of(SUNMatrix M, long long *rows, long long *columns)
{
  switch (SUNMatGetID(M)) {
  case SUNMATRIX_DENSE: *rows = SM_ROWS_D(M), *columns = SM_COLUMNS_D(M); break;
  case SUNMATRIX_BAND: *rows = SM_ROWS_B(M), *columns = SM_COLUMNS_B(M); break;
  default: *rows = SM_ROWS_S(M), *columns = SM_COLUMNS_S(M);
  }
}

static int check_matrix(steif_context *ctx, const char *name, SUNMatrix M, const stf_backend *b,
                        long long n)
{
  long long rows, columns;
  STEIF_CHECK(backend_of(M) == b, ctx, STEIF_BAD_INPUT,
              "E and A have different storage: make both dense, both band or both sparse");
  size_of(M, &rows, &columns);
  STEIF_CHECK(
    rows == n && columns == n && n > 0, ctx, STEIF_BAD_INPUT,
    "%s is %lld x %lld where %lld x %lld is needed: E and A must be square, of one size "
    "and not empty",
    name, rows, columns, n, n);
  STEIF_CHECK(b != &stf_backend_sparse || SM_SPARSETYPE_S(M) == CSC_MAT, ctx, STEIF_UNSUPPORTED,
              "%s is stored by rows (CSR_MAT): create it as CSC_MAT or convert it with "
              "SUNSparseMatrix_ToCSC",
              name);
  return STEIF_OK;
}

static int check_matrices(steif_context *ctx, SUNMatrix E, SUNMatrix A)
{
  STEIF_CHECK(A, ctx, STEIF_BAD_INPUT, "A is NULL: a pencil needs the matrix A");
  const stf_backend *b = backend_of(A);
  STEIF_CHECK(b, ctx, STEIF_UNSUPPORTED,
              "A has SUNDIALS matrix type %d: dense, band or sparse is needed",
              (int)SUNMatGetID(A));
  long long n, columns;
  size_of(A, &n, &columns);
  STEIF_TRY(check_matrix(ctx, "A", A, b, n));
  return E ? check_matrix(ctx, "E", E, b, n) : STEIF_OK;
}

static steif_pencil *make(steif_context *ctx, const steif_pencil *given)
{
  steif_pencil *p = stf_allocate(ctx, 1, sizeof *p);
  if (!p) return NULL;
  *p = *given;
  p->ctx = ctx;
  p->stale = true;
  p->state = stf_allocate(ctx, 1, p->backend->size);
  if (!p->state || p->backend->open(p)) steif_pencil_free(&p);
  return p;
}

steif_pencil *steif_pencil_new(steif_context *ctx, SUNMatrix E, SUNMatrix A)
{
  if (!ctx || check_matrices(ctx, E, A)) return NULL;
  long long n, columns;
  size_of(A, &n, &columns);
  return make(ctx,
              &(steif_pencil){.backend = backend_of(A), .n = (sunindextype)n, .E = E, .A = A});
}

steif_pencil *steif_pencil_new_incomplete(steif_context *ctx, SUNMatrix E, SUNMatrix A)
{
  if (!ctx || check_matrices(ctx, E, A)) return NULL;
  if (SUNMatGetID(A) == SUNMATRIX_SPARSE)
    return make(ctx, &(steif_pencil){.backend = &stf_backend_incomplete,
                                     .n = (sunindextype)SM_COLUMNS_S(A),
                                     .E = E,
                                     .A = A});
  STEIF_FAIL(ctx, STEIF_UNSUPPORTED,
             "incomplete factors need sparse matrices: factor dense and band ones whole");
  return NULL;
}

static int check_operator(steif_context *ctx, const steif_operator *op, N_Vector like)
{
  STEIF_CHECK(op && op->A && like, ctx, STEIF_BAD_INPUT,
              "an operator needs its product A and a vector to clone; %s is NULL",
              !op      ? "the operator"
              : !op->A ? "A"
                       : "the vector");
  STEIF_CHECK(op->dimension >= 0 && op->restarts >= 0 && op->tolerance >= 0 &&
                op->tolerance < 1,
              ctx, STEIF_BAD_INPUT,
              "Krylov dimension %d, restarts %d, tolerance %g: none may be negative, and the "
              "tolerance must be below 1; 0 takes the default",
              op->dimension, op->restarts, op->tolerance);
  return STEIF_OK;
}

steif_pencil *steif_pencil_new_operator(steif_context *ctx, const steif_operator *op,
                                        N_Vector like)
{
  if (!ctx || check_operator(ctx, op, like)) return NULL;
  return make(
    ctx, &(steif_pencil){
           .backend = &stf_backend_krylov, .n = N_VGetLength(like), .op = *op, .like = like});
}

void steif_pencil_free(steif_pencil **p)
{
  if (!p || !*p) return;
  steif_pencil *q = *p;
  if (q->state) q->backend->close(q);
  stf_release(q->ctx, q->state);
  stf_release(q->ctx, q->work);
  stf_release(q->ctx, q);
  *p = NULL;
}

int steif_pencil_update(steif_pencil *p)
{
  if (!p) return STEIF_BAD_INPUT;
  memset(p->fresh, 0, sizeof p->fresh);
  p->stale = true;
  STEIF_TRY(p->backend->update(p));
  p->stale = false;
  return STEIF_OK;
}

static int check_shifts(steif_pencil *p, int count, const steif_shift *s)
{
  STEIF_CHECK(s && count >= 1 && count <= STEIF_PENCIL_SLOTS, p->ctx, STEIF_BAD_INPUT,
              "%d shifts: from 1 to %d can be factored at a time", s ? count : 0,
              STEIF_PENCIL_SLOTS);
  for (int k = 0; k < count; k++)
    STEIF_CHECK(isfinite(s[k].re) && isfinite(s[k].im), p->ctx, STEIF_NOT_FINITE,
                "shift %d is %g%+gi: look at the step size it was made from", k, s[k].re,
                s[k].im);
  return STEIF_OK;
}

/* The slots that need factors, complex ones (the longer work) first. */
static int list(steif_pencil *p, int count, const steif_shift *s, int *todo)
{
  int m = 0;
  for (int wanted = 1; wanted >= 0; wanted--)
    for (int k = 0; k < count; k++) {
      if (stf_is_complex(s[k]) != (wanted == 1)) continue;
      if (p->fresh[k] && p->shift[k].re == s[k].re && p->shift[k].im == s[k].im) continue;
      p->fresh[k] = false;
      todo[m++] = k;
    }
  return m;
}

static int explain(steif_pencil *p, steif_shift s, const stf_outcome *o)
{
  const long long n = p->n, column = o->column;
  switch (o->code) {
  case STEIF_SINGULAR:
    STEIF_CHECK(
      !o->rank, p->ctx, o->code,
      "s E - A is singular at s = %.10g%+.10gi and at every other shift: the patterns "
      "of E and A allow rank %lld of %lld; look for an empty or repeated equation",
      s.re, s.im, (long long)o->rank, n);
    return STEIF_FAIL(p->ctx, o->code,
                      "s E - A is singular at s = %.10g%+.10gi: the pivot of column %lld "
                      "(of %lld) vanished; take another step size, or check that "
                      "det(s E - A) is not identically zero",
                      s.re, s.im, column + 1, n);
  case STEIF_NOT_FINITE:
    return STEIF_FAIL(p->ctx, o->code,
                      "s E - A overflows at s = %.10g%+.10gi; scale the equations or take a "
                      "larger step",
                      s.re, s.im);
  case STEIF_NO_MEMORY:
    return STEIF_FAIL(
      p->ctx, o->code,
      "no memory for the factors of s E - A (n = %lld) at s = %.10g%+.10gi; make "
      "the problem smaller or use an operator with a preconditioner",
      n, s.re, s.im);
  default:
    return STEIF_FAIL(p->ctx, o->code,
                      "the %s factorisation rejected s E - A at s = %.10g%+.10gi; check the "
                      "matrix's index arrays",
                      p->backend->name, s.re, s.im);
  }
}

/* Outcomes to counters; the first failure becomes the sentence. */
static int settle(steif_pencil *p, int m, const int *todo, const steif_shift *s,
                  const stf_outcome *out)
{
  int worst = -1;
  for (int i = 0; i < m; i++) {
    const int k = todo[i];
    p->shift[k] = s[k];
    p->fresh[k] = out[i].code == STEIF_OK;
    p->stats.factors += out[i].factors;
    p->stats.refactors += out[i].refactors;
    p->stats.fallbacks += out[i].fallbacks;
    if (out[i].fill) p->stats.fill = out[i].fill;
    if (out[i].code && (worst < 0 || k < todo[worst])) worst = i;
  }
  return worst < 0 ? STEIF_OK : explain(p, s[todo[worst]], &out[worst]);
}

int steif_pencil_factor(steif_pencil *p, int count, const steif_shift *s)
{
  int todo[STEIF_PENCIL_SLOTS];
  stf_outcome out[STEIF_PENCIL_SLOTS];
  if (!p) return STEIF_BAD_INPUT;
  STEIF_TRY(check_shifts(p, count, s));
  if (p->stale) STEIF_TRY(steif_pencil_update(p));
  if (count > p->slots) p->slots = count;
  const int m = list(p, count, s, todo);
  for (int i = 0; i < m; i++) {
    out[i] = (stf_outcome){.column = -1};
    STEIF_TRY(p->backend->prepare(p, todo[i], s[todo[i]]));
  }
  stf_parallel_factor(p, m, todo, s, out);
  return settle(p, m, todo, s, out);
}

static int check_vector(steif_pencil *p, const char *name, int k, N_Vector v)
{
  STEIF_CHECK(v, p->ctx, STEIF_BAD_INPUT, "%s[%d] is NULL: a vector is needed", name, k);
  const bool serial = v->ops->nvgetarraypointer == N_VGetArrayPointer_Serial;
  const long long n = serial ? NV_LENGTH_S(v) : N_VGetLength(v);
  STEIF_CHECK(n == p->n, p->ctx, STEIF_BAD_INPUT,
              "%s[%d] has %lld components where the pencil has %lld", name, k, n,
              (long long)p->n);
  STEIF_CHECK(
    !p->backend->matrices || stf_array(v), p->ctx, STEIF_UNSUPPORTED,
    "%s[%d] has no host array: use a serial vector, or give the pencil as an operator", name,
    k);
  return STEIF_OK;
}

static int check_solve(steif_pencil *p, int k, int nrhs, N_Vector *re, N_Vector *im)
{
  STEIF_CHECK(k >= 0 && k < p->slots && p->fresh[k], p->ctx, STEIF_BAD_INPUT,
              "slot %d of %d has no factors of the present matrices: call steif_pencil_factor "
              "first",
              k, p->slots);
  STEIF_CHECK(nrhs >= 1 && re, p->ctx, STEIF_BAD_INPUT,
              "%d right-hand sides%s: at least one is needed", nrhs,
              re ? "" : " and re = NULL");
  STEIF_CHECK(im || !stf_is_complex(p->shift[k]), p->ctx, STEIF_BAD_INPUT,
              "slot %d has the complex shift %g%+gi: give imaginary parts (im is NULL)", k,
              p->shift[k].re, p->shift[k].im);
  for (int i = 0; i < nrhs; i++) {
    STEIF_TRY(check_vector(p, "re", i, re[i]));
    if (im) STEIF_TRY(check_vector(p, "im", i, im[i]));
  }
  return STEIF_OK;
}

/* A real shift takes the parts of complex right-hand sides apart. */
int steif_pencil_solve(steif_pencil *p, int k, int nrhs, N_Vector *re, N_Vector *im)
{
  if (!p) return STEIF_BAD_INPUT;
  STEIF_TRY(check_solve(p, k, nrhs, re, im));
  p->stats.solves += nrhs;
  if (!im || stf_is_complex(p->shift[k])) return p->backend->solve(p, k, nrhs, re, im);
  STEIF_TRY(p->backend->solve(p, k, nrhs, re, NULL));
  return p->backend->solve(p, k, nrhs, im, NULL);
}

int steif_pencil_solve_transposed(steif_pencil *p, int k, int nrhs, N_Vector *re, N_Vector *im)
{
  if (!p) return STEIF_BAD_INPUT;
  STEIF_CHECK(p->backend->matrices || p->turned.A, p->ctx, STEIF_UNSUPPORTED,
              "a pencil of products knows no transposed products: give them by "
              "steif_pencil_give_transposed, or take dense, band or sparse matrices");
  STEIF_TRY(check_solve(p, k, nrhs, re, im));
  p->stats.solves += nrhs;
  if (!im || stf_is_complex(p->shift[k])) return p->backend->transposed(p, k, nrhs, re, im);
  STEIF_TRY(p->backend->transposed(p, k, nrhs, re, NULL));
  return p->backend->transposed(p, k, nrhs, im, NULL);
}

int steif_pencil_give_transposed(steif_pencil *p, const steif_transposed *t)
{
  if (!p) return STEIF_BAD_INPUT;
  STEIF_CHECK(
    !p->backend->matrices, p->ctx, STEIF_UNSUPPORTED,
    "a %s pencil has matrices and transposes them itself: leave transposed products to "
    "operators",
    p->backend->name);
  STEIF_CHECK(t && t->A && (t->E || !p->op.E), p->ctx, STEIF_BAD_INPUT,
              "transposed products need %s: it is NULL",
              !t      ? "a list of callbacks"
              : !t->A ? "A"
                      : "E, since the operator has E");
  p->turned = *t;
  return STEIF_OK;
}

int steif_pencil_product(steif_pencil *p, char which, N_Vector x, N_Vector out)
{
  if (!p) return STEIF_BAD_INPUT;
  STEIF_CHECK(which == 'E' || which == 'A', p->ctx, STEIF_BAD_INPUT,
              "product with '%c': 'E' or 'A' is needed", which);
  STEIF_TRY(check_vector(p, "x", 0, x));
  STEIF_TRY(check_vector(p, "out", 0, out));
  STEIF_CHECK(x != out, p->ctx, STEIF_BAD_INPUT,
              "x and out are the same vector: a product needs two");
  const bool identity = which == 'E' && (p->backend->matrices ? !p->E : !p->op.E);
  if (!identity) return p->backend->product(p, which, x, out);
  if (p->backend->matrices)
    memcpy(stf_array(out), stf_array(x), (size_t)p->n * sizeof(sunrealtype));
  else
    N_VScale(1, x, out);
  return STEIF_OK;
}

const steif_pencil_stats *steif_pencil_statistics(const steif_pencil *p)
{
  return p ? &p->stats : NULL;
}
