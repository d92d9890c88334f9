/* models.c - `weft models`: what there is to choose from */
#include <stdio.h>
#include <string.h>

#include "json.h"
#include "layout.h"
#include "names.h"
#include "report.h"
#include "verbs.h"
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
};
enum { TRAIT_COUNT = sizeof traits / sizeof *traits };

/* A list of names such as weft_builtin_name and weft_builtin_help make. */
typedef const char *Listed(int index);

static void append(char *line, size_t size, const char *separator, const char *text) {
    size_t used = strlen(line);
    snprintf(line + used, size - used, "%s%s", used ? separator : "", text);
}

static void lobe_words(const WeftLobeInfo *info, char *line, size_t size) {
    line[0] = '\0';
    for (int k = 0; k < TRAIT_COUNT; k++)
        if (info->traits & traits[k].bit) append(line, size, ", ", traits[k].words);
}

static void print_lobe_line(const WeftLobeInfo *info) {
    char line[512];
    lobe_words(info, line, sizeof line);
    for (int k = 0; k < info->param_count; k++)
        append(line, sizeof line, k ? ", " : "; parameters: ", info->params[k].name);
    layout_entry(stdout, 26, info->id, line);
}

static void print_list(const char *heading, const char *prefix, Listed *name, Listed *help) {
    printf("\n%s\n", heading);
    for (int k = 0; name(k); k++) {
        char full[128];
        snprintf(full, sizeof full, "%s%s", prefix, name(k));
        layout_entry(stdout, 26, full, help(k));
    }
}

static void print_all(void) {
    printf("Lobes\n");
    for (int k = 0; k < weft_lobe_count(); k++) print_lobe_line(weft_lobe_info(k));
    print_list("Layer rules: how a sheen sits on its base", "", weft_layer_id, weft_layer_help);
    print_list("Material inputs: render --set MATERIAL.INPUT=VALUE", "", weft_material_input_name,
               weft_material_input_help);
    print_list("Built-in scenes", "builtin:", weft_builtin_name, weft_builtin_help);
}

/* One row of a lobe's parameter table. */
static void print_row(const char *name, const char *def, const char *range, const char *hard,
                      const char *help) {
    char left[96];
    snprintf(left, sizeof left, "%-10s  %-7s  %-9s  %s", name, def, range, hard);
    layout_entry(stdout, 46, left, help);
}

static void print_lobe(const WeftLobeInfo *info) {
    print_lobe_line(info);
    printf("\n");
    print_row("parameter", "default", "range", "clamped to", "meaning");
    for (int k = 0; k < info->param_count; k++) {
        const WeftParamInfo *p = &info->params[k];
        char def[16], range[32], hard[32];
        snprintf(def, sizeof def, "%g", (double)p->def);
        snprintf(range, sizeof range, "%g .. %g", (double)p->low, (double)p->high);
        snprintf(hard, sizeof hard, "%g .. %g", (double)p->hard_low, (double)p->hard_high);
        print_row(p->name, def, range, hard, p->help);
    }
    print_row("color", "1", "0 .. 1", "", "r,g,b or one number; also called f0");
    if (info->traits & WEFT_LOBE_TWO_COLORS)
        print_row("f90", "1", "0 .. 1", "", "the second colour; at grazing, of a Fresnel term");
}

static void json_lobe(Json *json, const WeftLobeInfo *info) {
    json_open(json, NULL, '{');
    json_text(json, "id", info->id);
    json_open(json, "traits", '[');
    for (int k = 0; k < TRAIT_COUNT; k++)
        if (info->traits & traits[k].bit) json_text(json, NULL, traits[k].id);
    json_close(json, ']');
    json_open(json, "parameters", '[');
    for (int k = 0; k < info->param_count; k++) {
        const WeftParamInfo *p = &info->params[k];
        json_open(json, NULL, '{');
        json_text(json, "name", p->name);
        json_text(json, "help", p->help);
        json_float(json, "default", p->def);
        json_floats(json, "range", (float[]){p->low, p->high}, 2);
        json_floats(json, "clamp", (float[]){p->hard_low, p->hard_high}, 2);
        json_close(json, '}');
    }
    json_close(json, ']');
    json_close(json, '}');
}

static void json_list(Json *json, const char *key, Listed *name, Listed *help) {
    json_open(json, key, '[');
    for (int k = 0; name(k); k++) {
        json_open(json, NULL, '{');
        json_text(json, "id", name(k));
        json_text(json, "help", help(k));
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void json_all(Json *json) {
    json_open(json, NULL, '{');
    json_open(json, "lobes", '[');
    for (int k = 0; k < weft_lobe_count(); k++) json_lobe(json, weft_lobe_info(k));
    json_close(json, ']');
    json_list(json, "layers", weft_layer_id, weft_layer_help);
    json_list(json, "inputs", weft_material_input_name, weft_material_input_help);
    json_list(json, "scenes", weft_builtin_name, weft_builtin_help);
    json_close(json, '}');
}

static int models_run(const Options *options) {
    Json json = {.stream = stdout};
    bool as_json = option_given(options, "--json");
    if (options->operand_count == 0) {
        if (as_json)
            json_all(&json);
        else
            print_all();
        return 0;
    }
    int lobe = lobe_named(options->operands[0]);
    if (lobe < 0) return WEFT_USAGE;
    if (as_json)
        json_lobe(&json, weft_lobe_info(lobe));
    else
        print_lobe(weft_lobe_info(lobe));
    return 0;
}

static const Option models_options[] = {
    OPTION_HEADING("Options"),
    OPTION_SWITCH("--json", "one JSON object instead of text"),
    OPTION_END,
};

const Verb verb_models = {
    .name = "models",
    .operands = "[LOBE] [options]",
    .help = "lists lobes, layer rules, material inputs and built-in scenes",
    .operands_most = 1,
    .options = models_options,
    .notes = "Without LOBE everything is listed; with it, the parameters of that lobe.\n\n"
             "Examples\n"
             "  weft models\n"
             "  weft models charlie-neubelt\n",
    .run = models_run,
};
