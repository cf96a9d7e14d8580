/* test_nodes.c: nodes, quadrature weights and Lagrange's basis.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include "reference.h"
#include "table.h"
#include <string.h>

static void radau_nodes_agree(void)
{
  for (int k = 0; k < REFERENCES; k++) {
    const struct reference *r = radau_reference + k;
    long double c[STEIF_STAGES];
    CHECK(!stf_nodes(NULL, STF_RADAU_RIGHT, r->s, c));
    for (int i = 0; i < r->s; i++) CLOSE((double)c[i], r->c[i], 1.2e-16);
  }
}

/* Roots of P_2, P_3, P_5 and of P_3', P_4': Abramowitz, Stegun, tables 25.4 and 25.6. */
static void closed_forms_agree(void)
{
  long double c[STEIF_STAGES];
  CHECK(!stf_nodes(NULL, STF_GAUSS, 2, c));
  CLOSE((double)c[0], 0.5 - sqrt(3.0) / 6, 1e-15);
  CHECK(!stf_nodes(NULL, STF_GAUSS, 5, c));
  CLOSE((double)c[0], 0.046910077030668003601, 1.2e-16);
  CLOSE((double)c[1], 0.23076534494715845448, 1.2e-16);
  CHECK(c[2] == 0.5L);
  CLOSE((double)c[4], 0.95308992296933199640, 1.2e-16);
  CHECK(!stf_nodes(NULL, STF_LOBATTO, 4, c));
  CLOSE((double)c[1], 0.27639320225002103036, 1.2e-16);
  CHECK(!stf_nodes(NULL, STF_LOBATTO, 5, c));
  CLOSE((double)c[3], 0.82732683535398857190, 1.2e-16);
  CHECK(!stf_nodes(NULL, STF_RADAU_LEFT, 3, c));
  CLOSE((double)c[1], (6 - sqrt(6.0)) / 10, 2e-16);
}

static void end_points_and_order(void)
{
  const struct {
    enum stf_node_kind kind;
    int lowest;
    bool left, right;
  } all[] = {{STF_GAUSS, 1, false, false},
             {STF_RADAU_RIGHT, 1, false, true},
             {STF_RADAU_LEFT, 1, true, false},
             {STF_LOBATTO, 2, true, true}};
  for (int k = 0; k < 4; k++)
    for (int s = all[k].lowest; s <= STEIF_STAGES; s++) {
      long double c[STEIF_STAGES];
      CHECK(!stf_nodes(NULL, all[k].kind, s, c));
      CHECK(all[k].left ? c[0] == 0 : c[0] > 0);
      CHECK(all[k].right ? c[s - 1] == 1 : c[s - 1] < 1);
      for (int i = 1; i < s; i++) CHECK(c[i] > c[i - 1]);
    }
}

/* Left nodes are the mirror of right ones, so 1 - c agrees to absolute rounding. */
static void left_and_right_mirror(void)
{
  for (int s = 1; s <= STEIF_STAGES; s++) {
    long double left[STEIF_STAGES], right[STEIF_STAGES];
    CHECK(!stf_nodes(NULL, STF_RADAU_LEFT, s, left));
    CHECK(!stf_nodes(NULL, STF_RADAU_RIGHT, s, right));
    for (int i = 0; i < s; i++) CHECK(fabsl(left[i] + right[s - 1 - i] - 1) < 1e-18L);
  }
}

static void gauss_integrates(void)
{
  for (int m = 1; m <= STEIF_STAGES; m++) {
    long double c[STEIF_STAGES], w[STEIF_STAGES];
    stf_gauss(m, c, w);
    for (int k = 0; k <= 2 * m; k++) {
      long double sum = 0;
      for (int i = 0; i < m; i++) sum += w[i] * powl(c[i], k);
      if (k < 2 * m)
        CLOSE((double)(sum * (k + 1)), 1, 2e-16);
      else if (m < 6)
        CHECK(fabsl(sum - 1.0L / (k + 1)) > 1e-8L);
    }
  }
}

static void lagrange_differentiates(void)
{
  const long double x[] = {-0.37L, 0.11L, 0.58L, 0.93L, 1.46L};
  const long double at[] = {0.271L, 0.58L, 1.9L};
  for (int q = 0; q < 3; q++) {
    long double value[5], slope[5];
    stf_lagrange(5, x, at[q], value, slope);
    for (int k = 0; k < 5; k++) {
      long double p = 0, dp = 0;
      for (int j = 0; j < 5; j++) p += value[j] * powl(x[j], k), dp += slope[j] * powl(x[j], k);
      CLOSE_FLOOR((double)p, (double)powl(at[q], k), 1e-16, 1);
      CLOSE_FLOOR((double)dp, k ? (double)(k * powl(at[q], k - 1)) : 0, 1e-16, 1);
    }
  }
}

/* d_j = -l_j'(0) on the points 0, c_1 .. c_s, and sum_j d_j c_j^k = -delta_k1 for k = 1 .. s.
 * */
static void error_weights_agree(void)
{
  for (int k = 0; k < REFERENCES; k++) {
    const struct reference *r = radau_reference + k;
    long double x[STEIF_STAGES] = {0}, value[STEIF_STAGES], slope[STEIF_STAGES];
    CHECK(!stf_nodes(NULL, STF_RADAU_RIGHT, r->s, x + 1));
    stf_lagrange(r->s + 1, x, 0, value, slope);
    for (int j = 0; j < r->s; j++) CLOSE((double)-slope[j + 1], r->d[j], 1e-15);
    for (int power = 1; power <= r->s; power++) {
      long double sum = power == 1;
      for (int j = 1; j <= r->s; j++) sum -= slope[j] * powl(x[j], power);
      CHECK(fabsl(sum) < 1e-16L);
    }
  }
}

static void wrong_counts_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  long double c[STEIF_STAGES + 1];
  CHECK(stf_nodes(ctx, STF_LOBATTO, 1, c) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "2 to 32 stages, not for 1"));
  CHECK(stf_nodes(ctx, STF_GAUSS, 0, c) == STEIF_BAD_INPUT);
  CHECK(stf_nodes(ctx, STF_RADAU_LEFT, STEIF_STAGES + 1, c) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_nodes[] = {
  {"Radau nodes agree with 20 published digits", radau_nodes_agree},
  {"Gauss, Lobatto and left Radau nodes agree with handbooks", closed_forms_agree},
  {"nodes ascend and hold the end points of their kind", end_points_and_order},
  {"left Radau nodes mirror right ones", left_and_right_mirror},
  {"Gauss's rule is exact to degree 2m - 1 and no further", gauss_integrates},
  {"Lagrange's basis reproduces and differentiates powers", lagrange_differentiates},
  {"Radau's error weights agree with 20 published digits", error_weights_agree},
  {"impossible numbers of nodes are refused with the range", wrong_counts_are_refused},
  CU_TEST_INFO_NULL};
