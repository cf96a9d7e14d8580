/* test_wrong_models.c: wrong models, and what is said about them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

typedef struct wrong {
  const char *text, *rest, *sentence; /* after the path of the folder */
} wrong;

static const wrong models[] = {
  {"param k1 = 1, k3 = 2\nstate y1 = 1,\n y2 = 0, y3 = 0\n# comment\ny1' = -k1*y1 + "
   "k3*y2*y33\n",
   "", "m.steif:5:22: unknown name 'y33'; did you mean 'y3'?"},
  {"param k1 = 1\nstate y1 = 1\ny1' = -k1*y1\nr = k1*y1\n", "",
   "m.steif:4:1: 'r' is not declared; write 'let r = ...' for an abbreviation, 'state r' for "
   "an unknown"},
  {"state x = 1\nx' = 1\n", "", "m.steif: no time interval; add 'time 0 to 10'"},
  {"param k = 1\n\n\n\n\n\nparam k = 2\n", "",
   "m.steif:7:7: 'k' is already a parameter (line 1); a later line never replaces an earlier "
   "one"},
  {"param x = 1\n\n\nstate x = 1\n", "",
   "m.steif:4:7: 'x' is a parameter (line 1) and cannot be a state too; rename one"},
  {"state x = 1\n\n\n\nx' = 1\nx' = 2\ntime 0 to 1\n", "",
   "m.steif:6:1: the derivative of 'x' is given twice (first in line 5)"},
  {"state x = 1\n\nlet a = b\nlet b = a\nx' = a\ntime 0 to 1\n", "",
   "m.steif:3:5: 'a' needs 'b' (line 4), which needs 'a'; declare one of them as 'state' and "
   "the loop is solved "
   "as an equation"},
  {"state x = 1\nx' = 2x\n", "", "m.steif:2:6: '2x': write 2*x"},
  {"param a = 1,5\n", "", "m.steif:1:11: '1,5': decimal point, 1.5"},
  {"state u[1..2]\n", "", "m.steif:1:9: '..' between numbers: a range is written 1:2"},
  {"state x = 1\nx' = if x == 0 then 1 else 2\n", "",
   "m.steif:2:11: '==' between computed numbers; use < or >, or abs(a - b) < 1e-9"},
  {"state x = 1\nx' = k7*x\ntime 0 to 1\nparam k1 = 1, k2 = 2, k3 = 3\n", ":k7=1",
   "m.steif has no parameter 'k7'; the nearest is 'k1'. It has k1, k2, k3"},
  {"state u[i in 1:100] = 0\nfor i in 1:100\n  u[i]' = u[i+1]\nend\ntime 0 to 1\n", "",
   "m.steif:3:11: u[101] does not exist (i = 100; u runs from 1 to 100)"},
  {"state u[i in 1:3] = 0\nfor i in 1:10^12\nu[i]' = 0\nend\n", "",
   "m.steif:2:10: a loop of 1e+12 passes; 1e8 is the most."},
  {"state u[i in 1:3] = 0\nfor i in 1:1000000000\nu[i]' = 0\nend\n", "",
   "m.steif:2:10: a loop of 1e+09 passes; 1e8 is the most."},
};

static void have_their_sentence(void)
{
  fixture s;
  for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
    const int code = fixture_text(&s, models[i].text, models[i].rest);
    const char *said = steif_message(s.ctx), *base = strstr(said, "m.steif");
    const bool good = base && !strncmp(base, models[i].sentence, strlen(models[i].sentence));
    if (!good) printf("\n  expected %s\n  got      %s", models[i].sentence, said);
    CHECK(good && code < 0);
    fixture_close(&s);
  }
}

CU_TestInfo tests_of_wrong_models[] = {{"each has its sentence", have_their_sentence},
                                       CU_TEST_INFO_NULL};
