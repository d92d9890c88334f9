/* audit.c - `weft bake audit`: the error of a table of E from elsewhere, and its cause */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "base/path.h"
#include "cli/bake/audit_sheet.h"
#include "cli/bake/bake.h"
#include "cli/console/interrupt.h"
#include "cli/console/json_writer.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/console/two_columns.h"
#include "cli/files/table_text.h"

typedef struct Audit {
    const Options *options;
    const char *path;
    BakeCommon common;
    WeftLobe lobe;
    bool any; /* no lobe is given: the nearest is searched */
    WeftImage file, errors;
    int channel;
    double most;
    WeftAudit found;
} Audit;

static const char *const part_words[] = {"E", "the part of f0", "the part of f90"};
static const char *const part_names[] = {"sum", "f0", "f90"};

static const char *lobe_id(const Audit *audit) { return weft_lobe_info(audit->found.lobe)->id; }

static int outputs_check(const Options *options) {
    int cursor = 0, result = 0;
    for (const char *path; result == 0 && (path = option_next(options, "-o", &cursor));)
        if (path_ends(path, ".png") || path_ends(path, ".exr") || path_ends(path, ".npy"))
            result = output_probe(path);
        else
            result = report(WEFT_USAGE, "%s: an audit writes its errors as .png, .exr or .npy", path);
    return result;
}

static int audit_read(const Options *options, Audit *audit) {
    WeftError error;
    const WeftLog log = bake_log(&audit->common);
    const char *lobe = option_text(options, "--lobe");
    audit->options = options;
    if (options->operand_count < 2)
        return report(WEFT_USAGE, "bake audit: needs a file: weft bake audit FILE --lobe LOBE");
    audit->path = options->operands[1];
    if (!lobe) return report(WEFT_USAGE, "bake audit: needs --lobe LOBE, whose E the table should hold");
    if (!bake_common(options, &audit->common) || !option_number(options, "--max", &audit->most)) return WEFT_USAGE;
    int result = 0;
    audit->any = strcmp(lobe, "any") == 0;
    if (audit->any && option_given(options, "-p"))
        return report(WEFT_USAGE, "-p: is for a lobe, and --lobe any names none");
    if (!audit->any) result = bake_lobe(options, lobe, &audit->lobe);
    if (result == 0) result = outputs_check(options);
    if (result != 0) return result;
    if (table_text_suffix(audit->path))
        return table_text_read(audit->path, option_given(options, "--channel"), &audit->file);
    return weft_image_read(audit->path, &audit->file, &log, &error) == WEFT_OK ? 0 : report_error(&error);
}

/* Returns true if all colour channels are equal. */
static bool is_grey(const WeftImage *image) {
    const size_t bytes = image->type == WEFT_PIXEL_U8 ? 1 : image->type == WEFT_PIXEL_U16 ? 2 : 4;
    const size_t count = (size_t)image->width * (size_t)image->height;
    const char *at = image->pixels;
    if (image->channels < 3) return image->type != WEFT_PIXEL_F32 || image->channels == 1;
    for (size_t n = 0; n < count; n++, at += (size_t)image->channels * bytes)
        if (memcmp(at, at + bytes, bytes) != 0 || memcmp(at, at + 2 * bytes, bytes) != 0) return false;
    return true;
}

/* Finds the channel that --channel names, or else the only one. Returns 0, or an exit code after one line. */
static int channel_find(Audit *audit) {
    static const char letters[] = "rgba0123";
    const char *text = option_text(audit->options, "--channel");
    const int channels = audit->file.channels;
    if (!text)
        return is_grey(&audit->file)
                   ? 0
                   : report(WEFT_USAGE, "%s: has %d channels; say which with --channel", audit->path, channels);
    const char *letter = text[1] ? NULL : strchr(letters, tolower((unsigned char)text[0]));
    if (!letter) return report(WEFT_USAGE, "--channel: \"%.80s\" is not one of r, g, b, a, 0, 1, 2, 3", text);
    audit->channel = (int)(letter - letters) % 4;
    if (channels == 2 && *letter == 'a') audit->channel = 1;
    if (audit->channel < channels) return 0;
    return report(WEFT_USAGE, "--channel: %s has %d channel%s, and no %s", audit->path, channels,
                  channels > 1 ? "s" : "", text);
}

static int audit_make(Audit *audit) {
    WeftError error;
    Progress progress =
        progress_start_count(audit->common.quiet, "texels", (double)audit->file.width * audit->file.height);
    const WeftAuditDesc desc = {.image = &audit->file,
                                .channel = audit->channel,
                                .lobe = audit->any ? NULL : &audit->lobe,
                                .form = audit->common.formed ? &audit->common.form : NULL,
                                .scale = audit->common.scale,
                                .most = audit->most,
                                .tolerance = audit->common.tolerance,
                                .threads = audit->common.threads,
                                .progress = bake_progress,
                                .user = &progress};
    WeftResult result = weft_audit(&desc, &audit->found, &audit->errors, &error);
    progress_finish(&progress);
    if (result == WEFT_INTERRUPTED) return report(WEFT_INTERRUPTED, "interrupted; nothing was written");
    return result == WEFT_OK ? 0 : report_error(&error);
}

static void form_words(const Audit *audit, char *text, size_t size) {
    char elements[WEFT_TABLE_FORM_TEXT];
    const int named = weft_table_form_find(&audit->found.form);
    const char *why = audit->common.formed ? "" : audit->found.fits ? "; they fit best" : "; a guess, for none fit";
    snprintf(text, size, "%s (%s%s)", weft_table_form_text(&audit->found.form, elements),
             named >= 0 ? weft_table_form_name(named) : "of no engine known here", why);
}

static void place_words(const Audit *audit, char *text, size_t size) {
    const WeftTablePlace *place = &audit->found.place;
    const WeftLobeInfo *info = weft_lobe_info(audit->found.lobe);
    int used = snprintf(text, size, "%.4g at texel %d, %d: cos_o %.4g", audit->found.largest, place->x, place->y,
                        (double)place->cos_o);
    if (info->param_count)
        used += snprintf(text + used, size - (size_t)used, ", %s %.4g", info->params[0].name, (double)place->value);
    snprintf(text + used, size - (size_t)used, ", where E is %.4g and the table %.4g", (double)place->albedo,
             (double)place->table);
}

static void text_write(const Audit *audit) {
    enum { COLUMN = 18 };
    const WeftAudit *found = &audit->found;
    char text[400];
    print_name(audit->path);
    printf(": %d x %d, %s of %s%s\n", audit->file.width, audit->file.height, part_words[found->part], lobe_id(audit),
           audit->any ? ", the nearest of all lobes" : "");
    form_words(audit, text, sizeof text);
    layout_entry(stdout, COLUMN, "axes", text);
    place_words(audit, text, sizeof text);
    layout_entry(stdout, COLUMN, "largest error", text);
    snprintf(text, sizeof text, "%.4g", found->rms);
    layout_entry(stdout, COLUMN, "rms", text);
    snprintf(text, sizeof text, "%+.4g", found->mean);
    layout_entry(stdout, COLUMN, "mean", text);
    snprintf(text, sizeof text, "%.2f %% of %lld texels are off by more than %g", 100.0 * found->beyond, found->texels,
             audit->most);
    layout_entry(stdout, COLUMN, "beyond", text);
    if (found->left_out) {
        snprintf(text, sizeof text, "%lld texels, at cos_o 0 or beyond the range of the lobe", found->left_out);
        layout_entry(stdout, COLUMN, "left out", text);
    }
    snprintf(text, sizeof text, "E within about %.2g, an estimate", found->error);
    layout_entry(stdout, COLUMN, "quadrature", text);
    for (int k = 0; k < found->faults; k++)
        layout_entry(stdout, COLUMN, weft_table_fault_name(found->found[k].fault), found->found[k].text);
}

static void json_write(const Audit *audit) {
    const WeftAudit *found = &audit->found;
    const int named = weft_table_form_find(&found->form);
    char elements[WEFT_TABLE_FORM_TEXT];
    Json json = {.stream = stdout};
    json_open(&json, NULL, '{');
    json_text(&json, "file", audit->path);
    json_whole(&json, "width", audit->file.width);
    json_whole(&json, "height", audit->file.height);
    json_whole(&json, "channel", audit->channel);
    json_text(&json, "lobe", lobe_id(audit));
    json_bool(&json, "lobe_given", !audit->any);
    json_text(&json, "part", part_names[found->part]);
    json_text(&json, "axes", weft_table_form_text(&found->form, elements));
    if (named >= 0) json_text(&json, "axes_name", weft_table_form_name(named));
    json_bool(&json, "axes_given", audit->common.formed);
    json_bool(&json, "axes_fit", found->fits != 0);
    json_open(&json, "largest", '{');
    json_number(&json, "error", found->largest);
    json_whole(&json, "x", found->place.x);
    json_whole(&json, "y", found->place.y);
    json_float(&json, "cos_o", found->place.cos_o);
    json_float(&json, "parameter", found->place.value);
    json_float(&json, "table", found->place.table);
    json_float(&json, "albedo", found->place.albedo);
    json_close(&json, '}');
    json_number(&json, "rms", found->rms);
    json_number(&json, "mean", found->mean);
    json_number(&json, "max", audit->most);
    json_number(&json, "beyond", found->beyond);
    json_number(&json, "correlation", found->together);
    json_whole(&json, "texels", found->texels);
    json_whole(&json, "left_out", found->left_out);
    json_number(&json, "quadrature", found->error);
    json_open(&json, "findings", '[');
    for (int k = 0; k < found->faults; k++) {
        json_open(&json, NULL, '{');
        json_text(&json, "id", weft_table_fault_name(found->found[k].fault));
        json_text(&json, "text", found->found[k].text);
        json_close(&json, '}');
    }
    json_close(&json, ']');
    json_close(&json, '}');
}

/* Writes the errors alone, as numbers without the colours of the sheet. */
static WeftResult errors_write(const Audit *audit, const char *path, WeftError *error) {
    const WeftImage *errors = &audit->errors;
    const WeftImageWriting how = {.data = 1, .single = 1};
    const size_t count = (size_t)errors->width * (size_t)errors->height;
    WeftImage alone;
    WeftResult result = weft_image_create(errors->width, errors->height, 1, WEFT_PIXEL_F32, &alone, error);
    if (result != WEFT_OK) return result;
    for (size_t n = 0; n < count; n++) ((float *)alone.pixels)[n] = ((const float *)errors->pixels)[3 * n];
    result = weft_image_write_as(path, &alone, &how, error);
    weft_image_free(&alone);
    return result;
}

static int files_write(const Audit *audit) {
    WeftError error;
    WeftImage sheet = {0};
    const AuditSheet desc = {
        .audit = &audit->found, .errors = &audit->errors, .name = audit->path, .lobe = lobe_id(audit)};
    int cursor = 0, result = 0;
    for (const char *path; result == 0 && (path = option_next(audit->options, "-o", &cursor));) {
        WeftResult one = WEFT_OK;
        if (path_ends(path, ".png")) {
            if (!sheet.pixels) one = audit_sheet(&desc, &sheet, &error);
            if (one == WEFT_OK) one = weft_image_write(path, &sheet, &error);
        } else {
            one = errors_write(audit, path, &error);
        }
        if (one != WEFT_OK) result = report_error(&error);
    }
    weft_image_free(&sheet);
    return result;
}

int audit_run(const Options *options) {
    Audit audit = {0};
    int result = audit_read(options, &audit);
    if (result == 0) result = channel_find(&audit);
    if (result == 0) {
        interrupt_watch();
        result = audit_make(&audit);
    }
    if (result == 0) result = files_write(&audit);
    if (result == 0 && option_given(options, "--json"))
        json_write(&audit);
    else if (result == 0)
        text_write(&audit);
    if (result == 0 && audit.found.beyond > 0.0) {
        fflush(stdout);
        result = report(WEFT_FAILED, "%s: its largest error is %.4g, more than %g", audit.path, audit.found.largest,
                        audit.most);
    }
    weft_image_free(&audit.file);
    weft_image_free(&audit.errors);
    return result;
}
