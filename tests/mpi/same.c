/* same.c: what one rank alone is given otherwise: all ranks say the same.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ranks.h"
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <steif/checkpoint.h>
#include <steif/quadrature.h>

typedef struct given {
  steif_context *ctx;
  steif_problem p;
  steif_options o;
  const char *method;
  sunrealtype *y0;
} given;

static void open(given *g, rod *r)
{
  g->ctx = steif_context_new(NULL);
  g->y0 = malloc((size_t)(r->rows + 1) * sizeof *g->y0);
  g->p = rod_problem(r, g->y0), g->o = steif_defaults(), g->method = "bdf";
  g->o.rtol = 1e-3, g->o.like = rod_vector(r, g->ctx);
}

static void close(given *g)
{
  N_VDestroy(g->o.like);
  steif_context_free(&g->ctx);
  free(g->y0);
}

/* No solver, and a sentence with these words. */
static int told(rod *r, given *g, const char *words, const char *what)
{
  steif_solver *s = steif_solver_new(g->ctx, &g->p, g->method, &g->o);
  const int code = s ? STEIF_OK : steif_status(g->ctx);
  const int as = !s && strstr(steif_message(g->ctx), words),
            same = same_answer(r, g->ctx, code);
  if (!EVERYWHERE(r, as && same) && r->rank == 0)
    printf("  %s: %s\n", what, steif_message(g->ctx));
  steif_solver_free(&s);
  return as;
}

/* -- every word of the structs ------------------------------------------------------------------ */

typedef struct range {
  size_t from, to;
} range;

#define IN(type, name)                                                                         \
  {                                                                                            \
    offsetof(type, name), offsetof(type, name) + sizeof((type *)NULL)->name                    \
  }
#define AFTER(type, name, next)                                                                \
  {                                                                                            \
    offsetof(type, name) + sizeof((type *)NULL)->name, offsetof(type, next)                    \
  }

/* Of a rank, of own rows, or never read by a run; pointers that are set below are taken away instead; and what lies
 * between members. */
static const range free_in_problem[] = {
  IN(steif_problem, name),
  IN(steif_problem, about),
  IN(steif_problem, names),
  IN(steif_problem, user),
  IN(steif_problem, nnz),
  IN(steif_problem, nnz_E),
  IN(steif_problem, reference),
  IN(steif_problem, build),
  IN(steif_problem, destroy),
  IN(steif_problem, y0),
  IN(steif_problem, f),
  IN(steif_problem, precsetup),
  IN(steif_problem, precsolve),
  IN(steif_problem, like),
  AFTER(steif_problem, storage, lower),
  AFTER(steif_problem, linear, exact),
  AFTER(steif_problem, invariants, invariant),
  AFTER(steif_problem, events, event),
  AFTER(steif_problem, event_time_count, breaks),
  AFTER(steif_problem, break_count, positions),
  AFTER(steif_problem, unit_mass, rtol_scale),
};
static const range free_in_options[] = {
  IN(steif_options, like),
  IN(steif_options, observer),
  IN(steif_options, stop),
  AFTER(steif_options, force_storage, like),
  AFTER(steif_options, consistent, observe),
  AFTER(steif_options, initial, attributes),
};

static int is_free(size_t at, size_t count, const range *list)
{
  for (size_t i = 0; i < count; i++)
    if (at >= list[i].from && at < list[i].to) return 1;
  return 0;
}

static void words(rod *r, size_t size, size_t count, const range *list, size_t offset)
{
  for (size_t at = 0; at < size; at += sizeof(int)) {
    given g;
    char text[60];
    if (is_free(at, count, list)) continue;
    open(&g, r);
    if (r->rank == r->size - 1) ((char *)&g)[offset + at] ^= 1;
    snprintf(text, sizeof text, "%zu bytes, at %zu", size, at);
    told(r, &g, "", text);
    const char *said = steif_message(g.ctx);
    EVERYWHERE(r, strstr(said, "ranks disagree") || strstr(said, "reserved"));
    close(&g);
  }
}

static void pointers_taken_away(rod *r)
{
  enum { POINTERS = 6 };
  for (int k = 0; k < POINTERS; k++) {
    given g;
    open(&g, r);
    if (r->rank == r->size - 1) {
      if (k == 0) g.p.y0 = NULL;
      if (k == 1) g.p.f = NULL;
      if (k == 2) g.p.precsetup = NULL;
      if (k == 3) g.p.precsolve = NULL;
      if (k == 4) g.method = NULL;
      if (k == 5) g.method = "radau:s=1";
    }
    told(r, &g, k == 4 ? "a method is needed" : "ranks disagree", "a pointer");
    close(&g);
  }
}

/* -- what they point to -------------------------------------------------------------------------- */

static int fault; /* of these alone, on the rank alone */

static int counted(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const rod *r = user;
  (void)y;
  value[0] = t - 0.02, value[1] = 1;
  if (r->rank != r->alone) return 0;
  if (fault == LOCAL_EVENT) value[1] = 2;
  if (fault == NOT_A_NUMBER) value[1] = NAN;
  return fault == FATAL ? -1 : 0;
}

static void lists(rod *r)
{
  enum { LISTS = 7 };
  for (int k = 0; k < LISTS; k++) {
    const int other = r->rank == r->size - 1;
    given g;
    sunrealtype mesh[] = {0, 0.01, 0.05}, breaks[] = {0.01, 0.02};
    steif_event event[] = {{.name = "a"}, {.name = "b"}};
    steif_quadrature q = {.count = 2, .value = counted};
    open(&g, r);
    if (k == 0) mesh[1] += other * 1e-9, g.o.mesh = mesh, g.o.mesh_size = 3;
    if (k == 1) breaks[0] += other * 1e-9, g.p.breaks = breaks, g.p.break_count = 2;
    if (k == 2) g.o.start = other ? "constant" : "ramp";
    if (k == 3 || k == 4) g.p.events = 2, g.p.event = counted, g.p.event_list = event;
    if (k == 3) event[1].direction = other;
    if (k == 4) event[1].terminal = other;
    if (k == 5) q.count -= other, g.p.quadrature = &q;
    if (k == 6) g.o.mesh = mesh, g.o.mesh_size = (size_t)(3 - other);
    static const char *const said[LISTS] = {
      "mesh", "breaks", "start", "direction", "terminal", "quadrature->count", "mesh_size"};
    told(r, &g, "ranks disagree", said[k]);
    EVERYWHERE(r, strstr(steif_message(g.ctx), said[k]) != NULL);
    close(&g);
  }
}

/* -- values of callbacks ------------------------------------------------------------------------- */

enum { EVENTS, INVARIANTS, INTEGRALS };

static void values(rod *r, const char *method, int of, int wrong)
{
  given g;
  steif_quadrature q = {.count = 2, .value = counted};
  sunrealtype integral[2] = {0, 0};
  open(&g, r);
  g.method = method, fault = wrong, r->alone = r->size - 1, r->calls = 0;
  if (of == EVENTS) g.p.events = 2, g.p.event = counted;
  if (of == INVARIANTS) g.p.invariants = 2, g.p.invariant = counted;
  if (of == INTEGRALS) g.p.quadrature = &q;
  steif_solver *s = steif_solver_new(g.ctx, &g.p, method, &g.o);
  const int code = s ? steif_solve_to(s, g.p.t1) : steif_status(g.ctx);
  const char *text = steif_message(g.ctx);
  EVERYWHERE(r, same_answer(r, g.ctx, code));
  const int right = wrong == FATAL          ? STEIF_CALLBACK
                    : wrong == NOT_A_NUMBER ? STEIF_NOT_FINITE
                    : wrong == NOTHING      ? STEIF_OK
                                            : STEIF_BAD_INPUT;
  char words[40];
  snprintf(words, sizeof words, "on rank %d", r->alone);
  EVERYWHERE(r, code == right);
  EVERYWHERE(r,
             wrong != LOCAL_EVENT || strstr(text, "2 of problem 'rod' has different values"));
  if ((wrong == NOT_A_NUMBER || wrong == FATAL) && !EVERYWHERE(r, !!strstr(text, words)) &&
      !r->rank)
    printf("  %s, %d, %d: %s\n", method, of, wrong, text);
  if (of == INTEGRALS && wrong == NOTHING) {
    EVERYWHERE(r, steif_quadrature_values(s, g.p.t1, integral) == STEIF_OK);
    EVERYWHERE(r, integral[1] > 0.05 - 1e-12 && integral[1] < 0.05 + 1e-12);
    const sunrealtype t = steif_time(s) - 1e-9 * r->rank;
    EVERYWHERE(r, r->size == 1 || steif_quadrature_values(s, t, integral) == STEIF_BAD_INPUT);
  }
  steif_solver_free(&s);
  fault = NOTHING;
  close(&g);
}

/* -- times --------------------------------------------------------------------------------------- */

static void times(rod *r, const char *method)
{
  given g;
  open(&g, r);
  const int by_f = !strcmp(method, "rk4");
  g.o.h = by_f ? 2.5e-4 : 0;
  steif_solver *s = steif_solver_new(g.ctx, &g.p, method, &g.o);
  EVERYWHERE(r, steif_solve_to(s, 0.02 - 1e-3 * r->rank) == STEIF_BAD_INPUT);
  EVERYWHERE(r, same_answer(r, g.ctx, STEIF_BAD_INPUT));
  EVERYWHERE(r, steif_solve_to(s, r->rank ? 0.02 : 1e9) == STEIF_BAD_INPUT);
  EVERYWHERE(r, same_answer(r, g.ctx, STEIF_BAD_INPUT));
  EVERYWHERE(r, steif_solve_to(s, 0.05) == STEIF_OK);
  EVERYWHERE(r, steif_solver_extend(s, 0.06 + 1e-3 * r->rank) == STEIF_BAD_INPUT);
  EVERYWHERE(r, same_answer(r, g.ctx, STEIF_BAD_INPUT));
  EVERYWHERE(r, steif_solver_extend(s, 0.06) == STEIF_OK);
  EVERYWHERE(r, steif_solve_to(s, 0.06) == STEIF_OK);
  N_Vector y = N_VClone(g.o.like);
  const int code = steif_dense(s, 0.06 - 1e-6 * r->rank, y); /* of all ranks only by f */
  EVERYWHERE(r, code == (by_f ? STEIF_BAD_INPUT : STEIF_OK));
  N_VDestroy(y);
  steif_solver_free(&s);
  close(&g);
}

/* -- weights of the caller, and rows that are wrong ---------------------------------------------- */

static int weights(N_Vector y, N_Vector w, void *user)
{
  rod *r = user;
  N_VAbs(y, w);
  N_VScale(1e-4, w, w);
  N_VAddConst(w, r->n == 40 ? 1e-4 : -1, w);
  N_VInv(w, w);
  r->c++;
  return 0;
}

static void user_of_weights(rod *r, const char *method)
{
  given g;
  open(&g, r);
  g.o.ewt = weights, r->c = 0;
  steif_solver *s = steif_solver_new(g.ctx, &g.p, method, &g.o);
  EVERYWHERE(r, s && steif_solve_to(s, g.p.t1) == STEIF_OK && r->c > 1);
  steif_solver_free(&s);
  close(&g);
}

static void wrong_rows(rod *r)
{
  char words[80];
  for (int k = 0; k < 2; k++) {
    given g;
    sunrealtype atols[64];
    open(&g, r);
    const sunindextype last = r->n - r->owned[r->size - 1];
    for (sunindextype i = 0; i < r->rows; i++) atols[i] = 1e-6;
    if (k) g.o.atols = atols;
    if (r->rank == r->size - 1) *(k ? &atols[0] : &g.y0[0]) = -HUGE_VAL;
    snprintf(words, sizeof words, "on rank %d, whose row 0 is row %d", r->size - 1, (int)last);
    told(r, &g, words, "rows");
    close(&g);
  }
}

static void first_component(rod *r)
{
  given g;
  char words[80];
  open(&g, r);
  r->wrong = NOT_A_NUMBER, r->alone = r->size - 1, r->calls = 40;
  const sunindextype last = r->n - r->owned[r->size - 1];
  snprintf(words, sizeof words, "component %d (on rank %d) of f of problem 'rod'",
           (int)last + 1, r->size - 1);
  told(r, &g, words, "the first call");
  r->wrong = NOTHING;
  close(&g);
}

/* Numbers of ranks are those of the communicator: of a part, in the order of all or the other one, and of all in
 * reversed order. */
static void other_communicators(MPI_Comm comm)
{
  int rank;
  MPI_Comm_rank(comm, &rank);
  for (int k = 0; k < 3; k++) {
    rod r;
    MPI_Comm part;
    MPI_Comm_split(comm, k < 2 && rank > 0, k ? -rank : rank, &part);
    rod_open(&r, part, 40, 0);
    if (r.size > 1) {
      values(&r, "bdf", EVENTS, FATAL), values(&r, "cvode", EVENTS, NOT_A_NUMBER);
      wrong_rows(&r), first_component(&r);
    }
    rod_close(&r);
    MPI_Comm_free(&part);
  }
}

void test_same(MPI_Comm comm)
{
  static const char *const methods[] = {"bdf", "radau:s=2", "cvode", "ida"};
  rod r;
  rod_open(&r, comm, 40, 0);
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
    user_of_weights(&r, methods[k]);
    for (int of = EVENTS; of <= INTEGRALS; of++)
      for (int wrong = NOTHING; wrong <= LOCAL_EVENT; wrong++)
        if (wrong == NOTHING ||
            (r.size > 1 && (wrong == FATAL || wrong == NOT_A_NUMBER || wrong == LOCAL_EVENT)))
          values(&r, methods[k], of, wrong);
  }
  if (r.size > 1) {
    words(&r, sizeof(steif_problem), sizeof free_in_problem / sizeof *free_in_problem,
          free_in_problem, offsetof(given, p));
    words(&r, sizeof(steif_options), sizeof free_in_options / sizeof *free_in_options,
          free_in_options, offsetof(given, o));
    pointers_taken_away(&r);
    lists(&r);
    wrong_rows(&r);
    first_component(&r);
    times(&r, "bdf"), times(&r, "rk4"), times(&r, "cvode");
  }
  other_communicators(comm);
  rod_close(&r);
}
