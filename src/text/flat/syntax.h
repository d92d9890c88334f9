/* syntax.h - shader text as a tree
 *
 * The text is what text_end (text/assemble/text.h) makes: GLSL 3.30 or ES 3.00 without preprocessor lines but the
 * first, of records, functions, constants, uniforms, inputs and outputs. */
#pragma once

#include "base/memory.h"
#include "text/source/token.h"

/* The number of a name: equal names have equal numbers. 0: none. */
typedef int Symbol;

enum { SYMBOLS_MOST = 8192 };

typedef struct SymbolTable {
    Token names[SYMBOLS_MOST];
    int next[SYMBOLS_MOST];    /* the symbol before it with the same hash */
    int buckets[SYMBOLS_MOST]; /* 0: empty */
    int count;                 /* the first is no name */
} SymbolTable;

/* Returns the number of a name, 0 if there are too many. */
Symbol symbol_of(SymbolTable *symbols, Token name);

/* A two-character operator is its first character times 256 plus the second, and "<<=" the same of "<<" plus 65536. */
typedef int Operator;
#define OPERATOR(a, b) ((a)*256 + (b))

typedef enum ExprKind {
    EXPR_NUMBER, /* word */
    EXPR_NAME,   /* name; true and false among them */
    EXPR_CALL,   /* name of a function or type, arguments a and those after it */
    EXPR_MEMBER, /* a . name */
    EXPR_INDEX,  /* a [b] */
    EXPR_UNARY,  /* op a */
    EXPR_BINARY, /* a op b */
    EXPR_SELECT, /* a ? b : c */
    EXPR_ASSIGN  /* a = b; op is 0, or that of "+=" without its "="; ++k is k += 1, and k++ has the value before */
} ExprKind;

typedef struct Expr {
    ExprKind kind;
    Operator op;
    Symbol name;
    Token word;
    struct Expr *a, *b, *c;
    struct Expr *next; /* argument */
    bool before;       /* an assignment's value is that before it */
} Expr;

typedef enum StatementKind {
    STATEMENT_BLOCK,   /* body */
    STATEMENT_DECLARE, /* type name[size] = value */
    STATEMENT_EXPR,    /* value */
    STATEMENT_IF,      /* value, body, other */
    STATEMENT_FOR,     /* start, value (NULL: always), step, body; a while has neither start nor step */
    STATEMENT_SWITCH,  /* value, body, in which cases are labels */
    STATEMENT_CASE,    /* value; NULL: default */
    STATEMENT_RETURN,  /* value or NULL */
    STATEMENT_BREAK,
    STATEMENT_CONTINUE,
    STATEMENT_DISCARD
} StatementKind;

typedef struct StatementSyntax {
    StatementKind kind;
    Expr *value, *step;
    struct StatementSyntax *start, *body, *other;
    Symbol type, name;
    Expr *size; /* of an array; NULL: none */
    struct StatementSyntax *next;
    bool rolled; /* a loop that was found too long to be unrolled */
} StatementSyntax;

/* A member of a record or block, or a parameter. */
typedef struct FieldSyntax {
    Symbol type, name;
    Expr *size;
    bool written;         /* a parameter that is "inout" or "out" */
    bool fresh;           /* "out" */
    const char *at, *end; /* qualifiers and type, as they are written */
    struct FieldSyntax *next;
} FieldSyntax;

typedef enum DeclarationKind {
    DECLARATION_RECORD,
    DECLARATION_FUNCTION,
    DECLARATION_VARIABLE, /* of the text, perhaps constant */
    DECLARATION_OUTSIDE,  /* a uniform or an input */
    DECLARATION_OUTPUT,
    DECLARATION_BLOCK /* of uniforms */
} DeclarationKind;

typedef struct Declaration {
    DeclarationKind kind;
    Symbol type, name;     /* a function's type is its result's */
    FieldSyntax *fields;   /* members or parameters */
    StatementSyntax *body; /* of a function */
    Expr *value, *size;    /* of a variable */
    bool constant;
    const char *at, *end; /* qualifiers and type of a variable, or a block's line, as they are written */
    struct Declaration *next;
} Declaration;

typedef struct Syntax {
    Arena arena;
    SymbolTable symbols;
    Declaration *first;
    const char *head, *head_end; /* the lines before the first declaration: version and precision */
    const char *wrong;           /* what was not understood; NULL: all was */
} Syntax;

/* Reads a text, which is borrowed. Call syntax_free afterwards, in any case. */
void syntax_read(const char *text, Syntax *out);
void syntax_free(Syntax *syntax);
