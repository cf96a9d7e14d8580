/* growth.c: local errors and growth of a computed solution of x' = A(t) x against printed tables.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"
#include <math.h>
#include <steif/collection.h>
#include <steif/lyapunov.h>

static int measure(stf_trial *t, const stf_growth_line *l, int weak,
                   sunrealtype out[STF_DIAGNOSTICS])
{
  const steif_lyapunov_options o = {
    .h = l->h, .t1 = l->h * (sunrealtype)l->steps, .weak_start = weak};
  steif_growth_facts f;
  steif_problem p;
  STEIF_TRY(steif_problem_find(t->ctx, l->problem, &p));
  const int code = steif_growth_measure(t->ctx, &p, "bdf:p=2", &o, &f);
  steif_problem_clear(t->ctx, &p);
  if (code) return code;
  out[STF_LTE_MEAN] = f.lte_mean;
  out[STF_LTE_MAX] = f.lte_max;
  out[STF_TAU] = f.tau_max;
  out[STF_MU] = f.mu;
  out[STF_MU_LAST] = f.mu_last;
  out[STF_MU_WINDOW] = f.mu_window;
  out[STF_MU_PARTIAL] = f.mu_partial;
  out[STF_MU_RUNNING] = f.mu_running;
  return STEIF_OK;
}

/* The references have seven digits and three. */
static int line(stf_trial *t, const stf_growth_line *l, sunrealtype mu[3])
{
  static const char *const name[] = {"lte mean", "lte max",     "tau",         "mu",
                                     "mu, last", "mu, partial", "mu, running", "mu, window"},
                           *const begun[] = {"lte mean, begun with 5/6",
                                             "lte max, begun with 5/6", NULL,
                                             "mu, begun with 5/6"};
  const sunrealtype digits = 2e-6, few = 6e-3;
  sunrealtype right[STF_DIAGNOSTICS], weak[STF_DIAGNOSTICS];
  STEIF_TRY(measure(t, l, 0, right));
  STEIF_TRY(measure(t, l, 1, weak));
  for (int i = 0; i < STF_DIAGNOSTICS; i++) {
    STEIF_TRY(
      stf_find(t, l->label, l->h, name[i], right[i], l->right[i], digits * fabs(l->right[i])));
    stf_beside(t, i <= STF_MU ? l->printed[i] : NAN, weak[i]);
  }
  for (int i = 0; i <= STF_MU; i++)
    if (begun[i])
      STEIF_TRY(
        stf_find(t, l->label, l->h, begun[i], weak[i], l->weak[i], few * fabs(l->weak[i])));
  mu[0] = right[STF_MU];
  mu[1] = weak[STF_MU];
  mu[2] = l->printed[STF_MU];
  return STEIF_OK;
}

int stf_growth_table(stf_trial *t)
{
  static const char *const label[] = {"begun right", "begun with 5/6 of a step", "printed"};
  enum { MOST = 8 };
  const stf_growths *d = t->data;
  sunrealtype mu[MOST][3];
  for (size_t i = 0; i < d->lines && i < MOST; i++) STEIF_TRY(line(t, &d->line[i], mu[i]));
  for (int which = 0; which < 3; which++) {
    STEIF_TRY(stf_curve(t, label[which], 1));
    for (size_t i = 0; i < d->lines && i < MOST; i++)
      STEIF_TRY(stf_curve_point(t, d->line[i].abscissa, mu[i][which]));
  }
  return STEIF_OK;
}
