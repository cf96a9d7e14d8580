/* descriptor_start.c: x(0-), f = B u and y = C x + D u of a descriptor system.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "descriptor.h"
#include "matrix.h"
#include <stdlib.h>

int descriptor_read_x0(struct call *call, struct descriptor *l)
{
  struct matrix x0 = {0};
  if (!given(call, "--x0")) return EXIT_OK;
  const int code = matrix_read(call, word_of(call, "--x0"), l->n, 1, &x0);
  if (code) return code;
  free(l->x0);
  l->x0 = x0.x;
  return EXIT_OK;
}

/* B of f = B u: --input, else that of the .mat file; NULL: none. */
static int read_input(struct call *call, SUNMatrix *B)
{
  const char *path = word_of(call, "--input"), *last = call->word[call->words - 1];
  if (!path && !holds_system(last)) return EXIT_OK;
  if (path) *B = steif_matrix_read(call->ctx, path);
  const bool good =
    path ? *B != NULL : !steif_input_output_read(call->ctx, last, B, NULL, NULL);
  return good ? EXIT_OK : fail_file(call);
}

static int read_forcing(struct call *call, struct descriptor *l)
{
  SUNMatrix B = NULL;
  const char *path = word_of(call, "--forcing"), *text = word_of(call, "--f");
  if (!path && !text) return EXIT_OK;
  const int code = read_input(call, &B);
  if (code) return code;
  if (text)
    l->function = steif_function_parse(call->ctx, text, l->n, B);
  else if (ends_in(path, ".csv"))
    l->function = steif_function_samples(call->ctx, path, l->n, B, 0, NULL);
  else
    l->function = steif_function_read(call->ctx, path, l->n, B);
  if (B) SUNMatDestroy(B);
  if (!l->function) return path || given(call, "--input") ? fail_file(call) : fail(call);
  l->system.f = steif_function_value;
  l->system.user = l->function;
  return EXIT_OK;
}

/* The matrix of an option; NULL without it. */
static int read_matrix(struct call *call, const char *option, SUNMatrix *M)
{
  const char *path = word_of(call, option);
  if (path) *M = steif_matrix_read(call->ctx, path);
  return path && !*M ? fail_file(call) : EXIT_OK;
}

static int read_output(struct call *call, struct descriptor *l, const char *path)
{
  if (!given(call, "--output")) {
    const bool none = !holds_system(path);
    return none || !steif_input_output_read(call->ctx, path, NULL, &l->C, &l->D)
             ? EXIT_OK
             : fail_file(call);
  }
  int code = read_matrix(call, "--output", &l->C);
  if (!code) code = read_matrix(call, "--feedthrough", &l->D);
  const size_t inputs = l->function ? steif_function_count(l->function) : (size_t)l->n;
  if (!code && steif_output_check(call->ctx, l->C, l->D, l->n, (sunindextype)inputs))
    code = fail_file(call);
  return code;
}

int descriptor_read_ports(struct call *call, struct descriptor *l, const char *path)
{
  const int code = read_forcing(call, l);
  return code ? code : read_output(call, l, path);
}
