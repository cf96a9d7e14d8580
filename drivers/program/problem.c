/* problem.c: a problem of the collection by a word of a call, and a point of its solution.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
#include <nvector/nvector_serial.h>

int with_problem(struct call *call, int (*work)(struct call *call, const steif_problem *p))
{
  steif_problem p;
  if (steif_problem_find(call->ctx, call->word[0], &p) != STEIF_OK) return fail(call);
  const int code = work(call, &p);
  steif_problem_clear(call->ctx, &p);
  return code;
}

static int exact(struct call *call, const steif_problem *p, double t, struct point *q)
{
  q->y = N_VNew_Serial(p->n, steif_sundials(call->ctx));
  q->yp = N_VNew_Serial(p->n, steif_sundials(call->ctx));
  if (!q->y || !q->yp) return no_memory(call, "the solution", "give the process more");
  if (p->exact(t, q->y, q->yp, p->user)) {
    say(call, "the exact solution of '%s' is not known at t = %g [STEIF_UNSUPPORTED]", p->name,
        t);
    return EXIT_FAILED;
  }
  q->at.y = N_VGetArrayPointer(q->y);
  q->at.yp = N_VGetArrayPointer(q->yp);
  return EXIT_OK;
}

static int computed(struct call *call, const steif_problem *p, double t, struct point *q)
{
  steif_options o = steif_defaults();
  o.rtol = 1e-8;
  o.t1 = t;
  q->solver = steif_solver_new(call->ctx, p, "radau:s=3", &o);
  if (!q->solver || steif_solve_to(q->solver, t) != STEIF_OK) return fail(call);
  q->at.y = N_VGetArrayPointer(steif_solution(q->solver));
  return EXIT_OK;
}

int point_open(struct call *call, const steif_problem *p, double t, struct point *q)
{
  *q = (struct point){.at = {.t = t}};
  return p->exact ? exact(call, p, t, q) : computed(call, p, t, q);
}

void point_close(struct point *q)
{
  if (q->y) N_VDestroy(q->y);
  if (q->yp) N_VDestroy(q->yp);
  steif_solver_free(&q->solver);
}
