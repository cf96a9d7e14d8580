/* phi_report.c: exponentials against SciPy's, phi functions against implicit methods.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "benchmarks.h"
#include "phi_cost.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Of every (n, A, X) in a file: seconds of scipy.linalg.expm(A), measured as ours, and the
 * difference of X, relative, in the 1-norm. */
#define SCRIPT                                                                                 \
  "import sys, time, numpy as np\n"                                                            \
  "from scipy.linalg import expm\n"                                                            \
  "d, at = np.fromfile(sys.argv[1]), 0\n"                                                      \
  "def batch(A, count):\n"                                                                     \
  "    start = time.process_time()\n"                                                          \
  "    for i in range(count): expm(A)\n"                                                       \
  "    return time.process_time() - start\n"                                                   \
  "while at < len(d):\n"                                                                       \
  "    n = int(d[at])\n"                                                                       \
  "    A, X = [d[at+1+k*n*n:at+1+(k+1)*n*n].reshape(n, n).T for k in (0, 1)]\n"                \
  "    A, at, count = np.ascontiguousarray(A), at + 1 + 2*n*n, 1\n"                            \
  "    while batch(A, count) < 4e-3: count *= 2\n"                                             \
  "    t, Y = min(batch(A, count) for i in range(10)) / count, expm(A)\n"                      \
  "    print(t, abs(X - Y).sum(0).max() / abs(Y).sum(0).max())\n"

enum { MOST = 64 };

typedef struct results {
  steif_bench_expm row[MOST];
  double theirs[MOST], distance[MOST];
  size_t count;
} results;

/* Measure ours and write the matrices to `file`. */
static int measure(struct call *call, FILE *file, results *r)
{
  enum { SIZE = STEIF_BENCH_EXPM * STEIF_BENCH_EXPM };
  static double A[SIZE], X[SIZE];
  for (; r->count < MOST; r->count++) {
    steif_bench_expm *row = r->row + r->count;
    if (steif_bench_exponential(call->ctx, r->count, row, A, X)) break;
    progress(call, "e^A: %s, n = %d", row->matrix, row->n);
    const double n = row->n;
    const size_t entries = (size_t)row->n * (size_t)row->n;
    r->theirs[r->count] = r->distance[r->count] = NAN;
    if (fwrite(&n, sizeof n, 1, file) != 1 || fwrite(A, sizeof *A, entries, file) != entries ||
        fwrite(X, sizeof *X, entries, file) != entries) {
      say(call, "the matrices could not be written to a file in TMPDIR or /tmp [STEIF_IO]");
      return EXIT_FAILED;
    }
  }
  progress(call, NULL);
  return steif_status(call->ctx) ? fail(call) : EXIT_OK;
}

/* SciPy's times, if it is there. */
static void ask(struct call *call, const char *path, results *r)
{
  size_t got = 0;
  FILE *answer = scipy_ask(SCRIPT, path);
  while (answer && got < r->count &&
         fscanf(answer, "%lf %lf", r->theirs + got, r->distance + got) == 2)
    got++;
  if ((answer && pclose(answer)) || got < r->count) scipy_missing(call, "scipy_us");
}

static int exponentials(struct call *call, results *r)
{
  char path[256];
  const char *folder = getenv("TMPDIR");
  snprintf(path, sizeof path, "%s/steif-XXXXXX", folder ? folder : "/tmp");
  const int number = mkstemp(path);
  FILE *file = number >= 0 ? fdopen(number, "wb") : NULL;
  if (!file) {
    say(call, "no file can be made in %s; name another folder in TMPDIR [STEIF_IO]",
        folder ? folder : "/tmp");
    return EXIT_FAILED;
  }
  int code = measure(call, file, r);
  if (fclose(file)) code = EXIT_FAILED;
  if (!code) ask(call, path, r);
  unlink(path);
  return code;
}

static void tell(steif_report *r, const results *e)
{
  for (size_t i = 0; i < e->count; i++) {
    steif_report_row(r, "rows");
    steif_report_text(r, "rows.matrix", e->row[i].matrix);
    steif_report_whole(r, "rows.n", e->row[i].n);
    steif_report_real(r, "rows.norm", e->row[i].norm);
    steif_report_real(r, "rows.expm_us", 1e6 * e->row[i].cpu_s);
    steif_report_real(r, "rows.scipy_us", 1e6 * e->theirs[i]);
    steif_report_real(r, "rows.ratio", e->row[i].cpu_s / e->theirs[i]);
    steif_report_real(r, "rows.difference", e->distance[i]);
  }
}

static void actions(struct call *call, steif_report *r)
{
  steif_bench_phi row;
  const double longest = real_or(call, "--longest", 10);
  for (size_t i = 0; !steif_bench_functions(call->ctx, i, longest, &row); i++) {
    progress(call, "%s, %d digits", row.problem, row.digits);
    steif_report_row(r, "actions");
    steif_report_text(r, "actions.problem", row.problem);
    steif_report_whole(r, "actions.n", (long)row.n);
    steif_report_whole(r, "actions.digits", row.digits);
    steif_report_text(r, "actions.method", *row.method ? row.method : NULL);
    steif_report_real(r, "actions.cpu_ms", 1e3 * row.cpu_s);
    steif_report_real(r, "actions.radau_ms", 1e3 * row.radau_s);
    steif_report_real(r, "actions.cvode_ms", 1e3 * row.cvode_s);
    steif_report_real(r, "actions.to_radau", row.cpu_s / row.radau_s);
    steif_report_real(r, "actions.to_cvode", row.cpu_s / row.cvode_s);
  }
}

static void squares(struct call *call, steif_report *r)
{
  static const struct member members[] = {MEMBER(steif_bench_square, n, A_INDEX),
                                          {"phi", A_WHOLE, offsetof(steif_bench_square, p)},
                                          MEMBER(steif_bench_square, t, A_REAL),
                                          MEMBER(steif_bench_square, error, A_REAL),
                                          MEMBER(steif_bench_square, factors, A_LONG),
                                          MEMBER(steif_bench_square, solves, A_LONG),
                                          MEMBER(steif_bench_square, cpu_s, A_REAL),
                                          MEMBERS_END};
  steif_bench_square row[STEIF_BENCH_SQUARE];
  progress(call, "phi functions on squares");
  for (size_t i = 0; !steif_bench_squares(call->ctx, i, row); i++)
    for (int k = 0; k < STEIF_BENCH_SQUARE; k++) {
      steif_report_row(r, "squares");
      report_members(r, "squares.", members, &row[k]);
    }
}

int bench_phi(struct call *call)
{
  static results e;
  steif_report *r = steif_report_new(call->ctx);
  steif_report_text(r, "benchmark", "phi");
  const int code = r ? exponentials(call, &e) : fail(call);
  if (code) {
    steif_report_free(&r);
    return code;
  }
  tell(r, &e);
  rows_come(call, r);
  actions(call, r);
  if (!steif_status(call->ctx)) squares(call, r);
  return bench_present(call, &r);
}
