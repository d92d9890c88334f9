#include "measure/audit/audit_words.h"

#include "base/pi.h"

#include <stdarg.h>
#include <stdio.h>

__attribute__((format(printf, 2, 3))) static void add(char *text, const char *format, ...);

static void add(char *text, const char *format, ...) {
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, WEFT_AUDIT_TEXT - used, format, arguments);
    va_end(arguments);
}

void words_constant(char *text, double value, size_t count) {
    if (count == 1)
        add(text, "it is a single texel of %.4g", value);
    else if (value > 0.0)
        add(text, "all of its texels are %.4g", value);
    else
        add(text, "it is black");
    add(text, ", as a texture is that was never loaded: E comes out the same for every view and roughness");
}

void words_clipped(char *text, double top, double highest, size_t texels) {
    add(text, "it is right, but cut off at %.4g in %zu texels, where E goes on to %.3g", top, texels, highest);
}

/* Appends a difference of the axes. */
static void differ(char *text, int *count, bool differs, const char *words) {
    if (!differs) return;
    add(text, "%s%s", (*count)++ ? " and " : "", words);
}

void words_form(char *text, const ProbeReading *stated, const ProbeReading *found, double enough) {
    const WeftTableForm *a = &stated->form, *b = &found->form;
    char elements[WEFT_TABLE_FORM_TEXT];
    int count = 0;
    add(text, "%s, but ", found->distance < enough ? "it is right" : "it fits better read otherwise");
    differ(text, &count, !a->transposed != !b->transposed, "its axes are swapped");
    differ(text, &count, !a->flip_x != !b->flip_x, "its columns are in reverse");
    differ(text, &count, !a->flip_y != !b->flip_y, "its rows are in reverse");
    differ(text, &count, !a->alpha && b->alpha, "it is over alpha where roughness was said: nothing was squared");
    differ(text, &count, a->alpha && !b->alpha, "it is over roughness where alpha was said: that was squared");
    differ(text, &count, !a->root && b->root, "it is over the square root of cos_o");
    differ(text, &count, a->root && !b->root, "it is over cos_o, not its square root");
    differ(text, &count, !a->edges && b->edges, "its outer texels are at 0 and 1, not half a texel inside");
    differ(text, &count, a->edges && !b->edges, "its outer texels are half a texel inside, not at 0 and 1");
    add(text, " (%s: mean error %.2g, not %.2g)", weft_table_form_text(b, elements), found->distance, stated->distance);
}

void words_late(char *text, const ProbeReading *stated, const ProbeReading *found) {
    add(text,
        "it is right, but shifted: each texel holds what belongs to the %s (mean error %.2g there, %.2g "
        "here)",
        found->late > 0 ? "next one up the parameter" : "one before along the parameter", found->distance,
        stated->distance);
}

void words_encoded(char *text, const ProbeReading *stated, const ProbeReading *found) {
    add(text, "it is right, but sRGB-encoded as if it were a picture (mean error %.2g decoded, %.2g as it is)",
        found->distance, stated->distance);
}

void words_scaled(char *text, const ProbeReading *stated, const ProbeReading *found) {
    const struct {
        double factor;
        const char *words;
    } factors[] = {{PI_DOUBLE, "pi"},
                   {2.0 * PI_DOUBLE, "2 pi"},
                   {4.0 * PI_DOUBLE, "4 pi"},
                   {1.0 / PI_DOUBLE, "1 / pi"},
                   {0.5 / PI_DOUBLE, "1 / (2 pi)"}};
    add(text, "it is right, but for one factor: E is the table times %.5g", found->factor);
    for (size_t k = 0; k < sizeof factors / sizeof factors[0]; k++)
        if (fabs(found->factor / factors[k].factor - 1.0) < 2e-3) add(text, ", which is %s", factors[k].words);
    add(text, " (mean error %.2g so, %.2g as it is)", found->distance, stated->distance);
}

void words_lobe(char *text, const ProbeReading *stated, const ProbeReading *found) {
    char elements[WEFT_TABLE_FORM_TEXT];
    add(text, "it is much nearer to the E of %s (mean error %.2g) than to that of %s (%.2g)",
        weft_lobe_info(found->lobe.id)->id, found->distance, weft_lobe_info(stated->lobe.id)->id, stated->distance);
    if (!form_same(&stated->form, &found->form))
        add(text, ", read as %s", weft_table_form_text(&found->form, elements));
}

void words_no_lobe(char *text, const ProbeReading *nearest) {
    add(text,
        "no lobe fits it, in any axes, shifted, times a factor or decoded: the nearest is %s, off by %.2g in the mean; "
        "perhaps it is of other parameters, or holds something else than E",
        weft_lobe_info(nearest->lobe.id)->id, nearest->distance);
}

void words_biased(char *text, const WeftAudit *audit, const double ratios[3]) {
    add(text,
        "it is biased: neighbouring texels err alike (correlation %.2f), so more samples would not cure it, "
        "unless "
        "all texels share the same few; the table is %.3g times E at the median, and %.3g to %.3g times in "
        "eight "
        "texels of ten",
        audit->together, ratios[1], ratios[0], ratios[2]);
}

void words_noisy(char *text, const WeftAudit *audit) {
    add(text,
        "it is noisy: neighbouring texels err apart (correlation %.2f) with a deviation of %.2g, which four "
        "times "
        "the samples would halve",
        audit->together, audit->rms * (sqrt)(1.0 - fmax(audit->together, 0.0)));
}

void words_corner(char *text, const WeftAudit *audit, double most, int lobe) {
    const WeftLobeInfo *info = weft_lobe_info(lobe);
    add(text,
        "it is right but in a corner: %.2g %% of its texels are off by more than %.2g, most of all at cos_o "
        "%.3g",
        100.0 * audit->beyond, most, (double)audit->place.cos_o);
    if (info->param_count) add(text, " and %s %.3g", info->params[0].name, (double)audit->place.value);
}

void words_none(char *text, const WeftAudit *audit) {
    add(text, "it is right: no texel is off by more than %.2g", audit->largest);
    if (audit->step > 0.0 && audit->largest < 0.5 * audit->step + 2e-4) add(text, ", which is what its bits can hold");
}
