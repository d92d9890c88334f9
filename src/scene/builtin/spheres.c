#include "scene/builtin/spheres.h"

#include <math.h>
#include <stdio.h>

#include "base/fail.h"
#include "base/pi.h"

enum { COLUMNS = 5, ROWS = 2, RINGS = 64, SECTORS = 128 };
static const float radius = 0.45f, spacing = 1.06f;

/* Makes a latitude-longitude sphere whose texture wraps once; tangents run along the parallels. */
static bool sphere(Arena *arena, Mesh *mesh, Vec3 centre) {
    uint32_t across = SECTORS + 1;
    mesh->vertex_count = (RINGS + 1) * across;
    mesh->triangle_count = 2 * SECTORS * (RINGS - 1);
    mesh->position = arena_array(arena, mesh->vertex_count, 3 * sizeof(float));
    mesh->normal = arena_array(arena, mesh->vertex_count, 3 * sizeof(float));
    mesh->tangent = arena_array(arena, mesh->vertex_count, 4 * sizeof(float));
    mesh->texcoord[0] = arena_array(arena, mesh->vertex_count, 2 * sizeof(float));
    mesh->index = arena_array(arena, mesh->triangle_count, 3 * sizeof(uint32_t));
    if (!mesh->position || !mesh->normal || !mesh->tangent || !mesh->texcoord[0] || !mesh->index) return false;
    for (uint32_t k = 0; k < mesh->vertex_count; k++) {
        uint32_t ring = k / across, sector = k % across;
        float v = (float)ring / RINGS, u = (float)sector / SECTORS;
        float theta = v * PI_FLOAT, phi = u * 2.0f * PI_FLOAT;
        float n[3] = {sinf(theta) * sinf(phi), cosf(theta), sinf(theta) * cosf(phi)};
        float *p = mesh->position + 3 * k, *t = mesh->tangent + 4 * k;
        p[0] = centre.x + radius * n[0], p[1] = centre.y + radius * n[1], p[2] = centre.z + radius * n[2];
        for (int c = 0; c < 3; c++) mesh->normal[3 * k + (uint32_t)c] = n[c];
        t[0] = cosf(phi), t[1] = 0.0f, t[2] = -sinf(phi), t[3] = 1.0f;
        mesh->texcoord[0][2 * k] = u, mesh->texcoord[0][2 * k + 1] = v;
    }
    uint32_t *index = mesh->index;
    for (uint32_t ring = 0; ring < RINGS; ring++)
        for (uint32_t sector = 0; sector < SECTORS; sector++) {
            uint32_t a = ring * across + sector, b = a + across;
            if (ring > 0) *index++ = a, *index++ = b, *index++ = a + 1;
            if (ring + 1 < RINGS) *index++ = a + 1, *index++ = b, *index++ = b + 1;
        }
    return true;
}

static bool floor_quad(Arena *arena, Mesh *mesh, float half) {
    static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};
    mesh->vertex_count = 4;
    mesh->triangle_count = 2;
    mesh->position = arena_array(arena, 4, 3 * sizeof(float));
    mesh->index = arena_array(arena, 2, 3 * sizeof(uint32_t));
    if (!mesh->position || !mesh->index) return false;
    for (uint32_t k = 0; k < 4; k++) {
        mesh->position[3 * k] = k == 1 || k == 2 ? half : -half;
        mesh->position[3 * k + 2] = k < 2 ? half : -half;
    }
    for (int k = 0; k < 6; k++) mesh->index[k] = order[k];
    return true;
}

static Material sphere_material(bool light, float sheen_roughness) {
    Material material = material_default();
    material_set_color(&material, INPUT_base_color, light ? 0.55f : 0.02f, light ? 0.10f : 0.03f,
                       light ? 0.09f : 0.08f);
    material_set_color(&material, INPUT_sheen_color, light ? 0.9f : 0.35f, light ? 0.75f : 0.55f, light ? 0.7f : 0.9f);
    material.inputs[INPUT_sheen_roughness].value[0] = sheen_roughness;
    material.inputs[INPUT_roughness].value[0] = 0.9f;
    return material;
}

static Camera camera_of(float height, float distance, float pitch, float yfov) {
    return (Camera){.name = "main",
                    .eye = {0.0f, height, distance},
                    .right = {1.0f, 0.0f, 0.0f},
                    .up = {0.0f, cosf(pitch), sinf(pitch)},
                    .forward = {0.0f, sinf(pitch), -cosf(pitch)},
                    .yfov = yfov};
}

/* Balls, each with its own material, a floor, and one camera. */
typedef struct Arrangement {
    int count;
    Vec3 (*centre)(int k);
    Material (*material)(int k);
    const char *(*name)(int k, char text[16]);
    Camera camera;
} Arrangement;

static WeftResult arrange(WeftScene *scene, const Arrangement *balls, WeftError *error) {
    Arena *arena = &scene->arena;
    int count = balls->count;
    scene->meshes = arena_array(arena, (size_t)count + 1, sizeof(Mesh));
    scene->materials = arena_array(arena, (size_t)count + 1, sizeof(Material));
    scene->material_names = arena_array(arena, (size_t)count + 1, sizeof(char *));
    scene->cameras = arena_array(arena, 1, sizeof(Camera));
    bool made = scene->meshes && scene->materials && scene->material_names && scene->cameras;
    for (int k = 0; made && k < count; k++) {
        char text[16], *kept = arena_text(arena, balls->name(k, text));
        scene->meshes[k] = (Mesh){.name = kept, .material = k};
        made = kept && sphere(arena, &scene->meshes[k], balls->centre(k));
        if (made) scene->materials[k] = balls->material(k);
        if (made) scene->material_names[k] = kept;
    }
    if (made) {
        scene->meshes[count] = (Mesh){.name = "floor", .material = count};
        made = floor_quad(arena, &scene->meshes[count], 40.0f);
        scene->materials[count] = material_default();
        scene->material_names[count] = "floor";
        material_set_color(&scene->materials[count], INPUT_base_color, 0.42f, 0.41f, 0.40f);
        scene->materials[count].inputs[INPUT_roughness].value[0] = 1.0f;
        scene->mesh_count = scene->material_count = count + 1;
    }
    if (!made) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    scene->cameras[0] = balls->camera;
    scene->camera_count = 1;
    scene_bounds(scene);
    return WEFT_OK;
}

static const char *sphere_name(int k, char text[16]) {
    snprintf(text, 16, "%s-%d", k / COLUMNS ? "light" : "dark", k % COLUMNS);
    return text;
}

static Vec3 sphere_centre(int k) {
    float row = k / COLUMNS ? -0.7f : 0.7f;
    return (Vec3){((float)(k % COLUMNS) - 2.0f) * spacing, radius, row * spacing};
}

static Material sphere_of(int k) { return sphere_material(k / COLUMNS == 1, 0.1f + 0.225f * (float)(k % COLUMNS)); }

WeftResult spheres_make(WeftScene *scene, WeftError *error) {
    const Arrangement spheres = {COLUMNS * ROWS, sphere_centre, sphere_of, sphere_name,
                                 camera_of(6.2f, 10.8f, -0.50f, 0.345f)}; /* looks down on both rows */
    return arrange(scene, &spheres, error);
}

static const char *ball_name(int k, char text[16]) {
    (void)k;
    snprintf(text, 16, "ball");
    return text;
}

static Vec3 ball_centre(int k) {
    (void)k;
    return (Vec3){0.0f, radius, 0.0f};
}

static Material ball_of(int k) {
    (void)k;
    return sphere_material(true, 0.5f);
}

WeftResult ball_make(WeftScene *scene, WeftError *error) {
    const Arrangement ball = {1, ball_centre, ball_of, ball_name, camera_of(1.6f, 3.1f, -0.365f, 0.32f)};
    return arrange(scene, &ball, error);
}
