/* published.c: times of solvers that are not measured here.
 *
 * Least processor time in ms, on one core of an AMD EPYC, in which any of RADAU5, RADAU, RODAS,
 * SEULEX, GAMD, BIMD, MEBDFI, sundials_radau5, CVODE, IDA and ARKODE (SUNDIALS 6.4.1, all of them
 * at -O2) reached 4, 6, 8, 10 digits on a grid of one decade in rtol, with exact Jacobians; and the
 * time of the best of CVODE, IDA and implicit ARKODE there, in units of it, 0 where they do not
 * reach the digits or (plei) are not named. The word says who it was; sr5: sundials_radau5 with
 * its stages, erk: explicit methods of ARKODE.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "workprec.h"
#include <math.h>
#include <string.h>

static const struct {
  const char *problem;
  struct {
    sunrealtype ms;
    const char *peer;
    sunrealtype sundials;
  } at[4]; /* 4, 6, 8, 10 digits */
} published[] = {
  {"vdpol",
   {{0.0681, "rodas", 4.11},
    {0.164, "radau5", 3.62},
    {0.292, "radau5", 4.04},
    {0.599, "radau", 111.96}}},
  {"rober",
   {{0.0593, "radau5", 2.66},
    {0.104, "rodas", 3.01},
    {0.212, "radau5", 3.83},
    {0.405, "radau5", 0}}},
  {"orego",
   {{0.194, "radau5", 2.43},
    {0.341, "radau5", 3.62},
    {0.682, "bimd", 3.46},
    {1.56, "mebdfi", 88.89}}},
  {"hires",
   {{0.0558, "rodas", 2.97},
    {0.203, "radau5", 1.88},
    {0.443, "mebdfi", 1.91},
    {0.55, "mebdfi", 1.71}}},
  {"pollu",
   {{0.0491, "rodas", 1.83},
    {0.0723, "rodas", 1.81},
    {0.229, "rodas", 1.4},
    {0.418, "seulex", 3.54}}},
  {"ringmod",
   {{164, "mebdfi", 1.97},
    {186, "sr5_3_7", 20.78},
    {306, "sr5_3_7", 19.98},
    {452, "sr5_3_7", 0}}},
  {"beam",
   {{19.9, "sr5_3_7", 1.25}, {104, "sr5_3_7", 1.75}, {991, "mebdfi", 2.88}, {0, NULL, 0}}},
  {"plei", {{0.507, "erk5", 0}, {0.922, "erk8", 0}, {1.5, "erk8", 0}, {6.97, "sr5_3_7", 0}}},
  {"medakzo",
   {{4.98, "rodas", 2.57},
    {12.8, "radau", 1.32},
    {20.4, "sr5_3_7", 1.5},
    {31.1, "radau", 17.83}}},
  {"bruss2d:n=16",
   {{22.9, "ida", 1.0}, {44.9, "cvode", 1.0}, {86.5, "ida", 1.0}, {237, "sr5_3_7", 1.84}}},
  {"bruss2d:n=32",
   {{227, "ida", 1.0}, {433, "ida", 1.0}, {841, "ida", 1.0}, {2910, "sr5_3_7", 1.22}}},
  {"bruss2d:n=64", {{2640, "ida", 1.0}, {6020, "ida", 1.0}, {9010, "ida", 1.0}, {0, NULL, 0}}},
  {"bruss2d:n=128", {{31800, "ida", 1.0}, {0, NULL, 0}, {0, NULL, 0}, {0, NULL, 0}}},
  {"chemakzo",
   {{0.0138, "rodas", 1.96},
    {0.0226, "rodas", 2.26},
    {0.0524, "radau5", 2.37},
    {0.116, "mebdfi", 2.43}}},
  {"transamp",
   {{1.12, "mebdfi", 3.99},
    {1.57, "mebdfi", 2.86},
    {2.7, "mebdfi", 35.15},
    {4.37, "mebdfi", 0}}},
  {"caraxis", {{0.659, "mebdfi", 2.12}, {1.44, "mebdfi", 0}, {5.85, "bimd", 0}, {0, NULL, 0}}},
};

void stf_bench_published(steif_bench_match *m)
{
  const int k = m->digits == 4 ? 0 : m->digits == 6 ? 1 : m->digits == 8 ? 2 : 3;
  m->peer_s = m->peer_baseline_s = NAN;
  m->peer = NULL;
  if (k == 3 && m->digits != 10) return;
  for (size_t i = 0; i < sizeof published / sizeof *published; i++) {
    if (strcmp(published[i].problem, m->problem) || !(published[i].at[k].ms > 0)) continue;
    m->peer_s = 1e-3 * published[i].at[k].ms;
    m->peer = published[i].at[k].peer;
    const sunrealtype sundials = published[i].at[k].sundials;
    if (sundials > 0) m->peer_baseline_s = m->peer_s * sundials;
  }
}
