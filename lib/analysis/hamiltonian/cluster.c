/* cluster.c: clusters of eigenvalues and their invariant subspaces (C. A. Bavely and G. W. Stewart,
 * SIAM J. Numer. Anal. 16, 1979).
 *
 * The mean of a cluster moves by at most ||E|| ||Pi|| under a small change E of A, Pi the spectral
 * projector; a single eigenvalue of a Jordan block of size m splits by u^{1/m} while its ||Pi|| grows
 * to u^{1/m - 1}: the uncertainty covers the split, and the eigenvalues belong together. Joined,
 * their projector is of moderate size.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "cluster.h"
#include "lapack.h"
#include <math.h>
#include <string.h>

void stf_times(int n, const char *op_A, const stf_number *A, const char *op_B,
               const stf_number *B, stf_number *C)
{
  const stf_number one = 1, zero = 0;
  zgemm_(op_A, op_B, &n, &n, &n, &one, A, &n, B, &n, &zero, C, &n, 1, 1);
}

typedef struct work {
  stf_spectrum *s;
  stf_number *Q, *Z, *W; /* A = Q T Q^*; T Z = Z diag(T_k); W = Z^{-1} */
  double *scale;
  int *label; /* of the eigenvalues, before they stand in order */
} work;

/* A = D^{-1} A D in `balanced`, then its Schur form. */
static int schur(work *x, const double *A, double *balanced)
{
  stf_spectrum *s = x->s;
  const int n = s->n, room = 8 * n;
  const size_t count = (size_t)n * (size_t)n;
  int low, high, info, none = 0;
  memcpy(balanced, A, count * sizeof *A);
  dgebal_("S", &n, balanced, &n, &low, &high, x->scale, &info, 1);
  for (size_t i = 0; i < count; i++) {
    s->T[i] = balanced[i];
    s->norm = hypot(s->norm, balanced[i]);
  }
  stf_number *buffer = stf_allocate(s->ctx, (size_t)(room + 2 * n), sizeof *buffer);
  if (!buffer) return STEIF_NO_MEMORY;
  zgees_("V", "N", NULL, &n, s->T, &n, &none, buffer, x->Q, &n, buffer + n, &room,
         (double *)(buffer + n + room), &none, &info, 1, 1);
  stf_release(s->ctx, buffer);
  STEIF_CHECK(info == 0, s->ctx, STEIF_NO_CONVERGENCE,
              "the QR iteration stopped at eigenvalue %d of %d; rescale the matrix", info, n);
  return STEIF_OK;
}

/* Label the eigenvalues that chains of links no longer than `link` join. */
static void join(work *x, double link)
{
  const stf_spectrum *s = x->s;
  const int n = s->n;
  int next = 0;
  for (int i = 0; i < n; i++) x->label[i] = -1;
  for (int i = 0; i < n; i++) {
    if (x->label[i] >= 0) continue;
    x->label[i] = next;
    for (bool grown = true; grown;) {
      grown = false;
      for (int j = 0; j < n; j++)
        for (int k = 0; x->label[j] == next && k < n; k++)
          if (x->label[k] < 0 && cabs(s->T[k + n * k] - s->T[j + n * j]) <= link) {
            x->label[k] = next;
            grown = true;
          }
    }
    next++;
  }
  x->s->count = next;
}

/* Bring the clusters together along the diagonal. */
static void order(work *x)
{
  stf_spectrum *s = x->s;
  const int n = s->n;
  int at = 0, info;
  for (int k = 0; k < s->count; k++) {
    s->cluster[k] = (stf_cluster){.first = at};
    for (int i = at; i < n; i++) {
      if (x->label[i] != k) continue;
      const int from = i + 1, to = at + 1;
      if (from != to) ztrexc_("V", &n, s->T, &n, x->Q, &n, &from, &to, &info, 1);
      memmove(x->label + at + 1, x->label + at, (size_t)(i - at) * sizeof *x->label);
      x->label[at++] = k;
    }
    s->cluster[k].size = at - s->cluster[k].first;
  }
}

/* Z and W, unit upper triangular; Z is 1 within the clusters. */
static void separate(work *x)
{
  const stf_spectrum *s = x->s;
  const int n = s->n;
  const stf_number *T = s->T;
  memset(x->Z, 0, (size_t)n * (size_t)n * sizeof *x->Z);
  memset(x->W, 0, (size_t)n * (size_t)n * sizeof *x->W);
  for (int j = 0; j < n; j++) {
    stf_number *z = x->Z + n * j;
    const int first = s->cluster[x->label[j]].first;
    z[j] = 1;
    for (int i = first; i-- > 0;) {
      stf_number sum = -T[i + n * j];
      for (int p = i + 1; p < first; p++) sum -= T[i + n * p] * z[p];
      for (int p = first; p < j; p++) sum += x->Z[i + n * p] * T[p + n * j];
      z[i] = sum / (T[i + n * i] - T[j + n * j]);
    }
  }
  for (int j = 0; j < n; j++) {
    x->W[j + n * j] = 1;
    for (int i = j; i-- > 0;) {
      stf_number sum = 0;
      for (int p = i + 1; p <= j; p++) sum -= x->Z[i + n * p] * x->W[p + n * j];
      x->W[i + n * j] = sum;
    }
  }
}

/* ||Pi||^2 = tr (Z_k^* Z_k) (W_k W_k^*), Z_k columns of Z, W_k rows of W. */
static double projector(const work *x, const stf_cluster *c)
{
  const int n = x->s->n;
  double total = 0;
  for (int a = c->first; a < c->first + c->size; a++)
    for (int b = c->first; b < c->first + c->size; b++) {
      stf_number left = 0, right = 0;
      for (int i = 0; i < n; i++) {
        left += conj(x->Z[i + n * a]) * x->Z[i + n * b];
        right += x->W[b + n * i] * conj(x->W[a + n * i]);
      }
      total += creal(left * right);
    }
  return sqrt(total);
}

static double gap(const work *x, int k)
{
  const stf_spectrum *s = x->s;
  const int n = s->n;
  double least = INFINITY;
  for (int i = 0; i < n; i++)
    for (int j = 0; x->label[i] == k && j < n; j++)
      if (x->label[j] != k) least = fmin(least, cabs(s->T[i + n * i] - s->T[j + n * j]));
  return least;
}

/* Means, spreads and uncertainties; false where two clusters cannot be told apart. */
static bool measure(work *x)
{
  stf_spectrum *s = x->s;
  const int n = s->n;
  bool good = true;
  for (int k = 0; k < s->count; k++) {
    stf_cluster *c = s->cluster + k;
    const int end = c->first + c->size;
    c->mean = 0;
    c->spread = 0;
    for (int i = c->first; i < end; i++) c->mean += s->T[i + n * i] / c->size;
    for (int i = c->first; i < end; i++)
      c->spread = fmax(c->spread, cabs(s->T[i + n * i] - c->mean));
    c->radius = s->tolerance * s->norm * projector(x, c);
    good = good && 2 * c->radius < gap(x, k);
  }
  return good;
}

/* X = D Q Z, Y = W Q^* D^{-1}. */
static void assemble(work *x)
{
  stf_spectrum *s = x->s;
  const int n = s->n;
  stf_times(n, "N", x->Q, "N", x->Z, s->X);
  stf_times(n, "N", x->W, "C", x->Q, s->Y);
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      s->X[i + n * j] *= x->scale[i];
      s->Y[i + n * j] /= x->scale[j];
    }
}

static int build(work *x, const double *A, double *balanced)
{
  stf_spectrum *s = x->s;
  STEIF_TRY(schur(x, A, balanced));
  double link = s->tolerance * s->norm;
  for (bool good = false; !good; link *= 4) {
    join(x, link);
    order(x);
    separate(x);
    good = measure(x) || s->count == 1;
  }
  assemble(x);
  return STEIF_OK;
}

int stf_spectrum_open(stf_spectrum *s, steif_context *ctx, int n, const double *A,
                      double tolerance)
{
  const size_t size = (size_t)n, square = size * size;
  *s = (stf_spectrum){.ctx = ctx, .n = n, .tolerance = tolerance};
  stf_number *kept = stf_allocate(ctx, 3 * square, sizeof *kept),
             *z = stf_allocate(ctx, 4 * square, sizeof *z);
  s->memory = kept;
  s->cluster = stf_allocate(ctx, size, sizeof *s->cluster);
  work x = {.s = s, .Q = z, .Z = z + square, .W = z + 2 * square};
  x.scale = stf_allocate(ctx, size, sizeof *x.scale);
  x.label = stf_allocate(ctx, size, sizeof *x.label);
  int code = STEIF_NO_MEMORY;
  if (kept && z && s->cluster && x.scale && x.label) {
    s->T = kept;
    s->X = kept + square;
    s->Y = kept + 2 * square;
    code = build(&x, A, (double *)(z + 3 * square));
  }
  stf_release(ctx, x.label);
  stf_release(ctx, x.scale);
  stf_release(ctx, z);
  if (code) stf_spectrum_close(s);
  return code;
}

void stf_spectrum_close(stf_spectrum *s)
{
  stf_release(s->ctx, s->cluster);
  stf_release(s->ctx, s->memory);
  s->cluster = NULL;
  s->memory = NULL;
}

void stf_spectrum_block(const stf_spectrum *s, int k, stf_number *N)
{
  const stf_cluster *c = s->cluster + k;
  for (int j = 0; j < c->size; j++)
    for (int i = 0; i < c->size; i++) {
      const int row = c->first + i, column = c->first + j;
      N[i + c->size * j] = i > j ? 0 : s->T[row + s->n * column] - (i == j ? c->mean : 0);
    }
}
