/* The weave of a material file: what it may say, what is refused, and how it comes back. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "scene/record/scene.h"
#include "scratch.h"
#include "shading/weave/weave_light.h"
#include "weave/weft_cloth.h"
#include "weft/weft.h"
#include "woven_presets.h"

/* Warnings that speak of a weave. */
typedef struct Warned {
    int weaves;
} Warned;

static void count_warning(void *user, WeftMessage message, const char *text) {
    (void)message;
    ((Warned *)user)->weaves += strstr(text, "weft.weave") != NULL;
}

static WeftScene *scene_of_cloth(void) {
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

static WeftResult put(WeftScene *scene, const char *text, WeftError *error) {
    return weft_scene_assign_material_memory(scene, NULL, text, strlen(text), "mine.json", NULL, error);
}

static const char *const denim = "{\"weave\": {\"draft\": \"twill 3/1; warp 1k; weft 1w; sett 20 10\", "
                                 "\"warp\": {\"yarn\": \"wool\", \"alpha\": 0.45, \"twist\": 30}, \"weft\": "
                                 "{\"color\": \"#808080\"}, \"metres\": 0.5, \"seed\": 7}}";

static void a_weave_is_a_cloth_of_the_scene(void **state) {
    (void)state;
    WeftScene *scene = scene_of_cloth();
    WeftError error;
    if (put(scene, denim, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(scene->cloth_count, 1);
    assert_int_equal(scene->materials[0].cloth, 1);
    assert_int_equal(scene->materials[1].cloth, 0);
    const WeftCloth *cloth = scene->cloths[0];
    assert_int_equal(cloth->weave.warps, 4);
    assert_float_equal(cloth->per_uv[WEFT_WARP], 1000.0f, 1.0f); /* 20 per cm, half a metre */
    assert_float_equal(cloth->per_uv[WEFT_WEFT], 500.0f, 1.0f);
    assert_float_equal(cloth->yarns[WEFT_WARP].alpha, 0.45f, 1e-6f);
    assert_float_equal(cloth->yarns[WEFT_WARP].twist, 0.5236f, 1e-4f);
    assert_float_equal(cloth->weave.seed, 7.0f, 0.0f);
    assert_true(cloth->albedos[0] < 0.1f);     /* black warp */
    assert_true(cloth->albedos[4 * 3] > 0.5f); /* grey weft, where the draft had white */
    for (int k = 0; k < scene->mesh_count; k++)
        if (scene->meshes[k].material == 0) assert_non_null(scene->meshes[k].tangent);
    assert_int_equal(put(scene, "{}", &error), WEFT_OK); /* and off again */
    assert_int_equal(scene->materials[0].cloth, 0);
    weft_scene_free(scene);
}

static void broken_weaves_are_refused_in_one_line(void **state) {
    (void)state;
    static const char *const bad[] = {
        "3",
        "{}",
        "[]",
        "{\"draft\": 3}",
        "{\"draft\": \"velvet\"}",
        "{\"draft\": \"plain\", \"weird\": 1}",
        "{\"draft\": \"plain\", \"metres\": 0}",
        "{\"draft\": \"plain\", \"metres\": \"1\"}",
        "{\"draft\": \"plain\", \"metres\": -1}",
        "{\"draft\": \"plain\", \"seed\": 1e9}",
        "{\"draft\": \"plain\", \"warp\": \"nettle\"}",
        "{\"draft\": \"plain\", \"warp\": 3}",
        "{\"draft\": \"plain\", \"warp\": {\"color\": \"#-00001\"}}",
        "{\"draft\": \"plain\", \"warp\": {\"color\": \"#0x1234\"}}",
        "{\"draft\": \"plain\", \"warp\": []}",
        "{\"draft\": \"plain\", \"warp\": {\"yarn\": 3}}",
        "{\"draft\": \"plain\", \"weft\": {\"alpha\": \"1\"}}",
        "{\"draft\": \"plain\", \"weft\": {\"alpha\": 7}}",
        "{\"draft\": \"plain\", \"weft\": {\"crimp\": 90}}",
        "{\"draft\": \"plain\", \"weft\": {\"beauty\": 1}}",
        "{\"draft\": \"plain\", \"weft\": {\"color\": \"red\"}}",
        "{\"draft\": \"plain\", \"weft\": {\"color\": \"#12345z\"}}",
        "{\"draft\": \"satin 4001/2\"}",
    };
    WeftScene *scene = scene_of_cloth();
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        char text[256];
        WeftError error;
        snprintf(text, sizeof text, "{\"weave\": %s}", bad[k]);
        if (put(scene, text, &error) == WEFT_OK) fail_msg("%s was taken", bad[k]);
        assert_true(error.text[0] && !strchr(error.text, '\n'));
        if (strstr(bad[k], "velvet") || strstr(bad[k], "nettle")) { /* a bad word is a bad file, which is named */
            assert_int_equal(error.message, WEFT_MESSAGE_MATERIAL_FILE);
            assert_non_null(strstr(error.text, strstr(bad[k], "velvet") ? "velvet: is not a weave" : "is not a yarn"));
        }
        assert_int_equal(scene->cloth_count, 0);
        assert_int_equal(scene->materials[0].cloth, 0);
    }
    weft_scene_free(scene);
}

/* That material 0 of both scenes is woven alike. */
static void assert_woven_alike(const WeftScene *one, const WeftScene *other) {
    assert_true(one->materials[0].cloth && other->materials[0].cloth);
    const Weave *a = &one->cloths[one->materials[0].cloth - 1]->weave,
                *b = &other->cloths[other->materials[0].cloth - 1]->weave;
    assert_int_equal(a->warps, b->warps);
    assert_int_equal(a->picks, b->picks);
    for (int k = 0; k < 100; k++) {
        const float x = 0.61f * (float)k, y = 0.37f * (float)k;
        assert_float_equal(weave_point(a, x, y, 0.0f, 0.0f).height, weave_point(b, x, y, 0.0f, 0.0f).height, 1e-5f);
    }
    for (int k = 0; k < 3 * (a->warps + a->picks); k++) assert_float_equal(a->albedos[k], b->albedos[k], 0.0f);
}

/* Saves the scene or its first material, and compares what a fresh scene reads. */
static void assert_saved(const WeftScene *scene, const char *path) {
    WeftError error = {0};
    WeftScene *fresh = NULL;
    const bool material = strstr(path, ".json") != NULL;
    WeftResult result =
        material ? weft_scene_save_material(scene, 0, path, &error) : weft_scene_save(scene, path, &error);
    if (result == WEFT_OK && material) {
        fresh = scene_of_cloth();
        result = weft_scene_assign_material(fresh, NULL, path, NULL, &error);
    } else if (result == WEFT_OK) {
        result = weft_scene_load(path, &fresh, NULL, &error);
    }
    if (result != WEFT_OK) fail_msg("%s", error.text);
    assert_woven_alike(scene, fresh);
    weft_scene_free(fresh);
}

static void a_saved_weave_is_woven_again(void **state) {
    (void)state;
    char work[SCRATCH_SIZE], path[SCRATCH_SIZE + 64];
    WeftError error;
    WeftScene *scene = scene_of_cloth();
    assert_true(scratch_make(work));
    assert_int_equal(put(scene, denim, &error), WEFT_OK);
    snprintf(path, sizeof path, "%s/woven.json", work);
    assert_saved(scene, path);
    snprintf(path, sizeof path, "%s/woven.glb", work);
    assert_saved(scene, path);
    weft_scene_free(scene);
    assert_true(scratch_remove(work));
}

/* A draft in a file is found from another folder, and is still there in a glTF when that file is not. */
static void a_weave_of_a_draft_in_a_file_is_saved_with_it(void **state) {
    (void)state;
    char work[SCRATCH_SIZE], path[SCRATCH_SIZE + 64], draft_path[SCRATCH_SIZE + 64];
    static const char text[] = "{\"weave\": {\"draft\": \"own draft.wif\", \"weft\": \"silk\"}}";
    WeftError error = {0};
    WeftDraft *draft;
    WeftScene *scene = scene_of_cloth();
    assert_true(scratch_make(work));
    assert_int_equal(weft_draft_parse("satin 5/2; warp 3#123456 2r; sett 31 17", &draft, &error), WEFT_OK);
    snprintf(draft_path, sizeof draft_path, "%s/own draft.wif", work);
    assert_int_equal(weft_draft_write(draft, draft_path, &error), WEFT_OK);
    weft_draft_free(draft);
    snprintf(path, sizeof path, "%s/mine.json", work);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fputs(text, file) < 0, 0);
    assert_int_equal(fclose(file), 0);
    if (weft_scene_assign_material(scene, NULL, path, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    snprintf(path, sizeof path, "%s/below", work);
    assert_int_equal(mkdir(path, 0700), 0);
    snprintf(path, sizeof path, "%s/below/saved.json", work);
    assert_saved(scene, path);
    assert_int_equal(unlink(draft_path), 0);
    WeftScene *other = scene_of_cloth();
    assert_int_not_equal(weft_scene_assign_material(other, NULL, path, NULL, &error), WEFT_OK);
    assert_non_null(strstr(error.text, "../own draft.wif")); /* it was named, not copied */
    weft_scene_free(other);
    snprintf(path, sizeof path, "%s/below/saved.glb", work);
    assert_saved(scene, path);
    snprintf(path, sizeof path, "%s/below/saved.gltf", work);
    assert_saved(scene, path);
    weft_scene_free(scene);
    assert_true(scratch_remove(work));
}

/* Memory does not grow with every weave that is tried again. */
static void a_weave_that_the_scene_has_is_not_added(void **state) {
    (void)state;
    static const char *const other = "{\"weave\": {\"draft\": \"plain\", \"metres\": 1}}";
    WeftScene *scene = scene_of_cloth();
    WeftError error;
    for (int k = 0; k < 40; k++) {
        assert_int_equal(put(scene, k % 2 ? other : denim, &error), WEFT_OK);
        assert_int_equal(scene->materials[0].cloth, 1 + k % 2);
    }
    assert_int_equal(scene->cloth_count, 2);
    weft_scene_free(scene);
}

/* A glTF's weave never opens a file; what makes no sense is left out with a line. */
static void weave_of_a_gltf_reads_no_file(void **state) {
    (void)state;
    static const char *const bad[] = {"3", "{\"draft\": \"/etc/passwd\"}", "{\"draft\": \"[WIF]\\nVersion=1.1\\n\"}",
                                      "{\"draft\": \"plain\", \"warp\": \"nettle\"}"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        char text[512];
        Warned warned = {0};
        const WeftLog log = {count_warning, &warned};
        WeftScene *scene;
        WeftError error;
        snprintf(text, sizeof text,
                 "{\"asset\": {\"version\": \"2.0\"}, \"materials\": [{\"extras\": {\"weft\": {\"weave\": %s}}}]}",
                 bad[k]);
        if (weft_scene_load_memory(text, strlen(text), "some.gltf", &scene, &log, &error) != WEFT_OK)
            fail_msg("%s", error.text);
        assert_int_equal(scene->cloth_count, 0);
        assert_int_equal(scene->materials[0].cloth, 0);
        assert_int_equal(warned.weaves, 1);
        weft_scene_free(scene);
    }
}

/* A number of a cloth that the scene lacks is refused, one that it has is taken. */
static void numbers_name_cloths_of_the_scene(void **state) {
    (void)state;
    WeftScene *scene = scene_of_cloth();
    WeftMaterial material;
    WeftError error;
    assert_int_equal(weft_scene_material(scene, 1, &material, &error), WEFT_OK);
    material.cloth = 1;
    assert_int_not_equal(weft_scene_put_material(scene, 1, &material, &error), WEFT_OK);
    assert_int_equal(put(scene, denim, &error), WEFT_OK);
    assert_int_equal(weft_scene_put_material(scene, 1, &material, &error), WEFT_OK);
    material.cloth = -1;
    assert_int_not_equal(weft_scene_put_material(scene, 1, &material, &error), WEFT_OK);
    weft_scene_free(scene);
}

/* A cloth that is woven anew is one more of the scene, differs in what was asked for alone, and is saved. */
static void a_material_is_woven_anew(void **state) {
    (void)state;
    WeftScene *scene = scene_of_cloth();
    WeftYarn yarns[2];
    WeftDraft *draft;
    WeftError error;
    assert_int_equal(put(scene, denim, &error), WEFT_OK);
    assert_null(weft_scene_cloth(scene, 0, yarns));
    assert_null(weft_scene_cloth(scene, 2, yarns));
    const WeftDraft *was = weft_scene_cloth(scene, 1, yarns);
    assert_non_null(was);
    assert_int_equal(weft_draft_copy(was, &draft, &error), WEFT_OK);
    weft_draft_set_up(draft, 5, -4, !weft_draft_warp_up(draft, 1, 0)); /* indices wrap */
    assert_int_not_equal(weft_draft_warp_up(draft, 1, 0), weft_draft_warp_up(was, 1, 0));
    yarns[WEFT_WARP].crimp = 0.3f;
    if (weft_scene_set_weave(scene, 0, draft, yarns, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(scene->cloth_count, 2);
    assert_int_equal(scene->materials[0].cloth, 2);
    const WeftCloth *first = scene->cloths[0], *second = scene->cloths[1];
    assert_float_equal(second->yarns[WEFT_WARP].crimp, 0.3f, 1e-6f);
    assert_float_equal(second->yarns[WEFT_WARP].alpha, 0.45f, 1e-6f);
    assert_float_equal(second->per_uv[WEFT_WARP], first->per_uv[WEFT_WARP], 0.1f);
    assert_float_equal(second->weave.seed, 7.0f, 0.0f);
    for (int k = 0; k < 3 * 8; k++) /* a WIF has colours of 8 bits */
        assert_float_equal(second->albedos[k], first->albedos[k], 1e-3f);
    assert_int_equal(weft_draft_warp_up(weft_scene_cloth(scene, 2, NULL), 1, 0), weft_draft_warp_up(draft, 1, 0));
    assert_int_equal(weft_scene_set_weave(scene, 0, draft, yarns, &error), WEFT_OK); /* the same once more */
    assert_int_equal(scene->cloth_count, 2);
    yarns[WEFT_WEFT].alpha = NAN;
    assert_int_equal(weft_scene_set_weave(scene, 0, draft, yarns, &error), WEFT_USAGE);
    yarns[WEFT_WEFT].alpha = 7.0f;
    assert_int_not_equal(weft_scene_set_weave(scene, 0, draft, yarns, &error), WEFT_OK);
    assert_int_not_equal(weft_scene_set_weave(scene, 1, draft, yarns, &error), WEFT_OK); /* not woven */
    assert_int_not_equal(weft_scene_set_weave(scene, 99, draft, yarns, &error), WEFT_OK);
    assert_int_equal(scene->materials[0].cloth, 2);
    weft_draft_free(draft);
    weft_scene_free(scene);
}

/* Asserts that a prepared lobe's value is a number, for directions from the normal down to a cosine of 1e-4. */
#define ASSERT_FINITE(lobe, View, p, name)                                                                             \
    do {                                                                                                               \
        for (int o = 0; o < DIRECTIONS; o++) {                                                                         \
            View w;                                                                                                    \
            lobe##_view(p, direction(o), &w);                                                                          \
            for (int i = 0; i < DIRECTIONS; i++) {                                                                     \
                const LobeValue v = lobe##_value(p, &w, angles_between(direction(o), direction(i)));                   \
                if (!(v.f >= 0.0f && v.f < 1e8f && v.s >= 0.0f && v.s <= 1.0f))                                        \
                    fail_msg("%s: f %g, s %g at %d, %d", name, (double)v.f, (double)v.s, o, i);                        \
            }                                                                                                          \
        }                                                                                                              \
    } while (0)

enum { DIRECTIONS = 48 };
static Dir direction(int k) {
    static const float cosines[] = {1e-4f, 1e-3f, 0.02f, 0.2f, 0.6f, 1.0f};
    const float z = cosines[k % 6], r = sqrtf(1.0f - z * z), phi = 0.785f * (float)(k / 6);
    return dir(r * cosf(phi), r * sinf(phi), z);
}

/* Bytes of a cloth's tables and of its colours at all levels. */
static size_t size_of(const WeftCloth *cloth) {
    const size_t warps = (size_t)cloth->weave.warps, picks = (size_t)cloth->weave.picks;
    size_t floats = 4 * warps * picks + 3 * (warps + picks);
    for (int level = 0; level < cloth->far.levels; level++) {
        int width, height;
        (void)cloth_far_level(&cloth->far, level, &width, &height);
        floats += 4 * FAR_LAYERS * (size_t)width * (size_t)height;
    }
    return sizeof(float) * floats;
}

/* The presets that are woven: ours, and those by the numbers of two papers. */
static void woven_presets_are_cloths_and_finite_to_the_horizon(void **state) {
    (void)state;
    for (int f = 0; f < WOVEN_FAMILIES; f++) {
        int found = 0;
        for (int k = 0; weft_preset_name(k); k++) {
            const char *name = weft_preset_name(k);
            if (woven_family(name) != f) continue;
            WeftScene *scene = scene_of_cloth();
            WeftError error;
            found++;
            if (put(scene, weft_preset_text(k), &error) != WEFT_OK) fail_msg("%s", error.text);
            assert_int_equal(scene->cloth_count, 1);
            const WeftCloth *cloth = scene->cloths[0];
            const WeftClothInfo info = weft_cloth_info(cloth);
            if (!(info.share[0] + info.share[1] > 0.95f)) fail_msg("%s is full of holes", name);
            assert_true(size_of(cloth) < (size_t)6 << 20);
            for (int t = 0; t < 2; t++) ASSERT_FINITE(woven, WovenView, &cloth->far.woven[t], name);
            for (int at = 0; at < 25; at++) {
                const WeavePoint point = weave_point(&cloth->weave, 7.31f * (float)at, 3.77f * (float)at, 0.0f, 0.0f);
                YarnPrepared yarn;
                if (!(point.height > WEAVE_NONE)) continue;
                yarn_prepare(weave_yarn(&cloth->weave, point), &yarn);
                ASSERT_FINITE(yarn, YarnView, &yarn, name);
            }
            weft_scene_free(scene);
        }
        assert_int_equal(found, woven_families[f].promised);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_weave_is_a_cloth_of_the_scene),
        cmocka_unit_test(broken_weaves_are_refused_in_one_line),
        cmocka_unit_test(a_saved_weave_is_woven_again),
        cmocka_unit_test(a_weave_of_a_draft_in_a_file_is_saved_with_it),
        cmocka_unit_test(a_weave_that_the_scene_has_is_not_added),
        cmocka_unit_test(weave_of_a_gltf_reads_no_file),
        cmocka_unit_test(numbers_name_cloths_of_the_scene),
        cmocka_unit_test(a_material_is_woven_anew),
        cmocka_unit_test(woven_presets_are_cloths_and_finite_to_the_horizon),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
