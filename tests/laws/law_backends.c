/* law_backends.c: dense, band, sparse and Krylov storage, given Jacobians and differences, and every
 * kind of vector give the same run; so do the forms in which one system can be written.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "laws.h"
#include <nvector/nvector_manyvector.h>
#ifdef HAVE_NVECTOR_OPENMP
#include <nvector/nvector_openmp.h>
#endif
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* A reaction-diffusion chain: y_i' = 37 (y_{i-1} - 2 y_i + y_{i+1}) - 1.3 y_i^2 + 0.4 y_{i+1} sin t,
 * zero beyond both ends. */
enum { N = 11 };
static sunrealtype start[N];

static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *u = N_VGetArrayPointer(y);
  sunrealtype *v = N_VGetArrayPointer(r);
  (void)user;
  for (int i = 0; i < N; i++) {
    const sunrealtype left = i ? u[i - 1] : 0, right = i + 1 < N ? u[i + 1] : 0;
    v[i] = 37 * (left - 2 * u[i] + right) - 1.3 * u[i] * u[i] + 0.4 * right * sin(t);
  }
  return 0;
}

static sunrealtype entry(sunrealtype t, const sunrealtype *u, int i, int j)
{
  if (i == j) return -74 - 2.6 * u[i];
  return j == i + 1 ? 37 + 0.4 * sin(t) : 37;
}

static void set(SUNMatrix J, int i, int j, sunrealtype value)
{
  if (SUNMatGetID(J) == SUNMATRIX_DENSE) SM_ELEMENT_D(J, i, j) = value;
  if (SUNMatGetID(J) == SUNMATRIX_BAND) SM_ELEMENT_B(J, i, j) = value;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const sunrealtype *u = N_VGetArrayPointer(y);
  const int sparse = SUNMatGetID(J) == SUNMATRIX_SPARSE;
  sunindextype used = 0;
  (void)fy, (void)user, (void)a, (void)b, (void)c;
  for (int j = 0; j < N; j++) {
    if (sparse) SUNSparseMatrix_IndexPointers(J)[j] = used;
    for (int i = j ? j - 1 : 0; i <= j + 1 && i < N; i++) {
      if (!sparse) set(J, i, j, entry(t, u, i, j));
      if (!sparse) continue;
      SUNSparseMatrix_IndexValues(J)[used] = i;
      SUNSparseMatrix_Data(J)[used++] = entry(t, u, i, j);
    }
  }
  if (sparse) SUNSparseMatrix_IndexPointers(J)[N] = used;
  return 0;
}

static sunindextype column[N + 1], row[3 * N];
static const steif_pattern pattern = {column, row};

static steif_problem chain(void)
{
  sunindextype used = 0;
  for (int j = 0; j < N; j++) {
    start[j] = 0.7 + 0.13 * sin(1.9 * j);
    column[j] = used;
    for (int i = j ? j - 1 : 0; i <= j + 1 && i < N; i++) row[used++] = i;
  }
  column[N] = used;
  return (steif_problem){.name = "chain",
                         .n = N,
                         .t1 = 0.4,
                         .y0 = start,
                         .f = f,
                         .jac = jac,
                         .lower = 1,
                         .upper = 1,
                         .nnz = 3 * N};
}

static const char *const methods[] = {"be",        "bdf:p=3",     "dirk:alexander2",
                                      "gauss:s=2", "radau:s=3",   "radau:s=2",
                                      "exprb43",   "glm:irks,p=3"};
enum { METHODS = sizeof methods / sizeof *methods };

static int takes(steif_context *ctx, const char *method, const steif_problem *p)
{
  steif_method_info info;
  CHECK(steif_method_find(ctx, method, &info) == STEIF_OK);
  return (info.forms & (unsigned)steif_problem_form(ctx, p)) != 0;
}

/* Largest distance of the runs of p and q over all methods that take both. */
static double apart(steif_context *ctx, const steif_problem *p, const steif_problem *q,
                    N_Vector like)
{
  double most = 0;
  for (int m = 0; m < METHODS; m++) {
    steif_options o = steif_defaults();
    if (!takes(ctx, methods[m], q)) continue;
    o.h = 0.02;
    N_Vector a = law_run(ctx, p, methods[m], &o);
    o.like = like;
    N_Vector b = law_run(ctx, q, methods[m], &o);
    if (!a || !b) printf("\n  %s: %s", methods[m], steif_message(ctx));
    CU_ASSERT_FATAL(a && b);
    most = fmax(most, law_distance(a, b));
    N_VDestroy(a), N_VDestroy(b);
  }
  return most;
}

static void storages_agree(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = chain();
  for (int storage = STEIF_BAND; storage <= STEIF_KRYLOV; storage++) {
    steif_problem q = p;
    q.storage = (enum steif_storage)storage;
    CLOSE_FLOOR(apart(ctx, &p, &q, NULL), 0, storage == STEIF_KRYLOV ? 1e-9 : 1e-11, 1);
  }
  steif_context_free(&ctx);
}

/* With chosen steps sparse storage takes another iteration for collocation: the solutions agree to the
 * tolerance. */
static void storages_agree_with_chosen_steps(void)
{
  static const char *const chosen[] = {"radau:s=2", "radau:s=3", "radau:s=7", "gauss:s=4",
                                       "bdf",       "rodas4p2",  "dirk:hw43"};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 7; m++) {
    steif_problem q = chain();
    steif_options o = steif_defaults();
    o.rtol = o.atol = 1e-9;
    N_Vector a = law_run(ctx, &q, chosen[m], &o);
    for (int storage = STEIF_BAND; storage <= STEIF_SPARSE; storage++) {
      q.storage = (enum steif_storage)storage;
      N_Vector b = law_run(ctx, &q, chosen[m], &o);
      if (!a || !b) printf("\n  %s: %s", chosen[m], steif_message(ctx));
      CU_ASSERT_FATAL(a && b);
      CLOSE_FLOOR(law_distance(a, b), 0, 2e-9, 1);
      N_VDestroy(b);
    }
    N_VDestroy(a);
  }
  steif_context_free(&ctx);
}

static void differences_agree(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = chain();
  for (int storage = STEIF_DENSE; storage <= STEIF_SPARSE; storage++) {
    steif_problem q = p;
    q.storage = (enum steif_storage)storage, q.jac = NULL, q.pattern = &pattern;
    CLOSE_FLOOR(apart(ctx, &p, &q, NULL), 0, 1e-10, 1);
  }
  steif_context_free(&ctx);
}

/* A ManyVector of one serial part still has no array of its own: Krylov, through operations. */
static int f_many(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  return f(t, N_VGetSubvector_ManyVector(y, 0), N_VGetSubvector_ManyVector(r, 0), user);
}

static int start_many(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  sunrealtype *u = N_VGetArrayPointer(N_VGetSubvector_ManyVector(y, 0));
  (void)t, (void)yp, (void)user;
  for (int i = 0; i < N; i++) u[i] = start[i];
  return 0;
}

static void any_vector_serves(void)
{
  steif_context *ctx = steif_context_new(NULL);
  N_Vector part = N_VNew_Serial(N, steif_sundials(ctx));
  N_Vector many = N_VNew_ManyVector(1, &part, steif_sundials(ctx));
  steif_problem p = chain(), q = p;
  q.storage = STEIF_KRYLOV, q.f = f_many, q.start = start_many, q.y0 = NULL, q.jac = NULL;
  for (int m = 0; m < METHODS; m++) {
    steif_options o = steif_defaults();
    o.h = 0.02;
    N_Vector a = law_run(ctx, &p, methods[m], &o);
    o.like = many;
    N_Vector b = law_run(ctx, &q, methods[m], &o);
    if (!b) printf("\n  %s: %s", methods[m], steif_message(ctx));
    CU_ASSERT_FATAL(a && b);
    CLOSE_FLOOR(law_distance(a, N_VGetSubvector_ManyVector(b, 0)), 0, 1e-9, 1);
    N_VDestroy(a), N_VDestroy(b);
  }
  N_VDestroy(many), N_VDestroy(part);
  steif_context_free(&ctx);
}

/* OpenMP vectors have a host array, so every storage serves; sums run through their operations. */
static void openmp_vectors_serve(void)
{
#ifdef HAVE_NVECTOR_OPENMP
  steif_context *ctx = steif_context_new(NULL);
  N_Vector like = N_VNew_OpenMP(N, 2, steif_sundials(ctx));
  const steif_problem p = chain();
  for (int storage = STEIF_DENSE; storage <= STEIF_SPARSE; storage++) {
    steif_problem q = p;
    q.storage = (enum steif_storage)storage;
    CLOSE_FLOOR(apart(ctx, &p, &q, like), 0, 1e-11, 1);
  }
  N_VDestroy(like);
  steif_context_free(&ctx);
#endif
}

/* -- forms ----------------------------------------------------------------------------------- */

static int identity(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (int i = 0; i < N; i++) SM_ELEMENT_D(E, i, i) = 1;
  return 0;
}

static int residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const int code = f(t, y, r, user);
  N_VLinearSum(1, yp, -1, r, r);
  return code;
}

static int ida_jacobian(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r,
                        SUNMatrix J, void *user, N_Vector u, N_Vector v, N_Vector w)
{
  (void)yp;
  const int code = jac(t, y, r, J, user, u, v, w);
  SUNMatScaleAdd(-1, J, J);
  SUNMatZero(J);
  jac(t, y, r, J, user, u, v, w);
  for (int j = 0; j < N; j++)
    for (int i = 0; i < N; i++)
      SM_ELEMENT_D(J, i, j) = (i == j ? c : 0) - SM_ELEMENT_D(J, i, j);
  return code;
}

static void forms_agree(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = chain();
  sunrealtype slope[N];
  N_Vector y = N_VMake_Serial(N, start, steif_sundials(ctx));
  N_Vector yp = N_VMake_Serial(N, slope, steif_sundials(ctx));
  f(0, y, yp, NULL);
  steif_problem mass = p, implicit = p, differences;
  mass.E = identity;
  implicit.f = NULL, implicit.jac = NULL, implicit.F = residual, implicit.idajac = ida_jacobian;
  implicit.yp0 = slope;
  differences = implicit, differences.idajac = NULL;
  CLOSE_FLOOR(apart(ctx, &p, &mass, NULL), 0, 1e-11, 1);
  CLOSE_FLOOR(apart(ctx, &p, &implicit, NULL), 0, 1e-11, 1);
  CLOSE_FLOOR(apart(ctx, &p, &differences, NULL), 0, 1e-10, 1);
  N_VDestroy(y), N_VDestroy(yp);
  steif_context_free(&ctx);
}

static void missing_entries_are_added(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p = chain();
  static sunindextype less[N + 1], rows[3 * N];
  sunindextype used = 0;
  for (int j = 0; j < N; j++) {
    less[j] = used;
    for (sunindextype k = column[j]; k < column[j + 1]; k++)
      if (!(j == 6 && row[k] == 5)) rows[used++] = row[k];
  }
  less[N] = used;
  const steif_pattern thin = {less, rows};
  p.jac = NULL, p.storage = STEIF_SPARSE, p.pattern = &thin;
  const steif_problem whole = chain();
  CLOSE_FLOOR(apart(ctx, &whole, &p, NULL), 0, 1e-10, 1);
  p = chain(), p.jac = NULL, p.storage = STEIF_BAND, p.upper = 0;
  CHECK(!steif_solver_new(ctx, &p, "radau:s=2", NULL));
  CHECK(strstr(steif_message(ctx), "band") != NULL);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_law_backends[] = {
  {"storages agree", storages_agree},
  {"storages agree with chosen steps", storages_agree_with_chosen_steps},
  {"differences agree with given Jacobians", differences_agree},
  {"any vector serves", any_vector_serves},
  {"OpenMP vectors serve", openmp_vectors_serve},
  {"forms agree", forms_agree},
  {"missing entries join a pattern, and a band is refused", missing_entries_are_added},
  CU_TEST_INFO_NULL};
