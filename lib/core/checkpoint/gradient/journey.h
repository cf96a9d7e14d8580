/* journey.h: a run forward and back, its records and images.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_JOURNEY_H
#define STF_JOURNEY_H

#include "backwards.h"

enum { STF_FEWEST = 3 }; /* images */

/* An image of the solver before step `step`. */
typedef struct stf_run_image {
  unsigned char *bytes; /* NULL: in a file */
  size_t count;
  sunrealtype *tangent; /* NULL: none wanted */
  long step;
} stf_run_image;

typedef struct stf_journey {
  stf_backwards back;
  steif_options options;
  const char *method;
  steif_gradient *out;
  steif_solver *runner;    /* makes steps; the first one is the run */
  long stands;             /* before which step the runner stands */
  bool reused, always_new; /* it had been elsewhere before its image; that did not serve */
  stf_logged *log;
  long steps, room;      /* of the log */
  sunrealtype *record;   /* `window` of them ... */
  long window, recorded; /* ... of which so many hold the first steps */
  bool whole;            /* all steps so far are recorded */
  stf_run_image *image;
  int images, images_most;
  long stride, origin; /* of images on the way forward: at origin + k stride; 0: none yet */
  long base, until;    /* the steps that are being gone back through */
  size_t limit, bytes, on_images;
  stf_transition_keeper keeper;
  stf_passed *passed; /* events and breaks; `left` of them are still to be gone back through */
  long passages, passages_most, left;
  size_t on_passages;
  sunrealtype
    *along;         /* integrals along dense output, of their sizes, and scratch; NULL: none */
  sunrealtype *end; /* count: G at the end */
  bool ended;       /* what is asked of the end has been looked at */
  sunrealtype quiet, longest; /* time in steps that show no error; the longest of all */
  bool again;                 /* that was much */
  steif_direction *line;      /* of second derivatives ... */
  sunrealtype *Hp, *Hy0;      /* ... which go there; NULL: first ones only */
} stf_journey;

/* gradient.c: a gradient, and with a line, second derivatives along it. */
int stf_journey_make(stf_journey *J, const steif_problem *problem,
                     const steif_functional *functional, steif_gradient *g);
/* The way there and back, in one go, from a call that was checked. */
int stf_journey_once(stf_journey *J, const steif_problem *problem,
                     const steif_functional *functional, steif_gradient *g);
/* quiet_steps.c: after a step; did y stand still for much of the time? Then the same once more with steps below the longest,
 * until gradients agree. */
void stf_quiet_step(stf_journey *J);
bool stf_quiet(const stf_journey *J);
int stf_quiet_again(const stf_journey *call, const steif_problem *problem,
                    const steif_functional *functional, sunrealtype longest, steif_gradient *g);
/* lambda, mu and J at the end, where the runner and the tangent stand. */
int stf_journey_end(stf_journey *J);

/* The start as an image, then all steps, recorded while that fits; and back through them. */
int stf_journey_forward(stf_journey *J);
int stf_journey_back(stf_journey *J);
void stf_journey_close(stf_journey *J);

/* Of the above: step k once more; what may still be taken of the limit beside a log of so many steps and the images; how much
 * has been. */
int stf_journey_again(stf_journey *J, long k, sunrealtype *record);
size_t stf_journey_rest(const stf_journey *J, long log);
void stf_journey_took(stf_journey *J);

/* run_images.c: the image of the start; that of the runner before step `at`; after a step forward perhaps one; the last one
 * goes; the runner goes on from there; unless it stands there. Bytes of tangents beside one. */
int stf_images_open(stf_journey *J);
int stf_images_save(stf_journey *J, long at);
int stf_images_on_the_way(stf_journey *J);
void stf_images_drop(stf_journey *J);
int stf_images_revive(stf_journey *J);
int stf_images_restore(stf_journey *J);
size_t stf_images_beside(const stf_journey *J);
/* reversal.c: back through all steps, none of which is recorded. */
int stf_reversal(stf_journey *J);

/* event_passages.c: events and breaks of the run go into J->passed; what has happened in the step just made; back through a
 * record and what came after its step; through what happened at the start; and J->passed is released. */
int stf_passages_open(stf_journey *J);
int stf_passages_see(stf_journey *J);
int stf_passages_pull(stf_journey *J, long step, const sunrealtype *record);
int stf_passages_first(stf_journey *J);
void stf_passages_close(stf_journey *J);

/* integral_along.c: integrals that no error test of steps sees, seen otherwise; before the first step, after each, and when J is known. */
int stf_along_open(stf_journey *J);
int stf_along_step(stf_journey *J);
int stf_along_check(const stf_journey *J);

#endif
