/* Pictures put on materials: by name, of a folder, pixels in place of others; and what is refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "scene/record/scene.h"
#include "scratch.h"
#include "shading/material/choice.h"
#include "shading/material/convert.h"
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

static const char *in_folder(const char *name) {
    static char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static WeftImage grey(int side, int value) {
    WeftImage image;
    assert_int_equal(weft_image_create(side, side, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    memset(image.pixels, value, (size_t)(3 * side * side));
    return image;
}

/* A picture in the folder. */
static void draw(const char *name, int side, int value) {
    WeftImage image = grey(side, value);
    WeftError error;
    if (weft_image_write(in_folder("drawn.png"), &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    char from[128];
    snprintf(from, sizeof from, "%s", in_folder("drawn.png"));
    assert_int_equal(rename(from, in_folder(name)), 0); /* whatever its suffix says: content tells */
    weft_image_free(&image);
}

static const Material *named(const WeftScene *scene, const char *name) {
    for (int k = 0; k < scene->material_count; k++)
        if (strcmp(scene->material_names[k], name) == 0) return &scene->materials[k];
    fail_msg("%s", name);
    return NULL;
}

static void picture_is_bound_to_an_input(void **state) {
    (void)state;
    WeftScene *scene = load("builtin:spheres");
    WeftError error;
    int images = scene->image_count;
    draw("a.png", 4, 100);
    assert_int_equal(weft_scene_set_texture(scene, "dark-1.roughness.g", in_folder("a.png"), NULL, &error), WEFT_OK);
    const Input *input = &named(scene, "dark-1")->inputs[INPUT_roughness];
    assert_int_equal(scene->image_count, images + 1);
    assert_int_equal(input->texture, scene->texture_count);
    assert_true(input->value[0] == 1.0f && input->channel == 1 && input->given);
    assert_string_equal(weft_scene_texture_path(scene, input->texture), in_folder("a.png"));
    assert_int_equal(weft_scene_texture(scene, input->texture).width, 4);
    assert_null(weft_scene_texture_path(scene, 99));
    assert_null(weft_scene_texture(scene, 0).pixels);
    /* the same file again, for another input: read again, once in the scene */
    draw("a.png", 6, 50);
    unsigned version = scene->textures[input->texture - 1].version;
    assert_int_equal(weft_scene_set_texture(scene, "*.nap", in_folder("a.png"), NULL, &error), WEFT_OK);
    assert_int_equal(scene->image_count, images + 1);
    assert_int_equal(named(scene, "light-2")->inputs[INPUT_nap].texture, input->texture);
    assert_true(fabsf(named(scene, "light-2")->inputs[INPUT_nap].value[0] - 0.785398f) < 1e-6f);
    assert_int_equal(weft_scene_texture(scene, input->texture).width, 6);
    assert_int_equal(scene->textures[input->texture - 1].version, version + 1);
    assert_int_equal(weft_scene_set_texture(scene, "dark-1.opacity", in_folder("a.png"), NULL, &error), WEFT_OK);
    assert_int_equal(named(scene, "dark-1")->alpha_mode, WEFT_ALPHA_BLEND);
    weft_scene_free(scene);
}

static void unreadable_maps_are_refused(void **state) {
    (void)state;
    WeftScene *scene = load("builtin:cloth");
    WeftError error;
    draw("b.png", 4, 100);
    FILE *half = fopen(in_folder("half.png"), "wb");
    assert_true(half && fwrite("\x89PNG\r\n\x1a\n", 1, 8, half) == 8 && fclose(half) == 0);
    static const struct {
        const char *target, *file;
        WeftMessage message;
    } wrong[] = {
        {"*.roughnes", "b.png", WEFT_MESSAGE_PARAM_NAME},           {"roughness", "b.png", WEFT_MESSAGE_PARAM_NAME},
        {"*.base_color.g", "b.png", WEFT_MESSAGE_PARAM_NAME},       {"*.workflow", "b.png", WEFT_MESSAGE_PARAM_NAME},
        {"ceiling.roughness", "b.png", WEFT_MESSAGE_MATERIAL_NAME}, {"*.roughness", "none.png", WEFT_MESSAGE_FILE_OPEN},
        {"*.roughness", "half.png", WEFT_MESSAGE_IMAGE_DAMAGED},    {"*.roughness", "", WEFT_MESSAGE_FILE_READ},
    };
    WeftMaterial before, after;
    int textures = scene->texture_count;
    assert_int_equal(weft_scene_material(scene, 0, &before, &error), WEFT_OK);
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_int_not_equal(weft_scene_set_texture(scene, wrong[k].target, in_folder(wrong[k].file), NULL, &error),
                             WEFT_OK);
        if (error.message != wrong[k].message) fail_msg("%zu: %s", k, error.text);
        assert_int_equal(weft_scene_material(scene, 0, &after, &error), WEFT_OK);
        assert_memory_equal(&before, &after, sizeof before);
        assert_int_equal(scene->texture_count, textures);
    }
    WeftImage image = grey(4, 1), none = {0};
    assert_int_equal(weft_scene_put_texture(scene, textures + 1, &image, &error), WEFT_USAGE);
    assert_int_equal(weft_scene_put_texture(scene, 0, &image, &error), WEFT_USAGE);
    assert_int_equal(weft_scene_add_texture(scene, &none, &error), 0);
    assert_int_equal(error.message, WEFT_MESSAGE_DESC);
    assert_non_null(image.pixels); /* is ours still */
    image.channels = 5;
    assert_int_equal(weft_scene_add_texture(scene, &image, &error), 0);
    weft_image_free(&image);
    assert_int_equal(weft_image_create(2, 2, 1, WEFT_PIXEL_F32, &image, NULL), WEFT_OK);
    ((float *)image.pixels)[3] = NAN;
    assert_int_equal(weft_scene_add_texture(scene, &image, &error), 0);
    weft_image_free(&image);
    weft_scene_free(scene);
}

static int warned;
static void count_warning(void *user, WeftMessage message, const char *text) {
    (void)user;
    (void)message;
    assert_non_null(text);
    warned++;
}

static void maps_of_a_folder_are_bound_to_their_inputs(void **state) {
    (void)state;
    WeftScene *scene = load("builtin:cloth");
    const WeftLog log = {count_warning, NULL};
    WeftError error;
    char path[128];
    int count;
    snprintf(path, sizeof path, "%s", in_folder("0"));
    assert_int_equal(mkdir(path, 0700), 0);
    assert_int_equal(weft_scene_bind_maps(scene, NULL, path, &count, &log, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_OPEN);
    static const char *const files[] = {"0/Albedo.tga",         "0/NORMAL.PNG", "0/chair_Roughness.jpg",
                                        "0/Specular.exr",       "0/Sheen.png",  "0/chair.nap.png",
                                        "0/xyz-base_color.png", "0/notes.txt",  "0/gloss.png",
                                        "0/myroughness2.png",   "0/Thumbs.db"};
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) draw(files[k], 4, 100 + (int)k);
    warned = 0;
    if (weft_scene_bind_maps(scene, NULL, path, &count, &log, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(count, 6);
    assert_int_equal(
        warned, 3); /* of a second base_color, of gloss beside roughness, and in one line of what is not understood */
    const Material *cloth = named(scene, "Cloth");
    static const InputId worn[] = {INPUT_base_color,  INPUT_normal, INPUT_roughness,    INPUT_specular_color,
                                   INPUT_sheen_color, INPUT_nap,    INPUT_nap_direction};
    for (size_t k = 0; k < sizeof worn / sizeof *worn; k++) assert_true(cloth->inputs[worn[k]].texture > 0);
    assert_int_equal(cloth->inputs[INPUT_nap].channel, 2);
    assert_int_equal(cloth->choices[CHOICE_workflow], WORKFLOW_SPECULAR);
    assert_non_null(strstr(weft_scene_texture_path(scene, cloth->inputs[INPUT_base_color].texture), "Albedo.tga"));
    /* a metalness too: then the workflow stays */
    draw("0/chair_ORM.png", 4, 7);
    int images = scene->image_count;
    assert_int_equal(weft_scene_set(scene, "Cloth.workflow", "metallic", NULL, &error), WEFT_OK);
    assert_int_equal(weft_scene_bind_maps(scene, "Cloth", path, &count, &log, &error), WEFT_OK);
    assert_int_equal(scene->image_count, images + 1); /* the others were there and are read again */
    cloth = named(scene, "Cloth");
    assert_int_equal(cloth->choices[CHOICE_workflow], WORKFLOW_METALLIC);
    assert_int_equal(cloth->inputs[INPUT_metallic].channel, 2);
    assert_int_equal(cloth->inputs[INPUT_roughness].channel, 1); /* chair_ORM is before chair_Roughness */
    assert_int_equal(weft_scene_bind_maps(scene, "none", path, &count, &log, &error), WEFT_USAGE);
    assert_int_equal(weft_scene_bind_maps(scene, NULL, "/nowhere", &count, &log, &error), WEFT_INPUT);
    /* one that is damaged: the scene is as it was */
    WeftMaterial before, after;
    assert_int_equal(weft_scene_material(scene, 0, &before, &error), WEFT_OK);
    FILE *half = fopen(in_folder("0/ao.png"), "wb");
    assert_true(half && fwrite("\x89PNG\r\n\x1a\n", 1, 8, half) == 8 && fclose(half) == 0);
    assert_int_equal(weft_scene_bind_maps(scene, "0", path, &count, &log, &error), WEFT_INPUT);
    assert_int_equal(count, 0);
    assert_int_equal(weft_scene_material(scene, 0, &after, &error), WEFT_OK);
    assert_memory_equal(&before, &after, sizeof before);
    weft_scene_free(scene);
}

static char last_said[512];
static void keep_warning(void *user, WeftMessage message, const char *text) {
    (void)user;
    (void)message;
    snprintf(last_said, sizeof last_said, "%s", text);
}

static void map_of_any_input_is_bound_by_its_name(void **state) {
    (void)state;
    WeftScene *scene = load("builtin:cloth");
    const WeftLog log = {keep_warning, NULL};
    WeftError error;
    int count;
    assert_int_equal(mkdir(in_folder("c"), 0700), 0);
    draw("c/cloth_DustColor.png", 4, 10);
    draw("c/cloth_diffuse_transmission.png", 4, 20);
    last_said[0] = '\0';
    assert_int_equal(weft_scene_bind_maps(scene, NULL, in_folder("c"), &count, &log, &error), WEFT_OK);
    assert_string_equal(last_said, "");
    assert_int_equal(count, 2);
    const Material *cloth = named(scene, "Cloth");
    assert_true(cloth->inputs[INPUT_dust_color].texture && cloth->inputs[INPUT_diffuse_transmission].texture);
    assert_false(cloth->inputs[INPUT_base_color].texture);
    weft_scene_free(scene);
}

/* The ten parameters of the principled model as files are called. */
static void maps_of_the_principled_model_are_bound_by_name(void **state) {
    (void)state;
    static const struct {
        const char *file, *other;
        InputId input;
    } maps[] = {
        {"Subsurface", "cloth_subsurface", INPUT_subsurface},
        {"Metallic", "cloth-Metalness", INPUT_metallic},
        {"Specular", "cloth specular", INPUT_specular},
        {"Specular Tint", "cloth_specular_tint", INPUT_specular_tint},
        {"Roughness", "cloth.roughness", INPUT_roughness},
        {"Anisotropy", "cloth_Anisotropic", INPUT_anisotropy},
        {"Sheen", "cloth_sheen", INPUT_sheen},
        {"Sheen Tint", "cloth-sheenTint", INPUT_sheen_tint},
        {"Clearcoat", "cloth_clear_coat", INPUT_clearcoat},
        {"ClearcoatGloss", "cloth_Clearcoat_Gloss", INPUT_clearcoat_gloss},
    };
    for (int spelling = 0; spelling < 2; spelling++) {
        char path[128], file[160];
        WeftScene *scene = load("builtin:cloth");
        const WeftLog log = {keep_warning, NULL};
        WeftError error;
        int count;
        snprintf(path, sizeof path, "%s", in_folder(spelling ? "b" : "a"));
        assert_int_equal(mkdir(path, 0700), 0);
        for (size_t k = 0; k < sizeof maps / sizeof *maps; k++) {
            snprintf(file, sizeof file, "%s/%s.png", spelling ? "b" : "a", spelling ? maps[k].other : maps[k].file);
            draw(file, 4, 100 + (int)k);
        }
        last_said[0] = '\0';
        assert_int_equal(weft_scene_bind_maps(scene, NULL, path, &count, &log, &error), WEFT_OK);
        assert_string_equal(last_said, "");
        assert_int_equal(count, 10);
        const Material *cloth = named(scene, "Cloth");
        assert_string_equal(choice_id(CHOICE_workflow, cloth->choices[CHOICE_workflow]), "disney");
        for (size_t k = 0; k < sizeof maps / sizeof *maps; k++)
            if (!cloth->inputs[maps[k].input].texture) fail_msg("%s", input_infos[maps[k].input].name);
        snprintf(file, sizeof file, "%s/flakes.png", spelling ? "b" : "a");
        draw(file, 4, 1);
        snprintf(file, sizeof file, "%s/mask.png", spelling ? "b" : "a");
        draw(file, 4, 1);
        assert_int_equal(weft_scene_bind_maps(scene, NULL, path, &count, &log, &error), WEFT_OK);
        assert_non_null(strstr(last_said, "no input has a map of this name: flakes.png, mask.png"));
        weft_scene_free(scene);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(picture_is_bound_to_an_input),
                                       cmocka_unit_test(unreadable_maps_are_refused),
                                       cmocka_unit_test(maps_of_a_folder_are_bound_to_their_inputs),
                                       cmocka_unit_test(maps_of_the_principled_model_are_bound_by_name),
                                       cmocka_unit_test(map_of_any_input_is_bound_by_its_name)};
    return cmocka_run_group_tests(tests, begin, end);
}
