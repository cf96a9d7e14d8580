/* identity.c: is this the problem, with the options, of the run that was saved?
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checkpoint_file.h"
#include <stdio.h>
#include <string.h>

static const char *const real_name[STF_REALS] = {"rtol", "atol", "h", "h0", "h_max", "newton"};
static const char *const choice_name[STF_CHOICES] = {
  "iterations", "force_storage", "storage", "initial", "ewt", "mesh", "reinitialise"};
static const char *const sum_name[STF_SUMS] = {"atols", "mesh", "start", "attributes"};

static unsigned long long sum_of(const void *array, size_t bytes)
{
  return array ? stf_checksum(array, bytes) : 0;
}

static void options_of(const steif_options *o, size_t n, stf_identity *id)
{
  const sunrealtype real[] = {o->rtol, o->atol, o->h, o->h0, o->h_max, o->newton};
  const int choice[] = {
    o->iterations,          o->force_storage, o->force_storage ? (int)o->storage : 0,
    (int)o->initial,        o->ewt != NULL,   o->mesh != NULL,
    o->reinitialise != NULL};
  const unsigned long long sum[] = {sum_of(o->atols, n * sizeof *o->atols),
                                    sum_of(o->mesh, o->mesh_size * sizeof *o->mesh),
                                    sum_of(o->start, o->start ? strlen(o->start) : 0),
                                    sum_of(o->attributes, n * sizeof *o->attributes)};
  memcpy(id->real, real, sizeof real);
  memcpy(id->choice, choice, sizeof choice);
  memcpy(id->sum, sum, sizeof sum);
}

void stf_identity_of(steif_solver *s, stf_identity *id)
{
  const steif_problem *p = s->problem;
  memset(id, 0, sizeof *id);
  snprintf(id->version, sizeof id->version, "%s", steif_version());
  snprintf(id->problem, sizeof id->problem, "%s", p->name ? p->name : "");
  snprintf(id->spec, sizeof id->spec, "%s", s->spec);
  id->n = p->n;
  id->form = s->engine ? s->run.form : s->step.system.form;
  id->t0 = p->t0;
  id->t1_opened = s->t1_opened;
  id->t = s->end;
  id->t1 = s->t1;
  id->steps = s->engine ? s->run.stats.steps : s->step.count;
  id->repeats = s->engine != NULL;
  id->cpu_s = stf_cpu_seconds(s);
  id->finished = s->finished || !(s->end < s->t1);
  id->fingerprint = s->fingerprint;
  options_of(&s->options, (size_t)p->n, id);
}

static int check_options(steif_context *ctx, const stf_identity *here, const stf_identity *file)
{
  for (int i = 0; i < STF_REALS; i++)
    STEIF_CHECK(here->real[i] == file->real[i], ctx, STEIF_BAD_INPUT,
                "%s was %.17g in the run that was saved and is %.17g here: give the options of "
                "that run",
                real_name[i], file->real[i], here->real[i]);
  for (int i = 0; i < STF_CHOICES; i++)
    STEIF_CHECK(
      here->choice[i] == file->choice[i], ctx, STEIF_BAD_INPUT,
      "option %s was %d in the run that was saved and is %d here: give the options of "
      "that run",
      choice_name[i], file->choice[i], here->choice[i]);
  for (int i = 0; i < STF_SUMS; i++)
    STEIF_CHECK(here->sum[i] == file->sum[i], ctx, STEIF_BAD_INPUT,
                "option %s is not that of the run that was saved: give the options of that run",
                sum_name[i]);
  return STEIF_OK;
}

int stf_identity_check(steif_solver *s, const stf_identity *file)
{
  stf_identity here;
  stf_identity_of(s, &here);
  STEIF_CHECK(here.form == file->form && (here.t0 == file->t0 || !file->fingerprint), s->ctx,
              STEIF_BAD_INPUT,
              "problem '%s' has form %s and t0 = %.12g, that of the checkpoint form %s and "
              "t0 = %.12g: give the problem of that run",
              here.problem, steif_form_name(here.form), here.t0, steif_form_name(file->form),
              file->t0);
  STEIF_TRY(check_options(s->ctx, &here, file));
  STEIF_CHECK(here.fingerprint == file->fingerprint || !file->fingerprint, s->ctx,
              STEIF_BAD_INPUT,
              "problem '%s' has other start values, slopes or derivatives at its start than in "
              "the run that was saved: give the problem with the parameters of that run",
              here.problem);
  return STEIF_OK;
}
