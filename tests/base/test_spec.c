/* test_spec.c: specs that can be read, specs that cannot, their numbers, nearest names.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"
#include "suite.h"
#include <string.h>

static void good_specs_are_taken_apart(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_spec s;
  CHECK(steif_spec_parse(ctx, "rober", &s) == STEIF_OK);
  CHECK(!strcmp(s.name, "rober") && s.count == 0);
  CHECK(steif_spec_parse(ctx, "bdf:p=3,start=cq", &s) == STEIF_OK);
  CHECK(!strcmp(s.name, "bdf") && s.count == 2);
  CHECK(!strcmp(stf_spec_word(&s, "p"), "3") && !strcmp(stf_spec_word(&s, "start"), "cq"));
  CHECK(stf_spec_word(&s, "") == NULL && stf_spec_word(&s, "q") == NULL);
  CHECK(steif_spec_parse(ctx, "dirk:alexander2", &s) == STEIF_OK);
  CHECK(!strcmp(stf_spec_word(&s, ""), "alexander2"));
  CHECK(steif_spec_parse(ctx, "jordan:k=3,case=H-inc", &s) == STEIF_OK);
  CHECK(!strcmp(stf_spec_word(&s, "case"), "H-inc"));
  CHECK(steif_spec_parse(ctx, "x_1:a.b=-2.5e+3", &s) == STEIF_OK);
  CHECK(!strcmp(s.param[0].key, "a.b") && !strcmp(s.param[0].value, "-2.5e+3"));
  CHECK(steif_spec_parse(ctx, "glm:file=../some/where.glm,p=3", &s) == STEIF_OK);
  CHECK(!strcmp(stf_spec_word(&s, "file"), "../some/where.glm") && s.count == 2);
  CHECK(steif_spec_parse(ctx, "glm:some/where", &s) == STEIF_BAD_INPUT); /* paths are values */
  steif_context_free(&ctx);
}

static void bad_specs_are_refused_with_a_place(void)
{
  static const char *const bad[] = {
    "",        ":",         "radau:",     "radau:s=",     "radau:=3", "radau:s=3,",
    "a b",     "radau s=3", "radau:s==3", "radau:s=3;q",  "a:b:c",    "a,b",
    "a:b=c=d", "a:b=1,b=2", "a:word,two", "a:b=\xc3\xa9", " a",       "a ",
    "a:b=(3)", "a/../b",    "a:b=%s%n",   "\n",           "a:,b=1",
  };
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    steif_spec s;
    steif_forget(ctx);
    CHECK(steif_spec_parse(ctx, bad[i], &s) == STEIF_BAD_INPUT);
    CHECK(strstr(steif_message(ctx), "near position"));
  }
  CHECK(steif_spec_parse(ctx, "radau:s=3,s=4", &(steif_spec){0}) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "'radau:s=3,s=4' near position 13"));
  CHECK(steif_spec_parse(ctx, NULL, &(steif_spec){0}) == STEIF_BAD_INPUT);
  CHECK(steif_spec_parse(ctx, "be", NULL) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

static void words_and_parameters_have_limits(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_spec s;
  char text[400];
  memset(text, 'w', sizeof text);
  text[STEIF_SPEC_WORD - 1] = 0;
  CHECK(steif_spec_parse(ctx, text, &s) == STEIF_OK);
  CHECK(strlen(s.name) == STEIF_SPEC_WORD - 1);
  text[STEIF_SPEC_WORD - 1] = 'w', text[STEIF_SPEC_WORD] = 0;
  CHECK(steif_spec_parse(ctx, text, &s) == STEIF_BAD_INPUT);
  text[STEIF_SPEC_WORD] = 'w', text[sizeof text - 1] = 0;
  CHECK(steif_spec_parse(ctx, text, &s) == STEIF_BAD_INPUT);
  char many[16 * (STEIF_SPEC_PARAMS + 2)] = "m";
  for (int i = 0; i < STEIF_SPEC_PARAMS; i++)
    snprintf(many + strlen(many), 16, "%cp%d=%d", i ? ',' : ':', i, 3 * i);
  CHECK(steif_spec_parse(ctx, many, &s) == STEIF_OK);
  CHECK(s.count == STEIF_SPEC_PARAMS && !strcmp(s.param[63].key, "p63"));
  CHECK(!strcmp(s.param[63].value, "189"));
  strcat(many, ",more=1");
  CHECK(steif_spec_parse(ctx, many, &s) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "at most 64 parameters"));
  steif_context_free(&ctx);
}

static void whole_numbers_are_checked(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_spec s;
  int value = -77;
  CHECK(steif_spec_parse(ctx, "radau:s=5,t=3.5,u=five,v=4x,w=1e1,x=nan", &s) == STEIF_OK);
  CHECK(stf_spec_int(ctx, &s, "s", 2, 32, 3, &value) == STEIF_OK && value == 5);
  CHECK(stf_spec_int(ctx, &s, "w", 2, 32, 3, &value) == STEIF_OK && value == 10);
  CHECK(stf_spec_int(ctx, &s, "absent", 2, 32, 3, &value) == STEIF_OK && value == 3);
  CHECK(stf_spec_int(ctx, &s, "s", 6, 32, 7, &value) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "s=5 of 'radau' must be a whole number from 6 to 32"));
  CHECK(stf_spec_int(ctx, &s, "s", 2, 4, 3, &value) == STEIF_BAD_INPUT);
  for (const char *key = "tuvx"; *key; key++)
    CHECK(stf_spec_int(ctx, &s, (char[]){*key, 0}, -9, 9, 3, &value) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

static void reals_are_checked(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_spec s;
  sunrealtype value = -77;
  CHECK(steif_spec_parse(ctx, "vdpol:mu=2.5e-3,a=inf,b=nan,c=0x1p-3,d=1e999,e=--2", &s) ==
        STEIF_OK);
  CHECK(stf_spec_real(ctx, &s, "mu", 0, 1e3, 30, &value) == STEIF_OK);
  CHECK(value == 2.5e-3);
  CHECK(stf_spec_real(ctx, &s, "absent", 0, 1e3, 30.5, &value) == STEIF_OK && value == 30.5);
  CHECK(stf_spec_real(ctx, &s, "mu", 0.25, 1e3, 30, &value) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "mu=2.5e-3 of 'vdpol' must be a number from 0.25 to 1000"));
  for (const char *key = "abde"; *key; key++)
    CHECK(stf_spec_real(ctx, &s, (char[]){*key, 0}, -1e300, 1e300, 30, &value) ==
          STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

static void unknown_parameters_are_named(void)
{
  steif_context *ctx = steif_context_new(NULL);
  static const char *const keys[] = {"s", "start", NULL}, *const word[] = {"", NULL};
  steif_spec s;
  CHECK(steif_spec_parse(ctx, "radau:s=3,start=cq", &s) == STEIF_OK);
  CHECK(stf_spec_only(ctx, &s, keys) == STEIF_OK);
  CHECK(stf_spec_only(ctx, &s, word) == STEIF_UNKNOWN_NAME);
  CHECK(strstr(steif_message(ctx), "'radau' has no parameter 's'; it takes none"));
  CHECK(steif_spec_parse(ctx, "radau:stages=3", &s) == STEIF_OK);
  CHECK(stf_spec_only(ctx, &s, keys) == STEIF_UNKNOWN_NAME);
  CHECK(strstr(steif_message(ctx), "no parameter 'stages'; it takes s, start"));
  CHECK(steif_spec_parse(ctx, "dirk:alexander2", &s) == STEIF_OK);
  CHECK(stf_spec_only(ctx, &s, word) == STEIF_OK);
  CHECK(stf_spec_only(ctx, &s, keys) == STEIF_UNKNOWN_NAME);
  CHECK(strstr(steif_message(ctx), "no parameter 'alexander2'"));
  steif_context_free(&ctx);
}

static void the_nearest_name_is_found(void)
{
  static const struct {
    const char *name;
    int other;
  } shelf[] = {{"gauss", 3}, {"radau", 5}, {"radau1a", 7}, {"lobatto3c", 11}, {"bdf", 13}};
  const size_t count = sizeof shelf / sizeof *shelf, stride = sizeof *shelf;
  CHECK(!strcmp(stf_nearest("raddau", shelf, count, stride), "radau"));
  CHECK(!strcmp(stf_nearest("radau2a", shelf, count, stride), "radau1a"));
  CHECK(!strcmp(stf_nearest("lobato", shelf, count, stride), "lobatto3c"));
  CHECK(!strcmp(stf_nearest("guass", shelf, count, stride), "gauss"));
  CHECK(stf_nearest("", shelf, count, stride) == NULL);
  CHECK(stf_nearest("nosuch", shelf, count, stride) == NULL);
  CHECK(stf_nearest("gauss", shelf, 0, stride) == NULL);
  char huge[500];
  memset(huge, 'z', sizeof huge - 1), huge[sizeof huge - 1] = 0;
  CHECK(stf_nearest(huge, shelf, count, stride) == NULL);
  char guess[STF_GUESS];
  CHECK(stf_distance("guass", "gauss") == 1 && stf_distance("ba", "ab") == 1);
  CHECK(stf_distance("abcd", "abcd") == 0 && stf_distance("ABCD", "abcd") == 1);
  CHECK(stf_distance("", "abc") == 3 && stf_distance("abc", "") == 3);
  CHECK(stf_distance("kitten", "sitting") == 3 && stf_distance("Radua", "radau") == 1);
  CHECK(!strcmp(stf_guess("guass", shelf, count, stride, guess), "; did you mean 'gauss'?"));
  CHECK(!*stf_guess("nosuch", shelf, count, stride, guess));
}

CU_TestInfo tests_of_spec[] = {
  {"good specs are taken apart", good_specs_are_taken_apart},
  {"bad specs are refused with a place", bad_specs_are_refused_with_a_place},
  {"words and parameters have limits", words_and_parameters_have_limits},
  {"whole numbers are checked", whole_numbers_are_checked},
  {"reals are checked", reals_are_checked},
  {"unknown parameters are named", unknown_parameters_are_named},
  {"the nearest name is found", the_nearest_name_is_found},
  CU_TEST_INFO_NULL,
};
