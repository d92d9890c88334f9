/* surface.h - a material's inputs at one point as numbers, and its choices */
#pragma once

#include "shading/dialect/angles.h"
#include "shading/stack/inputs.h"

/* The kinds of inputs.h as types. */
#define SCALAR    float
#define COLOR     Rgb
#define NORMAL    Dir
#define DIRECTION Dir
#define ANGLE     float

#define SURFACE_FIELD(kind, name, label, initial, low, high, hard_low, hard_high, role, help) kind name;
STRUCT(Surface){SURFACE_INPUTS(SURFACE_FIELD)};

#define CHOICE_FIELD(name, help) int name;
STRUCT(Choices){SURFACE_CHOICES(CHOICE_FIELD)};

/* Returns choices of which none is made. */
#define CHOICE_UNMADE(name, help) c.name = CHOICE_AUTO;
FN Choices choices_unmade(void) {
    Choices c;
    SURFACE_CHOICES(CHOICE_UNMADE)
    return c;
}

/* Returns the surface without glass and what only glTF's coming extensions have, but for fuzz, which a choice decides. */
FN Surface surface_without_coming(Surface s) {
    s.diffuse_roughness = 0.0f;
    s.retroreflection = 0.0f;
    s.transmission = 0.0f;
    s.coat_ior = 1.5f;
    s.coat_color.r = 1.0f;
    s.coat_color.g = 1.0f;
    s.coat_color.b = 1.0f;
    s.coat_darkening = 0.0f;
    s.coat_anisotropy = 0.0f;
    return s;
}
