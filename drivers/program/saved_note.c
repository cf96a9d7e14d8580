/* saved_note.c: a call and its rows as bytes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "saved_note.h"
#include "saved_run.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Bytes that are counted, then written; or read. */
typedef struct tape {
  char *at;
  const char *from;
  size_t used, size;
  bool short_of_bytes;
} tape;

static void put(tape *t, const void *part, size_t bytes)
{
  if (t->at && bytes) memcpy(t->at + t->used, part, bytes);
  t->used += bytes;
}

static void take(tape *t, void *part, size_t bytes)
{
  t->short_of_bytes = t->short_of_bytes || bytes > t->size - t->used;
  if (t->short_of_bytes || !bytes) return;
  memcpy(part, t->from + t->used, bytes);
  t->used += bytes;
}

/* -- the call: how many arguments, each with its zero -------------------------------------------- */

static void put_text(tape *t, const char *text) { put(t, text, strlen(text) + 1); }

static void put_option(tape *t, const struct option *o, const char *text)
{
  put(t, o->name, strlen(o->name));
  if (o->kind != FLAG) put(t, "=", 1);
  put_text(t, o->kind == FLAG ? "" : text);
}

static void put_call(tape *t, const struct call *call)
{
  const int count = call->words + call->options;
  put(t, &count, sizeof count);
  for (int i = 0; i < call->words; i++) put_text(t, call->word[i]);
  for (int i = 0; i < call->options; i++)
    put_option(t, call->given[i].option, call->given[i].text);
}

/* Its next argument, or NULL. */
static const char *next_text(tape *t)
{
  const char *text = t->from + t->used;
  const size_t left = t->size - t->used, length = strnlen(text, left);
  if (length == left) return NULL;
  t->used += length + 1;
  return text;
}

/* Is it an option that is given anew, or the name of the file? */
static bool replaced(const struct call *call, const char *text)
{
  const size_t length = strcspn(text, "=");
  const char *const file = "--checkpoint";
  if (length == strlen(file) && !strncmp(text, file, length)) return true;
  for (int i = 0; i < call->options; i++) {
    const char *name = call->given[i].option->name;
    if (strlen(name) == length && !strncmp(name, text, length)) return true;
  }
  return false;
}

/* The options of this call, and the file that it goes on from and saves to. */
static void put_own(tape *t, const struct call *call)
{
  put(t, "--checkpoint=", strlen("--checkpoint="));
  put_text(t, call->word[0]);
  for (int i = 0; i < call->options; i++)
    put_option(t, call->given[i].option, call->given[i].text);
}

/* Pointers to `count` texts that stand one after another. */
static void point(char **argv, char *text, int count)
{
  for (int i = 0; i < count; i++, text += strlen(text) + 1) argv[i] = text;
}

char **saved_run_arguments(const struct call *call, const void *note, size_t bytes, int *argc)
{
  tape from = {.from = note, .size = bytes}, own = {.at = NULL};
  int count = 0;
  take(&from, &count, sizeof count);
  if (from.short_of_bytes || count < 0 || count > WORDS + GIVEN) return NULL;
  put_own(&own, call);
  const size_t pointers = (size_t)(count + call->options + 2) * sizeof(char *);
  char **argv = malloc(pointers + own.used + bytes);
  if (!argv) return NULL;
  tape to = {.at = (char *)argv + pointers};
  put_own(&to, call);
  *argc = call->options + 1;
  for (int i = 0; i < count; i++) {
    const char *text = next_text(&from);
    if (!text) return free(argv), NULL;
    if (replaced(call, text)) continue;
    put_text(&to, text);
    ++*argc;
  }
  point(argv, (char *)argv + pointers, *argc);
  return argv;
}

/* -- files ------------------------------------------------------------------------------------ */

/* FNV-1a over the bytes of a file (G. Fowler, L. C. Noll, K.-P. Vo); of none where there is no such file, or a pipe, which
 * cannot be read again. */
static uint64_t read_into(uint64_t sum, const char *path)
{
  struct stat is;
  FILE *file = !stat(path, &is) && S_ISREG(is.st_mode) ? fopen(path, "rb") : NULL;
  for (int c; file && (c = getc(file)) != EOF;) sum = (sum ^ (uint64_t)c) * 0x100000001b3u;
  if (file) fclose(file);
  return sum;
}

/* Files that a model names in quotes, tables and includes, relative to its own folder. */
static uint64_t read_named(uint64_t sum, const char *model)
{
  char path[4096], *name;
  const char *slash = strrchr(model, '/');
  const size_t folder = slash ? (size_t)(slash - model) + 1 : 0;
  FILE *file = folder < sizeof path ? fopen(model, "r") : NULL;
  if (!file) return sum;
  memcpy(path, model, folder);
  for (int c; (c = getc(file)) != EOF;) {
    if (c != '"') continue;
    for (name = path + folder; (c = getc(file)) != EOF && c != '"' && c != '\n';)
      if (name < path + sizeof path - 1) *name++ = (char)c;
    *name = 0;
    if (name > path + folder) sum = read_into(sum, path[folder] == '/' ? path + folder : path);
  }
  fclose(file);
  return sum;
}

static uint64_t read_word(uint64_t sum, const char *word)
{
  char path[4096];
  const char *end = strstr(word, ".steif");
  const size_t length = end ? (size_t)(end - word) + strlen(".steif") : strlen(word);
  if (length >= sizeof path) return sum;
  memcpy(path, word, length), path[length] = 0;
  sum = read_into(sum, path);
  return end ? read_named(sum, path) : sum;
}

/* Of words and of options that are read: --forcing, --x0, --input. */
uint64_t note_files(const struct call *call)
{
  uint64_t sum = 0xcbf29ce484222325u;
  for (int i = 0; i < call->words; i++) sum = read_word(sum, call->word[i]);
  for (int i = 0; i < call->options; i++) {
    const struct option *o = call->given[i].option;
    if (o->kind != FLAG && o->kind != OUTPUT && strcmp(o->name, "--checkpoint"))
      sum = read_into(sum, call->given[i].text);
  }
  return sum;
}

/* -- rows ------------------------------------------------------------------------------------- */

static void put_rows(tape *t, const trajectory *tr)
{
  const size_t count[] = {tr->count, tr->next, tr->events, tr->happened};
  put(t, count, sizeof count);
  put(t, tr->t, tr->count * sizeof *tr->t);
  put(t, tr->y, tr->count * tr->n * sizeof *tr->y);
  put(t, tr->event_t, tr->events * sizeof *tr->event_t);
  put(t, tr->event_which, tr->events * sizeof *tr->event_which);
  put(t, tr->event_direction, tr->events * sizeof *tr->event_direction);
  put(t, tr->event_number, tr->events * sizeof *tr->event_number);
}

static void put_note(tape *t, const trajectory *tr)
{
  put_call(t, tr->call);
  put(t, &tr->files, sizeof tr->files);
  put_rows(t, tr);
}

char *note_write(const trajectory *tr, size_t *bytes)
{
  tape t = {.at = NULL};
  put_note(&t, tr);
  *bytes = t.used;
  t = (tape){.at = malloc(t.used)};
  if (t.at) put_note(&t, tr);
  return t.at;
}

int note_read(trajectory *tr, const void *note, size_t bytes)
{
  tape t = {.from = note, .size = bytes};
  int words = 0;
  uint64_t files = 0;
  size_t count[4] = {0};
  take(&t, &words, sizeof words);
  for (int i = 0; i < words; i++)
    if (!next_text(&t)) return -1;
  take(&t, &files, sizeof files);
  if (!t.short_of_bytes && files != tr->files) return 1;
  take(&t, count, sizeof count);
  if (t.short_of_bytes || trajectory_room(tr, count[0], count[2])) return -1;
  tr->count = count[0], tr->next = count[1], tr->events = count[2], tr->happened = count[3];
  take(&t, tr->t, tr->count * sizeof *tr->t);
  take(&t, tr->y, tr->count * tr->n * sizeof *tr->y);
  take(&t, tr->event_t, tr->events * sizeof *tr->event_t);
  take(&t, tr->event_which, tr->events * sizeof *tr->event_which);
  take(&t, tr->event_direction, tr->events * sizeof *tr->event_direction);
  take(&t, tr->event_number, tr->events * sizeof *tr->event_number);
  return t.short_of_bytes ? -1 : 0;
}
