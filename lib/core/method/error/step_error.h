/* step_error.h: what methods make of the errors of their steps: how large an estimate may be, alone and by what has
 * become of the errors before it, and what in an estimate is no error.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_STEP_ERROR_H
#define STF_STEP_ERROR_H

#include "method.h"

/* What an estimate of order q may be, in units of the tolerance, so that the errors of all steps of a
 * method of order p add to a multiple of rtol where y is smooth, est^(p/(q+1)) ~ rtol, but above
 * rounding, relative to y. At rtol = 1e-3 the multiple is small enough for orbits that magnify errors a thousand
 * times before they close. */
sunrealtype stf_share(const stf_step *s, int q, int p, sunrealtype rounding);
/* Newton's tolerance for s->control.tolerance, unless the caller has given his: what is left of the
 * iteration must not be seen in the estimate. */
void stf_share_newton(stf_step *s, sunrealtype rounding);
/* Both for a method of one order, which does not take what is below `least` times rounding: 0.1 where errors may be
 * forgotten, 0.5 where they add. */
int stf_share_open(stf_step *s, const char *name, int q, int p, sunrealtype least);

/* What rounding of algebraic equations leaves in algebraic unknowns, in tolerances; 0 without factors, and where
 * matrices are operators. Three vectors of scratch. */
int stf_algebraic_noise(stf_step *s, N_Vector work, N_Vector other, N_Vector third,
                        sunrealtype *noise);

/* out = E v; v = (sigma E - A)^{-1} v of an attempt with step h. */
typedef int stf_by_E(stf_step *s, N_Vector v, N_Vector out);
typedef int stf_by_shift(stf_step *s, sunrealtype h, N_Vector v);
/* By the pencil and its first factors, whose shift is that of the attempt. */
stf_by_E stf_product_by_pencil;
stf_by_shift stf_solve_by_pencil;

/* So many refusals have not cured what is rounding, or no smooth solution. */
enum { STF_STUBBORN = 2 };

/* -- algebraic_equations.c -- */

/* A vector of no particular direction, of components between 1 and 2. Where E times it is 0, a row is algebraic. */
void stf_row_probe(const stf_space *space, N_Vector v);
/* r with its algebraic rows only, or with the others only; Ep: E times a probe. */
void stf_keep_rows(const stf_space *space, N_Vector Ep, bool algebraic, N_Vector r);

/* Once steps were rejected again and again, what a residual at y has in algebraic equations of index 1 may be all there
 * is, at every step size; and it is no error of the step, whose end does not depend on it. */
bool stf_residuals_remain(const stf_step *s);
/* `residual` without it, where that is so. probe, Ep: room. */
int stf_without_residuals(stf_step *s, N_Vector probe, N_Vector Ep, N_Vector residual);

/* Between stages of a step that has grown a diode may have conducted: there algebraic equations of index 1 hold to the
 * accuracy of what is between, and never in a thirtieth of the size of the solution. */
typedef struct stf_look {
  const sunrealtype *x; /* where, in parts of the step */
  int points;
  int (*inside)(stf_step *s, sunrealtype x,
                N_Vector y); /* the solution of this attempt there */
  stf_by_E *product;         /* NULL: by the pencil */
  stf_by_shift *solve;
  N_Vector y, Ep, off; /* room */
} stf_look;
/* Looked at where h is so much more than the last step; what the solution is off becomes the error of the step where it
 * is as large as that. */
int stf_look_between(stf_step *s, sunrealtype h, const stf_look *look);
/* x half-way from node k - 1, or the start, to node k; how many. */
int stf_between_nodes(const steif_table *T, sunrealtype *x);

/* The errors of all steps so far as the problem carries them on (carried_error.c). */
typedef struct stf_carried {
  N_Vector e, work, other; /* e NULL: not followed */
  long steps;
  bool exact;             /* all that e has lived through is carried on, and trusted */
  bool dear;              /* solves are: e is carried on as rarely as may be */
  bool always;            /* the share of a step is that of all remembered from the start */
  sunrealtype time;       /* since e was carried on */
  sunrealtype growth;     /* of e, 1 where what it had grown is gone */
  sunrealtype remembered; /* steps, growth taken out */
  sunrealtype size,
    sum;            /* of e in its largest component; of the errors remembered; in tolerances */
  sunrealtype peak; /* largest size so far */
  sunrealtype whole;      /* the solution itself, in tolerances */
  sunrealtype all, least; /* estimates below `least` tolerances are rounding */
  sunrealtype loose; /* what an estimate may be, for all that is remembered; 0: not known */
  sunrealtype most;  /* of `loose` */
  sunrealtype goal;  /* what e may come to where it shrinks; 0: no share of that */
  sunrealtype seen, added,
    rise; /* norms of e carried on, of estimates since; log of its growth */
  int failure;
  int first;         /* steps before anything is known; 0: as many as multistep methods take */
  stf_by_E *product; /* NULL: by the pencil, ... */
  stf_by_shift *solve; /* ... as is this */
  bool rises;          /* e has grown by much at some time */
  bool forgets;        /* the errors of few steps were remembered at some time */
  bool jumped; /* at an event, e as well, by the derivative of what is done there: not known */
} stf_carried;
/* Estimates below `rounding`, relative to y, are noise; `all`: what those remembered may come to, in
 * tolerances. `exact`: at twice the cost. */
int stf_carried_open(stf_step *s, sunrealtype rounding, sunrealtype all, bool exact,
                     stf_carried *c);
/* The same for methods of one step, of which `first` steps tell enough; most: what any estimate may be. */
int stf_carried_by_one_step(stf_step *s, int first, sunrealtype most, stf_carried *c);
/* After a step of this error, with the shift sigma in the factors. */
void stf_carried_add(stf_step *s, stf_carried *c, sunrealtype sigma, N_Vector error,
                     sunrealtype norm);
/* What Newton's iteration leaves has the same sign in many steps, and adds up over those remembered: its tolerance. */
void stf_carried_newton(stf_step *s, const stf_carried *c);
/* At an attempt: where shorter steps do not help, rounding is larger than thought. STEIF_CALLBACK: a
 * callback stopped the solves after the last step. */
int stf_carried_retry(const stf_step *s, stf_carried *c);
/* What an estimate may be, of which `wanted` would do if the errors of all steps added. */
sunrealtype stf_carried_share(const stf_carried *c, sunrealtype wanted);
/* What has become of the errors of all steps, where e is exact or rounding does not let them be as wanted. */
void stf_carried_tell(const stf_carried *c, sunrealtype wanted, stf_control *control);

/* How far the estimate of collocation, of order s, may exceed the tolerance because the method has
 * order p. On y' = lambda y, omega = h |lambda|, the error is the estimate times
 * s! / (gamma_0 (p + 1)!) omega^(p-s); omega is taken from the divided differences of order s
 * through (0, 0) and all stages and of order s - 1 through the stages, whose ratio is omega / s.
 * Small oscillations that a step does not resolve let the differences stay as large as they were
 * below: then the error is as large as the estimate, unless they are
 * below the tolerance themselves. Never more than a bound
 * that makes the sum of the errors of all steps proportional to rtol where y is smooth, est^(p/(s+1))
 * ~ rtol, and at rtol = 1e-3 is half of the 0.1 rtol^((s+1)/(2s)) of Hairer and Wanner (II, IV.8), less
 * below s = 5: the more steps, the more errors add. A tenth of that for methods of four stages and more that do not
 * damp, which add up what they make: orego by gauss:s=5 at 1e-11 is 66 tolerances off without, 2 with it, in as
 * many steps. */
typedef struct stf_estimate {
  int s, beyond;             /* beyond: p - s */
  sunrealtype gain, loosest; /* s! / (gamma_0 (p + 1)!) */
  sunrealtype most;     /* where errors are forgotten: that of Hairer and Wanner (II, IV.8) */
  sunrealtype weight;   /* gamma_0 */
  sunrealtype legendre; /* size of x^s + ... orthogonal to lower powers on [0, 1] */
  sunrealtype top[STEIF_STAGES], below[STEIF_STAGES]; /* weights of Z_j */
  sunrealtype lower[STEIF_STAGES];                    /* and of the difference of order s - 2 */
} stf_estimate;
void stf_estimate_open(stf_estimate *e, const steif_table *T, const stf_transform *transform,
                       sunrealtype rtol);
/* s->control.tolerance and s->control.order of this attempt, from the norms of the two differences. */
void stf_estimate_set(stf_step *s, const stf_estimate *e, sunrealtype top, sunrealtype below);
/* s->control.between of this attempt. Filters take from the estimate what stiff and algebraic components do between
 * the ends, which a long step follows as little as its polynomial does. Let a, b, c be the last three terms of that,
 * orthogonal to lower powers, in tolerances: the next one is r max(c, r b), r = sqrt(c/a), which sin(omega t + phi) has
 * for every phi; of two terms r = c/b. Components of index 1 only.
 * Here of collocation, from its differences of orders s - 2 to s. */
void stf_estimate_between(stf_step *s, const stf_estimate *e, sunrealtype lower,
                          sunrealtype below, sunrealtype top);
/* Of a polynomial on [0, 1] of degree k > 1 from its last three coefficients (k - 2, not looked at where k = 2, k - 1
 * and k), which are spent. */
void stf_between_powers(stf_step *s, int k, N_Vector const *coefficient);
/* Of a Taylor polynomial of degree k on [-1, 0], which is worst at -1, where terms are as large as coefficients. */
void stf_between_taylor(stf_step *s, int k, N_Vector const *coefficient);
/* Is the difference of order s above what Newton's iteration leaves? */
bool stf_estimate_sees(const stf_estimate *e, sunrealtype top);
/* Of the error to the estimate, from the two differences; 1 where it is no less. */
sunrealtype stf_estimate_ratio(const stf_estimate *e, sunrealtype top, sunrealtype below);
/* A larger s->control.tolerance, up to e->most, where the error is `ratio` times the estimate and may be `share` tolerances. */
void stf_estimate_share(stf_step *s, const stf_estimate *e, sunrealtype ratio,
                        sunrealtype share);

/* The same where the estimate is all that is known: no higher order. */
void stf_estimate_none(stf_step *s, const stf_estimate *e);

/* Stiff components have no more than the order of the estimate either: on y' = -lambda (y - g(t)) + g'(t), z =
 * h lambda, the error of methods whose last stage is the end is the estimate times s where z is large, and
 * below s (gamma_0 z / (1 + gamma_0 z))^(s-1) everywhere. The estimate is made larger where that, by as many
 * more solves as it takes to see, is above the tolerance. product: out = E v; NULL: by the pencil; filter: that
 * of the estimate. */
int stf_estimate_stiff(stf_step *s, const stf_estimate *e, sunrealtype h, stf_by_E *product,
                       stf_by_shift *filter, N_Vector rest, N_Vector work);
/* The estimate is made larger where the error of stiff components, `size` tolerances, is above three; not after many
 * refusals. By how much: 1 where it is not. */
sunrealtype stf_raise_stiff(stf_step *s, sunrealtype size);

/* Velocities and multipliers of index 3 have no more than the order of the estimate: it is made
 * larger for them, as if the tolerance had not been raised, but above rounding; not in the first steps,
 * whose start they forget, nor where many shorter steps do not help. */
void stf_estimate_levels(stf_step *s);
/* v without components of higher index, whose errors the superconvergence of the others does not need. */
void stf_of_index_one(const stf_step *s, N_Vector v);
/* Is a large estimate to be filtered once more? That removes what a stiff component not on its slow
 * manifold contributes at every step size: at the start and after a refusal, but not, without
 * need, the errors of velocities at index 3. */
bool stf_filters_twice(const stf_step *s);

/* Error test of methods that do not damp, at the end of a step: what the second filter took from the
 * first estimate is the deviation of stiff and algebraic components, which later steps will return
 * with the same size; it must be small against the tolerance itself. Where shorter steps do not make it small, Newton
 * diverged in this step, or, blended, those before have left most of it, it is taken from s->next. s->error is the
 * estimate after the filters, `first` the sum of those before it, `times` as large in components that are damped, and is
 * overwritten. */
int stf_test_undamped(stf_step *s, N_Vector first, sunrealtype times, bool diverged,
                      bool blended);
/* How many estimates are taken off before the one that counts: 1, more where refusals do not help, since
 * each leaves a part of a deviation that a nonlinear f or an old matrix keeps. */
int stf_filter_rounds(const stf_step *s);

/* Refuses chosen steps on problems of index 3: methods whose stages have order 1 or
 * that do not damp do not find the multipliers there, and no estimate of theirs would tell. */
int stf_check_index(stf_step *s, const char *name);
/* What Newton's iteration of a method of order p may leave of velocities and multipliers of index 3, which
 * h^(index - 1) makes small in its norm: N ~ rtol^(-1/p) steps add it up to N^2 of it in positions. */
sunrealtype stf_multipliers_known(sunrealtype rtol, int p);
/* Sets Newton's tolerance of collocation with chosen steps; p 0: no finer for finer rtol. */
void stf_stages_known(stf_step *s, int p);

/* Are absolute tolerances above so many times the rounding of the largest component of y? Where they
 * are below, small components are differences of large ones. */
bool stf_above_rounding(const steif_problem *p, const steif_options *o, const sunrealtype *y,
                        sunrealtype times);

/* step_image.c. */
void stf_carried_keep(stf_carried *c, stf_image *m);

#endif
