#include "inspect/page_script.h"
#include "params/program.h"

static void append(GByteArray *page, GBytes *part)
{
    gsize n = 0;
    const guint8 *data = g_bytes_get_data(part, &n);
    g_byte_array_append(page, data, (guint)n);
    g_bytes_unref(part);
}

GBytes *fl_live_page(void)
{
    GByteArray *page = g_byte_array_new();
    append(page, fl_page_part(FL_PAGE_HEAD));
    append(page, fl_page_file("live.html"));
    append(page, fl_page_part(FL_PAGE_REST));
    return g_byte_array_free_to_bytes(page);
}
