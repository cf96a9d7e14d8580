/* demo.h: the parts of the demonstration.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef DEMO_H
#define DEMO_H

#include "integration.h"

typedef struct demo {
  struct call *call;
  const char *folder;   /* of the pictures */
  steif_report *report; /* of the part that is running; the whole demonstration with --json */
  const char *pictures[8];
  char path[8][512];
  size_t count; /* pictures drawn */
} demo;

/* Make the folder of the pictures: EXIT_OK or an exit code after a sentence. */
int demo_open(demo *d, struct call *call);
/* The path of the next picture; it is listed at the end. */
const char *demo_picture(demo *d, const char *name);
/* Name the pictures; with --json show the whole report. */
int demo_finish(demo *d);

int demo_published(demo *d); /* published problems, digits against published solutions */
int demo_layers(demo *d);    /* index 2 to 4: lengths of the initial layer */
int demo_weak(demo *d);      /* index 2 to 4: weak convergence */
int demo_baseline(demo *d);  /* index 1 to 4: IDA in its best setting */

#endif
