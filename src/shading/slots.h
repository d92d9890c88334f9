/* slots.h - the lobe of each slot of a stack (stack.h)
 *
 * A shader, whose slots hold what its material says and nothing else, supplies these with only that text. */
#ifndef WEFT_SHADING_SLOTS_H
#define WEFT_SHADING_SLOTS_H

#include "shading/registry.h"

FN LobeValue diffuse_at(const Lobe *m, Angles a) { return lobe_value(m, a); }
FN LobeValue specular_at(const Lobe *m, Angles a) { return lobe_value(m, a); }
FN LobeValue sheen_at(const Lobe *m, Angles a) { return lobe_value(m, a); }
FN LobeValue coat_at(const Lobe *m, Angles a) { return lobe_value(m, a); }

#endif
