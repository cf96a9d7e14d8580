/* test_files.c: files that are no whole checkpoint of this run are refused with the reason, and no solver is
 * harmed; memory may fail at any place.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "oscillator.h"
#include "suite.h"
#include <string.h>

typedef struct file {
  unsigned char *bytes;
  size_t count;
} file;

static file slurp(const char *path)
{
  file f = {0};
  FILE *stream = fopen(path, "rb");
  CU_ASSERT_FATAL(stream != NULL);
  fseek(stream, 0, SEEK_END);
  f.count = (size_t)ftell(stream);
  rewind(stream);
  f.bytes = malloc(f.count + 1);
  CHECK(fread(f.bytes, 1, f.count, stream) == f.count);
  fclose(stream);
  return f;
}

static void spill(const char *path, const unsigned char *bytes, size_t count)
{
  FILE *stream = fopen(path, "wb");
  CU_ASSERT_FATAL(stream != NULL);
  CHECK(fwrite(bytes, 1, count, stream) == count);
  fclose(stream);
}

/* Is the file refused with this code, and a sentence that has the word? */
static int refused(steif_context *ctx, const char *path, const steif_problem *p,
                   const steif_options *o, int code, const char *word)
{
  steif_solver *s = steif_checkpoint_load(ctx, path, p, o);
  const int good = !s && steif_status(ctx) == code && strstr(steif_message(ctx), word);
  if (!good)
    printf("\n  %d '%s', expected %d '%s'", steif_status(ctx), steif_message(ctx), code, word);
  steif_solver_free(&s);
  return good;
}

/* Every part of a file that is cut short or has one bit turned. */
static void damage_is_noticed(void)
{
  const char *path = scratch("damage");
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = oscillator();
  steif_solver *s = under_way(ctx, &p, "radau:s=3", NULL);
  CU_ASSERT_FATAL(s && !steif_checkpoint_save(s, path, "note", 4));
  file f = slurp(path);
  for (size_t cut = 0; cut < f.count; cut += 1 + f.count / 97) {
    spill(path, f.bytes, cut);
    CHECK(
      refused(ctx, path, &p, NULL, STEIF_IO, cut < 48 ? "is no checkpoint" : "is cut short"));
  }
  for (size_t at = 40; at < f.count; at += 1 + f.count / 97) {
    f.bytes[at] ^= (unsigned char)(1u << at % 8);
    spill(path, f.bytes, f.count);
    CHECK(refused(ctx, path, &p, NULL, STEIF_IO, "is damaged"));
    f.bytes[at] ^= (unsigned char)(1u << at % 8);
  }
  f.bytes[3] ^= 1; /* magic */
  spill(path, f.bytes, f.count);
  CHECK(refused(ctx, path, &p, NULL, STEIF_IO, "is no checkpoint"));
  f.bytes[3] ^= 1, f.bytes[8] ^= 5; /* order of bytes: 04 03 02 01 */
  spill(path, f.bytes, f.count);
  CHECK(refused(ctx, path, &p, NULL, STEIF_UNSUPPORTED, "another order of bytes"));
  f.bytes[8] ^= 5, f.bytes[12] ^= 1; /* version */
  spill(path, f.bytes, f.count);
  CHECK(refused(ctx, path, &p, NULL, STEIF_UNSUPPORTED, "has version 2, this steif reads 3"));
  CHECK(!steif_solve_to(s, p.t1)); /* the run that was saved */
  free(f.bytes), remove(path);
  steif_solver_free(&s), steif_context_free(&ctx);
}

static void foreign_files_are_refused(void)
{
  const char *path = scratch("foreign");
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = oscillator();
  static const char text[] = "%%MatrixMarket matrix coordinate real general\n2 2 1\n1 1 3.5\n";
  spill(path, (const unsigned char *)text, sizeof text);
  CHECK(refused(ctx, path, &p, NULL, STEIF_IO, "is no checkpoint"));
  remove(path);
  CHECK(refused(ctx, path, &p, NULL, STEIF_IO, "No such file"));
  CHECK(refused(ctx, "/", &p, NULL, STEIF_IO, "cannot be read"));
  CHECK(refused(ctx, NULL, &p, NULL, STEIF_BAD_INPUT, "path"));
  CHECK(steif_checkpoint_load(NULL, path, &p, NULL) == NULL);
  steif_context_free(&ctx);
}

/* Another problem: name, size, parameters, form; other options. */
static void other_runs_are_refused(void)
{
  const char *path = scratch("other");
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p = oscillator(), q = p;
  steif_options o = steif_defaults();
  steif_solver *s = under_way(ctx, &p, "bdf", &o);
  CU_ASSERT_FATAL(s && !steif_checkpoint_save(s, path, NULL, 0));
  q.name = "pendulum";
  CHECK(refused(ctx, path, &q, &o, STEIF_BAD_INPUT,
                "'oscillator' with 2 unknowns, not of 'pendulum'"));
  q = p, q.n = 1;
  CHECK(refused(ctx, path, &q, &o, STEIF_BAD_INPUT, "with 1"));
  sunrealtype mu = 50.000001;
  q = p, q.user = &mu;
  CHECK(refused(ctx, path, &q, &o, STEIF_BAD_INPUT, "parameters of that run"));
  mu = 50; /* the same values: the same problem */
  steif_solver *same = steif_checkpoint_load(ctx, path, &q, &o);
  CHECK(same != NULL);
  steif_solver_free(&same);
  const sunrealtype other[] = {2, -0.65};
  q = p, q.y0 = other;
  CHECK(refused(ctx, path, &q, &o, STEIF_BAD_INPUT, "other start values"));
  o.rtol = 1e-7;
  CHECK(refused(ctx, path, &p, &o, STEIF_BAD_INPUT, "rtol was 9.99"));
  o = steif_defaults(), o.h = 0.01;
  CHECK(refused(ctx, path, &p, &o, STEIF_BAD_INPUT, "h was 0 in the run"));
  CHECK(refused(ctx, path, NULL, NULL, STEIF_BAD_INPUT, "a problem is needed"));
  steif_solver_free(&s), remove(path), steif_context_free(&ctx);
}

static void what_cannot_be_written_is_told(void)
{
  const char *path = scratch("kept");
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = oscillator();
  steif_solver *s = under_way(ctx, &p, "radau:s=3", NULL);
  CU_ASSERT_FATAL(s != NULL);
  CHECK(steif_checkpoint_save(s, "no/such/folder/x.ck", NULL, 0) == STEIF_IO);
  CHECK(strstr(steif_message(ctx), "No such file") != NULL);
  CHECK(steif_checkpoint_save(s, NULL, NULL, 0) == STEIF_BAD_INPUT);
  CHECK(steif_checkpoint_save(s, path, NULL, 3) == STEIF_BAD_INPUT);
  CHECK(steif_checkpoint_save(NULL, path, NULL, 0) == STEIF_BAD_INPUT);
  CHECK(!steif_checkpoint_save(s, path, "first", 5) &&
        !steif_checkpoint_save(s, path, "2nd", 3));
  steif_checkpoint *c = steif_checkpoint_read(ctx, path);
  CU_ASSERT_FATAL(c != NULL);
  CHECK(c->note_bytes == 3 && !memcmp(c->note, "2nd", 3));
  CHECK(!strcmp(c->problem, "oscillator") && !strcmp(c->method, "radau:s=3") && c->n == 2);
  CHECK(c->steps == 20 && c->t == steif_time(s) && c->t1 == 3 && !c->finished);
  steif_checkpoint_free(ctx, &c), steif_checkpoint_free(ctx, &c);
  steif_solver_free(&s), remove(path), steif_context_free(&ctx);
}

/* The k-th allocation fails, for every k: of save, of load, of copies of both. */
static void memory_may_fail(void)
{
  const char *path = scratch("memory");
  const steif_problem p = oscillator();
  failing f = {0};
  for (long k = 1;; k++) {
    steif_setup setup = failing_setup(&f);
    f = (failing){0};
    steif_context *ctx = steif_context_new(&setup);
    steif_solver *a = under_way(ctx, &p, "bdf", NULL), *b = NULL;
    CU_ASSERT_FATAL(a != NULL);
    f.refuse_at = f.served + k;
    int code = steif_checkpoint_save(a, path, "note", 4);
    if (!code && !(b = steif_checkpoint_load(ctx, path, &p, NULL))) code = steif_status(ctx);
    f.refuse_at = 0;
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    CHECK(!steif_solve_to(a, 2));
    steif_solver_free(&a), steif_solver_free(&b);
    steif_context_free(&ctx);
    CHECK(f.alive == 0);
    if (code == STEIF_OK) break;
    CU_ASSERT_FATAL(k < 500);
  }
  remove(path);
}

CU_TestInfo tests_of_files[] = {
  {"damage is noticed", damage_is_noticed},
  {"foreign files are refused", foreign_files_are_refused},
  {"other runs are refused", other_runs_are_refused},
  {"what cannot be written is told", what_cannot_be_written_is_told},
  {"memory may fail", memory_may_fail},
  CU_TEST_INFO_NULL};
