/* A material that is saved and put on again is the same one; what cannot be written leaves nothing. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "scene/record/scene.h"
#include "scratch.h"
#include "weft/weft.h"

static char folder[SCRATCH_SIZE];

static int begin(void **state) {
    (void)state;
    return scratch_make(folder) ? 0 : -1;
}

static int end(void **state) {
    (void)state;
    return scratch_remove(folder) ? 0 : -1;
}

static WeftScene *load(const char *name) {
    WeftScene *scene = NULL;
    WeftError error;
    if (weft_scene_load(name, &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

static bool is_angle(int input) {
    WeftInputInfo info;
    weft_material_input_info(input, &info);
    return info.kind == WEFT_INPUT_DIRECTION || info.kind == WEFT_INPUT_ANGLE;
}

/* Byte by byte but for three things: angles went through degrees, textures have other numbers, and what the
 * file names is given. */
static void assert_same(const WeftScene *a, const WeftScene *b, const char *name) {
    WeftMaterial x, y;
    assert_int_equal(weft_scene_material(a, 0, &x, NULL), WEFT_OK);
    assert_int_equal(weft_scene_material(b, 0, &y, NULL), WEFT_OK);
    for (int k = 0; weft_material_input_name(k); k++) {
        WeftInput *p = &x.inputs[k], *q = &y.inputs[k];
        WeftImage i = weft_scene_texture(a, p->texture), j = weft_scene_texture(b, q->texture);
        assert_true(i.width == j.width && i.type == j.type && (i.pixels == NULL) == (j.pixels == NULL));
        assert_true(q->given || !p->given);
        if (is_angle(k) && fabsf(p->value[0] - q->value[0]) <= 1.2e-7f * fabsf(p->value[0])) p->value[0] = q->value[0];
        if (!p->texture) memcpy(p->transform, q->transform, sizeof p->transform);
        if (!p->texture) p->channel = q->channel, p->texcoord = q->texcoord;
        p->texture = q->texture;
        p->given = q->given;
        if (memcmp(p, q, sizeof *p) != 0) fail_msg("%s: %s", name, weft_material_input_name(k));
    }
    if (memcmp(&x, &y, sizeof x) != 0) fail_msg("%s", name);
}

static void save_and_compare(const WeftScene *scene, const char *file, const char *name) {
    char path[128];
    WeftError error;
    WeftScene *fresh = load("builtin:cloth");
    snprintf(path, sizeof path, "%s/%s", folder, file);
    if (weft_scene_save_material(scene, 0, path, &error) != WEFT_OK) fail_msg("%s", error.text);
    if (weft_scene_assign_material(fresh, "0", path, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_same(scene, fresh, name);
    weft_scene_free(fresh);
}

static void saved_presets_read_as_they_were(void **state) {
    (void)state;
    WeftError error;
    for (int k = 0; weft_preset_name(k); k++) {
        char path[64];
        WeftScene *scene = load("builtin:cloth");
        snprintf(path, sizeof path, "preset:%s", weft_preset_name(k));
        assert_int_equal(weft_scene_assign_material(scene, "0", path, NULL, &error), WEFT_OK);
        save_and_compare(scene, "preset.json", path);
        weft_scene_free(scene);
    }
}

static uint32_t dice = 1;
static float roll(void) {
    dice = dice * 1664525u + 1013904223u;
    return (float)(dice >> 8) * 0x1p-24f;
}

static void saved_material_of_random_values_reads_as_it_was(void **state) {
    (void)state;
    WeftError error;
    for (int round = 0; round < 30; round++) {
        WeftScene *scene = load("builtin:cloth");
        WeftInputInfo info;
        WeftMaterial m;
        for (int k = 0; k < 4; k++) {
            WeftImage image;
            assert_int_equal(
                weft_image_create(3 + k, 4, k + 1, k == 2 ? WEFT_PIXEL_F32 : WEFT_PIXEL_U8, &image, &error), WEFT_OK);
            assert_true(weft_scene_add_texture(scene, &image, &error) > 0);
        }
        Texture *last = &scene->textures[scene->texture_count - 1];
        last->wrap_v = WRAP_CLAMP;
        last->nearest = true;
        assert_int_equal(weft_scene_material(scene, 0, &m, &error), WEFT_OK);
        for (int i = 0; weft_material_input_info(i, &info); i++) {
            WeftInput *input = &m.inputs[i];
            for (int c = 0; c < 3; c++) input->value[c] = roll() < 0.3f ? input->value[c] : roll();
            if (roll() < 0.3f) input->texture = scene->texture_count - (int)(roll() * 3.99f);
            input->texcoord = input->texture && roll() < 0.2f;
            input->channel = input->texture && (info.kind == WEFT_INPUT_SCALAR || info.kind == WEFT_INPUT_ANGLE)
                                 ? (int)(roll() * 3.99f)
                                 : 0;
            for (int c = 0; c < 6 && input->texture && roll() < 0.4f; c++) input->transform[c] = roll();
        }
        for (int c = 0; weft_material_choice_name(c); c++)
            for (int v = 0; weft_material_choice_value(c, v) && strcmp(weft_material_choice_name(c), "diffuse") != 0;
                 v++)
                if (roll() < 0.1f) m.choices[c] = v;
        m.alpha_mode = (WeftAlphaMode)(round % 3);
        m.alpha_cutoff = roll();
        m.double_sided = round % 2;
        m.unlit = round % 5 == 0;
        if (weft_scene_put_material(scene, 0, &m, &error) != WEFT_OK) fail_msg("%s", error.text);
        save_and_compare(scene, "any.json", "anything");
        weft_scene_free(scene);
    }
}

/* A picture that has a file is named from where the material lies, and not written again. */
static void textures_of_a_saved_material_are_relative_to_it(void **state) {
    (void)state;
    WeftScene *scene = load("builtin:cloth");
    WeftError error;
    char path[128], text[4096] = "";
    assert_int_equal(
        weft_scene_set_texture(scene, "0.roughness.b", WEFT_SOURCE_DIR "/examples/nap/nap.png", NULL, &error), WEFT_OK);
    save_and_compare(scene, "named.json", "named");
    snprintf(path, sizeof path, "%s/named.json", folder);
    FILE *file = fopen(path, "rb");
    assert_true(file && fread(text, 1, sizeof text - 1, file) > 0);
    fclose(file);
    assert_non_null(strstr(text, "../"));
    assert_non_null(strstr(text, "examples/nap/nap.png"));
    snprintf(path, sizeof path, "%s/named-roughness.png", folder);
    assert_int_equal(access(path, F_OK), -1);
    /* other pixels are no longer those of the file */
    WeftMaterial m;
    WeftImage image;
    assert_int_equal(weft_scene_material(scene, 0, &m, &error), WEFT_OK);
    int roughness = 0;
    while (strcmp(weft_material_input_name(roughness), "roughness") != 0) roughness++;
    assert_int_equal(weft_image_create(5, 5, 3, WEFT_PIXEL_U8, &image, &error), WEFT_OK);
    assert_int_equal(weft_scene_put_texture(scene, m.inputs[roughness].texture, &image, &error), WEFT_OK);
    save_and_compare(scene, "named.json", "painted");
    assert_int_equal(access(path, F_OK), 0);
    weft_scene_free(scene);
}

static void failed_save_leaves_no_file(void **state) {
    (void)state;
    WeftScene *scene = load("builtin:cloth");
    WeftError error;
    assert_int_equal(weft_scene_save_material(scene, -1, "/tmp/none.json", &error), WEFT_USAGE);
    assert_int_equal(weft_scene_save_material(scene, scene->material_count, "/tmp/none.json", &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_MATERIAL_NAME);
    assert_int_equal(weft_scene_save_material(scene, 0, "/nowhere/a.json", &error), WEFT_RESOURCES);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_WRITE);
    assert_int_equal(weft_scene_save_material(scene, 0, folder, &error), WEFT_RESOURCES);
    assert_int_equal(weft_scene_save_material(scene, 0, "", &error), WEFT_RESOURCES);
    assert_int_equal(weft_scene_save_material(scene, 0, "/dev/full", &error), WEFT_RESOURCES);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(saved_presets_read_as_they_were),
                                       cmocka_unit_test(saved_material_of_random_values_reads_as_it_was),
                                       cmocka_unit_test(textures_of_a_saved_material_are_relative_to_it),
                                       cmocka_unit_test(failed_save_leaves_no_file)};
    return cmocka_run_group_tests(tests, begin, end);
}
