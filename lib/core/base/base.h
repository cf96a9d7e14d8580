/* base.h: what every room may use: failing with a sentence, memory by pools, spec look-ups.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BASE_H
#define STF_BASE_H

#include <stdbool.h>
#include <steif/base.h>

#define STF_EPS 2.2204460492503131e-16

/* Store code and sentence in ctx, which ends with the name of the code, and return the code. */
int stf_fail(steif_context *ctx, int code, const char *format, ...) STEIF_PRINTF(3, 4);
/* "STEIF_BAD_INPUT" of a code. */

#define STEIF_TRY(call)                                                                        \
  do {                                                                                         \
    const int stf_code_ = (call);                                                              \
    if (stf_code_ != STEIF_OK) return stf_code_;                                               \
  } while (0)

#define STEIF_FAIL(ctx, code, ...) stf_fail(ctx, code, __VA_ARGS__)

#define STEIF_CHECK(condition, ctx, code, ...)                                                 \
  do {                                                                                         \
    if (!(condition)) return STEIF_FAIL(ctx, code, __VA_ARGS__);                               \
  } while (0)

/* A failure that a smaller step may cure: cause and sentence are stored, STEIF_RETRY is returned. */
#define STEIF_RECOVER(ctx, cause, ...) stf_recover(ctx, cause, __VA_ARGS__)
int stf_recover(steif_context *ctx, int cause, const char *format, ...) STEIF_PRINTF(3, 4);

/* While silent, recoverable failures store their cause but make no sentence: for attempts whose refusal
 * is part of normal work. Returns what it was. */
bool stf_silence(steif_context *ctx, bool silent);
/* How many failures there have been: a callback's own is told by it, and not replaced. */
long stf_failures(const steif_context *ctx);

/* The sentence as it stands, in STF_MESSAGE characters, zeros after it; and another one with its code. */
enum { STF_MESSAGE = 1024 };
void stf_message_copy(const steif_context *ctx, char *text);
void stf_message_take(steif_context *ctx, int code, const char *text);

/* Single blocks, zeroed; NULL with the message set when memory is short. */
void *stf_allocate(steif_context *ctx, size_t count, size_t size);
void stf_release(steif_context *ctx, void *block);
/* Do blocks come from the caller of the library? */
bool stf_foreign_memory(const steif_context *ctx);
int stf_threads(const steif_context *ctx);
/* Processes that share analyses with this one (steif/team.h), NULL: none; the number changes with the team. */
struct steif_team;
const struct steif_team *stf_team(const steif_context *ctx, long long *number);
void stf_context_lead(steif_context *ctx, const struct steif_team *team);
/* For a context of another thread: memory from where that of this one is from, and one thread. */
steif_setup stf_setup_alone(const steif_context *ctx);

/* What ranks have to tell each other while a solver is made (agree.h), NULL: none is; returns the one before. */
struct stf_deferred *stf_context_open(steif_context *ctx, struct stf_deferred *opening);
struct stf_deferred *stf_context_opening(const steif_context *ctx);
/* Users of problems that stand in for others (steif_stand_in), and whom this one stands in for, itself: for none. */
struct stf_stand_in **stf_context_stand_ins(steif_context *ctx);
void *stf_own_user(steif_context *ctx, void *user);

/* A pool owns blocks and vectors that live and die together. Claims return NULL with the message
 * set; stf_pool_free accepts NULL and half-built pools. */
typedef struct stf_pool stf_pool;
stf_pool *stf_pool_new(steif_context *ctx);
void *stf_pool_array(stf_pool *pool, size_t count, size_t size);
N_Vector stf_pool_vector(stf_pool *pool, N_Vector like);
/* A serial vector like `like` (serial) on an array that lives as long as the pool. */
N_Vector stf_pool_view(stf_pool *pool, N_Vector like, sunrealtype *data);
/* `count` clones of `like`, zeroed, as one array. */
N_Vector *stf_pool_vectors(stf_pool *pool, int count, N_Vector like);
/* Call destroy(object) when the pool goes; on failure destroys at once and returns NO_MEMORY. */
int stf_pool_adopt(stf_pool *pool, void *object, void (*destroy)(void *object));
/* What was claimed and adopted after a mark goes, and its memory serves again. */
typedef struct stf_pool_mark {
  void *blocks, *objects;
  char *at;
  size_t left;
} stf_pool_mark;
stf_pool_mark stf_pool_here(const stf_pool *pool);
void stf_pool_release(stf_pool *pool, stf_pool_mark mark);
void stf_pool_free(stf_pool **pool);

/* Parameters of a spec, with range check; `fallback` when absent. */
int stf_spec_int(steif_context *ctx, const steif_spec *spec, const char *key, int lowest,
                 int highest, int fallback, int *value);
int stf_spec_real(steif_context *ctx, const steif_spec *spec, const char *key,
                  sunrealtype lowest, sunrealtype highest, sunrealtype fallback,
                  sunrealtype *value);
/* NULL when absent. */
const char *stf_spec_word(const steif_spec *spec, const char *key);
/* Refuse parameters not in `keys`, a NULL-terminated list ("" allows a bare word). */
int stf_spec_only(steif_context *ctx, const steif_spec *spec, const char *const *keys);

/* The name of the list nearest to `wrong` in edit distance; NULL where none is near: a third of the letters may be
 * wrong. `list[i]` is read through `stride` bytes so that the names may be the first member of structs. */
const char *stf_nearest(const char *wrong, const void *list, size_t count, size_t stride);
/* "; did you mean 'NAME'?" of that name; nothing where none is near. */
enum { STF_GUESS = STEIF_SPEC_WORD + 32 };
const char *stf_guess(const char *wrong, const void *list, size_t count, size_t stride,
                      char text[STF_GUESS]);
bool stf_near(const char *wrong, const char *name);
/* That distance. */
int stf_distance(const char *a, const char *b);

#endif
