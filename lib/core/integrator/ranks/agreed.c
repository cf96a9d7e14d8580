/* agreed.c: a run whose vectors are spread over ranks is the run of a problem whose callbacks return the same on
 * all of them.
 *
 * Each callback of the caller is called on all ranks at the same places, since these depend on agreed numbers only;
 * what it returned is then agreed upon (agree.h) before anybody looks at it. Event functions and invariants decide
 * by their values: these must be the same everywhere, or the call counts as failed. One sum more for each call,
 * and no rank that waits for one that has left.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <stddef.h>
#include <stdio.h>
#include <string.h>

typedef struct stf_agreed {
  steif_problem problem;  /* with our callbacks ... */
  const steif_problem *p; /* ... around these */
  int (*ewt)(N_Vector y, N_Vector ewt, void *user);
  N_Vector like;
  steif_context *ctx;
  stf_deferred *deferred;
} stf_agreed;

/* -- callbacks ----------------------------------------------------------------------------- */

#define AGREED(member, ...)                                                                    \
  const stf_agreed *a = user;                                                                  \
  const steif_problem *p = a->p;                                                               \
  if (stf_deferred_gate(a->like, a->deferred)) return -1;                                      \
  return stf_deferred_add(a->like, a->deferred, p->member(__VA_ARGS__),                        \
                          (long)offsetof(steif_problem, member))

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  AGREED(f, t, y, out, p->user);
}

static int kick(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  AGREED(kick, t, y, out, p->user);
}

static int drift(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  AGREED(drift, t, y, out, p->user);
}

static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  AGREED(F, t, y, yp, r, p->user);
}

static int g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  AGREED(g, t, derivative, out, p->user);
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector v,
               N_Vector w, N_Vector x)
{
  AGREED(jac, t, y, fy, J, p->user, v, w, x);
}

static int idajac(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r,
                  SUNMatrix J, void *user, N_Vector v, N_Vector w, N_Vector x)
{
  AGREED(idajac, t, c, y, yp, r, J, p->user, v, w, x);
}

static int E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  AGREED(E, t, y, yp, M, p->user);
}

static int A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  AGREED(A, t, y, yp, M, p->user);
}

static int L(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  AGREED(L, t, y, yp, M, p->user);
}

static int Ev(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  AGREED(Ev, t, y, yp, x, out, p->user);
}

static int Av(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  AGREED(Av, t, y, yp, x, out, p->user);
}

static int Lv(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  AGREED(Lv, t, y, yp, x, out, p->user);
}

static int precsetup(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c,
                     void *user)
{
  AGREED(precsetup, t, y, yp, r, c, p->user);
}

static int precsolve(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
                     sunrealtype c, sunrealtype delta, void *user)
{
  AGREED(precsolve, t, y, yp, r, b, z, c, delta, p->user);
}

static int precsolve_pair(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector *b,
                          N_Vector *z, sunrealtype c_re, sunrealtype c_im, sunrealtype delta,
                          void *user)
{
  AGREED(precsolve_pair, t, y, yp, r, b, z, c_re, c_im, delta, p->user);
}

static int start(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  AGREED(start, t, y, yp, p->user);
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  AGREED(exact, t, y, yp, p->user);
}

static int handle_event(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  AGREED(handle_event, t, y, fired, p->user);
}

static int event_slope(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  AGREED(event_slope, t, y, yp, p->user);
}

static int begin(sunrealtype t, void *user) { AGREED(begin, t, p->user); }

/* Values that decide must be the same; the first failure of a run leaves the sentence. */
static int values(const stf_agreed *a, int returned, const char *what, int count,
                  const sunrealtype *value)
{
  const int code = stf_agree_returned(a->like, returned);
  if (code) return code;
  if (stf_agree_same(a->like, value, (size_t)count * sizeof *value)) return 0;
  STEIF_FAIL(a->ctx, STEIF_BAD_INPUT,
             "%s of problem '%s' has different values on different ranks: reduce it in the "
             "callback",
             what, a->p->name);
  return -1;
}

static int event(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const stf_agreed *a = user;
  if (stf_deferred_gate(a->like, a->deferred)) return -1;
  return values(a, a->p->event(t, y, value, a->p->user), "the event function", a->p->events,
                value);
}

static int invariant(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const stf_agreed *a = user;
  if (stf_deferred_gate(a->like, a->deferred)) return -1;
  return values(a, a->p->invariant(t, y, value, a->p->user), "the invariant", a->p->invariants,
                value);
}

static int ewt(N_Vector y, N_Vector w, void *user)
{
  const stf_agreed *a = user;
  if (stf_deferred_gate(a->like, a->deferred)) return -1;
  return stf_agree_returned(a->like, a->ewt(y, w, a->p->user));
}

#define NAMED(member)                                                                          \
  {                                                                                            \
    offsetof(steif_problem, member), #member                                                   \
  }

static const char *name_of(long id)
{
  static const struct {
    size_t offset;
    const char *name;
  } names[] = {NAMED(f),          NAMED(kick),      NAMED(drift),        NAMED(F),
               NAMED(g),          NAMED(jac),       NAMED(idajac),       NAMED(E),
               NAMED(A),          NAMED(L),         NAMED(Ev),           NAMED(Av),
               NAMED(Lv),         NAMED(precsetup), NAMED(precsolve),    NAMED(precsolve_pair),
               NAMED(start),      NAMED(exact),     NAMED(handle_event), NAMED(begin),
               NAMED(event_slope)};
  for (size_t i = 0; i < STF_COUNT(names); i++)
    if ((long)names[i].offset == id) return names[i].name;
  return "a callback";
}

#define WRAP(callback) to->callback = p->callback ? callback : NULL

static void wrap(stf_agreed *a)
{
  const steif_problem *p = a->p;
  steif_problem *to = &a->problem;
  *to = *p;
  to->user = a, to->save = NULL, to->restore = NULL;
  WRAP(f), WRAP(kick), WRAP(drift), WRAP(F), WRAP(g), WRAP(jac), WRAP(idajac);
  WRAP(E), WRAP(A), WRAP(L), WRAP(Ev), WRAP(Av), WRAP(Lv), WRAP(precsetup), WRAP(precsolve);
  WRAP(precsolve_pair), WRAP(start), WRAP(exact), WRAP(handle_event), WRAP(event_slope),
    WRAP(begin), WRAP(event), WRAP(invariant);
  to->Etv = to->Atv = NULL,
  to->precsolve_transposed = NULL; /* of gradients, which serve no ranks */
}

/* -- the same input ---------------------------------------------------------------------------- */

typedef struct member {
  const char *name;
  size_t offset, size;
} member;

#define OF(type, name)                                                                         \
  {                                                                                            \
#name, offsetof(type, name), sizeof((type *)NULL)->name                                    \
  }

static const member problems[] = {
  OF(steif_problem, n),         OF(steif_problem, t0),          OF(steif_problem, t1),
  OF(steif_problem, storage),   OF(steif_problem, dae_index),   OF(steif_problem, linear),
  OF(steif_problem, events),    OF(steif_problem, break_count), OF(steif_problem, invariants),
  OF(steif_problem, positions), OF(steif_problem, period),      OF(steif_problem, autonomous),
};
static const member options[] = {
  OF(steif_options, rtol),
  OF(steif_options, atol),
  OF(steif_options, h),
  OF(steif_options, h0),
  OF(steif_options, h_max),
  OF(steif_options, t1),
  OF(steif_options, max_steps),
  OF(steif_options, newton),
  OF(steif_options, iterations),
  OF(steif_options, storage),
  OF(steif_options, force_storage),
  OF(steif_options, mesh_size),
  OF(steif_options, max_seconds),
  OF(steif_options, consistent),
  OF(steif_options, sensitivities),
  OF(steif_options, initial),
};

static int same(const stf_agreed *a, size_t count, const member *m, const void *given)
{
  for (size_t i = 0; i < count; i++)
    STEIF_CHECK(stf_agree_same(a->like, (const char *)given + m[i].offset, m[i].size), a->ctx,
                STEIF_BAD_INPUT,
                "ranks disagree in .%s of problem or options: give all the same", m[i].name);
  return STEIF_OK;
}

/* Which callbacks there are decides what is called. */
static int same_callbacks(const stf_agreed *a, const steif_options *o)
{
  const steif_problem *p = a->p;
  const bool there[] = {
    p->f,       p->F,         p->g,         p->jac,          p->idajac,
    p->E,       p->A,         p->Ev,        p->Av,           p->L,
    p->Lv,      p->precsetup, p->precsolve, p->start,        p->precsolve_pair,
    p->exact,   p->event,     p->begin,     p->handle_event, p->kick,
    p->drift,   p->y0,        p->yp0,       p->index,        p->constraint,
    p->pattern, p->invariant, o->mesh,      o->atols,        o->ewt,
    o->observe, o->on_event};
  STEIF_CHECK(stf_agree_same(a->like, there, sizeof there), a->ctx, STEIF_BAD_INPUT,
              "ranks disagree in which callbacks and arrays problem and options have");
  const void *list[] = {o->mesh, p->breaks};
  const size_t bytes[] = {(o->mesh ? o->mesh_size : 0) * sizeof *o->mesh,
                          (size_t)p->break_count * sizeof *p->breaks};
  for (int k = 0; k < 2; k++)
    STEIF_CHECK(stf_agree_same(a->like, list[k], bytes[k]), a->ctx, STEIF_BAD_INPUT,
                "ranks disagree in the times of %s: give all the same",
                k ? "breaks" : "the mesh");
  return STEIF_OK;
}

/* What needs all unknowns in one place. */
static int refuse(const stf_agreed *a, const steif_options *o)
{
  const enum steif_storage storage = o->force_storage ? o->storage : a->p->storage;
  const char *const what = storage != STEIF_KRYLOV ? "storage other than Krylov"
                           : a->p->constraint      ? "constraint"
                           : o->sensitivities      ? "sensitivities"
                           : o->reinitialise       ? "reinitialise"
                                                   : NULL;
  STEIF_CHECK(
    !what, a->ctx, STEIF_UNSUPPORTED,
    "'%s' of problem '%s' needs all %lld unknowns in one place, and these vectors are "
    "spread over ranks: use storage Krylov without it",
    what, a->p->name, (long long)a->p->n);
  return STEIF_OK;
}

/* Vectors of several parts do not say how many rows are here; they have no array either, so that none of the
 * caller's is looked at. */
static bool knows_rows(N_Vector like) { return like->ops->nvgetlocallength != NULL; }

static int check_all(const stf_agreed *a, const steif_options *o)
{
  STEIF_TRY(same(a, STF_COUNT(problems), problems, a->p));
  STEIF_TRY(same(a, STF_COUNT(options), options, o));
  STEIF_TRY(same_callbacks(a, o));
  const bool known = knows_rows(a->like);
  const long long rows = stf_agree_total(a->like, known ? stf_local_length(a->like) : a->p->n);
  STEIF_CHECK(!known || rows == a->p->n, a->ctx, STEIF_BAD_INPUT,
              "the ranks own %lld rows together, problem '%s' has %lld", rows, a->p->name,
              (long long)a->p->n);
  return refuse(a, o);
}

/* -- opening ----------------------------------------------------------------------------------- */

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

static int open(steif_solver *s, stf_agreed *a)
{
  if (!a) return STEIF_NO_MEMORY;
  s->deferred = (stf_deferred){.name = name_of, .rank = -1, .sums = &s->agreements};
  *a = (stf_agreed){
    .p = s->problem, .like = s->options.like, .ctx = s->ctx, .deferred = &s->deferred};
  return STEIF_OK;
}

int stf_agreed_open(steif_solver *s, int *form)
{
  N_Vector like = s->options.like;
  const bool spread = like && stf_spread(like);
  STEIF_TRY(stf_agree_check(s->ctx, like));
  const sunindextype all = s->problem ? s->problem->n : 0;
  const sunindextype here = spread && knows_rows(like) ? stf_local_length(like) : 0;
  int code = check(s, spread ? here : all, form);
  if (!spread) return code;
  s->agreed = stf_pool_array(s->pool, 1, sizeof *s->agreed);
  if (!code) code = open(s, s->agreed);
  STEIF_TRY(stf_agree(s->ctx, like, code));
  STEIF_TRY(check_all(s->agreed, &s->options));
  wrap(s->agreed);
  s->agreed->ewt = s->options.ewt;
  if (s->options.ewt) s->options.ewt = ewt;
  s->problem = &s->agreed->problem;
  s->deferred.opening = true;
  return STEIF_OK;
}

int stf_agreed_gate(steif_solver *s)
{
  if (!s->agreed || !stf_deferred_gate(s->options.like, &s->deferred)) return STEIF_OK;
  return STEIF_FAIL(s->ctx, STEIF_NO_MEMORY, "another rank could not make its solver");
}

int stf_agreed_end(steif_solver *s, int code)
{
  char text[STF_MESSAGE];
  if (!s || !s->agreed) return code;
  const int agreed = stf_agree(s->ctx, s->options.like, code);
  s->agreements++;
  if (agreed != STEIF_CALLBACK || s->deferred.rank < 0) return agreed;
  stf_message_copy(s->ctx, text);
  const size_t used = strlen(text);
  snprintf(text + used, sizeof text - used, " (on rank %d first)", s->deferred.rank);
  stf_message_take(s->ctx, steif_status(s->ctx), text);
  s->deferred.rank = -1;
  return agreed;
}
