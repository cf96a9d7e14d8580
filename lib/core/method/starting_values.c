/* starting_values.c: further values at equal distances: Radau IIA of enough order, or for explicit
 * methods the extrapolated midpoint rule (W. B. Gragg, SIAM J. Numer. Anal. 2 (1965)).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "starting_values.h"
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

static int open_explicit(stf_step *s, int order, stf_begin *b)
{
  b->rows = order / 2 + 1;
  b->row = stf_pool_vectors(s->pool, b->rows + 2, s->y);
  b->slope = stf_pool_vector(s->pool, s->y);
  b->before = stf_pool_vector(s->pool, s->y);
  return b->row && b->slope && b->before ? STEIF_OK : STEIF_NO_MEMORY;
}

int stf_begin_open(stf_step *s, int count, int order, bool explicit_, stf_begin *b)
{
  b->count = count;
  b->value = stf_pool_vectors(s->pool, count + 1, s->y);
  if (!b->value) return STEIF_NO_MEMORY;
  return count == 0 ? STEIF_OK : (explicit_ ? open_explicit : open_implicit)(s, order, b);
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
  for (int i = 0; i < b->count && code == STEIF_OK; i++) {
    in->t = s->t + i * d, in->h_try = d;
    code = in->method->attempt(in, d);
    if (code) break;
    in->method->commit(in);
    in->h = d, in->count++, in->restart = false, in->newton.jacobian_new = false;
    stf_copy(space, in->y, b->value[i + 1]);
  }
  s->newton.factored = false, s->newton.jacobian_wanted = true;
  s->newton.sweeps += in->newton.sweeps - sweeps, s->newton.fails += in->newton.fails - fails;
  return code;
}

/* n steps of d / n of the midpoint rule, begun with Euler's, into `out`. */
static int midpoint(stf_step *s, stf_begin *b, sunrealtype t, N_Vector y, sunrealtype d, int n,
                    N_Vector out)
{
  const stf_space *space = &s->system.space;
  const sunrealtype e = d / n;
  stf_copy(space, y, b->before);
  STEIF_TRY(stf_system_rhs(&s->system, t, y, b->slope));
  stf_sum(space, 1, y, e, b->slope, out);
  for (int m = 1; m < n; m++) {
    STEIF_TRY(stf_system_rhs(&s->system, t + m * e, out, b->slope));
    stf_axpy(space, 2 * e, b->slope, b->before);
    N_Vector kept = b->row[b->rows];
    stf_copy(space, out, kept), stf_copy(space, b->before, out);
    stf_copy(space, kept, b->before);
  }
  return STEIF_OK;
}

/* Aitken's and Neville's scheme in (d / n)^2, n = 2, 4, ..; row[j] is column j of the last row.
 * */
static int extrapolated(stf_step *s, stf_begin *b, sunrealtype t, N_Vector y, sunrealtype d,
                        N_Vector out)
{
  const stf_space *space = &s->system.space;
  N_Vector last = b->row[b->rows + 1];
  for (int i = 0; i < b->rows; i++) {
    STEIF_TRY(midpoint(s, b, t, y, d, 2 * (i + 1), out));
    for (int j = 0; j < i; j++) {
      const sunrealtype q = (i + 1.0) / (i - j), w = 1 / (q * q - 1);
      stf_copy(space, b->row[j], last), stf_copy(space, out, b->row[j]);
      stf_sum(space, 1 + w, out, -w, last, out);
    }
    stf_copy(space, out, b->row[i]);
  }
  return STEIF_OK;
}

int stf_begin_run(stf_step *s, stf_begin *b, sunrealtype h)
{
  const sunrealtype d = h / b->count;
  stf_copy(&s->system.space, s->y, b->value[0]);
  if (b->count == 0) return STEIF_OK;
  if (!b->row) return implicit(s, b, d);
  for (int i = 0; i < b->count; i++)
    STEIF_TRY(extrapolated(s, b, s->t + i * d, b->value[i], d, b->value[i + 1]));
  return STEIF_OK;
}
