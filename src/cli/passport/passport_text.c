#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/passport/passports.h"

/* Writes "roughness 0.5, cos_o 0.1, cos_i 0.9, phi 30"; if cos_i is 0, the text leaves out wi. */
static const char *place_text(const WeftPassport *p, const WeftPlace *place, char *text, size_t size) {
    int used = 0;
    if (*p->parameter) used = snprintf(text, size, "%s %.3g, ", p->parameter, (double)place->value);
    used += snprintf(text + used, size - (size_t)used, "cos_o %.3g", (double)place->cos_o);
    if (place->cos_i > 0.0f)
        snprintf(text + used, size - (size_t)used, ", cos_i %.3g, phi %.0f", (double)place->cos_i, (double)place->phi);
    return text;
}

/* Returns the heading of the passport. */
static const char *title(const WeftPassport *p) {
    return p->profile && strcmp(p->id, "none") == 0 ? "none (weft's own)" : p->id;
}

static void print_cells(const WeftPassport *p, const float cells[][WEFT_PASSPORT_COSINES]) {
    if (*p->parameter) printf("  %s\n", p->parameter);
    printf("  cos_o ");
    for (int row = 0; row < p->rows && *p->parameter; row++) printf(" %5.3g", (double)p->values[row]);
    printf("\n");
    for (int c = 0; c < WEFT_PASSPORT_COSINES; c++) {
        printf("  %-6g", (double)p->cosines[c]);
        for (int row = 0; row < p->rows; row++) {
            float e = cells[row][c];
            printf("%c%5.3f", !(e <= 1.001f) ? '*' : ' ', (double)e);
        }
        printf("\n");
    }
}

static void print_albedo(const WeftPassport *p) {
    char place[96];
    printf("\nDirectional albedo E of the %s; * marks what is above 1 by more than 0.001\n\n",
           p->woven     ? "woven material"
           : p->profile ? "white material"
                        : "white lobe");
    print_cells(p, p->albedo);
    printf("  at most %.3g (%s); %d of %d cells above 1\n", (double)p->albedo_most,
           place_text(p, &p->albedo_place, place, sizeof place), p->albedo_above, p->rows * WEFT_PASSPORT_COSINES);
    if (!(p->traits & WEFT_LOBE_TINTED)) return;
    printf("\nDirectional albedo E of fibres that keep half of the light\n\n");
    print_cells(p, p->albedo_half);
}

static void print_reciprocity(const WeftPassport *p) {
    char place[96];
    printf("\nReciprocity\n  |f(wo, wi) - f(wi, wo)| is ");
    if (p->reciprocity <= 0.0f)
        printf("0\n");
    else
        printf("at most %.2g of the larger (%s)\n", (double)p->reciprocity,
               place_text(p, &p->reciprocity_place, place, sizeof place));
}

static void print_furnace(const WeftPassport *p) {
    if (p->layers == 0) return;
    printf("\nWhite furnace: what a white Lambert base under the white lobe returns, over %d views\n\n"
           "  roughness       ",
           WEFT_PASSPORT_VIEWS);
    for (int k = 0; k < WEFT_PASSPORT_SHEENS; k++) printf("  %-14g", (double)p->sheens[k]);
    printf("\n");
    for (int layer = 0; layer < p->layers; layer++) {
        printf("  %-16s", weft_layer_name(layer));
        for (int k = 0; k < WEFT_PASSPORT_SHEENS; k++) {
            float least = p->furnace[layer][k][0], most = least;
            bool above = false; /* significantly, not by noise */
            for (int v = 0; v < WEFT_PASSPORT_VIEWS; v++) {
                float e = p->furnace[layer][k][v];
                if (e < least || isnan(e)) least = e;
                if (e > most || isnan(e)) most = e;
                above |= !(e - 3.0f * p->furnace_noise[layer][k][v] <= 1.001f);
            }
            printf("  %5.3f ..%c%5.3f", (double)least, above ? '*' : ' ', (double)most);
        }
        printf("\n");
    }
}

static void print_sampling(const WeftPassport *p) {
    char place[96];
    printf("\nSampling\n  the pdf integrates to at most %.4f (%s)\n", (double)p->pdf_most,
           place_text(p, &p->pdf_place, place, sizeof place));
    printf("  chi-square: the least p of %d tests is %.2g (%s), significance %.2g\n", p->tests, p->p,
           place_text(p, &p->p_place, place, sizeof place), weft_passport_significance(p->p, p->tests));
    if (p->stray) printf("  %d samples fell where their pdf is 0\n", p->stray);
    printf("  missed by sampling: ");
    if (p->missed <= 0.0f)
        printf("0\n");
    else
        printf("%.2g of E (%s)\n", (double)p->missed, place_text(p, &p->missed_place, place, sizeof place));
    printf("  variance of f cos / pdf: %.2g of the cosine's", (double)p->variance_ratio);
    if (p->rows > 1)
        printf(" at %s %.3g, %.2g at worst (%s %.3g)", p->parameter, (double)p->values[p->row_default],
               (double)p->variance_worst, p->parameter, (double)p->variance_value);
    printf("\n");
}

static void print_sweep(const WeftPassport *p) {
    printf("\nAdversarial sweep\n  of %lld results %lld not finite, %lld negative, %lld nonzero below the "
           "horizon\n",
           p->sweep_count, p->sweep_infinite, p->sweep_negative, p->sweep_below);
}

static void print_half(const WeftPassport *p) {
    char place[96];
    printf("\nHalf precision\n");
    if (!p->half_measured) {
        const char *why = "the compiler of this program has no 16-bit floats";
        if (p->profile) why = "only lobes are measured in half precision";
        if (p->traits & WEFT_LOBE_REFERENCE) why = "for the path tracer only";
        printf("  not measured: %s\n", why);
        return;
    }
    printf("  of %lld results %lld not finite or negative; the least floor on both cosines:\n", p->half_count,
           p->half_bad);
    for (int row = 0; row < p->rows; row++) {
        if (*p->parameter) printf("  %s %.3g: ", p->parameter, (double)p->values[row]);
        if (!*p->parameter) printf("  ");
        if (p->half_floor[row] == WEFT_HALF_FREE)
            printf("none needed");
        else if (p->half_floor[row])
            printf("2^-%d", p->half_floor[row]);
        else
            printf("none up to 2^-%d helps", WEFT_HALF_MOST);
        printf("; away from grazing %.3g %% underflow to 0, %.3g %% are off by more than 1 %%\n",
               100.0 * (double)p->half_zero[row], 100.0 * (double)p->half_off[row]);
    }
    if (p->half_place.cos_o > 0.0f)
        printf("  where none helps, an example is %s\n", place_text(p, &p->half_place, place, sizeof place));
}

static void print_parity(const WeftPassport *p) {
    printf("\nC and GPU\n");
    if (p->parity_measured)
        printf("  differ by at most %.1e where within 5e-4; %.2g %% are beyond (%s)\n", (double)p->parity_worst,
               100.0 * (double)p->parity_beyond, p->parity_words);
    else
        printf("  not compared: %s\n", p->parity_words);
}

void passport_text(const WeftPassport *p) {
    printf("%s\n", title(p));
    if (*p->surface) printf("  %s\n", p->surface);
    print_albedo(p);
    print_reciprocity(p);
    print_furnace(p);
    print_sampling(p);
    print_sweep(p);
    print_half(p);
    print_parity(p);
}

void passport_line_heading(void) {
    printf("%-26s %6s %8s %7s %7s %5s %-6s %s\n", "", "most E", "recipr.", "signif.", "varian.", "sweep", "half",
           "GPU");
}

void passport_line(const WeftPassport *p) {
    char half[32] = "-";
    if (p->half_measured && !p->half_cosine)
        snprintf(half, sizeof half, "never");
    else if (p->half_measured && p->half_cosine == WEFT_HALF_FREE)
        snprintf(half, sizeof half, "always");
    else if (p->half_measured)
        snprintf(half, sizeof half, "2^-%d", p->half_cosine);
    printf("%-26s %6.3g %8.1e %7.2g %7.2g %5lld %-6s ", title(p), (double)p->albedo_most, (double)p->reciprocity,
           weft_passport_significance(p->p, p->tests), (double)p->variance_ratio,
           p->sweep_infinite + p->sweep_negative + p->sweep_below, half);
    if (p->parity_measured)
        printf("%.0e\n", (double)p->parity_worst);
    else
        printf("-\n");
}

static void header_half(const WeftPassport *p) {
    char place[96];
    printf(" *     half precision: ");
    if (!p->half_cosine)
        printf("no floor keeps it finite (%s).\n", place_text(p, &p->half_place, place, sizeof place));
    else if (p->half_cosine == WEFT_HALF_FREE)
        printf("finite for any cosines");
    else
        printf("finite for cosines >= 2^-%d", p->half_cosine);
    if (p->half_cosine && !p->half_whole) printf(" and %s >= %.2g", p->parameter, (double)p->half_parameter);
    if (p->half_cosine) printf(".\n");
}

/* Prints the lines, which say if parameters were not varied, without numbers that differ between machines: the
 * agreement of f(wo, wi) and f(wi, wo) to rounding,
 * and variances near zero. */
void passport_header(const WeftPassport *p) {
    char place[96];
    bool reference = (p->traits & WEFT_LOBE_REFERENCE) != 0;
    const WeftLobeInfo *info = weft_lobe_info(weft_lobe_find(p->id));
    printf(" *   measured by weft check %s%s: E at most %.2f (%s);\n", p->id,
           info && info->param_count > 1 ? ", other parameters at default" : "", (double)p->albedo_most,
           place_text(p, &p->albedo_place, place, sizeof place));
    if (p->reciprocity < 1e-3f)
        printf(" *     reciprocal to 1e-3; ");
    else
        printf(" *     f(wo, wi) and f(wi, wo) up to %.2f of the larger apart; ", (double)p->reciprocity);
    printf("weight variance %s%.2f of the cosine's%s\n", p->variance_ratio < 0.01f ? "under " : "",
           fmax((double)p->variance_ratio, 0.01), p->half_measured || reference ? ";" : ".");
    if (reference)
        printf(" *     half precision: not measured, since the lobe is for the path tracer only.\n");
    else if (p->half_measured)
        header_half(p);
}
