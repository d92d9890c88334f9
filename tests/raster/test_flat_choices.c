/* The flat text of each seventh value of every choice, in long runs of all, draws the picture of the text as it is
 * written, and so does that of woven cloth, near and from afar.
 *
 * Labels: slow unsanitized */
#include "raster/flat.h"

static void flat_texts_of_choices_draw_the_same_pictures(void **state) {
    (void)state;
    need_gl();
    expect_same_pictures_of_choices(test_long() ? 1 : 7);
}

static void flat_texts_of_woven_cloth_draw_the_same_pictures(void **state) {
    (void)state;
    need_gl();
    static const char *const setts[] = {"1", "40"}; /* threads per centimetre: near and afar */
    for (size_t k = 0; k < sizeof setts / sizeof setts[0]; k++) {
        WeftScene *scene = flat_spheres();
        flat_set(scene, "*.weave.sett", setts[k]);
        expect_same_pictures(scene, k % 2 ? WEFT_GL_DESKTOP : WEFT_GL_ES, setts[k]);
        weft_scene_free(scene);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(flat_texts_of_choices_draw_the_same_pictures),
                                       cmocka_unit_test(flat_texts_of_woven_cloth_draw_the_same_pictures)};
    return cmocka_run_group_tests(tests, flat_begin, flat_end);
}
