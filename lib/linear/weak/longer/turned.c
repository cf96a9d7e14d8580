/* turned.c: unknowns and equations in reverse, and turned around by one.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "turned.h"
#include "longer.h"
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

int stf_turned_place(const stf_turned *t, int m)
{
  const int at = t->turn == 0 ? m : (m + t->n / 2 + 1) % t->n;
  return t->turn < 2 ? t->n - 1 - at : at;
}

static int force(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const stf_turned *w = user;
  const int code = w->from->f(t, derivative, g, w->from->user);
  sunrealtype *f = N_VGetArrayPointer(g);
  if (code) return code;
  memcpy(w->f, f, (size_t)w->n * sizeof *f);
  for (int m = 0; m < w->n; m++) f[stf_turned_place(w, m)] = w->f[m];
  return 0;
}

static int fill(stf_turned *t, const steif_structure *structure, const sunrealtype *x0)
{
  const size_t n = (size_t)t->n;
  const SUNContext sun = steif_sundials(t->ctx);
  t->linear.E = SUNDenseMatrix(t->n, t->n, sun);
  t->linear.F = SUNDenseMatrix(t->n, t->n, sun);
  STEIF_CHECK(t->linear.E && t->linear.F, t->ctx, STEIF_NO_MEMORY,
              "no memory for dense matrices of order %d", t->n);
  long double *a = stf_allocate(t->ctx, n * n, sizeof *a);
  t->x0 = stf_allocate(t->ctx, 2 * n, sizeof *t->x0);
  for (int which = 0; which < 2 && a && t->x0; which++) {
    const SUNMatrix to = which ? t->linear.F : t->linear.E;
    stf_long_entries(which ? t->from->F : t->from->E, t->n, a);
    for (int i = 0; i < t->n; i++)
      for (int j = 0; j < t->n; j++)
        SM_ELEMENT_D(to, stf_turned_place(t, i), stf_turned_place(t, j)) =
          (sunrealtype)a[(size_t)i * n + (size_t)j];
  }
  stf_release(t->ctx, a);
  if (!a || !t->x0) return STEIF_NO_MEMORY;
  t->f = t->x0 + n;
  for (int m = 0; m < t->n; m++) t->x0[stf_turned_place(t, m)] = x0[m];
  if (t->from->f) t->linear.f = force, t->linear.user = t;
  STEIF_TRY(stf_apart_open(t->ctx, &t->linear, structure, &t->apart));
  if (t->apart.linear.E) stf_apart_enter(&t->apart, t->n, t->x0, t->apart.z0);
  return STEIF_OK;
}

int stf_turned_open(steif_context *ctx, const steif_linear *from,
                    const steif_structure *structure, const sunrealtype *x0, int turn,
                    stf_turned *t)
{
  *t = (stf_turned){.ctx = ctx, .from = from, .n = (int)structure->n, .turn = turn};
  const int code = fill(t, structure, x0);
  if (code) stf_turned_close(t);
  return code;
}

void stf_turned_close(stf_turned *t)
{
  if (!t->ctx) return;
  stf_apart_close(&t->apart);
  if (t->linear.E) SUNMatDestroy(t->linear.E);
  if (t->linear.F) SUNMatDestroy(t->linear.F);
  stf_release(t->ctx, t->x0);
  *t = (stf_turned){0};
}
