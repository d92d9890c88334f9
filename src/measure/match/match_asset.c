/* match_asset.c - converts the sheens of a glTF file for another engine */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "gltf/asset/material_fields.h"
#include "gltf/read/gltf.h"
#include "gltf/save/rewrite.h"
#include "image/pixel.h"
#include "measure/bsdf/material_key.h"
#include "measure/match/match.h"
#include "scene/record/scene.h"
#include "shading/material/choice.h"

/* The inputs that a match may change. */
static const InputId factors[] = {INPUT_base_color, INPUT_roughness, INPUT_sheen_color, INPUT_sheen_roughness,
                                  INPUT_specular};
enum { FACTORS = sizeof factors / sizeof *factors };

static double linear_of(double x) { return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4); }

/* Returns the place of red, green, blue or alpha among an image's channels, -1 if there is none. With one channel or
 * two, the first is grey and is used for all three colours; with two or four, the last is alpha. */
static int place_of(int channel, int channels) {
    if (channel == 3) return channels & 1 ? -1 : channels - 1;
    return channels < 3 ? 0 : channel;
}

/* Returns the mean of a channel over a texture's pixels. color: integers are decoded from sRGB. */
static double texture_mean(WeftImage image, int channel, bool color) {
    double sum = 0.0;
    size_t pixels = (size_t)image.width * (size_t)image.height;
    int at = place_of(channel, image.channels);
    if (at < 0 || pixels == 0) return 1.0;
    for (size_t k = 0; k < pixels; k++) {
        double x = pixel_value(&image, k * (size_t)image.channels + (size_t)at);
        sum += color && image.type != WEFT_PIXEL_F32 ? linear_of(x) : x;
    }
    return sum / (double)pixels;
}

/* A mean of a texture, kept for all materials that read it. */
typedef struct Mean {
    bool done;
    double mean;
} Mean;

/* One material of the asset. */
typedef struct AssetMaterial {
    double means[FACTORS][3]; /* mean of each factor's texture, by channel; 1 without a texture */
    int search;               /* index into `searches`; -1: the material has no sheen */
} AssetMaterial;

/* One search, for all materials that are equal once textures are replaced by their means. */
typedef struct AverageSearch {
    MaterialKey key;      /* of `average` */
    WeftMaterial average; /* such a material, without textures; the search replaces it by its match */
    WeftMatch found;
    WeftResult result;
    WeftError error;
} AverageSearch;

typedef struct AssetSearch {
    WeftScene *scene;
    int from, to;                /* profiles */
    int locked[WEFT_INPUTS_MAX]; /* not 0: the input keeps its value */
    WeftBrdfMetric metric;
    WeftProgress progress; /* may be NULL */
    void *user;
    LoopWatch watch;
    Mean (*means)[2][4];      /* [texture - 1][0: data, 1: sRGB colours][channel] */
    AssetMaterial *materials; /* `count` */
    AverageSearch *searches;  /* `search_count`, at most `count` */
    WeftAssetMatch *matches;
    int count, search_count;
} AssetSearch;

static double mean_of(AssetSearch *self, const WeftInput *input, int channel, bool color) {
    if (!input->texture) return 1.0;
    Mean *kept = &self->means[input->texture - 1][color][channel];
    if (!kept->done)
        *kept = (Mean){true, texture_mean(weft_scene_texture(self->scene, input->texture), channel, color)};
    return kept->mean;
}

static void means_of(AssetSearch *self, const WeftMaterial *material, double means[FACTORS][3]) {
    for (int f = 0; f < FACTORS; f++) {
        const WeftInput *input = &material->inputs[factors[f]];
        bool color = input_value_count(factors[f]) > 1;
        for (int c = 0; c < 3; c++) means[f][c] = mean_of(self, input, color ? c : input->channel, color);
    }
}

/* Multiplies the factors by the means of their textures and removes the textures. */
static void to_average(WeftMaterial *material, double means[FACTORS][3]) {
    for (int f = 0; f < FACTORS; f++)
        for (int c = 0; c < 3; c++) {
            float *value = &material->inputs[factors[f]].value[c];
            *value = (float)((double)*value * means[f][c]);
        }
    for (int k = 0; k < WEFT_INPUTS_MAX; k++) material->inputs[k].texture = 0;
}

/* Undoes to_average: divides the numbers by the means. Returns 1 if a factor would exceed 1 and was clipped. */
static int to_factors(WeftMaterial *material, double means[FACTORS][3]) {
    int clipped = 0;
    for (int f = 0; f < FACTORS; f++)
        for (int c = 0; c < input_value_count(factors[f]); c++) {
            float *value = &material->inputs[factors[f]].value[c];
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

/* Returns the object of that name in `object`; adds an empty one if there is none. */
static json_t *member_object(json_t *object, const char *name) {
    json_t *value = json_object_get(object, name);
    if (value) return value;
    json_object_set_new(object, name, json_object());
    return json_object_get(object, name);
}

/* Writes a factor that has changed to the JSON. */
static WeftResult factor_write(Rewrite *rewrite, json_t *material, const MaterialField *factor, const float *value,
                               WeftError *error) {
    const bool extends = material_field_extends(factor);
    json_t *home = member_object(extends ? member_object(material, "extensions") : material, factor->object);
    if (extends) {
        WeftResult result = rewrite_uses(rewrite, factor->object, error);
        if (result != WEFT_OK) return result;
    }
    if (material_field_numbers(factor) == 1) {
        json_object_set_new(home, factor->factor, json_real(round((double)value[0] * 1e6) / 1e6));
        return WEFT_OK;
    }
    json_t *before = json_object_get(home, factor->factor), *now = json_array();
    for (int c = 0; c < material_field_numbers(factor); c++) {
        const json_t *alpha = json_array_get(before, 3); /* NULL, and then 1, if there was none */
        double kept = alpha ? json_number_value(alpha) : 1.0;
        json_array_append_new(now, json_real(c < 3 ? round((double)value[c] * 1e6) / 1e6 : kept));
    }
    json_object_set_new(home, factor->factor, now);
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
        const float *was = match->copied.inputs[factors[f]].value, *now = match->matched.inputs[factors[f]].value;
        if (!same(was, now, input_value_count(factors[f])))
            result = factor_write(rewrite, material, material_field_of(factors[f]), now, error);
    }
    return result;
}

/* Locks every input but those of `factors`. */
static void lock_rest(int locked[WEFT_INPUTS_MAX]) {
    for (int k = 0; k < WEFT_INPUTS_MAX; k++) {
        locked[k] = 1;
        for (int f = 0; f < FACTORS; f++)
            if ((int)factors[f] == k) locked[k] = 0;
    }
}

/* Returns the index of the search for a material without textures; adds the search if there is none yet. */
static int search_for(AssetSearch *self, const WeftMaterial *average) {
    const MaterialKey key = material_key(average);
    int k = 0;
    while (k < self->search_count && !material_key_same(&self->searches[k].key, &key)) k++;
    if (k == self->search_count) {
        self->searches[k].key = key;
        self->searches[k].average = *average;
        self->search_count++;
    }
    return k;
}

/* Lists the materials and the searches that they need. */
static WeftResult plan(AssetSearch *self, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = 0; k < self->count && result == WEFT_OK; k++) {
        AssetMaterial *material = &self->materials[k];
        WeftAssetMatch *match = &self->matches[k];
        snprintf(match->name, sizeof match->name, "%s", weft_scene_material_name(self->scene, k));
        material->search = -1;
        result = weft_scene_material(self->scene, k, &match->copied, error);
        match->matched = match->copied;
        if (result != WEFT_OK || !has_sheen(&match->copied)) continue;
        if (self->progress && self->progress(self->user, 0.0)) return WEFT_INTERRUPTED;
        WeftMaterial average = match->copied;
        means_of(self, &match->copied, material->means);
        to_average(&average, material->means);
        material->search = search_for(self, &average);
    }
    return result;
}

static void search_run(void *user, int item, int thread) {
    (void)thread;
    AssetSearch *self = user;
    AverageSearch *search = &self->searches[item];
    ItemProgress item_progress = {.watch = &self->watch};
    WeftReflection *original = NULL;
    search->result = WEFT_INTERRUPTED;
    if (!progress_report(&item_progress, 0.0)) return;
    weft_material_choose(&search->average, CHOICE_profile, self->from);
    search->result = weft_reflection_create(&search->average, &original, &search->error);
    if (search->result != WEFT_OK) return;
    weft_material_choose(&search->average, CHOICE_profile, self->to);
    search->result = match_material(original, self->metric, self->locked, &item_progress, &search->average,
                                    &search->found, &search->error);
    weft_reflection_free(original);
    progress_report(&item_progress, 1.0);
}

static WeftResult search_all(AssetSearch *self, WeftError *error) {
    lock_rest(self->locked);
    if (!watch_loop(&self->watch, 0, self->search_count, search_run, self, self->progress, self->user))
        return WEFT_INTERRUPTED;
    for (int k = 0; k < self->search_count; k++) {
        const AverageSearch *search = &self->searches[k];
        if (search->result != WEFT_OK && error) *error = search->error;
        if (search->result != WEFT_OK) return search->result;
    }
    return WEFT_OK;
}

/* Writes the result of each search to its materials, as factors. */
static void write_matches(AssetSearch *self) {
    for (int k = 0; k < self->count; k++) {
        WeftAssetMatch *match = &self->matches[k];
        AssetMaterial *material = &self->materials[k];
        if (material->search < 0) continue;
        const AverageSearch *search = &self->searches[material->search];
        WeftMaterial found = search->average;
        match->found = search->found;
        match->clipped = to_factors(&found, material->means);
        for (int f = 0; f < FACTORS; f++)
            memcpy(match->matched.inputs[factors[f]].value, found.inputs[factors[f]].value, sizeof found.inputs->value);
        match->changed = 1;
        match->search = material->search + 1;
    }
}

static WeftResult asset_match(AssetSearch *self, WeftError *error) {
    self->count = self->scene->material_count;
    size_t count = (size_t)self->count;
    self->means = alloc_array((size_t)self->scene->texture_count, sizeof *self->means);
    self->materials = alloc_array(count, sizeof *self->materials);
    self->searches = alloc_array(count, sizeof *self->searches);
    self->matches = alloc_array(count, sizeof *self->matches);
    if (!self->means || !self->materials || !self->searches || !self->matches)
        return fail(error, WEFT_MESSAGE_MEMORY, "a match", NULL);
    WeftResult result = plan(self, error);
    if (result == WEFT_OK) result = search_all(self, error);
    if (result == WEFT_OK) write_matches(self);
    return result;
}

static WeftResult asset_write(const AssetSearch *self, Asset *asset, const char *out, WeftError *error) {
    Rewrite rewrite;
    WeftResult result = rewrite_begin(&rewrite, asset, error);
    for (int k = 0; k < self->count && result == WEFT_OK; k++)
        if (self->matches[k].changed) result = material_write(&rewrite, k, &self->matches[k], error);
    if (result == WEFT_OK) result = rewrite_save(&rewrite, out, error);
    rewrite_end(&rewrite);
    return result;
}

/* Reports no progress while the file is read, which takes little time beside the searches, but passes on a stop. */
static int while_reading(void *user, double fraction) {
    AssetSearch *self = user;
    (void)fraction;
    return self->progress ? self->progress(self->user, 0.0) : 0;
}

static WeftResult asset_rewrite(AssetSearch *self, const char *path, const char *out, const WeftLog *log,
                                WeftError *error) {
    WeftError own;
    WeftResult result = weft_scene_load_watched(path, while_reading, self, &self->scene, log, error);
    if (result == WEFT_OK) result = asset_match(self, error);
    if (result != WEFT_OK) return result;
    Asset asset = {.error = error ? error : &own};
    gltf_open(&asset, path, NULL, 0);
    result = asset.result;
    if (result == WEFT_OK) result = asset_write(self, &asset, out, error);
    gltf_close(&asset);
    return result;
}

WeftResult weft_match_asset(const char *path, const char *out, int from, int to, WeftBrdfMetric metric,
                            WeftProgress progress, void *user, WeftAssetMatch **report, int *count, const WeftLog *log,
                            WeftError *error) {
    AssetSearch self = {.from = from, .to = to, .metric = metric, .progress = progress, .user = user};
    char number[32];
    *count = 0;
    if (report) *report = NULL;
    snprintf(number, sizeof number, "%d, %d", from, to);
    if (!weft_profile_name(from) || !weft_profile_name(to)) return fail(error, WEFT_MESSAGE_DESC, number, NULL);
    WeftResult result = asset_rewrite(&self, path, out, log, error);
    *count = self.count;
    if (result == WEFT_OK && report) {
        *report = self.matches;
        self.matches = NULL;
    }
    free(self.matches);
    free(self.searches);
    free(self.materials);
    free(self.means);
    weft_scene_free(self.scene);
    return result;
}

void weft_match_report_free(WeftAssetMatch *report) { free(report); }
