#include "text/source/reference.h"

#include "text/source/token.h"

/* Appends a piece of source. */
static void put(const Buffer *source, Token token, Buffer *out) {
    out->origin = buffer_origin(source, (size_t)(token.at - source->bytes));
    buffer_put(out, token.at, token.size);
}

/* Writes "const T *" at c, in a list of parameters, as "T", and "T *" as "inout T". Returns the end of it, or c if
 * there is none. */
static const char *put_parameter(const Buffer *source, const char *c, const char *end, Buffer *out) {
    const char *cursor = c;
    Token type = token_solid(&cursor, end);
    bool read = token_is(type, "const");
    if (read) type = token_solid(&cursor, end);
    if (type.kind != TOKEN_NAME || !token_is(token_solid(&cursor, end), "*")) return c;
    out->origin = buffer_origin(source, (size_t)(c - source->bytes));
    if (!read) buffer_put_text(out, "inout ");
    put(source, type, out);
    buffer_put_text(out, " ");
    return cursor;
}

/* Returns true if an operator after this token has one operand. */
static bool is_open(Token last) {
    if (last.kind == TOKEN_NAME) return token_is(last, "return") || token_is(last, "else") || token_is(last, "do");
    return last.kind == TOKEN_MARK && !token_is(last, ")") && !token_is(last, "]");
}

/* Returns true if brackets after this token contain a condition and not an operand. */
static bool has_condition(Token last) {
    return token_is(last, "if") || token_is(last, "for") || token_is(last, "while");
}

/* Writes a token of a function's body, without operators that make or follow a reference. Returns the end of the source
 * that was read. */
static const char *put_body(const Buffer *source, Token token, Token last, const char *c, const char *end,
                            Buffer *out) {
    bool same = c < end && *c == *token.at;
    if (token_is(token, "-") && c < end && *c == '>') {
        out->origin = buffer_origin(source, (size_t)(token.at - source->bytes));
        buffer_put_text(out, ".");
        return c + 1;
    }
    if (token_is(token, "&") && same) { /* && of a condition */
        token.size = 2;
        put(source, token, out);
        return c + 1;
    }
    if (!is_open(last) || (!token_is(token, "&") && !token_is(token, "*"))) put(source, token, out);
    return c;
}

void reference_put(const Buffer *source, Buffer *out) {
    const char *c = source->bytes, *end = c + source->size;
    int depth = 0, list = 0, condition = 0; /* the level of brackets of a condition */
    Token last = {0};
    while (c < end) {
        const char *start = c;
        Token token = token_next(&c, end);
        if (depth == 0 && list > 0 && token.kind == TOKEN_NAME && !token_is(last, "const")) {
            const char *stop = put_parameter(source, start, end, out);
            if (stop != start) {
                c = blank_end(stop, end);
                last = token;
                continue;
            }
        }
        if (depth > 0)
            c = put_body(source, token, last, c, end, out);
        else
            put(source, token, out);
        depth += token_is(token, "{") - token_is(token, "}");
        list += token_is(token, "(") - token_is(token, ")");
        if (token_is(token, "(") && has_condition(last)) condition = list;
        if (token.kind != TOKEN_BLANK) last = token;
        if (token_is(token, ")") && list + 1 == condition) {
            last = (Token){TOKEN_MARK, ";", 1};
            condition = 0;
        }
    }
}
