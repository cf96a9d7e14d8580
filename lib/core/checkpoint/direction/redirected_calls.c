/* redirected_calls.c: callbacks of a problem called on behalf of another, whose user pointer is a direction.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "direction_inside.h"

static const steif_problem *of(const void *user)
{
  return ((const steif_direction *)user)->given;
}

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  return of(user)->f(t, y, out, of(user)->user);
}

static int kick(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  return of(user)->kick(t, y, out, of(user)->user);
}

static int drift(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  return of(user)->drift(t, y, out, of(user)->user);
}

static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  return of(user)->F(t, y, yp, r, of(user)->user);
}

static int g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  return of(user)->g(t, derivative, out, of(user)->user);
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a1,
               N_Vector a2, N_Vector a3)
{
  return of(user)->jac(t, y, fy, J, of(user)->user, a1, a2, a3);
}

static int idajac(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r,
                  SUNMatrix J, void *user, N_Vector a1, N_Vector a2, N_Vector a3)
{
  return of(user)->idajac(t, c, y, yp, r, J, of(user)->user, a1, a2, a3);
}

static int E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  return of(user)->E(t, y, yp, M, of(user)->user);
}

static int A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  return of(user)->A(t, y, yp, M, of(user)->user);
}

static int L(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  return of(user)->L(t, y, yp, M, of(user)->user);
}

static int Ev(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  return of(user)->Ev(t, y, yp, x, out, of(user)->user);
}

static int Av(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  return of(user)->Av(t, y, yp, x, out, of(user)->user);
}

static int Lv(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  return of(user)->Lv(t, y, yp, x, out, of(user)->user);
}

static int precsetup(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c,
                     void *user)
{
  return of(user)->precsetup(t, y, yp, r, c, of(user)->user);
}

static int precsolve(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
                     sunrealtype c, sunrealtype delta, void *user)
{
  return of(user)->precsolve(t, y, yp, r, b, z, c, delta, of(user)->user);
}

static int precsolve_pair(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector *b,
                          N_Vector *z, sunrealtype c_re, sunrealtype c_im, sunrealtype delta,
                          void *user)
{
  return of(user)->precsolve_pair(t, y, yp, r, b, z, c_re, c_im, delta, of(user)->user);
}

static int Etv(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  return of(user)->Etv(t, y, yp, x, out, of(user)->user);
}

static int Atv(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  return of(user)->Atv(t, y, yp, x, out, of(user)->user);
}

static int precsolve_transposed(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b,
                                N_Vector z, sunrealtype c, sunrealtype delta, void *user)
{
  return of(user)->precsolve_transposed(t, y, yp, r, b, z, c, delta, of(user)->user);
}

static int start(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  return of(user)->start(t, y, yp, of(user)->user);
}

static int project(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  return of(user)->project(t, y, yp, of(user)->user);
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  return of(user)->exact(t, y, yp, of(user)->user);
}

static int invariant(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  return of(user)->invariant(t, y, value, of(user)->user);
}

static int event(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  return of(user)->event(t, y, value, of(user)->user);
}

static int handle_event(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  return of(user)->handle_event(t, y, fired, of(user)->user);
}

static int event_slope(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  return of(user)->event_slope(t, y, yp, of(user)->user);
}

static int begin(sunrealtype t, void *user) { return of(user)->begin(t, of(user)->user); }

static long save(void *bytes, void *user) { return of(user)->save(bytes, of(user)->user); }

static int restore(const void *bytes, size_t count, void *user)
{
  return of(user)->restore(bytes, count, of(user)->user);
}

static void redirect_matrices(const steif_problem *from, steif_problem *to)
{
  if (from->jac) to->jac = jac;
  if (from->idajac) to->idajac = idajac;
  if (from->E) to->E = E;
  if (from->A) to->A = A;
  if (from->L) to->L = L;
  if (from->Ev) to->Ev = Ev;
  if (from->Av) to->Av = Av;
  if (from->Lv) to->Lv = Lv;
  if (from->precsetup) to->precsetup = precsetup;
  if (from->precsolve) to->precsolve = precsolve;
  if (from->precsolve_pair) to->precsolve_pair = precsolve_pair;
  if (from->Etv) to->Etv = Etv;
  if (from->Atv) to->Atv = Atv;
  if (from->precsolve_transposed) to->precsolve_transposed = precsolve_transposed;
}

void stf_redirect(steif_direction *d)
{
  const steif_problem *from = d->given;
  steif_problem *to = &d->problem;
  *to = *from;
  to->user = d;
  to->build = NULL, to->destroy = NULL;
  redirect_matrices(from, to);
  if (from->f) to->f = f;
  if (from->kick) to->kick = kick;
  if (from->drift) to->drift = drift;
  if (from->F) to->F = F;
  if (from->g) to->g = g;
  if (from->start) to->start = start;
  if (from->project) to->project = project;
  if (from->exact) to->exact = exact;
  if (from->invariant) to->invariant = invariant;
  if (from->event) to->event = event;
  if (from->handle_event) to->handle_event = handle_event;
  if (from->event_slope) to->event_slope = event_slope;
  if (from->begin) to->begin = begin;
  if (from->save) to->save = save;
  if (from->restore) to->restore = restore;
}
