#include "man.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "weft/version.h"

/* Prints text as roff: escapes what roff would read as a request, and keeps hyphens that can be copied. */
static void put(const char *text, size_t length) {
    if (length && (text[0] == '.' || text[0] == '\'')) fputs("\\&", stdout);
    for (size_t k = 0; k < length; k++) {
        if (text[k] == '\\')
            fputs("\\e", stdout);
        else if (text[k] == '-')
            fputs("\\-", stdout);
        else
            putchar(text[k]);
    }
}

static void put_text(const char *text) { put(text, strlen(text)); }

static void put_capitals(const char *text, size_t length) {
    for (size_t k = 0; k < length; k++) putchar(toupper((unsigned char)text[k]));
}

/* Prints the top of a page: its title, version, name and synopsis. */
static void head(const char *verb, const char *help) {
    const char *dash = verb ? "-" : "", *name = verb ? verb : "";
    printf(".TH WEFT%s", dash);
    put_capitals(name, strlen(name));
    printf(" 1 \"\" \"weft %s\" \"weft\"\n.SH NAME\nweft%s%s \\- ", weft_version(), dash, name);
    put_text(help);
    printf("\n.SH SYNOPSIS\n.B weft");
    if (verb) printf(" %s", verb);
    putchar('\n');
}

/* Begins a tagged paragraph: a term with its value, if it has one. The description follows. */
static void item(const char *name, const char *value) {
    printf(".TP\n\\fB");
    put_text(name);
    printf("\\fR");
    if (value) {
        printf(" \\fI");
        put_text(value);
        printf("\\fR");
    }
    putchar('\n');
}

static void option_item(const Option *row) {
    if (!row->name) {
        printf(".SS ");
        put_text(row->help);
        putchar('\n');
        return;
    }
    item(row->name, row->value);
    put_text(row->help);
    if (row->repeats) printf("; may be repeated");
    if (row->def) {
        printf(" [");
        put_text(row->def);
        putchar(']');
    }
    putchar('\n');
}

/* Returns true if the line is a single word: such a line stands above indented ones. */
static bool is_heading(const char *line) {
    size_t length = strcspn(line, "\n");
    return length && line[0] != ' ' && strcspn(line, " ") > length && line[length] && line[length + 1] == ' ';
}

/* Prints one line of the notes of a help text: within a paragraph or, where it is indented, as it is. */
static void note(const char *line, size_t length, bool *as_is) {
    bool indented = length ? line[0] == ' ' : *as_is && line[1] == ' ';
    if (indented != *as_is) puts(indented ? ".EX" : ".EE");
    *as_is = indented;
    if (!length && !indented && line[1] && !is_heading(line + 1) && line[1] != ' ') puts(".PP");
    if (!length && !indented) return;
    if (is_heading(line)) {
        printf(".SH ");
        put_capitals(line, length);
    } else {
        put(line, length);
    }
    putchar('\n');
}

static void notes_items(const char *notes) {
    bool as_is = false;
    if (!is_heading(notes)) puts(".SH NOTES");
    while (*notes) {
        size_t length = strcspn(notes, "\n");
        note(notes, length, &as_is);
        notes += length + (notes[length] == '\n');
    }
    if (as_is) puts(".EE");
}

void man_verb(const Verb *verb) {
    head(verb->name, verb->help);
    put_text(verb->operands);
    printf("\n.SH OPTIONS\n");
    for (const Option *row = verb->options; row->name || row->help; row++) option_item(row);
    item("--help", NULL);
    printf("print this in short\n");
    if (verb->lists) {
        printf(".SH LISTS\n.EX\n.eo\n"); /* without escapes, since the lists are printed as --help prints them */
        fflush(stdout);
        verb->lists();
        printf(".ec\n.EE\n");
    }
    notes_items(verb->notes);
    printf(".SH SEE ALSO\n.BR weft (1)\n");
}

void man_program(const Verb *const *verbs, const ExitCode *codes) {
    head(NULL, "the cloth-shading workbench");
    printf("VERB ...\n.SH VERBS\n");
    for (int k = 0; verbs[k]; k++) {
        item(verbs[k]->name, NULL);
        put_text(verbs[k]->help);
        printf("; see\n.BR weft\\-%s (1)\n", verbs[k]->name);
    }
    item("help", "[VERB]");
    printf("explain a verb\n.SH EXIT STATUS\n");
    for (const ExitCode *code = codes; code->code; code++) {
        item(code->code, NULL);
        put_text(code->words);
        putchar('\n');
    }
}
