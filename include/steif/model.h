/* steif/model.h: problems written as text.
 *
 *     model "Robertson's reaction"
 *     param k1 = 0.04 {1/s}, k2 = 3e7, k3 = 1e4
 *     state y1 = 1, y2 = 0 scale 1e-6, y3 = 0      # = fixed, ~ a guess, nothing: computed
 *     y1' = -k1*y1 + k3*y2*y3
 *     y2' =  k1*y1 - k3*y2*y3 - k2*y2^2
 *     y3' =  k2*y2^2
 *     time 0 to 1e11 {s}
 *
 * steif_problem_find opens a file by its name, "rober.steif" or "rober.steif:k1=0.05", or by a path, "./rober";
 * "-" is standard input; a model is a steif_problem from then on, with exact Jacobian and pattern, names, events and consistent start values.
 * The order of lines is free. Equations may be implicit; the simplest form that all of them fit is deduced:
 * ode, descriptor (linear with constant coefficients), mass or implicit. Equations in `for` loops are
 * kept as loops. A model is data: nothing in it is executed but arithmetic.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_MODEL_H
#define STEIF_MODEL_H

#include <steif/parameters.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A model from a text; `name` stands before the line in sentences, and tables are looked for in its
 * folder. steif_problem_clear releases it. STEIF_BAD_INPUT or STEIF_UNKNOWN_NAME with "name:line:column:
 * what; remedy", up to 20 of them a line each. */
STEIF_EXPORT int steif_model_parse(steif_context *ctx, const char *text, const char *name,
                                   const steif_spec *parameters, steif_problem *problem);
/* Another value of a parameter, for the runs that begin afterwards: form, sizes and start values follow.
 * Solvers made of the problem before must be freed first. On failure the problem is as it was. */
STEIF_EXPORT int steif_model_set(steif_context *ctx, steif_problem *problem, const char *name,
                                 sunrealtype value);

/* Exact products with the derivatives of the residual F(t, y, y'; p) of the problem's form (parameters.h),
 * at a few times the cost of F; the parameters are those of problem.parameters. The first call makes
 * what is evaluated. STEIF_RETRY: not finite.
 *
 * out = F_y v + F_y' vp + F_p q; NULL: 0. J v of y' = f is -out with vp = q = NULL. */
STEIF_EXPORT int steif_model_tangent(steif_context *ctx, const steif_problem *problem,
                                     sunrealtype t, N_Vector y, N_Vector yp, N_Vector v,
                                     N_Vector vp, const sunrealtype *q, N_Vector out);
/* by_y = F_y^T w, by_yp = F_y'^T w, by_p[k] = w . F_p_k; NULL: not wanted. */
STEIF_EXPORT int steif_model_adjoint(steif_context *ctx, const steif_problem *problem,
                                     sunrealtype t, N_Vector y, N_Vector yp, N_Vector w,
                                     N_Vector by_y, N_Vector by_yp, sunrealtype *by_p);

/* Taylor coefficients: for y(t + s) = sum_k y_k s^k and y'(t + s) those of F(t + s, y, y') = sum_k F_k s^k,
 * k = 0 .. order <= 64. y: (order + 2) n numbers, y[k n + i] of unknown i; F: (order + 1) n. For y' = f
 * with y_{k+1} = 0, F_k = -f_k, from which y_{k+1} = f_k/(k+1): the series of the solution. At a kink or
 * jump in t they are those to the right. STEIF_RETRY: an operation has no series there. */
STEIF_EXPORT int steif_model_taylor(steif_context *ctx, const steif_problem *problem,
                                    sunrealtype t, int order, const sunrealtype *y,
                                    sunrealtype *F);

/* The model with its present parameters in C: a `const steif_problem model` with f, sparse or dense
 * Jacobians, loops as loops, names and parameters. It computes the same numbers bit for bit where the
 * compiler does not contract a*b + c (-std=c11 or -ffp-contract=off). What events change is kept in
 * static variables of the text: one run of it at a time. The text lives as long as the problem; NULL with the
 * message. */
STEIF_EXPORT const char *steif_model_c(steif_context *ctx, const steif_problem *problem);

/* f and the Jacobians of a model by compiled code from now on, loops at the speed of C by hand, the same
 * numbers bit for bit. `compiler` is one path or a name looked for in PATH, without arguments, NULL: "cc"; it
 * is started without a shell. `folder`, an absolute path, keeps what was compiled for later runs: made for
 * the user alone, and not used when other users may enter it; NULL: nothing is kept. Straight code of more
 * than 2000 operations stays with the interpreter. The code is compared with the interpreter at the start.
 * On failure, STEIF_UNSUPPORTED without a compiler, STEIF_IO for a folder or file, STEIF_NOT_CERTIFIED where values
 * differ, the problem is as before. After steif_model_set compile again: it is found in the folder. */
STEIF_EXPORT int steif_model_compile(steif_context *ctx, const steif_problem *problem,
                                     const char *compiler, const char *folder);

typedef struct steif_model_facts {
  int form;                           /* enum steif_form */
  const char *why;                    /* ... and what keeps it from a simpler one */
  sunindextype n, entries, entries_E; /* of dF/dy and dF/dy' */
  int parameters, equations,
    loops;               /* equations as written; rectangles of passes kept as loops */
  int relations, breaks; /* events of relations and times; declared times */
  long operations;       /* of f in one evaluation */
} steif_model_facts;

/* STEIF_BAD_INPUT: the problem was not made from a text. */
STEIF_EXPORT int steif_model_describe(steif_context *ctx, const steif_problem *problem,
                                      steif_model_facts *facts);
/* Name and value of parameter i, in the order of the text; NULL past the end. */
STEIF_EXPORT const char *steif_model_parameter(const steif_problem *problem, size_t i,
                                               sunrealtype *value);
/* Why a parameter of the text is not among problem.parameters: events assign it, it follows others, or is a whole
 * number. A part of a sentence in `room` of `size` characters; "": it is among them, or there is none of this name. */
STEIF_EXPORT void steif_model_obstacle(const steif_problem *problem, const char *name,
                                       size_t size, char *room);
/* What the text says of the start of unknown i: enum steif_attribute, STEIF_FIXED of '=', STEIF_GUESS of '~', STEIF_FREE
 * without a value; -1: no model, no such unknown. */
STEIF_EXPORT int steif_model_attribute(const steif_problem *problem, sunindextype i);
/* What reading did to the start: guesses ('~') that do not fulfil the equations, where they were and where they are,
 * beyond 1e-6 of their size, or why no consistent start was found; "": none moved, or no model. */
STEIF_EXPORT const char *steif_model_start(const steif_problem *problem);
/* What the model says of measurements: `data "FILE.csv", name = expression sd s, ...` and `fit k1, k2 log`. */
typedef struct steif_model_data {
  const char *path; /* of FILE.csv, beside the model; NULL: not told */
  int
    columns; /* their names and standard deviations, 0: not told. Columns of expressions are outputs. */
  const char *const *column;
  const sunrealtype *sd;
  int fitted, log; /* parameters that `fit` names; 1: `log` stands after them */
  void *reserved[4];
} steif_model_data;
/* All 0 where the problem says nothing of them, or is no model. */
STEIF_EXPORT int steif_model_data_find(steif_context *ctx, const steif_problem *problem,
                                       steif_model_data *data);
/* Name of the parameter that `fit` names as number i, from 0; NULL past the end. */
STEIF_EXPORT const char *steif_model_fitted(const steif_problem *problem, size_t i);
/* What an event of a model means, 0 .. events - 1, when its function rises (direction > 0) or falls: "true" or "false",
 * what the relation that its name shows has become; "rising" or "falling", the expression of its name, or the argument
 * of abs, ramp, sign and step in it, or the first less the second of min and max; "time", of `at` and `every`; "changes",
 * the part of floor, mod or of a table. NULL: no model, no such event. Names are in problem.event_list:
 * "x < -1 (line 7)", with i = 3 beside the line in loops, or what `stop` says. */
STEIF_EXPORT const char *steif_model_turn(const steif_problem *problem, int event,
                                          int direction);
/* The unit in braces after the declaration of a state, a parameter or an output, of an array for its elements ("u[3]"), or
 * after that of time ("t"), into `unit`, cut to `room` bytes; "": there is none, or no model. */
STEIF_EXPORT void steif_model_unit(const steif_problem *problem, const char *name, size_t room,
                                   char *unit);
/* Name of output i; NULL past the end. Their values at (t, y), as many as there are names. */
STEIF_EXPORT const char *steif_model_output(const steif_problem *problem, size_t i);
STEIF_EXPORT int steif_model_outputs(const steif_problem *problem, sunrealtype t, N_Vector y,
                                     sunrealtype *value);
/* Their derivatives along y' = v, p' = q, exact; NULL: 0. q: of problem.parameters. STEIF_RETRY: not finite. */
STEIF_EXPORT int steif_model_output_tangent(steif_context *ctx, const steif_problem *problem,
                                            sunrealtype t, N_Vector y, N_Vector v,
                                            const sunrealtype *q, sunrealtype *value);

/* The model with its present parameters and `count` integrands, expressions in its names, of t, unknowns and parameters.
 * Where one of them has a kink or a jump, the runs have an event or a break, of its own where the model has none there. For
 * steif_problem_clear. Sentences have places of the text, lines after its last one being those of the expressions.
 *
 *     steif_quadrature q = {.count = 1, .value = steif_model_integrand_values, .slope = steif_model_integrand_along};
 *     if (!steif_model_integrands(ctx, &model, 1, (const char *[]){"abs(x)"}, &problem)) problem.quadrature = &q; */
STEIF_EXPORT int steif_model_integrands(steif_context *ctx, const steif_problem *problem,
                                        int count, const char *const *expression,
                                        steif_problem *out);
/* All of them, and their derivatives along y' = dy, p_k' = 1; user: problem.user of such a problem. */
STEIF_EXPORT int steif_model_integrand_values(sunrealtype t, N_Vector y, sunrealtype *value,
                                              void *user);
STEIF_EXPORT int steif_model_integrand_along(sunrealtype t, N_Vector y, N_Vector dy, int k,
                                             sunrealtype *out, void *user);
/* dy = dg_i/dy and dp[k] = dg_i/dp_k of integrand i of such a problem, exact; dp NULL: not wanted. */
STEIF_EXPORT int steif_model_integrand_slopes(const steif_problem *problem, sunrealtype t,
                                              N_Vector y, int i, N_Vector dy, sunrealtype *dp);

#ifdef __cplusplus
}
#endif
#endif
