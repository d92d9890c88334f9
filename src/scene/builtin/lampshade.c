#include "scene/builtin/lampshade.h"

#include <math.h>

#include "base/fail.h"
#include "base/pi.h"
#include "scene/builtin/lattice.h"

enum { SHADE, CURTAIN, BULB, STAND, TABLE, THINGS };
static const char *const names[THINGS] = {"shade", "curtain", "bulb", "stand", "table"};

static Vec3 about(float u, float radius, float y) {
    float phi = 2.0f * PI_FLOAT * u;
    return (Vec3){radius * sinf(phi), y, radius * cosf(phi)};
}

static Vec3 shade_point(float u, float v) { return about(u, 0.115f + 0.065f * v, 0.53f - 0.23f * v); }

static Vec3 curtain_point(float u, float v) {
    float x = 1.5f * (u - 0.5f), fold = sinf(52.0f * x) + 0.4f * sinf(19.0f * x + 1.0f);
    return (Vec3){x, 1.1f * (1.0f - v), -0.42f + (0.012f + 0.016f * v) * fold};
}

/* Returns a point of foot and stem, whose profile runs from the middle of the table outwards, up and in. */
static Vec3 stand_point(float u, float v) {
    static const float profile[][2] = {{0.0f, 0.0f},     {0.085f, 0.0f},  {0.09f, 0.006f}, {0.085f, 0.014f},
                                       {0.03f, 0.03f},   {0.01f, 0.06f},  {0.008f, 0.12f}, {0.008f, 0.37f},
                                       {0.014f, 0.375f}, {0.014f, 0.39f}, {0.0f, 0.39f}};
    enum { LAST = sizeof profile / sizeof profile[0] - 1 };
    float at = (1.0f - v) * LAST;
    int k = at < LAST ? (int)at : LAST - 1;
    float t = at - (float)k;
    return about(u, profile[k][0] + t * (profile[k + 1][0] - profile[k][0]),
                 profile[k][1] + t * (profile[k + 1][1] - profile[k][1]));
}

static Vec3 table_point(float u, float v) { return (Vec3){8.0f * (u - 0.5f), 0.0f, 8.0f * (v - 0.5f)}; }

/* Returns a point of the bulb: four upright sides, which both engines treat as polygon lights. */
static Vec3 bulb_point(float u, float v) {
    static const float side = 0.025f;
    int corner = (int)(4.0f * u + 0.5f) & 3;
    return (Vec3){corner == 0 || corner == 3 ? -side : side, 0.465f - 0.06f * v, corner < 2 ? side : -side};
}

static const Lattice lattices[THINGS] = {
    [SHADE] = {.across = 128, .down = 16, .point = shade_point, .smooth = true},
    [CURTAIN] = {.across = 600, .down = 12, .point = curtain_point, .smooth = true},
    [BULB] = {.across = 4, .down = 1, .point = bulb_point},
    [STAND] = {.across = 64, .down = 40, .point = stand_point, .smooth = true},
    [TABLE] = {.across = 1, .down = 1, .point = table_point}};

/* Returns cloth that reflects one colour and transmits another. */
static Material thin_cloth(float share, Vec3 color, Vec3 through) {
    Material m = material_default();
    m.double_sided = true;
    material_set_color(&m, INPUT_base_color, color.x, color.y, color.z);
    m.inputs[INPUT_diffuse_transmission].value[0] = share;
    material_set_color(&m, INPUT_diffuse_transmission_color, through.x, through.y, through.z);
    m.inputs[INPUT_roughness].value[0] = 0.9f;
    material_set_color(&m, INPUT_sheen_color, 0.1f, 0.1f, 0.1f);
    m.inputs[INPUT_sheen_roughness].value[0] = 0.6f;
    return m;
}

static void materials_make(Material *m) {
    m[SHADE] = thin_cloth(0.5f, (Vec3){0.85f, 0.78f, 0.66f}, (Vec3){0.9f, 0.72f, 0.48f});
    m[CURTAIN] = thin_cloth(0.4f, (Vec3){0.42f, 0.50f, 0.55f}, (Vec3){0.45f, 0.55f, 0.62f});
    for (int k = BULB; k < THINGS; k++) m[k] = material_default();
    material_set_color(&m[BULB], INPUT_base_color, 0.0f, 0.0f, 0.0f);
    material_set_color(&m[BULB], INPUT_emission, 1.0f, 0.78f, 0.52f);
    m[BULB].inputs[INPUT_emission_strength].value[0] = 60.0f;
    material_set_color(&m[STAND], INPUT_base_color, 0.75f, 0.52f, 0.28f);
    m[STAND].inputs[INPUT_metallic].value[0] = 1.0f;
    m[STAND].inputs[INPUT_roughness].value[0] = 0.35f;
    material_set_color(&m[TABLE], INPUT_base_color, 0.20f, 0.13f, 0.09f);
    m[TABLE].inputs[INPUT_roughness].value[0] = 0.6f;
}

WeftResult lampshade_make(WeftScene *scene, WeftError *error) {
    Arena *arena = &scene->arena;
    scene->meshes = arena_array(arena, THINGS, sizeof(Mesh));
    scene->materials = arena_array(arena, THINGS, sizeof(Material));
    scene->material_names = arena_array(arena, THINGS, sizeof(char *));
    scene->cameras = arena_array(arena, 1, sizeof(Camera));
    bool made = scene->meshes && scene->materials && scene->material_names && scene->cameras;
    for (int k = 0; made && k < THINGS; k++) {
        char *kept = arena_text(arena, names[k]);
        scene->meshes[k] = (Mesh){.name = kept, .material = k};
        scene->material_names[k] = kept;
        made = kept && lattice_make(arena, &scene->meshes[k], &lattices[k]);
    }
    if (!made) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    materials_make(scene->materials);
    scene->mesh_count = scene->material_count = THINGS;
    scene->cameras[0] = (Camera){.name = "main",
                                 .eye = {0.0f, 0.42f, 1.35f},
                                 .right = {1.0f, 0.0f, 0.0f},
                                 .up = {0.0f, cosf(0.08f), -sinf(0.08f)},
                                 .forward = {0.0f, -sinf(0.08f), -cosf(0.08f)},
                                 .yfov = 0.5f};
    scene->camera_count = 1;
    scene_bounds(scene);
    return WEFT_OK;
}
