/* interrupt.h - Ctrl-C as a request to finish early */
#ifndef WEFT_CLI_INTERRUPT_H
#define WEFT_CLI_INTERRUPT_H

#include <stdbool.h>

/* From now on the first SIGINT, the first SIGTERM and the first SIGHUP are only noted; a second one of a kind
 * ends the program. A SIGHUP that is ignored stays so. */
void interrupt_watch(void);

/* Returns true if the program was interrupted. */
bool interrupt_seen(void);

#endif
