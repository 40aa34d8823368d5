/* How the program's threads wait for each other. */
#ifndef FLUIDY_CLI_WAIT_H
#define FLUIDY_CLI_WAIT_H

/**
 * Has OpenMP's threads sleep while they wait, unless the environment says otherwise: busy waiting
 * takes the processors from other jobs. The library of gcc reads that before main() and has no
 * function for it, so that the program starts itself once more; where it cannot, threads wait as
 * they do. To be called first of all.
 */
void fl_wait_asleep(char **argv);

#endif
