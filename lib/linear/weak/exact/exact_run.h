/* exact_run.h: runs with constant steps on E x' + F x = f in many digits, paired with a spline. Entries of E
 * and F, x(0-) and h are the doubles they are, values of f those of double; nothing else is rounded
 * where it could be seen. Rational arithmetic would serve polynomials f alone, and its numbers grow with
 * every step as soon as there is a finite eigenvalue.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_EXACT_RUN_H
#define STF_EXACT_RUN_H

#include "integrals.h"
#include "longer.h"
#include "spline.h"

typedef struct stf_exact_run {
  stf_longer of; /* what is run, and its values of f; of.pairing is not used */
  int limbs;
  const stf_spline *g;      /* NULL: nothing is paired */
  stf_integrals *integrals; /* NULL: not wanted */
  enum steif_convention convention;
  bool solved; /* as in stf_pairing */
  int ends;    /* as in stf_pairing */
  stf_real h;
  stf_real *sum;   /* n: <x_h, g> is added */
  stf_real *state; /* n: as `state` of stf_longer, which is not used */
  /* --- from here on its own --- */
  stf_real from, before; /* before: int_0^t g at the last node */
  stf_real *E, *F;       /* n x n by rows */
  long double *f;        /* n */
} stf_exact_run;

/* Digits that such a run takes at the index. */
int stf_exact_limbs(int index, size_t steps);
int stf_exact_run_make(stf_exact_run *run);

/* x to begin with, and at the end. */
void stf_exact_begin(const stf_exact_run *run, stf_real *x);
void stf_exact_end(stf_exact_run *run, const stf_real *x);
/* f at from + (i + c) h into out. */
int stf_exact_force(stf_exact_run *run, size_t i, long double c, stf_real *out);
/* Pair node i; pair a stage at from + (i + c) h with weight b. */
void stf_exact_node(stf_exact_run *run, size_t i, const stf_real *x);
void stf_exact_stage(stf_exact_run *run, size_t i, const stf_real *c, const stf_real *b,
                     const stf_real *X);
/* Gregory's weight i of order p. */
stf_real stf_exact_gregory(int limbs, int p, size_t i);
int stf_exact_multistep(stf_exact_run *run, int p, const char *start);
int stf_exact_stages(stf_exact_run *run);

#endif
