/* A glTF file written again: what was edited is edited, and all else is what it was. */
#include "gltf/save/rewrite.h"

#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "reading.h"
#include "scratch.h"

static void write_bytes(const char *path, const void *bytes, size_t size) {
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
}

static FileBytes bytes_of(const char *path) {
    FileBytes bytes;
    WeftError error;
    if (file_read(path, 1 << 20, &bytes, &error) != WEFT_OK) fail_msg("%s", error.text);
    return bytes;
}

static void assert_same_files(const char *a, const char *b) {
    FileBytes x = bytes_of(a), y = bytes_of(b);
    assert_int_equal(x.size, y.size);
    assert_memory_equal(x.data, y.data, x.size);
    free(x.data);
    free(y.data);
}

/* Opens path, lets edit (may be NULL) change it, and saves it. */
static WeftResult rewrite(const char *path, void (*edit)(Rewrite *), const char *out, WeftError *error) {
    Asset asset = {.error = error};
    Rewrite rewrite;
    gltf_open(&asset, path, NULL, 0);
    if (asset.result != WEFT_OK) fail_msg("%s", error->text);
    assert_int_equal(rewrite_begin(&rewrite, &asset, error), WEFT_OK);
    if (edit) edit(&rewrite);
    WeftResult result = rewrite_save(&rewrite, out, error);
    rewrite_end(&rewrite);
    gltf_close(&asset);
    return result;
}

static void assert_rewritten(const char *path, void (*edit)(Rewrite *), const char *out) {
    WeftError error;
    if (rewrite(path, edit, out, &error) != WEFT_OK) fail_msg("%s", error.text);
    Reading *reading = read_gltf(out, NULL, 0);
    assert_read(reading);
    done(reading);
}

/* A 2 x 1 grey PNG. */
static const unsigned char png[] = {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
                                    0x44, 0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00,
                                    0x00, 0xd1, 0x49, 0x20, 0x56, 0x00, 0x00, 0x00, 0x0b, 0x49, 0x44, 0x41, 0x54, 0x78,
                                    0x9c, 0x63, 0x60, 0xf8, 0x0f, 0x00, 0x01, 0x02, 0x01, 0x00, 0x42, 0xbe, 0xbc, 0x68,
                                    0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

/* "square.gltf" with positions in one file and indices in another, a picture, and parts that weft has no use
 * for: an animation, an extension of somebody's that names a file, numbers in odd spellings. */
static void make_square(void) {
    mkdir("in", 0777);
    mkdir("in/pictures of", 0777);
    write_bytes("in/positions.bin", square.position, sizeof square.position);
    write_bytes("in/indices.bin", square.index, sizeof square.index);
    write_bytes("in/pictures of/a.png", png, sizeof png);
    write_bytes("in/sound.ogg", "ping", 4);
    char *text = json("{'asset' : {'version':'2.0'},\n 'extensionsUsed':['KHR_materials_sheen','SOME_sound'],\n"
                      " 'extensions':{'SOME_sound':{'uri':'sound.ogg','gain':1.50E0}},\n"
                      " 'buffers':[{'byteLength':48,'uri':'positions.bin'},{'byteLength':12,'uri':'indices.bin'}],\n"
                      " 'bufferViews':[{'buffer':0,'byteLength':48},{'buffer':1,'byteLength':12}],\n"
                      " 'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3','min':[0,0,0],"
                      "'max':[1.0,1.00,0]},{'bufferView':1,'componentType':5123,'count':6,'type':'SCALAR'}],\n"
                      " 'images':[{'uri':'pictures%%20of/a.png'}],'textures':[{'source':0}],\n"
                      " 'materials':[{'name':'cloth','pbrMetallicRoughness':{'baseColorTexture':{'index':0}},"
                      "'extensions':{'KHR_materials_sheen':{'sheenColorFactor':[1, 1, 0.250]}}}],\n"
                      " 'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1,'material':0}]}],\n"
                      " 'animations':[{'name':'none of weft'}], 'nodes':[{'mesh':0}],'scenes':[{'nodes':[0]}]}\n");
    write_bytes("in/square.gltf", text, strlen(text));
    free(text);
}

static json_t *sheen_of(const Rewrite *rewrite) {
    json_t *material = json_array_get(json_object_get(rewrite->root, "materials"), 0);
    return json_object_get(json_object_get(material, "extensions"), "KHR_materials_sheen");
}

static void roughen(Rewrite *rewrite) {
    json_object_set_new(sheen_of(rewrite), "sheenRoughnessFactor", json_real(0.3));
}

static void rewritten_asset_differs_by_the_added_number_alone(void **state) {
    (void)state;
    make_square();
    assert_rewritten("in/square.gltf", NULL, "in/same.gltf");
    assert_same_files("in/square.gltf", "in/same.gltf");
    assert_rewritten("in/square.gltf", roughen, "in/more.gltf");
    FileBytes was = bytes_of("in/square.gltf"), now = bytes_of("in/more.gltf");
    static const char added[] = ",\"sheenRoughnessFactor\": 0.3";
    char *place = strstr((char *)now.data, added);
    assert_non_null(place);
    memmove(place, place + strlen(added), strlen(place + strlen(added)) + 1);
    assert_string_equal(was.data, now.data);
    free(was.data);
    free(now.data);
}

static void files_of_the_asset_are_copied(void **state) {
    (void)state;
    make_square();
    mkdir("out", 0777);
    assert_rewritten("in/square.gltf", roughen, "out/square.gltf");
    assert_same_files("in/positions.bin", "out/positions.bin");
    assert_same_files("in/indices.bin", "out/indices.bin");
    assert_same_files("in/pictures of/a.png", "out/pictures of/a.png");
    assert_same_files("in/sound.ogg", "out/sound.ogg");
    assert_rewritten("in/square.gltf", roughen, "out/square.gltf"); /* once more, over itself */

    write_bytes("out/indices.bin", "another thing", 13);
    WeftError error;
    assert_int_equal(rewrite("in/square.gltf", NULL, "out/square.gltf", &error), WEFT_RESOURCES);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_WRITE);
    assert_non_null(strstr(error.text, "out/indices.bin"));
    FileBytes kept = bytes_of("out/indices.bin");
    assert_string_equal(kept.data, "another thing");
    free(kept.data);
}

static Reading *same_scene(const char *path, const char *other) {
    Reading *a = read_gltf(path, NULL, 0), *b = read_gltf(other, NULL, 0);
    assert_read(a);
    assert_read(b);
    assert_int_equal(a->scene->mesh_count, b->scene->mesh_count);
    assert_int_equal(a->scene->image_count, b->scene->image_count);
    for (int m = 0; m < a->scene->mesh_count; m++) {
        const Mesh *x = &a->scene->meshes[m], *y = &b->scene->meshes[m];
        assert_int_equal(x->triangle_count, y->triangle_count);
        assert_memory_equal(x->position, y->position, x->vertex_count * 3 * sizeof(float));
        assert_memory_equal(x->index, y->index, x->triangle_count * 3 * sizeof(uint32_t));
    }
    done(a);
    return b;
}

static void gltf_to_glb_and_back_is_the_same_scene(void **state) {
    (void)state;
    make_square();
    mkdir("packed", 0777);
    assert_rewritten("in/square.gltf", NULL, "packed/square.glb");
    done(same_scene("in/square.gltf", "packed/square.glb"));
    assert_int_not_equal(access("packed/indices.bin", F_OK), 0); /* it is inside */
    assert_int_equal(access("packed/sound.ogg", F_OK), 0);       /* it is not */
    assert_rewritten("packed/square.glb", NULL, "packed/same.glb");
    assert_same_files("packed/square.glb", "packed/same.glb");
    assert_rewritten("packed/square.glb", NULL, "packed/again.gltf");
    assert_int_equal(access("packed/again.bin", F_OK), 0);
    done(same_scene("in/square.gltf", "packed/again.gltf"));
    assert_rewritten("packed/again.gltf", NULL, "packed/third.glb");
    done(same_scene("in/square.gltf", "packed/third.glb"));
}

/* Views, and what compresses them, are led to where the bytes are; what nobody can pack stays. */
static void packed_buffers_keep_their_references(void **state) {
    (void)state;
    char *text =
        json("{'asset':{'version':'2.0'},'buffers':[{'byteLength':4,'uri':'%s'},{'byteLength':8,'extensions':"
             "{'EXT_meshopt_compression':{'fallback':true}}},{'byteLength':3,'uri':'%s'},"
             "{'byteLength':3,'uri':'https://weft.example/a.bin'}],'bufferViews':[{'buffer':1,'byteLength':8,"
             "'extensions':{'EXT_meshopt_compression':{'buffer':2,'byteOffset':1,'byteLength':2,'byteStride':4,"
             "'count':2,'mode':'ATTRIBUTES'}}},{'buffer':3,'byteLength':3}]}",
             uri("zero", 4), uri("two", 3));
    write_bytes("views.gltf", text, strlen(text));
    free(text);
    WeftError error;
    if (rewrite("views.gltf", NULL, "views.glb", &error) != WEFT_OK) fail_msg("%s", error.text);
    Asset asset = {.error = &error};
    gltf_open(&asset, "views.glb", NULL, 0);
    assert_int_equal(asset.result, WEFT_OK);
    assert_int_equal(asset.bin.size, 8);
    assert_memory_equal(asset.bin.data, "zerotwo", 8);
    char *made = json_dumps(json_object_get(asset.root, "bufferViews"), JSON_COMPACT);
    char *expected = json("[{'buffer':1,'byteLength':8,'extensions':{'EXT_meshopt_compression':{'buffer':0,"
                          "'byteOffset':5,'byteLength':2,'byteStride':4,'count':2,'mode':'ATTRIBUTES'}}},"
                          "{'buffer':2,'byteLength':3}]");
    assert_string_equal(made, expected);
    assert_int_equal(json_array_size(json_object_get(asset.root, "buffers")), 3);
    free(made);
    free(expected);
    gltf_close(&asset);
}

/* A chunk of somebody's behind the bytes stays behind them. */
static void unknown_chunks_of_a_glb_are_kept(void **state) {
    (void)state;
    make_square();
    WeftError error;
    assert_int_equal(rewrite("in/square.gltf", NULL, "plain.glb", &error), WEFT_OK);
    FileBytes plain = bytes_of("plain.glb");
    unsigned char *more = calloc(1, plain.size + 12);
    memcpy(more, plain.data, plain.size);
    memcpy(more + plain.size, "\x04\0\0\0WHATever", 12);
    size_t length = plain.size + 12;
    for (int k = 0; k < 4; k++) more[8 + k] = (unsigned char)(length >> 8 * k);
    write_bytes("more.glb", more, length);
    assert_rewritten("more.glb", roughen, "rough.glb");
    FileBytes rough = bytes_of("rough.glb");
    assert_memory_equal(rough.data + rough.size - 12, more + plain.size, 12);
    free(rough.data);
    free(plain.data);
    free(more);
}

static void add_picture(Rewrite *rewrite) {
    WeftError error;
    int texture = rewrite_texture(rewrite, png, sizeof png, 0, &error);
    assert_int_equal(texture, 1);
    json_object_set_new(sheen_of(rewrite), "sheenColorTexture", json_pack("{s:i}", "index", texture));
    assert_int_equal(rewrite_uses(rewrite, "KHR_materials_sheen", &error), WEFT_OK);
    rewrite_uses_no_more(rewrite, "SOME_sound");
    assert_int_equal(json_array_size(json_object_get(rewrite->root, "extensionsUsed")), 1);
}

static void new_pictures_are_written_beside_the_asset(void **state) {
    (void)state;
    make_square();
    mkdir("pictured", 0777);
    assert_rewritten("in/square.gltf", add_picture, "pictured/a.gltf");
    FileBytes picture = bytes_of("pictured/a-1.png");
    assert_int_equal(picture.size, sizeof png);
    assert_memory_equal(picture.data, png, sizeof png);
    free(picture.data);
    assert_rewritten("in/square.gltf", add_picture, "pictured/a.glb");
    Reading *reading = same_scene("pictured/a.gltf", "pictured/a.glb");
    assert_int_equal(reading->scene->image_count, 2);
    done(reading);
    /* into a GLB that has no bytes yet */
    char *text = json("{'asset':{'version':'2.0'},'materials':[{'extensions':{'KHR_materials_sheen':{}}}],"
                      "'extensionsUsed':['SOME_sound','KHR_materials_sheen'],"
                      "'images':[{'uri':'%s'}],'textures':[{'source':0}]}",
                      uri(png, sizeof png));
    write_bytes("empty.gltf", text, strlen(text));
    free(text);
    assert_rewritten("empty.gltf", add_picture, "empty.glb");
    Asset asset = {0};
    gltf_open(&asset, "empty.glb", NULL, 0);
    json_t *buffer = json_array_get(json_object_get(asset.root, "buffers"), 0);
    assert_int_equal(json_integer_value(json_object_get(buffer, "byteLength")), asset.bin.size);
    assert_int_equal(asset.bin.size, 2 * sizeof png);
    gltf_close(&asset);
}

static void output_of_another_suffix_is_refused(void **state) {
    (void)state;
    make_square();
    WeftError error;
    assert_int_equal(rewrite("in/square.gltf", NULL, "square.obj", &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_SCENE_KIND);
    assert_int_equal(rewrite("in/square.gltf", NULL, "nowhere/square.gltf", &error), WEFT_RESOURCES);
    assert_int_equal(rewrite("in/square.gltf", NULL, "nowhere/square.glb", &error), WEFT_RESOURCES);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_WRITE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rewritten_asset_differs_by_the_added_number_alone),
        cmocka_unit_test(files_of_the_asset_are_copied),
        cmocka_unit_test(gltf_to_glb_and_back_is_the_same_scene),
        cmocka_unit_test(packed_buffers_keep_their_references),
        cmocka_unit_test(unknown_chunks_of_a_glb_are_kept),
        cmocka_unit_test(new_pictures_are_written_beside_the_asset),
        cmocka_unit_test(output_of_another_suffix_is_refused),
    };
    return cmocka_run_group_tests(tests, scratch_group_begin, scratch_group_end);
}
