/* generated.c: descriptor systems E x' + F x = f(t) put together by a generator: the problem around
 * them, its callbacks and its exact start.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "generated.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* The largest n with dense matrices: 2 GB for E and A. */
enum { DENSE_MOST = 11000 };

void stf_linear_release(steif_context *ctx, steif_problem *self)
{
  stf_linear *l = self->user;
  (void)ctx;
  self->user = NULL;
  if (!l) return;
  stf_pool_free(&l->scratch);
  stf_pool *pool = l->pool;
  stf_pool_free(&pool);
}

static int allocate(stf_linear *l, sunindextype room_E, sunindextype room_F)
{
  const size_t n = (size_t)l->n;
  l->wave = stf_pool_array(l->pool, (size_t)l->room + 1, sizeof *l->wave);
  l->start = l->wave ? stf_pool_array(l->pool, n, sizeof *l->start) : NULL;
  l->index = l->start ? stf_pool_array(l->pool, n, sizeof *l->index) : NULL;
  if (!l->index) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < n; i++) l->index[i] = 1;
  STEIF_TRY(stf_sparse_open(l->scratch, l->n, room_E, &l->E));
  return stf_sparse_open(l->scratch, l->n, room_F, &l->F);
}

stf_linear *stf_linear_open(steif_context *ctx, steif_problem *self, sunindextype n,
                            sunindextype room_E, sunindextype room_F, sunindextype waves)
{
  stf_pool *pool = stf_pool_new(ctx);
  stf_linear *l = pool ? stf_pool_array(pool, 1, sizeof *l) : NULL;
  if (!l) {
    stf_pool_free(&pool);
    return NULL;
  }
  self->user = l;
  self->n = l->n = n;
  l->room = waves;
  l->pool = pool;
  l->scratch = stf_pool_new(ctx);
  return l->scratch && allocate(l, room_E, room_F) == STEIF_OK ? l : NULL;
}

void stf_linear_wave(stf_linear *l, sunindextype row, sunrealtype amplitude,
                     sunrealtype frequency, sunrealtype phase)
{
  const sunindextype k = l->waves++;
  if (k < l->room) l->wave[k] = (stf_wave){row, amplitude, frequency, phase};
}

static int sort(steif_context *ctx, stf_linear *l)
{
  const stf_sparse E = l->E, F = l->F;
  STEIF_CHECK(E.count <= E.room && F.count <= F.room && l->waves <= l->room, ctx,
              STEIF_BAD_INPUT,
              "%lld, %lld entries and %lld waves were put where %lld, %lld and %lld were "
              "announced: the generator counts wrongly",
              (long long)E.count, (long long)F.count, (long long)l->waves, (long long)E.room,
              (long long)F.room, (long long)l->room);
  STEIF_TRY(stf_sparse_sort(ctx, l->pool, &E, &l->E));
  STEIF_TRY(stf_sparse_sort(ctx, l->pool, &F, &l->F));
  stf_pool_free(&l->scratch);
  l->E.sorted = l->F.sorted = true;
  return STEIF_OK;
}

static int store(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  STEIF_TRY(stf_collection_storage(ctx, spec, self));
  STEIF_CHECK(self->storage != STEIF_BAND, ctx, STEIF_UNSUPPORTED,
              "'%s' has no band storage: choose dense or sparse", spec->name);
  STEIF_CHECK(
    self->storage != STEIF_DENSE || self->n <= DENSE_MOST, ctx, STEIF_UNSUPPORTED,
    "'%s' of %lld unknowns is too large for dense storage (at most %d): choose sparse",
    spec->name, (long long)self->n, DENSE_MOST);
  return STEIF_OK;
}

/* x(0+) becomes the start. */
static int jump_at_start(steif_context *ctx, stf_linear *l)
{
  sunrealtype *c = l->after + l->n;
  for (sunindextype i = 0; i < l->n * (l->dae_index > 1 ? l->dae_index - 1 : 0); i++) c[i] = 0;
  STEIF_TRY(l->jump(ctx, l, l->start, &(stf_exact_start){.x_plus = l->after, .c = c}));
  memcpy(l->start, l->after, (size_t)l->n * sizeof *l->start);
  return STEIF_OK;
}

static int choose_start(steif_context *ctx, const steif_spec *spec, stf_linear *l)
{
  const char *word = stf_spec_word(spec, "case");
  l->consistent = word && !strcmp(word, "cons");
  STEIF_CHECK(!word || l->consistent || !strcmp(word, "inc"), ctx, STEIF_UNKNOWN_NAME,
              "case=%s of '%s' is not known: choose inc or cons", word, spec->name);
  if (!l->consistent) return STEIF_OK;
  const int vectors = l->dae_index > 1 ? l->dae_index : 1;
  l->after = stf_pool_array(l->pool, (size_t)l->n * (size_t)vectors, sizeof *l->after);
  return l->after ? jump_at_start(ctx, l) : STEIF_NO_MEMORY;
}

/* ---- parameters ------------------------------------------------------------------------------- */

/* What depends on p, in a row: x(0-), the entries of E and F, the amplitudes of the waves. */
static size_t width(const stf_linear *l)
{
  return (size_t)(l->n + l->E.count + l->F.count + l->waves);
}

static void gather(const stf_linear *l, sunrealtype *to)
{
  memcpy(to, l->start, (size_t)l->n * sizeof *to), to += l->n;
  memcpy(to, l->E.value, (size_t)l->E.count * sizeof *to), to += l->E.count;
  memcpy(to, l->F.value, (size_t)l->F.count * sizeof *to), to += l->F.count;
  for (sunindextype k = 0; k < l->waves; k++) to[k] = l->wave[k].amplitude;
}

static int renew(stf_linear *l)
{
  stf_sparse *m[] = {&l->E, &l->F};
  for (int i = 0; i < 2; i++)
    for (sunindextype k = 0; k < m[i]->count; k++) m[i]->value[k] = 0;
  l->waves = 0;
  l->fill(l);
  return l->consistent ? jump_at_start(NULL, l) : 0;
}

/* Derivatives by p_k: central differences over three lengths, extrapolated to the sixth order; exact but for rounding
 * where p enters linearly. */
static int slopes(stf_linear *l, int k)
{
  static const sunrealtype factor[] = {1.0 / 45, -20.0 / 45, 64.0 / 45};
  const sunrealtype p = l->p[k], wide = (p != 0 ? fabs(p) : 1) / 128;
  const size_t size = width(l);
  sunrealtype *to = l->slope + (size_t)k * size, *end[2];
  for (int side = 0; side < 2; side++)
    end[side] = l->slope + (size_t)(l->parameters.count + side) * size;
  memset(to, 0, size * sizeof *to);
  int code = 0;
  for (int level = 0; !code && level < 3; level++) {
    const sunrealtype h = ldexp(wide, -level);
    for (int side = 0; !code && side < 2; side++) {
      l->p[k] = side ? p + h : p - h;
      code = renew(l);
      gather(l, end[side]);
    }
    const sunrealtype span = (p + h) - (p - h);
    for (size_t i = 0; i < size; i++) to[i] += factor[level] * (end[1][i] - end[0][i]) / span;
  }
  l->p[k] = p;
  return code;
}

static int follow(void *user)
{
  stf_linear *l = user;
  int code = renew(l);
  for (int k = 0; !code && k < l->parameters.count; k++) code = slopes(l, k);
  return code ? code : renew(l);
}

static int start_slope(int k, N_Vector S0, void *user)
{
  const stf_linear *l = user;
  memcpy(N_VGetArrayPointer(S0), l->slope + (size_t)k * width(l),
         (size_t)l->n * sizeof(sunrealtype));
  return 0;
}

/* out += M x, the pattern of m with other values. */
static const sunrealtype *add_product(const stf_sparse *m, const sunrealtype *value, N_Vector x,
                                      N_Vector out)
{
  for (sunindextype j = 0; j < m->n; j++)
    for (sunindextype k = m->at[j]; k < m->at[j + 1]; k++)
      N_VGetArrayPointer(out)[m->row[k]] += value[k] * N_VGetArrayPointer(x)[j];
  return value + m->count;
}

/* E_p x' + F_p x - f_p. */
static int slope_by_p(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const stf_linear *l = user;
  const sunrealtype *at = l->slope + (size_t)k * width(l) + l->n;
  N_VConst(0, out);
  at = add_product(&l->E, at, yp, out);
  at = add_product(&l->F, at, y, out);
  for (sunindextype i = 0; i < l->waves; i++)
    N_VGetArrayPointer(out)[l->wave[i].row] -=
      at[i] * cos(l->wave[i].frequency * t + l->wave[i].phase);
  return 0;
}

void stf_linear_depend(stf_linear *l, steif_problem *self, int count, const char *const *name,
                       void (*fill)(stf_linear *l))
{
  l->fill = fill;
  l->parameters = (steif_parameters){.count = count,
                                     .value = l->p,
                                     .name = name,
                                     .dFdp = slope_by_p,
                                     .start = start_slope,
                                     .moved = follow};
  self->parameters = &l->parameters;
  fill(l);
}

static int open_slopes(stf_linear *l)
{
  const size_t rows = (size_t)l->parameters.count + 2;
  if (!l->fill) return STEIF_OK;
  l->slope = stf_pool_array(l->pool, rows * width(l), sizeof *l->slope);
  return l->slope ? follow(l) : STEIF_NO_MEMORY;
}

int stf_linear_finish(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  stf_linear *l = self->user;
  STEIF_TRY(store(ctx, spec, self));
  STEIF_TRY(sort(ctx, l));
  STEIF_TRY(choose_start(ctx, spec, l));
  STEIF_TRY(open_slopes(l));
  self->y0 = l->start;
  self->index = l->index;
  self->dae_index = l->dae_index;
  self->nnz = l->F.count;
  self->nnz_E = l->E.count;
  return STEIF_OK;
}

static int sparse(const stf_sparse *m, sunrealtype factor, SUNMatrix M)
{
  if (SM_SPARSETYPE_S(M) != CSC_MAT || SM_NNZ_S(M) < m->count || SM_COLUMNS_S(M) != m->n)
    return -1;
  memcpy(SM_INDEXPTRS_S(M), m->at, (size_t)(m->n + 1) * sizeof *m->at);
  memcpy(SM_INDEXVALS_S(M), m->row, (size_t)m->count * sizeof *m->row);
  for (sunindextype k = 0; k < m->count; k++) SM_DATA_S(M)[k] = factor * m->value[k];
  return 0;
}

static int fill(const stf_sparse *m, sunrealtype factor, SUNMatrix M)
{
  if (SUNMatGetID(M) == SUNMATRIX_SPARSE) return sparse(m, factor, M);
  if (SUNMatGetID(M) != SUNMATRIX_DENSE || SM_COLUMNS_D(M) != m->n) return -1;
  for (sunindextype j = 0; j < m->n; j++)
    for (sunindextype k = m->at[j]; k < m->at[j + 1]; k++)
      SM_ELEMENT_D(M, m->row[k], j) = factor * m->value[k];
  return 0;
}

int stf_linear_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  (void)t, (void)y, (void)yp;
  return fill(&((const stf_linear *)user)->E, 1, M);
}

int stf_linear_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  (void)t, (void)y, (void)yp;
  return fill(&((const stf_linear *)user)->F, -1, M);
}

void stf_linear_force(const stf_linear *l, sunrealtype t, int order, sunrealtype *out)
{
  memset(out, 0, (size_t)l->n * sizeof *out);
  for (const stf_wave *w = l->wave; w < l->wave + l->waves; w++) {
    const sunrealtype phase = w->frequency * t + w->phase;
    const sunrealtype turn = order % 2 ? sin(phase) : cos(phase);
    const sunrealtype sign = order % 4 == 1 || order % 4 == 2 ? -1 : 1;
    out[w->row] += sign * w->amplitude * pow(w->frequency, order) * turn;
  }
}

static void add(const stf_sparse *m, const sunrealtype *x, sunrealtype *out)
{
  for (sunindextype j = 0; j < m->n; j++)
    for (sunindextype k = m->at[j]; k < m->at[j + 1]; k++) out[m->row[k]] += m->value[k] * x[j];
}

void stf_linear_times(const stf_linear *l, const sunrealtype *x, sunrealtype *out)
{
  memset(out, 0, (size_t)l->n * sizeof *out);
  add(&l->F, x, out);
}

void stf_linear_defect(const stf_linear *l, const sunrealtype *x, int order, sunrealtype *out)
{
  stf_linear_force(l, 0, order, out);
  for (sunindextype i = 0; i < l->n; i++) out[i] = -out[i];
  add(&l->F, x, out);
}

int stf_linear_g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  if (derivative < 0) return -1;
  stf_linear_force(user, t, derivative, N_VGetArrayPointer(out));
  return 0;
}

int stf_exact_start_find(steif_context *ctx, const steif_problem *problem, stf_exact_start *out)
{
  STEIF_CHECK(problem && out, ctx, STEIF_BAD_INPUT,
              "a problem and a place for its start are needed, got NULL");
  *out = (stf_exact_start){0};
  STEIF_CHECK(
    problem->destroy == stf_linear_release && problem->user, ctx, STEIF_UNSUPPORTED,
    "problem '%s' does not know its start: take a generated descriptor system such as "
    "stokes, springs or ladder",
    problem->name ? problem->name : "");
  const stf_linear *l = problem->user;
  const size_t n = (size_t)l->n;
  out->index = l->dae_index;
  out->finite = l->finite;
  out->x_plus = stf_allocate(ctx, n, sizeof *out->x_plus);
  if (out->x_plus && l->dae_index > 1)
    out->c = stf_allocate(ctx, (size_t)(l->dae_index - 1) * n, sizeof *out->c);
  const bool room = out->x_plus && (out->c || l->dae_index <= 1);
  const int code = room ? l->jump(ctx, l, problem->y0, out) : STEIF_NO_MEMORY;
  if (code) stf_exact_start_clear(ctx, out);
  return code;
}

void stf_exact_start_clear(steif_context *ctx, stf_exact_start *out)
{
  if (!out) return;
  stf_release(ctx, out->x_plus);
  stf_release(ctx, out->c);
  *out = (stf_exact_start){0};
}
