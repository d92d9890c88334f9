#include "cli/console/two_columns.h"

#include <string.h>

enum { LINE_WIDTH = 80 };

void layout_entry(FILE *stream, int column, const char *name, const char *text) {
    int at = fprintf(stream, "  %s", name), fresh = 1;
    while (*text) {
        int word = (int)strcspn(text, " ");
        if (fresh ? at + 2 > column : at + 1 + word > LINE_WIDTH) {
            fputc('\n', stream);
            at = 0;
            fresh = 1;
        }
        at += fresh ? fprintf(stream, "%*s", column - at, "") : fprintf(stream, " ");
        at += fprintf(stream, "%.*s", word, text);
        fresh = 0;
        text += word + (text[word] == ' ');
    }
    fputc('\n', stream);
}
