/* demo.c: what steif is for, in a minute and with pictures: the order of the parts.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "demo.h"
#include <stdio.h>

static const struct {
  int (*show)(demo *d);
  const char *title;
} parts[] = {
  {demo_published,
   "Published stiff problems and DAEs: digits against the published solutions."},
  {demo_layers,
   "N x' + x = f, index 2 to 4, inconsistent start: steps until the smooth solution "
   "is followed."},
  {demo_weak,
   "The same with the impulses, h = 1/256: <x_h, g> against the exact distribution."},
  {demo_baseline,
   "IDA at its best, rtol 1e-6: of six settings the one with the smallest errors at 0+ and at "
   "the\n"
   "end. Here it runs from consistent starts up to index 4, with fewer digits than asked from "
   "index\n"
   "3 on; from others its success can hide a wrong jump, and no setting gives impulses."},
};

/* As tables, every part is shown when it is done; as JSON, all are one object. */
static int show_part(demo *d, size_t i)
{
  const struct call *call = d->call;
  if (!call->json) d->report = steif_report_new(call->ctx);
  if (!d->report) return fail(call);
  int code = parts[i].show(d);
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
  int code = demo_open(&d, call);
  if (call->json && !code) d.report = steif_report_new(call->ctx);
  for (size_t i = 0; i < sizeof parts / sizeof *parts && !code && !interrupted(); i++)
    code = show_part(&d, i);
  if (!code && !interrupted()) return demo_finish(&d);
  steif_report_free(&d.report);
  if (!interrupted()) return code;
  say(call, "interrupted: the parts that were left are not shown [STEIF_STOPPED]");
  return interruption_exit();
}

static const struct option options[] = {
  {"--out", WORD, "DIR", "folder of the pictures", "steif-demo"},
  OPTIONS_END,
};

const struct verb verb_demo = {.name = "demo",
                               .about = "See what steif is for, in a minute and with pictures",
                               .usage = "[--out DIR]",
                               .picture = true,
                               .option = options,
                               .run = run};
