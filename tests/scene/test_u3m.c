/* U3M, the textile industry's materials: fields, formulas of textures, millimetres, refusals in one line. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "scene/material/u3m.h"
#include "scratch.h"
#include "u3m_text.h"
#include "weft/weft.h"

static int warnings;
static char last[512];
static void note(void *user, WeftMessage message, const char *text) {
    (void)user;
    (void)message;
    assert_null(strchr(text, '\n'));
    snprintf(last, sizeof last, "%s", text);
    warnings++;
}
static const WeftLog counting = {.fn = note};

static MaterialFile file_of(const char *text) {
    MaterialFile file;
    WeftError error;
    warnings = 0;
    if (u3m_read(text, strlen(text), "x.u3m", &(U3mFiles){""}, &file, &counting, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return file;
}

static float value(const MaterialFile *file, InputId id) { return file->material.inputs[id].value[0]; }

static void near(float is, float expected) {
    if (!(fabsf(is - expected) < 1e-5f)) fail_msg("it is %.9g, not %.9g", (double)is, (double)expected);
}

static void constants_are_the_inputs_of_the_principled_brdf(void **state) {
    (void)state;
    char text[U3M_TEXT];
    u3m_text(text, "\"roughness\"", U3M_NUMBER_OF("0.25"));
    u3m_put(text, "\"basecolor\"", "{\"constant\":{\"r\":0.5,\"g\":1,\"b\":0},\"texture\":null}");
    u3m_put(text, "\"specular_value\"", U3M_NUMBER_OF("0.5"));
    u3m_put(text, "\"sheen_value\"", U3M_NUMBER_OF("0.75"));
    u3m_put(text, "\"anisotropy_rotation\"", U3M_NUMBER_OF("0.25"));
    u3m_put(text, "\"clearcoat_roughness\"", U3M_NUMBER_OF("0.125"));
    u3m_put(text, "\"transmission\"", U3M_NUMBER_OF("0.375"));
    u3m_put(text, "\"alpha\"", U3M_NUMBER_OF("0.875"));
    MaterialFile file = file_of(text);
    if (warnings) fail_msg("%s", last);
    near(value(&file, INPUT_roughness), 0.25f);
    near(value(&file, INPUT_base_color), 0.214041144f); /* ((.5 + .055) / 1.055)^2.4 */
    near(value(&file, INPUT_specular), 0.5f);           /* F0 = .08 specular = 4 % */
    near(value(&file, INPUT_sheen), 0.75f);
    near(value(&file, INPUT_anisotropy_direction), 1.57079633f); /* a quarter of a turn */
    near(value(&file, INPUT_clearcoat_gloss), 0.875f);
    near(value(&file, INPUT_clearcoat_roughness), 0.125f);
    near(value(&file, INPUT_diffuse_transmission), 0.375f);
    near(value(&file, INPUT_opacity), 0.875f);
    assert_int_equal(file.material.alpha_mode, WEFT_ALPHA_BLEND);
    assert_true(file.material.double_sided);
    const int workflow = weft_material_choice_find("workflow");
    assert_string_equal(weft_material_choice_value(workflow, file.material.choices[workflow]), "disney");
    material_file_free(&file);
}

/* Writes a picture of one colour, whose texels are r, g, b. */
static void picture(const char *path, int r, int g, int b) {
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(2, 4, 3, WEFT_PIXEL_U8, &image, &error), WEFT_OK);
    uint8_t *p = image.pixels;
    for (int k = 0; k < 8; k++) p[3 * k] = (uint8_t)r, p[3 * k + 1] = (uint8_t)g, p[3 * k + 2] = (uint8_t)b;
    assert_int_equal(weft_image_write(path, &image, &error), WEFT_OK);
    weft_image_free(&image);
}

/* Returns channel c of the first texel of an input times its factor. */
static float texel(const MaterialFile *file, InputId id, int c) {
    const Input *input = &file->material.inputs[id];
    assert_true(input->texture > 0);
    const WeftImage *image = &file->images[file->textures[input->texture - 1].image];
    WeftImage linear;
    WeftError error;
    assert_int_equal(weft_image_convert_f32(image, input_infos[id].kind == WEFT_INPUT_COLOR, &linear, &error), WEFT_OK);
    const float x = ((const float *)linear.pixels)[c] * input->value[input_infos[id].kind == WEFT_INPUT_COLOR ? c : 0];
    weft_image_free(&linear);
    return x;
}

#define IMAGE                                                                                                          \
    "\"image\":{\"dpi\":{\"x\":100,\"y\":100},\"width\":20,\"height\":40,\"path\":\"t/p.png\","                        \
    "\"repeat\":{\"mode\":\"mirror_y\",\"rotation\":0}}"

static void a_texture_is_its_factor_times_the_mean_plus_its_offset(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE], text[U3M_TEXT];
    assert_true(scratch_enter(folder));
    assert_int_equal(system("mkdir t"), 0);
    picture("t/p.png", 51, 102, 153);
    u3m_text(text, "\"roughness\"", "{\"constant\":0.3,\"texture\":{\"factor\":0.5,\"offset\":0.25," IMAGE "}}");
    MaterialFile file = file_of(text);
    near(texel(&file, INPUT_roughness, 0), 0.45f); /* .25 + .5 (.2 + .4 + .6) / 3 */
    near(file.constant[INPUT_roughness][0], 0.3f);
    near(file.span[INPUT_roughness][0], 0.02f);
    near(file.span[INPUT_roughness][1], 0.04f);
    const Texture *texture = &file.textures[file.material.inputs[INPUT_roughness].texture - 1];
    assert_true(texture->wrap_u == WRAP_REPEAT && texture->wrap_v == WRAP_MIRROR);
    material_file_free(&file);
    picture("t/p.png", 102, 102, 102); /* a grey picture without offset stays as it is, a factor says the rest */
    u3m_text(text, "\"roughness\"", "{\"constant\":0.3,\"texture\":{\"factor\":0.5,\"offset\":0," IMAGE "}}");
    u3m_put(text, "\"clearcoat_roughness\"", "{\"constant\":0,\"texture\":{\"factor\":1,\"offset\":0," IMAGE "}}");
    file = file_of(text);
    near(texel(&file, INPUT_roughness, 0), 0.2f);
    near(texel(&file, INPUT_clearcoat_gloss, 0), 0.6f);
    near(texel(&file, INPUT_clearcoat_roughness, 0), 0.4f);
    assert_int_equal(file.image_count, 2); /* one for both roughnesses, one of gloss */
    material_file_free(&file);
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

static void a_colour_is_mixed_in_linear_light(void **state) {
    static const struct {
        const char *mode;
        float expected; /* of a = .2140411, encoded .5019608 -> .2158605, and b = .5 encoded -> .2140411 */
    } modes[] = {{"multiply", 0.0462030f}, {"add", 0.4299016f}, {"subtract", 0.0018194f}, {"max", 0.2158605f},
                 {"min", 0.2140411f},      {"divide", 1.0f},    {"overlay", 0.0924060f}};
    (void)state;
    char folder[SCRATCH_SIZE], text[U3M_TEXT], field[512];
    assert_true(scratch_enter(folder));
    assert_int_equal(system("mkdir t"), 0);
    picture("t/p.png", 128, 128, 128);
    for (size_t k = 0; k < sizeof modes / sizeof *modes; k++) {
        snprintf(field, sizeof field,
                 "{\"constant\":{\"r\":1,\"g\":1,\"b\":1},\"texture\":{\"mode\":\"%s\",\"factor\":{\"r\":0.5,\"g\":0.5,"
                 "\"b\":0.5}," IMAGE "}}",
                 modes[k].mode);
        u3m_text(text, "\"basecolor\"", field);
        MaterialFile file = file_of(text);
        near(texel(&file, INPUT_base_color, 1), modes[k].expected);
        material_file_free(&file);
    }
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

static void a_picture_that_is_not_there_gives_way_to_the_constant(void **state) {
    (void)state;
    char text[U3M_TEXT];
    u3m_text(text, "\"roughness\"", "{\"constant\":0.3,\"texture\":{\"factor\":1,\"offset\":0," IMAGE "}}");
    MaterialFile file = file_of(text);
    assert_int_equal(warnings, 1);
    assert_non_null(strstr(last, "front.roughness: its constant stands for the texture: t/p.png"));
    near(value(&file, INPUT_roughness), 0.3f);
    assert_int_equal(file.material.inputs[INPUT_roughness].texture, 0);
    material_file_free(&file);
}

static void refused(const char *text, const char *words) {
    MaterialFile file;
    WeftError error = {0};
    assert_int_equal(u3m_read(text, strlen(text), "x.u3m", &(U3mFiles){""}, &file, NULL, &error), WEFT_INPUT);
    if (!strstr(error.text, words) || strchr(error.text, '\n')) fail_msg("%s lacks %s", error.text, words);
    material_file_free(&file);
}

static void faults_are_refused_in_one_line(void **state) {
    (void)state;
    static const char *const paths[] = {"../p.png", "/etc/passwd", "t/../../p.png", "t\\\\p.png", "~/p.png", "c:p.png",
                                        "",         "a//b.png",    "./p.png"};
    char text[U3M_TEXT], field[512];
    refused("", "line 1");
    refused("[]", "it is not an object");
    refused("{}", "schema: expected \"1.0\" or \"1.1\"");
    refused("{\"schema\":\"1.1\",\"material\":{\"front\":null}}", "no front, back or side");
    u3m_text(text, "\"roughness\"", "{\"constant\":\"rough\",\"texture\":null}");
    refused(text, "front.roughness: constant must be a number, not \"rough\"");
    u3m_text(text, "\"alpha\"", U3M_NUMBER_OF("1.5"));
    refused(text, "front.alpha: constant must be from 0 to 1, not 1.5");
    u3m_text(text, "\"shader\"", "\"toon\"");
    refused(text, "front.shader: the shader must be \"principled\", not \"toon\"");
    for (size_t k = 0; k < sizeof paths / sizeof *paths; k++) {
        snprintf(field, sizeof field,
                 "{\"constant\":0,\"texture\":{\"factor\":1,\"offset\":0,\"image\":{\"width\":1,\"height\":1,\"path\":"
                 "\"%s\"}}}",
                 paths[k]);
        u3m_text(text, "\"roughness\"", field);
        refused(text, "front.roughness: the path must be relative and stay in the folder of the file");
    }
}

/* The same millimetres lie on a mesh however its texture coordinates are scaled. */
static void pictures_lie_in_millimetres(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE], text[U3M_TEXT];
    assert_true(scratch_enter(folder));
    assert_int_equal(system("mkdir t"), 0);
    picture("t/p.png", 102, 102, 102);
    u3m_text(text, "\"roughness\"", "{\"constant\":0.3,\"texture\":{\"factor\":1,\"offset\":0," IMAGE "}}");
    FILE *f = fopen("x.u3m", "w");
    assert_true(f && fputs(text, f) >= 0 && fclose(f) == 0);
    WeftScene *scene = NULL;
    WeftError error;
    if (weft_scene_load("x.u3m", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    int found = 0;
    for (int k = 0; k < weft_scene_info(scene).material_count; k++) {
        WeftMaterial material;
        assert_int_equal(weft_scene_material(scene, k, &material, &error), WEFT_OK);
        const WeftInput *input = &material.inputs[INPUT_roughness];
        if (!input->texture) continue;
        found++; /* the built-in cloth has metres as texture coordinates, or so many of them in a unit */
        const float across = input->transform[0] * 0.02f, down = input->transform[4] * 0.04f;
        assert_true(across > 0.0f && fabsf(across / down - 1.0f) < 1e-5f);
    }
    assert_int_equal(found, 1);
    weft_scene_free(scene);
    WeftMaterial alone; /* without textures its constants count */
    assert_int_equal(weft_material_read("x.u3m", &alone, NULL, &error), WEFT_OK);
    near(alone.inputs[INPUT_roughness].value[0], 0.3f);
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constants_are_the_inputs_of_the_principled_brdf),
        cmocka_unit_test(a_texture_is_its_factor_times_the_mean_plus_its_offset),
        cmocka_unit_test(a_colour_is_mixed_in_linear_light),
        cmocka_unit_test(a_picture_that_is_not_there_gives_way_to_the_constant),
        cmocka_unit_test(faults_are_refused_in_one_line),
        cmocka_unit_test(pictures_lie_in_millimetres),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
