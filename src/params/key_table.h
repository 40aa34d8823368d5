/* Key files, sections of "key = value" lines, and tables of keys: the field that each key of a
 * section sets, and the values that it may have. */
#pragma once

#include "base/file.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stddef.h>

typedef enum FlKeyType {
    FL_KEY_TEXT,    // char *, of the struct
    FL_KEY_NUMBER,  // float, one or several with spaces or a comma between
    FL_KEY_INTEGER, // int, likewise
    FL_KEY_SWITCH,  // bool: on or off, and other words of fl_text_bool()
    FL_KEY_COLOUR,  // uint8_t[3]: #rrggbb
    FL_KEY_WORD,    // an enum
} FlKeyType;

/** A key of a section. */
typedef struct FlTableKey {
    const char *name;
    FlKeyType type;
    size_t offset;     // of the field
    double min, max;   // inclusive, of a number; min: also the value of the first word
    int least, most;   // number of numbers; 0: one
    const char *words; // with | between, in the enum's order
    unsigned flag;     // for the caller
} FlTableKey;

/** The type and the field of a key. */
#define FL_KEY_OF(kind, type, field) FL_KEY_##kind, offsetof(type, field)

/** All keys of a section. */
typedef struct FlKeyTable {
    const FlTableKey *key;
    size_t n; // FL_MOST_KEYS at most
} FlKeyTable;

#define FL_MOST_KEYS 32

/** A section that is read. */
typedef struct FlKeySection {
    const char *name;
    const FlKeyTable *table;
    void *object;    // the struct with the fields
    FlError mistake; // the error code
    /** Takes every key where there is no table; errors as of fl_key_section_set(). */
    bool (*take)(void *object, const char *name, const char *value, GError **error);
    int n_values[FL_MOST_KEYS]; // of each key; 0: it is not given
} FlKeySection;

/** Sets a key's field. Returns: the key; NULL with section->mistake, which names no file. */
const FlTableKey *fl_key_section_set(FlKeySection *section, const char *name, const char *value,
                                     GError **error);

/** The number of values that a key of the table has been given; 0: none. */
int fl_key_section_count(const FlKeySection *section, const char *name);

/** Reads the n sections of a key file; others, such as a tool's own, are left out. Returns: false
 * with section->mistake or FL_ERROR_INPUT, which names file and line. */
bool fl_key_sections_read(const char *path, FlKeySection *section, int n, GError **error);

/** Appends "key = value" lines of the texts that are not NULL, and of the words and numbers that
 * differ from those of `usual`, which may be NULL. Keys with one of the flags are left out. Each
 * key has one value. */
void fl_key_table_write(const FlKeyTable *table, const void *object, const void *usual,
                        unsigned flags, GString *text);

/* ---- key files ------------------------------------------------------------------------------- */

/** The callbacks of a reader; each returns false with an error that names no file or line. */
typedef struct FlKeyReader {
    /** A "[name]" line; name has no outer spaces. */
    bool (*section)(void *data, const char *name, int line, GError **error);
    /** A "key = value" line below the last section; neither has outer spaces; value may be "". */
    bool (*entry)(void *data, const char *key, const char *value, int line, GError **error);
    void *data;
    FlError mistake;        // the error code for syntax errors
    const FlFileWait *wait; // for a pipe; NULL: only a regular file will do
    const char *text;       // of the file, which is then not read; NULL: it is read
} FlKeyReader;

/**
 * Reads a UTF-8 file from top to bottom. Lines that are empty or start with # or ; are comments; a
 * value goes to the end of its line. A file of more than 1 MiB is refused.
 *
 * Returns: false with the first error, "FILE:LINE: …" in front; FL_ERROR_INPUT when the file cannot
 * be read, reader->mistake for syntax errors, or the error of the reader.
 */
bool fl_key_file_read(const char *path, const FlKeyReader *reader, GError **error);

/** Items between semicolons, without outer spaces; empty ones are left out. g_strfreev(). */
char **fl_key_file_list(const char *value);
