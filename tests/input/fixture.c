/* fixture.c: the folder of the tests, made once and removed at the end.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include "folder.h"
#include <dirent.h>
#include <stdlib.h>
#include <unistd.h>

static char folder[256];

static void clean(void)
{
  DIR *d = opendir(folder);
  for (struct dirent *e; d && (e = readdir(d));)
    if (strcmp(e->d_name, ".") && strcmp(e->d_name, "..")) {
      const char *path = in_folder(e->d_name);
      if (unlink(path)) rmdir(path);
    }
  if (d) closedir(d);
  rmdir(folder);
}

const char *in_folder(const char *name)
{
  static char paths[4][400];
  static int next;
  if (!*folder) {
    if (!folder_make(folder, sizeof folder)) abort();
    atexit(clean);
  }
  char *path = paths[next++ % 4];
  snprintf(path, sizeof paths[0], "%s/%s", folder, name);
  return path;
}

const char *put_bytes(const char *name, const void *bytes, size_t size)
{
  const char *path = in_folder(name);
  FILE *file = fopen(path, "w");
  CU_ASSERT_FATAL(file != NULL);
  CHECK(fwrite(bytes, 1, size, file) == size);
  fclose(file);
  return path;
}

const char *put(const char *name, const char *text)
{
  return put_bytes(name, text, strlen(text));
}

double at(SUNMatrix M, sunindextype i, sunindextype j)
{
  if (SUNMatGetID(M) == SUNMATRIX_DENSE) return SM_ELEMENT_D(M, i, j);
  for (sunindextype k = SM_INDEXPTRS_S(M)[j]; k < SM_INDEXPTRS_S(M)[j + 1]; k++)
    if (SM_INDEXVALS_S(M)[k] == i) return SM_DATA_S(M)[k];
  return 0;
}

double ask(steif_context *ctx, steif_function *f, sunindextype n, sunindextype i, double t,
           int d)
{
  if (!f) return NAN;
  N_Vector g = N_VNew_Serial(n, steif_sundials(ctx));
  N_VConst(-77.5, g);
  const int code = steif_function_value(t, d, g, f);
  const double value = code ? NAN : NV_Ith_S(g, i);
  N_VDestroy(g);
  return value;
}
