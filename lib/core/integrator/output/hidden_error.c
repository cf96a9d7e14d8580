/* hidden_error.c: how large the errors of components of index 2 and 3 are: the distance of the solution shown from
 * that of a second run from the same start, for a hundredth of the tolerance, by what `auto` takes. Nothing
 * that one run leaves tells them: a point may fulfil all constraints and have moved along them, and what the steps
 * have left there, the problem has carried on.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>

static const sunrealtype finer = 0.01, finest = 1e-13, least = 0.2; /* parts of a tolerance */

/* To where the first run is shown, with every tolerance `part` of what it was. */
static steif_options second_options(const steif_solver *s, sunrealtype part, sunrealtype *atols)
{
  enum { TIMES = 4, FEW = 1000 };
  const steif_options *first = &s->options;
  steif_options o = steif_defaults();
  o.rtol = part * first->rtol;
  o.atol = part * first->atol;
  for (sunindextype i = 0; atols && i < s->problem->n; i++) atols[i] = part * first->atols[i];
  o.atols = atols;
  o.t1 = stf_side(s, s->t_shown) > s->t_shown ? s->t1 : s->t_shown; /* after a break, too */
  o.h_max = first->h_max;
  o.max_steps = TIMES * s->step.count + FEW;
  o.storage = first->storage, o.force_storage = first->force_storage;
  o.initial = first->initial, o.attributes = first->attributes;
  o.reinitialise = first->reinitialise;
  o.max_seconds = first->max_seconds, o.stop = first->stop;
  o.recompute = 1;
  return o;
}

/* Largest distance of components of index above 1, in tolerances. */
static sunrealtype largest(const steif_solver *s, const sunrealtype *y,
                           const sunrealtype *right)
{
  const int *index = s->problem->index;
  sunrealtype most = 0;
  for (sunindextype i = 0; i < s->problem->n; i++)
    if (index[i] > 1) most = fmax(most, fabs(y[i] - right[i]) / stf_allowed(s, y, (size_t)i));
  return most;
}

/* NaN where the second run does not arrive. */
static int second_run(steif_solver *s, stf_pool *pool, sunrealtype *error)
{
  steif_problem again = *s->given;
  sunrealtype *atols = NULL;
  if (s->options.atols) atols = stf_pool_array(pool, (size_t)again.n, sizeof *atols);
  if (s->options.atols && !atols) return STEIF_NO_MEMORY;
  if (!again.handle_event) again.events = 0;
  const steif_options o = second_options(s, fmax(finer, finest / s->options.rtol), atols);
  steif_solver *second = steif_solver_new(s->ctx, &again, "auto", &o);
  const int code = second ? steif_solve_to(second, s->t_shown) : steif_status(s->ctx);
  if (!code) *error = largest(s, stf_array(s->shown), stf_array(second->shown));
  steif_solver_free(&second);
  return code == STEIF_NO_MEMORY ? code : STEIF_OK;
}

/* With what the problem remembers as it was. */
static int beside(steif_solver *s, stf_pool *pool, sunrealtype *error)
{
  const steif_problem *p = s->given;
  const long bytes = p->save ? p->save(NULL, p->user) : 0;
  unsigned char *kept = bytes > 0 ? stf_pool_array(pool, (size_t)bytes, 1) : NULL;
  if (bytes > 0 && !kept) return STEIF_NO_MEMORY;
  if (bytes < 0 || (kept && p->save(kept, p->user) != bytes)) return STEIF_OK;
  const int code = second_run(s, pool, error);
  if (!p->save) return code;
  const int begun = p->begin ? p->begin(p->t0, p->user) : 0;
  const int restored = begun ? begun : p->restore(kept, (size_t)bytes, p->user);
  STEIF_CHECK(!restored, s->ctx, STEIF_CALLBACK,
              "begin or restore of problem '%s' returned %d after a second run", p->name,
              restored);
  return code;
}

/* What can be run again from the start, unseen, with finer tolerances. */
static bool served(const steif_solver *s)
{
  const steif_problem *p = s->problem;
  const stf_system *system = &s->step.system;
  const bool forgets = (p->begin || p->handle_event) && !p->save;
  return p->index && p->dae_index > 1 && p->n <= STEIF_DIAGNOSE_LARGEST &&
         system->space.serial && system->storage != STEIF_KRYLOV && !s->options.ewt &&
         !forgets && finest < least * s->options.rtol;
}

int steif_hidden_error(steif_solver *s, sunrealtype *error)
{
  if (!error) return STEIF_BAD_INPUT;
  *error = NAN;
  if (!s || s->engine || s->failed || !s->step.adaptive || s->step.count == 0 ||
      !stf_array(s->shown) || !served(s))
    return STEIF_OK;
  stf_pool *pool = stf_pool_new(s->ctx);
  const bool before = stf_silence(s->ctx, true);
  const int code = pool ? beside(s, pool, error) : STEIF_NO_MEMORY;
  stf_silence(s->ctx, before);
  stf_pool_free(&pool);
  if (code == STEIF_NO_MEMORY) return STEIF_FAIL(s->ctx, code, "no memory for a second run");
  if (code == STEIF_OK) steif_forget(s->ctx);
  return code;
}
