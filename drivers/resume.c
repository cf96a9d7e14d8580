/* resume.c: a run that was saved goes on, or shows its result where it is finished.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "saved_run.h"
#include "verbs.h"
#include <stdlib.h>

/* As if the program had been called as then, but for the options of this call. */
static int solve(struct call *call, int argc, char **argv)
{
  struct call again = {
    .verb = verb_find("solve"), .ctx = call->ctx, .continues = call->word[0]};
  int code = call_parse(&again, argc, argv);
  if (code == EXIT_OK) code = check_outputs(&again);
  return code == EXIT_OK ? again.verb->run(&again) : code;
}

static int run(struct call *call)
{
  int argc;
  steif_checkpoint *c = steif_checkpoint_read(call->ctx, call->word[0]);
  if (!c) return fail_file(call);
  char **argv = saved_run_arguments(call, c->note, c->note_bytes, &argc);
  steif_checkpoint_free(call->ctx, &c);
  if (!argv) {
    say(call,
        "\"%s\" was not saved by 'steif solve': load it with steif_checkpoint_load "
        "[STEIF_IO]",
        call->word[0]);
    return EXIT_FILE;
  }
  const int code = solve(call, argc, argv);
  free(argv);
  return code;
}

static const struct option options[] = {
  {"--t1", POSITIVE, "T", "another end of the integration", NULL},
  {"--every", POSITIVE, "S", "seconds of wall-clock time between two checkpoints", NULL},
  {"--max-steps", COUNT, "N", "give up after N steps, those before among them", NULL},
  {"--max-seconds", POSITIVE, "S", "give up after S seconds of wall-clock time", NULL},
  {"--npz", OUTPUT, "FILE", "t, y and events as arrays for numpy.load", NULL},
  {"--h5", OUTPUT, "FILE", "the same as an HDF5 file, where libhdf5 is installed", NULL},
  OPTIONS_END,
};

const struct verb verb_resume = {
  .name = "resume",
  .about = "Go on with a run of solve that was saved by --checkpoint",
  .usage = "FILE [--json --csv FILE ...]",
  .least = 1,
  .most = 1,
  .picture = true,
  .option = options,
  .run = run,
};
