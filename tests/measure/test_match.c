/* Matches: nothing is between a thing and itself, what made a reflection is found again, and what is found is
 * never worse than the numbers as they were.
 *
 * Labels: unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/pi.h"
#include "scratch.h"
#include "weft/weft.h"

static WeftReflection *of_lobe(const WeftLobe *lobe) {
    WeftReflection *reflection;
    WeftError error;
    if (weft_reflection_of_lobe(lobe, &reflection, &error) != WEFT_OK) fail_msg("%s", error.text);
    return reflection;
}

static WeftReflection *of_material(const WeftMaterial *material) {
    WeftReflection *reflection;
    WeftError error;
    if (weft_reflection_create(material, &reflection, &error) != WEFT_OK) fail_msg("%s", error.text);
    return reflection;
}

static WeftLobe lobe_named(const char *id) {
    WeftLobe lobe;
    WeftError error;
    if (weft_lobe_init(id, &lobe, &error) != WEFT_OK) fail_msg("%s", error.text);
    return lobe;
}

/* A coloured lobe somewhere in its plausible range. Fibres that lean count an alpha below 0.38 as that, so
 * all are placed above. */
static WeftLobe coloured(int index) {
    const WeftLobeInfo *info = weft_lobe_info(index);
    WeftLobe lobe = lobe_named(info->id);
    const float color[3] = {0.8f, 0.5f, 0.3f}, second[3] = {0.9f, 0.6f, 0.7f};
    for (int k = 0; k < info->param_count; k++)
        if (!info->params[k].choices)
            lobe.params[k] =
                info->params[k].low + (0.42f + 0.09f * (float)k) * (info->params[k].high - info->params[k].low);
    memcpy(lobe.f0, color, sizeof color);
    if (info->traits & WEFT_LOBE_TWO_COLORS) memcpy(lobe.f90, second, sizeof second);
    return lobe;
}

static WeftMaterial cloth(int profile) {
    static const char *const inputs[][2] = {{"base_color", "0.5,0.2,0.1"},
                                            {"sheen_color", "0.9,0.8,0.6"},
                                            {"sheen_roughness", "0.5"},
                                            {"roughness", "0.9"}};
    WeftMaterial material;
    WeftError error;
    weft_material_default(&material);
    for (size_t k = 0; k < sizeof inputs / sizeof *inputs; k++)
        assert_int_equal(weft_material_set(&material, inputs[k][0], inputs[k][1], NULL, &error), WEFT_OK);
    assert_int_equal(weft_material_set(&material, "profile", weft_profile_name(profile), NULL, &error), WEFT_OK);
    return material;
}

static void metric_of_white_and_half_grey_is_half(void **state) {
    (void)state;
    WeftLobe white = lobe_named("lambert"), grey = white;
    for (int c = 0; c < 3; c++) grey.f0[c] = 0.5f;
    WeftReflection *a = of_lobe(&white), *b = of_lobe(&grey);
    WeftError error;
    double apart;
    assert_int_equal(weft_brdf_distance(b, a, WEFT_PART_ALL, WEFT_BRDF_METRIC_COSINE, &apart, &error), WEFT_OK);
    assert_true(fabs(apart - 0.5) < 1e-6);
    assert_int_equal(weft_brdf_distance(a, b, WEFT_PART_ALL, WEFT_BRDF_METRIC_COSINE, &apart, &error), WEFT_OK);
    assert_true(fabs(apart - 1.0) < 1e-6);
    /* parts that neither has, and that one has */
    assert_int_equal(weft_brdf_distance(a, b, WEFT_PART_SHEEN, WEFT_BRDF_METRIC_COSINE, &apart, &error), WEFT_OK);
    assert_true(!(apart > 0.0));
    assert_int_equal(weft_brdf_distance(a, b, WEFT_PART_ALL, (WeftBrdfMetric)7, &apart, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_DESC);
    assert_string_equal(weft_brdf_metric_name(WEFT_BRDF_METRIC_PICTURE), "picture");
    assert_null(weft_brdf_metric_name(WEFT_BRDF_METRIC_COUNT));
    weft_reflection_free(a);
    weft_reflection_free(b);
}

/* What the directions of metric cosine sum up is the bihemispherical integral: against E by quadrature. */
static void sum_of_metric_cosine_is_the_integral(void **state) {
    (void)state;
    const char *const ids[] = {"charlie-neubelt", "ashikhmin-conty-kulla", "ggx"};
    WeftLobe black = lobe_named("lambert");
    memset(black.f0, 0, sizeof black.f0);
    WeftReflection *lambert, *to = of_lobe(&black);
    WeftLobe white = lobe_named("lambert");
    lambert = of_lobe(&white);
    for (size_t k = 0; k < sizeof ids / sizeof *ids; k++) {
        WeftLobe lobe = lobe_named(ids[k]);
        WeftReflection *of = of_lobe(&lobe);
        double apart, integral = 0.0;
        enum { STEPS = 64 };
        for (int j = 0; j < STEPS; j++) {
            float e[3];
            weft_lobe_albedo(&lobe, sqrtf(((float)j + 0.5f) / STEPS), e);
            integral += (double)e[0] / STEPS;
        }
        /* over what lambert reflects, |f - 0| sums up to E */
        assert_int_equal(weft_brdf_distance(of, to, WEFT_PART_ALL, WEFT_BRDF_METRIC_COSINE, &apart, NULL), WEFT_OK);
        assert_true(fabs(apart - 1.0) < 1e-6);
        WeftLobe grown = lobe;
        for (int c = 0; c < 3; c++) grown.f0[c] *= 100.0f, grown.f90[c] *= 100.0f;
        WeftReflection *large = of_lobe(&grown);
        assert_int_equal(weft_brdf_distance(large, lambert, WEFT_PART_ALL, WEFT_BRDF_METRIC_COSINE, &apart, NULL),
                         WEFT_OK);
        print_message("%s: %.4f, by quadrature %.4f\n", ids[k], (apart + 1.0) / 100.0, integral);
        assert_true(fabs((apart + 1.0) / 100.0 - integral) < 0.03 * integral);
        weft_reflection_free(large);
        weft_reflection_free(of);
    }
    weft_reflection_free(to);
    weft_reflection_free(lambert);
}

/* A to A: not a digit moves. */
static void match_to_itself_changes_nothing(void **state) {
    (void)state;
    for (int index = 0; index < weft_lobe_count(); index++) {
        if (weft_lobe_info(index)->traits & WEFT_LOBE_REFERENCE) continue;
        WeftLobe lobe = coloured(index), found = lobe;
        WeftReflection *from = of_lobe(&lobe);
        WeftMatch match;
        for (int metric = 0; metric < WEFT_BRDF_METRIC_COUNT; metric++) {
            assert_int_equal(weft_match_lobe(from, (WeftBrdfMetric)metric, 0, &found, &match, NULL), WEFT_OK);
            for (int k = 0; k < WEFT_LOBE_PARAMS_MAX; k++)
                assert_true(fabsf(found.params[k] - lobe.params[k]) <= 1e-3f);
            for (int c = 0; c < 3; c++) assert_true(fabsf(found.f0[c] - lobe.f0[c]) <= 1e-3f);
            assert_true(match.matched < 1e-6);
        }
        weft_reflection_free(from);
    }
    for (int profile = 0; weft_profile_name(profile); profile++) {
        WeftMaterial material = cloth(profile), found = material;
        WeftReflection *from = of_material(&material);
        WeftMatch match;
        assert_int_equal(weft_match_material(from, WEFT_BRDF_METRIC_COSINE, NULL, &found, &match, NULL), WEFT_OK);
        for (int k = 0; k < WEFT_INPUTS_MAX; k++)
            for (int c = 0; c < 3; c++)
                assert_true(fabsf(found.inputs[k].value[c] - material.inputs[k].value[c]) <= 1e-3f);
        assert_true(match.matched < 1e-6);
        weft_reflection_free(from);
    }
}

/* How far two lobes of one kind are apart. */
static double lobes_apart(const WeftLobe *a, const WeftLobe *b) {
    WeftReflection *to = of_lobe(a), *from = of_lobe(b);
    double apart = 1.0;
    assert_int_equal(weft_brdf_distance(to, from, WEFT_PART_ALL, WEFT_BRDF_METRIC_COSINE, &apart, NULL), WEFT_OK);
    weft_reflection_free(to);
    weft_reflection_free(from);
    return apart;
}

/* A parameter was found again, or is one that changes nothing there. */
static bool found_again(const WeftLobe *lobe, const WeftLobe *found, int param) {
    WeftLobe moved = *lobe;
    moved.params[param] = found->params[param];
    return fabsf(found->params[param] - lobe->params[param]) <= 1e-3f || lobes_apart(&moved, lobe) < 1e-6;
}

/* From the defaults to whatever made the samples. Of fabric-lambert the roughness only scales, as the colour
 * does: the two cannot be told apart, so that the error alone counts. */
static void parameters_of_a_lobe_are_found_from_its_defaults(void **state) {
    (void)state;
    for (int index = 0; index < weft_lobe_count(); index++) {
        const WeftLobeInfo *info = weft_lobe_info(index);
        if (info->traits & WEFT_LOBE_REFERENCE) continue;
        if (!getenv("WEFT_TEST_LONG") && info->param_count > 4) continue;
        WeftLobe lobe = coloured(index), found = lobe_named(info->id);
        WeftReflection *from = of_lobe(&lobe);
        WeftMatch match;
        assert_int_equal(weft_match_lobe(from, WEFT_BRDF_METRIC_COSINE, 0, &found, &match, NULL), WEFT_OK);
        print_message("%-28s %.4f -> %.1e, %lld evaluations\n", info->id, match.copied, match.matched,
                      match.evaluations);
        if (!(match.matched < 1e-5)) fail_msg("%s: %g is left", info->id, match.matched);
        bool scales = strcmp(info->id, "fabric-lambert") == 0;
        for (int k = 0; k < info->param_count && !scales; k++)
            if (!found_again(&lobe, &found, k))
                fail_msg("%s: %s is %g, not %g", info->id, info->params[k].name, (double)found.params[k],
                         (double)lobe.params[k]);
        for (int c = 0; c < 3 && !scales; c++) assert_true(fabsf(found.f0[c] - lobe.f0[c]) <= 1e-3f);
        weft_reflection_free(from);
    }
}

static void held_parameter_is_unchanged(void **state) {
    (void)state;
    WeftLobe from = lobe_named("charlie-neubelt"), to = lobe_named("patry");
    to.params[1] = 2.5f;
    WeftReflection *reflection = of_lobe(&from);
    WeftMatch match;
    assert_int_equal(weft_match_lobe(reflection, WEFT_BRDF_METRIC_LOG, 2u | WEFT_HOLD_COLOR, &to, &match, NULL),
                     WEFT_OK);
    assert_true(fabsf(to.params[1] - 2.5f) < 1e-6f && fabsf(to.f0[0] - 1.0f) < 1e-6f);
    assert_true(match.matched < match.copied);
    WeftLobe walk = lobe_named("fibre-walk");
    WeftError error;
    assert_int_equal(weft_match_lobe(reflection, WEFT_BRDF_METRIC_COSINE, 0, &walk, &match, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_DESC);
    /* nor is an estimate something to be met */
    WeftReflection *noise = of_lobe(&walk);
    WeftMaterial any = cloth(0);
    assert_int_equal(weft_match_lobe(noise, WEFT_BRDF_METRIC_COSINE, 0, &to, &match, &error), WEFT_USAGE);
    assert_non_null(strstr(error.text, "match fibre"));
    assert_int_equal(weft_match_material(noise, WEFT_BRDF_METRIC_COSINE, NULL, &any, &match, &error), WEFT_USAGE);
    assert_non_null(strstr(error.text, "match fibre"));
    weft_reflection_free(noise);
    walk.lobe = -1;
    assert_int_equal(weft_match_lobe(reflection, WEFT_BRDF_METRIC_COSINE, 0, &walk, &match, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_LOBE_NAME);
    weft_reflection_free(reflection);
    int held[WEFT_INPUTS_MAX] = {0};
    WeftMaterial material = cloth(7), found = cloth(8);
    for (int k = 0; weft_material_input_name(k); k++)
        held[k] = strcmp(weft_material_input_name(k), "sheen_roughness") != 0;
    reflection = of_material(&material);
    assert_int_equal(weft_match_material(reflection, WEFT_BRDF_METRIC_COSINE, held, &found, &match, NULL), WEFT_OK);
    for (int k = 0; weft_material_input_name(k); k++)
        if (held[k])
            for (int c = 0; c < 3; c++)
                assert_true(fabsf(found.inputs[k].value[c] - material.inputs[k].value[c]) < 1e-6f);
    assert_true(match.matched < match.copied);
    weft_reflection_free(reflection);
}

/* All ordered pairs of profiles, or every 23rd. */
static void match_is_never_worse_than_the_copy(void **state) {
    (void)state;
    int count = 0, step = getenv("WEFT_TEST_LONG") ? 1 : 23, jobs = 0;
    while (weft_profile_name(count)) count++;
    WeftMatchJob *all = calloc((size_t)(count * count), sizeof *all);
    WeftReflection **from = calloc((size_t)count, sizeof *from);
    assert_non_null(all);
    assert_non_null(from);
    for (int k = 0; k < count; k++) {
        WeftMaterial material = cloth(k);
        from[k] = of_material(&material);
    }
    for (int k = 1; k < count * count; k += step)
        all[jobs++] = (WeftMatchJob){.from = from[k / count], .material = cloth(k % count)};
    WeftError error;
    if (weft_match_many(all, jobs, WEFT_BRDF_METRIC_COSINE, 0, NULL, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    for (int j = 0; j < jobs; j++) {
        int k = 1 + j * step;
        double again;
        WeftReflection *to = of_material(&all[j].material);
        assert_int_equal(weft_brdf_distance(to, all[j].from, WEFT_PART_ALL, WEFT_BRDF_METRIC_COSINE, &again, NULL),
                         WEFT_OK);
        print_message("%-14s %-14s %.4f -> %.4f\n", weft_profile_name(k / count), weft_profile_name(k % count),
                      all[j].found.copied, all[j].found.matched);
        assert_true(all[j].found.matched <= all[j].found.copied);
        assert_true(fabs(again - all[j].found.matched) < 1e-9); /* what is said of it is so */
        weft_reflection_free(to);
    }
    for (int k = 0; k < count; k++) weft_reflection_free(from[k]);
    free(from);
    free(all);
}

/* The same bytes on one thread and on many. */
static void match_with_any_number_of_threads_is_the_same(void **state) {
    (void)state;
    WeftLobe lobes[2] = {lobe_named("charlie-neubelt"), lobe_named("ashikhmin-neubelt")};
    WeftReflection *from = of_lobe(&lobes[0]);
    WeftMatchJob jobs[2][3];
    memset(jobs, 0, sizeof jobs);
    for (int run = 0; run < 2; run++) {
        for (int k = 0; k < 3; k++) {
            jobs[run][k].from = from;
            jobs[run][k].is_lobe = 1;
            jobs[run][k].lobe = lobes[1];
        }
        assert_int_equal(weft_match_many(jobs[run], 3, WEFT_BRDF_METRIC_COSINE, run ? 4 : 1, NULL, NULL, NULL),
                         WEFT_OK);
    }
    for (int k = 0; k < 3; k++) {
        assert_true(fabsf(jobs[0][k].lobe.params[0] - jobs[1][k].lobe.params[0]) <= 0.0f);
        assert_true(fabs(jobs[0][k].found.matched - jobs[1][k].found.matched) <= 0.0);
    }
    weft_reflection_free(from);
}

static int count_and_stop(void *calls, double fraction) {
    assert_true(fraction >= 0.0 && fraction <= 1.0);
    return ++*(int *)calls == 2;
}

/* In the midst of a search, not after it. */
static void stopped_batch_is_interrupted_within_a_search(void **state) {
    (void)state;
    WeftLobe lobe = coloured(weft_lobe_find("threads"));
    WeftReflection *from = of_lobe(&lobe);
    WeftMatchJob job = {.from = from, .is_lobe = 1, .lobe = lobe_named("threads")};
    int calls = 0;
    assert_int_equal(weft_match_many(&job, 1, WEFT_BRDF_METRIC_COSINE, 1, count_and_stop, &calls, NULL),
                     WEFT_INTERRUPTED);
    assert_int_equal(calls, 2);
    assert_int_equal(job.result, WEFT_INTERRUPTED);
    weft_reflection_free(from);
}

static void sphere_of_a_reflection_is_a_picture(void **state) {
    (void)state;
    WeftLobe lobe = lobe_named("lambert");
    WeftReflection *of = of_lobe(&lobe);
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_reflection_sphere(of, 32, &image, &error), WEFT_OK);
    const float *pixels = image.pixels, *middle = pixels + (size_t)4 * (16 * 32 + 16);
    assert_true(!(pixels[3] > 0.0f) && middle[3] > 0.999f);
    /* cos / pi of 2 from 45 degrees and of 0.6 from in front; the third light is behind */
    assert_true(fabsf(middle[0] - (2.0f * 0.7071f + 0.6f) / PI_FLOAT) < 0.04f);
    weft_image_free(&image);
    assert_int_equal(weft_reflection_sphere(of, 3, &image, &error), WEFT_USAGE);
    weft_reflection_free(of);
}

static void text_write(const char *path, const char *text) {
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    fputs(text, stream);
    fclose(stream);
}

/* A picture of two greys, alpha 1: the same in any number of channels. */
static void picture_write(const char *path, int channels) {
    WeftImage image;
    WeftError error;
    if (weft_image_create(4, 4, channels, WEFT_PIXEL_U8, &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    for (int k = 0; k < 16 * channels; k++) {
        bool alpha = channels % 2 == 0 && k % channels == channels - 1;
        ((uint8_t *)image.pixels)[k] = (uint8_t)(alpha ? 255 : k / channels % 2 ? 200 : 150);
    }
    if (weft_image_write(path, &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_image_free(&image);
}

/* A triangle whose roughness, sheen roughness (of alpha) and colour are that picture. */
static const char textured[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":0}]}],"
    "\"materials\":[{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"baseColorFactor\":[0.5,0.4,0.3,1],"
    "\"baseColorTexture\":{\"index\":0},\"metallicRoughnessTexture\":{\"index\":0}},"
    "\"extensions\":{\"KHR_materials_sheen\":{\"sheenColorFactor\":[1,0.9,0.8],\"sheenRoughnessFactor\":0.5,"
    "\"sheenRoughnessTexture\":{\"index\":0}}}}],\"extensionsUsed\":[\"KHR_materials_sheen\"],"
    "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"PICTURE\"}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
    "\"min\":[-1,-1,0],\"max\":[1,1,0]},{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":"
    "\"VEC2\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":"
    "\"data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA\"}]}";

static int profile_named(const char *id) {
    int k = 0;
    while (weft_profile_name(k) && strcmp(weft_profile_name(k), id) != 0) k++;
    return k;
}

/* A missing alpha is 1, and grey is red, green and blue: what a picture says does not hang on its channels.
 */
static void match_of_a_texture_does_not_depend_on_its_channels(void **state) {
    (void)state;
    WeftAssetMatch found[4];
    char folder[SCRATCH_SIZE], picture[64], asset[64], out[64], text[sizeof textured + 16];
    assert_true(scratch_make(folder));
    snprintf(picture, sizeof picture, "%s/p.png", folder);
    snprintf(asset, sizeof asset, "%s/a.gltf", folder);
    snprintf(out, sizeof out, "%s/b.gltf", folder);
    snprintf(text, sizeof text, "%s", textured);
    memcpy(strstr(text, "PICTURE"), "./p.png", 7);
    text_write(asset, text);
    for (int k = 0; k < 4; k++) {
        WeftError error;
        int count;
        picture_write(picture, k + 1);
        WeftAssetMatch *report;
        if (weft_match_asset(asset, out, profile_named("khronos"), profile_named("three"), WEFT_BRDF_METRIC_COSINE,
                             NULL, NULL, &report, &count, NULL, &error) != WEFT_OK)
            fail_msg("%s", error.text);
        assert_true(count == 1 && report->changed);
        found[k] = *report;
        weft_match_report_free(report);
        for (int n = 0; n < WEFT_INPUTS_MAX; n++)
            for (int c = 0; c < 3; c++)
                assert_true(fabsf(found[k].matched.inputs[n].value[c] - found[0].matched.inputs[n].value[c]) <= 1e-6f);
        assert_true(fabs(found[k].found.matched - found[0].found.matched) <= 1e-9);
    }
    assert_true(scratch_remove(folder));
}

/* An asset of a velvet, a wool and a wall, one letter each. */
static void cloths_write(const char *path, const char *letters) {
    char text[4096];
    int used = snprintf(text, sizeof text,
                        "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_materials_sheen\"],"
                        "\"materials\":[");
    for (const char *letter = letters; *letter; letter++) {
        used += snprintf(text + used, sizeof text - (size_t)used, "%s{\"name\":\"%c%d\"", letter > letters ? "," : "",
                         *letter, (int)(letter - letters));
        if (*letter != '-')
            used += snprintf(text + used, sizeof text - (size_t)used,
                             ",\"extensions\":{\"KHR_materials_sheen\":{\"sheenColorFactor\":[1,0.9,0.8],"
                             "\"sheenRoughnessFactor\":%s}}",
                             *letter == 'v' ? "0.3" : "0.7");
        used += snprintf(text + used, sizeof text - (size_t)used, "}");
    }
    snprintf(text + used, sizeof text - (size_t)used, "]}");
    text_write(path, text);
}

typedef struct Asked {
    int times, most; /* most: it stops at */
    double least, last;
} Asked;

static int note_asked(void *user, double fraction) {
    Asked *asked = user;
    asked->least = fmin(asked->least, fraction - asked->last);
    asked->last = fraction;
    return ++asked->times > asked->most;
}

static WeftResult cloths_match(const char *letters, Asked *asked, WeftAssetMatch **report) {
    WeftError error;
    int count;
    cloths_write("cloths.gltf", letters);
    WeftResult result =
        weft_match_asset("cloths.gltf", "cloths-out.gltf", profile_named("khronos"), profile_named("three"),
                         WEFT_BRDF_METRIC_COSINE, note_asked, asked, report, &count, NULL, &error);
    if (result == WEFT_OK) assert_int_equal(count, strlen(letters));
    unlink("cloths.gltf");
    return result;
}

/* Each has the match that it has alone. */
static void equal_materials_share_a_search(void **state) {
    (void)state;
    static const int searches[] = {1, 2, 1, 0, 2, 1, 1};
    WeftAssetMatch *together, *alone[2];
    Asked asked = {.most = 1 << 30};
    assert_int_equal(cloths_match("vwv-wvv", &asked, &together), WEFT_OK);
    assert_true(asked.times > 0 && asked.least >= 0.0 && asked.last <= 1.0);
    assert_int_equal(cloths_match("v", &asked, &alone[0]), WEFT_OK);
    assert_int_equal(cloths_match("w", &asked, &alone[1]), WEFT_OK);
    for (int k = 0; k < 7; k++) {
        assert_int_equal(together[k].search, searches[k]);
        assert_int_equal(together[k].changed, searches[k] != 0);
        if (!searches[k]) continue;
        const WeftAssetMatch *same = alone[searches[k] - 1];
        assert_memory_equal(&together[k].matched, &same->matched, sizeof same->matched);
        assert_memory_equal(&together[k].found, &same->found, sizeof same->found);
        assert_true(same->found.matched < same->found.copied);
    }
    weft_match_report_free(together);
    for (int k = 0; k < 2; k++) weft_match_report_free(alone[k]);
    unlink("cloths-out.gltf");
}

static void stopped_match_of_an_asset_writes_nothing(void **state) {
    (void)state;
    for (int most = 0; most < 12; most += 3) {
        WeftAssetMatch *report;
        Asked asked = {.most = most};
        assert_int_equal(cloths_match("vwv", &asked, &report), WEFT_INTERRUPTED);
        assert_null(report);
        assert_int_equal(access("cloths-out.gltf", F_OK), -1);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(equal_materials_share_a_search),
                                       cmocka_unit_test(stopped_match_of_an_asset_writes_nothing),
                                       cmocka_unit_test(metric_of_white_and_half_grey_is_half),
                                       cmocka_unit_test(sum_of_metric_cosine_is_the_integral),
                                       cmocka_unit_test(match_to_itself_changes_nothing),
                                       cmocka_unit_test(parameters_of_a_lobe_are_found_from_its_defaults),
                                       cmocka_unit_test(held_parameter_is_unchanged),
                                       cmocka_unit_test(match_is_never_worse_than_the_copy),
                                       cmocka_unit_test(match_with_any_number_of_threads_is_the_same),
                                       cmocka_unit_test(sphere_of_a_reflection_is_a_picture),
                                       cmocka_unit_test(match_of_a_texture_does_not_depend_on_its_channels),
                                       cmocka_unit_test(stopped_batch_is_interrupted_within_a_search)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
