/* saved_note.h: the program's own part of a checkpoint: the call as arguments, then the rows of the trajectory.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SAVED_NOTE_H
#define SAVED_NOTE_H

#include "trajectory.h"

/* One block; NULL when memory is short. */
char *note_write(const trajectory *tr, size_t *bytes);
/* Rows and events into a trajectory just opened; nonzero when memory is short or this is no note. */
int note_read(trajectory *tr, const void *note, size_t bytes);

#endif
