/* space.h: vector kernels. Serial vectors, and components of parallel ones, run through loops on their arrays,
 * any other N_Vector and every sum over ranks through the operations of the vector. Weights are reciprocal: norm(x) = sqrt(mean (x_i w_i)^2).
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SPACE_H
#define STF_SPACE_H

#include "base.h"
#include "compat.h"
#include <nvector/nvector_serial.h>

typedef struct stf_space {
  sunindextype n;
  sunindextype
    rows; /* of n, how many are here; -1: they are not in an array of this process's own */
  bool serial;
  N_Vector like;
  long *sums; /* counts norms and the like: sums over all ranks; NULL: nobody does */
} stf_space;

void stf_space_open(stf_space *space, N_Vector like);

/* Are its components spread over the ranks of a communicator, a part of them here? The same answer on all
 * ranks; yes for a communicator of one rank too. */
static inline bool stf_spread(N_Vector v)
{
  return v->ops->nvgetcommunicator && N_VGetCommunicator(v) != STF_NO_COMM;
}

static inline void stf_count_sum(const stf_space *space)
{
  if (space->sums) ++*space->sums;
}

/* The host array of all components, or NULL: there is none, or the vector is spread. Without a call for a serial
 * vector. */
static inline sunrealtype *stf_array(N_Vector v)
{
  if (v->ops->nvgetarraypointer == N_VGetArrayPointer_Serial) return NV_DATA_S(v);
  return v->ops->nvgetarraypointer && !stf_spread(v) ? N_VGetArrayPointer(v) : NULL;
}

/* The host array of the rows that are here, and how many; NULL: there is none. */
sunrealtype *stf_own_rows(N_Vector v, sunindextype *rows);

/* The array of a serial vector, without a call. */
#define STF_ARRAY(v) NV_DATA_S(v)

void stf_zero(const stf_space *space, N_Vector x);
void stf_copy(const stf_space *space, N_Vector x, N_Vector y);                 /* y = x */
void stf_scale(const stf_space *space, sunrealtype c, N_Vector x, N_Vector y); /* y = c x */
void stf_axpy(const stf_space *space, sunrealtype c, N_Vector x, N_Vector y);  /* y += c x */
void stf_sum(const stf_space *space, sunrealtype a, N_Vector x, sunrealtype b, N_Vector y,
             N_Vector z); /* z = a x + b y */
void stf_by_component(const stf_space *space, N_Vector x, N_Vector y,
                      N_Vector z); /* z_i = x_i y_i */
/* z = sum_{j<count} c_j x_j; z may be x_0. */
void stf_combine(const stf_space *space, int count, const sunrealtype *c, N_Vector const *x,
                 N_Vector z);
/* z_i = sum_{j<columns} M[i columns + j] x_j, i < rows; z and x are disjoint. */
void stf_mix(const stf_space *space, int rows, int columns, const sunrealtype *M,
             N_Vector const *x, N_Vector *z);
/* z_i += the same. */
void stf_mix_add(const stf_space *space, int rows, int columns, const sunrealtype *M,
                 N_Vector const *x, N_Vector *z);
/* sums[j] = x . v_j, j < count; _here: its part of the components that are here, which stf_sum_up adds up over the
 * ranks. Vectors without an array of their own know only the whole, and nothing is to be added. */
void stf_dots(const stf_space *space, int count, N_Vector x, N_Vector const *v,
              sunrealtype *sums);
void stf_dots_here(const stf_space *space, int count, N_Vector x, N_Vector const *v,
                   sunrealtype *sums);
void stf_sum_up(const stf_space *space, int count, sunrealtype *sums);
sunrealtype stf_norm(const stf_space *space, N_Vector x, N_Vector w);
/* The root mean square of the norms of several vectors. */
sunrealtype stf_norms(const stf_space *space, int count, N_Vector const *x, N_Vector w);
/* Of each of several vectors. */
void stf_norm_each(const stf_space *space, int count, N_Vector const *x, N_Vector w,
                   sunrealtype *norms);
sunrealtype stf_max(const stf_space *space, N_Vector x);
/* w_i = 1 / (rtol |y_i| + atol_i); atols NULL: atol for all. */
void stf_weights(const stf_space *space, sunrealtype rtol, sunrealtype atol, N_Vector atols,
                 N_Vector y, N_Vector w);
/* Finite in all components (a sum of squares test: NaN and infinity survive every sum). */
bool stf_finite(const stf_space *space, N_Vector x);

/* x^p to seven digits, x from 1e-30 to 1e30: enough for the length of a step, at a third of the cost. */
sunrealtype stf_power(sunrealtype x, sunrealtype p);

#endif
