#include "scene/builtin/loom_scene.h"

#include <math.h>
#include <stdio.h>

#include "base/fail.h"
#include "base/pi.h"
#include "scene/builtin/lattice.h"
#include "scene/record/camera.h"

/* Cloths first: each has the name of its preset without "woven-". */
enum { DENIM, LINEN, TARTAN, SHOT_SILK, CHARMEUSE, VELVET, CORDUROY, CLOTHS };
enum { BAR = CLOTHS, LEFT_POST, RIGHT_POST, SWEEP, SOFTBOX, THINGS };
static const char *const names[THINGS] = {"denim",    "linen", "tartan",    "shot-silk",  "charmeuse", "velvet",
                                          "corduroy", "bar",   "left-post", "right-post", "sweep",     "softbox"};

static const float unit = 0.5f; /* metres that a unit of texture coordinates spans in these presets */

/* A swatch bent over the upper part of a cylinder, without stretching its threads. */
static const float swatch_width = 0.2f, swatch_bend = 0.55f, swatch_radius = 0.16f;

static Vec3 swatch_point(float u, float v) {
    const float a = swatch_bend * (2.0f * v - 1.0f);
    return (Vec3){swatch_width * (u - 0.5f), swatch_radius * (cosf(a) - cosf(swatch_bend)), swatch_radius * sinf(a)};
}

/* The cloth over the bar, from the lower end behind it over the bar to the lower end in front. */
static const float bar_height = 0.47f, bar_radius = 0.014f, hang_width = 0.44f, hang_behind = 0.3f, hang_before = 0.4f;

static float hang_length(void) { return hang_behind + PI_FLOAT * bar_radius + hang_before; }

/* Folds that begin at the bar. */
static float fold_depth(float x, float below) {
    const float t = fminf(below / 0.3f, 1.0f), wave = sinf(40.0f * x + 0.6f) + 0.4f * sinf(71.0f * x + 1.9f);
    return 0.022f * t * t * (3.0f - 2.0f * t) * (1.0f + 0.7f * wave);
}

static Vec3 hang_point(float u, float v) {
    const float s = v * hang_length(), x = hang_width * (u - 0.5f);
    const float a = fminf(fmaxf((s - hang_behind) / bar_radius, 0.0f), PI_FLOAT);
    const float below = a < 1.5f ? hang_behind - s : s - hang_behind - PI_FLOAT * bar_radius;
    const float out = bar_radius + fold_depth(x, fmaxf(below, 0.0f));
    return (Vec3){x, bar_height + bar_radius * sinf(a) - fmaxf(below, 0.0f), -cosf(a) * out};
}

static Vec3 bar_point(float u, float v) {
    const float phi = -2.0f * PI_FLOAT * v, r = 0.9f * bar_radius; /* a gap between them for depth buffers */
    return (Vec3){0.6f * (u - 0.5f), bar_height + r * cosf(phi), -r * sinf(phi)};
}

static Vec3 post_point(float u, float v) {
    const float phi = 2.0f * PI_FLOAT * u, r = 0.012f;
    return (Vec3){r * sinf(phi), bar_height * (1.0f - v), r * cosf(phi)};
}

/* Returns a point of a photographer's sweep: a wall, a bend and the floor. */
static Vec3 sweep_point(float u, float v) {
    const float wall = 1.6f, bend = 0.5f, s = v * 4.6f, x = 8.0f * (u - 0.5f);
    const float a = fminf(fmaxf((s - wall) / bend, 0.0f), 0.5f * PI_FLOAT);
    return (Vec3){x, bend * (1.0f - sinf(a)) + fmaxf(wall - s, 0.0f),
                  -0.5f - bend * cosf(a) + fmaxf(s - wall - 0.5f * PI_FLOAT * bend, 0.0f)};
}

/* Returns a point of a square light at the upper left, which lights the cloths from the side. */
static Vec3 softbox_point(float u, float v) {
    static const float side = 0.5f;
    const Vec3 middle = {-1.0f, 1.1f, 0.45f}, aim = {0.0f, 0.15f, 0.1f}, up = {0.0f, 1.0f, 0.0f};
    const Vec3 n = vec3_normal_or(vec3_sub(aim, middle), up), along = vec3_normal_or(vec3_cross(n, up), up),
               down = vec3_cross(along, n);
    return vec3_madd(vec3_madd(middle, along, side * (u - 0.5f)), down, side * (v - 0.5f));
}

/* Returns the lattice of object k. Swatches lie in two rows before the bar. */
static Lattice lattice_of(int k) {
    const Lattice others[] = {
        [BAR] = {.across = 1, .down = 48, .point = bar_point, .smooth = true},
        [LEFT_POST] = {.across = 32, .down = 1, .point = post_point, .smooth = true, .at = {-0.29f, 0.0f, 0.0f}},
        [RIGHT_POST] = {.across = 32, .down = 1, .point = post_point, .smooth = true, .at = {0.29f, 0.0f, 0.0f}},
        [SWEEP] = {.across = 1, .down = 92, .point = sweep_point, .smooth = true},
        [SOFTBOX] = {.across = 1, .down = 1, .point = softbox_point},
        [DENIM] = {.across = 220,
                   .down = 220,
                   .point = hang_point,
                   .smooth = true,
                   .span = {hang_width / unit, hang_length() / unit}}};
    if (k == DENIM || k >= CLOTHS) return others[k];
    const int place = k - LINEN, row = place / 3, column = place % 3;
    return (Lattice){.across = 1,
                     .down = 64,
                     .point = swatch_point,
                     .smooth = true,
                     .at = {0.235f * (float)(column - 1), 0.001f, 0.19f + 0.2f * (float)row},
                     .span = {swatch_width / unit, 2.0f * swatch_bend * swatch_radius / unit}};
}

static Material plain_material(float r, float g, float b, float roughness) {
    Material m = material_default();
    material_set_color(&m, INPUT_base_color, r, g, b);
    m.inputs[INPUT_roughness].value[0] = roughness;
    m.double_sided = true;
    return m;
}

static void materials_make(Material *m) {
    for (int k = 0; k < CLOTHS; k++) m[k] = plain_material(0.5f, 0.5f, 0.5f, 1.0f);
    for (int k = BAR; k <= RIGHT_POST; k++) m[k] = plain_material(0.24f, 0.15f, 0.09f, 0.4f);
    m[SWEEP] = plain_material(0.34f, 0.335f, 0.33f, 1.0f);
    m[SOFTBOX] = plain_material(0.0f, 0.0f, 0.0f, 1.0f);
    m[SOFTBOX].double_sided = false;
    material_set_color(&m[SOFTBOX], INPUT_emission, 1.0f, 0.95f, 0.88f);
    m[SOFTBOX].inputs[INPUT_emission_strength].value[0] = 34.0f;
}

/* Returns a camera whose picture of 4 by 3 is `threads` threads of the denim wide, which has 2,600 a metre. */
static Camera camera_over(const char *name, float threads, float distance) {
    const Vec3 target = {0.012f, 0.3f, 0.03f};
    const float height = 0.75f * threads / 2600.0f;
    return camera_towards(name, (Vec3){target.x, target.y + 0.15f * distance, target.z + distance}, target,
                          2.0f * atanf(0.5f * height / distance));
}

static void cameras_make(Camera *c) {
    c[0] = camera_towards("main", (Vec3){0.0f, 1.0f, 1.3f}, (Vec3){0.0f, 0.2f, 0.2f}, 0.54f);
    c[1] = camera_over("far", 5000.0f, 3.5f);
    c[2] = camera_over("near", 500.0f, 0.6f);
    c[3] = camera_over("close", 50.0f, 0.25f);
    c[4] = camera_over("threads", 5.0f, 0.25f);
}

/* Gives the cloths their presets. */
static WeftResult weave_all(WeftScene *scene, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = 0; k < CLOTHS && result == WEFT_OK; k++) {
        char preset[64];
        snprintf(preset, sizeof preset, "preset:woven-%s", names[k]);
        result = weft_scene_assign_material(scene, names[k], preset, NULL, error);
    }
    return result;
}

WeftResult loom_make(WeftScene *scene, WeftError *error) {
    enum { CAMERAS = 5 };
    Arena *arena = &scene->arena;
    scene->meshes = arena_array(arena, THINGS, sizeof(Mesh));
    scene->materials = arena_array(arena, THINGS, sizeof(Material));
    scene->material_names = arena_array(arena, THINGS, sizeof(char *));
    scene->cameras = arena_array(arena, CAMERAS, sizeof(Camera));
    bool made = scene->meshes && scene->materials && scene->material_names && scene->cameras;
    for (int k = 0; made && k < THINGS; k++) {
        const Lattice lattice = lattice_of(k);
        char *kept = arena_text(arena, names[k]);
        scene->meshes[k] = (Mesh){.name = kept, .material = k};
        scene->material_names[k] = kept;
        made = kept && lattice_make(arena, &scene->meshes[k], &lattice);
    }
    if (!made) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    materials_make(scene->materials);
    scene->mesh_count = scene->material_count = THINGS;
    cameras_make(scene->cameras);
    scene->camera_count = CAMERAS;
    return weave_all(scene, error);
}
