#include "text/passes/unused.h"

#include <stdio.h>
#include <string.h>

#include "text/passes/splice.h"
#include "text/passes/types.h"

enum { MEMBERS_MAX = 1024, USES_MAX = 256 };

typedef struct Member {
    Token record, name;
    bool read;
} Member;

typedef struct Unused {
    const Items *items;
    Edits edits;
    Member members[MEMBERS_MAX];
    int member_count;
} Unused;

static bool is_whole(Token record, const char *const *whole) {
    for (; *whole; whole++)
        if (token_is(record, *whole)) return true;
    return false;
}

/* Returns true if the mark at c assigns: it is none of "==", "!=", "<=" and ">=". */
static bool is_assignment(const char *c, const char *end) {
    return *c == '=' && !(c + 1 < end && c[1] == '=') && !strchr("=!<>", c[-1]);
}

/* Returns true if [c, end) has a side effect beside `own` assignments: it calls a function that writes
 * through a parameter, increments a variable, or assigns once more. */
static bool has_effect(const Items *items, const char *c, const char *end, int own) {
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;) {
        const Item *called =
            token.kind == TOKEN_NAME && token_is(token_peek(c, end), "(") ? items_find(items, token) : NULL;
        bool counts = (token_is(token, "+") || token_is(token, "-")) && c < end && *c == *token.at;
        own -= token.kind == TOKEN_MARK && is_assignment(token.at, end);
        if (counts || own < 0 || (called && called->kind == ITEM_FUNCTION && types_writes(called))) return true;
    }
    return false;
}

/* Removes a piece of a list: the first with the comma after it, another with the comma before it. */
static void drop_piece(Unused *self, List list, int place) {
    const char *from = place ? list.all[place - 1].end : list.all[0].at;
    const char *to = place || list.count == 1 ? list.all[place].end : list.all[1].at;
    edit_put(&self->edits, from, to, NULL);
}

/* Removes one name from a declaration, or the declaration if it has no other. */
static void drop_declared(Unused *self, const char *statement, List names, int place, const char *end) {
    if (names.count == 1)
        edit_drop(&self->edits, statement, types_statement_end(statement, end));
    else
        drop_piece(self, names, place);
}

static void list_members(Unused *self, const Item *record) {
    const char *c = record->code;
    while (c < record->end && *c != '{') c++;
    for (c++; token_peek(c, record->end).kind == TOKEN_NAME; c = types_statement_end(c, record->end)) {
        Token type;
        List names = types_declared(c, record->end, &type);
        for (int k = 0; k < names.count && self->member_count < MEMBERS_MAX; k++)
            self->members[self->member_count++] =
                (Member){record->name, token_peek(names.all[k].at, names.all[k].end), false};
    }
}

static Member *find_member(Unused *self, Token record, Token name) {
    for (int k = 0; k < self->member_count; k++)
        if (token_same(self->members[k].record, record) && token_same(self->members[k].name, name))
            return &self->members[k];
    return NULL;
}

/* Marks a member that is read. If its record is unknown, all members of that name are marked. */
static void visit_read(void *user, const Access *access) {
    Unused *self = user;
    if (access->statement) return;
    for (int k = 0; k < self->member_count; k++)
        if (token_same(self->members[k].name, access->member) &&
            (access->record.kind != TOKEN_NAME || token_same(self->members[k].record, access->record)))
            self->members[k].read = true;
}

static void visit_stored(void *user, const Access *access) {
    Unused *self = user;
    if (!access->statement || access->record.kind != TOKEN_NAME) return;
    const Member *member = find_member(self, access->record, access->member);
    if (member && !member->read) edit_drop(&self->edits, access->statement, access->statement_end);
}

/* Marks a member as read if a statement that writes to it cannot be removed: the path may lead through another unread
 * member of an unknown record, or the statement does more than write. */
static void visit_unknown(void *user, const Access *access) {
    const Unused *self = user;
    if (access->statement &&
        (access->record.kind != TOKEN_NAME || has_effect(self->items, access->statement, access->statement_end, 1)))
        visit_read(user, &(Access){access->record, access->member, NULL, NULL});
}

static void visit_all(Unused *self, void (*visit)(void *user, const Access *access)) {
    for (int k = 0; k < self->items->count; k++) {
        const Item *item = &self->items->all[k];
        if (item->kept && item->kind == ITEM_FUNCTION) types_accesses(self->items, item, visit, self);
    }
}

/* Marks one member of each record as read, so that no record becomes empty. */
static void keep_one(Unused *self) {
    for (int k = 0, read = 0, first = 0; k < self->member_count; k++) {
        if (!token_same(self->members[k].record, self->members[first].record)) first = k, read = 0;
        read += self->members[k].read;
        bool last =
            k + 1 == self->member_count || !token_same(self->members[k + 1].record, self->members[first].record);
        if (last && !read) self->members[first].read = true;
    }
}

static void drop_members(Unused *self, const Item *record) {
    const char *c = record->code;
    while (c < record->end && *c != '{') c++;
    for (c++; token_peek(c, record->end).kind == TOKEN_NAME; c = types_statement_end(c, record->end)) {
        Token type;
        List names = types_declared(c, record->end, &type);
        int idle = -1, count = 0;
        for (int k = 0; k < names.count; k++) {
            const Member *member = find_member(self, record->name, token_peek(names.all[k].at, names.all[k].end));
            if (!member || member->read) continue;
            idle = k;
            count++;
        }
        c = blank_end(c, record->end);
        if (idle < 0) continue;
        if (count == names.count)
            edit_drop(&self->edits, c, types_statement_end(c, record->end));
        else
            drop_piece(self, names, idle);
    }
}

/* Removes unread members with the statements that write to them, at most one name of each declaration. The others stay
 * until the next pass, without being written to, which does no harm. */
static void cut_members(Unused *self, const char *const *whole) {
    for (int k = 0; k < self->items->count; k++) {
        const Item *item = &self->items->all[k];
        if (item->kept && item->kind == ITEM_RECORD && !is_whole(item->name, whole)) list_members(self, item);
    }
    visit_all(self, visit_read);
    visit_all(self, visit_unknown);
    keep_one(self);
    visit_all(self, visit_stored);
    for (int k = 0; k < self->items->count; k++) {
        const Item *item = &self->items->all[k];
        if (item->kept && item->kind == ITEM_RECORD && !is_whole(item->name, whole)) drop_members(self, item);
    }
}

/* Drops the arguments of a place, or returns true if all of them could be dropped. */
static bool take_arguments(Unused *self, const Item *function, int place, bool drop) {
    for (int k = 0; k < self->items->count; k++) {
        const Item *caller = &self->items->all[k];
        const char *c;
        if (!caller->kept || caller->kind != ITEM_FUNCTION) continue;
        types_parameters(caller, &c);
        for (Token token; (token = token_next(&c, caller->end)).kind != TOKEN_NONE;) {
            if (!token_same(token, function->name) || !token_is(token_peek(c, caller->end), "(")) continue;
            List arguments = list_of(c, caller->end);
            if (place >= arguments.count) continue;
            if (drop)
                drop_piece(self, arguments, place);
            else if (has_effect(self->items, arguments.all[place].at, arguments.all[place].end, 0))
                return false;
        }
    }
    return true;
}

/* Removes at most one unread parameter of each function, since the places of the others then change. */
static void cut_parameters(Unused *self) {
    for (int k = 0; k < self->items->count; k++) {
        const Item *item = &self->items->all[k];
        const char *body;
        if (!item->kept || item->named || item->kind != ITEM_FUNCTION) continue;
        List parameters = types_parameters(item, &body);
        for (int n = 0; n < parameters.count; n++) {
            if (token_found(body, item->end, types_parameter(&parameters, n).name)) continue;
            if (!take_arguments(self, item, n, false)) continue;
            drop_piece(self, parameters, n);
            take_arguments(self, item, n, true);
            break;
        }
    }
}

/* A variable of a function. */
typedef struct Use {
    Token name;
    /* counts after its declaration: of its name, and of statements that only write to it; a declaration with a side
     * effect counts as a name too */
    int named, stored;
} Use;

typedef struct Uses {
    Use all[USES_MAX];
    int count;
} Uses;

static Use *find_use(Uses *uses, Token name) {
    for (int k = 0; k < uses->count; k++)
        if (token_same(uses->all[k].name, name)) return &uses->all[k];
    return NULL;
}

/* A statement that begins here: what it declares, or which variable it writes to. */
typedef struct Statement {
    const char *at;
    Token type;
    List names;         /* names that the statement declares */
    const char *stored; /* behind the path that it writes to, NULL: none */
} Statement;

/* Takes the next token of a body, and the statement that it begins. */
static Token next_token(const char **c, const char *end, Token *before, Statement *statement) {
    const char *at = *c;
    Token token = token_next(c, end);
    *statement = (Statement){.at = at};
    if (token.kind == TOKEN_BLANK) return token;
    if (token.kind == TOKEN_NAME && types_begins(*before)) {
        statement->names = types_declared(at, end, &statement->type);
        statement->stored = types_stored(at, end);
    }
    return token;
}

static void add_uses(const Items *items, const List *names, Uses *out) {
    for (int k = 0; k < names->count && out->count < USES_MAX; k++) {
        Token name = token_peek(names->all[k].at, names->all[k].end);
        Use *use = find_use(out, name);
        if (!use) {
            use = &out->all[out->count++];
            *use = (Use){name, -1, 0};
        }
        use->named += has_effect(items, names->all[k].at, names->all[k].end, 1);
    }
}

static void list_uses(const Items *items, const char *c, const char *end, Uses *out) {
    Token before = {TOKEN_NONE, "", 0}, token;
    Statement statement;
    out->count = 0;
    for (; (token = next_token(&c, end, &before, &statement)).kind != TOKEN_NONE;) {
        if (token.kind == TOKEN_BLANK) continue;
        add_uses(items, &statement.names, out);
        Use *use = token.kind == TOKEN_NAME && !token_is(before, ".") ? find_use(out, token) : NULL;
        if (use) use->named++;
        if (use && statement.stored && !has_effect(items, statement.at, types_statement_end(statement.at, end), 1))
            use->stored++;
        before = token;
    }
}

/* Removes variables that only statements which write to them name, at most one of each declaration. */
static void cut_variables(Unused *self, const Item *function) {
    const char *c, *end = function->end;
    Token before = {TOKEN_NONE, "", 0}, token;
    Statement statement;
    Uses uses;
    types_parameters(function, &c);
    list_uses(self->items, c, end, &uses);
    for (; (token = next_token(&c, end, &before, &statement)).kind != TOKEN_NONE;) {
        if (token.kind == TOKEN_BLANK) continue;
        const Use *use = statement.stored ? find_use(&uses, token) : NULL;
        if (use && use->named == use->stored)
            edit_drop(&self->edits, statement.at, types_statement_end(statement.at, end));
        for (int k = 0; k < statement.names.count; k++) {
            use = find_use(&uses, token_peek(statement.names.all[k].at, statement.names.all[k].end));
            if (!use || use->named > use->stored) continue;
            drop_declared(self, statement.at, statement.names, k, end);
            break;
        }
        before = token;
    }
}

/* Makes of "T x = a; ... x = b;" the declaration "T x = b;" if nothing names x in between. */
static void cut_value(Unused *self, const Statement *declared, const char *end) {
    const char *c = types_statement_end(declared->at, end), *piece = declared->names.all[0].at;
    Token name = token_solid(&piece, declared->names.all[0].end), before = {TOKEN_MARK, ";", 1}, token;
    Statement statement;
    if (!token_is(token_peek(piece, declared->names.all[0].end), "=") ||
        has_effect(self->items, declared->names.all[0].at, declared->names.all[0].end, 1))
        return;
    for (int depth = 0; (token = next_token(&c, end, &before, &statement)).kind != TOKEN_NONE;) {
        if (token.kind == TOKEN_BLANK) continue;
        depth += token_depth(token);
        if (depth < 0) return;
        if (token_same(token, name) && !token_is(before, ".")) {
            if (depth > 0 || statement.stored != c || token_found(c, types_statement_end(c, end), name)) return;
            char type[64];
            snprintf(type, sizeof type, "%.*s ", (int)declared->type.size, declared->type.at);
            edit_put(&self->edits, statement.at, statement.at, type);
            edit_drop(&self->edits, declared->at, types_statement_end(declared->at, end));
            return;
        }
        before = token;
    }
}

static void cut_values(Unused *self, const Item *function) {
    const char *c;
    Token before = {TOKEN_NONE, "", 0}, token;
    Statement statement;
    types_parameters(function, &c);
    for (; (token = next_token(&c, function->end, &before, &statement)).kind != TOKEN_NONE;) {
        if (token.kind == TOKEN_BLANK) continue;
        if (statement.names.count == 1) cut_value(self, &statement, function->end);
        before = token;
    }
}

/* Removes calls of functions that have no effect any more. */
static void cut_calls(Unused *self, const Item *function) {
    const char *c;
    Token before = {TOKEN_NONE, "", 0}, token;
    types_parameters(function, &c);
    for (const char *at = c; (token = token_next(&c, function->end)).kind != TOKEN_NONE; at = c) {
        if (token.kind == TOKEN_BLANK) continue;
        const Item *called = token.kind == TOKEN_NAME && types_begins(before) ? items_find(self->items, token) : NULL;
        before = token;
        if (!called || called->kind != ITEM_FUNCTION) continue;
        const char *body;
        types_parameters(called, &body);
        const char *stop = types_statement_end(at, function->end);
        if (blank_end(body + 1, called->end) == called->end - 1 && !has_effect(self->items, c, stop, 0))
            edit_drop(&self->edits, at, stop);
    }
}

static void cut_function(Unused *self, const Item *function) {
    cut_variables(self, function);
    cut_values(self, function);
    cut_calls(self, function);
}

bool unused_cut(const Items *items, const char *text, const char *const *whole, Buffer *out) {
    Unused self = {.items = items};
    cut_members(&self, whole);
    cut_parameters(&self);
    for (int k = 0; k < items->count; k++)
        if (items->all[k].kept && items->all[k].kind == ITEM_FUNCTION) cut_function(&self, &items->all[k]);
    return edits_apply(&self.edits, text, out);
}
