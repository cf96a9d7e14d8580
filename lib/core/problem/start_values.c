/* start_values.c: start values of a problem, and the first call of its callbacks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
#include <stdio.h>
#include <string.h>

static const char *name(const char *const *names, char letter, sunindextype i, char *room)
{
  if (names)
    snprintf(room, STEIF_SPEC_WORD, "'%s'", names[i]);
  else
    snprintf(room, STEIF_SPEC_WORD, "%c%lld", letter, (long long)i + 1);
  return room;
}

const char *stf_unknown(const steif_problem *p, sunindextype i, char *room)
{
  return name(p->names ? p->names->unknown : NULL, 'y', i, room);
}

const char *stf_equation(const steif_problem *p, sunindextype i, char *room)
{
  return name(p->names ? p->names->equation : NULL, 'e', i, room);
}

int stf_start_values(steif_context *ctx, const steif_problem *p, N_Vector y, N_Vector yp)
{
  if (p->start) {
    const int returned = p->start(p->t0, y, yp, p->user);
    STEIF_CHECK(returned == 0, ctx, STEIF_CALLBACK, "start of problem '%s' returned %d",
                p->name, returned);
    return STEIF_OK;
  }
  sunindextype rows;
  sunrealtype *a = stf_own_rows(y, &rows), *b = stf_own_rows(yp, &rows);
  STEIF_CHECK(a && b, ctx, STEIF_UNSUPPORTED,
              "vectors without a host array need the callback "
              ".start of problem '%s'",
              p->name);
  memcpy(a, p->y0, (size_t)rows * sizeof *a);
  if (p->yp0) memcpy(b, p->yp0, (size_t)rows * sizeof *b);
  return STEIF_OK;
}

/* A vector must come back from a callback as it went. */
static int check_size(steif_context *ctx, const steif_problem *p, const char *what, N_Vector v,
                      const sunrealtype *array)
{
  STEIF_CHECK(N_VGetLength(v) == p->n && stf_array(v) == array, ctx, STEIF_BAD_INPUT,
              "%s of problem '%s' gave a vector back with %lld components%s, it had %lld: "
              "callbacks fill vectors and never replace or resize them",
              what, p->name, (long long)N_VGetLength(v),
              N_VGetLength(v) == p->n ? " in another array" : "", (long long)p->n);
  return STEIF_OK;
}

/* f, F or g at the start into out; F with y' only where that is known. */
static int first_call(steif_context *ctx, const steif_problem *p, int form, bool known,
                      N_Vector y, N_Vector yp, N_Vector out)
{
  const char *what = form == STEIF_IMPLICIT ? "F" : form == STEIF_DESCRIPTOR ? "g" : "f";
  if ((form == STEIF_IMPLICIT && !known) || (form == STEIF_DESCRIPTOR && !p->g))
    return STEIF_OK;
  sunrealtype *kept[] = {stf_array(y), stf_array(out)};
  const int returned = form == STEIF_IMPLICIT     ? p->F(p->t0, y, yp, out, p->user)
                       : form == STEIF_DESCRIPTOR ? p->g(p->t0, 0, out, p->user)
                                                  : p->f(p->t0, y, out, p->user);
  STEIF_CHECK(returned == 0, ctx, STEIF_CALLBACK,
              "%s of problem '%s' could not be evaluated at the start, t = %g (it returned %d)",
              what, p->name, p->t0, returned);
  STEIF_TRY(check_size(ctx, p, what, y, kept[0]));
  STEIF_TRY(check_size(ctx, p, what, out, kept[1]));
  stf_space space;
  char room[STEIF_SPEC_WORD];
  stf_space_open(&space, out);
  STEIF_CHECK(stf_finite(&space, out), ctx, STEIF_NOT_FINITE,
              "component %s of %s of problem '%s' is not finite at the start, t = %g: correct "
              "the start or the equations",
              stf_number_not_finite(out, room), what, p->name, p->t0);
  return STEIF_OK;
}

int stf_system_start(steif_context *ctx, const steif_problem *p, int form,
                     const stf_space *space, N_Vector y, N_Vector yp, bool *known)
{
  char room[STEIF_SPEC_WORD];
  STEIF_TRY(stf_start_values(ctx, p, y, yp));
  STEIF_CHECK(stf_finite(space, y), ctx, STEIF_NOT_FINITE,
              "start value %s of problem '%s' is not finite", stf_number_not_finite(y, room),
              p->name);
  STEIF_CHECK(stf_finite(space, yp), ctx, STEIF_NOT_FINITE,
              "slope %s at the start of problem '%s' is not finite",
              stf_number_not_finite(yp, room), p->name);
  *known = p->yp0 || p->start || form == STEIF_ODE;
  if (form == STEIF_ODE) return first_call(ctx, p, form, true, y, yp, yp);
  stf_pool *pool = stf_pool_new(ctx);
  N_Vector out = pool ? stf_pool_vector(pool, y) : NULL;
  const int code = out ? first_call(ctx, p, form, *known, y, yp, out) : STEIF_NO_MEMORY;
  stf_pool_free(&pool);
  return code;
}
