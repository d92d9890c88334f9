#include "text/source/macro.h"

#include <stdio.h>

/* Limits far above the needs of any table: a macro that exceeds them expands without end. */
enum { PARAMS_MAX = 16, DEPTH_MAX = 256, STEPS_MAX = 1 << 20, BYTES_MAX = 1 << 22 };

typedef struct Macro {
    struct Macro *older;
    Token name;
    Token params[PARAMS_MAX];
    int param_count; /* -1: no parentheses */
    const char *body, *end;
    bool busy; /* being expanded: its own name stays as it is */
    bool gone;
} Macro;

static void set_wrong(Macros *macros, Token token, const char *what) {
    if (!*macros->wrong)
        snprintf(macros->wrong, sizeof macros->wrong, "%.*s %s", (int)(token.size < 40 ? token.size : 40), token.at,
                 what);
}

static Macro *find(const Macros *macros, Token name) {
    for (Macro *macro = macros->newest; macro; macro = macro->older)
        if (macro->name.size == name.size && memcmp(macro->name.at, name.at, name.size) == 0)
            return macro->gone ? NULL : macro;
    return NULL;
}

bool macro_defined(const Macros *macros, Token name) { return find(macros, name) != NULL; }

void macro_undefine(Macros *macros, Token name) {
    Macro *macro = find(macros, name);
    if (macro) macro->gone = true;
}

/* Copies a definition with its continued lines as ordinary ones, indented as the rows of a table are. Returns NULL if
 * memory is short. */
static char *copy_joined(Macros *macros, const char *c, size_t size) {
    char *copy = arena_array(&macros->arena, 4 * size + 1, 1), *out = copy;
    if (!copy) return NULL;
    for (const char *end = c + size; c < end;) {
        if (*c == '\\' && c + 1 < end && c[1] == '\n') {
            while (out > copy && is_blank(out[-1])) out--;
            for (c += 2; c < end && is_blank(*c);) c++;
            memcpy(out, "\n    ", 5);
            out += 5;
        } else {
            *out++ = *c++;
        }
    }
    while (out > copy && is_blank(out[-1])) out--;
    *out = 0;
    return copy;
}

/* Takes "(a, b)" from the cursor into the macro's parameters. */
static void take_params(Macros *macros, Macro *macro, const char **cursor, const char *end) {
    macro->param_count = 0;
    ++*cursor;
    for (;;) {
        Token token = token_solid(cursor, end);
        if (token_is(token, ")")) return;
        if (token_is(token, ",")) continue;
        if (token.kind != TOKEN_NAME || macro->param_count == PARAMS_MAX) {
            set_wrong(macros, macro->name, "has parameters that cannot be read");
            return;
        }
        macro->params[macro->param_count++] = token;
    }
}

void macro_define(Macros *macros, const char *definition, size_t size) {
    const char *c = copy_joined(macros, definition, size);
    Macro *macro = arena_array(&macros->arena, 1, sizeof *macro);
    if (!c || !macro) {
        macros->short_of_memory = true;
        return;
    }
    const char *end = c + strlen(c);
    macro->name = token_solid(&c, end);
    if (macro->name.kind != TOKEN_NAME) {
        set_wrong(macros, macro->name, "cannot be defined");
        return;
    }
    macro->param_count = -1;
    if (c < end && *c == '(') take_params(macros, macro, &c, end);
    while (c < end && is_blank(*c)) c++;
    macro->body = c;
    macro->end = end;
    macro->older = macros->newest;
    macros->newest = macro;
}

/* Takes the unexpanded arguments of a call from the cursor, which is after the opening parenthesis. Returns their
 * number, or -1 if the call does not end or has too many. */
static int take_arguments(const char **cursor, const char *end, Token arguments[PARAMS_MAX]) {
    int count = 0, depth = 0;
    const char *start = *cursor;
    for (;;) {
        Token token = token_next(cursor, end);
        if (token.kind == TOKEN_NONE) return -1;
        bool last = depth == 0 && token_is(token, ")");
        if (last || (depth == 0 && token_is(token, ","))) {
            const char *stop = token.at;
            while (start < stop && is_blank(*start)) start++;
            while (stop > start && is_blank(stop[-1])) stop--;
            if (count == PARAMS_MAX) return -1;
            arguments[count++] = (Token){TOKEN_NONE, start, (size_t)(stop - start)};
            if (last) return count;
            start = *cursor;
        }
        depth += token_is(token, "(") - token_is(token, ")");
    }
}

static int param_index(const Macro *macro, Token token) {
    for (int k = 0; token.kind == TOKEN_NAME && k < macro->param_count; k++)
        if (macro->params[k].size == token.size && memcmp(macro->params[k].at, token.at, token.size) == 0) return k;
    return -1;
}

static bool pastes_next(const char *cursor, const char *end) { return token_is(token_solid(&cursor, end), "##"); }

/* Appends the body with arguments in place of parameters. Beside ## arguments are not expanded. */
static void substitute(Macros *macros, const Macro *macro, const Token *arguments, Buffer *out) {
    bool pasted = false;
    for (const char *c = macro->body; c < macro->end;) {
        Token token = token_next(&c, macro->end);
        if (token.kind == TOKEN_BLANK && (pasted || pastes_next(c, macro->end))) continue;
        if (token_is(token, "##")) {
            pasted = true;
            continue;
        }
        if (token_is(token, "#") && c < macro->end) { /* an argument as a string, which only C reads */
            token_next(&c, macro->end);
            buffer_put_text(out, "\"\"");
            continue;
        }
        int k = param_index(macro, token);
        if (k < 0)
            buffer_put(out, token.at, token.size);
        else if (pasted || pastes_next(c, macro->end))
            buffer_put(out, arguments[k].at, arguments[k].size);
        else
            macro_expand(macros, arguments[k].at, arguments[k].at + arguments[k].size, out);
        pasted = false;
    }
}

static void expand_body(Macros *macros, Macro *macro, const char *body, const char *end, Buffer *out) {
    macros->bytes += (size_t)(end - body);
    if (macros->bytes > BYTES_MAX) {
        set_wrong(macros, macro->name, "expands without end");
        return;
    }
    macro->busy = true;
    macro_expand(macros, body, end, out);
    macro->busy = false;
}

/* Expands a call whose name has been taken; false where no call follows the name. */
static bool expand_call(Macros *macros, Macro *macro, const char **cursor, const char *end, Buffer *out) {
    const char *c = *cursor;
    if (!token_is(token_solid(&c, end), "(")) return false;
    Token arguments[PARAMS_MAX];
    int count = take_arguments(&c, end, arguments);
    if (count == 1 && macro->param_count == 0 && arguments[0].size == 0) count = 0;
    *cursor = c;
    if (count != macro->param_count) {
        set_wrong(macros, macro->name, "is called with arguments that do not fit");
        return true;
    }
    Buffer body = {0};
    substitute(macros, macro, arguments, &body);
    if (body.bytes) expand_body(macros, macro, body.bytes, body.bytes + body.size, out);
    out->failed |= body.failed;
    buffer_free(&body);
    return true;
}

/* Removes, after an empty expansion, the line if it contained nothing else, or else the space after the macro. */
static void close_gap(const char **source, const char *end, Buffer *out) {
    const char *next = *source;
    size_t line = out->size;
    while (next < end && (*next == ' ' || *next == '\t')) next++;
    while (line > 0 && (out->bytes[line - 1] == ' ' || out->bytes[line - 1] == '\t')) line--;
    if (line > 0 && out->bytes[line - 1] == '\n' && next < end && *next == '\n') {
        out->size = line;
        next++;
    }
    *source = next;
}

void macro_next(Macros *macros, const char **source, const char *end, Buffer *out) {
    Token token = token_next(source, end);
    Macro *macro = token.kind == TOKEN_NAME ? find(macros, token) : NULL;
    size_t before = out->size;
    bool taken = macro && !macro->busy;
    if (taken && (macros->depth == DEPTH_MAX || ++macros->steps == STEPS_MAX)) {
        set_wrong(macros, token, "expands without end");
        return;
    }
    macros->depth++;
    if (taken && macro->param_count < 0)
        expand_body(macros, macro, macro->body, macro->end, out);
    else if (taken)
        taken = expand_call(macros, macro, source, end, out);
    macros->depth--;
    if (!taken) buffer_put(out, token.at, token.size);
    if (out->size == before) close_gap(source, end, out);
}

void macro_expand(Macros *macros, const char *source, const char *end, Buffer *out) {
    while (source < end && !out->failed && !*macros->wrong) macro_next(macros, &source, end, out);
}
