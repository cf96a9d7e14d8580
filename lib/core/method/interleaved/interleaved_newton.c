/* interleaved_newton.c: Jacobians, factors and Newton's iteration of collocation with interleaved shifts.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "irk_interleaved.h"
#include <math.h>
#include <string.h>

/* -- Jacobian and factors ----------------------------------------------------------------------------- */

/* A quarter step ahead on the last polynomial, while it predicts well. */
static int jacobian(stf_step *s, double h)
{
  stf_irk_interleaved *e = s->state;
  const double ahead = 0.25, x = ahead * h / s->h;
  e->J_new = true, e->eta = 1;
  e->J_ahead = e->history && !s->restart && e->fails < 2 && e->first_correction < 0.3 &&
               h < 1.5 * s->h && s->problem->dae_index < 2;
  if (!e->J_ahead) return stf_system_matrices(&s->system, s->t, s->y, s->yp);
  double *y = STF_ARRAY(s->next);
  for (int i = 0; i < e->n; i++) {
    const double *a = e->a + i * e->L->wide;
    double sum = 0;
    for (int k = e->s; k-- > 0;) sum = (sum + a[k]) * x;
    y[i] = STF_ARRAY(s->y)[i] + sum;
  }
  return stf_system_matrices(&s->system, s->t + ahead * h, s->next, s->yp);
}

int stf_irk_interleaved_factor(stf_step *s, double h)
{
  stf_irk_interleaved *e = s->state;
  e->h_factored = 0;
  s->factors += (e->s + 1) / 2;
  STEIF_TRY(stf_system_interleave(&s->system, e->L, s->t, h));
  e->h_factored = h;
  return STEIF_OK;
}

int stf_irk_interleaved_prepare(stf_step *s, double h)
{
  stf_irk_interleaved *e = s->state;
  if (s->newton.jacobian_wanted) /* behind an event or a break f is another */
    e->renew_J = true, e->J_new = s->newton.jacobian_wanted = false;
  const bool at_point = e->J_new && !e->J_ahead && e->fails > 0;
  if (e->renew_J && !at_point) STEIF_TRY(jacobian(s, h));
  if (!e->renew_J && e->h_factored == h) return STEIF_OK;
  e->renew_J = false;
  return stf_irk_interleaved_factor(s, h);
}

/* -- Newton ---------------------------------------------------------------------------------------------- */

static int refuse(stf_step *s, double h, double norm, double theta, double shrink)
{
  stf_irk_interleaved *e = s->state;
  e->fails++, e->eta = 1, e->renew_J = true;
  s->newton.fails++;
  s->control.retry = shrink;
  if (!(norm <= 1e100))
    return STEIF_RECOVER(
      s->ctx, STEIF_NOT_FINITE,
      "a stage of problem '%s' is not finite in the step from t = %.12g with "
      "h = %.6g: the callbacks returned NaN or infinity, or the step is too large",
      s->problem->name, s->t, h);
  return STEIF_RECOVER(
    s->ctx, STEIF_NO_CONVERGENCE,
    "Newton's iteration did not converge for problem '%s' in the step from t = %.12g "
    "with h = %.6g: after %d iterations the correction is %.3g of its tolerance, "
    "rate %.2g; check the Jacobian%s",
    s->problem->name, s->t, h, e->iterations, norm / e->kappa, theta,
    s->problem->dae_index < 3
      ? ""
      : ", or take a larger rtol: multipliers of index 3 have rounding errors of eps / h^2");
}

/* Rounding in the stages makes corrections below this meaningless. Of velocities in problems of index 3 they
 * count h times less, so that each step may leave 10 eps / h in them, which N steps add up to N^(3/2) eps
 * at least: there the iteration ends where corrections no longer shrink. */
static double floor_of(const stf_step *s, const stf_irk_interleaved *e)
{
  if (s->problem->dae_index >= 3) return e->kappa;
  const double *y = STF_ARRAY(s->y), *w = STF_ARRAY(s->weights);
  double most = 0;
  for (int i = 0; i < e->n; i++) most = fmax(most, fabs(y[i]) * w[i]);
  return fmax(e->kappa, 10 * STF_EPS * most);
}

static double power(double x, int n)
{
  double p = 1;
  for (; n > 0; n /= 2, x *= x)
    if (n % 2) p *= x;
  return p;
}

/* F_j <- F_j - M sum_k b_jk Z_k / h, b of A^{-1}. */
static void whole_residuals(stf_irk_interleaved *e, double h)
{
  const int n = e->n, wide = e->L->wide;
  double d[STF_INTERLEAVED];
  stf_interleaved_end(e->L);
  for (int j = 0; j < e->s; j++) {
    double *F = STF_ARRAY(e->F[j]);
    for (int i = 0; i < n; i++) {
      d[i] = 0;
      for (int k = 0; k < e->s; k++) d[i] += e->B[j * e->s + k] * e->L->Z[i * wide + k];
      d[i] /= h;
    }
    for (int i = 0; i < n; i++) {
      double sum = 0;
      for (int k = 0; k < n; k++) sum += e->M[i * n + k] * d[k];
      F[i] -= sum;
    }
  }
}

/* The correction just made in the stages themselves; those before it are in Z. Of omega, rounding looks
 * as many times larger as V^{-1} is large. */
static double moved(stf_irk_interleaved *e, const double *w)
{
  const size_t count = (size_t)e->n * (size_t)e->L->wide;
  double sum = 0;
  memcpy(e->last_Z, e->L->Z, count * sizeof *e->last_Z);
  stf_interleaved_end(e->L);
  for (int i = 0; i < e->n; i++)
    for (int j = 0; j < e->s; j++) {
      const double d = w[i] * (e->L->Z[i * e->L->wide + j] - e->last_Z[i * e->L->wide + j]);
      sum += d * d;
    }
  return sqrt(sum / (double)(e->s * e->n));
}

static int evaluate(stf_step *s, double h)
{
  stf_irk_interleaved *e = s->state;
  for (int j = 0; j < e->s; j++) {
    const int code = stf_system_rhs(&s->system, s->t + e->table->c[j] * h, e->Y[j], e->F[j]);
    if (code) return e->fails++, e->renew_J = true, s->control.retry = 0.25, code;
  }
  if (e->L->residuals) whole_residuals(e, h);
  return STEIF_OK;
}

/* In the coordinates of the lanes M omega and F, both large where M y' is, are rounded apart, and their
 * rounding is multiplied by the condition of V; what rows of M cancel, the algebraic part, is then
 * rounding. Where that may be all that is left, it goes on with residuals by stages. */
static bool goes_on_by_stages(const stf_step *s, const stf_irk_interleaved *e, double norm)
{
  return e->M && !e->L->residuals && s->problem->dae_index < 2 &&
         norm <= 1e-9 / s->options->rtol;
}

/* What rounding may leave of corrections, in tolerances. Of velocities and multipliers they count h and h^2
 * times less, and are then as large in short steps as in long ones. */
static double rounding_of(const stf_step *s)
{
  const double eps = 1e-10, high = s->tries < 2 ? 0.01 : 0.1,
               multipliers = s->problem->dae_index >= 3 ? 3 * high : high;
  if (s->problem->dae_index < 2) return fmin(1, eps / s->options->rtol);
  return fmin(s->problem->dae_index >= 3 ? 0.5 : high, multipliers * eps / s->options->rtol);
}

/* Corrections that no longer shrink, or grow once they are small, are rounding: so is then what the
 * differences of highest order show. Multipliers of higher index are not to be left at that. */
static bool stalled(stf_step *s, double norm, double last, double tolerance)
{
  stf_irk_interleaved *e = s->state;
  const bool high = s->problem->dae_index > 1;
  const double rounding = rounding_of(s);
  e->rounding_limited =
    (norm >= 0.5 * last && norm <= fmax(tolerance, high ? rounding : 0.1 * rounding)) ||
    (norm >= last && norm <= rounding && !high);
  return e->rounding_limited;
}

/* A matrix from inside the step about halves the iterations that are left, and an LU costs as much as
 * n / 4 of them: is it worth its price? Not for methods that do not damp: what their stiff components
 * keep from step to step passes the filter of the error, which is this matrix. */
static bool worth(const stf_step *s, const stf_irk_interleaved *e, double norm, double theta,
                  double tolerance)
{
  const double slow = 0.1;
  const int price = 2 + e->n / 2;
  if (e->J_from_stage || !e->accurate || s->system.linear || s->problem->dae_index > 1)
    return false;
  return theta > slow && theta < 1 && power(theta, price) * e->eta * norm > tolerance;
}

/* J at a stage in the second half of the step as it is now, and factors of it: errors of the stages are
 * smaller there than those of any prediction, and J differs less from that of all stages than the one at
 * t_n does. */
static int renew_from_stage(stf_step *s, double h)
{
  stf_irk_interleaved *e = s->state;
  const double inside = 0.6;
  int j = 0;
  while (j < e->s - 1 && e->table->c[j] < inside) j++;
  e->J_from_stage = e->J_ahead = true;
  STEIF_TRY(stf_system_matrices(&s->system, s->t + e->table->c[j] * h, e->Y[j], s->yp));
  return stf_irk_interleaved_factor(s, h);
}

/* Of algebraic unknowns, corrections by the matrix of an earlier step may be far smaller than what is left, and shrink
 * slowly behind others that shrink fast: a diode that opens conducts a thousandth of what the matrix says. */
static bool outdated(const stf_step *s, const stf_irk_interleaved *e)
{
  return e->M && !e->J_new && !s->system.linear && s->problem->dae_index < 2;
}

/* The norm is that of the multipliers where their rounding, eps / h^2, ends the iteration: one correction more
 * for the velocities, in which it leaves an error that is kept and adds up in positions. */
static int once_more(stf_step *s, double h)
{
  const stf_irk_interleaved *e = s->state;
  if (!e->rounding_limited || s->problem->dae_index < 3) return STEIF_OK;
  STEIF_TRY(evaluate(s, h));
  stf_interleaved_sweep(e->L, STF_ARRAY(s->y), STF_ARRAY(s->weights), h);
  s->newton.sweeps++, s->solves += (e->s + 1) / 2;
  return STEIF_OK;
}

int stf_irk_interleaved_iterate(stf_step *s, double h)
{
  stf_irk_interleaved *e = s->state;
  const double tolerance = floor_of(s, e),
               first_rate = s->system.linear || s->problem->dae_index > 1 ? 0 : 1e-3,
               mean = 1 / (double)(e->s * e->n);
  const double *y = STF_ARRAY(s->y), *w = STF_ARRAY(s->weights);
  double last = 0, quotient = 0, theta = 0, first = 0;
  e->eta = stf_power(fmax(e->eta, STF_EPS), 0.8),
  e->rounding_limited = e->J_from_stage = e->L->residuals = false;
  for (int m = 1, since = 1;; m++, since++) {
    STEIF_TRY(evaluate(s, h));
    double norm = sqrt(stf_interleaved_sweep(e->L, y, w, h) * mean);
    if (e->L->residuals) norm = moved(e, w);
    s->newton.sweeps++, s->solves += (e->s + 1) / 2, e->iterations = m;
    if (!(norm <= 1e100)) return refuse(s, h, norm, theta, 0.25);
    if (m == 1) e->first_correction = norm;
    if (since > 1) {
      const double now = norm / last;
      theta = since == 2 ? now : sqrt(now * quotient);
      quotient = now;
      if (m == 2) first = now < 1 ? now / (1 - now) : 1, e->eta_of = last;
      const bool stuck = stalled(s, norm, last, tolerance), old = outdated(s, e),
                 doubt = stuck && old && !e->J_from_stage;
      if (stuck && !doubt) break;
      e->eta = theta / (1 - theta);
      const bool told = !doubt && (m > 2 || !old || norm <= tolerance);
      if (told && theta < 1 && e->eta * norm <= tolerance) break;
      if (doubt || worth(s, e, norm, theta, tolerance)) {
        STEIF_TRY(renew_from_stage(s, h));
        since = 0, e->eta = 1, last = fmax(norm, STF_EPS);
        continue;
      }
      const int left = e->itmax - 1 - m;
      const double excess = e->eta * norm * power(theta, left) / tolerance;
      const bool slow = !(theta < 0.99) || left < 0 || excess >= 1;
      if (slow && goes_on_by_stages(s, e, norm)) {
        e->L->residuals = true;
        m = since = 0, e->eta = 1, last = fmax(norm, STF_EPS);
        continue;
      }
      if (!(theta < 0.99)) return refuse(s, h, norm, theta, 0.5);
      if (left < 0 || excess >= 1) {
        const double q = fmax(1e-4, fmin(20, excess));
        return refuse(s, h, norm, theta,
                      0.8 * stf_power(q, -1.0 / (4 + (left > 0 ? left : 0))));
      }
    } else if (fmax(first_rate, e->eta * fmax(1, norm / e->eta_of)) * norm <= tolerance)
      break;
    last = fmax(norm, STF_EPS);
  }
  e->theta = theta, e->eta = fmax(e->eta, first);
  return once_more(s, h);
}
