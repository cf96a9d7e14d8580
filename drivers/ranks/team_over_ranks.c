/* team_over_ranks.c: `steif impulse ... --parallel` and `pencil`: rank 0 does what steif does, the others factor and
 * solve around its circles.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "over_ranks.h"
#include "command_line.h"
#include "interruption.h"
#include "message.h"
#include "verbs.h"
#include <signal.h>
#include <string.h>

extern const struct verb verb_impulse, verb_pencil;

bool team_verb(const char *name) { return !strcmp(name, "impulse") || !strcmp(name, "pencil"); }

static int lead(struct call *call, int argc, char **argv)
{
  int code = call_parse(call, argc - 2, argv + 2);
  if (!code && call->help) call_help(call->verb);
  if (code || call->help) return code;
  interruption_open(call->verb->name);
  return call->verb->run(call);
}

/* Rank 0 says when it is over, a signal or not. */
static int serve(steif_context *ctx, const steif_team *team)
{
  signal(SIGINT, SIG_IGN), signal(SIGTERM, SIG_IGN);
  return steif_team_serve(ctx, team) ? FAILED : FINE;
}

int team_over_ranks(const request *r, int argc, char **argv)
{
  struct call call = {.verb = strcmp(argv[1], "pencil") ? &verb_impulse : &verb_pencil,
                      .json = call_wants_json(argc - 2, argv + 2)};
  int code = FAILED;
  call.ctx = steif_context_new(NULL);
  steif_team *team =
    call.ctx && r->ranks > 1 ? steif_mpi_team_new(call.ctx, MPI_COMM_WORLD) : NULL;
  const bool made = call.ctx && (team || r->ranks == 1);
  if (team && !r->rank) steif_team_lead(call.ctx, team);
  if (made) code = r->rank ? serve(call.ctx, team) : lead(&call, argc, argv);
  if (team && !r->rank) steif_team_dismiss(call.ctx);
  if (!made && !r->rank) say(&call, "%s", call.ctx ? steif_message(call.ctx) : "no memory");
  steif_mpi_team_free(&team);
  steif_context_free(&call.ctx);
  MPI_Bcast(&code, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return code;
}
