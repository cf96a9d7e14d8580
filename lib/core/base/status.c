/* status.c: a code's name and what to do about it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"

#define CODE(code) code, #code

static const struct {
  int code;
  const char *symbol, *name, *remedy;
} codes[] = {
  {CODE(STEIF_OK), "ok", "nothing to do"},
  {CODE(STEIF_RETRY), "retry", "a stage failed recoverably; a smaller step may succeed"},
  {CODE(STEIF_EVENT), "event",
   "nothing to do: the problem declares that this event ends the run"},
  {CODE(STEIF_NO_MEMORY), "no memory",
   "make the problem smaller or give the process more memory"},
  {CODE(STEIF_BAD_INPUT), "bad input", "correct the argument that the sentence names"},
  {CODE(STEIF_UNKNOWN_NAME), "unknown name", "list what there is with 'steif list'"},
  {CODE(STEIF_NOT_FINITE), "not finite", "look for the NaN or overflow at the place named"},
  {CODE(STEIF_SINGULAR), "singular", "check that det(s E - A) is not identically zero"},
  {CODE(STEIF_NO_CONVERGENCE), "no convergence", "make the step smaller or check the Jacobian"},
  {CODE(STEIF_CALLBACK), "callback stopped", "see what the callback objected to at that point"},
  {CODE(STEIF_UNSUPPORTED), "unsupported", "choose a method that fits the form of the problem"},
  {CODE(STEIF_STEP_LIMIT), "step limit", "raise max_steps, or loosen the tolerance"},
  {CODE(STEIF_STEP_SIZE), "step size", "loosen the tolerance, or look for a singularity there"},
  {CODE(STEIF_IO), "input or output", "check the path and the permissions"},
  {CODE(STEIF_BASELINE), "baseline failed",
   "see the sentence; the same problem may suit a steif method"},
  {CODE(STEIF_NOT_CERTIFIED), "not certified", "read the numbers as an estimate only"},
  {CODE(STEIF_TIME_LIMIT), "time limit", "raise max_seconds, or loosen the tolerance"},
  {CODE(STEIF_STOPPED), "stopped", "go on by another call, or use what was computed"},
  {CODE(STEIF_INFEASIBLE), "infeasible",
   "correct the constraint or the model, or tighten the tolerance"},
};

static size_t row(int code)
{
  const size_t count = sizeof codes / sizeof *codes;
  for (size_t i = 0; i < count; i++)
    if (codes[i].code == code) return i;
  return count;
}

const char *steif_code_name(int code)
{
  const size_t i = row(code);
  return i < sizeof codes / sizeof *codes ? codes[i].name : "unknown code";
}

const char *steif_code_symbol(int code)
{
  const size_t i = row(code);
  return i < sizeof codes / sizeof *codes ? codes[i].symbol : "unknown code";
}

const char *steif_code_remedy(int code)
{
  const size_t i = row(code);
  return i < sizeof codes / sizeof *codes ? codes[i].remedy : "";
}

#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)

const char *steif_version(void)
{
  return TEXT(STEIF_VERSION_MAJOR) "." TEXT(STEIF_VERSION_MINOR) "." TEXT(STEIF_VERSION_PATCH);
}
