/* reversal.c: back through steps that are not recorded, from images of the solver: from those of the way forward where the
 * steps between two can be recorded at once, so that each step is made again once; else by the binomial schedule.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checkpoint_file.h"
#include "journey.h"
#include <math.h>

enum { MOST = 1000 }; /* images of the schedule, unless more are asked for */

/* ---- by the schedule, between two steps ---------------------------------------------------------- */

/* Steps base .. until - 1 are units of `window` steps. */
static long first_of(const stf_journey *J, long unit) { return J->base + unit * J->window; }

static int pull_unit(stf_journey *J, long unit)
{
  const long from = first_of(J, unit),
             to = from + J->window < J->until ? from + J->window : J->until;
  for (long k = from; k < to; k++)
    STEIF_TRY(stf_journey_again(J, k, J->record + (size_t)(k - from) * J->back.width));
  if (!J->ended) STEIF_TRY(stf_journey_end(J));
  for (long k = to; k-- > from;)
    STEIF_TRY(stf_passages_pull(J, k, J->record + (size_t)(k - from) * J->back.width));
  return STEIF_OK;
}

/* Units from .. to - 1, the last image standing at `from`. */
static int reverse(stf_journey *J, long from, long to)
{
  while (to > from) {
    STEIF_TRY(stf_images_restore(J));
    const int left = J->images_most - J->images;
    const long advance =
      to - from > 1 ? left > 0 ? stf_revolve_advance(to - from, left + 1) : to - from - 1 : 0;
    const long at = from + advance;
    for (long k = first_of(J, from); k < first_of(J, at); k++)
      STEIF_TRY(stf_journey_again(J, k, NULL));
    if (left == 0 || advance == 0)
      STEIF_TRY(pull_unit(J, at));
    else {
      STEIF_TRY(stf_images_save(J, first_of(J, at)));
      STEIF_TRY(reverse(J, at, to));
      stf_images_drop(J);
    }
    to = at;
  }
  return STEIF_OK;
}

static int reverse_all(stf_journey *J, long from, long to)
{
  J->base = from, J->until = to;
  return reverse(J, 0, (to - from + J->window - 1) / J->window);
}

static int open_window(stf_journey *J, long window)
{
  stf_release(J->back.ctx, J->record);
  J->window = window;
  J->record = stf_allocate(J->back.ctx, (size_t)(window + (J->line != NULL)) * J->back.width,
                           sizeof *J->record);
  if (!J->record) return STEIF_NO_MEMORY;
  stf_journey_took(J);
  return STEIF_OK;
}

/* ---- from images of the way forward -------------------------------------------------------------- */

/* Records that fit beside `images` bytes of them. */
static long records_beside(const stf_journey *J, size_t images)
{
  const size_t others = (size_t)J->room * sizeof *J->log + J->on_passages + images;
  return J->limit > others ? (long)((J->limit - others) / (J->back.width * sizeof *J->record))
                           : 0;
}

/* May all segments but the first be recorded at once, and the first in a few parts? */
static bool serve(const stf_journey *J)
{
  const long asked = J->out->checkpoints;
  if (J->line || J->stride == 0 || (asked && asked * asked < J->steps)) return false;
  long longest = 0;
  for (int i = 1; i < J->images; i++) {
    const long to = i + 1 < J->images ? J->image[i + 1].step : J->steps;
    if (to - J->image[i].step > longest) longest = to - J->image[i].step;
  }
  const long first = J->images > 1 ? J->image[1].step : J->steps;
  const size_t one = J->out->folder ? 0 : J->image[0].count;
  return records_beside(J, J->on_images) >= longest && 2 * records_beside(J, one) >= first;
}

static int by_segments(stf_journey *J)
{
  for (long to = J->steps;;) {
    const long from = J->image[J->images - 1].step, fit = records_beside(J, J->on_images);
    J->images_most = J->images;
    if (J->window < to - from) STEIF_TRY(open_window(J, to - from < fit ? to - from : fit));
    if (from < to) STEIF_TRY(reverse_all(J, from, to));
    to = from;
    if (to == 0) return STEIF_OK;
    stf_images_drop(J);
  }
}

/* ---- by the schedule, all of them ---------------------------------------------------------------- */

/* Images grow with the factors that a run holds: that of its end. */
static int size_of_images(stf_journey *J, size_t *size)
{
  unsigned char *bytes = NULL;
  STEIF_TRY(stf_checkpoint_image(J->runner, &bytes, size));
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
  const size_t of_image = (J->out->folder ? 0 : size) + stf_images_beside(J);
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
  if (images > MOST && !J->out->checkpoints) images = MOST;
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

int stf_reversal(stf_journey *J)
{
  if (serve(J)) return by_segments(J);
  while (J->images > 1) stf_images_drop(J);
  STEIF_TRY(plan(J));
  STEIF_TRY(open_window(J, J->window));
  return reverse_all(J, 0, J->steps);
}
