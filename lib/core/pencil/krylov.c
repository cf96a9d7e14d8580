/* krylov.c: pencils known by their products, through restarted GMRES (gmres.h), preconditioned on the right
 * so that the residual is that of the system itself.
 *
 * A complex shift s = a + i b works on pairs of real vectors with the inner product of complex ones. Both halves are
 * preconditioned with the real shift of the same modulus and the sign of a, where the caller has no
 * preconditioner of pairs: on the half-line of eigenvalues -l <= 0 the quotient
 * (s + l) / (|s| + l) stays on the short chord from s / |s| to 1, where a itself would stretch it to s / a.
 *
 * Where the caller has an aim (stf_pencil_aim) the preconditioner stands on the left: then the residual
 * is P^{-1} (b - M x), of the size of the error of x, and is measured with the weights of x.
 *
 * A preconditioner is expensive to prepare and serves while the rate of convergence lasts: it is made again for
 * shifts not within a factor of 2, and with new products once solves take twice the iterations for the same gain
 * as the first ones after it was made did, or where a solve has failed.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gmres.h"
#include "pencil.h"
#include <math.h>

enum { DIMENSION = 30, RESTARTS = 10 };
static const double TOLERANCE = 1e-10;

/* Iterations that a tenth of the residual takes: of the first solves after a preparation, and of late. */
typedef struct pace {
  double first, late;
  int solves;
  bool failed;
} pace;

enum { FIRST_SOLVES = 4 };

static void pace_add(pace *of, bool failed, long iterations, double left)
{
  if (failed) of->failed = true;
  if (failed || iterations == 0) return;
  const double tenths = -log10(fmin(fmax(left, 1e-16), 0.9));
  const double needed = fmax(1, (double)iterations / tenths);
  if (of->solves < FIRST_SOLVES)
    of->late = of->first += (needed - of->first) / ++of->solves;
  else
    of->late += (needed - of->late) / FIRST_SOLVES;
}

static bool pace_lost(const pace *of, bool changed)
{
  return of->failed || (changed && of->late > 2 * fmax(1, of->first));
}

typedef struct krylov {
  stf_pool *pool;
  stf_gmres gmres;
  N_Vector x[2], t, u, squares; /* t, u: E times the halves; squares: of the weights */
  double near;                  /* shift that the preconditioner is prepared for ... */
  bool ready;                   /* ... if it is */
  bool changed;                 /* the products have, since */
  pace pace[2];                 /* of real and complex shifts */
  steif_shift s;                /* of the solve under way ... */
  bool transposed;              /* ... with E^T and A^T, s being its conjugate */
  int answer;                   /* what a callback returned when it failed */
  const char *culprit;
} krylov;

static int answered(krylov *k, const char *name, int answer)
{
  if (answer) k->answer = answer, k->culprit = name;
  return answer;
}

static int times_A(steif_pencil *p, N_Vector x, N_Vector out)
{
  const krylov *k = p->state;
  if (k->transposed)
    return answered(p->state, "the transposed A", p->turned.A(x, out, p->op.user));
  return answered(p->state, "A", p->op.A(x, out, p->op.user));
}

/* E x is *out, or x itself. */
static int times_E(steif_pencil *p, N_Vector x, N_Vector *out)
{
  const krylov *k = p->state;
  if (p->op.E && k->transposed)
    return answered(p->state, "the transposed E", p->turned.E(x, *out, p->op.user));
  if (p->op.E) return answered(p->state, "E", p->op.E(x, *out, p->op.user));
  *out = x;
  return 0;
}

/* out = (s E - A) x. */
static int product_of(void *data, stf_pair x, stf_pair out)
{
  steif_pencil *p = data;
  krylov *k = p->state;
  const stf_space *space = &k->gmres.space;
  N_Vector Ex[2] = {k->t, k->u};
  int code;
  p->counts.products += x.im ? 2 : 1;
  if ((code = times_A(p, x.re, out.re)) || (code = times_E(p, x.re, &Ex[0]))) return code;
  stf_sum(space, k->s.re, Ex[0], -1, out.re, out.re);
  if (!x.im) return 0;
  if ((code = times_A(p, x.im, out.im)) || (code = times_E(p, x.im, &Ex[1]))) return code;
  stf_sum(space, k->s.re, Ex[1], -1, out.im, out.im);
  stf_axpy(space, -k->s.im, Ex[1], out.re);
  stf_axpy(space, k->s.im, Ex[0], out.im);
  return 0;
}

/* The real shift that stands for s. */
static double modulus(steif_shift s) { return copysign(hypot(s.re, s.im), s.re); }

static double near(const steif_pencil *p)
{
  const krylov *k = p->state;
  return p->op.prepare ? k->near : modulus(k->s);
}

static int precondition_of(void *data, stf_pair r, stf_pair z)
{
  steif_pencil *p = data;
  const krylov *k = p->state;
  N_Vector from[2] = {r.re, r.im}, to[2] = {z.re, z.im};
  const bool pair = r.im != NULL;
  int code = 0;
  p->counts.applications += pair ? 2 : 1;
  if (pair && p->precondition_pair && !k->transposed)
    return answered(p->state, "the preconditioner of pairs",
                    p->precondition_pair(k->s, from, to, p->op.user));
  for (int i = 0; i < (pair ? 2 : 1) && !code; i++)
    code = (k->transposed ? p->turned.precondition : p->op.precondition)(near(p), from[i],
                                                                         to[i], 0, p->op.user);
  return answered(p->state,
                  k->transposed ? "the transposed preconditioner" : "the preconditioner", code);
}

static int start(steif_pencil *p)
{
  krylov *k = p->state;
  if (!(k->pool = stf_pool_new(p->ctx))) return STEIF_NO_MEMORY;
  N_Vector *const own[] = {&k->x[0], &k->t, &k->squares};
  for (size_t i = 0; i < sizeof own / sizeof *own; i++)
    if (!(*own[i] = stf_pool_vector(k->pool, p->like))) return STEIF_NO_MEMORY;
  return stf_gmres_open(k->pool, p->like, p->op.dimension ? p->op.dimension : DIMENSION,
                        p->op.restarts ? p->op.restarts : RESTARTS, &k->gmres);
}

/* What is prepared serves new products while it does as well as for the first ones. */
static int update(steif_pencil *p)
{
  krylov *k = p->state;
  if (p->prepare_again)
    k->changed = true;
  else
    k->ready = false;
  return STEIF_OK;
}

/* Is the preconditioner in use near enough? */
static bool serves(const steif_pencil *p, double shift)
{
  const krylov *k = p->state;
  const double ratio = shift / k->near;
  return k->ready && ratio >= 0.5 && ratio <= 2 && !pace_lost(&k->pace[0], k->changed) &&
         !pace_lost(&k->pace[1], k->changed);
}

static int prepare_near(steif_pencil *p, double shift)
{
  krylov *k = p->state;
  if (!p->op.prepare || serves(p, shift)) return STEIF_OK;
  const long failures = stf_failures(p->ctx);
  const int answer = p->op.prepare(shift, p->op.user);
  k->near = shift, k->ready = !answer, k->changed = false;
  k->pace[0] = k->pace[1] = (pace){0};
  p->stats.factors++;
  if (!answer || stf_failures(p->ctx) > failures) return answer;
  return (answer > 0 ? stf_recover : stf_fail)(
    p->ctx, STEIF_CALLBACK, "preparing the preconditioner for the shift %.10g returned %d",
    shift, answer);
}

static int open_pairs(steif_pencil *p)
{
  krylov *k = p->state;
  STEIF_TRY(stf_gmres_pairs(k->pool, &k->gmres));
  if (!k->u && !(k->u = stf_pool_vector(k->pool, p->like))) return STEIF_NO_MEMORY;
  k->x[1] = stf_pool_vector(k->pool, p->like);
  return k->x[1] ? STEIF_OK : STEIF_NO_MEMORY;
}

/* Imaginary parts get their room at the first complex shift. */
static int prepare(steif_pencil *p, int slot, steif_shift s)
{
  krylov *k = p->state;
  (void)slot;
  if (!p->revived) STEIF_TRY(prepare_near(p, modulus(s)));
  if (!stf_is_complex(s) || k->x[1]) return STEIF_OK;
  const int code = open_pairs(p);
  return p->deferred ? stf_agree(p->ctx, p->like, code) : code;
}

static void factor(steif_pencil *p, int slot, steif_shift s, stf_outcome *out)
{
  (void)p, (void)slot, (void)s, (void)out;
}

/* 1 / c, c the middle of the segment from s / near to 1, on which the spectrum of P^{-1} (s E - A) lies for
 * eigenvalues -l <= 0: the best multiple of P^{-1} b alone. */
static stf_number middle(const steif_pencil *p, steif_shift s)
{
  const double by = p->op.precondition ? near(p) : 0;
  const bool real = !p->precondition_pair || !stf_is_complex(s);
  const double re = p->op.precondition ? (real ? (1 + s.re / by) / 2 : 1) : s.re;
  const double im = p->op.precondition ? (real ? s.im / by / 2 : 0) : s.im;
  const double square = re * re + im * im;
  return (stf_number){re / square, -im / square};
}

static bool preconditioned(const steif_pencil *p)
{
  const krylov *k = p->state;
  return k->transposed ? p->turned.precondition != NULL : p->op.precondition != NULL;
}

static stf_map map_of(steif_pencil *p, bool pair)
{
  krylov *k = p->state;
  const bool aims = p->weights && (p->op.precondition || !p->op.E) && !k->transposed;
  stf_map map = {.product = product_of,
                 .precondition = preconditioned(p) ? precondition_of : NULL,
                 .data = p,
                 .left = aims,
                 .relative = p->op.tolerance > 0 ? p->op.tolerance : TOLERANCE};
  if (!aims) return map;
  stf_by_component(&k->gmres.space, p->weights, p->weights, k->squares);
  map.squares = k->squares, map.relative = p->relative, map.ahead = p->ahead;
  map.tolerance = p->aim * sqrt((pair ? 2 : 1) * (double)p->n) *
                  (p->op.precondition ? 1 : hypot(k->s.re, k->s.im));
  if (p->forced) map.start = middle(p, k->s);
  return map;
}

static int short_of(steif_pencil *p, const stf_map *map, long iterations)
{
  const krylov *k = p->state;
  const steif_shift s = k->s;
  const char *const better = preconditioned(p) ? "better " : "", *const turned =
                                                                   k->transposed ? "transposed "
                                                                                 : "";
  const double wanted = fmax(map->tolerance, map->relative * k->gmres.first);
  return (p->weights ? stf_recover : stf_fail)(
    p->ctx, STEIF_NO_CONVERGENCE,
    "GMRES left a residual %.2e times the wanted one after %ld iterations at s = %.10g%+.10gi; "
    "give a %s%spreconditioner, a larger dimension or more restarts",
    k->gmres.last / wanted, iterations, s.re, s.im, better, turned);
}

/* Whose it is: the caller's, or that of the operator. */
static int not_finite(steif_pencil *p, stf_pair b)
{
  const double norm = sqrt(N_VDotProd(b.re, b.re) + (b.im ? N_VDotProd(b.im, b.im) : 0));
  return (p->weights ? stf_recover : stf_fail)(
    p->ctx, STEIF_NOT_FINITE,
    isfinite(norm) ? "the products or the preconditioner made of a vector of norm %g one that "
                     "is not finite: look for the NaN or overflow in them"
                   : "the right-hand side has norm %g: look for the NaN or overflow in it",
    norm);
}

/* A callback that has left a sentence in the context is told by it; `failures` there were before. */
static int stopped(steif_pencil *p, long failures)
{
  const krylov *k = p->state;
  const bool told = stf_failures(p->ctx) > failures;
  if (told && k->transposed) return k->answer;
  if (told) return k->answer > 0 ? STEIF_RETRY : steif_status(p->ctx);
  return (k->answer > 0 ? stf_recover : stf_fail)(
    p->ctx, STEIF_CALLBACK, "%s of the operator returned %d at s = %.10g%+.10gi", k->culprit,
    k->answer, k->s.re, k->s.im);
}

/* Solve for x from a zero guess. */
static int run(steif_pencil *p, stf_pair x, stf_pair b)
{
  krylov *k = p->state;
  stf_gmres *g = &k->gmres;
  const long failures = stf_failures(p->ctx);
  const long before = g->iterations, sums = g->sums_made;
  k->answer = 0;
  const stf_map map = map_of(p, b.im != NULL);
  int answer;
  const bool deferring = p->deferred && p->deferred->on;
  if (p->deferred) p->deferred->on = map.left;
  g->deferred = p->deferred && map.left ? p->deferred : NULL, g->culprit = NULL;
  const int code = stf_gmres_solve(g, &map, b, x, &answer);
  if (p->deferred) p->deferred->on = deferring;
  if (g->culprit) k->answer = answer, k->culprit = g->culprit;
  const long iterations = g->iterations - before;
  p->stats.iterations += iterations, p->counts.sums += g->sums_made - sums;
  if (b.im) p->counts.complex_solves++, p->counts.complex_iterations += iterations;
  if (code == STF_GMRES_STOPPED) return stopped(p, failures);
  if (code == STF_GMRES_NAN) return not_finite(p, b);
  if (preconditioned(p))
    pace_add(&k->pace[b.im != NULL], code == STF_GMRES_SHORT, iterations, g->last / g->first);
  return code == STF_GMRES_SHORT ? short_of(p, &map, iterations) : STEIF_OK;
}

static int solve_by(steif_pencil *p, int nrhs, N_Vector *re, N_Vector *im)
{
  krylov *k = p->state;
  const stf_space *space = &k->gmres.space;
  for (int i = 0; i < nrhs; i++) {
    const stf_pair b = {re[i], im ? im[i] : NULL}, x = {k->x[0], im ? k->x[1] : NULL};
    STEIF_TRY(run(p, x, b));
    stf_copy(space, x.re, b.re);
    if (im) stf_copy(space, x.im, b.im);
  }
  return STEIF_OK;
}

static int solve(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im)
{
  krylov *k = p->state;
  k->s = p->shift[slot];
  return solve_by(p, nrhs, re, im);
}

/* (s E - A)^H of pairs is conj(s) E^T - A^T. */
static int transposed(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im)
{
  krylov *k = p->state;
  k->s = p->shift[slot], k->s.im = 0 - k->s.im, k->transposed = true;
  const int code = solve_by(p, nrhs, re, im);
  k->transposed = false;
  return code;
}

/* E is not asked for where it is the identity. */
static int product(steif_pencil *p, char which, N_Vector x, N_Vector out)
{
  krylov *k = p->state;
  const long failures = stf_failures(p->ctx);
  k->answer = 0;
  const int answer = which == 'E' ? times_E(p, x, &out) : times_A(p, x, out);
  if (!answer) return STEIF_OK;
  if (stf_failures(p->ctx) > failures) return answer > 0 ? STEIF_RETRY : steif_status(p->ctx);
  return (answer > 0 ? stf_recover : stf_fail)(
    p->ctx, STEIF_CALLBACK, "%s of the operator returned %d in a product", k->culprit, answer);
}

/* The preconditioner is made again as it was, with the last slot; the caller has read its point. */
static void keep(steif_pencil *p, int slot, stf_image *m)
{
  krylov *k = p->state;
  STF_KEEP(m, k->near);
  STF_KEEP(m, k->ready);
  STF_KEEP(m, k->changed);
  STF_KEEP(m, k->pace);
  if (!m->reads || m->code || slot < p->slots - 1 || !k->ready || !p->op.prepare) return;
  const long failures = stf_failures(p->ctx);
  const int answer = (p->prepare_again ? p->prepare_again : p->op.prepare)(k->near, p->op.user);
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
  .transposed = transposed,
  .product = product,
  .keep = keep,
  .close = finish,
};
