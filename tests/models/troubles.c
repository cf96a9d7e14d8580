/* troubles.c: models on which a run must fail, and what their callbacks do wrong.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "models/models.h"
#include <math.h>
#include <string.h>

#define RESIDUAL(name) static void name(double t, const cplx *y, const cplx *yp, cplx *r)

/* A reproducible number in (-1, 1) that changes with the last bits of x. */
static double scatter(double x)
{
  unsigned long long bits = 0;
  memcpy(&bits, &x, sizeof x);
  bits ^= bits >> 31, bits *= 0x9e3779b97f4a7c15ull, bits ^= bits >> 29;
  bits *= 0xbf58476d1ce4e5b9ull, bits ^= bits >> 32;
  return (double)(bits >> 11) / 4503599627370496.0 - 1;
}

RESIDUAL(square) { (void)t, r[0] = yp[0] - y[0] * y[0]; }

RESIDUAL(exponential) { (void)t, r[0] = yp[0] - cexp(y[0]); }

RESIDUAL(coupled)
{
  (void)t;
  r[0] = yp[0] - y[1] * y[0];
  r[1] = y[1] - y[0] - .3;
}

RESIDUAL(vanderpol)
{
  (void)t;
  r[0] = yp[0] + y[1];
  r[1] = y[0] - (y[1] * y[1] * y[1] / 3 - y[1]);
}

RESIDUAL(cubic)
{
  r[0] = yp[0] - y[1] - .2 * sin(t);
  r[1] = y[0] + y[1] * y[1] * y[1] - 3 * y[1];
}

RESIDUAL(algebraic_jump)
{
  r[0] = yp[0] - y[1];
  r[1] = y[1] + y[0] - (t < .4371 ? cos(t) : cos(t) + .7);
}

/* e1, e2, jV as in the circuit with a loop, units of 1 */
RESIDUAL(voltage_step)
{
  r[0] = yp[0] + y[0] - y[1] + y[2];
  r[1] = y[1] - y[0] + yp[1];
  r[2] = y[0] - sin(t) - (t < .3217 ? 0 : 1);
}

RESIDUAL(switched)
{
  r[0] = yp[0] - 1 - .1 * sin(t);
  r[1] = y[1] - cos(t) - (creal(y[0]) < .6123 ? 0 : 5);
}

RESIDUAL(relay)
{
  (void)t;
  r[0] = yp[0] + (creal(y[0]) > 0 ? 1 : -1) - .3;
  r[1] = yp[1] - y[0];
}

RESIDUAL(noisy8)
{
  r[0] = yp[0] - y[1];
  r[1] = y[1] + y[0] + 3 * y[1] * y[1] * y[1] - cos(t) + 1e-8 * scatter(creal(y[0]));
}

RESIDUAL(noisy6)
{
  r[0] = yp[0] + y[0] - y[1];
  r[1] = y[1] - .5 * ccos(y[1]) - .1 * sin(t) + 1e-6 * scatter(creal(y[1]));
}

RESIDUAL(stiff) { r[0] = yp[0] + 1e6 * (y[0] - cos(t)); }

RESIDUAL(fast)
{
  r[0] = yp[0] + y[0] - y[1];
  r[1] = 1e-7 * yp[1] + y[1] - cos(3 * t);
}

RESIDUAL(fast_cubic)
{
  r[0] = yp[0] + y[0] - y[1];
  r[1] = 1e-7 * yp[1] + y[1] + y[1] * y[1] * y[1] - cos(3 * t);
}

RESIDUAL(fast_algebraic)
{
  r[0] = yp[0] + y[0] - y[1];
  r[1] = y[1] + .1 * y[1] * y[1] * y[1] - cos(3 * t);
}

RESIDUAL(wrong_by_four)
{
  r[0] = yp[0] + y[0] * y[1];
  r[1] = y[1] + y[1] * y[1] * y[1] - 2 * y[0] - sin(t);
}

/* a current between two nodes that nothing ties to the ground */
RESIDUAL(ungrounded)
{
  r[0] = yp[0] - yp[1] + y[0] - y[1] - sin(t);
  r[1] = yp[1] - yp[0] + y[1] - y[0] + sin(t);
}

/* node 1 of the amplifier with its coupling capacitor */
RESIDUAL(amplifier)
{
  r[0] = 1e-6 * (yp[0] - yp[1]) + (y[0] - .1 * sin(628 * t)) / 1e3;
  r[1] = 1e-6 * (yp[1] - yp[0]) + y[1] / 9e3 + 1e-6 * (cexp(y[1] / .3) - 1);
}

RESIDUAL(root)
{
  (void)t;
  r[0] = yp[0] + 1;
  r[1] = yp[1] - csqrt(y[0]);
  if (creal(y[0]) < 0) r[1] = NAN;
}

RESIDUAL(growing) { (void)t, r[0] = yp[0] - 5 * y[0]; }

RESIDUAL(oscillator) { (void)t, r[0] = yp[0] - y[1], r[1] = yp[1] + 25 * y[0]; }

RESIDUAL(front)
{
  r[0] = yp[0] - 2e2 * (1 - y[0] * y[0]) * .5 + .01 * y[1];
  r[1] = yp[1] + y[1] - sin(t);
}

const model troubles[] = {
  {.name = "square", .n = 1, .F = square, .y0 = {1}, .yp0 = {1}},
  {.name = "exponential", .n = 1, .F = exponential, .y0 = {0}, .yp0 = {1}},
  {.name = "coupled", .n = 2, .F = coupled, .y0 = {1, 1.3}, .yp0 = {1.3, 1.3}},
  {.name = "vanderpol",
   .n = 2,
   .F = vanderpol,
   .y0 = {1.3493333333333333, 2.2},
   .yp0 = {-2.2, -.5729166666666667}},
  {.name = "cubic", .n = 2, .F = cubic, .y0 = {0, 0}, .yp0 = {0, 0}},
  {.name = "algebraic_jump", .n = 2, .F = algebraic_jump, .y0 = {.2, .8}, .yp0 = {.8, -.8}},
  {.name = "voltage_step",
   .n = 3,
   .F = voltage_step,
   .y0 = {0, .1, -.9},
   .yp0 = {1, -.1, 0},
   .unknown = {"e1", "e2", "jV"}},
  {.name = "switched", .n = 2, .F = switched, .y0 = {.1, 1}, .yp0 = {1, 0}},
  {.name = "relay", .n = 2, .F = relay, .y0 = {.4, 0}, .yp0 = {-.7, .4}},
  {.name = "noisy8", .n = 2, .F = noisy8, .y0 = {.8, .16904276544846213}, .yp0 = {.169, -.13}},
  {.name = "noisy6", .n = 2, .F = noisy6, .y0 = {.5, .45018361129487355}, .yp0 = {-.05, .08}},
  {.name = "stiff", .n = 1, .F = stiff, .y0 = {1 + 1.8e-6}},
  {.name = "fast", .n = 2, .F = fast, .y0 = {.3, 1 + 1.8e-6}, .yp0 = {.7, 0}},
  {.name = "fast_cubic",
   .n = 2,
   .F = fast_cubic,
   .y0 = {.3, .68232780382801933 + 1.5e-6},
   .yp0 = {.38232780382801933, 0}},
  {.name = "fast_algebraic", .n = 2, .F = fast_algebraic, .y0 = {.3, .92170}, .yp0 = {.6, 50}},
  {.name = "wrong_by_four", .n = 2, .F = wrong_by_four, .y0 = {1, 5}, .yp0 = {-5, 0}},
  {.name = "ungrounded", .n = 2, .F = ungrounded, .y0 = {.3, .3}},
  {.name = "amplifier", .n = 2, .F = amplifier, .y0 = {0, 0}, .yp0 = {31.4, -31.4}},
  {.name = "root", .n = 2, .F = root, .y0 = {.5, 0}, .yp0 = {-1, .7071}},
  {.name = "growing", .n = 1, .F = growing, .y0 = {1}, .yp0 = {5}},
  {.name = "oscillator", .n = 2, .F = oscillator, .y0 = {1, 0}, .yp0 = {0, -25}},
  {.name = "front", .n = 2, .F = front, .y0 = {-.99, 0}, .yp0 = {1.99, 0}},
  {.name = NULL},
};
