/* field.h - a place in the JSON of a glTF file: typed reading, with the path of the place in messages
 *
 * A Field is a value on the stack that points at its parent's Field, which must outlive it. An absent field
 * reads as its default. A wrong type is a sticky GLTF_SCHEMA failure with the path, as in
 * "materials[3].pbrMetallicRoughness.roughnessFactor: expected a number, not "rough""; a number outside the schema's
 * range is clamped with a warning, and one of a list's values that is none of them is named in a warning too. Nothing
 * is passed over in silence. */
#pragma once

#include "gltf/asset/asset.h"

typedef struct Field {
    Asset *asset;
    const struct Field *parent; /* NULL: the root */
    const char *key;            /* NULL: an element of an array */
    size_t index;
    bool extension; /* key is the name of an extension of the parent */
    json_t *json;   /* borrowed; NULL: absent */
} Field;

Field field_root(Asset *asset);
Field field_member(const Field *object, const char *key);
Field field_element(const Field *array, size_t index);

/* Returns object.extensions.NAME. */
Field field_extension(const Field *object, const char *name);

/* Returns the number of elements of an array, 0 if it is absent. */
size_t field_count(const Field *array);

/* Returns an integer in [low, high] and fails (sticky) outside. Reals with an integer value count as integers. */
size_t field_size(const Field *field, size_t absent, size_t low, size_t high);

/* Returns an index below count, or -1 if it is absent. Fails with GLTF_REFERENCE if it is not below count. */
int field_index(const Field *field, size_t count);

/* Works as field_index, but fails if the field is absent. */
int field_needed_index(const Field *field, size_t count);

bool field_bool(const Field *field, bool absent);
const char *field_text(const Field *field, const char *absent);

/* Returns the index of the text among names, which end with NULL. An absent field reads as `absent`, and so does any
 * other text, with a warning; where that is -1 the warning says that `what` is left out. */
int field_choice(const Field *field, const char *const *names, int absent, const char *what);

/* Warns of every member of an object that is not among the known names, which end with NULL. */
void field_keys(const Field *object, const char *const *known);

double field_number(const Field *field, double absent, double low, double high);

/* Reads exactly count numbers into out, which keeps its values if the field is absent. Returns true if it is
 * present. */
bool field_floats(const Field *field, float *out, size_t count, float low, float high);
bool field_doubles(const Field *field, double *out, size_t count);

/* Fails or warns with a text that starts with the field's path. */
__attribute__((format(printf, 3, 4))) void field_fail(const Field *field, WeftMessage message, const char *detail, ...);
__attribute__((format(printf, 3, 4))) void field_warn(const Field *field, WeftMessage message, const char *detail, ...);
