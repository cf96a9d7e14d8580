/* test_wrong_models.c: wrong models, and what is said about them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <ctype.h>
#include <sys/stat.h>
#include <unistd.h>

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
  {"param a = 0x10\n", "", "m.steif:1:11: a hexadecimal number; write it as a decimal one"},
  {"param a = 1_000\n", "", "m.steif:1:11: a number with '_'; write it without"},
  {"param a = 1,5\n", "", "m.steif:1:11: '1,5': decimal point, 1.5"},
  {"state u[1..2]\n", "", "m.steif:1:9: '..' between numbers: a range is written 1:2"},
  {"state x = 1\nx' = if x == 0 then 1 else 2\n", "",
   "m.steif:2:11: '==' between computed numbers; use < or >, or abs(a - b) < 1e-9"},
  {"state x = 1\nx' = k7*x\ntime 0 to 1\nparam k1 = 1, k2 = 2, k3 = 3\n", ":k7=1",
   "m.steif has no parameter 'k7'; the nearest is 'k1'. It has k1, k2, k3"},
  {"state u[i in 1:100] = 0\nfor i in 1:100\n  u[i]' = u[i+1]\nend\ntime 0 to 1\n", "",
   "m.steif:3:11: u[101] does not exist (i = 100; u runs from 1 to 100); end the loop at 99 or "
   "add "
   "'boundary u[101] = ...'"},
  {"state u[i in 1:100] = 0\nfor i in 1:100\n  u[i]' = u[i-1]\nend\ntime 0 to 1\n", "",
   "m.steif:3:11: u[0] does not exist (i = 1; u runs from 1 to 100); begin the loop at 2 or "
   "add "
   "'boundary u[0] = ...'"},
  {"state u[i in 1:4, j in 1:3] = 0\nfor i in 1:4\nfor j in 1:3\n  u[i,j]' = "
   "u[i,j-1]\nend\nend\n"
   "time 0 to 1\n",
   "",
   "m.steif:4:13: u[1,0] does not exist (i = 1, j = 1; its second index runs from 1 to 3); end "
   "the loop earlier or add 'boundary u[i in 1:4, 0] = ...'"},
  {"state u[1:9] = 0\nfor i in 1:5\n  u[2*i]' = u[2*i]\nend\ntime 0 to 1\n", "",
   "m.steif:3:3: u[10] does not exist (i = 5; u runs from 1 to 9); end the loop at 4 or add "},
  {"state u[i in 1:3] = 0\nfor i in 1:10^12\nu[i]' = 0\nend\n", "",
   "m.steif:2:10: a loop of 1e+12 passes; 1e8 is the most."},
  {"state u[i in 1:3] = 0\nfor i in 1:1000000000\nu[i]' = 0\nend\n", "",
   "m.steif:2:10: a loop of 1e+09 passes; 1e8 is the most."},
  {"state x = 1, y = 1\n\nstate lambda\nx' = y + lambda\ny' = -x\ntime 0 to 1\n", "",
   "m.steif: 2 equations for 3 unknowns: nothing determines 'lambda' (line 3), or else one of "
   "'x', 'y' that "
   "share its equations; add an equation that contains it or remove it"},
  {"state x = 1, y = 1\nx' = vx\ny' = vy\nlet a = 1\nstate vx=1,vy=1\nvx' = 1\nvy' = 2\n0 = vx "
   "+ vy - 1\ntime 0 to 1\n",
   "",
   "m.steif: 5 equations for 4 unknowns: those of lines 6, 7, 8 determine only 'vx', 'vy'; one "
   "of the 3 is too many"},
  {"state x = 1, z, w\nx' = z\n0 = z - 1\n0 = z + 2\ntime 0 to 1\n", "",
   "m.steif: no matching: the equations of lines 3, 4 contain 'z' only, nothing determines 'w' "
   "(line 1)"},
  {"state y = 1\ny' = 1\nstate x\n\n\nx' = 2\ntime 0 to 1\n", "",
   "m.steif:3:7: 'x' needs a start value since its derivative occurs (line 6); write 'state x "
   "= ...', "
   "or '~' for a guess. "
   "Only states without derivative may leave it out"},
  {"state x = 1\nfunction f(x) = f(x-1)\nx' = f(x)\ntime 0 to 1\n", "",
   "m.steif:2:10: function 'f' calls itself; recursion is not part of the language"},
  {"param x0 = 2\nstate x = 2\n\n\nx' = 1/(x - x0)\ntime 0 to 1\n", "",
   "m.steif:5:7: division by zero at the start (t = 0, x = 2): 'x - x0' is 0; change the start "
   "or rewrite"},
  {"state z = -1\nz'=0\nstate y = 1\n\ny' = log(z)\ntime 0 to 1\n", "",
   "m.steif:5:6: log of -1 at the start (t = 0, z = -1)"},
  {"\n\n\nstate u[i in 1:100] = 1\n\n\nfor i in 2:99\nu[i]' = 1\nend\ntime 0 to 1\n", "",
   "m.steif: no equation for u[1], u[100] (declared in line 4; the loop of line 7 runs from 2 "
   "to "
   "99)"},
  {"\nparam n = 2.5\nstate u[1:n] = 1\n", "",
   "m.steif:3:7: the size n = 2.5 must be a whole number from 1 to 1e7; declare 'param n = 2 "
   "whole'"},
  {"state v = 1\nv' = 1\nwhen v: v = 0\n", "",
   "m.steif:3:6: expected a condition such as v < 0, or 'v falling'"},
  {"state v = 1, k2 = 1\nv' = 1\nk2' = 1\nwhen v < 0: k2 = sin(\n", "",
   "m.steif:4:22: expected an expression, found the end of the line"},
  {"include \"../a\"\n", "",
   "m.steif:1:9: '../a' leaves the directory of the model; copy the file beside it"},
  {"state x = 1\nx' = -x\noutput x = 2*x\ntime 0 to 1\n", "",
   "m.steif:3:8: 'x' has this name already (line 1); an output or invariant needs one of its "
   "own"},
  {"table f = \"/etc/x\" column 1 linear\nstate x = 1\nx' = f(t)\ntime 0 to 1\n", "",
   "m.steif:1:11: '/etc/x' leaves the directory of the model; copy the file beside it"},
  {"state x = -1\nx' = 1\nrequire x >= 0\ntime 0 to 1\n", "",
   "m.steif:3:9: x = -1 at the start contradicts 'require x >= 0'"},
  {"state x = 1.1, y = 0, vx = 0, vy = 0, l\nx' = vx\ny' = vy\nvx' = -l*x\nvy' = -l*y - 1\n0 = "
   "x^2 + y^2 - 1\ntime 0 to 1\n",
   "", "m.steif: fixed values contradict each other"},
  {"state x = 1\nx' = ln(x)\ntime 0 to 1\n", "",
   "m.steif:2:6: 'ln' is written log, which is natural here"},
  {"state x = 1\nx' = sin(x, 2) + x*(x < 1)\ntime 0 to 1\n", "",
   "m.steif:2:19: expected a number, found a condition"},
  {"state x = 1\nx' = sin(x, 2)\ntime 0 to 1\n", "",
   "m.steif:2:6: 'sin' takes 1 argument, got 2"},
  {"state x = 1\nfor i in 1:3\nx' = 1\ntime 0 to 1\n", "",
   "m.steif:2:1: this loop has no 'end'; close it"},
  {"param a = 3 in [0, 2]\nstate x = 1\nx' = a\ntime 0 to 1\n", "",
   "m.steif:1:7: a = 3 must lie in [0, 2]"},
  {"form ode\nstate x = 1, y\nx' = y\n0 = x - y\ntime 0 to 1\n", "",
   "m.steif:1:6: the form is mass: an equation has no derivative"},
  {"state x = 1\nx' = 1\ntime 1 to 0\n", "",
   "m.steif:3:6: the interval from 1 to 0; the end lies after the start"},
  /* habits of other languages */
  {"t = 0 .. 30\n", "",
   "m.steif:1:7: a '.' without digits: an interval is written 'time 0 to 30', a range 1:2"},
  {"time = 0 to 30\n", "",
   "m.steif:1:6: expected an interval such as 'time 0 to 10', found '='"},
  {"time 0, 30\n", "",
   "m.steif:1:7: expected 'to' and the end of the interval, as in 'time 0 to 10', found ','"},
  {"param k = 1;\n", "",
   "m.steif:1:12: ';' has no meaning: a statement ends with its line; remove it"},
  {"state x = 1\nx' = x**2\n", "", "m.steif:2:7: '**': a power is written ^"},
  {"// none\n", "", "m.steif:1:1: '//': a comment begins with #"},
  {"% none\n", "", "m.steif:1:1: '%': a comment begins with #, a remainder is mod(a, b)"},
  {"par k = 1\n", "", "m.steif:1:1: 'par' begins no statement; did you mean 'param'?"},
  {"variable x = 1\n", "",
   "m.steif:1:1: 'variable' begins no statement; did you mean 'state'?"},
  {"frobnicate x = 1\n", "",
   "m.steif:1:1: 'frobnicate' begins no statement: a line is an equation, or begins with"},
  {"state x = 1\ndx/dt = -x\ntime 0 to 1\n", "",
   "m.steif:2:1: 'dx' is not declared; the derivative of 'x' is written x'"},
  {"state x = 1\nder(x) = -x\ntime 0 to 1\n", "", "m.steif:2:1: 'der(x)' is written x'"},
  {"state x = 1\nx' = Sin(x)\ntime 0 to 1\n", "", "m.steif:2:6: 'Sin' is written sin"},
  {"state x = 1\nx' = pow(x, 2)\ntime 0 to 1\n", "",
   "m.steif:2:6: 'pow': a power is written x^y"},
  {"state x = 1\nx' = z\ntime 0 to 1\n", "", "m.steif:2:6: unknown name 'z'; declare it"},
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

/* What is said of the text in a folder with `file` beside it, a text, or (NULL) a link to `target`. */
static void beside(const char *text, const char *file, const char *content, const char *target,
                   const char *sentence)
{
  fixture s = {.ctx = steif_context_new(NULL)};
  char path[sizeof s.folder + 40];
  CU_ASSERT_FATAL(folder_make(s.folder, sizeof s.folder) != NULL);
  snprintf(path, sizeof path, "%s/%s", s.folder, file);
  FILE *to = content ? fopen(path, "w") : NULL;
  if (to) fputs(content, to), fclose(to);
  CU_ASSERT_FATAL(content ? to != NULL : symlink(target, path) == 0);
  snprintf(s.path, sizeof s.path, "%s/m.steif", s.folder);
  steif_problem p = {0};
  const int code = steif_model_parse(s.ctx, text, s.path, NULL, &p);
  const char *said = steif_message(s.ctx), *base = strstr(said, "m.steif");
  const bool told = sentence && base && !strncmp(base, sentence, strlen(sentence));
  if (sentence && !told) printf("\n  got %s", said);
  CHECK(sentence ? code == STEIF_BAD_INPUT && told : code == STEIF_OK);
  steif_problem_clear(s.ctx, &p);
  unlink(path);
  rmdir(s.folder);
  steif_context_free(&s.ctx);
}

/* Units of a table's times, where both are told; links that leave the folder. */
static void of_files_beside(void)
{
  static const char table[] = "state x = 1\ntable f = \"f.csv\" column \"T\" linear\n"
                              "x' = f(t)\ntime 0 to 1 {min}\n",
                    include[] = "include \"part.steif\"\n";
  beside(table, "f.csv", "t {s},T {K}\n0,1\n1,2\n", NULL,
         "m.steif:2:7: time is in {min} (line 4), the column 't {s}' of f.csv in {s}; convert "
         "one");
  beside(table, "f.csv", "\xEF\xBB\xBFt {s},T {K}\n0,1\n1,2\n", NULL,
         "m.steif:2:7: time is in {min} (line 4), the column 't {s}' of f.csv in {s}; convert "
         "one");
  beside(table, "f.csv", "t {min},T\n0,1\n1,2\n", NULL, NULL);
  beside(table, "f.csv", "t,T {K}\n0,1\n1,2\n", NULL, NULL);
  beside(table, "f.csv", "t,T\n0,1\n1,\"2,5\"\n", NULL,
         "m.steif:2:7: f.csv, line 3: more cells than the first line has, or a decimal comma");
  beside(
    include, "part.steif", NULL, "/etc/passwd",
    "m.steif:1:9: 'part.steif' leaves the directory of the model; copy the file beside it");
  beside(table, "f.csv", NULL, "/etc/passwd",
         "m.steif:2:11: 'f.csv' leaves the directory of the model; copy the file beside it");
}

/* A zero byte; too long; a directory and a device. */
static void are_no_texts(void)
{
  fixture s = {.ctx = steif_context_new(NULL)};
  CU_ASSERT_FATAL(folder_make(s.folder, sizeof s.folder) != NULL);
  snprintf(s.path, sizeof s.path, "%s/m.steif", s.folder);
  FILE *file = fopen(s.path, "w");
  CU_ASSERT_FATAL(file != NULL);
  fwrite("state x = 1\nx\0' = 1\n", 1, 21, file);
  fclose(file);
  CHECK(steif_problem_find(s.ctx, s.path, &s.p) == STEIF_BAD_INPUT);
  CHECK(!!strstr(steif_message(s.ctx), "m.steif:2:2: byte 0 in the text; a model is a UTF-8 "
                                       "text file"));
  CHECK(truncate(s.path, 1L << 30) == 0);
  CHECK(steif_problem_find(s.ctx, s.path, &s.p) == STEIF_BAD_INPUT);
  CHECK(!!strstr(steif_message(s.ctx), "1073741824 bytes; 67108864 are the most. Use loops"));
  unlink(s.path);
  CHECK(symlink("/dev/zero", s.path) == 0);
  CHECK(steif_problem_find(s.ctx, s.path, &s.p) == STEIF_IO);
  CHECK(!!strstr(steif_message(s.ctx), "it is a device or a pipe"));
  unlink(s.path);
  CHECK(mkdir(s.path, 0700) == 0);
  CHECK(steif_problem_find(s.ctx, s.path, &s.p) == STEIF_IO);
  CHECK(!!strstr(steif_message(s.ctx), "it is a directory"));
  rmdir(s.path);
  fixture_close(&s);
}

/* 250 parentheses; no such folder; UTF-16. */
static void are_survived(void)
{
  char text[600] = "state x = 1\nx' = ";
  fixture s;
  memset(text + strlen(text), '(', 250);
  CHECK(fixture_text(&s, text, "") == STEIF_BAD_INPUT);
  CU_ASSERT_PTR_NOT_NULL(strstr(steif_message(s.ctx), "nested more than 200 deep"));
  steif_problem p;
  CHECK(steif_problem_find(s.ctx, "/tmp/no such folder/m.steif", &p) == STEIF_IO);
  fixture_close(&s);
  CHECK(fixture_text(&s,
                     "\xff\xfe"
                     "a",
                     "") == STEIF_BAD_INPUT);
  CU_ASSERT_PTR_NOT_NULL(strstr(steif_message(s.ctx), "save it as UTF-8"));
  fixture_close(&s);
}

/* z_1 + z_2 = a, ..., z_(n-1) + z_n = a: of many unknowns, too, the one that nothing determines is named. */
static void large_ones_are_counted(void)
{
  enum { MANY = 20000, LINE = 32 };
  char *text = malloc(2 * (size_t)MANY * LINE), *to = text;
  CU_ASSERT_FATAL(text != NULL);
  to += sprintf(to, "state a = 1\na' = -a\nstate z1\n");
  for (int i = 2; i <= MANY; i++)
    to += sprintf(to, "state z%d\n0 = z%d + z%d - a\n", i, i - 1, i);
  sprintf(to, "time 0 to 1\n");
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p = {0};
  CHECK(steif_model_parse(ctx, text, "m.steif", NULL, &p) == STEIF_BAD_INPUT);
  CHECK(!!strstr(steif_message(ctx), "20000 equations for 20001 unknowns: nothing determines "
                                     "'z20000' (line 40000), or else one of 'z1', 'z2'"));
  steif_context_free(&ctx);
  free(text);
}

/* Each example with one token left out or doubled is a model or has a sentence. */
static void of_one_token(void)
{
  static const char *const examples[] = {"rober", "pendulum", "bounce", "brusselator",
                                         "hunters"};
  char text[2000], changed[2400];
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 5; k++) {
    snprintf(text, sizeof text, "%s/%s.steif", EXAMPLES, examples[k]);
    FILE *file = fopen(text, "r");
    CU_ASSERT_FATAL(file != NULL);
    const size_t length = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    text[length] = 0;
    for (size_t at = 0, end; at < length; at = end) {
      end = at + 1;
      while (end < length && isalnum((unsigned char)text[at]) &&
             isalnum((unsigned char)text[end]))
        end++;
      for (int doubled = 0; doubled < 2; doubled++) {
        steif_problem p = {0};
        snprintf(changed, sizeof changed, "%.*s %.*s%s", (int)(doubled ? end : at), text,
                 (int)(end - at), doubled ? text + at : "                        ", text + end);
        steif_forget(ctx);
        const int code = steif_model_parse(ctx, changed, "m.steif", NULL, &p);
        CHECK(code == STEIF_OK || (code < 0 && strcmp(steif_message(ctx), "ok")));
        steif_problem_clear(ctx, &p);
      }
    }
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_wrong_models[] = {{"hostile texts", are_survived},
                                       {"no texts", are_no_texts},
                                       {"files beside", of_files_beside},
                                       {"one token more or less", of_one_token},
                                       {"large ones are counted", large_ones_are_counted},
                                       {"each has its sentence", have_their_sentence},
                                       CU_TEST_INFO_NULL};
