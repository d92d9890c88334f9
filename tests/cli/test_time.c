/* --time and --animation: a sheet that crosses the picture in two seconds, in both engines; and what they refuse. */
#include "run.h"

#include "weft/image.h"

static const char asset[] =
    "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":92,\"uri\":\"data:application/octet-stream;base64,"
    "AAAAvwAAAL8AAAAAAAAAPwAAAL8AAAAAAAAAvwAAAD8AAAAAAAAAPwAAAD8AAAAAAAABAAIAAgABAAMAAAAAAAAAAEAAAADAAAAA"
    "AAAAAAAAAABAAAAAAAAAAAA="
    "\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":12},"
    "{\"buffer\":0,\"byteOffset\":60,\"byteLength\":8},{\"buffer\":0,\"byteOffset\":68,\"byteLength\":24}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
    "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"
    "{\"bufferView\":2,\"componentType\":5126,\"count\":2,\"type\":\"SCALAR\"},"
    "{\"bufferView\":3,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],\"nodes\":[{\"mesh\":0}],"
    "\"animations\":[{\"name\":\"wait\",\"channels\":[],\"samplers\":[]},{\"name\":\"cross\",\"channels\":[{"
    "\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}}],\"samplers\":[{\"input\":2,\"output\":3}]}]}";

enum { WIDTH = 96, HEIGHT = 32 };

/* The mean column of what is not transparent. */
static float column_of(const char *path) {
    WeftImage image;
    WeftError error = {0};
    if (weft_image_read(path, &image, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(image.width, WIDTH);
    assert_int_equal(image.channels, 4);
    float sum = 0.0f, weight = 0.0f;
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        const float alpha = (float)((const unsigned char *)image.pixels)[4 * k + 3];
        sum += alpha * ((float)(k % WIDTH) + 0.5f);
        weight += alpha;
    }
    weft_image_free(&image);
    assert_true(weight > 0.0f);
    return sum / weight;
}

/* The camera sees 6 m across at the sheet: 16 pixels are a metre. */
static void sheet_is_where_it_is_at_that_time(void **state) {
    (void)state;
    static const struct {
        const char *time, *animation;
        float column;
    } cases[] = {{"--time=0", "--animation=cross", 16},
                 {"--time=0.5", "--animation=cross", 32},
                 {"--time=2", "--animation=1", 80},
                 {"--time=9", "--animation=cross", 80},
                 {"--time=1.5", "--animation=wait", 48}};
    static const char *const engines[] = {"--engine=trace", "--engine=raster"};
    file_make("crossing.gltf", asset, sizeof asset - 1);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        for (size_t e = 0; e < 2; e++) {
            Ran ran = RUN("render", "crossing.gltf", cases[k].time, cases[k].animation, engines[e], "--spp=16",
                          "--width=96", "--height=32", "--camera=0,0,10;0,0,0;11.4212", "--background=transparent",
                          "--quiet", "-o", "moment.png");
            if (ran.code != 0 || ran.err[0]) fail_msg("exit %d: %s", ran.code, ran.err);
            ran_free(&ran);
            const float column = column_of("moment.png");
            if (!(column > cases[k].column - 0.5f && column < cases[k].column + 0.5f))
                fail_msg("%s %s %s: column %g, not %g", cases[k].time, cases[k].animation, engines[e], (double)column,
                         (double)cases[k].column);
        }
}

static void times_that_there_are_not_are_refused_in_one_line(void **state) {
    (void)state;
    static const struct {
        const char *arguments[3];
        int code;
        const char *part;
    } cases[] = {
        {{"crossing.gltf", "--animation=cross"}, 2, "--animation: needs --time"},
        {{"crossing.gltf", "--time=soon"}, 2, "--time"},
        {{"crossing.gltf", "--time=nan"}, 2, "--time"},
        {{"crossing.gltf", "--time=1", "--animation=fly"}, 3, "animation \"fly\"; there are 0 wait, 1 cross"},
        {{"builtin:ball", "--time=1"}, 3, "it has no animation"},
    };
    file_make("crossing.gltf", asset, sizeof asset - 1);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *const *a = cases[k].arguments;
        Ran ran = RUN("render", "-o", "none.png", "--quiet", a[0], a[1], a[2]);
        if (ran.code != cases[k].code || !one_complaint(ran.err) || !strstr(ran.err, cases[k].part))
            fail_msg("exit %d: %s", ran.code, ran.err);
        ran_free(&ran);
    }
    /* Without --time it opens at rest, and says that it could move. */
    Ran ran = RUN("render", "crossing.gltf", "--width=16", "--height=16", "--spp=1", "-o", "rest.png");
    if (ran.code != 0 || !strstr(ran.err, "animations: shown at rest; --time SECONDS shows a moment"))
        fail_msg("exit %d: %s", ran.code, ran.err);
    ran_free(&ran);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sheet_is_where_it_is_at_that_time),
        cmocka_unit_test(times_that_there_are_not_are_refused_in_one_line),
    };
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
