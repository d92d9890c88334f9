#include "text/passes/spell.h"

#include <stdio.h>

#include "text/passes/types.h"
#include "text/passes/wgsl.h"

typedef struct Word {
    const char *dialect, *spelt; /* name in the dialect and in the language */
} Word;

/* The words that a language spells differently. */
static const Word glsl_words[] = {{"Dir", "vec3"}, {"Rgb", "vec3"}, {NULL, NULL}};
static const Word hlsl_words[] = {{"Dir", "float3"}, {"Rgb", "float3"}, {"mix", "lerp"}, {NULL, NULL}};
static const Word c_words[] = {{"abs", "fabsf"}, {"floor", "floorf"},  {"sqrt", "sqrtf"}, {"sin", "sinf"},
                               {"cos", "cosf"},  {"exp", "expf"},      {"exp2", "exp2f"}, {"log2", "log2f"},
                               {"pow", "powf"},  {"uint", "unsigned"}, {NULL, NULL}};
static const Word wgsl_words[] = {{"Dir", "vec3f"}, {"Rgb", "vec3f"}, {"float", "f32"},
                                  {"int", "i32"},   {"uint", "u32"},  {NULL, NULL}};
static const Word *const words_of[] = {glsl_words, hlsl_words, c_words, wgsl_words};

static const Word c_helpers[] = {
    {"min", "(float a, float b) { return a < b ? a : b; }"},
    {"max", "(float a, float b) { return a > b ? a : b; }"},
    {"clamp", "(float x, float low, float high) { return x < low ? low : x > high ? high : x; }"},
    {"mix", "(float a, float b, float t) { return a + (b - a) * t; }"},
    {NULL, NULL}};

static bool is_vector(const Speller *speller, Token name) {
    return speller->language != SPELL_C && (token_is(name, "Dir") || token_is(name, "Rgb"));
}

static char upper(char c) { return c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : c; }

char *spell_name(const Speller *speller, ItemKind kind, const char *dialect, char name[SPELL_NAME]) {
    int size = 0;
    bool first = true;
    for (const char *c = speller->prefix; *c; c++) {
        if (kind == ITEM_RECORD && *c == '_') {
            first = true;
            continue;
        }
        name[size++] = kind == ITEM_CONSTANT || (kind == ITEM_RECORD && first) ? upper(*c) : *c;
        first = false;
    }
    snprintf(name + size, (size_t)(SPELL_NAME - size), "%s", dialect);
    return name;
}

char *spell_item(const Speller *speller, const Items *items, ItemKind kind, const char *dialect,
                 char name[SPELL_NAME]) {
    const Item *item = items_find(items, (Token){TOKEN_NAME, dialect, strlen(dialect)});
    Speller own = *speller;
    if (item && item->own) memcpy(own.prefix, own.own, sizeof own.prefix);
    return spell_name(&own, kind, dialect, name);
}

static void put_name(const Speller *speller, const Item *item, Buffer *out) {
    char text[SPELL_NAME - SPELL_PREFIX], name[SPELL_NAME];
    Speller own = *speller;
    if (item->own) memcpy(own.prefix, own.own, sizeof own.prefix);
    snprintf(text, sizeof text, "%.*s", (int)item->name.size, item->name.at);
    buffer_put_text(out, spell_name(&own, item->kind, text, name));
}

static const Word *find_word(const Word *words, Token name) {
    for (; words->dialect; words++)
        if (token_is(name, words->dialect)) return words;
    return NULL;
}

/* Writes a number. A float in C ends in f. */
static void put_number(const Speller *speller, Token number, Buffer *out) {
    bool real = false, f = number.at[number.size - 1] == 'f', whole = number.at[number.size - 1] == 'u';
    for (size_t k = 0; k < number.size; k++) real |= !whole && (number.at[k] == '.' || number.at[k] == 'e');
    buffer_put(out, number.at, number.size - (real && f));
    if (speller->language == SPELL_C && real) buffer_put(out, "f", 1);
}

/* Writes the type of a vector, or the name of a call that makes one, which in HLSL is a cast for a single number. */
static void put_vector(const Speller *speller, const char *spelt, bool made, const char *c, const char *end,
                       Buffer *out) {
    bool cast = speller->language == SPELL_HLSL && made && list_of(c, end).count == 1;
    if (cast) buffer_put_text(out, "(");
    buffer_put_text(out, spelt);
    if (cast) buffer_put_text(out, ")");
}

/* Writes a name that is no member's and that ends at c. */
static void put_word(const Speller *speller, const Items *items, Token name, const char *c, const char *end,
                     Buffer *out) {
    bool call = token_is(token_peek(c, end), "(");
    const Word *word = find_word(words_of[speller->language], name);
    bool vector = is_vector(speller, name), whole = token_is(name, "uint");
    bool cast = token_is(name, "float") || token_is(name, "int") || whole;
    bool type = speller->language == SPELL_WGSL || whole; /* all words of WGSL are types */
    const Item *item = vector ? NULL : items_find(items, name);
    if (speller->language == SPELL_C && call && cast) {
        buffer_put(out, "(", 1);
        if (word)
            buffer_put_text(out, word->spelt);
        else
            buffer_put(out, name.at, name.size);
        buffer_put(out, ")", 1);
    } else if (word && (call || vector || type))
        put_vector(speller, word->spelt, vector && call, c, end, out);
    else if (item)
        put_name(speller, item, out);
    else if (speller->language == SPELL_C && call && find_word(c_helpers, name))
        put_name(speller, &(Item){.kind = ITEM_FUNCTION, .name = name}, out);
    else
        buffer_put(out, name.at, name.size);
}

/* Returns true if a function's parameter of that place is written. */
static bool is_written(const Item *function, int place) {
    const char *body;
    const List list = types_parameters(function, &body);
    return place < list.count && types_parameter(&list, place).written;
}

/* Returns true if the function has a written parameter of that name. */
static bool is_reference(const Item *function, Token name) {
    const char *body;
    const List list = types_parameters(function, &body);
    for (int k = 0; k < list.count; k++) {
        const Parameter parameter = types_parameter(&list, k);
        if (parameter.written && token_same(parameter.name, name)) return true;
    }
    return false;
}

/* Returns true if the name at the end of a piece of a record's list is a type: in WGSL the type follows
 * the member. */
static bool is_type(const Speller *speller, Token before, const char *c, const char *end) {
    if (speller->language == SPELL_WGSL) return !token_is(token_peek(c, end), ":");
    return token_is(before, "{") || token_is(before, ";") || token_is(before, "[");
}

/* Writes code with its names spelt. Members keep their names; in a record only the types are spelt. */
static void put_code(const Speller *speller, const Items *items, const char *c, const char *end, bool record,
                     Buffer *out) {
    Token before = {TOKEN_NONE, "", 0};
    while (c < end) {
        Token token = token_next(&c, end);
        bool member = token_is(before, ".") || (record && !is_type(speller, before, c, end));
        if (token.kind == TOKEN_NUMBER)
            put_number(speller, token, out);
        else if (token.kind == TOKEN_NAME && !member)
            put_word(speller, items, token, c, end, out);
        else
            buffer_put(out, token.at, token.size);
        if (token.kind != TOKEN_BLANK) before = token;
    }
}

static const char *find(const char *c, const char *end, const char *mark) {
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;)
        if (token_is(token, mark)) return token.at;
    return end;
}

/* Writes the parameter "inout Name x", whose first word ends at c, as a pointer. Returns the place from which to go
 * on. */
static const char *put_pointer(const Speller *speller, const Items *items, const char *c, const char *end,
                               Buffer *out) {
    Token type = token_solid(&c, end);
    put_word(speller, items, type, c, end, out);
    buffer_put_text(out, " *");
    return blank_end(c, end);
}

/* The nested calls around a place, each with the number of the argument. */
typedef struct Calls {
    struct {
        const Item *function;
        int place;
    } open[64];
    int depth;
} Calls;

static void calls_follow(Calls *calls, const Items *items, Token before, Token token) {
    const Item *function = before.kind == TOKEN_NAME ? items_find(items, before) : NULL;
    if (token_is(token, "(") && ++calls->depth < 64) {
        calls->open[calls->depth].function = function && function->kind == ITEM_FUNCTION ? function : NULL;
        calls->open[calls->depth].place = 0;
    }
    if (token_is(token, ")")) calls->depth--;
    if (token_is(token, ",") && calls->depth >= 0 && calls->depth < 64) calls->open[calls->depth].place++;
}

/* Writes code of a function in C, with its references as pointers. */
static void put_c_code(const Speller *speller, const Items *items, const Item *function, const char *c, const char *end,
                       Buffer *out) {
    Calls calls = {0};
    Token before = {0};
    while (c < end) {
        Token token = token_next(&c, end);
        const char *next = c;
        bool member = token_is(before, "."), follows = token_is(token_solid(&next, end), ".");
        bool own = token.kind == TOKEN_NAME && !member && is_reference(function, token);
        if (token_is(token, "inout")) {
            c = put_pointer(speller, items, c, end, out);
        } else if (token.kind == TOKEN_NAME && !member) {
            bool argument = token_is(before, "(") || token_is(before, ",");
            bool written = argument && calls.depth > 0 && calls.depth < 64 && calls.open[calls.depth].function &&
                           is_written(calls.open[calls.depth].function, calls.open[calls.depth].place);
            bool declared = token_is(before, "inout");
            if (written && (follows || !own)) buffer_put_text(out, "&");
            if (own && !follows && !written && !declared) buffer_put_text(out, "*");
            put_word(speller, items, token, c, end, out);
            if (own && follows) {
                buffer_put_text(out, "->");
                token = (Token){TOKEN_MARK, ".", 1};
                c = next;
            }
        } else if (token.kind == TOKEN_NUMBER) {
            put_number(speller, token, out);
        } else {
            buffer_put(out, token.at, token.size);
        }
        calls_follow(&calls, items, before, token);
        if (token.kind != TOKEN_BLANK) before = token;
    }
}

/* Writes a function in C, with a statement that names each unread parameter. */
static void put_c_function(const Speller *speller, const Items *items, const Item *item, Buffer *out) {
    const char *open = find(item->code, item->end, "("), *close = find(open, item->end, ")");
    const char *body = find(close, item->end, "{"), *c = open + 1;
    buffer_put_text(out, "static inline ");
    put_code(speller, items, item->code, open + 1, false, out);
    if (blank_end(open + 1, close) == close) buffer_put_text(out, "void");
    put_c_code(speller, items, item, open + 1, body + 1, out);
    for (Token last = {0}; c <= close;) {
        Token token = token_solid(&c, item->end);
        if ((token_is(token, ",") || token_is(token, ")")) && last.kind == TOKEN_NAME && !token_is(last, "void") &&
            !token_found(body, item->end, last)) {
            buffer_put_text(out, "\n    (void)");
            put_word(speller, items, last, c, item->end, out);
            buffer_put_text(out, ";");
        }
        last = token;
    }
    put_c_code(speller, items, item, body + 1, item->end, out);
}

/* Writes an item in WGSL: first in its syntax, then with its names spelt. */
static void put_wgsl(const Speller *speller, const Items *items, const Item *item, Buffer *out) {
    Buffer words = {0};
    bool record = item->kind == ITEM_RECORD;
    (record ? wgsl_put_members : wgsl_put_function)(item, &words);
    if (record) {
        buffer_put_text(out, "struct ");
        put_name(speller, item, out);
        buffer_put_text(out, " ");
    }
    if (words.bytes) put_code(speller, items, words.bytes, words.bytes + words.size, record, out);
    out->failed |= words.failed;
    buffer_free(&words);
}

static void put_record(const Speller *speller, const Items *items, const Item *item, Buffer *out) {
    const char *open = find(item->code, item->end, "{"), *close = item->end - 1;
    while (close > open && *close != '}') close--;
    buffer_put_text(out, speller->language == SPELL_C ? "typedef struct " : "struct ");
    put_name(speller, item, out);
    buffer_put_text(out, " ");
    put_code(speller, items, open, close, true, out);
    buffer_put_text(out, "}");
    if (speller->language == SPELL_C) {
        buffer_put_text(out, " ");
        put_name(speller, item, out);
    }
    buffer_put_text(out, ";");
}

static void put_constant(const Speller *speller, const Items *items, const Item *item, Buffer *out) {
    const char *c = item->code, *value = find(item->code, item->end, "=") + 1;
    token_solid(&c, item->end);
    Token type = token_solid(&c, item->end);
    bool enumerated = speller->language == SPELL_C && token_is(type, "int");
    bool wgsl = speller->language == SPELL_WGSL;
    if (enumerated) {
        buffer_put_text(out, "enum { ");
    } else {
        buffer_put_text(out, wgsl || speller->language == SPELL_GLSL ? "const " : "static const ");
        if (!wgsl) buffer_put(out, type.at, type.size);
        if (!wgsl) buffer_put_text(out, " ");
    }
    put_name(speller, item, out);
    if (wgsl) buffer_put_text(out, ": ");
    if (wgsl) put_word(speller, items, type, item->end, item->end, out);
    buffer_put_text(out, " =");
    put_code(speller, items, value, item->end - 1, false, out);
    buffer_put_text(out, enumerated ? " };" : ";");
}

static bool is_called(const Items *const *texts, int count, Token name) {
    for (int t = 0; t < count; t++)
        for (int k = 0; k < texts[t]->count; k++) {
            const Item *item = &texts[t]->all[k];
            if (item->kept && token_found(item->code, item->end, name)) return true;
        }
    return false;
}

void spell_helpers(const Speller *speller, const Items *const *texts, int count, Buffer *out) {
    if (speller->language != SPELL_C) return;
    for (const Word *helper = c_helpers; helper->dialect; helper++) {
        const Token name = {TOKEN_NAME, helper->dialect, strlen(helper->dialect)};
        if (!is_called(texts, count, name)) continue;
        buffer_put_text(out, "static inline float ");
        put_name(speller, &(Item){.kind = ITEM_FUNCTION, .name = name}, out);
        buffer_put_text(out, helper->spelt);
        buffer_put_text(out, "\n");
    }
    buffer_put_text(out, "\n");
}

static bool is_line(const Item *item) {
    return !item->comment && !memchr(item->code, '\n', (size_t)(item->end - item->code));
}

static bool is_put(const Item *item, bool late) { return item->kept && item->late == late; }

void spell_items(const Speller *speller, const Items *items, bool late, Buffer *out) {
    bool line = false, any = false;
    int file = -1;
    for (int k = 0; k < items->count; k++) {
        const Item *item = &items->all[k];
        if (!is_put(item, late) || (item->kind == ITEM_RECORD && is_vector(speller, item->name))) continue;
        const ItemFile *from = item->file < 0 ? NULL : &items->files[item->file];
        bool first = from && from->head && item->file != file;
        for (int j = 0; j < k && first; j++) first = !is_put(&items->all[j], late) || items->all[j].file != item->file;
        if (any && (!line || !is_line(item) || first)) buffer_put_text(out, "\n");
        if (first) {
            buffer_put_text(out, "/*");
            buffer_put(out, from->head + 3, (size_t)(from->head_end - from->head) - 3);
            buffer_put_text(out, "\n\n");
        }
        file = item->file;
        if (item->comment) buffer_put(out, item->comment, (size_t)(item->code - item->comment));
        if (item->kind == ITEM_CONSTANT)
            put_constant(speller, items, item, out);
        else if (speller->language == SPELL_WGSL)
            put_wgsl(speller, items, item, out);
        else if (item->kind == ITEM_RECORD)
            put_record(speller, items, item, out);
        else if (speller->language == SPELL_C)
            put_c_function(speller, items, item, out);
        else
            put_code(speller, items, item->code, item->end, false, out);
        buffer_put_text(out, "\n");
        line = is_line(item);
        any = true;
    }
}
