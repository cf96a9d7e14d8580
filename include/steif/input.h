/* steif/input.h: matrices and forcing functions from files. The path "-" is standard input, up to 1 GB.
 *
 * Matrices: Matrix Market (coordinate or array; real, integer or pattern; general, symmetric or
 * skew-symmetric) and MATLAB version 5 files. Forcing: one expression in t per line,
 *     sin(3*t) + 2*exp(-t)          component 1
 *     step(t - 0.5) * t^2           component 2: declares a breakpoint at t = 0.5
 * with + - * / ^, numbers, t, pi, sin cos tan exp log sqrt sinh cosh tanh atan abs,
 * min(a, b), max(a, b), step(t - c) and ramp(t - c); abs, min and max of what is linear in t declare
 * their breakpoints, too. Derivatives of any order are exact, by Taylor arithmetic.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_INPUT_H
#define STEIF_INPUT_H

#include <steif/problem.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A sparse (CSC) SUNMatrix from a Matrix Market file; array files become dense matrices. NULL with
 * the message set (file, line, what was expected). SUNMatDestroy it. */
STEIF_EXPORT SUNMatrix steif_matrix_read(steif_context *ctx, const char *path);
/* Variable `name` of a MATLAB v5 file, sparse or full. *found = 0 and NULL without a message when
 * the file has no such variable. STEIF_UNSUPPORTED when built without matio. Of HDF5 files too, MATLAB's of version 7.3
 * and plain data sets by rows, through the libhdf5 of the system (STEIF_UNSUPPORTED: none is there); it is not built for
 * hostile files, so read those of people you trust. */
STEIF_EXPORT SUNMatrix steif_matrix_read_mat(steif_context *ctx, const char *path,
                                             const char *name, int *found);
/* Coordinate (sparse) or array (dense) Matrix Market file with 17 digits. */
STEIF_EXPORT int steif_matrix_write(steif_context *ctx, SUNMatrix M, const char *path);

/* E and F of a system from files of users: path_E and path_F are Matrix Market files, of E and F, or
 * with state_space = 1 of E and A (F = -A); path_F NULL: path_E is a .mat file with E and F, or E and
 * A, or F or A alone (E = I), or M, D, K and G of M q'' + D q' + K q + G^T l = f, G q = g, taken to first
 * order. The variables' names and sizes are checked. */
STEIF_EXPORT int steif_system_read(steif_context *ctx, const char *path_E, const char *path_F,
                                   int state_space, SUNMatrix *E, SUNMatrix *F);
/* B of f = B u, C and D of y = C x + D u beside them in a .mat file; *B, *C, *D NULL where there is
 * none. B, or C and D may be NULL: not wanted. B has the rows of E (of a mechanical system those of
 * M q''), C a column for each of E (of a mechanical system, whose D is the damping, of q or of
 * (q, v, l)), D one for each of B, or of f without B. */
STEIF_EXPORT int steif_input_output_read(steif_context *ctx, const char *path, SUNMatrix *B,
                                         SUNMatrix *C, SUNMatrix *D);
/* The same of matrices of one's own: C with n columns, D (NULL: none) with the rows of C and a column
 * for each input. */
STEIF_EXPORT int steif_output_check(steif_context *ctx, SUNMatrix C, SUNMatrix D,
                                    sunindextype n, sunindextype inputs);
/* y = C x + D u, as many values as C has rows; D or u NULL: 0. For the impulses of y, x = c_i. */
STEIF_EXPORT void steif_output_value(SUNMatrix C, SUNMatrix D, const sunrealtype *x,
                                     const sunrealtype *u, sunrealtype *y);

/* What the n equations and unknowns are called: of a text file with a line UNKNOWN or UNKNOWN, EQUATION
 * for each (# begins a comment), or of a .mat file with cell or character arrays `unknowns` and
 * `equations`, either of which may be missing. Of a mechanical system `unknowns` may be the names of
 * q: "x" has the velocity "x'" and the equations "velocity of x" and "motion of x"; without names
 * they are q1, v1, l1. *names NULL where the .mat file says nothing. steif_names_free it. */
STEIF_EXPORT int steif_names_read(steif_context *ctx, const char *path, sunindextype n,
                                  steif_names **names);
STEIF_EXPORT void steif_names_free(steif_names **names);

typedef struct steif_function steif_function;

/* n expressions from a file (lines; # begins a comment; fewer lines than n is an error with the
 * line number), or from one text separated by ';'. B n x m dense or sparse: f = B u with m
 * expressions; NULL: none. */
STEIF_EXPORT steif_function *steif_function_read(steif_context *ctx, const char *path,
                                                 sunindextype n, SUNMatrix B);
STEIF_EXPORT steif_function *steif_function_parse(steif_context *ctx, const char *text,
                                                  sunindextype n, SUNMatrix B);
/* Samples: a CSV file with columns t, f_1 .. f_n (with B: t, u_1 .. u_m) at equal distances;
 * derivatives at the first time by one-sided formulas over `points` samples (0: 8). *accuracy:
 * that of the derivative of order 1 there. */
STEIF_EXPORT steif_function *steif_function_samples(steif_context *ctx, const char *path,
                                                    sunindextype n, SUNMatrix B, int points,
                                                    sunrealtype *accuracy);
/* Estimated relative error of a derivative at t: the largest difference between the formulas over
 * all points and over one less, over the largest component. 0 for expressions, which are exact;
 * infinite where one point less is too few. */
STEIF_EXPORT int steif_function_accuracy(const steif_function *f, sunrealtype t, int derivative,
                                         sunrealtype *accuracy);
STEIF_EXPORT void steif_function_free(steif_function **f);

/* Fits steif_problem.g and steif_impulse_find, with the function as user data; right limits at
 * breakpoints. A derivative that some components have there and others have not, as sqrt(t) at 0, is
 * NaN in these. */
STEIF_EXPORT int steif_function_value(sunrealtype t, int derivative, N_Vector g,
                                      void *function);
/* c_j = f^(j)(t) / j!, j = 0 .. order, of the first of the expressions; nonzero where there is none: fits steif_weight with the function as user data. */
STEIF_EXPORT int steif_function_taylor(long double t, int order, long double *c,
                                       void *function);
/* u of f = B u, or f itself where there is no B: how many values, and these at t. */
STEIF_EXPORT size_t steif_function_count(const steif_function *f);
STEIF_EXPORT int steif_function_inputs(sunrealtype t, steif_function *f, sunrealtype *u);
/* Declared breakpoints inside (t0, t1), ascending; returns how many there are. */
STEIF_EXPORT size_t steif_function_breaks(const steif_function *f, sunrealtype t0,
                                          sunrealtype t1, size_t room, sunrealtype *times);

/* Is an expression smooth between its declared breakpoints? 1, or 0 where abs, min or max of what is not
 * linear in t turns within [t0, t1], seen at 1000 places; *where: shortly after the first turn. */
STEIF_EXPORT int steif_function_smooth(steif_function *f, sunrealtype t0, sunrealtype t1,
                                       sunrealtype *where);

#ifdef __cplusplus
}
#endif
#endif
