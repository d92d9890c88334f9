#include "text/passes/items.h"

#include "text/assemble/text.h"

enum { ITEMS_MAX = 4096, FILES_MAX = 256 };

/* Returns the end of the declaration at c: after the brace of a function, else after the semicolon. */
static const char *item_end(const char *c, const char *end, bool record) {
    int depth = 0;
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;) {
        depth += token_is(token, "{") - token_is(token, "}");
        if (token_is(token, "}") && depth == 0 && !record) return c;
        if (token_is(token, ";") && depth == 0) return c;
    }
    return end;
}

/* Sets the name and kind of an item. Returns false for a function without a body. */
static bool name_item(Item *item) {
    const char *c = item->code;
    Token first = token_solid(&c, item->end), second = token_solid(&c, item->end);
    item->name = second;
    if (token_is(first, "struct")) {
        item->kind = ITEM_RECORD;
        return true;
    }
    if (token_is(first, "const")) {
        item->kind = ITEM_CONSTANT;
        item->name = token_solid(&c, item->end);
        return true;
    }
    item->kind = ITEM_FUNCTION;
    return item->end[-1] == '}';
}

static bool starts(const char *c, const char *mark) { return strncmp(c, mark, strlen(mark)) == 0; }

static void put_file(Items *items, const char *c, const char *stop) {
    c += strlen(TEXT_FILE_MARK);
    while (*c == ' ') c++;
    Token name = {TOKEN_NAME, c, (size_t)(stop - 3 - c)};
    for (int k = 0; k < items->file_count; k++)
        if (items->files[k].name.size == name.size && memcmp(items->files[k].name.at, c, name.size) == 0) {
            items->file = k;
            return;
        }
    if (items->file_count == FILES_MAX) return;
    items->file = items->file_count;
    items->files[items->file_count++] = (ItemFile){name, NULL, NULL};
}

/* Takes the blanks, comments and marks before an item. Returns the item's own comment, or NULL. */
static const char *take_comments(Items *items, const char **cursor, const char *end) {
    const char *c = *cursor, *own = NULL;
    while (c < end && (is_blank(*c) || is_comment(c, end))) {
        if (is_blank(*c)) {
            c++;
            continue;
        }
        const char *stop = comment_end(c, end);
        if (starts(c, TEXT_FILE_MARK)) {
            put_file(items, c, stop);
            own = NULL;
        } else if (starts(c, TEXT_HEAD_MARK) && items->file_count) {
            items->files[items->file].head = c;
            items->files[items->file].head_end = stop;
        } else if (!own) {
            own = c;
        }
        c = stop;
    }
    *cursor = c;
    return own;
}

void items_cut(const char *text, Items *out) {
    *out = (Items){0};
    out->all = arena_array(&out->arena, ITEMS_MAX, sizeof *out->all);
    out->files = arena_array(&out->arena, FILES_MAX, sizeof *out->files);
    out->short_of_memory = !out->all || !out->files;
    const char *end = text + strlen(text);
    for (const char *c = text; c < end && !out->short_of_memory && out->count < ITEMS_MAX;) {
        const char *own = take_comments(out, &c, end), *first = c;
        if (c == end) break;
        bool record = token_is(token_next(&first, end), "struct");
        Item item = {
            .comment = own, .code = c, .end = item_end(c, end, record), .file = out->file_count ? out->file : -1};
        if (name_item(&item)) out->all[out->count++] = item;
        c = item.end;
    }
}

void items_free(Items *items) {
    arena_free(&items->arena);
    *items = (Items){0};
}

static bool is_named(const Item *item, Token name) { return token_same(item->name, name); }

const Item *items_find(const Items *items, Token name) {
    for (int k = 0; k < items->count; k++)
        if (is_named(&items->all[k], name)) return &items->all[k];
    return NULL;
}

/* Keeps all items of a name and what they need. Returns false if there is none. */
static bool keep_named(Items *items, Token name) {
    bool found = false;
    for (int k = 0; k < items->count; k++) {
        Item *item = &items->all[k];
        if (!is_named(item, name)) continue;
        found = true;
        if (item->kept) continue;
        item->kept = true;
        bool member = false;
        const char *c = item->code;
        for (Token token; (token = token_next(&c, item->end)).kind != TOKEN_NONE;) {
            if (token.kind == TOKEN_NAME && !member) keep_named(items, token);
            member = token_is(token, ".");
        }
    }
    return found;
}

bool items_keep(Items *items, const char *name) {
    for (int k = 0; k < items->count; k++) items->all[k].named |= token_is(items->all[k].name, name);
    return keep_named(items, (Token){TOKEN_NAME, name, strlen(name)});
}
