/* bench.c: costs as ratios in one run.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "benchmarks.h"
#include <string.h>

static const struct {
  const char *name;
  int (*run)(struct call *call);
} benchmarks[] = {{"step", bench_step},
                  {"books", bench_cost_accounting},
                  {"workprec", bench_workprec},
                  {"success", bench_success},
                  {"impulse", bench_impulse},
                  {"phi", bench_phi},
                  {"lyapunov", bench_lyapunov},
                  {"model", bench_model},
                  {"lorenz", bench_lorenz},
                  {"certificates", bench_certificates},
                  {"verdicts", bench_verdicts},
                  {"scale", bench_scale},
                  {"sensitivity", bench_sensitivity}};
enum { BENCHMARKS = sizeof benchmarks / sizeof *benchmarks };

static const char *name_at(const void *list, size_t i)
{
  (void)list;
  return i < BENCHMARKS ? benchmarks[i].name : NULL;
}

static int run(struct call *call)
{
  const char *name = call->words ? call->word[0] : "step";
  if (strcmp(name, "phi") && strcmp(name, "lorenz"))
    interruption_poll(); /* these wait for SciPy */
  for (size_t i = 0; i < BENCHMARKS; i++)
    if (!strcmp(name, benchmarks[i].name)) return benchmarks[i].run(call);
  char text[GUESS];
  return unknown_name(call, "no benchmark '%s'%s 'steif bench --help' lists them", name,
                      guess(name, name_at, NULL, text));
}

static const struct option options[] = {
  {"--problems", WORD, "a,b,c",
   "workprec: instead of the usual ones; impulse: one; success: a prefix", NULL},
  {"--methods", WORD, "a,b,c",
   "workprec, success: instead of the usual ones; baselines among them", NULL},
  {"--rtols", REALS, "a,b,c", "workprec, success: relative tolerances",
   "1e-1,1e-2,1e-3,1e-4,1e-5,1e-6,1e-7,1e-8,1e-9,1e-10,1e-11"},
  {"--longest", POSITIVE, "S",
   "a solve ends after S processor seconds (default: 2; phi: 10; --quick: 0.1)", NULL},
  {"--runs", FLAG, NULL,
   "workprec, success: every run as well, not the best, or the worst, alone; verdicts: those "
   "left open, too",
   NULL},
  {"--quick", FLAG, NULL,
   "success, certificates, verdicts: a part of the campaign, in a minute", NULL},
  {"--seeds", COUNT, "N",
   "success: random problems of each kind (default: 12; --quick: 2); certificates: pencils of "
   "each sparse kind, dense ones 200 times as many (default: 500; --quick: 10); verdicts: "
   "systems (default: 10000; --quick: 300)",
   NULL},
  {"--first", COUNT, "K", "success, verdicts: the first seed", "1"},
  {"--ranks", COUNT, "P", "scale: up to so many", "4096"},
  {"--rows", POSITIVE, "N", "scale: unknowns of a rank", "24000"},
  {"--latency", POSITIVE, "S", "scale: seconds of a message", "2e-6"},
  {"--bandwidth", POSITIVE, "B", "scale: bytes a second", "1e10"},
  {"--grid", COUNT, "K", "scale: measured with (2^K - 1)^3 points", "5"},
  {"--delay", REAL, "S", "scale: seconds slept at every message, to check the counts", "0"},
  OPTIONS_END};

const struct verb verb_bench = {
  .name = "bench",
  .about = "Measure steps against their kernels, solves against CVODE, IDA, ARKODE, and these "
           "against direct C programs",
  .usage = "[step|books|workprec|success|impulse|phi|lyapunov|model|lorenz|certificates|"
           "verdicts|scale|sensitivity]",
  .most = 1,
  .picture = true,
  .option = options,
  .run = run};
