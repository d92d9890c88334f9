/* saving.h - one scene while it is written as glTF: the JSON so far, and the bytes it speaks of
 *
 * Failures are sticky, as in asset.h: the first is kept, writers go on, and the end asks saving->result. */
#ifndef WEFT_GLTF_SAVING_H
#define WEFT_GLTF_SAVING_H

#include <jansson.h>

#include "scene/record/scene.h"

typedef struct Saving {
    const WeftScene *scene;
    const char *path;
    bool packed; /* .glb: everything is in one file; else a .bin and pictures are beside it */
    WeftResult result;
    WeftError *error;
    json_t *root;
    unsigned char *bytes; /* of the buffer */
    size_t size, room;
    Arena arena;
    int *texture_order,
        *texture_number;             /* the scene's textures that are used; of each its number here, or -1 */
    int *image_order, *image_number; /* the same of images */
    int texture_count, image_count;
} Saving;

void saving_fail(Saving *saving, WeftMessage message, const char *subject, const char *detail);

/* object[key] = value, which is taken over; NULL is a want of memory. */
void saving_put(Saving *saving, json_t *object, const char *key, json_t *value);
void saving_append(Saving *saving, json_t *array, json_t *value);

/* "name", unless it is empty. */
void saving_name(Saving *saving, json_t *object, const char *name);

/* count numbers, exactly. */
json_t *saving_floats(const float *values, int count);

/* The list of that name at the root, made when first asked for; borrowed, NULL after a failure. */
json_t *saving_list(Saving *saving, const char *name);

/* Notes that an extension is used, once. */
void saving_uses(Saving *saving, const char *extension);

/* object.extensions[name] = value. */
void saving_extend(Saving *saving, json_t *object, const char *name, json_t *value);

/* Puts bytes at the end of the buffer, and zeros up to a multiple of 4. */
void saving_bytes(Saving *saving, const void *data, size_t size);

/* Puts bytes at the end of the buffer, aligned to 4, as a view of their own: its index. target: of the
 * specification, 0: none. */
int saving_view(Saving *saving, const void *data, size_t size, int target);

/* The parts, in the order in which they refer to one another. */
void textures_save(Saving *saving);
void materials_save(Saving *saving);
void nodes_save(Saving *saving);

/* A file beside the one that is written, called like it but for `end` in the place of its suffix, in the
 * arena; and how its JSON calls it. */
char *saving_beside(Saving *saving, const char *end);
char *saving_uri(Saving *saving, const char *path);

/* Writes a whole file, complete or not at all. */
void saving_write(Saving *saving, const char *path, const void *head, size_t head_size, const void *body,
                  size_t body_size);

#endif
