/* arrays_output.c: the lists and matrices of a report as files for numpy and as Matrix Market files.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "output.h"
#include "message.h"
#include <steif/data.h>
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { ARRAYS = 16 }; /* of a .npz file */

bool wants_arrays(const struct call *call) { return call->npz || call->h5 || call->mtx; }

int save_matrix(const struct call *call, const char *name, SUNMatrix M)
{
  char path[4096];
  if (!call->mtx) return EXIT_OK;
  if (snprintf(path, sizeof path, "%s%s.mtx", call->mtx, name) >= (int)sizeof path)
    return bad_usage(call, "--mtx is longer than a path may be; shorten it");
  if (steif_matrix_write(call->ctx, M, path) == STEIF_OK) return EXIT_OK;
  say(call, "%s", steif_message(call->ctx));
  return EXIT_FAILED;
}

/* The array as a file, a list as one column. */
static int write_matrix(const struct call *call, const steif_array *a)
{
  const size_t columns = a->columns ? a->columns : 1;
  SUNMatrix M =
    SUNDenseMatrix((sunindextype)a->rows, (sunindextype)columns, steif_sundials(call->ctx));
  if (!M) return no_memory(call, "a matrix", "leave --mtx out");
  for (size_t i = 0; i < a->rows; i++)
    for (size_t j = 0; j < columns; j++)
      SM_ELEMENT_D(M, (sunindextype)i, (sunindextype)j) = a->value[i * columns + j];
  const int code = save_matrix(call, a->name, M);
  SUNMatDestroy(M);
  return code;
}

int save_arrays(const struct call *call, size_t count, const steif_array *array)
{
  int code = STEIF_OK;
  if (call->npz) code = steif_npz_save(call->ctx, call->npz, count, array);
  if (!code && call->h5) code = steif_h5_save(call->ctx, call->h5, count, array);
  if (!code) return EXIT_OK;
  say(call, "%s", steif_message(call->ctx));
  return EXIT_FAILED;
}

static int save(const struct call *call, size_t count, const steif_array *array)
{
  int code = save_arrays(call, count, array);
  for (size_t i = 0; call->mtx && i < count && !code; i++) code = write_matrix(call, array + i);
  return code;
}

int save_report_arrays(const struct call *call, const steif_report *report)
{
  steif_array array[ARRAYS] = {{0}};
  size_t count = 0, rows, columns;
  int code = EXIT_OK;
  if (!call->verb->matrices || !wants_arrays(call)) return EXIT_OK;
  for (const char *name;
       !code && count < ARRAYS &&
       (name = steif_report_array_at(report, count, &rows, &columns, NULL));) {
    double *value = malloc(rows * (columns ? columns : 1) * sizeof *value);
    if (!value) code = no_memory(call, "the matrices", "leave --npz and --mtx out");
    if (value) steif_report_array_at(report, count, &rows, &columns, value);
    array[count++] = (steif_array){name, rows, columns, value, NULL};
  }
  if (!code) code = save(call, count, array);
  for (size_t i = 0; i < count; i++) free((void *)array[i].value);
  return code;
}
