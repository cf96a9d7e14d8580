/* steif/jump.h: from y(t-) to y(t+) of a DAE F(t, y, y') = 0, after an event, a switch, an
 * impact.
 *
 * Let the unknowns be y = y_smooth + sum_i c_i delta^(i), and E = dF/dy', B = dF/dy frozen. As
 * in impulse.h the jump keeps the slow part and lands on all constraints, the hidden ones too:
 *   Pi_s (y(t+) - y(t-)) = 0,  Pi_s = Phi_{-1} E,    y(t+) consistent,
 *   c_i = (-1)^i (Phi_0 E)^{i+1} (y(t-) - y(t+)).
 * At index 1 this keeps E y, and algebraic unknowns jump freely. In M v' = f - G^T lambda, G v
 * = 0 it is the impact M (v(t+) - v(t-)) = -G^T Lambda with the blow Lambda as c_0 of lambda.
 *
 * Impulses of nonlinear equations have a meaning only where the matrices that multiply them do
 * not jump themselves. Two answers are found, with the matrices frozen at y(t-) and at y(t+).
 *   Equal to 10 tolerances: the jump is unique.
 *   Different: nothing in the equations decides, and both are told. All methods agree on the
 *     second whatever their steps are, which proves nothing. Unknowns in which E is constant
 *     (charges, momenta) decide.
 *   c_1 above what tolerances make of it, in equations that are not linear: positions jump, and
 *     the solution holds products of delta with what jumps. Not determined either.
 * `stages` asks for a consistent state in these cases too: positions move least, then
 * velocities for these positions (steif_consistent); velocities then stay tangential, a rule
 * and no law.
 *
 * Dense, n <= STEIF_DIAGNOSE_LARGEST; of the descriptor form any n, where f with its
 * derivatives gives the answer of steif_impulse_find.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_JUMP_H
#define STEIF_JUMP_H

#include <steif/consistent.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_jump_request {
  sunrealtype rtol;        /* of rtol (|y_j| + size_j), size as in steif_point; 0: 1e-6 */
  sunrealtype restitution; /* e in [0, 1]: what E acts on jumps 1 + e times as far, with 1 + e
                              times the impulses, G v(t+) = -e G v(t-). For e > 0 the equations
                              after an impact are others, in which the contact is open. */
  int stages;              /* 1: where the jump is not unique, y by stages */
} steif_jump_request;

typedef struct steif_jump {
  int unique;       /* 1: the equations determine the jump; 0: see the sentence */
  int index, count; /* of the frozen pencil; count = max(index - 1, 0) impulse coefficients */
  sunrealtype *y;   /* n: y(t+), matrices frozen there */
  sunrealtype *yp;  /* n: its slope; 0 where not computed (descriptor form) */
  sunrealtype *c;   /* count x n, by rows: c_0, c_1, ... */
  sunrealtype *before, *before_c; /* the same as y and c, matrices frozen at y(t-) */
  sunrealtype spread;             /* largest difference of y and `before`, in tolerances */
  char message[STEIF_SENTENCE];
  void *memory;
} steif_jump;

/* The point of the inquiry is y(t-), its slope is not needed. STEIF_OK whenever both answers
 * were found, unique or not. STEIF_SINGULAR: a frozen pencil is singular, or its index is not
 * that of the equations (matrices that turn with time); STEIF_NO_CONVERGENCE: no consistent
 * state is found along the impulses; STEIF_BAD_INPUT. request NULL: {0}. */
STEIF_EXPORT int steif_jump_find(steif_context *ctx, const steif_problem *problem,
                                 const steif_point *inquiry, const steif_jump_request *request,
                                 steif_jump *jump);
STEIF_EXPORT void steif_jump_clear(steif_jump *jump);

/* For options.reinitialise: y becomes y(t+) and yp its slope. STEIF_NOT_CERTIFIED with the sentence
 * where the jump is not unique; steif_reinitialise_stages takes the stages there. */
STEIF_EXPORT int steif_reinitialise(steif_context *ctx, const steif_problem *problem,
                                    sunrealtype t, sunrealtype rtol, N_Vector y, N_Vector yp);
STEIF_EXPORT int steif_reinitialise_stages(steif_context *ctx, const steif_problem *problem,
                                           sunrealtype t, sunrealtype rtol, N_Vector y,
                                           N_Vector yp);

#ifdef __cplusplus
}
#endif
#endif
