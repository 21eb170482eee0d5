/* Processes that compute for this one, each with a pipe to it and one back. `forks` documents each
   function. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#include "system_calls.h"

/* Most processes that are waited for at once; most descriptors that are looked at. */
enum { most = 1024, most_open = 65536 };

/* A process that is forked must not hold the pipes of the ones before it, whose end would not be
   seen, nor the lock of a folder. */
static void close_others(int reading, int writing) {
  long limit = sysconf(_SC_OPEN_MAX);
  int fd;
  if (limit < 0 || limit > most_open)
    limit = most_open;
  for (fd = STDERR_FILENO + 1; fd < limit; fd++)
    if (fd != reading && fd != writing)
      close(fd);
}

int snapin_can_fork(void) { return 1; }

int snapin_fork(int *reading, int *writing) {
  int to[2], from[2], status, i;
  pid_t parent = getpid(), child;
  if (pipe(to) != 0)
    return -errno;
  if (pipe(from) != 0) {
    status = -errno;
    close(to[0]);
    close(to[1]);
    return status;
  }
  fflush(NULL);
  child = fork();
  if (child < 0) {
    status = -errno;
    for (i = 0; i < 2; i++) {
      close(to[i]);
      close(from[i]);
    }
    return status;
  }
  *reading = child == 0 ? to[0] : from[0];
  *writing = child == 0 ? from[1] : to[1];
  if (child > 0) {
    close(to[0]);
    close(from[1]);
    return (int)child;
  }
  close_others(*reading, *writing);
  end_with_parent_by(SIGKILL);
  if (getppid() != parent)
    _exit(1);
  return 0;
}

int snapin_ready(const int *reading, int count) {
  struct pollfd waiting[most];
  int i;
  for (i = 0; i < count && i < most; i++) {
    waiting[i].fd = reading[i];
    waiting[i].events = POLLIN;
    waiting[i].revents = 0;
  }
  while (poll(waiting, count < most ? count : most, -1) < 0)
    if (errno != EINTR)
      return -errno;
  for (i = 0; i < count && i < most; i++)
    if (waiting[i].revents != 0)
      return i;
  return -EAGAIN;
}

void snapin_await(int child) {
  int status;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR)
    ;
}

void snapin_quit(void) { _exit(0); }
