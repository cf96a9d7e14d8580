/* scipy.c: SciPy in a process of its own, if there is one.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "benchmarks.h"
#include <stdlib.h>

#define COMMAND                                                                                \
  "for p in python3 /usr/bin/python3; do $p -c 'import scipy.linalg' 2>/dev/null && "          \
  "exec $p -c \"$STEIF_SCRIPT\" \"$STEIF_ARGUMENT\"; done; exit 1"

FILE *scipy_ask(const char *script, const char *argument)
{
  setenv("STEIF_SCRIPT", script, 1);
  setenv("STEIF_ARGUMENT", argument, 1);
  return popen(COMMAND, "r");
}

void scipy_missing(struct call *call, const char *column)
{
  say(call, "no SciPy to compare with: install python3-scipy (Debian) for the column %s",
      column);
}
