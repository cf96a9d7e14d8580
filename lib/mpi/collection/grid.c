/* grid.c: problems of the collection over ranks: the heat equation and the Brusselator by the star of 5 or 7 points
 * on n^2 or n^3 points; whole lines or planes ("layers") to a rank, unknowns of a point together.
 *
 * heat2d, heat3d: u_t = Laplace u on the unit square or cube, u = 0 on the boundary; products of sines are
 * eigenvectors of the star, so that the start has a closed solution. bruss2d: that of the collection, with u and v
 * of a point side by side: E. Hairer and G. Wanner, Solving Ordinary Differential Equations II, Springer 1996, ch.
 * IV.10. bruss3d: the same equations in a periodic cube with alpha = 0.02 and the ball around (0.3, 0.6, 0.5) in
 * place of the disc.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "parallel_problem.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

#define PI 3.14159265358979323846
#define IGNITION 1.1
#define FEED 1.0
#define DRAIN 3.4

typedef struct kind {
  const char *name;
  int dimension, fields, least, most, usual; /* points a side */
  sunrealtype alpha, end;
} kind;

static const kind kinds[] = {{"heat2d", 2, 1, 2, 20000, 32, 1, 0.05},
                             {"heat3d", 3, 1, 2, 1000, 20, 1, 0.02},
                             {"bruss2d", 2, 2, 3, 20000, 32, 0.1, 11.5},
                             {"bruss3d", 3, 2, 3, 1000, 12, 0.02, 1.0}};

typedef struct grid {
  parallel_problem public;
  const kind *is;
  MPI_Comm comm;
  int rank, size, n, low, high;          /* own layers: low .. high - 1 */
  int below, above;                      /* ranks of the layers beside them, or none */
  sunindextype wide, layer, rows, first; /* points and unknowns of a layer; own rows */
  sunrealtype scale;                     /* alpha / h^2 */
  sunrealtype *under, *over, *start;     /* the layers beside own ones */
} grid;

static const sunrealtype breaks[] = {IGNITION};

static bool periodic(const grid *g) { return g->is->fields == 2; }

/* -- products --------------------------------------------------------------------------------- */

static void exchange(grid *g, const sunrealtype *u)
{
  MPI_Request q[4];
  const int count = (int)g->layer;
  if (!g->rows) return;
  MPI_Irecv(g->under, count, MPI_DOUBLE, g->below, 0, g->comm, &q[0]);
  MPI_Irecv(g->over, count, MPI_DOUBLE, g->above, 1, g->comm, &q[1]);
  MPI_Isend(u + g->rows - g->layer, count, MPI_DOUBLE, g->above, 0, g->comm, &q[2]);
  MPI_Isend(u, count, MPI_DOUBLE, g->below, 1, g->comm, &q[3]);
  MPI_Waitall(4, q, MPI_STATUSES_IGNORE);
}

/* Places of the point's neighbours in a layer, -1: the boundary; 2 or 4 of them. */
static int beside(const grid *g, sunindextype point, sunindextype *place)
{
  const sunindextype n = g->n;
  int count = 0;
  for (sunindextype step = 1; step < g->wide; step *= n) {
    const sunindextype at = point / step % n;
    const bool around = periodic(g);
    place[count++] = at > 0 ? point - step : around ? point + (n - 1) * step : -1;
    place[count++] = at < n - 1 ? point + step : around ? point - (n - 1) * step : -1;
  }
  return count;
}

/* The source of the Brusselator in whole numbers, so that points on its rim are inside for every n. */
static bool burns(const grid *g, int layer, sunindextype point)
{
  const sunindextype n = g->n, i = point % n, j = g->is->dimension == 2 ? layer : point / n;
  const sunindextype dx = 10 * i - 3 * n, dy = 10 * j - 6 * n,
                     dz = g->is->dimension == 2 ? 0 : 10 * layer - 5 * n;
  return dx * dx + dy * dy + dz * dz <= n * n;
}

static void react(const grid *g, sunrealtype t, const sunrealtype *u, sunrealtype *du)
{
  for (sunindextype k = 0; k < g->rows; k += 2) {
    const sunrealtype uuv = u[k] * u[k] * u[k + 1];
    const int layer = g->low + (int)(k / g->layer);
    const bool lit = t >= IGNITION && burns(g, layer, k % g->layer / 2);
    du[k] += FEED + uuv - (DRAIN + 1) * u[k] + (lit ? 5 : 0);
    du[k + 1] += DRAIN * u[k] - uuv;
  }
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  grid *g = user;
  const sunrealtype *u = N_VGetArrayPointer(y);
  sunrealtype *du = N_VGetArrayPointer(ydot);
  const int fields = g->is->fields, sides = 2 * g->is->dimension;
  exchange(g, u);
  for (int l = g->low; l < g->high; l++) {
    const sunrealtype *here = u + (l - g->low) * g->layer;
    const sunrealtype *down = l > g->low ? here - g->layer : g->under,
                      *up = l < g->high - 1 ? here + g->layer : g->over;
    sunrealtype *out = du + (l - g->low) * g->layer;
    for (sunindextype p = 0; p < g->wide; p++) {
      sunindextype place[4];
      const int count = beside(g, p, place);
      for (int k = 0; k < fields; k++) {
        sunrealtype sum =
          down[fields * p + k] + up[fields * p + k] - sides * here[fields * p + k];
        for (int i = 0; i < count; i++)
          if (place[i] >= 0) sum += here[fields * place[i] + k];
        out[fields * p + k] = g->scale * sum;
      }
    }
  }
  if (fields == 2) react(g, t, u, du);
  return 0;
}

/* -- own rows of df/dy ------------------------------------------------------------------------ */

typedef struct row {
  sunindextype *column, used;
  sunrealtype *value;
} row;

static void put(row *r, sunindextype column, sunrealtype value)
{
  r->column[r->used] = column, r->value[r->used++] = value;
}

/* Neighbours first; n = 2 and 3 points around make no two of them the same. */
static void put_star(const grid *g, row *r, int layer, sunindextype point, int field)
{
  sunindextype place[4];
  const int fields = g->is->fields, count = beside(g, point, place), n = g->n;
  const int down = layer > 0     ? layer - 1
                   : periodic(g) ? n - 1
                                 : -1,
            up = layer < n - 1 ? layer + 1
                 : periodic(g) ? 0
                               : -1;
  for (int i = 0; i < count; i++)
    if (place[i] >= 0) put(r, layer * g->layer + fields * place[i] + field, g->scale);
  if (down >= 0) put(r, down * g->layer + fields * point + field, g->scale);
  if (up >= 0) put(r, up * g->layer + fields * point + field, g->scale);
}

static void put_point(const grid *g, row *r, sunindextype k, const sunrealtype *u)
{
  const int field = (int)(k % g->is->fields);
  sunrealtype own = -2 * g->is->dimension * g->scale;
  const sunindextype at = g->first + k;
  if (g->is->fields == 2) {
    const sunrealtype *w = u + k - field, uv2 = 2 * w[0] * w[1], uu = w[0] * w[0];
    own += field ? -uu : uv2 - (DRAIN + 1);
    put(r, field ? at - 1 : at + 1, field ? DRAIN - uv2 : uu);
  }
  put(r, at, own);
}

static int A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  const grid *g = user;
  const sunrealtype *u = N_VGetArrayPointer(y);
  sunindextype *pointer = SM_INDEXPTRS_S(M);
  row r = {.column = SM_INDEXVALS_S(M), .value = SM_DATA_S(M)};
  (void)t, (void)yp;
  pointer[0] = 0;
  for (sunindextype k = 0; k < g->rows; k++) {
    const int layer = g->low + (int)(k / g->layer), fields = g->is->fields;
    put_star(g, &r, layer, k % g->layer / fields, (int)(k % fields));
    put_point(g, &r, k, u);
    pointer[k + 1] = r.used;
  }
  return 0;
}

/* -- start and closed solution ---------------------------------------------------------------- */

static void coordinates(const grid *g, sunindextype k, sunrealtype *x)
{
  const sunindextype point = k % g->layer / g->is->fields;
  const sunrealtype h = 1 / (sunrealtype)(periodic(g) ? g->n : g->n + 1);
  const int shift = !periodic(g), last = g->is->dimension - 1;
  x[0] = (sunrealtype)(point % g->n + shift) * h;
  x[1] = (sunrealtype)(point / g->n + shift) * h;
  x[last] = (sunrealtype)(g->low + k / g->layer + shift) * h;
}

/* Eigenvalue of the star for sin(k pi x) in one direction. */
static sunrealtype eigenvalue(const grid *g, int k)
{
  const sunrealtype s = sin(0.5 * k * PI / (g->n + 1.));
  return -4 * g->scale * s * s;
}

static sunrealtype sines(const grid *g, sunrealtype t, const sunrealtype *x)
{
  static const int mode[] = {3, 2, 1};
  sunrealtype first = 1, second = 0.5;
  for (int d = 0; d < g->is->dimension; d++) {
    first *= sin(PI * x[d]) * exp(eigenvalue(g, 1) * t);
    second *= sin(mode[d] * PI * x[d]) * exp(eigenvalue(g, mode[d]) * t);
  }
  return first + second;
}

static void begin_at(const grid *g, sunrealtype t, sunrealtype *u)
{
  for (sunindextype k = 0; k < g->rows; k++) {
    sunrealtype x[3];
    coordinates(g, k, x);
    if (g->is->fields == 1) {
      u[k] = sines(g, t, x);
      continue;
    }
    const sunrealtype z = x[k % 2 == 0]; /* u depends on y, v on x */
    u[k] = (k % 2 ? 27 : 22) * z * (1 - z) * sqrt(1 - z);
  }
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  begin_at(user, t, N_VGetArrayPointer(y));
  return yp ? f(t, y, yp, user) : 0;
}

/* -- building --------------------------------------------------------------------------------- */

static int first_layer(const grid *g, int rank)
{
  return (int)((long long)g->n * rank / g->size);
}

static int owner(const grid *g, int layer)
{
  if (layer < 0 || layer >= g->n) {
    if (!periodic(g)) return MPI_PROC_NULL;
    layer = (layer + g->n) % g->n;
  }
  int rank = 0;
  while (first_layer(g, rank + 1) <= layer) rank++;
  return rank;
}

static int size_of(steif_context *ctx, const steif_spec *spec, const kind *is, int *n)
{
  *n = is->usual;
  for (int k = 0; k < spec->count; k++) {
    char rest;
    if (strcmp(spec->param[k].key, "n") ||
        sscanf(spec->param[k].value, "%d%c", n, &rest) != 1 || *n < is->least || *n > is->most)
      return steif_fail(ctx, STEIF_BAD_INPUT,
                        "%s over ranks takes n = %d .. %d points a side, not %s=%s", is->name,
                        is->least, is->most, spec->param[k].key, spec->param[k].value);
  }
  return STEIF_OK;
}

static const kind *kind_of(const char *name)
{
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
    if (!strcmp(kinds[i].name, name)) return &kinds[i];
  return NULL;
}

bool grid_named(const char *name) { return kind_of(name) != NULL; }

static int place(steif_context *ctx, grid *g)
{
  MPI_Comm_rank(g->comm, &g->rank), MPI_Comm_size(g->comm, &g->size);
  g->low = first_layer(g, g->rank), g->high = first_layer(g, g->rank + 1);
  g->wide = g->is->dimension == 2 ? g->n : (sunindextype)g->n * g->n;
  g->layer = g->wide * g->is->fields;
  g->rows = (g->high - g->low) * g->layer, g->first = g->low * g->layer;
  g->below = owner(g, g->low - 1), g->above = owner(g, g->high);
  const sunrealtype inverse = periodic(g) ? g->n : g->n + 1.;
  g->scale = g->is->alpha * inverse * inverse;
  g->under = steif_allocate(ctx, 2 * (size_t)g->layer, sizeof(sunrealtype));
  g->start = steif_allocate(ctx, (size_t)g->rows + 1, sizeof(sunrealtype));
  if (!g->under || !g->start) return STEIF_NO_MEMORY;
  g->over = g->under + g->layer;
  begin_at(g, 0, g->start);
  return STEIF_OK;
}

static void describe(grid *g)
{
  const bool heat = g->is->fields == 1;
  g->public.rows = g->rows;
  g->public.problem = (steif_problem){.name = g->is->name,
                                      .about = "a problem on a grid over ranks",
                                      .n = g->n * g->layer,
                                      .t1 = g->is->end,
                                      .y0 = g->start,
                                      .f = f,
                                      .A = A,
                                      .storage = STEIF_SPARSE,
                                      .nnz = (2 * g->is->dimension + g->is->fields) * g->rows,
                                      .autonomous = heat,
                                      .linear = heat,
                                      .exact = heat ? exact : NULL,
                                      .breaks = heat ? NULL : breaks,
                                      .break_count = !heat && g->is->end > IGNITION,
                                      .user = g};
}

/* In one process all u come before all v. */
static sunindextype number(const parallel_problem *public, sunindextype k)
{
  const grid *g = (const grid *)public;
  const sunindextype fields = g->is->fields, i = g->first + k;
  return i % fields * (g->wide * g->n) + i / fields;
}

static void release(steif_context *ctx, parallel_problem *public)
{
  grid *g = (grid *)public; /* its first member */
  steif_release(ctx, g->under);
  steif_release(ctx, g->start);
  steif_release(ctx, g);
}

int grid_build(steif_context *ctx, const char *text, MPI_Comm comm, parallel_problem **out)
{
  steif_spec spec;
  int n;
  if (steif_spec_parse(ctx, text, &spec)) return steif_status(ctx);
  const kind *is = kind_of(spec.name);
  if (size_of(ctx, &spec, is, &n)) return steif_status(ctx);
  grid *g = steif_allocate(ctx, 1, sizeof *g);
  if (!g) return STEIF_NO_MEMORY;
  *out = &g->public;
  g->public.number = number, g->public.release = release;
  g->is = is, g->n = n, g->comm = comm;
  if (place(ctx, g)) return STEIF_NO_MEMORY;
  describe(g);
  return STEIF_OK;
}
