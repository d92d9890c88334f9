/* inputs.h - what a material is described by
 *
 * SURFACE_INPUTS is the one list: records, --set, docs and (later) sliders and uniforms come from it. No
 * dialect in here, so that loaders may include it. */
#ifndef WEFT_SHADING_INPUTS_H
#define WEFT_SHADING_INPUTS_H

/* P(kind, name, default, low, high, hard_low, hard_high, help): low .. high is the plausible range, beyond
 * which a value is taken with a warning up to the hard range; colours use one number for all three channels.
 * SCALAR is a float, COLOR an Rgb, NORMAL a unit Dir in the tangent frame, DIRECTION an angle in the tangent
 * plane given as the Dir (cos, sin, 0). */
#define SURFACE_INPUTS(P)                                                                                    \
    P(COLOR, base_color, 0.8f, 0.0f, 1.0f, 0.0f, 1.0f,                                                       \
      "diffuse colour of a dielectric, reflectance of a metal")                                              \
    P(SCALAR, opacity, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, "coverage, 0 lets everything through")                  \
    P(SCALAR, metallic, 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, "0 dielectric, 1 metal")                               \
    P(SCALAR, roughness, 0.5f, 0.0f, 1.0f, 0.0f, 2.0f, "of the base; alpha = roughness^2")                   \
    P(NORMAL, normal, 1.0f, 0.0f, 2.0f, -8.0f, 8.0f, "strength of the normal map")                           \
    P(SCALAR, occlusion, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f,                                                       \
      "strength of baked occlusion (real-time renderer only)")                                               \
    P(COLOR, emission, 0.0f, 0.0f, 1.0f, 0.0f, 1e6f, "radiance sent out, before emission_strength")          \
    P(SCALAR, emission_strength, 1.0f, 0.0f, 100.0f, 0.0f, 1e6f, "factor on emission")                       \
    P(SCALAR, ior, 1.5f, 1.0f, 2.5f, 1.0f, 100.0f, "index of refraction of the dielectric")                  \
    P(SCALAR, specular, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, "strength of the dielectric's reflection")             \
    P(COLOR, specular_color, 1.0f, 0.0f, 1.0f, 0.0f, 1000.0f,                                                \
      "tint of the dielectric's reflection at normal incidence")                                             \
    P(SCALAR, anisotropy, 0.0f, 0.0f, 1.0f, 0.0f, 1.0f,                                                      \
      "stretch of the highlight along anisotropy_direction")                                                 \
    P(DIRECTION, anisotropy_direction, 0.0f, 0.0f, 360.0f, -1e6f, 1e6f, "angle from the tangent, degrees")   \
    P(SCALAR, clearcoat, 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, "amount of clear coat, ior 1.5")                      \
    P(SCALAR, clearcoat_roughness, 0.0f, 0.0f, 1.0f, 0.0f, 2.0f, "of the coat")                              \
    P(NORMAL, clearcoat_normal, 1.0f, 0.0f, 2.0f, -8.0f, 8.0f, "strength of the coat's own normal map")      \
    P(COLOR, sheen_color, 0.0f, 0.0f, 1.0f, 0.0f, 1000.0f, "colour of the sheen; black is none")             \
    P(SCALAR, sheen_roughness, 0.0f, 0.0f, 1.0f, 0.0f, 2.0f,                                                 \
      "of the sheen; each lobe says what alpha it becomes")

typedef enum InputId {
#define INPUT_ENUM(kind, name, def, low, high, hard_low, hard_high, help) INPUT_##name,
    SURFACE_INPUTS(INPUT_ENUM)
#undef INPUT_ENUM
        INPUT_COUNT
} InputId;

#endif
