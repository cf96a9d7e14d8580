/* steif/impulse.h: structure of a descriptor system and its start from any x(0-).
 *
 * E x' + F x = f(t) with a regular pencil (det(s E + F) not identically zero) has for every x(0-) one
 * solution in the sense of distributions,
 *   x = x_smooth + sum_{i=0}^{k-2} c_i delta^(i),   k the index.
 * With the Laurent expansion (s E + F)^{-1} = sum_{i <= k-1} Phi_i s^i at infinity
 *   x(0+) = Phi_{-1} E x(0-) + sum_{j=0}^{k-1} Phi_j f^(j)(0+)
 *   c_i   = Phi_i E x(0-) + sum_{j=0}^{k-2-i} Phi_{i+j+1} f^(j)(0+),   i = 0 .. k-2.
 * Only E x(0-) enters. Checks: E c_{k-2} = 0, F c_i + E c_{i-1} = 0, F c_0 + E (x(0+) - x(0-)) = 0.
 *
 * Dense pencils: singular-value staircase at infinity with tolerances that grow with what was
 * divided by, checked by a generalised Schur form with exactly as many infinite eigenvalues split
 * off. Sparse pencils: Cauchy integrals over a circle of radius R beyond the finite eigenvalues,
 * equilibrated, four nodes at a time in vector registers with the pivots of one complex
 * factorisation by KLU, refined where residuals ask; certified when the number of finite
 * eigenvalues counted inside the circle (Jensen's formula) equals the structural degree, or what is
 * left of it where entries cancel exactly: ranks modulo two random primes near 2^62 tell, which also
 * decide whether a pencil is singular.
 * What double precision does not decide is reported as undecided with a lower bound, never guessed.
 * Units of equations and unknowns decide nothing, whatever their sizes: rows and columns are scaled
 * by powers of two so that all entries come near to one size, where that is possible.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_IMPULSE_H
#define STEIF_IMPULSE_H

#include <steif/pencil.h>
#include <steif/problem.h>

#ifdef __cplusplus
extern "C" {
#endif

enum steif_algorithm {
  STEIF_AUTOMATIC, /* staircase up to n = 400 when dense or small, contour where that is not certified;
                      else contour */
  STEIF_STAIRCASE, /* dense, checked by STEIF_QZ */
  STEIF_QZ,        /* dense, generalised Schur form reordered */
  STEIF_CONTOUR    /* sparse */
};

typedef struct steif_analysis {
  enum steif_algorithm algorithm;
  sunrealtype radius; /* of the circle; 0: raised until the count equals the degree */
  int points;         /* of the quadrature; 0: 16 */
  int refinements;    /* of each solve, at most, where residuals ask; 0: 2; -1: none */
  int index_most;     /* largest index looked for; 0: 8 */
  unsigned seed;      /* of the random directions; 0: 1 */
  int snap;           /* exact ranks take a diagonal entry of E or F that is within 4 units in
                               the last place of the negative sum of its row for that sum: what
                               assembling 0.1 + 0.2 has rounded. 0: entries are what they are */
  const steif_names *names; /* for sentences, which count from 1; NULL: numbers only */
} steif_analysis;

/* What was found. Lists are owned by the structure. */
typedef struct steif_structure {
  sunindextype n, rank_E; /* rank_E -1: not computed (circles: see steif_structure_ranks) */
  int regular;            /* 1, 0 */
  int index;              /* -1: undecided, then index_least is a lower bound */
  int index_least;
  sunindextype finite, infinite; /* eigenvalues; -1: undecided */
  sunindextype
    degree; /* structural: maximum-weight perfect matching; -1: no perfect matching */
  sunindextype
    exact; /* finite eigenvalues of the entries exactly as given, by ranks modulo two random
                         primes near 2^62; -1: not computed, as where the count equals the degree */
  sunrealtype
    doubt; /* a bound of the probability that `exact` is wrong, both primes being unlucky */
  sunrealtype count; /* finite eigenvalues by Jensen's formula; NaN: not computed */
  int weyr_count;    /* Weyr characteristic at infinity; 0: not computed, or index 0 */
  sunindextype *weyr;
  sunrealtype gap;   /* ratio of the singular values or moments that decide the index */
  sunrealtype rcond; /* best reciprocal condition of equilibrated s E + F tried */
  sunrealtype
    resolution;       /* finite eigenvalues beyond it would pass for infinite: where the pattern
                               alone does not rule them out, rounding of the entries given hides them
                               (dense), or the circle (sparse); INFINITY: there are none */
  sunrealtype radius; /* estimate of the largest finite |eigenvalue|, or the radius used */
  int certified; /* of a regular pencil: finite eigenvalues are those up to `resolution`, what
                               is below rounding of the entries given is taken for 0; of a singular
                               one: det(s E + F) = 0 exactly as given */
  const char *method; /* "staircase", "qz", "contour" */
  sunindextype equations_count,
    unknowns_count; /* offenders, 0-based, when singular or index > 1 */
  sunindextype *equations, *unknowns;
  steif_pencil_stats cost; /* of the sparse algorithms: complex shifts of circles */
  struct stf_kept *kept;   /* factors for steif_impulse_find of the same matrices */
  char message[512];
} steif_structure;

/* E and F: dense or sparse (CSC), square, of one size; a dense one and a sparse one may be mixed.
 * Returns STEIF_OK when the analysis could be made, whatever it found: also for singular pencils. */
STEIF_EXPORT int steif_structure_find(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                                      const steif_analysis *analysis,
                                      steif_structure *structure);
STEIF_EXPORT void steif_structure_clear(steif_context *ctx, steif_structure *structure);
/* What circles leave open of a structure they found: rank_E, and the Weyr characteristic where it
 * agrees with their index and count. Ranks are those of the numbers exactly as given, by elimination
 * over a prime field, of E and of matrices of up to index + 1 times its order; rank_E stays -1 where
 * the factors would grow 64 times as large as that. E and F: the same again. */
STEIF_EXPORT int steif_structure_ranks(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                                       steif_structure *structure);

typedef struct steif_impulse {
  sunindextype n;
  int index, count;    /* count = max(index - 1, 0) impulse coefficients */
  sunrealtype *x_plus; /* n */
  sunrealtype *c;      /* count x n, by rows: c_0, c_1, ... */
  sunrealtype last, chain,
    first;                /* residuals ||E c_{k-2}||, max ||F c_i + E c_{i-1}||, ||F c_0 +
                               E (x+ - x-)||, each relative to the norms of its terms
                               (the first to max |E| ||c_{k-2}|| or, where larger, max |E|^2 /
                               max |F| times the norm of c_{k-3} or x- - x+) */
  sunrealtype resolution; /* of the structure: valid for time scales from 1 / resolution on */
  sunrealtype
    estimate; /* of the error of x_plus, in the units given, relative to its norm, or to a thousandth of
                 what E x(0-) and f stand for where that is larger, so that 0 is as good as any: two
                 radii, or two algorithms and four times what changes of all entries and of x(0-) in
                 the last place make of x_plus, the larger; at least what it is in even units */
  sunrealtype radius; /* of the circle that x_plus and c are from; 0: of none */
  int certified;
  const char *method;
  steif_pencil_stats cost; /* of the sparse algorithms */
  char message[512];
} steif_impulse;

/* x0: n values x(0-). f: forcing at time t with derivatives up to index - 1 (NULL: f = 0); a missing
 * derivative is STEIF_BAD_INPUT. structure: of steif_structure_find, or NULL to find it here.
 * STEIF_SINGULAR for a singular pencil; STEIF_NOT_CERTIFIED never: see certified. */
STEIF_EXPORT int steif_impulse_find(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                                    const sunrealtype *x0, sunrealtype t, steif_forcing f,
                                    void *user, const steif_analysis *analysis,
                                    const steif_structure *structure, steif_impulse *impulse);
STEIF_EXPORT void steif_impulse_clear(steif_context *ctx, steif_impulse *impulse);

/* slow = Pi_s x with Pi_s = Phi_{-1} E, n values each, by any algorithm; Pi_f x = x - Pi_s x. structure
 * as above. */
STEIF_EXPORT int steif_projector_apply(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                                       const steif_analysis *analysis,
                                       const steif_structure *structure, const sunrealtype *x,
                                       sunrealtype *slow);
/* All of Pi_s into P, n x n by columns: dense algorithms only, else STEIF_UNSUPPORTED. */
STEIF_EXPORT int steif_projector_find(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                                      const steif_analysis *analysis, sunrealtype *P);

/* E x' + F x = f(t). The matrices and what `user` points to outlive every use. */
typedef struct steif_linear {
  SUNMatrix E, F;  /* dense or both sparse (CSC) */
  steif_forcing f; /* NULL: 0 */
  void *user;
} steif_linear;

/* The matrices of a problem of the descriptor form: E, F = -A and g. linear->E and linear->F are new:
 * SUNMatDestroy them. */
STEIF_EXPORT int steif_linear_of(steif_context *ctx, const steif_problem *problem,
                                 steif_linear *linear);
/* A problem on [t0, t1] that starts at x0 (n values, kept by the caller), for steif_solver_new. */
STEIF_EXPORT int steif_linear_problem(steif_context *ctx, const steif_linear *linear,
                                      const sunrealtype *x0, sunrealtype t0, sunrealtype t1,
                                      steif_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
