/* gnuplot.c: a picture as PNG by gnuplot. The script comes from a temporary file and the picture
 * goes to the output file through standard streams, so no path and no shell is involved.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* A single-quoted gnuplot string, in which only the quote itself is special: pieces joined by the
 * quote in double quotes, for two doubled quotes side by side are not understood. */
static void quoted(FILE *script, const char *text)
{
  putc('\'', script);
  for (; text && *text; text++) {
    if (*text == '\'')
      fputs("'.\"'\".'", script);
    else
      putc((unsigned char)*text < ' ' ? ' ' : *text, script);
  }
  putc('\'', script);
}

static void setting(FILE *script, const char *what, const char *text)
{
  fprintf(script, "set %s ", what);
  quoted(script, text);
  fputs(" noenhanced\n", script);
}

static void terminal(FILE *script)
{
  fputs("if (strstrt(GPVAL_TERMINALS, 'pngcairo')) {\n"
        "  set terminal pngcairo size 1100,720 font 'Sans,12' linewidth 1.4\n"
        "} else {\n  set terminal png size 1100,720\n}\n"
        "set border lc rgb '#555555'\nset grid lc rgb '#dddddd'\nset datafile missing '?'\n"
        "set tics nomirror\n",
        script);
}

static void axes(const steif_plot *plot, FILE *script)
{
  setting(script, "title", plot->title);
  setting(script, "xlabel", plot->x_label);
  setting(script, "ylabel", plot->y_label);
  fputs(plot->count > 1 ? "set key outside right top Left reverse noenhanced\n" : "unset key\n",
        script);
  if (plot->log_x) fputs("set logscale x\nset format x '10^{%T}'\n", script);
  if (plot->log_y) fputs("set logscale y\nset format y '10^{%T}'\n", script);
  if (plot->equal) fputs("set size ratio -1\nset zeroaxis lt 1 lc rgb '#999999'\n", script);
}

/* Points that cannot be drawn become empty lines, which are gaps. */
static bool data(const steif_plot *plot, FILE *script)
{
  const stf_axis x_axis = {.log = plot->log_x}, y_axis = {.log = plot->log_y};
  bool any = false;
  for (size_t k = 0; k < plot->count; k++) {
    const steif_curve *c = &plot->curve[k];
    fprintf(script, "$curve%zu << EOD\n", k);
    for (size_t i = 0; i < c->count; i++) {
      char x[40], y[40];
      double unused;
      const bool drawn =
        stf_axis_value(&x_axis, c->x[i], &unused) && stf_axis_value(&y_axis, c->y[i], &unused);
      any = any || drawn;
      stf_report_number(x, sizeof x, 'g', 17, c->x[i]);
      stf_report_number(y, sizeof y, 'g', 17, c->y[i]);
      if (drawn)
        fprintf(script, "%s %s\n", x, y);
      else
        putc('\n', script);
    }
    fputs("EOD\n", script);
  }
  return any;
}

/* A frame as wide as it is high, around curves that may be a vertical line: the one of SVG. */
static void frame(const steif_plot *plot, FILE *script)
{
  stf_axis x = {.p1 = 1}, y = {.p1 = 1};
  char low[40], high[40];
  stf_axis_range(&x, plot, false);
  stf_axis_range(&y, plot, true);
  stf_axis_equal(&x, &y);
  for (int k = 0; k < 2; k++) {
    stf_report_number(low, sizeof low, 'g', 17, k ? y.lo : x.lo);
    stf_report_number(high, sizeof high, 'g', 17, k ? y.hi : x.hi);
    fprintf(script, "set %srange [%s:%s]\n", k ? "y" : "x", low, high);
  }
}

static void shade(const steif_plot *plot, FILE *script)
{
  enum { ROWS = 240 };
  stf_axis x = {.p1 = 1}, y = {.p1 = 1};
  double piece[STF_PIECES][2];
  if (!plot->inside || plot->log_x || plot->log_y) return;
  stf_axis_range(&x, plot, false);
  stf_axis_range(&y, plot, true);
  if (plot->equal) stf_axis_equal(&x, &y);
  for (int k = 0; k < ROWS; k++) {
    const double step = (y.hi - y.lo) / ROWS, low = y.lo + step * k;
    const size_t count = stf_shade_row(plot, low + step / 2, x.lo, x.hi, piece);
    for (size_t i = 0; i < count; i++) {
      const double corner[] = {piece[i][0], low, piece[i][1], low + step};
      char text[4][40];
      for (int c = 0; c < 4; c++) stf_report_number(text[c], sizeof text[c], 'g', 9, corner[c]);
      fprintf(script,
              "set object rect from %s,%s to %s,%s back fc rgb '#dbe9f4' fs solid noborder\n",
              text[0], text[1], text[2], text[3]);
    }
  }
}

static void script_of(const steif_plot *plot, FILE *script)
{
  static const char *const style[] = {"lines", "linespoints", "points"};
  axes(plot, script);
  if (!data(plot, script)) {
    fputs(plot->log_x ? "set xrange [1:10]\n" : "set xrange [0:1]\n", script);
    fputs(plot->log_y ? "set yrange [1:10]\n" : "set yrange [0:1]\n", script);
    fputs("plot NaN notitle\n", script);
    return;
  }
  if (plot->equal) frame(plot, script);
  shade(plot, script);
  for (size_t k = 0; k < plot->count; k++) {
    const steif_curve *c = &plot->curve[k];
    fprintf(script, "%s $curve%zu using 1:2 with %s pt %zu lc rgb '%s' title ",
            k ? "," : "plot", k, style[c->marks == 1 || c->marks == 2 ? c->marks : 0],
            k % 7 + 5, stf_colours[k % STF_COLOURS]);
    quoted(script, c->label);
  }
  putc('\n', script);
}

/* gnuplot -d (no start-up files) with the script as input and the picture as output. */
static int run(FILE *script, FILE *picture, pid_t *child)
{
  char program[] = "gnuplot", flag[] = "-d";
  char *const arguments[] = {program, flag, NULL};
  posix_spawn_file_actions_t streams;
  int failed = posix_spawn_file_actions_init(&streams);
  if (failed) return failed;
  failed = posix_spawn_file_actions_adddup2(&streams, fileno(script), 0);
  if (!failed) failed = posix_spawn_file_actions_adddup2(&streams, fileno(picture), 1);
  if (!failed) failed = posix_spawn_file_actions_addopen(&streams, 2, "/dev/null", O_WRONLY, 0);
  if (!failed) failed = posix_spawnp(child, program, &streams, NULL, arguments, environ);
  posix_spawn_file_actions_destroy(&streams);
  return failed;
}

/* Exit code of the child; 127 is also how POSIX lets a spawn say that the program was not found. */
static int waited(pid_t child)
{
  int status = 0;
  pid_t got;
  do got = waitpid(child, &status, 0);
  while (got < 0 && errno == EINTR);
  return got == child && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int stf_plot_gnuplot(steif_context *ctx, size_t count, const steif_plot *panel, FILE *stream)
{
  FILE *script = tmpfile();
  STEIF_CHECK(script, ctx, STEIF_IO, "no temporary file for gnuplot: %s; name an .svg file",
              strerror(errno));
  terminal(script);
  if (count > 1)
    fprintf(script, "set multiplot layout %zu,1\nset lmargin 15\nset rmargin 18\n", count);
  for (size_t i = 0; i < count; i++) script_of(panel + i, script);
  if (count > 1) fputs("unset multiplot\n", script);
  pid_t child = 0;
  const bool written = !fflush(script) && !ferror(script) && !fseek(script, 0, SEEK_SET) &&
                       lseek(fileno(script), 0, SEEK_SET) == 0;
  const int failed = written ? run(script, stream, &child) : EIO;
  const int left = failed ? -1 : waited(child);
  fclose(script);
  STEIF_CHECK(
    failed != ENOENT && left != 127, ctx, STEIF_UNSUPPORTED,
    "PNG pictures are drawn by gnuplot, which was not found: install gnuplot or name an "
    ".svg file");
  STEIF_CHECK(left == 0, ctx, STEIF_UNSUPPORTED,
              "gnuplot drew no picture%s%s; name an .svg file", failed ? ": " : "",
              failed ? strerror(failed) : "");
  return STEIF_OK;
}
