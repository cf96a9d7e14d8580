/* test_context.c: setup, the last message, codes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"
#include "failing.h"
#include "suite.h"
#include <string.h>

static void new_context_is_ok(void)
{
  steif_context *ctx = steif_context_new(NULL);
  CHECK(ctx != NULL);
  CHECK(steif_status(ctx) == STEIF_OK);
  CHECK(!strcmp(steif_message(ctx), "ok"));
  CHECK(steif_sundials(ctx) != NULL);
  CHECK(stf_threads(ctx) >= 1);
  steif_context_free(&ctx);
  CHECK(ctx == NULL);
  steif_context_free(&ctx);
  steif_context_free(NULL);
}

static void half_an_allocator_is_refused(void)
{
  failing f = {0};
  steif_setup only_allocate = failing_setup(&f), only_release = failing_setup(&f);
  only_allocate.release = NULL, only_release.allocate = NULL;
  CHECK(steif_context_new(&only_allocate) == NULL);
  CHECK(steif_context_new(&only_release) == NULL);
  CHECK(f.served == 0 && f.alive == 0);
  CHECK(strstr(steif_message(NULL), "only one of allocate and release"));
  CHECK(steif_status(NULL) == STEIF_NO_MEMORY);
}

static void a_refused_context_leaves_nothing(void)
{
  failing f = {.refuse_at = 1};
  const steif_setup setup = failing_setup(&f);
  CHECK(steif_context_new(&setup) == NULL);
  CHECK(f.served == 1 && f.alive == 0);
}

static void own_allocator_serves_everything(void)
{
  failing f = {0};
  steif_setup setup = failing_setup(&f);
  setup.threads = 3;
  steif_context *ctx = steif_context_new(&setup);
  CHECK(stf_threads(ctx) == 3);
  const long before = f.alive;
  double *block = stf_allocate(ctx, 37, sizeof *block);
  CHECK(f.alive == before + 1);
  int zeroed = 1;
  for (int i = 0; i < 37; i++) zeroed &= block[i] == 0;
  CHECK(zeroed);
  stf_release(ctx, block);
  stf_release(ctx, NULL);
  steif_context_free(&ctx);
  CHECK(f.served >= 2 && f.alive == 0);
}

static int fails(steif_context *ctx, double h)
{
  STEIF_CHECK(h > 0, ctx, STEIF_STEP_SIZE, "the step is h = %g: give a positive one", h);
  return STEIF_OK;
}

static int passes_on(steif_context *ctx, double h)
{
  STEIF_TRY(fails(ctx, h));
  return STEIF_RETRY;
}

static int wraps(steif_context *ctx, double h)
{
  fails(ctx, h);
  return STEIF_FAIL(ctx, STEIF_BAD_INPUT, "in [0, 1]: %s", steif_message(ctx));
}

/* A sentence that passes on another has its own code alone; brackets of other kinds stay. */
static void a_sentence_has_one_code(void)
{
  steif_context *ctx = steif_context_new(NULL);
  CHECK(wraps(ctx, -0.375) == STEIF_BAD_INPUT);
  CHECK(!strcmp(steif_message(ctx),
                "in [0, 1]: the step is h = -0.375: give a positive one [STEIF_BAD_INPUT]"));
  CHECK(STEIF_FAIL(ctx, STEIF_IO, "a place in [0, 1]") == STEIF_IO);
  CHECK(!strcmp(steif_message(ctx), "a place in [0, 1] [STEIF_IO]"));
  steif_context_free(&ctx);
}

static void a_failure_keeps_code_values_and_place(void)
{
  steif_context *ctx = steif_context_new(NULL);
  CHECK(passes_on(ctx, -0.375) == STEIF_STEP_SIZE);
  CHECK(steif_status(ctx) == STEIF_STEP_SIZE);
  CHECK(!strcmp(steif_message(ctx),
                "the step is h = -0.375: give a positive one [STEIF_STEP_SIZE]"));
  CHECK(passes_on(ctx, 0.375) == STEIF_RETRY);
  CHECK(steif_status(ctx) == STEIF_STEP_SIZE);
  steif_forget(ctx);
  CHECK(steif_status(ctx) == STEIF_OK && !strcmp(steif_message(ctx), "ok"));
  CHECK(fails(NULL, -0.375) == STEIF_STEP_SIZE);
  steif_context_free(&ctx);
}

static void a_long_sentence_is_cut_not_overrun(void)
{
  steif_context *ctx = steif_context_new(NULL);
  char text[3001];
  memset(text, 'q', 3000);
  text[3000] = 0;
  CHECK(STEIF_FAIL(ctx, STEIF_IO, "%s", text) == STEIF_IO);
  const size_t length = strlen(steif_message(ctx));
  CHECK(length > 500 && length < 3000);
  CHECK(strspn(steif_message(ctx), "q") == length);
  steif_context_free(&ctx);
}

static void every_code_has_name_and_remedy(void)
{
  for (int code = STEIF_NOT_CERTIFIED; code <= STEIF_RETRY; code++) {
    CHECK(strcmp(steif_code_name(code), "unknown code"));
    CHECK(strlen(steif_code_remedy(code)) > 10);
  }
  CHECK(!strcmp(steif_code_name(-99), "unknown code"));
  CHECK(!strcmp(steif_code_remedy(17), ""));
}

static void the_version_is_that_of_the_header(void)
{
  char text[40];
  snprintf(text, sizeof text, "%d.%d.%d", STEIF_VERSION_MAJOR, STEIF_VERSION_MINOR,
           STEIF_VERSION_PATCH);
  CHECK(!strcmp(steif_version(), text));
}

CU_TestInfo tests_of_context[] = {
  {"a new context is ok", new_context_is_ok},
  {"half an allocator is refused", half_an_allocator_is_refused},
  {"a refused context leaves nothing", a_refused_context_leaves_nothing},
  {"an own allocator serves everything", own_allocator_serves_everything},
  {"a failure keeps code, values and place", a_failure_keeps_code_values_and_place},
  {"a sentence has one code", a_sentence_has_one_code},
  {"a long sentence is cut, not overrun", a_long_sentence_is_cut_not_overrun},
  {"every code has a name and a remedy", every_code_has_name_and_remedy},
  {"the version is that of the header", the_version_is_that_of_the_header},
  CU_TEST_INFO_NULL,
};
