/* stability.h: the stability room inside: the spectral radius of a method's step as a function.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_STABILITY_H
#define STF_STABILITY_H

#include "method.h"
#include <steif/stability.h>

enum { STF_SCAN_PER_DECADE = 16 };

/* rho(M(z)) - 1 along rays and at points; the method is looked up and room for the matrix
 * and LAPACK is taken once. A failure
 * is kept in `code` and every later value is 0, so that loops need not ask. */
typedef struct stf_growth {
  steif_context *ctx;
  const char *name;
  steif_spec spec;
  const steif_method *method;
  steif_table *table;
  int r, code;
  bool star; /* rho(M(z)) / |e^z| - 1 instead */
  sunrealtype *M;    /* r x r complex */
  sunrealtype *work; /* zgeev: eigenvalues, work, rwork */
} stf_growth;

int stf_growth_open(stf_growth *growth, steif_context *ctx, const char *method);
void stf_growth_close(stf_growth *growth);
/* The r eigenvalues of M(z), pairs (re, im) in growth->work. */
int stf_growth_eigenvalues(stf_growth *growth, sunrealtype re, sunrealtype im);
sunrealtype stf_growth_at(stf_growth *growth, sunrealtype re, sunrealtype im);

#endif
