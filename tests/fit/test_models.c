/* test_models.c: measurements, standard deviations and parameters that a model names.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "folder.h"
#include "suite.h"
#include <math.h>
#include <steif/data.h>
#include <steif/fit.h>
#include <steif/model.h>
#include <string.h>

/* x = e^(-k t), w = 2 x + 1; k = 2 by these, exactly. */
static void write_data(const char *folder, char *path, size_t room)
{
  snprintf(path, room, "%s/d.csv", folder);
  FILE *file = fopen(path, "w");
  fprintf(file, "t,w,x\n");
  for (int i = 1; i < 5; i++)
    fprintf(file, "%.17g,%.17g,%.17g\n", 0.25 * i, 2 * exp(-0.5 * i) + 1, exp(-0.5 * i));
  fclose(file);
}

/* The model `rest` beside d.csv; the code of opening it, and of reading its measurements with so many standard
 * deviations of a caller. */
static int open_model(steif_context *ctx, const char *rest, int count, const double *sd,
                      steif_problem *p, steif_measurements *data)
{
  char folder[256], path[300], name[300], text[600];
  CHECK(folder_make(folder, sizeof folder) != NULL);
  write_data(folder, path, sizeof path);
  snprintf(name, sizeof name, "%s/m.steif", folder);
  snprintf(text, sizeof text,
           "param k = 1, n = 3 whole\nstate x = 1\nx' = -k*x\ntime 0 to 1\n%s", rest);
  *data = (steif_measurements){0};
  int code = steif_model_parse(ctx, text, name, NULL, p);
  if (!code) code = steif_measurements_read(ctx, p, NULL, 0, 0, count, sd, data);
  remove(path), remove(folder);
  return code;
}

static void what_a_model_says_is_used(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_measurements data;
  steif_model_data said;
  steif_fit fit;
  const char *text = "data \"d.csv\", w = 2*x + 1 sd 0.1, x = x sd 0.05*k\nfit k log\n";
  CU_ASSERT_FATAL(open_model(ctx, text, 0, NULL, &p, &data) == STEIF_OK);
  CHECK(steif_model_data_find(ctx, &p, &said) == STEIF_OK && said.columns == 2);
  CHECK(said.fitted == 1 && said.log && !strcmp(steif_model_fitted(&p, 0), "k"));
  CHECK(steif_model_fitted(&p, 1) == NULL);
  CHECK(!strcmp(steif_model_output(&p, 0), "w") && steif_model_output(&p, 1) == NULL);
  CHECK(data.count == 8 && data.component[0] == 1 && data.component[1] == 0);
  CLOSE(data.sd[0], 0.1, 1e-15);
  CLOSE(data.sd[1], 0.05, 1e-15);
  CU_ASSERT_FATAL(steif_fit_find(ctx, &p, "radau:s=3", &data, NULL, &fit) == STEIF_OK);
  CLOSE(fit.p[0], 2, 1e-7);
  steif_fit_free(ctx, &fit);
  steif_measurements_free(ctx, &data);
  steif_problem_clear(ctx, &p);
  const double own = 3;
  CU_ASSERT_FATAL(open_model(ctx, text, 1, &own, &p, &data) == STEIF_OK);
  CHECK(data.sd[0] == 3 && data.sd[1] == 3);
  steif_measurements_free(ctx, &data);
  steif_problem_clear(ctx, &p);
  CU_ASSERT_FATAL(open_model(ctx, "output w = 2*x + 1\ndata \"d.csv\"\n", 0, NULL, &p, &data) ==
                  STEIF_OK);
  CHECK(data.count == 8 && !data.sd && steif_model_fitted(&p, 0) == NULL);
  steif_measurements_free(ctx, &data);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* The header of a file beside a model with units; the code of reading it. */
static int read_units(steif_context *ctx, const char *header, steif_measurements *data)
{
  static const char text[] =
    "param k = 1 {1/s}\nstate x = 1 {m}, u[i in 1:2] = 1 {K}\nstate z = 1\n"
    "x' = -k*x\nz' = -z\nfor i in 1:2\nu[i]' = -u[i]\nend\n"
    "output w = 2*x {mm}\ntime 0 to 1 {s}\n";
  char folder[256], path[300];
  steif_problem p;
  CU_ASSERT_FATAL(!steif_model_parse(ctx, text, "units", NULL, &p));
  CHECK(folder_make(folder, sizeof folder) != NULL);
  snprintf(path, sizeof path, "%s/u.csv", folder);
  FILE *file = fopen(path, "w");
  fprintf(file, "%s\n0.5,1,2\n", header);
  fclose(file);
  const int code = steif_measurements_read(ctx, &p, path, 0, 0, 0, NULL, data);
  remove(path), remove(folder);
  steif_problem_clear(ctx, &p);
  return code;
}

static void units_are_read(void)
{
  static const char *const good[] = {
    "t {s},x {m},w {mm}", "t,x,w",       "t{s}, x{m} ,\"w {mm}\"",
    "t {s},x,z {any}",    "t {},x {},w", "t {s},u[1] {K},u[2] {K}",
    "t,x {m},sd_x {m}"};
  static const struct {
    const char *header, *part;
  } bad[] = {
    {"t {h},x,w",
     "line 1, column 1: 't' is in {h}, and problem 'units' has it in {s}; convert one"},
    {"t,x {mm},w", "line 1, column 2: 'x' is in {mm}, and problem 'units' has it in {m}"},
    {"t,x,w {m}", "line 1, column 3: 'w' is in {m}, and problem 'units' has it in {mm}"},
    {"t,x,u[2] {m}", "column 3: 'u[2]' is in {m}, and problem 'units' has it in {K}"},
    {"t,x,sd_x {mm}", "column 3: 'x' is in {mm}, and problem 'units' has it in {m}"}};
  steif_context *ctx = steif_context_new(NULL);
  steif_measurements data;
  for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
    CHECK(!read_units(ctx, good[i], &data) && data.count > 0);
    if (!data.count) printf("\n  '%s': %s", good[i], steif_message(ctx));
    steif_measurements_free(ctx, &data);
  }
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    CHECK(read_units(ctx, bad[i].header, &data) == STEIF_BAD_INPUT && !data.count);
    CHECK(strstr(steif_message(ctx), bad[i].part) != NULL);
    if (!strstr(steif_message(ctx), bad[i].part)) printf("\n  %s", steif_message(ctx));
  }
  steif_context_free(&ctx);
}

static void wrong_words_are_told(void)
{
  static const struct {
    const char *rest, *part;
  } wrong[] = {
    {"data \"d.csv\", x = 2*x, w = 2*x + 1\n", "5:15: 'x' has this name already (line 2)"},
    {"data \"d.csv\", w = 2*x + 1 sd 0\n", "5:15: a standard deviation must be a positive"},
    {"data \"d.csv\", w = 2*x + 1 sd x\n", "5:30: 'x' is an unknown"},
    {"data \"../d.csv\"\n", "5:6: '../d.csv' leaves the directory of the model"},
    {"data d, x = x\n", "5:6: expected"},
    {"data \"d.csv\" x = x\n", "5:14: expected"},
    {"data \"d.csv\", w = 2*x + 1\ndata \"e.csv\"\n", "6:7: a model has one 'data' statement"},
    {"data \"d.csv\", w = 2*x + 1 sd 1\n", "has no standard deviations, and others have"},
    {"output w = 2*x + 1\ndata \"e.csv\"\n", "e.csv"},
    {"data \"d.csv\"\n",
     "has no unknown or output 'w'; the nearest is 'x'; rename the column, or leave it out"},
    {"output w = x\n", "names none, as a model does by data \"FILE.csv\""},
    {"fit x\n", "5:5: 'x' is no parameter that can be fitted"},
    {"fit n\n", "5:5: 'n' is no parameter that can be fitted"},
    {"param a = 1\nfit k log, a\n", "6:12: 'log' stands after all parameters"},
  };
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    steif_problem p;
    steif_measurements data;
    CHECK(open_model(ctx, wrong[i].rest, 0, NULL, &p, &data) != STEIF_OK);
    if (!strstr(steif_message(ctx), wrong[i].part))
      printf("\n  %s  %s", wrong[i].rest, steif_message(ctx));
    CHECK(strstr(steif_message(ctx), wrong[i].part) != NULL);
    steif_measurements_free(ctx, &data);
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_models[] = {{"units are read", units_are_read},
                                 {"what a model says is used", what_a_model_says_is_used},
                                 {"wrong words are told", wrong_words_are_told},
                                 CU_TEST_INFO_NULL};
