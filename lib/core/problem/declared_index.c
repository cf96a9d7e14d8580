/* declared_index.c: does the declared index vector fit the pencil.
 *
 * With a perturbation b of the equations, x = (s E - A)^{-1} b grows in a component of index m like
 * s^(m-1), and decays or stays in those of index 1. The growth from s to 16 s is compared at two
 * places, far above the size of A against E; where they disagree, or where points differ, nothing is
 * said. At special points a component may show less than its index, never more: a vector that declares
 * less than the pencil shows is refused, and one that declares more than 1 where every component clearly
 * shows 1.
 *
 * A small entry, as the conductance of a diode that is closed, lets a component of index 1 grow up to a rate
 * above all the sizes of A and E, and in other units finite modes lie there. Before a vector is refused, the growth is compared
 * at two more places, the last beyond 1e22 times these sizes, and has to be the same there.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
#include <math.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static sunrealtype largest(SUNMatrix M)
{
  sunindextype count = 0;
  const sunrealtype *a = NULL;
  switch (SUNMatGetID(M)) {
  case SUNMATRIX_DENSE: a = SUNDenseMatrix_Data(M), count = SUNDenseMatrix_LData(M); break;
  case SUNMATRIX_BAND: a = SUNBandMatrix_Data(M), count = SM_LDATA_B(M); break;
  default:
    a = SUNSparseMatrix_Data(M);
    count = SUNSparseMatrix_IndexPointers(M)[SUNSparseMatrix_NP(M)];
  }
  sunrealtype most = 0;
  for (sunindextype i = 0; i < count; i++) most = fmax(most, fabs(a[i]));
  return most;
}

/* x = (s E - A)^{-1} b with b of pseudo-random entries in 1/2 .. 1. */
static int perturb(steif_pencil *p, sunrealtype s, N_Vector x)
{
  const steif_shift shift = {.re = s};
  unsigned state = 4711;
  sunrealtype *a = stf_array(x);
  for (sunindextype i = 0; i < N_VGetLength(x); i++) {
    state = state * 1103515245u + 12345u;
    a[i] = 0.5 + (sunrealtype)(state >> 16 & 1023) / 2048;
  }
  STEIF_TRY(steif_pencil_factor(p, 1, &shift));
  return steif_pencil_solve(p, 0, 1, &x, NULL);
}

/* The index that two growths show, 0: none; 3 stands for more, as in problem.index. */
static int shown(sunrealtype a, sunrealtype b, sunrealtype c)
{
  if (a == 0 || b == 0) return 0;
  const sunrealtype first = log2(fabs(b / a)) / 4, second = log2(fabs(c / b)) / 4;
  const sunrealtype whole = round(second);
  if (!(fabs(first - whole) < 0.2 && fabs(second - whole) < 0.1)) return 0;
  return whole < 0 ? 1 : whole > 2 ? 3 : 1 + (int)whole;
}

/* Growth at the shifts s, 16 s, 256 s. The index that component i shows goes to found[i], 0 where another was found before:
 * what is left is shown everywhere. STEIF_RETRY: nothing can be said. */
static int look(const stf_system *s, steif_pencil *pencil, sunrealtype shift, bool first,
                N_Vector found)
{
  N_Vector x[] = {s->work[0], s->work[1], s->work[2]};
  sunrealtype *seen = stf_array(found);
  for (int k = 0; k < 3; k++, shift *= 16) {
    const int code = perturb(pencil, shift, x[k]);
    if (code) return code == STEIF_NO_MEMORY ? code : STEIF_RETRY;
  }
  for (sunindextype i = 0; i < s->space.n; i++) {
    const int index = shown(stf_array(x[0])[i], stf_array(x[1])[i], stf_array(x[2])[i]);
    seen[i] = first || index == seen[i] ? index : 0;
  }
  return STEIF_OK;
}

/* The first component that shows more than it declares; -1: none. */
static sunindextype understated(const stf_system *s, N_Vector found)
{
  for (sunindextype i = 0; i < s->space.n; i++)
    if (stf_array(found)[i] > s->problem->index[i]) return i;
  return -1;
}

static int refuse_less(const stf_system *s, sunindextype i, int index)
{
  const steif_problem *p = s->problem;
  return STEIF_FAIL(
    s->ctx, STEIF_BAD_INPUT,
    "index[%lld] = %d of problem '%s' contradicts its equations, which show index %d "
    "of this component at t = %g: correct .index (steif_diagnose finds it)",
    (long long)i, p->index[i], p->name, index, p->t0);
}

/* The first component that declares more than 1 where all show 1; -1: none. */
static sunindextype overstated(const stf_system *s, N_Vector found)
{
  sunindextype ones = 0, high = -1;
  for (sunindextype i = 0; i < s->space.n; i++) {
    ones += stf_array(found)[i] == 1;
    if (s->problem->index[i] > 1 && high < 0) high = i;
  }
  return ones < s->space.n ? -1 : high;
}

static int refuse_more(const stf_system *s, sunindextype i)
{
  const steif_problem *p = s->problem;
  return STEIF_FAIL(
    s->ctx, STEIF_BAD_INPUT,
    "index[%lld] = %d of problem '%s' contradicts its equations, which show index 1 of "
    "all components at t = %g: correct .index, since more than there is keeps a "
    "component out of the error test",
    (long long)i, p->index[i], p->name, p->t0);
}

static int measure(const stf_system *s, steif_pencil *pencil)
{
  static const sunrealtype place[] = {1e3, 1e10, 1e20};
  enum { PLACES = sizeof place / sizeof *place };
  const sunrealtype E = largest(s->E), base = E > 0 ? largest(s->A) / E : 0;
  N_Vector found = s->work[3];
  if (!(base > 0) || !isfinite(base)) return STEIF_OK;
  sunindextype i = -1;
  for (int k = 0; k < PLACES; k++) {
    const int code = look(s, pencil, place[k] * base, k == 0, found);
    if (code)
      return code == STEIF_RETRY ? STEIF_OK : code; /* singular: told where it matters */
    i = understated(s, found);
    if (i < 0 && overstated(s, found) < 0) return STEIF_OK;
  }
  return i < 0 ? refuse_more(s, overstated(s, found))
               : refuse_less(s, i, (int)stf_array(found)[i]);
}

int stf_index_check(stf_system *s)
{
  const steif_problem *p = s->problem;
  if (!p->index || s->storage == STEIF_KRYLOV) return STEIF_OK;
  for (sunindextype i = 0; s->form == STEIF_ODE && i < s->space.n; i++)
    STEIF_CHECK(p->index[i] == 1, s->ctx, STEIF_BAD_INPUT,
                "index[%lld] = %d of problem '%s' contradicts its form y' = f, where every "
                "component has index 1: leave .index out",
                (long long)i, p->index[i], p->name);
  if (s->form == STEIF_ODE) return STEIF_OK;
  steif_pencil *pencil = steif_pencil_new(s->ctx, s->E, s->A); /* its costs are not the run's */
  if (!pencil) return steif_status(s->ctx);
  const int code = measure(s, pencil);
  steif_pencil_free(&pencil);
  if (!code) steif_forget(s->ctx);
  return code;
}
