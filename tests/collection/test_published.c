/* test_published.c: data, start values and right-hand sides of the published problems, against
 * relations and formulas that do not come from their code.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include "fixture.h"

#define PI 3.14159265358979323846

static int finite(const double *x, sunindextype n)
{
  for (sunindextype i = 0; x && i < n; i++)
    if (!isfinite(x[i])) return 0;
  return 1;
}

static void check_reference(const steif_problem *p)
{
  const steif_reference *r = p->reference;
  const sunindextype n = r->count ? r->count : p->n;
  CHECK(n <= p->n && r->value && r->source && r->digits >= 0 && r->digits <= 17);
  CHECK(r->t > p->t0 && r->t <= p->t1);
  CHECK(finite(r->value, n));
  for (sunindextype i = 0; r->component && i < n; i++)
    CHECK(r->component[i] >= (i ? r->component[i - 1] + 1 : 0) && r->component[i] < p->n);
}

static void shelf_data_is_sound(void)
{
  for (size_t k = 0; k < stf_problem_count; k++) {
    fixture s;
    if (fixture_open(&s, stf_problem_shelf[k].name)) continue;
    const steif_problem *p = &s.p;
    CHECK(p->about && strlen(p->about) > 30);
    CHECK(p->n > 0 && p->t1 > p->t0);
    CHECK(p->y0 || p->start);
    CHECK(finite(p->y0, p->n) && finite(p->yp0, p->n));
    for (sunindextype i = 0; p->index && i < p->n; i++)
      CHECK(p->index[i] >= 1 && p->index[i] <= 3);
    for (int i = 0; i < p->break_count; i++)
      CHECK(p->breaks[i] > (i ? p->breaks[i - 1] : p->t0) && p->breaks[i] < p->t1);
    CHECK((p->invariants > 0) == (p->invariant != NULL));
    CHECK(p->storage != STEIF_SPARSE || p->nnz > 0);
    if (p->reference) check_reference(p);
    fixture_close(&s);
  }
}

static void every_published_problem_is_there(void)
{
  static const struct {
    const char *spec;
    int n, index, values;
    double t1;
  } known[] = {{"rober", 3, 0, 3, 1e11},     {"vdpol", 2, 0, 2, 2},
               {"orego", 3, 0, 3, 360},      {"hires", 8, 0, 8, 321.8122},
               {"e5", 4, 0, 2, 1e13},        {"pollu", 20, 0, 20, 60},
               {"ringmod", 15, 0, 15, 1e-3}, {"beam", 80, 0, 80, 5},
               {"plei", 28, 0, 28, 3},       {"medakzo", 400, 0, 5, 20},
               {"chemakzo", 6, 1, 6, 180},   {"transamp", 8, 1, 8, 0.2},
               {"caraxis", 10, 3, 10, 3},    {"rober:form=mass", 3, 1, 3, 1e11},
               {"vdpol:mu=10", 2, 0, 2, 50}, {"vdpol:mu=30", 2, 0, 2, 50}};
  for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
    fixture s;
    if (fixture_open(&s, known[k].spec)) continue;
    const steif_reference *r = s.p.reference;
    CHECK(s.p.n == known[k].n && s.p.dae_index == known[k].index);
    CHECK(r && r->t == known[k].t1 && s.p.t1 == known[k].t1);
    CHECK(r && (r->count ? r->count : s.p.n) == known[k].values);
    fixture_close(&s);
  }
}

static void put(fixture *s, const double *y)
{
  for (sunindextype i = 0; i < s->p.n; i++) NV_Ith_S(s->y, i) = y[i];
}

/* What a problem declares as conserved has the same value at the start and in the reference. */
static void references_keep_the_invariants(void)
{
  int seen = 0;
  for (size_t k = 0; k < stf_problem_count; k++) {
    fixture s;
    double before[8], after[8];
    if (fixture_open(&s, stf_problem_shelf[k].name)) continue;
    const steif_reference *r = s.p.reference;
    if (s.p.invariants > 0 && s.p.y0 && r && (!r->count || r->count == s.p.n)) {
      put(&s, s.p.y0);
      CHECK(s.p.invariants <= 8 && s.p.invariant(s.p.t0, s.y, before, s.p.user) == 0);
      put(&s, r->value);
      CHECK(s.p.invariant(r->t, s.y, after, s.p.user) == 0);
      for (int i = 0; i < s.p.invariants; i++, seen++)
        CLOSE_FLOOR(after[i], before[i], 1e-11, 1);
    }
    fixture_close(&s);
  }
  CHECK(seen >= 5);
}

static void references_fulfil_the_equilibria(void)
{
  fixture s;
  if (!fixture_open(&s, "chemakzo")) {
    const double *y = s.p.reference->value;
    CLOSE(y[5], 115.83 * y[0] * y[3], 1e-13);
    fixture_close(&s);
  }
  if (!fixture_open(&s, "hires")) {
    CLOSE(s.p.reference->value[6] + s.p.reference->value[7], 0.0057, 1e-13);
    fixture_close(&s);
  }
  if (!fixture_open(&s, "pollu")) {
    CLOSE(s.p.reference->value[16] + s.p.reference->value[17], 0.007, 1e-12);
    fixture_close(&s);
  }
  if (!fixture_open(&s, "transamp")) {
    put(&s, s.p.reference->value);
    CHECK(s.p.f(0.2, s.y, s.r, NULL) == 0);
    for (int i = 0; i < 8; i += 3)
      CLOSE_FLOOR(NV_Ith_S(s.r, i) + NV_Ith_S(s.r, i + 1), 0, 1e-11, 1e-3);
    fixture_close(&s);
  }
}

static int value_of(fixture *s, const char *spec, double t, const double *y)
{
  if (fixture_open(s, spec)) return 0;
  put(s, y ? y : s->p.y0);
  CHECK(s->p.f(t, s->y, s->r, s->p.user) == 0);
  return 1;
}

static void chemistry_at_hand_computed_points(void)
{
  static const double orego[] = {-77.27 * 8.375e-6 + 77.27, -1 / 77.27, -0.161 * 2};
  static const double hires[] = {-1.7093, 1.71, 0, 0, 0, 0, 0, 0};
  fixture s;
  if (value_of(&s, "orego", 0, NULL)) {
    for (int i = 0; i < 3; i++) CLOSE(NV_Ith_S(s.r, i), orego[i], 1e-13);
    fixture_close(&s);
  }
  if (value_of(&s, "hires", 0, NULL)) {
    for (int i = 0; i < 8; i++) CLOSE(NV_Ith_S(s.r, i), hires[i], 1e-14);
    fixture_close(&s);
  }
  if (value_of(&s, "pollu", 0, NULL)) {
    CLOSE(NV_Ith_S(s.r, 0), 26.6 * 0.2 * 0.04, 1e-14);
    CLOSE(NV_Ith_S(s.r, 1), -26.6 * 0.2 * 0.04, 1e-14);
    CLOSE(NV_Ith_S(s.r, 3), -26.6 * 0.2 * 0.04 - (3.5e-4 + 0.0175) * 0.04, 1e-14);
    CLOSE(NV_Ith_S(s.r, 4), 2 * 8.6e-4 * 0.1 + 1.3e-4 * 0.01, 1e-14);
    CLOSE(NV_Ith_S(s.r, 15), 3.5e-4 * 0.04, 1e-14);
    fixture_close(&s);
  }
}

/* Medical Akzo at rest: only u_1 is fed, by the boundary value that falls from 2 to 0
 * at t = 5. */
static void tumour_is_fed_until_five(void)
{
  const double z = 1.0 / 200 - 1, fed = pow(z, 4) / 16 * 4e4 - 2 * pow(z, 3) / 16 * 100;
  fixture s;
  if (value_of(&s, "medakzo", 4.9, NULL)) {
    CLOSE(NV_Ith_S(s.r, 0), 2 * fed, 1e-12);
    for (int i = 1; i < 400; i++) CHECK(NV_Ith_S(s.r, i) == 0);
    CHECK(s.p.f(5.1, s.y, s.r, s.p.user) == 0);
    CHECK(N_VMaxNorm(s.r) == 0);
    fixture_close(&s);
  }
}

/* Without currents and voltages but with the high-frequency signal at its peak of 2 V, two
 * diodes conduct and two are blocked. */
static void modulator_at_the_peak_of_its_carrier(void)
{
  static const double zero[15];
  const double on = 40.67286402e-9 * expm1(2 * 17.7493332);
  const double off = 40.67286402e-9 * expm1(-2 * 17.7493332);
  fixture s;
  if (!value_of(&s, "ringmod", 2.5e-5, zero)) return;
  CLOSE(NV_Ith_S(s.r, 2), (on - off) / 2e-12, 1e-12);
  CLOSE(NV_Ith_S(s.r, 3), (off - on) / 2e-12, 1e-12);
  CLOSE(NV_Ith_S(s.r, 4), (off - on) / 2e-12, 1e-12);
  CLOSE(NV_Ith_S(s.r, 5), (on - off) / 2e-12, 1e-12);
  CLOSE(NV_Ith_S(s.r, 6), 2 * (off - on) / 1e-8, 1e-12);
  CLOSE(NV_Ith_S(s.r, 13), 0.5 * sin(0.05 * PI) / 2e-3, 1e-12);
  fixture_close(&s);
}

/* Accelerations of the straight beam under its end force are zero but for the last segment,
 * since the row sums of the inverse inertia are 0, ..., 0, 2; a rigid turn by d adds 2 N^4 d at
 * the clamp. */
static void beam_bends_from_its_end(void)
{
  static const double straight[80];
  double turned[80] = {0};
  fixture s;
  if (value_of(&s, "beam", 0.7, straight)) {
    const double push = 1600 * 1.5 * sin(0.7) * sin(0.7);
    for (int i = 0; i < 79; i++) CLOSE_FLOOR(NV_Ith_S(s.r, i), 0, 1e-11, push);
    CLOSE(NV_Ith_S(s.r, 79), 2 * push, 1e-12);
    fixture_close(&s);
  }
  for (int i = 0; i < 40; i++) turned[i] = 0.013;
  if (value_of(&s, "beam", 0, turned)) {
    CLOSE(NV_Ith_S(s.r, 40), -2 * 0.013 * 2560000, 1e-12);
    CLOSE(NV_Ith_S(s.r, 41), 2 * 0.013 * 2560000, 1e-12);
    for (int i = 42; i < 80; i++) CLOSE_FLOOR(NV_Ith_S(s.r, i), 0, 1e-12, 2560000);
    fixture_close(&s);
  }
}

/* Outside the domain a callback asks for a smaller step instead of returning NaN. */
static void callbacks_reject_points_outside_the_domain(void)
{
  static const struct {
    const char *spec;
    int component;
    double value;
  } outside[] = {{"chemakzo", 1, -3e-9}, {"transamp", 1, 12.9}, {"transamp", 4, 12.9},
                 {"ringmod", 6, 93.1},   {"ringmod", 2, 31.7},  {"chemakzo", 1, NAN}};
  for (size_t k = 0; k < sizeof outside / sizeof *outside; k++) {
    fixture s;
    if (fixture_open(&s, outside[k].spec)) continue;
    put(&s, s.p.y0);
    NV_Ith_S(s.y, outside[k].component) = outside[k].value;
    SUNMatrix J = fixture_matrix(&s, s.p.nnz);
    CHECK(s.p.f(0, s.y, s.r, s.p.user) > 0);
    CHECK(s.p.jac(0, s.y, s.r, J, s.p.user, s.r, s.r, s.r) > 0);
    SUNMatDestroy(J);
    fixture_close(&s);
  }
}

static void collisions_are_rejected(void)
{
  fixture s;
  if (fixture_open(&s, "plei")) return;
  put(&s, s.p.y0);
  NV_Ith_S(s.y, 2) = NV_Ith_S(s.y, 4), NV_Ith_S(s.y, 9) = NV_Ith_S(s.y, 11);
  SUNMatrix J = fixture_matrix(&s, 0);
  CHECK(s.p.f(0, s.y, s.r, s.p.user) > 0);
  CHECK(s.p.jac(0, s.y, s.r, J, s.p.user, s.r, s.r, s.r) > 0);
  SUNMatDestroy(J);
  fixture_close(&s);
}

static void impossible_parameters_are_rejected(void)
{
  static const char *const specs[] = {"vdpol:mu=3,eps=0.2", "vdpol:eps=-1", "vdpol:n=7",
                                      "rober:form=matrix",  "medakzo:n=63", "medakzo:n=2",
                                      "rober:mass"};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t k = 0; k < sizeof specs / sizeof *specs; k++) {
    steif_problem p;
    const int code = steif_problem_find(ctx, specs[k], &p);
    if (code >= 0) printf("\n  %s was accepted", specs[k]);
    CU_ASSERT(code < 0);
    CHECK(strlen(steif_message(ctx)) > 20);
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

static void parameters_change_what_they_name(void)
{
  fixture s;
  if (!fixture_open(&s, "medakzo:n=62")) {
    CHECK(s.p.n == 62 && s.p.nnz == 184 && s.p.reference == NULL);
    fixture_close(&s);
  }
  if (value_of(&s, "vdpol:mu=17.3", 0, (const double[]){0.6, -1.7})) {
    CLOSE(NV_Ith_S(s.r, 1), 17.3 * 0.64 * -1.7 - 0.6, 1e-14);
    CHECK(s.p.reference == NULL && s.p.t1 == 50);
    fixture_close(&s);
  }
  if (value_of(&s, "vdpol:eps=3.1e-3", 0, (const double[]){0.6, -1.7})) {
    CLOSE(NV_Ith_S(s.r, 1), (0.64 * -1.7 - 0.6) / 3.1e-3, 1e-14);
    CHECK(s.p.reference == NULL && s.p.t1 == 2);
    fixture_close(&s);
  }
}

CU_TestInfo tests_of_published[] = {
  {"data of the shelf are sound", shelf_data_is_sound},
  {"every published problem is there", every_published_problem_is_there},
  {"references keep the invariants", references_keep_the_invariants},
  {"references fulfil the equilibria", references_fulfil_the_equilibria},
  {"chemistry at points computed by hand", chemistry_at_hand_computed_points},
  {"tumour is fed until t = 5", tumour_is_fed_until_five},
  {"modulator at the peak of its carrier", modulator_at_the_peak_of_its_carrier},
  {"beam bends from its end", beam_bends_from_its_end},
  {"callbacks reject points outside the domain", callbacks_reject_points_outside_the_domain},
  {"collisions are rejected", collisions_are_rejected},
  {"impossible parameters are rejected", impossible_parameters_are_rejected},
  {"parameters change what they name", parameters_change_what_they_name},
  CU_TEST_INFO_NULL};
