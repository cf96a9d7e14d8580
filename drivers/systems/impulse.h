/* impulse.h: the jump of a descriptor system at its start, and the run that follows.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef IMPULSE_H
#define IMPULSE_H

#include "descriptor.h"
#include "integration.h"
#include "trajectory.h"

/* Each of the next ones returns an exit code. */

/* x(0+) and the impulses, or with --method the run that follows. */
int impulse_of_system(struct call *call, struct descriptor *l);
/* Trajectory, jumps and impulses up to --t1 by --method. */
int impulse_run(struct call *call, const struct descriptor *l);
/* Every descriptor system of the collection beside --vs. */
int impulse_collection(struct call *call);
/* The system of the words, or that of the problem found (.name), which is closed here. */
int impulse_on_system(struct call *call, const steif_problem *found);
/* Is the word a problem without a pencil of its own? It is opened where it is a problem at all, and impulse_nonlinear or
 * impulse_on_system closes it. */
bool impulse_is_nonlinear(struct call *call, steif_problem *problem);
int impulse_nonlinear(struct call *call, steif_problem *problem);

/* The jump as fields of a report: x(0+), impulses, how sure they are, y(0+). */
void report_impulse(steif_report *r, const struct descriptor *l, const steif_impulse *i);
/* EXIT_UNCERTIFIED after a sentence, or EXIT_OK. */
int impulse_verdict(const struct call *call, const steif_impulse *i);
/* The names of unknowns fit for columns beside t and kind; NULL: none. */
const char *const *impulse_columns(const struct descriptor *l);
/* Under "projectors.": the spectral projectors on the slow and the fast part, or what they make of
 * x(0-) where they are too large to be shown. */
int report_projectors(struct call *call, const struct descriptor *l, const steif_structure *s,
                      steif_report *r);
#define SLOPES_OPTION                                                                          \
  {                                                                                            \
    "--slopes", WORD, "W,W,...",                                                               \
      "derivatives of x(0+) and the impulses by parameters, E:i:j, F:i:j, x0:i, f:i, f:i:q",   \
      NULL                                                                                     \
  }
/* Under "d_WORD.": derivatives by every word of --slopes; some may be undecided, which is said. */
int report_slopes(struct call *call, const struct descriptor *l, const steif_structure *s,
                  steif_report *r, bool *undecided);
/* Under "vs.": how far `method` comes from the same x(0-), with the best of its settings; all of them in the
 * sheet "settings". */
void report_beside(const struct call *call, const struct descriptor *l, const char *method,
                   steif_report *r);
/* Of systems with an output y = C x + D u: y(0+) and its impulses; y at t where x is known. */
void report_output_jump(steif_report *r, const struct descriptor *l, const steif_impulse *i);
void report_output(steif_report *r, const char *name, const struct descriptor *l, double t,
                   const double *x);

#endif
