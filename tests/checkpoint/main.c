/* Runs that go on. That every method does so bit for bit is a law: tests/laws/law_checkpoint.c.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_files[], tests_of_members[], tests_of_further[],
  tests_of_plain_calls[], tests_of_threads[];

SUITE_MAIN({.pName = "files", .pTests = tests_of_files},
           {.pName = "members", .pTests = tests_of_members},
           {.pName = "further", .pTests = tests_of_further},
           {.pName = "plain calls", .pTests = tests_of_plain_calls},
           {.pName = "threads", .pTests = tests_of_threads})
