/* Names and sizes of files on Windows, whose patterns have * and ? in the last part of a
   path. `file_names` documents each function. */
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { longest = 2 * MAX_PATH };

static int by_bytes(const void *one, const void *other) { return strcmp(one, other); }

long snapin_names_like(const char *pattern, char *names, long size) {
  const char *slash = strrchr(pattern, '/');
  int folder = slash != NULL ? (int)(slash - pattern + 1) : 0;
  long count = 0, room = 0, needed = 0;
  char(*found)[longest] = NULL;
  WIN32_FIND_DATAA file;
  HANDLE search = FindFirstFileA(pattern, &file);
  if (search == INVALID_HANDLE_VALUE)
    return 0;
  do {
    if (file.cFileName[0] == '.' || folder + strlen(file.cFileName) >= longest)
      continue;
    if (count == room) {
      void *larger = realloc(found, (room = 2 * room + 64) * sizeof *found);
      if (larger == NULL)
        break;
      found = larger;
    }
    snprintf(found[count++], longest, "%.*s%s", folder, pattern, file.cFileName);
  } while (FindNextFileA(search, &file));
  FindClose(search);
  if (count > 0)
    qsort(found, count, sizeof *found, by_bytes);
  for (long i = 0; i < count; i++) {
    long length = (long)strlen(found[i]) + 1;
    if (needed + length <= size)
      memcpy(names + needed, found[i], length);
    needed += length;
  }
  free(found);
  return needed;
}

long snapin_bytes_of(const char *path) {
  struct _stat64 file;
  return _stat64(path, &file) == 0 ? (long)file.st_size : -1;
}
