/* slots.h - the lobe of each slot of a stack (stack.h)
 *
 * A shader, whose slots hold what its material says and nothing else, supplies these with only that text. */
#ifndef WEFT_SHADING_SLOTS_H
#define WEFT_SHADING_SLOTS_H

#include "shading/registry.h"

FN void diffuse_at(const Lobe *m, const Angles *a, LobeValue *v) { lobe_value_to(m, a, v); }
FN void specular_at(const Lobe *m, const Angles *a, LobeValue *v) { lobe_value_to(m, a, v); }
FN void sheen_at(const Lobe *m, const Angles *a, LobeValue *v) { lobe_value_to(m, a, v); }
FN void coat_at(const Lobe *m, const Angles *a, LobeValue *v) { lobe_value_to(m, a, v); }

#endif
