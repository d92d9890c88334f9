#include "cli/files/table_file.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cli/console/decimal.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/files/dds.h"

static const float *texel_at(const WeftImage *table, int x, int y) {
    return (const float *)table->pixels + ((size_t)y * (size_t)table->width + (size_t)x) * (size_t)table->channels;
}

/* "table_NAME": a C identifier from the name of a file without folder and suffix. */
enum { NAME = 64 };
static void name_of(const char *path, char name[NAME]) {
    const char *slash = strrchr(path, '/'), *from = slash ? slash + 1 : path, *dot = strrchr(from, '.');
    int used = snprintf(name, NAME, "table_");
    for (; from != dot && *from && used + 1 < NAME; from++) name[used++] = isalnum((unsigned char)*from) ? *from : '_';
    name[used] = '\0';
}

/* Writes value as a float literal of C. */
static void literal_write(FILE *stream, float value) {
    char text[DECIMAL_SIZE + 4], *end = decimal_write(text, value);
    *end = '\0';
    if (!strpbrk(text, ".e")) memcpy(end, ".0", sizeof ".0");
    fprintf(stream, "%sf", text);
}

/* Writes the table as an array in C. The command stands in a // comment, since it may contain what ends the other
 * kind. */
static void array_write(FILE *stream, const TableFile *file, const char *path) {
    enum { A_LINE = 6 };
    const WeftImage *table = file->table;
    char name[NAME], guard[NAME];
    name_of(path, name);
    snprintf(guard, sizeof guard, "%s", name);
    for (char *c = guard; *c; c++) *c = (char)toupper((unsigned char)*c);
    fprintf(stream, "// %s\n/* %s\n * Row after row, %d x %d texels, each %d value%s. */\n", file->command, file->about,
            table->width, table->height, table->channels, table->channels > 1 ? "s" : "");
    fprintf(stream, "#ifndef WEFT_%s_H\n#define WEFT_%s_H\n\n", guard, guard);
    fprintf(stream, "enum { %s_width = %d, %s_height = %d, %s_channels = %d };\n\n", name, table->width, name,
            table->height, name, table->channels);
    fprintf(stream, "static const float %s[%d * %d * %d] = {", name, table->height, table->width, table->channels);
    const size_t count = (size_t)table->width * (size_t)table->height * (size_t)table->channels;
    for (size_t n = 0; n < count; n++) {
        fputs(n % A_LINE ? " " : "\n    ", stream);
        literal_write(stream, ((const float *)table->pixels)[n]);
        if (n + 1 < count) fputc(',', stream);
    }
    fprintf(stream, "\n};\n\n#endif\n");
}

/* Writes each row of the table as a line, with the channels of a texel side by side. */
static void rows_write(FILE *stream, const TableFile *file, char separator) {
    const WeftImage *table = file->table;
    fprintf(stream, "# %s\n# %s; %d x %d texels, each %d value%s\n", file->command, file->about, table->width,
            table->height, table->channels, table->channels > 1 ? "s" : "");
    for (int y = 0; y < table->height; y++)
        for (int n = 0; n < table->width * table->channels; n++) {
            char text[DECIMAL_SIZE + 2], *end = decimal_write(text, texel_at(table, 0, y)[n]);
            *end++ = n + 1 < table->width * table->channels ? separator : '\n';
            fwrite(text, 1, (size_t)(end - text), stream);
        }
}

static int text_write(const TableFile *file, const char *path) {
    const char *suffix = strrchr(path, '.');
    Output output;
    int result = output_begin(&output, path);
    if (result != 0) return result;
    if (strcasecmp(suffix, ".h") == 0)
        array_write(output.stream, file, path);
    else
        rows_write(output.stream, file, strcasecmp(suffix, ".csv") == 0 ? ',' : ' ');
    return output_end(&output);
}

static int image_channels(const WeftImage *table) { return table->channels == 2 ? 3 : table->channels; }

static int written(const char *path, const WeftImage *image, const TableFile *file, const char *comment) {
    WeftError error;
    const WeftImageWriting how = {.data = 1, .single = !file->half, .comment = comment};
    return weft_image_write_as(path, image, &how, &error) == WEFT_OK ? 0 : report_error(&error);
}

static int float_write(const TableFile *file, const char *path, bool widen) {
    const WeftImage *table = file->table;
    const int channels = widen ? image_channels(table) : table->channels;
    WeftImage image;
    WeftError error;
    if (weft_image_create(table->width, table->height, channels, WEFT_PIXEL_F32, &image, &error) != WEFT_OK)
        return report_error(&error);
    float *to = image.pixels;
    for (int y = 0; y < table->height; y++)
        for (int x = 0; x < table->width; x++, to += channels)
            memcpy(to, texel_at(table, x, y), (size_t)table->channels * sizeof *to);
    int result = written(path, &image, file, file->command);
    weft_image_free(&image);
    return result;
}

static double scale_for(float high) {
    int exponent;
    return high > 1.0f ? ldexp(1.0, (frexpf(high, &exponent) > 0.5f ? exponent : exponent - 1)) : 1.0;
}

static int png_write(const TableFile *file, const char *path) {
    const WeftImage *table = file->table;
    const double scale = file->scale > 0.0 ? file->scale : scale_for(file->high);
    const int channels = image_channels(table);
    if (file->low < 0.0f || (double)file->high > scale)
        return report(WEFT_USAGE, "%s: holds 0 to %g, and the table %g to %g; give another --scale, or write .exr",
                      path, scale, (double)file->low, (double)file->high);
    WeftImage image;
    WeftError error;
    if (weft_image_create(table->width, table->height, channels, WEFT_PIXEL_U16, &image, &error) != WEFT_OK)
        return report_error(&error);
    uint16_t *to = image.pixels;
    for (int y = 0; y < table->height; y++)
        for (int x = 0; x < table->width; x++, to += channels)
            for (int c = 0; c < table->channels; c++)
                to[c] = (uint16_t)((double)texel_at(table, x, y)[c] / scale * 65535.0 + 0.5);
    const size_t capacity = strlen(file->command) + 64;
    char *comment = malloc(capacity);
    int result = comment ? 0 : report(WEFT_RESOURCES, "out of memory");
    if (comment) {
        snprintf(comment, capacity, "%s; value = pixel * %g", file->command, scale);
        result = written(path, &image, file, comment);
    }
    if (result == 0 && (scale < 1.0 || scale > 1.0))
        report(0, "%s: holds the table / %g, whose values go up to %.4g", path, scale, (double)file->high);
    free(comment);
    weft_image_free(&image);
    return result;
}

static int exr_write(const TableFile *file, const char *path) {
    const float most = 65504.0f;
    if (file->half && (file->high > most || file->low < -most))
        return report(WEFT_USAGE, "%s: 16 bit floats end at %g, the table at %g; leave --half out", path, (double)most,
                      (double)(file->high > most ? file->high : file->low));
    return float_write(file, path, true);
}

static int npy_write(const TableFile *file, const char *path) { return float_write(file, path, false); }

/* Writes a DDS file. DDS has no format with three channels, so a fourth is added, which is 0. */
static int dds_file_write(const TableFile *file, const char *path) {
    const WeftImage *table = file->table;
    const int channels = table->channels == 3 ? 4 : table->channels;
    WeftImage image;
    WeftError error;
    Output output;
    if (weft_image_create(table->width, table->height, channels, WEFT_PIXEL_F32, &image, &error) != WEFT_OK)
        return report_error(&error);
    float *to = image.pixels;
    for (int y = 0; y < table->height; y++)
        for (int x = 0; x < table->width; x++, to += channels)
            memcpy(to, texel_at(table, x, y), (size_t)table->channels * sizeof *to);
    int result = output_begin(&output, path);
    if (result == 0) {
        dds_write(output.stream, &image);
        result = output_end(&output);
    }
    weft_image_free(&image);
    return result;
}

static const struct {
    const char *suffix;
    int (*write)(const TableFile *file, const char *path);
} writers[] = {{".h", text_write},  {".png", png_write},  {".exr", exr_write}, {".dds", dds_file_write},
               {".npy", npy_write}, {".csv", text_write}, {".txt", text_write}};
enum { WRITERS = sizeof writers / sizeof writers[0] };

static int writer_find(const char *path) {
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *suffix = strrchr(name, '.');
    for (int k = 0; suffix && suffix != name && k < WRITERS; k++)
        if (strcasecmp(suffix, writers[k].suffix) == 0) return k;
    return -1;
}

bool table_suffix_check(const char *path) {
    if (writer_find(path) >= 0) return true;
    report(WEFT_USAGE, "%s: is not a table file; write .h .png .exr .dds .npy .csv .txt", path);
    return false;
}

int table_write(const TableFile *file, const char *path) { return writers[writer_find(path)].write(file, path); }
