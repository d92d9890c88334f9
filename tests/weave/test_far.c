/* Cloths of any yarns from afar: numbers of their lobes are finite and within what the lobe can do, its light is finite and not
 * below 0 and the same both ways round. White fibres send back no more than falls on the cloth by little more than a tenth,
 * which is of their points: yarns as no cloth has them, with a crimp of 69 degrees, have crowns that get more than their share. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "shading/cases.h"
#include "shading/weave/weave_light.h"
#include "weave/woven_fit.h"
#include "weft/weft.h"
#include "white_cloth.h"

enum { CLOTHS = 24, CLOTHS_LONG = 240, PAIRS = 200 };

static Random random_numbers = {41};
static double any_unit(void) { return (double)random_unit(&random_numbers); }

/* Any number of those that a yarn may have, or either end of them. */
static WeftYarn any_yarn(void) {
    WeftYarn yarn;
    for (int k = 0; weft_yarn_number(k); k++) {
        const WeftYarnNumber *number = weft_yarn_number(k);
        const double end = any_unit(), u = end < 0.1 ? 0.0 : end < 0.2 ? 1.0 : any_unit();
        *(float *)((char *)&yarn + number->offset) = number->low + (float)u * (number->high - number->low);
    }
    return yarn;
}

static WeftCloth *any_cloth(void) {
    static const char *const drafts[] = {"plain", "twill 3/1 z", "satin 8/3", "basket 2", "plain; warp 24k 4r"};
    const WeftYarn yarns[2] = {any_yarn(), any_yarn()};
    WeftDraft *draft;
    WeftCloth *cloth;
    WeftError error;
    const char *text = drafts[(int)(any_unit() * sizeof drafts / sizeof *drafts)];
    if (weft_draft_parse(text, &draft, &error) != WEFT_OK) fail_msg("%s", error.text);
    if (weft_cloth_create(draft, yarns, 7, &cloth, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_draft_free(draft);
    return cloth;
}

static Dir any_above(void) {
    const double z = 1e-4 + (1.0 - 1e-4) * any_unit();
    return direction_cos(z, 2.0 * PI_DOUBLE * any_unit());
}

#define BIN_OF(name) p->bins.name,
static void check_numbers(const WovenPrepared *p) {
    const WovenBin bins[] = {WOVEN_EACH_BIN(BIN_OF)};
    assert_true(p->level >= 0.0f && isfinite(p->level) && isfinite(p->steepest) && p->e >= 0.0f);
    assert_true(p->width > 0.0f && p->width <= ROUNDNESS_MOST);
    for (int k = 0; k < WOVEN_BINS - 1; k++) {
        const WovenSlopes slopes = woven_slopes(p, bins[k].slope);
        const float reach = fabsf(slopes.middle) + slopes.width;
        assert_true(slopes.width > 0.0f && reach <= ROUNDNESS_MOST + 1e-6f);
        assert_true(1.0f + p->edge * reach * reach >= 0.0f); /* the weight */
        assert_true(bins[k].weight >= 0.0f && isfinite(bins[k].weight));
        assert_true(bins[k].slope >= 0.0f && bins[k].slope <= 1.0f && slopes.c > 0.0f && slopes.c <= 1.0f);
    }
}

/* Returns 1 for a lobe that is not the one of its numbers alone. */
static int is_fitted(const WovenPrepared *p, Woven m) {
    WovenPrepared lobe;
    woven_prepare(m, &lobe);
    return p->level != lobe.level || p->bins.b1.weight != lobe.bins.b1.weight || p->taper != lobe.taper;
}

static double most_back, most_apart;
static int fitted; /* systems */

static void check_cloth(const WeftCloth *cloth) {
    for (int t = 0; t < 2; t++) {
        const WovenPrepared *p = &cloth->far.woven[t];
        check_numbers(p);
        fitted += is_fitted(p, weave_woven(&cloth->weave, t == WEFT_WEFT));
        for (int k = 0; k < PAIRS; k++) {
            const Dir o = any_above(), i = any_above();
            const float there = white_system(cloth, t, o, i), back = white_system(cloth, t, i, o);
            most_apart = fmax(most_apart, (double)(fabsf(there - back) / fmaxf(1.0f, there)));
        }
    }
    for (int k = 0; k < 8; k++)
        most_back = fmax(most_back, white_albedo(cloth, direction_cos(0.05 + 0.95 * k / 7.0, 0.8 * k)));
}

static void cloths_of_any_yarns_reflect_from_afar(void **state) {
    (void)state;
    for (int k = 0; k < (test_long() ? CLOTHS_LONG : CLOTHS); k++) {
        WeftCloth *cloth = any_cloth();
        check_cloth(cloth);
        weft_cloth_free(cloth);
    }
    print_message("at most %.3f of the light comes back, both ways round alike to %.1e\n", most_back, most_apart);
    print_message("%d systems are fitted\n", fitted);
    assert_true(fitted > CLOTHS);
    assert_true(most_back < 1.15);
    assert_true(most_apart < 1e-6);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(cloths_of_any_yarns_reflect_from_afar)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
