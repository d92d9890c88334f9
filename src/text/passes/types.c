#include "text/passes/types.h"

static const Token NOTHING = {TOKEN_NONE, "", 0};
enum { DEPTH_MAX = 64, SYMBOLS_MAX = 256 };

static void list_put(List *list, const char *at, const char *end) {
    at = blank_end(at, end);
    while (end > at && is_blank(end[-1])) end--;
    if (at < end && list->count <= LIST_MAX) {
        if (list->count < LIST_MAX) list->all[list->count] = (Piece){at, end};
        list->count++;
    }
}

/* Returns the list from c up to the mark that closes it. */
static List list_cut(const char *c, const char *end, const char *close) {
    List list = {.open = c, .close = end};
    const char *from = c;
    int depth = 0;
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;) {
        bool stop = depth == 0 && token_is(token, close);
        if (stop || (depth == 0 && token_is(token, ","))) {
            list_put(&list, from, token.at);
            from = c;
        }
        if (stop) {
            list.close = token.at;
            break;
        }
        depth += token_depth(token);
    }
    if (list.count > LIST_MAX) list.count = 0;
    return list;
}

List list_of(const char *c, const char *end) {
    Token open = token_solid(&c, end);
    List list = list_cut(c, end, ")");
    list.open = open.at;
    return list;
}

const char *list_end(const List *list, const char *end) { return list->close < end ? list->close + 1 : end; }

List types_parameters(const Item *function, const char **body) {
    const char *c = function->code;
    while (c < function->end && *c != '(') c++;
    List list = list_of(c, function->end);
    *body = token_peek(list_end(&list, function->end), function->end).at;
    return list;
}

Parameter types_parameter(const List *list, int place) {
    const char *c = list->all[place].at, *end = list->all[place].end;
    Token first = token_solid(&c, end);
    bool written = token_is(first, "inout");
    Token type = written ? token_solid(&c, end) : first;
    return (Parameter){type, token_solid(&c, end), written};
}

bool types_writes(const Item *function) {
    const char *body;
    List list = types_parameters(function, &body);
    bool written = false;
    for (int k = 0; k < list.count; k++) written |= types_parameter(&list, k).written;
    return written;
}

const char *types_statement_end(const char *c, const char *end) {
    int depth = 0;
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;) {
        depth += token_depth(token);
        if (depth == 0 && token_is(token, ";")) return c;
    }
    return end;
}

bool types_begins(Token before) {
    return before.kind == TOKEN_MARK &&
           (token_is(before, "{") || token_is(before, "}") || token_is(before, ";") || token_is(before, ":"));
}

const char *types_stored(const char *c, const char *end) {
    if (token_solid(&c, end).kind != TOKEN_NAME) return NULL;
    for (;;) {
        const char *stop = c;
        Token token = token_solid(&c, end);
        if (token_is(token, "["))
            c = token_closed(token.at, end);
        else if (token_is(token, "."))
            token_solid(&c, end);
        else
            return token_is(token, "=") && *c != '=' ? stop : NULL;
    }
}

List types_declared(const char *c, const char *end, Token *type) {
    static const char *const words[] = {"return", "else", "case", "const", "struct", "inout"};
    Token first = token_solid(&c, end), name = token_peek(c, end);
    *type = first;
    bool declares = first.kind == TOKEN_NAME && name.kind == TOKEN_NAME;
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) declares &= !token_is(first, words[k]);
    return declares ? list_cut(c, end, ";") : (List){.count = 0};
}

Token types_member(const Items *items, Token record, Token member) {
    const Item *item = record.kind == TOKEN_NAME ? items_find(items, record) : NULL;
    if (!item || item->kind != ITEM_RECORD) return NOTHING;
    const char *c = item->code;
    while (c < item->end && *c != '{') c++;
    for (c++; c < item->end && token_peek(c, item->end).kind == TOKEN_NAME;) {
        Token type;
        List names = types_declared(c, item->end, &type);
        for (int k = 0; k < names.count; k++)
            if (token_same(token_peek(names.all[k].at, names.all[k].end), member)) return type;
        c = types_statement_end(c, item->end);
    }
    return NOTHING;
}

/* The types of a function's parameters and variables. */
typedef struct Symbols {
    struct {
        Token name, type; /* a type of kind TOKEN_NONE: of more than one */
    } all[SYMBOLS_MAX];
    int count;
} Symbols;

static Token find_symbol(const Symbols *symbols, Token name) {
    for (int k = 0; k < symbols->count; k++)
        if (token_same(symbols->all[k].name, name)) return symbols->all[k].type;
    return NOTHING;
}

static void add_symbol(Symbols *symbols, Token name, Token type) {
    for (int k = 0; k < symbols->count; k++) {
        if (!token_same(symbols->all[k].name, name)) continue;
        if (!token_same(symbols->all[k].type, type)) symbols->all[k].type = NOTHING;
        return;
    }
    if (symbols->count == SYMBOLS_MAX) return; /* the record of a further name is unknown */
    symbols->all[symbols->count].name = name;
    symbols->all[symbols->count++].type = type;
}

static void list_symbols(const Item *function, Symbols *out) {
    const char *c;
    Token before = NOTHING;
    List parameters = types_parameters(function, &c);
    out->count = 0;
    for (int k = 0; k < parameters.count; k++) {
        Parameter parameter = types_parameter(&parameters, k);
        add_symbol(out, parameter.name, parameter.type);
    }
    for (const char *at = c; c < function->end; at = c) {
        Token token = token_next(&c, function->end), type;
        if (token.kind == TOKEN_BLANK) continue;
        bool begins = token.kind == TOKEN_NAME && (types_begins(before) || token_is(before, "("));
        List names = begins ? types_declared(at, function->end, &type) : (List){.count = 0};
        for (int k = 0; k < names.count; k++) add_symbol(out, token_peek(names.all[k].at, names.all[k].end), type);
        before = token;
    }
}

Token types_result(const Items *items, Token function) {
    const Item *item = items_find(items, function);
    if (!item || item->kind != ITEM_FUNCTION) return NOTHING;
    const char *c = item->code;
    return token_solid(&c, item->end);
}

typedef struct Walk {
    const Items *items;
    Symbols symbols;
    void (*visit)(void *user, const Access *access);
    void *user;
    Token type; /* of the expression that has just ended */
    Token outer[DEPTH_MAX];
    int depth;
} Walk;

static void take_member(Walk *walk, Token member, const char *statement, const char *statement_end) {
    walk->visit(walk->user, &(Access){walk->type, member, statement, statement_end});
    walk->type = types_member(walk->items, walk->type, member);
}

/* Updates the type at a bracket. An opening one stores the type of the expression before it, which its closing one
 * restores: the result of a call, or the array's type for an index. */
static void take_bracket(Walk *walk, Token before, Token bracket) {
    bool open = token_is(bracket, "(") || token_is(bracket, "[");
    if (open) {
        bool call = token_is(bracket, "(");
        Token type = walk->type;
        if (call) type = before.kind == TOKEN_NAME ? types_result(walk->items, before) : NOTHING;
        if (walk->depth < DEPTH_MAX) walk->outer[walk->depth] = type;
        walk->depth++;
        walk->type = NOTHING;
    } else {
        walk->depth--;
        walk->type = walk->depth >= 0 && walk->depth < DEPTH_MAX ? walk->outer[walk->depth] : NOTHING;
    }
}

static void take_token(Walk *walk, Token before, Token token, const char *statement, const char *statement_end) {
    bool bracket = token_is(token, "(") || token_is(token, "[") || token_is(token, ")") || token_is(token, "]");
    if (bracket)
        take_bracket(walk, before, token);
    else if (token.kind == TOKEN_NAME && token_is(before, "."))
        take_member(walk, token, statement, statement_end);
    else if (token.kind == TOKEN_NAME)
        walk->type = find_symbol(&walk->symbols, token);
    else if (!token_is(token, "."))
        walk->type = NOTHING;
}

void types_accesses(const Items *items, const Item *function, void (*visit)(void *user, const Access *access),
                    void *user) {
    Walk walk;
    walk.items = items;
    walk.visit = visit;
    walk.user = user;
    walk.type = NOTHING;
    walk.depth = 0;
    list_symbols(function, &walk.symbols);
    const char *c, *stored = NULL, *statement = NULL, *stop = NULL;
    Token before = NOTHING;
    types_parameters(function, &c);
    for (const char *at = c; c < function->end; at = c) {
        Token token = token_next(&c, function->end);
        if (token.kind == TOKEN_BLANK) continue;
        if (types_begins(before) && walk.depth == 0 && (stored = types_stored(at, function->end)) != NULL) {
            statement = at;
            stop = types_statement_end(at, function->end);
        }
        bool store = stored && at < stored && walk.depth == 0;
        take_token(&walk, before, token, store ? statement : NULL, store ? stop : NULL);
        before = token;
    }
}
