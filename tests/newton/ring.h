/* ring.h: a small nonlinear system with a knob on its Jacobian, and its stage equations solved
 * here by full Newton in long double.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef RING_H
#define RING_H

#include "newton.h"
#include "suite.h"
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

/* Two components; f and df/dy in long double, and what the Jacobian callback is multiplied
 * by. */
typedef struct ring {
  void (*f)(long double t, const long double *y, long double *f);
  void (*jac)(long double t, const long double *y, long double J[2][2]);
  double factor, poison; /* poison: added to f_1 */
  int calls;
} ring;

extern const ring ring_nonlinear, ring_linear, ring_cubic, ring_slow;

typedef struct stage_room {
  ring r;
  steif_context *ctx;
  stf_pool *pool;
  steif_problem problem;
  steif_table *table;
  stf_system system;
  stf_newton newton;
  N_Vector y, yp, weights, *Z, *base, *offset;
  double h;
  stf_stages stages;
} stage_room;

/* Stages of the table `spec` (NULL: one stage, backward Euler) in a step of length h from (0.8,
 * -0.35) at t = 0.2; weights 1, tolerance 1e-12. */
void room_open(stage_room *s, const ring *r, const char *spec, int linear, double h);
void room_close(stage_room *s);

/* The stages in long double, s x 2 by rows. */
void room_reference(const stage_room *s, long double *Z);
/* Largest distance of the stages from them. */
double room_error(const stage_room *s);

#endif
