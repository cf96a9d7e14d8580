/* test_hamiltonian.c: which linear systems are Hamiltonian. The answers to the examples are
 * those of their Jordan forms, by hand.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <stdlib.h>
#include <string.h>

static steif_context *ctx;

static steif_hamiltonian asked(int n, const double *A, double tolerance)
{
  steif_hamiltonian h;
  const int code = steif_hamiltonian_find(ctx, n, A, tolerance, &h);
  if (code) printf("\n  %s", steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  return h;
}

static const steif_hamiltonian_example *example(const char *name)
{
  const steif_hamiltonian_example *e;
  for (size_t i = 0; (e = steif_hamiltonian_example_at(i)); i++)
    if (!strcmp(e->name, name)) return e;
  CU_FAIL_FATAL("no such example");
  return NULL;
}

static int answers_are(const steif_hamiltonian *h, const steif_hamiltonian_example *e)
{
  const int good = h->definite == e->definite && h->nonsingular == e->nonsingular &&
                   h->symplectic == e->symplectic && h->invariant == e->invariant &&
                   h->dimension == e->dimension;
  if (!good)
    printf("\n  %s: %d %d %d %d, dimension %d: %s", e->name, h->definite, h->nonsingular,
           h->symplectic, h->invariant, h->dimension, h->message);
  return good;
}

static double entry(int n, const double *A, int i, int j) { return A[i + n * j]; }

/* max |A^T P + P A|, and whether P = sign P^T. */
static double residual(int n, const double *A, const double *P, int sign)
{
  double most = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double sum = 0;
      for (int k = 0; k < n; k++)
        sum += entry(n, A, k, i) * entry(n, P, k, j) + entry(n, P, i, k) * entry(n, A, k, j);
      most = fmax(most, fabs(sum));
      CHECK(entry(n, P, i, j) == sign * entry(n, P, j, i));
    }
  return most;
}

static void forms_are_solutions(const steif_hamiltonian *h, int n, const double *A, double size)
{
  CHECK(!h->symmetric.P == (h->invariant != 1 && !(h->symmetric.distance < STEIF_NEAR)));
  CHECK(!h->skew.P == (h->symplectic != 1));
  if (h->symmetric.P) CHECK(residual(n, A, h->symmetric.P, 1) < size);
  if (h->skew.P) CHECK(residual(n, A, h->skew.P, -1) < size);
  if (h->nonsingular == 1) CHECK(h->symmetric.condition < 1e3 && h->symmetric.distance < size);
  if (h->symplectic == 1) CHECK(h->skew.condition < 1e3 && h->skew.distance < size);
}

static void examples_have_their_answers(void)
{
  const steif_hamiltonian_example *e;
  size_t i = 0;
  for (; (e = steif_hamiltonian_example_at(i)); i++) {
    steif_hamiltonian h = asked(e->n, e->A, 0);
    CHECK(answers_are(&h, e));
    forms_are_solutions(&h, e->n, e->A, strcmp(e->name, "barely") ? 1e-13 : 1e-8);
    steif_hamiltonian_clear(ctx, &h);
  }
  CHECK(i == 22);
}

static void near(const char *name, const double *P)
{
  const steif_hamiltonian_example *e = example(name);
  steif_hamiltonian h = asked(e->n, e->A, 0);
  CU_ASSERT_FATAL(h.symmetric.P != NULL);
  for (int i = 0; i < e->n * e->n; i++) CLOSE_FLOOR(h.symmetric.P[i], P[i], 4e-15, 1);
  steif_hamiltonian_clear(ctx, &h);
}

/* The mean of e^{A^T t} e^{A t}: 1 for a skew A; for q'' = -4 q that of diag(cos^2 + 4 sin^2, sin^2/4
 * + cos^2) at 2t. */
static void canonical_forms_are_time_averages(void)
{
  near("rotation", (const double[]){1, 0, 0, 1});
  near("spin", (const double[]){1, 0, 0, 0, 1, 0, 0, 0, 1});
  near("resting", (const double[]){1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  near("oscillator", (const double[]){2.5, 0, 0, 0.625});
  near("masses",
       (const double[]){2.125, -.5, 0, 0, -.5, 2.25, 0, 0, 0, 0, .75, .125, 0, 0, .125, .625});
  near("gyroscope3",
       (const double[]){1.8, 0, 0, 1.2, 0, 1.8, -1.2, 0, 0, -1.2, 1.8, 0, 1.2, 0, 0, 1.8});
}

/* Damped by 1e-9: no by rounding, yes to 1e-9, and nobody knows just between. */
static void the_tolerance_decides_what_is_nearly_so(void)
{
  const steif_hamiltonian_example *e = example("barely");
  static const struct {
    double tolerance;
    int answer;
  } rows[] = {{0, 0}, {1e-12, 0}, {2e-11, -1}, {1e-9, 1}, {1e-7, 1}};
  for (int i = 0; i < 5; i++) {
    steif_hamiltonian h = asked(2, e->A, rows[i].tolerance);
    CHECK(h.definite == rows[i].answer && h.symplectic == rows[i].answer);
    CLOSE(h.symmetric.residual, 1.25e-10, 0.3);
    CLOSE(h.symmetric.distance, 1.7e-10, 0.3);
    CHECK(strstr(h.message, "definite: ") == h.message);
    if (rows[i].answer == 0) CHECK(strstr(h.message, "e-10 of its size") != NULL);
    if (rows[i].answer < 0) CHECK(strstr(h.message, "undecided") && h.dimension == -1);
    steif_hamiltonian_clear(ctx, &h);
  }
}

/* -- invariance ---------------------------------------------------------------------------------- */

static double noise(unsigned *seed)
{
  *seed = *seed * 1664525u + 1013904223u;
  return (double)(*seed >> 8) / 8388608.0 - 1;
}

/* A becomes X^{-1} A X, X a product of elementary matrices 1 + c e_i e_j^T. */
static void disguise(int n, double *A, int factors, double c, unsigned *seed)
{
  for (int f = 0; f < factors; f++) {
    const double x = c * noise(seed);
    const int i = (int)((noise(seed) + 1) / 2 * n), j = (i + 1 + f % (n - 1)) % n;
    for (int k = 0; k < n; k++) A[k + n * j] += x * A[k + n * i];
    for (int k = 0; k < n; k++) A[i + n * k] -= x * A[j + n * k];
  }
}

/* Entries are rounded on the way: the tolerance allows it. The damping of `barely` drowns in that. */
static void answers_do_not_depend_on_the_basis(void)
{
  unsigned seed = 20240612;
  const steif_hamiltonian_example *e;
  for (size_t i = 0; (e = steif_hamiltonian_example_at(i)); i++)
    for (int k = 0; k < 20; k++) {
      double A[16];
      if (!strcmp(e->name, "barely")) continue;
      memcpy(A, e->A, (size_t)(e->n * e->n) * sizeof *A);
      disguise(e->n, A, 3 * e->n, k % 2 ? 1 : 4, &seed);
      steif_hamiltonian h = asked(e->n, A, 1e-14);
      CHECK(answers_are(&h, e));
      steif_hamiltonian_clear(ctx, &h);
    }
}

static void large(int n, double c, int factors)
{
  unsigned seed = 77;
  double *A = calloc((size_t)(n * n), sizeof *A);
  CU_ASSERT_FATAL(A != NULL);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++) {
      const double x = noise(&seed);
      A[i + n * j] = x, A[j + n * i] = -x;
    }
  disguise(n, A, factors, c, &seed);
  steif_hamiltonian h = asked(n, A, 0);
  CHECK(h.definite == 1 && h.nonsingular == 1 && h.invariant == 1);
  CHECK(h.symplectic == (n % 2 == 0));
  CHECK(h.dimension == (n + 1) / 2);
  CHECK(h.symmetric.residual < 1e-14 && h.symmetric.condition < 1e10);
  A[0] += 1e-3;
  steif_hamiltonian_clear(ctx, &h);
  h = asked(n, A, 0);
  CHECK(h.definite == 0 && h.nonsingular == 0 && h.symplectic == 0);
  steif_hamiltonian_clear(ctx, &h);
  free(A);
}

static void larger_systems_are_answered(void)
{
  large(50, 1, 50);
  large(51, 1, 100);
  large(80, 3, 80);
}

static void zero_of_any_order(void)
{
  static const double A[60 * 60];
  steif_hamiltonian h = asked(60, A, 0);
  CHECK(h.definite == 1 && h.symplectic == 1 && h.dimension == 60 * 61 / 2);
  CHECK(h.symmetric.residual == 0 && h.symmetric.distance == 0);
  steif_hamiltonian_clear(ctx, &h);
}

/* -- rejections ------------------------------------------------------------------------------------ */

static void bad_questions_are_rejected(void)
{
  steif_hamiltonian h;
  const double A[] = {0, -1, 1, NAN};
  CHECK(steif_hamiltonian_find(ctx, 2, A, 0, &h) == STEIF_NOT_FINITE);
  CHECK(strstr(steif_message(ctx), "A(2, 2)") != NULL);
  CHECK(steif_hamiltonian_find(ctx, 0, A, 0, &h) == STEIF_BAD_INPUT);
  CHECK(steif_hamiltonian_find(ctx, 2, NULL, 0, &h) == STEIF_BAD_INPUT);
  CHECK(steif_hamiltonian_find(ctx, 1, A, -1, &h) == STEIF_BAD_INPUT);
  CHECK(steif_hamiltonian_find(ctx, 1, A, NAN, &h) == STEIF_BAD_INPUT);
  CHECK(steif_hamiltonian_find(ctx, 1, A, 0, NULL) == STEIF_BAD_INPUT);
  steif_hamiltonian_clear(ctx, &h);
  steif_hamiltonian_clear(ctx, NULL);
}

static void *stingy(size_t bytes, void *left)
{
  return (*(int *)left)-- > 0 ? malloc(bytes) : NULL;
}
static void give_back(void *block, void *left) { (void)left, free(block); }

static void memory_may_end_anywhere(void)
{
  const steif_hamiltonian_example *e = example("resonance");
  int tries = 0, done = 0;
  for (; !done && tries < 100; tries++) {
    int left = 100;
    steif_context *poor = steif_context_new(
      &(steif_setup){.allocate = stingy, .release = give_back, .user = &left});
    steif_hamiltonian h;
    left = tries;
    const int code = steif_hamiltonian_find(poor, e->n, e->A, 0, &h);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    done = code == STEIF_OK;
    steif_hamiltonian_clear(poor, &h);
    left = 100;
    steif_context_free(&poor);
  }
  CHECK(done && tries > 10);
}

static void opened(void) { ctx = steif_context_new(NULL); }
static void closed(void) { steif_context_free(&ctx); }

CU_TestInfo tests_of_hamiltonian[] = {
  {"a context opens", opened},
  {"the examples have their answers", examples_have_their_answers},
  {"canonical forms are averages over time", canonical_forms_are_time_averages},
  {"the tolerance decides what is nearly so", the_tolerance_decides_what_is_nearly_so},
  {"answers do not depend on the basis", answers_do_not_depend_on_the_basis},
  {"larger systems are answered", larger_systems_are_answered},
  {"zero of any order", zero_of_any_order},
  {"bad questions are rejected", bad_questions_are_rejected},
  {"memory may end anywhere", memory_may_end_anywhere},
  {"the context closes", closed},
  CU_TEST_INFO_NULL};
