/* counting.c: equations against unknowns, by a maximum matching: what nothing determines, and which
 * equations are too many (A. L. Dulmage, N. S. Mendelsohn, Canad. J. Math. 10, 1958).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <stdio.h>
#include <string.h>

enum { LARGEST = 3000 }; /* unknowns; beyond it the numbers alone are told */

typedef struct sides {
  stf_model *m;
  int32_t count;                     /* equations */
  const stf_equation **equation;     /* of each, with its pass */
  size_t *from;                      /* count + 1: its unknowns in `unknown` */
  stf_vector unknown;                /* int32_t */
  int32_t *of_unknown, *of_equation; /* 1 + partner, 0: none */
  uint8_t *seen, *reached;           /* equations; unknowns */
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

/* An alternating path from equation e to a free unknown. */
static bool augment(sides *s, int32_t e)
{
  s->seen[e] = 1;
  for (size_t i = s->from[e]; i < s->from[e + 1]; i++) {
    const int32_t u = *unknown(s, i), other = s->of_unknown[u] - 1;
    if (other >= 0 && (s->seen[other] || !augment(s, other))) continue;
    s->of_unknown[u] = e + 1;
    s->of_equation[e] = u + 1;
    return true;
  }
  return false;
}

static void match(sides *s)
{
  for (int32_t e = 0; e < s->count; e++) {
    memset(s->seen, 0, (size_t)s->count);
    augment(s, e);
  }
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

/* Unknown u has no partner: with it all unknowns that might take its place. */
static void missing(sides *s, int32_t u)
{
  stf_model *m = s->m;
  char others[300] = "";
  int count = 0;
  bool changed = true;
  memset(s->reached, 0, (size_t)m->n);
  s->reached[u] = 1;
  while (changed) {
    changed = false;
    for (int32_t e = 0; e < s->count; e++) {
      const int32_t own = s->of_equation[e] - 1;
      bool contains = false;
      for (size_t i = s->from[e]; i < s->from[e + 1]; i++)
        contains = contains || s->reached[*unknown(s, i)];
      if (!contains || own < 0 || s->reached[own]) continue;
      s->reached[own] = 1;
      changed = true;
    }
  }
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

/* Equation e has no partner: with it all that share its unknowns. */
static void surplus(sides *s, int32_t e)
{
  stf_model *m = s->m;
  char lines[200] = "", names[300] = "";
  int count = 0, equations = 0;
  memset(s->seen, 0, (size_t)s->count);
  memset(s->reached, 0, (size_t)m->n);
  augment(s, e); /* marks what alternating paths reach */
  for (int32_t k = 0; k < s->count; k++) {
    if (!s->seen[k]) continue;
    const size_t used = strlen(lines);
    if (++equations <= 8)
      snprintf(lines + used, sizeof lines - used, "%s%d", equations > 1 ? ", " : "",
               line_of_equation(s, k));
    for (size_t i = s->from[k]; i < s->from[k + 1]; i++) s->reached[*unknown(s, i)] = 1;
  }
  for (int32_t i = 0; i < m->n; i++)
    if (s->reached[i]) name(names, sizeof names, m->unknown[i], &count);
  stf_complain(&m->syntax.sources, STF_NOWHERE, STEIF_BAD_INPUT,
               "%d equations for %d unknowns: those of lines %s determine only %s; one of the "
               "%d is too many",
               (int)s->count, (int)m->n, lines, *names ? names : "no unknown", equations);
}

/* As many equations as unknowns, and still no matching. */
static void singular(sides *s, int32_t e, int32_t u)
{
  stf_model *m = s->m;
  char lines[200] = "", names[300] = "";
  int count = 0, equations = 0;
  memset(s->seen, 0, (size_t)s->count);
  memset(s->reached, 0, (size_t)m->n);
  augment(s, e);
  for (int32_t k = 0; k < s->count; k++) {
    if (!s->seen[k]) continue;
    const size_t used = strlen(lines);
    if (++equations <= 8)
      snprintf(lines + used, sizeof lines - used, "%s%d", equations > 1 ? ", " : "",
               line_of_equation(s, k));
    for (size_t i = s->from[k]; i < s->from[k + 1]; i++) s->reached[*unknown(s, i)] = 1;
  }
  for (int32_t i = 0; i < m->n; i++)
    if (s->reached[i]) name(names, sizeof names, m->unknown[i], &count);
  stf_complain(
    &m->syntax.sources, STF_NOWHERE, STEIF_BAD_INPUT,
    "no matching: the equations of lines %s contain %s only, nothing determines '%s' (line %d)",
    lines, *names ? names : "no unknown", m->unknown[u], line_of_unknown(s, u));
}

static void tell(sides *s)
{
  int32_t e = 0, u = 0;
  while (e < s->count && s->of_equation[e]) e++;
  while (u < s->m->n && s->of_unknown[u]) u++;
  if (u < s->m->n && s->count < s->m->n)
    missing(s, u);
  else if (e < s->count && u < s->m->n)
    singular(s, e, u);
  else if (e < s->count)
    surplus(s, e);
}

/* ---- rows of arrays that no loop gives --------------------------------------------------------- */

/* Elements without an equation, where all other equations are explicit; false: something else. */
static bool missing_rows(stf_model *m, const int32_t *taken_by, int64_t missing_count)
{
  char names[300] = "";
  int64_t found = 0;
  int count = 0, line = 0;
  for (int32_t i = 0; i < m->n; i++) {
    if (taken_by[i]) continue;
    const stf_symbol *s = stf_symbol_at(m, m->owner[i]);
    if (!s->dims) return false;
    const size_t used = strlen(names);
    if (++count <= 6)
      snprintf(names + used, sizeof names - used, "%s%s", count > 1 ? ", " : "", m->unknown[i]);
    if (count == 7) snprintf(names + used, sizeof names - used, ", ...");
    line = (int)stf_statement_at(m, s->statement)->line;
    found++;
  }
  if (found != missing_count) return false;
  stf_complain(&m->syntax.sources, STF_NOWHERE, STEIF_BAD_INPUT,
               "no equation for %s (declared in line %d)", names, line);
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
  s.of_unknown = stf_pool_array(pool, n, sizeof *s.of_unknown);
  s.of_equation = stf_pool_array(pool, rows, sizeof *s.of_equation);
  s.seen = stf_pool_array(pool, rows, 1);
  s.reached = stf_pool_array(pool, n, 1);
  int code = s.equation && s.from && s.of_unknown && s.of_equation && s.seen && s.reached
               ? collect(&s)
               : STEIF_NO_MEMORY;
  if (!code) {
    match(&s);
    tell(&s);
  }
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
