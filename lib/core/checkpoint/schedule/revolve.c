/* revolve.c: binomial schedule of images (A. Griewank and A. Walther, ACM TOMS 26, 2000, 19-45).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "backwards.h"
#include <limits.h>

/* C(c + r, c) steps can be reversed with c images, each made at most r times; saturates. */
static long reach(int c, int r)
{
  long long product = 1;
  if (r < 0 || c < 0) return 0;
  for (int i = 1; i <= (c < r ? c : r); i++) {
    product = product * (c + r - (c < r ? c : r) + i) / i;
    if (product > LONG_MAX / (2 * (c + r + 1))) return LONG_MAX / 2;
  }
  return (long)product;
}

long stf_revolve_advance(long l, int c)
{
  int r = 1;
  if (c < 2) return l - 1;
  while (reach(c, r) < l) r++;
  long advance = l - reach(c - 1, r);
  if (advance < reach(c, r - 2)) advance = reach(c, r - 2);
  return advance < 1 ? 1 : advance > l - 1 ? l - 1 : advance;
}
