/* auto.c: which method for which problem, and why.
 *
 *   given steps                                   radau:s=3
 *   E x' = A x + g of index above 1, or not known descriptor: from any start, to tolerance
 *   few unknowns and digits, with a given Jacobian
 *     n <= 5                                      Rosenbrock down to rtol 1e-2
 *     y' = f(y) or M y' = f(y), n <= 24           Rosenbrock down to rtol 1e-4
 *     others, n <= 8                              Rosenbrock at rtol 1e-1
 *   small dense systems (vector lanes)            radau:s=7, but s=5 at rtol 1e-1, and at 1e-2 for n > 8;
 *                                                 and s=5 for index above 1 below 5e-11: the split of s=7
 *                                                 has fourteen times its condition
 *   dense systems up to n = 300                   radau:s=5 down to rtol 1e-6, else s=7: oscillations
 *                                                 defeat BDF there
 *   index 3 up to n = 300                         radau:s=5: multipliers have order s - 2
 *   others of index above 1                       radau:s=3, but s=5 below 1e-4 up to n = 300
 *   band and sparse systems
 *     with a given Jacobian
 *       whose LU costs a few solves               Rosenbrock down to rtol 1e-6, 1e-3 if constant
 *       whose LU costs more, constant             Rosenbrock down to rtol 1e-9
 *     others                                      radau:s=3 down to rtol 1e-4, 1e-5 where an LU costs a
 *                                                 few solves, radau:s=5 below and for linear systems
 *   large dense systems, operators                bdf down to rtol 1e-8, radau:s=5 below
 * Beside it y' = f(t, y) has an explicit method, which begins where that is cheaper, and the two change
 * places when stiffness comes or goes (switching.c). With sensitivities: radau:s=5 for what does not carry them,
 * throughout.
 * The Rosenbrock method is rodas5p; at rtol 1e-1, where order 4 does, rodas4, or rodas4p2 where f depends
 * on t.
 * Rosenbrock methods factor in every step and iterate nowhere. Collocation on sparse systems takes one
 * real matrix for many steps, as BDF does, at orders that BDF does not have.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include "fill_order.h"
#include "step_error.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
  TINY = 5,
  FEW = 8,
  SOME = 24,
  SMALL = 64,
  MEDIUM = 300,
  CHEAP = 12 /* flops of an LU per entry of the factors */
};

const char *const stf_auto_methods[] = {
  [STF_AUTO_DESCRIPTOR] = "descriptor", [STF_AUTO_RADAU5] = "radau:s=3",
  [STF_AUTO_RADAU9] = "radau:s=5",      [STF_AUTO_RADAU13] = "radau:s=7",
  [STF_AUTO_RODAS4] = "rodas4",         [STF_AUTO_RODAS4P2] = "rodas4p2",
  [STF_AUTO_RODAS5P] = "rodas5p",       [STF_AUTO_BDF] = "bdf",
  [STF_AUTO_EXPLICIT] = "dopri87"};

typedef struct choice {
  enum stf_auto_method method;
  const char *reason;
} choice;

static enum steif_storage storage_of(const steif_problem *p, const steif_options *o)
{
  return o->force_storage ? o->storage : p->storage;
}

static bool small(const steif_problem *p, const steif_options *o, int form)
{
  return p->n <= SMALL && storage_of(p, o) == STEIF_DENSE &&
         (form == STEIF_ODE || form == STEIF_MASS);
}

/* Order 5 pays below rtol 1e-1; Rodas4 loses its order where stiff components are forced, Rodas4P2
 * keeps 3 (G. Steinebach, in Progress in Differential-Algebraic Equations II, 2020). */
static enum stf_auto_method rosenbrock(const steif_problem *p, const steif_options *o)
{
  if (o->rtol < 0.9e-1) return STF_AUTO_RODAS5P;
  return p->autonomous ? STF_AUTO_RODAS4 : STF_AUTO_RODAS4P2;
}

/* May events of a DAE make it one of index 3? */
static bool changes(const steif_problem *p) { return p->dae_index > 0 && p->handle_event; }

/* Does a Rosenbrock method pay for few digits of few unknowns? More digits, and forces that oscillate,
 * need many steps. */
static bool linearly(const steif_problem *p, const steif_options *o)
{
  const sunrealtype most = p->n <= TINY ? 1e-2 : p->autonomous ? 1e-4 : 1e-1;
  if (p->dae_index > 1 || changes(p) || !p->jac || (o->like && stf_spread(o->like)) || !p->y0 ||
      o->ewt || !stf_above_rounding(p, o, p->y0, 100))
    return false;
  return p->n <= (p->autonomous ? SOME : FEW) && o->rtol >= 0.9 * most;
}

/* Does an LU cost no more than a few solves? */
static bool cheap(const steif_problem *p, const steif_options *o)
{
  if (storage_of(p, o) == STEIF_BAND) return p->lower + p->upper <= CHEAP;
  if (!p->pattern)
    return p->nnz > 0 && p->nnz <= 4 * p->n; /* chains; grids have five a column */
  double entries;
  const double work = stf_fill_work(p->n, p->pattern->column, p->pattern->row, &entries);
  return work >= 0 && work <= CHEAP * entries;
}

/* Is it a linear system whose solution may hold impulses? Index 0 of a small one may mean that nobody
 * has said. */
static bool jumps(const steif_problem *p, const steif_options *o, int form)
{
  const bool stored = p->storage == STEIF_DENSE || p->storage == STEIF_SPARSE;
  const bool told = p->dae_index > 1 || p->dae_index < 0;
  const bool maybe = p->dae_index == 0 && p->n <= SMALL && p->storage == STEIF_DENSE;
  return form == STEIF_DESCRIPTOR && stored && (told || maybe) && !o->ewt && !p->constraint &&
         !o->like;
}

/* Down to which rtol a Rosenbrock method pays. A constant matrix it factors anew for other lengths of
 * steps only, but collocation does so too, which takes complex shifts then: dear where an LU is. */
static sunrealtype linearly_to(const steif_problem *p, const steif_options *o, int form)
{
  if ((form != STEIF_ODE && form != STEIF_MASS) || !p->jac || changes(p)) return INFINITY;
  return p->linear ? cheap(p, o) ? 1e-3 : 1e-9 : cheap(p, o) ? 1e-6 : INFINITY;
}

static choice on_grids(const steif_problem *p, const steif_options *o, int form)
{
  if (o->rtol >= 0.9 * linearly_to(p, o, form))
    return (choice){rosenbrock(p, o),
                    "an LU costs a few solves, or little beside complex ones: no iteration"};
  const sunrealtype low = cheap(p, o) ? 0.9e-5 : 0.9e-4;
  return (choice){o->rtol >= low && !p->linear ? STF_AUTO_RADAU5 : STF_AUTO_RADAU9,
                  "sparse: one real matrix, kept for many steps"};
}

static choice on_few(const steif_problem *p, const steif_options *o)
{
  if (linearly(p, o))
    return (choice){rosenbrock(p, o), "few unknowns, few digits: no iteration"};
  if (o->rtol >= (p->n > FEW ? 0.9e-2 : 0.9e-1))
    return (choice){STF_AUTO_RADAU9, "small and dense: all shifts in vector registers"};
  if (p->dae_index > 1 && o->rtol < 5e-11)
    return (choice){STF_AUTO_RADAU9, "near rounding, which multipliers feel more with s = 7"};
  return (choice){STF_AUTO_RADAU13, "small and dense, many digits wanted"};
}

static choice of_higher_index(const steif_problem *p, const steif_options *o)
{
  if (p->n <= MEDIUM && p->dae_index >= 3)
    return (choice){STF_AUTO_RADAU9, "index 3: order 3 of multipliers, constraints kept"};
  return (choice){p->n > MEDIUM || o->rtol >= 0.9e-4 ? STF_AUTO_RADAU5 : STF_AUTO_RADAU9,
                  "index above 1: collocation keeps the constraints"};
}

static choice choose(const steif_problem *p, const steif_options *o, int form)
{
  const enum steif_storage storage = storage_of(p, o);
  const bool grid = storage == STEIF_SPARSE || storage == STEIF_BAND;
  if (o->h > 0 || o->mesh)
    return (choice){STF_AUTO_RADAU5, "steps are given: order 5, stiffly accurate"};
  if (jumps(p, o, form))
    return (choice){STF_AUTO_DESCRIPTOR,
                    "linear: jumps and impulses of the pencil, smooth between"};
  if (small(p, o, form)) return on_few(p, o);
  if (p->dae_index > 1) return of_higher_index(p, o);
  if (storage == STEIF_DENSE && p->n <= MEDIUM)
    return (choice){o->rtol >= 0.9e-6 ? STF_AUTO_RADAU9 : STF_AUTO_RADAU13,
                    "dense, of medium size: few steps, oscillations do no harm"};
  if (grid) return on_grids(p, o, form);
  if (o->rtol >= 0.9e-8)
    return (choice){STF_AUTO_BDF,
                    "factorisations dominate: one real matrix, kept for many steps"};
  return (choice){STF_AUTO_RADAU9, "large, many digits wanted: order 9 needs few steps"};
}

/* Sensitivities are carried by collocation and BDF. */
static bool carries(enum stf_auto_method m)
{
  return m == STF_AUTO_RADAU5 || m == STF_AUTO_RADAU9 || m == STF_AUTO_RADAU13 ||
         m == STF_AUTO_BDF;
}

static choice carrying(choice c)
{
  return carries(c.method) ? c : (choice){STF_AUTO_RADAU9, "carries sensitivities"};
}

const char *stf_carrying(const char *method)
{
  for (int m = 0; m <= STF_AUTO_EXPLICIT; m++)
    if (carries((enum stf_auto_method)m) && !strcmp(method, stf_auto_methods[m])) return method;
  return stf_auto_methods[STF_AUTO_RADAU9];
}

const char *stf_choose(const steif_problem *p, const steif_options *o, int form, char *why,
                       size_t room)
{
  const choice any = choose(p, o, form), c = o->sensitivities ? carrying(any) : any;
  const char *method = stf_auto_methods[c.method];
  snprintf(why, room, "%s (n = %lld, rtol %.1e, form %s): %s", method, (long long)p->n, o->rtol,
           steif_form_name(form), c.reason);
  return method;
}
