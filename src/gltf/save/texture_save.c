/* texture_save.c - the textures that materials use, their samplers and images */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/save/saving.h"
#include "image/codec.h"
#include "scene/material/relief.h"

/* Gives numbers to the texture and the image of an input, in the order in which a reader finds them, so that
 * it numbers them alike. */
static void number_texture(Saving *saving, const Input *input) {
    if (!input->texture) return;
    int texture = input->texture - 1, image = saving->scene->textures[texture].image;
    if (saving->texture_number[texture] >= 0) return;
    saving->texture_number[texture] = saving->texture_count;
    saving->texture_order[saving->texture_count++] = texture;
    if (saving->image_number[image] >= 0) return;
    saving->image_number[image] = saving->image_count;
    saving->image_order[saving->image_count++] = image;
}

static void number_material(Saving *saving, int material) {
    const WeftScene *scene = saving->scene;
    const Material given = relief_given(scene, material);
    for (int k = 0; k < INPUT_COUNT; k++) number_texture(saving, &given.inputs[k]);
    for (int k = 0; k < INPUT_COUNT && scene_has_back(scene, material); k++)
        number_texture(saving, &scene->materials[scene->material_count + material].inputs[k]);
}

static bool number_all(Saving *saving) {
    const WeftScene *scene = saving->scene;
    size_t textures = (size_t)scene->texture_count, images = (size_t)scene->image_count;
    bool *used = arena_array(&saving->arena, (size_t)scene->material_count, sizeof *used);
    saving->texture_order = arena_array(&saving->arena, textures, sizeof(int));
    saving->texture_number = arena_array(&saving->arena, textures, sizeof(int));
    saving->image_order = arena_array(&saving->arena, images, sizeof(int));
    saving->image_number = arena_array(&saving->arena, images, sizeof(int));
    if (!used || !saving->texture_order || !saving->texture_number || !saving->image_order || !saving->image_number)
        return false;
    for (size_t k = 0; k < textures; k++) saving->texture_number[k] = -1;
    for (size_t k = 0; k < images; k++) saving->image_number[k] = -1;
    for (int m = 0; m < scene->mesh_count; m++) {
        const Mesh *mesh = &scene->meshes[m];
        used[mesh->material] = true;
        for (int v = 0; v < scene->variant_count && mesh->variant_material; v++)
            if (mesh->variant_material[v] >= 0) used[mesh->variant_material[v]] = true;
    }
    for (int idle = 0; idle < 2; idle++) /* unused materials come last */
        for (int m = 0; m < scene->material_count; m++)
            if (used[m] == !idle) number_material(saving, m);
    return true;
}

static void sampler_put(Saving *saving, const Texture *texture, json_t *object) {
    static const int wraps[] = {10497, 33648, 33071}; /* indexed by TextureWrap; of the specification */
    enum { NEAREST = 9728, LINEAR = 9729 };
    if (texture->wrap_u == WRAP_REPEAT && texture->wrap_v == WRAP_REPEAT && !texture->nearest && !texture->single)
        return;
    json_t *list = saving_list(saving, "samplers"), *sampler = json_object(), *other;
    saving_put(saving, sampler, "wrapS", json_integer(wraps[texture->wrap_u]));
    saving_put(saving, sampler, "wrapT", json_integer(wraps[texture->wrap_v]));
    if (texture->nearest) saving_put(saving, sampler, "magFilter", json_integer(NEAREST));
    if (texture->nearest || texture->single)
        saving_put(saving, sampler, "minFilter", json_integer(texture->nearest ? NEAREST : LINEAR));
    size_t index;
    json_array_foreach(list, index, other) {
        if (json_equal(sampler, other)) break;
    }
    if (index < json_array_size(list))
        json_decref(sampler);
    else
        saving_append(saving, list, sampler);
    saving_put(saving, object, "sampler", json_integer((json_int_t)index));
}

/* Encodes an image without loss: 8 or 16 bits as PNG, floats as a NumPy array. Release with free(). */
static char *encode(Saving *saving, const WeftImage *image, size_t *size) {
    const WeftImageWriting how = {.data = 1};
    char *bytes = NULL;
    FILE *stream = open_memstream(&bytes, size);
    if (!stream) {
        saving_fail(saving, WEFT_MESSAGE_MEMORY, saving->path, NULL);
        return NULL;
    }
    WeftResult result = (image->type == WEFT_PIXEL_F32 ? image_write_npy : image_write_png)(stream, saving->path, image,
                                                                                            &how, saving->error);
    if (saving->result == WEFT_OK) saving->result = result;
    if (fclose(stream) != 0) saving_fail(saving, WEFT_MESSAGE_MEMORY, saving->path, NULL);
    return bytes;
}

/* Adds a picture to the list of images. */
static void picture_put(Saving *saving, const void *bytes, size_t size, const char *media, const char *suffix) {
    json_t *object = json_object(), *list = saving_list(saving, "images");
    saving_picture(saving, object, saving->packed, (int)json_array_size(list), bytes ? bytes : "", size, media, suffix);
    saving_append(saving, list, object);
}

static void image_save(Saving *saving, int number) {
    const WeftImage *image = &saving->scene->images[saving->image_order[number]];
    bool floats = image->type == WEFT_PIXEL_F32;
    size_t size = 0;
    char *bytes = saving->result == WEFT_OK ? encode(saving, image, &size) : NULL;
    picture_put(saving, bytes, size, floats ? "application/octet-stream" : "image/png", floats ? "npy" : "png");
    free(bytes);
}

/* Names the file with levels of its own beside the plain picture, for viewers that read it. Textures of one picture share
 * it: shared[image], 0: not there yet. */
static void levels_save(Saving *saving, const Texture *texture, json_t *object, int *shared) {
    const TextureLevels *levels = texture->levels;
    int *number = &shared[texture->image];
    if (!levels) return;
    if (!*number) {
        *number = (int)json_array_size(saving_list(saving, "images"));
        picture_put(saving, levels->file, levels->size, "image/ktx2", "ktx2");
    }
    json_t *offer = json_object();
    saving_put(saving, offer, "source", json_integer(*number));
    saving_extend(saving, object, "KHR_texture_basisu", offer);
}

void textures_save(Saving *saving) {
    if (!number_all(saving)) saving_fail(saving, WEFT_MESSAGE_MEMORY, saving->path, NULL);
    if (saving->result != WEFT_OK) return;
    int *shared = arena_array(&saving->arena, (size_t)saving->scene->image_count + 1, sizeof *shared);
    if (!shared) saving_fail(saving, WEFT_MESSAGE_MEMORY, saving->path, NULL);
    for (int k = 0; k < saving->image_count; k++) image_save(saving, k);
    for (int k = 0; k < saving->texture_count && shared; k++) {
        const Texture *texture = &saving->scene->textures[saving->texture_order[k]];
        json_t *object = json_object();
        saving_put(saving, object, "source", json_integer(saving->image_number[texture->image]));
        sampler_put(saving, texture, object);
        levels_save(saving, texture, object, shared);
        saving_append(saving, saving_list(saving, "textures"), object);
    }
}
