/* models.c - `weft models`: the catalogue: every lobe, term, profile, preset and choice */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/console/json_writer.h"
#include "cli/console/names.h"
#include "cli/console/report.h"
#include "cli/console/two_columns.h"
#include "cli/operands/lobes.h"
#include "cli/pages/catalogue_page.h"
#include "cli/pages/chart_sheet.h"
#include "cli/verbs/verbs.h"
#include "weft/weft.h"

static const struct {
    unsigned bit;
    const char *id, *words;
} traits[] = {
    {WEFT_LOBE_RECIPROCAL, "reciprocal", "reciprocal"},
    {WEFT_LOBE_CONSERVES, "conserves", "never reflects more than it receives"},
    {WEFT_LOBE_LOSSLESS, "lossless", "loses nothing when white"},
    {WEFT_LOBE_TWO_COLORS, "two-colors", "mixes two colours, f0 and f90"},
    {WEFT_LOBE_ANISOTROPIC, "anisotropic", "anisotropic"},
    {WEFT_LOBE_REFERENCE, "reference", "for the path tracer only"},
    {WEFT_LOBE_DIFFUSE, "diffuse", "a diffuse term"},
    {WEFT_LOBE_TABLE, "table", "reads a table"},
    {WEFT_LOBE_TINTED, "tinted", "its colour is the albedo of fibres, no factor"},
};
enum { TRAIT_COUNT = sizeof traits / sizeof *traits, COLUMN = 32 };

static void append(char *line, size_t size, const char *separator, const char *text) {
    size_t used = strlen(line);
    snprintf(line + used, size - used, "%s%s", used ? separator : "", text);
}

/* Returns the lobe of an entry of a kind; NULL if the kind does not list lobes. */
static const WeftLobeInfo *entry_lobe(const Kind *kind, int k) {
    return strstr(kind->id, "lobe") || strcmp(kind->key, "diffuse") == 0 ? weft_lobe_info(weft_lobe_find(kind->name(k)))
                                                                         : NULL;
}

/* Returns the reference material of an entry; NULL if the kind is not that of the chart. */
static const WeftChartEntry *entry_chart(const Kind *kind, int k) {
    return strcmp(kind->id, "chart material") == 0 ? weft_chart(k) : NULL;
}

/* Returns the choice of an entry, or -1. */
static int entry_choice(const Kind *kind, int k) { return strcmp(kind->id, "choice") == 0 ? k : -1; }

static void lobe_words(const WeftLobeInfo *info, char *line, size_t size) {
    line[0] = '\0';
    for (int k = 0; k < TRAIT_COUNT; k++)
        if (info->traits & traits[k].bit) append(line, size, ", ", traits[k].words);
    for (int k = 0; k < info->param_count; k++) append(line, size, k ? ", " : "; parameters: ", info->params[k].name);
}

static void append_color(char *line, size_t size, const char *key, const float color[3]) {
    char text[64];
    bool grey = color[0] <= color[1] && color[1] <= color[2] && color[2] <= color[0];
    if (grey)
        snprintf(text, sizeof text, "%s %.3g", key, (double)color[0]);
    else
        snprintf(text, sizeof text, "%s %.3g,%.3g,%.3g", key, (double)color[0], (double)color[1], (double)color[2]);
    append(line, size, "; ", text);
}

/* Writes an entry's numbers as `--set` takes them. */
static void chart_words(const WeftChartEntry *entry, char *line, size_t size) {
    char ior[32];
    if (entry->kind == WEFT_CHART_METAL || entry->kind == WEFT_CHART_OPAQUE)
        append_color(line, size, "base_color", entry->base_color);
    if (entry->kind != WEFT_CHART_METAL) append_color(line, size, "F0", entry->f0);
    snprintf(ior, sizeof ior, "ior %.5g", (double)entry->ior);
    append(line, size, "; ", entry->kind == WEFT_CHART_METAL ? "metallic 1" : ior);
}

static void print_entry(const Kind *kind, int k) {
    char line[512];
    const WeftLobeInfo *lobe = entry_lobe(kind, k);
    const WeftChartEntry *chart = entry_chart(kind, k);
    snprintf(line, sizeof line, "%s", kind->help(k));
    if (lobe) lobe_words(lobe, line, sizeof line);
    if (chart) chart_words(chart, line, sizeof line);
    layout_entry(stdout, COLUMN, kind->name(k), line);
}

/* Prints the entries of a group; NULL: all. */
static void print_group(const Kind *kind, const char *group) {
    for (int k = 0; kind->name(k); k++)
        if (!group || strcmp(kind->groups->of(k), group) == 0) print_entry(kind, k);
}

static void print_kind(const Kind *kind) {
    printf("%s\n", kind->heading);
    if (!kind->groups) print_group(kind, NULL);
    for (int g = 0; kind->groups && kind->groups->name(g); g++) {
        printf("%s %s: %s\n", g ? "\n" : "", kind->groups->name(g), kind->groups->help(g));
        print_group(kind, kind->groups->name(g));
    }
}

static void print_all(void) {
    for (const Kind *kind = kinds; kind->id; kind++) {
        if (!kind->shown || !kind->name(0)) continue;
        if (kind != kinds) printf("\n");
        print_kind(kind);
    }
}

/* Prints one row of a lobe's parameter table. */
static void print_row(const char *name, const char *def, const char *range, const char *hard, const char *help) {
    char left[96];
    snprintf(left, sizeof left, "%-10s  %-7s  %-9s  %s", name, def, range, hard);
    layout_entry(stdout, 46, left, help);
}

static void print_param(const WeftParamInfo *p) {
    char def[16] = "an id", range[32] = "", hard[32] = "", help[768];
    snprintf(help, sizeof help, "%s", p->help);
    if (p->choices) {
        for (int c = 0; p->choices[c]; c++) append(help, sizeof help, c ? " " : ": ", p->choices[c]);
        append(help, sizeof help, "; by default ", p->choices[(int)p->def]);
    } else {
        snprintf(def, sizeof def, "%g", (double)p->def);
        snprintf(range, sizeof range, "%g .. %g", (double)p->low, (double)p->high);
        snprintf(hard, sizeof hard, "%g .. %g", (double)p->hard_low, (double)p->hard_high);
    }
    print_row(p->name, def, range, hard, help);
}

static void print_lobe(const WeftLobeInfo *info) {
    printf("\n");
    print_row("parameter", "default", "range", "clamped to", "meaning");
    for (int k = 0; k < info->param_count; k++) print_param(&info->params[k]);
    print_row("color", "1", "0 .. 1", "",
              info->traits & WEFT_LOBE_TINTED ? "albedo of the fibres, r,g,b or one number; also called f0"
                                              : "r,g,b or one number; also called f0");
    if (info->traits & WEFT_LOBE_TWO_COLORS)
        print_row("f90", "1", "0 .. 1", "", "the second colour; at grazing, of a Fresnel term");
}

static void json_param(Json *json, const WeftParamInfo *p) {
    json_open(json, NULL, '{');
    json_text(json, "name", p->name);
    json_text(json, "help", p->help);
    if (p->choices) {
        json_text(json, "default", p->choices[(int)p->def]);
        json_open(json, "values", '[');
        for (int k = 0; p->choices[k]; k++) json_text(json, NULL, p->choices[k]);
        json_close(json, ']');
    } else {
        json_float(json, "default", p->def);
        json_floats(json, "range", (float[]){p->low, p->high}, 2);
        json_floats(json, "clamp", (float[]){p->hard_low, p->hard_high}, 2);
    }
    json_close(json, '}');
}

static void json_lobe(Json *json, const WeftLobeInfo *info) {
    json_open(json, "traits", '[');
    for (int k = 0; k < TRAIT_COUNT; k++)
        if (info->traits & traits[k].bit) json_text(json, NULL, traits[k].id);
    json_close(json, ']');
    json_open(json, "parameters", '[');
    for (int k = 0; k < info->param_count; k++) json_param(json, &info->params[k]);
    json_close(json, ']');
}

/* Writes the ids that a choice may take, without those that `--set` would refuse. */
static void json_values(Json *json, int choice) {
    json_open(json, "values", '[');
    json_text(json, NULL, "auto");
    for (int k = 0; weft_material_choice_value(choice, k); k++)
        if (weft_material_choice_fits(choice, k)) json_text(json, NULL, weft_material_choice_value(choice, k));
    json_close(json, ']');
}

static void json_chart(Json *json, const WeftChartEntry *entry) {
    static const char *const names[] = {"opaque", "clear", "gem", "metal"}; /* as WeftChartKind */
    json_text(json, "material", names[entry->kind]);
    json_floats(json, "base_color", entry->base_color, 3);
    json_floats(json, "f0", entry->f0, 3);
    if (entry->kind != WEFT_CHART_METAL) json_float(json, "ior", entry->ior);
    json_text(json, "source", entry->source);
}

static void json_entry(Json *json, const Kind *kind, int k, bool with_kind) {
    const WeftLobeInfo *lobe = entry_lobe(kind, k);
    json_open(json, NULL, '{');
    if (with_kind) json_text(json, "kind", kind->id);
    json_text(json, "id", kind->name(k));
    if (lobe)
        json_lobe(json, lobe);
    else
        json_text(json, "help", kind->help(k));
    if (kind->groups) json_text(json, "group", kind->groups->of(k));
    if (entry_choice(kind, k) >= 0) json_values(json, k);
    if (entry_chart(kind, k)) json_chart(json, entry_chart(kind, k));
    if (strcmp(kind->id, "preset") == 0) json_text(json, "text", weft_preset_text(k));
    char *page = with_kind ? page_text(kind, kind->name(k)) : NULL;
    if (page) json_text(json, "page", page);
    free(page);
    json_close(json, '}');
}

/* Returns true if the kind is listed in JSON. "lobe" lists all lobes; their traits show which are diffuse. */
static bool in_json(const Kind *kind) { return strcmp(kind->id, "lobe") == 0 || (kind->shown && !entry_lobe(kind, 0)); }

static void json_kind(Json *json, const Kind *kind, const char *key) {
    json_open(json, key, '[');
    for (int k = 0; kind->name(k); k++) json_entry(json, kind, k, false);
    json_close(json, ']');
}

static void json_all(Json *json) {
    json_open(json, NULL, '{');
    for (const Kind *kind = kinds; kind->id; kind++)
        if (in_json(kind)) json_kind(json, kind, kind->key);
    json_close(json, '}');
}

/* Prints one entry with all its details. */
static void print_one(const Kind *kind, int k) {
    char *page = page_text(kind, kind->name(k));
    printf("%c%s\n", kind->id[0] & ~0x20, kind->id + 1);
    print_entry(kind, k);
    if (page) printf("\n%s", page);
    if (entry_lobe(kind, k)) print_lobe(entry_lobe(kind, k));
    if (strcmp(kind->id, "preset") == 0) printf("\n%s", weft_preset_text(k));
    if (entry_chart(kind, k)) layout_entry(stdout, COLUMN, "source", entry_chart(kind, k)->source);
    for (int v = 0; entry_choice(kind, k) >= 0 && weft_material_choice_value(k, v); v++)
        if (weft_material_choice_fits(k, v))
            layout_entry(stdout, COLUMN, v ? "" : "may be auto or", weft_material_choice_value(k, v));
    free(page);
}

static int no_such_id(const char *id) {
    char hint[96];
    Nearest nearest = {.typed = id};
    for (const Kind *kind = kinds; kind->id; kind++)
        for (int k = 0; kind->name(k); k++) nearest_offer(&nearest, kind->name(k));
    return report(WEFT_USAGE, "%.200s: is not an id of anything%s", id,
                  nearest.name ? nearest_hint(&nearest, hint, sizeof hint) : "; `weft models` lists them");
}

/* Prints the ids that begin with id and a dash. */
static void print_related(const char *id) {
    char line[512] = "";
    size_t length = strlen(id);
    for (const Kind *kind = kinds; kind->id; kind++)
        for (int k = 0; in_json(kind) && kind->name(k); k++)
            if (strncmp(kind->name(k), id, length) == 0 && kind->name(k)[length] == '-')
                append(line, sizeof line, ", ", kind->name(k));
    if (!line[0]) return;
    printf("\n");
    layout_entry(stdout, COLUMN, "see also", line);
}

static void show_one(const Kind *kind, int k, Json *json, bool first) {
    if (json) {
        json_entry(json, kind, k, true);
        return;
    }
    if (!first) printf("\n");
    print_one(kind, k);
}

static int list_kind(const Kind *kind, Json *json) {
    if (json)
        json_kind(json, kind, NULL);
    else
        print_kind(kind);
    return 0;
}

/* Shows the entries of an id, which several kinds may have: "cook-torrance" is a lobe, a V and an F. only is the one
 * kind to look in, NULL for all. The name of a kind that is no id lists the kind. */
static int show(const char *id, const Kind *only, Json *json) {
    int found = 0;
    const Kind *named = kind_prefixed(id, (int)strlen(id));
    if (named && strlen(id) + 1 < strlen(named->key)) named = NULL; /* "preset" and "presets", but not "pre" */
    for (const Kind *kind = kinds; kind->id; kind++)
        found += (only ? kind == only : in_json(kind)) && kind_find(kind, id) >= 0;
    if (!found) return named ? list_kind(named, json) : no_such_id(id);
    if (json) json_open(json, NULL, '[');
    found = 0;
    for (const Kind *kind = kinds; kind->id; kind++)
        if ((only ? kind == only : in_json(kind)) && kind_find(kind, id) >= 0)
            show_one(kind, kind_find(kind, id), json, !found++);
    if (json)
        json_close(json, ']');
    else if (!only)
        print_related(id);
    return 0;
}

/* Shows KIND: or KIND:ID. For a preset it prints the material file and nothing else. */
static int show_of_kind(const char *text, const char *colon, Json *json) {
    const Kind *kind = kind_prefixed(text, (int)(colon - text));
    if (!kind)
        return report(WEFT_USAGE, "%.200s: the word before the colon is not a kind that `weft models` lists", text);
    if (!colon[1]) return list_kind(kind, json);
    int k = kind_named(kind, colon + 1);
    if (k < 0) return WEFT_USAGE;
    if (json || strcmp(kind->id, "preset") != 0) return show(colon + 1, kind, json);
    fputs(weft_preset_text(k), stdout);
    return 0;
}

static int models_run(const Options *options) {
    Json stream = {.stream = stdout}, *json = option_given(options, "--json") ? &stream : NULL;
    const char *id = options->operand_count > 0 ? options->operands[0] : NULL, *colon,
               *out = option_text(options, "-o");
    if (out && (!id || strcmp(id, "chart:") != 0))
        return report(WEFT_USAGE, "-o: only the chart is drawn: weft models chart: -o OUT");
    if (out) return chart_sheet_write(out);
    if (id && (colon = strchr(id, ':'))) return show_of_kind(id, colon, json);
    if (id) return show(id, NULL, json);
    if (json)
        json_all(json);
    else
        print_all();
    return 0;
}

static const Option models_options[] = {
    OPTION_HEADING("Options"),
    OPTION_SWITCH("--json", "JSON instead of text: an object of lists, or for ID a list of what has that id"),
    OPTION_LOBES,
    OPTION_TEXT("-o", "OUT", NULL, "with chart: only: write the swatches as a picture, .png"),
    OPTION_END,
};

const Verb verb_models = {
    .name = "models",
    .operands = "[ID] [options]",
    .help = "lists terms, lobes, layers, profiles, presets, weaves ...",
    .operands_most = 1,
    .options = models_options,
    .notes = "Without ID everything is listed, by kind; with it, all that has that id: what\n"
             "one sees, formula and source, of a lobe its parameters, of a choice its values,\n"
             "of a preset its material file, of a reference material who measured it. KIND:ID\n"
             "is one of them: lobe:cook-torrance, d:charlie, layer:seed, profile:three; KIND:\n"
             "or its plural alone lists all of a kind. preset:NAME prints a material file and\n"
             "nothing else; chart: with -o draws the reference materials as swatches. Presets\n"
             "are listed by groups: woven, pile, smooth and so on.\n\n"
             "Examples\n"
             "  weft models\n"
             "  weft models charlie-neubelt\n"
             "  weft models preset:velvet > my-velvet.json\n"
             "  weft models chart: -o chart.png\n",
    .run = models_run,
};
