/* Every choice of a material, every part and kind of light has a flat text, which compilers of GLSL 3.30 and ES 3.00
 * take and which draws the picture of the text as it is written. `?:` between records, which WebGL refuses, would be a
 * gap of the flattening: there is none.
 *
 * Labels: unsanitized */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "raster/gl.h"
#include "trace/scenes.h"

#include "raster/frame/raster_state.h"
#include "raster/material/shader.h"
#include "scratch.h"
#include "shading/cases.h"
#include "shading/material/choice.h"
#include "text/flat/flatten.h"
#include "weft/weft.h"

static Fits fits;
static char folder[SCRATCH_SIZE];
static int written;

static const ChoiceId choices[] = {
#define ONE_CHOICE(name, help) CHOICE_##name,
    SURFACE_CHOICES(ONE_CHOICE)};
static const char *const choice_names[] = {
#define ONE_NAME(name, help) #name,
    SURFACE_CHOICES(ONE_NAME)};
enum { CHOICES = sizeof choices / sizeof choices[0] };

/* A material with maps under all kinds of light. */
static ShaderKey whole_key(void) {
    ShaderKey key;
    memset(&key, 0, sizeof key);
    key.choices = choices_unmade();
    for (int k = 0; k < INPUT_COUNT; k++) key.inputs[k].like = -1;
    key.inputs[INPUT_base_color].state = key.inputs[INPUT_normal].state = INPUT_MAP;
    key.inputs[INPUT_normal].slot = 1;
    key.shadowed = key.colored = key.ambient = 1;
    key.lights = 2;
    key.light_kind[0] = 2;
    key.light_map[1] = -1;
    key.polygons = 3;
    for (int k = 0; k < 3; k++) key.polygon_corners[k] = (int16_t)(k < 2 ? 4 : 8);
    return key;
}

static void make_choice(Choices *made, int choice, int value) {
    int *const all[] = {
#define ONE_MEMBER(name, help) &made->name,
        SURFACE_CHOICES(ONE_MEMBER)};
    *all[choice] = value;
}

/* The pointer of the choice's value: a lobe of the reference alone has no text for GPUs. */
static bool is_on_gpu(int choice, int value) {
    if (!choice_fits(choices[choice], value)) return false;
    const bool lobe = choices[choice] == CHOICE_sheen_lobe || choices[choice] == CHOICE_diffuse;
    return !lobe || !(weft_lobe_info(value)->traits & WEFT_LOBE_REFERENCE);
}

static void write_file(const char *bytes, TextLanguage language) {
    char path[96];
    snprintf(path, sizeof path, "%s/%03d-%d.frag", folder, written++, (int)language);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fputs(bytes, stream) >= 0);
    assert_int_equal(fclose(stream), 0);
}

/* Flattens a shader, and leaves its flat text in the folder. */
static void ask(const ShaderKey *key, TextLanguage language, const char *name, bool write) {
    Text text;
    WeftError error;
    FlattenGap gap = {""};
    Buffer flat = {0};
    shader_text(key, &(TextDesc){.language = language, .tables = true}, &fits, &text);
    if (text_end(&text, &error) != WEFT_OK) fail_msg("%s: %s", name, error.text);
    if (!flatten_text(text.bytes, &flat, &gap)) fail_msg("%s is not flattened: %s", name, gap.what);
    assert_null(strstr(flat.bytes, "struct"));
    assert_null(strstr(flat.bytes, "Stack"));
    if (write) write_file(flat.bytes, language);
    buffer_free(&flat);
    text_free(&text);
}

static void compile_files(void) {
    char command[256];
    if (system("command -v glslangValidator >/dev/null 2>&1") != 0) {
        print_message("glslangValidator is not installed: nothing is compiled\n");
        return;
    }
    snprintf(command, sizeof command,
             "cd %s && s=0; for f in *.frag; do glslangValidator -S frag $f >log 2>&1 || { s=1; echo $f; grep -v "
             "'^$' log | head -5; }; done; rm -f *.frag log; exit $s",
             folder);
    assert_int_equal(system(command), 0);
}

/* The value of every choice; compiled are some of them, in long runs all. */
static void every_choice_has_a_flat_text(void **state) {
    (void)state;
    const int step = test_long() ? 1 : test_short() ? 12 : 5;
    int asked = 0;
    for (int choice = 0; choice < CHOICES; choice++)
        for (int value = 0; choice_id(choices[choice], value); value++) {
            char name[96];
            ShaderKey key = whole_key();
            if (!is_on_gpu(choice, value)) continue;
            make_choice(&key.choices, choice, value);
            snprintf(name, sizeof name, "%s %s", choice_names[choice], choice_id(choices[choice], value));
            ask(&key, asked % 2 ? TEXT_GLSL_330 : TEXT_GLSL_ES_300, name, asked % step == 0);
            asked++;
        }
    assert_true(asked > 100);
    compile_files();
}

typedef struct Variant {
    const char *name;
    void (*change)(ShaderKey *key);
} Variant;

static void no_lights(ShaderKey *key) { key->lights = key->polygons = key->ambient = key->shadowed = 0; }
static void many_lights(ShaderKey *key) { key->lights = 40; }
static void polygons(ShaderKey *key) {
    key->polygons = 8;
    for (int k = 0; k < 8; k++) key->polygon_corners[k] = (int16_t)(3 + k % 6);
    key->polygon_two_sided[3] = 1;
    key->polygon_map[2] = -1;
}
static void irradiance(ShaderKey *key) { key->ambient = 2 + AMBIENT_IRRADIANCE; }
static void mirror(ShaderKey *key) { key->ambient = 2 + AMBIENT_MIRROR; }
static void sampled(ShaderKey *key) { key->ambient = 2 + AMBIENT_SAMPLED; }
static void ranged(ShaderKey *key) { key->ranged = 1; }
static void features(ShaderKey *key) { key->focus = key->narrow = key->by_azimuth = key->dense = 31; }
static void masked(ShaderKey *key) { key->alpha_mode = WEFT_ALPHA_MASK; }
static void blended(ShaderKey *key) { key->alpha_mode = WEFT_ALPHA_BLEND; }
static void unlit(ShaderKey *key) { key->unlit = 1; }
static void woven(ShaderKey *key) { key->woven = 1; }
static void woven_masked(ShaderKey *key) {
    key->woven = 1;
    key->alpha_mode = WEFT_ALPHA_MASK;
}
static void floor_alone(ShaderKey *key) {
    key->floor = 1;
    key->ambient = 0;
}
static void depth(ShaderKey *key) {
    key->depth = 1;
    key->alpha_mode = WEFT_ALPHA_MASK;
    key->inputs[INPUT_opacity].state = INPUT_MAP;
}
static void depth_woven(ShaderKey *key) {
    depth(key);
    key->woven = 1;
}
static void maybe(ShaderKey *key) {
    key->inputs[INPUT_base_color].state = INPUT_MAYBE;
    key->inputs[INPUT_roughness].state = INPUT_MAYBE;
}
static void zeros(ShaderKey *key) {
    for (int k = 0; k < INPUT_COUNT; k++) key->inputs[k].state = INPUT_ZERO;
}

static void every_kind_of_light_and_part_has_a_flat_text(void **state) {
    (void)state;
    static const Variant variants[] = {{"no lights", no_lights},
                                       {"many lights", many_lights},
                                       {"polygons", polygons},
                                       {"irradiance", irradiance},
                                       {"mirror", mirror},
                                       {"sampled", sampled},
                                       {"ranged", ranged},
                                       {"all features", features},
                                       {"masked", masked},
                                       {"blended", blended},
                                       {"unlit", unlit},
                                       {"woven", woven},
                                       {"a woven mask", woven_masked},
                                       {"floor", floor_alone},
                                       {"depth", depth},
                                       {"woven depth", depth_woven},
                                       {"maps of some", maybe},
                                       {"zeros", zeros}};
    for (size_t k = 0; k < sizeof variants / sizeof variants[0]; k++) {
        ShaderKey key = whole_key();
        variants[k].change(&key);
        ask(&key, k % 2 ? TEXT_GLSL_330 : TEXT_GLSL_ES_300, variants[k].name, true);
    }
    for (int part = 0; part <= WEFT_PART_TEXCOORD; part++) {
        ShaderKey key = whole_key();
        key.part = part;
        ask(&key, part % 2 ? TEXT_GLSL_330 : TEXT_GLSL_ES_300, "a part", part % 3 == 0);
    }
    compile_files();
}

enum { WIDTH = 96, HEIGHT = 54 };

static void set(WeftScene *scene, const char *target, const char *value) {
    WeftError error;
    if (weft_scene_set(scene, target, value, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

/* Spheres under a sun, a polygon and a coloured sky. */
static WeftScene *spheres(void) {
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load("builtin:spheres", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    const WeftLight sun = {.direction = {-1.0f, -2.0f, -1.0f}, .color = {3.0f, 2.8f, 2.5f}};
    assert_int_equal(weft_scene_add_light(scene, &sun, &error), WEFT_OK);
    assert_int_equal(weft_scene_set_environment_color(scene, (const float[]){0.3f, 0.4f, 0.5f}, &error), WEFT_OK);
    return scene;
}

/* Draws a scene, by the texts as they are written if `plain`: a folder without files does that. */
static WeftImage draw(const WeftScene *scene, WeftGl gl, bool plain) {
    WeftRaster *raster;
    WeftImage image;
    WeftError error;
    const WeftRasterDesc desc = {.gl = gl, .shader_dir = plain ? folder : NULL, .occlusion = 8};
    const WeftRasterView view = {
        .width = WIDTH, .height = HEIGHT, .samples = 1, .background = WEFT_BACKGROUND_COLOR, .plain_textures = 1};
    if (weft_raster_create(scene, &desc, &raster, NULL, &error) != WEFT_OK ||
        weft_raster_draw(raster, &view, &error) != WEFT_OK || weft_raster_image(raster, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    assert_string_equal(weft_raster_info(raster).complaint, "");
    weft_raster_free(raster);
    return image;
}

/* Asserts that both pictures are the same to 1e-4 of their light, and at each pixel to a step of their 16 bits. */
static void expect_same_pictures(const WeftScene *scene, WeftGl gl, const char *name) {
    WeftImage flat = draw(scene, gl, false), plain = draw(scene, gl, true);
    const float *a = flat.pixels, *b = plain.pixels;
    double difference = 0.0, sum = 0.0, worst = 0.0;
    for (int k = 0; k < 4 * WIDTH * HEIGHT; k++) {
        if (k % 4 == 3) continue;
        const double x = (double)a[k], y = (double)b[k];
        difference += fabs(x - y);
        sum += fabs(y);
        worst = fmax(worst, fabs(x - y) / (fabs(y) + 0.01));
    }
    print_message("%s: %.2g of the light, a pixel %.2g\n", name, difference / sum, worst);
    assert_true(sum > 100.0);
    assert_true(difference <= 1e-4 * sum);
    assert_true(worst < 4e-3);
    weft_image_free(&flat);
    weft_image_free(&plain);
}

static void flat_texts_draw_the_same_pictures(void **state) {
    (void)state;
    need_gl();
    const int step = test_long() ? 1 : test_short() ? 47 : 23;
    int count = 0;
    for (int choice = 0; choice < CHOICES; choice++)
        for (int value = 0; choice_id(choices[choice], value); value++) {
            char target[64], name[96];
            const char *id = choice_id(choices[choice], value);
            if (!is_on_gpu(choice, value) || strcmp(id, "stochastic") == 0 || count++ % step) continue;
            WeftScene *scene = spheres();
            snprintf(target, sizeof target, "*.%s", choice_names[choice]);
            if (choices[choice] == CHOICE_convert)
                set(scene, "*.workflow", strcmp(id, "metallic") == 0 ? "specular" : "metallic");
            set(scene, target, id);
            snprintf(name, sizeof name, "%s %s", choice_names[choice], id);
            expect_same_pictures(scene, count % 2 ? WEFT_GL_DESKTOP : WEFT_GL_ES, name);
            weft_scene_free(scene);
        }
}

/* Two materials that differ in what their flat text does not have are drawn by one program; a third has its own. */
static void one_flat_text_is_one_program(void **state) {
    (void)state;
    need_gl();
    WeftScene *scene = test_scene();
    for (int k = 0; k < 3; k++) {
        Material *material = test_material(scene, 0.5f);
        material->double_sided = k == 1;
        material->unlit = k == 2;
        test_quad(scene, vec3(-1.5f + (float)k, -1.0f, 0.0f), vec3(0.8f, 0.0f, 0.0f), vec3(0.0f, 2.0f, 0.0f));
    }
    scene_bounds(scene);
    test_environment(scene, 0.5f);
    const WeftRasterView view = {.width = WIDTH, .height = HEIGHT, .samples = 1};
    for (int plain = 0; plain < 2; plain++) {
        WeftRaster *raster;
        WeftError error;
        unsigned names[3] = {0};
        int count = 0;
        const WeftRasterDesc desc = {.shader_dir = plain ? folder : NULL, .occlusion = 8};
        if (weft_raster_create(scene, &desc, &raster, NULL, &error) != WEFT_OK ||
            weft_raster_draw(raster, &view, &error) != WEFT_OK)
            fail_msg("%s", error.text);
        for (const Program *p = raster->programs.first; p; p = p->next) {
            assert_true(count < 3);
            names[p->key.unlit ? 2 : p->key.double_sided] = p->name;
            count++;
        }
        assert_int_equal(count, 3);
        assert_true(names[0] && names[1] && names[2]);
        assert_int_equal(names[0] == names[1], !plain);
        assert_true(names[0] != names[2]);
        weft_raster_free(raster);
    }
    weft_scene_free(scene);
}

static int begin(void **state) { return scratch_make(folder) ? gl_begin(state) : 1; }

static int end(void **state) {
    (void)state;
    fits_destroy(&fits);
    return scratch_remove(folder) ? 0 : 1;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_choice_has_a_flat_text), cmocka_unit_test(every_kind_of_light_and_part_has_a_flat_text),
        cmocka_unit_test(flat_texts_draw_the_same_pictures), cmocka_unit_test(one_flat_text_is_one_program)};
    return cmocka_run_group_tests(tests, begin, end);
}
