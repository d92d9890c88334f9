/* After an update a raster draws what a new one would, byte for byte, whatever was changed; and it compiles
 * what is needed, nothing twice
 *
 * Labels: slow unsanitized */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>
#include <epoxy/gl.h>

#include "raster/gl.h"
#include "raster/made.h"
#include "scratch.h"
#include "shading/cases.h"
#include "trace/scenes.h"
#include "weft/material.h"

enum { SIDE = 64 };

static const WeftRasterView view = {.width = SIDE,
                                    .height = SIDE,
                                    .samples = 1,
                                    .camera = "0,0.9,3;0,0,0;32",
                                    .background = WEFT_BACKGROUND_ENVIRONMENT};

static WeftRaster *raster_of(const WeftScene *scene) {
    WeftRaster *raster;
    WeftError error;
    const WeftRasterDesc desc = {.threads = 1};
    if (weft_raster_create(scene, &desc, &raster, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return raster;
}

static WeftImage drawn(WeftRaster *raster) {
    WeftImage image = {0};
    WeftError error;
    if (weft_raster_draw(raster, &view, &error) != WEFT_OK || weft_raster_image(raster, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return image;
}

static bool is_same(const WeftImage *a, const WeftImage *b) {
    return memcmp(a->pixels, b->pixels, (size_t)SIDE * SIDE * 4 * sizeof(float)) == 0;
}

/* A ball with a sheen on a floor with texture coordinates, below a lamp and a sun. */
static WeftScene *under_lights(void) {
    static const float corners[8] = {0.0f, 0.3f, 0.7f, 1.0f, 1.0f, 0.7f, 0.3f, 0.0f};
    const WeftLight sun = {.direction = {-0.4f, -1.0f, -0.3f}, .color = {1.0f, 0.9f, 0.8f}};
    WeftScene *scene = test_scene();
    Material *ball = test_material(scene, 0.4f);
    test_color(ball, INPUT_sheen_color, 0.6f);
    ball->inputs[INPUT_sheen_roughness].value[0] = 0.5f;
    test_sphere(scene, vec3(0.0f, 0.0f, 0.0f), 0.5f);
    test_material(scene, 0.5f)->inputs[INPUT_specular].value[0] = 1.0f;
    Mesh *floor = test_quad(scene, vec3(-2.0f, -0.5f, 2.0f), vec3(4.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -4.0f));
    floor->texcoord[0] = arena_array(&scene->arena, 1, sizeof corners);
    memcpy(floor->texcoord[0], corners, sizeof corners);
    Material *lamp = test_material(scene, 0.0f);
    lamp->double_sided = false;
    test_color(lamp, INPUT_emission, 5.0f);
    test_quad(scene, vec3(-0.9f, 1.2f, -0.5f), vec3(0.8f, 0.0f, 0.0f), vec3(0.0f, 0.3f, 0.9f));
    scene_bounds(scene);
    test_environment(scene, 0.0f);
    assert_int_equal(weft_scene_add_light(scene, &sun, NULL), WEFT_OK);
    return scene;
}

/* A sky of one colour and a bright patch. */
static void put_sky(WeftScene *scene, float blue) {
    WeftImage sky;
    assert_int_equal(weft_image_create(64, 32, 3, WEFT_PIXEL_F32, &sky, NULL), WEFT_OK);
    float *p = sky.pixels;
    for (int k = 0; k < 64 * 32; k++, p += 3) {
        p[0] = p[1] = k % 64 > 10 && k % 64 < 20 && k / 64 > 5 && k / 64 < 12 ? 6.0f : 0.3f;
        p[2] = blue;
    }
    weft_image_free(&scene->environment.image);
    scene->environment.image = sky;
    scene->environment.kind = ENVIRONMENT_IMAGE;
    scene->environment.version++;
}

/* Two balls with a gloss and a sheen of other roughnesses, which share a program. */
static WeftScene *under_sky(void) {
    WeftScene *scene = test_scene();
    for (int k = 0; k < 2; k++) {
        float more = 0.3f * (float)k;
        Material *ball = test_material(scene, 0.2f + more);
        ball->inputs[INPUT_specular].value[0] = 1.0f;
        ball->inputs[INPUT_roughness].value[0] = 0.5f + more;
        test_color(ball, INPUT_sheen_color, 0.5f);
        ball->inputs[INPUT_sheen_roughness].value[0] = 0.3f + more;
        test_sphere(scene, vec3(1.2f * (float)k - 0.6f, 0.0f, 0.0f), 0.5f);
    }
    scene_bounds(scene);
    put_sky(scene, 0.5f);
    return scene;
}

static void set(WeftScene *scene, const char *target, const char *value) {
    WeftError error;
    if (weft_scene_set(scene, target, value, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

static void add_point(WeftScene *scene) {
    const WeftLight point = {.kind = WEFT_LIGHT_POINT, .position = {0.8f, 0.6f, 1.0f}, .color = {0.5f, 0.7f, 0.9f}};
    assert_int_equal(weft_scene_add_light(scene, &point, NULL), WEFT_OK);
}

static void turn_sun(WeftScene *scene) {
    scene->lights[0].direction = vec3_normal_or(vec3(0.5f, -1.0f, 0.2f), scene->lights[0].direction);
}

/* As weft_scene_set_variant does. */
static void swap_wear(WeftScene *scene) {
    scene->meshes[0].material = 1;
    scene->meshes[1].material = 0;
}
static void swap_back(WeftScene *scene) {
    scene->meshes[0].material = 0;
    scene->meshes[1].material = 1;
}
static void wear_one(WeftScene *scene) { scene->meshes[0].material = 1; }

/* Does what weft_scene_assign_material does: the lists grow, and a material looks up the new texture. */
static void put_texture(WeftScene *scene) {
    scene->images = arena_array(&scene->arena, 1, sizeof *scene->images);
    scene->textures = arena_array(&scene->arena, 1, sizeof *scene->textures);
    assert_int_equal(weft_image_create(4, 4, 4, WEFT_PIXEL_U8, &scene->images[0], NULL), WEFT_OK);
    unsigned char *p = scene->images[0].pixels;
    for (int k = 0; k < 64; k++) p[k] = (unsigned char)(k % 4 == 3 ? 255 : (k * 37) % 256);
    scene->image_count = scene->texture_count = 1;
    scene->materials[1].inputs[INPUT_base_color].texture = 1;
}

static void roughen(WeftScene *scene) {
    put_texture(scene);
    scene->materials[1].inputs[INPUT_base_color].texture = 0;
    scene->materials[1].inputs[INPUT_roughness].texture = 1;
}

enum { NEW = -1 };

typedef struct Step {
    const char *target, *value; /* what is set */
    void (*change)(WeftScene *scene);
    int compiled; /* shaders, by the next picture */
    int like;     /* the step after which the scene was the same, or NEW */
} Step;

static const Step steps[] = {
    {"0.base_color", "0.7,0.3,0.2", NULL, 0, NEW},
    {"0.sheen_roughness", "0.3", NULL, 0, NEW},          /* another table of E */
    {"0.sheen_lobe", "ashikhmin-neubelt", NULL, 1, NEW}, /* a term */
    {"0.sheen_lobe", "auto", NULL, 0, 1},
    {"0.sheen_lobe", "ashikhmin-neubelt", NULL, 0, 2},
    {"0.sheen_lobe", "auto", NULL, 0, 1},
    {NULL, NULL, turn_sun, 0, NEW},
    {NULL, NULL, swap_wear, 0, NEW},
    {NULL, NULL, swap_back, 0, 6},
    {"2.emission_strength", "0.5", NULL, 1, NEW}, /* it was 1, which is in the text */
    {NULL, NULL, put_texture, 1, NEW},
    {"1.base_color", "0.5", NULL, 0, 9},   /* the texture goes */
    {"1.anisotropy", "0.6", NULL, 1, NEW}, /* tangents come */
    {"1.anisotropy", "0", NULL, 0, 9},
    {"0.opacity", "0.5", NULL, 2, NEW}, /* the ball blends, and its shadow is asked for */
    {NULL, NULL, add_point, 3, NEW},
    {"2.emission_strength", "0", NULL, 3, NEW}, /* no polygon is left */
    {"2.emission_strength", "0.5", NULL, 0, 15},
};
enum { STEPS = sizeof steps / sizeof steps[0] };

/* What the light of the sky is found by is fitted to numbers, and to no texture. */
static const Step fitted_steps[] = {
    {"0.roughness", "0.7", NULL, 1, NEW}, /* its lobe is broader than the sky's lights are wide */
    {"1.sheen_roughness", "0.45", NULL, 0, NEW},
    {"0.roughness", "0.08", NULL, 1, NEW}, /* and narrow */
    {"0.roughness", "0.7", NULL, 0, 1},
    {NULL, NULL, wear_one, 0, NEW},
    {NULL, NULL, swap_back, 0, 1},
    {NULL, NULL, roughen, 1, NEW}, /* the other ball keeps its program */
    {"1.roughness", "0.8", NULL, 0, 1},
};
enum { FITTED_STEPS = sizeof fitted_steps / sizeof fitted_steps[0] };

/* Each step's picture is that of a new raster, of some in short runs, or the same as before where the scene
 * is. Frees the scene. */
static void take_steps(WeftScene *scene, const Step *all, int count) {
    WeftRaster *raster = raster_of(scene);
    WeftImage first = drawn(raster), pictures[STEPS];
    WeftError error;
    for (int k = 0; k < count; k++) {
        const Step *step = &all[k];
        const char *name = step->target ? step->target : "a change";
        int compiled = weft_raster_info(raster).compiled;
        if (step->target) set(scene, step->target, step->value);
        if (step->change) step->change(scene);
        if (weft_raster_update(raster, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        pictures[k] = drawn(raster);
        compiled = weft_raster_info(raster).compiled - compiled;
        if (compiled != step->compiled) fail_msg("step %d, %s: %d compiled, not %d", k, name, compiled, step->compiled);
        if (is_same(&pictures[k], k ? &pictures[k - 1] : &first)) fail_msg("step %d, %s: nothing has changed", k, name);
        bool asked = test_long() || k % (test_short() ? 12 : 4) == 1; /* a new raster takes a second */
        WeftRaster *fresh = step->like == NEW && asked ? raster_of(scene) : NULL;
        WeftImage should = fresh ? drawn(fresh) : pictures[step->like == NEW ? k : step->like];
        if (!is_same(&pictures[k], &should)) fail_msg("step %d, %s: not as it is otherwise", k, name);
        if (fresh) weft_image_free(&should);
        weft_raster_free(fresh);
    }
    for (int k = 0; k < count; k++) weft_image_free(&pictures[k]);
    weft_image_free(&first);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

static void changed_textures_draw_as_new_ones(void **state) {
    (void)state;
    need_gl();
    take_steps(under_lights(), steps, STEPS);
}

static void changed_fits_draw_as_new_ones(void **state) {
    (void)state;
    need_gl();
    take_steps(under_sky(), fitted_steps, FITTED_STEPS);
}

static int progress_calls;
static int on_progress(void *user, double done) {
    (void)user;
    assert_true(done >= 0.0 && done <= 1.0);
    progress_calls++;
    return 0;
}

/* Turning and dimming filters nothing; another image does, once. What hides its lights is found again. */
static void changed_environment_draws_as_a_new_one(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = test_scene();
    test_material(scene, 0.5f);
    test_sphere(scene, vec3(0.0f, 0.0f, 0.0f), 0.5f);
    test_quad(scene, vec3(-0.6f, -1.0f, 0.6f), vec3(0.4f, 0.0f, 0.0f), vec3(0.0f, 2.0f, 0.0f));
    scene_bounds(scene);
    WeftError error;
    WeftRaster *raster;
    const WeftRasterDesc desc = {.threads = 1, .occlusion = 8, .progress = on_progress};
    put_sky(scene, 0.5f);
    assert_int_equal(weft_scene_set_environment_placement(scene, 0.0f, 0.0f, &error), WEFT_OK);
    assert_int_equal(weft_raster_create(scene, &desc, &raster, NULL, &error), WEFT_OK);
    assert_int_equal(progress_calls, 0); /* it is dark */
    WeftImage before = drawn(raster);
    for (int k = 0; k < 5; k++) {
        progress_calls = 0;
        if (k == 2) put_sky(scene, 1.5f);
        if (k == 4) test_environment(scene, 0.0f);
        assert_int_equal(weft_scene_set_environment_placement(scene, 40.0f * (float)(k + 1), 1.0f, &error), WEFT_OK);
        if (weft_raster_update(raster, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        assert_int_equal(progress_calls > 0, k == 0 || k == 2);
        WeftRaster *fresh;
        assert_int_equal(weft_raster_create(scene, &desc, &fresh, NULL, &error), WEFT_OK);
        assert_int_equal(weft_raster_wait(raster, &error), WEFT_OK);
        assert_int_equal(weft_raster_wait(fresh, &error), WEFT_OK);
        WeftImage is = drawn(raster), should = drawn(fresh);
        if (!is_same(&is, &should)) fail_msg("environment %d: not as a new raster draws it", k);
        if (is_same(&is, &before)) fail_msg("environment %d: nothing has changed", k);
        weft_raster_free(fresh);
        weft_image_free(&before);
        weft_image_free(&should);
        before = is;
    }
    weft_image_free(&before);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

/* A picture of so many pixels a side and channels. */
static WeftImage pattern(int side, int channels, WeftPixelType type, int seed) {
    WeftImage image;
    assert_int_equal(weft_image_create(side, side, channels, type, &image, NULL), WEFT_OK);
    for (int k = 0; k < side * side * channels; k++) {
        int value = (k * 37 + k / side * 11 + seed * 101) % 256;
        if (type == WEFT_PIXEL_U8) ((unsigned char *)image.pixels)[k] = (unsigned char)value;
        if (type == WEFT_PIXEL_F32) ((float *)image.pixels)[k] = (float)value / 255.0f;
    }
    return image;
}

static const struct {
    int texture, side, channels;
    WeftPixelType type;
    bool made; /* all are uploaded anew */
} puts_of[] = {{1, 8, 4, WEFT_PIXEL_U8, false},  {2, 8, 1, WEFT_PIXEL_U8, false}, {3, 16, 3, WEFT_PIXEL_F32, false},
               {1, 8, 3, WEFT_PIXEL_U8, false},  {1, 16, 3, WEFT_PIXEL_U8, true}, {1, 16, 3, WEFT_PIXEL_F32, true},
               {1, 16, 4, WEFT_PIXEL_F32, false}};

/* Other pixels in the place of a texture's are seen, the same kind of them without another texture made: of a
 * coloured map, of one that lets light pass, and of one that shines. */
static void updated_scene_draws_as_a_new_one(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = under_lights();
    WeftError error;
    const WeftImage kinds[] = {pattern(8, 3, WEFT_PIXEL_U8, 0), pattern(8, 1, WEFT_PIXEL_U8, 1),
                               pattern(16, 3, WEFT_PIXEL_F32, 2)};
    static const InputId inputs[] = {INPUT_base_color, INPUT_opacity, INPUT_emission};
    for (int k = 0; k < 3; k++) {
        WeftImage image = kinds[k];
        assert_int_equal(weft_scene_add_texture(scene, &image, &error), k + 1);
        assert_null(image.pixels);
        scene->materials[k == 2 ? 2 : 1].inputs[inputs[k]].texture = k + 1;
    }
    scene->materials[1].alpha_mode = WEFT_ALPHA_MASK;
    WeftRaster *raster = raster_of(scene);
    WeftImage before = drawn(raster);
    for (size_t k = 0; k < sizeof puts_of / sizeof *puts_of; k++) {
        WeftImage image = pattern(puts_of[k].side, puts_of[k].channels, puts_of[k].type, (int)k + 5);
        assert_int_equal(weft_scene_put_texture(scene, puts_of[k].texture, &image, &error), WEFT_OK);
        COUNTED(COUNT)
        made = 0;
        if (weft_raster_update(raster, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        COUNTED(STOP_COUNTING)
        if ((made > 0) != puts_of[k].made) fail_msg("pixels %zu: %d things were made", k, made);
        WeftRaster *fresh = raster_of(scene);
        WeftImage is = drawn(raster), should = drawn(fresh);
        if (!is_same(&is, &should)) fail_msg("pixels %zu: not as a new raster draws them", k);
        if (is_same(&is, &before)) fail_msg("pixels %zu: nothing has changed", k);
        weft_raster_free(fresh);
        weft_image_free(&before);
        weft_image_free(&should);
        before = is;
    }
    weft_image_free(&before);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

static char cache[SCRATCH_SIZE];

static int begin(void **state) {
    if (!scratch_cache(cache)) return -1;
    return gl_begin(state);
}

static int end(void **state) {
    (void)state;
    return scratch_remove(cache) ? 0 : -1;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(changed_textures_draw_as_new_ones), cmocka_unit_test(changed_fits_draw_as_new_ones),
        cmocka_unit_test(updated_scene_draws_as_a_new_one), cmocka_unit_test(changed_environment_draws_as_a_new_one)};
    return cmocka_run_group_tests(tests, begin, end);
}
