/* Threads have the size of their draft on a mesh: on small ones made here, scaled, mirrored, rotated and of several parts,
 * and on those of the shared data; where texture coordinates have several scales a warning says so.
 *
 * Labels: unsanitized */
#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/reading.h"
#include "scene/material/cloth_fit.h"
#include "weft/weave.h"

static char told[1024];

static void hear(void *user, WeftMessage message, const char *text) {
    (void)user;
    (void)message;
    snprintf(told, sizeof told, "%s", text);
}

static const WeftLog listening = {.fn = hear};

/* Returns the shares of a material's area on which a unit of texture coordinates spans at most, and at least, a length
 * within a fraction of `metres`. The length is the root of the product of both singular values of the map from texture
 * coordinates to space, from the metric tensor of each triangle. */
static double share_within(const WeftScene *scene, int material, double metres, double fraction) {
    double area = 0.0, within = 0.0;
    for (int m = 0; m < scene_own_meshes(scene); m++) {
        const Mesh *mesh = &scene->meshes[m];
        if (mesh->material != material || !mesh->texcoord[0]) continue;
        for (uint32_t k = 0; k < mesh->triangle_count; k++) {
            const uint32_t *i = mesh->index + 3 * (size_t)k;
            double e[2][3], t[2][2];
            for (int n = 0; n < 2; n++) {
                for (int c = 0; c < 3; c++)
                    e[n][c] = (double)mesh->position[3 * i[n + 1] + (uint32_t)c] -
                              (double)mesh->position[3 * i[0] + (uint32_t)c];
                for (int c = 0; c < 2; c++)
                    t[n][c] = (double)mesh->texcoord[0][2 * i[n + 1] + (uint32_t)c] -
                              (double)mesh->texcoord[0][2 * i[0] + (uint32_t)c];
            }
            const double det = t[0][0] * t[1][1] - t[0][1] * t[1][0];
            if (!(fabs(det) > 1e-20)) continue;
            double du[3], dv[3], uu = 0.0, uv = 0.0, vv = 0.0;
            for (int c = 0; c < 3; c++) {
                du[c] = (t[1][1] * e[0][c] - t[0][1] * e[1][c]) / det;
                dv[c] = (t[0][0] * e[1][c] - t[1][0] * e[0][c]) / det;
                uu += du[c] * du[c], uv += du[c] * dv[c], vv += dv[c] * dv[c];
            }
            const double of = sqrt(fmax(uu * vv - uv * uv, 0.0)), own = sqrt(of), size = 0.5 * of * fabs(det);
            area += size;
            if (fabs(own / metres - 1.0) <= fraction) within += size;
        }
    }
    return area > 0.0 ? within / area : -1.0;
}

/* Weaves a material and returns the metres that a unit of texture coordinates then spans. */
static double woven(WeftScene *scene, int material) {
    WeftError error;
    WeftMaterial is;
    char name[16];
    snprintf(name, sizeof name, "%d", material);
    told[0] = '\0';
    if (weft_scene_weave(scene, name, "", "twill 2/2; sett 20", &listening, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    assert_int_equal(weft_scene_material(scene, material, &is, NULL), WEFT_OK);
    const WeftClothInfo info = weft_scene_cloth_info(scene, is.cloth);
    assert_true(info.automatic);
    assert_float_equal(info.sett[0], 20.0f, 1e-3f);
    return (double)info.metres;
}

static WeftScene *scene_of(const char *nodes) {
    WeftScene *scene;
    WeftError error;
    char *text = json("{'asset':{'version':'2.0'}," SQUARE_DATA ",'materials':[{}],'meshes':[{'primitives':[{%s,"
                      "'material':0}]}],'nodes':[%s]}",
                      SQUARE_URI, SQUARE_PRIMITIVE, nodes);
    if (weft_scene_load_memory(text, strlen(text), "squares", &scene, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    free(text);
    return scene;
}

/* The square's side spans one unit of texture coordinates. */
static void threads_follow_the_scale_of_the_mesh(void **state) {
    (void)state;
    static const struct {
        const char *nodes;
        double by;
    } of[] = {{"{'mesh':0}", 1.0},
              {"{'mesh':0,'scale':[3.28,3.28,3.28]}", 3.28},
              {"{'mesh':0,'scale':[-0.02,0.02,0.02]}", 0.02},
              {"{'mesh':0,'rotation':[0.5,0.5,0.5,0.5],'scale':[7,7,7]}", 7.0},
              {"{'mesh':0},{'mesh':0,'translation':[9,0,0]}", 1.0}};
    WeftScene *one = scene_of(of[0].nodes);
    const double unit = woven(one, 0);
    weft_scene_free(one);
    for (size_t k = 0; k < sizeof of / sizeof *of; k++) {
        WeftScene *scene = scene_of(of[k].nodes);
        const double metres = woven(scene, 0);
        assert_true(fabs(metres / (unit * of[k].by) - 1.0) < 0.05);
        assert_true(share_within(scene, 0, metres, 0.05) > 0.999);
        if (told[0]) fail_msg("%s", told);
        weft_scene_free(scene);
    }
}

static void scales_that_differ_are_told(void **state) {
    (void)state;
    WeftScene *scene = scene_of("{'mesh':0},{'mesh':0,'scale':[4,4,4]}");
    const double metres = woven(scene, 0);
    assert_true(share_within(scene, 0, metres, 0.05) < 0.95);
    if (!strstr(told, "uneven")) fail_msg("\"%s\"", told);
    weft_scene_free(scene);
}

/* On meshes of even texture coordinates nearly all threads are within 5 % of their size; others are told. */
static void threads_of_sample_assets_have_their_size(void **state) {
    (void)state;
    const char *folder = getenv("WEFT_DATA");
    char path[1200], gltf[1024];
    snprintf(gltf, sizeof gltf, "%s/gltf", folder && *folder ? folder : WEFT_SOURCE_DIR "/../shared/data");
    static const char *const assets[] = {"GlamVelvetSofa.glb",
                                         "SheenChair/SheenChair.gltf",
                                         "SheenCloth/SheenCloth.gltf",
                                         "TextureTransformMultiTest.glb",
                                         "SpecularTest.glb",
                                         "ClearCoatTest.glb",
                                         "AnisotropyStrengthTest.glb",
                                         "NegativeScaleTest.glb",
                                         "Box With Spaces/Box With Spaces.gltf",
                                         "TextureTransformTest/TextureTransformTest.gltf"};
    int seen = 0, even = 0;
    for (size_t k = 0; k < sizeof assets / sizeof *assets; k++) {
        WeftScene *scene;
        WeftError error;
        snprintf(path, sizeof path, "%s/%s", gltf, assets[k]);
        if (weft_scene_load(path, &scene, NULL, &error) != WEFT_OK) {
            print_message("%s\n", error.text);
            continue;
        }
        seen++;
        for (int m = 0; m < scene_own_materials(scene) && m < 8; m++) {
            double uneven;
            if (!(cloth_uv_metres(scene, m, 0, &uneven) > 0.0)) continue;
            const double metres = woven(scene, m), share = share_within(scene, m, metres, 0.05);
            print_message("%s, material %d: %.3g m a unit, deviation %.3f, %.1f %% within 5 %%\n", assets[k], m, metres,
                          uneven, 100.0 * share);
            if (uneven < 0.02) assert_true(share > 0.9);
            if (uneven > 0.3) assert_non_null(strstr(told, "uneven"));
            if (uneven < 0.2) assert_null(strstr(told, "uneven"));
            even += uneven < 0.02;
        }
        weft_scene_free(scene);
    }
    print_message("%d assets, %d materials of even texture coordinates\n", seen, even);
    if (!seen) skip();
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(threads_follow_the_scale_of_the_mesh),
                                       cmocka_unit_test(scales_that_differ_are_told),
                                       cmocka_unit_test(threads_of_sample_assets_have_their_size)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
