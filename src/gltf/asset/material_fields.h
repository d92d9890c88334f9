/* material_fields.h - the numbers and textures of a glTF material, a row for each
 *
 * The reader, the writer, the list of supported extensions and the checks of the doctor are loops over these rows. */
#pragma once

#include <stdbool.h>

#include "shading/stack/input_ids.h"

/* The channels that a field takes of its texture. A colour's factor has a number for each, any other has one number.
 * Colours are encoded in sRGB. */
typedef enum Channels {
    CHANNEL_R,
    CHANNEL_G,
    CHANNEL_B,
    CHANNEL_A,
    CHANNEL_A_GLOSS, /* alpha is glossiness, of which the roughness is 1 less */
    CHANNELS_COLOR,
    CHANNELS_COLOR_ALPHA, /* alpha is the input `opacity` */
    CHANNELS_NORMAL,      /* a vector; the factor scales x and y */
    CHANNELS_DIRECTION    /* a vector in R and G; the factor is an angle that is added, in radians */
} Channels;

enum { NO_INPUT = -1 };

typedef struct MaterialField {
    int input;           /* InputId; NO_INPUT: only the doctor looks at the field */
    const char *object;  /* name of an extension, or pbr_object; NULL: the material */
    const char *factor;  /* key of the numbers; "TEXTURE/KEY" where they lie in the textureInfo */
    const char *texture; /* key of the textureInfo, NULL if there is none */
    Channels channels;
    float absent;    /* each number of an absent factor */
    float low, high; /* what glTF allows of a number; low is -INFINITY where it may be any */
} MaterialField;

/* Fields of one object follow one another, and so do those that share a texture. Ends with a row without a factor. */
extern const MaterialField material_fields[];
extern const char pbr_object[];   /* "pbrMetallicRoughness" */
extern const char gloss_object[]; /* the extension with another workflow, whose fields replace those of others */
extern const char coat_object[];  /* the extension whose coat replaces the clear coat of KHR_materials_clearcoat */

/* Returns true for a row of gloss_object or coat_object, which is read where its object is there. */
bool material_field_replaces(const MaterialField *field);

/* Returns the row of an input that has one: of several, the one that does not replace another. */
const MaterialField *material_field_of(InputId input);

/* Returns what is not shown of a material extension whose rows have no input, as the end of a warning; NULL for any other
 * extension. Its loss is no reason to refuse an asset that requires it. */
const char *material_extension_lost(const char *extension);

/* Returns how many numbers the factor has: 1, 3 or 4. */
int material_field_numbers(const MaterialField *field);

/* Returns true if the field belongs to an extension. */
bool material_field_extends(const MaterialField *field);

/* Returns true if both are fields of one extension, or of pbr_object. */
bool material_fields_share(const MaterialField *a, const MaterialField *b);

/* Returns true if the row before has the same texture. */
bool material_field_repeats(const MaterialField *field);

/* Returns the last part of `factor`, and whether that is a member of the textureInfo. */
const char *material_field_key(const MaterialField *field);
bool material_field_inside(const MaterialField *field);

/* Writes the path of the field's factor or texture from the material, such as "extensions/NAME/KEY". */
enum { FIELD_PATH = 128 };
void material_field_path(const MaterialField *field, const char *key, char path[FIELD_PATH]);
