/* reactions.h: what happens at events: conditions that become true, times that
 * come, and assignments. SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_REACTIONS_H
#define STF_REACTIONS_H

#include "model.h"

typedef struct stf_target {
  int32_t state, memory; /* one of them; the other -1 */
  int32_t statement;
} stf_target;

/* Of relations whose g is 0 or rounding after an event: fired; brought to 0 by others, where it may stay; still
 * there, or seen to stay. */
enum stf_openness { STF_OPEN = 1, STF_AT_ZERO, STF_STAYS };

/* What g of a relation is of: time alone; discrete values and other relations, too. */
enum stf_use { STF_OF_STATE = 1, STF_OF_TIME, STF_OF_OTHERS };

/* What an event is, for its direction: a relation that holds where g < 0, or g > 0; an expression that has the sign of
 * g, or of -g; a time; a part of floor, mod or of a table. */
enum stf_event_sort {
  STF_TRUE_FALLING,
  STF_TRUE_RISING,
  STF_TURN,
  STF_TURN_BACK,
  STF_INSTANT,
  STF_OTHER_PART
};

enum stf_trigger { STF_BECOMES_TRUE, STF_CHANGES, STF_TIMER, STF_REQUIREMENT };

typedef struct stf_reaction {
  uint8_t trigger, stops, pending, truth,
    before; /* truth of its condition now, and at the start */
  int32_t statement;
  stf_tape tape; /* values of its assignments */
  double *space;
  int32_t first, count; /* targets */
  /* timers */
  int32_t memory;            /* the next time */
  double from, period, unit; /* every: (from + k period)/unit, k = 1, 2, ... or 0, 1, ... */
  double *times;             /* at: these */
  int32_t time_count, done;  /* done: how many have come */
} stf_reaction;

/* A statement by its place in the texts. */
typedef struct stf_placed {
  uint32_t at;
  int32_t statement;
} stf_placed;

typedef struct stf_reactions {
  stf_vector list, targets;  /* stf_reaction, stf_target */
  stf_quantity conditions;   /* truth of the condition of each reaction */
  int32_t equation_switches; /* the first so many switches stand in equations */
  double *truths, *values;
  stf_placed *placed; /* all statements, ascending */
} stf_reactions;

/* event_statements.c: compile all; members of the problem. */
int stf_build_events(stf_model *m);
void stf_reactions_free(stf_model *m);
/* Its times or period with the present parameters. */
int stf_timer_read(stf_model *m, stf_reaction *r);
/* event_names.c: what events are in the words of the text, all passes of a relation and those of `at` or `every`; into
 * event_list and event_sort. "true", "falling", ... of event number `which`. */
/* Before names: reactions->placed. */
int stf_order_statements(stf_model *m);
int stf_name_relation(stf_model *m, const stf_block *block, const stf_switch *s);
int stf_name_timer(stf_model *m, const stf_statement *s, int32_t which);
const char *stf_event_turn(const stf_model *m, int32_t which, int direction);
/* event_values.c */
void stf_event_values(const stf_model *m, double t, const double *y, double *g);
int stf_event_callback(sunrealtype t, N_Vector y, sunrealtype *g, void *user);
/* g of relations of time alone a moment after t (ahead = 1) or before (-1), where it is clear; else 0. */
void stf_event_sides(const stf_model *m, double t, const double *y, int ahead, double *g);
/* After an event at (t, y), with g there in event_values[1]. */
void stf_event_move(const stf_model *m, double t, const double *y, const int *fired);
/* reactions.c: at the start of a run, and at an event. */
int stf_reactions_begin(sunrealtype t, void *user);
int stf_reactions_slope(sunrealtype t, N_Vector y, N_Vector yp, void *user);
int stf_reactions_handle(sunrealtype t, N_Vector y, const int *fired, void *user);
/* Parameters have moved in the midst of a run: conditions, assignments and the next times follow. */
int stf_reactions_follow(stf_model *m);
/* event_state.c: what begin resets, for checkpoints. */
long stf_reactions_save(void *bytes, void *user);
int stf_reactions_restore(const void *bytes, size_t count, void *user);
/* Truths of all relations at a point, into memory. */
void stf_literal_switches(const stf_model *m, double t, const double *y, double *memory);

#endif
