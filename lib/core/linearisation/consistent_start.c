/* consistent_start.c: what every search for a consistent start has to do with.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "consistent_start.h"
#include <math.h>
#include <string.h>

int stf_start_allocate(steif_context *ctx, size_t n, steif_start *start)
{
  stf_pool *pool = stf_pool_new(ctx);
  *start = (steif_start){.memory = pool};
  if (!pool) return STEIF_NO_MEMORY;
  start->y = stf_pool_array(pool, 3 * n, sizeof *start->y);
  start->enforced = stf_pool_array(pool, n, sizeof *start->enforced);
  if (!start->y || !start->enforced) {
    steif_start_clear(start);
    return STEIF_NO_MEMORY;
  }
  start->yp = start->y + n, start->moved = start->y + 2 * n;
  return STEIF_OK;
}

void steif_start_clear(steif_start *start)
{
  if (!start) return;
  stf_pool *pool = start->memory;
  stf_pool_free(&pool);
  *start = (steif_start){0};
}

enum steif_attribute stf_start_attribute(const stf_start_task *task, size_t j)
{
  return task->request->attribute ? task->request->attribute[j] : STEIF_GUESS;
}

sunrealtype stf_start_weight(const stf_start_task *task, size_t j)
{
  return task->request->weight ? task->request->weight[j] : 1;
}

int stf_start_scale(stf_start_task *task)
{
  stf_point *s = task->point;
  const stf_view *v = task->view;
  memset(task->scale, 0, s->n * sizeof *task->scale);
  for (size_t j = 0; j < s->n; j++)
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++)
      task->scale[v->row[k]] +=
        fabs(v->e[k] * s->yp0[j]) + fabs(v->b[k]) * fmax(fabs(s->y0[j]), s->floor[j]);
  STEIF_TRY(stf_point_residual(s, s->t, s->y0, s->yp0, s->scratch));
  for (size_t i = 0; i < s->n; i++) {
    task->scale[i] = fmax(task->scale[i], fabs(s->scratch[i]));
    if (!(task->scale[i] > 0)) task->scale[i] = 1;
  }
  return STEIF_OK;
}
