/* demand.c: which derivatives of f a solution depends on. Equation i is differentiated degree_i times at
 * most (dulmage_mendelsohn.c), and so is f_i: a load sqrt(t) in an equation that is not differentiated need have no
 * derivative at all.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "demand.h"
#include "sentences.h"
#include "structural.h"
#include "units.h"
#include <math.h>
#include <stdio.h>

stf_demand stf_demand_of(steif_context *ctx, const steif_linear *l,
                         const steif_analysis *analysis)
{
  const steif_names *names = analysis ? analysis->names : NULL;
  return (stf_demand){ctx, l->E, l->F, l->f, l->user, names, -1, NULL};
}

steif_linear stf_demand_linear(stf_demand *d)
{
  return (steif_linear){d->E, d->F, d->f ? stf_demand_value : NULL, d};
}

static int degrees(stf_demand *d, stf_pool *pool, sunindextype *degree)
{
  stf_graph g, t;
  stf_units u;
  sunindextype rank;
  STEIF_TRY(stf_units_open(d->ctx, pool, d->E, d->F, &u));
  STEIF_TRY(stf_structural_graph(d->ctx, pool, u.E, u.F, &g));
  STEIF_TRY(stf_graph_match(pool, &g, &rank));
  STEIF_CHECK(rank == g.n, d->ctx, STEIF_SINGULAR,
              "the patterns of E and F allow rank %lld of %lld: no solution is determined",
              (long long)rank, (long long)g.n);
  const sunindextype surplus = stf_graph_weight(&g) - d->finite;
  STEIF_TRY(stf_graph_transpose(pool, &g, &t));
  STEIF_TRY(stf_graph_degrees(pool, &t, degree));
  for (sunindextype i = 0; i < g.n; i++) degree[i] += surplus;
  return STEIF_OK;
}

static int find(stf_demand *d, sunindextype n)
{
  stf_pool *pool = stf_pool_new(d->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  int code = STEIF_NO_MEMORY;
  if ((d->degree = stf_allocate(d->ctx, (size_t)n, sizeof *d->degree)))
    code = degrees(d, pool, d->degree);
  stf_pool_free(&pool);
  if (code) stf_demand_close(d);
  return code;
}

/* What the forcing itself said of the one component that has no derivative. */
static int refuse(const stf_demand *d, sunindextype i, sunindextype missing)
{
  char name[STF_NAME], words[256] = "";
  if (missing == 1 && steif_status(d->ctx))
    snprintf(words, sizeof words, ": %s", steif_message(d->ctx));
  return STEIF_RECOVER(d->ctx, STEIF_BAD_INPUT, "%s has none, and the solution depends on it%s",
                       stf_name_equation(d->names, i, name), words);
}

int stf_demand_value(sunrealtype t, int derivative, N_Vector g, void *demand)
{
  stf_demand *d = demand;
  sunindextype wanted = -1, missing = 0;
  const int code = d->f(t, derivative, g, d->user);
  if (code || derivative < 1) return code;
  sunrealtype *x = N_VGetArrayPointer(g);
  for (sunindextype i = 0, n = N_VGetLength(g); i < n; i++) {
    if (!isnan(x[i])) continue;
    missing++;
    if (d->finite >= 0 && !d->degree) STEIF_TRY(find(d, n));
    if (d->degree && d->degree[i] < derivative)
      x[i] = 0;
    else if (wanted < 0)
      wanted = i;
  }
  return wanted < 0 ? STEIF_OK : refuse(d, wanted, missing);
}

void stf_demand_close(stf_demand *d)
{
  stf_release(d->ctx, d->degree);
  d->degree = NULL;
}
