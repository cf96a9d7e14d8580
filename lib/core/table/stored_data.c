/* stored_data.c: tables and splits that are asked for most, as collocation.c and split.c compute them
 * (80-bit arithmetic, rounded once; hexadecimal so that no digit is lost). A test computes them again.
 * SPDX-License-Identifier: BSD-3-Clause */
/* clang-format off */
#include "stored.h"

static const struct {
  double c[2], b[2], A[4], A_low[4], B[4], T[4], Tinv[4], re[1], im[1];
} gauss2 = {
  .c = {
    0x1.b0cb174df99c7p-3, 0x1.93cd3a2c8198ep-1},
  .b = {
    0x1p-1, 0x1p-1},
  .A = {
    0x1p-2, -0x1.3cd3a2c8198e2p-5, 0x1.13cd3a2c8198ep-1, 0x1p-2},
  .A_low = {
    0x0p+0, -0x1.a48p-59, 0x1.34p-56, -0x1p-66},
  .B = {
    0x1.8p+1, 0x1.db3d742c26554p-2, -0x1.9db3d742c2655p+2, 0x1.8p+1},
  .T = {
    0x1.c37bdd2a23d89p-65, 0x1.126145e9ecd56p-1, 0x1p+1, 0x0p+0},
  .Tinv = {
    0x0p+0, 0x1p-1, 0x1.ddb3d742c2655p+0, -0x1.a53d7b2af662cp-65},
  .re = {
    0x1.8p+1},
  .im = {
    0x1.bb67ae8584caap+0},
};

static const struct {
  double c[3], b[3], A[9], A_low[9], B[9], T[9], Tinv[9], re[2], im[2];
} gauss3 = {
  .c = {
    0x1.cda042f0236e1p-4, 0x1p-1, 0x1.c64bf7a1fb924p-1},
  .b = {
    0x1.1c71c71c71c72p-2, 0x1.c71c71c71c71cp-2, 0x1.1c71c71c71c72p-2},
  .A = {
    0x1.1c71c71c71c72p-3, -0x1.26b88a4e09a62p-5, 0x1.40c7cef225974p-7, 0x1.337831ea8a881p-2,
    0x1.c71c71c71c71cp-3, -0x1.7066ace18c0fbp-6, 0x1.126b88a4e09a6p-2, 0x1.ebf38310dda69p-2,
    0x1.1c71c71c71c72p-3},
  .A_low = {
    -0x1.c6p-58, -0x1.fbp-60, 0x1.95p-61, 0x1.dp-56,
    0x1.c8p-57, 0x1.86p-61, 0x1.1fp-57, -0x1.18p-56,
    -0x1.c6p-58},
  .B = {
    0x1.4p+2, 0x1.29fa72e28d245p+0, -0x1.4fd3971469224p-3, -0x1.6e8f21f3660dbp+2,
    0x1p+1, 0x1.74790f9b306d6p-1, 0x1.453f4e5c51a49p+3, -0x1.253f4e5c51a49p+3,
    0x1.4p+2},
  .T = {
    0x1.2788b34ec442ap-4, -0x1.50dc2e3b25062p-3, -0x1.ec8253c5cd298p-4, 0x1.e6bcfd764a45ep-4,
    0x1.b2b58fa97c528p-4, 0x1.43cb41c5c5d64p-1, 0x1p+0, 0x1p+1,
    -0x0p+0},
  .Tinv = {
    0x1.7f77fb3e94137p+2, 0x1.23a38c4cd45fp+0, 0x1.bab006d97718p-2, -0x1.7f77fb3e94137p+1,
    -0x1.23a38c4cd45fp-1, 0x1.22a7fc934474p-2, -0x1.3f07d545e4daep-1, 0x1.7678bd0d72584p+0,
    -0x1.07ebbc91fd4e9p-3},
  .re = {
    0x1.293d5ea4af41fp+2, 0x1.d6c2a15b50be1p+1},
  .im = {
    0x0p+0, 0x1.c11f1c4eff056p+1},
};

static const struct {
  double c[4], b[4], A[16], A_low[16], B[16], T[16], Tinv[16], re[2], im[2];
} gauss4 = {
  .c = {
    0x1.1c6490c2719ecp-4, 0x1.51ee013116102p-2, 0x1.5708ff6774f7fp-1, 0x1.dc736de7b1cc3p-1},
  .b = {
    0x1.64340f7e7b66bp-3, 0x1.4de5f840c24cap-2, 0x1.4de5f840c24cap-2, 0x1.64340f7e7b66bp-3},
  .A = {
    0x1.64340f7e7b66bp-4, -0x1.b3e204d9b9c89p-6, 0x1.9dc6d5a4276fbp-7, -0x1.d1fb07440878dp-9,
    0x1.81441253937e8p-3, 0x1.4de5f840c24cap-3, -0x1.c8cafe42f2e69p-6, 0x1.b96af2c6963cbp-8,
    0x1.5668b7e846b4dp-3, 0x1.6a72a824f17b1p-2, 0x1.4de5f840c24cap-3, -0x1.d1002d51817d2p-7,
    0x1.6b7bfb9b8b889p-3, 0x1.40f7c193a1113p-2, 0x1.6924188e5de93p-2, 0x1.64340f7e7b66bp-4},
  .A_low = {
    0x1.1cp-59, 0x1.228p-60, -0x1.32p-61, 0x1.9d8p-63,
    0x1.eep-58, 0x1.ba8p-57, -0x1.c2p-62, -0x1.8d8p-62,
    -0x1.8dp-58, 0x1.8p-64, 0x1.b9p-57, 0x1.6dp-61,
    0x1.56p-57, -0x1.9dp-56, -0x1.8p-60, 0x1.18p-59},
  .B = {
    0x1.ef456e91b52c7p+2, 0x1.05c57f66b8c03p+1, -0x1.bf8f7d094e44fp-2, 0x1.62e4d7f57221cp-4,
    -0x1.cce2c55c45715p+2, 0x1.217522dc95a71p+1, 0x1.72e361215ac0cp+0, -0x1.dd755947261bcp-3,
    0x1.95fde80bcb15fp+2, -0x1.7e2dfb24ec574p+2, 0x1.217522dc95a71p+1, 0x1.1742206ace30fp+0,
    -0x1.f20b3841a010cp+3, 0x1.7c91af7ed4ce5p+3, -0x1.b0069370388c3p+3, 0x1.ef456e91b52c7p+2},
  .T = {
    -0x1.946a2f3b6c72cp-6, 0x1.80f937d2bd47fp-5, 0x1.93698673ce95ep-4, -0x1.8b72bfa448f1p-7,
    0x1.d35b4c13b3bcp-5, 0x1.8a8eac17e92p-6, -0x1.f51dbefe2b6d5p-3, -0x1.4255622712429p-4,
    0x1.77d3a6a644b36p-2, 0x1.cab6d9b1bb217p-3, 0x1.8d51950cc90b1p-3, 0x1.76bf1ce645fddp-1,
    0x1p+1, 0x0p+0, 0x1p+1, 0x0p+0},
  .Tinv = {
    -0x1.17d17b33c260cp+1, 0x1.267a219113a2bp+1, 0x1.b0c334f9bc534p-3, 0x1.7976dfbadbe46p-2,
    0x1.d144fb5f5555bp+3, 0x1.5d83834fc6e6cp+2, 0x1.a75f6f9cff9a8p-1, -0x1.064e4468645e2p-3,
    0x1.17d17b33c260cp+1, -0x1.267a219113a2bp+1, -0x1.b0c334f9bc534p-3, 0x1.0d12408a48375p-3,
    -0x1.f7603e6d793f9p+1, -0x1.1b85f054c3906p+1, 0x1.1031ed69116ffp+0, -0x1.719a26325a85ap-3},
  .re = {
    0x1.72b7076eb891ap+2, 0x1.0d48f891476e6p+2},
  .im = {
    0x1.bc061c9b7f5bp+0, 0x1.5426463ec99d4p+2},
};

static const struct {
  double c[2], b[2], A[4], A_low[4], B[4], T[4], Tinv[4], re[1], im[1];
} radau2 = {
  .c = {
    0x1.5555555555555p-2, 0x1p+0},
  .b = {
    0x1.8p-1, 0x1p-2},
  .A = {
    0x1.aaaaaaaaaaaabp-2, -0x1.5555555555555p-4, 0x1.8p-1, 0x1p-2},
  .A_low = {
    -0x1.548p-56, -0x1.56p-58, 0x1p-64, 0x0p+0},
  .B = {
    0x1.8p+0, 0x1p-1, -0x1.2p+2, 0x1.4p+1},
  .T = {
    0x1.c71c71c71c71cp-3, 0x1.41cfe93ff5199p-1, 0x1p+1, 0x0p+0},
  .Tinv = {
    0x0p+0, 0x1p-1, 0x1.974b2334f2346p+0, -0x1.6a09e667f3bcdp-3},
  .re = {
    0x1p+1},
  .im = {
    0x1.6a09e667f3bcdp+0},
};

static const struct {
  double c[3], b[3], A[9], A_low[9], B[9], T[9], Tinv[9], re[2], im[2];
} radau3 = {
  .c = {
    0x1.3d8b64657cae9p-3, 0x1.4a36c0803a6dfp-1, 0x1p+0},
  .b = {
    0x1.816fcdf1a6a67p-2, 0x1.06648ace491e9p-1, 0x1.c71c71c71c71cp-4},
  .A = {
    0x1.9313fe302d93bp-3, -0x1.0c6edfec18b84p-4, 0x1.8576b15adbb79p-6, 0x1.93e3f7b234d43p-2,
    0x1.2b154adc88802p-2, -0x1.545e0c7243c2cp-5, 0x1.816fcdf1a6a67p-2, 0x1.06648ace491e9p-1,
    0x1.c71c71c71c71cp-4},
  .A_low = {
    0x1.f9p-57, 0x1.2bp-58, 0x1.c18p-60, -0x1.cbp-57,
    -0x1.d38p-56, -0x1.cbp-60, 0x1.c98p-56, -0x1.1dp-55,
    0x1.c5p-58},
  .B = {
    0x1.9cc470a049097p+1, 0x1.2af7915ab4027p+0, -0x1.034624ce046cap-2, -0x1.c8aefbe08d347p+1,
    0x1.8cee3d7edbda3p-1, 0x1.0d9e56004de7fp+0, 0x1.620bd700c2c3ep+2, -0x1.e20bd700c2c3ep+2,
    0x1.4p+2},
  .T = {
    0x1.82d23845d677bp-4, -0x1.214a74c403bf7p-2, -0x1.ebff91a6d688fp-5, 0x1.0037de70aa1edp-2,
    0x1.a20e91e20b551p-2, 0x1.8821fa2a36dedp-1, 0x1p+0, 0x1p+1,
    -0x0p+0},
  .Tinv = {
    0x1.0b70201a79c47p+2, 0x1.4f8c15da84e86p-2, 0x1.0bf7ff59d56efp-1, -0x1.0b70201a79c47p+1,
    -0x1.4f8c15da84e86p-3, 0x1.e810014c55221p-3, -0x1.017885a24a7f2p-2, 0x1.4934e6fcaa598p+0,
    -0x1.312c0cf7bdfd1p-2},
  .re = {
    0x1.d1a48d83e731dp+1, 0x1.572db93e0c672p+1},
  .im = {
    0x0p+0, 0x1.86747f2c3fcb5p+1},
};

static const struct {
  double c[4], b[4], A[16], A_low[16], B[16], T[16], Tinv[16], re[2], im[2];
} radau4 = {
  .c = {
    0x1.6adb354ed2ae1p-4, 0x1.a34b481e46449p-2, 0x1.934819d94bac8p-1, 0x1p+0},
  .b = {
    0x1.c381b1181084dp-3, 0x1.8d8296b4cf125p-2, 0x1.50bc90bf28ab5p-2, 0x1p-4},
  .A = {
    0x1.ced88ac2871a4p-4, -0x1.4a36901783436p-5, 0x1.a6bf03cb7b2f8p-6, -0x1.448e72d68cb3p-7,
    0x1.e004b76386efep-3, 0x1.a7b74b36b3769p-3, -0x1.880babfb2abc3p-5, 0x1.06ebc508e68dfp-6,
    0x1.bbc3a8d4c4262p-3, 0x1.9fdec6e1d212p-2, 0x1.832593fa5220ep-3, -0x1.8c33196c5dc78p-6,
    0x1.c381b1181084dp-3, 0x1.8d8296b4cf125p-2, 0x1.50bc90bf28ab5p-2, 0x1p-4},
  .A_low = {
    0x1.15p-58, 0x1.adp-60, -0x1.268p-60, 0x1.4b8p-61,
    -0x1.2p-57, 0x1.6ap-59, -0x1.6p-65, 0x1.08p-61,
    0x1.e9p-57, 0x1.128p-56, -0x1.5p-59, 0x1.aap-61,
    0x1.d3p-58, -0x1.e6p-56, -0x1.1cp-57, 0x1.8p-66},
  .B = {
    0x1.6939103d934e6p+2, 0x1.ec6af91091689p+0, -0x1.2bfb4770a0ad1p-1, 0x1.641a556e4f586p-3,
    -0x1.4326552798095p+2, 0x1.389a02f13f52cp+0, 0x1.c132c5f5a4076p+0, -0x1.bd39f909f3cdcp-2,
    0x1.bf09218ed76cap+1, -0x1.fe04aeb25b352p+1, 0x1.45037830e6e77p-1, 0x1.d2779c12164c5p+0,
    -0x1.bb1a6e7ceb173p+2, 0x1.a6185fbd199bcp+2, -0x1.857ef8a017425p+3, 0x1.1p+3},
  .T = {
    -0x1.8209588c52f11p-6, 0x1.2268baf59c74ap-4, 0x1.07b499f8d24eap-3, -0x1.726951dbf08e6p-4,
    0x1.7ba76ab719fdep-4, 0x1.07d79e9b76576p-4, -0x1.8f5d380f1d85cp-2, 0x1.e43590d5c2a78p-5,
    0x1.58ee9447178bfp-1, 0x1.022f37788094fp-2, 0x1.2b1c3722ce28ep-1, 0x1.bc4a8bc9555f9p-1,
    0x1p+1, 0x0p+0, 0x1p+1, 0x0p+0},
  .Tinv = {
    -0x1.c7c3c3dc8aff4p-1, 0x1.d4c498859791fp+0, -0x1.bd6e5bb7233c4p-3, 0x1.e9622248b682cp-2,
    0x1.1f6182fecd3b9p+3, 0x1.58e6cd1406f87p+1, 0x1.8136ca251723bp-1, -0x1.170d3e7eabe43p-2,
    0x1.c7c3c3dc8aff4p-1, -0x1.d4c498859791fp+0, 0x1.bd6e5bb7233c4p-3, 0x1.69dddb7497d47p-6,
    -0x1.42406c975f19p+1, -0x1.f18c266e1a8bbp-1, 0x1.e995db5481415p-1, -0x1.3a15e25ad5415p-2},
  .re = {
    0x1.32615f2e64b48p+2, 0x1.9b3d41a33697p+1},
  .im = {
    0x1.9146226bd0f14p+0, 0x1.317a43b6b7cafp+2},
};

static const struct {
  double c[5], b[5], A[25], A_low[25], B[25], T[25], Tinv[25], re[3], im[3];
} radau5 = {
  .c = {
    0x1.d3cc2dd8d6d32p-5, 0x1.1b7cbc26ceaaep-2, 0x1.2acc5d7a90e51p-1, 0x1.b8716522b33bep-1,
    0x1p+0},
  .b = {
    0x1.26534b9cb85e2p-3, 0x1.201bca8e66374p-2, 0x1.3f4f73b8d3267p-2, 0x1.c8eab2b61c94ap-3,
    0x1.47ae147ae147bp-5},
  .A = {
    0x1.2b00db6e3fa2dp-4, -0x1.b6081b30682ap-6, 0x1.3200b8a1aa037p-6, -0x1.a605c5bc79bfcp-7,
    0x1.4a7ccd96a885cp-8, 0x1.3aee82311a74fp-3, 0x1.2b72b35cc0671p-3, -0x1.2a8dccf20f1a7p-5,
    0x1.5be1ebec3e8bdp-6, -0x1.040878141910fp-7, 0x1.1ed95fc4c15b4p-3, 0x1.3224706ef9eacp-2,
    0x1.5736d75c3ae6dp-3, -0x1.16465e9a31545p-5, 0x1.669f591dfd1acp-7, 0x1.28be58d5a7ef5p-3,
    0x1.1b22d582aaa26p-2, 0x1.4d9df880051b7p-2, 0x1.07b19ee2f3ab4p-3, -0x1.015ff99971365p-6,
    0x1.26534b9cb85e2p-3, 0x1.201bca8e66374p-2, 0x1.3f4f73b8d3267p-2, 0x1.c8eab2b61c94ap-3,
    0x1.47ae147ae147bp-5},
  .A_low = {
    -0x1.28p-60, -0x1.e9p-60, 0x1.45p-60, 0x1.c7p-62,
    0x1.dfp-62, 0x1.d68p-57, -0x1.a88p-57, -0x1.5d8p-59,
    0x1.69p-61, -0x1.208p-61, -0x1.44p-60, 0x1.a7p-56,
    0x1.69p-57, -0x1.d5p-59, -0x1.74p-61, -0x1.bb8p-57,
    0x1.e88p-56, -0x1.2cp-58, -0x1.ap-62, -0x1.ec8p-60,
    0x1.85p-58, -0x1.38p-57, -0x1.dcp-58, -0x1.7f8p-57,
    -0x1.dcp-61},
  .B = {
    0x1.1830877b703d6p+3, 0x1.722b2cf57bb01p+1, -0x1.c0186e6b2b212p-1, 0x1.994c52709276dp-2,
    -0x1.11d489880c497p-3, -0x1.ca540fccceadfp+2, 0x1.ce5b1c16f92e6p+0, 0x1.2e90e7e6cbc1p+1,
    -0x1.bb5758d9cb3c5p-1, 0x1.18ec14c05e2bbp-2, 0x1.07d18e2e54ad5p+2, -0x1.1fbebe9d67f6fp+2,
    0x1.b6a9ef2aa91c1p-1, 0x1.42585742d8bacp+1, -0x1.506a879a9f92ep-1, -0x1.f078095074d2fp+1,
    0x1.b252cd53396d6p+1, -0x1.4c0dc7046124bp+2, 0x1.299760f060b19p-1, 0x1.67ad8b5edc468p+1,
    0x1.0d3294490d4d2p+3, -0x1.be18ad1c72325p+2, 0x1.18de1e9b82aadp+3, -0x1.23822e2b2b6f6p+4,
    0x1.ap+3},
  .T = {
    0x1.bce3049d4571bp-7, -0x1.7820c3d05d519p-6, -0x1.cb6719b83f651p-6, -0x1.4f9c863603a7fp-6,
    0x1.868b5dfabb152p-4, 0x1.a81f7541182a2p-10, -0x1.f695a1442b72fp-7, 0x1.94d34a11716e1p-5,
    0x1.9b041f87f5bd6p-4, -0x1.826214e5b71e4p-3, 0x1.443b067594e3ap-4, 0x1.3dd30e1ded383p-5,
    0x1.4f0de33f576c9p-3, -0x1.d8251c7936647p-2, 0x1.a4abf2d1b7462p-3, 0x1.a6267562c234ap-2,
    0x1.a1623391d6c89p-1, 0x1.98f319cae0a7ep-2, 0x1.82f69e7e11149p-1, 0x1.ddf22c5d8318fp-1,
    0x1p+0, 0x1p+1, 0x0p+0, 0x1p+1,
    0x0p+0},
  .Tinv = {
    0x1.bb29c0f2d2f98p+4, 0x1.99111aaad89ebp+3, 0x1.9aafc7bcbfa6dp+1, -0x1.e729c05622205p-1,
    0x1.7bac81b18745bp-1, -0x1.0855c54b1b4f1p+4, -0x1.1608005f0b102p+3, -0x1.608533caefc2p-4,
    -0x1.96330c92fc51ep-5, 0x1.0ffd21b07b821p-2, -0x1.1390f2f71cd09p+2, 0x1.366654626d079p+2,
    0x1.ea2ba7f8366fcp-1, 0x1.3597b31c9da03p+0, -0x1.0c2691306fb5ap-1, 0x1.5607268d8e926p+1,
    0x1.25fdcc267b033p+1, -0x1.84a7748010aabp+0, 0x1.0cf810f440d55p-1, -0x1.175346c4058f7p-3,
    0x1.dfc06c7c33f87p+0, -0x1.fe135b74a3869p+0, -0x1.0b5ed2d02325fp-1, 0x1.2f21157164963p-1,
    -0x1.ccb73e72d9b82p-3},
  .re = {
    0x1.92595ee3123e2p+2, 0x1.6cdc6b397464ep+2, 0x1.d3edcaaa04f82p+1},
  .im = {
    0x0p+0, 0x1.9ae9fbb266469p+1, 0x1.a2cc95da18518p+2},
};

static const struct {
  double c[7], b[7], A[49], A_low[49], B[49], T[49], Tinv[49], re[4], im[4];
} radau7 = {
  .c = {
    0x1.e05201f8c2062p-6, 0x1.2f43d53682496p-3, 0x1.591283c00a7e2p-2, 0x1.1e0a317ca931cp-1,
    0x1.89d90550ca2b2p-1, 0x1.da989f7ef95f1p-1, 0x1p+0},
  .b = {
    0x1.3120de1741e2p-4, 0x1.45d7547e674b8p-3, 0x1.b2e58c2545d3dp-3, 0x1.c9d728b559d1fp-3,
    0x1.8617b942de854p-3, 0x1.e9f01a14371c2p-4, 0x1.4e5e0a72f0539p-6},
  .A = {
    0x1.339439878c04p-5, -0x1.cc0a796388665p-7, 0x1.533d7e60f7a16p-7, -0x1.0b54f84016f6ep-7,
    0x1.a2abccaf980e9p-8, -0x1.2d9e3b007fb24p-8, 0x1.df7241f37c4edp-10, 0x1.4848d89e338e7p-4,
    0x1.4c07bc1c40287p-4, -0x1.5bf69865d58fp-6, 0x1.cac2f480aa399p-7, -0x1.4f5a928186d41p-7,
    0x1.d4cf3ae0d0d66p-8, -0x1.70a8843d67503p-9, 0x1.272c6b9d6de7dp-4, 0x1.5e5915f04a5dcp-3,
    0x1.c0fb337b7a802p-4, -0x1.935f39fa17c8p-6, 0x1.e3ab045717476p-7, -0x1.39c318fadf2ccp-7,
    0x1.e162a3357877dp-9, 0x1.361693f89245cp-4, 0x1.3b939e87c4fffp-3, 0x1.d11ddc6d709b8p-3,
    0x1.e130ceb5140a4p-4, -0x1.861dd8fa6f242p-6, 0x1.a07b16199008p-7, -0x1.2e0b9375e30a2p-8,
    0x1.2ebeb545c9676p-4, 0x1.4a74cf0de4b92p-3, 0x1.a7aa0328a3e17p-3, 0x1.e563fc8a8784fp-3,
    0x1.a63e566e09258p-4, -0x1.34e7fdc37e032p-6, 0x1.7ff80c13e0dccp-8, 0x1.31fe759e0499cp-4,
    0x1.443693ea05bdep-3, 0x1.b69611ea12931p-3, 0x1.c24f5110ef0fep-3, 0x1.970b5a3508124p-3,
    0x1.1bb624822fe97p-4, -0x1.09f202e443882p-7, 0x1.3120de1741e2p-4, 0x1.45d7547e674b8p-3,
    0x1.b2e58c2545d3dp-3, 0x1.c9d728b559d1fp-3, 0x1.8617b942de854p-3, 0x1.e9f01a14371c2p-4,
    0x1.4e5e0a72f0539p-6},
  .A_low = {
    0x1.8bp-60, -0x1.8e8p-61, 0x1.62p-63, -0x1.55p-61,
    0x1.b98p-62, 0x1.63p-63, 0x1.ep-69, 0x1.34p-59,
    -0x1.32p-59, 0x1.88p-61, 0x1.95p-62, -0x1.98p-62,
    0x1.78p-66, 0x1.d8p-63, -0x1.4fp-58, 0x1.74p-59,
    -0x1.ccp-61, 0x1.8ap-60, 0x1.24p-62, 0x1.f8p-62,
    -0x1.b6p-65, 0x1.9ep-58, 0x1.4cp-59, -0x1.f8p-61,
    -0x1.18p-59, 0x1.9p-61, 0x1.a8p-64, -0x1.d3p-62,
    0x1.9ep-58, 0x1.b98p-57, -0x1.79p-58, 0x1.77p-57,
    -0x1.64p-60, -0x1.dd8p-60, 0x1.bd8p-62, 0x1.02p-58,
    -0x1.5ap-58, 0x1.628p-57, 0x1.798p-57, -0x1.4cp-58,
    -0x1.a9p-59, -0x1.3cp-61, 0x1.64p-58, 0x1.6p-60,
    -0x1.7p-57, -0x1.14p-59, -0x1.52p-58, 0x1.7cp-58,
    0x1.e88p-60},
  .B = {
    0x1.10e271cb7791ep+4, 0x1.5e6b4ea5290d6p+2, -0x1.9e5b54d0b7ccap+0, 0x1.7fd2aa783109ap-1,
    -0x1.b0044af93ef83p-2, 0x1.01134eaf5e426p-2, -0x1.7a2996fbbb1c3p-4, -0x1.9e5e1d8c35692p+3,
    0x1.b033f129f053cp+1, 0x1.0374f50e39c6dp+2, -0x1.7c7f129e892cbp+0, 0x1.8bb394e2e532cp-1,
    -0x1.c7a02c2abc0aap-2, 0x1.4b5088ba15d6bp-3, 0x1.a1b70c95575d5p+2, -0x1.ba633432bb25ap+2,
    0x1.7bd6d6c033dd7p+0, 0x1.cc1bf674bd6fp+1, -0x1.7341546366556p+0, 0x1.88b9437c04588p-1,
    -0x1.15f15953c2b8ep-2, -0x1.30aaa65fb16ebp+2, 0x1.fed482ca90257p+1, -0x1.6a48b7b87a2f5p+2,
    0x1.ca3adb68c00bdp-1, 0x1.de31f385d1d9ap+1, -0x1.8abf1a6795a2ap+0, 0x1.05ff338e6294bp-1,
    0x1.1515b9b786376p+2, -0x1.ad4067d2b6a47p+1, 0x1.d8662b1bb0d68p+1, -0x1.82634612c966dp+2,
    0x1.4ccc751bd2ac9p-1, 0x1.24f27fa5d4d5dp+2, -0x1.3e7a7f13d9a8bp+0, -0x1.3c64553829083p+2,
    0x1.da36f95dd5b12p+1, -0x1.df74077c39556p+1, 0x1.3206cf42c3b31p+2, -0x1.1911854bd811fp+3,
    0x1.142d03e452014p-1, 0x1.5c6541966637cp+2, 0x1.6fdac4dfd37d5p+3, -0x1.108bdb7756224p+3,
    0x1.0c31688e961e8p+3, -0x1.4111f43a2e702p+3, 0x1.e305467242cd3p+3, -0x1.135ce90bc9f5bp+5,
    0x1.9p+4},
  .T = {
    0x1.404915594ff5bp-9, -0x1.44b423796b1ccp-9, -0x1.69d6f3976638bp-8, -0x1.09c251d158d33p-7,
    0x1.2224a3e316d81p-7, 0x1.615cdded5bb91p-5, 0x1.1fd1e87d8734ep-6, -0x1.dbe161aec270ep-10,
    -0x1.179e73af3cd03p-13, 0x1.a186cc6484147p-8, 0x1.13c2e74335c5ep-6, -0x1.083ce38b117eap-7,
    -0x1.385fdcb5c18d7p-4, -0x1.60acbeb1e0799p-5, 0x1.2dd0c5d07774fp-8, -0x1.344e18cac272cp-8,
    0x1.b528d3f9b4dfbp-11, -0x1.188219b981005p-6, -0x1.c5b83bfac286p-7, 0x1.d6313419932dbp-4,
    0x1.e21a8149adf6cp-4, 0x1.24c84f75861c9p-6, 0x1.984c7172b55a2p-8, 0x1.9b82ad2c253c3p-5,
    -0x1.32252ceffcfe5p-4, 0x1.0df9cd7305315p-6, -0x1.390e05673870bp-4, -0x1.536dd24148f21p-2,
    0x1.0683c3ad482f3p-3, 0x1.a0a2c5e6ea782p-3, 0x1.854ded613adfp-3, 0x1.5fb7509be8d64p-7,
    0x1.8bb245070754ap-2, -0x1.fe4f0cac5be13p-2, 0x1.1820faaf29e23p-1, 0x1.0a45fab3ebcc8p-1,
    0x1.0b23122b28b41p+0, 0x1.064a956df5512p-2, 0x1.0d9b23131c6f7p+0, 0x1.1a25b03d9d468p-1,
    0x1.102bdcf5bd592p+0, 0x1.f1fe9d1a481ep-1, 0x1p+0, 0x1p+1,
    -0x0p+0, 0x1p+1, -0x0p+0, 0x1p+1,
    -0x0p+0},
  .Tinv = {
    0x1.c707d62ee24b7p+7, 0x1.4d4bc999d2eap+7, 0x1.5a1f04ce35ac3p+5, 0x1.cfc16a45f60dep+1,
    0x1.c94d68af5b718p+1, -0x1.5f2cdae07fe1fp+1, 0x1.7392758f0ebd1p+0, -0x1.2b2fadf366499p+7,
    -0x1.e614dc93b471dp+6, -0x1.86378257c6165p+4, -0x1.04f3337537c1dp+0, 0x1.ac6e71a216dacp-1,
    -0x1.165e250234761p-1, 0x1.cdcad9a779fadp-2, -0x1.744e56c68a22bp+5, 0x1.7e1b292a9dd8ep+3,
    0x1.3a3b25d212a3fp+4, 0x1.cc71ff4ec2bd5p+2, -0x1.c1560ba4057bep+0, 0x1.37400f3fa8d28p+1,
    -0x1.1f8cbeff4fc49p+0, 0x1.2ab69cb9b4fafp+5, 0x1.5da2652648b85p+5, 0x1.018bd116bd6c7p+1,
    -0x1.db7ec5f94a2b3p+0, -0x1.b70d51da000bp+0, 0x1.592a58ae16d32p+0, -0x1.e09c55d592e7bp-2,
    0x1.d2da2bcc78274p+4, -0x1.42336571722f3p+2, -0x1.e5dcba8c07172p+3, -0x1.0520166134e55p-1,
    -0x1.cc764af9f9754p-5, 0x1.e4010999a0feap-1, -0x1.f17bee32b5008p-2, -0x1.80f2293c0d772p+0,
    -0x1.6081f9942d45ap+2, 0x1.7ce06cd71790ap-1, 0x1.10b08f288bdf3p+0, -0x1.d0ee9f4ccda7cp-1,
    0x1.226329670693ap-1, -0x1.a8a6dde0091a8p-3, -0x1.0e248ffbfbff9p+2, -0x1.4d11a61298d05p-2,
    0x1.bc33f301cf8e3p+1, -0x1.9a3eff5048cb1p+0, 0x1.123f77c95c32ap-1, -0x1.6b5dfea9c0fdcp-3,
    0x1.78c5c74f5ad34p-5},
  .re = {
    0x1.1dfa88c180ab2p+3, 0x1.1060f36d58ac5p+3, 0x1.c9070c7855d36p+2, 0x1.183c83eb7828ep+2},
  .im = {
    0x0p+0, 0x1.a3f841231a708p+1, 0x1.a7dffc016913ep+2, 0x1.456e209c08037p+3},
};

#define ROW(family, s) {#family, s, family##s.c, family##s.b, family##s.A, family##s.A_low, \
  family##s.B, family##s.T, family##s.Tinv, family##s.re, family##s.im}

const stf_stored stf_stored_tables[] = {
  ROW(gauss, 2),
  ROW(gauss, 3),
  ROW(gauss, 4),
  ROW(radau, 2),
  ROW(radau, 3),
  ROW(radau, 4),
  ROW(radau, 5),
  ROW(radau, 7),
};

const size_t stf_stored_count = sizeof stf_stored_tables / sizeof *stf_stored_tables;
