/* demo_finish.c: the pictures of the demonstration and its last words.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "demo.h"

const char *demo_picture(demo *d, const char *name)
{
  snprintf(d->path[d->count], sizeof *d->path, "%s/%s", d->folder, name);
  d->pictures[d->count] = d->path[d->count];
  return d->pictures[d->count++];
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
