/* Every woven preset keeps energy. From afar it reflects the same both ways round, and no more than it gets. Points at
 * random places of the cloth send back no more than falls on it, on the mean over them: a crown alone may, since it gets
 * more than its share. Directions that lobes yarn and woven draw carry light that varies little. */
#include "shading/cases.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/pi.h"
#include "base/random.h"
#include "shading/weave/weave_light.h"
#include "weft/weft.h"
#include "white_cloth.h"
#include "woven_cloths.h"

enum { PLACES = 400, DRAWN = 256, THREADS = 480, PIECE = 4800 };

static double any_unit(uint64_t *stream) { return (double)unit_float((uint32_t)(stream_next(stream) >> 32)); }

static Dir any_above(uint64_t *stream) {
    const double z = 0.02 + 0.98 * any_unit(stream);
    return direction_cos(z, 6.0 * any_unit(stream));
}

static void check_afar(const char *name, const WeftCloth *cloth) {
    uint64_t stream = stream_start(3, 29);
    double apart = 0.0, most = 0.0;
    for (int k = 0; k < 1000; k++) {
        const Dir o = any_above(&stream), i = any_above(&stream);
        apart = fmax(apart, fabs((double)white_of(cloth, o, i) - (double)white_of(cloth, i, o)));
    }
    for (int k = 0; k < 40; k++)
        most = fmax(most, white_albedo(cloth, direction_cos(0.05 + 0.95 * (k % 8) / 7.0, 0.4 * (k / 8))));
    print_message("%-24s symmetric to %.1e, E at most %.3f\n", name, apart, most);
    assert_true(apart < 1e-6);
    assert_true(most < 1.0);
}

static void presets_from_afar_are_symmetric_and_keep_energy(void **state) {
    (void)state;
    each_woven_cloth(check_afar);
}

/* Pairs of directions within 81 degrees of the normal, and what a cloth reflects between each on the mean over its points,
 * with all fibres, times the cosine; the long run looks at more of them. */
enum { PAIRS = 100 };
enum { OTHERS = 1000003 }; /* places that cloth_far.c does not look at begin there */
static int points_seen(void) { return test_long() ? 300000 : 24000; }
typedef struct Pairs {
    Dir o[PAIRS], i[PAIRS];
} Pairs;

static void points_reflect(const Weave *m, const Pairs *pairs, double lit[PAIRS][3]) {
    memset(lit, 0, PAIRS * sizeof *lit);
    const int count = points_seen();
    for (int n = 0; n < count; n++) {
        const float x = (float)(PIECE * fmod(0.7548776662466927 * (n + OTHERS), 1.0)),
                    y = (float)(PIECE * fmod(0.5698402909980532 * (n + OTHERS), 1.0));
        const WeavePoint p = weave_point(m, x, y, 0.0f, 0.0f);
        if (p.height <= WEAVE_NONE) continue;
        const Rgb once = weave_single_rgb(m, p), again = weave_multiple_rgb(m, p);
        YarnPrepared yarn;
        YarnView view;
        yarn_prepare(weave_yarn(m, p), &yarn);
        for (int k = 0; k < PAIRS; k++) {
            yarn_view(&yarn, pairs->o[k], &view);
            const LobeValue v = yarn_value(&yarn, &view, angles_between(pairs->o[k], pairs->i[k]));
            const double f = (double)(v.f * pairs->i[k].z) / count, s = (double)v.s;
            lit[k][0] += f * ((double)once.r * (1.0 - s) + (double)again.r * s);
            lit[k][1] += f * ((double)once.g * (1.0 - s) + (double)again.g * s);
            lit[k][2] += f * ((double)once.b * (1.0 - s) + (double)again.b * s);
        }
    }
}

/* What a reflection does between them. It is the same both ways round, and its parts are the whole. */
static void reflection_reflects(const WeftReflection *r, const Pairs *pairs, double lit[PAIRS][3]) {
    for (int k = 0; k < PAIRS; k++) {
        const float o[3] = {pairs->o[k].x, pairs->o[k].y, pairs->o[k].z},
                    i[1][3] = {{pairs->i[k].x, pairs->i[k].y, pairs->i[k].z}}, back[1][3] = {{o[0], o[1], o[2]}};
        float f[1][3], turned[1][3], base[1][3];
        weft_reflection_eval(r, WEFT_PART_ALL, o, 1, i, f);
        weft_reflection_eval(r, WEFT_PART_ALL, i[0], 1, back, turned);
        weft_reflection_eval(r, WEFT_PART_DIFFUSE, o, 1, i, base);
        for (int c = 0; c < 3; c++) {
            lit[k][c] = (double)(f[0][c] * i[0][2]);
            assert_true(fabsf(f[0][c] - turned[0][c]) < 1e-5f && fabsf(f[0][c] - base[0][c]) < 1e-6f);
        }
    }
}

/* Sums over pairs: of what points reflect and what is reflected from afar, and of how far these are apart; and how far they
 * are at worst, in parts of a pair's light, where f is a twentieth of the brightest pair's or more. */
typedef struct Compared {
    double points, far, apart, worst;
} Compared;

static Compared compare(const Pairs *pairs, double points[PAIRS][3], double far[PAIRS][3], int c) {
    Compared sum = {0.0, 0.0, 0.0, 0.0};
    double most = 0.0;
    for (int k = 0; k < PAIRS; k++) most = fmax(most, points[k][c] / (double)pairs->i[k].z);
    for (int k = 0; k < PAIRS; k++) {
        const double off = fabs(far[k][c] - points[k][c]);
        sum.points += points[k][c];
        sum.far += far[k][c];
        sum.apart += off;
        if (points[k][c] > 0.05 * most * (double)pairs->i[k].z) sum.worst = fmax(sum.worst, off / points[k][c]);
    }
    return sum;
}

static double farthest, most_apart, worst_apart;
static int well_met; /* presets that are near, pair by pair */

static void check_reflection(const char *name, const WeftCloth *cloth) {
    Pairs pairs;
    WeftMaterial bare;
    WeftReflection *reflection;
    WeftError error;
    uint64_t stream = stream_start(5, 29);
    for (int k = 0; k < PAIRS; k++) {
        double unit[4]; /* in this order with any compiler */
        for (int n = 0; n < 4; n++) unit[n] = any_unit(&stream);
        pairs.o[k] = direction_cos(0.15 + 0.85 * unit[0], 6.28 * unit[1]);
        pairs.i[k] = direction_cos(0.15 + 0.85 * unit[2], 6.28 * unit[3]);
    }
    weft_material_default(&bare);
    assert_int_equal(weft_reflection_create_woven(&bare, cloth, &reflection, &error), WEFT_OK);
    static double points[PAIRS][3], far[PAIRS][3];
    double apart = 0.0, one = 0.0;
    float e[3];
    Weave even = cloth->weave; /* the lobe is that of all lots of yarn, of which the points see few */
    even.warp.barre = even.warp.uneven = even.weft.barre = even.weft.uneven = 0.0f;
    points_reflect(&even, &pairs, points);
    reflection_reflects(reflection, &pairs, far);
    weft_reflection_albedo(reflection, WEFT_PART_ALL, 0.7f, e);
    print_message("%-24s", name);
    for (int c = 0; c < 3; c++) {
        const Compared sum = compare(&pairs, points, far, c);
        const double off = sum.far / sum.points - 1.0;
        print_message(" %+.3f", off);
        farthest = fmax(farthest, fabs(off));
        apart = fmax(apart, sum.apart / sum.points);
        one = fmax(one, sum.worst);
        assert_true(e[c] > 0.0f && e[c] < 1.0f);
    }
    most_apart = fmax(most_apart, apart);
    worst_apart = fmax(worst_apart, one);
    well_met += apart < (test_long() ? 0.0065 : 0.012); /* docs/weave.md */
    assert_true(apart < (test_long() ? 0.0125 : 0.025) && one < (test_long() ? 0.04 : 0.16));
    print_message("  each pair by %.4f, at worst %.3f  E %.3f %.3f %.3f\n", apart, one, (double)e[0], (double)e[1],
                  (double)e[2]);
    weft_reflection_free(reflection);
}

static void presets_are_reflections_that_reflect_as_their_points_do(void **state) {
    (void)state;
    each_woven_cloth(check_reflection);
    print_message("the farthest is off by %.3f, each pair by %.3f, one by %.3f\n", farthest, most_apart, worst_apart);
    assert_true(farthest < (test_long() ? 0.01 : 0.02));
    assert_true(WOVEN_PRESETS - well_met <= 1);
}

/* What a preset's cloth is made of, and what is seen of it, as handbooks have it. Setts are threads per centimetre. */
static const struct {
    const char *preset;
    float warps[2], picks[2], weft_seen[2]; /* least and most */
} constructions[] = {
    {"woven-denim", {24, 30}, {16, 20}, {0.10f, 0.18f}},  {"woven-charmeuse", {60, 130}, {40, 60}, {0, 0.12f}},
    {"woven-linen", {12, 20}, {11, 18}, {0.45f, 0.55f}},  {"woven-wool", {16, 26}, {14, 24}, {0.45f, 0.55f}},
    {"woven-poplin", {45, 60}, {24, 34}, {0.15f, 0.45f}}, {"woven-gabardine", {35, 60}, {20, 32}, {0.2f, 0.4f}},
    {"woven-corduroy", {20, 36}, {30, 80}, {0.6f, 1}},    {"woven-tartan", {16, 28}, {16, 28}, {0.45f, 0.55f}},
};

static const WeftCloth *cloth_named(const char *preset) {
    for (int k = 0; weft_preset_name(k); k++)
        if (strcmp(weft_preset_name(k), preset) == 0) return woven_cloth(k);
    fail_msg("no preset %s", preset);
    return NULL;
}

static void assert_between(const char *preset, const char *what, float value, const float range[2]) {
    if (value < range[0] || value > range[1])
        fail_msg("%s: %s %g is not from %g to %g", preset, what, (double)value, (double)range[0], (double)range[1]);
}

/* No cloth of these lets light through that is on a sofa. */
static void presets_are_constructed_as_real_cloth_is(void **state) {
    (void)state;
    for (size_t k = 0; k < sizeof constructions / sizeof *constructions; k++) {
        const char *preset = constructions[k].preset;
        const WeftClothInfo info = weft_cloth_info(cloth_named(preset));
        const float gaps = 1.0f - info.share[0] - info.share[1];
        print_message("%-18s %3.0f x %2.0f per cm, weft seen %.3f, gaps %.4f\n", preset, (double)info.sett[0],
                      (double)info.sett[1], (double)info.share[WEFT_WEFT], (double)gaps);
        assert_between(preset, "sett of the warp", info.sett[WEFT_WARP], constructions[k].warps);
        assert_between(preset, "sett of the weft", info.sett[WEFT_WEFT], constructions[k].picks);
        assert_between(preset, "weft seen", info.share[WEFT_WEFT], constructions[k].weft_seen);
        assert_true(gaps < 0.02f);
    }
}

/* Sets E of the denim preset from afar, with the colour of its weft changed or NULL. Returns the share of the warp. */
static double denim_from_afar(const char *weft_color, double e[3]) {
    WeftScene *scene;
    WeftError error;
    WeftMaterial bare;
    WeftReflection *reflection;
    float albedo[3];
    int number = 0;
    while (strcmp(weft_preset_name(number), "woven-denim") != 0) number++;
    const char *text = weft_preset_text(number);
    weft_material_default(&bare);
    assert_int_equal(weft_scene_load("builtin:cloth", &scene, NULL, &error), WEFT_OK);
    assert_int_equal(weft_scene_assign_material_memory(scene, NULL, text, strlen(text), "denim", NULL, &error),
                     WEFT_OK);
    if (weft_color) assert_int_equal(weft_scene_weave(scene, NULL, "weft.color", weft_color, NULL, &error), WEFT_OK);
    const WeftCloth *cloth = scene->cloths[scene->materials[0].cloth - 1];
    assert_int_equal(weft_reflection_create_woven(&bare, cloth, &reflection, &error), WEFT_OK);
    weft_reflection_albedo(reflection, WEFT_PART_ALL, 0.7f, albedo);
    for (int c = 0; c < 3; c++) e[c] = (double)albedo[c];
    const double share = (double)weft_cloth_info(cloth).share[WEFT_WARP];
    weft_reflection_free(reflection);
    weft_scene_free(scene);
    return share;
}

/* Two coordinates of a linear colour against grey: colours that are mixed add up. */
static void chroma_of(const double e[3], double out[2]) {
    out[0] = e[0] - e[1];
    out[1] = 0.5 * (e[0] + e[1]) - e[2];
}

/* The blue of denim from afar is that of its warp, as pale as the share of white weft between makes it: hue within a
 * tenth of the way to the next of six hues, chroma within a tenth. */
static void denim_from_afar_is_as_blue_as_its_warp(void **state) {
    (void)state;
    double all[3], mixed[3], warp[2], seen[2];
    denim_from_afar("#28385c", all);
    const double share = denim_from_afar(NULL, mixed);
    chroma_of(all, warp), chroma_of(mixed, seen);
    const double turned = fabs(atan2(seen[0], seen[1]) - atan2(warp[0], warp[1])) * 180.0 / PI_DOUBLE,
                 kept = hypot(seen[0], seen[1]) / hypot(warp[0], warp[1]);
    print_message("denim: warp seen %.3f, chroma %.3f of its warp's, hue %.1f degrees off; E %.3f %.3f %.3f\n", share,
                  kept, turned, mixed[0], mixed[1], mixed[2]);
    assert_true(turned < 6.0);
    assert_true(fabs(kept / share - 1.0) < 0.1);
}

/* f cos / pdf of fibres of albedo 0.9. */
static double carried(LobeValue v, float cosine) {
    const double again = (double)v.s;
    return (double)(v.f * cosine / v.pdf) * (0.9 * (1.0 - again) + (double)yarn_reflectance(0.9f) * again);
}

/* Sums of what drawn directions carry, f cos / pdf, and of its square, of fibres of albedo 0.9; white is the sum of
 * fibres of albedo 1. */
typedef struct Carried {
    double sum, square, white;
} Carried;

static Carried draw(const YarnPrepared *yarn, Dir o, Random *random) {
    Carried c = {0.0, 0.0, 0.0};
    YarnView view;
    yarn_view(yarn, o, &view);
    for (int k = 0; k < DRAWN; k++) {
        const Dir i = yarn_sample(yarn, &view, o, random_unit(random), random_unit(random));
        if (i.z <= 0.0f) continue;
        const LobeValue v = yarn_value(yarn, &view, angles_between(o, i));
        const double white = (double)(v.f * i.z / v.pdf), all = carried(v, i.z);
        c.sum += all / DRAWN, c.square += all * all / DRAWN, c.white += white / DRAWN;
    }
    return c;
}

/* The places of a cloth together, with the light that reaches them between threads. The variance is of what is carried,
 * about the mean of each place, in parts of the squared mean of all. */
typedef struct Found {
    double variance;
    double mean, most; /* E of white fibres, on the mean and where it is largest */
} Found;

static Found find(const Weave *m, float degrees, Random *random) {
    double variance = 0.0, sum = 0.0;
    Found found = {0.0, 0.0, 0.0};
    for (int k = 0; k < PLACES; k++) {
        const float x = THREADS * random_unit(random), y = THREADS * random_unit(random);
        const WeavePoint point = weave_point(m, x, y, 0.02f, 0.0f);
        if (point.height <= WEAVE_NONE) continue;
        const Dir o = direction_cos((cos)((double)degrees * RADIANS), 2.0 * PI_DOUBLE * (double)random_unit(random));
        YarnPrepared yarn;
        yarn_prepare(weave_yarn(m, point), &yarn);
        const Carried c = draw(&yarn, o, random);
        const double white = c.white * (double)weave_open(m, point);
        variance += (c.square - c.sum * c.sum) / PLACES;
        sum += c.sum / PLACES;
        found.mean += white / PLACES;
        found.most = fmax(found.most, white);
    }
    found.variance = variance / (sum * sum);
    return found;
}

static double mean[3], worst[3]; /* of the variance over presets, by angle */
static int checked;

static void check_points(const char *name, const WeftCloth *cloth) {
    static const float degrees[] = {10, 45, 75};
    static const double most[] = {0.15, 0.15, 0.15};
    Random random = {29};
    print_message("%-24s", name);
    for (int d = 0; d < 3; d++) {
        const Found f = find(&cloth->weave, degrees[d], &random);
        print_message("  %2.0f: variance %.2f, E %.2f, at most %.2f", (double)degrees[d], f.variance, f.mean, f.most);
        assert_true(f.variance < most[d]);
        assert_true(f.mean < 1.0);
        worst[d] = fmax(worst[d], f.variance), mean[d] += f.variance;
    }
    print_message("\n");
    checked++;
}

static void points_send_back_what_falls_on_the_cloth_with_little_variance(void **state) {
    (void)state;
    each_woven_cloth(check_points);
    for (int d = 0; d < 3; d++)
        print_message("variance on the mean %.2f, at worst %.2f\n", mean[d] / checked, worst[d]);
}

/* The variance of what directions carry that a system from afar draws, in parts of the squared mean, with fibres of albedo
 * 0.9: on the mean over azimuths. */
static double variance_afar(const WovenPrepared *p, float degrees, Random *random) {
    enum { AZIMUTHS = 12, EACH_DRAWN = 2000 };
    double variance = 0.0;
    for (int k = 0; k < AZIMUTHS; k++) {
        const Dir o = direction_cos((cos)((double)degrees * RADIANS), 2.0 * PI_DOUBLE * k / AZIMUTHS);
        double sum = 0.0, square = 0.0;
        WovenView w;
        woven_view(p, o, &w);
        for (int n = 0; n < EACH_DRAWN; n++) {
            const Dir i = woven_sample(p, &w, o, random_unit(random), random_unit(random));
            if (i.z <= 0.0f) continue;
            const LobeValue v = woven_value(p, &w, angles_between(o, i));
            const double all = carried(v, i.z);
            sum += all / EACH_DRAWN, square += all * all / EACH_DRAWN;
        }
        variance += (square / (sum * sum) - 1.0) / AZIMUTHS;
    }
    return variance;
}

static const float afar_degrees[] = {10, 45, 75, 85};
enum { AFAR = sizeof afar_degrees / sizeof *afar_degrees };
static double afar_mean[AFAR], afar_worst[AFAR];
static int afar_checked;

static void check_variance_afar(const char *name, const WeftCloth *cloth) {
    static const double most[AFAR] = {0.15, 0.18, 0.45, 0.7};
    Random random = {31};
    print_message("%-24s", name);
    for (int t = 0; t < 2; t++, afar_checked++) {
        for (int d = 0; d < AFAR; d++) {
            const double variance = variance_afar(&cloth->far.woven[t], afar_degrees[d], &random);
            print_message(" %.3f", variance);
            assert_true(variance < most[d]);
            afar_mean[d] += variance, afar_worst[d] = fmax(afar_worst[d], variance);
        }
    }
    print_message("\n");
}

static void systems_from_afar_are_drawn_with_little_variance(void **state) {
    (void)state;
    each_woven_cloth(check_variance_afar);
    for (int d = 0; d < AFAR; d++)
        print_message("variance from afar at %2.0f: on the mean %.2f, at worst %.2f\n", (double)afar_degrees[d],
                      afar_mean[d] / afar_checked, afar_worst[d]);
}

static double facet_spread(const ClothFacet *facets, int count) {
    double sum[2] = {0.0, 0.0}, squares = 0.0;
    for (int k = 0; k < count; k++) {
        const double x = (double)facets[k].slope_x, y = (double)facets[k].slope_y;
        sum[0] += x, sum[1] += y, squares += x * x + y * y;
    }
    return squares / count - (sum[0] * sum[0] + sum[1] * sum[1]) / count / count;
}

static double spread_worst;
static int spreads;

/* Checks that slopes vary little within each 64th of a system's facets; in no particular order they would vary there as much
 * as in all. */
static void check_facets(const char *name, const WeftCloth *cloth) {
    enum { PARTS = 64 };
    for (int t = 0; t < 2; t++) {
        const int count = cloth->facet_count[t];
        const double all = facet_spread(cloth->facets[t], count);
        double within = 0.0;
        if (count < 8 * PARTS || all < 1e-6) continue;
        for (int k = 0; k < PARTS; k++) {
            const int begin = count * k / PARTS, end = count * (k + 1) / PARTS;
            within += facet_spread(cloth->facets[t] + begin, end - begin) * (end - begin) / count;
        }
        print_message("%-24s %s: %4d facets, of their spread within 1/64 %.4f\n", name, t ? "weft" : "warp", count,
                      within / all);
        assert_true(isfinite(within / all));
        spreads++;
        spread_worst = fmax(spread_worst, within / all);
    }
}

static void facets_side_by_side_are_alike(void **state) {
    (void)state;
    each_woven_cloth(check_facets);
    assert_true(spreads > WOVEN_PRESETS); /* of two systems each, some are level or hidden */
    assert_true(spread_worst < 0.06);
}

/* Returns the bytes of all maps of a folder, and the sides of one, and removes them. */
static double maps_weigh(const char *folder, int sides[2]) {
    static const char *const names[] = {
        "base_color.png",      "normal.png",          "occlusion_roughness.png", "anisotropy.png",
        "height.png",          "back-base_color.png", "back-normal.png",         "back-occlusion_roughness.png",
        "back-anisotropy.png", "back-height.png"};
    double bytes = 0.0;
    char path[300];
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        struct stat file;
        WeftImage image;
        WeftError error;
        snprintf(path, sizeof path, "%s/%s", folder, names[k]);
        if (weft_image_read(path, &image, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        sides[0] = image.width, sides[1] = image.height;
        weft_image_free(&image);
        assert_int_equal(stat(path, &file), 0);
        bytes += (double)file.st_size;
        assert_int_equal(unlink(path), 0);
    }
    snprintf(path, sizeof path, "%s/material.json", folder);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(rmdir(folder), 0);
    return bytes;
}

/* Maps of any preset have as many texels, square ones, however long its repeat is. So in memory they weigh the
 * same. Asks each eighth preset, in a long run all, since the material of maps is searched for, which takes seconds. */
static void check_maps(const char *name, const WeftCloth *cloth) {
    enum { SIDE = 160, LEAST = 16 };
    static int count;
    const int each = getenv("WEFT_TEST_SHORT") ? 32 : getenv("WEFT_TEST_LONG") ? 1 : 8;
    if (count++ % each) return;
    char folder[64];
    int sides[2];
    WeftError error;
    snprintf(folder, sizeof folder, "/tmp/weft-maps-%ld", (long)getpid());
    if (weft_cloth_bake(cloth, SIDE, 0.5, folder, &error) != WEFT_OK) fail_msg("%s", error.text);
    const double bytes = maps_weigh(folder, sides), texels = (double)sides[0] * sides[1];
    const WeftClothInfo info = weft_cloth_info(cloth);
    const int warps = cloth->weave.warps, picks = cloth->weave.picks;
    const double wide = (double)info.size[0] * ((LEAST + warps - 1) / warps),
                 tall = (double)info.size[1] * ((LEAST + picks - 1) / picks);
    print_message("%-24s %d x %d, %.2f bytes a texel\n", name, sides[0], sides[1], bytes / texels);
    assert_true(fabs(texels / (SIDE * SIDE) - 1.0) < 0.01);
    assert_true(fabs(wide / sides[0] / (tall / sides[1]) - 1.0) < 0.01);
}

static void maps_of_presets_have_one_weight(void **state) {
    (void)state;
    each_woven_cloth(check_maps);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(presets_are_constructed_as_real_cloth_is),
        cmocka_unit_test(denim_from_afar_is_as_blue_as_its_warp),
        cmocka_unit_test(presets_are_reflections_that_reflect_as_their_points_do),
        cmocka_unit_test(presets_from_afar_are_symmetric_and_keep_energy),
        cmocka_unit_test(points_send_back_what_falls_on_the_cloth_with_little_variance),
        cmocka_unit_test(systems_from_afar_are_drawn_with_little_variance),
        cmocka_unit_test(facets_side_by_side_are_alike),
        cmocka_unit_test(maps_of_presets_have_one_weight),
    };
    return cmocka_run_group_tests(tests, NULL, woven_cloths_free);
}
