/* input.h: shared inside the room: the scan of Matrix Market files, variables of MATLAB files.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_INPUT_H
#define STF_INPUT_H

#include "base.h"
#include "text.h"
#include <steif/input.h>

/* ---- matrices -------------------------------------------------------------------------------- */

enum stf_symmetry { STF_GENERAL, STF_SYMMETRIC, STF_SKEW };
typedef struct stf_market {
  bool array, pattern, integer;
  enum stf_symmetry symmetry;
  sunindextype rows, columns, entries; /* entries: as stored in the file */
} stf_market;
/* Read all of the file once: header, sizes, syntax of each line, count of the entries. */
int stf_market_scan(steif_context *ctx, const char *path, FILE *file, stf_market *market);

/* Entry k of column j: row and value, for the storages of this room. */
sunindextype stf_input_column(SUNMatrix M, sunindextype j);
void stf_input_entry(SUNMatrix M, sunindextype j, sunindextype k, sunindextype *row,
                     sunrealtype *value);
sunindextype stf_input_rows(SUNMatrix M);
sunindextype stf_input_columns(SUNMatrix M);
/* Dense or compressed by columns, finite; `name` for the sentence. */
int stf_input_check(steif_context *ctx, SUNMatrix M, const char *name);

/* Refuse a matrix of a file that has not so many rows and columns; why: "the size of E". */
int stf_input_sized(steif_context *ctx, const char *path, const char *name, SUNMatrix M,
                    sunindextype rows, sunindextype columns, const char *why);
/* A variable of a MATLAB file that need not be there; a failure only when it is and cannot be
 * read. */
int stf_input_variable(steif_context *ctx, const char *path, const char *name, SUNMatrix *M);
/* A failure when a .mat file is not whole, or its variables claim more entries than it can have. */
int stf_mat_check(steif_context *ctx, const char *path);
/* mat_hdf5.c: does a file begin as HDF5 does; a matrix of one, as steif_matrix_read_mat has it. */
bool stf_hdf5_is(const char *path);
SUNMatrix stf_hdf5_matrix(steif_context *ctx, const char *path, const char *name, int *found);
/* B of f = B u in the rows of E, of a .mat file; *B NULL where there is none. */
int stf_input_read(steif_context *ctx, const char *path, SUNMatrix *B);
/* The texts of a cell array or the rows of a character array, without blanks at their ends, in the
 * pool; *text NULL when the file has no such variable. */
int stf_input_texts(steif_context *ctx, stf_pool *pool, const char *path, const char *name,
                    size_t *count, const char ***text);

#endif
