/* U3M as it is written: byte for byte where nothing changed, by the schema, with the same numbers when it is read. */
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

#include "base/file.h"
#include "scene/material/cloth_fit.h"
#include "scene/material/u3m.h"
#include "scratch.h"
#include "u3m_text.h"
#include "weft/weft.h"

static int warnings;
static char said[4096]; /* all warnings, a line each */
static void note(void *user, WeftMessage message, const char *text) {
    (void)user;
    (void)message;
    assert_null(strchr(text, '\n'));
    snprintf(said + strlen(said), sizeof said - strlen(said), "%s\n", text);
    warnings++;
}
static const WeftLog counting = {.fn = note};

static void silence(void) {
    warnings = 0;
    said[0] = '\0';
}

static void expect_said(const char *words) {
    if (!strstr(said, words)) fail_msg("%s lacks %s", said, words);
}

static void near(float is, float expected) {
    if (!(fabsf(is - expected) < 2e-6f)) fail_msg("it is %.9g, not %.9g", (double)is, (double)expected);
}

/* Writes a picture whose texels have a grey of their own; texel k is r + k in red, and so on. */
static void picture(const char *path, int r, int g, int b) {
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(2, 4, 3, WEFT_PIXEL_U8, &image, &error), WEFT_OK);
    uint8_t *p = image.pixels;
    for (int k = 0; k < 8; k++)
        p[3 * k] = (uint8_t)(r + k), p[3 * k + 1] = (uint8_t)(g + k), p[3 * k + 2] = (uint8_t)(b + k);
    assert_int_equal(weft_image_write(path, &image, &error), WEFT_OK);
    weft_image_free(&image);
}

static void text_write(const char *path, const char *text) {
    FILE *f = fopen(path, "w");
    assert_true(f && fputs(text, f) >= 0 && fclose(f) == 0);
}

static FileBytes bytes_of(const char *path) {
    FileBytes bytes;
    WeftError error;
    if (file_read(path, 1 << 20, &bytes, &error) != WEFT_OK) fail_msg("%s", error.text);
    return bytes;
}

static void same_bytes(const char *a, const char *b) {
    FileBytes x = bytes_of(a), y = bytes_of(b);
    if (x.size != y.size || memcmp(x.data, y.data, x.size) != 0) fail_msg("%s differs from %s", a, b);
    free(x.data);
    free(y.data);
}

static WeftScene *scene_of(const char *path) {
    WeftScene *scene = NULL;
    WeftError error;
    if (weft_scene_load(path, &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

/* Returns the material that has a U3M or, if none has, the cloth of builtin:cloth. */
static int cloth_of(const WeftScene *scene) {
    for (int k = 0; k < weft_scene_info(scene).material_count; k++)
        if (u3m_source(scene, k)) return k;
    return 0;
}

static void save(const WeftScene *scene, const char *path) {
    WeftError error;
    silence();
    if (weft_scene_save_u3m(scene, cloth_of(scene), path, NULL, &counting, &error) != WEFT_OK)
        fail_msg("%s", error.text);
}

static void save_refused(const WeftScene *scene, const char *path, const char *words) {
    WeftError error = {0};
    assert_int_not_equal(weft_scene_save_u3m(scene, cloth_of(scene), path, NULL, NULL, &error), WEFT_OK);
    if (!strstr(error.text, words) || strchr(error.text, '\n')) fail_msg("%s lacks %s", error.text, words);
}

#define IMAGE(path)                                                                                                    \
    "\"image\":{\"dpi\":{\"x\":100,\"y\":100},\"width\":20,\"height\":40,\"path\":\"" path                             \
    "\",\"repeat\":{\"mode\":\"mirror_y\",\"rotation\":0}}"

/* Makes x.u3m with a texture and members that no reader knows, each number in a spelling of its own. */
static void strange_write(void) {
    char text[U3M_TEXT];
    assert_int_equal(system("mkdir t"), 0);
    picture("t/p.png", 51, 102, 153);
    text_write("t/cloth.fab", "measured");
    u3m_text(text, "\"roughness\"",
             "{\"constant\":0.30,\"texture\":{\"factor\":5e-1,\"offset\":0.250," IMAGE("t/p.png") "}}");
    u3m_put(text, "\"custom\"", "{ \"maker\" : [1.50e+0,  \"\\u00e9\" ] }");
    u3m_put(text, "\"physics\"",
            "{\"thickness\":0.40,\"weight\":1.80e2,\"devices\":{\"fab\":\"t/cloth.fab\"},\"bend\":[1.0, 2.00],"
            "\"composition\":null,\"material_type\":null,\"construction\":null}");
    u3m_put(text, "\"metadata\"", "{\"plm\": 12345678901234567}");
    u3m_put(text, "\"subsurface_radius\"", U3M_NUMBER_OF("0.125"));
    text_write("x.u3m", text);
}

static void members_that_did_not_change_are_written_byte_for_byte(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE];
    assert_true(scratch_enter(folder));
    strange_write();
    assert_int_equal(system("mkdir a b"), 0);
    WeftScene *scene = scene_of("x.u3m");
    save(scene, "a/y.u3m");
    if (warnings) fail_msg("%s", said);
    same_bytes("x.u3m", "a/y.u3m");
    same_bytes("t/p.png", "a/t/p.png");
    same_bytes("t/cloth.fab", "a/t/cloth.fab");
    save(scene, "x.u3ma");
    weft_scene_free(scene);
    scene = scene_of("x.u3ma");
    save(scene, "b/x.u3m");
    same_bytes("x.u3m", "b/x.u3m");
    same_bytes("t/p.png", "b/t/p.png");
    same_bytes("t/cloth.fab", "b/t/cloth.fab");
    save(scene, "b/x.u3ma"); /* an archive of an archive */
    same_bytes("x.u3ma", "b/x.u3ma");
    text_write("b/t/cloth.fab", "another");
    save_refused(scene, "b/x.u3m", "b/t/cloth.fab: cannot be written: another file of that name is there");
    save_refused(scene, "x.json", "a U3M is a .u3m or a .u3ma");
    weft_scene_free(scene);
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

static void only_what_changed_is_replaced(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE], expected[U3M_TEXT];
    WeftError error;
    assert_true(scratch_enter(folder));
    strange_write();
    WeftScene *scene = scene_of("x.u3m");
    assert_int_equal(weft_scene_set(scene, "*.sheen", "0.75", NULL, &error), WEFT_OK);
    assert_int_equal(weft_scene_set(scene, "*.clearcoat_gloss", "0.875", NULL, &error), WEFT_OK);
    save(scene, "y.u3m");
    weft_scene_free(scene);
    FileBytes was = bytes_of("x.u3m"), is = bytes_of("y.u3m");
    snprintf(expected, sizeof expected, "%s", (char *)was.data);
    char *modified = strstr((char *)is.data, "\"modified\":");
    assert_non_null(modified);
    char stamp[64];
    assert_int_equal(sscanf(modified, "\"modified\":%40[^,]", stamp), 1);
    assert_string_not_equal(stamp, "\"2026-01-01T00:00:00Z\"");
    u3m_put(expected, "\"modified\"", stamp);
    u3m_put(expected, "\"sheen_value\"", "{\"constant\":0.75,\"texture\":null}");
    u3m_put(expected, "\"clearcoat_roughness\"", "{\"constant\":0.125,\"texture\":null}");
    assert_string_equal((char *)is.data, expected);
    free(was.data);
    free(is.data);
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

/* A material of every number that the shader has. */
#define PRINCIPLED                                                                                                     \
    "{\"workflow\":\"disney\",\"base_color\":[0.1,0.45,0.8],\"opacity\":0.75,\"metallic\":0.25,\"roughness\":0.35,"    \
    "\"specular\":0.6,\"specular_tint\":0.2,\"sheen\":0.7,\"sheen_tint\":0.9,\"anisotropy\":0.4,"                      \
    "\"anisotropy_direction\":117,\"clearcoat\":0.3,\"clearcoat_gloss\":0.85,\"subsurface\":0.15,"                     \
    "\"diffuse_transmission\":0.05,\"alpha_mode\":\"blend\",\"double_sided\":true,\"back\":{\"workflow\":\"disney\","  \
    "\"base_color\":[0.9,0.2,0.02],\"roughness\":0.95}}"

static void material_assign(WeftScene *scene, const char *path) {
    WeftError error;
    if (weft_scene_assign_material(scene, "0", path, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

/* Inputs that are members of a U3M. */
static const InputId members[] = {INPUT_base_color,
                                  INPUT_opacity,
                                  INPUT_metallic,
                                  INPUT_roughness,
                                  INPUT_specular,
                                  INPUT_specular_tint,
                                  INPUT_sheen,
                                  INPUT_sheen_tint,
                                  INPUT_anisotropy,
                                  INPUT_clearcoat,
                                  INPUT_subsurface,
                                  INPUT_clearcoat_gloss,
                                  INPUT_diffuse_transmission,
                                  INPUT_anisotropy_direction};

static void same_numbers(const Material *a, const Material *b) {
    for (size_t k = 0; k < sizeof members / sizeof *members; k++)
        for (int c = 0; c < input_value_count(members[k]); c++)
            near(b->inputs[members[k]].value[c], a->inputs[members[k]].value[c]);
}

/* Checks a file by the schema, where Python has jsonschema. */
static void by_the_schema(const char *path) {
    char command[2048];
    if (system("python3 -c 'import jsonschema' 2>/dev/null") != 0) {
        print_message("%s was not checked by the schema: there is no python3-jsonschema\n", path);
        return;
    }
    snprintf(command, sizeof command,
             "python3 -c 'import json, sys, jsonschema; "
             "jsonschema.validate(json.load(open(sys.argv[2])), json.load(open(sys.argv[1])))' "
             "%s/tests/scene/u3m.schema.json %s",
             WEFT_SOURCE_DIR, path);
    if (system(command) != 0) fail_msg("%s breaks the schema", path);
}

static void every_number_comes_back_on_both_faces(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE];
    MaterialFile file;
    WeftError error;
    assert_true(scratch_enter(folder));
    text_write("m.json", PRINCIPLED);
    WeftScene *scene = scene_of("builtin:cloth");
    material_assign(scene, "m.json");
    save(scene, "\xff$.u3ma"); /* a name that no U3M has inside is another there */
    silence();
    assert_int_equal(u3m_load("\xff$.u3ma", &file, &counting, &error), WEFT_OK);
    material_file_free(&file);
    save(scene, "m.u3m");
    if (warnings) fail_msg("%s", said);
    by_the_schema("m.u3m");
    silence();
    assert_int_equal(u3m_load("m.u3m", &file, &counting, &error), WEFT_OK);
    if (warnings) fail_msg("%s", said);
    same_numbers(&scene->materials[0], &file.material);
    assert_non_null(file.back);
    for (int c = 0; c < 3; c++)
        near(file.back->material.inputs[INPUT_base_color].value[c],
             scene->materials[scene->material_count].inputs[INPUT_base_color].value[c]);
    near(file.back->material.inputs[INPUT_roughness].value[0], 0.95f);
    material_file_free(&file);
    weft_scene_free(scene);
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

/* Returns channel c of texel k of an input, linear, times its factor. */
static float texel(const MaterialFile *file, InputId id, int k, int c) {
    const Input *input = &file->material.inputs[id];
    assert_true(input->texture > 0);
    const bool color = input_infos[id].kind == WEFT_INPUT_COLOR;
    WeftImage linear;
    WeftError error;
    assert_int_equal(
        weft_image_convert_f32(&file->images[file->textures[input->texture - 1].image], color, &linear, &error),
        WEFT_OK);
    const float x = ((const float *)linear.pixels)[k * linear.channels + c] * input->value[color ? c : 0];
    weft_image_free(&linear);
    return x;
}

static void textures_come_back_from_packed_channels(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE];
    MaterialFile file;
    WeftError error;
    assert_true(scratch_enter(folder));
    picture("packed.png", 51, 102, 153);
    text_write("m.json", "{\"workflow\":\"disney\",\"base_color\":{\"texture\":\"packed.png\",\"factor\":[0.5,1,0.25]},"
                         "\"roughness\":{\"texture\":\"packed.png\",\"channel\":\"g\",\"factor\":0.5,\"scale\":[4,2],"
                         "\"wrap\":[\"mirror\",\"repeat\"]},\"normal\":{\"texture\":\"packed.png\",\"factor\":0.75},"
                         "\"clearcoat_gloss\":{\"texture\":\"packed.png\",\"channel\":\"b\"},\"double_sided\":true}");
    WeftScene *scene = scene_of("builtin:cloth");
    material_assign(scene, "m.json");
    const float metres = (float)cloth_uv_metres(scene, 0, 0, NULL);
    save(scene, "m.u3ma");
    if (warnings) fail_msg("%s", said);
    assert_int_equal(u3m_load("m.u3ma", &file, &counting, &error), WEFT_OK);
    if (warnings) fail_msg("%s", said);
    for (int k = 0; k < 8; k++) {
        near(texel(&file, INPUT_roughness, k, 0), 0.5f * (float)(102 + k) / 255.0f);
        if (!(fabsf(texel(&file, INPUT_clearcoat_gloss, k, 0) - (float)(153 + k) / 255.0f) < 1e-5f))
            fail_msg("gloss is %g", (double)texel(&file, INPUT_clearcoat_gloss, k, 0));
    }
    near(texel(&file, INPUT_base_color, 0, 2), 0.25f * 0.318546778f); /* 153 / 255 decoded */
    near(file.material.inputs[INPUT_normal].value[0], 0.75f);
    near(file.span[INPUT_roughness][0] / metres, 0.25f);
    near(file.span[INPUT_roughness][1] / metres, 0.5f);
    near(file.constant[INPUT_roughness][0], 0.5f * 105.5f / 255.0f); /* the mean stands for the texture */
    const Texture *texture = &file.textures[file.material.inputs[INPUT_roughness].texture - 1];
    assert_true(texture->wrap_u == WRAP_MIRROR && texture->wrap_v == WRAP_REPEAT);
    material_file_free(&file);
    weft_scene_free(scene);
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

static void other_materials_become_principled_and_their_losses_are_said(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE];
    MaterialFile file;
    WeftError error;
    assert_true(scratch_enter(folder));
    text_write("m.json", "{\"base_color\":[0.4,0.1,0.1],\"roughness\":0.6,\"ior\":1.5,\"sheen_color\":[0.2,0.05,0.05],"
                         "\"sheen_roughness\":0.3,\"emission\":[0,0.5,0],\"retroreflection\":0.5,"
                         "\"clearcoat\":1,\"clearcoat_roughness\":0.2,\"coat_color\":[1,0.5,0.5]}");
    WeftScene *scene = scene_of("builtin:cloth");
    material_assign(scene, "m.json");
    save(scene, "m.u3m");
    by_the_schema("m.u3m");
    expect_said("its own shading: U3M has the principled shader");
    expect_said("sheen_roughness: U3M has no word for it");
    expect_said("emission: U3M has no word for it");
    expect_said("retroreflection: U3M has no word for it");
    expect_said("coat_color: U3M has no word for it");
    assert_int_equal(u3m_load("m.u3m", &file, NULL, &error), WEFT_OK);
    const Input *in = file.material.inputs;
    near(in[INPUT_specular].value[0], 0.5f); /* F0 = 4 % of 8 % */
    near(in[INPUT_sheen].value[0], 0.2126f * 0.2f + 0.7874f * 0.05f);
    near(in[INPUT_sheen_tint].value[0], 1.0f); /* its hue is that of the base colour */
    near(in[INPUT_clearcoat_roughness].value[0], 0.2f);
    near(in[INPUT_base_color].value[0], 0.4f);
    material_file_free(&file);
    weft_scene_free(scene);
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

/* Every header of the archive is as Vizoo's part of zip demands. */
static void archives_are_the_part_of_zip_that_is_allowed(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE];
    assert_true(scratch_enter(folder));
    strange_write();
    WeftScene *scene = scene_of("x.u3m");
    save(scene, "x.u3ma");
    weft_scene_free(scene);
    FileBytes bytes = bytes_of("x.u3ma");
    int local = 0, central = 0;
    for (size_t k = 0; k + 46 < bytes.size; k++) {
        const unsigned char *p = bytes.data + k;
        if (memcmp(p, "PK\3\4", 4) == 0) {
            local++;
            assert_true(p[4] == 20 && p[5] == 0 && p[6] <= 6 && p[7] == 8 && p[28] == 0 && p[29] == 0);
        } else if (memcmp(p, "PK\1\2", 4) == 0) {
            central++;
            assert_true(p[4] == 63 && p[5] == 0 && p[6] == 20 && p[8] <= 6 && p[9] == 8 && p[30] == 0 && p[32] == 0);
            for (int c = 36; c < 42; c++) assert_int_equal(p[c], 0);
        }
    }
    assert_true(local == 3 && central == 3);
    free(bytes.data);
    int why;
    zip_t *zip = zip_open("x.u3ma", ZIP_RDONLY | ZIP_CHECKCONS, &why);
    assert_non_null(zip);
    assert_true(zip_name_locate(zip, "x.u3m", 0) >= 0 && zip_name_locate(zip, "t/p.png", 0) >= 0);
    zip_discard(zip);
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

static void a_weave_tells_its_construction(void **state) {
    static const struct {
        const char *draft, *construction;
    } weaves[] = {{"plain", "\"Plain weave\""},
                  {"twill 3/1 z", "\"Twill - right hand (Z)\""},
                  {"twill 2/2 s", "\"Twill - left hand (S)\""},
                  {"satin 5/2", "\"Satin\""},
                  {"basket 2 1", "\"Oxford\""},
                  {"herringbone 2/2 8", "\"other\""}};
    (void)state;
    char folder[SCRATCH_SIZE];
    WeftError error;
    assert_true(scratch_enter(folder));
    WeftScene *scene = scene_of("builtin:cloth");
    for (size_t k = 0; k < sizeof weaves / sizeof *weaves; k++) {
        WeftTextile textile = {.yarns = {"linen", "silk"}};
        WeftDraft *draft;
        assert_int_equal(weft_draft_parse(weaves[k].draft, &draft, &error), WEFT_OK);
        textile.draft = draft;
        assert_int_equal(weft_scene_save_u3m(scene, 0, "w.u3m", &textile, NULL, &error), WEFT_OK);
        by_the_schema("w.u3m");
        FileBytes bytes = bytes_of("w.u3m");
        const char *construction = strstr((char *)bytes.data, "\"construction\"");
        if (!construction || !strstr(construction, weaves[k].construction))
            fail_msg("%s is no %s", weaves[k].draft, weaves[k].construction);
        assert_true(strstr((char *)bytes.data, "\"Linen\"") && strstr((char *)bytes.data, "\"Silk\""));
        free(bytes.data);
        weft_draft_free(draft);
    }
    MaterialFile file; /* a woven material: its own construction, and the colour of its threads */
    silence();
    assert_int_equal(weft_scene_weave(scene, "0", "", "twill 3/1 s; warp 1#2030c0; weft 1#f0f0f0", NULL, &error),
                     WEFT_OK);
    assert_int_equal(weft_scene_save_u3m(scene, 0, "w.u3m", NULL, &counting, &error), WEFT_OK);
    expect_said("its threads: a U3M has their construction");
    by_the_schema("w.u3m");
    FileBytes bytes = bytes_of("w.u3m");
    assert_true(strstr((char *)bytes.data, "\"Twill - left hand (S)\"") && strstr((char *)bytes.data, "\"Cotton\""));
    free(bytes.data);
    assert_int_equal(u3m_load("w.u3m", &file, NULL, &error), WEFT_OK);
    assert_non_null(file.cloth); /* and so it is woven again */
    const float *color = file.material.inputs[INPUT_base_color].value;
    assert_true(color[2] > color[0] && color[0] > 0.1f && color[2] < 0.8f);
    material_file_free(&file);
    weft_scene_free(scene);
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

/* A file with a wrong character that is read all the same is written, and examined, and read again. */
static void damaged_files_that_are_read_are_written(void **state) {
    enum { ROUNDS = 300 };
    (void)state;
    char folder[SCRATCH_SIZE];
    WeftError error;
    unsigned seed = 7;
    int written = 0;
    assert_true(scratch_enter(folder));
    strange_write();
    FileBytes bytes = bytes_of("x.u3m");
    WeftScene *scene = scene_of("builtin:cloth");
    for (int k = 0; k < ROUNDS; k++) {
        seed = seed * 1664525u + 1013904223u;
        const size_t at = (seed >> 8) % bytes.size;
        const unsigned char was = bytes.data[at];
        bytes.data[at] = (unsigned char)"\"{}[],:0e-xn"[(seed >> 4) % 12];
        text_write("d.u3m", (char *)bytes.data);
        bytes.data[at] = was;
        WeftDoctor *doctor;
        const WeftResult read = weft_scene_assign_material(scene, "0", "d.u3m", NULL, &error);
        if (weft_doctor_open("d.u3m", &doctor, NULL, &error) == WEFT_OK) {
            assert_int_equal(read, WEFT_OK);
            weft_doctor_close(doctor);
        }
        if (read != WEFT_OK) continue;
        save(scene, "y.u3ma");
        if (weft_scene_assign_material(scene, "0", "y.u3ma", NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        written++;
    }
    assert_true(written > ROUNDS / 10);
    free(bytes.data);
    weft_scene_free(scene);
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damaged_files_that_are_read_are_written),
        cmocka_unit_test(members_that_did_not_change_are_written_byte_for_byte),
        cmocka_unit_test(only_what_changed_is_replaced),
        cmocka_unit_test(every_number_comes_back_on_both_faces),
        cmocka_unit_test(textures_come_back_from_packed_channels),
        cmocka_unit_test(other_materials_become_principled_and_their_losses_are_said),
        cmocka_unit_test(archives_are_the_part_of_zip_that_is_allowed),
        cmocka_unit_test(a_weave_tells_its_construction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
