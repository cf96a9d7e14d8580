/* repair.h: the start of a run: is it consistent, and the nearest start that is.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_REPAIR_H
#define STF_REPAIR_H

#include "sparse_view.h"

/* Matrices C and zero by columns for a pencil, whose shift 1 is C. */
typedef struct stf_view_factor {
  SUNMatrix C, zero;
  steif_pencil *pencil;
} stf_view_factor;

/* One look at a start. problem is a copy of the given one whose y0, index and dae_index are those to be
 * used; its arrays are of the pool. */
typedef struct stf_repair {
  steif_context *ctx;
  stf_pool *pool;
  const steif_problem *given;
  enum steif_initial policy;
  const int *attribute; /* n of enum steif_attribute; NULL: all guesses */
  sunrealtype rtol, atol;
  const sunrealtype *atols;
  steif_problem problem;
  steif_repair report;
  bool
    jumps; /* linear, and not consistent: its jump, by `descriptor`, is the start to be used */
  bool unsolved; /* not consistent, and no start found: the run tries it all the same */
  /* work */
  stf_point point;
  stf_view view;
  sunrealtype *y, *yp, *weight; /* n each; weight: rtol |y| + atol */
  bool *algebraic;              /* n: the column of E is zero */
  size_t count;                 /* of those */
  int *mode; /* n: .index of `problem` since an event or a break; NULL: as at the start */
  stf_view_factor first; /* of index 1, at the point given; pencil NULL: not there */
  bool judges;           /* pencils that are singular at every shift are errors */
  bool irregular;        /* this one is, and a sentence says so */
  stf_view_factor step;  /* of a step of length step_h; pencil NULL: not there */
  sunrealtype step_h;
  int factors; /* made so far */
} stf_repair;

/* Look at the start of `given`: repair->problem and repair->report. The point stays open, as long as the pool
 * lives: a run may take its system over. */
int stf_repair_start(stf_repair *repair);

/* repair_report.c, appended to the report's sentence. What moved to y, counted too; the equations that the start violates most;
 * those whose derivatives the stages have kept, and how often; momenta and charges that velocities of a jump have changed;
 * invariants that change. */
struct steif_diagnosis;
void stf_report_moved(stf_repair *repair, const sunrealtype *y);
int stf_report_violated(stf_repair *repair);
void stf_report_enforced(stf_repair *repair, const int *enforced);
int stf_report_impulses(stf_repair *repair, const struct steif_diagnosis *d,
                        const sunrealtype *y);
int stf_report_invariants(stf_repair *repair, const sunrealtype *y);

/* algebraic_newton.c: C = (columns of F_y' with entries | columns of F_y of the others), by which F = 0
 * is solved for y_d' and y_a. *regular: the DAE has index 1 (0 without algebraic components). */
int stf_index_one(stf_repair *repair, bool *regular);
/* Solve for y_a; the first correction is in *first, in tolerances: at most 1, and y stays as it is. */
int stf_algebraic_newton(stf_repair *repair, sunrealtype *first);

/* second_branch.c: r->y is the nearest consistent start; refused where two are about as near. first: of the
 * iteration that has found r->y. */
int stf_nearest_branch(stf_repair *repair, sunrealtype first);

/* first_jump.c: the largest jump in a step of backward Euler as h -> 0, in tolerances, of unknowns with a derivative
 * and of those of index 1 and 2. Zero for consistent starts of index up to 3. */
int stf_first_jump(stf_repair *repair, sunrealtype *largest);

/* Lengths of those steps, the first of use; those above the interval's share are 0. */
enum { STF_JUMP_LENGTHS = 4 };
void stf_jump_lengths(stf_repair *repair, sunrealtype *h);

/* singular_pencil.c: STEIF_SINGULAR with a sentence where E and F_y are constant and s E + F_y is singular to rounding at
 * every s. Leaves factors of the first step for stf_first_jump. */
int stf_judge_pencil(stf_repair *repair);
/* The same of a system with entries at its start y, scratch a vector more. Of *repair ctx, pool and given are there. */
int stf_judge_system(stf_repair *repair, const stf_system *system, N_Vector y,
                     N_Vector scratch);

/* e_j of the view times `derivative` plus b_j times `value`, chosen by column j; factored. STEIF_SINGULAR
 * leaves no sentence. */
int stf_view_factor_open(stf_repair *repair, sunrealtype derivative, const bool *by_value,
                         sunrealtype value, stf_view_factor *columns);
void stf_view_factor_close(stf_view_factor *columns);

#endif
