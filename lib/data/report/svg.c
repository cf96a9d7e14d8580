/* svg.c: a picture of curves as SVG: axes with ticks, grid, legend, lines and marks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include "svg_elements.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MINUS "\xE2\x88\x92"

/* Colours that colour-blind readers tell apart (Okabe and Ito, 2008), darkened where pale. */
const char *const stf_colours[] = {"#0072b2", "#d55e00", "#009e73", "#b8568f",
                                   "#c98a00", "#2f9fd8", "#444444", "#7a3e9d"};
static const char *const dashes[] = {"", "7 3", "2 3", "8 3 2 3"};
enum { DASHES = 4, SHAPES = 6 };

typedef struct picture {
  FILE *out;
  const steif_plot *plot;
  stf_axis x, y;
  double left, top, right, bottom, width, height;
} picture;

/* ---- layout ---- */

/* Roughly, in pixels of a 12 px sans-serif. */
static double text_width(const char *text)
{
  return text ? 6.6 * (double)stf_report_width(text) : 0;
}

static double widest_tick(const stf_axis *axis)
{
  double width = axis->log ? 30 : 8;
  for (int i = 0; i < axis->ticks; i++) {
    const stf_tick *tick = &axis->tick[i];
    width = fmax(width, tick->decade && tick->lead > 1 ? 44 : text_width(tick->label));
  }
  return width;
}

static bool has_legend(const steif_plot *plot) { return plot->count > 1; }

static double legend_width(const steif_plot *plot)
{
  double width = 0;
  for (size_t k = 0; k < plot->count; k++)
    width = fmax(width, text_width(plot->curve[k].label));
  return has_legend(plot) ? 62 + width : 26;
}

/* One of `count` panels, the bottom of the one above at `above`; plots of their own are higher. */
static picture layout(const steif_plot *plot, size_t count, double above, FILE *out)
{
  picture p = {.out = out, .plot = plot, .top = above + (above > 0 ? 36 : 54)};
  p.x.log = plot->log_x;
  p.y.log = plot->log_y;
  stf_axis_range(&p.x, plot, false);
  stf_axis_range(&p.y, plot, true);
  const double w = plot->equal ? 470 : 560;
  const double h = plot->equal ? 470 : count > 1 ? fmax(130, 480 / (double)count) : 370;
  p.x.p1 = w;
  p.y.p1 = h;
  if (plot->equal) stf_axis_equal(&p.x, &p.y);
  stf_axis_ticks(&p.x, 8);
  stf_axis_ticks(&p.y, count > 1 ? 4 : 7);
  p.left = 44 + widest_tick(&p.y);
  p.right = p.left + w;
  p.bottom = p.top + h;
  p.y.p0 = p.bottom;
  p.y.p1 = p.top;
  p.height = p.bottom + 58;
  const double needed = 22.0 * (double)plot->count + p.top + 30;
  if (has_legend(plot) && needed > p.height) p.height = needed;
  return p;
}

/* The frames of all panels one below another: the left edge is that of the widest labels. */
static void align(size_t count, picture *p)
{
  double left = 0, width = 0;
  for (size_t i = 0; i < count; i++) left = fmax(left, p[i].left);
  for (size_t i = 0; i < count; i++) {
    p[i].right += left - p[i].left;
    p[i].left = left;
    p[i].x.p0 = p[i].left;
    p[i].x.p1 = p[i].right;
    width = fmax(width, p[i].right + legend_width(p[i].plot));
  }
  p->width = width;
}

/* ---- axes ---- */

/* 10^exponent, after "lead . " when that is above 1. */
static void power(const picture *p, double x, double y, const char *anchor, const char *lead,
                  int exponent)
{
  fputs("<text", p->out);
  stf_svg_attribute(p->out, "x", x);
  stf_svg_attribute(p->out, "y", y);
  fprintf(p->out,
          " class=\"n\" text-anchor=\"%s\">%s10<tspan dy=\"-5\" font-size=\"9\">%s%d"
          "</tspan></text>\n",
          anchor, lead, exponent < 0 ? MINUS : "", abs(exponent));
}

static void tick_label(const picture *p, double x, double y, const char *anchor,
                       const stf_tick *tick)
{
  char style[64], text[40];
  if (tick->decade) {
    snprintf(text, sizeof text, "%d\xC2\xB7", tick->lead);
    power(p, x, y, anchor, tick->lead > 1 ? text : "", tick->power);
    return;
  }
  const bool negative = *tick->label == '-';
  snprintf(style, sizeof style, "class=\"n\" text-anchor=\"%s\"", anchor);
  snprintf(text, sizeof text, "%s%s", negative ? MINUS : "", tick->label + negative);
  stf_svg_words(p->out, x, y, style, text);
}

static void ticks(const picture *p, const stf_axis *axis, bool vertical)
{
  for (int i = 0; i < axis->ticks; i++) {
    const stf_tick *tick = &axis->tick[i];
    const double at = stf_axis_pixel(axis, tick->at), size = tick->major ? 5 : 3;
    const char *grid = tick->major ? "class=\"g\"" : "class=\"m\"";
    if (vertical) {
      stf_svg_segment(p->out, p->left, at, p->right, at, grid);
      stf_svg_segment(p->out, p->left, at, p->left + size, at, "class=\"a\"");
      tick_label(p, p->left - 7, at + 4, "end", tick);
    } else {
      stf_svg_segment(p->out, at, p->bottom, at, p->top, grid);
      stf_svg_segment(p->out, at, p->bottom, at, p->bottom - size, "class=\"a\"");
      tick_label(p, at, p->bottom + 18, "middle", tick);
    }
  }
}

/* The factor of the labels at the end of an axis: x 10^5. */
static void factor(const picture *p, const stf_axis *axis, double x, double y,
                   const char *anchor)
{
  if (axis->scale) power(p, x, y, anchor, "\xC3\x97 ", axis->scale);
}

static void axes(const picture *p)
{
  const steif_plot *plot = p->plot;
  ticks(p, &p->x, false);
  ticks(p, &p->y, true);
  if (plot->equal && p->x.lo < 0 && p->x.hi > 0)
    stf_svg_segment(p->out, stf_axis_pixel(&p->x, 0), p->top, stf_axis_pixel(&p->x, 0),
                    p->bottom, "class=\"z\"");
  if (plot->equal && p->y.lo < 0 && p->y.hi > 0)
    stf_svg_segment(p->out, p->left, stf_axis_pixel(&p->y, 0), p->right,
                    stf_axis_pixel(&p->y, 0), "class=\"z\"");
  factor(p, &p->x, p->right, p->bottom + 36, "end");
  factor(p, &p->y, p->left, p->top - 7, "middle");
  const double middle_x = (p->left + p->right) / 2, middle_y = (p->top + p->bottom) / 2;
  stf_svg_words(p->out, p->left, p->top - 30, "class=\"t\"", plot->title);
  stf_svg_words(p->out, middle_x, p->bottom + 42, "class=\"l\" text-anchor=\"middle\"",
                plot->x_label);
  fputs("<g transform=\"translate(20 ", p->out);
  stf_svg_number(p->out, middle_y);
  fputs(") rotate(-90)\">", p->out);
  stf_svg_words(p->out, 0, 0, "class=\"l\" text-anchor=\"middle\"", plot->y_label);
  fputs("</g>\n", p->out);
}

/* ---- curves ---- */

/* Outlines within a square of half side 1 around the point. */
static void mark(FILE *out, size_t k, double x, double y)
{
  static const struct {
    int corners;
    double at[12];
  } shapes[SHAPES - 1] = {
    {4, {-.9, -.9, .9, -.9, .9, .9, -.9, .9}},
    {3, {0, -1.2, 1.1, .9, -1.1, .9}},
    {4, {0, -1.3, 1.1, 0, 0, 1.3, -1.1, 0}},
    {3, {0, 1.2, 1.1, -.9, -1.1, -.9}},
    {6, {1.15, 0, .58, 1, -.58, 1, -1.15, 0, -.58, -1, .58, -1}},
  };
  const size_t shape = k % SHAPES;
  if (shape == 0) {
    fputs("<circle", out);
    stf_svg_attribute(out, "cx", x);
    stf_svg_attribute(out, "cy", y);
    fputs(" r=\"3.6\"/>\n", out);
    return;
  }
  fputs("<path d=\"", out);
  for (int i = 0; i < shapes[shape - 1].corners; i++) {
    fputs(i ? "L" : "M", out);
    stf_svg_number(out, x + 3.6 * shapes[shape - 1].at[2 * i]);
    putc(' ', out);
    stf_svg_number(out, y + 3.6 * shapes[shape - 1].at[2 * i + 1]);
  }
  fputs("Z\"/>\n", out);
}

static bool pixel(const picture *p, const steif_curve *c, size_t i, double *x, double *y)
{
  if (!stf_axis_value(&p->x, c->x[i], x) || !stf_axis_value(&p->y, c->y[i], y)) return false;
  *x = stf_axis_pixel(&p->x, *x);
  *y = stf_axis_pixel(&p->y, *y);
  return true;
}

/* Points nearer than a third of a pixel to the last one drawn are left out. */
static void path(const picture *p, const steif_curve *c)
{
  double x, y, x0 = 0, y0 = 0;
  bool pen = false;
  fputs("<path d=\"", p->out);
  for (size_t i = 0; i < c->count; i++) {
    if (!pixel(p, c, i, &x, &y)) {
      pen = false;
      continue;
    }
    if (pen && fabs(x - x0) + fabs(y - y0) < 0.33 && i + 1 < c->count) continue;
    fputs(pen ? "L" : "M", p->out);
    stf_svg_number(p->out, x);
    putc(' ', p->out);
    stf_svg_number(p->out, y);
    pen = true;
    x0 = x;
    y0 = y;
  }
  fputs("\"/>\n", p->out);
}

/* A point alone between gaps would leave no trace on a line. */
static bool lonely(const picture *p, const steif_curve *c, size_t i)
{
  double x, y;
  return !(i > 0 && pixel(p, c, i - 1, &x, &y)) &&
         !(i + 1 < c->count && pixel(p, c, i + 1, &x, &y));
}

/* On lines, marks keep a distance; points alone are all drawn. */
static void marks(const picture *p, size_t k)
{
  const steif_curve *c = &p->plot->curve[k];
  const double apart = c->marks == 2 ? 0.5 : 11;
  double x, y, x0 = -1e9, y0 = -1e9;
  for (size_t i = 0; i < c->count; i++) {
    if (!pixel(p, c, i, &x, &y) || hypot(x - x0, y - y0) < apart) continue;
    if (c->marks == 0 && !lonely(p, c, i)) continue;
    mark(p->out, k, x, y);
    x0 = x;
    y0 = y;
  }
}

static void open_group(const picture *p, size_t k, bool line)
{
  const char *dash = dashes[(k / STF_COLOURS) % DASHES];
  fprintf(p->out,
          line ? "<g fill=\"none\" stroke=\"%s\" stroke-width=\"1.8\" "
                 "stroke-linejoin=\"round\""
               : "<g fill=\"%s\" stroke=\"#fff\" "
                 "stroke-width=\"0.6\"",
          stf_colours[k % STF_COLOURS]);
  if (line && *dash) fprintf(p->out, " stroke-dasharray=\"%s\"", dash);
  fputs(">\n", p->out);
}

static void curve(const picture *p, size_t k)
{
  if (p->plot->curve[k].marks != 2) {
    open_group(p, k, true);
    path(p, &p->plot->curve[k]);
    fputs("</g>\n", p->out);
  }
  open_group(p, k, false);
  marks(p, k);
  fputs("</g>\n", p->out);
}

static void legend(const picture *p)
{
  for (size_t k = 0; k < p->plot->count; k++) {
    const double x = p->right + 16, y = p->top + 12 + 22 * (double)k;
    if (p->plot->curve[k].marks != 2) {
      open_group(p, k, true);
      stf_svg_segment(p->out, x, y, x + 26, y, "");
      fputs("</g>\n", p->out);
    }
    if (p->plot->curve[k].marks) {
      open_group(p, k, false);
      mark(p->out, k, x + 13, y);
      fputs("</g>\n", p->out);
    }
    stf_svg_words(p->out, x + 33, y + 4, "class=\"k\"", p->plot->curve[k].label);
  }
}

static void opening(const picture *p, double height)
{
  fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<svg xmlns=\"http://www.w3.org/2000/svg\"",
        p->out);
  stf_svg_attribute(p->out, "width", p->width);
  stf_svg_attribute(p->out, "height", height);
  fputs(" font-family=\"Helvetica, Arial, DejaVu Sans, sans-serif\">\n<style>"
        ".t{font-size:15px;font-weight:bold;fill:#222}.l{font-size:13px;fill:#222}"
        ".n{font-size:12px;fill:#333}.k{font-size:12px;fill:#222}"
        ".g{stroke:#e2e2e2;stroke-width:1}.m{stroke:#f3f3f3;stroke-width:1}"
        ".a{stroke:#555;stroke-width:1}.z{stroke:#999;stroke-width:1}</style>\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        p->out);
}

/* A rectangle over the area of the curves: its frame, or the edge they are clipped at. */
static void area(const picture *p, const char *style)
{
  fputs("<rect", p->out);
  stf_svg_attribute(p->out, "x", p->left);
  stf_svg_attribute(p->out, "y", p->top);
  stf_svg_attribute(p->out, "width", p->right - p->left);
  stf_svg_attribute(p->out, "height", p->bottom - p->top);
  fprintf(p->out, " %s/>", style);
}

/* Rows two pixels high of what is shaded. */
static void shade(const picture *p)
{
  double piece[STF_PIECES][2];
  if (!p->plot->inside || p->x.log || p->y.log) return;
  fputs("<g fill=\"#dbe9f4\">\n", p->out);
  for (double at = p->bottom; at > p->top; at -= 2) {
    const double y =
      p->y.lo + (p->y.hi - p->y.lo) * (p->bottom - at + 1) / (p->bottom - p->top);
    const size_t count = stf_shade_row(p->plot, y, p->x.lo, p->x.hi, piece);
    for (size_t i = 0; i < count; i++) {
      const double left = stf_axis_pixel(&p->x, piece[i][0]);
      fputs("<rect", p->out);
      stf_svg_attribute(p->out, "x", left);
      stf_svg_attribute(p->out, "y", at - 2);
      stf_svg_attribute(p->out, "width", stf_axis_pixel(&p->x, piece[i][1]) - left);
      stf_svg_attribute(p->out, "height", 2);
      fputs("/>\n", p->out);
    }
  }
  fputs("</g>\n", p->out);
}

static void panel_of(const picture *p, size_t k)
{
  fprintf(p->out, "<clipPath id=\"area%zu\">", k);
  area(p, "");
  fputs("</clipPath>\n", p->out);
  shade(p);
  axes(p);
  fprintf(p->out, "<g clip-path=\"url(#area%zu)\">\n", k);
  for (size_t i = 0; i < p->plot->count; i++) curve(p, i);
  fputs("</g>\n", p->out);
  area(p, "fill=\"none\" stroke=\"#555\"");
  putc('\n', p->out);
  if (has_legend(p->plot)) legend(p);
}

int stf_plot_svg(size_t count, const steif_plot *panel, FILE *stream)
{
  picture p[STF_PANELS] = {{.out = stream}};
  double above = 0;
  for (size_t i = 0; i < count; i++) {
    p[i] = layout(panel + i, count, above, stream);
    above = i + 1 < count ? p[i].bottom : p[i].height;
  }
  align(count, p);
  opening(p, above);
  for (size_t i = 0; i < count; i++) panel_of(p + i, i);
  fputs("</svg>\n", stream);
  return STEIF_OK;
}
