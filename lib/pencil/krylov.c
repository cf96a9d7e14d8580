/* krylov.c: pencils known by their products, through restarted GMRES (Y. Saad & M. H. Schultz,
 * SIAM J. Sci. Stat. Comput. 7, 1986; SUNDIALS' SPGMR), preconditioned on the right so that the
 * residual is that of the system itself.
 *
 * A complex shift s = a + i b works on the pair [x_r; x_i], a ManyVector, with
 *
 *   [ a E - A    -b E   ]
 *   [   b E     a E - A ],
 *
 * whose spectrum is that of s E - A and its mirror image. Both halves are preconditioned with the
 * real shift of the same modulus and the sign of a: on the half-line of eigenvalues -l <= 0 the
 * quotient (s + l) / (|s| + l) stays on the short arc from s / |s| to 1, where a itself would
 * stretch it to s / a.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include <math.h>
#include <nvector/nvector_manyvector.h>
#include <sundials/sundials_iterative.h>
#include <sunlinsol/sunlinsol_spgmr.h>

enum { DIMENSION = 30, RESTARTS = 10 };
static const double TOLERANCE = 1e-10;

typedef struct krylov {
  stf_pool *pool;
  SUNLinearSolver plain, paired; /* on y and on [Re; Im] */
  N_Vector x, t, u;              /* t, u: E times the halves */
  N_Vector pair_x, pair_b, half_x[2], half_b[2];
  steif_shift s; /* of the solve under way */
  int answer;    /* what a callback returned when it failed */
  const char *culprit;
} krylov;

static int answered(krylov *k, const char *name, int answer)
{
  if (answer) k->answer = answer, k->culprit = name;
  return answer;
}

static int times(steif_pencil *p, const char *name, N_Vector x, N_Vector out)
{
  const bool is_E = name[0] == 'E';
  int (*f)(N_Vector, N_Vector, void *) = is_E ? p->op.E : p->op.A;
  if (f) return answered(p->state, name, f(x, out, p->op.user));
  N_VScale(1, x, out);
  return 0;
}

static int plain_times(void *data, N_Vector x, N_Vector z)
{
  steif_pencil *p = data;
  krylov *k = p->state;
  int code;
  if ((code = times(p, "A", x, z)) || (code = times(p, "E", x, k->t))) return code;
  N_VLinearSum(k->s.re, k->t, -1, z, z);
  return 0;
}

static int paired_times(void *data, N_Vector x, N_Vector z)
{
  steif_pencil *p = data;
  krylov *k = p->state;
  N_Vector part[2] = {N_VGetSubvector_ManyVector(z, 0), N_VGetSubvector_ManyVector(z, 1)};
  int code;
  for (int i = 0; i < 2; i++) {
    N_Vector from = N_VGetSubvector_ManyVector(x, i);
    if ((code = times(p, "A", from, part[i]))) return code;
    if ((code = times(p, "E", from, i ? k->u : k->t))) return code;
  }
  N_VLinearSum(k->s.re, k->t, -1, part[0], part[0]);
  N_VLinearSum(-k->s.im, k->u, 1, part[0], part[0]);
  N_VLinearSum(k->s.re, k->u, -1, part[1], part[1]);
  N_VLinearSum(k->s.im, k->t, 1, part[1], part[1]);
  return 0;
}

static int plain_precondition(void *data, N_Vector r, N_Vector z, sunrealtype tolerance,
                              int side)
{
  steif_pencil *p = data;
  krylov *k = p->state;
  (void)side;
  return answered(k, "the preconditioner",
                  p->op.precondition(k->s.re, r, z, tolerance, p->op.user));
}

static int paired_precondition(void *data, N_Vector r, N_Vector z, sunrealtype tolerance,
                               int side)
{
  steif_pencil *p = data;
  krylov *k = p->state;
  const sunrealtype shift = copysign(hypot(k->s.re, k->s.im), k->s.re);
  int code = 0;
  (void)side;
  for (int i = 0; i < 2 && !code; i++)
    code = p->op.precondition(shift, N_VGetSubvector_ManyVector(r, i),
                              N_VGetSubvector_ManyVector(z, i), tolerance, p->op.user);
  return answered(k, "the preconditioner", code);
}

static void destroy_solver(void *solver) { SUNLinSolFree(solver); }

/* A solver on vectors like y; NULL with the sentence set. */
static SUNLinearSolver solver_new(steif_pencil *p, N_Vector y, SUNATimesFn product,
                                  SUNPSolveFn precondition)
{
  krylov *k = p->state;
  const int dimension = p->op.dimension ? p->op.dimension : DIMENSION;
  SUNLinearSolver l = SUNLinSol_SPGMR(y, p->op.precondition ? SUN_PREC_RIGHT : SUN_PREC_NONE,
                                      dimension, y->sunctx);
  if (!l) {
    STEIF_FAIL(p->ctx, STEIF_NO_MEMORY, "no memory for a Krylov solver of dimension %d",
               dimension);
    return NULL;
  }
  if (stf_claim_owner(k->pool, l, destroy_solver)) return NULL;
  const int bad =
    SUNLinSolSetATimes(l, p, product) ||
    (p->op.precondition && SUNLinSolSetPreconditioner(l, p, NULL, precondition)) ||
    SUNLinSol_SPGMRSetMaxRestarts(l, p->op.restarts ? p->op.restarts : RESTARTS) ||
    SUNLinSolInitialize(l) || SUNLinSolSetup(l, NULL);
  if (!bad) return l;
  STEIF_FAIL(p->ctx, STEIF_NO_MEMORY,
             "no memory for %d Krylov vectors of %lld components; take a smaller dimension",
             dimension, (long long)N_VGetLength(y));
  return NULL;
}

static void destroy_vector(void *v) { N_VDestroy(v); }

static N_Vector pair(steif_pencil *p, N_Vector half[2])
{
  krylov *k = p->state;
  for (int i = 0; i < 2; i++)
    if (!(half[i] = stf_claim_vector(k->pool, p->like))) return NULL;
  N_Vector v = N_VNew_ManyVector(2, half, p->like->sunctx);
  if (!v)
    STEIF_FAIL(p->ctx, STEIF_NO_MEMORY, "no memory for a pair of vectors of %lld components",
               (long long)p->n);
  return v && stf_claim_owner(k->pool, v, destroy_vector) ? NULL : v;
}

static int start(steif_pencil *p)
{
  krylov *k = p->state;
  if (!(k->pool = stf_pool_new(p->ctx))) return STEIF_NO_MEMORY;
  N_Vector *const own[] = {&k->x, &k->t, &k->u};
  for (size_t i = 0; i < sizeof own / sizeof *own; i++)
    if (!(*own[i] = stf_claim_vector(k->pool, p->like))) return STEIF_NO_MEMORY;
  k->plain = solver_new(p, k->x, plain_times, plain_precondition);
  return k->plain ? STEIF_OK : STEIF_NO_MEMORY;
}

static int update(steif_pencil *p)
{
  (void)p;
  return STEIF_OK;
}

/* The solver on pairs is made at the first complex shift. */
static int prepare(steif_pencil *p, int slot, steif_shift s)
{
  krylov *k = p->state;
  (void)slot;
  if (!stf_is_complex(s) || k->paired) return STEIF_OK;
  if (!k->pair_x && !(k->pair_x = pair(p, k->half_x))) return STEIF_NO_MEMORY;
  if (!k->pair_b && !(k->pair_b = pair(p, k->half_b))) return STEIF_NO_MEMORY;
  k->paired = solver_new(p, k->pair_x, paired_times, paired_precondition);
  return k->paired ? STEIF_OK : STEIF_NO_MEMORY;
}

static void factor(steif_pencil *p, int slot, steif_shift s, stf_outcome *out)
{
  (void)p, (void)slot, (void)s, (void)out;
}

static int refused(steif_pencil *p, SUNLinearSolver l, double norm)
{
  krylov *k = p->state;
  const steif_shift s = k->s;
  STEIF_CHECK(!k->answer, p->ctx, k->answer > 0 ? STEIF_RETRY : STEIF_CALLBACK,
              "%s of the operator returned %d at s = %.10g%+.10gi", k->culprit, k->answer, s.re,
              s.im);
  return STEIF_FAIL(
    p->ctx, STEIF_NO_CONVERGENCE,
    "GMRES reached the relative residual %.2e in %d iterations at s = %.10g%+.10gi "
    "(wanted %.1e); give a better preconditioner, a larger dimension or more "
    "restarts",
    SUNLinSolResNorm(l) / norm, SUNLinSolNumIters(l), s.re, s.im,
    p->op.tolerance > 0 ? p->op.tolerance : TOLERANCE);
}

/* Solve for x from a zero guess. */
static int run(steif_pencil *p, SUNLinearSolver l, N_Vector x, N_Vector b)
{
  krylov *k = p->state;
  const double norm = sqrt(N_VDotProd(b, b));
  const double tolerance = p->op.tolerance > 0 ? p->op.tolerance : TOLERANCE;
  k->answer = 0;
  N_VConst(0, x);
  if (norm == 0) return STEIF_OK;
  STEIF_CHECK(isfinite(norm), p->ctx, STEIF_NOT_FINITE,
              "the right-hand side has norm %g: look for the NaN or overflow in it", norm);
  SUNLinSolSetZeroGuess(l, 1);
  const int flag = SUNLinSolSolve(l, NULL, x, b, tolerance * norm);
  p->stats.iterations += SUNLinSolNumIters(l);
  return flag ? refused(p, l, norm) : STEIF_OK;
}

static int solve(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im)
{
  krylov *k = p->state;
  k->s = p->shift[slot];
  for (int i = 0; i < nrhs; i++) {
    if (!im) {
      STEIF_TRY(run(p, k->plain, k->x, re[i]));
      N_VScale(1, k->x, re[i]);
      continue;
    }
    N_VScale(1, re[i], k->half_b[0]);
    N_VScale(1, im[i], k->half_b[1]);
    STEIF_TRY(run(p, k->paired, k->pair_x, k->pair_b));
    N_VScale(1, k->half_x[0], re[i]);
    N_VScale(1, k->half_x[1], im[i]);
  }
  return STEIF_OK;
}

static int product(steif_pencil *p, char which, N_Vector x, N_Vector out)
{
  krylov *k = p->state;
  k->answer = 0;
  const int answer = times(p, which == 'E' ? "E" : "A", x, out);
  STEIF_CHECK(!answer, p->ctx, answer > 0 ? STEIF_RETRY : STEIF_CALLBACK,
              "%s of the operator returned %d in a product", k->culprit, answer);
  return STEIF_OK;
}

static void finish(steif_pencil *p)
{
  krylov *k = p->state;
  stf_pool_free(&k->pool);
}

const stf_backend stf_backend_krylov = {
  .name = "Krylov",
  .size = sizeof(krylov),
  .open = start,
  .update = update,
  .prepare = prepare,
  .factor = factor,
  .solve = solve,
  .product = product,
  .close = finish,
};
