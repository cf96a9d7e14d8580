/* mat_file.c: matrices and texts from MATLAB version 5 files, through matio.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include <stdint.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

#ifdef STEIF_HAVE_MATIO
#include <matio.h>

/* Element k of an array of a type of matio; false for what is no number. */
static bool element(const void *data, enum matio_types type, size_t k, sunrealtype *x)
{
  switch (type) {
  case MAT_T_DOUBLE: *x = ((const double *)data)[k]; return true;
  case MAT_T_SINGLE: *x = ((const float *)data)[k]; return true;
  case MAT_T_INT8: *x = ((const int8_t *)data)[k]; return true;
  case MAT_T_UINT8: *x = ((const uint8_t *)data)[k]; return true;
  case MAT_T_INT16: *x = ((const int16_t *)data)[k]; return true;
  case MAT_T_UINT16: *x = ((const uint16_t *)data)[k]; return true;
  case MAT_T_INT32: *x = ((const int32_t *)data)[k]; return true;
  case MAT_T_UINT32: *x = ((const uint32_t *)data)[k]; return true;
  case MAT_T_INT64: *x = (double)((const int64_t *)data)[k]; return true;
  case MAT_T_UINT64: *x = (double)((const uint64_t *)data)[k]; return true;
  default: return false;
  }
}

static SUNMatrix full(steif_context *ctx, const matvar_t *v)
{
  SUNMatrix M =
    SUNDenseMatrix((sunindextype)v->dims[0], (sunindextype)v->dims[1], steif_sundials(ctx));
  for (size_t k = 0; M && k < v->dims[0] * v->dims[1]; k++)
    element(v->data, v->data_type, k, SM_DATA_D(M) + k);
  return M;
}

/* Pointers that ascend from 0 to at most what is there. */
static bool sound(const mat_sparse_t *s, size_t columns)
{
  if (!s->jc || s->njc < columns + 1 || s->jc[0]) return false;
  for (size_t j = 0; j < columns; j++)
    if (s->jc[j] > s->jc[j + 1]) return false;
  const size_t count = s->jc[columns];
  return count <= s->nir && count <= s->ndata && (!count || (s->ir && s->data));
}

static SUNMatrix sparse(steif_context *ctx, const matvar_t *v)
{
  const mat_sparse_t *s = v->data;
  const size_t columns = v->dims[1], count = s->jc[columns];
  SUNMatrix M = SUNSparseMatrix((sunindextype)v->dims[0], (sunindextype)columns,
                                count ? (sunindextype)count : 1, CSC_MAT, steif_sundials(ctx));
  for (size_t j = 0; M && j <= columns; j++) SM_INDEXPTRS_S(M)[j] = (sunindextype)s->jc[j];
  for (size_t k = 0; M && k < count; k++) {
    SM_INDEXVALS_S(M)[k] = (sunindextype)s->ir[k];
    element(s->data, v->data_type, k, SM_DATA_S(M) + k);
  }
  return M;
}

/* A real matrix of numbers, whole. */
static int check(steif_context *ctx, const char *path, const matvar_t *v)
{
  sunrealtype x;
  const double zero = 0;
  STEIF_CHECK(!v->isComplex, ctx, STEIF_UNSUPPORTED,
              "'%s': the variable %s is complex, and systems here are real; save its real and "
              "imaginary parts as one real system of twice the size",
              path, v->name);
  const bool numbers = v->class_type == MAT_C_SPARSE ||
                       (v->class_type >= MAT_C_DOUBLE && v->class_type <= MAT_C_UINT64);
  STEIF_CHECK(numbers && v->rank == 2 && element(&zero, v->data_type, 0, &x), ctx,
              STEIF_BAD_INPUT,
              "'%s': the variable %s is no matrix of numbers; save it as double or sparse",
              path, v->name);
  STEIF_CHECK(v->dims[0] && v->dims[1], ctx, STEIF_BAD_INPUT,
              "'%s': the variable %s is empty, %zu x %zu; save a matrix", path, v->name,
              v->dims[0], v->dims[1]);
  const bool whole =
    v->data && (v->class_type == MAT_C_SPARSE
                  ? sound(v->data, v->dims[1])
                  : v->nbytes / Mat_SizeOf(v->data_type) / v->dims[0] >= v->dims[1]);
  STEIF_CHECK(whole, ctx, STEIF_BAD_INPUT,
              "'%s': the variable %s is cut off or damaged; save it again", path, v->name);
  return STEIF_OK;
}

static SUNMatrix convert(steif_context *ctx, const char *path, const matvar_t *v)
{
  char name[96];
  if (check(ctx, path, v)) return NULL;
  SUNMatrix M = v->class_type == MAT_C_SPARSE ? sparse(ctx, v) : full(ctx, v);
  if (!M)
    STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for %s of '%s'; make the problem smaller",
               v->name, path);
  snprintf(name, sizeof name, "the variable %.60s", v->name);
  if (M && stf_input_check(ctx, M, name)) {
    SUNMatDestroy(M);
    M = NULL;
  }
  return M;
}

/* The variable, or NULL: with the message set when it is there and cannot be read. */
static matvar_t *variable(steif_context *ctx, const char *path, const char *name, int *found)
{
  mat_t *mat = Mat_Open(path, MAT_ACC_RDONLY);
  if (!mat) {
    STEIF_FAIL(ctx, STEIF_IO, "matio cannot open '%s'; save it again with '-v7' or '-v6'",
               path);
    return NULL;
  }
  matvar_t *there = Mat_VarReadInfo(mat, name), *v = there ? Mat_VarRead(mat, name) : NULL;
  *found = there != NULL;
  if (there && !v)
    STEIF_FAIL(ctx, STEIF_BAD_INPUT,
               "'%s': the variable %s is cut off or damaged; save it again", path, name);
  Mat_VarFree(there);
  Mat_Close(mat);
  return v;
}

static SUNMatrix read(steif_context *ctx, const char *path, const char *name, int *found)
{
  matvar_t *v = variable(ctx, path, name, found);
  SUNMatrix M = v ? convert(ctx, path, v) : NULL;
  Mat_VarFree(v);
  return M;
}

SUNMatrix steif_matrix_read_mat(steif_context *ctx, const char *path, const char *name,
                                int *found)
{
  int unused;
  if (!found) found = &unused;
  *found = 0;
  if (!name || !*name) {
    STEIF_FAIL(ctx, STEIF_BAD_INPUT, "the name of the variable is empty; give a name");
    return NULL;
  }
  if (stf_hdf5_is(path)) return stf_hdf5_matrix(ctx, path, name, found);
  return stf_mat_check(ctx, path) ? NULL : read(ctx, path, name, found);
}

/* ---- texts ----------------------------------------------------------------------------------- */

/* A character array of at least one row and column, of one or two bytes each. */
static bool letters(const matvar_t *v)
{
  if (!v || v->class_type != MAT_C_CHAR || v->rank != 2 || !v->data) return false;
  const size_t size = Mat_SizeOf(v->data_type), rows = v->dims[0], length = v->dims[1];
  return rows && length && (size == 1 || size == 2) && v->nbytes / size / rows >= length;
}

/* Row i as UTF-8, without blanks at its end; NULL when memory is short. */
static const char *row(stf_pool *pool, const matvar_t *v, size_t i)
{
  const size_t size = Mat_SizeOf(v->data_type), length = v->dims[1], rows = v->dims[0];
  char *text = stf_pool_array(pool, 3 * length + 1, 1);
  size_t used = 0;
  for (size_t j = 0; text && j < length; j++) {
    const size_t at = j * rows + i;
    const unsigned u =
      size == 1 ? ((const uint8_t *)v->data)[at] : ((const uint16_t *)v->data)[at];
    if (u < 0x80 || size == 1) {
      text[used++] = (char)u;
    } else {
      if (u >= 0x800) text[used++] = (char)(0xe0 | u >> 12);
      text[used++] = (char)(u >= 0x800 ? 0x80 | (u >> 6 & 0x3f) : 0xc0 | u >> 6);
      text[used++] = (char)(0x80 | (u & 0x3f));
    }
  }
  while (used && text[used - 1] == ' ') used--;
  if (text) text[used] = 0;
  return text;
}

static int texts(steif_context *ctx, stf_pool *pool, const char *path, const matvar_t *v,
                 size_t *count, const char ***text)
{
  const bool cell = v->class_type == MAT_C_CELL, good = v->rank == 2 && v->data;
  STEIF_CHECK(good && (cell || v->class_type == MAT_C_CHAR), ctx, STEIF_BAD_INPUT,
              "'%s': the variable %s is neither a cell array of texts nor a character array; "
              "save {'v1', 'v2', ...}",
              path, v->name);
  *count = cell ? v->dims[0] * v->dims[1] : v->dims[0];
  if (!(*text = stf_pool_array(pool, *count, sizeof **text))) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < *count; i++) {
    const matvar_t *one = cell ? ((matvar_t *const *)v->data)[i] : v;
    const bool whole = letters(one);
    if (whole && !((*text)[i] = row(pool, one, cell ? 0 : i))) return STEIF_NO_MEMORY;
    STEIF_CHECK(whole && *(*text)[i], ctx, STEIF_BAD_INPUT,
                "'%s': entry %zu of %s is no text, or an empty one; give a name", path, i + 1,
                v->name);
  }
  return STEIF_OK;
}

int stf_input_texts(steif_context *ctx, stf_pool *pool, const char *path, const char *name,
                    size_t *count, const char ***text)
{
  int found = 0;
  *count = 0;
  *text = NULL;
  if (stf_hdf5_is(path)) return STEIF_OK; /* no names: there they are references */
  STEIF_TRY(stf_mat_check(ctx, path));
  steif_forget(ctx);
  matvar_t *v = variable(ctx, path, name, &found);
  const int code = v ? texts(ctx, pool, path, v, count, text) : steif_status(ctx);
  Mat_VarFree(v);
  return code;
}

#else

int stf_input_texts(steif_context *ctx, stf_pool *pool, const char *path, const char *name,
                    size_t *count, const char ***text)
{
  (void)pool;
  *count = 0;
  *text = NULL;
  if (stf_hdf5_is(path)) return STEIF_OK;
  return STEIF_FAIL(ctx, STEIF_UNSUPPORTED, "cannot read %s of '%s' without matio", name, path);
}

SUNMatrix steif_matrix_read_mat(steif_context *ctx, const char *path, const char *name,
                                int *found)
{
  int unused;
  if (!found) found = &unused;
  *found = 0;
  if (name && *name && stf_hdf5_is(path)) return stf_hdf5_matrix(ctx, path, name, found);
  STEIF_FAIL(ctx, STEIF_UNSUPPORTED,
             "cannot read %s of '%s': steif was built without matio; build it again with "
             "libmatio-dev installed, or write Matrix Market files",
             name ? name : "a variable", path ? path : "");
  return NULL;
}

#endif
