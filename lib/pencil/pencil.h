/* pencil.h: the pencil room inside: one frame, four back ends of a few functions each.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PENCIL_H
#define STF_PENCIL_H

#include "base.h"
#include <steif/pencil.h>

/* A back end. It finds E, A, n and ctx in the frame and keeps its state behind p->state, of `size`
 * bytes, zeroed, allocated and released by the frame. */
typedef struct stf_backend {
  const char *name;
  size_t size;
  int (*open)(steif_pencil *p);
  int (*update)(steif_pencil *p);                      /* values (or pattern) changed */
  int (*factor)(steif_pencil *p, int slot, steif_shift s); /* may run beside other slots */
  int (*solve)(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im);
  int (*product)(steif_pencil *p, char which, N_Vector x, N_Vector out);
  void (*close)(steif_pencil *p);
} stf_backend;

extern const stf_backend stf_backend_dense, stf_backend_band, stf_backend_sparse,
  stf_backend_krylov;

struct steif_pencil {
  steif_context *ctx;
  const stf_backend *backend;
  void *state;
  sunindextype n;
  SUNMatrix E, A;            /* E NULL: identity; both NULL for operators */
  steif_operator op;
  N_Vector like;             /* operators only */
  steif_pencil_stats stats;
  int slots;                 /* slots in use */
  steif_shift shift[STEIF_PENCIL_SLOTS];
  bool fresh[STEIF_PENCIL_SLOTS];
};

#endif
