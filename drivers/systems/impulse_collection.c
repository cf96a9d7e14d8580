/* impulse_collection.c: the descriptor systems of the collection, from consistent and from other starts,
 * beside what an integrator of SUNDIALS makes of them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse.h"
#include "settings.h"
#include <math.h>
#include <string.h>

/* Sizes and ends at which an integrator that can do it is done in a moment; of each both cases. */
static const struct {
  const char *spec, *inconsistent, *consistent;
  double t1;
} systems[] = {
  {"jordan:k=1", ",case=N-inc", ",case=N-cons", 1},
  {"jordan:k=2", ",case=N-inc", ",case=N-cons", 0.1},
  {"jordan:k=3", ",case=N-inc", ",case=N-cons", 0.1},
  {"jordan:k=4", ",case=N-inc", ",case=N-cons", 0.1},
  {"jordan:k=5", ",case=N-inc", ",case=N-cons", 0.1},
  {"jordan:k=6", ",case=N-inc", ",case=N-cons", 0.1},
  {"ut5", "", ":case=cons", 0.1},
  {"bus:n=60", "", ",case=cons", 0.5},
  {"ladder:n=50", "", ",case=cons", 1e-6},
  {"stokes:m=6", "", ",case=cons", 0.01},
  {"springs:n=60,c=6", "", ",case=cons", 0.1},
  {"hidden:n=60,c=6", "", ",case=cons", 0.1},
  {"blocks", "", ":case=cons", 0.1},
  {"switchrlc", "", ":case=cons", 1e-4},
  {"impact", ":gap=0.2", ":case=cons", 0.3},
};

static double largest(size_t count, const double *x)
{
  double most = 0;
  for (size_t i = 0; i < count; i++) most = fmax(most, fabs(x[i]));
  return most;
}

/* What steif returns. */
static int start(struct call *call, const steif_problem *p, steif_report *r)
{
  steif_linear l;
  steif_impulse i = {0};
  if (steif_linear_of(call->ctx, p, &l)) return fail(call);
  const int code =
    steif_impulse_find(call->ctx, l.E, l.F, p->y0, p->t0, l.f, l.user, NULL, NULL, &i);
  if (!code) {
    steif_report_whole(r, "rows.index", i.index);
    steif_report_real(r, "rows.x_plus", largest((size_t)i.n, i.x_plus));
    steif_report_real(r, "rows.impulse", largest((size_t)i.count * (size_t)i.n, i.c));
    steif_report_truth(r, "rows.certified", i.certified);
  }
  steif_impulse_clear(call->ctx, &i);
  SUNMatDestroy(l.E);
  SUNMatDestroy(l.F);
  return code ? fail(call) : EXIT_OK;
}

static int row(struct call *call, const char *spec, double t1, const char *method,
               steif_report *r)
{
  static settings s;
  known_solution known;
  steif_problem p;
  steif_options o = steif_defaults();
  o.t1 = t1;
  o.max_steps = 20000;
  o.rtol = real_or(call, "--rtol", o.rtol);
  if (steif_problem_find(call->ctx, spec, &p)) return fail(call);
  progress(call, "%s", spec);
  steif_report_row(r, "rows");
  steif_report_text(r, "rows.system", spec);
  const int code = start(call, &p, r);
  known_open(call, &p, &o, &known);
  settings_run(call, &p, method, &o, &known, &s);
  known_close(call, &known);
  const outcome *got = &s.run[0].out;
  steif_report_text(r, "rows.vs", s.run[0].verdict);
  report_best(r, "rows", &s);
  steif_report_whole(r, "rows.steps", got->stats.steps);
  steif_report_real(r, "rows.asked", -log10(o.rtol));
  steif_report_real(r, "rows.t", got->t);
  steif_report_text(r, "rows.message", got->message);
  steif_problem_clear(call->ctx, &p);
  return code;
}

int impulse_collection(struct call *call)
{
  enum { COUNT_OF = sizeof systems / sizeof *systems };
  char spec[64];
  int code = EXIT_OK;
  const char *method = word_of(call, "--vs");
  if (!method)
    return bad_usage(call, "\"all\" shows systems beside an integrator; add --vs ida");
  steif_report *r = steif_report_new(call->ctx);
  if (!r) return fail(call);
  for (int k = 0; k < 2 * COUNT_OF && !code; k++) {
    const char *how = k % 2 ? systems[k / 2].consistent : systems[k / 2].inconsistent;
    snprintf(spec, sizeof spec, "%s%s", systems[k / 2].spec, how);
    code = row(call, spec, systems[k / 2].t1, method, r);
  }
  if (!code) code = show(call, r);
  if (!code && call->csv) code = save_csv(call, r);
  steif_report_free(&r);
  return code;
}
