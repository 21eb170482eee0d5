/* The id that the linker gives to what it links: a checksum of all of it, in a note (see elf(5))
   that is in memory with the code. */
#define _GNU_SOURCE
#include <string.h>

#ifdef __ELF__
#include <link.h>

static size_t padded(size_t length, size_t step) { return (length + step - 1) / step * step; }

/* The build id among the notes of a segment, and its length; NULL where there is none. */
static const unsigned char *id_among(const unsigned char *notes, size_t size, size_t alignment,
                                     size_t *length) {
  size_t step = alignment > 4 ? alignment : 4, at = 0;
  ElfW(Nhdr) note;
  while (at + sizeof note < size) {
    const unsigned char *name = notes + at + sizeof note;
    memcpy(&note, notes + at, sizeof note);
    at = padded(at + sizeof note + note.n_namesz, step);
    if (at + note.n_descsz > size)
      break;
    if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == sizeof ELF_NOTE_GNU &&
        memcmp(name, ELF_NOTE_GNU, sizeof ELF_NOTE_GNU) == 0) {
      *length = note.n_descsz;
      return notes + at;
    }
    at = padded(at + note.n_descsz, step);
  }
  return NULL;
}

struct digits {
  char *text;
  size_t size;
};

/* Of the program and the libraries that are in memory, the one that this code is part of ends the
   search; its id is written as hexadecimal digits. */
static int write_own_id(struct dl_phdr_info *object, size_t size, void *where) {
  static const char here;
  const struct digits *digits = where;
  const unsigned char *id = NULL;
  size_t length = 0, i;
  int own = 0;
  (void)size;
  for (i = 0; i < object->dlpi_phnum; i++) {
    const ElfW(Phdr) *segment = &object->dlpi_phdr[i];
    ElfW(Addr) start = object->dlpi_addr + segment->p_vaddr;
    if (segment->p_type == PT_LOAD && (ElfW(Addr))&here - start < segment->p_memsz)
      own = 1;
    if (segment->p_type == PT_NOTE && id == NULL)
      id = id_among((const unsigned char *)start, segment->p_memsz, segment->p_align, &length);
  }
  for (i = 0; own && i < length && 2 * i + 1 < digits->size; i++) {
    digits->text[2 * i] = "0123456789abcdef"[id[i] / 16];
    digits->text[2 * i + 1] = "0123456789abcdef"[id[i] % 16];
  }
  return own;
}
#endif

/* As many digits as there is room for; blanks where there is no id. */
void snapin_build_id(char *text, int size) {
  memset(text, ' ', size);
#ifdef __ELF__
  struct digits digits = {text, size};
  dl_iterate_phdr(write_own_id, &digits);
#endif
}
