/* impulse_slopes.c: derivatives of x(0+) and impulses by the words of --slopes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse.h"
#include <ctype.h>
#include <stdlib.h>
#include <steif/slopes.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { WORD_ROOM = 128 };

/* One word: NAME of a parameter, E:i:j, F:i:j, x0:i, f:i or f:i:q. */
typedef struct asked {
  const struct descriptor *l;
  char word[WORD_ROOM];
  steif_impulse_direction along;
  bool of_problem; /* the direction is the library's */
  double *x0;
  long equation;  /* of f, from 0 */
  int derivative; /* of f */
} asked;

static const char words_are[] = "--slopes takes parameters, E:i:j and F:i:j, x0:i, f:i, and "
                                "f:i:q for the q-th derivative of f "
                                "at the jump";

/* A unit in one derivative of one equation. */
static int unit_force(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const asked *a = user;
  (void)t;
  N_VConst(0, g);
  if (derivative == a->derivative) N_VGetArrayPointer(g)[a->equation] = 1;
  return 0;
}

/* A number from 1, or a name; -1: neither, said. */
static long place_of(const struct call *call, const asked *a, const char *text, bool equation)
{
  const steif_names *names = a->l->names;
  const char *const *name = !names ? NULL : equation ? names->equation : names->unknown;
  char *end;
  const long i = strtol(text, &end, 10);
  if (end > text && !*end && i >= 1 && i <= (long)a->l->n) return i - 1;
  for (long k = 0; name && k < (long)a->l->n; k++)
    if (!strcmp(name[k], text)) return k;
  bad_usage(call, "\"%s\" in --slopes is no %s from 1 to %ld%s; %s", text,
            equation ? "equation" : "unknown", (long)a->l->n,
            name ? " and none of their names" : "", words_are);
  return -1;
}

static int entry(struct call *call, asked *a, SUNMatrix *M, const char *row, const char *column)
{
  const long i = place_of(call, a, row, true),
             j = i < 0 ? -1 : place_of(call, a, column, false);
  if (j < 0) return EXIT_USAGE;
  SUNMatrix one = *M = SUNSparseMatrix(a->l->n, a->l->n, 1, CSC_MAT, steif_sundials(call->ctx));
  if (!one) return no_memory(call, "a matrix", "give the process more");
  SM_INDEXVALS_S(one)[0] = i, SM_DATA_S(one)[0] = 1;
  for (long k = 0; k <= (long)a->l->n; k++) SM_INDEXPTRS_S(one)[k] = k > j;
  a->along.straight = 1;
  return EXIT_OK;
}

static int data(struct call *call, asked *a, bool start, const char *where, const char *order)
{
  const long i = place_of(call, a, where, !start);
  if (i < 0) return EXIT_USAGE;
  if (!start) {
    char *end = NULL;
    const long q = order ? strtol(order, &end, 10) : 0;
    if (q < 0 || q > 99 || (order && (end == order || *end)))
      return bad_usage(call, "\"%s\" in --slopes is no order of a derivative; %s", order,
                       words_are);
    a->equation = i, a->derivative = (int)q;
    a->along.f = unit_force, a->along.user = a;
    return EXIT_OK;
  }
  a->x0 = calloc((size_t)a->l->n, sizeof *a->x0);
  if (!a->x0) return no_memory(call, "a start", "give the process more");
  a->x0[i] = 1;
  a->along.x0 = a->x0;
  return EXIT_OK;
}

static int parameter(struct call *call, asked *a)
{
  const steif_problem *p = &a->l->problem;
  if (!p->name || !p->parameters)
    return bad_usage(call, "\"%s\" in --slopes is a parameter, and %s has none; %s", a->word,
                     call->word[0], words_are);
  const int k = steif_parameter_find(call->ctx, p, a->word);
  if (k < 0) return fail(call);
  if (steif_impulse_direction_of(call->ctx, p, k, &a->along)) return fail(call);
  a->of_problem = true;
  if (given(call, "--x0")) a->along.x0 = NULL; /* then it is what it is */
  if (a->l->function) a->along.f = NULL;
  return EXIT_OK;
}

static int read_word(struct call *call, asked *a)
{
  char text[WORD_ROOM], *part[4] = {text, NULL, NULL, NULL};
  int count = 1;
  memcpy(text, a->word, sizeof text);
  for (char *at = text; *at; at++)
    if (*at == ':' && count < 4) *at = 0, part[count++] = at + 1;
  const bool matrix = !strcmp(text, "E") || !strcmp(text, "F");
  if (count == 3 && matrix)
    return entry(call, a, *text == 'E' ? &a->along.E : &a->along.F, part[1], part[2]);
  if (count == 2 && !strcmp(text, "x0")) return data(call, a, true, part[1], NULL);
  if ((count == 2 || count == 3) && !strcmp(text, "f"))
    return data(call, a, false, part[1], part[2]);
  if (count == 1) return parameter(call, a);
  return bad_usage(call, "\"%s\" cannot be understood: %s", a->word, words_are);
}

static void close_word(struct call *call, asked *a)
{
  if (a->of_problem) {
    steif_impulse_direction_clear(call->ctx, &a->along);
  } else {
    if (a->along.E) SUNMatDestroy(a->along.E);
    if (a->along.F) SUNMatDestroy(a->along.F);
  }
  free(a->x0);
}

static void tell(steif_report *r, const char *word, const steif_impulse_slope *s)
{
  char key[WORD_ROOM + 32];
  const size_t n = (size_t)s->n;
#define KEY(name) (snprintf(key, sizeof key, "d_%s." name, word), key)
  steif_report_text(r, KEY("exists"), s->exists > 0 ? "yes" : s->exists ? "undecided" : "no");
  if (s->exists) steif_report_list(r, KEY("x_plus"), n, s->x_plus);
  if (s->exists) steif_report_matrix(r, KEY("impulses"), (size_t)s->count, n, s->c);
  if (s->exists) steif_report_real(r, KEY("estimate"), s->estimate);
  steif_report_truth(r, KEY("certified"), s->certified);
  steif_report_text(r, KEY("message"), s->message);
#undef KEY
}

static int answer(struct call *call, const struct descriptor *l, const steif_structure *s,
                  asked *a, steif_report *r, bool *undecided)
{
  steif_impulse_slope slope;
  const steif_analysis analysis = descriptor_analysis(call, l);
  int code = read_word(call, a);
  if (!code && steif_impulse_slope_find(call->ctx, &l->system, l->x0, l->t0, &analysis, s,
                                        &a->along, &slope))
    code = descriptor_fail(call);
  else if (!code) {
    tell(r, a->word, &slope);
    *undecided = *undecided || slope.exists < 0;
    if (slope.exists < 0) say(call, "%s: %s [STEIF_NOT_CERTIFIED]", a->word, slope.message);
    steif_impulse_slope_clear(call->ctx, &slope);
  }
  close_word(call, a);
  return code;
}

int report_slopes(struct call *call, const struct descriptor *l, const steif_structure *s,
                  steif_report *r, bool *undecided)
{
  int code = EXIT_OK;
  for (const char *at = word_of(call, "--slopes"); !code && *at;) {
    const size_t length = strcspn(at, ",");
    asked a = {.l = l};
    if (!length || length >= sizeof a.word)
      return bad_usage(call, "\"%.60s\" in --slopes is no word; %s", at, words_are);
    memcpy(a.word, at, length);
    code = answer(call, l, s, &a, r, undecided);
    at += length + (at[length] == ',');
  }
  return code;
}
