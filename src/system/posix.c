/* System calls for files, folders and the process; in C, to take their constants from the system's
   headers. A call that fails returns minus its errno. `c_library` documents each function.

   Here are those of POSIX.1-2008, and nothing else; `beyond_posix.c` has what further systems add,
   and `windows.c` has all of them for Windows. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <time.h>
#include <unistd.h>

#include "system_calls.h"

static int status_of(int result) { return result < 0 ? -errno : result; }

/* A link could redirect the output, and opening a pipe could wait. A file is emptied only after its
   kind is known. */
static int open_output(const char *path, int keep) {
  int flags = O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC, status;
  struct stat file;
  int fd = open(path, keep ? flags : flags | O_CREAT, 0666);
  if (fd < 0) {
    status = -errno;
    if (lstat(path, &file) == 0 && !S_ISREG(file.st_mode) && !S_ISDIR(file.st_mode))
      return -not_regular;
    return status;
  }
  if (fstat(fd, &file) != 0)
    status = -errno;
  else if (!S_ISREG(file.st_mode))
    status = -not_regular;
  else
    status = keep ? 0 : status_of(ftruncate(fd, 0));
  if (status == 0)
    return fd;
  close(fd);
  return status;
}

/* Data are read again by each case and each resumed run, which a pipe does not give; and opening or
   reading one, or a device, could wait for ever. */
static int open_data(const char *path) {
  struct stat file;
  int status, fd = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (fd < 0)
    return -errno;
  if (fstat(fd, &file) != 0)
    status = -errno;
  else if (S_ISREG(file.st_mode))
    return fd;
  else
    status = S_ISDIR(file.st_mode) ? -EISDIR : -not_regular;
  close(fd);
  return status;
}

int snapin_open(const char *path, int how) {
  switch (how) {
  case as_data:
    return open_data(path);
  case as_input:
    return status_of(open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  case as_folder:
    return status_of(open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  default:
    return open_output(path, how == as_kept_output);
  }
}

int may_be_read_later(int fd, int tries) {
  const struct timespec pause = {0, 100 * 1000 * 1000};
  struct stat file;
  if (!(fcntl(fd, F_GETFL) & O_NONBLOCK))
    return 0;
  if (tries < 0) {
    struct pollfd waiting = {fd, POLLIN, 0};
    return poll(&waiting, 1, -1) > 0 || errno == EINTR;
  }
  if (fstat(fd, &file) != 0 || !S_ISFIFO(file.st_mode))
    return 0;
  if (tries >= 20)
    return -not_written;
  nanosleep(&pause, NULL);
  return 1;
}

/* On file systems that do not support fsync, nothing more can be done. */
int snapin_sync(int fd) {
  if (fsync(fd) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS)
    return 0;
  return -errno;
}

int snapin_close(int fd) { return status_of(close(fd)); }

long snapin_size(int fd) {
  struct stat file;
  return fstat(fd, &file) == 0 ? (long)file.st_size : -errno;
}

int snapin_cut(int fd, long length, long place) {
  return ftruncate(fd, length) < 0 || lseek(fd, place, SEEK_SET) < 0 ? -errno : 0;
}

int snapin_sync_in(int folder, const char *name) {
  int status, fd = openat(folder, name, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0)
    return -errno;
  status = snapin_sync(fd);
  close(fd);
  return status;
}

/* No failure if the parent folder cannot be opened. */
int snapin_sync_above(int folder) {
  int status, above = openat(folder, "..", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (above < 0)
    return 0;
  status = snapin_sync(above);
  close(above);
  return status;
}

int snapin_make_folder(const char *path) { return status_of(mkdir(path, 0777)); }

void snapin_current_folder(char *text, int size) {
  char path[PATH_MAX];
  hand_over(getcwd(path, sizeof path) != NULL ? path : "", text, size);
}

int snapin_is_absolute(const char *path) { return path[0] == '/'; }

/* Any character but a slash may be part of a name. */
void snapin_use_slashes(char *path, int size) {
  (void)path;
  (void)size;
}

int snapin_kind(int folder, const char *name) {
  struct stat file;
  if (fstatat(folder, name, &file, AT_SYMLINK_NOFOLLOW) != 0)
    return errno == ENOENT ? 0 : -errno;
  return S_ISDIR(file.st_mode) ? 2 : 1;
}

int snapin_same_file(const char *path, const char *other) {
  struct stat one, two;
  return stat(path, &one) == 0 && stat(other, &two) == 0 && one.st_dev == two.st_dev &&
         one.st_ino == two.st_ino;
}

int snapin_rename(int folder, const char *from, const char *to) {
  return status_of(renameat(folder, from, folder, to));
}

int snapin_remove(int folder, const char *name) {
  return unlinkat(folder, name, 0) == 0 || errno == ENOENT ? 0 : -errno;
}

int snapin_remove_folder(int folder, const char *name) {
  return status_of(unlinkat(folder, name, AT_REMOVEDIR));
}

/* What is no regular file is not opened, since opening a pipe or a device may have effects. */
int snapin_beginning(int folder, const char *name, char *bytes, int count) {
  struct stat found;
  int status, fd;
  if (fstatat(folder, name, &found, AT_SYMLINK_NOFOLLOW) != 0)
    return -errno;
  if (!S_ISREG(found.st_mode))
    return -not_regular;
  fd = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (fd < 0)
    return -errno;
  status = (int)snapin_read(fd, bytes, count);
  close(fd);
  return status;
}

double snapin_free_disk(const char *path) {
  char above[PATH_MAX];
  struct statvfs disk;
  if (strlen(path) >= sizeof above)
    return 1e300;
  strcpy(above, path);
  while (statvfs(above[0] ? above : ".", &disk) != 0) {
    char *slash = strrchr(above, '/');
    if (errno != ENOENT || (!slash && !above[0]) || slash == above)
      return 1e300;
    *(slash ? slash : above) = 0;
  }
  return (double)disk.f_bavail * disk.f_frsize;
}

int snapin_is_terminal(int fd) { return isatty(fd) == 1; }

/* Writing to a pipe without a reader, or beyond the largest file size, fails instead of ending the
   process. Closed standard streams are opened on /dev/null, since another file would get their
   number, and messages; only for reading, so that writing fails as before. */
void snapin_prepare(void) {
  int fd;
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  do
    fd = open("/dev/null", O_RDONLY);
  while (fd >= 0 && fd <= STDERR_FILENO);
  if (fd > STDERR_FILENO)
    close(fd);
}

/* Processor time of this thread: unlike elapsed time it does not grow by other work. */
double snapin_thread_seconds(void) {
  struct timespec time = {0};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return time.tv_sec + 1e-9 * time.tv_nsec;
}

void snapin_pause(int microseconds) {
  struct timespec time = {.tv_sec = microseconds / 1000000};
  time.tv_nsec = microseconds % 1000000 * 1000L;
  nanosleep(&time, NULL);
}
