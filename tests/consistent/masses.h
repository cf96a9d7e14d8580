/* masses.h: E = diag(1, 1, 0, ..), of problems whose first two components have derivatives.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef MASSES_H
#define MASSES_H

#include <sunmatrix/sunmatrix_dense.h>

static inline int two_derivatives(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E,
                                  void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = SM_ELEMENT_D(E, 1, 1) = 1;
  return 0;
}

#endif
