/* finite_part.c: the state space behind a descriptor system E x' = A x + B u.
 *
 * A system of index 1 with the same smooth solutions, F_a x = sum_j G_j B u^(j) and
 * E_r x' + F_r x = G_r B u with [F_a; E_r] regular, has the state z = E_r x: with
 * x = X [w; z], X = [F_a; E_r]^{-1},
 *   z' = -F_r X_z z + G_r B u,   y = C X_z z + D u + sum_j C X_w G_j B u^(j).
 * F_r X_w is 0 because the rows of F_r are combinations of those of E_r, which X_w sends to 0.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "discrete.h"
#include "separated_parts.h"
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

typedef struct split {
  steif_context *ctx;
  const steif_state_space *s;
  SUNMatrix E, F;
  stf_reduction maps;
  double *X, *GB; /* n x n; terms of n x m */
  int *pivot;
} split;

static int sizes(steif_context *ctx, const steif_state_space *s, const double *E)
{
  steif_state_space bare = *s;
  if (s->p == 0) bare.C = NULL;
  STEIF_TRY(stf_state_space_check(ctx, &bare));
  return stf_check_matrix(ctx, "E", s->n, s->n, E);
}

/* The index, STEIF_SINGULAR or STEIF_NOT_CERTIFIED with what the analysis has to say. */
static int analyse(split *x, int *index)
{
  steif_structure structure = {0};
  STEIF_TRY(steif_structure_find(x->ctx, x->E, x->F, &(steif_analysis){0}, &structure));
  const int regular = structure.regular;
  *index = structure.index;
  char message[sizeof structure.message];
  memcpy(message, structure.message, sizeof message);
  steif_structure_clear(x->ctx, &structure);
  STEIF_CHECK(regular, x->ctx, STEIF_SINGULAR, "s E - A is singular: %s", message);
  STEIF_CHECK(*index >= 0, x->ctx, STEIF_NOT_CERTIFIED, "the index is undecided: %s", message);
  return STEIF_OK;
}

/* X, by rows of the reduced system. */
static int invert(split *x)
{
  const int n = x->s->n, m = x->maps.algebraic;
  double *M = x->X + n * n;
  int info = 0;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      M[i + n * j] = (i < m ? x->maps.F : x->maps.E)[i + n * j];
      x->X[i + n * j] = i == j;
    }
  dgesv_(&n, &n, M, &n, x->pivot, x->X, &n, &info);
  STEIF_CHECK(info == 0, x->ctx, STEIF_SINGULAR,
              "the finite part of the pencil could not be split off; scale the equations");
  return STEIF_OK;
}

/* Rows of maps.F below the algebraic ones, packed. */
static void rows_below(const split *x, const double *from, int columns, double *to)
{
  const int n = x->s->n, m = x->maps.algebraic, f = n - m;
  for (int j = 0; j < columns; j++)
    for (int i = 0; i < f; i++) to[i + f * j] = from[m + i + n * j];
}

/* C (p x n) or 1 times X_w (the algebraic columns) or X_z. */
static void outputs(const split *x, int first, int columns, double *CX)
{
  const steif_state_space *s = x->s;
  const double *part = x->X + s->n * first;
  if (s->p)
    stf_product(s->p, columns, s->n, 1, s->C, part, 0, CX);
  else
    memcpy(CX, part, (size_t)s->n * (size_t)columns * sizeof *CX);
}

static int largest(int a, int b) { return a > b ? a : b; }

/* `out` has room for A, B, C, D and the P_j one after another; room: n (n + m + p). */
static void compose(const split *x, double *out, double *room, steif_finite_part *part)
{
  const steif_state_space *s = x->s;
  const int n = s->n, m = x->maps.algebraic, f = n - m, p = s->p ? s->p : n;
  double *A = out, *B = A + f * f, *C = B + f * s->m, *D = C + p * f, *P = D + p * s->m;
  double *Fr = room, *CX = Fr + f * n, *top = CX + p * m;
  rows_below(x, x->maps.F, n, Fr);
  stf_product(f, f, n, -1, Fr, x->X + n * m, 0, A);
  rows_below(x, x->GB, s->m, B);
  outputs(x, m, f, C);
  outputs(x, 0, m, CX);
  if (s->D) memcpy(D, s->D, (size_t)p * (size_t)s->m * sizeof *D);
  for (int j = 0; j < x->maps.terms; j++) {
    const double *GB = x->GB + j * n * s->m;
    for (int c = 0; c < s->m; c++) memcpy(top + m * c, GB + n * c, (size_t)m * sizeof *top);
    stf_product(p, s->m, m, 1, CX, top, j == 0, j ? P + (j - 1) * p * s->m : D);
  }
  part->form = (steif_state_space){f, s->m, p, A, B, C, D};
  part->terms = largest(x->maps.terms - 1, 0);
  part->polynomial = P;
}

static int reduce(split *x, steif_finite_part *part)
{
  const steif_state_space *s = x->s;
  const int n = s->n, p = s->p ? s->p : n;
  const size_t square = (size_t)n * (size_t)n, inputs = (size_t)n * (size_t)s->m;
  STEIF_TRY(analyse(x, &part->index));
  const size_t terms = (size_t)largest(part->index, 1), rows = (size_t)p;
  double *work = stf_allocate(x->ctx,
                              (terms + 4) * square + terms * inputs +
                                ((size_t)n + (size_t)s->m) * (rows + (size_t)n),
                              sizeof *work);
  double *out = stf_allocate(
    x->ctx, square + inputs + rows * (size_t)n + terms * rows * (size_t)s->m + 1, sizeof *out);
  x->pivot = stf_allocate(x->ctx, (size_t)n, sizeof *x->pivot);
  part->memory = out;
  int code = work && out && x->pivot ? STEIF_OK : STEIF_NO_MEMORY;
  if (code == STEIF_OK) {
    x->maps = (stf_reduction){
      .terms = (int)terms, .E = work, .F = work + square, .G = work + 4 * square};
    x->X = work + 2 * square, x->GB = x->maps.G + terms * square;
    code = stf_dense_parts(x->ctx, x->E, x->F, &(steif_analysis){0},
                           &(stf_separated){.reduction = &x->maps});
  }
  if (code == STEIF_OK) code = invert(x);
  for (size_t j = 0; code == STEIF_OK && j < terms; j++)
    stf_product(n, s->m, n, 1, x->maps.G + j * square, s->B, 0, x->GB + j * inputs);
  if (code == STEIF_OK) compose(x, out, x->GB + terms * inputs, part);
  stf_release(x->ctx, work), stf_release(x->ctx, x->pivot);
  return code;
}

int steif_finite_part_find(steif_context *ctx, const steif_state_space *s, const double *E,
                           steif_finite_part *part)
{
  STEIF_CHECK(s && part, ctx, STEIF_BAD_INPUT,
              "a system and room for its finite part are needed");
  *part = (steif_finite_part){0};
  STEIF_TRY(sizes(ctx, s, E));
  const size_t square = (size_t)s->n * (size_t)s->n;
  split x = {.ctx = ctx, .s = s};
  x.E = SUNDenseMatrix(s->n, s->n, steif_sundials(ctx));
  x.F = SUNDenseMatrix(s->n, s->n, steif_sundials(ctx));
  int code = STEIF_OK;
  if (x.E && x.F) {
    memcpy(SM_DATA_D(x.E), E, square * sizeof *E);
    for (size_t i = 0; i < square; i++) SM_DATA_D(x.F)[i] = -s->A[i];
    code = reduce(&x, part);
  } else
    code = STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for dense matrices of order %d", s->n);
  if (x.E) SUNMatDestroy(x.E);
  if (x.F) SUNMatDestroy(x.F);
  if (code) steif_finite_part_clear(ctx, part);
  return code;
}

void steif_finite_part_clear(steif_context *ctx, steif_finite_part *part)
{
  if (!part) return;
  stf_release(ctx, part->memory);
  *part = (steif_finite_part){0};
}
