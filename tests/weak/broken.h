/* broken.h: N x' + x = f of index n from 0, N the Jordan block, f as text with breaks.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef BROKEN_H
#define BROKEN_H

#include "suite.h"
#include <steif/forcing.h>
#include <steif/weak.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { BROKEN_MOST = 4 };

typedef struct broken_system {
  steif_context *ctx;
  steif_linear linear;
  steif_function *function;
  sunrealtype x0[BROKEN_MOST], breaks[BROKEN_MOST];
  size_t count;
} broken_system;

static inline void broken_open(broken_system *s, int n, const char *f)
{
  *s = (broken_system){.ctx = steif_context_new(NULL)};
  s->linear.E = SUNDenseMatrix(n, n, steif_sundials(s->ctx));
  s->linear.F = SUNDenseMatrix(n, n, steif_sundials(s->ctx));
  for (int i = 0; i < n; i++) SM_ELEMENT_D(s->linear.F, i, i) = 1;
  for (int i = 0; i + 1 < n; i++) SM_ELEMENT_D(s->linear.E, i, i + 1) = 1;
  s->function = steif_function_parse(s->ctx, f, n, NULL);
  CU_ASSERT_FATAL(s->function != NULL);
  s->linear.f = steif_function_value, s->linear.user = s->function;
  s->count = steif_function_breaks(s->function, 0, 1, BROKEN_MOST, s->breaks);
}

static inline void broken_close(broken_system *s)
{
  SUNMatDestroy(s->linear.E), SUNMatDestroy(s->linear.F);
  steif_function_free(&s->function);
  steif_context_free(&s->ctx);
}

#endif
