/* own_rows.h: own rows of c E - A over ranks, with the exchange that products need, and solvers on them.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_MPI_OWN_ROWS_H
#define STEIF_MPI_OWN_ROWS_H

#include <steif/extension.h>
#include <steif/mpi.h>
#include <stdbool.h>

#define MPI_TRY(call)                                                                          \
  do {                                                                                         \
    const int mpi_code_ = (call);                                                              \
    if (mpi_code_) return mpi_code_;                                                           \
  } while (0)

/* Who owns what. */
typedef struct owners {
  MPI_Comm comm; /* a duplicate */
  int rank, size;
  sunindextype n, rows, first; /* first own row */
  sunindextype *start;         /* size + 1: first rows of all ranks, and n */
} owners;

/* Entries of other ranks that own rows refer to. */
typedef struct halo {
  sunindextype count;           /* of them, ... */
  sunindextype *column;         /* ... ascending */
  int *get, *get_at;            /* size: entries from each rank, and where they begin */
  int *give, *give_at, *source; /* entries for each rank; source: own rows, in that order */
  sunrealtype *out, *in;        /* two numbers for each entry, both halves of a pair */
  MPI_Request *request;         /* 2 size */
} halo;

/* Entries of the union of the patterns of E and A, rows ascending in columns. */
typedef struct row_differences row_differences;
typedef struct rows {
  steif_context *ctx;
  N_Vector like;
  owners own;
  halo halo;
  SUNMatrix E, A;
  bool identity;                                       /* E = I */
  sunindextype *seen_pointer, *seen_column, seen_room; /* of A, when the union was made */
  sunindextype entries, room;
  sunindextype *row_at, *column, *local, *at_A,
    *at_E;                      /* local: column among own rows, then in the halo */
  sunrealtype *e, *a;           /* values on the union */
  sunrealtype *one, *two;       /* own rows, then the halo */
  long revision;                /* of the pattern */
  row_differences *differences; /* values of A come from; NULL: from a callback */
  steif_mpi_stats stats;
} rows;

/* STEIF_OK, or a sentence: MPI is not ready. */
int own_rows_initialised(steif_context *ctx);
sunindextype rows_owner(const owners *o, sunindextype row);
int rows_open(rows *r, steif_context *ctx, const steif_problem *p, N_Vector like);
/* Values at (t, y, yp); E once. */
int rows_fill(rows *r, const steif_problem *p, sunrealtype t, N_Vector y, N_Vector yp);
/* Is there a union of patterns, with values? Not after a fill that failed while it was made. */
bool rows_united(const rows *r);
void rows_close(rows *r);

int halo_open(rows *r);
void halo_close(rows *r);
/* `width` 1 or 2 vectors of own rows into r->one, r->two, with the halo after them. */
void halo_exchange(rows *r, int width, const sunrealtype *const *x);
/* Values of the halo, after own rows in `from`, to their owners, where they are added, or the largest kept. */
void halo_return(rows *r, int width, bool largest, const sunrealtype *const *from,
                 sunrealtype *const *to);
/* out = (c E - A) x, or E x, or A x: w_e E + w_a A. */
void rows_product(rows *r, sunrealtype w_e, sunrealtype w_a, const sunrealtype *x,
                  sunrealtype *out);

/* A solver of c E - A. setup and solve return the same on all ranks. */
typedef struct back_end {
  const char *name;
  bool complex;
  int (*open)(rows *r, const steif_spec *spec, void **state);
  int (*changed)(void *state); /* values are new */
  int (*setup)(void *state, sunrealtype re, sunrealtype im);
  /* `count` columns; b and x: halves of each one after the other */
  int (*solve)(void *state, sunrealtype re, sunrealtype im, bool transposed, int count,
               const sunrealtype *const *b, sunrealtype *const *x);
  void (*close)(void *state);
} back_end;
extern const back_end back_end_amg, back_end_mumps;
/* STEIF_SINGULAR where the factors for this shift, which are there, are those of a matrix that is singular to
 * rounding. */
int mumps_sound(void *state, sunrealtype re, sunrealtype im);

#endif
