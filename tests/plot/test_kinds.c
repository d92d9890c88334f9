/* Every kind of figure of every lobe and of every profile: valid and not empty.
 *
 * Labels: unsanitized */
#include "plot/cloth.h"

/* Pixels with a colour, and how many different ones there are up to a limit. */
typedef struct Ink {
    int colored, different;
} Ink;

static Ink ink_of(const WeftImage *image) {
    enum { MOST = 200 };
    Ink ink = {0, 0};
    uint32_t seen[MOST];
    const uint8_t *p = image->pixels;
    for (int k = 0; k < image->width * image->height; k++, p += 3) {
        int high = p[0] > p[1] ? p[0] : p[1], low = p[0] < p[1] ? p[0] : p[1];
        high = p[2] > high ? p[2] : high, low = p[2] < low ? p[2] : low;
        ink.colored += high - low > 40;
        uint32_t word = (uint32_t)p[0] << 16 | (uint32_t)p[1] << 8 | p[2];
        int at = 0;
        while (at < ink.different && seen[at] != word) at++;
        if (at == ink.different && at < MOST) seen[ink.different++] = word;
    }
    return ink;
}

static void assert_drawn(WeftPlotDesc desc, const char *name) {
    WeftImage image;
    WeftError error;
    desc.quick = 1;
    desc.width = 420;
    if (weft_plot_image(&desc, &image, &error) != WEFT_OK) fail_msg("%s: %s", name, error.text);
    assert_int_equal(image.width, 420);
    assert_int_equal(image.channels, 3);
    Ink ink = ink_of(&image);
    /* spheres and slices of white lobes are grey */
    bool grey = desc.kind == WEFT_PLOT_SLICE || desc.kind == WEFT_PLOT_SPHERE;
    if (grey ? ink.different < 60 : ink.colored < 80 || ink.different < 20)
        fail_msg("%s %s: %d colours, %d pixels with colour", weft_plot_kind_name((int)desc.kind), name, ink.different,
                 ink.colored);
    weft_image_free(&image);
}

/* Finite numbers, of which not all are the same. */
static void assert_numbers(WeftPlotDesc desc, const char *name) {
    desc.quick = 1;
    WeftPlotData data = data_of(&desc);
    assert_true(data.count > 0);
    for (int p = 0; p < data.count; p++) {
        const WeftPlotPanel *panel = &data.panels[p];
        int numbers = 0;
        for (int s = 0; s < panel->series_count; s++)
            for (int k = 0; k < panel->series[s].count; k++) {
                float y = panel->series[s].y[k];
                assert_true(!isinf(y));
                numbers += isfinite(y) && y >= 0.0f;
            }
        for (int k = 0; panel->values && k < panel->columns * panel->rows * panel->channels; k++) {
            assert_true(!isinf(panel->values[k]));
            numbers += isfinite(panel->values[k]);
        }
        if (numbers < 4) fail_msg("%s %s: panel %d has no numbers", data.title, name, p);
        if (panel->form == WEFT_PLOT_CURVES || panel->form == WEFT_PLOT_ROSE)
            assert_true(panel->y.high > panel->y.low && isfinite(panel->y.high));
    }
    weft_plot_data_free(&data);
}

/* Returns true for every fifth lobe, unless it walks at random: a map takes seconds. */
static bool lights_a_map(const WeftLobe *lobe) {
    return lobe->lobe % 5 == 0 && !is_long(WEFT_PLOT_AMBIENT) &&
           !(weft_lobe_info(lobe->lobe)->traits & WEFT_LOBE_REFERENCE);
}

static void every_kind(const Cloth *cloth, const Cloth *other, const char *name) {
    for (int kind = 0; kind < WEFT_PLOT_KINDS; kind++) {
        if (kind == WEFT_PLOT_SAMPLES && !cloth->model.lobe) continue;
        if (kind == WEFT_PLOT_AMBIENT && !(cloth->model.lobe && lights_a_map(cloth->model.lobe))) continue;
        const WeftPlotModel models[2] = {cloth->model, other->model};
        const WeftPlotDesc desc = {
            .kind = (WeftPlotKind)kind, .models = models, .count = kind == WEFT_PLOT_DIFFERENCE ? 2 : 1};
        assert_drawn(desc, name);
        /* what takes longest is looked at as a picture alone */
        if (kind == WEFT_PLOT_POLAR || kind == WEFT_PLOT_CARTESIAN || kind == WEFT_PLOT_SLICE ||
            kind == WEFT_PLOT_DIFFERENCE)
            assert_numbers(desc, name);
    }
}

/* Under sanitizers every fifth will do. */
static int stride(void) { return getenv("WEFT_TEST_SHORT") ? 5 : 1; }

static void every_kind_of_every_lobe_is_drawn(void **state) {
    (void)state;
    Cloth ggx = {.reflection = NULL};
    cloth_of_lobe(&ggx, "ggx", NULL, NULL);
    for (int k = 0; k < weft_lobe_count(); k += stride()) {
        Cloth cloth = {.reflection = NULL};
        const char *id = weft_lobe_info(k)->id;
        cloth_of_lobe(&cloth, id, "color", "0.9,0.5,0.1");
        Cloth *other = strcmp(id, "ggx") == 0 ? NULL : &ggx;
        Cloth lambert = {.reflection = NULL};
        cloth_of_lobe(&lambert, "lambert", NULL, NULL);
        every_kind(&cloth, other ? other : &lambert, id);
        cloth_free(&lambert);
        cloth_free(&cloth);
    }
    cloth_free(&ggx);
}

static void every_kind_of_every_profile_is_drawn(void **state) {
    (void)state;
    Cloth ggx = {.reflection = NULL};
    int profiles = 0;
    while (weft_profile_name(profiles)) profiles++;
    cloth_of_lobe(&ggx, "ggx", NULL, NULL);
    for (int k = 0; k < profiles; k += stride()) {
        Cloth cloth = {.reflection = NULL};
        cloth_of_profile(&cloth, weft_profile_name(k));
        every_kind(&cloth, &ggx, weft_profile_name(k));
        cloth_free(&cloth);
    }
    cloth_free(&ggx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_of_every_lobe_is_drawn),
        cmocka_unit_test(every_kind_of_every_profile_is_drawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
