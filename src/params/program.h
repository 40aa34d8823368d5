/* What the programs need of the library and no other program does: it changes with them. */
#ifndef FLUIDY_PARAMS_PROGRAM_H
#define FLUIDY_PARAMS_PROGRAM_H

#include <fluidy/render.h>

/** Which scheduler a plan is printed for. */
typedef enum FlFarm {
    FL_FARM_SLURM,  /**< a script for bash that calls sbatch */
    FL_FARM_OPENJD, /**< an Open Job Description template, 2023-09 */
    FL_FARM_JSON,   /**< commands as lists of words, for everything else */
} FlFarm;

/**
 * A render as tasks for several machines: each paints some regions into files of paint, the largest
 * first, and a merge composes them. Reads the drawing and checks the options; writes nothing.
 *
 * command: the words of the command line of the whole render, NULL-terminated.
 * Returns: to be freed with g_free(); NULL with an error of FL_ERROR.
 */
FL_API char *fl_farm_plan(const FlRenderOptions *options, FlFarm farm, const char *const *command,
                          GError **error);

/**
 * The page of a report that is live, HTML: a list of regions, controls, and the film. It asks
 * `state`, `options` and `choice` beside its own address; see inspect/live.html.
 *
 * Returns: to be freed with g_bytes_unref().
 */
FL_API GBytes *fl_live_page(void);

#endif
