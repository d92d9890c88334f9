/* backs.h - materials seen from behind
 *
 * A woven cloth shows its other face there, and a material may be given a back of its own. The backs are materials of the
 * scene, behind all others (scene/record/scene.h), so that renderers prepare them as they prepare any. A back differs in
 * what it reflects: opacity and emission are those of the front, by which rays pass and lights are chosen. */
#pragma once

#include "scene/record/scene.h"

/* Gives each own material of a new scene a place for a back, once. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult backs_make(WeftScene *scene, WeftError *error);

/* Makes the backs that materials have as they are now. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult backs_fit(WeftScene *scene, WeftError *error);

/* Gives a material a back of its own, or takes it away with NULL. backs_fit completes it. */
void back_give(WeftScene *scene, int material, const Material *back);
