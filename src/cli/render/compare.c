#include "cli/render/compare.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/console/report.h"
#include "cli/files/sheet_scale.h"
#include "weft/weft.h"

enum { NOTE = 96, COLUMNS_MOST = 5, CAPTION = 512 };

/* One picture and its two panels. */
typedef struct Shot {
    Job job;
    char label[ASSIGN_LABEL], samples[NOTE], title[NOTE + ASSIGN_LABEL], figures[NOTE];
    WeftDifference difference; /* from the first */
    WeftImage picture;         /* of the difference */
} Shot;

typedef struct Comparison {
    const Request *request;
    Shot shots[ASSIGN_VARIANTS_MOST];
    int count;   /* images made; fewer than requested after an interruption */
    float scale; /* of all difference images */
} Comparison;

/* Traces the pictures one after the other. After an interruption, those without a sample are left out, except the
 * first. */
static WeftResult trace_all(Comparison *all, Warnings *warnings, bool *interrupted, WeftError *error) {
    const Request *request = all->request;
    WeftResult result = WEFT_OK;
    for (int k = 0; k < request_count(request) && result == WEFT_OK && !*interrupted; k++) {
        Shot *shot = &all->shots[k];
        shot->job = (Job){.request = request, .warnings = warnings, .number = k};
        if (request->engine == ENGINE_BOTH)
            snprintf(shot->label, sizeof shot->label, "%s", k ? "raster" : "trace");
        else
            assign_label(&request->scene_options.assignment, k, shot->label);
        shot->job.engine = request->engine == ENGINE_BOTH ? (Engine)k : request->engine;
        result = job_run(&shot->job, error);
        job_close(&shot->job);
        *interrupted = shot->job.interrupted || result == WEFT_INTERRUPTED;
        if (result == WEFT_INTERRUPTED && k > 0) return WEFT_OK;
        if (result == WEFT_OK) all->count++;
    }
    return result;
}

static WeftResult measure(Comparison *all, WeftError *error) {
    const WeftImage *first = &all->shots[0].job.linear;
    WeftResult result = WEFT_OK;
    float high = 0.0f;
    for (int k = 0; k < all->count && result == WEFT_OK; k++) {
        Shot *shot = &all->shots[k];
        result = weft_difference(&shot->job.linear, first, &shot->difference, error);
        high = fmaxf(high, shot->difference.high);
        snprintf(shot->samples, sizeof shot->samples, "%.4g samples/pixel", shot->job.info.samples_per_pixel);
        if (k)
            snprintf(shot->title, sizeof shot->title, "%s \xe2\x88\x92 %s", shot->label, all->shots[0].label);
        else
            snprintf(shot->title, sizeof shot->title, "difference from %s", shot->label);
        snprintf(shot->figures, sizeof shot->figures, "mean |difference| %.4f   relMSE %.4f", shot->difference.mean,
                 shot->difference.relmse);
    }
    all->scale = sheet_scale(high, 1e-4f);
    for (int k = 1; k < all->count && result == WEFT_OK; k++)
        result = weft_difference_image(&all->shots[k].job.linear, first, all->scale, &all->shots[k].picture, error);
    return result;
}

/* Writes the differences between the images into the caption. */
static void caption_of(const Request *request, char caption[CAPTION]) {
    const Assignments *assignment = &request->scene_options.assignment;
    const char *by = request->engine == ENGINE_BOTH ? "engine" : assignment->varied[0].name;
    if (assignment->varied_count > 1)
        snprintf(caption, CAPTION, "%.200s, rows by %s, columns by %s", request->scene_options.scene, by,
                 assignment->varied[1].name);
    else
        snprintf(caption, CAPTION, "%.200s, by %s", request->scene_options.scene, by);
}

/* Fills the panels with the pictures alone, in rows and columns. Returns the number of panels. */
static int place_grid(const Comparison *all, WeftPanel *panels, int *columns) {
    *columns = all->request->scene_options.assignment.varied[1].count;
    if (*columns > all->count) *columns = all->count;
    for (int k = 0; k < all->count; k++) {
        const Shot *shot = &all->shots[k];
        panels[k] = (WeftPanel){.image = &shot->job.display, .title = shot->label, .note = shot->samples};
    }
    return all->count;
}

/* Fills bands of two rows: pictures, and below each its difference; below the first stands the key of the colours. One
 * picture has neither. Returns the number of panels. */
static int place_bands(const Comparison *all, WeftPanel *panels, int *columns) {
    int last = all->count > 1 ? all->count - 1 : 0, bands = 1 + last / COLUMNS_MOST;
    *columns = 1 + last / bands;
    for (int k = 0; k < all->count; k++) {
        const Shot *shot = &all->shots[k];
        int at = k / *columns * 2 * *columns + k % *columns;
        panels[at] = (WeftPanel){.image = &shot->job.display, .title = shot->label, .note = shot->samples};
        if (!last) break;
        panels[at + *columns] = k ? (WeftPanel){.image = &shot->picture, .title = shot->title, .note = shot->figures}
                                  : (WeftPanel){.scale = all->scale,
                                                .title = shot->title,
                                                .note = "of linear radiance, the channel that differs most"};
    }
    return (last ? 2 * bands : 1) * *columns;
}

static WeftResult compose(const Comparison *all, WeftImage *sheet, WeftError *error) {
    WeftPanel panels[2 * (ASSIGN_VARIANTS_MOST + COLUMNS_MOST)] = {0};
    bool grid = all->request->scene_options.assignment.varied_count > 1;
    int columns, count = grid ? place_grid(all, panels, &columns) : place_bands(all, panels, &columns);
    char caption[CAPTION];
    caption_of(all->request, caption);
    const WeftSheetDesc desc = {.caption = caption, .panels = panels, .count = count, .columns = columns};
    return weft_sheet_compose(&desc, sheet, error);
}

/* Writes what sets picture k apart from the rest, by the names of what varies. */
static void json_variant(Json *json, const Request *request, int k) {
    const Assignments *assignment = &request->scene_options.assignment;
    char value[ASSIGN_LABEL];
    if (request->engine == ENGINE_BOTH) json_text(json, "engine", k ? "raster" : "trace");
    for (int v = 0; v < assignment->varied_count; v++) {
        assign_value(assignment, v, k, value);
        json_text(json, assignment->varied[v].name, value);
    }
}

static void figures(const Comparison *all) {
    Json json = {.stream = stdout};
    json_open(&json, NULL, '[');
    for (int k = 0; k < all->count; k++) {
        const Shot *shot = &all->shots[k];
        json_open(&json, NULL, '{');
        json_variant(&json, all->request, k);
        json_open(&json, "difference", '{');
        json_number(&json, "mean", shot->difference.mean);
        json_number(&json, "relmse", shot->difference.relmse);
        json_float(&json, "high", shot->difference.high);
        json_float(&json, "scale", all->scale);
        json_close(&json, '}');
        job_json(&shot->job, &json);
        json_close(&json, '}');
    }
    json_close(&json, ']');
}

static void summary(const Comparison *all, bool interrupted) {
    char files[REQUEST_FILES], part[48] = "";
    double seconds = 0.0;
    for (int k = 0; k < all->count; k++) seconds += all->shots[k].job.info.render_seconds;
    if (interrupted) snprintf(part, sizeof part, "interrupted at %d of ", all->count);
    report(0, "%s%d pictures in %.2f s; wrote %s", part, request_count(all->request), seconds,
           request_outputs_text(all->request, files));
}

int compare_run(const Request *request, Warnings *warnings) {
    WeftError error = {0};
    WeftImage sheet = {0};
    bool interrupted = false;
    Comparison *all = calloc(1, sizeof *all);
    if (!all) return report(WEFT_RESOURCES, "out of memory");
    all->request = request;
    WeftResult result = trace_all(all, warnings, &interrupted, &error);
    if (result == WEFT_OK) result = measure(all, &error);
    if (result == WEFT_OK) result = compose(all, &sheet, &error);
    if (result == WEFT_OK)
        result = request_outputs_write(request, NULL, &(Outputs){.linear = &sheet, .display = &sheet}, &error);
    if (result != WEFT_OK) {
        report_error(&error);
    } else {
        if (!request->quiet) summary(all, interrupted);
        if (option_given(request->options, "--json")) figures(all);
        if (interrupted) result = WEFT_INTERRUPTED;
    }
    for (int k = 0; k < ASSIGN_VARIANTS_MOST; k++) {
        job_free(&all->shots[k].job);
        weft_image_free(&all->shots[k].picture);
    }
    weft_image_free(&sheet);
    free(all);
    return (int)result;
}
