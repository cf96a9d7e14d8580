/* fulfilled_start.c: start values that fulfil the equations, and the index of
 * the components. SPDX-License-Identifier: BSD-3-Clause */
#include "component_numbers.h"
#include "reactions.h"
#include "model.h"
#include <math.h>
#include <steif/consistent.h>
#include <steif/model.h>
#include <stdio.h>
#include <string.h>

/* '=' is fixed, '~' a guess, nothing free. */
enum steif_attribute stf_kind_of_start(const stf_model *m, size_t i)
{
  return m->start[i] == '=' ? STEIF_FIXED : m->start[i] == '~' ? STEIF_GUESS : STEIF_FREE;
}

static void attributes(const stf_model *m, enum steif_attribute *attribute)
{
  for (int32_t i = 0; i < m->n; i++) attribute[i] = stf_kind_of_start(m, (size_t)i);
}

/* From where to where, of guesses that did not hold. */
static void tell(stf_model *m, const sunrealtype *y)
{
  enum { SHOWN = 6 };
  const size_t room = sizeof m->moved;
  int count = 0;
  size_t end = 0;
  for (int32_t i = 0; i < m->n; i++) {
    const sunrealtype off = fabs(y[i] - m->y0[i]);
    if (m->start[i] != '~' || !(off > 1e-6 * fabs(m->y0[i]) + 1e-9)) continue;
    if (count++ >= SHOWN || end >= room) continue;
    end += (size_t)snprintf(m->moved + end, room - end, "%s%.60s from %.6g to %.6g",
                            count > 1 ? ", " : "moved to fulfil the equations: ", m->unknown[i],
                            m->y0[i], y[i]);
  }
  if (count > SHOWN && end < room)
    snprintf(m->moved + end, room - end, " and %d more", count - SHOWN);
}

static int take(stf_model *m, steif_problem *p, const steif_start *start)
{
  const size_t bytes = (size_t)m->n * sizeof *m->y0;
  m->yp0 = stf_pool_array(m->pool, (size_t)m->n, sizeof *m->yp0);
  if (!m->yp0) return STEIF_NO_MEMORY;
  memcpy(m->y0, start->y, bytes);
  memcpy(m->yp0, start->yp, bytes);
  p->yp0 = m->yp0;
  return STEIF_OK;
}

/* Linear systems may start with a jump: fixed values that contradict them are
 * for the impulse analysis. */
static int solve(stf_model *m, steif_problem *p, const enum steif_attribute *attribute)
{
  const steif_request request = {.attribute = attribute};
  steif_start start = {0};
  p->yp0 = m->slope;
  int code = stf_sought_start(m, p, &request, &start);
  const bool found = !code;
  if (!found) p->yp0 = m->yp0;
  if (found) {
    tell(m, start.y);
    code = stf_other_start(m, p, &request, start.y);
  }
  if (found && !code) code = take(m, p, &start);
  steif_start_clear(&start);
  if (code == STEIF_NO_MEMORY || found) return code;
  if (code == STEIF_BAD_INPUT && m->form != STEIF_DESCRIPTOR) return code;
  steif_forget(m->ctx); /* the run may start all the same, or fail: then this is why */
  return STEIF_OK;
}

static int index_of_components(stf_model *m, steif_problem *p)
{
  steif_diagnosis d = {0};
  int code = stf_index_of_components(m->ctx, p, &d);
  p->dae_index = -1;
  if (!code && d.index >= 0) {
    int *index = stf_pool_array(m->pool, (size_t)m->n, sizeof *index);
    if (!index) code = STEIF_NO_MEMORY;
    p->dae_index = d.index;
    for (int32_t i = 0; index && i < m->n; i++)
      index[i] = d.number[i] < 1 ? 1 : d.number[i] > 3 ? 3 : d.number[i];
    p->index = index;
  }
  steif_diagnosis_clear(&d);
  if (code == STEIF_NO_MEMORY) return code;
  if (code) steif_forget(m->ctx);
  return STEIF_OK;
}

int stf_consistent_start(stf_model *m, steif_problem *p)
{
  if (m->form == STEIF_ODE) return STEIF_OK;
  p->dae_index = -1, m->moved[0] = 0;
  if (m->n > STEIF_DIAGNOSE_LARGEST) return STEIF_OK;
  enum steif_attribute *attribute = stf_allocate(m->ctx, (size_t)m->n, sizeof *attribute);
  if (!attribute) return STEIF_NO_MEMORY;
  attributes(m, attribute);
  const int code = solve(m, p, attribute);
  stf_release(m->ctx, attribute);
  if (!code) stf_reactions_begin(m->t0, m);
  return code ? code : index_of_components(m, p);
}
