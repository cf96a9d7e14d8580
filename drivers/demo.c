/* demo.c: what steif is for, in a minute and with pictures: the order of play.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "demo.h"
#include <errno.h>
#include <string.h>
#include <sys/stat.h>

static const struct {
  const char *title;
  int (*play)(demo *d);
} parts[] = {
  {"Published stiff problems and DAEs: digits against the published solutions "
   "(mescd counts components\nbelow atol/rtol as nothing)",
   demo_published},
  {"Index 2 to 4, N x' + x = f from inconsistent values: how many steps until the smooth "
   "solution is\nfollowed",
   demo_layers},
  {"The same systems, impulses included: the computed sequence paired with a test function, "
   "against the\nexact distribution",
   demo_weak},
  {"IDA on the same systems, rtol 1e-6, from consistent and from inconsistent values",
   demo_baseline},
};

const char *demo_picture(demo *d, const char *name)
{
  snprintf(d->path[d->count], sizeof *d->path, "%s/%s", d->folder, name);
  d->pictures[d->count] = d->path[d->count];
  return d->pictures[d->count++];
}

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

static int finish(demo *d)
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
  if (code == EXIT_OK) return finish(&d);
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
