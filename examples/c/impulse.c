/* An impulse: a switch connects two capacitors of 2 and 3 uF, charged to 5 and 1 V, by a wire.
 *
 *   C1 v1' + i = 0,   C2 v2' - i = 0,   v1 - v2 = 0:     E x' + F x = 0, x = (v1, v2, i), index 2.
 *
 * The values before contradict the third equation. The voltages jump to the common value, and the charge
 * that levels them passes in no time: i holds an impulse. No step size resolves that; steif_impulse_find
 * computes the values after the jump and the strength of the impulse from the matrices themselves.
 * Known: charge is kept, v = (2*5 + 3*1)/5 = 2.6 V, and 2 uF (5 - 2.6) V = 4.8 uC pass.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <sunmatrix/sunmatrix_dense.h>

int main(void)
{
  const double C1 = 2e-6, C2 = 3e-6, before[] = {5, 1, 0};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = SUNDenseMatrix(3, 3, steif_sundials(ctx));
  SUNMatrix F = SUNDenseMatrix(3, 3, steif_sundials(ctx));
  if (!E || !F) return 1;
  SUNMatZero(E), SUNMatZero(F);
  SM_ELEMENT_D(E, 0, 0) = C1, SM_ELEMENT_D(F, 0, 2) = 1;
  SM_ELEMENT_D(E, 1, 1) = C2, SM_ELEMENT_D(F, 1, 2) = -1;
  SM_ELEMENT_D(F, 2, 0) = 1, SM_ELEMENT_D(F, 2, 1) = -1;

  static const char *const unknown[] = {"v1", "v2", "i"};
  static const steif_names names = {NULL, unknown};
  const steif_analysis analysis = {.names = &names};
  steif_structure structure;
  steif_impulse a;
  int wrong = 1;
  if (steif_structure_find(ctx, E, F, &analysis, &structure) == STEIF_OK) {
    puts(structure.message);
    if (steif_impulse_find(ctx, E, F, before, 0, NULL, NULL, &analysis, &structure, &a) ==
        STEIF_OK) {
      printf("%s\n", a.message);
      for (int i = 0; i < 3; i++)
        printf("%-2s  before %g, after %.12g, impulse %.12g\n", unknown[i], before[i],
               a.x_plus[i], a.c[i]);
      wrong = !a.certified || !(fabs(a.x_plus[0] - 2.6) < 1e-12) ||
              !(fabs(a.x_plus[1] - 2.6) < 1e-12) || !(fabs(a.c[2] - 4.8e-6) < 1e-17);
      steif_impulse_clear(ctx, &a);
    }
    steif_structure_clear(ctx, &structure);
  }
  puts(steif_message(ctx));
  SUNMatDestroy(E);
  SUNMatDestroy(F);
  steif_context_free(&ctx);
  return wrong;
}
