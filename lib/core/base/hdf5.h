/* hdf5.h: the libhdf5 of the system, which is loaded when one is asked for: steif does not depend on it. Users declare the
 * functions that they call as those of HDF5 1.10 and later, where hid_t has 64 bits (HDF5 Reference Manual).
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_HDF5_H
#define STF_HDF5_H

#include "base.h"
#include <stdint.h>

typedef int64_t stf_h5; /* hid_t */

/* STEIF_UNSUPPORTED: none is there, or an older one; `instead` ends the sentence: what may be done without it. */
int stf_hdf5_load(steif_context *ctx, const char *instead, void **handle);
/* The function or variable of this name into the pointer at `to`; false: there is none. */
bool stf_hdf5_take(void *handle, const char *name, void *to);

#endif
