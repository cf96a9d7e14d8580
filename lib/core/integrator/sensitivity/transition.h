/* transition.h: what an event or a break does to derivatives, for runs that are gone through backwards.
 *
 * With the names of saltation.h, what a small change dy of y at a fixed time, and dp of p, before an event leave
 * behind it is
 *   R_y dy + R_p dp + (R_y f- + R_t - f+) dtau,   dtau = -(g_y dy + g_p dp) / (g_y f- + g_t):
 * with D_y dy + D_p dp the derivative of R where the event moves along, (t + dtau, y + dy + f- dtau, p + dp), this is
 *   D_y dy + D_p dp - f+ dtau;
 * transposed, with E_y = D_y - 1 - f- dtau/dy, E_p = D_p - f- dtau/dp, sigma = -lambda . (f- - f+) / (g_y f- + g_t),
 *   lambda <- lambda + E_y^T lambda + sigma g_y^T,   mu <- mu + E_p^T lambda + sigma g_p^T.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_TRANSITION_H
#define STF_TRANSITION_H

#include "saltation.h"

/* Nothing but what the problem remembers; the run begins anew behind an event, ends there, or passes a break. */
enum stf_passage { STF_PASSED, STF_RESTARTED, STF_ENDED, STF_BROKEN };

/* Of E_y, and from column n on of E_p. */
typedef struct stf_entry {
  sunindextype row, column;
  sunrealtype value;
} stf_entry;

typedef struct stf_transition {
  enum stf_passage kind;
  sunrealtype t, behind;  /* of it, and the first time after it */
  sunrealtype rate;       /* g_y f- + g_t */
  sunrealtype *gy, *gp;   /* n and P; of a break gp is its time by p */
  sunrealtype *across;    /* f- - f+; at an end f- */
  sunrealtype *y, *slope; /* y and y' behind it */
  sunrealtype *gap;       /* of the integrands: before less after; at an end before */
  sunrealtype *numbers;   /* where all of these are */
  stf_entry *entry;
  size_t entries, room;
  unsigned char *memory;      /* what the problem remembers before it; NULL: nothing */
  size_t bytes, memory_bytes; /* bytes: of all blocks */
} stf_transition;

/* Who keeps them. add: a new one, zeroed, with arrays; gap: gap += sign * integrands at (t, y). */
struct stf_transition_keeper {
  void *of;
  int (*add)(void *of, bool broken, stf_transition **transition);
  int (*gap)(void *of, stf_transition *transition, sunrealtype sign, sunrealtype t, N_Vector y);
};

/* From now on transitions of s go to the keeper, who must outlive it. STEIF_UNSUPPORTED: the problem remembers
 * something, and lacks save and restore. */
int stf_transitions_watch(steif_solver *s, const stf_transition_keeper *keeper);
/* The arrays of a transition of n unknowns, P parameters and `count` integrands, and their end. */
int stf_transition_claim(steif_context *ctx, sunindextype n, int P, int count,
                         stf_transition *transition);
void stf_transition_release(steif_context *ctx, stf_transition *transition);

/* The run has ended at an event. */
int stf_transition_end(steif_solver *s);
/* The problem remembers again what it did before. */
int stf_transition_recall(steif_solver *s, const stf_transition *transition);

/* saltation.c calls these: before what happens at an event, with its slopes or, where the run goes on, without;
 * behind it, with f+ in saltation->after; and at break i, before and behind. */
int stf_transition_pass(steif_solver *s);
int stf_transition_before(steif_solver *s, stf_quantity_at reaction);
int stf_transition_after(steif_solver *s, N_Vector y);
int stf_transition_break(steif_solver *s, int i); /* i < 0: it adds nothing */
/* Does break i move with p as break `first` does, or with first < 0 as the event that the run has begun anew at? */
bool stf_transition_together(const steif_solver *s, int i, int first);
int stf_transition_broken(steif_solver *s);

#endif
