/* fixture.h: files in a folder of the tests' own, and short ways to ask a function.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef FIXTURE_H
#define FIXTURE_H

#include "base/failing.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <steif/forcing.h>
#include <steif/input.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* The path of a file of this name in the folder, valid until the fourth next call. */
const char *in_folder(const char *name);
/* Write it: text, or bytes. */
const char *put(const char *name, const char *text);
const char *put_bytes(const char *name, const void *bytes, size_t size);

/* Entry (i, j) from 0, of either storage; zero where nothing is stored. */
double at(SUNMatrix M, sunindextype i, sunindextype j);

/* Derivative d of component i (from 0) of f at t; NaN when the code is not 0. */
double ask(steif_context *ctx, steif_function *f, sunindextype n, sunindextype i, double t,
           int d);

/* The last message holds these words; says what it held otherwise. */
#define SAYS(ctx, words)                                                                       \
  do {                                                                                         \
    const int good_ = strstr(steif_message(ctx), (words)) != NULL;                             \
    if (!good_)                                                                                \
      printf("\n  %s:%d: expected \"%s\" in: %s", __FILE__, __LINE__, (words),                 \
             steif_message(ctx));                                                              \
    CU_ASSERT(good_);                                                                          \
  } while (0)

#endif
