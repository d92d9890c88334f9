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

static bool is_material(const char *path) { return path_ends(path, ".json") || path_is_cloth(path); }

int save_check(const Options *options) {
    int cursor = 0, result = mtlx_node(options) < 0 ? WEFT_USAGE : 0;
    for (const char *path; !result && (path = option_next(options, "--save", &cursor));) {
        if (!path_ends(path, ".glb") && !path_ends(path, ".gltf") && !is_material(path))
            return report(WEFT_USAGE, "--save: \"%.200s\" is not a .glb, .gltf, .json, .mtlx, .u3m or .u3ma file",
                          path);
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

/* Writes the cloth as a material file or, by the suffix, as U3M or MaterialX. */
static WeftResult material_save(const Options *options, const WeftScene *scene, const char *path, WeftError *error) {
    const WeftLog log = {.fn = option_given(options, "--quiet") ? NULL : report_warning};
    const int cloth = save_cloth_of(scene);
    if (path_is_u3m(path)) return weft_scene_save_u3m(scene, cloth, path, NULL, &log, error);
    if (path_ends(path, ".mtlx"))
        return weft_scene_save_mtlx(scene, cloth, path, (WeftMtlxNode)mtlx_node(options), &log, error);
    return weft_scene_save_material(scene, cloth, path, error);
}

WeftResult save_all(const Options *options, const WeftScene *scene, WeftError *error) {
    WeftResult result = WEFT_OK;
    int cursor = 0;
    for (const char *path; result == WEFT_OK && (path = option_next(options, "--save", &cursor));) {
        const bool material = is_material(path);
        result = material ? material_save(options, scene, path, error) : weft_scene_save(scene, path, error);
        if (result == WEFT_OK && !material) warn_of_measured(options, scene, path);
    }
    return result;
}
