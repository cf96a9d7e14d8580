/* planted_judge.c: is what an analysis certifies of a pencil its known structure and start.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "planted.h"
#include "linear_system.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* An error this many times the estimate is a wrong answer, beyond rounding of the known one. */
#define FAR_OFF 10
#define ROUNDING 1e-14

static SUNMatrix matrix(steif_context *ctx, int n, const sunrealtype *A, bool dense)
{
  SUNMatrix D = SUNDenseMatrix(n, n, steif_sundials(ctx));
  if (!D) return NULL;
  memcpy(SM_DATA_D(D), A, (size_t)n * (size_t)n * sizeof *A);
  if (dense) return D;
  SUNMatrix S = SUNSparseFromDenseMatrix(D, 0, CSC_MAT);
  SUNMatDestroy(D);
  return S;
}

static enum planted_verdict judge(const planted *p, const steif_structure *s)
{
  const bool right =
    p->singular ? !s->regular : s->regular && s->index == p->index && s->finite == p->finite;
  /* a regular pencil may be called singular to rounding, which is not certified */
  if (!s->certified) return p->singular && s->regular ? PLANTED_WRONG : PLANTED_OPEN;
  return right ? PLANTED_RIGHT : PLANTED_WRONG;
}

static sunrealtype length(int n, const sunrealtype *x)
{
  sunrealtype square = 0;
  for (int i = 0; i < n; i++) square += x[i] * x[i];
  return sqrt(square);
}

/* What the estimate is relative to. */
static sunrealtype measure(const planted *p)
{
  sunrealtype Ex0[PLANTED_MOST] = {0};
  const stf_sources s = {.n = p->n, .derivatives = -1, .Ex0 = Ex0};
  for (int j = 0; j < p->n; j++)
    for (int i = 0; i < p->n; i++) Ex0[i] += p->E[j * p->n + i] * p->before[j];
  return stf_sources_measure(&s, length(p->n, p->after), length(p->n * p->n, p->E), 0);
}

static enum planted_verdict judge_start(const planted *p, const steif_impulse *i,
                                        planted_outcome *out)
{
  sunrealtype d[PLANTED_MOST];
  for (int k = 0; k < p->n; k++) d[k] = i->x_plus[k] - p->after[k];
  if (!i->certified) return PLANTED_OPEN;
  out->off = p->start ? length(p->n, d) / measure(p) / (i->estimate + ROUNDING) : 0;
  return out->off <= FAR_OFF ? PLANTED_RIGHT : PLANTED_WRONG;
}

static int look(steif_context *ctx, SUNMatrix E, SUNMatrix F, const steif_analysis *by,
                const planted *p, steif_structure *s, planted_outcome *out)
{
  steif_impulse i;
  STEIF_TRY(steif_structure_find(ctx, E, F, by, s));
  out->structure = judge(p, s);
  out->start = PLANTED_OPEN;
  out->cancels = s->degree > p->finite;
  snprintf(out->message, sizeof out->message, "%s", s->message);
  if (!s->certified || !s->regular || p->singular) return STEIF_OK;
  STEIF_TRY(steif_impulse_find(ctx, E, F, p->before, 0, NULL, NULL, by, s, &i));
  out->start = judge_start(p, &i, out);
  steif_impulse_clear(ctx, &i);
  return STEIF_OK;
}

int planted_judge(steif_context *ctx, enum planted_kind kind, const planted *p,
                  planted_outcome *out)
{
  const bool dense = kind == PLANTED_DENSE;
  const steif_analysis by = {.algorithm = dense ? STEIF_AUTOMATIC : STEIF_CONTOUR};
  SUNMatrix E = matrix(ctx, p->n, p->E, dense), F = matrix(ctx, p->n, p->F, dense);
  steif_structure s = {0};
  *out = (planted_outcome){.off = 0};
  const int code = E && F ? look(ctx, E, F, &by, p, &s, out)
                          : STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for a pencil");
  steif_structure_clear(ctx, &s);
  if (E) SUNMatDestroy(E);
  if (F) SUNMatDestroy(F);
  return code;
}
