/* layers.c: layers of N x' + x = f, index 2 to 4.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "demo.h"
#include "members.h"
#include "layer.h"

/* Backward differentiation of order p with constant history follows after p (k - 1) steps, the
 * ramp too needs no more for p = 1 (Campbell 1988). */
static const struct {
  const char *method, *start;
  size_t per_index;
} layers[] = {{"be", NULL, 1}, {"bdf:p=2", "constant", 2}, {"bdf:p=3", "constant", 3}};
enum { LAYERS = sizeof layers / sizeof *layers };

static struct layer block(size_t k, const char *kind, size_t steps, double h)
{
  struct layer l = {.k = k, .steps = steps, .h = h};
  snprintf(l.problem, sizeof l.problem, "jordan:k=%zu,case=%s", k, kind);
  return l;
}

static int one_layer(demo *d, size_t i, size_t k, error_curves *errors)
{
  const size_t expected = layers[i].per_index * (k - 1);
  struct layer l = block(k, "N-inc", 16, 1.0 / 64);
  int code = EXIT_OK;
  if (layer_measure(d->call->ctx, &l, layers[i].method, layers[i].start)) code = fail(d->call);
  steif_report_row(d->report, "layers");
  steif_report_text(d->report, "layers.method", layers[i].method);
  steif_report_text(d->report, "layers.start", layers[i].start ? layers[i].start : "ramp");
  steif_report_whole(d->report, "layers.index", (long)k);
  steif_report_real(d->report, "layers.h", l.h);
  steif_report_whole(d->report, "layers.layer_steps", l.result.layer_steps);
  steif_report_whole(d->report, "layers.theory", (long)expected);
  steif_report_real(d->report, "layers.error_in_layer", code ? 0 : l.error[1]);
  steif_report_real(d->report, "layers.error_after", code ? 0 : l.error[expected + 1]);
  if (!code && k == 3) layer_errors(&l, layers[i].method, errors);
  layer_free(&l);
  return code;
}

int demo_layers(demo *d)
{
  error_curves errors = {.title =
                           "The initial layer at index 3: N x' + x = f, inconsistent start",
                         .y_label = LAYER_ERROR,
                         .over_time = true};
  int code = EXIT_OK;
  for (size_t i = 0; i < LAYERS; i++)
    for (size_t k = 2; k <= 4 && code == EXIT_OK; k++) code = one_layer(d, i, k, &errors);
  return code ? code : errors_plot(d->call, &errors, demo_picture(d, "layer.svg"));
}
