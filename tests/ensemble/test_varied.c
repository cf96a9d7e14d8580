/* test_varied.c: problems with other values of parameters.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/data.h>
#include <steif/ensemble.h>
#include <steif/steif.h>
#include <string.h>

static const char decay[] = "model \"decay\"\nparam k = 2, n = 2 whole\nstate x[1:n] = k\n"
                            "for i in 1:n\n  x[i]' = -k*i*x[i]\nend\ntime 0 to 1\n";

/* f_0 at the start. */
static double slope(steif_context *ctx, const steif_problem *p)
{
  N_Vector y = N_VNew_Serial(p->n, steif_sundials(ctx)), d = N_VClone(y);
  memcpy(NV_DATA_S(y), p->y0, (size_t)p->n * sizeof *p->y0);
  CHECK(p->f(p->t0, y, d, p->user) == 0);
  const double value = NV_Ith_S(d, 0);
  N_VDestroy(y), N_VDestroy(d);
  return value;
}

static void models(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p, q;
  const char *const name[] = {"k", "n"};
  const double value[] = {3, 5};
  CHECK(steif_model_parse(ctx, decay, "decay", NULL, &p) == STEIF_OK);
  CHECK(steif_problem_vary(ctx, &p, 2, name, value, &q) == STEIF_OK);
  CHECK(p.n == 2 && q.n == 5 && q.y0[0] == 3);
  CLOSE(slope(ctx, &p), -4, 0);
  CLOSE(slope(ctx, &q), -9, 0);
  steif_problem_clear(ctx, &q);
  CHECK(steif_problem_vary(ctx, &p, 1, (const char *const[]){"kk"}, value, &q) ==
        STEIF_UNKNOWN_NAME);
  CHECK(strstr(steif_message(ctx), "the nearest is 'k'") && !q.name && !q.user);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void numbers(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p, q;
  const char *const name[] = {"k1"};
  const double other[] = {0.05}, own[] = {0.04};
  CHECK(steif_problem_find(ctx, "rober", &p) == STEIF_OK);
  CHECK(steif_problem_vary(ctx, &p, 1, name, other, &q) == STEIF_OK);
  CHECK(p.reference && !q.reference);
  CLOSE(slope(ctx, &p), -0.04, 0);
  CLOSE(slope(ctx, &q), -0.05, 0);
  steif_problem_clear(ctx, &q);
  CHECK(steif_problem_vary(ctx, &p, 1, name, own, &q) == STEIF_OK && q.reference);
  steif_problem_clear(ctx, &q);
  steif_problem_clear(ctx, &p);
  /* The start of a pendulum is on its circle, whatever its length is. */
  CHECK(steif_problem_find(ctx, "pendulum3", &p) == STEIF_OK);
  CHECK(steif_problem_vary(ctx, &p, 1, (const char *const[]){"L"}, (const double[]){2}, &q) ==
        STEIF_OK);
  CLOSE(hypot(p.y0[0], p.y0[1]), 1, 1e-14);
  CLOSE(hypot(q.y0[0], q.y0[1]), 2, 1e-14);
  steif_problem_clear(ctx, &q);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Parameters of the spec: another value, or one more beside those there. */
static void specs(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p, q;
  const char *const name[] = {"n"};
  const double value[] = {30};
  CHECK(steif_problem_find(ctx, "heat:n=20", &p) == STEIF_OK);
  CHECK(steif_problem_vary(ctx, &p, 1, name, value, &q) == STEIF_OK);
  CHECK(p.n == 20 && q.n == 30);
  steif_problem_clear(ctx, &q);
  CHECK(steif_problem_vary(ctx, &p, 1, (const char *const[]){"nn"}, value, &q) < 0);
  CHECK(!q.name && !q.user);
  steif_problem_clear(ctx, &p);
  CHECK(steif_problem_find(ctx, "hires", &p) == STEIF_OK);
  CHECK(steif_problem_vary(ctx, &p, 1, name, value, &q) < 0);
  CHECK(steif_problem_vary(ctx, &p, 1, name, (const double[]){NAN}, &q) == STEIF_BAD_INPUT);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* A name that the varied problem has not is told as by steif_problem_find; of several the wrong one is named. */
static void other_forms(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p, q;
  const char *const both[] = {"mu", "eps"}, *const turned[] = {"eps", "mu"};
  const char *const wrong[] = {"mu", "mu2"}, *const last[] = {"mu2", "mu"};
  const double value[] = {10, 1};
  CHECK(steif_problem_find(ctx, "vdpol", &p) == STEIF_OK);
  CHECK(steif_problem_vary(ctx, &p, 2, both, value, &q) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "not both") && !q.name && !q.user);
  CHECK(steif_problem_vary(ctx, &p, 2, turned, value, &q) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "not both"));
  CHECK(steif_problem_vary(ctx, &p, 2, wrong, value, &q) == STEIF_UNKNOWN_NAME);
  CHECK(strstr(steif_message(ctx), "no parameter 'mu2'") && !q.name && !q.user);
  CHECK(steif_problem_vary(ctx, &p, 2, last, value, &q) == STEIF_UNKNOWN_NAME);
  CHECK(strstr(steif_message(ctx), "no parameter 'mu2'"));
  CHECK(steif_problem_vary(ctx, &p, 1, both, value, &q) == STEIF_OK);
  CHECK(q.parameters->count == 1 && q.parameters->value[0] == 10 && q.t1 == 50);
  steif_problem_clear(ctx, &q);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Index 3 with guesses; index 1 whose structure is singular. */
static const char rod[] =
  "param g = 9.81, l = 1, m = 1\nstate y = 0.6, vy = 0.5, x ~ 1, vx ~ 0, f\nx' = vx\ny' = vy\n"
  "m*vx' = -f*x\nm*vy' = -f*y - m*g\n0 = x^2 + y^2 - l^2\ntime 0 to 1\n";
static const char amplifier[] =
  "param c = 1e-3, r = 10\nstate u = 0, v ~ 3\nc*(u' - v') = u/r + sin(t)\n"
  "c*(v' - u') = exp(v)/r - 2\ntime 0 to 1\n";

/* A varied problem starts with the bits of one that is read with these values. */
static void starts(const char *text, const char *name, const char *spec, double value,
                   steif_problem *q, steif_context *ctx)
{
  steif_problem p, fresh;
  steif_spec parameters;
  CHECK(steif_spec_parse(ctx, spec, &parameters) == STEIF_OK);
  CHECK(steif_model_parse(ctx, text, "t", NULL, &p) == STEIF_OK);
  CHECK(steif_model_parse(ctx, text, "t", &parameters, &fresh) == STEIF_OK);
  CHECK(steif_problem_vary(ctx, &p, 1, &name, &value, q) == STEIF_OK);
  const size_t bytes = (size_t)p.n * sizeof *p.y0;
  CHECK(!memcmp(q->y0, fresh.y0, bytes) && memcmp(q->y0, p.y0, bytes));
  CHECK(q->yp0 && fresh.yp0 && !memcmp(q->yp0, fresh.yp0, bytes));
  CHECK(q->dae_index == fresh.dae_index && q->index && fresh.index);
  CHECK(!memcmp(q->index, fresh.index, (size_t)p.n * sizeof *q->index));
  steif_problem_clear(ctx, &p);
  steif_problem_clear(ctx, &fresh);
}

static void same_starts(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem q;
  starts(rod, "l", "t:l=1.25", 1.25, &q, ctx);
  const double x = sqrt(1.25 * 1.25 - 0.36), vx = -0.3 / x;
  CLOSE(q.y0[2], x, 1e-15);
  CLOSE(q.y0[3], vx, 1e-14);
  CLOSE(q.y0[4], (vx * vx + 0.25 - 9.81 * 0.6) / (1.25 * 1.25), 1e-14);
  CHECK(q.dae_index == 3);
  steif_problem_clear(ctx, &q);
  starts(amplifier, "r", "t:r=20", 20, &q, ctx);
  CLOSE(q.y0[1], log(40), 1e-14);
  CHECK(q.dae_index == 1);
  steif_problem_clear(ctx, &q);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_varied[] = {{"models, all values at once", models},
                                 {"numbers of problems, which leave no reference", numbers},
                                 {"parameters of specs", specs},
                                 {"names that the varied problem has not", other_forms},
                                 {"the same starts as problems that are read", same_starts},
                                 CU_TEST_INFO_NULL};
