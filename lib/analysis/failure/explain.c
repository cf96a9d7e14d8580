/* explain.c: why did a run fail. Each test assumes that those before it found nothing: a
 * jump looks like a wrong Jacobian, and noise looks like either.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "causes.h"
#include <math.h>
#include <string.h>

int stf_cause_diagnose(stf_search *c)
{
  if (c->gathered) return STEIF_OK;
  STEIF_TRY(stf_diagnose(c->point, &c->evidence, &c->diagnosis));
  c->gathered = true;
  return STEIF_OK;
}

/* -- Jacobian ---------------------------------------------------------------------------- */

static const sunrealtype wrong = 1e-3; /* relative defect of an entry */

typedef struct suspect {
  char which;
  size_t i, j;
  sunrealtype given, measured, worth; /* worth: defect relative to its row */
} suspect;

/* x = the point with component j moved by +-h; its column of residuals, and the difference of both as rounded. */
static int beside(stf_search *c, char which, size_t j, sunrealtype h, sunrealtype *work,
                  sunrealtype *apart)
{
  stf_point *point = c->point;
  const size_t n = point->n;
  const sunrealtype *base = which == 'E' ? point->yp0 : point->y0;
  sunrealtype *x = work;
  memcpy(x, base, n * sizeof *x);
  const volatile sunrealtype end[] = {base[j] + h, base[j] - h};
  *apart = end[0] - end[1];
  for (int k = 0; k < 2; k++) {
    x[j] = end[k];
    const int code =
      which == 'E'
        ? stf_point_residual(point, point->t, point->y0, x, work + (size_t)(1 + k) * n)
        : stf_point_residual(point, point->t, x, point->yp0, work + (size_t)(1 + k) * n);
    if (code) return code;
  }
  return STEIF_OK;
}

static sunrealtype noise_of(const stf_search *c, size_t i)
{
  return fmax(c->noise[i], STF_EPS * c->scale[i]);
}

/* Is a suspect guilty? Where an equation bends at the scale of an increment, differences are no derivative, and
 * an exact one looks wrong. With increments that fall by 4 as long as rounding leaves the defect visible, all
 * differences must agree (noise may be such a bend), and there must be enough of them. What bends below the
 * rounding of its equation is never seen: an entry far larger than measured must matter to it. */
static int convict(stf_search *c, const suspect *s, sunrealtype h, sunrealtype *work,
                   bool *guilty)
{
  enum { ENOUGH = 5, MOST = 400 };
  const size_t n = c->point->n;
  const sunrealtype *base = s->which == 'E' ? c->point->yp0 : c->point->y0;
  const sunrealtype defect = fabs(s->given - s->measured), part = 0.05, matters = 1,
                    rounding = 64 * STF_EPS * fabs(base[s->j]);
  sunrealtype noise = 0; /* by the values seen: scales hold the entry itself */
  int seen = 0;
  *guilty = false;
  for (int k = 0; k < MOST && h > rounding && noise / h < part * defect; k++, h /= 4) {
    sunrealtype apart;
    const int code = beside(c, s->which, s->j, h, work, &apart);
    if (code) return code;
    const sunrealtype up = work[n + s->i], down = work[2 * n + s->i],
                      slope = (up - down) / apart;
    noise = fmax(noise, 20 * STF_EPS * fmax(fabs(up), fabs(down)));
    if (!(fabs(slope - s->measured) < part * defect + noise / h)) return STEIF_OK;
    seen++;
  }
  const bool larger = fabs(s->given) > 10 * fabs(s->measured),
             tells = defect * c->point->size[s->j] > matters * noise / (20 * STF_EPS);
  *guilty = seen >= ENOUGH && (tells || !larger);
  return STEIF_OK;
}

/* Column j of E or F_y against differences with two increments. */
static int compare(stf_search *c, char which, size_t j, const sunrealtype *given,
                   const sunrealtype *top, sunrealtype *work, suspect *s)
{
  stf_point *point = c->point;
  const size_t n = point->n;
  const sunrealtype *base = which == 'E' ? point->yp0 : point->y0;
  sunrealtype h = 1e-4 * fmax(fabs(base[j]), point->floor[j] * (which == 'E' ? 1 : 1e-2));
  sunrealtype *slope = work + 3 * n, apart;
  for (int tries = 0, code = 1; code; tries++) {
    code = beside(c, which, j, h, work, &apart);
    for (size_t i = 0; i < n && !code; i++) slope[i] = (work[n + i] - work[2 * n + i]) / apart;
    if (!code) code = beside(c, which, j, h / 4, work, &apart);
    if (code < 0 || (code && tries > 4)) return code;
    if (code) h /= 16;
  }
  for (size_t i = 0; i < n; i++) slope[n + i] = (work[n + i] - work[2 * n + i]) / apart;
  for (size_t i = 0; i < n; i++) {
    const sunrealtype coarse = slope[i], fine = slope[n + i], defect = fabs(given[i] - fine);
    const sunrealtype doubt = 10 * (fabs(coarse - fine) + 20 * noise_of(c, i) / (h / 4));
    const sunrealtype worth = top[i] > 0 ? defect * point->size[j] / top[i] : 1;
    if (!(defect > wrong * fmax(fabs(given[i]), fabs(fine)) && defect > doubt &&
          worth > s->worth))
      continue;
    const suspect now = {which, i, j, given[i], fine, worth};
    bool guilty;
    const int code = convict(c, &now, h / 4, work, &guilty);
    if (code < 0) return code;
    if (!code && guilty) *s = now;
  }
  return STEIF_OK;
}

static void accuse(stf_search *c, const suspect *s)
{
  char e[STEIF_SPEC_WORD], y[STEIF_SPEC_WORD];
  steif_cause *cause = c->cause;
  cause->kind = STEIF_CAUSE_JACOBIAN;
  cause->equation = (sunindextype)s->i, cause->unknown = (sunindextype)s->j;
  cause->value[0] = s->given, cause->value[1] = s->measured;
  stf_point_say(cause->message,
                "The Jacobian you supplied is wrong: d%s/d%s%s given %.6g, measured %.6g%s.",
                stf_point_equation(c->point, s->i, e), stf_point_unknown(c->point, s->j, y),
                s->which == 'E' ? "'" : "", s->given, s->measured,
                s->given == 0 ? " (the entry is missing)"
                : fabs(s->given + s->measured) < 1e-3 * fabs(s->measured) ? " (wrong sign)"
                                                                          : "");
}

/* Largest entries of the rows, given ones and unknowns weighted by size. */
static void tops(const stf_point *s, const sunrealtype *M, sunrealtype *top)
{
  memset(top, 0, s->n * sizeof *top);
  for (size_t k = 0; k < s->n * s->n; k++)
    top[k % s->n] = fmax(top[k % s->n], fabs(M[k]) * s->size[k / s->n]);
}

int stf_cause_jacobian(stf_search *c)
{
  stf_point *s = c->point;
  const size_t n = s->n;
  suspect worst = {.worth = 1e-6};
  if (!s->analytic) return STEIF_OK;
  sunrealtype *M = stf_allocate(s->ctx, 2 * n * n + 6 * n, sizeof *M);
  if (!M) return STEIF_NO_MEMORY;
  sunrealtype *work = M + 2 * n * n, *top = work + 5 * n;
  int code = stf_point_matrices(s, s->t, s->y0, s->yp0, M, M + n * n);
  for (int which = 0; which < 2 && !code; which++) {
    tops(s, M + (size_t)which * n * n, top);
    for (size_t j = 0; j < n && !code; j++)
      code =
        compare(c, which ? 'A' : 'E', j, M + ((size_t)which * n + j) * n, top, work, &worst);
  }
  if (!code && worst.worth > 1e-6) accuse(c, &worst);
  stf_release(s->ctx, M);
  return code < 0 ? code : STEIF_OK;
}

/* -- singular, start, index -------------------------------------------------------------- */

int stf_cause_singular(stf_search *c)
{
  STEIF_TRY(stf_cause_diagnose(c));
  const steif_diagnosis *d = &c->diagnosis;
  const stf_resolvent_growth *g = &c->evidence.at[0].growth;
  const bool none = d->verdict == STEIF_NO_SOLUTION || d->verdict == STEIF_NOT_UNIQUE;
  if (!none && !g->singular) return STEIF_OK;
  c->cause->kind = STEIF_CAUSE_SINGULAR;
  c->cause->value[0] = g->row ? g->rcond : 0;
  if (none) {
    stf_point_say(c->cause->message, "Singular pencil: %s. No step size can help.", d->message);
    return STEIF_OK;
  }
  stf_point_say(c->cause->message,
                "s E - A is singular for every s, so that no step can be solved, though the "
                "solution is determined: index %d (%s) of matrices that turn with time",
                d->index, steif_confidence_name(d->confidence));
  if (!stf_point_any(c->point, d->derivatives, 1)) {
    stf_point_say(
      c->cause->message,
      ". No equation is differentiated on the way: perhaps an entry has become 0, as "
      "the slope of an exponential that underflows; give the equation a small term of "
      "its own, such as a conductance beside a diode");
    return STEIF_OK;
  }
  stf_point_say(c->cause->message, "; differentiated on the way: ");
  stf_point_list(c->point, c->cause->message, true, d->derivatives, 1, true);
  stf_point_say(c->cause->message, ". Put derivatives of these in their place");
  return STEIF_OK;
}

/* The start of a linear problem: its impulses outlive many short steps. */
static bool from_problem(const stf_search *c)
{
  return c->point->problem.linear && !c->scene->restarted;
}

/* allowed: of the error of y at the start, or where the run has started anew. */
static int from_start(stf_search *c, sunrealtype *allowed, steif_start *start)
{
  const steif_history *s = c->scene;
  const size_t n = c->point->n;
  const bool linear = from_problem(c), kept = s->count > 0;
  const size_t at = s->restarted ? s->count - 1 : 0;
  const sunrealtype *y = kept ? s->y + at * n : c->point->y0,
                    *yp = kept ? s->yp + at * n : c->point->yp0;
  const steif_point q = {.y = linear ? NULL : y, /* NULL: the start of the problem */
                         .yp = linear ? NULL : yp,
                         .t = linear ? s->t0
                              : kept ? s->t[at]
                                     : c->point->t,
                         .size = c->point->floor,
                         .equation = c->point->equation,
                         .unknown = c->point->unknown};
  sunrealtype *weight = stf_allocate(c->point->ctx, n, sizeof *weight);
  if (!weight) return STEIF_NO_MEMORY;
  for (size_t j = 0; j < n; j++) {
    allowed[j] =
      s->rtol * (linear ? c->point->size[j] : fabs(y[j])) + (s->atols ? s->atols[j] : s->atol);
    weight[j] = 1 / allowed[j];
  }
  const steif_request request = {.weight = weight};
  steif_problem from = c->point->problem; /* from there on */
  from.t0 = q.t;
  const int code = steif_consistent(c->point->ctx, &from, &q, &request, start);
  stf_release(c->point->ctx, weight);
  return code;
}

static void say_start(stf_search *c, const steif_start *start, bool visible, size_t at,
                      sunrealtype weights)
{
  char y[STEIF_SPEC_WORD], e[STEIF_SPEC_WORD];
  char *m = c->cause->message;
  const bool anew = c->scene->restarted;
  if (anew)
    stf_point_say(m, "After the event or break at t = %.9g the solution", c->point->t);
  else
    stf_point_say(m, "Start");
  stf_point_say(m, " is inconsistent with %s%s: %s is off by %.3g (%.2g weights). ",
                visible ? "equation " : "a hidden constraint",
                visible ? stf_point_equation(c->point, (size_t)start->worst, e) : "",
                stf_point_unknown(c->point, at, y), -start->moved[at], weights);
  if (anew)
    stf_point_say(m,
                  "It jumps there, and derivatives of what jumps are impulses: set what jumps "
                  "in the event, take options.reinitialise = steif_reinitialise, or make the "
                  "change in a short time instead; steif_consistent says: ");
  else
    stf_point_say(m, "Call steif_consistent first%s; it says: ",
                  from_problem(c)
                    ? ", or take the method descriptor, which makes the jump and its impulses"
                    : "");
  stf_point_say(m, "%s", start->message);
}

/* The equations as they are behind an event may have no solution near the one before. */
static void say_none(stf_search *c)
{
  c->cause->kind = STEIF_CAUSE_START;
  stf_point_say(c->cause->message,
                "No consistent values were found after the event or break at t = %.9g: %s",
                c->point->t, steif_message(c->point->ctx));
  steif_forget(c->point->ctx);
}

int stf_cause_start(stf_search *c)
{
  steif_start start = {0};
  const bool linear = from_problem(c), anew = c->scene->restarted;
  if (c->scene->steps > 1 && !linear && !anew) return STEIF_OK;
  STEIF_TRY(stf_cause_diagnose(c));
  if (c->diagnosis.index < 1) return STEIF_OK;
  sunrealtype *allowed = stf_pool_array(c->point->pool, c->point->n, sizeof *allowed);
  if (!allowed) return STEIF_NO_MEMORY;
  const int code = from_start(c, allowed, &start);
  if (code == STEIF_NO_MEMORY) return code;
  if (code && anew) say_none(c);
  if (code) return STEIF_OK;
  sunrealtype most = 10;
  const size_t n = c->point->n;
  size_t at = n;
  for (int number = 1; number <= STF_DEEPEST && at == n; number++) /* causes before effects */
    for (size_t j = 0; j < n; j++)
      if (c->diagnosis.number[j] == number && fabs(start.moved[j]) / allowed[j] > most)
        most = fabs(start.moved[j]) / allowed[j], at = j;
  if (at < n) {
    const bool visible = start.worst >= 0 && start.violation > allowed[at];
    steif_cause *cause = c->cause;
    cause->kind = STEIF_CAUSE_START, cause->unknown = (sunindextype)at;
    cause->equation = visible ? start.worst : -1;
    cause->value[0] = start.moved[at], cause->value[1] = most;
    say_start(c, &start, visible, at, most);
  }
  steif_start_clear(&start);
  return STEIF_OK;
}

static int name_high_index(stf_search *c)
{
  const steif_diagnosis *d = &c->diagnosis;
  steif_cause *cause = c->cause;
  char *m = cause->message;
  size_t at = 0;
  for (size_t j = 1; j < c->point->n; j++)
    if (d->number[j] > d->number[at]) at = j;
  cause->kind = STEIF_CAUSE_INDEX, cause->unknown = (sunindextype)at;
  cause->value[0] = d->index, cause->value[1] = d->number[at];
  stf_point_say(m, "Index is %d (%s), and nonlinear equations are served up to 3: errors of ",
                d->index, steif_confidence_name(d->confidence));
  stf_point_list(c->point, m, false, d->number, 2, true);
  stf_point_say(m, " grow with powers of 1/h; differentiated on the way: ");
  stf_point_list(c->point, m, true, d->derivatives, 1, true);
  stf_point_say(m, ". Put derivatives of these in their place until the index is 3 or less");
  return STEIF_OK;
}

/* SUNDIALS' integrators keep their estimates to themselves: what the index does to any of them. */
static int name_index_of_engine(stf_search *c)
{
  const steif_diagnosis *d = &c->diagnosis;
  steif_cause *cause = c->cause;
  size_t at = 0;
  for (size_t j = 1; j < c->point->n; j++)
    if (d->number[j] > d->number[at]) at = j;
  cause->kind = STEIF_CAUSE_INDEX, cause->unknown = (sunindextype)at;
  cause->value[0] = d->index, cause->value[1] = d->number[at];
  stf_point_say(cause->message, "Index is %d (%s), and %s is for index 1: errors of ", d->index,
                steif_confidence_name(d->confidence),
                c->scene->method ? c->scene->method : "the method");
  stf_point_list(c->point, cause->message, false, d->number, 2, true);
  stf_point_say(cause->message, " do not fall with h. Use radau or auto, which control them by "
                                "their index, or a form of index 1");
  return STEIF_OK;
}

int stf_cause_index(stf_search *c)
{
  const size_t n = c->point->n;
  const sunrealtype *error = c->scene->error;
  char y[STEIF_SPEC_WORD];
  STEIF_TRY(stf_cause_diagnose(c));
  const steif_diagnosis *d = &c->diagnosis;
  if (d->index > 3 && !c->point->system.linear) return name_high_index(c);
  if (d->index < 2 || c->scene->prescribed) return STEIF_OK;
  if (!error) return d->index > 2 ? name_index_of_engine(c) : STEIF_OK;
  if (c->scene->weighted) return STEIF_OK;
  size_t at = 0;
  for (size_t j = 1; j < n; j++)
    if (fabs(error[j]) / c->weight[j] > fabs(error[at]) / c->weight[at]) at = j;
  if (d->number[at] < 2) return STEIF_OK;
  steif_cause *cause = c->cause;
  cause->kind = STEIF_CAUSE_INDEX, cause->unknown = (sunindextype)at;
  cause->value[0] = d->index, cause->value[1] = d->number[at];
  stf_point_say(cause->message,
                "Index is %d, weights are for index 1: the error of %s does not fall with h "
                "(it is multiplied by h^-%d). Set index weights: ",
                d->index, stf_point_unknown(c->point, at, y), d->number[at] - 1);
  for (size_t j = 0; j < n && j < 24; j++)
    stf_point_say(cause->message, "%s%d", j ? "," : "", d->number[j]);
  stf_point_say(cause->message, "%s (computed), or use radau with them.", n > 24 ? ",..." : "");
  return STEIF_OK;
}
