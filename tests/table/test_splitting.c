/* test_splitting.c: the passes of splitting schemes: consistent, symmetric, of the order
 * claimed on a small nonlinear oscillator run in long double, so that a wrong digit shows.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "splitting.h"
#include "suite.h"
#include <string.h>

static const stf_splitting *scheme(const char *name)
{
  const stf_splitting *x = stf_splitting_find(name);
  CU_ASSERT_FATAL(x != NULL);
  return x;
}

static void flows_sum_to_one(void)
{
  for (size_t i = 0; i < stf_splitting_count; i++)
    for (int first = 0; first < 2; first++) {
      stf_passes p;
      stf_splitting_passes(&stf_splittings[i], first, &p);
      double kicks = 0, drifts = 0;
      for (int k = 0; k < p.count; k++) {
        CLOSE_FLOOR(p.kick_at[k], drifts, 2e-15, 1);
        kicks += p.kick[k];
        CLOSE_FLOOR(p.drift_at[k], kicks, 2e-15, 1);
        drifts += p.drift[k];
      }
      CLOSE(kicks, 1, 2e-15);
      CLOSE(drifts, 1, 2e-15);
    }
}

/* The flows in turn, read from both ends. */
static void all_but_euler_are_symmetric(void)
{
  for (size_t i = 0; i < stf_splitting_count; i++)
    for (int first = 0; first < 2; first++) {
      stf_passes p;
      double flow[2 * STF_PASSES];
      int count = 0;
      stf_splitting_passes(&stf_splittings[i], first, &p);
      for (int k = 0; k < p.count; k++) {
        if (p.kick[k] != 0) flow[count++] = p.kick[k];
        if (p.drift[k] != 0) flow[count++] = p.drift[k];
      }
      CHECK((p.kick[0] != 0) == p.kick_first);
      CHECK(p.reuses == (p.kick_first && stf_splittings[i].kind != STF_EULER));
      if (stf_splittings[i].kind == STF_EULER) continue;
      CHECK(count % 2 == 1);
      for (int k = 0; k < count; k++) CHECK(flow[k] == flow[count - 1 - k]);
    }
}

/* Evaluations of the force per step, from the papers. */
static void stages_are_those_of_the_papers(void)
{
  static const struct {
    const char *name;
    int kicks;
  } known[] = {{"symeuler", 1},    {"verlet", 1},   {"yoshida4", 3}, {"suzuki4", 5},
               {"pefrl", 4},       {"rkn6", 6},     {"rkn11", 11},   {"yoshida6", 7},
               {"blanesmoan6", 6}, {"kahanli6", 9}, {"suzuki6", 25}, {"suzuki8", 15},
               {"kahanli8", 17}};
  CHECK(sizeof known / sizeof *known == stf_splitting_count);
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    for (int first = 0; first < 2; first++) {
      stf_passes p;
      stf_splitting_passes(scheme(known[i].name), first, &p);
      CU_ASSERT_EQUAL(p.kicks, known[i].kicks);
    }
}

/* Symmetric compositions of order 2k: sum w = 1 and sum w^3 = 0, for 6 sum w^5 = 0, for 8
 * sum w^7 = 0 (Hairer, Lubich and Wanner, V.3.2). */
static void compositions_satisfy_the_power_sums(void)
{
  int seen = 0;
  for (size_t i = 0; i < stf_splitting_count; i++) {
    const stf_splitting *x = &stf_splittings[i];
    if (x->kind != STF_VERLET || x->order < 4) continue;
    for (int power = 3; power < x->order; power += 2) {
      long double sum = 0, middle = 1;
      for (int k = 0; k < x->count; k++) middle -= 2 * x->given[k];
      for (int k = 0; k < x->count; k++) sum += 2 * powl(x->given[k], power);
      CLOSE_FLOOR((double)(sum + powl(middle, power)), 0, 3e-17, 1);
    }
    seen++;
  }
  CU_ASSERT_EQUAL(seen, 7);
}

/* H = p^2/2 + q^2/2 + q^4/4 - 0.3 q^3; from (0.7, 0.4). */
static long double force(long double q) { return -q - q * q * q + 0.9L * q * q; }

static void run(const stf_splitting *x, bool first, int steps, long double y[2])
{
  const long double h = 2.0L / steps;
  stf_passes p;
  stf_splitting_passes(x, first, &p);
  y[0] = 0.7L, y[1] = 0.4L;
  for (int i = 0; i < steps; i++)
    for (int k = 0; k < p.count; k++) {
      if (p.kick[k] != 0) y[1] += p.kick[k] * h * force(y[0]);
      y[0] += p.drift[k] * h * y[1];
    }
}

/* From two halvings, without a reference. */
static void orders_are_those_claimed(void)
{
  for (size_t i = 0; i < stf_splitting_count; i++)
    for (int first = 0; first < 2; first++) {
      const stf_splitting *x = &stf_splittings[i];
      const int steps = x->order > 6 ? 6 : x->order > 4 ? 8 : 64;
      long double y[3][2];
      for (int k = 0; k < 3; k++) run(x, first, steps << k, y[k]);
      const long double a = hypotl(y[0][0] - y[1][0], y[0][1] - y[1][1]),
                        b = hypotl(y[1][0] - y[2][0], y[1][1] - y[2][1]);
      const double order = (double)log2l(a / b);
      if (!(fabs(order - x->order) < 0.2)) printf("\n  %s: order %.3f", x->name, order);
      CHECK(fabs(order - x->order) < 0.2);
    }
}

static void unknown_names_are_not_found(void)
{
  CHECK(stf_splitting_find("yoshida5") == NULL);
  CHECK(!strcmp(scheme("pefrl")->name, "pefrl"));
}

CU_TestInfo tests_of_splitting[] = {
  {"kicks and drifts sum to one, and times are sums", flows_sum_to_one},
  {"all but Euler's are symmetric", all_but_euler_are_symmetric},
  {"stages are those of the papers", stages_are_those_of_the_papers},
  {"compositions satisfy the power sums", compositions_satisfy_the_power_sums},
  {"orders are those claimed", orders_are_those_claimed},
  {"unknown names are not found", unknown_names_are_not_found},
  CU_TEST_INFO_NULL};
