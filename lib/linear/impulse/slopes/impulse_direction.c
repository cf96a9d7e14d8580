/* impulse_direction.c: how a problem of the descriptor form depends on one of its parameters.
 *
 * Derivatives of entries that dF/dp does not tell, and of the forcing, are differences over steps of p of 2^-7,
 * 2^-8 and 2^-9, extrapolated (Romberg) to about 1e-12, and rounded to 38 bits: entries that depend on p in
 * the same way, as the four of a conductance, have the same derivative then, so that what cancels in E and F
 * cancels in them.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "doubled.h"
#include "problem.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

#define WIDEST 0x1p-7
#define ASIDE 0.0172360679
enum { LEVELS = 3, BITS = 38, BY_VECTORS = 2000 };

/* What a direction owns: the user of its forcing. */
typedef struct dependence {
  steif_context *ctx;
  const steif_problem *problem;
  steif_problem named; /* the problem, where it has no name */
  int k;
  sunrealtype size; /* of p */
  N_Vector other, zero, unit;
  sunrealtype *x0;
} dependence;

static sunrealtype value_of(const dependence *d) { return d->problem->parameters->value[d->k]; }

static int move(const dependence *d, sunrealtype to)
{
  const steif_parameters *q = d->problem->parameters;
  q->value[d->k] = to;
  return q->moved ? q->moved(d->problem->user) : 0;
}

static sunrealtype rounded(sunrealtype x)
{
  int e;
  const sunrealtype part = frexp(x, &e);
  return ldexp(rint(ldexp(part, BITS)), e - BITS);
}

/* ---- extrapolated differences ----------------------------------------------------------------- */

/* Column m of Romberg's table: the factor of level i in the value for step 0. */
static sunrealtype romberg(int level)
{
  static const sunrealtype factor[LEVELS] = {1.0 / 45, -20.0 / 45, 64.0 / 45};
  return factor[level];
}

static int forcing(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const dependence *d = user;
  const sunrealtype p = value_of(d);
  int code = 0;
  N_VConst(0, g);
  for (int level = 0; level < LEVELS && !code; level++)
    for (int side = -1; side <= 1 && !code; side += 2) {
      const sunrealtype h = ldexp(WIDEST * d->size, -level);
      code = move(d, p + side * h);
      if (!code) code = d->problem->g(t, derivative, d->other, d->problem->user);
      N_VLinearSum(1, g, side * romberg(level) / (2 * h), d->other, g);
    }
  return move(d, p) ? -1 : code;
}

/* The matrices at p + h. */
static int matrices(const dependence *d, sunrealtype h, steif_linear *l)
{
  const sunrealtype p = value_of(d);
  *l = (steif_linear){0};
  int code = move(d, p + h);
  code = code
           ? STEIF_FAIL(d->ctx, STEIF_CALLBACK,
                        "parameter %d of problem '%s' cannot be moved to %g: parameters.moved "
                        "returned %d",
                        d->k + 1, d->problem->name, p + h, code)
           : steif_linear_of(d->ctx, d->problem, l);
  return move(d, p) && !code ? STEIF_FAIL(d->ctx, STEIF_CALLBACK,
                                          "parameter %d of problem '%s' cannot be put back",
                                          d->k + 1, d->problem->name)
                             : code;
}

static void destroy(SUNMatrix *M)
{
  if (*M) SUNMatDestroy(*M);
  *M = NULL;
}

/* *sum += by M, from 0 where it is NULL: what does not depend on p then cancels exactly. */
static int gather(steif_context *ctx, SUNMatrix *sum, SUNMatrix M, sunrealtype by)
{
  if (!*sum) *sum = stf_moved_matrix(ctx, M, M, -1);
  SUNMatrix next = *sum ? stf_moved_matrix(ctx, *sum, M, by) : NULL;
  destroy(sum);
  *sum = next;
  return next ? STEIF_OK : STEIF_NO_MEMORY;
}

static void round_entries(SUNMatrix M)
{
  const bool sparse = SUNMatGetID(M) == SUNMATRIX_SPARSE;
  sunrealtype *x = sparse ? SM_DATA_S(M) : SUNDenseMatrix_Data(M);
  const sunindextype n = stf_matrix_order(M),
                     count = sparse ? SM_INDEXPTRS_S(M)[n] : SUNDenseMatrix_LData(M);
  for (sunindextype i = 0; i < count; i++) x[i] = rounded(x[i]);
}

static int by_differences(const dependence *d, steif_impulse_direction *out)
{
  int code = STEIF_OK;
  for (int level = 0; level < LEVELS && !code; level++)
    for (int side = -1; side <= 1 && !code; side += 2) {
      const sunrealtype h = ldexp(WIDEST * d->size, -level),
                        by = side * romberg(level) / (2 * h);
      steif_linear l;
      code = matrices(d, side * h, &l);
      if (!code) code = gather(d->ctx, &out->E, l.E, by);
      if (!code) code = gather(d->ctx, &out->F, l.F, by);
      destroy(&l.E), destroy(&l.F);
    }
  if (!code) round_entries(out->E), round_entries(out->F);
  return code;
}

/* ---- by dF/dp at unit vectors --------------------------------------------------------------------- */

/* Column j of dE/dp or dF/dp: what dF/dp is at a unit vector, less what it is at 0. */
static int column(const dependence *d, bool of_E, sunindextype j, sunrealtype *to)
{
  const steif_problem *p = d->problem;
  const sunrealtype *constant = N_VGetArrayPointer(d->other);
  N_VGetArrayPointer(d->unit)[j] = 1;
  N_Vector y = of_E ? d->zero : d->unit, yp = of_E ? d->unit : d->zero;
  N_Vector r = N_VMake_Serial(p->n, to, steif_sundials(d->ctx));
  if (!r) return STEIF_FAIL(d->ctx, STEIF_NO_MEMORY, "no memory for a vector");
  const int code = steif_parameter_slope(d->ctx, p, d->k, p->t0, y, yp, r);
  N_VGetArrayPointer(d->unit)[j] = 0;
  N_VDestroy(r);
  for (sunindextype i = 0; !code && i < p->n; i++) to[i] -= constant[i];
  return code;
}

static int by_vectors(const dependence *d, steif_impulse_direction *out)
{
  const steif_problem *p = d->problem;
  SUNMatrix *M[] = {&out->E, &out->F};
  N_VConst(0, d->zero), N_VConst(0, d->unit);
  STEIF_TRY(steif_parameter_slope(d->ctx, p, d->k, p->t0, d->zero, d->zero, d->other));
  for (int which = 0; which < 2; which++) {
    SUNMatrix dense = SUNDenseMatrix(p->n, p->n, steif_sundials(d->ctx));
    STEIF_CHECK(dense, d->ctx, STEIF_NO_MEMORY, "no memory for a matrix of order %lld",
                (long long)p->n);
    int code = STEIF_OK;
    for (sunindextype j = 0; !code && j < p->n; j++)
      code = column(d, which == 0, j, SUNDenseMatrix_Column(dense, j));
    if (!code && p->storage == STEIF_SPARSE) {
      *M[which] = SUNSparseFromDenseMatrix(dense, 0, CSC_MAT);
      SUNMatDestroy(dense);
    } else {
      *M[which] = dense;
    }
    if (code) return code;
    STEIF_CHECK(*M[which], d->ctx, STEIF_NO_MEMORY, "no memory for a sparse matrix");
  }
  return STEIF_OK;
}

/* ---- the whole ------------------------------------------------------------------------------------ */

static bool zero(SUNMatrix M)
{
  sunindextype i, j;
  sunrealtype value;
  for (stf_entries at = {M, 0, 0, 0}; stf_entries_next(&at, &i, &j, &value);)
    if (value != 0) return false;
  return true;
}

static int differ(steif_context *ctx, SUNMatrix A, SUNMatrix B, bool *different)
{
  SUNMatrix M = stf_moved_matrix(ctx, A, B, -1);
  if (!M) return STEIF_NO_MEMORY;
  *different = *different || !zero(M);
  SUNMatDestroy(M);
  return STEIF_OK;
}

/* Do E or F move with p? Their derivatives may vanish at p alone, as that of (p - 1)^2 does. */
static int moves(const dependence *d, bool *any)
{
  steif_linear l, here;
  STEIF_TRY(matrices(d, 0, &here));
  int code = STEIF_OK;
  for (int side = -1; side <= 1 && !code && !*any; side += 2) {
    code = matrices(d, side * ASIDE * d->size, &l);
    if (!code) code = differ(d->ctx, here.E, l.E, any);
    if (!code) code = differ(d->ctx, here.F, l.F, any);
    destroy(&l.E), destroy(&l.F);
  }
  destroy(&here.E), destroy(&here.F);
  return code;
}

static int nearby(sunrealtype by, SUNMatrix *E, SUNMatrix *F, void *user)
{
  const dependence *d = user;
  steif_linear l;
  const int code = matrices(d, by * d->size, &l);
  *E = l.E, *F = l.F;
  return code;
}

static int fill(dependence *d, steif_impulse_direction *out)
{
  const steif_problem *p = d->problem;
  const steif_parameters *q = p->parameters;
  STEIF_TRY(q->dFdp && p->n <= BY_VECTORS ? by_vectors(d, out) : by_differences(d, out));
  if (zero(out->E)) destroy(&out->E);
  if (zero(out->F)) destroy(&out->F);
  bool any = out->E || out->F;
  if (!any) STEIF_TRY(moves(d, &any));
  if (any) out->nearby = nearby;
  STEIF_TRY(steif_parameter_start(d->ctx, p, d->k, d->other));
  memcpy(d->x0, N_VGetArrayPointer(d->other), (size_t)p->n * sizeof *d->x0);
  out->x0 = d->x0;
  if (p->g) out->f = forcing;
  return STEIF_OK;
}

static int open(dependence *d)
{
  const sunindextype n = d->problem->n;
  N_Vector *v[] = {&d->other, &d->zero, &d->unit};
  const sunrealtype *scale = d->problem->parameters->scale;
  d->size = fabs(value_of(d));
  if (d->size == 0) d->size = scale && scale[d->k] != 0 ? fabs(scale[d->k]) : 1;
  for (int i = 0; i < 3; i++)
    if (!(*v[i] = N_VNew_Serial(n, steif_sundials(d->ctx))))
      return STEIF_FAIL(d->ctx, STEIF_NO_MEMORY, "no memory for a vector of %lld",
                        (long long)n);
  d->x0 = stf_allocate(d->ctx, (size_t)n, sizeof *d->x0);
  return d->x0 ? STEIF_OK : STEIF_NO_MEMORY;
}

int steif_impulse_direction_of(steif_context *ctx, const steif_problem *p, int k,
                               steif_impulse_direction *out)
{
  const steif_problem *asked = p;
  STF_NAMED(p);
  STEIF_CHECK(p && out, ctx, STEIF_BAD_INPUT,
              "a problem and a direction are needed, one is NULL");
  *out = (steif_impulse_direction){0};
  const steif_parameters *q = p->parameters;
  STEIF_CHECK(q && q->count > 0 && q->value, ctx, STEIF_BAD_INPUT,
              "problem '%s' has no parameters: set .parameters", p->name);
  STEIF_CHECK(k >= 0 && k < q->count, ctx, STEIF_BAD_INPUT,
              "parameter %d of problem '%s' must lie in 0 .. %d", k, p->name, q->count - 1);
  STEIF_CHECK(isfinite(q->value[k]), ctx, STEIF_NOT_FINITE,
              "parameter %d of problem '%s' is %g", k + 1, p->name, q->value[k]);
  STEIF_CHECK(steif_problem_form(ctx, p) == STEIF_DESCRIPTOR, ctx, STEIF_UNSUPPORTED,
              "problem '%s' has no pencil of its own: derivatives of impulses need the form "
              "descriptor",
              p->name);
  dependence *d = stf_allocate(ctx, 1, sizeof *d);
  if (!d) return STEIF_NO_MEMORY;
  *d = (dependence){.ctx = ctx, .k = k};
  d->problem = stf_with_name(asked, &d->named);
  out->user = d;
  int code = open(d);
  if (!code) code = fill(d, out);
  if (code) steif_impulse_direction_clear(ctx, out);
  return code;
}

void steif_impulse_direction_clear(steif_context *ctx, steif_impulse_direction *out)
{
  if (!out) return;
  dependence *d = out->user;
  destroy(&out->E), destroy(&out->F);
  if (d) {
    N_Vector v[] = {d->other, d->zero, d->unit};
    for (int i = 0; i < 3; i++)
      if (v[i]) N_VDestroy(v[i]);
    stf_release(ctx, d->x0);
    stf_release(ctx, d);
  }
  *out = (steif_impulse_direction){0};
}
