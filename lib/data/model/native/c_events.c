/* c_events.c: events of a model in C: the same rules as events/reactions.c and events/event_values.c, over tables.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "native.h"
#include "reactions.h"
#include <stdio.h>

static const char state[] =
  "/* What a run remembers: discrete values, truths of relations, next times; begin() resets "
  "it. One run at a\n"
  " * time: copies of this file in programs with threads need a state of their own each. */\n"
  "static struct run {\n"
  "  double memory[MEMORIES + 1], shift[SWITCHES + 1], range[SWITCHES + 1];\n"
  "  unsigned char open[SWITCHES + 1], truth[REACTIONS + 1], pending[REACTIONS + 1];\n"
  "  int done[REACTIONS + 1];\n"
  "} run;\n"
  "static double literal[MEMORIES + 1], before[SWITCHES + TIMERS + 1], after[SWITCHES + TIMERS "
  "+ 1],\n"
  "  truths[REACTIONS + 1];\n"
  "enum { BECOMES_TRUE, CHANGES, TIMER, REQUIREMENT };\n"
  "struct reaction {\n"
  "  int trigger, stops, first, count, memory, times;\n"
  "  double from, period;\n"
  "  const double *time;\n"
  "  void (*values)(double t, const double *restrict y, const double *restrict yp,\n"
  "                 const double *restrict p, const double *restrict m, double *restrict "
  "out);\n"
  "};\n"
  "struct target { int state, memory; };\n";

/* After event_values(). */
static const char relations[] =
  "static void literal_switches(double t, const double *y, double *memory)\n"
  "{\n"
  "  event_values(t, y, after);\n"
  "  for (int i = 0; i < SWITCHES; i++) memory[DISCRETES + i] = after[i] < 0;\n"
  "}\n"
  "/* A frozen branch may have no value a little beyond its border: relations as they are "
  "here. */\n"
  "static void take_literally(double t, const double *y)\n"
  "{\n"
  "  memcpy(literal, run.memory, sizeof literal);\n"
  "  literal_switches(t, y, literal);\n"
  "}\n"
  "static int all_finite(const double *x, long count)\n"
  "{\n"
  "  for (long i = 0; i < count; i++)\n"
  "    if (!isfinite(x[i])) return 0;\n"
  "  return 1;\n"
  "}\n\n";

/* After f and the tables. */
static const char rules[] =
  "static int event(sunrealtype t, N_Vector y, sunrealtype *g, void *user)\n"
  "{\n"
  "  (void)user;\n"
  "  event_values(t, N_VGetArrayPointer(y), g);\n"
  "  for (int i = 0; i < SWITCHES; i++) {\n"
  "    run.range[i] = fmax(run.range[i], fabs(g[i]));\n"
  "    if (g[i] * run.shift[i] > 0 && fabs(g[i]) > 1e3 * fabs(run.shift[i])) run.shift[i] = "
  "0;\n"
  "    g[i] += run.shift[i];\n"
  "  }\n"
  "  return 0;\n"
  "}\n"
  "static void set_timer(int i)\n"
  "{\n"
  "  const struct reaction *r = &reactions[i];\n"
  "  run.memory[r->memory] = !r->time                ? r->from + run.done[i] * r->period\n"
  "                          : run.done[i] < r->times ? r->time[run.done[i]]\n"
  "                                                   : 1e300;\n"
  "}\n"
  "static void start_timer(int i, double t)\n"
  "{\n"
  "  const struct reaction *r = &reactions[i];\n"
  "  run.done[i] = 0;\n"
  "  if (!r->time && t >= r->from) run.done[i] = (int)fmin(floor((t - r->from) / r->period), "
  "1e9);\n"
  "  do {\n"
  "    set_timer(i);\n"
  "  } while (run.memory[r->memory] <= t && ++run.done[i]);\n"
  "}\n"
  "/* Relations whose g is 0: a short step along y' = f tells. */\n"
  "static void look_ahead(double t, const double *at)\n"
  "{\n"
  "  static double y[UNKNOWNS];\n"
  "  const double h = 1e-8 * SPAN;\n"
  "  slopes(t, at, y);\n"
  "  for (int i = 0; i < UNKNOWNS; i++) y[i] = at[i] + h * y[i];\n"
  "  event_values(t + h, y, after);\n"
  "  for (int i = 0; i < SWITCHES; i++)\n"
  "    if (run.open[i] && isfinite(after[i])) run.memory[DISCRETES + i] = after[i] < 0;\n"
  "}\n"
  "static int begin(sunrealtype t, void *user)\n"
  "{\n"
  "  int any = 0;\n"
  "  (void)user;\n"
  "  memset(&run, 0, sizeof run);\n"
  "  memcpy(run.memory, memory_start, sizeof run.memory);\n"
  "  for (int i = 0; i < REACTIONS; i++)\n"
  "    if (reactions[i].trigger == TIMER) start_timer(i, t);\n"
  "  literal_switches(t, start, run.memory);\n"
  "  event_values(t, start, before);\n"
  "  for (int i = 0; i < SWITCHES; i++) any |= run.open[i] = before[i] == 0;\n"
  "  if (any && IS_ODE) look_ahead(t, start);\n"
  "  ask(t, start);\n"
  "  for (int i = 0; i < REACTIONS; i++) run.truth[i] = truths[i] != 0;\n"
  "  return 0;\n"
  "}\n";

static const char handling[] =
  "static int find_pending(double t, const double *y)\n"
  "{\n"
  "  int any = 0;\n"
  "  ask(t, y);\n"
  "  for (int i = 0; i < REACTIONS; i++) {\n"
  "    const int now = truths[i] != 0, trigger = reactions[i].trigger;\n"
  "    if (trigger != TIMER) {\n"
  "      if (trigger == CHANGES ? now != run.truth[i] : now && !run.truth[i]) run.pending[i] = "
  "1;\n"
  "      run.truth[i] = (unsigned char)now;\n"
  "    }\n"
  "    any |= run.pending[i];\n"
  "  }\n"
  "  return any;\n"
  "}\n"
  "static void assign(const struct reaction *r, double t, double *y)\n"
  "{\n"
  "  double value[TARGETS + 1] = {0};\n"
  "  if (r->count) r->values(t, y, 0, parameter, run.memory, value);\n"
  "  for (int k = 0; k < r->count; k++)\n"
  "    if (targets[r->first + k].state >= 0)\n"
  "      y[targets[r->first + k].state] = value[k];\n"
  "    else\n"
  "      run.memory[targets[r->first + k].memory] = value[k];\n"
  "}\n"
  "/* After assignments relations whose g has moved are as their sign says. */\n"
  "static void follow(double t, const double *y)\n"
  "{\n"
  "  event_values(t, y, after);\n"
  "  for (int i = 0; i < SWITCHES; i++)\n"
  "    if (after[i] != before[i]) {\n"
  "      run.memory[DISCRETES + i] = after[i] < 0;\n"
  "      run.open[i] = after[i] == 0;\n"
  "    }\n"
  "  memcpy(before, after, sizeof before);\n"
  "}\n"
  "static int act(double t, double *y, int *stops)\n"
  "{\n"
  "  for (int i = 0; i < REACTIONS; i++) {\n"
  "    if (!run.pending[i]) continue;\n"
  "    run.pending[i] = 0;\n"
  "    if (reactions[i].trigger == REQUIREMENT) return STEIF_INFEASIBLE;\n"
  "    assign(&reactions[i], t, y);\n"
  "    *stops |= reactions[i].stops;\n"
  "    if (reactions[i].trigger == TIMER) run.done[i]++, set_timer(i);\n"
  "    follow(t, y);\n"
  "  }\n"
  "  return 0;\n"
  "}\n"
  "/* A relation that has fired was the other way before; the direction says how it is now. "
  "*/\n"
  "static int flip(double t, const double *y, const int *fired)\n"
  "{\n"
  "  int changes = 0, timer = SWITCHES;\n"
  "  for (int i = 0; i < SWITCHES; i++) {\n"
  "    run.open[i] = fired[i] != 0;\n"
  "    if (fired[i]) run.memory[DISCRETES + i] = fired[i] > 0;\n"
  "  }\n"
  "  ask(t, y);\n"
  "  for (int i = 0; i < REACTIONS; i++) run.truth[i] = truths[i] != 0;\n"
  "  for (int i = 0; i < SWITCHES; i++) {\n"
  "    if (fired[i]) run.memory[DISCRETES + i] = fired[i] < 0;\n"
  "    changes |= fired[i] && i < IN_EQUATIONS;\n"
  "  }\n"
  "  for (int i = 0; i < REACTIONS; i++)\n"
  "    if (reactions[i].trigger == TIMER && fired[timer++] > 0) run.pending[i] = 1;\n"
  "  return changes;\n"
  "}\n"
  "/* g is moved to its new side by some rounding, so that noise does not fire it again. */\n"
  "static void move(const int *fired)\n"
  "{\n"
  "  const double units = 64 * 2.2204460492503131e-16;\n"
  "  for (int i = 0; i < SWITCHES; i++) {\n"
  "    if (!fired[i]) continue;\n"
  "    const double g = fabs(after[i]), shift = units * run.range[i] + 2 * g;\n"
  "    run.shift[i] = g > units * 1e3 * run.range[i]       ? 0\n"
  "                   : run.memory[DISCRETES + i] != 0 ? -shift\n"
  "                                                        : shift;\n"
  "    run.range[i] = 0;\n"
  "  }\n"
  "}\n"
  "static int handle(sunrealtype t, N_Vector v, const int *fired, void *user)\n"
  "{\n"
  "  double *y = N_VGetArrayPointer(v);\n"
  "  int stops = 0, rounds = 0;\n"
  "  (void)user;\n"
  "  event_values(t, y, before);\n"
  "  const int changes = flip(t, y, fired);\n"
  "  for (; find_pending(t, y); rounds++) {\n"
  "    if (rounds == 100) return STEIF_STEP_LIMIT; /* they cause each other without end */\n"
  "    const int code = act(t, y, &stops);\n"
  "    if (code) return code;\n"
  "  }\n"
  "  if (rounds && IS_ODE) look_ahead(t, y);\n"
  "  event_values(t, y, after);\n"
  "  move(fired);\n"
  "  return stops ? STEIF_FINISH : changes || rounds ? STEIF_RESTART : STEIF_CONTINUE;\n"
  "}\n"
  "static long save(void *bytes, void *user)\n"
  "{\n"
  "  (void)user;\n"
  "  if (bytes) memcpy(bytes, &run, sizeof run);\n"
  "  return (long)sizeof run;\n"
  "}\n"
  "static int restore(const void *bytes, size_t count, void *user)\n"
  "{\n"
  "  (void)user;\n"
  "  if (count != sizeof run) return -1;\n"
  "  memcpy(&run, bytes, sizeof run);\n"
  "  return 0;\n"
  "}\n\n";

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
    if (r->times) stf_write(w, ", .time = times%zu", i);
    if (r->count) stf_write(w, ", .values = action%zu_0", i);
    stf_write_text(w, "},\n");
  }
  stf_write_text(w, "  {0}};\n");
}

static void all(stf_writer *w, const char *name, const stf_quantity *q, const char *to)
{
  for (size_t i = 0; i < q->tapes.count; i++)
    stf_write(w, "  %s_%zu(t, y, 0, parameter, run.memory, %s);\n", name, i, to);
}

void stf_write_event_values(stf_writer *w, const stf_model *m)
{
  sizes(w, m);
  stf_write_text(w, state);
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
    w, "static void event_values(double t, const double *y, double *g)\n{\n"
       "  for (int i = 0; i < SWITCHES + TIMERS; i++) g[i] = i < SWITCHES && !used[i];\n");
  all(w, "event", &m->events, "g");
  stf_write_text(w, "}\nstatic void ask(double t, const double *y)\n{\n  (void)t, (void)y;\n"
                    "  memset(truths, 0, sizeof truths);\n");
  all(w, "condition", &m->reactions->conditions, "truths");
  stf_write_text(w, "}\n");
  stf_write_text(w, relations);
}

void stf_write_events(stf_writer *w, const stf_model *m)
{
  reaction_list(w, m);
  stf_write_text(w, "static void slopes(double t, const double *y, double *out)\n{\n");
  if (m->form != STEIF_ODE)
    stf_write_text(w, "  (void)t, (void)y, (void)out;\n}\n");
  else {
    if (m->f.size && !m->f.assigns)
      stf_write_text(w, "  memset(out, 0, UNKNOWNS * sizeof *out);\n");
    all(w, "f", &m->f, "out");
    stf_write_text(w, "}\n");
  }
  stf_write_text(w, rules);
  stf_write_text(w, handling);
}
