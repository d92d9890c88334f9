/* token.h - shading text cut into tokens */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

typedef enum TokenKind { TOKEN_NONE, TOKEN_BLANK, TOKEN_NAME, TOKEN_NUMBER, TOKEN_STRING, TOKEN_MARK } TokenKind;

/* A piece of the text it was cut from. A TOKEN_MARK is one character, or "##". Comments count as blank. */
typedef struct Token {
    TokenKind kind;
    const char *at;
    size_t size;
} Token;

static inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
static inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
static inline bool is_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || is_digit(c);
}

/* Returns the end of the string that opens at c, or end. */
static inline const char *string_end(const char *c, const char *end) {
    for (c++; c < end && *c != '"'; c++)
        if (*c == '\\' && c + 1 < end) c++;
    return c < end ? c + 1 : end;
}

static inline bool is_comment(const char *c, const char *end) { return c + 1 < end && c[0] == '/' && c[1] == '*'; }

/* Returns the end of the comment that opens at c, or end. */
static inline const char *comment_end(const char *c, const char *end) {
    for (c += 2; c + 1 < end && (c[0] != '*' || c[1] != '/');) c++;
    return c + 1 < end ? c + 2 : end;
}

/* Returns the end of the blanks and comments at c, or end. */
static inline const char *blank_end(const char *c, const char *end) {
    while (c < end && (is_blank(*c) || is_comment(c, end))) c = is_blank(*c) ? c + 1 : comment_end(c, end);
    return c;
}

/* Takes the next token from [*cursor, end); TOKEN_NONE at the end. */
static inline Token token_next(const char **cursor, const char *end) {
    const char *c = *cursor;
    Token token = {TOKEN_NONE, c, 0};
    if (c >= end) return token;
    if (is_blank(*c) || is_comment(c, end)) {
        token.kind = TOKEN_BLANK;
        c = blank_end(c, end);
    } else if (is_digit(*c) || (*c == '.' && c + 1 < end && is_digit(c[1]))) {
        token.kind = TOKEN_NUMBER;
        for (; c < end && (is_name(*c) || *c == '.'); c++)
            if ((*c == 'e' || *c == 'E') && c + 1 < end && (c[1] == '-' || c[1] == '+')) c++;
    } else if (is_name(*c)) {
        token.kind = TOKEN_NAME;
        while (c < end && is_name(*c)) c++;
    } else if (*c == '"') {
        token.kind = TOKEN_STRING;
        c = string_end(c, end);
    } else {
        token.kind = TOKEN_MARK;
        c += *c == '#' && c + 1 < end && c[1] == '#' ? 2 : 1;
    }
    token.size = (size_t)(c - token.at);
    *cursor = c;
    return token;
}

/* Takes the next token that is not blank. */
static inline Token token_solid(const char **cursor, const char *end) {
    Token token = token_next(cursor, end);
    return token.kind == TOKEN_BLANK ? token_next(cursor, end) : token;
}

static inline bool token_is(Token token, const char *text) {
    return token.size == strlen(text) && memcmp(token.at, text, token.size) == 0;
}

static inline bool token_same(Token a, Token b) { return a.size == b.size && memcmp(a.at, b.at, a.size) == 0; }

/* Returns the next token that is not blank, without taking it. */
static inline Token token_peek(const char *c, const char *end) { return token_solid(&c, end); }

static inline int token_depth(Token token) {
    if (token.kind != TOKEN_MARK) return 0;
    return (*token.at == '(' || *token.at == '{' || *token.at == '[') -
           (*token.at == ')' || *token.at == '}' || *token.at == ']');
}

/* Returns the end of the bracket that closes the one at c, or end. */
static inline const char *token_closed(const char *c, const char *end) {
    int depth = 0;
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;) {
        depth += token_depth(token);
        if (depth == 0) return c;
    }
    return end;
}

/* Returns true if [c, end) contains the name other than as a member. */
static inline bool token_found(const char *c, const char *end, Token name) {
    bool member = false;
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;) {
        if (!member && token_same(token, name)) return true;
        if (token.kind != TOKEN_BLANK) member = token_is(token, ".");
    }
    return false;
}
