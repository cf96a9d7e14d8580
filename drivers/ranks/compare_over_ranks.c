/* compare_over_ranks.c: `steif compare PROBLEM METHOD ... --parallel`: methods and baselines with the same vectors,
 * tolerances and preconditioner, by counts.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "over_ranks.h"
#include <math.h>
#include <stdio.h>
#include <steif/data.h>

typedef struct comparison {
  const request *r;
  steif_context *ctx;
  steif_problem *p;
  N_Vector like, truth;
  steif_report *report;
  int good;
} comparison;

static steif_options options_of(const comparison *c, double rtol)
{
  steif_options o = steif_defaults();
  o.rtol = rtol, o.like = c->like;
  if (c->r->atol > 0) o.atol = c->r->atol;
  if (c->r->h > 0) o.h = c->r->h;
  return o;
}

/* Where there is no closed solution: Radau's method of order 9, at a hundredth of the smallest tolerance. */
static int find_truth(comparison *c, const double *rtol, int count)
{
  if (c->p->exact) return STEIF_OK;
  double least = rtol[0];
  for (int k = 1; k < count; k++) least = fmin(least, rtol[k]);
  ranks_run run;
  steif_options o = options_of(c, fmax(least / 100, 1e-11));
  o.h = 0;
  if (!(c->truth = N_VClone(c->like))) return STEIF_NO_MEMORY;
  run_over_ranks(c->ctx, c->p, c->like, c->r->linear, "radau:s=5", &o, NULL, c->truth, &run);
  return run.code;
}

static void add(comparison *c, const char *method, double rtol, const ranks_run *run)
{
  steif_report *t = c->report;
  steif_report_row(t, "rows");
  steif_report_text(t, "rows.method", method);
  steif_report_real(t, "rows.rtol", rtol);
  steif_report_real(t, "rows.error", run->error);
  steif_report_text(t, "rows.status", steif_code_name(run->code));
  steif_report_whole(t, "rows.steps", run->stats.steps);
  steif_report_whole(t, "rows.rejected", run->stats.rejected);
  steif_report_whole(t, "rows.iterations", run->stats.nli);
  steif_report_whole(t, "rows.cycles", run->linear.solves);
  steif_report_whole(t, "rows.setups", run->linear.setups);
  steif_report_whole(t, "rows.reductions", run->sums);
  steif_report_real(t, "rows.cpu_s", run->seconds);
  steif_report_real(t, "rows.setup_s", run->setup_seconds);
  steif_report_real(t, "rows.cycle_s", run->cycle_seconds);
}

static void one(comparison *c, const char *method, double rtol)
{
  ranks_run run;
  const steif_options o = options_of(c, rtol);
  run_over_ranks(c->ctx, c->p, c->like, c->r->linear, method, &o, c->truth, NULL, &run);
  c->good += !run.code;
  if (run.code) object(c->r, "%s, rtol %g: %s", method, rtol, steif_message(c->ctx));
  if (c->report) add(c, method, rtol, &run);
  steif_forget(c->ctx);
}

/* Only rank 0 has a report. */
static int work(comparison *c)
{
  static const double usual[] = {1e-4, 1e-6};
  const request *r = c->r;
  const double *rtol = r->tolerances ? r->rtol : usual;
  const int count = r->tolerances ? r->tolerances : 2;
  steif_method_info info;
  for (int m = 0; m < r->methods; m++)
    if (steif_method_find(c->ctx, r->method[m], &info)) return steif_status(c->ctx);
  if (r->t1 > 0) c->p->t1 = r->t1;
  const int code = find_truth(c, rtol, count);
  if (code) return code;
  for (int m = 0; m < r->methods; m++)
    for (int k = 0; k < count; k++) one(c, r->method[m], rtol[k]);
  return c->report ? steif_report_write(c->report, r->json ? STEIF_JSON : STEIF_TABLE, stdout)
                   : STEIF_OK;
}

static steif_report *head(const comparison *c)
{
  steif_report *t = steif_report_new(c->ctx);
  steif_report_text(t, "problem", c->r->problem);
  steif_report_text(t, "linear", c->r->linear);
  steif_report_whole(t, "ranks", c->r->ranks);
  steif_report_whole(t, "unknowns", (long)c->p->n);
  return t;
}

int compare_over_ranks(const request *r)
{
  comparison c = {.r = r, .ctx = steif_context_new(NULL)};
  c.p = steif_mpi_problem_new(c.ctx, r->problem, MPI_COMM_WORLD, &c.like);
  if (c.p && r->rank == 0) c.report = head(&c);
  int code = c.p ? work(&c) : steif_status(c.ctx);
  if (code) object(r, "%s", steif_message(c.ctx));
  steif_report_free(&c.report);
  if (c.truth) N_VDestroy(c.truth);
  steif_mpi_problem_free(c.ctx, &c.p, &c.like);
  steif_context_free(&c.ctx);
  code = code ? exit_of_code(code) : c.good ? FINE : FAILED;
  MPI_Bcast(&code, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return code;
}
