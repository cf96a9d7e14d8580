/* splitting.c: the splitting schemes, a row each, and their passes. Symmetric ones are given
 * by the numbers of one half.
 *
 * Order of a symmetric composition of Verlet steps: sum w_i = 1 and sum w_i^3 = 0 for 4, also
 * sum w_i^5 = 0 and one condition more for 6 (Hairer, Lubich and Wanner, Geometric Numerical
 * Integration, 2nd ed., V.3).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "splitting.h"
#include <string.h>

const stf_splitting stf_splittings[] = {
  {.name = "symeuler",
   .about =
     "symplectic Euler, first=p or q: R. de Vogelaere, Univ. of Notre Dame report (1956)",
   .order = 1,
   .kind = STF_EULER,
   .kick_first = true},
  {.name = "verlet",
   .about = "Stoermer, Verlet, leapfrog, first=kick or drift: L. Verlet, Phys. Rev. 159 (1967)",
   .order = 2,
   .kind = STF_VERLET,
   .kick_first = true},
  {.name = "yoshida4",
   .about = "3 Verlet steps: H. Yoshida, Phys. Lett. A 150 (1990); w_1 = 1/(2 - 2^(1/3))",
   .order = 4,
   .kind = STF_VERLET,
   .kick_first = true,
   .count = 1,
   .given = {1.35120719195965763404768781L}},
  {.name = "suzuki4",
   .about = "5 Verlet steps: M. Suzuki, Phys. Lett. A 146 (1990); w = 1/(4 - 4^(1/3))",
   .order = 4,
   .kind = STF_VERLET,
   .kick_first = true,
   .count = 2,
   .given = {0.414490771794375737142354063L, 0.414490771794375737142354063L}},
  {.name = "pefrl",
   .about = "4 forces: I. P. Omelyan, I. M. Mryglod and R. Folk, Comput. Phys. Commun. 146 "
            "(2002); xi, 1/2 - lambda, chi",
   .order = 4,
   .kind = STF_ALTERNATING,
   .count = 3,
   .given = {0.1786178958448091L, 0.7123418310626054L, -0.06626458266981849L}},
  {.name = "blanesmoan6",
   .about = "6 forces: S. Blanes and P. C. Moan, J. Comput. Appl. Math. 142 (2002), S6",
   .order = 4,
   .kind = STF_ALTERNATING,
   .count = 5,
   .given = {0.0792036964311957L, 0.209515106613362L, 0.353172906049774L, -0.143851773179818L,
             -0.0420650803577195L}},
  {.name = "rkn6",
   .about =
     "6 forces, T quadratic in p: Blanes and Moan (2002), the Nystroem scheme of order 4",
   .order = 4,
   .kind = STF_ALTERNATING,
   .kick_first = true,
   .count = 5,
   .given = {0.0829844064174052L, 0.245298957184271L, 0.396309801498368L, 0.604872665711080L,
             -0.0390563049223486L}},
  {.name = "rkn11",
   .about =
     "11 forces, T quadratic in p: Blanes and Moan (2002), the Nystroem scheme of order 6",
   .order = 6,
   .kind = STF_ALTERNATING,
   .kick_first = true,
   .count = 10,
   .given = {0.0414649985182624L, 0.123229775946271L, 0.198128671918067L, 0.290553797799558L,
             -0.0400061921041533L, -0.127049212625417L, 0.0752539843015807L,
             -0.246331761062075L, -0.0115113874206879L, 0.357208872795928L}},
  {.name = "yoshida6",
   .about = "7 Verlet steps: H. Yoshida, Phys. Lett. A 150 (1990), solution A",
   .order = 6,
   .kind = STF_VERLET,
   .kick_first = true,
   .count = 3,
   .given = {0.78451361047755726381949763L, 0.23557321335935813368479318L,
             -1.17767998417887100694641568L}},
  {.name = "kahanli6",
   .about = "9 Verlet steps: W. Kahan and R.-C. Li, Math. Comp. 66 (1997)",
   .order = 6,
   .kind = STF_VERLET,
   .kick_first = true,
   .count = 4,
   .given = {0.39216144400731413927925056L, 0.33259913678935943859974864L,
             -0.70624617255763935980996482L, 0.08221359629355080023149045L}},
  {.name = "suzuki6",
   .about =
     "25 Verlet steps: M. Suzuki, Phys. Lett. A 146 (1990), suzuki4 with 1/(4 - 4^(1/5))",
   .order = 6,
   .kind = STF_VERLET,
   .kick_first = true,
   .count = 12,
   .given = {0.15463234286727187740293645L, 0.15463234286727187740293645L,
             -0.245463543735814684835882759L, 0.15463234286727187740293645L,
             0.15463234286727187740293645L, 0.15463234286727187740293645L,
             0.15463234286727187740293645L, -0.245463543735814684835882759L,
             0.15463234286727187740293645L, 0.15463234286727187740293645L,
             -0.204038599674711772469391737L, -0.204038599674711772469391737L}},
  {.name = "suzuki8",
   .about = "15 Verlet steps: M. Suzuki and K. Umeno, Springer Proc. Phys. 76 (1993)",
   .order = 8,
   .kind = STF_VERLET,
   .kick_first = true,
   .count = 7,
   .given = {0.74167036435061295344822780L, -0.40910082580003159399730010L,
             0.19075471029623837995387626L, -0.57386247111608226665638773L,
             0.29906418130365592384446354L, 0.33462491824529818378495798L,
             0.31529309239676659663205666L}},
  {.name = "kahanli8",
   .about = "17 Verlet steps: W. Kahan and R.-C. Li, Math. Comp. 66 (1997)",
   .order = 8,
   .kind = STF_VERLET,
   .kick_first = true,
   .count = 8,
   .given = {0.13020248308889008087881763L, 0.56116298177510838456196441L,
             -0.38947496264484728640807860L, 0.15884190655515560089621075L,
             -0.39590389413323757733623154L, 0.18453964097831570709183254L,
             0.25837438768632204729397911L, 0.29501172360931029887096624L}},
};
const size_t stf_splitting_count = sizeof stf_splittings / sizeof *stf_splittings;

const stf_splitting *stf_splitting_find(const char *name)
{
  for (size_t i = 0; i < stf_splitting_count; i++)
    if (!strcmp(stf_splittings[i].name, name)) return &stf_splittings[i];
  return NULL;
}

enum { FLOWS = 4 * STF_GIVEN + 3 };

/* Verlet steps w: halves of the first flow join where two steps meet. */
static int flows_of_steps(const stf_splitting *x, long double *flow)
{
  const int steps = 2 * x->count + 1, middle = x->count;
  long double w[2 * STF_GIVEN + 1], sum = 0;
  for (int i = 0; i < middle; i++) w[i] = w[steps - 1 - i] = x->given[i], sum += w[i];
  w[middle] = 1 - 2 * sum;
  for (int i = 0; i < steps; i++) {
    flow[2 * i] = ((i ? w[i - 1] : 0) + w[i]) / 2;
    flow[2 * i + 1] = w[i];
  }
  flow[2 * steps] = w[steps - 1] / 2;
  return 2 * steps + 1;
}

static int alternating_flows(const stf_splitting *x, long double *flow)
{
  const int middle = x->count + 1, flows = 2 * middle + 1;
  long double sum[2] = {0, 0}; /* of the flows at even and odd places of the half */
  for (int i = 0; i < x->count; i++) flow[i] = x->given[i], sum[i % 2] += flow[i];
  flow[x->count] = 0.5L - sum[x->count % 2];
  flow[middle] = 1 - 2 * sum[middle % 2];
  for (int i = 0; i < middle; i++) flow[flows - 1 - i] = flow[i];
  return flows;
}

static int flows_of(const stf_splitting *x, long double *flow)
{
  flow[0] = flow[1] = 1;
  switch (x->kind) {
  case STF_VERLET: return flows_of_steps(x, flow);
  case STF_ALTERNATING: return alternating_flows(x, flow);
  default: return 2;
  }
}

void stf_splitting_passes(const stf_splitting *x, bool kick_first, stf_passes *p)
{
  long double flow[FLOWS], kicked = 0, drifted = 0;
  const int count = flows_of(x, flow);
  *p = (stf_passes){.kick_first = x->kind == STF_ALTERNATING ? x->kick_first : kick_first};
  for (int i = 0; i < count; p->count++) {
    p->kick_at[p->count] = (sunrealtype)drifted;
    if (p->count > 0 || p->kick_first) {
      p->kick[p->count] = (sunrealtype)flow[i];
      kicked += flow[i++], p->kicks++;
    }
    p->drift_at[p->count] = (sunrealtype)kicked;
    if (i < count) p->drift[p->count] = (sunrealtype)flow[i], drifted += flow[i++];
  }
  p->reuses = p->kick_first && p->drift[p->count - 1] == 0;
  if (p->reuses) p->kicks--;
}
