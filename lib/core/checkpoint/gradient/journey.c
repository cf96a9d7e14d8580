/* journey.c: steps forward, logged and recorded, made again, and the way back where all are recorded.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checkpoint_file.h"
#include "journey.h"
#include <math.h>
#include <string.h>

/* ---- memory ------------------------------------------------------------------------------------ */

void stf_journey_took(stf_journey *J)
{
  const size_t now = (size_t)J->room * sizeof *J->log +
                     (size_t)J->window * J->back.width * sizeof *J->record + J->on_images +
                     J->on_passages;
  if (now > J->bytes) J->bytes = now;
}

/* `more` elements of `size` bytes in the place of *block, which holds `used`. */
static int longer(steif_context *ctx, void **block, size_t used, size_t more, size_t size)
{
  void *copy = stf_allocate(ctx, more, size);
  if (!copy) return STEIF_NO_MEMORY;
  if (used) memcpy(copy, *block, used * size);
  stf_release(ctx, *block);
  *block = copy;
  return STEIF_OK;
}

static void give_up_records(stf_journey *J)
{
  stf_release(J->back.ctx, J->record);
  J->record = NULL, J->window = J->recorded = 0;
  J->whole = false;
}

/* What may still be taken beside a log of so many steps and the images. */
size_t stf_journey_rest(const stf_journey *J, long log)
{
  const size_t others = (size_t)log * sizeof *J->log + J->on_images + J->on_passages;
  return J->limit > others ? J->limit - others : 0;
}

/* Room for one record more; where the limit forbids it the records are given up. */
static int grow_records(stf_journey *J)
{
  const size_t bytes = J->back.width * sizeof *J->record, rest = stf_journey_rest(J, J->room);
  long room = J->window ? 2 * J->window : 32;
  if ((size_t)(room + J->window) * bytes > rest) room = J->window + 1;
  if (J->out->checkpoints || (size_t)(room + J->window) * bytes > rest) {
    give_up_records(J);
    return STEIF_OK;
  }
  STEIF_TRY(longer(J->back.ctx, (void **)&J->record, (size_t)J->recorded * J->back.width,
                   (size_t)room * J->back.width, sizeof *J->record));
  J->window = room;
  stf_journey_took(J);
  return STEIF_OK;
}

static int grow_log(stf_journey *J)
{
  const long room = J->room ? 2 * J->room : 256;
  const size_t bytes = J->back.width * sizeof *J->record;
  if (J->whole && (size_t)J->window * bytes > stf_journey_rest(J, room + J->room))
    give_up_records(J);
  STEIF_TRY(
    longer(J->back.ctx, (void **)&J->log, (size_t)J->steps, (size_t)room, sizeof *J->log));
  J->room = room;
  stf_journey_took(J);
  return STEIF_OK;
}

static int log_step(stf_journey *J, const steif_solver *s)
{
  const stf_step *step = &s->step;
  if (J->steps == J->room) STEIF_TRY(grow_log(J));
  J->log[J->steps++] =
    (stf_logged){step->t - step->h, step->h,
                 stf_checksum(STF_ARRAY(step->y), (size_t)J->back.n * sizeof(sunrealtype))};
  return STEIF_OK;
}

/* ---- steps ------------------------------------------------------------------------------------- */

/* Advance the runner by one step, whose record goes to `record` (NULL: nowhere). */
static int step(stf_journey *J, steif_solver *s, sunrealtype *record)
{
  if (record) stf_copy(&J->back.space, stf_last(s), J->back.before);
  const long count = s->step.count;
  const int code = stf_step_untimed(s);
  if (code && code != STEIF_EVENT) return code;
  STEIF_CHECK(s->step.count == count + 1, s->ctx, STEIF_UNSUPPORTED,
              "a step of '%s' at t = %.12g was not one step", s->spec, s->step.t);
  return record ? stf_record_step(&J->back, s, J->back.before, record) : STEIF_OK;
}

static bool finished(const steif_solver *s)
{
  return s->finished || s->end >= s->t1 - 4 * STF_EPS * fabs(s->t1);
}

static int run(stf_journey *J)
{
  steif_solver *s = J->runner;
  J->whole = true, J->stands = -1;
  while (!finished(s)) {
    if (J->whole && J->recorded == J->window) STEIF_TRY(grow_records(J));
    STEIF_TRY(step(J, s, J->whole ? J->record + (size_t)J->recorded * J->back.width : NULL));
    if (J->whole) J->recorded++;
    stf_quiet_step(J);
    STEIF_TRY(stf_passages_see(J));
    STEIF_TRY(stf_along_step(J));
    STEIF_TRY(log_step(J, s));
    STEIF_TRY(stf_images_on_the_way(J));
  }
  stf_journey_took(J);
  return STEIF_OK;
}

static bool same(const stf_journey *J, long k)
{
  const N_Vector y = J->runner->step.y;
  return stf_checksum(STF_ARRAY(y), (size_t)J->back.n * sizeof(sunrealtype)) == J->log[k].hash;
}

/* All steps from the last image to `k` by a new solver. */
static int by_new_solver(stf_journey *J, long k, sunrealtype *record)
{
  J->always_new = true;
  STEIF_TRY(stf_images_revive(J));
  for (long i = J->stands; i <= k; i++) STEIF_TRY(step(J, J->runner, i == k ? record : NULL));
  return STEIF_OK;
}

/* Step `k` once more: to the same bits; the record after the window is for those that are not kept. */
int stf_journey_again(stf_journey *J, long k, sunrealtype *record)
{
  if (J->line && !record) record = J->record + (size_t)J->window * J->back.width;
  STEIF_TRY(step(J, J->runner, record));
  if (J->reused && !J->line && !same(J, k)) STEIF_TRY(by_new_solver(J, k, record));
  J->stands = k + 1;
  J->out->cost.recomputed_steps++;
  STEIF_CHECK(same(J, k), J->back.ctx, STEIF_UNSUPPORTED,
              "step %ld of problem '%s', from t = %.12g, made again, did not come to the same "
              "bits: do its callbacks remember something (begin, save, restore)?",
              k + 1, J->runner->problem->name, J->log[k].t);
  return J->line ? stf_push(&J->back, record) : STEIF_OK;
}

/* ---- back ---------------------------------------------------------------------------------------- */

int stf_journey_back(stf_journey *J)
{
  if (!J->whole) return stf_reversal(J);
  for (long k = 0; J->line && k < J->recorded; k++)
    STEIF_TRY(stf_push(&J->back, J->record + (size_t)k * J->back.width));
  STEIF_TRY(stf_journey_end(J));
  for (long k = J->recorded; k-- > 0;)
    STEIF_TRY(stf_passages_pull(J, k, J->record + (size_t)k * J->back.width));
  return STEIF_OK;
}

int stf_journey_forward(stf_journey *J)
{
  STEIF_TRY(stf_images_open(J));
  return run(J);
}

void stf_journey_close(stf_journey *J)
{
  stf_backwards *B = &J->back;
  while (J->images > 0) stf_images_drop(J);
  if (J->runner != B->home) steif_solver_free(&J->runner);
  stf_passages_close(J);
  stf_pool_free(&B->pool);
  steif_solver_free(&B->home);
  stf_release(B->ctx, J->image);
  stf_release(B->ctx, J->log);
  stf_release(B->ctx, J->record);
}
