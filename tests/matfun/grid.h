/* grid.h: matrices whose functions are known by sine bases.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef GRID_H
#define GRID_H

#include <steif/phi.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* Tridiagonal, n x n, with constant diagonals. */
SUNMatrix grid_tridiagonal(int n, double lower, double diagonal, double upper, SUNContext sun);
/* Five points on a side x side grid, unit coefficients. */
SUNMatrix grid_five_points(int side, SUNContext sun);

/* S_ik = sin(pi (i+1)(k+1)/(n+1)), S^2 = (n+1)/2 I. NULL if memory is short; free() it. */
double *grid_sines(int n);
/* x(1-x)(1 + sin 13 pi x), or numbers in (-1, 1) */
void grid_fill(int n, unsigned seed, double *v);

/* phi_k of t (n+1)^2 tridiag(1, -2, 1) times v */
void grid_heat(int n, const double *S, double t, int k, const double *v, double *w);
/* phi_k of t times the five-point matrix */
void grid_heat_2d(int side, const double *S, double t, int k, const double *v, double *w);
/* exp of t tridiag(-1, 0, 1) times v */
void grid_waves(int n, const double *S, double t, const double *v, double *w);

double grid_norm(int n, const double *v);
double grid_distance(int n, const double *v, const double *w);

#endif
