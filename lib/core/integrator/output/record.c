/* record.c: the dense output of all steps, by values at Chebyshev points.
 *
 * Points x_j = (1 - cos(j pi/d))/2 of a step and barycentric weights (-1)^j, halved at the ends
 * (J.-P. Berrut, L. N. Trefethen, SIAM Review 46, 2004).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>
#include <steif/record.h>
#include <string.h>

enum { DEGREE = 20, USUAL = 6 };

struct steif_record {
  steif_context *ctx;
  size_t n, count, room; /* steps kept, steps there is room for */
  int degree;            /* 0: the steps alone, count + 1 rows of y */
  sunrealtype point[DEGREE + 1];
  sunrealtype *t, *y; /* count + 1 times; count x (degree + 1) x n values */
  stf_pool *pool;
  N_Vector work; /* of the pool */
};

steif_record *steif_record_new(steif_context *ctx, sunindextype n, int degree)
{
  if (n < 1 || degree < STEIF_RECORD_STEPS || degree > DEGREE) {
    STEIF_FAIL(
      ctx, STEIF_BAD_INPUT,
      "a record of %lld components and degree %d: at least 1, and 0 .. %d are possible",
      (long long)n, degree, DEGREE);
    return NULL;
  }
  steif_record *r = stf_allocate(ctx, 1, sizeof *r);
  if (!r) return NULL;
  r->ctx = ctx, r->n = (size_t)n;
  r->degree = degree == STEIF_RECORD_STEPS ? 0 : degree ? degree : USUAL;
  const sunrealtype pi = acos(-1);
  for (int j = 0; j <= r->degree; j++) r->point[j] = (1 - cos(j * pi / r->degree)) / 2;
  return r;
}

void steif_record_free(steif_record **record)
{
  if (!record || !*record) return;
  steif_record *r = *record;
  stf_pool_free(&r->pool);
  stf_release(r->ctx, r->t);
  stf_release(r->ctx, r->y);
  stf_release(r->ctx, r);
  *record = NULL;
}

static size_t width(const steif_record *r) { return ((size_t)r->degree + 1) * r->n; }

/* `more` numbers in the place of `block`, which holds `used`. */
static sunrealtype *longer(steif_record *r, sunrealtype *block, size_t used, size_t more)
{
  sunrealtype *copy = stf_allocate(r->ctx, more, sizeof *copy);
  if (copy && used) memcpy(copy, block, used * sizeof *copy);
  if (copy) stf_release(r->ctx, block);
  return copy;
}

static int grow(steif_record *r)
{
  const size_t room = r->room ? 2 * r->room : 64;
  sunrealtype *t = longer(r, r->t, r->count ? r->count + 1 : 0, room + 1);
  if (!t) return STEIF_NO_MEMORY;
  r->t = t;
  const size_t kept = r->degree ? r->count : r->room ? r->count + 1 : 0;
  sunrealtype *y = longer(r, r->y, kept * width(r), (room + 1) * width(r));
  if (!y) return STEIF_NO_MEMORY;
  r->y = y, r->room = room;
  return STEIF_OK;
}

static int begin(steif_record *r, const steif_solver *s, N_Vector y)
{
  STEIF_CHECK(stf_array(y) && N_VGetLength(y) == (sunindextype)r->n, r->ctx, STEIF_BAD_INPUT,
              "a record of %zu components needs vectors of as many with a host array", r->n);
  if (!r->pool) r->pool = stf_pool_new(r->ctx);
  r->work = r->pool ? stf_pool_vector(r->pool, y) : NULL;
  if (!r->work) return STEIF_NO_MEMORY;
  STEIF_TRY(grow(r));
  r->t[0] = s->problem->t0;
  return STEIF_OK;
}

static int keep_row(steif_record *r, const steif_solver *s, sunrealtype t, N_Vector y)
{
  if (!r->work) {
    STEIF_TRY(begin(r, s, y));
  } else {
    if (r->count == r->room) STEIF_TRY(grow(r));
    r->count++;
  }
  r->t[r->count] = t;
  memcpy(r->y + r->count * r->n, stf_array(y), r->n * sizeof *r->y);
  return STEIF_OK;
}

int steif_record_step(steif_solver *s, sunrealtype t, N_Vector y, void *record)
{
  steif_record *r = record;
  if (!s || !y || !r) return STEIF_BAD_INPUT;
  if (!r->degree) return keep_row(r, s, t, y);
  if (!r->work) STEIF_TRY(begin(r, s, y));
  const sunrealtype from = r->t[r->count];
  if (t <= from) return STEIF_OK; /* the other side of an event */
  if (r->count == r->room) STEIF_TRY(grow(r));
  sunrealtype *to = r->y + r->count * width(r);
  for (int j = 0; j <= r->degree; j++, to += r->n) {
    N_Vector v = j < r->degree ? r->work : y;
    if (j < r->degree) STEIF_TRY(stf_dense(s, from + r->point[j] * (t - from), v));
    memcpy(to, stf_array(v), r->n * sizeof *to);
  }
  r->t[++r->count] = t;
  return STEIF_OK;
}

/* The step of t: the last one that begins before or there. */
static size_t find(const steif_record *r, sunrealtype t)
{
  size_t low = 0, high = r->count;
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    if (r->t[middle] <= t)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Weights of the values at the points for the value at x, and for the slope by x. */
static void weigh(const steif_record *r, sunrealtype x, sunrealtype *value, sunrealtype *slope)
{
  const int d = r->degree;
  sunrealtype w[DEGREE + 1], sum = 0, bent = 0;
  int hit = -1;
  for (int j = 0; j <= d; j++) {
    w[j] = (j % 2 ? -1 : 1) * (j == 0 || j == d ? 0.5 : 1);
    if (x == r->point[j]) hit = j;
  }
  for (int j = 0; hit < 0 && j <= d; j++) {
    const sunrealtype q = w[j] / (x - r->point[j]);
    sum += q, bent += q / (x - r->point[j]);
  }
  for (int j = 0; j <= d; j++) {
    const sunrealtype off = (hit < 0 ? x : r->point[hit]) - r->point[j];
    value[j] = hit < 0 ? w[j] / off / sum : j == hit;
    slope[j] = hit < 0 ? value[j] * (bent / sum - 1 / off) : j == hit ? 0 : w[j] / w[hit] / off;
  }
  for (int j = 0; hit >= 0 && j <= d; j++)
    if (j != hit) slope[hit] -= slope[j];
}

int steif_record_at(const steif_record *r, sunrealtype t, sunrealtype *y, sunrealtype *yp)
{
  if (!r || !y) return STEIF_BAD_INPUT;
  STEIF_CHECK(r->degree, r->ctx, STEIF_BAD_INPUT,
              "a record of steps alone has no values between them: take degree 0, or 1 .. %d",
              DEGREE);
  STEIF_CHECK(r->count > 0 && t >= r->t[0] && t <= r->t[r->count], r->ctx, STEIF_BAD_INPUT,
              "t = %.17g lies outside the record of %zu steps, [%.17g, %.17g]", t, r->count,
              r->count ? r->t[0] : 0, r->count ? r->t[r->count] : 0);
  const size_t k = find(r, t);
  const sunrealtype h = r->t[k + 1] - r->t[k];
  sunrealtype value[DEGREE + 1], slope[DEGREE + 1];
  weigh(r, (t - r->t[k]) / h, value, slope);
  const sunrealtype *from = r->y + k * width(r);
  for (size_t i = 0; i < r->n; i++) {
    y[i] = 0;
    if (yp) yp[i] = 0;
    for (int j = 0; j <= r->degree; j++) {
      y[i] += value[j] * from[(size_t)j * r->n + i];
      if (yp) yp[i] += slope[j] / h * from[(size_t)j * r->n + i];
    }
  }
  return STEIF_OK;
}

size_t steif_record_steps(const steif_record *r, const sunrealtype **t)
{
  if (t) *t = r ? r->t : NULL;
  return r ? r->count : 0;
}

const sunrealtype *steif_record_values(const steif_record *r)
{
  return r && !r->degree ? r->y : NULL;
}
