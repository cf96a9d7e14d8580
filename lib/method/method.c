/* method.c: find a family by spec, and what the families share.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "method.h"
#include "exponential.h"
#include "rodas.h"
#include "splitting.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const steif_method *family(const char *name)
{
  for (size_t i = 0; i < stf_method_count; i++)
    if (!strcmp(stf_method_shelf[i].name, name)) return stf_method_shelf[i].item;
  return NULL;
}

static const char *family_of(enum steif_table_kind kind)
{
  static const char *const names[] = {"erk", "dirk", "irk", "glm"};
  return names[kind];
}

/* What stands before the name of a table of this kind, NULL for nothing. */
static const char *prefix(enum steif_table_kind kind)
{
  return kind == STEIF_DIRK ? "dirk" : kind == STEIF_GLM ? "glm" : NULL;
}

static bool on_shelf(const char *name)
{
  for (size_t i = 0; i < stf_table_count; i++)
    if (!strcmp(stf_table_shelf[i].name, name)) return true;
  return false;
}

/* Methods that choose order and step themselves are run by the solver only. */
static int foreign(steif_context *ctx, const char *name)
{
  static const char *const names[] = {"auto", "cvode", "ida", "arkode"};
  for (int i = 0; i < 4; i++)
    STEIF_CHECK(strcmp(name, names[i]), ctx, STEIF_UNSUPPORTED,
                "'%s' chooses its %s: it has no one step on y' = lambda y; take a method of given "
                "order such as bdf:p=3",
                name, i ? "order and step" : "method");
  return STEIF_OK;
}

/* The names a method may begin with, for suggestions. */
static int unknown(steif_context *ctx, const steif_spec *spec)
{
  const char *names[64] = {"be", "bdf", "dirk", "glm", "cvode", "ida", "arkode"};
  size_t count = 7;
  for (size_t i = 0; i < stf_rodas_count; i++) names[count++] = stf_rodas_tables[i].name;
  for (size_t i = 0; i < stf_splitting_count; i++) names[count++] = stf_splittings[i].name;
  for (size_t i = 0; i < stf_exponential_rk_count; i++)
    names[count++] = stf_exponential_rk[i].name;
  for (size_t i = 0; i < stf_exponential_rb_count; i++)
    names[count++] = stf_exponential_rb[i].name;
  for (size_t i = 0; i < stf_table_count && count < 64; i++)
    if (!prefix(stf_table_shelf[i].item->kind)) names[count++] = stf_table_shelf[i].name;
  return STEIF_FAIL(ctx, STEIF_UNKNOWN_NAME,
                    "no method '%s'; did you mean '%s'? 'steif list "
                    "methods' shows all",
                    spec->name, stf_nearest(spec->name, names, count, sizeof *names));
}

/* dirk:TABLE, glm:TABLE,key=value and glm:file=PATH: the spec of the table. */
static int table_spec(steif_context *ctx, const steif_spec *spec, steif_spec *inner)
{
  const char *name = stf_spec_word(spec, "");
  *inner = *spec;
  if (!name && stf_spec_word(spec, "file")) return STEIF_OK;
  STEIF_CHECK(name, ctx, STEIF_BAD_INPUT, "'%s' needs the name of a table: %s", spec->name,
              *spec->name == 'd' ? "dirk:alexander2" : "glm:nord22, glm:ab,p=3, glm:file=PATH");
  STEIF_CHECK(strlen(name) < sizeof inner->name, ctx, STEIF_UNKNOWN_NAME,
              "no table is named '%s'", name);
  strcpy(inner->name, name);
  inner->count = 0;
  for (int i = 0; i < spec->count; i++)
    if (*spec->param[i].key) inner->param[inner->count++] = spec->param[i];
  return STEIF_OK;
}

static int named_table(steif_context *ctx, const steif_spec *spec, enum steif_table_kind kind,
                       steif_table **table)
{
  steif_spec inner;
  STEIF_TRY(table_spec(ctx, spec, &inner));
  *table = stf_table_build(ctx, &inner);
  if (!*table) return steif_status(ctx);
  if ((*table)->kind == kind) return STEIF_OK;
  const char *before = prefix((*table)->kind);
  steif_table_free(ctx, table);
  return STEIF_FAIL(ctx, STEIF_UNKNOWN_NAME, "table '%s' is %s: write '%s%s%s'", inner.name,
                    kind == STEIF_DIRK ? "not diagonally implicit" : "no general linear method",
                    before ? before : "", before ? ":" : "", inner.name);
}

int stf_method_find(steif_context *ctx, const steif_spec *spec, const steif_method **method,
                    steif_table **table)
{
  *table = NULL;
  if (!strcmp(spec->name, "be") || !strcmp(spec->name, "bdf")) {
    *method = family("bdf");
    return STEIF_OK;
  }
  for (size_t i = 0; i < stf_rodas_count; i++)
    if (!strcmp(spec->name, stf_rodas_tables[i].name)) {
      *method = family("rosenbrock");
      return STEIF_OK;
    }
  if (stf_splitting_find(spec->name)) {
    *method = family("sympl");
    return STEIF_OK;
  }
  const bool rk =
    stf_exponential_find(stf_exponential_rk, stf_exponential_rk_count, spec->name);
  if (rk ||
      stf_exponential_find(stf_exponential_rb, stf_exponential_rb_count, spec->name)) {
    *method = family(rk ? "etd" : "exprb");
    return STEIF_OK;
  }
  const bool dirk = !strcmp(spec->name, "dirk");
  if (dirk || !strcmp(spec->name, "glm")) {
    *method = family(spec->name);
    return named_table(ctx, spec, dirk ? STEIF_DIRK : STEIF_GLM, table);
  }
  STEIF_TRY(foreign(ctx, spec->name));
  if (!on_shelf(spec->name)) return unknown(ctx, spec);
  *table = stf_table_build(ctx, spec);
  if (!*table) return steif_status(ctx);
  *method = family(family_of((*table)->kind));
  const char *before = prefix((*table)->kind);
  if (!before) return STEIF_OK;
  steif_table_free(ctx, table);
  return STEIF_FAIL(ctx, STEIF_UNKNOWN_NAME, "write '%s:%s' for this table", before,
                    spec->name);
}

int steif_method_propagator(steif_context *ctx, const char *text, const sunrealtype z[2],
                            int *r, sunrealtype *M)
{
  steif_spec spec;
  const steif_method *method;
  steif_table *table;
  STEIF_TRY(steif_spec_parse(ctx, text, &spec));
  STEIF_TRY(stf_method_find(ctx, &spec, &method, &table));
  const int code = method->propagator(ctx, &spec, table, z, r, M);
  steif_table_free(ctx, &table);
  return code;
}

void stf_propagate_scalar(const sunrealtype R[2], int *r, sunrealtype *M)
{
  *r = 1;
  if (M) M[0] = R[0], M[1] = R[1];
}

int stf_refuse_factors(stf_step *s, int column, sunrealtype h)
{
  const sunrealtype *A = SM_DATA_D(s->system.A);
  const size_t n = (size_t)s->problem->n;
  for (size_t k = 0; k < n * n; k++)
    if (!isfinite(A[k]))
      return STEIF_RECOVER(s->ctx, STEIF_NOT_FINITE,
                           "entry (%zu, %zu) (from 0) of the Jacobian of problem '%s' is %g in the "
                           "step from t = %.12g: look at the function that fills it",
                           k % n, k / n, s->problem->name, A[k], s->t);
  return STEIF_RECOVER(s->ctx, STEIF_SINGULAR,
                       "the stage matrix of problem '%s' is singular in column %d (from 0) at "
                       "t = %.12g with h = %.6g: check that det(s E - A) is not identically zero",
                       s->problem->name, column, s->t, h);
}

void stf_swap(stf_step *s)
{
  N_Vector y = s->y;
  s->y = s->next, s->next = y;
}

/* By f(t), f(t + d) and f(t + 2 d). */
int stf_slope_in_time(stf_step *s, sunrealtype h, N_Vector f, N_Vector slope, N_Vector work)
{
  const sunrealtype d = fmax(1e-4 * h, 64 * STF_EPS * fabs(s->t));
  const sunrealtype c[] = {2 / d, -1.5 / d, -0.5 / d};
  N_Vector all[] = {slope, f, work};
  if (s->problem->autonomous) return STEIF_OK;
  STEIF_TRY(stf_system_rhs(&s->system, s->t + d, s->y, slope));
  STEIF_TRY(stf_system_rhs(&s->system, s->t + 2 * d, s->y, work));
  stf_combine(&s->system.space, 3, c, all, slope);
  return STEIF_OK;
}

int stf_hermite(const stf_step *s, sunrealtype t, N_Vector before, N_Vector slope, N_Vector end,
                N_Vector y)
{
  stf_step *mutable = (stf_step *)s;
  if (!s->ended) STEIF_TRY(stf_system_rhs(&mutable->system, s->t, s->y, end));
  mutable->ended = true;
  const sunrealtype x = (t - (s->t - s->h)) / s->h, u = 1 - x;
  const sunrealtype c[] = {u * u * (1 + 2 * x), x * x * (1 + 2 * u), s->h * x * u * u,
                           -s->h * x * x * u};
  N_Vector v[] = {before, s->y, slope, end};
  stf_combine(&s->system.space, 4, c, v, y);
  return STEIF_OK;
}

static void zero_stages(const stf_step *s, const stf_stages *g)
{
  for (int j = 0; j < s->newton.split.s; j++) stf_zero(&s->system.space, g->Z[j]);
}

int stf_solve_stages(stf_step *s, const stf_stages *g)
{
  stf_newton *newton = &s->newton;
  const bool renew = !newton->fresh && stf_newton_stale(newton);
  STEIF_TRY(stf_newton_prepare(newton, s->t, g->h, s->y, s->yp, renew));
  int code = stf_newton_solve(newton, g);
  if (code <= 0) return code;
  zero_stages(s, g);
  STEIF_TRY(stf_newton_prepare(newton, s->t, g->h, s->y, s->yp, !newton->fresh));
  code = stf_newton_solve(newton, g);
  if (code <= 0 || s->adaptive || s->system.linear) return code;
  zero_stages(s, g);
  return stf_newton_full(newton, g);
}

void stf_interpolate(int k, const sunrealtype *node, sunrealtype x, sunrealtype *value)
{
  for (int j = 0; j <= k; j++) {
    value[j] = 1;
    for (int m = 0; m <= k; m++)
      if (m != j) value[j] *= (x - node[m]) / (node[j] - node[m]);
  }
}

void stf_differentiate(int k, const sunrealtype *node, sunrealtype *a)
{
  a[0] = 0;
  for (int j = 1; j <= k; j++) {
    sunrealtype product = 1 / (node[j] - node[0]);
    for (int m = 1; m <= k; m++)
      if (m != j) product *= (node[0] - node[m]) / (node[j] - node[m]);
    a[j] = product;
    a[0] += 1 / (node[0] - node[j]);
  }
}
