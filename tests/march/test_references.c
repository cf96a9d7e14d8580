/* Every reference of the collection, by two methods of different families or numbers of stages, to the digits
 * it claims; where rounding leaves fewer, to these, and in test_extended.c to all.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"
#include <stdbool.h>
#include <string.h>

typedef struct row {
  const char *problem, *method[2];
  double rtol;
  bool significant; /* of each component (scd), not relative to 1 + |y| (mescd) */
  double reached;   /* > 0: less than is claimed, because of ... */
  const char *why;
} row;

static const row rows[] = {
  {"allencahn", {"radau:s=7", "gauss:s=4"}, 1e-11, false, 0, NULL},
  {"andrews", {"radau:s=4", "radau:s=5"}, 1e-11, false, 0, NULL},
  {"beam", {"radau:s=7", "gauss:s=4"}, 1e-10, false, 0, NULL},
  {"bruss2d", {"radau:s=7", "dopri87"}, 1e-12, false, 0, NULL},
  {"caraxis", {"radau:s=5", "radau:s=7"}, 1e-12, false, 0, NULL},
  {"chemakzo", {"radau:s=7", "gauss:s=4"}, 1e-13, false, 0, NULL},
  {"e5",
   {"radau:s=5", "gauss:s=4"},
   1e-10,
   false,
   4.5,
   "1e-22 as a difference of 1e-10; see extended"},
  {"fekete", {"radau:s=5", "radau:s=7"}, 1e-10, false, 0, NULL},
  {"hires", {"radau:s=4", "gauss:s=4"}, 1e-13, false, 0, NULL},
  {"lorenz", {"radau:s=7", "dopri87"}, 1e-11, false, 7.5, "grows 38 000-fold; see extended"},
  {"lorenz96", {"gauss:s=4", "dopri87"}, 1e-11, false, 8.5, "grows 460 000-fold; see extended"},
  {"medakzo", {"radau:s=5", "gauss:s=4"}, 1e-12, true, 0, NULL},
  {"orego", {"radau:s=7", "gauss:s=4"}, 1e-13, false, 0, NULL},
  {"pendulum", {"radau:s=7", "dopri87"}, 1e-11, false, 13, "rounding; see extended"},
  {"plei", {"radau:s=7", "dopri87"}, 1e-11, false, 0, NULL},
  {"pollu", {"radau:s=7", "gauss:s=4"}, 1e-11, false, 0, NULL},
  {"ringmod", {"radau:s=7", "gauss:s=4"}, 1e-12, true, 0, NULL},
  {"rober", {"radau:s=7", "gauss:s=4"}, 1e-11, false, 0, NULL},
  {"roessler", {"radau:s=7", "dopri87"}, 1e-11, false, 12, "rounding; see extended"},
  {"transamp", {"radau:s=5", "radau:s=7"}, 1e-11, false, 0, NULL},
  {"vdpol", {"radau:s=4", "gauss:s=4"}, 1e-13, false, 0, NULL},
  {"vdpol:mu=10", {"radau:s=7", "gauss:s=4"}, 1e-11, false, 0, NULL},
  {"vdpol:mu=30",
   {"radau:s=7", "gauss:s=4"},
   1e-13,
   false,
   11,
   "rounding of the phase, up to 6e-12; see extended"},
};

static void reach(steif_context *ctx, const steif_problem *p, const row *at, const char *method)
{
  const double wanted = at->reached > 0 ? at->reached : p->reference->digits;
  steif_options o = steif_defaults();
  o.rtol = at->rtol, o.recompute = 1; /* as the program does */
  sunrealtype scd = NAN, mescd = NAN;
  steif_solver *s = smooth_open(ctx, p, method, &o);
  CHECK(steif_solve_to(s, p->reference->t) == STEIF_OK);
  CHECK(steif_problem_digits(ctx, p, p->reference->t, steif_solution(s),
                             p->rtol_scale > 0 ? p->rtol_scale : 1, &scd, &mescd) == STEIF_OK);
  const double found = at->significant ? scd : mescd;
  if (!(found >= wanted))
    printf("\n  %s, %s: %.2f digits of %.4g", p->name, method, found, wanted);
  CHECK(found >= wanted);
  CHECK(at->why || wanted >= p->reference->digits);
  steif_solver_free(&s);
}

static void references_are_reached_by_two_methods(void)
{
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p;
    CU_ASSERT_FATAL(!steif_problem_find(ctx, rows[k].problem, &p) && p.reference);
    CHECK(strcmp(rows[k].method[0], rows[k].method[1]) != 0);
    for (int m = 0; m < 2; m++) reach(ctx, &p, rows + k, rows[k].method[m]);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
}

/* Linear systems have references by formulas, which the tests of their module look at. */
static void no_reference_is_left_out(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const char *name;
  for (size_t i = 0; (name = steif_problem_name(i)); i++) {
    steif_problem p;
    if (steif_problem_find(ctx, name, &p)) continue;
    bool found = !p.reference || p.linear;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
      found = found || !strcmp(rows[k].problem, name);
    if (!found) printf("\n  %s", name);
    CHECK(found);
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_references[] = {
  {"references are reached by two methods", references_are_reached_by_two_methods},
  {"no reference is left out", no_reference_is_left_out},
  CU_TEST_INFO_NULL};
