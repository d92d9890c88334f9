#include "text/source/layout.h"

#include <stdio.h>

#include "text/source/token.h"

/* Returns true if a blank line at this place would follow another one or an opening brace. */
static bool blank_is_enough(const Buffer *out, size_t line) {
    return out->bytes && line > 1 && (out->bytes[line - 2] == '\n' || out->bytes[line - 2] == '{');
}

/* Returns true if c is in a directive or in a continuation line of one. */
static bool in_directive(const char *source, const char *c) {
    for (;;) {
        const char *line = c;
        while (line > source && line[-1] != '\n') line--;
        const char *first = line;
        while (first < c && is_blank(*first)) first++;
        if (*first == '#') return true;
        if (line - source < 2 || line[-2] != '\\') return false;
        c = line - 1;
    }
}

void layout_strip(const char *source, const char *end, bool keep, Buffer *out) {
    size_t line = out->size; /* where the line being written starts */
    bool had_comment = false;
    for (const char *c = source; c < end;) {
        const char *next = c + 1;
        if (*c == '"') {
            next = string_end(c, end);
        } else if (keep && is_comment(c, end) && !in_directive(source, c)) {
            next = comment_end(c, end);
            for (const char *k = c; k < next; k++) out->origin.line += *k == '\n';
        } else if (*c == '/' && next < end && (*next == '*' || *next == '/')) {
            bool block = *next == '*';
            for (next = c + 2;
                 next < end && (block ? next[-1] != '/' || next[-2] != '*' || next < c + 4 : *next != '\n');)
                out->origin.line += *next++ == '\n';
            had_comment = true;
            buffer_put(out, " ", 1);
            c = next;
            continue;
        } else if (*c == '\r') {
            c = next;
            continue;
        } else if (*c == '\n') {
            size_t solid = out->size;
            while (solid > line && is_blank(out->bytes[solid - 1])) solid--;
            bool drop = solid == line && (had_comment || blank_is_enough(out, line));
            had_comment = false;
            if (out->bytes) out->size = solid;
            if (!drop) buffer_put(out, "\n", 1);
            out->origin.line++;
            line = out->size;
            c = next;
            continue;
        }
        buffer_put(out, c, (size_t)(next - c));
        c = next;
    }
}

/* Returns the end of the declaration or function at c: the brace that closes it or, for a record or a block of
 * uniforms, the semicolon after that. */
static const char *item_end(const char *c, const char *end) {
    const char *first = c;
    Token keyword = token_next(&first, end);
    bool record = token_is(keyword, "struct") || token_is(keyword, "typedef") || token_is(keyword, "enum") ||
                  token_is(keyword, "layout");
    int depth = 0;
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;) {
        if (token_is(token, "{")) depth++;
        if (token_is(token, "}") && --depth == 0 && !record) return c;
        if (token_is(token, ";") && depth == 0) return c;
    }
    return end;
}

/* Appends [c, end) with every run of blanks as one space, none at either end. */
static void put_words(const char *c, const char *end, Buffer *out) {
    bool first = true, blank = false;
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;) {
        if (token.kind == TOKEN_BLANK) {
            blank = true;
            continue;
        }
        if (blank && !first) buffer_put(out, " ", 1);
        buffer_put(out, token.at, token.size);
        first = blank = false;
    }
}

static const char *find_mark(const char *c, const char *end, const char *marks) {
    while (c < end && !strchr(marks, *c)) c++;
    return c;
}

static bool has_words(const char *c, const char *end) { return token_solid(&c, end).kind != TOKEN_NONE; }

/* Sets the origin of the text that follows: the first word at or after c. */
static void set_origin(const Buffer *source, const char *c, Buffer *out) {
    const char *end = source->bytes + source->size;
    while (c < end && is_blank(*c)) c++;
    out->origin = buffer_origin(source, (size_t)(c - source->bytes));
}

/* Writes "struct Name { members };", with a line a member if there are several. */
static void put_record(const Buffer *source, const char *c, const char *end, Buffer *out) {
    const char *open = find_mark(c, end, "{"), *close = end;
    while (close > open && *close != '}') close--;
    int count = 0;
    for (const char *m = open; m < close; m++) count += *m == ';';
    put_words(c, open, out);
    buffer_put_text(out, count > 1 ? " {\n" : " { ");
    for (const char *m = open + 1; m < close;) {
        const char *stop = find_mark(m, close, ";");
        if (has_words(m, stop)) {
            set_origin(source, m, out);
            if (count > 1) buffer_put_text(out, "    ");
            put_words(m, stop, out);
            buffer_put_text(out, count > 1 ? ";\n" : "; ");
        }
        m = stop + 1;
    }
    set_origin(source, close, out);
    buffer_put_text(out, "};");
}

static bool has_comment(const char *c, const char *end) {
    while (c < end && !is_comment(c, end)) c++;
    return c < end;
}

/* Writes enum { A, B = 4, C } as constants, since GLSL has no enumerations. */
static void put_enumeration(const Buffer *source, const char *c, const char *end, Buffer *out) {
    const char *m = find_mark(c, end, "{") + 1, *close = find_mark(m, end, "}");
    char last[64] = "";
    bool first = true;
    for (int value = 0; m < close; value++) {
        const char *stop = find_mark(m, close, ",");
        const char *cursor = m;
        Token name = token_solid(&cursor, stop);
        if (name.kind == TOKEN_NONE) break;
        set_origin(source, name.at, out);
        buffer_put_text(out, first ? "const int " : "\nconst int ");
        first = false;
        buffer_put(out, name.at, name.size);
        buffer_put_text(out, " = ");
        char number[96];
        if (token_is(token_solid(&cursor, stop), "=")) {
            put_words(cursor, stop, out);
            snprintf(last, sizeof last, "%.*s", (int)name.size, name.at);
            value = 0;
        } else {
            if (*last)
                snprintf(number, sizeof number, "%s + %d", last, value);
            else
                snprintf(number, sizeof number, "%d", value);
            buffer_put_text(out, number);
        }
        buffer_put_text(out, ";");
        m = stop + 1;
    }
}

/* Returns a construct that GLSL lacks, found before a driver fails on it, or NULL. */
static const char *wrong_in(const Buffer *source, const char *c, const char *end, Buffer *out) {
    for (Token token; (token = token_next(&c, end)).kind != TOKEN_NONE;) {
        set_origin(source, token.at, out);
        if (token.kind == TOKEN_STRING) return "a string";
        if (token_is(token, "#") || token_is(token, "##")) return "a # that no directive has";
        if (token_is(token, "\\")) return "a joined line";
    }
    return NULL;
}

/* Writes the text without blanks at line ends. */
static void put_trimmed(const Buffer *source, const char *c, const char *end, Buffer *out) {
    while (c < end) {
        const char *stop = find_mark(c, end, "\n"), *solid = stop;
        while (solid > c && is_blank(solid[-1])) solid--;
        set_origin(source, c, out);
        buffer_put(out, c, (size_t)(solid - c));
        if (stop < end) buffer_put(out, "\n", 1);
        c = stop + 1;
    }
}

const char *layout_put(const Buffer *source, bool *gap, Buffer *out) {
    const char *end = source->bytes + source->size;
    for (const char *c = source->bytes; c < end;) {
        int newlines = 0;
        for (; c < end && (is_blank(*c) || *c == ';'); c++) newlines += *c == '\n';
        if (!has_words(c, end)) break;
        const char *comment = c;
        c = blank_end(c, end);
        const char *stop = item_end(c, end), *cursor = c;
        const char *wrong = wrong_in(source, c, stop, out);
        if (wrong) return wrong;
        set_origin(source, comment, out);
        Token keyword = token_next(&cursor, stop), second = token_solid(&cursor, stop);
        bool type = token_is(keyword, "typedef"), record = token_is(keyword, "struct");
        bool enumeration = token_is(keyword, "enum") || (type && token_is(second, "enum"));
        if (type && token_is(second, "struct")) return "a record not made with STRUCT";
        if (type && !enumeration) { /* its name has become the type it stands for */
            c = stop;
            continue;
        }
        if ((*gap || newlines > 1) && out->size) buffer_put(out, "\n", 1);
        *gap = false;
        put_trimmed(source, comment, c, out);
        set_origin(source, c, out);
        if (record && !has_comment(c, stop))
            put_record(source, c, stop - 1, out);
        else if (enumeration)
            put_enumeration(source, c, stop, out);
        else
            put_trimmed(source, c, stop, out);
        buffer_put(out, "\n", 1);
        c = stop;
    }
    return NULL;
}
