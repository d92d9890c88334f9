/* types.h - the records that the names of a text belong to */
#ifndef WEFT_TEXT_TYPES_H
#define WEFT_TEXT_TYPES_H

#include "text/passes/items.h"

typedef struct Piece {
    const char *at, *end; /* without the blanks around it */
} Piece;

enum { LIST_MAX = 24 };

/* A list between brackets, cut at its commas: the arguments of a call, or a function's parameters. */
typedef struct List {
    Piece all[LIST_MAX];
    int count;
    const char *open, *close; /* the brackets */
} List;

/* c is at the opening bracket. What is more than a list holds is not counted: its length is then 0. */
List list_of(const char *c, const char *end);

/* Behind the bracket that closes it, or end. */
const char *list_end(const List *list, const char *end);

/* The parameters of a function, and the brace that its body begins with. */
List types_parameters(const Item *function, const char **body);

/* "inout T name" and "T name". */
typedef struct Parameter {
    Token type, name;
    bool written;
} Parameter;
Parameter types_parameter(const List *list, int place);

/* Returns true if the function writes through a parameter. */
bool types_writes(const Item *function);

/* The type of a member, and of what a function returns: a token of kind TOKEN_NONE where there is none. */
Token types_member(const Items *items, Token record, Token member);
Token types_result(const Items *items, Token function);

/* A member that a function names. */
typedef struct Access {
    Token record; /* TOKEN_NONE: of which record is not known */
    Token member;
    const char *statement,
        *statement_end; /* the statement that writes to the whole or a part; NULL: a read */
} Access;

/* Calls visit with each of them, in their order. */
void types_accesses(const Items *items, const Item *function, void (*visit)(void *user, const Access *access),
                    void *user);

/* "T a = 1, b, c[2];" at c where a statement begins: its names, each [at, end) with what it is set to.
 * A length of 0 where it declares nothing. */
List types_declared(const char *c, const char *end, Token *type);

/* Behind the semicolon of the plain statement at c. */
const char *types_statement_end(const char *c, const char *end);

/* Returns true if a statement of a block may begin after this token. */
bool types_begins(Token before);

/* "a.b[2].c = ...;" at c where a statement begins: behind its path, or NULL. */
const char *types_stored(const char *c, const char *end);

#endif
