/* field.h - a place in the JSON of a glTF file: typed reading that knows its own path for messages
 *
 * A Field is a value on the stack that points at its parent's Field, which must outlive it. An absent field
 * reads as its default. A wrong type is a sticky GLTF_SCHEMA failure that names the path, as in
 * "materials[3].pbrMetallicRoughness.roughnessFactor: expected a number"; a number outside the schema's
 * range is clamped with a warning. */
#ifndef WEFT_GLTF_FIELD_H
#define WEFT_GLTF_FIELD_H

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

/* object.extensions.NAME */
Field field_extension(const Field *object, const char *name);

/* The elements of an array; 0 where absent. */
size_t field_count(const Field *array);

/* An integer in [low, high]; outside it is a failure. Reals with an integer value count as integers. */
size_t field_size(const Field *field, size_t absent, size_t low, size_t high);

/* An index below count, -1 where absent, else GLTF_REFERENCE. */
int field_index(const Field *field, size_t count);

/* Works as field_index, but fails if the field is absent. */
int field_needed_index(const Field *field, size_t count);

bool field_bool(const Field *field, bool absent);
const char *field_text(const Field *field, const char *absent);
double field_number(const Field *field, double absent, double low, double high);

/* Exactly count numbers into out, which keeps its values where the field is absent; whether it is there. */
bool field_floats(const Field *field, float *out, size_t count, float low, float high);
bool field_doubles(const Field *field, double *out, size_t count);

/* A failure or warning whose detail starts with the field's path. */
__attribute__((format(printf, 3, 4))) void field_fail(const Field *field, WeftMessage message,
                                                      const char *detail, ...);
__attribute__((format(printf, 3, 4))) void field_warn(const Field *field, WeftMessage message,
                                                      const char *detail, ...);

#endif
