/* longer.c: a run in long double, by the family of the method.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "longer.h"
#include <float.h>
#include <nvector/nvector_serial.h>
#include <steif/table.h>
#include <string.h>

enum { LARGEST = 400 }; /* order of the dense systems */

static bool bdf(const steif_spec *spec)
{
  return !strcmp(spec->name, "be") || !strcmp(spec->name, "bdf");
}

/* Has the table of the method a regular A? 0 stages: it has none, or there is no such table. */
static void look_up(steif_context *ctx, const char *method, int *s)
{
  const char *spec = !strncmp(method, "dirk:", 5) ? method + 5 : method;
  *s = 0;
  if (strstr(method, "glm:")) return;
  steif_table *table = steif_table_new(ctx, spec);
  if (!table) return;
  bool regular = table->kind == STEIF_COLLOCATION || table->kind == STEIF_DIRK;
  for (int i = 0; table->kind == STEIF_DIRK && i < table->s; i++)
    regular = regular && table->A[i * table->s + i] != 0;
  if (regular) *s = table->s;
  steif_table_free(ctx, &table);
}

int stf_recurrence_of(steif_context *ctx, const char *method, int *stages)
{
  steif_spec spec;
  *stages = 0;
  const long failures = stf_failures(ctx);
  const bool silent = stf_silence(ctx, true);
  if (!steif_spec_parse(ctx, method, &spec)) {
    *stages = 1;
    if (!bdf(&spec)) look_up(ctx, method, stages);
  }
  stf_silence(ctx, silent);
  const bool short_of = stf_failures(ctx) > failures && steif_status(ctx) == STEIF_NO_MEMORY;
  return short_of ? STEIF_NO_MEMORY : STEIF_OK;
}

static bool general(const char *method) { return !strncmp(method, "glm:", 4); }

static int find_general(steif_context *ctx, const char *method, int *stages)
{
  const long failures = stf_failures(ctx);
  const bool silent = stf_silence(ctx, true);
  stf_longer_general_serves(ctx, method, stages);
  stf_silence(ctx, silent);
  const bool short_of = stf_failures(ctx) > failures && steif_status(ctx) == STEIF_NO_MEMORY;
  return short_of ? STEIF_NO_MEMORY : STEIF_OK;
}

int stf_longer_serves(steif_context *ctx, const char *method, int n, bool *serves)
{
  int s;
  STEIF_TRY(general(method) ? find_general(ctx, method, &s)
                            : stf_recurrence_of(ctx, method, &s));
  *serves = LDBL_MANT_DIG > DBL_MANT_DIG && s > 0 && s * n <= LARGEST;
  return STEIF_OK;
}

long double stf_longer_shake(stf_longer *run)
{
  return run->shaken ? 1 + (long double)STF_EPS * stf_random_in(&run->random, -1, 1) : 1;
}

int stf_longer_force(stf_longer *run, size_t i, long double c, long double *out)
{
  const sunrealtype t =
    (sunrealtype)((run->from + ((long double)i + c) * run->h) * stf_longer_shake(run));
  const steif_linear *l = run->linear;
  memset(out, 0, (size_t)run->n * sizeof *out);
  if (!l->f) return STEIF_OK;
  if (run->sides)
    stf_sides_step(run->sides, (sunrealtype)(run->from + (long double)i * run->h),
                   (sunrealtype)(run->from + (long double)(i + 1) * run->h), STF_STEP_END);
  const int code = l->f(t, 0, run->value, l->user);
  if (run->sides) stf_sides_step(run->sides, 0, 0, 0);
  STEIF_CHECK(!code, run->ctx, STEIF_CALLBACK, "the forcing returned %d at t = %g", code, t);
  const sunrealtype *f = N_VGetArrayPointer(run->value);
  for (int k = 0; k < run->n; k++) out[k] = f[k] * stf_longer_shake(run);
  return STEIF_OK;
}

static int dispatch(stf_longer *run)
{
  steif_spec spec;
  if (general(run->method)) return stf_longer_general(run, run->method);
  STEIF_TRY(steif_spec_parse(run->ctx, run->method, &spec));
  if (!bdf(&spec)) return stf_longer_stages(run, run->method);
  int p;
  STEIF_TRY(stf_spec_int(run->ctx, &spec, "p", 1, 6, strcmp(spec.name, "be") ? 2 : 1, &p));
  return stf_longer_multistep(run, p, run->start ? run->start : stf_spec_word(&spec, "start"));
}

int stf_longer_run(stf_longer *run)
{
  const size_t n = (size_t)run->n;
  if (run->random.state == 0) run->random.state = 1;
  run->value = N_VNew_Serial(run->n, steif_sundials(run->ctx));
  run->E = stf_allocate(run->ctx, 2 * n * n, sizeof *run->E);
  int code = STEIF_OK;
  if (!run->value)
    code = STEIF_FAIL(run->ctx, STEIF_NO_MEMORY, "no memory for a vector");
  else if (!run->E)
    code = STEIF_NO_MEMORY;
  if (!code) {
    run->F = run->E + n * n;
    stf_long_entries(run->linear->E, run->n, run->E);
    stf_long_entries(run->linear->F, run->n, run->F);
    code = dispatch(run);
  }
  if (run->value) N_VDestroy(run->value);
  stf_release(run->ctx, run->E);
  run->value = NULL, run->E = run->F = NULL;
  return code;
}
