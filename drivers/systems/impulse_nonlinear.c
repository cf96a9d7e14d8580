/* impulse_nonlinear.c: y(t+) and impulses of a nonlinear DAE of the collection.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "attributes.h"
#include "impulse.h"
#include <stdlib.h>
#include <string.h>

enum { NAME_ROOM = 128 };

struct answer {
  const steif_jump *jump;
  size_t n;
};

static void fill(steif_report *r, const struct call *call, const void *result)
{
  const struct answer *a = result;
  const steif_jump *j = a->jump;
  const size_t n = a->n, count = (size_t)j->count;
  (void)call;
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
  const int code = present_result(call, fill, &(struct answer){j, n});
  const bool decided = j->unique || given(call, "--stages");
  if (!j->unique) say(call, "%s%s", j->message, decided ? "" : " [STEIF_NOT_CERTIFIED]");
  return code ? code : decided ? EXIT_OK : EXIT_UNCERTIFIED;
}

static int run(struct call *call, const steif_problem *p)
{
  struct descriptor l = {.n = p->n};
  steif_jump jump = {0};
  int code = descriptor_read_x0(call, &l);
  const steif_point q = {.y = l.x0 ? l.x0 : p->y0, .t = real_or(call, "--t0", p->t0)};
  const steif_jump_request request = {.rtol = real_of(call, "--rtol"),
                                      .restitution = real_of(call, "--restitution"),
                                      .stages = given(call, "--stages")};
  if (!code && steif_jump_find(call->ctx, p, &q, &request, &jump)) code = fail(call);
  if (!code) code = tell(call, &jump, (size_t)p->n);
  steif_jump_clear(&jump);
  descriptor_close(call, &l);
  return code;
}

bool impulse_is_nonlinear(struct call *call, steif_problem *p)
{
  if (descriptor_is_file(call->word[0]) || steif_problem_find(call->ctx, call->word[0], p))
    return false;
  const int form = steif_problem_form(call->ctx, p);
  return form && form != STEIF_DESCRIPTOR;
}

/* --slopes has no system to go by; a name that is none is told first. */
static int no_slopes(struct call *call, const steif_problem *p)
{
  char name[NAME_ROOM];
  for (const char *at = word_of(call, "--slopes"); *at;) {
    const size_t length = strcspn(at, ",");
    int wrong;
    snprintf(name, sizeof name, "%.*s", (int)length, at);
    if (!strchr(name, ':') && parameter_of(call, p, name, &wrong) < 0) return wrong;
    at += length + (at[length] == ',');
  }
  return bad_usage(
    call,
    "--slopes is for systems E x' + F x = f, and %s is of the form %s: say 'form "
    "descriptor' in a model that is linear, or take 'steif sensitivity', or leave "
    "--slopes out",
    p->name, steif_form_name(steif_problem_form(call->ctx, p)));
}

int impulse_nonlinear(struct call *call, steif_problem *p)
{
  static const char *const linear[] = {
    "--method", "--t1",     "--h",          "--forcing",   "--f",      "--input",      "--vs",
    "--plot",   "--radius", "--projectors", "--algorithm", "--points", "--state-space"};
  int code = EXIT_OK;
  for (size_t k = 0; !code && k < sizeof linear / sizeof *linear; k++)
    if (given(call, linear[k]))
      code =
        bad_usage(call, "%s is for systems E x' + F x = f; leave it out with the problem %s",
                  linear[k], p->name);
  if (!code && given(call, "--slopes")) code = no_slopes(call, p);
  if (!code && call->words > 1)
    code = bad_usage(call, "\"%s\" is one word too many after the problem %s", call->word[1],
                     p->name);
  if (!code) code = run(call, p);
  steif_problem_clear(call->ctx, p);
  return code;
}
