#include "scene/record/levels.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/path.h"
#include "image/halve.h"
#include "image/ktx2/ktx2.h"
#include "image/pixel.h"

/* Reads a level after the first into the arena. Returns false unless it is half of the one before, and of its kind. */
static bool level_read(Arena *arena, const Ktx2 *file, int level, const WeftImage *before, WeftImage *out) {
    WeftImage image = {0};
    if (ktx2_picture(file, level, 0, &image, NULL) != WEFT_OK) return false;
    const size_t size = (size_t)image.width * (size_t)image.height * (size_t)image.channels;
    const bool fits = image.width == halved(before->width) && image.height == halved(before->height) &&
                      image.channels == before->channels && image.type == before->type;
    *out = image;
    out->pixels = fits ? arena_array(arena, size, pixel_type_size(image.type)) : NULL;
    if (out->pixels) memcpy(out->pixels, image.pixels, size * pixel_type_size(image.type));
    weft_image_free(&image);
    return out->pixels != NULL;
}

const TextureLevels *levels_read(Arena *arena, const unsigned char *data, size_t size, const WeftImage *picture) {
    const ImageSource source = {.data = data, .size = size, .name = ""};
    Ktx2 file;
    int count = 0;
    if (!data || !ktx2_starts(data, size) || ktx2_open(&source, &file, NULL) != WEFT_OK) return NULL;
    for (int w = picture->width, h = picture->height; w > 1 || h > 1; w = halved(w), h = halved(h)) count++;
    if (!count || (uint32_t)count + 1 > file.levels) return NULL;
    TextureLevels *levels = arena_array(arena, 1, sizeof *levels);
    WeftImage *images = arena_array(arena, (size_t)count, sizeof *images);
    unsigned char *copy = arena_array(arena, size, 1);
    if (!levels || !images || !copy) return NULL;
    for (int k = 0; k < count; k++)
        if (!level_read(arena, &file, k + 1, k ? &images[k - 1] : picture, &images[k])) return NULL;
    memcpy(copy, data, size);
    *levels = (TextureLevels){.images = images, .count = count, .file = copy, .size = size};
    return levels;
}

const TextureLevels *levels_read_file(Arena *arena, const char *path, const WeftImage *picture) {
    FileBytes file;
    if (!path || !path_ends(path, ".ktx2") || file_read(path, (size_t)1 << 30, &file, NULL) != WEFT_OK) return NULL;
    const TextureLevels *levels = levels_read(arena, file.data, file.size, picture);
    free(file.data);
    return levels;
}
