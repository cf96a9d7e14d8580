/* run_images.c: images of the solver, kept on the way forward or between steps that are made again, in memory or in files.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checkpoint_file.h"
#include "journey.h"
#include <math.h>
#include <stdio.h>
#include <unistd.h>

enum { MOST = 1000, FIRST_STRIDE = 16 };

int stf_images_open(stf_journey *J)
{
  const int asked = J->out->checkpoints, most = asked > MOST ? asked : MOST;
  J->image = stf_allocate(J->back.ctx, (size_t)most + 1, sizeof *J->image);
  if (!J->image) return STEIF_NO_MEMORY;
  J->images_most = most;
  return stf_images_save(J, 0);
}

static void path_of(const stf_journey *J, const stf_run_image *m, char *path, size_t room)
{
  snprintf(path, room, "%s/gradient-%ld-%p.image", J->out->folder, m->step, (const void *)J);
}

/* Of tangents beside an image. */
size_t stf_images_beside(const stf_journey *J)
{
  return J->line ? stf_push_size(&J->back) * sizeof(sunrealtype) : 0;
}

static int save_tangent(stf_journey *J, stf_run_image *m)
{
  if (!J->line) return STEIF_OK;
  m->tangent = stf_allocate(J->back.ctx, stf_push_size(&J->back), sizeof *m->tangent);
  if (!m->tangent) return STEIF_NO_MEMORY;
  stf_push_keep(&J->back, m->tangent);
  J->on_images += stf_images_beside(J);
  return STEIF_OK;
}

int stf_images_save(stf_journey *J, long at)
{
  char path[4096];
  stf_run_image *m = &J->image[J->images];
  *m = (stf_run_image){.step = at};
  STEIF_TRY(stf_checkpoint_image(J->runner, &m->bytes, &m->count));
  J->images++;
  const int lost = save_tangent(J, m);
  if (lost) return lost;
  if (!J->out->folder) {
    J->on_images += m->count;
    stf_journey_took(J);
    return STEIF_OK;
  }
  path_of(J, m, path, sizeof path);
  const int code = stf_disk_write(J->back.ctx, path, m->bytes, m->count);
  stf_release(J->back.ctx, m->bytes);
  m->bytes = NULL;
  return code;
}

static void forget(stf_journey *J, stf_run_image *m)
{
  char path[4096];
  if (m->bytes)
    J->on_images -= m->count;
  else {
    path_of(J, m, path, sizeof path);
    unlink(path);
  }
  stf_release(J->back.ctx, m->bytes);
  if (m->tangent) J->on_images -= stf_images_beside(J);
  stf_release(J->back.ctx, m->tangent);
}

void stf_images_drop(stf_journey *J) { forget(J, &J->image[--J->images]); }

/* ---- on the way forward -------------------------------------------------------------------------- */

/* Half of the memory is for images, the other half for the steps between two of them. */
static bool too_many(const stf_journey *J)
{
  if (J->out->checkpoints) return J->images > J->out->checkpoints;
  if (J->images > J->images_most) return true;
  if (J->out->folder) return J->images > STF_FEWEST + 2 * sqrt((double)J->steps);
  return J->on_images > (stf_journey_rest(J, J->room) + J->on_images) / 2;
}

/* Every other image goes, the first one stays. */
static void thin(stf_journey *J)
{
  int kept = 1;
  J->stride *= 2;
  if (J->images == 2) J->origin = J->steps + J->stride; /* which stays at no stride */
  for (int i = 1; i < J->images; i++)
    if (J->image[i].step >= J->origin && (J->image[i].step - J->origin) % J->stride == 0)
      J->image[kept++] = J->image[i];
    else
      forget(J, &J->image[i]);
  J->images = kept;
}

/* Of steps that are not recorded an image is kept in every so many: an image takes about what the records take that it
 * saves. Tangents are not known yet on the way forward. */
int stf_images_on_the_way(stf_journey *J)
{
  if (J->whole || J->line) return STEIF_OK;
  if (J->stride == 0) {
    const size_t records = J->image[0].count / (J->back.width * sizeof *J->record) + 1;
    J->stride = records > FIRST_STRIDE ? (long)records : FIRST_STRIDE;
    if (J->out->checkpoints) J->stride = FIRST_STRIDE;
    J->origin = J->out->checkpoints ? 0 : J->steps;
  }
  if (J->steps < J->origin || (J->steps - J->origin) % J->stride) return STEIF_OK;
  STEIF_TRY(stf_images_save(J, J->steps));
  while (J->images > 1 && too_many(J)) thin(J);
  return STEIF_OK;
}

/* ---- back to an image ---------------------------------------------------------------------------- */

/* The runner takes the state of the last image: a new one that of the start, and all where it did not serve. */
int stf_images_revive(stf_journey *J)
{
  char path[4096];
  const stf_run_image *m = &J->image[J->images - 1];
  unsigned char *bytes = m->bytes;
  size_t count = m->count;
  if (!bytes) {
    path_of(J, m, path, sizeof path);
    STEIF_TRY(stf_disk_read(J->back.ctx, path, &bytes, &count));
  }
  if (J->runner == J->back.home)
    J->runner = NULL;
  else if (m->step == 0 || J->always_new || J->line)
    steif_solver_free(&J->runner);
  J->reused = J->runner != NULL;
  const int code =
    stf_checkpoint_revive(J->back.ctx, J->back.problem, &J->options, bytes, count, &J->runner);
  if (!m->bytes) stf_release(J->back.ctx, bytes);
  J->stands = m->step;
  if (J->line) stf_push_back(&J->back, m->tangent);
  return code;
}

int stf_images_restore(stf_journey *J)
{
  return J->stands == J->image[J->images - 1].step ? STEIF_OK : stf_images_revive(J);
}
