#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "export/draft.h"

#include "base/fail.h"
#include "text/passes/native.h"
#include "text/passes/returned.h"
#include "text/passes/unused.h"
#include "text/passes/wgsl.h"

void draft_begin(Draft *draft, const WeftExportDesc *desc, DraftTables *tables) {
    static const SpellLanguage languages[WEFT_EXPORT_TARGETS] = {
        [WEFT_EXPORT_GLSL] = SPELL_GLSL,  [WEFT_EXPORT_ESSL] = SPELL_GLSL,      [WEFT_EXPORT_HLSL] = SPELL_HLSL,
        [WEFT_EXPORT_C] = SPELL_C,        [WEFT_EXPORT_SHADERTOY] = SPELL_GLSL, [WEFT_EXPORT_WGSL] = SPELL_WGSL,
        [WEFT_EXPORT_GODOT] = SPELL_GLSL, [WEFT_EXPORT_UNITY] = SPELL_HLSL,     [WEFT_EXPORT_UNREAL] = SPELL_HLSL,
    };
    *draft = (Draft){.desc = desc, .speller.language = languages[desc->target], .whole = {"Dir", "Rgb"}};
    const char *usual = desc->target == WEFT_EXPORT_C ? "weftx_" : "weft_"; /* weft.h, beside a text in C, has weft_ */
    snprintf(draft->speller.prefix, SPELL_PREFIX, "%s", desc->prefix ? desc->prefix : usual);
    draft->tables = tables;
    text_begin(&draft->text, &(TextDesc){.language = TEXT_PLAIN,
                                         .before = tables->all,
                                         .before_count = tables->count,
                                         .comments = true,
                                         .table_side = desc->target == WEFT_EXPORT_SHADERTOY ? 32 : 0});
    text_include(&draft->text, "shading/dialect/lang.h");
    text_define(&draft->text, "table_texel", "table_fetch");
    text_line(&draft->text, "\nfloat table_fetch(int t, int stride, int row, int column) {\n"
                            "    return float(t + stride + row + column); /* names what the real one reads */\n}");
}

void draft_free(Draft *draft) {
    for (int k = 0; k < draft->albedo_count; k++) free(draft->albedos[k]);
    free(draft->colors);
    items_free(&draft->items);
    buffer_free(&draft->folded);
    text_free(&draft->text);
}

void draft_root(Draft *draft, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    if (draft->root_count < DRAFT_ROOTS) vsnprintf(draft->roots[draft->root_count++], SPELL_NAME, format, arguments);
    va_end(arguments);
}

void draft_fact(Draft *draft, const char *path, int value) {
    if (draft->fact_count < DRAFT_FACTS) draft->facts[draft->fact_count++] = (FoldFact){path, value};
}

AlbedoTable *draft_albedo(Draft *draft) {
    if (draft->albedo_count == DRAFT_ALBEDOS) return NULL;
    AlbedoTable *table = calloc(1, sizeof *table);
    if (table) draft->albedos[draft->albedo_count++] = table;
    return table;
}

void draft_identifier(const char *name, char id[DRAFT_ID]) {
    int size = 0;
    for (; *name && size < DRAFT_ID - 1; name++) {
        bool letter = is_name(*name) && *name != '_';
        if (!size && is_digit(*name)) id[size++] = 'm';
        if (letter)
            id[size++] = (char)(*name >= 'A' && *name <= 'Z' ? *name - 'A' + 'a' : *name);
        else if (size && id[size - 1] != '_')
            id[size++] = '_';
    }
    while (size && id[size - 1] == '_') size--;
    if (!size) id[size++] = 'm';
    id[size] = 0;
}

/* Adds the tables of the text to those of all drafts, under unique names. */
static void take_tables(Draft *draft) {
    DraftTables *to = draft->tables;
    for (int k = 0; k < draft->text.table_count; k++, to->count++) {
        const char *name = draft->text.tables[k].name;
        bool taken = false;
        for (int j = 0; j < to->count; j++) taken |= strcmp(to->all[j].name, name) == 0;
        snprintf(to->names[to->count], WEFT_EXPORT_NAME, "%s%s%s", taken ? draft->id[0] : "", taken ? "_" : "", name);
        to->all[to->count] = draft->text.tables[k];
        to->all[to->count].name = to->names[to->count];
    }
}

/* Returns true for the members of records that name a table. */
static bool names_table(Token token) {
    return token_is(token, "texels") || token_is(token, "runs") || token_is(token, "albedos");
}

/* Marks the tables that kept items read, by statements such as "t.texels = 3;". */
static void find_used(Draft *draft) {
    for (int k = 0; k < draft->items.count; k++) {
        const Item *item = &draft->items.all[k];
        const char *c = item->code;
        for (Token token; item->kept && (token = token_solid(&c, item->end)).kind != TOKEN_NONE;) {
            if (!names_table(token) || !token_is(token_solid(&c, item->end), "=")) continue;
            token = token_solid(&c, item->end);
            long layer = token.kind == TOKEN_NUMBER ? strtol(token.at, NULL, 10) : -1;
            if (layer >= 0 && layer < draft->tables->count) draft->tables->used[layer] = true;
        }
    }
}

/* Replaces the text by `next`, cuts it into items and keeps those that the roots need. */
static WeftResult take_text(Draft *draft, Buffer *next, WeftError *error) {
    items_free(&draft->items);
    buffer_free(&draft->folded);
    draft->folded = *next;
    *next = (Buffer){0};
    if (draft->folded.failed || !draft->folded.bytes) return fail(error, WEFT_MESSAGE_MEMORY, "text", NULL);
    items_cut(draft->folded.bytes, &draft->items);
    if (draft->items.short_of_memory) return fail(error, WEFT_MESSAGE_MEMORY, "text", NULL);
    for (int k = 0; k < draft->root_count; k++)
        if (!items_keep(&draft->items, draft->roots[k]))
            return fail(error, WEFT_MESSAGE_TEXT_NAME, draft->roots[k], NULL);
    return WEFT_OK;
}

/* Fails if a kept function uses a part of the dialect that WGSL lacks. */
static WeftResult check_lacks(const Draft *draft, WeftError *error) {
    for (int k = 0; k < draft->items.count && draft->speller.language == SPELL_WGSL; k++) {
        const Item *item = &draft->items.all[k];
        char name[SPELL_NAME];
        snprintf(name, sizeof name, "%.*s", (int)item->name.size, item->name.at);
        const char *lack = item->kept && item->kind == ITEM_FUNCTION ? wgsl_lacks(item) : NULL;
        if (lack) return fail(error, WEFT_MESSAGE_TEXT_DIALECT, name, "%s", lack);
    }
    return WEFT_OK;
}

static WeftResult cut(Draft *draft, WeftError *error) {
    Buffer next = {0};
    fold_text(draft->text.bytes, draft->facts, draft->fact_count, &next);
    WeftResult result = take_text(draft, &next, error);
    if (result == WEFT_OK && draft->speller.language != SPELL_C) { /* C has pointers for results */
        returned_put(&draft->items, draft->folded.bytes, draft->speller.language == SPELL_WGSL, &next);
        result = take_text(draft, &next, error);
        if (result == WEFT_OK) result = check_lacks(draft, error);
    }
    while (result == WEFT_OK && unused_cut(&draft->items, draft->folded.bytes, draft->whole, &next))
        result = take_text(draft, &next, error);
    if (result != WEFT_OK || draft->speller.language == SPELL_C) return result;
    native_put(draft->folded.bytes, &next);
    return take_text(draft, &next, error);
}

WeftResult draft_cut(Draft *draft, WeftError *error) {
    WeftResult result = text_end(&draft->text, error);
    if (result == WEFT_OK) result = cut(draft, error);
    if (result != WEFT_OK) return result;
    take_tables(draft);
    find_used(draft);
    snprintf(draft->speller.own, SPELL_PREFIX, "%.24s%.*s_", draft->speller.prefix, DRAFT_ID, draft->id[0]);
    return WEFT_OK;
}

void put_line(Buffer *out, const char *format, ...) {
    char line[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    buffer_put_text(out, line);
    buffer_put(out, "\n", 1);
}
