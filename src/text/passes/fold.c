#include "text/passes/fold.h"

#include <stdio.h>
#include <stdlib.h>

#include "text/source/token.h"

enum { LOCALS_MAX = 16, CONSTANTS_MAX = 512, PATH_SIZE = 64 };

typedef struct Value {
    bool constant;
    long value;
} Value;

typedef struct Name {
    Token name;
    Value value;
} Name;

typedef struct Fold {
    const FoldFact *facts;
    int fact_count;
    Name constants[CONSTANTS_MAX];
    int constant_count;
    Name locals[LOCALS_MAX]; /* of the function being read */
    int local_count;
} Fold;

static const Value VARIABLE = {false, 0};

static Value constant_value(long value) { return (Value){true, value}; }

static const Name *find_name(const Name *names, int count, Token name) {
    for (int k = 0; k < count; k++)
        if (token_same(names[k].name, name)) return &names[k];
    return NULL;
}

/* Returns the value of a path such as "m.layer", which begins with `first`. */
static Value find_path(const Fold *fold, Token first, const char *end) {
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%.*s", (int)(end - first.at), first.at);
    for (int k = 0; k < fold->fact_count; k++)
        if (strcmp(fold->facts[k].path, path) == 0) return constant_value(fold->facts[k].value);
    if ((size_t)(end - first.at) != first.size) return VARIABLE;
    const Name *name = find_name(fold->locals, fold->local_count, first);
    if (!name) name = find_name(fold->constants, fold->constant_count, first);
    return name ? name->value : VARIABLE;
}

static bool take(const char **cursor, const char *end, const char *mark) {
    const char *c = *cursor;
    for (; *mark; mark++) {
        Token token = token_solid(&c, end);
        if (token.size != 1 || *token.at != *mark) return false;
    }
    *cursor = c;
    return true;
}

static Value read_or(const Fold *fold, const char **c, const char *end);

static Value read_name(const Fold *fold, Token first, const char **c, const char *end) {
    if (token_is(first, "true") || token_is(first, "false")) return constant_value(first.size == 4);
    const char *stop = first.at + first.size;
    while (stop < end && *stop == '.') {
        *c = stop + 1;
        stop += 1 + token_next(c, end).size;
    }
    Token next = token_peek(*c, end);
    if (!token_is(next, "(") && !token_is(next, "[")) return find_path(fold, first, stop);
    *c = token_closed(next.at, end);
    return VARIABLE;
}

static Value read_one(const Fold *fold, const char **c, const char *end) {
    Token token = token_solid(c, end);
    if (token_is(token, "!")) {
        Value v = read_one(fold, c, end);
        return v.constant ? constant_value(!v.value) : v;
    }
    if (token_is(token, "-")) {
        Value v = read_one(fold, c, end);
        return v.constant ? constant_value(-v.value) : v;
    }
    if (token_is(token, "(")) {
        Value v = read_or(fold, c, end);
        if (!take(c, end, ")")) *c = end;
        return v;
    }
    if (token.kind == TOKEN_NUMBER) {
        for (size_t k = 0; k < token.size; k++)
            if (!is_digit(token.at[k])) return VARIABLE;
        return constant_value(strtol(token.at, NULL, 10));
    }
    return token.kind == TOKEN_NAME ? read_name(fold, token, c, end) : VARIABLE;
}

/* Reads a sum. Its value is constant only if it is a single operand. */
static Value read_sum(const Fold *fold, const char **c, const char *end) {
    Value v = read_one(fold, c, end);
    for (;;) {
        if (!take(c, end, "+") && !take(c, end, "-") && !take(c, end, "*") && !take(c, end, "/")) return v;
        read_one(fold, c, end);
        v = VARIABLE;
    }
}

static Value read_compared(const Fold *fold, const char **c, const char *end) {
    static const char *const marks[] = {"==", "!=", "<=", ">=", "<", ">"};
    Value a = read_sum(fold, c, end);
    for (int k = 0; k < 6; k++) {
        if (!take(c, end, marks[k])) continue;
        Value b = read_sum(fold, c, end);
        if (!a.constant || !b.constant) return VARIABLE;
        const bool answers[] = {a.value == b.value, a.value != b.value, a.value <= b.value, a.value >= b.value,
                                a.value<b.value, a.value> b.value};
        return constant_value(answers[k]);
    }
    return a;
}

static Value read_and(const Fold *fold, const char **c, const char *end) {
    Value all = read_compared(fold, c, end);
    while (take(c, end, "&&")) {
        Value v = read_compared(fold, c, end);
        if ((all.constant && !all.value) || (v.constant && !v.value))
            all = constant_value(0);
        else
            all = all.constant && v.constant ? constant_value(1) : VARIABLE;
    }
    return all;
}

static Value read_or(const Fold *fold, const char **c, const char *end) {
    Value any = read_and(fold, c, end);
    while (take(c, end, "||")) {
        Value v = read_and(fold, c, end);
        if ((any.constant && any.value) || (v.constant && v.value))
            any = constant_value(1);
        else
            any = any.constant && v.constant ? constant_value(0) : VARIABLE;
    }
    return any;
}

/* Returns the value of the expression [c, end). */
static Value read_all(const Fold *fold, const char *c, const char *end) {
    Value v = read_or(fold, &c, end);
    return blank_end(c, end) == end ? v : VARIABLE;
}

/* Returns the end of the statement at c, with all its branches. */
static const char *statement_end(const char *c, const char *end) {
    const char *cursor = c;
    Token first = token_solid(&cursor, end);
    if (token_is(first, "{")) return token_closed(first.at, end);
    if (token_is(first, "if") || token_is(first, "for") || token_is(first, "while")) {
        const char *stop = statement_end(token_closed(token_peek(cursor, end).at, end), end), *next = stop;
        return token_is(first, "if") && token_is(token_solid(&next, end), "else") ? statement_end(next, end) : stop;
    }
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;) {
        if (token_is(token, "(")) c = token_closed(token.at, end);
        if (token_is(token, ";")) return c;
    }
    return end;
}

/* Returns true if a block declares anything: its braces then stay. */
static bool declares(const char *c, const char *end) {
    while (c < end) {
        const char *cursor = c;
        Token type = token_solid(&cursor, end), name = token_solid(&cursor, end);
        if (type.kind == TOKEN_NAME && name.kind == TOKEN_NAME && !token_is(type, "return") && !token_is(type, "else"))
            return true;
        c = statement_end(c, end);
    }
    return false;
}

static void fold_range(Fold *fold, const char *c, const char *end, Buffer *out);

/* Removes the blanks at the end of out if its line has nothing else yet. Returns the place from which to go on. */
static const char *drop_line(const char *c, const char *end, Buffer *out) {
    while (out->size && (out->bytes[out->size - 1] == ' ' || out->bytes[out->size - 1] == '\t')) out->size--;
    if (out->size && out->bytes[out->size - 1] != '\n') return c;
    while (c < end && (*c == ' ' || *c == '\t')) c++;
    return c < end && *c == '\n' ? c + 1 : c;
}

/* Writes a statement; unwrap: a block without its braces, if nothing is declared in it. */
static void put_chosen(Fold *fold, const char *c, const char *end, bool unwrap, Buffer *out) {
    while (c < end && is_blank(*c)) c++;
    if (!unwrap || c == end || *c != '{' || declares(c + 1, end - 1)) {
        fold_range(fold, c, end, out);
        return;
    }
    Buffer inner = {0};
    fold_range(fold, c + 1, end - 1, &inner);
    const char *k = inner.bytes, *stop = k ? k + inner.size : k;
    while (k < stop && is_blank(*k)) k++;
    while (stop > k && is_blank(stop[-1])) stop--;
    while (k < stop) { /* four columns to the left */
        const char *line = memchr(k, '\n', (size_t)(stop - k));
        buffer_put(out, k, (size_t)((line ? line + 1 : stop) - k));
        k = line ? line + 1 : stop;
        for (int column = 0; column < 4 && k < stop && *k == ' '; column++) k++;
    }
    out->failed |= inner.failed;
    buffer_free(&inner);
}

/* Writes those parts of a condition, with && between, that are not constant. */
static void put_condition(Fold *fold, const char *c, const char *end, Buffer *out) {
    const char *part = c;
    bool first = true, whole = true;
    for (const char *k = c; k < end;) { /* || and ?: bind less: left alone */
        Token token = token_next(&k, end);
        if (token_is(token, "(")) k = token_closed(token.at, end);
        whole &= !token_is(token, "|") && !token_is(token, "?");
    }
    for (const char *k = c; whole && part < end;) {
        Token token = token_next(&k, end);
        if (token_is(token, "(")) k = token_closed(token.at, end);
        bool last = token.kind == TOKEN_NONE, cut = token_is(token, "&");
        if (!last && !cut) continue;
        const char *stop = last ? end : token.at;
        if (!read_all(fold, part, stop).constant) {
            while (part < stop && is_blank(*part)) part++;
            while (stop > part && is_blank(stop[-1])) stop--;
            if (!first) buffer_put_text(out, " && ");
            fold_range(fold, part, stop, out);
            first = false;
        }
        if (last) return;
        token_next(&k, end); /* the other & */
        part = k;
    }
    if (!whole) fold_range(fold, c, end, out);
}

/* Writes the branch that the if at c chooses, if its condition is constant. Returns the place from which to go on. */
static const char *fold_if(Fold *fold, const char *c, const char *end, bool unwrap, bool *done, Buffer *out) {
    const char *open = token_peek(c, end).at, *close = token_closed(open, end);
    Value v = read_all(fold, open + 1, close - 1);
    const char *stop = statement_end(close, end), *next = stop, *other = NULL;
    *done = v.constant;
    if (!v.constant) {
        buffer_put_text(out, "if (");
        put_condition(fold, open + 1, close - 1, out);
        buffer_put_text(out, ")");
        return close;
    }
    if (token_is(token_solid(&next, end), "else")) {
        other = next;
        next = statement_end(other, end);
    } else {
        next = stop;
    }
    if (v.value)
        put_chosen(fold, close, stop, unwrap, out);
    else if (other)
        put_chosen(fold, other, next, unwrap, out);
    else
        return drop_line(next, end, out);
    if (!v.value || !unwrap || !token_is(token_peek(close, end), "return")) return next;
    const char *tail = end; /* what follows is never read */
    while (tail > next && is_blank(tail[-1])) tail--;
    buffer_put(out, tail, (size_t)(end - tail));
    return end;
}

/* Writes the branch of "a ? b : c" at c, where an expression begins, if a is constant. Returns the end of it, or c. */
static const char *fold_choice(Fold *fold, const char *c, const char *end, Buffer *out) {
    const char *k = c, *mark = NULL, *colon = NULL, *stop = end;
    int nested = 0;
    while (k < end) {
        Token token = token_next(&k, end);
        if (token_is(token, "(") || token_is(token, "[")) k = token_closed(token.at, end);
        bool over = token_is(token, ";") || token_is(token, ",") || token_is(token, ")") || token_is(token, "}");
        if (token_is(token, "?")) {
            if (!mark)
                mark = token.at;
            else
                nested++;
        } else if (token_is(token, ":") && mark) {
            if (!nested && !colon)
                colon = token.at;
            else
                nested--;
        } else if (over) {
            stop = token.at;
            break;
        } else if (!mark && (token_is(token, "{") || token_is(token, "="))) {
            if (token_is(token, "{")) return c;
        }
    }
    Value v = mark && colon ? read_all(fold, c, mark) : VARIABLE;
    if (!v.constant) return c;
    const char *from = v.value ? mark + 1 : colon + 1, *to = v.value ? colon : stop;
    while (from < to && is_blank(*from)) from++;
    while (to > from && is_blank(to[-1])) to--;
    const char *again = fold_choice(fold, from, to, out);
    if (again == from) fold_range(fold, from, to, out);
    return stop;
}

/* Takes "bool x = a;" with a constant a as a fact. Returns false if it is not one. */
static bool take_local(Fold *fold, Token type, const char **cursor, const char *end) {
    const char *c = *cursor;
    if (!token_is(type, "bool")) return false;
    Token name = token_solid(&c, end);
    if (name.kind != TOKEN_NAME || !take(&c, end, "=")) return false;
    const char *stop = c;
    while (stop < end && *stop != ';' && *stop != ',') stop++;
    Value v = read_all(fold, c, stop);
    if (!v.constant || stop == end || *stop != ';' || fold->local_count == LOCALS_MAX) return false;
    fold->locals[fold->local_count++] = (Name){name, v};
    *cursor = stop + 1;
    return true;
}

static void fold_range(Fold *fold, const char *c, const char *end, Buffer *out) {
    bool begins = true, behind_else = false; /* an expression; an else */
    while (c < end) {
        const char *start = c;
        Token token = token_next(&c, end);
        if (token.kind == TOKEN_BLANK) {
            buffer_put(out, token.at, token.size);
            continue;
        }
        if (token_is(token, "else")) {
            const char *next = c, *open;
            bool is_if = token_is(token_solid(&next, end), "if");
            open = token_peek(next, end).at;
            if (is_if) {
                Value v = read_all(fold, open + 1, token_closed(open, end) - 1);
                const char *stop = statement_end(token_closed(open, end), end);
                if (v.constant && !v.value && !token_is(token_peek(stop, end), "else")) {
                    c = drop_line(stop, end, out);
                    continue;
                }
            }
            buffer_put(out, token.at, token.size);
            behind_else = true;
            continue;
        }
        if (token_is(token, "if")) {
            bool done;
            c = fold_if(fold, c, end, !behind_else, &done, out);
            begins = behind_else = false;
            continue;
        }
        if (take_local(fold, token, &c, end)) {
            c = drop_line(c, end, out);
            continue;
        }
        if (begins) {
            const char *stop = fold_choice(fold, start, end, out);
            if (stop != start) {
                c = stop;
                begins = false;
                continue;
            }
        }
        buffer_put(out, token.at, token.size);
        behind_else = false;
        begins = token_is(token, "=") || token_is(token, "(") || token_is(token, ",") || token_is(token, "return") ||
                 token_is(token, "?") || token_is(token, ":");
    }
}

/* One of "x = ..., y = ..." in a declaration. */
typedef struct Declared {
    const char *start, *end;
    bool read; /* or its value contains brackets: a call may write to something else, see unused.h */
} Declared;

enum { DECLARED_MAX = 16 };

static bool is_read(Token name, const char *c, const char *end) {
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;)
        if (token.kind == TOKEN_NAME && token_same(token, name)) return true;
    return false;
}

/* Finds the variables that the declaration at c defines, each with a value. Returns their count, 0 if it
 * is no such declaration. *stop is set behind it. */
static int find_declared(const char *c, const char *end, Declared all[DECLARED_MAX], const char **stop) {
    int count = 0;
    Token type = token_solid(&c, end), mark;
    if (type.kind != TOKEN_NAME || token_is(type, "return") || token_is(type, "else")) return 0;
    do {
        Token name = token_solid(&c, end);
        if (name.kind != TOKEN_NAME || !take(&c, end, "=") || count == DECLARED_MAX) return 0;
        bool calls = false;
        do {
            mark = token_next(&c, end);
            calls |= token_is(mark, "(");
            if (token_is(mark, "(")) c = token_closed(mark.at, end);
        } while (mark.kind != TOKEN_NONE && !token_is(mark, ",") && !token_is(mark, ";"));
        all[count++] = (Declared){name.at, mark.at, calls || is_read(name, c, end)};
    } while (token_is(mark, ","));
    *stop = c;
    return count;
}

/* Writes the declaration at c without the variables that are never read. Returns the end of it, or c if all are
 * read. */
static const char *put_declared(const char *c, const char *end, Buffer *out) {
    Declared all[DECLARED_MAX];
    const char *stop = c;
    int count = find_declared(c, end, all, &stop), kept = 0;
    for (int k = 0; k < count; k++) kept += all[k].read;
    if (kept == count) return c;
    if (!kept) return drop_line(stop, end, out);
    buffer_put(out, c, (size_t)(all[0].start - c));
    for (int k = 0, put = 0; k < count; k++) {
        if (!all[k].read) continue;
        if (put++) buffer_put_text(out, ", ");
        buffer_put(out, all[k].start, (size_t)(all[k].end - all[k].start));
    }
    buffer_put(out, ";", 1);
    return stop;
}

static void put_read(const Buffer *body, Buffer *out) {
    const char *c = body->bytes, *end = c ? c + body->size : c;
    bool begins = true;
    while (c < end) {
        Token token = token_next(&c, end);
        if (begins && token.kind == TOKEN_NAME) {
            const char *stop = put_declared(token.at, end, out);
            if (stop != token.at) {
                c = stop;
                continue;
            }
        }
        buffer_put(out, token.at, token.size);
        if (token.kind != TOKEN_BLANK) begins = token_is(token, ";") || token_is(token, "{") || token_is(token, "}");
    }
}

/* Adds the constants of the text: "const int NAME = 3;". */
static void find_constants(Fold *fold, const char *c, const char *end) {
    while (c < end && fold->constant_count < CONSTANTS_MAX) {
        if (!token_is(token_next(&c, end), "const")) continue;
        Token type = token_solid(&c, end), name = token_solid(&c, end);
        if (!token_is(type, "int") || !take(&c, end, "=")) continue;
        const char *stop = c;
        while (stop < end && *stop != ';') stop++;
        Value v = read_all(fold, c, stop);
        if (v.constant) fold->constants[fold->constant_count++] = (Name){name, v};
    }
}

void fold_text(const char *text, const FoldFact *facts, int count, Buffer *out) {
    Fold *fold = calloc(1, sizeof *fold);
    if (!fold) {
        out->failed = true;
        return;
    }
    const char *c = text, *end = text + strlen(text);
    fold->facts = facts;
    fold->fact_count = count;
    find_constants(fold, c, end);
    while (c < end) { /* a function at a time */
        const char *open = c;
        while (open < end && *open != '{') open = is_comment(open, end) ? comment_end(open, end) : open + 1;
        const char *close = open < end ? token_closed(open, end) : end;
        fold->local_count = 0;
        if (open < end) {
            buffer_put(out, c, (size_t)(open + 1 - c));
            Buffer body = {0};
            fold_range(fold, open + 1, close - 1, &body);
            put_read(&body, out);
            out->failed |= body.failed;
            buffer_free(&body);
            buffer_put(out, "}", 1);
        } else {
            buffer_put(out, c, (size_t)(end - c));
        }
        c = close;
    }
    free(fold);
}
