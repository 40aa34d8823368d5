/* Facts that decide bytes, in words, so that a later run can say what has changed. */
#pragma once

#include "base/digest.h"
#include "base/reader.h"

/** One fact, such as "w-temp of region hair" and "50"; UTF-8. */
typedef struct FlFact {
    char *name, *value;
} FlFact;

/** Facts in a fixed order. */
typedef struct FlFacts {
    GArray *list; // of FlFact
} FlFacts;

FlFacts *fl_facts_new(void);
void fl_facts_free(FlFacts *facts); // NULL is fine

/** Adds copies of both; value NULL: it is not set. */
void fl_facts_add(FlFacts *facts, const char *name, const char *value);
void fl_facts_add_number(FlFacts *facts, const char *name, double value);

/** Adds the digest of a file's contents, under its name. */
void fl_facts_add_digest(FlFacts *facts, const char *name, FlDigest digest);

/** Adds versions of this program, librsvg and cairo, and the byte order. */
void fl_facts_add_versions(FlFacts *facts);

/** Adds the version and a digest of the library's file: programs in which they are equal have the
 * same code. The first call must not run beside another. */
void fl_facts_add_build(FlFacts *facts);

/** Adds all other facts; NULL: none. */
void fl_facts_append(FlFacts *facts, const FlFacts *other);

/** The digest of all facts in their order. */
FlDigest fl_facts_digest(const FlFacts *facts);

/** The first difference, as a clause, to be freed; NULL if all facts are equal. */
char *fl_facts_difference(const FlFacts *before, const FlFacts *now);

void fl_facts_put(GByteArray *out, const FlFacts *facts);

/** The reverse. Returns: to be freed, even if the reader has failed. */
FlFacts *fl_facts_take(FlReader *reader);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlFacts, fl_facts_free)
