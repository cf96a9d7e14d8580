/* test_units.c: verdicts that must not depend on the units of equations and unknowns, on entries that
 * may be rounding, or on rounding alone.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse/families.h"
#include "prime_field.h"
#include "generated.h"
#include "impulse/systems.h"

static const enum steif_algorithm ways[] = {STEIF_STAIRCASE, STEIF_QZ, STEIF_CONTOUR};
enum { WAYS = 3 };

/* x_1 = -x_2' / a, ...: N x' + diag(a, b, d) x = 0 with N the shift. From x(0-) = (x, y, z) follow
 * x(0+) = 0, c_0 = (y / a, z / b, 0) and c_1 = (-z / (a b), 0, 0). */
static void a_shift_beside_any_diagonal(void)
{
  static const double of[][3] = {
    {1e300, 1e-300, 1}, {1, 1e-300, 1}, {1e-300, 1, 1}, {1, 1e-20, 1e20}, {3e-9, 7e40, 5e-80}};
  const double E[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, x0[3] = {0.7, -1.3, 2.9};
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 5; k++)
    for (int w = 0; w < WAYS; w++) {
      const double F[9] = {of[k][0], 0, 0, 0, of[k][1], 0, 0, 0, of[k][2]};
      SUNMatrix e = dense(ctx, 3, E), f = dense(ctx, 3, F);
      const steif_analysis a = {.algorithm = ways[w]};
      steif_structure s;
      steif_impulse i;
      CHECK(steif_structure_find(ctx, e, f, &a, &s) == STEIF_OK);
      CHECK(s.regular && s.index == 3 && s.finite == 0 && s.certified);
      CHECK(steif_impulse_find(ctx, e, f, x0, 0, NULL, NULL, &a, &s, &i) == STEIF_OK);
      CHECK(i.count == 2 && (i.certified || ways[w] == STEIF_CONTOUR));
      for (int j = 0; j < 3 && ways[w] != STEIF_CONTOUR; j++)
        CHECK(fabs(i.x_plus[j]) <= 1e-13 * fmax(1, fmax(fabs(i.c[j]), fabs(i.c[3 + j]))));
      if (ways[w] != STEIF_CONTOUR) { /* which is right in norm alone */
        CLOSE(i.c[0], x0[1] / F[0], 1e-12);
        CLOSE(i.c[1], x0[2] / F[4], 1e-12);
        CLOSE(i.c[3], -x0[2] / F[0] / F[4], 1e-12);
      }
      steif_impulse_clear(ctx, &i), steif_structure_clear(ctx, &s);
      SUNMatDestroy(e), SUNMatDestroy(f);
    }
  steif_context_free(&ctx);
}

/* The 5 x 5 pencil with x(0-) = (1, 2, 3, 4, 5) and f = 0 has x(0+) = Pi_s x(0-) = (4, 10, 0, 0, 0)
 * in whole numbers; units of 2^-120 .. 2^120 move them by powers of 2. */
static void five_by_five_in_any_units(void)
{
  static const int row[5] = {90, -117, 3, -64, 120}, column[5] = {-33, 111, -120, 7, 58};
  static const double plus[5] = {4, 10, 0, 0, 0};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  double x0[5];
  for (int j = 0; j < 5; j++) {
    x0[j] = ldexp(j + 1, -column[j]);
    for (int i = 0; i < 5; i++) {
      SM_ELEMENT_D(E, i, j) = ldexp(SM_ELEMENT_D(E, i, j), row[i] + column[j]);
      SM_ELEMENT_D(F, i, j) = ldexp(SM_ELEMENT_D(F, i, j), row[i] + column[j]);
    }
  }
  for (int w = 0; w < WAYS; w++) {
    const steif_analysis a = {.algorithm = ways[w]};
    steif_impulse i;
    CHECK(steif_impulse_find(ctx, E, F, x0, 0, NULL, NULL, &a, NULL, &i) == STEIF_OK);
    CHECK(i.index == 3 && i.count == 2 && i.last < 1e-8 && i.chain < 1e-8 && i.first < 1e-8);
    for (int j = 0; j < 5; j++)
      CLOSE_FLOOR(ldexp(i.x_plus[j], column[j]), plus[j],
                  ways[w] == STEIF_CONTOUR ? 1e-9 : 1e-11, 10);
    steif_impulse_clear(ctx, &i);
  }
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

static int drawn(sample *r, int most) { return (int)(uniform(r) * (2 * most + 1)) - most; }

/* x_i' + i x_i = 0 and a chain of 5, equations and unknowns shuffled, in units 2^-400 .. 2^400. */
static void chains_in_any_units(void)
{
  enum { N = 9, FINITE = 4 };
  steif_context *ctx = steif_context_new(NULL);
  sample r = {.state = 2463534242u};
  for (int trial = 0; trial < 12; trial++) {
    double E[N * N] = {0}, F[N * N] = {0};
    int row[N], column[N];
    for (int i = 0; i < N; i++) row[i] = drawn(&r, 400), column[i] = drawn(&r, 400);
    for (int i = 0; i < N; i++) {
      const int a = (4 * i + 3) % N, b = (7 * i + trial) % N, next = (7 * (i + 1) + trial) % N;
      F[b * N + a] = ldexp(i < FINITE ? 1 + i : 1, row[a] + column[b]);
      if (i < FINITE) E[b * N + a] = ldexp(1, row[a] + column[b]);
      if (i >= FINITE && i + 1 < N) E[next * N + a] = ldexp(1, row[a] + column[next]);
    }
    for (int w = 0; w < WAYS; w++) {
      steif_structure s = look(ctx, N, E, F, ways[w]);
      CHECK(s.regular && s.index == 5 && s.finite == FINITE && s.certified);
      if (w < 2) CLOSE(s.radius, 4, 1e-12);
      steif_structure_clear(ctx, &s);
    }
  }
  steif_context_free(&ctx);
}

/* 1e-18 x_1' + x_1 + 1e-18 x_2 = 0 has the eigenvalue 1e18 unless 1e-18 is rounding; in other units
 * it is no smaller than the others. Such verdicts are never certified. */
static void small_entries_raise_doubts(void)
{
  const double E[9] = {1e-18, 0, 0, 0, 1, 0, 0, 0, 0}, F[9] = {1, 0, 0, 1e-18, 2, 1, 0, 1, 0};
  const double tiny = 1e-30;
  steif_context *ctx = steif_context_new(NULL);
  for (int w = 0; w < 2; w++) {
    steif_structure s = look(ctx, 3, E, F, ways[w]);
    CHECK(s.regular && !s.certified && !!strstr(s.message, "rounding"));
    steif_structure_clear(ctx, &s);
  }
  const double e[4] = {tiny, 0, 0, 1}, f[4] = {1, tiny, tiny, 1};
  steif_structure s = look(ctx, 2, e, f, STEIF_STAIRCASE);
  CHECK(s.regular && !s.certified && !!strstr(s.message, "rounding"));
  steif_structure_clear(ctx, &s);
  steif_context_free(&ctx);
}

/* 1 / (i + j + 1), i, j < 16, has full rank and a condition far beyond double precision; a copy of
 * its last row for the one before makes it singular exactly. */
static void singular_exactly_or_to_rounding(void)
{
  enum { N = 16 };
  double E[N * N] = {0}, F[N * N];
  steif_context *ctx = steif_context_new(NULL);
  for (int exact = 0; exact < 2; exact++) {
    for (int k = 0; k < N * N; k++) F[k] = 1.0 / (k / N + k % N + 1);
    for (int j = 0; exact && j < N; j++) F[j * N + N - 2] = F[j * N + N - 1];
    steif_structure s = look(ctx, N, E, F, STEIF_STAIRCASE);
    CHECK(!s.regular && s.certified == exact && s.index == -1);
    CHECK(!!strstr(s.message, exact ? "singular: " : "singular to rounding: "));
    steif_structure_clear(ctx, &s);
  }
  steif_context_free(&ctx);
}

/* A chain of 8 behind transformations of condition 1e3: rounding makes its eigenvalues finite, as
 * large as 1e10^(1/8), and circles count them. With no infinite ones left there is no index 8, and where ranks
 * find all finite, as circles do, no index above 0 is the least. */
static void counts_and_indices_agree(void)
{
  const family p = {"osc 10 [8]", 6, {8}, 10, false, 1e3};
  steif_context *ctx = steif_context_new(NULL);
  int certified = 0, ranked = 0;
  for (unsigned seed = 1; seed <= 12; seed++) {
    sample q;
    sample_open(&q, &p, seed);
    steif_structure s = look(ctx, q.n, q.E, q.F, STEIF_CONTOUR);
    certified += s.certified;
    CHECK(s.index < 0 || s.infinite < 0 || s.index <= s.infinite);
    ranked += s.exact == q.n && s.count > q.n - 0.5;
    CHECK(s.exact < q.n || !(s.count > q.n - 0.5) || s.index_least == 0);
    steif_structure_clear(ctx, &s);
    sample_close(&q);
  }
  CHECK(certified == 0 && ranked > 0);
  steif_context_free(&ctx);
}

/* Capacitors in a ring, of whose three states one cancels exactly, so that ranks are asked for, beside N with
 * N a = b - (1 - d) c, N b = N c = e: N^2 a = d e makes a chain of 3, which no scaling makes visible to moments
 * where d is rounding: these see one of 2. */
static void ranks_and_moments_agree(void)
{
  enum { N = 7 };
  static const double ring[9] = {4, -1, -3, -1, 3, -2, -3, -2, 5};
  steif_context *ctx = steif_context_new(NULL);
  for (int small = 0; small < 2; small++) {
    double E[N * N] = {0}, F[N * N] = {0};
    for (int i = 0; i < 9; i++) E[i / 3 * N + i % 3] = ring[i];
    for (int i = 0; i < N; i++) F[i * (N + 1)] = 1 + 0.125 * (i < 3 ? i : 0);
    E[3 * N + 4] = 1, E[3 * N + 5] = -(1 - (small ? ldexp(1, -50) : 0.5));
    E[4 * N + 6] = 1, E[5 * N + 6] = 1;
    steif_structure s = look(ctx, N, E, F, STEIF_CONTOUR);
    CHECK(s.regular && s.exact == 2 && s.index_least <= 3);
    CHECK(small ? s.index != 2 && (s.index == 3 || !s.certified) : s.index == 3 && s.certified);
    steif_structure_clear(ctx, &s);
  }
  steif_context_free(&ctx);
}

/* Ranks of [E; F E; ...] of UT5, whose E has a kernel of dimension 1 and a chain of 3. */
static void ranks_over_a_field(void)
{
  static const sunindextype kernel[] = {1, 2, 3, 3};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  bool singular = true;
  sunindextype rank = 0;
  stf_field field;
  CHECK(stf_field_open(ctx, E, F, false, &field) == STEIF_OK);
  CHECK(stf_field_singular(ctx, &field, &singular) == STEIF_OK && !singular);
  for (int j = 1; j <= 4; j++) {
    CHECK(stf_field_rank(ctx, &field, j, j % 2, &rank) == STEIF_OK);
    CHECK(rank == 5 * j - kernel[j - 1]);
  }
  SUNMatDestroy(E), SUNMatDestroy(F);
  /* 0.1 + 0.1 = 0.2 in doubles, and no sum of 0.1 and 0.2 is 0.3. */
  for (int i = 0; i < 2; i++) {
    const double a[9] = {1, 0, 1, 0, 1, 1, 0.1, i ? 0.1 : 0.2, i ? 0.2 : 0.3}, zero[9] = {0};
    SUNMatrix A = dense(ctx, 3, a), Z = dense(ctx, 3, zero);
    CHECK(stf_field_open(ctx, Z, A, false, &field) == STEIF_OK);
    CHECK(stf_field_singular(ctx, &field, &singular) == STEIF_OK);
    CHECK(singular == i);
    SUNMatDestroy(A), SUNMatDestroy(Z);
  }
  steif_context_free(&ctx);
}

/* Constraints on velocities reach pressures in chains of 2, those on positions forces in chains of 3,
 * and loads of a power network nothing else: one chain for each. */
static void chains_of_sparse_pencils(void)
{
  static const struct {
    const char *spec;
    sunindextype rank;
    int count;
    sunindextype weyr[3];
  } of[] = {{"springs:n=40,c=5", 80, 3, {5, 5, 5}},
            {"stokes:m=8", 112, 2, {63, 63}},
            {"bus:n=40", 20, 1, {40}}};
  for (int k = 0; k < 3; k++) {
    system_ q;
    steif_structure s;
    const steif_analysis a = {.algorithm = STEIF_CONTOUR};
    system_open(&q, NULL, of[k].spec);
    CHECK(steif_structure_find(q.ctx, q.E, q.F, &a, &s) == STEIF_OK);
    CHECK(s.certified && s.rank_E == -1 && s.weyr_count == 0);
    CHECK(steif_structure_ranks(q.ctx, q.E, q.F, &s) == STEIF_OK);
    CHECK(s.rank_E == of[k].rank && s.weyr_count == of[k].count);
    for (int j = 0; j < s.weyr_count; j++) CHECK(s.weyr[j] == of[k].weyr[j]);
    steif_structure_clear(q.ctx, &s);
    system_close(&q);
  }
}

/* Pi_s by circles, applied to a vector twice, and beside the whole projector of the staircase. */
static void projectors_of_sparse_pencils(void)
{
  system_ q;
  steif_structure s;
  const steif_analysis a = {.algorithm = STEIF_CONTOUR};
  system_open(&q, NULL, "springs:n=40,c=5");
  const size_t n = (size_t)q.n;
  double *x = calloc(3 * n, sizeof *x), *slow = x + n, *again = slow + n;
  stf_random r = {19};
  for (size_t i = 0; i < n; i++) x[i] = stf_random_in(&r, -1, 1);
  CHECK(steif_structure_find(q.ctx, q.E, q.F, &a, &s) == STEIF_OK);
  CHECK(steif_projector_apply(q.ctx, q.E, q.F, &a, &s, x, slow) == STEIF_OK);
  CHECK(steif_projector_apply(q.ctx, q.E, q.F, &a, &s, slow, again) == STEIF_OK);
  CHECK(system_error(q.n, again, slow) < 1e-11 && system_error(q.n, slow, x) > 1e-2);
  double *P = calloc(n * n, sizeof *P);
  CHECK(steif_projector_find(q.ctx, q.E, q.F, NULL, P) == STEIF_OK);
  for (size_t i = 0; i < n; i++) {
    again[i] = 0;
    for (size_t j = 0; j < n; j++) again[i] += P[j * n + i] * x[j];
  }
  CHECK(system_error(q.n, slow, again) < 1e-10);
  steif_structure_clear(q.ctx, &s);
  free(x), free(P);
  system_close(&q);
}

/* Equation 21 is the sum of equations 5, 6 and 7 of a chain of 30: no pattern shows it. */
static void dependent_equations_are_named(void)
{
  enum { N = 30, SUM = 21 };
  static const sunindextype wanted[4] = {5, 6, 7, SUM};
  double E[N * N] = {0}, F[N * N] = {0};
  for (int i = 0; i < N; i++) {
    E[i * N + i] = 1 + 0.25 * (i % 4), F[i * N + i] = 2;
    if (i) F[(i - 1) * N + i] = F[i * N + i - 1] = -1;
  }
  for (int j = 0; j < N; j++) {
    E[j * N + SUM] = E[j * N + 5] + E[j * N + 6] + E[j * N + 7];
    F[j * N + SUM] = F[j * N + 5] + F[j * N + 6] + F[j * N + 7];
  }
  steif_context *ctx = steif_context_new(NULL);
  steif_structure s = look(ctx, N, E, F, STEIF_CONTOUR);
  CHECK(!s.regular && s.certified && s.degree >= 0 && s.equations_count == 4);
  for (int k = 0; k < 4 && k < s.equations_count; k++) CHECK(s.equations[k] == wanted[k]);
  CHECK(s.unknowns_count > 0 && !!strstr(s.message, "exactly"));
  steif_structure_clear(ctx, &s);
  steif_context_free(&ctx);
}

/* One chain of 3 from whole numbers of determinant 1, in units of 2^-20 to 2^20: rounding decides whether staircase
 * and Schur form leave its index open, and circles with exact ranks decide it then; what is asked for with an
 * algorithm keeps to it. */
static void circles_decide_what_schur_forms_leave_open(void)
{
  static const double E[9] = {0, 1879048192,  -0.28125,
                              0, 25769803776, -4,
                              0, 0.125,       -1.8189894035458565e-11},
                      F[9] = {1024,
                              6710886400,
                              -0.90625,
                              0,
                              60129542144,
                              -9,
                              1.1920928955078125e-07,
                              0.46875,
                              -5.820766091346741e-11},
                      x0[3] = {1, 2, 3},
                      c[6] = {63.999999999650754, -1.9687499999781721,  -549755813885,
                              -1.000000000349246, 0.031250000010913936, 8589934595};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix e = dense(ctx, 3, E), f = dense(ctx, 3, F);
  const steif_analysis by = {.algorithm = STEIF_STAIRCASE};
  steif_structure s;
  steif_impulse i;
  CHECK(!steif_structure_find(ctx, e, f, &by, &s) && !strcmp(s.method, "staircase"));
  const bool open = !s.certified;
  CHECK(open || (s.index == 3 && s.finite == 0));
  steif_structure_clear(ctx, &s);
  CHECK(!steif_structure_find(ctx, e, f, NULL, &s));
  CHECK(s.certified && s.index == 3 && s.finite == 0 &&
        (!open || !strcmp(s.method, "contour")));
  CHECK(!steif_impulse_find(ctx, e, f, x0, 0, NULL, NULL, NULL, &s, &i));
  CHECK(i.index == 3 && i.count == 2);
  for (int j = 0; j < 6; j++) CLOSE(i.c[j], c[j], 1e-8); /* of fractions */
  /* x(0+) = 0 beside x(0-): what is certified is known to a thousandth of it, and that in the units given. */
  const double size = sqrt(14), off = hypot(hypot(i.x_plus[0], i.x_plus[1]), i.x_plus[2]);
  CHECK(off <= 10 * i.estimate * 1e-3 * size && (!i.certified || i.estimate <= 1e-3));
  steif_impulse_clear(ctx, &i);
  steif_structure_clear(ctx, &s);
  SUNMatDestroy(e), SUNMatDestroy(f);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_units[] = {
  {"a shift beside any diagonal has index 3", a_shift_beside_any_diagonal},
  {"the 5 x 5 pencil in any units", five_by_five_in_any_units},
  {"chains are found in any units", chains_in_any_units},
  {"small entries that may be rounding are not certified", small_entries_raise_doubts},
  {"singular exactly, or to rounding", singular_exactly_or_to_rounding},
  {"circles decide what Schur forms leave open", circles_decide_what_schur_forms_leave_open},
  {"counts leave room for the index", counts_and_indices_agree},
  {"ranks and moments agree", ranks_and_moments_agree},
  {"ranks over a field", ranks_over_a_field},
  {"rank of E and chains of sparse pencils", chains_of_sparse_pencils},
  {"projectors of sparse pencils", projectors_of_sparse_pencils},
  {"dependent equations are named", dependent_equations_are_named},
  CU_TEST_INFO_NULL};
