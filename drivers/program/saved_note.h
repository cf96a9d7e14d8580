/* saved_note.h: the program's own part of a checkpoint: the call as arguments, a sum of the files that its words
 * name, then the rows of the trajectory.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SAVED_NOTE_H
#define SAVED_NOTE_H

#include "trajectory.h"

/* One block; NULL when memory is short. */
char *note_write(const trajectory *tr, size_t *bytes);
/* What the files of a call, models and matrices, have in them, as a number. */
uint64_t note_files(const struct call *call);
/* Rows and events into a trajectory just opened; 1 when its files are others, -1 when memory is short or this is no
 * note. */
int note_read(trajectory *tr, const void *note, size_t bytes);

#endif
