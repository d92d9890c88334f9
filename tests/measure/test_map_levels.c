/* Mip levels of the maps of a cloth with gaps: what its texels say of the threads is a mean of the threads alone, and what a
 * viewer does not read is not searched for */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "measure/cloth/map_levels.h"
#include "shading/material/choice.h"
#include "weave/weft_cloth.h"
#include "weft/weft.h"

enum { SIDE = 32 };

/* Plain weave with threads so far apart that they cover about half of it. */
static WeftCloth *open_cloth(void) {
    WeftDraft *draft;
    WeftCloth *cloth;
    WeftYarn yarn;
    WeftError error;
    if (weft_draft_parse("plain; both 1#c08040", &draft, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_yarn_find("cotton", &yarn, &error), WEFT_OK);
    yarn.width *= 0.3f;
    if (weft_cloth_create(draft, (WeftYarn[2]){yarn, yarn}, 0, &cloth, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_draft_free(draft);
    return cloth;
}

static MapLevels levels_of(const WeftCloth *cloth, const char *profile, bool holed) {
    MapGrid grid = {.weave = cloth->weave, .width = SIDE, .height = SIDE};
    const MapLook look = {.color = {1.0f, 1.0f, 1.0f},
                          .roughness = 1.0f,
                          .anisotropy = 0.9f,
                          .normal = 0.5f,
                          .specular = 1.0f,
                          .sheen_roughness = 0.6f,
                          .occlusion = {1.0f, 1.0f}};
    MapLevels levels;
    WeftMaterial material;
    WeftError error;
    memset(&levels, 0, sizeof levels);
    weft_material_default(&material);
    material.alpha_mode = holed ? WEFT_ALPHA_BLEND : WEFT_ALPHA_OPAQUE;
    grid.weave.cycle_x = grid.weave.cycle_y = 4.0f;
    MapFit *fit;
    if (map_fit_create(&grid, &material, cloth, choice_find(CHOICE_profile, profile), holed, &fit, &error) != WEFT_OK ||
        map_levels_find(fit, &look, &levels, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    map_fit_free(fit);
    return levels;
}

/* Returns a^2 + b^2 of a texel's highlight as a viewer reads it, a: along its longer axis, b: across. */
static double squares_of(const MapLevels *levels, int level, int column, int row) {
    unsigned char maps[MAP_LEVEL_MAPS][4];
    map_level_texel(levels, level, column, row, maps);
    const double roughness = maps[2][1] / 255.0 / (double)levels->items[level].roughness;
    const double strength = maps[3][2] / 255.0 / fmax((double)levels->items[level].anisotropy, 1e-3);
    const double b = roughness * roughness, a = b + (1.0 - b) * strength * strength;
    return a * a + b * b;
}

/* Returns the part of the sky that a texel sees, as a viewer reads it, without the strength of the level. */
static double open_of(const MapLevels *levels, int level, int column, int row) {
    unsigned char maps[MAP_LEVEL_MAPS][4];
    map_level_texel(levels, level, column, row, maps);
    return 1.0 - (1.0 - maps[2][0] / 255.0) / (double)levels->items[level].occlusion.strength;
}

static void levels_are_means_of_threads(void **state) {
    (void)state;
    WeftCloth *cloth = open_cloth();
    for (int holed = 0; holed < 2; holed++) {
        MapLevels levels = levels_of(cloth, "khronos", holed != 0);
        double cover = 0.0, squares = 0.0, open = 0.0;
        for (int k = 0; k < SIDE * SIDE; k++) {
            unsigned char maps[MAP_LEVEL_MAPS][4];
            map_level_texel(&levels, 0, k % SIDE, k / SIDE, maps);
            const double own = maps[0][3] / 255.0 / (SIDE * SIDE);
            cover += own;
            squares += own * squares_of(&levels, 0, k % SIDE, k / SIDE);
            open += own * open_of(&levels, 0, k % SIDE, k / SIDE);
        }
        assert_true(cover > 0.2 && cover < 0.8);
        for (int k = 0; k < levels.count; k++) /* so that the last level shows what it holds */
            levels.items[k].occlusion.strength = levels.items[k].occlusion.factor = levels.items[k].roughness =
                levels.items[k].anisotropy = 1.0f;
        const int last = levels.count - 1;
        print_message("cover %.2f: %.3f of %.3f, sky %.3f of %.3f\n", cover, squares_of(&levels, last, 0, 0),
                      squares / cover, open_of(&levels, last, 0, 0), open / cover);
        assert_true(fabs(squares_of(&levels, last, 0, 0) - squares / cover) < 0.03 * squares / cover);
        assert_true(fabs(open_of(&levels, last, 0, 0) - open / cover) < 0.02);
        map_levels_free(&levels);
    }
    weft_cloth_free(cloth);
}

/* A hole, which is seen where a viewer mixes it with threads, has the colour and the highlight of the threads. */
static void holes_draw_nothing_of_their_own(void **state) {
    (void)state;
    WeftCloth *cloth = open_cloth();
    MapLevels levels = levels_of(cloth, "khronos", true);
    unsigned char hole[MAP_LEVEL_MAPS][4], whole[MAP_LEVEL_MAPS][4];
    int holes = 0;
    for (int c = 0; c < 3; c++) levels.items[levels.count - 1].color[c] = levels.items[0].color[c];
    levels.items[levels.count - 1].roughness = levels.items[0].roughness;
    map_level_texel(&levels, levels.count - 1, 0, 0, whole);
    for (int k = 0; k < SIDE * SIDE; k++) {
        map_level_texel(&levels, 0, k % SIDE, k / SIDE, hole);
        if (hole[0][3] > 0) continue;
        holes++;
        for (int c = 0; c < 3; c++) assert_int_equal(hole[0][c], whole[0][c]);
        assert_int_equal(hole[2][1], whole[2][1]);
        assert_true(hole[2][0] > 0 && hole[1][2] > 127);
    }
    assert_true(holes > 0);
    map_levels_free(&levels);
    weft_cloth_free(cloth);
}

static void inputs_that_no_viewer_reads_are_not_searched_for(void **state) {
    (void)state;
    WeftCloth *cloth = open_cloth();
    MapLevels levels = levels_of(cloth, "filament-sheen", true);
    for (int k = 0; k < levels.count; k++) assert_true(fabs((double)levels.items[k].anisotropy - 1.0) < 1e-6);
    map_levels_free(&levels);
    weft_cloth_free(cloth);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_are_means_of_threads),
        cmocka_unit_test(holes_draw_nothing_of_their_own),
        cmocka_unit_test(inputs_that_no_viewer_reads_are_not_searched_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
