/* earlier_program.c: a program compiled with headers of the past runs with the library of today: those in
 * steif/ beside it, a copy that is renewed with SOVERSION only, and these with two members fewer in each
 * struct. What stands after the structs in memory is not 0: nobody may look there.
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/checkpoint.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static struct given {
  steif_problem problem;
  unsigned char after_problem[512];
  steif_options options;
  unsigned char after_options[512];
} given;

static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *u = NV_DATA_S(y), slow = 0.04 * u[0], back = 1e4 * u[1] * u[2],
                    fast = 3e7 * u[1] * u[1];
  (void)t, (void)user;
  NV_Ith_S(r, 0) = back - slow;
  NV_Ith_S(r, 1) = slow - back - fast;
  NV_Ith_S(r, 2) = fast;
  return 0;
}

static const sunrealtype y0[] = {1, 0, 0};
static int failed;

static void check(int good, const char *what, steif_context *ctx)
{
  if (!good) printf("%s: %s\n", what, steif_message(ctx));
  failed |= !good;
}

/* y_1(0.4) = 0.98517 (Hairer and Wanner, 1996, IV.10; cvRoberts of SUNDIALS). */
static void reaches(steif_context *ctx, steif_solver *s, const char *what)
{
  check(s && steif_solve_to(s, 0.4) == STEIF_OK &&
          fabs(NV_Ith_S(steif_solution(s), 0) - 0.98517) < 5e-6,
        what, ctx);
}

int main(int argc, char **argv)
{
  const char *path = argc > 1 ? argv[1] : "earlier.ck";
  steif_context *ctx = steif_context_new(NULL);
  memset(&given, 0xa5, sizeof given);
  given.problem = (steif_problem){.name = "robertson", .n = 3, .t1 = 40, .y0 = y0, .f = f};
  given.options = steif_defaults();
  check(given.options.rtol == 1e-6 && given.after_options[0] == 0xa5, "defaults", ctx);
  given.options.rtol = 1e-8, given.options.atol = 1e-12;
  steif_solver *s = steif_solver_new(ctx, &given.problem, "radau:s=3", &given.options);
  for (int k = 0; s && k < 5; k++) check(!steif_solve_step(s), "step", ctx);
  check(s && !steif_checkpoint_save(s, path, NULL, 0), "save", ctx);
  steif_solver *t = steif_checkpoint_load(ctx, path, &given.problem, &given.options);
  steif_solver *u = s ? steif_solver_copy(s, NULL) : NULL;
  reaches(ctx, s, "run"), reaches(ctx, t, "loaded"), reaches(ctx, u, "copy");
  N_Vector y = N_VMake_Serial(3, (sunrealtype *)y0, steif_sundials(ctx));
  check(s && !steif_solver_restart(s, 0, y, NULL, &given.problem, &given.options), "restart",
        ctx);
  steif_solver_free(&u), reaches(ctx, s, "restarted");
  /* Commas in braces go through the macros. */
  u = steif_solver_new(
    ctx, &(steif_problem){.name = "robertson", .n = 3, .t1 = 1, .y0 = y0, .f = f}, "bdf", NULL);
  check(u != NULL, "compound literal", ctx);
  steif_solver_free(&s), steif_solver_free(&t), steif_solver_free(&u);
  N_VDestroy(y), steif_context_free(&ctx), remove(path);
  puts(failed ? "failed" : "earlier headers serve");
  return failed;
}
