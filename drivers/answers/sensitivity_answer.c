/* sensitivity_answer.c: derivatives by parameters as rows, and S at the end against differences.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "attributes.h"
#include "integration.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- parameters ------------------------------------------------------------------------------ */

const char *sensitivity_name(const struct sensitivity_answer *a, int i, char *room)
{
  const steif_parameters *q = a->problem->parameters;
  if (q->name) return q->name[a->active[i]];
  snprintf(room, STEIF_SPEC_WORD, "p%d", a->active[i] + 1);
  return room;
}

static int choose_named(struct call *call, struct sensitivity_answer *a, const char *list)
{
  char name[STEIF_SPEC_KEY];
  for (const char *at = list; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
    const size_t length = strcspn(at, ",");
    if (a->count >= SENSITIVITIES || length >= sizeof name)
      return bad_usage(call, "--parameters names more than %d", SENSITIVITIES);
    memcpy(name, at, length);
    name[length] = 0;
    int wrong;
    const int k = parameter_of(call, a->problem, name, &wrong);
    if (k < 0) return wrong;
    a->active[a->count++] = k;
  }
  return EXIT_OK;
}

int sensitivity_choose(struct call *call, struct sensitivity_answer *a)
{
  const char *list = word_of(call, "--parameters");
  const steif_parameters *q = a->problem->parameters;
  if (!q || q->count < 1) return no_parameters(call, a->problem);
  if (strcmp(list, "all")) return choose_named(call, a, list);
  if (q->count > SENSITIVITIES)
    return bad_usage(call, "problem '%s' has %d parameters, more than %d: name some",
                     call->word[0], q->count, SENSITIVITIES);
  for (a->count = 0; a->count < q->count; a->count++) a->active[a->count] = a->count;
  return EXIT_OK;
}

/* ---- rows ------------------------------------------------------------------------------------ */

double sensitivity_scale(const struct sensitivity_answer *a, int i)
{
  const steif_parameters *q = a->problem->parameters;
  const int k = a->active[i];
  const double typical = q->scale ? q->scale[k] : fabs(q->value[k]);
  return typical > 0 ? typical : 1;
}

static void cells(steif_report *r, const struct sensitivity_answer *a, const double *S,
                  size_t i)
{
  char room[STEIF_SPEC_WORD], key[2 * STEIF_SPEC_KEY];
  const size_t n = (size_t)a->problem->n;
  for (int scaled = 0; scaled < 2; scaled++)
    for (int k = 0; k < a->count; k++) {
      snprintf(key, sizeof key, "rows.%s%s", scaled ? "scaled_" : "d_",
               sensitivity_name(a, k, room));
      steif_report_real(r, key, (scaled ? sensitivity_scale(a, k) : 1) * S[(size_t)k * n + i]);
    }
}

void sensitivity_point(struct call *call, struct sensitivity_answer *a)
{
  const size_t n = (size_t)a->problem->n;
  const steif_names *names = a->problem->names;
  steif_report *r = a->report;
  const double *y = a->value + (a->shown - 1) * a->width + 1;
  for (size_t i = 0; i < n; i++) {
    char own[STEIF_SPEC_WORD];
    snprintf(own, sizeof own, "y%zu", i + 1);
    steif_report_row(r, "rows");
    steif_report_real(r, "rows.t", y[-1]);
    steif_report_text(r, "rows.unknown", names && names->unknown ? names->unknown[i] : own);
    steif_report_real(r, "rows.y", y[i]);
    cells(r, a, y + n, i);
  }
  rows_come(call, r);
}

/* S at the end, n x P by rows, as the last point has it by columns. */
static void matrix(steif_report *r, const struct sensitivity_answer *a)
{
  const size_t n = (size_t)a->problem->n, P = (size_t)a->count;
  const double *S = a->value + (a->shown - 1) * a->width + 1 + n;
  double *by_rows = malloc(n * P * sizeof *by_rows);
  for (size_t i = 0; by_rows && i < n * P; i++) by_rows[i] = S[(i % P) * n + i / P];
  if (by_rows) steif_report_matrix(r, "S", n, P, by_rows);
  free(by_rows);
}

void sensitivity_begin(struct call *call, struct sensitivity_answer *a)
{
  steif_report *r = a->report;
  double p[SENSITIVITIES];
  for (int i = 0; i < a->count; i++) p[i] = a->problem->parameters->value[a->active[i]];
  steif_report_text(r, "problem", call->word[0]);
  steif_report_text(r, "method", call->word[1]);
  steif_report_list(r, "p", (size_t)a->count, p);
}

static void finish(steif_report *r, const struct call *call, const struct sensitivity_answer *a)
{
  if (strcmp(call->word[1], a->used)) steif_report_text(r, "used", a->used);
  if ((call->json || call->npz || call->h5 || call->mtx) && a->shown) matrix(r, a);
  sensitivity_event_rows(r, call, a);
  if (a->problem->quadrature && a->outcome.code >= 0) {
    steif_report_real(r, "integral", a->integral);
    steif_report_list(r, "gradient", (size_t)a->count, a->gradient);
  }
  steif_report_truth(r, "tested", a->cost.tested);
  report_status(r, "", &a->outcome);
  steif_report_whole(r, "cost.steps", a->outcome.stats.steps);
  steif_report_whole(r, "cost.factors", a->outcome.stats.nlu);
  steif_report_whole(r, "cost.solves", a->outcome.stats.nsolve);
  steif_report_whole(r, "cost.sweeps", a->cost.sweeps);
  steif_report_whole(r, "cost.jacobians", a->cost.jacobians);
  if (a->checked) steif_report_real(r, "disagreement", a->disagreement);
}

int sensitivity_present(struct call *call, const struct sensitivity_answer *a)
{
  finish(a->report, call, a);
  return present(call, a->report);
}
