/* material.h - what a surface is made of, as a table of inputs: each a number or a texture times a number
 *
 * MATERIAL_INPUTS is the one list; the struct, --set, the docs and (later) sliders and uniforms come from it.
 */
#ifndef WEFT_SCENE_MATERIAL_H
#define WEFT_SCENE_MATERIAL_H

#include <stdbool.h>
#include <stdint.h>

#include "scene/texture.h"

/* SCALAR: value[0] times one channel.  COLOR: linear RGB times the sRGB-decoded texture.
 * NORMAL: value[0] scales x and y of 2 t - 1; without a texture the surface is smooth.
 * DIRECTION: value[0] is an angle (radians, from the tangent towards the bitangent) added to that of 2 t.rg
 * - 1. */
typedef enum InputKind { INPUT_SCALAR, INPUT_COLOR, INPUT_NORMAL, INPUT_DIRECTION } InputKind;

/* P(kind, name, default, low, high, help): low .. high is the plausible range; colours use one number for all
 * three channels. */
#define MATERIAL_INPUTS(P)                                                                                   \
    P(COLOR, base_color, 0.8f, 0.0f, 1.0f, "diffuse colour of a dielectric, reflectance of a metal")         \
    P(SCALAR, opacity, 1.0f, 0.0f, 1.0f, "coverage, 0 lets everything through")                              \
    P(SCALAR, metallic, 0.0f, 0.0f, 1.0f, "0 dielectric, 1 metal")                                           \
    P(SCALAR, roughness, 0.5f, 0.0f, 1.0f, "of the base; alpha = roughness^2")                               \
    P(NORMAL, normal, 1.0f, 0.0f, 2.0f, "strength of the normal map")                                        \
    P(SCALAR, occlusion, 1.0f, 0.0f, 1.0f, "strength of baked occlusion (real-time renderer only)")          \
    P(COLOR, emission, 0.0f, 0.0f, 1.0f, "radiance sent out, before emission_strength")                      \
    P(SCALAR, emission_strength, 1.0f, 0.0f, 100.0f, "factor on emission")                                   \
    P(SCALAR, ior, 1.5f, 1.0f, 2.5f, "index of refraction of the dielectric")                                \
    P(SCALAR, specular, 1.0f, 0.0f, 1.0f, "strength of the dielectric's reflection")                         \
    P(COLOR, specular_color, 1.0f, 0.0f, 1.0f, "tint of the dielectric's reflection at normal incidence")    \
    P(SCALAR, anisotropy, 0.0f, 0.0f, 1.0f, "stretch of the highlight along anisotropy_direction")           \
    P(DIRECTION, anisotropy_direction, 0.0f, 0.0f, 6.2831853f, "angle from the tangent")                     \
    P(SCALAR, clearcoat, 0.0f, 0.0f, 1.0f, "amount of clear coat, ior 1.5")                                  \
    P(SCALAR, clearcoat_roughness, 0.0f, 0.0f, 1.0f, "of the coat")                                          \
    P(NORMAL, clearcoat_normal, 1.0f, 0.0f, 2.0f, "strength of the coat's own normal map")                   \
    P(COLOR, sheen_color, 0.0f, 0.0f, 1.0f, "colour of the sheen; black is none")                            \
    P(SCALAR, sheen_roughness, 0.0f, 0.0f, 1.0f, "of the sheen; each lobe says what alpha it becomes")

typedef enum InputId {
#define INPUT_ENUM(kind, name, def, low, high, help) INPUT_##name,
    MATERIAL_INPUTS(INPUT_ENUM)
#undef INPUT_ENUM
        INPUT_COUNT
} InputId;

typedef struct InputInfo {
    InputKind kind;
    const char *name, *help;
    float def, low, high;
} InputInfo;

extern const InputInfo input_infos[INPUT_COUNT];

typedef struct Input {
    float value[3];
    int texture;      /* index into the scene's textures + 1; 0 is none */
    uint8_t texcoord; /* UV set, 0 or 1 */
    uint8_t channel;  /* of the texture, for SCALAR: 0 r, 1 g, 2 b, 3 a */
    /* (u', v') = (m0 u + m1 v + m2, m3 u + m4 v + m5) before the texture is read */
    float transform[6];
} Input;

typedef enum AlphaMode { ALPHA_OPAQUE = 0, ALPHA_MASK, ALPHA_BLEND } AlphaMode;

typedef struct Material {
    const char *name; /* never NULL, may be empty */
    AlphaMode alpha_mode;
    float alpha_cutoff; /* MASK: opacity below it is nothing, from it on everything */
    bool double_sided;  /* else seen only from the front */
    bool unlit;         /* base_color is shown as it is */
    bool vertex_color_ignored;
    int sheen_lobe; /* index into the registry of shading/registry.h */
    int layer;      /* index into the layer rules of shading/layer.h */
    Input inputs[INPUT_COUNT];
} Material;

/* A material with every default: identity texture transforms, no textures, opaque, single-sided, sheen lobe
 * charlie-conty-kulla under layer albedo-view as KHR_materials_sheen says. */
Material material_default(const char *name);

#endif
