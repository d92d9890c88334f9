/* Baked cloth: textures and a material that were made of a weave are shaded as the weave is. An arc of cloth, +-75 degrees,
 * is seen from far away, so that the columns of a picture are slices of the BRDF, 16 texels a pixel in its middle. Path
 * traced with direct light alone: head-on, 60 degrees aside, 110 degrees round and behind, each bent about the warp and
 * about the weft; and an even sky. No such direction is among those of the fit.
 *
 * Labels: slow unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "measure/arc.h"
#include "scratch.h"
#include "weft/weft.h"
#include "woven_presets.h"

/* What is found of a preset: errors of the profile and of the sum of the sky as parts, the contrast near by over that of
 * the threads. */
typedef struct Found {
    double profile, worst, sky, contrast;
} Found;

/* Compares a material under each setup with the cloth that it was made of. The arc of either is made once for each
 * bend. */
static void compare_setups(const char *path, const ArcView *made, Apart apart[SETUPS]) {
    ArcView of[2] = {*made, *made};
    of[0].material = path, of[0].profile = NULL;
    for (int weft = 0; weft < 2; weft++) {
        WeftScene *scenes[2] = {NULL, NULL};
        for (int k = 0; k < SETUPS; k++) {
            if (setups[k].weft != (weft == 1)) continue;
            WeftImage images[2];
            for (int t = 0; t < 2; t++) {
                of[t].setup = k;
                if (!scenes[t]) scenes[t] = arc_scene(&of[t]);
                arc_trace(scenes[t], &of[t], &images[t], NULL);
            }
            apart[k] = compare(&images[1], &images[0]);
            for (int t = 0; t < 2; t++) weft_image_free(&images[t]);
        }
        for (int t = 0; t < 2; t++) weft_scene_free(scenes[t]);
    }
}

static Found find(const char *path, double zoom) {
    Found found = {.profile = 0.0};
    Apart apart[SETUPS];
    const ArcView made = {.material = "maps/material.json", .profile = "khronos", .zoom = zoom, .samples = 48};
    compare_setups(path, &made, apart);
    for (int k = 0; k < SETUPS; k++) {
        print_message(" %5.1f", 100.0 * apart[k].profile);
        if (setups[k].degrees < 0.0) found.sky = apart[k].mean;
        if (setups[k].degrees >= 0.0) found.profile += apart[k].profile / (SETUPS - 1);
        if (setups[k].degrees >= 0.0) found.worst = fmax(found.worst, apart[k].profile);
    }
    double contrasts[2];
    for (int k = 0; k < 2; k++) {
        WeftImage image;
        const ArcView view = {.material = k ? "maps/material.json" : path,
                              .profile = k ? "khronos" : NULL,
                              .zoom = 0.25 * zoom,
                              .setup = 2,
                              .samples = 48};
        arc_render(&view, &image, NULL);
        contrasts[k] = contrast(&image);
        weft_image_free(&image);
    }
    found.contrast = contrasts[1] / contrasts[0];
    return found;
}

/* The most that the profile of a preset may be off, in the mean over the lights, in percent. Silk has two crossed
 * highlights, and pile stands up, which one highlight along the surface cannot follow. */
static const struct {
    const char *preset;
    double most;
} limits[] = {{"woven-charmeuse", 20.0},
              {"woven-shantung", 24.5},
              {"woven-shot-silk", 28.0},
              {"woven-velvet", 22.0},
              {"woven-corduroy", 20.0}};

static double limit_of(const char *preset) {
    for (size_t k = 0; k < sizeof limits / sizeof *limits; k++)
        if (strcmp(limits[k].preset, preset) == 0) return limits[k].most;
    return 10.0;
}

static void check_preset(const char *name) {
    char path[128];
    WeftMaterial material;
    WeftCloth *cloth;
    WeftBaked fit;
    WeftError error;
    snprintf(path, sizeof path, "preset:%s", name);
    if (weft_material_read_woven(path, &material, &cloth, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    if (weft_material_bake(&material, cloth, &(WeftBaking){.pixels = SIDE, .one_face = 1}, "maps", &fit, &error) !=
        WEFT_OK)
        fail_msg("%s", error.text);
    print_message("%-16s", name);
    const Found found = find(path, 16.0 * texel_of(cloth) * WIDTH / (2.0 * sin(BEND)));
    print_message(" | mean %4.1f  sky %+5.1f  contrast %4.2f | fit %4.1f, copied %5.1f\n", 100.0 * found.profile,
                  100.0 * found.sky, found.contrast, 100.0 * fit.fitted, 100.0 * fit.copied);
    weft_cloth_free(cloth);
    assert_true(100.0 * found.profile <= limit_of(name));
    assert_true(fabs(found.sky) <= 0.05);
    assert_true(found.contrast >= 0.6 && found.contrast <= 1.6);
    assert_true(fit.fitted < 0.75 * fit.copied);
}

/* Prints a line a preset: percent of the profile under each light, and their mean. */
static void baked_presets_are_shaded_as_their_threads(void **state) {
    (void)state;
    print_message("%-16s  head, weft; side, weft; behind, weft; sky\n", "");
    for (int k = 0; weft_preset_name(k); k++)
        if (woven_family(weft_preset_name(k)) == 0) check_preset(weft_preset_name(k));
}

/* Returns the error of the profile in the mean over the lights, at so many texels a pixel, under `three`. */
static double profile_of(const char *path, const char *made, double zoom) {
    double sum = 0.0;
    Apart apart[SETUPS];
    compare_setups(path, &(ArcView){.material = made, .profile = "three", .zoom = zoom, .samples = 32}, apart);
    for (int k = 0; k < SETUPS; k++)
        if (setups[k].degrees >= 0.0) sum += apart[k].profile / (SETUPS - 1);
    return 100.0 * sum;
}

/* Satin loses most by means of texels, which make one round highlight of two crossed ones. Its levels keep its light from
 * far on, in textures of a size for a shop. */
static void levels_keep_the_light_from_afar(void **state) {
    (void)state;
    static const char path[] = "preset:woven-charmeuse";
    static const char *const files[] = {"base_color", "normal", "occlusion_roughness", "anisotropy"};
    WeftMaterial material;
    WeftCloth *cloth;
    WeftBaked fit;
    WeftError error;
    const WeftBaking baking = {.pixels = SIDE, .profile = "three", .levels = 1, .one_face = 1};
    if (weft_material_read_woven(path, &material, &cloth, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    if (weft_material_bake(&material, cloth, &baking, "levels", &fit, &error) != WEFT_OK) fail_msg("%s", error.text);
    const double zoom = texel_of(cloth) * WIDTH / (2.0 * sin(BEND));
    const double far = profile_of(path, "levels/material.json", 64.0 * zoom),
                 farther = profile_of(path, "levels/material.json", 256.0 * zoom);
    size_t bytes = 0;
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        char name[64];
        struct stat status;
        WeftImage image;
        snprintf(name, sizeof name, "levels/%s.ktx2", files[k]);
        assert_int_equal(stat(name, &status), 0);
        bytes += (size_t)status.st_size;
        if (weft_image_read(name, &image, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        assert_true(image.width % 4 == 0 && image.height % 4 == 0);
        weft_image_free(&image);
    }
    print_message("satin with levels: %.1f %% at 64 texels, %.1f %% at 256; %zu bytes\n", far, farther, bytes);
    assert_true(far <= 20.0 && farther <= 20.0 && fit.levels > 0.0 && fit.levels < 0.2);
    assert_true(bytes < 3000000 * SIDE / 1024 * SIDE / 1024);
    weft_cloth_free(cloth);
}

static void wrong_bakes_are_refused(void **state) {
    (void)state;
    WeftMaterial material;
    WeftCloth *cloth;
    WeftError error;
    if (weft_material_read_woven("preset:woven-denim", &material, &cloth, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    const struct {
        WeftBaking baking;
        const char *words;
    } wrong[] = {{{.pixels = 8}, "16 to 8192"},
                 {{.metres = -1.0}, "metres"},
                 {{.metres = (double)NAN}, "metres"},
                 {{.profile = "treacle"}, "no profile treacle"},
                 {{.profile = "filament-cloth"}, "metallic"}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_int_equal(weft_material_bake(&material, cloth, &wrong[k].baking, "none", NULL, &error), WEFT_USAGE);
        if (!strstr(error.text, wrong[k].words)) fail_msg("%s", error.text);
    }
    assert_int_equal(weft_material_bake(&material, NULL, &(WeftBaking){.pixels = 64}, "none", NULL, &error),
                     WEFT_USAGE);
    assert_non_null(strstr(error.text, "not woven"));
    assert_int_equal(access("none", F_OK), -1);
    weft_cloth_free(cloth);
}

/* Viewers that read glTF find no index of refraction in what is saved: it is the usual one. */
static void no_ior_is_written(void **state) {
    (void)state;
    WeftMaterial material;
    WeftCloth *cloth;
    WeftScene *scene = NULL;
    WeftError error;
    char text[65536];
    if (weft_material_read_woven("preset:woven-twill", &material, &cloth, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    WeftResult result = weft_material_bake(&material, cloth, &(WeftBaking){.pixels = 64}, "plain", NULL, &error);
    if (result == WEFT_OK) result = weft_scene_load("builtin:cloth", &scene, NULL, &error);
    if (result == WEFT_OK) result = weft_scene_assign_material(scene, NULL, "plain/material.json", NULL, &error);
    if (result == WEFT_OK) result = weft_scene_save(scene, "plain/cloth.gltf", &error);
    if (result != WEFT_OK) fail_msg("%s", error.text);
    FILE *file = fopen("plain/cloth.gltf", "rb");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    assert_int_equal(fclose(file), 0);
    assert_non_null(strstr(text, "KHR_materials_specular"));
    assert_null(strstr(text, "KHR_materials_ior"));
    weft_scene_free(scene);
    weft_cloth_free(cloth);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_bakes_are_refused),
        cmocka_unit_test(no_ior_is_written),
        cmocka_unit_test(baked_presets_are_shaded_as_their_threads),
        cmocka_unit_test(levels_keep_the_light_from_afar),
    };
    return cmocka_run_group_tests(tests, scratch_group_begin, scratch_group_end);
}
