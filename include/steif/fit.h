/* steif/fit.h: parameters of a problem from measurements, by weighted least squares.
 *
 *   steif_measurements data;
 *   steif_fit fit;
 *   int code = steif_measurements_read(ctx, &problem, "rober.csv", 0, 0, NULL, &data);
 *   if (!code) code = steif_fit_find(ctx, &problem, "radau:s=3", &data, NULL, &fit);
 *   if (!code) printf("%g +- %g\n", fit.p[0], fit.sd[0]);
 *   steif_fit_free(ctx, &fit);
 *   steif_measurements_free(ctx, &data);
 *
 * Sought are the p that make chi2 = sum_j r_j^2 smallest, r_j = (y_{i(j)}(t_j; p) - d_j) / sd_j, by the method
 * of Levenberg and Marquardt in theta = log p where all of these p, and their bounds, are positive, else in
 * theta = p / scale. The derivatives are forward sensitivities of the run that gave the residuals (sensitivity.h,
 * which says what methods and problems are served); measurements lie on its dense output, and no step ends
 * at them. Start values are parameters where the start depends on p: `param a = 1` and `state x = a` of a model.
 *
 * Each descent goes on until chi2, or p, would change by less than rtol of the runs, relative. A step that
 * makes the run fail is rejected, and its sentence kept. Bounds are kept by projection: a parameter that a step
 * takes to its bound stays there until the slope of chi2 leads inward. No minimum is an end where chi2 has no slope along
 * a parameter, by runs nearby, and is less beside it; where parameters went to 0 or infinity, and chi2 hardly
 * changes; where runs fail beyond; and where J promises a fall of chi2 that is worth half a standard deviation, and no
 * step brings it (J is wrong, or chi2 has a jump or a kink, as where an event meets the time of a measurement).
 *
 * With J = dr/dtheta, the covariance of theta is C = (J^T J)^-1 where the standard deviations of the measurements are
 * given: they are taken for known, and 95 % intervals are theta -+ 1.96 sqrt(C_ii), by the normal distribution. Else C is
 * that times chi2 / dof, and the quantile of Student's t with dof degrees of freedom takes the place of 1.96. The
 * covariance of p is that of theta times dp/dtheta, to first order. Singular values of J below 1e-8 of the largest belong to directions of theta that
 * the measurements do not determine: parameters with a part in them have the standard deviation infinity.
 *
 * Sources: J. J. More, The Levenberg-Marquardt algorithm, in LNM 630 (1978) 105-116, as MINPACK's lmder (through
 * cminpack, found when steif is built); G. A. F. Seber and C. J. Wild, Nonlinear Regression (1989) 2.1.2, 5.1;
 * known and estimated variances: W. H. Press et al., Numerical Recipes, 3rd ed. (2007) 15.6;
 * points of several starts: J. H. Halton, Numer. Math. 2 (1960) 84-90.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_FIT_H
#define STEIF_FIT_H

#include <steif/parameters.h>
#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Measurement j is value[j] of the unknown y_i, i = component[j] from 0, at t[j], in any order; the same
 * component and time may occur again. i = n + k: output k of a model. */
typedef struct steif_measurements {
  size_t count;
  sunrealtype *t, *value;
  sunrealtype *sd; /* standard deviations, > 0; NULL: the same for all, not known */
  sunindextype *component;
  void *reserved[4];
} steif_measurements;

/* A CSV file: the first line is t and the names of unknowns (y1, y2, ... where the problem has no names) or outputs, in
 * any order; sd_NAME beside NAME is the standard deviation of each of its values. An empty cell, or NA, is
 * skipped. Times ascend and lie between t0 and t1 (0: the problem's, if it has one); each occurs once unless
 * `repeated`. # begins a comment. sd: sd_count standard deviations, one for all columns, or one for each in
 * their order; NULL: those of the file, of the model (`data`), or none. path NULL: what the model names. STEIF_BAD_INPUT, STEIF_UNKNOWN_NAME, STEIF_NOT_FINITE, STEIF_IO with
 * file, line and column. Free it with the context it was read with. */
STEIF_EXPORT int steif_measurements_read(steif_context *ctx, const steif_problem *problem,
                                         const char *path, sunrealtype t1, int repeated,
                                         int sd_count, const sunrealtype *sd,
                                         steif_measurements *data);
STEIF_EXPORT void steif_measurements_free(steif_context *ctx, steif_measurements *data);

enum steif_fit_scale { STEIF_FIT_AUTO, STEIF_FIT_LOG, STEIF_FIT_LINEAR };

/* {0} or NULL: all parameters, from the values they have, once. */
typedef struct steif_fit_options {
  const steif_options *run;   /* of the runs; NULL: rtol 1e-8 */
  int count;                  /* parameters that are fitted: */
  const int *parameter;       /* numbers from 0; NULL: all, count is 0 or that of all */
  const sunrealtype *start;   /* count values to begin with; NULL: those of the problem */
  const sunrealtype *low;     /* count bounds; NULL or -infinity: none */
  const sunrealtype *high;    /* NULL or infinity: none */
  enum steif_fit_scale scale; /* STEIF_FIT_AUTO: log where start and bounds are positive */
  /* Descents, 0: 1; the second begins at a point of Halton's sequence between the bounds; where there are none,
   * from start/10 to 10 start (linear: start -+ 10 scale). */
  int starts;
  int evaluations; /* most runs of a descent; 0: 200 */
  int reserved_int[5];
  void *reserved[8];
} steif_fit_options;

/* Matrices are count x count by rows. */
typedef struct steif_fit {
  int count, log;          /* log: 1, theta = log p */
  sunrealtype *p, *sd;     /* sd of p, to first order: sqrt of the diagonal of its covariance */
  sunrealtype *low, *high; /* 95 % intervals; those of log p, exp of it, where that is theta */
  int *bound;              /* -1, 1: at the bound low, high, and taken as known there; 0 */
  /* Of p; of parameters with a part in what the data do not determine, and of all where neither sd of the data nor a
   * degree of freedom is there, infinity, NaN beside the diagonal. */
  sunrealtype *covariance;
  sunrealtype *correlation;      /* of p, which is that of theta; of what is determined */
  sunrealtype *covariance_theta; /* of log p, or of p / scale; of what is determined */
  sunrealtype *singular; /* of J, descending; the last ones, 0, those of parameters at bounds */
  sunrealtype *direction; /* row k: the unit vector in theta of singular[k] */
  int undetermined; /* how many directions, the last but those, the data do not determine */
  sunrealtype chi2;
  long dof;             /* measurements less what they determine: the rank of J */
  int known;            /* 1: standard deviations of the measurements were given */
  sunrealtype quantile; /* of the intervals: normal, or Student's; infinity: there are none */
  sunrealtype
    probability; /* of a chi2 as large or larger, where they were given and dof > 0; else NaN */
  size_t residuals;
  sunrealtype *residual;         /* r_j, in the order of the data */
  int starts, best;              /* best: which descent, from 0 */
  sunrealtype *chi2_of;          /* of each; infinity: its first run failed */
  long runs, failed, iterations; /* of all descents; failed runs; of the best descent */
  /* 1: the best descent was ended by options.evaluations; 2: where there is no minimum, as the message says, and sd and
   * intervals are not those of one; STEIF_STOPPED, STEIF_TIME_LIMIT: the search by options.run */
  int exhausted;
  char message[1400]; /* one sentence or more: what was found, and what to doubt */
  char failure[500];  /* of the last run that failed; "" */
  char used[200];     /* the method of the best run, steif_method_used: what "auto" took */
  void *reserved[8];
} steif_fit;

/* The parameters of the problem have the values they had when it returns. STEIF_BAD_INPUT: fewer measurements than
 * parameters, a start outside the bounds and the like; STEIF_NO_CONVERGENCE: options.evaluations were too few, or the best
 * descent ended where there is no minimum; fit holds the best so far; STEIF_STOPPED, STEIF_TIME_LIMIT: the search was
 * ended by options.run, and fit holds the best run it had made, if there was one (else p is NULL); STEIF_UNSUPPORTED:
 * steif was built without cminpack, or the method carries no sensitivities; codes of the run where the first of every
 * descent failed. */
STEIF_EXPORT int steif_fit_find(steif_context *ctx, steif_problem *problem, const char *method,
                                const steif_measurements *data,
                                const steif_fit_options *options, steif_fit *fit);
STEIF_EXPORT void steif_fit_free(steif_context *ctx, steif_fit *fit);

/* The t with P(|T| <= t) = probability, in (0, 1), T of Student's distribution with dof >= 1 degrees of freedom, to
 * 1e-9 of itself. */
STEIF_EXPORT int steif_student(steif_context *ctx, sunrealtype probability, long dof,
                               sunrealtype *t);
/* The probability of a value of at least chi2 >= 0 by the chi-square distribution with dof >= 1 degrees of freedom, to
 * 1e-10 of itself up to a million of them. */
STEIF_EXPORT int steif_chi_square(steif_context *ctx, sunrealtype chi2, long dof,
                                  sunrealtype *probability);

#ifdef __cplusplus
}
#endif
#endif
