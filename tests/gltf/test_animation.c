/* Moments of animations: nodes by every interpolation, weights, skins, pointers; names; and what is wrong. */
#include "reading.h"

#include <math.h>

/* Keys at 1, 2 and 4 s; what they say, from byte 12 on. */
static const struct Keys {
    float times[3], moves[9], turns[8], scales[9], spline[9], weights[3], roughness[3], color[12], late[3];
    unsigned char seen[3];
} keys = {{1, 2, 4},
          {0, 0, 0, 10, 0, 0, 10, 20, 0},
          {0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f}, /* a quarter turn about z, keys at 1 and 2 s */
          {1, 1, 1, 2, 2, 2, 4, 4, 4},
          {0, 0, 0, 0, 0, 0, 6, 0, 0}, /* of one number at 3 keys: in-tangent, value, out-tangent each */
          {0, 1, 0.5f},
          {0.25f, 0.75f, 0.5f},
          {0, 0, 0, 1, 1, 0.5f, 0.25f, 1, 0, 0, 0, 1},
          {4, 2, 1},
          {1, 0, 1}};
enum {
    MOVES = 12,
    TURNS = 48,
    SCALES = 80,
    SPLINE = 116,
    WEIGHTS = 152,
    ROUGHNESS = 164,
    COLOR = 176,
    LATE = 224,
    SEEN = 236
};

/* The square under node 0, its copy under node 1, which is a child of 0. Accessors from 4 on: 4 times, 5 moves, 6 the
 * first two times, 7 turns, 8 scales, 9 splines, 10 weights, 11 roughness, 12 colours, 13 times that go back, 14 seen. */
static Reading *read_moment(const WeftMoment *moment, const char *animations) {
    char *whole =
        json("{'asset':{'version':'2.0'},'buffers':[{'byteLength':140,'uri':'%s'},{'byteLength':%zu,'uri':'%s'}],"
             "'bufferViews':[{'buffer':0,'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':48},"
             "{'buffer':0,'byteOffset':96,'byteLength':32},{'buffer':0,'byteOffset':128,'byteLength':12},"
             "{'buffer':1,'byteLength':%zu}],"
             "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"
             "{'bufferView':1,'componentType':5126,'count':4,'type':'VEC3'},"
             "{'bufferView':2,'componentType':5126,'count':4,'type':'VEC2'},"
             "{'bufferView':3,'componentType':5123,'count':6,'type':'SCALAR'},"
             "{'bufferView':4,'componentType':5126,'count':3,'type':'SCALAR'},"
             "{'bufferView':4,'byteOffset':%d,'componentType':5126,'count':3,'type':'VEC3'},"
             "{'bufferView':4,'componentType':5126,'count':2,'type':'SCALAR'},"
             "{'bufferView':4,'byteOffset':%d,'componentType':5126,'count':2,'type':'VEC4'},"
             "{'bufferView':4,'byteOffset':%d,'componentType':5126,'count':3,'type':'VEC3'},"
             "{'bufferView':4,'byteOffset':%d,'componentType':5126,'count':9,'type':'SCALAR'},"
             "{'bufferView':4,'byteOffset':%d,'componentType':5126,'count':3,'type':'SCALAR'},"
             "{'bufferView':4,'byteOffset':%d,'componentType':5126,'count':3,'type':'SCALAR'},"
             "{'bufferView':4,'byteOffset':%d,'componentType':5126,'count':3,'type':'VEC4'},"
             "{'bufferView':4,'byteOffset':%d,'componentType':5126,'count':3,'type':'SCALAR'},"
             "{'bufferView':4,'byteOffset':%d,'componentType':5121,'count':3,'type':'SCALAR'}],"
             "'materials':[{'name':'cloth'}],'meshes':[{'primitives':[{" SQUARE_PRIMITIVE
             ",'material':0,'targets':[{'POSITION':1}]}]}],"
             "'nodes':[{'mesh':0,'children':[1]},{'mesh':0,'translation':[0,0,3]},{'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,0,"
             "0,0,1]}"
             "],'scenes':[{'nodes':[0]}],'animations':[%s]}",
             SQUARE_URI, sizeof keys, uri(&keys, sizeof keys), sizeof keys, MOVES, TURNS, SCALES, SPLINE, WEIGHTS,
             ROUGHNESS, COLOR, LATE, SEEN, animations);
    Reading *reading = read_gltf_at(moment, "memory", whole, strlen(whole));
    free(whole);
    return reading;
}

/* An animation of one channel. */
static const char *channel(const char *target, int input, int output, const char *interpolation) {
    static char text[512];
    snprintf(text, sizeof text,
             "{'channels':[{'sampler':0,'target':{%s}}],'samplers':[{'input':%d,'output':%d,'interpolation':'%s'}]}",
             target, input, output, interpolation);
    return text;
}

static const float *first_corner(const Reading *reading, int mesh) { return reading->scene->meshes[mesh].position; }

static void nodes_move_by_every_interpolation(void **state) {
    (void)state;
    static const struct {
        const char *path;
        int input, output;
        const char *interpolation;
        double time;
        float at[3]; /* of the square's corner (1, 0, 0) */
    } cases[] = {
        {"translation", 4, 5, "LINEAR", 1.5, {6, 0, 0}},
        {"translation", 4, 5, "LINEAR", 3, {11, 10, 0}},
        {"translation", 4, 5, "LINEAR", -7, {1, 0, 0}},
        {"translation", 4, 5, "LINEAR", 1e6, {11, 20, 0}},
        {"translation", 4, 5, "LINEAR", 2, {11, 0, 0}},
        {"translation", 4, 5, "STEP", 1.99, {1, 0, 0}},
        {"translation", 4, 5, "STEP", 3.99, {11, 0, 0}},
        {"translation", 4, 5, "STEP", 4, {11, 20, 0}},
        {"scale", 4, 8, "LINEAR", 3, {3, 0, 0}},
        {"rotation", 6, 7, "LINEAR", 2, {0, 1, 0}},
        {"rotation", 6, 7, "LINEAR", 1.25, {0.92388f, 0.38268f, 0}},
        {"rotation", 6, 7, "LINEAR", 1.5, {0.70711f, 0.70711f, 0}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char target[64];
        snprintf(target, sizeof target, "'node':0,'path':'%s'", cases[k].path);
        const WeftMoment moment = {.time = cases[k].time};
        Reading *reading =
            read_moment(&moment, channel(target, cases[k].input, cases[k].output, cases[k].interpolation));
        assert_read(reading);
        assert_string_equal(reading->warning, "");
        assert_int_equal(reading->scene->mesh_count, 2);
        assert_all_near(first_corner(reading, 0) + 3, cases[k].at, 3, 1e-4f);
        done(reading);
    }
    /* At rest nothing of it is seen, and a line says so. */
    Reading *reading = read_moment(NULL, channel("'node':0,'path':'translation'", 4, 5, "LINEAR"));
    assert_read(reading);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_IGNORED], 1);
    assert_all_near(first_corner(reading, 0) + 3, (const float[3]){1, 0, 0}, 3, 0.0f);
    done(reading);
}

/* Weights move the square along its normal. A spline with tangents, by hand: from 0 at 2 s, leaving at 0 a second, to 0 at
 * 4 s, arriving at 6 a second: at 3 s it is (u^3 - u^2) 2 s 6 / s = -1.5. */
static void weights_move_morph_targets(void **state) {
    (void)state;
    static const struct {
        int output;
        const char *interpolation;
        double time;
        float z;
    } cases[] = {{10, "LINEAR", 1.5, 0.5f}, {10, "LINEAR", 3, 0.75f}, {10, "STEP", 3, 1}, {9, "CUBICSPLINE", 1.5, 0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const WeftMoment moment = {.time = cases[k].time};
        Reading *reading =
            read_moment(&moment, channel("'node':0,'path':'weights'", 4, cases[k].output, cases[k].interpolation));
        assert_read(reading);
        assert_string_equal(reading->warning, "");
        assert_near(first_corner(reading, 0)[2], cases[k].z, 1e-5f);
        assert_near(first_corner(reading, 1)[2], 3, 0.0f); /* the same mesh under another node */
        done(reading);
    }
    static const double times[] = {3, 4};
    static const float splined[] = {-1.5f, 0};
    for (int k = 0; k < 2; k++) {
        const WeftMoment moment = {.time = times[k]};
        Reading *reading = read_moment(&moment, channel("'node':0,'path':'weights'", 4, 9, "CUBICSPLINE"));
        assert_read(reading);
        assert_near(first_corner(reading, 0)[2], splined[k], 1e-5f);
        done(reading);
    }
}

#define POINTED(pointer) "'path':'pointer','extensions':{'KHR_animation_pointer':{'pointer':'" pointer "'}}"

static void pointers_move_materials_and_visibility(void **state) {
    (void)state;
    const WeftMoment moment = {.time = 1.5};
    Reading *reading =
        read_moment(&moment, channel(POINTED("/materials/0/pbrMetallicRoughness/roughnessFactor"), 4, 11, "LINEAR"));
    assert_read(reading);
    assert_string_equal(reading->warning, "");
    assert_near(reading->scene->materials[0].inputs[INPUT_roughness].value[0], 0.5f, 1e-6f);
    done(reading);
    reading =
        read_moment(&moment, channel(POINTED("/materials/0/pbrMetallicRoughness/baseColorFactor"), 4, 12, "LINEAR"));
    assert_read(reading);
    assert_all_near(reading->scene->materials[0].inputs[INPUT_base_color].value, (const float[3]){0.5f, 0.25f, 0.125f},
                    3, 1e-6f);
    done(reading);
    reading = read_moment(&moment, channel(POINTED("/nodes/0/weights/0"), 4, 10, "STEP"));
    assert_read(reading); /* the node has no weights: this leads nowhere */
    assert_non_null(strstr(reading->warning, "\"/nodes/0/weights/0\" leads nowhere"));
    done(reading);
    for (int k = 0; k < 2; k++) {
        const WeftMoment seen = {.time = 1.5 + k};
        reading =
            read_moment(&seen, channel(POINTED("/nodes/1/extensions/KHR_node_visibility/visible"), 4, 14, "STEP"));
        assert_read(reading);
        assert_int_equal(reading->scene->mesh_count, k ? 1 : 2);
        done(reading);
    }
}

static void animations_are_found_by_name_or_index(void **state) {
    (void)state;
    static const char both[] = "{'name':'walk','channels':[],'samplers':[]},{'name':'run','channels':[{'sampler':0,"
                               "'target':{'node':0,'path':'translation'}}],'samplers':[{'input':4,'output':5}]}";
    static const struct {
        const char *name;
        float x;
    } cases[] = {{NULL, 1}, {"walk", 1}, {"run", 11}, {"0", 1}, {"1", 11}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const WeftMoment moment = {.animation = cases[k].name, .time = 2};
        Reading *reading = read_moment(&moment, both);
        assert_read(reading);
        assert_near(first_corner(reading, 0)[3], cases[k].x, 1e-5f);
        done(reading);
    }
    assert_refused(read_moment(&(WeftMoment){.animation = "fly"}, both), WEFT_MESSAGE_GLTF_REFERENCE,
                   "animation \"fly\"; there are 0 walk, 1 run");
    assert_refused(read_moment(&(WeftMoment){.animation = "2"}, both), WEFT_MESSAGE_GLTF_REFERENCE, "animation \"2\"");
    assert_refused(read_moment(&(WeftMoment){.time = 1}, ""), WEFT_MESSAGE_GLTF_REFERENCE, "it has no animation");
}

static void wrong_animations_are_refused_or_named(void **state) {
    (void)state;
    const WeftMoment moment = {.time = 1.5};
    static const struct {
        const char *target;
        int input, output;
        WeftMessage message;
        const char *part;
    } refused[] = {
        {"'node':0,'path':'translation'", 13, 5, WEFT_MESSAGE_GLTF_SCHEMA, "the time of key 1 is not after"},
        {"'node':0,'path':'translation'", 5, 5, WEFT_MESSAGE_GLTF_SCHEMA, "accessor 5 is not of type SCALAR"},
        {"'node':0,'path':'translation'", 6, 5, WEFT_MESSAGE_GLTF_SCHEMA, "3 values for 2 keys"},
        {"'node':0,'path':'translation'", 4, 12, WEFT_MESSAGE_GLTF_SCHEMA,
         "nodes[0].translation: expected an array of 3"},
        {"'node':0,'path':'translation'", 99, 5, WEFT_MESSAGE_GLTF_REFERENCE, "animations[0].samplers[0].input: 99"},
        {"'node':9,'path':'translation'", 4, 5, WEFT_MESSAGE_GLTF_REFERENCE, "target.node: 9 of 3"},
        {POINTED("/nodes/0/children"), 4, 11, WEFT_MESSAGE_GLTF_SCHEMA, "children"},
    };
    for (size_t k = 0; k < sizeof refused / sizeof *refused; k++)
        assert_refused(read_moment(&moment, channel(refused[k].target, refused[k].input, refused[k].output, "LINEAR")),
                       refused[k].message, refused[k].part);
    static const char *const named[][2] = {
        {"'node':2,'path':'translation'", "node 2 has a matrix"},
        {"'path':'translation'", "it has no node"},
        {"'node':0,'path':'colour'", "\"colour\" is none of"},
        {POINTED("/asset/version"), "leads nowhere"},
        {POINTED("nodes"), "leads nowhere"},
        {POINTED("/materials/7/pbrMetallicRoughness/roughnessFactor"), "leads nowhere"},
        {POINTED("/nodes"), "leads nowhere"},
    };
    for (size_t k = 0; k < sizeof named / sizeof *named; k++) {
        Reading *reading = read_moment(&moment, channel(named[k][0], 4, 5, "LINEAR"));
        assert_read(reading);
        if (!strstr(reading->warning, named[k][1])) fail_msg("%s", reading->warning);
        done(reading);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nodes_move_by_every_interpolation),
        cmocka_unit_test(weights_move_morph_targets),
        cmocka_unit_test(pointers_move_materials_and_visibility),
        cmocka_unit_test(animations_are_found_by_name_or_index),
        cmocka_unit_test(wrong_animations_are_refused_or_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
