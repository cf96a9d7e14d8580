/* test_scalar.c: phi functions of real and complex numbers.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gear.h"
#include "suite.h"

/* phi_0 .. phi_4; mpmath at 60 and 90 digits, printed to 17; 0 where the value is below the
 * range. */
static const struct {
  double x, y, re[5], im[5];
} rows[] = {
  {0.0, 0.0, {1, 1, 0.5, 0.16666666666666667, 0.041666666666666667}, {0, 0, 0, 0, 0}},
  {1e-12,
   0.0,
   {1.000000000001, 1.0000000000005, 0.50000000000016667, 0.16666666666670833,
    0.041666666666675},
   {0, 0, 0, 0, 0}},
  {-1e-12,
   0.0,
   {0.999999999999, 0.9999999999995, 0.49999999999983333, 0.166666666666625,
    0.041666666666658333},
   {0, 0, 0, 0, 0}},
  {-1e-08,
   0.0,
   {0.99999999000000005, 0.99999999500000002, 0.49999999833333334, 0.16666666625,
    0.041666666583333333},
   {0, 0, 0, 0, 0}},
  {-1e-05,
   0.0,
   {0.99999000004999983, 0.99999500001666662, 0.49999833333749999, 0.16666625000083333,
    0.041666583333472222},
   {0, 0, 0, 0, 0}},
  {-0.001,
   0.0,
   {0.99900049983337499, 0.99950016662500833, 0.49983337499166806, 0.16662500833194464,
    0.041658334722023834},
   {0, 0, 0, 0, 0}},
  {-0.1,
   0.0,
   {0.90483741803595957, 0.95162581964040427, 0.48374180359595732, 0.16258196404042684,
    0.040847026262398309},
   {0, 0, 0, 0, 0}},
  {-0.2,
   0.0,
   {0.81873075307798185, 0.9063462346100907, 0.46826882694954647, 0.15865586525226767,
    0.040054007071995002},
   {0, 0, 0, 0, 0}},
  {-0.5,
   0.0,
   {0.60653065971263342, 0.78693868057473315, 0.42612263885053369, 0.14775472229893261,
    0.037823888735468111},
   {0, 0, 0, 0, 0}},
  {-1.0,
   0.0,
   {0.36787944117144232, 0.63212055882855768, 0.36787944117144232, 0.13212055882855768,
    0.034546107838108988},
   {0, 0, 0, 0, 0}},
  {-2.0,
   0.0,
   {0.13533528323661269, 0.43233235838169365, 0.28383382080915317, 0.10808308959542341,
    0.029291788535621627},
   {0, 0, 0, 0, 0}},
  {-10.0,
   0.0,
   {4.5399929762484852e-5, 0.099995460007023752, 0.090000453999297625, 0.040999954600070238,
    0.012566671206659643},
   {0, 0, 0, 0, 0}},
  {-50.0,
   0.0,
   {1.9287498479639178e-22, 0.02, 0.0196, 0.009608, 0.0031411733333333333},
   {0, 0, 0, 0, 0}},
  {-1000.0, 0.0, {0, 0.001, 0.000999, 0.000499001, 0.00016616766566666667}, {0, 0, 0, 0, 0}},
  {-1000000.0,
   0.0,
   {0, 1.0e-6, 9.99999e-7, 4.99999000001e-7, 1.6666616666766667e-7},
   {0, 0, 0, 0, 0}},
  {0.5,
   0.0,
   {1.6487212707001281, 1.2974425414002563, 0.59488508280051259, 0.18977016560102517,
    0.046206997868717016},
   {0, 0, 0, 0, 0}},
  {1.0,
   0.0,
   {2.7182818284590452, 1.7182818284590452, 0.71828182845904524, 0.21828182845904524,
    0.051615161792378569},
   {0, 0, 0, 0, 0}},
  {2.0,
   0.0,
   {7.3890560989306502, 3.1945280494653251, 1.0972640247326626, 0.29863201236633128,
    0.065982672849832306},
   {0, 0, 0, 0, 0}},
  {10.0,
   0.0,
   {22026.465794806717, 2202.5465794806717, 220.15465794806717, 21.965465794806717,
    2.179879912814005},
   {0, 0, 0, 0, 0}},
  {50.0,
   0.0,
   {5.1847055285870725e+21, 1.0369411057174145e+20, 2.073882211434829e+18, 41477644228696580.0,
    829552884573931.59},
   {0, 0, 0, 0, 0}},
  {0.0,
   1.0,
   {0.54030230586813972, 0.84147098480789651, 0.45969769413186028, 0.15852901519210349,
    0.040302305868139717},
   {0.84147098480789651, 0.45969769413186028, 0.15852901519210349, 0.040302305868139717,
    0.0081376514745631733}},
  {0.0,
   10.0,
   {-0.83907152907645245, -0.054402111088936981, 0.018390715290764525, 0.01054402111088937,
    0.0048160928470923548},
   {-0.54402111088936981, 0.18390715290764525, 0.1054402111088937, 0.048160928470923548,
    0.01561226455557773}},
  {0.0,
   100.0,
   {0.86231887228768393, -0.0050636564110975879, 1.3768112771231607e-5, 0.00010050636564110976,
    4.9998623188722877e-5},
   {-0.50636564110975879, 0.0013768112771231607, 0.010050636564110976, 0.0049998623188722877,
    0.0016656616030102556}},
  {-1.0,
   10.0,
   {-0.30867716521951295, -0.0068580659146036958, 0.02299399304008634, 0.014464060196380505,
    0.0060865797349883101},
   {-0.20013418225944862, 0.13155352311341166, 0.098386407287451736, 0.046254194676353315,
    0.014611602673529785}},
  {-1e-06,
   1e-06,
   {0.999999, 0.9999995, 0.49999983333333333, 0.166666625, 0.041666658333333333},
   {9.9999900000033329e-7, 4.9999966666674998e-7, 1.6666658333334999e-7, 4.1666650000002776e-8,
    8.333330555555952e-9}},
};
enum { ROWS = sizeof rows / sizeof *rows };

static void values(void)
{
  for (int r = 0; r < ROWS; r++)
    for (int p = 0; p <= 4; p++) {
      double re[9], im[9];
      CHECK(!steif_phi_scalar(p, rows[r].x, rows[r].y, re, im));
      for (int k = 0; k <= p; k++) {
        const double size = hypot(rows[r].re[k], rows[r].im[k]);
        const double error = hypot(re[k] - rows[r].re[k], im[k] - rows[r].im[k]);
        if (error > 4 * U * size)
          printf("\n  phi_%d(%g + %g i): %.2e", k, rows[r].x, rows[r].y, error / size);
        CHECK(error <= 4 * U * size);
      }
    }
}

/* phi_k(z) - z phi_{k+1}(z) = 1/k!, on a grid over all branches of the evaluation; the terms
 * round on their own. */
static void recurrence(void)
{
  double factorial = 1;
  for (int k = 0; k < STEIF_PHI_MOST; k++, factorial *= k)
    for (double r = 1.3e-9; r < 4e8; r *= 3.7)
      for (double angle = 1.5707; angle < 4.8; angle += 0.39) {
        const double x = r * cos(angle), y = r * sin(angle);
        double re[9], im[9];
        if (x > 700) continue;
        CHECK(!steif_phi_scalar(STEIF_PHI_MOST, x, y, re, im));
        const double a = re[k] - x * re[k + 1] + y * im[k + 1];
        const double b = im[k] - x * im[k + 1] - y * re[k + 1];
        const double size = hypot(re[k], im[k]) + 2 * r * hypot(re[k + 1], im[k + 1]);
        CHECK(hypot(a - 1 / factorial, b) <= 5 * U * size);
      }
}

static void tiny_imaginary(void)
{
  double re[3], im[3];
  CHECK(!steif_phi_scalar(2, -1.75, 1e-180, re, im));
  /* Im phi_k(x + i y) = y phi_k'(x) + O(y^3), phi_1' = phi_1 - phi_2 here with
   * phi_k' = (z phi_k - k phi_k + 1/(k-1)!)/z. */
  CLOSE(im[1], 1e-180 * (-1.75 * re[1] - re[1] + 1) / -1.75, 1e-15);
  CLOSE(im[2], 1e-180 * (-1.75 * re[2] - 2 * re[2] + 1) / -1.75, 2e-15);
}

/* phi_1 = -1/z + e^z/z, phi_2 = -1/z - ..., where squares of z are out of range: -1/(-3 + 4 i) = 0.12 + 0.16 i. */
static void numbers_whose_squares_overflow(void)
{
  double re[3], im[3];
  CHECK(!steif_phi_scalar(2, -3e200, 4e200, re, im));
  CHECK(re[0] == 0 && im[0] == 0);
  for (int k = 1; k <= 2; k++) {
    CLOSE(re[k], 1.2e-201, 8 * U);
    CLOSE(im[k], 1.6e-201, 8 * U);
  }
}

static void refusals(void)
{
  double re[9], im[9];
  CHECK(steif_phi_scalar(9, 0.3, 0, re, im) == STEIF_BAD_INPUT);
  CHECK(steif_phi_scalar(-1, 0.3, 0, re, im) == STEIF_BAD_INPUT);
  CHECK(steif_phi_scalar(2, 0.3, 0.1, re, NULL) == STEIF_BAD_INPUT);
  CHECK(!steif_phi_scalar(2, 0.3, 0, re, NULL));
  CHECK(!steif_phi_scalar(3, NAN, 0, re, im) && isnan(re[0]) && isnan(im[3]));
  CHECK(!steif_phi_scalar(4, 715, 0, re, im));
  /* e^715 is out of range, phi_4(715) = (e^715 - 1 - ... )/715^4 is not: mpmath. */
  CHECK(isinf(re[0]) && !isnan(re[0]));
  CLOSE(re[4], 1.2686166108864938e299, 4 * U);
}

/* phi_{k+1} = (phi_k - 1/k!)/z in long double loses less than k/|z| of its digits: all around circles where the
 * library takes one way or the other. */
static void complex_numbers_of_all_sizes(void)
{
  for (double r = 8.5; r < 680; r *= 1.37)
    for (int m = 0; m < 24; m++) {
      const double x = r * cos(0.13 + m * 0.2618), y = r * sin(0.13 + m * 0.2618);
      double re[9], im[9];
      long double a = expl(x) * cosl(y), b = expl(x) * sinl(y), factorial = 1;
      CHECK(!steif_phi_scalar(4, x, y, re, im));
      for (int k = 0; k <= 4; k++) {
        const long double size = hypotl(a, b);
        CHECK(hypotl(re[k] - a, im[k] - b) <= 8 * U * size || size < 1e-300L);
        const long double c = a - 1 / factorial,
                          square = (long double)x * x + (long double)y * y;
        const long double next = (c * x + b * y) / square;
        b = (b * x - c * y) / square, a = next, factorial *= k + 1;
      }
    }
}

CU_TestInfo tests_of_scalar[] = {
  {"phi_0 to phi_4 are right to four units of round-off", values},
  {"the recurrence holds in the left half plane up to p = 8", recurrence},
  {"a tiny imaginary part keeps its digits", tiny_imaginary},
  {"wrong arguments are refused and overflow stays where it is", refusals},
  {"numbers whose squares overflow", numbers_whose_squares_overflow},
  {"complex numbers of all sizes", complex_numbers_of_all_sizes},
  CU_TEST_INFO_NULL};
