/* weak_inside.h: the descriptor room inside: one Jordan block, its exact solution, recorded runs.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_WEAK_INSIDE_H
#define STF_WEAK_INSIDE_H

#include "apart.h"
#include "base.h"
#include "forcing_sides.h"
#include "pairing.h"
#include <steif/collection.h>
#include <steif/runs.h>
#include <steif/weak.h>
#include <steif/table.h>

/* N x' + x = f on t > 0 with x(0-) = x0; f given by `forcing` with its derivatives, NULL: 0. */
typedef struct stf_block {
  steif_context *ctx;
  int k;
  steif_forcing forcing;
  void *user;
  const sunrealtype *x0;
  N_Vector g;        /* room for one value of f */
  stf_weight weight; /* the test function; that of steif_test_function until it is changed */
  sunrealtype *c;    /* impulse coefficients, (k-1) x k by rows */
  sunrealtype *x;    /* scratch, k */
} stf_block;

int stf_block_open(stf_block *block, steif_context *ctx, int k, steif_forcing forcing,
                   void *user, const sunrealtype *x0);
void stf_block_close(stf_block *block);
/* x = sum_n w_n (-1)^n N^n f^(n+j)(t): w_n = 1 gives x_s^(j), w_n = n + 1 gives v^(j-1) with v the
 * smooth solution of N v' + v = x_s'. */
int stf_block_series(stf_block *block, sunrealtype t, int j, bool weighted, sunrealtype *x);
/* <x_m, g^(j)> of the distributional solution, m = 0 .. k-1. */
int stf_block_pair(stf_block *block, int m, int j, sunrealtype *value);
/* E_1 of backward Euler, <x_h - x, g> = h E_1 + O(h^2), in convention P or R. */
int stf_block_first(stf_block *block, int m, enum steif_convention convention,
                    sunrealtype *value);

/* Gauss's rule with 8 points on [-1, 1]. */
enum { STF_RULE = 8 };
extern const sunrealtype stf_rule_node[STF_RULE], stf_rule_weight[STF_RULE];

/* What to record of a run with constant steps, and the record. */
typedef struct stf_trace {
  int count; /* components */
  size_t steps;
  sunrealtype *t, *x;   /* steps + 1 times; as many rows of `count` values; NULL: not wanted */
  stf_pairing *pairing; /* is told of nodes and stages, in the coordinates of the run; NULL */
  stf_sides *sides;     /* of f; NULL: it has no breaks */
  stf_apart *apart;     /* run in its coordinates; NULL: in those of the problem */
  sunrealtype *state;   /* x at the end of the run, in its coordinates; NULL: not wanted */
  bool continued;       /* it begins there, not at the start of the problem */
} stf_trace;

/* Run `steps` equal steps h of the method; t and x are the caller's. */
int stf_trace_run(steif_context *ctx, const steif_problem *problem, const char *method,
                  const char *start, sunrealtype h, stf_trace *trace);
/* The trace starts with the value of convolution quadrature at t0 instead of x(0-). */
bool stf_trace_is_cq(steif_context *ctx, const char *method, const char *start);

/* The first break before t1 that is no whole number of steps h; count: none. */
size_t stf_break_inside(size_t count, const sunrealtype *breaks, sunrealtype t1, sunrealtype h);
/* A step near h with all of them on its mesh, NaN where there is none. */
sunrealtype stf_break_step(size_t count, const sunrealtype *breaks, sunrealtype t1,
                           sunrealtype h);

enum { STF_LEAST_ROWS = 3 }; /* that show an order */

/* What the rows of a measure are judged by. */
typedef struct stf_judged {
  const steif_weak_row *row;
  size_t rows;
  sunrealtype size;     /* of the exact value; */
  sunrealtype accuracy; /* of it, infinite: not known */
  sunrealtype longest;  /* step that resolves system, f and g; */
  const char *fastest;  /* what asks for it */
  int blind;            /* order of impulses that g does not see; -1: it sees all */
  sunrealtype inside;   /* a break of f that lies inside a step; NaN: none does */
  sunrealtype fitting;  /* a first step that puts the breaks on the meshes; NaN: none */
  bool able;            /* the run can begin anew at breaks */
  bool decidable;       /* a run in many digits would see what rounding hides */
} stf_judged;
/* That a break lies inside a step, and the remedy: `what` depends on where. */
void stf_say_inside(const stf_judged *judged, const char *what, char *text, size_t room);
/* Fills in verdict and converges. */
void stf_weak_judge(const stf_judged *judged, steif_weak_result *result);
/* The verdict is that errors are 0 in all rows. */
bool stf_weak_is_exact(const steif_weak_result *result);

#endif
