/* stokes.c: creeping flow of uneven density in the unit square, semi-discretised on m x m
 * staggered cells, index 2:
 *
 *   R u' + A u + G p = f,   G^T u = g,
 *
 * u the normal velocities at the inner faces (first the vertical ones), p the pressures of all
 * cells but the last; A = -Laplacian with no slip, G the gradient, R diagonal densities in [1, 2].
 * With S = G^T R^{-1} G:  c_0 = (0, S^{-1} (G^T u_0 - g)),  u(0+) = u_0 - R^{-1} G c_0,
 * p(0+) = S^{-1} (G^T R^{-1} (f - A u(0+)) - g').
 * F. H. Harlow, J. E. Welch, Phys. Fluids 8 (1965) 2182-2189 (the grid).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "generated.h"
#include <string.h>

typedef struct grid {
  sunindextype m, half, faces, cells; /* vertical faces, all faces, cells with a pressure */
  sunrealtype *lightness;             /* 1 / density */
} grid;

/* u(0+) from x0 in place, the pressures set to 0, and the multiplier of that jump. */
static int project(stf_schur *s, const stf_linear *l, sunrealtype *x, sunrealtype *impulse,
                   sunrealtype *work)
{
  const grid *q = l->data;
  memset(x + q->faces, 0, (size_t)q->cells * sizeof *x);
  stf_linear_defect(l, x, 0, work);
  memcpy(impulse + q->faces, work + q->faces, (size_t)q->cells * sizeof *work);
  STEIF_TRY(stf_schur_solve(s, impulse + q->faces));
  stf_linear_times(l, impulse, work);
  for (sunindextype i = 0; i < q->faces; i++) x[i] -= q->lightness[i] * work[i];
  return STEIF_OK;
}

/* p(0+) from u(0+); `slope` takes R^{-1} (f - A u). */
static int pressure(stf_schur *s, const stf_linear *l, sunrealtype *x, sunrealtype *work,
                    sunrealtype *slope)
{
  const grid *q = l->data;
  stf_linear_defect(l, x, 0, work);
  memset(slope, 0, (size_t)l->n * sizeof *slope);
  for (sunindextype i = 0; i < q->faces; i++) slope[i] = -q->lightness[i] * work[i];
  stf_linear_defect(l, slope, 1, work);
  memcpy(x + q->faces, work + q->faces, (size_t)q->cells * sizeof *work);
  return stf_schur_solve(s, x + q->faces);
}

static int jump(steif_context *ctx, const stf_linear *l, const sunrealtype *x0,
                stf_exact_start *out)
{
  const grid *q = l->data;
  stf_schur *s = NULL;
  sunrealtype *work = stf_allocate(ctx, 2 * (size_t)l->n, sizeof *work);
  int code = work
               ? stf_schur_open(ctx, &l->F, q->faces, q->cells, 0, q->faces, q->lightness, &s)
               : STEIF_NO_MEMORY;
  memcpy(out->x_plus, x0, (size_t)l->n * sizeof *x0);
  if (!code) code = project(s, l, out->x_plus, out->c, work);
  if (!code) code = pressure(s, l, out->x_plus, work, work + l->n);
  stf_schur_close(&s);
  stf_release(ctx, work);
  return code;
}

/* Laplacian of one velocity component on wide x high faces that start at `base`. Along its own
 * direction the walls are faces with the value 0; across it they lie half a cell away, and the
 * reflected value beyond adds to the diagonal. */
static void laplace(stf_linear *l, sunindextype base, sunindextype wide, sunindextype high,
                    sunindextype step, sunindextype stride, sunrealtype scale)
{
  for (sunindextype a = 0; a < wide; a++)
    for (sunindextype b = 0; b < high; b++) {
      const sunindextype i = base + a * step + b * stride;
      stf_linear_put(&l->F, i, i, scale * (4 + (b == 0) + (b == high - 1)));
      if (a > 0) stf_linear_put(&l->F, i, i - step, -scale);
      if (a < wide - 1) stf_linear_put(&l->F, i, i + step, -scale);
      if (b > 0) stf_linear_put(&l->F, i, i - stride, -scale);
      if (b < high - 1) stf_linear_put(&l->F, i, i + stride, -scale);
    }
}

/* The gradient across one face and its transpose. */
static void face(stf_linear *l, const grid *q, sunindextype i, sunindextype before,
                 sunindextype ahead)
{
  const sunindextype cell[] = {before, ahead};
  for (int k = 0; k < 2; k++) {
    if (cell[k] == q->cells) continue;
    const sunrealtype value = (sunrealtype)(k == 0 ? -q->m : q->m);
    stf_linear_put(&l->F, i, q->faces + cell[k], value);
    stf_linear_put(&l->F, q->faces + cell[k], i, value);
  }
}

static void flow(stf_linear *l, const grid *q)
{
  const sunindextype m = q->m;
  const sunrealtype scale = (sunrealtype)(m * m);
  laplace(l, 0, m - 1, m, 1, m - 1, scale);
  laplace(l, q->half, m - 1, m, m, 1, scale);
  for (sunindextype a = 0; a < m - 1; a++)
    for (sunindextype b = 0; b < m; b++) {
      face(l, q, a + (m - 1) * b, a + m * b, a + 1 + m * b);
      face(l, q, q->half + m * a + b, b + m * a, b + m * (a + 1));
    }
}

static int data(stf_linear *l, sunindextype m)
{
  grid *q = stf_pool_array(l->pool, 1, sizeof *q);
  if (!q) return STEIF_NO_MEMORY;
  *q = (grid){.m = m, .half = m * (m - 1), .faces = 2 * m * (m - 1), .cells = m * m - 1};
  q->lightness = stf_pool_array(l->pool, (size_t)q->faces, sizeof *q->lightness);
  l->data = q;
  return q->lightness ? STEIF_OK : STEIF_NO_MEMORY;
}

static void randomise(stf_linear *l, const grid *q, stf_random *r)
{
  for (sunindextype i = 0; i < q->faces; i++) {
    const sunrealtype density = stf_random_in(r, 1, 2);
    stf_linear_put(&l->E, i, i, density);
    q->lightness[i] = 1 / density;
  }
  for (sunindextype i = 0; i < l->n; i++) {
    l->start[i] = stf_random_in(r, -1, 1);
    if (i >= q->faces) l->index[i] = 2;
    const sunrealtype size = stf_random_in(r, -1, 1), pace = stf_random_in(r, 1, 10);
    stf_linear_wave(l, i, size, pace, stf_random_in(r, 0, 6));
  }
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  int m;
  stf_random r;
  static const char *const keys[] = {"m", "seed", "case", "storage", NULL};
  STEIF_TRY(stf_spec_only(ctx, spec, keys));
  STEIF_TRY(stf_spec_int(ctx, spec, "m", 2, 2000, 16, &m));
  STEIF_TRY(stf_random_seed(ctx, spec, &r));
  const sunindextype faces = 2 * (sunindextype)m * (m - 1), n = faces + (sunindextype)m * m - 1;
  stf_linear *l = stf_linear_open(ctx, self, n, faces, 9 * faces, n);
  if (!l || data(l, m)) return STEIF_NO_MEMORY;
  const grid *q = l->data;
  flow(l, q);
  randomise(l, q, &r);
  l->dae_index = 2;
  l->finite = q->faces - q->cells;
  l->jump = jump;
  return stf_linear_finish(ctx, spec, self);
}

const steif_problem steif_problem_stokes = {
  .about =
    "creeping flow on m=16 x 16 staggered cells, densities in [1, 2], index 2, impulse in the "
    "pressure (case=inc); grid: F. H. Harlow and J. E. Welch, Phys. Fluids 8 (1965)",
  .t1 = 0.1,
  .storage = STEIF_SPARSE,
  .build = build,
  STF_LINEAR_CALLBACKS,
};
