/* folder.h: a new folder for the files of a test, below TMPDIR, or /tmp where that is not set.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef FOLDER_H
#define FOLDER_H

#include <stdio.h>
#include <stdlib.h>

static inline const char *folder_above(void)
{
  const char *above = getenv("TMPDIR");
  return above && *above ? above : "/tmp";
}

/* Make it and write its path into `path`; NULL when that fails. */
static inline char *folder_make(char *path, size_t room)
{
  const int length = snprintf(path, room, "%s/steif-XXXXXX", folder_above());
  return length < (int)room ? mkdtemp(path) : NULL;
}

#endif
