/* reader.c: sentences of the library name functions and members of C; who reads them here has verbs and options.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "message.h"
#include <string.h>

static const struct {
  const char *in_c, *here;
} words[] = {
  {"raise max_steps", "raise --max-steps"},
  {"Raise max_steps", "Raise --max-steps"},
  {"rtol or max_steps", "rtol or --max-steps"},
  {"max_steps = ", "--max-steps = "},
  {"raise max_seconds", "raise --max-seconds"},
  {"max_seconds is", "--max-seconds is"},
  {"max_seconds = ", "--max-seconds = "},
  {"steps with h,", "steps with --h,"},
  {"steps with h;", "steps with --h;"},
  {"steps with h [", "steps with --h ["},
  {"prescribed steps: set h", "prescribed steps: set --h"},
  {"take an h that", "take an --h that"},
  {"take a larger h or", "take a larger --h or"},
  {"take a smaller h", "take a smaller --h"},
  {"take another h", "take another --h"},
  {"give h for", "give --h for"},
  {"give rtol instead", "give --rtol instead"},
  {"h_max = ", "--h-max = "},
  {"smaller h_max", "smaller --h-max"},
  {"stopped by max_seconds", "stopped by --max-seconds"},
  {"set options.t1", "set --t1"},
  {"raise options.run->t1", "raise --t1"},
  {"run longer (t1)", "run longer (--t1)"},
  {"raise options.evaluations", "raise --evaluations"},
  {"the linear scale (options.scale)", "the linear scale (--linear)"},
  {"name fewer in options.active", "name fewer with --parameters"},
  {"take a gradient (gradient.h)", "take a gradient (--adjoint)"},
  {"raise .memory or set .folder", "raise --memory"},
  {"or raise .memory", "or raise --memory"},
  {"raise .memory", "raise --memory"},
  {"ask for fewer .checkpoints or raise", "raise"},
  {"(options.initial = STEIF_REPAIR)", "(--initial repair)"},
  {"options.initial = STEIF_CHECK", "--initial check"},
  {"options.initial = STEIF_AS_GIVEN", "--initial given"},
  {"compute one by steif_consistent", "'steif diagnose' computes one"},
  {"Call steif_consistent first, or take the method", "Take the method"},
  {"Call steif_consistent first",
   "Adaptive steps of a method of steif repair it (--initial repair)"},
  {"steif_consistent finds such", "'steif diagnose' shows such"},
  {"steif_diagnose finds", "'steif diagnose' finds"},
  {"that steif_diagnose names", "that 'steif diagnose' names"},
  {"find x(0+) first (steif_linear_run)", "let steps begin at x(0+), without --layers"},
  {"set .invariants and .invariant", "a model declares one by 'invariant'"},
  {"is not declared separable: set .positions, or take", "is not declared separable: take"},
  {"make the step smaller or check the Jacobian", "make the step smaller"},
  {"check the Jacobian, or take", "take"},
  {"; check the Jacobian", "; loosen the tolerance or take another method"},
  {"the callbacks returned NaN", "its equations gave NaN"},
  {"The solution leaves .constraint here", "The solution leaves its constraint here"},
  {"correct the value or .constraint", "correct the value or the constraint"},
  {"give yp0; try ida:", "try ida:"},
  {"give better y0 and yp0, or use", "use"},
  {"Give better y0 and yp0", "Use a method of steif"},
  {"Check the Jacobian callback; if", "If"},
  {"Check the Jacobian callback and its pattern", "Use a method of steif"},
  {"Check the Jacobian callback, or use a direct solver",
   "Use a method of steif, or leave --storage out"},
  {"check dF/dy + c dF/dy' against differences, or use", "or use"},
  {"Check df/dy against differences; with", "Use a method of steif; with"},
  {"ask for those nearest to a point", "--count N and --near S ask for the N nearest to S"},
  {"(.h = ", "(--h "},
  {", .rows = 5)", " --halvings 4)"},
  {"; .h = ", "; --h "},
  {"(.h)", "(--h)"},
  {"(.g->t1)", "(--t1)"},
  {"(.rows)", "(--halvings)"},
  {"(.breaks)", "(--breaks)"},
  {"(.restart)", "(--restart)"},
  {"(.start = \"cq\")", "(--start cq)"},
  {".start = \"cq\"", "--start cq"},
  {"or set .exact", "or --exact"},
  {"or .exact", "or --exact"},
  {"leave .exact out", "leave --exact out"},
  {"such as (1 - t)^", "such as --g power:n="},
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
