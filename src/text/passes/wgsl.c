#include "text/passes/wgsl.h"

#include "text/passes/types.h"

typedef struct FunctionBody {
    const Item *function;
    Buffer *out;
} FunctionBody;

static void put(Buffer *out, const char *c, const char *end) {
    if (c < end) buffer_put(out, c, (size_t)(end - c));
}

static void put_token(Buffer *out, Token token) { buffer_put(out, token.at, token.size); }

static const char *trimmed_end(const char *c, const char *end) {
    while (end > c && is_blank(end[-1])) end--;
    return end;
}

/* Returns the first such mark outside of brackets, or end. */
static const char *find_mark(const char *c, const char *end, const char *mark) {
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;) {
        if (token_is(token, mark)) return token.at;
        if (token_depth(token) > 0) c = token_closed(token.at, end);
    }
    return end;
}

/* Returns the colon of the choice whose "?" is at c. */
static const char *find_colon(const char *c, const char *end) {
    int depth = 0;
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;) {
        depth += token_is(token, "?") - token_is(token, ":");
        if (depth == 0) return token.at;
        if (token_depth(token) > 0) c = token_closed(token.at, end);
    }
    return end;
}

static bool is_label(Token token) { return token_is(token, "case") || token_is(token, "default"); }

/* Returns the end of the label whose first word ends at c. */
static const char *label_end(const char *c, const char *end) {
    const char *colon = find_mark(c, end, ":");
    return colon < end ? colon + 1 : end;
}

/* Returns the first "||" outside of brackets, or end. */
static const char *find_or(const char *c, const char *end) {
    while ((c = find_mark(c, end, "|")) < end && (c + 1 == end || c[1] != '|')) c++;
    return c;
}

static void put_expression(const char *c, const char *end, Buffer *out);

/* Writes a bracketed list, an expression after each comma. */
static void put_list(const char *c, const char *end, Buffer *out) {
    while (c < end) {
        const char *comma = find_mark(c, end, ",");
        put_expression(c, comma, out);
        c = comma < end ? comma + 1 : end;
        if (comma < end) buffer_put_text(out, ",");
    }
}

static void put_tokens(const char *c, const char *end, Buffer *out) {
    while (c < end) {
        Token token = token_next(&c, end);
        put_token(out, token);
        if (token_depth(token) <= 0) continue;
        const char *close = token_closed(token.at, end) - 1;
        put_list(c, close, out);
        put(out, close, close + 1);
        c = close + 1;
    }
}

/* Writes alternatives with "||" between, each in parentheses if it contains "&&": WGSL does not allow both without
 * them. */
static void put_alternatives(const char *c, const char *end, Buffer *out) {
    const char *bar = find_or(c, end);
    bool several = bar < end;
    for (;;) {
        const char *first = blank_end(c, bar), *last = trimmed_end(first, bar);
        bool bracketed = several && find_mark(first, last, "&") < last;
        put(out, c, first);
        if (bracketed) buffer_put_text(out, "(");
        put_tokens(first, last, out);
        if (bracketed) buffer_put_text(out, ")");
        put(out, last, bar);
        if (bar == end) return;
        buffer_put_text(out, "||");
        c = bar + 2;
        bar = find_or(c, end);
    }
}

/* Writes an expression with the blanks around it. */
static void put_expression(const char *c, const char *end, Buffer *out) {
    const char *mark = find_mark(c, end, "?");
    if (mark == end) {
        put_alternatives(c, end, out);
        return;
    }
    const char *colon = find_colon(mark, end), *first = blank_end(c, mark), *last = trimmed_end(colon, end);
    put(out, c, first);
    buffer_put_text(out, "select(");
    put_expression(blank_end(colon + 1, last), last, out);
    buffer_put_text(out, ", ");
    put_expression(blank_end(mark + 1, colon), trimmed_end(mark + 1, colon), out);
    buffer_put_text(out, ", ");
    put_expression(first, trimmed_end(first, mark), out);
    buffer_put_text(out, ")");
    put(out, last, end);
}

/* Returns true if the path that begins at c is written to. */
static bool is_stored(const char *c, const char *end) {
    Token token;
    token_solid(&c, end);
    for (;;) {
        token = token_solid(&c, end);
        if (token_is(token, "["))
            c = token_closed(token.at, end);
        else if (token_is(token, "."))
            token_solid(&c, end);
        else
            break;
    }
    bool changes = token_is(token, "+") || token_is(token, "-") || token_is(token, "*") || token_is(token, "/");
    if (token_is(token, "=")) return *c != '=';
    return changes && (*c == '=' || (*c == *token.at && !token_is(token, "*") && !token_is(token, "/")));
}

static bool is_written(const Item *function, Token name) {
    const char *c;
    Token before = {TOKEN_NONE, "", 0}, token;
    types_parameters(function, &c);
    for (; (token = token_next(&c, function->end)).kind != TOKEN_NONE;) {
        if (token.kind == TOKEN_BLANK) continue;
        bool declared = (before.kind == TOKEN_NAME && !token_is(before, "else")) || token_is(before, ",");
        if (token_same(token, name) && !declared && !token_is(before, ".") && is_stored(token.at, function->end))
            return true;
        before = token;
    }
    return false;
}

/* Returns the blanks before c if its line begins with them, else nothing. */
static Piece indent_of(const FunctionBody *body, const char *c) {
    const char *first = c;
    while (first > body->function->code && (first[-1] == ' ' || first[-1] == '\t')) first--;
    bool line = first > body->function->code && first[-1] == '\n';
    return line ? (Piece){first, c} : (Piece){c, c};
}

/* Writes a new line if the statement at c begins one, else a space. */
static void put_break(const FunctionBody *body, const char *c) {
    Piece indent = indent_of(body, c);
    buffer_put_text(body->out, indent.at < indent.end ? "\n" : " ");
    put(body->out, indent.at, indent.end);
}

/* Writes the type of a variable; that of "x[4]" is an array. */
static void put_type(Token type, const char *c, const char *end, Buffer *out) {
    Token bracket = token_solid(&c, end);
    bool array = token_is(bracket, "[");
    if (array) buffer_put_text(out, "array<");
    put_token(out, type);
    if (!array) return;
    buffer_put_text(out, ", ");
    put(out, c, token_closed(bracket.at, end) - 1);
    buffer_put_text(out, ">");
}

/* Writes the declaration of one name: "x = 1.0", "x" or "x[4]". */
static void put_variable(const FunctionBody *body, Token type, Piece piece) {
    const char *c = piece.at, *value = find_mark(c, piece.end, "=");
    Token name = token_solid(&c, piece.end);
    bool set = value < piece.end;
    buffer_put_text(body->out, set && !is_written(body->function, name) ? "let " : "var ");
    put_token(body->out, name);
    if (set) {
        buffer_put_text(body->out, " =");
        put_expression(value + 1, piece.end, body->out);
    } else {
        buffer_put_text(body->out, ": ");
        put_type(type, c, piece.end, body->out);
    }
}

static void put_declaration(const FunctionBody *body, const char *c, Token type, const List *names) {
    for (int k = 0; k < names->count; k++) {
        if (k) put_break(body, c);
        put_variable(body, type, names->all[k]);
        if (k + 1 < names->count) buffer_put_text(body->out, ";");
    }
}

/* Writes a statement without its semicolon: a declaration, "a = b" or "f(a)". */
static void put_action(const FunctionBody *body, const char *c, const char *end) {
    const char *from = c;
    Token type, first = token_peek(c, end);
    if (token_is(first, "const")) c = blank_end(first.at + first.size, end);
    List names = types_declared(c, body->function->end, &type);
    const char *value = find_mark(c, end, "=");
    if (names.count) {
        put_declaration(body, from, type, &names);
    } else if (value < end) {
        put_tokens(c, value + 1, body->out);
        put_expression(value + 1, end, body->out);
    } else {
        put_expression(c, end, body->out);
    }
}

static const char *put_statement(const FunctionBody *body, const char *c, const char *from);

/* Writes statements and the blanks between them, up to a brace or a case. Returns the end of what was read. */
static const char *put_statements(const FunctionBody *body, const char *c, const char *end) {
    for (;;) {
        const char *first = blank_end(c, end);
        Token token = token_peek(first, end);
        if (first >= end || token_is(token, "}") || is_label(token)) return c;
        put(body->out, c, first);
        c = put_statement(body, first, first);
    }
}

/* Writes the statement that a condition guards, in braces. from: the start of the whole statement. */
static const char *put_branch(const FunctionBody *body, const char *c, const char *from) {
    const char *end = body->function->end, *first = blank_end(c, end);
    bool braces = *first == '{', line = memchr(c, '\n', (size_t)(first - c)) != NULL;
    if (!braces) buffer_put_text(body->out, " {");
    put(body->out, c, first);
    const char *stop = put_statement(body, first, from);
    if (braces) return stop;
    if (line)
        put_break(body, from);
    else
        buffer_put_text(body->out, " ");
    buffer_put_text(body->out, "}");
    return stop;
}

static const char *put_if(const FunctionBody *body, const char *c, const char *from) {
    const char *end = body->function->end, *open = token_peek(c + 2, end).at;
    const char *close = token_closed(open, end);
    put(body->out, c, open);
    put_tokens(open, close, body->out);
    const char *stop = put_branch(body, close, from), *next = stop;
    if (!token_is(token_solid(&next, end), "else")) return stop;
    buffer_put_text(body->out, " else");
    const char *other = blank_end(next, end);
    if (!token_is(token_peek(other, end), "if")) return put_branch(body, next, from);
    put(body->out, next, other);
    return put_if(body, other, from);
}

static const char *put_for(const FunctionBody *body, const char *c, const char *from) {
    const char *end = body->function->end, *open = token_peek(c + 3, end).at;
    const char *close = token_closed(open, end), *at = open + 1;
    buffer_put_text(body->out, "for (");
    for (int part = 0; part < 3; part++) {
        const char *stop = part < 2 ? find_mark(at, close, ";") : close - 1, *first = blank_end(at, stop);
        put(body->out, at, first);
        put_action(body, first, stop);
        if (part < 2) buffer_put_text(body->out, ";");
        at = stop + 1;
    }
    buffer_put_text(body->out, ")");
    return put_branch(body, close, from);
}

/* Writes "case A: default:" at c as "case A, default: {". Returns the end of the labels. */
static const char *put_labels(const FunctionBody *body, const char *c, const char *end) {
    Token label = token_solid(&c, end);
    const char *next = label_end(c, end);
    bool alone = token_is(label, "default") && !is_label(token_peek(next, end));
    if (!alone) buffer_put_text(body->out, "case");
    for (;;) {
        if (!token_is(label, "default"))
            put_expression(c, next - 1, body->out);
        else
            buffer_put_text(body->out, alone ? "default" : " default");
        if (!is_label(token_peek(next, end))) break;
        buffer_put_text(body->out, ",");
        c = next;
        label = token_solid(&c, end);
        next = label_end(c, end);
    }
    buffer_put_text(body->out, ": {");
    return next;
}

/* Writes a case in braces and without its break, since cases of WGSL do not fall through. Returns the end of it. */
static const char *put_case(const FunctionBody *body, const char *c, const char *end) {
    size_t size;
    Piece indent = indent_of(body, c);
    c = put_labels(body, c, end);
    size = body->out->size;
    c = put_statements(body, c, end);
    while (body->out->size > size && is_blank(body->out->bytes[body->out->size - 1])) body->out->size--;
    if (body->out->size - size >= 6 && memcmp(body->out->bytes + body->out->size - 6, "break;", 6) == 0)
        body->out->size -= 6;
    while (body->out->size > size && is_blank(body->out->bytes[body->out->size - 1])) body->out->size--;
    bool empty = body->out->size == size;
    bool line = !empty && memchr(body->out->bytes + size, '\n', body->out->size - size);
    buffer_put_text(body->out, empty ? "" : line ? "\n" : " ");
    if (line) put(body->out, indent.at, indent.end);
    buffer_put_text(body->out, "}");
    return c;
}

static const char *put_switch(const FunctionBody *body, const char *c) {
    const char *end = body->function->end, *open = token_peek(c + 6, end).at;
    const char *brace = token_peek(token_closed(open, end), end).at, *close = token_closed(brace, end) - 1;
    put(body->out, c, open);
    put_tokens(open, brace, body->out);
    put(body->out, brace, brace + 1);
    for (c = brace + 1; blank_end(c, close) < close;) {
        const char *first = blank_end(c, close);
        put(body->out, c, first);
        c = put_case(body, first, close);
    }
    put(body->out, c, close + 1);
    return close + 1;
}

static const char *put_block(const FunctionBody *body, const char *c) {
    const char *close = token_closed(c, body->function->end) - 1;
    buffer_put_text(body->out, "{");
    put(body->out, put_statements(body, c + 1, close), close + 1);
    return close + 1;
}

static const char *put_while(const FunctionBody *body, const char *c, const char *from) {
    const char *end = body->function->end, *open = token_peek(c + 5, end).at;
    put(body->out, c, open);
    put_tokens(open, token_closed(open, end), body->out);
    return put_branch(body, token_closed(open, end), from);
}

/* Writes the statement at c. Returns the end of it. */
static const char *put_statement(const FunctionBody *body, const char *c, const char *from) {
    const char *end = body->function->end, *stop;
    Token first = token_peek(c, end);
    if (token_is(first, "{")) return put_block(body, c);
    if (token_is(first, "if")) return put_if(body, c, from);
    if (token_is(first, "for")) return put_for(body, c, from);
    if (token_is(first, "while")) return put_while(body, c, from);
    if (token_is(first, "switch")) return put_switch(body, c);
    stop = types_statement_end(c, end);
    if (token_is(first, "return")) {
        put_token(body->out, first);
        put_expression(c + first.size, stop - 1, body->out);
    } else {
        put_action(body, c, stop - 1);
    }
    buffer_put_text(body->out, ";");
    return stop;
}

static void put_parameters(const Item *function, const List *list, Buffer *out) {
    const char *c = list->open + 1;
    for (int k = 0; k < list->count; k++) {
        Parameter parameter = types_parameter(list, k);
        put(out, c, list->all[k].at);
        put_token(out, parameter.name);
        if (is_written(function, parameter.name)) buffer_put_text(out, "_in");
        buffer_put_text(out, ": ");
        put_token(out, parameter.type);
        c = list->all[k].end;
    }
    put(out, c, list_end(list, function->end));
}

/* Writes "var x = x_in;" for each parameter that the body writes to. */
static void put_copies(const Item *function, const List *list, const char *body, Buffer *out) {
    bool line = !memchr(body, '\n', (size_t)(function->end - body));
    for (int k = 0; k < list->count; k++) {
        Parameter parameter = types_parameter(list, k);
        if (!is_written(function, parameter.name)) continue;
        buffer_put_text(out, line ? " var " : "\n    var ");
        put_token(out, parameter.name);
        buffer_put_text(out, " = ");
        put_token(out, parameter.name);
        buffer_put_text(out, "_in;");
    }
}

void wgsl_put_function(const Item *function, Buffer *out) {
    const FunctionBody body = {function, out};
    const char *open, *c = function->code;
    Token result = token_solid(&c, function->end);
    List list = types_parameters(function, &open);
    buffer_put_text(out, "fn ");
    put_token(out, function->name);
    buffer_put_text(out, "(");
    put_parameters(function, &list, out);
    if (!token_is(result, "void")) {
        buffer_put_text(out, " -> ");
        put_token(out, result);
    }
    buffer_put_text(out, " {");
    put_copies(function, &list, open, out);
    put(out, put_statements(&body, open + 1, function->end - 1), function->end);
}

/* Writes "float a, b" as "a: float, b: float". */
static void put_member(const char *c, const char *end, Buffer *out) {
    Token type = token_solid(&c, end);
    for (const char *comma; c < end; c = comma + 1) {
        Token name = token_solid(&c, end);
        comma = find_mark(c, end, ",");
        put_token(out, name);
        buffer_put_text(out, ": ");
        put_type(type, c, comma, out);
        if (comma < end) buffer_put_text(out, ", ");
    }
}

void wgsl_put_members(const Item *record, Buffer *out) {
    const char *c = find_mark(record->code, record->end, "{"), *close = token_closed(c, record->end) - 1;
    bool line = !memchr(c, '\n', (size_t)(close - c));
    put(out, c, c + 1);
    for (c++; blank_end(c, close) < close;) {
        const char *first = blank_end(c, close), *stop = find_mark(first, close, ";");
        put(out, c, first);
        put_member(first, stop, out);
        c = stop + 1;
        if (!line || blank_end(c, close) < close) buffer_put_text(out, ",");
    }
    put(out, c, close + 1);
}

/* Takes a statement. Returns true if control never reaches the next one in its case. */
static bool take_leaving(const char **c, const char *end) {
    const char *first = blank_end(*c, end);
    Token token = token_solid(c, end), next = token_peek(*c, end);
    bool branch = token_is(token, "if"), loop = token_is(token, "for") || token_is(token, "while");
    if (token_is(token, "{")) {
        bool left = false;
        const char *close = token_closed(first, end) - 1;
        while (blank_end(*c, close) < close) left = take_leaving(c, close);
        *c = close + 1;
        return left;
    }
    if (branch || loop || token_is(token, "switch")) {
        *c = token_closed(next.at, end);
        bool left = take_leaving(c, end);
        const char *other = *c;
        if (!branch || !token_is(token_solid(&other, end), "else")) return false;
        *c = other;
        return take_leaving(c, end) && left;
    }
    *c = types_statement_end(first, end);
    return token_is(token, "return") || token_is(token, "break") || token_is(token, "continue");
}

/* Returns true if a case of the switch with its brace at `open` falls through to the next. */
static bool falls_through(const char *open, const char *end) {
    const char *close = token_closed(open, end) - 1, *c = open + 1;
    for (bool left = true; blank_end(c, close) < close;) {
        bool label = is_label(token_peek(c, close));
        if (!label) left = take_leaving(&c, close);
        if (label && !left) return true;
        if (!label) continue;
        token_solid(&c, close);
        c = label_end(c, close);
    }
    return false;
}

const char *wgsl_lacks(const Item *function) {
    const char *c, *end = function->end;
    Token result = token_peek(function->code, end);
    types_parameters(function, &c);
    if (types_writes(function))
        return token_is(result, "void") ? "it writes to several parameters"
                                        : "it returns something and writes to a parameter";
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;) {
        if (token_is(token, "do")) return "it has a loop with do";
        if (token_is(token, "switch") && falls_through(find_mark(c, end, "{"), end))
            return "it has a case that ends neither in break nor in return";
    }
    return NULL;
}
