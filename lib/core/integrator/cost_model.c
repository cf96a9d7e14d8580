/* cost_model.c: what the parts of a step cost, in nanoseconds of one core of an x86 server of 2020; only ratios
 * matter. No clock is asked, so that a run is the same every time: a call of f is taken to cost what
 * its Jacobian has entries.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lu.h"
#include "switching.h"

/* Small systems have kernels of their own, others LAPACK; entries of sparse factors are read from
 * memory. */
static void dense(const stf_step *s, stf_cost *p)
{
  const double n = (double)s->problem->n;
  const bool own = s->problem->n <= STF_INTERLEAVED;
  p->entries = n * n;
  p->factor = 30 + n * n * n / (own ? 15 : 8);
  p->solve = 20 + n * n * (own ? 0.33 : 0.9);
}

static void band(const stf_step *s, stf_cost *p)
{
  const double n = (double)s->problem->n, lower = (double)s->problem->lower,
               upper = (double)s->problem->upper;
  p->entries = n * (lower + upper + 1);
  p->factor = n * (20 + 2 * lower * (lower + upper));
  p->solve = n * (10 + 2 * lower + upper);
}

/* Counted in instructions, for the brusselator on grids of 968, 3528 and 9800 unknowns: a solve is 0.60, 0.72, 0.79 of
 * a step of thirteen explicit stages (here 0.60, 0.79, 1.0), a factor 15 to 18, 27 to 36, 38 to 47 (15, 37, 84). */
static void sparse(const stf_step *s, stf_cost *p)
{
  const double n = (double)s->problem->n;
  double fill = 0, work = stf_system_fill(&s->system, &p->entries, &fill);
  if (work < 0) {
    fill = 10 * p->entries;
    work = 100 * fill;
  }
  p->factor = 50 * n + 0.15 * work;
  p->solve = 5 * n + 0.3 * fill;
}

/* Differences take a column, or a group of columns, per call. */
static double jacobian(const stf_step *s, const stf_cost *p)
{
  const steif_problem *of = s->problem;
  if (of->jac || of->A) return 5 * p->f;
  switch (s->system.storage) {
  case STEIF_DENSE: return p->f * (double)of->n;
  case STEIF_BAND: return p->f * (double)(of->lower + of->upper + 1);
  default: return 10 * p->f;
  }
}

/* Of a usual step: Newton's iteration converges in four sweeps; the blended one, which keeps its factors, takes two
 * for each stage (16 solves a step with three stages, 47 with five); a Rosenbrock method has eight stages at
 * most. Linear systems need one sweep, and no factors while the length of steps stays; a complex shift
 * costs three real ones. */
static double usual(const stf_step *s, const stf_cost *p)
{
  const double stages = s->table ? s->table->s : 1, lanes = (stages + 1) / 2;
  if (s->newton.gamma > 0)
    return 0.3 * (p->factor + p->jacobian) + 2 * stages * stages * (p->solve + p->f / 2);
  if (s->table && s->system.linear)
    return (3 * lanes - 2) * (0.5 * p->factor + p->solve) + stages * p->f;
  if (s->table) return lanes * (p->factor + 4 * p->solve) + 4 * stages * p->f + p->jacobian;
  if (s->method->traits & STF_MULTISTEP)
    return 0.1 * (p->factor + p->jacobian) + 2 * (p->solve + p->f);
  return (s->system.linear ? 0.5 * p->factor : p->factor + p->jacobian) + 8 * (p->solve + p->f);
}

void stf_cost_of(const stf_step *s, int stages, stf_cost *p)
{
  const double n = (double)s->problem->n;
  switch (s->system.storage) {
  case STEIF_DENSE: dense(s, p); break;
  case STEIF_BAND: band(s, p); break;
  default: sparse(s, p);
  }
  p->f = 10 + 0.16 * p->entries;
  p->jacobian = jacobian(s, p);
  p->step = usual(s, p);
  p->explicit_step = stages * (p->f + 20 + 0.25 * n * stages / 2);
}
