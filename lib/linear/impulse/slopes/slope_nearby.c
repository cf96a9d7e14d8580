/* slope_nearby.c: the structure of pencils at values of p nearby.
 *
 * Let E and F be analytic in p. The coefficients of det(s E + F) and of the adjugate are analytic, too; those
 * that vanish at one p and not identically make the degrees smaller there than at almost all p. The number of
 * finite eigenvalues is the degree of the determinant, the index 1 + the degree of the adjugate less that. So
 *
 *   more finite eigenvalues, or as many and a larger index: p is singular, the structure does not stay;
 *   fewer, or as many and a smaller index: the pencil nearby lies at a singular value itself, and says nothing.
 *
 * Steps of p are no powers of 2 and in no ratio of small numbers, for such are the singular values of matrices
 * as people write them.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "slope_nearby.h"

enum { CLOSER = 3 };

/* Above and below p, from far to near. */
static const sunrealtype step[2][CLOSER] = {{0.047213596, 0.0053879217, 0.00061803399},
                                            {-0.037320508, -0.0042426407, -0.00048512693}};

static bool tolerable(int code) { return code == STEIF_NOT_FINITE || code == STEIF_CALLBACK; }

static int pencil_at(const stf_approach *a, sunrealtype by, SUNMatrix *E, SUNMatrix *F)
{
  const steif_impulse_direction *d = a->direction;
  if (d->nearby) return d->nearby(by, E, F, d->user);
  *E = stf_moved_matrix(a->ctx, a->system->E, d->E, by * a->unit);
  *F = stf_moved_matrix(a->ctx, a->system->F, d->F, by * a->unit);
  return *E && *F ? STEIF_OK : STEIF_NO_MEMORY;
}

/* Like E and F of the system. */
static int check(const stf_approach *a, SUNMatrix E, SUNMatrix F)
{
  const sunindextype n = stf_matrix_order(a->system->E);
  STEIF_CHECK(
    E && F && stf_matrix_order(E) == n && stf_matrix_order(F) == n, a->ctx, STEIF_BAD_INPUT,
    "E and F at a p nearby must be matrices of the order %lld of the system", (long long)n);
  return STEIF_OK;
}

static void judge(const stf_approach *a, const steif_structure *near, stf_neighbour *found)
{
  const bool more = near->finite > a->finite, as_many = near->finite == a->finite;
  if (!near->certified || !near->regular || near->index < 0) return;
  if (more || (as_many && near->index > a->index))
    *found = (stf_neighbour){STF_GROWS, near->index, near->finite};
  else if (as_many && near->index == a->index)
    *found = (stf_neighbour){STF_STAYS, near->index, near->finite};
}

static int look_at(const stf_approach *a, sunrealtype by, stf_neighbour *found)
{
  SUNMatrix E = NULL, F = NULL;
  steif_structure near = {0};
  int code = pencil_at(a, by, &E, &F);
  if (!code) code = check(a, E, F);
  if (!code) code = steif_structure_find(a->ctx, E, F, a->analysis, &near);
  if (!code) {
    judge(a, &near, found);
    steif_structure_clear(a->ctx, &near);
  }
  if (E) SUNMatDestroy(E);
  if (F) SUNMatDestroy(F);
  if (!tolerable(code)) return code;
  steif_forget(a->ctx); /* p beyond what the matrices are defined for */
  return STEIF_OK;
}

int stf_approach_look(const stf_approach *a, stf_neighbour *found)
{
  stf_neighbour side[2];
  for (int k = 0; k < 2; k++) {
    side[k] = (stf_neighbour){STF_OPEN, -1, -1};
    for (int i = 0; i < CLOSER && side[k].verdict == STF_OPEN; i++)
      STEIF_TRY(look_at(a, step[k][i], side + k));
    *found = side[k];
    if (side[k].verdict == STF_GROWS) return STEIF_OK;
  }
  if (side[0].verdict == STF_OPEN) *found = side[0];
  return STEIF_OK;
}
