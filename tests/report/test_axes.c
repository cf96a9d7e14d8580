/* Ranges and ticks. SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

static void steps_are_1_2_5(void)
{
  static const struct {
    double lo, hi, step;
  } cases[] = {{-0.83, 7.11, 1}, {0.113, 0.297, 0.05}, {-413, 1377, 500}, {2.71, 3.62, 0.2}};
  for (size_t i = 0; i < 4; i++) {
    stf_axis axis = {.lo = cases[i].lo, .hi = cases[i].hi};
    stf_axis_ticks(&axis, 8 - 2 * (int)(i > 0));
    CHECK(axis.ticks >= 3 && axis.ticks <= 9);
    for (int k = 1; k < axis.ticks; k++)
      CLOSE(axis.tick[k].at - axis.tick[k - 1].at, cases[i].step, 1e-9);
    for (int k = 0; k < axis.ticks; k++)
      CHECK(axis.tick[k].at >= axis.lo && axis.tick[k].at <= axis.hi);
  }
}

static void labels_tell_the_ticks_apart(void)
{
  static const double range[][2] = {{3.1e7, 3.9e7},
                                    {-2.2e-7, 5.1e-7},
                                    {0.98713, 0.98791},
                                    {-1e250, 3e250},
                                    {123456.1, 123457.3}};
  for (size_t i = 0; i < 5; i++) {
    stf_axis axis = {.lo = range[i][0], .hi = range[i][1]};
    stf_axis_ticks(&axis, 7);
    CHECK(axis.ticks >= 3);
    for (int k = 1; k < axis.ticks; k++)
      CHECK(strcmp(axis.tick[k].label, axis.tick[k - 1].label) != 0);
    for (int k = 0; k < axis.ticks; k++) CHECK(strlen(axis.tick[k].label) < 14);
  }
}

static void log_axes_have_decades(void)
{
  stf_axis axis = {.log = true, .lo = -11.4, .hi = -2.3};
  stf_axis_ticks(&axis, 10);
  CHECK(axis.ticks == 9);
  CHECK(axis.tick[0].power == -11 && axis.tick[8].power == -3);
  axis = (stf_axis){.log = true, .lo = -290.2, .hi = 300.7};
  stf_axis_ticks(&axis, 8);
  CHECK(axis.ticks >= 4 && axis.ticks <= 10);
  axis = (stf_axis){.log = true, .lo = 0.43, .hi = 1.12};
  stf_axis_ticks(&axis, 8);
  int named = 0;
  for (int k = 0; k < axis.ticks; k++) named += *axis.tick[k].label != 0;
  CHECK(named >= 2);
}

static void few_decades_have_numbers_between(void)
{
  stf_axis axis = {.log = true, .lo = -6.6, .hi = -5.31};
  stf_axis_ticks(&axis, 8);
  int twos = 0, fives = 0;
  for (int k = 0; k < axis.ticks; k++) {
    if (!axis.tick[k].decade) continue;
    CLOSE(axis.tick[k].at, axis.tick[k].power + log10(axis.tick[k].lead), 1e-12);
    twos += axis.tick[k].lead == 2, fives += axis.tick[k].lead == 5;
  }
  CHECK(twos == 1 && fives == 1); /* 2e-6 and 5e-7; 5e-6 is at -5.301 */
}

static void range_leaves_out_what_cannot_be_drawn(void)
{
  static const sunrealtype x[] = {1.25, 2.5, 3.75, NAN, 40},
                           y[] = {0.5, -8, 12.5, 700, INFINITY};
  const steif_curve curve = {.count = 5, .x = x, .y = y};
  const steif_plot plot = {.log_y = 1, .count = 1, .curve = &curve};
  stf_axis ax = {0}, ay = {.log = true};
  stf_axis_range(&ax, &plot, false);
  stf_axis_range(&ay, &plot, true);
  CLOSE(ax.lo, 1.25 - 0.1, 1e-12);
  CLOSE(ax.hi, 3.75 + 0.1, 1e-12);
  CHECK(ay.lo < log10(0.5) && ay.lo > -0.4);
  CHECK(ay.hi > log10(12.5) && ay.hi < 1.2);
}

static void equal_axes_share_a_unit(void)
{
  stf_axis x = {.lo = -2, .hi = 5, .p0 = 60, .p1 = 530};
  stf_axis y = {.lo = -0.25, .hi = 0.75, .p0 = 500, .p1 = 50};
  stf_axis_equal(&x, &y);
  CLOSE((x.hi - x.lo) / 470, (y.hi - y.lo) / 450, 1e-12);
  CLOSE(y.lo + y.hi, 0.5, 1e-12);
  CHECK(x.lo == -2 && x.hi == 5);
}

CU_TestInfo tests_of_axes[] = {
  {"ticks step by 1, 2 or 5 inside the range", steps_are_1_2_5},
  {"labels tell neighbouring ticks apart", labels_tell_the_ticks_apart},
  {"log axes have decades, narrow ones some between", log_axes_have_decades},
  {"few decades have numbers between", few_decades_have_numbers_between},
  {"ranges leave out points that cannot be drawn", range_leaves_out_what_cannot_be_drawn},
  {"equal axes share a unit", equal_axes_share_a_unit},
  CU_TEST_INFO_NULL};
