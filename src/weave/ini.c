#include "weave/ini.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/fail.h"
#include "base/mark.h"
#include "base/memory.h"

/* Removes blanks from both ends of the string that ends at `end`; returns its start. */
static char *trim(char *text, char *end) {
    while (end > text && strchr(" \t", end[-1])) end--;
    *end = '\0';
    return text + strspn(text, " \t");
}

bool ini_add(Ini *ini, IniLine line) {
    if ((ini->count & (ini->count - 1)) == 0) { /* full at each power of two */
        IniLine *grown = realloc_array(ini->lines, ini->count ? 2 * (size_t)ini->count : 1, sizeof *grown);
        if (!grown) return false;
        ini->lines = grown;
    }
    ini->lines[ini->count++] = line;
    return true;
}

/* Parses one line; returns false if memory is short. */
static bool parse_line(Ini *ini, char *line, char *end, const char **section, int number) {
    char *text = trim(line, end);
    if (*text == '\0' || *text == ';') return true;
    char *close = *text == '[' ? strchr(text, ']') : NULL;
    const bool stray = close && memchr(text, '=', (size_t)(close - text));
    if (*text == '[' && !stray) {
        if (!close && !ini->unclosed) ini->unclosed = number;
        *section = trim(text + 1, close ? close : text + strlen(text));
        return true;
    }
    char *equals = stray ? NULL : strchr(text, '='), *stop = text + strlen(text);
    return ini_add(ini, (IniLine){.section = *section,
                                  .value = equals ? trim(equals + 1, stop) : NULL,
                                  .key = trim(text, equals ? equals : stop),
                                  .number = number});
}

WeftResult ini_read(const void *data, size_t size, const char *name, Ini *out, WeftError *error) {
    *out = (Ini){.name = name, .text = alloc_array(size + 1, 1)};
    if (!out->text) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    memcpy(out->text, data, size);
    if (memchr(out->text, '\0', size))
        return fail(error, WEFT_MESSAGE_DRAFT, name, "it has zero bytes: it is not text");
    const char *section = "";
    char *line = out->text + mark_size(data, size);
    for (int number = 1; *line; number++) {
        char *end = line + strcspn(line, "\r\n");
        char *next = end + (*end == '\r' && end[1] == '\n') + (*end != '\0');
        if (!parse_line(out, line, end, &section, number)) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
        line = next;
    }
    return WEFT_OK;
}

void ini_free(Ini *ini) {
    free(ini->text);
    free(ini->lines);
    *ini = (Ini){0};
}

const IniLine *ini_find(const Ini *ini, const char *section, const char *key) {
    for (int k = ini->count - 1; k >= 0; k--)
        if (strcasecmp(ini->lines[k].section, section) == 0 && (!key || strcasecmp(ini->lines[k].key, key) == 0))
            return &ini->lines[k];
    return NULL;
}

long ini_index(const IniLine *line) {
    char *end;
    if (line->key[0] < '0' || line->key[0] > '9') return 0;
    const long index = strtol(line->key, &end, 10);
    return *end ? 0 : index;
}
