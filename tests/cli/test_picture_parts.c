/* A picture in parts: whatever their number and order, the bytes of one run; what does not belong together is refused. */
#include <math.h>

#include "run.h"

#include "weft/image.h"
#include "weft/isa.h"

enum { PARTS_MOST = 7, PATH_TEXT = 24 };

/* The options of the picture: a crop whose sides are no multiples of a tile, all AOVs, a colour behind. */
#define PICTURE                                                                                                        \
    "scene.gltf", "--width=100", "--height=130", "--crop=3,5,90,117", "--aov=albedo,normal,depth,samples,uv",          \
        "--background=0.2,0.1,0", "--white-balance=auto", "--quiet"

static void part_path(char path[PATH_TEXT], int index) { snprintf(path, PATH_TEXT, "part-%d.exr", index); }

/* Renders part `index` of `count`, with other samples or exposure, or one more option. */
static Ran part_render(int index, int count, const char *spp, const char *exposure, const char *option) {
    char chunk[32], path[PATH_TEXT];
    snprintf(chunk, sizeof chunk, "%d/%d", index, count);
    part_path(path, index);
    return RUN("render", PICTURE, "--chunk", chunk, "-o", path, spp, exposure, option);
}

static void part_make(int index, int count) {
    Ran ran = part_render(index, count, "--spp=20", "--exposure=0.5", NULL);
    if (ran.code != 0) fail_msg("part %d of %d: exit %d: %s", index, count, ran.code, ran.err);
    ran_free(&ran);
}

static Ran parts_merge(int count, int first) {
    char paths[PARTS_MOST][PATH_TEXT];
    const char *arguments[PARTS_MOST + 8] = {"merge"};
    for (int k = 0; k < count; k++) {
        part_path(paths[k], 1 + (first + count - k) % count); /* backwards, from somewhere */
        arguments[1 + k] = paths[k];
    }
    const char *const rest[] = {"-o", "merged.exr", "-o", "merged.png", "--quiet", NULL};
    for (int k = 0; k < 6; k++) arguments[1 + count + k] = rest[k];
    return run_with(NULL, arguments);
}

static void assert_same_files(const char *a, const char *b, int parts) {
    size_t size;
    char *bytes = file_bytes(a, &size);
    assert_non_null(bytes);
    if (!same_bytes(b, bytes, size)) fail_msg("%d parts: %s is not %s", parts, b, a);
    free(bytes);
}

static void whole_make(void) {
    Ran ran = RUN("render", PICTURE, "--spp=20", "--exposure=0.5", "-o", "whole.exr", "-o", "whole.png", "--threads=2");
    if (ran.code != 0) fail_msg("exit %d: %s", ran.code, ran.err);
    ran_free(&ran);
}

static void merged_parts_are_the_bytes_of_one_run(void **state) {
    (void)state;
    static const int counts[] = {1, 2, 3, 4, 7};
    whole_make();
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        const int count = counts[c];
        for (int k = 1; k <= count; k++) part_make(k, count);
        Ran ran = parts_merge(count, (int)c);
        if (ran.code != 0) fail_msg("%d parts: exit %d: %s", count, ran.code, ran.err);
        ran_free(&ran);
        assert_same_files("whole.exr", "merged.exr", count);
        assert_same_files("whole.png", "merged.png", count);
    }
}

static void killed_part_is_done_again_and_nothing_is_left_of_it(void **state) {
    (void)state;
    whole_make();
    part_make(1, 2);
    unlink("part-2.exr");
    pid_t child = program_start(WEFT_PROGRAM, NULL,
                                LIST("render", "scene.gltf", "--spp=100000", "--chunk=2/2", "-o", "part-2.exr"));
    sleep_seconds(0.3);
    kill(child, SIGKILL);
    Ran ran = program_end(child);
    assert_int_equal(ran.code, 128 + SIGKILL);
    ran_free(&ran);
    assert_int_not_equal(access("part-2.exr", F_OK), 0);
    assert_complaint(NULL, LIST("merge", "part-1.exr", "-o", "merged.exr"), 2, "of 2 parts 1 is missing: 2");
    part_make(2, 2);
    ran = parts_merge(2, 0);
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    assert_same_files("whole.exr", "merged.exr", 2);
}

static void interrupted_part_is_not_written(void **state) {
    (void)state;
    unlink("part-1.exr");
    pid_t child = program_start(WEFT_PROGRAM, NULL,
                                LIST("render", "scene.gltf", "--spp=100000", "--chunk=1/2", "-o", "part-1.exr"));
    sleep_seconds(0.5);
    kill(child, SIGINT);
    Ran ran = program_end(child);
    assert_int_equal(ran.code, 130);
    assert_non_null(strstr(ran.err, "a part is whole or not at all"));
    ran_free(&ran);
    assert_int_not_equal(access("part-1.exr", F_OK), 0);
}

static void parts_that_do_not_belong_together_are_refused_by_name(void **state) {
    (void)state;
    const char *const rest[] = {"-o", "merged.exr", NULL};
    part_make(1, 2);
    static const struct {
        const char *spp, *exposure, *option, *words;
    } others[] = {
        {"--spp=21", "--exposure=0.5", NULL,
         "of 2 parts 1 is missing: 1 of 21 samples a pixel; part-1.exr has 20 (weft render --from adds samples)"},
        {"--spp=20", "--exposure=1", NULL, "tone=0,1,0,0,0,1, and not tone=0,0.5,0,0,0,1"},
        {"--spp=20", "--exposure=0.5", "--seed=3", "seed=3, and not seed=0"},
        {"--spp=20", "--exposure=0.5", "--set=cloth.sheen_roughness=0.4", "scene="},
        {"--spp=20", "--exposure=0.5", "--isa=sse2", "isa=sse2, and not isa="},
        {"--spp=20", "--exposure=0.5", "--max-depth=2", "depth=2, and not depth="},
    };
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        if (strcmp(weft_isa(), "sse2") == 0 && others[k].option && strcmp(others[k].option, "--isa=sse2") == 0)
            continue;
        Ran ran = part_render(2, 2, others[k].spp, others[k].exposure, others[k].option);
        assert_int_equal(ran.code, 0);
        ran_free(&ran);
        assert_complaint(NULL, LIST("merge", "part-1.exr", "part-2.exr", rest[0], rest[1]), 2, others[k].words);
    }
    part_make(2, 3);
    assert_complaint(NULL, LIST("merge", "part-1.exr", "part-2.exr", rest[0], rest[1]), 2, "of=3, and not of=2");
    assert_complaint(NULL, LIST("merge", "part-2.exr", rest[0], rest[1]), 2, "of 3 parts 2 are missing: 1, 3");
    file_make("twin.exr", "", 0);
    Ran ran = run_shell("cp part-1.exr twin.exr");
    ran_free(&ran);
    assert_complaint(NULL, LIST("merge", "part-1.exr", "twin.exr", rest[0], rest[1]), 2,
                     "twin.exr: is part 1 of 2, as is part-1.exr");
    assert_int_not_equal(access("merged.exr", F_OK) == 0 && access("whole.exr", F_OK) != 0, 1);
}

/* Writes part 1 of 1 by hand. */
static void part_forge(const char *words) {
    enum { SIDE = 16 };
    static float pixels[4 * SIDE * SIDE];
    for (int k = 0; k < 4 * SIDE * SIDE; k++) pixels[k] = 0.5f;
    const WeftImage image = {SIDE, SIDE, 4, WEFT_PIXEL_F32, pixels};
    const WeftImageLayer layer = {&image, {"part.R", "part.G", "part.B", "part.A"}};
    WeftError error;
    if (weft_image_write_as("forged.exr", &image,
                            &(WeftImageWriting){.comment = words, .layers = &layer, .layer_count = 1},
                            &error) != WEFT_OK)
        fail_msg("%s", error.text);
}

static void hostile_part_is_refused_by_name(void **state) {
    (void)state;
#define WORDS(part, crop, layers)                                                                                      \
    "weft-part=1 part=" part " isa=sse2 spp=1 crop=" crop " tone=0,0,0,0,0,0 behind=0,0,0,0 layers=" layers
    static const char good[] = WORDS("1 of=1", "0,0,16,16", "");
    static const struct {
        const char *words;
        int code;
        const char *line;
    } forged[] = {{NULL, 3, "forged.exr: is no part of a picture that weft render --chunk wrote"},
                  {"a picture", 3, "is no part"},
                  {WORDS("1 of=5000", "0,0,16,16", ""), 3, "is no part"},
                  {WORDS("2 of=1", "0,0,16,16", ""), 3, "is no part"},
                  {WORDS("0 of=1", "0,0,16,16", ""), 3, "is no part"},
                  {WORDS("nan of=nan", "0,0,16,16", ""), 3, "is no part"},
                  {WORDS("1 of=1 spp=-1", "0,0,16,16", ""), 3, "is no part"},
                  {WORDS("1 of=1 spp=1e9", "0,0,16,16", ""), 3, "is no part"},
                  {WORDS("1 of=1", "0,0,16", ""), 3, "is no part"},
                  {WORDS("1 of=1", "0,0,1e9,16", ""), 3, "is no part"},
                  {WORDS("1 of=1", "0,0,17,16", ""), 3, "has not the size that it says"},
                  {WORDS("1 of=1", "0,0,16,16", "a,b,c,d,e"), 3, "is no part"},
                  {WORDS("1 of=1", "0,0,16,16", "albedo.R"), 3, "it has no channel albedo.R"}};
    for (size_t k = 0; k < sizeof forged / sizeof *forged; k++) {
        part_forge(forged[k].words);
        assert_complaint(NULL, LIST("merge", "forged.exr", "-o", "merged.png"), forged[k].code, forged[k].line);
    }
    part_forge(good);
    Ran ran = RUN("merge", "forged.exr", "-o", "forged.png");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    size_t size;
    char *bytes = file_bytes("forged.exr", &size);
    for (int k = 1; k < 8; k++) {
        file_make("forged.exr", bytes, size * (size_t)k / 8);
        ran = RUN("merge", "forged.exr", "-o", "forged.png");
        assert_int_equal(ran.code, 3);
        assert_true(one_complaint(ran.err) && strstr(ran.err, "forged.exr: "));
        ran_free(&ran);
    }
    free(bytes);
    for (int k = 0; k < 2; k++) {
        static const char *const others[] = {"scene.gltf", "whole.png"};
        if (access(others[k], F_OK) == 0)
            assert_complaint(NULL, LIST("merge", others[k], "-o", "merged.png"), 3, others[k]);
    }
    assert_complaint(NULL, LIST("merge", "forged.exr", "-o", "forged.exr"), 2, "forged.exr");
    assert_complaint(NULL, LIST("merge", "forged.exr"), 2, "merge: needs -o OUT");
}

/* An .exr in memory, little-endian. */
typedef struct Bytes {
    unsigned char at[2048];
    size_t size;
} Bytes;

static void put(Bytes *bytes, const void *data, size_t size) {
    assert_true(bytes->size + size <= sizeof bytes->at);
    memcpy(bytes->at + bytes->size, data, size);
    bytes->size += size;
}

static void put_int(Bytes *bytes, int32_t number) { put(bytes, &number, sizeof number); }

static void put_attribute(Bytes *bytes, const char *name, const char *type, const void *data, size_t size) {
    put(bytes, name, strlen(name) + 1);
    put(bytes, type, strlen(type) + 1);
    put_int(bytes, (int32_t)size);
    put(bytes, data, size);
}

/* Writes part 1 of 1 of one pixel, without compression, since weft's writer lets no such number through. */
static void part_forge_raw(const char *words, float value) {
    static const char *const names[] = {"R", "part.A", "part.B", "part.G", "part.R"};
    const int32_t box[4] = {0}, form[4] = {2, 0, 1, 1}; /* float, linear, sampled 1 x 1 */
    const float one = 1.0f, centre[2] = {0};
    Bytes file = {.size = 0}, list = {.size = 0};
    for (int k = 0; k < 5; k++) {
        put(&list, names[k], strlen(names[k]) + 1);
        put(&list, form, sizeof form);
    }
    put(&list, "", 1);
    put_int(&file, 20000630);
    put_int(&file, 2);
    put_attribute(&file, "channels", "chlist", list.at, list.size);
    put_attribute(&file, "comments", "string", words, strlen(words));
    put_attribute(&file, "compression", "compression", "", 1);
    put_attribute(&file, "dataWindow", "box2i", box, sizeof box);
    put_attribute(&file, "displayWindow", "box2i", box, sizeof box);
    put_attribute(&file, "lineOrder", "lineOrder", "", 1);
    put_attribute(&file, "pixelAspectRatio", "float", &one, sizeof one);
    put_attribute(&file, "screenWindowCenter", "v2f", centre, sizeof centre);
    put_attribute(&file, "screenWindowWidth", "float", &one, sizeof one);
    put(&file, "", 1);
    const uint64_t line = file.size + sizeof line;
    put(&file, &line, sizeof line);
    put_int(&file, 0);
    put_int(&file, 5 * (int)sizeof value);
    for (int k = 0; k < 5; k++) put(&file, k < 4 ? &one : &value, sizeof value);
    file_make("forged.exr", file.at, file.size);
}

static void part_with_a_number_that_is_not_finite_is_refused(void **state) {
    (void)state;
    static const char words[] =
        "weft-part=1 part=1 of=1 isa=sse2 spp=1 crop=0,0,1,1 layers= tone=0,0,0,0,0,0 behind=0,0,0,0";
    const float wrong[] = {NAN, INFINITY, -INFINITY};
    part_forge_raw(words, 0.5f);
    Ran ran = RUN("merge", "forged.exr", "-o", "merged.png");
    if (ran.code != 0) fail_msg("exit %d: %s", ran.code, ran.err);
    ran_free(&ran);
    for (int k = 0; k < 3; k++) {
        part_forge_raw(words, wrong[k]);
        assert_complaint(NULL, LIST("merge", "forged.exr", "-o", "merged.png"), 3,
                         "forged.exr: has a number that is not finite");
    }
}

static void options_that_need_the_whole_picture_are_refused(void **state) {
    (void)state;
    static const struct {
        const char *option, *words;
    } refused[] = {{"--noise=0.1", "--chunk: not with --noise"},
                   {"--time-limit=1", "--chunk: not with --time-limit"},
                   {"--denoise", "--chunk: not with --denoise"},
                   {"--turntable=1", "--chunk: a turntable of 1 pictures has at most 1 parts"},
                   {"--engine=raster", "--chunk: needs one picture of --engine trace"},
                   {"--aov=albedo,object", "--chunk: not with --aov object or material"},
                   {"--height=16", "--chunk: a picture of 16 rows of pixels has at most 1 parts"},
                   {"--layer=additive,seed", "--chunk: needs one picture of --engine trace"}};
    for (size_t k = 0; k < sizeof refused / sizeof *refused; k++)
        assert_complaint(NULL, LIST("render", "scene.gltf", "--chunk=1/2", "-o", "part.exr", refused[k].option), 2,
                         refused[k].words);
    assert_complaint(NULL, LIST("render", "scene.gltf", "--chunk=1/2", "-o", "part.exr", "-o", "part.png"), 2,
                     "part.png: a part of a picture must be an .exr");
    static const char *const chunks[] = {"1", "0/2", "3/2", "1/0", "1/2x", "-1/2", "1/5000", "1/99999999999", "a/b"};
    for (size_t k = 0; k < sizeof chunks / sizeof *chunks; k++)
        assert_complaint(NULL, LIST("render", "scene.gltf", "-o", "part.exr", "--chunk", chunks[k]), 2, "is not I/N");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(merged_parts_are_the_bytes_of_one_run),
        cmocka_unit_test(killed_part_is_done_again_and_nothing_is_left_of_it),
        cmocka_unit_test(interrupted_part_is_not_written),
        cmocka_unit_test(parts_that_do_not_belong_together_are_refused_by_name),
        cmocka_unit_test(hostile_part_is_refused_by_name),
        cmocka_unit_test(part_with_a_number_that_is_not_finite_is_refused),
        cmocka_unit_test(options_that_need_the_whole_picture_are_refused),
    };
    return cmocka_run_group_tests(tests, scene_begin, work_end);
}
