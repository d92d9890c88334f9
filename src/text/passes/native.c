#include "text/passes/native.h"

#include "text/passes/types.h"

/* The precedence of an expression. */
typedef enum Bond { BOND_CHOICE, BOND_SUM, BOND_PRODUCT, BOND_CALL } Bond;

/* A call, and the expression that replaces it, with the arguments in place of A, B and C. */
typedef struct Form {
    const char *call, *form;
    Bond bond;
} Form;

static const Form forms[] = {
    {"dir", "Dir(A, B, C)", BOND_CALL},       {"dir_dot", "dot(A, B)", BOND_CALL},
    {"dir_add", "A + B", BOND_SUM},           {"dir_scale", "A * B", BOND_PRODUCT},
    {"dir_cross", "cross(A, B)", BOND_CALL},  {"dir_mirror", "reflect(-A, B)", BOND_CALL},
    {"rgb", "Rgb(A, B, C)", BOND_CALL},       {"rgb_grey", "Rgb(A)", BOND_CALL},
    {"rgb_add", "A + B", BOND_SUM},           {"rgb_mul", "A * B", BOND_PRODUCT},
    {"rgb_scale", "A * B", BOND_PRODUCT},     {"rgb_mix", "mix(A, B, C)", BOND_CALL},
    {"rgb_min", "min(A, Rgb(B))", BOND_CALL},
};

static const Form *find_form(Token name) {
    for (size_t k = 0; k < sizeof forms / sizeof *forms; k++)
        if (token_is(name, forms[k].call)) return &forms[k];
    return NULL;
}

static Bond least(Bond a, Bond b) { return a < b ? a : b; }

/* Returns the precedence of a binary operator; signs are not looked up. */
static Bond bond_of(Token mark) {
    if (token_is(mark, "*") || token_is(mark, "/")) return BOND_PRODUCT;
    if (token_is(mark, "+") || token_is(mark, "-")) return BOND_SUM;
    return token_is(mark, ".") ? BOND_CALL : BOND_CHOICE;
}

static Bond put_range(const char *c, const char *end, Buffer *out);

/* Writes an operand, in parentheses if its precedence is less than `bond`. */
static void put_operand(Piece piece, Bond bond, Buffer *out) {
    Buffer words = {0};
    bool bracketed = put_range(piece.at, piece.end, &words) < bond;
    if (bracketed) buffer_put_text(out, "(");
    if (words.bytes) buffer_put(out, words.bytes, words.size);
    if (bracketed) buffer_put_text(out, ")");
    out->failed |= words.failed;
    buffer_free(&words);
}

static void put_form(const Form *form, const List *arguments, Buffer *out) {
    Token before = {TOKEN_MARK, "(", 1};
    const char *c = form->form, *end = c + strlen(c);
    while (c < end) {
        Token token = token_next(&c, end);
        int place = token.size == 1 && *token.at >= 'A' && *token.at <= 'C' ? *token.at - 'A' : -1;
        bool among = token_is(before, "(") || token_is(before, ",");
        if (place < 0 || place >= arguments->count)
            buffer_put(out, token.at, token.size);
        else if (form->bond == BOND_CALL)
            put_operand(arguments->all[place], among ? BOND_CHOICE : BOND_CALL, out);
        else /* the order of the operations stays */
            put_operand(arguments->all[place], place ? form->bond + 1 : form->bond, out);
        if (token.kind != TOKEN_BLANK) before = token;
    }
}

/* Returns the least precedence that an expression needs between two tokens. */
static Bond bond_between(Token before, Token after) {
    if (token_is(before, "/") || token_is(after, ".") || token_is(after, "[")) return BOND_CALL;
    if (token_is(before, "*") || token_is(before, "-") || token_is(after, "*") || token_is(after, "/"))
        return BOND_PRODUCT;
    return token_is(before, "+") || token_is(after, "+") || token_is(after, "-") ? BOND_SUM : BOND_CHOICE;
}

/* Returns true if a name is that of a call. In a definition its type is before it. */
static bool is_call(Token before, Token name, const char *c, const char *end) {
    bool defined = before.kind == TOKEN_NAME && !token_is(before, "return") && !token_is(before, "else");
    return name.kind == TOKEN_NAME && !defined && token_is(token_peek(c, end), "(");
}

/* Writes a range of text with its calls replaced. Returns the precedence of the written expression. */
static Bond put_range(const char *c, const char *end, Buffer *out) {
    Bond bond = BOND_CALL;
    int depth = 0;
    Token before = {TOKEN_NONE, "", 0};
    while (c < end) {
        Token token = token_next(&c, end);
        const Form *form = is_call(before, token, c, end) ? find_form(token) : NULL;
        if (form) {
            List arguments = list_of(c, end);
            c = list_end(&arguments, end);
            bool bracketed = form->bond < bond_between(before, token_peek(c, end));
            if (bracketed) buffer_put_text(out, "(");
            put_form(form, &arguments, out);
            if (bracketed) buffer_put_text(out, ")");
            if (depth == 0 && !bracketed) bond = least(bond, form->bond);
            before = (Token){TOKEN_MARK, ")", 1};
            continue;
        }
        buffer_put(out, token.at, token.size);
        depth += token_depth(token);
        if (depth == 0 && token.kind == TOKEN_MARK && token_depth(token) == 0) bond = least(bond, bond_of(token));
        if (token.kind != TOKEN_BLANK) before = token;
    }
    return bond;
}

void native_put(const char *text, Buffer *out) { put_range(text, text + strlen(text), out); }
