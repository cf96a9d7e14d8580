/* words.c: names by open hashing.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "words.h"
#include <string.h>

static const char *const reserved[] = {
#define STF_ONE(name, text) text,
  STF_RESERVED(STF_ONE)
#undef STF_ONE
};

static size_t hash(const char *text, size_t length)
{
  uint64_t h = 1469598103934665603u;
  for (size_t i = 0; i < length; i++) h = (h ^ (unsigned char)text[i]) * 1099511628211u;
  return (size_t)(h ^ (h >> 29));
}

const char *stf_word_text(const stf_words *w, int name)
{
  return *STF_AT(w->names, const char *, name);
}

/* The slot of a name, or the free one where it belongs. */
static int32_t *slot(const stf_words *w, const char *text, size_t length)
{
  const size_t mask = w->slots.count - 1;
  for (size_t i = hash(text, length);; i++) {
    int32_t *s = STF_AT(w->slots, int32_t, i & mask);
    if (!*s) return s;
    const char *name = stf_word_text(w, *s - 1);
    if (!strncmp(name, text, length) && !name[length]) return s;
  }
}

static int widen(stf_words *w)
{
  const size_t count = w->slots.count ? 2 * w->slots.count : 256;
  stf_vector before = w->slots;
  w->slots = (stf_vector){0};
  const int code = stf_vector_resize(w->ctx, &w->slots, count, sizeof(int32_t));
  if (code) {
    w->slots = before;
    return code;
  }
  for (int i = 0; i < (int)w->names.count; i++) {
    const char *name = stf_word_text(w, i);
    *slot(w, name, strlen(name)) = i + 1;
  }
  stf_vector_free(w->ctx, &before);
  return STEIF_OK;
}

int stf_word_known(const stf_words *w, const char *text, size_t length)
{
  return *slot(w, text, length) - 1;
}

int stf_word(stf_words *w, const char *text, size_t length)
{
  if (2 * (w->names.count + 1) > w->slots.count && widen(w)) return -1;
  int32_t *s = slot(w, text, length);
  if (*s) return *s - 1;
  char *copy = stf_pool_array(w->pool, length + 1, 1);
  const char **name = copy ? stf_vector_push(w->ctx, &w->names, sizeof *name) : NULL;
  if (!name) return -1;
  memcpy(copy, text, length);
  *name = copy;
  *s = (int32_t)w->names.count;
  return *s - 1;
}

int stf_words_open(stf_words *w, steif_context *ctx, stf_pool *pool)
{
  *w = (stf_words){.ctx = ctx, .pool = pool};
  for (size_t i = 0; i < sizeof reserved / sizeof *reserved; i++)
    if (stf_word(w, reserved[i], strlen(reserved[i])) < 0) return STEIF_NO_MEMORY;
  return STEIF_OK;
}

void stf_words_close(stf_words *w)
{
  stf_vector_free(w->ctx, &w->names);
  stf_vector_free(w->ctx, &w->slots);
}
