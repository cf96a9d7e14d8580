/* face.c: exit codes, sentences, progress and output of every verb.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "face.h"
#include <errno.h>
#include <stdarg.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int exit_of(int code)
{
  switch (code) {
  case STEIF_OK:
  case STEIF_EVENT: return EXIT_OK;
  case STEIF_BAD_INPUT:
  case STEIF_UNKNOWN_NAME: return EXIT_USAGE;
  case STEIF_IO: return EXIT_FILE;
  case STEIF_SINGULAR: return EXIT_SINGULAR;
  case STEIF_NOT_CERTIFIED: return EXIT_UNCERTIFIED;
  case STEIF_STOPPED: return EXIT_INTERRUPTED;
  default: return EXIT_FAILED;
  }
}

/* ---- words ---- */

static void sentence(const struct call *call, const char *format, va_list arguments)
{
  progress(call, NULL);
  fflush(stdout);
  fprintf(stderr, call->verb ? "steif %s: " : "steif: ", call->verb ? call->verb->name : "");
  vfprintf(stderr, format, arguments);
  putc('\n', stderr);
}

void say(const struct call *call, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  sentence(call, format, arguments);
  va_end(arguments);
}

int refuse(const struct call *call, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  sentence(call, format, arguments);
  va_end(arguments);
  return EXIT_USAGE;
}

int fail(const struct call *call)
{
  const int code = steif_status(call->ctx);
  say(call, "%s", steif_message(call->ctx));
  steif_report *r = call->json ? steif_report_new(call->ctx) : NULL;
  if (r) {
    steif_report_text(r, "status", steif_code_name(code));
    steif_report_text(r, "message", steif_message(call->ctx));
    steif_report_write(r, STEIF_JSON, stdout);
    steif_report_free(&r);
  }
  return code == STEIF_OK ? EXIT_FAILED : exit_of(code);
}

void progress(const struct call *call, const char *format, ...)
{
  static bool shown = false;
  if (call->quiet || !isatty(STDERR_FILENO) || (!format && !shown)) return;
  fputs("\r\033[K", stderr);
  shown = format != NULL;
  if (format) {
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
  }
  fflush(stderr);
}

/* Edit distance of words up to 63 letters. */
static int distance(const char *a, const char *b)
{
  enum { MOST = 64 };
  int row[MOST + 1], m = (int)strlen(b);
  if (m > MOST) return MOST * 2;
  for (int j = 0; j <= m; j++) row[j] = j;
  for (int i = 1; a[i - 1]; i++) {
    int corner = row[0];
    row[0] = i;
    for (int j = 1; j <= m; j++) {
      const int change = corner + (a[i - 1] != b[j - 1]);
      const int shift = 1 + (row[j] < row[j - 1] ? row[j] : row[j - 1]);
      corner = row[j];
      row[j] = change < shift ? change : shift;
    }
  }
  return row[m];
}

const char *nearest(const char *wrong, const char *(*name_at)(const void *list, size_t i),
                    const void *list)
{
  const char *best = NULL, *name;
  int least = 0;
  for (size_t i = 0; (name = name_at(list, i)); i++) {
    const int d = distance(wrong, name);
    if (!best || d < least) best = name, least = d;
  }
  return best;
}

/* ---- output ---- */

int show(const struct call *call, steif_report *report)
{
  progress(call, NULL);
  if (steif_report_write(report, call->json ? STEIF_JSON : STEIF_TABLE, stdout) == STEIF_OK)
    return EXIT_OK;
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

int present(const struct call *call, steif_report *report)
{
  const int shown = show(call, report), saved = save_csv(call, report);
  return shown ? shown : saved;
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
  const char *const path[] = {call->csv, call->plot, call->npz};
  for (int i = 0; i < 3; i++)
    if (path[i] && !writable(path[i])) {
      say(call,
          "cannot write \"%s\": %s; name a file in a folder that exists and may be written",
          path[i], strerror(errno));
      return EXIT_FAILED;
    }
  const size_t length = call->plot ? strlen(call->plot) : 0;
  const char *ending = length > 4 ? call->plot + length - 4 : "";
  if (call->plot && strcmp(ending, ".svg") && strcmp(ending, ".png"))
    return refuse(call, "--plot is \"%s\" and must end in .svg or .png", call->plot);
  return EXIT_OK;
}
