/* c2d.c: x' = A x + B u, or E x' = A x + B u, on a time grid.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "matrix.h"
#include <stdlib.h>

enum { A, B, C, D, E, FILES };

static int read_files(struct call *call, struct matrix *m)
{
  int code = matrix_system(call, call->word[0], "A of x' = A x + B u", &m[A], &m[E]);
  const long n = m[A].rows;
  if (!code) code = matrix_ports(call, n, &m[B], &m[C], &m[D]);
  if (!code && given(call, "--D") && !m[B].x) code = bad_usage(call, "--D needs B.mtx; add it");
  if (!code) code = matrix_option(call, "--C", 0, n, &m[C]);
  if (!code) code = matrix_option(call, "--D", m[C].rows, m[B].columns, &m[D]);
  return code || m[E].x ? code : matrix_option(call, "--E", n, n, &m[E]);
}

static void scheme_with_parameter(const struct call *call, char *text, size_t room)
{
  const char *name = word_of(call, "--scheme"), *value = word_of(call, "--prewarp");
  const char *key = value ? ":w=" : ":alpha=";
  if (!value) value = word_of(call, "--alpha");
  snprintf(text, room, "%s%s%s", name, value ? key : "", value ? value : "");
}

static int discretise(struct call *call, const steif_state_space *s, struct discrete_answer *a)
{
  char scheme[200];
  scheme_with_parameter(call, scheme, sizeof scheme);
  if (a->part.memory && !s->n) {
    say(call, "E x' = A x + B u has no finite part; check E [STEIF_UNSUPPORTED]");
    return EXIT_FAILED;
  }
  const int code = steif_c2d(call->ctx, s, scheme, real_of(call, "--dt"), &a->discrete)
                     ? fail(call)
                     : discrete_present(call, a);
  steif_discrete_clear(call->ctx, &a->discrete);
  return code;
}

static int run(struct call *call)
{
  struct matrix m[FILES] = {{0}};
  struct discrete_answer a = {.part = {.memory = NULL}};
  int code = read_files(call, m);
  const steif_state_space s = {
    (int)m[A].rows, (int)m[B].columns, (int)m[C].rows, m[A].x, m[B].x, m[C].x, m[D].x};
  if (!code && m[E].x && steif_finite_part_find(call->ctx, &s, m[E].x, &a.part))
    code = fail(call);
  if (!code) code = discretise(call, m[E].x ? &a.part.form : &s, &a);
  steif_finite_part_clear(call->ctx, &a.part);
  for (int i = 0; i < FILES; i++) free(m[i].x);
  return code;
}

static const struct option options[] = {
  {"--dt", POSITIVE, "H", "step of the grid", NULL},
  {"--scheme", WORD, "S", "zoh, foh, bilinear, ...: 'steif list schemes'", "zoh"},
  {"--prewarp", POSITIVE, "W", "frequency at which bilinear is exact", NULL},
  {"--alpha", REAL, "A", "parameter of gbt, from 0 (forward) to 1 (backward)", NULL},
  {"--C", WORD, "C.mtx", "y = C x + D u: gives Cd and Dd as well", NULL},
  {"--D", WORD, "D.mtx", "D of y = C x + D u (default: 0)", NULL},
  {"--E", WORD, "E.mtx", "E x' = A x + B u, on its finite part (without --C: y = x)", NULL},
  OPTIONS_END};
static const struct rule rules[] = {{"--dt", REQUIRED, NULL},
                                    {"--prewarp", EXCLUDES, "--alpha"},
                                    {"--D", NEEDS, "--C"},
                                    RULES_END};

const struct verb verb_c2d = {.name = "c2d",
                              .about = "Discretise x' = A x + B u or E x' = A x + B u in time",
                              .usage = "A.mtx|S.mat|MODEL.steif [B.mtx] --dt H [--scheme S]",
                              .least = 1,
                              .most = 2,
                              .option = options,
                              .rule = rules,
                              .matrices = true,
                              .run = run};
