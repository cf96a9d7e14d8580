/* test_krylov.c: pencils known by their products, on any kind of vector.
 *
 * The operator is the heat equation's: A = the second difference on N points with ends held at 0,
 * E = diag(1 + i / N). Its vectors are serial, or ManyVectors of two parts of unequal length.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include "suite.h"
#include <nvector/nvector_manyvector.h>
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#if defined(HAVE_NVECTOR_OPENMP)
#include <nvector/nvector_openmp.h>
#endif

enum { N = 60, CUT = 23 };

typedef struct heat {
  int fail_after, answer; /* A returns `answer` after so many calls; 0: never */
  int products, preconditions, preparations, refuse; /* refuse: what prepare returns */
  double last_shift, prepared;
} heat;

/* The entries of a vector, whatever it is made of. */
static double *entry(N_Vector v, int i)
{
  if (N_VGetVectorID(v) != SUNDIALS_NVEC_MANYVECTOR) return N_VGetArrayPointer(v) + i;
  const int second = i >= CUT;
  return N_VGetArrayPointer(N_VGetSubvector_ManyVector(v, second)) + i - (second ? CUT : 0);
}

static double at(N_Vector v, int i) { return i < 0 || i >= N ? 0 : *entry(v, i); }
static double mass(int i) { return 1 + (double)i / N; }

static int times_A(N_Vector x, N_Vector out, void *user)
{
  heat *h = user;
  if (++h->products > h->fail_after && h->answer) return h->answer;
  for (int i = 0; i < N; i++) *entry(out, i) = at(x, i - 1) - 2 * at(x, i) + at(x, i + 1);
  return 0;
}

static int times_E(N_Vector x, N_Vector out, void *user)
{
  (void)user;
  for (int i = 0; i < N; i++) *entry(out, i) = mass(i) * at(x, i);
  return 0;
}

/* Exact: elimination of the tridiagonal matrix s E - A. */
static int eliminate(sunrealtype s, N_Vector r, N_Vector z, sunrealtype tolerance, void *user)
{
  heat *h = user;
  double d[N];
  (void)tolerance;
  h->preconditions++, h->last_shift = s;
  for (int i = 0; i < N; i++) {
    d[i] = s * mass(i) + 2 - (i ? 1 / d[i - 1] : 0);
    *entry(z, i) = at(r, i) + (i ? at(z, i - 1) / d[i - 1] : 0);
  }
  for (int i = N - 1; i >= 0; i--) *entry(z, i) = (at(z, i) + at(z, i + 1)) / d[i];
  return 0;
}

static int get_ready(sunrealtype s, void *user)
{
  heat *h = user;
  h->preparations++, h->prepared = s;
  return h->refuse;
}

static N_Vector serial(SUNContext sun) { return N_VNew_Serial(N, sun); }

static N_Vector many(SUNContext sun)
{
  N_Vector part[2] = {N_VNew_Serial(CUT, sun), N_VNew_Serial(N - CUT, sun)};
  return N_VNew_ManyVector(2, part, sun);
}

/* N_VNew_ManyVector leaves the parts to the caller. */
static void destroy(N_Vector v)
{
  if (N_VGetVectorID(v) == SUNDIALS_NVEC_MANYVECTOR)
    for (int i = 0; i < 2; i++) N_VDestroy(N_VGetSubvector_ManyVector(v, i));
  N_VDestroy(v);
}

static double right_side(int i, int part) { return sin(1.3 * i + 0.7 * part) + 0.21 * part; }

/* max |(s E - A) x - b| with b as right_side() has it. */
static double residual(steif_shift s, N_Vector re, N_Vector im)
{
  double worst = 0;
  for (int i = 0; i < N; i++) {
    const double ar = at(re, i - 1) - 2 * at(re, i) + at(re, i + 1);
    const double ai = at(im, i - 1) - 2 * at(im, i) + at(im, i + 1);
    const double er = mass(i) * at(re, i), ei = mass(i) * at(im, i);
    worst = fmax(worst, fabs(s.re * er - s.im * ei - ar - right_side(i, 0)));
    worst = fmax(worst, fabs(s.re * ei + s.im * er - ai - right_side(i, 1)));
  }
  return worst;
}

typedef struct bench {
  steif_context *ctx;
  heat h;
  steif_operator op;
  N_Vector re, im;
  steif_pencil *p;
} bench;

static void begin(bench *b, N_Vector (*make)(SUNContext), bool preconditioned, int dimension,
                  int restarts)
{
  memset(b, 0, sizeof *b);
  b->ctx = steif_context_new(NULL);
  b->op = (steif_operator){.E = times_E,
                           .A = times_A,
                           .precondition = preconditioned ? eliminate : NULL,
                           .user = &b->h,
                           .dimension = dimension,
                           .restarts = restarts};
  b->re = make(steif_sundials(b->ctx)), b->im = make(steif_sundials(b->ctx));
  for (int i = 0; i < N; i++)
    *entry(b->re, i) = right_side(i, 0), *entry(b->im, i) = right_side(i, 1);
  b->p = steif_pencil_new_operator(b->ctx, &b->op, b->re);
}

static void end(bench *b)
{
  steif_pencil_free(&b->p);
  destroy(b->re), destroy(b->im);
  steif_context_free(&b->ctx);
}

static const steif_shift shifts[] = {{0.83, 0}, {0.41, 2.6}, {0.09, -0.37}};

static void on(N_Vector (*make)(SUNContext), double *solution)
{
  for (int k = 0; k < 3; k++) {
    bench b;
    begin(&b, make, false, 0, 0);
    CU_ASSERT_FATAL(b.p != NULL);
    CHECK(steif_pencil_factor(b.p, 3, shifts) == STEIF_OK);
    CHECK(steif_pencil_solve(b.p, k, 1, &b.re, &b.im) == STEIF_OK);
    /* The default tolerance 1e-10 is relative to |b|_2 < sqrt(2 N) 1.3 < 15. */
    CHECK(residual(shifts[k], b.re, b.im) < 1.5e-9);
    CHECK(steif_pencil_statistics(b.p)->iterations > 5);
    for (int i = 0; i < N; i++)
      solution[2 * (k * N + i)] = at(b.re, i), solution[2 * (k * N + i) + 1] = at(b.im, i);
    end(&b);
  }
}

static void any_vector(void)
{
  static double plain[6 * N], parts[6 * N];
  on(serial, plain);
  on(many, parts);
  for (int i = 0; i < 6 * N; i++) CLOSE_FLOOR(parts[i], plain[i], 1e-8, 1);
}

#if defined(HAVE_NVECTOR_OPENMP)
static N_Vector threaded(SUNContext sun) { return N_VNew_OpenMP(N, 2, sun); }

static void openmp_vector(void)
{
  static double plain[6 * N], parts[6 * N];
  on(serial, plain);
  on(threaded, parts);
  for (int i = 0; i < 6 * N; i++) CLOSE_FLOOR(parts[i], plain[i], 1e-8, 1);
}
#endif

static void preconditioned(void)
{
  bench b;
  begin(&b, many, true, 0, 0);
  const steif_pencil_stats *stats = steif_pencil_statistics(b.p);
  CHECK(steif_pencil_factor(b.p, 3, shifts) == STEIF_OK);
  N_Vector once = N_VClone(b.re);
  N_VScale(1, b.re, once);
  CHECK(steif_pencil_solve(b.p, 0, 1, &once, NULL) == STEIF_OK);
  CHECK(stats->iterations == 1 && b.h.last_shift == 0.83);
  N_VDestroy(once);
  CHECK(steif_pencil_solve(b.p, 1, 1, &b.re, &b.im) == STEIF_OK);
  CHECK(residual(shifts[1], b.re, b.im) < 1.5e-9);
  /* |0.41 + 2.6 i|, which takes 46 iterations where the shift 0.41 takes 120. */
  CLOSE(b.h.last_shift, 2.6321284163201462, 1e-15);
  CHECK(stats->iterations <= 60);
  end(&b);
}

/* Prepared for the first shift, kept within a factor of 2 while the products are the same. */
static void prepared(void)
{
  static const double re[] = {0.8, 1.5, 0.41, 0.79, 1.7}, near[] = {0.8, 0.8, 0.8, 0.8, 1.7};
  static const int count[] = {1, 1, 1, 1, 2};
  bench b;
  begin(&b, serial, true, 0, 0);
  steif_pencil_free(&b.p);
  b.op.prepare = get_ready;
  b.p = steif_pencil_new_operator(b.ctx, &b.op, b.re);
  for (int k = 0; k < 5; k++) {
    CHECK(steif_pencil_factor(b.p, 1, &(steif_shift){re[k], 0}) == STEIF_OK);
    CHECK(steif_pencil_solve(b.p, 0, 1, &b.re, NULL) == STEIF_OK);
    CHECK(b.h.preparations == count[k] && b.h.last_shift == near[k]);
  }
  CHECK(steif_pencil_update(b.p) == STEIF_OK);
  CHECK(steif_pencil_factor(b.p, 1, &(steif_shift){1.7, 0}) == STEIF_OK);
  CHECK(b.h.preparations == 3 && steif_pencil_statistics(b.p)->factors == 3);
  for (int k = 0; k < 2; k++) {
    b.h.refuse = k ? -4 : 4;
    CHECK(steif_pencil_factor(b.p, 1, &(steif_shift){9 + k, 0}) ==
          (k ? STEIF_CALLBACK : STEIF_RETRY));
    CHECK(strstr(steif_message(b.ctx), k ? "returned -4" : "returned 4") != NULL);
  }
  b.h.refuse = 0; /* what failed is not ready */
  CHECK(steif_pencil_factor(b.p, 1, &(steif_shift){10, 0}) == STEIF_OK);
  CHECK(b.h.preparations == 6 && b.h.prepared == 10);
  end(&b);
}

/* The aim decides how many iterations are made, and the weighted error of x is about the aim: 2 for the
 * weights, of a complex shift, whose preconditioner is that of another. */
static void aimed(void)
{
  long before = 1000;
  for (double aim = 1e-9; aim < 1e-2; aim *= 1e3) {
    bench b;
    begin(&b, many, true, 0, 0);
    N_Vector x[2] = {N_VClone(b.re), N_VClone(b.re)}, w = N_VClone(b.re);
    for (int i = 0; i < 2; i++) N_VScale(1, i ? b.im : b.re, x[i]);
    const long *iterations = &steif_pencil_statistics(b.p)->iterations;
    CHECK(steif_pencil_factor(b.p, 3, shifts) == STEIF_OK);
    CHECK(steif_pencil_solve(b.p, 1, 1, &x[0], &x[1]) == STEIF_OK);
    const long whole = *iterations;
    N_VConst(2, w);
    stf_pencil_aim(b.p, w, aim);
    CHECK(steif_pencil_update(b.p) == STEIF_OK);
    CHECK(steif_pencil_factor(b.p, 3, shifts) == STEIF_OK);
    CHECK(steif_pencil_solve(b.p, 1, 1, &b.re, &b.im) == STEIF_OK);
    CHECK(*iterations - whole < before);
    before = *iterations - whole;
    double sum = 0;
    for (int i = 0; i < N; i++)
      sum += pow(at(b.re, i) - at(x[0], i), 2) + pow(at(b.im, i) - at(x[1], i), 2);
    const double error = 2 * sqrt(sum / (2 * N));
    CHECK(error < 3 * aim && error > 1e-3 * aim);
    for (int i = 0; i < 2; i++) N_VDestroy(x[i]);
    N_VDestroy(w);
    end(&b);
  }
}

static void not_converged(void)
{
  bench b;
  begin(&b, serial, false, 3, 1);
  CHECK(steif_pencil_factor(b.p, 2, shifts) == STEIF_OK);
  for (int k = 0; k < 2; k++) {
    CHECK(steif_pencil_solve(b.p, k, 1, &b.re, &b.im) == STEIF_NO_CONVERGENCE);
    CHECK(strstr(steif_message(b.ctx), "GMRES left a residual") != NULL);
    for (int i = 0; i < N; i++) CHECK(at(b.re, i) == right_side(i, 0));
  }
  end(&b);
}

static void callbacks_fail(void)
{
  static const int answers[] = {3, -2}, codes[] = {STEIF_RETRY, STEIF_CALLBACK};
  for (int k = 0; k < 2; k++) {
    bench b;
    begin(&b, serial, false, 0, 0);
    CHECK(steif_pencil_factor(b.p, 2, shifts) == STEIF_OK);
    b.h.fail_after = 4, b.h.answer = answers[k];
    CHECK(steif_pencil_solve(b.p, 1, 1, &b.re, &b.im) == codes[k]);
    CHECK(strstr(steif_message(b.ctx),
                 k ? "A of the operator returned -2" : "A of the operator returned 3") != NULL);
    CHECK(steif_pencil_product(b.p, 'A', b.re, b.im) == codes[k]);
    b.h.answer = 0;
    CHECK(steif_pencil_solve(b.p, 1, 1, &b.re, &b.im) == STEIF_OK);
    end(&b);
  }
}

static void zero_and_nan(void)
{
  bench b;
  begin(&b, many, false, 0, 0);
  CHECK(steif_pencil_factor(b.p, 1, shifts) == STEIF_OK);
  N_VConst(0, b.re);
  CHECK(steif_pencil_solve(b.p, 0, 1, &b.re, NULL) == STEIF_OK && N_VMaxNorm(b.re) == 0);
  *entry(b.re, 31) = NAN;
  CHECK(steif_pencil_solve(b.p, 0, 1, &b.re, NULL) == STEIF_NOT_FINITE);
  end(&b);
}

/* A matrix pencil asks for host arrays, which a ManyVector does not have. */
static void no_host_array(void)
{
  bench b;
  begin(&b, many, false, 0, 0);
  SUNMatrix A = SUNDenseMatrix(N, N, steif_sundials(b.ctx));
  steif_pencil *p = steif_pencil_new(b.ctx, NULL, A);
  CHECK(steif_pencil_factor(p, 1, shifts) == STEIF_OK);
  CHECK(steif_pencil_solve(p, 0, 1, &b.re, NULL) == STEIF_UNSUPPORTED);
  steif_pencil_free(&p);
  SUNMatDestroy(A);
  end(&b);
}

CU_TestInfo tests_of_krylov[] = {
  {"serial and ManyVector solutions agree, real and complex", any_vector},
#if defined(HAVE_NVECTOR_OPENMP)
  {"OpenMP vectors give the serial solution", openmp_vector},
#endif
  {"an exact preconditioner takes one iteration; a complex shift its modulus", preconditioned},
  {"prepared again for new products and shifts twice as large", prepared},
  {"an aim decides how far a solve goes", aimed},
  {"no convergence says what was reached and leaves b", not_converged},
  {"what a callback returns becomes retry or stop", callbacks_fail},
  {"a zero right-hand side gives zero, NaN is refused", zero_and_nan},
  {"matrices refuse vectors without host array", no_host_array},
  CU_TEST_INFO_NULL,
};
