/* blocks.c: a random dense pencil of known structure,
 *
 *   E = U diag(I, N_1, N_2, ...) V,   F = U diag(J, I, I, ...) V,
 *
 * N_b nilpotent Jordan blocks with ones above the diagonal, of the sizes in sizes=3.2.1 (or
 * index=k: one block; 2x50.3x20: fifty blocks of size 2 and twenty of size 3), J of order nf with
 * eigenvalues up to rho in modulus: kind=osc, blocks omega [0.05 1; -1 0.05] with omega spaced by
 * equal ratios from 0.1 to rho, or kind=stiff, a diagonal so spaced. U and V are products of
 * random reflections around singular values spaced by equal ratios from sqrt(kappa) to
 * 1/sqrt(kappa).
 *
 * With (h, k) = U^{-1} f and (y, z) = V x(0-):  y is continuous and, block by block,
 *   z(0+) = sum_i (-1)^i N^i k^(i)(0),   c_i = (-1)^i N^{i+1} (z - z(0+)).
 * Structure and start belong to E and F within rounding times powers of kappa.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "generated.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 1000, TALLEST = 12 };

/* n x n matrices by columns. */
typedef struct pencil {
  sunindextype n, finite;
  int tallest;
  bool stiff, last[MOST]; /* last: row i ends a block */
  sunrealtype rho, kappa, *U, *Ui, *V, *Vi;
} pencil;

static void times(const sunrealtype *A, sunindextype n, const sunrealtype *x, sunrealtype *out)
{
  memset(out, 0, (size_t)n * sizeof *out);
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype i = 0; i < n; i++) out[i] += A[i + n * j] * x[j];
}

/* x = N x in the places of the blocks. */
static void shift(const pencil *p, sunrealtype *x)
{
  for (sunindextype i = p->finite; i < p->n; i++) x[i] = p->last[i] ? 0 : x[i + 1];
}

/* w = sum_i (-1)^i N^i k^(i)(0) in the places of the blocks: Horner's scheme in N. */
static void smooth(const stf_linear *l, sunrealtype *w, sunrealtype *f, sunrealtype *h)
{
  const pencil *p = l->data;
  for (int i = l->dae_index - 1; i >= 0; i--) {
    stf_linear_force(l, 0, i, f);
    times(p->Ui, p->n, f, h);
    shift(p, w);
    for (sunindextype k = p->finite; k < p->n; k++) w[k] = h[k] - w[k];
  }
}

static int jump(steif_context *ctx, const stf_linear *l, const sunrealtype *x0,
                stf_exact_start *out)
{
  const pencil *p = l->data;
  const sunindextype n = p->n;
  sunrealtype *d = stf_allocate(ctx, 4 * (size_t)n, sizeof *d);
  if (!d) return STEIF_NO_MEMORY;
  sunrealtype *after = d + n, *f = after + n, *h = f + n;
  times(p->V, n, x0, d);
  memcpy(after, d, (size_t)p->finite * sizeof *after);
  smooth(l, after, f, h);
  times(p->Vi, n, after, out->x_plus);
  for (sunindextype k = 0; k < n; k++) d[k] -= after[k];
  for (int i = 0; i + 1 < l->dae_index; i++) {
    shift(p, d);
    times(p->Vi, n, d, out->c + i * n);
    for (sunindextype k = 0; k < n; k++) d[k] = -d[k];
  }
  stf_release(ctx, d);
  return STEIF_OK;
}

/* A = H A and B = B H with H = I - v v^T, v^T v = 2, v zero above `from`. */
static void reflect(sunrealtype *A, sunrealtype *B, sunindextype n, sunindextype from,
                    const sunrealtype *v, sunrealtype *Bv)
{
  memset(Bv, 0, (size_t)n * sizeof *Bv);
  for (sunindextype j = 0; j < n; j++) {
    sunrealtype dot = 0, *a = A + n * j, *b = B + n * j;
    for (sunindextype i = from; i < n; i++) dot += v[i] * a[i];
    for (sunindextype i = from; i < n; i++) a[i] -= dot * v[i];
    for (sunindextype i = 0; j >= from && i < n; i++) Bv[i] += b[i] * v[j];
  }
  for (sunindextype j = from; j < n; j++)
    for (sunindextype i = 0; i < n; i++) B[i + n * j] -= Bv[i] * v[j];
}

static void direction(stf_random *r, sunindextype n, sunindextype from, sunrealtype *v)
{
  sunrealtype square = 0;
  for (sunindextype i = from; i < n; i++) {
    v[i] = stf_random_normal(r);
    square += v[i] * v[i];
  }
  for (sunindextype i = from; i < n; i++) v[i] *= sqrt(2 / square);
}

/* A random A with singular values kappa^(1/2 - i/(n-1)), i < n, and its inverse. v: 2 n. */
static void turn(sunrealtype *A, sunrealtype *inverse, sunindextype n, sunrealtype kappa,
                 stf_random *r, sunrealtype *v)
{
  for (sunindextype i = 0; i < n; i++) {
    const sunrealtype at = n > 1 ? (sunrealtype)i / (sunrealtype)(n - 1) : 0.5;
    A[i + n * i] = pow(kappa, 0.5 - at);
    inverse[i + n * i] = pow(kappa, at - 0.5);
  }
  for (sunindextype from = 0; from < n; from++) {
    direction(r, n, from, v);
    reflect(A, inverse, n, from, v, v + n);
    direction(r, n, from, v);
    reflect(inverse, A, n, from, v, v + n);
  }
}

/* Number i of `count` rates from 0.1 to rho. */
static sunrealtype rate(sunindextype i, sunindextype count, sunrealtype rho)
{
  return count > 1 ? rho * pow(0.1 / rho, 1 - (sunrealtype)i / (sunrealtype)(count - 1)) : rho;
}

/* Row i of diag(J, I, ...) V; v: a column of V. */
static sunrealtype constant(const pencil *p, sunindextype i, const sunrealtype *v)
{
  if (i >= p->finite) return v[i];
  if (p->stiff) return rate(i, p->finite, p->rho) * v[i];
  const sunrealtype omega = rate(i / 2, p->finite / 2, p->rho);
  return omega * (0.05 * v[i] + (i % 2 ? -v[i - 1] : v[i + 1]));
}

static void multiply(stf_linear *l, sunrealtype *work)
{
  const pencil *p = l->data;
  const sunindextype n = p->n;
  for (sunindextype j = 0; j < n; j++) {
    const sunrealtype *v = p->V + n * j;
    memcpy(work, v, (size_t)n * sizeof *v);
    shift(p, work);
    times(p->U, n, work, work + n);
    for (sunindextype i = 0; i < n; i++) stf_linear_put(&l->E, i, j, work[n + i]);
    for (sunindextype i = 0; i < n; i++) work[i] = constant(p, i, v);
    times(p->U, n, work, work + n);
    for (sunindextype i = 0; i < n; i++) stf_linear_put(&l->F, i, j, work[n + i]);
  }
}

static int randomise(stf_linear *l, pencil *p, stf_random *r)
{
  const sunindextype n = p->n;
  const size_t square = (size_t)(n * n);
  sunrealtype *work = stf_pool_array(l->scratch, 2 * (size_t)n, sizeof *work);
  p->U = work ? stf_pool_array(l->pool, 4 * square, sizeof *p->U) : NULL;
  if (!p->U) return STEIF_NO_MEMORY;
  p->Ui = p->U + square;
  p->V = p->Ui + square;
  p->Vi = p->V + square;
  turn(p->U, p->Ui, n, p->kappa, r, work);
  turn(p->V, p->Vi, n, p->kappa, r, work);
  multiply(l, work);
  for (sunindextype i = 0; i < n; i++) {
    const sunrealtype size = stf_random_normal(r), pace = stf_random_in(r, 0.5, 2);
    stf_linear_wave(l, i, size, pace, stf_random_in(r, 0, 6));
    work[i] = stf_random_normal(r);
    l->index[i] = l->dae_index < 3 ? l->dae_index : 3;
  }
  times(p->Vi, n, work, l->start);
  return STEIF_OK;
}

/* Append `count` blocks. */
static int append(steif_context *ctx, const steif_spec *spec, pencil *p, long size, long count)
{
  STEIF_CHECK(size >= 1 && size <= TALLEST && count >= 1 && count <= MOST &&
                p->n + size * count <= MOST,
              ctx, STEIF_BAD_INPUT,
              "%ld blocks of size %ld do not fit into '%s': sizes from 1 to %d, at most %d "
              "unknowns in all",
              count, size, spec->name, TALLEST, MOST);
  for (; count > 0; count--) p->last[(p->n += (sunindextype)size) - 1] = true;
  if (size > p->tallest) p->tallest = (int)size;
  return STEIF_OK;
}

static int sizes(steif_context *ctx, const steif_spec *spec, pencil *p)
{
  const char *text = stf_spec_word(spec, "sizes");
  if (!text) text = "3.2.1";
  for (const char *at = text; *at;) {
    char *end;
    const long size = strtol(at, &end, 10), count = *end == 'x' ? strtol(end + 1, &end, 10) : 1;
    STEIF_CHECK(end > at && (!*end || (*end == '.' && end[1])), ctx, STEIF_BAD_INPUT,
                "sizes=%s of '%s' cannot be read: write 3.2.1 or 2x50.3x20", text, spec->name);
    STEIF_TRY(append(ctx, spec, p, size, count));
    at = *end ? end + 1 : end;
  }
  return STEIF_OK;
}

static int structure(steif_context *ctx, const steif_spec *spec, pencil *p)
{
  int nf, index;
  const char *kind = stf_spec_word(spec, "kind");
  p->stiff = kind && !strcmp(kind, "stiff");
  STEIF_CHECK(!kind || p->stiff || !strcmp(kind, "osc"), ctx, STEIF_UNKNOWN_NAME,
              "kind=%s of '%s' is not known: choose osc or stiff", kind, spec->name);
  STEIF_TRY(stf_spec_int(ctx, spec, "nf", 0, MOST - 1, 10, &nf));
  STEIF_CHECK(p->stiff || nf % 2 == 0, ctx, STEIF_BAD_INPUT,
              "nf=%d of '%s' must be even, its eigenvalues are pairs: take kind=stiff", nf,
              spec->name);
  STEIF_TRY(stf_spec_int(ctx, spec, "index", 1, TALLEST, 0, &index));
  STEIF_CHECK(!index || !stf_spec_word(spec, "sizes"), ctx, STEIF_BAD_INPUT,
              "'%s' takes index (one block) or sizes, not both", spec->name);
  STEIF_TRY(stf_spec_real(ctx, spec, "rho", 0.1, 1e12, 10, &p->rho));
  STEIF_TRY(stf_spec_real(ctx, spec, "kappa", 1, 1e12, 1, &p->kappa));
  p->n = p->finite = nf;
  return index ? append(ctx, spec, p, index, 1) : sizes(ctx, spec, p);
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  static const char *const keys[] = {"index", "sizes", "nf",   "rho",     "kappa",
                                     "kind",  "seed",  "case", "storage", NULL};
  pencil p = {0};
  stf_random r;
  STEIF_TRY(stf_spec_only(ctx, spec, keys));
  STEIF_TRY(structure(ctx, spec, &p));
  STEIF_TRY(stf_random_seed(ctx, spec, &r));
  stf_linear *l = stf_linear_open(ctx, self, p.n, p.n * p.n, p.n * p.n, p.n);
  pencil *kept = l ? stf_pool_array(l->pool, 1, sizeof *kept) : NULL;
  if (!kept) return STEIF_NO_MEMORY;
  *kept = p;
  l->data = kept;
  l->dae_index = p.tallest;
  l->finite = p.finite;
  l->jump = jump;
  STEIF_TRY(randomise(l, kept, &r));
  return stf_linear_finish(ctx, spec, self);
}

const steif_problem steif_problem_blocks = {
  .about =
    "random dense pencil with nf=10 finite eigenvalues up to rho=10 and nilpotent blocks "
    "sizes=3.2.1, condition kappa=1 of both transformations, impulses at the start (case=inc); "
    "theory: S. L. Campbell, Singular Systems of Differential Equations, Pitman 1980",
  .t1 = 1,
  .storage = STEIF_DENSE,
  .build = build,
  STF_LINEAR_CALLBACKS,
};
