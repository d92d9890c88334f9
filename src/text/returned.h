/* returned.h - functions that fill a record return it
 *
 *   void ggx_prepare(Ggx m, inout GgxPrepared p) { ... }     GgxPrepared ggx_prepare(Ggx m) { ... }
 *   GgxPrepared p;                                           GgxPrepared p = ggx_prepare(m);
 *   ggx_prepare(m, p); */
#ifndef WEFT_TEXT_RETURNED_H
#define WEFT_TEXT_RETURNED_H

#include "text/buffer.h"
#include "text/items.h"

/* Appends the text that the items were cut from. A function fills a record if its last parameter is its only
 * written one, it returns nothing else, and whatever calls it passes what nothing was written to before. */
void returned_put(const Items *items, const char *text, Buffer *out);

#endif
