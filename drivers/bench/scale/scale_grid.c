/* scale_grid.c: the heat equation on a cube and its multigrid.
 *
 * A V-cycle for c - Laplacian: one sweep of damped Jacobi before and one after the coarser grid, full weighting
 * (27 points, one dimension after the other), interpolation linear in each dimension (W. L. Briggs, V. E.
 * Henson & S. F. McCormick, A Multigrid Tutorial, SIAM, 2000). Arrays have a rim of zeros, where a rank would have
 * what its neighbours sent: every exchange is counted just before the rim is read.
 *
 * Known: the sum of sin(pi x) sin(pi y) sin(pi z) and half of sin(3 pi x) sin(2 pi y) sin(pi z), eigenvectors of the
 * discrete Laplacian with eigenvalues -4 (side + 1)^2 sum sin^2(k pi / (2 (side + 1))).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "scale.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

typedef struct level {
  size_t m, row, plane,
    size;   /* inner points of a side; places to the next point in y and z; in all */
  double q; /* 1 / h^2 */
  double *z, *r, *w;
} level;

struct scale_grid {
  scale_network *network;
  int levels;
  double c;
  double *start;
  level level[SCALE_LEVELS];
};

static void exchange(const scale_grid *g, int l)
{
  g->network->exchange[l]++;
  scale_sleep(g->network);
}

static size_t at(const level *a, size_t i, size_t j, size_t k)
{
  return (k + 1) * a->plane + (j + 1) * a->row + i + 1;
}

/* The sum of the six neighbours. */
static double around(const level *a, const double *u, size_t p)
{
  return u[p - 1] + u[p + 1] + u[p - a->row] + u[p + a->row] + u[p - a->plane] +
         u[p + a->plane];
}

#define EACH_ROW(a, k, j)                                                                      \
  for (size_t k = 0; k < (a)->m; k++)                                                          \
    for (size_t j = 0; j < (a)->m; j++)

static void into(const level *a, const double *from, double *to)
{
  EACH_ROW(a, k, j)
  memcpy(to + at(a, 0, j, k), from + (k * a->m + j) * a->m, a->m * sizeof *to);
}

/* -- a cycle ------------------------------------------------------------------------------------ */

/* z += omega (r - A z) / diagonal, the first time from z = 0; w: scratch. */
static void smooth(const scale_grid *g, int l, int first)
{
  const level *a = &g->level[l];
  const double d = g->c + 6 * a->q, omega = 6. / 7;
  if (!first) exchange(g, l);
  EACH_ROW(a, k, j)
  for (size_t p = at(a, 0, j, k), end = p + a->m; p < end; p++)
    a->w[p] = first ? omega * a->r[p] / d
                    : a->z[p] + omega * (a->r[p] - d * a->z[p] + a->q * around(a, a->z, p)) / d;
  EACH_ROW(a, k, j)
  memcpy(a->z + at(a, 0, j, k), a->w + at(a, 0, j, k), a->m * sizeof *a->z);
}

/* w := r - A z. */
static void residual(const scale_grid *g, int l)
{
  const level *a = &g->level[l];
  exchange(g, l);
  EACH_ROW(a, k, j)
  for (size_t p = at(a, 0, j, k), end = p + a->m; p < end; p++)
    a->w[p] = a->r[p] - (g->c + 6 * a->q) * a->z[p] + a->q * around(a, a->z, p);
}

/* The weight 1/4, 1/2, 1/4 of each dimension. */
static double weighted(const level *a, const double *w, size_t p)
{
  double sum = 0;
  for (size_t k = 0; k < 3; k++)
    for (size_t j = 0; j < 3; j++) {
      const double *u = w + p + k * a->plane + j * a->row - a->plane - a->row;
      sum += (k == 1 ? 0.5 : 0.25) * (j == 1 ? 0.5 : 0.25) *
             (0.25 * u[-1] + 0.5 * u[0] + 0.25 * u[1]);
    }
  return sum;
}

static void restrict_to(const scale_grid *g, int l)
{
  const level *a = &g->level[l - 1], *b = &g->level[l];
  exchange(g, l - 1);
  EACH_ROW(b, k, j)
  for (size_t i = 0; i < b->m; i++)
    b->r[at(b, i, j, k)] = weighted(a, a->w, at(a, 2 * i + 1, 2 * j + 1, 2 * k + 1));
}

/* Fine point i lies on coarse point (i - 1) / 2, i odd, or between that and the next. */
static void prolong_from(const scale_grid *g, int l)
{
  const level *a = &g->level[l - 1], *b = &g->level[l];
  exchange(g, l);
  EACH_ROW(a, k, j)
  for (size_t i = 0; i < a->m; i++) {
    const size_t p = (k + 1) / 2 * b->plane + (j + 1) / 2 * b->row + (i + 1) / 2;
    const size_t x = i % 2 == 0, y = (j % 2 == 0) * b->row, z = (k % 2 == 0) * b->plane;
    const double *u = b->z + p;
    const double sum =
      u[0] + u[x] + u[y] + u[x + y] + u[z] + u[x + z] + u[y + z] + u[x + y + z];
    a->z[at(a, i, j, k)] += sum / 8;
  }
}

static void cycle(const scale_grid *g, int l)
{
  const level *a = &g->level[l];
  if (l == g->levels - 1) {
    const size_t p = at(a, 0, 0, 0);
    a->z[p] = a->r[p] / (g->c + 6 * a->q);
    return;
  }
  smooth(g, l, 1);
  residual(g, l);
  restrict_to(g, l + 1);
  cycle(g, l + 1);
  prolong_from(g, l + 1);
  smooth(g, l, 0);
}

/* -- callbacks ------------------------------------------------------------------------------------ */

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  scale_grid *g = user;
  const level *a = &g->level[0];
  double *to = N_VGetArrayPointer(out);
  (void)t;
  into(a, N_VGetArrayPointer(y), a->z);
  exchange(g, 0);
  EACH_ROW(a, k, j)
  for (size_t i = 0; i < a->m; i++) {
    const size_t p = at(a, i, j, k);
    *to++ = a->q * (around(a, a->z, p) - 6 * a->z[p]);
  }
  return 0;
}

static int Av(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  (void)y, (void)yp;
  return f(t, x, out, user);
}

static int setup(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c, void *user)
{
  scale_grid *g = user;
  (void)t, (void)y, (void)yp, (void)r;
  g->c = c, g->network->setups++;
  return 0;
}

static int solve(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
                 sunrealtype c, sunrealtype delta, void *user)
{
  scale_grid *g = user;
  const level *a = &g->level[0];
  double *to = N_VGetArrayPointer(z);
  (void)t, (void)y, (void)yp, (void)r, (void)c, (void)delta;
  g->network->cycles++;
  into(a, N_VGetArrayPointer(b), a->r);
  cycle(g, 0);
  EACH_ROW(a, k, j)
  memcpy(to + (k * a->m + j) * a->m, a->z + at(a, 0, j, k), a->m * sizeof *to);
  return 0;
}

/* -- the solution ---------------------------------------------------------------------------------- */

static double rate(const scale_grid *g, int k)
{
  const double s = sin(k * PI / (2 * ((double)g->level[0].m + 1)));
  return -4 * g->level[0].q * s * s;
}

static double solution(const scale_grid *g, double t, size_t i, size_t j, size_t k)
{
  const double h = 1 / ((double)g->level[0].m + 1), x = PI * h * (double)(i + 1),
               y = PI * h * (double)(j + 1), z = PI * h * (double)(k + 1);
  return exp(3 * rate(g, 1) * t) * sin(x) * sin(y) * sin(z) +
         0.5 * exp((rate(g, 3) + rate(g, 2) + rate(g, 1)) * t) * sin(3 * x) * sin(2 * y) *
           sin(z);
}

double scale_grid_error(const scale_grid *g, double t, N_Vector y)
{
  const sunrealtype *u = N_VGetArrayPointer(y);
  double most = 0;
  EACH_ROW(&g->level[0], k, j)
  for (size_t i = 0; i < g->level[0].m; i++)
    most = fmax(most, fabs(*u++ - solution(g, t, i, j, k)));
  return most;
}

/* -- memory ------------------------------------------------------------------------------------------ */

static int open(scale_grid *g, size_t m)
{
  level *a = &g->level[g->levels];
  *a = (level){.m = m, .row = m + 2, .plane = (m + 2) * (m + 2), .q = pow((double)m + 1, 2)};
  a->size = a->plane * (m + 2);
  a->z = calloc(3 * a->size, sizeof *a->z);
  if (!a->z) return 0;
  a->r = a->z + a->size, a->w = a->r + a->size;
  g->levels++;
  return m == 1 || g->levels == SCALE_LEVELS ? 1 : open(g, (m - 1) / 2);
}

scale_grid *scale_grid_new(int side, scale_network *network)
{
  scale_grid *g = calloc(1, sizeof *g);
  if (!g) return NULL;
  const size_t m = (size_t)side;
  g->network = network;
  g->start = calloc(m * m * m, sizeof *g->start);
  if (!g->start || !open(g, m)) {
    scale_grid_free(g);
    return NULL;
  }
  double *to = g->start;
  EACH_ROW(&g->level[0], k, j)
  for (size_t i = 0; i < m; i++) *to++ = solution(g, 0, i, j, k);
  return g;
}

void scale_grid_free(scale_grid *g)
{
  if (!g) return;
  for (int l = 0; l < g->levels; l++) free(g->level[l].z);
  free(g->start), free(g);
}

int scale_grid_levels(const scale_grid *g) { return g->levels; }

steif_problem scale_grid_problem(scale_grid *g)
{
  const sunindextype m = (sunindextype)g->level[0].m;
  return (steif_problem){.name = "heat3d",
                         .n = m * m * m,
                         .t1 = 0.02,
                         .y0 = g->start,
                         .f = f,
                         .Av = Av,
                         .precsetup = setup,
                         .precsolve = solve,
                         .storage = STEIF_KRYLOV,
                         .user = g};
}
