/* starting_values.c: further values at equal distances: Radau IIA of enough order, or for explicit
 * methods the extrapolated midpoint rule (W. B. Gragg, SIAM J. Numer. Anal. 2 (1965)). Both are differentiated
 * by parameters as the steps they are.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "starting_values.h"
#include "carry.h"
#include <stdio.h>

static void destroy_table(void *step)
{
  stf_step *s = step;
  steif_table_free(s->ctx, &s->table);
}

static int open_implicit(stf_step *s, int order, stf_begin *b)
{
  stf_step *in = &b->inner;
  char name[24];
  steif_spec spec;
  *in = *s;
  in->method = &steif_method_irk, in->adaptive = false, in->table = NULL;
  snprintf(name, sizeof name, "radau:s=%d", order / 2 + 2);
  STEIF_TRY(steif_spec_parse(s->ctx, name, &spec));
  if (!(in->table = stf_table_build(s->ctx, &spec))) return steif_status(s->ctx);
  STEIF_TRY(stf_pool_adopt(s->pool, in, destroy_table));
  in->state = stf_pool_array(s->pool, 1, in->method->size);
  in->y = stf_pool_vector(s->pool, s->y);
  in->yp = stf_pool_vector(s->pool, s->y);
  in->next = stf_pool_vector(s->pool, s->y);
  in->error = stf_pool_vector(s->pool, s->y);
  if (!in->state || !in->y || !in->yp || !in->next || !in->error) return STEIF_NO_MEMORY;
  in->newton.tolerance *= 0.01;
  STEIF_TRY(in->method->open(in, &spec, in->table));
  in->newton.system = &s->system; /* one system: operators of the pencil read its last point */
  return STEIF_OK;
}

static int open_parts(stf_step *s, int parts, stf_begin *b)
{
  b->parts = parts;
  b->part = stf_pool_array(s->pool, (size_t)parts, sizeof *b->part);
  for (int j = 0; b->part && j < parts; j++) {
    stf_begin_part *of = b->part + j;
    if (!(of->value = stf_pool_vectors(s->pool, b->count + 1, s->y))) return STEIF_NO_MEMORY;
    if (!b->rows) continue;
    of->row = stf_pool_vectors(s->pool, b->rows + 2, s->y);
    of->slope = stf_pool_vector(s->pool, s->y);
    of->before = stf_pool_vector(s->pool, s->y);
    if (!of->row || !of->slope || !of->before) return STEIF_NO_MEMORY;
  }
  return b->part ? STEIF_OK : STEIF_NO_MEMORY;
}

int stf_begin_open(stf_step *s, int count, int order, bool explicit_, stf_begin *b)
{
  b->count = count;
  b->rows = explicit_ && count > 0 ? order / 2 + 1 : 0;
  STEIF_TRY(open_parts(s, 1, b));
  return count == 0 || explicit_ ? STEIF_OK : open_implicit(s, order, b);
}

int stf_begin_carry(stf_carry *T, stf_begin *b)
{
  stf_step *s = T->step;
  STEIF_TRY(open_parts(s, 1 + T->count, b));
  b->carry = T;
  if (b->count == 0 || b->rows > 0) return STEIF_OK;
  if (!(b->over = stf_pool_array(s->pool, 1, sizeof *b->over))) return STEIF_NO_MEMORY;
  return stf_carry_open(&b->inner, T->count, T->parameter, T->scale, b->over);
}

/* ---- implicit ---------------------------------------------------------------------------------- */

/* A step of `inner` to value i, and of the columns. */
static int inner_step(stf_begin *b, int i, sunrealtype d)
{
  stf_step *in = &b->inner;
  const stf_space *space = &in->system.space;
  in->h_try = d;
  STEIF_TRY(in->method->attempt(in, d));
  if (b->over) STEIF_TRY(stf_carry_carry(b->over, d));
  in->method->commit(in);
  in->h = d, in->t += d, in->count++;
  if (b->over) stf_carry_commit(b->over);
  in->restart = false, in->newton.jacobian_new = false;
  stf_copy(space, in->y, b->part->value[i]);
  for (int k = 0; k + 1 < b->parts; k++)
    stf_copy(space, b->over->S[k], b->part[1 + k].value[i]);
  return STEIF_OK;
}

/* Pencil and counts are common property; factors are not. */
static int implicit(stf_step *s, stf_begin *b, sunrealtype d)
{
  stf_step *in = &b->inner;
  const stf_space *space = &s->system.space;
  int code = STEIF_OK;
  in->newton.factored = false, in->newton.jacobian_new = s->newton.jacobian_new,
  in->newton.jacobian_wanted = true;
  in->restart = true, in->rejected = s->rejected, in->count = 0;
  const long sweeps = in->newton.sweeps, fails = in->newton.fails;
  stf_copy(space, s->y, in->y), stf_copy(space, s->yp, in->yp);
  for (int k = 0; k + 1 < b->parts; k++) stf_copy(space, b->carry->S[k], b->over->S[k]);
  for (int i = 0; i < b->count && !code; i++) {
    in->t = s->t + i * d;
    code = inner_step(b, i + 1, d);
  }
  s->newton.factored = false, s->newton.jacobian_wanted = true;
  s->newton.sweeps += in->newton.sweeps - sweeps, s->newton.fails += in->newton.fails - fails;
  return code;
}

/* ---- explicit ---------------------------------------------------------------------------------- */

/* Slopes of all parts at value i. */
static int slopes(stf_step *s, stf_begin *b, sunrealtype t, int i)
{
  stf_begin_part *of = b->part;
  STEIF_TRY(stf_system_rhs(&s->system, t, of->value[i], of->slope));
  if (b->parts == 1) return STEIF_OK;
  STEIF_TRY(stf_carry_point(b->carry, 0, t, of->value[i], of->slope));
  for (int k = 0; k + 1 < b->parts; k++)
    STEIF_TRY(stf_carry_residual(b->carry, 0, k, of[1 + k].value[i], NULL, of[1 + k].slope));
  return STEIF_OK;
}

/* n steps of d / n of the midpoint rule, begun with Euler's, from value i to value i + 1. */
static int midpoint(stf_step *s, stf_begin *b, sunrealtype t, int i, sunrealtype d, int n)
{
  const stf_space *space = &s->system.space;
  const sunrealtype e = d / n;
  STEIF_TRY(slopes(s, b, t, i));
  for (int j = 0; j < b->parts; j++) {
    const stf_begin_part *of = b->part + j;
    stf_copy(space, of->value[i], of->before);
    stf_sum(space, 1, of->value[i], e, of->slope, of->value[i + 1]);
  }
  for (int m = 1; m < n; m++) {
    STEIF_TRY(slopes(s, b, t + m * e, i + 1));
    for (int j = 0; j < b->parts; j++) {
      const stf_begin_part *of = b->part + j;
      N_Vector out = of->value[i + 1], kept = of->row[b->rows];
      stf_axpy(space, 2 * e, of->slope, of->before);
      stf_copy(space, out, kept), stf_copy(space, of->before, out);
      stf_copy(space, kept, of->before);
    }
  }
  return STEIF_OK;
}

/* Aitken's and Neville's scheme in (d / n)^2, n = 2, 4, ..; row[j] is column j of the last row.
 * */
static int extrapolated(stf_step *s, stf_begin *b, sunrealtype t, int from, sunrealtype d)
{
  const stf_space *space = &s->system.space;
  for (int i = 0; i < b->rows; i++) {
    STEIF_TRY(midpoint(s, b, t, from, d, 2 * (i + 1)));
    for (int m = 0; m < b->parts; m++) {
      const stf_begin_part *of = b->part + m;
      N_Vector out = of->value[from + 1], last = of->row[b->rows + 1];
      for (int j = 0; j < i; j++) {
        const sunrealtype q = (i + 1.0) / (i - j), w = 1 / (q * q - 1);
        stf_copy(space, of->row[j], last), stf_copy(space, out, of->row[j]);
        stf_sum(space, 1 + w, out, -w, last, out);
      }
      stf_copy(space, out, of->row[i]);
    }
  }
  return STEIF_OK;
}

int stf_begin_run(stf_step *s, stf_begin *b, sunrealtype h)
{
  const sunrealtype d = h / b->count;
  stf_copy(&s->system.space, s->y, b->part->value[0]);
  for (int k = 0; k + 1 < b->parts; k++)
    stf_copy(&s->system.space, b->carry->S[k], b->part[1 + k].value[0]);
  if (b->count == 0) return STEIF_OK;
  if (!b->rows) return implicit(s, b, d);
  for (int i = 0; i < b->count; i++) STEIF_TRY(extrapolated(s, b, s->t + i * d, i, d));
  return STEIF_OK;
}
