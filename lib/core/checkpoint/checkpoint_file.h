/* checkpoint_file.h: the frame of a checkpoint: who wrote it, of what, and is it whole.
 *
 *   magic, byte order, version, sizes of numbers    32 bytes
 *   bytes of the whole file                         8
 *   identity, then the state: images (image.h)
 *   checksum of all before                          8
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CHECKPOINT_FILE_H
#define STF_CHECKPOINT_FILE_H

#include "integrator.h"
#include <steif/checkpoint.h>

enum { STF_NAME = 256, STF_SPEC = 2560, STF_REALS = 6, STF_CHOICES = 7, STF_SUMS = 4 };

/* What both sides of a continuation must agree on, and what users want to know of a file. */
typedef struct stf_identity {
  char version[16], problem[STF_NAME], spec[STF_SPEC];
  long long n;
  int form;
  sunrealtype t0, t1_opened, t, t1;
  long steps;
  bool finished, repeats;
  sunrealtype cpu_s;
  sunrealtype real[STF_REALS];      /* options that decide on steps ... */
  int choice[STF_CHOICES];          /* ... switches ... */
  unsigned long long sum[STF_SUMS]; /* ... and arrays, by checksums */
  unsigned long long fingerprint;
} stf_identity;

void stf_identity_of(steif_solver *s, stf_identity *id);
/* STEIF_BAD_INPUT names what is not that of the file. */
int stf_identity_check(steif_solver *s, const stf_identity *file);

/* All that the next steps depend on. */
void stf_solver_keep(steif_solver *s, stf_image *m);

/* A file in memory: identity and note are read, `state` stands at the rest. */
typedef struct stf_opened {
  unsigned char *bytes;
  stf_identity identity;
  const void *note;
  size_t note_bytes;
  stf_image state;
} stf_opened;

/* The whole file as bytes to be released; of a solver, and from a file. */
int stf_checkpoint_bytes(steif_solver *s, const void *note, size_t note_bytes,
                         unsigned char **bytes, size_t *count);
/* Bytes to facts, after checking that they are whole; `name` for sentences. The block belongs to *file. */
int stf_checkpoint_open(steif_context *ctx, const char *name, unsigned char *bytes,
                        size_t count, stf_opened *file);
void stf_checkpoint_close(steif_context *ctx, stf_opened *file);

/* The same without a checksum, for bytes that stay with us; and a look at them, which stay the caller's. */
int stf_checkpoint_image(steif_solver *s, unsigned char **bytes, size_t *count);
int stf_checkpoint_view(steif_context *ctx, unsigned char *bytes, size_t count,
                        stf_opened *file);
/* The solver *s, NULL: a new one, goes on from such an image. After failures *s is freed. */
int stf_checkpoint_revive(steif_context *ctx, const steif_problem *problem,
                          const steif_options *options, unsigned char *bytes, size_t count,
                          steif_solver **s);

/* disk.c: a file as one block; and a block as a file that takes its name when it is whole. */
int stf_disk_read(steif_context *ctx, const char *path, unsigned char **bytes, size_t *count);
int stf_disk_write(steif_context *ctx, const char *path, const void *bytes, size_t count);

#endif
