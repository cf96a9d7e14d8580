/* test_weyr.c: Weyr characteristics and Jordan blocks from dimensions of kernels, and those
 * dimensions by ranks over a prime field.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "prime_field.h"
#include "suite.h"
#include "weyr.h"
#include <sunmatrix/sunmatrix_dense.h>

/* dim ker N^level of Jordan blocks: the sum of min(size, level). Ended by 0. */
static int of_blocks(void *data, int level, sunindextype *dimension)
{
  *dimension = 0;
  for (const int *size = data; *size; size++) *dimension += *size < level ? *size : level;
  return STEIF_OK;
}

static int undecided(void *data, int level, sunindextype *dimension)
{
  *dimension = level < *(int *)data ? level : -1;
  return STEIF_OK;
}

static int failing(void *data, int level, sunindextype *dimension)
{
  (void)data, (void)level, (void)dimension;
  return STEIF_NO_MEMORY;
}

static void blocks_come_back(void)
{
  int size[] = {5, 3, 3, 1, 0};
  sunindextype weyr[8];
  const sunindextype known[] = {4, 3, 3, 1, 1};
  int count;
  bool complete;
  CHECK(!stf_weyr_find(of_blocks, size, 12, 8, weyr, &count, &complete));
  CHECK(complete && count == 5);
  for (int k = 0; k < 5; k++) CHECK(weyr[k] == known[k]);
  for (int b = 0; b < 5; b++) CHECK(stf_weyr_block(weyr, count, b) == size[b]);
  CHECK(!stf_weyr_find(of_blocks, size, 12, 4, weyr, &count, &complete));
  CHECK(!complete && count == 4);
}

static void a_kernel_that_grows_no_more_ends_it(void)
{
  int size[] = {2, 1, 0}, decided = 3, count;
  sunindextype weyr[8];
  bool complete;
  CHECK(!stf_weyr_find(of_blocks, size, 5, 8, weyr, &count, &complete));
  CHECK(!complete && count == 2 && weyr[0] == 2 && weyr[1] == 1);
  CHECK(!stf_weyr_find(undecided, &decided, 5, 8, weyr, &count, &complete));
  CHECK(!complete && count == 2);
  CHECK(stf_weyr_find(failing, NULL, 5, 8, weyr, &count, &complete) == STEIF_NO_MEMORY);
  CHECK(!stf_weyr_find(failing, NULL, 0, 8, weyr, &count, &complete) && complete && !count);
}

typedef struct pencil {
  steif_context *ctx;
  SUNMatrix E, F;
  stf_field field;
} pencil;

static int by_ranks(void *data, int level, sunindextype *dimension)
{
  const pencil *p = data;
  sunindextype rank;
  CHECK(!stf_field_rank(p->ctx, &p->field, level, 1, &rank));
  *dimension = level * SM_COLUMNS_D(p->E) - rank;
  return STEIF_OK;
}

/* diag(N_3, N_2, 1), diag(I, 7), with rows and columns of N_3 added to others: by hand 2, 2, 1. */
static void ranks_give_the_chains_at_infinity(void)
{
  enum { N = 6 };
  pencil p = {.ctx = steif_context_new(NULL)};
  p.E = SUNDenseMatrix(N, N, steif_sundials(p.ctx));
  p.F = SUNDenseMatrix(N, N, steif_sundials(p.ctx));
  for (int i = 0; i < N; i++) SM_ELEMENT_D(p.F, i, i) = i < 5 ? 1 : 7;
  SM_ELEMENT_D(p.E, 0, 1) = SM_ELEMENT_D(p.E, 1, 2) = SM_ELEMENT_D(p.E, 3, 4) = 1;
  SM_ELEMENT_D(p.E, 5, 5) = 1;
  for (int j = 0; j < N; j++) { /* row 6 += 3 row 1, row 4 -= row 2 */
    SM_ELEMENT_D(p.E, 5, j) += 3 * SM_ELEMENT_D(p.E, 0, j);
    SM_ELEMENT_D(p.F, 5, j) += 3 * SM_ELEMENT_D(p.F, 0, j);
    SM_ELEMENT_D(p.E, 3, j) -= SM_ELEMENT_D(p.E, 1, j);
    SM_ELEMENT_D(p.F, 3, j) -= SM_ELEMENT_D(p.F, 1, j);
  }
  for (int i = 0; i < N; i++) { /* column 5 += column 3 / 8 */
    SM_ELEMENT_D(p.E, i, 4) += SM_ELEMENT_D(p.E, i, 2) / 8;
    SM_ELEMENT_D(p.F, i, 4) += SM_ELEMENT_D(p.F, i, 2) / 8;
  }
  sunindextype weyr[N];
  int count;
  bool complete, singular;
  CHECK(!stf_field_open(p.ctx, p.E, p.F, false, &p.field));
  CHECK(!stf_weyr_find(by_ranks, &p, 5, N, weyr, &count, &complete));
  CHECK(complete && count == 3 && weyr[0] == 2 && weyr[1] == 2 && weyr[2] == 1);
  CHECK(!stf_field_chains(p.ctx, &p.field, N, weyr, &count));
  CHECK(count == 3 && weyr[0] == 2 && weyr[1] == 2 && weyr[2] == 1);
  CHECK(!stf_field_chains(p.ctx, &p.field, 2, weyr, &count) && count == -1);
  CHECK(!stf_field_singular(p.ctx, &p.field, &singular) && !singular);
  for (int i = 0; i < N; i++) { /* unknown 2 as unknown 1 times -1 in all equations */
    SM_ELEMENT_D(p.E, i, 1) = -SM_ELEMENT_D(p.E, i, 0);
    SM_ELEMENT_D(p.F, i, 1) = -SM_ELEMENT_D(p.F, i, 0);
  }
  unsigned char in_kernel[N] = {0};
  CHECK(!stf_field_singular(p.ctx, &p.field, &singular) && singular);
  CHECK(!stf_field_kernel(p.ctx, &p.field, in_kernel));
  for (int j = 0; j < N; j++) CHECK(in_kernel[j] == (j < 2));
  SUNMatDestroy(p.E), SUNMatDestroy(p.F);
  steif_context_free(&p.ctx);
}

CU_TestInfo tests_of_weyr[] = {
  {"Jordan blocks come back from their kernels", blocks_come_back},
  {"a kernel that grows no more ends the characteristic", a_kernel_that_grows_no_more_ends_it},
  {"ranks over a prime field give the chains at infinity", ranks_give_the_chains_at_infinity},
  CU_TEST_INFO_NULL};
