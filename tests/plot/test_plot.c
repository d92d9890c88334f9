/* Figures: their numbers are the library's; files are valid and the same twice; what makes no sense is
 * refused. */
#include <unistd.h>

#include "base/pi.h"
#include "plot/cloth.h"
#include "scratch.h"

static const double degree = RADIANS;

/* Black is drawn as nothing: what is drawn is the lobe. */
static void figure_of_a_black_lobe_is_empty(void **state) {
    (void)state;
    Cloth white = {.reflection = NULL}, black = {.reflection = NULL};
    cloth_of_lobe(&white, "charlie-neubelt", NULL, NULL);
    cloth_of_lobe(&black, "charlie-neubelt", "color", "0");
    for (int kind = 0; kind < WEFT_PLOT_KINDS; kind++) {
        if (is_long(kind)) continue;
        if (kind == WEFT_PLOT_FURNACE || kind == WEFT_PLOT_SAMPLES) continue; /* white and pdf are what they show */
        WeftImage image[2];
        for (int k = 0; k < 2; k++) {
            const WeftPlotModel models[2] = {k ? black.model : white.model, black.model};
            const WeftPlotDesc desc = {.kind = (WeftPlotKind)kind,
                                       .models = models,
                                       .count = kind == WEFT_PLOT_DIFFERENCE ? 2 : 1,
                                       .quick = 1,
                                       .width = 420,
                                       .height = 240};
            assert_int_equal(weft_plot_image(&desc, &image[k], NULL), WEFT_OK);
        }
        int differ = 0;
        for (int k = 0; k < 420 * 240; k++)
            differ += memcmp((uint8_t *)image[0].pixels + 3 * k, (uint8_t *)image[1].pixels + 3 * k, 3) != 0;
        if (differ < 200) fail_msg("%s: %d pixels differ", weft_plot_kind_name(kind), differ);
        for (int k = 0; k < 2; k++) weft_image_free(&image[k]);
    }
    cloth_free(&white);
    cloth_free(&black);
}

/* Numbers. */

static float luminance(const float c[3]) { return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]; }

static float f_of(const Cloth *cloth, double theta_o, double theta_i, double phi_i) {
    const float wo[3] = {(float)sin(theta_o * degree), 0.0f, (float)cos(theta_o * degree)};
    const float wi[3] = {(float)(sin(theta_i * degree) * cos(phi_i * degree)),
                         (float)(sin(theta_i * degree) * sin(phi_i * degree)), (float)cos(theta_i * degree)};
    float f[3];
    weft_lobe_eval(&cloth->lobe, wo, wi, f);
    return luminance(f);
}

static void assert_near(double a, double b, double share) {
    if (!(fabs(a - b) <= share * fabs(b) + 1e-6)) fail_msg("%.7g is not %.7g", a, b);
}

static void curves_hold_values_of_the_lobe(void **state) {
    (void)state;
    Cloth cloth = {.reflection = NULL};
    cloth_of_lobe(&cloth, "ggx", "color", "0.9,0.4,0.2");
    WeftPlotDesc desc = {.models = &cloth.model, .count = 1, .views = {40.0f}, .view_count = 1};
    for (int kind = 0; kind < 2; kind++) {
        desc.kind = kind ? WEFT_PLOT_POLAR : WEFT_PLOT_CARTESIAN;
        WeftPlotData data = data_of(&desc);
        assert_int_equal(data.count, 2);
        float top = 0.0f;
        for (int p = 0; p < 2; p++) {
            const WeftPlotSeries *series = &data.panels[p].series[0];
            assert_int_equal(data.panels[p].series_count, 1);
            for (int k = 0; k < series->count; k++) {
                double theta = (double)series->x[k];
                assert_true(k == 0 || series->x[k] >= series->x[k - 1]);
                double want = (double)f_of(&cloth, 40.0, theta, kind && p ? 90.0 : 180.0);
                assert_near((double)series->y[k], want * (!kind && p ? cos(theta * degree) : 1.0), 2e-3);
                if (p == 0) top = fmaxf(top, series->y[k]);
            }
        }
        /* the mirror direction is among them, and no axis cuts a lone lobe off */
        assert_near((double)top, (double)f_of(&cloth, 40.0, 40.0, 180.0), 0.05);
        assert_true(data.panels[0].y.high >= top);
        weft_plot_data_free(&data);
    }
    cloth_free(&cloth);
}

static void axes_fit_the_range_of_the_curves(void **state) {
    (void)state;
    Cloth cloth[2] = {{.reflection = NULL}, {.reflection = NULL}};
    cloth_of_lobe(&cloth[0], "ggx", "alpha", "0.01");
    cloth_of_lobe(&cloth[1], "lambert", NULL, NULL);
    const WeftPlotModel models[2] = {cloth[0].model, cloth[1].model};
    WeftPlotDesc desc = {.kind = WEFT_PLOT_CARTESIAN, .models = models, .count = 2};
    WeftPlotData data = data_of(&desc); /* a peak of thousands does not flatten what is beside it */
    assert_true(data.panels[0].y.high < 4.0f && data.panels[0].y.high > 0.318f);
    weft_plot_data_free(&data);
    WeftError error; /* but one that is ten times as high is seen whole */
    weft_reflection_free(cloth[0].reflection);
    cloth[0].lobe.params[0] = 0.25f;
    assert_int_equal(weft_reflection_of_lobe(&cloth[0].lobe, &cloth[0].reflection, &error), WEFT_OK);
    const WeftPlotModel both[2] = {{.reflection = cloth[0].reflection}, cloth[1].model};
    desc.models = both;
    data = data_of(&desc);
    float top = 0.0f;
    for (int k = 0; k < data.panels[0].series[0].count; k++) top = fmaxf(top, data.panels[0].series[0].y[k]);
    assert_true(top > 3.0f && data.panels[0].y.high >= top);
    weft_plot_data_free(&data);
    weft_reflection_free(cloth[0].reflection);
    cloth[0].lobe.params[0] = 0.01f;
    assert_int_equal(weft_reflection_of_lobe(&cloth[0].lobe, &cloth[0].reflection, &error), WEFT_OK);
    const WeftPlotModel again[2] = {{.reflection = cloth[0].reflection}, cloth[1].model};
    desc.models = again;
    desc.logarithmic = 1;
    data = data_of(&desc);
    assert_true(data.panels[0].y.logarithmic && data.panels[0].y.low > 0.0f && data.panels[0].y.high >= 1000.0f);
    weft_plot_data_free(&data);
    desc.count = 1;
    desc.logarithmic = 0;
    data = data_of(&desc);
    assert_true(data.panels[0].y.high > 1000.0f);
    weft_plot_data_free(&data);
    for (int k = 0; k < 2; k++) cloth_free(&cloth[k]);
}

static void albedo_and_furnace_are_those_of_the_library(void **state) {
    (void)state;
    Cloth cloth = {.reflection = NULL};
    cloth_of_lobe(&cloth, "charlie-neubelt", "alpha", "0.25");
    WeftPlotDesc desc = {.kind = WEFT_PLOT_ALBEDO, .models = &cloth.model, .count = 1, .quick = 1};
    WeftPlotData data = data_of(&desc);
    assert_int_equal(data.count, 2);
    for (int k = 0; k < data.panels[0].series[0].count; k++) {
        float e[3];
        weft_lobe_albedo(&cloth.lobe, (float)cos((double)data.panels[0].series[0].x[k] * degree), e);
        assert_near((double)data.panels[0].series[0].y[k], (double)luminance(e), 2e-3);
    }
    const WeftPlotSeries *rough = &data.panels[1].series[0];
    for (int k = 0; k < rough->count; k++) { /* alpha = roughness^2, at 60 degrees */
        WeftLobe other = cloth.lobe;
        float e[3];
        other.params[0] = rough->x[k] * rough->x[k];
        weft_lobe_albedo(&other, 0.5f, e);
        assert_near((double)rough->y[k], (double)luminance(e), 2e-3);
    }
    weft_plot_data_free(&data);
    desc.kind = WEFT_PLOT_FURNACE;
    data = data_of(&desc);
    int rules = 0;
    while (weft_layer_name(rules)) rules++;
    assert_int_equal(data.panels[0].series_count, rules);
    for (int s = 0; s < rules; s++) {
        const WeftPlotSeries *series = &data.panels[0].series[s];
        const char *rule = data.legend[series->entry];
        for (int k = 0; k < series->count; k++) {
            float e[3];
            weft_lobe_albedo(&cloth.lobe, (float)cos((double)series->x[k] * degree), e);
            /* additive: 1 + E; of the view's E: exactly 1 */
            if (strcmp(rule, "additive") == 0) assert_near((double)series->y[k], 1.0 + (double)e[0], 0.01);
            if (strcmp(rule, "albedo-view") == 0) assert_near((double)series->y[k], 1.0, 0.01);
        }
    }
    weft_plot_data_free(&data);
    cloth_free(&cloth);
}

static void maps_hold_values_of_the_lobe(void **state) {
    (void)state;
    Cloth cloth[2] = {{.reflection = NULL}, {.reflection = NULL}};
    cloth_of_lobe(&cloth[0], "burley", NULL, NULL);
    cloth_of_lobe(&cloth[1], "lambert", "color", "0.5");
    const WeftPlotModel models[2] = {cloth[0].model, cloth[1].model};
    WeftPlotDesc desc = {.kind = WEFT_PLOT_DIFFERENCE, .models = models, .count = 2};
    WeftPlotData data = data_of(&desc);
    const WeftPlotPanel *panel = &data.panels[0];
    double most = 0.0;
    for (int row = 0; row < panel->rows; row++)
        for (int k = 0; k < panel->columns; k++) {
            double theta_i = -90.0 + 180.0 * (k + 0.5) / panel->columns, theta_o = 90.0 * (row + 0.5) / panel->rows;
            double a = (double)f_of(&cloth[0], theta_o, theta_i, 180.0),
                   b = (double)f_of(&cloth[1], theta_o, theta_i, 180.0);
            assert_near((double)panel->values[row * panel->columns + k], a - b, 3e-3);
            assert_near((double)data.panels[1].values[row * panel->columns + k], (a - b) / fmax(a, b), 6e-3);
            most = fmax(most, fabs(a - b));
        }
    assert_string_equal(panel->figures[1].name, "most");
    assert_near(panel->figures[1].value, most, 3e-3);
    weft_plot_data_free(&data);

    desc.kind = WEFT_PLOT_SLICE;
    desc.logarithmic = 1;
    data = data_of(&desc);
    panel = &data.panels[1];
    assert_near((double)panel->values[panel->columns * 30 + 40], 0.5 / PI_DOUBLE, 1e-4);
    assert_int_equal(panel->channels, 1);
    weft_plot_data_free(&data);

    desc.kind = WEFT_PLOT_LOBE3D;
    desc.logarithmic = 0;
    desc.cosine = 1;
    data = data_of(&desc);
    panel = &data.panels[1];
    for (int row = 0; row + 1 < panel->rows; row++)
        assert_near((double)panel->values[row * panel->columns + 7],
                    0.5 / PI_DOUBLE * cos(90.0 * degree * row / (panel->rows - 1)), 1e-3);
    weft_plot_data_free(&data);

    desc.kind = WEFT_PLOT_SPHERE; /* where the light falls straight, half Lambert is half */
    data = data_of(&desc);
    float top = 0.0f;
    panel = &data.panels[1];
    for (int k = 0; k < panel->columns * panel->rows; k++) top = fmaxf(top, panel->values[3 * k]);
    assert_near((double)top, 0.5, 2e-3);
    assert_int_equal(panel->columns, panel->cell_count * panel->rows);
    weft_plot_data_free(&data);
    for (int k = 0; k < 2; k++) cloth_free(&cloth[k]);
}

static void plotted_samples_follow_their_pdf(void **state) {
    (void)state;
    Cloth cloth = {.reflection = NULL};
    cloth_of_lobe(&cloth, "ashikhmin-neubelt", NULL, NULL);
    const WeftPlotDesc desc = {
        .kind = WEFT_PLOT_SAMPLES, .models = &cloth.model, .count = 1, .views = {30.0f}, .view_count = 1};
    WeftPlotData data = data_of(&desc);
    float e[3];
    weft_lobe_albedo(&cloth.lobe, (float)cos(30.0 * degree), e);
    assert_near(data.panels[0].figures[1].value, (double)e[0], 5e-3); /* mean f cos / pdf */
    assert_true(data.panels[1].figures[0].value > 0.5 && data.panels[1].figures[0].value < 1.002);
    assert_true(data.panels[2].figures[0].value > 1e-4);
    const WeftPlotPanel *ratio = &data.panels[2];
    int counted = 0;
    for (int k = 0; k < ratio->columns * ratio->rows; k++) {
        if (isnan(ratio->values[k])) continue;
        counted++;
        assert_true(ratio->values[k] > 0.5f && ratio->values[k] < 1.5f);
    }
    assert_true(counted > 500);
    weft_plot_data_free(&data);
    cloth_free(&cloth);
}

/* Files. */

static char folder[SCRATCH_SIZE];

static char *file_bytes(const char *path, size_t *size) {
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    fseek(stream, 0, SEEK_END);
    *size = (size_t)ftell(stream);
    rewind(stream);
    char *bytes = calloc(*size + 1, 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, stream), *size);
    fclose(stream);
    unlink(path);
    return bytes;
}

/* Every element ends as it began, attributes are quoted, and no ampersand stands alone. */
static void assert_xml(const char *text) {
    char open[64][32];
    int depth = 0, elements = 0;
    for (const char *s = text; *s; s++) {
        if (*s == '&') assert_non_null(memchr(s, ';', 8));
        assert_true(*s != '>'); /* is passed over below */
        if (*s != '<') continue;
        const char *end = s + 1;
        char quote = 0;
        for (; *end && (quote || *end != '>'); end++) {
            if (quote ? *end == quote : *end == '"' || *end == '\'') quote = quote ? 0 : *end;
            assert_true(quote || *end != '<');
        }
        assert_true(*end == '>');
        char name[32] = "";
        size_t length = strcspn(s + 1 + (s[1] == '/'), " \n\t/>");
        assert_true(length < sizeof name);
        memcpy(name, s + 1 + (s[1] == '/'), length);
        if (s[1] == '/') {
            assert_true(depth > 0);
            assert_string_equal(open[--depth], name);
        } else if (s[1] != '?' && s[1] != '!' && end[-1] != '/') {
            assert_true(depth < 64);
            memcpy(open[depth++], name, sizeof name);
        }
        elements++;
        s = end;
    }
    assert_int_equal(depth, 0);
    assert_true(elements > 20);
}

static void figure_files_are_valid_and_repeatable(void **state) {
    (void)state;
    static const char *const suffixes[] = {"png", "svg", "pdf"};
    Cloth cloth = {.reflection = NULL};
    cloth_of_lobe(&cloth, "charlie-neubelt", NULL, NULL);
    cloth.model.label = "<velvet> & \"co\" \xff";
    for (int kind = 0; kind < WEFT_PLOT_KINDS; kind++)
        for (int s = 0; s < 3 && !is_long(kind); s++) {
            const WeftPlotModel models[2] = {cloth.model, cloth.model};
            const WeftPlotDesc desc = {.kind = (WeftPlotKind)kind,
                                       .models = models,
                                       .count = kind == WEFT_PLOT_DIFFERENCE ? 2 : 1,
                                       .quick = 1,
                                       .width = 320};
            char path[80], *bytes[2];
            size_t size[2];
            WeftError error;
            snprintf(path, sizeof path, "%s/figure.%s", folder, suffixes[s]);
            for (int k = 0; k < 2; k++) {
                if (weft_plot_write(&desc, path, &error) != WEFT_OK) fail_msg("%s", error.text);
                bytes[k] = file_bytes(path, &size[k]);
            }
            assert_int_equal(size[0], size[1]);
            if (memcmp(bytes[0], bytes[1], size[0]) != 0)
                fail_msg("%s: two .%s files differ", weft_plot_kind_name(kind), suffixes[s]);
            if (s == 0) assert_memory_equal(bytes[0], "\x89PNG\r\n", 6);
            if (s == 1) {
                assert_xml(bytes[0]);
                assert_null(strstr(bytes[0], "<velvet>"));
                assert_non_null(strstr(bytes[0], "<title>"));
            }
            if (s == 2) {
                assert_memory_equal(bytes[0], "%PDF-1.", 7);
                assert_memory_equal(bytes[0] + size[0] - 6, "%%EOF\n", 6);
            }
            for (int k = 0; k < 2; k++) free(bytes[k]);
        }
    cloth_free(&cloth);
}

static void report_page_refers_to_no_other_file(void **state) {
    (void)state;
    Cloth cloth[2] = {{.reflection = NULL}, {.reflection = NULL}};
    cloth_of_lobe(&cloth[0], "charlie-neubelt", NULL, NULL);
    cloth_of_profile(&cloth[1], "three");
    cloth[0].model.label = "<b>&";
    const WeftPlotModel models[2] = {cloth[0].model, cloth[1].model};
    const WeftPlotDesc desc = {.models = models, .count = 2, .quick = 1};
    char path[80];
    WeftError error;
    size_t size;
    snprintf(path, sizeof path, "%s/report.html", folder);
    if (weft_plot_report(&desc, path, &error) != WEFT_OK) fail_msg("%s", error.text);
    char *page = file_bytes(path, &size);
    assert_int_equal(strlen(page), size);
    assert_null(strstr(page, "<script"));
    assert_null(strstr(page, "http:"));
    assert_null(strstr(page, "https:"));
    assert_non_null(strstr(page, "default-src 'none'"));
    assert_null(strstr(page, "<b>"));
    assert_non_null(strstr(page, "&lt;b&gt;&amp;"));
    int images = 0;
    for (const char *at = page; (at = strstr(at, "src=\"")); at++, images++)
        assert_memory_equal(at, "src=\"data:image/", 16);
    assert_int_equal(images, WEFT_PLOT_KINDS);
    for (int kind = 0; kind < WEFT_PLOT_KINDS; kind++) {
        char alt[200];
        snprintf(alt, sizeof alt, "alt=\"%s: ", weft_plot_kind_help(kind));
        assert_non_null(strstr(page, alt));
    }
    free(page);
    for (int k = 0; k < 2; k++) cloth_free(&cloth[k]);
}

/* Refusals. */

/* A map of 64 x 32 pixels: white, with a strip of `bright` beyond it at the right; release with weft_image_free. */
static WeftImage map_of(float bright) {
    WeftImage map;
    assert_int_equal(weft_image_create(64, 32, 3, WEFT_PIXEL_F32, &map, NULL), WEFT_OK);
    float *p = map.pixels;
    for (int k = 0; k < 64 * 32; k++)
        for (int c = 0; c < 3; c++) p[3 * k + c] = k % 64 >= 44 && k % 64 < 48 ? 1.0f + bright : 1.0f;
    return map;
}

/* The errors of the ways of a quick figure, in the order of the enumeration of ways. */
enum { WEFTS, KHRONOS, FILAMENT, THREE, BABYLON, MATERIALX, OPENPBR, WAYS };
static void ambient_errors(const Cloth *cloth, const WeftImage *map, double error[WAYS]) {
    static const char *const names[WAYS] = {"weft",    "khronos",   "filament",       "three",
                                            "babylon", "materialx", "babylon-openpbr"};
    const WeftPlotDesc desc = {
        .kind = WEFT_PLOT_AMBIENT, .models = &cloth->model, .count = 1, .quick = 1, .environment = map};
    WeftPlotData data = data_of(&desc);
    assert_int_equal(data.count, 2);
    assert_int_equal(data.panels[0].figure_count, WAYS);
    assert_int_equal(data.panels[1].series_count, WAYS);
    for (int k = 0; k < WAYS; k++) {
        assert_string_equal(data.panels[0].figures[k].name, names[k]);
        assert_string_equal(data.legend[data.panels[1].series[k].entry], names[k]);
        error[k] = data.panels[0].figures[k].value;
        print_message("%s %s %.2f %%\n", cloth->model.label, names[k], error[k]);
    }
    weft_plot_data_free(&data);
}

/* Under an even map the light is E, in which engines err only by their own formulas of it. Under a strip of light, the
 * irradiance of the normal is far off for a rim, and weft's own way is nearest. */
static void light_of_a_map_is_near_by_weft_and_far_by_irradiance(void **state) {
    (void)state;
    Cloth fibres = {.reflection = NULL}, charlie = {.reflection = NULL};
    WeftImage even = map_of(0.0f), strip = map_of(60.0f);
    double error[WAYS];
    cloth_of_lobe(&fibres, "ltc-fibre", "alpha", "0.5");
    cloth_of_lobe(&charlie, "charlie-neubelt", "alpha", "0.25");
    ambient_errors(&fibres, &even, error);
    for (int k = KHRONOS; k <= MATERIALX; k++) assert_true(error[k] < 0.01);
    assert_true(error[WEFTS] < 2.0);
    assert_true(error[OPENPBR] > 10.0);
    ambient_errors(&charlie, &even, error);
    assert_true(error[THREE] > 1.0 && error[KHRONOS] < 0.01); /* a fit of E, and a lobe that is not its own */
    ambient_errors(&charlie, &strip, error);
    assert_true(error[THREE] > 25.0);
    for (int k = KHRONOS; k < WAYS; k++) assert_true(error[WEFTS] < 0.5 * error[k]);
    weft_image_free(&even);
    weft_image_free(&strip);
    cloth_free(&charlie);
    cloth_free(&fibres);
}

/* A map must have floats, all of them finite, and models must be lobes of which there is a table. */
static void ambient_without_sense_is_refused(void **state) {
    (void)state;
    Cloth walk = {.reflection = NULL}, whole = {.reflection = NULL}, cloth = {.reflection = NULL};
    WeftImage bytes, map = map_of(0.0f);
    WeftPlotDesc desc = {.kind = WEFT_PLOT_AMBIENT, .models = &cloth.model, .count = 1, .quick = 1};
    WeftPlotData data;
    WeftError error;
    cloth_of_lobe(&cloth, "charlie-neubelt", NULL, NULL);
    cloth_of_lobe(&walk, "fibre-walk", NULL, NULL);
    cloth_of_profile(&whole, "three");
    assert_int_equal(weft_image_create(8, 4, 3, WEFT_PIXEL_U8, &bytes, NULL), WEFT_OK);
    desc.environment = &bytes;
    assert_int_equal(weft_plot_data(&desc, &data, &error), WEFT_USAGE);
    assert_non_null(strstr(error.text, "floats"));
    ((float *)map.pixels)[7] = INFINITY;
    desc.environment = &map;
    assert_int_equal(weft_plot_data(&desc, &data, &error), WEFT_USAGE);
    assert_non_null(strstr(error.text, "not finite"));
    desc.models = &whole.model;
    assert_int_equal(weft_plot_data(&desc, &data, &error), WEFT_USAGE);
    assert_non_null(strstr(error.text, "only lobes"));
    desc.models = &walk.model;
    assert_int_equal(weft_plot_data(&desc, &data, &error), WEFT_USAGE);
    assert_non_null(strstr(error.text, "at random"));
    weft_image_free(&bytes);
    weft_image_free(&map);
    cloth_free(&cloth);
    cloth_free(&walk);
    cloth_free(&whole);
}

static void assert_refused(const WeftPlotDesc *desc, const char *part) {
    WeftPlotData data;
    WeftImage image;
    WeftError error = {.text = ""};
    assert_int_equal(weft_plot_data(desc, &data, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_DESC);
    assert_non_null(strstr(error.text, part));
    assert_int_equal(weft_plot_image(desc, &image, NULL), WEFT_USAGE);
    assert_null(image.pixels);
}

static void plot_descriptors_without_sense_are_refused(void **state) {
    (void)state;
    Cloth cloth = {.reflection = NULL}, whole = {.reflection = NULL};
    cloth_of_lobe(&cloth, "lambert", NULL, NULL);
    cloth_of_profile(&whole, "three");
    const WeftPlotModel none = {.label = "x"};
    assert_refused(&(WeftPlotDesc){.kind = WEFT_PLOT_KINDS, .models = &cloth.model, .count = 1}, "kind");
    assert_refused(&(WeftPlotDesc){.models = &cloth.model, .count = 0}, "1 to 8");
    assert_refused(&(WeftPlotDesc){.models = &cloth.model, .count = 9}, "1 to 8");
    assert_refused(&(WeftPlotDesc){.models = NULL, .count = 1}, "1 to 8");
    assert_refused(&(WeftPlotDesc){.models = &none, .count = 1}, "no reflection");
    assert_refused(&(WeftPlotDesc){.kind = WEFT_PLOT_DIFFERENCE, .models = &cloth.model, .count = 1}, "two");
    assert_refused(&(WeftPlotDesc){.kind = WEFT_PLOT_SAMPLES, .models = &whole.model, .count = 1}, "lobes");
    assert_refused(&(WeftPlotDesc){.models = &cloth.model, .count = 1, .views = {90.0f}, .view_count = 1}, "view");
    assert_refused(&(WeftPlotDesc){.models = &cloth.model, .count = 1, .views = {NAN}, .view_count = 1}, "view");
    assert_refused(&(WeftPlotDesc){.models = &cloth.model, .count = 1, .view_count = 7}, "6 views");
    assert_refused(&(WeftPlotDesc){.models = &cloth.model, .count = 1, .width = 9000}, "8192");
    const WeftPlotDesc well = {.models = &cloth.model, .count = 1, .quick = 1};
    WeftError error;
    assert_int_equal(weft_plot_write(&well, "figure.jpg", &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_OUTPUT_SUFFIX);
    assert_int_equal(weft_plot_write(&well, "/none/such/figure.svg", &error), WEFT_RESOURCES);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_WRITE);
    assert_null(weft_plot_kind_name(-1));
    assert_null(weft_plot_kind_help(WEFT_PLOT_KINDS));
    weft_plot_data_free(NULL);
    cloth_free(&cloth);
    cloth_free(&whole);
}

/* From a stamp to a poster: no size is too small to be drawn. */
static void figure_of_any_size_is_drawn(void **state) {
    (void)state;
    static const int sizes[][2] = {{1, 1}, {8, 400}, {64, 64}, {3000, 200}, {0, 700}};
    Cloth cloth = {.reflection = NULL};
    cloth_of_lobe(&cloth, "ggx", NULL, NULL);
    const WeftPlotModel models[2] = {cloth.model, cloth.model};
    for (int kind = 0; kind < WEFT_PLOT_KINDS; kind++)
        for (size_t k = 0; k < sizeof sizes / sizeof *sizes && !is_long(kind); k++) {
            WeftImage image;
            const WeftPlotDesc desc = {.kind = (WeftPlotKind)kind,
                                       .models = models,
                                       .count = kind == WEFT_PLOT_DIFFERENCE ? 2 : 1,
                                       .quick = 1,
                                       .width = sizes[k][0],
                                       .height = sizes[k][1]};
            assert_int_equal(weft_plot_image(&desc, &image, NULL), WEFT_OK);
            if (sizes[k][0]) assert_int_equal(image.width, sizes[k][0]);
            assert_int_equal(image.height, sizes[k][1]);
            weft_image_free(&image);
        }
    cloth_free(&cloth);
}

static int begin(void **state) {
    (void)state;
    return scratch_make(folder) ? 0 : -1;
}

static int end(void **state) {
    (void)state;
    return scratch_remove_empty(folder) ? 0 : -1;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figure_of_a_black_lobe_is_empty),
        cmocka_unit_test(curves_hold_values_of_the_lobe),
        cmocka_unit_test(axes_fit_the_range_of_the_curves),
        cmocka_unit_test(albedo_and_furnace_are_those_of_the_library),
        cmocka_unit_test(maps_hold_values_of_the_lobe),
        cmocka_unit_test(plotted_samples_follow_their_pdf),
        cmocka_unit_test(figure_files_are_valid_and_repeatable),
        cmocka_unit_test(report_page_refers_to_no_other_file),
        cmocka_unit_test(plot_descriptors_without_sense_are_refused),
        cmocka_unit_test(light_of_a_map_is_near_by_weft_and_far_by_irradiance),
        cmocka_unit_test(ambient_without_sense_is_refused),
        cmocka_unit_test(figure_of_any_size_is_drawn),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
