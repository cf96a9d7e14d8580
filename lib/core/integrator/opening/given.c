/* given.c: the structs of the caller as the solver keeps them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <stddef.h>

/* A problem over ranks brings its vectors; with others its callbacks would read what is not there. */
static int take_vectors(steif_solver *s)
{
  N_Vector like = s->problem ? s->problem->like : NULL;
  if (!like) return STEIF_OK;
  if (!s->options.like) s->options.like = like;
  STEIF_CHECK(stf_spread(s->options.like) || !stf_spread(like), s->ctx, STEIF_BAD_INPUT,
              "the callbacks of problem '%s' take vectors over ranks, and options.like is of "
              "one process: leave it NULL, or give the vector that steif_mpi_open was given",
              s->problem->name);
  return STEIF_OK;
}

/* The structs of the caller, in the solver where his are shorter or longer than ours. */
int stf_take_given(steif_solver *s, const steif_problem *problem, size_t problem_bytes,
                   const steif_options *options, size_t options_bytes)
{
  STEIF_TRY(stf_whole_problem(s->ctx, problem, problem_bytes, &s->whole, &s->problem));
  if (s->problem && !s->problem->name) {
    s->whole = *s->problem, s->problem = &s->whole;
    s->whole.name = "unnamed"; /* in messages */
  }
  s->given = s->problem;
  s->options = steif_defaults();
  if (options)
    STEIF_TRY(stf_whole(s->ctx, "steif_options", options, options_bytes, sizeof s->options,
                        &s->options));
  STEIF_TRY(stf_reserved_check(s->ctx, "steif_options", STF_COUNT(s->options.reserved),
                               s->options.reserved));
  if (s->problem)
    STEIF_TRY(stf_reserved_check(s->ctx, "steif_problem", STF_COUNT(s->problem->reserved),
                                 s->problem->reserved));
  STEIF_TRY(take_vectors(s));
  return stf_look_at_pattern(s);
}

/* Vectors by which ranks agree, before the structs are looked at. */
N_Vector stf_like_given(const steif_problem *p, size_t problem_bytes, const steif_options *o,
                        size_t options_bytes)
{
  const size_t of_p = offsetof(steif_problem, like) + sizeof p->like,
               of_o = offsetof(steif_options, like) + sizeof o->like;
  if (p && (!problem_bytes || problem_bytes >= of_p) && p->like) return p->like;
  return o && (!options_bytes || options_bytes >= of_o) ? o->like : NULL;
}
