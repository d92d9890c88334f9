/* builtin.h - the scenes that need no file */
#pragma once

#include "scene/record/scene.h"

typedef struct Builtin {
    const char *name, *help;
    const unsigned char *glb, *glb_end;                     /* an embedded file, or */
    WeftResult (*make)(WeftScene *scene, WeftError *error); /* a function that fills an empty scene */
} Builtin;

/* Returns the built-in scene at index, or NULL past the end. */
const Builtin *builtin_at(int index);
