/* net.c: a problem on 5 x 5 points known by its products, its matrices, or both.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "net.h"
#include <stdbool.h>

enum { BOTH = NET_SIDE + 1 };
static const sunrealtype stream = 4, slant = 0.3;

static sunrealtype *at(N_Vector v) { return NV_DATA_S(v); }

/* The answer to a call that is counted. */
static int heard(struct net *w, enum net_call which)
{
  return w->stop == which && ++w->calls == w->at ? w->returned : 0;
}

/* Neighbours left, right, below and above of point i; -1: a wall. */
static void neighbours(int i, int *of)
{
  const int x = i % NET_SIDE, y = i / NET_SIDE;
  of[0] = x > 0 ? i - 1 : -1, of[1] = x < NET_SIDE - 1 ? i + 1 : -1;
  of[2] = y > 0 ? i - NET_SIDE : -1, of[3] = y < NET_SIDE - 1 ? i + NET_SIDE : -1;
}

static sunrealtype value(const sunrealtype *x, int i, int part)
{
  return i < 0 ? (part ? 3 : 1) : x[2 * i + part];
}

/* Sum of neighbours less four times the point itself, and right less left. */
static sunrealtype spread(const sunrealtype *x, int i, int part, sunrealtype *across)
{
  int of[4];
  neighbours(i, of);
  sunrealtype sum = -4 * x[2 * i + part];
  for (int k = 0; k < 4; k++) sum += value(x, of[k], part);
  *across = value(x, of[1], part) - value(x, of[0], part);
  return sum;
}

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const sunrealtype *p = ((struct subject *)user)->p, *x = at(y);
  (void)t;
  for (int i = 0; i < NET_CELLS; i++) {
    const sunrealtype u = x[2 * i], v = x[2 * i + 1];
    sunrealtype across, unused;
    const sunrealtype du = spread(x, i, 0, &across), dv = spread(x, i, 1, &unused);
    at(out)[2 * i] =
      p[0] + u * u * v - (p[1] + 1) * u + p[2] * BOTH * BOTH * du - stream * across;
    at(out)[2 * i + 1] = p[1] * u - u * u * v + p[2] * BOTH * BOTH * dv;
  }
  return 0;
}

static int slope(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const sunrealtype *x = at(y);
  (void)t, (void)yp, (void)user;
  for (int i = 0; i < NET_CELLS; i++)
    for (int part = 0; part < 2; part++) {
      sunrealtype across;
      const sunrealtype d = spread(x, i, part, &across), u = x[2 * i];
      at(out)[2 * i + part] = k == 2   ? -BOTH * BOTH * d
                              : k == 0 ? (part ? 0 : -1)
                                       : (part ? -u : u);
    }
  return 0;
}

/* ---- products ------------------------------------------------------------------------------------ */

/* Derivatives of the reactions of point i: by rows. */
static void reactions(const sunrealtype *p, const sunrealtype *y, int i, sunrealtype *J)
{
  const sunrealtype u = y[2 * i], v = y[2 * i + 1];
  J[0] = 2 * u * v - p[1] - 1, J[1] = u * u;
  J[2] = p[1] - 2 * u * v, J[3] = -u * u;
}

static void times(const sunrealtype *p, const sunrealtype *y, const sunrealtype *x,
                  bool transposed, sunrealtype *out)
{
  for (int i = 0; i < NET_CELLS; i++) {
    sunrealtype J[4];
    int of[4];
    reactions(p, y, i, J), neighbours(i, of);
    const sunrealtype u = x[2 * i], v = x[2 * i + 1];
    sunrealtype sum[2] = {-4 * u, -4 * v}, across = 0;
    for (int k = 0; k < 4; k++)
      for (int part = 0; part < 2; part++)
        if (of[k] >= 0) sum[part] += x[2 * of[k] + part];
    if (of[1] >= 0) across += x[2 * of[1]];
    if (of[0] >= 0) across -= x[2 * of[0]];
    out[2 * i] = J[0] * u + J[transposed ? 2 : 1] * v + p[2] * BOTH * BOTH * sum[0] +
                 (transposed ? stream : -stream) * across;
    out[2 * i + 1] = J[transposed ? 1 : 2] * u + J[3] * v + p[2] * BOTH * BOTH * sum[1];
  }
}

static int Av(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  (void)t, (void)yp;
  times(((struct subject *)user)->p, at(y), at(x), false, at(out));
  return heard(user, NET_AV);
}

static int Atv(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  (void)t, (void)yp;
  times(((struct subject *)user)->p, at(y), at(x), true, at(out));
  return heard(user, NET_ATV);
}

static sunrealtype start[NET_N];

void net_products(struct net *w)
{
  *w = (struct net){.stop = NET_NONE};
  w->s.p[0] = 1, w->s.p[1] = 3, w->s.p[2] = 0.02;
  w->s.parameters = (steif_parameters){.count = 3, .value = w->s.p, .dFdp = slope};
  for (int i = 0; i < NET_CELLS; i++)
    start[2 * i] = 1 + sin(i + 1.0) / 2, start[2 * i + 1] = 3 + cos(2.0 * i) / 3;
  w->s.problem = (steif_problem){.name = "net",
                                 .n = NET_N,
                                 .t1 = 2,
                                 .y0 = start,
                                 .f = f,
                                 .Av = Av,
                                 .Atv = Atv,
                                 .user = w,
                                 .storage = STEIF_KRYLOV,
                                 .parameters = &w->s.parameters};
}

/* ---- the preconditioner --------------------------------------------------------------------------- */

static int precsetup(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c,
                     void *user)
{
  struct net *w = user;
  const sunrealtype *p = w->s.p;
  (void)t, (void)yp, (void)r;
  for (int i = 0; i < NET_CELLS; i++) {
    sunrealtype J[4], *M = w->block[i];
    reactions(p, at(y), i, J);
    for (int k = 0; k < 4; k++) M[k] = (k % 3 ? 0 : c + 4 * p[2] * BOTH * BOTH) - J[k];
  }
  return heard(w, NET_SETUP);
}

static void solve(const struct net *w, bool transposed, const sunrealtype *b, sunrealtype *z)
{
  for (int i = 0; i < NET_CELLS; i++) {
    const sunrealtype *M = w->block[i], det = M[0] * M[3] - M[1] * M[2];
    const sunrealtype right = M[transposed ? 2 : 1], left = M[transposed ? 1 : 2];
    z[2 * i] = (M[3] * b[2 * i] - right * b[2 * i + 1]) / det;
    z[2 * i + 1] = (M[0] * b[2 * i + 1] - left * b[2 * i]) / det;
  }
}

static int precsolve(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
                     sunrealtype c, sunrealtype delta, void *user)
{
  (void)t, (void)y, (void)yp, (void)r, (void)c, (void)delta;
  solve(user, false, at(b), at(z));
  return heard(user, NET_SOLVE);
}

static int precsolve_transposed(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b,
                                N_Vector z, sunrealtype c, sunrealtype delta, void *user)
{
  (void)t, (void)y, (void)yp, (void)r, (void)c, (void)delta;
  solve(user, true, at(b), at(z));
  return heard(user, NET_TURNED);
}

void net_precondition(struct net *w)
{
  w->s.problem.precsetup = precsetup, w->s.problem.precsolve = precsolve;
  w->s.problem.precsolve_transposed = precsolve_transposed;
}

/* ---- matrices ------------------------------------------------------------------------------------- */

enum { MOST = 6 * NET_N };

/* Rows of column j: its point, and neighbours. */
static int rows(int j, sunindextype *row)
{
  int of[4], count = 2;
  neighbours(j / 2, of);
  row[0] = j, row[1] = j ^ 1;
  for (int k = 0; k < 4; k++)
    if (of[k] >= 0) row[count++] = 2 * of[k] + j % 2;
  return count;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector t1,
               N_Vector t2, N_Vector t3)
{
  sunindextype row[MOST], column[MOST];
  sunrealtype entry[MOST], e[NET_N] = {0}, out[NET_N];
  int count = 0;
  (void)t, (void)fy, (void)t1, (void)t2, (void)t3;
  for (int j = 0; j < NET_N; j++) {
    e[j] = 1;
    times(((struct subject *)user)->p, at(y), e, false, out);
    e[j] = 0;
    const int more = rows(j, row + count);
    for (int k = count; k < count + more; k++) column[k] = j, entry[k] = out[row[k]];
    count += more;
  }
  return steif_fill_triplets(J, count, row, column, entry);
}

void net_matrices(struct net *w)
{
  steif_problem *p = &w->s.problem;
  p->Av = p->Atv = NULL;
  p->jac = jac, p->storage = STEIF_SPARSE, p->nnz = MOST, p->nnz_E = 2 * NET_N;
}

/* ---- another E ------------------------------------------------------------------------------------ */

static sunrealtype grown(sunrealtype t, const void *user)
{
  return ((const struct net *)user)->s.p[7] != 0 ? 1 + t / 2 : 1;
}

static int Ev(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  (void)y, (void)yp;
  for (int i = 0; i < NET_N; i++)
    at(out)[i] = grown(t, user) * (at(x)[i] + (i < NET_N - 1 ? slant * at(x)[i + 1] : 0));
  return 0;
}

static int Etv(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  (void)y, (void)yp;
  for (int i = 0; i < NET_N; i++)
    at(out)[i] = grown(t, user) * (at(x)[i] + (i ? slant * at(x)[i - 1] : 0));
  return heard(user, NET_ETV);
}

static int E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  sunindextype row[2 * NET_N], column[2 * NET_N];
  sunrealtype entry[2 * NET_N];
  int count = 0;
  (void)y, (void)yp;
  for (int i = 0; i < NET_N; i++) {
    row[count] = i, column[count] = i, entry[count++] = grown(t, user);
    if (i == NET_N - 1) break;
    row[count] = i, column[count] = i + 1, entry[count++] = slant * grown(t, user);
  }
  return steif_fill_triplets(M, count, row, column, entry);
}

void net_mass(struct net *w, int grows)
{
  w->s.p[7] = grows;
  if (w->s.problem.jac)
    w->s.problem.E = E;
  else
    w->s.problem.Ev = Ev, w->s.problem.Etv = Etv;
}
