/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The room of programs from within: a program that was started and has ended is
   not ended again, the line of progress waits for its time, and what is said of
   a status. Signals: test_litter.sh; the line itself: test_progress.sh. */
#define _POSIX_C_SOURCE 200809L /* fork */
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include <gsl/gsl_errno.h>
#include "check.h"
#include "program/litter.h"
#include "program/messages.h"
#include "program/progress.h"

/* --- litter ----------------------------------------------------------------*/

/* In place of the system's: notes whom it was to end, and does not. */
static pid_t ended;
int kill(pid_t process, int number) {
  (void)number;
  ended = process;
  return 0;
}

static pid_t helper;
static void tell_ended(void) { /* after litter's, which was added later */
  _exit(ended == 0 ? 0 : ended == helper ? 1 : 2);
}

/* A process with a helper that has ended, and ends itself: it ends the helper
   only as long as it does not know. */
static void test_forked(void) {
  for (int knows = 0; knows < 2; knows++) {
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
      atexit(tell_ended);
      litter_watch();
      helper = litter_fork();
      if (helper == 0)
        _exit(0);
      waitpid(helper, NULL, 0);
      if (knows)
        litter_forked();
      exit(3);
    }
    int status = 0;
    CHECK(child > 0 && waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == !knows);
  }
}

/* --- progress --------------------------------------------------------------*/

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Not before half a second has passed, and then. */
static void test_due(void) {
  const double start = now();
  const struct progress p = progress_begin(true);
  const double began = now();
  bool due = progress_due(&p);
  CHECK(!due || now() >= start + 0.5);
  while (!due) {
    const double before = now();
    due = progress_due(&p);
    CHECK(due || before < began + 0.5);
    CHECK(!due || now() >= start + 0.5);
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
  }
}

/* --- messages --------------------------------------------------------------*/

/* What a program says that ends by a status of the library, and its own. */
static void test_status(int status, int want, const char *words) {
  int ends[2];
  char said[200] = "";
  if (pipe(ends) != 0)
    abort();
  fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);
    die_status(status, "the %s", "bed");
  }
  close(ends[1]);
  FILE *in = fdopen(ends[0], "r");
  CHECK(in && fgets(said, sizeof said, in) && strstr(said, words));
  CHECK(in && fgetc(in) == EOF);
  fclose(in);
  int got = 0;
  CHECK(waitpid(child, &got, 0) == child);
  CHECK(WIFEXITED(got) && WEXITSTATUS(got) == want);
}

int main(void) {
  gsl_set_error_handler_off();
  test_forked();
  test_due();
  test_status(GSL_ENOMEM, EXIT_IO, ": out of memory\n");
  test_status(GSL_EINVAL, EXIT_USAGE, ": the bed: ");
  test_status(GSL_EFAILED, EXIT_IO, ": the bed: ");
  return check_done();
}
