/* judge_causes.c - the causes of differences: each changes the materials, the lights or the values of the picture */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/pi.h"
#include "image/srgb.h"
#include "measure/judge/judge.h"
#include "shading/dialect/tone.h"
#include "weft/lobe.h"
#include "weft/material.h"

enum { SETS = 3, SET_SIZE = 64 };

/* Values of a picture that differ by a curve or a factor. */
typedef enum ValueChange { VALUES_KEPT = 0, VALUES_SCALED, VALUES_ENCODED, VALUES_DECODED } ValueChange;

/* A cause. Of what changes the scene, only one member is used. */
typedef struct CauseRow {
    const char *name, *help;
    WeftCauseKind kind;
    InputId reads;          /* a material is changed only if this input has an influence on it */
    const char *sets[SETS]; /* "input=value" or "choice=id" of the material */
    void (*material)(Material *material);
    bool (*scene)(WeftScene *scene, WeftRenderDesc *desc); /* false: it changes nothing */
    float factor;                                          /* of the reference's light; 0: it is rendered anew */
    ValueChange values;
} CauseRow;

static void sheen_roughness_linear(Material *m) {
    if (m->inputs[INPUT_sheen_roughness].texture) return;
    m->inputs[INPUT_sheen_roughness].value[0] = sqrtf(m->inputs[INPUT_sheen_roughness].value[0]);
}

static void sheen_roughness_squared(Material *m) {
    if (m->inputs[INPUT_sheen_roughness].texture) return;
    m->inputs[INPUT_sheen_roughness].value[0] *= m->inputs[INPUT_sheen_roughness].value[0];
}

static void sheen_roughness_of_base(Material *m) { m->inputs[INPUT_sheen_roughness] = m->inputs[INPUT_roughness]; }

/* Gives a chosen lobe, whose alpha is roughness^2, the root of the roughness. */
static void fuzz_alpha_rooted(Material *m) {
    if (m->inputs[INPUT_fuzz_roughness].texture) return;
    m->inputs[INPUT_fuzz_roughness].value[0] = sqrtf(sqrtf(m->inputs[INPUT_fuzz_roughness].value[0]));
}

static void roughness_linear(Material *m) {
    if (m->inputs[INPUT_roughness].texture) return;
    m->inputs[INPUT_roughness].value[0] = sqrtf(m->inputs[INPUT_roughness].value[0]);
}

static void anisotropy_across(Material *m) { m->inputs[INPUT_anisotropy_direction].value[0] += 0.5f * PI_FLOAT; }

static void color_decoded(Input *input) {
    for (int c = 0; c < 3; c++) input->value[c] = srgb_decode(fminf(input->value[c], 1.0f));
}

static void base_color_decoded(Material *m) { color_decoded(&m->inputs[INPUT_base_color]); }
static void sheen_color_decoded(Material *m) { color_decoded(&m->inputs[INPUT_sheen_color]); }

static void base_texture_left_out(Material *m) { m->inputs[INPUT_base_color].texture = 0; }
static void sheen_texture_left_out(Material *m) { m->inputs[INPUT_sheen_color].texture = 0; }
static void sheen_roughness_texture_left_out(Material *m) { m->inputs[INPUT_sheen_roughness].texture = 0; }

/* Takes the bytes of colour textures as linear light. */
static bool textures_undecoded(WeftScene *scene, WeftRenderDesc *desc) {
    (void)desc;
    for (int k = 0; k < 256; k++) scene->srgb.linear[k] = (float)k / 255.0f;
    return scene->texture_count > 0;
}

static bool shadows_changed(WeftScene *scene, WeftRenderDesc *desc) {
    (void)scene;
    desc->no_shadows = !desc->no_shadows;
    return true;
}

static bool bounces_changed(WeftScene *scene, WeftRenderDesc *desc) {
    enum { BOUNCES = 9 };
    (void)scene;
    desc->max_depth = desc->max_depth > 1 ? 1 : BOUNCES;
    return true;
}

static bool has_environment(const WeftScene *scene) {
    const Environment *e = &scene->environment;
    const bool black = e->kind == ENVIRONMENT_CONSTANT && !(fmaxf(e->color[0], fmaxf(e->color[1], e->color[2])) > 0.0f);
    return e->strength > 0.0f && !black;
}

/* Returns true if a punctual light is not the only light. */
static bool has_light_beside(const WeftScene *scene) {
    return scene->light_count > 0 && (has_environment(scene) || scene->polygon_light_count > 0);
}

static bool environment_left_out(WeftScene *scene, WeftRenderDesc *desc) {
    (void)desc;
    const bool any = has_environment(scene) && scene->light_count + scene->polygon_light_count > 0;
    scene->environment.strength = 0.0f;
    return any;
}

static bool lights_left_out(WeftScene *scene, WeftRenderDesc *desc) {
    (void)desc;
    const bool any = has_light_beside(scene);
    scene->light_count = 0;
    return any;
}

static bool lights_scaled(WeftScene *scene, float factor) {
    for (int k = 0; k < scene->light_count; k++) scene->lights[k].intensity *= factor;
    return has_light_beside(scene);
}

static bool lights_times_pi(WeftScene *scene, WeftRenderDesc *desc) {
    (void)desc;
    return lights_scaled(scene, PI_FLOAT);
}

static bool lights_over_pi(WeftScene *scene, WeftRenderDesc *desc) {
    (void)desc;
    return lights_scaled(scene, 1.0f / PI_FLOAT);
}

static bool environment_rotated(WeftScene *scene, float quarters) {
    scene->environment.rotation += quarters * 0.5f * PI_FLOAT;
    return has_environment(scene) && scene->environment.kind != ENVIRONMENT_CONSTANT;
}

static bool environment_at_90(WeftScene *scene, WeftRenderDesc *desc) {
    (void)desc;
    return environment_rotated(scene, 1.0f);
}

static bool environment_at_180(WeftScene *scene, WeftRenderDesc *desc) {
    (void)desc;
    return environment_rotated(scene, 2.0f);
}

static bool environment_at_270(WeftScene *scene, WeftRenderDesc *desc) {
    (void)desc;
    return environment_rotated(scene, 3.0f);
}

#define ANY INPUT_COUNT

/* TERM: settings of a material; CHANGE: a function of it (a row may have both); LIGHT: one of the scene; SCALE, VALUES: of a picture. */
#define TERM(name_, reads_, help_, ...)                                                                                \
    {                                                                                                                  \
        .name = (name_), .help = (help_), .kind = WEFT_CAUSE_TERM, .reads = (reads_), .sets = { __VA_ARGS__ }          \
    }
#define CHANGE(name_, reads_, help_, call)                                                                             \
    { .name = (name_), .help = (help_), .kind = WEFT_CAUSE_TERM, .reads = (reads_), .material = (call) }
#define LIGHT(name_, kind_, help_, call)                                                                               \
    { .name = (name_), .help = (help_), .kind = (kind_), .reads = ANY, .scene = (call) }
#define SCALE(name_, help_, factor_)                                                                                   \
    { .name = (name_), .help = (help_), .kind = WEFT_CAUSE_LIGHT, .reads = ANY, .factor = (factor_) }
#define VALUES(name_, help_, values_)                                                                                  \
    { .name = (name_), .help = (help_), .kind = WEFT_CAUSE_PICTURE, .reads = ANY, .values = (values_) }

static const CauseRow rows[] = {
    TERM("sheen-left-out", INPUT_sheen_roughness, "the sheen is not drawn", "sheen=0"),
    TERM("fuzz-left-out", ANY, "the fuzz is not drawn, or the sheen in its place", "fuzz=0"),
    TERM("base-not-dimmed", INPUT_sheen_roughness, "the base under the sheen keeps all of its light: no albedo scaling",
         "layer=additive"),
    TERM("base-dimmed-by-view", INPUT_sheen_roughness, "the base is dimmed by the sheen's E of the view alone",
         "layer=albedo-view"),
    TERM("base-dimmed-by-larger", INPUT_sheen_roughness, "the base is dimmed by the larger E of view and light",
         "layer=albedo-max"),
    TERM("sheen-v-neubelt", INPUT_sheen_roughness, "the sheen has D charlie and V of Neubelt and Pettineo",
         "sheen_lobe=charlie-neubelt"),
    TERM("sheen-v-conty-kulla", INPUT_sheen_roughness, "the sheen has D charlie and V of Conty and Kulla",
         "sheen_lobe=charlie-conty-kulla"),
    TERM("sheen-v-clamped", INPUT_sheen_roughness, "the sheen has D charlie and V of Conty and Kulla, at most 1",
         "sheen_lobe=charlie-khronos"),
    TERM("sheen-d-ashikhmin", INPUT_sheen_roughness, "the sheen has D of Ashikhmin in place of charlie",
         "sheen_lobe=ashikhmin-neubelt"),
    TERM("sheen-ltc-fibre", INPUT_sheen_roughness, "the sheen is of microfibres, with multiple scattering",
         "sheen_lobe=ltc-fibre"),
    {.name = "fuzz-at-half",
     .help = "the table of the fuzz is read at n . h and at the root of the roughness, and its light has no norm",
     .kind = WEFT_CAUSE_TERM,
     .reads = INPUT_fuzz_roughness,
     .sets = {"sheen_lobe=ltc-fibre-half", "layer=albedo-half"},
     .material = fuzz_alpha_rooted},
    CHANGE("sheen-roughness-not-squared", INPUT_sheen_roughness, "the roughness of the sheen is its alpha, not squared",
           sheen_roughness_linear),
    CHANGE("sheen-roughness-squared-twice", INPUT_sheen_roughness,
           "the roughness of the sheen is squared once too often", sheen_roughness_squared),
    CHANGE("sheen-roughness-of-base", INPUT_sheen_roughness, "the sheen has the roughness of the base",
           sheen_roughness_of_base),
    CHANGE("sheen-roughness-texture-left-out", INPUT_sheen_roughness,
           "the texture of the sheen's roughness is not read", sheen_roughness_texture_left_out),
    CHANGE("sheen-color-texture-left-out", INPUT_sheen_roughness, "the texture of the sheen's colour is not read",
           sheen_texture_left_out),
    CHANGE("sheen-color-decoded", INPUT_sheen_roughness,
           "the factor of the sheen's colour, linear, is decoded from sRGB", sheen_color_decoded),
    CHANGE("base-color-decoded", INPUT_base_color, "the factor of the base colour, linear, is decoded from sRGB",
           base_color_decoded),
    CHANGE("base-color-texture-left-out", INPUT_base_color, "the texture of the base colour is not read",
           base_texture_left_out),
    LIGHT("textures-not-decoded", WEFT_CAUSE_TERM, "textures of colour are not decoded from sRGB", textures_undecoded),
    CHANGE("roughness-not-squared", INPUT_roughness, "the roughness of the base is its alpha, not squared",
           roughness_linear),
    TERM("specular-left-out", ANY, "KHR_materials_specular is not read", "specular=1", "specular_color=1,1,1"),
    TERM("ior-left-out", ANY, "KHR_materials_ior is not read: the index of refraction is 1.5", "ior=1.5"),
    TERM("anisotropy-left-out", ANY, "the highlight is not stretched", "anisotropy=0"),
    CHANGE("anisotropy-across", INPUT_anisotropy_direction,
           "the highlight is stretched at right angles to its direction", anisotropy_across),
    TERM("clearcoat-left-out", ANY, "the clear coat is not drawn", "clearcoat=0"),
    TERM("coat-color-left-out", INPUT_coat_color, "the coat is drawn without its colour", "coat_color=1,1,1"),
    TERM("coat-darkening-left-out", INPUT_coat_darkening, "the coat does not darken the base", "coat_darkening=0"),
    TERM("diffuse-roughness-left-out", ANY, "the diffuse lobe has no roughness", "diffuse_roughness=0"),
    TERM("diffuse-transmission-left-out", ANY, "no light passes through the cloth", "diffuse_transmission=0"),
    TERM("retroreflection-left-out", ANY, "no light returns towards the lamp", "retroreflection=0"),
    TERM("normal-map-left-out", ANY, "normal maps are not read", "normal=0"),
    TERM("emission-left-out", ANY, "nothing glows", "emission=0"),
    SCALE("light-times-pi", "the light is pi times as bright, as where f lacks 1/pi", PI_FLOAT),
    SCALE("light-over-pi", "the light is pi times as dark, as where 1/pi is there twice", 1.0f / PI_FLOAT),
    LIGHT("lights-times-pi", WEFT_CAUSE_LIGHT, "punctual lights are pi times as bright beside the environment",
          lights_times_pi),
    LIGHT("lights-over-pi", WEFT_CAUSE_LIGHT, "punctual lights are pi times as dark beside the environment",
          lights_over_pi),
    LIGHT("environment-left-out", WEFT_CAUSE_LIGHT, "the environment sends no light", environment_left_out),
    LIGHT("lights-left-out", WEFT_CAUSE_LIGHT, "punctual lights send no light", lights_left_out),
    LIGHT("environment-at-90", WEFT_CAUSE_LIGHT, "the environment is rotated by 90 degrees", environment_at_90),
    LIGHT("environment-at-180", WEFT_CAUSE_LIGHT, "the environment is rotated by 180 degrees", environment_at_180),
    LIGHT("environment-at-270", WEFT_CAUSE_LIGHT, "the environment is rotated by 270 degrees", environment_at_270),
    LIGHT("shadows", WEFT_CAUSE_LIGHT, "shadows are left out, or are there where --no-shadows says otherwise",
          shadows_changed),
    LIGHT("bounces", WEFT_CAUSE_LIGHT,
          "light bounces between surfaces, or does not where --max-depth says that it does", bounces_changed),
    VALUES("exposure", "all values have one factor", VALUES_SCALED),
    VALUES("encoded-as-srgb", "values are encoded as sRGB where they should not be", VALUES_ENCODED),
    VALUES("decoded-from-srgb", "values are decoded from sRGB where they should not be", VALUES_DECODED),
};
enum { ROWS = sizeof rows / sizeof *rows };

static int profile_count(void) {
    int count = 0;
    while (weft_profile_name(count)) count++;
    return count;
}

int judge_cause_count(void) { return ROWS + profile_count(); }

WeftCause weft_judge_cause(int index) {
    if (index < 0 || index >= judge_cause_count()) return (WeftCause){0};
    if (index < ROWS) return (WeftCause){rows[index].name, rows[index].help, rows[index].kind};
    return (WeftCause){weft_profile_name(index - ROWS), weft_profile_help(index - ROWS), WEFT_CAUSE_ENGINE};
}

const char *weft_cause_kind_name(int kind) {
    static const char *const names[WEFT_CAUSE_KIND_COUNT] = {"term", "engine", "light", "picture"};
    return kind >= 0 && kind < WEFT_CAUSE_KIND_COUNT ? names[kind] : NULL;
}

WeftResult scene_keep(const WeftScene *scene, SceneKept *kept, WeftError *error) {
    const int materials = scene_own_materials(scene);
    *kept = (SceneKept){.materials = alloc_array((size_t)materials, sizeof(Material)),
                        .lights = alloc_array((size_t)scene->light_count, sizeof(Light)),
                        .material_count = materials,
                        .light_count = scene->light_count,
                        .environment = scene->environment,
                        .srgb = scene->srgb};
    if (!kept->materials || !kept->lights) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    for (int k = 0; k < materials; k++) kept->materials[k] = scene->materials[k];
    for (int k = 0; k < scene->light_count; k++) kept->lights[k] = scene->lights[k];
    return WEFT_OK;
}

void scene_kept_free(SceneKept *kept) {
    free(kept->materials);
    free(kept->lights);
}

static WeftResult put_back(WeftScene *scene, const SceneKept *kept, WeftError *error) {
    WeftResult result = WEFT_OK;
    scene->environment = kept->environment;
    scene->srgb = kept->srgb;
    scene->light_count = kept->light_count;
    for (int k = 0; k < kept->light_count; k++) scene->lights[k] = kept->lights[k];
    for (int k = 0; k < kept->material_count && result == WEFT_OK; k++)
        result = weft_scene_put_material(scene, k, &kept->materials[k], error);
    return result;
}

/* Returns true if two materials have the same numbers, textures and choices. */
static bool is_same(const Material *a, const Material *b) {
    bool same = true;
    for (int k = 0; k < CHOICE_COUNT; k++) same = same && a->choices[k] == b->choices[k];
    for (int k = 0; k < INPUT_COUNT; k++) {
        same = same && a->inputs[k].texture == b->inputs[k].texture;
        for (int c = 0; c < 3; c++) same = same && fabsf(a->inputs[k].value[c] - b->inputs[k].value[c]) < 1e-7f;
    }
    return same;
}

/* Draws a material as an engine does: choices that the profile makes are left to it. */
static void set_profile(Material *material, int profile) {
    for (int k = 0; k < CHOICE_COUNT; k++)
        if (k != CHOICE_workflow && k != CHOICE_convert) material->choices[k] = CHOICE_AUTO;
    weft_material_choose(material, CHOICE_profile, profile);
}

/* Sets "NAME=VALUE" of a material. A row that names no input or choice is a fault of the table. */
static WeftResult apply_set(Material *material, const char *set, WeftError *error) {
    char name[SET_SIZE];
    const char *equals = strchr(set, '=');
    if (!equals) return fail(error, WEFT_MESSAGE_PARAM_NAME, set, NULL);
    snprintf(name, sizeof name, "%.*s", (int)(equals - set), set);
    return weft_material_set(material, name, equals + 1, NULL, error);
}

static WeftResult change_material(int cause, Material *material, WeftError *error) {
    WeftResult result = WEFT_OK;
    if (cause >= ROWS) {
        set_profile(material, cause - ROWS);
        return WEFT_OK;
    }
    const CauseRow *row = &rows[cause];
    if (row->reads != ANY && !weft_material_reads(material, (int)row->reads)) return WEFT_OK;
    if (row->material) row->material(material);
    for (int k = 0; k < SETS && row->sets[k] && result == WEFT_OK; k++)
        result = apply_set(material, row->sets[k], error);
    return result;
}

/* Changes all materials; *changed becomes true if one is another afterwards. */
static WeftResult change_materials(WeftJudge *judge, int cause, const SceneKept *kept, bool *changed,
                                   WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = 0; k < kept->material_count && result == WEFT_OK; k++) {
        Material material = kept->materials[k];
        if (material.unlit) continue;
        result = change_material(cause, &material, error);
        if (result != WEFT_OK || is_same(&material, &kept->materials[k])) continue;
        *changed = true;
        result = weft_scene_put_material(judge->scene, k, &material, error);
    }
    return result;
}

/* Makes the reference with another amount of light. */
static WeftResult scale_reference(const WeftJudge *judge, float factor, WeftImage *out, WeftError *error) {
    WeftResult result = weft_image_convert_f32(&judge->reference, 0, out, error);
    if (result != WEFT_OK) return result;
    float *values = out->pixels;
    const size_t pixels = (size_t)out->width * (size_t)out->height;
    for (size_t k = 0; k < pixels; k++)
        for (size_t c = 0; c < 3; c++) values[4 * k + c] *= factor;
    return WEFT_OK;
}

WeftResult judge_cause_render(WeftJudge *judge, int cause, const SceneKept *kept, WeftProgress progress, void *user,
                              WeftImage *out, bool *made, WeftError *error) {
    WeftRenderDesc desc = judge->desc.render;
    const CauseRow *row = cause < ROWS ? &rows[cause] : NULL;
    *out = (WeftImage){0};
    *made = row && row->factor > 0.0f;
    if (*made) return scale_reference(judge, row->factor, out, error);
    WeftResult result = WEFT_OK, after;
    if (row && row->scene)
        *made = row->scene(judge->scene, &desc);
    else
        result = change_materials(judge, cause, kept, made, error);
    if (result == WEFT_OK && *made)
        result = judge_render(judge, &desc, WEFT_CHANGED_MATERIALS | WEFT_CHANGED_LIGHTS, progress, user, out, error);
    after = put_back(judge->scene, kept, result == WEFT_OK ? error : NULL);
    return result == WEFT_OK ? after : result;
}

bool judge_cause_is_of_values(int cause) { return cause < ROWS && rows[cause].values != VALUES_KEPT; }

bool judge_cause_is_fitted(int cause) { return cause < ROWS && rows[cause].values == VALUES_SCALED; }

static double encoded(double x) { return (double)tone_encode((float)fmin(fmax(x, 0.0), 1.0)); }

/* Returns the factor of r that comes closest to p. */
static double best_factor(const WeftJudge *judge, const CellMean *p, const CellMean *r, const CellMean *scales) {
    double above = 0.0, below = 0.0;
    for (int k = 0; k < judge->cell_count; k++)
        for (int c = 0; c < JUDGE_CHANNELS; c++) {
            const double square = r[k].c[c] * r[k].c[c], weight = judge->cells[k].pixels / (scales[k].c[c] + square);
            above += weight * p[k].c[c] * r[k].c[c];
            below += weight * square;
        }
    return below > 0.0 ? above / below : 1.0;
}

void judge_cause_values(const WeftJudge *judge, int cause, const CellMean *p, const CellMean *r, const CellMean *scales,
                        CellMean *out) {
    const ValueChange change = rows[cause].values;
    const double factor = change == VALUES_SCALED ? best_factor(judge, p, r, scales) : 1.0;
    for (int k = 0; k < judge->cell_count; k++)
        for (int c = 0; c < JUDGE_CHANNELS; c++)
            out[k].c[c] = change == VALUES_ENCODED   ? encoded(r[k].c[c])
                          : change == VALUES_DECODED ? (double)srgb_decode((float)fmax(r[k].c[c], 0.0))
                                                     : factor * r[k].c[c];
}
