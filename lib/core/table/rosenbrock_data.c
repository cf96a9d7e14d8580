/* rosenbrock_data.c: coefficients of Rosenbrock methods in the variables u (no matrix-vector products).
 * rodas4: Hairer and Wanner, Solving ODEs II, IV.7; rodas4p: Steinebach, TH Darmstadt preprint 1772
 * (1995); rodas4p2: Steinebach, in Progress in Differential-Algebraic Equations II (2020); rodas5p:
 * Steinebach, BIT 63 (2023).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "rosenbrock_data.h"
#include <string.h>

/* Inside the step: d solves the conditions of order 3 as functions of x, those of algebraic components
 * b omega alpha^2 = x^2 and, but for rodas4, b omega alpha^3 = x^3 and b omega (alpha A beta) = x^3/2
 * among them (Hairer and Wanner VI.4), in 30-digit arithmetic; where they leave a choice, of least
 * norm. For rodas4 these are the numbers of Hairer and Wanner's code RODAS. */

static const sunrealtype rodas4_alpha[] = {0, 0.386, 0.21, 0.63, 1, 1};
static const sunrealtype rodas4_gamma[] = {0.25, -0.1043, 0.1035, -0.0362, 0, 0};
static const sunrealtype rodas4_a[] = {1.544,
                                       0.9466785280815826,
                                       0.2557011698983284,
                                       3.314825187068521,
                                       2.896124015972201,
                                       0.9986419139977817,
                                       1.221224509226641,
                                       6.019134481288629,
                                       12.53708332932087,
                                       -0.6878860361058950};
static const sunrealtype rodas4_c[] = {-5.6688,
                                       -2.430093356833875,
                                       -0.2063599157091915,
                                       -0.1073529058151375,
                                       -9.594562251023355,
                                       -20.47028614809616,
                                       7.496443313967647,
                                       -10.24680431464352,
                                       -33.99990352819905,
                                       11.70890893206160,
                                       8.083246795921522,
                                       -7.981132988064893,
                                       -31.52159432874371,
                                       16.31930543123136,
                                       -6.058818238834054};
static const sunrealtype rodas4_d[] = {
  10.126235083445867,   -7.4879958776101485, -34.800918615557463,
  -7.9927717075688021,  1.0251377232956519,  0,
  -0.67628033928012808, 6.0877146516799165,  16.430843208924624,
  24.767225114183709,   -6.5943891257167995, 0};

static const sunrealtype rodas4p_alpha[] = {0, 0.75, 0.21, 0.63, 1, 1};
static const sunrealtype rodas4p_gamma[] = {0.25, -0.5, -0.023504, -0.0362, 0, 0};
static const sunrealtype rodas4p_a[] = {3,
                                        1.831036793486759,
                                        0.4955183967433795,
                                        2.304376582692669,
                                        -0.05249275245743001,
                                        -1.176798761832782,
                                        -7.170454962423024,
                                        -4.741636671481785,
                                        -16.31002631330971,
                                        -1.062004044111401};
static const sunrealtype rodas4p_c[] = {-12,
                                        -8.791795173947035,
                                        -2.207865586973518,
                                        10.81793056857153,
                                        6.780270611428266,
                                        19.53485944642410,
                                        34.19095006749676,
                                        15.49671153725963,
                                        54.74760875964130,
                                        14.16005392148534,
                                        34.62605830930532,
                                        15.30084976114473,
                                        56.99955578662667,
                                        18.40807009793095,
                                        -5.714285714285717};
static const sunrealtype rodas4p_d[] = {
  25.298191647914849, 11.53036106289936,    29.523625464514593,
  -3.717014154389913, -0.78571428571428465, 0,
  1.84921002768645,   -0.83241254848833473, 9.570774864687783,
  18.054068749893812, -2.7142857142857193,  0};

static const sunrealtype rodas4p2_alpha[] = {0, 0.75, 0.321448134013046, 0.519745732277726,
                                             1, 1};
static const sunrealtype rodas4p2_gamma[] = {0.25, -0.5, -0.189532918363016, 0.085612108792769,
                                             0,    0};
static const sunrealtype rodas4p2_a[] = {3,
                                         0.906377755268814,
                                         -0.189707390391685,
                                         3.758617027739064,
                                         1.161741776019525,
                                         -0.849258085312803,
                                         7.089566927282776,
                                         4.573591406461604,
                                         -8.423496976860259,
                                         -0.959280113459775};
static const sunrealtype rodas4p2_c[] = {-12,
                                         -6.354581592719008,
                                         0.338972550544623,
                                         -8.575016317114033,
                                         -7.606483992117508,
                                         12.224997650124820,
                                         -5.888975457523102,
                                         -8.157396617841821,
                                         24.805546872612922,
                                         12.790401512796979,
                                         -4.408651676063871,
                                         -6.692003137674639,
                                         24.625568527593117,
                                         16.627521966636085,
                                         -5.714285714285718};
static const sunrealtype rodas4p2_d[] = {
  -4.6590234985164414, -9.3843210703753019,  17.094464178122741,
  -3.3574803971092011, -0.78571428571428588, 0,
  6.2913760712017612,  6.2279222907105482,   -0.7649079663342164,
  16.307761928816174,  -2.7142857142857213,  0};

static const sunrealtype rodas5p_alpha[] = {
  0, 0.6358126895828704, 0.4095798393397535, 0.9769306725060716, 0.4288403609558664, 1, 1, 1};
static const sunrealtype rodas5p_gamma[] = {0.21193756319429014,
                                            -0.42387512638858027,
                                            -0.3384627126235924,
                                            1.8046452872882734,
                                            2.325825639765069,
                                            0,
                                            0,
                                            0};
static const sunrealtype rodas5p_a[] = {3.0,
                                        2.849394379747939,
                                        0.45842242204463923,
                                        -6.954028509809101,
                                        2.489845061869568,
                                        -10.358996098473584,
                                        2.8029986275628964,
                                        0.5072464736228206,
                                        -0.3988312541770524,
                                        -0.04721187230404641,
                                        -7.502846399306121,
                                        2.561846144803919,
                                        -11.627539656261098,
                                        -0.18268767659942256,
                                        0.030198172008377946};
static const sunrealtype rodas5p_c[] = {
  -14.155112264123755, -17.97296035885952, -2.859693295451294,  147.12150275711716,
  -1.41221402718213,   71.68940251302358,  165.43517024871676,  -0.4592823456491126,
  42.90938336958603,   -5.961986721573306, 24.854864614690072,  -3.0009227002832186,
  47.4931110020768,    5.5814197821558125, -0.6610691825249471, 30.91273214028599,
  -3.1208243349937974, 77.79954646070892,  34.28646028294783,   -19.097331116725623,
  -28.087943162872662, 37.80277123390563,  -3.2571969029072276, 112.26918849496327,
  66.9347231244047,    -40.06618937091002, -54.66780262877968,  -9.48861652309627};
static const sunrealtype rodas5p_d[] = {
  25.034474435864489,  -2.367222995585236,  6.7351150480004711, -5.2581449603111914,
  2.3473468018880966,  3.7788526810979213,  4.5484808292575315, 0,
  -8.5248598158624274, 0.39352884404009434, 17.05018129960223,  -6.2932679147199514,
  8.2127876119340473,  3.5912581993980976,  3.0341437549313361, 0};

const stf_rodas stf_rodas_tables[] = {
  {"rodas4",
   "Rodas4, Rosenbrock order 4(3), L-stable, stiffly accurate: Hairer and Wanner, Solving ODEs "
   "II, IV.7",
   6, 5, 4, 0.25, rodas4_alpha, rodas4_gamma, rodas4_a, rodas4_c, rodas4_d},
  {"rodas4p",
   "Rodas4P, order 4(3), for parabolic problems: G. Steinebach, TH Darmstadt preprint 1772 "
   "(1995)",
   6, 5, 4, 0.25, rodas4p_alpha, rodas4p_gamma, rodas4p_a, rodas4p_c, rodas4p_d},
  {"rodas4p2",
   "Rodas4P2, order 4(3), inexact Jacobians allowed: G. Steinebach, Progress in DAEs II (2020)",
   6, 5, 4, 0.25, rodas4p2_alpha, rodas4p2_gamma, rodas4p2_a, rodas4p2_c, rodas4p2_d},
  {"rodas5p", "Rodas5P, order 5(4), for parabolic problems: G. Steinebach, BIT 63 (2023)", 8, 6,
   5, 0.21193756319429014, rodas5p_alpha, rodas5p_gamma, rodas5p_a, rodas5p_c, rodas5p_d},
};
const size_t stf_rodas_count = sizeof stf_rodas_tables / sizeof *stf_rodas_tables;

const stf_rodas *stf_rodas_find(const char *name)
{
  for (size_t i = 0; i < stf_rodas_count; i++)
    if (!strcmp(stf_rodas_tables[i].name, name)) return stf_rodas_tables + i;
  return NULL;
}
