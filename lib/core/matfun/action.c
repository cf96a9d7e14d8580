/* action.c: phi functions of a large matrix applied to vectors: the frame and the choice of
 * method.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "action.h"
#include <sunmatrix/sunmatrix_sparse.h>

/* ||tA||_1 up to which Taylor series are taken, up to which products cost less than a factorisation,
 * and up to which sub-steps are affordable. */
static const double small = 8, medium = 100, affordable = 1e5;

bool stf_action_expm(steif_action *a, int order)
{
  stf_core c;
  stf_core_open(&c, a->ctx, order, 0, a->core);
  return stf_all_finite(a->M, (size_t)order * (size_t)order) &&
         !stf_core_expm(&c, a->M, a->X) && stf_all_finite(a->X, (size_t)order * (size_t)order);
}

static int check_matrix(steif_context *ctx, SUNMatrix A, N_Vector like)
{
  STEIF_CHECK(
    SUNMatGetID(A) == SUNMATRIX_SPARSE && SM_SPARSETYPE_S(A) == CSC_MAT, ctx, STEIF_UNSUPPORTED,
    "A must be sparse by columns (CSC); for a dense matrix take steif_phi_combine, for "
    "anything else an operator");
  const long long n = SM_COLUMNS_S(A), rows = SM_ROWS_S(A), size = N_VGetLength(like);
  STEIF_CHECK(n == rows, ctx, STEIF_BAD_INPUT, "A is %lld x %lld: it must be square", rows, n);
  STEIF_CHECK(n == size, ctx, STEIF_BAD_INPUT, "A is %lld x %lld, the vector has %lld entries",
              n, n, size);
  STEIF_CHECK(stf_array(like), ctx, STEIF_UNSUPPORTED,
              "the vector has no host array: take a serial vector, or an operator");
  return STEIF_OK;
}

static int check_options(steif_context *ctx, const steif_action_options *o)
{
  STEIF_CHECK(o->method >= STEIF_ACTION_AUTO && o->method <= STEIF_ACTION_TAYLOR &&
                o->spectrum >= STEIF_SPECTRUM_UNKNOWN &&
                o->spectrum <= STEIF_SPECTRUM_OSCILLATORY,
              ctx, STEIF_BAD_INPUT, "method %d or spectrum %d is not of the enums", o->method,
              o->spectrum);
  STEIF_CHECK(o->tolerance >= 0 && o->tolerance < 1, ctx, STEIF_BAD_INPUT,
              "tolerance %g: it lies between 0 (the default) and 1", o->tolerance);
  STEIF_CHECK((o->dimension == 0 || o->dimension >= 3) && o->dimension <= STF_DIMENSION, ctx,
              STEIF_BAD_INPUT, "dimension %d: from 3 to %d, or 0 for the default", o->dimension,
              STF_DIMENSION);
  STEIF_CHECK(o->products >= 0, ctx, STEIF_BAD_INPUT, "%ld products: none is negative",
              o->products);
  return STEIF_OK;
}

static int check_new(steif_context *ctx, SUNMatrix A, const steif_operator *op, N_Vector like,
                     const steif_action_options *o)
{
  STEIF_CHECK(!A != !op, ctx, STEIF_BAD_INPUT, "%s: give one of them",
              A ? "both a matrix and an operator are given"
                : "neither a matrix nor an operator is given");
  STEIF_CHECK(like, ctx, STEIF_BAD_INPUT, "there is no vector to clone");
  STEIF_CHECK(!op || !op->E, ctx, STEIF_UNSUPPORTED,
              "the operator has an E: multiply A by its inverse instead");
  STEIF_TRY(check_options(ctx, o));
  return A ? check_matrix(ctx, A, like) : STEIF_OK;
}

/* Inexact solves must not be what limits the accuracy. */
static steif_pencil *make_pencil(steif_action *a, const steif_operator *op)
{
  if (!op) return steif_pencil_new(a->ctx, NULL, a->A);
  steif_operator sharp = *op;
  const double needed = 0.01 * a->o.tolerance;
  if (!(sharp.tolerance > 0 && sharp.tolerance < needed)) sharp.tolerance = needed;
  return steif_pencil_new_operator(a->ctx, &sharp, a->space.like);
}

static int claim(steif_action *a)
{
  const int most = a->o.dimension ? a->o.dimension : STF_RATIONAL, order = stf_order(most);
  const size_t n = (size_t)order;
  a->basis = stf_pool_array(a->pool, (size_t)most + 2, sizeof *a->basis);
  double *dense = a->basis ? stf_pool_array(a->pool, 4 * n * n + 2 * n, sizeof *dense) : NULL;
  a->core = dense ? stf_pool_array(a->pool, stf_core_bytes(order, 0), 1) : NULL;
  if (!a->core) return STEIF_NO_MEMORY;
  a->H = dense, a->M = a->H + n * n, a->X = a->M + n * n, a->R = a->X + n * n;
  a->column = a->R + n * n, a->last = a->column + n;
  if (!a->A) return STEIF_OK;
  a->sign = stf_pool_array(a->pool, (size_t)a->space.n, sizeof *a->sign);
  return a->sign ? STEIF_OK : STEIF_NO_MEMORY;
}

/* Everything but the pencil. */
static steif_action *make(steif_context *ctx, SUNMatrix A, N_Vector like,
                          const steif_action_options *o)
{
  steif_action *a = stf_allocate(ctx, 1, sizeof *a);
  if (!a) return NULL;
  a->ctx = ctx, a->A = A, a->o = *o;
  a->dimension = o->dimension ? o->dimension : STF_RATIONAL;
  if (a->o.tolerance == 0) a->o.tolerance = 1e-10;
  if (a->o.products == 0) a->o.products = 100000;
  stf_space_open(&a->space, like);
  a->pool = stf_pool_new(ctx);
  if (!a->pool || claim(a)) steif_action_free(&a);
  return a;
}

steif_action *steif_action_new(steif_context *ctx, SUNMatrix A, const steif_operator *op,
                               N_Vector like, const steif_action_options *options)
{
  const steif_action_options o = options ? *options : (steif_action_options){0};
  if (!ctx || check_new(ctx, A, op, like, &o)) return NULL;
  steif_action *a = make(ctx, A, like, &o);
  if (a && (!(a->pencil = make_pencil(a, op)) || steif_action_update(a))) steif_action_free(&a);
  return a;
}

steif_action *stf_action_open(steif_context *ctx, steif_pencil *pencil, N_Vector like,
                              const steif_action_options *options)
{
  if (check_options(ctx, options)) return NULL;
  steif_action *a = make(ctx, pencil->A, like, options);
  if (!a) return NULL;
  a->pencil = pencil, a->borrowed = true;
  if (stf_state_grow(a, a->dimension + 2) || stf_action_renew(a)) steif_action_free(&a);
  return a;
}

void steif_action_free(steif_action **a)
{
  if (!a || !*a) return;
  if (!(*a)->borrowed) steif_pencil_free(&(*a)->pencil);
  stf_pool_free(&(*a)->pool);
  stf_release((*a)->ctx, *a);
  *a = NULL;
}

int stf_action_renew(steif_action *a)
{
  a->gamma = 0;
  return stf_facts_find(a);
}

void stf_action_aim(steif_action *a, double relative, double absolute)
{
  a->o.tolerance = relative, a->absolute = absolute;
}

int steif_action_update(steif_action *a)
{
  if (!a) return STEIF_BAD_INPUT;
  STEIF_TRY(steif_pencil_update(a->pencil));
  return stf_action_renew(a);
}

static int check_apply(steif_action *a, sunrealtype t, int p, N_Vector *b, N_Vector w)
{
  STEIF_CHECK(isfinite(t), a->ctx, STEIF_BAD_INPUT, "t = %g: the time must be finite", t);
  STEIF_CHECK(p >= 0 && p <= STEIF_PHI_MOST, a->ctx, STEIF_BAD_INPUT,
              "p = %d: phi functions from 0 to %d are at hand", p, STEIF_PHI_MOST);
  STEIF_CHECK(b && w, a->ctx, STEIF_BAD_INPUT, "%s is NULL",
              b ? "the vector for the result" : "the array of vectors b");
  for (int k = 0; k <= p + 1; k++) {
    N_Vector v = k <= p ? b[k] : w;
    if (!v) continue;
    const long long n = N_VGetLength(v), wanted = a->space.n;
    STEIF_CHECK(n == wanted && (!a->A || stf_array(v)), a->ctx, STEIF_BAD_INPUT,
                "%s %d has %lld entries%s where %lld in a host array are needed",
                k <= p ? "b" : "w, after b", k <= p ? k : p, n,
                n == wanted ? " and no host array" : "", wanted);
    STEIF_CHECK(k > p || v != w, a->ctx, STEIF_BAD_INPUT,
                "w is b[%d]: the result needs a vector of its own", k);
    STEIF_CHECK(k > p || stf_finite(&a->space, v), a->ctx, STEIF_NOT_FINITE,
                "b[%d] has an entry that is NaN or infinite", k);
  }
  return STEIF_OK;
}

/* scale = sum ||b_k||/k!, and eta, a power of two with eta max ||b_k|| near 1, k >= 1. */
static void measure(steif_action *a)
{
  double most = 0;
  a->scale = 0;
  for (int k = 0; k <= a->p; k++) {
    if (!a->b[k]) continue;
    const double norm = stf_vector_norm(&a->space, a->b[k]);
    a->scale += norm * stf_inverse_factorial(k).hi;
    if (k > 0 && norm > most) most = norm;
  }
  int e = 0;
  if (most > 0) frexp(most, &e);
  a->eta = ldexp(1, -e);
}

/* w = sum b_k/k!, the answer for t = 0 */
static void at_zero(steif_action *a, N_Vector w)
{
  stf_zero(&a->space, w);
  for (int k = 0; k <= a->p; k++)
    if (a->b[k]) stf_axpy(&a->space, stf_inverse_factorial(k).hi, a->b[k], w);
  a->report.norm = stf_vector_norm(&a->space, w);
}

static bool good(const steif_action *a)
{
  return a->report.error <= stf_action_allowed(a, a->report.norm);
}

static int run(steif_action *a, int method, N_Vector w)
{
  a->report.method = method;
  a->report.error = INFINITY;
  switch (method) {
  case STEIF_ACTION_RATIONAL: return stf_action_rational(a, w);
  case STEIF_ACTION_POLYNOMIAL: return stf_action_polynomial(a, w);
  default: return stf_action_taylor(a, w);
  }
}

static int choose(const steif_action *a)
{
  if (a->o.method != STEIF_ACTION_AUTO) return a->o.method;
  if (!a->A)
    return a->o.spectrum == STEIF_SPECTRUM_SECTORIAL ? STEIF_ACTION_RATIONAL
                                                     : STEIF_ACTION_POLYNOMIAL;
  if (a->report.norm_tA <= small) return STEIF_ACTION_TAYLOR;
  const bool waves = a->o.spectrum == STEIF_SPECTRUM_OSCILLATORY ||
                     (a->o.spectrum == STEIF_SPECTRUM_UNKNOWN && a->facts.skew);
  return waves || a->report.norm_tA <= medium ? STEIF_ACTION_POLYNOMIAL : STEIF_ACTION_RATIONAL;
}

/* The method chosen, and the polynomial one where that did not do. */
static int compute(steif_action *a, N_Vector w)
{
  const int before = steif_status(a->ctx), method = choose(a);
  int code = run(a, method, w);
  const bool failed =
    code == STEIF_SINGULAR || code == STEIF_NO_CONVERGENCE || (!code && !good(a));
  if (a->o.method == STEIF_ACTION_AUTO && method != STEIF_ACTION_POLYNOMIAL && failed &&
      a->report.norm_tA <= affordable) {
    code = run(a, STEIF_ACTION_POLYNOMIAL, w);
    if (!code && before == STEIF_OK) steif_forget(a->ctx);
  }
  return code;
}

static const char *name_of(int method)
{
  return method == STEIF_ACTION_RATIONAL     ? "rational Krylov"
         : method == STEIF_ACTION_POLYNOMIAL ? "polynomial Krylov"
                                             : "Taylor";
}

int steif_action_apply(steif_action *a, sunrealtype t, int p, N_Vector *b, N_Vector w,
                       steif_action_report *report)
{
  if (!a) return STEIF_BAD_INPUT;
  STEIF_TRY(check_apply(a, t, p, b, w));
  a->t = t, a->p = p, a->b = b;
  a->report = (steif_action_report){.norm_tA = fabs(t) * a->facts.norm};
  measure(a);
  int code = STEIF_OK;
  if (t == 0 || a->scale == 0)
    at_zero(a, w);
  else
    code = compute(a, w);
  if (report) *report = a->report;
  STEIF_TRY(code);
  STEIF_CHECK(
    good(a), a->ctx, STEIF_NOT_CERTIFIED,
    "the %s method leaves an estimated error of %.2e where %.2e is allowed (||w|| = %.3g, "
    "%ld products, %ld solves, ||tA||_1 = %.3g): shorten t, raise dimension, products "
    "or tolerance, or name another method",
    name_of(a->report.method), a->report.error, stf_action_allowed(a, a->report.norm),
    a->report.norm, a->report.products, a->report.solves, a->report.norm_tA);
  return STEIF_OK;
}
