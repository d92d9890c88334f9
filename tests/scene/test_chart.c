/* The chart of reference materials: that its numbers agree with each other, and that the limits of the
 * warnings hold all of it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "scene/record/scene.h"
#include "shading/stack/workflow.h"
#include "weft/weft.h"

static void chart_entries_are_complete_and_their_numbers_agree(void **state) {
    (void)state;
    int metals = 0, others = 0;
    const WeftChartEntry *e;
    for (int k = 0; (e = weft_chart(k)); k++) {
        *(e->kind == WEFT_CHART_METAL ? &metals : &others) += 1;
        assert_true(e->name[0] && e->help && e->source[0]);
        for (int j = 0; j < k; j++) assert_string_not_equal(weft_chart(j)->name, e->name);
        for (int c = 0; c < 3; c++) {
            assert_in_range((int)(1e6f * e->base_color[c]), 1, 1000000);
            assert_in_range((int)(1e6f * e->f0[c]), 1, 1000000);
            if (e->kind == WEFT_CHART_METAL) {
                assert_true(e->f0[c] == e->base_color[c]);
                continue;
            }
            float r = (e->ior - 1.0f) / (e->ior + 1.0f);
            assert_float_equal(e->f0[c], r * r, 1e-6f);
            assert_true(e->f0[c] == e->f0[0]);
        }
    }
    assert_null(weft_chart(-1));
    assert_true(metals >= 12 && others >= 15);
}

static double brightness(const WeftChartEntry *e) {
    bool clear = e->kind == WEFT_CHART_CLEAR || e->kind == WEFT_CHART_GEM;
    const float *c = clear ? e->f0 : e->base_color;
    return 0.2126 * (double)c[0] + 0.7152 * (double)c[1] + 0.0722 * (double)c[2];
}

static void chart_entries_go_from_dark_to_bright(void **state) {
    (void)state;
    const WeftChartEntry *e, *before = weft_chart(0);
    for (int k = 1; (e = weft_chart(k)); k++) {
        assert_true(e->kind >= before->kind);
        if (e->kind == before->kind && brightness(e) < brightness(before))
            fail_msg("%s is darker than %s", e->name, before->name);
        before = e;
    }
}

static void hear(void *user, WeftMessage message, const char *text) {
    (void)message;
    fprintf(stderr, "%s\n", text);
    ++*(int *)user;
}

static void set(WeftMaterial *material, const char *name, const char *value) {
    WeftError error;
    if (weft_material_set(material, name, value, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

static void set_color(WeftMaterial *material, const char *name, const float color[3]) {
    char value[64];
    snprintf(value, sizeof value, "%.9g,%.9g,%.9g", (double)color[0], (double)color[1], (double)color[2]);
    set(material, name, value);
}

static void set_number(WeftMaterial *material, const char *name, float number) {
    char value[32];
    snprintf(value, sizeof value, "%.9g", (double)number);
    set(material, name, value);
}

/* The entry as a workflow has it; an undyed clear one gets a grey diffuse colour, as dyed cloth has one. */
static void wear(WeftMaterial *material, const WeftChartEntry *e, const char *workflow) {
    static const float black[3] = {0.0f, 0.0f, 0.0f}, grey[3] = {0.3f, 0.3f, 0.3f};
    bool metal = e->kind == WEFT_CHART_METAL, specular = strcmp(workflow, "specular") == 0;
    weft_material_default(material);
    set(material, "workflow", workflow);
    set_color(material, "base_color", metal && specular ? black : e->kind == WEFT_CHART_CLEAR ? grey : e->base_color);
    if (specular) {
        set_color(material, "specular_color", e->f0);
        return;
    }
    set_number(material, "metallic", metal ? 1.0f : 0.0f);
    if (metal) return;
    if (strcmp(workflow, "disney") == 0)
        set_number(material, "specular", e->f0[0] / 0.08f);
    else
        set_number(material, "ior", e->ior);
}

static void chart_entries_other_than_gems_are_plausible(void **state) {
    (void)state;
    static const char *const workflows[] = {"metallic", "disney", "specular"};
    const WeftChartEntry *e;
    for (int k = 0; (e = weft_chart(k)); k++)
        for (int w = 0; e->kind != WEFT_CHART_GEM && w < 3; w++) {
            int heard = 0;
            WeftMaterial material;
            wear(&material, e, workflows[w]);
            weft_material_plausible(&material, e->name, &(WeftLog){hear, &heard});
            if (heard) fail_msg("%s in workflow %s", e->name, workflows[w]);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chart_entries_go_from_dark_to_bright),
        cmocka_unit_test(chart_entries_are_complete_and_their_numbers_agree),
        cmocka_unit_test(chart_entries_other_than_gems_are_plausible),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
