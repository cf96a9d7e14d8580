/* bdf_fixed.c: backward differentiation formulas of order 1 to 6 with given steps (be: order 1); bdf_adaptive.c
 * has them with chosen steps.
 *
 *   y'(t_{n+1}) = (1/h) sum_{j=0}^k alpha_j y_{n+1-j}, the slope of the polynomial through the k + 1
 *   points, alpha from Lagrange's basis; with equal steps the classical coefficients.
 * Starting procedures:
 *   ramp      orders 1, 2, ..., p in the first steps
 *   constant  y_i = y_0 for i <= 0 (past steps as long as the first)
 *   exact     y_1 .. y_{p-1} from the exact solution of the problem
 *   cq        zero history, impulse source E x_0 / h and forcing with Gregory's weights at i = 0, so
 *             the value at t0 is solved for: convolution quadrature of Lubich (Numer. Math. 52, 1988)
 *             for K(s) = (s E + F)^{-1}; descriptor form and equal steps only
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "carry.h"
#include "method.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { HIGHEST = 6 };
enum start { RAMP, CONSTANT, EXACT, CQ };

typedef struct state {
  int p, k; /* order wanted; order of the trial */
  enum start start;
  int points;              /* valid entries of y and t */
  N_Vector y[HIGHEST + 2]; /* y[0] is the accepted solution, y[1] the one before ... */
  sunrealtype t[HIGHEST + 2];
  sunrealtype alpha[HIGHEST + 1], guess[HIGHEST + 1];
  int cached; /* alpha and guess are those of this order and equal steps */
  int guess_points;
  int last; /* order of the last accepted step, for dense output */
  N_Vector base, offset, Z;
} state;

static int parameters(steif_context *ctx, const steif_spec *spec, int *p, const char **start)
{
  static const char *const bdf_keys[] = {"p", "start", NULL}, *const be_keys[] = {"start",
                                                                                  NULL};
  const bool be = !strcmp(spec->name, "be");
  STEIF_TRY(stf_spec_only(ctx, spec, be ? be_keys : bdf_keys));
  STEIF_TRY(stf_spec_int(ctx, spec, "p", 1, HIGHEST, be ? 1 : 2, p));
  *start = stf_spec_word(spec, "start");
  return STEIF_OK;
}

static int find_start(steif_context *ctx, const char *word, enum start *start)
{
  static const char *const names[] = {"ramp", "constant", "exact", "cq"};
  *start = RAMP;
  if (!word) return STEIF_OK;
  for (int i = 0; i < 4; i++)
    if (!strcmp(word, names[i])) {
      *start = (enum start)i;
      return STEIF_OK;
    }
  return STEIF_FAIL(ctx, STEIF_UNKNOWN_NAME,
                    "no starting procedure '%s': there are ramp, constant, "
                    "exact and cq",
                    word);
}

/* Gregory's weights w_0, w_1, ... of order p (then 1): 1 + gamma_i with sum gamma_i i^m = -zeta(-m),
 * and w_0 = gamma_0. */
static sunrealtype gregory(int p, long i)
{
  static const sunrealtype w[HIGHEST + 1][5] = {
    {1, 1, 1, 1, 1},
    {0, 1, 1, 1, 1},
    {1. / 2, 1, 1, 1, 1},
    {5. / 12, 13. / 12, 1, 1, 1},
    {3. / 8, 7. / 6, 23. / 24, 1, 1},
    {251. / 720, 299. / 240, 211. / 240, 739. / 720, 1},
    {95. / 288, 317. / 240, 23. / 30, 793. / 720, 157. / 160},
  };
  return i < 5 ? w[p][i] : 1;
}

/* Past values at equal distances h before t. */
static void past(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  for (int j = 1; j <= e->p; j++) e->t[j] = s->t0 - j * h;
  e->points = e->p + 1;
}

static void coefficients(stf_step *s, sunrealtype h, int k)
{
  state *e = s->state;
  const int points = e->points < k + 1 ? e->points : k + 1;
  if (s->h_equal > 0 && e->cached == k && e->guess_points == points) return;
  sunrealtype node[HIGHEST + 2] = {0};
  for (int j = 1; j <= k + 1; j++)
    node[j] = s->h_equal > 0 ? -j : (e->t[j - 1] - (s->t + h)) / h;
  stf_differentiate(k, node, e->alpha);
  stf_interpolate(points - 1, node + 1, 0, e->guess);
  e->cached = k, e->guess_points = points;
}

static int solve(stf_step *s, sunrealtype h)
{
  static const sunrealtype c[] = {1};
  state *e = s->state;
  const stf_space *space = &s->system.space;
  sunrealtype a[HIGHEST + 1];
  for (int j = 1; j <= e->k; j++) a[j - 1] = e->alpha[j] / h;
  stf_newton_single(&s->newton, e->alpha[0]);
  N_Vector base = s->system.linear ? e->y[0] : e->base;
  if (s->system.linear && !s->absolute) a[0] += e->alpha[0] / h;
  stf_combine(space, e->k, a, e->y, e->offset);
  if (!s->system.linear) {
    stf_combine(space, e->guess_points, e->guess, e->y, e->base); /* extrapolated */
    stf_axpy(space, e->alpha[0] / h, e->base, e->offset);
    stf_zero(space, e->Z);
  }
  const stf_stages g = {.t = s->t,
                        .h = h,
                        .c = c,
                        .base = s->absolute ? NULL : &base,
                        .offset = &e->offset,
                        .Z = s->absolute ? &s->next : &e->Z};
  STEIF_TRY(stf_solve_stages(s, &g));
  if (!s->absolute) stf_sum(space, 1, base, 1, e->Z, s->next);
  return STEIF_OK;
}

static int from_exact(stf_step *s, sunrealtype h)
{
  const int returned = s->problem->exact(s->t + h, s->next, NULL, s->problem->user);
  STEIF_CHECK(returned == 0, s->ctx, STEIF_CALLBACK,
              "the exact solution of problem '%s' is not known at t = %.12g", s->problem->name,
              s->t + h);
  return STEIF_OK;
}

/* Behind an event: orders 1, 2, ..., p once more. */
static int begin_anew(stf_step *s)
{
  state *e = s->state;
  STEIF_CHECK(
    e->start != CQ, s->ctx, STEIF_UNSUPPORTED,
    "start=cq of problem '%s' cannot restart after an event, at t = %.12g: its weights "
    "are those of one start",
    s->problem->name, s->t);
  e->points = 1, e->t[0] = s->t, e->start = RAMP;
  return STEIF_OK;
}

static int attempt(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  if (s->restart) STEIF_TRY(begin_anew(s));
  if (s->count == 0 && e->start == CONSTANT) past(s, h);
  if (e->start == EXACT && s->count < e->p - 1) {
    e->k = (int)s->count + 1;
    return from_exact(s, h);
  }
  e->k = e->points < e->p ? e->points : e->p;
  if (e->start == CQ) s->system.weight = gregory(e->p, s->count + 1);
  coefficients(s, h, e->k);
  return solve(s, h);
}

static void commit(stf_step *s)
{
  state *e = s->state;
  N_Vector oldest = e->y[e->p + 1];
  for (int j = e->p + 1; j > 0; j--) e->y[j] = e->y[j - 1], e->t[j] = e->t[j - 1];
  e->y[0] = s->y = s->next;
  e->t[0] = s->t + s->h_try;
  s->next = oldest;
  if (e->points <= e->p && !s->restart) e->points++; /* the rest of a step is no neighbour */
  e->last = e->k;
  if (s->system.form == STEIF_IMPLICIT) stf_copy(&s->system.space, s->newton.Zp[0], s->yp);
}

static int dense(const stf_step *s, sunrealtype t, N_Vector y)
{
  const state *e = s->state;
  sunrealtype value[HIGHEST + 2];
  stf_interpolate(e->last, e->t, t, value);
  stf_combine(&s->system.space, e->last + 1, value, e->y, y);
  return STEIF_OK;
}

/* The value at t0: (alpha_0/h E - A) x_0 = w_0 g(t0) + E x(0-)/h. */
static int open_cq(stf_step *s)
{
  static const sunrealtype c[] = {0};
  state *e = s->state;
  const sunrealtype h = s->h_equal;
  STEIF_CHECK(
    s->system.form == STEIF_DESCRIPTOR && h > 0, s->ctx, STEIF_UNSUPPORTED,
    "start=cq is for E x' = A x + g(t) with a constant step size; problem '%s' has form %s%s",
    s->problem->name, steif_form_name(s->system.form), h > 0 ? "" : " and no h");
  e->k = e->p;
  past(s, h);
  coefficients(s, h, e->p);
  stf_newton_single(&s->newton, e->alpha[0]);
  stf_scale(&s->system.space, -1 / h, s->y, e->offset);
  s->system.weight = gregory(e->p, 0);
  const stf_stages g = {.t = s->t, .h = h, .c = c, .offset = &e->offset, .Z = &e->Z};
  const int code = stf_solve_stages(s, &g);
  if (code) return code > 0 ? steif_status(s->ctx) : code;
  stf_copy(&s->system.space, e->Z, s->y);
  return STEIF_OK;
}

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  (void)table;
  state *e = s->state;
  stf_transform transform;
  const char *word;
  STEIF_TRY(parameters(s->ctx, spec, &e->p, &word));
  STEIF_TRY(find_start(s->ctx, s->options->start ? s->options->start : word, &e->start));
  STEIF_CHECK(e->start != EXACT || s->problem->exact, s->ctx, STEIF_UNSUPPORTED,
              "start=exact needs a closed solution, problem '%s' has none", s->problem->name);
  s->rest = STF_REST_ACROSS;
  STEIF_TRY(stf_transform_single(s->pool, 1, &transform));
  STEIF_TRY(stf_newton_open(s->pool, &s->system, &transform, s->weights, &s->newton));
  e->base = stf_pool_vector(s->pool, s->y);
  e->offset = stf_pool_vector(s->pool, s->y);
  e->Z = stf_pool_vector(s->pool, s->y);
  if (!e->base || !e->offset || !e->Z) return STEIF_NO_MEMORY;
  e->y[0] = s->y, e->t[0] = s->t, e->points = 1;
  for (int j = 1; j <= e->p + 1; j++) {
    if (!(e->y[j] = stf_pool_vector(s->pool, s->y))) return STEIF_NO_MEMORY;
    if (e->start == CONSTANT) stf_copy(&s->system.space, s->y, e->y[j]);
  }
  return e->start == CQ ? open_cq(s) : STEIF_OK;
}

static void keep(stf_step *s, stf_image *m)
{
  state *e = s->state;
  stf_keep_vectors(m, e->p + 1, e->y + 1); /* e->y[0] is s->y */
  STF_KEEP(m, e->t);
  STF_KEEP(m, e->k);
  STF_KEEP(m, e->start);
  STF_KEEP(m, e->points);
  STF_KEEP(m, e->alpha);
  STF_KEEP(m, e->guess);
  STF_KEEP(m, e->cached);
  STF_KEEP(m, e->guess_points);
  STF_KEEP(m, e->last);
}

static stf_carrier_size sizes(const stf_step *s)
{
  const state *e = s->state;
  return (stf_carrier_size){1, 1, e->p + 2, 1, 0};
}

static int check_carry(const stf_step *s)
{
  const state *e = s->state;
  STEIF_CHECK(e->start == RAMP, s->ctx, STEIF_UNSUPPORTED,
              "sensitivities of BDF are carried from start=ramp only");
  return STEIF_OK;
}

static int carry(stf_carry *T, sunrealtype h)
{
  state *e = T->step->state;
  const sunrealtype same = 1;
  return stf_carry_bdf(T, 0, T->step->t, h, e->k, e->alpha, e->y, T->step->next, 1, &same);
}

static int carried_dense(stf_carry *T, int k, sunrealtype t, N_Vector S)
{
  const state *e = T->step->state;
  sunrealtype value[HIGHEST + 2];
  stf_interpolate(e->last, e->t, t, value);
  stf_combine(&T->step->system.space, e->last + 1, value, T->kept[k], S);
  return STEIF_OK;
}

static const stf_carrier carrier = {.check = check_carry,
                                    .size = sizes,
                                    .carry = carry,
                                    .apply = stf_newton_carry_apply,
                                    .renew = stf_newton_carry_renew,
                                    .commit = stf_carry_bdf_commit,
                                    .dense = carried_dense};

static int trace(const stf_step *s, stf_trace *out)
{
  state *e = s->state;
  *out = (stf_trace){
    .kind = STF_TRACE_BDF, .order = e->last, .alpha = e->alpha, .past = e->y, .t = e->t};
  return check_carry(s);
}

static int propagator(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                      const sunrealtype z[2], int *r, sunrealtype *M)
{
  (void)table;
  const char *word;
  sunrealtype node[HIGHEST + 1], alpha[HIGHEST + 1];
  int p;
  STEIF_TRY(parameters(ctx, spec, &p, &word));
  *r = p;
  if (!M) return STEIF_OK;
  for (int j = 0; j <= p; j++) node[j] = -j;
  stf_differentiate(p, node, alpha);
  memset(M, 0, (size_t)(2 * p * p) * sizeof *M);
  const sunrealtype re = alpha[0] - z[0], im = -z[1], size = re * re + im * im;
  STEIF_CHECK(size > 0, ctx, STEIF_SINGULAR, "z = %.17g is the pole of '%s'", z[0], spec->name);
  for (int j = 0; j < p; j++) {
    M[2 * j] = isfinite(size) ? -alpha[j + 1] * re / size : 0;
    M[2 * j + 1] = isfinite(size) ? alpha[j + 1] * im / size : 0;
    if (j) M[2 * (j * p + j - 1)] = 1;
  }
  return STEIF_OK;
}

static int describe(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                    steif_method_info *info)
{
  (void)table;
  const char *word;
  enum start start;
  STEIF_TRY(parameters(ctx, spec, &info->order, &word));
  STEIF_TRY(find_start(ctx, word, &start));
  info->family = "bdf", info->stages = 1, info->adaptive = 1;
  info->about = "backward differentiation formula (Gear 1971; Hairer and Wanner II, V.1)";
  info->claims = info->order <= 2 ? STEIF_A_STABLE | STEIF_L_STABLE : 0;
  return STEIF_OK;
}

static bool owns(const char *name) { return !strcmp(name, "be") || !strcmp(name, "bdf"); }

static stf_example example(size_t i)
{
  static const char *const spec[] = {"be",      "bdf:p=2", "bdf:p=3",
                                     "bdf:p=4", "bdf:p=5", "bdf:p=6"};
  return (stf_example){i < sizeof spec / sizeof *spec ? spec[i] : NULL, 0};
}

static const steif_method *variant(const stf_step *s)
{
  return s->adaptive ? &steif_method_bdf_adaptive : NULL;
}

/* The table bdf:p=. */
static int general(steif_context *ctx, const steif_spec *spec, steif_glm *g)
{
  const char *word;
  char text[STEIF_SPEC_WORD];
  int p;
  STEIF_TRY(parameters(ctx, spec, &p, &word));
  snprintf(text, sizeof text, "bdf:p=%d", p);
  steif_table *table = steif_table_new(ctx, text);
  if (!table) return steif_status(ctx);
  const int code = steif_table_glm(ctx, table, g);
  steif_table_free(ctx, &table);
  return code;
}

const steif_method steif_method_bdf_fixed = {
  .about = "backward differentiation formulas",
  .forms = STEIF_ODE | STEIF_MASS | STEIF_IMPLICIT | STEIF_DESCRIPTOR,
  .traits = STF_MULTISTEP,
  .owns = owns,
  .example = example,
  .variant = variant,
  .size = sizeof(state),
  .open = open,
  .attempt = attempt,
  .commit = commit,
  .dense = dense,
  .keep = keep,
  .propagator = propagator,
  .describe = describe,
  .general = general,
  .carrier = &carrier,
  .trace = trace,
};
