/* newton_kept.c: what of Newton's iteration goes on in a run that is continued from a file.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "newton.h"

void stf_newton_keep(stf_newton *newton, stf_image *m)
{
  const int s = newton->transform.s; /* 0: the method has an iteration of its own */
  STF_KEEP(m, newton->single);
  STF_KEEP(m, newton->transform.re[0]);
  if (newton->single != 0) newton->transform.B = &newton->single;
  stf_keep(m, newton->B_over_h, (size_t)(s * s) * sizeof *newton->B_over_h);
  STF_KEEP(m, newton->tolerance);
  STF_KEEP(m, newton->shift);
  STF_KEEP(m, newton->relax);
  STF_KEEP(m, newton->h);
  STF_KEEP(m, newton->factored);
  STF_KEEP(m, newton->jacobian_new);
  STF_KEEP(m, newton->jacobian_wanted);
  STF_KEEP(m, newton->theta);
  STF_KEEP(m, newton->eta);
  STF_KEEP(m, newton->eta_of);
  STF_KEEP(m, newton->count);
  STF_KEEP(m, newton->sweeps);
  STF_KEEP(m, newton->fails);
}
