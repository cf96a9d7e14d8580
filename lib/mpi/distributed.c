/* distributed.c: a problem over ranks with a solver of its linear systems.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "own_rows.h"
#include <math.h>
#include <steif/quadrature.h>
#include <stdio.h>
#include <string.h>

struct steif_mpi {
  steif_problem problem;      /* with our callbacks ... */
  const steif_problem *p;     /* ... around these */
  steif_quadrature integrals; /* called with the caller's user */
  rows rows;
  const back_end *with;
  void *state;
  bool constant, filled;
};

/* -- vectors ---------------------------------------------------------------------------------- */

int own_rows_initialised(steif_context *ctx)
{
  int on = 0, off = 0;
  MPI_Initialized(&on), MPI_Finalized(&off);
  if (on && !off) return STEIF_OK;
  return steif_fail(ctx, STEIF_BAD_INPUT, "MPI is %s: call %s",
                    on ? "finalised" : "not initialised",
                    on ? "steif before MPI_Finalize" : "MPI_Init first");
}

/* What keeps a rank from its vector, or some other rank: the sentence is the same on all that have a context. */
static int vector_check(steif_context *ctx, MPI_Comm comm, sunindextype rows_here,
                        long long *total)
{
  int rank;
  long long own = rows_here < 0 ? 0 : rows_here, wrong[2];
  MPI_Comm_rank(comm, &rank);
  MPI_Allreduce(&own, total, 1, MPI_LONG_LONG, MPI_SUM, comm);
  wrong[0] = rows_here < 0 ? rank + 1 : 0, wrong[1] = ctx ? 0 : rank + 1;
  MPI_Allreduce(MPI_IN_PLACE, wrong, 2, MPI_LONG_LONG, MPI_MAX, comm);
  if (wrong[1])
    return steif_fail(ctx, STEIF_NO_MEMORY, "rank %lld has no context", wrong[1] - 1);
  if (wrong[0])
    return steif_fail(ctx, STEIF_BAD_INPUT, "rank %lld asks for less than 0 rows",
                      wrong[0] - 1);
  if (*total == 0) return steif_fail(ctx, STEIF_BAD_INPUT, "none of the ranks has a row (0)");
  return STEIF_OK;
}

N_Vector steif_mpi_vector(steif_context *ctx, MPI_Comm comm, sunindextype rows_here)
{
  long long total;
  if (own_rows_initialised(ctx) || vector_check(ctx, comm, rows_here, &total)) return NULL;
  N_Vector v = N_VNew_Parallel(comm, rows_here, (sunindextype)total, steif_sundials(ctx));
  int made = v != NULL;
  MPI_Allreduce(MPI_IN_PLACE, &made, 1, MPI_INT, MPI_MIN, comm);
  if (made) {
    N_VConst(0, v);
    return v;
  }
  if (v) N_VDestroy(v);
  steif_fail(ctx, STEIF_NO_MEMORY, "no memory for a vector of %lld rows over ranks", total);
  return NULL;
}

sunindextype steif_mpi_first(N_Vector v)
{
  long long own = NV_LOCLENGTH_P(v), sum = 0;
  MPI_Scan(&own, &sum, 1, MPI_LONG_LONG, MPI_SUM, NV_COMM_P(v));
  return (sunindextype)(sum - own);
}

/* -- callbacks that are passed on ------------------------------------------------------------- */

#define ON(member, ...)                                                                        \
  const steif_problem *p = ((const steif_mpi *)user)->p;                                       \
  return p->member(__VA_ARGS__)

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user) { ON(f, t, y, out, p->user); }
static int kick(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  ON(kick, t, y, out, p->user);
}
static int drift(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  ON(drift, t, y, out, p->user);
}
static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  ON(F, t, y, yp, r, p->user);
}
static int g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  ON(g, t, derivative, out, p->user);
}
static int Ev(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  ON(Ev, t, y, yp, x, out, p->user);
}
static int Av(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  ON(Av, t, y, yp, x, out, p->user);
}
static int Lv(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  ON(Lv, t, y, yp, x, out, p->user);
}
static int start(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  ON(start, t, y, yp, p->user);
}
static int project(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  ON(project, t, y, yp, p->user);
}
static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  ON(exact, t, y, yp, p->user);
}
static int invariant(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  ON(invariant, t, y, value, p->user);
}
static int event(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  ON(event, t, y, value, p->user);
}
static int handle_event(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  ON(handle_event, t, y, fired, p->user);
}
static int event_slope(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  ON(event_slope, t, y, yp, p->user);
}
static int begin(sunrealtype t, void *user) { ON(begin, t, p->user); }
static long save(void *bytes, void *user) { ON(save, bytes, p->user); }
static int restore(const void *bytes, size_t count, void *user)
{
  ON(restore, bytes, count, p->user);
}

/* -- rows, products, preconditioners ---------------------------------------------------------- */

static int fill(steif_mpi *m, sunrealtype t, N_Vector y, N_Vector yp)
{
  if (m->constant && m->filled) return STEIF_OK;
  const int code = rows_fill(&m->rows, m->p, t, y, yp);
  m->filled = code ? m->filled && rows_united(&m->rows) : true;
  if (code) return code;
  return m->with->changed(m->state);
}

static int product(steif_mpi *m, sunrealtype t, N_Vector y, N_Vector yp, char which, N_Vector x,
                   N_Vector out)
{
  MPI_TRY(fill(m, t, y, yp));
  rows_product(&m->rows, which == 'E', which == 'A', N_VGetArrayPointer(x),
               N_VGetArrayPointer(out));
  return 0;
}

/* E is constant: it is there after the first fill, whatever A has become. */
static int rows_E(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  steif_mpi *m = user;
  if (!m->filled) MPI_TRY(fill(m, t, y, yp));
  rows_product(&m->rows, 1, 0, N_VGetArrayPointer(x), N_VGetArrayPointer(out));
  return 0;
}

static int rows_A(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  return product(user, t, y, yp, 'A', x, out);
}

static int setup(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c, void *user)
{
  steif_mpi *m = user;
  (void)r;
  MPI_TRY(fill(m, t, y, yp));
  return m->with->setup(m->state, c, 0);
}

static int solve(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
                 sunrealtype c, sunrealtype delta, void *user)
{
  steif_mpi *m = user;
  const sunrealtype *from = N_VGetArrayPointer(b);
  sunrealtype *to = N_VGetArrayPointer(z);
  (void)t, (void)y, (void)yp, (void)r, (void)delta;
  return m->with->solve(m->state, c, 0, false, 1, &from, &to);
}

static int solve_pair(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector *b,
                      N_Vector *z, sunrealtype c_re, sunrealtype c_im, sunrealtype delta,
                      void *user)
{
  steif_mpi *m = user;
  const sunrealtype *from[] = {N_VGetArrayPointer(b[0]), N_VGetArrayPointer(b[1])};
  sunrealtype *to[] = {N_VGetArrayPointer(z[0]), N_VGetArrayPointer(z[1])};
  (void)t, (void)y, (void)yp, (void)r, (void)delta;
  return m->with->solve(m->state, c_re, c_im, false, 1, from, to);
}

/* Own rows of the halves of all columns, b before x; the caller releases them. */
static int own_parts(steif_mpi *m, int halves, N_Vector *b, N_Vector *x, sunrealtype ***parts)
{
  steif_context *ctx = m->rows.ctx;
  *parts = steif_allocate(ctx, 2 * (size_t)halves + 1, sizeof **parts);
  MPI_TRY(steif_agree(ctx, m->rows.like, *parts ? STEIF_OK : STEIF_NO_MEMORY));
  for (int k = 0; k < halves; k++) {
    (*parts)[k] = N_VGetArrayPointer(b[k]);
    (*parts)[halves + k] = N_VGetArrayPointer(x[k]);
  }
  return STEIF_OK;
}

static int finite(const steif_mpi *m, char which, int halves, sunrealtype *const *part)
{
  const rows *r = &m->rows;
  int code = STEIF_OK;
  for (int k = 0; k < halves && !code; k++)
    for (sunindextype i = 0; i < r->own.rows && !code; i++)
      if (!isfinite(part[k][i]))
        code =
          steif_fail(r->ctx, STEIF_NOT_FINITE, "vector %d of %c has %g in row %lld (rank %d)%s",
                     k, which, part[k][i], (long long)(r->own.first + i), r->own.rank,
                     which == 'x' ? ": the solution is beyond the largest number" : "");
  return steif_agree(r->ctx, r->like, code);
}

int steif_mpi_solve(steif_mpi *m, sunrealtype t, N_Vector y, N_Vector yp, sunrealtype c_re,
                    sunrealtype c_im, int transposed, int count, N_Vector *b, N_Vector *x)
{
  if (!m) return STEIF_BAD_INPUT;
  steif_context *ctx = m->rows.ctx;
  sunrealtype **parts = NULL;
  const sunrealtype asked[] = {t, c_re, c_im, transposed, count};
  MPI_TRY(
    steif_same(ctx, m->rows.like, "what steif_mpi_solve is asked for", asked, sizeof asked));
  if (m->with != &back_end_mumps)
    return steif_fail(ctx, STEIF_UNSUPPORTED,
                      "steif_mpi_solve needs the factors of \"mumps\", and there is \"%s\"",
                      m->with->name);
  if (count < 1)
    return steif_fail(ctx, STEIF_BAD_INPUT, "%d right-hand sides; give 1 or more", count);
  if (!isfinite(c_re) || !isfinite(c_im))
    return steif_fail(ctx, STEIF_BAD_INPUT, "c = %g%+gi is not finite", c_re, c_im);
  MPI_TRY(fill(m, t, y, yp));
  MPI_TRY(m->with->setup(m->state, c_re, c_im));
  MPI_TRY(mumps_sound(m->state, c_re, c_im));
  const int halves = c_im != 0 ? 2 * count : count;
  int code = own_parts(m, halves, b, x, &parts);
  if (!code) code = finite(m, 'b', halves, parts);
  if (!code)
    code = m->with->solve(m->state, c_re, c_im, transposed, count,
                          (const sunrealtype *const *)parts, parts + halves);
  if (!code) code = finite(m, 'x', halves, parts + halves);
  steif_release(ctx, parts);
  return code;
}

/* -- opening ---------------------------------------------------------------------------------- */

static void pass_on(steif_mpi *m)
{
  const steif_problem *p = m->p;
  steif_problem *q = &m->problem;
#define PASS(member) q->member = p->member ? member : NULL
  PASS(f), PASS(kick), PASS(drift), PASS(F), PASS(g), PASS(Ev), PASS(Av), PASS(Lv);
  PASS(start), PASS(project), PASS(exact), PASS(invariant), PASS(event), PASS(handle_event),
    PASS(event_slope), PASS(begin);
  PASS(save), PASS(restore);
#undef PASS
  q->user = m, q->storage = STEIF_KRYLOV, q->pattern = NULL;
  q->jac = NULL, q->idajac = NULL, q->E = q->A = q->L = NULL;
  q->parameters = NULL, q->build = NULL, q->destroy = NULL;
  if (p->quadrature) {
    m->integrals = *p->quadrature;
    if (!m->integrals.user) m->integrals.user = p->user;
    q->quadrature = &m->integrals;
  }
  q->precsetup = setup, q->precsolve = solve;
  q->Etv = q->Atv = NULL, q->precsolve_transposed = NULL;
  q->precsolve_pair = m->with->complex ? solve_pair : NULL;
  if (!m->rows.identity && !p->Ev) q->Ev = rows_E;
  if (m->constant && !p->Av) q->Av = rows_A;
}

static const back_end *find(const char *name)
{
  const back_end *const all[] = {&back_end_amg, &back_end_mumps};
  for (int i = 0; i < 2; i++)
    if (!strcmp(all[i]->name, name)) return all[i];
  return NULL;
}

static int prepare(steif_mpi *m, const char *text)
{
  steif_spec spec;
  steif_context *ctx = m->rows.ctx;
  N_Vector like = m->rows.like;
  MPI_TRY(steif_same(ctx, like, "the solver of linear systems", text, strlen(text)));
  MPI_TRY(steif_same_problem(ctx, like, m->p));
  int code = steif_spec_parse(ctx, text, &spec);
  if (!code && !(m->with = find(spec.name)))
    code = steif_fail(ctx, STEIF_UNKNOWN_NAME,
                      "no solver \"%s\" over ranks: there are amg and mumps", spec.name);
  MPI_TRY(steif_agree(ctx, like, code));
  MPI_TRY(rows_open(&m->rows, ctx, m->p, like));
  m->constant = m->p->linear || (!m->p->f && !m->p->F);
  code = m->with->open(&m->rows, &spec, &m->state);
  if (!code) code = steif_stand_in(ctx, m, m->p->user);
  MPI_TRY(steif_agree(ctx, like, code));
  pass_on(m);
  return STEIF_OK;
}

steif_mpi *steif_mpi_open(steif_context *ctx, const steif_problem *problem, const char *spec,
                          N_Vector like)
{
  if (!ctx || own_rows_initialised(ctx)) return NULL;
  const bool spread = like && N_VGetVectorID(like) == SUNDIALS_NVEC_PARALLEL;
  int code = STEIF_OK;
  if (!problem || !spec || !spread)
    code =
      steif_fail(ctx, STEIF_BAD_INPUT,
                 "steif_mpi_open needs a problem, a spec and a vector of steif_mpi_vector");
  if (!spread) return NULL;
  steif_mpi *m = code ? NULL : steif_allocate(ctx, 1, sizeof *m);
  if (!m && !code) code = STEIF_NO_MEMORY;
  if (steif_agree(ctx, like, code)) {
    steif_release(ctx, m);
    return NULL;
  }
  m->problem = *problem, m->p = problem;
  m->rows.ctx = ctx, m->problem.like = m->rows.like = like;
  if (prepare(m, spec)) steif_mpi_free(&m);
  return m;
}

const steif_problem *steif_mpi_problem(const steif_mpi *m) { return &m->problem; }

steif_mpi_stats steif_mpi_statistics(const steif_mpi *m) { return m->rows.stats; }

void steif_mpi_free(steif_mpi **handle)
{
  if (!handle || !*handle) return;
  steif_mpi *m = *handle;
  steif_context *ctx = m->rows.ctx;
  if (m->state) m->with->close(m->state);
  rows_close(&m->rows);
  steif_stand_down(ctx, m);
  steif_release(ctx, m);
  *handle = NULL;
}
