/* test_steady.c: runs through layers: lengths of steps that change, values at every step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "layers.h"
#include "base/failing.h"
#include "weak/data.h"

/* ---- a change at t = 1/2 ---------------------------------------------------------------- */

static void open_block(steif_context *ctx, int k, const char *method, steif_problem *p,
                       steif_linear *l, stf_layers *w)
{
  char name[40];
  steif_options o = steif_defaults();
  o.t1 = 1;
  snprintf(name, sizeof name, "jordan:k=%d,case=N-cons", k);
  CU_ASSERT_FATAL(!steif_problem_find(ctx, name, p) && !steif_linear_of(ctx, p, l));
  CU_ASSERT_FATAL(!stf_layers_open(ctx, l, p->y0, 0, method, &o, NULL, w));
}

static void close_block(steif_context *ctx, steif_problem *p, steif_linear *l, stf_layers *w)
{
  stf_layers_close(w);
  SUNMatDestroy(l->E), SUNMatDestroy(l->F);
  steif_problem_clear(ctx, p);
}

static double off(steif_context *ctx, const steif_problem *p, sunrealtype t, const double *x)
{
  sunrealtype exact[MOST];
  CU_ASSERT_FATAL(!steif_jordan_exact(ctx, (int)p->n, p->g, p->user, p->y0, t, exact, NULL));
  return fabs(x[0] - exact[0]);
}

/* Largest error of component 1 for t > 0.3 of n steps on [0, 1/2] and steps of `ratio` / n
 * behind. */
static double anew(int k, const char *method, int n, double ratio)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_linear l;
  stf_layers w;
  double most = 0;
  open_block(ctx, k, method, &p, &l, &w);
  CHECK(!stf_layers_begin(&w, 1.0 / n));
  for (bool changed = false; w.t[w.count - 1] < 1;) {
    CU_ASSERT_FATAL(!stf_layers_step(&w));
    const double t = w.t[w.count - 1];
    if (t > 0.3) most = fmax(most, off(ctx, &p, t, w.x + (w.count - 1) * k));
    stf_layers_keep(&w);
    if (changed || t < 0.5 - 1e-9) continue;
    changed = true;
    CU_ASSERT_FATAL(stf_layers_fit(&w, ratio / n) && !stf_layers_change(&w, ratio / n));
  }
  close_block(ctx, &p, &l, &w);
  steif_context_free(&ctx);
  return most;
}

/* The same times without the layer being run through. */
static double plainly(int k, const char *method, int n, double ratio)
{
  enum { TIMES = 1024 };
  steif_context *ctx = steif_context_new(NULL);
  double mesh[TIMES], most = 0;
  steif_problem p;
  char name[40];
  snprintf(name, sizeof name, "jordan:k=%d,case=N-cons", k);
  CU_ASSERT_FATAL(!steif_problem_find(ctx, name, &p));
  steif_options o = steif_defaults();
  for (mesh[0] = 0, o.mesh_size = 1; mesh[o.mesh_size - 1] < 1 - 1e-9; o.mesh_size++)
    mesh[o.mesh_size] =
      mesh[o.mesh_size - 1] + (mesh[o.mesh_size - 1] < 0.5 - 1e-9 ? 1 : ratio) / n;
  o.mesh = mesh, o.start = strcmp(method, "be") ? "constant" : NULL;
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  for (size_t i = 1; i < o.mesh_size; i++) {
    CU_ASSERT_FATAL(s && !steif_solve_step(s));
    const double *x = N_VGetArrayPointer(steif_solution(s));
    if (mesh[i] > 0.3) most = fmax(most, off(ctx, &p, mesh[i], x));
  }
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
  return most;
}

/* Orders from n = 2^7 and 2^8. Plainly: 2 - k + p for k > 2 (C. W. Gear, H. H. Hsu, L.
 * Petzold 1981); run through the layer: p for every k. */
static void changes_keep_the_order(void)
{
  static const struct {
    const char *method;
    int k, order, plain;
  } row[] = {{"be", 3, 1, 0},      {"be", 4, 1, -1},     {"be", 5, 1, -2},
             {"bdf:p=2", 3, 2, 1}, {"bdf:p=2", 4, 2, 0}, {"radau:s=3", 3, 2, 2}};
  static const double ratio[] = {0.5, 2};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++)
    for (int j = 0; j < 2; j++) {
      const double coarse = anew(row[i].k, row[i].method, 128, ratio[j]);
      const double fine = anew(row[i].k, row[i].method, 256, ratio[j]);
      const double before = plainly(row[i].k, row[i].method, 128, ratio[j]);
      const double after = plainly(row[i].k, row[i].method, 256, ratio[j]);
      const double order = log2(coarse / fine), plain = log2(before / after);
      const bool good = fabs(order - row[i].order) < 0.1 && fabs(plain - row[i].plain) < 0.1;
      CHECK(good);
      if (!good)
        printf("\n  %s, k = %d, ratio %g: %.3g, order %.2f; plainly %.3g, order %.2f",
               row[i].method, row[i].k, ratio[j], fine, order, after, plain);
    }
}

/* At t = 1 behind a change to h = 1/128 stand the errors of equal steps of that length,
 * 0.00975486 and 0.0130058 (50 digits); of 0.228549 and 6.86398, which the change leaves when
 * made plainly, nothing. */
static void changes_of_euler(void)
{
  CLOSE(anew(3, "be", 256, 2), 0.00975486, 1e-6);
  CLOSE(anew(4, "be", 256, 2), 0.0130058, 1e-5);
  CLOSE(plainly(3, "be", 256, 2), 0.228549, 1e-5);
  CLOSE(plainly(4, "be", 256, 2), 6.86398, 1e-5);
}

/* ---- chosen lengths --------------------------------------------------------------------- */

enum { ROWS = 8192, N = 5 };
typedef struct told {
  int count, layer, n, stop_at;
  double t[ROWS], x[ROWS][N];
} told;
static told run;

static int keep(sunrealtype t, const sunrealtype *x, int layer, void *user)
{
  told *r = user;
  CU_ASSERT_FATAL(r->count + 1 < ROWS);
  CHECK(t > (r->count ? r->t[r->count - 1] : -1e-9));
  r->t[r->count] = t, r->layer += layer;
  memcpy(r->x[r->count], x, (size_t)r->n * sizeof *x);
  return ++r->count == r->stop_at;
}

/* Largest error outside of the first layer over max |x|. */
static double error_most(steif_context *ctx, const steif_problem *p, const steif_linear *l)
{
  double most = 0, size = 0;
  static double x[ROWS * N];
  steif_linear_truth truth;
  const int rows = run.count - run.layer, n = run.n;
  if (strcmp(p->name, "ut5"))
    for (int i = 0; i < rows; i++)
      CHECK(!steif_jordan_exact(ctx, n, p->g, p->user, p->y0, run.t[run.layer + i], x + i * n,
                                NULL));
  else
    CHECK(!steif_linear_exact(ctx, l, p->y0, 0, NULL, 0, NULL, (size_t)rows, run.t + run.layer,
                              NULL, x, &truth));
  for (int i = 0; i < rows * n; i++) {
    size = fmax(size, fabs(x[i]));
    most = fmax(most, fabs(run.x[run.layer + i / n][i % n] - x[i]));
  }
  return most / size;
}

/* From inconsistent values; h0 far too short or too long. At most twice the tolerance at any
 * step. */
static void tolerances_are_kept(void)
{
  static const struct {
    const char *problem, *method;
    double rtol, h0;
    int width, changes;
  } row[] = {
    {"jordan:k=2,case=N-inc", "be", 1e-3, 1e-4, 1, 1},
    {"jordan:k=3,case=N-inc", "be", 1e-2, 1e-3, 2, 1},
    {"jordan:k=3,case=N-inc", "be", 1e-3, 0, 2, 1},
    {"jordan:k=4,case=N-inc", "be", 1e-2, 1e-3, 3, 1},
    {"jordan:k=4,case=N-inc", "be", 1e-3, 0, 3, 0},
    {"jordan:k=3,case=N-inc", "bdf:p=2", 1e-4, 1e-3, 4, 1},
    {"jordan:k=4,case=N-inc", "bdf:p=2", 1e-3, 4e-3, 6, 1},
    {"jordan:k=4,case=N-inc", "bdf:p=3", 1e-4, 0, 9, 0},
    {"jordan:k=3,case=N-inc", "radau:s=4", 1e-6, 0, 2, 0},
    {"jordan:k=4,case=N-inc", "radau:s=4", 1e-3, 0, 3, 0},
    {"ut5", "be", 1e-2, 1e-3, 2, 1},
    {"ut5", "bdf:p=2", 1e-4, 1e-3, 4, 1},
    {"ut5", "bdf:p=4", 1e-4, 1e-3, 8, 1},
    {"ut5", "bdf:p=4", 1e-6, 0, 8, 0},
    {"ut5", "radau:s=3", 1e-4, 1e-3, 2, 1},
  };
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    steif_problem p;
    steif_linear l;
    steif_layers_stats stats = {0};
    CU_ASSERT_FATAL(!steif_problem_find(ctx, row[i].problem, &p) &&
                    !steif_linear_of(ctx, &p, &l));
    steif_options o = steif_defaults();
    o.t1 = 1, o.rtol = row[i].rtol, o.h0 = row[i].h0;
    run.count = run.layer = 0, run.n = (int)p.n;
    const int code =
      steif_layers_run(ctx, &l, p.y0, 0, row[i].method, &o, NULL, keep, &run, &stats);
    const double error = code ? INFINITY : error_most(ctx, &p, &l) / row[i].rtol;
    const bool good = !code && error < 2 && run.t[run.count - 1] == 1 &&
                      stats.width == row[i].width && stats.steps == run.count &&
                      stats.changes >= row[i].changes && stats.longest >= stats.shortest &&
                      stats.again == stats.changes * stats.width;
    CHECK(good);
    if (!good)
      printf("\n  %s, %s, %g: %d rows, %ld changes, error %.2g rtol %s", row[i].problem,
             row[i].method, row[i].rtol, run.count, stats.changes, error,
             code ? steif_message(ctx) : "");
    SUNMatDestroy(l.E), SUNMatDestroy(l.F);
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

/* ---- what can go wrong ------------------------------------------------------------------ */

static int attempt(steif_context *ctx, const char *problem, const char *method, double rtol,
                   int stop_at)
{
  steif_problem p;
  steif_linear l;
  int code = steif_problem_find(ctx, problem, &p);
  if (code) return code;
  if (!(code = steif_linear_of(ctx, &p, &l))) {
    steif_options o = steif_defaults();
    o.t1 = 1, o.rtol = rtol;
    run = (told){.n = (int)p.n, .stop_at = stop_at};
    code = steif_layers_run(ctx, &l, p.y0, 0, method, &o, NULL, keep, &run, NULL);
    SUNMatDestroy(l.E), SUNMatDestroy(l.F);
  }
  steif_problem_clear(ctx, &p);
  return code;
}

static void refusals_have_sentences(void)
{
  steif_context *ctx = steif_context_new(NULL);
  CHECK(attempt(ctx, "jordan:k=3", "gauss:s=3", 1e-3, 0) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "come through layers") != NULL);
  CHECK(attempt(ctx, "jordan:k=4", "radau:s=2", 1e-3, 0) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "its order is 0") != NULL);
  CHECK(attempt(ctx, "jordan:k=5,case=N-inc", "be", 1e-9, 0) == STEIF_STEP_SIZE);
  CHECK(strstr(steif_message(ctx), "rounding") != NULL);
  CHECK(attempt(ctx, "ut5", "be", 1e-2, 7) == STEIF_CALLBACK && run.count == 7);
  steif_context_free(&ctx);
}

static void every_allocation_may_fail(void)
{
  int code = STEIF_NO_MEMORY;
  long at = 0;
  while (code) {
    failing f = {.refuse_at = 0};
    const steif_setup setup = failing_setup(&f);
    steif_context *ctx = steif_context_new(&setup);
    f.refuse_at = f.served + ++at;
    code = attempt(ctx, "ut5", "bdf:p=3", 1e-3, 0);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    steif_context_free(&ctx);
    CHECK(f.alive == 0);
    CU_ASSERT_FATAL(at < 2000);
  }
  CHECK(at > 50);
}

CU_TestInfo tests_of_steady[] = {
  {"a change of the step run through its layer keeps the order", changes_keep_the_order},
  {"backward Euler has the errors of equal steps behind a change", changes_of_euler},
  {"chosen steps from any start keep the tolerance outside the first layer",
   tolerances_are_kept},
  {"refusals have sentences", refusals_have_sentences},
  {"every allocation may fail", every_allocation_may_fail},
  CU_TEST_INFO_NULL};
