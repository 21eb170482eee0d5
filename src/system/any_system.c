/* Reading and writing, failures and OpenBLAS, by way of the calls that all systems have; see
   `c_library`. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <errno.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

#include "system_calls.h"

long snapin_read(int fd, char *bytes, long count) {
  long done = 0;
  int tries = 0, later;
  while (done < count) {
    ssize_t got = read(fd, bytes + done, count - done);
    if (got < 0 && errno == EINTR)
      continue;
    if (got < 0 && (errno != EAGAIN || may_be_read_later(fd, -1) <= 0))
      return -errno;
    if (got == 0) {
      later = done > 0 ? 0 : may_be_read_later(fd, tries++);
      if (later < 0)
        return later;
      if (later == 0)
        break;
    }
    if (got > 0)
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

int snapin_seek(int fd, long place) { return lseek(fd, place, SEEK_SET) < 0 ? -errno : 0; }

/* The sort of a failure, or 0 for others, and the system's message. */
int snapin_explain(int status, char *reason, int size) {
  hand_over(status == -not_regular   ? "not a file but a link, a pipe or a device"
            : status == -not_written ? "no program has opened this pipe for writing"
                                     : strerror(-status),
            reason, size);
  switch (-status) {
  case EFBIG:
    return too_large;
  case ENOSPC:
#ifdef EDQUOT
  case EDQUOT:
#endif
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

/* OpenBLAS is looked up at run time, since the linear algebra may be another library. 1 if it is
   there; count > 0: its number of threads. Setting a number restarts threads that were ended, even
   if it is 1. */
int snapin_openblas_threads(int count) {
  void (*set)(int) = (void (*)(int))found_procedure("openblas_set_num_threads");
  int (*get)(void) = (int (*)(void))found_procedure("openblas_get_num_threads");
  if (set != NULL && count > 0 && (get == NULL || get() != count))
    set(count);
  return set != NULL;
}

/* With a limited address space the threads stay, since they might not get their memory again. */
void snapin_openblas_end_threads(void) {
  int (*end)(void) = (int (*)(void))found_procedure("blas_thread_shutdown_");
  if (end != NULL && !address_space_is_limited())
    end();
}

void snapin_openblas_config(char *text, int size) {
  const char *(*get)(void) = (const char *(*)(void))found_procedure("openblas_get_config");
  hand_over(get != NULL ? get() : "", text, size);
}
