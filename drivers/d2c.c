/* d2c.c: the continuous system whose samples by a zero-order hold are given.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matrix.h"
#include "members.h"
#include <stdlib.h>

struct answer {
  int n, m;
  double *A, *B;
};

static void fill(steif_report *r, const struct call *call, const void *result)
{
  const struct answer *a = result;
  steif_report_real(r, "dt", real_of(call, "--dt"));
  report_dense(r, "A", a->n, a->n, a->A);
  report_dense(r, "B", a->n, a->m, a->B);
}

static int invert(struct call *call, const struct matrix *Ad, const struct matrix *Bd)
{
  struct answer a = {.n = (int)Ad->rows, .m = (int)Bd->columns};
  const size_t square = (size_t)a.n * (size_t)a.n;
  a.A = malloc((square + (size_t)a.n * (size_t)a.m + 1) * sizeof *a.A);
  if (!a.A) return no_memory(call, "the matrices", "take fewer states");
  a.B = a.A + square;
  const int code = steif_d2c(call->ctx, a.n, a.m, Ad->x, Bd->x, real_of(call, "--dt"), a.A, a.B)
                     ? fail(call)
                     : present_result(call, fill, &a);
  free(a.A);
  return code;
}

static int run(struct call *call)
{
  struct matrix Ad = {0}, Bd = {0};
  int code = matrix_square(call, call->word[0], "Ad of x(k+1) = Ad x(k) + Bd u(k)", &Ad);
  if (!code && call->words > 1) code = matrix_read(call, call->word[1], Ad.rows, 0, &Bd);
  if (!code) code = invert(call, &Ad, &Bd);
  free(Ad.x);
  free(Bd.x);
  return code;
}

static const struct option options[] = {{"--dt", POSITIVE, "H", "step of the grid", NULL},
                                        OPTIONS_END};
static const struct rule rules[] = {{"--dt", REQUIRED, NULL}, RULES_END};

const struct verb verb_d2c = {
  .name = "d2c",
  .about = "Find x' = A x + B u from its discretisation by a zero-order hold",
  .usage = "Ad.mtx [Bd.mtx] --dt H",
  .least = 1,
  .most = 2,
  .option = options,
  .rule = rules,
  .matrices = true,
  .run = run};
