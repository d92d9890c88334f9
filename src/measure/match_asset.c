/* match_asset.c - the sheens of a glTF file, rewritten for another engine */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "gltf/gltf.h"
#include "gltf/rewrite.h"
#include "shading/choice.h"
#include "weft/match.h"

/* Where a factor stands in a material's JSON, and what it is where it is not there. */
typedef struct Factor {
    InputId input;
    const char *extension, *name; /* extension NULL: of pbrMetallicRoughness */
    int numbers;
    double def;
} Factor;

static const Factor factors[] = {
    {INPUT_base_color, NULL, "baseColorFactor", 4, 1.0},
    {INPUT_roughness, NULL, "roughnessFactor", 1, 1.0},
    {INPUT_sheen_color, "KHR_materials_sheen", "sheenColorFactor", 3, 0.0},
    {INPUT_sheen_roughness, "KHR_materials_sheen", "sheenRoughnessFactor", 1, 0.0},
    {INPUT_specular, "KHR_materials_specular", "specularFactor", 1, 1.0},
};
enum { FACTORS = sizeof factors / sizeof *factors };

static double linear_of(double x) { return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4); }

/* Where a channel of red, green, blue, alpha stands in a picture of so many: one of grey has it in all three,
 * and alpha is the last of two or four. -1: there is no alpha. */
static int place_of(int channel, int channels) {
    if (channel == 3) return channels & 1 ? -1 : channels - 1;
    return channels < 3 ? 0 : channel;
}

/* The mean of a channel over a texture's pixels; those of a colour are sRGB. */
static double texture_mean(WeftImage image, int channel, bool color) {
    double sum = 0.0;
    size_t pixels = (size_t)image.width * (size_t)image.height;
    int at = place_of(channel, image.channels);
    if (at < 0 || pixels == 0) return 1.0;
    for (size_t k = 0; k < pixels; k++) {
        size_t place = k * (size_t)image.channels + (size_t)at;
        double x = image.type == WEFT_PIXEL_U8    ? ((const uint8_t *)image.pixels)[place] / 255.0
                   : image.type == WEFT_PIXEL_U16 ? ((const uint16_t *)image.pixels)[place] / 65535.0
                                                  : (double)((const float *)image.pixels)[place];
        sum += color && image.type != WEFT_PIXEL_F32 ? linear_of(x) : x;
    }
    return sum / (double)pixels;
}

/* What the textures of the factors are on average; 1 without one. */
static void means_of(const WeftScene *scene, const WeftMaterial *material, double means[FACTORS][3]) {
    for (int f = 0; f < FACTORS; f++) {
        const WeftInput *input = &material->inputs[factors[f].input];
        bool color = factors[f].numbers > 1;
        for (int c = 0; c < 3; c++) {
            means[f][c] = 1.0;
            if (input->texture)
                means[f][c] = texture_mean(weft_scene_texture(scene, input->texture),
                                           color ? c : input->channel, color);
        }
    }
}

/* The material as it is on average, without textures; and back to factors. */
static void to_average(WeftMaterial *material, double means[FACTORS][3]) {
    for (int f = 0; f < FACTORS; f++)
        for (int c = 0; c < 3; c++) {
            float *value = &material->inputs[factors[f].input].value[c];
            *value = (float)((double)*value * means[f][c]);
        }
    for (int k = 0; k < WEFT_INPUTS_MAX; k++) material->inputs[k].texture = 0;
}

static int to_factors(WeftMaterial *material, double means[FACTORS][3]) {
    int clipped = 0;
    for (int f = 0; f < FACTORS; f++)
        for (int c = 0; c < (factors[f].numbers > 1 ? 3 : 1); c++) {
            float *value = &material->inputs[factors[f].input].value[c];
            double factor = means[f][c] > 1e-4 ? (double)*value / means[f][c] : (double)*value;
            clipped |= factor > 1.0 + 1e-6;
            *value = (float)fmin(factor, 1.0);
        }
    return clipped;
}

static bool has_sheen(const WeftMaterial *material) {
    const float *color = material->inputs[INPUT_sheen_color].value;
    return !material->unlit && color[0] + color[1] + color[2] > 0.0f;
}

static json_t *member(json_t *object, const char *name) {
    json_t *value = json_object_get(object, name);
    if (value) return value;
    json_object_set_new(object, name, json_object());
    return json_object_get(object, name);
}

/* Puts a factor that has changed into the JSON. */
static WeftResult factor_write(Rewrite *rewrite, json_t *material, const Factor *factor, const float *value,
                               WeftError *error) {
    json_t *home = factor->extension ? member(member(material, "extensions"), factor->extension)
                                     : member(material, "pbrMetallicRoughness");
    if (factor->extension) {
        WeftResult result = rewrite_uses(rewrite, factor->extension, error);
        if (result != WEFT_OK) return result;
    }
    if (factor->numbers == 1) {
        json_object_set_new(home, factor->name, json_real(round((double)value[0] * 1e6) / 1e6));
        return WEFT_OK;
    }
    json_t *before = json_object_get(home, factor->name), *now = json_array();
    for (int c = 0; c < factor->numbers; c++) {
        const json_t *alpha = json_array_get(before, 3); /* three numbers have none, and it is 1 */
        double kept = alpha ? json_number_value(alpha) : 1.0;
        json_array_append_new(now, json_real(c < 3 ? round((double)value[c] * 1e6) / 1e6 : kept));
    }
    json_object_set_new(home, factor->name, now);
    return WEFT_OK;
}

static bool same(const float *a, const float *b, int count) {
    for (int c = 0; c < count; c++)
        if (fabsf(a[c] - b[c]) > 1e-6f) return false;
    return true;
}

static WeftResult material_write(Rewrite *rewrite, int index, const WeftAssetMatch *match, WeftError *error) {
    json_t *material = json_array_get(json_object_get(rewrite->root, "materials"), (size_t)index);
    WeftResult result = WEFT_OK;
    for (int f = 0; f < FACTORS && material && result == WEFT_OK; f++) {
        const float *was = match->copied.inputs[factors[f].input].value,
                    *now = match->matched.inputs[factors[f].input].value;
        if (!same(was, now, factors[f].numbers > 1 ? 3 : 1))
            result = factor_write(rewrite, material, &factors[f], now, error);
    }
    return result;
}

/* Only what has a factor is free. */
static void hold_rest(int held[WEFT_INPUTS_MAX]) {
    for (int k = 0; k < WEFT_INPUTS_MAX; k++) {
        held[k] = 1;
        for (int f = 0; f < FACTORS; f++)
            if ((int)factors[f].input == k) held[k] = 0;
    }
}

static WeftResult material_match(const WeftScene *scene, int index, int from, int to, WeftApart metric,
                                 WeftAssetMatch *out, WeftError *error) {
    double means[FACTORS][3];
    int held[WEFT_INPUTS_MAX];
    WeftReflection *original = NULL;
    memset(out, 0, sizeof *out);
    snprintf(out->name, sizeof out->name, "%s", weft_scene_material_name(scene, index));
    WeftResult result = weft_scene_material(scene, index, &out->copied, error);
    out->matched = out->copied;
    if (result != WEFT_OK || !has_sheen(&out->copied)) return result;
    WeftMaterial average = out->copied;
    means_of(scene, &out->copied, means);
    to_average(&average, means);
    weft_material_choose(&average, CHOICE_profile, from);
    result = weft_reflection_create(&average, &original, error);
    if (result != WEFT_OK) return result;
    weft_material_choose(&average, CHOICE_profile, to);
    hold_rest(held);
    result = weft_match_material(original, metric, held, &average, &out->found, error);
    weft_reflection_free(original);
    if (result != WEFT_OK) return result;
    out->clipped = to_factors(&average, means);
    for (int f = 0; f < FACTORS; f++)
        memcpy(out->matched.inputs[factors[f].input].value, average.inputs[factors[f].input].value,
               sizeof average.inputs->value);
    out->changed = 1;
    return WEFT_OK;
}

static WeftResult asset_write(Asset *asset, const WeftScene *scene, const char *out, int from, int to,
                              WeftApart metric, WeftAssetMatch *report, int room, WeftError *error) {
    Rewrite rewrite;
    WeftResult result = rewrite_begin(&rewrite, asset, error);
    int count = weft_scene_info(scene).material_count;
    for (int k = 0; k < count && result == WEFT_OK; k++) {
        WeftAssetMatch match;
        result = material_match(scene, k, from, to, metric, &match, error);
        if (result == WEFT_OK && match.changed) result = material_write(&rewrite, k, &match, error);
        if (report && k < room) report[k] = match;
    }
    if (result == WEFT_OK) result = rewrite_save(&rewrite, out, error);
    rewrite_end(&rewrite);
    return result;
}

WeftResult weft_match_asset(const char *path, const char *out, int from, int to, WeftApart metric,
                            WeftAssetMatch *report, int room, int *count, const WeftLog *log,
                            WeftError *error) {
    WeftScene *scene;
    WeftError own;
    char number[32];
    *count = 0;
    snprintf(number, sizeof number, "%d, %d", from, to);
    if (!weft_profile_id(from) || !weft_profile_id(to)) return fail(error, WEFT_MESSAGE_DESC, number, NULL);
    WeftResult result = weft_scene_load(path, &scene, log, error);
    if (result != WEFT_OK) return result;
    *count = weft_scene_info(scene).material_count;
    Asset asset = {.error = error ? error : &own};
    gltf_open(&asset, path, NULL, 0);
    result = asset.result;
    if (result == WEFT_OK) result = asset_write(&asset, scene, out, from, to, metric, report, room, error);
    gltf_close(&asset);
    weft_scene_free(scene);
    return result;
}
