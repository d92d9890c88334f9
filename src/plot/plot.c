/* plot.c - the API of figures: checking of descriptors, numbers, drawing and writing */
#include "weft/plot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/path.h"
#include "plot/drawing.h"
#include "plot/making.h"
#include "plot/page.h"
#include "plot/vector.h"

struct WeftPlotMemory {
    Arena arena;
};

typedef struct FigureKind {
    const char *name, *help, *title;
    WeftResult (*make)(Making *making);
} FigureKind;

static const FigureKind kinds[WEFT_PLOT_KINDS] = {
    [WEFT_PLOT_POLAR] = {"polar", "f as a length over the angle of wi, in the plane of wo and across it", "Polar plot",
                         kind_polar},
    [WEFT_PLOT_LOBE3D] = {"lobe3d", "f as a length over all wi: a surface", "The lobe in space", kind_lobe3d},
    [WEFT_PLOT_CARTESIAN] = {"cartesian", "f, and f cos, over the angle of wi", "Reflectance in the plane of view",
                             kind_cartesian},
    [WEFT_PLOT_ALBEDO] = {"albedo", "directional albedo over the angle of view, and over roughness",
                          "Directional albedo", kind_albedo},
    [WEFT_PLOT_FURNACE] = {"furnace",
                           "what white cloth returns of uniform light: a lobe on a white base, by layer rule",
                           "White furnace", kind_furnace},
    [WEFT_PLOT_SLICE] = {"slice", "f over theta_h and theta_d, phi_d = 90 degrees, as a picture", "Image slice",
                         kind_slice},
    [WEFT_PLOT_SPHERE] = {"sphere", "a lit sphere, and more as the roughness grows", "Lit spheres", kind_sphere},
    [WEFT_PLOT_SAMPLES] = {"samples", "lobes only: histogram of what is drawn, pdf, and their ratio",
                           "Samples against their density", kind_samples},
    [WEFT_PLOT_DIFFERENCE] = {"difference", "where in theta_o and theta_i two models differ", "Difference",
                              kind_difference},
    [WEFT_PLOT_AMBIENT] = {"ambient", "lobes only: a sphere under a map, as it is and as engines light it",
                           "Light of a map", kind_ambient},
};

const char *weft_plot_kind_name(int kind) { return kind >= 0 && kind < WEFT_PLOT_KINDS ? kinds[kind].name : NULL; }

const char *weft_plot_kind_help(int kind) { return kind >= 0 && kind < WEFT_PLOT_KINDS ? kinds[kind].help : NULL; }

const char *kind_refuses(WeftPlotKind kind, const WeftPlotModel *model) {
    if (kind == WEFT_PLOT_SAMPLES && !model->lobe) return "only lobes are sampled by themselves";
    if (kind == WEFT_PLOT_AMBIENT && !model->lobe) return "engines light only lobes alone";
    if (kind == WEFT_PLOT_AMBIENT && weft_lobe_info(model->lobe->lobe)->traits & WEFT_LOBE_REFERENCE)
        return "a lobe that walks at random has no table";
    return NULL;
}

/* Returns the fault of a descriptor, or NULL. */
static const char *complaint(const WeftPlotDesc *desc) {
    if ((int)desc->kind < 0 || desc->kind >= WEFT_PLOT_KINDS) return "there is no such kind";
    if (!desc->models || desc->count < 1 || desc->count > WEFT_PLOT_MODELS_MAX) return "a figure has 1 to 8 models";
    for (int k = 0; k < desc->count; k++)
        if (!desc->models[k].reflection) return "a model has no reflection";
    if (desc->kind == WEFT_PLOT_DIFFERENCE && desc->count != 2) return "a difference is of two models";
    if (desc->view_count < 0 || desc->view_count > WEFT_PLOT_VIEWS_MAX) return "a figure has up to 6 views";
    for (int k = 0; k < desc->view_count; k++)
        if (!(desc->views[k] >= 0.0f && desc->views[k] < (desc->kind == WEFT_PLOT_SPHERE ? 180.0f : 90.0f)))
            return "a view is an angle from 0 to below 90 degrees";
    if ((int)desc->channel < 0 || desc->channel > WEFT_PLOT_BLUE) return "there is no such channel";
    if (desc->width < 0 || desc->height < 0 || desc->width > WEFT_PLOT_SIDE_MAX || desc->height > WEFT_PLOT_SIDE_MAX)
        return "a side has up to 8192 pixels";
    const char *fault = NULL;
    for (int k = 0; k < desc->count && !fault; k++) fault = kind_refuses(desc->kind, &desc->models[k]);
    return fault;
}

/* Makes the title: that of the descriptor, else the kind's, with the label of a single model. */
static void make_title(const WeftPlotDesc *desc, WeftPlotData *data) {
    const char *own = kinds[desc->kind].title;
    if (desc->title)
        snprintf(data->title, sizeof data->title, "%s", desc->title);
    else if (desc->count == 1 && desc->models[0].label)
        snprintf(data->title, sizeof data->title, "%s: %.128s", own, desc->models[0].label);
    else
        snprintf(data->title, sizeof data->title, "%s", own);
}

WeftResult weft_plot_data(const WeftPlotDesc *desc, WeftPlotData *out, WeftError *error) {
    memset(out, 0, sizeof *out);
    const char *wrong = complaint(desc);
    if (wrong) return fail(error, WEFT_MESSAGE_DESC, "plot", "%s", wrong);
    out->owned = alloc_array(1, sizeof *out->owned);
    if (!out->owned) return fail(error, WEFT_MESSAGE_MEMORY, "plot", NULL);
    make_title(desc, out);
    Making making = {.desc = desc, .data = out, .arena = &out->owned->arena, .error = error};
    WeftResult result = kinds[desc->kind].make(&making);
    if (result != WEFT_OK) weft_plot_data_free(out);
    return result;
}

void weft_plot_data_free(WeftPlotData *data) {
    if (!data || !data->owned) return;
    arena_free(&data->owned->arena);
    free(data->owned);
    memset(data, 0, sizeof *data);
}

static void page_size(const WeftPlotDesc *desc, const WeftPlotData *data, int *width, int *height) {
    page_natural(data, width, height);
    double aspect = (double)*height / *width;
    if (desc->width && desc->height) {
        *width = desc->width;
        *height = desc->height;
    } else if (desc->width) {
        *width = desc->width;
        *height = (int)fmin(fmax(round(desc->width * aspect), 1.0), WEFT_PLOT_SIDE_MAX);
    } else if (desc->height) {
        *height = desc->height;
        *width = (int)fmin(fmax(round(desc->height / aspect), 1.0), WEFT_PLOT_SIDE_MAX);
    }
}

static WeftResult draw_page(cairo_t *cairo, void *user, WeftError *error) {
    Page *page = user;
    page->cairo = cairo;
    page->error = error;
    return page_draw(page);
}

static Drawing drawing_of(Page *page) {
    return (Drawing){
        .width = page->width, .height = page->height, .title = page->data->title, .draw = draw_page, .user = page};
}

static Page page_of(const WeftPlotDesc *desc, const WeftPlotData *data) {
    Page page = {.data = data};
    page_size(desc, data, &page.width, &page.height);
    page.type = page_type(data, page.width, page.height);
    return page;
}

WeftResult weft_plot_image(const WeftPlotDesc *desc, WeftImage *out, WeftError *error) {
    WeftPlotData data;
    *out = (WeftImage){0};
    WeftResult result = weft_plot_data(desc, &data, error);
    if (result != WEFT_OK) return result;
    Page page = page_of(desc, &data);
    const Drawing drawing = drawing_of(&page);
    result = drawing_image(&drawing, out, error);
    weft_plot_data_free(&data);
    return result;
}

WeftResult plot_svg(const WeftPlotDesc *desc, const WeftPlotData *data, Vector *out, WeftError *error) {
    Page page = page_of(desc, data);
    const Drawing drawing = drawing_of(&page);
    return drawing_svg(&drawing, out, error);
}

WeftResult plot_write_bytes(const char *path, const Vector *bytes, WeftError *error) {
    OutputFile file;
    WeftResult result = output_open(&file, path, error);
    if (result != WEFT_OK) return result;
    fwrite(bytes->text, 1, bytes->size, file.stream);
    return output_commit(&file, error);
}

int weft_plot_suffix_known(const char *path) {
    return path_ends(path, ".png") || path_ends(path, ".svg") || path_ends(path, ".pdf");
}

WeftResult weft_plot_write(const WeftPlotDesc *desc, const char *path, WeftError *error) {
    WeftPlotData data;
    if (!weft_plot_suffix_known(path))
        return fail(error, WEFT_MESSAGE_OUTPUT_SUFFIX, path, "figures are .png, .svg or .pdf");
    WeftResult result = weft_plot_data(desc, &data, error);
    if (result != WEFT_OK) return result;
    Page page = page_of(desc, &data);
    const Drawing drawing = drawing_of(&page);
    result = drawing_write(&drawing, path, error);
    weft_plot_data_free(&data);
    return result;
}
