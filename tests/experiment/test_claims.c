/* test_claims.c: what is often said wrongly about discretisations, stiffness and conserved energy,
 * measured. Numbers are by hand or of closed forms, unless a source is named.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <complex.h>
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const double pi = 3.14159265358979323846;
static steif_context *ctx;

static steif_discrete discrete(int n, const double *A, const char *scheme, double dt)
{
  const steif_state_space s = {.n = n, .A = A};
  steif_discrete d;
  CU_ASSERT_FATAL(steif_c2d(ctx, &s, scheme, dt, &d) == STEIF_OK);
  return d;
}

/* Largest singular value of a 2 x 2 matrix: s^2 is the larger root of s^4 - |A|^2 s^2 + det^2. */
static double norm2(const double *A)
{
  const double square = A[0] * A[0] + A[1] * A[1] + A[2] * A[2] + A[3] * A[3],
               det = A[0] * A[3] - A[1] * A[2];
  return sqrt((square + sqrt(square * square - 4 * det * det)) / 2);
}

/* -- discretisation ------------------------------------------------------------------------------ */

/* Ad = [1 1; 0 1] for every dt has the spectral radius 1, and its powers up to t = 1 grow. */
static void spectral_radius_one_is_not_stability(void)
{
  static const double grown[] = {10.099, 100.01, 1000.001};
  for (int k = 0; k < 3; k++) {
    const long steps = lround(pow(10, k + 1));
    const double dt = 1.0 / (double)steps, A[] = {0, 0, 1 / dt, 0};
    double power[4], h[2 * 1001];
    steif_discrete d = discrete(2, A, "forward", dt);
    CHECK(d.re[0] == 1 && d.re[1] == 1 && d.im[0] == 0);
    for (int j = 0; j < 2; j++) {
      const double start[] = {j == 0, j == 1};
      CHECK(!steif_discrete_run(ctx, &d, NULL, NULL, 0, start, steps, h));
      memcpy(power + 2 * j, h + 2 * steps, 2 * sizeof *h);
    }
    CLOSE(norm2(power), grown[k], 1e-5);
    steif_discrete_clear(ctx, &d);
  }
}

/* e^{At} of [-1 100; 0 -2]: 100 (e^{-t} - e^{-2t}) is 25 at t = log 2. */
static void decaying_systems_may_grow_first(void)
{
  double peak = 0, X[4];
  for (int k = 0; k <= 200; k++) {
    const double t = 0.01 * k, A[] = {-t, 0, 100 * t, -2 * t};
    CHECK(!steif_expm(ctx, 2, A, X));
    peak = fmax(peak, norm2(X));
  }
  CLOSE(peak, 25.006, 4e-5);
  CHECK(norm2(X) < 14);
}

/* HiPPO-LegS: A + A^T = -(1 + p p^T), so the norm decays at every time. */
static void legs_decays_from_the_start(void)
{
  enum { N = 8 };
  double A[N * N] = {0}, X[N * N], last = 1;
  for (int i = 0; i < N; i++) {
    A[i + N * i] = -0.05 * (i + 1);
    for (int k = 0; k < i; k++) A[i + N * k] = -0.05 * sqrt((2. * i + 1) * (2. * k + 1));
  }
  for (int i = 0; i < N; i++)
    for (int k = 0; k < N; k++)
      CLOSE_FLOOR(A[i + N * k] + A[k + N * i],
                  -0.05 * ((i == k) + sqrt((2. * i + 1) * (2. * k + 1))), 1e-15, 1);
  double v[N], w[N];
  for (int i = 0; i < N; i++)
    v[i] = sin(1.0 + i) / sqrt(N), last = i ? hypot(last, v[i]) : fabs(v[0]);
  CHECK(!steif_expm(ctx, N, A, X));
  for (int k = 0; k < 60; k++) {
    double size = 0;
    for (int i = 0; i < N; i++) {
      w[i] = 0;
      for (int j = 0; j < N; j++) w[i] += X[i + N * j] * v[j];
      size = hypot(size, w[i]);
    }
    CHECK(size < exp(-0.05 / 2) * last * (1 + 1e-12));
    memcpy(v, w, sizeof v);
    last = size;
  }
}

/* e^{l dt} does not tell l from l + 2 pi i/dt. */
static void a_hold_is_not_one_to_one(void)
{
  const double dt = 0.37, w = 1.3, v = w + 2 * pi / dt, slow[] = {-0.2, -w, w, -0.2},
               fast[] = {-0.2, -v, v, -0.2};
  steif_discrete one = discrete(2, slow, "zoh", dt), two = discrete(2, fast, "zoh", dt);
  for (int i = 0; i < 4; i++) CLOSE_FLOOR(one.form.A[i], two.form.A[i], 1e-14, 1);
  CHECK(one.alias < 1 && two.alias > 1);
  steif_discrete_clear(ctx, &one), steif_discrete_clear(ctx, &two);
}

/* r(z) - e^z = z^3/12 + O(z^4): for small decays the bilinear rule is below the exponential. */
static void bilinear_damps_slow_modes_more(void)
{
  const double z = -0.01;
  steif_discrete hold = discrete(1, &z, "zoh", 1), rule = discrete(1, &z, "bilinear", 1);
  CLOSE(rule.form.A[0] - hold.form.A[0], z * z * z / 12, 1e-2);
  steif_discrete_clear(ctx, &hold), steif_discrete_clear(ctx, &rule);
}

/* z^{-2} (e^z (z - 1) + 1) = int_0^1 s e^{sz} ds is phi_1 - phi_2, not phi_2. */
static void the_weighted_integral_is_a_difference(void)
{
  double phi[4];
  CHECK(!steif_phi_scalar(3, -0.2, 0, phi, NULL));
  CLOSE(0.04 * (phi[1] - phi[2]), 0.0175230963064217696, 4e-15);
  CLOSE(0.04 * (phi[1] - phi[2]), exp(-0.2) * -1.2 + 1, 1e-13);
  CLOSE(0.04 * phi[2], 0.0187307530779818587, 4e-15);
}

/* phi_k = (phi_{k-1} - 1/(k-1)!)/z loses a factor 1/|z| each time. */
static void quotients_lose_digits(void)
{
  static const double z[] = {-1e-2, -1e-4, -1e-6};
  for (int i = 0; i < 3; i++) {
    double phi[4], naive = exp(z[i]), series = 0, term = 1. / 6;
    for (int k = 0; k < 8; k++, term *= z[i] / (k + 3)) series += term;
    naive = (naive - 1) / z[i], naive = (naive - 1) / z[i], naive = (naive - 0.5) / z[i];
    CHECK(!steif_phi_scalar(3, z[i], 0, phi, NULL));
    CLOSE(phi[3], series, 4e-16);
    CHECK(fabs(naive - series) > 1e-18 / fabs(z[i] * z[i] * z[i]));
  }
}

/* -- multistep and stiffness --------------------------------------------------------------------- */

/* The polynomial of BDF of order 7 at z = 0, by its companion matrix: a root outside the circle. */
static void bdf_of_order_seven_is_not_stable(void)
{
  static const double a[] = {363. / 140, -7,       21. / 2, -35. / 3,
                             35. / 4,    -21. / 5, 7. / 6,  -1. / 7};
  double C[49] = {0}, most = 0;
  for (int j = 0; j < 7; j++) {
    C[7 * j] = -a[j + 1] / a[0];
    if (j < 6) C[j + 1 + 7 * j] = 1;
  }
  for (int j = 0; j < 7; j++) C[j + 7 * j] -= 1; /* forward with dt = 1 adds it again */
  steif_discrete d = discrete(7, C, "forward", 1);
  for (int j = 0; j < 7; j++) most = fmax(most, hypot(d.re[j], d.im[j]));
  CLOSE(most, 1.0222182443616783, 1e-13);
  steif_discrete_clear(ctx, &d);
}

/* Real parts of the eigenvalues, ascending. */
static void spectrum(int n, const double *J, double *re)
{
  steif_hamiltonian h;
  CU_ASSERT_FATAL(!steif_hamiltonian_find(ctx, n, J, 0, &h));
  for (int i = 0; i < n; i++) re[i] = h.re[i];
  for (int i = 0; i < n; i++)
    for (int j = i + 1; j < n; j++)
      if (re[j] < re[i]) {
        const double kept = re[i];
        re[i] = re[j], re[j] = kept;
      }
  steif_hamiltonian_clear(ctx, &h);
}

/* At (2, 0): l^2 + 3 mu l + 1 = 0, a ratio of 9 mu^2 and not of mu. */
static void van_der_pol_is_stiffer_than_mu(void)
{
  static const double mu[] = {10, 30}, slow[] = {-0.03337045, -0.01111248},
                      fast[] = {-29.96662955, -89.98888752};
  for (int i = 0; i < 2; i++) {
    const double J[] = {0, -1, 1, -3 * mu[i]};
    double re[2];
    spectrum(2, J, re);
    CLOSE(re[0], fast[i], 2e-10);
    CLOSE(re[1], slow[i], 4e-7);
    CLOSE(re[0] / re[1], 9 * mu[i] * mu[i] - 2, 1e-3);
  }
}

/* Along the solution of Robertson's kinetics: 6e3 at t = 0.4, 2e9 at 4e5. */
static void robertson_becomes_stiff(void)
{
  static const struct {
    double t, fast, slow, digits;
  } rows[] = {{0.4, -2179.5, -0.353, 2e-3},
              {40, -3392.8, -2.142e-2, 3e-4},
              {4e3, -8221.7, -3.194e-4, 3e-4},
              {4e5, -9951.8, -4.811e-6, 3e-4}};
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "rober", &p));
  steif_options o = steif_defaults();
  o.rtol = 1e-9, o.atol = 1e-14;
  steif_solver *s = steif_solver_new(ctx, &p, "radau:s=5", &o);
  SUNMatrix J = SUNDenseMatrix(3, 3, steif_sundials(ctx));
  CU_ASSERT_FATAL(s && J);
  for (int i = 0; i < 4; i++) {
    double re[3];
    CHECK(!steif_solve_to(s, rows[i].t));
    SUNMatZero(J);
    CHECK(!p.jac(rows[i].t, steif_solution(s), NULL, J, p.user, NULL, NULL, NULL));
    spectrum(3, SUNDenseMatrix_Data(J), re);
    CLOSE(re[0], rows[i].fast, 2e-5);
    CLOSE(re[1], rows[i].slow, rows[i].digits);
  }
  SUNMatDestroy(J);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
}

/* The zero of component 0 inside the last step, by halving. */
static double crossing(steif_solver *s, N_Vector y, double from, double to, double sign)
{
  for (int i = 0; i < 60; i++) {
    const double middle = (from + to) / 2;
    CHECK(!steif_dense(s, middle, y));
    *(NV_Ith_S(y, 0) * sign > 0 ? &from : &to) = middle;
  }
  return to;
}

static void crossings(const char *name, int count, const double *known, double width,
                      double height)
{
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, name, &p));
  steif_options o = steif_defaults();
  o.rtol = 1e-11, o.atol = 1e-12, o.t1 = 51, o.h_max = 0.05;
  steif_solver *s = steif_solver_new(ctx, &p, "radau:s=5", &o);
  N_Vector y = N_VNew_Serial(2, steif_sundials(ctx));
  CU_ASSERT_FATAL(s && y);
  double last = 2, before = 0, q_most = 0, p_most = 0;
  int found = 0;
  while (steif_time(s) < 51 && !steif_solve_step(s)) {
    const double q = NV_Ith_S(steif_solution(s), 0), t = steif_time(s);
    if (q * last < 0 && found < count)
      CLOSE(crossing(s, y, before, t, last), known[found++], 2e-9);
    last = q, before = t;
    if (t > 1) q_most = fmax(q_most, fabs(q));
    p_most = fmax(p_most, fabs(NV_Ith_S(steif_solution(s), 1)));
  }
  CHECK(found == count);
  CLOSE(q_most, width, 2e-4);
  CLOSE(p_most, height, 5e-3); /* at the steps */
  N_VDestroy(y);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
}

/* The period is (3 - 2 log 2) mu + 7.01 mu^{-1/3} - ..., 1.91 mu and 1.68 mu here, not 2 mu. Two
 * codes agree to the digits given. */
static void the_period_of_van_der_pol(void)
{
  crossings("vdpol:mu=10", 5,
            (const double[]){9.00625049, 18.54543528, 28.08462006, 37.62380484, 47.16298963},
            2.01428450, 14.176539);
  crossings("vdpol:mu=30", 2, (const double[]){24.90589808, 50.17774132}, 2.00516425,
            40.653833);
}

/* (-4 - z + e^z (4 - 3 z + z^2)) / z^3 = phi_1 - 3 phi_2 + 4 phi_3, a weight of ETDRK4, as it stands. */
static double complex weight(double complex z)
{
  return (-4 - z + cexp(z) * (4 - 3 * z + z * z)) / (z * z * z);
}

/* The mean over M points of the circle of radius 1 about z (Kassam and Trefethen, 2005). */
static double by_circle(double z, int M)
{
  double sum = 0;
  for (int j = 0; j < M; j++) sum += creal(weight(z + cexp(2 * pi * I * (j + 0.5) / M)));
  return sum / M;
}

static double by_phi(double z)
{
  double value[4], im[4];
  CHECK(!steif_phi_scalar(3, z, 0, value, im));
  return value[1] - 3 * value[2] + 4 * value[3];
}

/* About z = -1e-6 the circle has 16 digits where the quotient has none; about z = -1 it passes through
 * 0, where the quotient cancels, and more points come closer to it. */
static void circles_stay_clear_of_zero(void)
{
  const double near = -1e-6, small = (1 + near) / 6 + 0.075 * near * near, one = 3 - 8 / exp(1);
  CLOSE(by_circle(near, 32), small, 1e-15);
  CHECK(fabs(creal(weight(near)) / small - 1) > 1);
  CLOSE(by_phi(near), small, 4e-15);
  const double direct = fabs(creal(weight(-1)) / one - 1);
  CHECK(direct < 2e-14 && fabs(by_phi(-1) / one - 1) < 2e-14);
  double many = 0; /* rounding grows as M^2: the worst of eight numbers of points */
  for (int k = 0; k < 8; k++) many = fmax(many, fabs(by_circle(-1, 256 + k) / one - 1));
  CHECK(many > 5 * direct);
}

/* Least det(I - h J) of a step of backward Euler from q = 2 over where it may end, (q, (q - 2)/h). */
static double least_determinant(const char *name, double h)
{
  steif_problem p;
  double least = INFINITY;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, name, &p));
  N_Vector y = N_VNew_Serial(2, steif_sundials(ctx)), fy = N_VClone(y);
  SUNMatrix J = SUNDenseMatrix(2, 2, steif_sundials(ctx));
  for (double q = -2; q <= 2; q += 1e-3) {
    NV_Ith_S(y, 0) = q, NV_Ith_S(y, 1) = (q - 2) / h;
    SUNMatZero(J);
    CHECK(!p.f(0, y, fy, p.user) && !p.jac(0, y, fy, J, p.user, NULL, NULL, NULL));
    least = fmin(least, (1 - h * SM_ELEMENT_D(J, 0, 0)) * (1 - h * SM_ELEMENT_D(J, 1, 1)) -
                          h * h * SM_ELEMENT_D(J, 0, 1) * SM_ELEMENT_D(J, 1, 0));
  }
  N_VDestroy(y), N_VDestroy(fy), SUNMatDestroy(J);
  steif_problem_clear(ctx, &p);
  return least;
}

/* The cubic of a step is monotone for |q| <= 2 only if 7 mu h <= 3 (1 + h^2): h <= 0.042936 and
 * 0.014289 for mu = 10 and 30. Bounded for every step, backward Euler is not unique for every step. */
static void backward_euler_is_unique_for_short_steps(void)
{
  CHECK(least_determinant("vdpol:mu=10", 0.04290) > 0);
  CHECK(least_determinant("vdpol:mu=10", 0.04297) < 0);
  CHECK(least_determinant("vdpol:mu=30", 0.01428) > 0);
  CHECK(least_determinant("vdpol:mu=30", 0.01430) < 0);
}

/* -- energy -------------------------------------------------------------------------------------- */

static steif_drift drift(const char *method, double h, long steps)
{
  steif_problem p;
  steif_drift d = {0};
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "harmonic", &p));
  steif_energy e = {.period = 2 * pi, .drift = &d};
  steif_options o = steif_defaults();
  o.h = h, o.t1 = h * (double)steps;
  CHECK(!steif_energy_measure(ctx, &p, method, &o, &e));
  steif_problem_clear(ctx, &p);
  return d;
}

/* RK4 on q'' = -q: |R|^2 = 1 - h^6/72 + h^8/576 is below 1 up to h = 2 sqrt 2 and above beyond. */
static void rk4_loses_energy_up_to_its_limit(void)
{
  CHECK(drift("rk4", 2.82, 100).final < -0.3);
  CHECK(drift("rk4", 2.84, 100).final > 0.4);
  CHECK(drift("verlet", 1.99, 1000).max < 1e-10);
}

/* RK4 is the more accurate up to the time at which its loss reaches the band h^2/8 of Verlet:
 * 0.5 (1 - |R|^{2n}) = h^2/8 after 108.5 periods for h = 0.3. */
static void rk4_is_better_for_a_hundred_periods(void)
{
  const double h = 0.3, band = h * h / 8;
  const long period = lround(2 * pi / h);
  CLOSE(-drift("verlet", h, 100 * period).min, band, 1e-6);
  CHECK(-drift("rk4", h, lround(108 * 2 * pi / h)).final < band);
  CHECK(-drift("rk4", h, lround(109 * 2 * pi / h)).final > band);
}

static void opened(void) { ctx = steif_context_new(NULL); }
static void closed(void) { steif_context_free(&ctx); }

CU_TestInfo tests_of_claims[] = {
  {"a context opens", opened},
  {"spectral radius one is not stability", spectral_radius_one_is_not_stability},
  {"decaying systems may grow first", decaying_systems_may_grow_first},
  {"LegS decays from the start", legs_decays_from_the_start},
  {"a hold is not one to one", a_hold_is_not_one_to_one},
  {"the bilinear rule damps slow modes more", bilinear_damps_slow_modes_more},
  {"the weighted integral is phi_1 - phi_2", the_weighted_integral_is_a_difference},
  {"quotients lose digits", quotients_lose_digits},
  {"circles stay clear of zero", circles_stay_clear_of_zero},
  {"BDF of order seven is not stable", bdf_of_order_seven_is_not_stable},
  {"van der Pol is stiffer than mu", van_der_pol_is_stiffer_than_mu},
  {"Robertson's kinetics become stiff", robertson_becomes_stiff},
  {"the period of van der Pol's oscillator", the_period_of_van_der_pol},
  {"backward Euler is unique for short steps", backward_euler_is_unique_for_short_steps},
  {"RK4 loses energy up to its limit", rk4_loses_energy_up_to_its_limit},
  {"RK4 is better than Verlet for a hundred periods", rk4_is_better_for_a_hundred_periods},
  {"the context closes", closed},
  CU_TEST_INFO_NULL};
