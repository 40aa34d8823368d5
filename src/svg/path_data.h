/* The grammar of path data, to find where a broken `d` breaks. */
#ifndef FLUIDY_SVG_PATH_DATA_H
#define FLUIDY_SVG_PATH_DATA_H

/** Returns: NULL if d is good SVG path data (empty is), else where it goes wrong. */
const char *fl_path_data_error(const char *d);

#endif
