/* steif/input.h: matrices from files. The path "-" is standard input, up to 1 GB.
 *
 * Matrix Market (coordinate or array; real, integer or pattern; general, symmetric or skew-symmetric) and MATLAB
 * version 5 files. Forcing functions are those of steif/forcing.h.
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

#ifdef __cplusplus
}
#endif
#endif
