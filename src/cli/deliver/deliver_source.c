/* deliver_source.c - the source of a delivery, as a scene and as a glTF file */
#define _XOPEN_SOURCE 700
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/path.h"
#include "cli/console/names.h"
#include "cli/console/report.h"
#include "cli/deliver/delivery.h"
#include "cli/operands/draft_operand.h"

static bool is_preset(const char *what) { return kind_find(kind_of("preset"), what) >= 0; }

SourceKind source_kind(const char *what) {
    if (path_ends(what, ".gltf") || path_ends(what, ".glb")) return SOURCE_ASSET;
    if (path_builtin(what)) return SOURCE_SCENE;
    if (path_ends(what, ".json") || path_is_cloth(what) || strncmp(what, "preset:", 7) == 0 || is_preset(what))
        return SOURCE_MATERIAL;
    return weft_reflection_readable(what) ? SOURCE_MEASURED : SOURCE_DRAFT;
}

int told(WeftResult result, const WeftError *error) {
    return result == WEFT_OK || result == WEFT_INTERRUPTED ? (int)result : report_error(error);
}

static int material_load(const char *what, WeftScene *scene, const WeftLog *log) {
    WeftError error;
    char path[DELIVER_PATH];
    snprintf(path, sizeof path, "%s%s", is_preset(what) ? "preset:" : "", what);
    return told(weft_scene_assign_material(scene, NULL, path, log, &error), &error);
}

/* Returns true for a file that is none of those that can be delivered, by its name and by what it holds. */
static bool is_foreign(const char *what) {
    WeftDraft *draft = NULL;
    WeftError error;
    if (path_is_draft(what) || access(what, R_OK) != 0) return false;
    const WeftResult result = weft_draft_read(what, &draft, NULL, &error);
    weft_draft_free(draft);
    return result != WEFT_OK && error.message == WEFT_MESSAGE_DRAFT;
}

/* Weaves the cloth of the scene from a draft, as `weft weave` does. */
static int draft_load(const Delivery *delivery, WeftScene *scene, const WeftLog *log) {
    const Options *options = delivery->options;
    WeftDraft *draft = NULL;
    WeftYarn yarns[2];
    WeftError error;
    int result = draft_read(delivery->what, log, &draft);
    if (result == 0) result = draft_sett(option_text(options, "--sett"), draft);
    if (result == 0) result = yarns_read(option_text(options, "--yarn"), yarns);
    if (result == 0) result = told(weft_scene_weave(scene, "0", "draft", "plain", NULL, &error), &error);
    if (result == 0) result = told(weft_scene_set_weave(scene, 0, draft, yarns, &error), &error);
    if (result == 0)
        result = told(weft_scene_weave(scene, "0", "seed", option_text(options, "--seed"), NULL, &error), &error);
    if (result == 0) result = told(weft_scene_weave(scene, "0", "metres", "1", NULL, &error), &error);
    weft_draft_free(draft);
    return result;
}

static int woven_count(const WeftScene *scene) {
    WeftMaterial material;
    int count = 0;
    for (int k = 0; k < weft_scene_info(scene).material_count; k++)
        count += weft_scene_material(scene, k, &material, NULL) == WEFT_OK && material.cloth;
    return count;
}

/* Lets the materials of an asset look as in the engine that it was made for. */
static int profile_set(const Delivery *delivery, WeftScene *scene) {
    WeftMaterial material;
    WeftError error;
    const int choice = weft_material_choice_find("profile");
    for (int k = 0; k < weft_scene_info(scene).material_count; k++) {
        WeftResult result = weft_scene_material(scene, k, &material, &error);
        if (result == WEFT_OK && !material.cloth) {
            weft_material_choose(&material, choice, delivery->from);
            result = weft_scene_put_material(scene, k, &material, &error);
        }
        if (result != WEFT_OK) return report_error(&error);
    }
    return 0;
}

/* Decides what the numbers of the original mean, and what the pictures show. */
static int meaning_set(Delivery *delivery, SourceKind kind, WeftScene *scene) {
    const int khronos = kind_find(kind_of("profile"), "khronos");
    const int count = woven_count(scene);
    const bool woven = delivery->woven = count > 0;
    delivery->materials = weft_scene_info(scene).material_count;
    delivery->all_woven = count == delivery->materials;
    delivery->from = khronos;
    delivery->reference = "its threads";
    if (kind == SOURCE_ASSET) {
        delivery->from = kind_named(kind_of("profile"), option_text(delivery->options, "--from"));
        if (delivery->from < 0) return WEFT_USAGE;
        if (!woven) delivery->reference = "the asset in the engine it was made for";
        return profile_set(delivery, scene);
    }
    if (woven) return 0;
    delivery->from = -1;
    delivery->reference = "the material as weft draws it";
    return 0;
}

int source_load(Delivery *delivery, WeftScene **out) {
    static const WeftLog warnings = {.fn = report_warning};
    const WeftLog *log = delivery->loaded ? NULL : &warnings; /* each warning once */
    const SourceKind kind = source_kind(delivery->what);
    const bool file = kind == SOURCE_ASSET || kind == SOURCE_SCENE;
    WeftError error;
    *out = NULL;
    if (kind == SOURCE_MEASURED)
        return report(WEFT_USAGE,
                      "%.300s: is a measurement, not a material; fit one to it first: weft fit FILE -o fitted.json",
                      delivery->what);
    if (kind == SOURCE_DRAFT && is_foreign(delivery->what))
        return report(
            WEFT_INPUT,
            "%.300s: is nothing that can be delivered: neither an asset (.gltf, .glb), a material (.json, .u3m, "
            ".u3ma, .mtlx) nor a draft (.wif, .dtx, .wpo, a picture)",
            delivery->what);
    int result = told(weft_scene_load_watched(file ? delivery->what : "builtin:bend", delivery_heed, delivery, out,
                                              file ? log : NULL, &error),
                      &error);
    if (result == 0 && kind == SOURCE_MATERIAL) result = material_load(delivery->what, *out, log);
    if (result == 0 && kind == SOURCE_DRAFT) result = draft_load(delivery, *out, log);
    if (result == 0) result = meaning_set(delivery, kind, *out);
    if (result == 0 && !delivery->woven && !delivery->loaded && option_given(delivery->options, "--size"))
        report(0, "warning: --size is for cloth, and nothing is woven in %.300s", delivery->what);
    delivery->loaded = true;
    return result;
}

/* Writes the name of what cloth is baked for. */
static void baking_name(const WeftBaking *how, char name[64]) {
    snprintf(name, 64, "%.32s-%d-%d", how->profile, how->levels, how->one_face);
}

/* Gives a woven material the textures of its cloth, whose errors are kept with the source. */
static int cloth_bake(Delivery *delivery, WeftScene *scene, int index, const WeftBaking *how, BakedSource *source) {
    WeftBaking baking = *how;
    WeftError error;
    char folder[DELIVER_PATH];
    WeftMaterial material;
    const WeftResult result = weft_scene_material(scene, index, &material, &error);
    if (result != WEFT_OK || !material.cloth) return told(result, &error);
    baking.pixels = delivery->pixels;
    baking.losses = &delivery->losses;
    baking.progress = delivery_heed;
    baking.user = delivery;
    snprintf(folder, sizeof folder, "%.3900s/bake-%s-%d", delivery->temporary, source->name, index);
    return told(weft_scene_bake(scene, index, &baking, folder, &source->materials[index], &error), &error);
}

/* Returns the place for the errors of a baked source; NULL where memory is short. */
static BakedSource *source_add(Delivery *delivery, const WeftBaking *how) {
    BakedSource *source = &delivery->sources[delivery->source_count];
    source->materials = calloc((size_t)delivery->materials + 1, sizeof *source->materials);
    if (!source->materials) return NULL;
    baking_name(how, source->name);
    delivery->source_count++;
    return source;
}

int source_bake(Delivery *delivery, TargetFile *file, const WeftBaking *how, WeftScene **out) {
    int result = source_load(delivery, out);
    if (result != 0 || !delivery->woven) return result;
    const int count = delivery->materials;
    BakedSource *source = source_add(delivery, how);
    if (!source) return report(WEFT_RESOURCES, "%.300s: %s", delivery->what, weft_message_text(WEFT_MESSAGE_MEMORY));
    file->source = source;
    const double low = delivery->low, high = delivery->high, each = (high - low) / fmax(count, 1.0);
    for (int k = 0; k < count && result == 0; k++) {
        delivery_part(delivery, low + each * k, low + each * (k + 1));
        result = cloth_bake(delivery, *out, k, how, source);
        if (result == 0 && delivery_heed(delivery, 1.0)) result = WEFT_INTERRUPTED;
    }
    delivery_part(delivery, low, high);
    return result;
}

bool target_levels(const Delivery *delivery, const TargetFile *file) {
    return delivery->textures == TEXTURES_KTX2 ||
           (delivery->textures == TEXTURES_AUTO && file_target(file).levels != 0);
}

int source_write(Delivery *delivery, TargetFile *file, char path[DELIVER_PATH], int *from) {
    const WeftTarget target = file_target(file);
    const char *profile = target.fit;
    const bool levels = target_levels(delivery, file);
    WeftScene *scene = NULL;
    WeftError error;
    *from = delivery->from;
    if (!delivery->woven && source_kind(delivery->what) == SOURCE_ASSET) {
        snprintf(path, DELIVER_PATH, "%s", delivery->what);
        return 0;
    }
    if (delivery->all_woven)
        *from = kind_find(kind_of("profile"), target.profile);
    else if (delivery->from >= 0) /* beside cloth there is what was made for that engine, and the file is for one */
        profile = weft_profile_name(delivery->from);
    const WeftBaking how = {.profile = profile, .levels = levels, .one_face = 1};
    char name[64];
    baking_name(&how, name);
    snprintf(path, DELIVER_PATH, "%.3900s/source-%s.glb", delivery->temporary, name);
    for (int k = 0; k < delivery->source_count; k++)
        if (strcmp(delivery->sources[k].name, name) == 0) file->source = &delivery->sources[k];
    if (access(path, F_OK) == 0) return 0; /* made for an earlier target */
    int result = source_bake(delivery, file, &how, &scene);
    if (result == 0) result = told(weft_scene_save(scene, path, &error), &error);
    weft_scene_free(scene);
    return result;
}
