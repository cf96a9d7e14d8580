/* agreed_calls.c: what ranks agree upon when a solver is made, and when a call begins and ends.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "agreed.h"
#include <string.h>

/* -- opening ----------------------------------------------------------------------------------- */

/* What needs all unknowns in one place. */
static int refuse(const stf_agreed *a, const steif_options *o, int form)
{
  const enum steif_storage storage = o->force_storage ? o->storage : a->p->storage;
  const char *what = NULL, *instead = "solve it in one process, or leave it out";
  if (storage != STEIF_KRYLOV)
    what = "storage other than Krylov", instead = "use storage Krylov";
  else if (o->sensitivities)
    what = "options.sensitivities";
  else if (o->reinitialise)
    what = "options.reinitialise";
  else if (form != STEIF_ODE && o->initial == STEIF_CHECK)
    what = "options.initial = STEIF_CHECK",
    instead = "check the start in one process, or give options.initial = STEIF_AS_GIVEN";
  STEIF_CHECK(!what, a->ctx, STEIF_UNSUPPORTED,
              "%s of problem '%s' needs all %lld unknowns in one place, and these vectors are "
              "spread over ranks: %s",
              what, a->p->name, (long long)a->p->n, instead);
  return STEIF_OK;
}

/* Vectors of several parts do not say how many rows are here; they have no array either, so that none of the
 * caller's is looked at. */
static bool knows_rows(N_Vector like) { return like->ops->nvgetlocallength != NULL; }

static int add_up(const stf_agreed *a)
{
  const bool known = knows_rows(a->like);
  const long long rows = stf_agree_total(a->like, known ? stf_local_length(a->like) : a->p->n);
  STEIF_CHECK(!known || rows == a->p->n, a->ctx, STEIF_BAD_INPUT,
              "the ranks own %lld rows together, problem '%s' has %lld", rows, a->p->name,
              (long long)a->p->n);
  return STEIF_OK;
}

static int check(steif_solver *s, sunindextype rows, int *form)
{
  N_Vector like = s->options.like;
  *form = stf_problem_form(s->ctx, s->problem, rows);
  if (!*form) return steif_status(s->ctx);
  STEIF_TRY(stf_options_complete(s->ctx, s->problem, &s->options, rows));
  STEIF_CHECK(!like || N_VGetLength(like) == s->problem->n, s->ctx, STEIF_BAD_INPUT,
              "options.like has %lld components, problem '%s' has %lld",
              (long long)N_VGetLength(like), s->problem->name, (long long)s->problem->n);
  return STEIF_OK;
}

/* Letters of a sentence without the symbol of its code, which it gets again. */
static int without_symbol(const char *text)
{
  const char *symbol = strstr(text, " [STEIF_");
  return (int)(symbol ? (size_t)(symbol - text) : strlen(text));
}

/* The sentence of the lowest rank that found something in its rows, which it counts from 0. */
static int agree_on_rows(steif_solver *s, int code, sunindextype rows)
{
  N_Vector like = s->options.like;
  bool any = code != 0;
  int rank;
  long long first;
  stf_agree_any(like, 1, &any);
  if (!any) return STEIF_OK;
  const bool mine = stf_agree_lowest(like, code != 0, rows, &rank, &first);
  if (mine && rank > 0)
    STEIF_FAIL(s->ctx, steif_status(s->ctx),
               "%.*s (on rank %d, whose row 0 is row %lld of all)",
               without_symbol(steif_message(s->ctx)), steif_message(s->ctx), rank, first);
  return stf_agree(s->ctx, like, mine ? code : STEIF_OK);
}

static int open(steif_solver *s, stf_agreed *a)
{
  if (!a) return STEIF_NO_MEMORY;
  s->deferred = (stf_deferred){
    .name = stf_agreed_name, .rank = -1, .sums = &s->agreements, .like = s->options.like};
  *a = (stf_agreed){
    .p = s->problem, .like = s->options.like, .ctx = s->ctx, .deferred = &s->deferred};
  return STEIF_OK;
}

int stf_agreed_open(steif_solver *s, const char *method, int *form)
{
  N_Vector like = s->options.like;
  STEIF_TRY(stf_agree_check(s->ctx, like));
  if (!like || !stf_spread(like)) return check(s, s->problem ? s->problem->n : 0, form);
  s->agreed = stf_pool_array(s->pool, 1, sizeof *s->agreed);
  STEIF_TRY(stf_agree(s->ctx, like, open(s, s->agreed)));
  STEIF_TRY(stf_same_input(s->ctx, like, s->problem, method, &s->options));
  const sunindextype rows = knows_rows(like) ? stf_local_length(like) : 0;
  STEIF_TRY(agree_on_rows(s, check(s, rows, form), rows));
  STEIF_TRY(add_up(s->agreed));
  STEIF_TRY(refuse(s->agreed, &s->options, *form));
  stf_agreed_wrap(s->agreed, &s->options);
  s->problem = &s->agreed->problem;
  s->deferred.opening = true;
  return STEIF_OK;
}

int stf_agreed_gate(steif_solver *s)
{
  if (!s->agreed || !stf_deferred_gate(s->options.like, &s->deferred)) return STEIF_OK;
  return STEIF_FAIL(s->ctx, STEIF_NO_MEMORY, "another rank could not make its solver");
}

void *stf_ewt_user(const steif_solver *s)
{
  return s->agreed ? (void *)s->agreed : stf_own_user(s->ctx, s->given->user);
}

/* -- calls ------------------------------------------------------------------------------------- */

int stf_agreed_begin(steif_solver *s, int code, const char *what, sunrealtype t)
{
  if (!s || !s->agreed) return code;
  N_Vector like = s->options.like;
  const struct {
    sunrealtype t;
    long long code;
  } given = {t, code};
  s->agreements++;
  if (stf_agree_same(like, &given, sizeof given) && !code) return STEIF_OK;
  const int agreed = stf_agree(s->ctx, like, code);
  if (agreed) return agreed;
  return STEIF_FAIL(s->ctx, STEIF_BAD_INPUT,
                    "ranks disagree in the time given to %s: give all the same", what);
}

void stf_agreed_tell(steif_solver *s, int code)
{
  const char *text = steif_message(s->ctx);
  const int rank = s->agreed ? s->deferred.rank : -1;
  s->deferred.rank = -1;
  if (code != STEIF_CALLBACK || rank < 0 || strstr(text, " rank ")) return;
  STEIF_FAIL(s->ctx, steif_status(s->ctx), "%.*s (on rank %d first)", without_symbol(text),
             text, rank);
}

int stf_agreed_end(steif_solver *s, int code)
{
  if (!s || !s->agreed) return code;
  const int agreed = stf_agree(s->ctx, s->options.like, code);
  s->agreements++;
  stf_agreed_tell(s, agreed);
  return agreed;
}
