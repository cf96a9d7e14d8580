/* mean_trace.c: the mean of trace J over an interval, by nodes that no method's steps have chosen.
 *
 * x' = A(t) x: Gauss and Kronrod's pair of 7 and 15 nodes, panels halved until the pair agrees, begun on
 * N and on 1.618 N panels: a phase that one division samples alike does not survive the other (R. Piessens
 * et al., QUADPACK, 1983). y' = f(t, y): along a run with rtol 1e-8 and adaptive steps, by Gauss's
 * formulas of 3 and 4 nodes in every step.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lyapunov_thresholds.h"
#include "variation.h"
#include <math.h>

enum { PANELS = 64, DEPTH = 24 };

static const sunrealtype node[8] = {
  0.991455371120812639, 0.949107912342758525, 0.864864423359769073, 0.741531185599394440,
  0.586087235467691130, 0.405845151377397167, 0.207784955007898468, 0};
static const sunrealtype kronrod[8] = {
  0.022935322010529225, 0.063092092629978553, 0.104790010322250184, 0.140653259715525919,
  0.169004726639267903, 0.190350578064785410, 0.204432940075298892, 0.209482141084727828};
static const sunrealtype gauss[4] = {0.129484966168869693, 0.279705391489276668,
                                     0.381830050505118945, 0.417959183673469388};

typedef struct quadrature {
  stf_variation v;
  sunrealtype tolerance; /* of a panel, per unit of time */
  long asked, most;
} quadrature;

static int trace_at(quadrature *q, sunrealtype t, sunrealtype *value)
{
  STEIF_CHECK(!q->v.stop || !*q->v.stop, q->v.ctx, STEIF_STOPPED,
              "the mean trace was stopped from outside at t = %.12g", t);
  STEIF_TRY(stf_variation_matrix(&q->v, 0, t, q->v.y, NULL));
  *value = stf_jacobian_trace(q->v.J[0]);
  q->asked++;
  return STEIF_OK;
}

static int panel(quadrature *q, sunrealtype a, sunrealtype b, sunrealtype *value,
                 sunrealtype *off)
{
  const sunrealtype middle = (a + b) / 2, half = (b - a) / 2;
  sunrealtype coarse = 0, fine = 0;
  for (int i = 0; i < 15; i++) {
    const int k = i < 8 ? i : 14 - i;
    sunrealtype f = 0;
    STEIF_TRY(trace_at(q, middle + (i < 8 ? -half : half) * node[k], &f));
    fine += kronrod[k] * f;
    if (k % 2) coarse += gauss[k / 2] * f;
  }
  *value = half * fine;
  *off = half * fabs(fine - coarse);
  return STEIF_OK;
}

/* One of `panels`, halved as often as it takes: the left half first, the others wait. */
static int refined(quadrature *q, sunrealtype a, sunrealtype b, sunrealtype *sum)
{
  sunrealtype end[DEPTH + 1], value, off;
  int waiting = 0;
  end[0] = b;
  for (;;) {
    STEIF_TRY(panel(q, a, end[waiting], &value, &off));
    const bool good = off <= q->tolerance * (end[waiting] - a) * (1 + fabs(value / (b - a)));
    if (!good && waiting < DEPTH && q->asked < q->most) {
      end[waiting + 1] = (a + end[waiting]) / 2;
      waiting++;
      continue;
    }
    *sum += value;
    a = end[waiting];
    if (waiting-- == 0) return STEIF_OK;
  }
}

static int by_panels(quadrature *q, sunrealtype t0, sunrealtype t1, int panels,
                     sunrealtype *mean)
{
  const sunrealtype width = (t1 - t0) / panels;
  sunrealtype sum = 0;
  for (int i = 0; i < panels; i++)
    STEIF_TRY(refined(q, t0 + i * width, i + 1 < panels ? t0 + (i + 1) * width : t1, &sum));
  *mean = sum / (t1 - t0);
  return STEIF_OK;
}

static int of_linear(quadrature *q, sunrealtype t0, sunrealtype t1, stf_mean_trace *trace)
{
  sunrealtype other;
  STEIF_TRY(by_panels(q, t0, t1, PANELS, &trace->value));
  STEIF_TRY(by_panels(q, t0, t1, (int)lround(STF_GOLDEN * PANELS), &other));
  trace->error = fabs(trace->value - other);
  trace->known =
    q->asked < q->most && trace->error <= STF_TRACE_AGREES * (1 + fabs(trace->value));
  return STEIF_OK;
}

/* ---- along a run ---- */

typedef struct along {
  quadrature q;
  N_Vector y;
  sunrealtype from, t0, sum[2];
} along;

static int observe(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  static const sunrealtype x[7] = {0.112701665379258311, 0.5,
                                   0.887298334620741689, 0.0694318442029737124,
                                   0.330009478207571868, 0.669990521792428132,
                                   0.930568155797026288};
  static const sunrealtype w[7] = {5. / 18,
                                   8. / 18,
                                   5. / 18,
                                   0.173927422568726929,
                                   0.326072577431273071,
                                   0.326072577431273071,
                                   0.173927422568726929};
  along *r = user;
  (void)y;
  const sunrealtype a = fmax(r->from, r->t0);
  for (int i = 0; i < 7 && t > a; i++) {
    sunrealtype f;
    const sunrealtype at = a + x[i] * (t - a);
    if (steif_dense(s, at, r->y) || stf_variation_matrix(&r->q.v, 0, at, r->y, NULL)) return -1;
    f = stf_jacobian_trace(r->q.v.J[0]);
    r->sum[i > 2] += w[i] * (t - a) * f;
  }
  r->from = t;
  return 0;
}

static int of_run(stf_pool *pool, along *r, const steif_problem *p, sunrealtype t1,
                  stf_mean_trace *trace)
{
  steif_options o = {.rtol = STF_REFERENCE_RTOL,
                     .t1 = t1,
                     .observe = observe,
                     .observer = r,
                     .stop = r->q.v.stop};
  r->y = stf_pool_vector(pool, r->q.v.y);
  if (!r->y) return STEIF_NO_MEMORY;
  r->from = p->t0;
  steif_solver *s = steif_solver_new(r->q.v.ctx, p, "auto", &o);
  if (!s) return steif_status(r->q.v.ctx);
  const int code = steif_solve_to(s, t1);
  steif_solver_free(&s);
  if (code) return code;
  trace->value = r->sum[1] / (t1 - r->t0);
  trace->error = fabs(r->sum[1] - r->sum[0]) / (t1 - r->t0);
  trace->known = trace->error <= STF_TRACE_AGREES * (1 + fabs(trace->value));
  return STEIF_OK;
}

int stf_mean_trace_find(steif_context *ctx, const steif_problem *problem, sunrealtype t0,
                        sunrealtype t1, bool linear, const volatile int *stop,
                        stf_mean_trace *trace)
{
  enum { MOST = 4000000 };
  along r = {.t0 = t0};
  *trace = (stf_mean_trace){.value = NAN, .error = NAN};
  if (problem->E || problem->F) return STEIF_OK;
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  int code = stf_variation_open(pool, ctx, problem, "be", t1 - t0, t1, 1, 1, &r.q.v);
  r.q.v.stop = stop;
  r.q.tolerance = STF_TRACE_PANEL;
  r.q.most = problem->linear ? 0 : MOST;
  if (!code && problem->linear) {
    code = trace_at(&r.q, t0, &trace->value);
    trace->error = 0, trace->known = true;
  } else if (!code) {
    code = linear ? of_linear(&r.q, t0, t1, trace) : of_run(pool, &r, problem, t1, trace);
  }
  stf_pool_free(&pool);
  return code > 0 ? steif_status(ctx) : code;
}
