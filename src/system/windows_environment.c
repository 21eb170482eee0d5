/* What libraries read before main begins, on Windows; `environment.c` says why. The size of the
   stack is in the program's file (meson.build). */
#include <stdlib.h>
#include <string.h>

static void forget_variables(const char *prefix) {
  char name[256];
  size_t i = 0, length = strlen(prefix);
  while (_environ != NULL && _environ[i] != NULL) {
    size_t size = strcspn(_environ[i], "=");
    if (strncmp(_environ[i], prefix, length) != 0 || size >= sizeof name) {
      i++;
      continue;
    }
    memcpy(name, _environ[i], size);
    name[size] = 0;
    _putenv_s(name, "");
  }
}

static void prepare(void) __attribute__((constructor(101)));

static void prepare(void) {
  forget_variables("GFORTRAN_");
  _putenv_s("OPENBLAS_NUM_THREADS", "1");
  _putenv_s("OMP_STACKSIZE", "8M");
}
