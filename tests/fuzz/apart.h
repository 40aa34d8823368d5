/* Runs a target in a child process: the libraries below us end it with some drawings. */
#ifndef FLUIDY_TESTS_APART_H
#define FLUIDY_TESTS_APART_H

#include <stddef.h>
#include <stdint.h>

/**
 * Calls `run` in a child process with one thread, and returns when it has ended well; what it
 * covered counts as covered here. The child stays for further calls, all with the same function.
 *
 * The program reads drawings in a child process too, so that an input with which librsvg panics,
 * cairo asserts or libxml2 recurses is one line for its user: such an input is passed over here.
 * So is one whose time or memory a library takes. Whose fault an end is, the innermost function says
 * that is neither the C library's, GLib's nor a sanitizer's. Where that is ours, where a sanitizer
 * or our own assertion has spoken, or where memory leaks in a replay, this process ends with SIGABRT.
 */
void fuzz_apart(void (*run)(const uint8_t *data, size_t size), const uint8_t *data, size_t size);

#endif
