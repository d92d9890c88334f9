/* woven_cloths.h - the cloths of the woven presets, made once for a group of tests. After cmocka.h. */
#ifndef WEFT_TESTS_WOVEN_CLOTHS_H
#define WEFT_TESTS_WOVEN_CLOTHS_H

#include "scene/scene.h"
#include "weave/weft_cloth.h"
#include "weft/weft.h"
#include "woven_presets.h"

static struct {
    const char *name;
    WeftScene *scene;
} woven_cloths[2 * WOVEN_PRESETS];
static int woven_cloth_count;

/* What cmocka_run_group_tests takes to begin with and to end with. */
static inline int woven_cloths_make(void **state) {
    WeftError error;
    (void)state;
    for (int k = 0; weft_preset_name(k); k++) {
        const char *name = weft_preset_name(k), *text = weft_preset_text(k);
        if (woven_family(name) < 0) continue;
        assert_true(woven_cloth_count < 2 * WOVEN_PRESETS);
        WeftScene **scene = &woven_cloths[woven_cloth_count].scene;
        if (weft_scene_load("builtin:cloth", scene, NULL, &error) != WEFT_OK ||
            weft_scene_assign_material_memory(*scene, NULL, text, strlen(text), name, NULL, &error) !=
                WEFT_OK)
            fail_msg("%s", error.text);
        woven_cloths[woven_cloth_count++].name = name;
    }
    assert_true(woven_cloth_count >= WOVEN_PRESETS);
    return 0;
}
static inline int woven_cloths_free(void **state) {
    (void)state;
    while (woven_cloth_count) weft_scene_free(woven_cloths[--woven_cloth_count].scene);
    return 0;
}

static inline void each_woven_cloth(void (*check)(const char *name, const WeftCloth *cloth)) {
    for (int k = 0; k < woven_cloth_count; k++) {
        const WeftScene *scene = woven_cloths[k].scene;
        check(woven_cloths[k].name, scene->cloths[scene->materials[0].cloth - 1]);
    }
}

#endif
