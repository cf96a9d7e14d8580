/* models.c: definitions of the small DAEs. Sources: Hessenberg forms, circuits and
 * reactors of usual shape; Jay: L. Jay, BIT 33 (1993); Gear and Petzold, SIAM J. Numer.
 * Anal. 21 (1984); the pair ltva and ltvb: Kunkel and Mehrmann, Differential-Algebraic
 * Equations (2006), examples 3.1 and 3.2; over4, over5: 0/1 instances in the manner of
 * Reissig, Martinson and Barton, SIAM J. Sci. Comput. 21 (2000).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "models/models.h"
#include <math.h>
#include <string.h>

#define RESIDUAL(name) static void name(double t, const cplx *y, const cplx *yp, cplx *r)

/* the pendulum with lambda eliminated */
RESIDUAL(ode4)
{
  const cplx lambda = (y[2] * y[2] + y[3] * y[3] - 9.81 * y[1]) / (y[0] * y[0] + y[1] * y[1]);
  (void)t;
  r[0] = yp[0] - y[2], r[1] = yp[1] - y[3];
  r[2] = yp[2] + lambda * y[0], r[3] = yp[3] + lambda * y[1] + 9.81;
}

RESIDUAL(hess2)
{
  (void)t;
  r[0] = yp[0] - y[0] * y[1] * y[1] * y[2] * y[2];
  r[1] = yp[1] - y[0] * y[0] * y[1] * y[1] + 3 * y[1] * y[1] * y[2];
  r[2] = y[0] * y[0] * y[1] - 1;
}

RESIDUAL(jay3)
{
  (void)t;
  r[0] = yp[0] - 2 * y[0] * y[1] * y[2] * y[3];
  r[1] = yp[1] + y[0] * y[1] * y[3] * y[3];
  r[2] = yp[2] - (y[0] * y[1] + y[2] * y[3]) * y[4];
  r[3] = yp[3] + y[0] * y[1] * y[1] * y[3] * y[3] * y[4];
  r[4] = y[0] * y[1] * y[1] - 1;
}

/* C, T, R, Tc */
RESIDUAL(cstr)
{
  r[0] = yp[0] - 1.2 * (1 - y[0]) + y[2];
  r[1] = yp[1] - 1.2 * (1 - y[1]) - .5 * y[2] + .8 * (y[1] - y[3]);
  r[2] = y[2] - 3 * cexp(-1 / y[1]) * y[0];
  r[3] = y[0] - .5 - .1 * sin(t);
}

/* C1, C2, C0 */
RESIDUAL(reactors)
{
  r[0] = yp[0] - y[2] + y[0] + .3 * y[0] * y[0];
  r[1] = yp[1] - (y[0] - y[1]) / .7 + .2 * y[1] * y[1];
  r[2] = y[1] - .5 - .1 * sin(t);
}

static const double Rm = 100, Cm = 1e-6, Lm = 1e-3;

/* e1, e2, jL: source current, R between, C and L */
RESIDUAL(mnarlc)
{
  r[0] = Cm * yp[0] + (y[0] - y[1]) / Rm - 1e-3 * sin(1000 * t);
  r[1] = (y[1] - y[0]) / Rm + y[2];
  r[2] = Lm * yp[2] - y[1];
}

/* e1, e2, jV */
RESIDUAL(mnacv)
{
  r[0] = Cm * yp[0] + (y[0] - y[1]) / Rm + y[2];
  r[1] = (y[1] - y[0]) / Rm + Cm * yp[1];
  r[2] = y[0] - sin(1000 * t);
}

/* e1, e2, jL: current source in series with an inductor */
RESIDUAL(mnali)
{
  r[0] = y[2] - sin(1000 * t);
  r[1] = Lm * yp[2] - (y[0] - y[1]);
  r[2] = -y[2] + y[1] / Rm + Cm * yp[1];
}

static cplx charge_of(cplx e) { return 1e-6 * e + 3e-7 * e * e * e; }

/* e1, q: no loop */
RESIDUAL(charge)
{
  r[0] = yp[1] + y[0] / Rm - 1e-2 * sin(1000 * t);
  r[1] = y[1] - charge_of(y[0]);
}

/* e1, q, jV */
RESIDUAL(chargecv)
{
  r[0] = yp[1] + y[0] / Rm + y[2];
  r[1] = y[1] - charge_of(y[0]);
  r[2] = y[0] - sin(1000 * t);
}

RESIDUAL(floating)
{
  r[0] = Cm * (yp[0] - yp[1]) + y[0] / 1e3 - 1e-3 * sin(1000 * t);
  r[1] = Cm * (yp[1] - yp[0]) + y[1] / 1e3;
}

/* F = H r(t, W y, W y'), H = I - 1/2 1 1^T, W = I - 1/2 s s^T, s = (1, -1, 1, 1). */
static void reflect(const double *s, cplx *x)
{
  cplx dot = 0;
  for (int i = 0; i < 4; i++) dot += s[i] * x[i];
  for (int i = 0; i < 4; i++) x[i] -= .5 * dot * s[i];
}

static const double signs[] = {1, -1, 1, 1}, ones[] = {1, 1, 1, 1};

static void turned(const cplx *y, const cplx *yp, cplx *z, cplx *zp)
{
  memcpy(z, y, 4 * sizeof *z), memcpy(zp, yp, 4 * sizeof *zp);
  reflect(signs, z), reflect(signs, zp);
}

RESIDUAL(rot1)
{
  cplx z[4], zp[4];
  turned(y, yp, z, zp);
  r[0] = zp[0] + z[0] * z[3] - sin(t);
  r[1] = zp[1] - z[0] + z[1] * z[1];
  r[2] = zp[2] * (1 + z[1] * z[1]) + z[2] - z[3];
  r[3] = z[3] + .2 * z[3] * z[3] * z[3] - z[0] * z[1] - .3;
  reflect(ones, r);
}

RESIDUAL(rot3)
{
  cplx z[4], zp[4];
  turned(y, yp, z, zp);
  reactors(t, z, zp, r);
  r[3] = zp[3] + z[0] * z[3];
  reflect(ones, r);
}

RESIDUAL(ltva)
{
  r[0] = -t * yp[0] + t * t * yp[1] + y[0] - sin(t);
  r[1] = -yp[0] + t * yp[1] + y[1] - cos(2 * t);
}

RESIDUAL(ltvb)
{
  r[0] = y[0] - t * y[1] - sin(t);
  r[1] = yp[0] - t * yp[1] - cos(2 * t);
}

/* eta = -0.7 */
RESIDUAL(gear)
{
  const double eta = -.7;
  r[0] = y[0] + eta * t * y[1] - sin(t);
  r[1] = yp[0] + eta * t * yp[1] + (1 + eta) * y[1] - cos(2 * t);
}

static void affine(size_t n, const char *const *E, const char *const *F, double t,
                   const cplx *y, const cplx *yp, cplx *r)
{
  for (size_t i = 0; i < n; i++) {
    r[i] = -sin((double)(i + 1) * t);
    for (size_t j = 0; j < n; j++) {
      if (E[i][j] == '1') r[i] += yp[j];
      if (F[i][j] == '1') r[i] += y[j];
    }
  }
}

RESIDUAL(over4)
{
  static const char *const E[] = {"1000", "0101", "0000", "0000"};
  static const char *const F[] = {"0011", "0000", "1100", "0011"};
  affine(4, E, F, t, y, yp, r);
}

RESIDUAL(over5)
{
  static const char *const E[] = {"11000", "10000", "10000", "00101", "00000"};
  static const char *const F[] = {"00001", "11010", "10100", "01010", "11000"};
  affine(5, E, F, t, y, yp, r);
}

RESIDUAL(decoupled)
{
  r[0] = y[1] - sin(t), r[1] = y[2] - cos(2 * t), r[2] = yp[0] + yp[2] - sin(3 * t);
}

RESIDUAL(impasse)
{
  (void)t;
  r[0] = yp[0] - y[1];
  r[1] = y[0] - (y[1] * y[1] * y[1] / 3 - y[1]);
}

RESIDUAL(fold)
{
  (void)t;
  r[0] = yp[0] + 1;
  r[1] = y[0] - y[1] * y[1];
}

/* y, z: the coefficient of z vanishes at t = 1 */
RESIDUAL(moving)
{
  r[0] = (t - 1) * y[1] + y[0] - sin(t);
  r[1] = yp[0] - y[1];
}

/* the last equation repeats the sum of the others */
RESIDUAL(twice)
{
  r[0] = yp[0] + y[1] - sin(t);
  r[1] = y[0] + y[2] - cos(t);
  r[2] = yp[0] + y[0] + y[1] + y[2] - sin(t) - cos(t);
}

/* three equations in the first two unknowns only */
RESIDUAL(crowded)
{
  r[0] = yp[0] - y[1];
  r[1] = y[0] + y[1] - sin(t);
  r[2] = y[0] - 2 * y[1] - cos(t);
  r[3] = yp[2] + y[3] * y[3] - y[0];
}

const model models[] = {
  {.name = "ode4",
   .n = 4,
   .F = ode4,
   .t0 = 0,
   .y0 = {.8253356149096783, -.56464247339503536, .39524973137652475, .57773493043677481}},
  {.name = "hess2",
   .n = 3,
   .F = hess2,
   .t0 = 0,
   .y0 = {1, 1, 1},
   .yp0 = {1, -2, 2},
   .equation = {"f1", "f2", "g"},
   .unknown = {"y1", "y2", "z"}},
  {.name = "jay3",
   .n = 5,
   .F = jay3,
   .t0 = 0,
   .y0 = {1, 1, 1, 1, 1},
   .yp0 = {2, -1, 2, -1, 1},
   .equation = {"f1", "f2", "k1", "k2", "g"},
   .unknown = {"y1", "y2", "z1", "z2", "u"}},
  {.name = "cstr",
   .n = 4,
   .F = cstr,
   .t0 = 0,
   .y0 = {.5, .91023922662683739, .5, .0074035692374708096},
   .yp0 = {.1, -.36455559786369814, -.12, -.282466826121745},
   .equation = {"mass", "heat", "rate", "spec"},
   .unknown = {"C", "T", "R", "Tc"}},
  {.name = "reactors",
   .n = 3,
   .F = reactors,
   .t0 = 0,
   .y0 = {.605, .5, .8288075},
   .yp0 = {.114, .1, .088182},
   .equation = {"tank1", "tank2", "spec"},
   .unknown = {"C1", "C2", "C0"}},
  {.name = "mnarlc", .n = 3, .F = mnarlc, .t0 = 0, .y0 = {0, 0, 0}},
  {.name = "mnacv",
   .n = 3,
   .F = mnacv,
   .t0 = 0,
   .y0 = {0, .1, 1e-3},
   .yp0 = {1000, -1000, 0},
   .equation = {"kcl1", "kcl2", "src"},
   .unknown = {"e1", "e2", "jV"}},
  {.name = "mnali",
   .n = 3,
   .F = mnali,
   .t0 = 0,
   .y0 = {1.1, .1, 0},
   .yp0 = {0, 0, 1000},
   .equation = {"kcl1", "branch", "kcl2"},
   .unknown = {"e1", "e2", "jL"}},
  {.name = "charge",
   .n = 2,
   .F = charge,
   .t0 = 0,
   .y0 = {.2, 2.024e-7},
   .equation = {"kcl1", "charge"},
   .unknown = {"e1", "q"},
   .size = {1e-3, 1e-9}},
  {.name = "chargecv",
   .n = 3,
   .F = chargecv,
   .t0 = 0,
   .y0 = {0, 0, 1e-3},
   .yp0 = {1000, 1e-3, 0},
   .equation = {"kcl1", "charge", "src"},
   .unknown = {"e1", "q", "jV"},
   .size = {1e-3, 1e-9, 1e-5}},
  {.name = "floating", .n = 2, .F = floating, .t0 = 0, .y0 = {.1, -.1}},
  {.name = "rot1",
   .n = 4,
   .F = rot1,
   .t0 = 0,
   .y0 = {.04672006574209625, .6532799342579036, -.15327993425790373, .0532799342579037},
   .yp0 = {-.05527752430014, .20265357689382, .29685088963444, .17577305777188}},
  {.name = "rot3",
   .n = 4,
   .F = rot3,
   .t0 = 0,
   .y0 = {-.01190375, 1.11690375, .21190375, -.31690375},
   .yp0 = {.153659, .060341, .127841, -.141841}},
  {.name = "ltva", .n = 2, .F = ltva, .t0 = .7, .y0 = {.3, .4}, .yp0 = {.5, -.2}},
  {.name = "ltvb", .n = 2, .F = ltvb, .t0 = .7, .y0 = {.3, .4}, .yp0 = {.5, -.2}},
  {.name = "gear", .n = 2, .F = gear, .t0 = .7, .y0 = {.3, .4}, .yp0 = {.5, -.2}},
  {.name = "over4", .n = 4, .F = over4, .t0 = .3, .y0 = {.1, .2, .3, .4}},
  {.name = "over5", .n = 5, .F = over5, .t0 = .3, .y0 = {.1, .2, .3, .4, .5}},
  {.name = "decoupled", .n = 3, .F = decoupled, .t0 = .3, .y0 = {.1, .2, .3}},
  {.name = "impasse",
   .n = 2,
   .F = impasse,
   .t0 = 0,
   .y0 = {1.3493333333333333, 2.2},
   .yp0 = {2.2, .5729166666666667},
   .unknown = {"x", "y"}},
  {.name = "fold",
   .n = 2,
   .F = fold,
   .t0 = 0,
   .y0 = {1, 1},
   .yp0 = {-1, -.5},
   .unknown = {"x", "y"}},
  {.name = "moving",
   .n = 2,
   .F = moving,
   .t0 = 1,
   .y0 = {.84147098480789651, .27015115293406986},
   .yp0 = {.27015115293406986, 0},
   .unknown = {"y", "z"}},
  {.name = "twice", .n = 3, .F = twice, .t0 = .3, .y0 = {.1, .2, .3}},
  {.name = "crowded", .n = 4, .F = crowded, .t0 = .3, .y0 = {.1, .2, .3, .4}},
  {.name = NULL},
};
