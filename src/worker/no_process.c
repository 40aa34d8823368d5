/* Where drawings are read in this process; process.c starts others. */
#include "worker/process.h"

const char fl_process_lacks[] = "this build has no sandbox";

bool fl_process_may_fork(void)
{
    return false;
}

bool fl_process_start(FlProcess *process)
{
    return false;
}

void fl_process_stop(FlProcess *process)
{
}

void fl_process_pack_orders(GByteArray *out, bool confined, bool required, const char *const *paths)
{
}

bool fl_memory_file_set(int file, const void *data, size_t bytes)
{
    return false;
}

uint8_t *fl_memory_file_get(int file, size_t *bytes)
{
    return NULL;
}
