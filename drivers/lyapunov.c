/* lyapunov.c: Lyapunov exponents of a method's solution, and whether its step is short enough.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "run.h"
#include <stdlib.h>

typedef struct spectrum {
  size_t count;
  double *exponent, *interval, *error;
  steif_lyapunov_facts facts;
  steif_growth_facts growth;
  bool measured; /* growth */
  steif_lyapunov_check *check;
  int checks;
} spectrum;

static void checks(steif_report *r, const spectrum *s)
{
  for (int i = 0; i < s->checks; i++) {
    const steif_lyapunov_check *c = &s->check[i];
    steif_report_row(r, "checks");
    steif_report_text(r, "checks.law", steif_lyapunov_law_name(c->law));
    steif_report_whole(r, "checks.exponent", c->which);
    steif_report_real(r, "checks.value", c->value);
    steif_report_real(r, "checks.expected", c->expected);
    steif_report_real(r, "checks.tolerance", c->tolerance);
    steif_report_truth(r, "checks.holds", c->holds);
  }
}

/* Every measure of one solution of a linear problem. */
static void diagnostics(steif_report *r, const steif_growth_facts *g)
{
  const struct {
    const char *name;
    double value;
  } row[] = {{"mu", g->mu},
             {"mu_last", g->mu_last},
             {"mu_window", g->mu_window},
             {"mu_running", g->mu_running},
             {"mu_partial", g->mu_partial},
             {"lte_mean", g->lte_mean},
             {"lte_max", g->lte_max},
             {"residual_mean", g->residual_mean},
             {"residual_max", g->residual_max},
             {"local_mean", g->local_mean},
             {"local_max", g->local_max},
             {"tau_max", g->tau_max},
             {"tau_all", g->tau_all},
             {"norm_max", g->norm_max},
             {"norm_end", g->norm_end}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    steif_report_row(r, "diagnostics");
    steif_report_text(r, "diagnostics.quantity", row[i].name);
    steif_report_real(r, "diagnostics.found", row[i].value);
  }
}

static void fill(steif_report *r, const struct call *call, const spectrum *s)
{
  steif_report_text(r, "problem", call->word[0]);
  steif_report_text(r, "method", call->word[1]);
  steif_report_list(r, "exponents", s->count, s->exponent);
  steif_report_list(r, "errors", s->count, s->error);
  steif_report_matrix(r, "intervals", s->count, 2, s->interval);
  report_maybe(r, "", "dimension", s->facts.dimension >= 0, s->facts.dimension);
  steif_report_real(r, "mu", s->measured ? s->growth.mu : s->facts.mu);
  report_maybe(r, "", "lte_mean", s->measured, s->growth.lte_mean);
  report_maybe(r, "", "lte_max", s->measured, s->growth.lte_max);
  report_maybe(r, "", "tau_max", s->measured, s->growth.tau_max);
  steif_report_real(r, "sum", s->facts.sum);
  steif_report_real(r, "trace", s->facts.trace);
  steif_report_truth(r, "linear", s->facts.linear);
  steif_report_real(r, "h", s->facts.h);
  steif_report_whole(r, "steps", s->facts.steps);
  checks(r, s);
  if (s->measured) diagnostics(r, &s->growth);
}

static int rows(const struct call *call, const spectrum *s)
{
  if (!call->csv) return EXIT_OK;
  steif_report *r = steif_report_new(call->ctx);
  for (size_t i = 0; r && i < s->count; i++) {
    steif_report_row(r, "rows");
    steif_report_real(r, "rows.exponent", s->exponent[i]);
    steif_report_real(r, "rows.error", s->error[i]);
    steif_report_real(r, "rows.low", s->interval[2 * i]);
    steif_report_real(r, "rows.high", s->interval[2 * i + 1]);
  }
  const int code = r ? save_csv(call, r) : fail(call);
  steif_report_free(&r);
  return code;
}

static int tell(const struct call *call, const spectrum *s)
{
  steif_report *r = steif_report_new(call->ctx);
  if (r) fill(r, call, s);
  const int code = r ? show(call, r) : fail(call);
  steif_report_free(&r);
  return code ? code : rows(call, s);
}

static int measure(struct call *call, const steif_problem *p, spectrum *s)
{
  const steif_lyapunov_options o = {.h = real_of(call, "--h", 0),
                                    .t1 = real_of(call, "--t1", 0),
                                    .transient = real_of(call, "--transient", 0),
                                    .window = real_of(call, "--window", 0),
                                    .count = (int)s->count,
                                    .error = s->error};
  const char *method = call->word[1];
  progress(call, "%s on %s", method, call->word[0]);
  if (steif_lyapunov(call->ctx, p, method, &o, s->exponent, s->interval, &s->facts) != STEIF_OK)
    return fail(call);
  if (steif_lyapunov_verify(call->ctx, p, method, &o, real_of(call, "--accuracy", 0),
                            real_of(call, "--period", 0), s->exponent, &s->facts, s->check,
                            &s->checks) != STEIF_OK)
    return fail(call);
  /* One solution of a linear problem can be followed as long as it neither overflows nor is 0. */
  s->measured =
    s->facts.linear && steif_growth_measure(call->ctx, p, method, &o, &s->growth) == STEIF_OK;
  steif_forget(call->ctx);
  return tell(call, s);
}

static int run(struct call *call)
{
  steif_problem p;
  spectrum s = {0};
  if (!given(call, "--h")) return refuse(call, "exponents need equal steps: give --h");
  if (call->plot) return refuse(call, "exponents have no picture; leave --plot out");
  if (steif_problem_find(call->ctx, call->word[0], &p) != STEIF_OK) return fail(call);
  const long count = whole_of(call, "--count", (long)p.n);
  s.count = count < (long)p.n ? (size_t)count : (size_t)p.n;
  s.exponent = malloc(4 * s.count * sizeof *s.exponent);
  s.interval = s.exponent ? s.exponent + s.count : NULL;
  s.error = s.exponent ? s.exponent + 3 * s.count : NULL;
  s.check = malloc((s.count + 2) * sizeof *s.check);
  int code = EXIT_FAILED;
  if (count > (long)p.n)
    code = refuse(call, "--count is %ld and '%s' has %ld exponents", count, call->word[0],
                  (long)p.n);
  else if (!s.exponent || !s.check)
    say(call, "no memory for %ld exponents; ask for fewer with --count", count);
  else
    code = measure(call, &p, &s);
  free(s.check), free(s.exponent);
  steif_problem_clear(call->ctx, &p);
  return code;
}

static const struct option options[] = {
  {"--h", POSITIVE, "H", "equal steps"},
  {"--t1", POSITIVE, "T", "end of the run (default: the problem's)"},
  {"--transient", POSITIVE, "T", "time before the averages begin"},
  {"--window", POSITIVE, "W", "length of the windows (default: a tenth of what is averaged)"},
  {"--period", POSITIVE, "P", "of A(t) in x' = A(t) x: compare with Floquet's exponents"},
  {"--accuracy", POSITIVE, "R",
   "of the sum against the mean trace, in largest exponents (default 0.01)"},
  {"--count", COUNT, "K", "exponents, the largest first (default: all)"},
  {NULL, FLAG, NULL, NULL},
};

const struct verb verb_lyapunov = {
  "lyapunov",
  "Find Lyapunov exponents and whether the step is short enough",
  "PROBLEM METHOD --h H --t1 T [--transient T --window W --count K --period P]",
  2,
  2,
  options,
  NULL,
  run};
