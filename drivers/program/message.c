/* message.c: exit codes, sentences on stderr, the progress line.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "message.h"
#include "interruption.h"
#include <ctype.h>
#include <stdarg.h>
#include <string.h>
#include <steif/report.h>
#include <unistd.h>

int exit_of(int code)
{
  switch (code) {
  case STEIF_OK:
  case STEIF_EVENT: return EXIT_OK;
  case STEIF_BAD_INPUT:
  case STEIF_UNKNOWN_NAME: return EXIT_USAGE;
  case STEIF_IO: return EXIT_FILE;
  case STEIF_SINGULAR: return EXIT_SINGULAR;
  case STEIF_NOT_CERTIFIED: return EXIT_UNCERTIFIED;
  case STEIF_STOPPED: return interruption_exit();
  default: return EXIT_FAILED;
  }
}

/* ---- words ---- */

/* status, and message: what a failure is as JSON. */
static void object(const struct call *call, int code, const char *text)
{
  char spoken[4096];
  steif_report *r = call->json && call->ctx ? steif_report_new(call->ctx) : NULL;
  if (!r) return;
  snprintf(spoken, sizeof spoken, "%s", text);
  speak(spoken, sizeof spoken);
  steif_report_text(r, "status", steif_code_name(code));
  steif_report_text(r, "message", spoken);
  steif_report_write(r, STEIF_JSON, stdout);
  steif_report_free(&r);
}

/* The word on the command line: a run that goes on is one of solve, but it was called by resume. */
static const char *verb_called(const struct call *call)
{
  return call->continues ? "resume" : call->verb ? call->verb->name : "";
}

/* symbol: the code's, NULL where the sentence is no failure or names it itself. */
static void sentence(const struct call *call, int code, const char *symbol, const char *format,
                     va_list arguments)
{
  char text[4096];
  progress(call, NULL);
  fflush(stdout);
  vsnprintf(text, sizeof text, format, arguments);
  speak(text, sizeof text);
  fprintf(stderr, call->verb ? "steif %s: " : "steif: ", verb_called(call));
  fprintf(stderr, symbol ? "%s [%s]\n" : "%s%s\n", text, symbol ? symbol : "");
  if (symbol) object(call, code, text);
}

void say(const struct call *call, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  sentence(call, STEIF_OK, NULL, format, arguments);
  va_end(arguments);
}

int bad_usage(const struct call *call, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  sentence(call, STEIF_BAD_INPUT, "STEIF_BAD_INPUT", format, arguments);
  va_end(arguments);
  return EXIT_USAGE;
}

int unknown_name(const struct call *call, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  sentence(call, STEIF_UNKNOWN_NAME, "STEIF_UNKNOWN_NAME", format, arguments);
  va_end(arguments);
  return EXIT_USAGE;
}

int refuse(const struct call *call, int code, const char *symbol, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  sentence(call, code, symbol, format, arguments);
  va_end(arguments);
  return exit_of(code);
}

int no_memory(const struct call *call, const char *what, const char *remedy)
{
  return refuse(call, STEIF_NO_MEMORY, "STEIF_NO_MEMORY", "no memory for %s; %s", what, remedy);
}

/* Is a file of a tableau, glm:file=PATH, what the message is about? */
static bool about_table(const struct call *call, const char *message)
{
  for (int i = 0; i < call->words; i++) {
    const char *path = strstr(call->word[i], "file=");
    char name[256];
    if (!path) continue;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(path + 5, ","), path + 5);
    if (*name && strstr(message, name)) return true;
  }
  return false;
}

/* Does the message begin with this word, a model file? "ball.steif:e=0.5" or "-". Another parameter is a matter of
 * usage: "ball.steif has no parameter". */
static bool names_model(const char *word, const char *message)
{
  const char *end = strstr(word, ".steif");
  const size_t length = end ? (size_t)(end - word) + 6 : *word == '-';
  return length && !strncmp(message, word, length) && message[length] == ':';
}

static bool about_model(const struct call *call, const char *message)
{
  for (int i = 0; i < call->words; i++)
    if (names_model(call->word[i], message)) return true;
  const char *option = given(call, "--problem") ? word_of(call, "--problem") : NULL;
  return option && names_model(option, message);
}

int exit_of_run(const struct call *call, int code, const char *message)
{
  const bool input = code == STEIF_BAD_INPUT || code == STEIF_UNKNOWN_NAME;
  const bool file = (code == STEIF_BAD_INPUT && about_table(call, message)) ||
                    (input && about_model(call, message));
  return file ? EXIT_FILE : exit_of(code);
}

int fail(const struct call *call)
{
  const int code = steif_status(call->ctx);
  say(call, "%s", steif_message(call->ctx));
  object(call, code, steif_message(call->ctx));
  return code == STEIF_OK ? EXIT_FAILED : exit_of_run(call, code, steif_message(call->ctx));
}

int fail_file(const struct call *call)
{
  const int code = fail(call);
  return code == EXIT_USAGE || code == EXIT_FAILED ? EXIT_FILE : code;
}

void progress(const struct call *call, const char *format, ...)
{
  static bool shown = false;
  if (call->quiet || !isatty(STDERR_FILENO) || (!format && !shown)) return;
  fputs("\r\033[K", stderr);
  shown = format != NULL;
  if (format) {
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
  }
  fflush(stderr);
}

static bool same(char a, char b)
{
  return tolower((unsigned char)a) == tolower((unsigned char)b);
}

/* Letters of words up to 63 left out, added, changed or swapped with their neighbours. */
static int distance(const char *a, const char *b)
{
  enum { MOST = 64 };
  int rows[3][MOST + 1], *before = rows[0], *above = rows[1], *row = rows[2];
  const int m = (int)strlen(b);
  if (m > MOST) return MOST * 2;
  for (int j = 0; j <= m; j++) row[j] = j;
  for (int i = 1; a[i - 1]; i++) {
    int *const oldest = before;
    before = above, above = row, row = oldest;
    row[0] = i;
    for (int j = 1; j <= m; j++) {
      const int change = above[j - 1] + !same(a[i - 1], b[j - 1]);
      int best = above[j] < row[j - 1] ? above[j] + 1 : row[j - 1] + 1;
      const bool swapped =
        i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]);
      if (swapped && before[j - 2] + 1 < best) best = before[j - 2] + 1;
      row[j] = change < best ? change : best;
    }
  }
  return row[m];
}

const char *guess(const char *wrong, const char *(*name_at)(const void *list, size_t i),
                  const void *list, char text[GUESS])
{
  const char *best = NULL, *name;
  int least = 0;
  for (size_t i = 0; (name = name_at(list, i)); i++) {
    const int d = distance(wrong, name);
    if (!best || d < least) {
      best = name;
      least = d;
    }
  }
  const size_t letters = best && strlen(best) > strlen(wrong) ? strlen(best) : strlen(wrong);
  if (best && (size_t)least <= (letters + 3) / 3)
    snprintf(text, GUESS, "; did you mean %.64s?", best);
  else
    strcpy(text, ";");
  return text;
}
