/* Pictures: well-formed, finite, with gaps. SPDX-License-Identifier: BSD-3-Clause */
#define _XOPEN_SOURCE 700
#include "fixture.h"
#include "folder.h"
#include <stdlib.h>
#include <unistd.h>

static char text[TEXT];
static char path[256];

static const char *temporary(const char *ending)
{
  snprintf(path, sizeof path, "%s/steif-%ld%s", folder_above(), (long)getpid(), ending);
  return path;
}

/* Every tag is closed in order; attribute values are quoted. */
static bool balanced(const char *svg)
{
  char stack[16][24];
  int depth = 0;
  for (const char *at = strchr(svg, '<'); at; at = strchr(at + 1, '<')) {
    const char *end = strchr(at, '>');
    if (!end) return false;
    if (at[1] == '?') continue;
    char name[24] = "";
    sscanf(at + 1 + (at[1] == '/'), "%23[a-zA-Z]", name);
    if (at[1] == '/') {
      if (depth == 0 || strcmp(stack[--depth], name)) return false;
    } else if (end[-1] != '/') {
      if (depth == 16) return false;
      strcpy(stack[depth++], name);
    }
  }
  return depth == 0;
}

static size_t count_of(const char *word)
{
  size_t count = 0;
  for (const char *at = strstr(text, word); at; at = strstr(at + 1, word)) count++;
  return count;
}

/* Draw into `text`; the pictures are finite and balanced whatever the data. */
static void draw(const steif_plot *plot)
{
  steif_context *ctx = steif_context_new(NULL);
  CHECK(steif_plot_save(ctx, plot, temporary(".svg")) == STEIF_OK);
  contents(path, text);
  unlink(path);
  CHECK(balanced(text));
  CHECK(!strstr(text, "nan") && !strstr(text, "inf"));
  CHECK(!strcmp(text + strlen(text) - 7, "</svg>\n"));
  steif_context_free(&ctx);
}

static void gaps_break_the_line(void)
{
  static const sunrealtype x[] = {1, 2, 3, 4, 5, 6, 7}, y[] = {.5, .25, 0, -3, NAN, .75, .125};
  const steif_curve curve = {.label = "a", .count = 7, .x = x, .y = y};
  steif_plot plot = {.log_y = 1, .count = 1, .curve = &curve};
  draw(&plot);
  const char *path_data = strstr(text, "<path d=\"");
  CU_ASSERT_PTR_NOT_NULL_FATAL(path_data);
  size_t moves = 0, lines = 0;
  for (const char *c = path_data + 9; *c != '"'; c++) moves += *c == 'M', lines += *c == 'L';
  CHECK(moves == 2 && lines == 2);
  plot.log_y = 0;
  draw(&plot);
  path_data = strstr(text, "<path d=\"");
  moves = lines = 0;
  for (const char *c = path_data + 9; *c != '"'; c++) moves += *c == 'M', lines += *c == 'L';
  CHECK(moves == 2 && lines == 4);
}

static void hostile_data_is_drawn(void)
{
  static const sunrealtype same[] = {3.5, 3.5, 3.5}, bad[] = {NAN, -INFINITY, -2.5},
                           wide[] = {1e-300, 1e299, 1e308}, tiny[] = {0, 5e-324, 1e-310};
  const steif_curve curve[] = {{.label = "same", .count = 3, .x = same, .y = same, .marks = 1},
                               {.label = "wide", .count = 3, .x = wide, .y = wide},
                               {.label = "bad", .count = 3, .x = bad, .y = same, .marks = 2},
                               {.label = "tiny", .count = 3, .x = tiny, .y = tiny},
                               {.label = NULL, .count = 0}};
  for (size_t first = 0; first < 5; first++)
    for (size_t count = 0; first + count <= 5; count++)
      for (int mode = 0; mode < 5; mode++) {
        const steif_plot plot = {.count = count,
                                 .curve = curve + first,
                                 .log_x = mode & 1,
                                 .log_y = mode & 2,
                                 .equal = mode == 4};
        draw(&plot);
      }
}

static void words_are_escaped(void)
{
  static const sunrealtype x[] = {2.5, 3.75};
  const steif_curve curve[] = {{.label = "<b> & \"c\"", .count = 2, .x = x, .y = x},
                               {.label = "\xff"
                                         "J\xC3\xB8rn",
                                .count = 2,
                                .x = x,
                                .y = x}};
  const steif_plot plot = {
    .title = "a < b\n", .x_label = "t & s", .y_label = "</text>", .count = 2, .curve = curve};
  draw(&plot);
  CHECK(strstr(text, "&lt;b&gt; &amp; &quot;c&quot;"));
  CHECK(strstr(text, "?J\xC3\xB8rn"));
  CHECK(strstr(text, "&lt;/text&gt;"));
}

static void legend_names_every_curve(void)
{
  sunrealtype x[40], y[40];
  char label[30][16];
  steif_curve curve[30];
  for (int i = 0; i < 40; i++) x[i] = 0.3 * i, y[i] = 1.7 * i;
  for (int k = 0; k < 30; k++) {
    snprintf(label[k], sizeof label[k], "curve %d", k + 100);
    curve[k] = (steif_curve){.label = label[k], .count = 40, .x = x, .y = y, .marks = k % 3};
  }
  draw(&(steif_plot){.count = 30, .curve = curve});
  CHECK(count_of("class=\"k\">curve ") == 30);
  draw(&(steif_plot){.count = 1, .curve = curve});
  CHECK(count_of("class=\"k\"") == 0);
}

static void many_points_stay_small(void)
{
  enum { MANY = 400000 };
  sunrealtype *x = malloc(MANY * sizeof *x), *y = malloc(MANY * sizeof *y);
  CU_ASSERT_FATAL(x && y);
  for (int i = 0; i < MANY; i++) x[i] = i * 1e-5, y[i] = sin(x[i] * 2.385);
  const steif_curve curve = {.count = MANY, .x = x, .y = y, .marks = 1};
  draw(&(steif_plot){.count = 1, .curve = &curve});
  CHECK(strlen(text) < 120000);
  CHECK(strlen(text) > 8000);
  free(x), free(y);
}

static void bad_pictures_are_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_curve curve = {.count = 3};
  const steif_plot empty = {0}, hollow = {.count = 1, .curve = &curve};
  CHECK(steif_plot_save(ctx, &empty, "/tmp/picture.gif") == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), ".svg or .png"));
  CHECK(steif_plot_save(ctx, &empty, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_plot_save(ctx, NULL, "/tmp/a.svg") == STEIF_BAD_INPUT);
  CHECK(steif_plot_save(ctx, &hollow, temporary(".svg")) == STEIF_BAD_INPUT);
  CHECK(access(path, F_OK) != 0);
  CHECK(steif_plot_save(ctx, &empty, "/no/such/folder/a.svg") == STEIF_IO);
  CHECK(steif_plot_save(ctx, &empty, "/no/such/folder/a.png") == STEIF_IO);
  steif_context_free(&ctx);
}

/* A path that is hostile to a shell and to gnuplot. */
static void png_comes_from_gnuplot(void)
{
  static const sunrealtype x[] = {1, 2, 4, 8}, y[] = {1e-3, NAN, 1e-5, 2e-6};
  const steif_curve curve[] = {{.label = "it's {a_b}", .count = 4, .x = x, .y = y, .marks = 1},
                               {.label = "b", .count = 0}};
  const steif_plot plot = {
    .title = "q''; system 'false'; '", .log_x = 1, .log_y = 1, .count = 2, .curve = curve};
  steif_context *ctx = steif_context_new(NULL);
  temporary("'$(touch x)`\"|.png");
  const int code = steif_plot_save(ctx, &plot, path);
  CHECK(code == STEIF_OK ||
        (code == STEIF_UNSUPPORTED && strstr(steif_message(ctx), "gnuplot")));
  if (code == STEIF_OK) CHECK(!memcmp(contents(path, text), "\x89PNG", 4));
  CHECK((access(path, F_OK) == 0) == (code == STEIF_OK));
  unlink(path);
  steif_context_free(&ctx);
}

static void missing_gnuplot_is_told(void)
{
  steif_context *ctx = steif_context_new(NULL);
  char *old = strdup(getenv("PATH") ? getenv("PATH") : "");
  setenv("PATH", "/no/such/folder", 1);
  CHECK(steif_plot_save(ctx, &(steif_plot){0}, temporary(".png")) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "install gnuplot or name an .svg file"));
  CHECK(access(path, F_OK) != 0);
  setenv("PATH", old, 1);
  free(old);
  steif_context_free(&ctx);
}

/* Nine components of sizes 1 and 1e-3 over (0, 2e4): eight curves in two panels by their size, a logarithmic
 * axis; names where there are some. */
static void components_of_one_size_share_a_panel(void)
{
  enum { ROWS = 20, N = 9 };
  static const char *const names[N] = {"a", "b<", "c", "d", "e", "f", "g", "h", "i"};
  double t[ROWS], y[ROWS * N];
  for (int i = 0; i < ROWS; i++) {
    t[i] = pow(10, i * 4.3 / ROWS);
    for (int k = 0; k < N; k++) y[i * N + k] = sin(0.1 * (i + k + 1)) * (k % 2 ? 1e-3 : 1);
  }
  y[7] = NAN;
  steif_context *ctx = steif_context_new(NULL);
  const char *to = temporary(".svg");
  CHECK(steif_plot_components(ctx, "nine", ROWS, N, NULL, t, y, to) == STEIF_OK);
  contents(path, text);
  unlink(path);
  CHECK(balanced(text) && count_of("<clipPath") == 2);
  CHECK(count_of(">y8<") == 1 && count_of(">y1<") == 1 && !strstr(text, ">y9<"));
  CHECK(strstr(text, "the first components are shown"));
  CHECK(steif_plot_components(ctx, "two", ROWS, 1, names, t, y, to) == STEIF_OK);
  contents(path, text);
  unlink(path);
  CHECK(balanced(text) && count_of("<clipPath") == 1 && count_of(">a<") == 1);
  CHECK(steif_plot_components(ctx, "two", ROWS, 2, names, t, y, to) == STEIF_OK);
  contents(path, text);
  unlink(path);
  CHECK(balanced(text) && count_of("<clipPath") == 1 && count_of(">b&lt;<") == 1);
  CHECK(steif_plot_components(ctx, "two", ROWS, 2, NULL, t, y, "two.txt") == STEIF_BAD_INPUT);
  const steif_plot none[9] = {{0}};
  CHECK(steif_panels_save(ctx, 9, none, to) == STEIF_BAD_INPUT);
  CHECK(steif_panels_save(ctx, 0, none, to) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

static int disc(double x, double y, void *user)
{
  const double *radius = user;
  return x * x + y * y <= *radius * *radius;
}

/* The area of the rectangles, in pixels, is that of the disc. */
static void what_is_inside_is_shaded(void)
{
  double x[] = {-2, 2, 2, -2}, y[] = {-2, -2, 2, 2}, radius = 1.5, area = 0;
  const steif_curve square = {"square", 4, x, y, 0};
  const steif_plot plot = {
    .equal = 1, .count = 1, .curve = &square, .inside = disc, .user = &radius};
  steif_context *ctx = steif_context_new(NULL);
  const char *to = temporary(".svg");
  CHECK(steif_plot_save(ctx, &plot, to) == STEIF_OK);
  contents(path, text);
  unlink(path);
  const char *at = strstr(text, "<g fill=\"#dbe9f4\">"), *end = at ? strstr(at, "</g>") : NULL;
  CU_ASSERT_FATAL(at && end);
  double frame = 0, lo = 1e9, hi = 0;
  while ((at = strstr(at, "<rect")) && at < end) {
    const char *w = strstr(at, "width=\""), *left = strstr(at, "x=\"");
    const double width = strtod(w + 7, NULL), from = strtod(left + 3, NULL);
    area += 2 * width;
    lo = fmin(lo, from), hi = fmax(hi, from + width);
    at = w;
  }
  frame = hi - lo; /* the diameter */
  CLOSE(area / (frame * frame / 4), 3.14159265, 0.03);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_pictures[] = {
  {"what is inside is shaded", what_is_inside_is_shaded},
  {"points that cannot be drawn break the line", gaps_break_the_line},
  {"any data gives a finite, balanced picture", hostile_data_is_drawn},
  {"words are escaped", words_are_escaped},
  {"the legend names every curve", legend_names_every_curve},
  {"many points give a small file", many_points_stay_small},
  {"bad pictures are rejected and leave nothing", bad_pictures_are_rejected},
  {"PNG comes from gnuplot, whatever the path", png_comes_from_gnuplot},
  {"missing gnuplot is told with its remedy", missing_gnuplot_is_told},
  {"components of one size share a panel of their size", components_of_one_size_share_a_panel},
  CU_TEST_INFO_NULL};
