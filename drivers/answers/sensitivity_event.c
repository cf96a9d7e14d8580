/* sensitivity_event.c: a run that an event ends: derivatives of its time, and of the solution at it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "integration.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

int sensitivity_before(steif_solver *s, double t, N_Vector y, const int *fired, void *user)
{
  struct sensitivity_answer *a = user;
  (void)s, (void)t, (void)fired;
  memcpy(a->before, N_VGetArrayPointer(y), (size_t)a->problem->n * sizeof *a->before);
  return 0;
}

void sensitivity_met(struct call *call, struct sensitivity_answer *a, steif_solver *s)
{
  a->by_event = true, a->t_event = steif_time(s), a->outcome.code = STEIF_EVENT;
  snprintf(a->outcome.message, sizeof a->outcome.message, "%s", steif_message(call->ctx));
  steif_forget(call->ctx);
}

/* What they have not: an event that grazes has no derivative of its time. */
static void unknown(struct call *call, struct sensitivity_answer *a)
{
  const size_t n = (size_t)a->problem->n, used = strlen(a->outcome.message);
  snprintf(a->outcome.message + used, sizeof a->outcome.message - used, "; no dt_event: %s",
           steif_message(call->ctx));
  for (size_t i = 0; i < n * (size_t)a->count; i++) a->total[i] = NAN;
  for (int k = 0; k < a->count; k++) a->tau[k] = NAN;
  steif_forget(call->ctx);
}

int sensitivity_event(struct call *call, struct sensitivity_answer *a, steif_solver *s)
{
  const size_t n = (size_t)a->problem->n;
  N_Vector d = N_VClone(steif_solution(s));
  a->total = malloc((n * (size_t)a->count + 1) * sizeof *a->total);
  int code = d && a->total ? STEIF_OK : STEIF_NO_MEMORY;
  for (int k = 0; !code && k < a->count; k++) {
    code = steif_sensitivity_event(s, a->active[k], &a->tau[k], d);
    if (!code) memcpy(a->total + n * (size_t)k, N_VGetArrayPointer(d), n * sizeof *a->total);
  }
  if (d) N_VDestroy(d);
  if (code == STEIF_NO_MEMORY) return no_memory(call, "derivatives at the event", "name fewer");
  if (code) unknown(call, a);
  return EXIT_OK;
}

static void times(steif_report *r, const struct sensitivity_answer *a)
{
  char room[STEIF_SPEC_WORD];
  for (int k = 0; k < a->count; k++) {
    steif_report_row(r, "event");
    steif_report_text(r, "event.parameter", sensitivity_name(a, k, room));
    steif_report_real(r, "event.p", a->problem->parameters->value[a->active[k]]);
    steif_report_real(r, "event.dt_event", a->tau[k]);
    steif_report_real(r, "event.scaled", a->tau[k] * sensitivity_scale(a, k));
  }
}

static void totals(steif_report *r, const struct sensitivity_answer *a)
{
  char room[STEIF_SPEC_WORD], key[2 * STEIF_SPEC_KEY];
  const size_t n = (size_t)a->problem->n;
  const steif_names *names = a->problem->names;
  for (size_t i = 0; i < n; i++) {
    char own[STEIF_SPEC_WORD];
    snprintf(own, sizeof own, "y%zu", i + 1);
    steif_report_row(r, "at_event");
    steif_report_text(r, "at_event.unknown", names && names->unknown ? names->unknown[i] : own);
    for (int k = 0; k < a->count; k++) {
      snprintf(key, sizeof key, "at_event.total_%s", sensitivity_name(a, k, room));
      steif_report_real(r, key, a->total[(size_t)k * n + i]);
    }
  }
}

void sensitivity_event_rows(steif_report *r, const struct call *call,
                            const struct sensitivity_answer *a)
{
  const size_t n = (size_t)a->problem->n, P = (size_t)a->count;
  if (!a->by_event) return;
  times(r, a);
  totals(r, a);
  steif_report_real(r, "t_event", a->t_event);
  if (!call->json && !call->npz && !call->h5 && !call->mtx) return;
  steif_report_list(r, "dt_event", P, a->tau);
  double *by_rows = malloc(n * P * sizeof *by_rows);
  for (size_t i = 0; by_rows && i < n * P; i++) by_rows[i] = a->total[(i % P) * n + i / P];
  if (by_rows) steif_report_matrix(r, "S_event", n, P, by_rows);
  free(by_rows);
}
