/* items.h - a text cut into its declarations and functions, and the selection of those that are needed */
#pragma once

#include "base/memory.h"
#include "text/source/token.h"

typedef enum ItemKind { ITEM_RECORD, ITEM_FUNCTION, ITEM_CONSTANT } ItemKind;

typedef struct Item {
    ItemKind kind;
    Token name;
    const char *comment; /* the item's comment, if any: [comment, code) */
    const char *code, *end;
    int file;   /* index into files, -1: none */
    bool kept;  /* needed */
    bool named; /* kept by name, for users of the text */
    bool own;   /* has a name of this text alone */
    bool late;  /* is placed after the items that several texts share */
} Item;

/* A file of the catalogue that items come from. */
typedef struct ItemFile {
    Token name;
    const char *head, *head_end; /* the comment that it begins with; NULL: none */
} ItemFile;

/* Borrows the text that it was made from. */
typedef struct Items {
    Arena arena;
    Item *all;
    ItemFile *files;
    int count, file_count;
    int file; /* index of the file whose items are being cut */
    bool short_of_memory;
} Items;

/* Cuts a text as TextDesc.comments makes it. Nothing is kept yet. Declarations of functions without their
 * body are left out: a text defines before it calls. Call items_free. */
void items_cut(const char *text, Items *out);
void items_free(Items *items);

/* Keeps the item of that name and all it needs. Returns false if there is none. */
bool items_keep(Items *items, const char *name);

/* Returns the item of a name, or NULL. */
const Item *items_find(const Items *items, Token name);
