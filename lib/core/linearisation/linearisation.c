/* linearisation.c: a problem at a point: residual, dense E = F_y' and B = F_y, names, sentences.
 *
 * Without Jacobian callbacks: differences of order 4, (8 (F(x+h) - F(x-h)) - F(x+2h) +
 * F(x-2h))/12h, with h and h/16 compared.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "linearisation.h"
#include "varying_mass.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* -- opening ----------------------------------------------------------------------------- */

static int check_inquiry(steif_context *ctx, const steif_problem *p, const steif_point *q)
{
  for (sunindextype j = 0; q && j < p->n; j++) {
    STEIF_CHECK(!q->y || isfinite(q->y[j]), ctx, STEIF_NOT_FINITE,
                "y[%lld] = %g of the point given for '%s' is not finite", (long long)j, q->y[j],
                p->name);
    STEIF_CHECK(!q->yp || isfinite(q->yp[j]), ctx, STEIF_NOT_FINITE,
                "yp[%lld] = %g of the point given for '%s' is not finite", (long long)j,
                q->yp[j], p->name);
    STEIF_CHECK(!q->size || q->size[j] > 0, ctx, STEIF_BAD_INPUT,
                "size[%lld] = %g of '%s' must be positive", (long long)j, q->size[j], p->name);
  }
  return STEIF_OK;
}

static int claim(stf_point *s)
{
  sunrealtype **all[] = {&s->y0, &s->yp0, &s->floor, &s->size};
  for (int i = 0; i < 4; i++)
    if (!(*all[i] = stf_pool_array(s->pool, s->n, sizeof **all[i]))) return STEIF_NO_MEMORY;
  s->scratch = stf_pool_array(s->pool, 6 * s->n, sizeof *s->scratch);
  return s->scratch ? STEIF_OK : STEIF_NO_MEMORY;
}

/* The point into y0, yp0 and the vectors. The entries of a constant pencil are measured by the start of
 * the problem: unknowns that a failing run has made large say nothing of them. */
static int put_point(stf_point *s, const steif_point *q, int form)
{
  stf_space space;
  bool known;
  const bool here = q && q->y, constant = s->problem.linear;
  stf_space_open(&space, s->y);
  if (!here || constant)
    STEIF_TRY(stf_system_start(s->ctx, &s->problem, form, &space, s->y, s->yp, &known));
  sunrealtype *y = stf_array(s->y), *yp = stf_array(s->yp);
  for (size_t j = 0; j < s->n; j++) {
    const sunrealtype begun = fabs(y[j]);
    if (here) y[j] = q->y[j];
    if (q && q->yp) yp[j] = q->yp[j];
    s->y0[j] = y[j], s->yp0[j] = yp[j];
    s->floor[j] = q && q->size                ? q->size[j]
                  : s->problem.rtol_scale > 0 ? s->problem.rtol_scale
                                              : 1;
    s->size[j] = exp2(round(log2((constant ? begun : fabs(y[j])) + s->floor[j])));
  }
  return STEIF_OK;
}

static void destroy_vector(void *v) { N_VDestroy(v); }

/* M(t, y) y' = f(t, y) is looked at as F(t, y, y') = 0. */
static int lower(stf_point *s, int *form)
{
  const steif_problem *p;
  steif_problem *copy;
  int variation = STF_CONSTANT;
  if (*form == STEIF_MASS)
    STEIF_TRY(stf_mass_variation(s->ctx, &s->problem, s->problem.t1, s->y, &variation));
  if (variation == STF_CONSTANT) return STEIF_OK;
  if (!(copy = stf_pool_array(s->pool, 1, sizeof *copy))) return STEIF_NO_MEMORY;
  *copy = s->problem;
  STEIF_TRY(stf_mass_lower(s->pool, s->ctx, copy, variation, s->y, &p));
  s->problem = *p;
  *form = STEIF_IMPLICIT;
  return STEIF_OK;
}

static int open(stf_point *s, const steif_point *q, int form)
{
  const steif_problem *p = &s->problem;
  N_Vector first = N_VNew_Serial(p->n, steif_sundials(s->ctx));
  STEIF_CHECK(first, s->ctx, STEIF_NO_MEMORY, "no memory for a vector of %lld components",
              (long long)p->n);
  STEIF_TRY(stf_pool_adopt(s->pool, first, destroy_vector));
  s->y = first;
  N_VConst(0, s->y);
  if (!(s->yp = stf_pool_vector(s->pool, first)) || !(s->r = stf_pool_vector(s->pool, first)))
    return STEIF_NO_MEMORY;
  STEIF_TRY(claim(s));
  STEIF_TRY(put_point(s, q, form));
  STEIF_TRY(lower(s, &form));
  s->analytic = stf_analytic(p, form);
  STEIF_TRY(stf_system_open(s->pool, s->ctx, p, form, p->storage, s->floor[0], s->floor, s->y,
                            s->yp, &s->system));
  return stf_constant_matrices(s->ctx, p, form, p->t1, s->y, "this analysis");
}

/* The smooth part of the interval where the point lies; at a break that after it, and after breaks too close for a
 * part of its own. */
static void find_part(stf_point *s)
{
  const steif_problem *p = &s->problem;
  s->from = -INFINITY, s->to = INFINITY;
  for (int i = 0; i < p->break_count && s->to == INFINITY; i++) {
    const sunrealtype at = p->breaks[i];
    if (at <= s->t || at - s->from <= 32 * STF_EPS * fabs(at))
      s->from = nextafter(at, INFINITY);
    else
      s->to = nextafter(at, -INFINITY);
  }
  s->t = fmax(s->t, s->from);
}

static sunrealtype within(const stf_point *s, sunrealtype t)
{
  return fmin(fmax(t, s->from), s->to);
}

int stf_point_open(steif_context *ctx, const steif_problem *problem, const steif_point *q,
                   stf_point *s)
{
  const int form = steif_problem_form(ctx, problem);
  if (!form) return steif_status(ctx);
  STEIF_CHECK(
    problem->storage != STEIF_KRYLOV, ctx, STEIF_UNSUPPORTED,
    "'%s' has products only (Krylov storage): a diagnosis looks at entries of E and A, "
    "give them as matrices",
    problem->name);
  STEIF_TRY(check_inquiry(ctx, problem, q));
  *s = (stf_point){.ctx = ctx, .problem = *problem, .n = (size_t)problem->n};
  s->t = s->problem.t0 = q && q->y ? q->t : problem->t0;
  if (s->problem.t1 < s->t) s->problem.t1 = s->t;
  find_part(s);
  const steif_names *names = problem->names;
  s->equation = q && q->equation ? q->equation : names ? names->equation : NULL;
  s->unknown = q && q->unknown ? q->unknown : names ? names->unknown : NULL;
  s->pool = stf_pool_new(ctx);
  if (!s->pool) return STEIF_NO_MEMORY;
  const int code = open(s, q, form);
  if (code) stf_point_close(s);
  return code;
}

void stf_point_close(stf_point *s) { stf_pool_free(&s->pool); }

/* -- words ------------------------------------------------------------------------------- */

const char *stf_point_equation(const stf_point *s, size_t i, char *room)
{
  if (s->equation) return s->equation[i];
  snprintf(room, STEIF_SPEC_WORD, "e%zu", i + 1);
  return room;
}

const char *stf_point_unknown(const stf_point *s, size_t j, char *room)
{
  if (s->unknown) return s->unknown[j];
  snprintf(room, STEIF_SPEC_WORD, "y%zu", j + 1);
  return room;
}

void stf_point_say(char *sentence, const char *format, ...)
{
  const size_t used = strlen(sentence);
  va_list list;
  va_start(list, format);
  vsnprintf(sentence + used, STEIF_SENTENCE - used, format, list);
  va_end(list);
}

bool stf_point_any(const stf_point *s, const int *flag, int least)
{
  for (size_t i = 0; i < s->n; i++)
    if (flag[i] >= least) return true;
  return false;
}

void stf_point_list(const stf_point *s, char *sentence, bool equations, const int *flag,
                    int least, bool counts)
{
  enum { SHOWN = 8 };
  char room[STEIF_SPEC_WORD];
  size_t shown = 0, left = 0;
  for (size_t i = 0; i < s->n; i++) {
    if (flag[i] < least) continue;
    if (shown == SHOWN) {
      left++;
      continue;
    }
    stf_point_say(sentence, "%s%s", shown++ ? ", " : "",
                  (equations ? stf_point_equation : stf_point_unknown)(s, i, room));
    if (counts) stf_point_say(sentence, " (%d)", flag[i]);
  }
  if (left) stf_point_say(sentence, " and %zu more", left);
}

sunrealtype stf_point_random(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return ((sunrealtype)(*state >> 8) + 0.5) / 8388608 - 1;
}

/* -- values ------------------------------------------------------------------------------ */

static bool finite(const sunrealtype *x, size_t n)
{
  for (size_t i = 0; i < n; i++)
    if (!isfinite(x[i])) return false;
  return true;
}

static void move_to(stf_point *s, const sunrealtype *y, const sunrealtype *yp)
{
  memcpy(stf_array(s->y), y, s->n * sizeof *y);
  memcpy(stf_array(s->yp), yp, s->n * sizeof *yp);
}

int stf_point_residual(stf_point *s, sunrealtype t, const sunrealtype *y, const sunrealtype *yp,
                       sunrealtype *r)
{
  move_to(s, y, yp);
  STEIF_TRY(stf_system_residual(&s->system, within(s, t), s->y, s->yp, s->r));
  memcpy(r, stf_array(s->r), s->n * sizeof *r);
  return finite(r, s->n) ? STEIF_OK : STEIF_RETRY;
}

static void expand(SUNMatrix M, size_t n, sunrealtype sign, sunrealtype *D)
{
  memset(D, 0, n * n * sizeof *D);
  if (!M) {
    for (size_t j = 0; j < n; j++) D[j * n + j] = sign;
  } else if (SUNMatGetID(M) == SUNMATRIX_SPARSE) {
    const sunindextype *ptr = SM_INDEXPTRS_S(M), *row = SM_INDEXVALS_S(M);
    for (size_t j = 0; j < n; j++)
      for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++)
        D[j * n + (size_t)row[k]] += sign * SM_DATA_S(M)[k];
  } else
    for (size_t j = 0; j < n; j++)
      for (size_t i = 0; i < n; i++) {
        const sunindextype a = (sunindextype)i, b = (sunindextype)j;
        if (SUNMatGetID(M) == SUNMATRIX_DENSE)
          D[j * n + i] = sign * SM_ELEMENT_D(M, a, b);
        else if (b - a <= SM_UBAND_B(M) && a - b <= SM_LBAND_B(M))
          D[j * n + i] = sign * SM_ELEMENT_B(M, a, b);
      }
}

/* out = dF/dx_j with increment h of x = y or y'; work: 2 n. */
static int difference(stf_point *s, char which, sunrealtype t, const sunrealtype *y,
                      const sunrealtype *yp, size_t j, sunrealtype h, sunrealtype *work,
                      sunrealtype *out)
{
  static const sunrealtype at[] = {1, -1, 2, -2}, weight[] = {8, -8, -1, 1};
  const sunrealtype *base = which == 'E' ? yp : y;
  sunrealtype *x = work, *r = work + s->n;
  memcpy(x, base, s->n * sizeof *x);
  memset(out, 0, s->n * sizeof *out);
  const volatile sunrealtype moved = base[j] + h;
  h = moved - base[j];
  for (int k = 0; k < 4; k++) {
    x[j] = base[j] + at[k] * h;
    STEIF_TRY(which == 'E' ? stf_point_residual(s, t, y, x, r)
                           : stf_point_residual(s, t, x, yp, r));
    for (size_t i = 0; i < s->n; i++) out[i] += weight[k] / (12 * h) * r[i];
  }
  return STEIF_OK;
}

int stf_point_column(stf_point *s, char which, sunrealtype t, const sunrealtype *y,
                     const sunrealtype *yp, size_t j, sunrealtype *column)
{
  const size_t n = s->n;
  sunrealtype *work = s->scratch, *fine = s->scratch + 2 * n, top = 0, off = 0;
  sunrealtype h =
    which == 'E' ? fmax(fabs(yp[j]), s->floor[j]) : fmax(fabs(y[j]), 1e-2 * s->floor[j]);
  int code = STEIF_RETRY;
  for (int k = 0; k < 3 && code > 0; k++) {
    h *= k ? 1.0 / 64 : 1e-3;
    code = difference(s, which, t, y, yp, j, h, work, column);
  }
  STEIF_TRY(code);
  STEIF_TRY(difference(s, which, t, y, yp, j, h / 16, work, fine));
  for (size_t i = 0; i < n; i++) {
    top = fmax(top, fabs(column[i]));
    off = fmax(off, fabs(column[i] - fine[i]));
  }
  if (off > 1e-9 * top) memcpy(column, fine, n * sizeof *fine);
  return STEIF_OK;
}

int stf_point_matrices(stf_point *s, sunrealtype t, const sunrealtype *y, const sunrealtype *yp,
                       sunrealtype *E, sunrealtype *B)
{
  const size_t n = s->n;
  if (s->analytic) {
    move_to(s, y, yp);
    STEIF_TRY(stf_system_linearise(&s->system, within(s, t), s->y, s->yp));
    expand(s->system.E, n, 1, E);
    expand(s->system.A, n, -1, B);
  } else {
    if (s->system.form != STEIF_IMPLICIT) expand(s->system.E, n, 1, E);
    for (size_t j = 0; j < n; j++) {
      STEIF_TRY(stf_point_column(s, 'B', t, y, yp, j, B + j * n));
      if (s->system.form == STEIF_IMPLICIT)
        STEIF_TRY(stf_point_column(s, 'E', t, y, yp, j, E + j * n));
    }
  }
  return finite(E, n * n) && finite(B, n * n) ? STEIF_OK : STEIF_RETRY;
}
