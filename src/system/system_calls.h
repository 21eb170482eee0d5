/* What the halves of the system's calls share: `posix.c` with `beyond_posix.c`, and `windows.c`. */
#ifndef SYSTEM_CALLS_H
#define SYSTEM_CALLS_H

#include <string.h>

/* Larger than every errno; also in `c_library`, like the two lists. */
enum { not_regular = 100000, not_written = 100001 };

enum { too_large = 1, disk_full = 2, in_the_way = 3, not_there = 4, locked = 5 };

enum { as_input = 1, as_output = 2, as_kept_output = 3, as_folder = 4, as_data = 5 };

typedef void (*procedure)(void);

/* A procedure of a library that may be there, or NULL. */
procedure found_procedure(const char *name);

/* Reads count bytes, fewer only at the end of the file; returns their number, or minus an errno. */
long snapin_read(int fd, char *bytes, long count);

/* Whether a read that does not wait, and that got nothing, is to be tried again. tries < 0: there
   are no bytes yet, and this waits for some. Otherwise there may be no writer: a pipe's is waited
   for a tenth of a second, up to twenty times, then -not_written. Only if the file was opened so as
   not to wait: opening a pipe without a writer would wait for ever. */
int may_be_read_later(int fd, int tries);

/* Has the system end this process by a signal when its parent ends, if the system can. */
void end_with_parent_by(int signal);

/* Whether the process may have no more than a part of the address space. */
int address_space_is_limited(void);

/* Copies a C string into a Fortran string, with blanks behind it. */
static inline void hand_over(const char *from, char *text, int size) {
  size_t length = 0;
  while (length < (size_t)size && from[length] != 0)
    length++;
  memcpy(text, from, length);
  memset(text + length, ' ', size - length);
}

#endif
