/* discrete_answer.c: a discretised system as a report.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "members.h"

static void matrices(steif_report *r, const steif_discrete *d)
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

static void fill(steif_report *r, const struct call *call, const void *result)
{
  const struct discrete_answer *a = result;
  (void)call;
  matrices(r, &a->discrete);
  if (a->part.memory) polynomial(r, &a->part);
}

int discrete_present(const struct call *call, const struct discrete_answer *a)
{
  const int code = present_result(call, fill, a);
  if (!code && a->discrete.alias >= 1)
    say(call,
        "the largest |Im l| dt is %.4g pi: frequencies alias and cannot be recovered from the "
        "samples; shorten dt",
        a->discrete.alias);
  if (!code && a->part.terms)
    say(call,
        "the index is %d: add P1 u' + ... to the outputs; an input held between samples makes "
        "impulses of its derivatives",
        a->part.index);
  return code;
}
