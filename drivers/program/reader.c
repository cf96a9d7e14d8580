/* reader.c: sentences of the library name functions and members of C; who reads them here has verbs and options.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "message.h"
#include <string.h>

static const struct {
  const char *in_c, *here;
} words[] = {
  {"raise max_steps", "raise --max-steps"},
  {"max_steps = ", "--max-steps = "},
  {"max_seconds is", "--max-seconds is"},
  {"max_seconds = ", "--max-seconds = "},
  {"steps with h,", "steps with --h,"},
  {"steps with h;", "steps with --h;"},
  {"steps with h [", "steps with --h ["},
  {"prescribed steps: set h", "prescribed steps: set --h"},
  {"take an h that", "take an --h that"},
  {"give h (--h)", "give --h"},
  {"h_max = ", "--h-max = "},
  {"set options.t1", "set --t1"},
  {"raise options.run->t1", "raise --t1"},
  {"(options.initial, --initial repair)", "(--initial repair)"},
  {"compute one by steif_consistent", "'steif diagnose' computes one"},
  {"Call steif_consistent first", "Run 'steif diagnose' first"},
  {"steif_consistent finds", "'steif diagnose' finds"},
  {"steif_diagnose finds", "'steif diagnose' finds"},
  {"that steif_diagnose names", "that 'steif diagnose' names"},
};

/* Room for `to` where `from` stands; what does not fit is cut off at the end. */
static void replace(char *text, size_t room, char *at, const char *from, const char *to)
{
  const size_t out = strlen(from), in = strlen(to), rest = strlen(at + out),
               before = (size_t)(at - text);
  if (before + in >= room) return;
  const size_t most = room - 1 - before - in, kept = rest < most ? rest : most;
  memmove(at + in, at + out, kept);
  at[in + kept] = '\0';
  memcpy(at, to, in);
}

void speak(char *text, size_t room)
{
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    for (char *at = text; (at = strstr(at, words[i].in_c)); at += strlen(words[i].here)) {
      replace(text, room, at, words[i].in_c, words[i].here);
      if (strlen(at) < strlen(words[i].here)) break;
    }
  /* at the end of a sentence */
  const char *const last = "steps with h";
  const size_t length = strlen(text), tail = strlen(last);
  if (length >= tail && !strcmp(text + length - tail, last) && length + 3 <= room)
    strcpy(text + length - 1, "--h");
}
