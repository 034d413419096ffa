/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Calls that fail, for tests/torture.sh, which has a program load this before
   the C library: FAULT=CALL:N lets the N-th call of that name fail, as on a
   full or broken disk or without memory, and FAULT_DONE names a file that is
   made then. Beside names of functions, CALL is "write", for the N-th write to
   a file, "full", for that one and all that come, or "short", for one of which
   only half gets to the disk; or "made", for a signal that ends the process as
   soon as the N-th file or folder is there; or "killed", for KILL as soon as
   the N-th of all these calls but those for memory is done, or "asked", for
   TERM. With FAULT_NO_LINKS
   there are no hard links. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#if defined __linux__ && defined __x86_64__
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <ucontext.h>
#endif

static bool fails(const char *call) {
  static long left = -1;
  const char *fault = getenv("FAULT"), *hit = getenv("FAULT_DONE");
  const size_t length = strlen(call);
  if (!fault || strncmp(fault, call, length) || fault[length] != ':')
    return false;
  if (left < 0)
    left = atol(fault + length + 1);
  if (left == 0 || __atomic_sub_fetch(&left, 1, __ATOMIC_SEQ_CST) != 0)
    return false;
  if (hit)
    close(creat(hit, 0666));
  return true;
}

/* What a call gives that was done. */
static int done(int result) {
  if (fails("killed"))
    raise(SIGKILL);
  if (fails("asked"))
    raise(SIGTERM);
  return result;
}

#define REAL(type, name, ...)                                                  \
  static type (*real)(__VA_ARGS__);                                            \
  if (!real)                                                                   \
  *(void **)&real = dlsym(RTLD_NEXT, name)

int fsync(int fd) {
  REAL(int, "fsync", int);
  if (!fails("fsync"))
    return done(real(fd));
  errno = EIO;
  return -1;
}

int kill(pid_t process, int number) { /* which is then not done */
  REAL(int, "kill", pid_t, int);
  return fails("kill") ? 0 : real(process, number);
}

int rename(const char *from, const char *to) {
  REAL(int, "rename", const char *, const char *);
  if (!fails("rename"))
    return done(real(from, to));
  errno = EIO;
  return -1;
}

int link(const char *from, const char *to) {
  REAL(int, "link", const char *, const char *);
  if (!getenv("FAULT_NO_LINKS") && !fails("link"))
    return done(real(from, to));
  errno = EPERM; /* as where there are no hard links */
  return -1;
}

int unlink(const char *path) {
  REAL(int, "unlink", const char *);
  if (!fails("unlink"))
    return done(real(path));
  errno = EIO;
  return -1;
}

int fclose(FILE *stream) {
  REAL(int, "fclose", FILE *);
  const int status = real(stream);
  if (!fails("close"))
    return done(status);
  errno = EIO;
  return EOF;
}

int open(const char *path, int flags, ...) {
  REAL(int, "open", const char *, int, ...);
  va_list more;
  va_start(more, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(more, mode_t) : 0;
  va_end(more);
  const int fd = real(path, flags, mode);
  if (fd >= 0 && flags & O_CREAT && fails("made"))
    raise(SIGQUIT);
  return flags & O_CREAT ? done(fd) : fd;
}

int mkdir(const char *path, mode_t mode) {
  REAL(int, "mkdir", const char *, mode_t);
  const int status = real(path, mode);
  if (status == 0 && fails("made"))
    raise(SIGQUIT);
  return status;
}

char *mkdtemp(char *path) {
  REAL(char *, "mkdtemp", char *);
  char *made = real(path);
  if (made && fails("made"))
    raise(SIGQUIT);
  return made;
}

extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *old, size_t size);

void *malloc(size_t size) {
  if (!fails("malloc"))
    return __libc_malloc(size);
  errno = ENOMEM;
  return NULL;
}

void *calloc(size_t count, size_t size) {
  if (!fails("malloc"))
    return __libc_calloc(count, size);
  errno = ENOMEM;
  return NULL;
}

void *realloc(void *old, size_t size) {
  if (!fails("malloc"))
    return __libc_realloc(old, size);
  errno = ENOMEM;
  return NULL;
}

#if defined __linux__ && defined __x86_64__
/* The C library writes by a call of its own, which cannot be replaced: the
   kernel is told to hand each write back as a signal, and it is done here by
   another call, writev. */
static void write_instead(int number, siginfo_t *info, void *context) {
  static bool full;
  greg_t *r = ((ucontext_t *)context)->uc_mcontext.gregs;
  struct iovec part = {(void *)r[REG_RSI], (size_t)r[REG_RDX]};
  const int fd = (int)r[REG_RDI], error = errno;
  const bool file = fd > STDERR_FILENO;
  (void)number, (void)info;
  full = full || (file && fails("full"));
  if (file && part.iov_len > 1 && fails("short"))
    part.iov_len /= 2;
  ssize_t written = -1;
  errno = ENOSPC;
  if (!file || !(full || fails("write")))
    written = syscall(SYS_writev, fd, &part, 1);
  if (file)
    done(0);
  r[REG_RAX] = written < 0 ? -errno : written;
  errno = error;
}

__attribute__((constructor)) static void watch_writes(void) {
  static const struct sock_filter each[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, arch)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, AUDIT_ARCH_X86_64, 0, 3),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_write, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const struct sock_fprog all = {sizeof each / sizeof *each, (void *)each};
  const struct sigaction handle = {.sa_sigaction = write_instead,
                                   .sa_flags = SA_SIGINFO | SA_RESTART};
  const char *fault = getenv("FAULT");
  if (!fault || (strncmp(fault, "write:", 6) && strncmp(fault, "full:", 5) &&
                 strncmp(fault, "short:", 6) && strncmp(fault, "killed:", 7) &&
                 strncmp(fault, "asked:", 6)))
    return;
  if (sigaction(SIGSYS, &handle, NULL) != 0 ||
      prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &all) != 0)
    abort(); /* no test without */
}
#endif
