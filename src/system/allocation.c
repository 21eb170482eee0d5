/* Without memory the program ends with status 1 and a message; compiled Fortran would go on to a
   segmentation fault (compiler note 7). The linker redirects the calls here (--wrap, see
   meson.build). The journal then holds all complete states. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);

static void *checked(void *place, size_t size) {
  static const char message[] = "snapin: there is not enough memory to go on; free some, raise the "
                                "limit (ulimit -v), or ask for fewer nodes, then use --resume\n";
  if (place == NULL && size > 0) {
    ssize_t sent = write(STDERR_FILENO, message, sizeof message - 1);
    (void)sent;
    _exit(1);
  }
  return place;
}

void *__wrap_malloc(size_t size) { return checked(__real_malloc(size), size); }

void *__wrap_calloc(size_t count, size_t size) {
  return checked(__real_calloc(count, size), count > 0 ? size : 0);
}

void *__wrap_realloc(void *old, size_t size) { return checked(__real_realloc(old, size), size); }

/* OpenBLAS maps memory for each of its threads before main begins, and tries for ever if it gets
   none. If the address space is small, the program starts once more with fewer threads for
   OpenBLAS. This runs before the initialisation of the libraries, which read the environment of the
   process. The memory of a thread, its stack and its malloc arena take 200 MB. */
static void leave_room(int count, char **arguments, char **environment) {
  static const char name[] = "OPENBLAS_NUM_THREADS=";
  const rlim_t one = 320000000;
  struct rlimit limit;
  long wanted = 0, room, kept = 0, i;
  const char *common = NULL;
  char text[64], **changed;
  (void)count;
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return;
  for (i = 0; environment[i] != NULL; i++) {
    if (strncmp(environment[i], name, sizeof name - 1) == 0)
      wanted = atol(environment[i] + sizeof name - 1);
    if (strncmp(environment[i], "OMP_NUM_THREADS=", 16) == 0)
      common = environment[i] + 16;
  }
  if (wanted < 1 && common != NULL)
    wanted = atol(common);
  if (wanted < 1)
    wanted = sysconf(_SC_NPROCESSORS_ONLN);
  room = limit.rlim_cur / one > 1 ? (long)(limit.rlim_cur / one) : 1;
  changed = room < wanted ? malloc((i + 2) * sizeof *changed) : NULL;
  if (changed == NULL)
    return;
  for (i = 0; environment[i] != NULL; i++)
    if (strncmp(environment[i], name, sizeof name - 1) != 0)
      changed[kept++] = environment[i];
  snprintf(text, sizeof text, "%s%ld", name, room);
  changed[kept++] = text;
  changed[kept] = NULL;
  execve("/proc/self/exe", arguments, changed);
}

/* The stack grows when a part of it is first used. If the limit of the address space refuses this,
   the program ends with a signal instead of the message above. Therefore the stack grows here, at
   the start, to three times the size that was seen to be used. */
static void grow_stack(int count, char **arguments, char **environment) {
  volatile char room[500000];
  struct rlimit limit;
  size_t i;
  (void)count, (void)arguments, (void)environment;
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur < 4 * sizeof room)
    return;
  for (i = 0; i < sizeof room; i += 4096)
    room[i] = 0;
}

__attribute__((section(".preinit_array"), used)) static void (*first[])(int, char **, char **) = {
    leave_room, grow_stack};
