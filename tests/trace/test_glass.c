/* Solid and thin glass in the path tracer: that light is bent by Snell's law, absorbed by Beer's, and none made.
 *
 * Labels: unsanitized */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/random.h"
#include "scene/record/material_at.h"
#include "scenes.h"
#include "shading/material/choice.h"
#include "trace/path/solid.h"
#include "weft/weft.h"

/* Glass with a front alone. */
static Material *glass(WeftScene *scene, float roughness, float thickness) {
    Material *m = test_glass(scene, roughness, thickness);
    m->double_sided = false;
    return m;
}

/* A vertex of solid glass seen from wo. */
typedef struct Seen {
    Stack stack;
    StackView view;
    SolidGlass glass;
    SolidTable table;
    SolidView solid;
} Seen;

static void see(Seen *seen, float roughness, float ior, bool inside, Dir o) {
    WeftScene *scene = test_scene();
    Material *m = glass(scene, roughness, 1.0f);
    const Choices choices = choices_unmade();
    m->inputs[INPUT_ior].value[0] = ior;
    const Surface s = material_plain(m);
    stack_make(&seen->stack, &s, &choices, (TableRef){.kind = TABLE_NONE});
    seen->glass = solid_take(&seen->stack, &s, &seen->table);
    solid_table_fill(&seen->glass, false, &seen->table);
    if (inside) solid_hide_highlight(&seen->stack);
    stack_see(&seen->stack, &o, &seen->view);
    seen->solid = solid_see(&seen->glass, &seen->stack, &seen->view, inside);
    weft_scene_free(scene);
}

static StackValue value_of(const Seen *seen, Dir i) {
    StackValue v;
    stack_eval(&seen->stack, &seen->view, &i, 1, &v);
    const StackValue g = solid_glass(&seen->solid, i);
    v.f_cos.g += g.f_cos.g;
    v.pdf = v.pdf * (1.0f - seen->solid.p) + g.pdf;
    return v;
}

static Dir at(float cosine) {
    return dir(0.8f * sqrtf(1.0f - cosine * cosine), 0.6f * sqrtf(1.0f - cosine * cosine), cosine);
}

static void smooth_glass_bends_light_by_snell(void **state) {
    (void)state;
    static const float iors[] = {1.1f, 1.5f, 2.4f};
    double worst = 0.0;
    for (int n = 0; n < 60; n++) {
        Seen seen;
        const bool inside = n % 2;
        const float ior = iors[n / 2 % 3], cosine = 0.1f + 0.015f * (float)n, index = inside ? 1.0f / ior : ior;
        const Dir o = at(cosine);
        see(&seen, 0.0f, ior, inside, o);
        const float sine = sqrtf(1.0f - cosine * cosine) / index;
        for (int k = 0; k < 20; k++) {
            Dir i;
            const float u = ((float)k + 0.5f) / 20.0f;
            solid_sample(&seen.solid, u, 0.37f, u, &i);
            if (sine >= 1.0f) assert_true(i.z > 0.0f); /* all is reflected */
            if (!(i.z < 0.0f)) continue;
            worst = fmax(worst, fabs((double)hypotf(i.x, i.y) - (double)sine));
            assert_true(o.x * i.x + o.y * i.y < 0.0f);
        }
    }
    print_message("sines are off by %.1e at most\n", worst);
    assert_true(worst < 0.02);
}

/* R + T by samples and by an even sum over the sphere: 1 from either side, at any roughness. */
static void rough_glass_sends_on_what_it_should(void **state) {
    (void)state;
    enum { SAMPLES = 100000, EVEN = 400000 };
    static const float iors[] = {1.05f, 1.33f, 1.5f, 2.4f}, roughnesses[] = {0.1f, 0.3f, 0.6f, 1.0f};
    double most = 0.0, least[4] = {1.0, 1.0, 1.0, 1.0};
    uint32_t random = 5;
#define NEXT unit_float(hash32(++random * 0x9e3779b9u))
    for (int n = 0; n < 48; n++) {
        Seen seen;
        const int third_of = n / 16;
        const float roughness = roughnesses[n % 4], cosine = 0.1f + 0.28f * (float)third_of + 0.04f * (float)(n % 8);
        double drawn = 0.0, square = 0.0, even = 0.0, spread = 0.0;
        see(&seen, roughness, iors[n / 4 % 4], n % 3 == 0, at(cosine));
        for (int k = 0; k < SAMPLES; k++) {
            Dir i;
            const float u = NEXT, v = NEXT, third = NEXT;
            solid_sample(&seen.solid, u, v, third, &i);
            const StackValue value = value_of(&seen, i);
            const double x = value.pdf > 0.0f ? (double)(value.f_cos.g / value.pdf) : 0.0;
            drawn += x / SAMPLES;
            square += x * x / SAMPLES;
        }
        const double error = (sqrt)(fmax(square - drawn * drawn, 0.0) / SAMPLES);
        most = fmax(most, drawn - 4.0 * error);
        if (cosine > 0.3f) least[n % 4] = fmin(least[n % 4], drawn);
        if (roughness < 0.5f) continue;
        for (int k = 0; k < EVEN; k++) {
            const float z = 2.0f * NEXT - 1.0f, phi = 6.2831853f * NEXT, r = sqrtf(1.0f - z * z);
            const double x =
                4.0 * (double)PI_FLOAT * (double)value_of(&seen, dir(r * cosf(phi), r * sinf(phi), z)).f_cos.g;
            even += x / EVEN;
            spread += x * x / EVEN;
        }
        const double bound = 5.0 * (error + (sqrt)(fmax(spread - even * even, 0.0) / EVEN)) + 1e-3;
        if (!(fabs(drawn - even) < bound))
            fail_msg("ior %g, roughness %g, cosine %g: %.4f drawn, %.4f even", (double)iors[n / 4 % 4],
                     (double)roughness, (double)cosine, drawn, even);
    }
#undef NEXT
    print_message("R + T is at most %.4f; at least %.4f, %.3f, %.3f, %.3f at roughness .1, .3, .6, 1\n", most, least[0],
                  least[1], least[2], least[3]);
    assert_true(most < 1.002 && least[0] > 0.998 && least[1] > 0.998 && least[2] > 0.997 && least[3] > 0.99);
}

static double mean_of(const WeftScene *scene, WeftRenderDesc desc, int spp) {
    WeftImage image = test_render(scene, desc, spp);
    double sum = 0.0;
    const int count = image.width * image.height;
    for (int k = 0; k < count; k++) sum += (double)((const float *)image.pixels)[4 * k] / count;
    weft_image_free(&image);
    return sum;
}

/* White glass under radiance 1, solid and thin, bare and under fuzz. */
static void white_glass_vanishes(void **state) {
    (void)state;
    for (int k = 0; k < 6; k++) {
        const bool solid = k < 3, fuzzy = k % 3 == 1, rough = k % 3 == 2;
        WeftScene *scene = test_scene();
        test_environment(scene, 1.0f);
        Material *m = glass(scene, rough ? solid ? 0.3f : 0.7f : solid ? 0.03f : 0.1f, solid ? 1.0f : 0.0f);
        m->double_sided = !solid;
        m->inputs[INPUT_fuzz].value[0] = fuzzy ? 1.0f : 0.0f;
        test_sphere(scene, vec3(0, 0, 0), 1.0f);
        scene_bounds(scene);
        const WeftRenderDesc desc = {
            .width = 32, .height = 32, .camera = "0,0,3;0,0,0;40", .max_depth = 400, .sampling = WEFT_SAMPLING_LOBE};
        const double mean = mean_of(scene, desc, 256);
        printf("  white glass, %s%s%s: 1 %+.1e\n", solid ? "solid" : "thin", fuzzy ? ", fuzz" : "",
               rough ? ", rough" : "", mean - 1.0);
        assert_true(fabs(mean - 1.0) < 1e-3);
        weft_scene_free(scene);
    }
}

/* The same as engines draw it, but for Babylon.js, which takes F0 away a second time. Half of the samples of three.js'
 * highlight are even, so that its mean is the noisiest. */
static void white_glass_of_engines_vanishes(void **state) {
    (void)state;
    static const char *const profiles[] = {"three", "babylon", "filament-sheen", "openpbr", "babylon-openpbr"};
    for (size_t k = 0; k < 2 * sizeof profiles / sizeof *profiles; k++) {
        const bool solid = k % 2, babylon = k / 2 == 1;
        WeftScene *scene = test_scene();
        test_environment(scene, 1.0f);
        Material *m = glass(scene, 0.1f, solid ? 1.0f : 0.0f);
        m->inputs[INPUT_sheen].value[0] = 0.0f; /* fuzz takes from the base even where it is black */
        m->double_sided = !solid;
        weft_material_choose(m, CHOICE_profile, choice_find(CHOICE_profile, profiles[k / 2]));
        test_sphere(scene, vec3(0, 0, 0), 1.0f);
        scene_bounds(scene);
        const WeftRenderDesc desc = {
            .width = 32, .height = 32, .camera = "0,0,3;0,0,0;40", .max_depth = 400, .sampling = WEFT_SAMPLING_LOBE};
        const double mean = mean_of(scene, desc, 512);
        print_message("white glass of %s, %s: 1 %+.1e\n", profiles[k / 2], solid ? "solid" : "thin", mean - 1.0);
        assert_true(babylon ? mean > 0.85 && mean < 0.99 : fabs(mean - 1.0) < (k < 2 ? 1e-2 : 3e-3));
        weft_scene_free(scene);
    }
}

/* Half metal, half glass, and white: nothing is lost but what facets lose of the metal. */
static void partly_metal_glass_makes_no_light(void **state) {
    (void)state;
    for (int solid = 0; solid < 2; solid++) {
        WeftScene *scene = test_scene();
        test_environment(scene, 1.0f);
        glass(scene, 0.1f, solid ? 1.0f : 0.0f)->inputs[INPUT_metallic].value[0] = 0.5f;
        test_sphere(scene, vec3(0, 0, 0), 1.0f);
        scene_bounds(scene);
        const WeftRenderDesc desc = {
            .width = 32, .height = 32, .camera = "0,0,3;0,0,0;40", .max_depth = 400, .sampling = WEFT_SAMPLING_LOBE};
        const double mean = mean_of(scene, desc, 256);
        print_message("white glass, half metal, %s: 1 %+.1e\n", solid ? "solid" : "thin", mean - 1.0);
        assert_true(fabs(mean - 1.0) < 3e-3);
        weft_scene_free(scene);
    }
}

/* A metalness of 1 times a texture of 0 is no metal. */
static void texture_without_metal_is_glass(void **state) {
    (void)state;
    for (int solid = 0; solid < 2; solid++) {
        double seen[2];
        for (int textured = 0; textured < 2; textured++) {
            WeftScene *scene = test_scene();
            test_environment(scene, 1.0f);
            Material *m = glass(scene, 0.1f, solid ? 1.0f : 0.0f);
            test_color(m, INPUT_base_color, 0.8f);
            test_color(m, INPUT_attenuation_color, 0.3f);
            m->inputs[INPUT_attenuation_distance].value[0] = 1.0f;
            if (textured) {
                WeftImage black;
                assert_int_equal(weft_image_create(2, 2, 1, WEFT_PIXEL_U8, &black, NULL), WEFT_OK);
                memset(black.pixels, 0, 4);
                m->inputs[INPUT_metallic].value[0] = 1.0f;
                m->inputs[INPUT_metallic].texture = weft_scene_add_texture(scene, &black, NULL);
                assert_int_equal(m->inputs[INPUT_metallic].texture, 1);
            }
            test_sphere(scene, vec3(0, 0, 0), 1.0f);
            scene_bounds(scene);
            const WeftRenderDesc desc = {.width = 24, .height = 24, .camera = "0,0,3;0,0,0;40", .max_depth = 64};
            seen[textured] = mean_of(scene, desc, 64);
            weft_scene_free(scene);
        }
        print_message("%s glass, %.4f; with a texture of no metal, %.4f\n", solid ? "solid" : "thin", seen[0], seen[1]);
        assert_true(seen[0] < 0.999 && fabs(seen[1] - seen[0]) < 2e-3);
    }
}

/* Holes of a solid do not put the camera inside: how far away it is has no influence. */
static void partly_transparent_solid_is_the_same_from_afar(void **state) {
    (void)state;
    double seen[2];
    for (int far = 0; far < 2; far++) {
        WeftScene *scene = test_scene();
        test_environment(scene, 1.0f);
        Material *m = glass(scene, 0.1f, 1.0f);
        m->alpha_mode = WEFT_ALPHA_BLEND;
        m->inputs[INPUT_opacity].value[0] = 0.5f;
        test_color(m, INPUT_attenuation_color, 0.9f);
        m->inputs[INPUT_attenuation_distance].value[0] = 1.0f;
        test_sphere(scene, vec3(0, 0, 0), 1.0f);
        scene_bounds(scene);
        const WeftRenderDesc desc = {
            .width = 24, .height = 24, .camera = far ? "0,0,100;0,0,0;1" : "0,0,10;0,0,0;10.0", .max_depth = 32};
        seen[far] = mean_of(scene, desc, 128);
        weft_scene_free(scene);
    }
    print_message("a solid with holes, from 10 m: %.4f, from 100 m: %.4f\n", seen[0], seen[1]);
    assert_true(fabs(seen[1] - seen[0]) < 5e-3);
}

/* From the middle of a ball of radius 1 that reflects nothing straight ahead, what is left of a metre. */
static void camera_inside_a_solid_sees_through_it(void **state) {
    (void)state;
    for (int holes = 0; holes < 2; holes++) {
        WeftScene *scene = test_scene();
        test_environment(scene, 1.0f);
        Material *m = glass(scene, 0.0f, 1.0f);
        m->alpha_mode = holes ? WEFT_ALPHA_BLEND : WEFT_ALPHA_OPAQUE;
        m->inputs[INPUT_opacity].value[0] = 0.999f;
        m->inputs[INPUT_specular].value[0] = 0.0f;
        test_color(m, INPUT_attenuation_color, 0.5f);
        m->inputs[INPUT_attenuation_distance].value[0] = 1.0f;
        test_sphere(scene, vec3(0, 0, 0), 1.0f);
        scene_bounds(scene);
        const WeftRenderDesc desc = {.width = 8, .height = 8, .camera = "0,0,0;0,0,-1;30"};
        const double mean = mean_of(scene, desc, 64);
        print_message("from within, %.4f\n", mean);
        assert_true(fabs(mean - 0.5) < 4e-3);
        weft_scene_free(scene);
    }
}

/* By a profile that draws no glass a single-sided ball has no back: the camera in it sees the sky. */
static void profile_without_glass_has_one_side(void **state) {
    (void)state;
    const int opaque = choice_find(CHOICE_profile, "unreal4");
    WeftScene *scene = test_scene();
    test_environment(scene, 1.0f);
    Material *m = glass(scene, 0.5f, 1.0f);
    test_color(m, INPUT_base_color, 0.1f);
    weft_material_choose(m, CHOICE_profile, opaque);
    test_sphere(scene, vec3(0, 0, 0), 1.0f);
    scene_bounds(scene);
    const WeftRenderDesc desc = {.width = 8, .height = 8, .camera = "0,0,0;0,0,-1;30"};
    assert_true(fabs(mean_of(scene, desc, 4) - 1.0) < 1e-5);
    weft_scene_free(scene);
}

/* Thin and solid glass count as reflection where the sky has factors of its own. */
static void sky_counts_as_reflection_through_glass(void **state) {
    (void)state;
    for (int solid = 0; solid < 2; solid++) {
        WeftScene *scene = test_scene();
        test_environment(scene, 1.0f);
        scene->environment.reflection = 0.5f;
        scene->environment.ambient = 0.25f;
        glass(scene, 0.1f, solid ? 1.0f : 0.0f);
        test_quad(scene, vec3(-9, -9, 0.5f), vec3(18, 0, 0), vec3(0, 18, 0));
        if (solid) test_quad(scene, vec3(-9, -9, -0.5f), vec3(0, 18, 0), vec3(18, 0, 0));
        scene_bounds(scene);
        const WeftRenderDesc desc = {.width = 8, .height = 8, .camera = "0,0,4;0,0,0;10", .max_depth = 64};
        const double mean = mean_of(scene, desc, 256);
        print_message("%s glass under half a sky: %.4f\n", solid ? "solid" : "thin", mean);
        assert_true(fabs(mean - 0.5) < 3e-3);
        weft_scene_free(scene);
    }
}

/* What lies on a solid, or beside the glass in it, takes light and makes none: metal, coat, dust, a stretch, light that goes
 * through the diffuse lobe, a texture of transmission, and one solid in another. */
static void no_solid_makes_light(void **state) {
    (void)state;
    static const struct {
        const char *name;
        InputId input;
        float value;
    } cases[] = {{"metal", INPUT_metallic, 0.3f},
                 {"coat", INPUT_clearcoat, 1.0f},
                 {"dust", INPUT_dust, 0.5f},
                 {"stretch", INPUT_anisotropy, 0.8f},
                 {"cloth", INPUT_diffuse_transmission, 1.0f},
                 {"textured", INPUT_transmission, 1.0f},
                 {"nested", INPUT_transmission, 1.0f}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        WeftScene *scene = test_scene();
        test_environment(scene, 1.0f);
        Material *m = glass(scene, 0.2f, 1.0f);
        m->inputs[cases[k].input].value[0] = cases[k].value;
        if (cases[k].input == INPUT_diffuse_transmission) m->inputs[INPUT_transmission].value[0] = 0.5f;
        test_color(m, INPUT_diffuse_transmission_color, 1.0f);
        if (strcmp(cases[k].name, "textured") == 0) {
            WeftImage grey;
            assert_int_equal(weft_image_create(2, 2, 1, WEFT_PIXEL_U8, &grey, NULL), WEFT_OK);
            memset(grey.pixels, 128, 4);
            m->inputs[INPUT_transmission].texture = weft_scene_add_texture(scene, &grey, NULL);
            assert_int_equal(m->inputs[INPUT_transmission].texture, 1);
        }
        test_sphere(scene, vec3(0, 0, 0), 1.0f);
        if (strcmp(cases[k].name, "nested") == 0) {
            glass(scene, 0.2f, 1.0f)->inputs[INPUT_ior].value[0] = 1.3f;
            test_sphere(scene, vec3(0, 0, 0), 0.5f);
        }
        scene_bounds(scene);
        const WeftRenderDesc desc = {
            .width = 24, .height = 24, .camera = "0,0,3;0,0,0;40", .max_depth = 200, .sampling = WEFT_SAMPLING_LOBE};
        const double mean = mean_of(scene, desc, 64);
        print_message("a white solid, %s: %.4f\n", cases[k].name, mean);
        if (!(mean < 1.003 && mean > 0.6)) fail_msg("%s: %g", cases[k].name, mean);
        weft_scene_free(scene);
    }
}

/* A cube that reflects nothing, a metre thick, of which .5 is left after half a metre. */
static void inside_light_is_absorbed_by_beer(void **state) {
    (void)state;
    WeftScene *scene = test_scene();
    test_environment(scene, 1.0f);
    Material *m = glass(scene, 0.0f, 1.0f);
    m->inputs[INPUT_specular].value[0] = 0.0f;
    test_color(m, INPUT_attenuation_color, 0.5f);
    m->inputs[INPUT_attenuation_distance].value[0] = 0.5f;
    test_quad(scene, vec3(-9, -9, 0.5f), vec3(18, 0, 0), vec3(0, 18, 0));
    test_quad(scene, vec3(-9, -9, -0.5f), vec3(0, 18, 0), vec3(18, 0, 0));
    scene_bounds(scene);
    const WeftRenderDesc desc = {.width = 8, .height = 8, .camera = "0,0,4;0,0,0;1"};
    const double mean = mean_of(scene, desc, 256);
    print_message("of white light %.5f is left after a metre\n", mean);
    assert_true(fabs(mean - 0.25) < 5e-4);
    weft_scene_free(scene);
}

/* A matt ball in a ball of glass: it is lit through the glass, and looks larger. */
static void a_ball_in_glass_is_seen_larger(void **state) {
    (void)state;
    double seen[2];
    for (int k = 0; k < 2; k++) {
        WeftScene *scene = test_scene();
        test_environment(scene, 1.0f);
        test_material(scene, 0.0f);
        test_sphere(scene, vec3(0, 0, 0), 0.3f);
        if (k) {
            Material *m = glass(scene, 0.0f, 1.0f);
            m->inputs[INPUT_specular].value[0] = 0.0f;
            test_sphere(scene, vec3(0, 0, 0), 1.0f);
        }
        scene_bounds(scene);
        const WeftRenderDesc desc = {.width = 48, .height = 48, .camera = "0,0,20;0,0,0;6"};
        seen[k] = 1.0 - mean_of(scene, desc, 32);
        weft_scene_free(scene);
    }
    print_message("the dark part is %.3f of the picture, in glass %.3f: %.3f times\n", seen[0], seen[1],
                  seen[1] / seen[0]);
    assert_true(fabs(seen[1] / seen[0] - 2.25) < 0.1); /* ior squared, from afar */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smooth_glass_bends_light_by_snell),
        cmocka_unit_test(rough_glass_sends_on_what_it_should),
        cmocka_unit_test(white_glass_vanishes),
        cmocka_unit_test(white_glass_of_engines_vanishes),
        cmocka_unit_test(partly_metal_glass_makes_no_light),
        cmocka_unit_test(texture_without_metal_is_glass),
        cmocka_unit_test(partly_transparent_solid_is_the_same_from_afar),
        cmocka_unit_test(camera_inside_a_solid_sees_through_it),
        cmocka_unit_test(profile_without_glass_has_one_side),
        cmocka_unit_test(sky_counts_as_reflection_through_glass),
        cmocka_unit_test(no_solid_makes_light),
        cmocka_unit_test(inside_light_is_absorbed_by_beer),
        cmocka_unit_test(a_ball_in_glass_is_seen_larger),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
