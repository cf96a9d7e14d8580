/* hamiltonian.c: which of the four senses x' = A x is Hamiltonian in.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "matrix.h"
#include "members.h"
#include <stdlib.h>
#include <string.h>

static int find(struct call *call, int n, const double *A)
{
  struct hamiltonian_answer a = {.n = n};
  progress(call, "%d states", n);
  if (steif_hamiltonian_find(call->ctx, n, A, real_of(call, "--tol"), &a.found))
    return fail(call);
  const int code = hamiltonian_present(call, &a);
  steif_hamiltonian_clear(call->ctx, &a.found);
  return code;
}

static void fill_examples(steif_report *r, const struct call *call, const void *result)
{
  static const struct member members[] = {MEMBER(steif_hamiltonian_example, name, A_TEXT),
                                          MEMBER(steif_hamiltonian_example, n, A_WHOLE),
                                          MEMBER(steif_hamiltonian_example, about, A_TEXT),
                                          MEMBERS_END};
  const steif_hamiltonian_example *e;
  (void)call, (void)result;
  for (size_t i = 0; (e = steif_hamiltonian_example_at(i)); i++) {
    steif_report_row(r, "examples");
    report_members(r, "examples.", members, e);
  }
}

static int from_file(struct call *call)
{
  struct matrix A = {0};
  int code = matrix_system(call, call->word[0], "A of x' = A x", &A, NULL);
  if (!code) code = find(call, (int)A.rows, A.x);
  free(A.x);
  return code;
}

static const char *name_at(const void *list, size_t i)
{
  (void)list;
  const steif_hamiltonian_example *e = steif_hamiltonian_example_at(i);
  return e ? e->name : NULL;
}

static int run(struct call *call)
{
  if (!call->words) return present_result(call, fill_examples, NULL);
  const char *name = call->word[0];
  if (!strcmp(name, "-") || strpbrk(name, "./")) return from_file(call);
  const steif_hamiltonian_example *e;
  for (size_t i = 0; (e = steif_hamiltonian_example_at(i)); i++)
    if (!strcmp(e->name, name)) return find(call, e->n, e->A);
  char text[GUESS];
  return unknown_name(call, "no example \"%s\"%s files end in .mtx", name,
                      guess(name, name_at, NULL, text));
}

static const struct option options[] = {
  {"--tol", POSITIVE, "R", "relative accuracy of the entries (default: rounding)", NULL},
  OPTIONS_END};

const struct verb verb_hamiltonian = {.name = "hamiltonian",
                                      .about =
                                        "Find in which of four senses x' = A x is Hamiltonian",
                                      .usage = "[A.mtx | MODEL.steif | EXAMPLE] [--tol R]",
                                      .most = 1,
                                      .option = options,
                                      .matrices = true,
                                      .run = run};
