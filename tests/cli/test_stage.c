/* An asset that brings neither light nor floor stands in a picture as it comes: lit by a key, framed, on a floor with its
 * shadow; and nothing is added to a picture whose light or background was chosen. */
#include "run.h"

#include <math.h>

#include "box.h"
#include "weft/image.h"

enum { WIDTH = 96, HEIGHT = 72 };
#define SMALL "--width=96", "--height=72", "--quiet"

static void quietly(const char *const *arguments) {
    Ran ran = run_with(NULL, arguments);
    if (ran.code != 0 || ran.err[0]) fail_msg("exit %d: %s", ran.code, ran.err);
    ran_free(&ran);
}

static WeftImage picture(const char *path) {
    WeftImage image;
    WeftError error = {0};
    if (weft_image_read(path, &image, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(image.width, WIDTH);
    return image;
}

/* Channel c of a pixel of a linear picture. */
static float channel(const WeftImage *image, int k, int c) {
    return ((const float *)image->pixels)[image->channels * k + c];
}

/* The asset's pixels are those without a floor; around them there is a shadow, and paper that is bright far from it. */
static void assert_stands_on_a_floor(const char *staged, const char *bare, const char *cut) {
    WeftImage with = picture(staged), without = picture(bare), mask = picture(cut);
    float least = INFINITY, most = 0.0f, changed = 0.0f;
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        const float alpha = channel(&mask, k, 3);
        if (alpha >= 1.0f) changed = fmaxf(changed, fabsf(channel(&with, k, 1) - channel(&without, k, 1)));
        if (alpha > 0.0f) continue;
        least = fminf(least, channel(&with, k, 1));
        most = fmaxf(most, channel(&with, k, 1));
    }
    if (!(least < 0.6f * most && most > 0.3f)) fail_msg("paper from %g to %g", (double)least, (double)most);
    if (!(changed < 1e-3f)) fail_msg("the asset changed by %g", (double)changed);
    weft_image_free(&with);
    weft_image_free(&without);
    weft_image_free(&mask);
}

/* The asset fills the picture from border to border but for a margin, and stands in its middle. */
static void assert_framed(const char *cut) {
    WeftImage mask = picture(cut);
    int left = WIDTH, right = -1, top = HEIGHT, bottom = -1;
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        const int x = k % WIDTH, y = k / WIDTH;
        if (channel(&mask, k, 3) < 0.5f) continue;
        left = x < left ? x : left, right = x > right ? x : right;
        top = y < top ? y : top, bottom = y > bottom ? y : bottom;
    }
    const double across = (right - left + 1) / (double)WIDTH, down = (bottom - top + 1) / (double)HEIGHT;
    const double fills = fmax(across, down);
    if (!(fills > 0.84 && fills < 0.94)) fail_msg("it fills %g by %g", across, down);
    assert_true(abs(left - (WIDTH - 1 - right)) <= 3 && abs(top - (HEIGHT - 1 - bottom)) <= 3);
    weft_image_free(&mask);
}

/* Of the three faces that are seen, the brightest is well above the darkest: the key comes from one side. */
static void assert_has_a_key(const char *bare, const char *cut) {
    WeftImage image = picture(bare), mask = picture(cut);
    float least = INFINITY, most = 0.0f;
    for (int y = 1; y + 1 < HEIGHT; y++)
        for (int x = 1; x + 1 < WIDTH; x++) {
            float mean = 0.0f, inside = 1.0f;
            for (int k = 0; k < 9; k++) {
                const int at = (y + k / 3 - 1) * WIDTH + x + k % 3 - 1;
                mean += channel(&image, at, 1) / 9.0f;
                inside = fminf(inside, channel(&mask, at, 3));
            }
            if (inside < 1.0f) continue;
            least = fminf(least, mean), most = fmaxf(most, mean);
        }
    if (!(most > 1.5f * least && least > 0.05f)) fail_msg("faces from %g to %g", (double)least, (double)most);
    weft_image_free(&image);
    weft_image_free(&mask);
}

static void bare_asset_is_lit_framed_and_on_a_floor(void **state) {
    (void)state;
    box_write("box.gltf", BOX_BARE);
    quietly(LIST("render", "box.gltf", SMALL, "--spp=32", "-o", "staged.exr"));
    quietly(LIST("render", "box.gltf", SMALL, "--spp=32", "--stage=none", "-o", "bare.exr"));
    quietly(LIST("render", "box.gltf", SMALL, "--spp=32", "--background=transparent", "-o", "cut.exr"));
    assert_stands_on_a_floor("staged.exr", "bare.exr", "cut.exr");
    assert_framed("cut.exr");
    assert_has_a_key("bare.exr", "cut.exr");
}

static void opengl_has_the_same_stage(void **state) {
    (void)state;
    Ran ran = run_with(NULL, LIST("render", "builtin:spheres", SMALL, "-o", "probe.png", "--engine=raster"));
    const bool none = ran.code != 0 && strstr(ran.err, "OpenGL");
    ran_free(&ran);
    if (none) print_message("no OpenGL\n");
    if (none) skip();
    box_write("box.gltf", BOX_BARE);
    quietly(LIST("render", "box.gltf", SMALL, "--engine=raster", "-o", "staged.exr"));
    quietly(LIST("render", "box.gltf", SMALL, "--engine=raster", "--stage=none", "-o", "bare.exr"));
    quietly(LIST("render", "box.gltf", SMALL, "--engine=raster", "--background=transparent", "-o", "cut.exr"));
    assert_stands_on_a_floor("staged.exr", "bare.exr", "cut.exr");
    assert_has_a_key("bare.exr", "cut.exr");
}

/* Renders with a stage and without one, and compares the bytes. */
static bool has_stage(const char *scene, const char *option) {
    size_t size;
    quietly(LIST("render", scene, SMALL, "--spp=2", "-o", "a.exr", option));
    quietly(LIST("render", scene, SMALL, "--spp=2", "-o", "b.exr", option, "--stage=none"));
    char *bytes = file_bytes("a.exr", &size);
    const bool same = same_bytes("b.exr", bytes, size);
    free(bytes);
    return !same;
}

static void chosen_light_and_background_have_no_stage(void **state) {
    (void)state;
    static const char *const options[] = {"--env=0.5",
                                          "--light=sun;-1,-2,-1;3,3,3",
                                          "--background=1,1,1",
                                          "--background=transparent",
                                          "--background=environment",
                                          "--floor"};
    box_write("box.gltf", BOX_BARE);
    assert_true(has_stage("box.gltf", "--exposure=1"));
    for (size_t k = 0; k < sizeof options / sizeof *options; k++)
        if (has_stage("box.gltf", options[k])) fail_msg("%s has a stage", options[k]);
    for (int kind = BOX_LIT; kind <= BOX_ON_FLOOR; kind++) {
        box_write("other.gltf", kind);
        if (has_stage("other.gltf", "--exposure=1")) fail_msg("a box of kind %d has a stage", kind);
    }
    assert_false(has_stage("builtin:ball", "--exposure=1"));
    quietly(LIST("render", "box.gltf", SMALL, "--spp=2", "--layer=additive,seed", "-o", "a.png"));
    quietly(LIST("render", "box.gltf", SMALL, "--spp=2", "--layer=additive,seed", "-o", "b.png", "--stage=none"));
    size_t size;
    char *bytes = file_bytes("a.png", &size);
    assert_true(same_bytes("b.png", bytes, size)); /* of a sheet, whose pictures are compared */
    free(bytes);
    assert_complaint(NULL, LIST("render", "box.gltf", SMALL, "-o", "a.png", "--stage=studio"), 2, "--stage");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(bare_asset_is_lit_framed_and_on_a_floor),
                                       cmocka_unit_test(opengl_has_the_same_stage),
                                       cmocka_unit_test(chosen_light_and_background_have_no_stage)};
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
