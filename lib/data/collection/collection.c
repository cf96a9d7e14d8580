/* collection.c: problems by name, from a spec to a filled steif_problem and back.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include "model_file.h"
#include <string.h>

const char *steif_problem_name(size_t i)
{
  return i < stf_problem_count ? stf_problem_shelf[i].name : NULL;
}

const char *steif_problem_text(size_t i)
{
  return i < stf_problem_count ? stf_problem_texts[i] : NULL;
}

static const stf_problem_entry *look_up(const char *name)
{
  for (size_t i = 0; i < stf_problem_count; i++)
    if (!strcmp(stf_problem_shelf[i].name, name)) return &stf_problem_shelf[i];
  return NULL;
}

/* The name of a parametrised problem is the whole spec, in memory of its own. */
static int build(steif_context *ctx, const char *text, const steif_spec *spec, steif_problem *p)
{
  char *name = stf_allocate(ctx, strlen(text) + 1, 1);
  p->name = name ? strcpy(name, text) : NULL;
  const int code = name ? p->build(ctx, spec, p) : STEIF_NO_MEMORY;
  if (code) steif_problem_clear(ctx, p);
  return code;
}

/* "ball.steif", "ball.steif:e=0.9,g=1.6", a path such as "./ball", or "-" for standard input: where the name of the file ends; NULL:
 * this is no file. */
static const char *end_of_file_name(const char *text)
{
  if (text[0] == '-' && (!text[1] || text[1] == ':')) return text + 1;
  static const char ending[] = ".steif";
  for (const char *at = strstr(text, ending); at; at = strstr(at + 1, ending)) {
    const char *end = at + sizeof ending - 1;
    if (!*end || *end == ':') return end;
  }
  const char *slash = strchr(text, '/'), *mark = strchr(text, ':');
  if (!slash || (mark && mark < slash)) return NULL;
  return mark ? mark : text + strlen(text);
}

static int build_file(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  return stf_model_open(ctx, self->name, spec, self);
}

/* The name is the file alone; parameters are read as of a spec. */
static int open_file(steif_context *ctx, const char *text, const char *end, steif_problem *p)
{
  steif_spec spec = {.count = 0};
  const size_t length = (size_t)(end - text);
  char *rest = *end ? stf_allocate(ctx, strlen(end) + sizeof "model", 1) : NULL;
  if (*end && !rest) return STEIF_NO_MEMORY;
  int code = rest ? steif_spec_parse(ctx, strcat(strcpy(rest, "model"), end), &spec) : STEIF_OK;
  if (rest) stf_release(ctx, rest);
  if (code) return code;
  char *name = stf_allocate(ctx, length + 1, 1);
  if (!name) return STEIF_NO_MEMORY;
  p->name = memcpy(name, text, length);
  p->build = build_file;
  p->destroy = stf_model_close;
  code = p->build(ctx, &spec, p);
  if (code) steif_problem_clear(ctx, p);
  return code;
}

int steif_problem_find(steif_context *ctx, const char *text, steif_problem *problem)
{
  steif_spec spec;
  STEIF_CHECK(problem, ctx, STEIF_BAD_INPUT, "a place for the problem is needed, got NULL");
  *problem = (steif_problem){0};
  const char *end = text ? end_of_file_name(text) : NULL;
  if (end) return open_file(ctx, text, end, problem);
  STEIF_TRY(steif_spec_parse(ctx, text, &spec));
  const stf_problem_entry *entry = look_up(spec.name);
  if (!entry) {
    char guess[STF_GUESS];
    stf_guess(spec.name, stf_problem_shelf, stf_problem_count, sizeof *stf_problem_shelf,
              guess);
    return STEIF_FAIL(ctx, STEIF_UNKNOWN_NAME,
                      "no problem is called '%s'%s 'steif list problems' shows all", spec.name,
                      *guess ? guess : ";");
  }
  if (!entry->item->build) STEIF_TRY(stf_spec_only(ctx, &spec, (const char *const[]){NULL}));
  *problem = *entry->item;
  if (problem->build) return build(ctx, text, &spec, problem);
  problem->name = entry->name;
  return STEIF_OK;
}

void steif_problem_clear(steif_context *ctx, steif_problem *problem)
{
  if (!problem) return;
  if (problem->build) {
    if (problem->destroy) problem->destroy(ctx, problem);
    stf_release(ctx, (void *)problem->name);
  }
  *problem = (steif_problem){0};
}

void *stf_collection_allocate(steif_context *ctx, steif_problem *self, size_t fixed,
                              size_t count)
{
  return self->user = stf_allocate(ctx, fixed + count * sizeof(sunrealtype), 1);
}

void stf_collection_release(steif_context *ctx, steif_problem *self)
{
  stf_release(ctx, self->user);
  self->user = NULL;
}

int stf_collection_storage(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  static const struct {
    const char *word;
    enum steif_storage storage;
  } known[] = {{"dense", STEIF_DENSE}, {"band", STEIF_BAND}, {"sparse", STEIF_SPARSE}};
  const char *word = stf_spec_word(spec, "storage");
  if (!word) return STEIF_OK;
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (!strcmp(word, known[i].word)) {
      self->storage = known[i].storage;
      return STEIF_OK;
    }
  return STEIF_FAIL(ctx, STEIF_UNKNOWN_NAME,
                    "storage=%s of '%s' is not known: choose dense, band or sparse", word,
                    spec->name);
}
