#include "scene/builtin/swatch_scene.h"

#include <math.h>

#include "base/fail.h"
#include "base/pi.h"
#include "scene/builtin/lattice.h"
#include "scene/record/camera.h"

/* The section across the folds: crests and troughs, which are arcs, m and radians. The first crest sets out by
 * `steepness`, the next trough takes over where it falls as steeply. */
static const float crest = 0.0075f, trough = 0.0055f, steepness = 1.2f;
static const float height = 0.09f, lean = 0.42f; /* of the folds, and how far they lean from upright */
enum { ARCS = 13, AROUND = 48 };

static float arc_length(int k) { return 2.0f * steepness * (k % 2 ? trough : crest); }

static float section_length(void) {
    float length = 0.0f;
    for (int k = 0; k < ARCS; k++) length += arc_length(k);
    return length;
}

/* Returns the point of the section at that length: across in x, towards the viewer in z. */
static Vec3 section_at(float length) {
    Vec3 p = {0.0f, 0.0f, 0.0f};
    for (int k = 0; k < ARCS; k++) {
        const float heading = k % 2 ? -steepness : steepness, curvature = k % 2 ? 1.0f / trough : -1.0f / crest;
        const float angle = heading + curvature * fmaxf(fminf(length, arc_length(k)), 0.0f);
        p.x += (sinf(angle) - sinf(heading)) / curvature;
        p.z += (cosf(heading) - cosf(angle)) / curvature;
        length -= arc_length(k);
    }
    return p;
}

static Vec3 swatch_point(float u, float v) {
    const Vec3 p = section_at(u * section_length());
    const float x = p.x - 0.5f * section_at(section_length()).x, y = height * (0.5f - v);
    return (Vec3){x * cosf(lean) + y * sinf(lean), y * cosf(lean) - x * sinf(lean), p.z};
}

/* Returns a point of the sheet on which the cloth lies. */
static Vec3 sheet_point(float u, float v) { return (Vec3){0.24f * (u - 0.5f), 0.24f * (0.5f - v), -0.012f}; }

/* Returns a dull grey; the cloth has a sheen, by which it is the scene's cloth. */
static Material dull(float sheen) {
    Material m = material_default();
    material_set_color(&m, INPUT_base_color, 0.5f, 0.5f, 0.5f);
    material_set_color(&m, INPUT_sheen_color, sheen, sheen, sheen);
    m.inputs[INPUT_roughness].value[0] = 1.0f;
    m.double_sided = true;
    return m;
}

WeftResult swatch_make(WeftScene *scene, WeftError *error) {
    enum { CLOTH, SHEET, THINGS };
    static const char *const names[THINGS] = {"cloth", "sheet"};
    const Lattice lattices[THINGS] = {[CLOTH] = {.across = ARCS * AROUND,
                                                 .down = 1,
                                                 .point = swatch_point,
                                                 .smooth = true,
                                                 .span = {section_length(), height}},
                                      [SHEET] = {.across = 1, .down = 1, .point = sheet_point}};
    Arena *arena = &scene->arena;
    scene->meshes = arena_array(arena, THINGS, sizeof(Mesh));
    scene->materials = arena_array(arena, THINGS, sizeof(Material));
    scene->material_names = arena_array(arena, THINGS, sizeof(char *));
    scene->cameras = arena_array(arena, 1, sizeof(Camera));
    bool made = scene->meshes && scene->materials && scene->material_names && scene->cameras;
    for (int k = 0; made && k < THINGS; k++) {
        scene->meshes[k] = (Mesh){.name = names[k], .material = k};
        scene->material_names[k] = names[k];
        scene->materials[k] = dull(k == CLOTH ? 0.04f : 0.0f);
        made = lattice_make(arena, &scene->meshes[k], &lattices[k]);
    }
    if (!made) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    const Vec3 target = {0.0f, 0.0f, 0.002f}, toward = {0.06f, 0.09f, 0.25f};
    scene->cameras[0] =
        camera_towards("main", vec3_add(target, toward), target, 2.0f * atanf(0.017f / vec3_length(toward)));
    scene->mesh_count = scene->material_count = THINGS;
    scene->camera_count = 1;
    scene_bounds(scene);
    return WEFT_OK;
}
