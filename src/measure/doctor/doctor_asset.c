/* doctor_asset.c - an asset as the checks read it: JSON, images, and materials as mean numbers */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/asset/material_fields.h"
#include "image/pixel.h"
#include "measure/doctor/doctor.h"
#include "shading/material/choice.h"

json_t *doctor_part(json_t *object, const char *path) {
    while (object && *path) {
        char key[64];
        size_t length = strcspn(path, "/");
        if (length >= sizeof key) return NULL;
        memcpy(key, path, length);
        key[length] = 0;
        object = json_object_get(object, key);
        path += length + (path[length] == '/');
    }
    return object;
}

const char *doctor_key(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

json_t *doctor_list(const WeftDoctor *doctor, const char *name) { return json_object_get(doctor->asset.root, name); }

json_t *doctor_item(const WeftDoctor *doctor, const char *name, int index) {
    return json_array_get(doctor_list(doctor, name), (size_t)index);
}

bool doctor_numbers(json_t *object, const char *path, double *out, int count) {
    json_t *value = doctor_part(object, path);
    if (count == 1 && json_is_number(value)) {
        out[0] = json_number_value(value);
        return true;
    }
    if (!json_is_array(value) || json_array_size(value) < (size_t)count) return false;
    for (int k = 0; k < count; k++) out[k] = json_number_value(json_array_get(value, (size_t)k));
    return true;
}

int doctor_texture(const WeftDoctor *doctor, json_t *info) {
    double index = -1.0; /* an unsupported extension may have anything here */
    doctor_numbers(info, "index", &index, 1);
    return index >= 0.0 && index < (double)doctor->asset.texture_count ? (int)index : -1;
}

/* Returns the scene's image of a textureInfo, or -1. */
static int image_of(const WeftDoctor *doctor, json_t *info) {
    int index = doctor_texture(doctor, info);
    int texture = index < 0 ? -1 : doctor->asset.textures[index].scene_texture;
    return texture < 0 ? -1 : doctor->scene->textures[texture].image;
}

const WeftImage *doctor_image(WeftDoctor *doctor, json_t *info) {
    int image = image_of(doctor, info);
    return image < 0 || !doctor->scene->images[image].pixels ? NULL : &doctor->scene->images[image];
}

/* Reads one pixel as R G B A. */
static void pixel_read(const WeftImage *image, size_t pixel, float rgba[4]) {
    size_t at = pixel * (size_t)image->channels;
    bool grey = image->channels < 3;
    for (int c = 0; c < 3; c++) rgba[c] = (float)pixel_value(image, at + (grey ? 0 : (size_t)c));
    rgba[3] = image->channels % 2 ? 1.0f : (float)pixel_value(image, at + (size_t)image->channels - 1);
}

static size_t nearest_pixel(const WeftImage *image, float u, float v) {
    return (size_t)(v * (float)image->height) * (size_t)image->width + (size_t)(u * (float)image->width);
}

void doctor_texel(const WeftImage *image, float u, float v, float rgb[3]) {
    float rgba[4];
    pixel_read(image, nearest_pixel(image, u, v), rgba);
    memcpy(rgb, rgba, 3 * sizeof *rgb);
}

/* Returns a component of a colour, decoded from sRGB if the image has integers. */
static float linear_of(const SrgbTable *srgb, const WeftImage *image, float value) {
    bool integer = image->type != WEFT_PIXEL_F32;
    int step = integer ? (int)(value * 255.0f + 0.5f) : 0;
    return integer ? srgb->linear[step & 255] : value;
}

void doctor_texel_linear(const WeftDoctor *doctor, const WeftImage *image, float u, float v, float rgb[3]) {
    doctor_texel(image, u, v, rgb);
    for (int c = 0; c < 3; c++) rgb[c] = linear_of(&doctor->scene->srgb, image, rgb[c]);
}

static void pixels_survey(const SrgbTable *srgb, const WeftImage *image, Pixels *out) {
    size_t count = (size_t)image->width * (size_t)image->height;
    double sum[4] = {0.0}, linear[3] = {0.0};
    for (int c = 0; c < 4; c++) out->low[c] = INFINITY, out->high[c] = -INFINITY;
    for (size_t k = 0; k < count; k++) {
        float rgba[4];
        pixel_read(image, k, rgba);
        for (int c = 0; c < 4; c++) {
            out->low[c] = fminf(out->low[c], rgba[c]);
            out->high[c] = fmaxf(out->high[c], rgba[c]);
            sum[c] += (double)rgba[c];
            if (c < 3) linear[c] += (double)linear_of(srgb, image, rgba[c]);
        }
    }
    for (int c = 0; c < 4; c++) out->mean[c] = (float)(sum[c] / (double)count);
    for (int c = 0; c < 3; c++) out->linear[c] = (float)(linear[c] / (double)count);
    out->done = true;
}

const Pixels *doctor_pixels(WeftDoctor *doctor, json_t *info) {
    int image = image_of(doctor, info);
    if (image < 0 || !doctor->scene->images[image].pixels) return NULL;
    Pixels *pixels = &doctor->pixels[image];
    if (!pixels->done) pixels_survey(&doctor->scene->srgb, &doctor->scene->images[image], pixels);
    return pixels;
}

const MaterialField *doctor_row(json_t *material, InputId input) {
    const json_t *extensions = json_object_get(material, "extensions");
    for (const MaterialField *row = material_fields; row->factor; row++)
        if (material_field_replaces(row) && row->input == (int)input && json_object_get(extensions, row->object))
            return row;
    return material_field_of(input);
}

/* Turns glossiness into roughness. */
static float number_of(const MaterialField *row, float number) {
    return row->channels == CHANNEL_A_GLOSS ? 1.0f - number : number;
}

void doctor_input(WeftDoctor *doctor, json_t *material, InputId input, float *out) {
    const MaterialField *row = doctor_row(material, input);
    const int alpha = (int)CHANNEL_A, channel = (int)row->channels > alpha ? alpha : (int)row->channels;
    const int count = material_field_numbers(row), given = count > 1 ? 3 : 1;
    const double absent = (double)row->absent;
    double numbers[3] = {absent, absent, absent};
    char path[FIELD_PATH];
    material_field_path(row, row->factor, path);
    doctor_numbers(material, path, numbers, given);
    material_field_path(row, row->texture, path);
    const Pixels *pixels = doctor_pixels(doctor, doctor_part(material, path));
    for (int c = 0; c < given; c++) {
        out[c] = fminf(fmaxf((float)numbers[c], 0.0f), 1.0f);
        if (pixels) out[c] *= given == 3 ? pixels->linear[c] : pixels->mean[channel];
        out[c] = number_of(row, out[c]);
    }
}

/* The profiles of the catalogue that are engines' versions of KHR_materials_sheen. */
const char *const doctor_readers[] = {"khronos", "three", "babylon", "filament-sheen", "materialx", NULL};

unsigned doctor_engine(const char *profile) { return 1u << choice_find(CHOICE_profile, profile); }

unsigned doctor_engines(void) {
    unsigned all = 0;
    for (int k = 0; doctor_readers[k]; k++) all |= doctor_engine(doctor_readers[k]);
    return all;
}

Cloth doctor_cloth(WeftDoctor *doctor, int material) {
    Cloth cloth = {.index = material, .json = doctor_item(doctor, "materials", material)};
    cloth.sheen = doctor_part(cloth.json, "extensions/KHR_materials_sheen");
    doctor_input(doctor, cloth.json, INPUT_sheen_color, cloth.color);
    doctor_input(doctor, cloth.json, INPUT_sheen_roughness, &cloth.roughness);
    doctor_input(doctor, cloth.json, INPUT_base_color, cloth.base);
    const bool metals = !material_field_replaces(doctor_row(cloth.json, INPUT_base_color));
    if (metals) doctor_input(doctor, cloth.json, INPUT_metallic, &cloth.metallic);
    return cloth;
}

bool cloth_shows(const Cloth *cloth) {
    const float *c = cloth->color;
    return cloth->sheen && fmaxf(c[0], fmaxf(c[1], c[2])) > 1e-3f;
}
