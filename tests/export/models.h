/* models.h - all that can be exported, the same questions put to a text in any language, and the library's
 * answers */
#ifndef WEFT_TESTS_EXPORT_MODELS_H
#define WEFT_TESTS_EXPORT_MODELS_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "weft/export.h"

#include "base/memory.h"
#include "export/sheen.h"
#include "measure/bsdf/draw.h"
#include "measure/bsdf/grid.h"
#include "scene/material/material_numbers.h"
#include "scene/record/material_at.h"
#include "shading/material/choice.h"
#include "shading/material/material_stack.h"
#include "weave/cloth_base.h"

enum { PAIRS = 4096, INPUTS = 6, OUTPUTS = 2, MODELS_MAX = 192 };

/* A lobe, or a material: a profile's, a workflow's or a preset's. */
typedef struct Exported {
    const char *id;
    bool is_lobe, fixed; /* fixed: a material with its own numbers */
    WeftLobe lobe;
    WeftMaterial numbers;
    Material material;
    bool profile;
    WeftCloth *cloth; /* kept to the end of the program; NULL: not woven */
} Exported;

static inline int models_lobes(Exported *out) {
    int count = 0;
    for (int k = 0; k < weft_lobe_count(); k++) {
        const WeftLobeInfo *info = weft_lobe_info(k);
        if (info->traits & WEFT_LOBE_REFERENCE) continue;
        out[count] = (Exported){.id = info->id, .is_lobe = true};
        assert_int_equal(weft_lobe_init(info->id, &out[count].lobe, NULL), WEFT_OK);
        count++;
    }
    return count;
}

static inline int models_profiles(Exported *out) {
    int count = 0;
    for (int k = 0; weft_workflow_name(k); k++) {
        out[count] = (Exported){.id = weft_workflow_name(k), .profile = true};
        out[count].material = material_default();
        material_choose(&out[count++].material, CHOICE_workflow, k);
    }
    for (int k = 1; weft_profile_name(k); k++) {
        out[count] = (Exported){.id = weft_profile_name(k), .profile = true};
        out[count].material = material_default();
        material_choose(&out[count++].material, CHOICE_profile, k);
    }
    return count;
}

/* Materials of choices beside a workflow: rules below the interface, a sheen of free terms with an F of its
 * colour, a round highlight on a brushed base, light through cloth, and inputs of the other workflow. */
static inline int models_choices(Exported *out) {
    static const struct {
        const char *id, *workflow, *layer, *sheen_d, *sheen_v, *sheen_f, *d, *f, *through, *metallic, *convert;
    } rows[] = {{"a_seed", "metallic", "seed", "auto", "auto", "auto", "auto", "cook-torrance", "0", "0", "auto"},
                {"a_blend", "metallic", "side-by-side", "charlie", "conty-kulla-soft", "auto", "auto", "auto", "0.3",
                 "0", "auto"},
                {"a_sheen", "disney", "albedo-view", "inverse-ggx", "implicit", "cook-torrance", "ggx", "auto", "0",
                 "0", "auto"},
                {"a_thin", "cloth", "albedo-max", "auto", "auto", "auto", "auto", "auto", "0.6", "0", "auto"},
                {"a_gold", "metallic", "albedo-max", "auto", "auto", "auto", "auto", "auto", "0", "0.7", "specular"},
                {"a_chrome", "specular", "albedo-max", "auto", "auto", "auto", "ggx", "auto", "0", "0", "metallic"}};
    enum { ROWS = sizeof rows / sizeof *rows };
    for (int k = 0; k < ROWS; k++) {
        const char *const choices[][2] = {{"workflow", rows[k].workflow},
                                          {"layer", rows[k].layer},
                                          {"sheen_d", rows[k].sheen_d},
                                          {"sheen_v", rows[k].sheen_v},
                                          {"sheen_f", rows[k].sheen_f},
                                          {"d", rows[k].d},
                                          {"f", rows[k].f},
                                          {"diffuse_transmission", rows[k].through},
                                          {"metallic", rows[k].metallic},
                                          {"convert", rows[k].convert},
                                          {"specular_color", "0.7,0.5,0.2"},
                                          {"base_color", "0.8,0.4,0.1"},
                                          {"diffuse_transmission_color", "0.9,0.6,0.3"}};
        WeftScene *scene;
        assert_int_equal(weft_scene_load("builtin:ball", &scene, NULL, NULL), WEFT_OK);
        assert_int_equal(weft_scene_set(scene, "ball.anisotropy", "0.7", NULL, NULL), WEFT_OK);
        assert_int_equal(weft_scene_set(scene, "ball.sheen", "0.4", NULL, NULL), WEFT_OK);
        for (size_t c = 0; c < sizeof choices / sizeof *choices; c++) {
            char target[48];
            snprintf(target, sizeof target, "ball.%s", choices[c][0]);
            assert_int_equal(weft_scene_set(scene, target, choices[c][1], NULL, NULL), WEFT_OK);
        }
        out[k] = (Exported){.id = rows[k].id, .fixed = true};
        assert_int_equal(weft_scene_material(scene, 0, &out[k].numbers, NULL), WEFT_OK);
        out[k].material = material_sound(&out[k].numbers);
        weft_scene_free(scene);
    }
    return ROWS;
}

static inline int models_presets(Exported *out) {
    int count = 0;
    WeftScene *scene;
    assert_int_equal(weft_scene_load("builtin:spheres", &scene, NULL, NULL), WEFT_OK);
    for (; weft_preset_name(count); count++) {
        char path[64];
        snprintf(path, sizeof path, "preset:%s", weft_preset_name(count));
        assert_int_equal(weft_scene_assign_material(scene, "*", path, NULL, NULL), WEFT_OK);
        out[count] = (Exported){.id = weft_preset_name(count), .fixed = true};
        assert_int_equal(weft_scene_material(scene, 0, &out[count].numbers, NULL), WEFT_OK);
        out[count].material = material_sound(&out[count].numbers);
    }
    weft_scene_free(scene);
    return count;
}

/* Cloths: bare threads with and without gaps, and a rotated weave below a sheen, a coat and dust that lets light through,
 * whose gaps are holes. */
static inline int models_woven(Exported *out) {
    static const char *const ids[] = {"woven-denim", "woven-linen", "a_weave"}, *const layers[][2] = {
                                                                                    {"weave.draft",
                                                                                     "twill 2/2 z; warp 2k 2r"},
                                                                                    {"weave.warp", "wool"},
                                                                                    {"weave.rotation", "30"},
                                                                                    {"weave.metres", "1"},
                                                                                    {"sheen_color", "0.6,0.4,0.3"},
                                                                                    {"clearcoat", "0.5"},
                                                                                    {"dust", "0.05"},
                                                                                    {"wear", "0.4"},
                                                                                    {"diffuse_transmission", "0.3"},
                                                                                    {"opacity", "1"}};
    enum { WOVEN = sizeof ids / sizeof *ids, LAYERS = sizeof layers / sizeof *layers };
    for (int k = 0; k < WOVEN; k++) {
        WeftScene *scene;
        WeftError error;
        char path[64];
        snprintf(path, sizeof path, "preset:%s", k + 1 < WOVEN ? ids[k] : ids[0]);
        out[k] = (Exported){.id = ids[k], .fixed = true};
        assert_int_equal(weft_scene_load("builtin:ball", &scene, NULL, &error), WEFT_OK);
        assert_int_equal(weft_scene_assign_material(scene, NULL, path, NULL, &error), WEFT_OK);
        for (int layer = 0; k + 1 == WOVEN && layer < LAYERS; layer++) {
            char target[64];
            snprintf(target, sizeof target, "ball.%s", layers[layer][0]);
            if (weft_scene_set(scene, target, layers[layer][1], NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        }
        assert_int_equal(weft_scene_material(scene, 0, &out[k].numbers, &error), WEFT_OK);
        out[k].material = material_sound(&out[k].numbers);
        assert_int_equal(weft_scene_cloth_copy(scene, out[k].numbers.cloth, &out[k].cloth, &error), WEFT_OK);
        weft_scene_free(scene);
    }
    return WOVEN;
}

static inline bool has_albedo(const Exported *s) {
    return s->is_lobe && !(weft_lobe_info(s->lobe.lobe)->traits & WEFT_LOBE_ANISOTROPIC);
}

static inline WeftExportDesc model_desc(const Exported *s, WeftExportTarget target) {
    WeftExportDesc desc = {.target = target, .lut = WEFT_EXPORT_LUT_EXR, .name = s->id};
    if (target == WEFT_EXPORT_C) desc.lut = WEFT_EXPORT_LUT_C;
    if (s->is_lobe) {
        desc.lobe = &s->lobe;
        /* that of stretched highlights and of threads takes seconds */
        desc.albedo = target != WEFT_EXPORT_SHADERTOY && has_albedo(s);
    } else if (s->profile) {
        desc.profile = s->id;
    } else {
        desc.material = &s->numbers;
        desc.cloth = s->cloth;
    }
    return desc;
}

static inline WeftExport model_export(const WeftExportDesc *desc) {
    WeftExport out;
    WeftError error = {0};
    if (weft_export(desc, &out, &error) != WEFT_OK) fail_msg("%s: %s", desc->name, error.text);
    return out;
}

/* Of a material that is not fixed these vary: where each is in the inputs. */
static const struct {
    const char *name, *at;
    int row, column;
} varied[] = {{"base_color", "rgb", 2, 0},   {"roughness", "in2.w", 2, 3},
              {"sheen_color", "rgb", 3, 0},  {"sheen_roughness", "in3.w", 3, 3},
              {"metallic", "in4.x", 4, 0},   {"specular", "in4.y", 4, 1},
              {"clearcoat", "in4.z", 4, 2},  {"clearcoat_roughness", "in4.w", 4, 3},
              {"sheen", "in5.x", 5, 0},      {"anisotropy", "in5.y", 5, 1},
              {"subsurface", "in5.z", 5, 2}, {"sheen_tint", "in5.w", 5, 3}};
enum { VARIED = sizeof varied / sizeof varied[0] };

static inline Dir any_direction(Draw *draw) {
    double z = 1.0 - (double)draw_unit(draw), phi = 6.28318530717959 * (double)draw_unit(draw);
    return grid_direction(draw_unit(draw) < 0.25f ? (exp2)(-10.0 * z) : z, phi);
}

/* Sets where a point of a cloth is seen, and how large its pixel is: from a hundredth of a thread to a hundred. */
static inline void woven_inputs(const Exported *s, float *in[INPUTS], size_t k) {
    const float per = s->cloth->per_uv[WEFT_WARP], size = 0.01f * (float)(pow)(1e4, (double)in[4][4 * k]) / per;
    for (size_t c = 0; c < 2; c++) in[2][4 * k + c] = (40.0f * in[2][4 * k + c] - 20.0f) / per;
    for (size_t c = 0; c < 4; c++) in[3][4 * k + c] = (2.0f * in[3][4 * k + c] - 1.0f) * size;
    in[2][4 * k + 2] = k % 3 ? 1.0f : 4.0f;
}

/* in[row][4 k + column] */
static inline void model_inputs(const Exported *s, float *in[INPUTS]) {
    Draw draw = draw_start(20, 0);
    for (size_t k = 0; k < PAIRS; k++) {
        Dir o = any_direction(&draw), i = any_direction(&draw);
        if (!s->is_lobe && k % 4 == 3) i.z = -i.z; /* light from behind */
        const float rows[2][4] = {{o.x, o.y, o.z, draw_unit(&draw)}, {i.x, i.y, i.z, draw_unit(&draw)}};
        for (size_t c = 0; c < 4; c++) {
            in[0][4 * k + c] = rows[0][c];
            in[1][4 * k + c] = rows[1][c];
            for (int row = 2; row < INPUTS; row++) in[row][4 * k + c] = draw_unit(&draw);
        }
        if (s->cloth) woven_inputs(s, in, k);
        for (int p = 0; s->is_lobe && p < weft_lobe_info(s->lobe.lobe)->param_count; p++) {
            const WeftParamInfo *info = &weft_lobe_info(s->lobe.lobe)->params[p];
            float x = info->low + (info->high - info->low) * draw_unit(&draw),
                  *to = &in[2 + p / 4][4 * k + (size_t)(p % 4)];
            *to = info->choices ? (float)(int)(x + 0.5f) : x;
        }
    }
}

/* The words of a target for what a question is put in. */
typedef struct Language {
    const char *dir, *rgb, *whole, *number;
    const char *of; /* behind the name of a function without parameters that returns a record */
    bool typed;     /* a variable's type stands before it */
} Language;

static const Language language_glsl = {"vec3", "vec3", "int", "float", "() {", true};
static const Language language_hlsl = {"float3", "float3", "int", "float", "() {", true};
static const Language language_wgsl = {"vec3f", "vec3f", "i32", "f32", "() -> ", false};

typedef struct WrittenBody {
    char *text;
    size_t used, room;
} WrittenBody;

__attribute__((format(printf, 2, 3))) static inline void body_put(WrittenBody *body, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    body->used += (size_t)vsnprintf(body->text + body->used, body->room - body->used, format, arguments);
    va_end(arguments);
    assert_true(body->used < body->room);
}

/* "    T name", or "    var name: T". */
static inline void body_declare(WrittenBody *body, const Language *language, const char *type, const char *name) {
    if (language->typed)
        body_put(body, "    %s %s", type, name);
    else
        body_put(body, "    var %s: %s", name, type);
}

/* The function of that name that returns a record: what it returns, and its text from there on. */
static inline const char *model_record(const WeftExport *text, const Language *language, const char *end,
                                       char type[64]) {
    char call[64];
    snprintf(call, sizeof call, "%s%s", end, language->of);
    const char *at = strstr(text->text, call), *record = at;
    assert_non_null(at);
    if (language->typed) {
        while (record[-1] != '\n') record--;
        if (strncmp(record, "static inline ", 14) == 0) record += 14;
    } else {
        record += strlen(call);
    }
    snprintf(type, 64, "%.*s", (int)strcspn(record, " "), record);
    return at;
}

static inline void put_lobe_questions(const Exported *s, const WeftExport *text, const Language *l, const char *id,
                                      WrittenBody *body) {
    const WeftLobeInfo *info = weft_lobe_info(s->lobe.lobe);
    bool two = info->traits & WEFT_LOBE_TWO_COLORS;
    char type[64];
    model_record(text, l, "_default", type);
    body_declare(body, l, type, "m");
    body_put(body, " = %s_default();\n", id);
    for (int p = 0; p < info->param_count; p++)
        body_put(body, "    m.%s = %s(in%d.%c);\n", info->params[p].name,
                 info->params[p].choices ? l->whole : l->number, 2 + p / 4, "xyzw"[p % 4]);
    body_declare(body, l, l->rgb, "color");
    body_put(body, "; color.r = in4.x; color.g = in4.y; color.b = in4.z;\n");
    if (two) body_declare(body, l, l->rgb, "second");
    if (two) body_put(body, "; second.r = in5.x; second.g = in5.y; second.b = in5.z;\n");
    body_declare(body, l, l->rgb, "f");
    body_put(body, " = %s_eval(m, color, %so, i);\n", id, two ? "second, " : "");
    body_declare(body, l, l->dir, "drawn");
    body_put(body, " = %s_sample(m, o, in0.w, in1.w);\n", id);
    body_put(body,
             "    out0.w = %s_pdf(m, o, i);\n    out1.x = drawn.x;\n    out1.y = drawn.y;\n"
             "    out1.z = drawn.z;\n",
             id);
    if (has_albedo(s)) body_put(body, "    out1.w = %s_albedo(m, o.z);\n", id);
}

static inline void put_material_questions(const Exported *s, const WeftExport *text, const Language *l, const char *id,
                                          WrittenBody *body) {
    char type[64];
    const char *numbers = model_record(text, l, "_surface", type);
    body_declare(body, l, type, "s");
    body_put(body, " = %s_surface();\n", id);
    for (int v = 0; v < VARIED && !s->fixed; v++) {
        const char *name = varied[v].name;
        int row = varied[v].row;
        char found[64];
        snprintf(found, sizeof found, "    s.%s = ", name);
        if (!strstr(numbers, found)) continue; /* the composition does not read it */
        if (strcmp(varied[v].at, "rgb") == 0)
            body_put(body, "    s.%s.r = in%d.x; s.%s.g = in%d.y; s.%s.b = in%d.z;\n", name, row, name, row, name, row);
        else
            body_put(body, "    s.%s = %s;\n", name, varied[v].at);
    }
    body_declare(body, l, l->rgb, "f");
    if (!s->cloth) {
        body_put(body, " = %s_shade(s, o, i);\n", id);
        return;
    }
    char seen[256];
    snprintf(seen, sizeof seen, "%s_see(s, in2.x, in2.y, in3.x, in3.y, in3.z, in3.w, %s(in2.z))", id, l->whole);
    body_put(body, " = %s_shade(s, %s, o, i);\n    out0.w = %s.covers;\n    out1.x = %s.afar;\n", id, seen, seen, seen);
}

/* Statements which read in0 .. in5 and set members of out0 and out1. */
static inline void model_body(const Exported *s, const WeftExport *text, const char *prefix, const Language *l,
                              char *out, size_t room) {
    char id[64];
    WrittenBody body = {.text = out, .room = room};
    snprintf(id, sizeof id, "%s%s", prefix, s->id);
    for (char *k = id; *k; k++)
        if (*k == '-') *k = '_';
    body_declare(&body, l, l->dir, "o");
    body_put(&body, "; o.x = in0.x; o.y = in0.y; o.z = in0.z;\n");
    body_declare(&body, l, l->dir, "i");
    body_put(&body, "; i.x = in1.x; i.y = in1.y; i.z = in1.z;\n");
    (s->is_lobe ? put_lobe_questions : put_material_questions)(s, text, l, id, &body);
    body_put(&body, "    out0.x = f.r;\n    out0.y = f.g;\n    out0.z = f.b;\n");
}

static inline void put_varied(Surface *s, float *const in[INPUTS], size_t k) {
    const float *a = in[2] + 4 * k, *b = in[3] + 4 * k, *c = in[4] + 4 * k, *d = in[5] + 4 * k;
    s->base_color = (Rgb){a[0], a[1], a[2]};
    s->sheen_color = (Rgb){b[0], b[1], b[2]};
    s->roughness = a[3], s->sheen_roughness = b[3];
    s->metallic = c[0], s->specular = c[1], s->clearcoat = c[2], s->clearcoat_roughness = c[3];
    s->sheen = d[0], s->anisotropy = d[1], s->subsurface = d[2], s->sheen_tint = d[3];
}

/* The library's answers, out[0 .. 1][4 k + column]. */
static inline void lobe_answers(const Exported *s, float *const in[INPUTS], float *out[OUTPUTS]) {
    const WeftLobeInfo *info = weft_lobe_info(s->lobe.lobe);
    AlbedoTable *table = calloc(1, sizeof *table);
    assert_non_null(table);
    Lobe base;
    assert_true(lobe_of(&s->lobe, &base));
    bool rows = info->param_count > 0 && !info->params[0].choices;
    if (has_albedo(s))
        albedo_table_fill(table, &base, rows ? info->params[0].low : 0.0f, rows ? info->params[0].high : 0.0f, 0);
    TableRef e = albedo_table_ref(table);
    for (size_t k = 0; k < PAIRS; k++) {
        WeftLobe lobe = s->lobe;
        Dir o = dir(in[0][4 * k], in[0][4 * k + 1], in[0][4 * k + 2]);
        for (int p = 0; p < info->param_count; p++) lobe.params[p] = in[2 + p / 4][4 * k + (size_t)(p % 4)];
        for (size_t c = 0; c < 3; c++) lobe.f0[c] = in[4][4 * k + c], lobe.f90[c] = in[5][4 * k + c];
        weft_lobe_eval(&lobe, in[0] + 4 * k, in[1] + 4 * k, out[0] + 4 * k);
        out[0][4 * k + 3] = weft_lobe_pdf(&lobe, in[0] + 4 * k, in[1] + 4 * k);
        Lobe inner;
        assert_true(lobe_of(&lobe, &inner));
        Dir drawn = lobe_sample(&inner, o, in[0][4 * k + 3], in[1][4 * k + 3]);
        out[1][4 * k] = drawn.x, out[1][4 * k + 1] = drawn.y, out[1][4 * k + 2] = drawn.z;
        out[1][4 * k + 3] = has_albedo(s) ? table_roots(e, o.z, rows ? lobe.params[0] : 0.0f) : 0.0f;
    }
    free(table);
}

/* Returns a colour of a cloth from afar at x, y in threads: the mean over the texels of two levels around the place. */
static inline void woven_color(const WeftCloth *cloth, float level, int layer, const float at[2], float color[4]) {
    const double last = (double)(cloth->far.levels - 1), between = fmin((double)level, last);
    const int counts[2] = {cloth->weave.warps, cloth->weave.picks};
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    for (int corner = 0; corner < 8; corner++) {
        const int coarser = corner / 4, floored = (int)(floor)(between);
        int sides[2], texel[2];
        double weight = coarser ? between - floored : 1.0 - (between - floored);
        const float *texels = cloth_far_level(&cloth->far, (int)fmin(floored + coarser, last), &sides[0], &sides[1]);
        for (int axis = 0; axis < 2; axis++) {
            const double place = (double)at[axis] / counts[axis] * sides[axis] - 0.5, low = (floor)(place);
            const int next = corner >> axis & 1;
            weight *= next ? place - low : 1.0 - (place - low);
            texel[axis] = (((int)low + next) % sides[axis] + sides[axis]) % sides[axis];
        }
        texels += 4 * ((layer * sides[1] + texel[1]) * sides[0] + texel[0]);
        for (int c = 0; c < 4; c++) sum[c] += weight * (double)texels[c];
    }
    for (int c = 0; c < 4; c++) color[c] = (float)sum[c];
}

/* Returns one system from afar at a place, as the raster engine has it. */
static inline WeaveBase woven_system(const WeftCloth *cloth, bool weft, const float at[2], WeaveFootprint f, int points,
                                     float wear) {
    const Weave *m = &cloth->weave;
    const float texels = points > 1 ? 2.0f : 1.0f;
    const float level = weave_far_level(f, texels * (float)m->warps / (float)cloth->far.width,
                                        texels * (float)m->picks / (float)cloth->far.height);
    float single[4], multiple[4];
    woven_color(cloth, level, weft ? FAR_WEFT_SINGLE : FAR_WARP_SINGLE, at, single);
    woven_color(cloth, level, weft ? FAR_WEFT_MULTIPLE : FAR_WARP_MULTIPLE, at, multiple);
    return weave_far(m, weft, rgb(single[0], single[1], single[2]), rgb(multiple[0], multiple[1], multiple[2]),
                     single[3], weave_far_dye(m, weft, at[0], at[1], f), wear);
}

/* A cloth's answer: its bases in the stack of the material one by one, as in a picture, and the layers above them. */
typedef struct WovenAsked {
    const WeftCloth *cloth;
    Surface surface;
    Choices choices;
    TableRef e;
    Dir o, i;
} WovenAsked;

/* Returns f cos of the stack on a base, of the base alone or of all else. axis: of a thread; woven: lobe of a system. */
static inline Rgb woven_f(const WovenAsked *asked, WeaveBase base, const Dir *axis, const WovenPrepared *woven,
                          bool own) {
    SeenStack seen;
    stack_make(&seen.stack, &asked->surface, &asked->choices, asked->e);
    stack_put_base(&seen.stack, &base.lobe, base.single, base.multiple);
    if (axis) seen.stack.diffuse_prepared.yarn.axis = *axis;
    if (woven) seen.stack.diffuse_prepared.woven = *woven;
    if (woven) seen.stack.diffuse_prepared.woven.scale = 1.0f;
    stack_see(&seen.stack, &asked->o, &seen.view);
    return stack_eval_of(&seen.stack, &seen.view, slots_of(own, false, !own, !own, !own), asked->i).f_cos;
}

static inline void woven_answer(const WovenAsked *asked, bool holed, const float uv[2], const float step[4], int points,
                                float out[4], float *afar) {
    const WeftCloth *cloth = asked->cloth;
    const Weave *m = &cloth->weave;
    const float c = cloth->rotation_parts[0], s = cloth->rotation_parts[1], wear = asked->surface.wear;
    float to[3][2]; /* the place, and the steps to the next pixels, in threads */
    for (int k = 0; k < 3; k++) {
        const float *from = k ? step + 2 * k - 2 : uv;
        to[k][0] = (c * from[0] - s * from[1]) * cloth->per_uv[WEFT_WARP];
        to[k][1] = (-c * from[1] - s * from[0]) * cloth->per_uv[WEFT_WEFT];
    }
    const WeaveFootprint f = weave_footprint(to[1][0], to[1][1], to[2][0], to[2][1]);
    const float far = points > 1 ? weave_far_weight(f) : weave_far_weight_alone(f);
    const uint across = weave_key(m->seed, WEAVE_OF_LOTS, (floorf)(32.0f * to[0][0]), (floorf)(32.0f * to[0][1]));
    const WeavePoint p = weave_point(m, to[0][0], to[0][1], f.longest / sqrtf((float)points), weave_second(across));
    const float there = p.height > WEAVE_NONE ? 1.0f : 0.0f;
    const WeaveBase near = weave_near(m, p, wear);
    Rgb sum = rgb_scale(woven_f(asked, near, &p.fibre, NULL, true), 1.0f - far);
    for (int t = 0; t < 2; t++)
        sum = rgb_add(sum, rgb_scale(woven_f(asked, woven_system(cloth, t == 1, to[0], f, points, wear), NULL,
                                             &cloth->far.woven[t], true),
                                     far));
    const float covers = mix(there, min(m->warp_far.share + m->weft_far.share, 1.0f), far);
    const Rgb above = woven_f(asked, near, &p.fibre, NULL, false);
    if (asked->i.z > 0.0f)
        sum = rgb_add(sum, rgb_scale(above, holed ? covers : 1.0f));
    else
        sum = rgb_scale(woven_f(asked, near, &p.fibre, NULL, true), holed ? covers : 1.0f);
    out[0] = sum.r, out[1] = sum.g, out[2] = sum.b, out[3] = covers;
    *afar = far;
}

static inline void woven_answers(const Exported *s, float *const in[INPUTS], float *out[OUTPUTS]) {
    AlbedoTable *table = calloc(1, sizeof *table);
    assert_non_null(table);
    WovenAsked asked = {
        .cloth = s->cloth, .surface = material_plain(&s->material), .choices = material_choices(&s->material)};
    sheen_table_fill(&asked.surface, &asked.choices, table);
    asked.e = albedo_table_ref(table);
    const float c = s->cloth->rotation_parts[0], sine = s->cloth->rotation_parts[1];
    for (size_t k = 0; k < PAIRS; k++) {
        Dir *const to[2] = {&asked.o, &asked.i};
        for (int d = 0; d < 2; d++) {
            const float *w = in[d] + 4 * k;
            *to[d] = dir(c * w[0] + sine * w[1], c * w[1] - sine * w[0], w[2]);
        }
        woven_answer(&asked, s->material.alpha_mode != WEFT_ALPHA_OPAQUE, in[2] + 4 * k, in[3] + 4 * k,
                     (int)in[2][4 * k + 2], out[0] + 4 * k, out[1] + 4 * k);
        for (size_t r = 1; r < 4; r++) out[1][4 * k + r] = 0.0f;
    }
    free(table);
}

static inline void material_answers(const Exported *s, float *const in[INPUTS], float *out[OUTPUTS]) {
    const Choices choices = material_choices(&s->material);
    Surface plain = material_plain(&s->material);
    AlbedoTable *table = calloc(1, sizeof *table);
    assert_non_null(table);
    sheen_table_fill(&plain, &choices, table);
    for (size_t k = 0; k < PAIRS; k++) {
        Surface surface = plain;
        SeenStack seen;
        Dir o = dir(in[0][4 * k], in[0][4 * k + 1], in[0][4 * k + 2]);
        Dir i = dir(in[1][4 * k], in[1][4 * k + 1], in[1][4 * k + 2]);
        if (!s->fixed) put_varied(&surface, in, k);
        seen_make(&seen, &surface, &choices, albedo_table_ref(table), o);
        Rgb f = stack_eval_of(&seen.stack, &seen.view, slots_all(), i).f_cos;
        out[0][4 * k] = f.r, out[0][4 * k + 1] = f.g, out[0][4 * k + 2] = f.b, out[0][4 * k + 3] = 0.0f;
        for (size_t c = 0; c < 4; c++) out[1][4 * k + c] = 0.0f;
    }
    free(table);
}

static inline void model_answers(const Exported *s, float *const in[INPUTS], float *out[OUTPUTS]) {
    (s->is_lobe ? lobe_answers : s->cloth ? woven_answers : material_answers)(s, in, out);
}

typedef struct Arrays {
    float *in[INPUTS], *out[OUTPUTS], *expected[OUTPUTS];
} Arrays;

/* The inputs and the library's answers. */
static inline void arrays_fill(const Exported *s, Arrays *a);

static inline void arrays_fill(const Exported *s, Arrays *a) {
    model_inputs(s, a->in);
    model_answers(s, a->in, a->expected);
}

static inline Arrays arrays_make(void) {
    Arrays a;
    for (int k = 0; k < INPUTS; k++) assert_non_null(a.in[k] = alloc_array(PAIRS, 16));
    for (int k = 0; k < OUTPUTS; k++) {
        assert_non_null(a.out[k] = alloc_array(PAIRS, 16));
        assert_non_null(a.expected[k] = alloc_array(PAIRS, 16));
    }
    return a;
}

static inline void arrays_free(Arrays *a) {
    for (int k = 0; k < INPUTS; k++) free(a->in[k]);
    for (int k = 0; k < OUTPUTS; k++) free(a->out[k]), free(a->expected[k]);
}

/* How far an answer is off, over what it may be. f, pdf and E: 5e-4 relative, and 1e-5 where they are small.
 * Directions have a tolerance of their own: the steep ends of a sampler's maps, where a number that is off by
 * 1e-7 turns a direction by its square root. */
static inline double answer_error(const Exported *s, int q, size_t at, double expected, double got) {
    bool direction = s->is_lobe && q == 1 && at % 4 < 3;
    return fabs(got - expected) / (direction ? 1e-3 : 5e-4 * fabs(expected) + 1e-5);
}

static inline void assert_agree(const Exported *s, const char *target, const Arrays *a) {
    double worst = 0.0;
    size_t where = 0;
    int which = 0;
    for (int q = 0; q < OUTPUTS; q++)
        for (size_t k = 0; k < (size_t)4 * PAIRS; k++) {
            double error = answer_error(s, q, k, (double)a->expected[q][k], (double)a->out[q][k]);
            if (!(error <= worst)) worst = error, where = k, which = q;
        }
    if (getenv("WEFT_TEST_TELL")) print_message("%-6s %-28s %.2g of the tolerance\n", target, s->id, worst);
    if (!(worst <= 1.0))
        fail_msg("%s, %s: pair %zu, answer %d of output %d: %.8g, not %.8g", s->id, target, where / 4, (int)(where % 4),
                 which, (double)a->out[which][where], (double)a->expected[which][where]);
}

#endif
