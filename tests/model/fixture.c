/* fixture.c: models from texts.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

static int open_path(fixture *s)
{
  const int code = steif_problem_find(s->ctx, s->path, &s->p);
  return code;
}

int fixture_text(fixture *s, const char *text, const char *rest)
{
  *s = (fixture){.ctx = steif_context_new(NULL)};
  CU_ASSERT_FATAL(folder_make(s->folder, sizeof s->folder) != NULL);
  snprintf(s->path, sizeof s->path, "%s/m.steif", s->folder);
  FILE *file = fopen(s->path, "w");
  CU_ASSERT_FATAL(file != NULL);
  fputs(text, file);
  fclose(file);
  const size_t length = strlen(s->path);
  snprintf(s->path + length, sizeof s->path - length, "%s", rest);
  const int code = open_path(s);
  s->path[length] = 0;
  return code;
}

int fixture_example(fixture *s, const char *spec)
{
  *s = (fixture){.ctx = steif_context_new(NULL)};
  snprintf(s->path, sizeof s->path, "%s/%s", EXAMPLES, spec);
  const int code = open_path(s);
  if (code) printf("\n  %s", steif_message(s->ctx));
  return code;
}

void fixture_close(fixture *s)
{
  steif_problem_clear(s->ctx, &s->p);
  steif_context_free(&s->ctx);
  if (!*s->folder) return;
  unlink(s->path);
  rmdir(s->folder);
}
