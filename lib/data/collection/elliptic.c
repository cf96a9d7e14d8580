/* elliptic.c: the oscillating pendulum phi'' = -g sin phi in closed form.
 *
 * With w^2 = g and k^2 = sin^2(phi_0/2) + phi_0'^2 / (4g) < 1,
 *   sin(phi/2) = k sn(u_0 + w t),  cos(phi/2) = dn,  phi' = 2 k w cn,
 * u_0 from the start values; sn, cn, dn of modulus k by the arithmetic-geometric mean and their
 * addition theorems (Abramowitz and Stegun 1964, 16.4 and 16.17).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>

enum { MEANS = 12 }; /* quadratic convergence: seven suffice for k^2 <= 1 - 1e-15 */

typedef struct elliptic {
  sunrealtype sn, cn, dn;
} elliptic;

static elliptic jacobi(sunrealtype u, sunrealtype k)
{
  sunrealtype a[MEANS], c[MEANS], b = sqrt((1 - k) * (1 + k));
  int n = 0;
  a[0] = 1;
  c[0] = k;
  while (n < MEANS - 1 && fabs(c[n]) > 0.25 * STF_EPS) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = sqrt(a[n] * b);
    n++;
  }
  sunrealtype phi = ldexp(a[n] * u, n);
  for (; n > 0; n--) phi = 0.5 * (phi + asin(c[n] / a[n] * sin(phi)));
  const sunrealtype sn = sin(phi);
  return (elliptic){sn, cos(phi), sqrt((1 - k * sn) * (1 + k * sn))};
}

void stf_collection_pendulum(sunrealtype g, sunrealtype phi0, sunrealtype rate0, sunrealtype t,
                             sunrealtype *phi, sunrealtype *rate)
{
  const sunrealtype w = sqrt(g), k = hypot(sin(0.5 * phi0), 0.5 * rate0 / w);
  if (k == 0) {
    *phi = *rate = 0;
    return;
  }
  const elliptic a = {sin(0.5 * phi0) / k, 0.5 * rate0 / (k * w), cos(0.5 * phi0)};
  const elliptic v = jacobi(w * t, k);
  const sunrealtype below = 1 - k * k * a.sn * a.sn * v.sn * v.sn;
  *phi = 2 * asin(k * (a.sn * v.cn * v.dn + v.sn * a.cn * a.dn) / below);
  *rate = 2 * k * w * (a.cn * v.cn - a.sn * v.sn * a.dn * v.dn) / below;
}
