/* matrices.c: tapes of f and of the entries of E and A, with the pattern of the
 * entries by columns. SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <stdlib.h>
#include <string.h>

typedef struct entry {
  size_t block;
  int32_t node;
  const stf_equation *equation;
  int32_t column, stride[STF_LOOPS];
  stf_store place; /* in the values of the matrix */
} entry;

static stf_block *block_at(const stf_model *m, size_t i)
{
  return *STF_AT(m->blocks, stf_block *, i);
}

static int32_t row_of(const stf_box *box, int64_t k, const stf_equation *e)
{
  return e->slot ? e->slot[k] : stf_at_pass(box, k, e->row, e->stride);
}

/* f, with the equations that are not explicit as -residual without derivatives;
 * F is the residual. */
static int values(stf_model *m)
{
  for (size_t i = 0; i < m->blocks.count; i++) {
    stf_block *block = block_at(m, i);
    for (size_t k = 0; k < block->equations.count; k++) {
      stf_equation *e = STF_AT(block->equations, stf_equation, k);
      if (m->form == STEIF_IMPLICIT) e->value = e->residual;
      if (e->value >= 0) continue;
      const int32_t rest = stf_without(&block->graph, e->residual, STF_OP_SLOPE, &m->sweep);
      e->value = rest < 0 ? -1 : stf_apply1(&block->graph, STF_OP_NEGATIVE, rest);
      if (e->value < 0) return STEIF_NO_MEMORY;
    }
  }
  return STEIF_OK;
}

static int build_values(stf_model *m, bool without_states)
{
  stf_vector stores = {0};
  int code = STEIF_OK;
  for (size_t i = 0; !code && i < m->blocks.count; i++) {
    stf_block *block = block_at(m, i);
    stores.count = 0;
    for (size_t k = 0; !code && k < block->equations.count; k++) {
      stf_equation *e = STF_AT(block->equations, stf_equation, k);
      stf_store *s = stf_vector_push(m->ctx, &stores, sizeof *s);
      if (!s) code = STEIF_NO_MEMORY;
      if (code) break;
      *s = (stf_store){.from = e->value, .a = e->row, .slot = e->slot};
      memcpy(s->stride, e->stride, sizeof s->stride);
      if (without_states)
        s->from = stf_without(&block->graph, e->value, STF_OP_STATE, &m->sweep);
      e->forcing = s->from;
      if (s->from < 0) code = STEIF_NO_MEMORY;
    }
    if (!code) code = stf_compile_quantity(m, block, &stores, &m->f);
  }
  stf_vector_free(m->ctx, &stores);
  return code ? code : stf_quantity_close(m, &m->f, m->n);
}

/* ---- entries
 * ---------------------------------------------------------------------------------
 */

static int add(stf_model *m, stf_vector *entries, size_t block, const stf_equation *e,
               int32_t node, int32_t column, const int32_t *stride)
{
  entry *to = node < 0 ? NULL : stf_vector_push(m->ctx, entries, sizeof *to);
  if (!to) return STEIF_NO_MEMORY;
  *to = (entry){.block = block, .node = node, .equation = e, .column = column};
  memcpy(to->stride, stride, sizeof to->stride);
  return STEIF_OK;
}

static int partials(stf_model *m, stf_vector *entries, size_t i, const stf_equation *e,
                    int32_t root, int kind, bool minus)
{
  stf_formulas *g = &block_at(m, i)->graph;
  STEIF_TRY(stf_formulas_differentiate(g, root, kind, &m->sweep, &m->partials));
  for (size_t k = 0; k < m->partials.count; k++) {
    const stf_partial p = *STF_AT(m->partials, stf_partial, k);
    const stf_node leaf = *stf_node_at(g, p.leaf);
    const int32_t stride[STF_LOOPS] = {leaf.b, leaf.stride[0], leaf.stride[1]};
    if (stf_is_number(g, p.value, 0)) continue;
    STEIF_TRY(add(m, entries, i, e, minus ? stf_apply1(g, STF_OP_NEGATIVE, p.value) : p.value,
                  leaf.a, stride));
  }
  return STEIF_OK;
}

/* The entries of E (slopes) or A. */
static int list(stf_model *m, bool slopes, stf_vector *entries)
{
  const bool implicit = m->form == STEIF_IMPLICIT;
  for (size_t i = 0; i < m->blocks.count; i++) {
    const stf_block *block = block_at(m, i);
    for (size_t k = 0; k < block->equations.count; k++) {
      const stf_equation *e = STF_AT(block->equations, stf_equation, k);
      if (!slopes)
        STEIF_TRY(partials(m, entries, i, e, e->value, STF_OP_STATE, implicit));
      else if (e->own && !implicit)
        STEIF_TRY(
          add(m, entries, i, e, stf_number(&block_at(m, i)->graph, 1), e->row, e->stride));
      else
        STEIF_TRY(partials(m, entries, i, e, e->residual, STF_OP_SLOPE, false));
    }
  }
  return STEIF_OK;
}

/* ---- patterns
 * --------------------------------------------------------------------------------
 */

static int ascending(const void *a, const void *b)
{
  const sunindextype x = *(const sunindextype *)a, y = *(const sunindextype *)b;
  return (x > y) - (x < y);
}

/* Columns in `column` are counted, or rows filled in from column[j] on. */
static void scan(const stf_model *m, const stf_vector *entries, sunindextype *column,
                 sunindextype *row)
{
  for (size_t i = 0; i < entries->count; i++) {
    const entry *e = STF_AT(*entries, entry, i);
    const stf_box *box = &block_at(m, e->block)->box;
    const int64_t count = stf_passes(box);
    for (int64_t k = 0; k < count; k++) {
      const int32_t j = stf_at_pass(box, k, e->column, e->stride);
      if (row)
        row[column[j]++] = row_of(box, k, e->equation);
      else
        column[j + 1]++;
    }
  }
}

/* Rows ascend in each column and occur once. */
static void unite(int32_t n, sunindextype *column, sunindextype *row)
{
  sunindextype used = 0, from = 0;
  for (int32_t j = 0; j < n; j++) {
    const sunindextype to = column[j];
    qsort(row + from, (size_t)(to - from), sizeof *row, ascending);
    const sunindextype start = used;
    for (sunindextype k = from; k < to; k++)
      if (used == start || row[used - 1] != row[k]) row[used++] = row[k];
    column[j] = start;
    from = to;
  }
  column[n] = used;
}

static int pattern(stf_model *m, const stf_vector *entries, stf_matrix *M)
{
  int64_t count = 0;
  for (size_t i = 0; i < entries->count; i++)
    count += stf_passes(&block_at(m, STF_AT(*entries, entry, i)->block)->box);
  STEIF_CHECK(count < INT32_MAX, m->ctx, STEIF_UNSUPPORTED,
              "a Jacobian of %lld entries; 2e9 are the most", (long long)count);
  M->column = stf_pool_array(m->pool, (size_t)m->n + 1, sizeof *M->column);
  M->row = stf_pool_array(m->pool, (size_t)count, sizeof *M->row);
  if (!M->column || !M->row) return STEIF_NO_MEMORY;
  scan(m, entries, M->column, NULL);
  for (int32_t j = 0; j < m->n; j++) M->column[j + 1] += M->column[j];
  scan(m, entries, M->column, M->row);
  unite(m->n, M->column, M->row);
  M->entries = M->column[m->n];
  M->scratch = stf_pool_array(m->pool, (size_t)M->entries, sizeof *M->scratch);
  return M->scratch ? STEIF_OK : STEIF_NO_MEMORY;
}

/* Where the entry of each pass is stored. */
static void slots(const stf_model *m, const stf_matrix *M, const entry *e, int32_t *slot)
{
  const stf_box *box = &block_at(m, e->block)->box;
  const int64_t count = stf_passes(box);
  for (int64_t k = 0; k < count; k++) {
    const int32_t j = stf_at_pass(box, k, e->column, e->stride);
    const sunindextype row = row_of(box, k, e->equation), *from = M->row + M->column[j];
    const sunindextype *found =
      bsearch(&row, from, (size_t)(M->column[j + 1] - M->column[j]), sizeof row, ascending);
    slot[k] = (int32_t)(found - M->row);
  }
}

/* Inside a grid they are multiples of the counters, since all columns have as many entries. */
static bool straight(const stf_box *box, const int32_t *slot, stf_store *s)
{
  const int64_t count = stf_passes(box);
  int64_t ahead = 1, a = count ? slot[0] : 0;
  for (int d = box->dims - 1; d >= 0 && count; ahead *= box->count[d--]) {
    s->stride[d] = box->count[d] > 1 ? slot[ahead] - slot[0] : 0;
    a -= (int64_t)s->stride[d] * box->low[d];
  }
  s->a = (int32_t)a;
  if (a < INT32_MIN || a > INT32_MAX) return false;
  for (int64_t k = 0; k < count; k++)
    if (slot[k] != stf_at_pass(box, k, s->a, s->stride)) return false;
  return true;
}

static int keep_slots(stf_model *m, const stf_matrix *M, entry *e, int32_t *slot)
{
  const stf_box *box = &block_at(m, e->block)->box;
  const size_t bytes = (size_t)stf_passes(box) * sizeof *slot;
  slots(m, M, e, slot);
  e->place = (stf_store){.from = e->node};
  if (straight(box, slot, &e->place)) return STEIF_OK;
  int32_t *kept = stf_pool_array(m->pool, (size_t)stf_passes(box), sizeof *kept);
  if (!kept) return STEIF_NO_MEMORY;
  e->place = (stf_store){.from = e->node, .slot = memcpy(kept, slot, bytes)};
  return STEIF_OK;
}

static int all_slots(stf_model *m, const stf_vector *entries, const stf_matrix *M)
{
  int64_t most = 0;
  int code = STEIF_OK;
  for (size_t i = 0; i < entries->count; i++) {
    const int64_t count = stf_passes(&block_at(m, STF_AT(*entries, entry, i)->block)->box);
    if (count > most) most = count;
  }
  int32_t *slot = stf_allocate(m->ctx, (size_t)most + 1, sizeof *slot);
  if (!slot) return STEIF_NO_MEMORY;
  for (size_t i = 0; !code && i < entries->count; i++)
    code = keep_slots(m, M, STF_AT(*entries, entry, i), slot);
  stf_release(m->ctx, slot);
  return code;
}

static int tapes(stf_model *m, const stf_vector *entries, stf_matrix *M)
{
  stf_vector stores = {0};
  int code = all_slots(m, entries, M);
  size_t next = 0;
  for (size_t i = 0; !code && i < m->blocks.count; i++) {
    stores.count = 0;
    for (; !code && next < entries->count && STF_AT(*entries, entry, next)->block == i;
         next++) {
      const entry *e = STF_AT(*entries, entry, next);
      stf_store *s = stf_vector_push(m->ctx, &stores, sizeof *s);
      if (s)
        *s = e->place;
      else
        code = STEIF_NO_MEMORY;
    }
    if (!code) code = stf_compile_quantity(m, block_at(m, i), &stores, &M->quantity);
  }
  stf_vector_free(m->ctx, &stores);
  return code ? code : stf_quantity_close(m, &M->quantity, M->entries);
}

/* What all entries depend on. */
static int dependence(const stf_model *m, const stf_vector *entries)
{
  int on = 0;
  for (size_t i = 0; i < entries->count; i++) {
    const entry *e = STF_AT(*entries, entry, i);
    on |= stf_node_at(&block_at(m, e->block)->graph, e->node)->on;
  }
  return on;
}

/* Does f depend on what events change? */
static bool switched(const stf_model *m)
{
  for (size_t i = 0; i < m->blocks.count; i++) {
    const stf_block *block = block_at(m, i);
    for (size_t k = 0; k < block->equations.count; k++) {
      const stf_equation *e = STF_AT(block->equations, stf_equation, k);
      if (stf_node_at(&block->graph, e->value)->on & STF_ON_MEMORY) return true;
    }
  }
  return false;
}

static int finish(stf_model *m, stf_vector *A, stf_vector *E)
{
  m->linear = m->form != STEIF_IMPLICIT && !m->switches && !m->timers && !switched(m) &&
              !(dependence(m, A) & ~(STF_ON_PARAMETER | STF_ON_PASS));
  const bool descriptor = m->wished ? m->wished == STEIF_DESCRIPTOR : m->form == STEIF_MASS;
  if (m->wished == STEIF_DESCRIPTOR && !m->linear)
    return stf_complain(&m->syntax.sources, STF_NOWHERE, STEIF_BAD_INPUT,
                        "form descriptor needs equations with constant coefficients, linear in "
                        "all unknowns, without events");
  if (m->linear && descriptor) {
    m->form = STEIF_DESCRIPTOR;
    m->why = m->wished ? m->why : "linear with constant coefficients";
  }
  if (m->form == STEIF_ODE) /* nothing is added to the expressions before the tapes are made */
    for (size_t i = 0; i < m->blocks.count; i++)
      STEIF_TRY(stf_formulas_trim(&block_at(m, i)->graph));
  STEIF_TRY(pattern(m, A, &m->A));
  STEIF_TRY(tapes(m, A, &m->A));
  stf_vector_free(m->ctx, A);
  if (m->form == STEIF_ODE) return build_values(m, false);
  STEIF_TRY(list(m, true, E));
  STEIF_TRY(pattern(m, E, &m->E));
  STEIF_TRY(tapes(m, E, &m->E));
  return build_values(m, m->form == STEIF_DESCRIPTOR);
}

int stf_build_tapes(stf_model *m)
{
  stf_vector A = {0}, E = {0};
  int code = values(m);
  if (!code) code = list(m, false, &A);
  if (!code) code = finish(m, &A, &E);
  stf_vector_free(m->ctx, &A);
  stf_vector_free(m->ctx, &E);
  return code;
}
