/* Denoised pictures of woven cloth keep threads and checks: near and far, with few samples and with many, they are
 * nearer to the truth than the picture as it was sampled.
 * Labels: slow unsanitized */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>

#include "scene/record/scene.h"
#include "weave/weft_cloth.h"
#include "weft/weft.h"
#include "woven_presets.h"

enum { WIDTH = 60, HEIGHT = 45, REFERENCE = 256 };

/* Looks at folds of the cloth alone, which a pixel covers PIXEL metres of in the middle. */
static const char camera[] = "-0.2,0.9,0.9;0,0.4,0;14";
static const double PIXEL = 1.05 * 0.2456 / HEIGHT; /* distance times 2 tan(7 degrees) */

static float cross_length(Vec3 a, Vec3 b) { return vec3_length(vec3_cross(a, b)); }

/* Returns the texture coordinates that a metre of a mesh spans, from its areas. */
static float uv_per_metre(const Mesh *mesh) {
    double uv = 0.0, area = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        Vec3 p[3], q[3];
        for (int c = 0; c < 3; c++) {
            const uint32_t v = mesh->index[3 * t + (uint32_t)c];
            p[c] = vec3(mesh->position[3 * v], mesh->position[3 * v + 1], mesh->position[3 * v + 2]);
            q[c] = vec3(mesh->texcoord[0][2 * v], mesh->texcoord[0][2 * v + 1], 0.0f);
        }
        area += (double)cross_length(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
        uv += (double)cross_length(vec3_sub(q[1], q[0]), vec3_sub(q[2], q[0]));
    }
    return (float)(sqrt)(uv / area);
}

/* Returns the built-in cloth in a preset, with texture coordinates such that a thread is so many pixels wide. */
static WeftScene *draped(int preset, double pixels) {
    const char *text = weft_preset_text(preset), *name = weft_preset_name(preset);
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK ||
        weft_scene_assign_material_memory(scene, NULL, text, strlen(text), name, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    const WeftCloth *cloth = scene->cloths[scene->materials[0].cloth - 1];
    const Mesh *mesh = &scene->meshes[0];
    const float factor = (float)(1.0 / (pixels * PIXEL)) / (cloth->per_uv[0] * uv_per_metre(mesh));
    for (uint32_t k = 0; k < 2 * mesh->vertex_count; k++) mesh->texcoord[0][k] *= factor;
    return scene;
}

static WeftRender *rendered(const WeftScene *scene, bool halves, uint32_t seed, int spp) {
    const WeftRenderDesc desc = {.width = WIDTH,
                                 .height = HEIGHT,
                                 .camera = camera,
                                 .halves = halves ? WEFT_HALVES_SHARED : 0,
                                 .first_hits = halves,
                                 .seed = seed};
    WeftRender *r = NULL;
    WeftError error;
    if (weft_render_create(scene, &desc, &r, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_render_run(r, spp, 0.0, NULL, NULL), WEFT_OK);
    return r;
}

static WeftImage image_of(const WeftScene *scene, bool denoised, uint32_t seed, int spp) {
    WeftRender *r = rendered(scene, denoised, seed, spp);
    WeftImage image;
    WeftError error;
    if ((denoised ? weft_render_denoised(r, WEFT_DENOISER_REGRESSION, &image, &error)
                  : weft_render_image(r, &image, &error)) != WEFT_OK)
        fail_msg("%s", error.text);
    weft_render_free(r);
    return image;
}

static double relmse(const WeftImage *image, const WeftImage *reference) {
    WeftDiff found;
    assert_int_equal(weft_diff(&(WeftDiffDesc){.image = image, .reference = reference}, &found, NULL, NULL), WEFT_OK);
    return found.value;
}

static double light(const WeftImage *image, int x, int y) {
    const float *p = (const float *)image->pixels + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
    return (double)(p[0] + p[1] + p[2]);
}

/* Returns how a pixel differs from the mean of those around it. */
static double detail(const WeftImage *image, int x, int y) {
    enum { R = 3 };
    double sum = 0.0;
    for (int j = -R; j <= R; j++)
        for (int i = -R; i <= R; i++) sum += light(image, x + i, y + j);
    return light(image, x, y) - sum / ((2 * R + 1) * (2 * R + 1));
}

/* Returns the contrast of the reference's detail that is in an image: 1 is all of it, 0 none. */
static double kept(const WeftImage *image, const WeftImage *reference) {
    double sum = 0.0, all = 0.0;
    for (int y = 4; y < HEIGHT - 4; y++)
        for (int x = 4; x < WIDTH - 4; x++) {
            const double truth = detail(reference, x, y);
            sum += truth * detail(image, x, y), all += truth * truth;
        }
    return sum / all;
}

/* Compares both pictures of so many samples with the reference. */
static void compare(const WeftScene *scene, const WeftImage *reference, int spp, const char *what) {
    WeftImage plain = image_of(scene, false, 1, spp), denoised = image_of(scene, true, 1, spp);
    const double raw = relmse(&plain, reference), left = relmse(&denoised, reference);
    const double part = kept(&denoised, reference);
    if (!(left < raw)) fail_msg("%s, %d samples: relMSE %g, denoised %g", what, spp, raw, left);
    if (!(part > 0.5)) fail_msg("%s, %d samples: %.0f %% of the contrast is left", what, spp, 100.0 * part);
    weft_image_free(&plain);
    weft_image_free(&denoised);
}

/* Near by, a thread is four pixels wide; from afar ten threads share a pixel. */
static void denoised_cloth_is_nearer_to_the_truth_and_keeps_its_threads(void **state) {
    (void)state;
    for (int k = 0; weft_preset_name(k); k++)
        for (int far = 0; far < 2 && woven_family(weft_preset_name(k)) >= 0; far++) {
            char what[96];
            snprintf(what, sizeof what, "%s %s", weft_preset_name(k), far ? "from afar" : "near by");
            WeftScene *scene = draped(k, far ? 0.1 : 4.0);
            WeftImage reference = image_of(scene, false, 99, REFERENCE);
            compare(scene, &reference, 4, what);
            compare(scene, &reference, 64, what);
            weft_image_free(&reference);
            weft_scene_free(scene);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(denoised_cloth_is_nearer_to_the_truth_and_keeps_its_threads)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
