/* layout.c: offsets of members by name.
 * SPDX-License-Identifier: BSD-3-Clause */
#include <steif/layout.h>
#include <steif/solver.h>
#include <string.h>

#define SIZE(type)                                                                             \
  {                                                                                            \
#type, (long)sizeof(steif_##type)                                                          \
  }
#define AT(type, member)                                                                       \
  {                                                                                            \
#type "." #member, (long)offsetof(steif_##type, member)                                    \
  }

static const struct {
  const char *name;
  long bytes;
} rows[] = {
  SIZE(problem),           AT(problem, name),
  AT(problem, n),          AT(problem, t0),
  AT(problem, t1),         AT(problem, y0),
  AT(problem, yp0),        AT(problem, f),
  AT(problem, F),          AT(problem, jac),
  AT(problem, E),          AT(problem, A),
  AT(problem, user),       AT(problem, storage),
  AT(problem, pattern),    AT(problem, index),
  AT(problem, dae_index),  AT(problem, linear),
  AT(problem, events),     AT(problem, event),
  AT(problem, event_list), SIZE(event),
  AT(event, name),         AT(event, direction),
  AT(event, terminal),     SIZE(options),
  AT(options, rtol),       AT(options, atol),
  AT(options, atols),      AT(options, h),
  AT(options, h0),         AT(options, h_max),
  AT(options, t1),         AT(options, max_steps),
  AT(options, observe),    AT(options, on_event),
  AT(options, stop),       SIZE(stats),
  AT(stats, steps),        AT(stats, rejected),
  AT(stats, nfe),          AT(stats, nje),
  AT(stats, nlu),          AT(stats, nsolve),
  AT(stats, cpu_s),
};

long steif_layout(const char *member)
{
  for (size_t i = 0; member && i < sizeof rows / sizeof *rows; i++)
    if (!strcmp(rows[i].name, member)) return rows[i].bytes;
  return -1;
}
