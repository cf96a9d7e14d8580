/* checkpoint.c: save, load and look.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checkpoint_file.h"
#include <stddef.h>
#include <string.h>

int steif_checkpoint_save(steif_solver *s, const char *path, const void *note,
                          size_t note_bytes)
{
  unsigned char *bytes = NULL;
  size_t count = 0;
  if (!s) return STEIF_BAD_INPUT;
  STEIF_CHECK(path, s->ctx, STEIF_BAD_INPUT, "a checkpoint needs the path of a file, got NULL");
  STEIF_CHECK(!s->agreed, s->ctx, STEIF_UNSUPPORTED,
              "a run over ranks cannot be saved: each rank holds its own rows only");
  STEIF_CHECK(note || !note_bytes, s->ctx, STEIF_BAD_INPUT, "a note of %zu bytes is NULL",
              note_bytes);
  STEIF_TRY(stf_checkpoint_bytes(s, note, note_bytes, &bytes, &count));
  const int code = stf_disk_write(s->ctx, path, bytes, count);
  stf_release(s->ctx, bytes);
  return code;
}

static int open_file(steif_context *ctx, const char *path, stf_opened *file)
{
  unsigned char *bytes = NULL;
  size_t count = 0;
  STEIF_CHECK(path, ctx, STEIF_BAD_INPUT, "a checkpoint needs the path of a file, got NULL");
  STEIF_TRY(stf_disk_read(ctx, path, &bytes, &count));
  return stf_checkpoint_open(ctx, path, bytes, count, file);
}

/* -- load ------------------------------------------------------------------------------------ */

static int check_problem(steif_context *ctx, const steif_problem *p, const stf_identity *id)
{
  const char *name = p && p->name ? p->name : "";
  STEIF_CHECK(p, ctx, STEIF_BAD_INPUT, "a problem is needed, got NULL");
  STEIF_CHECK(!strncmp(name, id->problem, STF_NAME - 1) && p->n == id->n, ctx, STEIF_BAD_INPUT,
              "the checkpoint is of problem '%s' with %lld unknowns, not of '%s' with %lld",
              id->problem, id->n, name, (long long)p->n);
  return STEIF_OK;
}

/* A run that was restarted began elsewhere. */
static void move_start(steif_solver *s, sunrealtype t0)
{
  if (s->problem->t0 == t0) return;
  s->again = *s->problem;
  s->again.t0 = s->step.t0 = t0;
  s->problem = s->step.problem = &s->again;
  if (s->step.system.problem != &s->semilinear) s->step.system.problem = &s->again;
}

static int fill(steif_solver *s, stf_opened *file)
{
  stf_image *m = &file->state;
  STEIF_TRY(stf_identity_check(s, &file->identity));
  move_start(s, file->identity.t0);
  stf_solver_keep(s, m);
  STEIF_CHECK(
    m->code || m->used == m->size, s->ctx, STEIF_BAD_INPUT,
    "the checkpoint holds more than the state of '%s': it was made by another build of "
    "steif; repeat the run",
    s->spec);
  return m->code;
}

static steif_solver *load(steif_context *ctx, const steif_problem *problem, size_t bytes,
                          const steif_options *options, stf_opened *file)
{
  steif_options o = *options;
  if (check_problem(ctx, problem, &file->identity)) return NULL;
  const stf_identity *id = &file->identity;
  o.t1 = problem->t0 + (id->t1_opened - id->t0);
  if (id->t0 == problem->t0) o.t1 = id->t1_opened;
  steif_solver *s = steif_solver_new_sized(bytes, 0, ctx, problem, id->spec, &o);
  if (s && fill(s, file)) steif_solver_free(&s);
  return s;
}

steif_solver *steif_checkpoint_load_sized(size_t problem_bytes, size_t options_bytes,
                                          steif_context *ctx, const char *path,
                                          const steif_problem *problem,
                                          const steif_options *options)
{
  stf_opened file;
  steif_options o = steif_defaults();
  if (!ctx) return NULL;
  steif_forget(ctx);
  if (options && stf_whole(ctx, "steif_options", options, options_bytes, sizeof o, &o))
    return NULL;
  if (open_file(ctx, path, &file)) return NULL;
  steif_solver *s = load(ctx, problem, problem_bytes, &o, &file);
  stf_checkpoint_close(ctx, &file);
  return s;
}

steif_solver *(steif_checkpoint_load)(steif_context *ctx, const char *path,
                                      const steif_problem *problem,
                                      const steif_options *options)
{
  return steif_checkpoint_load_sized(0, 0, ctx, path, problem, options);
}

/* -- copy ------------------------------------------------------------------------------------ */

static int check_copied(steif_solver *s, const steif_problem *problem)
{
  STEIF_CHECK(
    problem != s->given || !problem->begin, s->ctx, STEIF_UNSUPPORTED,
    "callbacks of problem '%s' remember something, as its member begin says: give the "
    "copy a problem with memory of its own",
    problem->name);
  return STEIF_OK;
}

/* A problem that the first solver holds is held by the second, too: it is handed on as a short one. */
static size_t bytes_of(const steif_solver *s, const steif_problem *problem)
{
  return problem == &s->whole ? offsetof(steif_problem, reserved) : 0;
}

steif_solver *steif_solver_copy_sized(size_t problem_bytes, steif_solver *s,
                                      const steif_problem *problem)
{
  unsigned char *bytes = NULL;
  size_t count = 0;
  stf_opened file;
  if (!s) return NULL;
  steif_forget(s->ctx);
  if (!problem) {
    problem = s->given;
    problem_bytes = bytes_of(s, problem);
  }
  if (check_copied(s, problem) || stf_checkpoint_bytes(s, NULL, 0, &bytes, &count) ||
      stf_checkpoint_open(s->ctx, "copy", bytes, count, &file))
    return NULL;
  steif_solver *copy = load(s->ctx, problem, problem_bytes, &s->options, &file);
  stf_checkpoint_close(s->ctx, &file);
  return copy;
}

steif_solver *(steif_solver_copy)(steif_solver *s, const steif_problem *problem)
{
  return steif_solver_copy_sized(0, s, problem);
}

int stf_checkpoint_revive(steif_context *ctx, const steif_problem *problem,
                          const steif_options *options, unsigned char *bytes, size_t count,
                          steif_solver **s)
{
  stf_opened file;
  STEIF_TRY(stf_checkpoint_view(ctx, bytes, count, &file));
  if (*s) {
    const int code = fill(*s, &file);
    if (code) steif_solver_free(s);
    return code;
  }
  *s = load(ctx, problem, 0, options, &file);
  return *s ? STEIF_OK : steif_status(ctx);
}

/* -- look ------------------------------------------------------------------------------------ */

typedef struct reading {
  steif_checkpoint face; /* what others see */
  stf_opened file;
} reading;

steif_checkpoint *steif_checkpoint_read(steif_context *ctx, const char *path)
{
  if (!ctx) return NULL;
  steif_forget(ctx);
  reading *r = stf_allocate(ctx, 1, sizeof *r);
  if (!r) return NULL;
  if (open_file(ctx, path, &r->file)) {
    stf_release(ctx, r);
    return NULL;
  }
  const stf_identity *id = &r->file.identity;
  r->face = (steif_checkpoint){.version = id->version,
                               .problem = id->problem,
                               .method = id->spec,
                               .n = (sunindextype)id->n,
                               .t = id->t,
                               .t1 = id->t1,
                               .steps = id->steps,
                               .finished = id->finished,
                               .repeats = id->repeats,
                               .cpu_s = id->cpu_s,
                               .note = r->file.note,
                               .note_bytes = r->file.note_bytes};
  return &r->face;
}

void steif_checkpoint_free(steif_context *ctx, steif_checkpoint **checkpoint)
{
  if (!ctx || !checkpoint || !*checkpoint) return;
  reading *r = (reading *)*checkpoint;
  stf_checkpoint_close(ctx, &r->file);
  stf_release(ctx, r);
  *checkpoint = NULL;
}
