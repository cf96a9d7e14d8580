/* fixture.c: models from texts.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <math.h>
#include <steif/sensitivity.h>

static int open_path(fixture *s)
{
  const int code = steif_problem_find(s->ctx, s->path, &s->p);
  return code;
}

int fixture_text(fixture *s, const char *text, const char *rest)
{
  *s = (fixture){.ctx = steif_context_new(NULL)};
  CU_ASSERT_FATAL(folder_make(s->folder, sizeof s->folder) != NULL);
  snprintf(s->path, sizeof s->path, "%s/m.steif", s->folder);
  FILE *file = fopen(s->path, "w");
  CU_ASSERT_FATAL(file != NULL);
  fputs(text, file);
  fclose(file);
  const size_t length = strlen(s->path);
  snprintf(s->path + length, sizeof s->path - length, "%s", rest);
  const int code = open_path(s);
  s->path[length] = 0;
  return code;
}

int fixture_example(fixture *s, const char *spec)
{
  *s = (fixture){.ctx = steif_context_new(NULL)};
  snprintf(s->path, sizeof s->path, "%s/%s", EXAMPLES, spec);
  const int code = open_path(s);
  if (code) printf("\n  %s", steif_message(s->ctx));
  return code;
}

void fixture_close(fixture *s)
{
  steif_problem_clear(s->ctx, &s->p);
  steif_context_free(&s->ctx);
  if (!*s->folder) return;
  unlink(s->path);
  rmdir(s->folder);
}

int fixture_run(fixture *s, const char *method, double rtol, double *y)
{
  steif_options o = steif_defaults();
  o.rtol = rtol;
  steif_solver *solver = steif_solver_new(s->ctx, &s->p, method, &o);
  const int code = solver ? steif_solve_to(solver, s->p.t1) : steif_status(s->ctx);
  if (code && code != STEIF_EVENT) printf("\n  %s: %s", method, steif_message(s->ctx));
  for (int i = 0; solver && i < s->p.n; i++) y[i] = NV_Ith_S(steif_solution(solver), i);
  steif_solver_free(&solver);
  return code;
}

void fixture_reaches(const char *text, double expected, double allowed)
{
  static const char *const methods[] = {"radau:s=3", "dopri87", "bdf", "auto"};
  fixture s;
  double y[8];
  const int code = fixture_text(&s, text, "");
  if (code) printf("\n  %s", steif_message(s.ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  for (int k = 0; k < 4; k++)
    for (int again = 0; again < 2; again++) { /* a run leaves nothing for the next */
      CHECK(fixture_run(&s, methods[k], 1e-9, y) == STEIF_OK);
      CLOSE_FLOOR(y[0], expected, allowed, 1);
    }
  fixture_close(&s);
}

bool fixture_derivatives(fixture *s, const char *method, enum steif_storage storage,
                         double rtol, int count, sunrealtype *S)
{
  steif_options o = steif_defaults();
  o.rtol = rtol, o.sensitivities = 1, o.force_storage = 1, o.storage = storage;
  steif_solver *solver = steif_solver_new(s->ctx, &s->p, method, &o);
  bool well = solver && steif_solve_to(solver, s->p.t1) == STEIF_OK;
  N_Vector dy = N_VNew_Serial(s->p.n, steif_sundials(s->ctx));
  for (int k = 0; well && k < count; k++) {
    well = steif_sensitivity_output(solver, s->p.t1, k, dy) == STEIF_OK;
    S[k] = NV_Ith_S(dy, s->p.n - 1);
  }
  if (!well) printf("\n  %s: %s", method, steif_message(s->ctx));
  N_VDestroy(dy);
  steif_solver_free(&solver);
  return well;
}

void fixture_closely(const char *method, const sunrealtype *S, const sunrealtype *exact,
                     int count, double error)
{
  for (int k = 0; k < count; k++) {
    const bool close = fabs(S[k] - exact[k]) <= error * fabs(exact[k]);
    if (!close) printf("\n  %s, parameter %d: %.12g, not %.12g", method, k + 1, S[k], exact[k]);
    CHECK(close);
  }
}
