/* inexact.c: forcing terms.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "inexact.h"
#include "pencil.h"
#include <math.h>

/* Of a solve that has to be good for all digits that Newton's iteration wants (P. N. Brown & A. C.
 * Hindmarsh, Appl. Math. Comput. 31, 1989; CVODE, IDA). */
static const sunrealtype WHOLE = 0.05;
static const sunrealtype FLOOR = 0.5, FORCING = 0.1;

/* Errors of this size in each row of omega make dZ = T omega wrong by 1. */
static sunrealtype unit(const stf_newton *newton)
{
  const stf_transform *transform = &newton->transform;
  const int s = transform->s;
  sunrealtype sum = 0;
  for (int i = 0; i < s * s; i++) sum += transform->T[i] * transform->T[i];
  return sqrt(s / sum);
}

void stf_inexact_whole(stf_newton *newton)
{
  stf_pencil_aim(newton->system->pencil, newton->weights, WHOLE * newton->tolerance);
}

/* Only where GMRES makes no call after its last sum. */
void stf_inexact_defer(stf_newton *newton, bool on)
{
  const steif_pencil *p = newton->system->pencil;
  if (p->deferred) p->deferred->on = on && p->weights && (p->op.precondition || !p->op.E);
}

void stf_inexact_sweep(stf_newton *newton, int m)
{
  steif_pencil *pencil = newton->system->pencil;
  const bool krylov = newton->system->krylov && newton->gamma == 0;
  const bool forced = krylov && !(newton->system->linear && m > 0);
  const sunrealtype part = krylov ? FLOOR : WHOLE;
  stf_pencil_aim(pencil, newton->weights, part * newton->tolerance * (m ? unit(newton) : 1));
  if (krylov) stf_pencil_force(pencil, forced ? FORCING : 0, m < 2);
}
