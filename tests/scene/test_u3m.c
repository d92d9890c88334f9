/* U3M, the textile industry's materials: fields, formulas of textures, millimetres, refusals in one line. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zip.h>

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
    if (u3m_read(text, strlen(text), "x.u3m", &(U3mFiles){.folder = ""}, &file, &counting, &error) != WEFT_OK)
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
    assert_int_equal(u3m_read(text, strlen(text), "x.u3m", &(U3mFiles){.folder = ""}, &file, NULL, &error), WEFT_INPUT);
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

/* Writes a zip of files: path, contents, path, contents, and so on to NULL. */
static void pack(const char *path, const char *const *files) {
    int why;
    zip_t *zip = zip_open(path, ZIP_CREATE | ZIP_TRUNCATE, &why);
    assert_non_null(zip);
    for (int k = 0; files[k]; k += 2) {
        zip_source_t *source = zip_source_buffer(zip, files[k + 1], strlen(files[k + 1]), 0);
        assert_true(source && zip_file_add(zip, files[k], source, ZIP_FL_ENC_UTF_8) >= 0);
    }
    assert_int_equal(zip_close(zip), 0);
}

static void load_refused(const char *words) {
    MaterialFile file;
    WeftError error = {0};
    const WeftResult result = u3m_load("x.u3ma", &file, NULL, &error);
    if (result != WEFT_INPUT || !strstr(error.text, words) || strchr(error.text, '\n'))
        fail_msg("%s lacks %s", error.text, words);
    material_file_free(&file);
}

/* Replaces four bytes of x.u3ma after each mark, whose offset from it is at. */
static void forge(const char *mark, long at, unsigned value) {
    FILE *f = fopen("x.u3ma", "r+b");
    char bytes[8192];
    assert_non_null(f);
    const size_t size = fread(bytes, 1, sizeof bytes, f);
    for (size_t k = 0; k + 46 < size; k++)
        if (memcmp(bytes + k, mark, 4) == 0) memcpy(bytes + k + at, &value, 4);
    rewind(f);
    assert_int_equal(fwrite(bytes, 1, size, f), size);
    assert_int_equal(fclose(f), 0);
}

static void archives_are_read_and_hostile_ones_refused(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE], text[U3M_TEXT];
    assert_true(scratch_enter(folder));
    assert_int_equal(system("mkdir t"), 0);
    u3m_text(text, "\"roughness\"", "{\"constant\":0.3,\"texture\":{\"factor\":1,\"offset\":0," IMAGE "}}");
    pack("x.u3ma", (const char *const[]){"cloth/c.u3m", text, NULL}); /* the picture is missing */
    MaterialFile file;
    WeftError error;
    warnings = 0;
    assert_int_equal(u3m_load("x.u3ma", &file, &counting, &error), WEFT_OK);
    near(value(&file, INPUT_roughness), 0.3f);
    assert_int_equal(warnings, 1);
    assert_non_null(strstr(last, "the archive has no cloth/t/p.png"));
    material_file_free(&file);
    picture("t/p.png", 102, 102, 102);
    int why;
    zip_t *zip = zip_open("x.u3ma", 0, &why);
    assert_true(zip && zip_file_add(zip, "cloth/t/p.png", zip_source_file(zip, "t/p.png", 0, -1), 0) >= 0);
    assert_int_equal(zip_close(zip), 0);
    assert_int_equal(u3m_load("x.u3ma", &file, NULL, &error), WEFT_OK);
    near(texel(&file, INPUT_roughness, 0), 0.4f);
    material_file_free(&file);
    pack("x.u3ma", (const char *const[]){"c.u3m", text, "../p.png", "x", NULL});
    load_refused("would lie outside the archive's folder");
    pack("x.u3ma", (const char *const[]){"c.u3m", text, "/p.png", "x", NULL});
    load_refused("would lie outside the archive's folder");
    pack("x.u3ma", (const char *const[]){"c.u3m", text, "d.u3m", text, NULL});
    load_refused("is a second .u3m");
    pack("x.u3ma", (const char *const[]){"c.json", text, NULL});
    load_refused("has no .u3m");
    pack("x.u3ma", (const char *const[]){"c.u3m", text, NULL});
    forge("PK\1\2", 24, 0x7fffffffu); /* 2 GiB, as a bomb says */
    forge("PK\3\4", 22, 0x7fffffffu);
    load_refused("is too large");
    assert_int_equal(truncate("x.u3ma", 300), 0);
    load_refused("the archive:");
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

#define PHYSICS(construction, fibre)                                                                                   \
    "{\"thickness\":0.4,\"weight\":180,\"devices\":{\"fab\":\"null\"},\"composition\":{\"parts\":[{\"ratio\":0.3,"     \
    "\"type\":"                                                                                                        \
    "\"Cotton\",\"name\":null},{\"ratio\":0.7,\"type\":\"" fibre "\",\"name\":null}]},\"material_type\":{\"type\":"    \
    "\"Woven\",\"name\":null},\"construction\":{\"type\":\"" construction "\",\"name\":null}}"

static void a_cloth_without_a_texture_is_woven_by_its_construction(void **state) {
    (void)state;
    char text[U3M_TEXT];
    u3m_text(text, "\"physics\"", PHYSICS("Twill - left hand (S)", "Wild Silk"));
    MaterialFile file = file_of(text);
    assert_non_null(file.cloth);
    assert_int_equal(warnings, 1);
    assert_non_null(strstr(last, "twill 2/2 s; sett 30 24 of dupion"));
    material_file_free(&file);
    u3m_text(text, "\"physics\"", PHYSICS("Single jersey", "Wool")); /* no weave */
    file = file_of(text);
    assert_true(!file.cloth && warnings == 0);
    material_file_free(&file);
    u3m_text(text, "\"physics\"", PHYSICS("Twill", "Wool"));
    u3m_put(text, "\"roughness\"", "{\"constant\":0.3,\"texture\":{\"factor\":1,\"offset\":0," IMAGE "}}");
    file = file_of(text);
    assert_null(file.cloth); /* it has a picture, though that is missing here */
    material_file_free(&file);
}

static void the_back_is_read_beside_the_front(void **state) {
    (void)state;
    char text[U3M_TEXT], back[U3M_TEXT];
    snprintf(back, sizeof back, "%s", U3M_VISUAL);
    u3m_put(back, "\"roughness\"", U3M_NUMBER_OF("0.125"));
    u3m_text(text, "\"back\"", back);
    MaterialFile file = file_of(text);
    assert_non_null(file.back);
    near(value(&file, INPUT_roughness), 0.7f);
    near(value(file.back, INPUT_roughness), 0.125f);
    material_file_free(&file);
    u3m_put(text, "\"front\"", "null");
    file = file_of(text);
    assert_null(file.back);
    near(value(&file, INPUT_roughness), 0.125f);
    material_file_free(&file);
}

/* Changes, drops or repeats a byte of size bytes in place. Returns the new size. */
static size_t damage(char *bytes, size_t size, unsigned *state) {
    *state = *state * 1664525u + 1013904223u;
    const size_t at = (*state >> 8) % size;
    switch (*state >> 30) {
    case 0: memmove(bytes + at, bytes + at + 1, size - at - 1); return size - 1;
    case 1: bytes[at] = (char)(bytes[at] ^ (1 << (*state >> 26 & 7u))); return size;
    case 2: bytes[at] = "\"{}[],:0e-"[*state >> 20 & 7u]; return size;
    default: return at > 64 ? at : size; /* cut off */
    }
}

static void judge(WeftResult result, MaterialFile *file, const WeftError *error) {
    if (result != WEFT_OK) assert_true(error->text[0] && !strchr(error->text, '\n'));
    for (int k = 0; result == WEFT_OK && k < INPUT_COUNT; k++) assert_true(isfinite(file->material.inputs[k].value[0]));
    material_file_free(file);
}

static void damaged_files_are_read_or_refused(void **state) {
    enum { ROUNDS = 20000 };
    (void)state;
    char folder[SCRATCH_SIZE], text[U3M_TEXT], bytes[U3M_TEXT];
    assert_true(scratch_enter(folder));
    u3m_text(text, "\"roughness\"", "{\"constant\":0.3,\"texture\":{\"factor\":1,\"offset\":0," IMAGE "}}");
    pack("x.u3ma", (const char *const[]){"c.u3m", text, "t/p.png", "x", NULL});
    FILE *f = fopen("x.u3ma", "rb");
    char whole[U3M_TEXT];
    const size_t packed = f ? fread(whole, 1, sizeof whole, f) : 0;
    assert_true(packed > 0 && packed < sizeof whole && fclose(f) == 0);
    unsigned seed = 1;
    for (int k = 0; k < ROUNDS; k++) {
        MaterialFile file;
        WeftError error = {0};
        size_t size = strlen(text);
        memcpy(bytes, text, size);
        for (int n = 0; n <= k % 3; n++) size = damage(bytes, size, &seed);
        judge(u3m_read(bytes, size, "x.u3m", &(U3mFiles){.folder = NULL}, &file, NULL, &error), &file, &error);
        U3mArchive *archive;
        FileBytes read = {0};
        size = packed;
        memcpy(bytes, whole, size);
        for (int n = 0; n <= k % 3; n++) size = damage(bytes, size, &seed);
        if (u3m_archive_open(bytes, size, "x.u3ma", &archive, &error) != WEFT_OK) {
            assert_true(error.text[0] && !strchr(error.text, '\n'));
            continue;
        }
        if (u3m_archive_read(archive, u3m_archive_material(archive), &read, &error) != WEFT_OK)
            assert_null(strchr(error.text, '\n'));
        free(read.data);
        u3m_archive_close(archive);
    }
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
        cmocka_unit_test(archives_are_read_and_hostile_ones_refused),
        cmocka_unit_test(damaged_files_are_read_or_refused),
        cmocka_unit_test(a_cloth_without_a_texture_is_woven_by_its_construction),
        cmocka_unit_test(the_back_is_read_beside_the_front),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
