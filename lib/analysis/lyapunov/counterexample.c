/* counterexample.c: x' = lambda(t) x that decays between the nodes of a method and grows at them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lyapunov_thresholds.h"
#include "region.h"
#include <complex.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/counterexample.h>
#include <steif/lyapunov.h>
#include <sunmatrix/sunmatrix_dense.h>

static const sunrealtype pi = 3.14159265358979323846;
enum { STEPS = 200 };

typedef struct aliased {
  int m;
  sunrealtype c[STEIF_STAGES], h, rate, E;
  /* q = sum_{|j| <= m} a_j exp(2 pi i j t / h), a_{-j} the conjugate */
  sunrealtype re[STEIF_STAGES + 1], im[STEIF_STAGES + 1];
} aliased;

/* Phases are taken of the fraction of a period: they stay exact after many. */
static sunrealtype fraction(const aliased *a, sunrealtype t)
{
  const sunrealtype turns = t / a->h;
  return turns - nearbyint(turns);
}

static sunrealtype lambda(const aliased *a, sunrealtype t)
{
  const sunrealtype u = fraction(a, t);
  sunrealtype q = 1;
  for (int i = 0; i < a->m; i++) {
    const sunrealtype s = sin(pi * (u - a->c[i]));
    q *= s * s;
  }
  return a->rate - a->E * q;
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  NV_Ith_S(ydot, 0) = lambda(user, t) * NV_Ith_S(y, 0);
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)y, (void)fy, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = lambda(user, t);
  return 0;
}

/* x = exp(rate t - E int q), int q = a_0 t + 2 Re sum_j a_j (e^{2 pi i j t/h} - 1) h/(2 pi i j). */
static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const aliased *a = user;
  const sunrealtype u = 2 * pi * fraction(a, t);
  sunrealtype wave = 0;
  for (int j = 1; j <= a->m; j++)
    wave += (a->re[j] * sin(j * u) + a->im[j] * (cos(j * u) - 1)) * a->h / (pi * j);
  NV_Ith_S(y, 0) = exp((a->rate - a->E * a->re[0]) * t - a->E * wave);
  return yp ? f(t, y, yp, user) : 0;
}

/* a_j of the product: each factor is 1/2 - (e^{i (theta - phi)} + its conjugate)/4. */
static void expand(aliased *a)
{
  double complex q[2 * STEIF_STAGES + 1] = {0}, next[2 * STEIF_STAGES + 1];
  const int zero = STEIF_STAGES;
  q[zero] = 1;
  for (int i = 0; i < a->m; i++) {
    const double complex turn = cexp(-2 * pi * I * a->c[i]);
    for (int j = -i - 1; j <= i + 1; j++) {
      const double complex up = j > -zero ? q[zero + j - 1] : 0,
                           down = j < zero ? q[zero + j + 1] : 0;
      next[zero + j] = q[zero + j] / 2 - (turn * up + conj(turn) * down) / 4;
    }
    for (int j = -i - 1; j <= i + 1; j++) q[zero + j] = next[zero + j];
  }
  for (int j = 0; j <= a->m; j++) {
    a->re[j] = creal(q[zero + j]);
    a->im[j] = cimag(q[zero + j]);
  }
}

/* Distinct, ascending, in [0, 1). */
static void collect(const steif_glm *g, aliased *a)
{
  a->m = 0;
  for (int i = 0; i < g->r; i++) {
    sunrealtype c = g->xi[i] - floor(g->xi[i]);
    if (c > 1 - STF_NODE_DISTANCE) c = 0;
    int at = 0;
    while (at < a->m && a->c[at] < c - STF_NODE_DISTANCE) at++;
    if (at < a->m && a->c[at] <= c + STF_NODE_DISTANCE) continue;
    for (int j = a->m++; j > at; j--) a->c[j] = a->c[j - 1];
    a->c[at] = c;
  }
}

void steif_counterexample_clear(steif_context *ctx, steif_problem *problem)
{
  if (!problem) return;
  stf_release(ctx, problem->user);
  *problem = (steif_problem){0};
}

static const sunrealtype one[] = {1};

static int design(steif_context *ctx, const steif_glm *g, sunrealtype h, sunrealtype rate,
                  steif_problem *problem)
{
  aliased *a = stf_allocate(ctx, 1, sizeof *a);
  if (!a) return STEIF_NO_MEMORY;
  a->h = h;
  a->rate = rate;
  collect(g, a);
  expand(a);
  a->E = 2 * rate / a->re[0];
  *problem = (steif_problem){.name = "counterexample",
                             .about = "decays, and grows at the nodes of one method",
                             .n = 1,
                             .t1 = STEPS * h,
                             .y0 = one,
                             .f = f,
                             .jac = jac,
                             .exact = exact,
                             .user = a};
  return STEIF_OK;
}

static int growth(steif_context *ctx, const steif_problem *p, const char *method, sunrealtype h,
                  sunrealtype *exponent)
{
  const steif_lyapunov_options o = {
    .h = h, .t1 = STEPS * h, .transient = STEPS / 2 * h, .count = 1, .linear = 1};
  return steif_lyapunov(ctx, p, method, &o, exponent, NULL, NULL);
}

/* One node at 0 and E = 4 rate make lambda = 2 rate cos(2 pi t/h) - rate. */
static int measure(steif_context *ctx, const char *method, const steif_problem *p,
                   steif_counterexample *out)
{
  const aliased *a = p->user;
  aliased cosine = {.m = 1, .h = a->h, .rate = a->rate, .E = 4 * a->rate};
  steif_problem paper = *p;
  paper.user = &cosine;
  *out = (steif_counterexample){.nodes = a->m, .mean = a->re[0], .E = a->E};
  for (int i = 0; i < a->m; i++) out->node[i] = a->c[i];
  const sunrealtype z[2] = {a->h * a->rate, 0};
  sunrealtype radius;
  STEIF_TRY(steif_spectral_radius(ctx, method, z, &radius));
  STEIF_CHECK(
    radius > 1, ctx, STEIF_UNSUPPORTED,
    "h rate = %g lies in the stability region of %s, where its numbers do not grow: take "
    "a smaller h or rate",
    z[0], method);
  out->constant = log(radius) / a->h;
  STEIF_TRY(growth(ctx, p, method, a->h, &out->exponent));
  return growth(ctx, &paper, method, a->h, &out->cosine);
}

int steif_counterexample_new(steif_context *ctx, const char *method, sunrealtype h,
                             sunrealtype rate, steif_problem *problem,
                             steif_counterexample *facts)
{
  STEIF_CHECK(method && problem, ctx, STEIF_BAD_INPUT,
              "a method and room for a problem are needed");
  STEIF_CHECK(h > 0 && isfinite(h) && rate > 0 && isfinite(rate), ctx, STEIF_BAD_INPUT,
              "h = %g and rate = %g must be positive and finite", h, rate);
  steif_counterexample unused;
  steif_glm *g = steif_glm_new(ctx, method);
  if (!g) return steif_status(ctx);
  int code = design(ctx, g, h, rate, problem);
  steif_glm_free(ctx, &g);
  if (code != STEIF_OK) return code;
  code = measure(ctx, method, problem, facts ? facts : &unused);
  if (code != STEIF_OK) steif_counterexample_clear(ctx, problem);
  return code;
}

/* ---- the method beside the exact solution ---- */

typedef struct rows {
  long room, count;
  sunrealtype *t, *x;
} rows;

static int keep(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  rows *r = user;
  (void)s;
  if (r->count == r->room) return 0; /* rounding has left a last short step */
  r->t[r->count] = t;
  r->x[r->count] = fabs(NV_Ith_S(y, 0));
  r->count++;
  return 0;
}

int steif_counterexample_run(steif_context *ctx, const steif_problem *problem,
                             const char *method, sunrealtype h, long steps, sunrealtype *t,
                             sunrealtype *x, sunrealtype *solution, long *made)
{
  STEIF_CHECK(problem && problem->exact && method && h > 0 && steps > 0, ctx, STEIF_BAD_INPUT,
              "a counterexample, a method, a step and a number of steps are needed");
  STEIF_CHECK(t && x && solution && made, ctx, STEIF_BAD_INPUT, "room for the rows is needed");
  rows r = {.room = steps, .t = t, .x = x};
  steif_options o = steif_defaults();
  o.h = h;
  o.t1 = h * (sunrealtype)steps;
  o.start = "exact";
  o.observe = keep;
  o.observer = &r;
  steif_solver *s = steif_solver_new(ctx, problem, method, &o);
  int code = s ? steif_solve_to(s, o.t1) : steif_status(ctx);
  *made = r.count;
  for (long i = 0; i < r.count && code == STEIF_OK; i++) {
    code = problem->exact(t[i], steif_solution(s), NULL, problem->user);
    solution[i] = NV_Ith_S(steif_solution(s), 0);
  }
  steif_solver_free(&s);
  return code;
}
