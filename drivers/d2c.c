/* d2c.c: the continuous system behind a zero-order hold.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matrix.h"
#include <stdlib.h>

static int tell(struct call *call, int n, int m, const double *A, const double *B)
{
  steif_report *r = steif_report_new(call->ctx);
  if (!r) return fail(call);
  steif_report_real(r, "dt", real_of(call, "--dt", 0));
  report_dense(r, "A", n, n, A);
  report_dense(r, "B", n, m, B);
  const int code = present(call, r);
  steif_report_free(&r);
  return code;
}

static int invert(struct call *call, const struct matrix *Ad, const struct matrix *Bd)
{
  const int n = (int)Ad->rows, m = (int)Bd->columns;
  const size_t square = (size_t)n * (size_t)n;
  double *A = malloc((square + (size_t)n * (size_t)m + 1) * sizeof *A);
  int code = EXIT_FAILED;
  if (!A)
    say(call, "no memory for matrices of order %d; take fewer states", n);
  else if (steif_d2c(call->ctx, n, m, Ad->x, Bd->x, real_of(call, "--dt", 0), A, A + square))
    code = fail(call);
  else
    code = tell(call, n, m, A, A + square);
  free(A);
  return code;
}

static int run(struct call *call)
{
  struct matrix Ad = {0}, Bd = {0};
  if (call->plot) return refuse(call, "d2c has no picture; leave --plot out");
  if (!given(call, "--dt"))
    return refuse(call, "--dt H, the step, is needed: steif d2c Ad.mtx Bd.mtx --dt 0.1");
  int code = matrix_square(call, call->word[0], "Ad of x(k+1) = Ad x(k) + Bd u(k)", &Ad);
  if (!code && call->words > 1) code = matrix_read(call, call->word[1], Ad.rows, 0, &Bd);
  if (!code) code = invert(call, &Ad, &Bd);
  free(Ad.x), free(Bd.x);
  return code;
}

static const struct option options[] = {{"--dt", POSITIVE, "H", "the step"},
                                        {NULL, FLAG, NULL, NULL}};

const struct verb verb_d2c = {"d2c",
                              "Find the continuous system behind a zero-order hold",
                              "Ad.mtx [Bd.mtx] --dt H",
                              1,
                              2,
                              options,
                              NULL,
                              run};
