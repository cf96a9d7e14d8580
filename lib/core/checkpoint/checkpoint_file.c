/* checkpoint_file.c: a solver to the bytes of a file, and these to what they say.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checkpoint_file.h"
#include <stdint.h>
#include <string.h>

enum { VERSION = 3, ORDER = 0x01020304 };
static const char magic[8] = {'s', 't', 'e', 'i', 'f', ' ', 'c', 'k'};

/* The first bytes, the same on every machine but for the order of bytes. */
typedef struct head {
  char magic[8];
  uint32_t order, version, real, index, whole, pointer;
  uint64_t bytes;
} head;

static head our_head(uint64_t bytes)
{
  head h = {.order = ORDER,
            .version = VERSION,
            .real = sizeof(sunrealtype),
            .index = sizeof(sunindextype),
            .whole = sizeof(long),
            .pointer = sizeof(void *),
            .bytes = bytes};
  memcpy(h.magic, magic, sizeof magic);
  return h;
}

/* -- writing ------------------------------------------------------------------------------- */

static void walk(steif_solver *s, const stf_identity *id, const void *note, size_t note_bytes,
                 stf_image *m)
{
  stf_identity identity = *id;
  size_t count = note_bytes;
  STF_KEEP(m, identity);
  stf_keep_count(m, &count, SIZE_MAX);
  if (count) stf_keep(m, (void *)(uintptr_t)note, count);
  stf_solver_keep(s, m);
}

static int check_savable(steif_solver *s)
{
  const steif_problem *p = s->problem;
  STEIF_CHECK(!s->failed, s->ctx, STEIF_BAD_INPUT, "the run has failed (%s): save it before",
              s->why);
  STEIF_CHECK(!s->inside, s->ctx, STEIF_BAD_INPUT,
              "a run is saved after a step, not while its events are handled");
  STEIF_CHECK(!p->save == !p->restore, s->ctx, STEIF_BAD_INPUT,
              "problem '%s' has %s without %s", p->name, p->save ? "save" : "restore",
              p->save ? "restore" : "save");
  STEIF_CHECK(
    s->engine || !p->begin || p->save, s->ctx, STEIF_UNSUPPORTED,
    "callbacks of problem '%s' remember something, as its member begin says: set save "
    "and restore, too",
    p->name);
  STEIF_CHECK(
    !s->step.carry && !s->quadratures, s->ctx, STEIF_UNSUPPORTED,
    "a run of problem '%s' with sensitivities or quadratures cannot be saved: repeat it",
    p->name);
  return STEIF_OK;
}

static int write(steif_solver *s, const void *note, size_t note_bytes, bool summed,
                 unsigned char **bytes, size_t *count)
{
  stf_identity id;
  STEIF_TRY(check_savable(s));
  stf_identity_of(s, &id);
  stf_image m = {.ctx = s->ctx};
  walk(s, &id, note, note_bytes, &m);
  if (m.code) return m.code;
  *count = sizeof(head) + m.used + sizeof(uint64_t);
  *bytes = stf_allocate(s->ctx, *count, 1);
  if (!*bytes) return STEIF_NO_MEMORY;
  const head h = our_head(*count);
  memcpy(*bytes, &h, sizeof h);
  m = (stf_image){.ctx = s->ctx, .at = *bytes + sizeof h, .size = m.used};
  walk(s, &id, note, note_bytes, &m);
  const uint64_t sum = summed ? stf_checksum(*bytes, *count - sizeof sum) : 0;
  memcpy(*bytes + *count - sizeof sum, &sum, sizeof sum);
  if (!m.code && m.used == m.size) return STEIF_OK;
  stf_release(s->ctx, *bytes);
  *bytes = NULL;
  return m.code ? m.code
                : STEIF_FAIL(s->ctx, STEIF_CALLBACK,
                             "save of problem '%s' gave more bytes at its second call than at "
                             "its first",
                             s->problem->name);
}

int stf_checkpoint_bytes(steif_solver *s, const void *note, size_t note_bytes,
                         unsigned char **bytes, size_t *count)
{
  return write(s, note, note_bytes, true, bytes, count);
}

int stf_checkpoint_image(steif_solver *s, unsigned char **bytes, size_t *count)
{
  return write(s, NULL, 0, false, bytes, count);
}

/* -- reading ------------------------------------------------------------------------------- */

static int check_head(steif_context *ctx, const char *name, const head *h, size_t count)
{
  const head ours = our_head(h->bytes);
  STEIF_CHECK(!memcmp(h->magic, magic, sizeof magic), ctx, STEIF_IO,
              "'%s' is no checkpoint of steif", name);
  STEIF_CHECK(
    h->order == ours.order && h->real == ours.real && h->index == ours.index &&
      h->whole == ours.whole && h->pointer == ours.pointer,
    ctx, STEIF_UNSUPPORTED,
    "checkpoint '%s' was made on a machine with another order of bytes or other sizes "
    "of numbers: go on there, or repeat the run",
    name);
  STEIF_CHECK(h->version == ours.version, ctx, STEIF_UNSUPPORTED,
              "checkpoint '%s' has version %u, this steif reads %u: go on with the steif that "
              "made it",
              name, (unsigned)h->version, (unsigned)ours.version);
  STEIF_CHECK(h->bytes >= count, ctx, STEIF_IO,
              "checkpoint '%s' has %zu bytes, %llu more than it should", name, count,
              (unsigned long long)(count - h->bytes));
  STEIF_CHECK(h->bytes == count, ctx, STEIF_IO,
              "checkpoint '%s' is cut short: %zu of %llu bytes are there", name, count,
              (unsigned long long)h->bytes);
  return STEIF_OK;
}

static int check_whole(steif_context *ctx, const char *name, const unsigned char *bytes,
                       size_t count, bool summed)
{
  head h;
  uint64_t sum;
  STEIF_CHECK(count >= sizeof h + sizeof sum, ctx, STEIF_IO, "'%s' is no checkpoint of steif",
              name);
  memcpy(&h, bytes, sizeof h);
  STEIF_TRY(check_head(ctx, name, &h, count));
  memcpy(&sum, bytes + count - sizeof sum, sizeof sum);
  STEIF_CHECK(!summed || sum == stf_checksum(bytes, count - sizeof sum), ctx, STEIF_IO,
              "checkpoint '%s' is damaged: its bytes do not have the checksum they had", name);
  return STEIF_OK;
}

/* Texts end, and the version is ours. */
static int check_identity(steif_context *ctx, const char *name, stf_identity *id)
{
  id->version[sizeof id->version - 1] = 0;
  id->problem[sizeof id->problem - 1] = 0;
  id->spec[sizeof id->spec - 1] = 0;
  STEIF_CHECK(!strcmp(id->version, steif_version()), ctx, STEIF_UNSUPPORTED,
              "checkpoint '%s' was made by steif %s, this is steif %s: go on with that one",
              name, id->version, steif_version());
  return STEIF_OK;
}

static int look(steif_context *ctx, const char *name, size_t count, bool summed,
                stf_opened *file)
{
  stf_image *m = &file->state;
  STEIF_TRY(check_whole(ctx, name, file->bytes, count, summed));
  *m = (stf_image){.ctx = ctx,
                   .from = file->bytes + sizeof(head),
                   .size = count - sizeof(head) - sizeof(uint64_t),
                   .reads = true};
  STF_KEEP(m, file->identity);
  stf_keep_count(m, &file->note_bytes, m->size);
  if (m->code) return m->code;
  STEIF_TRY(check_identity(ctx, name, &file->identity));
  if (!file->note_bytes) return STEIF_OK;
  STEIF_CHECK(file->note_bytes + sizeof(uint64_t) <= m->size - m->used, ctx, STEIF_IO,
              "checkpoint '%s' is damaged: its note is longer than the file", name);
  file->note = m->from + m->used + sizeof(uint64_t);
  m->used += file->note_bytes + sizeof(uint64_t);
  return STEIF_OK;
}

int stf_checkpoint_open(steif_context *ctx, const char *name, unsigned char *bytes,
                        size_t count, stf_opened *file)
{
  *file = (stf_opened){.bytes = bytes};
  const int code = look(ctx, name, count, true, file);
  if (code) stf_checkpoint_close(ctx, file);
  return code;
}

int stf_checkpoint_view(steif_context *ctx, unsigned char *bytes, size_t count,
                        stf_opened *file)
{
  *file = (stf_opened){.bytes = bytes};
  return look(ctx, "image", count, false, file);
}

void stf_checkpoint_close(steif_context *ctx, stf_opened *file)
{
  stf_release(ctx, file->bytes);
  file->bytes = NULL;
}
