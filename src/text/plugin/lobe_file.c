/* lobe_file.c - a lobe from a file of the user's */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/mark.h"
#include "base/memory.h"
#include "shading/catalogue/outside.h"
#include "text/assemble/catalogue.h"
#include "text/assemble/text.h"
#include "text/plugin/plugin_compile.h"

/* A loaded lobe with its strings, in one allocation. */
typedef struct LobeFile {
    OutsideLobe lobe;
    WeftParamInfo params[LOBE_PARAMS_MAX];
    char id[48], prefix[48], record[48], macros[48], file[80];
    char text[];
} LobeFile;

enum { NAME_MOST = 40, TEXT_MOST = 1 << 20 };

static WeftResult refuse(WeftError *error, const char *path, const char *why) {
    return fail(error, WEFT_MESSAGE_LOBE_FILE, path, "%s", why);
}

/* Sets the name before ".h", from which the names of id, functions and macros are made. Returns false if it does not
 * serve. */
static bool name_of(const char *path, char name[NAME_MOST + 1]) {
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    size_t size = strlen(base);
    if (size < 3 || size - 2 > NAME_MOST || strcmp(base + size - 2, ".h") != 0) return false;
    memcpy(name, base, size - 2);
    name[size - 2] = 0;
    for (const char *c = name; *c; c++)
        if (!(*c >= 'a' && *c <= 'z') && (c == name || !((*c >= '0' && *c <= '9') || *c == '_'))) return false;
    return !strstr(name, "__") && name[strlen(name) - 1] != '_'; /* "a_" and "a__b" would have A and AB */
}

/* Sets the names of a lobe: those of "two_words" are two-words, TwoWords and TWO_WORDS, as cmake/lobes.cmake makes
 * them. */
static void set_names(LobeFile *own, const char *name) {
    char *record = own->record;
    bool first = true;
    for (int k = 0; name[k]; k++) {
        bool gap = name[k] == '_';
        own->prefix[k] = name[k];
        own->id[k] = gap ? '-' : name[k];
        own->macros[k] = (char)toupper((unsigned char)name[k]);
        if (!gap) *record++ = first ? (char)toupper((unsigned char)name[k]) : name[k];
        first = gap;
    }
    snprintf(own->file, sizeof own->file, "shading/lobes/%s.h", own->prefix);
    own->lobe.file = own->file;
    own->lobe.text = own->text;
    own->lobe.info.id = own->id;
    own->lobe.info.params = own->params;
    own->lobe.names = (LobeNames){own->prefix, own->record, own->macros, false};
}

static const char *const records[] = {"", "Prepared", "View"};
enum { RECORDS = sizeof records / sizeof *records };

/* Returns true if a record of the lobe has the name of a record of another lobe. */
static bool shares_record(const char *record, const char *other) {
    char a[64], b[64];
    for (int k = 0; k < RECORDS * RECORDS; k++) {
        snprintf(a, sizeof a, "%s%s", record, records[k % RECORDS]);
        snprintf(b, sizeof b, "%s%s", other, records[k / RECORDS]);
        if (strcmp(a, b) == 0) return true;
    }
    return false;
}

/* Returns true if the text defines a record, a type or a macro that the lobe file defines too. */
static bool is_defined(const LobeFile *own, const char *text) {
    static const char *const around[][2] = {
        {"STRUCT(", ")"}, {"STRUCT(", "Prepared)"}, {"STRUCT(", "View)"}, {"} ", ";"}, {" *", ";"}, {"#define ", " "}};
    char words[80];
    for (size_t k = 0; k < sizeof around / sizeof *around; k++) {
        snprintf(words, sizeof words, "%s%s%s", around[k][0], own->record, around[k][1]);
        if (strstr(text, words)) return true;
    }
    snprintf(words, sizeof words, "#define %s_PARAMS(", own->macros);
    return strstr(text, words) != NULL;
}

/* Fails if a name of the lobe is one of another lobe or of the dialect. */
static WeftResult check_names(const LobeFile *own, const char *path, WeftError *error) {
    int id = weft_lobe_find(own->id);
    if (id >= 0 && id < LOBE_COUNT)
        return fail(error, WEFT_MESSAGE_LOBE_FILE, path, "the catalogue has a lobe %s: give the file another name",
                    own->id);
    for (int k = 0, count = weft_lobe_count(); k < count; k++) {
        const OutsideLobe *outside = outside_lobe(k);
        if (k != id &&
            (shares_record(own->record, lobe_names(k)->record) || (outside && is_defined(own, outside->text))))
            return fail(error, WEFT_MESSAGE_LOBE_FILE, path,
                        "its %s would be that of the lobe %s: give the file another name", own->record,
                        weft_lobe_info(k)->id);
    }
    for (const CatalogueFile *file = catalogue_files; file->name; file++)
        if (is_defined(own, file->bytes))
            return fail(error, WEFT_MESSAGE_LOBE_FILE, path, "its %s would be that of %s: give the file another name",
                        own->record, file->name);
    return WEFT_OK;
}

/* Fails if the file lacks a part of a lobe, with its name. */
static WeftResult check_parts(const LobeFile *own, const char *path, WeftError *error) {
    const char *const parts[][2] = {
        {own->macros, "_PARAMS("}, {own->macros, "_TRAITS"}, {own->prefix, "_value("}, {own->prefix, "_sample("}};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        char part[80];
        snprintf(part, sizeof part, "%s%s", parts[k][0], parts[k][1]);
        if (!strstr(own->text, part))
            return fail(error, WEFT_MESSAGE_LOBE_FILE, path, "it has no %s%s", part, strchr(part, '(') ? "...)" : "");
    }
    return strstr(own->text, "shading/lobe/lobe_tables.h")
               ? refuse(error, path, "tables are for the lobes of the catalogue")
               : WEFT_OK;
}

/* Fails if the file is not in the shading dialect, from which a shader can be made. */
static WeftResult check_dialect(const LobeFile *own, const char *path, WeftError *error) {
    Text text;
    Buffer bytes = {0};
    buffer_put_text(&bytes, own->text);
    text_begin(&text, &(TextDesc){.language = TEXT_GLSL_330});
    text_source(&text, path, &bytes);
    WeftResult result = text_end(&text, error);
    text_free(&text);
    buffer_free(&bytes);
    return result;
}

/* Returns true if a help text can be written into the comments of exported text. */
static bool fits_comment(const char *help) {
    for (const char *c = help; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f) return false;
    return !strstr(help, "*/");
}

/* Returns true if the range of a parameter is within its choices and its default is an integer. */
static bool is_choice(const PluginParam *p, const char *const *choices) {
    int count = 0;
    while (choices[count]) count++;
    return p->hard_low >= 0.0f && p->hard_high < (float)count && !(floorf(p->def) < p->def);
}

/* Returns the reason why a parameter is refused, or NULL. */
static const char *fault_of(const PluginParam *p, const char *const *choices) {
    const float numbers[] = {p->def, p->low, p->high, p->hard_low, p->hard_high};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        if (!isfinite(numbers[k])) return "has a number that is not finite";
    if (!choices && strcmp(p->type, "float") != 0) return "is neither a float nor a term";
    if (choices && !is_choice(p, choices)) return "has a range or a default that its terms do not have";
    if (!p->help || !p->help[0]) return "has no help text";
    return fits_comment(p->help) ? NULL : "has a help text with a control character or the end of a comment";
}

static WeftResult take_params(LobeFile *own, const Plugin *plugin, const char *path, WeftError *error) {
    if (plugin->param_count > LOBE_PARAMS_MAX)
        return fail(error, WEFT_MESSAGE_LOBE_FILE, path, "it has %d parameters, and %d is the most",
                    plugin->param_count, LOBE_PARAMS_MAX);
    for (int k = 0; k < plugin->param_count; k++) {
        const PluginParam *p = &plugin->params[k];
        const char *const *choices = lobe_choices(p->type);
        const char *fault = fault_of(p, choices);
        if (fault) return fail(error, WEFT_MESSAGE_LOBE_FILE, path, "parameter %s %s", p->name, fault);
        if (!(p->hard_low <= p->low && p->low <= p->def && p->def <= p->high && p->high <= p->hard_high))
            return fail(error, WEFT_MESSAGE_LOBE_FILE, path, "the ranges of %s do not nest", p->name);
        own->params[k] = (WeftParamInfo){p->name, p->help, p->def, p->low, p->high, p->hard_low, p->hard_high, choices};
    }
    own->lobe.info.param_count = plugin->param_count;
    return WEFT_OK;
}

/* Fails if a record of `size` bytes does not fit into `most` floats. */
static WeftResult check_size(const char *record, const char *kind, size_t size, size_t most, const char *path,
                             WeftError *error) {
    if (size <= most * sizeof(float)) return WEFT_OK;
    return fail(error, WEFT_MESSAGE_LOBE_FILE, path, "%s%s has %zu bytes, and %zu is the most", record, kind, size,
                most * sizeof(float));
}

static WeftResult take_plugin(LobeFile *own, const Plugin *plugin, const char *path, WeftError *error) {
    const char *record = own->record;
    if (plugin->traits & (TRAIT_TABLE | TRAIT_REFERENCE))
        return refuse(error, path, "tables and random walks are for the lobes of the catalogue");
    WeftResult result = check_size(record, "Prepared", plugin->prepared_size, OUTSIDE_PREPARED_FLOATS, path, error);
    if (result == WEFT_OK) result = check_size(record, "View", plugin->view_size, OUTSIDE_VIEW_FLOATS, path, error);
    if (result == WEFT_OK) result = take_params(own, plugin, path, error);
    own->lobe.info.traits = plugin->traits;
    own->lobe.plugin = plugin;
    own->lobe.names.strips = plugin->strip != NULL;
    return result;
}

static WeftResult take(LobeFile *own, const char *path, int *lobe, const WeftLog *log, WeftError *error) {
    const Plugin *plugin;
    WeftResult result = check_names(own, path, error);
    if (result == WEFT_OK) result = check_parts(own, path, error);
    if (result == WEFT_OK) result = check_dialect(own, path, error);
    if (result == WEFT_OK) result = plugin_make(&own->lobe.names, path, own->text, &plugin, log, error);
    if (result == WEFT_OK) result = take_plugin(own, plugin, path, error);
    if (result == WEFT_OK && !outside_take(&own->lobe, lobe))
        return fail(error, WEFT_MESSAGE_LOBE_FILE, path, "there are %d already, and no more fit", OUTSIDE_MOST);
    return result;
}

WeftResult weft_lobe_load(const char *path, int *lobe, const WeftLog *log, WeftError *error) {
    char name[NAME_MOST + 1];
    FileBytes file;
    int id;
    WeftResult result = file_read(path, TEXT_MOST, &file, error);
    if (result != WEFT_OK) return result;
    if (!name_of(path, name)) {
        free(file.data);
        return refuse(error, path, "its name is to be lower-case letters, digits and single _ between, and .h");
    }
    if (memchr(file.data, 0, file.size)) {
        free(file.data);
        return refuse(error, path, "it has a zero byte");
    }
    LobeFile *own = alloc_array(1, sizeof *own + file.size + 1);
    size_t mark = mark_size(file.data, file.size);
    if (own) memcpy(own->text, file.data + mark, file.size - mark);
    free(file.data);
    if (!own) return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    set_names(own, name);
    result = take(own, path, lobe ? lobe : &id, log, error);
    if (result != WEFT_OK) free(own);
    return result;
}
