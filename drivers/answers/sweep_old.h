/* sweep_old.h: rows of earlier runs, member by member.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SWEEP_OLD_H
#define SWEEP_OLD_H

#include "sweep.h"

struct kept {
  long long number; /* of a member that is whole */
  size_t first, lines;
  int code;
  const char *path;
};
struct old_rows {
  char path[OLD_FILES][PATH_ROOM], *text[OLD_FILES];
  char **line;
  size_t lines;
  struct kept *member; /* in the order of their numbers */
  long long count, next;
  struct member_record *record; /* one of them, read */
  bool scattered;
  long long checked[2]; /* places of members that are compared */
  int checks;
};

#endif
