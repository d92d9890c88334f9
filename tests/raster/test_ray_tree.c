/* The tree of boxes for rays in shaders: every triangle is in one leaf and inside the boxes above it, and a walk along
 * random rays meets what Embree meets */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "trace/scenes.h"

#include "base/random.h"
#include "raster/geometry/ray_tree.h"
#include "trace/geometry/geometry.h"

enum { RAYS = 4000 };

typedef struct Soup {
    Vec3 (*corners)[3];
    RayBox *boxes;
    uint32_t count;
} Soup;

static Soup soup_of(const WeftScene *scene) {
    Soup soup = {0};
    for (int m = 0; m < scene->mesh_count; m++) soup.count += scene->meshes[m].triangle_count;
    soup.corners = calloc(soup.count, sizeof *soup.corners);
    soup.boxes = calloc(soup.count, sizeof *soup.boxes);
    assert_true(soup.corners && soup.boxes);
    uint32_t at = 0;
    for (int m = 0; m < scene->mesh_count; m++)
        for (uint32_t t = 0; t < scene->meshes[m].triangle_count; t++, at++) {
            const Mesh *mesh = &scene->meshes[m];
            Vec3 *c = soup.corners[at];
            for (int k = 0; k < 3; k++)
                c[k] = vec3_load(mesh->position + 3 * (size_t)mesh->index[3 * (size_t)t + (size_t)k]);
            soup.boxes[at] = (RayBox){vec3_least(c[0], vec3_least(c[1], c[2])), vec3_most(c[0], vec3_most(c[1], c[2]))};
        }
    return soup;
}

static void soup_free(Soup *soup) {
    free(soup->corners);
    free(soup->boxes);
}

static bool holds(const RayNode *node, const RayBox *box) {
    return node->low[0] <= box->low.x && node->low[1] <= box->low.y && node->low[2] <= box->low.z &&
           node->high[0] >= box->high.x && node->high[1] >= box->high.y && node->high[2] >= box->high.z;
}

/* Walks a node and its descendants, and counts each triangle; returns the node after them. */
static uint32_t check_node(const RayTree *tree, const Soup *soup, uint32_t at, int *seen) {
    const RayNode *node = &tree->nodes[at];
    const bool leaf = node->first >= 0.0f;
    const uint32_t first = leaf ? (uint32_t)node->first : 0, count = leaf ? (uint32_t)node->skip : 0;
    if (leaf) assert_true(count >= 1 && count <= RAY_LEAF_MOST && first + count <= tree->count);
    for (uint32_t k = 0; leaf && k < count; k++) {
        seen[tree->order[first + k]]++;
        assert_true(holds(node, &soup->boxes[tree->order[first + k]]));
    }
    if (leaf) return at + 1;
    const uint32_t second = check_node(tree, soup, at + 1, seen), end = check_node(tree, soup, second, seen);
    for (uint32_t child = at + 1; child != end; child = child == at + 1 ? second : end) {
        const RayNode *c = &tree->nodes[child];
        const RayBox box = {vec3_load(c->low), vec3_load(c->high)};
        assert_true(holds(node, &box));
    }
    assert_int_equal((uint32_t)node->skip, end);
    return end;
}

static void each_triangle_is_in_one_leaf(const RayTree *tree, const Soup *soup) {
    int *seen = calloc(soup->count, sizeof *seen);
    assert_non_null(seen);
    assert_int_equal(check_node(tree, soup, 0, seen), tree->node_count);
    for (uint32_t k = 0; k < soup->count; k++) assert_int_equal(seen[k], 1);
    free(seen);
}

static float random_in(uint32_t key, float low, float high) { return low + (high - low) * unit_float(hash32(key)); }

static bool meets(const Vec3 c[3], Vec3 origin, Vec3 d) {
    const Vec3 ab = vec3_sub(c[1], c[0]), ac = vec3_sub(c[2], c[0]), h = vec3_cross(d, ac), s = vec3_sub(origin, c[0]);
    const float det = vec3_dot(ab, h);
    if (!(det * det > 0.0f)) return false;
    const float u = vec3_dot(s, h) / det, v = vec3_dot(d, vec3_cross(s, ab)) / det;
    return u >= 0.0f && v >= 0.0f && u + v <= 1.0f && vec3_dot(ac, vec3_cross(s, ab)) / det > 0.0f;
}

static bool enters(const RayNode *n, Vec3 o, Vec3 d) {
    const float least = 1e-30f, from[3] = {o.x, o.y, o.z}, way[3] = {d.x, d.y, d.z};
    float near = 0.0f, far = INFINITY;
    for (int k = 0; k < 3; k++) {
        const float along = fabsf(way[k]) > least ? way[k] : least;
        const float a = (n->low[k] - from[k]) / along, b = (n->high[k] - from[k]) / along;
        near = fmaxf(near, fminf(a, b));
        far = fminf(far, fmaxf(a, b));
    }
    return near <= far * 1.0000004f;
}

/* As ray_trace of glsl/rays.glsl. */
static bool occluded(const RayTree *tree, const Soup *soup, Vec3 o, Vec3 d, int *steps) {
    for (uint32_t at = 0; at < tree->node_count;) {
        const RayNode *node = &tree->nodes[at];
        const bool inside = enters(node, o, d), leaf = node->first >= 0.0f;
        for (uint32_t k = 0; inside && leaf && k < (uint32_t)node->skip; k++)
            if (meets(soup->corners[tree->order[(uint32_t)node->first + k]], o, d)) return true;
        at = inside || leaf ? at + 1 : (uint32_t)node->skip;
        ++*steps;
    }
    return false;
}

static void rays_meet_what_embree_meets(const WeftScene *scene, const RayTree *tree, const Soup *soup) {
    Geometry *geometry;
    int differ = 0, hits = 0, steps = 0;
    assert_int_equal(geometry_create(scene, scene->mesh_count, 1, &geometry, NULL), WEFT_OK);
    const Vec3 size = vec3_sub(scene->high, scene->low);
    for (uint32_t k = 0; k < RAYS; k++) {
        const Vec3 o = {random_in(6 * k, scene->low.x - size.x, scene->high.x + size.x),
                        random_in(6 * k + 1, scene->low.y - size.y, scene->high.y + size.y),
                        random_in(6 * k + 2, scene->low.z - size.z, scene->high.z + size.z)};
        const Vec3 aim = {random_in(6 * k + 3, scene->low.x, scene->high.x),
                          random_in(6 * k + 4, scene->low.y, scene->high.y),
                          random_in(6 * k + 5, scene->low.z, scene->high.z)};
        const Vec3 d = vec3_normal_or(vec3_sub(aim, o), vec3(0.0f, 1.0f, 0.0f));
        const bool one = geometry_occluded(geometry, (Ray){.origin = o, .direction = d, .far = INFINITY});
        const bool other = occluded(tree, soup, o, d, &steps);
        hits += one;
        differ += one != other;
    }
    assert_true(hits > RAYS / 20);
    assert_true(differ <= RAYS / 1000); /* edges, by rounding */
    print_message("%u triangles, %.0f nodes a ray\n", soup->count, (double)steps / RAYS);
    if (soup->count > 1000) assert_true(steps / RAYS < 200);
    geometry_free(geometry);
}

static void check_scene(WeftScene *scene) {
    Soup soup = soup_of(scene);
    RayTree tree;
    for (int m = 0; m < scene->material_count; m++) {
        scene->materials[m].double_sided = true; /* `meets` has no sides */
        scene->materials[m].alpha_mode = WEFT_ALPHA_OPAQUE;
    }
    assert_true(ray_tree_make(&tree, soup.boxes, soup.count));
    each_triangle_is_in_one_leaf(&tree, &soup);
    rays_meet_what_embree_meets(scene, &tree, &soup);
    ray_tree_free(&tree);
    soup_free(&soup);
    weft_scene_free(scene);
}

static void builtin_scenes_are_met_as_by_embree(void **state) {
    (void)state;
    static const char *const names[] = {"builtin:spheres", "builtin:cloth", "builtin:lampshade"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        WeftScene *scene;
        WeftError error;
        if (weft_scene_load(names[k], &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        check_scene(scene);
    }
}

static void flat_boxes_and_one_triangle(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f);
    test_box(scene, 1.0f);
    scene_bounds(scene);
    check_scene(scene);
}

/* Triangles at one place cannot be told apart: the tree halves them by number. */
static void equal_boxes_are_divided(void **state) {
    (void)state;
    enum { SAME = 1000 };
    RayBox boxes[SAME];
    Vec3 corners[SAME][3];
    for (int k = 0; k < SAME; k++) {
        corners[k][0] = corners[k][1] = corners[k][2] = vec3(1.0f, 2.0f, 3.0f);
        boxes[k] = (RayBox){corners[k][0], corners[k][0]};
    }
    const Soup soup = {corners, boxes, SAME};
    RayTree tree;
    assert_true(ray_tree_make(&tree, boxes, SAME));
    each_triangle_is_in_one_leaf(&tree, &soup);
    ray_tree_free(&tree);
    assert_true(ray_tree_make(&tree, boxes, 0));
    assert_int_equal(tree.node_count, 0);
    ray_tree_free(&tree);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(builtin_scenes_are_met_as_by_embree),
                                       cmocka_unit_test(flat_boxes_and_one_triangle),
                                       cmocka_unit_test(equal_boxes_are_divided)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
