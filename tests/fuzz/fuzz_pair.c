/* fuzz_pair.c: any numbers as a pencil of order 1 to 6, dense or sparse: the analysis answers, an index
 * that is claimed is one of the order, and x(0+) of a certified answer satisfies its own equations.
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

/* Few values, so that ranks are met that are not full, and sizes that are far apart. */
static double value(uint8_t b)
{
  static const double small[] = {0,    0, 0,   0,    0,   1,    -1,    2,
                                 -0.5, 3, 1e3, 1e-3, 1e8, 1e-8, 1e150, 1e-150};
  return b < 128 ? 0 : b < 240 ? small[b % 10] : small[b % 16];
}

static void solve(steif_context *ctx, SUNMatrix E, SUNMatrix F, const double *x0,
                  const steif_analysis *a, int n)
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
    if (i.certified && (!(i.first < 1e-4) || !(i.chain < 1e-4) || !(i.last < 1e-4))) abort();
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
    if (Es && Fs) solve(ctx, Es, Fs, x0, &a, n);
    if (Es) SUNMatDestroy(Es);
    if (Fs) SUNMatDestroy(Fs);
  } else {
    solve(ctx, E, F, x0, &a, n);
  }
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
  return 0;
}
