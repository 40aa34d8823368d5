#include "params/keys.h"

#include "base/each.h"
#include "base/error.h"
#include "params/text.h"

#include <limits.h>

static const FlKey *key_at(const FlKeys *keys, int k)
{
    return &g_array_index(keys->key, FlKey, k);
}

bool fl_keys_are(const char *value)
{
    return g_regex_match_simple("@-?[0-9]+(~[0-9]+)?\\s*$", value, 0, 0);
}

static void clear_key(void *key)
{
    g_free(((FlKey *)key)->value);
}

/* A style must be whole before the next one replaces it. */
static bool check_order(const FlKeys *keys, const FlKey *key, GError **error)
{
    const int n = (int)keys->key->len;
    if (n == 0)
        return key->over == 0 || fl_fail(error, FL_ERROR_USAGE,
                                         "“%s” is the first key: there is none to replace in "
                                         "%d frames",
                                         key->value, key->over);
    const FlKey *before = key_at(keys, n - 1);
    if (key->frame <= before->frame)
        return fl_fail(error, FL_ERROR_USAGE,
                       "frame %d does not come after frame %d, that of the key before", key->frame,
                       before->frame);
    return key->frame >= before->frame + before->over ||
           fl_fail(error, FL_ERROR_USAGE,
                   "frame %d comes before frame %d, in which “%s” is complete", key->frame,
                   before->frame + before->over, before->value);
}

/* Adds the key of a match. */
static bool add_key(FlKeys *keys, const GMatchInfo *match, GError **error)
{
    g_autofree char *frame = g_match_info_fetch(match, 2), *over = g_match_info_fetch(match, 3);
    FlKey key = {.value = g_match_info_fetch(match, 1)};
    bool good = fl_text_integer(frame, INT_MIN / 2, INT_MAX / 2, &key.frame) ||
                fl_fail(error, FL_ERROR_USAGE, "“%s” is not the number of a frame", frame);
    if (good && over && *over && !keys->replace)
        good = fl_fail(error, FL_ERROR_USAGE,
                       "“~%s” is for styles; a number changes evenly from key to key", over);
    else if (good && over && *over)
        good = fl_text_integer(over, 0, 100000, &key.over) ||
               fl_fail(error, FL_ERROR_USAGE, "“~%s” is not a number of frames up to 100000", over);
    if (good && check_order(keys, &key, error)) {
        g_array_append_val(keys->key, key);
        return true;
    }
    g_free(key.value);
    return false;
}

FlKeys *fl_keys_read(const struct FlOption *option, bool replace, const char *text, GError **error)
{
    g_autoptr(FlKeys) keys = g_new0(FlKeys, 1);
    *keys = (FlKeys){option, replace, g_strdup(text), fl_array_of(FlKey, clear_key)};
    g_autoptr(GRegex) form =
        g_regex_new("\\s*(\\S.*?)@(-?[0-9]+)(?:~([0-9]+))?(?:\\s+|$)", 0, 0, NULL);
    g_autoptr(GMatchInfo) match = NULL;
    bool good = g_regex_match(form, text, 0, &match) ||
                fl_fail(error, FL_ERROR_USAGE,
                        "“%s” has no value before its frame; expected VALUE@FRAME", text);
    while (good && g_match_info_matches(match)) {
        good = add_key(keys, match, error);
        g_match_info_next(match, NULL);
    }
    return good ? g_steal_pointer(&keys) : NULL;
}

void fl_keys_free(FlKeys *keys)
{
    if (!keys)
        return;
    g_array_unref(keys->key);
    g_free(keys->text);
    g_free(keys);
}

double fl_keys_amount(const FlKeys *keys, int frame)
{
    const int n = (int)keys->key->len;
    int next = 0;
    while (next < n && key_at(keys, next)->frame <= frame)
        next++;
    const FlKey *a = key_at(keys, MAX(next - 1, 0)), *b = key_at(keys, MIN(next, n - 1));
    if (a == b)
        return a->amount;
    const double share = (frame - a->frame) / ((double)b->frame - a->frame);
    return a->amount + share * (b->amount - a->amount);
}

/* The part of the k-th key's style that has replaced the one before, 0..1. */
static float arrived(const FlKeys *keys, int k, int frame)
{
    const FlKey *key = key_at(keys, k);
    if (k == 0 || frame >= key->frame + key->over)
        return 1;
    return frame <= key->frame ? 0 : (float)(frame - key->frame) / (float)key->over;
}

float fl_keys_share(const FlKeys *keys, int k, int frame)
{
    const bool last = k + 1 == (int)keys->key->len;
    return last ? arrived(keys, k, frame)
                : MIN(arrived(keys, k, frame), 1 - arrived(keys, k + 1, frame));
}
