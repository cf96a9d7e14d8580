/* cobb.c: beside methods, the solutions of (E + eps F) x' + F x = f from x(0-), which tend to the
 * distribution as eps goes to 0: its finite eigenvalues lambda become lambda / (1 - eps lambda), the
 * infinite ones -1/eps, and sE + F + eps sF = (1 + eps s) (s/(1 + eps s) E + F) has an inverse that
 * tends to that of sE + F on every test function, with order 1. J. D. Cobb, On the solutions of linear
 * differential equations with singular coefficients, J. Differential Equations 46 (1982).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "measure.h"
#include <math.h>
#include <string.h>

/* Of the difference between two quadratures. */
enum { DISTRUST = 4 };

bool stf_is_cobb(const char *method) { return !strcmp(method, "cobb"); }

/* E + eps F as a new matrix. */
static int perturbed(const stf_measure *w, sunrealtype eps, SUNMatrix *E)
{
  const steif_linear *l = &w->subject.linear;
  *E = SUNMatClone(l->F);
  STEIF_CHECK(*E, w->ctx, STEIF_NO_MEMORY, "no memory for E + eps F");
  STEIF_CHECK(!SUNMatCopy(l->F, *E) && !SUNMatScaleAdd(eps, *E, l->E), w->ctx,
              STEIF_UNSUPPORTED, "E + eps F takes matrices of one kind, dense or sparse");
  return STEIF_OK;
}

/* Where E + eps F is or behaves as if it were singular in double, nothing is known. */
static bool unknown(int code)
{
  return code == STEIF_NOT_FINITE || code == STEIF_SINGULAR || code == STEIF_NO_CONVERGENCE;
}

static int pair(stf_measure *w, const steif_linear *linear)
{
  stf_subject s;
  char how[160];
  sunrealtype accuracy = INFINITY;
  STEIF_TRY(stf_subject_open(w->ctx, NULL, linear, w->subject.problem.y0, &s));
  s.weight = w->subject.weight;
  s.sides.count = w->subject.sides.count, s.sides.breaks = w->subject.sides.breaks;
  const int code =
    s.index ? STEIF_SINGULAR : stf_subject_pair(&s, w->value, &accuracy, how, sizeof how);
  for (int m = 0; m < s.n; m++) {
    w->level[m] = code ? INFINITY : DISTRUST * accuracy;
    if (code) w->value[m] = NAN;
  }
  stf_subject_close(&s);
  return unknown(code) ? STEIF_OK : code;
}

int stf_cobb_run(stf_measure *w, sunrealtype eps)
{
  SUNMatrix E = NULL;
  const steif_linear *l = &w->subject.linear;
  STEIF_CHECK(l->E, w->ctx, STEIF_UNSUPPORTED,
              "E + eps F takes the matrices of a problem in dense or sparse storage");
  int code = perturbed(w, eps, &E);
  if (!code) code = pair(w, &(steif_linear){E, l->F, l->f, l->user});
  if (E) SUNMatDestroy(E);
  return code;
}
