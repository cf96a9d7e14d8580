/* passage.h: a run of E x' + F x = f from segment to segment: at the beginning of each a jump
 * with its impulses, then a method on the smooth solution.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PASSAGE_H
#define STF_PASSAGE_H

#include <steif/runs.h>
#include "component_index.h"
#include "demand.h"
#include "reduce.h"
#include "smooth_flow.h"

/* It stays where it is from open to close. */
typedef struct stf_passage {
  steif_context *ctx;
  const steif_linear *given;
  const char *name; /* of the problem in sentences; NULL: E x' + F x = f */
  const char *method;
  steif_options options; /* of every segment, t1 and h0 apart */
  const steif_analysis *analysis;
  /* Told of every jump; nonzero stops the run. NULL: nobody is. */
  int (*jump)(sunrealtype t, const sunrealtype *before, const steif_impulse *impulse,
              void *user);
  void *user;
  /* --- from here on its own --- */
  stf_demand demand;         /* derivatives of f that matter, ... */
  steif_linear linear;       /* ... of this */
  steif_structure structure; /* of the pencil, found once */
  sunindextype n;
  sunrealtype *x;      /* x(t-) of the next jump, x(t+) behind it, the end of a segment */
  int *index;          /* of each unknown; NULL: all 1 */
  stf_reduced reduced; /* what chosen steps are made on, where there is one */
  bool settles;        /* else they leave errors in the fast part, which is then found anew */
  stf_smooth_flow
    through; /* with factors that are kept, where circles have found the structure */
  sunrealtype end, before; /* of the segment; the last number before it */
  sunrealtype scale;       /* of the states up to there */
  steif_linear cut;        /* with f up to the end: where it breaks there, from the left */
  steif_problem problem;   /* of the segment ... */
  steif_solver *solver;    /* ... and what makes its steps */
  steif_pencil_stats cost; /* of sparse analyses */
} stf_passage;

/* Members up to `user` are the caller's. x0: n values x(t0-). */
int stf_passage_open(stf_passage *p, const sunrealtype *x0);
/* The jump at `from`, and a solver from there up to `to`. */
int stf_passage_begin(stf_passage *p, sunrealtype from, sunrealtype to);
/* The fast part of the smooth solution x (n) at t as f has it, in place; at the end of the
 * segment from the left. */
int stf_passage_settle(stf_passage *p, sunrealtype t, sunrealtype *x);
/* Accepts half-opened ones. */
void stf_passage_close(stf_passage *p);

#endif
