/* counting.c: equations against unknowns, by a maximum matching: what nothing determines, and which
 * equations are too many (A. L. Dulmage, N. S. Mendelsohn, Canad. J. Math. 10, 1958).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matching.h"
#include "model.h"
#include <stdio.h>
#include <string.h>

enum { LARGEST = 200000 }; /* unknowns; beyond it the numbers alone are told */

typedef struct sides {
  stf_model *m;
  int32_t count;                 /* equations */
  const stf_equation **equation; /* of each, with its pass */
  size_t *from;                  /* count + 1: its unknowns in `unknown` */
  stf_vector unknown;            /* int32_t */
  int32_t *last;                 /* 1 + the last equation that has listed an unknown */
  stf_graph graph;
  unsigned char *reached; /* columns of the graph, or of the transposed one */
} sides;

static int32_t *unknown(const sides *s, size_t i) { return STF_AT(s->unknown, int32_t, i); }

static int leaves(sides *s, stf_block *block, const stf_equation *e, int64_t pass)
{
  stf_model *m = s->m;
  STEIF_TRY(stf_reach(&block->graph, e->residual, &m->sweep.mark, &m->sweep.list));
  for (size_t i = 0; i < m->sweep.list.count; i++) {
    const stf_node *n = stf_node_at(&block->graph, *STF_AT(m->sweep.list, int32_t, i));
    if (n->kind != STF_OP_STATE && n->kind != STF_OP_SLOPE) continue;
    const int32_t stride[STF_LOOPS] = {n->b, n->stride[0], n->stride[1]};
    int32_t *to = stf_vector_push(m->ctx, &s->unknown, sizeof *to);
    if (!to) return STEIF_NO_MEMORY;
    *to = stf_at_pass(&block->box, pass, n->a, stride);
  }
  return STEIF_OK;
}

static int collect(sides *s)
{
  int32_t next = 0;
  for (size_t i = 0; i < s->m->blocks.count; i++) {
    stf_block *block = *STF_AT(s->m->blocks, stf_block *, i);
    const int64_t passes = stf_passes(&block->box);
    for (int64_t pass = 0; pass < passes; pass++)
      for (size_t k = 0; k < block->equations.count; k++) {
        const stf_equation *e = STF_AT(block->equations, stf_equation, k);
        s->equation[next] = e;
        STEIF_TRY(leaves(s, block, e, pass));
        s->from[++next] = s->unknown.count;
      }
  }
  return STEIF_OK;
}

/* Columns of the graph are equations, rows are unknowns: those that free equations reach by alternating
 * paths are too many; transposed, they are the unknowns that nothing determines. */
static int match(sides *s, stf_pool *pool)
{
  const sunindextype n = s->count > s->m->n ? s->count : s->m->n;
  stf_graph *g = &s->graph;
  STEIF_TRY(stf_graph_allocate(pool, n, (sunindextype)s->unknown.count, g));
  for (sunindextype e = 0; e < n; e++) {
    sunindextype to = g->ptr[e];
    for (size_t i = e < s->count ? s->from[e] : 0; e < s->count && i < s->from[e + 1]; i++) {
      const int32_t u = *unknown(s, i);
      if (s->last[u] == e + 1) continue; /* x and x' of one equation are one edge */
      s->last[u] = (int32_t)e + 1;
      g->row[to++] = u;
    }
    g->ptr[e + 1] = to;
  }
  sunindextype rank;
  return stf_graph_match(pool, g, &rank);
}

/* ---- sentences ------------------------------------------------------------------------------- */

static int line_of_equation(const sides *s, int32_t e)
{
  return s->equation[e]->statement < 0
           ? 0
           : (int)stf_statement_at(s->m, s->equation[e]->statement)->line;
}

static int line_of_unknown(const sides *s, int32_t u)
{
  return (int)stf_statement_at(s->m, stf_symbol_at(s->m, s->m->owner[u])->statement)->line;
}

static void name(char *text, size_t room, const char *word, int *count)
{
  const size_t used = strlen(text);
  if (++*count <= 6) snprintf(text + used, room - used, "%s'%s'", *count > 1 ? ", " : "", word);
  if (*count == 7) snprintf(text + used, room - used, ", ...");
}

/* The equations that the graph's reached columns are: their lines, their number, and their unknowns. */
static int lines_of(const sides *s, char *lines, size_t room, char *names, size_t names_room,
                    bool *of_them)
{
  int equations = 0, count = 0;
  memset(of_them, 0, (size_t)s->m->n * sizeof *of_them);
  for (int32_t k = 0; k < s->count; k++) {
    if (!s->reached[k]) continue;
    const size_t used = strlen(lines);
    if (++equations <= 8)
      snprintf(lines + used, room - used, "%s%d", equations > 1 ? ", " : "",
               line_of_equation(s, k));
    for (size_t i = s->from[k]; i < s->from[k + 1]; i++) of_them[*unknown(s, i)] = true;
  }
  for (int32_t i = 0; i < s->m->n; i++)
    if (of_them[i]) name(names, names_room, s->m->unknown[i], &count);
  return equations;
}

/* Unknown u has no partner: with it all unknowns that might take its place, the last of which is named. */
static void missing(const sides *s, int32_t u)
{
  stf_model *m = s->m;
  char others[300] = "";
  int count = 0;
  for (int32_t i = 0; i < m->n; i++)
    if (s->reached[i]) u = i;
  for (int32_t i = 0; i < m->n; i++)
    if (i != u && s->reached[i]) name(others, sizeof others, m->unknown[i], &count);
  stf_complain(&m->syntax.sources, STF_NOWHERE, STEIF_BAD_INPUT,
               "%d equation%s for %d unknowns: nothing determines '%s' (line %d)%s%s%s; add an "
               "equation that "
               "contains it or remove it",
               (int)s->count, s->count == 1 ? "" : "s", (int)m->n, m->unknown[u],
               line_of_unknown(s, u), count ? ", or else one of " : "", others,
               count ? " that share its equations" : "");
}

/* An equation has no partner, nor has unknown u if that is not negative. */
static void surplus(const sides *s, int32_t u, bool *of_them)
{
  stf_model *m = s->m;
  char lines[200] = "", names[300] = "";
  const int equations = lines_of(s, lines, sizeof lines, names, sizeof names, of_them);
  const char *only = *names ? names : "no unknown";
  if (u < 0)
    stf_complain(
      &m->syntax.sources, STF_NOWHERE, STEIF_BAD_INPUT,
      "%d equations for %d unknowns: those of lines %s determine only %s; one of the "
      "%d is too many",
      (int)s->count, (int)m->n, lines, only, equations);
  else
    stf_complain(&m->syntax.sources, STF_NOWHERE, STEIF_BAD_INPUT,
                 "no matching: the equations of lines %s contain %s only, nothing determines "
                 "'%s' (line %d)",
                 lines, only, m->unknown[u], line_of_unknown(s, u));
}

static int tell(sides *s, stf_pool *pool)
{
  const stf_graph *g = &s->graph;
  int32_t e = 0, u = 0;
  while (e < s->count && g->row_of[e] >= 0) e++;
  while (u < s->m->n && g->column_of[u] >= 0) u++;
  if (u < s->m->n && s->count < s->m->n) {
    stf_graph t;
    STEIF_TRY(stf_graph_transpose(pool, g, &t));
    STEIF_TRY(stf_graph_reach_from(pool, &t, u, s->reached));
    missing(s, u);
  } else if (e < s->count) {
    bool *of_them = stf_pool_array(pool, (size_t)s->m->n, sizeof *of_them);
    if (!of_them) return STEIF_NO_MEMORY;
    STEIF_TRY(stf_graph_reach_from(pool, g, e, s->reached));
    surplus(s, u < s->m->n ? u : -1, of_them);
  }
  return STEIF_OK;
}

/* ---- rows of arrays that no loop gives --------------------------------------------------------- */

static bool has_element(const stf_model *m, const stf_expression *e, int32_t word)
{
  for (uint32_t k = e->from; k < e->to; k++) {
    const stf_code *c = STF_AT(m->syntax.codes, stf_code, k);
    if (c->kind == STF_OP_ELEMENT && c->b == word) return true;
  }
  return false;
}

/* "; the loop of line 7 runs from 2 to 99" of the one loop that has the array on its left; "" where there are others. */
static void loop_of(stf_model *m, int32_t word, char *text, size_t room)
{
  int found = 0;
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    double low, high;
    if (s->kind != STF_SAY_EQUATION || s->parent < 0 || !has_element(m, &s->value, word))
      continue;
    const stf_statement *loop = stf_statement_at(m, s->parent);
    *text = 0;
    if (loop->kind != STF_SAY_FOR || loop->parent >= 0 || found++ ||
        stf_number_of(m, &loop->range[0].low, &low) ||
        stf_number_of(m, &loop->range[0].high, &high))
      return;
    snprintf(text, room, "; the loop of line %d runs from %.0f to %.0f", (int)loop->line, low,
             high);
  }
}

/* Elements without an equation, where all other equations are explicit; false: something else. */
static bool missing_rows(stf_model *m, const int32_t *taken_by, int64_t missing_count)
{
  char names[300] = "", loop[80] = "";
  int64_t found = 0;
  int count = 0, line = 0;
  int32_t word = -1;
  for (int32_t i = 0; i < m->n; i++) {
    if (taken_by[i]) continue;
    const stf_symbol *s = stf_symbol_at(m, m->owner[i]);
    if (!s->dims) return false;
    const size_t used = strlen(names);
    if (++count <= 6)
      snprintf(names + used, sizeof names - used, "%s%s", count > 1 ? ", " : "", m->unknown[i]);
    if (count == 7) snprintf(names + used, sizeof names - used, ", ...");
    line = (int)stf_statement_at(m, s->statement)->line;
    word = s->word;
    found++;
  }
  if (found != missing_count) return false;
  loop_of(m, word, loop, sizeof loop);
  stf_complain(&m->syntax.sources, STF_NOWHERE, STEIF_BAD_INPUT,
               "no equation for %s (declared in line %d%s)", names, line, loop);
  return true;
}

static int64_t total(const stf_model *m)
{
  int64_t count = 0;
  for (size_t i = 0; i < m->blocks.count; i++) {
    const stf_block *block = *STF_AT(m->blocks, stf_block *, i);
    count += stf_passes(&block->box) * (int64_t)block->equations.count;
  }
  return count;
}

static int compare(stf_model *m, int64_t count)
{
  const size_t n = (size_t)m->n, rows = (size_t)count;
  stf_pool *pool = stf_pool_new(m->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  sides s = {.m = m, .count = (int32_t)count};
  s.equation = stf_pool_array(pool, rows, sizeof *s.equation);
  s.from = stf_pool_array(pool, rows + 1, sizeof *s.from);
  s.last = stf_pool_array(pool, n, sizeof *s.last);
  s.reached = stf_pool_array(pool, n > rows ? n : rows, 1);
  int code = s.equation && s.from && s.last && s.reached ? collect(&s) : STEIF_NO_MEMORY;
  if (!code) code = match(&s, pool);
  if (!code) code = tell(&s, pool);
  stf_vector_free(m->ctx, &s.unknown);
  stf_pool_free(&pool);
  return code;
}

int stf_count_equations(stf_model *m, const int32_t *taken_by)
{
  const int64_t count = total(m);
  if (count < m->n && missing_rows(m, taken_by, m->n - count)) return STEIF_OK;
  bool rows = count == m->n;
  for (int32_t i = 0; rows && i < m->n; i++) rows = taken_by[i];
  if (rows) return STEIF_OK; /* each has a derivative of its own */
  if (m->n <= LARGEST && count <= LARGEST) return compare(m, count);
  if (count == m->n) return STEIF_OK;
  return stf_complain(&m->syntax.sources, STF_NOWHERE, STEIF_BAD_INPUT,
                      "%lld equations for %d unknowns; %s", (long long)count, (int)m->n,
                      count < m->n ? "add one for each that is missing"
                                   : "remove what is too much");
}
