/* What libraries read before main begins. OpenBLAS maps memory for each of its threads, and tries
   for ever if it gets none: it begins with one, and `machine` asks for more where matrices are
   large. Variables of gfortran's library would change the format of numbers, or end runs. A stack
   that is too small ends a run by a signal: it is enlarged, or the program says so. Libraries that
   the program does not carry have read the variables already. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* The usual stack of a process and of a thread [bytes], and the least: sweeps use half. */
enum { usual_stack = 8 << 20, least_stack = 1 << 20 };

static void forget_variables(const char *prefix) {
  extern char **environ;
  char name[256];
  size_t i = 0, length = strlen(prefix);
  while (environ != NULL && environ[i] != NULL) {
    size_t size = strcspn(environ[i], "=");
    if (strncmp(environ[i], prefix, length) != 0 || size >= sizeof name) {
      i++;
      continue;
    }
    memcpy(name, environ[i], size);
    name[size] = 0;
    unsetenv(name);
  }
}

static void enlarge_stack(void) {
  struct rlimit limit;
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= usual_stack)
    return;
  limit.rlim_cur = limit.rlim_max < usual_stack ? limit.rlim_max : usual_stack;
  setrlimit(RLIMIT_STACK, &limit);
  if (limit.rlim_cur >= least_stack)
    return;
  fputs("snapin: the stack is too small; raise its limit (ulimit -s) to 1024 or more\n", stderr);
  _exit(1);
}

/* OpenBLAS's own constructor has this priority too, and comes later in the program. */
static void prepare(void) __attribute__((constructor(101)));

static void prepare(void) {
  forget_variables("GFORTRAN_");
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  setenv("OMP_STACKSIZE", "8M", 1);
  enlarge_stack();
}
