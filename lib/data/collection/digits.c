/* digits.c: how many digits of a result agree with the exact solution or the reference.
 *
 *   scd   = -log10 max_i |y_i - r_i| / |r_i|,  r_i = 0 left out
 *   mescd = -log10 max_i |y_i - r_i| / (atol/rtol + |r_i|)
 *
 * Both are the measures of the Test Set for IVP Solvers (Mazzia, Magherini 2008). An error
 * below the unit round-off counts as the unit round-off: 15.95 digits are the most that double
 * precision can show. A component that is not finite gives -infinity.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include "problem.h"
#include <math.h>
#include <string.h>

typedef struct target {
  sunindextype count;
  const sunindextype *component; /* NULL: 0 .. count-1 */
  const sunrealtype *value;
} target;

/* Largest relative and mixed error; infinity for y_i not finite, scd < 0 when no r_i counts. */
static void measure(const target *r, const sunrealtype *y, sunrealtype floor_,
                    sunrealtype *relative, sunrealtype *mixed)
{
  *relative = -1;
  *mixed = -1;
  for (sunindextype i = 0; i < r->count; i++) {
    const sunrealtype value = r->value[i], size = fabs(value);
    const sunrealtype error = fabs(y[r->component ? r->component[i] : i] - value);
    const sunrealtype off = isfinite(error) ? error : INFINITY;
    if (size > 0 && !(off / size <= *relative)) *relative = off / size;
    if (floor_ + size > 0 && !(off / (floor_ + size) <= *mixed)) *mixed = off / (floor_ + size);
  }
}

/* -log10 of an error; NaN when there was none to measure. */
static sunrealtype digits(sunrealtype error)
{
  if (error < 0) return NAN;
  return -log10(error > 0.5 * STF_EPS ? error : 0.5 * STF_EPS);
}

/* The same time but for the rounding of a clock that was advanced step by step. */
static bool same_time(sunrealtype a, sunrealtype b)
{
  return fabs(a - b) <= 64 * STF_EPS * fmax(fabs(a), fabs(b));
}

/* r from .exact, in the vector `exact`; positive when the closed solution is not known at t. */
static int closed(steif_context *ctx, const steif_problem *problem, sunrealtype t,
                  N_Vector exact, target *r)
{
  const int code = problem->exact(t, exact, NULL, problem->user);
  STEIF_CHECK(code >= 0, ctx, STEIF_CALLBACK,
              "the exact solution of %s stopped with %d at t = %g", problem->name, code, t);
  *r = (target){problem->n, NULL, N_VGetArrayPointer(exact)};
  return code;
}

static int published(const steif_problem *problem, sunrealtype t, target *r)
{
  const steif_reference *known = problem->reference;
  if (!known || !same_time(t, known->t)) return 1;
  *r = (target){known->count ? known->count : problem->n,
                known->count ? known->component : NULL, known->value};
  return 0;
}

static int arguments(steif_context *ctx, const steif_problem *problem, N_Vector y,
                     sunrealtype atol_over_rtol)
{
  STEIF_CHECK(problem && y, ctx, STEIF_BAD_INPUT,
              "a problem, a vector and two places for the digits are needed, got NULL");
  STEIF_CHECK(atol_over_rtol >= 0, ctx, STEIF_BAD_INPUT, "atol/rtol = %g must not be negative",
              atol_over_rtol);
  const long long n = (long long)problem->n, length = (long long)N_VGetLength(y);
  STEIF_CHECK(
    length == n && N_VGetArrayPointer(y), ctx, STEIF_BAD_INPUT,
    "digits of %s need a vector of %lld components with an array on the host, got %lld",
    problem->name, n, length);
  return STEIF_OK;
}

/* The target at t; `exact` is NULL or a vector to hold the closed solution. */
static int aim(steif_context *ctx, const steif_problem *problem, sunrealtype t, N_Vector exact,
               target *r)
{
  const int code = exact ? closed(ctx, problem, t, exact, r) : 1;
  if (code <= 0 || published(problem, t, r) == 0) return code < 0 ? code : STEIF_OK;
  const bool has = problem->reference != NULL;
  return STEIF_FAIL(ctx, STEIF_UNSUPPORTED, "nothing is known of %s at t = %.17g: %s %.17g",
                    problem->name, t, has ? "its reference is at" : "it has none; its end is",
                    has ? problem->reference->t : problem->t1);
}

int steif_problem_digits(steif_context *ctx, const steif_problem *problem, sunrealtype t,
                         N_Vector y, sunrealtype atol_over_rtol, sunrealtype *scd,
                         sunrealtype *mescd)
{
  STF_NAMED(problem);
  STEIF_TRY(arguments(ctx, scd && mescd ? problem : NULL, y, atol_over_rtol));
  *scd = *mescd = NAN;
  N_Vector exact = problem->exact ? N_VClone(y) : NULL;
  STEIF_CHECK(exact || !problem->exact, ctx, STEIF_NO_MEMORY,
              "no memory for %lld components of the exact solution", (long long)problem->n);
  target r = {0};
  const int code = aim(ctx, problem, t, exact, &r);
  if (code == STEIF_OK) {
    sunrealtype relative, mixed;
    measure(&r, N_VGetArrayPointer(y), atol_over_rtol, &relative, &mixed);
    *scd = digits(relative);
    *mescd = digits(mixed);
  }
  if (exact) N_VDestroy(exact);
  return code;
}
