/* source_file.c: the files of a model: its own, and those that it names, which lie beside it or below.
 * SPDX-License-Identifier: BSD-3-Clause */
#define _XOPEN_SOURCE 700 /* realpath */
#include "source.h"
#include "text.h"
#include <limits.h>
#include <stdlib.h>
#include <string.h>

int stf_source_read(stf_sources *s, stf_pool *pool, const char *path, const char *name)
{
  FILE *file = stf_input_open(s->ctx, path);
  if (!file) return steif_status(s->ctx);
  const stf_text *last = s->texts.count ? STF_AT(s->texts, stf_text, s->texts.count - 1) : NULL;
  const uint32_t base = last ? last->base + last->length + 1 : 0;
  long size = -1;
  if (!fseek(file, 0, SEEK_END)) size = ftell(file);
  int code = STEIF_OK;
  if (size < 0 || fseek(file, 0, SEEK_SET))
    code = STEIF_FAIL(s->ctx, STEIF_IO, "cannot read '%s'; check the path", name);
  else if (size > STF_LARGEST_TEXT)
    code = STEIF_FAIL(s->ctx, STEIF_BAD_INPUT, "%s: %ld bytes; %d are the most. Use loops",
                      name, size, STF_LARGEST_TEXT);
  char *text = code ? NULL : stf_pool_array(pool, (size_t)size + 1, 1);
  stf_text *to = text ? stf_vector_push(s->ctx, &s->texts, sizeof *to) : NULL;
  if (!code && !to) code = STEIF_NO_MEMORY;
  if (!code) *to = (stf_text){name, text, base, (uint32_t)fread(text, 1, (size_t)size, file)};
  fclose(file);
  return code;
}

/* Does the path end below its first `folder` bytes, links followed? What is not there is told when it is opened. */
static bool stays(const char *path, size_t folder)
{
  char real[PATH_MAX], home[PATH_MAX], own[PATH_MAX] = ".";
  if (folder >= sizeof own) return false;
  if (folder) snprintf(own, sizeof own, "%.*s", (int)folder, path);
  if (!realpath(path, real)) return true;
  if (!realpath(own, home)) return false;
  const size_t length = strlen(home);
  return !strncmp(real, home, length) && (length == 1 || real[length] == '/');
}

int stf_source_path(stf_sources *s, stf_pool *pool, uint32_t at, const char *name,
                    uint32_t length, const char **path)
{
  const stf_text *text = s->texts.data;
  if (!strcmp(text->name, "-"))
    return stf_complain(s, at, STEIF_BAD_INPUT,
                        "'%.*s': a model from standard input has no folder and names no files; "
                        "write it into a file",
                        length < 60 ? (int)length : 60, name);
  const char *slash = strrchr(text->name, '/');
  const size_t folder = slash ? (size_t)(slash - text->name) + 1 : 0;
  char *full = stf_pool_array(pool, folder + length + 1, 1);
  if (!full) return STEIF_NO_MEMORY;
  memcpy(full, text->name, folder);
  memcpy(full + folder, name, length);
  const char *own = full + folder;
  *path = full;
  if (*own && *own != '/' && strcmp(own, "-") && strncmp(own, "..", 2) && !strstr(own, "/..") &&
      stays(full, folder))
    return STEIF_OK;
  return stf_complain(s, at, STEIF_BAD_INPUT,
                      "'%.60s' leaves the directory of the model; copy the file beside it",
                      own);
}

const char *stf_source_at(const stf_sources *s, uint32_t at)
{
  const stf_text *text = stf_text_of(s, at);
  return text->text + (at - text->base);
}
