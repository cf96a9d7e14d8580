/* test_exact.c: closed solutions satisfy their equations and meet figures computed elsewhere.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

typedef struct probe {
  const char *spec;
  double t, h;      /* where, and the step of the differences */
  double tolerance; /* of the residual: truncation and rounding of the differences */
} probe;

static const probe probes[] = {
  {"stiffpair", 0.00137, 1e-5, 1e-8},
  {"stiffpair", 0.913, 1e-2, 1e-13},
  {"forced", 1.37, 1e-2, 1e-12},
  {"forced:k=2,c=0.5", 3.21, 1e-2, 1e-12},
  {"forced:k=53,c=7", 0.37, 2e-3, 1e-11},
  {"harmonic", 1.234, 1e-2, 1e-12},
  {"pendulum", 0.7, 1e-2, 1e-11},
  {"pendulum", 8.41, 1e-2, 1e-11},
  {"pendulum3", 0.31, 5e-3, 1e-10},
  {"pendulum3:index=2", 1.77, 5e-3, 1e-10},
  {"pendulum3:index=1", 1.93, 5e-3, 1e-10},
  {"pendulum3:index=ggl", 0.83, 5e-3, 1e-10},
  {"kepler", 0.41, 5e-3, 1e-10},
  {"kepler:e=0.1", 17.3, 1e-2, 1e-11},
  {"kepler:e=0.9", 3.7, 1e-2, 1e-11},
  {"jordan:k=4", 0.29, 1e-2, 1e-11},
  {"jordan:k=3,case=sin-inc,storage=band", 1.3, 1e-2, 1e-11},
  {"jordan:k=1,case=N-inc,storage=sparse", 0.8, 1e-2, 1e-11},
  {"ut5", 0.61, 5e-3, 1e-10},
  {"ut5:case=cons", 0.17, 5e-3, 1e-10},
  {"heat:n=11", 0.0123, 5e-4, 1e-9},
  {"heat:n=11,storage=dense", 0.0571, 5e-4, 1e-9},
  {"heat:n=1", 0.04, 2e-3, 1e-9},
  {"parabolic:n=11", 0.37, 5e-3, 1e-10},
  {"parabolic:n=1", 0.71, 5e-3, 1e-11},
  {"prothero", 2.21, 1e-2, 1e-11},
  {"prothero:lambda=-3.5", 0.04, 1e-2, 1e-11},
  {"dahlquist", 0.47, 1e-2, 1e-12},
  {"dahlquist:re=-2.5,im=11", 0.77, 2e-3, 1e-10},
};

static void differences_satisfy_the_equations(void)
{
  for (const probe *q = probes; q < probes + sizeof probes / sizeof *probes; q++) {
    fixture s;
    if (fixture_open(&s, q->spec)) continue;
    fixture_difference(&s, s.p.exact, q->t, q->h);
    CHECK(s.p.exact(q->t, s.y, NULL, s.p.user) == 0);
    CHECK(N_VMaxNorm(s.y) > 1e-3);
    CHECK(fixture_residual(&s, q->t) == 0);
    const double scale = 1 + N_VMaxNorm(s.yp);
    if (!(fixture_largest(s.r) <= q->tolerance * scale))
      printf("\n  %s at %g: residual %.2e of %.2e", q->spec, q->t, fixture_largest(s.r), scale);
    CU_ASSERT(fixture_largest(s.r) <= q->tolerance * scale);
    fixture_close(&s);
  }
}

static void slopes_satisfy_the_equations_to_rounding(void)
{
  for (const probe *q = probes; q < probes + sizeof probes / sizeof *probes; q++) {
    fixture s;
    if (fixture_open(&s, q->spec)) continue;
    CHECK(s.p.exact(q->t, s.y, s.yp, s.p.user) == 0);
    CHECK(fixture_residual(&s, q->t) == 0);
    const double scale = 1 + N_VMaxNorm(s.yp) + N_VMaxNorm(s.y);
    CLOSE_FLOOR(fixture_largest(s.r) / scale, 0, 3e-14, 1);
    fixture_close(&s);
  }
}

static void solutions_begin_at_the_start_values(void)
{
  for (const probe *q = probes; q < probes + sizeof probes / sizeof *probes; q++) {
    fixture s;
    if (strstr(q->spec, "inc") || !strcmp(q->spec, "ut5")) continue;
    if (fixture_open(&s, q->spec)) continue;
    CHECK(s.p.exact(s.p.t0, s.y, s.yp, s.p.user) == 0);
    for (sunindextype i = 0; i < s.p.n; i++) {
      CLOSE_FLOOR(NV_Ith_S(s.y, i), s.p.y0[i], 2e-15, 1);
      if (s.p.yp0) CLOSE_FLOOR(NV_Ith_S(s.yp, i), s.p.yp0[i], 2e-15, 1);
    }
    fixture_close(&s);
  }
}

static void meets(const char *spec, double t, int n, const double *value, double tolerance)
{
  fixture s;
  if (fixture_open(&s, spec)) return;
  CHECK(s.p.exact(t, s.y, NULL, s.p.user) == 0);
  for (int i = 0; i < n; i++) CLOSE(NV_Ith_S(s.y, i), value[i], tolerance);
  fixture_close(&s);
}

static void closed_solutions_meet_known_figures(void)
{
  /* Closed forms evaluated in 30-digit arithmetic. */
  meets("forced", 4, 2, (double[]){0.16108910832466325, 1.2397109028908442}, 2e-15);
  meets("forced:k=2", 4, 2, (double[]){-0.4584618295496261, 0.8383039200031415}, 2e-15);
  meets("harmonic", 1.5, 2, (double[]){0.0707372016677029, -0.9974949866040544}, 1e-15);
  meets("stiffpair", 4, 1, (double[]){1.8315638888734180e-02}, 1e-15);
  /* Elliptic functions; t = 314.2 is 47 periods on, where rounding of t counts. */
  meets("pendulum", 10, 2, (double[]){-0.998949814623850652, -0.0420333775342122937}, 2e-14);
  meets("pendulum", 314.2, 2, (double[]){0.7992660155679068, 0.5602334227181494}, 5e-13);
  /* phi(5) = 10 - 15 e^-5. */
  meets("prothero", 5, 1, (double[]){9.898930795013717994}, 1e-15);
}

/* Two independent formulas (Drazin inverses and contour integrals) gave these 15 digits. */
static void the_pencil_of_index_three_meets_known_figures(void)
{
  meets("ut5", 1, 5,
        (double[]){-9.83990493625282, -14.7438400658581, 6.64909590232396, -6.87665107291679,
                   3.08069506977476},
        2e-14);
  meets("ut5", 0.25, 5,
        (double[]){-19.2352448914155, -7.39415776173142, 16.0822852249443, -2.79754917052188,
                   0.101385592521976},
        2e-14);
  fixture s;
  if (fixture_open(&s, "ut5")) return;
  const double after[] = {-8, -2, 12, 0, 0};
  CHECK(s.p.exact(0, s.y, NULL, s.p.user) == 0);
  for (int i = 0; i < 5; i++) {
    CLOSE_FLOOR(NV_Ith_S(s.y, i), after[i], 1e-14, 1);
    CLOSE(s.p.y0[i], i + 1, 0);
  }
  double scd, mescd;
  N_VConst(1, s.y);
  for (int i = 0; i < 5; i++) NV_Ith_S(s.y, i) = s.p.reference->value[i];
  CHECK(steif_problem_digits(s.ctx, &s.p, 1, s.y, 1, &scd, &mescd) == STEIF_OK);
  CHECK(scd > 13.7 && mescd > 13.7);
  fixture_close(&s);
}

/* max over [0, t] of the drift of invariant i along the exact solution. */
static void invariants_are_constant_on(const char *spec, double t, int count,
                                       const double *value, double tolerance)
{
  fixture s;
  double now[3];
  if (fixture_open(&s, spec)) return;
  CU_ASSERT_EQUAL(s.p.invariants, count);
  for (int k = 0; k <= 40; k++) {
    CHECK(s.p.exact(k * t / 40, s.y, NULL, s.p.user) == 0);
    CHECK(s.p.invariant(k * t / 40, s.y, now, s.p.user) == 0);
    for (int i = 0; i < count; i++) CLOSE_FLOOR(now[i], value[i], tolerance, 1);
  }
  fixture_close(&s);
}

static void invariants_are_constant(void)
{
  invariants_are_constant_on("harmonic", 9, 1, (double[]){0.5}, 1e-15);
  invariants_are_constant_on("pendulum", 23, 1, (double[]){-0.540302305868139717}, 2e-14);
  /* energy -1/2 and angular momentum sqrt(1 - e^2) for a semi-axis of one */
  invariants_are_constant_on("kepler", 6.9, 2, (double[]){-0.5, 0.8}, 2e-14);
  invariants_are_constant_on("kepler:e=0.28", 13, 2, (double[]){-0.5, 0.96}, 1e-14);
  /* 0.7^2/2 - g sin 0.6 */
  invariants_are_constant_on("pendulum3:index=2", 3.3, 3,
                             (double[]){0.245 - 9.81 * 0.56464247339503536, 1, 0}, 3e-14);
}

CU_TestInfo tests_of_exact[] = {
  {"differences of closed solutions satisfy the equations", differences_satisfy_the_equations},
  {"slopes of closed solutions satisfy them to rounding",
   slopes_satisfy_the_equations_to_rounding},
  {"closed solutions begin at the start values", solutions_begin_at_the_start_values},
  {"closed solutions meet known figures", closed_solutions_meet_known_figures},
  {"the pencil of index three meets known figures",
   the_pencil_of_index_three_meets_known_figures},
  {"invariants are constant along closed solutions", invariants_are_constant},
  CU_TEST_INFO_NULL};
