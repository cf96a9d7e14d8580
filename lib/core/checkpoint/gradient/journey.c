/* journey.c: steps forward, logged and recorded, and the way back, where need be from images of the solver.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checkpoint_file.h"
#include "journey.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { MOST = 1000 }; /* images */

/* ---- memory ------------------------------------------------------------------------------------ */

static void took(stf_journey *J)
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
static size_t rest_of(const stf_journey *J, long log)
{
  const size_t others = (size_t)log * sizeof *J->log + J->on_images + J->on_passages;
  return J->limit > others ? J->limit - others : 0;
}

/* Room for one record more; where the limit forbids it the records are given up. */
static int grow_records(stf_journey *J)
{
  const size_t bytes = J->back.width * sizeof *J->record, rest = rest_of(J, J->room);
  long room = J->window ? 2 * J->window : 32;
  if ((size_t)(room + J->window) * bytes > rest) room = J->window + 1;
  if (J->out->checkpoints || (size_t)(room + J->window) * bytes > rest) {
    give_up_records(J);
    return STEIF_OK;
  }
  STEIF_TRY(longer(J->back.ctx, (void **)&J->record, (size_t)J->recorded * J->back.width,
                   (size_t)room * J->back.width, sizeof *J->record));
  J->window = room;
  took(J);
  return STEIF_OK;
}

static int grow_log(stf_journey *J)
{
  const long room = J->room ? 2 * J->room : 256;
  const size_t bytes = J->back.width * sizeof *J->record;
  if (J->whole && (size_t)J->window * bytes > rest_of(J, room + J->room)) give_up_records(J);
  STEIF_TRY(
    longer(J->back.ctx, (void **)&J->log, (size_t)J->steps, (size_t)room, sizeof *J->log));
  J->room = room;
  took(J);
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
  const int code = steif_solve_step(s);
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
    STEIF_TRY(stf_passages_see(J));
    STEIF_TRY(stf_along_step(J));
    STEIF_TRY(log_step(J, s));
  }
  took(J);
  return STEIF_OK;
}

/* Step `k` once more: to the same bits; the record after the window is for those that are not kept. */
static int again(stf_journey *J, long k, sunrealtype *record)
{
  steif_solver *s = J->runner;
  if (J->line && !record) record = J->record + (size_t)J->window * J->back.width;
  STEIF_TRY(step(J, s, record));
  J->stands = k + 1;
  const unsigned long long hash =
    stf_checksum(STF_ARRAY(s->step.y), (size_t)J->back.n * sizeof(sunrealtype));
  J->out->cost.recomputed_steps++;
  STEIF_CHECK(hash == J->log[k].hash, s->ctx, STEIF_UNSUPPORTED,
              "step %ld of problem '%s', from t = %.12g, made again, did not come to the same "
              "bits: do its callbacks remember something (begin, save, restore)?",
              k + 1, s->problem->name, J->log[k].t);
  return J->line ? stf_push(&J->back, record) : STEIF_OK;
}

/* ---- images ---------------------------------------------------------------------------------- */

static void path_of(const stf_journey *J, const stf_run_image *m, char *path, size_t room)
{
  snprintf(path, room, "%s/gradient-%ld-%p.image", J->out->folder, m->step, (const void *)J);
}

/* Of tangents beside an image. */
static size_t bytes_beside(const stf_journey *J)
{
  return J->line ? stf_push_size(&J->back) * sizeof(sunrealtype) : 0;
}

static int save_tangent(stf_journey *J, stf_run_image *m)
{
  if (!J->line) return STEIF_OK;
  m->tangent = stf_allocate(J->back.ctx, stf_push_size(&J->back), sizeof *m->tangent);
  if (!m->tangent) return STEIF_NO_MEMORY;
  stf_push_keep(&J->back, m->tangent);
  J->on_images += bytes_beside(J);
  return STEIF_OK;
}

static int save(stf_journey *J, long at)
{
  char path[4096];
  stf_run_image *m = &J->image[J->images];
  *m = (stf_run_image){.step = at};
  STEIF_TRY(stf_checkpoint_bytes(J->runner, NULL, 0, &m->bytes, &m->count));
  J->images++;
  const int lost = save_tangent(J, m);
  if (lost) return lost;
  if (!J->out->folder) {
    J->on_images += m->count;
    took(J);
    return STEIF_OK;
  }
  path_of(J, m, path, sizeof path);
  const int code = stf_disk_write(J->back.ctx, path, m->bytes, m->count);
  stf_release(J->back.ctx, m->bytes);
  m->bytes = NULL;
  return code;
}

static void drop(stf_journey *J)
{
  char path[4096];
  stf_run_image *m = &J->image[--J->images];
  if (m->bytes)
    J->on_images -= m->count;
  else {
    path_of(J, m, path, sizeof path);
    unlink(path);
  }
  stf_release(J->back.ctx, m->bytes);
  if (m->tangent) J->on_images -= bytes_beside(J);
  stf_release(J->back.ctx, m->tangent);
}

/* The runner goes on from the last image, unless it stands there. */
static int restore(stf_journey *J)
{
  char path[4096];
  const stf_run_image *m = &J->image[J->images - 1];
  if (J->stands == m->step) return STEIF_OK;
  unsigned char *bytes = m->bytes;
  size_t count = m->count;
  if (!bytes) {
    path_of(J, m, path, sizeof path);
    STEIF_TRY(stf_disk_read(J->back.ctx, path, &bytes, &count));
  }
  if (J->runner != J->back.home) steif_solver_free(&J->runner);
  J->runner = stf_checkpoint_revive(J->back.ctx, J->back.problem, &J->options, bytes, count);
  if (!m->bytes) stf_release(J->back.ctx, bytes);
  J->stands = m->step;
  if (J->line) stf_push_back(&J->back, m->tangent);
  return J->runner ? STEIF_OK : steif_status(J->back.ctx);
}

/* ---- back ---------------------------------------------------------------------------------------- */

/* Segments are units of `window` steps. */
static long first_of(const stf_journey *J, long unit) { return unit * J->window; }

static int pull_unit(stf_journey *J, long unit)
{
  const long from = first_of(J, unit),
             to = from + J->window < J->steps ? from + J->window : J->steps;
  for (long k = from; k < to; k++)
    STEIF_TRY(again(J, k, J->record + (size_t)(k - from) * J->back.width));
  if (!J->ended) STEIF_TRY(stf_journey_end(J));
  for (long k = to; k-- > from;)
    STEIF_TRY(stf_passages_pull(J, k, J->record + (size_t)(k - from) * J->back.width));
  return STEIF_OK;
}

/* Units from .. to - 1, the last image standing at `from`. */
static int reverse(stf_journey *J, long from, long to)
{
  while (to > from) {
    STEIF_TRY(restore(J));
    const int left = J->images_most - J->images;
    const long advance =
      to - from > 1 ? left > 0 ? stf_revolve_advance(to - from, left + 1) : to - from - 1 : 0;
    const long at = from + advance;
    for (long k = first_of(J, from); k < first_of(J, at); k++) STEIF_TRY(again(J, k, NULL));
    if (left == 0 || advance == 0)
      STEIF_TRY(pull_unit(J, at));
    else {
      STEIF_TRY(save(J, first_of(J, at)));
      STEIF_TRY(reverse(J, at, to));
      drop(J);
    }
    to = at;
  }
  return STEIF_OK;
}

/* Images grow with the factors that a run holds: that of its end. */
static int size_of_images(stf_journey *J, size_t *size)
{
  unsigned char *bytes = NULL;
  STEIF_TRY(stf_checkpoint_bytes(J->runner, NULL, 0, &bytes, size));
  stf_release(J->back.ctx, bytes);
  return STEIF_OK;
}

/* How many images there may be, and how many steps a segment has: within the limit. */
static int plan(stf_journey *J)
{
  size_t size = 0;
  STEIF_TRY(size_of_images(J, &size));
  if (size < J->image[0].count) size = J->image[0].count;
  const size_t unit = J->back.width * sizeof *J->record;
  const size_t log = (size_t)J->room * sizeof *J->log + J->on_passages;
  const size_t of_image = (J->out->folder ? 0 : size) + bytes_beside(J);
  const size_t unkept = J->line ? unit : 0;
  const size_t least = log + STF_FEWEST * of_image + unit + unkept;
  STEIF_CHECK(
    J->limit >= least, J->back.ctx, STEIF_BAD_INPUT,
    "a limit of %zu bytes is too small for the gradient of problem '%s': %ld steps, %d "
    "images of %zu bytes and the stages of a step need %zu; raise .memory%s",
    J->limit, J->back.problem->name, J->steps, STF_FEWEST, size, least,
    J->out->folder ? "" : " or set .folder");
  const size_t rest = J->limit - log - unkept;
  long images = J->out->checkpoints;
  if (!images)
    images =
      of_image ? (long)(rest / 2 / of_image) : (long)ceil(sqrt((double)J->steps)) + STF_FEWEST;
  if (images > MOST) images = MOST;
  if (images < STF_FEWEST) images = STF_FEWEST;
  STEIF_CHECK(
    (size_t)images * of_image + unit <= rest, J->back.ctx, STEIF_BAD_INPUT,
    "%ld images of %zu bytes are above the limit of %zu bytes: ask for fewer .checkpoints "
    "or raise .memory",
    images, size, J->limit);
  J->images_most = (int)images;
  /* With sqrt(N) images or more, segments between them: each step is made twice more, and no oftener. */
  const bool single = J->out->checkpoints && images * images < J->steps;
  const long window = single ? 1 : (long)((rest - (size_t)images * of_image) / unit);
  const long longest =
    J->out->checkpoints ? (J->steps + images - 1) / images : J->steps / images + 1;
  J->window = window > longest ? longest : window;
  return STEIF_OK;
}

static int back_by_images(stf_journey *J)
{
  STEIF_TRY(plan(J));
  stf_run_image *more = stf_allocate(J->back.ctx, (size_t)J->images_most, sizeof *more);
  if (!more) return STEIF_NO_MEMORY;
  more[0] = J->image[0];
  stf_release(J->back.ctx, J->image);
  J->image = more;
  J->record = stf_allocate(J->back.ctx, (size_t)(J->window + (J->line != NULL)) * J->back.width,
                           sizeof *J->record);
  if (!J->record) return STEIF_NO_MEMORY;
  took(J);
  return reverse(J, 0, (J->steps + J->window - 1) / J->window);
}

int stf_journey_back(stf_journey *J)
{
  if (!J->whole) return back_by_images(J);
  for (long k = 0; J->line && k < J->recorded; k++)
    STEIF_TRY(stf_push(&J->back, J->record + (size_t)k * J->back.width));
  STEIF_TRY(stf_journey_end(J));
  for (long k = J->recorded; k-- > 0;)
    STEIF_TRY(stf_passages_pull(J, k, J->record + (size_t)k * J->back.width));
  return STEIF_OK;
}

int stf_journey_forward(stf_journey *J)
{
  J->image = stf_allocate(J->back.ctx, 1, sizeof *J->image);
  if (!J->image) return STEIF_NO_MEMORY;
  STEIF_TRY(save(J, 0));
  return run(J);
}

void stf_journey_close(stf_journey *J)
{
  stf_backwards *B = &J->back;
  while (J->images > 0) drop(J);
  if (J->runner != B->home) steif_solver_free(&J->runner);
  stf_passages_close(J);
  stf_pool_free(&B->pool);
  steif_solver_free(&B->home);
  stf_release(B->ctx, J->image);
  stf_release(B->ctx, J->log);
  stf_release(B->ctx, J->record);
}
