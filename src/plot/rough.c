/* rough.c - a model at another roughness */
#include "plot/making.h"
#include "shading/catalogue/registry.h"

static bool rough_material(const WeftMaterial *given, float roughness, WeftReflection **out) {
    WeftMaterial material = *given;
    int sheen = weft_material_input_find("sheen_roughness");
    int input = weft_material_reads(&material, sheen) ? sheen : weft_material_input_find("roughness");
    return weft_material_set_number(&material, input, &roughness, NULL) == WEFT_OK &&
           weft_reflection_create(&material, out, NULL) == WEFT_OK;
}

bool rough_make(const WeftPlotModel *model, float roughness, Rough *out) {
    *out = (Rough){.reflection = NULL};
    if (model->lobe) {
        const WeftLobeInfo *info = weft_lobe_info(model->lobe->lobe);
        if (info->param_count < 1 || info->params[0].choices) return false;
        out->lobe = *model->lobe;
        out->lobe.params[0] = lobe_rough(model->lobe->lobe, roughness).params[0];
        if (weft_reflection_of_lobe(&out->lobe, &out->reflection, NULL) != WEFT_OK) return false;
    } else if (!model->material || !rough_material(model->material, roughness, &out->reflection)) {
        return false;
    }
    out->model =
        (WeftPlotModel){.reflection = out->reflection, .lobe = model->lobe ? &out->lobe : NULL, .label = model->label};
    return true;
}

void rough_free(Rough *rough) {
    weft_reflection_free(rough->reflection);
    rough->reflection = NULL;
}

bool rough_is_there(const WeftPlotModel *model) {
    Rough rough;
    const bool there = rough_make(model, 0.5f, &rough);
    rough_free(&rough);
    return there;
}
