/* variation_open.c: preparing the variational equation: checks, room, is the problem linear.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lyapunov_thresholds.h"
#include "region.h"
#include "variation.h"
#include <steif/index.h>
#include <limits.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>

static int suits(steif_context *ctx, const steif_problem *p)
{
  const int form = steif_problem_form(ctx, p);
  STEIF_CHECK(p->F ? p->idajac != NULL : p->jac != NULL, ctx, STEIF_UNSUPPORTED,
              "problem '%s' has no Jacobian: the variational equation needs .%s", p->name,
              p->F ? "idajac" : "jac");
  STEIF_CHECK(p->y0 && p->storage != STEIF_KRYLOV, ctx, STEIF_UNSUPPORTED,
              "problem '%s' needs .y0 and a storage with a matrix", p->name);
  const bool ode = form == STEIF_ODE;
  STEIF_CHECK(
    (p->storage != STEIF_DENSE && ode) || p->n <= STF_DENSE_MOST, ctx, STEIF_UNSUPPORTED,
    "problem '%s' with n = %lld has a dense Jacobian or a leading matrix: exponents are "
    "found up to n = %d, beyond of odes with a band or sparse Jacobian",
    p->name, (long long)p->n, STF_DENSE_MOST);
  STEIF_CHECK(p->n <= INT_MAX / STEIF_STAGES, ctx, STEIF_UNSUPPORTED,
              "problem '%s' with n = %lld is too large", p->name, (long long)p->n);
  return STEIF_OK;
}

static void destroy_vector(void *y) { N_VDestroy(y); }

static void destroy_solver(void *s)
{
  steif_solver *solver = s;
  steif_solver_free(&solver);
}

static int open_vectors(stf_pool *pool, stf_variation *v)
{
  const steif_problem *p = v->problem;
  SUNContext sun = steif_sundials(v->ctx);
  v->y = N_VNew_Serial(p->n, sun);
  STEIF_CHECK(v->y, v->ctx, STEIF_NO_MEMORY, "no memory for a vector of %d", v->d);
  STEIF_TRY(stf_pool_adopt(pool, v->y, destroy_vector));
  memcpy(N_VGetArrayPointer(v->y), p->y0, (size_t)p->n * sizeof *p->y0);
  N_Vector *more = stf_pool_vectors(pool, 6, v->y);
  v->f = stf_pool_vectors(pool, v->g->r, v->y);
  if (!more || !v->f) return STEIF_NO_MEMORY;
  v->fy = more[0];
  v->stage = more[1];
  v->yp = more[5];
  for (int i = 0; i < 3; i++) v->slope[i] = more[2 + i];
  return STEIF_OK;
}

static SUNMatrix matrix(stf_pool *pool, const stf_variation *v, sunindextype entries)
{
  const steif_problem *p = v->problem;
  const sunindextype stated = p->pattern ? p->pattern->column[p->n] : 1;
  return stf_jacobian_new(pool, v->ctx, p->storage, p->n, p->lower, p->upper,
                          entries > stated ? entries : stated);
}

static int open_matrices(stf_pool *pool, stf_variation *v)
{
  const size_t r = (size_t)v->g->r, count = r > 2 ? r : 2;
  v->J = stf_pool_array(pool, count, sizeof *v->J);
  if (!v->J) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < count; i++)
    if (!(v->J[i] = matrix(pool, v, v->problem->nnz))) return STEIF_NO_MEMORY;
  return STEIF_OK;
}

static int open_blocks(stf_pool *pool, stf_variation *v)
{
  const steif_glm *g = v->g;
  const size_t d = (size_t)v->d, m = (size_t)v->m, k = (size_t)g->k, r = (size_t)g->r;
  v->X = stf_pool_array(pool, k * d * m, sizeof *v->X);
  v->next = stf_pool_array(pool, k * d * m, sizeof *v->X);
  v->K = stf_pool_array(pool, r * d * m, sizeof *v->X);
  v->base = stf_pool_array(pool, d * m, sizeof *v->X);
  return v->X && v->next && v->K && v->base ? STEIF_OK : STEIF_NO_MEMORY;
}

/* Of a DAE whose index is above 1, or not stated: the start values that can be prescribed. */
static int degrees_of_freedom(stf_variation *v)
{
  const steif_problem *p = v->problem;
  v->index = v->finite < v->d ? 1 : 0;
  if (v->finite == v->d || p->dae_index == 1) return STEIF_OK;
  steif_diagnosis found = {0};
  const int code = steif_diagnose(v->ctx, p, &(steif_point){0}, &found);
  const bool none = !code && found.verdict == STEIF_REGULAR && found.freedom == 0;
  const bool known = !code && found.verdict == STEIF_REGULAR && found.freedom > 0;
  if (known) v->finite = (int)found.freedom, v->index = found.index;
  steif_diagnosis_clear(&found);
  STEIF_CHECK(
    !none, v->ctx, STEIF_BAD_INPUT,
    "'%s' has no degree of freedom, so no exponents: its solution is what the forcing "
    "says",
    p->name);
  STEIF_CHECK(
    known, v->ctx, code ? code : STEIF_NOT_CERTIFIED,
    "how many degrees of freedom '%s' has is not known%s%s: an equivalent problem of index "
    "1 has as many exponents as the rank of its leading matrix",
    p->name, code ? "; " : "", code ? steif_message(v->ctx) : "");
  return STEIF_OK;
}

/* Algebraic components of X are as consistent as a step leaves them, since rho(M(inf)) = 0. */
static int open_algebraic(stf_pool *pool, stf_variation *v)
{
  const steif_problem *p = v->problem;
  const sunrealtype far[2] = {INFINITY, 0};
  sunrealtype left = NAN;
  v->finite = v->d;
  if (!p->F && !p->E) return STEIF_OK;
  v->E = matrix(pool, v, p->F ? p->nnz : p->nnz_E);
  if (!v->E) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_variation_leading(v));
  bool implicit = true;
  for (int i = 0; i < v->g->r; i++) implicit = implicit && v->g->C[i * v->g->r + i] != 0;
  STEIF_TRY(steif_spectral_radius(v->ctx, v->method, far, &left));
  STEIF_CHECK(implicit || v->finite == v->d, v->ctx, STEIF_UNSUPPORTED,
              "%s has explicit stages, which a singular E such as that of '%s' does not allow: "
              "take bdf or a Radau IIA or SDIRK method",
              v->method, p->name);
  STEIF_CHECK(
    left < STF_FORGETS || v->finite == v->d, v->ctx, STEIF_UNSUPPORTED,
    "%s keeps |M(inf)| = %g of what is wrong in algebraic components such as those of "
    "'%s': take bdf or a Radau IIA or SDIRK method",
    v->method, left, p->name);
  return degrees_of_freedom(v);
}

/* As many columns as exponents are asked for; 0: as there are. */
static int open_columns(stf_variation *v)
{
  if (v->m == 0) v->m = v->finite;
  STEIF_CHECK(v->m >= 1 && v->m <= v->d, v->ctx, STEIF_BAD_INPUT,
              "%d exponents were asked for: '%s' has 1 to %d", v->m, v->problem->name, v->d);
  STEIF_CHECK(v->m <= v->finite, v->ctx, STEIF_BAD_INPUT,
              "%d exponents were asked for: '%s' has index %d with %d degrees of freedom: %d "
              "exponents",
              v->m, v->problem->name, v->index, v->finite, v->finite);
  STEIF_CHECK(v->m <= STF_DENSE_MOST, v->ctx, STEIF_UNSUPPORTED,
              "%d exponents of '%s' are too many at once: ask for up to %d", v->m,
              v->problem->name, STF_DENSE_MOST);
  return STEIF_OK;
}

void stf_variation_scatter(stf_variation *v)
{
  const steif_glm *g = v->g;
  const size_t size = (size_t)v->d * (size_t)v->m;
  unsigned long long seed = 4711; /* S. K. Park and K. W. Miller, Comm. ACM 31 (1988) */
  for (int j = 0; j < v->m; j++)
    for (int a = 0; a < v->d; a++) {
      seed = seed * 48271 % 2147483647;
      const sunrealtype x = 2 * (sunrealtype)seed / 2147483647 - 1;
      for (int i = 0; i < g->k; i++)
        v->X[(size_t)i * size + (size_t)a * (size_t)v->m + (size_t)j] =
          g->W[i * (g->order + 1)] * x;
    }
}

/* J at y0 and at y0 + (1 + |y0|) times two irrational directions is the same, entry by entry.
 * */
static int probe(stf_variation *v)
{
  const sunrealtype t = v->t;
  STEIF_TRY(stf_variation_matrix(v, 0, t, v->y, NULL));
  v->linear = true;
  for (int k = 1; k <= 2 && v->linear; k++) {
    sunrealtype *y = N_VGetArrayPointer(v->stage);
    for (int i = 0; i < v->d; i++) {
      const sunrealtype y0 = v->problem->y0[i];
      y[i] = y0 + (1 + fabs(y0)) * 0.1 * sin(k + sqrt(2 + (sunrealtype)i));
    }
    STEIF_TRY(stf_variation_matrix(v, 1, t, v->stage, NULL));
    v->linear = stf_jacobian_same(v->J[0], v->J[1]);
  }
  return STEIF_OK;
}

static int open_trajectory(stf_pool *pool, stf_variation *v, sunrealtype t1)
{
  if (v->linear || (v->shape == STEIF_EXPLICIT && v->g->k == 1)) return STEIF_OK;
  steif_options o = steif_defaults();
  o.h = v->h;
  o.t1 = t1;
  o.max_steps = 1L << 50;
  v->solver = steif_solver_new(v->ctx, v->problem, v->method, &o);
  if (!v->solver) return steif_status(v->ctx);
  return stf_pool_adopt(pool, v->solver, destroy_solver);
}

typedef struct owned {
  steif_context *ctx;
  steif_glm *g;
} owned;

static void destroy_method(void *owner)
{
  owned *o = owner;
  steif_glm_free(o->ctx, &o->g);
}

static int open_method(stf_pool *pool, stf_variation *v)
{
  owned *o = stf_pool_array(pool, 1, sizeof *o);
  if (!o) return STEIF_NO_MEMORY;
  o->ctx = v->ctx;
  o->g = v->g = steif_glm_new(v->ctx, v->method);
  if (!v->g) return steif_status(v->ctx);
  STEIF_TRY(stf_pool_adopt(pool, o, destroy_method));
  const steif_glm *g = v->g;
  v->shape = stf_glm_shape(g);
  for (int l = 0; l < g->r; l++)
    for (int j = 0; j < g->k; j++) v->weight[l] += g->ell[j] * g->D[j * g->r + l];
  return stf_glm_solution(v->ctx, g, v->finish);
}

int stf_variation_open(stf_pool *pool, steif_context *ctx, const steif_problem *problem,
                       const char *method, sunrealtype h, sunrealtype t1, int m, int linear,
                       stf_variation *v)
{
  STEIF_CHECK(problem && method, ctx, STEIF_BAD_INPUT, "a problem and a method are needed");
  const int form = steif_problem_form(ctx, problem);
  if (!form) return steif_status(ctx);
  STEIF_CHECK(form != STEIF_DESCRIPTOR || problem->A, ctx, STEIF_UNSUPPORTED,
              "problem '%s' has products instead of matrices", problem->name);
  if (form == STEIF_DESCRIPTOR) STEIF_TRY(stf_mass_form(pool, ctx, problem, &problem));
  *v = (stf_variation){.ctx = ctx, .problem = problem, .method = method, .h = h, .m = m};
  STEIF_TRY(suits(ctx, problem));
  STEIF_TRY(open_method(pool, v));
  v->d = (int)problem->n;
  v->t = v->t0 = problem->t0;
  STEIF_TRY(open_vectors(pool, v));
  STEIF_TRY(open_matrices(pool, v));
  STEIF_TRY(open_algebraic(pool, v));
  STEIF_TRY(open_columns(v));
  m = v->m;
  STEIF_TRY(open_blocks(pool, v));
  STEIF_TRY(stf_stage_system_open(pool, v));
  STEIF_TRY(stf_algebra_open(pool, v->system.order, v->d, m, &v->algebra));
  v->linear = linear > 0 || problem->linear;
  if (linear == 0 && !v->linear) STEIF_TRY(probe(v));
  for (int j = 0; j < v->g->k; j++)
    for (int i = 0; i < m; i++)
      v->X[((size_t)j * (size_t)v->d + (size_t)i) * (size_t)m + (size_t)i] =
        v->g->W[j * (v->g->order + 1)]; /* u */
  return open_trajectory(pool, v, t1);
}
