/* apart.h: a descriptor system in coordinates in which its infinite and finite part are apart.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_APART_H
#define STF_APART_H

#include "separated_parts.h"

/* It stays where it is until it is closed. */
typedef struct stf_apart {
  steif_context *ctx;
  const steif_linear *from;
  steif_linear linear; /* in z; linear.E NULL: there is none */
  int n;
  stf_decoupling maps;
  sunrealtype *z0;
  N_Vector g; /* room for a value of f */
} stf_apart;

/* Only for dense and small pencils of a decided index above 1: STEIF_OK with linear.E NULL for
 * others. */
int stf_apart_open(steif_context *ctx, const steif_linear *from,
                   const steif_structure *structure, stf_apart *apart);
void stf_apart_close(stf_apart *apart);
/* The problem in z, over the times and from the start values of one in x. */
int stf_apart_problem(stf_apart *apart, const steif_problem *given, steif_problem *problem);
/* z of x and x of z; copies where there are no coordinates. */
void stf_apart_enter(const stf_apart *apart, int n, const sunrealtype *x, sunrealtype *z);
void stf_apart_leave(const stf_apart *apart, int n, const sunrealtype *z, sunrealtype *x);
/* x_m of z. */
sunrealtype stf_apart_component(const stf_apart *apart, int m, const sunrealtype *z);

#endif
