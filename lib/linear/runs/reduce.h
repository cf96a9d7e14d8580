/* reduce.h: a system of index 1 with the smooth solutions of one of any index.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_REDUCE_H
#define STF_REDUCE_H

#include "separated_parts.h"

/* It stays where it is until it is closed. */
typedef struct stf_reduced {
  steif_context *ctx;
  const steif_linear *from; /* its f and user are asked; another one may take its place */
  steif_linear linear;      /* its matrices are new; linear.E NULL: there is none */
  int n;
  stf_reduction maps;
  int slope;  /* 1: the algebraic rows are differentiated, and index 0 is left */
  N_Vector g; /* room for a value of f */
} stf_reduced;

/* Was the infinite part split off, with something to gain: index above 1 (`keeps`: above 0)? */
bool stf_reducible(const steif_structure *structure, bool keeps);
/* Only for dense and small pencils of a decided index above 1: STEIF_OK with linear.E NULL for
 * others. `keeps`: for methods that do not damp algebraic unknowns, such as Gauss's, and for index 1
 * too; f is asked for one more derivative. */
int stf_reduced_open(steif_context *ctx, const steif_linear *from,
                     const steif_structure *structure, bool keeps, stf_reduced *reduced);
void stf_reduced_close(stf_reduced *reduced);

#endif
