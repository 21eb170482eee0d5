/* System calls for files, folders and the process on Windows, as `posix.c` and `beyond_posix.c`
   have them for other systems. A call that fails returns minus its errno. `c_library` says of each
   function what it does. Paths have slashes, in the code page of the process, as the command line
   has them. */
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#include <direct.h>
#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <stdio.h>
#include <string.h>

#include "system_calls.h"

/* Others may read, write and rename meanwhile, as on other systems. */
static const DWORD shared = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

static int failure(void) {
  switch (GetLastError()) {
  case ERROR_FILE_NOT_FOUND:
  case ERROR_PATH_NOT_FOUND:
  case ERROR_INVALID_NAME:
    return -ENOENT;
  case ERROR_ALREADY_EXISTS:
  case ERROR_FILE_EXISTS:
    return -EEXIST;
  case ERROR_DIRECTORY:
    return -ENOTDIR;
  case ERROR_DIR_NOT_EMPTY:
    return -ENOTEMPTY;
  case ERROR_DISK_FULL:
  case ERROR_HANDLE_DISK_FULL:
    return -ENOSPC;
  case ERROR_SHARING_VIOLATION:
  case ERROR_ACCESS_DENIED:
    return -EACCES;
  default:
    return -EIO;
  }
}

static int status_of(int result) { return result < 0 ? -errno : result; }

static HANDLE handle_of(int fd) { return (HANDLE)_get_osfhandle(fd); }

void snapin_use_slashes(char *path, int size) {
  for (int i = 0; i < size; i++)
    if (path[i] == '\\')
      path[i] = '/';
}

int snapin_is_absolute(const char *path) {
  return path[0] == '/' || (path[0] != 0 && path[1] == ':' && path[2] == '/');
}

/* The path of a name in an open folder; 0 if there is none. */
static int path_in(int folder, const char *name, char *path) {
  DWORD length = GetFinalPathNameByHandleA(handle_of(folder), path, MAX_PATH, 0);
  if (length == 0 || length + strlen(name) + 2 > 2 * MAX_PATH)
    return 0;
  path[length] = '\\';
  strcpy(path + length + 1, name);
  /* With its prefix, this path must have the system's own separators. */
  for (; path[length] != 0; length++)
    if (path[length] == '/')
      path[length] = '\\';
  return 1;
}

static int descriptor(HANDLE file, int flags) {
  int fd = file == INVALID_HANDLE_VALUE ? -1 : _open_osfhandle((intptr_t)file, flags | _O_BINARY);
  if (file == INVALID_HANDLE_VALUE)
    return failure();
  if (fd < 0)
    CloseHandle(file);
  return status_of(fd);
}

static int open_output(const char *path, int keep) {
  DWORD kind = GetFileAttributesA(path);
  HANDLE file;
  if (kind != INVALID_FILE_ATTRIBUTES && kind & FILE_ATTRIBUTE_DIRECTORY)
    return -EISDIR;
  if (kind != INVALID_FILE_ATTRIBUTES && kind & FILE_ATTRIBUTE_REPARSE_POINT)
    return -not_regular;
  file = CreateFileA(path, GENERIC_READ | GENERIC_WRITE, shared, NULL,
                     keep ? OPEN_EXISTING : OPEN_ALWAYS, FILE_FLAG_OPEN_REPARSE_POINT, NULL);
  if (file != INVALID_HANDLE_VALUE && GetFileType(file) != FILE_TYPE_DISK) {
    CloseHandle(file);
    return -not_regular;
  }
  if (file != INVALID_HANDLE_VALUE && !keep && !SetEndOfFile(file)) {
    int status = failure();
    CloseHandle(file);
    return status;
  }
  return descriptor(file, _O_RDWR);
}

/* A folder is opened for its name alone, which is no use that a lock would stand against. */
static int open_folder(const char *path) {
  DWORD kind = GetFileAttributesA(path);
  if (kind != INVALID_FILE_ATTRIBUTES && !(kind & FILE_ATTRIBUTE_DIRECTORY))
    return -ENOTDIR;
  return descriptor(CreateFileA(path, FILE_READ_ATTRIBUTES, shared, NULL, OPEN_EXISTING,
                                FILE_FLAG_BACKUP_SEMANTICS, NULL), _O_RDONLY);
}

int snapin_open(const char *path, int how) {
  switch (how) {
  case as_input:
  case as_data:
    return descriptor(CreateFileA(path, GENERIC_READ, shared, NULL, OPEN_EXISTING, 0, NULL),
                      _O_RDONLY);
  case as_folder:
    return open_folder(path);
  default:
    return open_output(path, how == as_kept_output);
  }
}

/* The names in a folder are the file system's own care. */
int snapin_sync(int fd) {
  BY_HANDLE_FILE_INFORMATION about;
  if (GetFileInformationByHandle(handle_of(fd), &about) &&
      about.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY)
    return 0;
  return FlushFileBuffers(handle_of(fd)) ? 0 : failure();
}

int snapin_sync_in(int folder, const char *name) {
  char path[2 * MAX_PATH];
  if (!path_in(folder, name, path))
    return failure();
  return GetFileAttributesA(path) == INVALID_FILE_ATTRIBUTES ? failure() : 0;
}

int snapin_sync_above(int folder) {
  (void)folder;
  return 0;
}

int snapin_close(int fd) { return status_of(_close(fd)); }

long snapin_size(int fd) { return status_of(_filelength(fd)); }

int snapin_cut(int fd, long length, long place) {
  return _chsize(fd, length) < 0 || _lseek(fd, place, SEEK_SET) < 0 ? -errno : 0;
}

int snapin_make_folder(const char *path) { return CreateDirectoryA(path, NULL) ? 0 : failure(); }

void snapin_current_folder(char *text, int size) {
  char path[MAX_PATH] = "";
  if (GetCurrentDirectoryA(sizeof path, path) >= sizeof path)
    path[0] = 0;
  hand_over(path, text, size);
  snapin_use_slashes(text, size);
}

void snapin_own_path(char *text, int size) {
  char path[MAX_PATH] = "";
  if (GetModuleFileNameA(NULL, path, sizeof path) >= sizeof path)
    path[0] = 0;
  hand_over(path, text, size);
  snapin_use_slashes(text, size);
}

/* The lock is a handle that may remove the folder and lets no other have this right; it takes the
   place of the folder's descriptor, and ends with it. */
int snapin_lock(int folder) {
  char path[2 * MAX_PATH];
  HANDLE lock;
  int fd, status;
  if (!path_in(folder, "", path))
    return failure();
  lock = CreateFileA(path, DELETE | FILE_READ_ATTRIBUTES, FILE_SHARE_READ | FILE_SHARE_WRITE, NULL,
                     OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, NULL);
  if (lock == INVALID_HANDLE_VALUE)
    return GetLastError() == ERROR_SHARING_VIOLATION ? -EWOULDBLOCK : failure();
  fd = descriptor(lock, _O_RDONLY);
  if (fd < 0)
    return fd;
  status = status_of(_dup2(fd, folder));
  _close(fd);
  return status;
}

int snapin_kind(int folder, const char *name) {
  char path[2 * MAX_PATH];
  DWORD kind;
  if (!path_in(folder, name, path))
    return failure();
  kind = GetFileAttributesA(path);
  if (kind == INVALID_FILE_ATTRIBUTES)
    return failure() == -ENOENT ? 0 : failure();
  return kind & FILE_ATTRIBUTE_DIRECTORY ? 2 : 1;
}

int snapin_same_file(const char *path, const char *other) {
  const char *names[] = {path, other};
  BY_HANDLE_FILE_INFORMATION about[2];
  for (int i = 0; i < 2; i++) {
    HANDLE file = CreateFileA(names[i], FILE_READ_ATTRIBUTES, shared, NULL, OPEN_EXISTING,
                              FILE_FLAG_BACKUP_SEMANTICS, NULL);
    int known = file != INVALID_HANDLE_VALUE && GetFileInformationByHandle(file, &about[i]);
    if (file != INVALID_HANDLE_VALUE)
      CloseHandle(file);
    if (!known)
      return 0;
  }
  return about[0].dwVolumeSerialNumber == about[1].dwVolumeSerialNumber &&
         about[0].nFileIndexHigh == about[1].nFileIndexHigh &&
         about[0].nFileIndexLow == about[1].nFileIndexLow;
}

int snapin_rename(int folder, const char *from, const char *to) {
  char old[2 * MAX_PATH], new[2 * MAX_PATH];
  if (!path_in(folder, from, old) || !path_in(folder, to, new))
    return failure();
  return MoveFileExA(old, new, MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) ? 0 : failure();
}

/* A file that is open keeps its name until it is closed, and its folder cannot be removed: it is
   moved out of a subfolder first. */
int snapin_remove(int folder, const char *name) {
  char path[2 * MAX_PATH], away[2 * MAX_PATH], other[64];
  snprintf(other, sizeof other, "removed-%lu-%lu", GetCurrentProcessId(), GetTickCount());
  if (!path_in(folder, name, path) || !path_in(folder, other, away))
    return failure();
  if (strchr(name, '/') != NULL && MoveFileExA(path, away, 0))
    return DeleteFileA(away) ? 0 : failure();
  return DeleteFileA(path) || failure() == -ENOENT ? 0 : failure();
}

int snapin_remove_folder(int folder, const char *name) {
  char path[2 * MAX_PATH];
  return path_in(folder, name, path) && RemoveDirectoryA(path) ? 0 : failure();
}

int snapin_beginning(int folder, const char *name, char *bytes, int count) {
  char path[2 * MAX_PATH];
  DWORD kind;
  int status, fd;
  if (!path_in(folder, name, path))
    return failure();
  kind = GetFileAttributesA(path);
  if (kind == INVALID_FILE_ATTRIBUTES)
    return failure();
  if (kind & (FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_REPARSE_POINT | FILE_ATTRIBUTE_DEVICE))
    return -not_regular;
  fd = snapin_open(path, as_input);
  if (fd < 0)
    return fd;
  status = (int)snapin_read(fd, bytes, count);
  _close(fd);
  return status;
}

double snapin_free_disk(const char *path) {
  char above[2 * MAX_PATH];
  ULARGE_INTEGER bytes;
  if (strlen(path) >= sizeof above)
    return 1e300;
  strcpy(above, path);
  while (!GetDiskFreeSpaceExA(above[0] ? above : ".", &bytes, NULL, NULL)) {
    char *slash = strrchr(above, '/');
    if (failure() != -ENOENT || (!slash && !above[0]) || slash == above)
      return 1e300;
    *(slash ? slash : above) = 0;
  }
  return (double)bytes.QuadPart;
}

int snapin_is_terminal(int fd) { return _isatty(fd) != 0; }

/* Bytes are written as they are, without a carriage return at the end of a line. */
void snapin_prepare(void) {
  for (int fd = 0; fd <= 2; fd++)
    _setmode(fd, _O_BINARY);
}

/* There is nothing like it; a pipe without a reader fails at the next write. */
void snapin_end_with_parent(void) {}

double snapin_thread_seconds(void) {
  FILETIME begun, ended, system, own;
  ULARGE_INTEGER ticks[2];
  if (!GetThreadTimes(GetCurrentThread(), &begun, &ended, &system, &own))
    return 0;
  ticks[0].LowPart = own.dwLowDateTime, ticks[0].HighPart = own.dwHighDateTime;
  ticks[1].LowPart = system.dwLowDateTime, ticks[1].HighPart = system.dwHighDateTime;
  return 1e-7 * (double)(ticks[0].QuadPart + ticks[1].QuadPart);
}

void snapin_pause(int microseconds) { Sleep((microseconds + 999) / 1000); }

/* Those of OpenBLAS, if the program has loaded it. */
procedure found_procedure(const char *name) {
  HMODULE library = GetModuleHandleA("libopenblas.dll");
  return library != NULL ? (procedure)GetProcAddress(library, name) : NULL;
}

int address_space_is_limited(void) { return 0; }

int may_be_read_later(int fd, int tries) {
  (void)fd;
  (void)tries;
  return 0;
}
