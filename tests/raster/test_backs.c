/* What is seen of cloth from behind: the other face of a weave, or the back that a material was given, in both engines.
 *
 * Labels: slow */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "raster/gl.h"

#include "scene/record/scene.h"
#include "weave/weft_cloth.h"
#include "weft/weft.h"

enum { SIDE = 96, PIXELS = SIDE * SIDE };

/* A square of 40 mm in the plane z = 0 that faces +z, with metres as texture coordinates: positions, normals, texture
 * coordinates and triangles. */
#define BASE64                                                                                                         \
    "CtejvArXo7wAAAAACtejPArXo7wAAAAACtejPArXozwAAAAACtejvArXozwAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAI"                   \
    "A/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/CtejvArXozwK16M8CtejPArXozwK16O8CtejvArXo7wAAAEAAgAAAAIAAwA="
static const char quad[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":["
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},\"indices\":3,\"material\":0}]}],"
    "\"materials\":[{\"name\":\"c\",\"doubleSided\":true}],\"buffers\":[{\"byteLength\":140,\"uri\":"
    "\"data:application/octet-stream;base64," BASE64 "\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"
    "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":96,\"byteLength\":32},"
    "{\"buffer\":0,\"byteOffset\":128,\"byteLength\":12}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
    "\"count\":4,\"type\":\"VEC3\",\"min\":[-0.02,-0.02,0],\"max\":[0.02,0.02,0]},{\"bufferView\":1,\"componentType\":"
    "5126,\"count\":4,\"type\":\"VEC3\"},{\"bufferView\":2,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
    "{\"bufferView\":3,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}]}";

/* Returns the square in a material, under light along that direction. */
static WeftScene *scene_of(const char *material, float x, float y, float z) {
    WeftScene *scene;
    WeftError error;
    const WeftLight light = {.direction = {x, y, z}, .color = {3.0f, 3.0f, 3.0f}};
    if (weft_scene_load_memory(quad, sizeof quad - 1, "quad.gltf", &scene, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    assert_int_equal(weft_scene_add_light(scene, &light, &error), WEFT_OK);
    assert_int_equal(weft_scene_set_environment_color(scene, (const float[]){0.0f, 0.0f, 0.0f}, &error), WEFT_OK);
    if (weft_scene_assign_material_memory(scene, "*", material, strlen(material), "m.json", NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return scene;
}

static void trace(const WeftScene *scene, bool behind, const char *fov, WeftImage *out) {
    WeftRender *render;
    WeftError error;
    char camera[64];
    snprintf(camera, sizeof camera, "0,0,%s0.1;0,0,0;%s", behind ? "-" : "", fov);
    const WeftRenderDesc desc = {.width = SIDE,
                                 .height = SIDE,
                                 .max_depth = 1,
                                 .camera = camera,
                                 .background = WEFT_BACKGROUND_TRANSPARENT,
                                 .pixel_centre = 1,
                                 .no_shadows = 1,
                                 .no_roulette = 1};
    if (weft_render_create(scene, &desc, &render, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_render_run(render, 1, 0.0, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_render_image(render, out, &error), WEFT_OK);
    weft_render_free(render);
}

static void draw(const WeftScene *scene, bool behind, const char *fov, WeftImage *out) {
    WeftRaster *raster;
    WeftError error;
    char camera[64];
    snprintf(camera, sizeof camera, "0,0,%s0.1;0,0,0;%s", behind ? "-" : "", fov);
    const WeftRasterView view = {.width = SIDE,
                                 .height = SIDE,
                                 .samples = 1,
                                 .camera = camera,
                                 .background = WEFT_BACKGROUND_TRANSPARENT,
                                 .no_shadows = 1,
                                 .plain_textures = 1};
    if (weft_raster_create(scene, &(WeftRasterDesc){.gl = WEFT_GL_DESKTOP}, &raster, NULL, &error) != WEFT_OK ||
        weft_raster_draw(raster, &view, &error) != WEFT_OK || weft_raster_image(raster, out, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    weft_raster_free(raster);
}

static void mean_of(const WeftImage *image, double mean[3]) {
    const float *p = image->pixels;
    for (int c = 0; c < 3; c++) {
        mean[c] = 0.0;
        for (int k = 0; k < PIXELS; k++) mean[c] += (double)p[4 * k + c] / PIXELS;
    }
}

/* Fills the mean colours that both engines show, which must agree within a part of it. */
static void seen(const WeftScene *scene, bool behind, const char *fov, double part, double mean[3]) {
    WeftImage traced, drawn;
    double other[3];
    trace(scene, behind, fov, &traced);
    draw(scene, behind, fov, &drawn);
    mean_of(&traced, mean);
    mean_of(&drawn, other);
    for (int c = 0; c < 3; c++)
        if (!(fabs(other[c] / mean[c] - 1.0) < part))
            fail_msg("channel %d: traced %.4f, drawn %.4f", c, mean[c], other[c]);
    weft_image_free(&traced);
    weft_image_free(&drawn);
}

#define DENIM                                                                                                          \
    "{\"weave\":{\"draft\":\"twill 3/1 z; warp 1#26375c; weft 1#d8d4c8; sett 26 18\",\"warp\":\"cotton\",\"weft\":"    \
    "\"cotton\"}%s}"

static void denim_is_blue_and_its_back_is_white(void **state) {
    (void)state;
    need_gl();
    char text[512];
    snprintf(text, sizeof text, DENIM, "");
    for (int far = 0; far < 2; far++) {
        const char *fov = far ? "22" : "2"; /* near: 3.5 mm of it */
        WeftScene *front = scene_of(text, 0.3f, -0.4f, -1.0f), *back = scene_of(text, 0.3f, -0.4f, 1.0f);
        double blue[3], white[3];
        seen(front, false, fov, 0.08, blue);
        seen(back, true, fov, 0.08, white);
        if (!(white[0] > 2.5 * blue[0] && white[2] < white[0] && blue[2] > 1.1 * blue[0]))
            fail_msg("front %.4f %.4f %.4f, back %.4f %.4f %.4f", blue[0], blue[1], blue[2], white[0], white[1],
                     white[2]);
        weft_scene_free(front);
        weft_scene_free(back);
    }
}

/* A cloth that has the other face as its front looks, upside down, as the cloth does from behind: threads bulge towards
 * the eye on both sides, and rise and fall where they cross. */
static void threads_bulge_to_the_eye_on_both_sides(void **state) {
    (void)state;
    need_gl();
    static const char even[] = "{\"weave\":{\"draft\":\"twill 3/1 z; warp 1#26375c; weft 1#d8d4c8; sett 20\",\"warp\":"
                               "{\"yarn\":\"silk\",\"slub\":0,\"uneven\":0,\"streaks\":0,\"wander\":0,\"hairiness\":0},"
                               "\"weft\":{\"yarn\":\"silk\",\"slub\":0,\"uneven\":0,\"streaks\":0,\"wander\":0,"
                               "\"hairiness\":0}}}";
    WeftScene *back = scene_of(even, 0.8f, -0.5f, 1.0f), *front = scene_of(even, -0.8f, 0.5f, -1.0f);
    const Material *other = &back->materials[scene_back(back, 0)];
    WeftCloth *cloth = cloth_copy(scene_cloth_of(back, other));
    assert_non_null(cloth);
    cloth->other_face = false;
    free(cloth->text); /* else it is taken for the cloth of that text */
    cloth->text = NULL;
    cloth_spread(cloth, cloth->metres);
    front->materials[0].cloth = scene_adopt_cloth(front, cloth);
    front->materials[0].double_sided = false;
    WeftImage images[2][2];
    trace(back, true, "2", &images[0][0]);
    trace(front, false, "2", &images[0][1]);
    draw(back, true, "2", &images[1][0]);
    draw(front, false, "2", &images[1][1]);
    for (int engine = 0; engine < 2; engine++) {
        double differ = 0.0, sum = 0.0, wrong = 0.0;
        const float *a = images[engine][0].pixels, *b = images[engine][1].pixels;
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                const double at = (double)a[4 * (y * SIDE + x)];
                sum += at;
                differ += fabs(at - (double)b[4 * ((SIDE - 1 - y) * SIDE + x)]);
                wrong += fabs(at - (double)b[4 * (y * SIDE + x)]);
            }
        if (!(differ < 0.03 * sum && wrong > 0.1 * sum))
            fail_msg("engine %d: of %.1f, %.3f differ; %.3f were it not upside down", engine, sum, differ, wrong);
        weft_image_free(&images[engine][0]);
        weft_image_free(&images[engine][1]);
    }
    weft_scene_free(front);
    weft_scene_free(back);
}

static void a_material_has_a_back_of_its_own(void **state) {
    (void)state;
    need_gl();
    static const char red[] =
        "{\"base_color\":[0.6,0.05,0.05],\"back\":{\"base_color\":[0.05,0.05,0.6],\"roughness\":1}}";
    WeftScene *front = scene_of(red, 0.3f, -0.4f, -1.0f), *back = scene_of(red, 0.3f, -0.4f, 1.0f);
    double warm[3], cold[3];
    seen(front, false, "15", 0.01, warm);
    seen(back, true, "15", 0.01, cold);
    assert_true(warm[0] > 5.0 * warm[2] && cold[2] > 5.0 * cold[0]);
    weft_scene_free(front);
    weft_scene_free(back);
}

/* Backs are no materials that one can name, and a single-sided material has none. */
static void backs_are_not_listed(void **state) {
    (void)state;
    char text[512];
    WeftError error;
    snprintf(text, sizeof text, DENIM, ",\"double_sided\":false");
    WeftScene *scene = scene_of(text, 0.3f, -0.4f, -1.0f);
    assert_int_equal(weft_scene_info(scene).material_count, 1);
    assert_null(weft_scene_material_name(scene, 1));
    assert_int_equal(scene_back(scene, 0), -1);
    const WeftLight lamp = {.kind = WEFT_LIGHT_POLYGON,
                            .position = {0.0f, 0.0f, 1.0f},
                            .direction = {0.0f, 0.0f, -1.0f},
                            .color = {1.0f, 1.0f, 1.0f},
                            .size = {0.1f, 0.1f},
                            .corners = 4};
    snprintf(text, sizeof text, DENIM, ",\"double_sided\":true");
    assert_int_equal(weft_scene_assign_material_memory(scene, "*", text, strlen(text), "m.json", NULL, &error),
                     WEFT_OK);
    const int cloth = scene->materials[scene_back(scene, 0)].cloth;
    for (int k = 0; k < 9; k++) assert_int_equal(weft_scene_add_light(scene, &lamp, &error), WEFT_OK);
    assert_int_equal(scene->materials[scene_back(scene, 0)].cloth, cloth);
    while (weft_scene_info(scene).light_count > 0) assert_int_equal(weft_scene_remove_light(scene, 0, &error), WEFT_OK);
    assert_int_equal(scene->materials[scene_back(scene, 0)].cloth, cloth);
    weft_scene_free(scene);
}

static void the_other_face_of_the_other_face_is_the_cloth(void **state) {
    (void)state;
    char text[512];
    snprintf(text, sizeof text, DENIM, "");
    WeftScene *scene = scene_of(text, 0.3f, -0.4f, -1.0f);
    const WeftCloth *cloth = scene->cloths[scene->materials[0].cloth - 1],
                    *other = scene_cloth_of(scene, &scene->materials[scene_back(scene, 0)]);
    WeftCloth *again = cloth_other_face(other);
    const size_t cells = (size_t)cloth->weave.warps * (size_t)cloth->weave.picks;
    for (size_t k = 0; k < 4 * cells; k++) assert_true(fabsf(again->runs[k] - cloth->runs[k]) < 1e-6f);
    assert_true(other->other_face && !again->other_face && again->per_uv[0] * other->per_uv[0] < 0.0f);
    assert_true(cloth->weave.warp_far.share > 0.6f && other->weave.weft_far.share > 0.5f);
    weft_cloth_free(again);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(denim_is_blue_and_its_back_is_white),
        cmocka_unit_test(threads_bulge_to_the_eye_on_both_sides),
        cmocka_unit_test(a_material_has_a_back_of_its_own),
        cmocka_unit_test(backs_are_not_listed),
        cmocka_unit_test(the_other_face_of_the_other_face_is_the_cloth),
    };
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
