/* two_by_two.c: phi_0 .. phi_p of one number or of one 2 x 2 matrix, z = a + b N with N^2 = q.
 *
 * A Taylor series for |z| <= 1/2, then phi_l(2z) = 2^{-l} (phi_0(z) phi_l(z) + sum_{j=1}^{l}
 * phi_j(z)/(l-j)!), in twice the working precision: where q >= 0 no term cancels beyond the
 * conditioning of the values, and b of the result is the divided difference phi_l[a + b sqrt q,
 * a - b sqrt q] in units of z.b.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matfun.h"

/* 1/k! = hi + lo, rounded from exact rationals. */
static const stf_two inverse_factorial[] = {
  {1, 0},
  {1, 0},
  {0.5, 0},
  {0.16666666666666666, 9.2518585385429707e-18},
  {0.041666666666666664, 2.3129646346357427e-18},
  {0.0083333333333333332, 1.1564823173178714e-19},
  {0.0013888888888888889, -5.3005439543735771e-20},
  {0.00019841269841269841, 1.7209558293420705e-22},
  {2.4801587301587302e-05, 2.1511947866775882e-23},
  {2.7557319223985893e-06, -1.8583932740464721e-22},
  {2.7557319223985888e-07, 2.3767714622250297e-23},
  {2.505210838544172e-08, -1.448814070935912e-24},
  {2.08767569878681e-09, -1.20734505911326e-25},
  {1.6059043836821613e-10, 1.2585294588752098e-26},
  {1.1470745597729725e-11, 2.0655512752830745e-28},
  {7.6471637318198164e-13, 7.03872877733453e-30},
  {4.7794773323873853e-14, 4.3992054858340813e-31},
  {2.8114572543455206e-15, 1.6508842730861433e-31},
  {1.5619206968586225e-16, 1.1910679660273754e-32},
  {8.2206352466243295e-18, 2.2141894119604265e-34},
  {4.1103176233121648e-19, 1.4412973378659527e-36},
  {1.9572941063391263e-20, -1.3643503830087908e-36},
  {8.8967913924505741e-22, -7.9114026148723762e-38},
  {3.8681701706306841e-23, -8.8431776554823438e-40},
  {1.6117375710961184e-24, -3.6846573564509766e-41},
  {6.4469502843844736e-26, -1.9330404233703465e-42},
  {2.4795962632247976e-27, -1.2953730964765229e-43},
  {9.183689863795546e-29, 1.4303150396787322e-45},
  {3.2798892370698378e-30, 1.5117542744029879e-46},
  {1.1309962886447716e-31, 1.0498015412959506e-47},
  {3.7699876288159054e-33, 2.5870347832750324e-49},
  {1.2161250415535179e-34, 5.5862905678888058e-51},
  {3.8003907548547434e-36, 1.7457158024652518e-52},
};

/* 2^{-23}/23! is below the square of the round-off. */
enum { TERMS = 22 };
_Static_assert(TERMS + STEIF_PHI_MOST < sizeof inverse_factorial / sizeof *inverse_factorial,
               "the table reaches 1/(TERMS + p)!");

stf_two stf_inverse_factorial(int k) { return inverse_factorial[k]; }

static stf_jet constant(int k) { return (stf_jet){inverse_factorial[k], {0, 0}}; }

double stf_spot_size(const stf_spot *s)
{
  return fabs(s->z.a.hi) + fabs(s->z.b.hi) * sqrt(fabs(s->q.hi));
}

/* phi_{l-1} = z phi_l + 1/(l-1)! from l = `from` down. */
static void descend(stf_spot *s, int from)
{
  for (int l = from; l > 0; l--)
    s->phi[l - 1] = stf_jet_add(stf_jet_mul(s->z, s->phi[l], s->q), constant(l - 1));
}

static void taylor(stf_spot *s)
{
  stf_jet sum = constant(TERMS + s->p);
  for (int k = TERMS - 1; k >= 0; k--)
    sum = stf_jet_add(stf_jet_mul(sum, s->z, s->q), constant(k + s->p));
  s->phi[s->p] = sum;
  descend(s, s->p);
}

/* phi_0 is squared only where |z| is large: 1 + z phi_1 does not pile up the round-off of many
 * doublings from a tiny z. */
void stf_spot_double(stf_spot *s)
{
  stf_jet next[STEIF_PHI_MOST + 1];
  double scale = 1;
  for (int l = 0; l <= s->p; l++, scale /= 2) {
    stf_jet sum = stf_jet_mul(s->phi[0], s->phi[l], s->q);
    for (int j = 1; j <= l; j++)
      sum = stf_jet_add(sum, stf_jet_times(inverse_factorial[l - j], s->phi[j]));
    next[l] = stf_jet_scale(sum, scale);
  }
  for (int l = 0; l <= s->p; l++) s->phi[l] = next[l];
  s->z = stf_jet_scale(s->z, 2);
  if (stf_spot_size(s) <= 0.5) descend(s, 1);
}

void stf_spot_open(stf_spot *s, int p, stf_jet z, stf_two q)
{
  *s = (stf_spot){.p = p > 0 ? p : 1, .z = z, .q = q};
  int halvings = 0;
  for (double size = stf_spot_size(s); size > 0.5; size /= 2) halvings++;
  s->z = stf_jet_scale(z, ldexp(1, -halvings));
  taylor(s);
  for (int k = 0; k < halvings; k++) stf_spot_double(s);
}
