/* steif/checkpoint.h: runs that go on: another day, in another process, twice, further, or from another state.
 *
 *   steif_checkpoint_save(s, "run.ck", NULL, 0);                   after any accepted step
 *   s = steif_checkpoint_load(ctx, "run.ck", &problem, &options);  goes on there
 *
 * A checkpoint holds all that the next steps depend on: the history of the method, step size control, rates and
 * ages of Newton's iteration, matrices and factors, events, the solution shown, statistics. With the
 * same library and the same kind of processor the continuation is that of the run that was saved bit for bit, at any
 * step, of every method of steif. What it does not hold are the problem and the options, which the
 * caller gives again; what the callbacks remember comes by the members begin, save and restore of the
 * problem.
 *
 * A file is written beside `path`, as path.part, and takes its name when it is complete and on the disk: whatever
 * happens, `path` is a whole checkpoint, the new or the last. Two runs need two paths. Refused, with the reason, and nothing is changed:
 *   STEIF_IO            cannot be read or written, no checkpoint, cut short, damaged (a checksum tells)
 *   STEIF_UNSUPPORTED   of another version or kind of machine; a repeated run that does not come to the same bits
 *   STEIF_BAD_INPUT     of another problem (name, size, form, values at the start), other options
 * CVODE, IDA, ARKODE and descriptor keep their history to themselves: loading such a run repeats it from t0, at the
 * cost that steif_checkpoint_read tells, without calls of options.observe and on_event; it must come to the same bits.
 * A file is trusted as far as its checksum: take none from strangers.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_CHECKPOINT_H
#define STEIF_CHECKPOINT_H

#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a file says of itself. */
typedef struct steif_checkpoint {
  const char *version, *problem, *method; /* of steif; name; spec */
  sunindextype n;
  sunrealtype t, t1; /* reached, end of the run */
  long steps;
  int finished;      /* t1, or an event that ends the run, is reached */
  int repeats;       /* loading repeats the run from t0, in about ... */
  sunrealtype cpu_s; /* ... as many processor seconds as it has taken so far */
  const void *note;  /* the bytes of the caller of steif_checkpoint_save */
  size_t note_bytes;
} steif_checkpoint;

/* Between two calls of the solver, or in options.observe, there not before an event is handled: STEIF_BAD_INPUT.
 * note: bytes of the caller's own, kept with the rest; NULL: none. */
STEIF_EXPORT int steif_checkpoint_save(steif_solver *s, const char *path, const void *note,
                                       size_t note_bytes);

/* NULL with the message set. The method is that of the file. Options that decide on steps (rtol, atol,
 * atols, ewt, h, mesh, h0, h_max, newton, iterations, storage, start, initial, attributes) must be those of
 * the run that was saved; t1 is that of the file, whatever the options say: steif_solver_extend moves it. */
STEIF_EXPORT steif_solver *steif_checkpoint_load(steif_context *ctx, const char *path,
                                                 const steif_problem *problem,
                                                 const steif_options *options);
STEIF_EXPORT steif_solver *steif_checkpoint_load_sized(size_t problem_bytes,
                                                       size_t options_bytes, steif_context *ctx,
                                                       const char *path,
                                                       const steif_problem *problem,
                                                       const steif_options *options);
#define steif_checkpoint_load(...) steif_checkpoint_load_sized(STEIF_SIZES, __VA_ARGS__)

/* Facts and note of a file, whole and unharmed; NULL with the message set. */
STEIF_EXPORT steif_checkpoint *steif_checkpoint_read(steif_context *ctx, const char *path);
STEIF_EXPORT void steif_checkpoint_free(steif_context *ctx, steif_checkpoint **checkpoint);

/* -- further, twice, from another state ------------------------------------------------------- */

/* Another end of the run, t1 > the time reached: later than before, or earlier. The run goes on with all its history;
 * its last step had ended at the old t1, else it is the run that had this t1 from the start. Constant steps are
 * counted from here. STEIF_BAD_INPUT: meshes, runs that an event has ended; nothing is changed. */
STEIF_EXPORT int steif_solver_extend(steif_solver *s, sunrealtype t1);

/* A second solver that goes on as the first would, to the same bits. NULL with the message set.
 * problem NULL: the same; callbacks that remember something (begin) need a problem with memory of its own. */
STEIF_EXPORT steif_solver *steif_solver_copy(steif_solver *s, const steif_problem *problem);
STEIF_EXPORT steif_solver *steif_solver_copy_sized(size_t problem_bytes, steif_solver *s,
                                                   const steif_problem *problem);
#define steif_solver_copy(...) steif_solver_copy_sized(sizeof(steif_problem), __VA_ARGS__)

/* Begin again at (t, y), with slopes yp where they are known (else NULL), counts from zero. Memory, matrices and the
 * analysis of their pattern stay. problem NULL: the same, whose parameters may have changed; else another one of
 * the same name, size, form and storage, with a pattern and callbacks in the same members. options NULL: the same
 * with their t1, else all anew; steps stay chosen by the tolerance or constant; atols and ewt may come, not go.
 * begin of the problem is called. A start is taken as it is given: make that of a DAE consistent before
 * (consistent.h). STEIF_BAD_INPUT, STEIF_UNSUPPORTED (engines): nothing is changed. After other
 * failures the solver can be restarted or freed. */
STEIF_EXPORT int steif_solver_restart(steif_solver *s, sunrealtype t, N_Vector y, N_Vector yp,
                                      const steif_problem *problem,
                                      const steif_options *options);
STEIF_EXPORT int steif_solver_restart_sized(size_t problem_bytes, size_t options_bytes,
                                            steif_solver *s, sunrealtype t, N_Vector y,
                                            N_Vector yp, const steif_problem *problem,
                                            const steif_options *options);
#define steif_solver_restart(...) steif_solver_restart_sized(STEIF_SIZES, __VA_ARGS__)

#ifdef __cplusplus
}
#endif
#endif
