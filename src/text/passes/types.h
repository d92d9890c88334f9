/* types.h - the records that the names of a text belong to */
#pragma once

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

/* Returns the list whose opening bracket is at c. A list of more than LIST_MAX pieces has a count of 0. */
List list_of(const char *c, const char *end);

/* Returns the end of the bracket that closes a list, or end. */
const char *list_end(const List *list, const char *end);

/* Returns the parameters of a function, and sets the brace that opens its body. */
List types_parameters(const Item *function, const char **body);

/* "inout T name" and "T name". */
typedef struct Parameter {
    Token type, name;
    bool written;
} Parameter;
Parameter types_parameter(const List *list, int place);

/* Returns true if the function writes through a parameter. */
bool types_writes(const Item *function);

/* Return the type of a member, and of a function's result; a token of kind TOKEN_NONE if there is none. */
Token types_member(const Items *items, Token record, Token member);
Token types_result(const Items *items, Token function);

/* A member that a function names. */
typedef struct Access {
    Token record; /* TOKEN_NONE: unknown */
    Token member;
    const char *statement, *statement_end; /* the statement that writes to the whole or a part; NULL: a read */
} Access;

/* Calls visit with each access of a function, in their order. */
void types_accesses(const Items *items, const Item *function, void (*visit)(void *user, const Access *access),
                    void *user);

/* Returns the names that the statement at c declares, as "T a = 1, b, c[2];" does, each piece with its value, and sets
 * their type. The count is 0 if it is no declaration. */
List types_declared(const char *c, const char *end, Token *type);

/* Returns the end of the statement at c, which has no block: after its semicolon. */
const char *types_statement_end(const char *c, const char *end);

/* Returns true if a statement of a block may begin after this token. */
bool types_begins(Token before);

/* Returns the end of the path that the statement at c writes to, as "a.b[2].c = ...;" does, or NULL. */
const char *types_stored(const char *c, const char *end);
