/* Reads decks over and over in one process, under AFL++ or alone:  driver DECK ...
   Whatever is wrong ends in abort(), which AFL++ keeps as a crash. */
#define _GNU_SOURCE
#include <fenv.h>
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>

int __afl_persistent_loop(unsigned count);
void __afl_manual_init(void);
void read_one(const char *path);

/* By these AFL++ recognises a program that waits for its forks and reads many inputs each. */
const char *volatile persistent = "##SIG_AFL_PERSISTENT##";
const char *volatile deferred = "##SIG_AFL_DEFER_FORKSRV##";

enum { runs_of_one_process = 10000 };
/* Units and buffers of the first decks stay; what grows beyond this is a leak, if malloc keeps no
   freed blocks aside: GLIBC_TUNABLES=glibc.malloc.tcache_count=0. */
enum { settled_after = 100, most_growth = 65536 };

static int finished;

/* A Fortran run-time error and `error stop` leave by exit(). */
static void ended_early(void)
{
  if (!finished) abort();
}

int main(int count, char **decks)
{
  size_t in_use, settled = 0;
  long runs = 0;

  atexit(ended_early);
#ifdef TRAPS
  feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
#endif
  __afl_manual_init();
  while (__afl_persistent_loop(runs_of_one_process)) {
    for (int i = 1; i < count; i++) {
      read_one(decks[i]);
      in_use = mallinfo2().uordblks;
      if (++runs == settled_after) settled = in_use;
      if (runs > settled_after && in_use > settled + most_growth) {
        fprintf(stderr, "%zu bytes more in use after %ld decks\n", in_use - settled, runs);
        abort();
      }
    }
  }
  finished = 1;
  return 0;
}
