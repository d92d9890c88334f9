/* Both engines make the same picture of one light without shadows: with every lobe, layer rule, workflow and
 * profile on spheres, and with a dozen of them on a textured cloth. They share the text: anything else is a
 * fault. Random rules are left out, and pixels at outlines, where the engines may see different surfaces.
 *
 * Labels: slow unsanitized */
#include "shading/cases.h"

#include "raster/gl.h"
#include "raster/spheres.h"

#include "scene/record/camera.h"
#include "scene/record/scene.h"
#include "shading/material/choice.h"
#include "trace/geometry/geometry.h"
#include "weft/weft.h"

enum { WIDTH = 320, HEIGHT = 180, PIXELS = WIDTH * HEIGHT };
static const double relative = 0.01, floor_coverage = 1e-3, share_least = 0.999;
static const float light_color = 3.0f;

static bool inside[PIXELS]; /* of one surface, with all neighbours */

/* What is hit at the middle of each pixel, from which follows what lies at an outline. */
static void find_inside(const WeftScene *scene, const char *camera_name) {
    static Hit hits[PIXELS];
    static bool there[PIXELS];
    Geometry *geometry;
    Camera camera;
    WeftError error;
    assert_int_equal(camera_find(scene, camera_name, (float)WIDTH / HEIGHT, &camera, &error), WEFT_OK);
    assert_int_equal(geometry_create(scene, scene->mesh_count, 2, &geometry, &error), WEFT_OK);
    View view = view_of(&camera, (float)WIDTH / HEIGHT);
    for (int k = 0; k < PIXELS; k++) {
        float x = ((float)(k % WIDTH) + 0.5f) / WIDTH, y = ((float)(k / WIDTH) + 0.5f) / HEIGHT;
        CameraRay r = view_ray(&view, 2.0f * x - 1.0f, 1.0f - 2.0f * y);
        there[k] = geometry_hit(geometry, (Ray){r.origin, r.direction, 0.0f, INFINITY, 0, false}, &hits[k]);
    }
    for (int k = 0; k < PIXELS; k++) {
        int x = k % WIDTH, y = k / WIDTH;
        inside[k] = x > 0 && y > 0 && x < WIDTH - 1 && y < HEIGHT - 1;
        for (int n = 0; inside[k] && n < 9; n++) {
            const Hit *a = &hits[k], *b = &hits[k + n % 3 - 1 + (n / 3 - 1) * WIDTH];
            bool same = there[k] == there[b - hits];
            if (same && there[k])
                same = a->mesh == b->mesh && fabsf(a->t - b->t) < 0.005f * a->t &&
                       vec3_dot(vec3_normal_or(a->facing, a->facing), vec3_normal_or(b->facing, b->facing)) > 0.7f;
            inside[k] = same;
        }
    }
    geometry_free(geometry);
}

static void trace(const WeftScene *scene, const char *camera, WeftImage *out) {
    WeftRender *render;
    WeftError error;
    WeftRenderDesc desc = {.width = WIDTH,
                           .height = HEIGHT,
                           .max_depth = 1,
                           .camera = camera,
                           .background = WEFT_BACKGROUND_COLOR,
                           .pixel_centre = 1,
                           .no_shadows = 1,
                           .no_roulette = 1};
    if (weft_render_create(scene, &desc, &render, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_render_run(render, 1, 0.0, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_render_image(render, out, &error), WEFT_OK);
    weft_render_free(render);
}

static void draw(const WeftScene *scene, WeftGl gl, const char *camera, WeftImage *out) {
    WeftRaster *raster;
    WeftError error;
    const WeftRasterView view = {.width = WIDTH,
                                 .height = HEIGHT,
                                 .samples = 1,
                                 .camera = camera,
                                 .background = WEFT_BACKGROUND_COLOR,
                                 .no_shadows = 1,
                                 .plain_textures = 1};
    if (weft_raster_create(scene, &(WeftRasterDesc){.gl = gl}, &raster, NULL, &error) != WEFT_OK ||
        weft_raster_draw(raster, &view, &error) != WEFT_OK || weft_raster_image(raster, out, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    WeftRasterInfo info = weft_raster_info(raster);
    assert_string_equal(info.complaint, "");
    assert_true(info.samplers <= 16);
    weft_raster_free(raster);
}

/* The share of pixels within the tolerance. */
static double agreeing(const WeftImage *a, const WeftImage *b) {
    const float *p = a->pixels, *q = b->pixels;
    int all = 0, good = 0, lit = 0;
    for (int k = 0; k < PIXELS; k++) {
        if (!inside[k]) continue;
        bool same = true;
        for (int c = 0; c < 3; c++) {
            double x = (double)p[4 * k + c], y = (double)q[4 * k + c];
            same &= fabs(x - y) <= relative * fabs(x) + floor_coverage * (double)light_color;
            lit += x > 0.01;
        }
        all++;
        good += same;
    }
    assert_true(all > PIXELS / 4);
    assert_true(lit > all / 4); /* there is a picture */
    return (double)good / all;
}

static WeftScene *scene_of(const char *path) {
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load(path, &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    const WeftLight light = {.direction = {-1.0f, -2.0f, -1.0f}, .color = {light_color, light_color, light_color}};
    assert_int_equal(weft_scene_add_light(scene, &light, &error), WEFT_OK);
    assert_int_equal(weft_scene_set_environment_color(scene, (const float[]){0.0f, 0.0f, 0.0f}, &error), WEFT_OK);
    return scene;
}

static bool engines_agree(const WeftScene *scene, const char *camera, WeftGl gl, const char *name) {
    WeftImage reference, picture;
    trace(scene, camera, &reference);
    draw(scene, gl, camera, &picture);
    double share = agreeing(&reference, &picture);
    print_message("%s: %.3f %% agree\n", name, 100.0 * share);
    if (share < share_least) {
        char file[96];
        WeftError error;
        snprintf(file, sizeof file, "disagree-%s-trace.exr", name);
        for (char *c = file; *c; c++)
            if (*c == ' ' || *c == '/') *c = '-';
        weft_image_write(file, &reference, &error);
        memcpy(strstr(file, "trace"), "image", 5);
        weft_image_write(file, &picture, &error);
        print_message("    see %s\n", file);
    }
    weft_image_free(&reference);
    weft_image_free(&picture);
    return share >= share_least;
}

static void choose(WeftScene *scene, const char *choice, const char *id) {
    char target[64];
    WeftError error;
    snprintf(target, sizeof target, "*.%s", choice);
    if (weft_scene_set(scene, target, id, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

static WeftScene *spheres(void) {
    WeftScene *scene = scene_of("builtin:spheres");
    spheres_cover_floor(scene);
    return scene;
}

/* Makes inputs that the other workflow understands differently, if the choice is a conversion to workflow `id`. */
static void prepare_conversion(WeftScene *scene, ChoiceId choice, const char *id) {
    if (choice != CHOICE_convert) return;
    choose(scene, "workflow", strcmp(id, "metallic") == 0 ? "specular" : "metallic");
    choose(scene, "metallic", "0.7");
    choose(scene, "specular_color", "0.8,0.5,0.2");
}

/* Every so manyth id of a choice, both of a pair, each in a scene of its own. */
static bool choice_agrees(ChoiceId choice, const char *name, int step) {
    bool good = true;
    if (!choice_id(choice, 2)) step = 1;
    for (int k = 0; choice_id(choice, k); k += step) {
        const char *id = choice_id(choice, k);
        if (strcmp(id, "stochastic") == 0 || !choice_fits(choice, k)) continue;
        bool lobe = choice == CHOICE_sheen_lobe || choice == CHOICE_diffuse;
        if (lobe && weft_lobe_info(k)->traits & TRAIT_REFERENCE) continue;
        WeftScene *scene = spheres();
        prepare_conversion(scene, choice, id);
        choose(scene, name, id);
        char words[96];
        snprintf(words, sizeof words, "%s %s", name, id);
        good &= engines_agree(scene, "0", k % 2 ? WEFT_GL_ES : WEFT_GL_DESKTOP, words);
        weft_scene_free(scene);
    }
    return good;
}

static void engines_agree_on_spheres(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = spheres();
    find_inside(scene, "0");
    weft_scene_free(scene);
    bool good = true;
    int step = test_short() ? 11 : test_long() ? 1 : 5; /* raster/parity and raster/families take all */
#define ASK_CHOICE(name, help) good &= choice_agrees(CHOICE_##name, #name, step);
    SURFACE_CHOICES(ASK_CHOICE)
    assert_true(good);
}

static void engines_agree_on_a_textured_cloth(void **state) {
    (void)state;
    need_gl();
    const char *path = WEFT_SOURCE_DIR "/../shared/data/gltf/SheenCloth/SheenCloth.gltf";
    FILE *there = fopen(path, "rb");
    if (!there) {
        print_message("%s is not there\n", path);
        skip();
    }
    fclose(there);
    static const char *const dozen[][2] = {
        {"profile", "none"},     {"profile", "khronos"},    {"profile", "three"},
        {"profile", "babylon"},  {"profile", "hdrp-silk"},  {"profile", "openpbr"},
        {"sheen_lobe", "fibre"}, {"sheen_lobe", "threads"}, {"sheen_lobe", "ashikhmin-neubelt"},
        {"layer", "albedo-max"}, {"workflow", "disney"},    {"layer", "reciprocal"}};
    WeftScene *scene = scene_of(path);
    find_inside(scene, NULL);
    weft_scene_free(scene);
    bool good = true;
    for (size_t k = 0; k < sizeof dozen / sizeof dozen[0]; k += test_short() ? 6 : test_long() ? 1 : 3) {
        char words[96];
        scene = scene_of(path);
        choose(scene, dozen[k][0], dozen[k][1]);
        snprintf(words, sizeof words, "cloth %s %s", dozen[k][0], dozen[k][1]);
        good &= engines_agree(scene, NULL, k % 2 ? WEFT_GL_ES : WEFT_GL_DESKTOP, words);
        weft_scene_free(scene);
    }
    assert_true(good);
}

/* Engines agree on light that comes through: with workflows that have it, and a light behind what is seen. */
static void engines_agree_on_light_through_cloth(void **state) {
    (void)state;
    need_gl();
    static const char *const workflows[] = {"metallic", "specular", "cloth", "free"};
    WeftScene *scene = spheres();
    find_inside(scene, "0");
    weft_scene_free(scene);
    bool good = true;
    for (size_t k = 0; k < sizeof workflows / sizeof *workflows; k++) {
        char words[96];
        scene = spheres();
        choose(scene, "workflow", workflows[k]);
        choose(scene, "diffuse_transmission", "0.6");
        choose(scene, "diffuse_transmission_color", "0.9,0.5,0.3");
        const WeftLight light = {.direction = {1.0f, 1.0f, 1.5f}, .color = {light_color, 1.0f, 1.0f}};
        assert_int_equal(weft_scene_put_light(scene, 0, &light, NULL), WEFT_OK);
        snprintf(words, sizeof words, "through %s", workflows[k]);
        good &= engines_agree(scene, "0", k % 2 ? WEFT_GL_ES : WEFT_GL_DESKTOP, words);
        weft_scene_free(scene);
    }
    assert_true(good);
}

static int begin(void **state) {
    /* Mesa's software renderer would filter 8-bit textures with 8 bits of fraction, and optimise programs that are
     * drawn with once. */
    setenv("GALLIVM_PERF", "no_aos_sampling,nopt", 1);
    return gl_begin(state);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(engines_agree_on_spheres),
                                       cmocka_unit_test(engines_agree_on_light_through_cloth),
                                       cmocka_unit_test(engines_agree_on_a_textured_cloth)};
    return cmocka_run_group_tests(tests, begin, NULL);
}
