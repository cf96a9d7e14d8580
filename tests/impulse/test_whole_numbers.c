/* test_whole_numbers.c: certified impulses are right. With whole U, V of determinant 1, J and a nilpotent
 * N of ones,
 *   E = R U diag(I, N) V C,  F = R U diag(J, I) V C,  R and C diagonal with powers of 2,
 * x = C^{-1} V^{-1} z has z(0+) = (z_1(0-), 0) and impulses (0, (-1)^k N^{k+1} z_2(0-)), all without
 * rounding: by algebra alone, no analysis has a part in it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse/families.h"
#include "impulse/systems.h"

enum { MOST = 9, DRAWS = 90 };

typedef struct whole {
  int n, finite, chains, chain[2], index;
  double E[MOST * MOST], F[MOST * MOST]; /* by columns */
  double back[MOST * MOST];              /* V^{-1}, by columns */
  double column[MOST];                   /* of C */
  double x0[MOST], plus[MOST], c[3][MOST];
} whole;

static int pick(sample *r, int count) { return (int)(uniform(r) * count); }

/* M = T M, or M = M T, with T = I + a e_i e_j'. */
static void add_row(int n, double *M, int i, int j, double a)
{
  for (int k = 0; k < n; k++) M[k * n + i] += a * M[k * n + j];
}
static void add_column(int n, double *M, int i, int j, double a)
{
  for (int k = 0; k < n; k++) M[j * n + k] += a * M[i * n + k];
}

static void chains_of(sample *r, whole *w)
{
  *w = (whole){.finite = pick(r, 4), .chains = 1 + pick(r, 2)};
  w->n = w->finite;
  for (int k = 0; k < w->chains; k++) {
    w->chain[k] = 1 + pick(r, k ? 2 : 4);
    w->index = w->chain[k] > w->index ? w->chain[k] : w->index;
    w->n += w->chain[k];
  }
  const int n = w->n;
  for (int i = 0; i < w->finite; i++) {
    w->E[i * n + i] = 1;
    for (int j = 0; j < w->finite; j++) w->F[j * n + i] = pick(r, 2) ? 0 : pick(r, 5) - 2;
  }
  for (int k = 0, at = w->finite; k < w->chains; at += w->chain[k++])
    for (int i = 0; i < w->chain[k]; i++) {
      w->F[(at + i) * n + at + i] = 1;
      if (i + 1 < w->chain[k]) w->E[(at + i + 1) * n + at + i] = 1;
    }
}

/* x = C^{-1} V^{-1} z. */
static void seen(const whole *w, const double *z, double *x)
{
  for (int i = 0; i < w->n; i++) {
    x[i] = 0;
    for (int j = 0; j < w->n; j++) x[i] += w->back[j * w->n + i] * z[j];
    x[i] /= w->column[i];
  }
}

/* From the blocks, before they are mixed: z moves along its chain. */
static void answers(sample *r, whole *w, double z[4][MOST])
{
  for (int i = 0; i < w->n; i++) z[0][i] = pick(r, 9) - 4;
  for (int k = 1; k < 4; k++)
    for (int at = w->finite, b = 0; b < w->chains; at += w->chain[b++])
      for (int i = 0; i < w->chain[b]; i++)
        z[k][at + i] = i + 1 < w->chain[b] ? (k > 1 ? -1 : 1) * z[k - 1][at + i + 1] : 0;
}

static void mix(sample *r, whole *w)
{
  const int n = w->n;
  for (int i = 0; i < n; i++) w->back[i * n + i] = 1;
  for (int turn = 0; n > 1 && turn < 2 * n; turn++) {
    const int i = pick(r, n), j = (i + 1 + pick(r, n - 1)) % n;
    const double a = pick(r, 2) ? 1 : -1;
    if (turn % 2) {
      add_row(n, w->E, i, j, a);
      add_row(n, w->F, i, j, a);
    } else {
      add_column(n, w->E, i, j, a);
      add_column(n, w->F, i, j, a);
      add_row(n, w->back, i, j, -a);
    }
  }
}

static void units(sample *r, whole *w, int span)
{
  const int n = w->n;
  double row[MOST];
  for (int i = 0; i < n; i++) row[i] = ldexp(1, pick(r, 2 * span + 1) - span);
  for (int i = 0; i < n; i++) w->column[i] = ldexp(1, pick(r, 2 * span + 1) - span);
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      w->E[j * n + i] *= row[i] * w->column[j];
      w->F[j * n + i] *= row[i] * w->column[j];
    }
}

static void draw_whole(unsigned seed, int span, whole *w)
{
  sample r = {.state = 77u + 100003u * (uint64_t)seed};
  double z[4][MOST] = {{0}}, plus[MOST] = {0};
  for (int k = 0; k < 10; k++) uniform(&r);
  chains_of(&r, w);
  answers(&r, w, z);
  for (int i = 0; i < w->finite; i++) plus[i] = z[0][i];
  mix(&r, w);
  units(&r, w, span);
  seen(w, z[0], w->x0);
  seen(w, plus, w->plus);
  for (int k = 0; k < 3; k++) seen(w, z[k + 1], w->c[k]);
}

/* The largest error in the units of z. */
static double apart(const whole *w, const double *x, const double *right)
{
  double most = 0;
  for (int i = 0; i < w->n; i++) most = fmax(most, fabs(x[i] - right[i]) * w->column[i]);
  return most;
}

/* What is certified differs by less than half a unit from whole numbers up to some hundreds. */
static void judge(const whole *w, const steif_impulse *i)
{
  CHECK(i->index == w->index);
  CHECK(apart(w, i->x_plus, w->plus) < 0.5);
  for (int k = 0; k < i->count && k < 3; k++) CHECK(apart(w, i->c + k * w->n, w->c[k]) < 0.5);
}

static void certified_impulses_are_right(void)
{
  static const enum steif_algorithm ways[] = {STEIF_STAIRCASE, STEIF_QZ, STEIF_CONTOUR};
  int certified = 0;
  for (unsigned draw = 0; draw < DRAWS; draw++)
    for (int way = 0; way < 3; way++) {
      steif_context *ctx = steif_context_new(NULL);
      whole w;
      draw_whole(draw, 10 * (int)(draw % 3), &w);
      SUNMatrix E = dense(ctx, w.n, w.E), F = dense(ctx, w.n, w.F);
      const steif_analysis a = {.algorithm = ways[way]};
      steif_impulse i;
      const int code = steif_impulse_find(ctx, E, F, w.x0, 0, NULL, NULL, &a, NULL, &i);
      if (code == STEIF_OK && i.certified) judge(&w, &i);
      certified += code == STEIF_OK && i.certified;
      steif_impulse_clear(ctx, &i);
      SUNMatDestroy(E);
      SUNMatDestroy(F);
      steif_context_free(&ctx);
    }
  CHECK(certified >= 3 * DRAWS * 9 / 10);
}

/* All eigenvalues are 0, and the smallest circles lose s E beside F: half of c_1 is what they agree on. */
static void half_an_impulse(void)
{
  static const double E[9] = {0.75,     -16,        -32,     0x1p-17, -0x1p-13,
                              -0x1p-12, -0x1.8p-38, 0x1p-33, 0x1p-32};
  static const double F[9] = {-0.75,   20,      32,         -0x1.cp-17, 0x1.2p-12,
                              0x1p-11, 0x1p-37, -0x1.4p-33, -0x1p-32};
  static const double x0[3] = {-0x1.8p-17, 0, -2097152};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix e = dense(ctx, 3, E), f = dense(ctx, 3, F);
  const steif_analysis a = {.algorithm = STEIF_CONTOUR};
  steif_impulse i;
  CHECK(steif_impulse_find(ctx, e, f, x0, 0, NULL, NULL, &a, NULL, &i) == STEIF_OK);
  if (i.certified) { /* by rational arithmetic */
    CLOSE(i.c[1], -0.5, 1e-6);
    CLOSE(i.c[3], 0x1p-18, 1e-6);
    CLOSE(i.c[5], 524288, 1e-6);
  }
  steif_impulse_clear(ctx, &i);
  SUNMatDestroy(e);
  SUNMatDestroy(f);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_whole_numbers[] = {
  {"certified impulses are right", certified_impulses_are_right},
  {"half an impulse is not one", half_an_impulse},
  CU_TEST_INFO_NULL};
