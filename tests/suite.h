/* suite.h: a few macros over CUnit. A file of tests ends with
 *
 *   CU_TestInfo tests_of_nodes[] = {{"nodes integrate exactly", nodes_integrate}, CU_TEST_INFO_NULL};
 *
 * and the room's main.c lists such tables:
 *
 *   extern CU_TestInfo tests_of_nodes[];
 *   SUITE_MAIN({.pName = "nodes", .pTests = tests_of_nodes})
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SUITE_H
#define SUITE_H

#include <CUnit/Basic.h>
#include <math.h>
#include <stdio.h>

/* |value - expected| <= tolerance * max(|expected|, floor); says what it saw. */
#define CLOSE(value, expected, tolerance) CLOSE_FLOOR(value, expected, tolerance, 0)
#define CLOSE_FLOOR(value, expected, tolerance, floor_)                                        \
  do {                                                                                         \
    const double v_ = (value), e_ = (expected);                                                \
    const double f_ = fabs(e_) > (floor_) ? fabs(e_) : (floor_);                               \
    const int good_ = fabs(v_ - e_) <= (tolerance)*f_;                                         \
    if (!good_)                                                                                \
      printf("\n  %s:%d: %s = %.17g, expected %.17g, off by %.2e", __FILE__, __LINE__, #value, \
             v_, e_, f_ > 0 ? fabs(v_ - e_) / f_ : fabs(v_ - e_));                             \
    CU_ASSERT(good_);                                                                          \
  } while (0)

#define CHECK(condition)                                                                       \
  do {                                                                                         \
    const int good_ = !!(condition);                                                           \
    if (!good_) printf("\n  %s:%d: %s does not hold", __FILE__, __LINE__, #condition);         \
    CU_ASSERT(good_);                                                                          \
  } while (0)

#define SUITE_MAIN(...)                                                                        \
  int main(void)                                                                               \
  {                                                                                            \
    CU_SuiteInfo suites[] = {__VA_ARGS__, CU_SUITE_INFO_NULL};                                 \
    if (CU_initialize_registry() || CU_register_suites(suites)) return 1;                      \
    CU_basic_set_mode(CU_BRM_NORMAL);                                                          \
    CU_basic_run_tests();                                                                      \
    const unsigned failures = CU_get_number_of_failures();                                     \
    CU_cleanup_registry();                                                                     \
    return failures != 0;                                                                      \
  }

#endif
