/* baseline.h: what CVODE, IDA and ARKODE share here.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BASELINE_H
#define STF_BASELINE_H

#include "space.h"
#include "compat.h"
#include "engine.h"
#include <steif/pencil.h>
#include <sundials/sundials_linearsolver.h>

/* A return flag of a package: its name, what it means, what to do. Tables end with flag 0. */
typedef struct stf_flag {
  int flag, code; /* code: enum steif_code */
  const char *name, *what, *remedy;
} stf_flag;

/* Pattern of c E - A by columns, and where the entries of E and A go in it. */
typedef struct stf_merge {
  sunindextype *column, *row, *from_E, *from_A;
  sunindextype nnz_E, nnz_A;
} stf_merge;

enum { STF_SAID = 320 };

/* First member of the state of every engine; the user data of every callback. */
typedef struct stf_baseline {
  const char *package;
  const stf_flag *flags;
  stf_run *run;
  enum steif_storage storage; /* of the Newton matrix */
  SUNMatrix J;                /* NULL for Krylov */
  SUNLinearSolver solver;
  steif_pencil *near;  /* incomplete factors; NULL: none */
  bool preconditioned; /* by them or by the problem ... */
  sunrealtype c;       /* ... for this c */
  SUNMatrix E, A;      /* as the callbacks fill them, in the storage of the problem */
  stf_merge merge;     /* of sparse E and A */
  struct stf_system
    *coloured;          /* differences in a sparse pattern; NULL: callbacks tell entries */
  N_Vector atol;        /* NULL: one number for all components */
  N_Vector work, start; /* start: residual of a failed start (IDA) */
  N_Vector *pair;       /* for slopes at a start */
  N_Vector constraint;  /* NULL: none */
  struct {
    const char *who; /* the callback that failed last, NULL: none */
    int verdict;     /* what it returned; 0: it returned a value that is not finite */
    sunindextype at; /* the component that is not finite, -1: not known */
    sunrealtype t;
    bool now; /* in this step */
  } fault;
  int next_break;      /* index into problem.breaks */
  bool restart;        /* a break was reached: the next step begins anew */
  steif_stats past;    /* counted before the last restart */
  sunrealtype before;  /* time before the step */
  long made;           /* steps made then */
  long stalls;         /* steps in a row that time did not feel */
  char said[STF_SAID]; /* last message of the package */
  bool told;           /* a preconditioner that has ended the call has left its own sentence */
  char detail[120];    /* what the engine adds to the sentence */
} stf_baseline;

#define STF_FLAG(flag, code, what, remedy)                                                     \
  {                                                                                            \
    flag, code, #flag, what, remedy                                                            \
  }

/* Run a call of a package unless one before it failed. */
#define STF_CALL(flag, call)                                                                   \
  do {                                                                                         \
    if ((flag) >= 0) (flag) = (call);                                                          \
  } while (0)

/* SUNDIALS 6 has one error handler for each integrator, SUNDIALS 7 a stack in its context. */
#if SUNDIALS_VERSION_MAJOR >= 7
#define STF_SILENCE(setter, memory, base) 0
#else
#define STF_SILENCE(setter, memory, base) setter(memory, stf_baseline_hear, base)
void stf_baseline_hear(int code, const char *module, const char *function, char *text,
                       void *base);
#endif

/* --- baseline.c --- */
int stf_baseline_open(stf_baseline *base, stf_run *run, const char *package,
                      const stf_flag *flags);
/* Before the package is made: it clones vectors, and asks for norms of tolerances and constraints. */
int stf_baseline_gate(const stf_baseline *base);
/* Refuse given steps. */
int stf_baseline_adaptive(const stf_baseline *base);
/* J and a solver for it; `exact`: a callback gives the entries. */
int stf_baseline_linear(stf_baseline *base, bool exact);
/* A in the storage of the problem, for callbacks that cannot fill J itself. */
int stf_baseline_native(stf_baseline *base);
SUNLinearSolver stf_baseline_solver(stf_baseline *base, SUNMatrix M);

/* coloured.c. Where the problem is sparse and tells its pattern only: base->coloured; it fills E or A, and
 * entries that a probe finds join them. */
int stf_coloured_open(stf_baseline *base);
int stf_coloured_fill(stf_baseline *base, char which, sunrealtype t, N_Vector y, N_Vector yp,
                      SUNMatrix M);
/* Evaluations it has made; count them from 0 again. */
long stf_coloured_count(stf_baseline *base);
void stf_coloured_forget(stf_baseline *base);

/* Around every stretch of calls to a package: its messages are collected, never printed. */
void stf_baseline_enter(stf_baseline *base, stf_run *run);
void stf_baseline_leave(stf_baseline *base);

/* What a callback returned; a value that is not finite becomes 1, "try a smaller step". */
int stf_baseline_watch(stf_baseline *base, const char *who, int verdict, sunrealtype t,
                       N_Vector out);
int stf_baseline_watch_matrix(stf_baseline *base, const char *who, int verdict, sunrealtype t,
                              SUNMatrix M);

/* CVODE and ARKODE: f, df/dy and its product, in their signatures. */
int stf_baseline_weights(N_Vector y, N_Vector ewt, void *base);
int stf_baseline_rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *base);
int stf_baseline_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *base,
                     N_Vector tmp1, N_Vector tmp2, N_Vector tmp3);
int stf_baseline_jv(N_Vector v, N_Vector Jv, sunrealtype t, N_Vector y, N_Vector fy, void *base,
                    N_Vector tmp);
/* precondition.c: Krylov: near and preconditioned; and the callbacks of CVODE and ARKODE for them. */
int stf_baseline_near(stf_baseline *base);
int stf_baseline_precsetup(sunrealtype t, N_Vector y, N_Vector fy, sunbooleantype jok,
                           sunbooleantype *jcur, sunrealtype gamma, void *base);
int stf_baseline_precsolve(sunrealtype t, N_Vector y, N_Vector fy, N_Vector r, N_Vector z,
                           sunrealtype gamma, sunrealtype delta, int side, void *base);
/* True if df/dy comes from a callback. */
bool stf_baseline_has_jac(const stf_baseline *base);
/* What a preconditioner returned; `failures` there were before. */
int stf_baseline_tells(stf_baseline *base, long failures, int returned);
/* Every component is a finite number. */
bool stf_baseline_finite(N_Vector v);

/* --- verdict.c: before and after a step --- */
/* enter, after t_stop and max_steps were looked at; t_stop is lowered to the next break. */
int stf_baseline_ready(stf_baseline *base, stf_run *run, sunrealtype *t_stop);
/* Time from which the next step begins anew: just behind a break, where f has its new value. */
sunrealtype stf_baseline_renew(stf_baseline *base);
/* The run was changed at an event: the next step begins anew. `state` is of any engine. */
int stf_baseline_renewed(stf_run *run, void *state);
/* Statistics of the run from the counters of the package. */
void stf_baseline_count(stf_baseline *base, const steif_stats *now);

/* STEIF_OK, or the sentence of a negative flag or of a solution that is not finite. */
int stf_baseline_verdict(stf_baseline *base, int flag, sunrealtype h, int order);

/* Dense output: t must lie inside the last step, up to rounding; and leave, with the sentence
 * of a negative flag. */
int stf_baseline_inside(const stf_baseline *base, sunrealtype *t);
int stf_baseline_dense(stf_baseline *base, int flag, sunrealtype t);

/* --- matrix.c: E and A, their sum and product; arrays only --- */
SUNMatrix stf_matrix_new(stf_run *run, enum steif_storage storage, sunindextype nnz);
/* Stored entries of a column; row NULL: rows first, first + 1, ... */
typedef struct stf_column {
  sunindextype count, first;
  const sunindextype *row;
  sunrealtype *entry;
} stf_column;
stf_column stf_matrix_column(SUNMatrix M, sunindextype j);
/* J += a M; M dense, band or sparse into a dense J, band into band. */
void stf_matrix_add(SUNMatrix J, sunrealtype a, SUNMatrix M);
/* out += a M x. */
void stf_matrix_times(SUNMatrix M, sunrealtype a, const sunrealtype *x, sunrealtype *out);
bool stf_matrix_finite(SUNMatrix M);
/* M = M - A, entry by entry, for matrices of one layout. */
void stf_matrix_difference(SUNMatrix M, SUNMatrix A);
/* large[j] = max_i |M_ij|. */
void stf_matrix_columns(SUNMatrix M, sunrealtype *large);
/* The n x n identity by columns. */
SUNMatrix stf_matrix_identity(stf_run *run);
int stf_merge_open(stf_run *run, SUNMatrix E, SUNMatrix A, stf_merge *merge);
/* J = c E - A by a merge, A NULL: 0; false if a pattern is not the one that was merged. */
bool stf_merge_fill(const stf_merge *merge, SUNMatrix J, sunrealtype c, SUNMatrix E,
                    SUNMatrix A);

/* --- ida_form.c: any form as the residual F(t, y, y') and its matrix dF/dy + c dF/dy' --- */
int stf_lower_open(stf_baseline *base);
int stf_lower_residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *base);
int stf_lower_jac(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r,
                  SUNMatrix J, void *base, N_Vector tmp1, N_Vector tmp2, N_Vector tmp3);
int stf_lower_jv(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector v, N_Vector Jv,
                 sunrealtype c, void *base, N_Vector tmp1, N_Vector tmp2);
bool stf_lower_has_jac(const stf_baseline *base);
/* E of the mass and descriptor forms, filled at the start. */
int stf_lower_mass(stf_baseline *base);
/* The same at t, y that of the run, on which it does not depend. Not 0: it could not be done. */
int stf_fill_mass(stf_baseline *base, sunrealtype t);

/* --- start.c --- */
/* E = dF/dy' at the start into base->E where callbacks can tell it. */
int stf_start_mass(stf_baseline *base);
/* y' at the start from E y' = f where the problem leaves it open. */
int stf_start_slopes(stf_baseline *base);
/* id_j = 1 for what IDA takes for a differential component, else 0, by `which`: "E": column j of dF/dy'
 * is not zero; "index": the perturbation index of component j is 1, by problem.index or else by
 * steif_diagnose; "ones": all. */
int stf_start_id(stf_baseline *base, const char *which, N_Vector id);

#endif
