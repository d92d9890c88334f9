/* Specification: Khronos Group, "glTF 2.0 Specification", 2021, sections 2.2 (file basics), 2.8 (URIs) and 4 (GLB). */
#include "gltf/save/rewrite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/patch.h"
#include "base/path.h"
#include "gltf/asset/container.h"
#include "gltf/save/bundle.h"
#include "gltf/save/saving.h"
#include "image/codec.h"

WeftResult rewrite_begin(Rewrite *rewrite, Asset *asset, WeftError *error) {
    *rewrite = (Rewrite){.asset = asset, .root = json_deep_copy(asset->root)};
    return rewrite->root ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, asset->name, NULL);
}

void rewrite_end(Rewrite *rewrite) {
    for (int k = 0; k < rewrite->image_count; k++) free(rewrite->images[k].bytes);
    free(rewrite->images);
    json_decref(rewrite->root);
    *rewrite = (Rewrite){0};
}

/* Returns the array of that name in the document, created if it is missing; borrowed, NULL if memory is short. */
static json_t *list(json_t *root, const char *name) {
    json_t *array = json_object_get(root, name);
    if (!array && json_object_set_new(root, name, json_array()) == 0) array = json_object_get(root, name);
    return array;
}

static int index_of(const json_t *array, const char *text) {
    size_t k;
    json_t *value;
    json_array_foreach(array, k, value) {
        if (json_is_string(value) && strcmp(json_string_value(value), text) == 0) return (int)k;
    }
    return -1;
}

WeftResult rewrite_uses(Rewrite *rewrite, const char *extension, WeftError *error) {
    json_t *used = list(rewrite->root, "extensionsUsed");
    if (used && index_of(used, extension) >= 0) return WEFT_OK;
    if (used && json_array_append_new(used, json_string(extension)) == 0) return WEFT_OK;
    return fail(error, WEFT_MESSAGE_MEMORY, rewrite->asset->name, NULL);
}

void rewrite_uses_no_more(Rewrite *rewrite, const char *extension) {
    static const char *const names[] = {"extensionsUsed", "extensionsRequired"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        json_t *array = json_object_get(rewrite->root, names[k]);
        int index = index_of(array, extension);
        if (index >= 0) json_array_remove(array, (size_t)index);
        if (index >= 0 && json_array_size(array) == 0) json_object_del(rewrite->root, names[k]);
    }
}

/* Makes a texture of image number `image` with the sampler of texture number `like`. */
static json_t *texture_make(const Rewrite *rewrite, int image, int like) {
    json_t *texture = json_object(),
           *old = like < 0 ? NULL : json_array_get(json_object_get(rewrite->root, "textures"), (size_t)like);
    json_t *sampler = json_object_get(old, "sampler");
    if (sampler) json_object_set(texture, "sampler", sampler);
    json_object_set_new(texture, "source", json_integer(image));
    return texture;
}

/* Appends an image of a texture, whose bytes are copied. Returns its index, or -1 with *error. */
static int image_add(Rewrite *rewrite, const void *bytes, size_t size, int texture, bool levels, WeftError *error) {
    json_t *images = list(rewrite->root, "images");
    NewImage *grown = realloc_array(rewrite->images, (size_t)rewrite->image_count + 1, sizeof *grown);
    unsigned char *copy = alloc_array(size, 1);
    const int image = (int)json_array_size(images);
    if (grown) rewrite->images = grown;
    if (!grown || !copy || json_array_append_new(images, json_object()) != 0) {
        free(copy);
        fail(error, WEFT_MESSAGE_MEMORY, rewrite->asset->name, NULL);
        return -1;
    }
    memcpy(copy, bytes, size);
    grown[rewrite->image_count++] = (NewImage){copy, size, image, texture, levels};
    return image;
}

int rewrite_texture(Rewrite *rewrite, const void *png, size_t size, int like, WeftError *error) {
    json_t *textures = list(rewrite->root, "textures");
    const int texture = (int)json_array_size(textures), image = image_add(rewrite, png, size, texture, false, error);
    if (image < 0 || json_array_append_new(textures, texture_make(rewrite, image, like)) == 0)
        return image < 0 ? -1 : texture;
    fail(error, WEFT_MESSAGE_MEMORY, rewrite->asset->name, NULL);
    return -1;
}

/* Lets a texture name a KTX 2 file, whose bytes are copied, beside its plain picture. */
static WeftResult levels_add(Rewrite *rewrite, Span ktx2, int texture, WeftError *error) {
    static const char name[] = "KHR_texture_basisu";
    json_t *object = json_array_get(json_object_get(rewrite->root, "textures"), (size_t)texture);
    const int image = image_add(rewrite, ktx2.data, ktx2.size, texture, true, error);
    if (image < 0) return WEFT_RESOURCES;
    if (!json_object_get(object, "extensions")) json_object_set_new(object, "extensions", json_object());
    json_t *offer = json_object();
    if (json_object_set_new(offer, "source", json_integer(image)) != 0 ||
        json_object_set_new(json_object_get(object, "extensions"), name, offer) != 0)
        return fail(error, WEFT_MESSAGE_MEMORY, rewrite->asset->name, NULL);
    return rewrite_uses(rewrite, name, error);
}

/* Encodes an image as PNG, or `count` levels of it as KTX 2. bytes: to be freed, in any case. */
static WeftResult encode(const WeftImage *levels, int count, bool data, const char *name, Span *bytes,
                         WeftError *error) {
    const WeftImageWriting how = {.data = data, .levels = levels + 1, .level_count = count - 1};
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    WeftResult result = (count > 1 ? image_write_ktx2 : image_write_png)(stream, name, levels, &how, error);
    if (fclose(stream) != 0 && result == WEFT_OK) result = fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    *bytes = (Span){(unsigned char *)text, size};
    return result;
}

/* Returns the sampler of a texture; NULL for none, and for texture -1. */
static const json_t *sampler_of(const Rewrite *rewrite, int texture) {
    const json_t *textures = json_object_get(rewrite->root, "textures");
    return texture < 0 ? NULL : json_object_get(json_array_get(textures, (size_t)texture), "sampler");
}

static bool is_of(const NewImage *image, Span bytes) {
    return image->size == bytes.size && memcmp(image->bytes, bytes.data, bytes.size) == 0;
}

/* Returns true if a texture names these levels beside its plain picture, or none where there are no bytes. */
static bool has_levels(const Rewrite *rewrite, int texture, Span levels) {
    for (int k = 0; k < rewrite->image_count; k++)
        if (rewrite->images[k].levels && rewrite->images[k].texture == texture)
            return levels.data && is_of(&rewrite->images[k], levels);
    return !levels.data;
}

/* Returns the texture of an image that was added with these bytes and levels and the sampler of texture `like`, or -1. */
static int added_before(const Rewrite *rewrite, Span png, Span levels, int like) {
    const json_t *sampler = sampler_of(rewrite, like);
    for (int k = 0; k < rewrite->image_count; k++) {
        const NewImage *old = &rewrite->images[k];
        const json_t *its = sampler_of(rewrite, old->texture);
        if (!old->levels && is_of(old, png) && has_levels(rewrite, old->texture, levels) &&
            (its == sampler || json_equal(its, sampler)))
            return old->texture;
    }
    return -1;
}

/* Sets *texture to one of this picture and these levels, which are added if they are not there. */
static WeftResult texture_find(Rewrite *rewrite, Span png, Span levels, int like, int *texture, WeftError *error) {
    if (!png.data) return fail(error, WEFT_MESSAGE_MEMORY, rewrite->asset->name, NULL);
    *texture = added_before(rewrite, png, levels, like);
    if (*texture >= 0) return WEFT_OK;
    *texture = rewrite_texture(rewrite, png.data, png.size, like, error);
    if (*texture < 0) return WEFT_RESOURCES;
    return levels.data ? levels_add(rewrite, levels, *texture, error) : WEFT_OK;
}

WeftResult rewrite_image(Rewrite *rewrite, const WeftImage *levels, int count, bool data, int like, int *texture,
                         WeftError *error) {
    Span png = {0}, ktx2 = {0};
    WeftResult result = encode(levels, 1, data, rewrite->asset->name, &png, error);
    if (result == WEFT_OK && count > 1) result = encode(levels, count, data, rewrite->asset->name, &ktx2, error);
    if (result == WEFT_OK) result = texture_find(rewrite, png, ktx2, like, texture, error);
    free((void *)png.data);
    free((void *)ktx2.data);
    return result;
}

/* Returns true if bytes of an asset in memory may become buffer 0 of a GLB. */
static bool takes_bytes(const Saving *saving) {
    const json_t *buffers = json_object_get(saving->root, "buffers"), *first = json_array_get(buffers, 0);
    return saving->packed && (!first || (saving->size && !json_object_get(first, "uri")));
}

static void image_put(Saving *saving, const NewImage *image) {
    json_t *object = json_array_get(json_object_get(saving->root, "images"), (size_t)image->index);
    const char *media = image_media_type(image->bytes, image->size);
    saving_picture(saving, object, takes_bytes(saving), image->index, image->bytes, image->size, media,
                   strchr(media, '/') + 1);
}

/* Writes the bytes of the BIN chunk to a file. */
static void bin_unpack(Saving *saving) {
    json_t *first = json_array_get(json_object_get(saving->root, "buffers"), 0);
    if (!first || json_object_get(first, "uri")) return;
    const char *path = saving_beside(saving, ".bin"), *uri = path ? saving_uri(saving, path) : NULL;
    if (uri) saving_put(saving, first, "uri", json_string(uri));
    if (uri) saving_write(saving, path, saving->bytes, saving->size, NULL, 0);
    saving->size = 0;
}

/* Updates the length of buffer 0 after bytes were appended to it. */
static void length_update(Saving *saving, size_t before) {
    if (!saving->packed || saving->size == before) return;
    json_t *buffers = saving_list(saving, "buffers"), *first = json_array_get(buffers, 0);
    if (!first) saving_append(saving, buffers, json_object());
    first = json_array_get(buffers, 0);
    saving_put(saving, first, "byteLength", json_integer((json_int_t)saving->size));
}

static void document_write(Saving *saving, const Asset *asset) {
    size_t length = 0, head_size = 0;
    char *text = patch_text((const char *)asset->text.data, asset->text.size, asset->root, saving->root, &length);
    unsigned char *head = NULL;
    if (text && !saving->packed) {
        saving_write(saving, saving->path, text, length, NULL, 0);
    } else if (text) {
        Span behind = asset->packed ? asset->behind : (Span){0};
        size_t bin = saving->size;
        if (!json_equal(asset->root, saving->root)) /* without its old padding */
            while (length && text[length - 1] == ' ') length--;
        head = container_head((Span){(unsigned char *)text, length}, bin, behind.size, &head_size);
        saving_bytes(saving, behind.data, behind.size);
        if (head) saving_write(saving, saving->path, head, head_size, saving->bytes, bin + behind.size);
    }
    if (!text || (saving->packed && !head)) saving_fail(saving, WEFT_MESSAGE_MEMORY, saving->path, NULL);
    free(head);
    free(text);
}

WeftResult rewrite_save(const Rewrite *rewrite, const char *path, WeftError *error) {
    const Asset *asset = rewrite->asset;
    bool packed = path_ends(path, ".glb");
    if (!packed && !path_ends(path, ".gltf"))
        return fail(error, WEFT_MESSAGE_SCENE_KIND, path, "write a .glb or a .gltf");
    Saving saving = {.path = path, .packed = packed, .error = error, .root = json_deep_copy(rewrite->root)};
    if (!saving.root) saving_fail(&saving, WEFT_MESSAGE_MEMORY, path, NULL);
    saving_bytes(&saving, asset->bin.data, asset->bin.size);
    size_t before = saving.size;
    if (packed && !asset->packed) bundle_pack(&saving, asset);
    if (!packed && saving.size) bin_unpack(&saving);
    for (int k = 0; k < rewrite->image_count && saving.result == WEFT_OK; k++) image_put(&saving, &rewrite->images[k]);
    length_update(&saving, before);
    bundle_copy(&saving, asset);
    if (saving.result == WEFT_OK) document_write(&saving, asset);
    json_decref(saving.root);
    free(saving.bytes);
    arena_free(&saving.arena);
    return saving.result;
}
