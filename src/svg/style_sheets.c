#include "svg/style_sheets.h"

#include "base/file.h"
#include "svg/document.h"
#include "svg/reference.h"
#include <string.h>

#define LARGEST_BYTES (1 << 20) // of a sheet whose own imports are looked for

typedef struct Check {
    const char *path;
    int number;
    GPtrArray *files;
    FlWarnings *warnings;
} Check;

static bool check_imports(const Check *check, const char *from, const char *css, int *length);

/** Adds a sheet and what it imports. Returns: false if librsvg would wait for it. */
static bool check_file(const Check *check, const char *from, const char *href)
{
    bool is_there = false;
    g_autofree char *file = fl_reference_file(from, href, &is_there), *css = NULL;
    size_t bytes = 0;
    if (!file || g_ptr_array_find_with_equal_func(check->files, file, g_str_equal, NULL))
        return true;
    if (is_there && !fl_file_check(file, FL_ERROR_INPUT, NULL))
        return false;
    g_ptr_array_add(check->files, g_strdup(file));
    return !fl_file_read(file, LARGEST_BYTES, &css, &bytes, NULL) ||
           check_imports(check, file, css, NULL);
}

/** What an @import names, after it: "a.css", url(a.css) or url("a.css"); to be freed. */
static char *import_target(const char *text)
{
    text += strspn(text, " \t\r\n");
    if (g_ascii_strncasecmp(text, "url(", 4) == 0)
        text += 4;
    text += strspn(text, " \t\r\n\"'");
    return g_strndup(text, strcspn(text, " \t\r\n\"');"));
}

/**
 * Checks what a sheet imports. Returns: false at the first that librsvg would wait for; *length,
 * unless NULL, is how many bytes come before it.
 */
static bool check_imports(const Check *check, const char *from, const char *css, int *length)
{
    for (const char *at = css; (at = strstr(at, "@import")); at++) {
        g_autofree char *href = import_target(at + strlen("@import"));
        if (length)
            *length = (int)(at - css);
        if (!check_file(check, from, href))
            return false;
    }
    return true;
}

static void warn(const Check *check, const char *what)
{
    fl_warnings_add(check->warnings, check->path, check->number, NULL,
                    "the style sheet “%.60s” is a pipe or a device and is left out", what);
}

/** A <style> element: imports that cannot be read become another rule, which is unknown everywhere.
 */
static void check_style(const Check *check, xmlNode *node)
{
    g_autoptr(xmlChar) css = xmlNodeGetContent(node);
    int at = 0;
    while (css && !check_imports(check, check->path, (const char *)css, &at)) {
        g_autofree char *href = import_target((const char *)css + at + strlen("@import"));
        warn(check, href);
        css[at + 1] = 'x';
        g_autoptr(xmlChar) text = xmlEncodeSpecialChars(node->doc, css);
        xmlNodeSetContent(node, text);
    }
}

static void check_node(const Check *check, xmlNode *node)
{
    if (fl_is(node, "style"))
        check_style(check, node);
    for (xmlNode *child = node->children; child; child = child->next)
        if (child->type == XML_ELEMENT_NODE)
            check_node(check, child);
}

/** A <?xml-stylesheet href="…"?>; one that cannot be read leaves the document. */
static void check_instruction(const Check *check, xmlNode *node)
{
    const char *href = node->content ? strstr((const char *)node->content, "href=") : NULL;
    if (!xmlStrEqual(node->name, (const xmlChar *)"xml-stylesheet") || !href)
        return;
    g_autofree char *target = import_target(href + strlen("href="));
    if (check_file(check, check->path, target))
        return;
    warn(check, target);
    xmlUnlinkNode(node);
    xmlFreeNode(node);
}

void fl_style_sheets_check(xmlDoc *doc, const char *path, int number, GPtrArray *files,
                           FlWarnings *warnings)
{
    const Check check = {path, number, files, warnings};
    for (xmlNode *node = doc->children, *next; node; node = next) {
        next = node->next;
        if (node->type == XML_PI_NODE)
            check_instruction(&check, node);
    }
    check_node(&check, xmlDocGetRootElement(doc));
}
