/* Shader text in a folder is taken when it changes; broken text leaves the picture as it was, and is
 * complained about with its file and line */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "raster/gl.h"
#include "raster/material/shader_watch.h"
#include "scratch.h"
#include "weft/weft.h"

static char base[SCRATCH_SIZE];
static char folder[64], lobe_path[128]; /* folder is not there at first */

static int begin(void **state) {
    if (!scratch_make(base)) return -1;
    return gl_begin(state);
}

static int end(void **state) {
    (void)state;
    return scratch_remove(base) ? 0 : -1;
}

static void make_folder(const char *below) {
    char path[256];
    snprintf(path, sizeof path, "%s%s", folder, below);
    assert_int_equal(mkdir(path, 0700), 0);
}

static void write_text(const char *path, const char *text) {
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0);
    assert_int_equal(fclose(stream), 0);
}

/* The file of lambert with other text in the place of some; returns that line. */
static int write_lobe(const char *from, const char *to) {
    const char *text = weft_catalogue_text("lobes/lambert.h"), *at = strstr(text, from);
    int line = 1;
    assert_non_null(at);
    char *edited = calloc(strlen(text) + strlen(to) + 1, 1);
    assert_non_null(edited);
    sprintf(edited, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    write_text(lobe_path, edited);
    free(edited);
    for (const char *c = text; c < at; c++) line += *c == '\n';
    return line;
}

static const WeftRasterView small = {
    .width = 64, .height = 36, .samples = 1, .background = WEFT_BACKGROUND_COLOR, .no_shadows = 1};

static WeftImage draw(WeftRaster *raster) {
    WeftImage image = {0};
    WeftError error = {0};
    if (weft_raster_draw(raster, &small, &error) != WEFT_OK || weft_raster_image(raster, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return image;
}

static double brightness(const WeftImage *image) {
    double sum = 0.0;
    for (int k = 0; k < 4 * image->width * image->height; k++) sum += (double)((float *)image->pixels)[k];
    return sum;
}

static bool is_same(const WeftImage *a, const WeftImage *b) {
    return memcmp(a->pixels, b->pixels, (size_t)a->width * (size_t)a->height * 4 * sizeof(float)) == 0;
}

static void assert_draws(WeftRaster *raster, const WeftImage *expected) {
    WeftImage image = draw(raster);
    assert_true(is_same(&image, expected));
    weft_image_free(&image);
}

/* The complaint is about that line of the lobe. */
static void assert_place(const char *complaint, int line) {
    char place[256];
    snprintf(place, sizeof place, "%s:%d: ", lobe_path, line);
    if (strncmp(complaint, place, strlen(place)) != 0) fail_msg("not at line %d: %s", line, complaint);
}

static WeftScene *load_scene(void) {
    WeftScene *scene;
    WeftError error;
    const WeftLight sun = {.direction = {-1.0f, -2.0f, -1.0f}, .color = {3.0f, 3.0f, 3.0f}};
    if (weft_scene_load("builtin:spheres", &scene, NULL, &error) != WEFT_OK ||
        weft_scene_set(scene, "*.base_color", "0.5", NULL, &error) != WEFT_OK || /* one shader for all */
        weft_scene_set(scene, "*.roughness", "0.5", NULL, &error) != WEFT_OK ||
        weft_scene_set(scene, "*.sheen_color", "0", NULL, &error) != WEFT_OK ||
        weft_scene_set(scene, "*.sheen_roughness", "0.5", NULL, &error) != WEFT_OK ||
        weft_scene_add_light(scene, &sun, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return scene;
}

static void text_is_taken_anew(WeftGl gl) {
    WeftRaster *raster, *other;
    WeftError error = {0};
    WeftScene *scene = load_scene();
    snprintf(folder, sizeof folder, "%s/text-%d", base, (int)gl);
    snprintf(lobe_path, sizeof lobe_path, "%s/shading/lobes/lambert.h", folder);
    const WeftRasterDesc desc = {.gl = gl, .shader_dir = folder};
    if (weft_raster_create(scene, &desc, &raster, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    WeftImage plain = draw(raster); /* a folder that is not there */
    assert_int_equal(weft_raster_refresh(raster), 0);

    make_folder("");
    make_folder("/shading");
    make_folder("/shading/lobes");
    assert_int_equal(weft_raster_refresh(raster), 0);
    write_lobe("1.0f / PI", "2.0f / PI");
    assert_int_equal(weft_raster_refresh(raster), 1);
    WeftImage bright = draw(raster);
    assert_true(brightness(&bright) > 1.01 * brightness(&plain));
    assert_string_equal(weft_raster_info(raster).complaint, "");
    int compiled = weft_raster_info(raster).compiled;
    assert_int_equal(weft_raster_refresh(raster), 0);
    assert_draws(raster, &bright);
    assert_int_equal(weft_raster_info(raster).compiled, compiled);

    static const char *const broken[] = {"1.0f / / PI", "nothing(a) / PI", "\"one\" / PI"};
    for (int k = 0; k < 3; k++) {
        int line = write_lobe("1.0f / PI", broken[k]);
        assert_int_equal(weft_raster_refresh(raster), 1);
        for (int again = 0; again < 2; again++) {
            assert_draws(raster, &bright);
            assert_place(weft_raster_info(raster).complaint, line);
            assert_int_equal(weft_raster_refresh(raster), 0);
        }
        print_message("as expected: %s\n", weft_raster_info(raster).complaint);
        if (k) continue;
        /* nothing is there to draw with */
        if (weft_raster_create(scene, &desc, &other, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        assert_int_equal(weft_raster_draw(other, &small, &error), WEFT_INPUT);
        assert_int_equal(error.message, WEFT_MESSAGE_GL_COMPILE);
        assert_place(error.text, line);
        weft_raster_free(other);
    }
    write_lobe("1.0f / PI", "2.0f / PI /* mended */");
    assert_int_equal(weft_raster_refresh(raster), 1);
    assert_draws(raster, &bright);
    assert_string_equal(weft_raster_info(raster).complaint, "");

    assert_int_equal(unlink(lobe_path), 0);
    assert_int_equal(weft_raster_refresh(raster), 1);
    assert_draws(raster, &plain);
    assert_string_equal(weft_raster_info(raster).complaint, "");
    weft_image_free(&plain);
    weft_image_free(&plain);
    weft_image_free(&bright);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

static void changed_shader_text_is_compiled_by_opengl(void **state) {
    (void)state;
    need_gl();
    text_is_taken_anew(WEFT_GL_DESKTOP);
}

static void changed_shader_text_is_compiled_by_opengl_es(void **state) {
    (void)state;
    need_gl();
    text_is_taken_anew(WEFT_GL_ES);
}

static void raster_without_a_shader_folder_changes_nothing(void **state) {
    (void)state;
    need_gl();
    WeftRaster *raster;
    WeftError error;
    WeftScene *scene = load_scene();
    assert_int_equal(weft_raster_create(scene, &(WeftRasterDesc){0}, &raster, NULL, &error), WEFT_OK);
    assert_int_equal(weft_raster_refresh(raster), 0);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

static void in_folder(const char *name, char path[256]) { snprintf(path, 256, "%s/%s", folder, name); }

static int look(FolderWatch *watch) { return watch_poll(watch, folder); }

/* Only text counts; links and folders without end do no harm. */
static void folder_watch_counts_changed_files(void **state) {
    (void)state;
    FolderWatch watch = {0};
    char path[256], to[256];
    snprintf(folder, sizeof folder, "%s/look", base);
    assert_int_equal(look(&watch), 0);
    make_folder("");
    make_folder("/a");
    static const char *const files[] = {"a/one.h", "a/two.glsl", "three.h", "a/note.txt", "a/.hidden.h", "a/one.h~"};
    for (int k = 0; k < 6; k++) {
        in_folder(files[k], path);
        write_text(path, "float a;\n");
    }
    assert_int_equal(look(&watch), 3);
    assert_int_equal(look(&watch), 0);
    in_folder("a/one.h", path);
    write_text(path, "float ab;\n");
    in_folder("a/note.txt", path);
    write_text(path, "none");
    assert_int_equal(look(&watch), 1);
    in_folder("a/two.glsl", path);
    in_folder("a/four.glsl", to);
    assert_int_equal(rename(path, to), 0);
    assert_int_equal(look(&watch), 2); /* one less, one more */
    in_folder("a/circle", path);
    assert_int_equal(symlink("..", path), 0);
    assert_true(look(&watch) > 0);
    assert_int_equal(look(&watch), 0);
    watch_free(&watch);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(changed_shader_text_is_compiled_by_opengl),
        cmocka_unit_test(changed_shader_text_is_compiled_by_opengl_es),
        cmocka_unit_test(raster_without_a_shader_folder_changes_nothing),
        cmocka_unit_test(folder_watch_counts_changed_files),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
