/* test_range.c: overflow, underflow, NaN, sizes: what a result may be and what is refused.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gear.h"
#include "reference.h"
#include "suite.h"
#include <string.h>

static steif_context *ctx;

static void near(int n, const double *A, const double *rows, double tolerance)
{
  double T[16], X[16];
  reference_turn(n, A, T);
  CHECK(!steif_expm(ctx, n, T, X));
  const double error = reference_error(n, X, rows);
  if (!(error <= tolerance)) printf("\n  error %.2e, allowed %.2e", error, tolerance);
  CHECK(error <= tolerance);
}

/* SciPy's issues 11839 and 19584 had NaN or overflow on stable matrices like these; values from
 * mpmath with 80 digits. */
static void stable_matrices_of_large_norm(void)
{
  ctx = steif_context_new(NULL);
  near(2, (double[]){-1, 1e6, 0, -1e6},
       (double[]){0.36787944117144232, 0.36787980905125137, 0, 0}, 1e-14);
  near(2, (double[]){-1, 0, 1e6, -1e6},
       (double[]){0.36787944117144232, 0, 0.36787980905125137, 0}, 1e-14);
  near(2, (double[]){-15000, 9000, 12000, -7200.5},
       (double[]){0.23135170423792041, 0.28918311706501616, 0.38557748942002154,
                  0.48196100663220858},
       1e-14);
  near(3, (double[]){-15000, 9000, 3.5, 12000, -7200.5, -1.25, 2, -0.75, -0.5},
       (double[]){0.28514446561519706, 0.35635708507125914, 0.44723144769755134,
                  0.47517482976036483, 0.59384608227968504, 0.74512524476535098,
                  0.17314740206324158, 0.21631755632020487, 0.76384460702189851},
       2e4 * 10 * U);
  near(3, (double[]){-1, 1500, 3, 0, -3000, 0.7, 0, 0, 2},
       (double[]){0.36787944117144232, 0.18400105427047799, 7.8397253018224102, 0, 0,
                  0.001722964446785961, 0, 0, 7.3890560989306502},
       100 * U);
  near(3, (double[]){-1500, 1, 2.5, 0, -1.25, 1, 0, 0, -750},
       (double[]){0, 0.0001911624999901185, 2.5530884806693623e-7, 0, 0.2865047968601901,
                  0.00038264413604032067, 0, 0, 0},
       100 * U);
  near(4, (double[]){-2, 300, 1, 7, -300, -2, 4, 1e5, 0, 0, -1, 3, 0, 0, 0, -4000},
       (double[]){-0.0029904522286522878, -0.13530223976047968, 0.0045040086110644508,
                  -3.3597374831600153, 0.13530223976047968, -0.0029904522286522878,
                  -0.0030252494794364963, -0.32667071830856688, 0, 0, 0.36787944117144232,
                  0.00027597857552246236, 0, 0, 0, 0},
       4e3 * 10 * U);
  steif_context_free(&ctx);
}

/* -2000 x the Laplacian of a tree on five vertices: e^A is the mean, phi_1 the mean plus -A^+.
 */
static void laplacian_of_a_tree(void)
{
  static const int edge[4][2] = {{0, 1}, {1, 2}, {1, 3}, {3, 4}};
  double A[25] = {0}, phi[50];
  for (int k = 0; k < 4; k++) {
    const int i = edge[k][0], j = edge[k][1];
    A[i + 5 * i] -= 2000, A[j + 5 * j] -= 2000, A[i + 5 * j] += 2000, A[j + 5 * i] += 2000;
  }
  ctx = steif_context_new(NULL);
  CHECK(!steif_phi_matrix(ctx, 5, 1, A, phi));
  for (int k = 0; k < 25; k++) CLOSE(phi[k], 0.2, 8000 * 10 * U);
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < 5; j++) { /* A phi_1 = e^A - I */
      double sum = 0;
      for (int k = 0; k < 5; k++) sum += A[i + 5 * k] * phi[25 + k + 5 * j];
      CLOSE_FLOOR(sum, 0.2 - (i == j), 8000 * 10 * U, 1);
    }
  CHECK(!steif_expm(ctx, 5, A, phi));
  for (int k = 0; k < 25; k++) CLOSE(phi[k], 0.2, 8000 * 10 * U);
  steif_context_free(&ctx);
}

static void entries_near_the_limits(void)
{
  double X[9];
  ctx = steif_context_new(NULL);
  near(2, (double[]){-1, 1e200, 0, -1e200},
       (double[]){0.36787944117144232, 0.36787944117144232, 0, 0}, 1e-14);
  near(2, (double[]){0.5, 1e300, 0, 0.5},
       (double[]){1.6487212707001281, 1.6487212707001281e300, 0, 1.6487212707001281}, 1e-14);
  /* The condition number is 1e308: any finite result will do. */
  CHECK(!steif_expm(ctx, 2, (double[]){-1e308, 1e308, 1e308, -1e308}, X));
  CHECK(!steif_expm(ctx, 3, (double[]){-1e5, 3, 2, 1, -1e5, 7, 5, 4, -1e5}, X));
  for (int k = 0; k < 9; k++) CHECK(X[k] == 0);
  CHECK(steif_expm(ctx, 3, (double[]){9e2, 3, 2, 1, 8e2, 7, 5, 4, 9e2}, X) == STEIF_NOT_FINITE);
  CHECK(strstr(steif_message(ctx), "range") != NULL);
  CHECK(!steif_expm(ctx, 1, (double[]){709.5}, X));
  CLOSE(X[0], exp(709.5), 4 * U);
  CHECK(steif_expm(ctx, 1, (double[]){709.9}, X) == STEIF_NOT_FINITE);
  steif_context_free(&ctx);
}

static void sizes_and_arguments(void)
{
  double A[9] = {0.3, -1.1, 0.7, 2.1, -0.4, 0.9, -1.3, 0.2, 0.6}, X[36], c = 3;
  ctx = steif_context_new(NULL);
  CHECK(!steif_expm(ctx, 0, NULL, NULL) && !steif_phi_matrix(ctx, 0, 3, NULL, NULL));
  CHECK(!steif_phi_combine(ctx, 0, 3, NULL, NULL, NULL) &&
        !steif_expm_condition(ctx, 0, NULL, &c));
  CHECK(c == 0);
  CHECK(!steif_phi_matrix(ctx, 1, 3, (double[]){-2}, X));
  CLOSE(X[3], 0.10808308959542341, 4 * U);
  CHECK(steif_expm(NULL, 3, A, X) == STEIF_BAD_INPUT);
  CHECK(steif_expm(ctx, -2, A, X) == STEIF_BAD_INPUT);
  CHECK(steif_expm(ctx, 3, NULL, X) == STEIF_BAD_INPUT);
  CHECK(steif_expm(ctx, 3, A, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_phi_matrix(ctx, 3, 9, A, X) == STEIF_BAD_INPUT);
  CHECK(steif_phi_matrix(ctx, 3, -1, A, X) == STEIF_BAD_INPUT);
  CHECK(steif_phi_combine(ctx, 3, 1, A, NULL, X) == STEIF_BAD_INPUT);
  A[5] = NAN;
  CHECK(steif_expm(ctx, 3, A, X) == STEIF_NOT_FINITE);
  CHECK(strstr(steif_message(ctx), "A(3, 2) = nan") ||
        strstr(steif_message(ctx), "A(3, 2) = -nan"));
  CHECK(steif_phi_matrix(ctx, 3, 2, A, X) == STEIF_NOT_FINITE);
  CHECK(steif_phi_combine(ctx, 3, 0, A, X, X + 9) == STEIF_NOT_FINITE);
  CHECK(steif_expm_frechet(ctx, 3, A, X, NULL, X + 9) == STEIF_NOT_FINITE);
  CHECK(steif_expm_condition(ctx, 3, A, &c) == STEIF_NOT_FINITE);
  A[5] = -INFINITY;
  CHECK(steif_expm(ctx, 3, A, X) == STEIF_NOT_FINITE);
  steif_context_free(&ctx);
}

static int every_function(steif_context *own)
{
  enum { N = 5, P = 2 };
  double A[N * N], X[(P + 1) * N * N], c;
  gear_fill(N, 3.1, 77, A);
  int code = steif_expm(own, N, A, X);
  if (!code) code = steif_phi_matrix(own, N, P, A, X);
  if (!code) code = steif_phi_combine(own, N, P, A, X, X + N * (P + 1));
  if (!code) code = steif_expm_frechet(own, N, A, A, NULL, X);
  return code ? code : steif_expm_condition(own, N, A, &c);
}

static void hunger(void) { CHECK(gear_hunger(every_function) >= 10); }

CU_TestInfo tests_of_range[] = {
  {"stable matrices of large norm give neither NaN nor overflow",
   stable_matrices_of_large_norm},
  {"2000 times the Laplacian of a tree gives the mean", laplacian_of_a_tree},
  {"results overflow or underflow only where the exponential does", entries_near_the_limits},
  {"sizes 0 and 1 work, wrong arguments are refused by name", sizes_and_arguments},
  {"every allocation may fail without crash or leak", hunger},
  CU_TEST_INFO_NULL};
