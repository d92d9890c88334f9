#include "gltf/read/animation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/asset/accessor.h"
#include "gltf/asset/field.h"

typedef enum Interpolation { LINEAR, STEP, CUBICSPLINE } Interpolation;

/* A sampler whose numbers are decoded. */
typedef struct Sampler {
    Interpolation interpolation;
    size_t keys, width;          /* numbers at each key */
    const float *times, *values; /* with CUBICSPLINE three groups at each key: in-tangent, value, out-tangent */
} Sampler;

/* Returns the numbers at a key. part: of CUBICSPLINE, 0 in-tangent, 1 value, 2 out-tangent. */
static const float *key_values(const Sampler *s, size_t key, size_t part) {
    return s->values + (s->interpolation == CUBICSPLINE ? 3 * key + part : key) * s->width;
}

/* Returns the last key that is not after the time; the first one before all. */
static size_t key_before(const Sampler *s, double time) {
    size_t low = 0, high = s->keys;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if ((double)s->times[middle] <= time)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Interpolates along the shorter arc of unit quaternions; nearly equal ones linearly. */
static void slerp(const float *a, const float *b, double u, double out[4]) {
    double dot = 0.0, from = 1.0 - u, to = u;
    for (int c = 0; c < 4; c++) dot += (double)a[c] * (double)b[c];
    const double angle = acos(fmin(fabs(dot), 1.0)), sine = sin(angle);
    if (sine > 1e-6) {
        from = sin((1.0 - u) * angle) / sine;
        to = sin(u * angle) / sine;
    }
    if (dot < 0.0) to = -to;
    for (int c = 0; c < 4; c++) out[c] = from * (double)a[c] + to * (double)b[c];
}

/* Writes the numbers at a time to out. Before the first key and after the last they are those of that key. */
static void sample(const Sampler *s, double time, bool rotation, double *out) {
    const size_t key = key_before(s, time);
    const double start = (double)s->times[key];
    const bool between = key + 1 < s->keys && time > start;
    const double span = between ? (double)s->times[key + 1] - start : 1.0, u = between ? (time - start) / span : 0.0;
    const float *a = key_values(s, key, 1), *b = between ? key_values(s, key + 1, 1) : a;
    if (between && s->interpolation == LINEAR && rotation) {
        slerp(a, b, u, out);
        return;
    }
    for (size_t c = 0; c < s->width; c++) {
        const double from = (double)a[c], to = (double)b[c];
        out[c] = from;
        if (between && s->interpolation == LINEAR) out[c] = from + u * (to - from);
        if (between && s->interpolation == CUBICSPLINE) {
            const double leaving = span * (double)key_values(s, key, 2)[c];
            const double arriving = span * (double)key_values(s, key + 1, 0)[c], u2 = u * u, u3 = u2 * u;
            out[c] = (2 * u3 - 3 * u2 + 1) * from + (u3 - 2 * u2 + u) * leaving + (3 * u2 - 2 * u3) * to +
                     (u3 - u2) * arriving;
        }
    }
}

/* Reads and decodes a sampler. Returns false after a sticky failure. */
static bool sampler_read(const Field *field, Arena *scratch, Sampler *s) {
    static const char *const names[] = {"LINEAR", "STEP", "CUBICSPLINE", NULL};
    Asset *asset = field->asset;
    Field input = field_member(field, "input"), output = field_member(field, "output"),
          interpolation = field_member(field, "interpolation");
    const int times = field_needed_index(&input, asset->accessor_count),
              values = field_needed_index(&output, asset->accessor_count);
    s->interpolation = (Interpolation)field_choice(&interpolation, names, LINEAR, "");
    if (asset->result != WEFT_OK) return false;
    const Accessor *in = &asset->accessors[times], *out = &asset->accessors[values];
    const size_t groups = in->count * (s->interpolation == CUBICSPLINE ? 3 : 1);
    if (in->columns != 1 || in->rows != 1)
        field_fail(&input, WEFT_MESSAGE_GLTF_SCHEMA, "accessor %d is not of type SCALAR", times);
    if (out->count % groups)
        field_fail(&output, WEFT_MESSAGE_GLTF_SCHEMA, "%zu values for %zu keys", out->count, in->count);
    s->keys = in->count;
    s->width = out->count / groups * out->columns * out->rows;
    s->times = accessor_floats(asset, scratch, times);
    s->values = accessor_floats(asset, scratch, values);
    for (size_t k = 0; k < s->keys && asset->result == WEFT_OK; k++)
        if (!isfinite(s->times[k]) || (k && s->times[k] <= s->times[k - 1]))
            field_fail(&input, WEFT_MESSAGE_GLTF_SCHEMA, "the time of key %zu is not after the one before", k);
    return asset->result == WEFT_OK;
}

/* Cuts the first name off a JSON pointer and undoes its escapes. Returns false at its end. */
static bool name_next(const char **pointer, char name[128]) {
    size_t used = 0;
    if (**pointer != '/') return false;
    for (++*pointer; **pointer && **pointer != '/' && used < 127; ++*pointer) {
        char c = **pointer;
        if (c == '~' && ((*pointer)[1] == '0' || (*pointer)[1] == '1')) c = *++*pointer == '1' ? '/' : '~';
        name[used++] = c;
    }
    name[used] = '\0';
    return true;
}

/* Returns the element of that number, written in digits alone; NULL if there is none. */
static json_t *element_at(json_t *array, const char *name, size_t *index) {
    char *end;
    if (name[0] < '0' || name[0] > '9') return NULL;
    *index = (size_t)strtoull(name, &end, 10);
    return *end ? NULL : json_array_get(array, *index);
}

/* Puts a value, of which the reference is taken, where a JSON pointer points. Objects on the way that are not there are
 * made; elements of arrays must be there. Returns false if the pointer leads nowhere. */
static bool value_put(json_t *root, const char *pointer, json_t *value) {
    enum { DEPTH_MOST = 16 };
    static const char *const roots[] = {"nodes", "materials", "meshes", "cameras", "extensions"};
    char name[128];
    json_t *at = root;
    bool known = false;
    for (int depth = 0; name_next(&pointer, name) && depth < DEPTH_MOST && at; depth++) {
        const bool last = !*pointer;
        size_t index = 0;
        for (size_t k = 0; k < sizeof roots / sizeof *roots; k++) known |= strcmp(name, roots[k]) == 0;
        if (!known || (last && depth == 0)) break;
        json_t *next = json_is_array(at) ? element_at(at, name, &index) : json_object_get(at, name);
        if (last && json_is_object(at)) return json_object_set_new(at, name, value) == 0;
        if (last && next) return json_array_set_new(at, index, value) == 0;
        const bool listed = pointer[0] == '/' && pointer[1] >= '0' && pointer[1] <= '9'; /* `next` would be an array */
        if (!next && !listed && depth && json_is_object(at) && json_object_set_new(at, name, json_object()) == 0)
            next = json_object_get(at, name);
        at = next;
    }
    json_decref(value);
    return false;
}

static bool ends_with(const char *text, const char *end) {
    const size_t length = strlen(text), size = strlen(end);
    return length >= size && strcmp(text + length - size, end) == 0;
}

/* Returns the numbers as the value that the pointer's place has: true or false, a number, or an array. */
static json_t *value_of(const char *pointer, const double *numbers, size_t count) {
    if (ends_with(pointer, "/visible")) return json_boolean(numbers[0] != 0.0);
    if (count == 1 && !ends_with(pointer, "/weights")) return json_real(numbers[0]);
    json_t *array = json_array();
    for (size_t k = 0; k < count; k++) json_array_append_new(array, json_real(numbers[k]));
    return array;
}

enum { POINTER = 512 };

/* Writes where a channel's target lies. Returns false, with a warning, if it is none that can move. */
static bool target_read(const Field *target, char pointer[POINTER]) {
    static const char *const paths[] = {"translation", "rotation", "scale", "weights", "pointer", NULL};
    Asset *asset = target->asset;
    Field node_field = field_member(target, "node"), path = field_member(target, "path"), root = field_root(asset),
          nodes = field_member(&root, "nodes"), extension = field_extension(target, "KHR_animation_pointer"),
          pointed = field_member(&extension, "pointer");
    const int node = field_index(&node_field, field_count(&nodes)), choice = field_choice(&path, paths, -1, "channel");
    if (asset->result != WEFT_OK || choice < 0) return false;
    if (strcmp(paths[choice], "pointer") == 0) {
        snprintf(pointer, POINTER, "%s", field_text(&pointed, ""));
        if (strlen(field_text(&pointed, "")) < POINTER) return true;
        field_warn(&pointed, WEFT_MESSAGE_GLTF_WARN_IGNORED, "it is too long");
        return false;
    }
    Field moved = field_element(&nodes, node < 0 ? 0 : (size_t)node);
    if (node < 0)
        field_warn(target, WEFT_MESSAGE_GLTF_WARN_IGNORED, "it has no node");
    else if (choice < 3 && json_object_get(moved.json, "matrix"))
        field_warn(target, WEFT_MESSAGE_GLTF_WARN_IGNORED, "node %d has a matrix, which does not move", node);
    else
        snprintf(pointer, POINTER, "/nodes/%d/%s", node, paths[choice]);
    return node >= 0 && !(choice < 3 && json_object_get(moved.json, "matrix"));
}

static void channel_apply(const Field *channel, const Field *samplers) {
    Asset *asset = channel->asset;
    Field target = field_member(channel, "target"), sampler_field = field_member(channel, "sampler");
    const int index = field_needed_index(&sampler_field, field_count(samplers));
    char pointer[POINTER];
    Arena scratch = {0};
    Sampler sampler = {.keys = 0};
    if (asset->result != WEFT_OK || !target_read(&target, pointer)) return;
    Field field = field_element(samplers, (size_t)index);
    double *numbers =
        sampler_read(&field, &scratch, &sampler) ? asset_array(asset, &scratch, sampler.width, sizeof *numbers) : NULL;
    if (numbers) {
        sample(&sampler, asset->moment->time, sampler.width == 4 && ends_with(pointer, "/rotation"), numbers);
        for (size_t k = 0; k < sampler.width; k++)
            if (!isfinite(numbers[k])) field_fail(&field, WEFT_MESSAGE_GLTF_SCHEMA, "a value is not finite");
        if (asset->result == WEFT_OK && !value_put(asset->root, pointer, value_of(pointer, numbers, sampler.width)))
            field_warn(&target, WEFT_MESSAGE_GLTF_WARN_IGNORED, "\"%.80s\" leads nowhere", pointer);
    }
    arena_free(&scratch);
}

/* Returns the number of the animation that the moment names; -1 after a sticky failure. */
static int animation_find(Asset *asset, const Field *list) {
    const char *wanted = asset->moment->animation;
    const size_t count = field_count(list);
    char names[256] = "";
    if (!count) asset_fail(asset, WEFT_MESSAGE_GLTF_REFERENCE, "it has no animation");
    if (!wanted || asset->result != WEFT_OK) return asset->result == WEFT_OK ? 0 : -1;
    for (size_t k = 0; k < count; k++) {
        Field animation = field_element(list, k), name_field = field_member(&animation, "name");
        const char *name = field_text(&name_field, "");
        if (*name && strcmp(name, wanted) == 0) return (int)k;
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%zu %.40s", k ? ", " : "", k, name);
    }
    char *end;
    const unsigned long long number = strtoull(wanted, &end, 10);
    if (wanted[0] >= '0' && wanted[0] <= '9' && !*end && number < count) return (int)number;
    asset_fail(asset, WEFT_MESSAGE_GLTF_REFERENCE, "animation \"%.80s\"; there are %s", wanted, names);
    return -1;
}

void animation_apply(Asset *asset) {
    Field root = field_root(asset), list = field_member(&root, "animations");
    if (!asset->moment) {
        if (field_count(&list))
            field_warn(&list, WEFT_MESSAGE_GLTF_WARN_IGNORED, "shown at rest; --time SECONDS shows a moment");
        return;
    }
    const int index = animation_find(asset, &list);
    if (index < 0) return;
    Field animation = field_element(&list, (size_t)index), channels = field_member(&animation, "channels"),
          samplers = field_member(&animation, "samplers");
    const size_t count = field_count(&channels);
    for (size_t k = 0; k < count && asset->result == WEFT_OK; k++) {
        Field channel = field_element(&channels, k);
        channel_apply(&channel, &samplers);
    }
}
