/* bruss2d.c: the Brusselator with diffusion on a periodic square of N x N points.
 *
 *   u_t = A + u^2 v - (B + 1) u + alpha (u_xx + u_yy) + f(x, y, t)
 *   v_t = B u - u^2 v + alpha (v_xx + v_yy),
 * with parameters A = 1, B = 3.4, alpha = 0.1; f = 5 in the disc (x - 0.3)^2 + (y - 0.6)^2 <= 0.1^2 for t >= 1.1, else 0;
 * u = 22 y (1-y)^{3/2}, v = 27 x (1-x)^{3/2} at t = 0; x = i/N, y = j/N, 0 <= i, j < N.
 * Unknowns: u of all points, x running first, then v.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/parameters.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

#define IGNITION 1.1
#define HEAT 5.0
#define END 11.5

/* References for N = 16, 32, 64 at the points (i, j)/16 below: first u, then v. */
enum { POINTS = 8, COARSEST = 16 };
static const int point[POINTS][2] = {{0, 0}, {3, 1},  {9, 2},   {14, 5},
                                     {5, 9}, {2, 12}, {11, 13}, {7, 15}};
static const sunrealtype end16[] = {
  0.48784188804639, 0.50874598771231, 0.48942133316807, 0.48584146893117,
  0.97570986783458, 0.62762086331947, 0.51106717615304, 0.54327123019209,
  4.8896180777323,  4.876357606542,   4.8884071520939,  4.8907955677389,
  4.7136402052402,  4.8151441423974,  4.8755093518666,  4.8572893855447};
static const sunrealtype end32[] = {
  0.55309850035254, 0.58133108114757, 0.54936170280516, 0.54892480897771,
  1.1377241529281,  0.75589951497334, 0.57804554523278, 0.62275453289139,
  4.8909126300592,  4.8689575966533,  4.8933882042599,  4.8939782608058,
  4.6191193653114,  4.7609218045678,  4.8723643310289,  4.8413915436073};
static const sunrealtype end64[] = {
  0.58016674642603, 0.61261570237265, 0.5779865943877,  0.57833349632644,
  1.2227234462274,  0.80279505350768, 0.60864425626357, 0.65671211375561,
  4.8806942844419,  4.8539042047388,  4.8820351268085,  4.8820533744339,
  4.5564494303554,  4.7280001076632,  4.858240941242,   4.822563755592};

enum { FEED, DRAIN, ALPHA, PARAMETERS };
static const char *const names[] = {"A", "B", "alpha"};

typedef struct square {
  sunindextype N, cells; /* N^2 */
  sunrealtype p[PARAMETERS];
  steif_parameters parameters;
  steif_pattern pattern; /* six rows a column */
  sunindextype *column, *row;
  sunrealtype *source; /* the disc: HEAT or 0, cells */
  sunindextype component[2 * POINTS];
  steif_reference reference;
  sunrealtype start[]; /* 2 cells */
} square;

static const sunrealtype breaks[] = {IGNITION};

/* Five-point sums times c of one row of cells w between the rows up and down. */
static void diffuse(sunindextype N, sunrealtype c, const sunrealtype *w, const sunrealtype *up,
                    const sunrealtype *down, sunrealtype *out)
{
  out[0] = c * (w[N - 1] + w[1] + up[0] + down[0] - 4 * w[0]);
  for (sunindextype i = 1; i < N - 1; i++)
    out[i] = c * (w[i - 1] + w[i + 1] + up[i] + down[i] - 4 * w[i]);
  out[N - 1] = c * (w[N - 2] + w[0] + up[N - 1] + down[N - 1] - 4 * w[N - 1]);
}

static sunrealtype spread_of(const square *s)
{
  return s->p[ALPHA] * (sunrealtype)s->N * (sunrealtype)s->N;
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const square *s = user;
  const sunindextype N = s->N;
  const sunrealtype *u = N_VGetArrayPointer(y), *v = u + s->cells;
  const sunrealtype burning = t >= IGNITION, A = s->p[FEED], B = s->p[DRAIN],
                    spread = spread_of(s);
  sunrealtype *du = N_VGetArrayPointer(ydot), *dv = du + s->cells;
  for (sunindextype j = 0; j < N; j++) {
    const sunindextype at = j * N, up = (j + 1) % N * N, down = (j + N - 1) % N * N;
    diffuse(N, spread, u + at, u + up, u + down, du + at);
    diffuse(N, spread, v + at, v + up, v + down, dv + at);
    for (sunindextype i = at; i < at + N; i++) {
      const sunrealtype uuv = u[i] * u[i] * v[i];
      du[i] += A + uuv - (B + 1) * u[i] + burning * s->source[i];
      dv[i] += B * u[i] - uuv;
    }
  }
  return 0;
}

/* -df/dp. */
static int slope(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const square *s = user;
  const sunindextype N = s->N;
  const sunrealtype *u = N_VGetArrayPointer(y), *v = u + s->cells;
  const sunrealtype c = -(sunrealtype)N * (sunrealtype)N;
  sunrealtype *du = N_VGetArrayPointer(out), *dv = du + s->cells;
  (void)t, (void)yp;
  for (sunindextype j = 0; j < N && k == ALPHA; j++) {
    const sunindextype at = j * N, up = (j + 1) % N * N, down = (j + N - 1) % N * N;
    diffuse(N, c, u + at, u + up, u + down, du + at);
    diffuse(N, c, v + at, v + up, v + down, dv + at);
  }
  for (sunindextype i = 0; i < s->cells && k != ALPHA; i++) {
    du[i] = k == FEED ? -1 : u[i];
    dv[i] = k == FEED ? 0 : -u[i];
  }
  return 0;
}

/* Columns of u: five rows of the u block, one of the v block; columns of v: one, then five. The
 * terms with u^2 v have the weight `reaction`, 0 or 1. */
static int fill(const square *s, N_Vector y, sunrealtype reaction, SUNMatrix J)
{
  const sunindextype M = s->cells;
  const sunrealtype *u = N_VGetArrayPointer(y), *v = u + M;
  if (SUNMatGetID(J) != SUNMATRIX_SPARSE || SM_SPARSETYPE_S(J) != CSC_MAT ||
      SM_NNZ_S(J) < 12 * M)
    return -1;
  memcpy(SM_INDEXPTRS_S(J), s->column, (size_t)(2 * M + 1) * sizeof *s->column);
  memcpy(SM_INDEXVALS_S(J), s->row, (size_t)(12 * M) * sizeof *s->row);
  const sunrealtype spread = spread_of(s), B = s->p[DRAIN];
  sunrealtype *of_u = SM_DATA_S(J), *of_v = of_u + 6 * M;
  for (sunindextype i = 0; i < M; i++, of_u += 6, of_v += 6) {
    const sunrealtype uu = reaction * u[i] * u[i], uv2 = 2 * reaction * u[i] * v[i];
    const sunindextype *row = s->row + 6 * i;
    for (int k = 0; k < 5; k++) {
      of_u[k] = spread * (row[k] == i ? -4 : 1) + (row[k] == i ? uv2 - (B + 1) : 0);
      of_v[k + 1] = spread * (row[k] == i ? -4 : 1) - (row[k] == i ? uu : 0);
    }
    of_u[5] = B - uv2;
    of_v[0] = uu;
  }
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  (void)t, (void)fy, (void)tmp1, (void)tmp2, (void)tmp3;
  return fill(user, y, 1, J);
}

static int linear_part(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix L, void *user)
{
  (void)t, (void)yp;
  return fill(user, y, 0, L);
}

/* The five rows of cell (i, j), ascending. */
static void neighbours(sunindextype N, sunindextype i, sunindextype j, sunindextype *row)
{
  const sunindextype all[] = {j * N + i, j * N + (i + 1) % N, j * N + (i + N - 1) % N,
                              (j + 1) % N * N + i, (j + N - 1) % N * N + i};
  for (int k = 0; k < 5; k++) {
    int place = k;
    for (; place > 0 && row[place - 1] > all[k]; place--) row[place] = row[place - 1];
    row[place] = all[k];
  }
}

static void lay_out(square *s)
{
  const sunindextype N = s->N, M = s->cells;
  for (sunindextype c = 0; c < M; c++) {
    sunindextype *of_u = s->row + 6 * c, *of_v = of_u + 6 * M;
    neighbours(N, c % N, c / N, of_u);
    for (int k = 0; k < 5; k++) of_v[k + 1] = of_u[k] + M;
    of_u[5] = c + M;
    of_v[0] = c;
  }
  for (sunindextype c = 0; c <= 2 * M; c++) s->column[c] = 6 * c;
  s->pattern = (steif_pattern){s->column, s->row};
}

/* The disc in whole numbers, so that points on its rim are inside for every N. */
static void light(square *s)
{
  const sunindextype N = s->N;
  for (sunindextype c = 0; c < s->cells; c++) {
    const sunindextype i = c % N, j = c / N, dx = 10 * i - 3 * N, dy = 10 * j - 6 * N;
    const sunrealtype x = (sunrealtype)i / (sunrealtype)N, y = (sunrealtype)j / (sunrealtype)N;
    s->source[c] = dx * dx + dy * dy <= N * N ? HEAT : 0;
    s->start[c] = 22 * y * (1 - y) * sqrt(1 - y);
    s->start[c + s->cells] = 27 * x * (1 - x) * sqrt(1 - x);
  }
}

/* The reference for this N, NULL when there is none. */
static const steif_reference *known(square *s)
{
  const sunindextype N = s->N, apart = N / COARSEST;
  const sunrealtype *value = N == 16 ? end16 : N == 32 ? end32 : N == 64 ? end64 : NULL;
  if (!value) return NULL;
  for (int k = 0; k < POINTS; k++) {
    s->component[k] = apart * (point[k][1] * N + point[k][0]);
    s->component[POINTS + k] = s->cells + s->component[k];
  }
  s->reference =
    (steif_reference){.t = END,
                      .count = 2 * POINTS,
                      .component = s->component,
                      .value = value,
                      .digits = 12,
                      .source = "explicit Runge-Kutta of order 8, tolerances 1e-13 "
                                "and 1e-14 agree to 3e-13"};
  return &s->reference;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  int N;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"n", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "n", 3, 1024, 32, &N));
  const size_t M = (size_t)N * (size_t)N;
  square *s =
    stf_collection_allocate(ctx, self, sizeof *s + (14 * M + 1) * sizeof(sunindextype), 3 * M);
  if (!s) return STEIF_NO_MEMORY;
  s->N = N;
  s->cells = (sunindextype)M;
  s->p[FEED] = 1, s->p[DRAIN] = 3.4, s->p[ALPHA] = 0.1;
  s->parameters =
    (steif_parameters){.count = PARAMETERS, .value = s->p, .name = names, .dFdp = slope};
  self->parameters = &s->parameters;
  s->source = s->start + 2 * M;
  s->column = (sunindextype *)(s->source + M);
  s->row = s->column + 2 * M + 1;
  lay_out(s);
  light(s);
  self->n = 2 * s->cells;
  self->y0 = s->start;
  self->nnz = 12 * s->cells;
  self->pattern = &s->pattern;
  self->reference = known(s);
  return STEIF_OK;
}

const steif_problem steif_problem_bruss2d = {
  .about = "Brusselator with diffusion in two dimensions, n=32 points a side: E. Hairer and G. "
           "Wanner, Solving Ordinary Differential Equations II, Springer 1996, ch. IV.10",
  .t1 = END,
  .f = f,
  .jac = jac,
  .L = linear_part,
  .storage = STEIF_SPARSE,
  .breaks = breaks,
  .break_count = 1,
  .build = build,
  .destroy = stf_collection_release,
};
