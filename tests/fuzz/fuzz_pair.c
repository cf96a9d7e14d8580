/* fuzz_pair.c: any numbers as a pencil of order 1 to 6, dense or sparse: the analysis answers, an index
 * that is claimed is one of the order, and a certified answer satisfies F c_0 + E (x(0+) - x(0-)) = 0.
 *   cmake -DSTEIF_FUZZ=ON -DCMAKE_C_COMPILER=clang ..., then ./fuzz_pair -max_total_time=60
 * SPDX-License-Identifier: BSD-3-Clause */
#include "linear_system.h"
#include <math.h>
#include <steif/impulse.h>
#include <stdint.h>
#include <stdlib.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Few values, so that ranks are met that are not full. */
static double value(uint8_t b)
{
  static const double some[] = {0, 0, 1, -1, 2, -0.5, 3, 1e3, 1e-3, 0};
  return b < 128 ? 0 : some[b % 10];
}

/* To rounding of the terms, by a wide margin: x0 and c_0 of the answer in the dense E and F. */
static void balanced(SUNMatrix E, SUNMatrix F, const double *x0, const steif_impulse *i, int n)
{
  for (int row = 0; row < n; row++) {
    double sum = 0, size = 0, rest = 0;
    for (int j = 0; j < n; j++) {
      const double e = SM_ELEMENT_D(E, row, j), f = SM_ELEMENT_D(F, row, j);
      const double c = i->count ? i->c[j] : 0;
      sum += e * (i->x_plus[j] - x0[j]) + f * c;
      size += fabs(e) * (fabs(i->x_plus[j]) + fabs(x0[j])) + fabs(f * c);
      rest = fmax(rest, fabs(i->x_plus[j]) + fabs(x0[j]) + fabs(c));
    }
    if (!(fabs(sum) <= 1e-5 * (size + 1e3 * rest))) abort();
  }
}

static void solve(steif_context *ctx, SUNMatrix E, SUNMatrix F, SUNMatrix full[2],
                  const double *x0, const steif_analysis *a, int n)
{
  steif_structure s;
  steif_impulse i;
  steif_forget(ctx);
  const int code = steif_structure_find(ctx, E, F, a, &s);
  if (code) {
    if (!steif_status(ctx)) abort();
    return;
  }
  if (s.index > n || s.index_least > n || s.finite > n || !*s.message) abort();
  if (!steif_impulse_find(ctx, E, F, x0, 0, NULL, NULL, a, &s, &i)) {
    if (i.certified) balanced(full[0], full[1], x0, &i, n);
    steif_impulse_clear(ctx, &i);
  }
  steif_structure_clear(ctx, &s);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  if (size < 4) return 0;
  const int n = 1 + data[0] % 6;
  const size_t entries = (size_t)(n * n);
  if (size < 2 + 2 * entries) return 0;
  double x0[6];
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = SUNDenseMatrix(n, n, steif_sundials(ctx)), F = SUNMatClone(E);
  for (size_t k = 0; k < entries; k++) {
    SM_DATA_D(E)[k] = value(data[2 + k]);
    SM_DATA_D(F)[k] = value(data[2 + entries + k]);
  }
  for (int i = 0; i < n; i++) x0[i] = 1 + i;
  const enum steif_algorithm algorithm = data[1] % 4;
  const steif_analysis a = {.algorithm = algorithm};
  if (algorithm == STEIF_CONTOUR) {
    SUNMatrix Es = SUNSparseFromDenseMatrix(E, 0, CSC_MAT),
              Fs = SUNSparseFromDenseMatrix(F, 0, CSC_MAT);
    if (Es && Fs) solve(ctx, Es, Fs, (SUNMatrix[]){E, F}, x0, &a, n);
    if (Es) SUNMatDestroy(Es);
    if (Fs) SUNMatDestroy(Fs);
  } else {
    solve(ctx, E, F, (SUNMatrix[]){E, F}, x0, &a, n);
  }
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
  return 0;
}
