/* apart.c: a descriptor system in coordinates z = (w, v) in which its parts are apart,
 *   N w' + w = g,  E_f v' + F_f v = f_f,  N strictly upper triangular in exact zeros.
 * A method with equal steps makes the same of it, but for rounding: errors in E and F as they are
 * given enter as eps h^(-2 (k-1)), those of the triangular N as eps h^(-(k-1)), since nothing leads
 * back from a later unknown of a chain to an earlier one.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "apart.h"
#include "dense_algebra.h"
#include "reduce.h"
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

/* G f^(order). */
static int force(sunrealtype t, int order, N_Vector out, void *user)
{
  const stf_apart *a = user;
  const int code = a->from->f(t, order, a->g, a->from->user);
  if (!code)
    stf_gemm('N', 'N', a->n, 1, a->n, 1, a->maps.G, a->n, NV_DATA_S(a->g), a->n, 0,
             N_VGetArrayPointer(out), a->n);
  return code;
}

static int claim(stf_apart *a)
{
  const size_t n = (size_t)a->n, size = n * n;
  const SUNContext sun = steif_sundials(a->ctx);
  a->linear.E = SUNDenseMatrix(a->n, a->n, sun);
  a->linear.F = SUNDenseMatrix(a->n, a->n, sun);
  a->g = N_VNew_Serial(a->n, sun);
  STEIF_CHECK(a->linear.E && a->linear.F && a->g, a->ctx, STEIF_NO_MEMORY,
              "no memory for dense matrices of order %d", a->n);
  if (!(a->z0 = stf_allocate(a->ctx, 3 * size + n, sizeof *a->z0))) return STEIF_NO_MEMORY;
  sunrealtype *maps = a->z0 + n;
  a->maps = (stf_decoupling){SM_DATA_D(a->linear.E), SM_DATA_D(a->linear.F), maps, maps + size,
                             maps + 2 * size};
  if (a->from->f) a->linear.f = force, a->linear.user = a;
  return stf_dense_parts(a->ctx, a->from->E, a->from->F, &(steif_analysis){0},
                         &(stf_separated){.decoupling = &a->maps});
}

int stf_apart_open(steif_context *ctx, const steif_linear *from,
                   const steif_structure *structure, stf_apart *a)
{
  *a = (stf_apart){.ctx = ctx, .from = from, .n = (int)structure->n};
  if (!stf_reducible(structure, false)) return STEIF_OK;
  const int code = claim(a);
  if (code) stf_apart_close(a);
  return code;
}

void stf_apart_close(stf_apart *a)
{
  if (!a->ctx) return;
  if (a->linear.E) SUNMatDestroy(a->linear.E);
  if (a->linear.F) SUNMatDestroy(a->linear.F);
  if (a->g) N_VDestroy(a->g);
  stf_release(a->ctx, a->z0);
  *a = (stf_apart){0};
}

/* out = M in. */
static void apply(const stf_apart *a, const sunrealtype *M, int n, const sunrealtype *in,
                  sunrealtype *out)
{
  if (a->linear.E)
    stf_gemm('N', 'N', n, 1, n, 1, M, n, in, n, 0, out, n);
  else
    memcpy(out, in, (size_t)n * sizeof *out);
}

void stf_apart_enter(const stf_apart *a, int n, const sunrealtype *x, sunrealtype *z)
{
  apply(a, a->maps.to, n, x, z);
}

void stf_apart_leave(const stf_apart *a, int n, const sunrealtype *z, sunrealtype *x)
{
  apply(a, a->maps.back, n, z, x);
}

int stf_apart_problem(stf_apart *a, const steif_problem *given, steif_problem *problem)
{
  stf_apart_enter(a, a->n, given->y0, a->z0);
  return steif_linear_problem(a->ctx, &a->linear, a->z0, given->t0, given->t1, problem);
}

sunrealtype stf_apart_component(const stf_apart *a, int m, const sunrealtype *z)
{
  sunrealtype sum = 0;
  for (int j = 0; j < a->n; j++)
    sum += a->maps.back[(size_t)j * (size_t)a->n + (size_t)m] * z[j];
  return sum;
}
