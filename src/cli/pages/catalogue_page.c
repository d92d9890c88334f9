#include "cli/pages/catalogue_page.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "weft/lobe.h"

/* Returns the text of the file of an id, or of the id that it is a variant of: schlick-f90 is in f_schlick.h. */
static const char *file_text(const char *prefix, const char *id) {
    char name[64], path[96];
    snprintf(name, sizeof name, "%s", id);
    for (char *c = name; *c; c++)
        if (*c == '-') *c = '_';
    for (char *end; name[0]; *end = '\0') {
        snprintf(path, sizeof path, "%s%s.h", prefix, name);
        const char *text = weft_catalogue_text(path);
        if (text || !(end = strrchr(name, '_'))) return text;
    }
    return NULL;
}

char *page_text(const Kind *kind, const char *id) {
    const char *text = kind->file ? file_text(kind->file, id) : NULL, *end = text ? strstr(text, "*/") : NULL;
    char *page = end ? malloc((size_t)(end - text) + 2) : NULL, *to = page;
    for (const char *line = text; page && line < end;) {
        size_t length = strcspn(line, "\n");
        if (line + length > end) length = (size_t)(end - line);
        const char *next = line + length + 1;
        size_t mark = length < 3 ? length : 3; /* "/" "* " and " * " */
        memcpy(to, line + mark, length - mark);
        for (to += length - mark; to > page && to[-1] == ' ';) to--;
        *to++ = '\n';
        line = next;
    }
    if (page) *to = '\0';
    return page;
}
