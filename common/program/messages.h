/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Messages of programs on standard error, and their exit. */
#ifndef MESSAGES_H
#define MESSAGES_H

enum exit_code {
  EXIT_DONE = 0,
  EXIT_IO = 1,
  EXIT_USAGE = 2,
  EXIT_INPUT = 3,
  EXIT_INTEGRATION = 4,
  EXIT_LIMIT = 5
};

/* The program's name, and the verb of several that runs or NULL; both texts
   must live on. */
void message_name(const char *program, const char *verb);
const char *program_name(void);
const char *program_verb(void);

/* Prints "PROGRAM: MESSAGE" on one line of standard error, after the rows that
   standard output has so far, and exits; after a
   mistake in the use (EXIT_USAGE) the line ends with where the help is. */
_Noreturn void die(enum exit_code code, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Leaves after a library's error, a GSL code: what was asked for cannot be had
   (GSL_EINVAL, EXIT_USAGE), "out of memory" or another reason (EXIT_IO). What
   format says comes before the reason. */
_Noreturn void die_status(int status, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* A number of bytes as people say it: 3.6 GB. */
enum { SAY_BYTES_SIZE = 32 };
void say_bytes(double bytes, char text[SAY_BYTES_SIZE]);

/* The same as die without leaving. */
void warn(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A line on a terminal's standard error that is no message: the next one, or a
   message, takes its place. program/progress.h says when. */
void status_line(const char *format, ...) __attribute__((format(printf, 1, 2)));
void status_clear(void);

/* Flushes standard output; exits with EXIT_IO if anything was not written,
   without a word if nobody reads it any more. */
void finish_output(void);

#endif
