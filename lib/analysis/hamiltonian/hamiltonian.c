/* hamiltonian.c: the four questions about x' = A x, by its clusters of eigenvalues.
 *
 * Answers are 1, 0 or -1, undecided: `all` of several is 0 if one is, `any` is 1 if one is.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "hamiltonian_thresholds.h"
#include "lyapunov_equation.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static int all(int a, int b) { return a == 0 || b == 0 ? 0 : a < 0 || b < 0 ? -1 : 1; }
static int any(int a, int b) { return a == 1 || b == 1 ? 1 : a < 0 || b < 0 ? -1 : 0; }

/* Is the value 0, known to `radius` only? */
static int vanishes(double value, double radius)
{
  return value <= radius ? 1 : value > STEIF_DOUBT * radius ? 0 : -1;
}

typedef struct question {
  steif_context *ctx;
  stf_spectrum s;
  stf_partner *partner;
  int *weyr; /* of all clusters, one after another */
  stf_number *block;
  steif_hamiltonian *h;
  const double *A;
} question;

/* Do two means add up to 0? A cluster whose eigenvalues lie apart hides which of them do. */
static int opposite(const stf_cluster *a, const stf_cluster *b)
{
  const double sum = cabs(a->mean + b->mean), radius = a->radius + b->radius;
  if (sum <= radius) return 1;
  return sum <= STEIF_DOUBT * radius || sum <= a->spread + b->spread ? -1 : 0;
}

static int look_at(question *q, int k, int *weyr)
{
  const stf_spectrum *s = &q->s;
  const stf_cluster *c = s->cluster + k;
  stf_partner *p = q->partner + k;
  *p = (stf_partner){.other = -1, .weyr = weyr};
  for (int j = 0; j < s->count; j++) {
    const int matched = opposite(c, s->cluster + j);
    if (matched == 1 || (matched < 0 && p->matched == 0)) {
      p->other = j;
      p->matched = matched;
    }
  }
  stf_spectrum_block(s, k, q->block);
  return stf_weyr(q->ctx, c->size, q->block, c->radius, p->weyr, &p->sure);
}

static double size_of_block(question *q, int k)
{
  const int m = q->s.cluster[k].size;
  double size = 0;
  stf_spectrum_block(&q->s, k, q->block);
  for (int i = 0; i < m * m; i++) size = hypot(size, cabs(q->block[i]));
  return size;
}

/* -- the questions ------------------------------------------------------------------------------- */

static const char *word(int answer)
{
  return answer == 1 ? "yes" : answer == 0 ? "no" : "undecided";
}

/* Why it is not "yes": the real part or the block of one cluster. */
static void blame(question *q, int now, const stf_cluster *c, bool part, double size)
{
  snprintf(q->h->message, sizeof q->h->message,
           part
             ? "definite: %s, eigenvalue %.6g%+.6gi has the real part %.3g, known to %.2g"
             : "definite: %s, eigenvalue %.6g%+.6gi is defective, its block is of size %.3g, "
               "known to %.2g",
           word(now), creal(c->mean), cimag(c->mean), size, c->radius);
}

/* *semisimple: no Jordan blocks. */
static int definite(question *q, bool *semisimple)
{
  const stf_spectrum *s = &q->s;
  int answer = 1;
  *semisimple = true;
  snprintf(q->h->message, sizeof q->h->message,
           "definite: yes, all eigenvalues are imaginary and none is defective");
  for (int k = 0; k < s->count; k++) {
    const stf_cluster *c = s->cluster + k;
    const double real = creal(c->mean), block = size_of_block(q, k);
    const int on_axis = vanishes(fabs(real), c->radius), simple = vanishes(block, c->radius),
              now = all(on_axis, simple);
    *semisimple = *semisimple && simple == 1;
    if (all(answer, now) == answer) continue;
    answer = now;
    blame(q, now, c, on_axis == now, on_axis == now ? real : block);
  }
  return answer;
}

static int invariant(const question *q)
{
  int answer = 0;
  for (int k = 0; k < q->s.count; k++) answer = any(answer, q->partner[k].matched);
  return answer;
}

/* The blocks of even (or odd) size at 0 come in pairs. */
static int paired(const question *q, int k, int odd)
{
  const stf_partner *p = q->partner + k;
  if (!p->sure) return -1;
  for (int a = 1; a <= q->s.cluster[k].size; a++) {
    const int next = a < q->s.cluster[k].size ? p->weyr[a] : 0;
    if (a % 2 == odd && (p->weyr[a - 1] - next) % 2) return 0;
  }
  return 1;
}

static int full_rank(const question *q, int odd)
{
  const stf_cluster *c = q->s.cluster;
  int answer = 1;
  for (int k = 0; k < q->s.count; k++) {
    const stf_partner *p = q->partner + k;
    int here = p->matched;
    if (here == 1 && p->other == k)
      here = paired(q, k, odd);
    else if (here == 1 && c[p->other].size != c[k].size)
      here = 0;
    else if (here == 1)
      here =
        !p->sure || !q->partner[p->other].sure
          ? -1
          : !memcmp(p->weyr, q->partner[p->other].weyr, (size_t)c[k].size * sizeof *p->weyr);
    answer = all(answer, here);
  }
  return answer;
}

/* sum_p w_p w'_p over pairs of clusters; at 0 the symmetric ones of them: blocks of sizes a and b
 * have min(a, b), a block by itself (a + 1)/2 of its a solutions. */
static int dimension(const question *q)
{
  int total = 0;
  for (int k = 0; k < q->s.count; k++) {
    const stf_partner *p = q->partner + k;
    if (p->matched < 0) return -1;
    if (p->matched == 0 || p->other < k) continue;
    const int *w = p->weyr, *v = q->partner[p->other].weyr, size = q->s.cluster[k].size,
              other = q->s.cluster[p->other].size;
    if (!p->sure || !q->partner[p->other].sure) return -1;
    int sum = 0, alone = 0;
    for (int i = 0; i < size && i < other; i++) sum += w[i] * v[i];
    for (int i = 0; i < size; i += 2) alone += w[i] - (i + 1 < size ? w[i + 1] : 0);
    total += p->other == k ? (sum + alone) / 2 : sum;
  }
  return total;
}

/* -- the solutions ------------------------------------------------------------------------------- */

/* The best conditioned of a few. */
static int random_form(question *q, int sign, bool singular, double *P, steif_form_found *f)
{
  const int n = q->s.n;
  const size_t square = (size_t)n * (size_t)n;
  unsigned seed = 20240611;
  double *draw = stf_allocate(q->ctx, square, sizeof *draw);
  int code = draw ? STEIF_OK : STEIF_NO_MEMORY;
  bool found = true;
  for (int i = 0; code == STEIF_OK && i < STF_FORM_DRAWS && !(f->condition < STF_FORM_GOOD);
       i++) {
    steif_form_found next = {.P = draw};
    code = stf_random_solution(&q->s, q->partner, sign, &seed, draw, &found);
    if (code || !found) break;
    code = stf_solution_check(q->ctx, n, q->A, singular, &next);
    if (code || (f->P && !(next.condition < f->condition))) continue;
    memcpy(P, draw, square * sizeof *P);
    *f = next;
    f->P = P;
    if (singular) break;
  }
  stf_release(q->ctx, draw);
  return code;
}

/* A P that rounding has spoilt proves nothing. */
static int canonical(question *q, double *P)
{
  steif_hamiltonian *h = q->h;
  steif_form_found *f = &h->symmetric;
  STEIF_TRY(stf_canonical_solution(&q->s, P));
  f->P = P;
  STEIF_TRY(stf_solution_check(q->ctx, q->s.n, q->A, false, f));
  const size_t used = strlen(h->message);
  if (h->definite == 1 && !(f->distance <= STEIF_DOUBT * h->tolerance * f->condition)) {
    h->definite = -1;
    snprintf(
      h->message, sizeof h->message,
      "definite: undecided, P has the condition number %.2g and solves a system %.2g away",
      f->condition, f->distance);
  } else if (h->definite != 1 && f->distance <= STEIF_NEAR)
    snprintf(h->message + used, sizeof h->message - used,
             "; a change of A by %.2e of its size makes it definite", f->distance);
  if (h->definite == 0 && !(f->distance <= STEIF_NEAR)) f->P = NULL;
  return STEIF_OK;
}

static int solutions(question *q, bool semisimple, double *P, double *K)
{
  steif_hamiltonian *h = q->h;
  if (semisimple) STEIF_TRY(canonical(q, P));
  if (!h->symmetric.P) {
    h->symmetric = (steif_form_found){.residual = NAN, .condition = NAN, .distance = NAN};
    if (h->invariant == 1) STEIF_TRY(random_form(q, 1, h->nonsingular != 1, P, &h->symmetric));
  }
  h->skew = (steif_form_found){.residual = NAN, .condition = NAN, .distance = NAN};
  return h->symplectic == 1 ? random_form(q, -1, false, K, &h->skew) : STEIF_OK;
}

static int ask(question *q, double *room)
{
  steif_hamiltonian *h = q->h;
  stf_spectrum *s = &q->s;
  const size_t n = (size_t)s->n;
  double *re = room, *im = re + n, *P = im + n, *K = P + n * n;
  bool semisimple;
  for (int k = 0, at = 0; k < s->count; at += s->cluster[k++].size)
    STEIF_TRY(look_at(q, k, q->weyr + at));
  for (size_t i = 0; i < n; i++) {
    re[i] = creal(s->T[i + n * i]);
    im[i] = cimag(s->T[i + n * i]);
  }
  h->re = re;
  h->im = im;
  h->definite = definite(q, &semisimple);
  h->nonsingular = full_rank(q, 0);
  h->symplectic = full_rank(q, 1);
  h->invariant = invariant(q);
  h->dimension = dimension(q);
  return solutions(q, semisimple, P, K);
}

static int check(steif_context *ctx, int n, const double *A, double tolerance)
{
  enum { LARGEST = 10000 };
  STEIF_CHECK(A && n >= 1 && n <= LARGEST, ctx, STEIF_BAD_INPUT,
              "A is %s, of order %d: n x n numbers with n from 1 to %d are needed",
              A ? "given" : "NULL", n, LARGEST);
  STEIF_CHECK(tolerance >= 0 && tolerance < 1, ctx, STEIF_BAD_INPUT,
              "tolerance = %g must lie in [0, 1)", tolerance);
  for (int i = 0; i < n * n; i++)
    STEIF_CHECK(isfinite(A[i]), ctx, STEIF_NOT_FINITE,
                "A(%d, %d) is %g: finite numbers are needed", i % n + 1, i / n + 1, A[i]);
  return STEIF_OK;
}

static int answer(question *q, int n)
{
  const size_t size = (size_t)n, square = size * size;
  double *room = stf_allocate(q->ctx, 2 * square + 2 * size, sizeof *room);
  q->h->memory = room;
  q->partner = stf_allocate(q->ctx, size, sizeof *q->partner);
  q->weyr = stf_allocate(q->ctx, size, sizeof *q->weyr);
  q->block = stf_allocate(q->ctx, square, sizeof *q->block);
  const int code = room && q->partner && q->weyr && q->block ? ask(q, room) : STEIF_NO_MEMORY;
  stf_release(q->ctx, q->block);
  stf_release(q->ctx, q->weyr);
  stf_release(q->ctx, q->partner);
  return code;
}

int steif_hamiltonian_find(steif_context *ctx, int n, const double *A, double tolerance,
                           steif_hamiltonian *h)
{
  STEIF_CHECK(h, ctx, STEIF_BAD_INPUT, "room for the answer is needed");
  *h = (steif_hamiltonian){0};
  STEIF_TRY(check(ctx, n, A, tolerance));
  h->tolerance = tolerance > 0 ? tolerance : 5 * n * STF_EPS;
  question q = {.ctx = ctx, .h = h, .A = A};
  STEIF_TRY(stf_spectrum_open(&q.s, ctx, n, A, h->tolerance));
  const int code = answer(&q, n);
  stf_spectrum_close(&q.s);
  if (code) steif_hamiltonian_clear(ctx, h);
  return code;
}

void steif_hamiltonian_clear(steif_context *ctx, steif_hamiltonian *h)
{
  if (!h) return;
  stf_release(ctx, h->memory);
  *h = (steif_hamiltonian){0};
}
