/* match_asset.c - a glTF file for another engine, or for the other workflow */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/path.h"
#include "cli/console/interrupt.h"
#include "cli/console/json_writer.h"
#include "cli/console/names.h"
#include "cli/console/output.h"
#include "cli/console/progress.h"
#include "cli/console/report.h"
#include "cli/match/match_verb.h"

static int needs(const Options *options, const char **out) {
    *out = option_text(options, "-o");
    if (!*out) return report(WEFT_USAGE, "%.200s: -o OUT is required", options->operands[0]);
    if (!path_ends(*out, ".gltf") && !path_ends(*out, ".glb"))
        return report(WEFT_USAGE, "%.200s: an asset is written as .gltf or .glb", *out);
    return output_probe_other(options, *out);
}

static void values_text(const float *v, bool color, char text[48]) {
    if (color)
        snprintf(text, 48, "%.4g,%.4g,%.4g", (double)v[0], (double)v[1], (double)v[2]);
    else
        snprintf(text, 48, "%.4g", (double)v[0]);
}

static void asset_text(const WeftAssetMatch *matches, int count, WeftBrdfMetric metric) {
    WeftInputInfo info;
    char was[48], now[48];
    for (int k = 0; k < count; k++) {
        const WeftAssetMatch *match = &matches[k];
        print_name(match->name[0] ? match->name : "(no name)");
        printf("%s\n", match->changed ? "" : ": has no sheen, or is unlit, and stays");
        if (!match->changed) continue;
        printf("  %-18s %-22.4f %.4f\n", weft_brdf_metric_name(metric), match->found.copied, match->found.matched);
        for (int n = 0; weft_material_input_info(n, &info); n++) {
            bool color = info.kind == WEFT_INPUT_COLOR;
            values_text(match->copied.inputs[n].value, color, was);
            values_text(match->matched.inputs[n].value, color, now);
            const bool rewritten = match->maps >> n & 1;
            if (strcmp(was, now) != 0 || rewritten)
                printf("  %-18s %-22s %s%s\n", info.name, was, now, rewritten ? " and a new texture" : "");
        }
        if (match->clipped) printf("  a factor ends at 1, where the match went beyond\n");
    }
}

static bool has_changed(const WeftAssetMatch *match, int input) {
    const float *was = match->copied.inputs[input].value, *now = match->matched.inputs[input].value;
    for (int c = 0; c < 3; c++)
        if (was[c] < now[c] || was[c] > now[c]) return true;
    return false;
}

static void asset_json(const WeftAssetMatch *matches, int count, WeftBrdfMetric metric, const char *out) {
    Json json = {.stream = stdout};
    WeftInputInfo info;
    json_open(&json, NULL, '{');
    json_text(&json, "metric", weft_brdf_metric_name(metric));
    json_text(&json, "output", out);
    json_open(&json, "materials", '[');
    for (int k = 0; k < count; k++) {
        const WeftAssetMatch *match = &matches[k];
        json_open(&json, NULL, '{');
        json_text(&json, "material", match->name);
        json_bool(&json, "changed", match->changed != 0);
        json_bool(&json, "clipped", match->clipped != 0);
        json_number(&json, "copied", match->found.copied);
        json_number(&json, "matched", match->found.matched);
        json_open(&json, "factors", '{');
        for (int n = 0; weft_material_input_info(n, &info); n++)
            if (has_changed(match, n))
                json_floats(&json, info.name, match->matched.inputs[n].value, info.kind == WEFT_INPUT_COLOR ? 3 : 1);
        json_close(&json, '}');
        json_open(&json, "textures", '[');
        for (int n = 0; weft_material_input_info(n, &info); n++)
            if (match->maps >> n & 1) json_text(&json, NULL, info.name);
        json_close(&json, ']');
        json_close(&json, '}');
    }
    json_close(&json, ']');
    json_close(&json, '}');
}

static int to_engine(const Options *options, const char *out, WeftBrdfMetric metric) {
    const char *path = options->operands[0];
    const WeftLog log = {.fn = report_warning};
    WeftError error;
    WeftAssetMatch *matches;
    int count = 0;
    int from = kind_named(kind_of("profile"), option_text(options, "--from"));
    int to = from < 0 ? -1 : kind_named(kind_of("profile"), option_text(options, "--to"));
    if (to < 0) return WEFT_USAGE;
    Progress progress = progress_start_count(false, "of the searches", 0.0);
    interrupt_watch();
    WeftResult result =
        weft_match_asset(path, out, from, to, metric, progress_heed, &progress, &matches, &count, &log, &error);
    progress_finish(&progress);
    if (result == WEFT_INTERRUPTED) return report(WEFT_INTERRUPTED, "%s: interrupted; nothing was written", path);
    if (result != WEFT_OK) return report_error(&error);
    if (option_given(options, "--json"))
        asset_json(matches, count, metric, out);
    else
        asset_text(matches, count, metric);
    weft_match_report_free(matches);
    return 0;
}

static void losses_write(const WeftScene *scene, const float *losses, int count, bool as_json, const char *out) {
    Json json = {.stream = stdout};
    if (as_json) {
        json_open(&json, NULL, '{');
        json_text(&json, "output", out);
        json_open(&json, "materials", '[');
    }
    for (int k = 0; k < count; k++) {
        const char *name = weft_scene_material_name(scene, k);
        if (as_json) {
            json_open(&json, NULL, '{');
            json_text(&json, "material", name);
            json_bool(&json, "converted", !(losses[k] < 0.0f));
            if (!(losses[k] < 0.0f)) json_float(&json, "loss", losses[k]);
            json_close(&json, '}');
        } else if (losses[k] < 0.0f) {
            print_name(name[0] ? name : "(no name)");
            printf(": %s\n", losses[k] < -1.5f ? "is of that workflow already" : "is of another workflow and stays");
        } else {
            print_name(name[0] ? name : "(no name)");
            printf(": converted, off by %.4f at most\n", (double)losses[k]);
        }
    }
    if (!as_json) return;
    json_close(&json, ']');
    json_close(&json, '}');
}

/* Converts the asset with weft_scene_convert, from metallic to specular or back, and saves it. */
static int to_workflow(const Options *options, const char *out) {
    const WeftLog log = {.fn = report_warning};
    WeftError error;
    WeftScene *scene;
    WeftResult result = weft_scene_load(options->operands[0], &scene, &log, &error);
    if (result != WEFT_OK) return report_error(&error);
    int count = weft_scene_info(scene).material_count;
    float *losses = calloc((size_t)count + 1, sizeof *losses);
    if (!losses) {
        weft_scene_free(scene);
        return report(WEFT_RESOURCES, "%s", weft_message_text(WEFT_MESSAGE_MEMORY));
    }
    result = weft_scene_convert(scene, option_text(options, "--workflow"), losses, &error);
    if (result == WEFT_OK) result = weft_scene_save(scene, out, &error);
    if (result == WEFT_OK) losses_write(scene, losses, count, option_given(options, "--json"), out);
    free(losses);
    weft_scene_free(scene);
    return result == WEFT_OK ? 0 : report_error(&error);
}

int match_asset(const Options *options, WeftBrdfMetric metric) {
    const char *out;
    int result = needs(options, &out);
    if (result != 0) return result;
    return option_given(options, "--to") ? to_engine(options, out, metric) : to_workflow(options, out);
}
