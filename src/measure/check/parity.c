#include <stdio.h>
#include <stdlib.h>

#include "measure/check/parity.h"

#include "base/memory.h"
#include "base/pi.h"
#include "measure/bsdf/draw.h"
#include "measure/bsdf/grid.h"
#include "raster/frame/compute.h"
#include "text/assemble/dispatch.h"

enum { PAIRS = 16384, INPUTS = 4, ANSWERS = 3 };

/* in0: o.  in1: i.  in2, in3: parameters.  out0: f of the white lobe, pdf, f in a colour. */
static const char body[] =
    "    Lobe m;\n    m.id = in0.w < 2.0 ? FIRST : -1;\n" /* no constant to the compiler */
    "    for (int k = 0; k < 4; k++) {\n"
    "        m.params[k] = in2[k];\n        m.params[k + 4] = in3[k];\n    }\n"
    "    LobeValue v = lobe_value(m, angles_between(dir(in0.x, in0.y, in0.z), dir(in1.x, in1.y, in1.z)));\n"
    "    out0 = vec4(v.f * lobe_color(v, 1.0, lobe_second(m, 1.0, 1.0)), v.pdf,\n"
    "                v.f * lobe_color(v, 0.5, lobe_second(m, 0.5, 1.0)), 0.0);\n";

/* Draws a direction; one in four grazes, down to a cosine of 1e-4. */
static Dir any_direction(Draw *draw) {
    double z = 1.0 - (double)draw_unit(draw), phi = 2.0 * PI_DOUBLE * (double)draw_unit(draw);
    return grid_direction(draw_unit(draw) < 0.25f ? (exp2)(-13.0 * z) : z, phi);
}

typedef struct Arrays {
    float *in[INPUTS], *out;
} Arrays;

static void fill(const Bsdf *bsdf, Arrays *arrays) {
    Draw draw = draw_start(77, 0);
    for (size_t k = 0; k < PAIRS; k++) {
        Lobe lobe = bsdf_lobe(bsdf, (int)(k % (size_t)bsdf->rows));
        Dir o = any_direction(&draw), i = any_direction(&draw);
        const float rows[2][4] = {{o.x, o.y, o.z, 0.0f}, {i.x, i.y, i.z, 0.0f}};
        for (size_t c = 0; c < 4; c++) {
            arrays->in[0][4 * k + c] = rows[0][c];
            arrays->in[1][4 * k + c] = rows[1][c];
            arrays->in[2][4 * k + c] = lobe.params[c];
            arrays->in[3][4 * k + c] = lobe.params[4 + c];
        }
    }
}

static void compare(const Bsdf *bsdf, const Arrays *arrays, WeftPassport *out) {
    const double tolerance = 5e-4, least = 1e-5; /* relative; absolute if f is small */
    double worst = 0.0;
    int beyond = 0;
    for (size_t k = 0; k < PAIRS; k++) {
        const float *o = arrays->in[0] + 4 * k, *i = arrays->in[1] + 4 * k, *gpu = arrays->out + 4 * k;
        Lobe lobe = bsdf_lobe(bsdf, (int)(k % (size_t)bsdf->rows));
        LobeValue v = lobe_value(&lobe, angles_between(dir(o[0], o[1], o[2]), dir(i[0], i[1], i[2])));
        const double c[ANSWERS] = {(double)(v.f * lobe_color(v, 1.0f, lobe_second(&lobe, 1.0f, 1.0f))), (double)v.pdf,
                                   (double)(v.f * lobe_color(v, 0.5f, lobe_second(&lobe, 0.5f, 1.0f)))};
        for (int q = 0; q < ANSWERS; q++) {
            double error = fabs((double)gpu[q] - c[q]) / (fabs(c[q]) + least / tolerance);
            if (!(error <= tolerance))
                beyond++;
            else if (error > worst)
                worst = error;
        }
    }
    out->parity_worst = (float)worst;
    out->parity_beyond = (float)beyond / (ANSWERS * PAIRS);
}

static WeftResult run(GlContext *context, const Bsdf *bsdf, Arrays *arrays, WeftError *error) {
    Text text;
    Compute *compute = NULL;
    int id = bsdf->lobe.id;
    text_begin(&text, &(TextDesc){.language = context_language(context), .tables = true});
    text_dispatch(&text, &id, 1);
    text_line(&text, "\nconst int FIRST = %d;", id);
    WeftResult result = text_end(&text, error);
    ComputeDesc desc = {.name = weft_lobe_info(id)->id, .text = &text, .body = body, .inputs = INPUTS, .outputs = 1};
    if (result == WEFT_OK) result = compute_create(context, &desc, &compute, error);
    if (result == WEFT_OK) result = compute_tables(compute, text.tables, text.table_count, error);
    if (result == WEFT_OK) result = compute_run(compute, PAIRS, (const float *const *)arrays->in, &arrays->out, error);
    compute_destroy(compute);
    text_free(&text);
    return result;
}

void parity_measure(const Bsdf *bsdf, WeftPassport *out) {
    if (bsdf->whole || weft_lobe_info(bsdf->lobe.id)->traits & TRAIT_REFERENCE) {
        snprintf(out->parity_words, sizeof out->parity_words, "%s",
                 bsdf->whole ? "whole materials are compared in tests/raster" : "for the path tracer only");
        return;
    }
    GlContext *context;
    WeftError error = {0};
    WeftResult result = context_create(TEXT_GLSL_330, &context, &error);
    if (result == WEFT_OK) {
        Arrays arrays = {.out = alloc_array(PAIRS, 4 * sizeof(float))};
        bool allocated = arrays.out != NULL;
        for (int k = 0; k < INPUTS; k++) {
            arrays.in[k] = alloc_array(PAIRS, 4 * sizeof(float));
            allocated = allocated && arrays.in[k];
        }
        if (allocated) {
            fill(bsdf, &arrays);
            result = run(context, bsdf, &arrays, &error);
        }
        out->parity_measured = allocated && result == WEFT_OK;
        if (out->parity_measured) {
            compare(bsdf, &arrays, out);
            snprintf(out->parity_words, sizeof out->parity_words, "%s", context_driver(context));
        }
        for (int k = 0; k < INPUTS; k++) free(arrays.in[k]);
        free(arrays.out);
        context_destroy(context);
    }
    if (!out->parity_measured)
        snprintf(out->parity_words, sizeof out->parity_words, "%.150s", error.text[0] ? error.text : "out of memory");
}
