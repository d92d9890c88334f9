#include "text/passes/returned.h"

#include "text/passes/splice.h"
#include "text/passes/types.h"

enum { FILLERS_MAX = 256 };

typedef struct Filler {
    const Item *function;
    Parameter filled;
    int place;  /* of `filled` among the parameters */
    bool takes; /* true if the function may read earlier contents and so keeps the parameter */
    List parameters;
    const char *body;
} Filler;

typedef struct Returned {
    const Items *items;
    bool all;
    Filler fillers[FILLERS_MAX];
    int count;
    Edits edits;
} Returned;

static const Filler *find_filler(const Returned *self, Token name) {
    for (int k = 0; k < self->count; k++)
        if (self->fillers[k].function && token_same(self->fillers[k].function->name, name)) return &self->fillers[k];
    return NULL;
}

/* Lists the functions that fill a record by their parameters. */
static void list_fillers(Returned *self) {
    for (int k = 0; k < self->items->count && self->count < FILLERS_MAX; k++) {
        const Item *item = &self->items->all[k];
        if (!item->kept || item->named || item->kind != ITEM_FUNCTION ||
            !token_is(token_peek(item->code, item->end), "void"))
            continue;
        Filler filler = {.function = item};
        filler.parameters = types_parameters(item, &filler.body);
        int written = 0;
        for (int n = 0; n < filler.parameters.count; n++) {
            const Parameter parameter = types_parameter(&filler.parameters, n);
            written += parameter.written;
            if (!parameter.written) continue;
            filler.filled = parameter;
            filler.place = n;
        }
        filler.takes = filler.place + 1 < filler.parameters.count;
        if (written == 1 && (self->all || !filler.takes)) self->fillers[self->count++] = filler;
    }
}

/* Returns true if [c, end) names the whole variable or its part `path`. */
static bool is_named(const char *c, const char *end, Piece path) {
    const char *rest = path.at;
    Token base = token_next(&rest, path.end), before = {TOKEN_NONE, "", 0};
    size_t members = (size_t)(path.end - rest);
    while (c < end) {
        Token token = token_next(&c, end);
        if (token_same(token, base) && !token_is(before, ".")) {
            bool other = members && *c == '.' && (size_t)(end - c) >= members && memcmp(c, rest, members) != 0;
            if (!other) return true;
        }
        if (token.kind != TOKEN_BLANK) before = token;
    }
    return false;
}

/* Returns the statement "T x;" that declares the variable without a value, or NULL. */
static const char *declared_bare(const char *body, const char *call, Piece path) {
    Token before = {TOKEN_NONE, "", 0};
    const char *c = body, *found = NULL, *rest = path.at;
    Token base = token_next(&rest, path.end);
    for (const char *at = c; c < call; at = c) {
        Token token = token_next(&c, call), type;
        if (token.kind == TOKEN_BLANK) continue;
        List names = types_begins(before) ? types_declared(at, call, &type) : (List){0};
        if (names.count == 1 && (size_t)(names.all[0].end - names.all[0].at) == base.size &&
            memcmp(names.all[0].at, base.at, base.size) == 0)
            found = at;
        before = token;
    }
    return found;
}

/* Returns true if a loop begins in [c, end), so that the code after it may run again. */
static bool has_loop(const char *c, const char *end) {
    static const char *const words[] = {"for", "while", "do"};
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;)
        for (size_t k = 0; k < sizeof words / sizeof *words; k++)
            if (token_is(token, words[k])) return true;
    return false;
}

/* Returns true if nothing was written before the call to the variable that it passes. */
static bool is_fresh(const Returned *self, const Item *caller, const char *body, const char *call, Piece path) {
    const char *declared = declared_bare(body, call, path), *from = body;
    const Filler *outer = find_filler(self, caller->name);
    const char *rest = path.at;
    Token base = token_next(&rest, path.end);
    if (declared)
        from = types_statement_end(declared, call);
    else if (!outer || outer->takes || !token_same(outer->filled.name, base))
        return false;
    return !is_named(from, call, path) && !has_loop(from, call);
}

/* A call of a filler. */
typedef struct Call {
    const Filler *filler;
    List arguments;
    Piece path; /* what it fills */
    const char *at;
} Call;

static bool call_at(const Returned *self, Token before, Token token, const char *c, const char *end, Call *out) {
    if (token.kind != TOKEN_NAME || token_is(before, ".")) return false;
    const Filler *filler = find_filler(self, token);
    if (!filler || !token_is(token_peek(c, end), "(")) return false;
    *out = (Call){.filler = filler, .arguments = list_of(c, end), .at = token.at};
    if (filler->place >= out->arguments.count) return false;
    out->path = out->arguments.all[filler->place];
    return true;
}

/* Strikes out functions of which a call passes a record that may have contents; with self->all they keep the parameter
 * instead. Returns true if there was one. */
static bool strike(Returned *self) {
    bool any = false;
    for (int k = 0; k < self->items->count; k++) {
        const Item *caller = &self->items->all[k];
        const char *body, *c;
        if (!caller->kept || caller->kind != ITEM_FUNCTION) continue;
        types_parameters(caller, &body);
        c = body;
        Token before = {TOKEN_NONE, "", 0};
        while (c < caller->end) {
            Token token = token_next(&c, caller->end);
            Call call;
            if (token.kind == TOKEN_BLANK) continue;
            if (call_at(self, before, token, c, caller->end, &call) && !call.filler->takes &&
                !is_fresh(self, caller, body, call.at, call.path)) {
                Filler *filler = &self->fillers[call.filler - self->fillers];
                filler->takes = true;
                if (!self->all) filler->function = NULL;
                any = true;
            }
            before = token;
        }
    }
    return any;
}

/* Adds an edit that replaces [at, end) by several words. */
static void put(Returned *self, const char *at, const char *end, const Token *words, int count) {
    size_t size = 0;
    char text[512];
    for (int k = 0; k < count; k++) {
        size_t more = words[k].size < sizeof text - 1 - size ? words[k].size : sizeof text - 1 - size;
        memcpy(text + size, words[k].at, more);
        size += more;
    }
    text[size] = 0;
    edit_put(&self->edits, at, end, text);
}

static Token word(const char *text) { return (Token){TOKEN_NAME, text, strlen(text)}; }

/* Makes "return x;" of "p = x;" if no other statement names the filled record. Returns false if another does. */
static bool return_value(Returned *self, const Filler *filler) {
    const char *end = filler->function->end - 1, *c = filler->body + 1, *stored;
    Token name = filler->filled.name, before = {TOKEN_MARK, "{", 1};
    for (const char *at = c; c < end; at = c) {
        Token token = token_next(&c, end);
        if (token.kind == TOKEN_BLANK) continue;
        if (token_same(token, name) && types_begins(before) && (stored = types_stored(at, end)) == c) {
            const char *stop = types_statement_end(at, end);
            const char *value = stored;
            token_solid(&value, end);
            if (token_found(filler->body, at, name) || token_found(value, end, name) || blank_end(stop, end) != end)
                return false;
            put(self, at, value, (Token[]){word("return")}, 1);
            return true;
        }
        before = token;
    }
    return false;
}

/* Returns true if a body ends with an unconditional return. */
static bool returns_last(const char *open, const char *last) {
    Token before = {TOKEN_MARK, "{", 1}, token;
    bool returns = false;
    for (const char *c = open; (token = token_next(&c, last)).kind != TOKEN_NONE;) {
        if (token.kind == TOKEN_BLANK) continue;
        if (types_begins(before)) returns = token_is(token, "return");
        before = token;
    }
    return returns && token_is(before, ";");
}

/* Makes the body declare the filled record, unless it stays a parameter, and return it. */
static void return_filled(Returned *self, const Filler *filler) {
    const char *open = filler->body + 1, *close = filler->function->end - 1, *c = open;
    bool line = !memchr(open, '\n', (size_t)(close - open));
    Token name = filler->filled.name, type = filler->filled.type;
    const char *first = blank_end(open, close), *last = close;
    while (is_blank(last[-1])) last--;
    if (!filler->takes)
        put(self, open, line ? first : open,
            (Token[]){word("\n    "), type, word(" "), name, word(line ? ";\n    " : ";")}, 5);
    else if (line)
        put(self, open, first, (Token[]){word("\n    ")}, 1);
    for (Token token; (token = token_next(&c, close)).kind != TOKEN_NONE;)
        if (token_is(token, "return")) put(self, c, c, (Token[]){word(" "), name}, 2);
    if (!returns_last(open, last)) put(self, last, close, (Token[]){word("\n    return "), name, word(";\n")}, 3);
}

static void drop_last(Returned *self, const List *list) {
    edit_put(&self->edits, list->count > 1 ? list->all[list->count - 2].end : list->open + 1, list->close, NULL);
}

static void change_function(Returned *self, const Filler *filler) {
    const char *c = filler->function->code;
    const List *list = &filler->parameters;
    Token nothing = token_solid(&c, filler->function->end);
    put(self, nothing.at, nothing.at + nothing.size, &filler->filled.type, 1);
    if (filler->takes)
        edit_put(&self->edits, list->all[filler->place].at, filler->filled.type.at, NULL);
    else
        drop_last(self, list);
    if (filler->takes || !return_value(self, filler)) return_filled(self, filler);
}

/* Returns true if both are in one block. */
static bool is_beside(const char *declared, const char *call) {
    int depth = 0;
    for (Token token; (token = token_next(&declared, call)).kind != TOKEN_NONE;) {
        depth += token_is(token, "{") - token_is(token, "}");
        if (depth < 0) return false;
    }
    return depth == 0;
}

static void change_call(Returned *self, const char *body, const Call *call, Token before) {
    const List *list = &call->arguments;
    const char *declared = declared_bare(body, call->at, call->path);
    const Token path = {TOKEN_NAME, call->path.at, (size_t)(call->path.end - call->path.at)};
    Token type = call->filler->filled.type;
    bool bare = declared && !call->filler->takes && !memchr(path.at, '.', path.size) && is_beside(declared, call->at);
    if (bare && types_begins(before)) {
        edit_drop(&self->edits, declared, types_statement_end(declared, call->at));
        put(self, call->at, call->at, (Token[]){type, word(" "), path, word(" = ")}, 4);
    } else {
        put(self, call->at, call->at, (Token[]){path, word(" = ")}, 2);
    }
    if (!call->filler->takes) drop_last(self, list);
}

static void change_calls(Returned *self, const Item *caller) {
    Token before = {TOKEN_NONE, "", 0};
    const char *body, *c;
    types_parameters(caller, &body);
    for (c = body; c < caller->end;) {
        Token token = token_next(&c, caller->end);
        Call call;
        if (token.kind == TOKEN_BLANK) continue;
        if (call_at(self, before, token, c, caller->end, &call)) change_call(self, body, &call, before);
        before = token;
    }
}

void returned_put(const Items *items, const char *text, bool all, Buffer *out) {
    Returned self = {.items = items, .all = all};
    list_fillers(&self);
    while (strike(&self)) {
    }
    for (int k = 0; k < self.count; k++)
        if (self.fillers[k].function) change_function(&self, &self.fillers[k]);
    for (int k = 0; k < items->count; k++)
        if (items->all[k].kept && items->all[k].kind == ITEM_FUNCTION) change_calls(&self, &items->all[k]);
    if (!edits_apply(&self.edits, text, out)) buffer_put_text(out, text);
}
