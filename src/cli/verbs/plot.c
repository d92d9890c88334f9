/* plot.c - `weft plot`: figures of lobes, materials and measurements, and a report of them */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/path.h"
#include "cli/console/names.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/console/two_columns.h"
#include "cli/operands/lobes.h"
#include "cli/operands/model.h"
#include "cli/operands/root.h"
#include "cli/pages/plot_numbers.h"
#include "cli/verbs/verbs.h"

typedef struct Plot {
    const Options *options;
    WeftPlotDesc desc;
    WeftPlotModel models[WEFT_PLOT_MODELS_MAX];
    Model *read;   /* one for each of models */
    WeftImage map; /* ambient: of --env */
    const char *output;
    bool report; /* instead of a kind */
} Plot;

static const char report_name[] = "report";

static int kind_read(Plot *plot, const char *word) {
    char hint[96];
    Nearest nearest = {.typed = word};
    plot->report = strcmp(word, report_name) == 0;
    if (plot->report) return 0;
    for (int k = 0; weft_plot_kind_name(k); k++) {
        if (strcmp(weft_plot_kind_name(k), word) == 0) {
            plot->desc.kind = (WeftPlotKind)k;
            return 0;
        }
        nearest_offer(&nearest, weft_plot_kind_name(k));
    }
    nearest_offer(&nearest, report_name);
    return report(WEFT_USAGE, "%.200s: is not a kind of plot%s", word,
                  nearest.name ? nearest_hint(&nearest, hint, sizeof hint) : "; see weft plot --help");
}

static int views_read(Plot *plot) {
    const char *text;
    const double most = plot->desc.kind == WEFT_PLOT_SPHERE && !plot->report ? 180.0 : 90.0;
    for (int cursor = 0; (text = option_next(plot->options, "--view", &cursor));) {
        double degrees;
        if (!numbers_parse(text, 1, &degrees) || degrees < 0.0 || degrees >= most)
            return report(WEFT_USAGE, "--view: \"%.80s\" is not an angle from 0 to below %g degrees", text, most);
        if (plot->desc.view_count == WEFT_PLOT_VIEWS_MAX)
            return report(WEFT_USAGE, "--view: is given more than %d times", WEFT_PLOT_VIEWS_MAX);
        plot->desc.views[plot->desc.view_count++] = (float)degrees;
    }
    return 0;
}

/* Reads --size: WxH, or W alone, from which the height follows. */
static int size_read(Plot *plot) {
    const char *text = option_text(plot->options, "--size");
    if (!text) return 0;
    char *end;
    long width = strtol(text, &end, 10), height = 0;
    bool well = end != text && (*end == '\0' || *end == 'x');
    if (well && *end == 'x') {
        const char *from = end + 1;
        height = strtol(from, &end, 10);
        well = end != from && *end == '\0' && height >= 64;
    }
    if (!well || width < 64 || width > WEFT_PLOT_SIDE_MAX || height > WEFT_PLOT_SIDE_MAX)
        return report(WEFT_USAGE, "--size: \"%.80s\" is not WIDTHxHEIGHT of 64 to %d pixels", text, WEFT_PLOT_SIDE_MAX);
    plot->desc.width = (int)width;
    plot->desc.height = (int)height;
    return 0;
}

static int output_read(Plot *plot) {
    const bool json = option_given(plot->options, "--json"), csv = option_given(plot->options, "--csv");
    plot->output = option_text(plot->options, "-o");
    if (json && csv) return report(WEFT_USAGE, "--csv: does not go with --json");
    if (plot->report && (json || csv))
        return report(WEFT_USAGE, "%s: a report has no numbers", json ? "--json" : "--csv");
    if (!plot->output && !json && !csv)
        return report(WEFT_USAGE, "plot: needs -o FILE%s", plot->report ? ".html" : ", --json or --csv");
    if (!plot->output) return 0;
    if (plot->report && !path_ends(plot->output, ".html"))
        return report(WEFT_USAGE, "%.300s: a report is an .html", plot->output);
    if (!plot->report && !weft_plot_suffix_known(plot->output))
        return report(WEFT_USAGE, "%.300s: a plot is a .png, .svg or .pdf", plot->output);
    return output_probe(plot->output);
}

/* Returns the label of a model; for a file its name without folders. */
static const char *label_of(const Model *model) {
    const char *slash = strrchr(model->words, '/');
    bool file = model->kind == MODEL_MEASURED || model->kind == MODEL_MATERIAL;
    return file && slash && slash[1] ? slash + 1 : model->words;
}

static int models_read(Plot *plot) {
    const int count = plot->options->operand_count - 1;
    if (count > WEFT_PLOT_MODELS_MAX)
        return report(WEFT_USAGE, "plot: takes up to %d models, not %d", WEFT_PLOT_MODELS_MAX, count);
    if (!plot->report && plot->desc.kind == WEFT_PLOT_DIFFERENCE && count != 2)
        return report(WEFT_USAGE, "difference: is of two models, not %d", count);
    plot->read = calloc((size_t)count, sizeof *plot->read);
    if (!plot->read) return report(WEFT_RESOURCES, "plot: %s", weft_message_text(WEFT_MESSAGE_MEMORY));
    for (int k = 0; k < count; k++) {
        Model *model = &plot->read[k];
        plot->desc.count = k + 1; /* so that every model read so far is freed */
        int result = model_read(plot->options->operands[k + 1], model);
        if (result != 0) return result;
        const char *of_lobes = plot->report                           ? NULL
                               : plot->desc.kind == WEFT_PLOT_SAMPLES ? "have samples to plot"
                               : plot->desc.kind == WEFT_PLOT_AMBIENT ? "are lit by a map alone"
                                                                      : NULL;
        if (of_lobes && model->kind != MODEL_LOBE)
            return report(WEFT_USAGE, "%.200s: is not a lobe, and only lobes %s", model->words, of_lobes);
        plot->models[k] =
            (WeftPlotModel){.reflection = model->reflection,
                            .lobe = model->kind == MODEL_LOBE ? &model->lobe : NULL,
                            .material = model_is_material(model) && !model->cloth ? &model->material : NULL,
                            .label = label_of(model)};
    }
    plot->desc.models = plot->models;
    return 0;
}

/* Reads the map of --env. */
static int map_read(Plot *plot) {
    const char *path = option_text(plot->options, "--env");
    WeftError error;
    if (!path) return 0;
    if (plot->report || plot->desc.kind != WEFT_PLOT_AMBIENT)
        return report(WEFT_USAGE, "--env: goes with the kind ambient alone");
    if (weft_image_read(path, &plot->map, NULL, &error) != WEFT_OK) return report_error(&error);
    if (plot->map.width != 2 * plot->map.height)
        return report(WEFT_INPUT, "%.300s: %d x %d pixels are no lat-long map: it is twice as wide as high", path,
                      plot->map.width, plot->map.height);
    plot->desc.environment = &plot->map;
    return 0;
}

static int plot_read(Plot *plot) {
    static const char *const channels[] = {"luminance", "red", "green", "blue", NULL};
    const Options *options = plot->options;
    int channel = 0, result = kind_read(plot, options->operands[0]);
    if (result != 0) return result;
    if (!option_choice(options, "--channel", channels, &channel)) return WEFT_USAGE;
    plot->desc.channel = (WeftPlotChannel)channel;
    plot->desc.logarithmic = option_given(options, "--log");
    plot->desc.cosine = option_given(options, "--cos");
    plot->desc.quick = option_given(options, "--quick");
    plot->desc.title = option_text(options, "--title");
    result = views_read(plot);
    if (result == 0) result = size_read(plot);
    if (result == 0) result = models_read(plot);
    if (result == 0) result = map_read(plot);
    return result == 0 ? output_read(plot) : result;
}

static int plot_make(const Plot *plot) {
    WeftError error;
    WeftResult result = WEFT_OK;
    if (plot->report)
        result = weft_plot_report(&plot->desc, plot->output, &error);
    else if (plot->output)
        result = weft_plot_write(&plot->desc, plot->output, &error);
    if (result != WEFT_OK) return report_error(&error);
    const bool json = option_given(plot->options, "--json");
    if (!json && !option_given(plot->options, "--csv")) return 0;
    WeftPlotData data;
    if (weft_plot_data(&plot->desc, &data, &error) != WEFT_OK) return report_error(&error);
    if (json)
        plot_json(&data, plot->desc.kind);
    else
        plot_csv(&data);
    weft_plot_data_free(&data);
    return 0;
}

static int plot_run(const Options *options) {
    Plot plot = {.options = options};
    int result = plot_read(&plot);
    if (result == 0) result = plot_make(&plot);
    for (int k = 0; plot.read && k < plot.desc.count; k++) model_free(&plot.read[k]);
    free(plot.read);
    weft_image_free(&plot.map);
    return result;
}

static void plot_lists(void) {
    printf("\nKinds\n");
    for (int k = 0; weft_plot_kind_name(k); k++)
        layout_entry(stdout, 26, weft_plot_kind_name(k), weft_plot_kind_help(k));
    layout_entry(stdout, 26, report_name, "all of these on one page of HTML that needs nothing else");
}

static const Option plot_options[] = {
    OPTION_HEADING("Options"),
    OPTION_TEXT("-o", "FILE", NULL, "write the figure: .png, .svg or .pdf; of report, .html"),
    OPTION_LOBES,
    OPTION_ROOT,
    OPTION_LIST("--view", "DEGREES",
                "angle of wo from the normal, below 90; of sphere, between light and viewer, below 180"),
    OPTION_TEXT("--env", "MAP", NULL, "ambient: a lat-long map of floats, .hdr or .exr [a studio]"),
    OPTION_SWITCH("--log", "f on a logarithmic scale; slice: in colours of a scale, not as a picture"),
    OPTION_SWITCH("--cos", "polar and lobe3d: f cos in place of f"),
    OPTION_TEXT("--channel", "CHANNEL", "luminance",
                "luminance, red, green or blue; sphere and slice show all colours unless this is one"),
    OPTION_TEXT("--title", "TEXT", NULL, "above the figure, in place of the kind's own"),
    OPTION_TEXT("--size", "WxH", NULL, "pixels, 96 to the inch; of a width alone the height follows; type grows along"),
    OPTION_SWITCH("--quick", "fewer values, walks and samples: a first look"),
    OPTION_SWITCH("--json", "the figure's numbers as JSON on standard output"),
    OPTION_SWITCH("--csv", "the same as comma-separated lines"),
    OPTION_END,
};

const Verb verb_plot = {
    .name = "plot",
    .operands = "KIND MODEL... [options]",
    .help = "draws figures of lobes, materials and measured BRDFs",
    .operands_least = 2,
    .operands_most = 1 + WEFT_PLOT_MODELS_MAX,
    .options = plot_options,
    .lists = plot_lists,
    .notes = "A model is " MODEL_FORM ": a lobe, an engine profile, preset:NAME or a\n"
             "material file, a material of a scene as scene.glb:MATERIAL, or a measured BRDF\n"
             "(.binary, .bsdf, .bin). A woven material is drawn as it is from afar. Up to\n"
             "eight stand in one figure. Their colours stay distinct for colour-blind\n"
             "readers, and so do the dashes of their lines. docs/plots.md shows each kind.\n\n"
             "Examples\n"
             "  weft plot polar charlie-neubelt:alpha=0.25 ashikhmin-neubelt -o polar.svg\n"
             "  weft plot cartesian ggx:alpha=0.1 ggx:alpha=0.4 --log --view 45 -o ggx.pdf\n"
             "  weft plot albedo charlie-neubelt charlie-khronos --csv\n"
             "  weft plot slice preset:velvet cotton.binary -o slice.png\n"
             "  weft plot difference three khronos -o difference.png\n"
             "  weft plot ambient charlie-neubelt --env studio.hdr -o ambient.png\n"
             "  weft plot report fibre charlie-neubelt -o report.html\n",
    .run = plot_run,
};
