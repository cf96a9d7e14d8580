/* matfun.h: the room of matrix functions inside.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MATFUN_H
#define STF_MATFUN_H

#include "pencil.h"
#include "twofold.h"
#include <steif/phi.h>

/* two_by_two.c: phi_0 .. phi_p at z, in the algebra a + b N, N^2 = q; p >= 1. */
typedef struct stf_spot {
  int p;
  stf_jet z, phi[STEIF_PHI_MOST + 1];
  stf_two q;
} stf_spot;

stf_two stf_inverse_factorial(int k);
void stf_spot_open(stf_spot *s, int p, stf_jet z, stf_two q);
/* From z to 2z. */
void stf_spot_double(stf_spot *s);
double stf_spot_size(const stf_spot *s);

/* balance.c: A(perm[i], perm[j]) = B(i, j) d[i]/d[j]. Rows and columns lo .. hi-1 of B are
 * full, B is triangular outside. */
typedef struct stf_scaling {
  int n, lo, hi;
  double *d;
  int *perm;
} stf_scaling;

/* A becomes B. */
void stf_balance_open(stf_scaling *b, double *A);
/* B into X, which is another array. */
void stf_balance_undo(const stf_scaling *b, const double *B, double *X);
/* E into F, as A became B. */
void stf_balance_redo(const stf_scaling *b, const double *E, double *F);
bool stf_balance_trivial(const stf_scaling *b);

/* corner.c: the part of a block triangular matrix that has a closed form, at one scale: a 1 x 1
 * block, the entry between two neighbouring ones, or a 2 x 2 block. */
enum stf_corner_kind { STF_ONE, STF_BETWEEN, STF_BLOCK };
typedef struct stf_corner {
  enum stf_corner_kind kind;
  int i;
  bool plain;        /* exponentials of 1 x 1 blocks: by the functions of the C library ... */
  double scale;      /* ... at this scale */
  double g, up, low; /* N = (M - mu I)/g */
  stf_two mu, half, q;
  stf_spot spot;
  const struct stf_corner *upper, *lower; /* STF_BETWEEN: its neighbours */
} stf_corner;

/* prepare.c: one exponential, or phi_0 .. phi_p, with all that it needs in one block of memory. */
typedef struct stf_core {
  steif_context *ctx;
  int n, p;
  double *A, *A2, *A4, *A6, *A8, *U, *V, *W; /* n^2 each; A8 is borrowed */
  double *sums;                              /* 2n */
  int *pivot;
  stf_scaling balance;
  double mu;   /* of the trace shift; 0 for p > 0 */
  double norm; /* ||A||_1, shifted */
  int m, s;    /* degree, squarings */
  int before;  /* of the s, those done before the powers were formed */
  int corners;
  stf_corner *corner;
} stf_core;

size_t stf_core_bytes(int n, int p);
void stf_core_open(stf_core *c, steif_context *ctx, int n, int p, void *memory);
/* Refuse n < 0, NULL, NaN and infinity with a sentence; `name` is that of the argument. */
int stf_check_matrix(steif_context *ctx, const char *name, int rows, int columns,
                     const double *A);
/* The same for a result, which is infinite where it overflowed. */
int stf_check_result(steif_context *ctx, const char *name, size_t count, const double *X,
                     double norm);

/* Copy A into the core, balance, look for corners, shift, choose m and s, scale the powers. */
void stf_core_prepare(stf_core *c, const double *A);
/* e^A without allocation or a check for overflow; X is not A. */
int stf_core_expm(stf_core *c, const double *A, double *X);
int stf_core_phi(stf_core *c, const double *A, double *phi);

void stf_corners_find(stf_core *c);
void stf_corners_open(stf_core *c, int s);
void stf_corners_double(stf_core *c);
/* Set those entries of X = phi_l. */
void stf_corners_fix(const stf_core *c, int l, double *X);

/* choose.c: powers of A, degree m and squarings s. */
void stf_core_choose(stf_core *c);
double stf_norm1(int n, const double *A);

/* pade.c: numerator and denominator of the [m/m] approximant to phi_l; either may be NULL. */
void stf_pade_coefficients(int m, int l, double *numerator, double *denominator);
/* Overwrites c->U by e^A, scaled and shifted back. */
int stf_pade_expm(stf_core *c);
/* The blocks of phi become phi_0 .. phi_p of the scaled matrix. */
int stf_pade_phi(stf_core *c, double *phi);

#endif
