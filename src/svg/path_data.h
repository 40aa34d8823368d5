/* The grammar of path data: its commands, and where a broken `d` breaks. */
#pragma once

/** Receives one step: a command letter, lower case if relative, and its arguments (A has 7, Z has
 * 0). */
typedef void FlPathStep(void *data, char command, const double *v);

/**
 * Calls `step` for every step of d in order. Further pairs after M come as L.
 *
 * Returns: NULL if d is good SVG path data (empty is) of finite numbers, else where it goes wrong,
 * after the calls for the steps before.
 */
const char *fl_path_data_walk(const char *d, FlPathStep *step, void *data);

/** Returns: NULL if d is good SVG path data (empty is), else where it goes wrong. */
const char *fl_path_data_error(const char *d);

/**
 * wa * a + wb * b of path data, number by number, whether steps are absolute or relative; flags of
 * arcs are set where either one is. Returns: NULL unless both are good and have the same steps; to
 * be freed.
 */
char *fl_path_data_combine(const char *a, const char *b, double wa, double wb);
