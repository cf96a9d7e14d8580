/* h5.c: arrays as an HDF5 file, one data set each, through the libhdf5 of the system, which is loaded when one
 * is asked for: steif does not depend on it. Declared below are the functions of HDF5 1.10 and later, where hid_t
 * has 64 bits (HDF5 Reference Manual, H5F, H5S, H5D).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <dlfcn.h>
#include <stdint.h>
#include <string.h>

#ifndef STEIF_HDF5_PATH
#define STEIF_HDF5_PATH ""
#endif

typedef int64_t identifier; /* hid_t */

typedef struct hdf5 {
  void *handle;
  int (*open)(void), (*version)(unsigned *, unsigned *, unsigned *);
  int (*get_report)(identifier, void *, void **), (*set_report)(identifier, void *, void *);
  identifier (*create)(const char *, unsigned, identifier, identifier);
  int (*close)(identifier);
  identifier (*space)(int, const uint64_t *, const uint64_t *);
  int (*space_close)(identifier);
  identifier (*data)(identifier, const char *, identifier, identifier, identifier, identifier,
                     identifier);
  int (*write)(identifier, identifier, identifier, identifier, identifier, const void *);
  int (*data_close)(identifier);
  const identifier *real; /* H5T_NATIVE_DOUBLE */
} hdf5;

static const char *const files[] = {
  STEIF_HDF5_PATH,  "libhdf5_serial.so.103", "libhdf5_serial.so.310",
  "libhdf5.so.103", "libhdf5.so.200",        "libhdf5.so.310",
  "libhdf5.so",     "libhdf5.dylib"};
enum { FILES = sizeof files / sizeof *files, REPLACE = 2 /* H5F_ACC_TRUNC */ };

static bool take(hdf5 *h, const char *name, void *to)
{
  void *found = dlsym(h->handle, name);
  memcpy(to, &found, sizeof found);
  return found;
}

static bool functions(hdf5 *h)
{
  return take(h, "H5open", &h->open) && take(h, "H5get_libversion", &h->version) &&
         take(h, "H5Eget_auto2", &h->get_report) && take(h, "H5Eset_auto2", &h->set_report) &&
         take(h, "H5Fcreate", &h->create) && take(h, "H5Fclose", &h->close) &&
         take(h, "H5Screate_simple", &h->space) && take(h, "H5Sclose", &h->space_close) &&
         take(h, "H5Dcreate2", &h->data) && take(h, "H5Dwrite", &h->write) &&
         take(h, "H5Dclose", &h->data_close) && take(h, "H5T_NATIVE_DOUBLE_g", &h->real);
}

static bool recent(const hdf5 *h)
{
  unsigned major = 0, minor = 0, release = 0;
  h->version(&major, &minor, &release);
  return major > 1 || (major == 1 && minor >= 10);
}

/* One that the program has already, through matio perhaps: two of them would share names. What is loaded stays:
 * HDF5 leaves handlers for the end of the process behind. */
static int load(steif_context *ctx, hdf5 *h)
{
  h->handle = dlopen(NULL, RTLD_NOW);
  if (h->handle && !dlsym(h->handle, "H5open")) {
    dlclose(h->handle);
    h->handle = NULL;
  }
  for (int i = 0; i < FILES && !h->handle; i++)
    if (*files[i]) h->handle = dlopen(files[i], RTLD_NOW | RTLD_LOCAL);
  STEIF_CHECK(
    h->handle, ctx, STEIF_UNSUPPORTED,
    "no libhdf5 was found: install it (Debian: libhdf5-103-1, Fedora: hdf5), or write "
    "the arrays by --npz");
  STEIF_CHECK(
    functions(h) && recent(h) && h->open() >= 0, ctx, STEIF_UNSUPPORTED,
    "the libhdf5 that was found is older than 1.10: install a later one, or write the "
    "arrays by --npz");
  return STEIF_OK;
}

static bool write_array(const hdf5 *h, identifier file, const steif_array *a)
{
  const uint64_t size[] = {a->rows, a->columns};
  const identifier space = h->space(a->columns ? 2 : 1, size, NULL);
  const identifier data = space < 0 ? -1 : h->data(file, a->name, *h->real, space, 0, 0, 0);
  const bool good = data >= 0 && h->write(data, *h->real, 0, 0, 0, a->value) >= 0;
  if (data >= 0) h->data_close(data);
  if (space >= 0) h->space_close(space);
  return good;
}

static bool write_file(const hdf5 *h, const char *path, size_t count, const steif_array *array)
{
  const identifier file = h->create(path, REPLACE, 0, 0);
  bool good = file >= 0;
  for (size_t i = 0; good && i < count; i++) good = write_array(h, file, array + i);
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
  const bool good = write_file(&h, path, count, array);
  if (quiet) h.set_report(0, print, with);
  STEIF_CHECK(
    good, ctx, STEIF_IO,
    "HDF5 could not write \"%s\": name a file in a folder that may be written, on a disk "
    "with room",
    path);
  return STEIF_OK;
}
