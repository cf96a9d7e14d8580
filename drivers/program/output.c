/* output.c: reports, pictures and files as the user asked for them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "output.h"
#include "message.h"
#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int show(const struct call *call, steif_report *report)
{
  progress(call, NULL);
  if (steif_report_write(report, call->json ? STEIF_JSON : STEIF_TABLE, stdout) == STEIF_OK) {
    fflush(stdout);
    return save_report_arrays(call, report);
  }
  say(call, "%s", steif_message(call->ctx));
  return EXIT_FAILED;
}

int save_csv(const struct call *call, steif_report *report)
{
  if (!call->csv || steif_report_save(report, STEIF_CSV, call->csv) == STEIF_OK) return EXIT_OK;
  say(call, "%s", steif_message(call->ctx));
  return EXIT_FAILED;
}

int save_plot(const struct call *call, const steif_plot *plot, const char *path)
{
  if (!path || steif_plot_save(call->ctx, plot, path) == STEIF_OK) return EXIT_OK;
  say(call, "%s", steif_message(call->ctx));
  return EXIT_FAILED;
}

void rows_come(const struct call *call, steif_report *report)
{
  progress(call, NULL);
  if (steif_report_flow(report, call->csv, call->json ? NULL : stdout)) steif_forget(call->ctx);
}

void csv_comes(const struct call *call, steif_report *report)
{
  if (steif_report_flow(report, call->csv, NULL)) steif_forget(call->ctx);
}

int present(const struct call *call, steif_report *report)
{
  const int shown = show(call, report), saved = save_csv(call, report);
  return shown ? shown : saved;
}

static int report_result(const struct call *call, report_filler *fill, const void *result,
                         int (*out)(const struct call *call, steif_report *r))
{
  steif_report *r = steif_report_new(call->ctx);
  if (r) fill(r, call, result);
  const int code = r ? out(call, r) : fail(call);
  steif_report_free(&r);
  return code;
}

int present_result(const struct call *call, report_filler *fill, const void *result)
{
  return report_result(call, fill, result, present);
}

int show_result(const struct call *call, report_filler *fill, const void *result)
{
  return report_result(call, fill, result, show);
}

int save_rows(const struct call *call, report_filler *fill, const void *result)
{
  return call->csv ? report_result(call, fill, result, save_csv) : EXIT_OK;
}

static bool writable(const char *path)
{
  struct stat info;
  char folder[4096];
  const char *slash = strrchr(path, '/');
  if (!stat(path, &info)) {
    errno = S_ISDIR(info.st_mode) ? EISDIR : 0;
    return !errno && !access(path, W_OK);
  }
  const size_t length = slash ? (size_t)(slash - path) : 0;
  errno = ENAMETOOLONG;
  if (length >= sizeof folder) return false;
  snprintf(folder, sizeof folder, "%.*s", (int)length, path);
  return !access(!slash ? "." : length ? folder : "/", W_OK);
}

int check_outputs(const struct call *call)
{
  const char *const path[] = {call->csv, call->plot, call->npz, call->h5};
  for (int i = 0; i < 4; i++)
    if (path[i] && !writable(path[i])) {
      say(call,
          "cannot write \"%s\": %s; name a file in a folder that exists and may be written "
          "[STEIF_IO]",
          path[i], strerror(errno));
      return EXIT_FAILED;
    }
  const size_t length = call->plot ? strlen(call->plot) : 0;
  const char *ending = length > 4 ? call->plot + length - 4 : "";
  if (call->plot && strcmp(ending, ".svg") && strcmp(ending, ".png"))
    return bad_usage(call, "--plot is \"%s\" and must end in .svg or .png", call->plot);
  return EXIT_OK;
}
