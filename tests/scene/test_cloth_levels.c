/* A cloth at every distance: the mean over pixels of what is looked up near, far and between is that of many points of
 * threads as far apart, to 0.5 % up to two threads a pixel and to 1 % beyond, where chance is as much; the long run looks at
 * more pixels, and finds 0.5 %. Pixels vary as those of many points do up to there, and hardly at all beyond. A pixel is a
 * square of so many threads.
 *
 * Labels: unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/pi.h"
#include "base/random.h"
#include "scene/record/scene.h"
#include "weave/cloth_base.h"
#include "weft/weft.h"

enum { SAMPLES = 144, FINE = 576, PAIRS = 7 };

typedef struct Direction {
    double theta, phi; /* degrees */
} Direction;

static int pixels(void) { return getenv("WEFT_TEST_LONG") ? 2048 : 256; }

/* From above, and at grazing; a highlight and beside it. */
static const Direction views[PAIRS] = {{0, 0}, {0, 0}, {45, 20}, {45, 20}, {45, 20}, {70, 100}, {70, 100}},
                       suns[PAIRS] = {{30, 40}, {60, 200}, {45, 200}, {20, 90}, {65, 300}, {70, 280}, {30, 10}};

static Dir direction_of(Direction d) {
    const double t = d.theta * PI_DOUBLE / 180.0, p = d.phi * PI_DOUBLE / 180.0;
    return (Dir){(float)((sin)(t) * (cos)(p)), (float)((sin)(t) * (sin)(p)), (float)(cos)(t)};
}

/* A look at one place, with the fields of ClothLooks; the product looks at many at once. */
typedef struct ClothLook {
    float uv[2];
    WeaveFootprint footprint;
    float level, facet, wear;
} ClothLook;

/* Puts into the place of the stack's base what is there. */
static void cloth_base(const WeftCloth *cloth, const ClothLook *look, Stack *stack) {
    static ClothLooks looks;
    static YarnRows yarn;
    looks.uv[0][0] = look->uv[0], looks.uv[1][0] = look->uv[1];
    looks.footprint_x[0] = look->footprint.x;
    looks.footprint_y[0] = look->footprint.y;
    looks.longest[0] = look->footprint.longest;
    looks.level[0] = look->level, looks.facet[0] = look->facet, looks.wear[0] = look->wear;
    cloth_bases(cloth, &looks, 1, &yarn, NULL);
    const Lobe lobe = yarn_of_row(&yarn, 0);
    stack_put_base(stack, &lobe, ROW_RGB(yarn.single, 0), ROW_RGB(yarn.multiple, 0));
}

/* The weave of a preset. */
typedef struct Case {
    const char *name, *draft, *warp, *weft;
} Case;
static const Case cases[] = {
    {"denim", "twill 3/1 z; warp 1#26375c; weft 1#d8d4c8; sett 26 18", "cotton", "cotton"},
    {"gabardine", "twill 2/1 z; both 1#4a4438; sett 40 22", "wool", "wool"},
    {"linen", "plain; both 1#c9bfa4; sett 14 13", "linen", "linen"},
    {"houndstooth", "houndstooth; sett 20", "wool", "wool"},
};
static const float footprints[] = {0.1f, 0.25f, 0.5f, 1.0f, 1.5f, 2.0f, 4.0f, 16.0f, 100.0f};

static WeftCloth *cloth_of(const Case *c) {
    WeftDraft *draft;
    WeftYarn yarns[2];
    WeftCloth *cloth;
    WeftError error;
    assert_int_equal(weft_draft_parse(c->draft, &draft, &error), WEFT_OK);
    assert_int_equal(weft_yarn_find(c->warp, &yarns[0], &error), WEFT_OK);
    assert_int_equal(weft_yarn_find(c->weft, &yarns[1], &error), WEFT_OK);
    assert_int_equal(weft_cloth_create(draft, yarns, 0, &cloth, &error), WEFT_OK);
    weft_draft_free(draft);
    return cloth;
}

static float random_unit(uint64_t *random) { return unit_float((uint32_t)(stream_next(random) >> 32)); }

/* Place k of evenly spread ones, in threads. */
static float place_x(int k) { return (float)(480.0 * fmod(0.7548776662466927 * k, 1.0)); }
static float place_y(int k) { return (float)(480.0 * fmod(0.5698402909980532 * k, 1.0)); }

/* It tells how far one light by pair and channel is from another, in parts of that: on the mean and at worst. */
typedef struct Apart {
    double mean, worst;
} Apart;
static Apart apart_of(double seen[PAIRS][2], double fine[PAIRS][2]) {
    Apart apart = {0.0, 0.0};
    for (int k = 0; k < PAIRS; k++)
        for (int c = 0; c < 2; c++) {
            const double e = fabs(seen[k][c] / fine[k][c] - 1.0);
            apart.mean += e / (2 * PAIRS);
            apart.worst = fmax(apart.worst, e);
        }
    return apart;
}

/* Adds what is seen of a place by all pairs, red and blue. */
static void add_look(const WeftCloth *cloth, const ClothLook *look, double weight, double sum[PAIRS][2]) {
    static Stack stack;
    cloth_base(cloth, look, &stack);
    const Slot *base = &stack.diffuse;
    for (int k = 0; k < PAIRS; k++) {
        const LobeValue v = lobe_value(&base->lobe, angles_between(direction_of(views[k]), direction_of(suns[k])));
        const double f = (double)v.f * weight, s = (double)v.s;
        sum[k][0] += f * ((double)base->f0.r * (1.0 - s) + (double)base->f90.r * s);
        sum[k][1] += f * ((double)base->f0.b * (1.0 - s) + (double)base->f90.b * s);
    }
}

/* A pixel with its lower left corner at x, y threads, of so many samples; near: of points of threads at any distance. */
static void see_pixel(const WeftCloth *cloth, float x, float y, float side, int samples, bool near, uint64_t *random,
                      double sum[PAIRS][2]) {
    for (int k = 0; k < PAIRS; k++) sum[k][0] = sum[k][1] = 0.0;
    for (int n = 0; n < samples; n++) {
        const int rows = samples == FINE ? 24 : samples == SAMPLES ? 12 : 1, columns = samples / rows;
        const int column = n % columns, row = n / columns;
        const float u = x + side * ((float)column + random_unit(random)) / (float)columns,
                    v = y + side * ((float)row + random_unit(random)) / (float)rows;
        const ClothLook look = {.uv = {u / cloth->per_uv[WEFT_WARP], -v / cloth->per_uv[WEFT_WEFT]},
                                .footprint = {side, side, side},
                                .level = near ? 1.0f : random_unit(random),
                                .facet = random_unit(random)};
        add_look(cloth, &look, 1.0 / samples, sum);
    }
}

/* Sums over pixels. */
typedef struct Moments {
    double mean[PAIRS][2], square[PAIRS][2];
} Moments;

static void add_pixel(Moments *m, double pixel[PAIRS][2]) {
    const double part = 1.0 / pixels();
    for (int k = 0; k < PAIRS; k++)
        for (int c = 0; c < 2; c++) {
            m->mean[k][c] += pixel[k][c] * part;
            m->square[k][c] += pixel[k][c] * pixel[k][c] * part;
        }
}
static double variance(const Moments *m, int k, int c) { return m->square[k][c] - m->mean[k][c] * m->mean[k][c]; }

/* Sums of variances over pairs, in units of the squared mean. */
static double spread(const Moments *m) {
    double sum = 0.0;
    for (int k = 0; k < PAIRS; k++)
        for (int c = 0; c < 2; c++) sum += variance(m, k, c) / (m->mean[k][c] * m->mean[k][c]) / (2 * PAIRS);
    return sum;
}

static void a_cloth_is_as_bright_at_every_distance(void **state) {
    (void)state;
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        WeftCloth *cloth = cloth_of(&cases[n]);
        for (size_t at = 0; at < sizeof footprints / sizeof *footprints; at++) {
            const float side = footprints[at];
            uint64_t random = stream_start(n, 29);
            Moments fine = {0}, seen = {0}, unfiltered = {0};
            for (int p = 0; p < pixels(); p++) {
                double pixel[PAIRS][2];
                const float x = place_x(p), y = place_y(p);
                see_pixel(cloth, x, y, side, FINE, true, &random, pixel), add_pixel(&fine, pixel);
                see_pixel(cloth, x, y, side, SAMPLES, false, &random, pixel), add_pixel(&seen, pixel);
                see_pixel(cloth, x, y, side, 1, true, &random, pixel), add_pixel(&unfiltered, pixel);
            }
            const Apart apart = apart_of(seen.mean, fine.mean);
            const double kept = spread(&seen) / spread(&fine), left = spread(&seen) / spread(&unfiltered);
            print_message("%-12s %6.2f threads: mean %.4f worst %.4f, variance %.3f of the reference's, %.4f of the "
                          "unfiltered\n",
                          cases[n].name, (double)side, apart.mean, apart.worst, kept, left);
            const bool near = side <= 2.0f;
            assert_true(apart.mean <= (near || pixels() > 256 ? 0.005 : 0.01));
            assert_true(apart.worst <= 0.02);
            if (near)
                assert_true(kept > 0.75 && kept < 1.25);
            else
                assert_true(left < 0.1);
        }
        weft_cloth_free(cloth);
    }
}

/* What n places look like from a distance of so many threads a pixel: the mean by pair, red and blue, and the deviation
 * of the first pair's red, in parts of its mean. near: by points of threads. */
static double see_worn(const WeftCloth *cloth, float wear, float side, bool near, int n, double mean[PAIRS][2]) {
    uint64_t random = stream_start((uint64_t)n, 37);
    double square = 0.0;
    for (int k = 0; k < PAIRS; k++) mean[k][0] = mean[k][1] = 0.0;
    for (int k = 0; k < n; k++) {
        double seen[PAIRS][2] = {{0.0}};
        const ClothLook look = {.uv = {place_x(k) / cloth->per_uv[WEFT_WARP], place_y(k) / cloth->per_uv[WEFT_WEFT]},
                                .footprint = {side, side, side},
                                .level = near ? 1.0f : random_unit(&random),
                                .facet = (float)fmod(0.6180339887498949 * (k + 1), 1.0),
                                .wear = wear};
        add_look(cloth, &look, 1.0, seen);
        for (int pair = 0; pair < PAIRS; pair++)
            for (int c = 0; c < 2; c++) mean[pair][c] += seen[pair][c] / n;
        square += seen[0][0] * seen[0][0] / n;
    }
    return (sqrt)(fmax(square - mean[0][0] * mean[0][0], 0.0)) / mean[0][0];
}

static double see_many(const WeftCloth *cloth, float side, bool near, int n, double mean[PAIRS][2]) {
    return see_worn(cloth, 0.0f, side, near, n, mean);
}

/* Wear takes the dye off what lies high, the warp of denim: its white core is seen from afar as it is near by, on the mean within 2 %.
 * In deep places the dye stays, so that even full wear leaves the cloth darker than undyed yarn. */
static void worn_denim_is_as_pale_from_afar(void **state) {
    (void)state;
    WeftCloth *cloth = cloth_of(&cases[0]);
    double new[PAIRS][2], near[PAIRS][2], far[PAIRS][2];
    see_many(cloth, 16.0f, false, 40000, new);
    for (float wear = 0.5f; wear <= 1.0f; wear += 0.5f) {
        see_worn(cloth, wear, 16.0f, true, 40000, near);
        see_worn(cloth, wear, 16.0f, false, 40000, far);
        const Apart apart = apart_of(far, near), paler = apart_of(far, new);
        print_message("wear %.1f: mean %.4f worst %.4f off from afar; %.2f paler than new\n", (double)wear, apart.mean,
                      apart.worst, paler.mean);
        assert_true(apart.mean < 0.025 && apart.worst < 0.09);
        assert_true(paler.mean > 0.1);
        for (int k = 0; k < PAIRS; k++) assert_true(far[k][0] > new[k][0]);
    }
    weft_cloth_free(cloth);
}

/* Steep silk has its highlights from few facets: the four thousand that are kept have as many of these as all points. */
static void far_facets_of_steep_silk_are_as_bright_as_its_points(void **state) {
    (void)state;
    WeftDraft *draft;
    WeftYarn yarns[2];
    WeftCloth *cloth;
    WeftError error;
    assert_int_equal(weft_draft_parse("satin 5/2; both 1#b8987e; sett 90 45", &draft, &error), WEFT_OK);
    for (int t = 0; t < 2; t++) {
        assert_int_equal(weft_yarn_find("silk", &yarns[t], &error), WEFT_OK);
        yarns[t].crimp = (float)((t ? 60.0 : 40.0) * PI_DOUBLE / 180.0);
    }
    assert_int_equal(weft_cloth_create(draft, yarns, 0, &cloth, &error), WEFT_OK);
    double near[PAIRS][2], far[PAIRS][2];
    see_many(cloth, 32.0f, true, 100000, near);
    see_many(cloth, 32.0f, false, 100000, far);
    const Apart apart = apart_of(far, near);
    print_message("steep silk: mean %.4f worst %.4f\n", apart.mean, apart.worst);
    assert_true(apart.mean < 0.004 && apart.worst < 0.01);
    weft_cloth_free(cloth);
    weft_draft_free(draft);
}

/* On a plane that is seen at a slant, a pixel covers a few percent more from row to row: the noise of its samples may not
 * jump between them, as it did where the colours go from crossings to the mean of four. */
static void noise_fades_with_distance(void **state) {
    (void)state;
    WeftCloth *cloth = cloth_of(&cases[0]); /* denim: blue and white */
    double before = 0.0, most = 1.0, mean[PAIRS][2];
    for (float side = 5.0f; side < 50.0f; side *= 1.05f) {
        const double noise = see_many(cloth, side, false, 20000, mean);
        if (before > 0.0) most = fmax(most, fmax(noise / before, before / noise));
        before = noise;
    }
    print_message("noise of a sample changes by a factor of at most %.3f\n", most);
    assert_true(most < 1.15);
    weft_cloth_free(cloth);
}

/* Points far apart leave loose fibres out and draw places across the others: at the same places, light stays nearly as it
 * is. */
static void fibres_that_are_left_out_take_little_light(void **state) {
    (void)state;
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        WeftCloth *cloth = cloth_of(&cases[n]);
        uint64_t random = stream_start(n, 31);
        double fine[PAIRS][2] = {{0.0}}, coarse[PAIRS][2] = {{0.0}};
        for (int p = 0; p < 40000; p++) {
            ClothLook look = {.uv = {place_x(p) / cloth->per_uv[WEFT_WARP], place_y(p) / cloth->per_uv[WEFT_WEFT]},
                              .level = 1.0f,
                              .facet = random_unit(&random)};
            add_look(cloth, &look, 1.0, fine);
            look.footprint = (WeaveFootprint){0.4f, 0.4f, 0.4f};
            add_look(cloth, &look, 1.0, coarse);
        }
        const Apart apart = apart_of(coarse, fine);
        print_message("%-12s without loose fibres: mean %.4f worst %.4f\n", cases[n].name, apart.mean, apart.worst);
        assert_true(apart.mean < 0.01 && apart.worst < 0.02);
        weft_cloth_free(cloth);
    }
}

/* Many looks at once are as one after the other, near by the points of threads with their loose fibres. */
static void looks_are_the_same_alone_and_among_others(void **state) {
    (void)state;
    static ClothLooks looks;
    static YarnRows rows;
    WeftCloth *cloth = cloth_of(&cases[0]);
    uint64_t random = stream_start(7, 29);
    int loose = 0;
    for (int round = 0; round < 40; round++) {
        for (int k = 0; k < ROW_MOST; k++) {
            looks.uv[0][k] = random_unit(&random), looks.uv[1][k] = random_unit(&random);
            looks.footprint_x[k] = looks.footprint_y[k] = looks.longest[k] =
                (k % 2 ? 6.0f : 0.25f) * random_unit(&random);
            looks.level[k] = random_unit(&random), looks.facet[k] = random_unit(&random);
        }
        cloth_bases(cloth, &looks, ROW_MOST, &rows, NULL);
        for (int k = 0; k < ROW_MOST; k++) {
            static Stack stack;
            const float side = looks.longest[k];
            const ClothLook look = {.uv = {looks.uv[0][k], looks.uv[1][k]},
                                    .footprint = {side, side, side},
                                    .level = looks.level[k],
                                    .facet = looks.facet[k]};
            cloth_base(cloth, &look, &stack);
            assert_float_equal(stack.diffuse.lobe.params[YARN_SLOPE_X], rows.params[YARN_SLOPE_X][k], 1e-3f);
            assert_float_equal(stack.diffuse.f0.r, rows.single[0][k], 1e-3f);
            assert_float_equal(stack.diffuse.f90.b, rows.multiple[2][k], 1e-3f);
            if (k % 2) continue;
            const float x = looks.uv[0][k] * cloth->per_uv[WEFT_WARP], y = -looks.uv[1][k] * cloth->per_uv[WEFT_WEFT];
            const WeavePoint p = weave_point(&cloth->weave, x, y, 0.25f * side, 2.0f * looks.facet[k] - 1.0f);
            assert_float_equal(p.slope_x, rows.params[YARN_SLOPE_X][k], 1e-2f);
            loose += p.height > weave_top(&cloth->weave, x, y).height;
        }
    }
    assert_true(loose > 50);
    weft_cloth_free(cloth);
}

static float dye_over(const WeftCloth *cloth, bool weft, float side) {
    return weave_far_dye(&cloth->weave, weft, 7.0f, 7.0f, (WeaveFootprint){side, side, side});
}

/* A place that is too far out to count its threads, or is none, is the first thread, whatever is seen of it; a pixel
 * without bounds has the mean dye. */
static void places_without_a_number_are_the_first(void **state) {
    (void)state;
    static const float none[] = {1e30f, -1e30f, INFINITY, -INFINITY, NAN};
    enum { NONE = sizeof none / sizeof *none };
    static Stack at, first;
    WeftCloth *cloth = cloth_of(&cases[0]);
    for (int k = 0; k < NONE * NONE; k++) {
        const float uv[2] = {none[k % NONE], none[k / NONE]};
        assert_true(cloth_is_gap(cloth, uv) == cloth_is_gap(cloth, (const float[2]){0.0f, 0.0f}));
        for (int wide = 0; wide <= NONE; wide++) {
            const float side = wide < NONE ? fabsf(none[wide]) : 0.1f;
            ClothLook look = {.footprint = {side, side, side}, .level = 0.5f, .facet = 0.3f};
            cloth_base(cloth, &look, &first);
            look.uv[0] = uv[0], look.uv[1] = uv[1];
            cloth_base(cloth, &look, &at);
            assert_float_equal(at.diffuse.f0.r, first.diffuse.f0.r, 1e-6f);
            assert_true(isfinite(at.diffuse.f0.r) && isfinite(at.diffuse.lobe.params[YARN_SLOPE_X]));
        }
    }
    for (int weft = 0; weft < 2; weft++) {
        assert_true(dye_over(cloth, weft == 1, 1e30f) == 1.0f);
        assert_true(dye_over(cloth, weft == 1, INFINITY) == 1.0f);
        assert_true(dye_over(cloth, weft == 1, NAN) == dye_over(cloth, weft == 1, 1.0f));
    }
    weft_cloth_free(cloth);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(places_without_a_number_are_the_first),
                                       cmocka_unit_test(looks_are_the_same_alone_and_among_others),
                                       cmocka_unit_test(fibres_that_are_left_out_take_little_light),
                                       cmocka_unit_test(far_facets_of_steep_silk_are_as_bright_as_its_points),
                                       cmocka_unit_test(worn_denim_is_as_pale_from_afar),
                                       cmocka_unit_test(noise_fades_with_distance),
                                       cmocka_unit_test(a_cloth_is_as_bright_at_every_distance)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
