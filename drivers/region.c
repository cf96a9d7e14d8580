/* region.c: the stability region of a method and its constants.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "face.h"
#include <stdlib.h>

static void fill(steif_report *r, const char *method, const steif_region *region)
{
  steif_report_text(r, "method", method);
  steif_report_truth(r, "a_stable", region->a_stable);
  steif_report_truth(r, "l_stable", region->l_stable);
  steif_report_truth(r, "zero_stable", region->zero_stable);
  steif_report_real(r, "alpha_deg", region->alpha_deg);
  steif_report_real(r, "r_inf", region->r_inf);
  steif_report_real(r, "real_limit", region->real_limit);
  steif_report_real(r, "imag_limit", region->imag_limit);
}

/* What follows from the coefficients, where the step is a linear recurrence. */
static void coefficients(steif_report *r, struct call *call)
{
  steif_glm *g = steif_glm_new(call->ctx, call->word[0]);
  if (g) {
    steif_report_whole(r, "order", g->order);
    steif_report_whole(r, "stage_order", g->stage_order);
    steif_report_real(r, "parasitic", g->second);
    if (g->error < 0 || g->error > 0) steif_report_real(r, "error", g->error);
    steif_report_list(r, "ell", (size_t)g->k, g->ell);
  }
  steif_glm_free(call->ctx, &g);
  steif_forget(call->ctx);
}

/* The boundary as rows re, im, and as a picture. */
static int boundary(const struct call *call, size_t count, const double *point, double *re)
{
  double *im = re + count;
  char title[96];
  steif_report *r = steif_report_new(call->ctx);
  for (size_t i = 0; i < count; i++) {
    re[i] = point[2 * i], im[i] = point[2 * i + 1];
    steif_report_row(r, "boundary");
    steif_report_real(r, "boundary.re", re[i]);
    steif_report_real(r, "boundary.im", im[i]);
  }
  const int code = r ? save_csv(call, r) : fail(call);
  steif_report_free(&r);
  snprintf(title, sizeof title, "%s: %s",
           given(call, "--star") ? "Order star" : "Boundary of the stability region",
           call->word[0]);
  const steif_curve curve = {call->word[0], count, re, im, 0};
  const steif_plot plot = {title, "Re z", "Im z", 0, 0, 1, 1, &curve};
  return code ? code : save_plot(call, &plot, call->plot);
}

static int find(struct call *call, size_t count, double *point)
{
  const char *method = call->word[0];
  steif_region region;
  if (steif_region_find(call->ctx, method, &region) != STEIF_OK) return fail(call);
  const bool star = given(call, "--star");
  const int traced = star ? steif_region_star(call->ctx, method, count, point)
                          : steif_region_boundary(call->ctx, method, count, point);
  if (traced != STEIF_OK) return fail(call);
  steif_report *r = steif_report_new(call->ctx);
  fill(r, method, &region);
  if (r) coefficients(r, call);
  steif_report_matrix(r, "boundary", count, 2, point);
  const int code = r ? show(call, r) : fail(call);
  steif_report_free(&r);
  return code ? code : boundary(call, count, point, point + 2 * count);
}

static int run(struct call *call)
{
  const size_t count = (size_t)whole_of(call, "--points", 400);
  double *point = count <= 1000000 ? malloc(4 * count * sizeof *point) : NULL;
  if (!point) return refuse(call, "--points is %zu and must be at most 1000000", count);
  const int code = find(call, count, point);
  free(point);
  return code;
}

static const struct option options[] = {
  {"--points", COUNT, "N", "points of the boundary (default 400)"},
  {"--star", FLAG, NULL, "trace the order star |R(z)| = |e^z| instead"},
  {NULL, FLAG, NULL, NULL},
};

const struct verb verb_region = {"region",
                                 "Find the stability region of a method and its constants",
                                 "METHOD [--points N --star]",
                                 1,
                                 1,
                                 options,
                                 NULL,
                                 run};
