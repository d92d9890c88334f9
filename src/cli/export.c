/* export.c - `weft export`: a lobe, a profile or a material as text for an engine, with its tables */
#include "weft/export.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "given_lobe.h"
#include "json.h"
#include "layout.h"
#include "names.h"
#include "output.h"
#include "report.h"
#include "table_file.h"
#include "verbs.h"

/* What is exported, and where its parts are kept. */
typedef struct Subject {
    WeftLobe lobe, right;
    WeftMaterial material;
    char name[96]; /* of the material */
} Subject;

typedef struct Export {
    const Options *options;
    WeftExportDesc desc;
    Subject subject;
    WeftExport made;
    bool quiet;
} Export;

static void say_warning(void *user, WeftMessage message, const char *text) {
    (void)message;
    if (!*(bool *)user) report(0, "warning: %s", text);
}

static bool ends_in(const char *text, const char *end) {
    size_t size = strlen(text), most = strlen(end);
    return size > most && strcmp(text + size - most, end) == 0;
}

/* The material of that number, under its name or that of its file. */
static WeftResult take_material(Export *self, WeftScene *scene, int index, const char *path,
                                WeftError *error) {
    Subject *subject = &self->subject;
    const char *own = weft_scene_material_name(scene, index), *slash = strrchr(path, '/');
    const char *file = slash ? slash + 1 : path;
    WeftResult result = weft_scene_material(scene, index, &subject->material, error);
    if (own && *own && (ends_in(path, ".gltf") || ends_in(path, ".glb")))
        snprintf(subject->name, sizeof subject->name, "%s", own);
    else
        snprintf(subject->name, sizeof subject->name, "%.*s", (int)strcspn(file, "."), file);
    bool textures = false;
    for (int k = 0; k < WEFT_INPUTS_MAX; k++) textures |= subject->material.inputs[k].texture != 0;
    if (textures && !self->quiet)
        report(0, "warning: %.200s: has textures, which stay with the engine: the text has their factors",
               path);
    self->desc.material = &subject->material;
    self->desc.name = subject->name;
    return result;
}

/* Material "NAME" or index of a scene, the first of all where it is NULL; -1: there is none. */
static int find_material(const WeftScene *scene, const char *name) {
    int count = weft_scene_info(scene).material_count;
    char *end;
    for (int k = 0; k < count && name; k++)
        if (strcmp(weft_scene_material_name(scene, k), name) == 0) return k;
    long index = name && *name ? strtol(name, &end, 10) : 0;
    if (name && (!*name || *end)) return -1;
    return index >= 0 && index < count ? (int)index : -1;
}

/* FILE.gltf or FILE.gltf:MATERIAL. */
static int read_asset(Export *self, const char *text, const WeftLog *log) {
    char path[1024];
    const char *suffix = strstr(text, ".gltf:"), *name = NULL;
    size_t size = strlen(text);
    if (!suffix) suffix = strstr(text, ".glb:");
    if (suffix) {
        const char *colon = strchr(suffix, ':');
        size = (size_t)(colon - text);
        name = colon + 1;
    }
    if (size >= sizeof path) return report(WEFT_USAGE, "%.80s...: is too long", text);
    snprintf(path, sizeof path, "%.*s", (int)size, text);
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load(path, &scene, log, &error) != WEFT_OK) return report_error(&error);
    int index = find_material(scene, name), result = 0;
    if (index < 0)
        result = report(WEFT_USAGE, "%.200s: %s: %.80s", path, weft_message_text(WEFT_MESSAGE_MATERIAL_NAME),
                        name ? name : "it has none");
    else if (take_material(self, scene, index, path, &error) != WEFT_OK)
        result = report_error(&error);
    weft_scene_free(scene);
    return result;
}

/* FILE.json, or "preset:NAME". */
static int read_material(Export *self, const char *path, const WeftLog *log) {
    WeftScene *scene;
    WeftError error;
    const char *preset = strncmp(path, "preset:", 7) == 0 ? path + 7 : path;
    WeftResult result = weft_scene_load("builtin:spheres", &scene, log, &error);
    if (result != WEFT_OK) return report_error(&error);
    result = weft_scene_dress(scene, "*", path, log, &error);
    if (result == WEFT_OK) result = take_material(self, scene, 0, preset, &error);
    weft_scene_free(scene);
    return result == WEFT_OK ? 0 : report_error(&error);
}

static bool is_preset(const char *name) {
    for (int k = 0; weft_preset_name(k); k++)
        if (strcmp(weft_preset_name(k), name) == 0) return true;
    return false;
}

static bool is_alias(const char *name) {
    for (int k = 0; weft_alias_name(k); k++)
        if (strcmp(weft_alias_name(k), name) == 0) return true;
    return false;
}

static int unknown(const char *text) {
    static const char *const kinds_of[] = {"lobe", "profile", "workflow"};
    char hint[96];
    Nearest nearest = {.typed = text};
    for (int k = 0; k < 3; k++)
        for (int n = 0; kind_of(kinds_of[k])->name(n); n++)
            nearest_offer(&nearest, kind_of(kinds_of[k])->name(n));
    for (int k = 0; weft_preset_name(k); k++) nearest_offer(&nearest, weft_preset_name(k));
    return report(
        WEFT_USAGE,
        "%.200s: is neither a lobe, a profile, a workflow, a preset nor a .json, .gltf or .glb file%s", text,
        nearest.name ? nearest_hint(&nearest, hint, sizeof hint) : "; see weft models");
}

static int read_subject(Export *self, const char *text, const WeftLog *log) {
    bool file = ends_in(text, ".json") || strncmp(text, "preset:", 7) == 0;
    bool asset =
        ends_in(text, ".gltf") || ends_in(text, ".glb") || strstr(text, ".gltf:") || strstr(text, ".glb:");
    bool lobe = weft_lobe_find(text) >= 0;
    if (!lobe && option_given(self->options, "-p"))
        return report(WEFT_USAGE, "-p: is for a lobe, and %.80s is none", text);
    if (asset) return read_asset(self, text, log);
    if (file) return read_material(self, text, log);
    if (lobe) {
        self->desc.lobe = &self->subject.lobe;
        return given_lobe(self->options, text, false, &self->subject.lobe);
    }
    if ((kind_find(kind_of("profile"), text) > 0 || kind_find(kind_of("workflow"), text) >= 0) &&
        !is_alias(text)) {
        self->desc.profile = text;
        return 0;
    }
    if (!is_preset(text)) return unknown(text);
    char preset[128];
    snprintf(preset, sizeof preset, "preset:%.100s", text);
    return read_material(self, preset, log);
}

/* The lobe of the right half. */
static int read_right(Export *self, const char *text) {
    WeftError error;
    if (self->desc.target != WEFT_EXPORT_SHADERTOY)
        return report(WEFT_USAGE, "%.200s: is one operand too many: two lobes are for --target shadertoy",
                      text);
    if (!self->desc.lobe)
        return report(WEFT_USAGE, "%.200s: two lobes stand side by side, and nothing else", text);
    if (kind_named(kind_of("lobe"), text) < 0) return WEFT_USAGE;
    if (weft_lobe_create(text, &self->subject.right, &error) != WEFT_OK) return report_error(&error);
    self->desc.right = &self->subject.right;
    return 0;
}

static int export_read(const Options *options, Export *self) {
    static const char *const pis[] = {"explicit", "folded", NULL};
    const char *targets[WEFT_EXPORT_TARGETS + 1] = {NULL}, *luts[WEFT_EXPORT_LUTS + 1] = {NULL};
    int target, lut = 0, pi;
    *self = (Export){.options = options, .quiet = option_given(options, "--quiet")};
    const WeftLog log = {say_warning, &self->quiet};
    for (int k = 0; k < WEFT_EXPORT_TARGETS; k++) targets[k] = weft_export_target(k);
    for (int k = 0; k < WEFT_EXPORT_LUTS; k++) luts[k] = weft_export_lut(k);
    if (!option_text(options, "--target"))
        return report(WEFT_USAGE, "export: needs --target glsl, essl, hlsl, c or shadertoy");
    if (!option_text(options, "-o")) return report(WEFT_USAGE, "export: needs -o FILE");
    if (!option_choice(options, "--target", targets, &target) ||
        !option_choice(options, "--lut", luts, &lut) || !option_choice(options, "--light-pi", pis, &pi))
        return WEFT_USAGE;
    self->desc.target = (WeftExportTarget)target;
    self->desc.lut = (WeftExportLut)lut;
    self->desc.albedo = option_given(options, "--albedo");
    self->desc.fold_pi = pi;
    self->desc.prefix = option_text(options, "--prefix");
    int result = read_subject(self, options->operands[0], &log);
    if (result == 0 && self->desc.albedo && !self->desc.lobe)
        result = report(WEFT_USAGE, "--albedo: is for a lobe; a material has the tables that it needs");
    if (result == 0 && options->operand_count > 1) result = read_right(self, options->operands[1]);
    return result;
}

/* "velvet.weft_texels_sheen.exr" beside "velvet.hlsl". */
static char *table_path(const Export *self, int k) {
    static const char *const suffixes[WEFT_EXPORT_LUTS] = {".h", ".png", ".exr", ".dds", ".npy"};
    const char *path = option_text(self->options, "-o"), *slash = strrchr(path, '/');
    const char *dot = strrchr(slash ? slash : path, '.');
    int stem = dot && dot > (slash ? slash + 1 : path) ? (int)(dot - path) : (int)strlen(path);
    size_t room = (size_t)stem + WEFT_EXPORT_NAME + 8;
    char *out = malloc(room);
    if (out)
        snprintf(out, room, "%.*s.%s%s", stem, path, self->made.tables[k].name, suffixes[self->desc.lut]);
    return out;
}

static int table_file_write(const Export *self, int k, const char *path) {
    const WeftExportTable *table = &self->made.tables[k];
    char *command = command_text(self->options), about[160];
    const float *texels = table->texels.pixels;
    float low = texels[0], high = texels[0];
    for (int n = 0; n < table->texels.width * table->texels.height; n++) {
        low = texels[n] < low ? texels[n] : low;
        high = texels[n] > high ? texels[n] : high;
    }
    snprintf(about, sizeof about, "%.95s%s", table->name,
             table->scale > 1.0f ? ", scaled as the text says" : "");
    const TableFile file = {.table = &table->texels,
                            .command = command,
                            .about = about,
                            .low = low,
                            .high = high,
                            .scale = self->desc.lut == WEFT_EXPORT_LUT_PNG16 ? 1.0 : 0.0};
    int result = command ? table_write(&file, path) : report(WEFT_RESOURCES, "out of memory");
    free(command);
    return result;
}

static int tables_write(const Export *self, Json *json) {
    int result = 0;
    for (int k = 0; k < self->made.table_count && result == 0; k++) {
        char *path = table_path(self, k);
        result = path ? table_file_write(self, k, path) : report(WEFT_RESOURCES, "out of memory");
        if (result == 0 && json) json_text(json, NULL, path);
        if (result == 0 && !json && !self->quiet)
            report(0, "%s: %d x %d texels", path, self->made.tables[k].texels.width,
                   self->made.tables[k].texels.height);
        free(path);
    }
    return result;
}

static int text_write(const Export *self) {
    Output output;
    int result = output_begin(&output, option_text(self->options, "-o"));
    if (result != 0) return result;
    fwrite(self->made.text, 1, self->made.size, output.stream);
    return output_end(&output);
}

static int files_write(const Export *self) {
    Json json = {.stream = stdout};
    bool wanted = option_given(self->options, "--json");
    int result;
    if (!wanted) {
        result = tables_write(self, NULL);
    } else {
        json_open(&json, NULL, '{');
        json_text(&json, "target", weft_export_target((int)self->desc.target));
        json_text(&json, "output", option_text(self->options, "-o"));
        json_whole(&json, "bytes", (long long)self->made.size);
        json_open(&json, "tables", '[');
        result = tables_write(self, &json);
        json_close(&json, ']');
        json_close(&json, '}');
    }
    return result == 0 ? text_write(self) : result;
}

static int export_run(const Options *options) {
    Export self;
    WeftError error;
    int result = export_read(options, &self);
    if (result == 0) result = output_probe(option_text(options, "-o"));
    if (result != 0) return result;
    if (weft_export(&self.desc, &self.made, &error) != WEFT_OK) return report_error(&error);
    result = files_write(&self);
    weft_export_free(&self.made);
    return result;
}

static void lists(void) {
    printf("\nTargets\n");
    for (int k = 0; weft_export_target(k); k++)
        layout_entry(stdout, 14, weft_export_target(k), weft_export_target_help(k));
}

static const Option export_options[] = {
    OPTION_HEADING("Output"),
    OPTION_TEXT("-o", "FILE", NULL,
                "write the text to FILE; tables go beside it, under their names in the text"),
    OPTION_TEXT("--target", "TARGET", NULL, "the language, below"),
    OPTION_TEXT("--lut", "KIND", "c",
                "tables as c arrays (inside the text where it can hold them), png16, exr, dds or npy"),
    OPTION_HEADING("Text"),
    OPTION_TEXT("--light-pi", "HOW", "explicit",
                "explicit: f has its 1/pi and lights are irradiances; folded: f times pi, for lights whose "
                "unit has the 1/pi inside"),
    OPTION_SWITCH("--albedo", "of a lobe its directional albedo E too, from a table"),
    OPTION_TEXT("--prefix", "NAME", "weft_", "what every name begins with; another one where two texts meet"),
    OPTION_PARAMS(", as its default"),
    OPTION_HEADING("Reports"),
    OPTION_SWITCH("--quiet", "no warnings and no summary"),
    OPTION_SWITCH("--json", "the files written as JSON on standard output"),
    OPTION_END,
};

const Verb verb_export = {
    .name = "export",
    .operands = "SUBJECT [LOBE] --target TARGET -o FILE [options]",
    .help = "writes a model as GLSL, HLSL, C or a Shadertoy",
    .operands_least = 1,
    .operands_most = 2,
    .options = export_options,
    .lists = lists,
    .notes = "SUBJECT is a lobe, an engine profile, a workflow, a preset (preset:NAME where a\n"
             "lobe has that name too), a material file .json, or FILE.gltf[:MATERIAL]. A\n"
             "second lobe stands on the right half of a Shadertoy. docs/export.md explains the\n"
             "functions, pi, and how engines take them.\n\n"
             "Examples\n"
             "  weft export charlie-neubelt --target hlsl -o charlie.ush\n"
             "  weft export ltc-fibre --target glsl --lut dds -o fuzz.glsl\n"
             "  weft export velvet --target c -o velvet.h\n"
             "  weft export chair.gltf:fabric --target essl --light-pi folded -o chair.glsl\n"
             "  weft export ashikhmin-neubelt charlie-neubelt --target shadertoy -o toy.glsl\n",
    .run = export_run,
};
