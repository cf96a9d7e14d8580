/* blowup.c: q' = p, p' = mu (1 - q^2) p - q from (2, 0) to t = 50, mu = 10 and 30. RK4 leaves beyond
 * its real limit 2.785/|l|, l = -29.97 and -89.99 at the start. The equations of backward Euler are
 * a cubic with several roots once 7 mu h > 3 (1 + h^2): it is bounded, but its period is wrong, and
 * in the jumps of long steps there is no root near: those are rejected. The roots themselves tell what
 * a run by the nearest one does. References: recomputed in NumPy, backward Euler by the roots of its
 * cubic.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"
#include <math.h>

#define MU10(method) "vdpol:mu=10", method, method ", mu = 10"
#define MU30(method) "vdpol:mu=30", method, method ", mu = 30"
#define END(q, p, digits)                                                                      \
  {STF_FIRST_END, q, digits}, { STF_SECOND_END, p, digits }

static const stf_constant_run lines[] = {
  {MU10("rk4"), 0.005, 10000, true, {END(-1.83790745, 0.07704401, 6e-9)}},
  {MU10("rk4"), 0.01, 5000, false, {END(-1.8379206, 0.07704301, 6e-8)}},
  {MU10("rk4"), 0.02, 2500, false, {END(-1.83810421, 0.07702901, 6e-9)}},
  {MU10("rk4"), 0.05, 1000, false, {END(-1.8444585, 0.07654809, 6e-8)}},
  {MU10("rk4"), 0.06, 833, false, {END(-1.85585707, 0.07570186, 6e-9)}},
  {MU10("rk4"), 0.08, 625, false, {{STF_BLOWN, 0, 0}}},
  {MU10("rk4"), 0.09, 556, false, {{STF_BLOWN, 107, 0}}},
  {MU10("rk4"), 0.1, 500, false, {{STF_BLOWN, 100, 0}}},
  {MU10("rk4"), 0.2, 250, false, {{STF_BLOWN, 3, 0}}},
  {MU30("rk4"), 0.005, 10000, true, {END(-0.86740352, 1.05817832, 6e-9)}},
  {MU30("rk4"), 0.02, 2500, false, {END(-0.94085931, 0.57028101, 6e-9)}},
  {MU30("rk4"), 0.03, 1667, false, {{STF_BLOWN, 838, 0}}},
  {MU30("rk4"), 0.04, 1250, false, {{STF_BLOWN, 8, 0}}},
  {MU30("rk4"), 0.05, 1000, false, {{STF_BLOWN, 5, 0}}},
  {MU30("rk4"), 0.2, 250, false, {{STF_BLOWN, 2, 0}}},
  {MU10("be"),
   0.005,
   10000,
   false,
   {END(-1.6373497471, 0.0966848201, 1e-9),
    {STF_LATE, 1.98297, 6e-6},
    {STF_CROSSING, 18.0625643, 6e-8}}},
  {MU10("be"),
   0.05,
   1000,
   true,
   {END(-1.6038949137, 0.1011119250, 1e-9),
    {STF_LATE, 1.78912, 6e-6},
    {STF_CROSSING, 15.2755507, 6e-8}}},
  {MU10("be"), 0.2, 250, false, {{STF_REJECTED, 1, 0}}},
  {MU30("be"),
   0.005,
   10000,
   false,
   {END(1.8456569816, -0.0255564585, 1e-9), {STF_CROSSING, 46.6310559, 6e-8}}},
  {MU30("be"), 0.05, 1000, false, {{STF_REJECTED, 1, 0}}},
};

static const stf_constant_runs data = {STF_COMPONENT, 0, sizeof lines / sizeof *lines, lines};

/* Among the multiples of 5e-4. */
static const struct {
  const char *problem, *method, *label;
  double least;
} limits[] = {{MU10("rk4"), 0.0820}, {MU30("rk4"), 0.0285}};

/* Where Newton's method finds none or another: the root that goes on from the last value. */
static const stf_cubic_line roots[] = {
  {"be, mu = 10, nearest root", 10, 0.2, 250, 1.3801511956, -0.1477057916, 1.54075, 226},
  {"be, mu = 30, nearest root", 30, 0.05, 1000, -1.5041193494, 0.0396460636, NAN, NAN},
};

static int run(stf_trial *t)
{
  STEIF_TRY(stf_constant_table(t));
  for (int i = 0; i < 2; i++) STEIF_TRY(stf_cubic_table(t, roots + i));
  for (int i = 0; i < 2; i++) {
    sunrealtype h;
    STEIF_TRY(stf_blow_up(t, limits[i].problem, limits[i].method, 5e-4, 0.1, 50, &h));
    STEIF_TRY(
      stf_find(t, limits[i].label, NAN, "least step that blows up", h, limits[i].least, 1e-9));
  }
  return STEIF_OK;
}

const steif_experiment steif_experiment_blowup = {
  .about = "van der Pol, mu = 10 and 30: step sizes with which RK4 blows up and backward Euler "
           "is wrong",
  .frame = {.title = "Van der Pol", .x_label = "t", .y_label = "q"},
  .run = run,
  .data = &data,
};
