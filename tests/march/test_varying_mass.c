/* M y' = f(t, y) with an M that is not constant: M(t) and M(t, y), of index 0 and 1, by every family that takes
 * mass matrices, with the order that it has for a constant one; what does not take it says so.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"
#include <stdbool.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum kind { CONSTANT, ROUNDED, OF_TIME, LATE, OF_STATE };

/* diag(a, 1 + a) with a = 2 but for: rounding errors; 1 + t; 3 after t = 1.5; 1 + y1^2. */
static double entry(const enum kind *kind, sunrealtype t, N_Vector y)
{
  const double x = NV_Ith_S(y, 0);
  switch (*kind) {
  case ROUNDED: return 2 * (sin(t) * sin(t) + cos(t) * cos(t));
  case OF_TIME: return 1 + t;
  case LATE: return t > 1.5 ? 3 : 2;
  case OF_STATE: return 1 + x * x;
  default: return 2;
  }
}

static int M(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  const double a = entry(user, t, y), d[] = {a, 1 + a};
  (void)yp;
  return steif_fill_diagonal(E, d);
}

static int times(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  const double a = entry(user, t, y);
  (void)yp;
  NV_Ith_S(out, 0) = a * NV_Ith_S(x, 0), NV_Ith_S(out, 1) = (1 + a) * NV_Ith_S(x, 1);
  return 0;
}

/* M y' = f = -M (y1 / t, y2): y = (1 / t, exp(1 - t)) from t = 1, y = (1, 1). */
static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const double a = entry(user, t, y);
  NV_Ith_S(out, 0) = -a * NV_Ith_S(y, 0) / t, NV_Ith_S(out, 1) = -(1 + a) * NV_Ith_S(y, 1);
  return 0;
}

static const double start[] = {1, 1};
static const sunindextype columns[] = {0, 1, 2}, rows[] = {0, 1};
static const steif_pattern diagonal = {columns, rows};

static steif_problem problem(enum kind *kind, enum steif_storage storage)
{
  steif_problem p = {.name = "heavy",
                     .n = 2,
                     .t0 = 1,
                     .t1 = 2,
                     .y0 = start,
                     .f = f,
                     .pattern = &diagonal,
                     .nnz_E = 2,
                     .storage = storage,
                     .user = kind};
  if (storage == STEIF_KRYLOV)
    p.Ev = times;
  else
    p.E = M;
  return p;
}

static double error_with(const steif_problem *p, const char *method, const steif_options *o,
                         const double *expected)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_solver *s = steif_solver_new(ctx, p, method, o);
  double error = INFINITY;
  if (s && steif_solve_to(s, p->t1) == STEIF_OK)
    for (sunindextype i = 0; i < p->n; i++)
      error = fmax(i ? error : 0, fabs(NV_Ith_S(steif_solution(s), i) - expected[i]));
  else
    printf("\n  %s, %s: %s", p->name, method, steif_message(ctx));
  steif_solver_free(&s);
  steif_context_free(&ctx);
  return error;
}

static double error_of(const steif_problem *p, const char *method)
{
  const double expected[] = {0.5, exp(-1)};
  steif_options o = steif_defaults();
  o.rtol = 1e-7, o.atol = 1e-9;
  return error_with(p, method, &o, expected);
}

static void a_constant_M_is_not_taken_for_one_that_varies(void)
{
  static const enum steif_storage storages[] = {STEIF_DENSE, STEIF_BAND, STEIF_SPARSE,
                                                STEIF_KRYLOV};
  for (enum kind kind = CONSTANT; kind <= ROUNDED; kind++)
    for (int k = 0; k < 4; k++) {
      const steif_problem p = problem(&kind, storages[k]);
      CHECK(error_of(&p, "radau:s=3") < 1e-6);
    }
}

static void it_is_taken_by_every_family(void)
{
  static const char *const methods[] = {"auto",   "radau:s=3", "gauss:s=2", "dirk:hw43", "bdf",
                                        "rodas4", "rodas5p",   "rodas4p2",  "ida"};
  for (enum kind kind = OF_TIME; kind <= OF_STATE; kind++)
    for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
      const steif_problem p = problem(&kind, STEIF_DENSE);
      CHECK(error_of(&p, methods[m]) < 1e-5);
    }
}

static void so_it_is_in_every_storage(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf", "rodas5p"};
  for (enum kind kind = OF_TIME; kind <= OF_STATE; kind++)
    for (enum steif_storage storage = STEIF_DENSE; storage <= STEIF_KRYLOV; storage++)
      for (int m = 0; m < (storage == STEIF_KRYLOV ? 2 : 3); m++) {
        if (kind == LATE && storage != STEIF_DENSE) continue;
        const steif_problem p = problem(&kind, storage);
        const double error = error_of(&p, methods[m]);
        if (!(error < 1e-5))
          printf("\n  kind %d, storage %d, %s: %g", kind, storage, methods[m], error);
        CHECK(error < 1e-5);
      }
}

static void arkode_takes_it_where_it_depends_on_time_only(void)
{
  enum kind kind = OF_TIME;
  for (enum steif_storage storage = STEIF_DENSE; storage <= STEIF_SPARSE; storage++) {
    const steif_problem p = problem(&kind, storage);
    CHECK(error_of(&p, "arkode") < 1e-5);
  }
  kind = OF_STATE;
  const steif_problem p = problem(&kind, STEIF_DENSE);
  smooth_refused(&p, "arkode", NULL, STEIF_UNSUPPORTED,
                 "for another state: arkode does not take that; radau, bdf, dirk and ida do");
}

/* -- orders -------------------------------------------------------------------------------------
 *
 *   [ 2 + sin t    c y1 ] y'     = f(t, y),   0 = y3 - y1 y2,   y = (e^-t, cos t, e^-t cos t),
 *   [ y2 / 2      3 + t ]  (1,2)
 *
 * c = 1: M depends on the state; of the other kind y1 and y2 in M are replaced by 1. The first row of f is
 * that of the solution plus -lambda (y1 - e^-t). With n = 2 the third unknown is left out. */
typedef struct smoothly {
  bool of_state, algebraic;
} smoothly;

static void fill_M(const smoothly *c, sunrealtype t, const double *y, double m[4])
{
  m[0] = 2 + sin(t), m[1] = c->of_state ? y[0] : 1;
  m[2] = c->of_state ? y[1] / 2 : 0.5, m[3] = 3 + t;
}

static int g(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const smoothly *c = user;
  const double *x = NV_DATA_S(y), u = exp(-t), v = cos(t), exact[] = {u, v};
  const double up = -u, vp = -sin(t);
  double m[4];
  fill_M(c, t, exact, m);
  NV_Ith_S(out, 0) = m[0] * up + m[1] * vp - 2 * (x[0] - u) + x[1] * x[1] - v * v;
  NV_Ith_S(out, 1) = m[2] * up + m[3] * vp + x[0] * x[1] - u * v;
  if (!c->algebraic) return 0;
  NV_Ith_S(out, 0) += x[2] - u * v;
  NV_Ith_S(out, 2) = x[2] - x[0] * x[1];
  return 0;
}

static int G(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  double m[4];
  (void)yp;
  fill_M(user, t, NV_DATA_S(y), m);
  static const sunindextype row[] = {0, 0, 1, 1}, column[] = {0, 1, 0, 1};
  return steif_fill_triplets(E, 4, row, column, m);
}

static int exact_g(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const smoothly *c = user;
  const double u = exp(-t), v = cos(t);
  NV_Ith_S(y, 0) = u, NV_Ith_S(y, 1) = v;
  if (c->algebraic) NV_Ith_S(y, 2) = u * v;
  if (!yp) return 0;
  NV_Ith_S(yp, 0) = -u, NV_Ith_S(yp, 1) = -sin(t);
  if (c->algebraic) NV_Ith_S(yp, 2) = -u * v - u * sin(t);
  return 0;
}

static double error_at(smoothly *c, const char *method, double h)
{
  static const double y0[] = {1, 1, 1};
  const double expected[] = {exp(-1), cos(1), exp(-1) * cos(1)};
  const steif_problem p = {.name = c->algebraic ? "coupled" : "regular",
                           .n = c->algebraic ? 3 : 2,
                           .t1 = 1,
                           .y0 = y0,
                           .f = g,
                           .E = G,
                           .exact = exact_g,
                           .dae_index = c->algebraic,
                           .user = c};
  steif_options o = steif_defaults();
  o.h = h;
  if (!strncmp(method, "bdf", 3)) o.start = "exact";
  return error_with(&p, method, &o, expected);
}

static const struct method {
  const char *name;
  double order, h;
} methods[] = {{"radau:s=3", 5, 0.1},  {"gauss:s=2", 4, 0.1}, {"dirk:hw43", 4, 0.05},
               {"bdf:p=3", 3, 0.0125}, {"rodas4", 4, 0.05},   {"rodas4p2", 4, 0.05},
               {"rodas5p", 5, 0.05}};

static void orders_are_those_of_a_constant_M(void)
{
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++)
    for (int k = 0; k < 4; k++) {
      smoothly c = {k & 1, k > 1};
      const bool gauss = !strcmp(methods[m].name, "gauss:s=2");
      if (gauss && c.algebraic) continue; /* does not damp */
      const double coarse = error_at(&c, methods[m].name, methods[m].h),
                   fine = error_at(&c, methods[m].name, methods[m].h / 2);
      const double order = log2(coarse / fine);
      if (!(order > methods[m].order - 0.5))
        printf("\n  %s, M of %s%s: order %.2f, errors %.2g %.2g", methods[m].name,
               c.of_state ? "state" : "time", c.algebraic ? ", index 1" : "", order, coarse,
               fine);
      CHECK(order > methods[m].order - 0.5);
    }
}

/* -- what is refused ---------------------------------------------------------------------------- */

/* (1 + t) (y1 + y2)' = -(y1 + y2), 0 = y1 - y2: regular, but M is singular and has no columns of zeros. */
static int sums(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = SM_ELEMENT_D(E, 0, 1) = 1 + t;
  return 0;
}
static int decay(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(out, 0) = -NV_Ith_S(y, 0) - NV_Ith_S(y, 1);
  NV_Ith_S(out, 1) = NV_Ith_S(y, 0) - NV_Ith_S(y, 1);
  return 0;
}

static void a_singular_M_is_refused_by_rosenbrock_methods_and_solved_by_the_advised(void)
{
  static const double expected[] = {0.5, 0.5};
  static const char *const advised[] = {"radau", "bdf", "dirk:hw43"};
  const steif_problem p = {
    .name = "sums", .n = 2, .t1 = 1, .y0 = start, .f = decay, .E = sums, .dae_index = 1};
  smooth_refused(&p, "rodas5p", NULL, STEIF_UNSUPPORTED, "take radau, bdf or dirk");
  steif_options o = steif_defaults();
  o.rtol = 1e-7, o.atol = 1e-9;
  for (int m = 0; m < 3; m++) CHECK(error_with(&p, advised[m], &o, expected) < 1e-5);
}

/* -- the rest of a run ---------------------------------------------------------------------------- */

static int crossing(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  (void)user, (void)t;
  value[0] = NV_Ith_S(y, 0) - 0.75;
  return 0;
}
static int doubled(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  (void)t, (void)fired, (void)user;
  NV_Ith_S(y, 1) *= 2;
  return STEIF_RESTART;
}

static void events_and_restarts_begin_with_new_slopes(void)
{
  static const char *const names[] = {"radau:s=3", "bdf", "rodas5p", "dirk:hw43", "ida"};
  const double expected[] = {0.5, 2 * exp(-1)};
  steif_options o = steif_defaults();
  o.rtol = 1e-7, o.atol = 1e-9;
  for (enum kind kind = OF_TIME; kind <= OF_STATE; kind += OF_STATE - OF_TIME)
    for (int m = 0; m < 5; m++) {
      steif_problem p = problem(&kind, STEIF_DENSE);
      p.events = 1, p.event = crossing, p.handle_event = doubled;
      CHECK(error_with(&p, names[m], &o, expected) < 1e-5);
    }
}

static void a_diagnosis_sees_the_index(void)
{
  smoothly c = {true, true};
  static const double y0[] = {1, 1, 1};
  const steif_problem p = {
    .name = "coupled", .n = 3, .t1 = 1, .y0 = y0, .f = g, .E = G, .user = &c};
  steif_context *ctx = steif_context_new(NULL);
  steif_diagnosis d = {0};
  CHECK(steif_diagnose(ctx, &p, NULL, &d) == STEIF_OK);
  CHECK(d.index == 1);
  steif_diagnosis_clear(&d);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_varying_mass[] = {
  {"a constant M is not taken for one that varies",
   a_constant_M_is_not_taken_for_one_that_varies},
  {"it is taken by every family", it_is_taken_by_every_family},
  {"so it is in every storage", so_it_is_in_every_storage},
  {"arkode takes it where it depends on time only",
   arkode_takes_it_where_it_depends_on_time_only},
  {"orders are those of a constant M", orders_are_those_of_a_constant_M},
  {"a singular M is refused by Rosenbrock methods and solved by those advised",
   a_singular_M_is_refused_by_rosenbrock_methods_and_solved_by_the_advised},
  {"events and restarts begin with new slopes", events_and_restarts_begin_with_new_slopes},
  {"a diagnosis sees the index", a_diagnosis_sees_the_index},
  CU_TEST_INFO_NULL};
