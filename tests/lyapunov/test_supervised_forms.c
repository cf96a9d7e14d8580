/* test_supervised_forms.c: the supervisor where M y' = f(t, y) and F(t, y, y') = 0, of index 1: the
 * problems of test_supervisor.c with an algebraic equation more.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/collection.h>
#include <steif/supervisor.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const double pi = 3.14159265358979323846;

/* -- u' = A(t) u of Steyer and Van Vleck with v = 2 u_1 - u_2 ----------------------------- */

static int wave(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const steif_problem *p = user;
  double *x = N_VGetArrayPointer(y), *out = N_VGetArrayPointer(r);
  N_Vector u = N_VMake_Serial(2, x, y->sunctx), du = N_VMake_Serial(2, out, y->sunctx);
  const int code = p->f(t, u, du, p->user);
  out[2] = 2 * x[0] - x[1] - x[2];
  N_VDestroy(u), N_VDestroy(du);
  return code;
}

static int wave_residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const int code = wave(t, y, r, user);
  for (int i = 0; i < 2; i++) NV_Ith_S(r, i) = NV_Ith_S(yp, i) - NV_Ith_S(r, i);
  return code;
}

static int two(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(M, 0, 0) = SM_ELEMENT_D(M, 1, 1) = 1;
  return 0;
}

/* Errors are controlled and the numbers grow; supervised they decay, in both forms. */
static void hard_runs_of_index_1_decay(void)
{
  static const char *const methods[] = {"be",           "bdf:p=2",   "radau:s=2",
                                        "glm:irks,p=2", "dirk:hw43", "glm:nord22"};
  static const sunrealtype y0[] = {1, 0, 2};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  int grown = 0;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "steyer", &p) == STEIF_OK);
  steif_problem form[2] = {{.name = "mass", .f = wave, .E = two},
                           {.name = "implicit", .F = wave_residual}};
  for (int k = 0; k < 2; k++) {
    form[k].n = 3, form[k].t1 = 200, form[k].y0 = y0, form[k].user = &p, form[k].dae_index = 1;
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
      steif_supervised f = {.mu = NAN}, alone = {.mu = NAN};
      double y[3];
      const int strict =
        !strncmp(methods[i], "glm", 3); /* its steps are a tenth of the others' */
      const steif_options o = {.rtol = strict ? 0.9 : 0.1, .h0 = 1e-3};
      const steif_supervision how = {.rate = 0.035, .window = 4 * pi},
                              only = {.rule = STEIF_SUPERVISE_NONE, .window = 4 * pi};
      CHECK(steif_supervise(ctx, &form[k], methods[i], &o, &only, NULL, &alone) == STEIF_OK);
      const int code = steif_supervise(ctx, &form[k], methods[i], &o, &how, y, &f);
      if (code) printf("\n  %s, %s: %s", form[k].name, methods[i], steif_message(ctx));
      CHECK(code == STEIF_OK && f.direct && f.mu < -0.02);
      CHECK(alone.mu < 0 || f.redone > 0);
      CLOSE_FLOOR(y[2], 2 * y[0] - y[1], 1e-6, fabs(y[0]) + fabs(y[1]));
      grown += alone.mu > 0;
    }
  }
  if (grown < 6) printf("\n  %d grow", grown);
  CHECK(grown >= 6);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* -- u' = -u + 12 v - q u + 1, v' = -6 v - q v, 0 = q - u^2 - v^2 -------------------------- */

static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const double u = NV_Ith_S(y, 0), v = NV_Ith_S(y, 1), q = NV_Ith_S(y, 2);
  (void)t, (void)user;
  NV_Ith_S(r, 0) = -u + 12 * v - q * u + 1;
  NV_Ith_S(r, 1) = -6 * v - q * v;
  NV_Ith_S(r, 2) = q - u * u - v * v;
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const double u = NV_Ith_S(y, 0), v = NV_Ith_S(y, 1), q = NV_Ith_S(y, 2);
  (void)t, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = -1 - q, SM_ELEMENT_D(J, 0, 1) = 12, SM_ELEMENT_D(J, 0, 2) = -u;
  SM_ELEMENT_D(J, 1, 1) = -6 - q, SM_ELEMENT_D(J, 1, 2) = -v;
  SM_ELEMENT_D(J, 2, 0) = -2 * u, SM_ELEMENT_D(J, 2, 1) = -2 * v, SM_ELEMENT_D(J, 2, 2) = 1;
  return 0;
}

/* (1 + u^2) u' enters: dF/dy' depends on y, and F_y on y'. */
static int residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const double u = NV_Ith_S(y, 0), s = 1 + u * u;
  const int code = f(t, y, r, user);
  NV_Ith_S(r, 0) = s * (NV_Ith_S(yp, 0) - NV_Ith_S(r, 0));
  NV_Ith_S(r, 1) = NV_Ith_S(yp, 1) - NV_Ith_S(r, 1);
  return code;
}

static int idajac(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r,
                  SUNMatrix M, void *user, N_Vector a, N_Vector b, N_Vector d)
{
  const double u = NV_Ith_S(y, 0), s = 1 + u * u, off = NV_Ith_S(r, 0) / s;
  (void)yp;
  jac(t, y, r, M, user, a, b, d);
  for (int j = 0; j < 3; j++) {
    SM_ELEMENT_D(M, 0, j) *= -s, SM_ELEMENT_D(M, 1, j) *= -1;
  }
  SM_ELEMENT_D(M, 0, 0) += 2 * u * off + c * s, SM_ELEMENT_D(M, 1, 1) += c;
  return 0;
}

/* At rest u + u^3 = 1, and the slowest rate is 1 + 3 u^2. y0, as w, is not consistent. */
static void nonlinear_problems_of_index_1_are_followed(void)
{
  static const sunrealtype y0[] = {0.7, -0.3, 0.58};
  static const char *const methods[] = {"bdf", "radau:s=3", "dirk:hw43", "glm:irks,p=3"};
  const steif_problem form[] = {
    {.name = "mass", .n = 3, .t1 = 40, .y0 = y0, .f = f, .jac = jac, .E = two, .dae_index = 1},
    {.name = "implicit",
     .n = 3,
     .t1 = 40,
     .y0 = y0,
     .F = residual,
     .idajac = idajac,
     .dae_index = 1}};
  const double u = 0.6823278038280193;
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 2; k++)
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
      steif_supervised facts = {.mu = NAN};
      double y[3] = {NAN, NAN, NAN};
      const steif_options o = {.rtol = 1e-7};
      const steif_supervision how = {.rate = 0.25, .window = 2};
      const int code = steif_supervise(ctx, &form[k], methods[i], &o, &how, y, &facts);
      if (code) printf("\n  %s, %s: %s", form[k].name, methods[i], steif_message(ctx));
      CHECK(code == STEIF_OK && !facts.direct && facts.redone == 0 && facts.windows == 20);
      CLOSE(y[0], u, 1e-5);
      CLOSE(y[2], u * u, 1e-5);
      CLOSE(facts.mu, -(1 + 3 * u * u), 1e-4);
    }
  steif_context_free(&ctx);
}

static void what_has_no_linearisation_is_rejected(void)
{
  static const struct {
    const char *problem, *words;
  } row[] = {{"pendulum3", "index 3"}, {"caraxis", "index 3"}, {"jordan", "form descriptor"}};
  static const sunrealtype y0[] = {0.7, -0.3, 0.58};
  const steif_problem bare = {
    .name = "bare", .n = 3, .t1 = 40, .y0 = y0, .F = residual, .dae_index = 1};
  const steif_options o = {.rtol = 1e-4};
  const steif_supervision how = {.rate = 0.25, .window = 0.5};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    steif_problem p;
    CU_ASSERT_FATAL(steif_problem_find(ctx, row[i].problem, &p) == STEIF_OK);
    CHECK(steif_supervise(ctx, &p, "radau:s=3", &o, &how, NULL, NULL) == STEIF_UNSUPPORTED);
    if (!strstr(steif_message(ctx), row[i].words)) printf("\n  %s", steif_message(ctx));
    CHECK(strstr(steif_message(ctx), row[i].words) != NULL);
    steif_problem_clear(ctx, &p);
  }
  CHECK(steif_supervise(ctx, &bare, "bdf", &o, &how, NULL, NULL) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), ".idajac") != NULL);
  steif_context_free(&ctx);
}

static void short_memory_is_told(void)
{
  static const sunrealtype y0[] = {0.7, -0.3, 0.58};
  const steif_problem p = {
    .name = "mass", .n = 3, .t1 = 4, .y0 = y0, .f = f, .jac = jac, .E = two};
  const steif_options o = {.rtol = 1e-3};
  const steif_supervision how = {.rate = 0.25, .window = 4};
  int code = STEIF_NO_MEMORY;
  for (long k = 1; code != STEIF_OK && k < 1000; k++) {
    failing mine = {0};
    const steif_setup setup = failing_setup(&mine);
    steif_context *ctx = steif_context_new(&setup);
    mine.refuse_at = mine.served + k;
    code = steif_supervise(ctx, &p, "bdf", &o, &how, NULL, NULL);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    steif_context_free(&ctx);
    CHECK(mine.alive == 0);
  }
  CHECK(code == STEIF_OK);
}

CU_TestInfo tests_of_supervised_forms[] = {
  {"hard runs of index 1 decay", hard_runs_of_index_1_decay},
  {"nonlinear problems of index 1 are followed", nonlinear_problems_of_index_1_are_followed},
  {"what has no linearisation is rejected", what_has_no_linearisation_is_rejected},
  {"short memory is told", short_memory_is_told},
  CU_TEST_INFO_NULL};
