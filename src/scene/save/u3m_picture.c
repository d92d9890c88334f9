#include "scene/save/u3m_picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/json.h"
#include "base/pi.h"
#include "image/codec.h"
#include "image/pixel.h"
#include "scene/material/cloth_fit.h"
#include "scene/material/u3m_texture.h"
#include "shading/dialect/tone.h"

enum { STEM = 144 }; /* bytes of a picture's name without its suffix */
static const size_t FILE_MOST = (size_t)1 << 30;

static const Texture *texture_of(const U3mPictures *pictures, const Input *input) {
    return &pictures->scene->textures[input->texture - 1];
}

/* Returns the number that a texel has in a picture. */
static float number_of(const float *p, int channels, const U3mPicture *picture) {
    switch (picture->pixels) {
    case U3M_LUMINANCE: return channels < 3 ? p[0] : 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2];
    case U3M_ANGLE: {
        const float part = atan2f(2.0f * p[channels > 1 ? 1 : 0] - 1.0f, 2.0f * p[0] - 1.0f) / (2.0f * PI_FLOAT);
        return part < 0.0f ? part + 1.0f : part;
    }
    case U3M_AS_IS:
    case U3M_CHANNEL: break;
    }
    if (channels < 3) return p[picture->channel == 3 && channels == 2 ? 1 : 0];
    return picture->channel < channels ? p[picture->channel] : 1.0f;
}

static void means_take(const WeftImage *linear, U3mPicture *picture) {
    const size_t texels = (size_t)linear->width * (size_t)linear->height, channels = (size_t)linear->channels;
    const float *p = linear->pixels;
    double sums[3] = {0.0, 0.0, 0.0};
    for (size_t k = 0; k < texels; k++)
        for (size_t c = 0; c < 3; c++)
            sums[c] += (double)(picture->pixels != U3M_AS_IS ? number_of(p + k * channels, linear->channels, picture)
                                                             : p[k * channels + (channels < 3 ? 0 : c)]);
    for (int c = 0; c < 3; c++) picture->mean[c] = (float)(sums[c] / (double)texels);
}

/* Makes the greatest number 1 where it is more, and tells by how much. */
static void scale_take(const WeftImage *linear, U3mPicture *picture) {
    const size_t texels = (size_t)linear->width * (size_t)linear->height, channels = (size_t)linear->channels;
    const float *p = linear->pixels;
    picture->scale = 1.0f;
    for (size_t k = 0; k < texels; k++) {
        const float x = number_of(p + k * channels, linear->channels, picture);
        if (isfinite(x)) picture->scale = fmaxf(picture->scale, x);
    }
}

/* Makes pixels of 8 bits of a channel of 8 bits, else of 16. */
static WeftResult pixels_make(const U3mPicture *picture, const WeftImage *linear, bool bytes, WeftImage *out,
                              WeftError *error) {
    const bool number = picture->pixels != U3M_AS_IS;
    const size_t texels = (size_t)linear->width * (size_t)linear->height, channels = (size_t)linear->channels;
    WeftResult result =
        weft_image_create(linear->width, linear->height, 3, bytes ? WEFT_PIXEL_U8 : WEFT_PIXEL_U16, out, error);
    const float *p = linear->pixels, full = bytes ? 255.0f : 65535.0f;
    for (size_t k = 0; k < 3 * texels && result == WEFT_OK; k++) {
        const float *texel = p + k / 3 * channels;
        float x =
            number ? number_of(texel, linear->channels, picture) / picture->scale : texel[channels < 3 ? 0 : k % 3];
        if (!number && picture->color) x = tone_encode(fminf(fmaxf(x, 0.0f), 1.0f));
        const float level = rintf(full * fminf(fmaxf(x, 0.0f), 1.0f));
        if (bytes)
            ((uint8_t *)out->pixels)[k] = (uint8_t)level;
        else
            ((uint16_t *)out->pixels)[k] = (uint16_t)level;
    }
    return result;
}

/* Adds an image to the package as PNG. */
static WeftResult png_add(U3mPictures *pictures, U3mPicture *picture, const WeftImage *image, const char *stem) {
    const WeftImageWriting how = {.data = picture->pixels != U3M_AS_IS || !picture->color};
    char *bytes = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&bytes, &size);
    if (!stream) return fail(pictures->error, WEFT_MESSAGE_MEMORY, pictures->path, NULL);
    WeftResult result = image_write_png(stream, pictures->path, image, &how, pictures->error);
    if (fclose(stream) != 0 && result == WEFT_OK)
        result = fail(pictures->error, WEFT_MESSAGE_MEMORY, pictures->path, NULL);
    snprintf(picture->path, sizeof picture->path, "%s.png", stem);
    if (result == WEFT_OK)
        result = u3m_package_add(pictures->package, picture->path, bytes, size, true, pictures->error);
    free(bytes);
    return result;
}

/* Adds the file of a texture to the package as it is, if it is one that every reader of U3M has to read. */
static WeftResult file_add(U3mPictures *pictures, U3mPicture *picture, const Texture *texture, const char *stem,
                           bool *added) {
    FileBytes bytes = {0};
    *added = false;
    if (!texture->path || texture->inverted) return WEFT_OK;
    if (file_read(texture->path, FILE_MOST, &bytes, NULL) != WEFT_OK) return WEFT_OK; /* the scene has its pixels */
    const char *type = image_media_type(bytes.data, bytes.size);
    const bool png = type && strcmp(type, "image/png") == 0, jpeg = type && strcmp(type, "image/jpeg") == 0;
    WeftResult result = WEFT_OK;
    if (png || jpeg) {
        snprintf(picture->path, sizeof picture->path, "%s.%s", stem, png ? "png" : "jpg");
        result = u3m_package_add(pictures->package, picture->path, bytes.data, bytes.size, true, pictures->error);
        *added = true;
    }
    free(bytes.data);
    return result;
}

/* Writes "textures/NAME-front-roughness", of the characters that a path of a U3M may have. */
static void stem_write(const char *path, const char *name, char stem[STEM]) {
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path, *dot = strrchr(base, '.');
    const int length = dot ? (int)(dot - base) : (int)strlen(base);
    snprintf(stem, STEM, "textures/%.*s-%s", length < 48 ? length : 48, base, name);
    for (char *c = stem; *c; c++)
        if ((unsigned char)*c < 0x20 || (unsigned char)*c > 0x7e || strchr("<>:\"\\|$%~?*", *c)) *c = '_';
}

/* Adds a number to a name that the U3M which was read may have given to a file of its own: another member still shows
 * that. */
static void stem_free(const char *taken, char stem[STEM]) {
    const size_t end = strlen(stem);
    for (int n = 2; taken && strstr(taken, stem + strlen("textures/")); n++) snprintf(stem + end, STEM - end, "-%d", n);
}

static WeftResult picture_make(U3mPictures *pictures, U3mPicture *picture, const Texture *texture, const char *name) {
    const WeftImage *image = &pictures->scene->images[texture->image];
    WeftImage linear = {0}, made = {0};
    char stem[STEM];
    bool copied = false;
    stem_write(pictures->path, name, stem);
    stem_free(pictures->taken, stem);
    WeftResult result = weft_image_convert_f32(image, picture->color, &linear, pictures->error);
    if (result != WEFT_OK) return result;
    means_take(&linear, picture);
    picture->scale = 1.0f;
    const bool grey = picture->pixels == U3M_CHANNEL && picture->channel == 0 && u3m_texture_grey(image);
    if (picture->pixels == U3M_AS_IS || grey) result = file_add(pictures, picture, texture, stem, &copied);
    if (result == WEFT_OK && !copied && picture->pixels == U3M_AS_IS && image->type != WEFT_PIXEL_F32) {
        result = png_add(pictures, picture, image, stem);
    } else if (result == WEFT_OK && !copied) {
        if (picture->pixels != U3M_AS_IS) scale_take(&linear, picture);
        const bool bytes = image->type == WEFT_PIXEL_U8 && picture->pixels == U3M_CHANNEL;
        result = pixels_make(picture, &linear, bytes, &made, pictures->error);
        if (result == WEFT_OK) result = png_add(pictures, picture, &made, stem);
    }
    weft_image_free(&linear);
    weft_image_free(&made);
    return result;
}

WeftResult u3m_picture_add(U3mPictures *pictures, const Input *input, U3mPixels pixels, bool color, const char *name,
                           const U3mPicture **out) {
    const Texture *texture = texture_of(pictures, input);
    const int channel = pixels == U3M_CHANNEL ? input->channel : 0;
    for (int k = 0; k < pictures->count; k++) {
        const U3mPicture *made = *out = &pictures->made[k];
        if (made->image == texture->image && made->pixels == pixels && made->channel == channel && made->color == color)
            return WEFT_OK;
    }
    U3mPicture *picture = &pictures->made[pictures->count];
    *picture = (U3mPicture){.image = texture->image, .channel = channel, .pixels = pixels, .color = color};
    *out = picture;
    WeftResult result = picture_make(pictures, picture, texture, name);
    if (result == WEFT_OK) pictures->count++;
    return result;
}

/* Warns of what a U3M cannot say of how a texture lies. */
static void place_warn(const U3mPictures *pictures, const Input *input, const Texture *texture, double metres,
                       const char *name) {
    const float *m = input->transform, *rows[2] = {m, m + 3};
    const float a = hypotf(m[0], m[1]), b = hypotf(m[3], m[4]);
    const char *lost[5] = {NULL};
    int count = 0;
    if (!(metres > 0.0)) lost[count++] = "its size is not known: a unit of texture coordinates is taken for 1 m";
    if (rows[1][1] * m[0] - rows[1][0] * m[1] < 0.9999f * a * b) lost[count++] = "it is mirrored or slanted";
    if (fabsf(m[2] - rintf(m[2])) > 1e-4f || fabsf(m[5] - rintf(m[5])) > 1e-4f) lost[count++] = "it is shifted";
    if (texture->wrap_u == WRAP_CLAMP || texture->wrap_v == WRAP_CLAMP) lost[count++] = "its edge is repeated";
    if (input->texcoord) lost[count++] = "it is on the second set of texture coordinates";
    for (int k = 0; k < count; k++)
        warn(pictures->log, WEFT_MESSAGE_GLTF_WARN_IGNORED, pictures->path, "%s: %s, which U3M cannot say", name,
             lost[k]);
}

json_t *u3m_picture_image(const U3mPictures *pictures, const Input *input, const U3mPicture *picture,
                          const char *name) {
    static const char *const modes[] = {"normal", "mirror_x", "mirror_y", "mirror_xy"};
    const Texture *texture = texture_of(pictures, input);
    const WeftImage *image = &pictures->scene->images[texture->image];
    const float *m = input->transform, lengths[2] = {hypotf(m[0], m[1]), hypotf(m[3], m[4])};
    const double metres = pictures->metres > 0.0
                              ? pictures->metres
                              : cloth_uv_metres(pictures->scene, pictures->material, input->texcoord, NULL),
                 unit = metres > 0.0 ? metres : 1.0;
    const int pixels[2] = {image->width, image->height},
              mode = (texture->wrap_u == WRAP_MIRROR ? 1 : 0) + (texture->wrap_v == WRAP_MIRROR ? 2 : 0);
    json_t *sides[2], *dpi[2];
    for (int k = 0; k < 2; k++) {
        const double mm = 1e3 * unit / fmax((double)lengths[k], 1e-6);
        sides[k] = json_of_float((float)mm);
        dpi[k] = json_of_float((float)((double)pixels[k] * 25.4 / mm));
    }
    place_warn(pictures, input, texture, metres, name);
    const float rotation = atan2f(m[1], m[0]) * (180.0f / PI_FLOAT);
    return json_pack("{s:o, s:o, s:{s:o, s:o}, s:s, s:{s:s, s:o}}", "width", sides[0], "height", sides[1], "dpi", "x",
                     dpi[0], "y", dpi[1], "path", picture->path, "repeat", "mode", modes[mode], "rotation",
                     json_of_float(rotation));
}
