/* native.c: f, E and A of a model by compiled code, as far as it agrees with the machine.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "native.h"
#include "compiler.h"
#include "model_file.h"
#include <dlfcn.h>
#include <math.h>
#include <steif/model.h>
#include <stdio.h>
#include <string.h>

enum { STATEMENTS = 2000 }; /* of a tape; compilers take minutes for long straight code */

static const char *const names[] = {"f", "A", "E"};
enum { QUANTITIES = 3 };

static stf_quantity *quantity(stf_model *m, int i)
{
  return i == 0 ? &m->f : i == 1 ? &m->A.quantity : &m->E.quantity;
}

/* ---- code for the quantities ------------------------------------------------------------------ */

/* The functions of one quantity; those of tapes that were too long are not there. */
static int take_code(stf_model *m, void *library, int which)
{
  stf_quantity *q = quantity(m, which);
  stf_code_of_tape *code = stf_pool_array(m->pool, q->tapes.count, sizeof *code);
  const int32_t *const **slots = stf_pool_array(m->pool, q->tapes.count, sizeof *slots);
  if (!code || !slots) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < q->tapes.count; i++) {
    char name[40];
    const stf_tape *t = STF_AT(q->tapes, stf_tape, i);
    const int32_t **slot = stf_pool_array(m->pool, t->stores.count, sizeof *slot);
    if (!slot) return STEIF_NO_MEMORY;
    for (size_t k = 0; k < t->stores.count; k++)
      slot[k] = STF_AT(t->stores, stf_store, k)->slot;
    slots[i] = slot;
    snprintf(name, sizeof name, "%s_%zu", names[which], i);
    void *found = dlsym(library, name);
    memcpy(&code[i], &found, sizeof found);
  }
  q->slots = slots;
  q->code = code;
  return STEIF_OK;
}

static void drop_code(stf_model *m)
{
  for (int i = 0; i < QUANTITIES; i++) quantity(m, i)->code = NULL;
  if (m->library) dlclose(m->library);
  m->library = NULL;
}

void stf_native_free(stf_model *m) { drop_code(m); }

/* ---- does it agree ---------------------------------------------------------------------------- */

static bool agrees(stf_model *m, stf_quantity *q, const stf_feed *feed, double *x)
{
  const int64_t count = q->size;
  stf_code_of_tape *code = q->code;
  stf_quantity_run(m, q, feed, x);
  q->code = NULL;
  stf_quantity_run(m, q, feed, x + count);
  q->code = code;
  for (int64_t i = 0; i < count; i++)
    if (!(x[i] == x[count + i]) && !(isnan(x[i]) && isnan(x[count + i]))) return false;
  return true;
}

/* At the start, with slopes if there are some. */
static int check_code(stf_model *m)
{
  int64_t most = m->n;
  for (int i = 0; i < QUANTITIES; i++)
    if (quantity(m, i)->size > most) most = quantity(m, i)->size;
  double *x = stf_allocate(m->ctx, 2 * (size_t)most + (size_t)m->n, sizeof *x);
  if (!x) return STEIF_NO_MEMORY;
  stf_feed feed = m->feed;
  feed.t = m->t0;
  feed.y = m->y0;
  feed.yp = m->yp0 ? m->yp0 : x + 2 * most;
  bool good = true;
  for (int i = 0; good && i < QUANTITIES; i++) good = agrees(m, quantity(m, i), &feed, x);
  stf_release(m->ctx, x);
  STEIF_CHECK(
    good, m->ctx, STEIF_NOT_CERTIFIED,
    "the compiled model gives other values than the interpreter at the start: it is not "
    "used; take another compiler");
  return STEIF_OK;
}

/* ---- the text --------------------------------------------------------------------------------- */

/* Tapes that are worth it; returns how many. */
static size_t write_code(stf_writer *w, stf_model *m)
{
  const stf_quantity *all[QUANTITIES];
  size_t count = 0;
  for (int i = 0; i < QUANTITIES; i++) all[i] = quantity(m, i);
  stf_write_text(w, "#include <math.h>\n");
  stf_write_functions(w, m, QUANTITIES, all);
  for (int i = 0; i < QUANTITIES; i++)
    count += stf_write_quantity(
      w, &(stf_dialect){.name = names[i], .store = "", .most = STATEMENTS}, all[i]);
  return count;
}

static int compile(stf_model *m, const char *compiler, const char *folder)
{
  stf_writer w = {.ctx = m->ctx};
  stf_write_text(&w, "/* ");
  stf_write_plain(&w, compiler);
  stf_write_text(&w, " */\n");
  const size_t count = write_code(&w, m);
  const char *text = stf_written(&w);
  int code = text ? STEIF_OK : STEIF_NO_MEMORY;
  if (!code && !count)
    code =
      STEIF_FAIL(m->ctx, STEIF_UNSUPPORTED,
                 "all equations are too long for a compiler (more than %d operations without a "
                 "loop)",
                 STATEMENTS);
  if (!code && !(m->library = stf_library_of(m->ctx, compiler, folder, text)))
    code = steif_status(m->ctx);
  stf_vector_free(m->ctx, &w.text);
  for (int i = 0; !code && i < QUANTITIES; i++) code = take_code(m, m->library, i);
  return code ? code : check_code(m);
}

int steif_model_compile(steif_context *ctx, const steif_problem *p, const char *compiler,
                        const char *folder)
{
  STEIF_CHECK(p && p->destroy == stf_model_close, ctx, STEIF_BAD_INPUT,
              "problem '%s' was not made from a text: there is nothing to compile",
              p && p->name ? p->name : "NULL");
  stf_model *m = p->user;
  if (m->library) return STEIF_OK;
  const int code = compile(m, compiler ? compiler : "cc", folder);
  if (code) drop_code(m);
  return code;
}
