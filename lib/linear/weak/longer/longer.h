/* longer.h: runs with constant steps on E x' + F x = f in long double, by recurrences of their own: what
 * a run in double differs from them by is its rounding, whatever the run does inside.
 *
 * Served are be and bdf with every starting procedure, Runge-Kutta tables with regular A, and general linear
 * methods with one real shift. Nodes and weights of collocation are those of long double; entries of E, F, x(0-) and values of f are the
 * doubles of the run.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_LONGER_H
#define STF_LONGER_H

#include "forcing_sides.h"
#include "pairing.h"
#include "random.h"
#include <steif/impulse.h>

/* Dense square matrices by rows, factored with partial pivoting. */
typedef struct stf_long_matrix {
  int n;
  long double *a; /* n x n */
  int *pivot;     /* n */
} stf_long_matrix;
/* False: singular. */
bool stf_long_factor(stf_long_matrix *m);
void stf_long_solve(const stf_long_matrix *m, long double *x);
/* A, dense or sparse, by rows into a (n x n). */
void stf_long_entries(SUNMatrix A, int n, long double *a);
/* y += factor A x. */
void stf_long_multiply(int n, const long double *a, long double factor, const long double *x,
                       long double *y);

/* `shaken`: values of f, times and coefficients known to double only are changed by random parts of eps:
 * what they do to the result is rounding of the run, too. */
typedef struct stf_longer {
  steif_context *ctx;
  const steif_linear *linear;
  stf_sides *sides;            /* of breaks of f; NULL: none */
  const steif_problem *closed; /* for start=exact; else NULL */
  const char *method, *start;
  const sunrealtype *x0;
  int n;
  long double from, h;
  size_t steps;
  bool shaken;
  long double *state;   /* n: x at the end of the run; NULL: not wanted */
  bool continued;       /* it begins there, not at x0 */
  stf_pairing *pairing; /* is told of every node and stage */
  /* --- from here on its own --- */
  stf_random random;
  N_Vector value;
  long double *E, *F; /* n x n by rows */
} stf_longer;

/* Is there such a run of this method, and is it small enough? */
int stf_longer_serves(steif_context *ctx, const char *method, int n, bool *serves);
/* The stages of be, bdf or a table with regular A, whatever the arithmetic; 0 for other methods. */
int stf_recurrence_of(steif_context *ctx, const char *method, int *stages);
/* The run; the pairing has its sums. `random` is all zero before the first segment. */
int stf_longer_run(stf_longer *run);

/* f at a node or stage at t = (i + c) h of step i + 1 (c = 0: node i from the right) into out. */
int stf_longer_force(stf_longer *run, size_t i, long double c, long double *out);
/* A random factor 1 + eps u, |u| <= 1, of a shaken run, else 1. */
long double stf_longer_shake(stf_longer *run);
int stf_longer_multistep(stf_longer *run, int p, const char *start);
int stf_longer_stages(stf_longer *run, const char *method);
int stf_longer_general(stf_longer *run, const char *method);
/* Stage values of a general linear method with one real shift; 0: it is none. */
int stf_longer_general_serves(steif_context *ctx, const char *method, int *stages);

#endif
