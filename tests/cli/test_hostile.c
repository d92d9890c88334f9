/* What a hostile or careless user hands over: one line and the right exit code, never a signal or a wait
 * without end. */
#include "run.h"

#include <sys/stat.h>

#include "weft/weft.h"

#define TINY "--width=16", "--height=16", "--spp=1", "--quiet"

static void cameras_out_of_reach_are_refused(void **state) {
    (void)state;
    assert_complaint(NULL, LIST("render", "scene.gltf", TINY, "-o", "a.png", "--camera", "1.9e18,1,3;0,0,0;45"), 2,
                     "beyond 1e15 m");
    assert_complaint(NULL, LIST("render", "scene.gltf", TINY, "-o", "a.png", "--camera", "0,1,3;0,0,-3e38;45"), 2,
                     "beyond 1e15 m");
    size_t size;
    char *text = file_bytes("scene.gltf", &size), *at = strstr(text, "[0,0,3]"), far[4096];
    assert_non_null(at);
    snprintf(far, sizeof far, "%.*s[0,0,3e19]%s", (int)(at - text), text, at + strlen("[0,0,3]"));
    file_make("far.gltf", far, strlen(far));
    free(text);
    assert_complaint(NULL, LIST("render", "far.gltf", TINY, "-o", "a.png"), 3, "cameras[0]: its node is too far away");
    Ran ran = RUN("render", "scene.gltf", TINY, "-o", "a.png", "--camera", "9e14,1,3;0,0,0;45");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
}

/* The widest scene there may be, and the narrowest picture: the camera would back off beyond Embree's
 * numbers. */
static void picture_from_a_camera_out_of_reach_is_refused(void **state) {
    (void)state;
    size_t size;
    char *text = file_bytes("scene.gltf", &size), *at = strstr(text, "{\"mesh\":0}"), wide[4096];
    assert_non_null(at);
    snprintf(wide, sizeof wide, "%.*s{\"mesh\":0,\"scale\":[9e14,9e14,9e14]}%s", (int)(at - text), text,
             at + strlen("{\"mesh\":0}"));
    file_make("wide.gltf", wide, strlen(wide));
    free(text);
    assert_complaint(NULL, LIST("render", "wide.gltf", "--width=1", "--height=60000", "--spp=1", "-o", "a.png"), 2,
                     "beyond 1e18 m");
}

static void pipes_and_devices_are_refused_at_once(void **state) {
    (void)state;
    static const char asset[] = "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"pipe\","
                                "\"byteLength\":36}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
                                "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
                                "\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{\"attributes\":"
                                "{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}]}";
    file_make("piped.gltf", asset, sizeof asset - 1);
    assert_int_equal(mkfifo("pipe", 0600), 0);
    assert_complaint(NULL, LIST("render", "piped.gltf", TINY, "-o", "a.png"), 3,
                     "pipe: cannot be read: it is not a plain");
    assert_complaint(NULL, LIST("render", "scene.gltf", TINY, "-o", "a.png", "--env", "pipe"), 3, "not a plain file");
    assert_complaint(NULL, LIST("render", "scene.gltf", TINY, "-o", "a.png", "--env", "/dev/zero"), 3,
                     "/dev/zero: cannot be read: it is not a plain file");
    assert_complaint(NULL, LIST("doctor", "pipe"), 3, "not a plain file");
    assert_complaint(NULL, LIST("fit", "pipe"), 3, "not a plain file");
    assert_complaint(NULL, LIST("convert", "pipe", "-o", "a.ktx2"), 3, "not a plain file");
    assert_complaint(NULL, LIST("merge", "pipe", "-o", "a.exr"), 3, "not a plain file");
    assert_complaint(NULL, LIST("render", "builtin:cloth", TINY, "-o", "a.png", "--material", "pipe"), 3,
                     "not a plain file");
    assert_complaint(NULL, LIST("weave", "pipe", "-o", "a.png"), 3, "not a plain file");
    assert_int_equal(symlink("pipe", "table.h"), 0);
    assert_complaint(NULL, LIST("bake", "audit", "table.h", "--lobe", "charlie-neubelt"), 3, "not a plain file");
    unlink("table.h");
    assert_int_equal(symlink("pipe", "cloth.u3ma"), 0);
    assert_complaint(NULL, LIST("render", "cloth.u3ma", TINY, "-o", "a.png"), 3, "not a plain file");
    unlink("cloth.u3ma");
    assert_complaint(NULL, LIST("diff", "pipe", "pipe"), 3, "not a plain file");
    unlink("pipe");
}

/* All that is there is the word that a .bsdf begins with. */
static void bsdf_cut_behind_its_magic_is_refused(void **state) {
    (void)state;
    file_make("cut.bsdf", "tensor_file", 12);
    assert_complaint(NULL, LIST("fit", "cut.bsdf"), 3, "cut short");
    assert_complaint(NULL, LIST("plot", "polar", "cut.bsdf", "-o", "a.svg"), 3, "cut short");
}

/* The program runs once to have its cache, of which every file becomes a pipe. */
static void cache_file_that_is_a_pipe_is_ignored(void **state) {
    (void)state;
    Ran ran = run_shell("export XDG_CACHE_HOME=$PWD/cache && $0 bake ltc ggx --size 4x4 -o a.npy --quiet && "
                        "cd cache/weft && for f in *.ltc; do rm $f && mkfifo $f; done && cd ../.. && "
                        "timeout 60 $0 bake ltc ggx --size 4x4 -o b.npy && cmp a.npy b.npy");
    if (ran.code != 0 || !strstr(ran.err, "is not used as a cache")) fail_msg("%d: %s%s", ran.code, ran.out, ran.err);
    ran_free(&ran);
    ran = run_shell("rm -r cache");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
}

static void damaged_cache_is_a_warning(void **state) {
    (void)state;
    Ran ran = run_shell("export XDG_CACHE_HOME=$PWD/cache && $0 bake ltc ggx --size 4x4 -o a.npy --quiet && "
                        "for f in cache/weft/*.ltc; do echo x >> $f; done && "
                        "$0 bake ltc ggx --size 4x4 -o b.npy && cmp a.npy b.npy");
    if (ran.code != 0 || !strstr(ran.err, "warning: ") || !strstr(ran.err, "is not used as a cache"))
        fail_msg("%d: %s%s", ran.code, ran.out, ran.err);
    ran_free(&ran);
    ran = run_shell("rm -r cache");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
}

/* Sends a signal to eval, which reads lines as they come, while it waits for a pipe. */
static Ran end_waiting_eval(int number) {
    assert_int_equal(mkfifo("lines", 0600), 0);
    pid_t child = program_start(WEFT_PROGRAM, NULL, LIST("eval", "ggx", "lines"));
    sleep_seconds(0.1);
    kill(child, number);
    Ran ran = program_end(child);
    unlink("lines");
    return ran;
}

static void eval_waiting_for_a_pipe_ends_by_a_signal(void **state) {
    (void)state;
    Ran ran = end_waiting_eval(SIGTERM);
    assert_int_equal(ran.code, 128 + SIGTERM);
    ran_free(&ran);
}

/* A fault, such as one in a driver, says where it was. Sanitizers, whose handler stays, say so in their own words. */
static void a_crash_tells_the_calls_that_led_to_it(void **state) {
    (void)state;
    Ran ran = end_waiting_eval(SIGSEGV);
    const char *line = strstr(ran.err, "weft: crashed; "), *call = line ? strstr(line, "[0x") : NULL;
    if (strstr(ran.err, "Sanitizer"))
        assert_int_not_equal(ran.code, 0);
    else if (ran.code != 128 + SIGSEGV || line != ran.err || !call)
        fail_msg("%d: %s", ran.code, ran.err);
    ran_free(&ran);
}

static void a_file_beyond_its_limit_is_one_line_and_leaves_nothing(void **state) {
    (void)state;
    Ran ran = run_shell("mkdir limit && cd limit && cp ../scene.gltf . && ulimit -f 8 && "
                        "$0 render scene.gltf --width 128 --height 128 --spp 1 --quiet -o a.exr; e=$?; ls; cd ..; "
                        "rm -r limit; exit $e");
    if (ran.code != 4 || !one_complaint(ran.err)) fail_msg("%d: %s", ran.code, ran.err);
    assert_non_null(strstr(ran.err, "a.exr: cannot be written"));
    assert_string_equal(ran.out, "scene.gltf\n");
    ran_free(&ran);
}

/* Each kind of file that cannot be written is one line with the reason, which a stream does not keep by itself. */
static void a_full_disk_is_told_by_every_writer(void **state) {
    (void)state;
    static const char *const lines[] = {"render scene.gltf --width 128 --height 128 --spp 1 --quiet -o a.png",
                                        "render scene.gltf --width 128 --height 128 --spp 1 --quiet -o a.exr",
                                        "render scene.gltf --width 128 --height 128 --spp 1 --quiet -o a.hdr",
                                        "render scene.gltf --width 128 --height 128 --spp 1 --quiet -o a.npy",
                                        "plot polar ggx -o a.svg",
                                        "plot polar ggx -o a.png",
                                        "bake bsdf ggx --size 4x16 --quiet -o a.bsdf",
                                        "bake albedo ggx --size 64x64 --quiet -o a.dds",
                                        "bake albedo ggx --size 64x64 --quiet -o a.csv",
                                        "export ggx --target c --quiet -o a.h",
                                        "weave 'plain; both 400k 400r' -o a.wif",
                                        "weave 'plain; both 400k 400r' -o a.txt",
                                        "render builtin:ball --save a.glb",
                                        "render builtin:ball --save a.gltf"};
    char line[400];
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        snprintf(line, sizeof line, "rm -f a.*; ulimit -f 4; $0 %s; e=$?; ls | grep '^a[.]'; exit $e", lines[k]);
        Ran ran = run_shell(line);
        if (ran.code != 4 || !one_complaint(ran.err) || !strstr(ran.err, "cannot be written: File too large") ||
            ran.out[0])
            fail_msg("%s: %d: %s%s", lines[k], ran.code, ran.err, ran.out);
        ran_free(&ran);
    }
}

/* Runs with the small stack that some programs leave to those they start; sanitizers need more for themselves. */
static void a_small_stack_is_enough(void **state) {
    (void)state;
#if defined(__SANITIZE_ADDRESS__) || defined(__clang__)
    skip();
#endif
    static const char *const lines[] = {"check lambert --quick --no-gpu",
                                        "export khronos --target glsl --quiet -o small.glsl",
                                        "doctor builtin:ball",
                                        "render scene.gltf --width 16 --height 16 --spp 4 --quiet -o small.png",
                                        "plot polar ggx -o small.svg",
                                        "bake albedo ggx --size 8x8 --quiet -o small.npy"};
    char line[300];
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        snprintf(line, sizeof line,
                 "$0 %s >usual 2>&1; e=$?; ulimit -s 64; $0 %s >small 2>&1; [ $? = $e ] && cmp usual small", lines[k],
                 lines[k]);
        Ran ran = run_shell(line);
        if (ran.code != 0) fail_msg("%s: %d: %s%s", lines[k], ran.code, ran.out, ran.err);
        ran_free(&ran);
    }
}

static void unwritable_report_is_an_error(void **state) {
    (void)state;
    Ran found = run_shell("$0 doctor scene.gltf > /dev/null"), lost = run_shell("$0 doctor scene.gltf > /dev/full");
    assert_int_equal(found.code, 1); /* or the test says nothing */
    assert_int_equal(lost.code, 4);
    assert_true(one_complaint(lost.err));
    ran_free(&found), ran_free(&lost);
}

static void damaged_picture_is_not_reported_as_lack_of_memory(void **state) {
    (void)state;
    const char *folder = getenv("WEFT_DATA");
    char path[1024];
    snprintf(path, sizeof path, "%s/malformed/undecodable.exr", folder ? folder : WEFT_SOURCE_DIR "/../shared/data");
    if (access(path, R_OK) != 0) {
        print_message("%s is not there (WEFT_DATA can name another folder)\n", path);
        skip();
    }
    assert_complaint(NULL, LIST("diff", path, path), 3, "undecodable.exr: is damaged");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cameras_out_of_reach_are_refused),
        cmocka_unit_test(picture_from_a_camera_out_of_reach_is_refused),
        cmocka_unit_test(pipes_and_devices_are_refused_at_once),
        cmocka_unit_test(bsdf_cut_behind_its_magic_is_refused),
        cmocka_unit_test(cache_file_that_is_a_pipe_is_ignored),
        cmocka_unit_test(damaged_cache_is_a_warning),
        cmocka_unit_test(eval_waiting_for_a_pipe_ends_by_a_signal),
        cmocka_unit_test(a_crash_tells_the_calls_that_led_to_it),
        cmocka_unit_test(a_file_beyond_its_limit_is_one_line_and_leaves_nothing),
        cmocka_unit_test(a_full_disk_is_told_by_every_writer),
        cmocka_unit_test(a_small_stack_is_enough),
        cmocka_unit_test(unwritable_report_is_an_error),
        cmocka_unit_test(damaged_picture_is_not_reported_as_lack_of_memory),
    };
    return cmocka_run_group_tests(tests, scene_begin, work_end);
}
