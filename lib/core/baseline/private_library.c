/* private_library.c: libraries whose names are not those of the program.
 * SPDX-License-Identifier: BSD-3-Clause */
#define _GNU_SOURCE /* RTLD_DEEPBIND */
#include "private_library.h"
#include <dlfcn.h>
#include <string.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED 1
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#endif

/* Names inside the library are its own: by the loader's rule on macOS, where asked for with glibc. AddressSanitizer
 * ends the process at such a request. */
#if defined(SANITIZED)
enum { MODE = 0 };
#elif defined(RTLD_DEEPBIND)
enum { MODE = RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND };
#elif defined(__APPLE__)
enum { MODE = RTLD_NOW | RTLD_LOCAL };
#else
enum { MODE = 0 };
#endif

static void shut(void *handle) { dlclose(handle); }

int stf_library_open(steif_context *ctx, stf_pool *pool, const char *package, const char *file,
                     const char *path, stf_library *library)
{
  *library = (stf_library){.ctx = ctx, .package = package};
  STEIF_CHECK(*file, ctx, STEIF_UNSUPPORTED,
              "the SUNDIALS that steif was built with has no shared %s: install it and build "
              "again",
              package);
  STEIF_CHECK(MODE, ctx, STEIF_UNSUPPORTED,
              "%s has names in common with CVODE or IDA and cannot be loaded beside them, "
              "without RTLD_DEEPBIND or under AddressSanitizer",
              package);
  library->handle = dlopen(file, MODE);
  if (!library->handle) library->handle = dlopen(path, MODE);
  STEIF_CHECK(library->handle, ctx, STEIF_UNSUPPORTED,
              "%s cannot be loaded from '%s': %s; install it, or name its folder in "
              "LD_LIBRARY_PATH",
              package, file, dlerror());
  return stf_pool_adopt(pool, library->handle, shut);
}

int stf_library_function(stf_library *library, const char *name, void *function)
{
  void *found = dlsym(library->handle, name);
  STEIF_CHECK(found, library->ctx, STEIF_UNSUPPORTED, "%s has no function '%s'",
              library->package, name);
  memcpy(function, &found, sizeof found);
  return STEIF_OK;
}
