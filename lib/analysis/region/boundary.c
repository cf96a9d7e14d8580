/* boundary.c: the curve rho(M(z)) = 1 by marching squares, for any method.
 *
 * rho - 1 is known on a grid over a box that holds the curve (found by scanning rays); each
 * cell that the curve enters joins two of its edges, the joined edges form chains, and the
 * points sent back are bisected on their edges. rho(M(conj z)) = rho(M(z)): only the upper half
 * is evaluated.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "region.h"
#include <math.h>
#include <string.h>

enum { RAYS = 36, LEAST = 64, MOST = 256, PIECES = 16, SHORTEST = 6 };
#define FAR 1e3       /* crossings further out are not drawn */
#define DEFAULT_BOX 8 /* half width where rays meet no boundary (Gauss: the imaginary axis) */
#define MARGIN 0.08
#define OFFSET 0.38196601125010515 /* of a column: keeps the grid off the imaginary axis */

typedef struct piece {
  int first, length; /* in the list of edges */
  bool closed;
} piece;

typedef struct contour {
  stf_scan *scan;
  int n;                  /* n x n grid points, n even, rows mirrored */
  sunrealtype x0, dx, dy; /* x_i = x0 + i dx, y_j = (j - (n-1)/2) dy */
  unsigned char *grows;   /* rho > 1 at grid points */
  int (*next)[2];         /* the edges joined to an edge, -1: none */
  int *list;              /* edges in the order of the chains */
  bool *seen;
  piece pieces[PIECES];
  int count;
} contour;

typedef struct box {
  sunrealtype left, right, top;
} box;

static void widen(box *b, sunrealtype re, sunrealtype im)
{
  b->left = fmin(b->left, re);
  b->right = fmax(b->right, re);
  b->top = fmax(b->top, im);
}

/* The box of all crossings on rays, the origin included. */
static box surround(stf_scan *scan)
{
  box b = {0, 0, 0};
  const sunrealtype pi = acos(-1.0);
  for (int a = 0; a < RAYS; a++) {
    const sunrealtype angle = (a + 0.5) * pi / RAYS, c = cos(angle), s = sin(angle);
    bool before = c > 0; /* rho - 1 is Re z near the origin */
    for (sunrealtype r = 0.01; r < FAR; r *= 1.15) {
      const bool here = stf_scan_excess(scan, r * c, r * s) > 0;
      if (here != before) widen(&b, r * c, r * s);
      before = here;
    }
  }
  if (b.top == 0) return (box){-DEFAULT_BOX, DEFAULT_BOX, DEFAULT_BOX};
  const sunrealtype rim = 3 * MARGIN * fmax(b.right - b.left, 2 * b.top);
  return (box){b.left - rim, b.right + rim, b.top * (1 + MARGIN) + rim};
}

static sunrealtype row_y(const contour *k, int j) { return (j - (k->n - 1) / 2.0) * k->dy; }

static void sample(contour *k)
{
  const int n = k->n;
  for (int j = n / 2; j < n; j++)
    for (int i = 0; i < n; i++) {
      const bool grows = stf_scan_excess(k->scan, k->x0 + i * k->dx, row_y(k, j)) > 0;
      k->grows[j * n + i] = k->grows[(n - 1 - j) * n + i] = grows;
    }
}

/* Edges: number j n + i runs from (i, j) to the right, n n + j n + i upwards. */
static void join(contour *k, int a, int b)
{
  k->next[a][k->next[a][0] >= 0] = b;
  k->next[b][k->next[b][0] >= 0] = a;
}

static void march(contour *k)
{
  const int n = k->n;
  for (int j = 0; j + 1 < n; j++)
    for (int i = 0; i + 1 < n; i++) {
      const int at = j * n + i, bottom = at, top = at + n, left = n * n + at, right = left + 1;
      const bool a = k->grows[at], b = k->grows[at + 1], c = k->grows[at + n + 1],
                 d = k->grows[at + n];
      int cut[4], cuts = 0;
      if (a != b) cut[cuts++] = bottom;
      if (b != c) cut[cuts++] = right;
      if (c != d) cut[cuts++] = top;
      if (d != a) cut[cuts++] = left;
      if (cuts == 2) join(k, cut[0], cut[1]);
      if (cuts == 4) { /* a saddle: keep the growing corners together */
        join(k, bottom, a ? right : left);
        join(k, top, a ? left : right);
      }
    }
}

/* Append the chain through `edge` to the list. */
static piece follow(contour *k, int edge, int start)
{
  piece p = {start, 0, false};
  for (int from = -1; edge >= 0 && !k->seen[edge];) {
    k->seen[edge] = true;
    k->list[start + p.length++] = edge;
    const int *next = k->next[edge], to = next[0] == from ? next[1] : next[0];
    from = edge;
    edge = to;
  }
  p.closed = edge >= 0;
  return p;
}

/* Keep the longest pieces, longest first. */
static void keep(contour *k, piece p)
{
  if (p.length < SHORTEST) return;
  int at = k->count < PIECES ? k->count++ : PIECES - 1;
  if (at == PIECES - 1 && k->pieces[at].length >= p.length) return;
  for (; at > 0 && k->pieces[at - 1].length < p.length; at--) k->pieces[at] = k->pieces[at - 1];
  k->pieces[at] = p;
}

/* Open chains first, from an end; what is left are loops. */
static void collect(contour *k)
{
  const int edges = 2 * k->n * k->n;
  int used = 0;
  for (int loops = 0; loops < 2; loops++)
    for (int e = 0; e < edges; e++) {
      const bool end = k->next[e][0] >= 0 && k->next[e][1] < 0;
      if (k->seen[e] || k->next[e][0] < 0 || (!loops && !end)) continue;
      const piece p = follow(k, e, used);
      used += p.length;
      keep(k, p);
    }
}

/* The point of the curve on an edge, by bisection. */
static void locate(const contour *k, int edge, sunrealtype point[2])
{
  const int n = k->n, at = edge % (n * n), upward = edge >= n * n;
  const sunrealtype x = k->x0 + at % n * k->dx, y = row_y(k, at / n);
  const sunrealtype step_x = upward ? 0 : k->dx, step_y = upward ? k->dy : 0;
  const bool first = k->grows[at];
  sunrealtype low = 0, high = 1;
  for (int i = 0; i < 48; i++) {
    const sunrealtype middle = (low + high) / 2;
    const bool grows =
      stf_scan_excess(k->scan, x + middle * step_x, fabs(y + middle * step_y)) > 0;
    *(grows == first ? &low : &high) = middle;
  }
  point[0] = x + (low + high) / 2 * step_x;
  point[1] = y + (low + high) / 2 * step_y;
}

/* Share `count` points among the pieces by length, NaN between pieces and after the last. */
static void emit(const contour *k, size_t count, sunrealtype *points)
{
  size_t total = 0, out = 0;
  for (int p = 0; p < k->count; p++) total += (size_t)k->pieces[p].length + 2;
  for (int p = 0; p < k->count; p++) {
    const piece *q = k->pieces + p;
    const size_t all = (size_t)q->length + q->closed;
    size_t some = total <= count ? all : count * ((size_t)q->length + 2) / total;
    some = some > 1 && total > count ? some - 1 : some; /* the break */
    for (size_t i = 0; i < some && some > 1 && out < count; i++, out++) {
      const size_t pick = (i * (all - 1) + (some - 1) / 2) / (some - 1);
      locate(k, k->list[q->first + (int)(pick % (size_t)q->length)], points + 2 * out);
    }
    if (out < count) {
      points[2 * out] = points[2 * out + 1] = NAN;
      out++;
    }
  }
  for (; out < count; out++) points[2 * out] = points[2 * out + 1] = NAN;
}

static int trace(contour *k, size_t count, sunrealtype *points)
{
  const size_t cells = (size_t)k->n * (size_t)k->n;
  steif_context *ctx = k->scan->ctx;
  k->grows = stf_allocate(ctx, cells, sizeof *k->grows);
  k->next = stf_allocate(ctx, 2 * cells, sizeof *k->next);
  k->list = stf_allocate(ctx, 2 * cells, sizeof *k->list);
  k->seen = stf_allocate(ctx, 2 * cells, sizeof *k->seen);
  if (!k->grows || !k->next || !k->list || !k->seen) return STEIF_NO_MEMORY;
  for (size_t e = 0; e < 2 * cells; e++) k->next[e][0] = k->next[e][1] = -1;
  sample(k);
  march(k);
  collect(k);
  emit(k, count, points);
  return k->scan->code;
}

static int boundary(stf_scan *scan, size_t count, sunrealtype *points)
{
  const box all = {-DEFAULT_BOX, DEFAULT_BOX, DEFAULT_BOX};
  const box b = scan->star ? all : surround(scan);
  const size_t wanted = count / 2 < LEAST ? LEAST : count / 2 > MOST ? MOST : count / 2;
  contour k = {.scan = scan, .n = (int)wanted & ~1};
  k.dx = (b.right - b.left) / (k.n - 1);
  k.dy = 2 * b.top / (k.n - 1);
  k.x0 = (floor(b.left / k.dx) + OFFSET) * k.dx;
  const int code = scan->code == STEIF_OK ? trace(&k, count, points) : scan->code;
  stf_release(scan->ctx, k.grows);
  stf_release(scan->ctx, k.next);
  stf_release(scan->ctx, k.list);
  stf_release(scan->ctx, k.seen);
  return code;
}

int steif_region_boundary(steif_context *ctx, const char *method, int star, size_t count,
                          sunrealtype *points)
{
  stf_scan scan;
  STEIF_CHECK(count >= 2, ctx, STEIF_BAD_INPUT,
              "%zu points make no boundary: ask for two or more", count);
  STEIF_TRY(stf_scan_open(&scan, ctx, method));
  scan.star = star;
  const int code = boundary(&scan, count, points);
  stf_scan_close(&scan);
  return code;
}
