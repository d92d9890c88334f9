#define _GNU_SOURCE /* memmem */
/* `weft render`: pictures come out, as asked for, and nothing is lost when they cannot. */
#include "run.h"

#include <jansson.h>
#include <math.h>
#include <sys/stat.h>

#include "weft/weft.h"

#define TINY "--width", "32", "--height", "24", "--spp", "4"

static WeftImage picture(const char *path) {
    WeftImage image;
    WeftError error = {0};
    if (weft_image_read(path, &image, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return image;
}

static void assert_size(const char *path, int width, int height) {
    WeftImage image = picture(path);
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    weft_image_free(&image);
}

static json_t *parsed(const char *text) {
    json_error_t error;
    json_t *value = json_loads(text, 0, &error);
    if (!value) fail_msg("not JSON: line %d: %s\n%s", error.line, error.text, text);
    return value;
}

static double number(json_t *object, const char *key) {
    assert_true(json_is_number(json_object_get(object, key)));
    return json_number_value(json_object_get(object, key));
}

/* Runs and asserts exit 0. */
static Ran done(const char *const *arguments) {
    Ran ran = run_with(NULL, arguments);
    if (ran.code != 0) fail_msg("exit %d: %s", ran.code, ran.err);
    return ran;
}

static void quietly(const char *const *arguments) {
    Ran ran = done(arguments);
    assert_string_equal(ran.err, "");
    assert_string_equal(ran.out, "");
    ran_free(&ran);
}

/* Each stage has a line; their sum is no more than the time of all threads. Without --stages there are none. */
static void stages_are_listed_with_their_times(void **state) {
    (void)state;
    Ran ran = done(LIST("render", "builtin:spheres", TINY, "-o", "a.png", "--stages", "--threads", "1", "--quiet"));
    assert_non_null(strstr(ran.out, "shadow tests"));
    assert_non_null(strstr(ran.out, "\nall "));
    ran_free(&ran);
    ran =
        done(LIST("render", "builtin:spheres", TINY, "-o", "a.png", "--stages", "--threads", "1", "--json", "--quiet"));
    json_t *figures = parsed(ran.out), *stages = json_object_get(figures, "stages"), *stage;
    const char *name;
    double sum = 0.0;
    json_object_foreach(stages, name, stage) sum += json_number_value(stage);
    double all = 1e9 * number(json_object_get(figures, "seconds"), "render") / (32 * 24 * 4);
    assert_true(number(stages, "bounce hits") > 0.0 && sum <= all && sum > 0.3 * all);
    json_decref(figures);
    ran_free(&ran);
    ran = done(LIST("render", "builtin:spheres", TINY, "-o", "a.png", "--json", "--quiet"));
    figures = parsed(ran.out);
    assert_null(json_object_get(figures, "stages"));
    json_decref(figures);
    ran_free(&ran);
}

static void builtin_scene_is_written_in_three_formats(void **state) {
    (void)state;
    Ran ran = done(LIST("render", "builtin:spheres", TINY, "-o", "a.png", "-o", "a.exr", "-o", "a.hdr"));
    assert_string_equal(ran.out, "");
    assert_true(one_complaint(ran.err)); /* the summary; no progress bar: this is no terminal */
    assert_non_null(strstr(ran.err, "4 samples/pixel in "));
    assert_non_null(strstr(ran.err, " M samples/s; wrote a.png, a.exr, a.hdr\n"));
    assert_size("a.png", 32, 24);
    assert_size("a.exr", 32, 24);
    assert_size("a.hdr", 32, 24);
    WeftImage linear = picture("a.exr");
    assert_int_equal(linear.type, WEFT_PIXEL_F32);
    weft_image_free(&linear);
    ran_free(&ran);
}

static void picture_depends_on_the_seed_alone(void **state) {
    (void)state;
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "-o", "a.png", "-o", "a.exr", "--threads", "1"));
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "-o", "b.png", "-o", "b.exr", "--seed=0", "--threads=3"));
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "-o", "c.exr", "--seed", "1"));
    size_t png_size, exr_size;
    char *png = file_bytes("a.png", &png_size), *exr = file_bytes("a.exr", &exr_size);
    assert_true(same_bytes("b.png", png, png_size));
    assert_true(same_bytes("b.exr", exr, exr_size));
    assert_false(same_bytes("c.exr", exr, exr_size));
    free(png), free(exr);
}

static float mean(const char *path) {
    WeftImage raw = picture(path), image;
    assert_int_equal(weft_image_convert_f32(&raw, 0, &image, NULL), WEFT_OK);
    const float *values = image.pixels;
    int pixels = image.width * image.height, colors = image.channels < 3 ? image.channels : 3;
    double sum = 0.0;
    for (int k = 0; k < pixels; k++)
        for (int c = 0; c < colors; c++) sum += (double)values[k * image.channels + c];
    weft_image_free(&raw);
    weft_image_free(&image);
    return (float)(sum / (pixels * colors));
}

static void light_and_picture_options_change_the_picture(void **state) {
    (void)state;
    quietly(
        LIST("render", "scene.gltf", TINY, "--quiet", "-o", "dark.exr", "--env", "0,0,0", "--background=environment"));
    assert_true(mean("dark.exr") == 0.0f);
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "-o", "one.exr", "-o", "one.png", "--env", "0.25",
                 "--env-strength=4", "--background=environment", "--camera", "0,0,3;0,0,9;30"));
    assert_true(fabsf(mean("one.exr") - 1.0f) < 1e-3f); /* it looks away from all there is */
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "-o", "low.exr", "-o", "low.png", "--exposure=-12", "--env",
                 "1,1,1", "--background", "environment", "--tonemap=none"));
    assert_true(mean("low.exr") > 0.3f); /* exposure is for display */
    assert_true(mean("low.png") < 0.02f);
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "-o", "clear.png", "--background=transparent", "--camera",
                 "0,0,3;0,0,9;30"));
    WeftImage clear = picture("clear.png");
    assert_int_equal(clear.channels, 4);
    for (int k = 0; k < 32 * 24; k++) assert_int_equal(((unsigned char *)clear.pixels)[4 * k + 3], 0);
    weft_image_free(&clear);
}

static void crop_is_a_part_of_the_whole(void **state) {
    (void)state;
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "-o", "crop.exr", "--crop", "8,6,16,12"));
    assert_size("crop.exr", 16, 12);
}

static void set_option_changes_a_material(void **state) {
    (void)state;
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "-o", "a.exr", "--camera=front"));
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "-o", "b.exr", "--camera=0", "--set", "cloth.base_color=0",
                 "--set=*.sheen_color=0,0,0", "--sheen", "charlie-neubelt", "--layer=additive"));
    assert_true(mean("b.exr") < mean("a.exr"));
    assert_complaint(NULL, LIST("render", "scene.gltf", "-o", "a.exr", "--set=wool.ior=1.5"), 2,
                     "wool: is not a material");
    assert_complaint(NULL, LIST("render", "scene.gltf", "-o", "a.exr", "--set=cloth.iro=1.5"), 2,
                     "\"iro\" is not a parameter; did you mean ior?");
    assert_complaint(NULL, LIST("render", "scene.gltf", "-o", "a.exr", "--variant=x"), 2,
                     "x: is not a material variant");
}

/* Alone, or beside a picture, which is that of what was saved. */
static void save_option_writes_the_scene(void **state) {
    (void)state;
    quietly(LIST("render", "builtin:cloth", "--preset=denim", "--save=saved.glb", "--save=saved.gltf",
                 "--save=saved.json"));
    quietly(LIST("render", "builtin:cloth", "--preset=denim", TINY, "--quiet", "--camera=0", "-o", "a.exr",
                 "--save=b.glb"));
    size_t size;
    char *one = file_bytes("a.exr", &size);
    static const char *const again[] = {"saved.glb", "saved.gltf", "b.glb"};
    for (int k = 0; k < 3; k++) {
        quietly(LIST("render", again[k], TINY, "--quiet", "--camera=0", "-o", "c.exr"));
        assert_true(same_bytes("c.exr", one, size));
    }
    quietly(LIST("render", "builtin:cloth", TINY, "--quiet", "--camera=0", "--material=saved.json", "-o", "c.exr"));
    assert_true(same_bytes("c.exr", one, size));
    free(one);
    assert_complaint(NULL, LIST("render", "builtin:cloth", "--save=a.obj"), 2,
                     "not a .glb, .gltf, .json, .mtlx, .u3m or .u3ma");
    assert_complaint(NULL, LIST("render", "builtin:cloth", "--save=none/a.glb"), 4, "none/a.glb");
    assert_complaint(NULL, LIST("render", "none.gltf", "--save=a.glb"), 3, "none.gltf");
}

static void json_has_samples_and_seconds(void **state) {
    (void)state;
    static const char odd[] = "o\"\\\n\xc3\xa4\xff.png"; /* quote, backslash, newline, UTF-8 and not */
    Ran ran = done(LIST("render", "scene.gltf", TINY, "--json", "-o", odd, "-o", "a.exr", "--set=cloth.ior=3",
                        "--set=cloth.metallic=0", "--set=cloth.base_color=0.5", "--camera", "0,0,4;0,0,0;40"));
    assert_non_null(strstr(ran.err, "weft: warning: "));
    json_t *all = parsed(ran.out), *camera = json_object_get(all, "camera"), *seconds = json_object_get(all, "seconds");
    assert_string_equal(json_string_value(json_object_get(all, "scene")), "scene.gltf");
    assert_true(number(all, "width") == 32.0 && number(all, "height") == 24.0);
    assert_true(number(all, "triangles") == 1.0);
    assert_true(number(all, "samples_per_pixel") == 4.0);
    assert_true(json_is_false(json_object_get(all, "interrupted")));
    assert_true(number(seconds, "load") >= 0.0 && number(seconds, "build") >= 0.0 && number(seconds, "render") > 0.0);
    assert_true(number(all, "rays") >= 32.0 * 24.0 * 4.0);
    double rate = number(all, "samples_per_second") * number(seconds, "render");
    assert_true(fabs(rate - 32.0 * 24.0 * 4.0) < 1.0);
    assert_true(number(all, "rays_per_second") > 0.0 && number(all, "peak_memory_bytes") > 1e6);
    assert_true(fabs(number(camera, "fov") - 40.0) < 1e-3);
    assert_true(json_number_value(json_array_get(json_object_get(camera, "eye"), 2)) == 4.0);
    assert_int_equal(json_array_size(json_object_get(all, "warnings")),
                     2); /* the range of ior; the reflectance, of ior and of metallic at once */
    json_t *outputs = json_object_get(all, "outputs");
    assert_int_equal(json_array_size(outputs), 2);
    assert_string_equal(json_string_value(json_array_get(outputs, 0)), "o\"\\\n\xc3\xa4\xef\xbf\xbd.png");
    json_decref(all);
    ran_free(&ran);
    ran = done(LIST("render", "scene.gltf", TINY, "--json", "--quiet", "-o", "a.png", "--set=cloth.ior=3"));
    assert_string_equal(ran.err, "");
    ran_free(&ran);
}

static void time_limit_ends_a_render_with_a_picture(void **state) {
    (void)state;
    Ran ran =
        done(LIST("render", "scene.gltf", "--width=32", "--height=24", "--time-limit=0.3", "--json", "-o", "a.png"));
    json_t *all = parsed(ran.out);
    double render = number(json_object_get(all, "seconds"), "render");
    assert_true(render >= 0.25 && render < 5.0);
    assert_true(number(all, "samples_per_pixel") > 0.0);
    assert_true(json_is_false(json_object_get(all, "interrupted")));
    assert_size("a.png", 32, 24);
    json_decref(all);
    ran_free(&ran);
    ran = done(LIST("render", "scene.gltf", TINY, "--time-limit=100", "-o", "a.png"));
    assert_non_null(strstr(ran.err, " 4 samples/pixel"));
    ran_free(&ran);
}

/* Interrupts a long render after some seconds; longer and longer until it had taken a sample. */
static void interrupted_render_writes_the_samples_so_far(void **state) {
    (void)state;
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    for (int s = 0; s < 3; s++) {
        file_make("a.png", "old", 3);
        Ran ran;
        bool early = true;
        for (double pause = 0.5; early && pause < 20.0; pause *= 2.0) {
            pid_t child =
                program_start(WEFT_PROGRAM, NULL, LIST("render", "scene.gltf", "--time-limit=60", "-o", "a.png"));
            sleep_seconds(pause);
            kill(child, signals[s]);
            ran = program_end(child);
            early = strstr(ran.err, "before the first sample") != NULL;
            if (early) ran_free(&ran);
        }
        assert_false(early);
        assert_int_equal(ran.code, 130);
        assert_true(one_complaint(ran.err));
        assert_non_null(strstr(ran.err, "interrupted at "));
        assert_size("a.png", 960, 720);
        ran_free(&ran);
    }
}

/* Who sent it off with nohup wants it to go on. */
static void an_ignored_hangup_stays_ignored(void **state) {
    (void)state;
    Ran ran = run_shell("trap '' HUP; \"$0\" render scene.gltf --width 32 --height 24 --time-limit 1 -o n.png & "
                        "sleep 0.5; kill -HUP $!; wait $!");
    if (ran.code != 0 || strstr(ran.err, "interrupted")) fail_msg("exit %d: %s", ran.code, ran.err);
    ran_free(&ran);
}

/* A sheet of which only the first picture was begun: that picture, and no word on differences. */
static void interrupted_sheet_shows_the_pictures_so_far(void **state) {
    (void)state;
    Ran ran = {0};
    bool early = true;
    for (double pause = 0.5; early && pause < 20.0; pause *= 2.0) {
        ran_free(&ran);
        pid_t child = program_start(WEFT_PROGRAM, NULL,
                                    LIST("render", "scene.gltf", "--width=320", "--height=240", "-o", "a.png",
                                         "--time-limit=100", "--layer=additive,seed,reciprocal"));
        sleep_seconds(pause);
        kill(child, SIGINT);
        ran = program_end(child);
        early = strstr(ran.err, "before the first sample") != NULL;
    }
    assert_int_equal(ran.code, 130);
    if (!strstr(ran.err, "interrupted at 1 of 3 pictures in ")) fail_msg("%s", ran.err);
    ran_free(&ran);
    WeftImage sheet = picture("a.png");
    assert_true(sheet.width < 2 * 320 && sheet.height < 2 * 240);
    weft_image_free(&sheet);
}

/* Interrupts are heeded before anything is loaded, and the sky is large: its loading cannot be over then. */
static void render_interrupted_while_loading_ends(void **state) {
    (void)state;
    enum { WIDTH = 2048, HEIGHT = 1024 };
    WeftImage sky;
    assert_int_equal(weft_image_create(WIDTH, HEIGHT, 3, WEFT_PIXEL_F32, &sky, NULL), WEFT_OK);
    assert_int_equal(weft_image_write("sky.exr", &sky, NULL), WEFT_OK);
    weft_image_free(&sky);
    file_make("a.png", "old", 3);
    pid_t child =
        program_start(WEFT_PROGRAM, NULL, LIST("render", "scene.gltf", TINY, "--env", "sky.exr", "-o", "a.png"));
    await_handler(child);
    kill(child, SIGINT);
    Ran ran = program_end(child);
    assert_int_equal(ran.code, 130);
    assert_true(one_complaint(ran.err));
    assert_non_null(strstr(ran.err, "before the first sample"));
    assert_true(same_bytes("a.png", "old", 3));
    ran_free(&ran);
}

static void failed_render_keeps_the_old_picture(void **state) {
    (void)state;
    file_make("a.png", "old", 3);
    assert_complaint(NULL, LIST("render", "none.gltf", "-o", "a.png"), 3, "none.gltf: cannot be opened");
    assert_complaint(NULL, LIST("render", "builtin:none", "-o", "a.png"), 2,
                     "builtin:none: is not a built-in scene: available: ball, bend, cloth, lampshade, loom, sewing, "
                     "spheres, swatch\n");
    assert_complaint(NULL, LIST("render", "builtin:sphere", "-o", "a.png"), 2,
                     "available: ball, bend, cloth, lampshade, loom, sewing, spheres, swatch; did you mean spheres?");
    assert_complaint(NULL, LIST("render", "scene.gltf", "-o", "a.png", "--camera=0,0,1;0,0,0;180"), 2, "field of view");
    assert_complaint(NULL, LIST("render", "scene.gltf", "-o", "a.png", "--camera=back"), 2,
                     "back: is not a camera of this scene: available: front; else write auto");
    assert_complaint(NULL, LIST("render", "scene.gltf", "-o", "a.png", "--variant=red"), 2, "the scene has none");
    assert_complaint(NULL, LIST("render", "builtin:spheres", "-o", "a.png", "--set", "x.roughness=1"), 2,
                     "available: dark-0, dark-1, dark-2, dark-3, dark-4, ...");
    assert_complaint(NULL, LIST("render", "scene.gltf", "-o", "a.png", "--env=none.hdr"), 3,
                     "none.hdr: cannot be opened");
    assert_complaint(NULL, LIST("render", "stdin", "-o", "a.png"), 3, "stdin: ");
    assert_true(same_bytes("a.png", "old", 3));
}

/* No scene is there to be read, so exit 4 shows that the outputs come first. */
static void unwritable_output_is_refused_before_the_scene_is_read(void **state) {
    (void)state;
    assert_complaint(NULL, LIST("render", "none.gltf", "-o", "no/folder/a.png"), 4,
                     "no/folder/a.png: cannot be written");
    assert_complaint(NULL, LIST("render", "none.gltf", "-o", "a.png", "-o", "/proc/a.exr"), 4,
                     "/proc/a.exr: cannot be written");
    assert_complaint(NULL, LIST("render", "none.gltf", "-o", "a.png", "-o", "b.jpg"), 2, "b.jpg: has no suffix");
    assert_int_equal(mkfifo("pipe.png", 0600), 0);
    assert_complaint(NULL, LIST("render", "none.gltf", "-o", "pipe.png"), 4, "weft: pipe.png: is not a plain file");
    assert_complaint(NULL, LIST("check", "lambert", "--html", "pipe.png"), 4, "pipe.png: is not a plain file");
    assert_complaint(NULL, LIST("check", "lambert", "--html", "/"), 4, "/: is not a plain file");
    assert_int_equal(symlink("nowhere", "link.exr"), 0);
    assert_complaint(NULL, LIST("render", "none.gltf", "-o", "link.exr"), 4, "link.exr: is a link that leads nowhere");
}

static void output_through_a_link_replaces_its_target(void **state) {
    (void)state;
    struct stat status;
    file_make("real.png", "old", 3);
    assert_int_equal(symlink("real.png", "link.png"), 0);
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "-o", "link.png"));
    assert_true(lstat("link.png", &status) == 0 && S_ISLNK(status.st_mode));
    assert_size("real.png", 32, 24);
}

static bool file_has(const char *path, const void *part, size_t length) {
    size_t size;
    char *bytes = file_bytes(path, &size);
    bool found = bytes && memmem(bytes, size, part, length) != NULL;
    free(bytes);
    return found;
}

/* Looks for a channel of 32 bit floats in an .exr's header: its name, a zero, and the type as an integer. */
static bool file_has_channel(const char *path, const char *name) {
    char entry[40] = {0};
    size_t length = strlen(name);
    memcpy(entry, name, length);
    entry[length + 1] = 2;
    return file_has(path, entry, length + 5);
}

/* The channels that were asked for, by the names that other programs know, and no more. */
static void aovs_lie_in_the_exr_by_name(void **state) {
    (void)state;
    static const char *const names[] = {"albedo.R", "N.X", "Z", "variance.B", "sampleCount"};
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "-o", "plain.exr", "-o", "plain.png"));
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "--aov", "albedo,normal,depth,samples", "-o", "some.exr",
                 "-o", "some.png"));
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "--aov=variance", "-o", "one.exr"));
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        assert_int_equal(file_has_channel("some.exr", names[k]), k != 3);
        assert_int_equal(file_has_channel("one.exr", names[k]), k == 3);
        assert_false(file_has_channel("plain.exr", names[k]));
    }
    WeftImage some = picture("some.exr"), plain = picture("plain.exr");
    assert_memory_equal(some.pixels, plain.pixels, 32 * 24 * 4 * sizeof(float));
    weft_image_free(&some);
    weft_image_free(&plain);
}

static void noise_level_ends_a_render(void **state) {
    (void)state;
    Ran ran =
        done(LIST("render", "builtin:spheres", "--width=48", "--height=36", "--noise=0.02", "--json", "-o", "a.png"));
    json_t *all = parsed(ran.out);
    assert_true(number(all, "noise") <= 0.02 && number(all, "samples_per_pixel") >= 16.0);
    assert_non_null(strstr(ran.err, "relMSE about "));
    json_decref(all);
    ran_free(&ran);
}

/* A denoised picture is marked, and whoever compares with it is told. */
static void denoised_picture_warns_who_compares_with_it(void **state) {
    (void)state;
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "--denoise", "-o", "clean.exr", "-o", "clean.png"));
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "-o", "raw.exr", "-o", "raw.png"));
    assert_true(file_has("clean.exr", "denoised", 8) && file_has("clean.png", "Denoised", 8));
    assert_false(file_has("raw.exr", "denoised", 8) || file_has("raw.png", "Denoised", 8));
    static const char *const pairs[][2] = {{"raw.exr", "clean.exr"}, {"raw.png", "clean.png"}};
    for (int k = 0; k < 2; k++) {
        Ran ran = done(LIST("diff", pairs[k][0], pairs[k][1]));
        assert_non_null(strstr(ran.err, "was denoised"));
        assert_non_null(strstr(ran.err, pairs[k][1]));
        ran_free(&ran);
        ran = done(LIST("diff", pairs[k][0], pairs[k][0]));
        assert_string_equal(ran.err, "");
        ran_free(&ran);
    }
}

/* The header says with which instructions, and one line that there are none of that name. */
static void header_has_the_instructions(void **state) {
    (void)state;
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "--isa", "sse2", "-o", "pinned.exr"));
    assert_true(file_has("pinned.exr", "isa\0string\0\4\0\0\0sse2", 19));
    quietly(LIST("render", "scene.gltf", TINY, "--quiet", "--engine", "raster", "-o", "drawn.exr"));
    assert_false(file_has("drawn.exr", "isa\0string", 10));
    Ran ran = run_with(NULL, LIST("render", "scene.gltf", TINY, "--isa", "mmx", "-o", "none.exr"));
    assert_int_equal(ran.code, WEFT_USAGE);
    assert_string_equal(ran.err, "weft: mmx: is not a set of instructions: sse2, avx2 or avx512\n");
    assert_int_equal(access("none.exr", F_OK), -1);
    ran_free(&ran);
}

/* Open Image Denoise is found at run time: it works where it is installed, and else one line says that it is not. */
static void absent_denoising_library_is_named(void **state) {
    (void)state;
    Ran ran = run_with(NULL, LIST("render", "scene.gltf", TINY, "--denoiser", "oidn", "-o", "oidn.png"));
    if (ran.code == 0) {
        assert_size("oidn.png", 32, 24);
    } else { /* before anything is read or rendered */
        Ran absent = run_with(NULL, LIST("render", "none.gltf", TINY, "--denoiser", "oidn", "-o", "oidn.png"));
        assert_string_equal(absent.err, ran.err);
        ran_free(&absent);
        assert_int_equal(ran.code, WEFT_RESOURCES);
        assert_non_null(strstr(ran.err, "libOpenImageDenoise: cannot denoise"));
        assert_ptr_equal(strchr(ran.err, '\n'), ran.err + strlen(ran.err) - 1);
        assert_int_equal(access("oidn.png", F_OK), -1);
    }
    ran_free(&ran);
}

/* One line, and the exit code of a wrong command line. */
static void aov_noise_and_denoise_are_refused_elsewhere(void **state) {
    (void)state;
    static const struct {
        const char *arguments[8], *said;
    } cases[] = {{{"--aov", "albedo", "-o", "a.png"}, "--aov: needs an .exr"},
                 {{"--aov", "depth,colour", "-o", "a.exr"}, "--aov: \"colour\" is not "},
                 {{"--aov", "albedo,", "-o", "a.hdr"}, "--aov: needs an .exr"},
                 {{"--aov", "normal", "--engine", "raster", "-o", "a.exr"}, "--aov: needs --engine trace"},
                 {{"--noise", "0.1", "--engine", "raster", "-o", "a.png"}, "--noise: needs --engine trace"},
                 {{"--noise", "0", "-o", "a.png"}, "--noise"},
                 {{"--denoise", "--engine", "both", "-o", "a.png"}, "--denoise: not for a sheet"},
                 {{"--denoise", "-o", "a.hdr"}, "a.hdr: cannot say that it was denoised"},
                 {{"--denoise", "-o", "a.npy"}, "a.npy: cannot say that it was denoised"},
                 {{"--denoiser", "magic", "-o", "a.png"}, "--denoiser"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *const *a = cases[k].arguments;
        Ran ran = run_with(NULL, LIST("render", "scene.gltf", a[0], a[1], a[2], a[3], a[4], a[5]));
        assert_int_equal(ran.code, WEFT_USAGE);
        assert_non_null(strstr(ran.err, cases[k].said));
        assert_ptr_equal(strchr(ran.err, '\n'), ran.err + strlen(ran.err) - 1);
        ran_free(&ran);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(builtin_scene_is_written_in_three_formats),
        cmocka_unit_test(stages_are_listed_with_their_times),
        cmocka_unit_test(picture_depends_on_the_seed_alone),
        cmocka_unit_test(light_and_picture_options_change_the_picture),
        cmocka_unit_test(crop_is_a_part_of_the_whole),
        cmocka_unit_test(set_option_changes_a_material),
        cmocka_unit_test(save_option_writes_the_scene),
        cmocka_unit_test(json_has_samples_and_seconds),
        cmocka_unit_test(time_limit_ends_a_render_with_a_picture),
        cmocka_unit_test(interrupted_render_writes_the_samples_so_far),
        cmocka_unit_test(an_ignored_hangup_stays_ignored),
        cmocka_unit_test(interrupted_sheet_shows_the_pictures_so_far),
        cmocka_unit_test(render_interrupted_while_loading_ends),
        cmocka_unit_test(failed_render_keeps_the_old_picture),
        cmocka_unit_test(unwritable_output_is_refused_before_the_scene_is_read),
        cmocka_unit_test(output_through_a_link_replaces_its_target),
        cmocka_unit_test(aovs_lie_in_the_exr_by_name),
        cmocka_unit_test(noise_level_ends_a_render),
        cmocka_unit_test(denoised_picture_warns_who_compares_with_it),
        cmocka_unit_test(header_has_the_instructions),
        cmocka_unit_test(absent_denoising_library_is_named),
        cmocka_unit_test(aov_noise_and_denoise_are_refused_elsewhere),
    };
    return cmocka_run_group_tests(tests, scene_begin, work_end);
}
