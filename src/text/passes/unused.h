/* unused.h - a text without what it writes and never reads: members of records, parameters, variables */
#ifndef WEFT_TEXT_UNUSED_H
#define WEFT_TEXT_UNUSED_H

#include "text/passes/items.h"
#include "text/source/buffer.h"

/* Appends the text that the items were cut from, without some of what the kept ones do not read. False where
 * there is nothing of the kind; then nothing is appended. Cut and keep again, and ask again, until there is
 * none: what went may have been all that read something else. Items that are asked for by name keep their
 * parameters, the records named in whole (ended by NULL) their members, and every record one. */
bool unused_cut(const Items *items, const char *text, const char *const *whole, Buffer *out);

#endif
