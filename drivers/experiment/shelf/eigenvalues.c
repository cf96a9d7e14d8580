/* eigenvalues.c: where discretisations send the eigenvalues -1/4 +- 1.984 i of q'' + q'/2 + 4 q, at
 * dt = 0.1, and along 0 < dt <= 1 in the picture. References: forward Euler 1 + l dt, hold e^{l dt},
 * bilinear (1 + l dt/2)/(1 - l dt/2), backward Euler 1/(1 - l dt), in 17 digits.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"
#include <math.h>
#include <steif/discrete.h>

static const struct {
  const char *scheme;
  double re, im, modulus;
} known[] = {
  {"forward", 0.975, 0.19843134832984429, 0.9949874371066200},
  {"zoh", 0.9561714201391411, 0.1922645048099431, 0.9753099120283327},
  {"bilinear", 0.9565217391304348, 0.1917211094974341, 0.9755464218867486},
  {"backward", 0.9403669724770642, 0.1820471085594902, 0.9578262852211515},
};

static int eigenvalue(stf_trial *t, const char *scheme, double dt, double *re, double *im)
{
  static const double A[] = {0, -4, 1, -0.5};
  const steif_state_space s = {.n = 2, .A = A};
  steif_discrete d;
  STEIF_TRY(steif_c2d(t->ctx, &s, scheme, dt, &d));
  *re = d.re[0];
  *im = fabs(d.im[0]);
  steif_discrete_clear(t->ctx, &d);
  return STEIF_OK;
}

static int circle(stf_trial *t)
{
  enum { POINTS = 181 };
  STEIF_TRY(stf_curve(t, "unit circle", 0));
  for (int i = 0; i < POINTS; i++) {
    const double x = 3.14159265358979323846 * i / (POINTS - 1);
    STEIF_TRY(stf_curve_point(t, cos(x), sin(x)));
  }
  return STEIF_OK;
}

static int run(stf_trial *t)
{
  double re = NAN, im = NAN;
  STEIF_TRY(circle(t));
  for (int i = 0; i < 4; i++) {
    const char *scheme = known[i].scheme;
    STEIF_TRY(eigenvalue(t, scheme, 0.1, &re, &im));
    STEIF_TRY(stf_find(t, scheme, 0.1, "real part", re, known[i].re, 1e-14));
    STEIF_TRY(stf_find(t, scheme, 0.1, "imaginary part", im, known[i].im, 1e-14));
    STEIF_TRY(stf_find(t, scheme, 0.1, "modulus", hypot(re, im), known[i].modulus, 1e-14));
    STEIF_TRY(stf_curve(t, scheme, 1));
    for (int k = 1; k <= 20; k++) {
      STEIF_TRY(eigenvalue(t, scheme, 0.05 * k, &re, &im));
      STEIF_TRY(stf_curve_point(t, re, im));
    }
  }
  return STEIF_OK;
}

const steif_experiment steif_experiment_eigenvalues = {
  .about = "migration of eigenvalues under discretisation",
  .frame = {.title = "Eigenvalues of q'' + q'/2 + 4 q, dt = 0.05 ... 1",
            .x_label = "Re",
            .y_label = "Im",
            .equal = 1},
  .run = run,
};
