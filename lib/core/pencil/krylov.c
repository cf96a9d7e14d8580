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
 * Where the caller has an aim (stf_pencil_aim) the preconditioner stands on the left: then the residual
 * is P^{-1} (b - M x), of the size of the error of x, and is measured with the weights of x.
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
  N_Vector pair_weights; /* p->weights twice */
  double near;           /* shift that the preconditioner is prepared for ... */
  bool ready;            /* ... if it is */
  steif_shift s;         /* of the solve under way */
  int answer;            /* what a callback returned when it failed */
  const char *culprit;
} krylov;

static int answered(krylov *k, const char *name, int answer)
{
  if (answer) k->answer = answer, k->culprit = name;
  return answer;
}

static int times_A(steif_pencil *p, N_Vector x, N_Vector out)
{
  return answered(p->state, "A", p->op.A(x, out, p->op.user));
}

/* E x is *out, or x itself. */
static int times_E(steif_pencil *p, N_Vector x, N_Vector *out)
{
  if (p->op.E) return answered(p->state, "E", p->op.E(x, *out, p->op.user));
  *out = x;
  return 0;
}

static int plain_times(void *data, N_Vector x, N_Vector z)
{
  steif_pencil *p = data;
  krylov *k = p->state;
  N_Vector Ex = k->t;
  int code;
  if ((code = times_A(p, x, z)) || (code = times_E(p, x, &Ex))) return code;
  N_VLinearSum(k->s.re, Ex, -1, z, z);
  return 0;
}

static int paired_times(void *data, N_Vector x, N_Vector z)
{
  steif_pencil *p = data;
  krylov *k = p->state;
  N_Vector part[2] = {N_VGetSubvector_ManyVector(z, 0), N_VGetSubvector_ManyVector(z, 1)};
  N_Vector Ex[2] = {k->t, k->u};
  int code;
  for (int i = 0; i < 2; i++) {
    N_Vector from = N_VGetSubvector_ManyVector(x, i);
    if ((code = times_A(p, from, part[i])) || (code = times_E(p, from, &Ex[i]))) return code;
  }
  N_VLinearSum(k->s.re, Ex[0], -1, part[0], part[0]);
  N_VLinearSum(-k->s.im, Ex[1], 1, part[0], part[0]);
  N_VLinearSum(k->s.re, Ex[1], -1, part[1], part[1]);
  N_VLinearSum(k->s.im, Ex[0], 1, part[1], part[1]);
  return 0;
}

/* The real shift that stands for s. */
static double modulus(steif_shift s) { return copysign(hypot(s.re, s.im), s.re); }

static double near(const steif_pencil *p)
{
  const krylov *k = p->state;
  return p->op.prepare ? k->near : modulus(k->s);
}

static int plain_precondition(void *data, N_Vector r, N_Vector z, sunrealtype tolerance,
                              int side)
{
  steif_pencil *p = data;
  (void)side;
  return answered(p->state, "the preconditioner",
                  p->op.precondition(near(p), r, z, tolerance, p->op.user));
}

static int paired_precondition(void *data, N_Vector r, N_Vector z, sunrealtype tolerance,
                               int side)
{
  steif_pencil *p = data;
  int code = 0;
  (void)side;
  if (p->precondition_pair) {
    N_Vector from[2] = {N_VGetSubvector_ManyVector(r, 0), N_VGetSubvector_ManyVector(r, 1)},
             to[2] = {N_VGetSubvector_ManyVector(z, 0), N_VGetSubvector_ManyVector(z, 1)};
    return answered(p->state, "the preconditioner of pairs",
                    p->precondition_pair(((krylov *)p->state)->s, from, to, p->op.user));
  }
  for (int i = 0; i < 2 && !code; i++)
    code = p->op.precondition(near(p), N_VGetSubvector_ManyVector(r, i),
                              N_VGetSubvector_ManyVector(z, i), tolerance, p->op.user);
  return answered(p->state, "the preconditioner", code);
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
  if (stf_pool_adopt(k->pool, l, destroy_solver)) return NULL;
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

static N_Vector join(steif_pencil *p, N_Vector half[2])
{
  krylov *k = p->state;
  N_Vector v = N_VNew_ManyVector(2, half, p->like->sunctx);
  if (!v)
    STEIF_FAIL(p->ctx, STEIF_NO_MEMORY, "no memory for a pair of vectors of %lld components",
               (long long)p->n);
  return v && stf_pool_adopt(k->pool, v, destroy_vector) ? NULL : v;
}

static N_Vector pair(steif_pencil *p, N_Vector half[2])
{
  krylov *k = p->state;
  for (int i = 0; i < 2; i++)
    if (!(half[i] = stf_pool_vector(k->pool, p->like))) return NULL;
  return join(p, half);
}

static int start(steif_pencil *p)
{
  krylov *k = p->state;
  if (!(k->pool = stf_pool_new(p->ctx))) return STEIF_NO_MEMORY;
  N_Vector *const own[] = {&k->x, &k->t, &k->u};
  for (size_t i = 0; i < sizeof own / sizeof *own; i++)
    if (!(*own[i] = stf_pool_vector(k->pool, p->like))) return STEIF_NO_MEMORY;
  k->plain = solver_new(p, k->x, plain_times, plain_precondition);
  return k->plain ? STEIF_OK : STEIF_NO_MEMORY;
}

static int update(steif_pencil *p)
{
  ((krylov *)p->state)->ready = false;
  return STEIF_OK;
}

/* A callback that has left a sentence in the context is told by it. */
static int prepare_near(steif_pencil *p, double shift)
{
  krylov *k = p->state;
  const double ratio = shift / k->near;
  if (!p->op.prepare || (k->ready && ratio >= 0.5 && ratio <= 2)) return STEIF_OK;
  const long failures = stf_failures(p->ctx);
  const int answer = p->op.prepare(shift, p->op.user);
  k->near = shift, k->ready = !answer;
  p->stats.factors++;
  if (!answer || stf_failures(p->ctx) > failures) return answer;
  return (answer > 0 ? stf_recover : stf_fail)(
    p->ctx, STEIF_CALLBACK, "preparing the preconditioner for the shift %.10g returned %d",
    shift, answer);
}

/* The solver on pairs is made at the first complex shift. */
static int prepare(steif_pencil *p, int slot, steif_shift s)
{
  krylov *k = p->state;
  (void)slot;
  STEIF_TRY(prepare_near(p, modulus(s)));
  if (!stf_is_complex(s)) return STEIF_OK;
  if (!k->pair_x && !(k->pair_x = pair(p, k->half_x))) return STEIF_NO_MEMORY;
  if (!k->pair_b && !(k->pair_b = pair(p, k->half_b))) return STEIF_NO_MEMORY;
  if (p->weights && !k->pair_weights) {
    N_Vector twice[2] = {p->weights, p->weights};
    if (!(k->pair_weights = join(p, twice))) return STEIF_NO_MEMORY;
  }
  if (!k->paired) k->paired = solver_new(p, k->pair_x, paired_times, paired_precondition);
  return k->paired ? STEIF_OK : STEIF_NO_MEMORY;
}

static void factor(steif_pencil *p, int slot, steif_shift s, stf_outcome *out)
{
  (void)p, (void)slot, (void)s, (void)out;
}

/* The norm below which the residual counts as none, and `side` and `weights` of it. */
static double allowed(const steif_pencil *p, bool paired, double size, int *side,
                      N_Vector *weights)
{
  const krylov *k = p->state;
  const bool aims = p->weights && (p->op.precondition || !p->op.E);
  *side = !p->op.precondition ? SUN_PREC_NONE : aims ? SUN_PREC_LEFT : SUN_PREC_RIGHT;
  *weights = !aims ? NULL : paired ? k->pair_weights : p->weights;
  if (!aims) return size * (p->op.tolerance > 0 ? p->op.tolerance : TOLERANCE);
  return p->aim * sqrt((paired ? 2 : 1) * (double)p->n) *
         (p->op.precondition ? 1 : hypot(k->s.re, k->s.im));
}

static int refused(steif_pencil *p, SUNLinearSolver l, double wanted)
{
  krylov *k = p->state;
  const steif_shift s = k->s;
  if (k->answer)
    return (k->answer > 0 ? stf_recover : stf_fail)(
      p->ctx, STEIF_CALLBACK, "%s of the operator returned %d at s = %.10g%+.10gi", k->culprit,
      k->answer, s.re, s.im);
  const char *const better = p->op.precondition ? "better " : "";
  const double left = SUNLinSolResNorm(l) / wanted;
  const int count = SUNLinSolNumIters(l);
  return (p->weights ? stf_recover : stf_fail)(
    p->ctx, STEIF_NO_CONVERGENCE,
    "GMRES left a residual %.2e times the wanted one after %d iterations at s = %.10g%+.10gi; "
    "give a %spreconditioner, a larger dimension or more restarts",
    left, count, s.re, s.im, better);
}

/* Solve for x from a zero guess. */
static int run(steif_pencil *p, bool paired, N_Vector x, N_Vector b)
{
  krylov *k = p->state;
  SUNLinearSolver l = paired ? k->paired : k->plain;
  const double norm = sqrt(N_VDotProd(b, b));
  N_Vector weights;
  int side;
  k->answer = 0;
  N_VConst(0, x);
  if (norm == 0) return STEIF_OK;
  if (!isfinite(norm))
    return (p->weights ? stf_recover : stf_fail)(
      p->ctx, STEIF_NOT_FINITE,
      "the right-hand side has norm %g: look for the NaN or overflow in it", norm);
  const double wanted = allowed(p, paired, norm, &side, &weights);
  SUNLinSol_SPGMRSetPrecType(l, side);
  SUNLinSolSetScalingVectors(l, weights, weights);
  SUNLinSolSetZeroGuess(l, 1);
  const int flag = SUNLinSolSolve(l, NULL, x, b, wanted);
  p->stats.iterations += SUNLinSolNumIters(l);
  return flag ? refused(p, l, wanted) : STEIF_OK;
}

static int solve(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im)
{
  krylov *k = p->state;
  k->s = p->shift[slot];
  for (int i = 0; i < nrhs; i++) {
    if (!im) {
      STEIF_TRY(run(p, false, k->x, re[i]));
      N_VScale(1, k->x, re[i]);
      continue;
    }
    N_VScale(1, re[i], k->half_b[0]);
    N_VScale(1, im[i], k->half_b[1]);
    STEIF_TRY(run(p, true, k->pair_x, k->pair_b));
    N_VScale(1, k->half_x[0], re[i]);
    N_VScale(1, k->half_x[1], im[i]);
  }
  return STEIF_OK;
}

/* E is not asked for where it is the identity. */
static int product(steif_pencil *p, char which, N_Vector x, N_Vector out)
{
  krylov *k = p->state;
  k->answer = 0;
  const int answer = which == 'E' ? times_E(p, x, &out) : times_A(p, x, out);
  if (!answer) return STEIF_OK;
  return (answer > 0 ? stf_recover : stf_fail)(
    p->ctx, STEIF_CALLBACK, "%s of the operator returned %d in a product", k->culprit, answer);
}

/* The preconditioner is made again as it was, with the last slot; the caller has read its point. */
static void keep(steif_pencil *p, int slot, stf_image *m)
{
  krylov *k = p->state;
  STF_KEEP(m, k->near);
  STF_KEEP(m, k->ready);
  if (!m->reads || m->code || slot < p->slots - 1 || !k->ready || !p->op.prepare) return;
  const long failures = stf_failures(p->ctx);
  const int answer = p->op.prepare(k->near, p->op.user);
  if (answer && stf_failures(p->ctx) == failures)
    STEIF_FAIL(p->ctx, STEIF_CALLBACK,
               "preparing the preconditioner of the run that was saved returned %d", answer);
  if (answer) stf_image_stop(m, STEIF_CALLBACK);
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
  .keep = keep,
  .close = finish,
};
