/* forcing_rate.c: how fast f changes, and whether it does so between its breaks only as its derivatives say.
 *
 * On [a, b], d_j = f^(j)(b) - f^(j)(a) - Simpson's rule for int f^(j+1) is small where f is smooth and
 * [a, b] short. Where it is not, the half with the larger one is looked at in turn: on a length on which d_j
 * has become small f changes at the rate 1/length; if it never does, f^(j) jumps there.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "measure.h"
#include <math.h>
#include <nvector/nvector_serial.h>

/* d_j is small below SMALL of the largest |f^(j)|, or FAINT of the largest derivative in units of t1; a
 * place is known to WIDTH of t1, breaks are declared to INSET of it. Points keep ASIDE, so that round numbers
 * are none of them. */
#define SMALL 1e-3
#define FAINT 1e-9
#define WIDTH 1e-11
#define INSET 1e-9
#define ASIDE 0.1831
enum { LOOKS = 500, MOST = STF_DERIVATIVES };

typedef struct look {
  const stf_measure *measure;
  steif_forcing f;
  void *user;
  int known;                 /* derivatives 0 .. known - 1 */
  sunrealtype largest[MOST]; /* of each of them */
} look;

/* sum += factor f^(j)(t); false: not known there. */
static bool add(const look *l, sunrealtype t, int j, sunrealtype factor, sunrealtype *sum)
{
  N_Vector room = l->measure->room;
  if (l->f(t, j, room, l->user)) return false;
  const sunrealtype *f = N_VGetArrayPointer(room);
  for (int i = 0; i < l->measure->subject.n; i++) sum[i] += factor * f[i];
  return true;
}

/* The largest |d_j| of all components; 0 where it is not known. */
static sunrealtype defect(const look *l, int j, sunrealtype a, sunrealtype b)
{
  sunrealtype *d = l->measure->away, most = 0;
  const int n = l->measure->subject.n;
  const sunrealtype part = (b - a) / 6;
  for (int i = 0; i < n; i++) d[i] = 0;
  if (!add(l, b, j, 1, d) || !add(l, a, j, -1, d) || !add(l, a, j + 1, -part, d) ||
      !add(l, b, j + 1, -part, d) || !add(l, a + (b - a) / 2, j + 1, -4 * part, d))
    return 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(d[i]));
  return most;
}

/* The largest values, at places between breaks; *rate: (|f^(j)| / |f|)^(1/j). */
static void sizes(look *l, sunrealtype *rate)
{
  const stf_measure *w = l->measure;
  const int wanted = w->subject.index + 1 < MOST ? w->subject.index + 1 : MOST;
  *rate = 0;
  for (l->known = 0; l->f && l->known < wanted; l->known++) {
    sunrealtype most = 0;
    for (int i = 0; i < LOOKS; i++) {
      const sunrealtype t = (sunrealtype)w->subject.weight.t1 * (i + 0.5) / LOOKS;
      if (l->f(t, l->known, w->room, l->user)) return;
      most = fmax(most, N_VMaxNorm(w->room));
    }
    l->largest[l->known] = most;
    if (l->known > 0 && l->largest[0] > 0)
      *rate = fmax(*rate, pow(most / l->largest[0], 1.0 / l->known));
  }
}

static sunrealtype small(const look *l, int j)
{
  const sunrealtype t1 = (sunrealtype)l->measure->subject.weight.t1;
  sunrealtype size = 0;
  for (int i = 0; i < l->known; i++) size = fmax(size, l->largest[i] * pow(t1, i));
  return SMALL * l->largest[j] + FAINT * size / pow(t1, j);
}

/* Halves [a, b] until d_j is small. */
static int narrow(const look *l, int j, sunrealtype a, sunrealtype b, sunrealtype *rate)
{
  const sunrealtype enough = small(l, j), t1 = (sunrealtype)l->measure->subject.weight.t1;
  if (defect(l, j, a, b) <= enough) return STEIF_OK;
  while (b - a > WIDTH * t1) {
    const sunrealtype middle = a + (b - a) / 2, left = defect(l, j, a, middle),
                      right = defect(l, j, middle, b);
    if (left > right)
      b = middle;
    else
      a = middle;
    if (fmax(left, right) > enough) continue;
    *rate = fmax(*rate, 1 / (b - a));
    return STEIF_OK;
  }
  return STEIF_FAIL(l->measure->ctx, STEIF_BAD_INPUT,
                    "f is not smooth near t = %.11g, where derivative %d of it jumps: name its "
                    "breaks (.breaks)",
                    a, j);
}

/* From one break to the next. */
static int segment(const look *l, sunrealtype from, sunrealtype to, sunrealtype *rate)
{
  for (int j = 0; j + 1 < l->known; j++)
    for (int i = 0; i < LOOKS; i++) {
      const sunrealtype a = i ? from + (to - from) * (i + ASIDE) / LOOKS : from,
                        b = i + 1 < LOOKS ? from + (to - from) * (i + 1 + ASIDE) / LOOKS : to;
      STEIF_TRY(narrow(l, j, a, b, rate));
    }
  return STEIF_OK;
}

int stf_forcing_rate(stf_measure *w)
{
  const stf_subject *s = &w->subject;
  const sunrealtype t1 = (sunrealtype)s->weight.t1;
  look l = {.measure = w,
            .f = s->block.k ? s->block.forcing : s->linear.f,
            .user = s->block.k ? s->block.user : s->linear.user};
  sizes(&l, &w->subject.rate);
  if (!w->query->linear) return STEIF_OK; /* the collection declares its own */
  const size_t count = s->sides.count;
  sunrealtype from = 0;
  for (size_t b = 0; b <= count && from < t1; b++) {
    const sunrealtype to = b < count ? fmin(s->sides.breaks[b], t1) : t1, inset = INSET * t1;
    STEIF_TRY(
      segment(&l, b ? from + inset : from, to < t1 ? to - inset : to, &w->subject.rate));
    from = to;
  }
  return STEIF_OK;
}
