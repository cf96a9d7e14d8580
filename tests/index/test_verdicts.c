/* test_verdicts.c: index, degrees of freedom, numbers and offending equations of known
 * problems.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "evidence.h"
#include "models/models.h"
#include "suite.h"
#include <steif/solver.h>
#include <string.h>

/* Numbers and derivatives as words of digits; "" : not looked at. */
typedef struct expected {
  const char *name;
  int index;
  long freedom;
  const char *number, *derivatives;
} expected;

static void show(const char *name, const steif_diagnosis *d, sunindextype n)
{
  printf("\n  %s: index %d (S %d rcond %.1e, G %d, D %d gap %.1e), freedom %ld\n    numbers ",
         name, d->index, d->structural, d->rcond, d->growth, d->array, d->gap,
         (long)d->freedom);
  for (sunindextype j = 0; j < n; j++) printf("%d", d->number[j]);
  printf(" derivatives ");
  for (sunindextype j = 0; j < n; j++) printf("%d", d->derivatives[j]);
  printf(" determined ");
  for (sunindextype j = 0; j < n; j++) printf("%d", d->determined[j]);
  printf("\n    %s", d->message);
}

static int digits_agree(const char *wanted, const int *got, sunindextype n)
{
  if (!*wanted) return 1;
  for (sunindextype j = 0; j < n; j++)
    if (wanted[j] - '0' != got[j]) return 0;
  return 1;
}

static void compare(steif_context *ctx, const steif_problem *p, const steif_point *q,
                    const expected *e)
{
  steif_diagnosis d;
  const int code = steif_diagnose(ctx, p, q, &d);
  if (code) printf("\n  %s: %s", e->name, steif_message(ctx));
  CHECK(code == STEIF_OK);
  if (code) return;
  const int good = d.index == e->index && (long)d.freedom == e->freedom &&
                   digits_agree(e->number, d.number, p->n) &&
                   digits_agree(e->derivatives, d.derivatives, p->n);
  if (!good) show(e->name, &d, p->n);
  CU_ASSERT(good);
  CHECK(d.verdict == STEIF_REGULAR);
  CHECK(d.confidence == STEIF_SURE);
  steif_diagnosis_clear(&d);
}

/* Differentiation index, degrees of freedom, perturbation numbers: closed forms or
 * Hessenberg theory (Hairer, Lubich and Roche 1989); pendulum, caraxis, transamp,
 * chemakzo: IVP Test Set. */
static const expected local[] = {
  {"ode4", 0, 4, "1111", "0000"},    {"hess2", 2, 1, "112", "001"},
  {"jay3", 3, 2, "11223", "11002"},  {"cstr", 3, 0, "1223", "1012"},
  {"reactors", 3, 0, "213", "012"},  {"mnarlc", 1, 2, "111", "000"},
  {"mnacv", 2, 1, "112", "001"},     {"mnali", 2, 1, "211", "100"},
  {"charge", 1, 1, "11", "00"},      {"chargecv", 2, 0, "112", "011"},
  {"floating", 1, 1, "11", "00"},    {"rot1", 1, 3, "1111", "0000"},
  {"rot3", 3, 1, "3333", "2222"},    {"ltvb", 2, 0, "22", ""},
  {"gear", 2, 0, "22", ""},          {"over4", 1, 2, "1111", "0000"},
  {"over5", 2, 2, "11222", "00001"}, {"decoupled", 1, 1, "111", "000"},
  {"impasse", 1, 1, "11", "00"}};
static const expected shelved[] = {{"pendulum3", 3, 2, "11223", "11002"},
                                   {"pendulum3:index=2", 2, 3, "11112", "00001"},
                                   {"pendulum3:index=1", 1, 4, "11111", "00000"},
                                   {"pendulum3:index=ggl", 2, 2, "111122", "000011"},
                                   {"caraxis", 3, 4, "1111222233", "1111000022"},
                                   {"transamp", 1, 5, "11111111", "00000000"},
                                   {"chemakzo", 1, 5, "111111", "000000"},
                                   {"rober:form=mass", 1, 2, "111", "000"},
                                   {"hires", 0, 8, "11111111", "00000000"}};

static void local_problems(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t k = 0; k < sizeof local / sizeof *local; k++) {
    const model *m = model_find(local[k].name);
    const steif_problem p = model_problem(m, 1);
    const steif_point q = model_inquiry(m);
    compare(ctx, &p, &q, &local[k]);
  }
  steif_context_free(&ctx);
}

static void problems_of_the_collection(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t k = 0; k < sizeof shelved / sizeof *shelved; k++) {
    steif_problem p;
    CHECK(!steif_problem_find(ctx, shelved[k].name, &p));
    compare(ctx, &p, NULL, &shelved[k]);
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

/* E/h - A of ltvb is singular for every h, though the index is 2 and the solution unique. */
static void no_step_of_ltvb_can_be_solved(void)
{
  static const double h[] = {0x1p-3, 0x1p-10, 0x1p-17};
  const steif_problem from = model_problem(model_find("ltvb"), 1);
  for (int k = 0; k < 3; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p = from;
    p.t1 = p.t0 + h[k];
    steif_solver *s = steif_solver_new(ctx, &p, "be", &(steif_options){.h = h[k]});
    const int code = s ? steif_solve_to(s, p.t1) : steif_status(ctx);
    CHECK(code == STEIF_SINGULAR || (k == 2 && code == STEIF_NO_CONVERGENCE)); /* rounding */
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

/* Structure and growth: what the first says of problems where it is wrong. */
static void structure_over_and_under_estimates(void)
{
  static const struct {
    const char *name;
    int structural, regular;
    const char *c, *d;
  } rows[] = {{"over4", 2, 1, "0010", "1101"}, {"over5", 3, 1, "10102", "22101"},
              {"floating", 0, 0, "00", "11"},  {"rot1", 0, 0, "0000", "1111"},
              {"ltvb", 1, 0, "", ""},          {"decoupled", 1, 1, "010", "101"}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    const model *m = model_find(rows[k].name);
    const steif_problem p = model_problem(m, 1);
    steif_diagnosis d;
    CHECK(!steif_diagnose(ctx, &p, NULL, &d));
    CHECK(d.structural == rows[k].structural);
    CHECK((d.rcond > 1e-9) == rows[k].regular);
    CHECK(digits_agree(rows[k].c, d.c, m->n) && digits_agree(rows[k].d, d.d, m->n));
    if (rows[k].structural > d.index) CHECK(strstr(d.message, "over-estimates") != NULL);
    if (!rows[k].regular) CHECK(strstr(d.message, "cancellation") != NULL);
    steif_diagnosis_clear(&d);
  }
  steif_context_free(&ctx);
}

/* yl = yr at the start: growth there alone gives vl and vr number 1; a little beside it 2, which is
 * what the diagnosis says. The amplifier's J is singular: structure
 * says 0. */
static void one_point_of_the_car_axis_misleads(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_diagnosis d;
  stf_point point;
  stf_evidence e;
  CHECK(!steif_problem_find(ctx, "caraxis", &p));
  CU_ASSERT_FATAL(!stf_point_open(ctx, &p, NULL, &point));
  CHECK(!stf_diagnose(&point, &e, &d));
  CHECK(e.at[0].growth.row[5] <= 0 && e.at[0].growth.row[7] <= 0); /* number 1 + degree */
  CHECK(e.at[1].growth.row[5] == 1 && e.at[1].growth.row[7] == 1); /* another point */
  stf_evidence_free(&e);
  steif_diagnosis_clear(&d);
  stf_point_close(&point);
  CHECK(!steif_diagnose(ctx, &p, NULL, &d));
  CHECK(d.number[5] == 2 && d.number[7] == 2);
  steif_diagnosis_clear(&d);
  steif_problem_clear(ctx, &p);
  CHECK(!steif_problem_find(ctx, "transamp", &p));
  CHECK(!steif_diagnose(ctx, &p, NULL, &d));
  CHECK(d.structural == 0 && d.rcond < 1e-9 && d.index == 1);
  steif_diagnosis_clear(&d);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Where y_j' is determined at once: all but lambda of the pendulum; U3 and U6 of the
 * amplifier. */
static void differentiations_of_each_unknown(void)
{
  static const struct {
    const char *name, *determined;
  } rows[] = {{"pendulum3", "00003"}, {"transamp", "11011011"}, {"caraxis", "0000000033"}};
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 3; k++) {
    steif_problem p;
    steif_diagnosis d;
    CHECK(!steif_problem_find(ctx, rows[k].name, &p));
    CHECK(!steif_diagnose(ctx, &p, NULL, &d));
    CHECK(digits_agree(rows[k].determined, d.determined, p.n));
    steif_diagnosis_clear(&d);
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

/* Without Jacobians: differences of differences still give the index. */
static void indices_without_jacobians(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t k = 0; k < sizeof local / sizeof *local + sizeof shelved / sizeof *shelved; k++) {
    const size_t count = sizeof local / sizeof *local;
    const expected *e = k < count ? &local[k] : &shelved[k - count];
    const model *m = k < count ? model_find(e->name) : NULL;
    steif_problem p;
    if (m)
      p = model_problem(m, 0);
    else
      CHECK(!steif_problem_find(ctx, e->name, &p));
    p.jac = NULL, p.idajac = NULL;
    const steif_point q = m ? model_inquiry(m) : (steif_point){0};
    steif_diagnosis d;
    CHECK(!steif_diagnose(ctx, &p, &q, &d));
    if (d.index != e->index) show(e->name, &d, p.n);
    CU_ASSERT(d.index == e->index);
    CHECK(d.confidence != STEIF_UNDECIDED);
    steif_diagnosis_clear(&d);
    if (!m) steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

static void verdict_of(steif_context *ctx, const char *name, const double *y,
                       steif_diagnosis *d)
{
  const model *m = model_find(name);
  const steif_problem p = model_problem(m, 1);
  steif_point q = model_inquiry(m);
  q.y = y;
  const int code = steif_diagnose(ctx, &p, &q, d);
  if (code) printf("\n  %s: %s", name, steif_message(ctx));
  CHECK(code == STEIF_OK);
}

/* E = [-t t^2; -1 t], F = I: c(t) (t, 1) solves the homogeneous system for every c. */
static void solutions_that_are_not_unique(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_diagnosis d;
  verdict_of(ctx, "ltva", NULL, &d);
  if (d.verdict != STEIF_NOT_UNIQUE) show("ltva", &d, 2);
  CHECK(d.verdict == STEIF_NOT_UNIQUE && d.confidence == STEIF_SURE);
  CHECK(d.index == -1 && d.growth == 2 && d.freedom == -1);
  CHECK(strncmp(d.message, "not unique", 10) == 0);
  steif_diagnosis_clear(&d);
  steif_context_free(&ctx);
}

static void singular_problems_name_their_equations(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_diagnosis d;
  verdict_of(ctx, "crowded", NULL, &d);
  CHECK(d.verdict == STEIF_NO_SOLUTION && d.structural == -1);
  CHECK(strstr(d.message, "{e1, e2, e3}") != NULL && strstr(d.message, "{y3, y4}") != NULL);
  steif_diagnosis_clear(&d);
  verdict_of(ctx, "twice", NULL, &d);
  if (d.verdict != STEIF_NO_SOLUTION) show("twice", &d, 3);
  CHECK(d.verdict == STEIF_NO_SOLUTION && d.structural >= 0);
  steif_diagnosis_clear(&d);
  steif_context_free(&ctx);
}

/* x' = y, x = y^3/3 - y: index 1, and 2 on y = 1. */
static void index_that_varies(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_diagnosis d;
  verdict_of(ctx, "impasse", (const double[]){-2.0 / 3, 1}, &d);
  if (d.verdict != STEIF_VARIES) show("impasse", &d, 2);
  CHECK(d.verdict == STEIF_VARIES && d.index == 2 && d.confidence == STEIF_PROBABLE);
  CHECK(strstr(d.message, "singular point") != NULL);
  steif_diagnosis_clear(&d);
  verdict_of(ctx, "moving", NULL, &d);
  if (d.verdict != STEIF_VARIES) show("moving", &d, 2);
  CHECK(d.verdict == STEIF_VARIES && d.index == 2);
  steif_diagnosis_clear(&d);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_verdicts[] = {
  {"local problems", local_problems},
  {"problems of the collection", problems_of_the_collection},
  {"structure over- and under-estimates", structure_over_and_under_estimates},
  {"no step of ltvb can be solved", no_step_of_ltvb_can_be_solved},
  {"one point of the car axis misleads", one_point_of_the_car_axis_misleads},
  {"differentiations of each unknown", differentiations_of_each_unknown},
  {"indices without Jacobians", indices_without_jacobians},
  {"solutions that are not unique", solutions_that_are_not_unique},
  {"singular problems name their equations", singular_problems_name_their_equations},
  {"index that varies", index_that_varies},
  CU_TEST_INFO_NULL};
