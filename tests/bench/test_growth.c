/* test_growth.c: exponents of costs over sizes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include "impulse_cost.h"
#include <string.h>

static steif_bench_impulse row_of(const char *problem, sunindextype n, double cpu, double floor)
{
  steif_bench_impulse row = {.n = n, .cpu_s = cpu, .floor_s = floor};
  snprintf(row.problem, sizeof row.problem, "%s", problem);
  return row;
}

/* c n^p gives p back, each family by its own rows. */
static void powers_are_found(void)
{
  steif_bench_impulse row[6];
  for (int i = 0; i < 3; i++) {
    const double n = pow(10, 3 + i);
    row[2 * i] = row_of("ladder:n=5", (sunindextype)n, 3e-6 * pow(n, 1.125), 2e-6 * n);
    row[2 * i + 1] = row_of("lad:n=7", (sunindextype)(2 * n), 5e-6 * pow(2 * n, 0.75), 7e-6);
  }
  const steif_bench_growth one = steif_bench_exponents(row, 6, 2),
                           two = steif_bench_exponents(row, 6, 1);
  CHECK(one.rows == 3 && two.rows == 3 && !strcmp(one.family, "ladder") &&
        !strcmp(two.family, "lad"));
  CLOSE(one.cpu, 1.125, 1e-12);
  CLOSE(one.floor, 1, 1e-12);
  CLOSE(two.cpu, 0.75, 1e-12);
  CLOSE_FLOOR(two.floor, 0, 1e-12, 1);
  CHECK(isnan(steif_bench_exponents(row, 1, 0).cpu));
}

CU_TestInfo tests_of_growth[] = {{"exponents of powers are found", powers_are_found},
                                 CU_TEST_INFO_NULL};
