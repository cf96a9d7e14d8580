/* test_expm.c: e^A, phi functions and combinations of dense matrices against references and
 * against each other.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gear.h"
#include "reference.h"
#include "suite.h"
#include <string.h>

enum { MOST = 64 };

static steif_context *ctx;

static void below(const char *name, double error, double tolerance)
{
  if (!(error <= tolerance)) printf("\n  %s: error %.2e, allowed %.2e", name, error, tolerance);
  CHECK(error <= tolerance);
}

/* 10 cond u, cond not below 1; where recomputed corners make a matrix exact, 1e-14. */
static double allowed(const reference *r)
{
  if (!strncmp(r->name, "T10", 3) || !strncmp(r->name, "T11", 3) || !strncmp(r->name, "T15", 3))
    return 1e-14;
  return fmax(10, 10 * r->condition) * U;
}

static void references_hold(void)
{
  ctx = steif_context_new(NULL);
  for (const reference *r = references; r < references + reference_count; r++) {
    double A[16], X[16], phi[9 * 16];
    reference_turn(r->n, r->A, A);
    CHECK(!steif_expm(ctx, r->n, A, X));
    below(r->name, reference_error(r->n, X, r->f[0]), allowed(r));
    for (int p = 1; p <= STEIF_PHI_MOST; p++) {
      CHECK(!steif_phi_matrix(ctx, r->n, p, A, phi));
      for (int l = 0; l <= p && l <= REFERENCE_P; l++)
        below(r->name, reference_error(r->n, phi + r->n * r->n * l, r->f[l]), allowed(r));
    }
  }
  steif_context_free(&ctx);
}

/* The transposed matrix has the transposed functions, but meets the code as lower triangular.
 */
static void transposes(void)
{
  ctx = steif_context_new(NULL);
  for (const reference *r = references; r < references + reference_count; r++) {
    double T[16], phi[4 * 16], back[16];
    memcpy(T, r->A, sizeof T);
    CHECK(!steif_phi_matrix(ctx, r->n, REFERENCE_P, T, phi));
    for (int l = 0; l <= REFERENCE_P; l++) {
      reference_turn(r->n, phi + r->n * r->n * l, back);
      below(r->name, reference_error(r->n, back, r->f[l]), 4 * allowed(r));
    }
  }
  steif_context_free(&ctx);
}

/* w = sum phi_k(A) b_k with b_k = (k+1) (1, 2, .., n)^T, k <= 3; mpmath, 17 digits. */
static void combinations(void)
{
  static const struct {
    const char *id;
    double w[4], tolerance;
  } rows[] = {
    {"T12",
     {3.2642411176571154, 2.8695523913663735, 0.60814233940844749, 0.38526530975953938},
     81.3 * U},
    {"T09", {-2.5982411139181827, -11.058964459411663, -7.7947233417545481}, 1.53e5 * U},
    {"T11", {293998840.2203011, 3.4420743668564019}, 1e-14}};
  ctx = steif_context_new(NULL);
  for (int r = 0; r < 3; r++) {
    const reference *T = reference_find(rows[r].id);
    double A[16], b[16], w[4], error = 0, norm = 0;
    reference_turn(T->n, T->A, A);
    for (int k = 0; k < 4; k++)
      for (int i = 0; i < T->n; i++) b[i + T->n * k] = (k + 1) * (i + 1);
    CHECK(!steif_phi_combine(ctx, T->n, 3, A, b, w));
    for (int i = 0; i < T->n; i++)
      error += fabs(w[i] - rows[r].w[i]), norm += fabs(rows[r].w[i]);
    below(T->name, error / norm, rows[r].tolerance);
  }
  steif_context_free(&ctx);
}

/* HiPPO-LegS: A_ik = -sqrt((2i+1)(2k+1)) below, -(i+1) on the diagonal; B_i = sqrt(2i+1). Trace
 * and norm of e^{A dt}, its corner and the first entry of dt phi_1(A dt) B; mpmath. */
static void legs(void)
{
  static const struct {
    int n;
    double dt, trace, norm, corner, first;
  } rows[] = {
    {8, 0.01, 7.6499876041343015, 2.7297584458305419, -0.028722762147895035,
     0.0099501662508319464},
    {16, 0.1, 7.588632833187617, 3.4054585979076486, -0.01229772752741783,
     0.095162581964040427},
    {32, 0.1, 9.1207513785481135, 4.8143816234392227, -0.0018915433780759043,
     0.095162581964040427},
    {64, 0.01, 47.034797730040096, 7.703122697553699, 0.0023454373748786571,
     0.0099501662508319464},
    {64, 0.1, 9.4925333066764566, 6.8078781279266152, -0.0066434881647021519,
     0.095162581964040427},
    {64, 1, 0.58197670686932642, 3.12539705408679, -0.002573771440691591, 0.63212055882855768}};
  static double A[MOST * MOST], phi[2 * MOST * MOST];
  ctx = steif_context_new(NULL);
  for (int r = 0; r < 6; r++) {
    const int n = rows[r].n;
    const double dt = rows[r].dt;
    double trace = 0, square = 0, first = 0;
    for (int k = 0; k < n; k++)
      for (int i = 0; i < n; i++)
        A[i + n * k] = i > k    ? -sqrt((2. * i + 1) * (2. * k + 1)) * dt
                       : i == k ? -(i + 1) * dt
                                : 0;
    CHECK(!steif_phi_matrix(ctx, n, 1, A, phi));
    for (int k = 0; k < n; k++) first += dt * phi[n * n + n * k] * sqrt(2. * k + 1);
    for (int route = 0; route < 2; route++) {
      if (route == 1) CHECK(!steif_expm(ctx, n, A, phi));
      trace = square = 0;
      for (int i = 0; i < n; i++) trace += phi[i + n * i];
      for (int i = 0; i < n * n; i++) square += phi[i] * phi[i];
      CLOSE(trace, rows[r].trace, 1e-13);
      CLOSE(sqrt(square), rows[r].norm, 1e-13);
      CLOSE_FLOOR(phi[n - 1], rows[r].corner, 1e-13, rows[r].norm);
    }
    CLOSE(first, rows[r].first, 1e-13);
  }
  steif_context_free(&ctx);
}

/* e^{A} = (e^{A/2})^2 over norms that take every degree, several squarings, products of norms
 * both exact and estimated. */
static void degrees_agree(void)
{
  static double A[MOST * MOST], X[MOST * MOST], half[MOST * MOST], square[MOST * MOST];
  ctx = steif_context_new(NULL);
  for (int n = 3; n <= 48; n *= 2)
    for (double size = 4e-3; size < 90; size *= 2.9) {
      gear_fill(n, size / n, 4711u + (unsigned)n, A);
      CHECK(!steif_expm(ctx, n, A, X));
      for (int k = 0; k < n * n; k++) A[k] /= 2;
      CHECK(!steif_expm(ctx, n, A, half));
      gear_times(n, half, half, square);
      below("half", gear_distance(n, X, square), 30 * n * (1 + size) * U);
      for (int k = 0; k < n * n; k++) A[k] *= -2;
      CHECK(!steif_expm(ctx, n, A, half));
      gear_times(n, half, X, square);
      for (int i = 0; i < n; i++) square[i + n * i] -= 1;
      double worst = 0;
      for (int k = 0; k < n * n; k++) worst = fmax(worst, fabs(square[k]));
      below("inverse", worst, 30 * n * (1 + size) * exp(1.2 * size / sqrt(n)) * U);
    }
  steif_context_free(&ctx);
}

/* phi_l(A) = A phi_{l+1}(A) + I/l! and e^A by both routes; the combination against the sum. */
static void routes_agree(void)
{
  enum { P = 5, N = 40 };
  static double A[N * N], phi[(P + 1) * N * N], X[N * N], T[N * N], b[N * (P + 1)];
  double w[N], sum[N], factorial = 1;
  unsigned seed = 90127;
  ctx = steif_context_new(NULL);
  for (double size = 2e-2; size < 60; size *= 5.3, factorial = 1) {
    gear_fill(N, size / N, seed, A);
    for (int k = 0; k < N * (P + 1); k++) b[k] = gear_random(&seed);
    CHECK(!steif_phi_matrix(ctx, N, P, A, phi));
    CHECK(!steif_expm(ctx, N, A, X));
    below("both", gear_distance(N, phi, X), 1e3 * (1 + size) * U);
    for (int l = 0; l < P; l++, factorial *= l) {
      gear_times(N, A, phi + N * N * (l + 1), T);
      for (int i = 0; i < N; i++) T[i + N * i] += 1 / factorial;
      below("recurrence", gear_distance(N, T, phi + N * N * l), 1e3 * (1 + size) * U);
    }
    CHECK(!steif_phi_combine(ctx, N, P, A, b, w));
    double norm = 0, error = 0;
    for (int i = 0; i < N; i++) {
      sum[i] = 0;
      for (int k = 0; k < N * (P + 1); k++) sum[i] += phi[i + N * k] * b[k];
      norm = fmax(norm, fabs(sum[i])), error = fmax(error, fabs(w[i] - sum[i]));
    }
    below("combination", error / norm, 1e3 * (1 + size) * U);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_expm[] = {
  {"22 matrices meet their references, for every p", references_hold},
  {"their transposes meet the transposed references", transposes},
  {"combinations of phi functions meet their references", combinations},
  {"HiPPO-LegS meets its references up to n = 64", legs},
  {"all degrees and squarings agree with the square and the inverse", degrees_agree},
  {"phi functions obey their recurrence, combinations are their sums", routes_agree},
  CU_TEST_INFO_NULL};
