/* fixture.h: a problem lowered to a system, with the vectors the tests of this room need.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef FIXTURE_H
#define FIXTURE_H

#include "problem.h"
#include "suite.h"
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

typedef struct fixture {
  steif_context *ctx;
  stf_pool *pool;
  N_Vector y, yp, r;
  stf_system system;
} fixture;

/* Start values from the problem; the code of opening. */
static inline int fixture_open(fixture *s, const steif_problem *p, enum steif_storage storage)
{
  *s = (fixture){.ctx = steif_context_new(NULL)};
  s->pool = stf_pool_new(s->ctx);
  s->y = N_VNew_Serial(p->n, steif_sundials(s->ctx));
  s->yp = N_VClone(s->y), s->r = N_VClone(s->y);
  N_VConst(0, s->yp), N_VConst(0, s->r);
  const int form = steif_problem_form(s->ctx, p);
  if (!form) return steif_status(s->ctx);
  stf_space space;
  bool known;
  stf_space_open(&space, s->y);
  STEIF_TRY(stf_system_start(s->ctx, p, form, &space, s->y, s->yp, &known));
  return stf_system_open(s->pool, s->ctx, p, form, storage, 1, NULL, s->y, s->yp, &s->system);
}

static inline void fixture_close(fixture *s)
{
  stf_pool_free(&s->pool);
  N_VDestroy(s->y), N_VDestroy(s->yp), N_VDestroy(s->r);
  steif_context_free(&s->ctx);
}

/* The problem is refused on opening with this code and these words. */
static inline void fixture_refused(const steif_problem *p, enum steif_storage storage, int code,
                                   const char *words)
{
  fixture s;
  const int found = fixture_open(&s, p, storage);
  const int good = found == code && strstr(steif_message(s.ctx), words);
  if (!good) printf("\n  code %d: %s", found, steif_message(s.ctx));
  CHECK(good);
  fixture_close(&s);
}

/* M_ij of any storage. */
static inline double fixture_element(SUNMatrix M, sunindextype i, sunindextype j)
{
  if (SUNMatGetID(M) == SUNMATRIX_DENSE) return SM_ELEMENT_D(M, i, j);
  if (SUNMatGetID(M) == SUNMATRIX_BAND)
    return j - i <= SM_UBAND_B(M) && i - j <= SM_LBAND_B(M) ? SM_ELEMENT_B(M, i, j) : 0;
  for (sunindextype k = SM_INDEXPTRS_S(M)[j]; k < SM_INDEXPTRS_S(M)[j + 1]; k++)
    if (SM_INDEXVALS_S(M)[k] == i) return SM_DATA_S(M)[k];
  return 0;
}

#endif
