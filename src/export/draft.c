#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "export/draft.h"

#include "base/fail.h"

void draft_begin(Draft *draft, const WeftExportDesc *desc) {
    static const SpellLanguage languages[WEFT_EXPORT_TARGETS] = {
        [WEFT_EXPORT_GLSL] = SPELL_GLSL,      [WEFT_EXPORT_ESSL] = SPELL_GLSL,
        [WEFT_EXPORT_HLSL] = SPELL_HLSL,      [WEFT_EXPORT_C] = SPELL_C,
        [WEFT_EXPORT_SHADERTOY] = SPELL_GLSL,
    };
    *draft = (Draft){.desc = desc, .speller.language = languages[desc->target]};
    snprintf(draft->speller.prefix, SPELL_PREFIX, "%s", desc->prefix ? desc->prefix : "weft_");
    text_begin(&draft->text, &(TextDesc){.language = TEXT_PLAIN,
                                         .comments = true,
                                         .table_side = desc->target == WEFT_EXPORT_SHADERTOY ? 32 : 0});
    text_include(&draft->text, "shading/lang.h");
    text_define(&draft->text, "table_texel", "table_fetch");
    text_line(&draft->text, "\nfloat table_fetch(int t, int stride, int row, int column) { return 0.0; }");
}

void draft_free(Draft *draft) {
    for (int k = 0; k < draft->albedo_count; k++) free(draft->albedos[k]);
    items_free(&draft->items);
    buffer_free(&draft->folded);
    text_free(&draft->text);
}

void draft_root(Draft *draft, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    if (draft->root_count < DRAFT_ROOTS)
        vsnprintf(draft->roots[draft->root_count++], SPELL_NAME, format, arguments);
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
    if (is_digit(*name)) id[size++] = 'm';
    for (; *name && size < DRAFT_ID - 1; name++) {
        bool letter = is_name(*name) && *name != '_';
        if (letter)
            id[size++] = (char)(*name >= 'A' && *name <= 'Z' ? *name - 'A' + 'a' : *name);
        else if (size && id[size - 1] != '_')
            id[size++] = '_';
    }
    while (size && id[size - 1] == '_') size--;
    if (!size) id[size++] = 'm';
    id[size] = 0;
}

/* "t.texels = 3;" of what is kept: which tables are read. */
static void find_used(Draft *draft) {
    for (int k = 0; k < draft->items.count; k++) {
        const Item *item = &draft->items.all[k];
        const char *c = item->code;
        for (Token token; item->kept && (token = token_solid(&c, item->end)).kind != TOKEN_NONE;) {
            if (!token_is(token, "texels") || !token_is(token_solid(&c, item->end), "=")) continue;
            token = token_solid(&c, item->end);
            long layer = token.kind == TOKEN_NUMBER ? strtol(token.at, NULL, 10) : -1;
            if (layer >= 0 && layer < draft->text.table_count) draft->used[layer] = true;
        }
    }
}

WeftResult draft_cut(Draft *draft, WeftError *error) {
    WeftResult result = text_end(&draft->text, error);
    if (result != WEFT_OK) return result;
    fold_text(draft->text.bytes, draft->facts, draft->fact_count, &draft->folded);
    if (draft->folded.failed || !draft->folded.bytes) return fail(error, WEFT_MESSAGE_MEMORY, "text", NULL);
    items_cut(draft->folded.bytes, &draft->items);
    if (draft->items.short_of_memory) return fail(error, WEFT_MESSAGE_MEMORY, "text", NULL);
    for (int k = 0; k < draft->root_count; k++)
        if (!items_keep(&draft->items, draft->roots[k]))
            return fail(error, WEFT_MESSAGE_TEXT_NAME, draft->roots[k], NULL);
    find_used(draft);
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
