/* rectifier.c: an ideal diode feeds a resistor and an inductor from a mains voltage,
 *
 *   conducting (m = 1)   L i' = V sin wt - R i    until i falls to 0
 *   blocking   (m = 0)   i = 0                    until V sin wt rises through 0
 *
 * with the mode m as a second component, m' = 0. With tan phi = w L/R the current of a period is
 * V/|Z| (sin(wt - phi) + sin phi exp(-wt/tan phi)), and the diode turns off at the angle beta
 * after pi where sin(beta - phi) + sin phi exp(-beta/tan phi) = 0 (N. Mohan, T. M. Undeland,
 * W. P. Robbins, Power Electronics, Wiley 1995, ch. 5). While the diode blocks, the event function
 * i stays at zero.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

static const sunrealtype V = 100, R = 10, L = 0.05, w = 314.159265358979323846; /* 50 Hz */

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  sunrealtype *dx = N_VGetArrayPointer(ydot);
  (void)user;
  dx[0] = x[1] * (V * sin(w * t) - R * x[0]) / L;
  dx[1] = 0;
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = -R / L * x[1];
  SM_ELEMENT_D(J, 0, 1) = (V * sin(w * t) - R * x[0]) / L;
  return 0;
}

static int switches(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  (void)user;
  value[0] = N_VGetArrayPointer(y)[0];
  value[1] = sin(w * t);
  return 0;
}

static int change(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  sunrealtype *x = N_VGetArrayPointer(y);
  (void)t, (void)user;
  if (fired[0]) x[0] = 0;
  x[1] = fired[1] ? 1 : 0;
  return STEIF_RESTART;
}

/* beta/w after the beginning of a period, beta = 240.847 degrees: the equation above by the secant
 * rule in 30-digit arithmetic. */
#define TURN_OFF 0.0133803940679453753669100113279
#define PERIOD 0.02
static const sunrealtype times[] = {
  TURN_OFF, PERIOD, PERIOD + TURN_OFF, 2 * PERIOD, 2 * PERIOD + TURN_OFF, 3 * PERIOD};

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  sunrealtype *x = N_VGetArrayPointer(y);
  const sunrealtype s = fmod(t, PERIOD), phi = atan2(w * L, R);
  const int on = s < TURN_OFF;
  x[0] = on ? V / hypot(R, w * L) * (sin(w * s - phi) + sin(phi) * exp(-R / L * s)) : 0;
  x[1] = on;
  return yp ? f(t, y, yp, user) : 0;
}

static const sunrealtype start[] = {0, 1};
static const steif_event list[] = {{.name = "off", .direction = -1},
                                   {.name = "on", .direction = 1}};

const steif_problem steif_problem_rectifier = {
  .about =
    "half-wave rectifier with an inductive load: a diode as events that change the mode; "
    "N. Mohan, T. M. Undeland, W. P. Robbins, Power Electronics, Wiley 1995, ch. 5",
  .n = 2,
  .t1 = 0.07,
  .y0 = start,
  .f = f,
  .jac = jac,
  .exact = exact,
  .events = 2,
  .event = switches,
  .event_list = list,
  .handle_event = change,
  .event_times = times,
  .event_time_count = sizeof times / sizeof *times,
};
