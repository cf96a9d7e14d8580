/* subject.h: a descriptor system from x(0-), to be run by methods, beside its solution in the sense
 * of distributions.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SUBJECT_H
#define STF_SUBJECT_H

#include "apart.h"
#include "weak_inside.h"
#include "reduce.h"

/* What happens at a break of f: x(t+) and impulses. */
typedef struct stf_jump {
  sunrealtype t;
  steif_impulse at;
} stf_jump;

/* A Jordan block (everything by closed formulas), another problem of the collection, or a system of
 * the caller's. */
typedef struct stf_subject {
  steif_context *ctx;
  steif_problem problem; /* from x(0-); named ones are cleared */
  bool named;
  int n, index;
  stf_block block;     /* of a Jordan block, k > 0 */
  steif_linear linear; /* of the others; named: its matrices are new */
  steif_structure structure;
  steif_impulse impulse; /* at 0 */
  stf_weight weight; /* the test function; that of steif_test_function until it is changed */
  sunrealtype rate;  /* at which f changes, 1/time; 0: not looked at */
  stf_sides sides;   /* linear.f of a caller's system, with the breaks that are set here */
  stf_jump *jump;    /* at the breaks, as many as are found */
  size_t jumps;
  stf_reduced reduced; /* with the same smooth solutions, where there is one */
  stf_apart apart;     /* the same system in other coordinates, where there are some */
} stf_subject;

/* linear NULL: the problem called `spec`. The subject stays where it is until it is closed. */
int stf_subject_open(steif_context *ctx, const char *spec, const steif_linear *linear,
                     const sunrealtype *x0, stf_subject *subject);
void stf_subject_close(stf_subject *subject);

/* The coordinates for runs; NULL: those of the problem, also for starts on its closed solution. */
stf_apart *stf_subject_apart(stf_subject *subject, const char *method, const char *start);
/* <x_m, g> for all m into value[n]; accuracy (a bound seen, 0 for closed formulas) and how it was
 * found, in words. */
int stf_subject_pair(stf_subject *subject, sunrealtype *value, sunrealtype *accuracy, char *how,
                     size_t room);
/* The rounding level of x(t+) and of impulses c_i / t1^(i + 1) at 0 and at breaks found. */
sunrealtype stf_subject_rounding(const stf_subject *subject);
/* The smooth part at t[0] = 0 (right limit), t[1], ... ascending: rows of n. */
int stf_subject_smooth(stf_subject *subject, size_t count, const sunrealtype *t,
                       sunrealtype *x);
/* The same from break `i` - 1 on, where the jump is known, to times before break i; i = 0: from 0. */
int stf_subject_segment(stf_subject *subject, size_t i, size_t count, const sunrealtype *t,
                        sunrealtype *x);
/* A smooth solution at `t`, before 0, that has there the slow part of x(0+): one row. */
int stf_subject_before(stf_subject *subject, sunrealtype t, sunrealtype *x);
/* The smooth solution from the first row at t[0] on: the others. */
int stf_subject_follow(stf_subject *subject, size_t count, const sunrealtype *t,
                       sunrealtype *x);
/* radau:s=5 through given times; `take` is told of every one but the first. */
int stf_subject_carry(stf_subject *subject, const sunrealtype *x0, size_t count,
                      const sunrealtype *mesh,
                      int (*take)(steif_solver *solver, sunrealtype t, N_Vector x, void *user),
                      void *user);

#endif
