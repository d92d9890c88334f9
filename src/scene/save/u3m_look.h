/* u3m_look.h - a material in the parameters of the principled shader, which U3M has, and what they cannot say */
#pragma once

#include "scene/record/scene.h"

/* A material in these parameters. An input whose texture was a colour and is now a number is the colour's luminance. */
typedef struct U3mLook {
    Material material; /* of workflow disney; textures are the scene's */
    bool luminance[INPUT_COUNT];
    bool gloss; /* the coat's width is clearcoat_gloss; otherwise it is clearcoat_roughness */
} U3mLook;

/* Returns the look of a material: as it is if it is of the principled shader. Otherwise the reflectance of a dielectric
 * becomes specular, and the luminance of a sheen's colour the sheen, whose tint is the share of the base colour in it. */
U3mLook u3m_look(const Material *material);

/* Warns of what a U3M cannot say of a material, in a line each. name is the subject. */
void u3m_look_lost(const Material *material, const char *name, const WeftLog *log);
