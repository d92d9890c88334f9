/* set.h - setting a material's inputs and choices, with warnings about implausible values */
#pragma once

#include "scene/record/scene.h"

/* Returns true if name is that of material k, its decimal index, or "*". */
bool material_matches(const WeftScene *scene, int k, const char *name);

/* Sets the value of a choice from an id, an alias or "auto". Fails with WEFT_MESSAGE_PARAM_VALUE. */
WeftResult choice_value(ChoiceId choice, const char *id, int *value, WeftError *error);

/* Reads "#rrggbb", encoded in sRGB, as a linear colour. Returns false for anything else. */
bool hex_color(const char *text, float color[3]);

/* Converts a number given for an input or of hair: clamps it to the hard range, warns about target if it is beyond the plausible
 * range or the limit, and converts degrees to radians. Any DIRECTION is plausible. */
float number_ranged(const WeftInputInfo *info, float value, const char *target, const WeftLog *log);

/* The input, the choice or the number of hair that a setting names; the others are -1. */
typedef struct Setting {
    int input, choice, hair, value; /* value: of the choice */
    float v[3];
} Setting;

/* Reads the value for an input, choice or number of hair called name. Fails with WEFT_MESSAGE_PARAM_NAME or _PARAM_VALUE; target is the
 * subject of warnings. */
WeftResult setting_read(const char *name, const char *value, const char *target, Setting *setting, const WeftLog *log,
                        WeftError *error);
void material_set(Material *material, const Setting *setting);

/* Warns about implausible values of a material that involve one setting, an input or a choice; the other is -1. */
void plausible_check(const Material *material, int input, int choice, const char *target, const WeftLog *log);

/* Checks the inputs that a file names, a flag for each of SURFACE_INPUTS, and reports each finding once. */
void plausible_check_named(const Material *material, const bool *named, const char *file, const WeftLog *log);

/* Checks all settings and reports each finding once. */
void plausible_check_all(const Material *material, const char *target, const WeftLog *log);
