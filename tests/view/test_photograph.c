/* A photograph beside the picture, behind a line and over it; it grows with the picture, and keeps its colours.
 *
 * Labels: slow unsanitized */
#include "drive.h"

enum { RED = 200, GREEN = 30, BLUE = 60 };

static void photograph_make(const char *path, int width, int height, float linear) {
    WeftImage image;
    WeftError error;
    assert_int_equal(
        weft_image_create(width, height, 3, linear > 0.0f ? WEFT_PIXEL_F32 : WEFT_PIXEL_U8, &image, &error), WEFT_OK);
    for (int k = 0; k < width * height; k++)
        if (linear > 0.0f) {
            for (int c = 0; c < 3; c++) ((float *)image.pixels)[3 * k + c] = linear;
        } else {
            unsigned char *p = (unsigned char *)image.pixels + 3 * k;
            p[0] = RED, p[1] = GREEN, p[2] = BLUE;
        }
    if (weft_image_write(path, &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_image_free(&image);
}

/* The colour of the window at a place, pixels. */
static void color_at(const char *window, double x, double y, int color[3]) {
    WeftImage image = picture_read(window);
    assert_true(x >= 0.0 && y >= 0.0 && x < image.width && y < image.height);
    const unsigned char *p = image.pixels;
    for (int c = 0; c < 3; c++) color[c] = p[(int)x * image.channels + (int)y * image.width * image.channels + c];
    weft_image_free(&image);
}

static bool is_photograph(const int c[3]) { return c[0] == RED && c[1] == GREEN && c[2] == BLUE; }

#define CHOOSE "wait rest\nclick Menu/Compare\nwait 2\nclick \"Menu/Compare/Photograph ...\"\nwait 4\n"

/* The panel is 372 pixels wide, so that the picture has 268; beside a photograph it has the left half of these. */
static void a_photograph_is_seen_beside_behind_a_line_and_over_the_picture(void **state) {
    (void)state;
    need_gl();
    photograph_make("photo.png", 400, 300, 0.0f);
    script_begin();
    say(CHOOSE "click \"Choose a photograph/photo.png\"\nclick \"Choose a photograph/Open\"\nwait 4\nwait rest\n");
    say("window beside.png\nwait rest\nclick Panel/View\nwait 3\nclick View/place/Line\nwait rest\nwindow line.png\n");
    say("drag left 0.5 0.3 0.8 0.3\nwait rest\nwindow dragged.png\nclick View/place/Over\nwait rest\n");
    say("set View/opacity 1\nwait rest\nwindow over.png\nset View/opacity 0.5\nwait rest\nwindow half.png\n");
    say("set View/opacity 0\nwait rest\nwindow none.png\n");
    drive_through(script, LIST(UNSEEN, CHEAP));
    static const struct {
        const char *window;
        double x;
        bool photograph;
    } places[] = {{"beside.png", 200, true}, {"beside.png", 60, false},   {"line.png", 160, true},
                  {"line.png", 110, false},  {"dragged.png", 160, false}, {"dragged.png", 240, true},
                  {"over.png", 100, true},   {"none.png", 100, false}};
    int c[3], half[3], none[3];
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        color_at(places[k].window, places[k].x, 210, c);
        if (is_photograph(c) != places[k].photograph)
            fail_msg("%s at %g: %d %d %d", places[k].window, places[k].x, c[0], c[1], c[2]);
    }
    color_at("over.png", 100, 210, c);
    color_at("half.png", 100, 210, half);
    color_at("none.png", 100, 210, none);
    for (int k = 0; k < 3; k++) assert_true(abs(2 * half[k] - c[k] - none[k]) <= 3);
}

/* Returns the size of the photograph, and how large it can be in the picture, in the last state before a window ends. */
static void size_after(const char *text, double size[2], double *fits) {
    Drive drive = drive_start(text, LIST(UNSEEN, CHEAP));
    size[0] = size[1] = 0.0;
    for (bool ended = false; !ended;) {
        ended = drive_ended(&drive);
        for (json_t *now; (now = drive_next(&drive)); json_decref(now)) {
            const json_t *box = json_object_get(now, "photograph_box"), *stage = json_object_get(now, "stage");
            *fits =
                fmin(json_number_value(json_array_get(stage, 2)), json_number_value(json_array_get(stage, 3)) * 4 / 3);
            for (int k = 0; k < 2; k++) size[k] = json_number_value(json_array_get(box, (size_t)k + 2));
        }
        if (!ended) sleep_seconds(0.02);
    }
    drive_finish(&drive);
}

static void a_photograph_grows_as_the_camera_comes_nearer(void **state) {
    (void)state;
    need_gl();
    photograph_make("photo.png", 400, 300, 0.0f);
    double is[2], nearer[2], fixed[2], over[2], fits;
#define USE                                                                                                            \
    "wait rest\ndrop photo.png\nwait 4\nclick \"Use a picture/As photograph\"\nwait 4\nwait rest\nclick Panel/View\n"
    size_after(USE "wait seconds 1\nwait rest\n", is, &fits);
    size_after(USE "move 0.5 0.5\nwheel 2\nwait seconds 1\nwait rest\n", nearer, &fits);
    size_after(USE "click \"View/Zoom with the camera\"\nmove 0.5 0.5\nwheel 2\nwait seconds 1\nwait rest\n", fixed,
               &fits);
    if (!(is[0] > 100.0 && fabs(is[0] / is[1] - 400.0 / 300.0) < 0.03)) fail_msg("%g x %g", is[0], is[1]);
    const double grown = nearer[0] / is[0], due = 1.0 / (0.88 * 0.88);
    if (fabs(grown - due) > 0.02 * due) fail_msg("%g, not %g", grown, due);
    assert_true(fabs(fixed[0] - is[0]) <= 1.0);
    /* Over the picture the camera stands elsewhere than beside it, since its picture is wider: nothing has come nearer. */
    size_after(USE "wait rest\nclick View/place/Over\nwait seconds 1\nwait rest\n", over, &fits);
    if (fabs(over[0] - fits) > 2.0) fail_msg("%g, where %g fits", over[0], fits);
}

/* A linear photograph is exposed like the picture, and a file that is none is a line. */
static void linear_photographs_have_the_exposure_of_the_picture(void **state) {
    (void)state;
    need_gl();
    photograph_make("light.exr", 64, 64, 0.05f);
    file_make("none.png", "no picture", 10);
    script_begin();
    say(CHOOSE "click \"Choose a photograph/light.exr\"\nclick \"Choose a photograph/Open\"\nwait 4\nwait rest\n");
    say("window dim.png\nclick Panel/View\nwait 3\nset View/exposure 2\nwait rest\nwait seconds 1\nwindow light.png\n");
    say("click \"View/Choose a photograph ...\"\nwait 4\nclick \"Choose a photograph/none.png\"\n");
    say("click \"Choose a photograph/Open\"\nwait message none.png\nwait rest\nwindow none.png.png\n");
    drive_through(script, LIST(UNSEEN, CHEAP));
    int dim[3], light[3];
    color_at("dim.png", 200, 210, dim);
    color_at("light.png", 200, 210, light);
    if (!(light[0] > dim[0] + 50 && dim[0] > 20)) fail_msg("%d and %d", dim[0], light[0]);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_photograph_is_seen_beside_behind_a_line_and_over_the_picture),
                                       cmocka_unit_test(a_photograph_grows_as_the_camera_comes_nearer),
                                       cmocka_unit_test(linear_photographs_have_the_exposure_of_the_picture)};
    return cmocka_run_group_tests_name("view/photograph", tests, drive_begin, drive_end);
}
