/* data.h: the standard data of the tables: g = (1-t)_+^8, f_m = cos(t+m), x(0-) = (1, .., k) or the
 * smooth solution at 0. The figures of this folder were computed with 40 to 60 digits by recurrences
 * of their own (no code shared with the library) and are printed to the digits that are right.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef DATA_H
#define DATA_H

#include "weak_inside.h"
#include "suite.h"
#include <string.h>

enum { MOST = 8 };

static inline int cosines(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const int k = (int)N_VGetLength(g);
  (void)user;
  for (int m = 0; m < k; m++)
    N_VGetArrayPointer(g)[m] = cos(t + (m + 1) + derivative * acos(0.0));
  return 0;
}

/* x(0-) of the inconsistent cases. */
static const sunrealtype counting[MOST] = {1, 2, 3, 4, 5, 6, 7, 8};

/* Errors and orders of rows h, h/2, ... on "jordan:k=,case=". */
static inline int weak_rows(steif_context *ctx, const char *method, int k, const char *name,
                            enum steif_convention convention, const char *start, sunrealtype h,
                            size_t rows, steif_weak_row *row, steif_weak_result *result)
{
  char problem[48];
  snprintf(problem, sizeof problem, "jordan:k=%d,case=%s", k, name);
  const steif_weak_query query = {.method = method,
                                  .problem = problem,
                                  .convention = convention,
                                  .start = start,
                                  .h = h,
                                  .rows = rows};
  const int code = steif_weak_measure(ctx, &query, row, result);
  if (code != STEIF_OK) printf("\n  %s on %s: %s", method, problem, steif_message(ctx));
  return code;
}

#endif
