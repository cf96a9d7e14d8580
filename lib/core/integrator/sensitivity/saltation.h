/* saltation.h: S through events and breaks: where they are, and how the jump of y hands derivatives on.
 *
 * An event lies at tau(p), g(tau, y-, p) = 0, behind it y+ = R(tau, y-, p). With f- and f+ the slopes of y on
 * both sides,
 *   tau_p = -(g_y S- + g_p) / (g_y f- + g_t),
 *   S+ = R_y S- + R_p + (R_y f- + R_t - f+) tau_p,
 * the first three terms of which are the derivative of R along (tau_p, S- + f- tau_p, e_p). f- is the slope
 * of dense output, on which tau was located.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SALTATION_H
#define STF_SALTATION_H

#include "integrator.h"
#include "carry.h"
#include <steif/sensitivity.h>

typedef struct stf_transition_keeper stf_transition_keeper;

struct stf_saltation {
  sunrealtype t;                  /* of the event */
  N_Vector y, slope;              /* y- and f- */
  N_Vector after;                 /* f+ */
  N_Vector *S, *jump;             /* S- at the event, and S+ */
  N_Vector *found, *found_before; /* for jumps of index 1; NULL: there are none */
  sunrealtype *tau, *other;       /* tau_p of each column; of another function */
  N_Vector g[4], r[4];            /* values of g and of R, for differences */
  N_Vector point, direction;      /* where they are made; of the derivative */
  sunrealtype renewed;            /* time of the event that the run began anew at last */
  const sunrealtype *gy, *gp; /* of its function, and g_y f- + g_t, where there is a keeper */
  sunrealtype rate;
  bool known;   /* tau belongs to the event at t */
  bool pending; /* jump is S at the beginning of the next step */
  int wish;     /* what handle_event wants at other points */
  bool asked;   /* it was */
  void *bytes;  /* what begin resets, as it was before the event */
  long size;
  const stf_transition_keeper *keeper; /* for the way back (transition.h); NULL: nobody */
  struct stf_transition *open;         /* the transition being looked at */
};

/* Columns of S: none where a run is watched for the way back only. */
static inline int stf_columns(const steif_solver *s)
{
  return s->step.carry ? s->step.carry->count : 0;
}

/* event_times.c: y-, f- and S- at t in the last step; tau of the functions that fire at t too. */
int stf_saltation_look(steif_solver *s, sunrealtype t);
int stf_saltation_times(steif_solver *s, sunrealtype t);
int stf_saltation_values(steif_solver *s, sunrealtype t, N_Vector y, N_Vector out);
int stf_undifferentiable(steif_solver *s, int i, int code);
/* saltation.c: with no columns where S is not carried; `bytes` where the problem remembers something. */
int stf_saltation_claim(steif_solver *s);
int stf_saltation_remember(steif_solver *s, const char *who);
/* saltation_breaks.c: d breaks[i]/dp_k; given steps meet no breaks, and none may move. */
int stf_break_slope(steif_solver *s, int i, int k, sunrealtype *slope);
int stf_breaks_check(steif_solver *s);
/* y' of a run that is at (t, y); that at the first time behind t into `after`, or a known one. */
int stf_saltation_slope(steif_solver *s, sunrealtype t, N_Vector y, N_Vector slope);
int stf_saltation_behind(steif_solver *s, sunrealtype t, N_Vector y, N_Vector known);

/* start_derivatives.c: T->S of a start that was repaired; or of one with hidden constraints, checked. */
int stf_start_derivatives(steif_solver *s, stf_carry *T);
/* Adaptive runs of nonlinear DAEs of index 1: T->S jumps to what the equations differentiated ask for. */
int stf_start_jumps(steif_solver *s, stf_carry *T);
/* The same of S+ behind an event or break, at (t, y), and room for it. */
int stf_saltation_jumps(steif_solver *s, sunrealtype t, N_Vector y);
int stf_saltation_jumps_claim(steif_solver *s);
/* probe_starts.c: STEIF_BAD_INPUT where T->S is not the derivative of problem.start. */
int stf_probe_starts(steif_solver *s, stf_carry *T);
/* sensitivity.c: the place of parameter k in the list of columns. */
int stf_column(const steif_solver *s, int k, int *i);
/* value[k] = value, and what the problem keeps of it. */
int stf_set_parameter(const steif_solver *s, int k, sunrealtype value);

/* A line through the event: (t, y, p_k) + x (dt, dy, 1); k < 0: p stays. */
typedef struct stf_line {
  sunrealtype dt;
  N_Vector dy;
  int k;
} stf_line;
/* recomputed_columns.c: out = y on all constraints, unknowns of index 2 and 3 computed from the others. */
int stf_recomputed(steif_solver *s, sunrealtype t, N_Vector y, N_Vector out);
/* constrained_columns.c: S at (t, y, yp) onto the algebraic equations differentiated, of at most STEIF_DIAGNOSE_LARGEST
 * unknowns. */
int stf_columns_constrain(steif_solver *s, sunrealtype t, N_Vector y, N_Vector yp, N_Vector *S);
/* Column k of S inside the last step. */
int stf_column_dense(steif_solver *s, int k, sunrealtype t, N_Vector S);
typedef int (*stf_quantity_at)(steif_solver *s, sunrealtype t, N_Vector y, N_Vector out);
/* out = the derivative along the line at the event, by central differences of three lengths. STEIF_RETRY: shorter
 * ones do not agree, or there are no values; the sentence is the caller's. work: three more vectors. */
int stf_along(steif_solver *s, stf_quantity_at what, const stf_line *line, N_Vector out,
              N_Vector *work);
/* jump = dy + (derivative of `what` along (tau, dy, e_k)), dy = S- + f- tau; what options.reinitialise does behind a
 * break. */
int stf_saltation_through(steif_solver *s, stf_quantity_at what, int k, const char *name);
int stf_saltation_projection(steif_solver *s, sunrealtype t, N_Vector y, N_Vector out);

#endif
