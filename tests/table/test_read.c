/* test_read.c: tableaux in text files: what is read, and what is refused with its line.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "suite.h"
#include "table.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int parse(steif_context *ctx, const char *text, steif_glm *g)
{
  const int code = stf_table_parse(ctx, "a.glm", text, g);
  return code ? code : steif_glm_complete(ctx, g);
}

static const char nord22[] = "name my 22  # a comment\n xi   1/2 1\n\nC 1/2 0\n  1/2 1/2\n"
                             "U 1 0 -1/8\n1 0 -.25\nD .5 1/2\n0 1\n-2 2e0\n"
                             "V 1 0 -1/4\r\n0 0 0\n0 0 0";

static void the_three_ways_to_write_are_read(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_table *t = steif_table_new(ctx, "nord22"), *bdf = steif_table_new(ctx, "bdf:p=2");
  steif_glm g;
  CU_ASSERT_FATAL(t && bdf);
  CHECK(parse(ctx, nord22, &g) == STEIF_OK && !strcmp(g.name, "my 22"));
  CHECK(g.k == 3 && g.r == 2 && g.order == 2);
  CHECK(!memcmp(g.U, t->general->U, sizeof g.U) && !memcmp(g.V, t->general->V, sizeof g.V));
  CHECK(!memcmp(g.C, t->general->C, sizeof g.C) && !memcmp(g.D, t->general->D, sizeof g.D));
  CHECK(parse(ctx, "A 0 0\n1/2 1/2\nb 1/2 1/2", &g) == STEIF_OK && !strcmp(g.name, "a.glm"));
  CHECK(g.k == 1 && g.r == 2 && g.order == 2 && g.xi[0] == 0 && g.xi[1] == 1);
  CHECK(parse(ctx, "alpha 1/3 -4/3 1\nbeta 0 0 2/3", &g) == STEIF_OK && g.order == 2);
  for (int j = 0; j < 2; j++) CLOSE(g.ell[j], bdf->general->ell[j], 1e-14);
  steif_table_free(ctx, &t), steif_table_free(ctx, &bdf);
  steif_context_free(&ctx);
}

static void mistakes_are_named_with_their_line(void)
{
  static const char *const bad[][2] = {
    {"xi 1\nC 1\nD 1\nU 1 1\nV 1", "U 1 x 2"},
    {"xi 1 2\nC 1\nD 1\nU 1\nV 1", "xi has 2 entries"},
    {"xi 1\nC 1\nU 1\nV 1", "D 0 x 0"},
    {"C 1 2\n3", "line 2: a row of 1 numbers in 'C', whose rows before have 2"},
    {"xi 1\nxi 2", "line 2: 'xi' is given a second time"},
    {"# x\nE 1 2", "line 2: 'E 1 2' is no part"},
    {"1 2 3", "line 1: numbers before the name"},
    {"xi 1 two", "line 1: 'two' is no finite number"},
    {"xi 1/0", "no finite number"},
    {"xi 1/", "no finite number"},
    {"xi 1,2", "no finite number"},
    {"xi nan", "no finite number"},
    {"alpha -1 1\nbeta 0", "alpha has 2 entries and beta 1"},
    {"alpha -1 1\nbeta 0 1\nxi 1", "nothing else"},
    {"beta 1 1", "alpha has 0 entries"},
    {"name", "a name has 1 to"},
    {"", "xi has 0 entries"},
    {"alpha -1 0 1\nbeta 1/3 4/3 1/3\nname simpson", "'simpson' is not strictly stable"},
    {"A 1\nb 1/2", "inconsistent"},
  };
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    steif_glm g;
    steif_forget(ctx);
    CHECK(parse(ctx, bad[i][0], &g) == STEIF_BAD_INPUT);
    if (!strstr(steif_message(ctx), bad[i][1]))
      printf("\n  %s: %s", bad[i][0], steif_message(ctx));
    CHECK(strstr(steif_message(ctx), bad[i][1]) != NULL);
  }
  char *many = calloc(1, 1 << 14);
  for (int i = 0; i < 1100; i++) strcat(many, i ? "1\n" : "C 1\n");
  steif_glm g;
  CHECK(parse(ctx, many, &g) == STEIF_BAD_INPUT &&
        strstr(steif_message(ctx), "more than 1024"));
  memset(many, '1', 4000), many[4000] = 0;
  CHECK(parse(ctx, many, &g) == STEIF_BAD_INPUT && strstr(steif_message(ctx), "longer than"));
  free(many);
  steif_context_free(&ctx);
}

static void files_are_tables(void)
{
  char path[] = "tableXXXXXX", spec[64];
  const int file = mkstemp(path);
  steif_context *ctx = steif_context_new(NULL);
  CU_ASSERT_FATAL(file >= 0 && write(file, nord22, strlen(nord22)) == (ssize_t)strlen(nord22));
  close(file);
  snprintf(spec, sizeof spec, "glm:file=%s", path);
  steif_table *t = steif_table_new(ctx, spec);
  CHECK(t && t->kind == STEIF_GLM && t->order == 2 && t->s == 2);
  steif_table_free(ctx, &t);
  snprintf(spec, sizeof spec, "glm:file=./%s,p=3", path);
  CHECK(!steif_table_new(ctx, spec) && strstr(steif_message(ctx), "no parameter 'p'"));
  unlink(path);
  CHECK(!steif_table_new(ctx, "glm:file=no/such.glm") && steif_status(ctx) == STEIF_IO);
  CHECK(strstr(steif_message(ctx), "no/such.glm") != NULL);
  steif_context_free(&ctx);
}

/* The text, its matrices, the table: three allocations, each may fail. */
static void short_memory_is_reported(void)
{
  char path[] = "tableXXXXXX", spec[64];
  const int file = mkstemp(path);
  CU_ASSERT_FATAL(file >= 0 && write(file, nord22, strlen(nord22)) == (ssize_t)strlen(nord22));
  close(file);
  snprintf(spec, sizeof spec, "glm:file=%s", path);
  for (int k = 0; k <= 3; k++) {
    failing memory = {0};
    const steif_setup setup = failing_setup(&memory);
    steif_context *ctx = steif_context_new(&setup);
    CU_ASSERT_FATAL(ctx != NULL);
    const long own = memory.alive;
    memory.refuse_at = memory.served + k + 1;
    steif_table *t = steif_table_new(ctx, spec);
    CHECK((t != NULL) == (k == 3) && (t || steif_status(ctx) == STEIF_NO_MEMORY));
    steif_table_free(ctx, &t);
    CHECK(memory.alive == own);
    steif_context_free(&ctx);
  }
  unlink(path);
}

CU_TestInfo tests_of_read[] = {
  {"the three ways to write a tableau are read", the_three_ways_to_write_are_read},
  {"mistakes are named with their line", mistakes_are_named_with_their_line},
  {"files are tables", files_are_tables},
  {"a failing allocation is reported", short_memory_is_reported},
  CU_TEST_INFO_NULL};
