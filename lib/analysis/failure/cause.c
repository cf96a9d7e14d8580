/* cause.c: the list of causes in its order, and the limit of accuracy.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "causes.h"
#include <math.h>
#include <string.h>

/* -- accuracy ---------------------------------------------------------------------------- */

static void blame_tolerance(stf_search *c, size_t j)
{
  char y[STEIF_SPEC_WORD];
  steif_cause *cause = c->cause;
  cause->kind = STEIF_CAUSE_ACCURACY, cause->unknown = (sunindextype)j;
  cause->value[0] = STF_EPS * fabs(c->point->y0[j]);
  cause->value[1] = cause->value[0] / c->weight[j];
  stf_point_say(
    cause->message,
    "Tolerance cannot be met: the weight %.2g of %s is below 8 units of rounding of "
    "its value %.4g; smallest useful rtol about 1e-14.",
    c->weight[j], stf_point_unknown(c->point, j, y), c->point->y0[j]);
}

/* Against rounding at the scale of the equation. */
static bool loud(const stf_search *c, size_t i)
{
  return c->noise[i] > 1e3 * STF_EPS * c->scale[i];
}

static void blame(stf_search *c, size_t i, size_t j, sunrealtype noise, sunrealtype part)
{
  steif_cause *cause = c->cause;
  cause->kind = STEIF_CAUSE_ACCURACY;
  cause->equation = (sunindextype)i, cause->unknown = (sunindextype)j;
  cause->value[0] = noise, cause->value[1] = part;
}

static void blame_noise(stf_search *c, size_t i, size_t j, sunrealtype noise, sunrealtype part)
{
  char e[STEIF_SPEC_WORD], y[STEIF_SPEC_WORD];
  blame(c, i, j, noise, part);
  stf_point_say(
    c->cause->message,
    "Tolerance cannot be met: %s %.2g in %s makes an uncertainty of %.2g weights in "
    "%s; smallest useful rtol about %.0e.",
    loud(c, i) ? "noise" : "rounding", noise, stf_point_equation(c->point, i, e), part,
    stf_point_unknown(c->point, j, y), 10 * part * c->scene->rtol);
}

static void blame_differences(stf_search *c, size_t i, size_t j, sunrealtype noise,
                              sunrealtype part)
{
  char e[STEIF_SPEC_WORD], y[STEIF_SPEC_WORD];
  blame(c, i, j, noise, part);
  stf_point_say(
    c->cause->message,
    "Noise %.2g in %s spoils the Jacobian, which is made by differences: it moves %s by %.2g "
    "times their increment, so that Newton's iteration cannot succeed with any step. Give the "
    "Jacobian, or make the equation smoother.",
    noise, stf_point_equation(c->point, i, e), stf_point_unknown(c->point, j, y), part);
}

/* x = (E/h - A)^{-1} e_i times the noise of equation i. */
static int response(const stf_search *c, stf_factor *f, size_t i, sunrealtype *x)
{
  memset(x, 0, c->point->n * sizeof *x);
  x[i] = fmax(c->noise[i], STF_EPS * c->scale[i]);
  return stf_factor_solve(f, false, x);
}

/* The factors at 1/h, and the fast rate; close both in any case. */
static int factors(stf_search *c, stf_view *v, stf_factor **f, sunrealtype *rate)
{
  stf_point *s = c->point;
  sunrealtype slow;
  STEIF_TRY(stf_view_take(s, s->t, s->y0, s->yp0, v));
  STEIF_TRY(stf_factor_open(s, v, f));
  stf_view_rates(s, v, &slow, rate);
  return stf_factor_shift(*f, v, 1 / fabs(c->scene->h));
}

/* Against the increments at the start, since that is the relative error of a Jacobian made by differences.
 * It lets unknowns run away as in a blow-up, with steps that get as small. */
static int spoilt(stf_search *c, stf_factor *f)
{
  const size_t n = c->point->n;
  sunrealtype *x = c->point->scratch + 5 * n, most = 1;
  size_t column = n, row = 0;
  for (size_t i = 0; i < n; i++) {
    if (!loud(c, i)) continue;
    STEIF_TRY(response(c, f, i, x));
    for (size_t j = 0; j < n; j++) {
      const sunrealtype first = c->scene->count ? fabs(c->scene->y[j]) : 0;
      const sunrealtype part = fabs(x[j]) / (sqrt(STF_EPS) * fmax(first, c->point->floor[j]));
      if (part > most) most = part, column = j, row = i;
    }
  }
  if (column < n) blame_differences(c, row, column, c->noise[row], most);
  return STEIF_OK;
}

/* Against the weights, numbers taken off: h^(number - 1). */
static int uncertainty(stf_search *c, stf_factor *f, sunrealtype rate, bool noisy)
{
  const size_t n = c->point->n;
  sunrealtype *x = c->point->scratch + 5 * n, most = 0.1;
  size_t at = n, from = 0;
  for (size_t i = 0; i < n; i++) {
    if (loud(c, i) != noisy) continue;
    STEIF_TRY(response(c, f, i, x));
    for (size_t j = 0; j < n; j++) {
      const sunrealtype order = c->diagnosis.number[j] - 1;
      const sunrealtype part =
        fabs(x[j]) * pow(fmin(1, fabs(c->scene->h) * rate), order) / c->weight[j];
      if (part > most) most = part, at = j, from = i;
    }
  }
  if (at < n) blame_noise(c, from, at, fmax(c->noise[from], STF_EPS * c->scale[from]), most);
  return STEIF_OK;
}

/* A point where factors cannot be had tells nothing here. */
static int close_factors(stf_search *c, stf_view *v, stf_factor *f, int code)
{
  stf_factor_free(&f);
  stf_view_free(c->point, v);
  return code > 0 || code == STEIF_SINGULAR ? STEIF_OK : code;
}

int stf_cause_differences(stf_search *c)
{
  stf_view v = {0};
  stf_factor *f = NULL;
  sunrealtype rate;
  bool any = false;
  for (size_t i = 0; i < c->point->n; i++) any = any || loud(c, i);
  if (!any || c->point->analytic || !(fabs(c->scene->h) > 0)) return STEIF_OK;
  int code = factors(c, &v, &f, &rate);
  if (!code) code = spoilt(c, f);
  return close_factors(c, &v, f, code);
}

int stf_cause_accuracy(stf_search *c)
{
  stf_point *s = c->point;
  stf_view v = {0};
  stf_factor *f = NULL;
  sunrealtype rate;
  if (c->scene->prescribed) return STEIF_OK;
  for (size_t j = 0; j < s->n; j++)
    if (8 * STF_EPS * fabs(s->y0[j]) > c->weight[j]) {
      blame_tolerance(c, j);
      return STEIF_OK;
    }
  if (!(fabs(c->scene->h) > 0) || stf_cause_large(c)) return STEIF_OK;
  STEIF_TRY(stf_cause_diagnose(c));
  int code = factors(c, &v, &f, &rate);
  for (int noisy = 1; noisy >= 0 && !code && c->cause->kind == STEIF_CAUSE_UNKNOWN; noisy--)
    code = uncertainty(c, f, rate, noisy);
  return close_factors(c, &v, f, code);
}

/* -- order ------------------------------------------------------------------------------- */

static int residual_ahead(stf_point *s, sunrealtype dt, sunrealtype *y, sunrealtype *r)
{
  for (size_t j = 0; j < s->n; j++) y[j] = s->y0[j] + dt * s->yp0[j], r[j] = 0;
  return stf_point_residual(s, s->t + dt, y, s->yp0, r);
}

/* Halve [from, *dt] down to the first time known where F cannot be had; F there in r. */
static int border(stf_point *s, sunrealtype from, sunrealtype *dt, sunrealtype *y,
                  sunrealtype *r)
{
  for (int k = 0; k < 60; k++) {
    const sunrealtype middle = from + (*dt - from) / 2;
    const int code = residual_ahead(s, middle, y, r);
    if (code < 0 && code != STEIF_CALLBACK) return code;
    if (code)
      *dt = middle;
    else
      from = middle;
  }
  const int code = residual_ahead(s, *dt, y, r);
  return code < 0 && code != STEIF_CALLBACK ? code : STEIF_OK;
}

/* F at the point and along a step of length h, at `count` parts of it from the first. */
static int finite_along(stf_search *c, sunrealtype h, int first, int count)
{
  static const sunrealtype part[] = {0, 0.25, 0.5, 1, 8, 64, 512};
  stf_point *s = c->point;
  sunrealtype *y = s->scratch, *r = s->scratch + s->n;
  char e[STEIF_SPEC_WORD];
  for (int k = first; k < first + count; k++) {
    sunrealtype dt = part[k] * h;
    const int code = residual_ahead(s, dt, y, r);
    if (code < 0 && code != STEIF_CALLBACK) return code;
    if (!code) continue;
    if (k) STEIF_TRY(border(s, k > 1 ? part[k - 1] * h : 0, &dt, y, r));
    steif_cause *cause = c->cause;
    cause->kind = STEIF_CAUSE_NOT_FINITE, cause->t = s->t + dt;
    for (size_t i = s->n; i-- > 0;)
      if (!isfinite(r[i])) cause->equation = (sunindextype)i;
    if (cause->equation >= 0)
      stf_point_say(cause->message, "Equation %s is %g",
                    stf_point_equation(s, (size_t)cause->equation, e),
                    isnan(r[cause->equation]) ? fabs(r[cause->equation]) : r[cause->equation]);
    else
      stf_point_say(cause->message, "The equations cannot be evaluated");
    stf_point_say(cause->message,
                  " at t = %.12g, %s: the solution leaves the domain of its functions there.",
                  cause->t, k ? "along the attempted step" : "the last accepted point");
    return STEIF_OK;
  }
  return STEIF_OK;
}

static int not_finite(stf_search *c) { return finite_along(c, c->scene->h, 0, 1); }

/* After blow-up, which overflows along steps as well. */
static int not_finite_near(stf_search *c)
{
  const bool tiny = fabs(c->scene->h) < 1e-9 * fabs(c->point->t - c->scene->t0);
  return finite_along(c, c->scene->h, 1, tiny ? 6 : 3); /* tiny: longer steps were rejected */
}

/* Steps that shrink far below the last accepted one were first tried at its length. */
static int not_finite_ahead(stf_search *c)
{
  const steif_history *s = c->scene;
  const sunrealtype last = s->count > 1 ? s->t[s->count - 1] - s->t[s->count - 2] : 0;
  return fabs(s->h) < 1e-6 * last ? finite_along(c, last, 1, 4) : STEIF_OK;
}

/* Noise moves starts as well, and is told by accuracy, which comes next. */
static int start_without_noise(stf_search *c)
{
  for (size_t i = 0; i < c->point->n; i++)
    if (loud(c, i)) return STEIF_OK;
  return stf_cause_start(c);
}

static int open_case(stf_search *c)
{
  stf_point *s = c->point;
  const size_t n = s->n;
  c->scale = stf_pool_array(s->pool, 3 * n, sizeof *c->scale);
  if (!c->scale) return STEIF_NO_MEMORY;
  c->noise = c->scale + n, c->weight = c->scale + 2 * n;
  for (size_t j = 0; c->scene && j < n; j++)
    c->weight[j] =
      c->scene->rtol * fabs(s->y0[j]) + (c->scene->atols ? c->scene->atols[j] : c->scene->atol);
  stf_view v = {0};
  stf_start_task task = {.point = s, .view = &v, .scale = c->scale};
  int code = stf_view_take(s, s->t, s->y0, s->yp0, &v);
  if (!code) code = stf_start_scale(&task);
  stf_view_free(s, &v);
  return code;
}

bool stf_cause_large(const stf_search *c) { return c->point->n > STEIF_DIAGNOSE_LARGEST; }

static int nothing(stf_search *c)
{
  if (stf_cause_large(c)) {
    stf_point_say(c->cause->message,
                  "No cause was found at t = %.9g with step %.3g: F is finite and smooth "
                  "there; with more than %d unknowns its Jacobian and index are not looked at",
                  c->point->t, c->scene->h, STEIF_DIAGNOSE_LARGEST);
    return STEIF_OK;
  }
  STEIF_TRY(stf_cause_diagnose(c));
  stf_point_say(c->cause->message,
                "No cause was found at t = %.9g with step %.3g: F is finite and smooth there, "
                "its Jacobian is right (or not given); %s",
                c->point->t, c->scene->h, c->diagnosis.message);
  if (c->point->system.form == STEIF_DESCRIPTOR && c->diagnosis.index > 1)
    stf_point_say(c->cause->message,
                  ". Methods divide rounding by powers of h where constraints "
                  "stand in sums of equations: take the method descriptor, "
                  "which is for linear systems of any index");
  return STEIF_OK;
}

static int look(stf_search *c)
{
  static const struct {
    int (*test)(stf_search *);
    bool large; /* for any number of unknowns; the others are dense */
  } tests[] = {
    {not_finite, true},          {stf_cause_differences, false}, {stf_cause_blow_up, true},
    {not_finite_near, true},     {stf_cause_impasse, false},     {stf_cause_jump, true},
    {stf_cause_jacobian, false}, {stf_cause_singular, false},    {start_without_noise, false},
    {stf_cause_index, false},    {stf_cause_accuracy, true},     {stf_cause_stiff, false},
    {stf_cause_start, false},    {stf_cause_ringing, true},      {not_finite_ahead, true}};
  const size_t count = c->scene ? sizeof tests / sizeof *tests : 0;
  const int code = open_case(c);
  if (code < 0) return code;
  STEIF_TRY(stf_cause_noise(c));
  if (!c->scene) return stf_cause_jacobian(c);
  for (size_t k = 0; k < count && c->cause->kind == STEIF_CAUSE_UNKNOWN; k++)
    if (tests[k].large || !stf_cause_large(c)) STEIF_TRY(tests[k].test(c));
  return c->cause->kind == STEIF_CAUSE_UNKNOWN ? nothing(c) : STEIF_OK;
}

/* What is so large that matrices overflow is told by the points alone. */
static bool grown(const steif_problem *problem, const steif_point *inquiry,
                  const steif_history *scene, steif_cause *cause)
{
  const steif_names *names = problem ? problem->names : NULL;
  stf_point point = {.n = problem ? (size_t)problem->n : 0,
                     .unknown = inquiry && inquiry->unknown ? inquiry->unknown
                                : names                     ? names->unknown
                                                            : NULL};
  stf_search c = {.point = &point, .scene = scene, .cause = cause};
  return scene && stf_cause_growth(&c);
}

/* A point where F or its derivatives are not finite cannot even be opened: that is the
 * cause. */
static int examine(steif_context *ctx, const steif_problem *problem, const steif_point *inquiry,
                   const steif_history *scene, steif_cause *cause)
{
  stf_point point;
  STEIF_CHECK(cause, ctx, STEIF_BAD_INPUT, "a place for the cause is needed, got NULL");
  *cause = (steif_cause){.t = NAN, .equation = -1, .unknown = -1};
  if (grown(problem, inquiry, scene, cause)) return STEIF_OK;
  int code = stf_point_open(ctx, problem, inquiry, &point);
  if (code == STEIF_CALLBACK || (code == STEIF_NOT_FINITE && scene)) {
    cause->kind = STEIF_CAUSE_NOT_FINITE;
    stf_point_say(cause->message, "Not finite: %s", steif_message(ctx));
    steif_forget(ctx);
    return STEIF_OK;
  }
  STEIF_TRY(code);
  stf_search c = {.point = &point, .scene = scene, .cause = cause};
  c.evidence.point = &point;
  if (!scene && point.n > STEIF_DIAGNOSE_LARGEST)
    code = STEIF_FAIL(ctx, STEIF_UNSUPPORTED,
                      "'%s' has %zu unknowns: Jacobians are looked at up to %d", problem->name,
                      point.n, STEIF_DIAGNOSE_LARGEST);
  else
    code = look(&c);
  if (code == STEIF_CALLBACK && scene) {
    cause->kind = STEIF_CAUSE_NOT_FINITE;
    cause->t = point.t;
    stf_point_say(
      cause->message,
      "The equations cannot be evaluated beside the last accepted point, t = %.12g: "
      "the solution leaves the domain of its functions there.",
      point.t);
    code = STEIF_OK;
  }
  steif_diagnosis_clear(&c.diagnosis);
  stf_evidence_free(&c.evidence);
  stf_point_close(&point);
  if (!code) steif_forget(ctx);
  return code;
}

int steif_explain(steif_context *ctx, const steif_problem *problem, const steif_point *inquiry,
                  const steif_history *scene, steif_cause *cause)
{
  STF_NAMED(problem);
  STEIF_CHECK(scene && (scene->count == 0 || (scene->t && scene->y && scene->yp)), ctx,
              STEIF_BAD_INPUT,
              "a history with its accepted points is needed to explain a failure");
  STEIF_CHECK(scene->rtol >= 0 && (scene->rtol > 0 || scene->atol > 0 || scene->atols), ctx,
              STEIF_BAD_INPUT, "the tolerances of the failed run are needed, got rtol = %g",
              scene->rtol);
  return examine(ctx, problem, inquiry, scene, cause);
}

int steif_check_jacobian(steif_context *ctx, const steif_problem *problem,
                         const steif_point *inquiry, steif_cause *cause)
{
  STF_NAMED(problem);
  STEIF_TRY(examine(ctx, problem, inquiry, NULL, cause));
  if (cause->kind == STEIF_CAUSE_UNKNOWN)
    stf_point_say(cause->message, "E and A agree with differences of F");
  return STEIF_OK;
}
