/* convert.c - converting a scene's materials from workflow metallic to specular and back */
#include <string.h>

#include "base/fail.h"
#include "scene/material/hair.h"
#include "scene/material/set.h"
#include "scene/record/material_at.h"
#include "shading/material/choice.h"
#include "shading/material/compose.h"

static bool textured(const Material *material) {
    bool any = false;
    for (int k = 0; k < INPUT_COUNT; k++) any |= material->inputs[k].texture != 0;
    return any;
}

static float greatest_loss(const WeftScene *scene, const Material *material) {
    enum { GRID = 256 };
    static const float white[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    Choices choices = material_choices(material);
    Surface untextured = material_plain(material);
    if (!textured(material)) return convert_loss(untextured, choices);
    float loss = 0.0f;
    for (int k = 0; k < GRID * GRID; k++) {
        int row = k / GRID, column = k % GRID;
        float u = (to_float(column) + 0.5f) / GRID, v = (to_float(row) + 0.5f) / GRID;
        float uv[2][2] = {{u, v}, {u, v}};
        Surface surface = untextured;
        material_textures(scene, material, uv, white, &surface);
        loss = max(loss, convert_loss(surface, choices));
    }
    return loss;
}

WeftResult weft_scene_convert(WeftScene *scene, const char *workflow, float *losses, WeftError *error) {
    int target = choice_find(CHOICE_convert, workflow);
    if (target < 0) return fail(error, WEFT_MESSAGE_PARAM_VALUE, workflow, "convert to metallic or to specular");
    for (int k = 0; k < scene_own_materials(scene); k++) {
        Material *material = &scene->materials[k];
        Choices choices = material_choices(material);
        material->choices[CHOICE_convert] = choices.convert = target;
        bool already = choices.profile <= 0 && ((target == CONVERT_METALLIC && choices.workflow <= WORKFLOW_METALLIC) ||
                                                (target == CONVERT_SPECULAR && choices.workflow == WORKFLOW_SPECULAR));
        if (losses) losses[k] = already ? -2.0f : convert_wanted(choices) ? greatest_loss(scene, material) : -1.0f;
    }
    return hairs_fit(scene, error);
}
