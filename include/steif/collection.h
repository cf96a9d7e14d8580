/* steif/collection.h: the published problems that come with the library.
 *
 * A problem is named by a spec: "rober", "vdpol:mu=30", "heat:n=400", "jordan:k=4". Each carries
 * its form, analytic Jacobian, component index, reference end values and citation.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_COLLECTION_H
#define STEIF_COLLECTION_H

#include <steif/problem.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Name of problem i, as a spec with the default parameters; NULL past the end. */
STEIF_EXPORT const char *steif_problem_name(size_t i);

/* What stands at the head of the file of problem i: equations, parameters, sources; lines end in \n. */
STEIF_EXPORT const char *steif_problem_text(size_t i);

/* Fill *problem from a spec; steif_problem_clear releases its memory and zeroes it. */
STEIF_EXPORT int steif_problem_find(steif_context *ctx, const char *spec,
                                    steif_problem *problem);
STEIF_EXPORT void steif_problem_clear(steif_context *ctx, steif_problem *problem);

/* The problem `like`, of steif_problem_find or steif_model_parse, with other values of parameters, as a problem
 * of its own for steif_problem_clear: `like` stays as it is, may be of another context, and what comes out
 * depends on these values only. Of a model, parameters of its text, all at once; else numbers of
 * problem.parameters, or parameters of the spec, "mu" of vdpol:mu=30. Values of problem.parameters leave neither
 * reference nor exact solution: these belong to the published ones. On failure *out is zero;
 * STEIF_UNKNOWN_NAME: the problem has no such parameter; STEIF_BAD_INPUT: values that are out of range, and names that
 * exclude each other, as mu and eps of vdpol. Of a model the start that fulfils the equations is found for these
 * values, with the bits of a problem that is read with them. */
STEIF_EXPORT int steif_problem_vary(steif_context *ctx, const steif_problem *like, int count,
                                    const char *const *name, const sunrealtype *value,
                                    steif_problem *out);

/* Digits of y against the problem's reference or exact solution at time t:
 *   scd   = -log10 max_i |y_i - ref_i| / |ref_i|                 (components with ref_i = 0 left out)
 *   mescd = -log10 max_i |y_i - ref_i| / (atol/rtol + |ref_i|)
 * An error below the unit round-off counts as the unit round-off (15.95 digits); a component that
 * is not finite gives -infinity; scd is NaN when every ref_i is 0. STEIF_UNSUPPORTED, and both
 * NaN, when nothing is known at t. */
STEIF_EXPORT int steif_problem_digits(steif_context *ctx, const steif_problem *problem,
                                      sunrealtype t, N_Vector y, sunrealtype atol_over_rtol,
                                      sunrealtype *scd, sunrealtype *mescd);

#ifdef __cplusplus
}
#endif
#endif
