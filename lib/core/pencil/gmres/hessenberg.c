/* hessenberg.c: Givens rotations.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "hessenberg.h"
#include <math.h>

int stf_hessenberg_open(stf_pool *pool, int dimension, stf_hessenberg *H)
{
  const size_t most = (size_t)dimension + 1;
  *H = (stf_hessenberg){.dimension = dimension};
  H->cosine = stf_pool_array(pool, most, sizeof *H->cosine);
  H->column = stf_pool_array(pool, most, sizeof *H->column);
  H->sine = stf_pool_array(pool, most, sizeof *H->sine);
  H->rest = stf_pool_array(pool, most, sizeof *H->rest);
  H->y = stf_pool_array(pool, most, sizeof *H->y);
  H->R = stf_pool_array(pool, most * most, sizeof *H->R);
  const bool good = H->cosine && H->column && H->sine && H->rest && H->y && H->R;
  return good ? STEIF_OK : STEIF_NO_MEMORY;
}

void stf_hessenberg_begin(stf_hessenberg *H, double norm)
{
  H->rest[0] = (stf_number){norm, 0};
}

double stf_hessenberg_add(stf_hessenberg *H, int j, double under)
{
  stf_number *h = H->column, *R = H->R + j * H->dimension;
  for (int i = 0; i < j; i++) {
    const stf_number a = h[i], b = h[i + 1];
    h[i] = stf_plus(stf_scaled(H->cosine[i], a), stf_times(H->sine[i], b));
    h[i + 1] = stf_minus(stf_scaled(H->cosine[i], b), stf_times(stf_conjugate(H->sine[i]), a));
  }
  const double size = sqrt(stf_square(h[j])), all = hypot(size, under);
  if (!(all > 0)) { /* nothing in this direction */
    H->cosine[j] = 0, H->sine[j] = (stf_number){1, 0}, R[j] = (stf_number){1, 0};
    H->rest[j + 1] = stf_scaled(-1, H->rest[j]), H->rest[j] = (stf_number){0, 0};
    for (int i = 0; i < j; i++) R[i] = h[i];
    return sqrt(stf_square(H->rest[j + 1]));
  }
  const stf_number turn = size > 0 ? stf_scaled(1 / size, h[j]) : (stf_number){1, 0};
  H->cosine[j] = size / all;
  H->sine[j] = stf_scaled(under / all, turn);
  for (int i = 0; i < j; i++) R[i] = h[i];
  R[j] = stf_scaled(all, turn);
  H->rest[j + 1] = stf_scaled(-1, stf_times(stf_conjugate(H->sine[j]), H->rest[j]));
  H->rest[j] = stf_scaled(H->cosine[j], H->rest[j]);
  return sqrt(stf_square(H->rest[j + 1]));
}

void stf_hessenberg_solve(stf_hessenberg *H, int count)
{
  for (int i = count; i-- > 0;) {
    stf_number left = H->rest[i];
    for (int j = i + 1; j < count; j++)
      left = stf_minus(left, stf_times(H->R[j * H->dimension + i], H->y[j]));
    H->y[i] = stf_quotient(left, H->R[i * H->dimension + i]);
  }
}

void stf_hessenberg_further(stf_hessenberg *H, int count, stf_number step)
{
  stf_number *r = H->column;
  for (int i = 0; i < count; i++) r[i] = (stf_number){0, 0};
  r[count] = H->rest[count];
  for (int i = count; i-- > 0;) {
    const stf_number b = r[i + 1];
    r[i] = stf_scaled(-1, stf_times(H->sine[i], b));
    r[i + 1] = stf_scaled(H->cosine[i], b);
  }
  H->y[count] = (stf_number){0, 0};
  for (int i = 0; i <= count; i++) H->y[i] = stf_plus(H->y[i], stf_times(step, r[i]));
}
