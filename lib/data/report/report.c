/* report.c: build a report: named fields, lists, matrices, and rows of sheets.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <math.h>
#include <string.h>

enum { NAME = 128 };

steif_report *steif_report_new(steif_context *ctx)
{
  if (!ctx) return NULL;
  steif_report *r = stf_allocate(ctx, 1, sizeof *r);
  if (!r) return NULL;
  r->ctx = ctx;
  r->root = json_object();
  if (!r->root) {
    STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for an empty report; free some memory");
    steif_report_free(&r);
  }
  return r;
}

void steif_report_free(steif_report **r)
{
  if (!r || !*r) return;
  stf_flow_close(&(*r)->flow);
  json_decref((*r)->root);
  stf_release((*r)->ctx, *r);
  *r = NULL;
}

static void fail(steif_report *r, int code, const char *name, const char *reason)
{
  if (r->code == STEIF_OK)
    r->code = stf_fail(r->ctx, code, "cannot add \"%s\" to the report: %s", name, reason);
}

/* Store a new value (the reference is taken) as member `key` of `owner`. */
static void store(steif_report *r, json_t *owner, const char *key, json_t *value)
{
  if (!value || json_object_set_new(owner, key, value))
    fail(r, STEIF_NO_MEMORY, key, "memory is short, or the name is not UTF-8");
}

/* The object that "sheet.key" or "object.key" belongs to, made when it is new. */
static json_t *owner_of(steif_report *r, const char *name, const char **key)
{
  const char *dot = strchr(name, '.');
  *key = dot ? dot + 1 : name;
  if (!dot) return r->root;
  char head[NAME];
  const size_t length = (size_t)(dot - name);
  if (length >= NAME) return NULL;
  memcpy(head, name, length);
  head[length] = 0;
  json_t *found = json_object_get(r->root, head);
  if (!found) {
    store(r, r->root, head, json_object());
    found = json_object_get(r->root, head);
  }
  if (stf_report_is_sheet(found)) found = json_array_get(found, json_array_size(found) - 1);
  return json_is_object(found) ? found : NULL;
}

/* Takes the reference to `value`. */
static void add(steif_report *r, const char *name, json_t *value)
{
  if (!r || r->code != STEIF_OK) {
    json_decref(value);
    return;
  }
  const char *key;
  json_t *owner = owner_of(r, name, &key);
  if (owner) {
    store(r, owner, key, value);
    return;
  }
  json_decref(value);
  fail(r, STEIF_BAD_INPUT, name, "the part before the dot is neither a sheet nor an object");
}

static json_t *real(double value)
{
  if (isnan(value)) return json_string("nan");
  if (isinf(value)) return json_string(value > 0 ? "inf" : "-inf");
  return json_real(value);
}

/* Bytes that are not UTF-8 become '?'. */
static json_t *text(steif_context *ctx, const char *value)
{
  if (!value) return json_null();
  json_t *made = json_string(value);
  if (made) return made;
  const size_t length = strlen(value);
  char *plain = stf_allocate(ctx, length + 1, 1);
  if (!plain) return NULL;
  for (size_t i = 0; i < length; i++) plain[i] = (char)((value[i] & 0x80) ? '?' : value[i]);
  made = json_string(plain);
  stf_release(ctx, plain);
  return made;
}

/* An array of `count` values; NULL when one of them could not be made. */
static json_t *reals(size_t count, const sunrealtype *value)
{
  json_t *array = json_array();
  for (size_t i = 0; array && i < count; i++)
    if (json_array_append_new(array, real(value[i]))) {
      json_decref(array);
      array = NULL;
    }
  return array;
}

void steif_report_row(steif_report *r, const char *sheet)
{
  if (!r || r->code != STEIF_OK) return;
  json_t *rows = json_object_get(r->root, sheet);
  if (!rows) {
    store(r, r->root, sheet, json_array());
    rows = json_object_get(r->root, sheet);
  }
  if (!json_is_array(rows))
    fail(r, STEIF_BAD_INPUT, sheet, "it is a field already, give the sheet another name");
  else if (json_array_append_new(rows, json_object()))
    fail(r, STEIF_NO_MEMORY, sheet, "no memory for a row");
}

void steif_report_real(steif_report *r, const char *name, sunrealtype value)
{
  add(r, name, real(value));
}

void steif_report_whole(steif_report *r, const char *name, long value)
{
  add(r, name, json_integer(value));
}

void steif_report_truth(steif_report *r, const char *name, int value)
{
  add(r, name, json_boolean(value));
}

void steif_report_text(steif_report *r, const char *name, const char *value)
{
  if (r) add(r, name, text(r->ctx, value));
}

void steif_report_texts(steif_report *r, const char *name, size_t count,
                        const char *const *value)
{
  if (!r) return;
  json_t *array = json_array();
  for (size_t i = 0; array && i < count; i++)
    if (json_array_append_new(array, text(r->ctx, value[i]))) {
      json_decref(array);
      array = NULL;
    }
  add(r, name, array);
}

void steif_report_list(steif_report *r, const char *name, size_t count,
                       const sunrealtype *value)
{
  add(r, name, reals(count, value));
}

void steif_report_matrix(steif_report *r, const char *name, size_t rows, size_t columns,
                         const sunrealtype *value)
{
  json_t *array = json_array();
  for (size_t i = 0; array && i < rows; i++)
    if (json_array_append_new(array, reals(columns, value + i * columns))) {
      json_decref(array);
      array = NULL;
    }
  add(r, name, array);
}

bool stf_report_is_sheet(const json_t *value)
{
  return json_is_array(value) && json_is_object(json_array_get(value, 0));
}

bool stf_report_is_number(const json_t *value)
{
  static const char *const special[] = {"nan", "inf", "-inf"};
  const char *word = json_string_value(value);
  for (size_t i = 0; word && i < 3; i++)
    if (!strcmp(word, special[i])) return true;
  return json_is_number(value);
}

int steif_report_write(steif_report *r, enum steif_format format, FILE *stream)
{
  if (!r) return STEIF_NO_MEMORY;
  STEIF_TRY(r->code);
  STEIF_CHECK(stream, r->ctx, STEIF_BAD_INPUT,
              "no stream to write the report to; open one first");
  STEIF_TRY(format == STEIF_JSON  ? stf_report_json(r, stream)
            : format == STEIF_CSV ? stf_report_csv(r, stream)
                                  : stf_report_table(r, stream));
  STEIF_CHECK(
    !fflush(stream) && !ferror(stream), r->ctx, STEIF_IO,
    "the report could not be written: the stream failed; is the disk full or the reader "
    "gone?");
  return STEIF_OK;
}

int steif_report_save(steif_report *r, enum steif_format format, const char *path)
{
  if (!r) return STEIF_NO_MEMORY;
  stf_output output;
  STEIF_TRY(r->code);
  STEIF_TRY(stf_output_open(r->ctx, path, &output));
  return stf_output_close(r->ctx, &output, steif_report_write(r, format, output.stream));
}
