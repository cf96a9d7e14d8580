/* method_names.c: which method a spec stands for, by what families and engines on the shelf say themselves;
 * and the list of methods with what is claimed of each.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <stdio.h>
#include <string.h>
#include <strings.h>

static const char automatic[] = "auto";

const steif_engine *stf_engine_find(const char *name)
{
  for (size_t i = 0; i < stf_engine_count; i++)
    if (!strcmp(stf_engine_shelf[i].name, name)) return stf_engine_shelf[i].item;
  return NULL;
}

/* -- lists ------------------------------------------------------------------------------- */

static const char *example_at(size_t *i)
{
  for (int place = 0; place < STF_PLACES; place++)
    for (size_t f = 0; f < stf_method_count; f++) {
      const steif_method *family = stf_method_shelf[f].item;
      stf_example e;
      for (size_t k = 0; family->example && (e = family->example(k)).spec; k++)
        if (e.place == place && (*i)-- == 0) return e.spec;
    }
  return NULL;
}

/* The family that takes its coefficients from tables of this kind. */
static const steif_method *family_of(enum steif_table_kind kind)
{
  for (size_t f = 0; f < stf_method_count; f++) {
    const stf_tables *tables = stf_method_shelf[f].item->tables;
    if (tables && tables->kind == kind) return stf_method_shelf[f].item;
  }
  return NULL;
}

/* "dirk:" before a table that its family takes by that prefix, else "". */
static void prefix_of(enum steif_table_kind kind, char *text, size_t size)
{
  const steif_method *family = family_of(kind);
  const char *prefix = family ? family->tables->prefix : NULL;
  snprintf(text, size, "%s%s", prefix ? prefix : "", prefix ? ":" : "");
}

/* Tables with parameters are among the examples. */
static bool table_at(size_t *i, char *text, size_t size)
{
  for (size_t k = 0; k < stf_table_count; k++) {
    const steif_table *item = stf_table_shelf[k].item;
    if (item->build || item->fill || (*i)--) continue;
    prefix_of(item->kind, text, size);
    const size_t used = strlen(text);
    return snprintf(text + used, size - used, "%s", stf_table_shelf[k].name) > 0;
  }
  return false;
}

/* Spec i of the list: examples, tables, `auto`, engines. */
static bool spec_at(size_t i, char *text, size_t size)
{
  const char *spec = example_at(&i);
  if (!spec && table_at(&i, text, size)) return true;
  if (!spec && i == 0) spec = automatic;
  if (!spec && --i < stf_engine_count) spec = stf_engine_shelf[i].name;
  return spec && snprintf(text, size, "%s", spec) > 0;
}

/* -- look-ups ---------------------------------------------------------------------------- */

/* Names that other programs have for methods of the same kind. */
static const char *known_elsewhere(const char *name)
{
  static const char *const words[] = {
    "rk45>dopri87",  "rk23>dopri87",      "dop853>dopri87", "dopri5>dopri87", "ode45>dopri87",
    "ode23>dopri87", "radau5>radau",      "bdf>bdf",        "ode15s>bdf",     "ode15i>bdf",
    "vode>bdf",      "dassl>bdf",         "daspk>bdf",      "lsoda>auto",     "lsode>auto",
    "ode23s>rodas4", "ode23t>dirk:trbdf2"};
  const size_t m = strlen(name);
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (!strncasecmp(name, words[i], m) && words[i][m] == '>') return words[i] + m + 1;
  return NULL;
}

/* The word before the colon of the spec in the list that is nearest to a wrong one. */
static int unknown(steif_context *ctx, const steif_spec *spec)
{
  char text[STEIF_SPEC_WORD], best[STEIF_SPEC_WORD] = "";
  const char *other = known_elsewhere(spec->name);
  int least = 0;
  for (size_t i = 0; spec_at(i, text, sizeof text); i++) {
    text[strcspn(text, ":")] = 0;
    const int distance = stf_distance(spec->name, text);
    if (*best && distance >= least) continue;
    least = distance;
    strcpy(best, text);
  }
  const bool near = !other && stf_near(spec->name, best);
  const char *words = other ? "; here it is '" : near ? "; did you mean '" : "";
  return STEIF_FAIL(ctx, STEIF_UNKNOWN_NAME,
                    "no method '%s'%s%s%s 'steif list methods' shows all", spec->name, words,
                    other  ? other
                    : near ? best
                           : "",
                    other  ? "';"
                    : near ? "'?"
                           : ";");
}

/* PREFIX:TABLE,key=value and PREFIX:file=PATH: the spec of the table. */
static int table_spec(steif_context *ctx, const stf_tables *tables, const steif_spec *spec,
                      steif_spec *inner)
{
  const char *name = stf_spec_word(spec, "");
  *inner = *spec;
  if (!name && stf_spec_word(spec, "file")) return STEIF_OK;
  STEIF_CHECK(name, ctx, STEIF_BAD_INPUT, "'%s' needs the name of a table: %s", spec->name,
              tables->example);
  STEIF_CHECK(strlen(name) < sizeof inner->name, ctx, STEIF_UNKNOWN_NAME,
              "no table is named '%s'", name);
  strcpy(inner->name, name);
  inner->count = 0;
  for (int i = 0; i < spec->count; i++)
    if (*spec->param[i].key) inner->param[inner->count++] = spec->param[i];
  return STEIF_OK;
}

/* The table of a spec for the family with these tables. */
static int build(steif_context *ctx, const stf_tables *tables, const steif_spec *spec,
                 steif_table **table)
{
  static const char *const kinds[] = {"explicit", "diagonally implicit", "fully implicit",
                                      "of a general linear method"};
  steif_spec inner = *spec;
  if (tables->prefix) STEIF_TRY(table_spec(ctx, tables, spec, &inner));
  *table = stf_table_build(ctx, &inner);
  if (!*table) return steif_status(ctx);
  const enum steif_table_kind kind = (*table)->kind;
  if (kind == tables->kind) return STEIF_OK;
  char before[STEIF_SPEC_WORD];
  prefix_of(kind, before, sizeof before);
  steif_table_free(ctx, table);
  return STEIF_FAIL(ctx, STEIF_UNKNOWN_NAME, "table '%s' is %s: write '%s%s'", inner.name,
                    kinds[kind], before, inner.name);
}

static const steif_table *table_named(const char *name)
{
  for (size_t i = 0; i < stf_table_count; i++)
    if (!strcmp(stf_table_shelf[i].name, name)) return stf_table_shelf[i].item;
  return NULL;
}

static bool owns(const steif_method *family, const char *name, const steif_table *item)
{
  const stf_tables *tables = family->tables;
  if (family->owns && family->owns(name)) return true;
  if (!tables) return false;
  return tables->prefix ? !strcmp(tables->prefix, name) : item && item->kind == tables->kind;
}

/* Neither an engine nor `auto`, which the solver looks for first. */
static int check_family(steif_context *ctx, const char *name)
{
  const bool chooses = !strcmp(name, automatic);
  STEIF_CHECK(
    !chooses && !stf_engine_find(name), ctx, STEIF_UNSUPPORTED,
    "'%s' chooses its %s: it has no one step on y' = lambda y; take a method of given "
    "order such as bdf:p=3",
    name, chooses ? "method" : "order and step");
  return STEIF_OK;
}

int stf_method_find(steif_context *ctx, const steif_spec *spec, const steif_method **method,
                    steif_table **table)
{
  const steif_table *item = table_named(spec->name);
  *table = NULL;
  STEIF_TRY(check_family(ctx, spec->name));
  for (size_t f = 0; f < stf_method_count; f++) {
    const steif_method *family = stf_method_shelf[f].item;
    if (!owns(family, spec->name, item)) continue;
    *method = family;
    return family->tables ? build(ctx, family->tables, spec, table) : STEIF_OK;
  }
  if (!item) return unknown(ctx, spec);
  char before[STEIF_SPEC_WORD];
  prefix_of(item->kind, before, sizeof before);
  return STEIF_FAIL(ctx, STEIF_UNKNOWN_NAME, "write '%s%s' for this table", before, spec->name);
}

int steif_method_propagator(steif_context *ctx, const char *text, const sunrealtype z[2],
                            int *r, sunrealtype *M)
{
  steif_spec spec;
  const steif_method *method;
  steif_table *table;
  STEIF_TRY(steif_spec_parse(ctx, text, &spec));
  STEIF_TRY(stf_method_find(ctx, &spec, &method, &table));
  const int code = stf_propagate(ctx, method, &spec, table, z, r, M);
  steif_table_free(ctx, &table);
  return code;
}

/* -- claims ------------------------------------------------------------------------------ */

static void describe_auto(steif_method_info *info)
{
  info->family = automatic;
  info->about = "chooses by size, storage, index, tolerance and the stiffness it meets";
  info->forms = STEIF_ODE | STEIF_MASS | STEIF_IMPLICIT | STEIF_DESCRIPTOR;
  info->adaptive = 1;
}

static void describe_engine(const steif_engine *engine, steif_method_info *info)
{
  info->family = engine->family ? engine->family : "baseline";
  info->about = engine->about;
  info->forms = engine->forms;
  info->adaptive = 1;
}

static int describe(steif_context *ctx, const steif_spec *spec, steif_method_info *info)
{
  const steif_method *method;
  steif_table *table;
  STEIF_TRY(stf_method_find(ctx, spec, &method, &table));
  info->forms = method->forms;
  const int code = method->describe(ctx, spec, table, info);
  const steif_table *item = table ? table_named(table->name) : NULL;
  if (item) info->about = item->about; /* outlives the table */
  steif_table_free(ctx, &table);
  return code;
}

int steif_method_find(steif_context *ctx, const char *text, steif_method_info *info)
{
  steif_spec spec;
  STEIF_TRY(steif_spec_parse(ctx, text, &spec));
  memset(info, 0, sizeof *info);
  snprintf(info->name, sizeof info->name, "%s", text);
  const steif_engine *engine = stf_engine_find(spec.name);
  if (engine)
    describe_engine(engine, info);
  else if (!strcmp(text, automatic))
    describe_auto(info);
  else
    return describe(ctx, &spec, info);
  return STEIF_OK;
}

int steif_method_at(steif_context *ctx, size_t i, steif_method_info *info)
{
  STEIF_CHECK(info, ctx, STEIF_BAD_INPUT, "no place for the method: it is NULL");
  char text[STEIF_SPEC_WORD];
  return spec_at(i, text, sizeof text) ? steif_method_find(ctx, text, info) : STEIF_BAD_INPUT;
}
