/* ida_family.h: the engines ida and idas are one, by the functions of IDA that the library is linked with or by those
 * of IDAS, which has the same names and is loaded privately.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_IDA_FAMILY_H
#define STF_IDA_FAMILY_H

#include "baseline.h"
#include "private_library.h"

typedef struct stf_ida {
  stf_baseline base;
  void *memory;
  const struct stf_ida_calls *call; /* NULL when opened: those that are linked */
  const char *const *keys;          /* of the spec; NULL when opened: those of ida */
  int order, suppress, ic;          /* ic: 0 none, 1 YA_YDP_INIT, 2 Y_INIT */
  const char *id;                   /* of the spec, "E" when absent */
  sunrealtype newton;               /* coefficient of its convergence test; 0: its default */
} stf_ida;

/* The same functions of IDAS; they live in the pool of the run. */
const struct stf_ida_calls *stf_ida_load(stf_run *run, stf_library *library);

#endif
