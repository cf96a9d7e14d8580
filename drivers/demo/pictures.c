/* pictures.c: the folder of the pictures of the demonstration, their names, the end.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "demo.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

int demo_open(demo *d, struct call *call)
{
  d->call = call;
  d->folder = word_of(call, "--out");
  if (call->csv || call->plot)
    return bad_usage(call, "demo names its files itself; --out names their folder");
  if (!mkdir(d->folder, 0777) || errno == EEXIST) return EXIT_OK;
  say(call, "cannot make the folder \"%s\": %s; name another with --out [STEIF_IO]", d->folder,
      strerror(errno));
  return EXIT_FAILED;
}

const char *demo_picture(demo *d, const char *name)
{
  snprintf(d->path[d->count], sizeof *d->path, "%s/%s", d->folder, name);
  d->pictures[d->count] = d->path[d->count];
  d->count++;
  return d->pictures[d->count - 1];
}

int demo_finish(demo *d)
{
  if (!d->call->json) {
    printf("\nPictures:");
    for (size_t i = 0; i < d->count; i++) printf(" %s", d->pictures[i]);
    return putchar('\n') == EOF ? EXIT_FAILED : EXIT_OK;
  }
  steif_report_texts(d->report, "pictures", d->count, d->pictures);
  const int code = show(d->call, d->report);
  steif_report_free(&d->report);
  return code;
}
