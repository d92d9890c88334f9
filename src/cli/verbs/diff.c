/* diff.c - `weft diff`: the difference of two pictures */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/path.h"
#include "cli/console/json_writer.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/console/two_columns.h"
#include "cli/verbs/verbs.h"
#include "weft/weft.h"

typedef struct Diff {
    const Options *options;
    const char *paths[2], *output; /* output: NULL: none */
    WeftImage images[2], map;
    WeftDiffDesc desc;
    double most, scale; /* --max and --scale; NAN: not given */
    WeftDiff found;
    double beyond; /* fraction of pixels worse than most */
} Diff;

/* Returns the best value of the metric, which is also where the colours of the map begin. */
static float best(const Diff *diff) { return diff->desc.metric == WEFT_METRIC_SSIM ? 1.0f : 0.0f; }

static bool failed(const Diff *diff) {
    if (isnan(diff->most)) return false;
    return diff->desc.metric == WEFT_METRIC_SSIM ? diff->found.value < diff->most : diff->found.value > diff->most;
}

static int output_check(Diff *diff) {
    const char *path = diff->output = option_text(diff->options, "-o");
    if (!path) return 0;
    if (path_ends(path, ".png") || path_ends(path, ".exr") || path_ends(path, ".npy")) return output_probe(path);
    return report(WEFT_USAGE, "%s: a difference is written as .png, .exr or .npy", path);
}

static int images_read(Diff *diff) {
    WeftError error;
    const WeftLog log = {.fn = report_warning};
    for (int k = 0; k < 2; k++)
        if (weft_image_read(diff->paths[k], &diff->images[k], &log, &error) != WEFT_OK) return report_error(&error);
    const WeftImage *a = &diff->images[0], *b = &diff->images[1];
    if (a->width == b->width && a->height == b->height) return 0;
    return report(WEFT_USAGE, "%.300s: is %d x %d pixels, but %.300s %d x %d", diff->paths[0], a->width, a->height,
                  diff->paths[1], b->width, b->height);
}

static int diff_read(Diff *diff) {
    static const char *const metrics[] = {"relmse", "flip", "ssim", NULL};
    const char *curves[WEFT_TONEMAP_COUNT + 1];
    const Options *options = diff->options;
    int metric = 0, curve = 0;
    for (int k = 0; k <= WEFT_TONEMAP_COUNT; k++) curves[k] = weft_tonemap_name(k);
    double sight = 0.0, exposure = 0.0;
    if (!option_choice(options, "--metric", metrics, &metric) || !option_choice(options, "--tonemap", curves, &curve) ||
        !option_number(options, "--ppd", &sight) || !option_number(options, "--exposure", &exposure) ||
        !option_number(options, "--max", &diff->most) || !option_number(options, "--scale", &diff->scale))
        return WEFT_USAGE;
    diff->desc = (WeftDiffDesc){.image = &diff->images[0],
                                .reference = &diff->images[1],
                                .metric = (WeftMetric)metric,
                                .pixels_per_degree = (float)sight,
                                .tonemap = (WeftTonemap)curve,
                                .exposure = (float)exposure,
                                .exposed = option_given(options, "--exposure")};
    diff->paths[0] = options->operands[0];
    diff->paths[1] = options->operands[1];
    int result = output_check(diff);
    return result == 0 ? images_read(diff) : result;
}

static void text_write(const Diff *diff) {
    enum { COLUMN = 16 };
    const WeftDiff *found = &diff->found;
    const char *metric = weft_metric_name(diff->desc.metric);
    char text[200];
    print_name(diff->paths[0]);
    printf(" against ");
    print_name(diff->paths[1]);
    printf(": %d x %d\n", diff->map.width, diff->map.height);
    snprintf(text, sizeof text, "%.6g (%g is the same)", found->value, (double)best(diff));
    layout_entry(stdout, COLUMN, metric, text);
    snprintf(text, sizeof text, "%.4g at pixel %d, %d", (double)found->worst, found->worst_x, found->worst_y);
    layout_entry(stdout, COLUMN, "worst", text);
    snprintf(text, sizeof text, "%.4g or better", (double)found->high);
    layout_entry(stdout, COLUMN, "99 of 100", text);
    if (found->exposures) {
        snprintf(text, sizeof text, "%d, from %.4g to %.4g stops", found->exposures, (double)found->exposure_low,
                 (double)found->exposure_high);
        layout_entry(stdout, COLUMN, "exposures", text);
    }
    if (isnan(diff->most)) return;
    snprintf(text, sizeof text, "%.2f %% of pixels are worse than %g", 100.0 * diff->beyond, diff->most);
    layout_entry(stdout, COLUMN, "beyond", text);
}

static void json_write(const Diff *diff) {
    const WeftDiff *found = &diff->found;
    Json json = {.stream = stdout};
    json_open(&json, NULL, '{');
    json_text(&json, "image", diff->paths[0]);
    json_text(&json, "reference", diff->paths[1]);
    json_whole(&json, "width", diff->map.width);
    json_whole(&json, "height", diff->map.height);
    json_text(&json, "metric", weft_metric_name(diff->desc.metric));
    json_number(&json, "value", found->value);
    json_float(&json, "high", found->high);
    json_open(&json, "worst", '{');
    json_float(&json, "value", found->worst);
    json_whole(&json, "x", found->worst_x);
    json_whole(&json, "y", found->worst_y);
    json_close(&json, '}');
    if (found->exposures) {
        json_open(&json, "exposures", '{');
        json_whole(&json, "count", found->exposures);
        json_float(&json, "low", found->exposure_low);
        json_float(&json, "high", found->exposure_high);
        json_close(&json, '}');
    }
    if (!isnan(diff->most)) {
        json_number(&json, "max", diff->most);
        json_number(&json, "beyond", diff->beyond);
        json_bool(&json, "failed", failed(diff));
    }
    json_close(&json, '}');
}

/* Rounds x up to 1, 2 or 5 times a power of ten. */
static double rounded_up(double x) {
    const double steps[] = {1.0, 2.0, 5.0}, power = pow(10.0, floor(log10(fmax(x, 1e-6))));
    for (int k = 0; k < 3; k++)
        if (steps[k] * power >= 0.999 * x) return steps[k] * power;
    return 10.0 * power;
}

static WeftResult heat_write(const Diff *diff, WeftError *error) {
    const WeftDiff *found = &diff->found;
    const float none = best(diff);
    const double range = isnan(diff->scale) ? rounded_up(fabs((double)found->high - (double)none)) : diff->scale;
    const float most = (float)(diff->desc.metric == WEFT_METRIC_SSIM ? 1.0 - range : range);
    WeftImage heat, sheet = {0};
    char title[80], note[120], caption[400];
    WeftResult result = weft_heat_image(&diff->map, none, most, &heat, error);
    if (result != WEFT_OK) return result;
    snprintf(title, sizeof title, "%s %.4g", weft_metric_name(diff->desc.metric), found->value);
    snprintf(note, sizeof note, "worst %.3g at %d, %d", (double)found->worst, found->worst_x, found->worst_y);
    snprintf(caption, sizeof caption, "%.190s against %.190s", diff->paths[0], diff->paths[1]);
    const WeftPanel panel = {.image = &heat, .title = title, .note = note, .none = none, .most = most};
    const WeftSheetDesc desc = {.caption = caption, .panels = &panel, .count = 1, .columns = 1};
    result = weft_sheet_compose(&desc, &sheet, error);
    if (result == WEFT_OK) result = weft_image_write(diff->output, &sheet, error);
    weft_image_free(&heat);
    weft_image_free(&sheet);
    return result;
}

static WeftResult map_write(const Diff *diff, WeftError *error) {
    const WeftImageWriting how = {.data = 1, .single = 1};
    if (!diff->output) return WEFT_OK;
    if (path_ends(diff->output, ".png")) return heat_write(diff, error);
    return weft_image_write_as(diff->output, &diff->map, &how, error);
}

static int diff_make(Diff *diff) {
    WeftError error;
    WeftResult result = weft_diff(&diff->desc, &diff->found, &diff->map, &error);
    if (result == WEFT_OK) result = map_write(diff, &error);
    if (result != WEFT_OK) return report_error(&error);
    if (!isnan(diff->most)) diff->beyond = weft_diff_beyond(&diff->map, diff->desc.metric, diff->most);
    if (option_given(diff->options, "--json"))
        json_write(diff);
    else
        text_write(diff);
    if (!failed(diff)) return 0;
    fflush(stdout);
    return report(WEFT_FAILED, "%.300s: %s is %.6g, %s than %g", diff->paths[0], weft_metric_name(diff->desc.metric),
                  diff->found.value, diff->desc.metric == WEFT_METRIC_SSIM ? "less" : "more", diff->most);
}

static int diff_run(const Options *options) {
    Diff diff = {.options = options, .most = (double)NAN, .scale = (double)NAN};
    int result = diff_read(&diff);
    if (result == 0) result = diff_make(&diff);
    for (int k = 0; k < 2; k++) weft_image_free(&diff.images[k]);
    weft_image_free(&diff.map);
    return result;
}

static const Option diff_options[] = {
    OPTION_HEADING("Comparison"),
    OPTION_TEXT("--metric", "NAME", "relmse", "relmse, flip or ssim"),
    OPTION_NUMBER("--ppd", "COUNT", "67", 1, 500, "flip: pixels per degree of the viewer's sight"),
    OPTION_NUMBER("--exposure", "STOPS", NULL, -64, 64,
                  "show linear pictures after 2^STOPS, where they are shown at all [0]; flip of two linear "
                  "pictures then is of this exposure alone"),
    OPTION_TEXT("--tonemap", "CURVE", "pbr-neutral",
                "and through this curve: none, pbr-neutral, agx or aces (Narkowicz' fit)"),
    OPTION_HEADING("Result"),
    OPTION_NUMBER("--max", "X", NULL, -1, 1e9,
                  "exit with 1 where the number is above X; of ssim, whose best is 1, where it is below X"),
    OPTION_TEXT("-o", "OUT", NULL,
                "write the metric of every pixel: .png as a heat map with its scale, .exr and .npy as numbers"),
    OPTION_NUMBER("--scale", "X", NULL, 1e-6, 1e9,
                  "how far from the best value a heat map's colours reach; else a round number that 99 of 100 "
                  "pixels keep within"),
    OPTION_SWITCH("--json", "figures as JSON on standard output"),
    OPTION_END,
};

const Verb verb_diff = {
    .name = "diff",
    .operands = "A B [options]",
    .help = "measures the difference of two images",
    .operands_least = 2,
    .operands_most = 2,
    .options = diff_options,
    .notes = "Compares picture A with reference B, of one size, in any format that weft reads.\n\n"
             "Metrics\n"
             "  relmse  (a - b)^2 / (b^2 + 0.01) of linear colours; 0 is the same\n"
             "  flip    what an eye sees when the two alternate: 0 is the same, 1 the most;\n"
             "          of two linear pictures the largest over all exposures (HDR-FLIP)\n"
             "  ssim    structural similarity of luma: 1 is the same\n\n"
             "The number is the mean over pixels. .exr, .hdr and float .npy are linear, all\n"
             "else is display-referred (sRGB). Where one picture of each kind is compared,\n"
             "and for ssim, a linear picture is first shown as `weft render` would show it:\n"
             "with --exposure, --tonemap and 8 bits. relmse of two others decodes sRGB.\n"
             "Transparent pictures lie over black; grey is a colour. docs/diff.md has the\n"
             "formulas.\n\n"
             "Examples\n"
             "  weft diff new.png old.png --metric flip -o heat.png\n"
             "  weft diff noisy.exr converged.exr --max 0.01\n"
             "  weft diff raster.exr trace.exr --metric flip --exposure 1 --json\n"
             "  weft diff cloth.png cloth.exr --metric ssim --max 0.99\n",
    .run = diff_run,
};
