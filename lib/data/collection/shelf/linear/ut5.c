/* ut5.c: a regular 5 x 5 pencil E x' + F x = f of index 3 with two finite eigenvalues.
 *
 * E = U diag(I_2, N_3) V, F = U diag(J, I_3) V with integer unimodular U and V,
 * J = [1/2 3; -3 1/2] and N_3 nilpotent with ones above the diagonal. With h = U^{-1} f,
 *   zeta = z_1 + i z_2:  zeta' + (1/2 - 3i) zeta = h_1 + i h_2,
 *   w_3 = h_5,  w_2 = h_4 - h_5',  w_1 = h_3 - h_4' + h_5'',
 *   x = (z_1 - w_1 + w_2, z_2 - w_1 + w_2 - w_3, w_1 - w_2, w_2, w_3) = V^{-1} (z, w).
 * x(0-) = (1, 2, 3, 4, 5) has impulses (case=inc); case=cons starts from x(0+).
 *
 * Parameters that leave the structure as it is: beta N_3 for N_3; (1 + rows X) E (1 + columns X), and F likewise, with
 * X = e_12 + 2 e_24 + e_31 - e_45 + e_53. beta = 1, rows = columns = 0 is the pencil above.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <complex.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/parameters.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { SIZE = 5 };

static const sunrealtype lead[SIZE][SIZE] = {
  {1, 0, 1, 0, 0}, {1, 1, 2, 0, 1}, {0, 1, 1, 1, 1}, {0, 0, 0, 1, 1}, {1, 0, 1, 0, 1}};
static const sunrealtype tail[SIZE][SIZE] = {{.5, 3, 3.5, 0, 3},
                                             {-2.5, 3.5, 1, 0, 3.5},
                                             {-3, .5, -1.5, 1, .5},
                                             {0, 0, 1, 2, 0},
                                             {.5, 3, 3.5, 1, 4}};

/* U diag(0, N_3) V, and X. */
static const sunrealtype nilpotent[SIZE][SIZE] = {
  {0}, {0}, {0, 0, 0, 1, 0}, {0, 0, 0, 1, 1}, {0, 0, 0, 0, 1}};
static const sunrealtype mixed[SIZE][SIZE] = {
  {0, 1, 0, 0, 0}, {0, 0, 0, 2, 0}, {1, 0, 0, 0, 0}, {0, 0, 0, 0, -1}, {0, 0, 1, 0, 0}};

enum { BETA, ROWS, COLUMNS, PARAMETERS };
static const char *const parameter[] = {"beta", "rows", "columns"};

typedef struct pencil {
  sunrealtype p[PARAMETERS];
  sunrealtype E[SIZE][SIZE], F[SIZE][SIZE];
  sunrealtype dE[PARAMETERS][SIZE][SIZE], dF[PARAMETERS][SIZE][SIZE];
  steif_parameters parameters;
} pencil;

static const sunrealtype before[] = {1, 2, 3, 4, 5}, after[] = {-8, -2, 12, 0, 0};
static const sunrealtype slope[] = {-56, -18, 25, -10, -1}; /* of x at 0+ */
static const int component_index[] = {3, 3, 3, 2, 1};

static const sunrealtype end[] = {-9.83990493625282, -14.7438400658581, 6.64909590232396,
                                  -6.87665107291679, 3.08069506977476};
static const steif_reference reference = {
  .t = 1, .value = end, .digits = 15, .source = "Drazin and contour formulas, 40 digits"};

/* Derivative q of cos(at) and of sin(at). */
static sunrealtype cosine(sunrealtype a, int q, sunrealtype t)
{
  const sunrealtype wave[] = {cos(a * t), -sin(a * t), -cos(a * t), sin(a * t)};
  return pow(a, q) * wave[q % 4];
}
static sunrealtype sine(sunrealtype a, int q, sunrealtype t)
{
  return cosine(a, q + 3, t) / (a * a * a);
}

/* f = (cos t, sin 2t, 1 + t, cos 3t, t^2). */
static void force(sunrealtype t, int q, sunrealtype *f)
{
  f[0] = cosine(1, q, t);
  f[1] = sine(2, q, t);
  f[2] = q == 0 ? 1 + t : q == 1;
  f[3] = cosine(3, q, t);
  f[4] = q == 0 ? t * t : q == 1 ? 2 * t : q == 2 ? 2 : 0;
}

static int g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  (void)user;
  if (derivative < 0) return -1;
  force(t, derivative, N_VGetArrayPointer(out));
  return 0;
}

/* out = (a + rows X) M (b + columns X). */
static void mix(sunrealtype a, sunrealtype rows, sunrealtype M[SIZE][SIZE], sunrealtype b,
                sunrealtype columns, sunrealtype out[SIZE][SIZE])
{
  sunrealtype left[SIZE][SIZE];
  for (int i = 0; i < SIZE; i++)
    for (int j = 0; j < SIZE; j++) {
      left[i][j] = a * M[i][j];
      for (int k = 0; k < SIZE; k++) left[i][j] += rows * mixed[i][k] * M[k][j];
    }
  for (int i = 0; i < SIZE; i++)
    for (int j = 0; j < SIZE; j++) {
      out[i][j] = b * left[i][j];
      for (int k = 0; k < SIZE; k++) out[i][j] += columns * left[i][k] * mixed[k][j];
    }
}

static void mix_all(const sunrealtype *p, sunrealtype M[SIZE][SIZE],
                    sunrealtype out[SIZE][SIZE], sunrealtype by[PARAMETERS][SIZE][SIZE])
{
  mix(1, p[ROWS], M, 1, p[COLUMNS], out);
  mix(0, 1, M, 1, p[COLUMNS], by[ROWS]);
  mix(1, p[ROWS], M, 0, 1, by[COLUMNS]);
}

static int follow(void *user)
{
  pencil *b = user;
  sunrealtype by_beta[SIZE][SIZE], E[SIZE][SIZE], F[SIZE][SIZE];
  memcpy(by_beta, nilpotent, sizeof by_beta);
  memcpy(F, tail, sizeof F);
  for (int i = 0; i < SIZE; i++)
    for (int j = 0; j < SIZE; j++) E[i][j] = lead[i][j] + (b->p[BETA] - 1) * nilpotent[i][j];
  mix_all(b->p, E, b->E, b->dE);
  mix_all(b->p, F, b->F, b->dF);
  mix(1, b->p[ROWS], by_beta, 1, b->p[COLUMNS], b->dE[BETA]);
  return 0;
}

/* E_p x' + F_p x. */
static int slope_by_p(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const pencil *b = user;
  const sunrealtype *x = N_VGetArrayPointer(y), *d = N_VGetArrayPointer(yp);
  (void)t;
  for (int i = 0; i < SIZE; i++) {
    sunrealtype sum = 0;
    for (int j = 0; j < SIZE; j++) sum += b->dE[k][i][j] * d[j] + b->dF[k][i][j] * x[j];
    N_VGetArrayPointer(out)[i] = sum;
  }
  return 0;
}

static int E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  const pencil *b = user;
  (void)t, (void)y, (void)yp;
  for (int i = 0; i < SIZE; i++)
    for (int j = 0; j < SIZE; j++) SM_ELEMENT_D(M, i, j) = b->E[i][j];
  return 0;
}

static int A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  const pencil *b = user;
  (void)t, (void)y, (void)yp;
  for (int i = 0; i < SIZE; i++)
    for (int j = 0; j < SIZE; j++) SM_ELEMENT_D(M, i, j) = -b->F[i][j];
  return 0;
}

/* h^(q) = U^{-1} f^(q) by forward substitution. */
static void reduced(sunrealtype t, int q, sunrealtype *h)
{
  sunrealtype f[SIZE];
  force(t, q, f);
  h[0] = f[0];
  h[1] = f[1] - h[0];
  h[2] = f[2] - h[1];
  h[3] = f[3] - h[2];
  h[4] = f[4] - h[0] - h[3];
}

/* A solution of zeta' + a zeta = (1-i) cos t + i sin 2t. */
static double complex particular(double complex a, sunrealtype t)
{
  return (1 - I) * (a * cos(t) + sin(t)) / (a * a + 1) +
         I * (a * sin(2 * t) - 2 * cos(2 * t)) / (a * a + 4);
}

static void assemble(double complex zeta, const sunrealtype *w, sunrealtype *x)
{
  x[0] = creal(zeta) - w[0] + w[1];
  x[1] = cimag(zeta) - w[0] + w[1] - w[2];
  x[2] = w[0] - w[1];
  x[3] = w[1];
  x[4] = w[2];
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const double complex a = 0.5 - 3 * I, zeta0 = 4 + 10 * I; /* (1, 2) = rows of V times x(0-) */
  const double complex zeta = particular(a, t) + cexp(-a * t) * (zeta0 - particular(a, 0));
  sunrealtype h[4][SIZE];
  (void)user;
  for (int q = 0; q < 4; q++) reduced(t, q, h[q]);
  for (int q = 0; q < (yp ? 2 : 1); q++) {
    const sunrealtype w[] = {h[q][2] - h[q + 1][3] + h[q + 2][4], h[q][3] - h[q + 1][4],
                             h[q][4]};
    assemble(q == 0 ? zeta : h[0][0] + I * h[0][1] - a * zeta, w,
             N_VGetArrayPointer(q == 0 ? y : yp));
  }
  return 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"case", NULL}));
  const char *word = stf_spec_word(spec, "case");
  const bool consistent = word && !strcmp(word, "cons");
  STEIF_CHECK(!word || consistent || !strcmp(word, "inc"), ctx, STEIF_UNKNOWN_NAME,
              "case=%s of '%s' is not known: choose inc or cons", word, spec->name);
  pencil *b = stf_collection_allocate(ctx, self, sizeof *b, 0);
  if (!b) return STEIF_NO_MEMORY;
  b->p[BETA] = 1, b->p[ROWS] = b->p[COLUMNS] = 0;
  b->parameters = (steif_parameters){
    .count = PARAMETERS, .value = b->p, .name = parameter, .dFdp = slope_by_p, .moved = follow};
  self->parameters = &b->parameters;
  follow(b);
  self->y0 = consistent ? after : before;
  self->yp0 = consistent ? slope : NULL;
  return STEIF_OK;
}

const steif_problem steif_problem_ut5 = {
  .about =
    "5 x 5 pencil of index 3 with eigenvalues -1/2 +- 3i, impulses at the start (case=inc); "
    "theory: S. L. Campbell, Singular Systems of Differential Equations, Pitman 1980",
  .n = SIZE,
  .t1 = 1,
  .E = E,
  .A = A,
  .g = g,
  .index = component_index,
  .dae_index = 3,
  .linear = 1,
  .exact = exact,
  .reference = &reference,
  .build = build,
  .destroy = stf_collection_release,
};
