/* Starting procedures, names and refusals of the methods.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <string.h>

static void refused(const char *problem, const char *method, const steif_options *o, int status,
                    const char *words)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, problem, &p));
  steif_solver *s = steif_solver_new(ctx, &p, method, o);
  const int good = !s && steif_status(ctx) == status && strstr(steif_message(ctx), words);
  if (!good) printf("\n  %s %s: %s", problem, method, steif_message(ctx));
  CHECK(good);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void names_are_checked(void)
{
  steif_options o = steif_defaults();
  o.h = 0.01;
  refused("hires", "radua:s=3", &o, STEIF_UNKNOWN_NAME, "'radau'");
  refused("hires", "dirk:alexandr2", &o, STEIF_UNKNOWN_NAME, "alexander2");
  refused("hires", "dirk", &o, STEIF_BAD_INPUT, "dirk:alexander2");
  refused("hires", "bdf:p=7", &o, STEIF_BAD_INPUT, "from 1 to 6");
  refused("hires", "bdf:p=2.5", &o, STEIF_BAD_INPUT, "whole number");
  refused("hires", "bdf:q=2", &o, STEIF_UNKNOWN_NAME, "'q'");
  refused("hires", "be:p=1", &o, STEIF_UNKNOWN_NAME, "'p'");
  refused("hires", "gauss:s=33", &o, STEIF_BAD_INPUT, "s=33");
  refused("hires", "gauss:s=0", &o, STEIF_BAD_INPUT, "s=0");
  refused("hires", "bdf:p=2,start=warp", &o, STEIF_UNKNOWN_NAME, "ramp, constant");
  refused("hires", "", &o, STEIF_BAD_INPUT, "cannot read");
}

static void forms_and_starts_are_checked(void)
{
  steif_options o = steif_defaults();
  o.h = 0.001;
  refused("chemakzo", "rk4", &o, STEIF_UNSUPPORTED, "form mass");
  refused("hires", "bdf:p=3,start=cq", &o, STEIF_UNSUPPORTED, "cq");
  refused("hires", "bdf:p=3,start=exact", &o, STEIF_UNSUPPORTED, "no");
  refused("jordan:k=3,case=H-inc", "dirk:cranknicolson", &o, STEIF_UNSUPPORTED, "slope");
  o.h = 0;
  refused("hires", "rk4", &o, STEIF_UNSUPPORTED, "no error estimate");
  refused("hires", "radau1a:s=2", &o, STEIF_UNSUPPORTED, "no error estimate");
  refused("stiffpair", "bdf:p=2,start=exact", &o, STEIF_UNSUPPORTED, "set h");
}

/* Polynomials of degree p are integrated exactly by BDF-p on any mesh from exact values: y' = 0 y +
 * p t^{p-1} cannot be said with the collection, so the harmonic oscillator with tiny and uneven
 * steps checks the variable coefficients by their order instead. */
static double mesh_error(steif_context *ctx, const steif_problem *p, const char *method,
                         size_t n)
{
  double mesh[513], y[2];
  for (size_t i = 0; i <= n; i++) {
    const double x = (double)i / (double)n;
    mesh[i] = p->t1 * (x + 0.1 * sin(6.283185307179586 * x));
  }
  mesh[0] = 0, mesh[n] = p->t1;
  steif_options o = steif_defaults();
  o.mesh = mesh, o.mesh_size = n + 1;
  steif_solver *s = steif_solver_new(ctx, p, method, &o);
  CU_ASSERT_FATAL(s && !steif_solve_to(s, p->t1));
  y[0] = NV_Ith_S(steif_solution(s), 0);
  steif_solver_free(&s);
  return fabs(y[0] - cos(p->t1));
}

static void meshes_keep_the_order(void)
{
  static const struct {
    const char *method;
    double order;
  } rows[] = {{"be", 1},
              {"bdf:p=2", 2},
              {"bdf:p=3,start=exact", 3},
              {"bdf:p=4,start=exact", 4},
              {"radau:s=2", 3},
              {"dirk:alexander3", 3},
              {"gauss:s=2", 4}};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "harmonic", &p));
  for (int m = 0; m < 7; m++) {
    const double order =
      log2(mesh_error(ctx, &p, rows[m].method, 128) / mesh_error(ctx, &p, rows[m].method, 256));
    CLOSE_FLOOR(order, rows[m].order, 0.2, 1);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_start[] = {{"names are checked", names_are_checked},
                                {"forms and starts are checked", forms_and_starts_are_checked},
                                {"meshes keep the order", meshes_keep_the_order},
                                CU_TEST_INFO_NULL};
