/* CVODE, IDA and ARKODE through the same calls as the methods of this library, and the list of
 * methods.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"

static void engines_solve_the_stiff_pair(void)
{
  static const char *const methods[] = {"cvode", "ida", "arkode", "radau:s=3", "bdf:p=5"};
  for (int m = 0; m < 5; m++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p;
    CU_ASSERT_FATAL(!steif_problem_find(ctx, "stiffpair", &p));
    steif_options o = steif_defaults();
    o.rtol = 1e-7;
    steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
    CHECK(!steif_solve_to(s, 1.3) && steif_time(s) == 1.3);
    CLOSE_FLOOR(NV_Ith_S(steif_solution(s), 0), exp(-1.3), 2e-6, 1);
    CLOSE_FLOOR(NV_Ith_S(steif_solution(s), 1), 0, 2e-6, 1);
    CHECK(!steif_solve_to(s, p.t1) && steif_time(s) == p.t1);
    CLOSE_FLOOR(NV_Ith_S(steif_solution(s), 0), exp(-p.t1), 2e-6, 1);
    const steif_stats *n = steif_statistics(s);
    CHECK(n->steps > 10 && n->nfe > n->steps && n->nje > 0 && n->nlu > 0 && n->h_last > 0);
    CHECK(!strcmp(steif_method_used(s), methods[m]));
    steif_solver_free(&s);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
}

static void engines_refuse_what_they_cannot(void)
{
  steif_options o = steif_defaults();
  o.h = 0.1;
  smooth_refused(&smooth, "cvode", &o, STEIF_UNSUPPORTED, "chooses its own steps");
  o.h = 0;
  smooth_refused(&smooth, "cvode:p=2", &o, STEIF_UNKNOWN_NAME, "'p'");
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "chemakzo", &p));
  smooth_refused(&p, "cvode", &o, STEIF_UNSUPPORTED,
                 "'cvode' does not accept problems of form mass such as 'chemakzo'");
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void every_method_of_the_list_opens(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_method_info info;
  size_t count = 0;
  for (; !steif_method_at(ctx, count, &info); count++) {
    if (!(info.forms & STEIF_ODE)) continue;
    if (info.family && !strcmp(info.family, "splitting")) continue;
    CHECK(info.about && *info.about && info.family && *info.name);
    steif_options o = steif_defaults();
    o.h = info.adaptive ? 0 : 0.02;
    if (info.order == 1) o.rtol = 1e-3; /* six digits would be millions of steps */
    steif_solver *s = steif_solver_new(ctx, &smooth, info.name, &o);
    if (!s && steif_status(ctx) == STEIF_UNSUPPORTED) continue; /* separable systems only */
    const int code = s ? steif_solve_to(s, 2) : steif_status(ctx);
    const double error = s ? smooth_error(2, steif_solution(s)) : NAN;
    if (code || !(error < 0.03))
      printf("\n  %s: %.3g %s", info.name, error, steif_message(ctx));
    CHECK(!code && error < 0.03);
    steif_solver_free(&s);
  }
  CHECK(count > 30);
  CHECK(steif_method_at(ctx, count, &info) == STEIF_BAD_INPUT);
  CHECK(steif_method_at(ctx, count + 1000, &info) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_engines[] = {
  {"engines solve the stiff pair by the same calls", engines_solve_the_stiff_pair},
  {"engines refuse what they cannot", engines_refuse_what_they_cannot},
  {"every method of the list opens and runs", every_method_of_the_list_opens},
  CU_TEST_INFO_NULL};
