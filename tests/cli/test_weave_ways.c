/* A woven cloth is the same by every way that says it: options, keys, JSON, material files and saved scenes; and its
 * threads have the size that they have on a loom, on meshes of any scale.
 *
 * Labels: slow unsanitized */
#include <math.h>

#include <sys/stat.h>

#include "run.h"
#include "weft/weft.h"

enum { DRAFTS = 10, DRAFTS_LONG = 200 };

/* A random cloth: the words of its draft, and the keys beside it with their values as --set and as JSON have them. */
typedef struct Cloth {
    char draft[160];
    struct {
        char key[24], value[64], json[80];
    } keys[12];
    int count;
} Cloth;

static unsigned random_state;

static int roll(int below) {
    random_state = random_state * 1664525u + 1013904223u;
    return (int)((random_state >> 8) % (unsigned)below);
}

static void add_key(Cloth *cloth, const char *key, const char *value, const char *json) {
    snprintf(cloth->keys[cloth->count].key, sizeof cloth->keys[0].key, "%s", key);
    snprintf(cloth->keys[cloth->count].value, sizeof cloth->keys[0].value, "%s", value);
    snprintf(cloth->keys[cloth->count++].json, sizeof cloth->keys[0].json, "%s", json);
}

/* Adds a key whose number is written alike in both. */
static void add_number(Cloth *cloth, const char *key, double number) {
    char text[32];
    snprintf(text, sizeof text, "%.4f", number);
    add_key(cloth, key, text, text);
}

static Cloth random_cloth(int k) {
    static const char *const weaves[] = {
        "plain",    "twill 2/2 z",       "twill 3/1 s", "satin 5/2",        "sateen 8/3",
        "basket 2", "herringbone 2/2 8", "houndstooth", "picks #.. .#. ..#"};
    Cloth cloth = {.count = 0};
    char value[64], json[80];
    random_state = (unsigned)k * 2654435761u + 1u;
    snprintf(cloth.draft, sizeof cloth.draft, "%s; warp 3#%06x 1#%06x; weft 2#%06x", weaves[roll(9)], roll(1 << 24),
             roll(1 << 24), roll(1 << 24));
    const int warp = 8 + roll(40), weft = 8 + roll(40);
    snprintf(value, sizeof value, "%d,%d", warp, weft);
    snprintf(json, sizeof json, "[%d, %d]", warp, weft);
    add_key(&cloth, "sett", value, json);
    if (roll(2)) add_number(&cloth, "metres", 0.05 * (1 + roll(40)));
    add_number(&cloth, "seed", roll(289));
    if (roll(2)) add_number(&cloth, "rotation", roll(720) - 360);
    if (roll(2)) add_number(&cloth, "relief", 0.001 * roll(100));
    if (roll(2)) add_number(&cloth, "warp.alpha", 0.15 + 0.01 * roll(50));
    if (roll(2)) add_number(&cloth, "weft.slub", 0.01 * roll(90));
    snprintf(value, sizeof value, "%.2f,%.2f,%.2f", 0.01 * roll(99), 0.01 * roll(99), 0.01 * roll(99));
    snprintf(json, sizeof json, "[%s]", value);
    if (roll(2)) add_key(&cloth, "weft.color", value, json);
    return cloth;
}

/* Writes the weave as JSON into text. */
static void cloth_json(const Cloth *cloth, char *text, size_t size) {
    static const char *const systems[] = {"warp", "weft"};
    size_t used = (size_t)snprintf(text, size, "{\"draft\": \"%s\"", cloth->draft);
    for (int k = 0; k < cloth->count; k++)
        if (!strchr(cloth->keys[k].key, '.'))
            used += (size_t)snprintf(text + used, size - used, ", \"%s\": %s", cloth->keys[k].key, cloth->keys[k].json);
    for (int t = 0; t < 2; t++) {
        used +=
            (size_t)snprintf(text + used, size - used, ", \"%s\": {\"yarn\": \"%s\"", systems[t], t ? "wool" : "linen");
        for (int k = 0; k < cloth->count; k++)
            if (strncmp(cloth->keys[k].key, systems[t], 4) == 0)
                used += (size_t)snprintf(text + used, size - used, ", \"%s\": %s", cloth->keys[k].key + 5,
                                         cloth->keys[k].json);
        used += (size_t)snprintf(text + used, size - used, "}");
    }
    snprintf(text + used, size - used, "}");
}

#define SMALL "--width", "40", "--height", "30", "--spp", "2", "--env", "1", "--light", "none", "--quiet"

/* Renders and returns the bytes of the picture's numbers. */
static char *drawn(const char *const *arguments, size_t *size) {
    Ran ran = run_with(NULL, arguments);
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
    return file_bytes("drawn.npy", size);
}

static void assert_drawn(const char *way, int k, const char *bytes, size_t size, const char *const *arguments) {
    size_t other_size;
    char *other = drawn(arguments, &other_size);
    if (size != other_size || memcmp(bytes, other, size) != 0) fail_msg("cloth %d is another %s", k, way);
    free(other);
}

static void asset_make(void) {
    Ran ran = RUN("render", "builtin:ball", "--save", "ball.glb");
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
}

static void cloth_is_the_same_by_every_way(void **state) {
    (void)state;
    asset_make();
    for (int k = 0; k < (getenv("WEFT_TEST_LONG") ? DRAFTS_LONG : DRAFTS); k++) {
        const Cloth cloth = random_cloth(k);
        char json[1024], file[1100], set[1100], draft[200], keys[16][128];
        const char *arguments[64] = {"render", "ball.glb", SMALL, "-o", "drawn.npy", "--weave", draft};
        int count = 0;
        size_t size;
        cloth_json(&cloth, json, sizeof json);
        snprintf(file, sizeof file, "{\"weave\": %s}", json);
        file_make("cloth.json", file, strlen(file));
        char *bytes =
            drawn(LIST("render", "ball.glb", SMALL, "-o", "drawn.npy", "--material", "ball=cloth.json"), &size);

        snprintf(draft, sizeof draft, "ball=%s", cloth.draft);
        while (arguments[count]) count++;
        snprintf(keys[14], sizeof keys[14], "ball.weave.warp=linen");
        snprintf(keys[15], sizeof keys[15], "ball.weave.weft=wool");
        for (int n = 14; n < 16; n++) arguments[count++] = "--set", arguments[count++] = keys[n];
        for (int n = 0; n < cloth.count; n++) {
            snprintf(keys[n], sizeof keys[n], "ball.weave.%s=%s", cloth.keys[n].key, cloth.keys[n].value);
            arguments[count++] = "--set", arguments[count++] = keys[n];
        }
        assert_drawn("by --weave and --set", k, bytes, size, arguments);

        snprintf(set, sizeof set, "ball.weave=%s", json);
        assert_drawn("by its JSON", k, bytes, size,
                     LIST("render", "ball.glb", SMALL, "-o", "drawn.npy", "--weave", "ball=plain", "--set", set));
        Ran ran =
            RUN("render", "ball.glb", "--material", "ball=cloth.json", "--save", "saved.glb", "--save", "saved.json");
        if (ran.code != 0) fail_msg("%s", ran.err);
        ran_free(&ran);
        assert_drawn("in a saved scene", k, bytes, size, LIST("render", "saved.glb", SMALL, "-o", "drawn.npy"));
        free(bytes);
    }
}

/* A quad of `side` metres whose texture coordinates span so many units, mirrored or not, and are turned by so many degrees,
 * counter-clockwise on an upright texture. */
static void rotated_quad_make(const char *path, double side, double units, bool mirrored, double degrees) {
    const double c = cos(degrees * acos(-1.0) / 180.0), s = sin(degrees * acos(-1.0) / 180.0);
    char text[2048];
    float numbers[20];
    static const int corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int k = 0; k < 4; k++) {
        numbers[3 * k] = (float)(side * corners[k][0]);
        numbers[3 * k + 1] = (float)(side * corners[k][1]);
        numbers[3 * k + 2] = 0.0f;
        const double u = (mirrored ? -units : units) * corners[k][0], v = units * (1 - corners[k][1]);
        numbers[12 + 2 * k] = (float)(c * u + s * v);
        numbers[12 + 2 * k + 1] = (float)(c * v - s * u);
    }
    file_make("quad.bin", numbers, sizeof numbers);
    int size = snprintf(
        text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"materials\":[{\"name\":\"cloth\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
        "\"TEXCOORD_0\":1},\"mode\":6,\"material\":0}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
        "\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[%.9g,%.9g,0]},{\"bufferView\":1,\"componentType\":5126,"
        "\"count\":4,\"type\":\"VEC2\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,"
        "\"byteOffset\":48,\"byteLength\":32}],\"buffers\":[{\"byteLength\":80,\"uri\":\"quad.bin\"}]}",
        side, side);
    file_make(path, text, (size_t)size);
}

static void quad_make(const char *path, double side, double units, bool mirrored) {
    rotated_quad_make(path, side, units, mirrored, 0.0);
}

/* Whatever the mesh and its coordinates, the threads that are seen are as many as in a quad whose units are metres. */
static void threads_have_their_size_on_any_mesh(void **state) {
    (void)state;
    static const struct {
        double side, units;
        bool mirrored;
    } meshes[] = {{0.02, 0.02, false}, {0.02, 1.0, false}, {0.02, 0.3, true}, {0.02, 7.5, false}, {0.02, 1e-3, true}};
    double first = 0.0;
    for (size_t k = 0; k < sizeof meshes / sizeof *meshes; k++) {
        quad_make("quad.gltf", meshes[k].side, meshes[k].units, meshes[k].mirrored);
        /* 20 threads a centimetre, every fourth white: 10 stripes over 2 cm */
        Ran ran = RUN("render", "quad.gltf", "--weave", "plain; warp 1w 3k; weft 1k; sett 20", "--width", "240",
                      "--height", "24", "--spp", "64", "--env", "1", "--quiet", "--camera",
                      "0.01,0.01,1;0.01,0.01,0;0.11", "-o", "threads.npy");
        if (ran.code != 0) fail_msg("%s", ran.err);
        ran_free(&ran);
        WeftImage image;
        assert_int_equal(weft_image_read("threads.npy", &image, NULL, NULL), WEFT_OK);
        const float *p = image.pixels;
        double mean = 0.0;
        int crossings = 0;
        for (int x = 20; x < 220; x++)
            for (int y = 8; y < 16; y++) mean += (double)p[image.channels * (y * image.width + x) + 1] / (200.0 * 8.0);
        bool was = false;
        for (int x = 20; x < 220; x++) {
            double column = 0.0;
            for (int y = 8; y < 16; y++) column += (double)p[image.channels * (y * image.width + x) + 1] / 8.0;
            const bool is = column > mean;
            crossings += x > 20 && is != was;
            was = is;
        }
        weft_image_free(&image);
        print_message("%g units over %g m: %d edges of stripes\n", meshes[k].units, meshes[k].side, crossings);
        if (k == 0) first = crossings;
        assert_true(first >= 10.0 && fabs(crossings - first) <= 2.0);
    }
}

/* Renders satin near by with an engine, and reads the picture. */
static WeftImage satin(const char *engine, const char *rotation) {
    WeftImage image;
    char set[64];
    snprintf(set, sizeof set, "cloth.weave.rotation=%s", rotation);
    Ran ran = RUN("render", "quad.gltf", "--weave", "satin 5/2; warp 3#c0a040 1#203080; weft 1#802020; sett 12",
                  "--set", "cloth.weave.warp=silk", "--set", set, "--engine", engine, "--occlusion", "0", "--light",
                  "sun;-1,-0.4,-1;3,3,3", "--env", "0.2", "--width", "96", "--height", "96", "--quiet", "--camera",
                  "0.014,0.006,0.05;0.01,0.01,0;14", "-o", "satin.npy");
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
    assert_int_equal(weft_image_read("satin.npy", &image, NULL, NULL), WEFT_OK);
    return image;
}

/* Returns the mean difference of two pictures as a part of the first one's mean. */
static double satins_differ(WeftImage a, WeftImage b) {
    const float *p = a.pixels, *q = b.pixels;
    double sum = 0.0, mean = 0.0;
    for (int k = 0; k < a.width * a.height * a.channels; k++)
        sum += fabs((double)p[k] - (double)q[k]), mean += (double)p[k];
    return sum / mean;
}

/* A weave that is turned as the texture coordinates are lies as it did before, with its threads and its highlight. */
static void a_rotated_weave_lies_as_it_says(const char *engine) {
    rotated_quad_make("quad.gltf", 0.02, 0.02, false, 0.0);
    WeftImage straight = satin(engine, "0"), askew = satin(engine, "33");
    rotated_quad_make("quad.gltf", 0.02, 0.02, false, 33.0);
    WeftImage back = satin(engine, "33"), other = satin(engine, "-33");
    print_message("%s: turned with its coordinates %.4f, turned alone %.3f, turned the other way %.3f\n", engine,
                  satins_differ(straight, back), satins_differ(straight, askew), satins_differ(straight, other));
    assert_true(satins_differ(straight, back) < 0.02);
    assert_true(satins_differ(straight, askew) > 0.1);
    assert_true(satins_differ(straight, other) > 0.1);
    weft_image_free(&straight);
    weft_image_free(&askew);
    weft_image_free(&back);
    weft_image_free(&other);
}

static void weaves_rotate_in_the_path_tracer(void **state) {
    (void)state;
    a_rotated_weave_lies_as_it_says("trace");
}

/* Skips where there is no OpenGL. */
static void need_gl(void) {
    Ran ran = RUN("render", "builtin:ball", "--engine", "raster", "--width", "8", "--height", "8", "-o", "probe.npy");
    const bool gl = ran.code == 0;
    ran_free(&ran);
    if (!gl) skip();
}

static void weaves_rotate_in_the_raster_engine(void **state) {
    (void)state;
    need_gl();
    a_rotated_weave_lies_as_it_says("raster");
}

/* Renders 2 m of a flat cloth from afar under an even sky, and returns its mean colour. */
static void seen_from_afar(const char *option, const char *material, double mean[3]) {
    quad_make("quad.gltf", 2.0, 2.0, false);
    Ran ran = RUN("render", "quad.gltf", option, material, "--width", "24", "--height", "24", "--spp", "64", "--env",
                  "1", "--quiet", "--camera", "1,1,3;1,1,0;20", "-o", "afar.npy");
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
    WeftImage image;
    assert_int_equal(weft_image_read("afar.npy", &image, NULL, NULL), WEFT_OK);
    const float *p = image.pixels;
    const int count = image.width * image.height;
    for (int c = 0; c < 3; c++) mean[c] = 0.0;
    for (int k = 0; k < count; k++)
        for (int c = 0; c < 3; c++) mean[c] += (double)p[image.channels * k + c] / (double)count;
    weft_image_free(&image);
}

/* Denim shows 10 to 18 % of its weft, and its colour from afar has the hue of the warp, and the chroma (the largest channel
 * less the smallest, linear) of a cloth all of warp times the share of the warp that is seen. */
static void denim_is_as_blue_as_its_warp(void **state) {
    (void)state;
    static const char all_warp[] =
        "{\"weave\": {\"draft\": \"twill 3/1 z; both 1#28385c; sett 26 18\", \"warp\": {\"yarn\": \"cotton\", \"dye\": "
        "0.3, \"slub\": 0.5, \"slub_length\": 40, \"width\": 1.3, \"bulge\": 0.5, \"barre\": 0.2, \"barre_width\": "
        "40}, "
        "\"weft\": {\"yarn\": \"cotton\", \"dye\": 0.05, \"width\": 0.95}}}";
    WeftScene *scene;
    WeftMaterial material;
    double denim[3], warp[3];
    assert_int_equal(weft_scene_load("builtin:cloth", &scene, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_scene_assign_material(scene, "Cloth", "preset:woven-denim", NULL, NULL), WEFT_OK);
    assert_int_equal(weft_scene_material(scene, 0, &material, NULL), WEFT_OK);
    const WeftClothInfo info = weft_scene_cloth_info(scene, material.cloth);
    weft_scene_free(scene);
    file_make("warp.json", all_warp, sizeof all_warp - 1);
    seen_from_afar("--preset", "woven-denim", denim);
    seen_from_afar("--material", "warp.json", warp);
    const double chroma = denim[2] - denim[0], expected = (double)info.share[WEFT_WARP] * (warp[2] - warp[0]),
                 hue = (denim[1] - denim[0]) / chroma, warp_hue = (warp[1] - warp[0]) / (warp[2] - warp[0]);
    print_message("weft seen %.3f, chroma %.4f of %.4f, hue %.3f of %.3f\n", (double)info.share[WEFT_WEFT], chroma,
                  expected, hue, warp_hue);
    assert_true(info.share[WEFT_WEFT] >= 0.10f && info.share[WEFT_WEFT] <= 0.18f);
    assert_true(fabs(chroma / expected - 1.0) <= 0.1);
    assert_true(fabs(hue - warp_hue) <= 0.1); /* of a sextant of the circle */
}

/* A folder that has the name of a weave is no draft. */
static void names_in_the_folder_do_not_disturb(void **state) {
    (void)state;
    assert_int_equal(mkdir("plain", 0700), 0);
    Ran ran = RUN("render", "builtin:ball", "--weave", "ball=twill 2/2", "--set", "ball.weave.warp=silk", "--set",
                  "ball.weave.draft=plain", "--save", "plain.json");
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
    assert_int_equal(rmdir("plain"), 0);
}

static void wrong_keys_are_refused_in_one_line(void **state) {
    (void)state;
    static const char *const bad[][2] = {{"*.weave.sett=a", "WARP,WEFT"},
                                         {"*.weave.sett=0", "sett"},
                                         {"*.weave.colour=1", "warp.color"},
                                         {"*.weave.warp.foo=1", "foo"},
                                         {"*.weave.rotation=a", "rotation"},
                                         {"*.weave.rotation=361", "rotation"},
                                         {"*.weave.metres=0", "metres"},
                                         {"*.weave.metres=big", "metres"},
                                         {"*.weave.draft=nothing", "nothing"},
                                         {"*.weave.warp=nettle", "nettle"},
                                         {"*.weave.seed=-1", "seed"},
                                         {"*.weave={\"a\":1}", "not a key"},
                                         {"*.weave.warp.color=2,0,0", "color"},
                                         {"*.weave={", "JSON"},
                                         {"*.weave.warp.color=#12", "color"},
                                         {"*.weave.seed=1.5", "whole number"},
                                         {"*.weave.warp.yarn=nettle", "nettle"},
                                         {"*.base_color=#12345", "#rrggbb"},
                                         {"*.weave.scale=2", "did you mean metres?"},
                                         {"*.weave.EPI=20", "did you mean sett?"},
                                         {"*.weave={\"draft\":\"plain\",\"scale\":2}", "did you mean metres?"},
                                         {"*.weave.draft=none.wif", "words such as twill 2/2 need no file"},
                                         {"nobody.weave.seed=1", "nobody"}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        Ran ran = RUN("render", "builtin:ball", "--set", bad[k][0], "-o", "no.png");
        if (ran.code == 0 || !one_complaint(ran.err) || !strstr(ran.err, bad[k][1]) || strstr(ran.err, "material file"))
            fail_msg("%s: %d: %s", bad[k][0], ran.code, ran.err);
        ran_free(&ran);
    }
}

/* Returns the picture of a ball under two settings, of which warnings must say what they are told to, or nothing if that is
 * NULL. */
static WeftImage ball_of(const char *first, const char *second, const char *said) {
    WeftImage image;
    Ran ran = RUN("render", "ball.glb", "--width", "40", "--height", "30", "--spp", "2", "-o", "drawn.npy", "--set",
                  first, "--set", second);
    if (ran.code != 0 || (said ? !strstr(ran.err, said) : strstr(ran.err, "warning") != NULL))
        fail_msg("%s %s: %s", first, second, ran.err);
    ran_free(&ran);
    assert_int_equal(weft_image_read("drawn.npy", &image, NULL, NULL), WEFT_OK);
    return image;
}

static void colours_and_yarns_have_two_spellings(void **state) {
    (void)state;
    static const char *const ways[][2][2] = {{{"ball.base_color=#80bc00", "ball.roughness=0.6"},
                                              {"ball.base_color=0.2158605,0.5028865,0", "ball.roughness=0.6"}},
                                             {{"ball.weave.draft=twill 2/2", "ball.weave.warp.yarn=silk"},
                                              {"ball.weave.draft=twill 2/2", "ball.weave.warp=silk"}}};
    asset_make();
    for (int k = 0; k < 2; k++) {
        WeftImage a = ball_of(ways[k][0][0], ways[k][0][1], NULL), b = ball_of(ways[k][1][0], ways[k][1][1], NULL);
        assert_true(satins_differ(a, b) < 1e-5);
        weft_image_free(&a);
        weft_image_free(&b);
    }
}

static void settings_without_effect_on_a_weave_are_told(void **state) {
    (void)state;
    asset_make();
    WeftImage idle = ball_of("ball.weave=plain", "ball.base_color=#a02030", "weave.warp.color"),
              sheen = ball_of("ball.weave=plain", "ball.sheen_color=#a02030", NULL);
    weft_image_free(&idle);
    weft_image_free(&sheen);
    WeftImage reset = ball_of("ball.weave=plain", "ball.base_color=0.8", NULL);
    weft_image_free(&reset);
    scene_make(); /* a triangle without texture coordinates */
    Ran ran = RUN("render", "scene.gltf", "--weave", "cloth=plain", "--width", "8", "--height", "8", "--spp", "1", "-o",
                  "no.npy");
    if (ran.code != 0 || !strstr(ran.err, "no texture coordinates")) fail_msg("%s", ran.err);
    ran_free(&ran);
}

/* Renders a ball of a material file with an engine. said: a warning of its threads is due. */
static WeftImage woven_ball(const char *file, const char *engine, bool said) {
    WeftImage image;
    Ran ran = RUN("render", "builtin:ball", "--material", file, "--engine", engine, "--width", "24", "--height", "24",
                  "--spp", "4", "-o", "woven.npy");
    if (ran.code != 0 || (strstr(ran.err, "threads are no glass") != NULL) != said) fail_msg("%s", ran.err);
    ran_free(&ran);
    assert_int_equal(weft_image_read("woven.npy", &image, NULL, NULL), WEFT_OK);
    return image;
}

/* A woven material with a transmission is drawn as one without, and weft says so. */
static void woven_is_no_glass(const char *engine) {
    static const char glass[] =
        "{\"weave\": {\"draft\": \"plain\"}, \"diffuse_transmission\": 0.5, \"transmission\": 1}",
                      plain[] = "{\"weave\": {\"draft\": \"plain\"}, \"diffuse_transmission\": 0.5}";
    file_make("glass.json", glass, sizeof glass - 1);
    file_make("plain.json", plain, sizeof plain - 1);
    WeftImage a = woven_ball("ball=plain.json", engine, false), b = woven_ball("ball=glass.json", engine, true);
    assert_true(satins_differ(a, b) < 1e-5);
    weft_image_free(&a);
    weft_image_free(&b);
}

static void woven_is_no_glass_in_the_path_tracer(void **state) {
    (void)state;
    woven_is_no_glass("trace");
}

static void woven_is_no_glass_in_the_raster_engine(void **state) {
    (void)state;
    need_gl();
    woven_is_no_glass("raster");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(cloth_is_the_same_by_every_way),
                                       cmocka_unit_test(threads_have_their_size_on_any_mesh),
                                       cmocka_unit_test(weaves_rotate_in_the_path_tracer),
                                       cmocka_unit_test(weaves_rotate_in_the_raster_engine),
                                       cmocka_unit_test(names_in_the_folder_do_not_disturb),
                                       cmocka_unit_test(denim_is_as_blue_as_its_warp),
                                       cmocka_unit_test(colours_and_yarns_have_two_spellings),
                                       cmocka_unit_test(settings_without_effect_on_a_weave_are_told),
                                       cmocka_unit_test(woven_is_no_glass_in_the_path_tracer),
                                       cmocka_unit_test(woven_is_no_glass_in_the_raster_engine),
                                       cmocka_unit_test(wrong_keys_are_refused_in_one_line)};
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
