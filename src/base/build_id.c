#include "base/build_id.h"

#include "config.h"
#include <fluidy/fluidy.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#if defined __linux__
#include <elf.h>
#include <link.h>

/* Returns: true if the loaded object contains fl_build_id(). */
static bool is_ours(const struct dl_phdr_info *info)
{
    const uintptr_t here = (uintptr_t)fl_build_id;
    for (int k = 0; k < info->dlpi_phnum; k++) {
        const uintptr_t start = info->dlpi_addr + info->dlpi_phdr[k].p_vaddr;
        if (info->dlpi_phdr[k].p_type == PT_LOAD && here >= start &&
            here - start < info->dlpi_phdr[k].p_memsz)
            return true;
    }
    return false;
}

/* Appends the id among the notes of a segment. */
static void append_id(GString *text, const uint8_t *notes, size_t bytes)
{
    ElfW(Nhdr) note;
    while (bytes > sizeof note) {
        memcpy(&note, notes, sizeof note);
        const size_t name = (note.n_namesz + 3u) & ~3u, data = (note.n_descsz + 3u) & ~3u;
        if (name + data > bytes - sizeof note)
            return;
        if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4)
            for (unsigned k = 0; k < note.n_descsz; k++)
                g_string_append_printf(text, "%02x", notes[sizeof note + name + k]);
        notes += sizeof note + name + data, bytes -= sizeof note + name + data;
    }
}

static int look_at(struct dl_phdr_info *info, size_t size, void *text)
{
    if (!is_ours(info))
        return 0;
    for (int k = 0; k < info->dlpi_phnum; k++)
        if (info->dlpi_phdr[k].p_type == PT_NOTE) {
            // NOLINTNEXTLINE(performance-no-int-to-ptr): address given by the loader
            const uint8_t *notes = (const uint8_t *)(info->dlpi_addr + info->dlpi_phdr[k].p_vaddr);
            append_id(text, notes, info->dlpi_phdr[k].p_memsz);
        }
    return 1;
}

static void append_build(GString *text)
{
    dl_iterate_phdr(look_at, text);
}
#else
static void append_build(GString *text)
{
    (void)text;
}
#endif

const char *fl_version(void)
{
    return FL_VERSION;
}

const char *fl_build_id(void)
{
    static char *id;
    if (!id) {
        GString *text = g_string_new(FL_VERSION " ");
        append_build(text);
        id = g_string_free(text, FALSE);
    }
    return id;
}
