/* woven_cloths.h - the cloths of the woven presets, made once for a group of tests. After cmocka.h. */
#ifndef WEFT_TESTS_WOVEN_CLOTHS_H
#define WEFT_TESTS_WOVEN_CLOTHS_H

#include "scene/record/scene.h"
#include "weave/weft_cloth.h"
#include "weft/weft.h"
#include "woven_presets.h"

enum { WOVEN_NUMBERS_MOST = 256 };
static WeftScene *woven_scenes[WOVEN_NUMBERS_MOST]; /* by the number of the preset; NULL: not made yet */

/* Returns the cloth of woven preset k, made where it is first asked for and kept to the end of the group. */
static inline const WeftCloth *woven_cloth(int k) {
    assert_in_range(k, 0, WOVEN_NUMBERS_MOST - 1);
    if (!woven_scenes[k]) {
        const char *name = weft_preset_name(k), *text = weft_preset_text(k);
        WeftError error;
        if (weft_scene_load("builtin:cloth", &woven_scenes[k], NULL, &error) != WEFT_OK ||
            weft_scene_assign_material_memory(woven_scenes[k], NULL, text, strlen(text), name, NULL, &error) != WEFT_OK)
            fail_msg("%s", error.text);
    }
    const WeftScene *scene = woven_scenes[k];
    return scene->cloths[scene->materials[0].cloth - 1];
}

/* Ends a group of tests, as cmocka_run_group_tests asks for it. */
static inline int woven_cloths_free(void **state) {
    (void)state;
    for (int k = 0; k < WOVEN_NUMBERS_MOST; k++) {
        weft_scene_free(woven_scenes[k]);
        woven_scenes[k] = NULL;
    }
    return 0;
}

static inline void each_woven_cloth(void (*check)(const char *name, const WeftCloth *cloth)) {
    int count = 0;
    for (int k = 0; weft_preset_name(k); k++) {
        if (woven_family(weft_preset_name(k)) < 0) continue;
        check(weft_preset_name(k), woven_cloth(k));
        count++;
    }
    assert_true(count >= WOVEN_PRESETS);
}

#endif
