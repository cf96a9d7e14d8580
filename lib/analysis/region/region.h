/* region.h: the room of stability regions inside: the spectral radius of a method's step as a function.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_REGION_H
#define STF_REGION_H

#include "integrator.h"
#include <steif/region.h>

enum { STF_SCAN_PER_DECADE = 16 };

/* rho(M(z)) - 1 along rays and at points; the method is looked up and room for the matrix
 * and LAPACK is taken once. A failure
 * is kept in `code` and every later value is 0, so that loops need not ask. */
typedef struct stf_scan {
  steif_context *ctx;
  const char *name;
  steif_spec spec;
  const steif_method *method;
  steif_table *table;
  int r, code;
  bool star;         /* rho(M(z)) / |e^z| - 1 instead */
  sunrealtype *M;    /* r x r complex */
  sunrealtype *work; /* zgeev: eigenvalues, work, rwork */
} stf_scan;

int stf_scan_open(stf_scan *scan, steif_context *ctx, const char *method);
void stf_scan_close(stf_scan *scan);
/* The r eigenvalues of M(z), pairs (re, im) in scan->work. */
int stf_scan_eigenvalues(stf_scan *scan, sunrealtype re, sunrealtype im);
sunrealtype stf_scan_excess(stf_scan *scan, sunrealtype re, sunrealtype im);

#endif
