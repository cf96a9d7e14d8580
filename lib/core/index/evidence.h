/* evidence.h: the three tests of the index at several points, and the verdict drawn from them.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_EVIDENCE_H
#define STF_EVIDENCE_H

#include "curve.h"
#include "pryce.h"
#include "refined_factor.h"

/* -- test G ------------------------------------------------------------------------------ */

typedef struct stf_resolvent_growth {
  bool found, singular;     /* singular: at three shifts */
  sunrealtype rcond;        /* the best of the three */
  int index, *row, *column; /* n each: degrees of rows and columns of (sE - A)^{-1} */
} stf_resolvent_growth;
/* bound: numbers that the structure allows, where its Jacobian is regular; else NULL. */
int stf_resolvent_growth_find(stf_point *point, const stf_view *view, stf_factor *f,
                              const int *bound, stf_resolvent_growth *g);

/* -- test D ------------------------------------------------------------------------------ */

typedef struct stf_derivative_array {
  bool closed; /* y' is determined by `index` differentiations */
  bool stalls; /* it never will be: constraints stop, the null space keeps growing */
  int index;
  sunindextype freedom;
  sunrealtype gap, tau;
  int *determined, *derivatives; /* n each */
  int *prescribe;                /* n */
} stf_derivative_array;
int stf_derivative_array_open(stf_point *point, stf_derivative_array *a);
/* Over several tau between the time scales of the view; the one with the largest gap is
 * kept. */
int stf_derivative_array_scan(stf_point *point, const stf_view *view, sunrealtype t,
                              const sunrealtype *y, const sunrealtype *yp,
                              const sunrealtype *ypp, stf_derivative_array *a);
/* The whole array: rows (K+1) n, columns (K+2) n for z_0 .. z_{K+1}. */
void stf_derivative_array_fill(size_t n, int K, sunrealtype tau, const sunrealtype *E,
                               const sunrealtype *B, sunrealtype *D);

/* -- verdict ----------------------------------------------------------------------------- */

/* What the tests said at the points looked at; lists are of the point. */
enum { STF_POINTS = 4 };
typedef struct stf_evidence {
  stf_point *point;
  stf_view view;
  stf_factor *factor;
  stf_offsets offsets;
  int points, arrays; /* points looked at, and those where test D ran */
  struct {
    sunrealtype t, *y, *yp, *ypp, rcond;
    stf_resolvent_growth growth;
    stf_derivative_array array;
  } at[STF_POINTS];
} stf_evidence;
/* All tests at all points, and the verdict. Both are freed by the caller, whatever is returned. */
int stf_diagnose(stf_point *point, stf_evidence *evidence, steif_diagnosis *d);
void stf_evidence_free(stf_evidence *evidence);

/* Its steps: the point given and two beside it; */
int stf_evidence_points(stf_evidence *evidence);
/* test S, by the pattern of all of them; */
int stf_evidence_offsets(stf_evidence *evidence);
/* the system Jacobian and test G at each; */
int stf_evidence_growth(stf_evidence *evidence);
/* the system Jacobian alone at each; */
int stf_evidence_regular(stf_evidence *evidence);
/* one point more, on all constraints, if the structure is certified; */
int stf_evidence_consistent(stf_evidence *evidence);
/* test D, where the others do not agree or it is cheap. */
int stf_evidence_arrays(stf_evidence *evidence);
/* Test S alone, at the first points: what a start needs whose structure is certified; and is it certified at the start
 * that was found, too? */
int stf_evidence_structure(stf_evidence *evidence);
int stf_evidence_certified_at(stf_evidence *evidence, const steif_start *start,
                              bool *certified);
/* Is the system Jacobian regular at all points? */
bool stf_evidence_certified(const stf_evidence *evidence);
/* The reciprocal condition of the system Jacobian that certifies it at this point; the smallest of all points. */
sunrealtype stf_evidence_regular_rcond(const stf_point *point);
sunrealtype stf_evidence_rcond(const stf_evidence *evidence);
/* Is it, and has test G the index of the structure at all of them? */
bool stf_evidence_agrees(const stf_evidence *evidence);

/* What all tests together say. */
typedef struct stf_summary {
  const stf_evidence *e;
  int low[2], high[2];   /* smallest and largest index of test G and of test D */
  int found[2];          /* at how many points */
  bool stalls, singular; /* the array at all points; the pencil at all points */
  sunrealtype gap;
} stf_summary;
stf_summary stf_summarise(const stf_evidence *evidence);
/* Verdict, index, lists; then the sentence. */
void stf_verdict(const stf_summary *s, steif_diagnosis *d);
void stf_index_message(const stf_summary *s, steif_diagnosis *d);

#endif
