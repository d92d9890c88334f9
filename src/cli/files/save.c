#include "cli/files/save.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/path.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "weft/material.h"
#include "weft/save.h"

int save_check(const Options *options) {
    int cursor = 0, result = 0;
    for (const char *path; !result && (path = option_next(options, "--save", &cursor));) {
        if (!path_ends(path, ".glb") && !path_ends(path, ".gltf") && !path_ends(path, ".json"))
            return report(WEFT_USAGE, "--save: \"%.200s\" is not a .glb, .gltf or .json file", path);
        result = output_probe(path);
    }
    return result;
}

static bool shows(const WeftMaterial *material, const char *name) {
    const float *v = material->inputs[weft_material_input_find(name)].value;
    return v[0] > 0.0f || v[1] > 0.0f || v[2] > 0.0f;
}

int save_cloth_of(const WeftScene *scene) {
    int count = weft_scene_info(scene).material_count;
    for (int wanted = 0; wanted < 2; wanted++)
        for (int k = 0; k < count; k++) {
            WeftMaterial material;
            if (weft_scene_material(scene, k, &material, NULL) != WEFT_OK) continue;
            if (wanted ? !shows(&material, "emission") : shows(&material, "sheen_color")) return k;
        }
    return 0;
}

/* Warns that the saved glTF contains the numbers fitted to a measurement and not the measurement. */
static void warn_of_measured(const Options *options, const WeftScene *scene, const char *path) {
    char text[1024];
    int count = option_given(options, "--quiet") ? 0 : weft_scene_info(scene).material_count;
    for (int k = 0; k < count; k++) {
        WeftMaterial material;
        if (weft_scene_material(scene, k, &material, NULL) != WEFT_OK || !material.measured) continue;
        snprintf(text, sizeof text, "%.200s: material %d is saved as the numbers fitted to its measurement", path, k);
        report_warning(NULL, WEFT_MESSAGE_GLTF_WARN_IGNORED, text);
    }
}

WeftResult save_all(const Options *options, const WeftScene *scene, WeftError *error) {
    WeftResult result = WEFT_OK;
    int cursor = 0;
    for (const char *path; result == WEFT_OK && (path = option_next(options, "--save", &cursor));) {
        bool material = path_ends(path, ".json");
        result = material ? weft_scene_save_material(scene, save_cloth_of(scene), path, error)
                          : weft_scene_save(scene, path, error);
        if (result == WEFT_OK && !material) warn_of_measured(options, scene, path);
    }
    return result;
}
