/* data_lobe_text.c - the text of a lobe's file for a fitted measurement, which --lobe reads */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "measure/fit/data_lobe.h"

/* The name of a lobe's file in its three forms. */
typedef struct DataLobeNames {
    char low[48], upper[48], record[48];
} DataLobeNames;

/* Derives the names of a lobe's file: letters, digits and _, a letter first. Returns false if the name is not
 * of this form. */
static bool names_of(const char *name, DataLobeNames *out) {
    size_t length = strlen(name), r = 0;
    bool next = true;
    if (length == 0 || length > 40 || !islower((unsigned char)name[0])) return false;
    memset(out, 0, sizeof *out);
    for (size_t k = 0; k < length; k++) {
        unsigned char c = (unsigned char)name[k];
        if (!islower(c) && !isdigit(c) && c != '_') return false;
        out->low[k] = (char)c;
        out->upper[k] = (char)toupper(c);
        if (c != '_') out->record[r++] = (char)(next ? toupper(c) : c);
        next = c == '_';
    }
    return true;
}

/* Writes a polynomial by Horner's rule: a row in x for each power of y, and their sum. */
static void put_polynomial(FILE *out, const char *rows, const char *result, const double *powers, int terms) {
    for (int j = 0; j < terms; j++) {
        fprintf(out, "    float %s%d = ", rows, j);
        for (int i = 0; i < terms; i++) fprintf(out, i + 1 < terms ? "%.7ef + x * (" : "%.7ef", powers[j * terms + i]);
        for (int i = 1; i < terms; i++) fputc(')', out);
        fputs(";\n", out);
    }
    fprintf(out, "    float %s = ", result);
    for (int j = 0; j < terms; j++) fprintf(out, j + 1 < terms ? "%s%d + y * (" : "%s%d", rows, j);
    for (int j = 1; j < terms; j++) fputc(')', out);
    fputs(";\n", out);
}

/* Writes words within a comment, without the characters that can end it. */
static void put_text(FILE *out, const char *words) {
    for (size_t k = 0; words[k] && k < 400; k++)
        fputc(iscntrl((unsigned char)words[k]) || words[k] == '*' ? '?' : words[k], out);
}

static void put_comment(FILE *out, const DataLobeNames *names, const char *about, const DataLobe *lobe) {
    fprintf(out, "/* %s - a measured cloth\n *\n", names->low);
    fprintf(out, " *   f = k exp(P(x, y)) (f0 (1 - s) + f90 s),   s = Q(x, y) in [0, 1]                [1/sr]\n"
                 " *   x = 2 sqrt(sin_h) - 1,   y = 2 sqrt(1 - wi . h) - 1\n *\n");
    fputs(" *   ", out);
    put_text(out, about);
    fprintf(out,
            ", 2026. The polynomials P and Q are fitted;\n"
            " * the log error of the fit over the data is %.4f.\n",
            lobe->error);
    fprintf(out,
            " *   Departures: phi_d is averaged over; P ends where the data do.\n"
            " *   roughness: none.\n *   reciprocal: yes.\n"
            " *   energy: k makes the largest E of the white lobe 1 / 1.05; that of the data is these colours:\n"
            " *     f0 %.6g,%.6g,%.6g and f90 %.6g,%.6g,%.6g.\n"
            " *   sampling: half by the cosine, half by half vectors of ggx. */\n",
            lobe->f0[0], lobe->f0[1], lobe->f0[2], lobe->f90[0], lobe->f90[1], lobe->f90[2]);
}

static void put_head(FILE *out, const DataLobeNames *n, const DataLobe *lobe) {
    fprintf(out, "#ifndef WEFT_%s_H\n#define WEFT_%s_H\n\n#include \"shading/lobe/lobe.h\"\n", n->upper, n->upper);
    fprintf(out, "#include \"shading/terms/d_ggx.h\"\n#include \"shading/terms/facet.h\"\n\n");
    fprintf(out, "#define %s_PARAMS(P)\n#define %s_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_TWO_COLORS)\n\n",
            n->upper, n->upper);
    fprintf(out, "STRUCT(%s) { float none; };\nPREPARED_AS_IT_IS(%s, %s)\nSEEN_AS_IT_IS(%s, %s)\n\n", n->record, n->low,
            n->record, n->low, n->record);
    fprintf(out, "#define %s_ALPHA %.2ff\n\n", n->upper, lobe->alpha);
}

static void put_value(FILE *out, const DataLobeNames *n, const DataLobe *lobe) {
    fprintf(out, "FN LobeValue %s_value(const %sPrepared *p, const %sView *w, Angles a) {\n", n->low, n->record,
            n->record);
    fprintf(out, "    float x = 2.0f * sqrt(sqrt(a.sin2_h)) - 1.0f, y = 2.0f * sqrt(max(1.0f - a.d, 0.0f)) - 1.0f;\n");
    put_polynomial(out, "p", "l", lobe->shape[0], SHAPE_TERMS);
    put_polynomial(out, "q", "s", lobe->share[0], SHARE_TERMS);
    fprintf(out, "    float f = %.7ef * exp(clamp(l, %.7ef, %.7ef));\n", lobe->scale, lobe->low, lobe->high);
    fprintf(out, "    float drawn = facet_pdf(ggx_d(%s_ALPHA, %s_ALPHA, a.h) * a.h.z, a);\n", n->upper, n->upper);
    fprintf(out, "    return lobe_value_of(f, clamp(s, 0.0f, 1.0f), 0.5f * (warp_cosine_pdf(a.i) + drawn));\n}\n\n");
}

static void put_sample(FILE *out, const DataLobeNames *n) {
    fprintf(out, "FN Dir %s_sample(const %sPrepared *p, const %sView *w, Dir o, float u, float v) {\n", n->low,
            n->record, n->record);
    fprintf(out, "    if (u < 0.5f) return warp_cosine(2.0f * u, v);\n");
    fprintf(out, "    Dir h = ggx_facet(%s_ALPHA, %s_ALPHA, 2.0f * u - 1.0f, v);\n", n->upper, n->upper);
    fprintf(out, "    return dir_mirror(o, facet_towards(o, h));\n}\n\n");
    fprintf(out, "FN Proxy %s_proxy(%s m) { return proxy_facets(%s_ALPHA, %s_ALPHA); }\n\n#endif\n", n->low, n->record,
            n->upper, n->upper);
}

WeftResult weft_data_lobe(const WeftData *data, const char *name, const char *about, char **text, WeftDataLobe *out,
                          WeftError *error) {
    DataLobeNames names;
    DataLobe lobe;
    size_t size = 0;
    *text = NULL;
    if (!names_of(name, &names))
        return fail(error, WEFT_MESSAGE_DESC, name, "is no name of a lobe: up to 40 of a-z, 0-9 and _, a letter first");
    if (!data_lobe_fit(data, &lobe)) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    out->error = lobe.error;
    for (int c = 0; c < 3; c++) out->f0[c] = (float)lobe.f0[c], out->f90[c] = (float)lobe.f90[c];
    FILE *stream = open_memstream(text, &size);
    if (!stream) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    put_comment(stream, &names, about, &lobe);
    put_head(stream, &names, &lobe);
    put_value(stream, &names, &lobe);
    put_sample(stream, &names);
    if (fclose(stream) == 0) return WEFT_OK;
    free(*text);
    *text = NULL;
    return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
}
