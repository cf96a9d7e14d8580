/* success.c: a campaign of adaptive runs on problems of known solution: is a run that says ok right?
 *
 * Problems: those of the collection with a closed solution or reference at the end and few unknowns, but
 * for those that amplify errors (lorenz, lorenz96, steyer: 10^2 to 10^6 times before the end), and random
 * ones of made.h. Every method of the list that chooses its steps runs on all problems it accepts.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "benchmarks.h"
#include "made.h"
#include "success.h"
#include "timing.h"
#include "workprec_report.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>

enum { COLLECTED_MOST = 100, QUICK_SEEDS = 2, SEEDS = 12 };

static bool amplifies(const char *name)
{
  return !strncmp(name, "lorenz", 6) || !strncmp(name, "steyer", 6);
}

/* max over components of index 1, or of higher ones, of the error in tolerances. */
static sunrealtype worst(const steif_problem *p, sunrealtype rtol, N_Vector y, N_Vector known,
                         bool higher)
{
  const steif_reference *r = p->exact ? NULL : p->reference;
  const sunrealtype scale = p->rtol_scale > 0 ? p->rtol_scale : 1;
  const sunindextype count = r && r->count ? r->count : p->n;
  sunrealtype most = 0;
  for (sunindextype k = 0; k < count; k++) {
    const sunindextype i = r && r->component ? r->component[k] : k;
    if ((p->index && p->index[i] > 1) != higher) continue;
    const sunrealtype value = r ? r->value[k] : NV_Ith_S(known, i);
    const sunrealtype error = fabs(NV_Ith_S(y, i) - value) / (rtol * (scale + fabs(value)));
    most = error <= most ? most : isfinite(error) ? error : INFINITY;
  }
  return most;
}

/* Is a solution known at t1? */
static bool known_at_end(const steif_problem *p, N_Vector y)
{
  if (p->exact && !p->exact(p->t1, y, NULL, p->user)) return true;
  return p->reference && fabs(p->reference->t - p->t1) <= 1e-12 * fabs(p->t1);
}

typedef struct watch {
  const steif_problem *problem;
  N_Vector known; /* NULL: only the end is looked at */
  sunrealtype rtol, end, most;
  int ticks;
  bool late;
} watch;

/* A solution that decays forgets its errors before t1: the user reads all of it. */
static int look(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  watch *w = user;
  const steif_problem *p = w->problem;
  (void)s;
  if (w->known && !p->exact(t, w->known, NULL, p->user))
    w->most = fmax(w->most, worst(p, w->rtol, y, w->known, false));
  if (++w->ticks % 64 == 0) w->late = stf_now() > w->end;
  return w->late || interrupted();
}

static void solve(struct call *call, const steif_problem *p, const char *method,
                  sunrealtype rtol, sunrealtype longest, success_run *run)
{
  watch w = {.problem = p, .rtol = rtol, .end = stf_now() + longest};
  if (p->exact) w.known = N_VNew_Serial(p->n, steif_sundials(call->ctx));
  steif_options o = steif_defaults();
  o.rtol = rtol;
  o.observe = look;
  o.observer = &w;
  *run =
    (success_run){.rtol = rtol, .error = NAN, .whole = NAN, .levels = NAN, .promised = NAN};
  snprintf(run->problem, sizeof run->problem, "%s", p->name);
  const sunrealtype from = stf_now();
  steif_solver *s = steif_solver_new(call->ctx, p, method, &o);
  run->code = s ? steif_solve_to(s, p->t1) : steif_status(call->ctx);
  run->cpu_s = stf_now() - from;
  run->late = w.late;
  if (s) run->steps = steif_statistics(s)->steps;
  N_Vector known = run->code ? NULL : N_VClone(steif_solution(s));
  if (known && known_at_end(p, known)) {
    run->told = steif_statistics(s)->rounding > 1;
    run->error = worst(p, rtol, steif_solution(s), known, false);
    if (w.known) run->whole = w.most;
    run->levels = worst(p, rtol, steif_solution(s), known, true);
    if (steif_hidden_error(s, &run->promised)) run->promised = NAN;
  }
  if (known) N_VDestroy(known);
  if (w.known) N_VDestroy(w.known);
  steif_solver_free(&s);
  steif_forget(call->ctx);
}

/* What is asked of all methods alike. */
typedef struct campaign {
  struct call *call;
  sunrealtype rtol[REALS_MOST], longest;
  size_t rtols;
  long from, seeds; /* random problems from, from + 1, ... of each kind */
  const char *only; /* problems whose names begin so; NULL: all */
} campaign;

static void all_tolerances(const campaign *c, const steif_problem *p,
                           const steif_method_info *m, success_runs *all)
{
  const int form = steif_problem_form(c->call->ctx, p);
  if (!form || (strcmp(m->family, "auto") && !(m->forms & (unsigned)form))) return;
  if (c->only && strncmp(p->name, c->only, strlen(c->only))) return;
  for (size_t k = 0; k < c->rtols && all->count < SUCCESS_RUNS && !interrupted(); k++) {
    success_run *run = &all->run[all->count++];
    solve(c->call, p, m->name, c->rtol[k], c->longest, run);
  }
}

static bool collected(struct call *call, const steif_problem *p)
{
  if (p->n > COLLECTED_MOST || amplifies(p->name)) return false;
  N_Vector y = N_VNew_Serial(p->n, steif_sundials(call->ctx));
  const bool known = y && known_at_end(p, y);
  if (y) N_VDestroy(y);
  return known;
}

static void one_method(const campaign *c, const steif_method_info *m, success_runs *all)
{
  const char *name;
  for (size_t i = 0; (name = steif_problem_name(i)); i++) {
    steif_problem p;
    if (steif_problem_find(c->call->ctx, name, &p)) continue;
    progress(c->call, "%s, %s", m->name, name);
    if (collected(c->call, &p)) all_tolerances(c, &p, m, all);
    steif_problem_clear(c->call->ctx, &p);
  }
  for (int kind = 0; kind < MADE_KINDS; kind++)
    for (long seed = c->from; seed < c->from + c->seeds; seed++) {
      made one;
      made_new(&one, (enum made_kind)kind, seed);
      progress(c->call, "%s, %s", m->name, one.name);
      all_tolerances(c, &one.problem, m, all);
    }
}

/* Method i of those asked for, else of the list; false past the end. */
static bool method_at(struct call *call, const plan_list *wanted, size_t i,
                      steif_method_info *m)
{
  if (wanted->count)
    return i < wanted->count && !steif_method_find(call->ctx, wanted->item[i], m);
  return !steif_method_at(call->ctx, i, m);
}

/* Its own methods that choose their steps; baselines where they are asked for. */
static bool takes_part(const plan_list *wanted, const steif_method_info *m)
{
  if (!m->adaptive || !strcmp(m->family, "descriptor")) return false;
  return wanted->count || strcmp(m->family, "baseline") != 0;
}

int bench_success(struct call *call)
{
  static success_runs all;
  const bool quick = given(call, "--quick");
  const sunrealtype some[] = {1e-3, 1e-6, 1e-9}, five[] = {1e-3, 1e-5, 1e-7, 1e-9, 1e-11};
  campaign c = {.call = call, .longest = real_or(call, "--longest", quick ? 0.1 : 2)};
  c.rtols = given(call, "--rtols") ? reals_of(call, "--rtols", c.rtol) : quick ? 3 : 5;
  if (!given(call, "--rtols")) memcpy(c.rtol, quick ? some : five, c.rtols * sizeof *c.rtol);
  c.seeds = whole_or(call, "--seeds", quick ? QUICK_SEEDS : SEEDS);
  c.from = whole_or(call, "--first", 1);
  c.only = word_of(call, "--problems");
  plan_list wanted = {.count = 0};
  if (given(call, "--methods")) work_split(&wanted, word_of(call, "--methods"), NULL);
  steif_report *r = steif_report_new(call->ctx);
  steif_report_text(r, "benchmark", "success");
  steif_method_info m;
  for (size_t i = 0; r && !interrupted() && method_at(call, &wanted, i, &m); i++) {
    if (!takes_part(&wanted, &m)) continue;
    all.method = m.name;
    all.count = 0;
    one_method(&c, &m, &all);
    success_report(&all, given(call, "--runs"), r);
    rows_come(call, r);
  }
  return steif_status(call->ctx) == STEIF_UNKNOWN_NAME ? fail(call) : bench_present(call, &r);
}
