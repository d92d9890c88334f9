/* Meshes: modes, attributes, transforms, tangents, skins, morphs, limits. */
#include "reading.h"

#include <math.h>
#include <time.h>

#include "base/random.h"
#include "gltf/read/tangent.h"

/* A scene of the square under one node, whose members are node. */
static Reading *read_square(const char *node, const char *primitive) {
    return read_rest(SQUARE_DATA ",'meshes':[{'name':'square','primitives':[{%s}]}],'nodes':[{'mesh':0%s}]", SQUARE_URI,
                     primitive, node);
}

/* The normal of a triangle by its winding, not unit. */
static void winding(const Mesh *mesh, size_t triangle, float out[3]) {
    const uint32_t *v = mesh->index + 3 * triangle;
    float e[2][3];
    for (int k = 0; k < 2; k++)
        for (int c = 0; c < 3; c++)
            e[k][c] = mesh->position[3 * v[k + 1] + (uint32_t)c] - mesh->position[3 * v[0] + (uint32_t)c];
    for (int c = 0; c < 3; c++) out[c] = e[0][(c + 1) % 3] * e[1][(c + 2) % 3] - e[0][(c + 2) % 3] * e[1][(c + 1) % 3];
}

/* Every triangle winds as the normals of its vertices say. */
static void assert_consistent(const Mesh *mesh) {
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        float n[3];
        winding(mesh, t, n);
        for (int k = 0; k < 3; k++) {
            const float *v = mesh->normal + 3 * mesh->index[3 * t + (uint32_t)k];
            assert_true(n[0] * v[0] + n[1] * v[1] + n[2] * v[2] > 0.0f);
        }
    }
}

static void primitives_of_every_mode_become_triangles(void **state) {
    (void)state;
    static const struct {
        const char *indices;
        int mode;
        uint32_t triangles;
        uint32_t index[6];
    } cases[] = {
        {",'indices':3", 4, 2, {0, 1, 2, 2, 1, 3}},
        /* 0 1 2 2 1 3 as a strip: 012, then 122 and 221 without area, 213 turned to 231 */
        {",'indices':3", 5, 2, {0, 1, 2, 2, 3, 1}},
        {"", 4, 1, {0, 1, 2}},
        {"", 5, 2, {0, 1, 2, 1, 3, 2}},
        {"", 6, 2, {1, 2, 0, 2, 3, 0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *primitive = json("'attributes':{'POSITION':0},'mode':%d%s", cases[i].mode, cases[i].indices);
        Reading *reading = read_square("", primitive);
        assert_read(reading);
        const Mesh *mesh = reading->scene->meshes;
        assert_int_equal(mesh->triangle_count, cases[i].triangles);
        assert_memory_equal(mesh->index, cases[i].index, 12 * (size_t)cases[i].triangles);
        assert_null(mesh->normal);
        assert_string_equal(mesh->name, "square");
        free(primitive);
        done(reading);
    }
    for (int mode = 0; mode < 4; mode++) {
        char *primitive = json("'attributes':{'POSITION':0},'mode':%d", mode);
        Reading *reading = read_square("", primitive);
        assert_read(reading);
        assert_int_equal(reading->scene->mesh_count, 0);
        assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_IGNORED], 1);
        free(primitive);
        done(reading);
    }
    assert_refused(read_square("", "'attributes':{'POSITION':0},'mode':7"), WEFT_MESSAGE_GLTF_SCHEMA,
                   "meshes[0].primitives[0].mode");
}

static void malformed_attributes_are_refused(void **state) {
    (void)state;
    static const struct {
        const char *primitive;
        WeftMessage message;
        const char *part;
    } cases[] = {
        {"'mode':4", WEFT_MESSAGE_GLTF_SCHEMA, "attributes: missing"},
        {"'attributes':{'POSITION':9}", WEFT_MESSAGE_GLTF_REFERENCE, "attributes.POSITION: 9 of 4"},
        {"'attributes':{'POSITION':2}", WEFT_MESSAGE_GLTF_SCHEMA, "VEC3"},
        {"'attributes':{'POSITION':'0'}", WEFT_MESSAGE_GLTF_SCHEMA, "POSITION: expected an integer"},
        {"'attributes':{'POSITION':0,'TEXCOORD_0':1}", WEFT_MESSAGE_GLTF_SCHEMA, "VEC2"},
        {"'attributes':{'POSITION':0,'COLOR_0':2}", WEFT_MESSAGE_GLTF_SCHEMA, "COLOR_0"},
        {"'attributes':{'POSITION':0},'indices':0", WEFT_MESSAGE_GLTF_SCHEMA, "unsigned scalars"},
        {"'attributes':{'POSITION':0},'material':0", WEFT_MESSAGE_GLTF_REFERENCE, "material: 0 of 0"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_refused(read_square("", cases[i].primitive), cases[i].message, cases[i].part);
    /* An index beyond the vertices, and a position that is not finite. */
    struct Square bad = square;
    bad.index[4] = 4;
    assert_refused(read_rest(SQUARE_DATA ",'meshes':[{'primitives':[{" SQUARE_PRIMITIVE "}]}],'nodes':[{'mesh':0}]",
                             uri(&bad, sizeof bad)),
                   WEFT_MESSAGE_GLTF_BOUNDS, "meshes[0].primitives[0]: an index");
    bad = square;
    bad.position[5] = NAN;
    assert_refused(read_rest(SQUARE_DATA ",'meshes':[{'primitives':[{" SQUARE_PRIMITIVE "}]}],'nodes':[{'mesh':0}]",
                             uri(&bad, sizeof bad)),
                   WEFT_MESSAGE_GLTF_SCHEMA, "not finite");
    assert_refused(read_square(",'scale':[1e20,1,1]", SQUARE_PRIMITIVE), WEFT_MESSAGE_GLTF_TOO_LARGE, "too far away");
    assert_refused(read_square("},{'children':[2],'scale':[1e30,1,1]},{'scale':[1e30,1,1]", SQUARE_PRIMITIVE),
                   WEFT_MESSAGE_GLTF_TOO_LARGE, "nodes[2]: its transform");
    Reading *reading = read_square("", "'attributes':{'NORMAL':1}");
    assert_read(reading);
    assert_int_equal(reading->scene->mesh_count, 0);
    assert_non_null(strstr(reading->warning, "no positions"));
    done(reading);
}

static void matrix_and_translation_rotation_scale_agree(void **state) {
    (void)state;
    /* 0.6 = sin, 0.8 = cos of half the angle about x: the whole angle has cosine 0.28 and sine 0.96. */
    Reading *trs = read_square(",'translation':[1,2,3],'rotation':[0.6,0,0,0.8],'scale':[2,3,4]", SQUARE_PRIMITIVE);
    Reading *matrix = read_square(",'matrix':[2,0,0,0, 0,0.84,2.88,0, 0,-3.84,1.12,0, 1,2,3,1]", SQUARE_PRIMITIVE);
    assert_read(trs);
    assert_read(matrix);
    const Mesh *a = trs->scene->meshes, *b = matrix->scene->meshes;
    assert_all_near(a->position, b->position, 12, 1e-5f);
    assert_all_near(a->normal, b->normal, 12, 1e-6f);
    assert_all_near(a->position + 9, (const float[]){3.0f, 2.84f, 5.88f}, 3, 1e-5f);
    assert_all_near(a->normal, (const float[]){0.0f, -0.96f, 0.28f}, 3, 1e-6f);
    assert_consistent(a);
    done(trs);
    done(matrix);
    assert_refused(read_square(",'matrix':[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]", SQUARE_PRIMITIVE),
                   WEFT_MESSAGE_GLTF_SCHEMA, "nodes[0].matrix: its last row");
    assert_refused(read_square(",'matrix':[1,2,3]", SQUARE_PRIMITIVE), WEFT_MESSAGE_GLTF_SCHEMA,
                   "expected an array of 16");
}

static void mirrored_node_keeps_its_front(void **state) {
    (void)state;
    static const char *const nodes[] = {",'scale':[-1,1,1]", ",'scale':[1,1,-1]", ",'scale':[-2,-3,-1]",
                                        ",'scale':[-1,-1,1]", ",'scale':[1,1,1],'rotation':[0,0,0,0]"};
    for (size_t i = 0; i < sizeof nodes / sizeof *nodes; i++) {
        Reading *reading = read_square(nodes[i], SQUARE_PRIMITIVE);
        assert_read(reading);
        const Mesh *mesh = reading->scene->meshes;
        /* What was the front stays the front: the normal points where the scale takes +z. */
        float expected = strstr(nodes[i], ",-1]") ? -1.0f : 1.0f;
        for (int v = 0; v < 4; v++) assert_all_near(mesh->normal + 3 * v, (float[]){0, 0, expected}, 3, 1e-6f);
        assert_consistent(mesh);
        done(reading);
    }
}

static void flattened_nodes_keep_what_has_an_area(void **state) {
    (void)state;
    /* Flattened along the normal: what is left is still a surface, with a normal. */
    Reading *reading = read_square(",'scale':[1,1,0]", SQUARE_PRIMITIVE);
    assert_read(reading);
    assert_int_equal(reading->scene->mesh_count, 1);
    for (int i = 0; i < 4; i++) assert_near(fabsf(reading->scene->meshes[0].normal[3 * i + 2]), 1.0f, 1e-6f);
    done(reading);
    /* Flattened to a line or a point: nothing is left. */
    reading = read_square(",'scale':[0,1,1]", SQUARE_PRIMITIVE);
    assert_read(reading);
    assert_int_equal(reading->scene->mesh_count, 0);
    done(reading);
}

static void missing_or_zero_normals_are_repaired(void **state) {
    (void)state;
    struct Square bad = square;
    memset(bad.normal, 0, sizeof bad.normal);
    bad.normal[0] = INFINITY;
    bad.normal[5] = 7.0f; /* only not unit */
    Reading *reading = read_rest(SQUARE_DATA ",'meshes':[{'primitives':[{" SQUARE_PRIMITIVE "}]}],'nodes':[{'mesh':0}]",
                                 uri(&bad, sizeof bad));
    assert_read(reading);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_REPAIRED], 1);
    assert_all_near(reading->scene->meshes[0].normal, square.normal, 12, 1e-6f);
    done(reading);
}

static void vertex_colours_are_read(void **state) {
    (void)state;
    static const struct {
        int component, rows;
        unsigned char bytes[16];
        float first[4];
    } cases[] = {
        {5121, 3, {255, 51, 0}, {1.0f, 0.2f, 0.0f, 1.0f}},
        {5121, 4, {255, 51, 0, 102}, {1.0f, 0.2f, 0.0f, 0.4f}},
        {5123, 3, {0xff, 0xff, 0, 0, 0x33, 0x33}, {1.0f, 0.0f, 0.2f, 1.0f}},
        {5126, 3, {0, 0, 0x00, 0x3f, 0, 0, 0, 0xbf, 0, 0, 0, 0x40}, {0.5f, 0.0f, 1.0f, 1.0f}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        unsigned char bytes[64] = {0};
        memcpy(bytes, cases[i].bytes, 16);
        Reading *reading =
            read_rest("'buffers':[{'byteLength':64,'uri':'%s'}],'bufferViews':[{'buffer':0,'byteLength':64}],"
                      "'accessors':[{'componentType':5126,'count':3,'type':'VEC3','sparse':{'count':2,"
                      "'indices':{'bufferView':0,'byteOffset':32,'componentType':5121},'values':{'bufferView'"
                      ":0,'byteOffset':36}}},{'bufferView':0,'componentType':%d,'normalized':true,'count':3,"
                      "'type':'VEC%d'}],'meshes':[{'primitives':[{'attributes':{'POSITION':0,'COLOR_0':1}}]}],"
                      "'nodes':[{'mesh':0}]",
                      uri((memcpy(bytes + 32, (unsigned char[]){1, 2}, 2),
                           memcpy(bytes + 36, (float[]){1, 0, 0, 0, 1, 0}, 24), bytes),
                          sizeof bytes),
                      cases[i].component, cases[i].rows);
        assert_read(reading);
        assert_int_equal(reading->scene->mesh_count, 1);
        assert_all_near(reading->scene->meshes[0].color, cases[i].first, 4, 1e-6f);
        done(reading);
    }
}

/* KHR_mesh_quantization: positions of int8 with a node that undoes the scale, coordinates of uint16. */
static void quantized_attributes_are_read(void **state) {
    (void)state;
    static const int8_t bytes[] = {0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0, 0, 0, 0, 0, 127, 0, 127, 127, 0};
    Reading *reading =
        read_rest("'extensionsRequired':['KHR_mesh_quantization'],'buffers':[{'byteLength':20,'uri':'%s'}],"
                  "'bufferViews':[{'buffer':0,'byteLength':12,'byteStride':4},{'buffer':0,'byteOffset':12,"
                  "'byteLength':8}],'accessors':[{'bufferView':0,'componentType':5120,'count':3,'type':'VEC3'},"
                  "{'bufferView':1,'componentType':5120,'normalized':true,'count':3,'type':'VEC2'}],"
                  "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':1}}]}],"
                  "'nodes':[{'mesh':0,'scale':[0.01,0.01,0.01]}]",
                  uri(bytes, sizeof bytes));
    assert_read(reading);
    const Mesh *mesh = reading->scene->meshes;
    assert_all_near(mesh->position, (const float[]){0, 0, 0, 1, 0, 0, 0, 1, 0}, 9, 1e-6f);
    assert_all_near(mesh->texcoord[0], (const float[]){0, 0, 0, 1, 0, 1}, 6, 1e-6f);
    done(reading);
}

/* --- sets of texture coordinates --- */

/* The square's coordinates under a name, and the set of the mesh that they become; -1: none. */
static void materials_read_any_two_sets(void **state) {
    (void)state;
    static const struct {
        const char *materials; /* of the primitive; then that of its variant */
        int named, becomes;
        const char *warning;
    } cases[] = {
        {"{'occlusionTexture':{'index':0}},{}", 0, 0, NULL},
        {"{'occlusionTexture':{'index':0,'texCoord':1}},{}", 1, 1, NULL},
        {"{'occlusionTexture':{'index':0,'texCoord':2}},{}", 2, 1, NULL},
        {"{'occlusionTexture':{'index':0,'texCoord':2}},{}", 0, 0, NULL},
        {"{'occlusionTexture':{'index':0,'texCoord':2},'emissiveTexture':{'index':0,'texCoord':7}},{}", 7, 0, NULL},
        {"{'occlusionTexture':{'index':0,'extensions':{'KHR_texture_transform':{'texCoord':3}}}},{}", 3, 1, NULL},
        {"{'extras':{'weft':{'back':{'occlusionTexture':{'index':0,'texCoord':3}}}}},{}", 3, 1, NULL},
        {"{'normalTexture':{'index':0},'occlusionTexture':{'index':0,'texCoord':1},"
         "'emissiveTexture':{'index':0,'texCoord':2}},{}",
         2, -1, "materials[0].emissiveTexture: TEXCOORD_2, but the material reads TEXCOORD_0 and 1 already"},
        {"{'occlusionTexture':{'index':0}},{'occlusionTexture':{'index':0,'texCoord':4}}", 4, 1, NULL},
        {"{'occlusionTexture':{'index':0,'texCoord':2}},{'occlusionTexture':{'index':0,'texCoord':4}}", 4, -1,
         "attributes: materials of its variants need more sets"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Reading *reading = read_rest(
            SQUARE_DATA
            ",'textures':[{}],'materials':[%s],'extensions':{'KHR_materials_variants':{'variants':[{'name':'a'}]}},"
            "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_%d':2},'indices':3,"
            "'material':0,'extensions':{'KHR_materials_variants':{'mappings':[{'material':1,'variants':[0]}]}}}]}],"
            "'nodes':[{'mesh':0}]",
            uri(&square, sizeof square), cases[k].materials, cases[k].named);
        assert_read(reading);
        if (cases[k].warning) assert_non_null(strstr(reading->warning, cases[k].warning));
        for (int set = 0; set < 2; set++) {
            const float *uv = reading->scene->meshes[0].texcoord[set];
            if (set != cases[k].becomes)
                assert_null(uv);
            else
                assert_all_near(uv, square.texcoord, 8, 0.0f);
        }
        done(reading);
    }
    /* what no material reads is checked all the same */
    assert_refused(read_rest(SQUARE_DATA ",'textures':[{}],'materials':[{'occlusionTexture':{'index':0,'texCoord':2}}],"
                                         "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_1':0},"
                                         "'indices':3,'material':0}]}],'nodes':[{'mesh':0}]",
                             uri(&square, sizeof square)),
                   WEFT_MESSAGE_GLTF_SCHEMA, "TEXCOORD_1: accessor 0 is not of type VEC2");
}

/* --- tangents --- */

/* Needs tangents, by a texture whose image is never asked for: it has no source. */
#define MAPPED ",'textures':[{}],'materials':[{'normalTexture':{'index':0%s}}]"

static Reading *read_mapped(const struct Square *data, const char *attributes, const char *transform) {
    return read_rest(SQUARE_DATA MAPPED ",'meshes':[{'primitives':[{'attributes':{%s},'indices':3,"
                                        "'material':0}]}],'nodes':[{'mesh':0}]",
                     uri(data, sizeof *data), transform, attributes);
}

static void assert_tangents(const Mesh *mesh, float x, float y, float w) {
    assert_non_null(mesh->tangent);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        assert_all_near(mesh->tangent + 4 * v, (const float[]){x, y, 0.0f, w}, 4, 1e-5f);
}

static const char with_normals[] = "'POSITION':0,'NORMAL':1,'TEXCOORD_0':2";

static void missing_tangents_are_made(void **state) {
    (void)state;
    /* An upright image: u to the right, v down, so that the bitangent cross(n, t) is up. */
    Reading *reading = read_mapped(&square, with_normals, "");
    assert_read(reading);
    assert_int_equal(reading->scene->meshes[0].vertex_count, 4);
    assert_tangents(reading->scene->meshes, 1.0f, 0.0f, 1.0f);
    done(reading);
    /* Without normals the faces' are used, on vertices of their own. */
    reading = read_mapped(&square, "'POSITION':0,'TEXCOORD_0':2", "");
    assert_read(reading);
    assert_int_equal(reading->scene->meshes[0].vertex_count, 6);
    assert_tangents(reading->scene->meshes, 1.0f, 0.0f, 1.0f);
    for (int v = 0; v < 6; v++) assert_all_near(reading->scene->meshes[0].normal + 3 * v, square.normal, 3, 1e-6f);
    done(reading);
    /* A transform of the map turns the frame: here the image lies mirrored, then turned by a quarter. */
    reading = read_mapped(&square, with_normals, ",'extensions':{'KHR_texture_transform':{'scale':[-1,1]}}");
    assert_read(reading);
    assert_tangents(reading->scene->meshes, -1.0f, 0.0f, -1.0f);
    done(reading);
    reading =
        read_mapped(&square, with_normals, ",'extensions':{'KHR_texture_transform':{'rotation':1.5707963267948966}}");
    assert_read(reading);
    assert_tangents(reading->scene->meshes, 0.0f, -1.0f, 1.0f);
    done(reading);
    /* No coordinates, or none needed: no tangents. */
    reading = read_mapped(&square, "'POSITION':0,'NORMAL':1", "");
    assert_read(reading);
    assert_null(reading->scene->meshes[0].tangent);
    done(reading);
    reading = read_square("", SQUARE_PRIMITIVE);
    assert_read(reading);
    assert_null(reading->scene->meshes[0].tangent);
    done(reading);
}

/* Two halves with mirrored coordinates share the edge 1-2: its vertices must part. */
static void vertices_shared_by_mirrored_maps_are_split(void **state) {
    (void)state;
    struct Square mirrored = square;
    memcpy(mirrored.texcoord + 6, square.texcoord, 2 * sizeof(float)); /* vertex 3 as vertex 0 */
    Reading *reading = read_mapped(&mirrored, with_normals, "");
    assert_read(reading);
    const Mesh *mesh = reading->scene->meshes;
    assert_int_equal(mesh->vertex_count, 6);
    for (uint32_t t = 0; t < 2; t++)
        for (uint32_t k = 0; k < 3; k++)
            assert_near(mesh->tangent[4 * mesh->index[3 * t + k] + 3], t ? -1.0f : 1.0f, 0.0f);
    for (uint32_t v = 4; v < 6; v++) { /* copies stand where their originals do */
        uint32_t original = mesh->index[3] == v ? 2 : 1;
        assert_memory_equal(mesh->position + 3 * v, mesh->position + 3 * original, 12);
        assert_memory_equal(mesh->texcoord[0] + 2 * v, mesh->texcoord[0] + 2 * original, 8);
    }
    done(reading);
}

/* Coordinates that are all one point: some tangent across the normal, never NaN. */
static void degenerate_texture_coordinates_give_finite_tangents(void **state) {
    (void)state;
    struct Square flat = square;
    memset(flat.texcoord, 0, sizeof flat.texcoord);
    flat.texcoord[1] = NAN;
    Reading *reading = read_mapped(&flat, with_normals, "");
    assert_read(reading);
    assert_null(reading->scene->meshes->tangent); /* of one point of the map: as without */
    done(reading);
    flat.texcoord[2] = 0.5f;
    reading = read_mapped(&flat, with_normals, "");
    assert_read(reading);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_REPAIRED], 1);
    const Mesh *mesh = reading->scene->meshes;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float *t = mesh->tangent + 4 * v;
        assert_near(t[0] * t[0] + t[1] * t[1], 1.0f, 1e-5f);
        assert_near(t[2], 0.0f, 1e-6f);
    }
    done(reading);
}

/* The file's own tangents: kept, made unit and square to the normals, turned around by a mirroring node. */
static void tangents_of_the_file_are_kept(void **state) {
    (void)state;
    static const float tangents[16] = {2, 0, 0.5f, 1, 0, 3, 0, -1, 0, 0, 1, 1, 0, 0, 0, -1};
    static const char form[] =
        "'buffers':[{'byteLength':140,'uri':'%s'},{'byteLength':64,'uri':'%s'}],'bufferViews':[{'buffer':0,"
        "'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':48},{'buffer':1,'byteLength':64}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},{'bufferView':1,"
        "'componentType':5126,'count':4,'type':'VEC3'},{'bufferView':2,'componentType':5126,'count':4,"
        "'type':'VEC4'}],'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1,'TANGENT':2},"
        "'mode':5}]}],'nodes':[{'mesh':0,'scale':[%d,1,1]}]";
    for (int x = -1; x <= 1; x += 2) {
        Reading *reading = read_rest(form, SQUARE_URI, uri(tangents, sizeof tangents), x);
        assert_read(reading);
        const float *t = reading->scene->meshes[0].tangent, sign = (float)x;
        assert_all_near(t, (const float[]){sign, 0, 0, sign}, 4, 1e-6f);
        assert_all_near(t + 4, (const float[]){0, 1, 0, -sign}, 4, 1e-6f);
        for (int v = 2; v < 4; v++) { /* along the normal, and nothing: some direction across */
            assert_near(t[4 * v] * t[4 * v] + t[4 * v + 1] * t[4 * v + 1], 1.0f, 1e-6f);
            assert_near(t[4 * v + 2], 0.0f, 1e-6f);
        }
        done(reading);
    }
}

/* --- rest pose --- */

static void skinned_vertices_are_posed_at_rest(void **state) {
    (void)state;
    /* Vertex 0 follows joint 0, vertex 1 joint 1, vertex 2 both, vertex 3 neither (joint 0 then). */
    static const struct {
        uint8_t joints[16];
        float weights[16], inverse[32];
    } bytes = {{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0},
               {1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 0, 0, 0, 0},
               {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    static const char form[] =
        "'buffers':[{'byteLength':140,'uri':'%s'},{'byteLength':208,'uri':'%s'}],"
        "'bufferViews':[{'buffer':0,'byteLength':48},{'buffer':1,'byteLength':16},"
        "{'buffer':1,'byteOffset':16,'byteLength':64},{'buffer':1,'byteOffset':80,'byteLength':128}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"
        "{'bufferView':1,'componentType':5121,'count':4,'type':'VEC4'},"
        "{'bufferView':2,'componentType':5126,'count':4,'type':'VEC4'},"
        "{'bufferView':3,'componentType':5126,'count':2,'type':'MAT4'}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'JOINTS_0':1,'WEIGHTS_0':2},'mode':5}]}],"
        "'skins':[{'joints':[%s],'inverseBindMatrices':3}],"
        "'nodes':[{'mesh':0,'skin':0,'translation':[9,9,9]},{'translation':[1,0,0],'children':[2]},"
        "{'translation':[0,0,2]}]";
    Reading *reading = read_rest(form, SQUARE_URI, uri(&bytes, sizeof bytes), "1,2");
    assert_read(reading);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_REST_POSE], 1);
    /* Joint 0: +1 - 1 = 0. Joint 1: (1, 0, 2). The node's own (9, 9, 9) does not count. */
    assert_all_near(reading->scene->meshes[0].position, (const float[]){0, 0, 0, 2, 0, 2, 0.5f, 1, 1, 1, 1, 0}, 12,
                    1e-6f);
    done(reading);
    assert_refused(read_rest(form, SQUARE_URI, uri(&bytes, sizeof bytes), "1"), WEFT_MESSAGE_GLTF_BOUNDS,
                   "joint 1 of 1");
    assert_refused(read_rest(form, SQUARE_URI, uri(&bytes, sizeof bytes), "1,2,0"), WEFT_MESSAGE_GLTF_SCHEMA, "MAT4");
    assert_refused(read_rest(form, SQUARE_URI, uri(&bytes, sizeof bytes), "1,7"), WEFT_MESSAGE_GLTF_REFERENCE,
                   "skins[0].joints[1]");
}

static void morph_targets_are_applied_at_rest(void **state) {
    (void)state;
    static const char form[] = SQUARE_DATA ",'meshes':[{'weights':[0.5,3],'primitives':[{'attributes':"
                                           "{'POSITION':0,'NORMAL':1},'indices':3,'targets':[{'POSITION':1},"
                                           "{'NORMAL':0}]}]}],'nodes':[{'mesh':0%s}]";
    Reading *reading = read_rest(form, SQUARE_URI, ",'weights':[2]");
    assert_read(reading);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_REST_POSE], 1);
    assert_near(reading->scene->meshes[0].position[2], 2.0f, 1e-6f);
    assert_near(reading->scene->meshes[0].normal[11], 1.0f, 1e-6f);
    done(reading);
    reading = read_rest(form, SQUARE_URI, "");
    assert_read(reading);
    assert_near(reading->scene->meshes[0].position[2], 0.5f, 1e-6f);
    assert_near(reading->scene->meshes[0].normal[9], 3.0f / sqrtf(19.0f), 1e-6f);
    done(reading);
}

/* --- limits --- */

/* Triangles of the last three vertices only: the first is not in the scene, and all attributes move along. */
static void unused_vertices_are_dropped(void **state) {
    (void)state;
    struct Square part = square;
    memcpy(part.index, (const uint16_t[6]){3, 2, 1, 1, 3, 2}, 12);
    part.position[0] = -900.0f;
    Reading *reading = read_rest(SQUARE_DATA ",'meshes':[{'primitives':[{" SQUARE_PRIMITIVE "}]}],'nodes':[{'mesh':0}]",
                                 uri(&part, sizeof part));
    assert_read(reading);
    const Mesh *mesh = reading->scene->meshes;
    assert_int_equal(mesh->vertex_count, 3);
    assert_memory_equal(mesh->index, ((const uint32_t[]){2, 1, 0, 0, 2, 1}), 24);
    assert_memory_equal(mesh->position, square.position + 3, 36);
    assert_memory_equal(mesh->normal, square.normal + 3, 36);
    assert_memory_equal(mesh->texcoord[0], square.texcoord + 2, 24);
    done(reading);
}

/* The inverse of an odd number modulo 2^32, by Newton's iteration. */
static uint32_t inverse(uint32_t a) {
    uint32_t x = a;
    for (int i = 0; i < 5; i++) x *= 2 - a * x;
    return x;
}

/* Vertices whose v is chosen so that the hash of each vertex is the same: welding must not become quadratic.
 */
static void vertices_of_equal_hash_are_welded_in_linear_time(void **state) {
    (void)state;
    enum { COUNT = 90000 };
    WeftScene scene = {0};
    Asset asset = {.limit = (size_t)1 << 30, .scene = &scene};
    Mesh mesh = {.vertex_count = COUNT, .triangle_count = COUNT / 3};
    mesh.position = calloc(COUNT, 3 * sizeof(float));
    mesh.normal = calloc(COUNT, 3 * sizeof(float));
    mesh.texcoord[0] = calloc(COUNT, 2 * sizeof(float));
    mesh.index = calloc(COUNT, sizeof *mesh.index);
    for (uint32_t i = 0, n = 0; i < COUNT; n++) {
        uint32_t key[7] = {0}, hash = 0;
        float x = (float)n;
        memcpy(key, &x, 4);
        key[5] = 0x3f800000; /* normal +z */
        for (int k = 0; k < 7; k++) hash = hash_combine(hash, key[k]);
        uint32_t v = (hash - 0x85ebca6bu) * inverse(0x9e3779b9u);
        float value;
        memcpy(&value, &v, 4);
        if (!(fabsf(value) <= 1e9f) || value == 0.0f) continue;
        mesh.position[3 * (size_t)i] = x;
        mesh.normal[3 * (size_t)i + 2] = 1.0f;
        mesh.texcoord[0][2 * (size_t)i + 1] = value;
        mesh.index[i] = i;
        i++;
    }
    float *owned[] = {mesh.position, mesh.normal, mesh.texcoord[0]};
    const Input input = {.transform = {1, 0, 0, 0, 1, 0}};
    clock_t start = clock();
    tangents_make(&asset, &mesh, &input);
    assert_true(clock() - start < 3 * CLOCKS_PER_SEC);
    assert_int_equal(asset.result, WEFT_OK);
    assert_non_null(mesh.tangent);
    for (int k = 0; k < 3; k++) free(owned[k]);
    free(mesh.index);
    arena_free(&scene.arena);
}

/* Nodes times primitives beyond the limit: refused before anybody walks them all. */
static void surfaces_beyond_the_limit_are_refused(void **state) {
    (void)state;
    enum { COUNT = 100000 };
    char *text = malloc((size_t)COUNT * 32);
    int used = sprintf(text, "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{\"primitives\":[");
    for (int i = 0; i < COUNT; i++) used += sprintf(text + used, "%s{\"attributes\":{}}", i ? "," : "");
    used += sprintf(text + used, "]}],\"nodes\":[");
    for (int i = 0; i < COUNT; i++) used += sprintf(text + used, "%s{\"mesh\":0}", i ? "," : "");
    used += sprintf(text + used, "]}");
    clock_t start = clock();
    assert_refused(read_gltf("many", text, (size_t)used), WEFT_MESSAGE_GLTF_TOO_LARGE, "decode to more");
    assert_true(clock() - start < 4 * CLOCKS_PER_SEC);
    free(text);
}

static void accessors_without_data_beyond_the_limit_are_refused(void **state) {
    (void)state;
    assert_refused(read_rest("'accessors':[{'componentType':5126,'count':400000000,'type':'VEC3'}],"
                             "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],'nodes':[{'mesh':0}]"),
                   WEFT_MESSAGE_GLTF_TOO_LARGE, "decode to more");
}

/* 64 nodes that each show the same large mesh: the tree multiplies what the file holds. */
static void instances_beyond_the_limit_of_memory_are_refused(void **state) {
    (void)state;
    char nodes[2048];
    int used = snprintf(nodes, sizeof nodes, "{'mesh':0}");
    for (int i = 1; i < 64; i++) used += snprintf(nodes + used, sizeof nodes - (size_t)used, ",{'mesh':0}");
    assert_refused(read_rest("'accessors':[{'componentType':5126,'count':600000,'type':'VEC3'}],"
                             "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],'nodes':[%s]",
                             nodes),
                   WEFT_MESSAGE_GLTF_TOO_LARGE, "decode to more");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(primitives_of_every_mode_become_triangles),
        cmocka_unit_test(malformed_attributes_are_refused),
        cmocka_unit_test(matrix_and_translation_rotation_scale_agree),
        cmocka_unit_test(mirrored_node_keeps_its_front),
        cmocka_unit_test(flattened_nodes_keep_what_has_an_area),
        cmocka_unit_test(missing_or_zero_normals_are_repaired),
        cmocka_unit_test(vertex_colours_are_read),
        cmocka_unit_test(quantized_attributes_are_read),
        cmocka_unit_test(materials_read_any_two_sets),
        cmocka_unit_test(missing_tangents_are_made),
        cmocka_unit_test(vertices_shared_by_mirrored_maps_are_split),
        cmocka_unit_test(degenerate_texture_coordinates_give_finite_tangents),
        cmocka_unit_test(tangents_of_the_file_are_kept),
        cmocka_unit_test(skinned_vertices_are_posed_at_rest),
        cmocka_unit_test(morph_targets_are_applied_at_rest),
        cmocka_unit_test(accessors_without_data_beyond_the_limit_are_refused),
        cmocka_unit_test(instances_beyond_the_limit_of_memory_are_refused),
        cmocka_unit_test(unused_vertices_are_dropped),
        cmocka_unit_test(vertices_of_equal_hash_are_welded_in_linear_time),
        cmocka_unit_test(surfaces_beyond_the_limit_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
