/* The linker's id of the program or library: a checksum of all of it, in a note (see elf(5)) that
   is in memory with the code. */
#include <string.h>

#ifdef __ELF__
#include <link.h>

/* The linker's symbol for the beginning of the program or library. */
extern const char __ehdr_start[] __attribute__((visibility("hidden")));

static size_t padded(size_t length) { return (length + 3) / 4 * 4; }

/* Writes the build id, if it is among these notes of a segment, in hexadecimal digits. */
static void write_id(const char *notes, size_t size, char *text, int room) {
  size_t at = 0, i;
  while (at + sizeof(ElfW(Nhdr)) < size) {
    const ElfW(Nhdr) *note = (const void *)(notes + at);
    const char *name = notes + at + sizeof *note;
    const unsigned char *id = (const void *)(name + padded(note->n_namesz));
    if (note->n_type == NT_GNU_BUILD_ID && strcmp(name, ELF_NOTE_GNU) == 0)
      for (i = 0; i < note->n_descsz && 2 * (int)i + 1 < room; i++) {
        text[2 * i] = "0123456789abcdef"[id[i] / 16];
        text[2 * i + 1] = "0123456789abcdef"[id[i] % 16];
      }
    at += sizeof *note + padded(note->n_namesz) + padded(note->n_descsz);
  }
}
#endif

/* As many digits of the id as fit; blanks if there is none. */
void snapin_build_id(char *text, int size) {
  memset(text, ' ', size);
#ifdef __ELF__
  const ElfW(Ehdr) *object = (const void *)__ehdr_start;
  const ElfW(Phdr) *segment = (const void *)(__ehdr_start + object->e_phoff);
  for (int i = 0; i < object->e_phnum; i++)
    if (segment[i].p_type == PT_NOTE)
      write_id(__ehdr_start + segment[i].p_offset, segment[i].p_memsz, text, size);
#endif
}
