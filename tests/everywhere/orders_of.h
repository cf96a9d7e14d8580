/* orders_of.h: what orders.c has of one type T: sums, products of matrices, triangular systems.
 * SPDX-License-Identifier: BSD-3-Clause
 */

/* The first entry in memory of a vector whose steps may be negative. */
static T *IN(from)(const T *x, int n, int step)
{
  return (T *)x + (step < 0 ? (long)(1 - n) * step : 0);
}

/* sum of x[k sx] y[k sy], conjugated where asked. */
static T IN(sum)(int n, const T *x, int sx, int cx, const T *y, int sy, int cy)
{
  T s[8] = {0};
  const int mask = lanes - 1;
  for (int i = 0; i < n; i++) {
    const long k = backwards ? n - 1 - i : i;
    const T a = x[k * sx], b = y[k * sy];
    T *at = &s[i & mask];
    *at = PLUS(cx ? CONJ(a) : a, cy ? CONJ(b) : b, *at);
  }
  for (int i = 1; i < lanes; i++) s[0] += s[i];
  return s[0];
}

void F(axpy)(const int *n, const T *a, const T *x, const int *sx, T *y, const int *sy)
{
  x = IN(from)(x, *n, *sx), y = IN(from)(y, *n, *sy);
  for (int i = 0; i < *n; i++, x += *sx, y += *sy) *y = PLUS(*a, *x, *y);
}

void F(gemv)(const char *trans, const int *m, const int *n, const T *alpha, const T *a,
             const int *lda, const T *x, const int *sx, const T *beta, T *y, const int *sy)
{
  const int plain = is(trans, 'N'), rows = plain ? *m : *n, columns = plain ? *n : *m;
  x = IN(from)(x, columns, *sx), y = IN(from)(y, rows, *sy);
  for (int i = 0; i < rows; i++, y += *sy) {
    const T *row = plain ? a + i : a + (long)i * *lda;
    const T s =
      *alpha == 0 ? 0 : IN(sum)(columns, row, plain ? *lda : 1, is(trans, 'C'), x, *sx, 0);
    *y = *alpha * s + (*beta == 0 ? 0 : *beta * *y);
  }
}

void F(gemm)(const char *ta, const char *tb, const int *m, const int *n, const int *k,
             const T *alpha, const T *a, const int *lda, const T *b, const int *ldb,
             const T *beta, T *c, const int *ldc)
{
  const int na = is(ta, 'N'), nb = is(tb, 'N');
  for (int j = 0; j < *n; j++)
    for (int i = 0; i < *m; i++) {
      const T *row = na ? a + i : a + (long)i * *lda, *column = nb ? b + (long)j * *ldb : b + j;
      const T s = *alpha == 0 ? 0
                              : IN(sum)(*k, row, na ? *lda : 1, is(ta, 'C'), column,
                                        nb ? 1 : *ldb, is(tb, 'C'));
      T *at = c + i + (long)j * *ldc;
      *at = *alpha * s + (*beta == 0 ? 0 : *beta * *at);
    }
}

/* M x = b in place, or M x; M[i, k] = a[i by + k along], triangular. */
static void IN(solve)(int n, const T *a, long by, long along, int conjugate, int lower,
                      int unit, T *x, int step)
{
  for (int r = 0; r < n; r++) {
    const int i = lower ? r : n - 1 - r, first = lower ? 0 : i + 1,
              count = lower ? i : n - 1 - i;
    const T s = IN(sum)(count, a + i * by + first * along, (int)along, conjugate,
                        x + (long)first * step, step, 0),
            pivot = a[i * by + i * along];
    x[(long)i * step] -= s;
    if (!unit) x[(long)i * step] /= conjugate ? CONJ(pivot) : pivot;
  }
}
static void IN(multiply)(int n, const T *a, long by, long along, int conjugate, int lower,
                         int unit, T *x, int step)
{
  for (int r = 0; r < n; r++) {
    const int i = lower ? n - 1 - r : r, first = lower ? 0 : i + 1,
              count = lower ? i : n - 1 - i;
    const T s = IN(sum)(count, a + i * by + first * along, (int)along, conjugate,
                        x + (long)first * step, step, 0),
            pivot = a[i * by + i * along], own = x[(long)i * step];
    x[(long)i * step] = s + (unit ? own : (conjugate ? CONJ(pivot) : pivot) * own);
  }
}

typedef void IN(triangle)(int, const T *, long, long, int, int, int, T *, int);

static void IN(columns)(IN(triangle) * of, const char *side, const char *uplo,
                        const char *trans, const char *diag, int m, int n, T alpha, const T *a,
                        int lda, T *b, int ldb)
{
  const int left = is(side, 'L'), turned = left != !!is(trans, 'N'), size = left ? m : n,
            count = left ? n : m;
  for (int j = 0; j < count; j++) {
    T *x = left ? b + (long)j * ldb : b + j;
    const int step = left ? 1 : ldb;
    for (int i = 0; i < size; i++)
      x[(long)i * step] = alpha == 0 ? 0 : alpha * x[(long)i * step];
    of(size, a, turned ? lda : 1, turned ? 1 : lda, is(trans, 'C'), is(uplo, 'L') != turned,
       is(diag, 'U'), x, step);
  }
}
void F(trsm)(const char *side, const char *uplo, const char *trans, const char *diag,
             const int *m, const int *n, const T *alpha, const T *a, const int *lda, T *b,
             const int *ldb)
{
  IN(columns)(IN(solve), side, uplo, trans, diag, *m, *n, *alpha, a, *lda, b, *ldb);
}
void F(trmm)(const char *side, const char *uplo, const char *trans, const char *diag,
             const int *m, const int *n, const T *alpha, const T *a, const int *lda, T *b,
             const int *ldb)
{
  IN(columns)(IN(multiply), side, uplo, trans, diag, *m, *n, *alpha, a, *lda, b, *ldb);
}

static void IN(one)(IN(triangle) * of, const char *uplo, const char *trans, const char *diag,
                    int n, const T *a, int lda, T *x, int step)
{
  const int turned = !is(trans, 'N');
  of(n, a, turned ? lda : 1, turned ? 1 : lda, is(trans, 'C'), is(uplo, 'L') != turned,
     is(diag, 'U'), IN(from)(x, n, step), step);
}
void F(trsv)(const char *uplo, const char *trans, const char *diag, const int *n, const T *a,
             const int *lda, T *x, const int *step)
{
  IN(one)(IN(solve), uplo, trans, diag, *n, a, *lda, x, *step);
}
void F(trmv)(const char *uplo, const char *trans, const char *diag, const int *n, const T *a,
             const int *lda, T *x, const int *step)
{
  IN(one)(IN(multiply), uplo, trans, diag, *n, a, *lda, x, *step);
}
