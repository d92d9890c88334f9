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

#include "raster/flat.h"
#include "trace/scenes.h"

#include "raster/frame/raster_state.h"
#include "raster/material/shader.h"
#include "text/flat/flatten.h"

static Fits fits;
static int written;

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

static void reference(ShaderKey *key) { key->reference = 1; }
static void reference_in_parts(ShaderKey *key) {
    key->reference = 2;
    key->part = WEFT_PART_SHEEN;
}
static void reference_woven(ShaderKey *key) { key->reference = key->woven = 1; }
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
                                       {"zeros", zeros},
                                       {"reference", reference},
                                       {"a part of the reference", reference_in_parts},
                                       {"the reference of a woven cloth", reference_woven}};
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

static void flat_texts_draw_the_same_pictures(void **state) {
    (void)state;
    need_gl();
    expect_same_pictures_of_choices(test_short() ? 61 : 41); /* raster/flat_choices takes all */
}

static int end(void **state) {
    fits_destroy(&fits);
    return flat_end(state);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_choice_has_a_flat_text), cmocka_unit_test(every_kind_of_light_and_part_has_a_flat_text),
        cmocka_unit_test(flat_texts_draw_the_same_pictures), cmocka_unit_test(one_flat_text_is_one_program)};
    return cmocka_run_group_tests(tests, flat_begin, end);
}
