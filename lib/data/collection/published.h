/* published.h: what the published test problems of the shelf share.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PUBLISHED_H
#define STF_PUBLISHED_H

#include "collection.h"
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

/* Source of the reference values: F. Mazzia, C. Magherini, Test Set for Initial Value Problem
 * Solvers, release 2.4, University of Bari and INdAM (2008); formerly CWI Amsterdam. */
#define IVP_TEST_SET "IVP Test Set, release 2.4 (Mazzia and Magherini 2008), problem "
#define HAIRER_WANNER "Hairer and Wanner, Solving Ordinary Differential Equations II (1996)"

#endif
