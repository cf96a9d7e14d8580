/* gmres.c: GMRES on vectors and on pairs of them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gmres.h"
#include <math.h>

/* Of the basis, as a product of norms: beyond it a second pass is made. */
static const double LOST = 1e4;

/* -- vectors ------------------------------------------------------------------------------------ */

static stf_pair at(const stf_gmres *g, int j, bool pair)
{
  return (stf_pair){g->basis[0][j], pair ? g->basis[1][j] : NULL};
}

static stf_pair of(N_Vector const *part, bool pair)
{
  return (stf_pair){part[0], pair ? part[1] : NULL};
}

static void scale(const stf_gmres *g, double c, stf_pair x)
{
  stf_scale(&g->space, c, x.re, x.re);
  if (x.im) stf_scale(&g->space, c, x.im, x.im);
}

/* x += sum c_i v_i, i < count, or that sum itself. */
static void combine(stf_gmres *g, int count, const stf_number *c, stf_pair x, bool add)
{
  const bool pair = x.im != NULL;
  for (int part = 0; part < (pair ? 2 : 1); part++) {
    int k = 0;
    if (add) g->terms[k] = part ? x.im : x.re, g->factors[k++] = 1;
    for (int i = 0; i < count; i++) {
      g->terms[k] = g->basis[part][i], g->factors[k++] = c[i].re;
      if (pair)
        g->terms[k] = g->basis[1 - part][i], g->factors[k++] = part ? c[i].im : -c[i].im;
    }
    stf_combine(&g->space, k, g->factors, g->terms, part ? x.im : x.re);
  }
}

/* -- inner products ------------------------------------------------------------------------------ */

/* Do the vectors know the part of an inner product that is theirs alone? */
static bool parted(const stf_gmres *g)
{
  const N_Vector_Ops ops = g->space.like->ops;
  const bool sums = ops->nvdotprodmultiallreduce || !stf_spread(g->space.like);
  return sums && (ops->nvdotprodmultilocal || ops->nvdotprodlocal);
}

/* sums[i] = x . v_i on this rank, or of all where the vectors do not part the two. */
static void local(const stf_gmres *g, int count, N_Vector x, N_Vector *v, double *sums)
{
  if (g->space.rows < 0 && count > 0 && parted(g))
    N_VDotProdMultiLocal(count, x, v, sums);
  else
    stf_dots_here(&g->space, count, x, v, sums);
}

/* Numbers of all ranks from those of this one. False: a callback has failed somewhere. */
static bool sum(stf_gmres *g, int count)
{
  N_Vector like = g->space.like;
  const bool one = parted(g), flag = one && g->deferred;
  g->sums_made += one ? 1 : count;
  if (flag) g->sums[count] = g->deferred->returned != 0;
  if (one && like->ops->nvdotprodmultiallreduce)
    like->ops->nvdotprodmultiallreduce(count + flag, like, g->sums);
  return !flag || g->sums[count] == 0;
}

static stf_pair weighed(stf_gmres *g, const stf_map *map, stf_pair x)
{
  if (!map->squares) return x;
  stf_by_component(&g->space, map->squares, x.re, g->weighed[0]);
  if (x.im) stf_by_component(&g->space, map->squares, x.im, g->weighed[1]);
  return of(g->weighed, x.im != NULL);
}

/* This rank's <v_i, x>, i < count, as `parts` rows of sums behind `from`, and <x, x>. Returns the end. */
static int products(stf_gmres *g, int count, stf_pair x, stf_pair wx, int from)
{
  const bool pair = x.im != NULL;
  double *s = g->sums + from;
  local(g, count, wx.re, g->basis[0], s);
  if (pair) {
    local(g, count, wx.im, g->basis[1], s + count);
    local(g, count, wx.im, g->basis[0], s + 2 * count);
    local(g, count, wx.re, g->basis[1], s + 3 * count);
  }
  double *norms = s + (pair ? 4 : 1) * count;
  local(g, 1, wx.re, &x.re, norms);
  if (pair) local(g, 1, wx.im, &x.im, norms + 1);
  return from + (pair ? 4 : 1) * count + (pair ? 2 : 1);
}

/* Their values after the sum: c_i += or = <v_i, x>; returns <x, x>. */
static double values(const stf_gmres *g, int count, bool pair, int from, stf_number *c)
{
  const double *s = g->sums + from;
  for (int i = 0; i < count; i++) {
    c[i].re = s[i] + (pair ? s[count + i] : 0);
    c[i].im = pair ? s[2 * count + i] - s[3 * count + i] : 0;
  }
  const double *norms = s + (pair ? 4 : 1) * count;
  return norms[0] + (pair ? norms[1] : 0);
}

/* -- iterations ----------------------------------------------------------------------------------- */

typedef struct solve {
  stf_gmres *g;
  const stf_map *map;
  stf_pair b, x;
  bool pair;
  double goal, lost; /* what the norm is to be; product of before / after */
  bool ended;        /* the space does not grow any more */
  int *answer;
} solve;

static bool stops(solve *s, int answer) { return (*s->answer = answer) != 0; }

/* The sum of what `products` left; false: stopped. */
static bool gather(solve *s, int count)
{
  stf_gmres *g = s->g;
  if (sum(g, count)) return true;
  return !stops(s, stf_deferred_settle(g->space.like, g->deferred, &g->culprit));
}

/* out = P^{-1} M x or M P^{-1} x; false: stopped. */
static bool apply(solve *s, stf_pair x, stf_pair out)
{
  const stf_map *map = s->map;
  const stf_pair between = of(s->g->work, s->pair);
  if (!map->precondition) return !stops(s, map->product(map->data, x, out));
  if (map->left)
    return !stops(s, map->product(map->data, x, between)) &&
           !stops(s, map->precondition(map->data, between, out));
  return !stops(s, map->precondition(map->data, x, between)) &&
         !stops(s, map->product(map->data, between, out));
}

/* The vector that remains of v_{j+1} after v_0 .. v_j have been taken out, of norm 1; returns the norm. */
static double remainder_of(solve *s, int j, stf_pair v, double before)
{
  stf_gmres *g = s->g;
  const int count = j + 1;
  double after = before;
  for (int i = 0; i < count; i++)
    after -= stf_square(g->H.column[i]), g->H.y[i] = stf_scaled(-1, g->H.column[i]);
  combine(g, count, g->H.y, v, true);
  s->lost *= after > 0 ? sqrt(before / after) : LOST;
  if (!(s->lost < LOST)) {
    stf_number *more = g->H.y;
    sum(g, products(g, count, v, weighed(g, s->map, v), 0));
    after = values(g, count, s->pair, 0, more);
    for (int i = 0; i < count; i++) {
      after -= stf_square(more[i]);
      g->H.column[i] = stf_plus(g->H.column[i], more[i]), more[i] = stf_scaled(-1, more[i]);
    }
    combine(g, count, more, v, true);
  }
  s->ended = !(after > before * STF_EPS * STF_EPS);
  if (s->ended) return 0;
  scale(g, 1 / sqrt(after), v);
  return sqrt(after);
}

/* Iteration j. False: stopped. */
static bool iterate(solve *s, int j)
{
  stf_gmres *g = s->g;
  const stf_pair v = at(g, j + 1, s->pair);
  if (!apply(s, at(g, j, s->pair), v)) return false;
  g->iterations++;
  if (!gather(s, products(g, j + 1, v, weighed(g, s->map, v), 0))) return false;
  const double before = values(g, j + 1, s->pair, 0, g->H.column);
  g->last = stf_hessenberg_add(&g->H, j, remainder_of(s, j, v, before));
  return true;
}

/* Iteration 0 from v_0 as it is, with its norm in the same sum. */
static bool iterate_ahead(solve *s, double *norm)
{
  stf_gmres *g = s->g;
  const stf_pair r = at(g, 0, s->pair), v = at(g, 1, s->pair);
  if (!apply(s, r, v)) return false;
  g->iterations++;
  const int mid = products(g, 0, r, weighed(g, s->map, r), 0);
  if (!gather(s, products(g, 1, v, weighed(g, s->map, v), mid))) return false;
  const double own = values(g, 0, s->pair, 0, NULL);
  double before = values(g, 1, s->pair, mid, g->H.column);
  *norm = sqrt(own);
  if (!(own > 0) || !isfinite(own)) return true;
  scale(g, 1 / *norm, r), scale(g, 1 / *norm, v);
  g->H.column[0] = stf_scaled(1 / own, g->H.column[0]), before /= own;
  stf_hessenberg_begin(&g->H, *norm);
  g->last = stf_hessenberg_add(&g->H, 0, remainder_of(s, 0, v, before));
  return true;
}

/* v_0 := the residual at x, with P^{-1} on the left; x = 0 at first. */
static bool residual(solve *s, bool first)
{
  stf_gmres *g = s->g;
  const stf_map *map = s->map;
  const stf_pair v = at(g, 0, s->pair), b = s->b, work = of(g->work, s->pair);
  const bool left = map->left && map->precondition;
  stf_pair r = b;
  if (!first) {
    if (stops(s, map->product(map->data, s->x, work))) return false;
    stf_sum(&g->space, 1, b.re, -1, work.re, work.re);
    if (b.im) stf_sum(&g->space, 1, b.im, -1, work.im, work.im);
    r = work;
  }
  if (left) return !stops(s, map->precondition(map->data, r, v));
  stf_copy(&g->space, r.re, v.re);
  if (r.im) stf_copy(&g->space, r.im, v.im);
  return true;
}

/* x += V y, with P^{-1} on the right. On the left the residual P^{-1} (b - M x) is known in the basis, and `start`
 * times it is a step of Richardson's iteration for nothing. */
static bool advance(solve *s, int count)
{
  stf_gmres *g = s->g;
  const stf_map *map = s->map;
  stf_hessenberg_solve(&g->H, count);
  if (!s->ended && (map->start.re != 0 || map->start.im != 0))
    stf_hessenberg_further(&g->H, count++, map->start);
  if (map->left || !map->precondition) {
    combine(g, count, g->H.y, s->x, true);
    return true;
  }
  const stf_pair u = of(g->work, s->pair), v = at(g, g->dimension, s->pair);
  combine(g, count, g->H.y, v, false);
  if (stops(s, map->precondition(map->data, v, u))) return false;
  stf_axpy(&g->space, 1, u.re, s->x.re);
  if (s->pair) stf_axpy(&g->space, 1, u.im, s->x.im);
  return true;
}

/* x = start v_0, v_0 of the length `norm` still. */
static void start_only(solve *s)
{
  if (s->map->start.re != 0 || s->map->start.im != 0)
    combine(s->g, 1, &s->map->start, s->x, false);
}

/* One space from x. Returns SOLVED, SHORT, NAN or STOPPED. */
static int space(solve *s, bool first)
{
  stf_gmres *g = s->g;
  const bool ahead = first && s->map->ahead;
  double norm;
  if (!residual(s, first)) return STF_GMRES_STOPPED;
  s->lost = 1, s->ended = false;
  if (ahead) {
    if (!iterate_ahead(s, &norm)) return STF_GMRES_STOPPED;
  } else {
    const stf_pair v = at(g, 0, s->pair);
    if (!gather(s, products(g, 0, v, weighed(g, s->map, v), 0))) return STF_GMRES_STOPPED;
    norm = sqrt(values(g, 0, s->pair, 0, NULL));
  }
  if (!isfinite(norm)) return STF_GMRES_NAN;
  if (first) g->first = norm, s->goal = fmax(s->map->tolerance, s->map->relative * norm);
  if (!ahead || norm == 0) g->last = norm;
  if (norm == 0) return STF_GMRES_SOLVED;
  if (!ahead && norm <= s->goal) {
    if (first) start_only(s);
    return STF_GMRES_SOLVED;
  }
  if (!ahead) scale(g, 1 / norm, at(g, 0, s->pair)), stf_hessenberg_begin(&g->H, norm);
  int count = ahead;
  while (count < g->dimension && !s->ended && (!count || g->last > s->goal))
    if (!iterate(s, count++)) return STF_GMRES_STOPPED;
  if (!isfinite(g->last)) return STF_GMRES_NAN;
  if (!advance(s, count)) return STF_GMRES_STOPPED;
  return g->last <= s->goal ? STF_GMRES_SOLVED : STF_GMRES_SHORT;
}

int stf_gmres_solve(stf_gmres *g, const stf_map *map, stf_pair b, stf_pair x, int *answer)
{
  solve s = {.g = g, .map = map, .b = b, .x = x, .pair = b.im != NULL, .answer = answer};
  stf_zero(&g->space, x.re);
  if (x.im) stf_zero(&g->space, x.im);
  int code = STF_GMRES_SHORT;
  for (int k = 0; k <= g->restarts && code == STF_GMRES_SHORT; k++) code = space(&s, k == 0);
  return code;
}

/* -- memory ------------------------------------------------------------------------------------- */

static bool parts(stf_pool *pool, stf_gmres *g, int part)
{
  N_Vector like = g->space.like;
  g->weighed[part] = stf_pool_vector(pool, like);
  g->work[part] = stf_pool_vector(pool, like);
  g->basis[part] = stf_pool_vectors(pool, g->dimension + 1, like);
  return g->weighed[part] && g->work[part] && g->basis[part];
}

int stf_gmres_open(stf_pool *pool, N_Vector like, int dimension, int restarts, stf_gmres *g)
{
  const size_t most = (size_t)dimension + 1;
  *g = (stf_gmres){.dimension = dimension, .restarts = restarts};
  stf_space_open(&g->space, like);
  g->terms = stf_pool_array(pool, 2 * most + 1, sizeof(N_Vector));
  g->factors = stf_pool_array(pool, 2 * most + 1, sizeof *g->factors);
  g->sums = stf_pool_array(pool, 4 * most + 9, sizeof *g->sums);
  const bool good = g->terms && g->factors && g->sums && parts(pool, g, 0);
  return good ? stf_hessenberg_open(pool, dimension, &g->H) : STEIF_NO_MEMORY;
}

int stf_gmres_pairs(stf_pool *pool, stf_gmres *g)
{
  if (g->basis[1]) return STEIF_OK;
  return parts(pool, g, 1) ? STEIF_OK : STEIF_NO_MEMORY;
}
