/* baked - prints how far the textures of woven cloths are from their threads, from near to far
 *
 *   study_baked [--profile NAME] [--size PIXELS] PRESET|/FILE.json ...
 *
 * Each preset, or woven material of a file, is baked and path traced on an arc of +-75 degrees (measure/arc.h) under a
 * profile, khronos unless told: the textures as they are, which the path tracer means in light (png); with mip levels that
 * are means of texels, which viewers draw (means); and with levels of their own (ktx2). A line for each has, at 4, 16, 64
 * and 256 texels a pixel in the middle, the mean over six lights of the profile's error, in percent of the light, and that
 * under an even sky, signed; then, with the light aside, at 4 texels the contrast over that of the threads and the
 * correlation with them; and with it behind, at 16 and 64, the change of pixels by a shift of (0.37, 0.21) pixels over
 * their mean, and that of the threads. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define fail_msg(...)          (fprintf(stderr, "study_baked: " __VA_ARGS__), fputc('\n', stderr), exit(1))
#define assert_true(x)         ((x) ? (void)0 : fail_msg("%s", #x))
#define assert_non_null(x)     assert_true((x) != NULL)
#define assert_int_equal(x, y) assert_true((x) == (y))

#include "measure/arc.h"
#include "scratch.h"

enum { SCALES = 4, KINDS = 3, SIDEWAYS = 2, BEHIND = 5, SAMPLES = 32 };
static const double scales[SCALES] = {4.0, 16.0, 64.0, 256.0}; /* texels a pixel */
static const char *const kinds[KINDS] = {"png", "means", "ktx2"};

/* Writes a material file again, with the suffixes of its textures changed. */
static void suffix_change(const char *from, const char *to) {
    static char text[65536];
    FILE *file = fopen(from, "rb");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    file = fopen(to, "wb");
    assert_non_null(file);
    for (const char *at = text, *end; *at; at = end) {
        end = strstr(at, ".png");
        fprintf(file, "%.*s%s", end ? (int)(end - at) : (int)strlen(at), at, end ? ".ktx2" : "");
        end = end ? end + 4 : at + strlen(at);
    }
    fclose(file);
}

/* Bakes a cloth in all kinds, to folders of their names. */
static void bake(const WeftMaterial *material, const WeftCloth *cloth, const char *profile, int side) {
    static const char *const maps[] = {"base_color", "normal", "occlusion_roughness", "anisotropy"};
    WeftError error;
    for (int k = 0; k < KINDS; k++) {
        const WeftBaking baking = {.pixels = side, .profile = profile, .levels = k == KINDS - 1, .one_face = 1};
        if (weft_material_bake(material, cloth, &baking, kinds[k], NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    }
    for (int m = 0; m < 4; m++) {
        WeftImage image;
        char path[128];
        snprintf(path, sizeof path, "means/%s.png", maps[m]);
        WeftResult result = weft_image_read(path, &image, NULL, &error);
        snprintf(path, sizeof path, "means/%s.ktx2", maps[m]);
        if (result == WEFT_OK) result = weft_image_write_as(path, &image, &(WeftImageWriting){.data = m != 0}, &error);
        if (result != WEFT_OK) fail_msg("%s", error.text);
        weft_image_free(&image);
    }
    suffix_change("means/material.json", "means/levels.json");
}

static const char *file_of(int kind) {
    return kind == 0 ? "png/material.json" : kind == 1 ? "means/levels.json" : "ktx2/material.json";
}

/* Returns the change of pixels by a shift over their mean, without noise, which halves of the samples do not share. */
static double shimmer(ArcView view) {
    WeftImage still[2], moved[2];
    double change = 0.0, mean = 0.0;
    view.samples = 2 * SAMPLES;
    arc_render(&view, &still[0], &still[1]);
    view.shift[0] = 0.37, view.shift[1] = 0.21;
    arc_render(&view, &moved[0], &moved[1]);
    for (int k = 0; k < 3 * WIDTH * HEIGHT; k++) {
        const int column = k / 3 % WIDTH, row = k / 3 / WIDTH, c = k % 3;
        if (column < WIDTH / 8 || column >= WIDTH - WIDTH / 8) continue;
        change += (pixel(&moved[0], column, row, c) - pixel(&still[0], column, row, c)) *
                  (pixel(&moved[1], column, row, c) - pixel(&still[1], column, row, c));
        mean += pixel(&still[0], column, row, c);
    }
    for (int k = 0; k < 2; k++) weft_image_free(&still[k]), weft_image_free(&moved[k]);
    const double count = 3.0 * (WIDTH - 2.0 * (WIDTH / 8)) * HEIGHT;
    return sqrt(fmax(change / count, 0.0)) / (mean / count);
}

/* The threads of a preset, drawn once for all kinds. */
typedef struct Truth {
    WeftImage setups[SCALES][SETUPS];
    double shimmer[2];
} Truth;

static void truth_draw(const char *path, double texel, Truth *truth) {
    ArcView view = {.material = path, .samples = SAMPLES};
    for (int s = 0; s < SCALES; s++)
        for (view.setup = 0; view.setup < SETUPS; view.setup++) {
            view.zoom = scales[s] * texel;
            arc_render(&view, &truth->setups[s][view.setup], NULL);
        }
    for (int k = 0; k < 2; k++) {
        view.zoom = scales[k + 1] * texel;
        view.setup = BEHIND;
        truth->shimmer[k] = shimmer(view);
    }
}

static void line_print(const char *name, const char *profile, int kind, double texel, const Truth *truth) {
    ArcView view = {.material = file_of(kind), .profile = profile, .samples = SAMPLES};
    double ratio = 0.0, together = 0.0;
    printf("| %s | %s |", kind == 0 ? name : "", kinds[kind]);
    for (int s = 0; s < SCALES; s++) {
        double sum = 0.0, sky = 0.0;
        for (view.setup = 0; view.setup < SETUPS; view.setup++) {
            WeftImage made;
            const WeftImage *as = &truth->setups[s][view.setup];
            view.zoom = scales[s] * texel;
            arc_render(&view, &made, NULL);
            const Apart apart = compare(&made, as);
            if (setups[view.setup].degrees < 0.0)
                sky = apart.mean;
            else
                sum += apart.profile / (SETUPS - 1);
            if (s == 0 && view.setup == SIDEWAYS)
                ratio = contrast(&made) / contrast(as), together = correlation(&made, as);
            weft_image_free(&made);
        }
        printf(" %.1f, %+.1f |", 100.0 * sum, 100.0 * sky);
    }
    printf(" %.2f | %.2f |", ratio, together);
    for (int k = 0; k < 2; k++) {
        view.zoom = scales[k + 1] * texel;
        view.setup = BEHIND;
        printf(" %.2f of %.2f%s", shimmer(view), truth->shimmer[k], k ? " |\n" : ",");
    }
    fflush(stdout);
}

static void preset_print(const char *name, const char *profile, int side) {
    static Truth truth;
    char path[4096];
    WeftMaterial material;
    WeftCloth *cloth;
    WeftError error;
    snprintf(path, sizeof path, "%s%s", *name == '/' ? "" : "preset:", name);
    if (weft_material_read_woven(path, &material, &cloth, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    if (!cloth) fail_msg("%s: is not woven", name);
    bake(&material, cloth, profile, side);
    const double texel = texel_of(cloth) * SIDE / side * WIDTH / (2.0 * sin(BEND));
    truth_draw(path, texel, &truth);
    for (int kind = 0; kind < KINDS; kind++) line_print(name, profile, kind, texel, &truth);
    for (int s = 0; s < SCALES; s++)
        for (int k = 0; k < SETUPS; k++) weft_image_free(&truth.setups[s][k]);
    weft_cloth_free(cloth);
}

int main(int count, char **arguments) {
    const char *profile = "khronos";
    int first = 1, side = SIDE;
    char folder[SCRATCH_SIZE];
    for (; first + 1 < count && strncmp(arguments[first], "--", 2) == 0; first += 2) {
        if (strcmp(arguments[first], "--profile") == 0) profile = arguments[first + 1];
        if (strcmp(arguments[first], "--size") == 0) side = (int)strtol(arguments[first + 1], NULL, 10);
    }
    if (first >= count || side < 16 || side > 8192) {
        fprintf(stderr, "use: study_baked [--profile NAME] [--size PIXELS] PRESET|/FILE.json ...\n");
        return 2;
    }
    if (!scratch_enter(folder)) return 1;
    printf(
        "| cloth | textures | 4 texels: profile, sky | 16 | 64 | 256 | contrast | correlation | shimmer at 16, 64 |\n"
        "|---|---|---|---|---|---|---|---|---|\n");
    for (int k = first; k < count; k++) preset_print(arguments[k], profile, side);
    return chdir("/") == 0 && scratch_remove(folder) ? 0 : 1;
}
