/* Triangles cut for what their vertices see: a floor has small ones below what stands on it, without a gap and with its
 * attributes, and smaller ones where a test tells the ends of edges apart; a mesh alone stays as it is; and vertices below
 * a slab see less of the sky */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "trace/scenes.h"

#include "raster/geometry/occlusion.h"

enum { FLOOR, SLAB };

/* A floor of two triangles, 40 m wide, and half a metre above its middle a slab of one. */
static WeftScene *floor_below(bool slab) {
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f);
    Mesh *floor = test_quad(scene, vec3(-20.0f, 0.0f, 20.0f), vec3(40.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -40.0f));
    floor->normal = NULL;
    if (slab) test_quad(scene, vec3(-0.5f, 0.5f, 0.5f), vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -1.0f));
    scene_bounds(scene);
    return scene;
}

static Vec3 corner(const float *position, const RefinedMesh *mesh, uint32_t k) {
    return vec3_load(position + 3 * (size_t)mesh->index[k]);
}

static float *filled(const RefinedMesh *refined, const Mesh *mesh) {
    float *position = malloc(3 * (size_t)refined->vertex_count * sizeof *position);
    assert_non_null(position);
    refined_fill(refined, mesh, mesh->position, 3, position);
    return position;
}

static void floor_is_cut_below_what_stands_on_it(void **state) {
    (void)state;
    WeftScene *scene = floor_below(true);
    Refinement refinement;
    assert_int_equal(refinement_make(scene, &refinement, NULL), WEFT_OK);
    const RefinedMesh mesh = refinement_mesh(&refinement, scene, FLOOR);
    float *position = filled(&mesh, &scene->meshes[FLOOR]);
    double area = 0.0;
    assert_true(mesh.triangle_count > 100 && mesh.triangle_count < 20000);
    for (uint32_t k = 0; k < 3 * mesh.triangle_count; k += 3) {
        Vec3 a = corner(position, &mesh, k), b = corner(position, &mesh, k + 1), c = corner(position, &mesh, k + 2);
        Vec3 up = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
        assert_true(up.y > 0.0f);
        area += 0.5 * (double)up.y;
        bool below = fabsf(a.x) < 0.5f && fabsf(a.z) < 0.5f;
        if (below) assert_true(vec3_length(vec3_sub(b, a)) <= 0.75f);
    }
    assert_float_equal((float)area, 1600.0f, 0.1f);
    free(position);
    refinement_free(&refinement);
    weft_scene_free(scene);
}

/* Each edge inside the floor is of two triangles, so that nothing opens where one is cut and its neighbour is not. */
static void has_no_gap(const RefinedMesh *mesh, const float *position) {
    uint32_t corners = 3 * mesh->triangle_count;
    for (uint32_t k = 0; k < corners; k++) {
        uint32_t a = mesh->index[k], b = mesh->index[k % 3 == 2 ? k - 2 : k + 1], back = 0;
        for (uint32_t n = 0; n < corners; n++)
            back += mesh->index[n] == b && mesh->index[n % 3 == 2 ? n - 2 : n + 1] == a;
        Vec3 p = vec3_load(position + 3 * (size_t)a), q = vec3_load(position + 3 * (size_t)b);
        bool border =
            (fabsf(p.x) > 19.99f && fabsf(p.x + q.x) > 39.9f) || (fabsf(p.z) > 19.99f && fabsf(p.z + q.z) > 39.9f);
        assert_int_equal(back, border ? 0 : 1);
    }
}

static void cut_triangles_leave_no_gap(void **state) {
    (void)state;
    WeftScene *scene = floor_below(true);
    Refinement refinement;
    assert_int_equal(refinement_make(scene, &refinement, NULL), WEFT_OK);
    const RefinedMesh mesh = refinement_mesh(&refinement, scene, FLOOR);
    float *position = filled(&mesh, &scene->meshes[FLOOR]);
    has_no_gap(&mesh, position);
    free(position);
    refinement_free(&refinement);
    weft_scene_free(scene);
}

/* Says that the sides of the line x = 0.1 differ, of the floor alone. */
static bool differ_at_line(const void *user, int mesh, uint32_t a, uint32_t b) {
    const float *position = user;
    return mesh == FLOOR && (position[3 * (size_t)a] < 0.1f) != (position[3 * (size_t)b] < 0.1f);
}

static bool never_differ(const void *user, int mesh, uint32_t a, uint32_t b) {
    (void)user, (void)mesh, (void)a, (void)b;
    return false;
}

static bool always_differ(const void *user, int mesh, uint32_t a, uint32_t b) {
    (void)user, (void)mesh, (void)a, (void)b;
    return true;
}

/* Vertices that were there stay, and each new one halves an edge across the line, near the slab and not far from it. */
static void edges_whose_ends_differ_are_halved(void **state) {
    (void)state;
    WeftScene *scene = floor_below(true);
    Refinement coarse, fine;
    assert_int_equal(refinement_make(scene, &coarse, NULL), WEFT_OK);
    const RefinedMesh before = refinement_mesh(&coarse, scene, FLOOR);
    float *position = filled(&before, &scene->meshes[FLOOR]);
    const EdgeTest line = {differ_at_line, position, 0};
    assert_true(refinement_halve(scene, &coarse, &line, &fine));
    const RefinedMesh after = refinement_mesh(&fine, scene, FLOOR);
    float *finer = filled(&after, &scene->meshes[FLOOR]);
    assert_true(after.vertex_count > before.vertex_count && after.triangle_count > before.triangle_count);
    assert_memory_equal(finer, position, 3 * (size_t)before.vertex_count * sizeof *finer);
    for (uint32_t k = before.vertex_count; k < after.vertex_count; k++) {
        const uint32_t *ends = after.ends[k - scene->meshes[FLOOR].vertex_count];
        assert_true(ends[0] < before.vertex_count && ends[1] < before.vertex_count);
        assert_true(differ_at_line(position, FLOOR, ends[0], ends[1]));
    }
    has_no_gap(&after, finer);
    free(position);
    free(finer);
    refinement_free(&coarse);
    refinement_free(&fine);
    weft_scene_free(scene);
}

/* Nothing is made where no edge may be halved: none differs, or no other mesh is near. */
static void refinement_stays_where_no_ends_differ(void **state) {
    (void)state;
    for (int slab = 0; slab < 2; slab++) {
        WeftScene *scene = floor_below(slab);
        Refinement coarse, fine;
        const EdgeTest test = {slab ? never_differ : always_differ, NULL, 0};
        assert_int_equal(refinement_make(scene, &coarse, NULL), WEFT_OK);
        assert_false(refinement_halve(scene, &coarse, &test, &fine));
        assert_null(fine.meshes);
        assert_int_equal(fine.count, 0);
        refinement_free(&coarse);
        weft_scene_free(scene);
    }
}

static void mesh_alone_stays_as_it_is(void **state) {
    (void)state;
    WeftScene *scene = floor_below(false);
    Refinement refinement;
    assert_int_equal(refinement_make(scene, &refinement, NULL), WEFT_OK);
    const RefinedMesh mesh = refinement_mesh(&refinement, scene, FLOOR);
    assert_int_equal(mesh.triangle_count, 2);
    assert_int_equal(mesh.vertex_count, 4);
    assert_ptr_equal(mesh.index, scene->meshes[FLOOR].index);
    refinement_free(&refinement);
    weft_scene_free(scene);
}

/* The middle of the floor sees what the slab, a square of half width h at height z, leaves: all but the form factor
 * 2/pi (4/2) (h/r) atan(h/r), r^2 = h^2 + z^2; John R. Howell, "A Catalog of Radiation Heat Transfer Configuration
 * Factors", B-3. */
static void vertices_below_a_slab_see_less_of_the_sky(void **state) {
    (void)state;
    WeftScene *scene = floor_below(true);
    test_material(scene, 0.5f)->double_sided = 1;
    scene->meshes[SLAB].material = 1;
    Refinement refinement;
    Occlusion *occlusion;
    const OcclusionHow how = {.rays = 256, .threads = 2, .no_cache = true};
    assert_int_equal(refinement_make(scene, &refinement, NULL), WEFT_OK);
    assert_int_equal(occlusion_start(scene, &refinement, &how, &occlusion, NULL, NULL), WEFT_OK);
    const float *values = occlusion_values(occlusion, true);
    Refinement finer = occlusion_take_refinement(occlusion);
    const RefinedMesh mesh = refinement_mesh(&finer, scene, FLOOR);
    float *position = filled(&mesh, &scene->meshes[FLOOR]), r = sqrtf(0.5f);
    float seen = 1.0f - 4.0f / 3.14159265f * 0.5f / r * atanf(0.5f / r);
    int middles = 0, corners = 0;
    for (uint32_t k = 0; k < mesh.vertex_count; k++) {
        Vec3 p = vec3_load(position + 3 * (size_t)k);
        float own = values[OCCLUSION_VALUES * (size_t)k];
        bool middle = vec3_length(p)<1e-6f, far = fabsf(p.x)> 19.99f && fabsf(p.z) > 19.99f;
        if (middle) assert_float_equal(own, seen, 0.03f);
        if (far) assert_float_equal(own, 1.0f, 0.01f);
        middles += middle, corners += far;
    }
    assert_true(middles == 1 && corners == 4);
    free(position);
    occlusion_free(occlusion);
    refinement_free(&finer);
    refinement_free(&refinement);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(floor_is_cut_below_what_stands_on_it),
                                       cmocka_unit_test(cut_triangles_leave_no_gap),
                                       cmocka_unit_test(edges_whose_ends_differ_are_halved),
                                       cmocka_unit_test(refinement_stays_where_no_ends_differ),
                                       cmocka_unit_test(mesh_alone_stays_as_it_is),
                                       cmocka_unit_test(vertices_below_a_slab_see_less_of_the_sky)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
