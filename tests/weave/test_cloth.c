/* Cloth woven of yarns: what lies on top, what is seen of either system, what varies, and maps that tile. */
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmocka.h>

#include "scratch.h"
#include "shading/weave/weave_base.h"
#include "shading/weave/weave_light.h"
#include "weave/weft_cloth.h"
#include "weft/weft.h"

static WeftYarn named_yarn(const char *name) {
    WeftYarn yarn;
    WeftError error;
    if (weft_yarn_find(name, &yarn, &error) != WEFT_OK) fail_msg("%s", error.text);
    return yarn;
}

/* Returns the yarn of a name without anything that varies. */
static WeftYarn even_yarn(const char *name) {
    WeftYarn yarn = named_yarn(name);
    yarn.streaks = yarn.dye = yarn.slub = yarn.wander = yarn.hairiness = yarn.barre = yarn.uneven = 0.0f;
    return yarn;
}

static WeftCloth *woven(const char *notation, WeftYarn yarn, unsigned seed) {
    WeftDraft *draft;
    WeftCloth *cloth;
    WeftError error;
    if (weft_draft_parse(notation, &draft, &error) != WEFT_OK) fail_msg("%s", error.text);
    if (weft_cloth_create(draft, (WeftYarn[2]){yarn, yarn}, seed, &cloth, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    weft_draft_free(draft);
    return cloth;
}

static const char *const drafts[] = {"plain",    "twill 2/2 z",       "twill 3/1 s",   "satin 8/3",
                                     "basket 2", "herringbone 2/2 8", "twill 2/1/1/1", "sateen 5/2; sett 40 20"};

/* In the middle of a crossing lies the thread that the draft says, in every repeat. */
static void the_draft_says_what_lies_on_top(void **state) {
    (void)state;
    for (size_t d = 0; d < sizeof drafts / sizeof *drafts; d++) {
        WeftDraft *draft;
        WeftError error;
        WeftCloth *cloth = woven(drafts[d], named_yarn("cotton"), 3);
        assert_int_equal(weft_draft_parse(drafts[d], &draft, &error), WEFT_OK);
        for (int pick = -20; pick < 40; pick++)
            for (int warp = -20; warp < 40; warp++) {
                const WeavePoint p = weave_top(&cloth->weave, (float)warp + 0.5f, (float)pick + 0.5f);
                if (p.weft == (bool)weft_draft_warp_up(draft, warp, pick))
                    fail_msg("%s: warp %d, pick %d", drafts[d], warp, pick);
            }
        weft_draft_free(draft);
        weft_cloth_free(cloth);
    }
}

/* A warp satin shows hardly any weft, less than its draft has; a plain weave shows half. */
static void shares_are_of_what_is_seen(void **state) {
    (void)state;
    WeftCloth *satin = woven("satin 8/3", even_yarn("silk"), 0), *plain = woven("plain", even_yarn("cotton"), 0);
    const WeftClothInfo s = weft_cloth_info(satin), p = weft_cloth_info(plain);
    assert_true(s.share[WEFT_WARP] > 0.875f && s.share[WEFT_WARP] < 0.99f);
    assert_float_equal(p.share[WEFT_WARP], p.share[WEFT_WEFT], 0.02f);
    assert_true(p.share[WEFT_WARP] + p.share[WEFT_WEFT] <= 1.0f);
    weft_cloth_free(satin);
    weft_cloth_free(plain);
}

static bool same_point(WeavePoint a, WeavePoint b) {
    return a.weft == b.weft && fabsf(a.height - b.height) < 1e-4f && fabsf(a.slope_x - b.slope_x) < 1e-3f &&
           fabsf(a.slope_y - b.slope_y) < 1e-3f && fabsf(a.fibre.x - b.fibre.x) < 1e-3f && fabsf(a.dye - b.dye) < 1e-3f;
}

/* Counts places at which the cloth is another one so many threads on. */
static int changes(const Weave *m, float x, float y) {
    int count = 0;
    for (int k = 0; k < 400; k++) {
        const float u = 7.77f + 0.31f * (float)(k % 20), v = 3.33f + 0.37f * (float)(k / 20);
        count += !same_point(weave_point(m, u, v, 0.0f, 0.0f), weave_point(m, u + x, v + y, 0.0f, 0.0f));
    }
    return count;
}

static void variation_does_not_tile_unless_it_is_to(void **state) {
    (void)state;
    WeftCloth *even = woven("twill 2/2", even_yarn("wool"), 0), *real = woven("twill 2/2", named_yarn("wool"), 0);
    assert_int_equal(changes(&even->weave, 4.0f, 8.0f), 0);
    assert_true(changes(&real->weave, 4.0f, 0.0f) > 300);
    assert_true(changes(&real->weave, 0.0f, 4.0f) > 300);
    assert_true(changes(&real->weave, 289.0f * 4.0f, 0.0f) > 300);
    Weave tile = real->weave;
    tile.cycle_x = 20.0f;
    tile.cycle_y = 16.0f;
    assert_true(changes(&tile, 4.0f, 0.0f) > 300);
    assert_true(changes(&tile, 20.0f, 0.0f) < 4); /* rounding, at the very edge of a thread */
    assert_true(changes(&tile, 0.0f, 16.0f) < 4);
    assert_true(changes(&tile, -40.0f, 32.0f) < 4);
    weft_cloth_free(even);
    weft_cloth_free(real);
}

enum { THREADS = 8192 };

/* Returns the largest correlation of numbers of mean 0 with themselves, 1 to half of all numbers further on. */
static double most_alike(const float x[THREADS]) {
    double most = 0.0, square = 0.0;
    for (int k = 0; k < THREADS; k++) square += (double)(x[k] * x[k]) / THREADS;
    for (int lag = 1; lag <= THREADS / 2; lag++) {
        double sum = 0.0;
        for (int k = 0; k < THREADS - lag; k++) sum += (double)(x[k] * x[k + lag]);
        most = fmax(most, fabs(sum) / (THREADS - lag) / square);
    }
    return most;
}

/* Returns how far the dye of a thread is off, where it lies on top of its crossing with one of two threads, and fibres show no
 * streaks: in parts of the yarn's own dye. */
static float dye_of(const Weave *m, bool weft, float thread) {
    for (int cross = 0; cross < 2; cross++) {
        const float u = thread + 0.5f, v = (float)cross + 0.5f;
        const WeavePoint p = weave_point_bound(m, weft ? v : u, weft ? u : v, 0.0f, 0.0f);
        if (p.weft == weft && p.thread == thread) return (1.0f - p.dye) / (weft ? m->weft.dye : m->warp.dye);
    }
    fail_msg("thread %g is on top of neither of two", (double)thread);
    return 0.0f;
}

/* Neither threads nor loose fibres vary with a period: of chance alone a correlation of 4096 numbers is
 * beyond 0.094, six deviations, once in a hundred thousand cloths. Dye is even on the mean, and varies as what is uniform
 * up to 0.7 of the yarn's does, with up to 0.3 more along each thread. */
static void variation_has_no_period(void **state) {
    (void)state;
    static float dye[THREADS], turn[THREADS];
    WeftYarn yarn = named_yarn("wool");
    yarn.streaks = yarn.slub = yarn.wander = yarn.barre = yarn.uneven = 0.0f;
    WeftCloth *cloth = woven("plain", yarn, 7);
    for (int weft = 0; weft < 2; weft++) {
        double sum = 0.0, square = 0.0;
        for (int k = 0; k < THREADS; k++) {
            const float along = 2.0f * (float)k + 2.0f, x = weft ? 2.0f : along, y = weft ? along : 2.0f;
            dye[k] = dye_of(&cloth->weave, weft == 1, (float)(k - THREADS / 2));
            turn[k] = weave_hair(&cloth->weave, 0, x, y, WEAVE_HAIR_RADIUS).s;
            sum += (double)dye[k] / THREADS, square += (double)(dye[k] * dye[k]) / THREADS;
        }
        const double threads = most_alike(dye), fibres = most_alike(turn);
        print_message("%s: correlated by at most %.3f, loose fibres %.3f; dye %.3f, deviation %.3f\n",
                      weft ? "weft" : "warp", threads, fibres, sum, (sqrt)(square - sum * sum));
        assert_true(threads < 0.094 && fibres < 0.094);
        assert_true(fabs(sum) < 0.02);
        assert_true(square > 0.49 / 3.0 && square < (0.49 + 0.09) / 3.0);
    }
    weft_cloth_free(cloth);
}

/* Squares of 4 mm, a pixel of a sofa that is seen whole, 8 by 8 threads at 20 a centimetre, side by side over 2.4 m. */
enum { SQUARES = 600, SQUARE = 8 };

/* Returns the mean amount of dye of a system's points in a square about x, y. */
static double dye_seen(const Weave *m, bool weft, float x, float y) {
    enum { POINTS = 24 };
    double sum = 0.0;
    int count = 0;
    for (int k = 0; k < POINTS * POINTS; k++) {
        const float right = ((float)(k % POINTS) + 0.5f) / POINTS - 0.5f,
                    up = ((float)(k / POINTS) + 0.5f) / POINTS - 0.5f;
        const WeavePoint p = weave_point_bound(m, x + SQUARE * right, y + SQUARE * up, 0.1f, 0.0f);
        if (p.weft != weft || p.height <= WEAVE_NONE) continue;
        sum += (double)p.dye;
        count++;
    }
    return sum / count;
}

/* How squares side by side vary, across the threads of a system or along them. */
typedef struct Lots {
    double mean, deviation; /* of the dye of points */
    double apart;           /* of that and the dye from afar: the root of the mean square */
} Lots;

static Lots lots_of(const Weave *m, bool weft, bool along) {
    Lots lots = {0.0, 0.0, 0.0};
    for (int k = 0; k < SQUARES; k++) {
        const float at = (float)(SQUARE * k) + 3.3f, x = weft == along ? at : 31.7f, y = weft == along ? 31.7f : at;
        const double near = dye_seen(m, weft, x, y),
                     far = (double)weave_far_dye(m, weft, x, y, (WeaveFootprint){SQUARE, SQUARE, SQUARE});
        lots.mean += near / SQUARES;
        lots.deviation += near * near / SQUARES;
        lots.apart += (near - far) * (near - far) / SQUARES;
    }
    lots.deviation = (sqrt)(fmax(lots.deviation - lots.mean * lots.mean, 0.0));
    lots.apart = (sqrt)(lots.apart);
    return lots;
}

/* Lots of yarn make bars across their system that do not end along it, uneven dye makes patches in both directions. Seen
 * from afar both are where they are near by. The mean stays: 2.4 m of the coarsest bars are 60, whose mean is uncertain by
 * an eighth of their deviation. */
static void dye_varies_over_centimetres(void **state) {
    (void)state;
    WeftYarn barred = even_yarn("cotton"), patched = barred;
    barred.barre = 0.2f, barred.barre_width = 40.0f;
    patched.uneven = 0.2f, patched.uneven_size = 40.0f;
    WeftCloth *bars = woven("plain", barred, 3), *patches = woven("plain", patched, 3),
              *even = woven("plain", even_yarn("cotton"), 3);
    for (int k = 0; k < 4; k++) {
        const bool weft = k % 2, along = k / 2;
        const Lots b = lots_of(&bars->weave, weft, along), p = lots_of(&patches->weave, weft, along),
                   e = lots_of(&even->weave, weft, along);
        print_message("%s %s: bars %.3f deviation %.3f, from afar %.3f off; patches %.3f %.3f %.3f\n",
                      weft ? "weft" : "warp", along ? "along" : "across", b.mean, b.deviation, b.apart, p.mean,
                      p.deviation, p.apart);
        assert_true(along ? b.deviation < 0.002 : b.deviation > 0.05 && b.deviation < 0.15);
        assert_true(p.deviation > 0.05 && p.deviation < 0.15);
        assert_true(b.apart < 0.02 && p.apart < 0.02);
        if (!along) assert_true(fabs(b.mean - 1.0) < 0.03);
        assert_true(fabs(p.mean - 1.0) < 0.03);
        assert_true(e.deviation < 1e-6 && e.apart < 1e-6);
    }
    weft_cloth_free(bars);
    weft_cloth_free(patches);
    weft_cloth_free(even);
}

/* Returns over how many crossings the width of a thread goes from one node of its noise to the next: half of the mean
 * distance between its extremes is less than that, twice it is more. */
static double slub_length_of(const Weave *m) {
    double before = 0.0, slope = 0.0;
    int extremes = 0;
    enum { LENGTH = 20000 };
    for (int k = 0; k < LENGTH; k++) {
        const WeaveNoise n =
            weave_noise(m->seed, WEAVE_OF_THREADS, 5.0f, weave_nodes_along(m->warp.slub_nodes, (float)k, 0.0f));
        const double now = (double)n.second - before;
        extremes += k > 1 && now * slope < 0.0;
        slope = now;
        before = (double)n.second;
    }
    return (double)LENGTH / extremes;
}

/* A slub is as long as its yarn says, in millimetres, whatever the sett. */
static void slubs_are_millimetres_long(void **state) {
    (void)state;
    WeftYarn yarn = even_yarn("linen");
    yarn.slub_length = 40.0f;
    WeftCloth *coarse = woven("plain; sett 10", yarn, 0), *fine = woven("plain; sett 40", yarn, 0);
    const double c = slub_length_of(&coarse->weave) / 1.0, f = slub_length_of(&fine->weave) / 4.0; /* millimetres */
    print_message("slubs of 40 mm: extremes are %.1f mm apart at 10 threads/cm, %.1f mm at 40\n", c, f);
    assert_true(c > 40.0 && c < 90.0);
    assert_true(f > 40.0 && f < 90.0);
    weft_cloth_free(coarse);
    weft_cloth_free(fine);
}

static void a_seed_makes_a_cloth(void **state) {
    (void)state;
    WeftCloth *one = woven("plain", named_yarn("linen"), 1), *again = woven("plain", named_yarn("linen"), 1),
              *other = woven("plain", named_yarn("linen"), 2);
    int apart = 0;
    for (int k = 0; k < 300; k++) {
        const float x = 0.37f * (float)k, y = 0.11f * (float)k;
        assert_true(
            same_point(weave_point(&one->weave, x, y, 0.0f, 0.0f), weave_point(&again->weave, x, y, 0.0f, 0.0f)));
        apart += !same_point(weave_point(&one->weave, x, y, 0.0f, 0.0f), weave_point(&other->weave, x, y, 0.0f, 0.0f));
    }
    assert_true(apart > 250);
    weft_cloth_free(one);
    weft_cloth_free(again);
    weft_cloth_free(other);
}

/* A pick that never goes below is level, and every point is one of a yarn: finite, unit, white at the most. */
static void every_point_is_sound(void **state) {
    (void)state;
    static const char *const yarns[] = {"cotton", "linen", "wool", "silk", "dupion", "polyester"};
    for (size_t d = 0; d < sizeof drafts / sizeof *drafts; d++)
        for (size_t n = 0; n < sizeof yarns / sizeof *yarns; n++) {
            WeftCloth *cloth = woven(drafts[d], named_yarn(yarns[n]), (unsigned)n);
            for (int k = 0; k < 500; k++) {
                const float x = 1.618f * (float)k - 100.0f, y = 0.7071f * (float)k - 50.0f;
                const WeavePoint p = weave_point(&cloth->weave, x, y, 0.0f, 0.0f);
                if (p.height <= WEAVE_NONE) continue;
                const Yarn yarn = weave_yarn(&cloth->weave, p);
                const float length = p.fibre.x * p.fibre.x + p.fibre.y * p.fibre.y + p.fibre.z * p.fibre.z;
                assert_float_equal(length, 1.0f, 1e-4f);
                /* along the yarn's surface */
                assert_float_equal(p.fibre.x * p.slope_x + p.fibre.y * p.slope_y + p.fibre.z, 0.0f, 1e-4f);
                assert_true(yarn.share >= 0.0f && yarn.share <= 1.0f && fabsf(p.slope_x) < 8.0f);
                for (int c = 0; c < 3; c++) {
                    const float a = weave_albedo(&cloth->weave, p, c);
                    assert_true(a >= 0.0f && a <= 1.0f);
                }
            }
            weft_cloth_free(cloth);
        }
}

/* Places in rows that no thread and no fibre follows. */
enum { PLACES = 200000 };
static void place_of(int k, float *x, float *y) {
    *x = (float)fmod(0.7548776662466927 * k, 1.0) * 480.0f;
    *y = (float)fmod(0.5698402909980532 * k, 1.0) * 480.0f;
}

/* Returns how much of a point a sun sees that stands 15 degrees over the cloth. */
static double sunlit(WeavePoint p) { return (double)fmaxf(0.2588f + 0.683f * p.slope_x + 0.683f * p.slope_y, 0.0f); }

/* Fibres that are too fine to be seen are left out. The means of light, dye and slopes stay, and nearly those of colours,
 * from which more dye takes less than less dye gives. A low sun sees what slopes towards it: as much of fibres whose places
 * across are drawn as of those that are seen, and less of none. */
static void fibres_leave_the_mean_as_it_is(void **state) {
    (void)state;
    static const float most[] = {0.4f, 2.0f};
    for (int n = 0; n < 2; n++) {
        WeftYarn yarn = even_yarn("cotton");
        yarn.streaks = most[n];
        WeftCloth *cloth = woven("twill 2/2; both 1#a03040", yarn, 1);
        double lit = 0.0, dye = 0.0, slope[2] = {0.0, 0.0}, color[2] = {0.0, 0.0};
        struct {
            double fine, half_way, coarse, bare;
        } sun = {0.0, 0.0, 0.0, 0.0};
        int seen = 0;
        for (int k = 0; k < PLACES; k++) {
            float x, y;
            place_of(k, &x, &y);
            const float across = 2.0f * (float)fmod(1.4142135623730951 * k, 1.0) - 1.0f;
            const WeavePoint fine = weave_point(&cloth->weave, x, y, 0.0f, 0.0f),
                             coarse = weave_point(&cloth->weave, x, y, 0.09f, across),
                             bare = weave_point(&cloth->weave, x, y, 0.09f, 0.0f);
            if (fine.height <= WEAVE_NONE) continue;
            sun.fine += sunlit(fine), sun.coarse += sunlit(coarse), sun.bare += sunlit(bare);
            sun.half_way += sunlit(weave_point(&cloth->weave, x, y, 0.033f, across));
            assert_true(coarse.lit == 1.0f && coarse.dye == 1.0f);
            seen += fabsf(fine.lit - 1.0f) > 0.05f;
            lit += (double)(fine.lit - 1.0f) / PLACES;
            dye += (double)(fine.dye - 1.0f) / PLACES;
            slope[0] += (double)(fine.slope_x - coarse.slope_x) / PLACES;
            slope[1] += (double)(fine.slope_y - coarse.slope_y) / PLACES;
            color[0] += (double)weave_multiple(&cloth->weave, fine, 0);
            color[1] += (double)weave_multiple(&cloth->weave, coarse, 0);
        }
        print_message("cotton, streaks %.1f: light %+.4f, dye %+.4f, slopes %+.4f %+.4f, colour %+.4f\n",
                      (double)most[n], lit, dye, slope[0], slope[1], color[0] / color[1] - 1.0);
        print_message("a low sun: %+.4f, half way %+.4f, without their slopes %+.4f\n", sun.coarse / sun.fine - 1.0,
                      sun.half_way / sun.fine - 1.0, sun.bare / sun.fine - 1.0);
        assert_true(fabs(sun.coarse / sun.fine - 1.0) < 0.003);
        assert_true(fabs(sun.half_way / sun.fine - 1.0) < 0.02);
        assert_true(sun.bare < 0.98 * sun.fine);
        assert_true(seen > PLACES / 2);
        assert_true(fabs(lit) < 0.003 && fabs(dye) < 0.01);
        assert_true(fabs(slope[0]) < 0.003 && fabs(slope[1]) < 0.003);
        assert_true(fabs(color[0] / color[1] - 1.0) < 0.01);
        weft_cloth_free(cloth);
    }
}

/* Returns how much of the threads, or else of the gaps between them, loose fibres cover where points are so far apart. */
static double covered_by_hairs(const WeftCloth *cloth, float spacing, bool gaps) {
    int count = 0, all = 0;
    for (int k = 0; k < PLACES; k++) {
        float x, y;
        place_of(k, &x, &y);
        const float top = weave_top(&cloth->weave, x, y).height;
        const WeavePoint p = weave_point(&cloth->weave, x, y, spacing, 0.0f);
        assert_true(p.height >= top);
        assert_true(weave_gap(&cloth->weave, x, y) == (top <= WEAVE_NONE && p.height <= WEAVE_NONE));
        if (gaps != (top <= WEAVE_NONE)) continue;
        count += p.height > top;
        all++;
    }
    return (double)count / all;
}

static void hairiness_says_how_many_fibres_come_loose(void **state) {
    (void)state;
    double covered[3];
    for (int k = 0; k < 3; k++) {
        WeftYarn yarn = even_yarn("cotton");
        yarn.hairiness = 0.5f * (float)k;
        WeftCloth *cloth = woven("plain", yarn, 1);
        covered[k] = covered_by_hairs(cloth, 0.0f, false);
        assert_true(covered_by_hairs(cloth, 0.3f, false) == 0.0);
        weft_cloth_free(cloth);
    }
    print_message("hairiness 1 covers %.4f of the cloth\n", covered[2]);
    assert_true(covered[0] == 0.0);
    assert_true(covered[2] > 0.01 && covered[2] < 0.05);
    assert_true(fabs(covered[1] - 0.5 * covered[2]) < 0.1 * covered[2]);
}

/* Over gaps lie as many loose fibres as over threads, from near and far, and light does not pass them. */
static void loose_fibres_go_across_gaps(void **state) {
    (void)state;
    WeftYarn yarn = even_yarn("cotton");
    yarn.width = 0.6f;
    WeftCloth *bare = woven("plain", yarn, 1);
    yarn.hairiness = 1.0f;
    WeftCloth *hairy = woven("plain", yarn, 1);
    const double threads = covered_by_hairs(hairy, 0.0f, false), gaps = covered_by_hairs(hairy, 0.0f, true);
    print_message("loose fibres cover %.4f of threads, %.4f of gaps\n", threads, gaps);
    assert_true(fabs(gaps / threads - 1.0) < 0.15);
    assert_true(covered_by_hairs(hairy, 0.3f, true) == gaps);
    assert_true(covered_by_hairs(bare, 0.0f, true) == 0.0);
    weft_cloth_free(bare);
    weft_cloth_free(hairy);
}

static void a_thread_without_end_is_level(void **state) {
    (void)state;
    static const char wif[] = "[WIF]\nVersion=1.1\n[CONTENTS]\nWEAVING=yes\nWARP=yes\nWEFT=yes\nTHREADING=yes\n"
                              "LIFTPLAN=yes\n[WEAVING]\nShafts=2\nTreadles=2\n[WARP]\nThreads=2\n[WEFT]\n"
                              "Threads=2\n[THREADING]\n1=1\n2=2\n[LIFTPLAN]\n1=1,2\n2=1\n";
    WeftDraft *draft;
    WeftCloth *cloth;
    WeftError error;
    const WeftYarn yarn = even_yarn("cotton");
    assert_int_equal(weft_draft_read_memory(wif, sizeof wif - 1, "endless", &draft, NULL, &error), WEFT_OK);
    assert_int_equal(weft_cloth_create(draft, (WeftYarn[2]){yarn, yarn}, 0, &cloth, &error), WEFT_OK);
    int level = 0;
    for (int k = 0; k < 64; k++) { /* warp 1 is up at both picks */
        const WeavePoint p = weave_point(&cloth->weave, 0.5f, 0.05f * (float)k, 0.0f, 0.0f);
        if (p.weft || p.thread != 0.0f) continue;
        assert_float_equal(p.slope_y, 0.0f, 1e-6f);
        level++;
    }
    assert_true(level > 10);
    weft_draft_free(draft);
    weft_cloth_free(cloth);
}

static void numbers_that_no_yarn_has_are_refused_in_one_line(void **state) {
    (void)state;
    WeftDraft *draft;
    WeftCloth *cloth;
    WeftYarn yarn;
    WeftError error;
    assert_int_equal(weft_draft_parse("plain", &draft, &error), WEFT_OK);
    assert_int_equal(weft_yarn_find("nettle", &yarn, &error), WEFT_USAGE);
    assert_non_null(strstr(error.text, "nettle"));
    const WeftYarn good = named_yarn("cotton");
    const size_t count = sizeof good / sizeof(float);
    for (size_t k = 0; k < count; k++) {
        static const float wrong[] = {-9.0f, 9999.0f, NAN, INFINITY};
        for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++) {
            WeftYarn bad = good;
            memcpy((char *)&bad + k * sizeof(float), &wrong[w], sizeof(float));
            assert_int_equal(weft_cloth_create(draft, (WeftYarn[2]){good, bad}, 0, &cloth, &error), WEFT_USAGE);
            assert_null(cloth);
            assert_null(strchr(error.text, '\n'));
        }
    }
    weft_draft_free(draft);
}

static WeftImage read_map(const char *folder, const char *name) {
    char path[256];
    WeftImage image;
    WeftError error;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    if (weft_image_read(path, &image, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return image;
}

/* Returns the mean difference of two columns, in bytes. */
static double apart(const WeftImage *image, int one, int other) {
    const uint8_t *pixels = image->pixels;
    double sum = 0.0;
    for (int row = 0; row < image->height; row++)
        for (int c = 0; c < image->channels; c++) {
            const size_t at = (size_t)row * (size_t)image->width;
            const int a = pixels[(at + (size_t)one) * (size_t)image->channels + (size_t)c];
            const int b = pixels[(at + (size_t)other) * (size_t)image->channels + (size_t)c];
            sum += a > b ? a - b : b - a;
        }
    return sum / image->height / image->channels;
}

/* Across the seam a map changes as much as from thread to thread elsewhere. */
static void maps_repeat_without_a_seam(void **state) {
    (void)state;
    static const char *const names[] = {
        "base_color.png",      "normal.png",          "occlusion_roughness.png", "anisotropy.png",
        "height.png",          "back-base_color.png", "back-normal.png",         "back-occlusion_roughness.png",
        "back-anisotropy.png", "back-height.png"};
    char folder[64];
    WeftError error;
    snprintf(folder, sizeof folder, "/tmp/weft-maps-%ld", (long)getpid());
    WeftCloth *cloth = woven("twill 2/2; both 1#a08050", named_yarn("wool"), 5);
    if (weft_cloth_bake(cloth, 256, 0.5, folder, &error) != WEFT_OK) fail_msg("%s", error.text);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        WeftImage map = read_map(folder, names[k]);
        assert_int_equal(map.width, 256);
        double inside = 0.0; /* between columns on both sides of a boundary of threads, which are 16 wide */
        for (int c = 1; c < 16; c++) inside += apart(&map, 16 * c - 1, 16 * c) / 15.0;
        assert_true(apart(&map, map.width - 1, 0) < 1.5 * inside + 0.5);
        if (k % 5 == 1) assert_true(apart(&map, 8, 8 + 64) > 1.0); /* the draft comes again, its threads do not */
        weft_image_free(&map);
    }
    assert_int_equal(weft_cloth_bake(cloth, 8, 0.5, folder, &error), WEFT_USAGE);
    assert_int_equal(weft_cloth_bake(cloth, 64, -1.0, folder, &error), WEFT_USAGE);
    assert_int_not_equal(weft_cloth_bake(cloth, 64, 0.5, "/proc/weft", &error), WEFT_OK);
    char path[300];
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[k]);
        assert_int_equal(unlink(path), 0);
    }
    snprintf(path, sizeof path, "%s/material.json", folder);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(rmdir(folder), 0);
    weft_cloth_free(cloth);
}

/* Where the blue warp is over on the front, the white weft is on the back, and the other way. */
static void the_back_shows_what_lies_under(void **state) {
    (void)state;
    if (getenv("WEFT_TEST_SHORT")) skip(); /* a bake searches for its material: a minute under sanitizers */
    char folder[SCRATCH_SIZE];
    WeftError error;
    assert_true(scratch_make(folder));
    WeftCloth *cloth = woven("twill 3/1; warp 1#2030c0; weft 1#f0f0f0", named_yarn("cotton"), 0);
    if (weft_cloth_bake(cloth, 256, 0.5, folder, &error) != WEFT_OK) fail_msg("%s", error.text);
    WeftImage front = read_map(folder, "base_color.png"), back = read_map(folder, "back-base_color.png");
    assert_true(front.width == back.width && front.height == back.height);
    int one_is_blue = 0, seen = 0;
    double blue[2] = {0.0, 0.0};
    for (int row = 8; row < front.height; row += 16) /* in the middle of crossings, which are 16 wide */
        for (int column = 8; column < front.width; column += 16, seen++) {
            const size_t at = 4 * ((size_t)row * (size_t)front.width + (size_t)column);
            const uint8_t *a = (uint8_t *)front.pixels + at, *b = (uint8_t *)back.pixels + at;
            const bool warp[2] = {a[2] > 2 * a[0], b[2] > 2 * b[0]};
            one_is_blue += warp[0] != warp[1];
            for (int k = 0; k < 2; k++) blue[k] += warp[k];
        }
    assert_true(one_is_blue > 0.9 * seen);
    assert_true(blue[0] > 0.65 * seen && blue[0] < 0.85 * seen && blue[1] < 0.35 * seen);
    weft_image_free(&front);
    weft_image_free(&back);
    weft_cloth_free(cloth);
    assert_true(scratch_remove(folder));
}

/* A bake that fails takes its folder back, but leaves one that was there. */
static void failed_bake_leaves_no_folder(void **state) {
    (void)state;
    if (getenv("WEFT_TEST_SHORT")) skip();
    char folder[SCRATCH_SIZE], maps[SCRATCH_SIZE + 8];
    WeftError error;
    struct rlimit was, small;
    WeftCloth *cloth = woven("plain", named_yarn("cotton"), 0);
    assert_true(scratch_make(folder));
    snprintf(maps, sizeof maps, "%s/maps", folder);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &was), 0);
    small = was;
    small.rlim_cur = 3000; /* bytes: the first map is larger */
    void (*before)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    const WeftResult result = weft_cloth_bake(cloth, 64, 0.5, maps, &error);
    const WeftResult there = weft_cloth_bake(cloth, 64, 0.5, folder, &error);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &was), 0);
    signal(SIGXFSZ, before);
    assert_int_equal(result, WEFT_RESOURCES);
    assert_int_equal(there, WEFT_RESOURCES);
    assert_int_equal(access(maps, F_OK), -1);
    assert_int_equal(access(folder, F_OK), 0);
    weft_cloth_free(cloth);
    assert_true(scratch_remove(folder));
}

static void a_picture_shows_the_colours_of_its_threads(void **state) {
    (void)state;
    WeftCloth *cloth = woven("plain; both 1#c02020", named_yarn("cotton"), 0);
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_cloth_draw(cloth, 48, 6.0f, &image, &error), WEFT_OK);
    double sum[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < 48 * 48; k++)
        for (int c = 0; c < 3; c++) sum[c] += ((const uint8_t *)image.pixels)[3 * k + c] / (48.0 * 48.0);
    assert_true(sum[0] > 2.0 * sum[1] && sum[0] > 2.0 * sum[2] && sum[0] > 60.0);
    weft_image_free(&image);
    assert_int_equal(weft_cloth_draw(cloth, 0, 6.0f, &image, &error), WEFT_USAGE);
    assert_int_equal(weft_cloth_draw(cloth, 64, NAN, &image, &error), WEFT_USAGE);
    weft_cloth_free(cloth);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_draft_says_what_lies_on_top),
        cmocka_unit_test(shares_are_of_what_is_seen),
        cmocka_unit_test(variation_does_not_tile_unless_it_is_to),
        cmocka_unit_test(variation_has_no_period),
        cmocka_unit_test(dye_varies_over_centimetres),
        cmocka_unit_test(slubs_are_millimetres_long),
        cmocka_unit_test(a_seed_makes_a_cloth),
        cmocka_unit_test(every_point_is_sound),
        cmocka_unit_test(fibres_leave_the_mean_as_it_is),
        cmocka_unit_test(hairiness_says_how_many_fibres_come_loose),
        cmocka_unit_test(loose_fibres_go_across_gaps),
        cmocka_unit_test(a_thread_without_end_is_level),
        cmocka_unit_test(numbers_that_no_yarn_has_are_refused_in_one_line),
        cmocka_unit_test(maps_repeat_without_a_seam),
        cmocka_unit_test(the_back_shows_what_lies_under),
        cmocka_unit_test(failed_bake_leaves_no_folder),
        cmocka_unit_test(a_picture_shows_the_colours_of_its_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
