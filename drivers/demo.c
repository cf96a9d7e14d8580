/* demo.c: what steif is for, in a minute and with pictures: the order of play.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "demo.h"
#include <errno.h>
#include <string.h>
#include <sys/stat.h>

static const struct {
  int (*play)(demo *d);
  const char *title;
} parts[] = {
  {demo_published,
   "Published stiff problems and DAEs: digits against the published solutions."},
  {demo_layers,
   "N x' + x = f, index 2 to 4, inconsistent start: steps until the smooth solution "
   "is followed."},
  {demo_weak,
   "The same with the impulses, h = 1/256: <x_h, g> against the exact distribution."},
  {demo_baseline, "IDA, rtol 1e-6, on the same systems, consistent and inconsistent start."},
};

/* As tables, every part is shown when it is done; as JSON, all are one object. */
static int play(demo *d, size_t i)
{
  const struct call *call = d->call;
  if (!call->json) d->report = steif_report_new(call->ctx);
  if (!d->report) return fail(call);
  int code = parts[i].play(d);
  if (call->json) return code;
  progress(call, NULL);
  printf("%s%s\n\n", i ? "\n" : "", parts[i].title);
  if (code == EXIT_OK) code = show(call, d->report);
  steif_report_free(&d->report);
  return code;
}

static int run(struct call *call)
{
  static demo d;
  d.call = call;
  d.folder = word_of(call, "--out", "steif-demo");
  if (call->csv || call->plot)
    return refuse(call, "demo names its files itself; --out names their folder");
  if (mkdir(d.folder, 0777) && errno != EEXIST) {
    say(call, "cannot make the folder \"%s\": %s; name another with --out", d.folder,
        strerror(errno));
    return EXIT_FAILED;
  }
  if (call->json) d.report = steif_report_new(call->ctx);
  int code = EXIT_OK;
  for (size_t i = 0; i < sizeof parts / sizeof *parts && code == EXIT_OK; i++)
    code = play(&d, i);
  if (code == EXIT_OK) return demo_finish(&d);
  steif_report_free(&d.report);
  return code;
}

static const struct option options[] = {
  {"--out", WORD, "DIR", "folder of the pictures (default steif-demo)"},
  {NULL, FLAG, NULL, NULL},
};

const struct verb verb_demo = {"demo",
                               "See what steif is for, in a minute and with pictures",
                               "[--out DIR]",
                               0,
                               0,
                               options,
                               NULL,
                               run};
