/* test_tables.c: errors of every scheme for q'' + q'/2 + k q = sin 2t on [0, 4], and orders.
 * Figures: the recurrences recomputed with NumPy in double precision against the closed form.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "oscillator.h"
#include "suite.h"

static const double step[5] = {0.4, 0.2, 0.1, 0.05, 0.025};

typedef struct row {
  const char *scheme;
  double error[5], slope[4];
  change_fn change;
} row;

static void only_first(steif_discrete *d, double *room)
{
  room[0] = room[1] = 0;
  d->B0 = d->form.B, d->B1 = room;
}

/* B1 as it should be times `factor`, with B0 + B1 kept. */
static void scale(steif_discrete *d, double *room, double factor)
{
  for (int i = 0; i < 2; i++) {
    room[i] = factor * d->B1[i];
    room[2 + i] = d->form.B[i] - room[i];
  }
  d->B1 = room, d->B0 = room + 2;
}

static void too_large(steif_discrete *d, double *room) { scale(d, room, 1 / d->dt); }
static void too_small(steif_discrete *d, double *room) { scale(d, room, d->dt); }

static void go_through(const row *r, size_t rows, double k, enum drive drive, enum size of)
{
  for (size_t i = 0; i < rows; i++) {
    double before = 0;
    for (int j = 0; j < 5; j++) {
      const double e = worst(r[i].scheme, k, drive, step[j], of, r[i].change);
      if (r[i].error[j] > 0) CLOSE(e, r[i].error[j], 1e-7);
      if (j > 0 && r[i].slope[j - 1] > 0) CLOSE(log2(before / e), r[i].slope[j - 1], 1e-4);
      before = e;
    }
  }
}
#define EACH(rows, k, drive, of) go_through(rows, sizeof rows / sizeof *rows, k, drive, of)

static void wrong_input(void)
{
  static const row rows[] = {
    {"bilinear",
     {3.4167269137e-01, 1.5266771162e-01, 6.9514353690e-02, 3.2981885452e-02, 1.6043746956e-02},
     {1.162220, 1.135012, 1.075637, 1.039663},
     only_first},
  };
  EACH(rows, 4, SINE, OUTPUT);
}

static void states(void)
{
  static const row rows[] = {
    {"forward",
     {2.7562187238e+00, 1.4146208838e+00, 5.6494239651e-01, 2.4728056757e-01, 1.1558096740e-01},
     {0},
     NULL},
    {"zoh",
     {4.4936948031e-01, 2.2656593058e-01, 1.1269256318e-01, 5.5814468962e-02, 2.7775076957e-02},
     {0},
     NULL},
    {"bilinear",
     {1.9170015544e-01, 5.0955387912e-02, 1.2887427573e-02, 3.2307654271e-03, 8.0892351271e-04},
     {0},
     NULL},
    {"foh",
     {6.5287224972e-02, 1.6581369378e-02, 4.1616614146e-03, 1.0421319973e-03, 2.6076086537e-04},
     {0},
     NULL},
    {"exp-midpoint",
     {3.8261973779e-02, 9.5108765102e-03, 2.3977076768e-03, 5.9927718040e-04, 1.4996516280e-04},
     {0},
     NULL},
  };
  EACH(rows, 4, SINE, LENGTH);
}

static void without_input(void)
{
  static const row rows[] = {
    {"forward",
     {4.8725905940, 1.1642940489, 4.0597320574e-01, 1.7012759604e-01, 7.8153766851e-02},
     {0},
     NULL},
    {"bilinear",
     {1.5312056324e-01, 3.9030879239e-02, 9.8344325126e-03, 2.4681106812e-03, 6.1726477973e-04},
     {0, 0, 0, 1.9994},
     NULL},
  };
  EACH(rows, 4, NOTHING, OUTPUT);
  for (int j = 0; j < 5; j++) {
    CHECK(worst("zoh", 4, NOTHING, step[j], OUTPUT, NULL) <= 2e-15);
    CHECK(worst("quadrature", 4, NOTHING, step[j], OUTPUT, NULL) <= 2e-15);
  }
}

static void exact_inputs(void)
{
  static const char *const constant[] = {"zoh", "foh", "exp-midpoint", "averaged"};
  for (int i = 0; i < 4; i++) CHECK(worst(constant[i], 4, ONE, 0.4, LARGEST, NULL) <= 6e-16);
  CLOSE(worst("bilinear", 4, ONE, 0.4, LARGEST, NULL), 7.1769195553e-02, 1e-7);
  CLOSE(worst("quadrature", 4, ONE, 0.4, LARGEST, NULL), 2.2452924306e-02, 1e-7);
  CLOSE(worst("forward", 4, ONE, 0.4, LARGEST, NULL), 2.3427347592, 1e-7);
  CHECK(worst("foh", 4, RAMP, 0.4, LARGEST, NULL) <= 1e-15);
  CLOSE(worst("exp-midpoint", 4, RAMP, 0.4, LARGEST, NULL), 2.2452924306e-02, 1e-7);
  CLOSE(worst("zoh", 4, RAMP, 0.4, LARGEST, NULL), 9.7580265394e-02, 1e-7);
  CLOSE(worst("bilinear", 4, RAMP, 0.4, LARGEST, NULL), 3.8280140810e-02, 1e-7);
  CLOSE(worst("quadrature", 4, RAMP, 0.4, LARGEST, NULL), 5.6357580739e-02, 1e-7);
}

static void seeded_bugs(void)
{
  static const row rows[] = {
    {"exp-trapezoidal",
     {3.4809630e-01, 4.9062339e-01, 5.5750959e-01, 5.9186120e-01, 6.0784219e-01},
     {0},
     too_large},
    {"exp-trapezoidal",
     {1.5145992e-01, 1.0071115e-01, 5.6342119e-02, 2.9679617e-02, 1.5217170e-02},
     {0},
     too_small},
  };
  EACH(rows, 4, SINE, OUTPUT);
}

static void reference(void)
{
  double h[2];
  exact(4, SINE, 4, h); /* mpmath, 30 digits */
  CLOSE(h[0], 0.16108910832466325, 1e-14);
  CLOSE(h[1], 1.2397109028908442, 1e-14);
  exact(2, SINE, 4, h);
  CLOSE(h[0], -0.4584618295496261, 1e-14);
  CLOSE(h[1], 0.8383039200031415, 1e-14);
}

CU_TestInfo tests_of_tables[] = {
  {"the closed form has its values at t = 4", reference},
  {"bilinear fed with one sample only is of order 1", wrong_input},
  {"state errors for k = 4", states},
  {"without input the exponential is exact", without_input},
  {"constant and linear inputs are exact where claimed", exact_inputs},
  {"a wrong factor of B1 shows in the errors", seeded_bugs},
  CU_TEST_INFO_NULL};
