/* adjoint.h: weak values of Runge-Kutta methods by their adjoint method.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef ADJOINT_H
#define ADJOINT_H

#include <steif/table.h>

/* The weak value of a Runge-Kutta method by its adjoint: h sum_n sum_i b_i X_{n,i} . w g(t_{n,i})
 * of the homogeneous block equals lambda_0 . N x0, where lambda comes from the method with
 * a^_ij = b_j a_ji / b_i run backwards over n steps h from lambda = 0 on -N^T lambda' + lambda =
 * w g. Needs b_i != 0 and A regular. */
int adjoint_value(steif_context *ctx, const steif_table *table, int k, sunrealtype h, size_t n,
                  const sunrealtype *w, const sunrealtype *x0, sunrealtype *value);

#endif
