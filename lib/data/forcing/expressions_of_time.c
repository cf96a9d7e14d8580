/* expressions_of_time.c: expressions in t, by the reader of models: one graph of nodes for all of them, and the
 * Taylor series of each. SPDX-License-Identifier: BSD-3-Clause */
#include "forcing.h"
#include "model_file.h"
#include "reader.h"
#include "text.h"
#include <math.h>
#include <string.h>

/* ---- words ----------------------------------------------------------------------------------- */

static int unknown(stf_model *m, uint32_t at, const char *name)
{
  const char *known[STF_OP_KINDS] = {"t", "pi"};
  char room[3 * STEIF_SPEC_WORD], guess[STF_GUESS];
  const size_t count = 2 + stf_function_words(known + 2);
  const char *here = stf_elsewhere(m, name, room, sizeof room);
  if (here) return stf_complain(&m->syntax.sources, at, STEIF_UNKNOWN_NAME, "%s", here);
  return stf_complain(&m->syntax.sources, at, STEIF_UNKNOWN_NAME, "unknown name '%s'%s", name,
                      stf_guess(name, known, count, sizeof *known, guess));
}

/* Only t, pi, the functions and the indices of sums are known here. */
static int check(stf_model *m, const stf_expression *e)
{
  for (uint32_t i = e->from; i < e->to; i++) {
    const stf_code *c = STF_AT(m->syntax.codes, stf_code, i);
    const int32_t word = c->kind == STF_OP_ELEMENT ? c->b : c->a;
    const bool names = c->kind == STF_OP_NAME || c->kind == STF_OP_ELEMENT;
    int wanted = 0;
    if (c->kind == STF_OP_CALL && stf_function_of(stf_named(m, word), &wanted) < 0)
      return unknown(m, c->at, stf_named(m, word));
    if (c->kind == STF_OP_CALL && c->b != wanted)
      return stf_complain(&m->syntax.sources, c->at, STEIF_BAD_INPUT,
                          "'%s' takes %d argument%s, got %d", stf_named(m, word), wanted,
                          wanted == 1 ? "" : "s", c->b);
    if (names && word >= STF_WORDS_RESERVED && !stf_summed(m, e, word))
      return unknown(m, c->at, stf_named(m, word));
  }
  return STEIF_OK;
}

/* ---- reading --------------------------------------------------------------------------------- */

/* The text with a line for each expression: those of a text end with ';'. */
static int take(steif_function *f, const char *path, const char *text)
{
  stf_model *m = f->expressions->model;
  const size_t length = strlen(text);
  STEIF_CHECK(length <= STF_LARGEST_TEXT, f->ctx, STEIF_BAD_INPUT,
              "%s: %zu bytes of expressions; %d are the most", path ? path : "the text", length,
              STF_LARGEST_TEXT);
  stf_text *to = stf_vector_push(f->ctx, &m->syntax.sources.texts, sizeof *to);
  char *copy = to ? stf_pool_array(m->pool, length + 1, 1) : NULL;
  if (!copy) return STEIF_NO_MEMORY;
  *to = (stf_text){path, strcpy(copy, text), 0, (uint32_t)length};
  for (size_t i = 0; i < length && !path; i++)
    copy[i] = copy[i] == ';' ? '\n' : copy[i] == '\n' ? ' ' : copy[i];
  return STEIF_OK;
}

/* The next line: 1, or 0 where it is blank and may be; of a text only the last is. */
static int next_line(stf_lexer *l, stf_vector *tokens, bool blanks)
{
  tokens->count = 0;
  STEIF_TRY(stf_lex_line(l));
  if (l->sources->errors) return l->sources->code;
  return STF_AT(*tokens, stf_token, 0)->kind != STF_TOKEN_END || (!blanks && !l->ended);
}

/* One expression of a line, as a node among the roots. */
static int expression(steif_function *f, stf_builder *b)
{
  stf_expressions *x = f->expressions;
  stf_model *m = x->model;
  stf_parser p = {.syntax = &m->syntax};
  stf_expression e;
  int32_t node;
  const int line = (int)stf_next(&p)->line;
  STEIF_CHECK(x->roots.count < (size_t)f->inputs, f->ctx, STEIF_BAD_INPUT,
              "%s, %s %d: more than %lld expressions; give one for each component",
              x->lines ? STF_AT(m->syntax.sources.texts, stf_text, 0)->name : "the text",
              x->lines ? "line" : "expression", line, (long long)f->inputs);
  STEIF_TRY(stf_parse_number(&p, &e));
  if (stf_next(&p)->kind != STF_TOKEN_END)
    return stf_expected(&p, "an operator or the end of the expression");
  STEIF_TRY(check(m, &e));
  STEIF_TRY(stf_build(b, &e, &node));
  int32_t *to = stf_vector_push(f->ctx, &x->roots, sizeof *to);
  if (!to) return STEIF_NO_MEMORY;
  *to = node;
  return STEIF_OK;
}

static int all_lines(steif_function *f, stf_builder *b)
{
  stf_expressions *x = f->expressions;
  stf_model *m = x->model;
  stf_sources *s = &m->syntax.sources;
  stf_lexer l;
  uint32_t last = 0;
  STEIF_TRY(stf_lex_open(&l, s, 0, &m->syntax.words, &m->syntax.tokens));
  l.single = true;
  while (!l.ended) {
    const int given = next_line(&l, &m->syntax.tokens, x->lines);
    if (given < 0 || s->errors) return given;
    if (!given) continue;
    STEIF_TRY(expression(f, b));
    last = STF_AT(m->syntax.tokens, stf_token, 0)->line;
  }
  if (x->lines) last = l.length ? l.line - (l.text[l.length - 1] == '\n') : 0;
  STEIF_CHECK(x->roots.count == (size_t)f->inputs, f->ctx, STEIF_BAD_INPUT,
              "%s ends at %s %u after %zu of %lld expressions; give one for each component",
              x->lines ? STF_AT(s->texts, stf_text, 0)->name : "the text",
              x->lines ? "line" : "expression", last, x->roots.count, (long long)f->inputs);
  return STEIF_OK;
}

/* ---- what is computed ------------------------------------------------------------------------ */

/* A number of the text that is none, such as 1/0. */
static int check_numbers(steif_function *f, const stf_vector *list)
{
  stf_expressions *x = f->expressions;
  for (size_t i = 0; i < list->count; i++) {
    const stf_node *n = stf_node_at(&x->graph, *STF_AT(*list, int32_t, i));
    if (n->kind != STF_OP_NUMBER || isfinite(n->number)) continue;
    return stf_complain(&x->model->syntax.sources, n->at, STEIF_NOT_FINITE,
                        "a constant that is not finite, %g", n->number);
  }
  return STEIF_OK;
}

static int list_nodes(steif_function *f)
{
  stf_expressions *x = f->expressions;
  stf_sweep *sweep = &x->model->sweep;
  size_t longest = 0;
  x->from = stf_pool_array(f->pool, x->roots.count + 1, sizeof *x->from);
  x->at = stf_pool_array(f->pool, x->graph.nodes.count, sizeof *x->at);
  if (!x->from || !x->at) return STEIF_NO_MEMORY;
  for (size_t k = 0; k < x->roots.count; k++) {
    STEIF_TRY(stf_reach(&x->graph, *STF_AT(x->roots, int32_t, k), &sweep->mark, &sweep->list));
    STEIF_TRY(check_numbers(f, &sweep->list));
    const size_t count = sweep->list.count, from = x->lists.count;
    STEIF_TRY(stf_vector_resize(f->ctx, &x->lists, from + count, sizeof(int32_t)));
    memcpy(STF_AT(x->lists, int32_t, from), sweep->list.data, count * sizeof(int32_t));
    x->from[k] = from, x->from[k + 1] = from + count;
    if (count > longest) longest = count;
  }
  x->series = stf_pool_array(f->pool, longest + 4, sizeof *x->series);
  x->value = stf_pool_array(f->pool, longest, sizeof *x->value);
  return x->series && x->value ? STEIF_OK : STEIF_NO_MEMORY;
}

static int build(steif_function *f)
{
  stf_expressions *x = f->expressions;
  stf_block block = {0};
  stf_builder b;
  int code = stf_builder_open(&b, x->model, &x->graph, false);
  b.events = b.clock = true;
  b.block = &block;
  if (!code) code = all_lines(f, &b);
  if (!code && b.turns.count) {
    const size_t count = x->roots.count;
    code = stf_vector_resize(f->ctx, &x->roots, count + b.turns.count, sizeof(int32_t));
    if (!code)
      memcpy(STF_AT(x->roots, int32_t, count), b.turns.data, b.turns.count * sizeof(int32_t));
  }
  stf_builder_close(&b);
  return code ? code : list_nodes(f);
}

int stf_expressions_read(steif_function *f, const char *path, const char *text)
{
  stf_expressions *x = f->expressions = stf_pool_array(f->pool, 1, sizeof *x);
  if (!x) return STEIF_NO_MEMORY;
  x->lines = path != NULL;
  x->graph.ctx = f->ctx;
  STEIF_TRY(stf_model_new(f->ctx, &x->model));
  x->model->syntax.pool = x->model->pool;
  x->model->syntax.sources.alone = true, x->model->syntax.sources.pieces = !path;
  STEIF_TRY(take(f, path, text));
  const int code = build(f);
  return x->model->syntax.sources.errors ? stf_complaints(&x->model->syntax.sources) : code;
}

void stf_expressions_free(steif_function *f)
{
  stf_expressions *x = f->expressions;
  if (!x) return;
  stf_vector_free(f->ctx, &x->roots);
  stf_vector_free(f->ctx, &x->lists);
  stf_formulas_free(&x->graph);
  if (x->model) stf_model_free(x->model);
}

/* Its value; not finite where there is none. */
static sunrealtype value_of(const stf_expressions *x, size_t root, sunrealtype t)
{
  const int32_t *list = STF_AT(x->lists, int32_t, x->from[root]);
  const size_t count = x->from[root + 1] - x->from[root];
  int32_t child[3] = {0, 0, 0};
  double operand[3] = {0, 0, 0};
  for (size_t i = 0; i < count; i++) {
    const stf_node *n = stf_node_at(&x->graph, list[i]);
    const int operands = stf_children(n, child);
    for (int k = 0; k < operands; k++) operand[k] = x->value[x->at[child[k]]];
    x->at[list[i]] = (int32_t)i;
    x->value[i] = n->kind == STF_OP_NUMBER ? n->number
                  : n->kind == STF_OP_TIME
                    ? t
                    : stf_operate(n->kind, operand[0], operand[1], operand[2]);
  }
  return x->value[count - 1];
}

int stf_expressions_series(steif_function *f, size_t root, sunrealtype t, int order,
                           const sunrealtype **c)
{
  stf_expressions *x = f->expressions;
  const stf_feed feed = {.t = t};
  const size_t from = x->from[root], count = x->from[root + 1] - from;
  const int32_t *list = STF_AT(x->lists, int32_t, from);
  int32_t wrong = list[count - 1];
  if (order == 0) {
    *x->series->c = value_of(x, root, t);
    *c = x->series->c;
    if (isfinite(**c)) return STEIF_OK;
  }
  const char *why =
    stf_series_run(&x->graph, list, count, &feed, NULL, NULL, order, x->at, x->series, &wrong);
  *c = x->series[count - 1].c;
  bool finite = true;
  for (int k = 0; k <= order; k++) finite = finite && isfinite((*c)[k]);
  if (finite) return STEIF_OK;
  char place[256];
  return STEIF_RECOVER(f->ctx, STEIF_NOT_FINITE,
                       "%s: %s at t = %g, derivative %d; keep t out of there",
                       stf_place_text(&x->model->syntax.sources,
                                      stf_node_at(&x->graph, wrong)->at, place, sizeof place),
                       why ? why : "a result that is not finite", t, order);
}
