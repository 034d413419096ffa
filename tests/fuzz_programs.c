/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random command lines and random checkpoints for whole programs, each in a
   process of its own: it is to end by itself with an exit status that the
   README lists, whatever it is given. What does not, is printed so that a shell
   can run it again. For "make fuzz", with programs that the sanitizers watch;
   run in an empty folder, where options may put files.

     fuzz_programs options PROGRAM BED SECONDS SEED [VERB]
     fuzz_programs checkpoint SETTLE CHECKPOINT SECONDS SEED

   Not in the paper. */
#define _POSIX_C_SOURCE 200809L
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum {
  MOST_WORDS = 32,
  MOST_OPTIONS = 128,
  TOO_LONG = 5 /* CPU seconds: work that was asked for, no finding */
};

static uint64_t state;

static size_t below(size_t n) { /* xorshift64*, by Vigna */
  state ^= state >> 12;
  state ^= state << 25;
  state ^= state >> 27;
  return (size_t)((state * 2685821657736338717u) >> 33) % n;
}

static size_t executions, findings, statuses[6], slow;

/* In the child, before the program. */
static void prepare(const char *input) {
  const struct rlimit time = {TOO_LONG, TOO_LONG + 1};
  const struct rlimit size = {1 << 24, 1 << 24}; /* of files */
  setrlimit(RLIMIT_CPU, &time);
  setrlimit(RLIMIT_FSIZE, &size);
  const int in = open(input, O_RDONLY), out = open("/dev/null", O_WRONLY);
  dup2(in, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(open("said", O_WRONLY | O_CREAT | O_TRUNC, 0666), STDERR_FILENO);
}

static void print_words(char *const words[]) {
  for (size_t k = 0; words[k]; k++) {
    printf("%s'", k ? " " : "");
    for (const char *c = words[k]; *c; c++)
      printf(*c == '\'' ? "'\\''" : "%c", *c);
    putchar('\'');
  }
  putchar('\n');
}

/* The exit status; what is none of a program's own is a finding. */
static int run(char *const words[], const char *input) {
  int status;
  fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    prepare(input);
    execv(words[0], words);
    _exit(127);
  }
  if (child < 0 || waitpid(child, &status, 0) < 0)
    abort();
  executions++;
  const bool late = (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU ||
                                             WTERMSIG(status) == SIGKILL));
  if (late) {
    slow++;
  } else if (WIFEXITED(status) && WEXITSTATUS(status) < 6) {
    statuses[WEXITSTATUS(status)]++;
    return WEXITSTATUS(status);
  } else {
    findings++;
    printf("finding, status %d: ", status);
    print_words(words);
  }
  return -1;
}

static bool goes_on(const char *seconds) {
  static time_t begun;
  if (!begun)
    begun = time(NULL);
  return difftime(time(NULL), begun) < strtod(seconds, NULL);
}

/* --- options ---------------------------------------------------------------*/

static char option[MOST_OPTIONS][64];
static size_t options;

static void find_options(const char *program, const char *verb) {
  char command[512], line[512];
  snprintf(command, sizeof command, "'%s' %s --complete", program,
           verb ? verb : "");
  FILE *in = popen(command, "r");
  while (in && fgets(line, sizeof line, in) && options < MOST_OPTIONS) {
    line[strcspn(line, "\t\n")] = 0;
    if (!strncmp(line, "--", 2))
      snprintf(option[options++], sizeof *option, "%.63s", line);
  }
  if (!in || pclose(in) != 0 || !options)
    abort();
}

static void any_value(char *text, size_t size) {
  static const char *const pool[] = {"0",
                                     "1",
                                     "-1",
                                     "0.1",
                                     "3",
                                     "1e308",
                                     "-1e308",
                                     "1e-320",
                                     "nan",
                                     "inf",
                                     "",
                                     " ",
                                     "x",
                                     "1,1",
                                     "0.3,0.3",
                                     "1,1,1",
                                     "0,0,1,0,0,1",
                                     "0,1,0,1,0,1",
                                     "0,1,0,1",
                                     "0,,1",
                                     "0.5,0.5,0,0,0,1,0.5",
                                     "basic",
                                     "friction",
                                     "rotation",
                                     "merson",
                                     "rkc",
                                     "multirate",
                                     "verlet",
                                     "msbdf",
                                     "paper",
                                     "standard",
                                     "random",
                                     "rain",
                                     "all",
                                     "touching",
                                     "fraction=0.5",
                                     "stl",
                                     "raw",
                                     "uniform:0.05,0.1",
                                     "xy",
                                     "mix:0.1*1,0.05*2",
                                     "normal:0.1,0.5",
                                     "%s%n",
                                     "%04d.x",
                                     "99999999999999999999",
                                     "1e4",
                                     "0x10",
                                     "0.1*",
                                     "-",
                                     "bed",
                                     "out"};
  if (below(8)) {
    snprintf(text, size, "%s", pool[below(sizeof pool / sizeof *pool)]);
    return;
  }
  const size_t length = below(12);
  for (size_t k = 0; k < length; k++)
    text[k] = (char)(1 + below(255));
  for (size_t k = 0; k < length; k++)
    if (text[k] == '/') /* stays in this folder */
      text[k] = '.';
  text[length] = 0;
}

static void fuzz_options(char *program, char *bed, const char *seconds,
                         char *verb) {
  char text[MOST_WORDS][128];
  find_options(program, verb);
  while (goes_on(seconds)) {
    char *words[MOST_WORDS + 3] = {program};
    size_t count = 1;
    if (verb) {
      words[count++] = verb;
    } else { /* little to do, unless an option says otherwise */
      words[count++] = "--count=3";
      words[count++] = "--time=0.01";
    }
    const size_t most = 1 + below(6);
    for (size_t k = 0; k < most; k++) {
      snprintf(text[2 * k], sizeof *text, "%s", option[below(options)]);
      words[count++] = text[2 * k];
      any_value(text[2 * k + 1], sizeof *text);
      if (below(8))
        words[count++] = text[2 * k + 1];
    }
    words[count] = NULL;
    run(words, bed);
  }
}

/* --- checkpoints -----------------------------------------------------------*/

enum { MOST_BYTES = 1 << 22 };
static unsigned char whole[MOST_BYTES], bytes[MOST_BYTES];

static size_t change(size_t size) {
  memcpy(bytes, whole, size);
  const size_t most = 1 + below(4);
  for (size_t k = 0; k < most && size > 8; k++) {
    const size_t at = below(4) ? below(size) : below(size < 4096 ? size : 4096);
    const size_t other = below(size), length = 1 + below(16);
    switch (below(5)) {
    case 0:
      bytes[at] ^= (unsigned char)(1 << below(8));
      break;
    case 1:
      bytes[at] = (unsigned char)below(256);
      break;
    case 2: /* a large or a small number */
      if (at + 8 <= size)
        memset(bytes + at, below(2) ? 255 : 0, 8);
      break;
    case 3:
      size = at;
      break;
    default:
      if (at + length <= size && other + length <= size)
        memmove(bytes + at, bytes + other, length);
    }
  }
  return size;
}

/* All of them are refused: bad input. */
static void fuzz_checkpoint(char *settle, const char *path,
                            const char *seconds) {
  FILE *in = fopen(path, "rb");
  const size_t size = in ? fread(whole, 1, sizeof whole, in) : 0;
  char name[] = "damaged";
  char *const words[] = {settle, "--quiet", "--resume", name, NULL};
  if (!in || size < 100 || size == sizeof whole)
    abort();
  fclose(in);
  while (goes_on(seconds)) {
    const size_t length = change(size);
    if (length == size && !memcmp(bytes, whole, size))
      continue;
    FILE *out = fopen(name, "wb");
    if (!out || fwrite(bytes, 1, length, out) != length || fclose(out) != 0)
      abort();
    const int status = run(words, "/dev/null");
    if (status != 3) {
      char keep[32];
      snprintf(keep, sizeof keep, "finding-%zu", executions);
      printf("finding: %s has exit status %d\n", keep, status);
      findings += status >= 0;
      rename(name, keep);
    }
  }
}

int main(int argc, char **argv) {
  if (argc < 6)
    return 2;
  state = strtoull(argv[5], NULL, 10) * 2 + 1;
  setenv("ASAN_OPTIONS",
         "exitcode=99:detect_leaks=0:allocator_may_return_null=1", 1);
  setenv("UBSAN_OPTIONS", "exitcode=99", 1);
  if (!strcmp(argv[1], "options"))
    fuzz_options(argv[2], argv[3], argv[4], argv[6]);
  else
    fuzz_checkpoint(argv[2], argv[3], argv[4]);
  printf("%s %s: %zu executions, %zu findings, %zu beyond %d s; exit status",
         argv[6] ? argv[6] : "settle", argv[1], executions, findings, slow,
         TOO_LONG);
  for (int k = 0; k < 6; k++)
    printf(" %d: %zu%s", k, statuses[k], k < 5 ? "," : "\n");
  return findings > 0;
}
