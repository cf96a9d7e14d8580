/* same_input.c: are problem, options and method the same on all ranks?
 *
 * Every member that a run looks at is here, but for those that belong to a rank: user, observer, stop; names; room
 * for entries (nnz, nnz_E); what is of own rows (y0, yp0, index, constraint, pattern, atols, attributes), of which only
 * the presence is to be the same. What no run reads (about, reference, build, destroy) may differ.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "agreed.h"
#include <steif/extension.h>
#include <stddef.h>
#include <string.h>

typedef struct member {
  const char *name;
  size_t offset, size; /* size 0: a pointer, of which only the presence is looked at */
} member;

#define VALUE(name)                                                                            \
  {                                                                                            \
#name, offsetof(TYPE, name), sizeof((TYPE *)NULL)->name                                    \
  }
#define THERE(name)                                                                            \
  {                                                                                            \
#name, offsetof(TYPE, name), 0                                                             \
  }

#define TYPE steif_problem
static const member of_problem[] = {
  VALUE(n),
  VALUE(t0),
  VALUE(t1),
  VALUE(storage),
  VALUE(lower),
  VALUE(upper),
  VALUE(dae_index),
  VALUE(autonomous),
  VALUE(period),
  VALUE(linear),
  VALUE(invariants),
  VALUE(events),
  VALUE(event_time_count),
  VALUE(break_count),
  VALUE(positions),
  VALUE(unit_mass),
  VALUE(rtol_scale),
  VALUE(event_spacing),
  THERE(y0),
  THERE(yp0),
  THERE(start),
  THERE(f),
  THERE(F),
  THERE(g),
  THERE(jac),
  THERE(idajac),
  THERE(E),
  THERE(A),
  THERE(Ev),
  THERE(Av),
  THERE(precsetup),
  THERE(precsolve),
  THERE(L),
  THERE(Lv),
  THERE(pattern),
  THERE(index),
  THERE(constraint),
  THERE(exact),
  THERE(invariant),
  THERE(event),
  THERE(event_list),
  THERE(handle_event),
  THERE(begin),
  THERE(save),
  THERE(restore),
  THERE(event_times),
  THERE(breaks),
  THERE(kick),
  THERE(drift),
  THERE(parameters),
  THERE(quadrature),
  THERE(precsolve_pair),
  THERE(event_slope),
  THERE(project),
  THERE(Etv),
  THERE(Atv),
  THERE(precsolve_transposed),
};
#undef TYPE

#define TYPE steif_options
static const member of_options[] = {
  VALUE(rtol),
  VALUE(atol),
  VALUE(h),
  VALUE(mesh_size),
  VALUE(h0),
  VALUE(h_max),
  VALUE(t1),
  VALUE(max_steps),
  VALUE(newton),
  VALUE(iterations),
  VALUE(storage),
  VALUE(force_storage),
  VALUE(suppress_algebraic),
  VALUE(consistent),
  VALUE(initial),
  VALUE(max_seconds),
  VALUE(sensitivities),
  VALUE(active_count),
  VALUE(untested_sensitivities),
  VALUE(test_quadratures),
  VALUE(recompute),
  VALUE(reserved_int),
  THERE(atols),
  THERE(ewt),
  THERE(mesh),
  THERE(start),
  THERE(observe),
  THERE(on_event),
  THERE(jump),
  THERE(reinitialise),
  THERE(attributes),
  THERE(active),
};
#undef TYPE

/* -- numbers that stand for what is given -------------------------------------------------------- */

enum { ROOM = 64 };

typedef struct collected {
  const char *name[ROOM], *of;
  unsigned long long number[ROOM];
  bool presence[ROOM]; /* the number tells whether it is given */
  size_t count;
} collected;

static void add(collected *c, const char *name, const void *bytes, size_t count)
{
  c->name[c->count] = name, c->presence[c->count] = false;
  c->number[c->count++] = bytes ? stf_checksum(bytes, count) : 0;
}

static void add_times(collected *c, const char *name, const sunrealtype *t, long long count)
{
  if (t && count > 0) add(c, name, t, (size_t)count * sizeof *t);
}

static void add_members(collected *c, size_t count, const member *m, const void *given)
{
  for (size_t i = 0; i < count; i++) {
    const char *at = (const char *)given + m[i].offset;
    if (m[i].size) {
      add(c, m[i].name, at, m[i].size);
      continue;
    }
    static const char none[sizeof(void *)];
    const bool there = memcmp(at, none, sizeof none) != 0;
    add(c, m[i].name, &there, sizeof there);
    c->presence[c->count - 1] = true;
  }
}

static int compare(steif_context *ctx, N_Vector like, const collected *c)
{
  const long at = stf_agree_different(like, c->count, c->number);
  if (at < 0) return STEIF_OK;
  return STEIF_FAIL(ctx, STEIF_BAD_INPUT, "ranks disagree in %s%s: %s", c->of, c->name[at],
                    c->presence[at] ? "give it on all ranks or on none" : "give all the same");
}

/* -- what they point to: counts and presence are the same already --------------------------------- */

static void add_events(collected *c, const steif_problem *p)
{
  if (!p->event_list || p->events < 1) return;
  unsigned long long direction = 0, terminal = 0;
  for (int i = 0; i < p->events; i++) {
    const int two[] = {p->event_list[i].direction, p->event_list[i].terminal};
    direction = 31 * direction + stf_checksum(&two[0], sizeof two[0]);
    terminal = 31 * terminal + stf_checksum(&two[1], sizeof two[1]);
  }
  add(c, "event_list[].direction", &direction, sizeof direction);
  add(c, "event_list[].terminal", &terminal, sizeof terminal);
}

static void add_quadrature(collected *c, const steif_quadrature *q)
{
  if (!q) return;
  const bool there[] = {q->value != NULL, q->slope != NULL};
  add(c, "quadrature->count", &q->count, sizeof q->count);
  add(c, "quadrature->value", &there[0], sizeof there[0]);
  add(c, "quadrature->slope", &there[1], sizeof there[1]);
}

static void add_parameters(collected *c, const steif_parameters *q)
{
  if (!q) return;
  add(c, "parameters->count", &q->count, sizeof q->count);
  add_times(c, "parameters->value", q->value, q->count);
}

int steif_same_problem(steif_context *ctx, N_Vector like, const steif_problem *problem)
{
  static const steif_problem none;
  const steif_problem *p = problem ? problem : &none;
  const bool there = problem != NULL;
  collected of_p = {.of = "problem."};
  _Static_assert(STF_COUNT(of_problem) <= ROOM && STF_COUNT(of_options) <= ROOM, "room");
  STEIF_TRY(steif_same(ctx, like, "whether there is a problem at all", &there, sizeof there));
  add_members(&of_p, STF_COUNT(of_problem), of_problem, p);
  STEIF_TRY(compare(ctx, like, &of_p));
  of_p.count = 0;
  add_times(&of_p, "event_times", p->event_times, p->event_time_count);
  add_times(&of_p, "breaks", p->breaks, p->break_count);
  add_events(&of_p, p);
  add_quadrature(&of_p, p->quadrature);
  add_parameters(&of_p, p->parameters);
  return compare(ctx, like, &of_p);
}

int stf_same_input(steif_context *ctx, N_Vector like, const steif_problem *problem,
                   const char *method, const steif_options *o)
{
  collected of_o = {.of = "options."};
  STEIF_TRY(steif_same(ctx, like, "the method", method, strlen(method)));
  STEIF_TRY(steif_same_problem(ctx, like, problem));
  add_members(&of_o, STF_COUNT(of_options), of_options, o);
  STEIF_TRY(compare(ctx, like, &of_o));
  of_o.count = 0;
  add_times(&of_o, "mesh", o->mesh, (long long)o->mesh_size);
  add(&of_o, "start", o->start, o->start ? strlen(o->start) : 0);
  if (o->active && o->active_count > 0)
    add(&of_o, "active", o->active, (size_t)o->active_count * sizeof *o->active);
  return compare(ctx, like, &of_o);
}
