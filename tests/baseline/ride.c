/* ride.c: opens, steps and closes one engine by hand.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ride.h"
#include <nvector/nvector_serial.h>
#include <string.h>

steif_options ride_defaults(void)
{
  return (steif_options){.rtol = 1e-6, .atol = 1e-6, .max_steps = 1000000};
}

static const steif_engine *find(const char *name)
{
  for (size_t i = 0; i < stf_engine_count; i++)
    if (!strcmp(stf_engine_shelf[i].name, name)) return stf_engine_shelf[i].item;
  return NULL;
}

static int start(ride *r, const steif_problem *p)
{
  r->run.like = N_VNew_Serial(p->n, steif_sundials(r->ctx));
  r->run.pool = stf_pool_new(r->ctx);
  r->run.y = stf_pool_vector(r->run.pool, r->run.like);
  r->run.yp = stf_pool_vector(r->run.pool, r->run.like);
  memcpy(NV_DATA_S(r->run.y), p->y0, (size_t)p->n * sizeof *p->y0);
  if (p->yp0) memcpy(NV_DATA_S(r->run.yp), p->yp0, (size_t)p->n * sizeof *p->yp0);
  r->run.t = p->t0;
  return STEIF_OK;
}

int ride_open(ride *r, const steif_problem *p, const char *text, const steif_options *options)
{
  memset(r, 0, sizeof *r);
  r->ctx = steif_context_new(NULL);
  r->options = options ? *options : ride_defaults();
  if (r->options.t1 == 0) r->options.t1 = p->t1;
  r->run.ctx = r->ctx, r->run.problem = p, r->run.options = &r->options;
  r->run.form = steif_problem_form(r->ctx, p);
  if (!r->run.form) return r->code = steif_status(r->ctx);
  start(r, p);
  steif_spec spec;
  if ((r->code = steif_spec_parse(r->ctx, text, &spec))) return r->code;
  r->engine = find(spec.name);
  if (!r->engine) return r->code = STEIF_UNKNOWN_NAME;
  if (!(r->engine->forms & (unsigned)r->run.form)) return r->code = STEIF_UNSUPPORTED;
  r->state = stf_allocate(r->ctx, 1, r->engine->size);
  return r->code = r->engine->open(&r->run, r->state, &spec);
}

int ride_to(ride *r, sunrealtype t)
{
  while (!r->code && r->run.t < t) r->code = r->engine->step(&r->run, r->state, t);
  return r->code;
}

int ride_whole(ride *r, const steif_problem *p, const char *spec, const steif_options *options)
{
  ride_open(r, p, spec, options);
  return ride_to(r, p->t1);
}

sunrealtype ride_y(const ride *r, int i) { return NV_Ith_S(r->run.y, i); }

const char *ride_says(const ride *r) { return steif_message(r->ctx); }

void ride_close(ride *r)
{
  if (r->state) {
    r->engine->close(&r->run, r->state);
    stf_release(r->ctx, r->state);
  }
  stf_pool_free(&r->run.pool);
  if (r->run.like) N_VDestroy(r->run.like);
  steif_context_free(&r->ctx);
}
