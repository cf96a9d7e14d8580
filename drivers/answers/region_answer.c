/* region_answer.c: a stability region as a report, rows and a picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "members.h"
#include <math.h>

/* What follows from the coefficients, where the step is a linear recurrence. */
static void coefficients(steif_report *r, const struct call *call)
{
  static const struct member members[] = {MEMBER(steif_glm, order, A_WHOLE),
                                          MEMBER(steif_glm, stage_order, A_WHOLE),
                                          {"parasitic", A_REAL, offsetof(steif_glm, second)},
                                          MEMBERS_END};
  steif_glm *g = steif_glm_new(call->ctx, call->word[0]);
  if (g) {
    report_members(r, "", members, g);
    if (g->error < 0 || g->error > 0) steif_report_real(r, "error", g->error);
    steif_report_list(r, "ell", (size_t)g->k, g->ell);
  }
  steif_glm_free(call->ctx, &g);
  steif_forget(call->ctx);
}

static void fill(steif_report *r, const struct call *call, const void *result)
{
  static const struct member members[] = {
    MEMBER(steif_region, a_stable, A_TRUTH),    MEMBER(steif_region, l_stable, A_TRUTH),
    MEMBER(steif_region, zero_stable, A_TRUTH), MEMBER(steif_region, alpha_deg, A_REAL),
    MEMBER(steif_region, r_inf, A_REAL),        MEMBER(steif_region, real_limit, A_REAL),
    MEMBER(steif_region, imag_limit, A_REAL),   MEMBERS_END};
  const struct region_answer *a = result;
  steif_report_text(r, "method", call->word[0]);
  report_members(r, "", members, &a->region);
  coefficients(r, call);
  steif_report_matrix(r, "boundary", a->count, 2, a->point);
}

static void fill_rows(steif_report *r, const struct call *call, const void *result)
{
  const struct region_answer *a = result;
  (void)call;
  for (size_t i = 0; i < a->count; i++) {
    steif_report_row(r, "boundary");
    steif_report_real(r, "boundary.re", a->re[i]);
    steif_report_real(r, "boundary.im", a->im[i]);
  }
}

/* In the region, or with --star where the method grows more than the solution. */
static int inside(double re, double im, void *user)
{
  const struct call *call = user;
  const double z[] = {re, im};
  double radius;
  if (steif_spectral_radius(call->ctx, call->word[0], z, &radius)) {
    steif_forget(call->ctx);
    return 0;
  }
  return given(call, "--star") ? radius > exp(re) : radius <= 1;
}

static int draw(const struct call *call, const struct region_answer *a)
{
  char title[96];
  snprintf(title, sizeof title, "%s: %s",
           given(call, "--star") ? "Order star" : "Stability region (shaded)", call->word[0]);
  const steif_curve curve = {call->word[0], a->count, a->re, a->im, 0};
  const steif_plot plot = {.title = title,
                           .x_label = "Re z",
                           .y_label = "Im z",
                           .equal = 1,
                           .count = 1,
                           .curve = &curve,
                           .inside = inside,
                           .user = (void *)call};
  return save_plot(call, &plot, call->plot);
}

int region_present(const struct call *call, const struct region_answer *a)
{
  int code = show_result(call, fill, a);
  if (!code) code = save_rows(call, fill_rows, a);
  return code ? code : draw(call, a);
}
