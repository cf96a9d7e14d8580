/* reference.h: see reference.c.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef REFERENCE_H
#define REFERENCE_H

#include <steif/phi.h>

enum { REFERENCE_N = 4, REFERENCE_P = 3 };

typedef struct reference {
  const char *name;
  int n;
  double condition;
  double A[REFERENCE_N * REFERENCE_N];
  double f[REFERENCE_P + 1][REFERENCE_N * REFERENCE_N];
} reference;

extern const reference references[];
extern const int reference_count;

/* The reference whose name begins with id. */
const reference *reference_find(const char *id);
/* From rows to columns. */
void reference_turn(int n, const double *rows, double *columns);
/* ||X - Y||_1 / ||Y||_1, Y by rows. */
double reference_error(int n, const double *X, const double *rows);

#endif
