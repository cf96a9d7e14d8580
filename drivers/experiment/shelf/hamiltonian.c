/* hamiltonian.c: small linear systems and in which senses they are Hamiltonian. References: their
 * Jordan forms, by hand.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"
#include <math.h>
#include <steif/hamiltonian.h>

static int run(stf_trial *t)
{
  const steif_hamiltonian_example *e;
  for (size_t i = 0; (e = steif_hamiltonian_example_at(i)); i++) {
    steif_hamiltonian h;
    STEIF_TRY(steif_hamiltonian_find(t->ctx, e->n, e->A, 0, &h));
    const struct {
      const char *quantity;
      int value, reference;
    } row[] = {{"definite", h.definite, e->definite},
               {"nonsingular", h.nonsingular, e->nonsingular},
               {"symplectic", h.symplectic, e->symplectic},
               {"invariant", h.invariant, e->invariant},
               {"dimension", h.dimension, e->dimension}};
    steif_hamiltonian_clear(t->ctx, &h);
    for (int k = 0; k < 5; k++)
      STEIF_TRY(stf_find(t, e->name, NAN, row[k].quantity, row[k].value, row[k].reference, 0));
  }
  return STEIF_OK;
}

const steif_experiment steif_experiment_hamiltonian = {
  .about = "which linear systems are Hamiltonian: 1 yes, 0 no, -1 undecided",
  .run = run,
};
