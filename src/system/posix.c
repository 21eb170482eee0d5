/* The system calls that files, folders and the process need, so that their constants are those of
   the system's own headers. A call that fails returns minus its errno. `c_library` says what each
   is for. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* Beyond every errno. */
enum { not_regular = 100000 };

enum { too_large = 1, disk_full = 2, in_the_way = 3, not_there = 4, locked = 5 };

static int status_of(int result) { return result < 0 ? -errno : result; }

int snapin_open_input(const char *path) { return status_of(open(path, O_RDONLY | O_CLOEXEC)); }

/* A link could lead the output elsewhere, and a pipe could make its opening wait. Nothing is
   emptied before it is known what it is. */
int snapin_open_output(const char *path, int keep) {
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

/* Bytes read; fewer than asked for only at the end. */
long snapin_read(int fd, char *bytes, long count) {
  long done = 0;
  while (done < count) {
    ssize_t got = read(fd, bytes + done, count - done);
    if (got < 0 && errno == EINTR)
      continue;
    if (got < 0)
      return -errno;
    if (got == 0)
      break;
    done += got;
  }
  return done;
}

int snapin_write(int fd, const char *bytes, long count) {
  while (count > 0) {
    ssize_t done = write(fd, bytes, count);
    if (done < 0 && errno == EINTR)
      continue;
    if (done < 0)
      return -errno;
    bytes += done;
    count -= done;
  }
  return 0;
}

/* Some file systems cannot, and say so: then there is nothing to be had. */
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

int snapin_go_to(int fd, long offset) { return lseek(fd, offset, SEEK_SET) < 0 ? -errno : 0; }

int snapin_truncate(int fd, long length) { return status_of(ftruncate(fd, length)); }

int snapin_make_folder(const char *path) { return status_of(mkdir(path, 0777)); }

int snapin_open_folder(const char *path) {
  return status_of(open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC));
}

int snapin_lock(int folder) { return status_of(flock(folder, LOCK_EX | LOCK_NB)); }

/* 0 where there is nothing of that name, 1 a file, 2 a folder. */
int snapin_kind(int folder, const char *name) {
  struct stat file;
  if (fstatat(folder, name, &file, AT_SYMLINK_NOFOLLOW) != 0)
    return errno == ENOENT ? 0 : -errno;
  return S_ISDIR(file.st_mode) ? 2 : 1;
}

int snapin_rename(int folder, const char *from, const char *to) {
  return status_of(renameat(folder, from, folder, to));
}

int snapin_remove(int folder, const char *name) {
  return unlinkat(folder, name, 0) == 0 || errno == ENOENT ? 0 : -errno;
}

int snapin_is_terminal(int fd) { return isatty(fd) == 1; }

const char *snapin_reason(int status) {
  return status == -not_regular ? "not a file but a link, a pipe or a device" : strerror(-status);
}

int snapin_sort(int status) {
  switch (-status) {
  case EFBIG:
    return too_large;
  case ENOSPC:
  case EDQUOT:
    return disk_full;
  case EEXIST:
  case ENOTDIR:
  case EISDIR:
  case not_regular:
    return in_the_way;
  case ENOENT:
    return not_there;
  case EWOULDBLOCK:
    return locked;
  default:
    return 0;
  }
}

/* Writing to a pipe that nobody reads, or beyond the largest file that the user may have, fails
   instead of ending the process; and no file takes the place of a closed standard stream, where
   messages would be written into it. */
void snapin_prepare(void) {
  int fd;
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  do
    fd = open("/dev/null", O_RDWR);
  while (fd >= 0 && fd <= STDERR_FILENO);
  if (fd > STDERR_FILENO)
    close(fd);
}
