/* Material files: every form of every key, refusals in one line, and what a scene wears afterwards. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "scene/material/material_file.h"
#include "scratch.h"
#include "weft/weft.h"

static int warnings;
static void note(void *user, WeftMessage message, const char *text) {
    (void)user;
    (void)message;
    assert_null(strchr(text, '\n'));
    warnings++;
}
static const WeftLog counting = {.fn = note};

static MaterialFile file_of(const char *text, int warned) {
    MaterialFile file;
    WeftError error;
    warnings = 0;
    if (material_file_read(text, strlen(text), "mine.json", NULL, &file, &counting, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    if (warnings != warned) fail_msg("%s: %d warnings", text, warnings);
    return file;
}

static void near(const Input *input, float r, float g, float b) {
    const float expected[3] = {r, g, b};
    for (int c = 0; c < 3; c++)
        if (!(fabsf(input->value[c] - expected[c]) < 1e-6f))
            fail_msg("channel %d is %g, not %g", c, (double)input->value[c], (double)expected[c]);
}

static void values_of_every_form_are_read(void **state) {
    (void)state;
    MaterialFile file = file_of("{\"base_color\":[0.1,0.2,0.3],\"sheen_color\":\"#ff0080\",\"specular_color\":0.5,"
                                "\"roughness\":0.75,\"anisotropy_direction\":90,\"name\":\"a\",\"help\":\"b\"}",
                                0);
    const Input *inputs = file.material.inputs;
    near(&inputs[INPUT_base_color], 0.1f, 0.2f, 0.3f);
    near(&inputs[INPUT_sheen_color], 1.0f, 0.0f, 0.21586050f); /* ((128 / 255 + .055) / 1.055)^2.4 */
    near(&inputs[INPUT_specular_color], 0.5f, 0.5f, 0.5f);
    assert_true(inputs[INPUT_roughness].value[0] == 0.75f);
    assert_true(fabsf(inputs[INPUT_anisotropy_direction].value[0] - 1.57079633f) < 1e-6f);
    assert_true(file.named[INPUT_roughness] && !file.named[INPUT_ior]);
    material_file_free(&file);
    file = file_of("{\"nap\":30,\"nap_direction\":-45,\"sheen_density\":2}", 0);
    inputs = file.material.inputs;
    assert_true(fabsf(inputs[INPUT_nap].value[0] - 0.523598776f) < 1e-6f);
    assert_true(fabsf(inputs[INPUT_nap_direction].value[0] + 0.785398163f) < 1e-6f);
    assert_true(inputs[INPUT_sheen_density].value[0] == 2.0f);
    material_file_free(&file);
    file = file_of("{\"dust\":0.5,\"dust_color\":\"#ffffff\",\"dust_tilt\":30,\"dust_noise\":1}", 0);
    inputs = file.material.inputs;
    assert_true(inputs[INPUT_dust].value[0] == 0.5f && inputs[INPUT_dust_noise].value[0] == 1.0f);
    near(&inputs[INPUT_dust_color], 1.0f, 1.0f, 1.0f);
    assert_true(fabsf(inputs[INPUT_dust_tilt].value[0] - 0.523598776f) < 1e-6f);
    /* what the file is silent on has its default */
    const Material plain = material_default();
    assert_memory_equal(&inputs[INPUT_ior], &plain.inputs[INPUT_ior], sizeof *inputs);
    assert_memory_equal(file.material.choices, plain.choices, sizeof plain.choices);
    material_file_free(&file);
}

/* Editors of one large house put it there. */
static void byte_order_mark_of_a_material_file_is_skipped(void **state) {
    (void)state;
    MaterialFile file = file_of("\xef\xbb\xbf{\"roughness\":0.75}", 0);
    assert_true(file.material.inputs[INPUT_roughness].value[0] == 0.75f);
    material_file_free(&file);
}

static void choices_of_a_material_file_are_ids_and_aliases(void **state) {
    (void)state;
    MaterialFile file = file_of("{\"v\":\"charlie-v\",\"d\":\"charlie-d\",\"sheen_lobe\":\"ashikhmin-neubelt\","
                                "\"layer\":\"reciprocal\",\"workflow\":\"auto\",\"alpha_mode\":\"mask\","
                                "\"alpha_cutoff\":0.25,\"double_sided\":true}",
                                0);
    const int *choices = file.material.choices;
    assert_string_equal(weft_material_choice_value(CHOICE_v, choices[CHOICE_v]), "conty-kulla");
    assert_string_equal(weft_material_choice_value(CHOICE_d, choices[CHOICE_d]), "charlie");
    assert_string_equal(weft_material_choice_value(CHOICE_layer, choices[CHOICE_layer]), "reciprocal");
    assert_int_equal(choices[CHOICE_workflow], CHOICE_AUTO);
    assert_true(file.material.alpha_mode == WEFT_ALPHA_MASK && file.material.alpha_cutoff == 0.25f);
    assert_true(file.material.double_sided && file.alpha_named && file.sided_named);
    material_file_free(&file);
    /* a workflow's defaults give way to inputs, wherever it stands */
    file = file_of("{\"specular\":1,\"workflow\":\"disney\"}", 1); /* 0.08 is beyond a dielectric */
    assert_true(file.material.inputs[INPUT_specular].value[0] == 1.0f);
    assert_true(file.material.inputs[INPUT_sheen].value[0] == 0.0f);
    material_file_free(&file);
}

static void implausible_values_of_a_file_are_named_in_warnings(void **state) {
    (void)state;
    static const struct {
        const char *text;
        int warned;
    } files[] = {
        {"{}", 0},
        {"{\"roughness\":1.5}", 1},
        {"{\"roughness\":5}", 1},
        {"{\"base_color\":[2,0,0]}", 2}, /* clamped, and brighter than paper all the same */
        {"{\"base_color\":0.95}", 1},
        {"{\"workflow\":\"cloth\",\"base_color\":0.95}", 1},
        {"{\"workflow\":\"cloth\",\"base_color\":0.8}", 0},
        {"{\"nap\":60}", 1},
        {"{\"nap\":120}", 1},
        {"{\"nap\":45,\"nap_direction\":900,\"sheen_density\":4}", 0},
        {"{\"sheen_density\":0.1}", 1},
        {"{\"ior\":1.5}", 0},
        {"{\"ior\":2.2}", 1},
        {"{\"metallic\":0.5}", 1},
        {"{\"metallic\":1}", 0},
        {"{\"layer\":\"additive\"}", 1},
        {"{\"layer\":\"albedo-max\"}", 0},
        {"{\"workflow\":\"free\"}", 1},
        {"{\"workflow\":\"specular\",\"specular_color\":[0.9,0.6,0.3],\"base_color\":0}", 0},
        {"{\"workflow\":\"specular\",\"specular_color\":0.04,\"base_color\":0.5}", 0},
        {"{\"workflow\":\"specular\",\"specular_color\":0.01}", 1},
        {"{\"workflow\":\"specular\",\"specular_color\":[0.05,0.02,0.01]}", 1},
        {"{\"workflow\":\"specular\",\"specular_color\":[0.1,0.04,0.02]}", 2},
        {"{\"workflow\":\"specular\",\"specular_color\":0.4,\"base_color\":0}", 1},
        {"{\"metallic\":1,\"base_color\":0.3}", 1}, /* told once, though both have to do with it */
        {"{\"specular_color\":[1,0.5,0.5]}", 1},
        {"{\"specular\":0.4}", 0}, /* gaps between threads */
        {"{\"workflow\":\"disney\",\"specular\":0.5}", 0},
        {"{\"workflow\":\"disney\",\"specular\":0}", 0},
        {"{\"workflow\":\"disney\",\"specular\":0.1}", 1},
        {"{\"workflow\":\"disney\",\"base_color\":[0.5,0.1,0.1],\"specular_tint\":1}", 1},
    };
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        MaterialFile file = file_of(files[k].text, files[k].warned);
        material_file_free(&file);
    }
    warnings = 0;
    MaterialFile file;
    WeftError error;
    static const char metal[] = "{\"workflow\":\"specular\",\"specular_color\":0.9,\"base_color\":0.5}";
    assert_int_equal(material_file_read(metal, sizeof metal - 1, "m", NULL, &file, &counting, &error), WEFT_OK);
    assert_true(warnings >= 1);
    assert_true(file.material.inputs[INPUT_base_color].value[0] == 0.5f); /* taken as it is */
    material_file_free(&file);
}

static const struct {
    const char *text, *part;
} wrong[] = {
    {"", "it is empty"},
    {" \n\t", "it is empty"},
    {"\xef\xbb\xbf", "it is empty"},
    {"\xef\xbb\xbf{", "line 1"},
    {"\xef\xbb{}", "line 1"},
    {"{", "line 1"},
    {"[]", "not an object"},
    {"3", "line 1"},
    {"{\"base_color\":1,\n\"base_color\":1}", "duplicate"},
    {"{\"base_colour\":1}", "base_colour"},
    {"{\"base_color\":\"red\"}", "base_color: \"red\""},
    {"{\"base_color\":\"#12345\"}", "#12345"},
    {"{\"base_color\":\"#12345g\"}", "#12345g"},
    {"{\"base_color\":[1,1]}", "base_color"},
    {"{\"base_color\":[1,1,\"x\"]}", "an element must be a number, not \"x\""},
    {"{\"base_color\":null}", "base_color"},
    {"{\"roughness\":[1,1,1]}", "roughness"},
    {"{\"roughness\":\"#ffffff\"}", "roughness"},
    {"{\"roughness\":true}", "roughness"},
    {"{\"nap\":\"steep\"}", "nap"},
    {"{\"nap\":[1,0]}", "nap"},
    {"{\"nap_direction\":{\"texture\":\"a.png\",\"channel\":\"b\"}}", "channel"},
    {"{\"nap_rotation\":90}", "nap_rotation"},
    {"{\"layer\":3}", "layer"},
    {"{\"layer\":\"glue\"}", "glue"},
    {"{\"layer\":\"seed,by=max\"}", "write layer=seed and layer_by=max"},
    {"{\"sheen_lobe\":\"charlie\"}", "charlie-neubelt, charlie-conty-kulla"},
    {"{\"diffuse\":\"ggx\"}", "ggx"},
    {"{\"keep\":\"normal\"}", "keep"},
    {"{\"keep\":[\"norml\"]}", "norml"},
    {"{\"keep\":[1]}", "keep"},
    {"{\"keep\":[\"ior\"],\"ior\":1.5}", "both"},
    {"{\"alpha_mode\":\"cut\"}", "alpha_mode: it must be one of opaque, mask, blend, not \"cut\""},
    {"{\"double_sided\":1}", "true or false, not 1"},
    {"{\"help\":1}", "help"},
    {"{\"roughness\":{}}", "texture"},
    {"{\"roughness\":{\"texture\":\"\"}}", "texture"},
    {"{\"roughness\":{\"texture\":\"a.png\"}}", "a file to lie beside"},
    {"{\"roughness\":{\"texture\":\"a.png\",\"chanel\":\"r\"}}", "chanel"},
    {"{\"roughness\":{\"texture\":\"a.png\",\"channel\":\"x\"}}", "r, g, b, a"},
    {"{\"base_color\":{\"texture\":\"a.png\",\"channel\":\"r\"}}", "channel"},
    {"{\"roughness\":{\"texture\":\"a.png\",\"texture\":\"b.png\"}}", "duplicate"},
    {"{\"roughness\":{\"texture\":\"a.png\",\"texcoord\":2}}", "texcoord"},
    {"{\"roughness\":{\"texture\":\"a.png\",\"texcoord\":0.5}}", "texcoord"},
    {"{\"roughness\":{\"texture\":\"a.png\",\"scale\":[1,2,3]}}", "scale is one number or two, not [1,2,3]"},
    {"{\"roughness\":{\"texture\":\"a.png\",\"offset\":\"1\"}}", "offset is one number or two"},
    {"{\"roughness\":{\"texture\":\"a.png\",\"scale\":1e7}}", "1e6"},
    {"{\"roughness\":{\"texture\":\"a.png\",\"wrap\":\"none\"}}",
     "wrap must be one of repeat, mirror, clamp, not \"none\""},
    {"{\"roughness\":{\"texture\":\"a.png\",\"nearest\":1}}", "nearest must be true or false, not 1"},
};

static void wrong_material_file_is_an_error_of_one_line(void **state) {
    (void)state;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        MaterialFile file;
        WeftError error;
        WeftResult result =
            material_file_read(wrong[k].text, strlen(wrong[k].text), "mine.json", NULL, &file, NULL, &error);
        if (result != WEFT_INPUT || error.message != WEFT_MESSAGE_MATERIAL_FILE ||
            strncmp(error.text, "mine.json: ", 11) != 0 || !strstr(error.text, wrong[k].part) ||
            strchr(error.text, '\n'))
            fail_msg("%s: %d \"%s\"", wrong[k].text, result, error.text);
        material_file_free(&file);
    }
}

static void keep_text(void *user, WeftMessage message, const char *text) {
    (void)message;
    snprintf(user, 512, "%s", text);
}

/* What lies beyond its limit is taken as that, with a line that names the key and the number. */
static void cutoff_below_zero_is_repaired_with_a_warning(void **state) {
    (void)state;
    static const char text[] = "{\"alpha_cutoff\":-3}";
    char line[512] = "";
    const WeftLog log = {keep_text, line};
    MaterialFile file;
    WeftError error;
    assert_int_equal(material_file_read(text, sizeof text - 1, "mine.json", NULL, &file, &log, &error), WEFT_OK);
    assert_true(file.material.alpha_cutoff <= 0.0f && file.material.alpha_cutoff >= 0.0f);
    assert_non_null(strstr(line, "mine.json: alpha_cutoff"));
    assert_non_null(strstr(line, "-3"));
    material_file_free(&file);
}

static WeftScene *load(const char *name) {
    WeftScene *scene = NULL;
    WeftError error;
    if (weft_scene_load(name, &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

static WeftResult dress(WeftScene *scene, const char *material, const char *text, WeftError *error) {
    return weft_scene_assign_material_memory(scene, material, text, strlen(text), "mine.json", NULL, error);
}

static void material_file_changes_materials_and_keeps_meshes(void **state) {
    (void)state;
    WeftScene *scene = load("builtin:cloth");
    WeftError error;
    Material *cloth = &scene->materials[0];
    cloth->inputs[INPUT_normal].value[0] = 0.3f;
    cloth->inputs[INPUT_base_color].value[0] = 0.7f;
    cloth->double_sided = true;
    Material plinth = scene->materials[1];
    assert_int_equal(dress(scene, NULL, "{\"roughness\":0.9,\"keep\":[\"base_color\"]}", &error), WEFT_OK);
    assert_true(cloth->inputs[INPUT_roughness].value[0] == 0.9f);
    assert_true(cloth->inputs[INPUT_normal].value[0] == 0.3f);
    assert_true(cloth->inputs[INPUT_base_color].value[0] == 0.7f);
    assert_true(cloth->inputs[INPUT_sheen_color].value[0] == 0.0f); /* the file is the whole material */
    assert_true(cloth->double_sided);
    assert_memory_equal(&scene->materials[1], &plinth, sizeof plinth);
    /* nothing has a sheen now: all but the light are cloth */
    assert_int_equal(dress(scene, NULL, "{\"roughness\":0.8}", &error), WEFT_OK);
    assert_true(scene->materials[1].inputs[INPUT_roughness].value[0] == 0.8f);
    for (int k = 0; k < scene->material_count; k++)
        if (strcmp(scene->material_names[k], "Softbox") == 0)
            assert_true(scene->materials[k].inputs[INPUT_emission].value[0] > 0.0f);
    assert_int_equal(dress(scene, "Floor", "{\"roughness\":0.1}", &error), WEFT_OK);
    assert_true(scene->materials[2].inputs[INPUT_roughness].value[0] == 0.1f);
    assert_true(scene->materials[1].inputs[INPUT_roughness].value[0] == 0.8f);
    weft_scene_free(scene);
}

static void failed_material_file_changes_nothing(void **state) {
    (void)state;
    WeftScene *scene = load("builtin:cloth");
    WeftError error;
    Material *before = calloc((size_t)scene->material_count, sizeof *before);
    assert_non_null(before);
    memcpy(before, scene->materials, (size_t)scene->material_count * sizeof *before);
    assert_int_equal(dress(scene, NULL, "{\"roughness\":0.9,\"layer\":\"glue\"}", &error), WEFT_INPUT);
    assert_int_equal(dress(scene, "Wool", "{}", &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_MATERIAL_NAME);
    assert_int_equal(weft_scene_assign_material(scene, NULL, "preset:silc", NULL, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_PRESET_NAME);
    assert_int_equal(weft_scene_assign_material(scene, NULL, "/nowhere/mine.json", NULL, &error), WEFT_INPUT);
    assert_memory_equal(before, scene->materials, (size_t)scene->material_count * sizeof *before);
    free(before);
    weft_scene_free(scene);
}

static char folder[SCRATCH_SIZE];

static void write_text(const char *path, const char *text) {
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    assert_int_equal(fwrite(text, 1, strlen(text), stream), strlen(text));
    assert_int_equal(fclose(stream), 0);
}

/* A picture of one byte a channel beside the file; two inputs look at it, and it is read once. */
static void textures_are_found_beside_the_material_file(void **state) {
    (void)state;
    char picture[64], json[64];
    assert_true(scratch_make(folder));
    snprintf(picture, sizeof picture, "%s/orm.png", folder);
    snprintf(json, sizeof json, "%s/mine.json", folder);
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(2, 2, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    memset(image.pixels, 51, 12);
    assert_int_equal(weft_image_write(picture, &image, &error), WEFT_OK);
    weft_image_free(&image);
    write_text(json, "{\"roughness\":{\"texture\":\"orm.png\",\"channel\":\"g\",\"factor\":0.5,\"scale\":[2,3],"
                     "\"rotation\":90,\"offset\":0.25,\"wrap\":\"mirror\",\"nearest\":true},"
                     "\"base_color\":{\"texture\":\"orm.png\",\"texcoord\":1},"
                     "\"nap\":{\"texture\":\"orm.png\",\"channel\":\"b\"},"
                     "\"nap_direction\":{\"texture\":\"orm.png\"}}");
    WeftScene *scene = load("builtin:cloth");
    int images = scene->image_count, textures = scene->texture_count;
    if (weft_scene_assign_material(scene, "Cloth", json, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(scene->image_count, images + 1);
    assert_int_equal(scene->texture_count, textures + 4);
    const Input *roughness = &scene->materials[0].inputs[INPUT_roughness],
                *color = &scene->materials[0].inputs[INPUT_base_color];
    const Texture *texture = &scene->textures[roughness->texture - 1];
    assert_true(roughness->value[0] == 0.5f && roughness->channel == 1);
    assert_true(texture->nearest && texture->wrap_u == texture->wrap_v && texture->wrap_u == WRAP_MIRROR);
    assert_int_equal(texture->image, images);
    const Input *nap = &scene->materials[0].inputs[INPUT_nap];
    assert_true(nap->channel == 2 && fabsf(nap->value[0] - 0.785398163f) < 1e-6f); /* 45 degrees at most */
    assert_true(scene->materials[0].inputs[INPUT_nap_direction].value[0] == 0.0f);
    assert_true(scene->materials[0].inputs[INPUT_nap_direction].texture > 0);
    assert_non_null(scene->meshes[0].tangent);
    assert_true(color->texcoord == 1 && color->value[2] == 1.0f && color->texture != roughness->texture);
    /* KHR_texture_transform: offset + rotation (scale uv), here (u, v) -> (3 v + .25, -2 u + .25) */
    const float expected[6] = {0.0f, 3.0f, 0.25f, -2.0f, 0.0f, 0.25f};
    for (int k = 0; k < 6; k++) assert_true(fabsf(roughness->transform[k] - expected[k]) < 1e-5f);
    weft_scene_free(scene);
    /* one that is not there is named by its own path, and nothing leaks */
    scene = load("builtin:cloth");
    write_text(json, "{\"base_color\":{\"texture\":\"orm.png\"},\"roughness\":{\"texture\":\"none.png\"}}");
    assert_int_equal(weft_scene_assign_material(scene, "Cloth", json, NULL, &error), WEFT_INPUT);
    assert_non_null(strstr(error.text, "none.png: "));
    assert_int_equal(scene->image_count, images);
    weft_scene_free(scene);
    unlink(picture);
    unlink(json);
    rmdir(folder);
}

/* Every preset is a clean file; every file of scenes/presets is a preset, to the byte. */
static void presets_load_without_warnings(void **state) {
    (void)state;
    int count = 0;
    for (; weft_preset_name(count); count++) {
        const char *text = weft_preset_text(count);
        char path[512], from_disk[8192];
        MaterialFile file = file_of(text, 0);
        material_file_free(&file);
        snprintf(path, sizeof path, WEFT_SOURCE_DIR "/scenes/presets/%s.json", weft_preset_name(count));
        FILE *stream = fopen(path, "r");
        assert_non_null(stream);
        size_t size = fread(from_disk, 1, sizeof from_disk, stream);
        fclose(stream);
        assert_int_equal(size, strlen(text));
        assert_memory_equal(from_disk, text, size);
        assert_true(strlen(weft_preset_help(count)) > 10);
        assert_non_null(strstr(text, weft_preset_help(count)));
    }
    static const char *const promised[] = {"velvet", "cotton", "denim", "wool",     "silk",
                                           "satin",  "linen",  "felt",  "corduroy", "microfibre"};
    for (size_t k = 0; k < sizeof promised / sizeof *promised; k++) {
        int found = 0;
        for (int p = 0; p < count; p++) found += strcmp(weft_preset_name(p), promised[k]) == 0;
        if (found != 1) fail_msg("%s: %d presets", promised[k], found);
    }
    assert_null(weft_preset_name(-1));
    assert_null(weft_preset_text(count));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_of_every_form_are_read),
        cmocka_unit_test(byte_order_mark_of_a_material_file_is_skipped),
        cmocka_unit_test(choices_of_a_material_file_are_ids_and_aliases),
        cmocka_unit_test(implausible_values_of_a_file_are_named_in_warnings),
        cmocka_unit_test(wrong_material_file_is_an_error_of_one_line),
        cmocka_unit_test(cutoff_below_zero_is_repaired_with_a_warning),
        cmocka_unit_test(material_file_changes_materials_and_keeps_meshes),
        cmocka_unit_test(failed_material_file_changes_nothing),
        cmocka_unit_test(textures_are_found_beside_the_material_file),
        cmocka_unit_test(presets_load_without_warnings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
