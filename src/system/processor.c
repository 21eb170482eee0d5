/* A program that is compiled for processors with AVX2 (meson.build) ends on others with a message,
   where it would be killed at its first such instruction; so does the probe of meson.build, which
   includes this file. This file is compiled for any processor. */
#include <stdio.h>
#include <unistd.h>

static void require(void) __attribute__((constructor));

static void require(void) {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
      __builtin_cpu_supports("bmi2"))
    return;
  fputs("snapin: this program is compiled for processors with AVX2, which this one does not have; "
        "build it with meson setup -Dprocessor=any\n", stderr);
  _exit(1);
}
