#include "gltf/asset/field.h"

#include <float.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/fail.h"
#include "base/json.h"

Field field_root(Asset *asset) { return (Field){.asset = asset, .json = asset->root}; }

/* Writes the path, root first, cut short where it does not fit. Returns the number of characters used. */
static size_t path(const Field *field, char *out, size_t size) {
    if (!field->parent) {
        out[0] = 0;
        return 0;
    }
    size_t used = path(field->parent, out, size), left = size - used;
    const char *dot = used ? "." : "";
    int wrote = !field->key        ? snprintf(out + used, left, "[%zu]", field->index)
                : field->extension ? snprintf(out + used, left, "%sextensions.%s", dot, field->key)
                                   : snprintf(out + used, left, "%s%s", dot, field->key);
    if (wrote < 0) wrote = 0;
    return (size_t)wrote < left ? used + (size_t)wrote : size - 1;
}

enum { PATH_SIZE = 160, LINE_SIZE = 400 };

static void place(const Field *field, char *line, const char *detail, va_list arguments) {
    size_t used = path(field, line, PATH_SIZE);
    if (used) {
        memcpy(line + used, ": ", 3);
        used += 2;
    }
    vsnprintf(line + used, LINE_SIZE - used, detail, arguments);
}

void field_fail(const Field *field, WeftMessage message, const char *detail, ...) {
    char line[LINE_SIZE];
    va_list arguments;
    va_start(arguments, detail);
    place(field, line, detail, arguments);
    va_end(arguments);
    asset_fail(field->asset, message, "%s", line);
}

void field_warn(const Field *field, WeftMessage message, const char *detail, ...) {
    char line[LINE_SIZE];
    va_list arguments;
    va_start(arguments, detail);
    place(field, line, detail, arguments);
    va_end(arguments);
    field->asset->place = field;
    warn(field->asset->log, message, field->asset->name, "%s", line);
    field->asset->place = NULL;
}

static void expected(const Field *field, const char *what) {
    char text[JSON_SHOWN];
    field_fail(field, WEFT_MESSAGE_GLTF_SCHEMA, "%s %s%s", field->json ? "expected" : "missing", what,
               json_but(field->json, text));
}

Field field_member(const Field *object, const char *key) {
    Field member = {.asset = object->asset, .parent = object, .key = key};
    if (!object->json) return member;
    if (json_is_object(object->json))
        member.json = json_object_get(object->json, key);
    else
        expected(object, "an object");
    return member;
}

Field field_element(const Field *array, size_t index) {
    return (Field){.asset = array->asset,
                   .parent = array,
                   .index = index,
                   .json = array->json ? json_array_get(array->json, index) : NULL};
}

Field field_extension(const Field *object, const char *name) {
    Field extensions = field_member(object, "extensions");
    Field extension = field_member(&extensions, name);
    extension.parent = object;
    extension.extension = true;
    if (extension.json && !json_is_object(extension.json)) {
        expected(&extension, "an object");
        extension.json = NULL;
    }
    return extension;
}

size_t field_count(const Field *array) {
    if (!array->json) return 0;
    if (!json_is_array(array->json)) expected(array, "an array");
    return json_array_size(array->json);
}

size_t field_size(const Field *field, size_t absent, size_t low, size_t high) {
    if (!field->json) return absent;
    double value = json_number_value(field->json); /* 0 for what is not a number */
    /* 2^53: up to here a double holds every integer, and no size is larger. */
    bool fits = json_is_number(field->json) && value >= 0.0 && value <= 0x1p53;
    if (fits && value == (double)(size_t)value && (size_t)value >= low && (size_t)value <= high) return (size_t)value;
    char text[64];
    if (high == SIZE_MAX)
        snprintf(text, sizeof text, "an integer from %zu", low);
    else
        snprintf(text, sizeof text, "an integer from %zu to %zu", low, high);
    expected(field, text);
    return absent;
}

int field_index(const Field *field, size_t count) {
    if (!field->json) return -1;
    size_t index = field_size(field, 0, 0, SIZE_MAX);
    if (index < count && index <= INT32_MAX) return (int)index;
    field_fail(field, WEFT_MESSAGE_GLTF_REFERENCE, "%zu of %zu", index, count);
    return -1;
}

int field_needed_index(const Field *field, size_t count) {
    if (!field->json) expected(field, "an index");
    return field_index(field, count);
}

bool field_bool(const Field *field, bool absent) {
    if (!field->json) return absent;
    if (!json_is_boolean(field->json)) expected(field, "true or false");
    return json_is_true(field->json);
}

const char *field_text(const Field *field, const char *absent) {
    if (!field->json) return absent;
    if (json_is_string(field->json)) return json_string_value(field->json);
    expected(field, "a string");
    return absent;
}

static int index_of(const char *text, const char *const *names) {
    int k = 0;
    while (names[k] && strcmp(text, names[k]) != 0) k++;
    return names[k] ? k : -1;
}

int field_choice(const Field *field, const char *const *names, int absent, const char *what) {
    const char *text = field_text(field, NULL);
    int index = text ? index_of(text, names) : absent;
    char list[160] = "";
    if (!text || index >= 0) return index;
    for (int k = 0; names[k]; k++)
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", k ? ", " : "", names[k]);
    if (absent < 0)
        field_warn(field, WEFT_MESSAGE_GLTF_WARN_IGNORED, "\"%.40s\" is none of %s; the %s is left out", text, list,
                   what);
    else
        field_warn(field, WEFT_MESSAGE_GLTF_WARN_REPAIRED, "\"%.40s\" is none of %s; it is taken as %s", text, list,
                   names[absent]);
    return absent;
}

void field_keys(const Field *object, const char *const *known) {
    const char *key;
    json_t *value;
    json_object_foreach(object->json, key, value) {
        Field member = {.asset = object->asset, .parent = object, .key = key, .json = value};
        if (index_of(key, known) < 0) field_warn(&member, WEFT_MESSAGE_GLTF_WARN_IGNORED, "it means nothing here");
    }
}

double field_number(const Field *field, double absent, double low, double high) {
    if (!field->json) return absent;
    if (!json_is_number(field->json)) {
        expected(field, "a number");
        return absent;
    }
    double value = json_number_value(field->json);
    if (value >= low && value <= high) return value;
    double clamped = value < low ? low : high;
    field_warn(field, WEFT_MESSAGE_GLTF_WARN_REPAIRED, "%g is taken as %g", value, clamped);
    return clamped;
}

/* Returns true if the field exists and is an array of count numbers. */
static bool numbers(const Field *field, size_t count) {
    if (!field->json) return false;
    if (json_is_array(field->json) && json_array_size(field->json) == count) return true;
    char text[48];
    snprintf(text, sizeof text, "an array of %zu numbers", count);
    expected(field, text);
    return false;
}

bool field_floats(const Field *field, float *out, size_t count, float low, float high) {
    if (!numbers(field, count)) return false;
    for (size_t i = 0; i < count; i++) {
        Field element = field_element(field, i);
        out[i] = (float)field_number(&element, (double)low, (double)low, (double)high);
    }
    return true;
}

bool field_doubles(const Field *field, double *out, size_t count) {
    if (!numbers(field, count)) return false;
    for (size_t i = 0; i < count; i++) {
        Field element = field_element(field, i);
        out[i] = field_number(&element, 0.0, -(double)FLT_MAX, (double)FLT_MAX);
    }
    return true;
}
