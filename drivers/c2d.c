/* c2d.c: x' = A x + B u on a time grid.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matrix.h"
#include <stdlib.h>

struct files {
  struct matrix A, B, C, D, E;
};

static int open(struct call *call, struct files *f)
{
  const char *C = word_of(call, "--C", NULL), *D = word_of(call, "--D", NULL),
             *E = word_of(call, "--E", NULL);
  if (D && (!C || call->words < 2))
    return refuse(call, "--D needs B.mtx and --C, whose sizes it joins; give them too");
  int code = matrix_square(call, call->word[0], "A of x' = A x + B u", &f->A);
  const long n = f->A.rows;
  if (!code && call->words > 1) code = matrix_read(call, call->word[1], n, 0, &f->B);
  if (!code && C) code = matrix_read(call, C, 0, n, &f->C);
  if (!code && D) code = matrix_read(call, D, f->C.rows, f->B.columns, &f->D);
  if (!code && E) code = matrix_read(call, E, n, n, &f->E);
  return code;
}

static void fill(steif_report *r, const steif_discrete *d)
{
  const steif_state_space *s = &d->form;
  steif_report_text(r, "scheme", d->scheme);
  steif_report_real(r, "dt", d->dt);
  report_dense(r, "Ad", s->n, s->n, s->A);
  report_dense(r, "Bd", s->n, s->m, s->B);
  report_dense(r, "B1", s->n, s->m, d->B1);
  if (s->p) report_dense(r, "Cd", s->p, s->n, s->C);
  if (s->p) report_dense(r, "Dd", s->p, s->m, s->D);
  report_dense(r, "eigenvalues", s->n, 2, d->re); /* the imaginary parts follow */
  steif_report_real(r, "alias", d->alias);
}

/* What x and y hold of the derivatives of u: P1, P2, ... */
static void polynomial(steif_report *r, const steif_finite_part *part)
{
  const int p = part->form.p, m = part->form.m;
  steif_report_whole(r, "index", part->index);
  for (int j = 0; j < part->terms; j++) {
    char name[16];
    snprintf(name, sizeof name, "P%d", j + 1);
    report_dense(r, name, p, m, part->polynomial + j * p * m);
  }
}

static int tell(struct call *call, const steif_discrete *d, const steif_finite_part *part)
{
  steif_report *r = steif_report_new(call->ctx);
  if (!r) return fail(call);
  fill(r, d);
  if (part->memory) polynomial(r, part);
  const int code = present(call, r);
  steif_report_free(&r);
  if (!code && d->alias >= 1)
    say(call,
        "the largest |Im l| dt is %.4g pi: frequencies alias and cannot be recovered from the "
        "samples; shorten dt",
        d->alias);
  if (!code && part->terms)
    say(call,
        "the index is %d: add P1 u' + ... to the outputs; an input held between samples makes "
        "impulses of its derivatives",
        part->index);
  return code;
}

/* The scheme with its parameter; `text` has room for it. */
static int scheme(struct call *call, char *text, size_t room)
{
  const char *name = word_of(call, "--scheme", "zoh");
  const char *W = word_of(call, "--prewarp", NULL), *alpha = word_of(call, "--alpha", NULL);
  if (!given(call, "--dt"))
    return refuse(call, "--dt H, the step, is needed: steif c2d A.mtx B.mtx --dt 0.1");
  const int length = W       ? snprintf(text, room, "%s:w=%s", name, W)
                     : alpha ? snprintf(text, room, "%s:alpha=%s", name, alpha)
                             : snprintf(text, room, "%s", name);
  if (length < 0 || (size_t)length >= room)
    return refuse(
      call, "the scheme \"%.20s...\" is too long; 'steif list schemes' has them all", name);
  return EXIT_OK;
}

static int discretise(struct call *call, const char *text, const steif_state_space *s,
                      const steif_finite_part *part)
{
  steif_discrete d = {0};
  if (part->memory && !s->n) {
    say(call, "E x' = A x + B u has no finite part: nothing in it moves; check E");
    return EXIT_FAILED;
  }
  const int code = steif_c2d(call->ctx, s, text, real_of(call, "--dt", 0), &d)
                     ? fail(call)
                     : tell(call, &d, part);
  steif_discrete_clear(call->ctx, &d);
  return code;
}

static int run(struct call *call)
{
  char text[200];
  struct files f = {{0}, {0}, {0}, {0}, {0}};
  steif_finite_part part = {.memory = NULL};
  if (call->plot) return refuse(call, "c2d has no picture; leave --plot out");
  int code = scheme(call, text, sizeof text);
  if (!code) code = open(call, &f);
  if (!code) {
    const steif_state_space s = {
      (int)f.A.rows, (int)f.B.columns, (int)f.C.rows, f.A.x, f.B.x, f.C.x, f.D.x};
    if (f.E.x && steif_finite_part_find(call->ctx, &s, f.E.x, &part))
      code = fail(call);
    else
      code = discretise(call, text, f.E.x ? &part.form : &s, &part);
  }
  steif_finite_part_clear(call->ctx, &part);
  free(f.A.x), free(f.B.x), free(f.C.x), free(f.D.x), free(f.E.x);
  return code;
}

static const struct option options[] = {
  {"--dt", POSITIVE, "H", "the step"},
  {"--scheme", WORD, "S", "zoh, foh, bilinear, ...: 'steif list schemes' (default zoh)"},
  {"--prewarp", POSITIVE, "W", "frequency at which bilinear is exact"},
  {"--alpha", REAL, "A", "of gbt, from 0 (forward) to 1 (backward)"},
  {"--C", WORD, "C.mtx", "y = C x + D u: gives Cd and Dd as well"},
  {"--D", WORD, "D.mtx", "default 0"},
  {"--E", WORD, "E.mtx", "E x' = A x + B u, on its finite part; outputs are x without --C"},
  {NULL, FLAG, NULL, NULL}};

static const char *const clash[][2] = {{"--prewarp", "--alpha"}, {NULL, NULL}};

const struct verb verb_c2d = {
  "c2d", "Discretise x' = A x + B u", "A.mtx [B.mtx] --dt H [--scheme S]", 1, 2, options, clash,
  run};
