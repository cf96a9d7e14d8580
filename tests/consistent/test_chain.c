/* test_chain.c: consistent starts of index 3 with thousands of unknowns: a chain of rigid rods, link k hanging
 * on link k - 1, with unknowns x, y, u, v and the force l in the rod:
 *   x' = u, y' = v, q_k'' = -l_k r_k + l_{k+1} r_{k+1} - (0, g), |r_k|^2 = 1, r_k = q_k - q_{k-1}.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/consistent.h>
#include <steif/solver.h>
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

static steif_context *ctx;
static const double g = 9.81;

static double gap(const sunrealtype *y, int links, int k, int c)
{
  if (k < 0 || k >= links) return 0;
  return y[5 * k + c] - (k > 0 ? y[5 * k - 5 + c] : 0);
}

static double force(const sunrealtype *y, int links, int k)
{
  return k < links ? y[5 * k + 4] : 0;
}

/* Acceleration c of link k. */
static double pull(const sunrealtype *y, int links, int k, int c)
{
  return -force(y, links, k) * gap(y, links, k, c) +
         force(y, links, k + 1) * gap(y, links, k + 1, c) - (c ? g : 0);
}

static int f(sunrealtype t, N_Vector Y, N_Vector R, void *user)
{
  const int links = *(int *)user;
  const sunrealtype *y = N_VGetArrayPointer(Y);
  sunrealtype *r = N_VGetArrayPointer(R);
  (void)t;
  for (int k = 0; k < links; k++) {
    const double a = gap(y, links, k, 0), b = gap(y, links, k, 1);
    r[5 * k] = y[5 * k + 2], r[5 * k + 1] = y[5 * k + 3];
    r[5 * k + 2] = pull(y, links, k, 0), r[5 * k + 3] = pull(y, links, k, 1);
    r[5 * k + 4] = (a * a + b * b - 1) / 2;
  }
  return 0;
}

static void entry(SUNMatrix A, sunindextype *used, int row, int links, double value)
{
  if (row < 0 || row >= 5 * links) return;
  SM_INDEXVALS_S(A)[*used] = row;
  SM_DATA_S(A)[(*used)++] = value;
}

static int jacobian(sunrealtype t, N_Vector Y, N_Vector Yp, SUNMatrix A, void *user)
{
  const int links = *(int *)user;
  const sunrealtype *y = N_VGetArrayPointer(Y);
  sunindextype used = 0, *start = SM_INDEXPTRS_S(A);
  (void)t, (void)Yp;
  for (int k = 0; k < links; k++) {
    const double here = force(y, links, k), next = force(y, links, k + 1);
    for (int c = 0; c < 2; c++) {
      start[5 * k + c] = used;
      entry(A, &used, 5 * k - 3 + c, links, here);
      entry(A, &used, 5 * k + 2 + c, links, -here - next);
      entry(A, &used, 5 * k + 4, links, gap(y, links, k, c));
      entry(A, &used, 5 * k + 7 + c, links, next);
      entry(A, &used, 5 * k + 9, links, -gap(y, links, k + 1, c));
    }
    for (int c = 0; c < 2; c++) {
      start[5 * k + 2 + c] = used;
      entry(A, &used, 5 * k + c, links, 1);
    }
    start[5 * k + 4] = used;
    for (int c = 0; c < 2; c++) entry(A, &used, 5 * k - 3 + c, links, gap(y, links, k, c));
    for (int c = 0; c < 2; c++) entry(A, &used, 5 * k + 2 + c, links, -gap(y, links, k, c));
  }
  start[5 * links] = used;
  return 0;
}

static int mass(sunrealtype t, N_Vector Y, N_Vector Yp, SUNMatrix E, void *user)
{
  const int links = *(int *)user;
  sunindextype used = 0;
  (void)t, (void)Y, (void)Yp;
  for (int j = 0; j < 5 * links; j++) {
    SM_INDEXPTRS_S(E)[j] = used;
    if (j % 5 < 4) entry(E, &used, j, links, 1);
  }
  SM_INDEXPTRS_S(E)[5 * links] = used;
  return 0;
}

/* Rods at angles that turn slowly along the chain, at rest; everything is off by up to `off`, and nothing
 * is known of the forces. */
static void guess(sunrealtype *y, int links, double off, unsigned seed)
{
  double x = 0, z = 0;
  for (int k = 0; k < links; k++) {
    const double angle = -0.6 - 0.8 * sin(0.01 * k);
    x += cos(angle), z += sin(angle);
    double *at = y + 5 * k;
    at[0] = x, at[1] = z, at[2] = at[3] = at[4] = 0;
    for (int c = 0; c < 4; c++) {
      seed = seed * 1664525u + 1013904223u;
      at[c] += off * ((seed >> 8) / 8388608.0 - 1);
    }
  }
}

static steif_problem chain(int *links, const sunrealtype *y0)
{
  return (steif_problem){.name = "chain",
                         .n = 5 * *links,
                         .t1 = 0.1,
                         .y0 = y0,
                         .f = f,
                         .A = jacobian,
                         .E = mass,
                         .storage = STEIF_SPARSE,
                         .nnz = 16 * *links,
                         .nnz_E = 4 * *links,
                         .user = links};
}

/* Largest violations of |r|^2 = 1 and its two derivatives, with accelerations from the forces. */
static void levels(const sunrealtype *y, int links, double *worst)
{
  worst[0] = worst[1] = worst[2] = 0;
  for (int k = 0; k < links; k++) {
    double sum[3] = {-1, 0, 0};
    for (int c = 0; c < 2; c++) {
      const double r = gap(y, links, k, c), v = gap(y, links, k, 2 + c);
      const double a = pull(y, links, k, c) - (k > 0 ? pull(y, links, k - 1, c) : 0);
      sum[0] += r * r, sum[1] += r * v, sum[2] += v * v + r * a;
    }
    /* the support holds the first rod: no acceleration, and none is taken away */
    for (int l = 0; l < 3; l++) worst[l] = fmax(worst[l], fabs(sum[l]));
  }
}

static void one_start(int links)
{
  const size_t n = 5 * (size_t)links;
  sunrealtype *y0 = malloc(n * sizeof *y0);
  double worst[3];
  guess(y0, links, 1e-3, 7);
  const steif_problem p = chain(&links, y0);
  steif_start s;
  CU_ASSERT_FATAL(y0 && steif_consistent(ctx, &p, NULL, NULL, &s) == STEIF_OK);
  levels(s.y, links, worst);
  CLOSE_FLOOR(worst[0], 0, 1e-15 * links, 1); /* rounding of positions up to `links` */
  CLOSE_FLOOR(worst[1], 0, 1e-9, 1);
  CLOSE_FLOOR(worst[2], 0, 1e-7 * g, 1);
  CHECK(s.levels == 2 && s.stages == 4);
  for (size_t j = 0; j < n; j++) {
    if (j % 5 < 2) CLOSE_FLOOR(s.moved[j], 0, 3e-3, 1);
    if (j % 5 < 2) CLOSE_FLOOR(s.yp[j], s.y[j + 2], 1e-10, 1);
  }
  steif_start_clear(&s);
  free(y0);
}

/* 250 and 305 unknowns, on both sides of the limit of dense stages, and 10,000. */
static void starts(void)
{
  static const int sizes[] = {50, 61, 2000};
  ctx = steif_context_new(NULL);
  for (int i = 0; i < 3; i++) one_start(sizes[i]);
  steif_context_free(&ctx);
}

/* Both coordinates of the first link cannot be kept where its rod has another length, one of them can. */
static void fixed_positions(void)
{
  enum { LINKS = 70, N = 5 * LINKS };
  int links = LINKS;
  sunrealtype y0[N];
  enum steif_attribute attribute[N];
  guess(y0, links, 0, 7);
  y0[0] += 1e-3;
  for (int j = 0; j < N; j++) attribute[j] = j < 2 ? STEIF_FIXED : STEIF_GUESS;
  const steif_problem p = chain(&links, y0);
  const steif_request request = {.attribute = attribute};
  steif_start s;
  ctx = steif_context_new(NULL);
  CHECK(steif_consistent(ctx, &p, NULL, &request, &s) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "equations {e5} contain only fixed unknowns {y1, y2}"));
  attribute[1] = STEIF_GUESS;
  CHECK(steif_consistent(ctx, &p, NULL, &request, &s) == STEIF_OK);
  CHECK(s.y && s.y[0] == y0[0]);
  if (s.y) CLOSE(s.y[1], -sqrt(1 - y0[0] * y0[0]), 1e-13);
  steif_start_clear(&s);
  /* what agrees with its equation may be fixed though nothing is left to fulfil it */
  y0[0] -= 1e-3;
  attribute[1] = STEIF_FIXED;
  CHECK(steif_consistent(ctx, &p, NULL, &request, &s) == STEIF_OK);
  steif_start_clear(&s);
  steif_context_free(&ctx);
}

/* A rod of length 0 holds no force: there is no start, and this is said. */
static void no_start(void)
{
  enum { LINKS = 70, N = 5 * LINKS };
  int links = LINKS;
  sunrealtype y0[N];
  guess(y0, links, 0, 7);
  for (int c = 0; c < 2; c++) y0[5 * 40 + c] = y0[5 * 39 + c];
  const steif_problem p = chain(&links, y0);
  steif_start s;
  ctx = steif_context_new(NULL);
  CHECK(steif_consistent(ctx, &p, NULL, NULL, &s) < 0);
  CHECK(strstr(steif_message(ctx), "structure") != NULL);

  steif_start_clear(&s);
  steif_context_free(&ctx);
}

/* A run moves inconsistent velocities, keeps what is consistent, and keeps the rods' lengths. */
static void runs(void)
{
  enum { LINKS = 200, N = 5 * LINKS };
  int links = LINKS;
  sunrealtype y0[N];
  double worst[3];
  guess(y0, links, 0, 7);
  y0[5 * 100 + 2] = 0.5;
  const steif_problem p = chain(&links, y0);
  steif_options o = steif_defaults();
  ctx = steif_context_new(NULL);
  o.rtol = 1e-6;
  steif_solver *s = steif_solver_new(ctx, &p, "auto", &o);
  CU_ASSERT_FATAL(s != NULL);
  const steif_repair *used = steif_initial_used(s);
  int first = 0;
  CHECK(used->index == 3 && sscanf(used->message, "start: moved y%d by", &first) == 1);
  CHECK((first - 1) % 5 == 2 || (first - 1) % 5 == 3);
  if (used->y) levels(used->y, links, worst);
  CHECK(used->y && worst[0] < 1e-13 && worst[1] < 1e-9);
  for (int j = 0; used->y && j < N; j++)
    if (j % 5 < 2) CHECK(used->y[j] == y0[j]);
  CHECK(steif_solve_to(s, 0.1) == STEIF_OK);
  levels(N_VGetArrayPointer(steif_solution(s)), links, worst);
  CHECK(worst[0] < 1e-6);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

/* Positions and velocities at 0.5 seconds, within ten tolerances of a tight run; the index is found. */
static void double_pendulum(void)
{
  enum { LINKS = 2, N = 5 * LINKS };
  int links = LINKS;
  sunrealtype y0[N] = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0}, exact[N];
  steif_problem p = chain(&links, y0);
  p.t1 = 0.5;
  for (double rtol = 1e-11; rtol < 2e-4; rtol *= rtol < 1e-10 ? 1e3 : 1e2) {
    steif_options o = steif_defaults();
    o.rtol = rtol;
    ctx = steif_context_new(NULL);
    steif_solver *s = steif_solver_new(ctx, &p, "auto", &o);
    CU_ASSERT_FATAL(s != NULL);
    CHECK(steif_initial_used(s)->index == 3 && steif_initial_used(s)->moved == 0);
    CHECK(steif_solve_to(s, 0.5) == STEIF_OK);
    for (int j = 0; j < N; j++) {
      const sunrealtype y = NV_Ith_S(steif_solution(s), j);
      if (rtol < 1e-10)
        exact[j] = y;
      else if (j % 5 < 4)
        CLOSE_FLOOR(y, exact[j], 10 * rtol * (1 + fabs(exact[j])), 1);
    }
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_chain[] = {{"thousands of rods start together", starts},
                                {"fixed positions contradict each other", fixed_positions},
                                {"a rod without length has no start", no_start},
                                {"a double pendulum swings", double_pendulum},
                                {"a run moves velocities alone", runs},
                                CU_TEST_INFO_NULL};
