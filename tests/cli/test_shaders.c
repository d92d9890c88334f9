/* `weft render --shader-dir`: broken text ends with one line that names its file and line */
#include "run.h"

#include <sys/stat.h>

#include "weft/weft.h"

#define DRAW(folder)                                                                                                   \
    LIST("render", "scene.gltf", "--engine", "raster", "--width", "32", "--height", "24", "--quiet", "-o", "a.png",    \
         "--shader-dir", folder)

static const char path[] = "text/shading/lobes/lambert.h";

static int begin(void **state) {
    return scene_begin(state) == 0 && mkdir("text", 0700) == 0 && mkdir("text/shading", 0700) == 0 &&
                   mkdir("text/shading/lobes", 0700) == 0
               ? 0
               : -1;
}

static int end(void **state) {
    unlink(path);
    return rmdir("text/shading/lobes") == 0 && rmdir("text/shading") == 0 && rmdir("text") == 0 ? work_end(state) : -1;
}

static void need_gl(void) {
    Ran ran = run_with(NULL, DRAW("nowhere")); /* no such folder: nothing to take from it */
    bool none = ran.code == 4 && strstr(ran.err, weft_message_text(WEFT_MESSAGE_GL_CONTEXT));
    if (none) print_message("%s", ran.err);
    if (!none && ran.code != 0) fail_msg("exit %d: %s", ran.code, ran.err);
    ran_free(&ran);
    if (none) skip();
}

/* The library's text with other words in one place, in words where that is: "PATH:LINE: ". */
static void write_broken(const char *from, const char *to, char place[64]) {
    const char *text = weft_catalogue_text("lobes/lambert.h"), *at = strstr(text, from);
    int line = 1;
    assert_non_null(at);
    for (const char *c = text; c < at; c++) line += *c == '\n';
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fprintf(stream, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from)) > 0);
    assert_int_equal(fclose(stream), 0);
    snprintf(place, 64, "weft: %s:%d: ", path, line);
}

static void broken_shader_text_is_an_error_with_its_line(void **state) {
    (void)state;
    static const char *const changes[][2] = {{"1.0f / PI", "1.0f +"},
                                             {"1.0f / PI", "\"one\""},
                                             {"FN LobeValue lambert_value", "#pragma\nFN LobeValue lambert_value"}};
    char place[64];
    need_gl();
    file_make("a.png", "old", 3);
    for (int k = 0; k < 3; k++) {
        write_broken(changes[k][0], changes[k][1], place);
        assert_complaint(NULL, DRAW("text"), 3, place);
    }
    assert_true(same_bytes("a.png", "old", 3));
    write_broken("1.0f / PI", "(1.0f / PI)", place);
    Ran ran = run_with(NULL, DRAW("text"));
    if (ran.code != 0 || ran.err[0]) fail_msg("exit %d: %s", ran.code, ran.err);
    ran_free(&ran);
    assert_false(same_bytes("a.png", "old", 3));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(broken_shader_text_is_an_error_with_its_line)};
    return cmocka_run_group_tests(tests, begin, end);
}
