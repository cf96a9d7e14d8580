/* table.c: look a table up by its spec, build families, copy what is constant.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"
#include <stdio.h>
#include <string.h>

enum { SQUARE = STEIF_STAGES * STEIF_STAGES };

/* What steif_table_new hands out: the table and the arrays it points to, one block. */
typedef struct owned {
  steif_table table;
  sunrealtype A[2 * SQUARE], b[STEIF_STAGES], c[STEIF_STAGES], bhat[STEIF_STAGES];
} owned;

const steif_table *steif_table_at(size_t i)
{
  return i < stf_table_count ? stf_table_shelf[i].item : NULL;
}

int stf_table_check(steif_context *ctx, const steif_table *table)
{
  STEIF_CHECK(table, ctx, STEIF_BAD_INPUT, "a table is needed, got NULL");
  STEIF_CHECK(table->kind != STEIF_GLM, ctx, STEIF_UNSUPPORTED,
              "table '%s' is a general linear method, which has no A and b: see steif/glm.h",
              table->name ? table->name : "");
  STEIF_CHECK(
    table->A && table->b, ctx, STEIF_BAD_INPUT,
    "table '%s' has no coefficients; a family is built by steif_table_new(ctx, \"%s:s=3\")",
    table->name ? table->name : "", table->name ? table->name : "radau");
  STEIF_CHECK(table->s >= 1 && table->s <= STEIF_STAGES, ctx, STEIF_BAD_INPUT,
              "table '%s' has %d stages; 1 to %d are possible", table->name ? table->name : "",
              table->s, STEIF_STAGES);
  return STEIF_OK;
}

static const steif_table *find(steif_context *ctx, const char *name)
{
  for (size_t i = 0; i < stf_table_count; i++)
    if (!strcmp(stf_table_shelf[i].name, name)) return stf_table_shelf[i].item;
  char guess[STF_GUESS];
  STEIF_FAIL(ctx, STEIF_UNKNOWN_NAME, "no table is named '%s'%s", name,
             stf_guess(name, stf_table_shelf, stf_table_count, sizeof *stf_table_shelf, guess));
  return NULL;
}

static void row_sums(int s, const sunrealtype *A, sunrealtype *c)
{
  for (int i = 0; i < s; i++) {
    long double sum = 0;
    for (int j = 0; j < s; j++) sum += (long double)A[i * s + j];
    c[i] = (sunrealtype)sum;
  }
}

static void copy(owned *o)
{
  steif_table *t = &o->table;
  const size_t s = (size_t)t->s;
  memcpy(o->A, t->A, s * s * sizeof *o->A);
  memcpy(o->b, t->b, s * sizeof *o->b);
  if (t->c)
    memcpy(o->c, t->c, s * sizeof *o->c);
  else
    row_sums(t->s, t->A, o->c);
  if (t->bhat) {
    memcpy(o->bhat, t->bhat, s * sizeof *o->bhat);
    t->bhat = o->bhat;
  }
  t->A = o->A, t->b = o->b, t->c = o->c;
}

static int fill(steif_context *ctx, const steif_spec *spec, owned *o)
{
  steif_table *t = &o->table;
  if (t->build) return t->build(ctx, spec, t, o->A, o->b, o->c);
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){NULL}));
  copy(o);
  return STEIF_OK;
}

/* The same for general linear methods. */
typedef struct owned_general {
  steif_table table;
  steif_glm glm;
} owned_general;

/* "ab:p=3" */
static void set_name(const steif_spec *spec, steif_glm *g)
{
  size_t used = (size_t)snprintf(g->name, sizeof g->name, "%s", spec->name);
  for (int i = 0; i < spec->count && used < sizeof g->name; i++)
    used += (size_t)snprintf(g->name + used, sizeof g->name - used, "%c%s=%s", i ? ',' : ':',
                             spec->param[i].key, spec->param[i].value);
}

static int fill_general(steif_context *ctx, const steif_spec *spec, owned_general *o)
{
  steif_table *t = &o->table;
  steif_glm *g = &o->glm;
  if (t->fill)
    STEIF_TRY(t->fill(ctx, spec, t, g));
  else {
    STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){NULL}));
    *g = *t->general;
  }
  if (!*g->name) set_name(spec, g);
  STEIF_TRY(steif_glm_complete(ctx, g));
  t->general = g, t->s = g->r, t->order = g->order, t->stage_order = g->stage_order;
  return STEIF_OK;
}

static steif_table *build_general(steif_context *ctx, const steif_spec *spec,
                                  const steif_table *item)
{
  owned_general *o = stf_allocate(ctx, 1, sizeof *o);
  if (!o) return NULL;
  o->table = *item;
  steif_table *table = &o->table;
  if (fill_general(ctx, spec, o)) steif_table_free(ctx, &table);
  return table;
}

/* glm:file=PATH */
static int fill_from_file(steif_context *ctx, const steif_spec *spec, steif_table *self,
                          steif_glm *glm)
{
  (void)self;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"file", NULL}));
  return stf_table_read(ctx, stf_spec_word(spec, "file"), glm);
}

static const steif_table of_file = {.name = "file",
                                    .about = "a tableau from a text file",
                                    .kind = STEIF_GLM,
                                    .fill = fill_from_file};

steif_table *stf_table_build(steif_context *ctx, const steif_spec *spec)
{
  const bool file = !strcmp(spec->name, "glm") && stf_spec_word(spec, "file");
  const steif_table *item = file ? &of_file : find(ctx, spec->name);
  if (item && item->kind == STEIF_GLM) return build_general(ctx, spec, item);
  owned *o = item ? stf_allocate(ctx, 1, sizeof *o) : NULL;
  if (!o) return NULL;
  o->table = *item;
  steif_table *table = &o->table;
  if (fill(ctx, spec, o)) steif_table_free(ctx, &table);
  return table;
}

steif_table *steif_table_new(steif_context *ctx, const char *spec)
{
  steif_spec parsed;
  if (!ctx || steif_spec_parse(ctx, spec, &parsed)) return NULL;
  return stf_table_build(ctx, &parsed);
}

void steif_table_free(steif_context *ctx, steif_table **table)
{
  if (!ctx || !table || !*table) return;
  stf_release(ctx, *table);
  *table = NULL;
}
