/* What POSIX does not have and Linux, macOS and the BSDs add, each with what a plain POSIX system
   has instead (PLAIN_POSIX, by meson setup -Dsystem=posix): a lock of a folder, the end of the
   parent process, the program's own path, and procedures that are looked up at run time. */
#ifndef PLAIN_POSIX
#define _GNU_SOURCE
#endif
#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "system_calls.h"

#ifndef PLAIN_POSIX
#include <sys/file.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#ifdef __APPLE__
#include <mach-o/dyld.h>
#endif
#endif

/* A lock by `fcntl` would need a file, which stays, and would end when any of the process's
   descriptors of this file is closed. So plain POSIX has no lock, as some network file systems. */
int snapin_lock(int folder) {
#ifdef PLAIN_POSIX
  (void)folder;
  return -ENOTSUP;
#else
  return flock(folder, LOCK_EX | LOCK_NB) < 0 ? -errno : 0;
#endif
}

void end_with_parent_by(int signal) {
#if !defined(PLAIN_POSIX) && defined(PR_SET_PDEATHSIG)
  prctl(PR_SET_PDEATHSIG, signal);
#else
  (void)signal;
#endif
}

/* When the parent process has ended, nobody reads standard output. If it ended before this call,
   the pipe has no reader; where the system tells of no later end, that is all. */
void snapin_end_with_parent(void) {
  struct pollfd out = {.fd = STDOUT_FILENO};
  end_with_parent_by(SIGTERM);
  if (poll(&out, 1, 0) == 1 && (out.revents & POLLERR))
    raise(SIGTERM);
}

/* Blank where the system does not say. */
void snapin_own_path(char *text, int size) {
  char path[PATH_MAX];
  size_t length = 0;
#if !defined(PLAIN_POSIX) && defined(__APPLE__)
  uint32_t room = sizeof path;
  if (_NSGetExecutablePath(path, &room) == 0)
    length = strlen(path);
#elif !defined(PLAIN_POSIX)
  ssize_t found = readlink("/proc/self/exe", path, sizeof path);
  length = found > 0 ? (size_t)found : 0;
#endif
  path[length < sizeof path ? length : 0] = 0;
  hand_over(path, text, size);
}

/* Plain POSIX finds procedures of the program, not those of a library that a library has loaded. */
procedure found_procedure(const char *name) {
  procedure found = NULL;
#ifdef PLAIN_POSIX
  void *program = dlopen(NULL, RTLD_LAZY);
  if (program != NULL)
    *(void **)&found = dlsym(program, name);
#else
  *(void **)&found = dlsym(RTLD_DEFAULT, name);
#endif
  return found;
}

int address_space_is_limited(void) {
  struct rlimit limit;
  return getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY;
}
