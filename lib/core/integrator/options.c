/* options.c: defaults, and options completed and checked against a problem.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>
#include <string.h>

static const sunrealtype SPAN_LEAST = 1e-280; /* of time: first steps are 1e10 times smaller */

steif_options(steif_defaults)(void)
{
  return (steif_options){.rtol = 1e-6, .max_steps = 1000000};
}

void steif_defaults_sized(size_t bytes, steif_options *options)
{
  const steif_options ours = (steif_defaults)();
  if (!options) return;
  if (!bytes) bytes = sizeof ours;
  memset(options, 0, bytes);
  memcpy(options, &ours, bytes < sizeof ours ? bytes : sizeof ours);
}

static int check_mesh(steif_context *ctx, const steif_options *o, sunrealtype t0)
{
  STEIF_CHECK(o->mesh_size >= 2, ctx, STEIF_BAD_INPUT, "a mesh needs at least 2 times, got %zu",
              o->mesh_size);
  STEIF_CHECK(o->mesh[0] == t0, ctx, STEIF_BAD_INPUT,
              "the mesh begins at %.17g, the problem at %.17g", o->mesh[0], t0);
  for (size_t i = 1; i < o->mesh_size; i++)
    STEIF_CHECK(isfinite(o->mesh[i]) && o->mesh[i] > o->mesh[i - 1], ctx, STEIF_BAD_INPUT,
                "mesh times must ascend: number %zu is %.17g after %.17g", i, o->mesh[i],
                o->mesh[i - 1]);
  return STEIF_OK;
}

int stf_options_complete(steif_context *ctx, const steif_problem *p, steif_options *o,
                         sunindextype rows)
{
  if (o->rtol == 0) o->rtol = 1e-6;
  if (o->atol == 0) o->atol = o->rtol * (p->rtol_scale > 0 ? p->rtol_scale : 1);
  if (o->max_steps == 0) o->max_steps = steif_defaults().max_steps;
  if (o->t1 == 0) o->t1 = p->t1;
  if (o->mesh && o->mesh_size > 0) o->t1 = o->mesh[o->mesh_size - 1];
  STEIF_CHECK(o->rtol > 0 && o->rtol < 1, ctx, STEIF_BAD_INPUT,
              "rtol = %g must lie between 0 and 1", o->rtol);
  STEIF_CHECK(o->rtol >= 1e-14, ctx, STEIF_BAD_INPUT,
              "rtol = %g asks for more than double precision has: use 1e-14 or more", o->rtol);
  STEIF_CHECK(o->atol > 0 && isfinite(o->atol), ctx, STEIF_BAD_INPUT,
              "atol = %g must be positive and finite", o->atol);
  for (sunindextype i = 0; o->atols && i < rows; i++)
    STEIF_CHECK(o->atols[i] > 0 && isfinite(o->atols[i]), ctx, STEIF_BAD_INPUT,
                "atols[%lld] = %g must be positive and finite", (long long)i, o->atols[i]);
  STEIF_CHECK(o->h >= 0 && isfinite(o->h) && o->h0 >= 0 && isfinite(o->h0) && o->h_max >= 0 &&
                isfinite(o->h_max),
              ctx, STEIF_BAD_INPUT,
              "steps must be finite and not negative: h = %g, h0 = %g, h_max = %g", o->h, o->h0,
              o->h_max);
  STEIF_CHECK(o->max_steps > 0 && o->iterations >= 0 && o->newton >= 0 && isfinite(o->newton),
              ctx, STEIF_BAD_INPUT,
              "max_steps = %ld, iterations = %d, newton = %g must not be negative",
              o->max_steps, o->iterations, o->newton);
  STEIF_CHECK(o->max_seconds >= 0, ctx, STEIF_BAD_INPUT,
              "max_seconds = %g must not be negative; 0 means no limit", o->max_seconds);
  if (o->mesh) STEIF_TRY(check_mesh(ctx, o, p->t0));
  STEIF_CHECK(p->t1 > p->t0 || o->t1 != p->t1, ctx, STEIF_BAD_INPUT,
              "%s: no time interval; set options.t1, or in a model add 'time 0 to 10 {s}'",
              p->name);
  STEIF_CHECK(isfinite(o->t1) && o->t1 > p->t0, ctx, STEIF_BAD_INPUT,
              "the end t1 = %g must lie after the start t0 = %g of problem '%s'", o->t1, p->t0,
              p->name);
  STEIF_CHECK(
    o->t1 - p->t0 >= SPAN_LEAST, ctx, STEIF_BAD_INPUT,
    "the interval from t0 = %g to t1 = %g of problem '%s' is shorter than %g, and 1 / h "
    "of its steps would overflow: take another unit of time",
    p->t0, o->t1, p->name, SPAN_LEAST);
  return STEIF_OK;
}
