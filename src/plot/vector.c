#include "plot/vector.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "plot/type.h"

bool vector_append(Vector *vector, const void *bytes, size_t count) {
    if (vector->broken) return false;
    if (!vector->text || vector->capacity - vector->size < count + 1) {
        size_t capacity = 2 * (vector->capacity + count) + 4096;
        char *more = realloc_array(vector->text, capacity, 1);
        vector->broken = !more;
        if (!more) return false;
        vector->text = more;
        vector->capacity = capacity;
    }
    memcpy(vector->text + vector->size, bytes, count);
    vector->size += count;
    vector->text[vector->size] = '\0';
    return true;
}

bool vector_print(Vector *vector, const char *format, ...) {
    char line[1024];
    va_list arguments;
    va_start(arguments, format);
    int count = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    return vector_append(vector, line, count < (int)sizeof line ? (size_t)count : sizeof line - 1);
}

bool vector_escaped(Vector *vector, const char *text) {
    char line[TEXT_SIZE];
    drawable(text, line);
    for (const char *s = line; *s; s++) {
        const char *entity = *s == '<'    ? "&lt;"
                             : *s == '>'  ? "&gt;"
                             : *s == '&'  ? "&amp;"
                             : *s == '"'  ? "&quot;"
                             : *s == '\'' ? "&#39;"
                                          : NULL;
        if (!(entity ? vector_append(vector, entity, strlen(entity)) : vector_append(vector, s, 1))) return false;
    }
    return true;
}

/* The names of an SVG in the order of appearance, which is their new number. */
typedef struct Names {
    char seen[256][24];
    int count;
} Names;

static int names_number(Names *names, const char *name, size_t length) {
    for (int k = 0; k < names->count; k++)
        if (strlen(names->seen[k]) == length && strncmp(names->seen[k], name, length) == 0) return k + 1;
    if (names->count == 256 || length >= sizeof names->seen[0]) return 0;
    memcpy(names->seen[names->count], name, length);
    names->seen[names->count][length] = '\0';
    return ++names->count;
}

/* Returns the length of a name that Cairo numbered, such as "surface17" or "image4", and sets *word to that of the
 * word; returns 0 if text does not begin with one. */
static size_t numbered(const char *text, size_t *word) {
    static const char *const words[] = {"surface", "image", "mask", "clip", "pattern", "source"};
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
        size_t length = strlen(words[k]), digits = 0;
        if (strncmp(text, words[k], length) != 0) continue;
        while (isdigit((unsigned char)text[length + digits])) digits++;
        if (!digits) continue;
        *word = length;
        return length + digits;
    }
    return 0;
}

bool vector_finish_svg(Vector *svg, const char *title) {
    Vector out = {0};
    Names names = {.count = 0};
    bool titled = false;
    for (const char *s = svg->text; *s && !out.broken;) {
        size_t word, length = (*s == '"' || *s == '#') ? numbered(s + 1, &word) : 0;
        int number = length ? names_number(&names, s + 1, length) : 0;
        if (number) {
            vector_append(&out, s, 1 + word);
            vector_print(&out, "%d", number);
            s += 1 + length;
            continue;
        }
        vector_append(&out, s, 1);
        if (!titled && *s == '>' && strstr(svg->text, "<svg") && s > strstr(svg->text, "<svg")) {
            vector_append(&out, "\n<title>", 8);
            vector_escaped(&out, title);
            vector_append(&out, "</title>", 8);
            titled = true;
        }
        s++;
    }
    free(svg->text);
    *svg = out;
    return !out.broken;
}
