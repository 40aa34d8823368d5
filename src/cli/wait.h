/* How the program's threads wait for each other. */
#ifndef FLUIDY_CLI_WAIT_H
#define FLUIDY_CLI_WAIT_H

/**
 * Has OpenMP's threads sleep while they wait, unless the environment says otherwise: busy waiting
 * takes the processors from other jobs. gcc's libgomp reads the policy before main() and has no
 * function for it, so the program executes itself again; where that fails, threads wait busily. To
 * be called first of all.
 */
void fl_wait_asleep(char **argv);

#endif
