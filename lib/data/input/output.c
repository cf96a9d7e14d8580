/* output.c: y = C x + D u beside a descriptor system.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { LEAD, INPUT, CONSTRAINT, KNOWN };

/* C beside M, D, K and G, where D is the damping: of q or of (q, v, l). */
static int mechanical(steif_context *ctx, const char *path, SUNMatrix *known, SUNMatrix C)
{
  STEIF_TRY(stf_input_variable(ctx, path, "M", known + LEAD));
  if (!known[LEAD]) return STEIF_OK;
  STEIF_TRY(stf_input_variable(ctx, path, "G", known + CONSTRAINT));
  const sunindextype n = stf_input_rows(known[LEAD]),
                     m = known[CONSTRAINT] ? stf_input_rows(known[CONSTRAINT]) : 0;
  if (stf_input_columns(C) == n) return STEIF_OK;
  return stf_input_sized(ctx, path, "C", C, stf_input_rows(C), 2 * n + m,
                         "a column for each of q, or of q, v and the multipliers");
}

static int first_order(steif_context *ctx, const char *path, SUNMatrix *known, SUNMatrix C,
                       SUNMatrix *D)
{
  const sunindextype rows = stf_input_rows(C);
  STEIF_TRY(stf_input_sized(ctx, path, "C", C, rows, stf_input_rows(known[LEAD]),
                            "a column for each of E"));
  STEIF_TRY(stf_input_variable(ctx, path, "D", D));
  if (!*D) return STEIF_OK;
  STEIF_TRY(stf_input_variable(ctx, path, "B", known + INPUT));
  const sunindextype inputs = stf_input_columns(known[INPUT] ? known[INPUT] : known[LEAD]);
  return stf_input_sized(ctx, path, "D", *D, rows, inputs,
                         known[INPUT] ? "the rows of C and the columns of B"
                                      : "the rows of C and, without B, a column for each of f");
}

static int output_read(steif_context *ctx, const char *path, SUNMatrix *C, SUNMatrix *D)
{
  SUNMatrix known[KNOWN] = {NULL};
  *C = *D = NULL;
  STEIF_TRY(stf_input_variable(ctx, path, "C", C));
  if (!*C) return STEIF_OK;
  int code = stf_input_variable(ctx, path, "E", known + LEAD);
  if (!code)
    code =
      known[LEAD] ? first_order(ctx, path, known, *C, D) : mechanical(ctx, path, known, *C);
  for (int i = 0; i < KNOWN; i++)
    if (known[i]) SUNMatDestroy(known[i]);
  if (!code) return code;
  SUNMatDestroy(*C);
  if (*D) SUNMatDestroy(*D);
  *C = *D = NULL;
  return code;
}

int steif_input_output_read(steif_context *ctx, const char *path, SUNMatrix *B, SUNMatrix *C,
                            SUNMatrix *D)
{
  STEIF_CHECK((B || C) && !C == !D, ctx, STEIF_BAD_INPUT,
              "room for B, or for C and D, is needed, got NULL");
  if (B) STEIF_TRY(stf_input_read(ctx, path, B));
  const int code = C ? output_read(ctx, path, C, D) : STEIF_OK;
  if (code && B && *B) SUNMatDestroy(*B);
  if (code && B) *B = NULL;
  return code;
}

int steif_output_check(steif_context *ctx, SUNMatrix C, SUNMatrix D, sunindextype n,
                       sunindextype inputs)
{
  STEIF_TRY(stf_input_check(ctx, C, "C"));
  if (D) STEIF_TRY(stf_input_check(ctx, D, "D"));
  const long long rows = (long long)stf_input_rows(C),
                  columns = (long long)stf_input_columns(C);
  STEIF_CHECK(
    columns == n, ctx, STEIF_BAD_INPUT,
    "C of y = C x + D u is %lld x %lld and should have %lld columns, one for each unknown",
    rows, columns, (long long)n);
  STEIF_CHECK(
    !D || (stf_input_rows(D) == rows && stf_input_columns(D) == inputs), ctx, STEIF_BAD_INPUT,
    "D of y = C x + D u is %lld x %lld and should be %lld x %lld, the rows of C and the "
    "number of inputs",
    (long long)stf_input_rows(D), (long long)stf_input_columns(D), rows, (long long)inputs);
  return STEIF_OK;
}

static void add(SUNMatrix M, const sunrealtype *x, sunrealtype *y)
{
  for (sunindextype j = 0; M && j < stf_input_columns(M); j++)
    for (sunindextype k = 0; k < stf_input_column(M, j); k++) {
      sunindextype i;
      sunrealtype entry;
      stf_input_entry(M, j, k, &i, &entry);
      y[i] += entry * x[j];
    }
}

void steif_output_value(SUNMatrix C, SUNMatrix D, const sunrealtype *x, const sunrealtype *u,
                        sunrealtype *y)
{
  if (!C || !x || !y) return;
  memset(y, 0, (size_t)stf_input_rows(C) * sizeof *y);
  add(C, x, y);
  if (u) add(D, u, y);
}
