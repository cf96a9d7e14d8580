/* mat_hdf5.c: matrices from HDF5 files: those of MATLAB's version 7.3, where arrays stand by columns, sparse ones as a
 * group of data, ir and jc with the attribute MATLAB_sparse, the number of rows; and plain data sets of one or two
 * dimensions by rows, as h5py and steif write them. Functions of the HDF5 Reference Manual.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "hdf5.h"
#include "input.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

typedef struct hdf5 {
  void *handle;
  int (*get_report)(stf_h5, void *, void **), (*set_report)(stf_h5, void *, void *);
  stf_h5 (*open)(const char *, unsigned, stf_h5);
  int (*close)(stf_h5), (*link)(stf_h5, const char *, stf_h5);
  stf_h5 (*data)(stf_h5, const char *, stf_h5), (*space)(stf_h5), (*type)(stf_h5);
  int (*data_close)(stf_h5), (*space_close)(stf_h5), (*type_close)(stf_h5), (*kind)(stf_h5);
  int (*rank)(stf_h5), (*extent)(stf_h5, uint64_t *, uint64_t *);
  int (*read)(stf_h5, stf_h5, stf_h5, stf_h5, stf_h5, void *);
  int (*has)(stf_h5, const char *, const char *, stf_h5);
  stf_h5 (*mark)(stf_h5, const char *, const char *, stf_h5, stf_h5);
  int (*mark_read)(stf_h5, stf_h5, void *), (*mark_close)(stf_h5);
  uint64_t (*stored)(stf_h5);
  size_t (*bytes)(stf_h5);
  stf_h5 (*how)(stf_h5);
  int (*layout)(stf_h5), (*how_close)(stf_h5);
  const stf_h5 *real, *whole;
} hdf5;

/* A data set as numbers in the order of the file. */
typedef struct numbers {
  uint64_t size[2];
  sunrealtype *x; /* by stf_allocate */
} numbers;

bool stf_hdf5_is(const char *path)
{
  static const unsigned char mark[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
  unsigned char head[520] = {0};
  FILE *file = path ? fopen(path, "rb") : NULL;
  if (!file) return false;
  const size_t length = fread(head, 1, sizeof head, file);
  fclose(file);
  return (length >= 8 && !memcmp(head, mark, 8)) ||
         (length >= 520 && !memcmp(head + 512, mark, 8));
}

static int load(steif_context *ctx, hdf5 *h)
{
  STEIF_TRY(
    stf_hdf5_load(ctx, "save the matrices with '-v7' or as Matrix Market files", &h->handle));
  const struct {
    const char *name;
    void *to;
  } wanted[] = {{"H5Eget_auto2", &h->get_report},
                {"H5Eset_auto2", &h->set_report},
                {"H5Fopen", &h->open},
                {"H5Fclose", &h->close},
                {"H5Lexists", &h->link},
                {"H5Dopen2", &h->data},
                {"H5Dclose", &h->data_close},
                {"H5Dget_space", &h->space},
                {"H5Sclose", &h->space_close},
                {"H5Dget_type", &h->type},
                {"H5Tclose", &h->type_close},
                {"H5Tget_class", &h->kind},
                {"H5Sget_simple_extent_ndims", &h->rank},
                {"H5Sget_simple_extent_dims", &h->extent},
                {"H5Dread", &h->read},
                {"H5Aexists_by_name", &h->has},
                {"H5Aopen_by_name", &h->mark},
                {"H5Aread", &h->mark_read},
                {"H5Aclose", &h->mark_close},
                {"H5Dget_storage_size", &h->stored},
                {"H5Tget_size", &h->bytes},
                {"H5Dget_create_plist", &h->how},
                {"H5Pget_layout", &h->layout},
                {"H5Pclose", &h->how_close},
                {"H5T_NATIVE_DOUBLE_g", &h->real},
                {"H5T_NATIVE_INT64_g", &h->whole}};
  bool all = true;
  for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++)
    all = all && stf_hdf5_take(h->handle, wanted[i].name, wanted[i].to);
  STEIF_CHECK(
    all, ctx, STEIF_UNSUPPORTED,
    "the libhdf5 that was found lacks functions of 1.10: install a later one, or save "
    "the matrices with '-v7' or as Matrix Market files");
  return STEIF_OK;
}

/* Integers or reals, of one or two dimensions; sizes are those of the file. */
static bool measure(const hdf5 *h, stf_h5 data, uint64_t size[2])
{
  enum { INTEGER, FLOAT };
  const stf_h5 type = h->type(data), space = h->space(data);
  const int kind = type >= 0 ? h->kind(type) : -1, rank = space >= 0 ? h->rank(space) : -1;
  size[0] = size[1] = 1;
  const bool good = (kind == INTEGER || kind == FLOAT) && (rank == 1 || rank == 2) &&
                    h->extent(space, size, NULL) == rank;
  if (type >= 0) h->type_close(type);
  if (space >= 0) h->space_close(space);
  return good;
}

/* Has the file all that the sizes claim? Chunks may be compressed, by deflate to 1/1032 at most; a claim beyond that
 * of more than some megabytes is refused before there is room for it, small ones are looked at as they are read. */
static bool whole(const hdf5 *h, stf_h5 data, const uint64_t size[2])
{
  enum { CHUNKED = 2, PRESSED = 1100, SMALL = 1 << 20 };
  const stf_h5 type = h->type(data), how = h->how(data);
  const int layout = how >= 0 ? h->layout(how) : -1;
  const size_t bytes = type >= 0 ? h->bytes(type) : 0;
  const uint64_t most =
    (bytes ? h->stored(data) / bytes : 0) * (layout == CHUNKED ? PRESSED : 1);
  const bool good = (layout == CHUNKED && size[0] <= SMALL / size[1]) ||
                    (layout >= 0 && bytes && most / size[0] >= size[1]);
  if (type >= 0) h->type_close(type);
  if (how >= 0) h->how_close(how);
  return good;
}

static int read_numbers(steif_context *ctx, const hdf5 *h, stf_h5 file, const char *name,
                        numbers *v)
{
  const uint64_t most = (uint64_t)1 << 31;
  const stf_h5 data = h->data(file, name, 0);
  const bool good = data >= 0 && measure(h, data, v->size);
  const bool empty = good && !(v->size[0] && v->size[1]);
  const bool fits = good && !empty && v->size[0] < most && v->size[1] < most &&
                    v->size[0] <= ((uint64_t)1 << 40) / v->size[1];
  const bool held = fits && whole(h, data, v->size);
  int code = held ? STEIF_OK : STEIF_BAD_INPUT;
  if (held && !(v->x = stf_allocate(ctx, (size_t)(v->size[0] * v->size[1]), sizeof *v->x)))
    code = STEIF_NO_MEMORY;
  const bool complete = !code && h->read(data, *h->real, 0, 0, 0, v->x) >= 0;
  if (data >= 0) h->data_close(data);
  if (code == STEIF_NO_MEMORY) return code;
  STEIF_CHECK(good && !empty && fits, ctx, STEIF_BAD_INPUT,
              "the variable %s is %s; save a matrix of real numbers", name,
              empty  ? "empty"
              : good ? "too large"
                     : "no matrix of real numbers");
  STEIF_CHECK(
    held, ctx, STEIF_BAD_INPUT,
    "the variable %s claims %llu x %llu numbers, and the file does not hold them: it is "
    "cut off or damaged; save it again",
    name, (unsigned long long)v->size[0], (unsigned long long)v->size[1]);
  STEIF_CHECK(complete, ctx, STEIF_BAD_INPUT,
              "the variable %s is cut off or damaged; save it again", name);
  return STEIF_OK;
}

static int dense(steif_context *ctx, const hdf5 *h, stf_h5 file, const char *name, SUNMatrix *M)
{
  numbers v = {0};
  const bool by_columns = h->has(file, name, "MATLAB_class", 0) > 0;
  STEIF_CHECK(h->has(file, name, "MATLAB_empty", 0) <= 0, ctx, STEIF_BAD_INPUT,
              "the variable %s is empty; save a matrix", name);
  const int code = read_numbers(ctx, h, file, name, &v);
  const size_t rows = (size_t)v.size[by_columns], columns = (size_t)v.size[!by_columns];
  if (!code)
    *M = SUNDenseMatrix((sunindextype)rows, (sunindextype)columns, steif_sundials(ctx));
  for (size_t k = 0; *M && k < rows * columns; k++)
    SM_DATA_D((*M))[k] = v.x[by_columns ? k : k % rows * columns + k / rows];
  stf_release(ctx, v.x);
  return code ? code : *M ? STEIF_OK : STEIF_NO_MEMORY;
}

/* Columns that ascend from 0 to the number of entries, whose rows are there. */
static bool sound(const numbers *jc, const numbers *ir, const numbers *data, double rows)
{
  const size_t count = (size_t)(ir->size[0] * ir->size[1]),
               last = (size_t)(jc->size[0] * jc->size[1]) - 1;
  bool good = jc->x[0] == 0 && jc->x[last] <= (double)count && (!count || data->x) &&
              count == (size_t)(data->size[0] * data->size[1]);
  for (size_t j = 0; good && j < last; j++)
    good = jc->x[j] <= jc->x[j + 1] && jc->x[j] == floor(jc->x[j]);
  for (size_t k = 0; good && k < count; k++)
    good = ir->x[k] >= 0 && ir->x[k] < rows && ir->x[k] == floor(ir->x[k]);
  return good;
}

static int by_entries(steif_context *ctx, const char *name, int64_t rows, const numbers *jc,
                      const numbers *ir, const numbers *data, SUNMatrix *M)
{
  const size_t columns = (size_t)(jc->size[0] * jc->size[1]) - 1;
  STEIF_CHECK(
    rows > 0 && rows < ((int64_t)1 << 31) && columns > 0 && sound(jc, ir, data, (double)rows),
    ctx, STEIF_BAD_INPUT, "the variable %s is cut off or damaged; save it again", name);
  const size_t count = (size_t)jc->x[columns];
  *M = SUNSparseMatrix((sunindextype)rows, (sunindextype)columns,
                       count ? (sunindextype)count : 1, CSC_MAT, steif_sundials(ctx));
  if (!*M) return STEIF_NO_MEMORY;
  for (size_t j = 0; j <= columns; j++) SM_INDEXPTRS_S((*M))[j] = (sunindextype)jc->x[j];
  for (size_t k = 0; k < count; k++) {
    SM_INDEXVALS_S((*M))[k] = (sunindextype)ir->x[k];
    SM_DATA_S((*M))[k] = data->x[k];
  }
  return STEIF_OK;
}

static int sparse(steif_context *ctx, const hdf5 *h, stf_h5 file, const char *name,
                  SUNMatrix *M)
{
  static const char *const parts[] = {"jc", "ir", "data"};
  numbers v[3] = {{{0}, NULL}};
  int64_t rows = 0;
  char part[STEIF_SPEC_WORD + 8];
  const stf_h5 mark = h->mark(file, name, "MATLAB_sparse", 0, 0);
  const bool marked = mark >= 0 && h->mark_read(mark, *h->whole, &rows) >= 0;
  if (mark >= 0) h->mark_close(mark);
  int code =
    marked ? STEIF_OK : STEIF_FAIL(ctx, STEIF_BAD_INPUT, "the variable %s is damaged", name);
  for (int i = 0; i < 3 && !code; i++) { /* without entries there are jc alone */
    snprintf(part, sizeof part, "%.*s/%s", STEIF_SPEC_WORD - 1, name, parts[i]);
    if (i == 0 || h->link(file, part, 0) > 0) code = read_numbers(ctx, h, file, part, v + i);
  }
  if (!code) code = by_entries(ctx, name, rows, v, v + 1, v + 2, M);
  for (int i = 0; i < 3; i++) stf_release(ctx, v[i].x);
  return code;
}

static int of_file(steif_context *ctx, const hdf5 *h, const char *path, const char *name,
                   int *found, SUNMatrix *M)
{
  const stf_h5 file = h->open(path, 0, 0);
  STEIF_CHECK(file >= 0, ctx, STEIF_IO, "HDF5 cannot open '%s': it is cut off or damaged",
              path);
  int code = STEIF_OK;
  *found = h->link(file, name, 0) > 0;
  if (*found)
    code = (h->has(file, name, "MATLAB_sparse", 0) > 0 ? sparse : dense)(ctx, h, file, name, M);
  h->close(file);
  return code;
}

SUNMatrix stf_hdf5_matrix(steif_context *ctx, const char *path, const char *name, int *found)
{
  hdf5 h = {0};
  SUNMatrix M = NULL;
  void *print = NULL, *with = NULL;
  char shown[96];
  if (strlen(name) >= STEIF_SPEC_WORD || load(ctx, &h)) return NULL;
  const bool quiet = h.get_report(0, &print, &with) >= 0 && h.set_report(0, NULL, NULL) >= 0;
  int code = of_file(ctx, &h, path, name, found, &M);
  if (quiet) h.set_report(0, print, with);
  if (code == STEIF_NO_MEMORY)
    STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for %s of '%s'; make the problem smaller", name,
               path);
  snprintf(shown, sizeof shown, "the variable %.60s", name);
  if (M && stf_input_check(ctx, M, shown)) {
    SUNMatDestroy(M);
    M = NULL;
  }
  return M;
}
