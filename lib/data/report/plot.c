/* plot.c: check a picture and send it to the writer that the ending of the path names.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <string.h>

static bool ends(const char *path, const char *ending)
{
  const size_t length = strlen(path), tail = strlen(ending);
  return length > tail && !strcmp(path + length - tail, ending);
}

static int check(steif_context *ctx, const steif_plot *plot)
{
  STEIF_CHECK(plot && (plot->count == 0 || plot->curve), ctx, STEIF_BAD_INPUT,
              "a picture of %zu curves without the curves; set plot.curve",
              plot ? plot->count : 0);
  for (size_t k = 0; k < plot->count; k++)
    STEIF_CHECK(plot->curve[k].count == 0 || (plot->curve[k].x && plot->curve[k].y), ctx,
                STEIF_BAD_INPUT, "curve %zu of the picture has no points; set x and y", k + 1);
  return STEIF_OK;
}

int steif_panels_save(steif_context *ctx, size_t count, const steif_plot *panel,
                      const char *path)
{
  STEIF_CHECK(panel && count >= 1 && count <= STF_PANELS, ctx, STEIF_BAD_INPUT,
              "a picture has 1 to %d panels, not %zu", STF_PANELS, count);
  for (size_t i = 0; i < count; i++) STEIF_TRY(check(ctx, panel + i));
  const bool png = path && ends(path, ".png");
  STEIF_CHECK(png || (path && ends(path, ".svg")), ctx, STEIF_BAD_INPUT,
              "\"%s\" is no picture: name a file that ends in .svg or .png", path ? path : "");
  stf_output output;
  STEIF_TRY(stf_output_open(ctx, path, &output));
  const int code = png ? stf_plot_gnuplot(ctx, count, panel, output.stream)
                       : stf_plot_svg(count, panel, output.stream);
  return stf_output_close(ctx, &output, code);
}

int steif_plot_save(steif_context *ctx, const steif_plot *plot, const char *path)
{
  return steif_panels_save(ctx, 1, plot, path);
}
