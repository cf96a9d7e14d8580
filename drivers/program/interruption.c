/* interruption.c: SIGINT, SIGTERM: a flag for who polls, else the end with a sentence; SIGPIPE, which a reader
 * that has gone sends, where no verb runs: the sentence.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "interruption.h"
#include <signal.h>
#include <stddef.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { LONGEST = 30 };

static volatile int stop_flag;
static volatile sig_atomic_t polled, number_of;
static const char *verb_name;
static struct timespec asked; /* when the first signal came */

static double seconds_since(const struct timespec *then)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)(now.tv_sec - then->tv_sec) + 1e-9 * (double)(now.tv_nsec - then->tv_nsec);
}

static void put(const char *text)
{
  const ssize_t written = write(STDERR_FILENO, text, strlen(text));
  (void)written; /* there is nobody left to tell */
}

/* Only what a signal handler may call. */
static void end(int number)
{
  put(number == SIGPIPE ? "steif" : "\nsteif");
  if (verb_name) put(" "), put(verb_name);
  put(number == SIGPIPE ? ": nobody reads the output any more [STEIF_IO]\n"
                        : ": interrupted; what is not shown yet is not kept [STEIF_STOPPED]\n");
  _exit(128 + number);
}

/* Half a second belongs to the first signal: timeout(1) and other parents send it to the child and to
 * its group. A step that takes longer than LONGEST seconds is not waited for. */
static void on_signal(int number)
{
  if (number == SIGALRM) end(number_of);
  if (!polled || (stop_flag && seconds_since(&asked) > 0.5)) end(number);
  if (stop_flag) return;
  clock_gettime(CLOCK_MONOTONIC, &asked);
  number_of = number;
  stop_flag = 1;
  alarm(LONGEST);
}

/* Verbs end by SIGPIPE without a word, as filters before head(1) do. */
void interruption_open(const char *verb)
{
  static const int numbers[] = {SIGINT, SIGTERM, SIGALRM, SIGPIPE};
  const struct sigaction usual = {.sa_handler = SIG_DFL};
  const struct sigaction ours = {.sa_handler = on_signal};
  struct sigaction before;
  verb_name = verb;
  for (int i = 0; i < 4; i++) {
    sigaction(numbers[i], NULL, &before);
    if (before.sa_handler == SIG_IGN) continue;
    sigaction(numbers[i], verb && numbers[i] == SIGPIPE ? &usual : &ours, NULL);
  }
}

volatile int *interruption_poll(void)
{
  polled = 1;
  return &stop_flag;
}

bool interrupted(void) { return stop_flag; }

int interruption_exit(void) { return 128 + (number_of ? number_of : SIGINT); }
