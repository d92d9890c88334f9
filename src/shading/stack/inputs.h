/* inputs.h - the inputs and choices of a material
 *
 * SURFACE_INPUTS lists its numbers and textures, SURFACE_CHOICES the ids that choose its models. The records, --set,
 * material files, docs, menus and sliders are made from these two lists. */
#ifndef WEFT_SHADING_INPUTS_H
#define WEFT_SHADING_INPUTS_H

/* P(kind, name, default, low, high, hard_low, hard_high, help): low .. high is the plausible range, beyond
 * which a value is taken with a warning up to the hard range; colours use one number for all three channels.
 * SCALAR is a float, COLOR an Rgb, NORMAL a unit Dir in the tangent frame, DIRECTION an angle in a plane, the
 * tangent's unless the help names another, given as the Dir (cos, sin, 0), ANGLE a float in radians. The
 * ranges of angles are in degrees. */
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
    P(SCALAR, reflectance, 0.26f, 0.0f, 1.0f, -0.34f, 19.66f,                                                \
      "of the dielectric where ior is 0: F0 = 0.017 + 0.05 reflectance")                                     \
    P(SCALAR, ior, 0.0f, 0.0f, 2.5f, 0.0f, 1e6f,                                                             \
      "index of refraction of the dielectric; 0: see reflectance")                                           \
    P(SCALAR, extinction, 3.0f, 0.0f, 10.0f, 0.0f, 100.0f, "k of a metal's complex index, for f=conductor")  \
    P(SCALAR, specular, 1.0f, 0.0f, 1.0f, 0.0f, 2.0f,                                                        \
      "strength of the dielectric's reflection; disney: F0 = 0.08 specular")                                 \
    P(COLOR, specular_color, 1.0f, 0.0f, 1.0f, 0.0f, 1000.0f,                                                \
      "tint of the dielectric's reflection; specular workflow: its F0")                                      \
    P(SCALAR, specular_tint, 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, "disney: base colour in the reflection")          \
    P(SCALAR, subsurface, 0.0f, 0.0f, 1.0f, 0.0f, 1.0f,                                                      \
      "disney: flattened subsurface; diffuse=wrap: the amount of wrap")                                      \
    P(SCALAR, diffuse_transmission, 0.0f, 0.0f, 1.0f, 0.0f, 1.0f,                                            \
      "share of the diffuse light that goes through cloth in place of back")                                 \
    P(COLOR, diffuse_transmission_color, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, "colour of the light that does")      \
    P(SCALAR, anisotropy, 0.0f, 0.0f, 1.0f, 0.0f, 1.0f,                                                      \
      "stretch of the highlight along anisotropy_direction")                                                 \
    P(DIRECTION, anisotropy_direction, 0.0f, 0.0f, 360.0f, -1e6f, 1e6f, "angle from the tangent, degrees")   \
    P(SCALAR, clearcoat, 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, "amount of clear coat, ior 1.5")                      \
    P(SCALAR, clearcoat_roughness, 0.0f, 0.0f, 1.0f, 0.0f, 2.0f, "of the coat")                              \
    P(SCALAR, clearcoat_gloss, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, "disney: gloss of the coat")                    \
    P(NORMAL, clearcoat_normal, 1.0f, 0.0f, 2.0f, -8.0f, 8.0f, "strength of the coat's own normal map")      \
    P(SCALAR, sheen, 1.0f, 0.0f, 1.0f, 0.0f, 10.0f, "amount of sheen, a factor on its colour")               \
    P(SCALAR, sheen_tint, 0.5f, 0.0f, 1.0f, 0.0f, 1.0f, "disney: base colour in the sheen")                  \
    P(COLOR, sheen_second, 1.0f, 0.0f, 1.0f, 0.0f, 1000.0f,                                                  \
      "second colour of a sheen that has two: at grazing, or of the weft yarns")                             \
    P(COLOR, sheen_color, 0.0f, 0.0f, 1.0f, 0.0f, 1000.0f, "colour of the sheen; black is none")             \
    P(SCALAR, sheen_roughness, 0.0f, 0.0f, 1.0f, 0.0f, 2.0f,                                                 \
      "of the sheen; each lobe says what alpha it becomes")                                                  \
    P(SCALAR, sheen_beta, 0.0f, 0.0f, 20.0f, 0.0f, 100.0f,                                                   \
      "beta of an exponential sheen; 0: mix(0.5, 20, sheen_roughness)")                                      \
    P(SCALAR, sheen_density, 1.0f, 0.25f, 4.0f, 0.01f, 8.0f, "of the fibres of a sheen that has a density")  \
    P(SCALAR, sheen_tail, 0.6f, 0.25f, 4.0f, 0.25f, 4.0f,                                                    \
      "of a sheen that has a tail: how fast its highlight falls, 0.5 loose fibres, 2 as ggx")                \
    P(SCALAR, sheen_rise, 3.0f, 1.0f, 6.0f, 1.0f, 6.0f,                                                      \
      "of such a sheen: the power by which sheen_second comes in")                                           \
    P(SCALAR, diffuse_retro, 0.3f, 0.0f, 6.0f, 0.0f, 6.0f, "diffuse=body: the peak towards the light")       \
    P(SCALAR, diffuse_lift, 0.3f, 0.0f, 8.0f, 0.0f, 8.0f,                                                    \
      "diffuse=body: how much brighter it is where light and viewer part")                                   \
    P(ANGLE, nap, 0.0f, 0.0f, 45.0f, 0.0f, 90.0f, "how far the fibres of a sheen lean over, degrees")        \
    P(DIRECTION, nap_direction, 0.0f, 0.0f, 360.0f, -1e6f, 1e6f,                                             \
      "where they lean to: angle from the tangent, degrees")                                                 \
    P(SCALAR, dust, 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, "amount of dust on what looks up, over everything else")   \
    P(COLOR, dust_color, 0.6f, 0.0f, 1.0f, 0.0f, 1.0f, "colour of the dust")                                 \
    P(SCALAR, dust_roughness, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, "1: grains, less: lint that stands upright")     \
    P(SCALAR, dust_falloff, 1.0f, 0.5f, 8.0f, 0.1f, 64.0f,                                                   \
      "how fast it thins as the surface turns away: a power of the cosine")                                  \
    P(ANGLE, dust_tilt, 0.0f, 0.0f, 90.0f, 0.0f, 180.0f,                                                     \
      "how far from straight above (+y) it comes, degrees")                                                  \
    P(DIRECTION, dust_direction, 0.0f, 0.0f, 360.0f, -1e6f, 1e6f,                                            \
      "from where then: angle from the world's +x to +z, degrees")                                           \
    P(SCALAR, dust_noise, 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, "strength of its patches: 0 even, 1 bare between")   \
    P(SCALAR, dust_scale, 0.05f, 0.001f, 10.0f, 1e-4f, 1e4f, "distance of its largest patches, metres")

/* C(name, help). The value is an index into a list of the catalogue, or CHOICE_AUTO: what the workflow, or
 * the profile, says. So a choice that is made wins over a profile. */
#define SURFACE_CHOICES(C)                                                                                   \
    C(workflow, "how the inputs make a base; auto is metallic")                                              \
    C(profile, "an engine's exact composition in place of a workflow")                                       \
    C(diffuse, "the diffuse term")                                                                           \
    C(d, "distribution of the specular lobe")                                                                \
    C(v, "visibility of the specular lobe")                                                                  \
    C(f, "Fresnel term of the specular lobe")                                                                \
    C(sheen_lobe, "the lobe of the sheen")                                                                   \
    C(sheen_d, "distribution of a sheen of free terms; auto is charlie")                                     \
    C(sheen_v, "visibility of a sheen of free terms; auto is neubelt")                                       \
    C(sheen_f, "Fresnel term of a sheen of free terms; auto is none")                                        \
    C(layer, "the rule by which the sheen sits on the base")                                                 \
    C(layer_by, "which colour the rule takes: max, the strongest channel, or channel, each its own")         \
    C(convert, "turn the inputs of workflow metallic or specular into those of the other one first")

#define CHOICE_AUTO (-1)

#endif
