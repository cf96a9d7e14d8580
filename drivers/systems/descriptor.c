/* descriptor.c: E x' + F x = f from files, or from the collection.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "descriptor.h"
#include "output.h"
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

bool ends_in(const char *word, const char *ending)
{
  const size_t length = strlen(word), tail = strlen(ending);
  return length > tail && !strcmp(word + length - tail, ending);
}

bool holds_system(const char *word) { return ends_in(word, ".mat") || ends_in(word, ".h5"); }

/* Of a path without an ending: does it begin as a matrix does? Else it is a model. */
static bool begins_as_matrix(const char *path)
{
  static const char market[] = "%%MatrixMarket", matlab[] = "MATLAB ";
  char head[sizeof market] = "";
  FILE *file = fopen(path, "rb");
  if (!file) return false;
  const size_t length = fread(head, 1, sizeof head - 1, file);
  fclose(file);
  return length == 0 || !strncmp(head, market, sizeof market - 1) ||
         !strncmp(head, matlab, sizeof matlab - 1);
}

bool descriptor_is_file(const char *word)
{
  const char *model = strstr(word, ".steif"); /* a problem, whatever its folder */
  if (model && (!model[6] || model[6] == ':')) return false;
  return ends_in(word, ".mtx") || holds_system(word) ||
         (strchr(word, '/') && !strchr(word, ':') && begins_as_matrix(word));
}

int descriptor_fail(const struct call *call)
{
  const int code = steif_status(call->ctx);
  bool file = given(call, "--x0") || given(call, "--forcing");
  for (int i = 0; i < call->words; i++) file = file || descriptor_is_file(call->word[i]);
  const bool blamed =
    (code == STEIF_BAD_INPUT && !given(call, "--f") && !given(call, "--points")) ||
    code == STEIF_NOT_FINITE;
  return blamed && file ? fail_file(call) : fail(call);
}

/* "equations 3 (current at b), 4, 7, ..." and likewise unknowns, counted from 1. */
static const char *named(char *text, size_t room, const char *what, const char *const *name,
                         long count, const sunindextype *value)
{
  enum { SHOWN = 8 };
  size_t used = (size_t)snprintf(text, room, "%s%s", what, count == 1 ? "" : "s");
  for (long i = 0; i < count && i < SHOWN && used < room; i++) {
    const long k = (long)value[i];
    used += (size_t)snprintf(text + used, room - used, name ? "%s %ld (%.40s)" : "%s %ld",
                             i ? "," : "", k + 1, name ? name[k] : "");
  }
  if (count > SHOWN && used < room) snprintf(text + used, room - used, ", ...");
  return text;
}

int descriptor_singular(const struct call *call, const struct descriptor *l,
                        const steif_structure *s, bool presented)
{
  char one[512], two[512], text[2048];
  const bool equations = s->equations_count, unknowns = s->unknowns_count;
  const steif_names none = {NULL, NULL}, *names = l->names ? l->names : &none;
  const int code = s->certified ? STEIF_SINGULAR : STEIF_NOT_CERTIFIED;
  named(one, sizeof one, "equation", names->equation, (long)s->equations_count, s->equations);
  named(two, sizeof two, "unknown", names->unknown, (long)s->unknowns_count, s->unknowns);
  snprintf(text, sizeof text, "%s%s%s%s%s", s->message,
           equations || unknowns ? "; look at " : "", equations ? one : "",
           equations && unknowns ? " and " : "", unknowns ? two : "");
  const char *symbol = s->certified ? "STEIF_SINGULAR" : "STEIF_NOT_CERTIFIED";
  if (!presented) return refuse(call, code, symbol, "%s", text);
  say(call, "%s [%s]", text, symbol);
  return exit_of(code);
}

/* ---- matrices ---- */

static sunindextype rows(SUNMatrix M)
{
  return SUNMatGetID(M) == SUNMATRIX_SPARSE ? SUNSparseMatrix_Rows(M) : SUNDenseMatrix_Rows(M);
}

static int from_files(struct call *call, struct descriptor *l, int from)
{
  const char *first = call->word[from],
             *second = call->words > from + 1 ? call->word[from + 1] : NULL;
  const bool one = holds_system(first);
  if (one && second)
    return bad_usage(call, "%s holds both matrices; leave %s out", first, second);
  if (!one && !second)
    return bad_usage(call, "%s is E, the second file is missing: E.mtx F.mtx", first);
  if (one && given(call, "--state-space"))
    return bad_usage(call,
                     "--state-space is for two files; a .mat file tells by the name, F or A");
  if (steif_system_read(call->ctx, first, second, given(call, "--state-space"), &l->system.E,
                        &l->system.F))
    return fail_file(call);
  l->n = rows(l->system.E);
  return EXIT_OK;
}

static int from_collection(struct call *call, struct descriptor *l, int from)
{
  const char *name = call->word[from];
  if (!l->problem.name && steif_problem_find(call->ctx, name, &l->problem)) return fail(call);
  if (call->words > from + 1)
    return bad_usage(call, "\"%s\" is one word too many after the problem %s",
                     call->word[from + 1], name);
  if (given(call, "--state-space"))
    return bad_usage(call, "--state-space is for files; leave it out with the problem %s",
                     name);
  if (steif_linear_of(call->ctx, &l->problem, &l->system)) return fail(call);
  l->n = l->problem.n;
  l->t0 = l->problem.t0;
  l->x0 = malloc((size_t)l->n * sizeof *l->x0);
  if (!l->x0) return no_memory(call, "start values", "give the process more");
  memcpy(l->x0, l->problem.y0, (size_t)l->n * sizeof *l->x0);
  l->names = l->problem.names;
  return EXIT_OK;
}

static int read_names(struct call *call, struct descriptor *l)
{
  const char *path =
    given(call, "--names") ? word_of(call, "--names") : call->word[call->words - 1];
  if (!given(call, "--names") && !holds_system(path)) return EXIT_OK;
  if (steif_names_read(call->ctx, path, l->n, &l->read)) return fail_file(call);
  if (l->read) l->names = l->read;
  return EXIT_OK;
}

int descriptor_open(struct call *call, struct descriptor *l, int from, bool start)
{
  return descriptor_open_found(call, l, from, start, &(steif_problem){0});
}

int descriptor_open_found(struct call *call, struct descriptor *l, int from, bool start,
                          const steif_problem *found)
{
  *l = (struct descriptor){.problem = *found};
  int code = descriptor_is_file(call->word[from]) ? from_files(call, l, from)
                                                  : from_collection(call, l, from);
  if (!code) code = read_names(call, l);
  if (!code && start) code = descriptor_read_x0(call, l);
  if (!code && start) code = descriptor_read_ports(call, l, call->word[from]);
  l->t0 = real_or(call, "--t0", l->t0);
  if (!code) code = save_matrix(call, "E", l->system.E);
  return code ? code : save_matrix(call, "F", l->system.F);
}

int descriptor_started(const struct call *call, const struct descriptor *l)
{
  return l->x0 ? EXIT_OK : bad_usage(call, "--x0 X.mtx is needed: the values x(0-)");
}

bool descriptor_as_published(const struct call *call, const struct descriptor *l)
{
  return l->problem.name && strcmp(l->problem.name, "-") && !given(call, "--x0") &&
         !l->function;
}

void descriptor_close(struct call *call, struct descriptor *l)
{
  if (l->system.E) SUNMatDestroy(l->system.E);
  if (l->system.F) SUNMatDestroy(l->system.F);
  if (l->C) SUNMatDestroy(l->C);
  if (l->D) SUNMatDestroy(l->D);
  steif_function_free(&l->function);
  steif_names_free(&l->read);
  steif_problem_clear(call->ctx, &l->problem);
  free(l->x0);
}

steif_analysis descriptor_analysis(const struct call *call, const struct descriptor *l)
{
  return (steif_analysis){.algorithm = (enum steif_algorithm)choice_of(call, "--algorithm"),
                          .radius = real_of(call, "--radius"),
                          .points = (int)whole_of(call, "--points"),
                          .snap = given(call, "--snap"),
                          .names = l->names};
}
