/* scenes.h - small scenes made in memory for the tests of trace/ */
#ifndef WEFT_TEST_TRACE_SCENES_H
#define WEFT_TEST_TRACE_SCENES_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/pi.h"
#include "scene/record/scene.h"
#include "weft/weft.h"

enum { TEST_MESHES = 16 };

static inline WeftScene *test_scene(void) {
    WeftScene *scene = scene_create("test");
    scene->meshes = arena_array(&scene->arena, TEST_MESHES, sizeof(Mesh));
    scene->materials = arena_array(&scene->arena, TEST_MESHES, sizeof(Material));
    scene->material_names = arena_array(&scene->arena, TEST_MESHES, sizeof(char *));
    scene->lights = arena_array(&scene->arena, TEST_MESHES, sizeof(Light));
    return scene;
}

static inline void test_environment(WeftScene *scene, float radiance) {
    weft_scene_set_environment_color(scene, (float[3]){radiance, radiance, radiance}, NULL);
}

static inline void test_color(Material *material, InputId input, float value) {
    for (int c = 0; c < 3; c++) material->inputs[input].value[c] = value;
}

/* A purely diffuse material: no specular layer. */
static inline Material *test_material(WeftScene *scene, float base_color) {
    int k = scene->material_count++;
    Material *material = &scene->materials[k];
    *material = material_default();
    scene->material_names[k] = "matt";
    material->double_sided = true;
    test_color(material, INPUT_base_color, base_color);
    test_color(material, INPUT_specular, 0.0f);
    return material;
}

/* A white, smooth dielectric of an index of 1.5 that lets all light through; solid of a thickness above 0. */
static inline Material *test_glass(WeftScene *scene, float roughness, float thickness) {
    Material *m = test_material(scene, 1.0f);
    m->inputs[INPUT_specular].value[0] = 1.0f;
    m->inputs[INPUT_ior].value[0] = 1.5f;
    m->inputs[INPUT_roughness].value[0] = roughness;
    m->inputs[INPUT_transmission].value[0] = 1.0f;
    m->inputs[INPUT_thickness].value[0] = thickness;
    return m;
}

/* White light from afar along a direction. */
static inline void test_sun(WeftScene *scene, Vec3 direction, float intensity) {
    scene->lights[scene->light_count++] = (Light){
        .name = "sun", .kind = LIGHT_DIRECTIONAL, .direction = direction, .color = {1, 1, 1}, .intensity = intensity};
}

static inline Mesh *test_mesh(WeftScene *scene, uint32_t vertices, uint32_t triangles) {
    Mesh *mesh = &scene->meshes[scene->mesh_count++];
    *mesh = (Mesh){.name = "mesh", .vertex_count = vertices, .triangle_count = triangles};
    mesh->material = scene->material_count - 1;
    mesh->position = arena_array(&scene->arena, vertices, 3 * sizeof(float));
    mesh->index = arena_array(&scene->arena, triangles, 3 * sizeof(uint32_t));
    return mesh;
}

/* A parallelogram a, a + u, a + u + v, a + v of the last material; its front is towards cross(u, v). */
static inline Mesh *test_quad(WeftScene *scene, Vec3 a, Vec3 u, Vec3 v) {
    static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};
    Mesh *mesh = test_mesh(scene, 4, 2);
    Vec3 p[4] = {a, vec3_add(a, u), vec3_add(vec3_add(a, u), v), vec3_add(a, v)};
    memcpy(mesh->position, p, sizeof p);
    memcpy(mesh->index, order, sizeof order);
    return mesh;
}

/* Works as test_quad, with texture coordinates: u along u, and v, which runs down, against v. */
static inline Mesh *test_sheet(WeftScene *scene, Vec3 a, Vec3 u, Vec3 v) {
    static const float uv[8] = {0.0f, 1.0f, 1.0f, 1.0f, 1.0f, 0.0f, 0.0f, 0.0f};
    Mesh *mesh = test_quad(scene, a, u, v);
    mesh->texcoord[0] = arena_array(&scene->arena, 4, 2 * sizeof(float));
    memcpy(mesh->texcoord[0], uv, sizeof uv);
    return mesh;
}

/* A sphere of the last material, of rings from pole to pole, with smooth normals. */
static inline Mesh *test_ball(WeftScene *scene, Vec3 centre, float radius, uint32_t rings) {
    const uint32_t sectors = 2 * rings, across = sectors + 1;
    Mesh *mesh = test_mesh(scene, (rings + 1) * across, 2 * sectors * (rings - 1));
    mesh->normal = arena_array(&scene->arena, mesh->vertex_count, 3 * sizeof(float));
    for (uint32_t k = 0; k < mesh->vertex_count; k++) {
        uint32_t ring = k / across, sector = k % across;
        float theta = (float)ring * PI_FLOAT / (float)rings, phi = (float)sector * 6.28318531f / (float)sectors;
        Vec3 n = {sinf(theta) * sinf(phi), cosf(theta), sinf(theta) * cosf(phi)};
        Vec3 p = vec3_madd(centre, n, radius);
        memcpy(mesh->normal + 3 * k, &n, sizeof n);
        memcpy(mesh->position + 3 * k, &p, sizeof p);
    }
    uint32_t *index = mesh->index;
    for (uint32_t ring = 0; ring < rings; ring++)
        for (uint32_t sector = 0; sector < sectors; sector++) {
            uint32_t a = ring * across + sector, b = a + across;
            if (ring > 0) *index++ = a, *index++ = b, *index++ = a + 1;
            if (ring + 1 < rings) *index++ = a + 1, *index++ = b, *index++ = b + 1;
        }
    return mesh;
}

/* A finely tessellated one. */
static inline Mesh *test_sphere(WeftScene *scene, Vec3 centre, float radius) {
    return test_ball(scene, centre, radius, 96);
}

/* A matt ball of so many rings under a sun from the side, in light that is as bright all around. */
static inline WeftScene *test_grazed_ball(uint32_t rings, float base_color, float radiance) {
    WeftScene *scene = test_scene();
    test_environment(scene, radiance);
    test_material(scene, base_color);
    test_ball(scene, vec3(0, 0, 0), 1.0f, rings);
    test_sun(scene, vec3(0.995f, -0.1f, 0), PI_FLOAT);
    scene_bounds(scene);
    return scene;
}

/* Renders and checks that nothing went wrong; release with weft_image_free. */
static inline WeftImage test_render(const WeftScene *scene, WeftRenderDesc desc, int spp) {
    WeftRender *r = NULL;
    WeftImage image;
    WeftError error;
    if (weft_render_create(scene, &desc, &r, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_render_run(r, spp, 0.0, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_render_info(r).non_finite, 0);
    assert_int_equal(weft_render_image(r, &image, &error), WEFT_OK);
    weft_render_free(r);
    return image;
}

/* Six quads facing inward around [-half, half]^3. */
static inline void test_box(WeftScene *scene, float h) {
    test_quad(scene, vec3(-h, -h, h), vec3(2 * h, 0, 0), vec3(0, 0, -2 * h)); /* floor, up */
    test_quad(scene, vec3(-h, h, -h), vec3(2 * h, 0, 0), vec3(0, 0, 2 * h));  /* ceiling, down */
    test_quad(scene, vec3(-h, -h, -h), vec3(2 * h, 0, 0), vec3(0, 2 * h, 0)); /* back, +z */
    test_quad(scene, vec3(-h, -h, h), vec3(0, 2 * h, 0), vec3(2 * h, 0, 0));  /* front, -z */
    test_quad(scene, vec3(-h, -h, h), vec3(0, 0, -2 * h), vec3(0, 2 * h, 0)); /* left, +x */
    test_quad(scene, vec3(h, -h, -h), vec3(0, 0, 2 * h), vec3(0, 2 * h, 0));  /* right, -x */
}

#endif
