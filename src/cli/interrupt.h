/* interrupt.h - Ctrl-C as a request to finish early */
#ifndef WEFT_CLI_INTERRUPT_H
#define WEFT_CLI_INTERRUPT_H

#include <stdbool.h>

/* From now on the first SIGINT and the first SIGTERM are only noted; a second one ends the program. */
void interrupt_watch(void);

/* Whether one has come. */
bool interrupt_seen(void);

#endif
