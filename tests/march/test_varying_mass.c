/* M y' = f(t, y) with an M that is not constant: refused by every method, never taken as that of the start; as
 * F(t, y, y') = 0 it is solved.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"
#include <stdbool.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static const char *const methods[] = {"auto",   "radau:s=3", "gauss:s=2", "dirk:hw43",
                                      "rodas4", "rodas5p",   "bdf",       "ida",
                                      "arkode", "bdf:p=2",   "glm:am,p=2"};
enum { METHODS = sizeof methods / sizeof *methods };

enum kind { CONSTANT, ROUNDED, OF_TIME, LATE, OF_STATE };

/* diag(a, 1 + a) with a = 2 but for: rounding errors; 1 + t; 3 after t = 1.5; 1 + y1^2. */
static double entry(const enum kind *kind, sunrealtype t, N_Vector y)
{
  const double x = NV_Ith_S(y, 0);
  switch (*kind) {
  case ROUNDED: return 2 * (sin(t) * sin(t) + cos(t) * cos(t));
  case OF_TIME: return 1 + t;
  case LATE: return t > 1.5 ? 3 : 2;
  case OF_STATE: return 1 + x * x;
  default: return 2;
  }
}

static int M(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  const double a = entry(user, t, y);
  (void)yp;
  switch (SUNMatGetID(E)) {
  case SUNMATRIX_DENSE: SM_ELEMENT_D(E, 0, 0) = a, SM_ELEMENT_D(E, 1, 1) = 1 + a; break;
  case SUNMATRIX_BAND: SM_ELEMENT_B(E, 0, 0) = a, SM_ELEMENT_B(E, 1, 1) = 1 + a; break;
  default:
    for (int i = 0; i < 2; i++) {
      SM_INDEXPTRS_S(E)[i] = SM_INDEXVALS_S(E)[i] = i;
      SM_DATA_S(E)[i] = i + a;
    }
    SM_INDEXPTRS_S(E)[2] = 2;
  }
  return 0;
}

static int times(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  const double a = entry(user, t, y);
  (void)yp;
  NV_Ith_S(out, 0) = a * NV_Ith_S(x, 0), NV_Ith_S(out, 1) = (1 + a) * NV_Ith_S(x, 1);
  return 0;
}

/* M y' = f = -M (y1 / t, y2): y = (1 / t, exp(1 - t)) from t = 1, y = (1, 1). */
static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const double a = entry(user, t, y);
  NV_Ith_S(out, 0) = -a * NV_Ith_S(y, 0) / t, NV_Ith_S(out, 1) = -(1 + a) * NV_Ith_S(y, 1);
  return 0;
}

static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  f(t, y, r, user);
  const double a = entry(user, t, y);
  NV_Ith_S(r, 0) = a * NV_Ith_S(yp, 0) - NV_Ith_S(r, 0);
  NV_Ith_S(r, 1) = (1 + a) * NV_Ith_S(yp, 1) - NV_Ith_S(r, 1);
  return 0;
}

static const double start[] = {1, 1}, slopes[] = {-1, -1};
static const sunindextype columns[] = {0, 1, 2}, rows[] = {0, 1};
static const steif_pattern diagonal = {columns, rows};

static steif_problem problem(enum kind *kind, enum steif_storage storage)
{
  steif_problem p = {.name = "heavy",
                     .n = 2,
                     .t0 = 1,
                     .t1 = 2,
                     .y0 = start,
                     .f = f,
                     .pattern = &diagonal,
                     .nnz_E = 2,
                     .storage = storage,
                     .user = kind};
  if (storage == STEIF_KRYLOV)
    p.Ev = times;
  else
    p.E = M;
  return p;
}

static void refused(enum kind kind, enum steif_storage storage, const char *method,
                    const char *words)
{
  const steif_problem p = problem(&kind, storage);
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.h = strstr(method, "p=2") ? 0.125 : 0;
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  const bool good = !s && steif_status(ctx) == STEIF_UNSUPPORTED &&
                    strstr(steif_message(ctx), words) && strstr(steif_message(ctx), method);
  if (!good) printf("\n  %s, storage %d: %s", method, storage, steif_message(ctx));
  CHECK(good);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

static void an_M_that_varies_is_refused_by_every_method(void)
{
  for (int m = 0; m < METHODS; m++) {
    refused(OF_TIME, STEIF_DENSE, methods[m], "(entry of y1 in e1) of problem 'heavy'");
    refused(LATE, STEIF_DENSE, methods[m], "is 2 at the start, t = 1, and 3 at t = 2");
    refused(OF_STATE, STEIF_DENSE, methods[m], "for another state");
  }
}

static void so_it_is_in_every_storage(void)
{
  for (int m = 0; m < 2; m++) {
    refused(OF_TIME, STEIF_BAND, methods[m], "state E y' - f(t, y) as .F with .E as it is");
    refused(OF_STATE, STEIF_SPARSE, methods[m], "(entry of y1 in e1)");
  }
  refused(OF_TIME, STEIF_KRYLOV, "radau:s=3", "in size at the start, t = 1");
  refused(OF_STATE, STEIF_KRYLOV, "bdf", "for another state");
}

static double error_of(const steif_problem *p, const char *method)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.rtol = 1e-7, o.atol = 1e-9;
  steif_solver *s = steif_solver_new(ctx, p, method, &o);
  double error = INFINITY;
  if (s && steif_solve_to(s, 2) == STEIF_OK)
    error = fmax(fabs(NV_Ith_S(steif_solution(s), 0) - 0.5),
                 fabs(NV_Ith_S(steif_solution(s), 1) - exp(-1)));
  else
    printf("\n  %s: %s", method, steif_message(ctx));
  steif_solver_free(&s);
  steif_context_free(&ctx);
  return error;
}

static void a_constant_M_is_not_taken_for_one_that_varies(void)
{
  static const enum steif_storage storages[] = {STEIF_DENSE, STEIF_BAND, STEIF_SPARSE,
                                                STEIF_KRYLOV};
  for (enum kind kind = CONSTANT; kind <= ROUNDED; kind++)
    for (int k = 0; k < 4; k++) {
      const steif_problem p = problem(&kind, storages[k]);
      CHECK(error_of(&p, "radau:s=3") < 1e-6);
    }
}

static void what_the_sentence_advises_solves_it(void)
{
  static const char *const advised[] = {"auto", "radau:s=3", "bdf", "dirk:hw43", "ida"};
  for (enum kind kind = OF_TIME; kind <= OF_STATE; kind++)
    for (int m = 0; m < 5; m++) {
      steif_problem p = problem(&kind, STEIF_DENSE);
      p.f = NULL, p.F = F, p.yp0 = slopes;
      CHECK(error_of(&p, advised[m]) < 1e-5);
    }
}

CU_TestInfo tests_of_varying_mass[] = {
  {"an M that varies is refused by every method", an_M_that_varies_is_refused_by_every_method},
  {"so it is in every storage", so_it_is_in_every_storage},
  {"a constant M is not taken for one that varies",
   a_constant_M_is_not_taken_for_one_that_varies},
  {"what the sentence advises solves it", what_the_sentence_advises_solves_it},
  CU_TEST_INFO_NULL};
