#define _POSIX_C_SOURCE 200809L /* fdopen */
#include "cli/files/table_text.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/path.h"
#include "cli/console/decimal.h"
#include "cli/console/report.h"

enum { SIZE_MOST = 1 << 28, BRACKETS = 3 };

/* A file of text while it is read. */
typedef struct TableText {
    const char *path;
    char *text;
    float *values;
    size_t count, capacity;
    long rows;    /* lines of numbers */
    long size[3]; /* rows, columns, channels that the file names; 0: not named */
    long group;   /* numbers in the innermost braces; 0: they differ, or there are none */
} TableText;

static const char *const rows_suffixes[] = {".csv", ".txt", ".tsv", NULL};
static const char *const array_suffixes[] = {".h",    ".hpp",   ".c",    ".cpp",   ".inl", ".inc",
                                             ".glsl", ".glslh", ".hlsl", ".cginc", ".usf", NULL};

static bool ends_in_one(const char *path, const char *const *suffixes) {
    while (*suffixes && !path_ends(path, *suffixes)) suffixes++;
    return *suffixes != NULL;
}

bool table_text_suffix(const char *path) {
    return ends_in_one(path, rows_suffixes) || ends_in_one(path, array_suffixes);
}

/* Reads the file, with a zero byte at its end. */
static int text_read(TableText *self) {
    struct stat about;
    const int handle = open(self->path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC); /* a pipe would wait */
    FILE *stream = handle < 0 ? NULL : fdopen(handle, "rb");
    if (!stream && handle >= 0) close(handle);
    if (!stream) return report(WEFT_INPUT, "%s: cannot be opened: %s", self->path, strerror(errno));
    int result = 0;
    if (fstat(fileno(stream), &about) != 0 || !S_ISREG(about.st_mode) || about.st_size > SIZE_MOST)
        result = report(WEFT_INPUT, "%s: is not a plain file, or is too large", self->path);
    const size_t size = result == 0 ? (size_t)about.st_size : 0;
    self->text = result == 0 ? malloc(size + 1) : NULL;
    if (result == 0 && !self->text) result = report(WEFT_RESOURCES, "out of memory");
    if (self->text && fread(self->text, 1, size, stream) != size)
        result = report(WEFT_INPUT, "%s: cannot be read", self->path);
    if (self->text) self->text[size] = '\0';
    if (result == 0 && self->text && strlen(self->text) != size)
        result = report(WEFT_INPUT, "%s: is not text", self->path);
    fclose(stream);
    return result;
}

static int add_value(TableText *self, double value) {
    if (!isfinite(value)) return report(WEFT_INPUT, "%s: has a number that is not finite", self->path);
    if (self->count == self->capacity) {
        const size_t more = self->capacity ? 2 * self->capacity : 4096;
        float *grown = realloc(self->values, more * sizeof *grown);
        if (!grown) return report(WEFT_RESOURCES, "out of memory");
        self->values = grown;
        self->capacity = more;
    }
    self->values[self->count++] = (float)value;
    return 0;
}

/* Reads a size as "8 x 8 texels, each 3 value", which `weft bake` writes. */
static void size_of_words(const char *text, long size[3]) {
    const char *at = strstr(text, " texels, each ");
    int columns, rows, channels;
    if (!at) return;
    const char *start = at;
    while (start > text && strchr("0123456789 x", start[-1])) start--;
    if (sscanf(start, "%7d x %7d texels, each %1d", &columns, &rows, &channels) != 3) return;
    size[0] = rows;
    size[1] = columns;
    size[2] = channels;
}

/* Reads a size as "--size 8x8" in the command that made the file. */
static void size_of_command(const char *text, long size[3]) {
    int columns, rows;
    const char *at = strstr(text, "--size ");
    if (size[0] || !at || sscanf(at, "--size %7dx%7d", &columns, &rows) != 2) return;
    size[0] = rows;
    size[1] = columns;
}

/* Reads one line of numbers; `line` is its number in the file. */
static int line_read(TableText *self, char *line, long number) {
    const size_t before = self->count;
    while (*(line += strspn(line, " \t\r,;"))) {
        double value;
        const char *end = decimal_read(line, &value);
        if (end == line || !strchr(" \t\r,;", *end)) {
            if (self->count == 0) return 0; /* names above the columns */
            return report(WEFT_INPUT, "%s: line %ld: no number begins at \"%.20s\"", self->path, number, line);
        }
        int result = add_value(self, value);
        if (result != 0) return result;
        line += end - line;
    }
    self->rows += self->count > before;
    if (self->rows > 0 && self->count != (size_t)self->rows * (self->count - before) && self->count > before)
        return report(WEFT_INPUT, "%s: line %ld has %zu numbers, and those before it another number", self->path,
                      number, self->count - before);
    return 0;
}

static int rows_read(TableText *self) {
    char *line = self->text, *end;
    size_of_words(self->text, self->size);
    size_of_command(self->text, self->size);
    int result = 0;
    for (long number = 1; line && result == 0; number++) {
        end = strchr(line, '\n');
        if (end) *end = '\0';
        if (number == 1 && strncmp(line, "\xef\xbb\xbf", 3) == 0) line += 3;
        const char *first = line + strspn(line, " \t\r");
        if (*first && *first != '#' && strncmp(first, "//", 2) != 0) result = line_read(self, line, number);
        line = end ? end + 1 : NULL;
    }
    if (!self->size[0]) self->size[0] = self->rows;
    return result;
}

/* Overwrites the comments of a program by blanks. */
static void blank_comments(char *text) {
    for (char *at = text; (at = strchr(at, '/')) != NULL;) {
        const char *end = at[1] == '*' ? strstr(at + 2, "*/") : at[1] == '/' ? at + strcspn(at, "\n") : NULL;
        if (!end) {
            at++;
            continue;
        }
        for (end += at[1] == '*' ? 2 : 0; at < end; at++)
            if (*at != '\n') *at = ' ';
    }
}

/* Reads the extents in brackets between `at` and `end`, such as [8][8][3], or [8 * 8 * 3]. */
static void size_of_brackets(const char *at, const char *end, long size[3]) {
    int count = 0;
    for (; at < end && count < BRACKETS; at++)
        if (isdigit((unsigned char)*at) && !isalnum((unsigned char)at[-1]) && at[-1] != '_') {
            size[count++] = strtol(at, (char **)&at, 10);
            at--;
        }
    if (count == 1) size[0] = 0; /* a length is no size */
}

/* Returns where the first array of numbers begins, behind its brace, or behind the "(" of GLSL's float[64](...), and
 * reads the size that its brackets say. */
static char *array_find(TableText *self) {
    char *brace = self->text;
    while ((brace = strpbrk(brace, "{(")) != NULL) {
        const char *equals = brace;
        while (equals > self->text && !strchr("=;}{(", equals[-1])) equals--;
        const char *name = equals;
        while (name > self->text && !strchr(";}", name[-1])) name--;
        if (equals > self->text && equals[-1] == '=') {
            const char *bracket = memchr(name, '[', (size_t)(equals - name));
            if (bracket) size_of_brackets(bracket + 1, equals, self->size);
            return brace + 1;
        }
        brace++;
    }
    return NULL;
}

/* Reads the numbers of an array up to its last brace. A name, such as float3, is passed over with its digits. */
static int array_read(TableText *self) {
    long named[3] = {0};
    size_of_words(self->text, named);
    blank_comments(self->text);
    char *at = array_find(self);
    if (!at) return report(WEFT_INPUT, "%s: has no array \"= { ... }\"", self->path);
    if (named[0]) memcpy(self->size, named, sizeof named);
    long inside = 0;
    for (int depth = 1; depth > 0 && *at;) {
        double value;
        const char *end = decimal_read(at, &value);
        if (isalpha((unsigned char)*at) || *at == '_') {
            while (isalnum((unsigned char)*at) || *at == '_') at++;
        } else if (end != at) {
            int result = add_value(self, value);
            if (result != 0) return result;
            at += end - at;
            inside++;
            if (*at == 'f' || *at == 'F' || *at == 'h' || *at == 'H') at++;
        } else {
            if (*at == '{' || *at == '(') inside = 0;
            if ((*at == '}' || *at == ')') && inside) {
                self->group = self->group == 0 || self->group == inside ? inside : -1;
                inside = 0;
            }
            depth += (*at == '{' || *at == '(') - (*at == '}' || *at == ')');
            at++;
        }
    }
    return 0;
}

static bool is_whole(const TableText *self, long rows, long columns, long channels) {
    return rows > 0 && columns > 0 && channels > 0 && channels <= 4 && rows <= 65536 && columns <= 65536 &&
           (size_t)rows * (size_t)columns * (size_t)channels == self->count;
}

/* Finds the size: as it is named; by the length of lines; by the innermost braces; square. Returns false if none
 * fits. */
static bool size_find(TableText *self, bool several, bool *guessed) {
    long *size = self->size;
    const long count = (long)self->count;
    *guessed = false;
    if (size[2] && is_whole(self, size[0], size[1], size[2])) return true;
    if (size[0] && size[1] && count % (size[0] * size[1]) == 0) {
        size[2] = count / (size[0] * size[1]);
        if (is_whole(self, size[0], size[1], size[2])) return true;
    }
    *guessed = true;
    const bool grouped = self->group >= 1 && self->group <= 4;
    for (long channels = several && !grouped ? 2 : 1; channels <= 4; channels++) {
        const long texels = count / channels, side = (long)lround(sqrt((double)texels));
        if ((grouped && channels != self->group) || !is_whole(self, side, side, channels)) continue;
        if (self->rows && side != self->rows) continue;
        size[0] = size[1] = side;
        size[2] = channels;
        return true;
    }
    size[0] = self->rows;
    size[1] = self->rows ? count / self->rows : 0;
    size[2] = 1;
    return is_whole(self, size[0], size[1], 1);
}

/* Hands the values over as a table. */
static int table_make(TableText *self, bool several, WeftImage *table) {
    WeftError error;
    bool guessed;
    if (self->count == 0) return report(WEFT_INPUT, "%s: has no numbers", self->path);
    if (!size_find(self, several, &guessed))
        return report(WEFT_INPUT,
                      "%s: has %zu numbers, and does not say of how many rows and columns: write [ROWS][COLUMNS]",
                      self->path, self->count);
    const int width = (int)self->size[1], height = (int)self->size[0], channels = (int)self->size[2];
    if (guessed)
        report(0, "%s: does not say its size; taken for %d x %d texels of %d channel%s", self->path, width, height,
               channels, channels > 1 ? "s" : "");
    if (weft_image_create(width, height, channels, WEFT_PIXEL_F32, table, &error) != WEFT_OK)
        return report_error(&error);
    memcpy(table->pixels, self->values, self->count * sizeof *self->values);
    return 0;
}

int table_text_read(const char *path, bool several, WeftImage *table) {
    TableText self = {.path = path};
    *table = (WeftImage){0};
    int result = text_read(&self);
    if (result == 0 && self.text) result = ends_in_one(path, array_suffixes) ? array_read(&self) : rows_read(&self);
    if (result == 0) result = table_make(&self, several, table);
    free(self.text);
    free(self.values);
    return result;
}
