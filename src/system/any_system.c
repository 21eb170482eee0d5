/* Failures and OpenBLAS, by way of the calls of this system; see `c_library`. */
#include <errno.h>
#include <string.h>

#include "system_calls.h"

/* The sort of a failure, or 0 for others, and the system's message. */
int snapin_explain(int status, char *reason, int size) {
  hand_over(status == -not_regular ? "not a file but a link, a pipe or a device"
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
