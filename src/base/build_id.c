#include "base/build_id.h"

#include "base/digest.h"
#include "config.h"
#include <dlfcn.h>
#include <fluidy/fluidy.h>

const char *fl_version(void)
{
    return FL_VERSION;
}

/* The file of the library; of a program that holds it, where the system tells that one. */
static GMappedFile *map_code(void)
{
    Dl_info own;
    GMappedFile *file = dladdr((const void *)(uintptr_t)fl_build_id, &own)
                            ? g_mapped_file_new(own.dli_fname, FALSE, NULL)
                            : NULL;
    return file ? file : g_mapped_file_new("/proc/self/exe", FALSE, NULL);
}

const char *fl_build_id(void)
{
    static char *id;
    if (!id) {
        FlDigest digest = {0};
        g_autoptr(GMappedFile) file = map_code();
        if (file)
            fl_digest_add(&digest, g_mapped_file_get_contents(file),
                          g_mapped_file_get_length(file));
        id = g_strdup_printf(FL_VERSION " %016" G_GINT64_MODIFIER "x%016" G_GINT64_MODIFIER "x",
                             digest.a, digest.b);
    }
    return id;
}
