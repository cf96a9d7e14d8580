/* fitted.h: what `steif fit` is asked for and finds.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef FITTED_H
#define FITTED_H

#include "integration.h"

enum { FITTED = 64 };
struct fitted {
  steif_problem *problem;
  const char *method; /* as asked for; auto where none is */
  steif_options run;
  int count, parameter[FITTED];
  double start[FITTED], low[FITTED], high[FITTED];
  steif_measurements data;
  steif_fit fit;
  bool log;   /* the model says so */
  int status; /* of the search */
};

/* --parameters, --bounds, --data, --sd: exit codes after a sentence. */
int fitted_ask(struct call *call, struct fitted *a);
/* The fit, presented and drawn. */
int fitted_find(struct call *call, struct fitted *a);
int fitted_present(const struct call *call, const struct fitted *a);
/* --plot: measurements with their standard deviations, and the solution with the parameters found. */
int fitted_plot(const struct call *call, struct fitted *a);
/* The file of the measurements: of the command line, else of the model. */
const char *fitted_data(const struct call *call, const struct fitted *a);
/* Parameter i as its user calls it; `room` of STEIF_SPEC_WORD bytes. */
const char *fitted_name(const struct fitted *a, int i, char *room);

#endif
