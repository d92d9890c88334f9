/* Sums of frames under a studio are the path tracer's direct light for every sheen lobe, for silk of strong anisotropy,
 * a metal, and woven cloth, whose points are those of threads, or from afar both systems
 *
 * Labels: slow unsanitized */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define SUMS_WIDTH  72
#define SUMS_HEIGHT 48
#include "raster/sums.h"

enum { FRAMES = 64, SPP = 512 };

static const WeftRasterView view = {
    .width = WIDTH, .height = HEIGHT, .camera = "0,1.1,3.2;0,0,0;24", .background = WEFT_BACKGROUND_TRANSPARENT};

/* A ball on a floor under the studio. */
static WeftScene *ball(void) {
    WeftScene *scene = test_scene();
    test_material(scene, 0.3f);
    Mesh *mesh = test_ball(scene, vec3(0.0f, 0.0f, 0.0f), 0.5f, 32);
    mesh->texcoord[0] = arena_array(&scene->arena, mesh->vertex_count, 2 * sizeof(float));
    mesh->tangent = arena_array(&scene->arena, mesh->vertex_count, 4 * sizeof(float));
    for (uint32_t k = 0; k < mesh->vertex_count; k++) {
        const float *n = mesh->normal + 3 * (size_t)k;
        float *uv = mesh->texcoord[0] + 2 * (size_t)k, *t = mesh->tangent + 4 * (size_t)k;
        const Vec3 along = vec3_normal_or(vec3(n[2], 0.0f, -n[0]), vec3(1.0f, 0.0f, 0.0f));
        uv[0] = 0.5f * n[0], uv[1] = 0.5f * n[1];
        t[0] = along.x, t[1] = along.y, t[2] = along.z, t[3] = 1.0f;
    }
    test_material(scene, 0.5f);
    test_quad(scene, vec3(-1.5f, -0.5f, 1.5f), vec3(3.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -3.0f));
    scene_bounds(scene);
    assert_int_equal(weft_scene_set_environment_studio(scene, NULL), WEFT_OK);
    return scene;
}

static void set(WeftScene *scene, const char *target, const char *value) {
    WeftError error;
    if (weft_scene_set(scene, target, value, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

static void every_sheen_lobe(void **state) {
    (void)state;
    need_gl();
    for (int k = 0; k < weft_lobe_count(); k++) {
        const WeftLobeInfo *lobe = weft_lobe_info(k);
        if (lobe->traits & WEFT_LOBE_REFERENCE) continue; /* never in a shader */
        WeftMaterial material;
        WeftScene *scene = ball();
        set(scene, "0.sheen_color", "0.8,0.6,0.4");
        set(scene, "0.sheen_roughness", "0.4");
        if (weft_scene_set(scene, "0.sheen_lobe", lobe->id, NULL, NULL) != WEFT_OK) {
            weft_scene_free(scene);
            continue;
        }
        assert_int_equal(weft_scene_material(scene, 0, &material, NULL), WEFT_OK);
        agrees(scene, &view, FRAMES, SPP, lobe->id, 0.04, 0.008);
    }
}

static void presets_are_as_traced(void **state) {
    (void)state;
    need_gl();
    static const char *const names[] = {"silk",        "semi-glossy-copper", "velvet",
                                        "woven-denim", "woven-linen",        "sadeghi-charmeuse"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        WeftScene *scene = ball();
        char path[64];
        WeftError error;
        snprintf(path, sizeof path, "preset:%s", names[k]);
        if (weft_scene_assign_material(scene, "0", path, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        if (k == 0) set(scene, "0.anisotropy", "0.9");
        agrees(scene, &view, FRAMES, SPP, names[k], 0.045, 0.008);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_sheen_lobe), cmocka_unit_test(presets_are_as_traced)};
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
