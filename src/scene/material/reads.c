/* reads.c - finds the inputs that have an influence on a material
 *
 * Workflows, profiles and choices are code, not lists of the inputs that they read. So an input is changed and the
 * reflected light is compared, at points with dust from any side, in directions of a narrow highlight and of a rim. */
#include <math.h>

#include "scene/material/material_numbers.h"
#include "scene/record/material_at.h"
#include "shading/material/dust.h"
#include "shading/stack/frame.h"

/* A point of the world with the direction to the eye. */
typedef struct ReadProbe {
    Dir normal, tangent, point, eye;
} ReadProbe;

static const ReadProbe probes[] = {
    {{0.36f, 0.80f, 0.48f}, {1.0f, 0.0f, 0.0f}, {0.031f, 0.212f, 0.117f}, {0.10f, 0.55f, 0.83f}},
    {{-0.48f, -0.36f, 0.80f}, {0.6f, 0.0f, 0.8f}, {1.373f, -0.418f, 0.702f}, {-0.78f, -0.10f, 0.62f}},
    {{0.48f, 0.60f, -0.64f}, {0.0f, 1.0f, 0.0f}, {-0.561f, 0.933f, 2.207f}, {0.88f, 0.12f, 0.46f}},
};
enum { PROBES = sizeof probes / sizeof *probes, INCOMING = 5, ANSWERS = PROBES * INCOMING };

typedef struct MaterialAnswer {
    Rgb f_cos[ANSWERS];
} MaterialAnswer;

/* Returns a number in place of E, which takes long, that depends on the same parameters: the sheen's lobe for one pair
 * of directions. */
static float stand_in(const Stack *m) {
    const Dir o = dir(0.48f, 0.36f, 0.8f), i = dir(-0.36f, 0.64f, 0.678823f);
    float f = lobe_eval(&m->sheen.lobe, angles_between(o, i));
    return f > 0.0f ? f / (1.0f + f) : 0.0f;
}

/* Returns direction k of light: the mirror direction, one just beside, two far off, and the last from behind. */
static Dir incoming(Dir o, int k) {
    const float aside[INCOMING][2] = {{0.0f, 0.0f}, {0.021f, 0.013f}, {0.43f, -0.29f}, {-0.51f, 0.37f}, {0.2f, 0.3f}};
    float x = aside[k][0] - o.x, y = aside[k][1] - o.y, most = 0.97f; /* above the horizon */
    float shrink = min(1.0f, sqrt(most / max(x * x + y * y, most)));
    x *= shrink, y *= shrink;
    return dir(x, y, (k == INCOMING - 1 ? -1.0f : 1.0f) * sqrt(1.0f - x * x - y * y));
}

/* Replaces diffuse and specular as the threads of a cloth do, which wear makes paler. */
static void put_threads(SeenStack *seen, float wear, Dir o) {
    const Lobe yarn = lobe_default(LOBE_YARN);
    const Rgb color = rgb_grey(0.5f + 0.5f * wear);
    stack_put_base(&seen->stack, &yarn, color, color);
    seen_prepare(seen, o);
}

static void answer_at(const ReadProbe *probe, Surface s, const Choices *choices, bool woven, Rgb f_cos[INCOMING]) {
    enum { COLUMNS = 4 };
    const Facing at = {probe->normal, probe->normal, probe->tangent, 1.0f};
    const TableRef none = {.kind = TABLE_NONE};
    float e[COLUMNS + 1];
    SeenStack seen;
    Frame frame = frame_of(at, s, probe->eye), fixed = frame_about(frame.z, probe->tangent, 1.0f);
    Dir o = frame_to(frame, probe->eye);
    s = dust_accumulate(frame_surface(s), frame.z, probe->point);
    stack_make(&seen.stack, &s, choices, none);
    float same = stand_in(&seen.stack);
    for (int k = 0; k <= COLUMNS; k++) e[k] = same;
    seen_make(&seen, &s, choices, (TableRef){.texels = e, .kind = TABLE_ROOTS, .rows = 1, .columns = COLUMNS}, o);
    if (woven) put_threads(&seen, s.wear, o);
    for (int k = 0; k < INCOMING; k++) { /* the same directions in the world for any rotation of the frame */
        Dir i = frame_from(fixed, incoming(frame_to(fixed, probe->eye), k));
        f_cos[k] = seen_eval(&seen, frame_to(frame, i), 1).f_cos;
    }
}

static MaterialAnswer answer_of(const Surface *surface, const Choices *choices, bool woven) {
    MaterialAnswer answer;
    for (int k = 0; k < PROBES; k++) answer_at(&probes[k], *surface, choices, woven, answer.f_cos + k * INCOMING);
    return answer;
}

/* Returns true if two numbers differ by more than rounding. */
static bool is_other(float a, float b) { return fabsf(a - b) > 1e-7f + 1e-5f * max(fabsf(a), fabsf(b)); }

static bool differ(const MaterialAnswer *a, const MaterialAnswer *b) {
    bool other = false;
    for (int k = 0; k < ANSWERS; k++)
        other |= is_other(a->f_cos[k].r, b->f_cos[k].r) || is_other(a->f_cos[k].g, b->f_cos[k].g) ||
                 is_other(a->f_cos[k].b, b->f_cos[k].b);
    return other;
}

/* Sets an input to a place t in its plausible range; channels of a colour get different values. */
static void move(Material *material, int input, float t) {
    const WeftInputInfo *info = &input_infos[input];
    bool angle = info->kind == WEFT_INPUT_DIRECTION || info->kind == WEFT_INPUT_ANGLE;
    float unit = angle ? PI / 180.0f : 1.0f;
    for (int c = 0; c < 3; c++) {
        float share = info->kind == WEFT_INPUT_COLOR ? t * (1.0f - 0.3f * (float)c) : t;
        material->inputs[input].value[c] = unit * mix(info->low, info->high, share);
    }
}

/* Returns the surface with textures at their middle value and narrow lobes widened to the spacing of the
 * directions, so that neither hides an influence. */
static Surface middle_of(const Material *material) {
    static const InputId widths[] = {INPUT_roughness, INPUT_clearcoat_roughness, INPUT_sheen_roughness,
                                     INPUT_fuzz_roughness, INPUT_dust_roughness};
    Material middle = *material;
    for (size_t k = 0; k < sizeof widths / sizeof *widths; k++)
        middle.inputs[widths[k]].value[0] = max(middle.inputs[widths[k]].value[0], 0.5f);
    for (int k = 0; k < INPUT_COUNT; k++)
        for (int c = 0; c < 3 && input_infos[k].kind != WEFT_INPUT_DIRECTION; c++)
            if (middle.inputs[k].texture) middle.inputs[k].value[c] *= 0.5f;
    return material_plain(&middle);
}

static bool moves_the_light(const Material *material, int input) {
    const float places[] = {0.0f, 1.0f, 0.37f};
    const Choices choices = material_choices(material);
    const Surface surface = middle_of(material);
    const bool woven = material->cloth > 0;
    const MaterialAnswer before = answer_of(&surface, &choices, woven);
    bool reads = false;
    for (size_t k = 0; k < sizeof places / sizeof *places && !reads; k++) {
        Material moved = *material;
        move(&moved, input, places[k]);
        Surface other = middle_of(&moved);
        if (input == INPUT_clearcoat_normal) other.clearcoat_normal = dir(0.36f, 0.48f, 0.8f);
        const Choices then = material_choices(&moved); /* an amount above 0 may choose a model */
        MaterialAnswer after = answer_of(&other, &then, woven);
        reads = differ(&before, &after);
    }
    return reads;
}

/* Returns true if light goes through the material as through glass: of the thickness and what is absorbed inside, the
 * stack shows one where the other is there, and the path tracer each. */
static bool is_glass(const Material *material) {
    return material->inputs[INPUT_transmission].value[0] > 0.0f && moves_the_light(material, INPUT_transmission);
}

static bool is_black(const Input *input) {
    return !(input->value[0] > 0.0f || input->value[1] > 0.0f || input->value[2] > 0.0f);
}

int weft_material_reads(const WeftMaterial *numbers, int input) {
    if (input < 0 || input >= INPUT_COUNT) return 0;
    const Material material = material_sound(numbers);
    if (input == INPUT_opacity) return material.alpha_mode != WEFT_ALPHA_OPAQUE;
    if (material.unlit) return input == INPUT_base_color;
    switch ((InputId)input) {
    case INPUT_normal:
    case INPUT_occlusion: return 1;
    case INPUT_emission: return material.inputs[INPUT_emission_strength].value[0] > 0.0f;
    case INPUT_thickness: return is_glass(&material);
    case INPUT_attenuation_distance: return material_is_solid(&material) && is_glass(&material);
    case INPUT_emission_strength: return !is_black(&material.inputs[INPUT_emission]);
    default: return moves_the_light(&material, input);
    }
}
