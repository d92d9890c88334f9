/* A raster lets go of what nothing draws with any more: memory does not grow with every term that was tried.
 *
 * Sanitizers keep what is freed, so memory is measured without them; what is drawn here, other tests draw under them.
 *
 * Labels: slow unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#include "gl.h"
#include "weft/weft.h"

/* The sanitizers keep what is freed. */
#if defined(__SANITIZE_ADDRESS__)
enum { SANITIZED = 1 };
#elif defined(__has_feature)
enum { SANITIZED = __has_feature(address_sanitizer) };
#else
enum { SANITIZED = 0 };
#endif

/* MiB. */
static double resident(void) {
    long pages = 0, held = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%ld %ld", &pages, &held) != 2) held = 0;
    if (file) fclose(file);
    return (double)held * (double)sysconf(_SC_PAGESIZE) / 1048576.0;
}

typedef struct Switches {
    WeftScene *scene;
    WeftRaster *raster;
    int done, wanted, scale; /* scale: of a picture of 320 x 180 */
    double most;             /* MiB, after any of them */
} Switches;

static void draw(Switches *self) {
    const WeftRasterView view = {.width = 320 * self->scale, .height = 180 * self->scale};
    WeftError error;
    if (weft_raster_update(self->raster, NULL, &error) != WEFT_OK ||
        weft_raster_draw(self->raster, &view, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    weft_raster_finish(self->raster);
    self->done++;
    self->most = fmax(self->most, resident());
}

/* Each value of each choice, and back. */
static void switch_choices(Switches *self, const char *material) {
    char target[128];
    for (int c = 0; weft_material_choice_name(c) && self->done < self->wanted; c++) {
        snprintf(target, sizeof target, "%s.%s", material, weft_material_choice_name(c));
        for (int v = 0; weft_material_choice_value(c, v) && self->done < self->wanted; v++) {
            if (!weft_material_choice_fits(c, v)) continue;
            if (weft_scene_set(self->scene, target, weft_material_choice_value(c, v), NULL, NULL) == WEFT_OK)
                draw(self);
        }
        weft_scene_set(self->scene, target, "auto", NULL, NULL);
    }
}

static void switch_presets(Switches *self) {
    for (int k = 0; weft_preset_name(k) && self->done < self->wanted; k++) {
        char name[128];
        snprintf(name, sizeof name, "preset:%s", weft_preset_name(k));
        if (weft_scene_assign_material(self->scene, NULL, name, NULL, NULL) == WEFT_OK) draw(self);
    }
}

static Switches begin(int wanted, int scale) {
    Switches self = {.wanted = wanted, .scale = scale};
    WeftError error;
    assert_int_equal(weft_scene_load("builtin:cloth", &self.scene, NULL, &error), WEFT_OK);
    assert_int_equal(weft_raster_create(self.scene, &(WeftRasterDesc){.no_cache = 1}, &self.raster, NULL, &error),
                     WEFT_OK);
    return self;
}

static void end(Switches *self) {
    weft_raster_free(self->raster);
    weft_scene_free(self->scene);
}

static void holds_at_most(const Switches *self, double most) {
    double held = resident();
    print_message("%.0f MiB after %d switches, %.0f at most between\n", held, self->done, self->most);
    if (!SANITIZED && held > most) fail_msg("more than %.0f", most);
}

static void programs_in_use_stay_few(void **state) {
    (void)state;
    need_gl();
    Switches self = begin(10, 1);
    switch_choices(&self, "Cloth");
    WeftRasterInfo info = weft_raster_info(self.raster);
    if (!(info.compiled > 10 && info.programs <= 10))
        fail_msg("%d programs of %d compiled", info.programs, info.compiled);
    holds_at_most(&self, 250.0); /* 211 by llvmpipe, unoptimised and with its cache empty */
    end(&self);
}

/* A picture that would have to wait for a compiler is known beforehand. */
static void picture_is_ready_once_its_programs_are(void **state) {
    (void)state;
    need_gl();
    Switches self = begin(1, 1);
    const WeftRasterView view = {.width = 64, .height = 36, .samples = 1},
                         number = {.width = 64, .height = 36, .samples = 1, .part = WEFT_PART_NORMAL};
    assert_false(weft_raster_ready(self.raster, &number));
    assert_int_equal(weft_raster_draw(self.raster, &number, NULL), WEFT_OK);
    assert_true(weft_raster_ready(self.raster, &number));
    assert_false(weft_raster_ready(self.raster, &view));
    int compiled = weft_raster_info(self.raster).compiled;
    assert_int_equal(weft_raster_draw(self.raster, &number, NULL), WEFT_OK);
    assert_int_equal(weft_raster_info(self.raster).compiled, compiled);
    end(&self);
}

static void two_hundred_switches_stay_within_300_mib(void **state) {
    (void)state;
    need_gl();
    if (!getenv("WEFT_TEST_LONG")) skip();
    Switches self = begin(200, 4);
    switch_choices(&self, "Cloth");
    switch_presets(&self);
    for (int k = 0; self.done < self.wanted && k < 8; k++) switch_choices(&self, "Cloth");
    holds_at_most(&self, 300.0);
    end(&self);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(programs_in_use_stay_few),
        cmocka_unit_test(picture_is_ready_once_its_programs_are),
        cmocka_unit_test(two_hundred_switches_stay_within_300_mib),
    };
    return cmocka_run_group_tests(tests, gl_begin, NULL);
}
