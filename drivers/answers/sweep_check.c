/* sweep_check.c: do rows that are kept belong to this sweep? Its words and options, and the program, decide on every
 * digit: the first and the last member that went well are run again and come out with the same ones.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sweep_old.h"
#include "interruption.h"
#include <string.h>

/* Of what runs against a clock or for memory nothing can be told; better are members that went well. */
static int worth(const struct kept *m)
{
  const bool chance = m->code == STEIF_TIME_LIMIT || m->code == STEIF_NO_MEMORY;
  return chance ? 0 : m->code < 0 ? 1 : m->code ? 2 : 3;
}

static void choose(struct old_rows *o)
{
  int best = 0;
  for (long long k = 0; k < o->count; k++)
    if (worth(&o->member[k]) > best) best = worth(&o->member[k]);
  for (long long k = 0; k < o->count && best; k++) {
    if (worth(&o->member[k]) != best) continue;
    o->checked[o->checks > 0] = k;
    if (o->checks < 2) o->checks++;
  }
}

long long old_checked(const struct sweep *s, long long k)
{
  return s->old->member[s->old->checked[k]].number;
}

int old_compare(struct sweep *s, long long k, const struct member_record *r)
{
  const struct old_rows *o = s->old;
  const struct kept *m = &o->member[o->checked[k]];
  for (size_t row = 0; row < r->rows || row < m->lines; row++) {
    const bool both = row < r->rows && row < m->lines;
    if (row < r->rows && sweep_line(s, m->number, r, row) >= s->room) return 1;
    if (both && !strcmp(s->line, o->line[m->first + row])) continue;
    say(s->call,
        "\"%s\": member %lld comes out as \"%.300s\" here, and stands there as \"%.300s\": its "
        "rows are of other options, another problem, version or machine; --resume goes with "
        "the words "
        "and options of the sweep that wrote the file [STEIF_BAD_INPUT]",
        m->path, m->number, row < r->rows ? s->line : "",
        row < m->lines ? o->line[m->first + row] : "");
    return 1;
  }
  return 0;
}

int old_check(struct sweep *s)
{
  choose(s->old);
  if (!s->old->checks) return EXIT_OK;
  s->checking = true;
  const int code = sweep_members(s, s->old->checks);
  s->checking = false;
  if (code == STEIF_CALLBACK) return EXIT_FILE;
  if (code == STEIF_STOPPED) {
    say(s->call, "interrupted; no member was run, and the file is as it was [STEIF_STOPPED]");
    return interruption_exit();
  }
  return code ? fail(s->call) : EXIT_OK;
}
