/* match_table.c - every profile matched to every other: the error with the same numbers, and with matched ones */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/console/interrupt.h"
#include "cli/console/json_writer.h"
#include "cli/console/progress.h"
#include "cli/console/report.h"
#include "cli/match/match_verb.h"

enum { PROFILES_MOST = 32 };

typedef struct MatchTable {
    int count;
    Model from[PROFILES_MOST];
    WeftMatchJob *jobs; /* [from][to] */
} MatchTable;

static int prepare(MatchTable *table) {
    char typed[64];
    int result = 0;
    for (; result == 0 && weft_profile_name(table->count) && table->count < PROFILES_MOST; table->count++) {
        snprintf(typed, sizeof typed, "profile:%s", weft_profile_name(table->count));
        result = model_read(typed, &table->from[table->count]);
    }
    if (result != 0) return result;
    table->jobs = calloc((size_t)PROFILES_MOST * PROFILES_MOST, sizeof *table->jobs);
    if (!table->jobs) return report(WEFT_RESOURCES, "%s", weft_message_text(WEFT_MESSAGE_MEMORY));
    WeftError error;
    for (int from = 0; from < table->count; from++)
        for (int to = 0; to < table->count; to++) {
            WeftMatchJob *job = &table->jobs[from * table->count + to];
            job->from = table->from[from].reflection;
            job->material = table->from[from].material;
            if (weft_material_set(&job->material, "profile", weft_profile_name(to), NULL, &error) != WEFT_OK)
                return report_error(&error);
        }
    return 0;
}

/* Writes the changes, in the order of the inputs. */
static void changes_text(const MatchTable *table, int from, const WeftMatchJob *job, char *text, size_t size) {
    const WeftMaterial *was = &table->from[from].material;
    WeftInputInfo info;
    size_t used = 0;
    text[0] = '\0';
    for (int k = 0; weft_material_input_info(k, &info) && used < size; k++) {
        float a = was->inputs[k].value[0], b = job->material.inputs[k].value[0];
        if (a < b || a > b)
            used += (size_t)snprintf(text + used, size - used, "%s%s %.3g", used ? ", " : "", info.name, (double)b);
    }
}

static void text_write(const MatchTable *table, WeftBrdfMetric metric) {
    char text[300];
    printf("%-14s %-14s %7s %7s  %s\n", "from", "to", "copied", "matched", weft_brdf_metric_name(metric));
    for (int k = 0; k < table->count * table->count; k++) {
        int from = k / table->count, to = k % table->count;
        const WeftMatchJob *job = &table->jobs[k];
        if (from == to) continue;
        changes_text(table, from, job, text, sizeof text);
        printf("%-14s %-14s %7.4f %7.4f  %s\n", weft_profile_name(from), weft_profile_name(to), job->found.copied,
               job->found.matched, text);
    }
}

static void json_write(const MatchTable *table, WeftBrdfMetric metric) {
    Json json = {.stream = stdout};
    WeftInputInfo info;
    json_open(&json, NULL, '{');
    json_text(&json, "metric", weft_brdf_metric_name(metric));
    json_open(&json, "pairs", '[');
    for (int k = 0; k < table->count * table->count; k++) {
        const WeftMatchJob *job = &table->jobs[k];
        json_open(&json, NULL, '{');
        json_text(&json, "from", weft_profile_name(k / table->count));
        json_text(&json, "to", weft_profile_name(k % table->count));
        json_number(&json, "copied", job->found.copied);
        json_number(&json, "matched", job->found.matched);
        json_open(&json, "inputs", '{');
        for (int n = 0; weft_material_input_info(n, &info); n++)
            if (weft_match_is_free(&job->material, n))
                json_floats(&json, info.name, job->material.inputs[n].value, info.kind == WEFT_INPUT_COLOR ? 3 : 1);
        json_close(&json, '}');
        json_close(&json, '}');
    }
    json_close(&json, ']');
    json_close(&json, '}');
}

static int match_all(MatchTable *table, WeftBrdfMetric metric) {
    WeftError error;
    int count = table->count * table->count;
    Progress progress = progress_start_count(false, "matches", count);
    interrupt_watch();
    WeftResult result = weft_match_many(table->jobs, count, metric, 0, progress_heed, &progress, &error);
    progress_finish(&progress);
    if (result == WEFT_INTERRUPTED) return report(WEFT_INTERRUPTED, "interrupted");
    return result == WEFT_OK ? 0 : report_error(&error);
}

int match_table(const Options *options, WeftBrdfMetric metric) {
    MatchTable table = {.count = 0};
    int result = prepare(&table);
    if (result == 0) result = match_all(&table, metric);
    if (result == 0 && option_given(options, "--json"))
        json_write(&table, metric);
    else if (result == 0)
        text_write(&table, metric);
    for (int k = 0; k < table.count; k++) model_free(&table.from[k]);
    free(table.jobs);
    return result;
}
