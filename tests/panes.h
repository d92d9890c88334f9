/* panes.h - a floor under a sheet of glass, under a sun or a lamp, for tests of both engines */
#ifndef WEFT_TEST_PANES_H
#define WEFT_TEST_PANES_H

#include "trace/scenes.h"

/* The camera is between floor and glass. */
#define PANE_CAMERA "0,0.6,1.2;0,0,0;20"

static const float pane_tint[3] = {0.9f, 0.5f, 0.2f};

/* Glass that takes the tint from what goes through; thin of a thickness of 0. */
static inline Material *pane_material(WeftScene *scene, const float tint[3], float roughness, float thickness) {
    Material *m = test_glass(scene, roughness, thickness);
    for (int c = 0; c < 3; c++) m->inputs[INPUT_base_color].value[c] = tint[c];
    return m;
}

/* A matt floor in the dark. */
static inline WeftScene *pane_floor(void) {
    WeftScene *scene = test_scene();
    test_environment(scene, 0.0f);
    test_material(scene, 0.5f);
    test_quad(scene, vec3(-4, 0, 4), vec3(8, 0, 0), vec3(0, 0, -8));
    return scene;
}

/* A sheet of the last material, `height` above the floor. */
static inline void pane_put(WeftScene *scene, float height) {
    test_quad(scene, vec3(-3, height, 3), vec3(6, 0, 0), vec3(0, 0, -6));
}

/* A sun, of which the cosine to the floor is .8. */
static inline void pane_sun(WeftScene *scene) {
    test_sun(scene, vec3(0.6f, -0.8f, 0), PI_FLOAT);
    scene_bounds(scene);
}

/* A small lamp high above. */
static inline void pane_lamp(WeftScene *scene) {
    const WeftLight lamp = {.kind = WEFT_LIGHT_POLYGON,
                            .position = {0, 5, 0},
                            .direction = {0, -1, 0},
                            .color = {60, 60, 60},
                            .size = {0.6f, 0.6f}};
    scene_bounds(scene);
    assert_int_equal(weft_scene_add_light(scene, &lamp, NULL), WEFT_OK);
}

/* Returns what glass of an index of 1.5 lets through at a cosine: 1 - F, F by Schlick. */
static inline double pane_clear(double cosine) { return 1.0 - (0.04 + 0.96 * pow(1.0 - cosine, 5.0)); }

/* Sets the mean of each channel. */
static inline void pane_means(const WeftImage *image, double mean[3]) {
    const int count = image->width * image->height;
    mean[0] = mean[1] = mean[2] = 0.0;
    for (int k = 0; k < count; k++)
        for (int c = 0; c < 3; c++) mean[c] += (double)((const float *)image->pixels)[4 * k + c] / count;
}

#endif
