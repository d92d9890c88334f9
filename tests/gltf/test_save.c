/* What is saved as glTF comes back: the same picture byte by byte, the same materials; and what cannot be
 * written leaves nothing.
 *
 * Labels: slow unsanitized */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "scene/record/scene.h"
#include "scratch.h"
#include "u3m_text.h"
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
    if (weft_scene_load(name, &scene, NULL, &error) != WEFT_OK) fail_msg("%s: %s", name, error.text);
    return scene;
}

/* Read without a word. */
static void complain(void *user, WeftMessage message, const char *text) {
    (void)user;
    if (message != WEFT_MESSAGE_NONE) fail_msg("%s", text);
}

static WeftScene *saved(const WeftScene *scene, const char *name) {
    char path[128];
    WeftScene *back = NULL;
    WeftError error;
    const WeftLog log = {complain, NULL};
    snprintf(path, sizeof path, "%s/%s", folder, name);
    if (weft_scene_save(scene, path, &error) != WEFT_OK) fail_msg("%s", error.text);
    if (weft_scene_load(path, &back, &log, &error) != WEFT_OK) fail_msg("%s", error.text);
    return back;
}

static WeftImage drawn_from(const WeftScene *scene, const char *camera, int spp) {
    const WeftRenderDesc desc = {.width = 48, .height = 36, .camera = camera, .seed = 7};
    WeftRender *render;
    WeftImage image;
    WeftError error;
    if (weft_render_create(scene, &desc, &render, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_render_run(render, spp, 0.0, NULL, NULL);
    assert_int_equal(weft_render_image(render, &image, &error), WEFT_OK);
    weft_render_free(render);
    return image;
}

static WeftImage drawn(const WeftScene *scene) {
    return drawn_from(scene, weft_scene_info(scene).camera_count ? "0" : "auto", 2);
}

static void assert_same_textures(const WeftScene *a, int at_a, const WeftScene *b, int at_b) {
    WeftImage x = weft_scene_texture(a, at_a), y = weft_scene_texture(b, at_b);
    static const size_t sizes[] = {1, 2, 4};
    assert_int_equal(at_a > 0, at_b > 0);
    if (!at_a) return;
    assert_true(x.width == y.width && x.height == y.height && x.channels == y.channels && x.type == y.type);
    assert_memory_equal(x.pixels, y.pixels, (size_t)x.width * (size_t)x.height * (size_t)x.channels * sizes[x.type]);
    assert_int_equal(a->textures[at_a - 1].wrap_u, b->textures[at_b - 1].wrap_u);
    assert_int_equal(a->textures[at_a - 1].wrap_v, b->textures[at_b - 1].wrap_v);
    assert_int_equal(a->textures[at_a - 1].nearest, b->textures[at_b - 1].nearest);
}

/* Materials byte by byte, but for the numbers of textures, which are as they are; and the picture p of a. */
static void assert_same_as(const WeftScene *a, WeftImage p, const WeftScene *b, const char *name) {
    WeftError error;
    assert_int_equal(a->material_count, b->material_count);
    for (int k = 0; k < a->material_count; k++) {
        WeftMaterial x, y;
        assert_string_equal(weft_scene_material_name(a, k), weft_scene_material_name(b, k));
        assert_int_equal(weft_scene_material(a, k, &x, &error), WEFT_OK);
        assert_int_equal(weft_scene_material(b, k, &y, &error), WEFT_OK);
        for (int i = 0; i < WEFT_INPUTS_MAX; i++) {
            assert_same_textures(a, x.inputs[i].texture, b, y.inputs[i].texture);
            x.inputs[i].texture = y.inputs[i].texture = 0;
            if (memcmp(&x.inputs[i], &y.inputs[i], sizeof x.inputs[i]) != 0)
                fail_msg("%s: %s of material %d", name, weft_material_input_name(i), k);
        }
        if (memcmp(&x, &y, sizeof x) != 0) fail_msg("%s: material %d", name, k);
    }
    assert_int_equal(a->variant_count, b->variant_count);
    WeftImage q = drawn(b);
    if (memcmp(p.pixels, q.pixels, 48 * 36 * 4 * sizeof(float)) != 0) {
        float most = 0.0f;
        for (int k = 0; k < 48 * 36 * 4; k++)
            most = fmaxf(most, fabsf(((float *)p.pixels)[k] - ((float *)q.pixels)[k]));
        fail_msg("%s: another picture, by %g at most", name, (double)most);
    }
    weft_image_free(&q);
}

static void assert_same(const WeftScene *a, const WeftScene *b, const char *name) {
    WeftImage p = drawn(a);
    assert_same_as(a, p, b, name);
    weft_image_free(&p);
}

static void saved_built_in_scenes_read_as_they_were(void **state) {
    (void)state;
    for (int k = 0; weft_builtin_name(k); k++) {
        char path[64];
        snprintf(path, sizeof path, "builtin:%s", weft_builtin_name(k));
        WeftScene *scene = load(path), *packed = saved(scene, "a.glb"), *apart = saved(scene, "b.gltf");
        WeftScene *again = saved(packed, "c.glb");
        WeftImage picture = drawn(scene);
        assert_same_as(scene, picture, packed, path);
        assert_same_as(scene, picture, apart, path);
        assert_same_as(scene, picture, again, path);
        weft_image_free(&picture);
        weft_scene_free(again);
        weft_scene_free(apart);
        weft_scene_free(packed);
        weft_scene_free(scene);
    }
}

static void saved_presets_read_as_they_were(void **state) {
    (void)state;
    for (int k = 0; weft_preset_name(k); k++) {
        char path[64];
        WeftError error;
        WeftScene *scene = load("builtin:cloth");
        snprintf(path, sizeof path, "preset:%s", weft_preset_name(k));
        assert_int_equal(weft_scene_assign_material(scene, NULL, path, NULL, &error), WEFT_OK);
        WeftScene *back = saved(scene, k % 2 ? "p.glb" : "p.gltf");
        assert_same(scene, back, path);
        weft_scene_free(back);
        weft_scene_free(scene);
    }
}

static WeftImage pattern(int side, int channels, WeftPixelType type) {
    WeftImage image;
    assert_int_equal(weft_image_create(side, side, channels, type, &image, NULL), WEFT_OK);
    for (int k = 0; k < side * side * channels; k++) {
        if (type == WEFT_PIXEL_U8) ((uint8_t *)image.pixels)[k] = (uint8_t)(k * 37);
        if (type == WEFT_PIXEL_U16) ((uint16_t *)image.pixels)[k] = (uint16_t)(k * 3701);
        if (type == WEFT_PIXEL_F32) ((float *)image.pixels)[k] = (float)(k % 97) * 0.0103f;
    }
    return image;
}

static uint32_t dice = 1;
static float roll(void) {
    dice = dice * 1664525u + 1013904223u;
    return (float)(dice >> 8) * 0x1p-24f;
}

/* Whatever numbers, maps and choices there are. */
static void saved_scene_of_random_values_reads_as_it_was(void **state) {
    (void)state;
    WeftError error;
    WeftScene *scene = load("builtin:spheres");
    for (int c = 0; c < 12; c++) {
        WeftImage image = pattern(4 + c, c % 4 + 1, (WeftPixelType)(c / 4));
        assert_int_equal(weft_scene_add_texture(scene, &image, &error), c + 1);
        scene->textures[c].wrap_u = (TextureWrap)(c % 3);
        scene->textures[c].wrap_v = (TextureWrap)(c / 3 % 3);
        scene->textures[c].nearest = c % 5 == 0;
    }
    for (int k = 0; k < scene->material_count; k++) {
        WeftMaterial m;
        WeftInputInfo info;
        assert_int_equal(weft_scene_material(scene, k, &m, &error), WEFT_OK);
        for (int i = 0; weft_material_input_info(i, &info); i++) {
            WeftInput *input = &m.inputs[i];
            for (int c = 0; c < 3; c++) input->value[c] = roll() < 0.3f ? input->value[c] : roll();
            if (roll() < 0.3f) input->texture = 1 + (int)(roll() * 11.99f);
            input->texcoord = roll() < 0.2f;
            input->channel = (int)(roll() * 3.99f);
            input->given = roll() < 0.5f;
            for (int c = 0; c < 6 && roll() < 0.3f; c++) input->transform[c] = roll();
        }
        for (int c = 0; weft_material_choice_name(c); c++)
            for (int v = 0; weft_material_choice_value(c, v) && strcmp(weft_material_choice_name(c), "diffuse") != 0;
                 v++)
                if (roll() < 0.1f) m.choices[c] = v;
        m.alpha_mode = (WeftAlphaMode)(k % 3);
        m.alpha_cutoff = roll();
        m.double_sided = k % 2;
        m.unlit = k == 4;
        if (weft_scene_put_material(scene, k, &m, &error) != WEFT_OK) fail_msg("%s", error.text);
    }
    const WeftLight lights[] = {
        {.kind = WEFT_LIGHT_DIRECTIONAL, .direction = {0.3f, -1.0f, 0.2f}, .color = {3.0f, 2.5f, 0.1f}},
        {.kind = WEFT_LIGHT_POINT, .position = {1.1f, 3.0f, 0.7f}, .color = {20.3f, 0.7f, 12.0f}, .range = 9.5f},
        {.kind = WEFT_LIGHT_SPOT,
         .position = {-1.0f, 4.0f, 1.0f},
         .direction = {0.1f, -1.0f, 0.0f},
         .color = {30.0f, 31.0f, 32.0f},
         .inner = 20.0f,
         .outer = 20.0f},
        {.kind = WEFT_LIGHT_SPOT,
         .position = {-1.0f, 4.0f, 1.0f},
         .direction = {0.0f, -1.0f, 0.0f},
         .color = {0.1f, 0.2f, 0.3f},
         .inner = 11.0f,
         .outer = 33.3f}};
    for (int k = 0; k < 4; k++) assert_int_equal(weft_scene_add_light(scene, &lights[k], &error), WEFT_OK);
    WeftScene *packed = saved(scene, "any thing%.glb"), *apart = saved(scene, "any thing%.gltf");
    const float grey[3] = {0.3f, 0.3f, 0.3f};
    WeftScene *const all[] = {scene, packed, apart};
    for (int k = 0; k < 3; k++) assert_int_equal(weft_scene_set_environment_color(all[k], grey, &error), WEFT_OK);
    assert_same(scene, packed, "anything, .glb");
    assert_same(scene, apart, "anything, .gltf");
    assert_non_null(weft_scene_texture_path(apart, 1));
    assert_null(weft_scene_texture_path(packed, 1));
    for (int k = 0; k < 3; k++) weft_scene_free(all[k]);
}

static const struct {
    const char *name;
    float value[3];
} coming[] = {{"fuzz", {0.7f}},
              {"fuzz_color", {0.9f, 0.6f, 0.3f}},
              {"fuzz_roughness", {0.4f}},
              {"diffuse_roughness", {0.55f}},
              {"retroreflection", {0.25f}},
              {"clearcoat", {0.5f}},
              {"clearcoat_roughness", {0.3f}},
              {"coat_ior", {1.7f}},
              {"coat_color", {0.9f, 0.8f, 0.7f}},
              {"coat_darkening", {0.6f}},
              {"coat_anisotropy", {0.4f}},
              {"coat_anisotropy_direction", {1.0f}},
              {"transmission", {0.6f}},
              {"thickness", {0.02f}},
              {"attenuation_color", {0.9f, 0.5f, 0.7f}},
              {"attenuation_distance", {0.3f}},
              {"ior", {1.4f}}};
enum { COMING = sizeof coming / sizeof *coming };

static char *text_of(const char *name) {
    char path[128];
    static char text[1 << 20];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    text[fread(text, 1, sizeof text - 1, f)] = '\0';
    fclose(f);
    return text;
}

/* Extensions that are drafts yet: for readers that have them, and their fallbacks for those that do not. */
static void saved_coming_extensions_read_as_they_were(void **state) {
    (void)state;
    WeftError error;
    WeftMaterial m, back;
    WeftScene *scene = load("builtin:ball");
    assert_int_equal(weft_scene_material(scene, 0, &m, &error), WEFT_OK);
    for (int k = 0; k < COMING; k++)
        memcpy(m.inputs[weft_material_input_find(coming[k].name)].value, coming[k].value, sizeof coming[k].value);
    memset(m.inputs[weft_material_input_find("sheen_color")].value, 0, 3 * sizeof(float));
    assert_int_equal(weft_scene_put_material(scene, 0, &m, &error), WEFT_OK);
    WeftScene *first = saved(scene, "coming.gltf");
    const char *text = text_of("coming.gltf");
    static const char *const names[] = {
        "KHR_materials_fuzz",   "KHR_materials_coat",      "KHR_materials_diffuse_roughness",
        "KHR_materials_sheen",  "KHR_materials_clearcoat", "KHR_materials_retroreflection",
        "fuzzRoughnessFactor",  "diffuseRoughnessFactor",  "KHR_materials_transmission",
        "KHR_materials_volume", "attenuationDistance"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (!strstr(text, names[k])) fail_msg("%s is not saved", names[k]);
    assert_int_equal(weft_scene_material(first, 0, &back, &error), WEFT_OK);
    for (int k = 0; k < COMING; k++) {
        const float *value = back.inputs[weft_material_input_find(coming[k].name)].value;
        for (int c = 0; c < 3; c++)
            if (!(fabsf(value[c] - coming[k].value[c]) <= 0.0f)) fail_msg("%s: %g", coming[k].name, (double)value[c]);
    }
    const float *sheen = back.inputs[weft_material_input_find("sheen_color")].value;
    assert_true(sheen[0] > sheen[1] && sheen[1] > sheen[2] && sheen[2] > 0.0f);
    WeftScene *second = saved(first, "again.gltf");
    assert_same(first, second, "fuzz, coat, matt base, retroreflection, glass");
    weft_scene_free(second);
    weft_scene_free(first);
    weft_scene_free(scene);
}

static void write_text(const char *name, const char *text) {
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "w");
    assert_true(f && fputs(text, f) >= 0);
    assert_int_equal(fclose(f), 0);
}

/* Returns builtin:bend in a U3M whose back has a map and other numbers than its front. */
static WeftScene *two_faced(void) {
    char back[U3M_TEXT], text[U3M_TEXT], path[128];
    WeftError error;
    WeftImage image = pattern(4, 3, WEFT_PIXEL_U8);
    snprintf(path, sizeof path, "%s/map.png", folder);
    assert_int_equal(weft_image_write(path, &image, &error), WEFT_OK);
    weft_image_free(&image);
    snprintf(back, sizeof back, "%s", U3M_VISUAL);
    u3m_put(
        back, "\"basecolor\"",
        "{\"constant\":{\"r\":1,\"g\":1,\"b\":1},\"texture\":{\"mode\":\"multiply\",\"factor\":{\"r\":0.9,\"g\":0.3,"
        "\"b\":0.1},\"image\":{\"dpi\":{\"x\":100,\"y\":100},\"width\":20,\"height\":20,\"path\":\"map.png\","
        "\"repeat\":{\"mode\":\"normal\",\"rotation\":0}}}}");
    u3m_put(back, "\"roughness\"", U3M_NUMBER_OF("0.25"));
    u3m_text(text, "\"back\"", back);
    write_text("faces.u3m", text);
    snprintf(path, sizeof path, "%s/faces.u3m", folder);
    WeftScene *scene = load("builtin:bend");
    if (weft_scene_assign_material(scene, NULL, path, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

/* Returns the mean of each channel of a picture from behind, where the back is seen. */
static void mean_from_behind(const WeftScene *scene, double mean[3]) {
    WeftImage image = drawn_from(scene, "-0.25,-0.13,-0.39;0.02,0,0.05;28", 4);
    for (int c = 0; c < 3; c++) {
        mean[c] = 0.0;
        for (int k = 0; k < 48 * 36; k++) mean[c] += (double)((float *)image.pixels)[4 * k + c] / (48.0 * 36.0);
    }
    weft_image_free(&image);
}

/* A back comes with its numbers and its map, to the same picture from behind; what has a weave of its own is none. */
static void saved_backs_read_as_they_were(void **state) {
    (void)state;
    WeftScene *scene = two_faced(), *plain = load("builtin:bend");
    double other[3], wanted[3];
    mean_from_behind(plain, other);
    mean_from_behind(scene, wanted);
    if (!(fabs(wanted[2] / other[2] - 1.0) > 0.05)) fail_msg("the back is not seen: %g, %g", wanted[2], other[2]);
    static const char *const names[] = {"faces.glb", "faces.gltf"};
    for (int k = 0; k < 2; k++) {
        WeftScene *read = saved(scene, names[k]);
        double found[3];
        assert_same(scene, read, names[k]);
        mean_from_behind(read, found);
        for (int c = 0; c < 3; c++)
            if (!(fabs(found[c] - wanted[c]) <= 0.0)) fail_msg("%s: %.9g, not %.9g", names[k], found[c], wanted[c]);
        assert_int_equal(read->materials[read->material_count].inputs[0].texture > 0,
                         scene->materials[scene->material_count].inputs[0].texture > 0);
        weft_scene_free(read);
    }
    weft_scene_free(plain);
    weft_scene_free(scene);
}

static int warnings;
static void count_warning(void *user, WeftMessage message, const char *text) {
    (void)user;
    warnings += message == WEFT_MESSAGE_GLTF_WARN_IGNORED && strstr(text, "extras.weft.back") != NULL;
}

static void backs_that_make_no_sense_are_refused_or_left_out(void **state) {
    (void)state;
    static const struct {
        const char *back;
        WeftResult result;
        int warnings;
    } rows[] = {{"7", WEFT_INPUT, 0},
                {"[]", WEFT_INPUT, 0},
                {"{\"extras\":{\"weft\":{\"back\":{}}}}", WEFT_OK, 1},
                {"{\"pbrMetallicRoughness\":{\"roughnessFactor\":\"x\"}}", WEFT_INPUT, 0},
                {"{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":3}}}", WEFT_INPUT, 0},
                {"{}", WEFT_OK, 0}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[512];
        WeftScene *scene = NULL;
        WeftError error;
        const WeftLog log = {count_warning, NULL};
        warnings = 0;
        snprintf(text, sizeof text,
                 "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{\"extras\":{\"weft\":{\"back\":%s}}}]}",
                 rows[k].back);
        const WeftResult result = weft_scene_load_memory(text, strlen(text), "faces", &scene, &log, &error);
        if (result != rows[k].result || warnings != rows[k].warnings)
            fail_msg("%s: %d, %d warnings", rows[k].back, result, warnings);
        if (result != WEFT_OK) assert_non_null(strstr(error.text, "materials[0].extras.weft.back"));
        weft_scene_free(scene);
    }
}

static int file_count(void) {
    char command[96];
    int count = -1;
    snprintf(command, sizeof command, "ls -A %s | wc -l", folder);
    FILE *pipe = popen(command, "r");
    assert_true(pipe && fscanf(pipe, "%d", &count) == 1);
    pclose(pipe);
    return count;
}

static void failed_save_leaves_no_files(void **state) {
    (void)state;
    WeftScene *scene = load("builtin:cloth");
    WeftError error;
    char path[128];
    assert_int_equal(weft_scene_save(scene, "scene.obj", &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_SCENE_KIND);
    assert_int_equal(weft_scene_save(scene, ".glb", &error), WEFT_INPUT);
    static const char *const wrong[] = {"/nowhere/a.glb", "/nowhere/a.gltf"};
    for (int k = 0; k < 2; k++) {
        assert_int_equal(weft_scene_save(scene, wrong[k], &error), WEFT_RESOURCES);
        assert_int_equal(error.message, WEFT_MESSAGE_FILE_WRITE);
    }
    snprintf(path, sizeof path, "%s/folder.glb", folder);
    assert_int_equal(mkdir(path, 0700), 0);
    assert_int_equal(weft_scene_save(scene, path, &error), WEFT_RESOURCES);
    /* a disk that is full after 10000 bytes */
    struct rlimit old, small = {10000, 10000};
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    small.rlim_max = old.rlim_max;
    signal(SIGXFSZ, SIG_IGN);
    int before = file_count();
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    for (int k = 0; k < 2; k++) {
        snprintf(path, sizeof path, "%s/full.%s", folder, k ? "gltf" : "glb");
        WeftResult result = weft_scene_save(scene, path, &error);
        assert_int_equal(result, WEFT_RESOURCES);
        assert_int_equal(error.message, WEFT_MESSAGE_FILE_WRITE);
        assert_int_equal(access(path, F_OK), -1);
    }
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
    assert_int_equal(file_count(), before);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(saved_built_in_scenes_read_as_they_were),
                                       cmocka_unit_test(saved_presets_read_as_they_were),
                                       cmocka_unit_test(saved_scene_of_random_values_reads_as_it_was),
                                       cmocka_unit_test(saved_coming_extensions_read_as_they_were),
                                       cmocka_unit_test(saved_backs_read_as_they_were),
                                       cmocka_unit_test(backs_that_make_no_sense_are_refused_or_left_out),
                                       cmocka_unit_test(failed_save_leaves_no_files)};
    return cmocka_run_group_tests(tests, begin, end);
}
