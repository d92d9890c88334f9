/* What a ray meets: sides, transparency, offsets, interpolation. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/pi.h"
#include "base/random.h"
#include "scene/record/material_at.h"
#include "scenes.h"
#include "trace/geometry/geometry.h"
#include "trace/path/chunk.h"
#include "weft/weft.h"

static Geometry *build(WeftScene *scene) {
    Geometry *geometry = NULL;
    scene_bounds(scene);
    assert_int_equal(geometry_create(scene, scene->mesh_count, 2, &geometry, NULL), WEFT_OK);
    return geometry;
}

static Ray down(float x, float z) { return (Ray){{x, 5.0f, z}, {0.0f, -1.0f, 0.0f}, 0.0f, INFINITY, 1, false}; }

/* Three floors: a single-sided one facing down at y = 2, one facing up at 1, and a two-sided one at 0. */
static WeftScene *floors(void) {
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f)->double_sided = false;
    test_quad(scene, vec3(-1, 2, -1), vec3(2, 0, 0), vec3(0, 0, 2));
    test_quad(scene, vec3(-1, 1, 1), vec3(2, 0, 0), vec3(0, 0, -2));
    test_material(scene, 0.5f);
    test_quad(scene, vec3(-1, 0, -1), vec3(2, 0, 0), vec3(0, 0, 2));
    return scene;
}

static void single_sided_surface_has_no_back(void **state) {
    (void)state;
    WeftScene *scene = floors();
    Geometry *geometry = build(scene);
    Hit hit;
    assert_true(geometry_hit(geometry, down(0.1f, 0.2f), &hit));
    assert_int_equal(hit.mesh, 1);
    assert_true(fabsf(hit.t - 4.0f) < 1e-5f);
    Ray up = {{0.1f, -5.0f, 0.2f}, {0.0f, 1.0f, 0.0f}, 0.0f, INFINITY, 1, false};
    assert_true(geometry_hit(geometry, up, &hit));
    assert_int_equal(hit.mesh, 2); /* the two-sided one, from behind */
    up.origin.y = 0.5f;
    assert_true(geometry_hit(geometry, up, &hit));
    assert_int_equal(hit.mesh, 0);
    Ray part = down(0.1f, 0.2f);
    part.far = 3.5f;
    assert_false(geometry_occluded(geometry, part));
    part.far = 4.5f;
    assert_true(geometry_occluded(geometry, part));
    geometry_free(geometry);
    weft_scene_free(scene);
}

/* A packet of rays that begin at 0; t < 0 where nothing is hit. */
static void hit_packet(const Geometry *geometry, int count, const Ray *rays, Hit *hits) {
    float o[3][GEOMETRY_PACKET] = {{0}}, d[3][GEOMETRY_PACKET] = {{0}}, far[GEOMETRY_PACKET] = {0};
    float t[GEOMETRY_PACKET], u[GEOMETRY_PACKET], v[GEOMETRY_PACKET];
    uint32_t key[GEOMETRY_PACKET] = {0}, mesh[GEOMETRY_PACKET], triangle[GEOMETRY_PACKET];
    for (int k = 0; k < count; k++) {
        o[0][k] = rays[k].origin.x, o[1][k] = rays[k].origin.y, o[2][k] = rays[k].origin.z;
        d[0][k] = rays[k].direction.x, d[1][k] = rays[k].direction.y, d[2][k] = rays[k].direction.z;
        far[k] = rays[k].far, key[k] = rays[k].key;
    }
    bool hidden[GEOMETRY_PACKET];
    const RayRows rows = {{o[0], o[1], o[2]}, {d[0], d[1], d[2]}, far, key, false, false};
    geometry_hits(geometry, &rows, count, &(HitRows){t, u, v, mesh, triangle});
    geometry_occlusions(geometry, &rows, count, hidden, NULL);
    for (int k = 0; k < count; k++) {
        bool any = mesh[k] != GEOMETRY_NOTHING;
        hits[k] = (Hit){.t = any ? t[k] : -1.0f, .mesh = mesh[k], .triangle = triangle[k], .u = u[k], .v = v[k]};
        assert_int_equal(hidden[k], geometry_occluded(geometry, rays[k]));
    }
}

/* Embree asserts that rays are numbers within 1.8e18. */
static void rays_out_of_reach_hit_nothing(void **state) {
    (void)state;
    WeftScene *scene = floors();
    Geometry *geometry = build(scene);
    const float wrong[] = {1.9e18f, -1e30f, (float)INFINITY, (float)NAN};
    Ray rays[GEOMETRY_PACKET];
    Hit hits[GEOMETRY_PACKET];
    for (int k = 0; k < GEOMETRY_PACKET; k++) {
        rays[k] = down(0.1f, 0.2f);
        float *numbers[] = {&rays[k].origin.y, &rays[k].origin.x, &rays[k].direction.y, &rays[k].far};
        if (k % 2 && (k / 2 < 6 || k / 2 == 7)) *numbers[k / 2 % 4] = wrong[k / 2 < 4 ? k / 2 : 3];
    }
    hit_packet(geometry, GEOMETRY_PACKET, rays, hits);
    for (int k = 0; k < GEOMETRY_PACKET; k++) {
        bool sound = fabsf(rays[k].origin.x) < 1e18f && fabsf(rays[k].origin.y) < 1e18f &&
                     fabsf(rays[k].direction.y) < 1e18f && rays[k].far > 0.0f;
        Hit hit;
        assert_int_equal(hits[k].t >= 0.0f, sound);
        assert_int_equal(geometry_hit(geometry, rays[k], &hit), sound);
        assert_true(geometry_occluded(geometry, rays[k]));
    }
    geometry_free(geometry);
    weft_scene_free(scene);
}

static void packets_of_rays_agree_with_single_rays(void **state) {
    (void)state;
    WeftScene *scene = floors();
    test_sphere(scene, vec3(0.3f, 3, 0.1f), 0.5f);
    Geometry *geometry = build(scene);
    for (int count = 1; count <= GEOMETRY_PACKET; count++) {
        Ray rays[GEOMETRY_PACKET];
        Hit hits[GEOMETRY_PACKET], one;
        for (int k = 0; k < count; k++) rays[k] = down(-1.2f + 0.15f * (float)k, 0.03f * (float)k);
        hit_packet(geometry, count, rays, hits);
        for (int k = 0; k < count; k++) {
            bool found = geometry_hit(geometry, rays[k], &one);
            assert_int_equal(found, hits[k].t >= 0.0f);
            if (!found) continue;
            assert_int_equal(one.mesh, hits[k].mesh);
            assert_true(fabsf(one.t - hits[k].t) < 1e-5f);
        }
    }
    geometry_free(geometry);
    weft_scene_free(scene);
}

/* Two sheets back to back, each seen from its own side only: no ray falls between them. */
static void sheets_back_to_back_have_no_holes(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f)->double_sided = false;
    test_quad(scene, vec3(-1, 0, 1), vec3(2, 0, 0), vec3(0, 0, -2)); /* faces up */
    test_quad(scene, vec3(-1, 0, -1), vec3(0, 0, 2), vec3(2, 0, 0)); /* the same corners, faces up too: flip it */
    Mesh *under = &scene->meshes[1];
    memcpy(under->position, scene->meshes[0].position, 12 * sizeof(float));
    static const uint32_t reversed[6] = {0, 2, 1, 0, 3, 2};
    memcpy(under->index, reversed, sizeof reversed);
    Geometry *geometry = build(scene);
    for (uint32_t k = 0; k < 2000; k++) {
        float x = 1.8f * unit_float(hash32(2 * k)) - 0.9f, z = 1.8f * unit_float(hash32(2 * k + 1)) - 0.9f;
        Ray rays[2] = {down(x, z), {{x, -5.0f, z}, {0.0f, 1.0f, 0.0f}, 0.0f, INFINITY, k, false}};
        Hit hits[2];
        hit_packet(geometry, 2, rays, hits);
        for (uint32_t side = 0; side < 2; side++) {
            assert_true(hits[side].t > 0.0f);
            assert_int_equal(hits[side].mesh, side);
            assert_true(geometry_occluded(geometry, rays[side]));
        }
    }
    geometry_free(geometry);
    weft_scene_free(scene);
}

/* Coverage is a coin per ray and triangle: its mean is the opacity, and occlusion sees the same surface. */
static void stochastic_transparency_has_its_probability(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    Material *veil = test_material(scene, 0.5f);
    veil->alpha_mode = WEFT_ALPHA_BLEND;
    veil->inputs[INPUT_opacity].value[0] = 0.3f;
    test_quad(scene, vec3(-1, 0, -1), vec3(2, 0, 0), vec3(0, 0, 2));
    Geometry *geometry = build(scene);
    enum { N = 20000 };
    int hits = 0, blocked = 0;
    for (uint32_t k = 0; k < N; k++) {
        Ray ray = down(0.3f, 0.1f);
        ray.key = hash32(k);
        Hit hit;
        bool there = geometry_hit(geometry, ray, &hit);
        hits += there;
        blocked += geometry_occluded(geometry, ray) == there;
    }
    double off = hits - 0.3 * N;
    assert_true(off * off < 16.0 * 0.3 * 0.7 * N); /* 4 standard deviations */
    assert_int_equal(blocked, N);
    veil->alpha_mode = WEFT_ALPHA_MASK;
    Hit hit;
    assert_false(geometry_hit(geometry, down(0.3f, 0.1f), &hit));
    veil->alpha_cutoff = 0.25f;
    assert_true(geometry_hit(geometry, down(0.3f, 0.1f), &hit));
    geometry_free(geometry);
    weft_scene_free(scene);
}

/* Returns the light of a matt sheet behind a black veil of some opacity, through which eye and sun see it aslant. */
static double seen_through(float opacity) {
    WeftScene *scene = test_scene();
    test_environment(scene, 0.0f);
    test_material(scene, 0.8f);
    test_quad(scene, vec3(-2, 0, 2), vec3(4, 0, 0), vec3(0, 0, -4));
    Material *veil = test_material(scene, 0.0f);
    veil->alpha_mode = WEFT_ALPHA_BLEND;
    veil->inputs[INPUT_opacity].value[0] = opacity;
    test_quad(scene, vec3(-2, 0.5f, 2), vec3(4, 0, 0), vec3(0, 0, -4));
    scene_bounds(scene);
    const WeftLight sun = {.direction = {-0.3f, -1.0f, 0.0f}, .color = {3.0f, 3.0f, 3.0f}};
    assert_int_equal(weft_scene_add_light(scene, &sun, NULL), WEFT_OK);
    const WeftRenderDesc desc = {.width = 16, .height = 16, .camera = "0,4,0.001;0,0,0;5", .max_depth = 1};
    WeftImage image = test_render(scene, desc, 256);
    double sum = 0.0;
    for (int k = 0; k < 16 * 16; k++) sum += (double)((const float *)image.pixels)[4 * k];
    weft_image_free(&image);
    weft_scene_free(scene);
    return sum;
}

/* Whether a veil is in the way of the eye says nothing of whether it is in the way of the light: .6 of it passes each
 * time, and not .6 in all. */
static void veil_hides_eye_and_light_independently(void **state) {
    (void)state;
    const double share = seen_through(0.4f) / seen_through(0.0f);
    print_message("light of a sheet through a veil that .6 of all rays pass: %.3f\n", share);
    assert_true(fabs(share - 0.36) < 0.01);
}

/* Many coincident sheets: the walk past refused hits ends. */
static void walk_through_coincident_sheets_ends(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    Material *glass = test_material(scene, 0.5f);
    glass->alpha_mode = WEFT_ALPHA_MASK;
    glass->inputs[INPUT_opacity].value[0] = 0.0f;
    for (int k = 0; k < 12; k++) test_quad(scene, vec3(-1, 0, -1), vec3(2, 0, 0), vec3(0, 0, 2));
    Geometry *geometry = build(scene);
    Hit hit;
    assert_false(geometry_hit(geometry, down(0.1f, 0.3f), &hit));
    Ray near = down(0.1f, 0.3f);
    near.origin.y = 0.0f; /* starts on them, at distance 0 */
    assert_false(geometry_hit(geometry, near, &hit));
    geometry_free(geometry);
    weft_scene_free(scene);
}

/* Places a vertex on the scene's first mesh, seen from wo; where: its position, then the lifted point. */
static void place(const WeftScene *scene, uint32_t triangle, float u, Vec3 wo, Vec3 where[2]) {
    static Paths paths;
    static Chunk chunk;
    static const PathKeys keys;
    const PathMaterial material = {.material = scene->materials[0], .untextured = material_plain(&scene->materials[0])};
    const PathContext context = {.scene = scene, .materials = &material, .lift = true};
    const float t = 1.0f;
    const uint32_t mesh = 0;
    const int order[ROW_LANES] = {0};
    paths.direction[0][0] = -wo.x, paths.direction[1][0] = -wo.y, paths.direction[2][0] = -wo.z;
    chunk.filled_material = 0;
    chunk_place(&chunk, &(ChunkSource){.context = &context,
                                       .paths = &paths,
                                       .t = &t,
                                       .u = &u,
                                       .v = &u,
                                       .mesh = &mesh,
                                       .triangle = &triangle,
                                       .keys = &keys,
                                       .order = order,
                                       .n = 1});
    where[0] = vec3(chunk.position[0][0], chunk.position[1][0], chunk.position[2][0]);
    where[1] = vec3(chunk.lifted[0][0], chunk.lifted[1][0], chunk.lifted[2][0]);
}

static void lifted_points_lie_on_the_smooth_surface(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f);
    Mesh *mesh = test_sphere(scene, vec3(0, 0, 0), 1.0f);
    double flat = 0.0, lifted = 0.0;
    for (uint32_t k = 0; k < mesh->triangle_count; k += 7) {
        Vec3 front[2], back[2], out = vec3_load(mesh->position + 3 * (size_t)mesh->index[3 * (size_t)k]);
        place(scene, k, 0.33f, out, front);
        Vec3 p = front[1];
        flat = fmax(flat, fabs(1.0 - (double)vec3_length(front[0])));
        assert_true(vec3_length(p) > 1.0f - 1e-6f); /* tangent planes lie outside a ball */
        lifted = fmax(lifted, (double)vec3_length(p) - 1.0);
        place(scene, k, 0.33f, vec3_scale(out, -1.0f), back); /* seen from within nothing bulges */
        assert_true(vec3_length(vec3_sub(back[1], back[0])) < 1e-6f);
    }
    assert_true(flat > 1e-4 && lifted < 1.1 * flat);
    weft_scene_free(scene);
}

/* A convex ball does not shadow itself: every point facing the light is lit, at three scales of the world. */
static void smooth_ball_does_not_shadow_itself(void **state) {
    (void)state;
    static const float scales[] = {0.01f, 1.0f, 1000.0f};
    for (int k = 0; k < 3; k++) {
        WeftScene *scene = test_scene();
        test_environment(scene, 0.0f);
        test_material(scene, 1.0f);
        test_sphere(scene, vec3(0, 0, 0), scales[k]);
        test_sun(scene, vec3(0, 0, -1), PI_FLOAT);
        scene_bounds(scene);
        char camera[64];
        snprintf(camera, sizeof camera, "0,0,%g;0,0,0;12", (double)(10.0f * scales[k]));
        WeftRender *r;
        WeftImage image;
        assert_int_equal(
            weft_render_create(
                scene,
                &(WeftRenderDesc){.width = 64, .height = 64, .camera = camera, .max_depth = 1, .pixel_centre = 1}, &r,
                NULL),
            WEFT_OK);
        assert_int_equal(weft_render_run(r, 1, 0.0, NULL, NULL), WEFT_OK);
        assert_int_equal(weft_render_image(r, &image, NULL), WEFT_OK);
        int checked = 0;
        double half = 10.0 * tan(6.0 * RADIANS);
        for (int y = 0; y < 64; y++)
            for (int x = 0; x < 64; x++) {
                /* the ray (0, 0, 10) + t (px, py, -10) meets the unit ball where t solves a quadratic */
                double px = ((x + 0.5) / 32.0 - 1.0) * half, py = ((y + 0.5) / 32.0 - 1.0) * half;
                double a = px * px + py * py + 100.0, root = 100.0 * 100.0 - a * 99.0;
                if (root <= 0.0) continue;
                double z = 10.0 - 10.0 * (100.0 - (sqrt)(root)) / a;
                if (z < 0.3) continue;
                float lit = ((float *)image.pixels)[4 * (64 * y + x)];
                assert_true(fabs((double)lit - z) < 0.01); /* lambert under a sun of irradiance pi: the cosine */
                checked++;
            }
        assert_true(checked > 1500);
        weft_image_free(&image);
        weft_render_free(r);
        weft_scene_free(scene);
    }
}

static WeftImage grazed_ball(uint32_t rings, int no_lift) {
    WeftScene *scene = test_grazed_ball(rings, 1.0f, 0.0f);
    WeftImage image = test_render(scene,
                                  (WeftRenderDesc){.width = 64,
                                                   .height = 64,
                                                   .camera = "0,0,10;0,0,0;8",
                                                   .max_depth = 1,
                                                   .pixel_centre = 1,
                                                   .no_lift = no_lift},
                                  1);
    weft_scene_free(scene);
    return image;
}

/* A coarse ball is lit as the smooth one that its normals describe: its triangles leave no blocks of black. */
static void coarse_ball_is_lit_as_a_fine_one(void **state) {
    (void)state;
    WeftImage fine = grazed_ball(96, 0);
    double most[2] = {0.0, 0.0};
    for (int no_lift = 0; no_lift < 2; no_lift++) {
        WeftImage coarse = grazed_ball(12, no_lift);
        for (int k = 0; k < 64 * 64; k++)
            most[no_lift] = fmax(most[no_lift],
                                 fabs((double)((float *)coarse.pixels)[4 * k] - (double)((float *)fine.pixels)[4 * k]));
        weft_image_free(&coarse);
    }
    weft_image_free(&fine);
    assert_true(most[0] < 0.03);
    assert_true(most[1] > 2.0 * most[0]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(single_sided_surface_has_no_back),
        cmocka_unit_test(rays_out_of_reach_hit_nothing),
        cmocka_unit_test(packets_of_rays_agree_with_single_rays),
        cmocka_unit_test(sheets_back_to_back_have_no_holes),
        cmocka_unit_test(stochastic_transparency_has_its_probability),
        cmocka_unit_test(veil_hides_eye_and_light_independently),
        cmocka_unit_test(walk_through_coincident_sheets_ends),
        cmocka_unit_test(lifted_points_lie_on_the_smooth_surface),
        cmocka_unit_test(smooth_ball_does_not_shadow_itself),
        cmocka_unit_test(coarse_ball_is_lit_as_a_fine_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
