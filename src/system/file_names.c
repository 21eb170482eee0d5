/* Names and sizes of files. `file_names` documents each function. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <glob.h>
#include <string.h>
#include <sys/stat.h>

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
