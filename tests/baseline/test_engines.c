/* test_engines.c: CVODE, IDA and ARKODE on ordinary differential equations.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ride.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static const char *const all[] = {"cvode", "ida", "arkode"};

/* y1' = -1370 (y1 - cos t) - sin t, y2' = -0.73 y2: y = (cos t, 1.37 exp(-0.73 t)). */
static int pair(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *x = NV_DATA_S(y);
  NV_Ith_S(ydot, 0) = -1370 * (x[0] - cos(t)) - sin(t);
  NV_Ith_S(ydot, 1) = -0.73 * x[1];
  if (user) ++*(long *)user;
  return 0;
}

static int pair_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
                    N_Vector b, N_Vector c)
{
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = -1370;
  SM_ELEMENT_D(J, 1, 1) = -0.73;
  return 0;
}

static const sunrealtype pair_y0[] = {1, 1.37};
static const steif_problem stiff_pair = {
  .name = "pair", .n = 2, .t1 = 2.3, .y0 = pair_y0, .f = pair, .jac = pair_jac};

static void pair_to_tolerance(void)
{
  steif_options o = ride_defaults();
  o.rtol = o.atol = 1e-8;
  for (int e = 0; e < 3; e++) {
    ride r;
    CHECK(ride_whole(&r, &stiff_pair, all[e], &o) == STEIF_OK);
    CHECK(r.run.t == 2.3);
    CLOSE(ride_y(&r, 0), cos(2.3), 1e-6);
    CLOSE(ride_y(&r, 1), 1.37 * exp(-0.73 * 2.3), 1e-6);
    CHECK(r.run.stats.steps > 10 && r.run.stats.nje > 0 && r.run.stats.nlu > 0);
    CHECK(r.run.stats.newton >= r.run.stats.steps && r.run.stats.h_last > 0);
    ride_close(&r);
  }
}

static void evaluations_are_all_counted(void)
{
  for (int e = 0; e < 3; e++)
    for (int exact = 0; exact < 2; exact++) {
      long calls = 0;
      steif_problem p = stiff_pair;
      p.user = &calls;
      if (!exact) p.jac = NULL;
      ride r;
      CHECK(ride_whole(&r, &p, all[e], NULL) == STEIF_OK);
      CHECK(r.run.stats.nfe <= calls && calls <= r.run.stats.nfe + 2);
      CLOSE(ride_y(&r, 0), cos(2.3), 1e-4);
      ride_close(&r);
    }
}

static void dense_output_inside_a_step(void)
{
  N_Vector inside;
  for (int e = 0; e < 3; e++) {
    ride r;
    CHECK(ride_open(&r, &stiff_pair, all[e], NULL) == STEIF_OK);
    while (r.run.t < 0.9 && !r.code) r.code = r.engine->step(&r.run, r.state, 2.3);
    const sunrealtype t = r.run.t - 0.37 * r.run.stats.h_last;
    inside = N_VClone(r.run.y);
    CHECK(r.engine->dense(&r.run, r.state, t, inside) == STEIF_OK);
    CLOSE(NV_Ith_S(inside, 1), 1.37 * exp(-0.73 * t), 2e-4);
    CHECK(r.engine->dense(&r.run, r.state, r.run.t + 1, inside) == STEIF_BAD_INPUT);
    CHECK(strstr(ride_says(&r), "last step") != NULL);
    N_VDestroy(inside);
    ride_close(&r);
  }
}

static void order_limits_what_is_reached(void)
{
  for (int e = 0; e < 2; e++) {
    ride low, high;
    char spec[32];
    snprintf(spec, sizeof spec, "%s:order=1", all[e]);
    CHECK(ride_whole(&low, &stiff_pair, spec, NULL) == STEIF_OK);
    CHECK(ride_whole(&high, &stiff_pair, all[e], NULL) == STEIF_OK);
    CHECK(low.run.stats.steps > 5 * high.run.stats.steps);
    ride_close(&low);
    ride_close(&high);
  }
}

/* u' = 400 (u_{i-1} - 2 u_i + u_{i+1}), u = 0 at the ends: the mode sin(pi i / (n+1)) decays
 * with 400 (2 - 2 cos(pi / (n+1))). */
enum { N = 19 };
static const sunrealtype K = 400;

static int heat(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  (void)t, (void)user;
  const sunrealtype *u = NV_DATA_S(y);
  for (int i = 0; i < N; i++)
    NV_Ith_S(ydot, i) = K * ((i ? u[i - 1] : 0) - 2 * u[i] + (i < N - 1 ? u[i + 1] : 0));
  return 0;
}

static int heat_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
                    N_Vector b, N_Vector c)
{
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  sunindextype k = 0;
  for (int j = 0; j < N; j++) {
    if (SUNMatGetID(J) == SUNMATRIX_SPARSE) SM_INDEXPTRS_S(J)[j] = k;
    for (int i = j ? j - 1 : 0; i <= j + 1 && i < N; i++) {
      const sunrealtype value = i == j ? -2 * K : K;
      switch (SUNMatGetID(J)) {
      case SUNMATRIX_DENSE: SM_ELEMENT_D(J, i, j) = value; break;
      case SUNMATRIX_BAND: SM_ELEMENT_B(J, i, j) = value; break;
      default: SM_INDEXVALS_S(J)[k] = i, SM_DATA_S(J)[k++] = value;
      }
    }
  }
  if (SUNMatGetID(J) == SUNMATRIX_SPARSE) SM_INDEXPTRS_S(J)[N] = k;
  return 0;
}

static int heat_times(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out,
                      void *user)
{
  (void)y, (void)yp;
  ++*(long *)user;
  return heat(t, x, out, user);
}

static void heat_start(sunrealtype *y0)
{
  for (int i = 0; i < N; i++) y0[i] = sin(acos(-1.0) * (i + 1) / (N + 1));
}

static void check_heat(const steif_problem *p, const steif_options *o, const char *engine)
{
  const sunrealtype rate = K * (2 - 2 * cos(acos(-1.0) / (N + 1)));
  ride r;
  CHECK(ride_whole(&r, p, engine, o) == STEIF_OK);
  if (r.code) printf("\n  %s, storage %d: %s", engine, (int)p->storage, ride_says(&r));
  for (int i = 0; i < N; i += 6) CLOSE(ride_y(&r, i), p->y0[i] * exp(-rate * p->t1), 2e-4);
  ride_close(&r);
}

static void storages_agree(void)
{
  sunrealtype y0[N];
  heat_start(y0);
  long products = 0;
  steif_options usual = ride_defaults();
  usual.rtol = usual.atol = 1e-8;
  steif_options dense = usual, krylov = usual;
  dense.force_storage = krylov.force_storage = 1;
  dense.storage = STEIF_DENSE, krylov.storage = STEIF_KRYLOV;
  for (int storage = STEIF_DENSE; storage <= STEIF_KRYLOV; storage++)
    for (int e = 0; e < 3; e++)
      for (int exact = 0; exact < 2; exact++) {
        steif_problem p = {.name = "heat",
                           .n = N,
                           .t1 = 0.083,
                           .y0 = y0,
                           .f = heat,
                           .storage = (enum steif_storage)storage,
                           .lower = 1,
                           .upper = 1,
                           .nnz = 3 * N - 2,
                           .user = &products};
        if (storage == STEIF_KRYLOV) {
          if (exact) p.Av = heat_times;
        } else if (exact) {
          p.jac = heat_jac;
        } else if (storage == STEIF_SPARSE) {
          continue;
        }
        check_heat(&p, &usual, all[e]);
        if (exact) check_heat(&p, &dense, all[e]);
        check_heat(&p, &krylov, all[e]);
      }
  CHECK(products > 100);
}

static void sparse_needs_entries(void)
{
  sunrealtype y0[N];
  heat_start(y0);
  const steif_problem p = {.name = "heat",
                           .n = N,
                           .t1 = 0.083,
                           .y0 = y0,
                           .f = heat,
                           .storage = STEIF_SPARSE,
                           .nnz = 3 * N - 2};
  for (int e = 0; e < 3; e++) {
    ride r;
    CHECK(ride_open(&r, &p, all[e], NULL) == STEIF_UNSUPPORTED);
    CHECK(strstr(ride_says(&r), ".jac") != NULL);
    ride_close(&r);
  }
}

static void tolerances_by_component(void)
{
  const sunrealtype atols[] = {1e-3, 1e-11};
  steif_options o = ride_defaults();
  o.rtol = 1e-10, o.atols = atols;
  for (int e = 0; e < 3; e++) {
    ride r;
    CHECK(ride_whole(&r, &stiff_pair, all[e], &o) == STEIF_OK);
    CLOSE(ride_y(&r, 1), 1.37 * exp(-0.73 * 2.3), 1e-7);
    ride_close(&r);
  }
}

static void first_and_largest_steps_are_kept(void)
{
  steif_options o = ride_defaults();
  o.h0 = 1.7e-5, o.h_max = 0.031;
  for (int e = 0; e < 3; e++) {
    ride r;
    CHECK(ride_open(&r, &stiff_pair, all[e], &o) == STEIF_OK);
    CHECK(r.engine->step(&r.run, r.state, 2.3) == STEIF_OK);
    CHECK(r.run.t > 0 && r.run.t <= 1.7e-5 * (1 + 1e-12));
    sunrealtype largest = 0;
    while (!r.code && r.run.t < 2.3) {
      r.code = r.engine->step(&r.run, r.state, 2.3);
      largest = fmax(largest, r.run.stats.h_last);
    }
    CHECK(r.code == STEIF_OK && largest <= 0.031 * (1 + 1e-12));
    CHECK(r.run.stats.steps >= 74); /* 2.3 / 0.031 */
    ride_close(&r);
  }
}

static void runs_do_not_disturb_each_other(void)
{
  ride alone, r[3];
  CHECK(ride_whole(&alone, &stiff_pair, "cvode", NULL) == STEIF_OK);
  for (int e = 0; e < 3; e++) CHECK(ride_open(&r[e], &stiff_pair, all[e], NULL) == STEIF_OK);
  for (bool moving = true; moving;) {
    moving = false;
    for (int e = 0; e < 3; e++) {
      if (r[e].code || r[e].run.t >= 2.3) continue;
      r[e].code = r[e].engine->step(&r[e].run, r[e].state, 2.3);
      moving = true;
    }
  }
  CHECK(ride_y(&r[0], 0) == ride_y(&alone, 0) && ride_y(&r[0], 1) == ride_y(&alone, 1));
  for (int e = 0; e < 3; e++) {
    CLOSE(ride_y(&r[e], 0), cos(2.3), 1e-4);
    ride_close(&r[e]);
  }
  ride_close(&alone);
}

static void opened_and_closed_again_and_again(void)
{
  sunrealtype first[3] = {0, 0, 0};
  for (int k = 0; k < 20; k++)
    for (int e = 0; e < 3; e++) {
      ride r;
      CHECK(ride_open(&r, &stiff_pair, all[e], NULL) == STEIF_OK);
      if (k % 2) ride_to(&r, 2.3);
      if (k == 1) first[e] = ride_y(&r, 0);
      if (k % 2) CHECK(ride_y(&r, 0) == first[e]);
      ride_close(&r);
    }
}

/* y' = -30 (y - s(t)), s = 1 until 0.7, then -2: from 1, y = -2 + 3 exp(-30 (t - 0.7)). */
static int jump(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const bool late = *(bool *)user ? t >= 0.7 : t > 0.7;
  NV_Ith_S(ydot, 0) = -30 * (NV_Ith_S(y, 0) - (late ? -2 : 1));
  return 0;
}

static void breaks_are_stopped_at(void)
{
  const sunrealtype y0[] = {1}, breaks[] = {0, 0.7, 0.95, 3};
  bool closed = false;
  const steif_problem p = {.user = &closed,
                           .name = "jump",
                           .n = 1,
                           .t1 = 1,
                           .y0 = y0,
                           .f = jump,
                           .breaks = breaks,
                           .break_count = 4};
  steif_problem unaware = p;
  unaware.break_count = 0;
  sunrealtype first[3] = {0, 0, 0};
  for (int k = 0; k < 6; k++) {
    const int e = k % 3;
    closed = k < 3; /* f has its new value at the break */
    ride r, other;
    CHECK(ride_open(&r, &p, all[e], NULL) == STEIF_OK);
    int seen = 0;
    sunrealtype last = 0;
    while (!r.code && r.run.t < 1) {
      r.code = r.engine->step(&r.run, r.state, 1);
      seen += r.run.t == 0.7 || r.run.t == 0.95;
      CHECK(r.run.t > last);
      last = r.run.t;
    }
    if (r.code) printf("\n  %s", ride_says(&r));
    CHECK(r.code == STEIF_OK && seen == 2 && r.run.t == 1);
    CLOSE(ride_y(&r, 0), -2 + 3 * exp(-30 * 0.3), 1e-4);
    CHECK(ride_whole(&other, &unaware, all[e], NULL) == STEIF_OK);
    CHECK(r.run.stats.rejected < other.run.stats.rejected);
    if (closed) first[e] = ride_y(&r, 0);
    CHECK(ride_y(&r, 0) == first[e]);
    CHECK(r.run.stats.steps > 20 && r.run.stats.nfe > r.run.stats.steps);
    ride_close(&other);
    ride_close(&r);
  }
}

CU_TestInfo tests_of_engines[] = {
  {"a stiff pair is solved to tolerance", pair_to_tolerance},
  {"every evaluation of f is counted", evaluations_are_all_counted},
  {"dense output inside the last step", dense_output_inside_a_step},
  {"a low order takes more steps", order_limits_what_is_reached},
  {"dense, band, sparse and Krylov agree", storages_agree},
  {"sparse storage without entries is refused", sparse_needs_entries},
  {"tolerances by component", tolerances_by_component},
  {"first and largest step are kept", first_and_largest_steps_are_kept},
  {"declared breaks are stopped at", breaks_are_stopped_at},
  {"interleaved runs do not disturb each other", runs_do_not_disturb_each_other},
  {"opened and closed again and again", opened_and_closed_again_and_again},
  CU_TEST_INFO_NULL};
