/* merge.c - several drafts as one text: equal items are written once, different ones get the id of their draft */
#include "export/draft.h"

/* Returns true if `test` is true for any other item that the code of an item names. */
static bool any_named(const Items *items, const Item *item, bool (*test)(const Item *named)) {
    bool member = false;
    const char *c = item->code;
    for (Token token; (token = token_next(&c, item->end)).kind != TOKEN_NONE;) {
        const Item *named = token.kind == TOKEN_NAME && !member ? items_find(items, token) : NULL;
        if (named && named != item && test(named)) return true;
        if (token.kind != TOKEN_BLANK) member = token_is(token, ".");
    }
    return false;
}

static bool is_own(const Item *item) { return item->own; }
static bool is_late(const Item *item) { return item->own || item->late; }

/* Returns the kept item of that name, or NULL. */
static Item *find_kept(Draft *draft, Token name) {
    for (int k = 0; k < draft->items.count; k++)
        if (draft->items.all[k].kept && token_same(draft->items.all[k].name, name)) return &draft->items.all[k];
    return NULL;
}

static bool same_code(const Item *a, const Item *b) {
    size_t size = (size_t)(a->end - a->code);
    return size == (size_t)(b->end - b->code) && memcmp(a->code, b->code, size) == 0;
}

/* Marks items of one name in two drafts as their draft's own if their code, or the code of items that it names,
 * differs. Returns true if an item was marked. */
static bool part(Draft *a, Draft *b) {
    bool any = false;
    for (int k = 0; k < a->items.count; k++) {
        Item *item = &a->items.all[k], *other = item->kept ? find_kept(b, item->name) : NULL;
        if (!other || (item->own && other->own)) continue;
        bool differs = item->own || other->own || !same_code(item, other) || any_named(&a->items, item, is_own) ||
                       any_named(&b->items, other, is_own);
        item->own = other->own = differs;
        any |= differs;
    }
    return any;
}

/* Drops the items that an earlier draft writes. */
static void drop_repeated(Draft *drafts, int which) {
    for (int k = 0; k < drafts[which].items.count; k++) {
        Item *item = &drafts[which].items.all[k];
        for (int j = 0; j < which && item->kept && !item->late; j++) {
            const Item *before = find_kept(&drafts[j], item->name);
            if (before && !before->late) item->kept = false;
        }
    }
}

void drafts_merge(Draft *drafts, int count) {
    for (bool changed = true; changed;) {
        changed = false;
        for (int a = 0; a < count; a++)
            for (int b = a + 1; b < count; b++) changed |= part(&drafts[a], &drafts[b]);
    }
    for (int d = 0; d < count; d++)
        for (int k = 0; k < drafts[d].items.count; k++) { /* items that an item names are written before it */
            Item *item = &drafts[d].items.all[k];
            item->late = item->own || (item->kept && any_named(&drafts[d].items, item, is_late));
        }
    for (int d = count - 1; d > 0; d--) drop_repeated(drafts, d);
}

/* Drops the comments at the top of files whose first item has been written. */
static void drop_heads(Draft *drafts, int count, const Draft *from, bool late) {
    for (int k = 0; k < from->items.count; k++) {
        const Item *item = &from->items.all[k];
        if (!item->kept || item->late != late || item->file < 0) continue;
        const Token name = from->items.files[item->file].name;
        for (int d = 0; d < count; d++)
            for (int f = 0; f < drafts[d].items.file_count; f++)
                if (token_same(drafts[d].items.files[f].name, name)) drafts[d].items.files[f].head = NULL;
    }
}

static bool has_late(const Items *items) {
    for (int k = 0; k < items->count; k++)
        if (items->all[k].kept && items->all[k].late) return true;
    return false;
}

void drafts_spell(Draft *drafts, int count, Buffer *out) {
    for (int late = 0; late < 2; late++)
        for (int d = 0; d < count; d++) {
            if (late && has_late(&drafts[d].items)) put_line(out, "\n/* %s: what is its own */", drafts[d].id[0]);
            size_t size = out->size;
            spell_items(&drafts[d].speller, &drafts[d].items, late, out);
            if (out->size > size && d + 1 < count) buffer_put_text(out, "\n");
            drop_heads(drafts, count, &drafts[d], late);
        }
}
