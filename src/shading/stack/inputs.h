/* inputs.h - the inputs and choices of a material
 *
 * SURFACE_INPUTS lists its numbers and textures, SURFACE_CHOICES the ids that choose its models. The records, --set,
 * material files, docs, menus and sliders are made from these two lists. */
#pragma once

/* P(kind, name, label, initial, low, high, hard_low, hard_high, role, help)
 *
 * kind: SCALAR is a float, COLOR an Rgb, NORMAL a unit Dir in the tangent frame, DIRECTION an angle in a plane, the
 * tangent's unless the help names another, given as the Dir (cos, sin, 0), ANGLE a float in radians.
 * label: the input in the window, in words of artists.
 * low .. high: the plausible range. A value beyond it is taken with a warning, up to the hard range. Colours use one
 * number for all three channels. The ranges of angles are in degrees.
 * role: SHAPE if the albedo of base or sheen depends on the input. HALF and MIX do so too, and a surface shows each of
 * its lobes where HALF is 1/2 and MIX any of 0, 1/2 and 1. WHOLE is the amount of a layer over these: 1 shows it. NONE
 * is any other input. */
#define SURFACE_INPUTS(P)                                                                                              \
    P(COLOR, base_color, "colour", 0.8f, 0.0f, 1.0f, 0.0f, 1.0f, HALF,                                                 \
      "diffuse colour of a dielectric, reflectance of a metal")                                                        \
    P(SCALAR, opacity, "opacity", 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, NONE, "coverage, 0 lets everything through")           \
    P(SCALAR, metallic, "metalness", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, MIX, "0 dielectric, 1 metal")                       \
    P(SCALAR, roughness, "roughness", 0.5f, 0.0f, 1.0f, 0.0f, 2.0f, SHAPE, "of the base; alpha = roughness^2")         \
    P(NORMAL, normal, "bumps, normal", 1.0f, 0.0f, 2.0f, -8.0f, 8.0f, NONE, "strength of the normal map")              \
    P(SCALAR, occlusion, "creases, occlusion", 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, NONE,                                     \
      "strength of baked occlusion, which the raster engine has until it has traced rays")                             \
    P(COLOR, emission, "glow, emission", 0.0f, 0.0f, 1.0f, 0.0f, 1e6f, NONE,                                           \
      "radiance sent out, before emission_strength")                                                                   \
    P(SCALAR, emission_strength, "emission strength", 1.0f, 0.0f, 100.0f, 0.0f, 1e6f, NONE, "factor on emission")      \
    P(SCALAR, reflectance, "reflectance", 0.26f, 0.0f, 1.0f, -0.34f, 19.66f, SHAPE,                                    \
      "of the dielectric where ior is 0: F0 = 0.017 + 0.05 reflectance")                                               \
    P(SCALAR, ior, "refraction, ior", 0.0f, 0.0f, 2.5f, 0.0f, 1e6f, SHAPE,                                             \
      "index of refraction of the dielectric; 0: see reflectance")                                                     \
    P(SCALAR, extinction, "extinction k", 3.0f, 0.0f, 10.0f, 0.0f, 100.0f, SHAPE,                                      \
      "k of a metal's complex index, for f=conductor")                                                                 \
    P(SCALAR, specular, "specular", 1.0f, 0.0f, 1.0f, 0.0f, 2.0f, SHAPE,                                               \
      "strength of the dielectric's reflection; disney: F0 = 0.08 specular")                                           \
    P(COLOR, specular_color, "specular colour", 1.0f, 0.0f, 1.0f, 0.0f, 1000.0f, HALF,                                 \
      "tint of the dielectric's reflection; specular workflow: its F0")                                                \
    P(SCALAR, specular_tint, "specular tint", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, SHAPE,                                     \
      "disney: base colour in the reflection")                                                                         \
    P(SCALAR, diffuse_roughness, "matt roughness", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, WHOLE,                                \
      "of the diffuse lobe: 0 as lambert, above it as eon")                                                            \
    P(SCALAR, retroreflection, "light turned back", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, WHOLE,                               \
      "share of the base's light that returns towards the lamp, as of high-visibility cloth")                          \
    P(SCALAR, subsurface, "subsurface", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, MIX,                                             \
      "disney: flattened subsurface; diffuse=wrap: the amount of wrap")                                                \
    P(SCALAR, diffuse_transmission, "light through cloth", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, HALF,                         \
      "share of the diffuse light that goes through cloth in place of back")                                           \
    P(COLOR, diffuse_transmission_color, "colour of that light", 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, SHAPE,                  \
      "colour of the light that does")                                                                                 \
    P(SCALAR, transmission, "glass, light through", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, HALF,                                \
      "share of the light below the reflection that goes through as through glass, in base_color")                     \
    P(SCALAR, thickness, "glass, thickness", 0.0f, 0.0f, 1.0f, 0.0f, 1e6f, NONE,                                       \
      "metres; 0: a thin sheet that bends no light; above: solid, bends light by ior")                                 \
    P(COLOR, attenuation_color, "glass, colour inside", 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, NONE,                            \
      "what is left of white light after attenuation_distance inside solid glass")                                     \
    P(SCALAR, attenuation_distance, "glass, distance of it", 0.0f, 0.0f, 1.0f, 0.0f, 1e6f, NONE,                       \
      "metres that light goes for attenuation_color; 0: nothing is absorbed inside")                                   \
    P(SCALAR, anisotropy, "stretch, anisotropy", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, MIX,                                    \
      "stretch of the highlight along anisotropy_direction")                                                           \
    P(DIRECTION, anisotropy_direction, "stretch direction", 0.0f, 0.0f, 360.0f, -1e6f, 1e6f, NONE,                     \
      "angle from the tangent, degrees")                                                                               \
    P(SCALAR, clearcoat, "coat amount", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, WHOLE, "amount of clear coat")                   \
    P(SCALAR, clearcoat_roughness, "clearcoat roughness", 0.0f, 0.0f, 1.0f, 0.0f, 2.0f, NONE, "of the coat")           \
    P(SCALAR, clearcoat_gloss, "clearcoat gloss", 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, NONE, "disney: gloss of the coat")     \
    P(NORMAL, clearcoat_normal, "clearcoat normal", 1.0f, 0.0f, 2.0f, -8.0f, 8.0f, NONE,                               \
      "strength of the coat's own normal map")                                                                         \
    P(SCALAR, coat_ior, "coat ior", 1.5f, 1.0f, 2.5f, 1.0f, 100.0f, NONE, "index of refraction of the coat")           \
    P(COLOR, coat_color, "coat colour", 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, NONE,                                            \
      "what the coat lets through, down and up again")                                                                 \
    P(SCALAR, coat_darkening, "coat darkening", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, NONE,                                    \
      "how much the base darkens by light that the coat throws back to it")                                            \
    P(SCALAR, coat_anisotropy, "coat stretch", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, NONE,                                     \
      "stretch of the coat's highlight along coat_anisotropy_direction")                                               \
    P(DIRECTION, coat_anisotropy_direction, "coat stretch direction", 0.0f, 0.0f, 360.0f, -1e6f, 1e6f, NONE,           \
      "angle from the tangent, degrees")                                                                               \
    P(SCALAR, sheen, "sheen amount", 1.0f, 0.0f, 1.0f, 0.0f, 10.0f, SHAPE, "amount of sheen, a factor on its colour")  \
    P(SCALAR, sheen_tint, "sheen tint", 0.5f, 0.0f, 1.0f, 0.0f, 1.0f, SHAPE, "disney: base colour in the sheen")       \
    P(COLOR, sheen_second, "second colour", 1.0f, 0.0f, 1.0f, 0.0f, 1000.0f, SHAPE,                                    \
      "second colour of a sheen that has two: at grazing, or of the weft yarns")                                       \
    P(COLOR, sheen_color, "sheen colour", 0.0f, 0.0f, 1.0f, 0.0f, 1000.0f, HALF, "colour of the sheen; black is none") \
    P(SCALAR, sheen_roughness, "sheen roughness", 0.0f, 0.0f, 1.0f, 0.0f, 2.0f, HALF,                                  \
      "of the sheen; each lobe says what alpha it becomes")                                                            \
    P(SCALAR, fuzz, "fuzz amount", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, WHOLE,                                                \
      "amount of fuzz, fibres that stand up over everything but dust; it takes the place of the sheen")                \
    P(COLOR, fuzz_color, "fuzz colour", 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, HALF, "colour of the fuzz; black darkens")       \
    P(SCALAR, fuzz_roughness, "fuzz roughness", 0.5f, 0.0f, 1.0f, 0.0f, 1.0f, HALF, "of the fuzz: its alpha itself")   \
    P(SCALAR, sheen_beta, "sheen beta", 0.0f, 0.0f, 20.0f, 0.0f, 100.0f, SHAPE,                                        \
      "beta of an exponential sheen; 0: mix(0.5, 20, sheen_roughness)")                                                \
    P(SCALAR, sheen_density, "density of fibres", 1.0f, 0.25f, 4.0f, 0.01f, 8.0f, SHAPE,                               \
      "of the fibres of a sheen that has a density")                                                                   \
    P(SCALAR, sheen_tail, "tail of highlight", 0.6f, 0.25f, 4.0f, 0.25f, 4.0f, SHAPE,                                  \
      "of a sheen that has a tail: how fast its highlight falls, 0.5 loose fibres, 2 as ggx")                          \
    P(SCALAR, sheen_rise, "rise to second colour", 3.0f, 1.0f, 6.0f, 1.0f, 6.0f, SHAPE,                                \
      "of such a sheen: the power by which sheen_second comes in")                                                     \
    P(SCALAR, diffuse_retro, "glow towards the light", 0.3f, 0.0f, 6.0f, 0.0f, 6.0f, SHAPE,                            \
      "diffuse=body: the peak towards the light")                                                                      \
    P(SCALAR, diffuse_lift, "glow away from it", 0.3f, 0.0f, 8.0f, 0.0f, 8.0f, SHAPE,                                  \
      "diffuse=body: how much brighter it is where light and viewer part")                                             \
    P(SCALAR, sheen_upward, "only on what faces up", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, NONE,                               \
      "1: the sheen lies as dust does, its amount times max(n . d, 0)^dust_falloff")                                   \
    P(ANGLE, nap, "nap, lean of fibres", 0.0f, 0.0f, 45.0f, 0.0f, 90.0f, SHAPE,                                        \
      "how far the fibres of a sheen lean over, degrees")                                                              \
    P(DIRECTION, nap_direction, "nap direction", 0.0f, 0.0f, 360.0f, -1e6f, 1e6f, NONE,                                \
      "where they lean to: angle from the tangent, degrees")                                                           \
    P(SCALAR, dust, "dust", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, WHOLE,                                                       \
      "amount of dust on what looks up, over everything else")                                                         \
    P(COLOR, dust_color, "dust colour", 0.6f, 0.0f, 1.0f, 0.0f, 1.0f, NONE, "colour of the dust")                      \
    P(SCALAR, dust_roughness, "dust roughness", 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, NONE,                                    \
      "1: grains, less: lint that stands upright")                                                                     \
    P(SCALAR, dust_falloff, "dust falloff", 1.0f, 0.5f, 8.0f, 0.1f, 64.0f, NONE,                                       \
      "how fast it thins as the surface turns away: a power of the cosine")                                            \
    P(ANGLE, dust_tilt, "dust tilt", 0.0f, 0.0f, 90.0f, 0.0f, 180.0f, NONE,                                            \
      "how far from straight above (+y) it comes, degrees")                                                            \
    P(DIRECTION, dust_direction, "dust direction", 0.0f, 0.0f, 360.0f, -1e6f, 1e6f, NONE,                              \
      "from where then: angle from the world's +x to +z, degrees")                                                     \
    P(SCALAR, dust_noise, "dust noise", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, NONE,                                            \
      "strength of its patches: 0 even, 1 bare between")                                                               \
    P(SCALAR, dust_scale, "dust scale", 0.05f, 0.001f, 10.0f, 1e-4f, 1e4f, NONE,                                       \
      "distance of its largest patches, metres")                                                                       \
    P(SCALAR, wear, "wear of threads", 0.0f, 0.0f, 1.0f, 0.0f, 1.0f, NONE,                                             \
      "of a weave: how far its raised threads have lost their dye, as at edges and folds")

/* C(name, help). The value is an index into a list of the catalogue, or CHOICE_AUTO: what the workflow, or
 * the profile, says. So a choice that is made wins over a profile. */
#define SURFACE_CHOICES(C)                                                                                             \
    C(workflow, "how the inputs make a base; auto is metallic")                                                        \
    C(profile, "an engine's exact composition in place of a workflow")                                                 \
    C(diffuse, "the diffuse term")                                                                                     \
    C(d, "distribution of the specular lobe")                                                                          \
    C(v, "visibility of the specular lobe")                                                                            \
    C(f, "Fresnel term of the specular lobe")                                                                          \
    C(sheen_lobe, "the lobe of the sheen")                                                                             \
    C(sheen_d, "distribution of a sheen of free terms; auto is charlie")                                               \
    C(sheen_v, "visibility of a sheen of free terms; auto is neubelt")                                                 \
    C(sheen_f, "Fresnel term of a sheen of free terms; auto is none")                                                  \
    C(rim, "what lies over the base: auto is fuzz where the material has some, else sheen")                            \
    C(layer, "the rule by which the sheen sits on the base")                                                           \
    C(layer_by, "which colour the rule takes: max, the strongest channel, or channel, each its own; auto is max, of "  \
                "rule multiplicative channel")                                                                         \
    C(convert, "turn the inputs of workflow metallic or specular into those of the other one first")

#define CHOICE_AUTO (-1)
