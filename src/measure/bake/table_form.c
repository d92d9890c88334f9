/* table_form.c - the meaning of a table's axes: forms that engines use, their text, and the places of texels */
#include <stdio.h>

#include "base/fail.h"
#include "measure/bake/bake_texels.h"

/* The engines and their forms. For a table over cos_o and roughness alone, Unreal, the glTF viewer and HDRP's
 * cloth agree. Sources: glTF-Sample-Renderer, source/Renderer/shaders/ibl.glsl; Filament,
 * libs/ibl/src/CubemapIBL.cpp, DFG; three.js, lights_physical_pars_fragment.glsl.js; MaterialX,
 * mx_microfacet_specular.glsl; HDRP, PreIntegratedFGD.hlsl; Cycles, bsdf_microfacet.h and bsdf_sheen.h. */
static const struct {
    const char *name, *help;
    WeftTableForm form;
} forms[] = {
    {"gltf", "the glTF sample viewer, Unreal, HDRP's cloth", {0}},
    {"filament", "Filament's cmgen --ibl-dfg", {.flip_y = 1, .total = 1}},
    {"three", "three.js", {.transposed = 1}},
    {"materialx", "MaterialX", {.alpha = 1}},
    {"hdrp", "Unity HDRP, ggx", {.root = 1, .edges = 1, .total = 1}},
    {"cycles", "Blender Cycles, E of ggx", {.transposed = 1, .edges = 1, .total = 1}},
    {"zeltner", "Zeltner's sheen, in Cycles and OpenPBR too", {.alpha = 1, .edges = 1}},
};
enum { FORMS = sizeof forms / sizeof forms[0] };

const char *weft_table_form_name(int index) { return index >= 0 && index < FORMS ? forms[index].name : NULL; }
const char *weft_table_form_help(int index) { return index >= 0 && index < FORMS ? forms[index].help : NULL; }
WeftTableForm weft_table_form_at(int index) {
    return index >= 0 && index < FORMS ? forms[index].form : (WeftTableForm){0};
}

bool form_same(const WeftTableForm *a, const WeftTableForm *b) {
    return !a->transposed == !b->transposed && !a->root == !b->root && !a->alpha == !b->alpha &&
           !a->edges == !b->edges && !a->flip_x == !b->flip_x && !a->flip_y == !b->flip_y;
}

int weft_table_form_find(const WeftTableForm *form) {
    int k = 0;
    while (k < FORMS && !form_same(form, &forms[k].form)) k++;
    return k < FORMS ? k : -1;
}

char *weft_table_form_text(const WeftTableForm *form, char text[WEFT_TABLE_FORM_TEXT]) {
    const char *cosine = form->root ? "sqrt-cos" : "cos", *parameter = form->alpha ? "alpha" : "roughness";
    snprintf(text, WEFT_TABLE_FORM_TEXT, "%s,%s,%s%s%s%s", form->transposed ? parameter : cosine,
             form->transposed ? cosine : parameter, form->edges ? "edges" : "centres", form->flip_x ? ",flip-x" : "",
             form->flip_y ? ",flip-y" : "", form->total ? ",total" : "");
    return text;
}

/* The quantity along an axis. */
enum { AXIS_NONE, AXIS_COS, AXIS_ROOT, AXIS_ROUGHNESS, AXIS_ALPHA };

static int axis_of(const char *word) {
    static const char *const words[] = {"", "cos", "sqrt-cos", "roughness", "alpha"};
    for (int k = AXIS_COS; k <= AXIS_ALPHA; k++)
        if (strcmp(word, words[k]) == 0) return k;
    return AXIS_NONE;
}

/* Sets what a word after the axes means. Returns false if it has no meaning. */
static bool element(WeftTableForm *form, const char *word) {
    const struct {
        const char *word;
        int *flag;
    } flags[] = {
        {"edges", &form->edges}, {"flip-x", &form->flip_x}, {"flip-y", &form->flip_y}, {"total", &form->total}};
    if (strcmp(word, "centres") == 0) return !form->edges;
    for (size_t k = 0; k < sizeof flags / sizeof flags[0]; k++) {
        if (strcmp(word, flags[k].word) != 0) continue;
        *flags[k].flag = 1;
        return true;
    }
    return false;
}

WeftResult weft_table_form_parse(const char *text, WeftTableForm *out, WeftError *error) {
    enum { WORD = 16 };
    int axes[2] = {0};
    WeftTableForm form = {0};
    bool good = true;
    *out = form;
    for (int k = 0; k < FORMS; k++)
        if (strcmp(text, forms[k].name) == 0) {
            *out = forms[k].form;
            return WEFT_OK;
        }
    const char *at = text;
    for (int n = 0; good; n++) {
        size_t length = strcspn(at, ",");
        char word[WORD];
        snprintf(word, sizeof word, "%.*s", (int)(length < WORD ? length : WORD - 1), at);
        if (n < 2)
            good = (axes[n] = axis_of(word)) != AXIS_NONE && length < WORD;
        else
            good = length < WORD && element(&form, word);
        if (!at[length]) break;
        at += length + 1;
    }
    form.transposed = axes[0] == AXIS_ROUGHNESS || axes[0] == AXIS_ALPHA;
    const int cosine = axes[form.transposed], parameter = axes[!form.transposed];
    if (!good || (cosine != AXIS_COS && cosine != AXIS_ROOT) ||
        (parameter != AXIS_ROUGHNESS && parameter != AXIS_ALPHA))
        return fail(error, WEFT_MESSAGE_TABLE_FORM, text, NULL);
    form.root = cosine == AXIS_ROOT;
    form.alpha = parameter == AXIS_ALPHA;
    *out = form;
    return WEFT_OK;
}

/* Returns the coordinate of texel k of count, in [0, 1]. */
static double place(int k, int count, bool edges, bool flip) {
    if (flip) k = count - 1 - k;
    const double at = !edges ? (k + 0.5) / count : count > 1 ? (double)k / (count - 1) : 0.0;
    return fmin(fmax(at, 0.0), 1.0);
}

float form_parameter(const WeftTableForm *form, int lobe, double t) {
    const WeftLobeInfo *info = weft_lobe_info(lobe);
    if (info->param_count == 0) return 0.0f;
    const WeftParamInfo *p = &info->params[0];
    if (form->alpha || strcmp(p->name, "roughness") == 0) return (float)t;
    if (strcmp(p->name, "alpha") == 0) return (float)(t * t);
    return p->low + (p->high - p->low) * (float)t;
}

void weft_table_form_texel(const WeftTableForm *form, int lobe, int width, int height, int x, int y, float *cos_o,
                           float *value) {
    const double s = place(x, width, form->edges, form->flip_x), t = place(y, height, form->edges, form->flip_y);
    const double c = form->transposed ? t : s;
    *cos_o = (float)(form->root ? c * c : c);
    *value = form_parameter(form, lobe, form->transposed ? s : t);
}
