/* GLB and JSON containers, versions, extensions, URIs. */
#include "reading.h"
#include "scratch.h"
#include "weft/root.h"

#include <sys/stat.h>
#include <unistd.h>

static void put_word(unsigned char *p, size_t value) {
    for (int k = 0; k < 4; k++) p[k] = (unsigned char)(value >> 8 * k);
}

/* A chunk at an offset of out; the offset behind it. */
static size_t put_chunk(unsigned char *out, size_t at, size_t kind, const void *body, size_t size) {
    put_word(out + at, size);
    put_word(out + at + 4, kind);
    memcpy(out + at + 8, body, size);
    return at + 8 + size;
}

enum { KIND_JSON = 0x4e4f534a, KIND_BIN = 0x004e4942, MAGIC = 0x46546c67 };

/* A GLB of the text and bin (NULL: no second chunk) in out; its size. */
static size_t glb(unsigned char *out, const char *text, const void *bin, size_t bin_size) {
    size_t size = put_chunk(out, 12, KIND_JSON, text, strlen(text));
    if (bin) size = put_chunk(out, size, KIND_BIN, bin, bin_size);
    put_word(out, MAGIC);
    put_word(out + 4, 2);
    put_word(out + 8, size);
    return size;
}

static const char triangle_text[] =
    "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
    "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":"
    "[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}]}";
static const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

static void glb_chunks_are_read(void **state) {
    (void)state;
    unsigned char bytes[1024];
    size_t size = glb(bytes, triangle_text, triangle, sizeof triangle);
    Reading *reading = read_gltf("triangle.glb", bytes, size);
    assert_read(reading);
    assert_int_equal(reading->scene->mesh_count, 1);
    assert_int_equal(reading->scene->meshes[0].triangle_count, 1);
    assert_memory_equal(reading->scene->meshes[0].position, triangle, sizeof triangle);
    assert_null(reading->scene->meshes[0].normal);
    done(reading);
    /* What lies behind the end is reported, not read. */
    reading = read_gltf("triangle.glb", bytes, size + 4);
    assert_read(reading);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_IGNORED], 1);
    done(reading);
}

/* A byte order mark before the JSON and zeros behind it, in both containers: each is passed over with a warning. */
static void marks_and_zeros_about_the_text_are_passed_over(void **state) {
    (void)state;
    static const struct {
        const char *before;
        size_t zeros;
        const char *warning;
    } cases[] = {{"\xef\xbb\xbf", 0, "byte order mark"}, {"", 4, "zeros"}, {"\xef\xbb\xbf ", 4, "byte order mark"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        for (int packed = 0; packed < 2; packed++) {
            unsigned char bytes[1024], text[1024] = {0};
            char *whole = json("%s%s%s", cases[k].before, "{'asset':{'version':'2.0'},'nodes':[{'name':'n'}]}", "");
            const size_t length = strlen(whole);
            memcpy(text, whole, length);
            size_t size = length + cases[k].zeros;
            if (packed) {
                size = put_chunk(bytes, 12, KIND_JSON, text, size);
                put_word(bytes, MAGIC), put_word(bytes + 4, 2), put_word(bytes + 8, size);
            }
            Reading *reading = read_gltf("marked", packed ? bytes : text, size);
            assert_read(reading);
            assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_REPAIRED],
                             (*cases[k].before != 0) + (cases[k].zeros > 0));
            assert_non_null(strstr(reading->warning, cases[k].warning));
            done(reading);
            free(whole);
        }
    /* a mark alone, or before something else, is still no glTF */
    assert_refused(read_gltf("mark", "\xef\xbb\xbf", 3), WEFT_MESSAGE_SCENE_KIND, "neither");
    assert_refused(read_gltf("mark", "\xef\xbb\xbfP6", 5), WEFT_MESSAGE_SCENE_KIND, "neither");
}

static void damaged_glb_is_refused(void **state) {
    (void)state;
    unsigned char bytes[1024];
    size_t size = glb(bytes, triangle_text, triangle, sizeof triangle);
    for (size_t cut = 0; cut < size; cut++) {
        Reading *reading = read_gltf("cut.glb", bytes, cut);
        assert_int_equal(reading->result, WEFT_INPUT);
        assert_int_equal(reading->error.message, cut < 4 ? WEFT_MESSAGE_SCENE_KIND : WEFT_MESSAGE_GLTF_CONTAINER);
        done(reading);
    }
    put_word(bytes + 4, 1);
    assert_refused(read_gltf("old.glb", bytes, size), WEFT_MESSAGE_GLTF_VERSION, "GLB version 1");
    put_word(bytes + 4, 2);
    put_word(bytes + 12, 1 << 20);
    assert_refused(read_gltf("chunk.glb", bytes, size), WEFT_MESSAGE_GLTF_CONTAINER, "chunk 0");
    size = glb(bytes, triangle_text, triangle, sizeof triangle);
    bytes[16] = 'X';
    assert_refused(read_gltf("kind.glb", bytes, size), WEFT_MESSAGE_GLTF_CONTAINER, "first chunk");
    size = glb(bytes, "[1] ", NULL, 0);
    assert_refused(read_gltf("array.glb", bytes, size), WEFT_MESSAGE_GLTF_JSON, "not an object");
    size = glb(bytes, triangle_text, triangle, 32);
    assert_refused(read_gltf("short.glb", bytes, size), WEFT_MESSAGE_GLTF_BOUNDS, "buffers[0]: 32 of 36");
}

static void text_that_is_no_gltf_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *text;
        WeftMessage message;
        const char *part;
    } cases[] = {
        {"", WEFT_MESSAGE_SCENE_KIND, "neither"},
        {"P6 1 1", WEFT_MESSAGE_SCENE_KIND, "neither"},
        {"{\"asset\":", WEFT_MESSAGE_GLTF_JSON, "line 1"},
        {"{}\n{}", WEFT_MESSAGE_GLTF_JSON, "line 2"},
        {"{\"a\":1e999}", WEFT_MESSAGE_GLTF_JSON, "overflow"},
        {"{}", WEFT_MESSAGE_GLTF_VERSION, "asset.version"},
        {"{\"asset\":{\"version\":\"1.0\"}}", WEFT_MESSAGE_GLTF_VERSION, "1.0"},
        {"{\"asset\":{\"version\":\"2.0\",\"minVersion\":\"2.1\"}}", WEFT_MESSAGE_GLTF_VERSION, "2.1"},
        {"{\"asset\":{\"version\":2}}", WEFT_MESSAGE_GLTF_SCHEMA, "asset.version: expected a string"},
        {"{\"asset\":[]}", WEFT_MESSAGE_GLTF_SCHEMA, "asset: expected an object"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_refused(read_gltf("text", cases[i].text, strlen(cases[i].text)), cases[i].message, cases[i].part);
    /* Nesting is bounded, so that no file can exhaust the stack. */
    size_t size = 5000000;
    char *text = malloc(size);
    memset(text, '[', size);
    text[0] = '{';
    assert_refused(read_gltf("deep", text, 100), WEFT_MESSAGE_GLTF_JSON, "line 1");
    memcpy(text, (const char[]){'{', '"', 'a', '"', ':'}, 5);
    assert_refused(read_gltf("deep", text, 100000), WEFT_MESSAGE_GLTF_JSON, "depth");
    assert_refused(read_gltf("many", text, size), WEFT_MESSAGE_GLTF_TOO_LARGE, "JSON values");
    free(text);
}

static void unsupported_required_extension_is_named(void **state) {
    (void)state;
    assert_refused(read_rest("'extensionsRequired':['MSFT_texture_dds']"), WEFT_MESSAGE_GLTF_EXTENSION,
                   "MSFT_texture_dds");
    assert_refused(read_rest("'extensionsRequired':['KHR_mesh_quantization','EXT_texture_avif']"),
                   WEFT_MESSAGE_GLTF_EXTENSION, "EXT_texture_avif");
    assert_refused(read_rest("'extensionsRequired':['line\\nbreak']"), WEFT_MESSAGE_GLTF_EXTENSION, "line?break");
    Reading *reading = read_rest("'extensionsUsed':['KHR_materials_iridescence','KHR_materials_sheen','X_Y']");
    assert_read(reading);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_EXTENSION], 2);
    assert_non_null(strstr(reading->warning, "X_Y"));
    done(reading);
}

static void base64_data_uri_is_decoded(void **state) {
    (void)state;
    static const char *const good[] = {"AAAA", "AAAAAAAA", "////", "AAA=", "AAA", "AA=="};
    static const char *const bad[] = {"AAA?", "A", "AAAAA", "AA AA", "AA=A", "===="};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        Reading *reading =
            read_rest("'buffers':[{'byteLength':1,'uri':'data:application/gltf-buffer;base64,%s'}]", good[i]);
        assert_read(reading);
        done(reading);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_refused(read_rest("'buffers':[{'byteLength':1,'uri':'data:;base64,%s'}]", bad[i]), WEFT_MESSAGE_GLTF_URI,
                       "base64");
    assert_refused(read_rest("'buffers':[{'byteLength':1,'uri':'data:'}]"), WEFT_MESSAGE_GLTF_URI, "needs a comma");
    assert_refused(read_rest("'buffers':[{'byteLength':4,'uri':'data:;base64,AAAA'}]"), WEFT_MESSAGE_GLTF_BOUNDS,
                   "3 of 4");
}

/* Data of a URI that is not in base64, by RFC 2397: each byte of it reaches the mesh, and half an escape none. */
static void percent_encoded_data_uri_is_decoded(void **state) {
    (void)state;
    static const struct {
        const char *data;
        int bytes;
    } good[] = {{"hello", 5}, {"%00%fF%Ab", 3}, {"a%20b,c", 5}, {"-_.!~*();/?:@&=+$,", 18}, {"%25", 1}};
    static const char *const bad[] = {"%", "%2", "ab%", "%2g", "%g2", "% 2", "%%20", "100%"}, *const bare[] = {
                                                                                                  "a b",   "a#b",
                                                                                                  "a[0]",  "a\\\\b",
                                                                                                  "a\\nb", "\xc3\xa4",
                                                                                                  "^"};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        Reading *reading =
            read_rest("'buffers':[{'byteLength':%d,'uri':'DATA:a/b;c=d,%s'}]", good[i].bytes, good[i].data);
        assert_read(reading);
        done(reading);
        char few[32];
        snprintf(few, sizeof few, "%d of %d bytes", good[i].bytes, good[i].bytes + 1);
        assert_refused(read_rest("'buffers':[{'byteLength':%d,'uri':'data:,%s'}]", good[i].bytes + 1, good[i].data),
                       WEFT_MESSAGE_GLTF_BOUNDS, few);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_refused(read_rest("'buffers':[{'byteLength':1,'uri':'data:,%s'}]", bad[i]), WEFT_MESSAGE_GLTF_URI,
                       "percent-encoding is damaged at character");
    for (size_t i = 0; i < sizeof bare / sizeof *bare; i++)
        assert_refused(read_rest("'buffers':[{'byteLength':1,'uri':'data:,%s'}]", bare[i]), WEFT_MESSAGE_GLTF_URI,
                       "must be percent-encoded");
    assert_refused(read_rest("'buffers':[{'byteLength':1,'uri':'data:,'}]"), WEFT_MESSAGE_GLTF_BOUNDS, "0 of 1");
    char *whole = json("{'asset':{'version':'2.0'},'buffers':[{'byteLength':48,'uri':'%s'}],"
                       "'bufferViews':[{'buffer':0,'byteLength':48}],"
                       "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'}],"
                       "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'mode':5}]}],'nodes':[{'mesh':0}]}",
                       percent_uri(square.position, 48));
    Reading *reading = read_gltf("percent", whole, strlen(whole));
    free(whole);
    assert_read(reading);
    assert_int_equal(reading->scene->mesh_count, 1);
    float sum = 0.0f;
    for (size_t k = 0; k < 3 * (size_t)reading->scene->meshes[0].vertex_count; k++)
        sum += reading->scene->meshes[0].position[k];
    assert_near(sum, 4.0f, 0.0f); /* of the corners of a unit square */
    done(reading);
}

/* --- files beside the asset --- */

static char folder[SCRATCH_SIZE];

static void write_file(const char *name, const void *data, size_t size) {
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    fclose(file);
}

/* Reads an asset of the folder whose one buffer of 4 bytes lies at reference. */
static Reading *read_referring(const char *reference) {
    char path[256];
    char *text = json("{'asset':{'version':'2.0'},'buffers':[{'byteLength':4,'uri':'%s'}]}", reference);
    write_file("a b/asset.gltf", text, strlen(text));
    free(text);
    snprintf(path, sizeof path, "%s/a b/asset.gltf", folder);
    return read_gltf(path, NULL, 0);
}

static int make_folder(void **state) {
    (void)state;
    char path[256];
    if (!scratch_make(folder)) return -1;
    snprintf(path, sizeof path, "%s/a b", folder);
    if (mkdir(path, 0700)) return -1;
    snprintf(path, sizeof path, "%s/a b/sub", folder);
    if (mkdir(path, 0700)) return -1;
    write_file("outside.bin", "1234", 4);
    write_file("a b/in side.bin", "1234", 4);
    write_file("a b/sub/\xc3\xa9%.bin", "1234", 4);
    return 0;
}

static int remove_folder(void **state) {
    (void)state;
    return scratch_remove(folder) ? 0 : -1;
}

static void relative_uris_find_their_files(void **state) {
    (void)state;
    static const char *const good[] = {"in%20side.bin",           "in side.bin",
                                       "./sub/../in%20side.bin",  "sub/%C3%A9%25.bin",
                                       "sub//.././in%20side.bin", "sub%2f%c3%a9%25.bin"};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        Reading *reading = read_referring(good[i]);
        assert_read(reading);
        done(reading);
    }
    assert_refused(read_referring("missing.bin"), WEFT_MESSAGE_FILE_OPEN, "missing.bin");
    assert_refused(read_referring("sub"), WEFT_MESSAGE_FILE_READ, "folder");
}

static void uris_outside_the_folder_are_refused(void **state) {
    (void)state;
    static const struct {
        const char *uri, *reason;
    } cases[] = {
        {"../outside.bin", "out of the asset's folder"},
        {"sub/../../outside.bin", "out of the asset's folder"},
        {"%2e%2e/outside.bin", "out of the asset's folder"},
        {"..%2foutside.bin", "out of the asset's folder"},
        {"..", "out of the asset's folder"},
        {"/etc/passwd", "absolute"},
        {"%2Fetc/passwd", "absolute"},
        {"file:///etc/passwd", "only files and data"},
        {"https://example.org/a.bin", "only files and data"},
        {"C:/a.bin", "only files and data"},
        {"in%2", "percent"},
        {"%%", "percent"},
        {"in%00side.bin", "percent"},
        {"", "empty"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_refused(read_referring(cases[i].uri), WEFT_MESSAGE_GLTF_URI, cases[i].reason);
    assert_refused(read_rest("'buffers':[{'byteLength':4,'uri':'in%%20side.bin'}]"), WEFT_MESSAGE_GLTF_URI,
                   "in memory");
    assert_refused(read_gltf("/nowhere/at/all.gltf", NULL, 0), WEFT_MESSAGE_FILE_OPEN, "all.gltf");
}

/* A link counts by what it points to; a folder that is opened on purpose lets in what lies below it, nothing else. */
static void files_are_read_from_the_opened_folder_alone(void **state) {
    (void)state;
    char from[256], to[256], opened[256];
    WeftError error;
    Reading *reading;
    snprintf(from, sizeof from, "%s/outside.bin", folder);
    snprintf(to, sizeof to, "%s/a b/link.bin", folder);
    assert_int_equal(symlink(from, to), 0);
    snprintf(to, sizeof to, "%s/a b/near.bin", folder);
    assert_int_equal(symlink("in side.bin", to), 0);
    reading = read_referring("near.bin");
    assert_read(reading);
    done(reading);
    snprintf(opened, sizeof opened, "a link out of the asset's folder is refused; --root %s lets it in", folder);
    assert_refused(read_referring("link.bin"), WEFT_MESSAGE_GLTF_URI, opened);
    snprintf(opened, sizeof opened, "a path out of the asset's folder is refused; --root %s/a b/.. lets it in", folder);
    assert_refused(read_referring("sub/../../outside.bin"), WEFT_MESSAGE_GLTF_URI, opened);
    snprintf(opened, sizeof opened, "%s/a b/..", folder);
    assert_int_equal(weft_root_use(opened, &error), WEFT_OK);
    static const char *const good[] = {"../outside.bin", "link.bin", "in%20side.bin", "..\\\\outside.bin"};
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        reading = read_referring(good[k]);
        assert_read(reading);
        done(reading);
    }
    assert_refused(read_referring("../../../../../../../etc/passwd"), WEFT_MESSAGE_GLTF_URI,
                   "out of the asset's folder");
    assert_refused(read_referring("../absent.bin"), WEFT_MESSAGE_FILE_OPEN, "absent.bin");
    assert_int_equal(weft_root_use("/nowhere/at/all", &error), WEFT_INPUT);
    assert_int_equal(weft_root_use(NULL, &error), WEFT_OK);
    assert_refused(read_referring("../outside.bin"), WEFT_MESSAGE_GLTF_URI, "--root");
}

/* Backslashes come from Windows; a file with one in its name is that file. */
static void backslashes_are_taken_as_slashes(void **state) {
    (void)state;
    write_file("a b/sub/plain.bin", "1234", 4);
    static const char *const names[] = {"sub\\\\plain.bin", "sub%5Cplain.bin"};
    for (size_t k = 0; k < 2; k++) {
        Reading *reading = read_referring(names[k]);
        assert_read(reading);
        assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_REPAIRED], 1);
        assert_non_null(strstr(reading->warning, "buffers[0].uri: sub\\plain.bin: its backslashes"));
        done(reading);
    }
    assert_refused(read_referring("..\\\\outside.bin"), WEFT_MESSAGE_GLTF_URI, "out of the asset's folder");
    write_file("a b/odd\\name.bin", "1234", 4);
    Reading *reading = read_referring("odd%5Cname.bin");
    assert_read(reading);
    assert_string_equal(reading->warning, "");
    done(reading);
}

/* Many names of one large file, of which little is wanted: it is read once, and no more than that of it. */
static void file_used_twice_is_read_once(void **state) {
    (void)state;
    enum { SIZE = 4 << 20, NAMES = 1000 };
    char path[256], *large = calloc(SIZE, 1), *text = malloc((size_t)NAMES * 80);
    write_file("a b/large.bin", large, SIZE);
    int used = sprintf(text, "{'asset':{'version':'2.0'},'buffers':[");
    for (int i = 0; i < NAMES; i++)
        used += sprintf(text + used, "%s{'byteLength':%d,'uri':'%s%s'}", i ? "," : "", 1 + i, i % 2 ? "./" : "",
                        "large.bin");
    /* Zeros that would fit if each name counted, or all of the file. */
    sprintf(text + used, "],'accessors':[{'componentType':5126,'count':3000000,'type':'VEC3'}],"
                         "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],'nodes':[{'mesh':0}]}");
    for (char *c = text; *c; c++)
        if (*c == '\'') *c = '"';
    size_t length = strlen(text);
    write_file("a b/asset.gltf", text, length);
    snprintf(path, sizeof path, "%s/a b/asset.gltf", folder);
    char expected[64];
    snprintf(expected, sizeof expected, "%zu bytes of input", length + NAMES);
    assert_refused(read_gltf(path, NULL, 0), WEFT_MESSAGE_GLTF_TOO_LARGE, expected);
    snprintf(path, sizeof path, "%s/a b/large.bin", folder);
    unlink(path);
    free(large);
    free(text);
}

/* No data are not a file, whatever they are called. */
static void scene_from_no_bytes_is_refused_whatever_its_name(void **state) {
    (void)state;
    WeftScene *scene = NULL;
    WeftError error;
    static const char *const names[] = {WEFT_SOURCE_DIR "/CMakeLists.txt", "builtin:spheres"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        assert_int_equal(weft_scene_load_memory(NULL, 0, names[i], &scene, NULL, &error), WEFT_INPUT);
        assert_int_equal(error.message, WEFT_MESSAGE_SCENE_KIND);
        assert_null(scene);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(glb_chunks_are_read),
        cmocka_unit_test(marks_and_zeros_about_the_text_are_passed_over),
        cmocka_unit_test(damaged_glb_is_refused),
        cmocka_unit_test(text_that_is_no_gltf_is_refused),
        cmocka_unit_test(unsupported_required_extension_is_named),
        cmocka_unit_test(base64_data_uri_is_decoded),
        cmocka_unit_test(percent_encoded_data_uri_is_decoded),
        cmocka_unit_test(relative_uris_find_their_files),
        cmocka_unit_test(uris_outside_the_folder_are_refused),
        cmocka_unit_test(files_are_read_from_the_opened_folder_alone),
        cmocka_unit_test(backslashes_are_taken_as_slashes),
        cmocka_unit_test(file_used_twice_is_read_once),
        cmocka_unit_test(scene_from_no_bytes_is_refused_whatever_its_name),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
