/* test_mesh.c: unequal steps: backward Euler, and BDF2 with constant history, in convention R.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/data.h"

/* n = 2^5 .. 2^8: weak errors on H-inc and N-cons and the largest pointwise error of N-cons for
 * t > 0.3, all at 2^8, each with its three orders. */
typedef struct row {
  const char *method, *mesh;
  int k;
  double impulse, impulse_order[3], smooth, smooth_order[3], point, point_order[3];
} row;
/* clang-format off */
static const row rows[] = {
  {"be", "uniform", 2, -0.0309668, {0.948, 0.974, 0.987}, -0.000194448, {1.05, 1.03, 1.01},
   0.00193322, {0.999, 0.999, 1.0}},
  {"be", "uniform", 3, 0.616386, {0.921, 0.96, 0.98}, -0.002107, {0.926, 0.962, 0.981},
   0.00488365, {0.992, 0.996, 0.998}},
  {"be", "uniform", 4, -7.13164, {0.906, 0.953, 0.976}, 0.0046923, {0.769, 0.888, 0.945},
   0.00652743, {0.978, 0.989, 0.995}},
  {"be", "half@.5", 2, -0.0309668, {0.948, 0.974, 0.987}, -0.000194229, {1.05, 1.03, 1.01},
   0.00156321, {0.994, 0.997, 0.999}},
  {"be", "half@.5", 3, 0.616386, {0.921, 0.96, 0.98}, -0.00210334, {0.926, 0.962, 0.981},
   0.47004, {0.022, 0.0111, 0.00556}},
  {"be", "half@.5", 4, -7.13164, {0.906, 0.953, 0.976}, 0.00469073, {0.769, 0.888, 0.945},
   54.4532, {-0.949, -0.974, -0.987}},
  {"be", "double@.5", 2, -0.0309668, {0.948, 0.974, 0.987}, -0.000194898, {1.05, 1.03, 1.01},
   0.0038657, {0.998, 0.999, 0.999}},
  {"be", "double@.5", 3, 0.616386, {0.921, 0.96, 0.98}, -0.00211401, {0.925, 0.962, 0.981},
   0.228549, {-0.173, -0.0765, -0.0361}},
  {"be", "double@.5", 4, -7.13164, {0.906, 0.953, 0.976}, 0.00469464, {0.769, 0.888, 0.945},
   6.86398, {-0.955, -0.961, -0.977}},
  {"be", "double@h", 2, -0.015554, {0.974, 0.987, 0.993}, -0.000192835, {1.0, 1.0, 1.0},
   0.00193267, {0.997, 0.999, 0.999}},
  {"be", "double@h", 3, -11.3655, {-0.395, -0.172, -0.0812}, -0.00209804, {0.903, 0.95,
   0.975}, 0.330741, {0.0638, 0.0332, 0.017}},
  {"be", "double@h", 4, 8172.33, {-1.07, -1.02, -1.01}, 0.00718811, {0.811, 0.906, 0.953},
   72.95, {-0.97, -0.986, -0.993}},
  {"be", "double@2h", 2, -0.0309668, {0.948, 0.974, 0.987}, -0.000379813, {0.925, 0.961,
   0.98}, 0.0038657, {0.998, 0.999, 0.999}},
  {"be", "double@2h", 3, 0.616386, {0.921, 0.96, 0.98}, -0.00406083, {0.75, 0.864, 0.929},
   0.00975486, {0.984, 0.992, 0.996}},
  {"be", "double@2h", 4, -3778.92, {-1.3, -1.2, -1.11}, 0.00892377, {0.527, 0.753, 0.874},
   0.0130058, {0.954, 0.978, 0.989}},
  {"be", "alt12", 2, -0.0207072, {0.965, 0.983, 0.991}, -0.000215495, {1.03, 1.02, 1.01},
   0.00257746, {0.998, 0.999, 1.0}},
  {"be", "alt12", 3, -11.1567, {-0.587, -0.24, -0.11}, -0.00212909, {0.926, 0.963, 0.981},
   0.494874, {0.0181, 0.00579, 0.00599}},
  {"be", "alt12", 4, 8976.77, {-1.2, -1.09, -1.04}, -0.0587699, {-2.63, -0.773, -0.297},
   113.929, {-1.01, -1.06, -0.977}},
  {"be", "smooth", 2, -0.0181258, {0.98, 0.99, 0.995}, -0.00013297, {1.04, 1.02, 1.01},
   0.00305201, {0.987, 0.993, 0.997}},
  {"be", "smooth", 3, 0.315775, {0.979, 0.99, 0.995}, -0.00146579, {0.954, 0.977, 0.988},
   0.00641583, {0.962, 0.981, 0.99}},
  {"be", "smooth", 4, -2.95357, {0.997, 0.999, 1.0}, 0.00326432, {0.885, 0.945, 0.973},
   0.00764273, {0.966, 0.992, 0.992}},
  {"bdf:p=2", "uniform", 2, -0.000559739, {1.9, 1.95, 1.97}, 0.00144687, {0.89, 0.945, 0.973},
   3.80012e-6, {2.01, 2.0, 2.0}},
  {"bdf:p=2", "uniform", 3, 0.00954454, {1.91, 1.96, 1.98}, 0.00115488, {0.709, 0.858, 0.93},
   1.38487e-5, {2.01, 2.0, 2.0}},
  {"bdf:p=2", "uniform", 4, -0.0917933, {1.93, 1.97, 1.98}, -0.0890474, {0.91, 0.96, 0.981},
   2.78403e-5, {2.0, 2.0, 2.0}},
  {"bdf:p=2", "half@.5", 2, -0.000559739, {1.9, 1.95, 1.97}, 0.00144726, {0.89, 0.945, 0.973},
   3.80012e-6, {2.01, 2.0, 2.0}},
  {"bdf:p=2", "half@.5", 3, 0.00954454, {1.91, 1.96, 1.98}, 0.00115535, {0.709, 0.858, 0.93},
   0.000750379, {0.91, 0.957, 0.979}},
  {"bdf:p=2", "half@.5", 4, -0.0917933, {1.93, 1.97, 1.98}, -0.0890481, {0.91, 0.96, 0.981},
   2.41483, {-0.00477, -0.00229, -0.00112}},
  {"bdf:p=2", "double@.5", 2, -0.000559739, {1.9, 1.95, 1.97}, 0.00144607, {0.89, 0.945,
   0.973}, 1.20161e-5, {1.91, 1.96, 1.98}},
  {"bdf:p=2", "double@.5", 3, 0.00954454, {1.91, 1.96, 1.98}, 0.00115393, {0.709, 0.858,
   0.93}, 0.000793338, {1.19, 1.11, 1.06}},
  {"bdf:p=2", "double@.5", 4, -0.0917933, {1.93, 1.97, 1.98}, -0.0890505, {0.91, 0.96, 0.981},
   0.481539, {0.0108, 0.00108, -0.000569}},
  {"bdf:p=2", "double@h", 2, -1.60789, {-0.204, -0.103, -0.0517}, 0.000580703, {0.944, 0.972,
   0.986}, 3.79351e-6, {1.98, 2.0, 2.01}},
  {"bdf:p=2", "double@h", 3, 2407.0, {-1.18, -1.08, -1.04}, 0.0690177, {-0.147, -0.0682,
   -0.0328}, 0.00163251, {0.963, 0.982, 0.991}},
  {"bdf:p=2", "double@h", 4, -2.77577e6, {-2.16, -2.08, -2.04}, 330.438, {-1.18, -1.08,
   -1.04}, 1.41987, {-0.00225, -0.00136, -0.000736}},
  {"bdf:p=2", "double@2h", 2, -0.000559739, {1.9, 1.95, 1.97}, 0.0011596, {0.927, 0.966,
   0.983}, 1.51872e-5, {2.03, 2.01, 2.0}},
  {"bdf:p=2", "double@2h", 3, -1211.87, {-1.66, -1.31, -1.15}, -0.0528595, {-0.736, -0.331,
   -0.158}, 5.53756e-5, {2.01, 2.01, 2.0}},
  {"bdf:p=2", "double@2h", 4, 1.41142e6, {-2.62, -2.29, -2.14}, -295.936, {-1.58, -1.28,
   -1.14}, 0.000111362, {5.44, 2.0, 2.0}},
  {"bdf:p=2", "alt12", 2, -1.58878, {-0.269, -0.137, -0.0688}, 0.000836569, {0.916, 0.958,
   0.979}, 5.05065e-6, {2.02, 2.01, 1.99}},
  {"bdf:p=2", "alt12", 3, 3240.99, {-1.38, -1.19, -1.09}, 0.0902758, {-0.258, -0.123,
   -0.0604}, 0.00147631, {0.993, 0.996, 0.998}},
  {"bdf:p=2", "alt12", 4, -5.28209e6, {-2.49, -2.25, -2.12}, 607.77, {-1.44, -1.21, -1.11},
   2.24894, {-0.00273, -0.00147, -0.000686}},
  {"bdf:p=2", "smooth", 2, -0.00587285, {1.02, 1.01, 1.0}, 0.000818092, {0.945, 0.973, 0.987},
   3.66333e-6, {2.0, 2.0, 2.0}},
  {"bdf:p=2", "smooth", 3, 2.02239, {0.197, 0.113, 0.0615}, 0.000725334, {0.864, 0.936,
   0.969}, 3.05108e-5, {1.98, 1.99, 1.99}},
  {"bdf:p=2", "smooth", 4, -1698.52, {-0.965, -0.993, -1.0}, 0.192179, {1.79, -1.74, -0.443},
   7.05222e-5, {1.95, 1.97, 1.99}},
};
/* clang-format on */
enum { ROWS = sizeof rows / sizeof *rows, FINEST = 4096 };

typedef struct series {
  size_t n;
  sunrealtype t[2 * FINEST], x[2 * FINEST];
} series;
static series run;

static void push(sunrealtype h)
{
  run.t[run.n + 1] = run.t[run.n] + h;
  run.n++;
}

/* half@.5 and double@.5 change at t = 1/2, double@h after a first half step (and the last step is
 * half again, to end at 1), double@2h after two; alt12 alternates 2h/3 and 4h/3; smooth is graded. */
static void lay(const char *mesh, int n)
{
  const double h = 1.0 / n;
  const bool half = !strcmp(mesh, "half@.5"), twice = !strcmp(mesh, "double@.5");
  run.n = 0;
  if (half || twice) {
    for (int i = 0; i < n / 2; i++) push(h);
    for (int i = 0; i < (half ? n : n / 4); i++) push(half ? h / 2 : 2 * h);
  } else if (!strcmp(mesh, "double@h"))
    for (int i = 0; i <= n; i++) push(i > 0 && i < n ? h : h / 2);
  else if (!strcmp(mesh, "double@2h"))
    for (int i = 0; i <= n / 2; i++) push(i < 2 ? h : 2 * h);
  else if (!strcmp(mesh, "alt12"))
    for (int i = 0; i < n; i++) push(i % 2 ? 4 * h / 3 : 2 * h / 3);
  else {
    const bool uniform = !strcmp(mesh, "uniform");
    for (int i = 1; i <= n; i++) run.t[i] = uniform ? i * h : expm1(i * h) / expm1(1);
    run.n = (size_t)n;
  }
}

/* Run on the mesh laid; returns the largest pointwise error of component 1 for t > 0.3. */
static double follow(const char *method, int k, const char *name)
{
  steif_context *ctx = steif_context_new(NULL);
  char text[32];
  steif_problem problem;
  snprintf(text, sizeof text, "jordan:k=%d,case=%s", k, name);
  CU_ASSERT_FATAL(steif_problem_find(ctx, text, &problem) == STEIF_OK);
  steif_options options = steif_defaults();
  options.mesh = run.t;
  options.mesh_size = run.n + 1;
  options.start = strcmp(method, "be") ? "constant" : NULL;
  steif_solver *s = steif_solver_new(ctx, &problem, method, &options);
  if (!s) printf("\n  %s", steif_message(ctx));
  CU_ASSERT_FATAL(s != NULL);
  double worst = 0;
  run.x[0] = N_VGetArrayPointer(steif_solution(s))[0];
  for (size_t i = 1; i <= run.n; i++) {
    sunrealtype exact[MOST];
    CHECK(steif_solve_step(s) == STEIF_OK);
    CHECK(steif_time(s) == run.t[i]);
    run.x[i] = N_VGetArrayPointer(steif_solution(s))[0];
    CHECK(steif_jordan_exact(ctx, k, problem.g, problem.user, problem.y0, run.t[i], exact,
                             NULL) == STEIF_OK);
    if (run.t[i] > 0.3) worst = fmax(worst, fabs(run.x[i] - exact[0]));
  }
  steif_solver_free(&s);
  steif_problem_clear(ctx, &problem);
  steif_context_free(&ctx);
  return worst;
}

static double exact_value(int k, const char *name)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem problem;
  stf_block block;
  char text[32];
  double value = NAN;
  snprintf(text, sizeof text, "jordan:k=%d,case=%s", k, name);
  CU_ASSERT_FATAL(steif_problem_find(ctx, text, &problem) == STEIF_OK);
  CU_ASSERT_FATAL(stf_block_open(&block, ctx, k, problem.g, problem.user, problem.y0) ==
                  STEIF_OK);
  CHECK(stf_block_pair(&block, 0, 0, &value) == STEIF_OK);
  stf_block_close(&block);
  steif_problem_clear(ctx, &problem);
  steif_context_free(&ctx);
  return value;
}

static double weak_error(const char *method, int k, const char *name)
{
  follow(method, k, name);
  return steif_pair(STEIF_R, run.n, run.t, run.x) - exact_value(k, name);
}

/* Six printed digits; orders to three. */
static void compare(const double *seen, double error, const double *order, double noise)
{
  CLOSE(seen[3], error, 2e-5 + noise / fabs(error));
  for (int i = 0; i < 3; i++)
    CLOSE_FLOOR(log2(fabs(seen[i] / seen[i + 1])), order[i], 5.1e-3, 1);
}

static void table_of_meshes(void)
{
  for (int r = 0; r < ROWS; r++) {
    const double noise = 3e-15 * pow(256, rows[r].k - 1); /* pointwise: eps h^-(k-1) */
    double impulse[4], smooth[4], point[4];
    for (int i = 0; i < 4; i++) {
      lay(rows[r].mesh, 32 << i);
      impulse[i] = weak_error(rows[r].method, rows[r].k, "H-inc");
      smooth[i] = weak_error(rows[r].method, rows[r].k, "N-cons");
      point[i] = follow(rows[r].method, rows[r].k, "N-cons");
    }
    compare(impulse, rows[r].impulse, rows[r].impulse_order, 0);
    compare(smooth, rows[r].smooth, rows[r].smooth_order, 0);
    compare(point, rows[r].point, rows[r].point_order, noise);
  }
}

/* With steps 2h/3, 4h/3 the third difference of k = 4 is weighted by 9/8, and the weak error tends
 * to (9/8 - 1) int g' f_4'' = -0.0703883; measured -0.0696411 at h = 2^-12 with 50 digits. */
static void alternating_steps_converge_to_another_functional(void)
{
  double error[2];
  for (int i = 0; i < 2; i++) {
    lay("alt12", FINEST / 2 << i);
    error[i] = weak_error("be", 4, "N-cons");
  }
  CLOSE(error[1], -0.0696411, 1e-4);
  CLOSE(2 * error[1] - error[0], -0.0703883, 1e-3);
}

CU_TestInfo tests_of_mesh[] = {
  {"unequal steps: weak and pointwise errors and orders", table_of_meshes},
  {"alternating steps converge weakly to a wrong functional",
   alternating_steps_converge_to_another_functional},
  CU_TEST_INFO_NULL};
