/* slope_length.h: over which length a central difference by a parameter can be trusted.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SLOPE_LENGTH_H
#define STF_SLOPE_LENGTH_H

#include "space.h"

/* Quotients of one function of p with values in host arrays. */
typedef struct stf_quotients {
  sunrealtype length, least; /* the one that is tried first; over shorter ones p hardly moves */
  /* out = the quotient over p -+ length; returns as callbacks do. */
  int (*quotient)(sunrealtype length, N_Vector out, void *user);
  /* bar_i = how far rounding moves the function; scratch: `now`. */
  int (*noise)(N_Vector bar, void *user);
  void *user;
  N_Vector now, half, bar; /* scratch */
} stf_quotients;

typedef struct stf_trusted {
  sunrealtype length; /* 0: there is none */
  /* where the quotients over q->length and half of it disagree the most, and what they are */
  sunindextype component;
  sunrealtype quotient[2];
} stf_trusted;

/* `first` is the quotient over q->length. */
int stf_trust(const stf_quotients *q, N_Vector first, stf_trusted *found);

#endif
