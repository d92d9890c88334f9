/* The tree of lights: its probabilities are those with which it chooses, sum up to 1, and leave no light out that
 * arrives. Many emissive triangles light a point as the contour integral says. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/random.h"
#include "scenes.h"
#include "trace/light/light_tree.h"
#include "trace/light/lights.h"

enum { LIGHTS = 300, POINTS = 200 };

static float draw(uint32_t *state) { return unit_float(*state = hash32(*state + 0x9e3779b9u)); }

static Vec3 draw_in(uint32_t *state, float size) {
    float x = draw(state), y = draw(state), z = draw(state);
    return vec3(size * (x - 0.5f), size * (y - 0.5f), size * (z - 0.5f));
}

static Vec3 draw_unit(uint32_t *state) { return vec3_normal_or(draw_in(state, 2.0f), vec3(0, 1, 0)); }

/* Small flat lights of very different power; each seventh has none. */
static void fill(LightBounds lights[LIGHTS], uint32_t *state) {
    for (int k = 0; k < LIGHTS; k++) {
        Vec3 at = draw_in(state, 8.0f);
        float size = 0.1f * draw(state), bright = draw(state);
        lights[k] = (LightBounds){.low = vec3_sub(at, vec3(size, size, size)),
                                  .high = vec3_add(at, vec3(size, size, size)),
                                  .axis = draw_unit(state),
                                  .cos_spread = 1.0f,
                                  .power = k % 7 == 3 ? 0.0f : 0.001f + bright * bright * bright,
                                  .two_sided = k % 5 == 0};
    }
}

/* Returns true if some of the light's middle arrives. */
static bool arrives(const LightBounds *light, Vec3 point, Vec3 normal) {
    Vec3 to = vec3_sub(vec3_scale(vec3_add(light->low, light->high), 0.5f), point);
    float sent = -vec3_dot(to, light->axis);
    bool anywhere = !(vec3_dot(normal, normal) > 0.0f);
    return light->power > 0.0f && (anywhere || vec3_dot(to, normal) > 0.0f) &&
           (sent > 0.0f || (light->two_sided && sent < 0.0f));
}

/* Returns the share of even draws whose way down the tree ends where no light arrives. */
static double dead_share(const LightTree *tree, Vec3 point, Vec3 normal) {
    enum { ROUNDS = 16 };
    static float rows[6][ROW_MOST], u[ROW_MOST], probability[ROW_MOST];
    static int chosen[ROW_MOST];
    const float of[] = {point.x, point.y, point.z, normal.x, normal.y, normal.z};
    for (int a = 0; a < 6; a++)
        for (int k = 0; k < ROW_MOST; k++) rows[a][k] = of[a];
    const float *const points[] = {rows[0], rows[1], rows[2]}, *const normals[] = {rows[3], rows[4], rows[5]};
    int dead = 0;
    for (int round = 0; round < ROUNDS; round++) {
        for (int k = 0; k < ROW_MOST; k++) u[k] = ((float)(round * ROW_MOST + k) + 0.5f) / (float)(ROUNDS * ROW_MOST);
        light_tree_choose_rows(tree, ROW_MOST, points, normals, u, chosen, probability);
        for (int k = 0; k < ROW_MOST; k++) dead += !(probability[k] > 0.0f);
    }
    return (double)dead / (ROUNDS * ROW_MOST);
}

static void probabilities_sum_to_one(void **state) {
    (void)state;
    static LightBounds lights[LIGHTS];
    Arena arena = {0};
    LightTree tree;
    uint32_t random = 5;
    fill(lights, &random);
    assert_true(light_tree_make(&tree, LIGHTS, lights, &arena));
    assert_true(tree.depth >= 8 && tree.depth < 40);
    for (int n = 0; n < POINTS; n++) {
        Vec3 point = draw_in(&random, 10.0f), normal = draw_unit(&random);
        if (n % 4 == 0) normal = vec3(0, 0, 0); /* what light reaches from both sides */
        double sum = 0.0;
        for (int k = 0; k < LIGHTS; k++) {
            float p = light_tree_probability(&tree, k, point, normal);
            assert_true(p >= 0.0f);
            if (arrives(&lights[k], point, normal)) assert_true(p > 0.0f);
            if (!(lights[k].power > 0.0f)) assert_true(p <= 0.0f);
            sum += (double)p;
        }
        const double dead = dead_share(&tree, point, normal);
        if (!(dead > 0.0)) assert_true(fabs(sum - 1.0) < 1e-4);
        if (!(fabs(sum + dead - 1.0) < 0.01)) fail_msg("%g of lights, %g of dead ends", sum, dead);
    }
    arena_free(&arena);
}

/* Chooses as often as it says, and keeps u even. */
static void follows_probabilities(Vec3 normal) {
    enum { ROUNDS = 400 };
    static LightBounds lights[LIGHTS];
    int counts[LIGHTS] = {0};
    Arena arena = {0};
    LightTree tree;
    uint32_t random = 11;
    fill(lights, &random);
    assert_true(light_tree_make(&tree, LIGHTS, lights, &arena));
    Vec3 point = vec3(0.5f, -1.0f, 0.2f);
    static float rows[6][ROW_MOST], u[ROW_MOST], probability[ROW_MOST];
    static int chosen[ROW_MOST];
    const float of[] = {point.x, point.y, point.z, normal.x, normal.y, normal.z};
    for (int a = 0; a < 6; a++)
        for (int k = 0; k < ROW_MOST; k++) rows[a][k] = of[a];
    const float *const points[] = {rows[0], rows[1], rows[2]}, *const normals[] = {rows[3], rows[4], rows[5]};
    double mean = 0.0, live = 0.0;
    const double draws = (double)ROUNDS * ROW_MOST;
    for (int round = 0; round < ROUNDS; round++) {
        for (int k = 0; k < ROW_MOST; k++) u[k] = ((float)(round * ROW_MOST + k) + 0.5f) / (float)draws;
        light_tree_choose_rows(&tree, ROW_MOST, points, normals, u, chosen, probability);
        for (int k = 0; k < ROW_MOST; k++) {
            float p = light_tree_probability(&tree, chosen[k], point, normal);
            assert_true(fabsf(p - probability[k]) <= 1e-4f * p + 1e-9f);
            if (!(p > 0.0f)) continue; /* the end of a way without light */
            counts[chosen[k]]++;
            mean += (double)u[k];
            live += 1.0;
        }
    }
    assert_true(live > 0.7 * draws && fabs(mean / live - 0.5) < 0.01);
    for (int k = 0; k < LIGHTS; k++) { /* u are even: a count is off by one or two */
        double expected = draws * (double)light_tree_probability(&tree, k, point, normal);
        assert_true(fabs(counts[k] - expected) < 2.5 + 0.01 * expected);
    }
    arena_free(&arena);
}

static void choices_follow_probabilities(void **state) {
    (void)state;
    follows_probabilities(vec3(0, 1, 0));
    follows_probabilities(vec3(0, 0, 0));
}

/* The irradiance of a triangle above the horizon: half of the sum of each edge's angle times the part of its
 * plane's normal along z. Johann Heinrich Lambert, "Photometria", 1760. */
static double lambert(const Vec3 corner[3]) {
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        Vec3 a = vec3_normal_or(corner[k], vec3(0, 1, 0)), b = vec3_normal_or(corner[(k + 1) % 3], vec3(0, 1, 0));
        Vec3 across = vec3_normal_or(vec3_cross(a, b), vec3(0, 0, 0));
        sum += (acos)((double)fminf(fmaxf(vec3_dot(a, b), -1.0f), 1.0f)) * (double)across.y;
    }
    return 0.5 * fabs(sum);
}

enum { QUADS = 100, SAMPLES = 1 << 14 };

/* A parallelogram that emits. */
typedef struct Quad {
    Vec3 at, x, y;
    float strength;
    bool two_sided;
} Quad;

static Vec3 facing(const Quad *q) { return vec3_cross(q->x, q->y); }

static float power(const Quad *q) { return q->strength * vec3_length(facing(q)) * (q->two_sided ? 2.0f : 1.0f); }

/* The mean square of the estimates that choosing by power alone would give. */
static double square_by_power(const Quad quads[QUADS], uint32_t *random) {
    double sum = 0.0, all = 0.0;
    for (int k = 0; k < QUADS; k++) all += (double)power(&quads[k]);
    for (int k = 0; k < QUADS; k++)
        for (int n = 0; n < 64; n++) {
            const Quad *q = &quads[k];
            float u = draw(random), v = draw(random);
            Vec3 to = vec3_madd(vec3_madd(q->at, q->x, u), q->y, v);
            float t2 = vec3_dot(to, to), cosine = -vec3_dot(to, facing(q)) / sqrtf(t2);
            if (to.y < 0.0f || (cosine < 0.0f && !q->two_sided)) continue;
            double p = (double)power(q) / all;
            double x = (double)(q->strength * to.y / sqrtf(t2) * fabsf(cosine) / t2) / p;
            sum += p * x * x / 64.0;
        }
    return sum;
}

static void many_emitters_shine_as_their_sum(void **state) {
    (void)state;
    static Quad quads[QUADS];
    WeftScene *scene = test_scene();
    scene->meshes = arena_array(&scene->arena, QUADS, sizeof(Mesh));
    scene->materials = arena_array(&scene->arena, QUADS, sizeof(Material));
    scene->material_names = arena_array(&scene->arena, QUADS, sizeof(char *));
    test_environment(scene, 0.0f);
    uint32_t random = 3;
    double expected = 0.0, squares = 0.0, sum = 0.0;
    for (int k = 0; k < QUADS; k++) {
        Material *lamp = test_material(scene, 0.0f);
        float strength = k % 10 == 0 ? 20.0f : 0.5f;
        lamp->double_sided = k % 2;
        test_color(lamp, INPUT_emission, strength);
        Vec3 at = vec3_add(draw_in(&random, 6.0f), vec3(0, 4.0f, 0));
        Vec3 x = vec3_scale(draw_unit(&random), 0.4f), y = vec3_scale(draw_unit(&random), 0.4f);
        test_quad(scene, at, x, y);
        quads[k] = (Quad){at, x, y, strength, lamp->double_sided};
        Vec3 b = vec3_add(at, x), c = vec3_add(b, y), d = vec3_add(at, y);
        if (!lamp->double_sided && vec3_dot(facing(&quads[k]), at) >= 0.0f) continue; /* its back */
        expected += (double)strength * (lambert((Vec3[]){at, b, c}) + lambert((Vec3[]){at, c, d}));
    }
    Lights *lights = NULL;
    scene_bounds(scene);
    assert_int_equal(lights_create(scene, &lights, NULL), WEFT_OK);
    for (int k = 0; k < SAMPLES; k++) {
        float u = draw(&random), v = draw(&random);
        LightSample s = lights_sample(lights, LIGHTS_EMITTERS, vec3(0, 0, 0), vec3(0, 1, 0), u, v);
        double x = s.pdf > 0.0f ? (double)(s.radiance.r * fmaxf(s.wi.y, 0.0f) / s.pdf) : 0.0;
        sum += x / SAMPLES;
        squares += x * x / SAMPLES;
    }
    double error = (sqrt)((squares - sum * sum) / SAMPLES);
    assert_true(fabs(sum - expected) < 4.0 * error);
    double by_power = square_by_power(quads, &random) - expected * expected;
    assert_true(squares - sum * sum < 0.6 * by_power);
    lights_free(lights);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(probabilities_sum_to_one),
        cmocka_unit_test(choices_follow_probabilities),
        cmocka_unit_test(many_emitters_shine_as_their_sum),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
