/* kick_drift.c: kicks and drifts of a separable problem.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kick_drift.h"
#include <math.h>

/* -- kernels on arrays -------------------------------------------------------------------------
 *
 * What is written is summed on the way: a sum that is finite has finite terms. LANES components are
 * taken together, so that they fit vector registers; `to` may be `from`. */

enum { LANES = 8 };

typedef struct lanes {
  sunrealtype sum[LANES];
} lanes;

/* All terms finite? Where the sum of finite terms overflowed, by one more look at y. */
static bool finite(const lanes *s, sunindextype count, const sunrealtype *y)
{
  sunrealtype sum = 0;
  for (int k = 0; k < LANES; k++) sum += s->sum[k];
  for (sunindextype i = 0; !isfinite(sum) && i < count; i++)
    if (!isfinite(y[i])) return false;
  return true;
}

/* y = x + c v. */
static bool add(sunindextype count, sunrealtype c, const sunrealtype *v, const sunrealtype *x,
                sunrealtype *y)
{
  lanes s = {{0}};
  sunindextype i = 0;
  for (; i + LANES <= count; i += LANES) {
    sunrealtype u[LANES];
    for (int k = 0; k < LANES; k++) u[k] = x[i + k] + c * v[i + k];
    for (int k = 0; k < LANES; k++) y[i + k] = u[k];
    for (int k = 0; k < LANES; k++) s.sum[k] += u[k];
  }
  for (; i < count; i++) s.sum[0] += y[i] = x[i] + c * v[i];
  return finite(&s, count, y);
}

/* P = p + a F, Q = q + b P; what is not finite in P shows in Q. */
static bool add_twice(sunindextype count, sunrealtype a, const sunrealtype *F, sunrealtype b,
                      const sunrealtype *p, const sunrealtype *q, sunrealtype *P,
                      sunrealtype *Q)
{
  lanes s = {{0}};
  sunindextype i = 0;
  for (; i + LANES <= count; i += LANES) {
    sunrealtype u[LANES], v[LANES];
    for (int k = 0; k < LANES; k++) u[k] = p[i + k] + a * F[i + k];
    for (int k = 0; k < LANES; k++) v[k] = q[i + k] + b * u[k];
    for (int k = 0; k < LANES; k++) P[i + k] = u[k];
    for (int k = 0; k < LANES; k++) Q[i + k] = v[k];
    for (int k = 0; k < LANES; k++) s.sum[k] += v[k];
  }
  for (; i < count; i++) {
    P[i] = p[i] + a * F[i];
    s.sum[0] += Q[i] = q[i] + b * P[i];
  }
  return finite(&s, count, Q);
}

/* (y, f) = (x, e) + c v, compensated. */
static bool add_exactly(sunindextype count, sunrealtype c, const sunrealtype *v,
                        const sunrealtype *x, const sunrealtype *e, sunrealtype *y,
                        sunrealtype *f)
{
  lanes s = {{0}};
  sunindextype i = 0;
  for (; i + LANES <= count; i += LANES) {
    sunrealtype d[LANES], u[LANES];
    for (int k = 0; k < LANES; k++) d[k] = c * v[i + k] + e[i + k];
    for (int k = 0; k < LANES; k++) u[k] = x[i + k] + d[k];
    for (int k = 0; k < LANES; k++) d[k] -= u[k] - x[i + k];
    for (int k = 0; k < LANES; k++) f[i + k] = d[k];
    for (int k = 0; k < LANES; k++) y[i + k] = u[k];
    for (int k = 0; k < LANES; k++) s.sum[k] += u[k];
  }
  for (; i < count; i++) {
    const sunrealtype d = c * v[i] + e[i], sum = x[i] + d;
    f[i] = d - (sum - x[i]);
    s.sum[0] += y[i] = sum;
  }
  return finite(&s, count, y);
}

static void copy(sunindextype count, const sunrealtype *x, sunrealtype *y)
{
  for (sunindextype i = 0; x != y && i < count; i++) y[i] = x[i];
}

/* The part `at` .. of a vector that may not be there. */
static sunrealtype *part(N_Vector v, sunindextype at) { return v ? STF_ARRAY(v) + at : NULL; }

/* to = from + c v on `count` components from `at`; with c = 0 a copy. */
static bool half(sunindextype count, sunindextype at, sunrealtype c, const sunrealtype *v,
                 stf_point from, stf_point to)
{
  const sunrealtype *x = part(from.y, at), *e = part(from.e, at);
  sunrealtype *y = part(to.y, at), *f = part(to.e, at);
  if (c != 0) return f ? add_exactly(count, c, v, x, e, y, f) : add(count, c, v, x, y);
  copy(count, x, y);
  if (f) copy(count, e, f);
  return true;
}

/* -- halves -------------------------------------------------------------------------------------- */

static int evaluate(stf_system *s, steif_rhs rhs, const char *what, sunrealtype t, N_Vector y,
                    N_Vector out)
{
  s->nfe++;
  const int returned = rhs(t, y, out, s->problem->user);
  if (returned == 0) return STEIF_OK;
  if (returned > 0)
    return STEIF_RECOVER(
      s->ctx, STEIF_CALLBACK,
      "%s of problem '%s' could not be evaluated at t = %.12g (it returned %d)", what,
      s->problem->name, t, returned);
  return STEIF_FAIL(s->ctx, STEIF_CALLBACK,
                    "%s of problem '%s' stopped the run at t = %.12g (it returned %d)", what,
                    s->problem->name, t, returned);
}

/* One half of f: by its own callback, or all of f and the other half cleared. */
static int rate(stf_kick_drift *h, steif_rhs own, const char *what, N_Vector mask,
                sunrealtype t, N_Vector y, N_Vector out)
{
  stf_system *s = h->system;
  if (own) return evaluate(s, own, what, t, y, out);
  STEIF_TRY(evaluate(s, s->problem->f, "f", t, y, out));
  if (mask) N_VProd(mask, out, out);
  return STEIF_OK;
}

int stf_kick_drift_force(stf_kick_drift *h, sunrealtype t, N_Vector y, N_Vector force)
{
  return rate(h, h->system->problem->kick, "kick", h->mask[1], t, y, force);
}

static int overflowed(const stf_kick_drift *h, sunrealtype t)
{
  return STEIF_RECOVER(h->system->ctx, STEIF_NOT_FINITE,
                       "the step of problem '%s' near t = %.12g overflowed: the step is too "
                       "large for a method that is explicit",
                       h->system->problem->name, t);
}

/* With q' = p a kick and the drift after it are one loop. Compensated sums go block by
 * block, so that the momenta are still in the cache when the positions need them. */
static int serial_unit(stf_kick_drift *h, sunrealtype a, N_Vector force, sunrealtype b,
                       sunrealtype t, stf_point from, stf_point to)
{
  enum { BLOCK = 512 };
  const sunindextype m = h->m;
  const sunrealtype *F = part(force, m), *p = part(to.y, m);
  if (a != 0 && b != 0 && !to.e)
    return add_twice(m, a, F, b, part(from.y, m), part(from.y, 0), part(to.y, m), part(to.y, 0))
             ? STEIF_OK
             : overflowed(h, t);
  bool good = true;
  for (sunindextype at = 0; at < m; at += BLOCK) {
    const sunindextype size = m - at < BLOCK ? m - at : BLOCK;
    good &= half(size, m + at, a, a != 0 ? F + at : NULL, from, to);
    good &= half(size, at, b, p + at, from, to);
  }
  return good ? STEIF_OK : overflowed(h, t);
}

static int serial(stf_kick_drift *h, sunrealtype a, N_Vector force, sunrealtype b,
                  sunrealtype t, stf_point from, stf_point to)
{
  const sunindextype rest = h->system->space.n - h->m;
  bool good = half(h->m, 0, 0, NULL, from, to); /* f may be asked for all of `to` */
  good &= half(rest, h->m, a, part(force, h->m), from, to);
  if (good && b != 0) {
    STEIF_TRY(rate(h, h->system->problem->drift, "drift", NULL, t, to.y, h->speed));
    good &= half(h->m, 0, b, part(h->speed, 0), to, to);
  }
  return good ? STEIF_OK : overflowed(h, t);
}

static void move(stf_kick_drift *h, sunrealtype c, N_Vector v, stf_point at)
{
  const stf_space *space = &h->system->space;
  if (!at.e) {
    stf_axpy(space, c, v, at.y);
    return;
  }
  stf_scale(space, c, v, h->increment);
  stf_copy(space, at.y, h->moved);
  stf_add_compensated(space, h->increment, (stf_point){h->moved, at.e}, at);
}

static int general(stf_kick_drift *h, sunrealtype a, N_Vector force, sunrealtype b,
                   sunrealtype t, stf_point from, stf_point to)
{
  const stf_space *space = &h->system->space;
  if (from.y != to.y) stf_copy(space, from.y, to.y);
  if (from.y != to.y && to.e) stf_copy(space, from.e, to.e);
  if (a != 0) move(h, a, force, to);
  if (b != 0) {
    STEIF_TRY(rate(h, h->system->problem->drift, "drift", h->mask[0], t, to.y, h->speed));
    move(h, b, h->speed, to);
  }
  return stf_finite(space, to.y) ? STEIF_OK : overflowed(h, t);
}

int stf_kick_drift_pass(stf_kick_drift *h, sunrealtype a, N_Vector force, sunrealtype b,
                        sunrealtype t, stf_point from, stf_point to)
{
  if (!h->system->space.serial) return general(h, a, force, b, t, from, to);
  return (h->unit ? serial_unit : serial)(h, a, force, b, t, from, to);
}

void stf_add_compensated(const stf_space *space, N_Vector increment, stf_point from,
                         stf_point to)
{
  if (space->serial) {
    add_exactly(space->n, 1, STF_ARRAY(increment), STF_ARRAY(from.y), STF_ARRAY(from.e),
                STF_ARRAY(to.y), STF_ARRAY(to.e));
    return;
  }
  N_VLinearSum(1, increment, 1, from.e, increment);
  N_VLinearSum(1, from.y, 1, increment, to.y);
  N_VLinearSum(1, to.y, -1, from.y, to.e);
  N_VLinearSum(1, increment, -1, to.e, to.e);
}

/* -- opening ------------------------------------------------------------------------------------- */

static int check(stf_system *s, const char *name)
{
  const steif_problem *p = s->problem;
  const long long m = (long long)p->positions, n = (long long)p->n;
  STEIF_CHECK(
    m != 0, s->ctx, STEIF_UNSUPPORTED,
    "'%s' splits q' = T_p(p), p' = -V_q(q), and problem '%s' is not declared separable: "
    "set .positions, or take gauss:s=2, which is symplectic for any Hamiltonian",
    name, p->name);
  STEIF_CHECK(m > 0 && m < n, s->ctx, STEIF_BAD_INPUT,
              "problem '%s' has positions = %lld: it must lie in 1 .. %lld", p->name, m, n - 1);
  STEIF_CHECK(!p->unit_mass || 2 * m == n, s->ctx, STEIF_BAD_INPUT,
              "problem '%s' says q' = p with %lld positions of %lld components: half is needed",
              p->name, m, n);
  return STEIF_OK;
}

/* y with positions (from = 0) or momenta moved by a ten-thousandth, unevenly. */
static void moved(const stf_kick_drift *h, int from, N_Vector y, N_Vector out)
{
  const sunindextype n = h->system->space.n, low = from ? h->m : 0, high = from ? n : h->m;
  stf_copy(&h->system->space, y, out);
  for (sunindextype i = low; i < high; i++)
    STF_ARRAY(out)[i] += 1e-4 * (1 + fabs(STF_ARRAY(y)[i])) / (sunrealtype)(1 + i % 7);
}

/* Where a and b differ by more than rounding, or -1. */
static sunindextype differs(N_Vector a, N_Vector b, sunindextype low, sunindextype high)
{
  sunrealtype size = 0;
  for (sunindextype i = low; i < high; i++) size = fmax(size, fabs(STF_ARRAY(b)[i]));
  for (sunindextype i = low; i < high; i++)
    if (fabs(STF_ARRAY(a)[i] - STF_ARRAY(b)[i]) > 1e-12 * size) return i;
  return -1;
}

/* q' must not change with q, nor p' with p. A point that cannot be evaluated proves nothing. */
static int separable(stf_kick_drift *h, const char *name, N_Vector y, N_Vector slope,
                     N_Vector at, N_Vector f)
{
  stf_system *s = h->system;
  const steif_problem *p = s->problem;
  for (int from = 0; from < 2; from++) {
    const char half_name = from ? 'p' : 'q';
    moved(h, from, y, at);
    s->nfe++;
    if (p->f(p->t0, at, f, p->user)) continue;
    const sunindextype i = differs(f, slope, from ? h->m : 0, from ? s->space.n : h->m);
    STEIF_CHECK(
      i < 0, s->ctx, STEIF_UNSUPPORTED,
      "'%s' splits q' = T_p(p), p' = -V_q(q), but component %lld of f of problem '%s', "
      "of %c', changes with %c: it is not separable; take gauss:s=2",
      name, (long long)i + 1, p->name, half_name, half_name);
  }
  return STEIF_OK;
}

/* The halves given are those of f. */
static int same(stf_kick_drift *h, N_Vector y, N_Vector slope, N_Vector f)
{
  stf_system *s = h->system;
  const steif_problem *p = s->problem;
  const steif_rhs own[] = {p->drift, p->kick};
  static const char *const what[] = {"drift", "kick"};
  for (int k = 0; k < 2; k++) {
    if (!own[k]) continue;
    const int code = evaluate(s, own[k], what[k], p->t0, y, f);
    if (code) return code > 0 ? STEIF_CALLBACK : code;
    const sunindextype i = differs(f, slope, k ? h->m : 0, k ? s->space.n : h->m);
    STEIF_CHECK(
      i < 0, s->ctx, STEIF_BAD_INPUT,
      "component %lld of %s of problem '%s' is %.17g at the start, that of f is %.17g",
      (long long)i + 1, what[k], p->name, STF_ARRAY(f)[i < 0 ? 0 : i],
      STF_ARRAY(slope)[i < 0 ? 0 : i]);
  }
  for (sunindextype i = 0; p->unit_mass && i < h->m; i++)
    STEIF_CHECK(
      STF_ARRAY(slope)[i] == STF_ARRAY(y)[h->m + i], s->ctx, STEIF_BAD_INPUT,
      "problem '%s' says q' = p, but q'[%lld] = %.17g and p[%lld] = %.17g at the start",
      p->name, (long long)i, STF_ARRAY(slope)[i], (long long)i, STF_ARRAY(y)[h->m + i]);
  return STEIF_OK;
}

/* Vectors with all components in one array are masked where a half has no callback of its own. */
static int masks(stf_pool *pool, stf_kick_drift *h, const char *name)
{
  stf_system *s = h->system;
  const N_Vector_ID kind = N_VGetVectorID(s->space.like);
  if (s->problem->kick && s->problem->drift) return STEIF_OK;
  STEIF_CHECK(kind == SUNDIALS_NVEC_OPENMP || kind == SUNDIALS_NVEC_PTHREADS, s->ctx,
              STEIF_UNSUPPORTED,
              "'%s' needs .kick and .drift of problem '%s' for vectors of this kind", name,
              s->problem->name);
  for (int k = 0; k < 2; k++) {
    if (!(h->mask[k] = stf_pool_vector(pool, s->space.like))) return STEIF_NO_MEMORY;
    sunrealtype *a = stf_array(h->mask[k]);
    for (sunindextype i = 0; i < s->space.n; i++) a[i] = (i < h->m) == (k == 0);
  }
  return STEIF_OK;
}

int stf_kick_drift_open(stf_pool *pool, stf_system *s, const char *name, N_Vector y,
                        N_Vector slope, stf_kick_drift *h)
{
  *h = (stf_kick_drift){.system = s, .m = s->problem->positions};
  STEIF_TRY(check(s, name));
  h->speed = stf_pool_vector(pool, y);
  h->increment = stf_pool_vector(pool, y);
  h->moved = stf_pool_vector(pool, y);
  if (!h->speed || !h->increment || !h->moved) return STEIF_NO_MEMORY;
  h->unit = s->space.serial && s->problem->unit_mass;
  if (!s->space.serial) return masks(pool, h, name);
  STEIF_TRY(separable(h, name, y, slope, h->moved, h->increment));
  return same(h, y, slope, h->increment);
}
