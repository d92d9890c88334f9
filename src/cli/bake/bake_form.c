/* bake_form.c - `weft bake albedo LOBE --form polynomial`: E as a short function for shaders that have no sampler to
 * spare */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/path.h"
#include "cli/bake/bake.h"
#include "cli/console/decimal.h"
#include "cli/console/interrupt.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/operands/command.h"

enum { FORMS_MOST = 2, NAME_SIZE = 96 };

/* A language of shaders, which the suffix of a file names; the first is standard output's too. */
typedef struct Dialect {
    const char *suffix, *include, *head, *variable, *literal, *root, *exponential, *least;
} Dialect;

static const Dialect dialects[] = {
    {".glsl", "", "float %s(float cos_o, float roughness) {\n", "float", "", "sqrt", "exp", "max"},
    {".hlsl", "", "float %s(float cos_o, float roughness) {\n", "float", "", "sqrt", "exp", "max"},
    {".metal", "", "inline float %s(float cos_o, float roughness) {\n", "float", "f", "sqrt", "exp", "max"},
    {".wgsl", "", "fn %s(cos_o: f32, roughness: f32) -> f32 {\n", "let", "", "sqrt", "exp", "max"},
    {".h", "#include <math.h>\n\n", "static inline float %s(float cos_o, float roughness) {\n", "float", "f", "sqrtf",
     "expf", "fmaxf"},
};
enum { DIALECTS = sizeof dialects / sizeof *dialects };

typedef struct FormBake {
    const Options *options;
    BakeCommon common;
    WeftLobe lobe;
    double error, lowest;
    int count;
    WeftAlbedoForm forms[FORMS_MOST]; /* of E, or of the parts of f0 and f90 */
    char names[FORMS_MOST][NAME_SIZE];
    char *command;
} FormBake;

static const Dialect *dialect_of(const char *path) {
    for (int k = 0; k < DIALECTS; k++)
        if (path_ends(path, dialects[k].suffix)) return &dialects[k];
    return NULL;
}

static int form_read(const Options *options, FormBake *bake) {
    const char *form = option_text(options, "--form"), *lobe = options->operand_count > 1 ? options->operands[1] : NULL;
    int cursor = 0, result = 0;
    bake->options = options;
    if (strcmp(form, "polynomial") != 0)
        return report(WEFT_USAGE, "--form: \"%.80s\" is not a form of E; there is polynomial", form);
    if (!lobe) return report(WEFT_USAGE, "bake albedo: needs a lobe: weft bake albedo LOBE --form polynomial");
    if (!bake_common(options, &bake->common) || !option_number(options, "--error", &bake->error) ||
        !option_number(options, "--from", &bake->lowest))
        return WEFT_USAGE;
    result = bake_lobe(options, lobe, &bake->lobe);
    for (const char *path; result == 0 && (path = option_next(options, "-o", &cursor));)
        result = dialect_of(path)
                     ? output_probe(path)
                     : report(WEFT_USAGE, "%s: a function is written as .glsl .hlsl .metal .wgsl or .h", path);
    return result;
}

/* Makes a name of a function from that of the lobe, with what follows it. */
static void name_make(const char *id, const char *rest, char *name) {
    snprintf(name, NAME_SIZE, "%.64s_%s", id, rest);
    for (char *c = name; *c; c++)
        if (!isalnum((unsigned char)*c)) *c = '_';
}

static int forms_find(FormBake *bake) {
    const WeftLobeInfo *info = weft_lobe_info(bake->lobe.lobe);
    const bool two = info->traits & WEFT_LOBE_TWO_COLORS;
    int result = 0;
    bake->count = two ? 2 : 1;
    for (int k = 0; k < bake->count && result == 0; k++) {
        WeftError error;
        Progress progress = progress_start_count(bake->common.quiet, "points", 1.0);
        const WeftAlbedoFormDesc desc = {.lobe = &bake->lobe,
                                         .part = !two ? WEFT_TABLE_SUM
                                                 : k  ? WEFT_TABLE_F90
                                                      : WEFT_TABLE_F0,
                                         .error = bake->error,
                                         .lowest = bake->lowest,
                                         .threads = bake->common.threads,
                                         .progress = bake_progress,
                                         .user = &progress};
        const WeftResult found = weft_bake_form(&desc, &bake->forms[k], &error);
        progress_finish(&progress);
        if (found == WEFT_INTERRUPTED) return report(WEFT_INTERRUPTED, "interrupted; nothing was written");
        if (found != WEFT_OK) return report_error(&error);
        name_make(info->id, !two ? "albedo" : k ? "albedo_f90" : "albedo_f0", bake->names[k]);
        if (bake->forms[k].error > bake->error)
            result = report(WEFT_FAILED,
                            "%s: no form of %d terms is within %g; the nearest is off by %.3g at cos_o %.3g, roughness "
                            "%.3g: allow it by --error, or begin higher by --from",
                            info->id, WEFT_FORM_TERMS, bake->error, bake->forms[k].error, (double)bake->forms[k].cos_o,
                            (double)bake->forms[k].roughness);
    }
    return result;
}

static void literal_write(FILE *stream, const Dialect *dialect, float value) {
    char text[DECIMAL_SIZE + 4], *end = decimal_write(text, value);
    *end = '\0';
    if (!strpbrk(text, ".e")) memcpy(end, ".0", sizeof ".0");
    fprintf(stream, "%s%s", text, dialect->literal);
}

/* Writes a polynomial as a + v * (b + v * (c ...)), whose coefficients `write` writes. */
static void nested_write(FILE *stream, const char *variable, int degree,
                         void (*write)(FILE *, const Dialect *, const WeftAlbedoForm *, int), const Dialect *dialect,
                         const WeftAlbedoForm *form, int first) {
    for (int k = 0; k <= degree; k++) {
        write(stream, dialect, form, first + k);
        if (k < degree) fprintf(stream, " + %s * %s", variable, k + 1 < degree ? "(" : "");
    }
    for (int k = 0; k + 1 < degree; k++) fputc(')', stream);
}

static void term_write(FILE *stream, const Dialect *dialect, const WeftAlbedoForm *form, int k) {
    literal_write(stream, dialect, form->terms[k]);
}

/* Writes row j, the polynomial of x that multiplies roughness^j, as a variable of its own. */
static void row_write(FILE *stream, const Dialect *dialect, const WeftAlbedoForm *form, int j) {
    fprintf(stream, "    %s p%d = ", dialect->variable, j);
    nested_write(stream, "x", form->across, term_write, dialect, form, j * (form->across + 1));
    fprintf(stream, ";\n");
}

static void row_name(FILE *stream, const Dialect *dialect, const WeftAlbedoForm *form, int j) {
    (void)dialect;
    (void)form;
    fprintf(stream, "p%d", j);
}

static void function_write(FILE *stream, const Dialect *dialect, const WeftAlbedoForm *form, const char *name) {
    fprintf(stream, dialect->head, name);
    fprintf(stream, "    %s x = ", dialect->variable);
    fprintf(stream, form->root ? "%s(cos_o);\n" : "cos_o;\n", dialect->root);
    for (int j = 0; j <= form->along; j++) row_write(stream, dialect, form, j);
    fprintf(stream, "    return %s(", form->exponential ? dialect->exponential : dialect->least);
    nested_write(stream, "roughness", form->along, row_name, dialect, form, 0);
    if (!form->exponential) fprintf(stream, ", 0.0%s", dialect->literal);
    fprintf(stream, ");\n}\n");
}

static void text_write(FILE *stream, const Dialect *dialect, const FormBake *bake) {
    const char *id = weft_lobe_info(bake->lobe.lobe)->id;
    fprintf(stream, "// %s\n", bake->command);
    if (dialect->include[0]) fprintf(stream, "%s", dialect->include);
    for (int k = 0; k < bake->count; k++) {
        const WeftAlbedoForm *form = &bake->forms[k];
        const char *part = bake->count == 1 ? "E" : k ? "the part of f90 in E" : "the part of f0 in E";
        fprintf(
            stream,
            "%s// %s of the white %s for cos_o from 0 to 1 and roughness from %g to 1, off by at most %.3g (at cos_o "
            "%.3g, roughness %.3g)\n",
            k ? "\n" : "", part, id, bake->lowest, form->error, (double)form->cos_o, (double)form->roughness);
        function_write(stream, dialect, form, bake->names[k]);
    }
}

static int form_write(const FormBake *bake) {
    int cursor = 0, result = 0;
    if (!option_given(bake->options, "-o")) text_write(stdout, &dialects[0], bake);
    for (const char *path; result == 0 && (path = option_next(bake->options, "-o", &cursor));) {
        Output output;
        result = output_begin(&output, path);
        if (result != 0) return result;
        text_write(output.stream, dialect_of(path), bake);
        result = output_end(&output);
    }
    return result;
}

int bake_form_run(const Options *options) {
    FormBake bake = {.error = 0.01};
    int result = form_read(options, &bake);
    if (result != 0) return result;
    interrupt_watch();
    bake.command = command_text(options);
    result = bake.command ? forms_find(&bake) : report(WEFT_RESOURCES, "out of memory");
    if (result == 0) result = form_write(&bake);
    for (int k = 0; k < bake.count && result == 0 && !bake.common.quiet; k++) {
        const WeftAlbedoForm *form = &bake.forms[k];
        report(0, "%s: %d terms, off by at most %.3g from roughness %g on", bake.names[k],
               (form->across + 1) * (form->along + 1), form->error, bake.lowest);
    }
    free(bake.command);
    return result;
}
