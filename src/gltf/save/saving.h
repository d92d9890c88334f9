/* saving.h - a scene while it is written as glTF: the JSON so far, and the bytes of its buffer
 *
 * Failures are sticky, as in asset.h: saving->result keeps the first, writers go on, and the caller tests it
 * at the end. */
#pragma once

#include <jansson.h>

#include "scene/record/scene.h"

typedef struct Saving {
    const WeftScene *scene;
    const char *path;
    bool packed; /* .glb: everything is in one file; else a .bin and images are beside it */
    WeftResult result;
    WeftError *error;
    json_t *root;
    unsigned char *bytes; /* of the buffer; `capacity` of them are allocated */
    size_t size, capacity;
    Arena arena;
    int *texture_order;  /* the textures of the scene that are used, in the order of the file */
    int *texture_number; /* of each texture of the scene, its number in the file, or -1 */
    int *image_order;    /* the same for images */
    int *image_number;
    int texture_count, image_count;
} Saving;

void saving_fail(Saving *saving, WeftMessage message, const char *subject, const char *detail);

/* Sets object[key] to value, which it takes over. A value of NULL is a failure to allocate. */
void saving_put(Saving *saving, json_t *object, const char *key, json_t *value);
void saving_append(Saving *saving, json_t *array, json_t *value);

/* Sets object.name, unless name is empty or no UTF-8. */
void saving_name(Saving *saving, json_t *object, const char *name);

/* Returns an array of count numbers, each the exact value of the float. */
json_t *saving_floats(const float *values, int count);

/* Returns the array of that name at the root, created on first use; borrowed, NULL after a failure. */
json_t *saving_list(Saving *saving, const char *name);

/* Adds an extension to extensionsUsed, unless it is there. */
void saving_uses(Saving *saving, const char *extension);

/* Sets object.extensions[name] to value, and adds the extension to extensionsUsed. */
void saving_extend(Saving *saving, json_t *object, const char *name, json_t *value);

/* Appends bytes to the buffer, and zeros up to a multiple of 4. */
void saving_bytes(Saving *saving, const void *data, size_t size);

/* Appends bytes to the buffer, aligned to 4, with a view of their own, whose index it returns. target: of the
 * specification, 0: none. */
int saving_view(Saving *saving, const void *data, size_t size, int target);

/* Saves the parts, which are called in this order, because later ones refer to earlier ones. */
void textures_save(Saving *saving);
void materials_save(Saving *saving);
void nodes_save(Saving *saving);

/* Returns the path of a file beside the one that is written, with the same name but `end` instead of its suffix; the
 * second function returns how the JSON refers to a path. Both are in the arena, NULL after a failure. */
char *saving_beside(Saving *saving, const char *end);
char *saving_uri(Saving *saving, const char *path);

/* Puts a picture where the object of an image names it: inside the file, or in one of that number and suffix beside it. */
void saving_picture(Saving *saving, json_t *object, bool inside, int number, const void *bytes, size_t size,
                    const char *media, const char *suffix);

/* Writes a file, completely or not at all. */
void saving_write(Saving *saving, const char *path, const void *head, size_t head_size, const void *body,
                  size_t body_size);
