/* slots.h - the slots of a stack (stack.h), and the lobe of each */
#pragma once

#include "shading/catalogue/registry.h"

/* S(name, NAME, Name, wo in the frame of the slot), in the order in which sampling tries them. */
#define SLOTS(S)                                                                                                       \
    S(diffuse, DIFFUSE, Diffuse, o)                                                                                    \
    S(specular, SPECULAR, Specular, o)                                                                                 \
    S(sheen, SHEEN, Sheen, o) S(coat, COAT, Coat, coat_o) S(dust, DUST, Dust, o)

/* A record and a function of the dispatch for the lobe of a slot. A shader has fixed slots and functions of its own
 * for each (text/assemble/dispatch.h). */
#ifndef OF_SLOT
#define OF_SLOT(Name, Record)   Lobe##Record
#define IN_SLOT(name, function) lobe_##function
#endif
