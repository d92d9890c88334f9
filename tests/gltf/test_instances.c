/* EXT_mesh_gpu_instancing: places of every type; and KHR_node_visibility. Wrong and hostile ones. */
#include "reading.h"

#include <math.h>

/* Three places: translations and scales as floats, then rotations about z of 0, 90 and 180 degrees as integers. */
static const struct Places {
    float translation[9], scale[9];
    int16_t word[12];
    int8_t byte[12];
    float whole[12];
} places = {{0, 0, 0, 10, 0, 0, 0, 20, 0},
            {1, 1, 1, 2, 2, 2, -1, 1, 1},
            {0, 0, 0, 32767, 0, 0, 23170, 23170, 0, 0, 32767, 0},
            {0, 0, 0, 127, 0, 0, 90, 90, 0, 0, 127, 0},
            {0, 0, 0, 2, 0, 0, 3, 3, 0, 0, -7, 0}};

/* The square under a node that is moved by z = 5 and has the square's mesh at these places; 5 onwards are the places. */
static Reading *read_places(const char *attributes, const char *more) {
    return read_rest("'extensionsRequired':['EXT_mesh_gpu_instancing'],"
                     "'buffers':[{'byteLength':140,'uri':'%s'},{'byteLength':%zu,'uri':'%s'}],"
                     "'bufferViews':[{'buffer':0,'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':48},"
                     "{'buffer':0,'byteOffset':96,'byteLength':32},{'buffer':0,'byteOffset':128,'byteLength':12},"
                     "{'buffer':1,'byteLength':%zu}],"
                     "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"
                     "{'bufferView':1,'componentType':5126,'count':4,'type':'VEC3'},"
                     "{'bufferView':2,'componentType':5126,'count':4,'type':'VEC2'},"
                     "{'bufferView':3,'componentType':5123,'count':6,'type':'SCALAR'},"
                     "{'bufferView':4,'componentType':5126,'count':3,'type':'VEC3'},"
                     "{'bufferView':4,'byteOffset':36,'componentType':5126,'count':3,'type':'VEC3'},"
                     "{'bufferView':4,'byteOffset':72,'componentType':5122,'normalized':true,'count':3,'type':'VEC4'},"
                     "{'bufferView':4,'byteOffset':96,'componentType':5120,'normalized':true,'count':3,'type':'VEC4'},"
                     "{'bufferView':4,'byteOffset':108,'componentType':5126,'count':3,'type':'VEC4'},"
                     "{'componentType':5126,'count':4000000000,'type':'VEC3'},"
                     "{'componentType':5126,'count':2,'type':'VEC3'}],"
                     "'meshes':[{'primitives':[{" SQUARE_PRIMITIVE "}]}],'nodes':[{'mesh':0,'translation':[0,0,5],"
                     "'extensions':{'EXT_mesh_gpu_instancing':{'attributes':%s}}}%s]",
                     SQUARE_URI, sizeof places, uri(&places, sizeof places), sizeof places, attributes, more);
}

/* The corner (1, 0, 0) of the square comes after the origin. */
static void assert_corner(const Reading *reading, int mesh, float x, float y, float z) {
    const Mesh *m = &reading->scene->meshes[mesh];
    bool found = false;
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        const float *p = m->position + 3 * v;
        found = found || (fabsf(p[0] - x) < 0.01f && fabsf(p[1] - y) < 0.01f && fabsf(p[2] - z) < 0.01f);
    }
    if (!found) fail_msg("mesh %d has no corner at %g %g %g", mesh, (double)x, (double)y, (double)z);
    assert_int_equal(m->triangle_count, 2);
}

static void instances_of_every_type_are_placed(void **state) {
    (void)state;
    static const int rotations[] = {6, 7, 8};
    for (size_t k = 0; k < 3; k++) {
        char attributes[160];
        snprintf(attributes, sizeof attributes, "{'TRANSLATION':4,'SCALE':5,'ROTATION':%d,'_ID':3}", rotations[k]);
        Reading *reading = read_places(attributes, "");
        assert_read(reading);
        assert_string_equal(reading->warning, "");
        assert_int_equal(reading->scene->mesh_count, 3);
        assert_corner(reading, 0, 1, 0, 5);
        assert_corner(reading, 1, 10, 2, 5); /* a quarter turn of twice the size */
        assert_corner(reading, 1, 8, 0, 5);
        assert_corner(reading, 2, 1, 20, 5); /* half a turn of a mirrored one */
        assert_corner(reading, 2, 0, 19, 5);
        done(reading);
    }
    Reading *reading = read_places("{'TRANSLATION':4}", ",{'mesh':0}");
    assert_read(reading);
    assert_int_equal(reading->scene->mesh_count, 4);
    assert_corner(reading, 1, 11, 0, 5);
    assert_corner(reading, 3, 1, 0, 0);
    done(reading);
}

static void wrong_instances_are_refused(void **state) {
    (void)state;
    assert_refused(
        read_places("{'TRANSLATION':6}", ""), WEFT_MESSAGE_GLTF_SCHEMA,
        "nodes[0].extensions.EXT_mesh_gpu_instancing.attributes.TRANSLATION: accessor 6 is not of type VEC3");
    assert_refused(read_places("{'ROTATION':4}", ""), WEFT_MESSAGE_GLTF_SCHEMA, "accessor 4 is not of type VEC4");
    assert_refused(read_places("{'TRANSLATION':4,'SCALE':10}", ""), WEFT_MESSAGE_GLTF_SCHEMA, "instances");
    assert_refused(read_places("{'SCALE':77}", ""), WEFT_MESSAGE_GLTF_REFERENCE, "77 of 11");
    assert_refused(read_places("{}", ""), WEFT_MESSAGE_GLTF_SCHEMA, "expected an object of TRANSLATION");
    assert_refused(read_places("7", ""), WEFT_MESSAGE_GLTF_SCHEMA, "attributes");
    Reading *reading = read_places("{'TRANSLATION':4,'COLOUR':4}", "");
    assert_read(reading);
    assert_non_null(strstr(reading->warning, "COLOUR: this attribute is not read"));
    done(reading);
}

/* Four thousand million places of nothing, from a file of a kilobyte. */
static void too_many_instances_are_refused_before_memory_is_taken(void **state) {
    (void)state;
    assert_refused(read_places("{'TRANSLATION':9}", ""), WEFT_MESSAGE_GLTF_TOO_LARGE, "decode to more than");
}

static void hidden_nodes_and_what_is_below_them_are_not_shown(void **state) {
    (void)state;
    static const char form[] =
        SQUARE_DATA ",'extensionsUsed':['KHR_node_visibility','KHR_lights_punctual'],'extensions':{"
                    "'KHR_lights_punctual':{'lights':[{'type':'point'}]}},'meshes':[{'primitives':[{" SQUARE_PRIMITIVE
                    "}]}],'nodes':[{'mesh':0,'children':[1,2],'extensions':{'KHR_node_visibility':{%s}}},"
                    "{'mesh':0,'extensions':{'KHR_node_visibility':{'visible':true}}},"
                    "{'extensions':{'KHR_lights_punctual':{'light':0}}},{'mesh':0}]";
    static const char *const visible[] = {"", "'visible':true", "'visible':false"};
    for (int k = 0; k < 3; k++) {
        Reading *reading = read_rest(form, SQUARE_URI, visible[k]);
        assert_read(reading);
        assert_string_equal(reading->warning, "");
        assert_int_equal(reading->scene->mesh_count, k == 2 ? 1 : 3);
        assert_int_equal(reading->scene->light_count, k == 2 ? 0 : 1);
        done(reading);
    }
    assert_refused(read_rest(form, SQUARE_URI, "'visible':0"), WEFT_MESSAGE_GLTF_SCHEMA, "true or false");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(instances_of_every_type_are_placed),
        cmocka_unit_test(wrong_instances_are_refused),
        cmocka_unit_test(too_many_instances_are_refused_before_memory_is_taken),
        cmocka_unit_test(hidden_nodes_and_what_is_below_them_are_not_shown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
