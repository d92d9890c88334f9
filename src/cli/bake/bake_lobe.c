/* bake_lobe.c - `weft bake lobe`: a measured BRDF as a lobe of one's own, and a material that has it */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/path.h"
#include "cli/bake/bake.h"
#include "cli/console/json_writer.h"
#include "cli/console/output.h"
#include "cli/console/report.h"

/* Returns the path of the lobe's .h among the -o, which names the lobe; NULL after one line. */
static const char *lobe_path(const Options *options) {
    const char *found = NULL;
    int cursor = 0;
    for (const char *path; (path = option_next(options, "-o", &cursor));) {
        bool lobe = path_ends(path, ".h");
        if ((lobe && found) || (!lobe && !path_ends(path, ".json"))) {
            report(WEFT_USAGE, "%.200s: a measured lobe is one .h, and its material a .json", path);
            return NULL;
        }
        if (lobe) found = path;
    }
    if (!found) report(WEFT_USAGE, "bake lobe: needs -o NAME.h");
    return found;
}

static int name_of(const char *path, char name[64]) {
    const char *slash = strrchr(path, '/'), *file = slash ? slash + 1 : path;
    size_t length = strlen(file) - 2;
    if (length >= 64) return report(WEFT_USAGE, "%.200s: has too long a name for a lobe", path);
    memcpy(name, file, length);
    name[length] = '\0';
    return 0;
}

/* Writes the material: the lobe over a black base. */
static void material_put(FILE *stream, const char *name, const WeftDataLobe *lobe) {
    char id[64];
    Json json = {.stream = stream};
    snprintf(id, sizeof id, "%s", name);
    for (char *c = id; *c; c++)
        if (*c == '_') *c = '-';
    json_open(&json, NULL, '{');
    json_text(&json, "workflow", "cloth");
    json_text(&json, "layer", "additive");
    json_text(&json, "sheen_lobe", id);
    json_floats(&json, "base_color", (const float[3]){0.0f, 0.0f, 0.0f}, 3);
    json_floats(&json, "sheen_color", lobe->f0, 3);
    json_floats(&json, "sheen_second", lobe->f90, 3);
    json_close(&json, '}');
}

static int file_write(const char *path, const char *name, const char *text, const WeftDataLobe *lobe) {
    Output output;
    int result = output_begin(&output, path);
    if (result != 0) return result;
    if (path_ends(path, ".h"))
        fputs(text, output.stream);
    else
        material_put(output.stream, name, lobe);
    return output_end(&output);
}

/* Reads, fits and writes. */
static int lobe_make(const Options *options, const char *data_path, const char *name) {
    WeftError error;
    WeftData *data;
    WeftDataLobe lobe;
    char *text = NULL, about[256];
    int result = 0, cursor = 0;
    if (weft_data_read(data_path, &data, &error) != WEFT_OK) return report_error(&error);
    snprintf(about, sizeof about, "Made by weft bake lobe of %.200s", data_path);
    if (weft_data_lobe(data, name, about, &text, &lobe, &error) != WEFT_OK) result = report_error(&error);
    for (const char *path; result == 0 && (path = option_next(options, "-o", &cursor));)
        result = file_write(path, name, text, &lobe);
    if (result == 0 && !option_given(options, "--quiet"))
        report(0, "%s: error %.4f, log, over the measurement; f0 %.3g,%.3g,%.3g, f90 %.3g,%.3g,%.3g", data_path,
               lobe.error, (double)lobe.f0[0], (double)lobe.f0[1], (double)lobe.f0[2], (double)lobe.f90[0],
               (double)lobe.f90[1], (double)lobe.f90[2]);
    free(text);
    weft_data_free(data);
    return result;
}

int bake_lobe_run(const Options *options) {
    char name[64];
    int cursor = 0;
    if (options->operand_count < 2)
        return report(WEFT_USAGE, "bake lobe: needs a measurement: weft bake lobe DATA -o NAME.h");
    const char *path = lobe_path(options);
    int result = path ? name_of(path, name) : WEFT_USAGE;
    for (const char *each; result == 0 && (each = option_next(options, "-o", &cursor));)
        result = output_probe_other(options, each);
    return result == 0 ? lobe_make(options, options->operands[1], name) : result;
}
