/* What a newcomer does, by mouse alone: opens an asset, weaves it of a weaver's WIF with a red weft, and saves a path-traced
 * picture of it.
 *
 * Labels: slow unsanitized */
#include "drive.h"

#include "weft/save.h"

/* A chair's seat: a square of a metre whose texture coordinates go from 0 to 2.5, so that a unit spans 0.4 m. */
static void seat_make(void) {
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"materials\":[{\"name\":\"Seat\",\"doubleSided\":true}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":0}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":6,\"type\":\"VEC3\","
        "\"min\":[-0.5,-0.5,0],\"max\":[0.5,0.5,0]},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":6,\"type\":\"VEC2\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":72},{\"buffer\":0,\"byteOffset\":72,\"byteLength\":48}],"
        "\"buffers\":[{\"byteLength\":120,\"uri\":\"seat.bin\"}]}";
    static const float corners[30] = {-0.5f, -0.5f, 0.0f, 0.5f, -0.5f, 0.0f,  0.5f, 0.5f, 0.0f, -0.5f,
                                      -0.5f, 0.0f,  0.5f, 0.5f, 0.0f,  -0.5f, 0.5f, 0.0f, 0.0f, 2.5f,
                                      2.5f,  2.5f,  2.5f, 0.0f, 0.0f,  2.5f,  2.5f, 0.0f, 0.0f, 0.0f};
    file_make("seat.bin", corners, sizeof corners);
    file_make("seat.gltf", text, sizeof text - 1);
}

/* A weaver's twill 1/3, in which the weft shows: 12 threads to the centimetre. */
static void draft_make(void) {
    static const char text[] =
        "[WIF]\nVersion=1.1\nDate=April 20, 1997\nDevelopers=wif@mhsoft.com\nSource Program=a loom\n"
        "[CONTENTS]\nCOLOR PALETTE=yes\nCOLOR TABLE=yes\nWEAVING=yes\nWARP=yes\nWEFT=yes\nTHREADING=yes\nTIEUP=yes\n"
        "TREADLING=yes\n[COLOR PALETTE]\nEntries=2\nForm=RGB\nRange=0,255\n[COLOR TABLE]\n1=20,20,30\n2=230,220,200\n"
        "[WEAVING]\nShafts=4\nTreadles=4\nRising Shed=yes\n"
        "[WARP]\nThreads=4\nColor=1\nUnits=centimeters\nSpacing=0.0833\n"
        "[WEFT]\nThreads=4\nColor=2\nUnits=centimeters\nSpacing=0.0833\n"
        "[THREADING]\n1=1\n2=2\n3=3\n4=4\n[TIEUP]\n1=1\n2=2\n3=3\n4=4\n[TREADLING]\n1=1\n2=2\n3=3\n4=4\n";
    file_make("twill.wif", text, sizeof text - 1);
}

/* The clicks from the open scene to the picture; samples: a share of the slider. */
static void say_story(const char *draft, const char *samples) {
    script_begin();
    say("wait rest\nwindow 1-open.png\nclick Material/Weave\nwait 3\nclick \"Material/Draft ...\"\nwait 4\n");
    say("click \"Choose a draft/%s\"\nwindow 2-draft.png\nclick \"Choose a draft/Open\"\nwait rest\n", draft);
    say("click \"Material/yarn of weft\"\nwait 3\nclick \"Material/weft red\"\nwait 3\nwait rest\nwindow 3-red.png\n");
    say("click Menu/File\nwait 3\nclick \"Menu/File/Save a picture ...\"\nwait 4\nclick \"Save a picture/path "
        "traced\"\n");
    say("wait 2\nslide \"Save a picture/samples\" %s\nwait 2\nwindow 4-save.png\nclick \"Save a picture/Save\"\n",
        samples);
    say("wait message samples\nwindow 5-done.png\n");
}

static void mean_of(const char *path, double mean[3]) {
    WeftImage image = picture_read(path);
    const int channels = image.channels;
    int count = 0;
    for (int c = 0; c < 3; c++) mean[c] = 0.0;
    for (int y = image.height * 2 / 5; y < image.height * 3 / 5; y++)
        for (int x = image.width * 2 / 5; x < image.width * 3 / 5; x++, count++)
            for (int c = 0; c < 3; c++)
                mean[c] += ((const unsigned char *)image.pixels)[(y * image.width + x) * channels + c];
    for (int c = 0; c < 3; c++) mean[c] /= (double)count;
    weft_image_free(&image);
}

/* Asserts that the middle of a picture, which may have some of the paper behind it, is `much` as red as green and blue. */
static void assert_red(const char *picture, double much) {
    double mean[3];
    mean_of(picture, mean);
    if (!(mean[0] > much * mean[1] && mean[0] > much * mean[2] && mean[0] > 40.0))
        fail_msg("%s: %g %g %g", picture, mean[0], mean[1], mean[2]);
}

static void a_seat_is_woven_of_a_draft_in_red_by_mouse_alone(void **state) {
    (void)state;
    need_gl();
    seat_make();
    draft_make();
    say_story("twill.wif", "0.004");
    say("save woven.glb\nwait message wrote woven.glb\n");
    const double start = clock_now();
    drive_through(script, LIST(UNSEEN, "seat.gltf"));
    const double seconds = clock_now() - start;
    print_message("%.0f s\n", seconds);
    assert_true(seconds < 120.0);
    assert_red("seat-weft.png", 1.5);
    /* Threads have their size: a unit of texture coordinates spans 0.4 m, and there are 12 threads to the centimetre. */
    WeftScene *scene;
    WeftMaterial material;
    WeftError error;
    if (weft_scene_load("woven.glb", &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_scene_material(scene, 0, &material, &error), WEFT_OK);
    const WeftClothInfo info = weft_scene_cloth_info(scene, material.cloth);
    assert_true(info.automatic && fabs((double)info.metres - 0.4) < 1e-3);
    for (int t = 0; t < 2; t++) assert_true(fabs((double)info.sett[t] - 12.0) < 0.1);
    weft_scene_free(scene);
}

static void a_sofa_is_woven_of_a_draft_in_red_by_mouse_alone(void **state) {
    (void)state;
    need_gl();
    char sofa[1024], draft[1024];
    const char *folder = getenv("WEFT_DATA");
    if (!folder || !*folder) folder = WEFT_SOURCE_DIR "/../shared/data";
    snprintf(sofa, sizeof sofa, "%s/gltf/GlamVelvetSofa.glb", folder);
    snprintf(draft, sizeof draft, "%s/weave/2229.wif", folder);
    size_t size;
    char *bytes = file_bytes(draft, &size);
    if (!bytes || access(sofa, R_OK) != 0) {
        free(bytes);
        print_message("%s is not there (WEFT_DATA can name another folder)\n", sofa);
        skip();
    }
    file_make("weaver.wif", bytes, size);
    free(bytes);
    say_story("weaver.wif", "0.002");
    const double start = clock_now();
    drive_through(script, LIST(UNSEEN, sofa));
    const double seconds = clock_now() - start;
    print_message("%.0f s\n", seconds);
    assert_true(seconds < 120.0);
    assert_red("GlamVelvetSofa-weft.png", 1.3);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_seat_is_woven_of_a_draft_in_red_by_mouse_alone),
                                       cmocka_unit_test(a_sofa_is_woven_of_a_draft_in_red_by_mouse_alone)};
    return cmocka_run_group_tests_name("view/story", tests, drive_begin, drive_end);
}
