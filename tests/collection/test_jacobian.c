/* test_jacobian.c: over the whole shelf, the matrices E and A that a problem declares are the
 * derivatives of its residual F(t, y, y'), at the start, beside it and at the reference.
 *
 * With v in the scale of the unknowns, E v and A v are compared with central differences of F
 * in y' and y, row by row: each row i within 1e-9 of its entries plus what the differences
 * themselves cannot resolve (rounding of the terms of row i, and the change when the step is
 * halved), so that a small entry in a column of large ones is seen too. v runs through the unit
 * vectors, or through random ones where n is large.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include "fixture.h"

enum { MANY = 600, PROBES = 8 };
static const double STEP = 6e-6; /* of the differences, relative to v */

typedef struct matrices {
  SUNMatrix E,
    A; /* E NULL: the identity; A holds dF/dy itself where `sign` is 1, -dF/dy for -1 */
  int sign;
} matrices;

/* out = M x for a matrix that may be the identity. */
static void product(SUNMatrix M, N_Vector x, N_Vector out)
{
  if (M)
    CHECK(SUNMatMatvec(M, x, out) == 0);
  else
    N_VScale(1, x, out);
}

/* F(t, y, y') into out. */
static int residual(const fixture *s, const matrices *m, double t, N_Vector y, N_Vector yp,
                    N_Vector out)
{
  const steif_problem *p = &s->p;
  if (p->F) return p->F(t, y, yp, out, p->user);
  int code = 0;
  if (p->f) {
    code = p->f(t, y, out, p->user);
  } else {
    code = p->g(t, 0, out, p->user);
    product(m->A, y, s->w);
    N_VLinearSum(1, out, 1, s->w, out);
  }
  product(m->E, yp, s->w);
  N_VLinearSum(1, s->w, -1, out, out);
  return code;
}

/* J(c) = dF/dy + c dF/dy' of the problem's idajac. */
static SUNMatrix shifted(const fixture *s, double t, double c)
{
  const steif_problem *p = &s->p;
  SUNMatrix J = fixture_matrix(s, p->nnz + p->nnz_E);
  CHECK(p->idajac(t, c, s->y, s->yp, s->r, J, p->user, s->r, s->r, s->r) == 0);
  return J;
}

/* The declared matrices at (t, s->y, s->yp); 0 when the problem declares none. */
static int declared(const fixture *s, double t, matrices *m)
{
  const steif_problem *p = &s->p;
  *m = (matrices){.sign = -1};
  if (p->storage == STEIF_KRYLOV) return 0;
  if (p->E) {
    m->E = fixture_matrix(s, p->nnz_E);
    CHECK(p->E(t, s->y, s->yp, m->E, p->user) == 0);
  }
  if (p->A || p->jac) {
    m->A = fixture_matrix(s, p->nnz);
    CHECK((p->A ? p->A(t, s->y, s->yp, m->A, p->user)
                : p->jac(t, s->y, s->r, m->A, p->user, s->r, s->r, s->r)) == 0);
  } else if (p->idajac) {
    m->sign = 1;
    m->A = shifted(s, t, 0);
  }
  return m->A != NULL;
}

static void drop(matrices *m)
{
  if (m->E) SUNMatDestroy(m->E);
  if (m->A) SUNMatDestroy(m->A);
}

/* (F(x + delta v) - F(x - delta v))/(2 delta) with x = y or y' moved; terms_i grows to the
 * largest |F_i| seen. */
static int difference(fixture *s, const matrices *m, double t, N_Vector moved, N_Vector v,
                      double delta, N_Vector out, N_Vector terms)
{
  N_Vector base = N_VClone(moved), sum = N_VClone(moved);
  int code = 0;
  N_VScale(1, moved, base);
  N_VConst(0, sum);
  for (int sign = -1; sign <= 1 && code == 0; sign += 2) {
    N_VLinearSum(1, base, sign * delta, v, moved);
    code = residual(s, m, t, s->y, s->yp, out);
    N_VLinearSum(1, sum, sign / (2 * delta), out, sum);
    for (sunindextype i = 0; i < s->p.n; i++)
      NV_Ith_S(terms, i) = fmax(NV_Ith_S(terms, i), fabs(NV_Ith_S(out, i)));
  }
  N_VScale(1, base, moved);
  N_VScale(1, sum, out);
  N_VDestroy(base), N_VDestroy(sum);
  return code;
}

/* Does `expected` equal the derivative of F along v? Says the first row where not. */
static int along(fixture *s, const matrices *m, double t, N_Vector moved, N_Vector v,
                 N_Vector expected, N_Vector magnitude)
{
  N_Vector whole = N_VClone(v), half = N_VClone(v), terms = N_VClone(v);
  int good = 1;
  N_VScale(1, magnitude, terms);
  CHECK(difference(s, m, t, moved, v, STEP, whole, terms) == 0);
  CHECK(difference(s, m, t, moved, v, STEP / 2, half, terms) == 0);
  for (sunindextype i = 0; i < s->p.n && good; i++) {
    const double is = NV_Ith_S(half, i), must = NV_Ith_S(expected, i);
    const double blur =
      fabs(is - NV_Ith_S(whole, i)) + 16 * STF_EPS * NV_Ith_S(terms, i) / STEP;
    good = fabs(is - must) <= 1e-9 * fabs(must) + blur;
    if (!good)
      printf("\n  %s, t = %g, row %d: declared %.10g, differences %.10g +- %.1e", s->p.name, t,
             (int)i + 1, must, is, blur);
  }
  CU_ASSERT(good);
  N_VDestroy(whole), N_VDestroy(half), N_VDestroy(terms);
  return good;
}

/* A size for each unknown: its own, and where that is 0 a thousandth of the largest. */
static void sizes(N_Vector y, N_Vector size)
{
  const double largest = N_VMaxNorm(y), least = largest > 0 ? 1e-3 * largest : 1e-3;
  for (sunindextype i = 0; i < NV_LENGTH_S(y); i++)
    NV_Ith_S(size, i) = fmax(fabs(NV_Ith_S(y, i)), least);
}

/* Deterministic numbers in (0.3, 1.7) without pattern. */
static double scatter(sunindextype i) { return 1 + 0.7 * sin(12.9898 * (double)i + 78.233); }

/* The i-th direction: a unit vector, or a random one with both signs. */
static void direction(N_Vector size, sunindextype i, int units, N_Vector v)
{
  N_VConst(0, v);
  if (units) {
    NV_Ith_S(v, i) = NV_Ith_S(size, i);
    return;
  }
  for (sunindextype j = 0; j < NV_LENGTH_S(v); j++)
    NV_Ith_S(v, j) = NV_Ith_S(size, j) * (scatter(j + 1000 * i) - 1);
}

/* Sum of |A_ij| (|y_j| + STEP |v_j|) over j: the terms that may cancel in row i. */
static void terms_of(const matrices *m, N_Vector y, N_Vector v, N_Vector out)
{
  N_Vector reach = N_VClone(y);
  SUNMatrix M = SUNMatClone(m->A);
  CHECK(SUNMatCopy(m->A, M) == 0);
  const SUNMatrix_ID kind = SUNMatGetID(M);
  const int dense = kind == SUNMATRIX_DENSE, band = kind == SUNMATRIX_BAND;
  double *entry = dense ? SM_DATA_D(M) : band ? SM_DATA_B(M) : SM_DATA_S(M);
  const sunindextype count = dense  ? SM_LDATA_D(M)
                             : band ? SM_LDATA_B(M)
                                    : SM_INDEXPTRS_S(M)[SM_NP_S(M)];
  for (sunindextype k = 0; k < count; k++) entry[k] = fabs(entry[k]);
  for (sunindextype i = 0; i < NV_LENGTH_S(y); i++)
    NV_Ith_S(reach, i) = fabs(NV_Ith_S(y, i)) + STEP * fabs(NV_Ith_S(v, i));
  product(M, reach, out);
  N_VDestroy(reach);
  SUNMatDestroy(M);
}

/* dF/dy' where E or idajac gives it: E v against differences in y' (of F itself for the
 * implicit form; the mass and descriptor forms contain E, and there it must not depend on the
 * point). */
static int slopes_agree(fixture *s, const matrices *m, double t, N_Vector v, N_Vector zero)
{
  const steif_problem *p = &s->p;
  N_Vector expected = N_VClone(v);
  int good = 1;
  if (p->E) {
    product(m->E, v, expected);
  } else if (p->idajac) {
    const double c = 2.7;
    SUNMatrix J = shifted(s, t, c), J0 = shifted(s, t, 0);
    product(J, v, expected);
    product(J0, v, s->w);
    N_VLinearSum(1 / c, expected, -1 / c, s->w, expected);
    SUNMatDestroy(J), SUNMatDestroy(J0);
  }
  if (p->F && (p->E || p->idajac)) good = along(s, m, t, s->yp, v, expected, zero);
  N_VDestroy(expected);
  return good;
}

static void matrices_agree(fixture *s, double t)
{
  const int units = s->p.n <= MANY;
  matrices m;
  if (!declared(s, t, &m)) return;
  N_Vector size = N_VClone(s->y), v = N_VClone(s->y), expected = N_VClone(s->y),
           terms = N_VClone(s->y);
  int good = 1;
  sizes(s->y, size);
  for (sunindextype i = 0; i < (units ? s->p.n : PROBES) && good; i++) {
    direction(size, i, units, v);
    product(m.A, v, expected);
    N_VScale(m.sign, expected, expected);
    terms_of(&m, s->y, v, terms);
    good = along(s, &m, t, s->y, v, expected, terms);
    N_VConst(0, terms);
    good = good && slopes_agree(s, &m, t, v, terms);
  }
  N_VDestroy(size), N_VDestroy(v), N_VDestroy(expected), N_VDestroy(terms);
  drop(&m);
}

static void put_start(fixture *s)
{
  const steif_problem *p = &s->p;
  if (p->start) CHECK(p->start(p->t0, s->y, s->yp, p->user) == 0);
  for (sunindextype i = 0; i < p->n; i++) {
    if (p->y0) NV_Ith_S(s->y, i) = p->y0[i];
    if (p->yp0) NV_Ith_S(s->yp, i) = p->yp0[i];
  }
}

/* The reference, where it is complete. */
static int put_end(fixture *s)
{
  const steif_reference *r = s->p.reference;
  if (!r || r->component || (r->count && r->count < s->p.n)) return 0;
  for (sunindextype i = 0; i < s->p.n; i++) NV_Ith_S(s->y, i) = r->value[i];
  return 1;
}

/* Away from the start by 3 % of each size, and in all slopes, inside the domain. */
static void move(fixture *s)
{
  N_Vector size = N_VClone(s->y);
  sizes(s->y, size);
  for (sunindextype i = 0; i < s->p.n; i++) {
    NV_Ith_S(s->y, i) += 0.03 * scatter(i) * NV_Ith_S(size, i);
    NV_Ith_S(s->yp, i) += 0.05 * scatter(i + 7) * (1 + fabs(NV_Ith_S(s->yp, i)));
  }
  N_VDestroy(size);
}

static void shelf_matrices_are_derivatives(void)
{
  CHECK(stf_problem_count > 12);
  for (size_t k = 0; k < stf_problem_count; k++) {
    fixture s;
    if (fixture_open(&s, stf_problem_shelf[k].name)) continue;
    put_start(&s);
    matrices_agree(&s, s.p.t0);
    move(&s);
    matrices_agree(&s, s.p.t0 + 0.0137 * (s.p.t1 - s.p.t0));
    if (put_end(&s)) matrices_agree(&s, s.p.t1);
    fixture_close(&s);
  }
}

static void variants_have_right_matrices(void)
{
  static const char *const specs[] = {"rober:form=mass", "vdpol:mu=30", "vdpol:eps=3.7e-3",
                                      "medakzo:n=62"};
  for (size_t k = 0; k < sizeof specs / sizeof *specs; k++) {
    fixture s;
    if (fixture_open(&s, specs[k])) continue;
    put_start(&s);
    move(&s);
    matrices_agree(&s, s.p.t0 + 0.0137 * (s.p.t1 - s.p.t0));
    fixture_close(&s);
  }
}

/* Every problem declares its matrices, or products where it has none. */
static void shelf_declares_matrices(void)
{
  for (size_t k = 0; k < stf_problem_count; k++) {
    fixture s;
    if (fixture_open(&s, stf_problem_shelf[k].name)) continue;
    if (!(s.p.jac || s.p.idajac || s.p.A || s.p.Av)) printf("\n  %s has no matrices", s.p.name);
    CU_ASSERT(s.p.jac || s.p.idajac || s.p.A || s.p.Av);
    fixture_close(&s);
  }
}

/* M of M y' = f and E, A of a descriptor system are the same at the start and anywhere else. */
static void constant_matrices_are_constant(void)
{
  int seen = 0;
  for (size_t k = 0; k < stf_problem_count; k++) {
    fixture s;
    matrices here, there;
    if (fixture_open(&s, stf_problem_shelf[k].name)) continue;
    put_start(&s);
    if (s.p.E && !s.p.F && declared(&s, s.p.t0, &here)) {
      move(&s);
      declared(&s, 0.3 * s.p.t0 + 0.7 * s.p.t1, &there);
      CHECK(SUNMatScaleAdd(-1, here.E, there.E) == 0);
      if (s.p.A) CHECK(SUNMatScaleAdd(-1, here.A, there.A) == 0);
      for (sunindextype i = 0; i < s.p.n && s.p.n <= MANY; i++)
        for (sunindextype j = 0; j < s.p.n; j++, seen++) {
          CU_ASSERT(fixture_element(here.E, i, j) == 0);
          if (s.p.A) CU_ASSERT(fixture_element(here.A, i, j) == 0);
        }
      drop(&here), drop(&there);
    }
    fixture_close(&s);
  }
  CHECK(seen > 0);
}

CU_TestInfo tests_of_jacobian[] = {
  {"every problem declares matrices or products", shelf_declares_matrices},
  {"matrices of the shelf are derivatives of the residual", shelf_matrices_are_derivatives},
  {"matrices of variants are derivatives of the residual", variants_have_right_matrices},
  {"constant matrices are constant", constant_matrices_are_constant},
  CU_TEST_INFO_NULL};
