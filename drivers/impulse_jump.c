/* impulse_jump.c: y(t+) and impulses of a nonlinear DAE of the collection.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse.h"

static void fill(steif_report *r, const steif_jump *j, size_t n)
{
  const size_t count = (size_t)j->count;
  steif_report_whole(r, "index", j->index);
  steif_report_list(r, "x_plus", n, j->y);
  steif_report_matrix(r, "impulses", count, n, j->c);
  steif_report_truth(r, "unique", j->unique);
  if (!j->unique) {
    steif_report_list(r, "x_plus_left", n, j->before);
    steif_report_matrix(r, "impulses_left", count, n, j->before_c);
  }
  steif_report_real(r, "spread", j->spread);
  steif_report_text(r, "message", j->message);
}

static int tell(struct call *call, const steif_jump *j, size_t n)
{
  steif_report *r = steif_report_new(call->ctx);
  if (!r) return fail(call);
  fill(r, j, n);
  const int code = present(call, r);
  steif_report_free(&r);
  if (!j->unique) say(call, "%s", j->message);
  return code ? code : j->unique || given(call, "--stages") ? EXIT_OK : EXIT_UNCERTIFIED;
}

static int run(struct call *call, const steif_problem *p)
{
  struct linear l = {.n = p->n};
  steif_jump jump = {0};
  int code = linear_read_x0(call, &l);
  const steif_inquiry q = {.y = l.x0 ? l.x0 : p->y0, .t = real_of(call, "--t0", p->t0)};
  const steif_jump_request request = {.rtol = real_of(call, "--rtol", 0),
                                      .restitution = real_of(call, "--restitution", 0),
                                      .stages = given(call, "--stages")};
  if (!code && steif_jump_find(call->ctx, p, &q, &request, &jump)) code = fail(call);
  if (!code) code = tell(call, &jump, (size_t)p->n);
  steif_jump_clear(&jump);
  linear_close(call, &l);
  return code;
}

bool impulse_is_nonlinear(struct call *call, steif_problem *p)
{
  if (linear_is_file(call->word[0]) || steif_problem_find(call->ctx, call->word[0], p))
    return false;
  const int form = steif_problem_form(call->ctx, p);
  if (form && form != STEIF_DESCRIPTOR) return true;
  steif_problem_clear(call->ctx, p);
  return false;
}

int impulse_jump(struct call *call, steif_problem *p)
{
  static const char *const linear[] = {
    "--method", "--t1",     "--h",          "--forcing",   "--f",      "--input",      "--vs",
    "--plot",   "--radius", "--projectors", "--algorithm", "--points", "--state-space"};
  int code = EXIT_OK;
  for (size_t k = 0; !code && k < sizeof linear / sizeof *linear; k++)
    if (given(call, linear[k]))
      code = refuse(call, "%s is for systems E x' + F x = f; leave it out with the problem %s",
                    linear[k], p->name);
  if (!code && call->words > 1)
    code =
      refuse(call, "\"%s\" is one word too many after the problem %s", call->word[1], p->name);
  if (!code) code = run(call, p);
  steif_problem_clear(call->ctx, p);
  return code;
}
