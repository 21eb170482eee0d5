/* Loaded before the C library, makes its calls fail, or the process die, where tests want it.

   FAULT_CALL   the call: open, write, fsync, close, rename, unlink, ftruncate, fstat, mkdir, or any
                of these; or read
   FAULT_AT     which of them, from 1; 0 counts only
   FAULT_ERRNO  the error; 0: the process is killed before the call
   FAULT_LASTS  set: every later one fails too
   FAULT_UNDER  part of a path: only files below it count
   FAULT_LOG    a file that gets a line for every call that was made: its name, descriptor, path(s),
                and what was written in hexadecimal digits

   On the way out, the number of calls is the last line of the log. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { most = 1024 };
static char *paths[most];
static const char *call, *under;
static long at, failures, counted;
static int lasts, failing, log_fd = -1, ready;

static void set_up(void) {
  const char *text;
  if (ready)
    return;
  ready = 1;
  call = getenv("FAULT_CALL");
  under = getenv("FAULT_UNDER");
  at = (text = getenv("FAULT_AT")) ? atol(text) : 0;
  failing = (text = getenv("FAULT_ERRNO")) ? atoi(text) : 0;
  lasts = getenv("FAULT_LASTS") != NULL;
  if ((text = getenv("FAULT_LOG")))
    log_fd = syscall(SYS_openat, AT_FDCWD, text, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
}

static void put(const char *text) {
  if (log_fd >= 0)
    syscall(SYS_write, log_fd, text, strlen(text));
}

static void note(const char *name, int fd, const char *path, const char *other) {
  char line[9000];
  if (log_fd < 0)
    return;
  snprintf(line, sizeof line, "%s\t%d\t%s\t%s\n", name, fd, path ? path : "", other ? other : "");
  put(line);
}

/* Whether this call is to fail; sets errno. */
static int fails(const char *name) {
  set_up();
  if (!call || (strcmp(call, name) && strcmp(call, "any")))
    return 0;
  long mine = __sync_add_and_fetch(&counted, 1);
  if (at == 0 || mine < at || (mine > at && !lasts))
    return 0;
  failures++;
  if (failing == 0)
    syscall(SYS_kill, getpid(), SIGKILL);
  errno = failing;
  return 1;
}

static int minds_path(const char *path) {
  set_up();
  return under && path && strstr(path, under);
}

static const char *minds(int fd) {
  set_up();
  return fd >= 0 && fd < most ? paths[fd] : NULL;
}

#define REAL(type, name, ...)                                                                      \
  static type (*real)(__VA_ARGS__);                                                                \
  if (!real)                                                                                       \
    *(void **)&real = dlsym(RTLD_NEXT, name)

int open(const char *path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  if (minds_path(path) && fails("open"))
    return -1;
  int fd = syscall(SYS_openat, AT_FDCWD, path, flags | O_LARGEFILE, mode);
  if (fd >= 0 && fd < most && minds_path(path)) {
    paths[fd] = strdup(path);
    note(flags & O_CREAT ? "create" : "open", fd, path, NULL);
  }
  return fd;
}

/* What is opened from a folder that counts, the one above it for instance, counts too. */
int openat(int folder, const char *path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  const char *from_path = minds(folder);
  if (from_path && fails("open"))
    return -1;
  int fd = syscall(SYS_openat, folder, path, flags | O_LARGEFILE, mode);
  if (from_path && fd >= 0 && fd < most) {
    char whole[4200];
    snprintf(whole, sizeof whole, "%s/%s", from_path, path);
    paths[fd] = strdup(whole);
    note("open", fd, whole, NULL);
  }
  return fd;
}

ssize_t write(int fd, const void *bytes, size_t count) {
  const char *path = minds(fd);
  if (path && fails("write")) {
    /* A full disk takes a part first. */
    if (errno == ENOSPC && count > 1 && failures == 1) {
      failures++;
      ssize_t part = syscall(SYS_write, fd, bytes, count / 2);
      if (!lasts)
        at++;
      return part;
    }
    return -1;
  }
  if (path && log_fd >= 0) {
    char digits[3];
    char head[4200];
    snprintf(head, sizeof head, "write\t%d\t%s\t", fd, path);
    put(head);
    for (size_t i = 0; i < count; i++) {
      snprintf(digits, sizeof digits, "%02x", ((const unsigned char *)bytes)[i]);
      put(digits);
    }
    put("\n");
  }
  return syscall(SYS_write, fd, bytes, count);
}

ssize_t read(int fd, void *bytes, size_t count) {
  if (minds(fd) && call && !strcmp(call, "read") && fails("read"))
    return -1;
  return syscall(SYS_read, fd, bytes, count);
}

int fsync(int fd) {
  const char *path = minds(fd);
  if (path && fails("fsync"))
    return -1;
  if (path)
    note("fsync", fd, path, NULL);
  return syscall(SYS_fsync, fd);
}

int close(int fd) {
  const char *path = minds(fd);
  int bad = path && fails("close");
  if (path) {
    if (!bad)
      note("close", fd, path, NULL);
    paths[fd] = NULL;
  }
  int status = syscall(SYS_close, fd);
  if (bad)
    errno = failing;
  return bad ? -1 : status;
}

int ftruncate(int fd, off_t length) {
  char text[32];
  const char *path = minds(fd);
  if (path && fails("ftruncate"))
    return -1;
  snprintf(text, sizeof text, "%ld", (long)length);
  if (path)
    note("truncate", fd, path, text);
  return syscall(SYS_ftruncate, fd, length);
}

int fstat(int fd, struct stat *status) {
  REAL(int, "fstat", int, struct stat *);
  if (minds(fd) && fails("fstat"))
    return -1;
  return real(fd, status);
}

int fstatat(int folder, const char *name, struct stat *status, int flags) {
  REAL(int, "fstatat", int, const char *, struct stat *, int);
  if (minds(folder) && fails("fstat"))
    return -1;
  return real(folder, name, status, flags);
}

/* The names under which programs with large files know them. */
int open64(const char *path, int flags, ...) __attribute__((alias("open")));

int openat64(int folder, const char *path, int flags, ...) __attribute__((alias("openat")));

int ftruncate64(int fd, off64_t length) { return ftruncate(fd, length); }

int fstat64(int fd, struct stat64 *status) { return fstat(fd, (struct stat *)status); }

int fstatat64(int folder, const char *name, struct stat64 *status, int flags) {
  return fstatat(folder, name, (struct stat *)status, flags);
}

int renameat(int folder, const char *from, int target, const char *to) {
  if (minds(folder)) {
    if (fails("rename"))
      return -1;
    note("rename", folder, from, to);
  }
  return syscall(SYS_renameat2, folder, from, target, to, 0);
}

int unlinkat(int folder, const char *name, int flags) {
  if (minds(folder)) {
    if (fails("unlink"))
      return -1;
    note("unlink", folder, name, NULL);
  }
  return syscall(SYS_unlinkat, folder, name, flags);
}

int mkdir(const char *path, mode_t mode) {
  if (minds_path(path) && fails("mkdir"))
    return -1;
  if (minds_path(path))
    note("mkdir", -1, path, NULL);
  return syscall(SYS_mkdirat, AT_FDCWD, path, mode);
}

__attribute__((destructor)) static void end(void) {
  char line[64];
  snprintf(line, sizeof line, "counted\t%ld\n", counted);
  put(line);
}
