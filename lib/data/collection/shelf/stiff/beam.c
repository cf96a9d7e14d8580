/* beam.c: the elastic beam as a chain of N segments with angles theta, clamped at one end and
 * pulled at the other by the force (F_x, F_y) = (-phi, phi), phi = 1.5 sin^2 t up to t = pi.
 *
 * With G_lk = N + 1/2 - max(l, k) and B = G .* exp(i (theta_l - theta_k)), the equations of
 * motion Re(B) theta'' + Im(B) theta'^2 = v are solved in O(N) operations, because
 * B^-1 = C + i D is tridiagonal: C u = D v + theta'^2, theta'' = C v + D u.
 * E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, section IV.1.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "published.h"
#include <math.h>

enum { N = 40 };

/* Everything at one (t, theta, p = theta'): off-diagonals of C and D (c[l] and d[l] couple l
 * and l + 1; D is antisymmetric with d above the diagonal), the pivots of C, v, u and
 * theta''. */
struct chain {
  sunrealtype c[N], d[N], pivot[N], v[N], u[N], a[N], bend[N];
};

static sunrealtype diagonal(int l) { return l == 0 ? 1 : l == N - 1 ? 3 : 2; }

/* C x, D x and C^-1 x (in place). */
static void times_c(const struct chain *m, const sunrealtype *x, sunrealtype *out)
{
  for (int l = 0; l < N; l++)
    out[l] = diagonal(l) * x[l] + (l > 0 ? m->c[l - 1] * x[l - 1] : 0) +
             (l < N - 1 ? m->c[l] * x[l + 1] : 0);
}

static void times_d(const struct chain *m, const sunrealtype *x, sunrealtype *out)
{
  for (int l = 0; l < N; l++)
    out[l] = (l < N - 1 ? m->d[l] * x[l + 1] : 0) - (l > 0 ? m->d[l - 1] * x[l - 1] : 0);
}

static void solve_c(const struct chain *m, sunrealtype *x)
{
  for (int l = 1; l < N; l++) x[l] -= m->c[l - 1] / m->pivot[l - 1] * x[l - 1];
  x[N - 1] /= m->pivot[N - 1];
  for (int l = N - 1; l-- > 0;) x[l] = (x[l] - m->c[l] * x[l + 1]) / m->pivot[l];
}

/* v = N^4 (second difference of theta) + N^2 (F_y cos theta - F_x sin theta),
 * theta_0 = -theta_1, theta_(N+1) = theta_N; bend = the part of dv/dtheta that the force adds
 * to the diagonal. */
static void forces(sunrealtype t, const sunrealtype *q, struct chain *m)
{
  const sunrealtype s = sin(t), phi = t < 3.14159265358979323846 ? 1.5 * s * s : 0;
  const sunrealtype n2 = (sunrealtype)N * N, n4 = n2 * n2;
  for (int l = 0; l < N; l++) {
    const sunrealtype left = l > 0 ? q[l - 1] : -q[0], right = l < N - 1 ? q[l + 1] : q[N - 1];
    const sunrealtype sine = sin(q[l]), cosine = cos(q[l]);
    m->v[l] = n4 * (left - 2 * q[l] + right) + n2 * phi * (cosine + sine);
    m->bend[l] = n2 * phi * (cosine - sine);
  }
}

static void motion(sunrealtype t, const sunrealtype *q, const sunrealtype *p, struct chain *m)
{
  sunrealtype work[N];
  for (int l = 0; l < N - 1; l++) {
    m->c[l] = -cos(q[l] - q[l + 1]);
    m->d[l] = -sin(q[l] - q[l + 1]);
  }
  m->pivot[0] = 1;
  for (int l = 1; l < N; l++)
    m->pivot[l] = diagonal(l) - m->c[l - 1] * m->c[l - 1] / m->pivot[l - 1];
  forces(t, q, m);
  times_d(m, m->v, m->u);
  for (int l = 0; l < N; l++) m->u[l] += p[l] * p[l];
  solve_c(m, m->u);
  times_c(m, m->v, m->a);
  times_d(m, m->u, work);
  for (int l = 0; l < N; l++) m->a[l] += work[l];
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *q = NV_DATA_S(y), *p = q + N;
  sunrealtype *d = NV_DATA_S(ydot);
  struct chain m;
  (void)user;
  motion(t, q, p, &m);
  for (int l = 0; l < N; l++) {
    d[l] = p[l];
    d[N + l] = m.a[l];
  }
  return 0;
}

/* Column j of K = dv/dtheta - diag(u). */
static void stiffness(const struct chain *m, int j, sunrealtype *out)
{
  const sunrealtype n4 = (sunrealtype)N * N * N * N;
  for (int l = 0; l < N; l++) out[l] = 0;
  if (j > 0) out[j - 1] = n4;
  if (j < N - 1) out[j + 1] = n4;
  out[j] = n4 * (j == 0 ? -3 : j == N - 1 ? -1 : -2) + m->bend[j] - m->u[j];
}

/* dtheta''/dtheta = C K + D C^-1 (D K + diag(theta'')) + diag(p^2), because dC v = (D diag(v) -
 * diag(D v)) dtheta and dD u = (diag(C u) - C diag(u)) dtheta; dtheta''/dp = 2 D C^-1
 * diag(p). */
static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  const sunrealtype *q = NV_DATA_S(y), *p = q + N;
  sunrealtype column[N], x[N], work[N];
  struct chain m;
  (void)fy, (void)user, (void)tmp1, (void)tmp2, (void)tmp3;
  motion(t, q, p, &m);
  for (int j = 0; j < N; j++) {
    sunrealtype *to = SM_COLUMN_D(J, j) + N;
    stiffness(&m, j, column);
    times_d(&m, column, x);
    x[j] += m.a[j];
    solve_c(&m, x);
    times_c(&m, column, to);
    times_d(&m, x, work);
    for (int l = 0; l < N; l++) {
      to[l] += work[l];
      x[l] = 0;
    }
    to[j] += p[j] * p[j];

    x[j] = 2 * p[j];
    solve_c(&m, x);
    times_d(&m, x, SM_COLUMN_D(J, N + j) + N);
    SM_ELEMENT_D(J, j, N + j) = 1;
  }
  return 0;
}

static const sunrealtype y0[2 * N];
static const sunrealtype end[] = {
  -0.0057923665912850072, -0.016952985507217352, -0.027691033129730942, -0.038008156558791577,
  -0.047906168597437633,  -0.057387104352745938, -0.066453273134546173, -0.075107305819790374,
  -0.083352197654149918,  -0.091191346546479465, -0.098628587001320905, -0.1056682200378002,
  -0.1123150395409595,    -0.1185743552727245,   -0.1244520128755561,   -0.12995441132641611,
  -0.1350885180610398,    -0.13986188191944221,  -0.14428264410152419,  -0.14835954724630121,
  -0.1521019429001447,    -0.15551979780611291,  -0.15862369934202289,  -0.1614248603702127,
  -0.16393512381932229,   -0.1661669673440852,   -0.1681335081778558,   -0.16984850806022431,
  -0.17132637824408881,   -0.1725821847462537,   -0.1736316537975654,   -0.17449117738400491,
  -0.1751778187863392,    -0.17570931787129021,  -0.17610409602285759,  -0.17638126071755489,
  -0.17656060975646709,   -0.17666263522605649,  -0.176708527080746,    -0.17672017610754881,
  0.037473626813297939,   0.1099117880217593,    0.1798360474312799,    0.24724273054423909,
  0.31212938205965668,    0.37449473770195002,   0.43433860734927981,   0.49166203546017478,
  0.54646778545868069,    0.59876097026242703,   0.64854936111107397,   0.6958435169132503,
  0.74065726685208078,    0.78300817478132412,   0.82291766592015148,   0.86041103051905599,
  0.89551755023778046,    0.92827082631279534,   0.95870893345220343,   0.98687478217283631,
  1.0128165799618829,     1.0365877366798579,    1.0582468264813549,    1.077857811433353,
  1.0954902220053691,     1.1112191642948981,    1.125125269286501,     1.1372945266092289,
  1.147818025153607,      1.1567921320044821,    1.1643188451301829,    1.1705059925961241,
  1.17546742429955,       1.1793230032288591,    1.1821985862996669,    1.184226111223146,
  1.1855439098055749,     1.1862970842037159,    1.1866376189081269,    1.186724615113034};
static const steif_reference reference = {
  .t = 5, .value = end, .digits = 7, .source = IVP_TEST_SET "beam"};

/* The force ends at pi with a jump of its second derivative. */
static const sunrealtype breaks[] = {3.14159265358979323846};

const steif_problem steif_problem_beam = {
  .name = "beam",
  .about = "Elastic beam of 40 segments, stiff and oscillatory with eigenvalues near the "
           "imaginary axis. IVP Test Set II-14; " HAIRER_WANNER " IV.1.",
  .n = 2 * N,
  .t1 = 5,
  .y0 = y0,
  .f = f,
  .jac = jac,
  .reference = &reference,
  .breaks = breaks,
  .break_count = 1,
};
