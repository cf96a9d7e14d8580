/* fixture.h: a model from a text, which is written into a file of a new folder, or of the examples.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef FIXTURE_H
#define FIXTURE_H

#include "folder.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <steif/data.h>
#include <steif/steif.h>
#include <string.h>
#include <unistd.h>

typedef struct fixture {
  steif_context *ctx;
  steif_problem p;
  char folder[200], path[300];
} fixture;

/* The text as m.steif, with `rest` after its path (":k=3" or ""). The code of opening it. */
int fixture_text(fixture *s, const char *text, const char *rest);
int fixture_example(fixture *s, const char *spec);
void fixture_close(fixture *s);
/* To t1; the unknowns there into y. */
int fixture_run(fixture *s, const char *method, double rtol, double *y);
/* The first unknown at the end of a model of at most eight, by four methods, twice each, at rtol 1e-9. */
void fixture_reaches(const char *text, double expected, double allowed);
/* S of the last unknown by the first `count` parameters at the end, as it is shown; false: not solved. Close to `exact`, in
 * parts of it? */
bool fixture_derivatives(fixture *s, const char *method, enum steif_storage storage,
                         double rtol, int count, sunrealtype *S);
void fixture_closely(const char *method, const sunrealtype *S, const sunrealtype *exact,
                     int count, double error);

#endif
