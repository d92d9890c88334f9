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
#include "measure/bsdf/material_key.h"
#include "measure/match/average.h"
#include "measure/match/match.h"
#include "measure/match/match_curves.h"
#include "measure/match/match_factor.h"
#include "measure/match/match_place.h"
#include "measure/match/match_texels.h"
#include "scene/record/scene.h"
#include "shading/material/choice.h"

/* Returns the range over a texture's pixels of the brightest channel of its colour times a factor. */
static ValueRange brightness_of(WeftImage image, const float factor[3]) {
    ValueRange range = {(double)INFINITY, -(double)INFINITY};
    size_t pixels = (size_t)image.width * (size_t)image.height;
    for (size_t k = 0; k < pixels; k++) {
        double most = 0.0;
        for (int c = 0; c < 3; c++) most = fmax(most, texture_value(&image, k, c, true) * (double)factor[c]);
        range.low = fmin(range.low, most);
        range.high = fmax(range.high, most);
    }
    return range;
}

/* One material of the asset. */
typedef struct AssetMaterial {
    double means[FACTORS][3]; /* mean of each factor's texture, by channel; 1 without a texture */
    int search;               /* index into `searches`; -1: the material has no sheen */
    WeftMaterial factors;     /* the factors of the match of the mean, which may be above 1 */
} AssetMaterial;

/* One search, for all materials whose textures have the same means and ranges. */
typedef struct AverageSearch {
    MaterialKey key;      /* of `average` */
    WeftMaterial average; /* without textures, which are replaced by their means; under profile `from` */
    WeftMaterial matched; /* under profile `to` */
    MatchCurves curves;   /* what becomes of texels */
    WeftMatch found;
} AverageSearch;

/* One run of a search, for a mean or at a node of its curves. */
typedef struct NodeSearch {
    int search, index;
    CurveNode node;
    WeftMatch found;
    WeftResult result;
    WeftError error;
} NodeSearch;

typedef struct AssetSearch {
    WeftScene *scene;
    int from, to; /* profiles */
    WeftBrdfMetric metric;
    WeftProgress progress; /* may be NULL */
    void *user;
    LoopWatch watch;
    TextureChannel (*channels)[2][4]; /* [texture - 1][0: data, 1: sRGB colours][channel] */
    AssetMaterial *materials;         /* `count` */
    AverageSearch *searches;          /* `search_count`, at most `count` */
    NodeSearch *nodes;                /* of the phase in hand */
    WeftAssetMatch *matches;
    int count, search_count;
    int done, whole, now; /* runs of phases that are done, of all phases, of the phase in hand */
} AssetSearch;

static const TextureChannel *channel_at(AssetSearch *self, const WeftInput *input, int channel, bool color) {
    static const TextureChannel one = {true, 1.0, 1.0, 1.0};
    if (!input->texture) return &one;
    TextureChannel *kept = &self->channels[input->texture - 1][color][channel];
    if (kept->done) return kept;
    const WeftImage image = weft_scene_texture(self->scene, input->texture);
    *kept = texture_channel(&image, channel, color);
    return kept;
}

static void means_of(AssetSearch *self, const WeftMaterial *material, double means[FACTORS][3]) {
    for (int f = 0; f < FACTORS; f++) {
        const WeftInput *input = &material->inputs[match_factors[f]];
        bool color = input_value_count(match_factors[f]) > 1;
        for (int c = 0; c < 3; c++) means[f][c] = channel_at(self, input, color ? c : input->channel, color)->mean;
    }
}

/* Multiplies the numbers by the means of their textures and removes the textures. */
static void to_average(AssetSearch *self, WeftMaterial *material) {
    for (int k = 0; k < INPUT_COUNT; k++) {
        WeftInput *input = &material->inputs[k];
        const WeftInputKind kind = input_infos[k].kind;
        const bool color = kind == WEFT_INPUT_COLOR;
        for (int c = 0; c < input_value_count((InputId)k) && (color || kind == WEFT_INPUT_SCALAR); c++) {
            const double mean = channel_at(self, input, color ? c : input->channel, color)->mean;
            input->value[c] = (float)((double)input->value[c] * mean);
        }
        input->texture = 0;
    }
}

/* Returns the range of a number times its texture. */
static ValueRange range_of(AssetSearch *self, const WeftInput *input) {
    const TextureChannel *channel = channel_at(self, input, input->channel, false);
    const double factor = (double)input->value[0];
    return (ValueRange){channel->low * factor, channel->high * factor};
}

/* Finds what the texels of a material vary in. */
static MatchCurves curves_of(AssetSearch *self, const WeftMaterial *material) {
    const WeftInput *color = &material->inputs[INPUT_sheen_color];
    MatchCurves curves = {.sheen_roughness = range_of(self, &material->inputs[INPUT_sheen_roughness]),
                          .roughness = range_of(self, &material->inputs[INPUT_roughness])};
    if (color->texture)
        curves.brightness = brightness_of(weft_scene_texture(self->scene, color->texture), color->value);
    curves_begin(&curves, texels_joined(material));
    return curves;
}

/* Undoes to_average: divides the numbers by the means. */
static void to_factors(WeftMaterial *material, double means[FACTORS][3]) {
    for (int f = 0; f < FACTORS; f++)
        for (int c = 0; c < input_value_count(match_factors[f]); c++) {
            float *value = &material->inputs[match_factors[f]].value[c];
            if (means[f][c] > 1e-4) *value = (float)((double)*value / means[f][c]);
        }
}

/* Takes over the factors, of which glTF allows 1 at most. */
static void factors_take(const WeftMaterial *from, WeftMaterial *to) {
    for (int f = 0; f < FACTORS; f++)
        for (int c = 0; c < input_value_count(match_factors[f]); c++)
            to->inputs[match_factors[f]].value[c] = fminf(from->inputs[match_factors[f]].value[c], 1.0f);
}

/* Returns 1 if a factor was above 1 whose texture was not rewritten. */
static int is_clipped(const WeftMaterial *material, uint64_t maps) {
    int clipped = 0;
    for (int f = 0; f < FACTORS; f++)
        for (int c = 0; c < input_value_count(match_factors[f]); c++)
            clipped |= !(maps >> match_factors[f] & 1) && material->inputs[match_factors[f]].value[c] > 1.0f + 1e-6f;
    return clipped;
}

static bool has_sheen(const WeftMaterial *material) {
    const float *color = material->inputs[INPUT_sheen_color].value;
    return !material->unlit && color[0] + color[1] + color[2] > 0.0f;
}

/* Writes a factor that has changed to the JSON. */
static WeftResult factor_write(Rewrite *rewrite, json_t *material, const MaterialField *factor, const float *value,
                               WeftError *error) {
    const bool extends = material_field_extends(factor);
    json_t *home = factor_home(extends ? factor_home(material, "extensions") : material, factor->object);
    if (extends) {
        WeftResult result = rewrite_uses(rewrite, factor->object, error);
        if (result != WEFT_OK) return result;
    }
    factor_put(home, factor, value);
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
        const float *was = match->copied.inputs[match_factors[f]].value,
                    *now = match->matched.inputs[match_factors[f]].value;
        if (!same(was, now, input_value_count(match_factors[f])))
            result = factor_write(rewrite, material, material_field_of(match_factors[f]), now, error);
    }
    return result;
}

static bool same_range(ValueRange a, ValueRange b) {
    return fabs(a.low - b.low) <= 0.0 && fabs(a.high - b.high) <= 0.0;
}

/* Returns true if both have the same texels around their nodes. */
static bool same_means(const MatchCurves *a, const MatchCurves *b) {
    return memcmp((const char *)a->mean, (const char *)b->mean, sizeof a->mean) == 0;
}

static bool same_ranges(const MatchCurves *a, const MatchCurves *b) {
    return same_range(a->sheen_roughness, b->sheen_roughness) && same_range(a->brightness, b->brightness) &&
           same_range(a->roughness, b->roughness) && a->rows == b->rows && same_means(a, b);
}

/* Returns the index of the search for a material without textures; adds the search if there is none yet. */
static int search_for(AssetSearch *self, const WeftMaterial *average, const MatchCurves *curves) {
    const MaterialKey key = material_key(average);
    int k = 0;
    while (k < self->search_count &&
           !(material_key_same(&self->searches[k].key, &key) && same_ranges(&self->searches[k].curves, curves)))
        k++;
    if (k == self->search_count)
        self->searches[self->search_count++] = (AverageSearch){.key = key, .average = *average, .curves = *curves};
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
        MatchCurves curves = curves_of(self, &match->copied);
        WeftMaterial average = match->copied;
        means_of(self, &match->copied, material->means);
        to_average(self, &average);
        place_means(self->scene, &match->copied, &average, &curves);
        average.inputs[INPUT_transmission].value[0] =
            0.0f; /* a reflection knows no colour of glass: as if it were opaque */
        weft_material_choose(&average, CHOICE_profile, self->from);
        material->search = search_for(self, &average, &curves);
    }
    return result;
}

/* The phases: the means, then those of the curves. */
enum { PHASES = 1 + CURVE_PHASES };

static int phase_runs(const AverageSearch *search, int phase) {
    return phase == 0 ? 1 : curves_nodes(&search->curves, phase - 1);
}

static int phase_total(const AssetSearch *self, int phase) {
    int total = 0;
    for (int k = 0; k < self->search_count; k++) total += phase_runs(&self->searches[k], phase);
    return total;
}

static void node_prepare(const AssetSearch *self, int phase, NodeSearch *run) {
    const AverageSearch *search = &self->searches[run->search];
    if (phase > 0) {
        curves_node(&search->curves, phase - 1, run->index, &search->average, &search->matched, &run->node);
        return;
    }
    run->node = (CurveNode){.from = search->average, .to = search->average};
    weft_material_choose(&run->node.to, CHOICE_profile, self->to);
    factors_unlock(run->node.locked);
    /* the mean is no measure for texels that differ much, and the specular has no texture that could follow them */
    run->node.locked[INPUT_specular] |= curves_vary_sheen(&search->curves);
}

static void node_take(AssetSearch *self, int phase, const NodeSearch *run) {
    AverageSearch *search = &self->searches[run->search];
    if (phase > 0) {
        curves_take(&search->curves, phase - 1, run->index, &run->node);
        return;
    }
    search->matched = run->node.to;
    search->found = run->found;
}

static void node_run(void *user, int item, int thread) {
    (void)thread;
    AssetSearch *self = user;
    NodeSearch *run = &self->nodes[item];
    ItemProgress item_progress = {.watch = &self->watch};
    WeftReflection *original = NULL;
    run->result = WEFT_INTERRUPTED;
    if (!progress_report(&item_progress, 0.0)) return;
    run->result = weft_reflection_create(&run->node.from, &original, &run->error);
    if (run->result != WEFT_OK) return;
    run->result = match_material(original, self->metric, run->node.locked, &item_progress, &run->node.to, &run->found,
                                 &run->error);
    weft_reflection_free(original);
    progress_report(&item_progress, 1.0);
}

/* Reports the progress of a phase as that of all. */
static int phase_progress(void *user, double fraction) {
    AssetSearch *self = user;
    return self->progress ? self->progress(self->user, (self->done + fraction * self->now) / self->whole) : 0;
}

static WeftResult phase_run(AssetSearch *self, int phase, WeftError *error) {
    int run = 0;
    for (int k = 0; k < self->search_count; k++)
        for (int index = 0; index < phase_runs(&self->searches[k], phase); index++, run++) {
            self->nodes[run] = (NodeSearch){.search = k, .index = index};
            node_prepare(self, phase, &self->nodes[run]);
        }
    self->now = run;
    self->watch = (LoopWatch){0};
    if (!watch_loop(&self->watch, 0, run, node_run, self, phase_progress, self)) return WEFT_INTERRUPTED;
    for (int k = 0; k < run; k++) {
        if (self->nodes[k].result != WEFT_OK && error) *error = self->nodes[k].error;
        if (self->nodes[k].result != WEFT_OK) return self->nodes[k].result;
        node_take(self, phase, &self->nodes[k]);
    }
    for (int k = 0; k < self->search_count && phase == 1; k++) curves_straighten(&self->searches[k].curves);
    self->done += run;
    return WEFT_OK;
}

static WeftResult search_all(AssetSearch *self, WeftError *error) {
    int most = 0;
    for (int phase = 0; phase < PHASES; phase++) {
        const int total = phase_total(self, phase);
        self->whole += total;
        if (total > most) most = total;
    }
    self->nodes = alloc_array((size_t)most, sizeof *self->nodes);
    if (!self->nodes) return fail(error, WEFT_MESSAGE_MEMORY, "a match", NULL);
    WeftResult result = WEFT_OK;
    for (int phase = 0; phase < PHASES && result == WEFT_OK; phase++)
        if (phase_total(self, phase) > 0) result = phase_run(self, phase, error);
    free(self->nodes);
    self->nodes = NULL;
    return result;
}

/* Writes the result of each search to its materials, as factors. */
static void write_matches(AssetSearch *self) {
    for (int k = 0; k < self->count; k++) {
        WeftAssetMatch *match = &self->matches[k];
        AssetMaterial *material = &self->materials[k];
        if (material->search < 0) continue;
        const AverageSearch *search = &self->searches[material->search];
        material->factors = search->matched;
        to_factors(&material->factors, material->means);
        match->found = search->found;
        factors_take(&material->factors, &match->matched);
        match->changed = 1;
        match->search = material->search + 1;
    }
}

static WeftResult asset_match(AssetSearch *self, WeftError *error) {
    self->count = self->scene->material_count;
    size_t count = (size_t)self->count;
    self->channels = alloc_array((size_t)self->scene->texture_count, sizeof *self->channels);
    self->materials = alloc_array(count, sizeof *self->materials);
    self->searches = alloc_array(count, sizeof *self->searches);
    self->matches = alloc_array(count, sizeof *self->matches);
    if (!self->channels || !self->materials || !self->searches || !self->matches)
        return fail(error, WEFT_MESSAGE_MEMORY, "a match", NULL);
    WeftResult result = plan(self, error);
    if (result == WEFT_OK) result = search_all(self, error);
    if (result == WEFT_OK) write_matches(self);
    return result;
}

/* Rewrites the textures and the factors of a material. */
static WeftResult material_rewrite(const AssetSearch *self, Rewrite *rewrite, int index, WeftError *error) {
    json_t *material = json_array_get(json_object_get(rewrite->root, "materials"), (size_t)index);
    WeftAssetMatch *match = &self->matches[index];
    const TexelMatch texels = {.scene = self->scene,
                               .material = &match->copied,
                               .curves = &self->searches[match->search - 1].curves,
                               .factors = &self->materials[index].factors,
                               .from = self->from,
                               .to = self->to,
                               .metric = self->metric,
                               .progress = self->progress,
                               .user = self->user};
    if (!material) return WEFT_OK;
    WeftResult result = texels_rewrite(&texels, rewrite, material, &match->matched, &match->maps, &match->found, error);
    match->clipped = is_clipped(&self->materials[index].factors, match->maps);
    return result == WEFT_OK ? material_write(rewrite, index, match, error) : result;
}

static WeftResult asset_write(const AssetSearch *self, Asset *asset, const char *out, WeftError *error) {
    Rewrite rewrite;
    WeftResult result = rewrite_begin(&rewrite, asset, error);
    for (int k = 0; k < self->count && result == WEFT_OK; k++)
        if (self->matches[k].changed) result = material_rewrite(self, &rewrite, k, error);
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
    free(self.channels);
    weft_scene_free(self.scene);
    return result;
}

void weft_match_report_free(WeftAssetMatch *report) { free(report); }
