/* returned.h - rewrites functions that fill a record so that they return it
 *
 *   void ggx_prepare(Ggx m, inout GgxPrepared p) { ... }     GgxPrepared ggx_prepare(Ggx m) { ... }
 *   GgxPrepared p;                                           GgxPrepared p = ggx_prepare(m);
 *   ggx_prepare(m, p); */
#pragma once

#include "text/passes/items.h"
#include "text/source/buffer.h"

/* Appends the rewritten text that the items were cut from. A function fills a record if its last parameter is the only
 * one that it writes to, it returns nothing, and every call passes a record that nothing was written to before.
 *
 * all: rewrites each other function that writes to one parameter and returns nothing, for languages without references.
 * It keeps the parameter, for the earlier contents:
 *
 *   void slot_add(inout Slot s, float x) { ... }             Slot slot_add(Slot s, float x) { ... return s; }
 *   slot_add(m.coat, x);                                     m.coat = slot_add(m.coat, x); */
void returned_put(const Items *items, const char *text, bool all, Buffer *out);
