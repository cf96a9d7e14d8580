/* matrix.h: dense matrices from files.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef MATRIX_H
#define MATRIX_H

#include "program.h"

/* By columns; x is NULL when there is no such matrix; free it. */
struct matrix {
  long rows, columns;
  double *x;
};

/* rows, columns: what they should be, 0: anything. EXIT_OK, or the exit code after a sentence. */
int matrix_read(struct call *call, const char *path, long rows, long columns, struct matrix *M);
/* The same for the file of an option; nothing where it is not given. */
int matrix_option(struct call *call, const char *option, long rows, long columns,
                  struct matrix *M);
/* The same for a square matrix, `what` it is in its sentence. */
int matrix_square(struct call *call, const char *path, const char *what, struct matrix *M);
/* B of f = B u, C and D of y = C x + D u beside the system in the .mat file of the first word, those that it
 * has; of no such file: B of n rows from the second word. */
int matrix_ports(struct call *call, long n, struct matrix *B, struct matrix *C,
                 struct matrix *D);
/* The same, or of a .mat file, or of a model as text (.steif) that is linear: A, and E where it is not the identity; E NULL: it
 * must be. */
int matrix_system(struct call *call, const char *path, const char *what, struct matrix *A,
                  struct matrix *E);

#endif
