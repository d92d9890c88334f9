/* unused.h - a text without the members of records, parameters and variables that it never reads */
#pragma once

#include "text/passes/items.h"
#include "text/source/buffer.h"

/* Appends the text that the items were cut from, without some members, parameters and variables that kept items do not
 * read. Returns false, and appends nothing, if there are none. Cut and keep the text again, and repeat until there are
 * none, since a removed part may have been the only one to read another. Items kept by name keep their parameters, the
 * records named in whole (ended by NULL) their members, and every record one member. */
bool unused_cut(const Items *items, const char *text, const char *const *whole, Buffer *out);
