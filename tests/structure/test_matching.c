/* test_matching.c: structural rank, degree, index and offenders against all permutations.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "generated.h"
#include "structural.h"
#include "impulse/systems.h"

enum { MOST = 7, NONE = -100 };

/* kind[i][j]: 2 entry of E, 1 of F only, 0 none. */
typedef struct board {
  int n, kind[MOST][MOST];
} board;

/* Most rows matched, and if all the largest number of entries of E; rows and columns but `skip`. */
static void all_permutations(const board *b, int i, unsigned used, int rank, int degree,
                             int skip_row, int skip_column, int *best_rank, int *best_degree)
{
  if (i == b->n) {
    if (rank > *best_rank) *best_rank = rank;
    if (rank == b->n - (skip_row >= 0) && degree > *best_degree) *best_degree = degree;
    return;
  }
  all_permutations(b, i + 1, used, rank, degree, skip_row, skip_column, best_rank, best_degree);
  if (i == skip_row) return;
  for (int j = 0; j < b->n; j++)
    if (b->kind[i][j] && j != skip_column && !(used >> j & 1))
      all_permutations(b, i + 1, used | 1u << j, rank + 1, degree + (b->kind[i][j] == 2),
                       skip_row, skip_column, best_rank, best_degree);
}

static void brute(const board *b, int skip_row, int skip_column, int *rank, int *degree)
{
  *rank = 0;
  *degree = NONE;
  all_permutations(b, 0, 0, 0, 0, skip_row, skip_column, rank, degree);
}

typedef struct outcome {
  steif_context *ctx;
  SUNMatrix E, F;
  sunindextype rank, index;
  steif_structure structure;
} outcome;

static void match(const board *b, outcome *f)
{
  double E[MOST * MOST], F[MOST * MOST];
  for (int i = 0; i < b->n; i++)
    for (int j = 0; j < b->n; j++) {
      E[i * b->n + j] = b->kind[i][j] == 2 ? 1.75 : 0;
      F[i * b->n + j] = b->kind[i][j] == 1 || (b->kind[i][j] == 2 && j % 2) ? -0.625 : 0;
    }
  memset(f, 0, sizeof *f);
  f->ctx = steif_context_new(NULL);
  f->E = system_dense(f->ctx, b->n, E);
  f->F = system_dense(f->ctx, b->n, F);
  CHECK(stf_structural_index(f->ctx, f->E, f->F, &f->rank, &f->index, &f->structure) ==
        STEIF_OK);
}

static void drop(outcome *f)
{
  steif_structure_clear(f->ctx, &f->structure);
  SUNMatDestroy(f->E);
  SUNMatDestroy(f->F);
  steif_context_free(&f->ctx);
}

static bool listed(sunindextype count, const sunindextype *list, int item)
{
  for (sunindextype k = 0; k < count; k++)
    if (list[k] == item) return true;
  return false;
}

/* An unknown (equation) is to blame when its row (column) of the inverse may grow with s: when a
 * minor without it has a larger degree than the whole. */
static void compare_minors(const board *b, int degree, const outcome *f)
{
  int highest = -1;
  for (int k = 0; k < b->n; k++) {
    int unknown = NONE, equation = NONE, rank, minor;
    for (int m = 0; m < b->n; m++) {
      brute(b, m, k, &rank, &minor);
      if (minor - degree > unknown) unknown = minor - degree;
      brute(b, k, m, &rank, &minor);
      if (minor - degree > equation) equation = minor - degree;
    }
    if (unknown > highest) highest = unknown;
    CHECK(listed(f->structure.unknowns_count, f->structure.unknowns, k) == (unknown > 0));
    CHECK(listed(f->structure.equations_count, f->structure.equations, k) == (equation > 0));
  }
  CHECK(f->index == highest + 1);
}

static int random_boards(int n, double density, int rounds, stf_random *r)
{
  int perfect = 0;
  for (int round = 0; round < rounds; round++) {
    board b = {.n = n};
    outcome f;
    int rank, degree;
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++)
        if (stf_random_in(r, 0, 1) < density)
          b.kind[i][j] = stf_random_in(r, 0, 1) < 0.4 ? 2 : 1;
    brute(&b, -1, -1, &rank, &degree);
    match(&b, &f);
    CHECK(f.rank == rank);
    CHECK(f.structure.degree == (rank == n ? degree : -1));
    if (rank == n && n < MOST) compare_minors(&b, degree, &f);
    perfect += rank == n;
    drop(&f);
  }
  return perfect;
}

static void against_permutations(void)
{
  stf_random r = {20011u};
  int perfect = 0;
  for (int n = 1; n < MOST; n++) perfect += random_boards(n, 0.5, 40, &r);
  perfect += random_boards(MOST, 0.35, 60, &r);
  perfect += random_boards(MOST, 0.6, 20, &r);
  CHECK(perfect > 60 && perfect < 300);
}

/* A Jordan block N x' + x of order n: degree 0, index n, x_1 depends on the last equation by
 * s^{n-1}. */
static void jordan_block(void)
{
  board b = {.n = MOST};
  outcome f;
  for (int i = 0; i < MOST; i++) b.kind[i][i] = 1;
  for (int i = 0; i + 1 < MOST; i++) b.kind[i][i + 1] = 2;
  match(&b, &f);
  CHECK(f.rank == MOST && f.structure.degree == 0 && f.index == MOST);
  CHECK(f.structure.unknowns_count == MOST - 1 && f.structure.unknowns[0] == 0);
  CHECK(f.structure.equations_count == MOST - 1 && f.structure.equations[0] == 1);
  drop(&f);
}

/* Equations 1 and 2 hold the unknown 2 alone; unknowns 0 and 1 are in equation 0 alone: the blocks
 * L_1 and L_1^T of Kronecker's form. */
static void kronecker_blocks(void)
{
  const board b = {3, {{2, 1, 0}, {0, 0, 2}, {0, 0, 1}}};
  outcome f;
  match(&b, &f);
  CHECK(f.rank == 2 && f.structure.degree == -1 && f.index == -1);
  CHECK(f.structure.equations_count == 2 && f.structure.unknowns_count == 2);
  CHECK(f.structure.equations[0] == 1 && f.structure.equations[1] == 2);
  CHECK(f.structure.unknowns[0] == 0 && f.structure.unknowns[1] == 1);
  drop(&f);
}

/* x1' + x1 = f1, x1 + x2 = f2 has index 1; entries that are stored but zero do not count: with them
 * E would have degree 2. */
static void stored_zeros(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const double e[4] = {1.5, 0.25, 0.375, 0.75}, f[4] = {1.25, 0, 2.5, 0.5};
  SUNMatrix E = system_dense(ctx, 2, e), F = system_dense(ctx, 2, f);
  for (int k = 1; k < 4; k++) SM_DATA_S(E)[k] = 0;
  steif_structure s = {0};
  sunindextype rank, index;
  CHECK(stf_structural_index(ctx, E, F, &rank, &index, &s) == STEIF_OK);
  CHECK(rank == 2 && s.degree == 1 && index == 1);
  CHECK(s.equations_count == 0 && s.unknowns_count == 0);
  steif_structure_clear(ctx, &s);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

/* Degrees of the collection's systems: numbers of finite eigenvalues by their formulas, faces less
 * cells, twice masses less constraints, capacitors and inductors that are not tied. */
static void collection_degrees(void)
{
  static const struct {
    const char *spec;
    int degree, index, equations;
  } known[] = {{"stokes:m=16", 225, 2, 255},
               {"springs:n=200,c=20", 360, 3, 0},
               {"ladder:n=200", 398, 2, 41},
               {"ladder:n=5000", 9998, 2, 1001},
               {"hidden:lambda=1e6", 361, 3, 0}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    system_ s;
    steif_structure found = {0};
    sunindextype rank, index;
    system_open(&s, NULL, known[i].spec);
    CHECK(stf_structural_index(s.ctx, s.E, s.F, &rank, &index, &found) == STEIF_OK);
    CHECK(rank == s.n);
    CHECK(found.degree == known[i].degree);
    CHECK(index == known[i].index);
    if (known[i].equations) CHECK(found.equations_count == known[i].equations);
    steif_structure_clear(s.ctx, &found);
    system_close(&s);
  }
}

static void no_memory(void)
{
  failing fails = {0};
  const steif_setup setup = failing_setup(&fails);
  steif_context *ctx = steif_context_new(&setup);
  const double e[9] = {0, 2.5, 0, 0, 0, 1.5, 0, 0, 0}, f[9] = {1, 0, 0, 0, 3, 0, 0, 0, 2};
  SUNMatrix E = system_dense(ctx, 3, e), F = system_dense(ctx, 3, f);
  const long alive = fails.alive;
  int code = STEIF_NO_MEMORY;
  for (long k = 1; code == STEIF_NO_MEMORY && k < 100; k++) {
    steif_structure s = {0};
    sunindextype rank;
    fails.refuse_at = fails.served + k;
    code = stf_structural_rank(ctx, E, F, &rank, &s);
    CHECK(code == STEIF_OK ? s.degree == 0 && rank == 3 : k < 90);
    steif_structure_clear(ctx, &s);
    CHECK(fails.alive == alive);
  }
  CHECK(code == STEIF_OK);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_matching[] = {
  {"rank, degree, index and offenders are those of all permutations", against_permutations},
  {"a Jordan block has degree 0 and its order for index", jordan_block},
  {"equations too many and too few are told apart", kronecker_blocks},
  {"stored zeros are no entries", stored_zeros},
  {"degrees of the collection equal their numbers of finite eigenvalues", collection_degrees},
  {"no memory at any place leaves nothing behind", no_memory},
  CU_TEST_INFO_NULL};
