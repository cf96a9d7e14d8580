/* cubic.c: backward Euler for van der Pol's equation through the real roots of its cubic.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"
#include <math.h>

/* ((a x + b) x + c) x + d */
typedef struct cubic {
  sunrealtype a, b, c, d;
} cubic;

static sunrealtype at(const cubic *f, sunrealtype x)
{
  return ((f->a * x + f->b) * x + f->c) * x + f->d;
}

/* Between lo and hi, where the signs differ: halved until nothing lies between. */
static sunrealtype bisect(const cubic *f, sunrealtype lo, sunrealtype hi)
{
  const bool below = at(f, lo) < 0;
  for (;;) {
    const sunrealtype middle = lo + (hi - lo) / 2;
    if (middle <= lo || middle >= hi) return middle;
    *((at(f, middle) < 0) == below ? &lo : &hi) = middle;
  }
}

/* The real roots: one at most between the places where the slope is zero and a bound for all of
 * them. */
static int real_roots(const cubic *f, sunrealtype root[3])
{
  const sunrealtype bound = 1 + fmax(fabs(f->b), fmax(fabs(f->c), fabs(f->d))) / fabs(f->a);
  const sunrealtype slope = f->b * f->b - 3 * f->a * f->c;
  const sunrealtype half = slope > 0 ? sqrt(slope) / (3 * f->a) : 0,
                    centre = -f->b / (3 * f->a);
  const sunrealtype edge[4] = {-bound, centre - half, centre + half, bound};
  int count = 0;
  for (int i = 0; i < 3; i++)
    if (edge[i] < edge[i + 1] && (at(f, edge[i]) < 0) != (at(f, edge[i + 1]) < 0))
      root[count++] = bisect(f, edge[i], edge[i + 1]);
  return count;
}

/* The new q = x of a step from (q, p), with a = mu h: q + h p' h eliminated,
 * a x^3 - a q x^2 + (1 - a + h^2) x + (a - 1) q - h p = 0. */
static int step(sunrealtype mu, sunrealtype h, sunrealtype *q, sunrealtype *p)
{
  const sunrealtype a = mu * h;
  const cubic f = {a, -a * *q, 1 - a + h * h, (a - 1) * *q - h * *p};
  sunrealtype root[3];
  const int count = real_roots(&f, root);
  sunrealtype nearest = root[0];
  for (int i = 1; i < count; i++)
    if (fabs(root[i] - *q) < fabs(nearest - *q)) nearest = root[i];
  *p = (nearest - *q) / h;
  *q = nearest;
  return count;
}

int stf_cubic_table(stf_trial *t, const stf_cubic_line *l)
{
  sunrealtype q = 2, p = 0, late = 0;
  long several = 0;
  for (long k = 1; k <= l->steps; k++) {
    several += step(l->mu, l->h, &q, &p) == 3;
    if (2 * k > l->steps) late = fmax(late, fabs(q));
  }
  STEIF_TRY(stf_find(t, l->label, l->h, "q at the end", q, l->q, 1e-9));
  STEIF_TRY(stf_find(t, l->label, l->h, "p at the end", p, l->p, 1e-9));
  STEIF_TRY(stf_find(t, l->label, l->h, "largest late |q|", late, l->late, 6e-6));
  return stf_find(t, l->label, l->h, "steps with three real roots", (sunrealtype)several,
                  l->several, 0);
}
