/* match - prints how far assets that `weft match` converted for other engines are from the original, beside copies of
 * their numbers
 *
 *   study_match [--spp N] [--map MAP.hdr] ASSET ...
 *
 * Each asset is path traced under khronos, and under each engine as it is and as it was matched, at 240 x 180 pixels.
 * The errors are FLIP at exposure 0 and relMSE (weft_diff). With few samples the noise, which is not the same in both
 * pictures, is a part of them: 512 unless told. Without a map the light is that of the asset. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scratch.h"
#include "weft/weft.h"

static const char *const engines[] = {"three", "filament-sheen", "filament-cloth"};
enum { ENGINES = sizeof engines / sizeof *engines };

/* How pictures are made. */
typedef struct How {
    int samples;
    const char *map; /* an environment; NULL: that of the asset */
} How;

static void check(WeftResult result, const WeftError *error) {
    if (result == WEFT_OK) return;
    fprintf(stderr, "study_match: %s\n", error->text);
    exit(1);
}

static int profile_named(const char *id) {
    int k = 0;
    while (weft_profile_name(k) && strcmp(weft_profile_name(k), id) != 0) k++;
    return k;
}

static WeftImage drawn(const char *path, const char *profile, const How *how) {
    const WeftRenderDesc desc = {.width = 240, .height = 180};
    WeftScene *scene;
    WeftRender *render;
    WeftImage image;
    WeftError error;
    check(weft_scene_load(path, &scene, NULL, &error), &error);
    check(weft_scene_set(scene, "*.profile", profile, NULL, &error), &error);
    if (how->map) check(weft_scene_set_environment_file(scene, how->map, NULL, &error), &error);
    check(weft_render_create(scene, &desc, &render, &error), &error);
    check(weft_render_run(render, how->samples, 0.0, NULL, NULL), &error);
    check(weft_render_image(render, &image, &error), &error);
    weft_render_free(render);
    weft_scene_free(scene);
    return image;
}

static double apart(const WeftImage *image, const WeftImage *reference, WeftMetric metric) {
    const WeftDiffDesc desc = {.image = image, .reference = reference, .metric = metric, .exposed = 1};
    WeftDiff found;
    WeftError error;
    check(weft_diff(&desc, &found, NULL, &error), &error);
    return found.value;
}

static const char *file_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static void compare(const char *asset, const char *engine, const WeftImage *original, const char *folder,
                    const How *how) {
    char out[SCRATCH_SIZE + 16];
    WeftError error;
    int count;
    snprintf(out, sizeof out, "%s/matched.glb", folder);
    check(weft_match_asset(asset, out, profile_named("khronos"), profile_named(engine), WEFT_BRDF_METRIC_COSINE, NULL,
                           NULL, NULL, &count, NULL, &error),
          &error);
    WeftImage images[2] = {drawn(asset, engine, how), drawn(out, engine, how)};
    printf("| %s | %s |", file_name(asset), engine);
    for (int k = 0; k < 2; k++) printf(" %.4f |", apart(&images[k], original, WEFT_METRIC_FLIP));
    for (int k = 0; k < 2; k++) printf(" %.5f |", apart(&images[k], original, WEFT_METRIC_RELMSE));
    printf("\n");
    fflush(stdout);
    for (int k = 0; k < 2; k++) weft_image_free(&images[k]);
}

int main(int count, char **arguments) {
    How how = {.samples = 512};
    char folder[SCRATCH_SIZE];
    int first = 1;
    for (; first + 1 < count && strncmp(arguments[first], "--", 2) == 0; first += 2) {
        if (strcmp(arguments[first], "--map") == 0)
            how.map = arguments[first + 1];
        else
            how.samples = (int)strtol(arguments[first + 1], NULL, 10);
    }
    if (first == count || how.samples < 1) {
        fprintf(stderr, "study_match [--spp N] [--map MAP.hdr] ASSET ...\n");
        return 2;
    }
    if (!scratch_make(folder)) return 1;
    printf("| asset | to | flip copied | matched | relMSE copied | matched |\n|---|---|---|---|---|---|\n");
    for (int k = first; k < count; k++) {
        WeftImage original = drawn(arguments[k], "khronos", &how);
        for (int n = 0; n < ENGINES; n++) compare(arguments[k], engines[n], &original, folder, &how);
        weft_image_free(&original);
    }
    return scratch_remove(folder) ? 0 : 1;
}
