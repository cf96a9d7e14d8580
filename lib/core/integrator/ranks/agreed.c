/* agreed.c: a run whose vectors are spread over ranks is the run of a problem whose callbacks return the same on
 * all of them.
 *
 * Each callback of the caller is called on all ranks at the same places, since these depend on agreed numbers only;
 * what it returned is then agreed upon (agree.h) before anybody looks at it. Event functions and invariants decide
 * by their values: these must be the same everywhere, or the call counts as failed. One sum more for each call,
 * and no rank that waits for one that has left.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "agreed.h"
#include <math.h>
#include <stddef.h>

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

static int project(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  AGREED(project, t, y, yp, p->user);
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

/* A callback that has failed may have left a sentence on some rank: then all have it. */
static int shared(const stf_agreed *a, long failures, int returned, int code)
{
  bool told = stf_failures(a->ctx) > failures, any = told;
  long long first;
  stf_agree_lowest(a->like, returned == code, 0, &a->deferred->rank, &first);
  stf_agree_any(a->like, 1, &any);
  if (any) stf_agree(a->ctx, a->like, told ? steif_status(a->ctx) : STEIF_OK);
  return code;
}

/* Values that decide must be the same numbers. Not 0: there is a sentence, the same on all ranks, or all of them
 * returned this. */
static int values(const stf_agreed *a, long failures, int returned, const char *what,
                  sunrealtype t, int count, const sunrealtype *value)
{
  int i = 0, rank;
  long long first;
  const int code = stf_agree_returned(a->like, returned);
  if (code) return shared(a, failures, returned, code);
  if (stf_agree_same(a->like, value, (size_t)count * sizeof *value)) return 0;
  while (i < count && stf_agree_same(a->like, &value[i], sizeof *value)) i++;
  if (i == count) i = 0; /* zeros of two signs */
  const bool wrong = !isfinite(value[i]);
  stf_agree_lowest(a->like, wrong, 0, &rank, &first);
  bool any = wrong;
  stf_agree_any(a->like, 1, &any);
  if (any)
    STEIF_FAIL(a->ctx, STEIF_NOT_FINITE,
               "%s %d of problem '%s' is not finite on rank %d at t = %.12g, and is on others",
               what, i + 1, a->p->name, rank, t);
  else
    STEIF_FAIL(a->ctx, STEIF_BAD_INPUT,
               "%s %d of problem '%s' has different values on different ranks at t = %.12g: "
               "reduce it in the callback",
               what, i + 1, a->p->name, t);
  return -1;
}

#define VALUES(what, count, call)                                                              \
  const stf_agreed *a = user;                                                                  \
  const steif_problem *p = a->p;                                                               \
  if (stf_deferred_gate(a->like, a->deferred)) return -1;                                      \
  const long failures = stf_failures(a->ctx);                                                  \
  const int returned = call;                                                                   \
  return values(a, failures, returned, what, t, count, value)

static int event(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  VALUES("event function", p->events, p->event(t, y, value, p->user));
}

static int invariant(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  VALUES("invariant", p->invariants, p->invariant(t, y, value, p->user));
}

static void *of_quadrature(const steif_problem *p)
{
  return p->quadrature->user ? p->quadrature->user : p->user;
}

static int integrand(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  VALUES("integrand", p->quadrature->count,
         p->quadrature->value(t, y, value, of_quadrature(p)));
}

static int integrand_slope(sunrealtype t, N_Vector y, N_Vector dy, int k, sunrealtype *value,
                           void *user)
{
  VALUES("the derivative of integrand", p->quadrature->count,
         p->quadrature->slope(t, y, dy, k, value, of_quadrature(p)));
}

static int ewt(N_Vector y, N_Vector w, void *user)
{
  const stf_agreed *a = user;
  if (stf_deferred_gate(a->like, a->deferred)) return -1;
  return stf_agree_returned(a->like, a->ewt(y, w, stf_own_user(a->ctx, a->p->user)));
}

#define NAMED(member)                                                                          \
  {                                                                                            \
    offsetof(steif_problem, member), #member                                                   \
  }

const char *stf_agreed_name(long id)
{
  static const struct {
    size_t offset;
    const char *name;
  } names[] = {NAMED(f),           NAMED(kick),      NAMED(drift),        NAMED(F),
               NAMED(g),           NAMED(jac),       NAMED(idajac),       NAMED(E),
               NAMED(A),           NAMED(L),         NAMED(Ev),           NAMED(Av),
               NAMED(Lv),          NAMED(precsetup), NAMED(precsolve),    NAMED(precsolve_pair),
               NAMED(start),       NAMED(exact),     NAMED(handle_event), NAMED(begin),
               NAMED(event_slope), NAMED(project)};
  for (size_t i = 0; i < STF_COUNT(names); i++)
    if ((long)names[i].offset == id) return names[i].name;
  return "a callback";
}

#define WRAP(callback) to->callback = p->callback ? callback : NULL

static void wrap_integrals(stf_agreed *a)
{
  const steif_quadrature *q = a->p->quadrature;
  if (!q) return;
  a->integrals = *q;
  a->integrals.user = a;
  if (q->value) a->integrals.value = integrand;
  if (q->slope) a->integrals.slope = integrand_slope;
  a->problem.quadrature = &a->integrals;
}

void stf_agreed_wrap(stf_agreed *a, steif_options *o)
{
  const steif_problem *p = a->p;
  steif_problem *to = &a->problem;
  *to = *p;
  to->user = a, to->save = NULL, to->restore = NULL;
  WRAP(f), WRAP(kick), WRAP(drift), WRAP(F), WRAP(g), WRAP(jac), WRAP(idajac);
  WRAP(E), WRAP(A), WRAP(L), WRAP(Ev), WRAP(Av), WRAP(Lv), WRAP(precsetup), WRAP(precsolve);
  WRAP(precsolve_pair), WRAP(start), WRAP(exact), WRAP(handle_event), WRAP(event_slope),
    WRAP(project), WRAP(begin), WRAP(event), WRAP(invariant);
  to->Etv = to->Atv = NULL,
  to->precsolve_transposed = NULL; /* of gradients, which serve no ranks */
  wrap_integrals(a);
  a->ewt = o->ewt;
  if (o->ewt) o->ewt = ewt;
}
