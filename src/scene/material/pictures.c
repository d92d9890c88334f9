#include "scene/material/pictures.h"

#include <math.h>
#include <string.h>

#include "base/fail.h"
#include "scene/material/relief.h"
#include "weft/material.h"

int texture_number_of(WeftScene *scene, Texture texture) {
    size_t count = (size_t)scene->texture_count;
    Texture *textures = arena_array(&scene->arena, count + 1, sizeof *textures);
    if (!textures) return 0;
    if (count) memcpy(textures, scene->textures, count * sizeof *textures);
    textures[count] = texture;
    scene->textures = textures;
    return ++scene->texture_count;
}

int picture_add(WeftScene *scene, WeftImage *image, Texture like) {
    size_t count = (size_t)scene->image_count;
    WeftImage *images = arena_array(&scene->arena, count + 1, sizeof *images);
    if (!images) return 0;
    like.image = scene->image_count;
    int number = texture_number_of(scene, like);
    if (!number) return 0;
    if (count) memcpy(images, scene->images, count * sizeof *images);
    images[count] = *image;
    *image = (WeftImage){0};
    scene->images = images;
    scene->image_count++;
    return number;
}

void picture_replace(WeftScene *scene, int image, WeftImage *fresh, TextureLevels *levels, const char *path) {
    if (fresh->pixels != scene->images[image].pixels) weft_image_free(&scene->images[image]);
    scene->images[image] = *fresh;
    *fresh = (WeftImage){0};
    for (int k = 0; k < scene->texture_count; k++) {
        if (scene->textures[k].image != image) continue;
        scene->textures[k].version++;
        scene->textures[k].path = path;
        if (!path) scene->textures[k].inverted = 0;
    }
    textures_put_levels(scene->textures, scene->texture_count, image, levels);
    reliefs_renew(scene, image);
}

void picture_invert(WeftImage *image, TextureLevels **levels, unsigned channels) {
    if (!channels) return;
    levels_free(*levels);
    *levels = NULL;
    const int count = image->channels, alpha = count % 2 ? -1 : count - 1;
    const size_t values = (size_t)image->width * (size_t)image->height * (size_t)count;
    for (int c = 0; c < count; c++) {
        if (!(channels >> (c == alpha ? 3 : c) & 1)) continue;
        for (size_t k = (size_t)c; k < values; k += (size_t)count) switch (image->type) {
            case WEFT_PIXEL_U8: ((uint8_t *)image->pixels)[k] ^= 0xff; break;
            case WEFT_PIXEL_U16: ((uint16_t *)image->pixels)[k] ^= 0xffff; break;
            case WEFT_PIXEL_F32: ((float *)image->pixels)[k] = 1.0f - ((float *)image->pixels)[k]; break;
            }
    }
}

/* Fails for an invalid image, since look-ups do not check. */
static WeftResult check_image(const WeftImage *image, WeftError *error) {
    enum { SIDE_MAX = 65536 };
    const char *subject = "texture";
    if (!image->pixels) return fail(error, WEFT_MESSAGE_DESC, subject, "it has no pixels");
    if (image->width < 1 || image->width > SIDE_MAX || image->height < 1 || image->height > SIDE_MAX)
        return fail(error, WEFT_MESSAGE_DESC, subject, "%d x %d pixels", image->width, image->height);
    if (image->channels < 1 || image->channels > 4 || (unsigned)image->type > WEFT_PIXEL_F32)
        return fail(error, WEFT_MESSAGE_DESC, subject, "%d channels of type %d", image->channels, (int)image->type);
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    const float *values = image->pixels;
    for (size_t k = 0; k < count && image->type == WEFT_PIXEL_F32; k++)
        if (!isfinite(values[k])) return fail(error, WEFT_MESSAGE_DESC, subject, "a pixel is not finite");
    return WEFT_OK;
}

static bool is_texture(const WeftScene *scene, int index) { return index > 0 && index <= scene->texture_count; }

const char *weft_scene_texture_path(const WeftScene *scene, int index) {
    return is_texture(scene, index) ? scene->textures[index - 1].path : NULL;
}

WeftImage weft_scene_texture(const WeftScene *scene, int index) {
    return is_texture(scene, index) ? scene->images[scene->textures[index - 1].image] : (WeftImage){0};
}

WeftResult weft_scene_put_texture(WeftScene *scene, int index, WeftImage *image, WeftError *error) {
    if (!is_texture(scene, index)) return fail(error, WEFT_MESSAGE_DESC, "texture", "number %d does not exist", index);
    WeftResult result = check_image(image, error);
    if (result == WEFT_OK) picture_replace(scene, scene->textures[index - 1].image, image, NULL, NULL);
    return result;
}

WeftResult weft_scene_read_texture(WeftScene *scene, int index, const WeftLog *log, WeftError *error) {
    WeftImage image;
    TextureLevels *levels;
    const char *path = weft_scene_texture_path(scene, index);
    if (!path) return fail(error, WEFT_MESSAGE_DESC, "texture", "number %d has no file of its own", index);
    WeftResult result = levels_read(path, &image, &levels, log, error);
    if (result != WEFT_OK) return result;
    picture_invert(&image, &levels, scene->textures[index - 1].inverted);
    picture_replace(scene, scene->textures[index - 1].image, &image, levels, path);
    return WEFT_OK;
}

int weft_scene_add_texture(WeftScene *scene, WeftImage *image, WeftError *error) {
    if (check_image(image, error) != WEFT_OK) return 0;
    int number = picture_add(scene, image, (Texture){0});
    if (!number) fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    return number;
}
