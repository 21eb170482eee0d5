/* What the compiler's -fsanitize-coverage=trace-pc calls at every basic block: counts the edges of
   the program in the map that AFL++ looks at. gfortran has no other way to be watched: AFL++'s own
   compilers know C alone. Addresses must not move between runs, so link with -no-pie. */
#include <stdint.h>

extern unsigned char *__afl_area_ptr;

/* The map AFL++ gives by default. */
enum { map_size = 1 << 16 };

void __sanitizer_cov_trace_pc(void)
{
  static uintptr_t previous;
  uintptr_t here = (uintptr_t)__builtin_return_address(0);

  here = (here * UINT64_C(0x9e3779b97f4a7c15)) >> 40;
  __afl_area_ptr[(here ^ previous) % map_size]++;
  previous = here >> 1;
}
