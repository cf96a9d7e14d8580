/* match.c: the cheapest runs that reach some digits, and what they cost on the average.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "workprec.h"
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum side { OURS, AUTO, BASELINE };

static bool on(const steif_bench_solve *run, enum side side)
{
  if (side == AUTO) return !strcmp(run->method, "auto");
  return !run->baseline == (side == OURS);
}

static steif_bench_pick pick(const steif_bench_solve *run, size_t count, enum side side,
                             sunrealtype digits)
{
  steif_bench_pick p = {.rtol = NAN, .atol = NAN, .cpu_s = NAN, .mescd = NAN};
  for (const steif_bench_solve *end = run + count; run < end; run++) {
    if (run->code || !on(run, side) || !(run->mescd >= digits) || run->cpu_s >= p.cpu_s)
      continue;
    snprintf(p.method, sizeof p.method, "%s", run->method);
    p.rtol = run->rtol;
    p.atol = run->atol;
    p.cpu_s = run->cpu_s;
    p.mescd = run->mescd;
  }
  return p;
}

steif_bench_match steif_bench_compare(const steif_bench_solve *solve, size_t count,
                                      sunrealtype digits)
{
  steif_bench_match m = {.digits = digits, .ratio = NAN, .auto_ratio = NAN};
  m.ours = pick(solve, count, OURS, digits);
  m.automatic = pick(solve, count, AUTO, digits);
  m.baseline = pick(solve, count, BASELINE, digits);
  m.ratio = m.ours.cpu_s / m.baseline.cpu_s;
  m.auto_ratio = m.automatic.cpu_s / m.baseline.cpu_s;
  if (count) {
    snprintf(m.problem, sizeof m.problem, "%s", solve->problem);
    m.n = solve->n;
  }
  stf_bench_published(&m);
  return m;
}

/* A geometric mean; numbers that are not positive and finite do not count. */
typedef struct mean {
  long count;
  sunrealtype sum;
} mean;

static void add(mean *m, sunrealtype x)
{
  if (x > 0 && isfinite(x)) {
    m->count++;
    m->sum += log(x);
  }
}

static sunrealtype value(const mean *m)
{
  return m->count ? exp(m->sum / (sunrealtype)m->count) : NAN;
}

sunrealtype steif_bench_speed(const steif_bench_match *match, size_t count)
{
  mean speed = {0};
  for (size_t i = 0; i < count; i++)
    add(&speed, match[i].baseline.cpu_s / match[i].peer_baseline_s);
  return value(&speed);
}

void steif_bench_average(const steif_bench_match *match, size_t count, steif_bench_mean *m)
{
  const sunrealtype speed = steif_bench_speed(match, count);
  mean best = {0}, automatic = {0}, peer = {0};
  m->alone = m->beaten = 0;
  for (size_t i = 0; i < count; i++) {
    const steif_bench_match *one = &match[i];
    if (one->n <= m->least_n || one->n > m->most_n) continue;
    add(&best, one->ratio);
    add(&automatic, one->auto_ratio);
    add(&peer, one->ours.cpu_s / (speed * one->peer_s));
    m->alone += !isnan(one->ours.cpu_s) && isnan(one->baseline.cpu_s);
    m->beaten += isnan(one->ours.cpu_s) && !isnan(one->baseline.cpu_s);
  }
  m->count = best.count;
  m->ratio = value(&best);
  m->auto_count = automatic.count;
  m->auto_ratio = value(&automatic);
  m->peer_count = peer.count;
  m->peer_ratio = value(&peer);
}
