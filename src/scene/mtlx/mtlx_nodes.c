#include "scene/mtlx/mtlx_nodes.h"

#include <math.h>
#include <string.h>

#include "scene/record/fuzz_sheen.h"
#include "scene/record/material_at.h"
#include "shading/material/choice.h"

#define SAME(name, type, input, initial)                                                                               \
    { name, MTLX_##type, MTLX_SAME, INPUT_##input, initial }
#define END                                                                                                            \
    { NULL, MTLX_FLOAT, MTLX_SAME, -1, 0.0f }

static const MtlxRow open_pbr[] = {
    SAME("base_color", COLOR, base_color, 0.8f),
    {"base_weight", MTLX_FLOAT, MTLX_WEIGHT, INPUT_base_color, 1.0f},
    SAME("base_diffuse_roughness", FLOAT, diffuse_roughness, 0.0f),
    SAME("base_metalness", FLOAT, metallic, 0.0f),
    SAME("specular_weight", FLOAT, specular, 1.0f),
    SAME("specular_color", COLOR, specular_color, 1.0f),
    SAME("specular_roughness", FLOAT, roughness, 0.3f),
    SAME("specular_ior", FLOAT, ior, 1.5f),
    SAME("specular_roughness_anisotropy", FLOAT, anisotropy, 0.0f),
    SAME("transmission_weight", FLOAT, transmission, 0.0f),
    SAME("transmission_color", COLOR, attenuation_color, 1.0f),
    SAME("transmission_depth", FLOAT, attenuation_distance, 0.0f),
    SAME("fuzz_weight", FLOAT, fuzz, 0.0f),
    SAME("fuzz_color", COLOR, fuzz_color, 1.0f),
    SAME("fuzz_roughness", FLOAT, fuzz_roughness, 0.5f),
    SAME("coat_weight", FLOAT, clearcoat, 0.0f),
    SAME("coat_color", COLOR, coat_color, 1.0f),
    SAME("coat_roughness", FLOAT, clearcoat_roughness, 0.0f),
    SAME("coat_roughness_anisotropy", FLOAT, coat_anisotropy, 0.0f),
    SAME("coat_ior", FLOAT, coat_ior, 1.6f),
    SAME("coat_darkening", FLOAT, coat_darkening, 1.0f),
    SAME("emission_luminance", FLOAT, emission_strength, 0.0f),
    SAME("emission_color", COLOR, emission, 1.0f),
    SAME("geometry_opacity", FLOAT, opacity, 1.0f),
    {"geometry_thin_walled", MTLX_BOOLEAN, MTLX_TWO_SIDED, -1, 0.0f},
    SAME("geometry_normal", NORMAL, normal, 1.0f),
    SAME("geometry_coat_normal", NORMAL, clearcoat_normal, 1.0f),
    SAME("geometry_tangent", TANGENT, anisotropy_direction, 0.0f),
    SAME("geometry_coat_tangent", TANGENT, coat_anisotropy_direction, 0.0f),
    END,
};

static const MtlxRow gltf_pbr[] = {
    SAME("base_color", COLOR, base_color, 1.0f),
    SAME("metallic", FLOAT, metallic, 1.0f),
    SAME("roughness", FLOAT, roughness, 1.0f),
    SAME("normal", NORMAL, normal, 1.0f),
    {"occlusion", MTLX_FLOAT, MTLX_MAP, INPUT_occlusion, 1.0f},
    SAME("specular", FLOAT, specular, 1.0f),
    SAME("specular_color", COLOR, specular_color, 1.0f),
    SAME("ior", FLOAT, ior, 1.5f),
    SAME("alpha", FLOAT, opacity, 1.0f),
    {"alpha_mode", MTLX_INTEGER, MTLX_ALPHA_MODE, -1, 0.0f},
    {"alpha_cutoff", MTLX_FLOAT, MTLX_ALPHA_CUTOFF, -1, 0.5f},
    SAME("sheen_color", COLOR, sheen_color, 0.0f),
    SAME("sheen_roughness", FLOAT, sheen_roughness, 0.0f),
    SAME("clearcoat", FLOAT, clearcoat, 0.0f),
    SAME("clearcoat_roughness", FLOAT, clearcoat_roughness, 0.0f),
    SAME("clearcoat_normal", NORMAL, clearcoat_normal, 1.0f),
    SAME("emissive", COLOR, emission, 0.0f),
    SAME("emissive_strength", FLOAT, emission_strength, 1.0f),
    SAME("transmission", FLOAT, transmission, 0.0f),
    SAME("thickness", FLOAT, thickness, 0.0f),
    {"attenuation_distance", MTLX_FLOAT, MTLX_FINITE, INPUT_attenuation_distance, 0.0f},
    SAME("attenuation_color", COLOR, attenuation_color, 1.0f),
    END,
};

static const MtlxRow standard_surface[] = {
    SAME("base_color", COLOR, base_color, 0.8f),
    {"base", MTLX_FLOAT, MTLX_WEIGHT, INPUT_base_color, 1.0f},
    SAME("diffuse_roughness", FLOAT, diffuse_roughness, 0.0f),
    SAME("metalness", FLOAT, metallic, 0.0f),
    SAME("specular", FLOAT, specular, 1.0f),
    SAME("specular_color", COLOR, specular_color, 1.0f),
    SAME("specular_roughness", FLOAT, roughness, 0.2f),
    SAME("specular_IOR", FLOAT, ior, 1.5f),
    SAME("specular_anisotropy", FLOAT, anisotropy, 0.0f),
    SAME("transmission", FLOAT, transmission, 0.0f),
    SAME("transmission_color", COLOR, attenuation_color, 1.0f),
    SAME("transmission_depth", FLOAT, attenuation_distance, 0.0f),
    SAME("sheen", FLOAT, sheen, 0.0f),
    SAME("sheen_color", COLOR, sheen_color, 1.0f),
    {"sheen_roughness", MTLX_FLOAT, MTLX_SQUARE, INPUT_sheen_roughness, 0.3f},
    SAME("coat", FLOAT, clearcoat, 0.0f),
    SAME("coat_color", COLOR, coat_color, 1.0f),
    SAME("coat_roughness", FLOAT, clearcoat_roughness, 0.1f),
    SAME("coat_anisotropy", FLOAT, coat_anisotropy, 0.0f),
    SAME("coat_IOR", FLOAT, coat_ior, 1.5f),
    SAME("coat_normal", NORMAL, clearcoat_normal, 1.0f),
    SAME("emission", FLOAT, emission_strength, 0.0f),
    SAME("emission_color", COLOR, emission, 1.0f),
    SAME("opacity", GREY, opacity, 1.0f),
    {"thin_walled", MTLX_BOOLEAN, MTLX_TWO_SIDED, -1, 0.0f},
    SAME("normal", NORMAL, normal, 1.0f),
    SAME("tangent", TANGENT, anisotropy_direction, 0.0f),
    END,
};

static const char *const open_pbr_unshown[] = {"transmission_scatter", "transmission_dispersion_scale",
                                               "subsurface_weight", "thin_film_weight", NULL};
static const char *const gltf_unshown[] = {"iridescence", "dispersion", NULL};
static const char *const standard_unshown[] = {"transmission_scatter",    "transmission_extra_roughness",
                                               "transmission_dispersion", "subsurface",
                                               "thin_film_thickness",     "coat_affect_color",
                                               "coat_rotation",           "coat_affect_roughness",
                                               "specular_rotation",       NULL};

#define BASE_CHOICES                                                                                                   \
    "workflow=metallic workflow=none diffuse=lambert d=ggx v=smith-ggx f=schlick rim=sheen rim=fuzz layer_by=max "     \
    "layer=albedo-view "
#define CHARLIE_CHOICES "sheen_lobe=charlie-neubelt sheen_lobe=charlie-conty-kulla sheen_d=charlie "

const MtlxNodeInfo mtlx_nodes[WEFT_MTLX_NODES] = {
    [WEFT_MTLX_OPEN_PBR] = {"open_pbr_surface", open_pbr, open_pbr_unshown,
                            BASE_CHOICES "diffuse=eon profile=openpbr sheen_lobe=ltc-fibre ", "profile", "openpbr",
                            MTLX_STRETCH_OPENPBR},
    [WEFT_MTLX_GLTF] = {"gltf_pbr", gltf_pbr, gltf_unshown, BASE_CHOICES CHARLIE_CHOICES "profile=materialx ",
                        "workflow", "metallic", MTLX_STRETCH_NONE},
    [WEFT_MTLX_STANDARD] = {"standard_surface", standard_surface, standard_unshown, BASE_CHOICES CHARLIE_CHOICES,
                            "workflow", "metallic", MTLX_STRETCH_ASPECT},
};

const char *weft_mtlx_node_name(int node) { return node >= 0 && node < WEFT_MTLX_NODES ? mtlx_nodes[node].id : NULL; }

const char *mtlx_type_name(MtlxType type) {
    static const char *const names[] = {"float", "color3", "color3", "vector3", "vector3", "integer", "boolean"};
    return names[type];
}

const MtlxRow *mtlx_row(const MtlxNodeInfo *node, const char *name) {
    const MtlxRow *row = node->rows;
    while (row->name && strcmp(row->name, name) != 0) row++;
    return row->name ? row : NULL;
}

const MtlxRow *mtlx_row_of(const MtlxNodeInfo *node, int input) {
    const MtlxRow *row = node->rows;
    while (row->name && (row->input != input || row->rule == MTLX_WEIGHT)) row++;
    return row->name ? row : NULL;
}

void mtlx_flip(const float from[6], float to[6]) {
    const float m[6] = {from[0], 0.0f - from[1], from[1] + from[2], 0.0f - from[3], from[4], 1.0f - from[4] - from[5]};
    memcpy(to, m, sizeof m);
}

static float greatest(const float v[3]) { return fmaxf(fmaxf(v[0], v[1]), v[2]); }

static void scale(Input *input, float by) {
    for (int c = 0; c < 3; c++) input->value[c] *= by;
}

static float ior_of(float f0) {
    const float root = sqrtf(fminf(fmaxf(f0, 0.0f), 0.999f));
    return (1.0f + root) / (1.0f - root);
}

/* Writes the tint of a colour of workflow disney, as mix(1, colour / luminance, amount). */
static void tint(const float color[3], float amount, float out[3]) {
    const float y = 0.2126f * color[0] + 0.7152f * color[1] + 0.0722f * color[2];
    for (int c = 0; c < 3; c++) out[c] = 1.0f - amount + amount * (y > 0.0f ? color[c] / y : 1.0f);
}

/* Turns the ten parameters of workflow disney into reflection, sheen and coat of a metallic material: F0 = .08 specular, a
 * sheen in the tint of the base, a quarter of the coat with alpha from its gloss. */
static void from_disney(Input *inputs) {
    const float *base = inputs[INPUT_base_color].value;
    inputs[INPUT_ior].value[0] = ior_of(0.08f * inputs[INPUT_specular].value[0]);
    inputs[INPUT_specular].value[0] = 1.0f;
    tint(base, inputs[INPUT_specular_tint].value[0], inputs[INPUT_specular_color].value);
    tint(base, inputs[INPUT_sheen_tint].value[0], inputs[INPUT_sheen_color].value);
    inputs[INPUT_sheen_roughness].value[0] = sqrtf(0.3f); /* MaterialX's default: that of disney has no roughness */
    inputs[INPUT_clearcoat].value[0] *= 0.25f;
    inputs[INPUT_clearcoat_roughness].value[0] = sqrtf(0.1f + (0.001f - 0.1f) * inputs[INPUT_clearcoat_gloss].value[0]);
}

static void from_specular(Input *inputs) {
    const float f0 = fminf(greatest(inputs[INPUT_specular_color].value), 0.999f);
    inputs[INPUT_metallic].value[0] = 0.0f;
    inputs[INPUT_metallic].texture = 0;
    inputs[INPUT_ior].value[0] = ior_of(f0);
    if (f0 > 0.0f) scale(&inputs[INPUT_specular_color], 1.0f / f0);
}

/* Turns workflow cloth, which has no highlight, into a base without a reflection. */
static void from_cloth(Input *inputs) {
    static const InputId black[] = {INPUT_specular, INPUT_metallic};
    for (size_t k = 0; k < sizeof black / sizeof *black; k++) {
        inputs[black[k]].value[0] = 0.0f;
        inputs[black[k]].texture = 0;
    }
    inputs[INPUT_ior].value[0] = 1.5f;
}

static bool is_id(ChoiceId choice, int value, const char *id) {
    const char *is = choice_id(choice, value);
    return is && strcmp(is, id) == 0;
}

/* Turns the base of any workflow into that of a metallic one, with an index of refraction. */
static bool to_metallic(Material *material, const Choices *choices) {
    Input *inputs = material->inputs;
    const bool profile = choices->profile > 0;
    if (profile ? is_id(CHOICE_profile, choices->profile, "disney-2012")
                : is_id(CHOICE_workflow, choices->workflow, "disney")) {
        from_disney(inputs);
        return true;
    }
    if (!profile && is_id(CHOICE_workflow, choices->workflow, "cloth")) {
        from_cloth(inputs);
    } else if (!profile && choices->workflow > WORKFLOW_METALLIC) {
        from_specular(inputs);
    } else if (inputs[INPUT_ior].value[0] < 1.0f) {
        const Surface plain = {.ior = inputs[INPUT_ior].value[0], .reflectance = inputs[INPUT_reflectance].value[0]};
        inputs[INPUT_ior].value[0] = ior_of(dielectric_f0(&plain));
    }
    return false;
}

/* Makes weight times colour of them, where the strongest channel of the colour is 1. */
static void part_weight(Input *weight, Input *color) {
    const float most = greatest(color->value);
    weight->value[0] = fminf(weight->value[0] * most, 1.0f);
    if (most > 0.0f) scale(color, 1.0f / most);
}

/* The widths of a highlight along the tangent and across it. */
typedef struct Widths {
    float x, y;
} Widths;

static void widths_to_node(MtlxStretch stretch, Widths alpha, Input *roughness, Input *anisotropy) {
    const float was = roughness->value[0], q = alpha.x > 0.0f ? alpha.y / alpha.x : 1.0f;
    const float square =
        stretch == MTLX_STRETCH_OPENPBR ? alpha.x * sqrtf(0.5f * (1.0f + q * q)) : sqrtf(alpha.x * alpha.y);
    anisotropy->texture = 0;
    anisotropy->value[0] = 1.0f - q;
    roughness->value[0] = sqrtf(square);
    if (roughness->texture && was > 0.0f) roughness->value[0] = fminf(roughness->value[0], 1.0f);
}

/* Turns roughness and anisotropy of KHR_materials_anisotropy, or of workflow disney, into those of the node. */
static void stretch_to_node(MtlxStretch stretch, bool disney, Input *roughness, Input *anisotropy) {
    const float a = anisotropy->value[0], alpha = roughness->value[0] * roughness->value[0];
    if (stretch == MTLX_STRETCH_NONE || !(a > 0.0f)) return;
    const float aspect = sqrtf(1.0f - 0.9f * a);
    const Widths widths =
        disney ? (Widths){alpha / aspect, alpha * aspect} : (Widths){alpha + (1.0f - alpha) * a * a, alpha};
    widths_to_node(stretch, widths, roughness, anisotropy);
}

/* Turns them back: alpha of weft is that across, and the one along is mix(alpha, 1, anisotropy^2). */
static void stretch_from_node(MtlxStretch stretch, Input *roughness, Input *anisotropy) {
    const float a = fminf(anisotropy->value[0], stretch == MTLX_STRETCH_ASPECT ? 0.98f : 1.0f), q = 1.0f - a;
    const float square = roughness->value[0] * roughness->value[0];
    if (stretch == MTLX_STRETCH_NONE || !(a > 0.0f)) return;
    Widths alpha = {square / sqrtf(fmaxf(q, 1e-6f)), square * sqrtf(q)};
    if (stretch == MTLX_STRETCH_OPENPBR) {
        alpha.x = square * sqrtf(2.0f / (1.0f + q * q));
        alpha.y = q * alpha.x;
    }
    alpha.x = fminf(alpha.x, 1.0f);
    roughness->value[0] = sqrtf(alpha.y);
    anisotropy->value[0] = alpha.y < 1.0f ? sqrtf(fmaxf((alpha.x - alpha.y) / (1.0f - alpha.y), 0.0f)) : 0.0f;
}

bool mtlx_is_glass(const Material *material) {
    return !material->cloth && !material->measured && material_has_glass(material);
}

bool mtlx_absorbs(const Material *material) {
    const Input *color = &material->inputs[INPUT_attenuation_color];
    const bool clear = !color->texture && fminf(fminf(color->value[0], color->value[1]), color->value[2]) >= 1.0f;
    return !clear && material_is_solid(material) && material->inputs[INPUT_attenuation_distance].value[0] > 0.0f;
}

/* Takes out glass that is not drawn, and turns the colours of other glass into the one of a node without a thickness. */
static void glass_to_node(const MtlxNodeInfo *node, Material *material) {
    const Material plain = material_default();
    const bool glass = mtlx_is_glass(material), solid = material_is_solid(material), absorbs = mtlx_absorbs(material);
    Input *inputs = material->inputs;
    if (!glass) inputs[INPUT_transmission] = plain.inputs[INPUT_transmission];
    if (mtlx_row_of(node, INPUT_thickness)) return;
    if (glass) material->double_sided = !solid;
    if (absorbs) return;
    inputs[INPUT_attenuation_color] = glass ? inputs[INPUT_base_color] : plain.inputs[INPUT_attenuation_color];
    inputs[INPUT_attenuation_distance] = plain.inputs[INPUT_attenuation_distance];
}

void mtlx_to_node(WeftMtlxNode node, Material *material) {
    const Choices choices = material_choices(material);
    const MtlxStretch stretch = mtlx_nodes[node].stretch;
    Input *inputs = material->inputs;
    glass_to_node(&mtlx_nodes[node], material);
    const bool disney = to_metallic(material, &choices);
    if (node == WEFT_MTLX_OPEN_PBR)
        sheen_fuzz_put(material);
    else
        fuzz_sheen_put(material);
    if (node == WEFT_MTLX_GLTF) {
        scale(&inputs[INPUT_sheen_color], inputs[INPUT_sheen].value[0]);
        inputs[INPUT_sheen].value[0] = 1.0f;
    }
    if (node == WEFT_MTLX_STANDARD) part_weight(&inputs[INPUT_sheen], &inputs[INPUT_sheen_color]);
    stretch_to_node(stretch, disney, &inputs[INPUT_roughness], &inputs[INPUT_anisotropy]);
    stretch_to_node(stretch, false, &inputs[INPUT_clearcoat_roughness], &inputs[INPUT_coat_anisotropy]);
    if (material->alpha_mode == WEFT_ALPHA_OPAQUE) {
        inputs[INPUT_opacity].value[0] = 1.0f;
        inputs[INPUT_opacity].texture = 0;
    }
}

void mtlx_from_node(WeftMtlxNode node, Material *material) {
    const MtlxStretch stretch = mtlx_nodes[node].stretch;
    Input *inputs = material->inputs;
    stretch_from_node(stretch, &inputs[INPUT_roughness], &inputs[INPUT_anisotropy]);
    stretch_from_node(stretch, &inputs[INPUT_clearcoat_roughness], &inputs[INPUT_coat_anisotropy]);
}
