/* model_file.h: what other rooms see of this one.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MODEL_FILE_H
#define STF_MODEL_FILE_H

#include "base.h"
#include <steif/problem.h>

/* The model of a file with parameters from a spec (NULL: none) as a problem;
 * close it in any case. */
int stf_model_open(steif_context *ctx, const char *path, const steif_spec *spec,
                   steif_problem *problem);
void stf_model_close(steif_context *ctx, steif_problem *problem);

/* Was the problem made from a text? */
bool stf_model_is(const steif_problem *problem);
/* The text of a problem with other values of parameters, as a problem of its own for steif_problem_clear. */
int stf_model_vary(steif_context *ctx, const steif_problem *problem, int count,
                   const char *const *name, const sunrealtype *value, steif_problem *out);
/* Its text; another one with the same values, whose last outputs are integrands, as a problem of its own. */
const char *stf_model_text(const steif_problem *problem);
int stf_model_rewrite(steif_context *ctx, const steif_problem *problem, const char *text,
                      int integrands, steif_problem *out);

#endif
