/* deliver.c - a glTF file for one viewer: matched, without what the viewer ignores, and matched again where that shows */
#include "weft/deliver.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/printable.h"
#include "gltf/asset/material_fields.h"
#include "gltf/read/gltf.h"
#include "measure/match/average.h"
#include "measure/match/match.h"
#include "measure/match/match_factor.h"
#include "measure/match/viewer_reads.h"
#include "scene/record/material_at.h"
#include "shading/material/choice.h"

/* A material on its way. */
typedef struct Parcel {
    bool limited;         /* what was taken out of it changes its light */
    bool open[FACTORS];   /* the file as written has a place for the factor */
    bool glass;           /* the original is of glass, whose base colour is that of the light that goes through */
    WeftMaterial source;  /* the original, with the means of its textures */
    WeftMaterial written; /* the same of the file as written, under the profile of the target */
    double means[FACTORS][3];
    WeftReflection *original;
} Parcel;

typedef struct Delivering {
    const char *path, *out;
    int from, target, profile; /* profile: the target's, as an index */
    WeftBrdfMetric metric;
    WeftProgress progress; /* may be NULL */
    void *user;
    double low, high; /* the part of the work that runs */
    WeftScene *source;
    Parcel *parcels; /* `count` */
    WeftDelivered *delivered;
    WeftLosses losses;
    int count;
    LoopWatch watch;
    WeftError *errors; /* of the searches */
    WeftResult *results;
} Delivering;

/* Passes on the progress of a part of the work, as a WeftProgress. */
static int part_heed(void *user, double fraction) {
    const Delivering *self = user;
    return self->progress ? self->progress(self->user, self->low + fraction * (self->high - self->low)) : 0;
}

static WeftProgress part(Delivering *self, double low, double high) {
    self->low = low;
    self->high = high;
    return part_heed;
}

/* Returns the profile of that name, as weft_profile_name counts; -1 where there is none. */
static int profile_find(const char *name) {
    int k = 0;
    while (weft_profile_name(k) && strcmp(weft_profile_name(k), name) != 0) k++;
    return weft_profile_name(k) ? k : -1;
}

/* Takes the average of each material of a scene. to: of the file as it was written, else of the original. */
static WeftResult averages_read(Delivering *self, const WeftScene *scene, bool to, WeftError *error) {
    Averages averages = {.scene = scene};
    WeftResult result = WEFT_OK;
    for (int k = 0; k < self->count && result == WEFT_OK; k++) {
        Parcel *parcel = &self->parcels[k];
        WeftMaterial *average = to ? &parcel->written : &parcel->source;
        bool room = true;
        result = weft_scene_material(scene, k, average, error);
        for (int f = 0; f < FACTORS && result == WEFT_OK && to; f++)
            room = room && averages_of(&averages, average, (int)match_factors[f], parcel->means[f]);
        if (result == WEFT_OK) room = room && averages_take(&averages, average);
        if (result == WEFT_OK && !room) result = fail(error, WEFT_MESSAGE_MEMORY, self->path, NULL);
        if (to || self->from >= 0) weft_material_choose(average, CHOICE_profile, to ? self->profile : self->from);
        if (result == WEFT_OK && part_heed(self, 0.0)) result = WEFT_INTERRUPTED;
    }
    averages_free(&averages);
    return result;
}

static WeftResult source_read(Delivering *self, const WeftLog *log, WeftError *error) {
    WeftResult result = weft_scene_load_watched(self->path, part(self, 0.0, 0.05), self, &self->source, log, error);
    if (result != WEFT_OK) return result;
    self->count = weft_scene_info(self->source).material_count;
    const size_t count = (size_t)self->count;
    self->parcels = alloc_array(count, sizeof *self->parcels);
    self->delivered = alloc_array(count, sizeof *self->delivered);
    self->errors = alloc_array(count, sizeof *self->errors);
    self->results = alloc_array(count, sizeof *self->results);
    if (!self->parcels || !self->delivered || !self->errors || !self->results)
        return fail(error, WEFT_MESSAGE_MEMORY, self->path, NULL);
    for (int k = 0; k < self->count; k++)
        printable(weft_scene_material_name(self->source, k), self->delivered[k].name, sizeof self->delivered->name);
    return averages_read(self, self->source, false, error);
}

/* Finds the factors that a material of the file has a place for: no extension is added. */
static void factors_open(Parcel *parcel, const json_t *material) {
    for (int f = 0; f < FACTORS; f++) {
        const MaterialField *field = material_field_of(match_factors[f]);
        parcel->open[f] = !material_field_extends(field) ||
                          json_object_get(json_object_get(material, "extensions"), field->object) != NULL;
    }
}

/* Writes the file without what the target does not read. */
static WeftResult file_limit(Delivering *self, const char *path, WeftError *error) {
    WeftError own;
    Asset asset = {.error = error ? error : &own};
    Rewrite rewrite;
    gltf_open(&asset, path, NULL, 0);
    WeftResult result = asset.result == WEFT_OK ? rewrite_begin(&rewrite, &asset, error) : asset.result;
    if (result == WEFT_OK) {
        json_t *materials = json_object_get(rewrite.root, "materials");
        for (int k = 0; k < self->count && result == WEFT_OK; k++) {
            json_t *material = json_array_get(materials, (size_t)k);
            if (!material) continue;
            result = viewer_limit(&rewrite, self->target, material,
                                  &(ViewerLimit){&self->losses, k, self->delivered[k].name}, &self->parcels[k].limited,
                                  error);
            factors_open(&self->parcels[k], material);
        }
        viewer_uses(&rewrite, self->target);
        if (result == WEFT_OK) result = rewrite_save(&rewrite, self->out, error);
        rewrite_end(&rewrite);
    }
    gltf_close(&asset);
    return result;
}

/* Fills in the light that a part of a reflection returns under an even sky, by channels: 2 times the integral of E over the
 * square of the cosine, by midpoints. */
static void sky_of(const WeftReflection *reflection, int part, double sky[3]) {
    enum { STEPS = 12 };
    memset(sky, 0, 3 * sizeof *sky);
    for (int k = 0; k < STEPS; k++) {
        float e[3];
        weft_reflection_albedo(reflection, part, (float)(sqrt)(((double)k + 0.5) / STEPS), e);
        for (int c = 0; c < 3; c++) sky[c] += (double)e[c] / STEPS;
    }
}

static double even_sky(const WeftReflection *reflection) {
    double sky[3];
    sky_of(reflection, WEFT_PART_ALL, sky);
    return (sky[0] + sky[1] + sky[2]) / 3.0;
}

/* Makes glass opaque for the search and for the judgement where the target's profile shows none, since reflections would
 * then be those of two things. */
static WeftResult glass_set_aside(Delivering *self, WeftError *error) {
    for (int k = 0; k < self->count; k++) {
        Parcel *parcel = &self->parcels[k];
        parcel->glass = material_has_glass(&parcel->source);
        if (!parcel->glass || material_has_glass(&parcel->written)) continue;
        parcel->source.inputs[INPUT_transmission].value[0] = 0.0f;
        parcel->written.inputs[INPUT_transmission].value[0] = 0.0f;
        if (!weft_losses_add(&self->losses, k, self->delivered[k].name, "glass",
                             "it is matched and judged as if it were opaque, in its own base colour"))
            return fail(error, WEFT_MESSAGE_MEMORY, self->path, NULL);
    }
    return WEFT_OK;
}

/* Locks every input but the factors that can be written. Of glass the base colour stays: its reflection does not have it. */
static void lock_rest(const Parcel *parcel, int locked[WEFT_INPUTS_MAX]) {
    factors_unlock(locked);
    locked[INPUT_base_color] = parcel->glass;
    for (int f = 0; f < FACTORS; f++) locked[match_factors[f]] |= !parcel->open[f];
}

/* Leaves no number above what a factor of 1 gives with the means of its textures. */
static void parcel_clip(Parcel *parcel) {
    for (int f = 0; f < FACTORS; f++)
        for (int c = 0; c < 3; c++) {
            float *value = &parcel->written.inputs[match_factors[f]].value[c];
            *value = fminf(*value, (float)parcel->means[f][c]);
        }
}

/* Scales the base colour so that the material returns as much light under an even sky as the original. Without a rim the
 * least error over directions is darker, since it gives up the rim. */
static WeftResult parcel_level(Parcel *parcel, WeftError *error) {
    WeftReflection *now = NULL;
    double original[3], all[3], diffuse[3];
    const WeftResult result = weft_reflection_create(&parcel->written, &now, error);
    if (result != WEFT_OK) return result;
    sky_of(parcel->original, WEFT_PART_ALL, original);
    sky_of(now, WEFT_PART_ALL, all);
    sky_of(now, WEFT_PART_DIFFUSE, diffuse);
    weft_reflection_free(now);
    for (int c = 0; c < 3; c++) {
        float *value = &parcel->written.inputs[INPUT_base_color].value[c];
        const double scale = 1.0 + (original[c] - all[c]) / fmax(diffuse[c], 1e-4);
        *value = (float)fmin(fmax((double)*value * scale, 0.0), 1.0);
    }
    return WEFT_OK;
}

/* Returns true if the factors of a material are searched: what is unlit reflects nothing. */
static bool is_due(const Delivering *self, const Parcel *parcel) {
    return !parcel->source.unlit && (parcel->limited || self->from < 0);
}

/* Returns true if a target shows no rim at all. */
static bool is_bare(const Delivering *self) { return strcmp(weft_profile_name(self->profile), "core") == 0; }

/* Searches one material, where that is due, and measures it. */
static WeftResult parcel_match(Delivering *self, int k, ItemProgress *item_progress, WeftError *error) {
    Parcel *parcel = &self->parcels[k];
    WeftDelivered *delivered = &self->delivered[k];
    WeftReflection *copy = NULL, *now = NULL;
    WeftMaterial plain = parcel->source;
    int locked[WEFT_INPUTS_MAX];
    lock_rest(parcel, locked);
    weft_material_choose(&plain, CHOICE_profile, self->profile);
    WeftResult result = weft_reflection_create(&parcel->source, &parcel->original, error);
    const bool due = is_due(self, parcel);
    if (result == WEFT_OK && due)
        result = match_material(parcel->original, self->metric, locked, item_progress, &parcel->written,
                                &delivered->found, error);
    const bool levels = parcel->limited && is_bare(self) && !parcel->glass;
    if (result == WEFT_OK && due && levels) result = parcel_level(parcel, error);
    parcel_clip(parcel);
    if (result == WEFT_OK) result = weft_reflection_create(&plain, &copy, error);
    if (result == WEFT_OK) result = weft_reflection_create(&parcel->written, &now, error);
    if (result == WEFT_OK)
        result =
            weft_brdf_distance(copy, parcel->original, WEFT_PART_ALL, self->metric, &delivered->found.copied, error);
    if (result == WEFT_OK)
        result =
            weft_brdf_distance(now, parcel->original, WEFT_PART_ALL, self->metric, &delivered->found.matched, error);
    if (result == WEFT_OK) delivered->even_sky = even_sky(now) / fmax(even_sky(parcel->original), 1e-6) - 1.0;
    weft_reflection_free(copy);
    weft_reflection_free(now);
    return result;
}

static void parcel_run(void *user, int item, int thread) {
    (void)thread;
    Delivering *self = user;
    ItemProgress item_progress = {.watch = &self->watch};
    self->results[item] = WEFT_INTERRUPTED;
    if (!progress_report(&item_progress, 0.0)) return;
    self->results[item] = parcel_match(self, item, &item_progress, &self->errors[item]);
    progress_report(&item_progress, 1.0);
}

static WeftResult match_all(Delivering *self, WeftError *error) {
    WeftProgress progress = part(self, 0.6, 0.95);
    if (!watch_loop(&self->watch, 0, self->count, parcel_run, self, progress, self)) return WEFT_INTERRUPTED;
    for (int k = 0; k < self->count; k++) {
        if (self->results[k] != WEFT_OK && error) *error = self->errors[k];
        if (self->results[k] != WEFT_OK) return self->results[k];
    }
    return WEFT_OK;
}

/* Writes a factor to a material. An extension that the material lacks is not added, since nothing was there to fit. */
static void factor_write(json_t *material, const MaterialField *field, const float *value) {
    const bool extends = material_field_extends(field);
    json_t *parts = extends ? json_object_get(material, "extensions") : material;
    json_t *home = extends ? json_object_get(parts, field->object) : factor_home(material, field->object);
    if (home) factor_put(home, field, value);
}

/* Writes what a search found, over the means of the textures that stay. */
static void parcel_write(const Parcel *parcel, json_t *material) {
    for (int f = 0; f < FACTORS; f++) {
        float value[3];
        for (int c = 0; c < 3; c++) {
            const double mean = fmax(parcel->means[f][c], 1e-4);
            value[c] = (float)fmin((double)parcel->written.inputs[match_factors[f]].value[c] / mean, 1.0);
        }
        factor_write(material, material_field_of(match_factors[f]), value);
    }
}

/* Writes the factors that were found, and lists what the file uses. */
static WeftResult file_finish(Delivering *self, WeftDelivery *delivery, WeftError *error) {
    WeftError own;
    Asset asset = {.error = error ? error : &own};
    Rewrite rewrite;
    gltf_open(&asset, self->out, NULL, 0);
    WeftResult result = asset.result == WEFT_OK ? rewrite_begin(&rewrite, &asset, error) : asset.result;
    if (result == WEFT_OK) {
        json_t *materials = json_object_get(rewrite.root, "materials");
        for (int k = 0; k < self->count && result == WEFT_OK; k++) {
            json_t *material = json_array_get(materials, (size_t)k);
            if (!material) continue;
            if (is_due(self, &self->parcels[k])) parcel_write(&self->parcels[k], material);
            viewer_strength_fold(self->target, material);
            result = viewer_specular_put(&rewrite, self->target, material, error);
        }
        if (result == WEFT_OK) {
            delivery->extensions = viewer_extensions_text(rewrite.root);
            result = delivery->extensions ? rewrite_save(&rewrite, self->out, error)
                                          : fail(error, WEFT_MESSAGE_MEMORY, self->out, NULL);
        }
        rewrite_end(&rewrite);
    }
    gltf_close(&asset);
    return result;
}

/* Matches the sheens as weft_match_asset does, where the target has any, and takes out what it does not read. */
static WeftResult file_make(Delivering *self, WeftError *error) {
    int count;
    const bool sheens = !is_bare(self) && self->from >= 0;
    WeftResult result = WEFT_OK;
    if (sheens)
        result = weft_match_asset(self->path, self->out, self->from, self->profile, self->metric, part(self, 0.05, 0.5),
                                  self, NULL, &count, NULL, error);
    if (result == WEFT_OK) result = file_limit(self, sheens ? self->out : self->path, error);
    return result;
}

static WeftResult written_read(Delivering *self, WeftError *error) {
    WeftScene *scene = NULL;
    WeftResult result = weft_scene_load_watched(self->out, part(self, 0.5, 0.6), self, &scene, NULL, error);
    if (result == WEFT_OK) result = averages_read(self, scene, true, error);
    weft_scene_free(scene);
    return result;
}

WeftResult weft_deliver(const char *path, const char *out, int from, int target, WeftBrdfMetric metric,
                        WeftProgress progress, void *user, WeftDelivery *delivery, const WeftLog *log,
                        WeftError *error) {
    WeftDelivery own = {.materials = NULL};
    WeftTarget info;
    char number[48];
    if (delivery) *delivery = own;
    snprintf(number, sizeof number, "target %d, profile %d", target, from);
    if (!weft_target_info(target, &info) || (from >= 0 && !weft_profile_name(from)))
        return fail(error, WEFT_MESSAGE_DESC, number, NULL);
    Delivering self = {.path = path,
                       .out = out,
                       .from = from,
                       .target = target,
                       .profile = profile_find(info.profile),
                       .metric = metric,
                       .progress = progress,
                       .user = user};
    WeftResult result = source_read(&self, log, error);
    if (result == WEFT_OK) result = file_make(&self, error);
    if (result == WEFT_OK) result = written_read(&self, error);
    if (result == WEFT_OK) result = glass_set_aside(&self, error);
    if (result == WEFT_OK) result = match_all(&self, error);
    if (result == WEFT_OK) result = file_finish(&self, &own, error);
    for (int k = 0; k < self.count && self.parcels; k++) weft_reflection_free(self.parcels[k].original);
    if (result == WEFT_OK && delivery) {
        own.materials = self.delivered;
        own.material_count = self.count;
        own.losses = self.losses;
        *delivery = own;
        self.delivered = NULL;
        self.losses = (WeftLosses){.items = NULL};
    } else {
        weft_delivery_free(&own);
    }
    weft_scene_free(self.source);
    weft_losses_free(&self.losses);
    free(self.parcels);
    free(self.delivered);
    free(self.errors);
    free(self.results);
    return result;
}

void weft_delivery_free(WeftDelivery *delivery) {
    if (!delivery) return;
    free(delivery->materials);
    free(delivery->extensions);
    weft_losses_free(&delivery->losses);
    *delivery = (WeftDelivery){.materials = NULL};
}
