/* The light of an even sky in viewers, beside what they drew: three.js 0.187, Babylon.js 9.28 and Filament 1.53.4 as
 * they come from npm, a surface of one colour seen from its normal, under a sky of radiance 1, read back as floats. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "measure/cloth/map_sky.h"
#include "scene/record/material_at.h"
#include "shading/material/choice.h"

typedef struct Sample {
    float color, metallic, roughness, specular, sheen, sheen_roughness;
    double three, babylon, filament; /* 0: not drawn */
} Sample;

static const Sample samples[] = {{0.5f, 0.0f, 0.3f, 1.0f, 0.0f, 0.5f, 0.520, 0.520, 0.520},
                                 {0.5f, 0.0f, 0.7f, 1.0f, 0.0f, 0.5f, 0.514, 0.508, 0.514},
                                 {0.5f, 1.0f, 0.3f, 1.0f, 0.0f, 0.5f, 0.497, 0.498, 0.497},
                                 {0.5f, 1.0f, 0.7f, 1.0f, 0.0f, 0.5f, 0.412, 0.422, 0.419},
                                 {1.0f, 1.0f, 0.7f, 1.0f, 0.0f, 0.5f, 1.000, 1.000, 1.000},
                                 {0.5f, 0.5f, 0.5f, 1.0f, 0.0f, 0.5f, 0.498, 0.493, 0.440},
                                 {0.5f, 0.0f, 0.5f, 0.0f, 0.0f, 0.5f, 0.500, 0.500, 0.500},
                                 {0.5f, 0.0f, 0.5f, 0.5f, 0.0f, 0.5f, 0.509, 0.508, 0.0},
                                 {0.5f, 0.0f, 0.7f, 1.0f, 0.4f, 0.5f, 0.521, 0.515, 0.521},
                                 {0.5f, 1.0f, 0.5f, 1.0f, 0.4f, 0.8f, 0.499, 0.501, 0.499},
                                 {0.0f, 0.0f, 0.5f, 1.0f, 0.0f, 0.5f, 0.037, 0.037, 0.036}};

static Choices choices_of(const char *profile, Surface *surface) {
    Material material = material_default();
    material_choose(&material, CHOICE_profile, choice_find(CHOICE_profile, profile));
    material.inputs[INPUT_ior].value[0] = 1.5f;
    *surface = material_plain(&material);
    return material_choices(&material);
}

/* Returns the light of the sky towards the normal. */
static Rgb light_of(const MapSky *sky, const char *profile, const Sample *sample, float anisotropy) {
    Surface surface;
    const Choices choices = choices_of(profile, &surface);
    SeenStack seen;
    surface.base_color = rgb_grey(sample->color);
    surface.metallic = sample->metallic;
    surface.roughness = sample->roughness;
    surface.specular = sample->specular;
    surface.sheen_color = rgb_grey(sample->sheen);
    surface.sheen_roughness = sample->sheen_roughness;
    surface.anisotropy = anisotropy;
    seen_make(&seen, &surface, &choices, (TableRef){.kind = TABLE_NONE}, dir(0.0f, 0.0f, 1.0f));
    assert_true(map_sky_is_own(&seen.stack));
    return map_sky_light(sky, &seen, &surface);
}

static void skies_are_as_viewers_draw_them(void **state) {
    (void)state;
    static const char *const profiles[] = {"three", "babylon", "filament-sheen"};
    MapSky sky;
    WeftError error;
    if (map_sky_create(&sky, &error) != WEFT_OK) fail_msg("%s", error.text);
    for (size_t k = 0; k < sizeof samples / sizeof *samples; k++) {
        const double drawn[] = {samples[k].three, samples[k].babylon, samples[k].filament};
        for (int p = 0; p < 3; p++) {
            const double light = (double)light_of(&sky, profiles[p], &samples[k], 0.0f).g;
            if (drawn[p] > 0.0 && fabs(light - drawn[p]) > 0.012)
                fail_msg("sample %zu in %s: %.3f, drawn %.3f", k, profiles[p], light, drawn[p]);
        }
    }
    map_sky_free(&sky);
}

/* A stretched highlight is lit as a round one, which no integral over directions would give. */
static void stretched_highlights_are_lit_as_round_ones(void **state) {
    (void)state;
    MapSky sky;
    WeftError error;
    if (map_sky_create(&sky, &error) != WEFT_OK) fail_msg("%s", error.text);
    const Rgb round = light_of(&sky, "three", &samples[2], 0.0f),
              stretched = light_of(&sky, "three", &samples[2], 0.7f);
    assert_true(fabsf(round.g - stretched.g) < 1e-6f);
    map_sky_free(&sky);
}

/* Path tracers and viewers that integrate have no sky of their own. */
static void other_profiles_have_no_sky_of_their_own(void **state) {
    (void)state;
    static const char *const others[] = {"khronos", "core", "cycles-principled"};
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        Surface surface;
        const Choices choices = choices_of(others[k], &surface);
        SeenStack seen;
        seen_make(&seen, &surface, &choices, (TableRef){.kind = TABLE_NONE}, dir(0.0f, 0.0f, 1.0f));
        assert_false(map_sky_is_own(&seen.stack));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(skies_are_as_viewers_draw_them),
        cmocka_unit_test(stretched_highlights_are_lit_as_round_ones),
        cmocka_unit_test(other_profiles_have_no_sky_of_their_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
