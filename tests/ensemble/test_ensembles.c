/* test_ensembles.c: the same bits for any number of workers, order, failures, stops.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <steif/data.h>
#include <steif/ensemble.h>
#include <steif/steif.h>
#include <string.h>

enum { MEMBERS = 150, BAD = 40 };

typedef struct row {
  double y[3], t;
  int code;
  char sentence[200];
} row;

typedef struct collected {
  uint64_t hash; /* FNV-1a of the records in the order in which they come */
  long long rows, last;
  bool ordered;
  long long fail_at, stop_at;
  volatile int stop;
  row of[MEMBERS];
} collected;

static int set_rates(steif_context *ctx, long long i, steif_problem *p, steif_options *o,
                     void *user)
{
  (void)ctx, (void)user;
  p->parameters->value[0] = 0.01 + 0.06 * steif_ensemble_uniform(7, 2 * (unsigned long long)i);
  p->parameters->value[2] =
    3e7 * (1 + steif_ensemble_uniform(7, 2 * (unsigned long long)i + 1));
  o->t1 = 100 + (double)(i % 7) * 1000;
  if (i % BAD == BAD - 1) o->max_steps = 3;
  return STEIF_OK;
}

static int keep(steif_context *ctx, long long i, const steif_problem *p, steif_solver *s,
                int code, void *record, void *user)
{
  row *r = record;
  collected *c = user;
  (void)p;
  r->code = code;
  r->t = s ? steif_time(s) : NAN;
  if (s) memcpy(r->y, N_VGetArrayPointer(steif_solution(s)), sizeof r->y);
  if (code) snprintf(r->sentence, sizeof r->sentence, "%s", steif_message(ctx));
  return c->fail_at && i == c->fail_at ? STEIF_IO : STEIF_OK;
}

static int take_row(long long i, const void *record, void *user)
{
  collected *c = user;
  c->hash = c->rows ? c->hash : UINT64_C(0xcbf29ce484222325);
  for (size_t k = 0; k < sizeof(row); k++)
    c->hash = (c->hash ^ ((const unsigned char *)record)[k]) * UINT64_C(0x100000001b3);
  c->ordered = c->rows ? c->ordered && i > c->last : true;
  c->last = i;
  if (i < MEMBERS) c->of[i] = *(const row *)record;
  c->rows++;
  if (c->stop_at && i == c->stop_at) c->stop = 1;
  return 0;
}

static int sweep(int threads, const char *problem, long long count, steif_member member,
                 collected *c)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.rtol = 1e-5;
  const steif_ensemble_options e = {.problem = problem,
                                    .method = "radau:s=3",
                                    .options = &o,
                                    .threads = threads,
                                    .record = sizeof(row),
                                    .row = take_row,
                                    .user = c,
                                    .stop = &c->stop};
  const int code = steif_ensemble(ctx, count, member, keep, &e);
  CHECK(code == steif_status(ctx));
  steif_context_free(&ctx);
  return code;
}

static void same_bits(void)
{
  static collected one, many;
  CHECK(sweep(1, "rober", MEMBERS, set_rates, &one) == STEIF_OK);
  CHECK(one.rows == MEMBERS && one.ordered);
  for (int threads = 2; threads <= 5; threads++) {
    many = (collected){0};
    CHECK(sweep(threads, "rober", MEMBERS, set_rates, &many) == STEIF_OK);
    CHECK(many.rows == MEMBERS && many.ordered && many.hash == one.hash);
  }
}

/* Members alone, in a context and problem of their own. */
static void as_alone(void)
{
  static collected all;
  CHECK(sweep(3, "rober", MEMBERS, set_rates, &all) == STEIF_OK);
  for (long long i = 0; i < MEMBERS; i += 17) {
    steif_context *ctx = steif_context_new(&(steif_setup){.threads = 1});
    steif_problem p;
    steif_options o = steif_defaults();
    o.rtol = 1e-5;
    CHECK(steif_problem_find(ctx, "rober", &p) == STEIF_OK);
    set_rates(ctx, i, &p, &o, NULL);
    steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
    CHECK(steif_solve_to(s, o.t1) == all.of[i].code);
    CHECK(!memcmp(N_VGetArrayPointer(steif_solution(s)), all.of[i].y, sizeof all.of[i].y));
    steif_solver_free(&s);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
}

static void failures_are_rows(void)
{
  static collected c;
  CHECK(sweep(2, "rober", MEMBERS, set_rates, &c) == STEIF_OK);
  for (int i = 0; i < MEMBERS; i++) {
    const bool bad = i % BAD == BAD - 1;
    CHECK(c.of[i].code == (bad ? STEIF_STEP_LIMIT : STEIF_OK));
    CHECK(bad == (strstr(c.of[i].sentence, "STEP_LIMIT") != NULL));
  }
}

/* Every third member cannot be opened. */
static int member_of_its_own(steif_context *ctx, long long i, steif_problem *p,
                             steif_options *o, void *user)
{
  (void)user;
  o->t1 = 1;
  return steif_problem_find(ctx, i % 3 ? "rober" : "robbr", p);
}

static void members_bring_problems(void)
{
  static collected c;
  CHECK(sweep(2, NULL, 20, member_of_its_own, &c) == STEIF_OK);
  CHECK(c.rows == 20);
  for (int i = 0; i < 20; i++) {
    CHECK(c.of[i].code == (i % 3 ? STEIF_OK : STEIF_UNKNOWN_NAME));
    CHECK(i % 3 || strstr(c.of[i].sentence, "did you mean 'rober'"));
  }
}

/* A member may change every member of its problem, its name as well. */
static int rename_it(steif_context *ctx, long long i, steif_problem *p, steif_options *o,
                     void *user)
{
  p->name = "mine";
  return set_rates(ctx, i, p, o, user);
}

static void members_may_be_renamed(void)
{
  static collected named, plain;
  named = plain = (collected){0};
  CHECK(sweep(2, "rober", MEMBERS, set_rates, &plain) == STEIF_OK);
  CHECK(sweep(2, "rober", MEMBERS, rename_it, &named) == STEIF_OK);
  for (int i = 0; i < MEMBERS; i++)
    CHECK(!memcmp(named.of[i].y, plain.of[i].y, sizeof plain.of[i].y));
}

static void stops_keep_what_is_finished(void)
{
  static collected all, some;
  CHECK(sweep(1, "rober", MEMBERS, set_rates, &all) == STEIF_OK);
  for (int threads = 1; threads <= 3; threads++) {
    some = (collected){.stop_at = 20};
    CHECK(sweep(threads, "rober", MEMBERS, set_rates, &some) == STEIF_STOPPED);
    CHECK(some.rows >= 21 && some.rows < MEMBERS && some.ordered);
    for (int i = 0; i <= 20; i++) CHECK(!memcmp(&some.of[i], &all.of[i], sizeof(row)));
  }
}

static void callbacks_can_end_it(void)
{
  static collected c;
  c = (collected){.fail_at = 31};
  CHECK(sweep(3, "rober", MEMBERS, set_rates, &c) == STEIF_IO);
  CHECK(c.rows < MEMBERS && c.ordered && c.of[31].code == 0 && c.of[31].t == 0);
}

static int refuse_row(long long i, const void *record, void *user)
{
  (void)record, (void)user;
  return i == 10;
}

static void rows_can_be_refused(void)
{
  static collected c;
  steif_context *ctx = steif_context_new(NULL);
  const steif_ensemble_options e = {
    .problem = "rober", .threads = 3, .record = sizeof(row), .row = refuse_row, .user = &c};
  CHECK(steif_ensemble(ctx, MEMBERS, set_rates, keep, &e) == STEIF_CALLBACK);
  CHECK(strstr(steif_message(ctx), "member 10"));
  steif_context_free(&ctx);
}

static void bad_input(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_ensemble_options e = {.problem = "rober"};
  CHECK(steif_ensemble(NULL, 1, set_rates, keep, &e) == STEIF_BAD_INPUT);
  CHECK(steif_ensemble(ctx, 0, set_rates, keep, &e) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "0 members"));
  CHECK(steif_ensemble(ctx, 1, NULL, keep, &e) == STEIF_BAD_INPUT);
  CHECK(steif_ensemble(ctx, 1, set_rates, NULL, &e) == STEIF_BAD_INPUT);
  CHECK(steif_ensemble(ctx, 1, set_rates, keep, NULL) == STEIF_BAD_INPUT);
  e.threads = 1000;
  CHECK(steif_ensemble(ctx, 1, set_rates, keep, &e) == STEIF_BAD_INPUT);
  e = (steif_ensemble_options){.problem = "robber"};
  CHECK(steif_ensemble(ctx, 1, set_rates, keep, &e) == STEIF_UNKNOWN_NAME);
  CHECK(strstr(steif_message(ctx), "did you mean 'rober'"));
  steif_context_free(&ctx);
}

/* An allocator for several threads, whose allocation number `left` fails. */
typedef struct purse {
  atomic_int left, out, calls;
} purse;

static void *grant(size_t bytes, void *user)
{
  purse *p = user;
  void *block = atomic_fetch_sub(&p->left, 1) == 0 ? NULL : malloc(bytes);
  atomic_fetch_add(&p->out, block != NULL);
  atomic_fetch_add(&p->calls, 1);
  return block;
}

static void give_back(void *block, void *user)
{
  atomic_fetch_sub(&((purse *)user)->out, block != NULL);
  free(block);
}

static int few_members(purse *p, int fails, collected *c)
{
  p->left = -1;
  steif_context *ctx = steif_context_new(
    &(steif_setup){.allocate = grant, .release = give_back, .user = p, .threads = 2});
  const int before = p->out;
  const steif_ensemble_options e = {
    .problem = "rober", .record = sizeof(row), .row = take_row, .user = c};
  p->left = fails;
  *c = (collected){0};
  const int code = steif_ensemble(ctx, 8, set_rates, keep, &e);
  CHECK(p->out == before);
  steif_context_free(&ctx);
  CHECK(p->out == 0);
  return code;
}

/* What workers allocate is of the caller's allocator: one that fails is a member's failure, or the end of the
 * ensemble where its own memory is short. */
static void short_memory(void)
{
  static collected c, good;
  purse all = {0};
  CHECK(few_members(&all, -1, &good) == STEIF_OK && good.rows == 8);
  CHECK(all.calls > 200);
  int ended = 0, failed = 0;
  for (int k = 0; k < all.calls; k += 1 + k / 8) {
    purse p = {0};
    const int code = few_members(&p, k, &c);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    ended += code == STEIF_NO_MEMORY;
    CHECK(code || c.rows == 8);
    for (int i = 0; !code && i < 8; i++) {
      failed += c.of[i].code != 0;
      CHECK(c.of[i].code == STEIF_NO_MEMORY || !memcmp(&c.of[i], &good.of[i], sizeof(row)));
    }
  }
  CHECK(ended > 2 && failed > 2);
}

/* Two ensembles as two ranks share one counter: together they run each member once, with the same bits. */
typedef struct sharing {
  atomic_llong next;
  collected c[2];
} sharing;

static long long take_shared(long long chunk, void *queue)
{
  return atomic_fetch_add(&((sharing *)queue)->next, chunk);
}

typedef struct rank {
  sharing *with;
  int number;
} rank;

static void *run_rank(void *argument)
{
  rank *r = argument;
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.rtol = 1e-5;
  const steif_ensemble_options e = {.problem = "rober",
                                    .method = "radau:s=3",
                                    .options = &o,
                                    .threads = 2,
                                    .workers = 4,
                                    .record = sizeof(row),
                                    .row = take_row,
                                    .user = &r->with->c[r->number],
                                    .take = take_shared,
                                    .queue = r->with};
  CHECK(steif_ensemble(ctx, MEMBERS, set_rates, keep, &e) == STEIF_OK);
  steif_context_free(&ctx);
  return NULL;
}

static void chunks_can_be_shared(void)
{
  static sharing all;
  static collected one;
  rank r[2] = {{&all, 0}, {&all, 1}};
  pthread_t other;
  CHECK(!pthread_create(&other, NULL, run_rank, &r[1]));
  run_rank(&r[0]);
  pthread_join(other, NULL);
  one = (collected){0};
  CHECK(sweep(1, "rober", MEMBERS, set_rates, &one) == STEIF_OK);
  CHECK(all.c[0].rows + all.c[1].rows == MEMBERS);
  CHECK((all.c[0].ordered || !all.c[0].rows) && (all.c[1].ordered || !all.c[1].rows));
  for (int i = 0; i < MEMBERS; i++) {
    const int at = all.c[0].of[i].t == 0;
    CHECK(!memcmp(&all.c[at].of[i], &one.of[i], sizeof(row)));
  }
}

/* Mean 1/2, variance 1/12, no correlation of neighbours in counter or seed: within five standard errors. */
static void numbers_are_uniform(void)
{
  enum { N = 20000 };
  double sum = 0, square = 0, neighbour = 0, seeds = 0;
  for (unsigned long long i = 0; i < N; i++) {
    const double u = steif_ensemble_uniform(5, i) - 0.5;
    CHECK(fabs(u) < 0.5);
    sum += u, square += u * u;
    neighbour += u * (steif_ensemble_uniform(5, i + 1) - 0.5);
    seeds += u * (steif_ensemble_uniform(6, i) - 0.5);
  }
  /* The largest of all 2^53 numbers: 1 - 2^-54 is no number of this precision. */
  CHECK(steif_ensemble_uniform(1080776227074132637ULL, 0) == 1 - 0x1p-53);
  CHECK(fabs(sum / N) < 5 * sqrt(1. / 12 / N));
  CHECK(fabs(square / N - 1. / 12) < 5 * sqrt(1. / 180 / N));
  CHECK(fabs(neighbour / N) < 5. / 12 / sqrt(N) && fabs(seeds / N) < 5. / 12 / sqrt(N));
}

CU_TestInfo tests_of_ensembles[] = {
  {"the same bits for 1 to 5 workers, in order", same_bits},
  {"members are what they are alone", as_alone},
  {"failures are rows", failures_are_rows},
  {"members may bring problems of their own", members_bring_problems},
  {"members may be renamed", members_may_be_renamed},
  {"a stop keeps finished members", stops_keep_what_is_finished},
  {"done can end it", callbacks_can_end_it},
  {"row can end it", rows_can_be_refused},
  {"bad input", bad_input},
  {"short of memory", short_memory},
  {"two ranks share the members", chunks_can_be_shared},
  {"uniform numbers", numbers_are_uniform},
  CU_TEST_INFO_NULL};
