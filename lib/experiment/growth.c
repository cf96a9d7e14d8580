/* growth.c: local errors and growth of a computed solution of x' = A(t) x against printed tables.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"
#include <math.h>
#include <steif/collection.h>
#include <steif/lyapunov.h>

static int measure(stf_trial *t, const stf_growth_line *l, int weak, stf_growth *out)
{
  const steif_lyapunov_options o = {
    .h = l->h, .t1 = l->h * (sunrealtype)l->steps, .weak_start = weak};
  steif_growth_facts f;
  steif_problem p;
  STEIF_TRY(steif_problem_find(t->ctx, l->problem, &p));
  const int code = steif_growth_measure(t->ctx, &p, "bdf:p=2", &o, &f);
  steif_problem_clear(t->ctx, &p);
  *out = (stf_growth){f.lte_mean, f.lte_max, f.mu};
  return code;
}

/* digits: relative tolerance of the references; 0: they are only shown. */
static int find(stf_trial *t, const stf_growth_line *l, const char *const name[3],
                const stf_growth *got, const stf_growth *known, sunrealtype digits)
{
  const sunrealtype value[] = {got->lte_mean, got->lte_max, got->mu},
                    reference[] = {known->lte_mean, known->lte_max, known->mu};
  for (int i = 0; i < 3; i++)
    STEIF_TRY(stf_find(t, l->label, l->h, name[i], value[i], digits > 0 ? reference[i] : NAN,
                       digits * fabs(reference[i])));
  return STEIF_OK;
}

/* One way of all lines: 0 right, 1 weak, 2 printed. */
static int way(stf_trial *t, int which)
{
  static const char *const curve[] = {"begun right", "begun with 5/6 of a step", "printed"};
  static const char *const name[][3] = {
    {"lte mean", "lte max", "mu"},
    {"lte mean, begun with 5/6", "lte max, begun with 5/6", "mu, begun with 5/6"},
    {"lte mean as printed", "lte max as printed", "mu as printed"}};
  static const sunrealtype digits[] = {2e-6, 6e-3, 0};
  const stf_growths *d = t->data;
  STEIF_TRY(stf_curve(t, curve[which], 1));
  for (size_t i = 0; i < d->lines; i++) {
    const stf_growth_line *l = &d->line[i];
    stf_growth got = l->printed;
    if (which < 2) STEIF_TRY(measure(t, l, which, &got));
    STEIF_TRY(find(t, l, name[which], &got, which ? &l->weak : &l->right, digits[which]));
    STEIF_TRY(stf_point(t, l->abscissa, got.mu));
  }
  return STEIF_OK;
}

int stf_growth_table(stf_trial *t)
{
  for (int which = 0; which < 3; which++) STEIF_TRY(way(t, which));
  return STEIF_OK;
}
