/* returned.h - functions that fill a record return it
 *
 *   void ggx_prepare(Ggx m, inout GgxPrepared p) { ... }     GgxPrepared ggx_prepare(Ggx m) { ... }
 *   GgxPrepared p;                                           GgxPrepared p = ggx_prepare(m);
 *   ggx_prepare(m, p); */
#ifndef WEFT_TEXT_RETURNED_H
#define WEFT_TEXT_RETURNED_H

#include "text/passes/items.h"
#include "text/source/buffer.h"

/* Appends the text that the items were cut from. A function fills a record if its last parameter is its only
 * written one, it returns nothing else, and whatever calls it passes what nothing was written to before.
 *
 * all: so does each other function that writes to one parameter and returns nothing, for languages without
 * references. It takes what was written before:
 *
 *   void slot_add(inout Slot s, float x) { ... }             Slot slot_add(Slot s, float x) { ... return s; }
 *   slot_add(m.coat, x);                                     m.coat = slot_add(m.coat, x); */
void returned_put(const Items *items, const char *text, bool all, Buffer *out);

#endif
