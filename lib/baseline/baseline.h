/* baseline.h: what CVODE, IDA and ARKODE share here.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BASELINE_H
#define STF_BASELINE_H

#include "engine.h"

#endif
