/* c_events.c: events of a model in C: the same rules as events/reactions.c and events/event_values.c, over tables.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "native.h"
#include "reactions.h"
#include <stdio.h>

static stf_reaction *reaction(const stf_model *m, size_t i)
{
  return STF_AT(m->reactions->list, stf_reaction, i);
}

static void sizes(stf_writer *w, const stf_model *m)
{
  stf_write(w,
            "enum { UNKNOWNS = %d, DISCRETES = %d, SWITCHES = %d, TIMERS = %d, MEMORIES = %d,\n"
            "       REACTIONS = %zu, TARGETS = %zu, IN_EQUATIONS = %d, IS_ODE = %d };\n",
            (int)m->n, (int)m->discretes, (int)m->switches, (int)m->timers, (int)m->memories,
            m->reactions->list.count, m->reactions->targets.count,
            (int)m->reactions->equation_switches, m->form == STEIF_ODE);
  stf_write(w, "static const double SPAN = ");
  stf_write_number(w, stf_span(m));
  stf_write_text(w, ";\n");
}

static void reals(stf_writer *w, const char *name, size_t which, int32_t count, const double *x)
{
  stf_write(w, "static const double %s%zu[%d] = {", name, which, (int)count + 1);
  for (int32_t i = 0; i < count; i++) {
    stf_write_number(w, x[i]);
    stf_write_text(w, ", ");
  }
  stf_write_text(w, "0};\n");
}

static void used(stf_writer *w, const stf_model *m)
{
  stf_write_text(w, "static const unsigned char used[SWITCHES + 1] = {");
  for (int32_t i = 0; i < m->switches; i++) stf_write(w, "%d,", m->switch_used[i]);
  stf_write_text(w, "0};\nstatic const steif_event event_list[SWITCHES + TIMERS + 1] = {\n");
  for (int32_t i = 0; i < m->switches + m->timers; i++) {
    stf_write_text(w, "  {.name = ");
    if (m->event_list[i].name)
      stf_write_string(w, m->event_list[i].name);
    else
      stf_write_text(w, "0");
    stf_write(w, ", .direction = %d},\n", m->event_list[i].direction);
  }
  stf_write_text(w, "  {0, 0, 0}};\n");
}

static void lists(stf_writer *w, const stf_model *m)
{
  const stf_reactions *r = m->reactions;
  reals(w, "memory_start", 0, m->memories, m->memory_start);
  stf_write_text(w, "#define memory_start memory_start0\n");
  used(w, m);
  for (size_t i = 0; i < r->list.count; i++)
    if (reaction(m, i)->times)
      reals(w, "times", i, reaction(m, i)->time_count, reaction(m, i)->times);
  stf_write_text(w, "static const struct target targets[TARGETS + 1] = {");
  for (size_t i = 0; i < r->targets.count; i++) {
    const stf_target *t = STF_AT(r->targets, stf_target, i);
    stf_write(w, "{%d, %d}, ", (int)t->state, (int)t->memory);
  }
  stf_write_text(w, "{-1, 0}};\n");
}

static void reaction_list(stf_writer *w, const stf_model *m)
{
  static const char *const trigger[] = {"BECOMES_TRUE", "CHANGES", "TIMER", "REQUIREMENT"};
  stf_write_text(w, "static const struct reaction reactions[REACTIONS + 1] = {\n");
  for (size_t i = 0; i < m->reactions->list.count; i++) {
    const stf_reaction *r = reaction(m, i);
    stf_write(w,
              "  {.trigger = %s, .stops = %d, .first = %d, .count = %d, .memory = %d, .times = "
              "%d, .from = ",
              trigger[r->trigger], r->stops, (int)r->first, (int)r->count, (int)r->memory,
              (int)r->time_count);
    stf_write_number(w, r->from);
    stf_write_text(w, ", .period = ");
    stf_write_number(w, r->period);
    stf_write_text(w, ", .unit = ");
    stf_write_number(w, r->unit);
    if (r->times) stf_write(w, ", .time = times%zu", i);
    if (r->count) stf_write(w, ", .values = action%zu_0", i);
    stf_write_text(w, "},\n");
  }
  stf_write_text(w, "  {0}};\n");
}

static void all(stf_writer *w, const char *name, const stf_quantity *q, const char *memory,
                const char *to)
{
  for (size_t i = 0; i < q->tapes.count; i++)
    stf_write(w, "  %s_%zu(t, y, 0, parameter, %s, %s);\n", name, i, memory, to);
}

void stf_write_event_values(stf_writer *w, const stf_model *m)
{
  sizes(w, m);
  stf_write_text(w, stf_c_state);
  lists(w, m);
  stf_write_quantity(w, &(stf_dialect){.name = "event", .standalone = true, .store = "static "},
                     &m->events);
  stf_write_quantity(
    w, &(stf_dialect){.name = "condition", .standalone = true, .store = "static "},
    &m->reactions->conditions);
  for (size_t i = 0; i < m->reactions->list.count; i++) {
    char name[32];
    stf_reaction *r = reaction(m, i);
    snprintf(name, sizeof name, "action%zu", i);
    const stf_quantity q = {.tapes = {.data = &r->tape, .count = r->count > 0}};
    stf_write_quantity(w, &(stf_dialect){.name = name, .standalone = true, .store = "static "},
                       &q);
  }
  stf_write_text(
    w,
    "static void event_values(double t, const double *y, const double *memory, double *g)\n{\n"
    "  for (int i = 0; i < SWITCHES + TIMERS; i++) g[i] = i < SWITCHES && !used[i];\n");
  all(w, "event", &m->events, "memory", "g");
  stf_write_text(w, "}\nstatic void ask(double t, const double *y)\n{\n  (void)t, (void)y;\n"
                    "  memset(truths, 0, sizeof truths);\n");
  all(w, "condition", &m->reactions->conditions, "run.memory", "truths");
  stf_write_text(w, "}\n");
  stf_write_text(w, stf_c_relations);
}

void stf_write_events(stf_writer *w, const stf_model *m)
{
  reaction_list(w, m);
  if (m->form != STEIF_ODE) stf_write_text(w, stf_c_slope);
  stf_write_text(
    w, "static int slopes(double t, const double *y, double *out)\n{\n  (void)t, (void)y, "
       "(void)out;\n");
  if (m->form == STEIF_ODE) {
    if (m->f.size && !m->f.assigns)
      stf_write_text(w, "  memset(out, 0, UNKNOWNS * sizeof *out);\n");
    all(w, "f", &m->f, "run.memory", "out");
    stf_write_text(w, "  return 1;\n}\n");
  } else {
    if (m->yp0)
      stf_write_text(
        w, "  if (y == start) return memcpy(out, start_slope, UNKNOWNS * sizeof *out), 1;\n");
    stf_write_text(
      w, "  if (t == run.slope_at) return memcpy(out, slope_now, sizeof slope_now), 1;\n"
         "  return 0;\n}\n");
  }
  stf_write_text(w, stf_c_rules);
  stf_write_text(w, stf_c_turning);
  stf_write_text(w, stf_c_handling);
  stf_write_text(w, stf_c_moving);
}
