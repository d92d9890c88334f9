/* interrupt.h - Ctrl-C as a request to finish early */
#pragma once

#include <stdbool.h>

/* Catches signals: the first SIGINT, SIGTERM and SIGHUP are only noted, and a second one of a kind ends the program. A
 * SIGHUP that is ignored stays ignored. */
void interrupt_watch(void);

/* Leaves signals to end the program again, as before interrupt_watch. */
void interrupt_unwatch(void);

/* Returns true if the program was interrupted. */
bool interrupt_seen(void);
