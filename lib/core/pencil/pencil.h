/* pencil.h: the pencil room inside: one frame, five back ends of a few functions each.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PENCIL_H
#define STF_PENCIL_H

#include "agree.h"
#include "image.h"
#include "space.h"
#include <nvector/nvector_serial.h>
#include <steif/pencil.h>

_Static_assert(sizeof(sunrealtype) == sizeof(double),
               "LAPACK and KLU work in double precision");

/* What one factorisation came to. The factorisations of one call run side by side and the context
 * is not thread safe: each leaves an outcome, and the frame makes sentences and sums afterwards. */
typedef struct stf_outcome {
  int code;            /* STEIF_OK, _SINGULAR, _NOT_FINITE, _NO_MEMORY or _BAD_INPUT */
  sunindextype column; /* where the pivot vanished, from 0; -1: not known */
  sunindextype rank;   /* the most that the pattern allows; 0: no statement */
  long factors, refactors, fallbacks, fill;
} stf_outcome;

/* A back end. It finds E, A, n and ctx in the frame and keeps its state behind p->state, of `size`
 * bytes, zeroed, allocated and released by the frame. `prepare` is called one slot after another
 * and may allocate and fail with a sentence; `factor` touches its slot and its outcome only, and
 * is called from several threads when n >= `crowd` (0: never). */
typedef int stf_columns_solve(steif_pencil *p, int slot, int nrhs, double *b, sunindextype ld);

typedef struct stf_backend {
  const char *name;
  size_t size;
  sunindextype crowd;
  bool matrices; /* E, A: vectors need host arrays */
  int (*open)(steif_pencil *p);
  int (*update)(steif_pencil *p); /* values (or pattern) changed */
  int (*prepare)(steif_pencil *p, int slot, steif_shift s);
  void (*factor)(steif_pencil *p, int slot, steif_shift s, stf_outcome *out);
  int (*solve)(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im);
  stf_columns_solve *columns; /* from several threads for complex slots; NULL: not so */
  /* With the transpose, complex slots with the conjugate transpose; NULL: not so. */
  int (*transposed)(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im);
  int (*product)(steif_pencil *p, char which, N_Vector x, N_Vector out);
  /* What a slot remembers: factors in use, pivots that serve again. Read into a slot not prepared yet. */
  void (*keep)(steif_pencil *p, int slot, stf_image *m);
  void (*close)(steif_pencil *p);
} stf_backend;

extern const stf_backend stf_backend_dense, stf_backend_band, stf_backend_sparse,
  stf_backend_krylov, stf_backend_incomplete;

/* What operators have cost: vectors preconditioned, products with A, sums over ranks. */
typedef struct stf_krylov_counts {
  long complex_solves, complex_iterations, applications, products, sums;
} stf_krylov_counts;

struct steif_pencil {
  steif_context *ctx;
  const stf_backend *backend;
  void *state;
  sunindextype n;
  SUNMatrix E, A; /* E NULL: identity; both NULL for operators */
  steif_operator op;
  steif_transposed turned; /* of operators; A NULL: not known */
  /* Operators: z[0] + i z[1] near (s E - A)^{-1} (r[0] + i r[1]), with op.user; NULL: op.precondition. */
  int (*precondition_pair)(steif_shift s, N_Vector *r, N_Vector *z, void *user);
  /* What op.prepare did last, at the point it did it: then it serves other products too while GMRES converges. */
  int (*prepare_again)(sunrealtype re, void *user);
  N_Vector like;    /* operators only */
  N_Vector weights; /* operators: of solutions, NULL: none; see stf_pencil_aim */
  double aim, relative;
  bool ahead, forced; /* see stf_pencil_force */
  stf_krylov_counts counts;
  stf_deferred *deferred; /* of operators on vectors that are spread over ranks */
  double *work;           /* STF_COLUMNS * n, for solve; NULL where not needed */
  steif_pencil_stats stats;
  bool revived; /* an image is being read: a preconditioner is made where and as that says */
  bool stale;   /* E and A have not been looked at since they changed */
  /* Sparse: pivots in use serve new values whatever the growth: residuals are looked at instead. */
  bool keeps_pivots;
  bool
    many_shifts; /* sparse: many complex matrices will share order and pivots, worth some time */
  int slots;     /* slots in use */
  steif_shift shift[STEIF_PENCIL_SLOTS];
  bool fresh[STEIF_PENCIL_SLOTS];
};

/* Columns of p->work: real right-hand sides that a back end gets at once, or twice the complex. */
enum { STF_COLUMNS = 8 };

static inline bool stf_is_complex(steif_shift s) { return s.im != 0; }

/* Operators with a preconditioner P, or with E = I, then P = s: solves until P^{-1} r, r the residual, has
 * the weighted root mean square `aim`, which is about what is wrong with the solution, and not until r
 * is small beside b. Those that do not get there return STEIF_RETRY. Other pencils take no notice. */
static inline void stf_pencil_aim(steif_pencil *p, N_Vector weights, double aim)
{
  p->weights = weights, p->aim = aim, p->relative = 0;
  p->ahead = p->forced = false;
}

/* Until the next aim: a solve ends as well where P^{-1} r is `relative` times what it was at first, and what is
 * known of the residual there is put to use; `ahead`: that will take an iteration at least. */
static inline void stf_pencil_force(steif_pencil *p, double relative, bool ahead)
{
  p->relative = relative, p->ahead = ahead, p->forced = true;
}

/* saved/pencil_image.c: factors and counts; the matrices are the owner's and have been read before. */
void stf_pencil_keep(steif_pencil *p, stf_image *m);

/* threads.c: piece(task, i) for i < count on up to so many threads; the pieces are independent. */
void stf_parallel(int threads, int count, void (*piece)(void *task, int i), void *task);
/* Factor slots[0 .. count-1], side by side where it pays; out[i] belongs to slots[i]. */
void stf_parallel_factor(steif_pencil *p, int count, const int *slots, const steif_shift *s,
                         stf_outcome *out);

/* One right-hand side with each of the slots 0 .. count-1, re[k] + i im[k], side by side where it pays;
 * im[k] = NULL for a real slot. What comes out does not depend on the number of threads. */
int stf_parallel_solve(steif_pencil *p, int count, N_Vector *re, N_Vector *im);

/* columns.c: right-hand sides as columns of one array, `ld` apart, complex ones interleaved. Calls
 * `solve` for as many at a time as p->work holds; works in place where the vectors already are. */
int stf_columns_open(steif_pencil *p);
int stf_columns(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im,
                stf_columns_solve *solve);
/* All finite? Branch-free, since the answer is yes. */
bool stf_all_finite(const double *x, size_t count);
/* Vectors to interleaved columns and back. */
void stf_columns_join(size_t n, const double *re, const double *im, double *w);
void stf_columns_part(size_t n, const double *w, double *re, double *im);

/* The solve of a sparse slot and nothing around it, b in its own layout (complex: interleaved):
 * the floor that benchmarks compare with. */
void stf_sparse_direct(steif_pencil *p, int slot, double *b);
/* Forget the factors of a sparse slot by KLU: the next ones look for pivots. */
void stf_sparse_drop(steif_pencil *p, int slot);

/* residual.c, sparse pencils, M = s E - A of a factored slot, complex where s is: r, which comes as
 * b, becomes b - M x. Returns the root mean square of the rows' backward errors
 * |b - M x|_i / (|M| |x| + |b|)_i, |z| = |Re z| + |Im z| (W. Oettli & W. Prager, Numer. Math. 6,
 * 1964): their maximum grows with the number of rows. size: scratch, n. */
double stf_sparse_residual(const steif_pencil *p, int slot, const double *x, double *r,
                           double *size);
/* log |det(s E - A)| of a factored slot, sparse pencils only: the logarithms of the diagonal of U
 * and of KLU's row scales, summed with compensation. */
int stf_pencil_logdet(steif_pencil *p, int slot, sunrealtype *log_abs_det);

#endif
