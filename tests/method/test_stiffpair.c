/* Errors of the stiff linear pair x' = diag(-1, -1000) x, x(0) = (1, 1), at T = 4 with h = 1/2 ...
 * 1/32, in the maximum norm. Reference figures: recomputation of the book chapter's experiment with
 * numpy and mpmath (10 digits printed; those of order 1e-10 and below are limited by rounding).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/steif.h>

static const struct {
  const char *method;
  double error[5], tolerance;
} rows[] = {
  {"be",
   {2.0702803422e-02, 9.8318587823e-03, 4.7581694934e-03, 2.3356861264e-03, 1.1564669106e-03},
   1e-9},
  {"bdf:p=2",
   {3.9927222221e-03, 8.3222219986e-04, 1.8601182957e-04, 4.4038988300e-05, 1.0717276289e-05},
   1e-9},
  {"bdf:p=2,start=exact",
   {7.7512226567e-03, 1.6929526392e-03, 4.0062291749e-04, 9.7693934388e-05, 2.4131733262e-05},
   1e-9},
  {"bdf:p=3,start=exact",
   {3.0039438896e-03, 3.2747384385e-04, 3.8372016402e-05, 4.6334814379e-06, 5.6903412908e-07},
   1e-8},
  {"bdf:p=4,start=exact",
   {1.2272227274e-03, 6.8445678371e-05, 3.9338248084e-06, 2.3470212679e-07, 1.4320508866e-08},
   1e-7},
  {"bdf:p=5,start=exact",
   {5.4125003373e-04, 1.4826719388e-05, 4.1995187824e-07, 1.2387371726e-08, 3.7549680e-10},
   1e-5},
  {"bdf:p=6,start=exact",
   {2.3818729142e-04, 3.3327355372e-06, 4.592576715e-08, 6.72506429e-10, 1.012956e-11},
   2e-4},
  {"bdf:p=3,start=ramp", {-1, -1, 1.9369749022e-04, 4.6934922341e-05, 1.1571511267e-05}, 1e-9},
  {"dirk:cranknicolson",
   {9.3800467936e-01, 7.7413774079e-01, 3.5912405440e-01, 1.6615837687e-02, 5.9620249676e-06},
   1e-8},
  {"dirk:alexander2",
   {7.7456083585e-04, 1.8939439156e-04, 4.6820042606e-05, 1.1639078752e-05, 2.9015359108e-06},
   1e-9},
  {"dirk:alexander3",
   {1.8571276010e-04, 2.5924093701e-05, 3.4533775468e-06, 4.4674346619e-07, 5.6848609636e-08},
   1e-8},
  {"radau:s=2",
   {1.1324758654e-04, 1.4940705004e-05, 1.9244358185e-06, 2.4438693393e-07, 3.0797279636e-08},
   2e-8},
  {"radau:s=3",
   {2.9523378511e-07, 9.5472066641e-09, 3.0415989172e-10, 9.6023675e-12, 3.01e-13},
   5e-3},
  {"gauss:s=2",
   {8.2530686856e-01, 4.6394002372e-01, 4.6328422126e-02, 4.6068015e-06, 9.7046e-11},
   1e-5},
};

static void errors_are_those_of_the_chapter(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "stiffpair", &p));
  for (size_t m = 0; m < sizeof rows / sizeof *rows; m++) {
    steif_order_row row[5];
    CHECK(!steif_order_measure(ctx, &p, rows[m].method, NULL, 0.5, 5, row));
    for (int i = 0; i < 5; i++)
      if (rows[m].error[i] > 0) {
        /* the last two Radau entries are at the rounding of y(4) = 0.018 */
        const double tolerance =
          rows[m].error[i] > 1e-6 ? fmin(rows[m].tolerance, 1e-7) : rows[m].tolerance;
        CLOSE(row[i].error, rows[m].error[i], tolerance);
      }
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void fast_component_of_crank_nicolson_stays(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  o.h = 0.5;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "stiffpair", &p));
  steif_solver *s = steif_solver_new(ctx, &p, "dirk:cranknicolson", &o);
  CU_ASSERT_FATAL(s && !steif_solve_to(s, 4));
  CLOSE(NV_Ith_S(steif_solution(s), 1), 0.9380046794, 1e-9);
  steif_solver_free(&s);
  s = steif_solver_new(ctx, &p, "be", &o);
  CU_ASSERT_FATAL(s && !steif_solve_to(s, 4));
  CLOSE(NV_Ith_S(steif_solution(s), 1), 2.519406e-22, 1e-6); /* (1/501)^8 */
  CLOSE(NV_Ith_S(steif_solution(s), 0), 0.039018442311, 1e-10);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_stiffpair[] = {
  {"errors are those of the chapter", errors_are_those_of_the_chapter},
  {"Crank-Nicolson does not damp, backward Euler does", fast_component_of_crank_nicolson_stays},
  CU_TEST_INFO_NULL};
