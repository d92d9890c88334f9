#include "cli/fit/fit_files.h"

#include <stdlib.h>

#include "base/path.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/files/export_files.h"
#include "cli/files/save.h"
#include "cli/operands/command.h"

/* The suffixes of engine text. */
static const struct {
    const char *suffix;
    WeftExportTarget target;
} texts[] = {
    {".glsl", WEFT_EXPORT_GLSL}, {".hlsl", WEFT_EXPORT_HLSL}, {".wgsl", WEFT_EXPORT_WGSL}, {".h", WEFT_EXPORT_C}};
enum { TEXTS = sizeof texts / sizeof *texts };

/* Returns the export target of a path, or -1. */
static int target_of(const char *path) {
    for (int k = 0; k < TEXTS; k++)
        if (path_ends(path, texts[k].suffix)) return (int)texts[k].target;
    return -1;
}

static bool is_asset(const char *path) { return path_ends(path, ".glb") || path_ends(path, ".gltf"); }

/* Checks that with --measured the data is a measurement and one of the files can name it. Returns 0 or an exit code. */
static int measured_check(const Options *options) {
    bool json = false;
    int cursor = 0;
    if (!option_given(options, "--measured")) return 0;
    if (!weft_reflection_readable(options->operands[0]))
        return report(WEFT_USAGE, "--measured: %.200s is no .binary, .bsdf or .bin", options->operands[0]);
    for (const char *path; (path = option_next(options, "-o", &cursor));) json |= path_ends(path, ".json");
    return json ? 0 : report(WEFT_USAGE, "--measured: only a material file names a measurement: -o NAME.json");
}

int fit_files_check(const Options *options) {
    int cursor = 0, result = measured_check(options);
    for (const char *path; result == 0 && (path = option_next(options, "-o", &cursor));)
        result =
            path_ends(path, ".json") || is_asset(path) || target_of(path) >= 0
                ? output_probe_other(options, path)
                : report(WEFT_USAGE, "%.200s: a fit is written as .json, .glb, .gltf, .glsl, .hlsl, .wgsl or .h", path);
    return result;
}

/* Writes a cloth of that material, as an asset or as the material alone; a material file may name a measurement. */
static int scene_write(const WeftMaterial *material, const char *path, const char *measured) {
    WeftError error;
    WeftScene *scene = NULL;
    WeftResult result = weft_scene_load("builtin:cloth", &scene, NULL, &error);
    int index = result == WEFT_OK ? save_cloth_of(scene) : 0;
    if (result == WEFT_OK) result = weft_scene_put_material(scene, index, material, &error);
    if (result == WEFT_OK && measured && !is_asset(path))
        result = weft_scene_put_measured(scene, index, measured, &error);
    if (result == WEFT_OK)
        result = is_asset(path) ? weft_scene_save(scene, path, &error)
                                : weft_scene_save_material(scene, index, path, &error);
    weft_scene_free(scene);
    return result == WEFT_OK ? 0 : report_error(&error);
}

static int text_write(const WeftMaterial *material, const char *path, const char *command) {
    WeftError error;
    WeftExport made = {0};
    const WeftExportDesc desc = {
        .material = material, .name = "fit", .target = (WeftExportTarget)target_of(path), .call = command};
    if (weft_export(&desc, &made, &error) != WEFT_OK) return report_error(&error);
    const ExportFiles files = {.made = &made, .path = path, .command = command, .quiet = true};
    int result = export_tables_write(&files, NULL);
    if (result == 0) result = export_text_write(&files);
    weft_export_free(&made);
    return result;
}

int fit_files_write(const Options *options, const WeftMaterial *material) {
    const char *measured = option_given(options, "--measured") ? options->operands[0] : NULL;
    char *command = command_text(options);
    int cursor = 0, result = command ? 0 : report(WEFT_RESOURCES, "out of memory");
    for (const char *path; result == 0 && (path = option_next(options, "-o", &cursor));)
        result = target_of(path) >= 0 ? text_write(material, path, command) : scene_write(material, path, measured);
    free(command);
    return result;
}
