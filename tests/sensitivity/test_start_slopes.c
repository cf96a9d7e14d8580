/* test_start_slopes.c: parameters.start beside problem.start: what contradicts it is an error, what agrees is not.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "forcing.h"
#include <steif/gradient.h>
#include <string.h>

/* y' = -k y, y(0) = v(a): dy/da = v' exp(-k t). */
typedef struct law {
  sunrealtype p[2];
  int kind;
  sunrealtype given; /* dy0/da */
} law;

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  (void)t;
  NV_Ith_S(ydot, 0) = -((law *)user)->p[0] * NV_Ith_S(y, 0);
  return 0;
}

static int by_p(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  (void)t, (void)yp, (void)user;
  NV_Ith_S(out, 0) = k == 0 ? NV_Ith_S(y, 0) : 0;
  return 0;
}

enum { PLAIN, WAVES, LOST, CORNER, EDGE };

static int start(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const law *m = user;
  const sunrealtype a = m->p[1];
  (void)t, (void)yp;
  if (m->kind == EDGE && a > 2) return 1;
  NV_Ith_S(y, 0) = m->kind == WAVES    ? sin(1e5 * a)
                   : m->kind == LOST   ? 1e10 + 1e-8 * a
                   : m->kind == CORNER ? fabs(a - 2)
                                       : a;
  return 0;
}

static int slope_of_start(int k, N_Vector S0, void *user)
{
  NV_Ith_S(S0, 0) = k == 1 ? ((law *)user)->given : 0;
  return 0;
}

static int end(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  (void)t, (void)user;
  value[0] = NV_Ith_S(y, 0);
  return 0;
}

/* The codes of a run with S, and of a gradient; the sentence of the latter in `said`. */
static int both(law *m, char *said, size_t room)
{
  static const char *const names[] = {"k", "a"};
  steif_context *ctx = steif_context_new(NULL);
  const steif_parameters q = {
    .count = 2, .value = m->p, .name = names, .dFdp = by_p, .start = slope_of_start};
  const steif_problem p = {
    .name = "law", .n = 1, .t1 = 1, .f = f, .start = start, .user = m, .parameters = &q};
  const steif_functional J = {.count = 1, .end = end};
  steif_options o = steif_defaults();
  steif_gradient g = {0};
  m->p[0] = 0.5, m->p[1] = 2;
  const int back = steif_gradient_find(ctx, &p, "radau:s=3", &o, &J, &g);
  snprintf(said, room, "%s", steif_message(ctx));
  steif_gradient_free(ctx, &g);
  o.sensitivities = 1;
  steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
  const int forth = s ? STEIF_OK : steif_status(ctx);
  CHECK(m->p[0] == 0.5 && m->p[1] == 2);
  CHECK(forth == back && !strcmp(said, steif_message(ctx)));
  steif_solver_free(&s);
  steif_context_free(&ctx);
  return back;
}

static void wrong_ones_are_named(void)
{
  static const sunrealtype wrong[] = {-1, 0.5, 0, 1.01};
  char said[700];
  for (int i = 0; i < 4; i++) {
    law m = {.given = wrong[i]};
    CHECK(both(&m, said, sizeof said) == STEIF_BAD_INPUT);
    CHECK(strstr(said, "parameter 2 (a)") &&
          strstr(said, "differences of problem.start are 1"));
  }
}

/* Derivatives that are true, of one branch, or that no difference can tell. */
static void others_are_not(void)
{
  const law trial[] = {{.given = 1},
                       {.kind = WAVES, .given = 1e5 * cos(2e5)},
                       {.kind = LOST, .given = 1e-8},
                       {.kind = CORNER, .given = 1},
                       {.kind = CORNER, .given = -1}};
  char said[700];
  for (size_t i = 0; i < sizeof trial / sizeof *trial; i++) {
    law m = trial[i];
    CHECK(both(&m, said, sizeof said) == STEIF_OK);
    if (*said) puts(said);
  }
  law m = {.kind = EDGE, .given = -1};
  CHECK(both(&m, said, sizeof said) == STEIF_OK);
}

/* ---- x' = -z, 0 = z - p x: x(0) = p, z(0) = 2 for any p ---------------------------------------- */

static sunrealtype of_x, of_z;

static int guess(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  (void)t, (void)yp;
  NV_Ith_S(y, 0) = *(const sunrealtype *)user, NV_Ith_S(y, 1) = 4;
  return 0;
}

static int of_guess(int k, N_Vector S0, void *user)
{
  (void)k, (void)user;
  NV_Ith_S(S0, 0) = of_x, NV_Ith_S(S0, 1) = of_z;
  return 0;
}

/* z = p x has dz/dp = 2 p there, whatever problem.start has for it. */
static void algebraic_unknowns_follow(void)
{
  sunrealtype p[] = {2};
  steif_context *ctx = steif_context_new(NULL);
  const steif_parameters q = {.count = 1, .value = p, .start = of_guess};
  const steif_problem problem = {.name = "constrained",
                                 .n = 2,
                                 .t1 = 1,
                                 .f = constrained_f,
                                 .E = constrained_mass,
                                 .start = guess,
                                 .user = p,
                                 .dae_index = 1,
                                 .parameters = &q};
  steif_options o = steif_defaults();
  o.sensitivities = 1;
  for (int wrong = 0; wrong < 2; wrong++) {
    of_x = wrong ? -1 : 1, of_z = wrong ? 0 : 4;
    steif_solver *s = steif_solver_new(ctx, &problem, "radau:s=3", &o);
    CHECK(wrong ? !s && steif_status(ctx) == STEIF_BAD_INPUT : s != NULL);
    if ((s == NULL) != wrong) puts(steif_message(ctx));
    if (wrong) CHECK(strstr(steif_message(ctx), "E dy0/dp of parameter 1") != NULL);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_start_slopes[] = {{"wrong ones are named", wrong_ones_are_named},
                                       {"others are not", others_are_not},
                                       {"algebraic unknowns follow", algebraic_unknowns_follow},
                                       CU_TEST_INFO_NULL};
