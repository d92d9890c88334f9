#include "text/flat/syntax.h"

#include <string.h>

enum { DEPTH_MOST = 200 };

typedef struct SyntaxReader {
    Syntax *out;
    const Token *tokens;
    int count, at;
    int depth;         /* of expressions and statements inside each other */
    Declaration spare; /* what is written there is never read: the text is wrong */
} SyntaxReader;

_Static_assert(sizeof(Declaration) >= sizeof(StatementSyntax) && sizeof(Declaration) >= sizeof(Expr) &&
                   sizeof(Declaration) >= sizeof(FieldSyntax),
               "a spare declaration holds each of the others");

Symbol symbol_of(SymbolTable *symbols, Token name) {
    unsigned hash = 2166136261u;
    for (size_t k = 0; k < name.size; k++) hash = (hash ^ (unsigned char)name.at[k]) * 16777619u;
    int *bucket = &symbols->buckets[hash % SYMBOLS_MOST];
    for (int k = *bucket; k; k = symbols->next[k])
        if (token_same(symbols->names[k], name)) return k;
    if (symbols->count + 1 >= SYMBOLS_MOST) return 0;
    const int made = ++symbols->count;
    symbols->names[made] = name;
    symbols->next[made] = *bucket;
    *bucket = made;
    return made;
}

static void wrong(SyntaxReader *reader, const char *what) {
    if (!reader->out->wrong) reader->out->wrong = what;
    reader->at = reader->count; /* ends every loop of the reader */
}

static void *make(SyntaxReader *reader, size_t size) {
    void *made = arena_array(&reader->out->arena, 1, size);
    if (made) return made;
    wrong(reader, "memory is short");
    memset(&reader->spare, 0, sizeof reader->spare);
    return &reader->spare;
}

static Token peek(const SyntaxReader *reader, int ahead) {
    static const Token none = {TOKEN_NONE, "", 0};
    return reader->at + ahead < reader->count ? reader->tokens[reader->at + ahead] : none;
}

static Token take(SyntaxReader *reader) {
    const Token token = peek(reader, 0);
    reader->at++;
    return token;
}

static bool next_is(const SyntaxReader *reader, const char *text) { return token_is(peek(reader, 0), text); }

static bool take_if(SyntaxReader *reader, const char *text) {
    const bool found = next_is(reader, text);
    reader->at += found;
    return found;
}

static void expect(SyntaxReader *reader, const char *text) {
    if (!take_if(reader, text)) wrong(reader, "a mark is missing");
}

static Symbol take_name(SyntaxReader *reader) {
    const Token token = take(reader);
    if (token.kind != TOKEN_NAME) wrong(reader, "a name is missing");
    const Symbol name = symbol_of(&reader->out->symbols, token);
    if (!name) wrong(reader, "too many names");
    return name;
}

static Operator operator_of(Token token) {
    if (token.kind != TOKEN_MARK) return 0;
    return token.size == 2 ? OPERATOR(token.at[0], token.at[1]) : (Operator)token.at[0];
}

/* Returns how tightly a binary operator binds, 0 if the token is none. */
static int binding(Operator op) {
    switch (op) {
    case '*':
    case '/':
    case '%': return 10;
    case '+':
    case '-': return 9;
    case OPERATOR('<', '<'):
    case OPERATOR('>', '>'): return 8;
    case '<':
    case '>':
    case OPERATOR('<', '='):
    case OPERATOR('>', '='): return 7;
    case OPERATOR('=', '='):
    case OPERATOR('!', '='): return 6;
    case '&': return 5;
    case '^': return 4;
    case '|': return 3;
    case OPERATOR('&', '&'): return 2;
    case OPERATOR('|', '|'): return 1;
    default: return 0;
    }
}

static Expr *read_expr(SyntaxReader *reader);

static Expr *make_expr(SyntaxReader *reader, ExprKind kind) {
    Expr *expr = make(reader, sizeof *expr);
    expr->kind = kind;
    return expr;
}

/* Reads the arguments after an opening parenthesis. */
static Expr *read_arguments(SyntaxReader *reader) {
    Expr *first = NULL, **last = &first;
    if (take_if(reader, ")")) return NULL;
    if (next_is(reader, "void"))
        reader->at++;
    else
        do {
            *last = read_expr(reader);
            last = &(*last)->next;
        } while (take_if(reader, ","));
    expect(reader, ")");
    return first;
}

static Expr *read_primary(SyntaxReader *reader) {
    const Token token = peek(reader, 0);
    Expr *expr = make_expr(reader, EXPR_NUMBER);
    expr->word = token;
    if (token.kind == TOKEN_NUMBER) {
        reader->at++;
    } else if (token.kind == TOKEN_NAME) {
        expr->kind = EXPR_NAME;
        expr->name = take_name(reader);
        if (take_if(reader, "(")) {
            expr->kind = EXPR_CALL;
            expr->a = read_arguments(reader);
        }
    } else {
        expect(reader, "(");
        expr = read_expr(reader);
        expect(reader, ")");
    }
    return expr;
}

/* Returns `to` increased or decreased by one. */
static Expr *make_step(SyntaxReader *reader, Expr *to, Token mark) {
    static const Token one = {TOKEN_NUMBER, "1", 1};
    Expr *step = make_expr(reader, EXPR_ASSIGN), *by = make_expr(reader, EXPR_NUMBER);
    by->word = one;
    step->op = (unsigned char)mark.at[0];
    step->a = to;
    step->b = by;
    return step;
}

static bool is_step(Token token) { return token_is(token, "++") || token_is(token, "--"); }

static Expr *read_postfix(SyntaxReader *reader) {
    Expr *expr = read_primary(reader);
    while (next_is(reader, ".") || next_is(reader, "[") || is_step(peek(reader, 0))) {
        const Token mark = take(reader);
        Expr *outer = make_expr(reader, token_is(mark, ".") ? EXPR_MEMBER : EXPR_INDEX);
        outer->a = expr;
        if (is_step(mark)) {
            outer = make_step(reader, expr, mark);
            outer->before = true;
        } else if (token_is(mark, ".")) {
            outer->name = take_name(reader);
        } else {
            outer->b = read_expr(reader);
            expect(reader, "]");
        }
        expr = outer;
    }
    return expr;
}

static Expr *read_unary(SyntaxReader *reader) {
    const Token mark = peek(reader, 0);
    if (reader->depth > DEPTH_MOST) wrong(reader, "too deep");
    if (reader->out->wrong) return make_expr(reader, EXPR_NUMBER);
    if (is_step(mark)) {
        reader->at++;
        return make_step(reader, read_postfix(reader), mark);
    }
    if (!token_is(mark, "-") && !token_is(mark, "!") && !token_is(mark, "~") && !token_is(mark, "+"))
        return read_postfix(reader);
    reader->at++;
    Expr *expr = make_expr(reader, EXPR_UNARY);
    expr->op = (unsigned char)mark.at[0];
    reader->depth++;
    expr->a = read_unary(reader);
    reader->depth--;
    return expr;
}

static Expr *read_binary(SyntaxReader *reader, int least) {
    Expr *left = read_unary(reader);
    for (;;) {
        const Operator op = operator_of(peek(reader, 0));
        const int bound = binding(op);
        if (!bound || bound < least) return left;
        reader->at++;
        Expr *expr = make_expr(reader, EXPR_BINARY);
        expr->op = op;
        expr->a = left;
        expr->b = read_binary(reader, bound + 1);
        left = expr;
    }
}

/* Returns the operator of "+=", 0 of "=", -1 of anything else. */
static Operator assigned_by(Token token) {
    if (token_is(token, "=")) return 0;
    const bool assigns =
        token.kind == TOKEN_MARK && token.size == 2 && token.at[1] == '=' && strchr("+-*/%&|^", token.at[0]);
    return assigns ? token.at[0] : -1;
}

static Expr *read_expr(SyntaxReader *reader) {
    reader->depth++;
    Expr *expr = read_binary(reader, 1);
    const Operator assigned = assigned_by(peek(reader, 0));
    if (take_if(reader, "?")) {
        Expr *select = make_expr(reader, EXPR_SELECT);
        select->a = expr;
        select->b = read_expr(reader);
        expect(reader, ":");
        select->c = read_expr(reader);
        expr = select;
    } else if (assigned >= 0) {
        reader->at++;
        Expr *to = make_expr(reader, EXPR_ASSIGN);
        to->op = assigned;
        to->a = expr;
        to->b = read_expr(reader);
        expr = to;
    }
    reader->depth--;
    return expr;
}

/* Takes words that say nothing which the tree needs. */
static void skip_qualifiers(SyntaxReader *reader) {
    while (next_is(reader, "const") || next_is(reader, "highp") || next_is(reader, "mediump") ||
           next_is(reader, "lowp"))
        reader->at++;
}

static Expr *read_size(SyntaxReader *reader) {
    if (!take_if(reader, "[")) return NULL;
    Expr *size = read_expr(reader);
    expect(reader, "]");
    return size;
}

static StatementSyntax *make_statement(SyntaxReader *reader, StatementKind kind) {
    StatementSyntax *statement = make(reader, sizeof *statement);
    statement->kind = kind;
    return statement;
}

/* Reads "T a = 1, b[2];" as a chain of declarations. */
static StatementSyntax *read_declarations(SyntaxReader *reader) {
    StatementSyntax *first = NULL, **last = &first;
    skip_qualifiers(reader);
    const Symbol type = take_name(reader);
    do {
        StatementSyntax *one = make_statement(reader, STATEMENT_DECLARE);
        one->type = type;
        one->name = take_name(reader);
        one->size = read_size(reader);
        if (take_if(reader, "=")) one->value = read_expr(reader);
        *last = one;
        last = &one->next;
    } while (take_if(reader, ","));
    expect(reader, ";");
    return first;
}

static bool declares(const SyntaxReader *reader) {
    if (next_is(reader, "const") || next_is(reader, "highp")) return true;
    return peek(reader, 0).kind == TOKEN_NAME && peek(reader, 1).kind == TOKEN_NAME;
}

static StatementSyntax *read_statement(SyntaxReader *reader);

static StatementSyntax *read_block(SyntaxReader *reader) {
    StatementSyntax *block = make_statement(reader, STATEMENT_BLOCK), **last = &block->body;
    expect(reader, "{");
    while (!next_is(reader, "}") && reader->at < reader->count) {
        *last = read_statement(reader);
        while (*last) last = &(*last)->next; /* a declaration is several */
    }
    expect(reader, "}");
    return block;
}

static StatementSyntax *read_if(SyntaxReader *reader) {
    StatementSyntax *statement = make_statement(reader, STATEMENT_IF);
    expect(reader, "(");
    statement->value = read_expr(reader);
    expect(reader, ")");
    statement->body = read_statement(reader);
    if (take_if(reader, "else")) statement->other = read_statement(reader);
    return statement;
}

static StatementSyntax *read_for(SyntaxReader *reader, bool is_for) {
    StatementSyntax *statement = make_statement(reader, STATEMENT_FOR);
    expect(reader, "(");
    if (is_for && !take_if(reader, ";")) {
        if (declares(reader)) {
            statement->start = read_declarations(reader);
        } else {
            statement->start = make_statement(reader, STATEMENT_EXPR);
            statement->start->value = read_expr(reader);
            expect(reader, ";");
        }
    }
    if (!is_for || !next_is(reader, ";")) statement->value = read_expr(reader);
    if (is_for) {
        expect(reader, ";");
        if (!next_is(reader, ")")) statement->step = read_expr(reader);
    }
    expect(reader, ")");
    statement->body = read_statement(reader);
    return statement;
}

static StatementSyntax *read_switch(SyntaxReader *reader) {
    StatementSyntax *statement = make_statement(reader, STATEMENT_SWITCH);
    expect(reader, "(");
    statement->value = read_expr(reader);
    expect(reader, ")");
    statement->body = read_block(reader)->body;
    return statement;
}

static StatementSyntax *read_case(SyntaxReader *reader, bool valued) {
    StatementSyntax *statement = make_statement(reader, STATEMENT_CASE);
    if (valued) statement->value = read_expr(reader);
    expect(reader, ":");
    return statement;
}

/* Reads what is left of a statement of one word and perhaps a value. */
static StatementSyntax *read_jump(SyntaxReader *reader, StatementKind kind) {
    StatementSyntax *statement = make_statement(reader, kind);
    if (kind == STATEMENT_RETURN && !next_is(reader, ";")) statement->value = read_expr(reader);
    expect(reader, ";");
    return statement;
}

static StatementSyntax *read_one(SyntaxReader *reader) {
    if (next_is(reader, "{")) return read_block(reader);
    if (take_if(reader, ";")) return make_statement(reader, STATEMENT_BLOCK);
    if (take_if(reader, "if")) return read_if(reader);
    if (take_if(reader, "for")) return read_for(reader, true);
    if (take_if(reader, "while")) return read_for(reader, false);
    if (take_if(reader, "switch")) return read_switch(reader);
    if (take_if(reader, "case")) return read_case(reader, true);
    if (take_if(reader, "default")) return read_case(reader, false);
    if (take_if(reader, "return")) return read_jump(reader, STATEMENT_RETURN);
    if (take_if(reader, "break")) return read_jump(reader, STATEMENT_BREAK);
    if (take_if(reader, "continue")) return read_jump(reader, STATEMENT_CONTINUE);
    if (take_if(reader, "discard")) return read_jump(reader, STATEMENT_DISCARD);
    if (declares(reader)) return read_declarations(reader);
    StatementSyntax *statement = make_statement(reader, STATEMENT_EXPR);
    statement->value = read_expr(reader);
    expect(reader, ";");
    return statement;
}

static StatementSyntax *read_statement(SyntaxReader *reader) {
    if (++reader->depth > DEPTH_MOST) wrong(reader, "too deep");
    StatementSyntax *statement = reader->out->wrong ? make_statement(reader, STATEMENT_BLOCK) : read_one(reader);
    reader->depth--;
    return statement;
}

/* Reads the members of a record or block, to its closing brace. */
static FieldSyntax *read_members(SyntaxReader *reader) {
    FieldSyntax *first = NULL, **last = &first;
    expect(reader, "{");
    while (!take_if(reader, "}") && reader->at < reader->count) {
        const char *at = peek(reader, 0).at;
        skip_qualifiers(reader);
        const Symbol type = take_name(reader);
        const char *end = peek(reader, 0).at;
        do {
            FieldSyntax *field = make(reader, sizeof *field);
            field->type = type;
            field->at = at;
            field->end = end;
            field->name = take_name(reader);
            field->size = read_size(reader);
            *last = field;
            last = &field->next;
        } while (take_if(reader, ","));
        expect(reader, ";");
    }
    return first;
}

static FieldSyntax *read_parameters(SyntaxReader *reader) {
    FieldSyntax *first = NULL, **last = &first;
    if (take_if(reader, ")")) return NULL;
    if (next_is(reader, "void") && token_is(peek(reader, 1), ")")) {
        reader->at += 2;
        return NULL;
    }
    do {
        FieldSyntax *field = make(reader, sizeof *field);
        skip_qualifiers(reader);
        field->fresh = take_if(reader, "out");
        field->written = take_if(reader, "inout") || field->fresh;
        if (!field->written) take_if(reader, "in");
        skip_qualifiers(reader);
        field->type = take_name(reader);
        field->name = take_name(reader);
        field->size = read_size(reader);
        *last = field;
        last = &field->next;
    } while (take_if(reader, ","));
    expect(reader, ")");
    return first;
}

/* Reads names after a type: "a = 1, b[2];". */
static Declaration **read_variables(SyntaxReader *reader, const Declaration *like, Declaration **last) {
    do {
        Declaration *one = make(reader, sizeof *one);
        *one = *like;
        one->name = take_name(reader);
        one->size = read_size(reader);
        if (take_if(reader, "=")) one->value = read_expr(reader);
        *last = one;
        last = &one->next;
    } while (take_if(reader, ","));
    expect(reader, ";");
    return last;
}

/* Takes qualifiers, and returns what they declare. */
static DeclarationKind take_qualifiers(SyntaxReader *reader, bool *constant) {
    DeclarationKind kind = DECLARATION_VARIABLE;
    for (;; reader->at++) {
        *constant |= next_is(reader, "const");
        if (next_is(reader, "uniform") || next_is(reader, "in"))
            kind = DECLARATION_OUTSIDE;
        else if (next_is(reader, "out"))
            kind = DECLARATION_OUTPUT;
        else if (next_is(reader, "layout"))
            while (!token_is(peek(reader, 1), ")") && reader->at < reader->count) reader->at++;
        else if (!next_is(reader, "const") && !next_is(reader, "highp") && !next_is(reader, "centroid") &&
                 !next_is(reader, "flat") && !next_is(reader, "mediump") && !next_is(reader, "lowp") &&
                 !next_is(reader, ")"))
            return kind;
    }
}

/* Reads a function after its name. One without a body comes with it elsewhere. */
static Declaration **read_function(SyntaxReader *reader, Declaration *function, Declaration **last) {
    function->kind = DECLARATION_FUNCTION;
    function->fields = read_parameters(reader);
    if (take_if(reader, ";")) return last;
    function->body = read_block(reader);
    *last = function;
    return &function->next;
}

static Declaration **read_declaration(SyntaxReader *reader, Declaration **last) {
    Declaration *one = make(reader, sizeof *one);
    one->at = peek(reader, 0).at;
    if (take_if(reader, "struct")) {
        one->kind = DECLARATION_RECORD;
        one->name = take_name(reader);
        one->fields = read_members(reader);
        expect(reader, ";");
        *last = one;
        return &one->next;
    }
    one->kind = take_qualifiers(reader, &one->constant);
    one->type = take_name(reader);
    one->end = peek(reader, 0).at;
    if (next_is(reader, "{") && one->kind == DECLARATION_OUTSIDE) {
        one->kind = DECLARATION_BLOCK;
        one->fields = read_members(reader);
        expect(reader, ";");
        *last = one;
        return &one->next;
    }
    if (!token_is(peek(reader, 1), "(")) return read_variables(reader, one, last);
    one->name = take_name(reader);
    reader->at++;
    return read_function(reader, one, last);
}

/* Returns true if the two marks are one operator. */
static bool is_pair(Token a, Token b) {
    if (a.kind != TOKEN_MARK || b.kind != TOKEN_MARK || a.at + 1 != b.at || a.size != 1 || b.size != 1) return false;
    return (*b.at == '=' && strchr("=!<>+-*/%&|^", *a.at)) || (*a.at == *b.at && strchr("&|<>+-^", *a.at));
}

/* Cuts a text into tokens without blanks, and operators of two characters into one. Returns their count. */
static int cut(const char *c, const char *end, Token *out) {
    int count = 0;
    for (Token token; (token = token_solid(&c, end)).kind != TOKEN_NONE;) {
        if (count && is_pair(out[count - 1], token))
            out[count - 1].size = 2;
        else
            out[count++] = token;
    }
    return count;
}

/* Returns the end of the lines for the preprocessor and of precision statements that a text begins with. */
static const char *head_end(const char *c) {
    for (;;) {
        while (is_blank(*c)) c++;
        if (*c != '#' && strncmp(c, "precision ", 10) != 0) return c;
        while (*c && *c != '\n') c++;
    }
}

void syntax_read(const char *text, Syntax *out) {
    memset(out, 0, sizeof *out);
    out->head = text;
    out->head_end = head_end(text);
    const size_t size = strlen(out->head_end);
    Token *tokens = arena_array(&out->arena, size + 1, sizeof *tokens);
    if (!tokens) {
        out->wrong = "memory is short";
        return;
    }
    SyntaxReader reader = {.out = out, .tokens = tokens, .count = cut(out->head_end, out->head_end + size, tokens)};
    for (Declaration **last = &out->first; reader.at < reader.count;) last = read_declaration(&reader, last);
}

void syntax_free(Syntax *syntax) { arena_free(&syntax->arena); }
