#include "scene/record/material.h"

#include <math.h>
#include <string.h>

#include "base/equal.h"
#include "base/pi.h"
#include "scene/record/material_at.h"
#include "shading/dialect/texel.h"
#include "shading/material/choice.h"
#include "weave/cloth_base.h"

const WeftInputInfo input_infos[INPUT_COUNT] = {
#define INPUT_INFO(kind, name, label, initial, low, high, hard_low, hard_high, role, help)                             \
    {#name, help, WEFT_INPUT_##kind, initial, low, high, hard_low, hard_high},
    SURFACE_INPUTS(INPUT_INFO)
#undef INPUT_INFO
};

const InputRole input_roles[INPUT_COUNT] = {
#define INPUT_ROLE(kind, name, label, initial, low, high, hard_low, hard_high, role, help) ROLE_##role,
    SURFACE_INPUTS(INPUT_ROLE)
#undef INPUT_ROLE
};

const char *weft_material_input_label(int index) {
    static const char *const labels[INPUT_COUNT] = {
#define INPUT_LABEL(kind, name, label, initial, low, high, hard_low, hard_high, role, help) label,
        SURFACE_INPUTS(INPUT_LABEL)
#undef INPUT_LABEL
    };
    return index >= 0 && index < INPUT_COUNT ? labels[index] : NULL;
}

int weft_material_input_find(const char *name) {
    for (int k = 0; k < INPUT_COUNT; k++)
        if (strcmp(input_infos[k].name, name) == 0) return k;
    return -1;
}

int input_value_count(InputId input) { return input_infos[input].kind == WEFT_INPUT_COLOR ? 3 : 1; }

int weft_material_input_info(int index, WeftInputInfo *out) {
    *out = (WeftInputInfo){0};
    if (index < 0 || index >= INPUT_COUNT) return 0;
    *out = input_infos[index];
    return 1;
}

const WeftInputInfo hair_infos[WEFT_HAIR_NUMBERS] = {
    {"hair_length", "length of the longest loose fibres that stand off the cloth, m; 0: none", WEFT_INPUT_SCALAR, 0.0f,
     0.0f, 0.02f, 0.0f, 1.0f},
    {"hair_density", "loose fibres that stand on a square metre", WEFT_INPUT_SCALAR, 200000.0f, 0.0f, 2e6f, 0.0f,
     1e12f},
    {"hair_thickness", "width of a loose fibre, m: of wool about 3e-5, of a wisp 1e-4", WEFT_INPUT_SCALAR, 6e-5f, 0.0f,
     5e-4f, 0.0f, 0.01f},
};

int weft_material_hair_info(int index, WeftInputInfo *out) {
    *out = (WeftInputInfo){0};
    if (index < 0 || index >= WEFT_HAIR_NUMBERS) return 0;
    *out = hair_infos[index];
    return 1;
}

const char *weft_material_hair_name(int index) {
    return index >= 0 && index < WEFT_HAIR_NUMBERS ? hair_infos[index].name : NULL;
}

const char *weft_material_hair_help(int index) {
    return index >= 0 && index < WEFT_HAIR_NUMBERS ? hair_infos[index].help : NULL;
}

int hair_find(const char *name) {
    for (int k = 0; k < WEFT_HAIR_NUMBERS; k++)
        if (strcmp(hair_infos[k].name, name) == 0) return k;
    return -1;
}

Material material_default(void) {
    Material material = {.alpha_cutoff = 0.5f};
    for (int k = 0; k < WEFT_HAIR_NUMBERS; k++) material.hair[k] = hair_infos[k].initial;
    for (int k = 0; k < CHOICE_COUNT; k++) material.choices[k] = CHOICE_AUTO;
    for (int k = 0; k < INPUT_COUNT; k++) {
        Input *input = &material.inputs[k];
        for (int c = 0; c < input_value_count((InputId)k); c++) input->value[c] = input_infos[k].initial;
        input->transform[0] = input->transform[4] = 1.0f;
    }
    return material;
}

void material_set_color(Material *material, InputId input, float r, float g, float b) {
    float *value = material->inputs[input].value;
    value[0] = r, value[1] = g, value[2] = b;
}

void input_set_map_factor(Input *input, InputId id) {
    const WeftInputInfo *info = &input_infos[id];
    float factor = info->kind == WEFT_INPUT_DIRECTION ? 0.0f
                   : info->kind == WEFT_INPUT_ANGLE   ? info->high * (PI_FLOAT / 180.0f)
                                                      : 1.0f;
    for (int c = 0; c < input_value_count(id); c++) input->value[c] = factor;
}

/* Inputs whose default depends on workflow or profile: the principled BRDF has a fainter highlight and no sheen,
 * workflow specular the reflectance of a dielectric. */
static const InputId redefaulted[] = {INPUT_specular, INPUT_sheen, INPUT_specular_color};
enum { REDEFAULTED = sizeof redefaulted / sizeof redefaulted[0] };

static bool has_choice(const Material *material, ChoiceId choice, const char *id) {
    const char *value = choice_id(choice, material->choices[choice]);
    return value && strcmp(value, id) == 0;
}

static float input_default(const Material *material, InputId id) {
    bool engine = material->choices[CHOICE_profile] > 0;
    bool disney =
        engine ? has_choice(material, CHOICE_profile, "disney-2012") : has_choice(material, CHOICE_workflow, "disney");
    if (disney && id == INPUT_specular) return 0.5f;
    if (disney && id == INPUT_sheen) return 0.0f;
    bool bare = has_choice(material, CHOICE_workflow, "specular") || has_choice(material, CHOICE_workflow, "free");
    if (!engine && bare && id == INPUT_specular_color) return 0.03f;
    return input_infos[id].initial;
}

static bool is_default(const Material *material, InputId id) {
    const Input *input = &material->inputs[id];
    float def = input_default(material, id);
    bool same = !input->texture && !input->given;
    for (int c = 0; c < input_value_count(id); c++) same &= is_equal(input->value[c], def);
    return same;
}

void material_choose(Material *material, ChoiceId choice, int value) {
    bool moves[REDEFAULTED];
    for (int k = 0; k < REDEFAULTED; k++) moves[k] = is_default(material, redefaulted[k]);
    material->choices[choice] = value;
    for (int k = 0; k < REDEFAULTED; k++)
        for (int c = 0; moves[k] && c < input_value_count(redefaulted[k]); c++)
            material->inputs[redefaulted[k]].value[c] = input_default(material, redefaulted[k]);
}

Choices material_choices(const Material *material) {
#define CHOICE_OF(name, help) .name = material->choices[CHOICE_##name],
    Choices choices = {SURFACE_CHOICES(CHOICE_OF)};
    if (choices.rim == CHOICE_AUTO && material->inputs[INPUT_fuzz].value[0] > 0.0f) choices.rim = RIM_FUZZ;
    return choices;
}

/* One point of a material: inputs that share a texture and its placement share the fetch. */
typedef struct Lookup {
    const WeftScene *scene;
    float (*uv)[2];
    const Input *last;
    const SrgbTable *last_srgb;
    Texel texel;
} Lookup;

bool input_same_texels(const Input *a, const Input *b) {
    bool same = a->texture == b->texture && a->texcoord == b->texcoord;
    for (int k = 0; same && k < 6; k++) same = a->transform[k] == b->transform[k];
    return same;
}

static const Texel *fetch(Lookup *lookup, const Input *input, const SrgbTable *srgb) {
    const Input *last = lookup->last;
    if (last && lookup->last_srgb == srgb && input_same_texels(last, input)) return &lookup->texel;
    const float *uv = lookup->uv[input->texcoord], *m = input->transform;
    float u = m[0] * uv[0] + m[1] * uv[1] + m[2], v = m[3] * uv[0] + m[4] * uv[1] + m[5];
    lookup->last = input;
    lookup->last_srgb = srgb;
    lookup->texel = texture_fetch(&lookup->scene->textures[input->texture - 1], lookup->scene->images, srgb, u, v);
    return &lookup->texel;
}

static float plain_SCALAR(const Input *input) { return input->value[0]; }
static float plain_ANGLE(const Input *input) { return input->value[0]; }
static Rgb plain_COLOR(const Input *input) { return (Rgb){input->value[0], input->value[1], input->value[2]}; }
static Dir plain_NORMAL(const Input *input) { return dir(0.0f, 0.0f, 1.0f); }
static Dir plain_DIRECTION(const Input *input) { return dir(cos(input->value[0]), sin(input->value[0]), 0.0f); }

static float read_SCALAR(Lookup *lookup, const Input *input) {
    /* opacity is the alpha of a colour texture: the same texel, and alpha is never decoded */
    const SrgbTable *srgb = input->channel == 3 ? lookup->last_srgb : NULL;
    return input->value[0] * fetch(lookup, input, srgb)->c[input->channel];
}

static float read_ANGLE(Lookup *lookup, const Input *input) { return read_SCALAR(lookup, input); }

static Rgb read_COLOR(Lookup *lookup, const Input *input) {
    const float *c = fetch(lookup, input, &lookup->scene->srgb)->c;
    return (Rgb){input->value[0] * c[0], input->value[1] * c[1], input->value[2] * c[2]};
}

static Dir read_NORMAL(Lookup *lookup, const Input *input) {
    const float *c = fetch(lookup, input, NULL)->c;
    return texel_normal(c[0], c[1], c[2], input->value[0]);
}

static Dir read_DIRECTION(Lookup *lookup, const Input *input) {
    const float *c = fetch(lookup, input, NULL)->c;
    return texel_direction(c[0], c[1], cos(input->value[0]), sin(input->value[0]));
}

Surface material_plain(const Material *material) {
    Surface s;
#define PLAIN_INPUT(kind, name, label, initial, low, high, hard_low, hard_high, role, help)                            \
    s.name = plain_##kind(&material->inputs[INPUT_##name]);
    SURFACE_INPUTS(PLAIN_INPUT)
    if (material->cloth) s.transmission = 0.0f; /* threads are no glass */
    return s;
}

Surface surface_default(void) {
    const Material material = material_default();
    return material_plain(&material);
}

bool material_has_glass(const Material *material) {
    Surface s = material_plain(material);
    const Choices choices = material_choices(material);
    Stack stack;
    if (!(s.transmission > 0.0f)) return false;
    if (material->inputs[INPUT_metallic].texture) s.metallic = 0.0f;
    stack_make(&stack, &s, &choices, (TableRef){.kind = TABLE_NONE});
    return stack.glass > 0.0f;
}

bool material_is_solid(const Material *material) {
    return material->inputs[INPUT_thickness].value[0] > 0.0f && !material->cloth && !material->measured &&
           material_has_glass(material);
}

void material_textures(const WeftScene *scene, const Material *material, float uv[2][2], const float color[4],
                       Surface *s) {
    Lookup lookup = {.scene = scene, .uv = uv};
#define READ_INPUT(kind, name, label, initial, low, high, hard_low, hard_high, role, help)                             \
    if (material->inputs[INPUT_##name].texture) s->name = read_##kind(&lookup, &material->inputs[INPUT_##name]);
    SURFACE_INPUTS(READ_INPUT)
    s->base_color = (Rgb){s->base_color.r * color[0], s->base_color.g * color[1], s->base_color.b * color[2]};
    s->opacity *= color[3];
}

float material_opacity(const WeftScene *scene, const Material *material, float uv[2][2], float vertex_alpha) {
    if (material->alpha_mode == WEFT_ALPHA_OPAQUE) return 1.0f;
    Lookup lookup = {.scene = scene, .uv = uv};
    const Input *input = &material->inputs[INPUT_opacity];
    float opacity = (input->texture ? read_SCALAR(&lookup, input) : plain_SCALAR(input)) * vertex_alpha;
    if (material->cloth && cloth_is_gap(scene->cloths[material->cloth - 1], uv[0])) return 0.0f;
    if (material->alpha_mode == WEFT_ALPHA_MASK) return opacity >= material->alpha_cutoff ? 1.0f : 0.0f;
    return clamp(opacity, 0.0f, 1.0f);
}
