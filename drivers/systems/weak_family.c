/* weak_family.c: weak convergence for each of several test functions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "output.h"
#include "weak.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FUNCTIONS = 64 };

struct member {
  char words[512];
  double exact, t1;
  steif_weak_row last; /* the smallest usable step, else the smallest */
  steif_weak_result result;
};
struct members {
  const struct weak *weak;
  size_t count;
  struct member *member;
  char verdict[384];
  int converges;
};

static void fill(steif_report *r, const struct call *call, const void *result)
{
  enum { LISTED = 256 };
  double error[LISTED];
  const struct members *m = result;
  steif_report_text(r, "method", call->word[0]);
  steif_report_whole(r, "index", m->member->result.index);
  steif_report_text(r, "convention", convention_name(m->weak->query.convention));
  for (size_t i = 0; i < m->count; i++) {
    const struct member *g = m->member + i;
    steif_report_row(r, "functions");
    steif_report_text(r, "functions.g", g->words);
    steif_report_real(r, "functions.t1", g->t1);
    steif_report_real(r, "functions.exact", g->result.exact);
    steif_report_real(r, "functions.h", g->last.h);
    steif_report_real(r, "functions.error", g->last.error);
    steif_report_real(r, "functions.rounding", g->last.rounding);
    steif_report_real(r, "functions.order", g->last.usable ? g->last.order : NAN);
    steif_report_whole(r, "functions.converges", g->result.converges);
  }
  for (size_t i = 0; wants_arrays(call) && i < m->count && i < LISTED; i++)
    error[i] = m->member[i].last.error;
  if (wants_arrays(call))
    steif_report_list(r, "error", m->count < LISTED ? m->count : LISTED, error);
  steif_report_text(r, "verdict", m->verdict);
}

/* One that does not converge decides against, open ones leave it open. */
static void judge(struct members *m)
{
  double least = INFINITY;
  size_t open = 0, unknown = 0, single = 0;
  const struct member *against = NULL;
  for (size_t i = 0; i < m->count; i++) {
    const struct member *g = m->member + i;
    if (g->result.converges == 0 && !against) against = g;
    open += g->result.converges < 0;
    single += !weak_is_open(g->result.converges, g->result.verdict) && g->result.converges < 0;
    if (isfinite(g->result.order)) least = fmin(least, g->result.order);
    unknown += !isfinite(g->result.order) && strncmp(g->result.verdict, "exact", 5) != 0;
  }
  m->converges = against ? 0 : open ? -1 : 1;
  if (against)
    snprintf(m->verdict, sizeof m->verdict, "%s, for g = %.60s", against->result.verdict,
             against->words);
  else if (single == m->count)
    snprintf(m->verdict, sizeof m->verdict, "%s", m->member->result.verdict);
  else if (open)
    snprintf(m->verdict, sizeof m->verdict, "undecided for %zu of %zu test functions", open,
             m->count);
  else if (unknown)
    snprintf(m->verdict, sizeof m->verdict,
             "converges weakly for all %zu test functions; the order is not known for %zu",
             m->count, unknown);
  else if (isfinite(least))
    snprintf(m->verdict, sizeof m->verdict,
             "converges weakly for all %zu test functions, order %.2f or more", m->count,
             least);
  else
    snprintf(m->verdict, sizeof m->verdict, "exact for all %zu test functions (to rounding)",
             m->count);
}

/* The next of words separated by ';' into text; what is left. */
static const char *piece(const char *words, char *text, size_t room)
{
  const size_t length = strcspn(words, ";");
  snprintf(text, room, "%.*s", (int)length, words);
  return words + length + (words[length] == ';');
}

int weak_end_of_test(struct call *call, double *t1)
{
  struct test_function g;
  struct member m;
  *t1 = real_or(call, "--t1", 1);
  for (const char *at = word_of(call, "--g"); at && *at && !given(call, "--t1");) {
    at = piece(at, m.words, sizeof m.words);
    const int code = test_function_open(call, m.words, 0, &g);
    *t1 = fmax(*t1, g.weight.t1);
    test_function_close(&g);
    if (code) return code;
  }
  return EXIT_OK;
}

static int measure(struct call *call, struct weak *w, struct member *g)
{
  int code = test_function_open(call, g->words, real_of(call, "--t1"), &w->g);
  w->query.g = &w->g.weight;
  if (!code && weak_measure(call->ctx, w)) code = descriptor_fail(call);
  g->t1 = w->g.weight.t1;
  test_function_close(&w->g);
  g->result = w->result;
  g->last = w->row[w->query.rows - 1];
  for (size_t i = 1; i < w->query.rows; i++)
    if (w->row[i].usable) g->last = w->row[i];
  return code;
}

static int all(struct call *call, struct weak *w, const char *words, struct members *m)
{
  for (const char *at = words; *at;) {
    struct member *g = m->member + m->count;
    if (m->count == FUNCTIONS)
      return bad_usage(call, "--g has more than %d test functions; split the call", FUNCTIONS);
    at = piece(at, g->words, sizeof g->words);
    const int code = measure(call, w, g);
    if (code) return code;
    m->count++;
  }
  judge(m);
  return EXIT_OK;
}

int weak_family(struct call *call, struct weak *w, const char *words)
{
  struct members m = {.weak = w, .member = calloc(FUNCTIONS, sizeof *m.member)};
  if (!m.member) return no_memory(call, "the test functions", "give the process more");
  int code = all(call, w, words, &m);
  if (!code) code = present_result(call, fill, &m);
  free(m.member);
  if (code || !weak_is_open(m.converges, m.verdict)) return code;
  say(call, "%s [STEIF_NOT_CERTIFIED]", m.verdict);
  return EXIT_UNCERTIFIED;
}
