/* law_symplectic.c: the map of one step is symplectic where the method claims it and nowhere
 * else, it comes back with turned momenta where the method is symmetric, and symplectic
 * methods keep the energy in a band, over the Hamiltonian problems and all methods listed.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "laws.h"
#ifdef HAVE_NVECTOR_OPENMP
#include <nvector/nvector_openmp.h>
#endif

static const char *const problems[] = {"pendulum", "henonheiles", "kepler:e=0.1"};

/* Rounding of differences; a map that is not symplectic is so by its local error at least,
 * which is large enough to be seen up to order HIGHEST. */
static const double rounding = 1e-10;
enum { HIGHEST = 6 };

/* A first step of these is of another method. */
static int starts_differently(const steif_method_info *m)
{
  return !strncmp(m->name, "bdf:", 4) || !strcmp(m->family, "glm");
}

static void steps_are_symplectic_as_claimed(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_method_info info;
  int seen[2] = {0, 0};
  for (size_t i = 0; steif_method_at(ctx, i, &info) == STEIF_OK; i++)
    for (size_t k = 0; k < sizeof problems / sizeof *problems; k++) {
      steif_problem p;
      steif_step_map map;
      if (info.order == 0 || starts_differently(&info)) continue;
      CU_ASSERT_FATAL(steif_problem_find(ctx, problems[k], &p) == STEIF_OK);
      const int code = steif_step_map_find(ctx, &p, info.name, 0.28, NULL, NULL, &map);
      if (code) printf("\n  %s on %s: %s", info.name, problems[k], steif_message(ctx));
      CHECK(code == STEIF_OK);
      const int symplectic = (info.claims & STEIF_SYMPLECTIC) != 0,
                symmetric = (info.claims & STEIF_SYMMETRIC) != 0,
                good = (symplectic ? map.symplectic < rounding
                                   : info.order > HIGHEST || map.symplectic > rounding) &&
                       (symmetric ? map.reversal < rounding
                                  : info.order > HIGHEST || map.reversal > rounding);
      if (!good)
        printf("\n  %s on %s: defect %.2e, claimed %d; reversal %.2e, claimed %d", info.name,
               problems[k], map.symplectic, symplectic, map.reversal, symmetric);
      CHECK(good);
      seen[symplectic]++;
      steif_problem_clear(ctx, &p);
    }
  CHECK(seen[0] > 40 && seen[1] > 50);
  steif_context_free(&ctx);
}

/* 2000 steps: what the slope has carried away at the end is a small share of the band. */
static void symplectic_methods_keep_a_band(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_method_info info;
  for (size_t i = 0; steif_method_at(ctx, i, &info) == STEIF_OK; i++)
    for (size_t k = 0; k < sizeof problems / sizeof *problems; k++) {
      steif_problem p;
      steif_drift drift[2];
      steif_energy e = {.drift = drift};
      steif_options o = steif_defaults();
      if (!(info.claims & STEIF_SYMPLECTIC)) continue;
      CU_ASSERT_FATAL(steif_problem_find(ctx, problems[k], &p) == STEIF_OK);
      o.h = 0.1, o.t1 = 200, o.newton = 1e-6;
      CHECK(steif_energy_measure(ctx, &p, info.name, &o, &e) == STEIF_OK);
      const double band = drift[0].max - drift[0].min, gone = fabs(drift[0].slope) * o.t1;
      if (!(gone < 0.15 * band + 1e-12))
        printf("\n  %s on %s: %.2e of %.2e", info.name, problems[k], gone, band);
      CHECK(gone < 0.15 * band + 1e-12);
      steif_problem_clear(ctx, &p);
    }
  steif_context_free(&ctx);
}

/* A half of f without a callback of its own is cut out by a mask: the same run but for the
 * order of sums. */
static void openmp_vectors_give_the_same_run(void)
{
#ifdef HAVE_NVECTOR_OPENMP
  static const char *const methods[] = {"verlet:compensated=0", "pefrl:compensated=1"};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "fpu:n=7", &p) == STEIF_OK);
  for (int i = 0; i < 4; i++) {
    steif_options o = steif_defaults();
    o.h = 0.1, o.t1 = 30;
    N_Vector serial = law_run(ctx, &p, methods[i % 2], &o);
    o.like = N_VNew_OpenMP(p.n, 2, steif_sundials(ctx));
    if (i > 1) p.kick = NULL;
    N_Vector threads = law_run(ctx, &p, methods[i % 2], &o);
    CU_ASSERT_FATAL(serial && threads);
    CHECK(law_distance(serial, threads) < 1e-13);
    N_VDestroy(serial), N_VDestroy(threads), N_VDestroy(o.like);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
#endif
}

CU_TestInfo tests_of_law_symplectic[] = {
  {"steps are symplectic and reversible as claimed", steps_are_symplectic_as_claimed},
  {"symplectic methods keep the energy in a band", symplectic_methods_keep_a_band},
  {"OpenMP vectors give the same run", openmp_vectors_give_the_same_run},
  CU_TEST_INFO_NULL};
