#include "scene/material/backs.h"

#include <string.h>

#include "base/fail.h"
#include "weave/weft_cloth.h"

WeftResult backs_make(WeftScene *scene, WeftError *error) {
    const size_t own = (size_t)scene_own_materials(scene), fronts = (size_t)scene->material_count,
                 room = (size_t)(scene->polygon_light_capacity - scene->polygon_light_count);
    if (own == 0 || scene->back_count) return WEFT_OK;
    Material *materials = arena_array(&scene->arena, fronts + own + room, sizeof *materials);
    scene->backs = arena_array(&scene->arena, own, sizeof *scene->backs);
    if (!materials || !scene->backs) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    memcpy(materials, scene->materials, fronts * sizeof *materials);
    for (size_t k = 0; k < own; k++) materials[fronts + k] = material_default();
    scene->materials = materials;
    scene->back_count = (int)own;
    return WEFT_OK;
}

/* Makes the other face of a cloth, once. Returns false if memory is short. */
static bool has_other(WeftCloth *cloth) {
    if (!cloth->other) cloth->other = cloth_other_face(cloth);
    return cloth->other != NULL;
}

/* Gives a back what it has in common with the front. */
static void share(const Material *front, Material *back) {
    static const InputId common[] = {INPUT_opacity, INPUT_emission, INPUT_emission_strength};
    for (size_t k = 0; k < sizeof common / sizeof *common; k++) back->inputs[common[k]] = front->inputs[common[k]];
    back->alpha_mode = front->alpha_mode;
    back->alpha_cutoff = front->alpha_cutoff;
    back->double_sided = true;
}

WeftResult backs_fit(WeftScene *scene, WeftError *error) {
    for (int k = 0; k < scene->back_count; k++) {
        const Material *front = &scene->materials[k];
        Material *back = &scene->materials[scene->material_count + k];
        const bool woven = front->cloth && front->double_sided;
        if (scene->backs[k] != BACK_GIVEN) {
            scene->backs[k] = woven ? BACK_WOVEN : BACK_SAME;
            if (!woven) continue;
            *back = *front;
            back->cloth = -front->cloth;
            if (!has_other(scene->cloths[front->cloth - 1])) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
        }
        share(front, back);
    }
    return WEFT_OK;
}

void back_give(WeftScene *scene, int material, const Material *back) {
    if (material >= scene->back_count) return;
    scene->backs[material] = back ? BACK_GIVEN : BACK_SAME;
    if (back) scene->materials[scene->material_count + material] = *back;
}
