/* doctor_repair.c - repairs findings: values of the JSON, and pictures with the wrong channel */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "gltf/save/rewrite.h"
#include "measure/doctor/doctor.h"

/* Follows one step of a JSON pointer; adds the value if it is missing and `make` is true. */
static json_t *step(json_t *from, const char *key, bool make) {
    if (json_is_array(from)) return json_array_get(from, (size_t)strtoul(key, NULL, 10));
    if (!json_object_get(from, key) && make) json_object_set_new(from, key, json_object());
    return json_object_get(from, key);
}

/* Returns the object that has the last key of a pointer, and sets key to it. The doctor's pointers need no escapes. */
static json_t *parent_of(json_t *root, const char *pointer, char key[64]) {
    json_t *at = root;
    while (at && *pointer == '/') {
        size_t length = strcspn(++pointer, "/");
        snprintf(key, 64, "%.*s", (int)length, pointer);
        pointer += length;
        if (*pointer) at = step(at, key, true);
    }
    return at;
}

/* Returns a number as short JSON: 0.42, not 0.41999998688697815; or the old value if it is equal. */
static json_t *number(double value, json_t *old) {
    char text[32];
    snprintf(text, sizeof text, "%.6g", value);
    double rounded = strtod(text, NULL);
    if (json_is_number(old) && fabs(json_number_value(old) - rounded) <= 0.0) return json_incref(old);
    return fabs(rounded - floor(rounded)) <= 0.0 ? json_integer((json_int_t)rounded) : json_real(rounded);
}

static json_t *numbers(const Repair *repair, const json_t *old) {
    json_t *array = json_array();
    for (int k = 0; k < repair->count; k++)
        json_array_append_new(array, number(repair->numbers[k], json_array_get(old, (size_t)k)));
    return array;
}

/* Makes an image of one channel, as alpha and as grey, so that a person sees it too. */
static WeftResult alpha_image(const WeftImage *from, int channel, const char *name, WeftImage *out, WeftError *error) {
    WeftPixelType type = from->type == WEFT_PIXEL_U16 ? WEFT_PIXEL_U16 : WEFT_PIXEL_U8;
    WeftResult result = weft_image_create(from->width, from->height, 2, type, out, error);
    size_t count = (size_t)from->width * (size_t)from->height, stride = (size_t)from->channels;
    size_t at = from->channels < 3 ? 0 : (size_t)channel;
    if (result != WEFT_OK) return result;
    if (from->type == WEFT_PIXEL_F32) {
        weft_image_free(out);
        return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, name, "a picture of floats");
    }
    for (size_t k = 0; k < count; k++)
        for (size_t c = 0; c < 2; c++) {
            if (type == WEFT_PIXEL_U16)
                ((uint16_t *)out->pixels)[2 * k + c] = ((const uint16_t *)from->pixels)[stride * k + at];
            else
                ((uint8_t *)out->pixels)[2 * k + c] = ((const uint8_t *)from->pixels)[stride * k + at];
        }
    return WEFT_OK;
}

/* Returns true if two repairs need the same image with the same sampler. */
static bool same_move(const WeftDoctor *doctor, const Repair *a, const Repair *b) {
    if (a->act != REPAIR_ALPHA || b->act != REPAIR_ALPHA || a->channel != b->channel) return false;
    const TextureSource *x = &doctor->asset.textures[a->texture], *y = &doctor->asset.textures[b->texture];
    return x->image == y->image && x->sampler == y->sampler;
}

/* Returns the texture that an earlier finding about the same image was given, so that materials still share
 * it; -1 if there is none. */
static int moved_before(const WeftDoctor *doctor, const Rewrite *rewrite, int finding) {
    for (int k = 0; k < finding; k++) {
        char key[64] = "";
        if (!same_move(doctor, &doctor->repairs[k], &doctor->repairs[finding])) continue;
        json_t *object = parent_of(rewrite->root, doctor->items[k].place, key);
        return (int)json_integer_value(json_object_get(json_object_get(object, key), "index"));
    }
    return -1;
}

/* Makes a texture for a repair, sampled as before, and sets *made to its index. */
static WeftResult alpha_texture(const WeftDoctor *doctor, Rewrite *rewrite, const Repair *repair, int *made,
                                WeftError *error) {
    const char *name = doctor->asset.name;
    int texture = doctor->asset.textures[repair->texture].scene_texture;
    WeftImage image = {0};
    WeftResult result = alpha_image(&doctor->scene->images[doctor->scene->textures[texture].image], repair->channel,
                                    name, &image, error);
    if (result == WEFT_OK) result = rewrite_image(rewrite, &image, 1, true, repair->texture, made, error);
    weft_image_free(&image);
    return result;
}

static WeftResult move_to_alpha(const WeftDoctor *doctor, Rewrite *rewrite, json_t *info, int finding,
                                WeftError *error) {
    int texture = moved_before(doctor, rewrite, finding);
    WeftResult result = WEFT_OK;
    if (texture < 0) result = alpha_texture(doctor, rewrite, &doctor->repairs[finding], &texture, error);
    if (result == WEFT_OK && json_object_set_new(info, "index", json_integer(texture)) != 0)
        result = fail(error, WEFT_MESSAGE_MEMORY, doctor->asset.name, NULL);
    return result;
}

WeftResult doctor_repair(const WeftDoctor *doctor, Rewrite *rewrite, int finding, WeftError *error) {
    const Repair *repair = &doctor->repairs[finding];
    char key[64] = "";
    if (repair->act == REPAIR_NONE) return WEFT_OK;
    if (repair->act == REPAIR_DECLARE) return rewrite_uses(rewrite, repair->extension, error);
    json_t *object = parent_of(rewrite->root, doctor->items[finding].place, key);
    int failed = 0;
    switch (repair->act) {
    case REPAIR_NUMBER: failed = json_object_set_new(object, key, number(repair->numbers[0], NULL)); break;
    case REPAIR_NUMBERS:
        failed = json_object_set_new(object, key, numbers(repair, json_object_get(object, key)));
        break;
    case REPAIR_REMOVE: failed = json_object_del(object, key); break;
    case REPAIR_ALPHA: return move_to_alpha(doctor, rewrite, json_object_get(object, key), finding, error);
    case REPAIR_NONE:
    case REPAIR_DECLARE: break;
    }
    return failed ? fail(error, WEFT_MESSAGE_MEMORY, doctor->asset.name, NULL) : WEFT_OK;
}
