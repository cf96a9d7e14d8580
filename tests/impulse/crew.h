/* crew.h: a team of threads with sockets between them.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CREW_H
#define CREW_H

#include "base/failing.h"
#include "suite.h"
#include <pthread.h>
#include <steif/team.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#ifndef MSG_NOSIGNAL
#define MSG_NOSIGNAL 0
#endif

enum { MOST = 5 };

typedef struct member {
  pthread_t thread;
  failing memory;
  int ours, theirs; /* the ends of the socket */
  int code, threads;
} member;

typedef struct crew {
  steif_team team;
  member of[MOST + 1];
  long pieces,
    cut_at; /* received by process 0; the connection fails from here on, 0: it does not */
} crew;

static inline int all_of(ssize_t (*move)(int, void *, size_t, int), int socket, char *at,
                         size_t bytes)
{
  while (bytes) {
    const ssize_t now = move(socket, at, bytes, MSG_NOSIGNAL);
    if (now <= 0) return 1;
    at += now, bytes -= (size_t)now;
  }
  return 0;
}

static inline ssize_t to_socket(int socket, void *at, size_t bytes, int flags)
{
  return send(socket, at, bytes, flags);
}

static inline int lead_send(int to, const void *data, size_t bytes, void *user)
{
  crew *c = user;
  return all_of(to_socket, c->of[to].ours, (char *)data, bytes);
}

static inline int lead_receive(int from, void *data, size_t bytes, void *user)
{
  crew *c = user;
  if (++c->pieces >= c->cut_at && c->cut_at) return 1;
  return all_of(recv, c->of[from].ours, data, bytes);
}

static inline int serve_send(int to, const void *data, size_t bytes, void *user)
{
  (void)to;
  return all_of(to_socket, ((member *)user)->theirs, (char *)data, bytes);
}

static inline int serve_receive(int from, void *data, size_t bytes, void *user)
{
  (void)from;
  return all_of(recv, ((member *)user)->theirs, data, bytes);
}

static inline void *serve(void *user)
{
  member *m = user;
  steif_setup setup = failing_setup(&m->memory);
  setup.threads = m->threads;
  steif_context *ctx = steif_context_new(&setup);
  const steif_team team = {.send = serve_send, .receive = serve_receive, .user = m};
  m->code = steif_team_serve(ctx, &team);
  steif_context_free(&ctx);
  return NULL;
}

/* The second of those that serve refuses its request number `refuse_at`. */
static inline void assemble(crew *c, steif_context *ctx, int others, int threads,
                            long refuse_at)
{
  memset(c, 0, sizeof *c);
  c->team = (steif_team){others, lead_send, lead_receive, c};
  for (int p = 1; p <= others; p++) {
    int pair[2];
    CU_ASSERT_FATAL(!socketpair(AF_UNIX, SOCK_STREAM, 0, pair));
    c->of[p].ours = pair[0], c->of[p].theirs = pair[1], c->of[p].threads = threads;
    if (p == (others > 1 ? 2 : 1)) c->of[p].memory.refuse_at = refuse_at;
    CU_ASSERT_FATAL(!pthread_create(&c->of[p].thread, NULL, serve, &c->of[p]));
  }
  CHECK(steif_team_lead(ctx, &c->team) == STEIF_OK);
}

static inline void part(crew *c, steif_context *ctx, int expected)
{
  steif_team_dismiss(ctx);
  for (int p = 1; p <= c->team.others; p++) {
    pthread_join(c->of[p].thread, NULL);
    CHECK(c->of[p].code == expected);
    CHECK(c->of[p].memory.alive == 0);
    close(c->of[p].ours), close(c->of[p].theirs);
  }
}

#endif
