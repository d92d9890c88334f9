/* material.h - the material of a surface: each input of shading/inputs.h as a number or a texture times a
 * number */
#ifndef WEFT_SCENE_MATERIAL_H
#define WEFT_SCENE_MATERIAL_H

#include <stdbool.h>
#include <stdint.h>

#include "scene/texture.h"
#include "shading/input_ids.h"

/* The rule by which an input's value and texture give the number or direction at a point. SCALAR, ANGLE
 * (radians): value[0] times one channel.  COLOR: linear RGB times the sRGB-decoded texture. NORMAL: value[0]
 * scales x and y of 2 t - 1; without a texture the surface is smooth. DIRECTION: value[0] is an angle
 * (radians, from the tangent towards the bitangent) added to that of 2 t.rg - 1. */
typedef enum InputKind { INPUT_SCALAR, INPUT_COLOR, INPUT_NORMAL, INPUT_DIRECTION, INPUT_ANGLE } InputKind;

typedef struct InputInfo {
    const char *name, *help;
    InputKind kind;
    float def;
    float low, high;           /* plausible; angles in degrees */
    float hard_low, hard_high; /* values are clamped to this */
} InputInfo;

extern const InputInfo input_infos[INPUT_COUNT];

typedef struct Input {
    float value[3];
    int texture;      /* index into the scene's textures + 1; 0 is none */
    uint8_t texcoord; /* UV set, 0 or 1 */
    uint8_t channel;  /* of the texture, for SCALAR and ANGLE: 0 r, 1 g, 2 b, 3 a */
    bool given;       /* by the user: no workflow has a default of its own for it */
    /* (u', v') = (m0 u + m1 v + m2, m3 u + m4 v + m5) before the texture is read */
    float transform[6];
} Input;

typedef enum AlphaMode { ALPHA_OPAQUE = 0, ALPHA_MASK, ALPHA_BLEND } AlphaMode;

typedef struct Material {
    const char *name; /* never NULL, may be empty */
    AlphaMode alpha_mode;
    float alpha_cutoff;        /* MASK: opacity below it is nothing, from it on everything */
    bool double_sided;         /* else seen only from the front */
    bool unlit;                /* base_color is shown as it is */
    int choices[CHOICE_COUNT]; /* indices into the catalogue (shading/choice.h) or CHOICE_AUTO */
    Input inputs[INPUT_COUNT];
} Material;

/* A material with every default: identity texture transforms, no textures, opaque, single-sided, nothing
 * chosen. */
Material material_default(const char *name);

/* Index of an input by name, or -1. */
int material_input(const char *name);

/* Makes a choice. Inputs that mean something else to a workflow (disney, and profile disney-2012: specular
 * 0.5, sheen 0; specular and free: specular_color 0.03) move from default to default, unless they are given,
 * hold a texture or another value. */
void material_choose(Material *material, ChoiceId choice, int value);

#endif
