/* cloth_reflection.h - prepares the reflection of a woven material in a thread of its own, since a cloth takes a while */
#pragma once

#include "view/render/loader.h"
#include "weft/reflection.h"

typedef struct ClothReflection ClothReflection;

/* Starts; copies what it needs. Wakes the window when it is done. NULL where memory or threads are short. */
ClothReflection *cloth_reflection_start(const WeftMaterial *material, const FactCloth *cloth, Window *window);
bool cloth_reflection_done(ClothReflection *self);

/* Waits for it and returns the reflection, owned; NULL where memory is short. */
WeftReflection *cloth_reflection_end(ClothReflection *self);
