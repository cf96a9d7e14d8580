/* lu.h: all eliminations side by side: M = P L U of one matrix, or of several shifts of a pencil at once.
 *
 *   dense unrolled     n <= 16, real and complex: loops of constant length, no call of a library
 *   dense blocked      the real ones of 8 < n <= 16, by blocks of four rows (behind dense unrolled)
 *   dense bit-set      n <= 64, real, with many zeros: they are skipped, sets of rows are bits of words
 *   dense by rows      real matrices by rows, n to about 100, with transposes, products and triangles beside them
 *   dense LAPACK       all others
 *   band unblocked     kl + ku <= 24, real and complex
 *   multifrontal       sparse, real, n >= 200: dense blocks along the elimination tree
 *   multi-shift        sparse, STF_LANES complex shifts side by side with shared pivots
 *   interleaved        dense, n <= 64, all shifts of a collocation method side by side
 *   Rosenbrock         dense, n <= 8: the factors and a whole stage in registers
 * One sparse matrix at any shift is KLU's (sparse.c). Who takes which: dense.c, band.c and sparse.c for a
 * pencil; irk, rosenbrock and the analyses call theirs.
 *
 * Matrices stand by columns, entry (i, j) at i + n j, unless said otherwise. A factorisation replaces the
 * matrix and returns 0, or k when the pivot of column k, from 1, vanished.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_LU_H
#define STF_LU_H

#include "image.h"
#include "rosenbrock_data.h"
#include "simd.h"
#include <steif/pencil.h>

/* ---- dense unrolled, dense blocked -------------------------------------------------------------
 * Complex matrices are two arrays. The diagonal of the factors holds the pivots (complex: their
 * reciprocals); perm[i] is the row that became row i. */
enum {
  STF_UNROLLED = 16,
  STF_UNROLLED_PAD = 3
}; /* n; PAD: numbers after real factors that are read */
int stf_unrolled_factor(int n, double *a, int *perm);
void stf_unrolled_solve(int n, const double *lu, const int *perm, double *b);
int stf_unrolled_zfactor(int n, double *re, double *im, int *perm);
void stf_unrolled_zsolve(int n, const double *re, const double *im, const int *perm, double *br,
                         double *bi);
/* dense_transposed.c: with M^T, and with the conjugate of M^T. */
void stf_unrolled_solve_transposed(int n, const double *lu, const int *perm, double *b);
void stf_unrolled_zsolve_transposed(int n, const double *re, const double *im, const int *perm,
                                    double *br, double *bi);
/* dense_blocked.c: real, 8 < n; dense unrolled calls them. */
int stf_blocked_factor(int n, double *a, int *perm);
void stf_blocked_solve(int n, const double *lu, const int *perm, double *b);

/* ---- dense bit-set -------------------------------------------------------------------------------
 * Unknowns are taken in an order of little fill, pivots on the diagonal while they are not much smaller
 * than the largest of their column (I. S. Duff, A. M. Erisman and J. K. Reid, Direct Methods for Sparse
 * Matrices, Oxford 1986, 5.2). */
enum { STF_BITSET = 64 }; /* n */
typedef struct stf_bitset stf_bitset;
stf_bitset *stf_bitset_new(steif_context *ctx, int n); /* to be released as one block */
size_t stf_bitset_size(void);                          /* of which, without pointers */
/* Is it worth to skip the zeros of a? Orders anew when entries appear. */
bool stf_bitset_look(stf_bitset *t, const double *a);
int stf_bitset_factor(stf_bitset *t, double *a);
void stf_bitset_solve(const stf_bitset *t, const double *a, double *b);
void stf_bitset_solve_transposed(const stf_bitset *t, const double *a, double *b);

/* ---- dense by rows -------------------------------------------------------------------------------
 * Entry (i, j) at i n + j; loops along rows, for the instruction set there is. */
typedef struct stf_rows {
  /* LU in place with rows exchanged; false when a pivot is 0 or NaN. B := A^{-1} B, n x m. */
  bool (*factor)(int n, sunrealtype *A, int *pivot);
  void (*substitute)(int n, int m, const sunrealtype *A, const int *pivot, sunrealtype *B);
  /* b := A^{-T} b. */
  void (*transposed)(int n, const sunrealtype *A, const int *pivot, sunrealtype *b);
  /* R^T R = W^T W, R upper triangular; false when that is not positive. */
  bool (*squares)(int d, int m, const sunrealtype *W, sunrealtype *R);
  /* X := X R^{-1}. */
  void (*divide)(int rows, int m, const sunrealtype *R, sunrealtype *X);
} stf_rows;
const stf_rows *stf_rows_best(void);

/* ---- dense LAPACK --------------------------------------------------------------------------------
 * A X = B in place, `columns` of them; trans 'T': A^T X = B. Complex entries are pairs. */
int stf_dense_factor(int n, double *A, int *pivot);
void stf_dense_solve(char trans, int n, int columns, const double *A, const int *pivot,
                     double *B);
int stf_dense_zfactor(int n, double *A, int *pivot);

/* ---- band unblocked ------------------------------------------------------------------------------
 * Storage and pivoting are those of LAPACK's dgbtrf: entry (i, j) at kl + ku + i - j of column j,
 * ld = 2 kl + ku + 1, the multipliers below the diagonal, row j exchanged with row pivot[j]; only
 * the diagonal holds the reciprocals of the pivots. Complex entries are pairs. */
enum {
  STF_BAND_UNBLOCKED = 24
}; /* kl + ku; above, the calls of a blocked LU cost less than they gain */
typedef struct stf_band {
  sunindextype n;
  int kl, ku;
} stf_band;
sunindextype stf_band_factor(const stf_band *b, double *ab, int *pivot);
void stf_band_solve(const stf_band *b, const double *ab, const int *pivot, double *x);
sunindextype stf_band_zfactor(const stf_band *b, double *ab, int *pivot);
void stf_band_zsolve(const stf_band *b, const double *ab, const int *pivot, double *x);
/* band_transposed.c: with M^T, and with the conjugate of M^T. */
void stf_band_solve_transposed(const stf_band *b, const double *ab, const int *pivot,
                               double *x);
void stf_band_zsolve_transposed(const stf_band *b, const double *ab, const int *pivot,
                                double *x);

/* ---- multifrontal --------------------------------------------------------------------------------
 * I. S. Duff and J. K. Reid, ACM TOMS 9, 1983; J. W. H. Liu, SIAM Review 34, 1992. On the symmetric
 * pattern of M and its transpose, in an order of little fill: columns whose factors have (nearly) the
 * same rows make a front, a dense matrix over its own columns and the rows that follow, in which they
 * are eliminated; what is left is added to the front of the parent. Pivots are sought among the rows of
 * the front's own columns; a multiplier above 1000 rejects the matrix, for KLU, which pivots freely. */
enum { STF_FRONTS_COLUMNS = 2 * STF_LANES }; /* right-hand sides solved at once */
struct stf_pattern;
typedef struct stf_multifrontal stf_multifrontal;
typedef struct stf_fronts_size {
  size_t factors, pivots, stack, work; /* numbers in the arrays below */
} stf_fronts_size;
/* Symbolic, of a pattern with n < 2^31. STEIF_OK, or STEIF_NO_MEMORY without a sentence. */
int stf_multifrontal_open(steif_context *ctx, const struct stf_pattern *u,
                          stf_multifrontal **f);
void stf_multifrontal_free(steif_context *ctx, stf_multifrontal **f);
stf_fronts_size stf_multifrontal_size(const stf_multifrontal *f);
/* `value` by the entries of the pattern. False: a pivot was too small. */
bool stf_multifrontal_factor(const stf_multifrontal *f, const double *value, double *factors,
                             int *pivots, double *stack);
/* nrhs columns, ld apart, in place. */
void stf_multifrontal_solve(const stf_multifrontal *f, const double *factors, const int *pivots,
                            int nrhs, double *b, sunindextype ld, double *work);
/* The same with the transpose. */
void stf_multifrontal_solve_transposed(const stf_multifrontal *f, const double *factors,
                                       const int *pivots, int nrhs, double *b, sunindextype ld,
                                       double *work);
/* The reciprocals of the pivots of front i, `step` apart; NULL past the last front. */
const double *stf_multifrontal_pivots(const stf_multifrontal *f, const double *factors, int i,
                                      int *count, sunindextype *step);

/* ---- multi-shift ---------------------------------------------------------------------------------
 * s E - A at several complex shifts in the lanes of vector registers. They share one pattern, one order
 * and one sequence of pivots, those of a factorisation by KLU (shared_pivots.c): an entry is the real
 * parts of all lanes and then their imaginary parts, a line of cache, so that indices are read once for
 * all of them. Vectors stand in the order of the pivots: equation `equation[k]` of a right-hand side,
 * unknown `unknown[k]` of a solution at place k. A lane's results do not depend on what stands in the
 * others. */
typedef struct stf_sequence {
  int n;
  int *equation, *unknown; /* at each place */
  double growth;           /* the reciprocal pivot growth to be asked of these pivots */
} stf_sequence;
/* Of a slot of a sparse pencil that KLU has factored at a complex shift; n < 2^31. */
int stf_sequence_open(steif_pencil *p, int slot, stf_sequence **sequence);
void stf_sequence_close(stf_sequence **sequence);
/* The values of E and A, after an update of p that kept the pattern. */
void stf_sequence_fill(const steif_pencil *p, stf_sequence *sequence);

/* Right-hand sides g_0 + z g_1 + z^2 g_2 + ..., z = 1 / s, rows of n, times `scale` by equations. */
typedef struct stf_polynomial {
  int powers;             /* beside the constant */
  const double *constant; /* n */
  const double *power;    /* powers x n */
  const double *scale;    /* NULL: 1 */
} stf_polynomial;

typedef struct stf_multishift {
  const stf_sequence *sequence;
  steif_shift s[STF_LANES];
  double *l, *u, *pivot; /* factors; pivot: reciprocal diagonal of U */
  double *x, *r;         /* n each: the solution; scratch, in the end the residual */
  bool good[STF_LANES];  /* pivots were finite, not 0, and as large as was asked for */
  double growth[STF_LANES],
    log_det[STF_LANES]; /* growth: reciprocal, 1 unless asked for; 0: none */
  double
    error[STF_LANES]; /* root mean square of the rows' backward errors, when last looked at */
  int solves[STF_LANES]; /* of the last right-hand side */
  void *memory;
} stf_multishift;
int stf_multishift_open(const stf_sequence *sequence, stf_multishift *batch);
void stf_multishift_close(stf_multishift *batch);
/* Factor at the shifts s, all lanes of them, and x from g, unless it is NULL. A lane is bad
 * where a column of U exceeds that of s E - A more than 1 / growth times, by largest entries;
 * growth 0: where a pivot is 0 or not finite. */
void stf_multishift_factor(stf_multishift *batch, double growth, const stf_polynomial *g);
/* x from another g with these factors. */
void stf_multishift_solve(stf_multishift *batch, const stf_polynomial *g);
/* Up to `sweeps` steps of refinement of x, by residuals in twice the precision, while the backward error
 * is above `steady`, one anyway; sweeps 0: the error alone. */
void stf_multishift_refine(stf_multishift *batch, const stf_polynomial *g, int sweeps,
                           double steady);

/* ---- interleaved ---------------------------------------------------------------------------------
 * Simplified Newton of collocation. The shifts lambda_k / h (one per real eigenvalue and per conjugate pair
 * of A^{-1} = V Lambda V^{-1}) are the innermost index of every array, so that one pass over the matrix
 * serves all of them in vector registers; a real shift rides along with zero imaginary part.
 *   (lambda_k / h M - J) d omega_k = [V^{-1} F]_k - (lambda_k / h) M omega_k,   Z = V omega
 * with eigenvectors scaled to last component 1 (Hairer and Wanner, Solving ODEs II, IV.8). A matrix whose
 * LU is mostly zeros is eliminated in an order of little fill, its zeros skipped. */
enum {
  STF_INTERLEAVED = 64,                  /* n */
  STF_INTERLEAVED_STAGES = 4 * STF_LANES /* to which stages are padded at most */
};
typedef struct stf_interleaved {
  int n, s, wide; /* wide: stages padded to 4, 8 or 16 */
  double *Z;      /* n x wide, by components */
  double *F, *Y;  /* s x n, by stages: callbacks write and read them */
  bool whole;     /* filter keeps stiff components: by the real part */
  bool residuals; /* F holds whole residuals F - M Z'/h: nothing of omega is taken off them */
} stf_interleaved;
/* Of a transformation without coupling; M n x n by rows, NULL: identity. NULL: no memory. */
struct stf_transform;
stf_interleaved *stf_interleaved_new(stf_pool *pool, const struct stf_transform *transform,
                                     int n, const double *M);
/* LU of all shifts; J n x n by columns. */
int stf_interleaved_factor(stf_interleaved *L, const double *J, double h);
/* Z_j = sum_{k < count} a_k x_j^(k+1), omega = V^{-1} Z and Y = y + Z; a by components, `wide` each,
 * x of `wide` numbers. */
void stf_interleaved_begin(stf_interleaved *L, int count, const double *a, const double *x,
                           const double *y);
/* One Newton iteration from F: omega and Y are moved; returns sum_i weight_i^2 sum_k |d omega|^2, pairs
 * counting four times. */
double stf_interleaved_sweep(stf_interleaved *L, const double *y, const double *weight,
                             double h);
/* Z from omega. */
void stf_interleaved_end(stf_interleaved *L);
/* a_k = sum_j K[j][k] Z_j, by components. */
void stf_interleaved_keep(stf_interleaved *L, double (*K)[STF_INTERLEAVED_STAGES], double *a);
/* Factors, pattern and stages. */
void stf_interleaved_image(stf_interleaved *L, stf_image *m);
/* x = (lambda_0 / h M - J)^{-1} x, by the real shift 0; of a pair the quadratic filter or, if `whole`,
 * the real part. */
void stf_interleaved_filter(stf_interleaved *L, double *x);

/* ---- Rosenbrock ----------------------------------------------------------------------------------
 * A stage as one pass over registers,
 *   (M/(gamma h) - J) u_i = f(t + alpha_i h, Y_i) + M sum_{j<i} (c_ij/h) u_j + gamma_i h f_t,
 * and the argument of the next stage. */
enum { STF_ROSENBROCK = 8 }; /* n */
typedef struct stf_rosenbrock {
  const struct stf_rosenbrock_kernels *kernels; /* of the instruction set there is */
  int n, order[STF_ROSENBROCK];                 /* rows in the order of elimination */
  const double *M;                              /* by columns; NULL: identity */
  /* L with unit diagonal below, U divided by its diagonal above, and 1 / that diagonal. */
  double lu[STF_ROSENBROCK * STF_ROSENBROCK], pivot[STF_ROSENBROCK];
} stf_rosenbrock;
typedef struct stf_rosenbrock_stage {
  int i;
  const double *a, *c;         /* row i + 1 and row i of the tables; a NULL: Y += u_i */
  double h, slope;             /* slope: gamma_i h, 0 where f_t is not asked for */
  const double *f, *ft, *y;    /* f at Y_i; y_n */
  double *u[STF_RODAS_STAGES]; /* u_0 .. u_i */
  double *Y;
} stf_rosenbrock_stage;
void stf_rosenbrock_open(stf_rosenbrock *R, int n, const double *M);
/* LU of shift M - J. */
int stf_rosenbrock_factor(stf_rosenbrock *R, const double *J, double shift);
/* u_i, and Y of the stage after it. */
void stf_rosenbrock_solve(const stf_rosenbrock *R, const stf_rosenbrock_stage *g);

#endif
