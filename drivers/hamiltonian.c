/* hamiltonian.c: which of the four senses x' = A x is Hamiltonian in.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matrix.h"
#include <stdlib.h>
#include <string.h>

static void answer(steif_report *r, const char *name, int value)
{
  steif_report_text(r, name, value == 1 ? "yes" : value == 0 ? "no" : "undecided");
}

static void form(steif_report *r, const char *name, const char *prefix, int n,
                 const steif_form_found *f)
{
  const struct {
    const char *key;
    double value;
  } part[] = {{"residual", f->residual}, {"cond", f->condition}, {"distance", f->distance}};
  char key[32];
  if (f->P)
    report_dense(r, name, n, n, f->P);
  else
    steif_report_text(r, name, NULL);
  for (int i = 0; i < 3; i++) {
    snprintf(key, sizeof key, "%s%s", prefix, part[i].key);
    if (f->P)
      steif_report_real(r, key, part[i].value);
    else
      steif_report_text(r, key, NULL);
  }
}

static void fill(steif_report *r, int n, const steif_hamiltonian *h)
{
  answer(r, "definite", h->definite);
  answer(r, "nonsingular", h->nonsingular);
  answer(r, "symplectic", h->symplectic);
  answer(r, "invariant", h->invariant);
  if (h->dimension >= 0)
    steif_report_whole(r, "dimension", h->dimension);
  else
    steif_report_text(r, "dimension", NULL);
  form(r, "P", "", n, &h->symmetric);
  form(r, "K", "K_", n, &h->skew);
  report_dense(r, "eigenvalues", n, 2, h->re); /* the imaginary parts follow */
  steif_report_real(r, "tolerance", h->tolerance);
  steif_report_text(r, "message", h->message);
}

static int tell(struct call *call, int n, const double *A)
{
  steif_hamiltonian h;
  progress(call, "%d states", n);
  if (steif_hamiltonian_find(call->ctx, n, A, real_of(call, "--tol", 0), &h)) return fail(call);
  steif_report *r = steif_report_new(call->ctx);
  if (r) fill(r, n, &h);
  const int code = r ? present(call, r) : fail(call);
  steif_report_free(&r);
  const bool sure =
    h.definite >= 0 && h.nonsingular >= 0 && h.symplectic >= 0 && h.invariant >= 0;
  if (!code && !sure) say(call, "%s; say with --tol how accurate the entries are", h.message);
  steif_hamiltonian_clear(call->ctx, &h);
  return code ? code : sure ? EXIT_OK : EXIT_UNCERTIFIED;
}

static const char *name_at(const void *list, size_t i)
{
  (void)list;
  const steif_hamiltonian_example *e = steif_hamiltonian_example_at(i);
  return e ? e->name : NULL;
}

static int shelf(struct call *call)
{
  const steif_hamiltonian_example *e;
  steif_report *r = steif_report_new(call->ctx);
  for (size_t i = 0; (e = steif_hamiltonian_example_at(i)); i++) {
    steif_report_row(r, "examples");
    steif_report_text(r, "examples.name", e->name);
    steif_report_whole(r, "examples.n", e->n);
    steif_report_text(r, "examples.about", e->about);
  }
  const int code = r ? present(call, r) : fail(call);
  steif_report_free(&r);
  return code;
}

static int from_file(struct call *call)
{
  struct matrix A = {0};
  int code = matrix_square(call, call->word[0], "A of x' = A x", &A);
  if (!code) code = tell(call, (int)A.rows, A.x);
  free(A.x);
  return code;
}

static int run(struct call *call)
{
  if (call->plot) return refuse(call, "hamiltonian has no picture; leave --plot out");
  if (!call->words) return shelf(call);
  const char *name = call->word[0];
  if (strpbrk(name, "./")) return from_file(call);
  const steif_hamiltonian_example *e;
  for (size_t i = 0; (e = steif_hamiltonian_example_at(i)); i++)
    if (!strcmp(e->name, name)) return tell(call, e->n, e->A);
  return refuse(call, "no example \"%s\", the nearest is %s; files end in .mtx", name,
                nearest(name, name_at, NULL));
}

static const struct option options[] = {
  {"--tol", POSITIVE, "R", "relative accuracy of the entries (default: rounding)"},
  {NULL, FLAG, NULL, NULL}};

const struct verb verb_hamiltonian = {"hamiltonian",
                                      "Tell in which of four senses x' = A x is Hamiltonian",
                                      "[A.mtx | EXAMPLE] [--tol R]",
                                      0,
                                      1,
                                      options,
                                      NULL,
                                      run};
