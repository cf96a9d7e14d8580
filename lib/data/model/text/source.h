/* source.h: the texts of a model, places in them, and sentences that begin with
 * a place.
 *
 * A place is an offset into all texts one after the other, so that it fits 32
 * bits and every part of a model can carry one.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SOURCE_H
#define STF_SOURCE_H

#include "vector.h"
#include <stdint.h>

#define STF_NOWHERE UINT32_MAX
enum { STF_LARGEST_TEXT = 64 << 20, STF_ERRORS = 20, STF_TOLD = 900, STF_NAME_BYTES = 100 };

typedef struct stf_text {
  const char *name; /* as the user wrote it */
  const char *text;
  uint32_t base, length;
} stf_text;

typedef struct stf_sources {
  steif_context *ctx;
  stf_vector texts; /* of stf_text */
  bool alone;       /* expressions in t, one in a line, no model ... */
  bool pieces;      /* ... of a text with ';': "expression 2, position 5" */
  int errors, code; /* told so far; the code of the first */
  size_t used;
  char told[STF_TOLD + 1];
} stf_sources;

/* Keep "FILE:LINE:COLUMN: sentence"; returns the code. STF_NOWHERE: "FILE:
 * sentence". */
int stf_complain(stf_sources *s, uint32_t at, int code, const char *format, ...)
  STEIF_PRINTF(4, 5);
/* All that has been kept, as one failure; STEIF_OK when there is none. */
int stf_complaints(stf_sources *s);

/* A file as the next text, known by `name` in sentences; its contents live in the pool. */
int stf_source_read(stf_sources *s, stf_pool *pool, const char *path, const char *name);
/* "sub/feed.csv" in the folder of the first text or below it, in the pool; a path that leaves it is a
 * complaint at `at`. */
int stf_source_path(stf_sources *s, stf_pool *pool, uint32_t at, const char *name,
                    uint32_t length, const char **path);
/* The text in which a place lies, and the characters there. */
const stf_text *stf_text_of(const stf_sources *s, uint32_t at);
const char *stf_source_at(const stf_sources *s, uint32_t at);

/* "FILE:LINE:COLUMN", "FILE" for STF_NOWHERE. */
const char *stf_place_text(const stf_sources *s, uint32_t at, char *room, size_t size);
/* Line and column of a place, from 1; columns count characters. */
const stf_text *stf_place(const stf_sources *s, uint32_t at, int *line, int *column);
int stf_line_of(const stf_sources *s, uint32_t at);

#endif
