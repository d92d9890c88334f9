/* The path tracer against integrals that are known: white furnaces and directional albedo.
 *
 * Labels: unsanitized */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/pi.h"
#include "scenes.h"
#include "weft/weft.h"

/* Mean and standard error of a picture's red over pixels with full coverage. */
typedef struct Estimate {
    double mean, error;
    int count;
} Estimate;

static Estimate estimate(const WeftImage *image) {
    double sum = 0.0, squares = 0.0;
    int count = 0;
    for (int k = 0; k < image->width * image->height; k++) {
        const float *p = (const float *)image->pixels + 4 * k;
        if (p[3] < 0.9999f) continue;
        sum += (double)p[0];
        squares += (double)p[0] * (double)p[0];
        count++;
    }
    double mean = sum / count, variance = fmax(squares / count - mean * mean, 0.0);
    return (Estimate){mean, sqrt(variance / count), count};
}

/* Two-sided 1 % test, Sidak-corrected over `tests` of them: |z| below the normal quantile of 1 - p/2 with
 * p = 1 - 0.99^(1/tests); the quantile by bisection on erfc. */
static double sidak_quantile(int tests) {
    double p = 1.0 - pow(0.99, 1.0 / tests), low = 0.0, high = 10.0;
    while (high - low > 1e-6) {
        double middle = 0.5 * (low + high);
        if (erfc(middle / sqrt(2.0)) > p)
            low = middle;
        else
            high = middle;
    }
    return high;
}

/* A sheen over white lambert: lossless under albedo-view where the sheen's own E stays below 1. */
static void set_sheen(Material *material, const char *lobe, float alpha) {
    material->choices[CHOICE_sheen_lobe] = weft_lobe_find(lobe);
    test_color(material, INPUT_sheen_color, 1.0f);
    material->inputs[INPUT_sheen_roughness].value[0] = sqrtf(alpha);
}

/* A white lobe whose first parameter is what workflows make of the roughness whose square is alpha. */
static WeftLobe rough_lobe(int lobe, float alpha) {
    const WeftLobeInfo *info = weft_lobe_info(lobe);
    const WeftParamInfo *p = info->params;
    WeftLobe l;
    assert_int_equal(weft_lobe_init(info->id, &l, NULL), WEFT_OK);
    if (info->param_count == 0) return l;
    l.params[0] = p->low + (p->high - p->low) * sqrtf(alpha);
    if (strcmp(p->name, "alpha") == 0) l.params[0] = alpha;
    if (strcmp(p->name, "roughness") == 0) l.params[0] = sqrtf(alpha);
    return l;
}

/* Whether f of the lobe, and so E, is a mean of walks; and the standard errors that E has then (albedo.h). */
static bool walks(int lobe) { return lobe >= 0 && (weft_lobe_info(lobe)->traits & WEFT_LOBE_REFERENCE) != 0; }
static const double table_error = 0.0025, call_error = 0.0011;

static bool conserves_at(int lobe, float alpha) {
    if (walks(lobe)) return true;
    WeftLobe l = rough_lobe(lobe, alpha);
    float e[3];
    for (float mu = 0.005f; mu <= 1.0f; mu *= 1.3f) {
        weft_lobe_albedo(&l, mu, e);
        if (e[0] > 1.0f) return false;
    }
    return true;
}

/* Returns E of a lobe seen from an azimuth, by midpoints that are even in cos_i^2. */
static double albedo_from(const WeftLobe *lobe, float mu, double azimuth) {
    enum { RINGS = 200, SECTORS = 200 };
    const float s = sqrtf(1.0f - mu * mu), wo[3] = {s * (float)cos(azimuth), s * (float)sin(azimuth), mu};
    double sum = 0.0;
    for (int k = 0; k < RINGS * SECTORS; k++) {
        const double u = ((double)(k / SECTORS) + 0.5) / RINGS,
                     phi = 2.0 * PI_DOUBLE * ((double)(k % SECTORS) + 0.5) / SECTORS;
        const float wi[3] = {(float)(sqrt(u) * cos(phi)), (float)(sqrt(u) * sin(phi)), (float)sqrt(1.0 - u)};
        float f[3];
        weft_lobe_eval(lobe, wo, wi, f);
        sum += (double)f[0] / (RINGS * SECTORS);
    }
    return sum * PI_DOUBLE;
}

/* Returns true if E of a lobe depends on the azimuth, as where an engine reads a table in the frame of the surface. */
static bool is_turned(const WeftLobe *lobe, float mu) {
    const double along = albedo_from(lobe, mu, 0.0), across = albedo_from(lobe, mu, 0.5 * PI_DOUBLE);
    return fabs(along - across) > 2e-3 * along;
}

/* Every lobe; under sanitizers (WEFT_TEST_SHORT=1) one of seven, and for numbers to mean something, as many
 * samples. */
static int lobe_step(void) {
    const char *asked = getenv("WEFT_TEST_SHORT");
    return asked && asked[0] == '1' ? 7 : 1;
}

/* A closed room whose walls emit 1 - albedo: radiance is 1 everywhere, so a lossless sphere within is
 * invisible. */
static void closed_furnace_has_radiance_one(void **state) {
    (void)state;
    static const float alphas[] = {0.25f, 0.5f, 1.0f};
    int cases = 0;
    double z[64];
    for (int lobe = -1; lobe < weft_lobe_count(); lobe += lobe_step())
        for (int a = (lobe + 1) % 3; a < 3; a += 3) { /* each lobe at one of them */
            if (lobe >= 0 && (weft_lobe_info(lobe)->traits & WEFT_LOBE_TWO_COLORS || !conserves_at(lobe, alphas[a])))
                continue;
            WeftScene *scene = test_scene();
            test_environment(scene, 0.0f);
            test_color(test_material(scene, 0.5f), INPUT_emission, 0.5f);
            test_box(scene, 2.0f);
            Material *white = test_material(scene, 1.0f);
            if (lobe >= 0) set_sheen(white, weft_lobe_info(lobe)->id, alphas[a]);
            test_sphere(scene, vec3(0, 0, 0), 1.0f);
            scene_bounds(scene);
            WeftImage image = test_render(
                scene, (WeftRenderDesc){.width = 32, .height = 32, .camera = "0,0,1.95;0,0,0;60", .max_depth = 400},
                100);
            Estimate e = estimate(&image);
            z[cases] = (e.mean - 1.0) / (walks(lobe) ? hypot(e.error, table_error) : e.error);
            printf("  closed furnace %-22s alpha %.2f: %.5f +- %.5f\n",
                   lobe < 0 ? "(no sheen)" : weft_lobe_info(lobe)->id, (double)alphas[a], e.mean, e.error);
            cases++;
            weft_image_free(&image);
            weft_scene_free(scene);
        }
    assert_true(cases >= 2);
    double limit = sidak_quantile(cases);
    for (int k = 0; k < cases; k++)
        if (!(fabs(z[k]) < limit))
            fail_msg("case %d is %.2f standard errors from 1; the limit is %.2f", k, z[k], limit);
}

/* A ball and a curtain that let light through and lose none, under radiance 1: they are invisible. By lobe samples
 * alone each path is worth 1 from the first. */
static void white_cloth_that_light_goes_through_vanishes(void **state) {
    (void)state;
    static const float shares[] = {0.3f, 0.7f, 1.0f};
    for (int k = 0; k < 6; k++) {
        bool sheen = k % 3 == 1, by_lobe = k < 3;
        WeftScene *scene = test_scene();
        test_environment(scene, 1.0f);
        Material *white = test_material(scene, 1.0f);
        if (sheen) set_sheen(white, "charlie-conty-kulla", 0.5f);
        white->inputs[INPUT_diffuse_transmission].value[0] = shares[k % 3];
        test_sphere(scene, vec3(0, 0, 0), 1.0f);
        test_quad(scene, vec3(-1.5f, -1.5f, -1.4f), vec3(3, 0, 0), vec3(0, 3, 0));
        scene_bounds(scene);
        WeftRenderDesc desc = {.width = 32, .height = 32, .camera = "0,0,3;0,0,0;40", .max_depth = 1000};
        desc.sampling = by_lobe ? WEFT_SAMPLING_LOBE : WEFT_SAMPLING_MIS;
        WeftImage image = test_render(scene, desc, sheen && by_lobe ? 1024 : 128);
        Estimate e = estimate(&image);
        printf("  R + T = 1, T %.1f%s%s: %.5f +- %.5f\n", (double)shares[k % 3], sheen ? ", sheen" : "",
               by_lobe ? ", by lobe" : "", e.mean, e.error);
        assert_true(fabs(e.mean - 1.0) < (by_lobe ? 1e-3 : 4.0 * e.error + 2e-4) && e.error < 2e-3);
        weft_image_free(&image);
        weft_scene_free(scene);
    }
}

/* A curtain of waves whose normals are smoother than its few facets: z = depth cos(8 x). */
static void test_folds(WeftScene *scene, float depth, uint32_t columns) {
    enum { ROWS = 2 };
    Mesh *mesh = test_mesh(scene, (ROWS + 1) * (columns + 1), 2 * ROWS * columns);
    mesh->normal = arena_array(&scene->arena, mesh->vertex_count, 3 * sizeof(float));
    uint32_t *index = mesh->index;
    for (uint32_t k = 0; k < mesh->vertex_count; k++) {
        uint32_t row = k / (columns + 1), column = k % (columns + 1);
        float x = -1.5f + 3.0f * (float)column / (float)columns, y = -1.0f + (float)row;
        Vec3 p = {x, y, depth * cosf(8.0f * x)}, n = vec3_normal_or(vec3(8.0f * depth * sinf(8.0f * x), 0, 1), p);
        memcpy(mesh->position + 3 * k, &p, sizeof p);
        memcpy(mesh->normal + 3 * k, &n, sizeof n);
        uint32_t a = k, b = k + columns + 1;
        if (row == ROWS || column == columns) continue;
        *index++ = a, *index++ = a + 1, *index++ = b + 1;
        *index++ = a, *index++ = b + 1, *index++ = b;
    }
}

/* White cloth in folds under radiance 1 vanishes: by lobe samples alone no path of it may be lost, not even where the
 * smooth normal of a facet looks away from the viewer. */
static void white_folds_lose_nothing(void **state) {
    (void)state;
    static const char *const cameras[] = {"0,0,3;0,0,0;40", "3,0.4,1;0,0,0;40", "2.5,0,0.5;0,0,0;50"};
    double worst = 0.0;
    for (int k = 0; k < 6; k++) {
        WeftScene *scene = test_scene();
        test_environment(scene, 1.0f);
        test_material(scene, 1.0f);
        test_folds(scene, 0.3f, k < 3 ? 36 : 120);
        scene_bounds(scene);
        WeftRenderDesc desc = {.width = 64,
                               .height = 48,
                               .camera = cameras[k % 3],
                               .max_depth = 4000,
                               .no_roulette = 1,
                               .sampling = WEFT_SAMPLING_LOBE};
        WeftImage image = test_render(scene, desc, 256);
        double sum = 0.0;
        for (int p = 0; p < 64 * 48; p++) sum += (double)((const float *)image.pixels)[4 * p] / (64 * 48);
        printf("  folds, %d facets, %s: 1 %+.1e\n", k < 3 ? 36 : 120, cameras[k % 3], sum - 1.0);
        worst = fmax(worst, fabs(sum - 1.0));
        weft_image_free(&image);
        weft_scene_free(scene);
    }
    assert_true(worst < 2e-6);
}

/* The furnace test can fail: an additive sheen returns more than it receives. */
static void additive_layer_in_the_furnace_gains_energy(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    test_environment(scene, 1.0f);
    set_sheen(test_material(scene, 1.0f), "charlie-neubelt", 0.5f);
    assert_int_equal(weft_scene_set(scene, "*.layer", "additive", NULL, NULL), WEFT_OK);
    test_sphere(scene, vec3(0, 0, 0), 1.0f);
    scene_bounds(scene);
    WeftImage image = test_render(scene, (WeftRenderDesc){.width = 16, .height = 16, .camera = "0,0,3;0,0,0;20"}, 64);
    assert_true(estimate(&image).mean > 1.02);
    weft_image_free(&image);
    weft_scene_free(scene);
}

/* An image of numbers drawn anew for each texel, read by some inputs at full strength. */
static void put_noise(WeftScene *scene, Material *material, const InputId *inputs, int count) {
    enum { SIDE = 16 };
    uint32_t seed = 5;
    scene->images = arena_array(&scene->arena, 1, sizeof *scene->images);
    scene->textures = arena_array(&scene->arena, 1, sizeof *scene->textures);
    scene->image_count = scene->texture_count = 1;
    assert_int_equal(weft_image_create(SIDE, SIDE, 4, WEFT_PIXEL_F32, &scene->images[0], NULL), WEFT_OK);
    float *p = scene->images[0].pixels;
    for (int k = 0; k < 4 * SIDE * SIDE; k++) {
        seed = seed * 1664525u + 1013904223u;
        p[k] = (float)(seed >> 8) * 0x1p-24f;
    }
    for (int k = 0; k < count; k++) {
        WeftInputInfo info;
        weft_material_input_info((int)inputs[k], &info);
        material->inputs[inputs[k]].texture = 1;
        material->inputs[inputs[k]].channel = (uint8_t)(k % 3);
        material->inputs[inputs[k]].value[0] = info.hard_high;
    }
}

/* White fabric, and white body, whose numbers are textures over all their range: no part of a sphere of them
 * returns more than it receives, and most of it returns much. */
static void textured_fabric_and_body_keep_within_the_furnace(void **state) {
    (void)state;
    static const InputId inputs[2][3] = {{INPUT_sheen_roughness, INPUT_sheen_tail, INPUT_sheen_rise},
                                         {INPUT_roughness, INPUT_diffuse_retro, INPUT_diffuse_lift}};
    for (int body = 0; body < 2; body++) {
        WeftScene *scene = test_scene();
        test_environment(scene, 1.0f);
        Material *white = test_material(scene, body ? 1.0f : 0.0f);
        assert_int_equal(weft_scene_set(scene, "*.workflow", "cloth", NULL, NULL), WEFT_OK);
        assert_int_equal(weft_scene_set(scene, "*.layer", "additive", NULL, NULL), WEFT_OK);
        white->choices[CHOICE_diffuse] = weft_lobe_find("body");
        if (!body) set_sheen(white, "fabric", 1.0f);
        put_noise(scene, white, inputs[body], 3);
        Mesh *sphere = test_sphere(scene, vec3(0, 0, 0), 1.0f);
        sphere->texcoord[0] = arena_array(&scene->arena, sphere->vertex_count, 2 * sizeof(float));
        for (uint32_t k = 0; k < 2 * sphere->vertex_count; k++)
            sphere->texcoord[0][k] = 3.0f * sphere->position[k / 2 * 3 + k % 2];
        scene_bounds(scene);
        WeftImage image = test_render(
            scene, (WeftRenderDesc){.width = 32, .height = 32, .camera = "0,0,3;0,0,0;20", .max_depth = 1}, 1024);
        Estimate e = estimate(&image);
        double most = 0.0;
        for (int k = 0; k < 32 * 32; k++) most = fmax(most, (double)((float *)image.pixels)[4 * k]);
        printf("  textured %s: mean %.4f, most %.4f\n", body ? "body" : "fabric", e.mean, most);
        assert_true(e.mean > 0.3 && e.mean < 1.0 && most < 1.04); /* the noise of a pixel is 0.01 */
        weft_image_free(&image);
        weft_scene_free(scene);
    }
}

/* A lone lobe on a plane under radiance 1 shows E: camera straight at a wall from one direction. */
static void plane_in_the_furnace_shows_the_albedo(void **state) {
    (void)state;
    static const float cosines[] = {0.1f, 0.4f, 0.9f};
    for (int lobe = 0; lobe < weft_lobe_count(); lobe += lobe_step()) {
        const WeftLobeInfo *info = weft_lobe_info(lobe);
        if (info->traits & WEFT_LOBE_TWO_COLORS) continue;
        for (int k = 0; k < 3; k++) {
            float mu = cosines[k], e[3];
            WeftScene *scene = test_scene();
            test_environment(scene, 1.0f);
            set_sheen(test_material(scene, 0.0f), info->id, 0.36f);
            test_quad(scene, vec3(-100, 0, 100), vec3(200, 0, 0), vec3(0, 0, -200));
            scene_bounds(scene);
            char camera[96];
            snprintf(camera, sizeof camera, "0,%g,%g;0,0,0;0.2", (double)mu, (double)sqrtf(1.0f - mu * mu));
            WeftImage image =
                test_render(scene, (WeftRenderDesc){.width = 16, .height = 16, .camera = camera, .max_depth = 1}, 512);
            Estimate found = estimate(&image);
            WeftLobe l = rough_lobe(lobe, 0.36f);
            weft_lobe_albedo(&l, mu, e);
            if (!walks(lobe) && is_turned(&l, mu)) e[0] = (float)albedo_from(&l, mu, 0.5 * PI_DOUBLE);
            printf("  plane %-22s cos %.1f: %.5f +- %.5f, E %.5f\n", info->id, (double)mu, found.mean, found.error,
                   (double)e[0]);
            double noise = walks(lobe) ? 4.0 * hypot(found.error, call_error) : 0.0;
            assert_true(fabs(found.mean - (double)e[0]) < 0.005 * (double)e[0] + noise);
            weft_image_free(&image);
            weft_scene_free(scene);
        }
    }
}

/* A sphere in a uniform environment: the mean over its disc of E(cos_o), cos_o^2 being uniform there. */
static void sphere_in_the_furnace_shows_the_albedo(void **state) {
    (void)state;
    for (int lobe = 0; lobe < weft_lobe_count(); lobe += lobe_step()) {
        const WeftLobeInfo *info = weft_lobe_info(lobe);
        if (info->traits & WEFT_LOBE_TWO_COLORS || walks(lobe)) continue;
        WeftLobe l = rough_lobe(lobe, 0.36f);
        if (is_turned(&l, 0.5f)) continue; /* tangents of a sphere have all azimuths */
        WeftScene *scene = test_scene();
        test_environment(scene, 1.0f);
        set_sheen(test_material(scene, 0.0f), info->id, 0.36f);
        test_sphere(scene, vec3(0, 0, 0), 1.0f);
        scene_bounds(scene);
        /* far away, so that directions are parallel; black around, so that the silhouette's coverage does not
         * count */
        WeftImage image = test_render(
            scene,
            (WeftRenderDesc){
                .width = 32, .height = 32, .camera = "0,0,1000;0,0,0;0.13", .background = WEFT_BACKGROUND_COLOR},
            512);
        double light = 0.0, pixel = 2000.0 * tan(0.065 * RADIANS) / 32.0;
        for (int k = 0; k < 32 * 32; k++) light += (double)((float *)image.pixels)[4 * k] * pixel * pixel;
        double truth = 0.0;
        enum { STEPS = 150 };
        for (int k = 0; k < STEPS; k++) {
            float e[3];
            weft_lobe_albedo(&l, sqrtf(((float)k + 0.5f) / STEPS), e);
            truth += PI_DOUBLE * (double)e[0] / STEPS;
        }
        printf("  sphere %-22s %.5f, by quadrature %.5f\n", info->id, light, truth);
        assert_true(fabs(light - truth) < 0.005 * truth);
        weft_image_free(&image);
        weft_scene_free(scene);
    }
}

/* The mean of a matt floor's picture under a sky and a square light, with a black board between, or not. */
static Estimate under_a_board(bool board, WeftSampling sampling, int no_shadows) {
    WeftScene *scene = test_scene();
    test_environment(scene, 1.0f);
    test_material(scene, 0.5f);
    test_quad(scene, vec3(-1, 0, 1), vec3(2, 0, 0), vec3(0, 0, -2));
    Material *light = test_material(scene, 0.0f);
    test_color(light, INPUT_emission, 3.0f);
    test_quad(scene, vec3(-1, 3, -1), vec3(2, 0, 0), vec3(0, 0, 2));
    test_material(scene, 0.0f);
    if (board) test_quad(scene, vec3(-4, 2, -4), vec3(8, 0, 0), vec3(0, 0, 8));
    scene_bounds(scene);
    const WeftRenderDesc desc = {
        .width = 16, .height = 16, .camera = "0,1,0.01;0,0,0;40", .sampling = sampling, .no_shadows = no_shadows};
    WeftRender *render;
    WeftImage image;
    WeftError error;
    if (weft_render_create(scene, &desc, &render, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_render_run(render, 64, 0.0, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_render_image(render, &image, &error), WEFT_OK);
    const Estimate found = estimate(&image);
    weft_image_free(&image);
    weft_render_free(render);
    weft_scene_free(scene);
    return found;
}

/* Without shadows the board is as if it were not there, however light is sampled; with them it is. */
static void no_shadows_is_the_same_for_every_sampling(void **state) {
    (void)state;
    const Estimate bare = under_a_board(false, WEFT_SAMPLING_LIGHT, 1); /* nor does the light hide the sky */
    const double shaded = under_a_board(true, WEFT_SAMPLING_MIS, 0).mean;
    assert_int_equal(bare.count, 16 * 16);
    assert_true(shaded < 0.5 * bare.mean);
    for (int sampling = 0; sampling <= WEFT_SAMPLING_LOBE; sampling++) {
        const Estimate found = under_a_board(true, (WeftSampling)sampling, 1);
        if (!(fabs(found.mean - bare.mean) < 4.0 * hypot(found.error, bare.error)))
            fail_msg("sampling %d: %.4f, not %.4f +- %.4f", sampling, found.mean, bare.mean,
                     4.0 * hypot(found.error, bare.error));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_furnace_has_radiance_one),
        cmocka_unit_test(white_folds_lose_nothing),
        cmocka_unit_test(white_cloth_that_light_goes_through_vanishes),
        cmocka_unit_test(additive_layer_in_the_furnace_gains_energy),
        cmocka_unit_test(textured_fabric_and_body_keep_within_the_furnace),
        cmocka_unit_test(plane_in_the_furnace_shows_the_albedo),
        cmocka_unit_test(sphere_in_the_furnace_shows_the_albedo),
        cmocka_unit_test(no_shadows_is_the_same_for_every_sampling),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
