/* krylov_statistics.c: what GMRES has cost a run.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include "pencil.h"
#include <steif/krylov.h>

const steif_krylov_stats *steif_krylov_statistics(steif_solver *s)
{
  static const steif_krylov_stats none = {0};
  const stf_system *system = s && !s->engine ? &s->step.system : NULL;
  if (!system || !system->krylov || !system->pencil) return &none;
  const steif_pencil_stats *pencil = steif_pencil_statistics(system->pencil);
  const stf_krylov_counts *counts = &system->pencil->counts;
  s->krylov = (steif_krylov_stats){.setups = pencil->factors,
                                   .applications = counts->applications,
                                   .products = counts->products,
                                   .solves = pencil->solves,
                                   .complex_solves = counts->complex_solves,
                                   .iterations = pencil->iterations,
                                   .complex_iterations = counts->complex_iterations,
                                   .reductions = counts->sums + system->sums + s->agreements};
  return &s->krylov;
}
