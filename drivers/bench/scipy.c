/* scipy.c: SciPy in a process of its own, if there is one.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "benchmarks.h"
#include <stdlib.h>

/* A process whose parent has gone has nobody to answer. */
#define WATCH                                                                                  \
  "import os, threading, time\n"                                                               \
  "def watch(parent):\n"                                                                       \
  "    while os.getppid() == parent: time.sleep(0.2)\n"                                        \
  "    os._exit(1)\n"                                                                          \
  "threading.Thread(target=watch, args=(os.getppid(),), daemon=True).start()\n"

#define COMMAND                                                                                \
  "for p in python3 /usr/bin/python3; do $p -c 'import scipy.linalg' 2>/dev/null && "          \
  "exec $p -c \"$STEIF_WATCH$STEIF_SCRIPT\" \"$STEIF_ARGUMENT\"; done; exit 1"

FILE *scipy_ask(const char *script, const char *argument)
{
  setenv("STEIF_WATCH", WATCH, 1);
  setenv("STEIF_SCRIPT", script, 1);
  setenv("STEIF_ARGUMENT", argument, 1);
  return popen(COMMAND, "r");
}

void scipy_missing(struct call *call, const char *column)
{
  say(call, "no SciPy to compare with: install python3-scipy (Debian) for the column %s",
      column);
}
