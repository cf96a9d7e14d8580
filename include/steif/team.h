/* steif/team.h: processes that share the analysis of large descriptor systems.
 *
 * Structure, jump and impulses of a sparse E x' + F x = f come from factors of s E + F at points of circles
 * (impulse.h), which do not depend on each other. One process, number 0, leads: it makes all calls, after
 * steif_team_lead. The others, numbers 1 to `others`, serve: they get E and F, factor at their share of the points,
 * four or more each, and send solutions back, which are added in the order of the points. So the answer is that of one
 * process, bit for bit where the processors are of one kind, and factors take a share of the memory in each. 16 points
 * occupy two processes; steif_analysis.points asks for more.
 *
 * How bytes get from one process to another is for the caller to say: steif/mpi.h makes a team of the ranks of MPI.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_TEAM_H
#define STEIF_TEAM_H

#include <steif/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* send and receive return 0 when all bytes have gone or come, else the connection counts as lost. Those that serve
 * are asked for process 0 alone. What is sent by one call is received by one, at most 65536
 * bytes, in the order of sending; bytes that are sent before they are received may wait or be kept. All processes
 * run the same build of steif. */
typedef struct steif_team {
  int others; /* 1 to 1023; read where it leads */
  int (*send)(int to, const void *data, size_t bytes, void *user);
  int (*receive)(int from, void *data, size_t bytes, void *user);
  void *user;
} steif_team;

/* Analyses made with this context are shared from now on; NULL: by nobody. The team is kept, not copied; what was
 * found with it is cleared (steif_structure_clear) before it goes. STEIF_BAD_INPUT: others, send or receive. */
STEIF_EXPORT int steif_team_lead(steif_context *ctx, const steif_team *team);

/* Serves until process 0 dismisses: STEIF_OK then. A failure, of memory say, is sent to process 0, whose call fails with
 * it, and serving goes on. STEIF_IO: the connection is lost. */
STEIF_EXPORT int steif_team_serve(steif_context *ctx, const steif_team *team);

/* Lets all that serve return, and leads nobody. */
STEIF_EXPORT int steif_team_dismiss(steif_context *ctx);

#ifdef __cplusplus
}
#endif
#endif
