/* test_circle.c: circles by batches of nodes: threads, and nodes at which pivots fail.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "circle.h"
#include "impulse/crew.h"
#include "impulse/systems.h"

static void found(system_ *s, const steif_analysis *analysis, steif_structure *structure,
                  steif_impulse *impulse)
{
  memset(structure, 0, sizeof *structure), memset(impulse, 0, sizeof *impulse);
  CU_ASSERT_FATAL(system_structure(s, analysis, structure) == STEIF_OK);
  CU_ASSERT_FATAL(system_start(s, analysis, structure, impulse) == STEIF_OK);
}

/* 20 nodes: the last batch of each circle is not full. */
static void threads_agree(void)
{
  steif_structure a, b;
  steif_impulse x, y;
  system_ s, t;
  const steif_analysis analysis = {.points = 40};
  system_open(&s, &(steif_setup){.threads = 1}, "springs:n=1000,c=100");
  found(&s, &analysis, &a, &x);
  const size_t n = (size_t)s.n, bytes = n * sizeof *x.c;
  for (int threads = 2; threads < 8; threads += 5) {
    system_open(&t, &(steif_setup){.threads = threads}, "springs:n=1000,c=100");
    found(&t, &analysis, &b, &y);
    CHECK(!memcmp(x.x_plus, y.x_plus, bytes) && !memcmp(x.c, y.c, 2 * bytes));
    CHECK(a.count == b.count && a.gap == b.gap && a.cost.solves == b.cost.solves);
    CHECK(a.cost.refactors == b.cost.refactors && x.estimate == y.estimate);
    steif_impulse_clear(t.ctx, &y);
    steif_structure_clear(t.ctx, &b);
    system_close(&t);
  }
  steif_impulse_clear(s.ctx, &x);
  steif_structure_clear(s.ctx, &a);
  system_close(&s);
}

enum { PAIRS = 3, N = 2 * PAIRS + 1 };

/* Pairs [s - c, -d; d, s - c] under one constraint w . x = 0 with its multiplier, which are
 * eliminated last: at c + d i the second pivot of a pair vanishes, not the determinant. */
static void constrained(system_ *s, const steif_shift *pair)
{
  memset(s, 0, sizeof *s);
  s->ctx = steif_context_new(NULL);
  s->n = N;
  SUNMatrix E = SUNDenseMatrix(N, N, steif_sundials(s->ctx)), F = SUNMatClone(E);
  SUNMatZero(E), SUNMatZero(F);
  s->Ex0 = stf_allocate(s->ctx, N, sizeof *s->Ex0);
  for (int i = 0; i < 2 * PAIRS; i++) {
    SM_ELEMENT_D(E, i, i) = 1, SM_ELEMENT_D(F, i, i) = -pair[i / 2].re;
    SM_ELEMENT_D(F, i, i ^ 1) = i % 2 ? pair[i / 2].im : -pair[i / 2].im;
    SM_ELEMENT_D(F, N - 1, i) = 0.7 + 0.2 * i, SM_ELEMENT_D(F, i, N - 1) = 1.1 - 0.3 * i;
    s->Ex0[i] = 1.3 - 0.4 * i;
  }
  s->E = SUNSparseFromDenseMatrix(E, 0, CSC_MAT),
  s->F = SUNSparseFromDenseMatrix(F, 0, CSC_MAT);
  SUNMatDestroy(E), SUNMatDestroy(F);
  s->sources = (stf_sources){.n = N, .derivatives = -1, .Ex0 = s->Ex0};
}

/* x(0+) and c_0 by the same quadrature, each node by dense elimination with pivoting. */
static void quadrature(const system_ *s, double R, int points, double *x_plus, double *c)
{
  SUNContext sun = steif_sundials(s->ctx);
  SUNMatrix E = SUNDenseMatrix(N, N, sun), A = SUNMatClone(E);
  SUNMatZero(E), SUNMatZero(A);
  for (int j = 0; j < N; j++) {
    for (sunindextype k = SM_INDEXPTRS_S(s->E)[j]; k < SM_INDEXPTRS_S(s->E)[j + 1]; k++)
      SM_ELEMENT_D(E, SM_INDEXVALS_S(s->E)[k], j) = SM_DATA_S(s->E)[k];
    for (sunindextype k = SM_INDEXPTRS_S(s->F)[j]; k < SM_INDEXPTRS_S(s->F)[j + 1]; k++)
      SM_ELEMENT_D(A, SM_INDEXVALS_S(s->F)[k], j) = -SM_DATA_S(s->F)[k];
  }
  steif_pencil *p = steif_pencil_new(s->ctx, E, A);
  N_Vector re = N_VNew_Serial(N, sun), im = N_VClone(re);
  for (int i = 0; i < N; i++) x_plus[i] = c[i] = 0;
  for (int j = 0; j < points / 2; j++) {
    const double angle = 2 * 3.14159265358979323846 * (j + 0.5) / points;
    const steif_shift z = {R * cos(angle), R * sin(angle)};
    N_VConst(0, im), memcpy(NV_DATA_S(re), s->Ex0, N * sizeof(double));
    CU_ASSERT_FATAL(steif_pencil_factor(p, 1, &z) == STEIF_OK);
    CHECK(steif_pencil_solve(p, 0, 1, &re, &im) == STEIF_OK);
    for (int i = 0; i < N; i++) {
      c[i] += 2.0 / points * NV_Ith_S(re, i);
      x_plus[i] += 2.0 / points * (z.re * NV_Ith_S(re, i) - z.im * NV_Ith_S(im, i));
    }
  }
  N_VDestroy(re), N_VDestroy(im);
  steif_pencil_free(&p);
  SUNMatDestroy(E), SUNMatDestroy(A);
}

/* A pivot that vanishes, one that is small, and none of these; twice, as what was found serves
 * again. */
static void pivots_fail_for(int others)
{
  crew team;
  const double R = 12, angle = 2 * 3.14159265358979323846 * 1.5 / 16;
  const steif_shift pair[PAIRS] = {{0.3, 1.9}, {R * cos(angle), R * sin(angle)}, {-1.2, 0.8}};
  static const struct {
    double radius;
    int points, fallbacks;
    bool careful;
  } row[] = {{12, 16, 1, false}, {12 * (1 + 1e-10), 16, 1, true}, {12, 18, 0, false}};
  double x_plus[N], c[N];
  system_ s;
  for (int i = 0; i < 3; i++) {
    stf_circle *circle;
    constrained(&s, pair);
    quadrature(&s, row[i].radius, row[i].points, x_plus, c);
    const steif_analysis analysis = {.points = row[i].points};
    if (others) assemble(&team, s.ctx, others, 1, 0);
    CU_ASSERT_FATAL(stf_circle_open(s.ctx, s.E, s.F, &analysis, 2, &circle) == STEIF_OK);
    for (int again = 0; again < 2; again++) {
      const stf_polynomial g = {.constant = s.Ex0, .scale = circle->scaled.row};
      CHECK(stf_circle_run(circle, row[i].radius, &g) == STEIF_OK);
      for (int k = 0; k < N; k++) {
        const int j = circle->sequence->unknown[k];
        const double scale = circle->scaled.column[j];
        CLOSE_FLOOR(row[i].radius * scale * circle->sum[k], x_plus[j], 1e-13, 1);
        CLOSE_FLOOR(scale * circle->sum[N + k], c[j], 1e-13, 1);
      }
      CHECK(steif_pencil_statistics(circle->scaled.pencil)->fallbacks == row[i].fallbacks);
      CHECK(circle->careful == row[i].careful);
    }
    stf_circle_close(s.ctx, &circle);
    if (others) part(&team, s.ctx, STEIF_OK);
    system_close(&s);
  }
}

/* Alone, and by a team, which has to seek the same pivots again. */
static void pivots_fail(void)
{
  for (int others = 0; others <= 2; others++) pivots_fail_for(others);
}

CU_TestInfo tests_of_circle[] = {
  {"one, two and seven threads agree bit for bit", threads_agree},
  {"a node at which a pivot vanishes is factored by itself", pivots_fail},
  CU_TEST_INFO_NULL};
