/* OpenBLAS maps memory for each of its threads before main begins, and tries for ever if it gets
   none. Where the program carries it, it begins with one thread; `machine` asks for more where
   matrices are large. */
#include <stdlib.h>

/* OpenBLAS's own constructor has this priority too, and comes later in the program. */
static void begin_with_one(void) __attribute__((constructor(101)));

static void begin_with_one(void) { setenv("OPENBLAS_NUM_THREADS", "1", 1); }
