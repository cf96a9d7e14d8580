/* text.h: files as text, and numbers in them whatever the locale is.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_TEXT_H
#define STF_TEXT_H

#include "base.h"
#include <locale.h>
#include <stdio.h>
#ifdef __APPLE__
#include <xlocale.h> /* newlocale and uselocale */
#endif

/* Numbers have a decimal point between these two, whatever the locale of the program is. */
typedef struct stf_plain {
  locale_t own, before;
} stf_plain;
int stf_plain_begin(steif_context *ctx, stf_plain *plain);
void stf_plain_end(stf_plain *plain);

/* A regular file, open to be read, or for "-" a copy of standard input; NULL with the message set. */
FILE *stf_input_open(steif_context *ctx, const char *path);
/* All of a file behind a byte order mark, ended by a zero byte; refuses zero bytes inside. stf_release it. */
char *stf_input_text(steif_context *ctx, const char *path);

/* The first bytes of a text, fit for a sentence: up to 40, unprintable ones as '?'. */
enum { STF_SHOWN = 44 };
const char *stf_input_shown(const char *text, char shown[STF_SHOWN]);

/* A line of a text of numbers has something before its end that is no comment; the line after it. */
bool stf_has_data(const char *line);
const char *stf_next_line(const char *line);

/* Lines of an open file behind a byte order mark, in order. */
enum { STF_LINE = 1000, STF_CHUNK = 1 << 15 };
typedef struct stf_lines {
  steif_context *ctx;
  const char *path;
  FILE *file;
  long number; /* of the line in text, from 1 */
  size_t at, used;
  char text[STF_LINE + 1], chunk[STF_CHUNK];
} stf_lines;
/* *more = 0 at the end of the file; text is then empty and number that of the last line. */
int stf_line_next(stf_lines *lines, int *more);

#endif
