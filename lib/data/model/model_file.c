/* model_file.c: from a text to a model that can be solved, and back.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model_file.h"
#include "reactions.h"
#include "text.h"
#include <errno.h>
#include <string.h>

/* ---- reading
 * ---------------------------------------------------------------------------------
 */

/* The whole file into the pool. */
static int read_text(stf_model *m, const char *path)
{
  FILE *file = stf_input_open(m->ctx, path);
  if (!file) return steif_status(m->ctx);
  long size = -1;
  if (!fseek(file, 0, SEEK_END)) size = ftell(file);
  int code = STEIF_OK;
  char *text = NULL;
  stf_text *to = stf_vector_push(m->ctx, &m->syntax.sources.texts, sizeof *to);
  if (size < 0 || fseek(file, 0, SEEK_SET))
    code = STEIF_FAIL(m->ctx, STEIF_IO, "cannot read '%s'; check the path", path);
  else if (size > STF_LARGEST_TEXT)
    code = STEIF_FAIL(m->ctx, STEIF_BAD_INPUT, "%s: %ld bytes; %d are the most. Use loops",
                      path, size, STF_LARGEST_TEXT);
  else
    text = stf_pool_array(m->pool, (size_t)size + 1, 1);
  if (!code && (!text || !to)) code = STEIF_NO_MEMORY;
  if (!code) *to = (stf_text){path, text, 0, (uint32_t)fread(text, 1, (size_t)size, file)};
  fclose(file);
  return code;
}

int stf_number_of(stf_model *m, const stf_expression *e, double *value)
{
  stf_graph g = {.ctx = m->ctx};
  stf_builder b;
  int code = stf_builder_open(&b, m, &g, true);
  if (!code) code = stf_value(&b, e, value);
  stf_builder_close(&b);
  stf_graph_free(&g);
  if (code) return stf_complaints(&m->syntax.sources) ? steif_status(m->ctx) : code;
  return STEIF_OK;
}

/* ---- the whole
 * -------------------------------------------------------------------------------
 */

static int interval(stf_model *m)
{
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->kind != STF_SAY_TIME) continue;
    STEIF_TRY(stf_number_of(m, &s->value, &m->t0));
    STEIF_TRY(stf_number_of(m, &s->other, &m->t1));
    if (m->t1 > m->t0) return STEIF_OK;
    stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                 "the interval from %.12g to %.12g; the end lies after the start", m->t0,
                 m->t1);
    return stf_complaints(&m->syntax.sources);
  }
  stf_complain(&m->syntax.sources, STF_NOWHERE, STEIF_BAD_INPUT,
               "no time interval; add 'time 0 to 10'");
  return stf_complaints(&m->syntax.sources);
}

static int open_events(stf_model *m)
{
  m->reactions = stf_pool_array(m->pool, 1, sizeof *m->reactions);
  m->event_block = stf_pool_array(m->pool, 1, sizeof *m->event_block);
  if (!m->reactions || !m->event_block) return STEIF_NO_MEMORY;
  m->event_block->graph.ctx = m->ctx;
  return STEIF_OK;
}

static int lower(stf_model *m, const steif_spec *spec)
{
  STEIF_TRY(open_events(m));
  STEIF_TRY(stf_declare(m, spec));
  STEIF_TRY(stf_number_unknowns(m));
  STEIF_TRY(stf_name_unknowns(m));
  m->feed = (stf_feed){.p = m->p};
  STEIF_TRY(stf_read_tables(m));
  STEIF_TRY(stf_build_blocks(m));
  STEIF_TRY(stf_deduce_form(m));
  STEIF_TRY(stf_build_start(m));
  STEIF_TRY(interval(m));
  STEIF_TRY(stf_build_constraints(m));
  STEIF_TRY(stf_build_events(m));
  return stf_build_tapes(m);
}

static void quantity_free(const stf_model *m, stf_quantity *q)
{
  for (size_t i = 0; i < q->tapes.count; i++)
    stf_tape_free(m->ctx, STF_AT(q->tapes, stf_tape, i));
  stf_vector_free(m->ctx, &q->tapes);
  stf_vector_free(m->ctx, &q->spaces);
}

static void blocks_free(stf_model *m)
{
  for (size_t i = 0; i < m->blocks.count; i++) {
    stf_block *block = *STF_AT(m->blocks, stf_block *, i);
    stf_graph_free(&block->graph);
    stf_vector_free(m->ctx, &block->equations);
    stf_vector_free(m->ctx, &block->switches);
  }
  stf_vector_free(m->ctx, &m->blocks);
  if (m->event_block) stf_graph_free(&m->event_block->graph);
  if (m->event_block) stf_vector_free(m->ctx, &m->event_block->switches);
}

void stf_model_free(stf_model *m)
{
  steif_context *ctx = m->ctx;
  stf_pool *pool = m->pool;
  stf_vector *all[] = {&m->syntax.sources.texts,
                       &m->syntax.tokens,
                       &m->syntax.statements,
                       &m->syntax.codes,
                       &m->syntax.indices,
                       &m->symbols,
                       &m->symbol_of,
                       &m->names,
                       &m->partials,
                       &m->breaks};
  blocks_free(m);
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) stf_vector_free(ctx, all[i]);
  stf_words_close(&m->syntax.words);
  if (m->reactions) quantity_free(m, &m->reactions->conditions);
  stf_reactions_free(m);
  quantity_free(m, &m->events);
  quantity_free(m, &m->invariants);
  quantity_free(m, &m->f);
  quantity_free(m, &m->A.quantity);
  quantity_free(m, &m->E.quantity);
  stf_sweep_free(ctx, &m->sweep);
  stf_pool_free(&pool);
}

static int model_new(steif_context *ctx, stf_model **model)
{
  stf_pool *pool = stf_pool_new(ctx);
  stf_model *m = pool ? stf_pool_array(pool, 1, sizeof *m) : NULL;
  if (!m) {
    stf_pool_free(&pool);
    return STEIF_NO_MEMORY;
  }
  m->ctx = m->syntax.sources.ctx = ctx;
  m->pool = pool;
  m->syntax.words.ctx = ctx;
  *model = m;
  return stf_words_open(&m->syntax.words, ctx, pool);
}

static int build(stf_model *m, const char *path, const steif_spec *spec, steif_problem *p)
{
  STEIF_TRY(read_text(m, path));
  STEIF_TRY(stf_parse(&m->syntax, 0));
  STEIF_TRY(stf_complaints(&m->syntax.sources));
  STEIF_TRY(lower(m, spec));
  return stf_model_fill(m, p);
}

int stf_model_open(steif_context *ctx, const char *path, const steif_spec *spec,
                   steif_problem *p)
{
  stf_model *m = NULL;
  stf_plain plain;
  int code = model_new(ctx, &m);
  if (!code) code = stf_plain_begin(ctx, &plain);
  if (!code) {
    code = build(m, path, spec, p);
    stf_plain_end(&plain);
  }
  p->user = m;
  return code;
}

void stf_model_close(steif_context *ctx, steif_problem *p)
{
  (void)ctx;
  if (p->user) stf_model_free(p->user);
  p->user = NULL;
}
