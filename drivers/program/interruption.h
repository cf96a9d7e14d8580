/* interruption.h: SIGINT, SIGTERM and SIGPIPE.
 *
 * A verb that polls keeps what there is: the first signal sets the flag that runs see after a step, one
 * half a second later, or a step of half a minute, ends the program. Where nobody polls the first does so, after a sentence; what
 * was shown until then stays. Signals that the parent ignores are ignored.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef INTERRUPTION_H
#define INTERRUPTION_H

#include <stdbool.h>

/* At the start of the program; verb: its name, for the sentence. */
void interruption_open(const char *verb);
/* From here on somebody looks at the flag; it fits steif_options.stop. */
volatile int *interruption_poll(void);
/* Has a signal come? */
bool interrupted(void);
/* 128 + the number of the signal, as shells have it. */
int interruption_exit(void);

#endif
