/* message.h: exit codes, and sentences on stderr.
 *
 * The sentence of a failure ends with the name of its code in brackets, as those of the library do.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef MESSAGE_H
#define MESSAGE_H

#include "command_line.h"

enum { EXIT_OK, EXIT_FAILED, EXIT_USAGE, EXIT_FILE, EXIT_SINGULAR, EXIT_UNCERTIFIED };

/* Of an enum steif_code. */
int exit_of(int code);
/* The same, EXIT_FILE where the message names the file of a tableau in the call. */
int exit_of_run(const struct call *call, int code, const char *message);

/* "steif solve: sentence" on stderr. */
void say(const struct call *call, const char *format, ...) STEIF_PRINTF(2, 3);
/* The same with STEIF_BAD_INPUT and STEIF_UNKNOWN_NAME; both return EXIT_USAGE. */
int bad_usage(const struct call *call, const char *format, ...) STEIF_PRINTF(2, 3);
/* A failure with this code of the library and its symbol, as JSON too; its exit code. */
int refuse(const struct call *call, int code, const char *symbol, const char *format, ...)
  STEIF_PRINTF(4, 5);
int unknown_name(const struct call *call, const char *format, ...) STEIF_PRINTF(2, 3);
/* "no memory for `what`; `remedy`" with STEIF_NO_MEMORY; EXIT_FAILED. */
int no_memory(const struct call *call, const char *what, const char *remedy);
/* Say the context's message (as a JSON object too, when asked for); its exit code. */
int fail(const struct call *call);
/* The same where a file of the user's is to blame: EXIT_FILE. */
int fail_file(const struct call *call);

/* A sentence of the library, whose remedies are functions and members, as one of options and verbs; in place. */
void speak(char *text, size_t room);

/* "; did you mean NAME?", of the name_at(list, i), NULL past the end, that is nearest to `wrong`; ";" where none is
 * near: a third of the letters may be wrong. */
enum { GUESS = 96 };
const char *guess(const char *wrong, const char *(*name_at)(const void *list, size_t i),
                  const void *list, char text[GUESS]);

/* A line on a terminal that the next one replaces; NULL wipes it. */
void progress(const struct call *call, const char *format, ...) STEIF_PRINTF(2, 3);

#endif
