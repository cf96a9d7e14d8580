/* image.c: the parts of an image.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "image.h"
#include "space.h"
#include <stdint.h>
#include <string.h>

void stf_image_stop(stf_image *m, int code)
{
  if (!m->code) m->code = code;
}

/* FNV-1a by words, with the upper half mixed in. */
static unsigned long long mixed(unsigned long long sum, const void *from, size_t bytes)
{
  const unsigned char *b = from;
  for (size_t i = 0; i < bytes; i += sizeof(uint64_t)) {
    uint64_t word = 0;
    memcpy(&word, b + i, bytes - i < sizeof word ? bytes - i : sizeof word);
    sum = (sum ^ word) * 1099511628211u;
    sum ^= sum >> 29;
  }
  return sum;
}

static void put(stf_image *m, const void *from, size_t bytes)
{
  if (!m->at) m->sum = mixed(m->sum, from, bytes);
  if (m->at && bytes <= m->size - m->used) memcpy(m->at + m->used, from, bytes);
  m->used += bytes;
}

static void take(stf_image *m, void *to, size_t bytes)
{
  if (bytes > m->size - m->used) {
    stf_image_stop(m, STEIF_FAIL(m->ctx, STEIF_BAD_INPUT,
                                 "the checkpoint ends before the state it holds: it was made "
                                 "by another build of steif; repeat the run"));
    return;
  }
  memcpy(to, m->from + m->used, bytes);
  m->used += bytes;
}

/* The length of a part, equal on both sides. */
static bool agrees(stf_image *m, size_t bytes)
{
  uint64_t length = bytes;
  if (m->code) return false;
  if (!m->reads) {
    put(m, &length, sizeof length);
    return true;
  }
  take(m, &length, sizeof length);
  if (m->code || length == bytes) return !m->code;
  stf_image_stop(m, STEIF_FAIL(m->ctx, STEIF_BAD_INPUT,
                               "a part of the checkpoint has %llu bytes where %zu belong: it "
                               "was made by another build of steif; repeat the run",
                               (unsigned long long)length, bytes));
  return false;
}

void stf_keep(stf_image *m, void *part, size_t bytes)
{
  if (!agrees(m, bytes) || bytes == 0) return;
  if (m->reads)
    take(m, part, bytes);
  else
    put(m, part, bytes);
}

/* Vectors without a host array are packed by their own operations. */
static void keep_packed(stf_image *m, N_Vector v)
{
  sunindextype size = 0;
  if (!v->ops->nvbufsize || N_VBufSize(v, &size) || size < 0) {
    stf_image_stop(m,
                   STEIF_FAIL(m->ctx, STEIF_UNSUPPORTED,
                              "vectors of this kind have neither a host array nor N_VBufPack: "
                              "they cannot be saved"));
    return;
  }
  void *buffer = stf_allocate(m->ctx, (size_t)size + 1, 1);
  if (!buffer) {
    stf_image_stop(m, STEIF_NO_MEMORY);
    return;
  }
  if (!m->reads) N_VBufPack(v, buffer);
  stf_keep(m, buffer, (size_t)size);
  if (m->reads && !m->code) N_VBufUnpack(v, buffer);
  stf_release(m->ctx, buffer);
}

void stf_keep_vector(stf_image *m, N_Vector v)
{
  if (m->code) return;
  sunrealtype *a = stf_array(v);
  if (a)
    stf_keep(m, a, (size_t)N_VGetLength(v) * sizeof *a);
  else
    keep_packed(m, v);
}

void stf_keep_vectors(stf_image *m, int count, N_Vector *v)
{
  for (int i = 0; i < count; i++) stf_keep_vector(m, v[i]);
}

void stf_keep_count(stf_image *m, size_t *count, size_t most)
{
  uint64_t value = *count;
  STF_KEEP(m, value);
  if (m->code) return;
  if (value > most)
    stf_image_stop(m, STEIF_FAIL(m->ctx, STEIF_BAD_INPUT,
                                 "the checkpoint counts %llu entries where at most %zu belong: "
                                 "it was made by another build of steif; repeat the run",
                                 (unsigned long long)value, most));
  else
    *count = (size_t)value;
}

void stf_keep_presence(stf_image *m, bool present, const char *what)
{
  bool there = present;
  STF_KEEP(m, there);
  if (m->code || there == present) return;
  stf_image_stop(m,
                 STEIF_FAIL(m->ctx, STEIF_BAD_INPUT,
                            "%s %s in the checkpoint and %s here: problem and options must be "
                            "those of the run that was saved",
                            what, there ? "is" : "is not", there ? "is not" : "is"));
}

unsigned long long stf_checksum(const void *bytes, size_t count)
{
  const unsigned char *b = bytes;
  uint64_t sum = 14695981039346656037u;
  for (size_t i = 0; i < count; i++) sum = (sum ^ b[i]) * 1099511628211u;
  return sum;
}
