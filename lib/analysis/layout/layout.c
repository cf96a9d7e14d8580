/* layout.c: offsets of members by name.
 * SPDX-License-Identifier: BSD-3-Clause */
#include <steif/discrete.h>
#include <steif/ensemble.h>
#include <steif/fit.h>
#include <steif/layout.h>
#include <steif/solver.h>
#include <steif/weak.h>
#include <string.h>

/* clang-format off */
#define SIZE(type) {#type, (long)sizeof(steif_##type)}
#define AT(type, member) {#type "." #member, (long)offsetof(steif_##type, member)}

static const struct {
  const char *name;
  long bytes;
} rows[] = {
  {"sunindextype", (long)sizeof(sunindextype)},

  SIZE(problem), AT(problem, name), AT(problem, n), AT(problem, t0), AT(problem, t1),
  AT(problem, y0), AT(problem, yp0), AT(problem, f), AT(problem, F), AT(problem, jac),
  AT(problem, E), AT(problem, A), AT(problem, user), AT(problem, storage), AT(problem, nnz), AT(problem, nnz_E),
  AT(problem, pattern), AT(problem, index), AT(problem, dae_index), AT(problem, linear),
  AT(problem, names), AT(problem, events), AT(problem, event), AT(problem, event_list),
  AT(problem, parameters), AT(problem, begin), AT(problem, save), AT(problem, restore),

  SIZE(pattern), AT(pattern, column), AT(pattern, row),
  SIZE(names), AT(names, equation), AT(names, unknown),
  SIZE(event), AT(event, name), AT(event, direction), AT(event, terminal),

  SIZE(options), AT(options, rtol), AT(options, atol), AT(options, atols), AT(options, h),
  AT(options, h0), AT(options, h_max), AT(options, t1), AT(options, max_steps),
  AT(options, observe), AT(options, observer), AT(options, on_event), AT(options, jump), AT(options, stop),

  AT(options, recompute), AT(options, sensitivities), AT(options, active_count), AT(options, active),

  SIZE(parameters), AT(parameters, count), AT(parameters, value), AT(parameters, name),
  SIZE(measurements), AT(measurements, count), AT(measurements, t), AT(measurements, value),
  AT(measurements, sd), AT(measurements, component),
  SIZE(fit_options), AT(fit_options, run), AT(fit_options, count), AT(fit_options, parameter),
  AT(fit_options, start), AT(fit_options, low), AT(fit_options, high), AT(fit_options, scale),
  AT(fit_options, starts),
  SIZE(fit), AT(fit, count), AT(fit, log), AT(fit, p), AT(fit, sd), AT(fit, low), AT(fit, high),
  AT(fit, covariance), AT(fit, correlation), AT(fit, undetermined), AT(fit, chi2), AT(fit, dof),
  AT(fit, residuals), AT(fit, residual), AT(fit, runs), AT(fit, message),
  AT(fit, covariance_theta), AT(fit, known), AT(fit, probability), AT(fit, used),
  SIZE(ensemble_options), AT(ensemble_options, problem), AT(ensemble_options, method),
  AT(ensemble_options, options), AT(ensemble_options, threads), AT(ensemble_options, stop),

  SIZE(stats), AT(stats, steps), AT(stats, rejected), AT(stats, nfe), AT(stats, nje),
  AT(stats, nlu), AT(stats, nsolve), AT(stats, cpu_s), AT(stats, rounding),
  SIZE(repair), AT(repair, moved), AT(repair, index), AT(repair, y), AT(repair, message), AT(repair, jumps), AT(repair, jumped),

  SIZE(linear), AT(linear, E), AT(linear, F), AT(linear, f), AT(linear, user),
  SIZE(analysis), AT(analysis, algorithm),
  SIZE(structure), AT(structure, n), AT(structure, regular), AT(structure, index),
  AT(structure, index_least), AT(structure, finite), AT(structure, infinite),
  AT(structure, certified), AT(structure, method), AT(structure, message),
  SIZE(impulse), AT(impulse, n), AT(impulse, index), AT(impulse, count), AT(impulse, x_plus),
  AT(impulse, c), AT(impulse, estimate), AT(impulse, resolution), AT(impulse, certified),
  AT(impulse, method), AT(impulse, message),

  SIZE(weak_query), AT(weak_query, method), AT(weak_query, problem), AT(weak_query, convention),
  AT(weak_query, start), AT(weak_query, h), AT(weak_query, rows), AT(weak_query, component),
  AT(weak_query, values), AT(weak_query, exacts), AT(weak_query, linear), AT(weak_query, x0),
  AT(weak_query, break_count), AT(weak_query, breaks), AT(weak_query, restart),
  SIZE(weak_row), AT(weak_row, h), AT(weak_row, value), AT(weak_row, error), AT(weak_row, order),
  AT(weak_row, rounding), AT(weak_row, usable),
  SIZE(weak_result), AT(weak_result, exact), AT(weak_result, verdict),
  AT(weak_result, converges), AT(weak_result, accuracy), AT(weak_result, source),
  AT(weak_result, index), AT(weak_result, note), AT(weak_result, mesh),

  SIZE(state_space), AT(state_space, n), AT(state_space, m), AT(state_space, p),
  AT(state_space, A), AT(state_space, B), AT(state_space, C), AT(state_space, D),
  SIZE(finite_part), AT(finite_part, form), AT(finite_part, index), AT(finite_part, terms),
  AT(finite_part, polynomial),
  SIZE(discrete), AT(discrete, scheme), AT(discrete, dt), AT(discrete, form), AT(discrete, B0),
  AT(discrete, Bm), AT(discrete, B1), AT(discrete, re), AT(discrete, im), AT(discrete, alias),
};
/* clang-format on */

long steif_layout(const char *member)
{
  for (size_t i = 0; member && i < sizeof rows / sizeof *rows; i++)
    if (!strcmp(rows[i].name, member)) return rows[i].bytes;
  return -1;
}
