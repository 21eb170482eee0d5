/* Windows cannot fork: what a team of processes would compute is computed by this one. `forks`
   documents each function. */
#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

int snapin_can_fork(void) { return 0; }

int snapin_fork(int *reading, int *writing) {
  *reading = *writing = -1;
  return -ENOSYS;
}

int snapin_ready(const int *reading, int count) {
  (void)reading;
  (void)count;
  return -ENOSYS;
}

void snapin_await(int child) { (void)child; }

void snapin_quit(void) { _exit(0); }
