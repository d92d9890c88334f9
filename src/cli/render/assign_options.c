#include "cli/render/assign_options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/console/names.h"
#include "cli/console/report.h"
#include "weft/material.h"
#include "weft/weave.h"

/* Options whose value is the id of a choice for all materials, in the order in which they are applied. */
static const struct {
    const char *option, *kind, *choice;
} axes[] = {
    {"--workflow", "workflow", "workflow"},   {"--profile", "profile", "profile"},
    {"--diffuse", "diffuse term", "diffuse"}, {"--sheen", "lobe", "sheen_lobe"},
    {"--layer", "layer rule", "layer"},
};
enum { AXES = sizeof axes / sizeof *axes };

/* Returns the text after "by=", or NULL if text does not begin so. */
static const char *after_by(const char *text) {
    text += strspn(text, " ");
    return strncmp(text, "by=", 3) == 0 ? text + 3 : NULL;
}

/* Returns the end of the item that begins at text: a separator or the end. "RULE,by=channel" is one item. */
static const char *item_end(const char *text, char separator) {
    const char separators[] = {separator, '\0'};
    const char *end = text + strcspn(text, separators);
    while (*end && after_by(end + 1)) end += 1 + strcspn(end + 1, separators);
    return end;
}

static int item_count(const char *text, char separator) {
    int count = 1;
    for (const char *end = item_end(text, separator); *end; end = item_end(end + 1, separator)) count++;
    return count;
}

/* Copies item k of a list, without the blanks around it. A list of one item repeats it. Returns false if it is too long
 * for a value. */
static bool item_at(const char *text, char separator, int k, char item[ASSIGN_LABEL]) {
    const char *end = item_end(text, separator);
    while (k-- > 0 && *end) {
        text = end + 1;
        end = item_end(text, separator);
    }
    while (text < end && *text == ' ') text++;
    while (text < end && end[-1] == ' ') end--;
    return snprintf(item, ASSIGN_LABEL, "%.*s", (int)(end - text), text) < ASSIGN_LABEL;
}

/* Cuts "RULE,by=channel" into rule and "channel"; NULL where there is no such end. */
static const char *split_by(char *item) {
    char *comma = strchr(item, ',');
    if (!comma) return NULL;
    const char *by = after_by(comma + 1);
    do *comma = '\0';
    while (comma > item && *--comma == ' ');
    return by;
}

static bool check_item(int axis, const char *text, int k) {
    char item[ASSIGN_LABEL];
    if (!item_at(text, ',', k, item)) {
        report(WEFT_USAGE, "%s: \"%.80s\" is too long for an id", axes[axis].option, text);
        return false;
    }
    const char *by = split_by(item);
    if (by && (strcmp(axes[axis].choice, "layer") != 0 || (strcmp(by, "max") != 0 && strcmp(by, "channel") != 0))) {
        report(WEFT_USAGE, "%s: \"by=%.80s\" is not by=max or by=channel of a layer rule", axes[axis].option, by);
        return false;
    }
    const Kind *kind = kind_of(axes[axis].kind);
    if (item[0]) return kind_named(kind, item) >= 0;
    report(WEFT_USAGE, "%s: \"\" is not %s %s", axes[axis].option, kind->article, kind->id);
    return false;
}

/* Returns true if item k differs from the items before it, which were checked already. */
static bool check_once(const Varied *varied, int k) {
    char item[ASSIGN_LABEL], other[ASSIGN_LABEL];
    item_at(varied->values, varied->separator, k, item);
    for (int j = 0; j < k; j++) {
        item_at(varied->values, varied->separator, j, other);
        if (strcmp(item, other) != 0) continue;
        report(WEFT_USAGE, "%s: %s is listed twice", varied->option, item);
        return false;
    }
    return true;
}

/* Adds an option to those that vary, unless its list has only one value. */
static bool add_varied(Assignments *assignment, Varied varied) {
    for (int k = 0; k < varied.count; k++)
        if (!check_once(&varied, k)) return false;
    if (varied.count < 2) return true;
    if (assignment->varied_count == ASSIGN_VARIED_MOST) {
        report(WEFT_USAGE, "%s: has several values, and so have %s and %s: two options may, as rows and columns",
               varied.option, assignment->varied[0].option, assignment->varied[1].option);
        return false;
    }
    if (varied.count > ASSIGN_VARIANTS_MOST / assignment->count) {
        report(WEFT_USAGE, "%s: makes more than %d pictures", varied.option, ASSIGN_VARIANTS_MOST);
        return false;
    }
    assignment->varied[assignment->varied_count++] = varied;
    assignment->count *= varied.count;
    return true;
}

static bool check_axis(int axis, Assignments *assignment) {
    const char *text = option_text(assignment->options, axes[axis].option);
    if (!text) return true;
    Varied varied = {.option = axes[axis].option, .values = text, .separator = ',', .count = item_count(text, ',')};
    for (int k = 0; k < varied.count; k++)
        if (!check_item(axis, text, k)) return false;
    snprintf(varied.name, sizeof varied.name, "%s", axes[axis].choice);
    return add_varied(assignment, varied);
}

enum { MATERIAL_SIZE = 256, TARGET_SIZE = 512 };

/* Returns the text after the '=' in "MAT=NAME", or all of it. Names of materials and files may contain '=' too: the
 * longest tail that is an existing file is taken, else the text after the last '='. */
static const char *operand_of(const char *text, bool is_file) {
    const char *last = strrchr(text, '=');
    for (const char *file = text; is_file && file; file = strchr(file, '=') ? strchr(file, '=') + 1 : NULL)
        if (access(file, F_OK) == 0) return file;
    return last ? last + 1 : text;
}

static bool check_operands(const Options *options, const char *option, bool is_file) {
    int cursor = 0;
    for (const char *text; (text = option_next(options, option, &cursor));) {
        const char *operand = operand_of(text, is_file);
        if (operand - text > MATERIAL_SIZE) {
            report(WEFT_USAGE, "%s: \"%.80s\" is too long for the name of a material", option, text);
            return false;
        }
        if (!is_file && kind_named(kind_of("preset"), operand) < 0) return false;
    }
    return true;
}

/* Returns the '=' before the value of a setting: the last one, but of a weave, whose value may contain others, the first
 * one behind "MATERIAL.weave"; is_weave tells which. NULL if there is none. */
static const char *setting_equals(const char *text, bool *is_weave) {
    static const char mark[] = ".weave";
    *is_weave = false;
    for (const char *at = text; (at = strstr(at, mark)); at++) {
        const char *key = at + sizeof mark - 1, *equals = strchr(key, '=');
        if ((*key != '.' && *key != '=') || !equals || memchr(key, ' ', (size_t)(equals - key))) continue;
        *is_weave = true;
        return equals;
    }
    return strrchr(text, '=');
}

/* Copies the name in "MATERIAL.NAME=VALUE". Returns false after one line if text is not of that form or too long. A
 * material's name may contain '=' and '.', so the last of each divides. */
static bool setting_name(const char *text, char name[ASSIGN_LABEL]) {
    bool is_weave;
    const char *equals = setting_equals(text, &is_weave), *point = equals;
    while (point && point > text && *point != '.') point--;
    if (!equals || *point != '.') {
        report(WEFT_USAGE, "--set: \"%.80s\" is not MATERIAL.INPUT=VALUE", text);
        return false;
    }
    if (equals - text >= TARGET_SIZE) {
        report(WEFT_USAGE, "--set: \"%.80s\" is too long for the name of a material", text);
        return false;
    }
    snprintf(name, ASSIGN_LABEL, "%.*s", (int)(equals - point - 1), point + 1);
    return true;
}

static bool refuse_name(const char *text, const char *name) {
    char hint[96];
    const Kind *input = kind_of("input"), *choice = kind_of("choice");
    Nearest nearest = {.typed = name};
    if (strncmp(name, "layer=", 6) == 0) {
        report(WEFT_USAGE, "--set: \"%.80s\": the by of a layer rule is a setting of its own, layer_by", text);
        return false;
    }
    for (int k = 0; input->name(k); k++) nearest_offer(&nearest, input->name(k));
    for (int k = 0; choice->name(k); k++) nearest_offer(&nearest, choice->name(k));
    report(WEFT_USAGE, "--set: \"%s\" %s%s", name, weft_message_text(WEFT_MESSAGE_PARAM_NAME),
           nearest.name ? nearest_hint(&nearest, hint, sizeof hint) : "; `weft models` lists inputs and choices");
    return false;
}

/* Returns the character between the values of a setting: ';' is always allowed, and ',' unless the input is a colour. */
static char separator_of(int input, const char *values) {
    WeftInputInfo info = {.kind = WEFT_INPUT_SCALAR};
    if (input >= 0) weft_material_input_info(input, &info);
    return strchr(values, ';') || info.kind == WEFT_INPUT_COLOR ? ';' : ',';
}

/* Returns true for text in the form of a setting of an input or a choice; the library judges its values.
 */
static bool check_set(const char *text, Assignments *assignment) {
    char name[ASSIGN_LABEL], item[ASSIGN_LABEL];
    if (!setting_name(text, name)) return false;
    bool is_weave;
    const char *equals = setting_equals(text, &is_weave);
    if (is_weave) return true; /* one value, which may have commas */
    int input = kind_find(kind_of("input"), name);
    if (input < 0 && kind_find(kind_of("choice"), name) < 0) return refuse_name(text, name);
    Varied varied = {.option = "--set", .values = equals + 1, .separator = separator_of(input, equals + 1)};
    varied.count = item_count(varied.values, varied.separator);
    snprintf(varied.name, sizeof varied.name, "%.*s", (int)(equals - text), text);
    for (int k = 0; varied.count > 1 && k < varied.count; k++) {
        if (item_at(varied.values, varied.separator, k, item) && item[0]) continue;
        report(WEFT_USAGE, "--set: \"%.80s\": value %d of %d is empty or too long", text, k + 1, varied.count);
        return false;
    }
    return add_varied(assignment, varied);
}

static bool check_sets(const Options *options, Assignments *assignment) {
    int cursor = 0;
    for (const char *text; (text = option_next(options, "--set", &cursor));)
        if (!check_set(text, assignment)) return false;
    return true;
}

static bool check_textures(const Options *options) {
    int cursor = 0;
    for (const char *text; (text = option_next(options, "--texture", &cursor));) {
        const char *file = operand_of(text, true);
        if (file > text && file - text <= TARGET_SIZE && memchr(text, '.', (size_t)(file - text))) continue;
        report(WEFT_USAGE, "--texture: \"%.80s\" is not MATERIAL.INPUT=FILE", text);
        return false;
    }
    return true;
}

bool assign_read(const Options *options, Assignments *assignment) {
    static const char *const targets[] = {"metallic", "specular", NULL};
    int target;
    *assignment = (Assignments){.options = options, .count = 1};
    for (int k = 0; k < AXES; k++)
        if (!check_axis(k, assignment)) return false;
    if (option_given(options, "--workflow") && option_given(options, "--profile")) {
        report(WEFT_USAGE, "--workflow: a profile stands in its place; give --workflow or --profile");
        return false;
    }
    return check_operands(options, "--preset", false) && check_operands(options, "--material", true) &&
           check_operands(options, "--materials", true) && check_operands(options, "--weave", true) &&
           check_textures(options) && check_sets(options, assignment) &&
           (!option_given(options, "--convert") || option_choice(options, "--convert", targets, &target));
}

/* Returns which of its values option v has in picture k. */
static int value_index(const Assignments *assignment, int v, int k) {
    for (int later = assignment->varied_count - 1; later > v; later--) k /= assignment->varied[later].count;
    return k % assignment->varied[v].count;
}

void assign_value(const Assignments *assignment, int v, int k, char value[ASSIGN_LABEL]) {
    const Varied *varied = &assignment->varied[v];
    item_at(varied->values, varied->separator, value_index(assignment, v, k), value);
}

void assign_label(const Assignments *assignment, int k, char label[ASSIGN_LABEL]) {
    char text[ASSIGN_VARIED_MOST * 3 * ASSIGN_LABEL] = "";
    for (int v = 0; v < assignment->varied_count; v++) {
        char value[ASSIGN_LABEL];
        size_t used = strlen(text);
        const char *input = strrchr(assignment->varied[v].name, '.');
        assign_value(assignment, v, k, value);
        snprintf(text + used, sizeof text - used, "%s%s%s%s", used ? ", " : "", input ? input + 1 : "",
                 input ? " " : "", value);
    }
    snprintf(label, ASSIGN_LABEL, "%.*s", ASSIGN_LABEL - 1, text);
}

/* Copies the value that the list at `values` has in picture k. Returns false if option `values` does not vary. */
static bool value_of(const Assignments *assignment, const char *values, int k, char value[ASSIGN_LABEL]) {
    for (int v = 0; v < assignment->varied_count; v++) {
        if (assignment->varied[v].values != values) continue;
        assign_value(assignment, v, k, value);
        return true;
    }
    return false;
}

/* Sets a choice of all materials. */
static WeftResult choose(WeftScene *scene, const char *choice, const char *id, const WeftLog *log, WeftError *error) {
    char target[64];
    snprintf(target, sizeof target, "*.%s", choice);
    return weft_scene_set(scene, target, id, log, error);
}

/* Resets what `choice` overrides. A profile sets the other choices to auto, since it is exact; a workflow sets the
 * profile to none. */
static WeftResult reset_overridden(WeftScene *scene, const char *choice, const char *id, WeftError *error) {
    if (strcmp(choice, "workflow") == 0) return choose(scene, "profile", "none", NULL, error);
    if (strcmp(choice, "profile") != 0 || strcmp(id, "none") == 0) return WEFT_OK;
    WeftResult result = WEFT_OK;
    for (int k = 0; weft_material_choice_name(k) && result == WEFT_OK; k++) {
        const char *name = weft_material_choice_name(k);
        if (strcmp(name, "profile") != 0 && strcmp(name, "workflow") != 0 && strcmp(name, "convert") != 0)
            result = choose(scene, name, "auto", NULL, error);
    }
    return result;
}

static WeftResult apply_axis(const Assignments *assignment, int axis, int k, WeftScene *scene, const WeftLog *log,
                             WeftError *error) {
    char item[ASSIGN_LABEL];
    const char *text = option_text(assignment->options, axes[axis].option), *choice = axes[axis].choice;
    if (!text) return WEFT_OK;
    if (!value_of(assignment, text, k, item)) item_at(text, ',', 0, item);
    const char *by = split_by(item);
    WeftResult result = reset_overridden(scene, choice, item, error);
    if (result == WEFT_OK) result = choose(scene, choice, item, log, error);
    if (result == WEFT_OK && by) result = choose(scene, "layer_by", by, log, error);
    return result;
}

static WeftResult put_preset(WeftScene *scene, const char *material, const char *name, const WeftLog *log,
                             WeftError *error) {
    char preset[64];
    snprintf(preset, sizeof preset, "preset:%s", name);
    return weft_scene_assign_material(scene, material, preset, log, error);
}

static WeftResult put_folder(WeftScene *scene, const char *material, const char *folder, const WeftLog *log,
                             WeftError *error) {
    return weft_scene_bind_maps(scene, material, folder, NULL, log, error);
}

static WeftResult put_weave(WeftScene *scene, const char *material, const char *draft, const WeftLog *log,
                            WeftError *error) {
    return weft_scene_weave(scene, material, "draft", draft, log, error);
}

/* Options of the form [MAT=]NAME, or MAT.INPUT=NAME, in the order in which they are applied. */
static const struct {
    const char *option;
    bool is_file;
    WeftResult (*put)(WeftScene *scene, const char *on, const char *name, const WeftLog *log, WeftError *error);
} operand_options[] = {{"--preset", false, put_preset},
                       {"--material", true, weft_scene_assign_material},
                       {"--materials", true, put_folder},
                       {"--weave", true, put_weave},
                       {"--texture", true, weft_scene_set_texture}};
enum { OPERAND_OPTIONS = sizeof operand_options / sizeof *operand_options };

static WeftResult apply_operands(const Assignments *assignment, WeftScene *scene, const WeftLog *log,
                                 WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = 0; k < OPERAND_OPTIONS; k++) {
        int cursor = 0;
        const char *option = operand_options[k].option;
        for (const char *text; result == WEFT_OK && (text = option_next(assignment->options, option, &cursor));) {
            char on[TARGET_SIZE];
            const char *name = operand_of(text, operand_options[k].is_file);
            bool named = name > text;
            if (named) snprintf(on, sizeof on, "%.*s", (int)(name - 1 - text), text);
            result = operand_options[k].put(scene, named ? on : NULL, name, log, error);
        }
    }
    return result;
}

/* Applies every --set, with the values of picture k. */
static WeftResult apply_sets(const Assignments *assignment, int k, WeftScene *scene, const WeftLog *log,
                             WeftError *error) {
    WeftResult result = WEFT_OK;
    int cursor = 0;
    for (const char *text; result == WEFT_OK && (text = option_next(assignment->options, "--set", &cursor));) {
        char target[TARGET_SIZE], value[ASSIGN_LABEL];
        bool is_weave;
        const char *equals = setting_equals(text, &is_weave);
        snprintf(target, sizeof target, "%.*s", (int)(equals - text), text);
        bool listed = value_of(assignment, equals + 1, k, value);
        result = weft_scene_set(scene, target, listed ? value : equals + 1, log, error);
    }
    return result;
}

/* Reports what each conversion loses, how many materials stay unchanged, and whether there was nothing to convert. */
static WeftResult convert(const char *workflow, WeftScene *scene, const WeftLog *log, WeftError *error) {
    int count = weft_scene_info(scene).material_count, converted = 0, others = 0;
    char line[256], name[96];
    float *losses = calloc((size_t)count + 1, sizeof *losses);
    WeftResult result = weft_scene_convert(scene, workflow, losses, error);
    for (int k = 0; losses && k < count && result == WEFT_OK; k++) {
        others += losses[k] < 0.0f && losses[k] > -2.0f;
        if (losses[k] < 0.0f) continue;
        converted++;
        snprintf(name, sizeof name, "%.79s", weft_scene_material_name(scene, k));
        if (!name[0]) snprintf(name, sizeof name, "%d", k);
        snprintf(line, sizeof line, "material %s: conversion to %s loses %.3f", name, workflow, (double)losses[k]);
        log->fn(log->user, WEFT_MESSAGE_NONE, line);
    }
    if (losses && (others || !converted)) {
        snprintf(name, sizeof name, "%d of %d materials are of another workflow or a profile and stay", others, count);
        snprintf(line, sizeof line, "--convert %s: %s%s%s", workflow, converted ? "" : "there is nothing to convert",
                 others && !converted ? ": " : "", others ? name : "");
        if (result == WEFT_OK) log->fn(log->user, WEFT_MESSAGE_NONE, line);
    }
    free(losses);
    return result;
}

/* The plausibility warnings so far. Several settings can lead to the same finding, and each of them warns. */
typedef struct Heard {
    const WeftLog *log;
    char lines[32][256];
    int count;
} Heard;

/* Returns true if two warnings differ only in the input that follows the material's name. */
static bool is_echo(const char *line, const char *other) {
    const char *text = weft_message_text(WEFT_MESSAGE_PLAUSIBLE), *words = strstr(line, text),
               *others = strstr(other, text);
    if (!words || !others || strcmp(words, others) != 0) return false;
    while (words > line && words[-1] != '.') words--;
    while (others > other && others[-1] != '.') others--;
    return words - line == others - other && strncmp(line, other, (size_t)(words - line)) == 0;
}

static void hear_once(void *user, WeftMessage message, const char *text) {
    enum { LINES = sizeof((Heard *)NULL)->lines / sizeof *((Heard *)NULL)->lines };
    Heard *heard = user;
    char line[sizeof heard->lines[0]];
    snprintf(line, sizeof line, "%s", text);
    for (int k = 0; k < heard->count; k++)
        if (is_echo(line, heard->lines[k])) return;
    if (message == WEFT_MESSAGE_PLAUSIBLE && heard->count < LINES)
        memcpy(heard->lines[heard->count++], line, sizeof line);
    if (heard->log && heard->log->fn) heard->log->fn(heard->log->user, message, text);
}

WeftResult assign_apply(const Assignments *assignment, int k, WeftScene *scene, const WeftLog *log, WeftError *error) {
    const char *variant = option_text(assignment->options, "--variant"),
               *workflow = option_text(assignment->options, "--convert");
    WeftResult result = WEFT_OK;
    if (variant) result = weft_scene_set_variant(scene, variant, error);
    if (result == WEFT_OK) result = apply_operands(assignment, scene, log, error);
    /* A setting warns about the material in its state at that moment. So all settings are applied twice, and only
     * the second round is logged, in which every other setting is in place. */
    Heard heard = {.log = log};
    const WeftLog unique = {hear_once, &heard};
    for (int round = 0; round < 2; round++) {
        const WeftLog *to = round ? &unique : NULL;
        for (int axis = 0; axis < AXES && result == WEFT_OK; axis++)
            result = apply_axis(assignment, axis, k, scene, to, error);
        if (result == WEFT_OK) result = apply_sets(assignment, k, scene, to, error);
    }
    if (result == WEFT_OK && workflow) result = convert(workflow, scene, log, error);
    for (int m = 0; m < weft_scene_info(scene).material_count && result == WEFT_OK; m++) {
        WeftMaterial material;
        char name[96];
        snprintf(name, sizeof name, "material %.79s", weft_scene_material_name(scene, m));
        result = weft_scene_material(scene, m, &material, error);
        if (result == WEFT_OK) weft_material_fitted(&material, name, log);
    }
    return result;
}
