/* arnoldi.c: eigenvalues of a sparse pencil near S by Arnoldi's method for M = (S E + F)^{-1} E. M v =
 * v / (S - s) for an eigenvalue s; infinite ones have the eigenvalue 0, and a chain of k of them ends
 * after k products: the start is M^k of a random vector, and has no part in them.
 * W. E. Arnoldi, Quart. Appl. Math. 9 (1951); Y. Saad, Numerical Methods for Large Eigenvalue Problems
 * (2011), ch. VI.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "eigenpairs.h"
#include "lapack.h"
#include "random.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/pencil.h>
#include <string.h>

/* Vectors of the first space beside twice the eigenvalues wanted; its size after which it is not doubled
 * once more; shifts that are tried; work of zgeev per row. */
enum { MORE = 30, MOST = 480, TRIES = 3, ZGEEV = 4 };
/* Where S is an eigenvalue the shift goes beside it, by this part of max |F| / max |E|. */
#define BESIDE 1e-3
/* A new direction this small beside M v is rounding: the space is invariant. */
#define INVARIANT 1e-13

/* Imaginary parts this small, of a real pencil and at a real S, are rounding. */
#define NEARLY_REAL 1e-12

typedef struct arnoldi {
  stf_eigenpairs *p;
  steif_pencil *pencil;      /* s E - F, at s = -S */
  double complex shift;      /* S, or beside it */
  N_Vector half[2];          /* real and imaginary part of a right-hand side */
  int m, size;               /* vectors wanted, and got */
  double complex *V, *H, *x; /* n x (m + 1); (m + 1) x m; n */
  double complex *T, *Y, *theta, *work;
  sunrealtype *rwork;
  int *order; /* of the thetas, the largest first */
} arnoldi;

static void destroy_pencil(void *pencil)
{
  steif_pencil *p = pencil;
  steif_pencil_free(&p);
}

/* -- the operator ---------------------------------------------------------------------------- */

static int factor(arnoldi *a)
{
  const stf_eigenpairs *p = a->p;
  sunrealtype F = 0, E = 0;
  int code = STEIF_OK;
  for (int i = 0; i < p->n; i++) E = fmax(E, p->norm[0][i]), F = fmax(F, p->norm[1][i]);
  const sunrealtype beside = BESIDE * (E > 0 && F > 0 ? F / E : 1);
  a->shift = p->near;
  for (int k = 1; k <= TRIES; k++, a->shift += k * beside) {
    code =
      steif_pencil_factor(a->pencil, 1, &(steif_shift){-creal(a->shift), -cimag(a->shift)});
    if (code != STEIF_SINGULAR) return code;
  }
  return code;
}

static int open(arnoldi *a)
{
  const stf_eigenpairs *p = a->p;
  a->pencil = steif_pencil_new(p->ctx, p->E, p->F);
  if (!a->pencil) return steif_status(p->ctx);
  STEIF_TRY(stf_pool_adopt(p->pool, a->pencil, destroy_pencil));
  N_Vector like = N_VNewEmpty_Serial(p->n, steif_sundials(p->ctx));
  STEIF_CHECK(like, p->ctx, STEIF_NO_MEMORY, "no memory for a vector of %d values", p->n);
  for (int k = 0; k < 2; k++) a->half[k] = stf_pool_vector(p->pool, like);
  N_VDestroy(like);
  return a->half[0] && a->half[1] ? factor(a) : STEIF_NO_MEMORY;
}

/* y = (S E + F)^{-1} E x; x and y may be the same. */
static int apply(arnoldi *a, const double complex *x, double complex *y)
{
  const stf_eigenpairs *p = a->p;
  sunrealtype *re = N_VGetArrayPointer(a->half[0]), *im = N_VGetArrayPointer(a->half[1]);
  stf_eigenpairs_product(p, 'E', x, p->r);
  for (int i = 0; i < p->n; i++) {
    re[i] = -creal(p->r[i]);
    im[i] = -cimag(p->r[i]);
  }
  STEIF_TRY(cimag(a->shift) != 0 ? steif_pencil_solve(a->pencil, 0, 1, &a->half[0], &a->half[1])
                                 : steif_pencil_solve(a->pencil, 0, 2, a->half, NULL));
  for (int i = 0; i < p->n; i++) y[i] = re[i] + I * im[i];
  return STEIF_OK;
}

/* -- the space ------------------------------------------------------------------------------- */

static sunrealtype length(int n, const double complex *x)
{
  sunrealtype square = 0;
  for (int i = 0; i < n; i++) square += creal(x[i]) * creal(x[i]) + cimag(x[i]) * cimag(x[i]);
  return sqrt(square);
}

static void divide(int n, sunrealtype by, double complex *x)
{
  for (int i = 0; i < n; i++) x[i] /= by;
}

/* M^(k + 1) times a random vector, k the index. */
static int start(arnoldi *a)
{
  stf_random random = {a->p->analysis->seed + 1};
  const int n = a->p->n, index = a->p->structure->index;
  for (int i = 0; i < n; i++) a->V[i] = stf_random_in(&random, -1, 1);
  for (int k = 0; k <= index; k++) {
    STEIF_TRY(apply(a, a->V, a->V));
    const sunrealtype size = length(n, a->V);
    a->size = 0;
    if (!(size > 0)) return STEIF_OK;
    divide(n, size, a->V);
  }
  a->size = 1;
  return STEIF_OK;
}

/* Gram and Schmidt, twice; what is left of v, and its column of H. */
static sunrealtype orthogonalise(arnoldi *a, int j, double complex *v)
{
  const int n = a->p->n;
  double complex *h = a->H + (size_t)j * (size_t)(a->m + 1);
  for (int pass = 0; pass < 2; pass++)
    for (int k = 0; k <= j; k++) {
      const double complex *q = a->V + (size_t)k * (size_t)n;
      double complex dot = 0;
      for (int i = 0; i < n; i++) dot += conj(q[i]) * v[i];
      for (int i = 0; i < n; i++) v[i] -= dot * q[i];
      h[k] += dot;
    }
  h[j + 1] = length(n, v);
  return creal(h[j + 1]);
}

/* V of a->m vectors, or as many as the space has. */
static int span(arnoldi *a)
{
  const int n = a->p->n;
  memset(a->H, 0, (size_t)(a->m + 1) * (size_t)a->m * sizeof *a->H);
  STEIF_TRY(start(a));
  for (int j = 0; a->size && j < a->m; j++) {
    double complex *next = a->V + (size_t)(j + 1) * (size_t)n;
    STEIF_TRY(apply(a, a->V + (size_t)j * (size_t)n, next));
    const sunrealtype before = length(n, next), left = orthogonalise(a, j, next);
    a->size = j + 1;
    if (!(left > INVARIANT * before)) break;
    divide(n, left, next);
  }
  return STEIF_OK;
}

/* -- Ritz values ----------------------------------------------------------------------------- */

static int ritz(arnoldi *a)
{
  const int m = a->size, lwork = ZGEEV * m, one = 1;
  int info = 0;
  for (int j = 0; j < m; j++)
    for (int i = 0; i < m; i++)
      a->T[j * m + i] = a->H[(size_t)j * (size_t)(a->m + 1) + (size_t)i];
  if (m)
    zgeev_("N", "V", &m, a->T, &m, a->theta, NULL, &one, a->Y, &m, a->work, &lwork, a->rwork,
           &info, 1, 1);
  STEIF_CHECK(!info, a->p->ctx, STEIF_NOT_CERTIFIED,
              "eigenvalues of a matrix of order %d did not converge (zgeev: %d)", m, info);
  for (int k = 0; k < m; k++) { /* by insertion */
    int at = k;
    for (; at > 0 && cabs(a->theta[k]) > cabs(a->theta[a->order[at - 1]]); at--)
      a->order[at] = a->order[at - 1];
    a->order[at] = k;
  }
  return STEIF_OK;
}

static steif_eigenvalue ritz_pair(const arnoldi *a, int k)
{
  const int n = a->p->n, m = a->size;
  const double complex *y = a->Y + (size_t)k * (size_t)m;
  for (int i = 0; i < n; i++) a->x[i] = 0;
  for (int j = 0; j < m; j++)
    for (int i = 0; i < n; i++) a->x[i] += y[j] * a->V[(size_t)j * (size_t)n + (size_t)i];
  double complex s = a->shift - 1 / a->theta[k];
  const sunrealtype size = cabs(a->shift) + 1 / cabs(a->theta[k]);
  if (cimag(a->shift) == 0 && fabs(cimag(s)) <= NEARLY_REAL * size) s = creal(s);
  return stf_eigenpairs_measure(a->p, s, a->x);
}

/* Is it the first of a pair whose other one is the next? */
static bool parted(const stf_eigenpairs *p)
{
  const steif_eigenvalue *last = p->value + p->count - 1, *before = last - 1;
  if (p->count < 1 || cimag(p->near) != 0) return false;
  const sunrealtype size = hypot(last->re, last->im), near = 1e-6 * size;
  if (fabs(last->im) <= near) return false;
  for (long k = p->count - 2; k >= 0; k--, before--)
    if (hypot(before->re - last->re, before->im + last->im) <= near) return false;
  return true;
}

/* The eigenvalues nearest to S; how many of them have not converged. */
static int collect(arnoldi *a, long *open_ones)
{
  stf_eigenpairs *p = a->p;
  const sunrealtype largest = a->size ? cabs(a->theta[a->order[0]]) : 0;
  p->count = *open_ones = 0;
  for (int k = 0; k < a->size && (p->count < p->wanted || parted(p)); k++) {
    if (!(cabs(a->theta[a->order[k]]) > STF_EPS * largest)) break;
    const steif_eigenvalue found = ritz_pair(a, a->order[k]);
    p->value[p->count++] = found;
    *open_ones += !(found.residual <= STF_CONVERGED);
  }
  return STEIF_OK;
}

/* -- passes ----------------------------------------------------------------------------------- */

static int allocate(arnoldi *a)
{
  stf_pool *pool = a->p->pool;
  const size_t n = (size_t)a->p->n, m = (size_t)a->m, size = sizeof *a->V;
  a->V = stf_pool_array(pool, n * (m + 1), size);
  a->H = stf_pool_array(pool, (m + 1) * m, size);
  a->T = stf_pool_array(pool, 2 * m * m, size);
  a->theta = stf_pool_array(pool, (1 + ZGEEV) * m + n, size);
  a->rwork = stf_pool_array(pool, 2 * m, sizeof *a->rwork);
  a->order = stf_pool_array(pool, m, sizeof *a->order);
  if (!a->V || !a->H || !a->T || !a->theta || !a->rwork || !a->order) return STEIF_NO_MEMORY;
  a->Y = a->T + m * m;
  a->work = a->theta + m;
  a->x = a->work + ZGEEV * m;
  return STEIF_OK;
}

/* Converged ones alone count; they are the nearest where all before them have. */
static void keep_converged(stf_eigenpairs *p)
{
  long kept = 0;
  for (long k = 0; k < p->count; k++)
    if (p->value[k].residual <= STF_RESIDUAL) p->value[kept++] = p->value[k];
  p->count = kept;
}

int stf_eigenpairs_sparse(stf_eigenpairs *p)
{
  arnoldi a = {.p = p};
  const long finite = p->structure->finite, first = 2 * p->wanted + MORE;
  long left = 1;
  p->value = stf_pool_array(p->pool, (size_t)p->wanted + 2, sizeof *p->value);
  if (!p->value) return STEIF_NO_MEMORY;
  STEIF_TRY(open(&a));
  for (long m = first; left; m *= 2) {
    const long most = finite >= 0 ? finite : p->n;
    a.m = (int)(m < most ? m : most);
    if (a.m < 1) return STEIF_OK;
    STEIF_TRY(allocate(&a));
    STEIF_TRY(span(&a));
    STEIF_TRY(ritz(&a));
    STEIF_TRY(collect(&a, &left));
    if (a.m == most || a.size < a.m || m > MOST) break;
  }
  keep_converged(p);
  return STEIF_OK;
}
