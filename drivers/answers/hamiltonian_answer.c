/* hamiltonian_answer.c: in which senses x' = A x is Hamiltonian, as a report.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "members.h"

static void answer(steif_report *r, const char *name, int value)
{
  steif_report_text(r, name, value == 1 ? "yes" : value == 0 ? "no" : "undecided");
}

static void form(steif_report *r, const char *name, const char *prefix, int n,
                 const steif_form_found *f)
{
  const bool there = f->P != NULL;
  if (there)
    report_dense(r, name, n, n, f->P);
  else
    steif_report_text(r, name, NULL);
  report_maybe(r, prefix, "residual", there, f->residual);
  report_maybe(r, prefix, "cond", there, f->condition);
  report_maybe(r, prefix, "distance", there, f->distance);
}

static void fill(steif_report *r, const struct call *call, const void *result)
{
  const struct hamiltonian_answer *a = result;
  const steif_hamiltonian *h = &a->found;
  (void)call;
  answer(r, "definite", h->definite);
  answer(r, "nonsingular", h->nonsingular);
  answer(r, "symplectic", h->symplectic);
  answer(r, "invariant", h->invariant);
  report_natural(r, "dimension", h->dimension);
  form(r, "P", "", a->n, &h->symmetric);
  form(r, "K", "K_", a->n, &h->skew);
  report_dense(r, "eigenvalues", a->n, 2, h->re); /* the imaginary parts follow */
  steif_report_real(r, "tolerance", h->tolerance);
  steif_report_text(r, "message", h->message);
}

int hamiltonian_present(const struct call *call, const struct hamiltonian_answer *a)
{
  const steif_hamiltonian *h = &a->found;
  const bool sure =
    h->definite >= 0 && h->nonsingular >= 0 && h->symplectic >= 0 && h->invariant >= 0;
  const int code = present_result(call, fill, a);
  if (code || sure) return code;
  say(call, "%s; say with --tol how accurate the entries are [STEIF_NOT_CERTIFIED]",
      h->message);
  return EXIT_UNCERTIFIED;
}
