/* phi_step.c: phi functions of h L inside a step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "phi_step.h"
#include "lapack.h"
#include <string.h>

/* n up to which matrices serve for band and sparse L: about 30 n^3 once, or in every step. */
enum { STEADY = 256, CHANGING = 24, DIMENSION = 40 };

static bool by_matrices(const stf_system *s, bool steady)
{
  if (s->storage == STEIF_KRYLOV || !stf_array(s->space.like)) return false;
  return s->storage == STEIF_DENSE || s->space.n <= (steady ? STEADY : CHANGING);
}

static void destroy_action(void *action)
{
  steif_action *a = action;
  steif_action_free(&a);
}

static int open_action(stf_pool *pool, stf_phis *f)
{
  const steif_action_options o = {.dimension = DIMENSION};
  const stf_system *s = f->system;
  f->action = stf_action_open(s->ctx, s->pencil, s->space.like, &o);
  if (!f->action) return steif_status(s->ctx);
  return stf_pool_adopt(pool, f->action, destroy_action);
}

static int open_matrices(stf_pool *pool, stf_phis *f)
{
  const stf_system *s = f->system;
  const size_t count = (size_t)s->space.n * (size_t)s->space.n;
  f->n = (int)s->space.n;
  f->L = stf_pool_array(pool, count, sizeof *f->L);
  f->scaled = stf_pool_array(pool, count, sizeof *f->scaled);
  f->phi = stf_pool_array(pool, (size_t)f->nodes, sizeof *f->phi);
  f->core = stf_pool_array(pool, stf_core_bytes(f->n, f->p), 1);
  f->unit = stf_pool_vector(pool, s->space.like);
  f->image = stf_pool_vector(pool, s->space.like);
  if (!f->L || !f->scaled || !f->phi || !f->core || !f->unit || !f->image)
    return STEIF_NO_MEMORY;
  for (int i = 0; i < f->nodes; i++)
    if (!(f->phi[i] = stf_pool_array(pool, (size_t)(f->p + 1) * count, sizeof **f->phi)))
      return STEIF_NO_MEMORY;
  return stf_phis_renew(f);
}

int stf_phis_open(stf_pool *pool, stf_system *system, int p, int nodes, const sunrealtype *node,
                  bool steady, stf_phis *f)
{
  *f = (stf_phis){.system = system, .p = p, .nodes = nodes, .node = node};
  return by_matrices(system, steady) ? open_matrices(pool, f) : open_action(pool, f);
}

/* L by its columns L e_j. */
int stf_phis_renew(stf_phis *f)
{
  if (f->action) return stf_action_renew(f->action);
  const size_t n = (size_t)f->n;
  double *e = stf_array(f->unit);
  f->h = 0;
  for (size_t j = 0; j < n; j++) {
    e[j] = 1;
    const int code = steif_pencil_product(f->system->pencil, 'A', f->unit, f->image);
    e[j] = 0;
    STEIF_TRY(code);
    memcpy(f->L + n * j, stf_array(f->image), n * sizeof *f->L);
  }
  return STEIF_OK;
}

void stf_phis_aim(stf_phis *f, sunrealtype relative, sunrealtype absolute)
{
  if (f->action) stf_action_aim(f->action, relative, absolute);
}

/* The matrices for h. */
static int evaluate(stf_phis *f, sunrealtype h)
{
  stf_core core;
  const size_t count = (size_t)f->n * (size_t)f->n;
  f->h = 0;
  for (int i = 0; i < f->nodes; i++) {
    for (size_t j = 0; j < count; j++) f->scaled[j] = f->node[i] * h * f->L[j];
    stf_core_open(&core, f->system->ctx, f->n, f->p, f->core);
    STEIF_TRY(stf_core_phi(&core, f->scaled, f->phi[i]));
    f->factors++;
  }
  f->h = h;
  return STEIF_OK;
}

int stf_phis_apply(stf_phis *f, sunrealtype h, int node, N_Vector *b, N_Vector w)
{
  int p = f->p;
  while (p > 0 && !b[p]) p--;
  if (f->action) return steif_action_apply(f->action, f->node[node] * h, p, b, w, NULL);
  if (f->h != h) STEIF_TRY(evaluate(f, h));
  const int one = 1;
  const double unit = 1;
  const size_t count = (size_t)f->n * (size_t)f->n;
  stf_zero(&f->system->space, w);
  for (int k = 1; k <= p; k++)
    if (b[k])
      dgemv_("N", &f->n, &f->n, &unit, f->phi[node] + (size_t)k * count, &f->n, stf_array(b[k]),
             &one, &unit, stf_array(w), &one, 1);
  return STEIF_OK;
}

void stf_phis_keep(stf_phis *f, stf_image *m)
{
  const size_t bytes = (size_t)f->n * (size_t)f->n * sizeof *f->L;
  STF_KEEP(m, f->factors);
  STF_KEEP(m, f->h);
  if (f->action) {
    STF_KEEP(m, f->action->facts);
    STF_KEEP(m, f->action->gamma);
    STF_KEEP(m, f->action->absolute);
    STF_KEEP(m, f->action->o.tolerance);
    return;
  }
  stf_keep(m, f->L, bytes);
  for (int i = 0; i < f->nodes; i++) stf_keep(m, f->phi[i], (size_t)(f->p + 1) * bytes);
}
