/* The scene graph, cameras and lights. */
#include "reading.h"

#include <math.h>

static void cycles_of_nodes_are_refused(void **state) {
    (void)state;
    static const char *const nodes[] = {
        "{'children':[0]}",
        "{'children':[1]},{'children':[0]}",
        "{'children':[1]},{'children':[2]},{'children':[0]},{}",
        "{},{'children':[2]},{'children':[1]}",
    };
    static const char *const shared[] = {
        "{'children':[2]},{'children':[2]},{}",
        "{'children':[1,1]},{}",
        "{},{'children':[2]},{'children':[3]},{'children':[2]}",
    };
    for (size_t i = 0; i < sizeof nodes / sizeof *nodes; i++)
        assert_refused(read_rest("'nodes':[%s]", nodes[i]), WEFT_MESSAGE_GLTF_CYCLE, "node");
    for (size_t i = 0; i < sizeof shared / sizeof *shared; i++)
        assert_refused(read_rest("'nodes':[%s]", shared[i]), WEFT_MESSAGE_GLTF_PARENTS, "children");
    assert_refused(read_rest("'nodes':[{'children':[1]}]"), WEFT_MESSAGE_GLTF_REFERENCE,
                   "nodes[0].children[0]: 1 of 1");
    assert_refused(read_rest("'nodes':[{'mesh':0}]"), WEFT_MESSAGE_GLTF_REFERENCE, "nodes[0].mesh");
    assert_refused(read_rest("'scenes':[{'nodes':[0]}]"), WEFT_MESSAGE_GLTF_REFERENCE, "scenes[0].nodes[0]");
    assert_refused(read_rest("'scene':1,'scenes':[{}]"), WEFT_MESSAGE_GLTF_REFERENCE, "scene: 1 of 1");
}

/* A chain of 20000 nodes, each one step along x, the camera at its end; children before parents, so that no
 * order of the file helps. */
static void deep_chains_of_nodes_are_read(void **state) {
    (void)state;
    enum { DEPTH = 20000 };
    size_t size = (size_t)DEPTH * 64, used = 0;
    char *text = malloc(size);
    for (int i = 0; i < DEPTH; i++) {
        char link[32];
        snprintf(link, sizeof link, i ? "'children':[%d]" : "'camera':%d", i ? i - 1 : 0);
        used += (size_t)snprintf(text + used, size - used, "%s{'translation':[1,0,0],%s}", i ? "," : "", link);
    }
    Reading *reading = read_rest("'cameras':[{'type':'perspective','perspective':{'yfov':1}}],'nodes':[%s]", text);
    assert_read(reading);
    assert_int_equal(reading->scene->camera_count, 1);
    assert_near(reading->scene->cameras[0].eye.x, DEPTH, 0.0f);
    free(text);
    done(reading);
}

static void only_the_default_scene_is_shown(void **state) {
    (void)state;
    static const char form[] = SQUARE_DATA ",'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':3"
                                           "}]}],'nodes':[{'mesh':0,'name':'a'},{'children':[2],'name':'b'},"
                                           "{'mesh':0,'name':'c'}]%s";
    static const struct {
        const char *scenes;
        int meshes;
        const char *first;
    } cases[] = {
        {"", 2, "a"},
        {",'scenes':[{'nodes':[1]},{'nodes':[0]}]", 1, "c"},
        {",'scenes':[{'nodes':[1]},{'nodes':[0]}],'scene':1", 1, "a"},
        {",'scenes':[{}]", 0, NULL},
        {",'scenes':[{'nodes':[2]}]", 1, "c"}, /* not a root: shown all the same */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Reading *reading = read_rest(form, SQUARE_URI, cases[i].scenes);
        assert_read(reading);
        assert_int_equal(reading->scene->mesh_count, cases[i].meshes);
        if (cases[i].first) assert_string_equal(reading->scene->meshes[0].name, cases[i].first);
        done(reading);
    }
}

static void cameras_are_read(void **state) {
    (void)state;
    Reading *reading =
        read_rest("'cameras':[{'name':'near','type':'perspective','perspective':{'yfov':0.5,'znear':0.1}},"
                  "{'type':'orthographic','orthographic':{'xmag':2,'ymag':3,'znear':0,'zfar':9}}],'nodes':["
                  "{'camera':0,'translation':[1,2,3]},"
                  "{'name':'top','camera':1,'rotation':[-0.70710678,0,0,0.70710678],'scale':[2,5,-3]},"
                  "{'camera':0,'scale':[0,0,0]}]");
    assert_read(reading);
    assert_int_equal(reading->scene->camera_count, 2);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_IGNORED], 1);
    const Camera *a = &reading->scene->cameras[0], *b = &reading->scene->cameras[1];
    assert_string_equal(a->name, "near");
    assert_false(a->orthographic);
    assert_near(a->yfov, 0.5f, 1e-6f);
    assert_all_near(&a->eye.x, (const float[]){1, 2, 3}, 3, 1e-6f);
    assert_all_near(&a->forward.x, (const float[]){0, 0, -1}, 3, 1e-6f);
    assert_all_near(&a->up.x, (const float[]){0, 1, 0}, 3, 1e-6f);
    assert_all_near(&a->right.x, (const float[]){1, 0, 0}, 3, 1e-6f);
    /* Turned to look down; the mirror along its axis turns it around. */
    assert_string_equal(b->name, "top");
    assert_true(b->orthographic);
    assert_near(b->ymag, 3.0f, 0.0f);
    assert_all_near(&b->forward.x, (const float[]){0, 1, 0}, 3, 1e-6f);
    assert_all_near(&b->up.x, (const float[]){0, 0, -1}, 3, 1e-6f);
    done(reading);
    reading = read_rest("'cameras':[{'type':'fisheye'}],'nodes':[{'camera':0}]");
    assert_read(reading);
    assert_int_equal(reading->scene->camera_count, 0);
    assert_non_null(strstr(reading->warning, "cameras[0].type: \"fisheye\" is none of perspective, orthographic"));
    done(reading);
    assert_refused(read_rest("'cameras':[{}],'nodes':[{'camera':0}]"), WEFT_MESSAGE_GLTF_SCHEMA,
                   "cameras[0].type: missing");
    assert_refused(read_rest("'cameras':[{'type':'perspective'}],'nodes':[{'camera':0}]"), WEFT_MESSAGE_GLTF_SCHEMA,
                   "cameras[0].perspective.yfov: missing");
    assert_refused(read_rest("'cameras':[{'type':'orthographic','orthographic':{'ymag':0}}],"
                             "'nodes':[{'camera':0}]"),
                   WEFT_MESSAGE_GLTF_SCHEMA, "cameras[0].orthographic.ymag");
}

/* Where they are read from a picture, Embree would stop the program. */
static void nodes_too_far_away_are_refused(void **state) {
    (void)state;
    static const char camera[] = "'cameras':[{'type':'perspective','perspective':{'yfov':1}}],"
                                 "'nodes':[{'camera':0,'translation':[%s]}]",
                      light[] = "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'%s'}]}},'nodes':"
                                "[{'translation':[0,1e19,0],'extensions':{'KHR_lights_punctual':{'light':0}}}]";
    assert_refused(read_rest(camera, "1e19,0,0"), WEFT_MESSAGE_GLTF_TOO_LARGE, "cameras[0]: its node is too far");
    Reading *reading = read_rest(camera, "9e14,0,0");
    assert_read(reading);
    done(reading);
    assert_refused(read_rest(light, "point"), WEFT_MESSAGE_GLTF_TOO_LARGE, "its node is too far");
    reading = read_rest(light, "directional"); /* which is nowhere */
    assert_read(reading);
    done(reading);
}

#define LIGHTS             "'extensions':{'KHR_lights_punctual':{'lights':[%s]}},'nodes':[%s]"
#define LIGHT(index, rest) "{'extensions':{'KHR_lights_punctual':{'light':" #index "}}" rest "}"

static void punctual_lights_are_read(void **state) {
    (void)state;
    Reading *reading =
        read_rest(LIGHTS,
                  "{'type':'directional','name':'sun','intensity':3},{'type':'point','color':[1,0.5,0],'range':10},"
                  "{'type':'spot','spot':{'innerConeAngle':0.3,'outerConeAngle':0.6}},{'type':'spot'},"
                  "{'type':'spot','spot':{'innerConeAngle':0.6,'outerConeAngle':0.3}}",
                  LIGHT(0, ",'rotation':[0,0.70710678,0,0.70710678]") "," LIGHT(1, ",'translation':[1,2,3]") "," LIGHT(
                      2, ",'scale':[0,0,0]") "," LIGHT(3, "") "," LIGHT(4, ""));
    assert_read(reading);
    assert_int_equal(reading->scene->light_count, 5);
    const Light *l = reading->scene->lights;
    assert_string_equal(l[0].name, "sun");
    assert_int_equal(l[0].kind, LIGHT_DIRECTIONAL);
    assert_near(l[0].intensity, 3.0f, 0.0f);
    assert_all_near(&l[0].direction.x, (const float[]){-1, 0, 0}, 3, 1e-6f);
    assert_int_equal(l[1].kind, LIGHT_POINT);
    assert_all_near(&l[1].position.x, (const float[]){1, 2, 3}, 3, 0.0f);
    assert_all_near(l[1].color, (const float[]){1.0f, 0.5f, 0.0f}, 3, 0.0f);
    assert_near(l[1].range, 10.0f, 0.0f);
    assert_near(l[1].intensity, 1.0f, 0.0f);
    assert_int_equal(l[2].kind, LIGHT_SPOT);
    assert_near(l[2].cos_inner, cosf(0.3f), 1e-6f);
    assert_near(l[2].cos_outer, cosf(0.6f), 1e-6f);
    assert_all_near(&l[2].direction.x, (const float[]){0, 0, -1}, 3, 0.0f);
    assert_near(l[3].cos_outer, cosf(0.78539816f), 1e-6f);
    assert_near(l[3].cos_inner, 1.0f, 0.0f);
    assert_true(l[4].cos_inner >= l[4].cos_outer);
    done(reading);
    reading = read_rest(LIGHTS, "{'type':'area'},{'type':'point'}", LIGHT(0, "") "," LIGHT(1, ""));
    assert_read(reading);
    assert_int_equal(reading->scene->light_count, 1);
    assert_int_equal(reading->scene->lights[0].kind, LIGHT_POINT);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_IGNORED], 1);
    assert_non_null(strstr(reading->warning, "lights[0].type: \"area\" is none of directional, point, spot"));
    done(reading);
    reading = read_rest(LIGHTS, "{'type':'spot','spot':{'innerConeAngle':0.9,'outerConeAngle':0.5}}", LIGHT(0, ""));
    assert_read(reading);
    assert_non_null(strstr(reading->warning, "lights[0].spot.innerConeAngle: 0.9"));
    done(reading);
    reading = read_rest(LIGHTS, "{'type':'point','intesity':7}", LIGHT(0, ""));
    assert_read(reading);
    assert_non_null(strstr(reading->warning, "lights[0].intesity"));
    done(reading);
    assert_refused(read_rest(LIGHTS, "{'type':7}", LIGHT(0, "")), WEFT_MESSAGE_GLTF_SCHEMA,
                   "lights[0].type: expected a string, not 7");
    assert_refused(read_rest(LIGHTS, "{}", LIGHT(0, "")), WEFT_MESSAGE_GLTF_SCHEMA, "lights[0].type: missing");
    assert_refused(read_rest(LIGHTS, "", LIGHT(0, "")), WEFT_MESSAGE_GLTF_REFERENCE,
                   "nodes[0].extensions.KHR_lights_punctual.light: 0 of 0");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cycles_of_nodes_are_refused),     cmocka_unit_test(deep_chains_of_nodes_are_read),
        cmocka_unit_test(only_the_default_scene_is_shown), cmocka_unit_test(cameras_are_read),
        cmocka_unit_test(nodes_too_far_away_are_refused),  cmocka_unit_test(punctual_lights_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
