/* event.h: what watches the event functions of a problem during a run.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_EVENT_H
#define STF_EVENT_H

#include "base.h"
#include <steif/solver.h>

enum {
  STF_NODES = 5, /* Chebyshev points of a step, both ends among them */
  STF_FINE = 16  /* parts of a step at whose ends the polynomial through them is looked at */
};

typedef struct stf_detector {
  int count;         /* event functions */
  N_Vector y, after; /* inside the step; the state at the last event, then behind it */
  N_Vector slope;    /* y' of `after`, if it is settled */
  N_Vector place;    /* kept_sides.c: the state at the event, on its constraints */
  sunrealtype t;     /* before it the step has been searched ... */
  sunrealtype *low;  /* ... and g had these values */
  sunrealtype *high, *mid, *next;
  sunrealtype *node;  /* STF_NODES rows of g */
  sunrealtype *fine;  /* STF_FINE + 1 rows of the polynomials through them */
  sunrealtype *noise; /* |g| that cannot be told from zero behind an event */
  int *sign;          /* side of each function at t: 1, -1; 0: at zero, side unknown */
  int *fired;
  int *seen;           /* horizon.c: side at the looks so far; 0: none yet */
  sunrealtype horizon; /* found there; not behind s->end: to be looked for */
  int *first;          /* those that fired before the jump that they have made */
  int *coarse;         /* kept_sides.c: `noise` is what errors of the step make of it */
  int *rests;          /* resting.c: it is zero in this part of the step but for errors */
  int *leaves;      /* the side to which y' takes a function that is at zero when a step begins;
                       0: not known, or not at zero */
  bool started;     /* g was seen at the start */
  bool cut;         /* the step ends at the event, the next one begins anew from `after` */
  bool again;       /* the step goes on; g behind the event may be another */
  bool settled;     /* options.reinitialise has found the slope */
  bool moved;       /* the last reaction changed y */
  bool silent;      /* the end of the step was shown to the observer before the reaction */
  sunrealtype last; /* time of the last restart */
  bool crowded;     /* the run ended since they follow each other ever faster */
  int gathered;     /* restarts in a row with almost no time between them */
  char name[160];   /* of the last event */
  /* passed.c; passed: of y, then of each column of S; NULL: methods have dense output of their own */
  N_Vector *passed;
  sunrealtype from,
    to; /* the way of the last step up to its event, and whether it is asked for */
  bool passing;
} stf_detector;

/* s->events for a problem with events, else nothing. */
int stf_event_open(steif_solver *s);
/* Before a step: begin anew behind an event. */
int stf_event_begin(steif_solver *s);
/* After a step that began at `from`: find its events and react to them; s->end is lowered to one that
 * changes the state or ends the run. */
int stf_event_step(steif_solver *s, sunrealtype from);
/* Is the solution at s->end in watch->after? */
bool stf_event_holds(const steif_solver *s);

/* --- event.c, for event_handler.c --- */
/* g at t by dense output, and at y. */
int stf_event_value(steif_solver *s, sunrealtype t, sunrealtype *g);
int stf_event_ask(steif_solver *s, sunrealtype t, N_Vector y, sunrealtype *g);
/* "'ground'", or "g1" of a function without a name. */
void stf_event_name(const steif_problem *p, int i, size_t room, char *name);
/* Resolution of time near t. */
sunrealtype stf_event_tolerance(const steif_solver *s, sunrealtype t);
/* The sentence for function i that comes back to zero within a step of h after an event at t. */
int stf_event_below(steif_solver *s, int i, sunrealtype t, sunrealtype h);
/* Does function i leave its side for g in the direction asked for? */
bool stf_event_crosses(const steif_solver *s, int i, sunrealtype g);

/* --- kept_sides.c --- */
/* w->noise of what fires at t, before the reaction, by w->after. */
int stf_event_find_noise(steif_solver *s, sunrealtype t);
/* Is function i kept on the side to which it has fired, as long as no more than this is seen? */
bool stf_event_kept(const stf_detector *w, int i, sunrealtype g);

/* --- resting.c --- */
/* w->rests for the part of a step that ends at t, from w->node. */
int stf_event_find_resting(steif_solver *s, sunrealtype t);
/* w->fired: functions that a jump to w->after at t has put on their other side, clear of errors; their new sides. */
int stf_event_find_jumped(steif_solver *s, sunrealtype t, bool *any);

/* --- horizon.c --- */
/* Where a step has to end at the latest, s->t1 or earlier: not far behind the next change of an event function in t alone,
 * up to where f is as it is now. */
int stf_event_horizon(steif_solver *s, sunrealtype *stop);

/* --- passed.c --- */
/* Room for it; look at the way to an event at t before it is handled. */
int stf_event_pass_open(steif_solver *s);
int stf_event_pass(steif_solver *s, sunrealtype t);
/* Is dense output of the last step to be had from there? At t. */
bool stf_event_passed(const steif_solver *s);
/* y, or column k >= 0 of S. */
int stf_event_recall(const steif_solver *s, int k, sunrealtype t, N_Vector y);

/* --- event_handler.c --- */
/* The event at t: tell, react; low, high: g on both sides of it. */
int stf_event_fire(steif_solver *s, sunrealtype t, sunrealtype to);

#endif
