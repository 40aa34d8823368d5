/* A folder for the files of a target that wants them on disk: in memory where the system has it. */
#ifndef FLUIDY_TESTS_FOLDER_H
#define FLUIDY_TESTS_FOLDER_H

#include <stddef.h>
#include <stdint.h>

/** Makes it at the first call; it is removed with all that is in it when the process exits. */
const char *fuzz_folder(void);

/** Deletes what is in a folder, and the folder itself unless `keep`. */
void fuzz_empty(const char *path, int keep);

/**
 * Writes the PNG pictures among the bytes as FOLDER/1.png, 2.png ..., at most `most`; what stands
 * before the first is a line of options, which goes to *line, to be freed. Returns: how many.
 */
int fuzz_write_pngs(const uint8_t *data, size_t size, const char *folder, int most, char **line);

#endif
