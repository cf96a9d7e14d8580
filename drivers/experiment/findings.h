/* findings.h: known experiments, run again, each number beside its reference.
 *
 *   steif_findings f;
 *   if (steif_experiment_run(ctx, "drift", &f) == STEIF_OK)
 *     for (size_t i = 0; i < f.count; i++) ... f.finding[i].value, f.finding[i].reference ...
 *   steif_findings_clear(ctx, &f);
 *
 * An experiment is a file of drivers/experiment/shelf: methods, steps and references as data, run by the
 * functions of stability.h, energy.h and discrete.h. The references are those of the source named in
 * the file, recomputed independently; the tests go through all of them.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_EXPERIMENT_H
#define STEIF_EXPERIMENT_H

#include <steif/report.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_finding {
  const char *of;       /* method, scheme or system */
  sunrealtype h;        /* the step; NaN where there is none */
  const char *quantity; /* "error", "final drift", ... */
  sunrealtype value;
  sunrealtype reference; /* NaN: none is known */
  sunrealtype error;     /* |value - reference| / |reference|; absolute for a reference of 0 */
  int agrees;            /* 1: within the digits of the reference; 0: not; -1: no reference */
  sunrealtype order; /* log2 of this and the last error, for errors by halved steps; or NaN */
  /* Where the source prints another value: that, and ours when begun as the source seems to have
     begun; else NaN. */
  sunrealtype printed, imitated;
} steif_finding;

typedef struct steif_findings {
  const char *name, *about;
  size_t count, disagree; /* findings; those that do not agree */
  int printed;            /* 1: some findings have a printed value beside them */
  const steif_finding *finding;
  steif_plot plot;
  void *memory;
} steif_findings;

/* Experiment i of the shelf and what it is about; NULL past the end. */
const char *steif_experiment_name(size_t i, const char **about);
/* STEIF_UNKNOWN_NAME for one that does not exist. steif_findings_clear it. */
int steif_experiment_run(steif_context *ctx, const char *name, steif_findings *f);
void steif_findings_clear(steif_context *ctx, steif_findings *f);

#ifdef __cplusplus
}
#endif
#endif
