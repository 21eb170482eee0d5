/* Names, sizes and parts of files. `file_names` documents each function. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <errno.h>
#include <glob.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

long snapin_names_like(const char *pattern, char *names, long size) {
  glob_t found;
  long needed = 0;
  size_t i;
  if (glob(pattern, 0, NULL, &found) != 0)
    return 0;
  for (i = 0; i < found.gl_pathc; i++) {
    long length = (long)strlen(found.gl_pathv[i]) + 1;
    if (needed + length <= size)
      memcpy(names + needed, found.gl_pathv[i], length);
    needed += length;
  }
  globfree(&found);
  return needed;
}

long snapin_bytes_of(const char *path) {
  struct stat file;
  return stat(path, &file) == 0 ? (long)file.st_size : -1;
}

long snapin_read_at(int fd, char *bytes, long count, long place) {
  long done = 0;
  while (done < count) {
    ssize_t got = pread(fd, bytes + done, count - done, place + done);
    if (got < 0 && errno == EINTR)
      continue;
    if (got < 0)
      return -errno;
    if (got == 0)
      break;
    done += got;
  }
  return done;
}
