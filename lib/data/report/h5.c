/* h5.c: arrays as an HDF5 file, one data set each; texts have equal width, zeros behind them. Functions of the
 * HDF5 Reference Manual, H5F, H5S, H5D, H5T.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "hdf5.h"
#include "report.h"
#include <string.h>

enum { REPLACE = 2 /* H5F_ACC_TRUNC */, UTF8 = 1 /* H5T_CSET_UTF8 */ };

typedef struct hdf5 {
  void *handle;
  int (*get_report)(stf_h5, void *, void **), (*set_report)(stf_h5, void *, void *);
  stf_h5 (*create)(const char *, unsigned, stf_h5, stf_h5);
  int (*close)(stf_h5);
  stf_h5 (*space)(int, const uint64_t *, const uint64_t *);
  int (*space_close)(stf_h5);
  stf_h5 (*data)(stf_h5, const char *, stf_h5, stf_h5, stf_h5, stf_h5, stf_h5);
  int (*write)(stf_h5, stf_h5, stf_h5, stf_h5, stf_h5, const void *);
  int (*data_close)(stf_h5);
  stf_h5 (*type_copy)(stf_h5);
  int (*type_size)(stf_h5, size_t), (*type_set)(stf_h5, int), (*type_close)(stf_h5);
  const stf_h5 *real, *text; /* H5T_NATIVE_DOUBLE, H5T_C_S1 */
} hdf5;

static int load(steif_context *ctx, hdf5 *h)
{
  STEIF_TRY(stf_hdf5_load(ctx, "write the arrays by --npz", &h->handle));
  const bool all = stf_hdf5_take(h->handle, "H5Eget_auto2", &h->get_report) &&
                   stf_hdf5_take(h->handle, "H5Eset_auto2", &h->set_report) &&
                   stf_hdf5_take(h->handle, "H5Fcreate", &h->create) &&
                   stf_hdf5_take(h->handle, "H5Fclose", &h->close) &&
                   stf_hdf5_take(h->handle, "H5Screate_simple", &h->space) &&
                   stf_hdf5_take(h->handle, "H5Sclose", &h->space_close) &&
                   stf_hdf5_take(h->handle, "H5Dcreate2", &h->data) &&
                   stf_hdf5_take(h->handle, "H5Dwrite", &h->write) &&
                   stf_hdf5_take(h->handle, "H5Dclose", &h->data_close) &&
                   stf_hdf5_take(h->handle, "H5Tcopy", &h->type_copy) &&
                   stf_hdf5_take(h->handle, "H5Tset_size", &h->type_size) &&
                   stf_hdf5_take(h->handle, "H5Tset_cset", &h->type_set) &&
                   stf_hdf5_take(h->handle, "H5Tclose", &h->type_close) &&
                   stf_hdf5_take(h->handle, "H5T_C_S1_g", &h->text) &&
                   stf_hdf5_take(h->handle, "H5T_NATIVE_DOUBLE_g", &h->real);
  STEIF_CHECK(
    all, ctx, STEIF_UNSUPPORTED,
    "the libhdf5 that was found lacks functions of 1.10: install a later one, or write "
    "the arrays by --npz");
  return STEIF_OK;
}

static bool write_data(const hdf5 *h, stf_h5 file, const steif_array *a, stf_h5 type,
                       const void *values)
{
  const uint64_t size[] = {a->rows, a->columns};
  const stf_h5 space = h->space(a->columns ? 2 : 1, size, NULL);
  const stf_h5 data = space < 0 ? -1 : h->data(file, a->name, type, space, 0, 0, 0);
  const bool good = data >= 0 && h->write(data, type, 0, 0, 0, values) >= 0;
  if (data >= 0) h->data_close(data);
  if (space >= 0) h->space_close(space);
  return good;
}

static bool write_texts(steif_context *ctx, const hdf5 *h, stf_h5 file, const steif_array *a)
{
  size_t width = 1;
  for (size_t i = 0; i < a->rows; i++) {
    const size_t length = strlen(a->text[i]) + 1;
    if (length > width) width = length;
  }
  char *all = stf_allocate(ctx, a->rows + 1, width);
  for (size_t i = 0; all && i < a->rows; i++)
    memcpy(all + i * width, a->text[i], strlen(a->text[i]));
  const stf_h5 type = all ? h->type_copy(*h->text) : -1;
  const bool good = type >= 0 && h->type_size(type, width) >= 0 &&
                    h->type_set(type, UTF8) >= 0 && write_data(h, file, a, type, all);
  if (type >= 0) h->type_close(type);
  if (all) stf_release(ctx, all);
  return good;
}

static bool write_file(steif_context *ctx, const hdf5 *h, const char *path, size_t count,
                       const steif_array *array)
{
  const stf_h5 file = h->create(path, REPLACE, 0, 0);
  bool good = file >= 0;
  for (size_t i = 0; good && i < count; i++)
    good = array[i].text ? write_texts(ctx, h, file, array + i)
                         : write_data(h, file, array + i, *h->real, array[i].value);
  return file >= 0 && h->close(file) >= 0 && good;
}

int steif_h5_save(steif_context *ctx, const char *path, size_t count, const steif_array *array)
{
  hdf5 h = {0};
  void *print = NULL, *with = NULL;
  STEIF_CHECK(path && (array || !count), ctx, STEIF_BAD_INPUT,
              "a path and arrays are needed, one is NULL");
  STEIF_TRY(load(ctx, &h));
  const bool quiet = h.get_report(0, &print, &with) >= 0 && h.set_report(0, NULL, NULL) >= 0;
  const bool good = write_file(ctx, &h, path, count, array);
  if (quiet) h.set_report(0, print, with);
  STEIF_CHECK(
    good, ctx, STEIF_IO,
    "HDF5 could not write \"%s\": name a file in a folder that may be written, on a disk "
    "with room",
    path);
  return STEIF_OK;
}
