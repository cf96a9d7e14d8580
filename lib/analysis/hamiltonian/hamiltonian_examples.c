/* hamiltonian_examples.c: small linear systems with known answers to the questions of hamiltonian.h.
 * SPDX-License-Identifier: BSD-3-Clause */
#include <steif/hamiltonian.h>

/* By columns, written by rows of the transpose. */
#define M(...) ((const double[]){__VA_ARGS__})

static const steif_hamiltonian_example examples[] = {
  {"rotation", "q' = 2 p, p' = -2 q", 2, M(0, -2, 2, 0), 1, 1, 1, 1, 1},
  {"oscillator", "q'' = -4 q", 2, M(0, -4, 1, 0), 1, 1, 1, 1, 1},
  {"damped", "q'' = -4 q - q'/2: the trace is not 0", 2, M(0, -4, 1, -0.5), 0, 0, 0, 0, 0},
  {"saddle", "diag(1, -1), H = q p", 2, M(1, 0, 0, -1), 0, 1, 1, 1, 1},
  {"resonance", "eigenvalues i, i and -i, -i in Jordan blocks", 4,
   M(0, -1, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 1, 1, 0), 0, 1, 1, 1, 2},
  {"free", "q' = p, p' = 0, H = p^2/2", 2, M(0, 0, 1, 0), 0, 0, 1, 1, 1},
  {"spin", "rotation about (1, 2, 2): odd order", 3, M(0, 2, -2, -2, 0, 1, 2, -1, 0), 1, 1, 0,
   1, 2},
  {"decaying", "a rotation and a decay", 3, M(0, -1, 0, 1, 0, 0, 0, 0, -1), 0, 0, 0, 1, 1},
  {"nilpotent3", "a Jordan block of size 3 at 0", 3, M(0, 0, 0, 1, 0, 0, 0, 1, 0), 0, 1, 0, 1,
   2},
  {"legs4", "HiPPO-LegS: eigenvalues -1 to -4", 4,
   M(-1, -1.7320508075688772, -2.23606797749979, -2.6457513110645907, 0, -2, -3.872983346207417,
     -4.58257569495584, 0, 0, -3, -5.916079783099616, 0, 0, 0, -4),
   0, 0, 0, 0, 0},
  {"masses", "M q'' + K q = 0, M = diag(1, 2), K = [3 -1; -1 2]", 4,
   M(0, 0, -3, 1, 0, 0, 1, -2, 1, 0, 0, 0, 0, 0.5, 0, 0), 1, 1, 1, 1, 2},
  {"spirals", "diag(R, -R^T), R = [1 2; -2 1]: eigenvalues +-1 +- 2i", 4,
   M(1, -2, 0, 0, 2, 1, 0, 0, 0, 0, -1, -2, 0, 0, 2, -1), 0, 1, 1, 1, 2},
  {"pair", "two equal rotations", 4, M(0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0), 1, 1,
   1, 1, 4},
  {"barely", "q'' = -4 q - 1e-9 q'", 2, M(0, -4, 1, -1e-9), 0, 0, 0, 0, 0},
  {"gyroscope3", "q'' = q + 3 J q': gyroscopically stable, its energy is indefinite", 4,
   M(0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, -3, 0, 1, 3, 0), 1, 1, 1, 1, 2},
  {"gyroscope1", "q'' = q + J q': not stabilised", 4,
   M(0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, -1, 0, 1, 1, 0), 0, 1, 1, 1, 2},
  {"zero2", "A = 0", 2, M(0, 0, 0, 0), 1, 1, 1, 1, 3},
  {"nilpotent22", "two Jordan blocks of size 2 at 0", 4,
   M(0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0), 0, 1, 1, 1, 4},
  {"mirrored", "diag(1, 2, -1, -2)", 4, M(1, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1, 0, 0, 0, 0, -2), 0,
   1, 1, 1, 2},
  {"unmirrored", "diag(1, 1, -1, -2)", 4, M(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -2),
   0, 0, 0, 1, 2},
  {"resting", "a rotation and two states at rest", 4,
   M(0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0), 1, 1, 1, 1, 4},
  {"gyroscope2", "q'' = q + 2 J q': Krein's collision at +-i", 4,
   M(0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, -2, 0, 1, 2, 0), 0, 1, 1, 1, 2},
};

const steif_hamiltonian_example *steif_hamiltonian_example_at(size_t i)
{
  return i < sizeof examples / sizeof *examples ? &examples[i] : 0;
}
