/* problem.c: a problem of the collection by a word of a call, and a point of its solution.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* XDG_CACHE_HOME, or .cache of the home folder; NULL: neither is an absolute path. */
static const char *cache_folder(char *room, size_t size)
{
  const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
  const bool own = cache && *cache == '/';
  if (!own && !(home && *home == '/')) return NULL;
  const int length =
    snprintf(room, size, "%s%s/steif/models", own ? cache : home, own ? "" : "/.cache");
  return length > 0 && (size_t)length < size ? room : NULL;
}

/* STEIF_CC, else CC where it has no arguments, else cc. */
static const char *compiler_of(void)
{
  const char *own = getenv("STEIF_CC"), *usual = getenv("CC");
  if (own && *own) return own;
  return usual && *usual && !strpbrk(usual, " \t") ? usual : "cc";
}

static void compile(struct call *call, const steif_problem *p)
{
  char folder[900];
  const char *compiler = compiler_of();
  if (!steif_model_compile(call->ctx, p, compiler, cache_folder(folder, sizeof folder))) return;
  say(call, "%s; it runs without --compile", steif_message(call->ctx));
  steif_forget(call->ctx);
}

/* A word that is no problem: what it may be instead. */
static int no_problem(struct call *call, const char *word)
{
  const int code = fail(call);
  const bool unknown = steif_status(call->ctx) == STEIF_UNKNOWN_NAME && !strchr(word, '/') &&
                       !strstr(word, ".steif");
  char file[300];
  steif_method_info method;
  snprintf(file, sizeof file, "%.200s.steif", word);
  if (unknown && !access(file, R_OK))
    say(call, "the file here is %s", file);
  else if (unknown && !access(word, R_OK))
    say(call, "'%s' is a file here: a model's name ends in .steif, or write ./%s", word, word);
  else if (unknown && call->words > 1 && strstr(call->word[1], ".steif"))
    say(call, "the problem comes before the method: %s %s", call->word[1], word);
  else if (unknown && call->verb->method && !steif_method_find(call->ctx, word, &method))
    say(call, "'%s' is a method, and the problem comes before it: steif %s %s", word,
        call->verb->name, call->verb->usage);
  return code;
}

/* What stands after the colon of a problem, "k=1,l=2"; NULL: nothing. */
static const char *after_colon(const char *word)
{
  const char *file = strstr(word, ".steif"), *colon = strchr(file ? file : word, ':');
  return colon ? colon + 1 : NULL;
}

/* Where a list of NAME=VALUE has this name before `end`; NULL: nowhere. */
static const char *place_of(const char *list, const char *end, const char *name, size_t length)
{
  for (const char *at = list; at < end; at += strcspn(at, ",") + 1)
    if (!strncmp(at, name, length) && at[length] == '=') return at;
  return NULL;
}

const char *value_given(const struct call *call, const char *word, const char *name)
{
  const char *list = after_colon(word);
  if (list && place_of(list, list + strlen(list), name, strlen(name))) return "after the colon";
  for (int i = 0; (list = repeated_of(call, "--set", i)); i++)
    if (place_of(list, list + strlen(list), name, strlen(name))) return "by --set";
  return NULL;
}

/* Names of --set in text, which begins with `word`, that it has before. */
static int each_once(struct call *call, const char *word, const char *text)
{
  const char *list = after_colon(text), *end = text + strlen(text),
             *own = text + strlen(word) + 1;
  for (const char *at = own; list && at < end; at += strcspn(at, ",") + 1) {
    const int length = (int)strcspn(at, "=,");
    const char *first = at[length] == '=' ? place_of(list, at, at, (size_t)length) : NULL;
    if (first)
      return bad_usage(call, "%.*s is given twice, %s by --set; leave one of them out", length,
                       at, first < own ? "after the colon and" : "both times");
  }
  return EXIT_OK;
}

/* "word:k=1,l=2" of all --set. */
static int with_values(struct call *call, const char *word, char *text, size_t room)
{
  const char *set;
  char mark = after_colon(word) ? ',' : ':';
  size_t used = (size_t)snprintf(text, room, "%s", word);
  for (int i = 0; (set = repeated_of(call, "--set", i)) && used < room; i++, mark = ',') {
    if (!strchr(set, '='))
      return bad_usage(call, "--set is \"%s\" and must be NAME=VALUE,...", set);
    used += (size_t)snprintf(text + used, room - used, "%c%s", mark, set);
  }
  return used < room ? each_once(call, word, text)
                     : bad_usage(call, "--set is longer than %zu characters", room);
}

int numbers_set(const struct call *call, int room, char name[][STEIF_SPEC_KEY], double *value,
                int *words)
{
  int count = 0;
  const char *at;
  *words = 0;
  for (int i = 0; (at = repeated_of(call, "--set", i)); i++)
    while (*at && count < room) {
      const size_t length = strcspn(at, "="), all = strcspn(at, ",");
      char *end = NULL;
      if (length < all && length < STEIF_SPEC_KEY) value[count] = strtod(at + length + 1, &end);
      if (end > at + length + 1 && end == at + all)
        snprintf(name[count++], STEIF_SPEC_KEY, "%.*s", (int)length, at);
      else
        ++*words;
      at += all + (at[all] == ',');
    }
  return count;
}

/* Numbers that the equations read need not stand after the colon: --set finds these, too. */
static int find_set(struct call *call, const char *word, const char *text, steif_problem *p)
{
  enum { SETS = 64 };
  char name[SETS][STEIF_SPEC_KEY];
  const char *names[SETS];
  double value[SETS];
  int words;
  const int code = steif_problem_find(call->ctx, text, p),
            count = numbers_set(call, SETS, name, value, &words);
  if (code != STEIF_UNKNOWN_NAME || !count || words) return code;
  steif_problem plain;
  if (steif_problem_find(call->ctx, word, &plain)) return steif_status(call->ctx);
  for (int k = 0; k < count; k++) names[k] = name[k];
  const int varied = steif_problem_vary(call->ctx, &plain, count, names, value, p);
  steif_problem_clear(call->ctx, &plain);
  return varied;
}

/* --storage: matrices that the callbacks of the problem do not fill, or whose places nobody knows. */
static int storage_fits(struct call *call, const steif_problem *p)
{
  const char *word = given(call, "--storage") ? word_of(call, "--storage") : "";
  if (!strcmp(word, "band") && p->storage != STEIF_BAND)
    return bad_usage(call, "--storage band: the Jacobian of '%s' is no band; leave it out",
                     p->name);
  if (!strcmp(word, "sparse") && p->storage != STEIF_SPARSE && !p->pattern && p->nnz <= 0)
    return bad_usage(
      call, "--storage sparse: the Jacobian of '%s' is dense and has no pattern; leave it out",
      p->name);
  return EXIT_OK;
}

/* The end of the run of a model without `time`; measurements bring their own. */
static int find_end(struct call *call, steif_problem *p)
{
  bool runs = false;
  const struct option *o;
  for (size_t i = 0; (o = option_at(call->verb, i)); i++)
    runs = runs || !strcmp(o->name, "--t1");
  if (p->t1 > p->t0 || !runs || given(call, "--data")) return EXIT_OK;
  if (given(call, "--t1")) p->t1 = fmax(p->t0, real_of(call, "--t1"));
  if (p->t1 > p->t0) return EXIT_OK;
  say(call,
      "%s: no time interval; add 'time %.12g to %.12g {s}' or give --t1 [STEIF_BAD_INPUT]",
      p->name, p->t0, p->t0 + 10);
  steif_problem_clear(call->ctx, p);
  return EXIT_FILE;
}

int find_problem(struct call *call, const char *word, steif_problem *p)
{
  char text[4096];
  const int wrong = with_values(call, word, text, sizeof text);
  if (wrong) return wrong;
  if (find_set(call, word, text, p) != STEIF_OK) return no_problem(call, word);
  const int unfit = storage_fits(call, p);
  if (unfit) {
    steif_problem_clear(call->ctx, p);
    return unfit;
  }
  if (given(call, "--compile")) compile(call, p);
  return find_end(call, p);
}

int with_problem(struct call *call, int (*work)(struct call *call, const steif_problem *p))
{
  steif_problem p;
  const int found = find_problem(call, call->word[0], &p);
  if (found) return found;
  const int code = work(call, &p);
  steif_problem_clear(call->ctx, &p);
  return code;
}

static int exact(struct call *call, const steif_problem *p, double t, struct point *q)
{
  q->y = N_VNew_Serial(p->n, steif_sundials(call->ctx));
  q->yp = N_VNew_Serial(p->n, steif_sundials(call->ctx));
  if (!q->y || !q->yp) return no_memory(call, "the solution", "give the process more");
  if (p->exact(t, q->y, q->yp, p->user)) {
    say(call, "the exact solution of '%s' is not known at t = %g [STEIF_UNSUPPORTED]", p->name,
        t);
    return EXIT_FAILED;
  }
  q->at.y = N_VGetArrayPointer(q->y);
  q->at.yp = N_VGetArrayPointer(q->yp);
  return EXIT_OK;
}

static int computed(struct call *call, const steif_problem *p, double t, struct point *q)
{
  steif_options o = steif_defaults();
  o.rtol = 1e-8;
  o.t1 = t;
  q->solver = steif_solver_new(call->ctx, p, "radau:s=3", &o);
  if (!q->solver || steif_solve_to(q->solver, t) != STEIF_OK) return fail(call);
  q->at.y = N_VGetArrayPointer(steif_solution(q->solver));
  return EXIT_OK;
}

int point_open(struct call *call, const steif_problem *p, double t, struct point *q)
{
  *q = (struct point){.at = {.t = t}};
  return p->exact ? exact(call, p, t, q) : computed(call, p, t, q);
}

void point_close(struct point *q)
{
  if (q->y) N_VDestroy(q->y);
  if (q->yp) N_VDestroy(q->yp);
  steif_solver_free(&q->solver);
}
