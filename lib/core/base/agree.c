/* agree.c: one decision for all ranks that vectors are spread over.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "agree.h"
#include "image.h"
#include "rank.h"
#include <stdint.h>
#include <string.h>

enum { MOST = 256 };

/* x_i summed over the ranks; integers below 2^53 exactly, in any order. */
static void sum(N_Vector like, int count, sunrealtype *x)
{
  like->ops->nvdotprodmultiallreduce(count, like, x);
}

int stf_agree_check(steif_context *ctx, N_Vector like)
{
  if (!like || !stf_spread(like)) return STEIF_OK;
  STEIF_CHECK(
    like->ops->nvdotprodmultiallreduce, ctx, STEIF_UNSUPPORTED,
    "options.like is spread over ranks and has no operation nvdotprodmultiallreduce, by "
    "which they agree on failures");
  return STEIF_OK;
}

static bool alone(N_Vector like)
{
  return !like || !stf_spread(like) || !like->ops->nvdotprodmultiallreduce;
}

/* The ranks with the largest of 53 bit keys among those that stand: bit by bit, those without it step back
 * where another has it. `count`: how many stand. Returns how many they are, *stands whether this is one. */
static sunrealtype elect(N_Vector like, uint64_t key, sunrealtype count, bool *stands)
{
  if (count == 1) return count;
  for (int bit = 52; bit >= 0; bit--) {
    const bool has = *stands && (key >> bit & 1);
    sunrealtype having = has;
    sum(like, 1, &having);
    if (having > 0) *stands = has;
  }
  count = *stands;
  sum(like, 1, &count);
  return count;
}

/* The lowest of `count` ranks that stand; returns how many remain, *told its number. */
static sunrealtype lowest(N_Vector like, sunrealtype count, bool *stands, int *told)
{
  const uint64_t last = (uint64_t)1 << 31;
  const int own = stf_own_rank(like);
  count = elect(like, last - (uint64_t)(own + 1), count, stands);
  sunrealtype of_all = *stands ? own : 0;
  sum(like, 1, &of_all);
  *told = (int)(of_all / count);
  return count;
}

/* How many ranks come before the one with the number `told`, which is its number in the communicator, also where the
 * launcher told it; and how many rows they have. */
static int number_of(N_Vector like, int told, sunindextype rows, long long *first)
{
  const bool before = told >= 0 && stf_own_rank(like) < told;
  sunrealtype of_all[] = {before, before ? (sunrealtype)rows : 0};
  sum(like, 2, of_all);
  *first = (long long)of_all[1];
  return told < 0 ? -1 : (int)of_all[0];
}

/* Some rank has failed: which, and with what. */
static int returned_by(N_Vector like, int returned, sunrealtype failed, long *id, int *rank)
{
  bool stands = returned != 0;
  int told;
  long long first;
  const uint64_t size = returned < 0 ? -(uint64_t)returned : (uint64_t)returned;
  sunrealtype count = elect(like, (uint64_t)(returned < 0) << 52 | size, failed, &stands);
  count = lowest(like, count, &stands, &told);
  sunrealtype of_all[] = {stands ? returned : 0, stands ? (sunrealtype)*id : 0};
  sum(like, 2, of_all);
  *id = (long)(of_all[1] / count), *rank = number_of(like, told, 0, &first);
  return (int)(of_all[0] / count);
}

bool stf_agree_lowest(N_Vector like, bool fault, sunindextype rows, int *rank, long long *first)
{
  bool stands = fault;
  int told;
  sunrealtype count = fault;
  *rank = -1, *first = 0;
  if (alone(like)) return fault;
  sum(like, 1, &count);
  if (count == 0) return false;
  lowest(like, count, &stands, &told);
  *rank = number_of(like, told, rows, first);
  return stands;
}

int stf_agree_returned(N_Vector like, int returned)
{
  long id = 0;
  int rank;
  if (alone(like)) return returned;
  sunrealtype failed = returned != 0;
  sum(like, 1, &failed);
  return failed == 0 ? 0 : returned_by(like, returned, failed, &id, &rank);
}

int stf_deferred_settle(N_Vector like, stf_deferred *d, const char **name)
{
  sunrealtype failed = d->returned != 0;
  sum(like, 1, &failed);
  const int returned =
    failed == 0 ? 0 : returned_by(like, d->returned, failed, &d->id, &d->rank);
  *name = d->name(d->id);
  d->returned = 0;
  return returned;
}

int stf_deferred_gate(N_Vector like, stf_deferred *d)
{
  if (!d->opening || alone(like)) return 0;
  if (!d->gone) stf_agree_any(like, 1, &d->gone);
  return d->gone ? -1 : 0;
}

int stf_sum_gate(steif_context *ctx)
{
  stf_deferred *opening = stf_context_opening(ctx);
  if (!opening || !stf_deferred_gate(opening->like, opening)) return STEIF_OK;
  return STEIF_FAIL(ctx, STEIF_NO_MEMORY, "another rank could not make its solver");
}

int stf_clone_gate(steif_context *ctx, N_Vector like)
{
  const bool local = N_VGetVectorID(like) == SUNDIALS_NVEC_PARALLEL || !stf_spread(like);
  return local ? STEIF_OK : stf_sum_gate(ctx);
}

int stf_deferred_leave(steif_context *ctx, N_Vector like, stf_deferred *d, int code)
{
  bool failed = code != 0;
  if (alone(like)) return code;
  if (!d->gone) stf_agree_any(like, 1, &failed);
  d->opening = false;
  return stf_agree(ctx, like, d->gone ? 0 : code);
}

int stf_deferred_add(N_Vector like, stf_deferred *d, int returned, long id)
{
  const char *name;
  const bool worse = returned && (!d->returned || (returned < 0 && d->returned > 0));
  if (worse) d->returned = returned, d->id = id;
  if (d->on) return 0;
  ++*d->sums;
  return stf_deferred_settle(like, d, &name);
}

/* Ranks that win have the same text, up to collisions of 51 bits: the text that all get is the mean. */
static void take_text(N_Vector like, char *text, size_t size, bool mine, sunrealtype count)
{
  sunrealtype letter[MOST];
  for (size_t from = 0; from < size; from += MOST) {
    const size_t most = size - from < MOST ? size - from : MOST;
    for (size_t i = 0; i < most; i++) letter[i] = mine ? (unsigned char)text[from + i] : 0;
    sum(like, (int)most, letter);
    for (size_t i = 0; i < most; i++) text[from + i] = (char)(unsigned char)(letter[i] / count);
  }
  text[size - 1] = 0;
}

int stf_agree(steif_context *ctx, N_Vector like, int code)
{
  return stf_agree_flags(ctx, like, code, 0, NULL);
}

int stf_agree_flags(steif_context *ctx, N_Vector like, int code, int count_flags, bool *flag)
{
  if (alone(like)) return code;
  sunrealtype set[8] = {code != 0};
  for (int i = 0; i < count_flags; i++) set[1 + i] = flag[i];
  sum(like, 1 + count_flags, set);
  for (int i = 0; i < count_flags; i++) flag[i] = set[1 + i] > 0;
  const sunrealtype failed = set[0];
  if (failed == 0) return STEIF_OK;
  char text[STF_MESSAGE] = "";
  bool stands = code != 0;
  if (stands) stf_message_copy(ctx, text);
  const bool own = stands && steif_status(ctx) != STEIF_CALLBACK; /* a reason, not a number */
  const uint64_t name = stf_checksum(text, sizeof text) >> 13;
  const uint64_t key = (uint64_t)(code < 0) << 52 | (uint64_t)own << 51 | name;
  const sunrealtype count = elect(like, key, failed, &stands);
  sunrealtype numbers[] = {stands ? code : 0, stands ? steif_status(ctx) : 0};
  sum(like, 2, numbers);
  take_text(like, text, sizeof text, stands, count);
  stf_message_take(ctx, (int)(numbers[1] / count), text);
  return (int)(numbers[0] / count);
}

void stf_agree_any(N_Vector like, int count, bool *flag)
{
  sunrealtype set[8];
  if (alone(like)) return;
  for (int i = 0; i < count; i++) set[i] = flag[i];
  sum(like, count, set);
  for (int i = 0; i < count; i++) flag[i] = set[i] > 0;
}

long long stf_agree_total(N_Vector like, long long part)
{
  sunrealtype total = (sunrealtype)part;
  if (alone(like)) return part;
  sum(like, 1, &total);
  return (long long)total;
}

/* A sum of P numbers is P times the mean, and so is the sum of squares with the square, only where they are
 * equal: for pieces of 16 bits of a checksum, in integers. */
bool stf_agree_same(N_Vector like, const void *bytes, size_t count)
{
  enum { PIECES = 4 };
  if (alone(like)) return true;
  const uint64_t mine = stf_checksum(bytes, count);
  sunrealtype s[1 + 2 * PIECES] = {1};
  for (int k = 0; k < PIECES; k++) {
    const sunrealtype piece = (sunrealtype)(mine >> 16 * k & 0xffff);
    s[1 + 2 * k] = piece, s[2 + 2 * k] = piece * piece;
  }
  sum(like, 1 + 2 * PIECES, s);
  bool same = true;
  for (int k = 0; k < PIECES; k++) {
    const uint64_t ranks = (uint64_t)s[0], first = (uint64_t)s[1 + 2 * k];
    same = same && ranks * (uint64_t)s[2 + 2 * k] == first * first;
  }
  return same;
}

long stf_agree_different(N_Vector like, size_t count, const unsigned long long *number)
{
  if (stf_agree_same(like, number, count * sizeof *number)) return -1;
  for (size_t i = 0; i < count; i++)
    if (!stf_agree_same(like, &number[i], sizeof *number)) return (long)i;
  return -1;
}
