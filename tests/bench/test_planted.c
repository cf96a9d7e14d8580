/* test_planted.c: random pencils have the structure that they are made with, and no certificate says
 * otherwise. The whole campaign is `steif bench certificates`.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "planted.h"
#include "prime_field.h"
#include "suite.h"
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

/* By ranks of the whole numbers, which have no part in how these are made. */
static void whole_numbers_have_their_structure(void)
{
  static planted p;
  steif_context *ctx = steif_context_new(NULL);
  for (long seed = 1; seed <= 40; seed++) {
    sunindextype weyr[PLANTED_MOST], infinite = 0;
    int count;
    stf_field f;
    CHECK(!planted_new(ctx, PLANTED_WHOLE, seed, &p));
    const size_t size = (size_t)p.n * (size_t)p.n * sizeof *p.E;
    SUNMatrix E = SUNDenseMatrix(p.n, p.n, steif_sundials(ctx)), F = SUNMatClone(E);
    memcpy(SM_DATA_D(E), p.E, size), memcpy(SM_DATA_D(F), p.F, size);
    CHECK(!stf_field_open(ctx, E, F, false, &f));
    CHECK(!stf_field_chains(ctx, &f, PLANTED_MOST, weyr, &count) && count == p.index);
    for (int k = 0; k < count; k++) infinite += weyr[k];
    CHECK(p.n - infinite == p.finite);
    SUNMatDestroy(E), SUNMatDestroy(F);
  }
  steif_context_free(&ctx);
}

/* None wrong, and less than 1 in 100 not certified. */
static void certificates_are_right(void)
{
  static const long seeds[PLANTED_KINDS] = {400, 60, 60, 60};
  static planted p;
  planted_outcome out;
  steif_context *ctx = steif_context_new(NULL);
  for (int kind = 0; kind < PLANTED_KINDS; kind++) {
    long open = 0, cancel = 0, starts = 0;
    for (long seed = 1; seed <= seeds[kind]; seed++) {
      CHECK(!planted_new(ctx, (enum planted_kind)kind, seed, &p));
      CHECK(!planted_judge(ctx, (enum planted_kind)kind, &p, &out));
      CHECK(out.structure != PLANTED_WRONG && out.start != PLANTED_WRONG);
      open += out.structure == PLANTED_OPEN;
      cancel += !p.singular && out.cancels;
      starts += out.start == PLANTED_RIGHT;
      if (out.structure == PLANTED_WRONG || out.start == PLANTED_WRONG)
        printf("\n  %s %ld: %s", planted_name((enum planted_kind)kind), seed, out.message);
    }
    CHECK(100 * open < seeds[kind] && 2 * starts > seeds[kind]);
    CHECK(kind == PLANTED_PATTERN || cancel > 10); /* it is not the pattern that tells */
  }
  steif_context_free(&ctx);
}

/* Equations and unknowns in units of 2^-20 to 2^20, which rounds nothing. */
static void change_units(planted *p, stf_random *r)
{
  int row[PLANTED_MOST], column[PLANTED_MOST];
  for (int i = 0; i < p->n; i++) {
    row[i] = (int)stf_random_below(r, 41) - 20, column[i] = (int)stf_random_below(r, 41) - 20;
    p->before[i] = ldexp(p->before[i], -column[i]);
    p->after[i] = ldexp(p->after[i], -column[i]);
  }
  for (int k = 0; k < p->n * p->n; k++) {
    const int power = row[k % p->n] + column[k / p->n];
    p->E[k] = ldexp(p->E[k], power), p->F[k] = ldexp(p->F[k], power);
  }
}

/* What is said of the error of x(0+) holds in the units given, whatever they are. */
static void errors_in_mixed_units(void)
{
  static planted p;
  planted_outcome out;
  stf_random r = {.state = 12};
  long right = 0;
  steif_context *ctx = steif_context_new(NULL);
  for (long seed = 1; seed <= 150; seed++) {
    CHECK(!planted_new(ctx, PLANTED_DENSE, seed, &p));
    change_units(&p, &r);
    CHECK(!planted_judge(ctx, PLANTED_DENSE, &p, &out));
    CHECK(out.structure != PLANTED_WRONG && out.start != PLANTED_WRONG);
    if (out.start == PLANTED_WRONG) printf("\n  %ld: %g times the estimate", seed, out.off);
    right += out.start == PLANTED_RIGHT;
  }
  CHECK(right > 130);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_planted[] = {
  {"whole numbers have the structure that they are made with",
   whole_numbers_have_their_structure},
  {"errors in mixed units are those told", errors_in_mixed_units},
  {"no certificate of a random pencil is wrong, few are withheld", certificates_are_right},
  CU_TEST_INFO_NULL};
