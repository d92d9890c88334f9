#include "cli/files/save.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/path.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "weft/material.h"
#include "weft/save.h"

/* Returns the node of MaterialX that --mtlx names, or -1 after one line. */
static int mtlx_node(const Options *options) {
    const char *names[WEFT_MTLX_NODES + 1] = {NULL};
    int node = WEFT_MTLX_OPEN_PBR;
    for (int k = 0; k < WEFT_MTLX_NODES; k++) names[k] = weft_mtlx_node_name(k);
    return option_given(options, "--mtlx") && !option_choice(options, "--mtlx", names, &node) ? -1 : node;
}

int save_check(const Options *options) {
    int cursor = 0, result = mtlx_node(options) < 0 ? WEFT_USAGE : 0;
    for (const char *path; !result && (path = option_next(options, "--save", &cursor));) {
        if (!path_ends(path, ".glb") && !path_ends(path, ".gltf") && !path_ends(path, ".json") &&
            !path_ends(path, ".mtlx"))
            return report(WEFT_USAGE, "--save: \"%.200s\" is not a .glb, .gltf, .json or .mtlx file", path);
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
        if (path_ends(path, ".json")) {
            result = weft_scene_save_material(scene, save_cloth_of(scene), path, error);
        } else if (path_ends(path, ".mtlx")) {
            const WeftLog log = {.fn = option_given(options, "--quiet") ? NULL : report_warning};
            result =
                weft_scene_save_mtlx(scene, save_cloth_of(scene), path, (WeftMtlxNode)mtlx_node(options), &log, error);
        } else {
            result = weft_scene_save(scene, path, error);
            if (result == WEFT_OK) warn_of_measured(options, scene, path);
        }
    }
    return result;
}
