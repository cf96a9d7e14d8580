/* hdf5.c: where libhdf5 is found.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "hdf5.h"
#include <dlfcn.h>
#include <string.h>

#ifndef STEIF_HDF5_PATH
#define STEIF_HDF5_PATH ""
#endif

static const char *const files[] = {
  STEIF_HDF5_PATH,  "libhdf5_serial.so.103", "libhdf5_serial.so.310",
  "libhdf5.so.103", "libhdf5.so.200",        "libhdf5.so.310",
  "libhdf5.so",     "libhdf5.dylib"};
enum { FILES = sizeof files / sizeof *files };

bool stf_hdf5_take(void *handle, const char *name, void *to)
{
  void *found = dlsym(handle, name);
  memcpy(to, &found, sizeof found);
  return found;
}

static bool recent(void *handle)
{
  int (*open)(void), (*version)(unsigned *, unsigned *, unsigned *);
  unsigned major = 0, minor = 0, release = 0;
  if (!stf_hdf5_take(handle, "H5open", &open) ||
      !stf_hdf5_take(handle, "H5get_libversion", &version) || open() < 0)
    return false;
  version(&major, &minor, &release);
  return major > 1 || (major == 1 && minor >= 10);
}

/* One that the program has already, through matio perhaps: two of them would share names. What is loaded stays:
 * HDF5 leaves handlers for the end of the process behind. */
int stf_hdf5_load(steif_context *ctx, const char *instead, void **handle)
{
  void *found = dlopen(NULL, RTLD_NOW);
  if (found && !dlsym(found, "H5open")) {
    dlclose(found);
    found = NULL;
  }
  for (int i = 0; i < FILES && !found; i++)
    if (*files[i]) found = dlopen(files[i], RTLD_NOW | RTLD_LOCAL);
  *handle = found;
  STEIF_CHECK(found, ctx, STEIF_UNSUPPORTED,
              "no libhdf5 was found: install it (Debian: libhdf5-103-1, Fedora: hdf5), or %s",
              instead);
  STEIF_CHECK(recent(found), ctx, STEIF_UNSUPPORTED,
              "the libhdf5 that was found is older than 1.10: install a later one, or %s",
              instead);
  return STEIF_OK;
}
