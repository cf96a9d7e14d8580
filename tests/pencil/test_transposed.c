/* test_transposed.c: solves with transposed factors against dense LAPACK, and as transposes of solves.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gear.h"
#include "lapack.h"
#include "suite.h"
#include <stdlib.h>
#include <string.h>

static const SUNMatrix_ID storages[] = {SUNMATRIX_DENSE, SUNMATRIX_BAND, SUNMATRIX_SPARSE};
static const steif_shift shifts[] = {{2.7182, 0}, {-3.25, 0}, {1.61, 7.39}, {0.577, -40.3}};
enum { SHIFTS = 4, RHS = 5 };

/* x := (s E - A)^{-H} x by LAPACK, x interleaved. */
static void reference(const gear *g, steif_shift s, double *x)
{
  const int n = g->n, one = 1;
  static double M[2 * GEAR_MOST * GEAR_MOST];
  static int pivot[GEAR_MOST];
  int info;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      const double e = g->identity ? i == j : g->E[i + n * j];
      M[2 * (j + n * i)] = s.re * e - g->A[i + n * j];
      M[2 * (j + n * i) + 1] = -s.im * e;
    }
  zgesv_(&n, &one, M, &n, pivot, x, &n, &info);
  CHECK(info == 0);
}

static double largest(int n, const double *x)
{
  double most = 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  return most;
}

static void agrees(const gear *g, steif_pencil *p, int k, int count, double tolerance,
                   SUNContext sun)
{
  const bool complex = shifts[k].im != 0;
  N_Vector re[RHS], im[RHS];
  for (int i = 0; i < count; i++)
    re[i] = gear_vector(g->n, 31u + (unsigned)i, sun),
    im[i] = gear_vector(g->n, 77u + (unsigned)i, sun);
  CHECK(steif_pencil_solve_transposed(p, k, count, re, complex ? im : NULL) == STEIF_OK);
  for (int i = 0; i < count; i++) {
    N_Vector br = gear_vector(g->n, 31u + (unsigned)i, sun),
             bi = gear_vector(g->n, 77u + (unsigned)i, sun);
    double x[2 * GEAR_MOST], d[2 * GEAR_MOST];
    for (int j = 0; j < g->n; j++)
      x[2 * j] = NV_Ith_S(br, j), x[2 * j + 1] = complex ? NV_Ith_S(bi, j) : 0;
    reference(g, shifts[k], x);
    for (int j = 0; j < g->n; j++)
      d[2 * j] = NV_Ith_S(re[i], j) - x[2 * j],
            d[2 * j + 1] = complex ? NV_Ith_S(im[i], j) - x[2 * j + 1] : 0;
    CLOSE_FLOOR(largest(2 * g->n, d), 0, tolerance, fmax(1, largest(2 * g->n, x)));
    N_VDestroy(br), N_VDestroy(bi);
  }
  for (int i = 0; i < count; i++) N_VDestroy(re[i]), N_VDestroy(im[i]);
}

static void in_storage(int n, bool identity, SUNMatrix_ID id)
{
  gear g;
  gear_fill(&g, n, identity, 4711u + (unsigned)n);
  steif_context *ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix E = identity ? NULL : gear_matrix(g.E, n, id, sun),
            A = gear_matrix(g.A, n, id, sun);
  steif_pencil *p = steif_pencil_new(ctx, E, A);
  CHECK(steif_pencil_factor(p, SHIFTS, shifts) == STEIF_OK);
  for (int k = 0; k < SHIFTS; k++)
    agrees(&g, p, k, 1, 1e-12, sun), agrees(&g, p, k, RHS, 1e-12, sun);
  steif_pencil_free(&p);
  if (E) SUNMatDestroy(E);
  SUNMatDestroy(A);
  steif_context_free(&ctx);
}

static void agree_with_lapack(void)
{
  const int n[] = {1, 2, 3, 5, 8, 9, 13, 16, 17, 40, 60};
  for (size_t i = 0; i < sizeof n / sizeof *n; i++)
    for (int k = 0; k < 3; k++)
      in_storage(n[i], false, storages[k]), in_storage(n[i], true, storages[k]);
}

/* Full matrices without any symmetry: LAPACK's dense and wide band codes, and KLU's. */
static void full_matrices(void)
{
  gear g = {.n = 40};
  unsigned seed = 5;
  for (int i = 0; i < g.n * g.n; i++) g.E[i] = gear_random(&seed), g.A[i] = gear_random(&seed);
  steif_context *ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(ctx);
  for (int kind = 0; kind < 3; kind++) {
    SUNMatrix M[2];
    for (int i = 0; i < 2; i++) {
      const double *from = i ? g.A : g.E;
      M[i] = SUNDenseMatrix(g.n, g.n, sun);
      memcpy(SM_DATA_D(M[i]), from, (size_t)(g.n * g.n) * sizeof *from);
      SUNMatrix dense = M[i];
      if (kind == 1) {
        M[i] = SUNBandMatrix(g.n, g.n - 1, g.n - 1, sun);
        for (int j = 0; j < g.n; j++)
          for (int r = 0; r < g.n; r++) SM_ELEMENT_B(M[i], r, j) = from[r + g.n * j];
      }
      if (kind == 2) M[i] = SUNSparseFromDenseMatrix(dense, 0, CSC_MAT);
      if (kind) SUNMatDestroy(dense);
    }
    steif_pencil *p = steif_pencil_new(ctx, M[0], M[1]);
    CHECK(steif_pencil_factor(p, SHIFTS, shifts) == STEIF_OK);
    for (int k = 0; k < SHIFTS; k++) agrees(&g, p, k, RHS, 1e-12, sun);
    steif_pencil_free(&p);
    SUNMatDestroy(M[0]), SUNMatDestroy(M[1]);
  }
  steif_context_free(&ctx);
}

/* A convected grid, large enough for fronts: u . solve(v) = transposed(u) . v. */
static void fronts(void)
{
  enum { SIDE = 32, N = SIDE * SIDE };
  steif_context *ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix A = SUNSparseMatrix(N, N, 5 * N, CSC_MAT, sun);
  sunindextype at = 0;
  unsigned seed = 9;
  for (int j = 0; j < N; j++) {
    const int row[] = {j - SIDE, j - 1, j, j + 1, j + SIDE};
    SM_INDEXPTRS_S(A)[j] = at;
    for (int k = 0; k < 5; k++) {
      if (row[k] < 0 || row[k] >= N || (abs(row[k] - j) == 1 && row[k] / SIDE != j / SIDE))
        continue;
      SM_INDEXVALS_S(A)[at] = row[k];
      SM_DATA_S(A)[at++] = (k == 2 ? -4 : 1) + 0.7 * gear_random(&seed);
    }
  }
  SM_INDEXPTRS_S(A)[N] = at;
  steif_pencil *p = steif_pencil_new(ctx, NULL, A);
  CHECK(steif_pencil_factor(p, SHIFTS, shifts) == STEIF_OK);
  for (int k = 0; k < SHIFTS; k++) {
    N_Vector u[2], v[2], x[2], y[2];
    double left = 0, right = 0, size = 0;
    for (int i = 0; i < 2; i++) {
      u[i] = gear_vector(N, 3u + (unsigned)i, sun),
      v[i] = gear_vector(N, 8u + (unsigned)i, sun);
      x[i] = gear_vector(N, 3u + (unsigned)i, sun),
      y[i] = gear_vector(N, 8u + (unsigned)i, sun);
    }
    const bool complex = shifts[k].im != 0;
    CHECK(steif_pencil_solve(p, k, 1, &y[0], complex ? &y[1] : NULL) == STEIF_OK);
    CHECK(steif_pencil_solve_transposed(p, k, 1, &x[0], complex ? &x[1] : NULL) == STEIF_OK);
    for (int i = 0; i < 1 + complex; i++) {
      left += N_VDotProd(u[i], y[i]), right += N_VDotProd(x[i], v[i]);
      size += sqrt(N_VDotProd(u[i], u[i]) * N_VDotProd(y[i], y[i]));
    }
    CLOSE_FLOOR(left, right, 1e-13, size);
    for (int i = 0; i < 2; i++)
      N_VDestroy(u[i]), N_VDestroy(v[i]), N_VDestroy(x[i]), N_VDestroy(y[i]);
  }
  steif_pencil_free(&p);
  SUNMatDestroy(A);
  steif_context_free(&ctx);
}

/* z = (re E - A)^{-1} r, or its transpose, for the re prepared; complex shifts are near it only. */
typedef struct preconditioned {
  gear g; /* first: the products take it for their user */
  double near;
  int calls;
} preconditioned;

static int prepare(sunrealtype re, void *user)
{
  ((preconditioned *)user)->near = re;
  return 0;
}

static int solve_near(void *user, bool transposed, N_Vector r, N_Vector z)
{
  preconditioned *q = user;
  const int n = q->g.n, one = 1;
  double M[GEAR_MOST * GEAR_MOST];
  int pivot[GEAR_MOST], info;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++)
      M[i + n * j] = q->near * (q->g.identity ? i == j : q->g.E[i + n * j]) - q->g.A[i + n * j];
  N_VScale(1, r, z);
  dgetrf_(&n, &n, M, &n, pivot, &info);
  if (!info)
    dgetrs_(transposed ? "T" : "N", &n, &one, M, &n, pivot, NV_DATA_S(z), &n, &info, 1);
  q->calls++;
  return info;
}

static int near(sunrealtype re, N_Vector r, N_Vector z, sunrealtype tolerance, void *user)
{
  (void)re, (void)tolerance;
  return solve_near(user, false, r, z);
}

static int turned_near(sunrealtype re, N_Vector r, N_Vector z, sunrealtype tolerance,
                       void *user)
{
  (void)re, (void)tolerance;
  return solve_near(user, true, r, z);
}

/* Known by products; the second time with a preconditioner too. */
static void operators(void)
{
  preconditioned q = {.near = 0};
  for (int with = 0; with < 2; with++)
    for (int identity = 0; identity < 2; identity++)
      for (int n = 3; n <= 40; n += 37) {
        gear_fill(&q.g, n, identity, 11);
        q.calls = 0;
        steif_context *ctx = steif_context_new(NULL);
        N_Vector like = gear_vector(n, 1, steif_sundials(ctx));
        steif_operator op = gear_operator(&q.g);
        steif_transposed turned = gear_transposed(&q.g);
        op.tolerance = 1e-12;
        if (with)
          op.prepare = prepare, op.precondition = near, turned.precondition = turned_near;
        steif_pencil *p = steif_pencil_new_operator(ctx, &op, like);
        CHECK(steif_pencil_give_transposed(p, &turned) == STEIF_OK);
        CHECK(steif_pencil_factor(p, SHIFTS, shifts) == STEIF_OK);
        for (int k = 0; k < SHIFTS; k++) agrees(&q.g, p, k, 2, 1e-9, steif_sundials(ctx));
        CHECK(!with || q.calls > 0);
        steif_pencil_free(&p);
        N_VDestroy(like);
        steif_context_free(&ctx);
      }
}

/* Both ways with one pencil: a solve with the transpose leaves nothing that the next one without it sees. */
static void operators_turn_back(void)
{
  gear g;
  gear_fill(&g, 30, false, 5);
  steif_context *ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(ctx);
  N_Vector u[2] = {gear_vector(30, 3, sun), gear_vector(30, 4, sun)},
           v[2] = {gear_vector(30, 6, sun), gear_vector(30, 7, sun)};
  const steif_operator op = gear_operator(&g);
  const steif_transposed turned = gear_transposed(&g);
  steif_pencil *p = steif_pencil_new_operator(ctx, &op, u[0]);
  CHECK(steif_pencil_give_transposed(p, &turned) == STEIF_OK);
  CHECK(steif_pencil_factor(p, SHIFTS, shifts) == STEIF_OK);
  for (int k = 0; k < SHIFTS; k++) {
    const bool complex = shifts[k].im != 0;
    N_Vector x[2], y[2];
    double left = 0, right = 0, size = 0;
    for (int i = 0; i < 2; i++) {
      x[i] = N_VClone(u[i]), y[i] = N_VClone(v[i]);
      N_VScale(1, u[i], x[i]), N_VScale(1, v[i], y[i]);
    }
    CHECK(steif_pencil_solve_transposed(p, k, 1, &x[0], complex ? &x[1] : NULL) == STEIF_OK);
    CHECK(steif_pencil_solve(p, k, 1, &y[0], complex ? &y[1] : NULL) == STEIF_OK);
    for (int i = 0; i < 1 + complex; i++) {
      left += N_VDotProd(u[i], y[i]), right += N_VDotProd(x[i], v[i]);
      size += sqrt(N_VDotProd(u[i], u[i]) * N_VDotProd(y[i], y[i]));
    }
    CLOSE_FLOOR(left, right, 1e-9, size);
    for (int i = 0; i < 2; i++) N_VDestroy(x[i]), N_VDestroy(y[i]);
  }
  for (int i = 0; i < 2; i++) N_VDestroy(u[i]), N_VDestroy(v[i]);
  steif_pencil_free(&p);
  steif_context_free(&ctx);
}

static int fails(N_Vector x, N_Vector out, void *user)
{
  (void)x, (void)out, (void)user;
  return -7;
}

static void operators_are_refused(void)
{
  gear g;
  gear_fill(&g, 10, false, 1);
  steif_context *ctx = steif_context_new(NULL);
  N_Vector like = gear_vector(10, 1, steif_sundials(ctx));
  const steif_operator op = gear_operator(&g);
  steif_pencil *p = steif_pencil_new_operator(ctx, &op, like);
  CHECK(steif_pencil_factor(p, 1, shifts) == STEIF_OK);
  CHECK(steif_pencil_solve_transposed(p, 0, 1, &like, NULL) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "transposed") != NULL);
  CHECK(steif_pencil_solve_transposed(NULL, 0, 1, &like, NULL) == STEIF_BAD_INPUT);
  steif_transposed turned = {.A = fails};
  CHECK(steif_pencil_give_transposed(p, &turned) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "E, since") != NULL);
  CHECK(steif_pencil_give_transposed(p, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_pencil_give_transposed(NULL, &turned) == STEIF_BAD_INPUT);
  turned.E = fails;
  CHECK(steif_pencil_give_transposed(p, &turned) == STEIF_OK);
  CHECK(steif_pencil_solve_transposed(p, 0, 1, &like, NULL) == STEIF_CALLBACK);
  CHECK(strstr(steif_message(ctx), "transposed A of the operator returned -7") != NULL);
  SUNMatrix A = gear_matrix(g.A, 10, SUNMATRIX_DENSE, steif_sundials(ctx));
  steif_pencil *own = steif_pencil_new(ctx, NULL, A);
  CHECK(steif_pencil_give_transposed(own, &turned) == STEIF_UNSUPPORTED);
  steif_pencil_free(&own);
  SUNMatDestroy(A);
  steif_pencil_free(&p);
  N_VDestroy(like);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_transposed[] = {{"transposed solves agree with LAPACK", agree_with_lapack},
                                     {"full unsymmetric matrices", full_matrices},
                                     {"fronts and KLU are transposed", fronts},
                                     {"operators agree with LAPACK", operators},
                                     {"operators turn back", operators_turn_back},
                                     {"operators without a transpose", operators_are_refused},
                                     CU_TEST_INFO_NULL};
