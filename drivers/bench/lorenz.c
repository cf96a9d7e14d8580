/* lorenz.c: the exponents of Lorenz' equations, timed, against SciPy's DOP853 with NumPy's QR.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "attractor.h"
#include "benchmarks.h"
#include "timing.h"
#include <math.h>
#include <steif/collection.h>
#include <steif/lyapunov.h>
#include <stdio.h>

/* Steps and tolerances of DOP853 that keep the sum of the exponents about equally well. */
static const struct {
  sunrealtype h, rtol;
} plan[] = {{0.01, 1e-4}, {0.004, 1e-6}};

int steif_bench_lorenz(steif_context *ctx, size_t i, steif_bench_attractor *row)
{
  steif_problem p;
  steif_lyapunov_facts facts;
  if (i >= sizeof plan / sizeof *plan) return STEIF_BAD_INPUT;
  *row = (steif_bench_attractor){
    .h = plan[i].h, .time = 2e4, .transient = 100, .rtol = plan[i].rtol};
  snprintf(row->method, sizeof row->method, "rk4");
  STEIF_TRY(steif_problem_find(ctx, "lorenz", &p));
  const steif_lyapunov_options o = {.h = row->h,
                                    .t1 = p.t0 + row->transient + row->time,
                                    .transient = row->transient,
                                    .error = row->error};
  const sunrealtype from = stf_now();
  const int code = steif_lyapunov(ctx, &p, row->method, &o, row->exponent, NULL, &facts);
  row->cpu_s = stf_now() - from;
  row->sum = -41.0 / 3; /* -(sigma + 1 + beta), the divergence */
  if (!code) row->defect = fabs(facts.sum - row->sum);
  steif_problem_clear(ctx, &p);
  return code;
}

/* ---- beside SciPy ---- */

/* Argument: rtol, transient, time. Equations and variations in one system of 12, Q R after every step
 * of the stepper itself, which solve_ivp would start again each time. */
#define SCRIPT                                                                                 \
  "import sys, time, numpy as np\n"                                                            \
  "from scipy.integrate import DOP853\n"                                                       \
  "rtol, begin, span = [float(a) for a in sys.argv[1].split()]\n"                              \
  "J = np.array([[-10, 10, 0], [28, -1, 0], [0, 0, -8/3]])\n"                                  \
  "def f(t, u):\n"                                                                             \
  "    x, y, z = u[:3]\n"                                                                      \
  "    J[1, 0], J[1, 2], J[2, 0], J[2, 1] = 28 - z, -x, y, x\n"                                \
  "    out = np.empty(12)\n"                                                                   \
  "    out[0], out[1], out[2] = 10*(y - x), x*(28 - z) - y, x*y - 8/3*z\n"                     \
  "    out[3:] = (J @ u[3:].reshape(3, 3)).ravel()\n"                                          \
  "    return out\n"                                                                           \
  "since, sums, began = time.process_time(), np.zeros(3), None\n"                              \
  "start = np.concatenate(([1, 1, 20], np.eye(3).ravel()))\n"                                  \
  "s = DOP853(f, 0, start, begin + span, rtol=rtol, atol=rtol)\n"                              \
  "while s.status == 'running':\n"                                                             \
  "    s.step()\n"                                                                             \
  "    Q, R = np.linalg.qr(s.y[3:].reshape(3, 3))\n"                                           \
  "    s.y[3:] = Q.ravel()\n"                                                                  \
  "    s.f = f(s.t, s.y)\n"                                                                    \
  "    if began is not None: sums += np.log(abs(R.diagonal()))\n"                              \
  "    elif s.t >= begin: began = s.t\n"                                                       \
  "print(time.process_time() - since, *(sums/(s.t - began)))\n"

typedef struct peer {
  double cpu_s, exponent[3], defect;
} peer;

static void ask(struct call *call, const steif_bench_attractor *row, peer *theirs)
{
  char argument[96];
  double *x = theirs->exponent;
  *theirs = (peer){NAN, {NAN, NAN, NAN}, NAN};
  snprintf(argument, sizeof argument, "%.17g %.17g %.17g", row->rtol, row->transient,
           row->time);
  progress(call, "DOP853, rtol = %g", row->rtol);
  FILE *answer = scipy_ask(SCRIPT, argument);
  const int got =
    answer ? fscanf(answer, "%lf %lf %lf %lf", &theirs->cpu_s, x, x + 1, x + 2) : 0;
  if ((answer && pclose(answer)) || got < 4) scipy_missing(call, "scipy_s");
  theirs->defect = fabs(x[0] + x[1] + x[2] - row->sum);
}

static void tell(steif_report *r, const char *method, double step, double cpu_s,
                 const double *exponent, double defect)
{
  steif_report_row(r, "rows");
  steif_report_text(r, "rows.method", method);
  steif_report_real(r, "rows.h_or_rtol", step);
  steif_report_real(r, "rows.cpu_s", cpu_s);
  steif_report_real(r, "rows.first", exponent[0]);
  steif_report_real(r, "rows.second", exponent[1]);
  steif_report_real(r, "rows.third", exponent[2]);
  steif_report_real(r, "rows.sum_error", defect);
}

int bench_lorenz(struct call *call)
{
  steif_report *r = steif_report_new(call->ctx);
  steif_bench_attractor ours;
  peer theirs;
  steif_report_text(r, "benchmark", "lorenz");
  for (size_t i = 0; r && !steif_bench_lorenz(call->ctx, i, &ours); i++) {
    ask(call, &ours, &theirs);
    tell(r, ours.method, ours.h, ours.cpu_s, ours.exponent, ours.defect);
    tell(r, "DOP853", ours.rtol, theirs.cpu_s, theirs.exponent, theirs.defect);
    steif_report_row(r, "ratios");
    steif_report_real(r, "ratios.h", ours.h);
    steif_report_real(r, "ratios.rtol", ours.rtol);
    steif_report_real(r, "ratios.scipy_to_steif", theirs.cpu_s / ours.cpu_s);
    rows_come(call, r);
  }
  return bench_present(call, &r);
}
